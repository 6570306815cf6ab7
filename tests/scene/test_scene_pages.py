"""Scenes: what the page holds, how large it is, and that the same scene gives the same bytes."""

import base64
import io
import re

import matplotlib.image
import numpy as np
import pytest
from matplotlib.colors import to_rgb
from reading import commands_of, motion_of, shapes_of, vertices_of

from uavlab import plot, scene
from uavlab.city import Building, City, NoFlyZone
from uavlab.flight import OffsetProcess, fly
from uavlab.planners import astar, potential_field, repare, shortcut
from uavlab.plot.colors import LINES
from uavlab.plot.ground import MOST_QUADS, ZONE_COLOR
from uavlab.risk import RiskMap, reference_campus
from uavlab.route import Route
from uavlab.scene.content import drawing_of
from uavlab.vehicle import LIGHT_QUADROTOR
from uavlab.weather import Wind

START, GOAL = (90, 18, 30), (20, 75, 75)
CENTER = np.array([50.0, 50.0, 50.0])
"""Of Table 1's map, from where its scene counts."""


@pytest.fixture(scope="module")
def route(table1):
    return astar(table1, START, GOAL, record=True)


def test_page_is_small_and_needs_no_network(table1, route):
    page = scene.page(table1, route, shortcut(route, table1), safe_distance=3.5)
    assert len(page) < 400_000
    assert not re.findall(r'(?:src|href)="(?!data:)', page)
    assert "url(" not in page
    assert len(scene.page(table1, route, expansion=True)) < 400_000


def test_same_scene_gives_the_same_bytes(table1, route):
    assert scene.page(table1, route) == scene.page(table1, route)
    assert scene.show(table1, route).still == scene.show(table1, route).still


def test_what_the_page_holds_is_what_is_drawn_to_half_a_millimetre_of_rounding(table1, route):
    drawing = drawing_of(table1, (route,), safe_distance=3.5)
    commands = commands_of(scene.page(table1, route, safe_distance=3.5))
    for name in ("buildings", "route0", "route0 near", "ground"):
        shown = shapes_of(commands[f"/meshcat/{name}", "set_object"])
        assert np.abs(shown - drawing.near(drawing.parts[name].triangles)).max() <= 0.5 / 512 + 1e-9, name
    edges = shapes_of(commands["/meshcat/edges", "set_object"])
    assert np.abs(edges - drawing.near(drawing.parts["edges"].ends).reshape(-1, 2, 3)).max() <= 0.5 / 512 + 1e-9


def test_buildings_have_their_colours(table1):
    command = commands_of(scene.page(table1))["/meshcat/buildings", "set_object"]
    data = command["object"]["geometries"][0]["data"]
    colors = data["attributes"]["color"]["array"][data["index"]["array"].astype(int).reshape(-1, 3)[:, 0]]
    expected = [to_rgb(b.color) for b in table1.buildings for _ in b.triangles()]
    assert colors == pytest.approx(np.array(expected), abs=0.5 / 255)
    vertices = vertices_of(command) + CENTER
    assert vertices.min(axis=0) == pytest.approx([10, 15, 0])
    assert vertices.max(axis=0) == pytest.approx([95, 95, 99])


def test_uav_flies_through_the_waypoints_in_the_colour_of_its_route(table1, route):
    straight = shortcut(route, table1)
    motion = motion_of(scene.page(table1, straight, safe_distance=3.0))
    (mover,) = motion["movers"]
    assert motion["duration"] == pytest.approx(straight.length / LIGHT_QUADROTOR.cruise_speed, abs=1e-3)
    for waypoint in straight.points:
        assert np.linalg.norm(np.array(mover["points"]) + CENTER - waypoint, axis=1).min() < 1e-3
    assert mover["color"] == plot.styles([straight.planner])[0].color
    body = commands_of(scene.page(table1, straight))["/meshcat/mover0/body", "set_object"]
    assert np.linalg.norm(vertices_of(body)[:, :2], axis=1).max() == pytest.approx(
        LIGHT_QUADROTOR.diameter / 2, rel=0.02
    )


