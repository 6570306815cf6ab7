"""The potential field against gradients and brute force; where it arrives, how long its routes are, where it sticks."""

import itertools

import numpy as np
import pytest

from uavlab.city import City
from uavlab.planners import astar, penalty_zone, potential_field, potential_forces, repulsion
from uavlab.planners.potential_field import Field, field_of, forces_at, put_forces, walk_freely, walk_lattice

SETTINGS = [
    {"attraction": attraction, "obstacles": obstacles}
    for attraction in ("conic", "quadratic")
    for obstacles in ("voxels", "surface")
]
MOVES = ("lattice", "continuous")
NOTCH, MIDDLE = (90, 18, 30), (50, 44, 30)  # REPARE Fig. 12
OPEN = City(np.zeros((40, 30, 20), bool), cell=2.0, origin=(100, -50, 10))


def box(shape, *blocks, cell=1.0, origin=(0, 0, 0)):
    """A map with blocks, each three (low, high) pairs of indices."""
    occupied = np.zeros(shape, bool)
    for (a, b), (c, d), (e, f) in blocks:
        occupied[a:b, c:d, e:f] = True
    return City(occupied, cell=cell, origin=origin)


def random_city(seed, densest=0.15):
    rng = np.random.default_rng(seed)
    occupied = rng.random(rng.integers(6, 14, 3)) < rng.uniform(0.01, densest)
    city = City(occupied, cell=rng.uniform(0.5, 4), origin=rng.uniform(-100, 100, 3))
    start, goal = city.center_of(rng.permutation(np.argwhere(~occupied))[:2])
    return city, start, goal


def nearest_points(city, point):
    """The nearest point of every occupied voxel to a point, (V, 3)."""
    low = city.origin + city.cell * np.argwhere(city.occupied)
    return np.clip(point, low, low + city.cell)


def potential_by_hand(city, point, goal, *, attraction, obstacles, pull, push, reach):
    """The potential from its definition, over all obstacles of the map."""
    left = np.linalg.norm(np.subtract(goal, point))
    distance = np.linalg.norm(point - nearest_points(city, point), axis=1)
    each = np.where(distance < reach, 0.5 * push * (1 / np.maximum(distance, 1e-9) - 1 / reach) ** 2, 0.0)
    pushed = each.sum() if obstacles == "voxels" else each.max(initial=0.0)
    return (pull * left if attraction == "conic" else 0.5 * pull * left**2) + pushed


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("seed", range(6))
def test_forces_are_minus_the_gradient_of_the_potential(setting, seed):
    city, _, goal = random_city(seed)
    rng = np.random.default_rng(seed)
    given = setting | {"pull": rng.uniform(0.5, 3), "push": rng.uniform(1, 30), "reach": rng.uniform(1, 4) * city.cell}
    points = rng.uniform(*city.bounds, (300, 3))
    free = points[city.is_free(points)]
    clear = [np.linalg.norm(p - nearest_points(city, p), axis=1).min() > 0.1 for p in free]  # not within contact
    points = free[clear]
    assert len(points) > 50
    pulls, pushes, potentials = potential_forces(city, points, goal, **given)
    h = 1e-5
    for point, pull, push, potential in zip(points, pulls, pushes, potentials, strict=True):
        assert potential == pytest.approx(potential_by_hand(city, point, goal, **given), rel=1e-9)
        slope = [
            (potential_by_hand(city, point + e, goal, **given) - potential_by_hand(city, point - e, goal, **given))
            for e in h * np.eye(3)
        ]
        assert pull + push == pytest.approx(-np.array(slope) / (2 * h), rel=1e-4, abs=1e-4 * np.linalg.norm(push))


def test_attraction_is_of_constant_size_or_grows_with_the_distance():
    goal = np.array([140.0, -20.0, 30.0])
    points = np.random.default_rng(1).uniform(*OPEN.bounds, (50, 3))
    conic, none, depth = potential_forces(OPEN, points, goal, pull=3.0)
    quadratic, _, well = potential_forces(OPEN, points, goal, attraction="quadratic", pull=3.0)
    left = np.linalg.norm(goal - points, axis=1)
    assert np.linalg.norm(conic, axis=1) == pytest.approx(3.0)
    assert conic * left[:, None] / 3 == pytest.approx(goal - points)
    assert quadratic == pytest.approx(3 * (goal - points))
    assert depth == pytest.approx(3 * left)
    assert well == pytest.approx(1.5 * left**2)
    assert not none.any()


