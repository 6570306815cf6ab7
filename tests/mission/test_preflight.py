"""Each check of the preflight holds when it should and fails when it should, by values that are found another way."""

import math
import re
from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
import shapely
from missions import CENTIMETRE, DELFT, WGS84, campus, corners, followed, hills, samples, table1, way
from scipy.stats import beta, binom

from uavlab.city import Building, City, NoFlyZone, Place, Terrain
from uavlab.flight import PERFECT_GPS, Autopilot, Gps, monte_carlo
from uavlab.flight.path import planned_speed
from uavlab.mission import Check, FencePolygon, Item, Mission, Preflight, preflight
from uavlab.mission.way import most_take
from uavlab.planners import astar
from uavlab.power import power_needed
from uavlab.route import Route
from uavlab.vehicle import LIGHT_QUADROTOR, RISK_QUADROTOR
from uavlab.weather import Weather, Wind, grounded_by, mean_wind_limit, wind_limit

POINTS = ((5, 5, 30), (40, 5, 30), (40, 50, 30))
BREEZE = Wind((1.0, 0.5), deviation=0.3)
NAMES = (
    "home", "landing", "map", "clearance", "no-fly zones", "least height", "greatest height", "return height", "fence",
    "speed", "ground speed", "lift", "mean wind", "gusts", "energy", "flights",
)  # fmt: skip


@cache
def made(**options):
    return Mission.from_route(Route(POINTS), table1(), LIGHT_QUADROTOR, **options)


def checked(mission=None, city=None, uav=LIGHT_QUADROTOR, weather=BREEZE, **options):
    return preflight(
        made() if mission is None else mission, city or table1(), uav, weather, **{"flights": 2, **options}
    )


def other_items(mission, change):
    """The mission with other items."""
    return replace(mission, items=tuple(change(number, item) for number, item in enumerate(mission.items)))


def at(xy, altitude, command=16, frame=3, parameters=(0.0, 2.0, 0.0, 0.0), place=DELFT):
    longitude, latitude = place.longitude_latitude(xy)
    return Item(command, frame, parameters, float(latitude), float(longitude), altitude)


def by_hand(*points, city=None, end=21, **fields):
    """A mission through points (x, y, height above home), from below the first; it lands below the last."""
    first, *rest = points
    items = [at(first[:2], first[2], 22), *(at(point[:2], point[2]) for point in rest)]
    if end:
        items.append(Item(20) if end == 20 else at(points[-1][:2], 0.0, end))
    longitude, latitude = DELFT.longitude_latitude(first[:2])
    home = Place(float(longitude), float(latitude), DELFT.height + fields.pop("bottom", 0.0))
    fence = (square((-100, -100, 200, 200)),)
    return Mission(tuple(items), home, **{"fence": fence, "place": DELFT, "return_height": 110.0, **fields})


def square(bounds, inside=True, name="fence"):
    west, south, east, north = bounds
    plan = np.array([(west, south), (east, south), (east, north), (west, north)], float)
    degrees = DELFT.longitude_latitude(plan)
    return FencePolygon(tuple((float(latitude), float(longitude)) for longitude, latitude in degrees), inside, name)


def test_a_mission_that_can_be_flown_passes():
    found = checked(flights=60)
    assert found.passed
    assert found.failed == ()
    assert tuple(check.name for check in found.checks) == NAMES
    assert found.mission is made()
    for check in found.checks:
        assert found[check.name] is check
        assert check.words


def test_same_seed_same_result():
    assert checked(rng=3, flights=5) == checked(rng=3, flights=5)
    assert checked(rng=np.random.default_rng(3), flights=5) == checked(rng=3, flights=5)
    assert checked(rng=3, flights=5)["energy"] != checked(rng=4, flights=5)["energy"]


def test_the_table():
    found = checked(replace(made(), fence=(), name="here & <there>"))
    text = str(found)
    assert text == repr(found)
    title, heads, *rows = text.splitlines()
    assert title == "Preflight of here & <there>: NOT passed, fence"
    assert heads.split() == ["check", "found", "asked", "for", "met", "in", "words"]
    assert [row.split("  ")[0] for row in rows] == list(NAMES)
    (fence,) = (row for row in rows if row.startswith("fence"))
    assert "  none " in fence
    assert "  NO  " in fence
    assert "Mission.from_route makes one" in fence
    page = found._repr_html_()
    assert page.count("<tr>") == len(NAMES) + 1
    assert "here &amp; &lt;there&gt;" in page
    assert "<there>" not in page
    assert "≥" in page
    assert "≤" in page
    assert str(checked()).splitlines()[0] == "Preflight of the city of REPARE Table 1: passed"


def test_a_check_is_met_at_its_limit_and_not_beyond():
    assert Check("a", 2.5, 2.5, "m", True, "").met
    assert Check("a", 2.5, 2.5, "m", False, "").met
    assert not Check("a", 2.49, 2.5, "m", True, "").met
    assert not Check("a", 2.51, 2.5, "m", False, "").met
    assert not Check("a", math.nan, 2.5, "m", True, "").met
    assert not Check("a", math.nan, 2.5, "m", False, "").met
    assert not Check("a", -math.inf, 2.5, "m", True, "").met
    assert Check("a", math.inf, 2.5, "m", True, "").met
    assert Check("a", 2.5, math.inf, "Wh", False, "").met
    assert repr(Check("a", 2.0, 2.5, "m", False, "")) == "<Check a: 2 m, at most 2.5, met>"
    assert repr(Check("a", -math.inf, 2.5, "m", True, "")) == "<Check a: none, at least 2.5, NOT met>"
    with pytest.raises(ValueError, match="name must be one of 'a'"):
        Preflight((Check("a", 2.0, 2.5, "m", False, ""),), made())["b"]


