"""Moves, legality, heuristics, and questions that are refused, each against its definition."""

import itertools
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from skimage.graph import MCP_Geometric

from uavlab import checks
from uavlab.city import City
from uavlab.planners import astar, potential_field, repare
from uavlab.planners.grid import (
    BOXES,
    HEURISTICS,
    LENGTHS,
    MOVES,
    blocked_around,
    checked_price,
    distance_left,
    endpoints,
    node_at,
)
from uavlab.risk import CAMPUS_FLIGHT, reference_campus

OFFSETS = list(itertools.product((-1, 0, 1), repeat=3))
BITS = {offset: 1 << position for position, offset in enumerate(OFFSETS)}


def test_moves_lead_to_all_26_neighbours_in_the_order_of_their_codes():
    assert MOVES.tolist() == [list(offset) for offset in OFFSETS if any(offset)]
    assert LENGTHS.tolist() == [sum(map(abs, move)) ** 0.5 for move in MOVES.tolist()]


@pytest.mark.parametrize("move", range(26))
def test_box_of_a_move_covers_the_voxels_between_both_ends(move):
    def between(offset):
        return any(offset) and all(o in (0, m) for o, m in zip(offset, MOVES[move].tolist(), strict=True))

    assert BOXES[move] == sum(BITS[offset] for offset in OFFSETS if between(offset))
    assert int(BOXES[move]).bit_count() == 2 ** np.count_nonzero(MOVES[move]) - 1


def legal_by_definition(blocked, node, move):
    """Every voxel of the bounding box of node and neighbour lies in the map and is free."""
    low, high = np.minimum(node, node + move), np.maximum(node, node + move)
    if (low < 0).any() or (high >= blocked.shape).any():
        return False
    return not bool(blocked[tuple(slice(a, b + 1) for a, b in zip(low, high, strict=True))].any())


@pytest.mark.parametrize("density", [0.0, 0.05, 0.2, 0.5])
def test_legality_is_a_free_bounding_box_inside_the_map(density):
    blocked = np.random.default_rng(11).random((6, 5, 4)) < density
    legal = 0
    for node in np.argwhere(~blocked):
        around = blocked_around(blocked, *node)
        for move in range(26):
            expected = legal_by_definition(blocked, node, MOVES[move])
            assert bool(around & BOXES[move] == 0) is expected, (node, MOVES[move])
            legal += expected
    assert legal > 0


def test_octile_is_the_true_cost_on_an_empty_map():
    source = (3, 2, 5)
    costs, _ = MCP_Geometric(np.ones((9, 8, 7))).find_costs([source])
    for index in np.ndindex(9, 8, 7):
        left = distance_left(HEURISTICS["octile"], *np.subtract(index, source))
        assert left == pytest.approx(costs[index], rel=1e-12, abs=1e-12)


cells = st.integers(-500, 500)


@pytest.mark.parametrize("heuristic", HEURISTICS.values(), ids=HEURISTICS)
@given(cells, cells, cells)
@settings(deadline=None, max_examples=50)
def test_heuristics_are_consistent(heuristic, di, dj, dk):
    here = distance_left(heuristic, di, dj, dk)
    for move, length in zip(MOVES.tolist(), LENGTHS, strict=True):
        there = distance_left(heuristic, di - move[0], dj - move[1], dk - move[2])
        assert abs(here - there) <= length + 1e-9
    assert distance_left(heuristic, 0, 0, 0) == 0


@given(cells, cells, cells)
@settings(deadline=None)
def test_euclidean_is_straight_and_never_above_octile(di, dj, dk):
    straight = distance_left(HEURISTICS["euclidean"], di, dj, dk)
    assert straight == pytest.approx(np.linalg.norm((di, dj, dk)))
    assert distance_left(HEURISTICS["zero"], di, dj, dk) == 0
    assert straight <= distance_left(HEURISTICS["octile"], di, dj, dk) + 1e-9


def test_blocked_is_what_is_nearer_than_the_clearance_asked_for():
    occupied = np.zeros((9, 3, 3), bool)
    occupied[0] = True
    city = City(occupied, cell=2.0)  # clearances 1, 3, 5, … metres
    assert np.array_equal(city.blocked(0), occupied)
    assert city.blocked(3.0)[:, 1, 1].tolist() == [True] * 2 + [False] * 7
    assert city.blocked(3.1)[:, 1, 1].tolist() == [True] * 3 + [False] * 6


def test_node_is_the_code_of_the_voxel_that_holds_the_point(table1):
    assert node_at(table1, (90.2, 18.9, 30.0), "start") == 90 * 10_000 + 18 * 100 + 30
    assert endpoints(table1, (0.5, 0, 0), (0, 0, 99.9)) == (0, 99)


