"""Where home and waypoints are on the Earth and how high, against pyproj; both ends, the way home, and refusals."""

from dataclasses import replace

import numpy as np
import pyproj
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from missions import (
    CENTIMETRE,
    DELFT,
    FOOT,
    LAYOUT,
    ROOF,
    WGS84,
    apart,
    campus,
    cityjson_town,
    geojson_town,
    hills,
    placed,
    samples,
    table1,
    way,
)

from uavlab.city import Building, City, NoFlyZone, Place, Terrain
from uavlab.mission import Item, Mission
from uavlab.mission.items import LAND, LOITER, RETURN, WAYPOINT
from uavlab.mission.making import heading, place_of_origin
from uavlab.planners import astar, least_risk
from uavlab.risk import CAMPUS_FLIGHT, reference_campus
from uavlab.route import Route
from uavlab.vehicle import LIGHT_QUADROTOR, RISK_QUADROTOR

pytestmark = pytest.mark.filterwarnings("ignore:.*:UserWarning")

US_FOOT = 1200 / 3937
NAMES = "ABCDE"

SYSTEMS = {
    "Netherlands": ("EPSG:7415", "EPSG:28992", {"corner": (84_616.5, 447_423.0)}),
    "Germany": ("EPSG:25832", "EPSG:25832", {"corner": (565_000.0, 5_934_000.0)}),
    "New York": ("EPSG:2263", "EPSG:2263", {"corner": (981_000.0, 195_000.0), "unit": US_FOOT, "height_unit": US_FOOT}),
    "ellipsoidal": ("EPSG:4979", "EPSG:4326", {"corner": (9.9937, 53.5511), "degrees": True}),
    "Fiji": ("EPSG:4979", "EPSG:4326", {"corner": (179.9955, -17.7), "degrees": True}),
}
"""Of the file, of its plane, and where the town lies in it."""


@pytest.fixture(scope="module")
def towns(tmp_path_factory):
    folder = tmp_path_factory.mktemp("towns")
    found = {
        name: cityjson_town(folder / f"{name}.city.json", crs, **options) for name, (crs, _, options) in SYSTEMS.items()
    }
    found["WGS-84"] = geojson_town(folder / "berlin.geojson", (13.3777, 52.5163))
    found["Quito"] = geojson_town(folder / "quito.geojson", (-78.4678, -0.1807))
    return found


def by_pyproj(name, town):
    """Longitudes and latitudes of the landmarks, from the file's own coordinates."""
    system = SYSTEMS[name][1] if name in SYSTEMS else "OGC:CRS84"
    to_degrees = pyproj.Transformer.from_crs(system, "EPSG:4326", always_xy=True)
    return {landmark: to_degrees.transform(*xy) for landmark, xy in town.source.items()}


def farthest(mission, expected):
    """Of the first items from where they should be [m]."""
    items = placed(mission)[: len(NAMES)]
    return max(apart(item, expected[name]) for item, name in zip(items, NAMES, strict=True))


EVERYWHERE = [*SYSTEMS, "WGS-84", "Quito"]


@pytest.mark.parametrize("name", EVERYWHERE)
def test_waypoints_are_where_pyproj_has_them(towns, name):
    town, expected = towns[name], by_pyproj(name, towns[name])
    assert np.ptp([*expected.values()], axis=0).max() > 0.008  # degrees: about a kilometre
    mission = Mission.from_route(town.route(), town.city, RISK_QUADROTOR)
    assert farthest(mission, expected) < CENTIMETRE
    home = mission.home.longitude, mission.home.latitude
    assert abs(WGS84.inv(*home, *expected["A"])[2]) < CENTIMETRE
    for before, after in zip(placed(mission)[:-1], placed(mission)[1:], strict=True):  # true north
        azimuth = WGS84.inv(before.longitude, before.latitude, after.longitude, after.latitude)[0]
        assert (before.parameters[3] - azimuth + 180) % 360 - 180 == pytest.approx(0.0, abs=0.02)


