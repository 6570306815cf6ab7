"""Checks of the exercises on cities: node codes, the distance to a voxel, the clearance that a street keeps."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np

from uavlab.exercises.hints import alike, recognised
from uavlab.exercises.kinds import asks_for, number, numbers

SHAPE = (4, 5, 6)
"""No two extents are equal, so that none can stand for another."""

BOXES = [
    ((5.0, 0.5, 0.5), (0, 0, 0), 1.0),  # straight ahead
    ((2.5, 2.5, 1.5), (0, 0, 0), 1.0),  # towards a corner
    ((7.3, 4.2, 1.1), (1, 5, 0), 2.0),  # towards an edge, and one axis within the voxel
    ((3.9, 5.9, 5.8), (1, 2, 2), 2.0),  # inside, near a corner
    ((0.2, 9.0, 4.0), (3, 1, 2), 0.5),
]
"""Point [m], voxel and cell [m]."""

STREETS = [(10.0, 4.0), (10.0, 3.0), (10.0, 0.6), (7.0, 2.0), (1.5, 1.0), (1.5, 2.0)]
ON_THE_WALL = [(10.0, 2.0), (2.0, 2.0), (12.0, 3.0)]
"""Gap and cell [m]; in the second list a grid can have centres on both walls."""

same = partial(alike, relative=0, absolute=1e-6)


@asks_for(numbers((3,), "three whole numbers: return i, j, k"))
def exercise_2(answer: Callable[[int, tuple[int, int, int]], Sequence[int]]) -> str:
    """04.2: from a node code back to its voxel."""
    codes = range(math.prod(SHAPE))
    given = [answer(code, SHAPE) for code in codes]
    nx, ny, nz = SHAPE
    voxels, right = np.asarray(given, dtype=float), [(code // (ny * nz), code // nz % ny, code % nz) for code in codes]
    if same(voxels, right):
        return ""
    if any(index != round(index) for triple in given for index in triple):
        return "Some of your indices are not whole numbers: / divides exactly, // counts how often it fits."
    if same(voxels, [index[::-1] for index in right]):
        return "These are the right three numbers in the wrong order: i counts the slabs, k the voxels within a row."
    if same(voxels, [(code % nx, code // nx % ny, code // (nx * ny)) for code in codes]):
        return (
            "You let i change fastest. In Eq. 4 it is k that has no factor: the next code is the voxel above, "
            "not the one to the east."
        )
    if same(voxels, [(i, code // nz, k) for code, (i, _, k) in zip(codes, right, strict=True)]):
        return (
            "i and k are right, j grows too large: code // nz counts the rows of all slabs before, not only those "
            "of its own."
        )
    code = next(code for code in codes if not same(voxels[code], right[code]))
    i, j, k = (int(value) for value in given[code])
    return (
        f"On a map of {SHAPE} voxels you give code {code} the voxel {(i, j, k)}. Put it into Eq. 4: "
        f"k + nz·(j + ny·i) = {k + nz * (j + ny * i)}. Indices run from 0 to {(nx - 1, ny - 1, nz - 1)}."
    )


@asks_for(number("the distance [m]"))
def exercise_3(answer: Callable[[np.ndarray, np.ndarray, float], float]) -> str:
    """04.3: the distance from any point to a voxel."""
    given = [answer(np.array(point), np.array(voxel), cell) for point, voxel, cell in BOXES]
    distances, right = np.asarray(given, dtype=float), [box_distance(*case) for case in BOXES]
    if same(distances, right):
        return ""
    if hint := recognised(distances, BOX_MISTAKES, BOXES, same):
        return hint
    index = next(i for i, (found, true) in enumerate(zip(distances, right, strict=True)) if not same(found, true))
    (point, voxel, cell), distance = BOXES[index], given[index]
    return (
        f"For the point {point} m and voxel {voxel} of {cell:g} m you get {distance:.3f} m. Where does the voxel "
        "begin and end on each axis, in metres, and how far outside is the point on each?"
    )


@asks_for(number("the clearance [m]"))
def exercise_4(answer: Callable[[float, float], float]) -> str:
    """04.4: the clearance that is certain in a street."""
    given = [answer(gap, cell) for gap, cell in STREETS + ON_THE_WALL]
    clearances, right = np.asarray(given, dtype=float), [certain_clearance(*case) for case in STREETS + ON_THE_WALL]
    if same(clearances, right):
        return ""
    in_streets = clearances[: len(STREETS)]
    if same(in_streets, right[: len(STREETS)]):
        return (
            "Right, but for streets that are a whole number of cells wide. There a grid can have a centre on each "
            "wall, and a centre on a wall is inside it: how many are left?"
        )
    if hint := recognised(in_streets, STREET_MISTAKES, STREETS, same):
        return hint
    index = next(i for i, found in enumerate(in_streets) if not same(found, right[i]))
    gap, cell = STREETS[index]
    return (
        f"For a street of {gap:g} m and voxels of {cell:g} m you get {given[index]:g} m. Draw the street, lay the "
        "row of centres into it so that as few as possible fall between the walls, and measure from the middle one."
    )


def from_center(point: Sequence[float], voxel: Sequence[int], cell: float) -> np.ndarray:
    """Distance on each axis from a point to the centre of a voxel, (3,) [m]."""
    return np.abs(np.array(point) - cell * (np.array(voxel) + 0.5))


def box_distance(point: Sequence[float], voxel: Sequence[int], cell: float) -> float:
    return float(np.linalg.norm(np.maximum(from_center(point, voxel, cell) - cell / 2, 0)))


def certain_clearance(gap: float, cell: float) -> float:
    return middle_clearance(math.ceil(gap / cell) - 1, cell)


def middle_clearance(free: int, cell: float) -> float:
    """Clearance of the middle one of `free` voxels in a row [m]."""
    return (math.ceil(free / 2) - 0.5) * cell if free > 0 else 0.0


BOX_MISTAKES: list[tuple[Callable[..., Any], str]] = [
    (
        lambda point, voxel, cell: np.linalg.norm(from_center(point, voxel, cell)),
        "That is the distance to the centre of the voxel. The obstacle is the whole cube: it begins half a cell "
        "before its centre, on each axis.",
    ),
    (
        lambda point, voxel, cell: np.linalg.norm(from_center(point, voxel, cell)) - cell / 2,
        "Half a cell off the whole distance is right only straight ahead, and would give a voxel the shape of a ball. "
        "Take it off on each axis, before you join them.",
    ),
    (
        lambda point, voxel, cell: np.linalg.norm(from_center(point, voxel, cell) - cell / 2),
        "On an axis where the point lies between the faces, the distance less half a cell is negative, and its square "
        "counts as if the point were outside. How far outside is it there?",
    ),
    (
        lambda point, voxel, cell: box_distance(point, voxel, 1.0),
        "Right for cells of 1 m only. Where is the centre of voxel 3 when the cell is 2 m, and how far is its face?",
    ),
    (
        lambda point, voxel, cell: cell * box_distance(point, voxel, 1.0),
        "The point is in metres already, the voxel in cells: bring both to metres before you subtract.",
    ),
    (
        lambda point, voxel, cell: np.maximum(from_center(point, voxel, cell) - cell / 2, 0).max(),
        "You take the largest of the three axes. The straight line to a corner is longer than any of its sides.",
    ),
]
"""What else students write, and what to tell them."""

STREET_MISTAKES: list[tuple[Callable[..., Any], str]] = [
    (
        lambda gap, cell: gap / 2,
        "That is the middle of the street without a grid. A planner has only centres, and a voxel is free or "
        "occupied as a whole.",
    ),
    (
        lambda gap, cell: middle_clearance(math.ceil(gap / cell), cell),
        "That is the luckiest grid: it has one centre more in the street than is certain.",
    ),
    (
        lambda gap, cell: max(math.ceil(gap / cell) - 1, 0) * cell / 2,
        "You count the right number of free voxels and take half of their width. With an even number the middle of the "
        "row is the face between two voxels, and no node is there.",
    ),
    (
        lambda gap, cell: math.ceil(max(math.ceil(gap / cell) - 1, 0) / 2) * cell,
        "You measure to the centre of the first occupied voxel. Its surface is half a cell nearer.",
    ),
    (
        lambda gap, cell: (math.ceil((math.ceil(gap / cell) - 1) / 2) - 0.5) * cell,
        "A clearance is never negative: what is left of a street in which no centre is sure to fall?",
    ),
]
"""What else students write, and what to tell them."""
