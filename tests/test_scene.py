"""Scenes: what the page holds, how large it is, and that the same scene gives the same bytes."""

import base64
import gzip
import re

import numpy as np
import pytest
import umsgpack

from uavlab import plot, scene
from uavlab.city import Building, City, NoFlyZone
from uavlab.flight import OffsetProcess, fly
from uavlab.planners import astar, repare, shortcut
from uavlab.plot.ground import MOST_QUADS, ZONE_COLOR
from uavlab.risk import RiskMap, reference_campus
from uavlab.route import Route
from uavlab.scene.animation import FLIGHT_SECONDS, FRAMES_PER_SECOND, LAST_FRAME
from uavlab.scene.shapes import tube
from uavlab.vehicle import LIGHT_QUADROTOR
from uavlab.weather import Wind

START, GOAL = (90, 18, 30), (20, 75, 75)


@pytest.fixture(scope="module")
def route(table1):
    return astar(table1, START, GOAL, record=True)


def commands_of(page):
    """The commands that meshcat's viewer gets, by path and type."""
    packed = gzip.decompress(base64.b64decode(re.findall(r'unpack\("([^"]+)"\)', page)[1]))
    commands = {}
    while packed:
        length = int.from_bytes(packed[:4], "big")
        command = umsgpack.unpackb(packed[4 : 4 + length])
        commands[command["path"], command["type"]] = command
        packed = packed[4 + length :]
    return commands


def vertices_of(command):
    attribute = command["object"]["geometries"][0]["data"]["attributes"]["position"]
    return np.frombuffer(bytes(attribute["array"].data), dtype=np.float32).reshape(-1, 3)


def test_page_is_small_and_needs_no_network(table1, route):
    page = scene.page(table1, route, shortcut(route, table1), safe_distance=3.5)
    assert len(page) < 400_000
    assert "src=" not in page.split("<script>")[0]
    assert len(scene.page(table1, route, expansion=True)) < 400_000


def test_same_scene_gives_the_same_bytes(table1, route):
    assert scene.page(table1, route) == scene.page(table1, route)


def test_all_buildings_are_one_mesh_that_spans_them(table1):
    commands = commands_of(scene.page(table1))
    vertices = vertices_of(commands["/meshcat/city/buildings", "set_object"])
    assert vertices.min(axis=0) == pytest.approx([10, 15, 0])
    assert vertices.max(axis=0) == pytest.approx([95, 95, 99])
    assert sum(path.startswith("/meshcat/city") for path, kind in commands if kind == "set_object") == 2


def test_uav_visits_the_waypoints_in_order_at_constant_speed(table1, route):
    straight = shortcut(route, table1)
    animation = commands_of(scene.page(table1, straight))["", "set_animation"]["animations"]
    (clip,) = [entry["clip"] for entry in animation if entry["path"] == "/meshcat/uav"]
    keys = next(track["keys"] for track in clip["tracks"] if track["name"] == ".position")
    assert np.array([key["value"] for key in keys]) == pytest.approx(straight.points)
    frames = np.array([key["time"] for key in keys])
    assert frames / frames[-1] == pytest.approx(straight.distance / straight.length, abs=1 / frames[-1])


def test_expansion_shows_the_nodes_in_batches_in_their_order(table1, route):
    commands = commands_of(scene.page(table1, route, expansion=True))
    batches = [vertices_of(commands[f"/meshcat/expansion/batch{n}", "set_object"]) for n in range(40)]
    shown = table1.code_of(table1.cell_of(np.concatenate(batches)))
    positions = [np.flatnonzero(route.info["order"] == node)[0] for node in shown[:: len(shown) // 50]]
    assert positions == sorted(positions)
    assert shown[0] == route.info["order"][0]


def test_tube_surrounds_the_polyline():
    points = np.array([[0.0, 0, 0], [0, 0, 5], [4, 0, 5]])
    corners = tube(points, 0.5).reshape(-1, 3)
    distance = np.minimum(
        np.linalg.norm(corners - np.clip(corners, points[0], points[1]), axis=1),
        np.linalg.norm(corners - np.clip(corners, points[1], points[2]), axis=1),
    )
    assert distance.max() <= 0.5 + 1e-9
    assert (distance > 0.4).any()


def test_legend_names_the_city_and_escapes_it(route):
    city = City.from_buildings([Building.prism([(0, 0), (9, 0), (9, 9)], 5)], name="<b>Town</b>")
    page = scene.page(city, Route(np.empty((0, 3)), "A*", reached=False, reason="no free way"))
    assert "&lt;b&gt;Town" in page
    assert "A*: no free way" in page


def test_notebook_gets_the_page_and_a_still_picture(table1, route):
    shown = scene.show(table1, route)
    bundle = shown._repr_mimebundle_()
    assert bundle["text/plain"] == repr(shown)
    assert bundle["text/html"].startswith('<div class="uavlab-scene">')  # "<iframe" first makes IPython warn
    assert base64.b64decode(bundle["image/png"]).startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"expansion": True}, "expansion needs a first route planned with record=True"),
        ({"safe_distance": 0.0}, "safe_distance must be finite and above 0, got 0"),
        ({"title": 3}, "title must be text, got 3"),
        ({"expansion": "no"}, "expansion must be True or False, got 'no'"),
    ],
)
def test_wrong_question(table1, arguments, message):
    with pytest.raises(ValueError, match=message):
        scene.page(table1, Route(np.array([[1.0, 1, 1], [2, 2, 2]])), **arguments)


