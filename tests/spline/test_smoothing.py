"""Smoothing: what was clear before is clear after, by samples that share nothing with the check in the code."""

import re

import numpy as np
import pytest

from uavlab.city import City, NoFlyZone
from uavlab.planners import astar, shortcut
from uavlab.risk import random_campus
from uavlab.route import Route
from uavlab.spline import Curve, smooth, smoothing
from uavlab.vehicle import LIGHT_QUADROTOR, RISK_QUADROTOR

RADIUS = RISK_QUADROTOR.diameter / 2
HIGH = 1.1  # clearance of the voxels [m]: then even at their corners the body is clear of the obstacles


def samples(curve, parts=4):
    """Points on a curve, so many for each of its own."""
    return curve.at(np.linspace(0, curve.parameter[-1], parts * len(curve.points)))


def body_distance(city, points):
    """Least distance of points (N, 3) to an obstacle, looking into each of the 27 voxels around; up to one voxel."""
    cells = (points - city.origin) / city.cell
    least = 1.0
    for shift in np.ndindex(3, 3, 3):
        voxel = np.floor(cells).astype(int) + np.array(shift) - 1
        inside = ((voxel >= 0) & (voxel < city.shape)).all(axis=1)
        full = np.zeros(len(voxel), bool)
        full[inside] = city.occupied[tuple(voxel[inside].T)]
        gap = np.maximum(np.maximum(voxel - cells, cells - voxel - 1), 0)[full]
        least = min(least, np.linalg.norm(gap, axis=1).min(initial=least))
    return least * city.cell


def planned(city, count, seed, min_clearance):
    """Routes on the grid, and the same without the waypoints that can be left out."""
    pairs = city.random_pairs(count, seed, min_clearance=min_clearance)
    routes = [astar(city, start, goal, min_clearance=min_clearance) for start, goal in pairs]
    return [(route, shortcut(route, city, min_clearance=min_clearance)) for route in routes if route.reached]


@pytest.fixture(scope="module")
def flights(table1):
    """City, route on the grid and any-angle route, of Table 1's city and of three campuses."""
    cases = [(table1, *routes) for routes in planned(table1, 80, 3, HIGH)]
    for seed in range(3):
        city = random_campus(seed).city
        cases += [(city, *routes) for routes in planned(city, 14, seed, 0.0)]
    return cases


@pytest.fixture(scope="module")
def any_angle(flights):
    """City and any-angle route, only of those that are clear for the body before they are smoothed."""
    clear = []
    for city, _, route in flights:
        if body_distance(city, route.resample(RADIUS / 20).points) >= RADIUS:
            clear.append((city, route))
    assert len(clear) >= 100
    return clear


@pytest.fixture(scope="module")
def smoothed(any_angle):
    """The same with the curves that they become."""
    return [(city, route, smooth(route, city, RISK_QUADROTOR)) for city, route in any_angle]


def test_a_hundred_clear_any_angle_routes_are_clear_after_smoothing_too(smoothed):
    for city, route, curve in smoothed:
        assert body_distance(city, samples(curve)) >= (1 - smoothing.CONTACT) * RADIUS
        assert city.inside(samples(curve)).all()
        assert np.array_equal(curve.points[[0, -1]], route.points[[0, -1]])


def test_without_repair_many_of_them_would_collide(smoothed):
    """Measured 28 of 80 in Table 1's city; 5 of 42 on the campuses, where legs are shorter and the way is wider.

    The ranges are three standard errors wide and more.
    """
    by_name = {}
    for city, route, curve in smoothed:
        hits = body_distance(city, samples(Curve(route.points, step=0.05), 1)) < (1 - smoothing.CONTACT) * RADIUS
        by_name.setdefault(city.name.split()[0], []).append(hits)
        assert curve.info["rounds"] > 0 or not hits
    shares = {name: np.mean(hits) for name, hits in by_name.items()}
    table1, campus = (shares[name] for name in sorted(shares, key=shares.get, reverse=True))
    assert 0.19 < table1 < 0.51
    assert 0 < campus < 0.27