def test_at_the_goal_nothing_pulls():
    for attraction in ("conic", "quadratic"):
        pull, push, potential = potential_forces(OPEN, (120, -20, 20), (120, -20, 20), attraction=attraction)
        assert (pull.tolist(), push.tolist(), float(potential)) == ([0, 0, 0], [0, 0, 0], 0)


@pytest.mark.parametrize("obstacles", ["voxels", "surface"])
def test_one_voxel_pushes_along_the_line_from_its_nearest_point_and_not_beyond_its_reach(obstacles):
    city = box((9, 9, 9), ((4, 5), (4, 5), (4, 5)), cell=2.0, origin=(5, 6, 7))
    points = np.random.default_rng(2).uniform(*city.bounds, (2000, 3))
    points = points[city.is_free(points)]
    _, pushes, _ = potential_forces(city, points, (6, 7, 8), obstacles=obstacles, push=7.0, reach=4.0)
    away = points - np.clip(points, np.array([13.0, 14.0, 15.0]), np.array([15.0, 16.0, 17.0]))
    distance = np.linalg.norm(away, axis=1)
    inside = distance < 4.0
    assert 100 < inside.sum() < 1000
    assert not pushes[~inside].any()
    expected = repulsion(distance[inside], 7.0, 4.0)[:, None] * away[inside] / distance[inside, None]
    assert pushes[inside] == pytest.approx(expected)


def test_surface_takes_the_nearest_obstacle_alone_and_voxels_add_up():
    two = box((9, 3, 3), ((1, 2), (1, 2), (1, 2)), ((7, 8), (1, 2), (1, 2)))
    point = (3.5, 1.5, 1.5)  # 1.5 m from the one, 3.5 m from the other
    alone = potential_forces(two, point, (8.5, 0.5, 0.5), obstacles="surface", push=2.0, reach=5.0)[1]
    both = potential_forces(two, point, (8.5, 0.5, 0.5), push=2.0, reach=5.0)[1]
    assert alone == pytest.approx([float(repulsion(1.5, 2.0, 5.0)), 0, 0])
    assert both == pytest.approx([float(repulsion(1.5, 2.0, 5.0) - repulsion(3.5, 2.0, 5.0)), 0, 0])


def test_forces_are_finite_where_an_obstacle_is_touched():
    city = box((3, 3, 3), ((2, 3), (0, 3), (0, 3)))
    for x in (2 - 1e-9, 2.0, 2.5):
        pull, push, potential = potential_forces(city, (x, 1.5, 1.5), (0.5, 0.5, 0.5))
        assert np.isfinite([*pull, *push, potential]).all()


def test_points_of_any_shape():
    grid = np.random.default_rng(3).uniform(*OPEN.bounds, (4, 5, 3))
    pulls, pushes, potentials = potential_forces(OPEN, grid, (120, -20, 20))
    assert (pulls.shape, pushes.shape, potentials.shape) == ((4, 5, 3), (4, 5, 3), (4, 5))
    assert pulls[2, 3] == pytest.approx(potential_forces(OPEN, grid[2, 3], (120, -20, 20))[0])


def test_repulsion_is_minus_the_slope_of_its_potential_and_ends_at_its_reach():
    distance = np.linspace(0.3, 4.99, 200)
    h = 1e-6
    above, below = (3.5 * (1 / d - 1 / 5) ** 2 for d in (distance + h, distance - h))
    slope = (above - below) / (2 * h)
    assert repulsion(distance, 7.0, 5.0) == pytest.approx(-slope, rel=1e-6)
    assert repulsion([5.0, 5.1, 100.0], 7.0, 5.0).tolist() == [0, 0, 0]
    assert repulsion(distance, 7.0, 5.0, safe_distance=5.0) == pytest.approx(repulsion(distance, 7.0, 5.0))


def test_a_safe_distance_below_the_reach_makes_the_push_jump():
    below, above = repulsion([3.5 - 1e-9, 3.5 + 1e-9], 8.0, 5.0, safe_distance=3.5)
    assert below == pytest.approx(8 * (1 / 3.5 - 1 / 5) / 3.5**2)
    assert above == 0


