"""Exercises of chapter 04: other ways to the answer pass; typical mistakes fail, each with a hint of its own."""

import math

import numpy as np
import pytest

from uavlab import exercises
from uavlab.city import City
from uavlab.exercises.chapter04 import HOUSES
from uavlab.planners import penalty_zone


def node_index(code, shape):
    return np.unravel_index(code, shape)


def box_clearance(point, voxel, cell):
    lowest, highest = voxel * cell, (voxel + 1) * cell
    return math.dist(point, np.clip(point, lowest, highest))


def street_clearance(gap, cell):
    """By trying where the grid begins, also with a centre on the wall."""
    worst = math.inf
    for first in np.append(np.linspace(0, cell, 97), (np.linspace(0, cell, 97) + gap) % cell):
        centers = first + cell * np.arange(-3, math.ceil(gap / cell) + 3)
        free = (centers > 1e-9) & (centers < gap - 1e-9)
        distances = np.abs(centers[free][:, None] - centers[~free]) - cell / 2
        worst = min(worst, distances.min(axis=1).max() if free.any() else 0.0)
    return worst


ANSWERS = {"04.2": node_index, "04.3": box_clearance, "04.4": street_clearance}


@pytest.mark.parametrize("number", ANSWERS)
def test_another_way_to_the_answer_is_right(number):
    verdict = exercises.check(number, ANSWERS[number])
    assert verdict, verdict


def offset(point, voxel, cell):
    """From the voxel's centre, on each axis."""
    return np.abs(point - cell * (voxel + 0.5))


def city_of(cell=1.0, origin=(-0.6, 0, 0), size=(57, 42, 20), voxels="touched", houses=None):
    return City.from_buildings(houses or HOUSES, cell=cell, origin=origin, size=size, voxels=voxels)


MISTAKES = {
    "04.2": {
        "in the wrong order": lambda code, shape: np.unravel_index(code, shape)[::-1],
        "You let i change fastest": lambda code, shape: np.unravel_index(code, shape, order="F"),
        "j grows too large": lambda code, shape: (code // 30, code // 6, code % 6),
        "not whole numbers": lambda code, shape: (code / 30, code // 6 % 5, code % 6),
        "Put it into Eq. 3": lambda code, shape: (code // 20, code // 4 % 5, code % 4),
        "returns one number, 0. The answer is three whole numbers": lambda code, shape: code,
    },
    "04.3": {
        "distance to the centre": lambda *box: np.linalg.norm(offset(*box)),
        "the shape of a ball": lambda *box: np.linalg.norm(offset(*box)) - box[2] / 2,
        "its square counts": lambda *box: np.linalg.norm(offset(*box) - box[2] / 2),
        "Right for cells of 1 m only": lambda point, voxel, cell: box_clearance(point, voxel, 1.0),
        "bring both to metres": lambda point, voxel, cell: cell * box_clearance(point, voxel, 1.0),
        "the largest of the three": lambda *box: np.maximum(offset(*box) - box[2] / 2, 0).max(),
        "You add the three axes": lambda *box: np.maximum(offset(*box) - box[2] / 2, 0).sum(),
        "The answer is one number: the distance": lambda *box: np.maximum(offset(*box) - box[2] / 2, 0),
        "Where does the voxel begin and end": lambda *box: 1.0,
    },
    "04.4": {
        "without a grid": lambda gap, cell: gap / 2,
        "the luckiest grid": lambda gap, cell: (math.ceil(math.ceil(gap / cell) / 2) - 0.5) * cell,
        "the face between two voxels": lambda gap, cell: (math.ceil(gap / cell) - 1) * cell / 2,
        "half a cell nearer": lambda gap, cell: math.ceil((math.ceil(gap / cell) - 1) / 2) * cell,
        "never negative": lambda gap, cell: (math.ceil((math.ceil(gap / cell) - 1) / 2) - 0.5) * cell,
        "a whole number of cells wide": lambda gap, cell: max(math.ceil(gap // cell / 2) - 0.5, 0) * cell,
        "Draw the street": lambda gap, cell: 1.0,
    },
    "04.5": {
        "what the ring sees of the zone": [4 / 44, 4 / 76, 4 / 108],
        "all that the ring calls risky": [8 / 44, 8 / 76, 8 / 108],
        "voxels of the mast, too": [40 / 45, 72 / 77, 104 / 109],
        "measured between centres": [24 / 28, 44 / 48, 76 / 80],
        "divide by the zone": [40 / 960, 72 / 960, 104 / 960],
        "per cent": [100 * 40 / 44, 100 * 72 / 76, 100 * 104 / 108],
        "test city in the chapter": [0.0076, 0.0099, 0.014],
        "Count a single layer first": [0.1, 0.2, 0.3],
    },
    "04.6": {
        "In the street from south to north": city_of(origin=(0, 0, 0)),
        "In the street from west to east": city_of(origin=(-0.6, -0.5, 0), size=(57, 43, 20)),
        "there is room for 50,000": city_of(cell=0.8),
        "Which of the two rules": city_of(voxels="centres"),
        "It has to cover": city_of(size=(50, 42, 20)),
        "more volume than the houses": city_of(cell=1.5, origin=(-0.5, -0.75, 0), size=(58.5, 43.5, 21)),
    },
}


def test_half_a_cell_off_and_cut_at_zero_is_still_a_ball():
    def answer(point, voxel, cell):
        return max(np.linalg.norm(offset(point, voxel, cell)) - cell / 2, 0.0)

    assert "the shape of a ball" in exercises.check("04.3", answer).hint


def test_the_shares_are_those_of_the_library():
    mast = np.zeros((31, 31, 11), dtype=bool)
    mast[15, 15] = True
    shares = []
    for radius in (3, 4, 5):
        zone = ~mast & (City(mast).clearance < radius + 0.5)
        seen = penalty_zone(City(mast), radius + 0.5, penalty=1.0, zone="ring") > 1
        shares.append((zone & ~seen).sum() / zone.sum())
    assert exercises.check("04.5", shares)
    assert exercises.check("04.5", np.round(shares, 3))


@pytest.mark.parametrize(
    "own",
    [
        city_of(),
        city_of(origin=(-0.45, 0.0, 0.0)),
        city_of(cell=1.02, origin=(-0.06, -0.39, 0), size=(56.1, 42.84, 20.4)),
        City(city_of().occupied, 1.0, (-0.6, 0, 0)),
    ],
)
def test_several_maps_are_right(own):
    verdict = exercises.check("04.6", own)
    assert verdict, verdict


def test_a_map_without_houses_is_none():
    assert (
        "Which of the two rules"
        in exercises.check("04.6", City(np.zeros((57, 42, 20), dtype=bool), 1.0, (-1, 0, 0))).hint
    )