def test_control_points_on_every_node_of_the_grid_need_no_repair(flights):
    for city, route, _ in flights:
        curve = smooth(route, city, RISK_QUADROTOR)
        assert curve.info == {"rounds": 0, "inserted": 0, "repeated": 0}
        assert np.array_equal(curve.control, route.points)
        assert body_distance(city, samples(curve)) >= RADIUS


def test_a_body_as_wide_as_the_gap_is_repaired_on_the_grid_too(table1):
    """With 0.5 m from node to wall, a body of 1 m has no room for cutting corners."""
    rounds = []
    for route, _ in planned(table1, 20, 1, 0.5):
        curve = smooth(route, table1, LIGHT_QUADROTOR)
        rounds.append(curve.info["rounds"])
        assert body_distance(table1, samples(curve)) >= (1 - smoothing.CONTACT) * LIGHT_QUADROTOR.diameter / 2
    assert np.mean(np.array(rounds) > 0) > 0.3


def test_what_was_repaired_is_counted_and_named(smoothed):
    for _, route, curve in smoothed:
        added = curve.info["inserted"] + curve.info["repeated"]
        assert len(curve.control) == len(route.points) + added
        assert (added > 0) == (curve.info["rounds"] > 0)
        assert curve.info["rounds"] <= smoothing.MIDPOINT_ROUNDS or curve.info["repeated"]
        assert curve.planner == f"{route.planner} + B-spline"
        assert curve.step == RISK_QUADROTOR.diameter / 8


def test_control_points_stay_on_the_route(smoothed):
    """Midpoints of its legs, and its waypoints among them, in order."""
    for _, route, curve in smoothed:
        control = curve.control
        where = [np.flatnonzero((control == point).all(axis=1)) for point in route.points]
        assert all(len(found) >= 1 for found in where)
        firsts = [found[0] for found in where]
        assert firsts == sorted(firsts)
        for leg in range(len(route.points) - 1):
            start, end = route.points[leg : leg + 2]
            between = control[firsts[leg] : firsts[leg + 1] + 1] - start
            along = between @ (end - start) / ((end - start) @ (end - start))
            assert between == pytest.approx(np.outer(along, end - start), abs=1e-9)
            assert (np.diff(along) >= 0).all()


def around_a_corner(leg, gap, cell=1.0):
    """A block, and a route around its corner: two long legs along its walls, so near that only corners are clear."""
    size = int(leg + 3)
    occupied = np.zeros((size, size, 3), bool)
    occupied[: int(leg), : int(leg)] = True
    reach = int(leg) + gap
    return City(occupied, cell), Route([(0.5, reach, 1.5), (reach, reach, 1.5), (reach, 0.5, 1.5)])


@pytest.mark.parametrize(("leg", "times"), [(128, 2), (256, 3)])
def test_long_legs_that_hug_a_corner_need_waypoints_that_stand_twice_or_three_times(leg, times):
    """Six rounds leave legs of 2 or 4 m, which cut the corner by √2/6 of that, 0.47 or 0.94 m; doubled by √2/48.

    And 0.28 m is the way from the waypoint to the block's corner, of which a radius of 0.2 m is needed.
    """
    city, route = around_a_corner(leg, RADIUS)
    curve = smooth(route, city, RISK_QUADROTOR)
    assert curve.info["rounds"] > smoothing.MIDPOINT_ROUNDS
    assert curve.info["repeated"] > 0
    assert curve.info["inserted"] > 0
    assert body_distance(city, samples(curve, 50)) >= (1 - smoothing.CONTACT) * RADIUS
    assert (curve.control == route.points[1]).all(axis=1).sum() == times
    assert np.isinf(curve.curvature.max()) == (times == 3)


