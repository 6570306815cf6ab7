"""What flat polygons do in columns of voxels: how low and how high they reach in each, and how much of it they cover.

A column is a square in plan. A convex polygon is cut to it edge by edge (Sutherland and Hodgman 1974), first to the
strip of columns that share an x, then to each square of the strip. The surface of a convex solid, cut to a column, has
the lowest and the highest point that the solid has there; so it touches the voxels in between and no others. The same
cut gives terrain its highest point in a column, and shares out the pixels of a raster without loss.

Coordinates in plan are in cells, counted from the first column of a window; heights are in any unit.
"""

from __future__ import annotations

import math

import numpy as np

from uavlab.compiled import compiled

X, Y = 0, 1


@compiled
def cut(polygon, count, axis, bound, above, out):
    """The corners of a convex polygon (count, 2 or 3) on one side of a line x or y = bound, into `out`; how many."""
    kept = 0
    for n in range(count):
        following = (n + 1) % count
        here, there = polygon[n, axis] - bound, polygon[following, axis] - bound
        if not above:
            here, there = -here, -there
        if here >= 0:
            out[kept] = polygon[n]
            kept += 1
        if (here > 0 and there < 0) or (here < 0 and there > 0):
            share = here / (here - there)
            for a in range(polygon.shape[1]):
                out[kept, a] = polygon[n, a] + share * (polygon[following, a] - polygon[n, a])
            out[kept, axis] = bound
            kept += 1
    return kept


@compiled
def columns_between(least, most, inset, last):
    """First and, exclusively, last column that an extent reaches into by more than `inset`, within 0 and `last`."""
    first = min(max(math.floor(least + inset), 0), last)
    return first, min(max(math.ceil(most - inset), first), last)


@compiled
def extent(polygon, count, axis):
    least, most = polygon[0, axis], polygon[0, axis]
    for n in range(1, count):
        least, most = min(least, polygon[n, axis]), max(most, polygon[n, axis])
    return least, most


@compiled
def widen(polygons, inset, low, high, first=(0, 0)):
    """Widen the range of heights of each column, in place, by what of flat polygons (T, P, 3) lies in it.

    Columns (nx, ny) are smaller by `inset` on each side: what merely touches one at its border isn't in it. They begin
    with the column `first`.
    """
    end = (first[0] + low.shape[0], first[1] + low.shape[1])
    corners = polygons.shape[1]
    strip, square, spare = np.empty((corners + 8, 3)), np.empty((corners + 8, 3)), np.empty((corners + 8, 3))
    for polygon in polygons:
        west, east = extent(polygon, corners, X)
        first_i, last_i = columns_between(west, east, inset, end[0])
        for i in range(max(first_i, first[0]), last_i):
            count = cut(polygon, corners, X, i + inset, True, spare)
            count = cut(spare, count, X, i + 1 - inset, False, strip)
            if count == 0:
                continue
            south, north = extent(strip, count, Y)
            first_j, last_j = columns_between(south, north, inset, end[1])
            for j in range(max(first_j, first[1]), last_j):
                left = cut(strip, count, Y, j + inset, True, spare)
                left = cut(spare, left, Y, j + 1 - inset, False, square)
                a, b = i - first[0], j - first[1]
                for n in range(left):
                    low[a, b] = min(low[a, b], square[n, 2])
                    high[a, b] = max(high[a, b], square[n, 2])


@compiled
def share_out(polygons, values, sums, areas):
    """Add to each column (nx, ny) the areas [cells²] of polygons (T, P, 2) in it, and the areas times their values."""
    corners = polygons.shape[1]
    strip, square, spare = np.empty((corners + 8, 2)), np.empty((corners + 8, 2)), np.empty((corners + 8, 2))
    for t in range(len(polygons)):
        west, east = extent(polygons[t], corners, X)
        first_i, last_i = columns_between(west, east, 0.0, sums.shape[0])
        for i in range(first_i, last_i):
            count = cut(polygons[t], corners, X, float(i), True, spare)
            count = cut(spare, count, X, i + 1.0, False, strip)
            if count == 0:
                continue
            south, north = extent(strip, count, Y)
            first_j, last_j = columns_between(south, north, 0.0, sums.shape[1])
            for j in range(first_j, last_j):
                left = cut(strip, count, Y, float(j), True, spare)
                left = cut(spare, left, Y, j + 1.0, False, square)
                area = area_of(square, left)
                areas[i, j] += area
                sums[i, j] += values[t] * area


@compiled
def area_of(polygon, count):
    """Area of a polygon in plan, by the shoelace formula about its first corner."""
    twice = 0.0
    for n in range(1, count - 1):
        ax, ay = polygon[n, 0] - polygon[0, 0], polygon[n, 1] - polygon[0, 1]
        bx, by = polygon[n + 1, 0] - polygon[0, 0], polygon[n + 1, 1] - polygon[0, 1]
        twice += ax * by - ay * bx
    return abs(twice) / 2


@compiled
def touch(occupied, triangles, ends, inset, first, columns):
    """Mark the voxels that convex solids reach into by more than `inset`, in place.

    The surface of solid n are the triangles (T, 3, 3) [cells from the corner of the map] from ends[n − 1] to ends[n].
    `occupied` are the columns of a map of so many `columns` (nx, ny) from the column `first` (i, j) on; what is marked
    in one doesn't depend on where they begin.
    """
    begin = 0
    for end in ends:
        surface = triangles[begin:end].copy()
        begin = end
        window = np.empty((2, 2), np.int64)
        here = np.empty((2, 2), np.int64)
        for axis in range(2):
            least, most = surface[0, 0, axis], surface[0, 0, axis]
            for triangle in surface:
                for corner in triangle:
                    least, most = min(least, corner[axis]), max(most, corner[axis])
            window[axis] = columns_between(least, most, inset, columns[axis])
            here[axis, 0] = max(window[axis, 0], first[axis])
            here[axis, 1] = min(window[axis, 1], first[axis] + occupied.shape[axis])
            surface[:, :, axis] -= window[axis, 0]
        if here[0, 0] >= here[0, 1] or here[1, 0] >= here[1, 1]:
            continue
        shape = (here[0, 1] - here[0, 0], here[1, 1] - here[1, 0])
        low, high = np.full(shape, np.inf), np.full(shape, -np.inf)
        widen(surface, inset, low, high, (here[0, 0] - window[0, 0], here[1, 0] - window[1, 0]))
        i, j = here[0, 0] - first[0], here[1, 0] - first[1]
        fill(occupied[i : i + shape[0], j : j + shape[1]], low, high, inset)


@compiled
def fill(occupied, low, high, inset):
    """Mark the voxels [cells] (nx, ny, nz) that ranges of heights (nx, ny) reach into by more than `inset`."""
    for i in range(low.shape[0]):
        for j in range(low.shape[1]):
            if low[i, j] < high[i, j]:
                first, last = columns_between(low[i, j], high[i, j], inset, occupied.shape[2])
                for k in range(first, last):
                    occupied[i, j, k] = True
