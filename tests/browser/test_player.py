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
    page.wait_for_timeout(150)


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
    page.wait_for_timeout(100)
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


@pytest.mark.parametrize("camera", ["overview", "above", "side", "chase", (30.0, 20.0)])
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


def test_keys_choose_cameras_and_fold_the_legend(opened, city, flights):
    page = opened(scene.page(city, flights=flights, start_paused=True))
    seen = []
    for key in "1234":
        page.keyboard.press(key)
        page.wait_for_timeout(150)
        seen.append(pixels(page.locator("#pane")))
    assert all(not np.array_equal(a, b) for a, b in pairwise(seen))
    assert page.input_value("#camera") == "chase"
    page.keyboard.press("l")
    assert not page.evaluate("document.getElementById('legend').open")
    page.locator("#pane").focus()
    before = page.evaluate("viewer.camera.position.toArray()")
    page.keyboard.press("ArrowLeft")
    page.keyboard.press("+")
    assert page.evaluate("viewer.camera.position.toArray()") != before


def test_the_uav_is_where_it_is_in_the_drawing(opened, city, flights):
    page = opened(scene.page(city, flights=flights, start_paused=True, start_at=6.0))
    drawing = drawing_of(city, (), flights=flights)
    for number, mover in enumerate(drawing.movers):
        place, turn = mover.at(6.0)
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
