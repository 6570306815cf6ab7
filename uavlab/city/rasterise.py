"""From solids to voxels: what a building, a terrain or a zone occupies, and how high the surface below each voxel is.

Two rules. "touched": a voxel is occupied when a building reaches into it, so what is free is free. "centres": when its
centre lies in one, the papers' rule, which loses what is thinner than a voxel.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import islice
from typing import NamedTuple

import numpy as np

from uavlab.city.buildings import FACE_TOLERANCE, Building, Hull
from uavlab.city.columns import fill, touch, widen

TOUCH = 1e-6
"""What reaches less far into a voxel [m] only touches it: rounding of coordinates, not thickness."""

AT_ONCE = 10_000
"""So many pieces are rasterised in one go."""

RULES = ("touched", "centres")


class Ranges(NamedTuple):
    """How low and how high a convex solid reaches in the columns of a window; low is above high where it doesn't."""

    window: tuple[slice, slice]
    low: np.ndarray  # [m]
    high: np.ndarray


class Window(NamedTuple):
    """Columns of a map, for the rule "touched"; each has the voxels that it has on the whole map, to the last one."""

    first: tuple[int, int]
    """Its first column along x and y."""
    columns: tuple[int, int]
    """So many has the whole map."""


def ranges_of(triangles: np.ndarray, shape: Sequence[int], cell: float, origin: np.ndarray) -> Ranges:
    """Heights of the surface (T, 3, 3) [m] of a convex solid, or of a terrain, in the columns that it reaches into."""
    plan = (triangles[..., :2] - origin[:2]) / cell
    first = np.clip(np.floor(plan.min(axis=(0, 1))).astype(int), 0, shape[:2])
    last = np.clip(np.ceil(plan.max(axis=(0, 1))).astype(int), first, shape[:2])
    low, high = np.full(last - first, np.inf), np.full(last - first, -np.inf)
    widen(np.concatenate([plan - first, triangles[..., 2:]], axis=2), TOUCH / cell, low, high)
    return Ranges((slice(first[0], last[0]), slice(first[1], last[1])), low, high)


def rasterise(
    hulls: Iterable[Hull], occupied: np.ndarray, cell: float, origin: np.ndarray, rule: str,
    window: Window | None = None,
) -> None:  # fmt: skip
    """Mark the voxels of convex pieces, in place; what sticks out of the map, or its window, is cut off."""
    if rule == "centres":
        for hull in hulls:
            mark_centres(hull, occupied, cell, origin)
        return
    waiting = iter(hulls)
    while surfaces := [hull.triangles for hull in islice(waiting, AT_ONCE)]:
        triangles = (np.concatenate(surfaces) - origin) / cell
        ends = np.cumsum([len(surface) for surface in surfaces])
        touch(occupied, triangles, ends, TOUCH / cell, *(window or Window((0, 0), occupied.shape[:2])))


def mark_centres(hull: Hull, occupied: np.ndarray, cell: float, origin: np.ndarray) -> None:
    """Mark the voxels whose centres lie in a convex piece, in place."""
    low = np.clip(np.floor((hull.points.min(axis=0) - origin) / cell - 0.5).astype(int), 0, occupied.shape)
    high = np.clip(np.ceil((hull.points.max(axis=0) - origin) / cell + 0.5).astype(int), 0, occupied.shape)
    x, y, z = np.ix_(*(origin[a] + cell * (np.arange(low[a], high[a]) + 0.5) for a in range(3)))
    inside = np.ones(high - low, dtype=bool)
    for a, b, c, d in hull.equations:  # one face after the other, as in Building.contains, for memory's sake
        inside &= a * x + b * y + c * z + d <= FACE_TOLERANCE
    occupied[low[0] : high[0], low[1] : high[1], low[2] : high[2]] |= inside


