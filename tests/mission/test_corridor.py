"""Legs and corners keep what the route promises, by points that are sampled densely, in cities that are drawn."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from missions import CENTIMETRE, campus, corners, distance_to_polyline, followed, hills, placed, samples, table1, way

from uavlab.city import Building, City, NoFlyZone, Terrain
from uavlab.city.bounds import bounds_of
from uavlab.mission import Mission
from uavlab.mission.corridor import Corridor, corner, cut_off, distance_to_leg, floor_below
from uavlab.planners import astar, theta_star
from uavlab.route import Route
from uavlab.spline import smooth
from uavlab.vehicle import LIGHT_QUADROTOR, RISK_QUADROTOR

SEEDS = st.integers(0, 10_000)
FEW = settings(max_examples=60, suppress_health_check=[HealthCheck.filter_too_much, HealthCheck.too_slow])
SHAFT = "a wall is .* m away"
"""What is said of starts and goals below which a wall is too near; others are drawn instead."""


def promised(route, uav):
    return max(route.min_clearance, uav.diameter / 2)


def check_way(mission, city, route, uav, corridor):
    """All that a mission promises of its way, along straight legs."""
    points = way(mission, city)
    along = samples(points)
    assert city.distance(along).min() >= promised(route, uav) - CENTIMETRE
    flown = route.points[route.takeoff : len(route.points) - route.landing]
    assert distance_to_polyline(along, flown).max() <= corridor + CENTIMETRE
    assert distance_to_polyline(samples(flown, 0.2), points).max() <= corridor + CENTIMETRE
    check_zones(city, along)
    check_corners(mission, city, promised(route, uav))


def check_corners(mission, city, keep):
    for within in corners(mission, city):
        assert city.distance(within).min() >= keep - CENTIMETRE
        check_zones(city, within)


def check_zones(city, points):
    """By their polygons and heights; flat cities only."""
    for zone in city.no_fly:
        height = city.height_above_ground(points)
        inside = shapely.contains_xy(zone.polygon, points[:, 0], points[:, 1])
        assert not (inside & (height > zone.lower) & (height < zone.upper)).any()


def planned(city, seed, keep, planner=astar, **heights):
    """A route between two places that are drawn."""
    free = city.center_of(np.argwhere(~city.blocked(keep, **heights)))
    rng = np.random.default_rng(seed)
    start = free[rng.integers(len(free))]
    far = free[np.linalg.norm(free - start, axis=1) > 40.0]
    route = planner(city, start, far[rng.integers(len(far))], min_clearance=keep, **heights)
    assume(route.reached)
    return route


def made(route, city, uav, **options):
    """The mission; others are drawn where nothing can rise or land."""
    try:
        return Mission.from_route(route, city, uav, ceiling=1000.0, **options)
    except ValueError as error:
        assume("a wall is" not in str(error))
        raise


@FEW
@given(
    SEEDS,
    st.sampled_from([2.0, 4.0, 4.0, 5.0, 5.0]),
    st.floats(0.5, 2.5),
    st.floats(0.1, 6.0),
    st.floats(0.2, 6.0),
    st.sampled_from([astar, theta_star]),
)
def test_legs_and_corners_keep_the_promise_in_repares_city(seed, cell, keep, corridor, radius, planner):
    city = table1(cell)
    route = planned(city, seed, keep, planner)
    mission = made(route, city, LIGHT_QUADROTOR, corridor=corridor, corner_radius=radius)
    check_way(mission, city, route, LIGHT_QUADROTOR, corridor)
    assert len(placed(mission)) <= len(route.points)


@FEW
@given(SEEDS, SEEDS, st.floats(0.2, 2.4), st.floats(0.1, 6.0), st.floats(0.2, 8.0))
def test_legs_and_corners_keep_the_promise_on_a_campus(number, seed, keep, corridor, radius):
    city = campus(number % 6)
    west, south = 10.0 + seed % 100, 15.0 + (7 * seed) % 100
    zone = NoFlyZone([(west, south), (west + 22, south), (west + 22, south + 9), (west, south + 9)], upper=50.0)
    city = replace(city, no_fly=[zone])
    route = planned(city, seed, keep, min_height=10.0, max_height=70.0)
    assume(not zone.polygon.buffer(8.0).intersects(shapely.MultiPoint(route.points[[0, -1], :2])))
    mission = made(route, city, RISK_QUADROTOR, corridor=corridor, corner_radius=radius)
    check_way(mission, city, route, RISK_QUADROTOR, corridor)
    above = city.height_above_ground(samples(way(mission, city)))
    assert above.min() >= 10.0 - CENTIMETRE
    assert above.max() <= 70.0 + CENTIMETRE


@FEW
@given(SEEDS, SEEDS, st.floats(0.5, 2.0), st.floats(0.5, 5.0), st.floats(0.5, 5.0), st.floats(1.0, 14.0))
def test_legs_that_follow_the_ground_keep_the_promise(number, seed, keep, corridor, radius, height):
    city = hills(number % 5, height)
    route = planned(city, seed, keep, min_height=4.0).resample(2.0)
    try:
        mission = made(route, city, RISK_QUADROTOR, altitudes="terrain", corridor=corridor, corner_radius=radius)
    except ValueError as error:
        assume("leaves the ground's slope" not in str(error) and "isn't clear" not in str(error))
        raise
    points = way(mission, city)
    along = np.concatenate([followed(city, *leg) for leg in pairwise(points)])
    assert city.distance(along).min() >= promised(route, RISK_QUADROTOR) - CENTIMETRE
    assert distance_to_polyline(along, route.points).max() <= corridor + CENTIMETRE
    check_corners(mission, city, promised(route, RISK_QUADROTOR))


def test_few_waypoints_stand_for_many():
    city = table1(2.0)
    route = astar(city, (5, 5, 31), (95, 95, 31), min_clearance=2.0)
    mission = Mission.from_route(route, city, LIGHT_QUADROTOR)
    assert len(placed(mission)) < len(route.points) / 2
    again = Mission.from_route(route.resample(0.5), city, LIGHT_QUADROTOR)
    assert len(placed(again)) < len(route.points) / 2


def test_a_straight_route_has_two_waypoints():
    city = table1()
    route = Route([(5, 5, 30), (5, 95, 30)]).resample(1.0)
    mission = Mission.from_route(route, city, LIGHT_QUADROTOR)
    assert [item.command for item in mission.items] == [22, 178, 16, 21]
    assert way(mission, city) == pytest.approx(np.array([(5, 5, 30), (5, 95, 30)]), abs=CENTIMETRE)


def test_a_curve_is_a_route():
    city = table1(2.0)
    curve = smooth(astar(city, (5, 5, 31), (95, 95, 31), min_clearance=2.0), city, LIGHT_QUADROTOR)
    mission = Mission.from_route(curve, city, LIGHT_QUADROTOR, corridor=1.0)
    check_way(mission, city, curve.route(), LIGHT_QUADROTOR, 1.0)
    assert 3 < len(placed(mission)) < len(curve.route().points) / 20
    fine = Mission.from_route(curve, city, LIGHT_QUADROTOR, corridor=0.05)
    assert len(placed(mission)) < len(placed(fine))
    assert way(mission, city)[[0, -1]] == pytest.approx(curve.points[[0, -1]], abs=CENTIMETRE)


def test_way_between_two_houses_isnt_cut_short():
    """The straight leg would lie within the corridor, and in a house."""
    houses = [Building.prism([(10, 0), (14, 0), (14, 20), (10, 20)], 30), Building.prism([(30, 24), (34, 24), (34, 44),
              (30, 44)], 30)]  # fmt: skip
    city = City.from_buildings(houses, cell=1.0, origin=(0, 0, 0), size=(50, 50, 50), reference=(4.36, 52.01))
    route = Route([(2, 10, 20), (6, 22, 20), (38, 22, 20), (45, 35, 20)])
    mission = Mission.from_route(route, city, RISK_QUADROTOR, corridor=30.0)
    assert city.distance(samples(way(mission, city))).min() >= 0.2 - CENTIMETRE
    assert len(placed(mission)) > 2


def test_zones_arent_cut_through():
    zone = NoFlyZone([(10, -5), (30, -5), (30, 5), (10, 5)], name="school")
    city = City(np.zeros((50, 50, 40), bool), reference=(4.36, 52.01), origin=(-5, -10, 0), no_fly=[zone])
    route = Route([(0, 0, 20), (9, 7, 20), (31, 7, 20), (40, 0, 20)])
    mission = Mission.from_route(route, city, RISK_QUADROTOR, corridor=30.0, end="stay")
    check_zones(city, samples(way(mission, city)))
    low = replace(zone, upper=15.0)
    over = Mission.from_route(route, replace(city, no_fly=[low]), RISK_QUADROTOR, corridor=30.0)
    assert len(placed(over)) == 2


CORNER = Building.prism([(0, 0), (20, 0), (20, 20), (0, 20)], 40)


@pytest.fixture(scope="module")
def block():
    """A city of one tower, whose north-east corner is at (20, 20)."""
    return City.from_buildings([CORNER], cell=1.0, origin=(-20, -20, 0), size=(80, 80, 60), reference=(4.36, 52.01))


@pytest.mark.parametrize(
    ("clearance", "keep", "radius", "stops"),
    [
        (4.0, 1.0, 2.0, False),
        (4.0, 3.8, 2.0, True),
        (4.0, 3.8, 0.1, False),
        (3.0, 0.5, 6.0, True),  # the triangle reaches the tower's edge
        (4.0, 0.5, 6.0, False),
    ],
)
def test_corners_that_cant_be_rounded_are_stops(block, clearance, keep, radius, stops):
    at = 20.0 + clearance
    route = Route([(at, 0, 20), (at, at, 20), (0, at, 20)], min_clearance=keep)
    mission = Mission.from_route(route, block, RISK_QUADROTOR, corner_radius=radius, corridor=0.01)
    assert (placed(mission)[1].parameters[0] == 1.0) is stops
    assert any("it stops at 1 corners" in note for note in mission.notes) is stops
    check_corners(mission, block, keep)


def test_short_legs_are_rounded_less(block):
    """Else an autopilot would be at the next waypoint before it came to this one, and leave out both."""
    zigzag = [(30 + (n % 2), 1.5 * n, 20) for n in range(12)]
    mission = Mission.from_route(Route(zigzag), block, RISK_QUADROTOR, corner_radius=5.0, corridor=0.01)
    items = placed(mission)
    assert len(items) == 12
    leg = np.hypot(1.0, 1.5)
    for item in items[1:-1]:
        assert item.parameters[1] == pytest.approx(leg / 2, abs=1e-3)


def test_no_leg_is_too_short_for_a_radius(block):
    """An autopilot takes 0 for its own."""
    route = Route([(30, 0, 20), (30, 5, 20), (30.004, 5, 20), (30.004, 5, 25)])
    mission = Mission.from_route(route, block, RISK_QUADROTOR, corridor=0.001)
    assert len(placed(mission)) == 4
    assert [item.parameters[1] for item in placed(mission)[1:]] == [0.01, 0.01, 2.0]


def test_the_corner_before_a_climb_home_is_rounded_clear_or_a_stop():
    """Out from under an eave, and up right before it."""
    eave = Building.prism([(20, 0), (60, 0), (60, 40), (20, 40)], 34, bottom=22.0)
    city = City.from_buildings([eave], cell=1.0, origin=(0, 0, 0), size=(60, 60, 60), reference=(4.36, 52.01))
    route = Route([(50, 50, 20), (30, 45, 20), (30, 20, 20), (19, 20, 20)], min_clearance=0.5)
    stopping = Mission.from_route(route, city, RISK_QUADROTOR, corner_radius=5.0, end="return")
    assert placed(stopping)[-2].parameters[0] == 1.0
    assert Mission.from_route(route, city, RISK_QUADROTOR, corner_radius=5.0, end="stay").items[-2].parameters[0] == 0.0
    rounding = Mission.from_route(route, city, RISK_QUADROTOR, corner_radius=0.8, end="return")
    assert placed(rounding)[-2].parameters[0] == 0.0
    for mission in (stopping, rounding):
        check_corners(mission, city, 0.5)


@pytest.mark.parametrize("turn", np.radians([1.0, 30.0, 60.0, 89.0, 91.0, 120.0, 179.0]))
def test_no_point_of_the_corner_is_farther_inside_than_said(turn):
    into, out = np.array([1.0, 0.0, 0.0]), np.array([np.cos(turn), np.sin(turn), 0.0])
    reach = 3.0
    rng = np.random.default_rng(0)
    weights = rng.dirichlet((0.5, 0.5, 0.5), 5000)
    inside = weights @ np.array([-reach * into, np.zeros(3), reach * out])
    legs = np.array([-reach * into, np.zeros(3), reach * out])
    farthest = distance_to_polyline(inside, legs).max()
    assert farthest <= cut_off(into, out, reach) + 1e-12
    if turn < np.pi / 2:
        middle = (reach * out - reach * into) / 2
        assert distance_to_polyline(middle[None], legs)[0] == pytest.approx(cut_off(into, out, reach))


def test_a_corner_reaches_no_farther_than_half_its_legs():
    into, out, reach = corner(np.zeros(3), np.array([10.0, 0, 0]), np.array([10.0, 3.0, 0]), 4.0)
    assert into.tolist() == [1, 0, 0]
    assert out.tolist() == [0, 1, 0]
    assert reach == 1.5
    assert corner(np.zeros(3), np.array([10.0, 0, 0]), np.array([10.0, 30.0, 0]), 4.0)[2] == 4.0


def test_distance_to_a_leg():
    points = np.array([(5.0, 3.0, 0.0), (-3.0, 4.0, 0.0), (10.0, 0.0, 2.0)])
    assert distance_to_leg(points, np.zeros(3), np.array([10.0, 0, 0])) == pytest.approx([3.0, 5.0, 2.0])
    assert len(distance_to_leg(points[:0], np.zeros(3), np.ones(3))) == 0


RIDGE = Terrain.from_raster([[0, 0, 10, 0, 0]] * 5, (0, 0, 50, 50), beyond="nearest")
"""A ridge from south to north, 10 m high at x = 25."""


def test_ground_below_a_leg_is_known_at_its_bends():
    """The top of the ridge lies between columns' centres and halves of voxels: it must not be stepped over."""
    city = City.from_buildings([], cell=10.0, origin=(0, 0, -10), size=(50, 50, 60), terrain=RIDGE)
    legs = Corridor(city, bounds_of(city), 1.0, True)
    for west, east in ((5.0, 45.0), (12.0, 45.0), (21.0, 28.0), (1.0, 31.0)):
        start, end = np.array([west, 25.0, 30.0]), np.array([east, 25.0, 30.0])
        share = np.linspace(0, 1, 40_001)
        ground = -city.height_above_ground(np.column_stack([west + share * (east - west), 0 * share + 25, 0 * share]))
        rise = np.abs(ground - ground[0] - share * (ground[-1] - ground[0])).max()
        assert legs.rise(start, end) == pytest.approx(rise, abs=1e-3)
    assert Corridor(city, bounds_of(city), 1.0, False).rise(start, end) == 0.0


