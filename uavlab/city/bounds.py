"""What a straight leg must keep at each of its points: its distance to obstacles, out of no-fly zones, heights.

A planner on the grid asks only at the centres of voxels. That is enough for its moves, as every voxel of a move's
bounding box is asked; legs at any angle and curves are asked all along. Compiled code counts in cells.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from uavlab import checks
from uavlab.city.model import City
from uavlab.city.segments import ROUNDING, Runs, nearest_run, runs_of, shares_between
from uavlab.compiled import compiled


class Bounds(NamedTuple):
    """What a leg must keep [cells]."""

    obstacles: Runs
    keep: float  # from obstacles
    zones: Runs
    apart: float  # from no-fly zones
    lowest: np.ndarray  # (nx, ny, 1 or nz)
    highest: np.ndarray  # (nx, ny)
    limited: bool  # whether there are such heights at all
    shape: tuple[int, int, int]


def bounds_of(
    city: City,
    min_clearance: float = 0.0,
    min_height: float = 0.0,
    max_height: float = np.inf,
    safe_height: float = 0.0,
) -> Bounds:
    """The bounds of a city; a touch is too near, and what is as near as asked for, to rounding, is far enough."""
    city.blocked(min_clearance, min_height=min_height, max_height=max_height)  # refuses what is out of range
    checks.not_negative_number("safe_height", safe_height)
    slack = slack_of(city)
    heights = height_limits(city, min_height, max_height, safe_height)
    return Bounds(
        city.runs, max(min_clearance / city.cell - slack, slack),
        runs_of(city.in_no_fly), slack,
        *heights, min_height > 0 or max_height < np.inf or safe_height > 0, city.shape,
    )  # fmt: skip


def rounding_of(city: City) -> float:
    """By how much positions [cells] are rounded: far from x = y = z = 0 a float has few digits left for a cell."""
    return 4 * np.finfo(float).eps * float(np.abs(city.bounds).max()) / city.cell


def slack_of(city: City) -> float:
    """What is nearer than this [cells] touches, with positions as they are rounded."""
    return ROUNDING + rounding_of(city)


def height_limits(
    city: City, min_height: float, max_height: float, safe_height: float
) -> tuple[np.ndarray, np.ndarray]:
    """Least z (nx, ny, 1 or nz) and greatest (nx, ny) [cells], with room for rounding; not to be written to."""
    slack = slack_of(city)
    low, high = city.range_of_ground[1][..., None] + min_height, city.range_of_ground[0] + max_height
    if safe_height > 0:
        low = np.maximum(low, city.surface_below + safe_height)
    limits = (low - city.origin[2]) / city.cell - slack, (high - city.origin[2]) / city.cell + slack
    for array in limits:
        array.setflags(write=False)
    return limits


@compiled
def keeps(bounds, start, end, aside, rise):
    """Whether all that is within `aside` of a leg, and `rise` above and below it, keeps the bounds.

    And if not, the box that is too near, as (i, j, low, high, least distance); i is −1 where it isn't one.
    """
    nobody = (-1, 0, 0, 0, 0.0)
    for point in (start, end):
        for axis in range(3):
            if not 0 <= point[axis] < bounds.shape[axis]:
                return False, nobody
    if bounds.limited and least_room(bounds.lowest, bounds.highest, start, end, aside) < rise:
        return False, nobody
    for runs, apart in ((bounds.zones, bounds.apart), (bounds.obstacles, bounds.keep)):
        near = nearest_run(runs, start, end, apart + aside, apart + aside)
        if near.column >= 0:
            i, j = divmod(near.column, bounds.shape[1])
            return False, (i, j, runs.low[near.run], runs.high[near.run], apart)
    return True, nobody


@compiled
def legs_keep(bounds, points, aside, rise):
    """Whether each leg of a polyline (N, 3) keeps the bounds, (N − 1,) bool; see `keeps`."""
    kept = np.empty(len(points) - 1, np.bool_)
    for n in range(len(points) - 1):
        kept[n] = keeps(bounds, points[n], points[n + 1], aside[n], rise[n])[0]
    return kept


@compiled
def least_room(lowest, highest, start, end, aside):
    """How far a leg stays above `lowest` (nx, ny, 1 or nz) and below `highest` [cells] in each column within `aside`.

    Negative where it doesn't; beyond the map there are no limits. Between its ends in a free column nothing begins
    that it would have to be above.
    """
    top = lowest.shape[2] - 1
    room = np.inf
    dx, dy, dz = end[0] - start[0], end[1] - start[1], end[2] - start[2]
    west, east = min(start[0], end[0]) - aside, max(start[0], end[0]) + aside
    for i in range(max(math.floor(west), 0), min(math.floor(east), lowest.shape[0] - 1) + 1):
        first, last = shares_between(start[0], dx, i - aside, i + 1 + aside)
        enter, leave = start[1] + first * dy, start[1] + last * dy
        enter, leave = min(enter, leave) - aside, max(enter, leave) + aside
        for j in range(max(math.floor(enter), 0), min(math.floor(leave), lowest.shape[1] - 1) + 1):
            within, until = shares_between(start[1], dy, j - aside, j + 1 + aside)
            within, until = max(within, first), min(until, last)
            if until - within <= 1e-12 and (dx != 0.0 or dy != 0.0):
                continue  # it touches only an edge of the column
            one, other = start[2] + within * dz, start[2] + until * dz
            for z in (one, other):
                below = lowest[i, j, min(max(math.floor(z), 0), top)]
                room = min(room, z - below, highest[i, j] - z)
    return room