@pytest.mark.parametrize("height", [-3, 0, 300.5, "480", True, 10_001])
def test_a_frame_has_a_height_in_pixels(table1, height):
    with pytest.raises(ValueError, match="height must be "):
        scene.show(table1, height=height)


def colors_of(command):
    attribute = command["object"]["geometries"][0]["data"]["attributes"]["color"]
    return np.frombuffer(bytes(attribute["array"].data), dtype=np.float32).reshape(-1, 3)


def test_risk_paints_the_ground_and_a_slice_on_one_scale_with_a_color_bar():
    campus = reference_campus()
    page = scene.page(campus.city, risk=campus, slice_height=27.5)
    commands = commands_of(page)
    ground, cut = (commands[f"/meshcat/risk/{name}", "set_object"] for name in ("ground", "slice"))
    assert len(vertices_of(ground)) == 6 * 30 * 30
    assert len(vertices_of(cut)) == 6 * np.count_nonzero(campus.flyable[:, :, 5])  # buildings are left out
    assert np.allclose(vertices_of(cut)[:, 2], 27.5)
    lightness = colors_of(ground).sum(axis=1)[::6].reshape(30, 30)
    assert lightness[28, 28] > lightness[2, 2] + 0.5  # the crowded square against the park
    assert "linear-gradient" in page
    assert "deaths per hour of flight (logarithmic scale)" in page
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


def keys_of(commands, path, name):
    """Frames and values of an animation's track."""
    animation = commands["", "set_animation"]["animations"]
    (clip,) = [entry["clip"] for entry in animation if entry["path"] == path]
    keys = next(track["keys"] for track in clip["tracks"] if track["name"] == name)
    return np.array([key["time"] for key in keys]), [key["value"] for key in keys]


def test_flights_run_by_one_clock_in_proportion_of_time(table1, crash_and_safe):
    commands = commands_of(scene.page(table1, flights=crash_and_safe))
    longest = max(flight.duration for flight in crash_and_safe.values())
    for number, flight in enumerate(crash_and_safe.values()):
        frames, places = keys_of(commands, f"/meshcat/flight{number}/uav", ".position")
        shown = frames[:-1] / (FLIGHT_SECONDS * FRAMES_PER_SECOND) * longest
        steps = np.searchsorted(flight.time, shown - 1e-9)
        frame = longest / (FLIGHT_SECONDS * FRAMES_PER_SECOND)
        gap = np.linalg.norm(flight.position[np.minimum(steps, len(flight.log) - 1)] - places[:-1], axis=1)
        assert gap.max() < 8.0 * frame + 0.2  # half a frame's rounding at 5 m/s and what gusts add
        assert places[-2] == pytest.approx(flight.position[-1])
        assert places[-1] == places[-2]  # it stays where it ended
        assert frames[-1] == LAST_FRAME  # all begin again together
        assert np.allclose(vertices_of(commands[f"/meshcat/flight{number}/tube", "set_object"])[0], places[0], atol=1.0)


def test_crash_is_a_cross_that_appears_when_and_where_it_happens(table1, crash_and_safe):
    commands = commands_of(scene.page(table1, flights=crash_and_safe))
    crash = crash_and_safe["A*"]
    beams = vertices_of(commands["/meshcat/flight0/crash", "set_object"])
    assert (beams.min(axis=0) + beams.max(axis=0)) / 2 == pytest.approx(crash.position[-1], abs=0.1)
    frames, visible = keys_of(commands, "/meshcat/flight0/crash", ".visible")
    longest = max(flight.duration for flight in crash_and_safe.values())
    moment = crash.duration / longest * FLIGHT_SECONDS * FRAMES_PER_SECOND
    assert visible == [False, True, True]
    assert frames.tolist() == [0, pytest.approx(moment, abs=0.51), LAST_FRAME]
    assert not any("flight1/crash" in path for path, _ in commands)
    assert ("/meshcat/flight1/goal", "set_object") in commands
    assert ("/meshcat/flight0/goal", "set_object") not in commands