@given(SEEDS)
@settings(max_examples=60)
def test_rise_is_the_farthest_that_the_ground_leaves_a_slope(seed):
    city = hills(seed % 5, 14.0)
    start, end = np.random.default_rng(seed).uniform((3, 3, 30), (117, 117, 40), (2, 3))
    if seed % 3 == 0:
        end[:2] = start[:2] + (end - start)[:2] / 30
    share = np.linspace(0, 1, 20_001)[:, None]
    ground = -city.height_above_ground((start + share * (end - start)) * (1, 1, 0))
    rise = np.abs(ground - ground[0] - share[:, 0] * (ground[-1] - ground[0])).max()
    assert Corridor(city, bounds_of(city), 1.0, True).rise(start, end) == pytest.approx(rise, abs=2e-3)


def test_a_leg_that_follows_the_ground_stays_above_the_ridge():
    city = City.from_buildings([], cell=2.0, origin=(0, 0, -10), size=(50, 50, 80), terrain=RIDGE, reference=(4.4, 52))
    straight = Route([(5, 25, 14), (45, 25, 14)])
    with pytest.raises(ValueError, match=r"route leaves the ground's slope by 10\.0 m .*route\.resample\(2\)"):
        Mission.from_route(straight, city, RISK_QUADROTOR, altitudes="terrain")
    assert len(placed(Mission.from_route(straight, city, RISK_QUADROTOR, altitudes="home"))) == 2
    mission = Mission.from_route(straight.resample(2.0), city, RISK_QUADROTOR, altitudes="terrain", corridor=0.5)
    points = way(mission, city)
    along = np.concatenate([followed(city, *leg) for leg in pairwise(points)])
    assert np.abs(along[:, 2] - 14.0).max() <= 0.5 + CENTIMETRE


