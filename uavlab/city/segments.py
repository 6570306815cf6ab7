"""How far straight lines stay from what is occupied: exactly, along their whole length, from box to box.

What is occupied is kept as runs, one above the other in each column of the map. Only the columns near a line are
looked at, and of those only what can be nearest. Coordinates are in cells, as in `uavlab.city.voxels`.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from uavlab.compiled import compiled

ROUNDING = 1e-9
"""What is nearer than this [cells] touches."""


class Runs(NamedTuple):
    """Occupied voxels as boxes, [i, i + 1] × [j, j + 1] × [low, high] in the column (i, j) of a map."""

    columns: tuple[int, int]  # (nx, ny)
    first: np.ndarray  # (nx·ny + 1,): number of the lowest run in column j + ny·i; those of a column follow each other
    low: np.ndarray  # (R,)
    high: np.ndarray
    inner: np.ndarray  # (R,) bool: whether all four columns around are occupied over the whole run


class Nearest(NamedTuple):
    """The box that is nearest to a line."""

    distance: float
    column: int
    """Its column, −1 where no box is as near as was asked for."""
    run: int


def runs_of(occupied: np.ndarray) -> Runs:
    """The runs of occupied voxels (nx, ny, nz); not to be written to."""
    first = first_runs(occupied)
    arrays = first, *runs_in_columns(occupied, first)
    for array in arrays:
        array.setflags(write=False)
    return Runs(occupied.shape[:2], *arrays)


@compiled
def first_runs(occupied):
    nx, ny, nz = occupied.shape
    first = np.zeros(nx * ny + 1, np.int64)
    for i in range(nx):
        for j in range(ny):
            count = 0
            below = False
            for k in range(nz):
                count += occupied[i, j, k] and not below
                below = occupied[i, j, k]
            first[j + ny * i + 1] = first[j + ny * i] + count
    return first


@compiled
def runs_in_columns(occupied, first):
    nx, ny, nz = occupied.shape
    low, high = np.empty(first[-1], np.int32), np.empty(first[-1], np.int32)
    inner = np.empty(first[-1], np.bool_)
    for i in range(nx):
        for j in range(ny):
            run = first[j + ny * i] - 1
            below = False
            surrounded = 0 < i < nx - 1 and 0 < j < ny - 1
            for k in range(nz):
                if occupied[i, j, k]:
                    if not below:
                        run += 1
                        low[run] = k
                        inner[run] = surrounded
                    high[run] = k + 1
                    if inner[run]:
                        inner[run] = (
                            occupied[i - 1, j, k]
                            and occupied[i + 1, j, k]
                            and occupied[i, j - 1, k]
                            and occupied[i, j + 1, k]
                        )
                below = occupied[i, j, k]
    return low, high, inner


@compiled
def gap(x, low, high):
    """From an interval to x; negative below it, 0 within."""
    if x < low:
        return x - low
    if x > high:
        return x - high
    return 0.0


@compiled
def distance_to_box(start, end, i, j, low, high):
    """Least distance of a segment to the box [i, i + 1] × [j, j + 1] × [low, high].

    Along the segment its square is convex, and a parabola between the planes of the box's faces. So the slopes at the
    planes tell between which two the least is, and the slopes at those two where.
    """
    x, y, z = start
    dx, dy, dz = end[0] - x, end[1] - y, end[2] - z
    before, slope_before = 0.0, dx * gap(x, i, i + 1) + dy * gap(y, j, j + 1) + dz * gap(z, low, high)
    after, slope_after = 1.0, dx * gap(end[0], i, i + 1) + dy * gap(end[1], j, j + 1) + dz * gap(end[2], low, high)
    if slope_before >= 0.0:
        return math.sqrt(gap(x, i, i + 1) ** 2 + gap(y, j, j + 1) ** 2 + gap(z, low, high) ** 2)
    if slope_after <= 0.0:
        return math.sqrt(gap(end[0], i, i + 1) ** 2 + gap(end[1], j, j + 1) ** 2 + gap(end[2], low, high) ** 2)
    for at, step, face in (
        (x, dx, 1.0 * i), (x, dx, i + 1.0), (y, dy, 1.0 * j), (y, dy, j + 1.0), (z, dz, 1.0 * low), (z, dz, 1.0 * high),
    ):  # fmt: skip
        if step == 0.0:
            continue
        share = (face - at) / step
        if before < share < after:
            slope = dx * gap(x + share * dx, i, i + 1) + dy * gap(y + share * dy, j, j + 1)
            slope += dz * gap(z + share * dz, low, high)
            if slope < 0.0:
                before, slope_before = share, slope
            else:
                after, slope_after = share, slope
    share = before + (after - before) * slope_before / (slope_before - slope_after)
    across = gap(x + share * dx, i, i + 1) ** 2 + gap(y + share * dy, j, j + 1) ** 2
    return math.sqrt(across + gap(z + share * dz, low, high) ** 2)


@compiled
def shares_between(start, extent, low, high):
    """Shares of a segment between which one of its coordinates is from low to high, within 0 to 1."""
    if extent == 0.0:
        return 0.0, 1.0
    first, last = (low - start) / extent, (high - start) / extent
    if extent < 0.0:
        first, last = last, first
    return min(max(first, 0.0), 1.0), min(max(last, 0.0), 1.0)


@compiled
def nearest_run(runs, start, end, at_most, enough):
    """The occupied box that is nearest to a segment, if it is nearer than `at_most`.

    Parameters
    ----------
    runs : Runs
    start, end : (3,) arrays [cells]
    at_most : float
        Finite; the wider, the more columns are looked at.
    enough : float
        The first box that is at least so near is taken.

    Returns
    -------
    Nearest
        With the distance `at_most` where none is nearer.
    """
    distance, column, run = at_most, -1, -1
    u = 0 if abs(end[0] - start[0]) >= abs(end[1] - start[1]) else 1  # columns are looked at row by row along it
    v = 1 - u
    du, dv, dz = end[u] - start[u], end[v] - start[v], end[2] - start[2]
    ny = runs.columns[1]
    a = max(math.floor(min(start[u], end[u]) - distance), 0)
    while a <= min(math.floor(max(start[u], end[u]) + distance), runs.columns[u] - 1):
        first, last = shares_between(start[u], du, a - distance, a + 1 + distance)
        near, far = start[v] + first * dv, start[v] + last * dv
        near, far = min(near, far), max(near, far)
        bottom, top = start[2] + first * dz, start[2] + last * dz
        bottom, top = min(bottom, top), max(bottom, top)
        first, last = shares_between(start[u], du, a, a + 1)
        enter, leave = start[v] + first * dv, start[v] + last * dv
        enter, leave = math.floor(min(enter, leave)), math.floor(max(enter, leave))
        for b in range(max(math.floor(near - distance), 0), min(math.floor(far + distance), runs.columns[v] - 1) + 1):
            i, j = (a, b) if u == 0 else (b, a)
            for r in range(runs.first[j + ny * i], runs.first[j + ny * i + 1]):
                low, high = runs.low[r], runs.high[r]
                if high <= bottom - distance or low >= top + distance:
                    continue
                if runs.inner[r] and low <= bottom and top <= high and not enter <= b <= leave:
                    continue  # a column around it is at least as near
                apart = distance_to_box(start, end, i, j, low, high)
                if apart < distance:
                    distance, column, run = apart, j + ny * i, r
                    if distance <= enough:
                        return Nearest(distance, column, run)
        a += 1
    return Nearest(distance, column, run)


@compiled
def segment_clearance(runs, start, end, at_most):
    """Least distance of a segment to what is occupied [cells], `at_most` where that is more; see `nearest_run`."""
    return nearest_run(runs, start, end, at_most, 0.0).distance


@compiled
def segment_clearances(runs, clearance, cell, starts, ends, at_most):
    """Of segments (N, 3) each, at most (N,); `clearance` is that of the voxels' centres [m], `cell` their edge [m]."""
    distances = np.empty(len(starts))
    for n in range(len(starts)):
        bound = distance_bound(clearance, cell, starts[n])
        if bound == np.inf:
            distances[n] = at_most[n]
        else:
            distances[n] = segment_clearance(runs, starts[n], ends[n], min(bound, at_most[n]))
    return distances


