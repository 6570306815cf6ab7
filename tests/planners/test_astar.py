"""A* against SciPy's Dijkstra and scikit-image, on random maps; its penalty zone against brute force."""

import numpy as np
import pytest
import scipy.ndimage
from grid_references import OFFSETS, additive_cost, cheapest_by_scipy, is_legal, ways
from scipy.sparse.csgraph import dijkstra
from skimage.graph import MCP_Geometric

from uavlab.city import City
from uavlab.planners import astar, penalty_zone

DIAGONAL = 3**0.5


def cheapest_by_skimage(city, start, goal, price):
    """Cost and voxels of scikit-image's cheapest way, which may cut corners; infinite where there is none."""
    search = MCP_Geometric(np.where(city.occupied, -1.0, price))
    source, target = tuple(city.cell_of(start)), tuple(city.cell_of(goal))
    costs, _ = search.find_costs([source])
    path = search.traceback(target) if np.isfinite(costs[target]) else []
    return costs[target] * city.cell, np.array(path)


def random_case(seed, *, densest=0.45):
    """A random map with its cell, a start and a goal, and a price between 0.1 and 10."""
    rng = np.random.default_rng(seed)
    shape = rng.integers(3, 14, 3)
    occupied = rng.random(shape) < rng.uniform(0, densest)
    occupied.ravel()[rng.choice(occupied.size, 4, replace=False)] = False
    city = City(occupied, cell=rng.uniform(0.5, 5), origin=rng.uniform(-100, 100, 3))
    start, goal = city.center_of(rng.permutation(np.argwhere(~occupied))[:2])
    return city, start, goal, 10 ** rng.uniform(-1, 1, shape)


@pytest.mark.parametrize("seed", range(200))
def test_cost_is_that_of_scipy_s_dijkstra(seed):
    city, start, goal, price = random_case(seed)
    for prices in (None, price):
        expected = cheapest_by_scipy(city, start, goal, prices)
        route = astar(city, start, goal, price=prices)
        assert route.cost == pytest.approx(expected, rel=1e-9)
        assert route.reached is bool(np.isfinite(expected))


@pytest.mark.parametrize("seed", range(200))
def test_route_consists_of_legal_moves_and_costs_what_they_cost(seed):
    city, start, goal, price = random_case(seed)
    for prices in (np.ones(city.shape), price):
        route = astar(city, start, goal, price=prices)
        if route.reached:
            index = city.cell_of(route.points)
            assert np.array_equal(route.points[[0, -1]], city.center_of(city.cell_of([start, goal])))
            assert np.array_equal(route.points, city.center_of(index))
            assert np.abs(np.diff(index, axis=0)).max(axis=1).tolist() == [1] * (len(index) - 1)
            assert is_legal(city, index)
            assert route.cost == pytest.approx(additive_cost(city, route, prices), rel=1e-12)


def test_cost_is_scikit_image_s_where_rules_agree_and_never_lower():
    """scikit-image cuts corners. Where its cheapest way cuts none, both rules allow it: the costs must be equal."""
    agree, cut = set(), 0
    for seed in range(400):
        city, start, goal, price = random_case(seed, densest=0.12)
        for prices in (np.ones(city.shape), price):
            expected, path = cheapest_by_skimage(city, start, goal, prices)
            cost = astar(city, start, goal, price=prices).cost
            assert cost >= expected * (1 - 1e-9)
            if len(path) and is_legal(city, path):
                assert cost == pytest.approx(expected, rel=1e-9), seed
                agree.add(seed)
            else:
                cut += 1
    assert len(agree) >= 200
    assert cut >= 100