def test_routes_are_thin_beside_flights_and_nobody_flies_them(table1, route, crash_and_safe):
    def radius(page):
        first_ring = vertices_of(commands_of(page)["/meshcat/route0/tube", "set_object"])[:2]
        return np.linalg.norm(first_ring - route.points[0], axis=1)

    page = scene.page(table1, route, flights=crash_and_safe)
    assert radius(page) == pytest.approx(0.4 * radius(scene.page(table1, route)), rel=1e-3)
    assert len(page) < 600_000
    assert not any(path.startswith("/meshcat/uav") for path, _ in commands_of(page))


def test_legend_says_what_became_of_each_flight(table1, crash_and_safe):
    page = scene.page(table1, flights=crash_and_safe)
    crash, safe = crash_and_safe.values()
    assert f"A*: crashed after {crash.duration:.1f} s" in page
    assert f"REPARE: arrived after {safe.duration:.1f} s" in page
    assert f"12 s show {safe.duration:.1f} s of flight" in page
    assert "flight 2: arrived" in scene.page(table1, flights=list(crash_and_safe.values()))
    assert "crash</" not in scene.page(table1, flights=[safe])
    assert scene.show(table1, flights=crash_and_safe).still.startswith(b"\x89PNG")


def test_grounded_flight_is_named_and_not_drawn(table1, route):
    grounded = fly(route, table1, LIGHT_QUADROTOR, Wind((40.0, 0.0)), rng=1)
    page = scene.page(table1, flights={"A*": grounded})
    assert "A*: grounded" in page
    assert not any(path.startswith("/meshcat/flight") for path, _ in commands_of(page))
    assert scene.show(table1, flights=[grounded]).still


def test_flights_that_are_none_are_refused(table1, route, crash_and_safe):
    with pytest.raises(ValueError, match="flights must be a list of Flight, or Flight by name, got Flight"):
        scene.page(table1, flights=crash_and_safe["A*"])
    with pytest.raises(ValueError, match="flights must be a Flight, got Route"):
        scene.page(table1, flights=[route])
    with pytest.raises(ValueError, match="two animations"):
        scene.page(table1, route, expansion=True, flights=crash_and_safe)


@pytest.fixture(scope="module")
def hill():
    """Ground that rises to 20 m in the middle, a house, and two no-fly zones."""
    x, y = np.meshgrid(np.arange(30) - 14.5, np.arange(20) - 9.5, indexing="ij")
    house = Building.prism([(12, 12), (24, 12), (24, 24), (12, 24)], 10)
    zones = (
        NoFlyZone([(70, 20), (90, 20), (90, 30)], 0.0, 20.0, name="<school>"),
        NoFlyZone([(20, 50), (30, 50), (30, 60), (20, 60)], 10.0, name="church"),
    )
    grid, ground = np.zeros((30, 20, 15), dtype=bool), 20 * np.exp(-(x**2 + y**2) / 30)
    return City(grid, 4.0, buildings=(house,), name="hill", ground=ground, no_fly=zones)


def test_ground_is_one_mesh_at_its_heights_with_a_grid_on_it(hill):
    commands = commands_of(scene.page(hill))
    ground = commands["/meshcat/ground", "set_object"]
    vertices = vertices_of(ground)
    assert len(vertices) == 31 * 21
    assert np.abs(hill.height_above_ground(vertices)).max() <= 1 / 512
    assert ground["object"]["materials"][0]["type"] == "MeshLambertMaterial"
    lines = vertices_of(commands["/meshcat/grid", "set_object"])
    lift = 0.002 * np.hypot(120, 80)
    assert hill.height_above_ground(lines) == pytest.approx(np.full(len(lines), lift), abs=1e-4)
    assert len(lines) > 2 * 20 * 5
    assert "ground at z = 0 to 20 m" in scene.page(hill)


def test_large_ground_is_thinned_out():
    ground = np.random.default_rng(1).uniform(0, 20, (500, 300))
    city = City(np.zeros((500, 300, 30), dtype=bool), 1.0, ground=ground)
    page = scene.page(city)
    assert len(vertices_of(commands_of(page)["/meshcat/ground", "set_object"])) == (MOST_QUADS + 1) ** 2
    assert len(page) < 650_000


def test_risk_is_painted_on_the_ground_in_place_of_it(hill):
    commands = commands_of(scene.page(hill, risk=RiskMap(hill, 1e-3, 0.5), slice_height=np.int64(30)))
    painted = vertices_of(commands["/meshcat/risk/ground", "set_object"])
    assert hill.height_above_ground(painted) == pytest.approx(np.full(len(painted), 0.04), abs=1e-4)
    assert np.ptp(painted[:, 2]) > 15
    assert ("/meshcat/ground", "set_object") not in commands
    assert np.allclose(vertices_of(commands["/meshcat/risk/slice", "set_object"])[:, 2], 30.0)