def test_a_safe_distance_above_the_reach_makes_the_obstacle_attract_in_between():
    distance = np.array([4.9, 5.1, 6.0, 7.9, 8.1])
    assert np.sign(repulsion(distance, 8.0, 5.0, safe_distance=8.0)).tolist() == [1, -1, -1, -1, 0]


def pairs_in_the_open(count, seed):
    rng = np.random.default_rng(seed)
    return [rng.uniform(*OPEN.bounds, (2, 3)) for _ in range(count)]


@pytest.mark.parametrize("attraction", ["conic", "quadratic"])
def test_in_the_open_it_flies_straight_or_as_short_as_moves_allow(attraction):
    for start, goal in pairs_in_the_open(40, 4):
        free = potential_field(OPEN, start, goal, attraction=attraction, moves="continuous")
        assert free.reached
        assert np.allclose(free.points[[0, -1]], [start, goal], rtol=0, atol=1e-9)
        assert free.length == pytest.approx(np.linalg.norm(goal - start), rel=1e-9)
        assert free.cost == free.length
        assert free.leg_lengths[:-1] == pytest.approx(1.0)
        assert free.leg_lengths[-1] <= 1 + 1e-9
        lattice = potential_field(OPEN, start, goal, attraction=attraction)
        assert lattice.reached
        assert lattice.length == pytest.approx(astar(OPEN, start, goal).length)
        assert np.array_equal(lattice.points[[0, -1]], OPEN.center_of(OPEN.cell_of([start, goal])))


def test_a_step_of_its_own_is_the_length_of_the_legs():
    route = potential_field(OPEN, (110, -40, 20), (160, -10, 40), moves="continuous", step=3.0)
    assert route.leg_lengths[:-1] == pytest.approx(3.0)
    assert route.info["expanded"] == len(route.points) - 1 == np.ceil(np.linalg.norm([50, 30, 20]) / 3)


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("seed", range(25))
def test_moves_are_legal_whether_it_arrives_or_not(seed, setting):
    city, start, goal = random_city(seed)
    for push in (0.5, 20.0):
        route = potential_field(city, start, goal, push=push * city.cell**2, reach=3 * city.cell, **setting)
        index = city.cell_of(route.points)
        assert np.array_equal(route.points, city.center_of(index))
        assert np.abs(np.diff(index, axis=0)).max(axis=1, initial=1).tolist() == [1] * (len(index) - 1)
        for here, there in itertools.pairwise(index):
            low, high = np.minimum(here, there), np.maximum(here, there)
            assert not city.occupied[tuple(slice(a, b + 1) for a, b in zip(low, high, strict=True))].any()
        assert route.reached is bool((index[-1] == city.cell_of(goal)).all())
        assert route.reached is (not route.reason) is bool(np.isfinite(route.cost))


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("seed", range(25))
def test_legs_cut_no_building_and_stay_on_the_map(seed, setting):
    city, start, goal = random_city(seed)
    for push, step in ((0.01, 0.5), (5.0, 0.5), (500.0, 3.0)):
        given = setting | {"push": push * city.cell**2, "reach": 3 * city.cell, "step": step * city.cell}
        route = potential_field(city, start, goal, moves="continuous", max_steps=1500, **given)
        index, _ = city.voxels_along(route.points)
        assert ((index >= 0) & (index < city.shape)).all()
        assert not city.occupied[tuple(index.T)].any()
        assert (route.leg_lengths <= step * city.cell * (1 + 1e-9)).all()


def test_the_last_leg_flies_into_walls_as_little_as_any_other():
    wall = box((20, 9, 9), ((10, 11), (0, 9), (0, 9)))
    route = potential_field(wall, (7.5, 4.5, 4.5), (12.5, 4.5, 4.5), moves="continuous", step=6.0, reach=1.0)
    assert route.reason.startswith("flies into an obstacle at (7.5, 4.5, 4.5), 5.0 m from the goal")


def at(city, *offset):
    """A point, counted from the map's corner [m]."""
    return city.origin + np.array(offset)


def test_along_the_border_it_slides_with_whole_steps():
    """A block pushes it out of the map; it goes on along the border."""
    city = box((40, 8, 8), ((10, 30), (5, 8), (0, 8)), origin=(5e5, 4e6, 0))  # far from the origin, as in UTM
    start, goal = at(city, 3.5, 1.5, 4.0), at(city, 36.5, 1.5, 4.0)
    route = potential_field(city, start, goal, moves="continuous", push=200.0, reach=6.0)
    assert route.reached
    assert city.is_free(route.points).all()
    along = route.points[:, 1] - city.origin[1] == 0
    assert along.sum() > 20
    assert np.diff(route.points[along, 0]).max() == pytest.approx(0.5)
    assert np.median(np.diff(route.points[along, 0])) == pytest.approx(0.5)
    assert route.length < 1.15 * 33


