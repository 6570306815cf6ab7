"""Exercises of chapter 04: other ways to the answer pass; typical mistakes fail, each with a hint of its own."""

import math

import numpy as np
import pytest

from uavlab import exercises


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


MISTAKES = [
    ("04.2", lambda code, shape: np.unravel_index(code, shape)[::-1], "in the wrong order"),
    ("04.2", lambda code, shape: np.unravel_index(code, shape, order="F"), "You let i change fastest"),
    ("04.2", lambda code, shape: (code // 30, code // 6, code % 6), "j grows too large"),
    ("04.2", lambda code, shape: (code / 30, code // 6 % 5, code % 6), "not whole numbers"),
    ("04.2", lambda code, shape: (code // 20, code // 4 % 5, code % 4), "Put it into Eq. 4"),
    ("04.2", lambda code, shape: code, "returns one number, 0. The answer is three whole numbers"),
    ("04.3", lambda *box: np.linalg.norm(offset(*box)), "distance to the centre"),
    ("04.3", lambda *box: np.linalg.norm(offset(*box)) - box[2] / 2, "the shape of a ball"),
    ("04.3", lambda *box: max(np.linalg.norm(offset(*box)) - box[2] / 2, 0.0), "the shape of a ball"),
    ("04.3", lambda *box: np.linalg.norm(offset(*box) - box[2] / 2), "its square counts"),
    ("04.3", lambda point, voxel, cell: box_clearance(point, voxel, 1.0), "Right for cells of 1 m only"),
    ("04.3", lambda point, voxel, cell: cell * box_clearance(point, voxel, 1.0), "bring both to metres"),
    ("04.3", lambda *box: np.maximum(offset(*box) - box[2] / 2, 0).max(), "the largest of the three"),
    ("04.3", lambda *box: np.maximum(offset(*box) - box[2] / 2, 0), "The answer is one number: the distance"),
    ("04.3", lambda *box: 1.0, "Where does the voxel begin and end"),
    ("04.4", lambda gap, cell: gap / 2, "without a grid"),
    ("04.4", lambda gap, cell: (math.ceil(math.ceil(gap / cell) / 2) - 0.5) * cell, "the luckiest grid"),
    ("04.4", lambda gap, cell: (math.ceil(gap / cell) - 1) * cell / 2, "the face between two voxels"),
    ("04.4", lambda gap, cell: math.ceil((math.ceil(gap / cell) - 1) / 2) * cell, "half a cell nearer"),
    ("04.4", lambda gap, cell: (math.ceil((math.ceil(gap / cell) - 1) / 2) - 0.5) * cell, "never negative"),
    ("04.4", lambda gap, cell: max(math.ceil(gap // cell / 2) - 0.5, 0) * cell, "a whole number of cells wide"),
    ("04.4", lambda gap, cell: 1.0, "Draw the street"),
]


@pytest.mark.parametrize(("number", "answer", "words"), MISTAKES, ids=range(len(MISTAKES)))
def test_mistake_gets_its_own_hint(number, answer, words):
    verdict = exercises.check(number, answer)
    assert not verdict
    assert words in verdict.hint
