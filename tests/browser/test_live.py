"""A live scene in use: ends dragged by a mouse or by keys, planners and flights that answer as Python does."""

import numpy as np
import pytest

from uavlab.city import City, table1_city
from uavlab.flight import monte_carlo
from uavlab.planners import astar, least_risk
from uavlab.risk import CAMPUS_FLIGHT, RiskMap, reference_campus
from uavlab.scene import live, live_curve
from uavlab.spline import Curve
from uavlab.statistics import share_interval
from uavlab.vehicle import LIGHT_QUADROTOR
from uavlab.weather import Wind

ENDS = (90.5, 18.5, 30.5), (50.5, 44.5, 30.5)
NAMES = ["A*", "Dijkstra", "A* in a penalty zone", "Theta*", "hazard A*", "REPARE", "potential field"]
SECONDS = 60_000


@pytest.fixture(scope="module")
def city():
    return table1_city()


@pytest.fixture
def opened(browser, tmp_path):
    """Open a live scene's page; whatever goes wrong in it, or is asked for outside of it, fails the test."""
    wrong, contexts = [], []

    def open_page(scene, fragment="", script="", **viewport):
        context = browser.new_context(viewport={"width": 1200, "height": 800} | viewport)
        contexts.append(context)
        page = context.new_page()
        page.on("pageerror", lambda error: wrong.append(str(error)))
        page.on("console", lambda message: wrong.append(message.text) if message.type == "error" else None)
        page.on("request", lambda request: wrong.append(request.url) if request.url.startswith("http") else None)
        if script:
            page.add_init_script(script)
        path = tmp_path / "live.html"
        path.write_text(scene.page, encoding="utf-8")
        page.goto(f"{path.as_uri()}{fragment}")
        page.wait_for_selector("body[data-live]", timeout=SECONDS)
        return page

    yield open_page
    for context in contexts:
        context.close()
    assert wrong == []


def planned(page):
    return int(page.evaluate("document.body.dataset.planned ?? 0"))


def lengths(page):
    """By planner, as the page computed them."""
    rows = page.eval_on_selector_all(
        "#offers li",
        "rows => rows.map(row => [row.querySelector('label').textContent, row.querySelector('.found').dataset.length])",
    )
    return {name: float(length) for name, length in rows if length}


def said(page, number=0):
    return page.inner_text(f"#offer-{number} .found")


def as_python(page, **names):
    """What the page's own words in Python give."""
    exec(page.text_content("#python"), names)
    return names


def here(page):
    """Where the start is, as the page says."""
    x, y, z = page.inner_text("#where").split("(")[1].split(")")[0].split(", ")
    return float(x), float(y), float(z)


def drag(page, number, to, kind="level"):
    """Take an end, and let go of it so many pixels away."""
    grip = page.locator(f".handle .{kind}").nth(number).bounding_box()
    x, y = grip["x"] + grip["width"] / 2, grip["y"] + grip["height"] / 2
    before = planned(page)
    page.mouse.move(x, y)
    page.mouse.down()
    for share in (0.25, 0.5, 0.75, 1.0):
        page.mouse.move(x + share * to[0], y + share * to[1])
    page.mouse.up()
    page.wait_for_function(f"document.body.dataset.planned > {before}")
    page.wait_for_timeout(200)


def test_the_goal_is_dragged_and_python_called_as_the_page_says_gives_the_same(opened, city, picture_of):
    page = opened(live(city, *ENDS, planners=NAMES))
    before = lengths(page)
    picture_of(page, "-before")
    drag(page, 1, (-70, 30))
    after = lengths(page)
    picture_of(page, "-after")
    assert set(after) == set(NAMES) - {"potential field"}  # which is caught in the notch
    assert all(after[name] != before[name] for name in after)
    routes = as_python(page, city=city)["routes"]
    assert {name: route.length for name, route in routes.items() if route.reached} == after
    assert routes["potential field"].reason in said(page, NAMES.index("potential field"))
    assert f"{routes['A*'].info['expanded']:,} expanded" in said(page)
    assert f"clearance {routes['A*'].clearance(city):.2f} m" in said(page)


def test_settings_are_those_of_the_calls(opened, city):
    page = opened(live(city, *ENDS, planners=NAMES, settings={"keep": 3.0, "sigma": 0.4}))
    for name, value in (("keep", "1.5"), ("omega", "0.3"), ("sigma", "1.2"), ("reach", "8")):
        page.fill(f"#set-{name}", value)
    page.select_option("#set-conditions", "3")
    page.wait_for_timeout(300)
    routes = as_python(page, city=city)["routes"]
    assert {name: route.length for name, route in routes.items() if route.reached} == lengths(page)
    assert 'load="moderate"' in page.text_content("#python")
    page.fill("#set-keep", "0")
    page.wait_for_timeout(300)
    assert "min_clearance" not in page.text_content("#python")
    assert as_python(page, city=city)["routes"]["A*"].length == lengths(page)["A*"]