def test_expansion_shows_the_nodes_in_batches_in_their_order(table1, route):
    page = scene.page(table1, route, expansion=True)
    commands, motion = commands_of(page), motion_of(page)
    batches = [vertices_of(commands[f"/meshcat/expanded{n:02d}", "set_object"]) + CENTER for n in range(40)]
    shown = table1.code_of(table1.cell_of(np.concatenate(batches)))
    positions = [np.flatnonzero(route.info["order"] == node)[0] for node in shown[:: len(shown) // 50]]
    assert positions == sorted(positions)
    assert shown[0] == route.info["order"][0]
    since = [motion["since"][f"expanded{n:02d}"] for n in range(40)]
    assert since == sorted(since)
    assert motion["duration"] == len(route.info["order"])
    assert motion["unit"] == "nodes"


def test_names_with_markup_stay_names(route):
    city = City.from_buildings([Building.prism([(0, 0), (9, 0), (9, 9)], 5)], name="<b>Town</b>")
    page = scene.page(city, Route(np.empty((0, 3)), "<i>A*</i>", reached=False, reason="no <free> way"))
    assert "&lt;b&gt;Town" in page
    assert "&lt;i&gt;A*&lt;/i&gt;: doesn&#x27;t arrive, no &lt;free&gt; way" in page
    for tag in ("<b>Town", "<i>A*", "<free>"):
        assert tag not in page


def test_notebook_gets_the_page_a_still_picture_and_words(table1, route):
    shown = scene.show(table1, route)
    data, metadata = shown._repr_mimebundle_()
    assert data["text/plain"] == repr(shown)
    assert data["text/html"].startswith('<div class="uavlab-scene">')  # "<iframe" first makes IPython warn
    png = base64.b64decode(data["image/png"])
    assert png == shown.still
    assert png[25] == 3  # colours by a palette
    assert len(png) < 60_000
    words = metadata["image/png"]["alt"]
    assert "the city of REPARE Table 1" in words
    assert f'"A*: {route.length:.1f} m" (blue, solid)' in words


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"expansion": True}, "expansion needs a first route planned with record=True"),
        ({"safe_distance": 0.0}, "safe_distance must be finite and above 0, got 0"),
        ({"title": 3}, "title must be text, got 3"),
        ({"expansion": "no"}, "expansion must be True or False, got 'no'"),
        ({"start_paused": 1}, "start_paused must be True or False, got 1"),
        ({"start_at": 1e4}, "start_at must be at most .* s, the animation's length, got 10000"),
        ({"start_at": -1}, "start_at must be"),
        ({"camera": "front"}, "camera must be one of"),
        ({"wind": (1, 2)}, "wind must be a Wind, got tuple"),
        ({"uav": None}, "uav must be a UAV, got NoneType"),
        ({"colors": {"A*": "bluish"}}, "must be a colour"),
    ],
)
def test_wrong_question(table1, arguments, message):
    with pytest.raises(ValueError, match=message):
        scene.page(table1, Route(np.array([[1.0, 1, 1], [2, 2, 2]])), **arguments)


def test_a_camera_that_follows_needs_somebody_to_follow(table1):
    with pytest.raises(ValueError, match="camera='chase' follows a UAV: give a route or a flight"):
        scene.page(table1, camera="chase")


@pytest.mark.parametrize("height", [-3, 0, 300.5, "480", True, 10_001])
def test_a_frame_has_a_height_in_pixels(table1, height):
    with pytest.raises(ValueError, match="height must be "):
        scene.show(table1, height=height)


def test_risk_has_a_scale_with_a_tick_at_each_power_of_ten():
    campus = reference_campus()
    page = scene.page(campus.city, risk=campus, slice_height=27.5)
    ticks = {int(power): float(left) for left, power in re.findall(r'left:([\d.]+)%">10<sup>(-?\d+)</sup>', page)}
    norm = plot.risk_norm(campus)
    assert set(ticks) == {-7, -6, -5}
    for power, left in ticks.items():
        assert left == pytest.approx(100 * float(norm(10.0**power)), abs=0.1)
    assert "deaths per hour of flight" in page
    assert "logarithmic scale" in page
    assert len(page) < 450_000


