"""Moves, legality, heuristics, and questions that are refused, each against its definition."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from skimage.graph import MCP_Geometric

from uavlab.city import City
from uavlab.planners import astar, potential_field, repare
from uavlab.planners.grid import (
    BOXES,
    HEURISTICS,
    LENGTHS,
    MOVES,
    blocked_around,
    distance_left,
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


def test_a_risk_map_is_not_a_city():
    campus = reference_campus()
    for plan in (astar, potential_field, repare):
        with pytest.raises(ValueError, match="city must be a City, got RiskMap"):
            plan(campus, *CAMPUS_FLIGHT)
    with pytest.raises(ValueError, match="city must be a City, got RiskMap"):
        astar(campus.city, *CAMPUS_FLIGHT).clearance(campus)