def test_short_legs_that_hug_a_corner_need_only_midpoints():
    city, route = around_a_corner(8, RADIUS)
    curve = smooth(route, city, RISK_QUADROTOR)
    assert 0 < curve.info["rounds"] <= smoothing.MIDPOINT_ROUNDS
    assert curve.info["repeated"] == 0
    assert np.isfinite(curve.curvature).all()
    assert body_distance(city, samples(curve, 50)) >= (1 - smoothing.CONTACT) * RADIUS


def test_midpoints_go_into_all_legs_that_a_wrong_segment_depends_on():
    control = np.arange(6.0)[:, None] * (2.0, 0.0, 1.0)
    for wrong, middles in (([2], [1, 2, 3]), ([0], [0, 1]), ([4], [3, 4]), ([0, 4], [0, 1, 3, 4]), ([], [])):
        finer = smoothing.with_midpoints(control, np.isin(np.arange(5), wrong))
        assert finer == pytest.approx(np.sort([*range(6), *(middle + 0.5 for middle in middles)])[:, None] * (2, 0, 1))


def test_the_ends_of_a_wrong_segment_are_repeated_but_stand_no_more_than_three_times():
    control = np.arange(4.0)[:, None] * (2.0, 0.0, 1.0)
    wrong = np.array([False, True, False])
    for times in (2, 3):
        control = smoothing.with_repeated(control, wrong)
        assert control[:, 2].tolist() == [0, *[1] * times, *[2] * times, 3]
        wrong = np.isin(np.arange(len(control) - 1), times)
    assert np.array_equal(smoothing.with_repeated(control, wrong), control)
    assert len(smoothing.with_repeated(control, ~wrong)) == len(control) + 2  # the first and the last point


def test_repeating_waypoints_alone_clears_them_as_well(any_angle, monkeypatch):
    monkeypatch.setattr(smoothing, "MIDPOINT_ROUNDS", 0)
    repaired = 0
    for city, route in any_angle:
        curve = smooth(route, city, RISK_QUADROTOR)
        assert curve.info["inserted"] == 0
        assert curve.info["rounds"] <= 2 * len(route.points)
        assert body_distance(city, samples(curve)) >= (1 - smoothing.CONTACT) * RADIUS
        repaired += curve.info["repeated"] > 0
        _, times = np.unique(curve.control, axis=0, return_counts=True)
        assert times.max() <= 3
    assert repaired > 20


def test_where_not_even_straight_lines_are_clear_it_says_so(monkeypatch):
    """Which can't be, or the route would have been refused; unless the curve is asked for more than the route."""
    city, route = around_a_corner(8, RADIUS)
    monkeypatch.setattr(smoothing, "refuse_route", lambda *_: None)
    with pytest.raises(ValueError, match=r"route passes an obstacle so closely at \(.*\) that not even straight"):
        smooth(route, city, RISK_QUADROTOR, min_clearance=0.3)


def exact_distance(city, points):
    """Least distance of points (N, 3) to an occupied voxel, from all of them [m]."""
    low = city.center_of(np.argwhere(city.occupied)) - city.cell / 2
    gaps = (np.maximum(np.maximum(low - point, point - low - city.cell), 0) for point in points)
    return min(np.linalg.norm(gap, axis=1).min(initial=np.inf) for gap in gaps)


def test_the_curve_keeps_min_clearance_all_along(table1):
    """As far as any-angle routes do, to the last bit; unless it is asked for less."""
    nearer = 0
    for _, route in planned(table1, 40, 5, 2.0):
        curve = smooth(route, table1, RISK_QUADROTOR)
        assert table1.distance(samples(curve), 4.0).min() >= 2.0 - 1e-8
        assert curve.clearance(table1) >= 2.0 - 1e-8
        nearer += smooth(route, table1, RISK_QUADROTOR, min_clearance=0.0).clearance(table1) < 2.0 - 1e-6
    assert nearer > 10  # so it takes a request