@pytest.mark.parametrize("name", EVERYWHERE)
@pytest.mark.parametrize("altitudes", ["home", "terrain"])
def test_the_height_of_home_above_the_sea_moves_nothing(towns, name, altitudes):
    """Metres of the map are those at the height of its own place, whatever is known of the sea."""
    town, expected = towns[name], by_pyproj(name, towns[name])
    mission = Mission.from_route(
        town.route(), town.city, RISK_QUADROTOR, home=(*expected["A"], 2850.0), altitudes=altitudes
    )
    assert farthest(mission, expected) < CENTIMETRE
    points = town.route().points
    assert way(mission, town.city) == pytest.approx(points, abs=2 * CENTIMETRE)
    fence = np.array(mission.fence[0].corners)[:, ::-1]
    plain = Mission.from_route(town.route(), town.city, RISK_QUADROTOR, altitudes=altitudes)
    assert fence == pytest.approx(np.array(plain.fence[0].corners)[:, ::-1], abs=2e-7)


@pytest.mark.parametrize("name", ["Netherlands", "New York", "WGS-84"])
def test_a_turn_of_eight_tenths_of_a_degree_is_noticed(towns, name):
    """That of the Dutch grid in Delft; else these tests would be none."""
    town, expected = towns[name], by_pyproj(name, towns[name])
    turn = np.radians(0.8)
    rotation = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    turned = Route(town.route().points @ rotation.T)
    mission = Mission.from_route(turned, town.city, RISK_QUADROTOR)
    assert farthest(mission, expected) == pytest.approx(1300 * np.sin(turn), rel=0.1)
    moved = Route(town.route().points + np.array([0.02, 0.0, 0.0]))
    assert farthest(Mission.from_route(moved, town.city, RISK_QUADROTOR), expected) > CENTIMETRE


@pytest.mark.parametrize("height", [0.0, 420.0, 2850.0])
def test_of_a_city_without_a_place_home_says_where_it_is(towns, height):
    town = towns["Germany"]
    nowhere = replace(town.city, reference=None)
    home = (8.5417, 47.3769, height)
    mission = Mission.from_route(town.route("EBCDA"), nowhere, RISK_QUADROTOR, home=home)
    assert apart(placed(mission)[0], home[:2]) < CENTIMETRE
    start = town.over("E")
    for item, name in zip(placed(mission), "EBCDA", strict=True):
        east, north = (town.over(name) - start)[:2]
        azimuth, _, distance = WGS84.inv(*home[:2], item.longitude, item.latitude)
        at_height = np.hypot(east, north) * (1 - height / 6.37e6)
        assert distance == pytest.approx(at_height, abs=2 * CENTIMETRE)
        if name != "E":
            assert azimuth % 360 == pytest.approx(heading(np.zeros(3), town.over(name) - start), abs=0.02)
    assert way(mission, nowhere) == pytest.approx(town.route("EBCDA").points, abs=2 * CENTIMETRE)
    assert mission.home.height == height


@pytest.mark.parametrize("longitude", [0.0, 8.5, 179.9999, -180.0])
@pytest.mark.parametrize("latitude", [-70.0, 0.0, 47.0])
def test_the_origin_is_where_home_has_its_coordinates(longitude, latitude):
    where, xy = Place(longitude, latitude, 700.0), np.array([1500.0, -2500.0])
    origin = place_of_origin(where, xy)
    assert origin.east_north((longitude, latitude)) == pytest.approx(xy, abs=1e-3)


def test_altitudes_above_home_sea_and_ground(towns):
    """Heights of the file are above the sea; it is level there at the lowest foot but for the houses."""
    town = towns["Netherlands"]
    assert town.city.source.heights == "above sea"
    missions = {
        above: Mission.from_route(town.route(), town.city, RISK_QUADROTOR, altitudes=above)
        for above in ("home", "sea", "terrain")
    }
    for above, frame in (("home", 3), ("sea", 0), ("terrain", 10)):
        mission = missions[above]
        assert mission.altitudes == above
        for item, name in zip(placed(mission), NAMES, strict=True):
            over_sea = FOOT[name] + ROOF[name] + 40.0
            expected = {"home": over_sea - FOOT["A"] - ROOF["A"], "sea": over_sea, "terrain": 40.0 + ROOF[name]}[above]
            assert item.frame == frame
            assert item.altitude == pytest.approx(expected, abs=0.05 if above == "terrain" else 2e-3)
        assert mission.home.height == pytest.approx(FOOT["A"] + ROOF["A"], abs=2e-3)  # on a roof
        assert mission.heights == "above sea"
        assert mission.notes == ()
    landing = {above: placed(mission, LAND)[0].altitude for above, mission in missions.items()}
    on_roof = FOOT["E"] + ROOF["E"]
    assert landing["sea"] == pytest.approx(on_roof, abs=2e-3)
    assert landing["home"] == pytest.approx(on_roof - FOOT["A"] - ROOF["A"], abs=2e-3)
    assert landing["terrain"] == pytest.approx(ROOF["E"], abs=0.05)