@pytest.mark.parametrize("seed", range(6))
def test_clearance_is_that_of_points_all_along_legs_and_corners(seed):
    city, keep, uav = campus(seed), 0.4 + 0.3 * seed, RISK_QUADROTOR
    free = city.center_of(np.argwhere(~city.blocked(keep, min_height=6.0)))
    rng = np.random.default_rng(seed)
    route = astar(city, *free[rng.integers(len(free), size=2)], min_clearance=keep, min_height=6.0)
    assert route.reached
    mission = Mission.from_route(route, city, uav, corner_radius=1.0 + seed, ceiling=1000.0, speed=5.0)
    found = preflight(mission, city, uav, BREEZE, min_clearance=keep, ceiling=1000.0, flights=1)
    assert {check.name for check in found.failed} <= {"flights", "energy"}
    value = found["clearance"].value
    sampled = city.distance(samples(way(mission, city)), exact_within=60.0).min()
    cut = [city.distance(within, exact_within=60.0).min() for within in corners(mission, city)]
    assert value <= min([sampled, *cut]) + 1e-6
    assert value >= sampled - (1.0 + seed) / 2  # what a right angle cuts off
    straight = other_items(mission, lambda n, item: item._replace(parameters=(1.0, 1.0, 0.0, 0.0)))
    exact = preflight(straight, city, uav, BREEZE, flights=1)["clearance"].value
    assert exact == pytest.approx(sampled, abs=0.03)
    assert exact <= sampled + 1e-9


def test_a_corner_is_cut_off_unless_it_stops_there():
    """Inside of the corner a tower: √2·r/4 or half the reach nearer, and not where it holds."""
    tower = Building.prism([(45, 45), (48, 45), (48, 48), (45, 48)], 80.0)
    city = City.from_buildings([tower], cell=1.0, origin=(0, 0, 0), size=(100, 100, 100), reference=DELFT)
    mission = by_hand((10, 50, 30), (50, 50, 30), (50, 10, 30), corner_radius=8.0)
    wide = other_items(mission, lambda n, item: item._replace(parameters=(0.0, 8.0, 0.0, 0.0)))
    stops = other_items(mission, lambda n, item: item._replace(parameters=(2.0, 8.0, 0.0, 0.0)))
    usual = other_items(mission, lambda n, item: item._replace(parameters=(0.0, 0.0, 0.0, 0.0)))
    found = checked(wide, city)["clearance"]
    assert found.value == pytest.approx(2.0 - 4.0, abs=CENTIMETRE)  # a right angle cuts off half the reach
    assert not found.met
    assert "4.00 m that a corner may be cut by" in found.words
    assert "item 1" in found.words
    assert checked(usual, city)["clearance"] == found  # the mission's own radius
    assert checked(stops, city)["clearance"].value == pytest.approx(2.0, abs=CENTIMETRE)


def test_clearance_is_asked_for_of_half_the_uav_and_more():
    near = by_hand((5, 30, 30), (5, 90, 30), (11.7, 90, 30))
    assert checked(near)["clearance"].limit == pytest.approx(0.5 - CENTIMETRE)
    assert checked(near, min_clearance=0.1)["clearance"].limit == pytest.approx(0.5 - CENTIMETRE)
    asked = checked(near, min_clearance=3.0)["clearance"]
    assert asked.limit == pytest.approx(3.0 - CENTIMETRE)
    assert "3 m" in asked.words
    value = asked.value
    assert asked.met == (value >= asked.limit)
    assert not checked(near, min_clearance=value + 0.02)["clearance"].met
    assert checked(near, min_clearance=value)["clearance"].met


SLOPE = Terrain.from_raster([[0.0, 10.0, 40.0, 10.0]] * 2, (0, 0, 200, 200), beyond="nearest")
"""Up to the east and down again, the more the farther up."""


def test_legs_above_terrain_follow_it():
    """Between two items at 20 m above ground it stays 20 m above, where a straight leg would run into the hill."""
    city = City.from_buildings([], cell=5.0, origin=(0, 0, -5), size=(200, 200, 160), terrain=SLOPE, reference=DELFT)
    ground = -float(city.height_above_ground((20.0, 100.0, 0.0)))
    mission = by_hand((20, 100, 20), (180, 100, 20), bottom=ground)
    follows = other_items(mission, lambda n, item: item._replace(frame=10))
    points = followed(city, *follows.path(city).points[1:3])
    found = checked(follows, city)
    assert found["clearance"].value == pytest.approx(city.distance(points, exact_within=60.0).min(), abs=0.05)
    assert found["least height"].value == pytest.approx(20.0, abs=CENTIMETRE)
    straight = checked(mission, city)
    above = city.height_above_ground(samples(mission.path(city).points[1:3]))
    assert straight["least height"].value == pytest.approx(above.min(), abs=0.02)
    assert straight["least height"].value < 0
    assert not straight["least height"].met
    assert straight["clearance"].value == 0.0