def test_the_upper_border_is_not_crossed_either():
    city = box((40, 8, 8), ((10, 30), (0, 3), (0, 8)), origin=(5e5, 4e6, 0))
    route = potential_field(
        city, at(city, 3.5, 6.5, 4.0), at(city, 36.5, 6.5, 4.0), moves="continuous", push=200.0, reach=6.0
    )
    assert route.reached
    assert city.is_free(route.points).all()
    assert route.points[:, 1].max() - city.origin[1] == pytest.approx(8.0, abs=1e-5)


GRID = list(
    itertools.product(("conic", "quadratic"), ("voxels", "surface"), MOVES, (1, 5, 50, 500, 5000), (2, 3.5, 5, 8, 12))
)


def test_no_setting_leads_out_of_the_notch_and_astar_does(table1):
    """REPARE Fig. 12, with 200 settings."""
    assert len(GRID) >= 135
    assert astar(table1, NOTCH, MIDDLE).length == pytest.approx(66.385, abs=1e-3)
    for attraction, obstacles, moves, push, reach in GRID:
        route = potential_field(
            table1, NOTCH, MIDDLE, attraction=attraction, obstacles=obstacles, moves=moves, push=push, reach=reach
        )
        x, y, z = route.points[-1]
        left = np.linalg.norm(route.points[-1] - (MIDDLE if moves == "continuous" else (50.5, 44.5, 30.5)))
        assert not route.reached
        assert route.cost == np.inf
        assert route.reason.startswith(f"stuck in a local minimum at ({x:.1f}, {y:.1f}, {z:.1f}), {left:.1f} m from")
        assert 70 < x < 90
        assert 15 < y < 35
        assert z in (30.0, 30.5)
        assert route.info["expanded"] < (100 if moves == "lattice" else 1200)  # found out in bounded steps


def test_where_it_is_stuck_the_potential_has_a_minimum(table1):
    """The forces at the bottom cancel, and all eigenvalues of the Hessian are above 0."""
    bottom = np.array([73.4101, 31.2622, 30.0])
    pull, push, lowest = potential_forces(table1, bottom, MIDDLE)
    assert np.linalg.norm(pull) == pytest.approx(1)
    assert np.linalg.norm(pull + push) < 1e-4
    around = bottom + 0.5 * np.random.default_rng(5).standard_normal((200, 3))
    assert (potential_forces(table1, around, MIDDLE)[2] > lowest).all()
    h = 0.01
    hessian = [
        (sum(potential_forces(table1, bottom - e, MIDDLE)[:2]) - sum(potential_forces(table1, bottom + e, MIDDLE)[:2]))
        / (2 * h)
        for e in h * np.eye(3)
    ]
    assert np.linalg.eigvalsh(np.add(hessian, np.transpose(hessian)) / 2) == pytest.approx(
        [0.041, 0.981, 1.513], abs=0.01
    )


def test_trembling_gets_smaller_with_the_step_and_never_arrives(table1):
    """It is a matter of steps; the trap is one of the potential."""
    spread = []
    for step in (0.5, 0.1):
        route = potential_field(table1, NOTCH, MIDDLE, moves="continuous", step=step)
        assert "back and forth" in route.reason
        spread.append(np.ptp(route.points[-500:], axis=0).max())
        assert route.points[-500:].mean(axis=0) == pytest.approx([73.41, 31.26, 30.0], abs=0.3)
    assert spread[1] < 0.4 * spread[0]


def test_creeping_along_a_wall_is_not_taken_for_trembling(table1):
    """Within 100 steps it gets on by less than a metre, 130 times; but it does arrive."""
    route = potential_field(table1, (21.5, 89.5, 45.5), (50.5, 26.5, 57.5), moves="continuous", push=50.0)
    gain = np.linalg.norm(route.points[100:] - route.points[:-100], axis=1)
    assert (gain < 1.0).sum() > 100
    assert route.reached


