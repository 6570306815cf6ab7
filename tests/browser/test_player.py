"""A scene's page in use: its clock, its cameras, its signs, and places that can't draw it."""

import io
from itertools import pairwise

import matplotlib.image
import numpy as np
import pytest
from matplotlib.colors import to_rgb
from pictures import share_of_hue

from uavlab import plot, scene
from uavlab.city import City, table1_city
from uavlab.flight import OffsetProcess, fly
from uavlab.planners import astar, repare
from uavlab.route import Route
from uavlab.scene.camera import axes_of
from uavlab.scene.content import drawing_of
from uavlab.scene.stills import HEIGHT, WIDTH, chase_size, view_of
from uavlab.vehicle import LIGHT_QUADROTOR
from uavlab.weather import Wind

ENDS = (90, 18, 30), (50, 44, 30)


@pytest.fixture(scope="module")
def city():
    return table1_city()


@pytest.fixture(scope="module")
def flights(city):
    crash, safe = (fly(plan(city, *ENDS), city, LIGHT_QUADROTOR, OffsetProcess(1.0), rng=3) for plan in (astar, repare))
    assert (crash.outcome, safe.outcome) == ("crashed", "arrived")
    return {"A*": crash, "REPARE": safe}


@pytest.fixture
def opened(browser, tmp_path):
    """Open a scene's page; whatever goes wrong in it, or is asked for outside of it, fails the test."""
    pages, errors = [], []

    def open_page(content, width=1000, height=600, **options):
        page = browser.new_page(viewport={"width": width, "height": height}, **options)
        pages.append(page)
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.on("console", lambda said: errors.append(said.text) if said.type == "error" else None)
        page.on("request", lambda one: errors.append(one.url) if one.url.startswith("http") else None)
        path = tmp_path / f"scene{len(pages)}.html"
        path.write_text(content, encoding="utf-8")
        page.goto(path.as_uri())
        page.wait_for_selector("body[data-ready=yes]", timeout=60_000)
        return page

    yield open_page
    for page in pages:
        page.close()
    assert errors == []


def pixels(target):
    return matplotlib.image.imread(io.BytesIO(target.screenshot()))[..., :3]


def scrub_to(page, seconds, duration):
    page.locator("#scrub").evaluate(
        "(slider, value) => { slider.value = value; slider.dispatchEvent(new Event('input')); }",
        round(1000 * seconds / duration),
    )
    drawn(page)


def drawn(page):
    """Wait until what was asked for is drawn, however long a picture takes on a busy machine."""
    page.evaluate("() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")


def crosses(page):
    return page.evaluate(
        "[...document.querySelectorAll('#overlay [data-kind=crash]')].filter(g => g.style.display != 'none').length"
    )


def test_it_plays_pauses_and_scrubs_to_the_crash(opened, city, flights, picture_of):
    page = opened(scene.page(city, flights=flights, safe_distance=3.5, wind=Wind((6, 2))))
    crash, safe = flights["A*"], flights["REPARE"]
    first = page.inner_text("#clock")
    page.wait_for_function("first => document.getElementById('clock').textContent != first", arg=first)
    page.click("#play")
    assert page.get_attribute("#play", "aria-label") == "Play"
    page.wait_for_timeout(200)
    stands, clock = pixels(page), page.inner_text("#clock")
    draws = "window.draws = 0; const old = viewer.render; viewer.render = () => { window.draws++; old(); }; 0"
    page.evaluate(draws)
    page.wait_for_timeout(500)
    assert np.array_equal(pixels(page), stands)
    assert page.inner_text("#clock") == clock
    assert page.evaluate("window.draws") == 0  # a paused scene costs nothing
    scrub_to(page, crash.duration - 0.3, safe.duration)
    assert crosses(page) == 0
    scrub_to(page, crash.duration + 0.1, safe.duration)
    assert crosses(page) == 1
    assert page.get_attribute("#scrub", "aria-valuetext").endswith(f"of {safe.duration:.1f} s")
    box = page.locator("#overlay [data-kind=crash]").bounding_box()
    picture = picture_of(page)
    middle = picture[int(box["y"] + box["height"] / 2), int(box["x"] + box["width"] / 2)]
    assert np.abs(middle - to_rgb(plot.CRASH_COLOR)).max() < 0.15
    page.keyboard.press("Home")
    drawn(page)
    assert page.inner_text("#clock").startswith("0.0 of")
    page.locator("#pane").focus()
    page.keyboard.press(" ")
    page.wait_for_function("document.body.classList.contains('playing')")