def mark_ground(occupied: np.ndarray, top: np.ndarray, cell: float, bottom: float) -> None:
    """Mark the voxels that a terrain with highest points (nx, ny) [m] reaches into, in place."""
    highest = (top - bottom) / cell
    fill(occupied, np.minimum(highest, 0.0) - 1.0, highest, TOUCH / cell)


def raise_surface(building: Building, surface: np.ndarray, levels: np.ndarray, cell: float, origin: np.ndarray) -> None:
    """Raise the surface below each centre (nx, ny, nz) to the highest point of the building there, in place.

    Highest within the column, and not above the centre: a centre within the building has its surface at its own height.
    """
    for hull in building.hulls:
        (i, j), low, high = ranges_of(hull.triangles, surface.shape, cell, origin)
        below = np.where(levels >= low[..., None], np.minimum(high[..., None], levels), -np.inf)
        np.maximum(surface[i, j], below, out=surface[i, j])


def surface_below(
    buildings: Sequence[Building], occupied: np.ndarray, ground: np.ndarray, levels: np.ndarray, cell: float,
    origin: np.ndarray,
) -> np.ndarray:  # fmt: skip
    """Highest point of ground and roofs below each centre, anywhere in its column, (nx, ny, nz) [m].

    `ground` (nx, ny) is the highest of each column, `levels` (nz,) are the heights of the centres [m]. Without
    buildings what is occupied counts.
    """
    surface = np.empty(occupied.shape)
    surface[:] = np.minimum(ground[..., None], levels)
    if not buildings:
        above_ground = levels - cell / 2 >= ground[..., None]
        tops = np.where(occupied & above_ground, levels + cell / 2, surface)
        return np.maximum.accumulate(tops, axis=2)
    for building in buildings:
        raise_surface(building, surface, levels, cell, origin)
    return surface


def range_of_ground(ground: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Lowest and highest point of the ground in each column (nx, ny) [m], bilinear between the columns' centres."""
    padded = np.pad(ground, 1, mode="edge")
    along_x = (padded[:-1] + padded[1:]) / 2  # in the middle of the west and east sides
    along_y = (padded[:, :-1] + padded[:, 1:]) / 2
    corners = (along_x[:, :-1] + along_x[:, 1:]) / 2
    there = [
        ground,
        along_x[:-1, 1:-1], along_x[1:, 1:-1], along_y[1:-1, :-1], along_y[1:-1, 1:],
        corners[:-1, :-1], corners[1:, :-1], corners[:-1, 1:], corners[1:, 1:],
    ]  # fmt: skip
    return np.min(there, axis=0), np.max(there, axis=0)


def bilinear(ground: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """Heights of the ground at places (..., 2) counted in columns from the corner of the map."""
    at = np.clip(columns - 0.5, 0.0, np.array(ground.shape) - 1.0)
    i, j = np.moveaxis(np.minimum(at.astype(int), np.maximum(np.array(ground.shape) - 2, 0)), -1, 0)
    x, y = at[..., 0] - i, at[..., 1] - j
    east, north = np.minimum(i + 1, ground.shape[0] - 1), np.minimum(j + 1, ground.shape[1] - 1)
    south_side = (1 - x) * ground[i, j] + x * ground[east, j]
    north_side = (1 - x) * ground[i, north] + x * ground[east, north]
    return (1 - y) * south_side + y * north_side


def reaches_into(building: Building, voxel: np.ndarray, cell: float) -> bool:
    """Whether a building reaches into the voxel with this lowest corner (3,) [m]."""
    here = np.zeros((1, 1, 1), dtype=bool)
    rasterise(building.hulls, here, cell, voxel, "touched")
    return bool(here.any())


def touches(building: Building, shape: Sequence[int], cell: float, origin: np.ndarray) -> np.ndarray:
    """Which columns of a map a building reaches into, (nx, ny) bool."""
    columns = np.zeros(tuple(shape[:2]), dtype=bool)
    for hull in building.hulls:
        window, low, high = ranges_of(hull.triangles, shape, cell, origin)
        columns[window] |= low < high
    return columns