def test_below_a_point_lies_the_roof_and_the_ground():
    city = table1(1.0)
    assert floor_below(city, np.array([30.5, 80.5, 30.5])) == (0.0, 0.0)
    assert floor_below(city, np.array([30.5, 80.5, 80.5])) == (60.0, 60.0)  # on the floating building
    assert floor_below(city, np.array([80.5, 70.5, 95.5])) == (90.0, 90.0)
    sloped, top = floor_below(city, np.array([12.5, 35.5, 90.5]))  # a hip roof
    assert 60.0 < sloped < 62.5
    assert top in (61.0, 62.0)


@pytest.mark.parametrize("high", [3.0, 30.0])
@pytest.mark.parametrize("where", ["start", "goal"])
def test_a_narrow_shaft_is_refused(where, high):
    walls = [Building.prism([(20, 0), (22, 0), (22, 40), (20, 40)], high), Building.prism([(22.8, 0), (25, 0), (25, 40),
             (22.8, 40)], high)]  # fmt: skip
    city = City.from_buildings(walls, cell=0.4, origin=(0, 0, 0), size=(40, 40, 50), reference=(4.36, 52.01))
    points = [(22.4, 20, 40), (5, 20, 40)]
    points = points if where == "start" else points[::-1]
    name = "home" if where == "start" else "the goal"
    with pytest.raises(ValueError, match=rf"{name} at .* {SHAFT}, and a UAV of 1 m needs 0\.5 m: begin and end"):
        Mission.from_route(Route(points), city, LIGHT_QUADROTOR)
    assert Mission.from_route(Route(points), city, RISK_QUADROTOR)  # half as wide
    if where == "goal":
        assert Mission.from_route(Route(points), city, LIGHT_QUADROTOR, end="stay")