def test_a_wall_straight_ahead_stops_it_where_pull_and_push_cancel():
    wall = box((30, 15, 15), ((20, 21), (0, 15), (0, 15)))
    route = potential_field(wall, (5.5, 7.5, 7.5), (28.5, 7.5, 7.5), obstacles="surface", push=5.0, reach=5.0)
    balance = next(d for d in np.arange(0.5, 5, 1)[::-1] if repulsion(d, 5.0, 5.0) > 1)  # nearest centre pushed back
    assert route.points[:, 0].max() == 20 - balance
    assert "it goes back and forth there" in route.reason


def test_no_move_along_the_force_is_said():
    corner = box((6, 6, 1), ((3, 4), (0, 6), (0, 1)), ((0, 4), (3, 4), (0, 1)))
    route = potential_field(corner, (2.5, 2.5, 0.5), (5.5, 5.5, 0.5), push=1e-9, reach=1.0)
    assert (
        route.reason == "stuck in a local minimum at (2.5, 2.5, 0.5), 4.2 m from the goal: no move goes along the force"
    )
    assert len(route.points) == 1
    assert route.length == 0


def test_a_push_too_weak_flies_into_the_wall_and_says_where():
    wall = box((20, 9, 9), ((10, 12), (0, 9), (0, 9)))
    route = potential_field(wall, (2.3, 4.5, 4.5), (18.5, 4.5, 4.5), moves="continuous", push=1e-4)
    assert route.reason == (
        "flies into an obstacle at (9.8, 4.5, 4.5), 8.7 m from the goal: the push is too weak or the step too long"
    )
    assert route.points[-1] == pytest.approx([9.8, 4.5, 4.5])


@pytest.mark.parametrize("moves", MOVES)
def test_it_gives_up_after_as_many_steps_as_allowed_and_not_before(moves):
    needed = potential_field(OPEN, (101, -49, 11), (141, -9, 31), moves=moves)
    enough = potential_field(OPEN, (101, -49, 11), (141, -9, 31), moves=moves, max_steps=needed.info["expanded"])
    assert enough.reached
    assert np.array_equal(enough.points, needed.points)
    short = potential_field(OPEN, (101, -49, 11), (141, -9, 31), moves=moves, max_steps=needed.info["expanded"] - 1)
    assert not short.reached
    assert np.array_equal(short.points, needed.points[:-1])
    assert short.reason.startswith(f"gave up after {short.info['expanded']} steps at (")
    assert short.cost == np.inf


@pytest.mark.parametrize("moves", MOVES)
def test_recorded_forces_are_those_that_it_followed(table1, moves):
    route = potential_field(table1, NOTCH, MIDDLE, moves=moves, record=True)
    aim = (50.5, 44.5, 30.5) if moves == "lattice" else MIDDLE
    pulls, pushes, _ = potential_forces(table1, route.points, aim)
    assert np.array_equal(route.info["attraction"], pulls)
    assert np.array_equal(route.info["repulsion"], pushes)
    if moves == "continuous":
        resultant = (pulls + pushes)[:-1]
        legs = np.diff(route.points, axis=0)
        assert legs == pytest.approx(0.5 * resultant / np.linalg.norm(resultant, axis=1, keepdims=True), abs=1e-9)
    assert "attraction" not in potential_field(table1, NOTCH, MIDDLE, moves=moves).info


@pytest.mark.parametrize("moves", MOVES)
@pytest.mark.parametrize("seed", range(8))
def test_same_question_same_route_and_only_the_ratio_of_the_forces_counts(seed, moves):
    city, start, goal = random_city(seed, densest=0.05)
    given = {"moves": moves, "reach": 3 * city.cell, "max_steps": 1500}
    first, second = (potential_field(city, start, goal, push=2.0, **given) for _ in range(2))
    assert np.array_equal(first.points, second.points)
    assert first.reason == second.reason
    scaled = potential_field(city, start, goal, pull=2.0**-50, push=2.0**-49, **given)
    assert np.array_equal(first.points, scaled.points)
    assert first.reason == scaled.reason


