"""Checks of the exercises on cities: free voxels, codes, distances, streets, a mast and the ring, an own map."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cache, partial
from typing import Any

import numpy as np

from uavlab.city import Building, City
from uavlab.exercises.hints import alike, recognised
from uavlab.exercises.kinds import Quiz, asks_for, asks_for_value, number, numbers, thing

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

HOUSES = [
    Building.prism([(west, south), (east, south), (east, north), (west, north)], 14.0)
    for west, east in ((4.2, 23.3), (28.6, 51.4))
    for south, north in ((3.1, 16.9), (22.1, 38.7))
]
QUARTER = np.array([(0.0, 0.0, 0.0), (56.0, 42.0, 20.0)])
MOST_VOXELS, LEAST_CLEARANCE, MOST_GROWTH = 50_000, 2.0, 0.15
"""What a map of one's own has to cover [m], and what else it has to do."""

same = partial(alike, relative=0, absolute=1e-6)

exercise_1 = Quiz(
    right="b",
    because="Only centres were looked at. Walls may reach into a free voxel from both sides, nearly to its middle.",
    wrong={
        "a": "That would be true by touch. Draw a voxel whose centre is free, and let a wall reach into it.",
        "c": "A shift moves all centres. But wherever they are, each of them was tested. What was the test?",
        "d": "Centres make a house larger on some grids and smaller on others. When does the gap seem wider?",
    },
)


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
            "You let i change fastest. In Eq. 3 it is k that has no factor: the next code is the voxel above, "
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
        f"On a map of {SHAPE} voxels you give code {code} the voxel {(i, j, k)}. Put it into Eq. 3: "
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


@asks_for_value(numbers((3,), "three shares, from 0 to 1: for radius 3, 4 and 5"))
def exercise_5(shares: Sequence[float]) -> str:
    """04.5: what the ring misses of the zone around a mast."""
    given = np.asarray(shares, dtype=float)
    if alike(given, [shares_of(radius)["missed"] for radius in RADII], relative=0, absolute=2e-3):
        return ""
    for name, hint in MAST_MISTAKES.items():
        if alike(given, [shares_of(radius)[name] for radius in RADII], relative=0, absolute=2e-3):
            return hint
    if alike(given / 100, [shares_of(radius)["missed"] for radius in RADII], relative=0, absolute=2e-3):
        return "These are per cent. Shares are from 0 to 1."
    if alike(given, [0.0076, 0.0099, 0.0140], relative=0, absolute=5e-4):
        return "These are the shares of the test city in the chapter. Here the only obstacle is the mast."
    return (
        f"For radius 3 you give {given[0]:.3g}. Count a single layer first: how many free nodes have a clearance below "
        "3.5 m, and from how many of them does the ring meet the mast?"
    )


RADII = (3, 4, 5)


@cache
def shares_of(radius: int) -> dict[str, float]:
    """Around a mast of one column: the share that the ring misses, and what else students compute."""
    column, x, y = 15, *np.indices((31, 31))
    mast = (x == column) & (y == column)
    dx, dy = np.abs(x - column), np.abs(y - column)
    exact = np.hypot(np.maximum(dx - 0.5, 0), np.maximum(dy - 0.5, 0)) < radius + 0.5
    ring = np.isin(dx, (0, radius)) & np.isin(dy, (0, radius))
    zone, centres = exact & ~mast, (np.hypot(dx, dy) <= radius) & ~mast
    return {
        "missed": (zone & ~ring).sum() / zone.sum(),
        "seen": (zone & ring).sum() / zone.sum(),
        "seen or added": (ring & ~mast).sum() / zone.sum(),
        "with the mast": (exact & ~ring).sum() / exact.sum(),
        "between centres": (centres & ~ring).sum() / centres.sum(),
        "of all": (zone & ~ring).sum() / (~mast).sum(),
    }


MAST_MISTAKES = {
    "seen": "That is what the ring sees of the zone. What is the rest?",
    "seen or added": "That is all that the ring calls risky, over the zone. Some of it lies outside of the zone.",
    "with the mast": "You count the voxels of the mast, too. No UAV can be there: take free nodes only.",
    "between centres": "Your zone is measured between centres. Take the clearance, and the radius and a half.",
    "of all": "You divide by all free nodes. A larger map would make your share smaller: divide by the zone.",
}
"""What else students compute, and what to tell them."""


@asks_for_value(thing(City, "a `City`, as from `City.from_buildings(houses, …)`"))
def exercise_6(own: City) -> str:
    """04.6: a map with a budget, in which two streets stay open."""
    low, high = own.bounds
    if (low > QUARTER[0] + 1e-9).any() or (high < QUARTER[1] - 1e-9).any():
        corners = [f"({', '.join(f'{part:g}' for part in corner)})" for corner in (low, high)]
        return f"Your map covers {corners[0]} to {corners[1]} m. It has to cover (0, 0, 0) to (56, 42, 20) m."
    if own.occupied.size > MOST_VOXELS:
        return f"Your map has {own.occupied.size:,} voxels, and there is room for {MOST_VOXELS:,}."
    touched = City.from_buildings(HOUSES, cell=own.cell, origin=own.origin, size=own.cell * np.array(own.shape))
    if (forgotten := touched.occupied & ~own.occupied).any():
        place = ", ".join(f"{part:.4g}" for part in own.center_of(np.argwhere(forgotten)[0]))
        return (
            f"A house reaches into {forgotten.sum():,} free voxels, such as the one at ({place}) m. Which of the two "
            "rules never lets that happen?"
        )
    streets = {"from south to north": ((25.9, 10.0, 5.0), 0), "from west to east": ((12.0, 19.5, 5.0), 1)}
    for name, (middle, axis) in streets.items():
        index: list[Any] = [int(part) for part in own.cell_of(middle)]
        index[axis] = np.abs(own.coordinates(axis) - middle[axis]) < 2.65
        best = float(own.clearance[tuple(index)].max(initial=0.0))
        if best < LEAST_CLEARANCE - 1e-9:
            return (
                f"In the street {name} the best node has {best:.2f} m of clearance, and 2 m are asked for. How many "
                "whole voxels fit between the walls, is there one in the middle, and where would the faces have to be?"
            )
    built = sum(float(np.prod(house.bounds[1] - house.bounds[0])) for house in HOUSES)
    growth = float(own.occupied.sum()) * own.cell**3 / built - 1
    if growth > MOST_GROWTH:
        return f"The occupied voxels have {growth:.0%} more volume than the houses; at most 15 % are allowed."
    return ""


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
    (
        lambda point, voxel, cell: np.maximum(from_center(point, voxel, cell) - cell / 2, 0).sum(),
        "You add the three axes. That is the way along the axes; the straight line is shorter.",
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