def test_ground_that_bends_between_the_centres_of_columns():
    """Between two columns that are 10 m high, a diagonal leg passes over 5 m; what follows it rises by as much."""
    ground, occupied = np.zeros((20, 20)), np.zeros((20, 20, 8), dtype=bool)
    ground[9, 10] = ground[10, 9] = 10.0
    occupied[9, 9, 3] = occupied[10, 10, 3] = True  # a bridge, from 30 m on
    city = City(occupied, 10.0, ground=ground, reference=DELFT)
    mission = by_hand((45, 45, 20), (155, 155, 20))
    straight = checked(mission, city)
    assert straight["least height"].value == pytest.approx(15.0, abs=0.02)
    assert straight["greatest height"].value == 110.0
    assert straight["clearance"].value == pytest.approx(10.0, abs=0.02)
    follows = checked(other_items(mission, lambda n, item: item._replace(frame=10)), city)
    assert follows["least height"].value == 20.0
    assert follows["clearance"].value == pytest.approx(5.0, abs=0.02)


def test_home_is_where_it_stands_and_can_rise():
    found = checked()["home"]
    apart = table1().distance(samples([(5, 5, 10), (5, 5, 30)]), exact_within=60.0).min()
    assert found.value == pytest.approx(apart, abs=0.02)
    assert found.limit == pytest.approx(0.49)
    no_takeoff = replace(made(), items=made().items[1:])
    floating = replace(made(), home=made().home._replace(height=made().home.height + 12.0))
    away = by_hand((-20, 5, 30), (40, 5, 30))
    for mission, words in (
        (no_takeoff, "take-off"), (floating, "12.0 m above what it would stand on"), (away, "off the map"),
    ):  # fmt: skip
        home = checked(mission)["home"]
        assert not home.met
        assert words in home.words


def test_home_beside_a_wall_or_under_a_roof_isnt_free_to_rise():
    wall = Building.prism([(20, 10), (30, 10), (30, 20), (20, 20)], 30.0)
    roof = Building.prism([(60, 60), (80, 60), (80, 80), (60, 80)], 32.0, bottom=28.0)
    city = City.from_buildings([wall, roof], cell=1.0, origin=(0, 0, 0), size=(100, 100, 60), reference=DELFT)
    beside = checked(by_hand((19.7, 15, 40), (10, 15, 40), (10, 50, 40)), city)
    assert beside["home"].value == pytest.approx(0.3, abs=CENTIMETRE)
    assert not beside["home"].met
    assert beside["landing"].met
    landing = checked(by_hand((10, 50, 40), (10, 15, 40), (19.7, 15, 40)), city)
    assert landing["home"].met
    assert landing["landing"].value == pytest.approx(0.3, abs=CENTIMETRE)
    assert not landing["landing"].met
    through = checked(by_hand((70, 70, 40), (10, 70, 40)), city)["home"]
    assert not through.met  # what is below the start is the roof, not the ground on which it is said to stand
    assert checked(by_hand((70, 70, 20), (70, 50, 20), (10, 50, 40)), city)["home"].met  # below it there is room


def test_the_ground_below_home_is_no_wall_and_rising_ground_is_told_from_walls():
    wall = Building.prism([(60, 10), (70, 10), (70, 20), (60, 20)], 30.0)
    level = {"origin": (0, 0, -8), "size": (100, 100, 60), "reference": DELFT}
    mission = by_hand((20, 15, 40), (20, 50, 40))
    for cell in (2.0, 4.0):
        flat = City.from_buildings([wall], cell=cell, terrain=0.0, **level)
        home = checked(mission, flat)["home"]
        assert home.value == pytest.approx(40.0, abs=CENTIMETRE)  # not the cell
        assert home.words == "to walls on the way up to 40.0 m"
    slope = Terrain([(0, 0, -6), (100, 0, 24), (100, 100, 24), (0, 100, -6)], [(0, 1, 2), (0, 2, 3)])
    hill = City.from_buildings([wall], cell=2.0, terrain=slope, **level)
    home = checked(by_hand((20, 15, 30), (20, 50, 30), city=hill), hill)["home"]
    assert home.value < 7
    assert re.match(r"to rising ground, (3\d|40)(\.\d)? m to walls, on the way up", home.words)
    empty = City(np.zeros((50, 50, 30), dtype=bool), 2.0, reference=DELFT)
    found = checked(mission, empty)
    assert found["home"].value == math.inf
    assert found["home"].met
    assert "nothing on the map is higher" in found["home"].words
    assert next(row for row in found.rows() if row[0] == "home")[1] == "none"


def test_a_mission_that_stays_in_the_air_has_no_landing():
    found = checked(made(end="stay"))
    assert [check.name for check in found.checks] == [name for name in NAMES if name != "landing"]
    assert found.passed


def test_a_way_that_leaves_the_map_fails_and_isnt_flown():
    found = checked(by_hand((5, 5, 30), (5, 120, 30), (40, 5, 30)))
    assert found["map"].value == pytest.approx(-20.0, abs=CENTIMETRE)
    assert {"map", "energy", "flights"} <= {check.name for check in found.failed}
    assert "leaves the map" in found["energy"].words
    high = checked(by_hand((5, 5, 110), (40, 5, 110)), ceiling=200.0)["map"]
    assert high.value == pytest.approx(-10.0, abs=CENTIMETRE)  # a building reaches the map's top, and may go on
    low = City.from_buildings(
        [Building.prism([(50, 50), (60, 50), (60, 60), (50, 60)], 20.0)], cell=5.0, origin=(0, 0, 0),
        size=(100, 100, 50), reference=DELFT,
    )  # fmt: skip
    assert checked(by_hand((5, 5, 110), (40, 5, 110)), low, ceiling=200.0)["map"].met  # nothing does there