def test_a_map_without_anybody_can_still_be_drawn():
    nobody = RiskMap(City(np.zeros((4, 4, 4), dtype=bool), 5.0), 0.0, 0.0)
    assert "deaths per hour" in scene.page(nobody.city, risk=nobody)
    assert scene.show(nobody.city, risk=nobody).still


def test_a_slice_needs_a_risk_map_and_a_height_on_it(table1):
    with pytest.raises(ValueError, match="slice_height needs risk"):
        scene.page(table1, slice_height=30.0)
    campus = reference_campus()
    with pytest.raises(ValueError, match="slice_height must lie on the map, 0 to 80 m, got 90"):
        scene.page(campus.city, risk=campus, slice_height=90.0)


@pytest.fixture(scope="module")
def crash_and_safe(table1):
    """Two flights of REPARE Fig. 12's pair in offsets of 1 m: A* ends at a wall, REPARE arrives."""
    ends = (90, 18, 30), (50, 44, 30)
    routes = astar(table1, *ends), repare(table1, *ends)
    crash, safe = (fly(route, table1, LIGHT_QUADROTOR, OffsetProcess(1.0), rng=3) for route in routes)
    assert (crash.outcome, safe.outcome) == ("crashed", "arrived")
    return {"A*": crash, "REPARE": safe}


def markers_of(page):
    return [(m["kind"], np.array(m["place"]) + CENTER, m["since"], m["color"]) for m in motion_of(page)["markers"]]


def test_flights_run_by_one_clock_and_a_crash_appears_when_and_where_it_happens(table1, crash_and_safe):
    page = scene.page(table1, flights=crash_and_safe)
    motion, crash, safe = motion_of(page), *crash_and_safe.values()
    assert motion["duration"] == pytest.approx(safe.duration, abs=1e-3)
    assert [mover["time"][-1] for mover in motion["movers"]] == pytest.approx([crash.duration, safe.duration], abs=1e-3)
    ((_, place, since, color),) = [marker for marker in markers_of(page) if marker[0] == "crash"]
    assert place == pytest.approx(crash.position[-1], abs=0.01)
    assert since == pytest.approx(crash.duration, abs=1e-3)
    assert color == plot.CRASH_COLOR
    missed = [marker for marker in markers_of(page) if marker[0] == "missed"]
    assert [marker[1] for marker in missed] == [pytest.approx(crash.goal, abs=0.01)]
    goals = [marker for marker in markers_of(page) if marker[0] == "goal"]
    assert [marker[1] for marker in goals] == [pytest.approx(safe.position[-1], abs=0.01)]


def test_a_flight_looks_like_its_route_which_is_thinner(table1, crash_and_safe):
    route = astar(table1, (90, 18, 30), (50, 44, 30))
    drawing = drawing_of(table1, (route,), flights=crash_and_safe)
    assert drawing.parts["route0"].color == drawing.parts["flight0"].color == plot.BLUE

    def radius(part):
        return np.linalg.norm(part.triangles[0, 0] - route.points[0])

    alone = drawing_of(table1, (route,))
    assert radius(drawing.parts["route0"]) == pytest.approx(0.4 * radius(alone.parts["route0"]), rel=1e-3)
    assert len(drawing.movers) == 2  # nobody flies the route
    assert len(scene.page(table1, route, flights=crash_and_safe)) < 450_000


def test_colours_asked_for_are_those_of_tube_uav_and_legend(table1, route):
    page = scene.page(table1, {"mine": route}, colors={"mine": plot.GREEN})
    (material,) = commands_of(page)["/meshcat/route0", "set_object"]["object"]["materials"]
    assert material["color"] == int(plot.GREEN[1:], 16)
    assert motion_of(page)["movers"][0]["color"] == plot.GREEN
    assert f'style="color:{plot.GREEN}"' in page