def test_a_link_brings_the_state_back(opened, city):
    scene = live(city, *ENDS, planners=["A*", "Theta*"])
    page = opened(scene)
    drag(page, 0, (30, 20))
    page.fill("#set-keep", "3.5")
    page.uncheck("#offer-1 input")
    page.wait_for_timeout(300)
    again = opened(scene, page.evaluate("location.hash"))
    assert lengths(again) == lengths(page)
    assert list(lengths(again)) == ["A*"]
    other = opened(live(city, *ENDS, planners=["A*"]), page.evaluate("location.hash"))
    assert lengths(other)["A*"] == astar(city, *ENDS, min_clearance=2.0).length  # a link of another scene


@pytest.mark.parametrize("camera", ["overview", "above", (-85, 20), (-85, 50)])
def test_height_by_a_handle(opened, city, camera):
    page = opened(live(city, *ENDS, camera=camera))
    drag(page, 1, (0, -40), "height")
    routes = as_python(page, city=city)["routes"]
    higher = routes["A*"].points[-1]
    assert higher[:2].tolist() == list(ENDS[1][:2])
    assert ENDS[1][2] + 3 < higher[2] < ENDS[1][2] + 25
    assert routes["A*"].length == lengths(page)["A*"]
    drag(page, 1, (0, 40), "height")
    assert abs(as_python(page, city=city)["routes"]["A*"].points[-1, 2] - ENDS[1][2]) <= 1


def test_keys(opened, city):
    page = opened(live(city, *ENDS))
    page.focus(".handle >> nth=0")
    for key in ("ArrowRight", "ArrowUp", "PageUp", "PageUp"):
        page.keyboard.press(key)
    page.wait_for_timeout(300)
    start = as_python(page, city=city)["routes"]["A*"].points[0]
    assert start.tolist() == [ENDS[0][0] + 1, ENDS[0][1] + 1, ENDS[0][2] + 2]
    assert page.get_attribute(".handle >> nth=0", "aria-label").startswith(f"start at ({start[0]:g}, ")


def test_start_over(opened, city):
    page = opened(live(city, *ENDS, planners=["A*", "Theta*"], shown=["A*"], flights=20))
    before = page.url, lengths(page), page.inner_text("#where")
    drag(page, 1, (-70, 30))
    page.check("#offer-1 input")
    page.fill("#set-keep", "3")
    page.fill("#set-wind", "9")
    page.wait_for_timeout(300)
    assert before[1:] != (lengths(page), page.inner_text("#where"))
    page.click("#again")
    page.wait_for_timeout(300)
    assert before == (page.url, lengths(page), page.inner_text("#where"))
    assert page.inner_text("#is-keep") == "2 m"


def test_a_start_in_a_building_is_said_and_a_free_point_offered(opened, city):
    page = opened(live(city, *ENDS))
    page.focus(".handle >> nth=0")
    for _ in range(23):
        page.keyboard.press("ArrowLeft")
    page.wait_for_timeout(300)
    inside = (ENDS[0][0] - 23, *ENDS[0][1:])
    with pytest.raises(ValueError, match=r"start .* lies in ") as refusal:
        astar(city, inside, ENDS[1], min_clearance=2.0)
    assert "lies in a building" in page.inner_text("#wrong")
    assert lengths(page) == {}
    assert str(refusal.value).endswith(page.inner_text("#instead").split("point ")[1])
    page.click("#instead")
    page.wait_for_timeout(300)
    assert not page.is_visible("#wrong")
    assert set(lengths(page)) == {"A*"}


@pytest.mark.parametrize(("planner", "fewest"), [("A*", 4), ("Theta*", 4), ("hazard A*", 8), ("REPARE", 5)])
def test_a_start_too_near_a_wall_is_refused_as_by_python(opened, city, planner, fewest):
    page = opened(
        live(city, *ENDS, planners=[planner], settings={"keep": 4.5} if planner in ("A*", "Theta*") else None)
    )
    page.focus(".handle >> nth=0")
    answered, refusal = 0, ""
    while not refusal and city.clearance[tuple(city.cell_of(here(page)))] > 0.5:  # on to the wall
        before = planned(page)
        page.keyboard.press("ArrowLeft")
        page.wait_for_function(f"document.body.dataset.planned > {before}")
        try:
            (route,) = as_python(page, city=city)["routes"].values()
        except ValueError as error:
            refusal = str(error)
        else:
            assert lengths(page) == {planner: route.length}
            answered += 1
    assert answered >= fewest
    assert bool(refusal) == (planner != "hazard A*")  # which keeps no more than its body away
    if refusal:
        assert page.inner_text("#instead").split("point ")[1] in refusal
        assert lengths(page) == {}