def test_the_clock_runs_at_the_speed_that_is_chosen(opened, city, flights):
    page = opened(scene.page(city, flights=flights, start_paused=True))
    shown = []
    for speed in ("0.25", "1"):
        page.select_option("#speed", speed)
        page.evaluate("document.getElementById('restart').click()")
        page.click("#play")
        page.wait_for_timeout(2000)
        page.click("#play")
        shown.append(float(page.inner_text("#clock").split()[0]))
    assert 2 < shown[1] / max(shown[0], 0.1) < 8  # four times as fast; a busy machine draws few frames
    assert 0.8 < shown[1] < 3.5


@pytest.mark.parametrize("camera", ["overview", "above", "side", "chase", (30.0, 20.0), (100.0, -30.0)])
def test_cameras_are_those_of_the_still(opened, city, flights, camera):
    page = opened(scene.page(city, flights=flights, camera=camera, start_paused=True, start_at=5.0, safe_distance=3.5))
    aspect, eye, target = page.evaluate(
        "[viewer.camera.aspect, viewer.camera.position.toArray(), viewer.controls.target.toArray()]"
    )
    size = chase_size(LIGHT_QUADROTOR, 3.5)
    view = view_of(drawing_of(city, (), flights=flights, safe_distance=3.5), camera, 5.0, size, aspect)
    scale = np.linalg.norm(view.eye - view.target)
    for found, expected in ((eye, view.eye), (target, view.target)):
        x, y, z = found
        assert np.linalg.norm(np.array([x, -z, y]) - expected) < 0.01 * scale


def test_at_the_end_it_rests_and_begins_again(opened, city):
    page = opened(scene.page(city, Route([(90, 18, 30), (90, 10, 30)], "short"), start_paused=True))
    seconds = float(page.inner_text("#clock").split()[2])
    page.select_option("#speed", "1")
    scrub_to(page, seconds, seconds)
    page.click("#play")  # at the end: from the beginning
    assert int(page.input_value("#scrub")) < 900
    for _ in range(2):
        page.wait_for_function("document.getElementById('scrub').value == 1000", timeout=10_000)
        page.wait_for_timeout(300)
        assert page.input_value("#scrub") == "1000"  # readers see where it ends
        page.wait_for_function("document.getElementById('scrub').value < 900", timeout=5000)


def test_scrubbing_pauses(opened, city, flights):
    page = opened(scene.page(city, flights=flights))
    page.wait_for_function("document.body.classList.contains('playing')")
    scrub_to(page, 3.0, flights["REPARE"].duration)
    shown = page.inner_text("#clock")
    page.wait_for_timeout(400)
    assert page.inner_text("#clock") == shown
    page.locator("#camera").focus()
    page.keyboard.press("Escape")
    page.locator("#pane").focus()
    page.keyboard.press("Home")
    page.locator("#play").focus()
    page.keyboard.press("ArrowRight")  # a step of two per cent, wherever it isn't used otherwise
    assert float(page.inner_text("#clock").split()[0]) == pytest.approx(flights["REPARE"].duration / 50, abs=0.06)


@pytest.mark.parametrize("camera", [(-61.0, 38.0), (0.0, 60.0), (90.0, 30.0), (180.0, 45.0)])
def test_the_compass_points_to_the_north_and_along_the_wind(opened, city, camera):
    page = opened(scene.page(city, camera=camera, wind=Wind((3.0, 4.0))))
    right, up, _ = axes_of(*camera)
    letter = [float(page.get_attribute("#north", name)) for name in "xy"]
    assert bearing(letter[0], -letter[1]) == pytest.approx(bearing(right[1], up[1]), abs=0.5)
    north = turned(page, "#needle", (0, -1))
    assert bearing(north[0], -north[1]) == pytest.approx(bearing(right[1], up[1]), abs=0.5)
    wind = turned(page, "#windmark", (0, 1))  # its point is below
    blows = np.array([0.6, 0.8, 0.0])
    assert bearing(wind[0], -wind[1]) == pytest.approx(bearing(right @ blows, up @ blows), abs=0.5)


def bearing(across, upward):
    """Clockwise from a corner of the picture [degrees], which none of the cases points to."""
    return (np.degrees(np.arctan2(across, upward)) + 45) % 360


def turned(page, element, direction):
    """Where a direction (x, y) of a drawing points in the compass."""
    return page.locator(element).evaluate(
        "(drawn, [x, y]) => { const m = drawn.transform.baseVal.consolidate().matrix;"
        " return [m.a * x + m.c * y, m.b * x + m.d * y]; }",
        list(direction),
    )