def test_heights_are_above_ground_and_below_the_ceiling():
    found = checked(by_hand((5, 5, 30), (40, 5, 95), (40, 50, 20), return_height=97.0))
    assert found["least height"].value == 20.0
    assert found["greatest height"].value == 97.0
    assert "95.0 m on the way to item 1" in found["greatest height"].words
    assert checked(made(), ceiling=66.0)["greatest height"].met
    too_high = checked(made(), ceiling=65.0)["greatest height"]  # a return is at 65.5 m
    assert not too_high.met
    assert "65.5 m if it returns" in too_high.words
    assert not checked(made(), ceiling=29.0)["greatest height"].met
    assert checked(by_hand((5, 5, 30), (40, 5, 120), return_height=120.0))["greatest height"].met
    assert not checked(by_hand((5, 5, 30), (40, 5, 120.02), return_height=10.0))["greatest height"].met
    assert not checked(by_hand((5, 5, 30), (40, 5, 0.3)))["least height"].met
    assert not checked(by_hand((5, 5, 30), (40, 5, -3.0)))["least height"].met


def test_a_return_passes_over_the_lowest_ground_between():
    """The way goes around a valley, and the way home is across it."""
    city = City.from_buildings([], cell=10.0, origin=(0, 0, -10), size=(300, 300, 250), terrain=VALLEY, reference=DELFT)
    mission = by_hand((25, 50, 30), (25, 250, 30), (275, 250, 30), return_height=100.0, bottom=60.0)
    found = checked(mission, city, ceiling=1000.0)["greatest height"]
    assert found.value == pytest.approx(160.0, abs=CENTIMETRE)
    west = by_hand((25, 50, 30), (25, 250, 30), (60, 250, 30), return_height=100.0, bottom=60.0)
    assert checked(west, city, ceiling=1000.0)["greatest height"].value == pytest.approx(100.0, abs=CENTIMETRE)


VALLEY = Terrain.from_raster([[60.0, 60.0, 0.0, 0.0, 60.0, 60.0]] * 6, (0, 0, 300, 300), beyond="nearest")


def test_the_return_is_above_all_that_stands_between():
    assert made().return_height == pytest.approx(65.5)
    assert checked()["return height"].met
    for height, words in ((60.0, "too low"), (0.0, "isn't known")):
        found = checked(replace(made(), return_height=height))["return height"]
        assert not found.met
        assert found.limit == pytest.approx(65.5, abs=0.03)
        assert words in found.words
        assert "return_height=66" in found.words
    assert not checked(min_clearance=3.0)["return height"].met


def test_no_fly_zones_with_takeoff_landing_and_what_lies_above_the_map():
    def zoned(west, south, lower=0.0, upper=np.inf, size=4, **options):
        corner = [(west, south), (west + size, south), (west + size, south + size), (west, south + size)]
        zone = NoFlyZone(corner, lower, upper, name="school & yard")
        return checked(made(**options), replace(table1(1.0), no_fly=[zone]))["no-fly zones"]

    assert checked()["no-fly zones"].value == math.inf
    beside = zoned(20, 12)
    assert beside.met
    assert beside.value == pytest.approx(7.0, abs=CENTIMETRE)
    assert "item 2" in beside.words
    in_corner = zoned(34, 6, size=5, corner_radius=4.0)  # touches no leg, but what the corner at item 2 may cut off
    assert not in_corner.met
    assert zoned(34, 6, size=5, corner_radius=1.0).value == pytest.approx(0.5, abs=CENTIMETRE)
    on_way = zoned(18, 3)
    assert not on_way.met
    assert on_way.value == 0.0
    assert "school & yard" in on_way.words
    assert zoned(18, 3, upper=20.0).met
    assert zoned(18, 3, lower=40.0).met
    assert not zoned(3, 3, upper=10.0).met  # in the take-off
    assert not zoned(38, 48, upper=10.0).met  # in the landing
    low = City.from_buildings(
        [Building.prism([(60, 80), (70, 80), (70, 90), (60, 90)], 20.0)], cell=2.0, origin=(0, 0, 0),
        size=(100, 100, 40), reference=DELFT, no_fly=[NoFlyZone([(18, 3), (22, 3), (22, 7), (18, 7)])],
    )  # fmt: skip
    assert not checked(by_hand((5, 5, 60), (40, 5, 60)), low)["no-fly zones"].met


def test_the_fence_is_as_far_as_shapely_says():
    mission = made(fence_margin=7.0)
    (polygon,) = mission.fence
    longitude, latitude = DELFT[:2]
    azimuth, _, length = WGS84.inv(
        [longitude] * len(polygon.corners), [latitude] * len(polygon.corners),
        [corner[1] for corner in polygon.corners], [corner[0] for corner in polygon.corners],
    )  # fmt: skip
    east, north = length * np.sin(np.radians(azimuth)), length * np.cos(np.radians(azimuth))
    border = shapely.Polygon(np.column_stack([east, north])).exterior
    plan = mission.path(table1()).points
    expected = min(border.distance(shapely.Point(x, y)) for x, y, _ in samples(plan, 0.5))
    found = checked(mission)["fence"]
    assert found.value == pytest.approx(expected, abs=0.05)
    assert 6.5 < found.value < 7.1