def test_altitudes_in_feet(tmp_path):
    town = cityjson_town(
        tmp_path / "york.city.json", "EPSG:2263+6360", (981_000.0, 195_000.0), unit=US_FOOT, height_unit=US_FOOT
    )
    assert town.city.source.heights == "above sea"
    mission = Mission.from_route(town.route(), town.city, RISK_QUADROTOR, altitudes="sea")
    for item, name in zip(placed(mission), NAMES, strict=True):
        assert item.altitude == pytest.approx(FOOT[name] + ROOF[name] + 40.0, abs=2e-3)


def test_altitudes_above_the_sea_from_geojson(tmp_path):
    town = geojson_town(tmp_path / "town.geojson", (13.3777, 52.5163), heights_above="sea", base=0.0)
    assert town.city.source.heights == "above sea"
    mission = Mission.from_route(
        Route([(20, -15, 50), (600, -15, 50)]), town.city, RISK_QUADROTOR, altitudes="sea", end="stay"
    )
    zero = town.city.reference.height
    assert placed(mission)[0].altitude == pytest.approx(50.0 + zero, abs=2e-3)


SLOPE = Terrain.from_raster([[5.0 + 0.1 * x for x in range(5, 200, 10)]] * 20, (0, 0, 200, 200), beyond="nearest")
"""Rises by one in ten to the east, from 5 m."""


def test_altitudes_above_a_slope():
    city = City.from_buildings([], cell=5.0, origin=(0, 0, 0), size=(200, 200, 100), terrain=SLOPE, reference=DELFT)
    route = Route([(20, 100, 40), (120, 100, 50), (120, 150, 60)])
    mission = Mission.from_route(route, city, RISK_QUADROTOR, altitudes="terrain")
    assert [item.altitude for item in placed(mission)] == pytest.approx([33.0, 33.0, 43.0], abs=2e-3)
    assert placed(mission, LAND)[0].altitude == pytest.approx(0.0, abs=0.5)  # the highest ground of its column
    above_home = Mission.from_route(route, city, RISK_QUADROTOR)
    rises = np.diff([item.altitude for item in placed(above_home)])
    assert rises == pytest.approx([10.0, 10.0], abs=2e-3)
    assert placed(above_home)[0].altitude == pytest.approx(33.0, abs=0.5)
    assert way(above_home, city) == pytest.approx(route.points, abs=CENTIMETRE)
    assert way(mission, city) == pytest.approx(route.points, abs=CENTIMETRE)


CURE = r"give home=\(longitude, latitude, height above sea\), or altitudes='home'"


@pytest.mark.parametrize(
    ("name", "kind"),
    [("ellipsoidal", "ellipsoidal, up to 100 m off the sea"), ("New York", "unknown"), ("Germany", "unknown"),
     ("WGS-84", "unknown")],
)  # fmt: skip
def test_heights_that_arent_above_the_sea_are_refused_and_home_is_the_cure(towns, name, kind):
    town = towns[name]
    with pytest.raises(ValueError, match=rf"altitudes='sea' needs heights above the sea, .* {kind}.*: {CURE}"):
        Mission.from_route(town.route(), town.city, RISK_QUADROTOR, altitudes="sea")
    where = by_pyproj(name, town)["A"]
    with pytest.raises(ValueError, match=CURE):
        Mission.from_route(town.route(), town.city, RISK_QUADROTOR, altitudes="sea", home=where)
    for home in ((*where, 21.5), Place(*where, 21.5)):
        mission = Mission.from_route(town.route(), town.city, RISK_QUADROTOR, altitudes="sea", home=home)
        assert mission.heights == "above sea"
        rise = np.array([FOOT[each] + ROOF[each] for each in NAMES]) - FOOT["A"] - ROOF["A"]
        assert [item.altitude for item in placed(mission)] == pytest.approx(21.5 + 40.0 + rise, abs=3e-3)
        assert mission.home.height == 21.5
        assert mission.notes == ()
    kept = Mission.from_route(town.route(), town.city, RISK_QUADROTOR)
    assert kept.heights == town.city.source.heights
    assert "the height of home above the sea isn't known" in kept.notes