def test_no_fly_zones_are_one_mesh_to_look_through_and_one_line_of_the_legend(hill):
    page = scene.page(hill)
    commands = commands_of(page)
    walls = commands["/meshcat/no_fly/walls", "set_object"]
    material = walls["object"]["materials"][0]
    assert (material["transparent"], material["depthWrite"]) == (True, False)
    assert material["opacity"] < 0.5
    vertices = vertices_of(walls)
    assert vertices.min(axis=0)[:2] == pytest.approx([20, 20])
    assert vertices.max(axis=0) == pytest.approx([90, 60, 60])  # the church's zone has no upper limit
    assert page.count("no-fly zones: &lt;school&gt;, church") == 1
    assert ZONE_COLOR not in plot.route_colors(6)
    assert "no-fly" not in scene.page(City(hill.occupied, 4.0))


def test_far_off_maps_are_drawn_as_exactly_as_near_ones(crash_and_safe):
    """float32 has steps of half a metre at 5 000 km."""

    def town(shift):
        house = Building.prism(np.array([(5.2, 10.1), (30.3, 10.1), (30.3, 40.7)]) + shift[:2], 12.3)
        zone = NoFlyZone(np.array([(50.1, 50.3), (60, 50), (60, 60)]) + shift[:2])
        ground = np.linspace(0, 3, 100).reshape(10, 10)
        grid = np.zeros((10, 10, 8), dtype=bool)
        return City(grid, 8.0, np.asarray(shift), (house,), ground=ground, no_fly=(zone,))

    shift = np.array([3_000_000.0, 5_000_000.0, 0.0])
    route = Route(np.array([[2.2, 2.3, 20.1], [40.4, 70.7, 30.3]]))
    near = commands_of(scene.page(town(0 * shift), route, safe_distance=2.0))
    far = commands_of(scene.page(town(shift), Route(route.points + shift), safe_distance=2.0))
    assert near.keys() == far.keys()
    for path, kind in near:
        if kind == "set_object" and "attributes" in near[path, kind]["object"]["geometries"][0].get("data", {}):
            assert vertices_of(far[path, kind]) == pytest.approx(vertices_of(near[path, kind]), abs=2e-5), path
        elif kind == "set_transform":
            assert far[path, kind]["matrix"] == pytest.approx(near[path, kind]["matrix"], abs=1e-6), path
    places = [keys_of(commands, "/meshcat/uav", ".position")[1] for commands in (near, far)]
    assert np.allclose(*places, atol=1e-6)


def test_route_that_stays_where_it_is_can_be_drawn(table1):
    hover = Route([(1, 1, 1), (1, 1, 1)])
    commands = commands_of(scene.page(table1, hover))
    assert ("/meshcat/route0/start", "set_object") in commands
    assert ("/meshcat/route0/tube", "set_object") not in commands
    assert scene.show(table1, hover).still
    assert len(plot.stills.ribbons(np.array([[0.0, 0, 0], [0, 0, 0], [1, 0, 0]]), 0.1)) == 4


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


def test_the_goal_s_cone_is_at_the_goal_and_the_ball_at_the_start(table1, route):
    commands = commands_of(scene.page(table1, route))
    places = {}
    for name in ("start", "goal"):
        matrix = np.array(commands[f"/meshcat/route0/{name}", "set_transform"]["matrix"]).reshape(4, 4, order="F")
        places[name] = matrix[:3, 3]
    assert places["start"] == pytest.approx(route.points[0], abs=1e-4)
    assert places["goal"][:2] == pytest.approx(route.points[-1][:2], abs=1e-4)
    assert 0 < route.points[-1][2] - places["goal"][2] < 3


def test_the_legend_has_each_route_in_the_colour_that_it_is_drawn_in(table1, route):
    straight = shortcut(route, table1)
    page = scene.page(table1, route, straight)
    commands = commands_of(page)
    for number, name in enumerate((route.planner, straight.planner)):
        (material,) = commands[f"/meshcat/route{number}/tube", "set_object"]["object"]["materials"]
        named = re.search(rf'<span style="color:(#\w+)">[^<]*</span> {re.escape(name)}: ', page)[1]
        assert int(named[1:], 16) == material["color"]


def test_a_title_is_text(table1):
    page = scene.page(table1, title="</title><script>alert(1)</script>")
    assert "<script>alert(1)" not in page
    assert "&lt;/title&gt;&lt;script&gt;alert(1)" in page