@pytest.mark.parametrize("seed", range(200))
def test_cost_is_scikit_image_s_on_prices_without_obstacles(seed):
    rng = np.random.default_rng(seed)
    price = rng.choice([0.0, 0.5, 1.0, 7.0], rng.integers(2, 12, 3)) if seed % 2 else 10 ** rng.normal(0, 1, (9, 7, 5))
    city = City(np.zeros(price.shape, bool))
    start, goal = city.center_of(rng.permutation(np.argwhere(~city.occupied))[:2])
    expected, _ = cheapest_by_skimage(city, start, goal, price)
    assert astar(city, start, goal, price=price).cost == pytest.approx(expected, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("seed", range(0, 200, 2))
def test_all_heuristics_find_the_same_cost_and_none_expands_more_than_zero(seed):
    city, start, goal, price = random_case(seed)
    for prices in (None, price):
        octile, euclidean, zero = (
            astar(city, start, goal, price=prices, heuristic=name) for name in ("octile", "euclidean", "zero")
        )
        assert euclidean.cost == pytest.approx(octile.cost, rel=1e-9)
        assert zero.cost == pytest.approx(octile.cost, rel=1e-9)
        assert octile.info["expanded"] <= zero.info["expanded"]
        assert euclidean.info["expanded"] <= zero.info["expanded"]


def test_octile_expands_a_third_of_what_euclidean_does_and_that_a_tenth_of_zero(table1):
    octile, euclidean, zero = (
        sum(astar(table1, *ends, heuristic=name).info["expanded"] for ends in pairs(table1, 20, seed=6))
        for name in ("octile", "euclidean", "zero")
    )
    assert octile < 0.4 * euclidean
    assert euclidean < 0.1 * zero


def test_way_out_of_the_notch_costs_a_detour_around_the_corners_that_scikit_image_cuts(table1):
    """REPARE Fig. 12."""
    start, goal = (90, 18, 30), (50, 44, 30)
    assert cheapest_by_skimage(table1, start, goal, np.ones(table1.shape))[0] == pytest.approx(65.799, abs=1e-3)
    assert astar(table1, start, goal).length == pytest.approx(66.385, abs=1e-3)


@pytest.mark.parametrize("heuristic", ["octile", "euclidean", "zero"])
@pytest.mark.parametrize("seed", range(20))
def test_recorded_order_never_goes_back_in_g_plus_h(seed, heuristic):
    city, start, goal, price = random_case(seed, densest=0.2)
    route = astar(city, start, goal, price=price, heuristic=heuristic, record=True)
    order = route.info["order"]
    first, last = sorted((start, goal), key=lambda end: -price[tuple(city.cell_of(end))])
    so_far = dijkstra(ways(city.occupied, price), indices=city.code_of(city.cell_of(first)))
    offset = np.abs(city.index_of(order) - city.cell_of(last))
    moves = -np.sort(-offset, axis=1)  # longest side first
    estimate = {
        "octile": moves @ (1, 2**0.5 - 1, 3**0.5 - 2**0.5),
        "euclidean": np.linalg.norm(offset, axis=1),
        "zero": np.zeros(len(order)),
    }[heuristic]
    keys = so_far[order] + price.min() * estimate
    assert order[0] == city.code_of(city.cell_of(first))
    assert len(order) == len(set(order.tolist())) == route.info["expanded"]
    assert (np.diff(keys) >= -1e-6).all()
    assert city.code_of(city.cell_of(last)) not in order


def test_order_is_recorded_only_when_asked(table1):
    assert "order" not in astar(table1, (1, 1, 1), (4, 4, 4)).info


def test_no_way_is_an_answer_with_the_reason():
    occupied = np.zeros((9, 9, 9), bool)
    occupied[3:8, 3:8, 3:8] = True
    occupied[4:7, 4:7, 4:7] = False  # a room without a door
    city = City(occupied, cell=2.0)
    route = astar(city, (9, 9, 9), (1, 1, 1), record=True)
    assert not route.reached
    assert route.cost == np.inf
    assert route.points.shape == (0, 3)
    assert (
        route.reason == "no free way from (9.0, 9.0, 9.0) to (1.0, 1.0, 1.0): all 27 voxels within reach were searched"
    )
    assert len(route.info["order"]) == route.info["expanded"] == 27


@pytest.mark.parametrize("seed", range(0, 200, 4))
def test_reach_is_what_hangs_together_by_faces(seed):
    """Without corner cutting every diagonal move can be made in straight ones too."""
    city, start, goal, _ = random_case(seed, densest=0.75)
    parts, _ = scipy.ndimage.label(~city.occupied)
    start_part, goal_part = (parts[tuple(city.cell_of(point))] for point in (start, goal))
    route = astar(city, start, goal)
    assert route.reached is bool(start_part == goal_part)
    if not route.reached:
        assert route.info["expanded"] == (parts == start_part).sum()


def test_reaches_both_answers_on_the_maps_above():
    answers = []
    for seed in range(0, 200, 4):
        city, start, goal, _ = random_case(seed, densest=0.75)
        answers.append(astar(city, start, goal).reached)
    assert 10 < sum(answers) < 40


@pytest.mark.parametrize("min_clearance", [1.5, 3.5, 5.5])
def test_no_node_comes_nearer_than_the_clearance_asked_for(table1, min_clearance):
    start, goal = (90, 20, 30), (50, 44, 30)
    route = astar(table1, start, goal, min_clearance=min_clearance)
    index = table1.cell_of(route.points)
    assert table1.clearance[tuple(index.T)].min() >= min_clearance - 1e-9
    assert route.length > astar(table1, start, goal).length


@pytest.mark.parametrize("seed", range(30))
def test_clearance_is_kept_at_the_least_cost(seed):
    rng = np.random.default_rng(seed)
    city = City(rng.random((15, 13, 11)) < 0.01, cell=2.0)
    near = city.clearance < 3.0
    start, goal = city.center_of(rng.permutation(np.argwhere(~near))[:2])
    route = astar(city, start, goal, min_clearance=3.0)
    assert route.cost == pytest.approx(cheapest_by_scipy(city, start, goal, occupied=near), rel=1e-9)


def pairs(city, count, seed):
    free = np.argwhere(~city.occupied)
    return city.center_of(np.random.default_rng(seed).choice(free, (count, 2), axis=0))


def test_in_a_penalty_zone_both_directions_cost_the_same(table1):
    price = penalty_zone(table1, 3.5, penalty=2.0)
    for start, goal in pairs(table1, 15, seed=4):
        there, back = astar(table1, start, goal, price=price), astar(table1, goal, start, price=price)
        assert there.cost == pytest.approx(back.cost, rel=1e-9)
        assert there.cost == pytest.approx(additive_cost(table1, there, price), rel=1e-12)


@pytest.mark.parametrize(
    ("start", "goal", "safe_distance", "penalty", "there", "back"),
    [
        ((29.5, 24.5, 95.5), (43.5, 99.5, 45.5), 3.5, 0.1, 103.964, 101.625),
        ((56.5, 16.5, 1.5), (41.5, 67.5, 36.5), 5.5, 2.0, 77.722, 70.265),
    ],
)
def test_as_printed_the_route_depends_on_the_direction_of_travel(
    table1, start, goal, safe_distance, penalty, there, back
):
    price = penalty_zone(table1, safe_distance, penalty=penalty)
    assert astar(table1, start, goal, price=price, as_printed=True).length == pytest.approx(there, abs=1e-3)
    assert astar(table1, goal, start, price=price, as_printed=True).length == pytest.approx(back, abs=1e-3)
    both = [astar(table1, *ends, price=price).length for ends in ((start, goal), (goal, start))]
    assert both[0] == pytest.approx(both[1])


def test_as_printed_is_never_cheaper_than_the_exact_route(table1):
    price = penalty_zone(table1, 5.5, penalty=2.0)
    excess = [
        additive_cost(table1, astar(table1, start, goal, price=price, as_printed=True), price)
        - astar(table1, start, goal, price=price).cost
        for start, goal in pairs(table1, 15, seed=5)
    ]
    assert min(excess) > -1e-9
    assert max(excess) > 1.0


def test_as_printed_with_a_price_of_one_is_plain_astar():
    for seed in range(20):
        city, start, goal, _ = random_case(seed)
        printed = astar(city, start, goal, price=np.ones(city.shape), as_printed=True)
        assert np.array_equal(printed.points, astar(city, start, goal).points)


def test_as_printed_records_every_expansion_even_repeated_ones():
    """Eq. 13 reopens nodes: there can be more expansions than voxels."""
    city = City(np.zeros((5, 5, 3), bool))
    price = 10 ** np.random.default_rng(0).uniform(0, 3, city.shape)
    route = astar(city, (0.5, 0.5, 0.5), (4.5, 4.5, 2.5), price=price, as_printed=True, record=True)
    assert route.info["expanded"] > city.occupied.size
    assert len(route.info["order"]) == route.info["expanded"]


def test_as_printed_tells_how_many_voxels_are_within_reach():
    occupied = np.zeros((6, 5, 3), bool)
    occupied[4] = True
    price = 10 ** np.random.default_rng(1).uniform(0, 3, occupied.shape)
    route = astar(City(occupied), (0.5, 0.5, 0.5), (5.5, 4.5, 2.5), price=price, as_printed=True)
    assert "all 60 voxels within reach" in route.reason


def test_ball_is_priced_where_the_surface_is_nearer_than_the_safe_distance(table1):
    price = penalty_zone(table1, 3.5, penalty=0.1)
    assert np.array_equal(price, np.where(table1.clearance < 3.5, 1.1, 1.0))
    assert (penalty_zone(table1, 3.5, penalty=0.0) == 1).all()


def ring_by_looking(occupied, radius):
    """Voxels in which there is an obstacle, or from which one of the 26 points `radius` away lies in one."""
    marked = occupied.copy()
    for index in np.argwhere(occupied):
        for offset in OFFSETS:
            seen_from = index + radius * np.array(offset)
            if (seen_from >= 0).all() and (seen_from < occupied.shape).all():
                marked[tuple(seen_from)] = True
    return marked


@pytest.mark.parametrize(("safe_distance", "radius"), [(1.5, 1), (3.5, 3), (4.5, 4), (5.5, 5)])
def test_ring_is_26_points_half_a_cell_nearer_than_the_safe_distance(safe_distance, radius):
    city = City(np.random.default_rng(8).random((17, 15, 13)) < 0.01)
    price = penalty_zone(city, safe_distance, penalty=0.5, zone="ring")
    assert np.array_equal(price, 1 + 0.5 * ring_by_looking(city.occupied, radius))


def test_ring_and_ball_are_measured_in_cells():
    occupied = np.random.default_rng(8).random((17, 15, 13)) < 0.01
    for shape in ("ball", "ring"):
        coarse = penalty_zone(City(occupied, cell=4.0), 4 * 3.5, penalty=1.0, zone=shape)
        assert np.array_equal(coarse, penalty_zone(City(occupied), 3.5, penalty=1.0, zone=shape))


@pytest.mark.parametrize(
    ("radius", "missed", "added"),
    [(2, 0.0000, 0.1849), (3, 0.0000, 0.1678), (4, 0.0000, 0.1888), (5, 0.0034, 0.1707), (6, 0.0219, 0.1735)],
)
def test_ring_against_a_ball_of_centre_distances(table1, radius, missed, added):
    """Up to r = 4, among blocks this large, the ring misses no voxel whose centre is within r of an occupied one."""
    ball = (scipy.ndimage.distance_transform_edt(~table1.occupied) <= radius) & ~table1.occupied
    ring = (penalty_zone(table1, radius + 0.5, penalty=1.0, zone="ring") > 1) & ~table1.occupied
    assert (ball & ~ring).sum() / ball.sum() == pytest.approx(missed, abs=1e-4)
    assert (ring & ~ball).sum() / ball.sum() == pytest.approx(added, abs=1e-4)
    assert (ball <= ring).all() == (missed == 0)


@pytest.mark.parametrize(
    ("radius", "missed", "added"),
    [(1, 0.0000, 0.0000), (2, 0.0021, 0.0028), (3, 0.0076, 0.0466), (4, 0.0099, 0.0404), (5, 0.0140, 0.0678)],
)
def test_ring_against_the_ball_that_is_priced_by_default(table1, radius, missed, added):
    """Measured to surfaces, the ball of D_min = r + ½ is larger: from r = 2 on the ring misses voxels at edges."""
    ball = (penalty_zone(table1, radius + 0.5, penalty=1.0) > 1) & ~table1.occupied
    ring = (penalty_zone(table1, radius + 0.5, penalty=1.0, zone="ring") > 1) & ~table1.occupied
    assert (ball & ~ring).sum() / ball.sum() == pytest.approx(missed, abs=1e-4)
    assert (ring & ~ball).sum() / ball.sum() == pytest.approx(added, abs=1e-4)


@pytest.mark.parametrize("shape", ["ball", "ring"])
def test_distance_and_penalty_may_differ_from_voxel_to_voxel(shape):
    rng = np.random.default_rng(21)
    city = City(rng.random((13, 12, 11)) < 0.01, cell=2.0)
    distances, penalties = rng.choice([3.0, 5.0, 9.0], city.shape), rng.uniform(0, 3, city.shape)
    price = penalty_zone(city, distances, penalty=penalties, zone=shape)
    for distance in (3.0, 5.0, 9.0):
        near = penalty_zone(city, distance, penalty=1.0, zone=shape) > 1
        here = distances == distance
        assert np.array_equal(price[here], np.where(near, 1 + penalties, 1.0)[here])
    assert (price > 1).any()
    assert (price == 1).any()


@pytest.mark.parametrize("shape", ["ball", "ring"])
def test_arrays_of_one_value_are_that_value(shape):
    city = City(np.random.default_rng(8).random((9, 8, 7)) < 0.02)
    expected = penalty_zone(city, 2.5, penalty=0.3, zone=shape)
    everywhere = penalty_zone(city, np.full(city.shape, 2.5), penalty=np.full(city.shape, 0.3), zone=shape)
    assert np.array_equal(everywhere, expected)


def test_ring_overlooks_a_mast_that_stands_inside_it():
    occupied = np.zeros((11, 11, 11), bool)
    occupied[5, 5, :] = True
    city = City(occupied)
    beside = (6, 6, 5)
    assert penalty_zone(city, 3.5, penalty=1.0)[beside] == 2
    assert penalty_zone(city, 3.5, penalty=1.0, zone="ring")[beside] == 1


@pytest.mark.parametrize("seed", range(10))
def test_same_question_same_route(seed):
    city, start, goal, price = random_case(seed)
    first, second = (astar(city, start, goal, price=price, record=True) for _ in range(2))
    assert np.array_equal(first.points, second.points)
    assert np.array_equal(first.info["order"], second.info["order"])
    assert first.cost == second.cost


@pytest.mark.parametrize("seed", range(10))
def test_price_in_another_unit_gives_the_same_route(seed):
    city, start, goal, price = random_case(seed, densest=0.2)
    route, scaled = astar(city, start, goal, price=price), astar(city, start, goal, price=8 * price)
    assert np.array_equal(route.points, scaled.points)
    assert scaled.cost == 8 * route.cost
    assert astar(city, start, goal, price=0.37 * price).cost == pytest.approx(0.37 * route.cost, rel=1e-9)


def test_ends_may_lie_anywhere_in_their_voxels(table1):
    route = astar(table1, (3.0, 3.99, 3.2), (8.9, 3.1, 3.3))
    assert route.points[[0, -1]].tolist() == [[3.5, 3.5, 3.5], [8.5, 3.5, 3.5]]
    assert route.cost == 5


def test_asking_changes_neither_city_nor_price():
    city, start, goal, price = random_case(3)
    occupied, prices = city.occupied.copy(), price.copy()
    astar(city, start, goal, price=price, min_clearance=0.1)
    assert np.array_equal(city.occupied, occupied)
    assert np.array_equal(price, prices)


OPEN = City(np.zeros((4, 4, 4), bool))
ENDS = (0.5, 0.5, 0.5), (3.5, 3.5, 3.5)


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (
            lambda: astar(OPEN, *ENDS, heuristic="manhattan"),
            "heuristic must be one of 'auto', 'octile', 'euclidean', 'zero', 'coarse', got 'manhattan'",
        ),
        (lambda: astar(OPEN, *ENDS, as_printed=True), "as_printed needs a price"),
        (lambda: astar(OPEN, *ENDS, price=np.ones((4, 4))), r"price must have the city's shape \(4, 4, 4\)"),
        (lambda: astar(OPEN, *ENDS, price=np.full((4, 4, 4), np.nan)), "price must be finite and at least 0"),
        (lambda: astar(OPEN, *ENDS, price=np.full((4, 4, 4), -1)), "price must be finite and at least 0"),
        (lambda: astar(OPEN, *ENDS, min_clearance=-1), "min_clearance must be .* at least 0, got -1"),
        (lambda: astar(OPEN, *ENDS, min_clearance=np.nan), "min_clearance must be .* got nan"),
        (lambda: astar(OPEN, (0, 0, np.nan), ENDS[1]), "start must be finite"),
        (lambda: astar(OPEN, ENDS[0], (9, 9, 9)), "goal .* lies outside of the map: x 0 to 4"),
        (lambda: astar(OPEN, ENDS[0], (3, 3)), "goal must be three numbers"),
        (lambda: astar(OPEN, ENDS[0], (0.1, 0.9, 0.5)), "lie in the same voxel"),
        (lambda: astar(OPEN, *ENDS, record="no"), "record must be True or False, got 'no'"),
        (lambda: penalty_zone(OPEN.occupied, 3.5, penalty=1), "city must be a City, got ndarray"),
        (lambda: penalty_zone(OPEN, 0, penalty=1), "safe_distance must be .* above 0, got 0"),
        (lambda: penalty_zone(OPEN, -3.5, penalty=1), "safe_distance must be .* above 0, got -3.5"),
        (lambda: penalty_zone(OPEN, np.nan, penalty=1), "safe_distance must be .* got nan"),
        (lambda: penalty_zone(OPEN, 3.5, penalty=-0.1), "penalty must be finite and at least 0, got -0.1"),
        (lambda: penalty_zone(OPEN, 3.5, penalty=np.inf), "penalty must be finite .* got inf"),
        (
            lambda: penalty_zone(OPEN, np.ones((4, 4)), penalty=1),
            r"safe_distance must be one number or have the city's shape \(4, 4, 4\), got \(4, 4\)",
        ),
        (lambda: penalty_zone(OPEN, 1, penalty=[1, 2]), r"penalty must be one number or .* got \(2,\)"),
        (lambda: penalty_zone(OPEN, np.zeros((4, 4, 4)), penalty=1), "safe_distance must be .* above 0, got 0"),
        (lambda: penalty_zone(OPEN, 1, penalty=np.full((4, 4, 4), -2)), "penalty must be .* at least 0, got -2"),
        (lambda: penalty_zone(OPEN, "3.5", penalty=1), "safe_distance must be a number"),
        (lambda: penalty_zone(OPEN, 3.5, penalty=1, zone="cube"), "zone must be one of 'ball', 'ring', got 'cube'"),
    ],
)
def test_bad_questions_are_refused_with_the_reason(ask, message):
    with pytest.raises(ValueError, match=message):
        ask()


def test_a_start_in_a_building_is_told_which(table1):
    with pytest.raises(ValueError, match=r"start \(65.0, 20.0, 30.0\) lies in building '1 notch'"):
        astar(table1, (65, 20, 30), (1, 1, 1))