def test_home_beside_the_start(towns):
    town = towns["Netherlands"]
    away = town.over("A") + np.array([-15.0, -18.0, 0.0])
    home = town.city.to_geographic(away)[:2]
    mission = Mission.from_route(town.route(), town.city, RISK_QUADROTOR, home=home, speed=[3.0, 4.0, 5.0, 6.0])
    points = way(mission, town.city)
    assert points[0] == pytest.approx(away, abs=CENTIMETRE)
    assert points[1] == pytest.approx(town.over("A"), abs=CENTIMETRE)
    assert apart(placed(mission)[0], home) < CENTIMETRE
    assert mission.home.height == pytest.approx(FOOT["A"], abs=0.05)  # on the ground, not on a roof
    speeds = [item.parameters[1] for item in placed(mission, 178)]
    assert speeds == [3.0, 4.0, 5.0, 6.0]
    assert mission.items[1].command == 178
    assert mission.items[2].command == mission.items[3].command == WAYPOINT  # the same speed to the start and on


def refused(message, city=None, route=((5, 5, 30), (5, 95, 30)), uav=LIGHT_QUADROTOR, **options):
    with pytest.raises(ValueError, match=message):
        Mission.from_route(
            Route(route) if isinstance(route, tuple) else route, table1() if city is None else city, uav, **options
        )


NOWHERE = replace(table1(), reference=None)
FAR = DELFT.longitude + 1.46, DELFT.latitude
LOW = ((5, 5, 30), (5, 95, 30))


@pytest.mark.parametrize(
    ("message", "options"),
    [
        (r"REPARE Table 1' doesn't know where on Earth it lies.*home=\(longitude, latitude", {"city": NOWHERE}),
        (r"home is 100 km from the start of the route.*order is \(longitude, latitude", {"home": FAR}),
        (r"home is .* km from the start", {"home": (DELFT.latitude, DELFT.longitude)}),
        (r"home lies outside of the map, at \(-5\d\.\d.*larger margin", {"home": (4.3592, 52.0101)}),
        (r"home at \(30\.0, 30\.0, 6\d\.\d\) has no clear way to the start", {
            "home": table1().to_geographic((30, 30, 0))[:2], "route": ((5, 5, 80), (5, 95, 80)),
            "min_clearance": 17.0}),
        (r"home at .* has no clear way to the start of the route \(5\.0, 5\.0, 30\.0\): take off below", {
            "home": table1().to_geographic((30, 30, 0))[:2]}),
        ("home must be a number or an array of numbers: got text, 'here'", {"home": "here"}),
        ("home must be a Place", {"home": (1.0,)}),
        ("home must be a Place", {"home": 4.0}),
        (r"latitude must be from -90 to 90 degrees \(the order is longitude", {"home": (52.0, 95.0)}),
        (r"route must lead from a start to a goal: no way", {"route": Route.none("A*", "no way")}),
        (r"route must lead from a start to a goal", {"route": ((5, 5, 30), (5, 5, 30))}),
        (r"route must lead from a start to a goal", {"route": ((5, 5, 30),)}),
        (r"route must have a way between take-off and landing", {
            "route": Route([(5, 5, 0.5), (5, 5, 30), (5, 5, 0.5)], takeoff=1, landing=1)}),
        (r"route must have a way between take-off and landing", {
            "route": Route([(5, 5, 30), (5, 50, 30), (5, 95, 30), (50, 98, 30)], landing=5)}),
        (r"route must be a Route", {"route": [(5, 5, 30), (5, 95, 30)]}),
        (r"city must be a City", {"city": "Delft"}),
        (r"uav must be an? UAV", {"uav": "drone"}),
        (r"route is 20\.0 m above the ground at .* ceiling is 15 m: plan it with max_height=15", {
            "ceiling": 15.0, "route": ((5, 5, 20), (5, 95, 20))}),
        (r"speed must be at most the UAV's top speed of 18 m/s, got 19", {"speed": 19.0}),
        (r"speed must be at most", {"speed": [5.0, 19.0], "route": (*LOW, (50, 95, 30))}),
        (r"speed must be one number, or one for each of the 1 legs, got shape \(2,\)", {"speed": [5.0, 6.0]}),
        (r"speed must be finite and above 0, got 0", {"speed": 0.0}),
        (r"speed must be finite and above 0", {"speed": np.nan}),
        (r"end must be one of 'land', 'return', 'stay', got 'hover'", {"end": "hover"}),
        (r"altitudes must be one of 'sea', 'home', 'terrain', got 'ground'", {"altitudes": "ground"}),
        (r"rally\[1\] \(20\.0, 30\.0, 20\.0\) lies in building '2 hip roof'.*choose another", {
            "rally": [(5, 50, 1), (20, 30, 20)]}),
        (r"rally\[0\] .* off the map", {"rally": [(500, 50, 1)]}),
        (r"rally\[0\] must have shape \(3,\)", {"rally": [(5, 50)]}),
        (r"rally must be a list of points", {"rally": 5.0}),
        (r"hold must be finite and at least 0, got -1", {"hold": -1.0}),
        (r"corner_radius must be finite and above 0", {"corner_radius": 0.0}),
        (r"corridor must be finite and above 0", {"corridor": 0.0}),
        (r"ceiling must be finite and above 0", {"ceiling": -5.0}),
        (r"fence_margin must be finite and above 0", {"fence_margin": 0.0}),
        (r"min_clearance must be finite and at least 0", {"min_clearance": -1.0}),
    ],
)  # fmt: skip
def test_what_cant_be_flown_is_refused_by_name_with_the_cure(message, options):
    refused(message, **options)