def test_the_fence_is_kept_on_its_right_side():
    def fence(*polygons, **options):
        return checked(replace(made(), fence=polygons), **options)["fence"]

    assert fence(square((-30, -30, 70, 80))).value == pytest.approx(30.0, abs=CENTIMETRE)
    assert fence(square((-30, -30, 70, 80)), square((60, 0, 70, 10), False, "pond")).value == pytest.approx(
        20, abs=0.01
    )
    assert "pond" in fence(square((-30, -30, 70, 80)), square((60, 0, 70, 10), False, "pond")).words
    assert fence(square((-30, -30, 30, 80))).value == pytest.approx(-10.0, abs=CENTIMETRE)
    through = fence(square((18, -30, 26, 80), False))
    assert through.value < -3.0
    assert not through.met
    assert not fence(square((0, 0, 50, 60)), square((-30, -30, 38, 80))).met  # in one, and not in the other
    crossed = FencePolygon(tuple(square((-30, -30, 70, 80)).corners[n] for n in (0, 2, 1, 3)), True)
    assert not fence(crossed, fence_margin=0.0).met


def test_a_corner_may_not_be_cut_through_the_fence():
    """Only the corner that is rounded comes near the pond inside of it."""
    pond = square((33, 8, 36, 12), False, "pond")
    mission = replace(made(corner_radius=9.0), fence=(square((-30, -30, 70, 80)), pond))
    holding = other_items(mission, lambda n, item: item._replace(parameters=(1.0, *item.parameters[1:])))
    assert not checked(mission, fence_margin=0.5)["fence"].met
    assert checked(holding, fence_margin=0.5)["fence"].value == pytest.approx(3.0, abs=CENTIMETRE)


def test_the_fence_is_3_sigma_of_gps_away():
    found = checked(weather=Wind())["fence"]
    seconds = 30 / 3.0 + 80 / 5.0 + 30 / 2.0
    assert found.limit == pytest.approx(3 * 4.7 * math.sqrt(1 - math.exp(-2 * seconds / 1100)), rel=1e-3)
    assert f"after {seconds:.0f} s" in found.words
    assert checked(gps=PERFECT_GPS)["fence"].limit == 0.0
    assert checked(gps=Gps(drift=9.4))["fence"].limit == pytest.approx(2 * checked()["fence"].limit)
    given = checked(fence_margin=25.0)["fence"]
    assert given.limit == 25.0
    assert not given.met
    assert "GPS" not in given.words
    holding = other_items(made(), lambda n, item: item._replace(parameters=(60.0, *item.parameters[1:])))
    assert f"after {seconds + 120:.0f} s" in checked(holding, weather=Wind())["fence"].words


def test_speeds():
    assert checked(made(speed=4.0))["speed"].value == 4.0
    fast = other_items(made(), lambda n, item: item._replace(parameters=(1.0, 19.0, -1.0, 0.0)) if n == 1 else item)
    found = checked(fast)
    assert found["speed"].value == 19.0
    assert not found["speed"].met
    steep = checked(by_hand((5, 5, 20), (5, 25, 60), speed=10.0), weather=Wind(deviation=0.1))["ground speed"]
    assert steep.value == pytest.approx(5.0 * math.sqrt(5) / 2, abs=0.01)
    assert steep.met
    assert "climbs at 5 m/s at most" in steep.words
    down = checked(by_hand((5, 5, 60), (5, 25, 20), speed=10.0), weather=Wind(deviation=0.1))["ground speed"]
    assert down.value == pytest.approx(4.0 * math.sqrt(5) / 2, abs=0.01)
    assert "sinks at 4 m/s at most" in down.words
    assert checked()["ground speed"].value == 5.0
    against = checked(by_hand((5, 5, 30), (40, 5, 30), speed=8.0), weather=Wind((-14.0, 0.0), deviation=0.1))
    assert against["ground speed"].value == pytest.approx(4.0, abs=0.01)  # of 18 m/s through the air
    assert "wind" in against["ground speed"].words
    across = checked(by_hand((5, 5, 30), (40, 5, 30)), weather=Wind((0.0, 25.0), gusts="none"))
    assert not across["ground speed"].met
    assert across["ground speed"].value == 0.0


@pytest.mark.parametrize("load", [0.0, 1.0, 1.3])
@pytest.mark.parametrize("wind", [0.0, 6.0, 11.5, 17.0])
def test_wind_is_too_strong_exactly_where_grounded_by_says_so(load, wind):
    uav, weather = LIGHT_QUADROTOR.loaded(load), Weather(forecast_wind=wind, rain_mm_per_h=20.0)
    found = checked(uav=uav, weather=weather)
    reasons = grounded_by(uav, weather, ground_speed=0.1)
    assert bool(reasons) == any(not found[name].met for name in ("lift", "mean wind", "gusts"))
    mean, gust = weather.reference_wind
    assert found["mean wind"].value == pytest.approx(mean)
    assert found["gusts"].value == pytest.approx(gust)
    rain = 1000 * 20.0 / 3.6e6 * 9.0 * uav.rain_area
    assert found["lift"].value == pytest.approx(uav.thrust - 1.1 * (uav.weight + rain))
    if not found["lift"].met:
        assert any(reason.startswith("lift") for reason in reasons)
        return
    assert found["gusts"].limit == pytest.approx(float(wind_limit(uav, rain, air_density=weather.air_density)))
    calm = float(mean_wind_limit(uav, rain, ground_speed=0.1, air_density=weather.air_density, gust_factor=1.0))
    assert found["mean wind"].limit == pytest.approx(calm, abs=1e-6)
    for reason in reasons:
        assert reason in found["energy"].words
        assert reason in found["flights"].words
    if reasons:
        assert not found["energy"].met
        assert found["energy"].value == math.inf
        assert found["flights"].value == 2