@pytest.mark.parametrize("seed", range(20))
def test_on_random_maps_the_curve_keeps_what_the_route_was_asked_for(seed):
    rng = np.random.default_rng(seed)
    occupied = rng.random((20, 16, 10)) < 0.015
    city = City(occupied, rng.choice([0.5, 2.0, 5.0]), rng.choice([0.0, 5e5], 3))
    min_clearance = city.cell * rng.uniform(0.5, 2.0)
    rounding = city.cell * 2e-9 + 4e-15 * np.abs(city.bounds).max()
    for start, goal in city.random_pairs(2, rng, apart=10 * city.cell, min_clearance=min_clearance):
        route = astar(city, start, goal, min_clearance=min_clearance)
        if route.reached and min_clearance >= RADIUS:
            for flown in (route, shortcut(route, city, min_clearance=min_clearance)):
                curve = smooth(flown, city, RISK_QUADROTOR, min_clearance=min_clearance)
                points = curve.at(np.arange(0, curve.parameter[-1], 0.05))
                assert exact_distance(city, points) >= min_clearance - rounding


def hills(seed=0):
    """A map with ground that goes up and down, and a zone."""
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(30), np.arange(24), indexing="ij")
    ground = 3 * np.sin(x / rng.uniform(2, 5)) + 2 * np.cos(y / rng.uniform(2, 5))
    zone = NoFlyZone([(11.3, 8.2), (17.1, 9.4), (14, 16.7)], 0.0, 100.0)
    return City(np.zeros((30, 24, 30), bool), 1.0, (0, 0, -6), ground=ground, no_fly=(zone,))


@pytest.mark.parametrize("seed", range(8))
def test_heights_and_zones_are_kept_between_take_off_and_landing(seed):
    city, heights = hills(seed), {"min_height": 4.0, "max_height": 9.0}
    ends = [(x, 11.5, np.floor(city.range_of_ground[1][int(x), 11]) + 1.5) for x in (2.5, 27.5)]
    route = shortcut(astar(city, *ends, **heights), city, **heights)
    assert min(route.takeoff, route.landing) > 0
    curve = smooth(route, city, RISK_QUADROTOR, **heights)
    assert (curve.takeoff, curve.landing) == (route.takeoff + 1, route.landing + 1)
    assert curve.points[[0, -1]] == pytest.approx(np.array(ends))
    parameter = np.linspace(curve.takeoff, int(curve.parameter[-1]) - curve.landing, 20_000)
    points = curve.at(parameter)
    lowest, highest = (limit[tuple(city.cell_of(points)[:, :2].T)] for limit in city.range_of_ground)
    assert (points[:, 2] >= highest + 4.0 - 1e-6).all()
    assert (points[:, 2] <= lowest + 9.0 + 1e-6).all()
    assert not city.in_no_fly[tuple(city.cell_of(points).T)].any()
    top, way = curve.at(curve.takeoff), route.en_route.points
    assert top == pytest.approx(way[0])
    assert curve.at(np.linspace(0, curve.takeoff, 99))[:, :2] == pytest.approx(np.tile(way[0, :2], (99, 1)))
    assert curve.at(int(curve.parameter[-1]) - curve.landing) == pytest.approx(way[-1])
    limits = {"min_clearance": 2.0, **heights}  # the ground is nearer while it takes off
    route = shortcut(astar(city, *ends, **limits), city, **limits)
    assert route.en_route.clearance(city) >= 2.0 - 1e-9 > route.clearance(city)
    smooth(route, city, RISK_QUADROTOR, **limits)


def test_the_route_stays_as_it_was_and_the_curve_is_always_the_same(any_angle):
    for city, route in any_angle[:10]:
        before = route.points.copy()
        first, second = (smooth(route, city, RISK_QUADROTOR) for _ in range(2))
        assert np.array_equal(route.points, before)
        assert np.array_equal(first.control, second.control)
        assert first.info == second.info
        first.control[:] = 0
        assert np.array_equal(route.points, before)