def test_a_goal_out_of_reach_has_pythons_reason(opened):
    occupied = np.zeros((12, 12, 12), bool)
    occupied[3:8, 3:8, 3:8] = True
    occupied[4:7, 4:7, 4:7] = False
    closed = City(occupied)
    page = opened(live(closed, (1.5, 1.5, 1.5), (5.5, 5.5, 5.5), planners=["A*", "Theta*"], settings={"keep": 0.0}))
    reasons = [astar(closed, (1.5, 1.5, 1.5), (5.5, 5.5, 5.5)).reason] * 2
    for number, reason in enumerate(reasons):
        assert said(page, number).lower() == reason.lower()


def test_flights_are_those_of_monte_carlo(opened, city):
    page = opened(live(city, *ENDS, planners=["A*", "hazard A*"], flights=60, settings={"wind": 9.0, "gusts": 3.0}))
    page.click("#fly")
    page.wait_for_selector("body[data-flown]", timeout=SECONDS)
    crashed = page.eval_on_selector_all("#offers .flown", "rows => rows.map(row => Number(row.dataset.crashed))")
    wind = Wind((9.0, 0.0), deviation=3.0)
    routes = as_python(page, city=city)["routes"]
    runs = [monte_carlo(route, city, LIGHT_QUADROTOR, wind, rng=0, flights=60) for route in routes.values()]
    assert crashed == [int(run.crashed.sum()) for run in runs]
    assert crashed[0] > crashed[1]
    for number, count in enumerate(crashed):
        low, high = share_interval(count, 60)
        assert f"(95 %: {1000 * low:.0f} to {1000 * high:.0f})" in page.inner_text(f"#offer-{number} .flown")
    assert page.locator("#overlay [data-kind=crash]").count() == sum(crashed)
    page.focus(".handle >> nth=0")
    page.keyboard.press("ArrowRight")
    page.wait_for_timeout(300)
    assert page.get_attribute("#offer-0 .flown", "class") == "flown before"  # they flew another route
    assert page.locator("#overlay [data-kind=crash]").count() == 0
    page.fill("#set-wind", "14")
    page.fill("#set-gusts", "4")
    page.click("#fly")
    page.wait_for_function("document.body.dataset.flown == 2")
    assert "stays on the ground" in page.inner_text("#offer-0 .flown")


def test_flights_can_be_stopped_and_those_before_stay_to_compare(opened, city):
    page = opened(live(city, *ENDS, planners=["A*"], flights=1000, settings={"wind": 3.0, "gusts": 1.0}))
    words, row = page.inner_text("#fly"), "#offer-0 .flown"
    page.click("#fly")
    page.wait_for_function("document.querySelector('#offer-0 .flown').textContent.startsWith('flight ')")
    assert page.inner_text("#fly") == "Stop"
    page.click("#fly")
    page.wait_for_timeout(300)
    assert page.inner_text("#fly") == words
    assert page.text_content(row) == ""
    assert page.evaluate("document.body.dataset.flown ?? 'never'") == "never"
    page.click("#fly")
    page.wait_for_selector("body[data-flown]", timeout=SECONDS)
    first = page.text_content(row)
    assert "of 1000 crash" in first
    for wind in ("4", "5"):  # changed twice, still there
        page.fill("#set-wind", wind)
        assert (page.text_content(row), page.get_attribute(row, "class")) == (first, "flown before")
    page.click("#fly")
    page.wait_for_function("document.body.dataset.flown == 2", timeout=SECONDS)
    assert page.get_attribute(row, "class") == "flown"


def test_flights_without_memory_say_so(opened, city):
    page = opened(live(city, *ENDS, planners=["A*"], flights=20))
    page.evaluate("window.grow = WebAssembly.Memory.prototype.grow, null")
    page.evaluate("WebAssembly.Memory.prototype.grow = () => { throw new RangeError() }, null")
    page.click("#fly")
    page.wait_for_selector("body[data-flown]", timeout=SECONDS)
    assert "no more memory" in page.inner_text("#offer-0 .flown")
    page.evaluate("WebAssembly.Memory.prototype.grow = window.grow, null")
    page.click("#fly")
    page.wait_for_function("document.body.dataset.flown == 2")
    assert "0 of 20 crash" in page.inner_text("#offer-0 .flown")