def test_rings_are_for_uavs_that_are_too_small_to_see(opened, city, flights):
    page = opened(scene.page(city, flights=flights, start_paused=True, start_at=4.0))
    rings = "[...document.querySelectorAll('#overlay [data-kind=uav]')].map(ring => ring.style.display)"
    assert page.evaluate(rings) == ["", ""]
    page.select_option("#camera", "chase")
    page.wait_for_function(f"{rings}[0] === 'none'", timeout=10_000)


def test_behind_the_camera_there_are_no_signs(opened, city):
    page = opened(scene.page(city, Route([(90, 5, 30), (90, 60, 30), (90, 95, 30)], "north"), start_paused=True))
    shown = "[...document.querySelectorAll('#overlay [data-kind=start]')].map(sign => sign.style.display)"
    assert page.evaluate(shown) == [""]
    page.evaluate("viewer.camera.position.set(90, 30, -50); viewer.controls.target.set(90, 30, -90)")
    page.evaluate("viewer.controls.update(); viewer.render()")
    assert page.evaluate(shown) == ["none"]  # 45 m behind the eye


def test_turning_by_hand_stays_when_the_window_changes(opened, city, flights):
    page = opened(scene.page(city, flights=flights, start_paused=True))
    place = "viewer.camera.position.toArray()"
    page.set_viewport_size({"width": 700, "height": 600})
    page.wait_for_timeout(300)
    fitted = page.evaluate(place)
    page.mouse.move(300, 200)
    page.mouse.down()
    page.mouse.move(360, 200, steps=4)
    page.mouse.up()
    page.wait_for_timeout(600)
    turned = page.evaluate(place)
    assert np.linalg.norm(np.subtract(turned, fitted)) > 1
    page.set_viewport_size({"width": 1000, "height": 600})
    page.wait_for_timeout(400)
    assert page.evaluate(place) == pytest.approx(turned, abs=1e-6)


@pytest.mark.parametrize("camera", ["overview", "above", "side"])
def test_no_drag_takes_the_camera_under_the_ground(opened, camera):
    city = City(np.zeros((60, 40, 5), dtype=bool), 10.0)
    page = opened(scene.page(city, Route([(50, 50, 5), (500, 300, 12)]), start_paused=True, camera=camera))
    for _ in range(3):
        page.mouse.move(400, 450)
        page.mouse.down()
        page.mouse.move(400, 100, steps=4)
        page.mouse.up()
        page.wait_for_timeout(300)
    eye, target = page.evaluate("[viewer.camera.position.y, viewer.controls.target.y]")
    assert eye == pytest.approx(target, abs=1)  # as low as it gets
    ground = -50 / 2  # the middle of the map is 0
    assert eye > ground


def test_turning_by_keys_ends_following(opened, city, flights):
    page = opened(scene.page(city, flights=flights, start_paused=True, camera="chase"))
    page.locator("#pane").focus()
    page.keyboard.press("ArrowLeft")
    place = page.evaluate("viewer.camera.position.toArray()")
    scrub_to(page, 9.0, flights["REPARE"].duration)
    assert page.evaluate("viewer.camera.position.toArray()") == pytest.approx(place, abs=1e-6)


def test_arrows_turn_the_view_and_up_goes_up(opened, city):
    page = opened(scene.page(city, start_paused=True))
    page.locator("#pane").focus()
    heights = [page.evaluate("viewer.camera.position.y")]
    for key in ("ArrowUp", "ArrowDown"):
        page.keyboard.press(key)
        heights.append(page.evaluate("viewer.camera.position.y"))
    assert heights[1] > heights[0] + 1
    assert heights[2] == pytest.approx(heights[0], abs=1e-6)


def test_keys_choose_cameras_and_fold_the_legend(opened, city, flights):
    page = opened(scene.page(city, flights=flights, start_paused=True))
    seen = []
    for key in "1234":
        page.keyboard.press(key)
        seen.append(page.evaluate("viewer.camera.position.toArray()"))
    assert all(a != b for a, b in pairwise(seen))
    assert page.input_value("#camera") == "chase"
    page.keyboard.press("l")
    assert not page.evaluate("document.getElementById('legend').open")
    page.locator("#pane").focus()
    before = page.evaluate("viewer.camera.position.toArray()")
    page.keyboard.press("ArrowLeft")
    page.keyboard.press("+")
    assert page.evaluate("viewer.camera.position.toArray()") != before