@pytest.mark.parametrize("seed", range(4))
def test_compiled_code_and_python_agree(seed):
    city, start, goal = random_city(seed, densest=0.05)
    field = field_of(city, goal, "conic", "voxels", 1.0, 2.0 * city.cell**2, 2.5 * city.cell)
    assert isinstance(field, Field)
    for point in np.random.default_rng(seed).uniform(*(city.bounds - city.origin), (20, 3)):
        forces, plain_forces = np.empty((2, 3)), np.empty((2, 3))
        potential = put_forces(field, point, *forces)
        assert put_forces.py_func(field, point, *plain_forces) == pytest.approx(potential, rel=1e-12)
        assert forces == pytest.approx(plain_forces, rel=1e-12)
    points = np.random.default_rng(seed).uniform(0, 1, (5, 3))
    for compiled, plain in zip(forces_at(field, points), forces_at.py_func(field, points), strict=True):
        assert compiled == pytest.approx(plain, rel=1e-12)
    ends = city.cell_of([start, goal])
    for compiled, plain in zip(
        walk_lattice(field, *ends, 50) + walk_freely(field, start - city.origin, 0.5, 50),
        walk_lattice.py_func(field, *ends, 50) + walk_freely.py_func(field, start - city.origin, 0.5, 50),
        strict=True,
    ):
        assert compiled == pytest.approx(plain, rel=1e-9)


def interval(values, draws=2000):
    """95 % interval of the mean, by the bootstrap."""
    rng = np.random.default_rng(0)
    means = values[rng.integers(len(values), size=(draws, len(values)))].mean(axis=1)
    return np.quantile(means, [0.025, 0.975])


@pytest.fixture(scope="module")
def compared(table1):
    """Pairs of Table 1's city, with the lengths of A*'s and REPARE's routes (ring of 3, ω = 2)."""
    pairs = table1.random_pairs(1000, 7, apart=40, min_clearance=4.5)
    zone = penalty_zone(table1, 3.5, penalty=2.0, zone="ring")
    return pairs, *(np.array([astar(table1, *pair, price=price).length for pair in pairs]) for price in (None, zone))


TABLE_2 = {"push": 5.0, "reach": 5.0}, {"attraction": "quadratic", "push": 200.0, "reach": 4.5}


@pytest.mark.parametrize("setting", TABLE_2)
def test_lengths_are_those_of_repare_table_2_among_the_routes_that_arrive(table1, compared, setting):
    pairs, shortest, safer = compared
    routes = [potential_field(table1, *pair, **setting) for pair in pairs]
    arrived = np.array([route.reached for route in routes])
    lengths = np.array([route.length for route in routes])
    for others, printed in ((shortest, 0.952), (safer, 0.973)):
        ratio = (others / lengths)[arrived]
        low, high = interval(ratio)
        assert ratio.mean() == pytest.approx(printed, abs=0.01)
        assert low < ratio.mean() < high < low + 0.015
    assert 0.12 < 1 - arrived.mean() < 0.21
    assert (safer / shortest).mean() == pytest.approx(1.02, abs=0.006)


def measured(city, compared, **setting):
    """Length ratio A*/APF, share that doesn't arrive, and share of the others that keeps 3.5 m."""
    pairs, shortest, _ = compared
    routes = [potential_field(city, *pair, **setting) for pair in pairs]
    arrived = np.array([route.reached for route in routes])
    ratio = np.mean([a / route.length for a, route in zip(shortest, routes, strict=True) if route.reached])
    kept = np.mean([route.clearance(city) >= 3.5 for route in routes if route.reached])
    return ratio, 1 - arrived.mean(), kept


def test_table_2_s_settings_come_near_walls_and_a_hard_push_gets_stuck(table1, compared):
    for setting in TABLE_2:
        ratio, failed, kept = measured(table1, compared, **setting)
        assert kept < 0.55
    ratio, failed, kept = measured(table1, compared, push=5000.0, reach=8.0)
    assert kept == 1
    assert failed > 0.5
    assert ratio < 0.89


def test_the_nearest_surface_with_a_long_reach_is_short_and_keeps_its_distance_but_is_stuck_as_often(table1, compared):
    ratio, failed, kept = measured(table1, compared, obstacles="surface", push=200.0, reach=8.0)
    assert ratio == pytest.approx(0.952, abs=0.01)
    assert kept == 1
    assert 0.1 < failed < 0.2


@pytest.mark.parametrize("setting", [*TABLE_2, {"obstacles": "surface", "push": 50.0}])
def test_in_any_direction_the_potential_field_is_shorter_than_astar_s_lattice(table1, compared, setting):
    ratio, failed, _ = measured(table1, compared, moves="continuous", **setting)
    assert 1.02 < ratio < 1.09
    assert 0.05 < failed < 0.2