def test_risk_below_the_ends_and_along_the_routes(opened):
    campus = reference_campus()
    page = opened(live(campus.city, *CAMPUS_FLIGHT, risk=campus, planners=["least risk", "shortest"]))
    found = lengths(page)
    assert found["least risk"] == least_risk(campus, *CAMPUS_FLIGHT).length
    routes = as_python(page, city=campus.city, risk=campus)["routes"]
    assert {name: route.length for name, route in routes.items()} == found
    digits, power = f"{campus.fatalities(routes['least risk']):.1e}".split("e")
    superscripts = str(int(power)).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
    assert f"{digits}·10{superscripts} deaths a flight" in said(page)
    assert page.inner_text("#where").count("deaths an hour") == 2
    assert page.inner_text("#where").startswith("start at (12.5, 17.5, 22.5) m, where r = ")
    drag(page, 1, (-40, 20))
    assert lengths(page)["least risk"] != found["least risk"]


def test_a_flight_over_people_takes_off_and_lands_where_it_is_too_low(opened):
    occupied = np.zeros((20, 20, 10), bool)
    occupied[14, 14, 2] = True  # a roof over the goal's ground
    occupied[8:12, 8:12, :8] = True
    campus = RiskMap(City(occupied, cell=5.0), population_density=0.01, shelter=0.2, min_height=15.0)
    page = opened(
        live(campus.city, (12.5, 12.5, 2.5), (82.5, 82.5, 7.5), risk=campus, planners=["least risk", "shortest"])
    )
    routes = as_python(page, city=campus.city, risk=campus)["routes"]
    assert [route.takeoff for route in routes.values()] == [3, 3]
    assert [route.landing for route in routes.values()] == [2, 2]
    assert {name: route.length for name, route in routes.items()} == lengths(page)
    assert f"{campus.fatalities(routes['least risk']):.1e}".split("e")[0] + "·10⁻" in said(page)
    page.focus(".handle >> nth=1")
    for steps in (2, 12):  # below the roof; then above the start, to end below where a route may begin
        for key in ["ArrowLeft"] * steps + ["ArrowDown"] * steps:
            page.keyboard.press(key)
        page.wait_for_timeout(300)
        with pytest.raises(ValueError, match="min_height") as refusal:
            as_python(page, city=campus.city, risk=campus)
        assert said(page).lower() in str(refusal.value)


def test_control_points_are_dragged(opened, city):
    page = opened(live_curve(city, [(5, 60, 30), (30, 60, 40), (45, 80, 40), (60, 60, 30)]))
    drag(page, 2, (30, 10))
    curve = as_python(page, city=city, print=lambda *_: None)["curve"]
    assert isinstance(curve, Curve)
    assert lengths(page)["curve"] == pytest.approx(curve.length, rel=1e-12)
    assert f"{1 / curve.level_curvature.max():.1f} m of radius" in said(page)
    assert ("touches" in said(page)) == (curve.clearance(city) == 0.0)


@pytest.mark.parametrize(
    ("script", "why"),
    [
        ("delete window.WebAssembly", "there is no WebAssembly"),
        ("WebAssembly.Memory.prototype.grow = () => { throw new RangeError('no more memory'); }", "no more memory"),
    ],
)
def test_a_page_without_planners_shows_the_first_routes(opened, city, script, why):
    page = opened(live(city, *ENDS), script=script)
    assert page.evaluate("document.body.dataset.live") == "no"
    assert why in page.inner_text("#lifeless")
    assert f"{astar(city, *ENDS, min_clearance=2.0).length:.1f} m" in said(page)
    assert not page.is_visible("#set-keep")


def test_expanded_voxels_of_a_race(opened, city, picture_of):
    names = ["A*", "A*, straight estimate", "Dijkstra"]
    page = opened(live(city, *ENDS, planners=names, expansions=True))
    before = picture_of(page.locator("#pane"), "-without")
    page.check("#expanded")
    page.wait_for_timeout(500)
    assert np.abs(picture_of(page.locator("#pane"), "-with") - before).mean() > 0.01
    expanded = [int(said(page, n).split(" expanded")[0].split()[-1].replace(",", "")) for n in range(3)]
    assert expanded == sorted(expanded)


def test_a_planner_that_records_nothing_draws_no_expanded_voxels(opened, city, picture_of):
    page = opened(live(city, *ENDS, planners=["A*", "potential field"], expansions=True))
    page.uncheck("#offer-0 input")  # the field is planned alone, after a search that was recorded
    page.wait_for_timeout(500)
    without = picture_of(page.locator("#pane"), "-without")
    page.check("#expanded")
    page.wait_for_timeout(500)
    assert np.array_equal(picture_of(page.locator("#pane"), "-with"), without)


def test_on_a_phone(opened, city, picture_of):
    page = opened(live(city, *ENDS, planners=["A*", "REPARE"], flights=20), width=390, height=844)
    picture_of(page)
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    assert page.is_visible("#offer-0")
    assert page.is_visible("#pane canvas")
