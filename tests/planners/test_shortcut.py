"""Shortcuts against dense sampling, numeric integrals, and all subsets of the waypoints."""

import importlib
import itertools

import numpy as np
import pytest
from line_references import random_case, touches_obstacle

from uavlab.city import City, NoFlyZone
from uavlab.planners import astar, penalty_zone, shortcut
from uavlab.route import Route

OPEN = City(np.zeros((20, 20, 20), bool))
module = importlib.import_module("uavlab.planners.shortcut")  # the package has a function of this name


def integral(city, price, points, step=0.002):
    """∫ price ds along a polyline, by the midpoint rule."""
    total = 0.0
    for start, end in itertools.pairwise(points):
        parts = int(np.ceil(np.linalg.norm(end - start) / step))
        middle = start + np.outer((np.arange(parts) + 0.5) / parts, end - start)
        total += price[tuple(city.cell_of(middle).T)].mean() * np.linalg.norm(end - start)
    return total


@pytest.mark.parametrize("seed", range(40))
def test_shortcut_is_free_never_longer_and_keeps_the_ends(seed):
    city, _, route, _ = random_case(seed)
    short = shortcut(route, city)
    assert route.reached
    assert np.array_equal(short.points[[0, -1]], route.points[[0, -1]])
    assert short.cost == pytest.approx(short.length)
    assert short.length <= route.length + 1e-9
    assert short.planner == "A* + shortcut"
    for start, end in itertools.pairwise(short.points):
        assert not touches_obstacle(city, start, end)


@pytest.mark.parametrize("seed", range(40))
def test_waypoints_are_some_of_the_route_s_in_order(seed):
    city, _, route, _ = random_case(seed)
    position = 0
    for waypoint in shortcut(route, city).points:
        position += int(np.flatnonzero((route.points[position:] == waypoint).all(axis=1))[0])
    assert position == len(route.points) - 1


def test_shortcuts_shorten_in_table_1_and_stay_free(table1):
    rng = np.random.default_rng(2)
    free = np.argwhere(~table1.occupied)
    saved = []
    for start, goal in table1.center_of(rng.choice(free, (15, 2), axis=0)):
        route = astar(table1, start, goal)
        short = shortcut(route, table1)
        assert not any(touches_obstacle(table1, *leg, step=0.01) for leg in itertools.pairwise(short.points))
        saved.append(1 - short.length / route.length)
    assert min(saved) >= 0
    assert np.mean(saved) > 0.02


@pytest.mark.parametrize("goal", [(19.5, 0.5, 0.5), (19.5, 7.5, 0.5), (3.5, 17.5, 11.5), (19.5, 19.5, 19.5)])
def test_on_an_empty_map_it_is_a_straight_line(goal):
    start = (0.5, 0.5, 0.5)
    route = astar(OPEN, start, goal)
    for price in (None, np.full(OPEN.shape, 2.0)):
        short = shortcut(route, OPEN, price=price)
        assert short.points.tolist() == [list(start), list(goal)]
        factor = 1.0 if price is None else 2.0
        assert short.cost == pytest.approx(factor * np.linalg.norm(np.subtract(goal, start)))


@pytest.mark.parametrize("seed", range(40))
def test_cost_of_a_grid_route_is_the_exact_integral_of_its_price(seed):
    """Half of each move lies in one voxel, half in the other: the edge cost d·(p + p')/2 is the line integral."""
    city, price, _, route = random_case(seed)
    index, length = city.voxels_along(route.points)
    assert (length * price[tuple(index.T)]).sum() == pytest.approx(route.cost, rel=1e-9)


@pytest.mark.parametrize("seed", range(15))
def test_with_a_price_the_cost_is_the_integral_and_not_above_the_route_s(seed):
    city, price, _, route = random_case(seed)
    short = shortcut(route, city, price=price)
    assert short.cost == pytest.approx(integral(city, price, short.points), rel=2e-3)
    assert short.cost <= route.cost * (1 + 1e-9)
    assert not any(touches_obstacle(city, *leg) for leg in itertools.pairwise(short.points))