def test_the_uav_is_where_it_is_in_the_drawing(opened, city, flights):
    moment = 6.13  # between two points of the tracks
    page = opened(scene.page(city, flights=flights, start_paused=True, start_at=moment))
    drawing = drawing_of(city, (), flights=flights)
    for number, mover in enumerate(drawing.movers):
        place, turn = mover.at(moment)
        found = page.evaluate(
            f"(() => {{ const o = viewer.scene_tree.find(['meshcat', 'mover{number}']).object;"
            " return [o.position.toArray(), o.quaternion.toArray()]; })()"
        )
        assert found[0] == pytest.approx(drawing.near(place).tolist(), abs=2e-3)
        assert abs(np.dot(found[1], turn)) == pytest.approx(1, abs=1e-3)


def test_page_and_still_show_the_same(opened, city, flights, picture_of):
    """The same drawing from the same camera: pictures differ by anti-aliasing and text only."""
    route = astar(city, *ENDS)
    page = opened(scene.page(city, route, start_paused=True, start_at=3.0), width=1200, height=700)
    page.evaluate("document.getElementById('legend').open = false")
    page.evaluate("document.getElementById('signs').style.display = 'none'")
    page.wait_for_timeout(300)
    pane = page.locator("#pane")
    box = pane.bounding_box()
    figure = scene.still(city, route, start_at=3.0)
    image = figure.axes[0].images[0].get_array()
    size = f"width:{WIDTH * 100}px;height:{HEIGHT * 100}px"
    page.evaluate("size => document.getElementById('pane').style.cssText = size", size)
    page.wait_for_timeout(500)
    page.keyboard.press("1")
    page.wait_for_timeout(300)
    shown = picture_of(page)[: int(HEIGHT * 100), : int(WIDTH * 100)]
    assert box["width"] > 600
    assert shown.shape == image.shape
    assert np.abs(shown - image).mean() < 0.02


def test_the_scale_bar_is_as_long_as_it_says(opened):
    flat = City(np.zeros((100, 100, 20), dtype=bool), 1.0)
    page = opened(scene.page(flat, Route([(30, 50, 10), (70, 50, 10)], "40 m"), camera="above", start_paused=True))
    ends = [page.locator(f"#overlay [data-kind={kind}]").bounding_box() for kind in ("start", "goal")]
    pixels_per_metre = (ends[1]["x"] + ends[1]["width"] / 2 - ends[0]["x"] - ends[0]["width"] / 2) / 40
    length = float(page.inner_text("#scale").split()[0])
    assert page.locator("#scale").bounding_box()["width"] / pixels_per_metre == pytest.approx(length, rel=0.05)


def test_a_phone_has_everything_in_reach(opened, city, flights, picture_of):
    page = opened(scene.page(city, flights=flights, start_paused=True), 360, 640, has_touch=True, device_scale_factor=2)
    assert not page.evaluate("document.getElementById('legend').open")
    for name in ("#play", "#restart", "#camera", "#speed", "#scrub", "#legend summary"):
        box = page.locator(name).bounding_box()
        assert 0 <= box["x"] <= box["x"] + box["width"] <= 360, name
        assert box["y"] + box["height"] <= 640, name
    assert page.locator("#play").bounding_box()["height"] >= 36
    page.tap("#play")
    page.wait_for_function("document.body.classList.contains('playing')")
    assert share_of_hue(picture_of(page), table1_city().buildings[0].color) > 0.01


def test_readers_who_want_less_motion_begin_with_a_standing_picture(opened, city, flights):
    page = opened(scene.page(city, flights=flights), reduced_motion="reduce")
    assert not page.evaluate("document.body.classList.contains('playing')")


def test_a_scene_without_animation_has_no_clock(opened, city):
    page = opened(scene.page(city))
    assert not page.is_visible("#play")
    assert not page.is_visible("#scrub")
    assert page.is_visible("#camera")
    assert page.get_attribute("#pane", "aria-label").startswith("Scene in 3D: ")


def test_without_webgl_there_is_a_still_and_a_sentence(browser, tmp_path, city, picture_of):
    path = tmp_path / "scene.html"
    path.write_text(scene.page(city, astar(city, *ENDS)), encoding="utf-8")
    page = browser.new_page(viewport={"width": 900, "height": 600})
    page.add_init_script("HTMLCanvasElement.prototype.getContext = () => null")
    page.goto(path.as_uri())
    page.wait_for_selector("body[data-ready=still]", timeout=60_000)
    assert "This browser can't draw the scene in 3D" in page.inner_text("#problem")
    assert share_of_hue(picture_of(page), table1_city().buildings[0].color) > 0.01
    page.close()