def test_a_route_of_two_waypoints_stays_a_straight_line():
    city = City(np.zeros((20, 20, 20), bool))
    curve = smooth(Route([(1, 1, 1), (13, 17, 9)]), city, RISK_QUADROTOR)
    assert curve.length == pytest.approx(np.sqrt(12**2 + 16**2 + 8**2), rel=1e-12)
    assert curve.curvature.max() == pytest.approx(0, abs=1e-12)


WALL = City(np.pad(np.ones((1, 10, 5), bool), ((10, 9), (0, 10), (0, 5))))


@pytest.mark.parametrize(
    ("route", "min_clearance", "message"),
    [
        (Route([(1, 1, 1), (2, 2, 2)], reached=False, reason="stuck"), 0, "route doesn't arrive (stuck): plan one"),
        (Route(np.empty((0, 3)), reached=False, reason="no way"), 0, "route doesn't arrive (no way)"),
        (Route([(1, 1, 1)]), 0, "route must have at least two waypoints, got 1"),
        (
            Route([(1, 1, 1), (5, 1, 1), (5, 1, 1), (9, 1, 1)]),
            0,
            "route repeats waypoint 1 at (5.0, 1.0, 1.0): drop one of the two",
        ),
        (
            Route([(1, 1, 1), (2, 1, 1), (15, 1, 1)]),
            0,
            "or leaves the map between waypoints 1 (2.0, 1.0, 1.0) and 2 (15.0, 1.0, 1.0), before it is",
        ),
        (
            Route([(1, 1, 1), (1, 25, 1)]),
            0,
            "leaves the map between waypoints 0 (1.0, 1.0, 1.0) and 1 (1.0, 25.0, 1.0)",
        ),
        (
            Route([(1, 10.5, 1), (1, 15.5, 1), (19, 15.5, 1), (19, 10.5, 1)]),
            6.0,
            "give the min_clearance and heights that it was planned with",
        ),
        (
            Route([(1, 12, 1), (10.5, 10.1, 1), (19, 12, 1)]),
            0,
            "route comes within 0.10 m of an obstacle at (10.5, 10.1",
        ),
        (Route([(9.9, 2, 1), (9.9, 8, 1)]), 0, "a body of 0.4 m needs 0.2 m: plan with a larger min_clearance"),
        (Route([(1, 1, 1), (2, 2, 2)]), -1.0, "min_clearance must be a distance in metres, at least 0, got -1"),
        (Route([(1, 1, 1), (2, 2, 2)]), np.nan, "min_clearance must be a distance in metres, at least 0, got nan"),
    ],
)
def test_what_can_t_be_smoothed_is_refused_with_the_place(route, min_clearance, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        smooth(route, WALL, RISK_QUADROTOR, min_clearance=min_clearance)


def test_the_distance_that_a_refusal_names_is_what_a_clear_route_needs():
    for gap, clear in ((RADIUS, True), (0.9 * RADIUS, False)):
        route = Route([(10 - gap, 2, 1), (10 - gap, 8, 1)])
        if clear:
            assert smooth(route, WALL, RISK_QUADROTOR).info["rounds"] == 0
        else:
            with pytest.raises(ValueError, match=r"route comes within 0\.18 m .* before it is smoothed"):
                smooth(route, WALL, RISK_QUADROTOR)


@pytest.mark.parametrize(
    ("things", "message"),
    [
        (([(1, 1, 1), (2, 2, 2)], WALL, RISK_QUADROTOR), "route must be a Route, got list"),
        ((Route([(1, 1, 1), (2, 2, 2)]), random_campus(0), RISK_QUADROTOR), "city must be a City, got RiskMap"),
        ((Route([(1, 1, 1), (2, 2, 2)]), WALL, 0.4), "uav must be a UAV, got float"),
    ],
)
def test_things_of_another_kind_are_refused(things, message):
    with pytest.raises(ValueError, match=message):
        smooth(*things)