def test_a_route_below_the_ground_is_refused():
    city = City.from_buildings([], cell=5.0, origin=(0, 0, 0), size=(200, 200, 100), terrain=SLOPE, reference=DELFT)
    refused(r"route is 3\.0 m below the ground at \(120\.0, 100\.0, 14\.0\): plan it above", city,
            ((20, 100, 40), (120, 100, 14), (150, 100, 60)))  # fmt: skip


VALLEY = Terrain.from_raster([[60.0, 60.0, 0.0, 0.0, 60.0, 60.0]] * 6, (0, 0, 300, 300), beyond="nearest")
"""60 m deep, from south to north."""


def test_the_ceiling_holds_between_waypoints_too():
    city = City.from_buildings([], cell=10.0, origin=(0, 0, -10), size=(300, 300, 250), terrain=VALLEY, reference=DELFT)
    over = ((25, 150, 140), (275, 150, 140))
    refused(
        r"route is 140\.0 m above the ground at \(1\d\d\.\d, 150\.0, 140\.0\), and the ceiling is 120 m", city, over
    )
    assert Mission.from_route(Route(over), city, RISK_QUADROTOR, ceiling=141.0)
    down = ((25, 150, 170), (75, 150, 170), (125, 150, 115), (175, 150, 115), (225, 150, 170), (275, 150, 170))
    mission = Mission.from_route(Route(down), city, RISK_QUADROTOR, corridor=60.0)  # straight on would be too high
    assert city.height_above_ground(samples(way(mission, city))).max() <= 120.0 + CENTIMETRE
    refused(r"end='return' flies up to 170\.0 m above the ground", city, down, RISK_QUADROTOR, end="return")


def test_ends(towns):
    town = towns["Netherlands"]
    for end, last in (("land", LAND), ("stay", LOITER), ("return", RETURN)):
        mission = Mission.from_route(town.route(), town.city, RISK_QUADROTOR, end=end, hold=7.5)
        assert mission.items[-1].command == last
        goal = placed(mission)[len(NAMES) - 1]
        assert goal.parameters[0] == 7.5
        if last != RETURN:
            assert apart(mission.items[-1], (goal.longitude, goal.latitude)) == 0.0
        if last == LOITER:
            assert mission.items[-1].altitude == goal.altitude