SLOW = replace(LIGHT_QUADROTOR, climb_speed=0.7, sink_speed=0.7)
"""Takes off and lands no faster than the last metres, so that one speed says all."""


GOOD = Gps(drift=0.5)


def as_flown(mission, city, clear_from, speed=5.0, flights=60, rng=7, uav=SLOW, weather=BREEZE):
    """Its path, from a height on, by `monte_carlo`, without a battery that could be empty."""
    points = mission.path(city).points.copy()
    points[0, 2] = clear_from
    unlimited = replace(uav, battery=np.inf)
    autopilot = Autopilot(speed=speed, gps=GOOD)
    return monte_carlo(Route(points), city, unlimited, weather, autopilot, rng=rng, flights=flights)


def rest(height, holds=0.0, uav=SLOW, wind=BREEZE):
    """Energy and time of a climb at 0.7 m/s, and of hovering [J, s]."""
    climb, hover = (float(power_needed(uav, (0, 0, v), wind.mean).battery) for v in (0.7, 0.0))
    return climb * height / 0.7 + hover * holds, height / 0.7 + holds


def test_energy_is_that_of_monte_carlo_on_the_same_path():
    city = table1()
    flights = as_flown(made(), city, clear_from=5.0)
    assert (flights.outcome == "arrived").all()
    found = checked(uav=SLOW, flights=60, rng=7, gps=GOOD)
    joules, seconds = rest(5.0)
    sink = float(power_needed(SLOW, (0, 0, -0.7), BREEZE.mean).battery)
    left = np.maximum(flights.place[:, 2], 0.0) / 0.7
    bound = np.sort(flights.energy + joules + sink * left)[rank(60) - 1]
    assert found["energy"].value == pytest.approx(bound / 3600, rel=1e-9)
    assert found["energy"].limit == pytest.approx(0.8 * 100.0)
    latest = np.sort(flights.duration + seconds + left)[rank(60) - 1]
    assert f"in {latest:.0f} s" in found["energy"].words
    assert "60 that arrived" in found["energy"].words
    holding = other_items(made(), lambda n, item: item._replace(parameters=(40.0, 2.0, 0.0, 0.0)) if n == 3 else item)
    more = checked(holding, uav=SLOW, flights=60, rng=7, gps=GOOD)["energy"].value - found["energy"].value
    assert more == pytest.approx(rest(0.0, 40.0)[0] / 3600, rel=1e-6)


def rank(count):
    """The least order statistic that is above the 95 % quantile with a probability of 95 %, by trying all."""
    return next(r for r in range(1, count + 1) if binom.cdf(r - 1, count, 0.95) >= 0.95)


def test_the_bound_is_above_the_quantile_in_95_of_100():
    rng = np.random.default_rng(1)
    for count in (59, 100, 200):
        above = [most_take(rng.exponential(size=count))[0] >= -math.log(0.05) for _ in range(1000)]
        assert 0.935 <= np.mean(above) <= 0.995
        assert most_take(np.arange(count))[0] == rank(count) - 1
    values, words = most_take([3.0, 1.0, 2.0])
    assert values == 3.0
    assert "needs 59" in words
    assert "needs 59" in most_take(np.ones(58))[1]
    assert "needs 59" not in most_take(np.ones(59))[1]


def test_the_energy_has_to_be_in_the_battery():
    used = checked()["energy"].value * 3600
    assert checked(uav=replace(LIGHT_QUADROTOR, battery=1.01 * used / 0.8))["energy"].met
    for share in (0.99, 0.4):
        short = checked(uav=replace(LIGHT_QUADROTOR, battery=share * used / 0.8))
        assert not short["energy"].met
        assert short["energy"].value == pytest.approx(used / 3600)  # not cut off where the battery is empty
        assert short["flights"].met
    unknown = checked(uav=replace(LIGHT_QUADROTOR, battery=np.inf))["energy"]
    assert unknown.met
    assert unknown.limit == math.inf
    assert "what the battery holds isn't known" in unknown.words


def test_a_return_takes_the_way_back_and_the_landing_at_home():
    calm = {"weather": Wind(gusts="none"), "gps": PERFECT_GPS, "uav": SLOW}
    back, there = (checked(made(end=end, min_clearance=3.0), **calm) for end in ("return", "stay"))
    points = [(40, 50, 30), (40, 50, 68), (5, 5, 68), (5, 5, 0)]
    autopilot, unlimited = Autopilot(speed=5.0, gps=PERFECT_GPS), replace(SLOW, battery=np.inf)
    way_back = monte_carlo(Route(points), table1(), unlimited, Wind(gusts="none"), autopilot, rng=0, flights=1)
    assert way_back.outcome.tolist() == ["arrived"]
    assert back["energy"].value - there["energy"].value == pytest.approx(way_back.energy[0] / 3600, rel=0.02)
    apart = table1().distance(samples([(5, 5, 10), (5, 5, 68)]), exact_within=60.0).min()
    assert back["landing"].value == pytest.approx(apart, abs=0.02)


