"""Triangles seen from above: how high they are at a place, where a surface of them ends, and what joins its ends.

Triangles are given as numbers of points (T, 3), so that large surfaces need no copies.
"""

from __future__ import annotations

import math

import numpy as np

from uavlab.compiled import compiled

EDGE_SLACK = 1e-9
"""So much of a triangle beyond its sides still counts as in it."""


def rims_of(triangles: np.ndarray, count: int) -> np.ndarray:
    """Points at the edges that only one triangle has, and those of no triangle, of `count`, (R,)."""
    edges = np.sort(np.concatenate([triangles[:, :2], triangles[:, 1:], triangles[:, [2, 0]]]), axis=1)
    code = np.sort(edges[:, 0] * count + edges[:, 1])
    other = np.concatenate([[True], code[1:] != code[:-1], [True]])
    single = code[other[:-1] & other[1:]] if len(code) else code
    alone = np.ones(count, dtype=bool)
    alone[triangles] = False
    alone[single // count] = alone[single % count] = True
    return np.flatnonzero(alone)


def triangulated(points: np.ndarray) -> np.ndarray:
    """Delaunay triangles (T, 3) of points (N, 3) in plan; none where fewer than three are not on a line."""
    from scipy.spatial import Delaunay, QhullError

    try:
        return Delaunay(points[:, :2] - points[:, :2].mean(axis=0)).simplices
    except (QhullError, ValueError):
        return np.empty((0, 3), int)


def heights_of(points: np.ndarray, triangles: np.ndarray, plan: np.ndarray) -> np.ndarray:
    """Heights (N,) of triangles (T, 3) of points at places (N, 2); NaN where there is none.

    Places are sorted into bins, about one in each, so that a triangle looks at few.
    """
    heights = np.full(len(plan), np.nan)
    if len(triangles) == 0 or len(plan) == 0:
        return heights
    plan = np.array(plan, order="C")  # any other layout would be compiled anew
    bins = min(math.isqrt(len(plan)) + 1, 2000)
    low, extent = plan.min(axis=0), np.ptp(plan, axis=0)
    width = np.maximum(extent, 1e-9) / bins
    i, j = np.minimum((plan - low) / width, bins - 1).astype(int).T
    order = np.argsort(i * bins + j, kind="stable")
    first = np.searchsorted((i * bins + j)[order], np.arange(bins * bins + 1))
    heights_in_bins(points, triangles, plan, low, width, order, first, heights)
    return heights


@compiled
def heights_in_bins(points, triangles, places, low, width, order, first, heights):
    """Height of each triangle at the places below it, into `heights`, the highest where several are above each other.

    The places of bin b are `order[first[b] : first[b + 1]]`; bins are `width` (2,) wide, from `low` (2,) on.
    """
    bins = int(math.sqrt(len(first) - 1.0) + 0.5)
    bounds = np.empty((2, 2), np.int64)
    for t in range(len(triangles)):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        outside = False
        for axis in range(2):
            least = min(points[a, axis], points[b, axis], points[c, axis])
            most = max(points[a, axis], points[b, axis], points[c, axis])
            slack = EDGE_SLACK * (most - least)
            start, end = (least - slack - low[axis]) / width[axis], (most + slack - low[axis]) / width[axis]
            outside = outside or end < 0 or start > bins + EDGE_SLACK
            bounds[axis, 0] = math.floor(min(max(start, 0.0), bins - 1.0))
            bounds[axis, 1] = math.floor(min(max(end, 0.0), bins - 1.0))
        if outside:
            continue
        for i in range(bounds[0, 0], bounds[0, 1] + 1):
            for m in range(first[i * bins + bounds[1, 0]], first[i * bins + bounds[1, 1] + 1]):
                n = order[m]
                height = height_in_triangle(points[a], points[b], points[c], places[n])
                if not np.isnan(height) and not height <= heights[n]:
                    heights[n] = height


@compiled
def height_in_triangle(a, b, c, place):
    """Height of a triangle with corners a, b, c (3,) at a place in plan; NaN outside of it, or where it is upright."""
    bx, by, cx, cy = b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1]
    px, py = place[0] - a[0], place[1] - a[1]
    twice = bx * cy - by * cx
    if twice == 0:
        return np.nan
    u, v = (px * cy - py * cx) / twice, (bx * py - by * px) / twice
    if u < -EDGE_SLACK or v < -EDGE_SLACK or u + v > 1 + EDGE_SLACK:
        return np.nan
    return a[2] + u * (b[2] - a[2]) + v * (c[2] - a[2])