def test_takeoff_and_landing_legs_of_a_route_are_no_waypoints():
    campus_map = reference_campus()
    city = replace(campus_map.city, reference=DELFT)
    route = least_risk(campus_map, *CAMPUS_FLIGHT)
    assert (route.takeoff, route.landing) == (0, 0)
    longer = astar(city, (12.5, 17.5, 2.5), (112.5, 112.5, 2.5), min_height=20.0)
    assert longer.takeoff > 0 < longer.landing
    mission = Mission.from_route(longer, city, RISK_QUADROTOR)
    first, last = longer.en_route.points[[0, -1]]
    points = mission.path(city)
    assert (points.takeoff, points.landing) == (1, 1)
    assert points.points[1] == pytest.approx(first, abs=CENTIMETRE)
    assert points.points[-2] == pytest.approx(last, abs=CENTIMETRE)
    assert points.points[0] == pytest.approx((*first[:2], 0.0), abs=CENTIMETRE)
    assert placed(mission)[0].altitude == pytest.approx(first[2])


def test_legs_of_no_length_and_their_speeds_are_left_out():
    points = [(5, 5, 30), (5, 50, 30), (5, 50, 30), (5, 95, 30), (50, 98, 30), (50, 98, 30)]
    mission = Mission.from_route(Route(points), table1(), LIGHT_QUADROTOR, speed=[3, 1, 4, 5, 1])
    assert way(mission, table1()) == pytest.approx(np.array([(5, 5, 30), (5, 95, 30), (50, 98, 30)]), abs=CENTIMETRE)
    assert [item.parameters[1] for item in placed(mission, 178)] == [3.0, 5.0]  # of 3 and 4 the lower
    assert mission.speed == 5.0


def test_one_change_of_speed_for_legs_of_the_same():
    points = [(5, 5, 30), (5, 50, 40), (5, 95, 30), (50, 98, 30), (98, 98, 40)]
    mission = Mission.from_route(Route(points), table1(), LIGHT_QUADROTOR, speed=[3, 3, 5, 5])
    assert [item.command for item in mission.items] == [22, 178, 16, 16, 178, 16, 16, 21]
    assert mission.items[1] == Item(178, 2, (1.0, 3.0, -1.0, 0.0))
    usual = Mission.from_route(Route(points), table1(), LIGHT_QUADROTOR)
    assert usual.items[1].parameters[1] == usual.speed == LIGHT_QUADROTOR.cruise_speed


@pytest.mark.parametrize(
    ("towards", "degrees"),
    [
        ((0, 1, 5), 0.0),
        ((1, 1, 0), 45.0),
        ((1, 0, 0), 90.0),
        ((0, -3, 1), 180.0),
        ((-1, 0, 0), 270.0),
        ((0, 0, 9), 0.0),
    ],
)
def test_headings_are_clockwise_from_north(towards, degrees):
    assert heading(np.zeros(3), np.array(towards, float)) == pytest.approx(degrees)


def test_home_on_a_roof_and_landing_on_one():
    city = table1()
    route = Route([(22, 35, 80), (50, 5, 80), (80, 68, 100 - 2.5)], min_clearance=1.0)
    mission = Mission.from_route(route, city, RISK_QUADROTOR)
    assert mission.path(city).points[0, 2] == pytest.approx(65.0, abs=0.6)  # the ridge of the hip roof
    assert placed(mission)[0].altitude == pytest.approx(80 - mission.path(city).points[0, 2], abs=2e-3)
    assert mission.path(city).points[-1] == pytest.approx((80, 68, 90), abs=CENTIMETRE)
    home = city.to_geographic((35.2, 80.0, 0))[:2]  # the floating building is below, 60 m high
    on_roof = Mission.from_route(Route([(37, 81, 70), (5, 81, 70)]), city, RISK_QUADROTOR, home=home)
    assert on_roof.path(city).points[0] == pytest.approx((35.2, 80.0, 60.0), abs=CENTIMETRE)


def test_home_under_an_eave_is_below_the_start():
    """Not on top of what hangs over it: a take-off by minus thirty metres is none."""
    city = table1()
    home = city.to_geographic((30, 80, 0))[:2]
    mission = Mission.from_route(Route([(32, 80, 30), (5, 80, 30), (5, 5, 30)]), city, LIGHT_QUADROTOR, home=home)
    assert mission.path(city).points[0] == pytest.approx((30, 80, 0), abs=CENTIMETRE)
    assert placed(mission)[0].altitude == pytest.approx(30.0)
    assert min(item.altitude for item in placed(mission)) > 0
    assert mission.items[-1].altitude == pytest.approx(0.0, abs=1e-3)