def test_it_rises_to_return_where_the_mission_doesnt_say_so():
    mission = by_hand((5, 5, 30), (40, 5, 30), (40, 50, 30), end=20, return_height=70.0)
    back = checked(mission)
    assert back["landing"].words.endswith("(5.0, 5.0, 70.0)")
    assert "70.0 m on the way to item 3" in back["greatest height"].words
    low = checked(replace(mission, return_height=30.0))  # through the building between
    assert (back["clearance"].met, low["clearance"].met) == (True, False)
    assert "item 3" in low["clearance"].words


def test_each_leg_has_its_own_speed():
    slow, fast = made(speed=(1.0, 8.0)), made(speed=(8.0, 8.0))
    apart = [checked(one, weather=Wind(gusts="none"), gps=PERFECT_GPS)["energy"] for one in (slow, fast)]
    times = [float(check.words.removeprefix("in ").split(" s")[0]) for check in apart]
    route = Route([(5, 5, 5), *POINTS, (40, 50, 5), (40, 50, 0)])
    planned = [
        planned_speed(route, LIGHT_QUADROTOR, Wind(gusts="none"), np.array([3.0, first, 8.0, 2.0, 0.7]))
        for first in (1.0, 8.0)
    ]
    expected = [duration(path) + 5.0 / 3.0 for path in planned]
    assert times == pytest.approx(expected, abs=1.5)
    assert times[0] > times[1] + 25.0


def duration(path):
    """Of the reference on a path, by its speeds alone [s]."""
    s = np.linspace(0.0, path.distance[-1], 200_001)
    leg = np.clip(np.searchsorted(path.distance, s, side="right") - 1, 0, len(path.on_legs) - 1)
    since = path.at_points[leg] ** 2 + 2 * path.braking * (s - path.distance[leg])
    until = path.at_points[leg + 1] ** 2 + 2 * path.braking * (path.distance[leg + 1] - s)
    return np.trapezoid(1 / np.minimum(path.on_legs[leg], np.sqrt(np.minimum(since, until))), s)


def test_who_touches_the_ground_while_it_lands_has_landed():
    """On ground that is an obstacle, where flights that begin or end on it would all have crashed."""
    city = hills(1, 6.0, 2.0)
    route = Route([(10, 50, 30), (50, 50, 30), (85, 85, 30)])
    mission = Mission.from_route(route, city, LIGHT_QUADROTOR)
    found = checked(mission, city, flights=60)
    assert found["flights"].value == 0
    assert found["energy"].met
    points = mission.path(city).points
    raw = monte_carlo(Route(points), city, LIGHT_QUADROTOR, BREEZE, Autopilot(speed=5.0), rng=0, flights=3)
    assert (raw.outcome == "crashed").all()


def test_on_the_way_a_touch_is_a_crash():
    """A wall across the way, and a roof on which it doesn't land, however low above it."""
    wall = Building.prism([(45, 0), (47, 0), (47, 100), (45, 100)], 29.0)
    city = City.from_buildings([wall], cell=1.0, origin=(0, 0, 0), size=(100, 100, 60), reference=DELFT)
    for height in (20.0, 29.2):
        found = checked(by_hand((10, 50, height), (90, 50, height)), city, flights=4)
        assert found["flights"].value == 4
        assert "crashed after" in found["flights"].words
        assert found["energy"].words == "no flight arrived"
        assert not found["energy"].met


def test_a_roof_on_the_way_isnt_landed_on():
    roof = Building.prism([(30, 0), (70, 0), (70, 100), (30, 100)], 29.0)
    city = City.from_buildings([roof], cell=1.0, origin=(0, 0, 0), size=(100, 100, 60), reference=DELFT)
    mission, gps = by_hand((10, 50, 29.8), (90, 50, 29.8), speed=0.7, end=None), Gps(vertical_drift=3.0)
    found = checked(mission, city, uav=SLOW, flights=20, rng=2, gps=gps)["flights"]
    route = Route([(10, 50, 1.0), (10, 50, 29.8), (90, 50, 29.8)])
    flights = monte_carlo(route, city, SLOW, BREEZE, Autopilot(speed=0.7, gps=gps), rng=2, flights=20)
    above = flights.crashed & (flights.place[:, 0] > 30)
    assert above.sum() > 0
    assert found.value == flights.crashed.sum() < 20


