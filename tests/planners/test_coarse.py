"""The estimate by blocks: never above the true cost, consistent, exact routes, far fewer expansions."""

import numpy as np
import pytest
from grid_references import additive_cost, cheapest_by_scipy, is_legal, ways
from scipy.interpolate import RegularGridInterpolator
from scipy.ndimage import gaussian_filter
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from uavlab.city import City, table1_city
from uavlab.planners import astar, coarse, hazard_price, penalty_zone
from uavlab.planners.grid import LENGTHS, MOVES


def smooth(shape, rng, sigma=3.0):
    """Filtered noise from 1 to 5."""
    noise = gaussian_filter(rng.normal(size=shape), sigma)
    return 1.0 + 4.0 * (noise - noise.min()) / max(np.ptp(noise), 1e-12)


def random_case(seed):
    """A map of any shape, prices of all kinds, and two free voxels, which obstacles may part."""
    rng = np.random.default_rng(seed)
    shape = rng.integers(1, 15, 3)
    shape[rng.integers(3)] += 5
    occupied = rng.random(shape) < rng.choice((0.0, 0.1, 0.4, 0.7))
    occupied[: shape[0] // 2] |= bool(rng.random() < 0.1)
    kinds = (
        lambda: smooth(shape, rng),
        lambda: 10.0 ** rng.uniform(-3, 3, shape),
        lambda: rng.choice((0.0, 1.0, 7.0), shape),
        lambda: np.full(shape, rng.uniform(0, 2)),
        lambda: 1e12 * rng.random(shape),
        lambda: 1.0 + np.arange(shape[2]) + np.zeros(shape),
    )
    price = kinds[seed % len(kinds)]()
    free = np.argwhere(~occupied)
    if len(free) < 2:
        return random_case(seed + 1000)
    city = City(occupied, rng.uniform(0.5, 3), rng.uniform(-50, 50, 3))
    return city, price, city.center_of(rng.permutation(free)[:2])


def estimates(city, price, start, goal):
    """At each voxel (nodes,)."""
    ends = [int(city.code_of(city.cell_of(end))) for end in (start, goal)]
    known = coarse.coarse_estimate(city.occupied, price, float(price.min()), *ends)
    return np.array([coarse.estimated(known, *index) for index in np.ndindex(city.shape)])


def test_a_move_is_as_long_as_the_axes_weigh_it_at_most_and_by_one_order_exactly():
    assert (np.abs(MOVES) @ coarse.WEIGHTS.T).max(axis=1) == pytest.approx(LENGTHS, rel=1e-15)
    assert len(np.unique(coarse.WEIGHTS, axis=0)) == 6


@pytest.mark.parametrize("seed", range(120))
def test_route_costs_what_scipy_s_dijkstra_finds(seed):
    city, price, (start, goal) = random_case(seed)
    expected = cheapest_by_scipy(city, start, goal, price)
    for ends in ((start, goal), (goal, start)):
        route = astar(city, *ends, price=price, heuristic="coarse")
        assert route.reached is bool(np.isfinite(expected))
        assert route.cost == pytest.approx(expected, rel=1e-8, abs=1e-12 * price.max())
        assert route.info["heuristic"] == "coarse"
        if route.reached:
            assert additive_cost(city, route, price) == pytest.approx(expected, rel=1e-8, abs=1e-12 * price.max())
            assert is_legal(city, city.cell_of(route.points))
        else:
            assert "no free way" in route.reason


def test_cases_above_are_of_all_kinds():
    reached = [bool(np.isfinite(cheapest_by_scipy(c, *ends, p))) for c, p, ends in map(random_case, range(120))]
    assert 5 < reached.count(False) < 60
    assert sum(max(random_case(seed)[0].shape) > 12 for seed in range(120)) > 40


@pytest.mark.parametrize("seed", range(60))
def test_estimate_is_consistent_and_never_above_the_true_cost(seed):
    """Along each legal move it changes by no more than the move costs; it is 0 in all of the goal's block or more."""
    city, price, (start, goal) = random_case(seed)
    estimate, graph = estimates(city, price, start, goal), ways(city.occupied, price).tocoo()
    least = 1e-12 * price.max() * max(city.shape)
    assert (np.abs(estimate[graph.row] - estimate[graph.col]) <= graph.data * (1 + 1e-9) + least).all()
    target = int(city.code_of(city.cell_of(goal)))
    assert estimate[target] == 0
    true = dijkstra(graph.tocsr(), indices=target)
    assert (estimate[~city.occupied.ravel()] <= true[~city.occupied.ravel()] * (1 + 1e-9) + least).all()


def by_definition(city, price, start, goal, weights):
    """The estimate by one order of the weights (nodes,): SciPy's Dijkstra over the corners, and its interpolation."""
    edge, blocks = coarse.BLOCK, -(-np.array(city.shape) // coarse.BLOCK)
    free = np.full(blocks * edge, coarse.WALL * price.max())
    free[tuple(slice(n) for n in city.shape)] = np.where(city.occupied, free.max(), price)
    least = np.pad(free.reshape(np.c_[blocks, [edge] * 3].ravel()).min(axis=(1, 3, 5)), 1, constant_values=np.inf)
    code = np.arange((blocks + 1).prod()).reshape(blocks + 1)
    steps = []
    for corner in np.ndindex(*(blocks + 1)):
        around = least[tuple(slice(n, n + 2) for n in corner)]
        for axis in range(3):
            if corner[axis] < blocks[axis]:
                touched = np.take(around, 1, axis).min()
                steps.append((code[corner], code[corner] + code.strides[axis] // 8, touched * weights[axis]))
    one, other, cost = np.transpose(steps)
    cost = np.maximum(edge * cost, 1e-300)  # a step that is free is one, too
    ways_there = coo_array((cost, (one.astype(int), other.astype(int))), (code.size, code.size)).tocsr()
    at_start, at_goal = (
        code[tuple(slice(n, n + 2) for n in city.cell_of(end) // edge)].ravel() for end in (start, goal)
    )
    far = dijkstra(ways_there, directed=False, indices=at_goal, min_only=True)
    far = np.minimum(far, coarse.BEYOND * far[at_start].max()).reshape(code.shape)
    between = RegularGridInterpolator([edge * np.arange(n) for n in code.shape], far)
    return between(np.argwhere(np.ones(city.shape, bool)) + 0.5)


@pytest.mark.parametrize("seed", range(30))
def test_estimate_is_the_greatest_by_the_six_orders_and_the_distance(seed):
    city, price, (start, goal) = random_case(seed)
    away = np.abs(np.argwhere(np.ones(city.shape, bool)) - city.cell_of(goal))
    distances = price.min() * (away @ coarse.WEIGHTS.T).T
    expected = np.max([*distances, *(by_definition(city, price, start, goal, w) for w in coarse.WEIGHTS)], axis=0)
    assert estimates(city, price, start, goal) == pytest.approx(expected, rel=1e-9, abs=1e-12 * price.max())


@pytest.mark.parametrize("seed", range(6))
def test_among_nearly_equal_prices_the_cheapest_route_is_found_to_a_billionth(seed):
    """An estimate in single precision would take another one."""
    rng = np.random.default_rng(seed)
    city = City(np.zeros((64, 8, 8), bool))
    price = 3.0 + 3e-7 * rng.integers(0, 2, city.shape)
    for start, goal in ((1, 1, 1), (63, *rng.integers(1, 8, 2))), ((1, 7, 2), (63, *rng.integers(1, 8, 2))):
        route = astar(city, start, goal, price=price, heuristic="coarse")
        assert route.cost == pytest.approx(cheapest_by_scipy(city, start, goal, price), rel=1.2e-9)


def test_estimate_is_no_weaker_than_distance_at_the_cheapest_price():
    city, price, (start, goal) = random_case(0)
    far = estimates(city, np.full(city.shape, price.min()), start, goal)
    assert (estimates(city, price, start, goal) >= far - 1e-9).all()


def test_a_third_of_the_expansions_and_the_same_route_where_prices_are_uneven():
    expanded = {"coarse": 0, "octile": 0}
    for seed in range(3):
        rng = np.random.default_rng(seed)
        city = City(rng.random((60, 60, 60)) < 0.02)
        price = smooth(city.shape, rng, 5.0)
        for start, goal in city.random_pairs(3, seed, apart=40):
            routes = {name: astar(city, start, goal, price=price, heuristic=name) for name in expanded}
            for name, route in routes.items():
                expanded[name] += route.info["expanded"]
            assert np.array_equal(routes["coarse"].points, routes["octile"].points)
            assert routes["coarse"].cost == pytest.approx(routes["octile"].cost, rel=1e-12)
            default = astar(city, start, goal, price=price)
            assert default.info["expanded"] == routes["coarse"].info["expanded"]
    assert expanded["coarse"] < expanded["octile"] / 3


def test_walls_of_blocks_are_gone_around():
    occupied = np.zeros((40, 40, 40), bool)
    occupied[16:24, :36] = True
    city, price = City(occupied), np.full(occupied.shape, 3.0)
    price[0, 0, 0] = 1.0
    blocks, distance = (
        astar(city, (2, 2, 2), (38, 2, 2), price=price, heuristic=name) for name in ("coarse", "octile")
    )
    assert blocks.cost == pytest.approx(distance.cost, rel=1e-12)
    assert blocks.info["expanded"] < distance.info["expanded"] / 3


def test_limits_are_kept_with_it():
    city = table1_city()
    price = smooth(city.shape, np.random.default_rng(3), 6.0)
    limits = {"min_clearance": 3.0, "min_height": 12.0, "max_height": 60.0}
    blocks, distance = (
        astar(city, (5, 5, 5), (95, 95, 30), price=price, heuristic=name, **limits) for name in ("coarse", "octile")
    )
    assert np.array_equal(blocks.points, distance.points)
    assert blocks.takeoff == distance.takeoff > 0
    assert blocks.clearance(city) >= 3.0


def test_it_is_taken_where_nearly_every_voxel_is_far_from_the_cheapest():
    city, ends = table1_city(), ((5, 5, 30), (95, 95, 30))
    even = {
        "none": None,
        "zone": penalty_zone(city, 5.5, penalty=9.0),
        "hazard": hazard_price(city, sigma=1.0, crash_price=100.0),
        "all alike": np.full(city.shape, 7.0),
        "free": np.zeros(city.shape),
    }
    for name, price in even.items():
        assert astar(city, *ends, price=price).info["heuristic"] == "octile", name
    noise = smooth(city.shape, np.random.default_rng(0))
    assert astar(city, *ends, price=noise).info["heuristic"] == "coarse"
    assert astar(city, *ends, price=noise, as_printed=True).info["heuristic"] == "octile"


@pytest.mark.parametrize("shape", [(101, 101, 101), (100, 100, 50), (100, 100, 100)])
@pytest.mark.parametrize("behind", [False, True])
@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("cheap", [0.0, 0.05, 0.15, 0.5])
def test_a_tenth_of_the_map_may_be_cheap_wherever_it_lies(cheap, axis, behind, shape):
    place = np.indices(shape)[axis] / shape[axis]
    price = np.where((1 - place if behind else place) < cheap, 1.0, 2.0)
    assert coarse.is_uneven(price, 1.0) is (cheap < 0.1) is bool((price == 1).mean() < 0.1)


def test_it_needs_a_price_that_is_added_up():
    city = City(np.zeros((9, 9, 9), bool))
    for options in ({}, {"price": np.ones(city.shape), "as_printed": True}):
        with pytest.raises(ValueError, match='heuristic="coarse" estimates what a way costs: give a price, and leave'):
            astar(city, (1, 1, 1), (8, 8, 8), heuristic="coarse", **options)


@pytest.mark.parametrize("seed", [0, 1, 2, 13])
def test_compiled_and_plain_python_agree_on_the_estimate(seed, monkeypatch):
    city, price, (start, goal) = random_case(seed)
    both = []
    names = (
        "least_prices", "prices_of_steps", "costs_of_corners", "corners_of", "greatest_in_blocks", "is_below",
        "estimated", "interpolated", "between",
    )  # fmt: skip
    both.append(estimates(city, price, start, goal))
    for name in names:
        monkeypatch.setattr(coarse, name, getattr(coarse, name).py_func)
    both.append(estimates(city, price, start, goal))
    assert np.array_equal(*both)


def test_blocks_that_tell_nothing_new_are_passed_over():
    """In each block, the greatest of those kept is the greatest of all."""
    city, price, (start, goal) = random_case(6)
    ends = [int(city.code_of(city.cell_of(end))) for end in (start, goal)]
    known = coarse.coarse_estimate(city.occupied, price, 0.0, *ends)
    every = known._replace(telling=np.full_like(known.telling, 63))
    assert any(word not in (0, 63) for word in known.telling.ravel())
    for index in np.ndindex(city.shape):
        assert coarse.estimated(known, *index) == coarse.estimated(every, *index)