def test_to_return_it_first_climbs_to_where_the_way_home_is_clear():
    city = table1()
    route = Route([(5, 5, 30), (5, 60, 30), (42, 60, 30)], min_clearance=2.0)
    mission = Mission.from_route(route, city, LIGHT_QUADROTOR, end="return")
    *_, goal, climb, back = mission.items
    assert (goal.command, climb.command, back.command) == (WAYPOINT, WAYPOINT, RETURN)
    assert (goal.latitude, goal.longitude) == (climb.latitude, climb.longitude)
    assert climb.parameters[0] >= 1.0
    assert climb.altitude == pytest.approx(mission.return_height, abs=2e-3)
    assert climb.altitude > goal.altitude
    assert mission.return_height >= 65.0 + 2.0
    low = Mission.from_route(Route([(60, 5, 50), (95, 5, 50)]), city, LIGHT_QUADROTOR, end="return")
    assert [item.command for item in low.items[-2:]] == [WAYPOINT, RETURN]
    assert low.return_height == pytest.approx(50.0)  # nothing stands there: it stays where it is
    assert sum(item.command == WAYPOINT for item in low.items) == 1


@settings(max_examples=40, suppress_health_check=[HealthCheck.filter_too_much, HealthCheck.too_slow])
@given(st.integers(0, 10_000), st.floats(0.5, 2.4), st.booleans(), st.booleans())
def test_the_straight_way_home_is_clear_from_anywhere(seed, keep, hilly, near_home):
    city = hills(seed % 5, 10.0) if hilly else campus(seed % 6)
    start, goal = city.random_pairs(1, seed, apart=40.0, min_clearance=keep)[0]
    route = astar(city, start, goal, min_clearance=keep)
    assume(route.reached)
    home = city.to_geographic(route.points[0] + (3.0, 2.0, 0.0))[:2] if near_home else None
    try:
        mission = Mission.from_route(route, city, RISK_QUADROTOR, end="return", home=home, ceiling=1000.0)
    except ValueError as error:
        assume("a wall is" not in str(error) and "home" not in str(error) and "end='return'" not in str(error))
        raise
    home = mission.path(city).points[0]
    above_home = np.array([*home[:2], home[2] + mission.return_height])
    for begin in samples(way(mission, city), 7.0):
        above = np.array([*begin[:2], above_home[2]])
        back = samples([above, above_home + np.array([0.0, 0.0, 1e-6])], 0.2)
        assert city.distance(back).min() >= keep - CENTIMETRE
    climb = samples(way(mission, city)[-2:], 0.1)
    assert city.distance(climb).min() >= min(keep, city.distance(way(mission, city)[:-1]).min()) - CENTIMETRE


def test_what_hangs_over_the_goal_is_in_the_way_of_a_return():
    """The floating building, from 45 m on."""
    route = ((5, 5, 30), (5, 80, 30), (30, 80, 30))
    refused(r"end='return' .*\(30\.0, 80\.0, 30\.0\).* end='land' or 'stay'", route=route, end="return")
    assert Mission.from_route(Route(route), table1(), LIGHT_QUADROTOR, end="stay")


def test_what_hangs_over_home_is_in_the_way_of_a_return():
    route = ((30, 80, 30), (5, 80, 30), (5, 5, 30))
    refused(r"end='return' .*\(30\.0, 80\.0, 30\.0\).* end='land' or 'stay'", route=route, end="return")
    assert Mission.from_route(Route(route), table1(), LIGHT_QUADROTOR)