def test_a_dear_zone_is_not_cut_through():
    price = np.ones(OPEN.shape)
    price[5:15, :15] = 50.0
    route = astar(OPEN, (0.5, 0.5, 0.5), (19.5, 0.5, 0.5), price=price)
    short = shortcut(route, OPEN, price=price)
    assert short.length > 30
    assert short.cost == pytest.approx(short.length)  # it stays where a metre costs 1
    straight = shortcut(route, OPEN, price=1.0)  # without the price, it is a straight line
    assert straight.length == straight.cost == 19
    assert shortcut(route, OPEN, price=2.5).cost == 2.5 * 19


@pytest.mark.parametrize("seed", range(60))
def test_no_subset_of_the_waypoints_is_cheaper(seed):
    city, price, plain, priced = random_case(seed, side=(4, 8), densest=0.3)
    for route, prices in ((plain, None), (priced, price)):
        if not route.reached:
            continue
        points = route.points[:9]
        whole = Route(points)
        cost = np.full((len(points), len(points)), np.inf)
        for i, j in itertools.combinations(range(len(points)), 2):
            if not touches_obstacle(city, points[i], points[j], step=0.02):
                index, length = city.voxels_along(points[[i, j]])
                cost[i, j] = length @ (np.ones(len(index)) if prices is None else prices[tuple(index.T)])
        inner = range(1, len(points) - 1)
        ways = (
            (0, *kept, len(points) - 1)
            for count in range(len(inner) + 1)
            for kept in itertools.combinations(inner, count)
        )
        least = min(sum(cost[i, j] for i, j in itertools.pairwise(way)) for way in ways)
        assert shortcut(whole, city, price=prices).cost == pytest.approx(least, rel=1e-7)


def box_distance(city, points):
    """Least distance of points (N, 3) to an occupied voxel, from all of them [m]."""
    low = city.center_of(np.argwhere(city.occupied)) - city.cell / 2
    gaps = (np.maximum(np.maximum(low - point, point - low - city.cell), 0) for point in points)
    return min(np.linalg.norm(gap, axis=1).min(initial=np.inf) for gap in gaps)


@pytest.mark.parametrize("origin", [(0.0, 0.0, 0.0), (5e5, 5e6, -30.0)])
@pytest.mark.parametrize("seed", range(30))
def test_every_leg_keeps_min_clearance_on_its_whole_length(seed, origin):
    rng = np.random.default_rng(seed)
    city = City(rng.random((16, 14, 8)) < rng.uniform(0.005, 0.03), rng.choice([0.1, 1.0, 5.0]), origin)
    min_clearance = city.cell * rng.choice([0.5, 1.0, 1.2, 2.0])
    for start, goal in city.random_pairs(3, rng, apart=6 * city.cell, min_clearance=min_clearance):
        route = astar(city, start, goal, min_clearance=min_clearance)
        if route.reached:
            short = shortcut(route, city, min_clearance=min_clearance)
            rounding = city.cell * 1e-9 + 4e-15 * np.abs(city.bounds).max()
            assert box_distance(city, short.resample(0.05 * city.cell).points) >= min_clearance - rounding
            assert short.clearance(city) >= min_clearance - rounding
            assert short.length <= route.length * (1 + 1e-12)


def test_a_leg_may_pass_a_voxel_whose_centre_is_too_near():
    """1.2 m from the wall at y = 1: through voxels whose centres are 0.5 and 1.5 m from it."""
    city = City(np.pad(np.ones((20, 1, 3), bool), ((0, 0), (0, 9), (0, 0))))
    route = Route([(0.5, 2.2, 1.5), (5.5, 4.5, 1.5), (19.5, 2.2, 1.5)])
    assert len(shortcut(route, city, min_clearance=1.2).points) == 2
    with pytest.raises(ValueError, match=r"too near .* between waypoints 1"):
        shortcut(Route([(0.5, 2.3, 1.5), (5.5, 2.2, 1.5), (9.5, 2.19, 1.5)]), city, min_clearance=1.2)