def test_legend_says_what_became_of_each_flight(table1, crash_and_safe):
    page = scene.page(table1, flights=crash_and_safe)
    crash, safe = crash_and_safe.values()
    assert f"A*: crashed after {crash.duration:.1f} s" in page
    assert f"REPARE: arrived after {safe.duration:.1f} s" in page
    assert "flight 2: arrived" in scene.page(table1, flights=list(crash_and_safe.values()))
    assert "<span>crash</span>" in page
    assert "<span>crash</span>" not in scene.page(table1, flights=[safe])


def test_grounded_flight_is_named_and_not_drawn(table1, route):
    grounded = fly(route, table1, LIGHT_QUADROTOR, Wind((40.0, 0.0)), rng=1)
    page = scene.page(table1, flights={"A*": grounded})
    assert "A*: grounded" in page
    assert not motion_of(page)["movers"]
    assert scene.show(table1, flights=[grounded]).still


def test_a_route_that_is_trapped_says_where_it_stopped_and_where_it_should_be(table1):
    trapped = potential_field(table1, (90, 18, 30), (50, 44, 30))
    assert not trapped.reached
    found = {kind: place for kind, place, _, _ in markers_of(scene.page(table1, trapped))}
    assert found["stopped"] == pytest.approx(trapped.points[-1], abs=0.01)
    assert found["missed"] == pytest.approx([50, 44, 30], abs=0.51)
    assert "goal" not in found


def test_flights_that_are_none_are_refused(table1, route, crash_and_safe):
    with pytest.raises(ValueError, match="flights must be a list of Flight, or Flight by name, got Flight"):
        scene.page(table1, flights=crash_and_safe["A*"])
    with pytest.raises(ValueError, match="flights must be a Flight, got Route"):
        scene.page(table1, flights=[route])
    with pytest.raises(ValueError, match="two animations"):
        scene.page(table1, route, expansion=True, flights=crash_and_safe)


def test_large_ground_is_thinned_out_and_small():
    ground = np.random.default_rng(1).uniform(0, 20, (500, 300))
    city = City(np.zeros((500, 300, 30), dtype=bool), 1.0, ground=ground)
    page = scene.page(city)
    assert len(vertices_of(commands_of(page)["/meshcat/ground", "set_object"])) == (MOST_QUADS + 1) ** 2
    assert len(page) < 550_000  # no two heights are alike


def test_far_off_maps_are_drawn_as_exactly_as_near_ones():
    """float32 has steps of half a metre at 5 000 km."""

    def town(shift):
        house = Building.prism(np.array([(5.2, 10.1), (30.3, 10.1), (30.3, 40.7)]) + shift[:2], 12.3)
        zone = NoFlyZone(np.array([(50.1, 50.3), (60, 50), (60, 60)]) + shift[:2])
        ground = np.linspace(0, 3, 100).reshape(10, 10)
        return City(np.zeros((10, 10, 8), dtype=bool), 8.0, shift, (house,), ground=ground, no_fly=(zone,))

    shift = np.array([3_000_000.0, 5_000_000.0, 0.0])
    route = np.array([[2.2, 2.3, 20.1], [40.4, 70.7, 30.3]])
    near, far = (
        scene.page(town(move), Route(route + move), safe_distance=2.0, wind=Wind((3, 1))) for move in (0 * shift, shift)
    )
    commands = commands_of(near), commands_of(far)
    assert commands[0].keys() == commands[1].keys()
    for path, kind in commands[0]:
        if kind == "set_object":
            ones, others = (np.unique(vertices_of(c[path, kind]), axis=0) for c in commands)
            assert len(ones) == len(others), path
            assert ones.min(axis=0) == pytest.approx(others.min(axis=0), abs=0.002), path
            assert ones.max(axis=0) == pytest.approx(others.max(axis=0), abs=0.002), path
    (one,), (other,) = motion_of(near)["movers"], motion_of(far)["movers"]
    assert np.allclose(one["points"], other["points"], atol=0.002)


def test_route_that_stays_where_it_is_can_be_drawn(table1):
    hover = Route([(1, 1, 1), (1, 1, 1)])
    page = scene.page(table1, hover, Route([(5, 5, 5)], "a point"))
    assert ("/meshcat/route0", "set_object") not in commands_of(page)
    assert [kind for kind, *_ in markers_of(page)].count("start") == 2
    assert scene.show(table1, hover).still