@pytest.mark.parametrize("min_clearance", [0.0, 4.5])
def test_a_point_in_a_building_is_told_the_nearest_free_one(table1, min_clearance):
    point = (80.0, 70.5, 30.0)
    with pytest.raises(ValueError, match=r"^goal \(80.0, 70.5, 30.0\) lies in building '3 frustum'; ") as refusal:
        node_at(table1, point, "goal", min_clearance)
    told = re.search(r"the nearest free point is \((.*)\)$", str(refusal.value))[1]
    told = np.array([float(number) for number in told.split(", ")])
    allowed = np.argwhere(table1.clearance >= max(min_clearance, 0.1)) + 0.5
    assert table1.is_free(told)
    assert np.linalg.norm(told - point) == pytest.approx(np.linalg.norm(allowed - point, axis=1).min())
    node_at(table1, told, "goal", min_clearance)


WALLED = np.zeros((4, 4, 4), bool)
WALLED[2] = True
SMALL = City(WALLED)


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (
            lambda: node_at(SMALL, (2.5, 1, 1), "start"),
            r"start \(2.5, 1.0, 1.0\) lies in an obstacle; the nearest free",
        ),
        (
            lambda: node_at(SMALL, (9, 1, 1), "goal"),
            r"goal \(9.0, 1.0, 1.0\) lies outside of the map: x 0 to 4, y 0 to 4",
        ),
        (lambda: node_at(SMALL, (1, 4, 1), "goal"), "lies outside of the map"),
        (lambda: node_at(SMALL, (1, 1, -0.01), "start"), "lies outside of the map"),
        (lambda: node_at(SMALL, (1, np.nan, 1), "start"), r"start must be finite, got \(1.0, nan, 1.0\)"),
        (lambda: node_at(SMALL, (1, np.inf, 1), "goal"), "goal must be finite"),
        (
            lambda: node_at(SMALL, (1, 1), "start"),
            r"start must be three numbers \(x, y, z\) in metres, got shape \(2,\)",
        ),
        (lambda: node_at(SMALL, [(1, 1, 1)], "start"), r"start must be three numbers .* got shape \(1, 3\)"),
        (lambda: node_at(SMALL, 5, "start"), r"start must be three numbers .* got shape \(\)"),
        (
            lambda: node_at(SMALL, (1.5, 1, 1), "start", 1.0),
            r"start \(1.5, 1.0, 1.0\) is 0.50 m from the nearest obstacle, min_clearance asks for 1 m; "
            r"the nearest free point is \(0.5, 0.5, 0.5\)",
        ),
        (lambda: node_at(SMALL, (1.5, 1, 1), "start", 50), "no voxel of the map is free"),
        (lambda: node_at(City(np.ones((2, 2, 2))), (1, 1, 1), "goal"), "an obstacle; no voxel of the map is free"),
        (
            lambda: endpoints(City(WALLED, cell=2.0), (0.1, 0.1, 0.1), (1.9, 1.9, 1.9)),
            r"start \(0.1, .*\) and goal \(1.9, .*\) lie in the same voxel: .* at least one cell \(2 m\) away",
        ),
        (lambda: endpoints(SMALL, (1, 1, 1), (1, 1, 1)), "lie in the same voxel"),
        (lambda: endpoints(SMALL, (1, 1, 1), (1, 1, 7)), "goal .* lies outside of the map"),
        (lambda: endpoints(SMALL, (1, 1, 7), (1, 1, 1)), "start .* lies outside of the map"),
        (lambda: SMALL.blocked(-1), "min_clearance must be a distance in metres, at least 0, got -1"),
        (lambda: SMALL.blocked(np.nan), "min_clearance must be .* got nan"),
        (lambda: SMALL.blocked(np.inf), "min_clearance must be .* got inf"),
        (lambda: checked_price(SMALL, np.ones((4, 4))), r"price must have the city's shape \(4, 4, 4\), got \(4, 4\)"),
        (lambda: checked_price(SMALL, 1.0), r"price must have the city's shape \(4, 4, 4\), got \(1?,?\)"),
        (lambda: checked_price(SMALL, np.full((4, 4, 4), np.nan)), "price must be finite and at least 0 everywhere"),
        (lambda: checked_price(SMALL, np.full((4, 4, 4), np.inf)), "use min_clearance to forbid voxels"),
        (lambda: checked_price(SMALL, np.where(WALLED, -0.1, 1)), "price must be finite and at least 0 everywhere"),
    ],
)
def test_bad_questions_are_refused_with_the_reason(ask, message):
    with pytest.raises(ValueError, match=message):
        ask()


def test_prices_become_floats_of_the_city_s_shape():
    price, cheapest = checked_price(SMALL, np.arange(64).reshape(4, 4, 4)[::-1])
    assert cheapest == 0
    assert price.dtype == float
    assert price.flags.c_contiguous
    assert price[0, 0, 0] == 48


def test_points_in_messages_have_one_decimal():
    assert checks.show((90, 18.04, -0.5)) == "(90.0, 18.0, -0.5)"


def test_a_risk_map_is_not_a_city():
    campus = reference_campus()
    for plan in (astar, potential_field, repare):
        with pytest.raises(ValueError, match="city must be a City, got RiskMap"):
            plan(campus, *CAMPUS_FLIGHT)
    with pytest.raises(ValueError, match="city must be a City, got RiskMap"):
        astar(campus.city, *CAMPUS_FLIGHT).clearance(campus)