@pytest.mark.parametrize(
    ("where", "lower", "upper", "closed"),
    [
        ((40, 2, 50, 20), 0.0, np.inf, True),  # on the straight way home
        ((40, 2, 50, 20), 0.0, 20.0, False),  # below it
        ((40, 2, 50, 20), 90.0, np.inf, False),  # above it
        ((90, 4, 96, 8), 60.0, np.inf, False),  # above the climb, and higher than that
        ((90, 4, 96, 8), 40.0, np.inf, True),  # in the climb
        ((2, 4, 8, 8), 40.0, 50.0, True),  # in the descent at home
        ((40, 80, 50, 98), 0.0, np.inf, False),  # elsewhere
    ],
)
def test_no_fly_zones_are_in_the_way_of_a_return(where, lower, upper, closed):
    west, south, east, north = where
    zone = NoFlyZone([(west, south), (east, south), (east, north), (west, north)], lower, upper, name="school")
    tower = Building.prism([(60, 8), (66, 8), (66, 14), (60, 14)], 50.0)
    city = City.from_buildings(
        [tower], cell=2.0, origin=(0, 0, 0), size=(100, 100, 100), reference=DELFT, no_fly=[zone]
    )
    around = Route([(5, 6, 30), (5, 40, 30), (93, 40, 30), (93, 6, 30)])
    if closed:
        with pytest.raises(ValueError, match=r"end='return' .*'school'.* end='land' or 'stay'"):
            Mission.from_route(around, city, RISK_QUADROTOR, end="return")
    else:
        mission = Mission.from_route(around, city, RISK_QUADROTOR, end="return")
        assert mission.return_height == pytest.approx(50.4, abs=0.3)
    assert Mission.from_route(around, city, RISK_QUADROTOR)


def test_a_return_above_the_ceiling_is_refused():
    tower = Building.prism([(40, 40), (60, 40), (60, 60), (40, 60)], 130.0)
    city = City.from_buildings([tower], cell=5.0, origin=(0, 0, 0), size=(100, 100, 160), reference=DELFT)
    around = ((20, 20, 30), (20, 80, 30), (80, 80, 30))
    refused(r"end='return' .* 13\d\.\d m above the ground.* ceiling is 120 m.* end='land' or 'stay'", city, around,
            end="return")  # fmt: skip
    assert Mission.from_route(Route(around), city, RISK_QUADROTOR, end="return", ceiling=150.0)
    assert Mission.from_route(Route(around), city, RISK_QUADROTOR)


@pytest.mark.parametrize("end", ["start", "goal"])
def test_nothing_rises_or_lands_through_a_no_fly_zone(end):
    x = 5 if end == "start" else 60
    zone = NoFlyZone([(x - 4, 0), (x + 4, 0), (x + 4, 9), (x - 4, 9)], upper=20.0, name="school")
    city = replace(table1(), no_fly=[zone])
    message = r"(home|the goal) at .* no-fly zone 'school'"
    refused(message, city, ((5, 5, 30), (60, 5, 30)))
    if end == "goal":
        assert Mission.from_route(Route([(5, 5, 30), (60, 5, 30)]), city, LIGHT_QUADROTOR, end="stay")
    over = replace(table1(), no_fly=[replace(zone, lower=40.0, upper=50.0)])
    assert Mission.from_route(Route([(5, 5, 30), (60, 5, 30)]), over, LIGHT_QUADROTOR)


def test_rally_points(towns):
    town = towns["Netherlands"]
    at = town.over("B", 0.0) + np.array([-60.0, 0.0, 15.0])
    mission = Mission.from_route(town.route(), town.city, RISK_QUADROTOR, rally=[town.over("C", 25.0), at])
    expected = by_pyproj("Netherlands", town)["C"]
    assert abs(WGS84.inv(mission.rally[0].longitude, mission.rally[0].latitude, *expected)[2]) < CENTIMETRE
    above_home = FOOT["C"] + ROOF["C"] + 25.0 - FOOT["A"] - ROOF["A"]
    assert mission.rally[0].height == pytest.approx(above_home, abs=2e-3)
    assert len(mission.rally) == 2


def test_no_rally_point_in_a_no_fly_zone():
    zone = NoFlyZone([(40, 2), (60, 2), (60, 10), (40, 10)], upper=20.0, name="school")
    city = replace(table1(), no_fly=[zone])
    refused(r"rally\[0\] \(50\.0, 5\.0, 1\.0\) lies in no-fly zone 'school'.*choose another", city, rally=[(50, 5, 1)])
    assert Mission.from_route(Route(LOW), city, LIGHT_QUADROTOR, rally=[(50, 5, 40)])


def test_layout_is_about_a_kilometre():
    assert np.ptp([*LAYOUT.values()], axis=0).min() > 900