@pytest.mark.parametrize("kind", [np.int64, np.float32, int])
def test_safe_distance_of_any_kind_of_number(table1, route, kind):
    assert scene.page(table1, route, safe_distance=kind(3)) == scene.page(table1, route, safe_distance=3.0)
    for wrong in (kind(0), np.inf, np.nan, "3"):
        with pytest.raises(ValueError, match="safe_distance must be"):
            scene.page(table1, route, safe_distance=wrong)


def test_names_may_look_like_tex(table1, route):
    page = scene.page(table1, Route(route.points, r"$\foo$"))
    assert r"$\foo$: " in page
    assert scene.show(table1, Route(route.points, r"$\foo$")).still


def test_a_title_is_text(table1):
    page = scene.page(table1, title="</title><script>alert(1)</script>")
    assert "<script>alert(1)" not in page
    assert "&lt;/title&gt;&lt;script&gt;alert(1)" in page


def test_a_city_of_many_buildings_is_one_mesh():
    rng = np.random.default_rng(0)
    corners = rng.uniform(0, 1950, (1500, 2))
    houses = [
        Building.prism([(x, y), (x + 20, y), (x + 20, y + 15), (x, y + 15)], height)
        for (x, y), height in zip(corners, rng.uniform(5, 40, 1500), strict=True)
    ]
    city = City(np.zeros((40, 40, 4), dtype=bool), 50.0, buildings=tuple(houses))
    page = scene.page(city)
    assert len(page) < 900_000
    assert len(shapes_of(commands_of(page)["/meshcat/buildings", "set_object"])) == 12 * 1500


def colors_in(figure):
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=100)
    buffer.seek(0)
    return matplotlib.image.imread(buffer)[..., :3]


def test_a_still_shows_the_crash_from_its_moment_on(table1, crash_and_safe):
    crash = crash_and_safe["A*"]
    red = np.array(to_rgb(plot.CRASH_COLOR))
    shares = []
    for moment in (crash.duration - 0.5, crash.duration):
        figure = scene.still(table1, flights=crash_and_safe, start_at=moment)
        picture = colors_in(figure)[: figure.axes[0].get_window_extent().height.astype(int)]
        shares.append((np.abs(picture - red).max(axis=-1) < 0.1).sum())
    assert shares[0] < shares[1]
    names = [text.get_text() for text in figure.legends[0].get_texts()]
    assert names[0] == f"A*: crashed after {crash.duration:.1f} s"
    assert names[-4:] == ["start", "goal", "goal not reached", "crash"]


def test_a_still_has_a_title_and_the_scale_of_its_colours(table1, route):
    campus = reference_campus()
    figure = scene.still(campus.city, risk=campus)
    assert figure.axes[0].get_title() == "Reference campus"
    assert "deaths per hour" in figure.axes[1].get_xlabel()
    search = scene.still(table1, route, expansion=True)
    assert search.axes[1].get_xlabel() == "order in which nodes were expanded"
    assert ZONE_COLOR not in LINES


def test_north_is_up_from_above_and_the_scale_bar_has_its_length(table1):
    figure = scene.still(table1, camera="above")
    axes = figure.axes[0]
    (arrow,) = [note for note in axes.texts if hasattr(note, "arrow_patch")]
    (x, y), (tail_x, tail_y) = arrow.xy, arrow.xyann
    assert x == pytest.approx(tail_x)
    assert y < tail_y  # rows are counted downwards
    bar = next(line for line in axes.lines if line.get_color() == "#222222").get_xdata()
    text = next(note.get_text() for note in axes.texts if note.get_text().endswith(" m"))
    marked = scene.still(table1, Route([(10, 50, 50), (60, 50, 50)], "fifty metres"), camera="above").axes[0]
    ends = [line.get_xdata()[0] for line in marked.lines if line.get_marker() in ("o", "^")][:2]
    pixels_per_metre = abs(ends[1] - ends[0]) / 50
    assert np.ptp(bar) / float(text[:-2]) == pytest.approx(pixels_per_metre, rel=0.01)  # at the height of its middle