SMALL = City(np.zeros((6, 6, 6), bool))
ENDS = (0.5, 0.5, 0.5), (5.5, 5.5, 5.5)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"attraction": "linear"}, "attraction must be one of 'conic', 'quadratic', got 'linear'"),
        ({"obstacles": "corners"}, "obstacles must be one of 'voxels', 'surface', got 'corners'"),
        ({"pull": 0.0}, "pull must be finite and above 0, got 0"),
        ({"pull": np.nan}, "pull must be finite and above 0, got nan"),
        ({"push": -5.0}, "push must be finite and above 0, got -5"),
        ({"push": (1.0, 2.0)}, r"push must be one number, got an array of shape \(2,\)"),
        ({"reach": np.inf}, "reach must be finite and above 0, got inf"),
        ({"reach": "far"}, "reach must be a number or an array of numbers"),
    ],
)
def test_bad_fields_are_refused_with_the_reason(wrong, message):
    with pytest.raises(ValueError, match=message):
        potential_field(SMALL, *ENDS, **wrong)
    with pytest.raises(ValueError, match=message):
        potential_forces(SMALL, *ENDS, **wrong)


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (
            lambda: potential_field(SMALL, *ENDS, moves="diagonal"),
            "moves must be one of 'lattice', 'continuous', got 'diagonal'",
        ),
        (lambda: potential_field(SMALL, *ENDS, step=0.0), "step must be finite and above 0, got 0"),
        (lambda: potential_field(SMALL, *ENDS, step=np.nan), "step must be finite and above 0, got nan"),
        (lambda: potential_field(SMALL, *ENDS, step=[1, 2]), "step must be one number"),
        (lambda: potential_field(SMALL, *ENDS, max_steps=0), "max_steps must be a whole number of at least 1, got 0"),
        (lambda: potential_field(SMALL, *ENDS, max_steps=9.5), "max_steps must be a whole number .* got 9.5"),
        (lambda: potential_field(SMALL, *ENDS, max_steps=10**9), "max_steps must be at most 100,000,000"),
        (lambda: potential_field(SMALL, *ENDS, record=None), "record must be True or False, got None"),
        (lambda: potential_forces(SMALL.occupied, *ENDS), "city must be a City, got ndarray"),
        (lambda: repulsion(1.0, [5.0], 5.0), "push must be one number"),
        (lambda: potential_field(SMALL, (0, 0, np.nan), ENDS[1]), "start must be finite"),
        (lambda: potential_field(SMALL, ENDS[0], (9, 9, 9)), "goal .* lies outside of the map: x 0 to 6"),
        (lambda: potential_field(SMALL, ENDS[0], (3, 3)), "goal must be three numbers"),
        (lambda: potential_field(SMALL, ENDS[0], (0.1, 0.9, 0.5)), "lie in the same voxel"),
        (lambda: potential_forces(SMALL, [(1, 2)], (3, 4)), r"points must have shape \(..., 3\) and goal \(3,\), got"),
        (lambda: potential_forces(SMALL, ENDS, ENDS), r"goal \(3,\), got \(2, 3\) and \(2, 3\)"),
        (lambda: potential_forces(SMALL, (0, 0, np.inf), ENDS[1]), "points must be finite"),
        (lambda: repulsion(0.0, 5.0, 5.0), "distance must be finite and above 0, got 0"),
        (lambda: repulsion([1.0, -2.0], 5.0, 5.0), "distance must be finite and above 0, got -2"),
        (lambda: repulsion(1.0, 0.0, 5.0), "push must be finite and above 0, got 0"),
        (lambda: repulsion(1.0, 5.0, np.nan), "reach must be finite and above 0, got nan"),
        (lambda: repulsion(1.0, 5.0, 5.0, safe_distance=-1.0), "safe_distance must be finite and above 0, got -1"),
        (lambda: repulsion("near", 5.0, 5.0), "distance must be a number or an array of numbers"),
    ],
)
def test_bad_questions_are_refused_with_the_reason(ask, message):
    with pytest.raises(ValueError, match=message):
        ask()


def test_a_start_in_a_building_is_told_which(table1):
    with pytest.raises(ValueError, match=r"start \(65.0, 20.0, 30.0\) lies in building '1 notch'"):
        potential_field(table1, (65, 20, 30), (1, 1, 1))