def test_how_many_fail_and_how_many_may():
    wall = Building.prism([(45, 50.9), (47, 50.9), (47, 100), (45, 100)], 60.0)
    city = City.from_buildings([wall], cell=0.9, origin=(0, 0, 0), size=(100, 100, 60), reference=DELFT)
    mission = by_hand((10, 48.5, 30), (90, 48.5, 30))
    found = checked(mission, city, weather=Wind(deviation=1.5), flights=80, rng=5)
    count = found["flights"].value
    assert 5 < count < 75
    assert found["flights"].limit == 0
    assert not found["flights"].met
    assert f"at most {100 * beta.ppf(0.975, count + 1, 80 - count):.3g} %" in found["flights"].words
    points = mission.path(city).points.copy()
    points[0, 2] = 1.0
    points = np.insert(points, 3, points[2] - (0, 0, 25.0), axis=0)
    flights = monte_carlo(
        Route(points), city, LIGHT_QUADROTOR, Wind(deviation=1.5), Autopilot(speed=5.0), rng=5, flights=80
    )
    assert count == pytest.approx(flights.crashed.sum(), abs=6)
    assert f"{80 - count} that arrived" in found["energy"].words or f"most of {80 - count} " in found["energy"].words
    none = checked(flights=100)["flights"]
    assert none.met
    assert f"at most {100 * (1 - 0.025 ** (1 / 100)):.3g} %" in none.words


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("altitudes", ["home", "terrain"])
def test_what_is_made_from_a_route_is_as_it_should_be(seed, altitudes):
    """All that from_route promises; what gusts and GPS make of it is another matter."""
    city, rng = hills(seed % 5, 8.0), np.random.default_rng(seed)
    free = city.center_of(np.argwhere(~city.blocked(1.0, min_height=4.0)))
    route = astar(city, *free[rng.integers(len(free), size=2)], min_clearance=1.0, min_height=4.0)
    assert route.reached
    assert len(route.points) > 4
    end = ("land", "return", "stay")[seed % 3]
    mission = Mission.from_route(
        route.resample(2.0), city, RISK_QUADROTOR, altitudes=altitudes, end=end, speed=4.0, corridor=3.0,
        corner_radius=0.5 + seed / 2,
    )  # fmt: skip
    found = preflight(mission, city, RISK_QUADROTOR, BREEZE, min_clearance=1.0, flights=1, rng=seed)
    assert {check.name for check in found.failed} <= {"flights", "energy"}
    for one, other in pairwise(way(mission, city)):
        along = samples([one, other]) if altitudes == "home" else followed(city, one, other)
        assert city.distance(along, exact_within=60.0).min() >= found["clearance"].value - 1e-6
        assert city.height_above_ground(along).min() >= found["least height"].value - 0.006


def test_a_mission_of_a_file_is_judged_too():
    """As another program writes it: no return height, no radii, a landing elsewhere, heights above the sea."""
    city = table1()
    items = (
        at((5, 5), 30.0, 22), at((5, 40), 30.0, parameters=(math.nan, 0.0, 0.0, math.nan)),
        Item(178, 2, (1.0, math.nan, -1.0, 0.0)), at((5, 80), 30.0, parameters=(3.0, 0.0, 0.0, 0.0)),
        at((8, 90), 0.0, 21),
    )  # fmt: skip
    mission = Mission(items, DELFT, (square((-30, -30, 130, 130)),), speed=6.0, corner_radius=4.0)
    longitude, latitude = DELFT.longitude_latitude((5, 5))
    mission = replace(mission, home=Place(float(longitude), float(latitude), 17.0))
    found = checked(mission, city)
    assert [check.name for check in found.failed] == ["return height"]
    assert found["speed"].value == 6.0
    assert found["landing"].words.endswith("(8.0, 90.0, 30.0)")
    apart = city.distance(samples([(5, 5, 30), (5, 80, 30), (8, 90, 30)]), exact_within=60.0).min()
    assert found["clearance"].value == pytest.approx(apart, abs=0.02)


@pytest.mark.parametrize(
    ("message", "options"),
    [
        ("mission must be a Mission, got Route", {"mission": Route(POINTS)}),
        ("city must be a City, got str", {"city": "Delft"}),
        ("uav must be a UAV, got str", {"uav": "drone"}),
        ("weather must be a Wind, got str", {"weather": "fine"}),
        ("gps must be a Gps, got float", {"gps": 4.7}),
        ("gps.drift must be finite and at least 0, got -1", {"gps": Gps(drift=-1.0)}),
        ("ceiling must be finite and above 0, got -5", {"ceiling": -5.0}),
        ("ceiling must be finite and above 0", {"ceiling": math.inf}),
        ("min_clearance must be finite and at least 0, got -1", {"min_clearance": -1.0}),
        ("fence_margin must be finite and at least 0, got -1", {"fence_margin": -1.0}),
        ("flights must be a whole number of at least 1, got 2.5", {"flights": 2.5}),
        ("flights must be a whole number of at least 1, got 0", {"flights": 0}),
        ("flights must be at most 1,000,000", {"flights": 10_000_000}),
        ("rng must be a numpy.random.Generator, or a seed", {"rng": None}),
        (r"mission: items\[0\] lands before it has flown", {"mission": replace(made(), items=made().items[-1:])}),
        (r"mission must have an item at a place", {"mission": replace(made(), items=made().items[1:2])}),
        (r"mission: items\[2\].*isn't known", {"mission": by_hand((5, 5, 30), (9, 5, 30), end=82)}),
        (r"mission lies \d\d+ km off city 'the city of REPARE Table 1': give the city", {
            "mission": by_hand((5, 5, 30), (90_000, 5, 30))}),
        ("has a place in frame 1", {"mission": other_items(made(), lambda n, item: item._replace(frame=1))}),
        ("mission must fly somewhere, and stays where it begins", {"mission": by_hand((5, 5, 1), end=None)}),
    ],
)  # fmt: skip
def test_what_cant_be_checked_is_refused_by_name(message, options):
    with pytest.raises(ValueError, match=message):
        checked(**options)


def test_a_table_of_something_else_is_refused():
    with pytest.raises(ValueError, match="checks must hold at least 1 Check"):
        Preflight((), made())
    with pytest.raises(ValueError, match=r"checks\[0\] must be a Check"):
        Preflight(("fine",), made())
    with pytest.raises(ValueError, match="mission must be a Mission"):
        Preflight((Check("a", 2.0, 2.5, "m", False, ""),), "mission")