@pytest.mark.parametrize(
    ("route", "options", "message"),
    [
        (Route([(5, 20, 20), (45, 20, 20)]), {}, r"route isn't clear between waypoints 0 \(5\.0, 20\.0, 20\.0\)"),
        (Route([(21.5, -9, 20), (21.5, 30, 20)]), {"min_clearance": 2.0}, r"1\.50 m .* has to keep 2\.00 m"),
        (Route([(30, -9, 20), (30, 30, 20)], max_height=15.0), {}, "too low or too high; plan it with min_clearance"),
        (Route([(30, -9, 20), (30, 30, 20)], min_height=25.0), {}, "too low or too high"),
        (Route([(30, -9, 20), (90, -9, 20)]), {}, "route isn't clear"),  # off the map
        (Route([(20.3, -9, 20), (20.3, 30, 20)]), {}, r"0\.30 m to an obstacle where it has to keep 0\.50 m"),
    ],
)
def test_a_route_that_isnt_clear_is_refused(block, route, options, message):
    with pytest.raises(ValueError, match=message):
        Mission.from_route(route, block, LIGHT_QUADROTOR, **options)


def test_less_clearance_may_be_asked_for_than_was_promised(block):
    route = Route([(21.5, -9, 20), (21.5, 30, 20)], min_clearance=2.0)
    assert Mission.from_route(route, block, LIGHT_QUADROTOR, min_clearance=1.0)