@pytest.mark.parametrize("seed", range(20))
def test_legs_keep_heights_and_zones_at_each_point(seed):
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(24), np.arange(20), indexing="ij")
    ground = 3 * np.sin(x / rng.uniform(2, 5)) + 2 * np.cos(y / rng.uniform(2, 5))
    zone = NoFlyZone([(9.3, 6.2), (13.1, 7.4), (11, 12.7)], 0.0, 100.0)
    city = City(np.zeros((24, 20, 26), bool), 1.0, (0, 0, -6), ground=ground, no_fly=(zone,))
    heights = {"min_height": 2.3, "max_height": 9.0}
    route = astar(city, (1.5, 9.5, ground[1, 9] // 1 + 5.5), (22.5, 9.5, ground[22, 9] // 1 + 5.5), **heights)
    short = shortcut(route, city, **heights)
    assert len(short.points) < len(route.points)
    points = short.resample(0.01).points
    above = city.height_above_ground(points)
    assert above.min() >= 2.3 - 1e-6
    assert above.max() <= 9.0 + 1e-6
    lowest, highest = (limit[tuple(city.cell_of(points)[:, :2].T)] for limit in city.range_of_ground)
    assert (points[:, 2] >= highest + 2.3 - 1e-6).all()
    assert (points[:, 2] <= lowest + 9.0 + 1e-6).all()
    assert not city.in_no_fly[tuple(city.cell_of(points).T)].any()


def test_a_penalty_zone_is_kept_in_mind(table1):
    price = penalty_zone(table1, 3.5, penalty=2.0)
    route = astar(table1, (90, 20, 30), (50, 44, 30), price=price)
    short = shortcut(route, table1, price=price)
    assert short.cost <= route.cost + 1e-9
    assert short.cost < integral(table1, price, shortcut(route, table1, price=1.0).points, step=0.01) - 0.1


def walled(*voxels, shape=(3, 6, 1)):
    occupied = np.zeros(shape, bool)
    for voxel in voxels:
        occupied[voxel] = True
    return City(occupied)


def test_a_line_may_not_touch_the_corner_of_an_obstacle():
    city = walled((1, 0, 0), shape=(3, 3, 1))
    route = Route([(0.5, 0.5, 0.5), (0.5, 1.5, 0.5), (1.5, 1.5, 0.5)])
    assert np.array_equal(shortcut(route, city).points, route.points)


@pytest.mark.parametrize("step", [10.0, 0.8, 0.4])
def test_a_route_that_cuts_a_corner_is_refused_also_when_resampled(step):
    city = walled((1, 0, 0), shape=(3, 3, 1))
    with pytest.raises(ValueError, match="route comes too near to an obstacle"):
        shortcut(Route([(0.5, 0.5, 0.5), (1.5, 1.5, 0.5)]).resample(step), city)


@pytest.mark.parametrize("mirrored", [False, True])
def test_a_line_along_the_face_of_an_obstacle_is_blocked_on_either_side(mirrored):
    city = walled((0, 2, 0), shape=(2, 6, 1))
    points = np.array([(0.5, 0.5, 0.5), (1.5, 1.5, 0.5), (1.5, 2.5, 0.5), (1.5, 3.5, 0.5), (0.5, 4.5, 0.5)])
    if mirrored:
        city = City(city.occupied[::-1])
        points[:, 0] = 2 - points[:, 0]
    short = shortcut(Route(points).resample(0.8), city)
    assert not any(touches_obstacle(city, *leg) for leg in itertools.pairwise(short.points))


@pytest.mark.parametrize(
    ("route", "city", "options", "message"),
    [
        (
            Route([(0.5, 0.5, 0.5), (0.5, 1.5, 0.5), (0.5, 4.5, 0.5)]),
            walled((0, 3, 0)),
            {},
            r"route comes too near to an obstacle or a zone, too low or too high, between waypoints 1 "
            r"\(0.5, 1.5, 0.5\) and 2 \(0.5, 4.5, 0.5\)",
        ),
        (Route([(0.5, 0.5, 0.5), (0.5, 9.5, 0.5)]), walled(), {}, "between waypoints 0 .* and 1"),
        (
            Route([(0.5, 0.5, 0.5), (0.5, 5.5, 0.5)]),
            walled((2, 2, 0)),
            {"min_clearance": 2.0},
            "shorten only routes that themselves keep min_clearance=2 m",
        ),
        (Route(np.ones((2, 3))), OPEN, {"min_clearance": -1.0}, "min_clearance must be .* at least 0, got -1"),
        (Route(np.ones((2, 3))), OPEN, {"price": np.ones(3)}, "price must have the city's shape"),
        (Route(np.ones((2, 3))), OPEN, {"price": np.full(OPEN.shape, np.nan)}, "price must be finite"),
        (Route(np.ones((2, 3))), OPEN, {"price": np.nan}, "price must be finite and above 0, got nan"),
        (Route(np.ones((2, 3))), OPEN, {"price": -3.0}, "price must be finite and above 0, got -3"),
        (Route(np.ones((2, 3))), OPEN, {"price": "much"}, "price must be a number or an array of numbers: got text"),
        (Route(np.ones((2, 3))), OPEN, {"price": [1.0, [2.0, 3.0]]}, "price must be a number or an array of numbers"),
    ],
)
def test_bad_questions_are_refused_with_the_reason(route, city, options, message):
    with pytest.raises(ValueError, match=message):
        shortcut(route, city, **options)


def test_what_did_not_arrive_or_has_no_legs_comes_back_as_it_is():
    stuck = Route(np.empty((0, 3)), "A*", reached=False, reason="no free way", cost=np.inf)
    assert shortcut(stuck, OPEN) is stuck
    halfway = Route([(0.5, 0.5, 0.5), (1.5, 0.5, 0.5)], "APF", reached=False, reason="stuck")
    assert shortcut(halfway, OPEN) is halfway
    point = Route([(0.5, 0.5, 0.5)])
    assert shortcut(point, OPEN) is point


def test_a_longer_way_between_the_same_two_points_is_straightened():
    loop = Route([(0.5, 0.5, 0.5), (5.5, 0.5, 0.5), (5.5, 5.5, 0.5), (0.5, 5.5, 0.5), (0.5, 1.5, 0.5)])
    assert shortcut(loop, OPEN).points.tolist() == [[0.5, 0.5, 0.5], [0.5, 1.5, 0.5]]


def test_what_the_planner_noted_stays():
    route = astar(OPEN, (0.5, 0.5, 0.5), (9.5, 5.5, 2.5), record=True)
    assert shortcut(route, OPEN).info is route.info


@pytest.mark.parametrize("kind", ["hills", "noise", "posts"])
def test_with_a_price_long_routes_are_shortened_in_rounds_nearly_as_well_as_at_once(kind, monkeypatch):
    """1 600 waypoints took 16 s: now 0.4 to 0.7, see the module; here 420, which are no more than a quarter of a %."""
    rng = np.random.default_rng(0)
    occupied = np.zeros((425, 40, 6), bool)
    if kind == "posts":
        for x in range(8, 410, 12):
            occupied[x : x + 4, (y := rng.integers(0, 32)) : y + 8] = True
    city = City(occupied)
    price = {
        "hills": 1 + 0.5 * np.sin(np.arange(425) / 40)[:, None, None] + np.zeros(city.shape),
        "noise": 1 + rng.random(city.shape),
        "posts": 1 + 3 * np.exp(-np.minimum(city.clearance, 50)),
    }[kind]
    route = astar(city, (1.5, 2.5, 1.5), (421.5, 35.5, 3.5), price=price)
    in_rounds = shortcut(route, city, price=price)
    monkeypatch.setattr(module, "LOOKBACK", 1000)
    at_once = shortcut(route, city, price=price)
    assert len(in_rounds.points) < len(route.points)
    assert at_once.cost <= in_rounds.cost * (1 + 1e-12)
    assert in_rounds.cost <= min(1.0025 * at_once.cost, route.cost)
    assert in_rounds.cost == pytest.approx(in_rounds.integral(city, price), rel=1e-9)