@compiled
def segment_distances(runs, starts, ends, at_most):
    """Of segments (N, 3) each, at most (N,), all finite: without knowing the clearance of voxels."""
    distances = np.empty(len(starts))
    for n in range(len(starts)):
        distances[n] = segment_clearance(runs, starts[n], ends[n], at_most[n])
    return distances


@compiled
def least_clearance(runs, clearance, cell, points):
    """Least distance of a polyline (N, 3) to what is occupied [cells]; as `segment_clearances`."""
    least = np.inf
    for n in range(len(points)):
        least = min(least, distance_bound(clearance, cell, points[n]))
    if least == np.inf:
        return least
    for n in range(len(points) - 1):
        if least_to_expect(clearance, cell, points[n], points[n + 1]) < least:
            least = segment_clearance(runs, points[n], points[n + 1], least)
    return least if len(points) > 1 else segment_clearance(runs, points[0], points[0], least)


@compiled
def least_to_expect(clearance, cell, start, end):
    """A distance [cells] that a segment certainly keeps, as the clearance where it begins tells, quickly."""
    off, i, j, k = from_centre(clearance.shape, start)
    length = math.sqrt((end[0] - start[0]) ** 2 + (end[1] - start[1]) ** 2 + (end[2] - start[2]) ** 2)
    return clearance[i, j, k] / cell - off - length - ROUNDING


@compiled
def distance_bound(clearance, cell, point):
    """What the distance of a point to what is occupied can't be more than [cells]."""
    off, i, j, k = from_centre(clearance.shape, point)
    return (clearance[i, j, k] / cell + off) * (1 + ROUNDING) + ROUNDING


@compiled
def from_centre(shape, point):
    """How far a point is from the centre of its voxel, or of the nearest on the map [cells]; and that voxel."""
    i = min(max(math.floor(point[0]), 0), shape[0] - 1)
    j = min(max(math.floor(point[1]), 0), shape[1] - 1)
    k = min(max(math.floor(point[2]), 0), shape[2] - 1)
    off = math.sqrt((point[0] - i - 0.5) ** 2 + (point[1] - j - 0.5) ** 2 + (point[2] - k - 0.5) ** 2)
    return off, i, j, k
