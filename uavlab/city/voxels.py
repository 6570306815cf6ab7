"""Two exact computations on voxels: how far the nearest surface is, and which voxels a straight line passes.

Coordinates here are in cells: voxel (i, j, k) covers [i, i+1) × [j, j+1) × [k, k+1), its centre is (i+½, j+½, k+½).
"""

from __future__ import annotations

import math

import numpy as np

from uavlab.compiled import compiled

SURFACE = 1e-9
"""What is nearer than this touches [cells]."""

TINY = 1e-300
"""A clearance below this is that of an obstacle."""

MOST_PASSED = 50_000_000
"""A polyline through more voxels is refused: it would need gigabytes."""

FARTHEST = 2.0**52
"""From here on [cells] a float no longer tells where in its voxel a point is."""

SAME_SHARE = 1e-12
"""Shares of a segment that differ by less are the same point."""


@compiled
def put_clearance(occupied, cell, clearance):
    """Write the distance [m] from each centre to the nearest surface of an occupied voxel into (nx, ny, nz) floats.

    0 inside; infinite everywhere when nothing is occupied. One axis after the other, the minimum of the squares over
    all obstacles is a lower envelope of parabolas (Felzenszwalb and Huttenlocher 2012), here on a line of half cells,
    because the nearest point of a voxel is its centre plane or one of its faces. Distances between centres would be
    off by half a cell and more.
    """
    nx, ny, nz = occupied.shape
    for i in range(nx):
        for j in range(ny):
            for k in range(nz):
                clearance[i, j, k] = 0.0 if occupied[i, j, k] else np.inf
    for j in range(ny):
        for k in range(nz):
            lower_envelope(clearance[:, j, k])
    for i in range(nx):
        for k in range(nz):
            lower_envelope(clearance[i, :, k])
        for j in range(ny):
            lower_envelope(clearance[i, j])
    for i in range(nx):
        for j in range(ny):
            for k in range(nz):
                clearance[i, j, k] = math.sqrt(clearance[i, j, k]) * cell


@compiled
def least_kept(min_clearance, cell):
    """The clearance [m] from which on one that is asked for is kept, to rounding; that of an obstacle never is."""
    return max(min_clearance - 1e-9 * cell, TINY) if min_clearance > 0 else TINY


@compiled
def lower_envelope(line):
    """Replace line[x] by the minimum over q of line[q] + max(|x − q| − ½, 0)², in place."""
    apex = np.empty(2 * line.size + 1)  # of the parabolas in the envelope, [half cells]
    height = np.empty(2 * line.size + 1)
    begin = np.empty(2 * line.size + 1)  # where each becomes the lowest, [half cells]
    count = 0
    for face in range(2 * line.size + 1):  # odd: centre plane of a voxel; even: between two of them
        level = min(line[max(face // 2 - 1 + face % 2, 0)], line[min(face // 2, line.size - 1)])
        if level == np.inf:
            continue
        start = -np.inf
        while count > 0:
            last = count - 1
            gap = 4.0 * (level - height[last]) + face * face - apex[last] * apex[last]
            start = gap / (2.0 * (face - apex[last]))
            if start > begin[last]:
                break
            count -= 1
            start = -np.inf
        apex[count], height[count], begin[count] = face, level, start
        count += 1
    if count == 0:
        return
    lowest = 0
    for x in range(line.size):
        while lowest + 1 < count and begin[lowest + 1] <= 2 * x + 1:
            lowest += 1
        line[x] = height[lowest] + 0.25 * (2 * x + 1 - apex[lowest]) ** 2


@compiled
def voxels_on_segment(start, end):
    """Voxels in which a segment has length, in order, and the share of the segment at which each is left.

    Amanatides and Woo 1987. Where the segment crosses an edge or a corner (to rounding), it goes straight to the
    voxel opposite.

    Parameters
    ----------
    start, end : (3,) float arrays [cells]

    Returns
    -------
    voxels : (M, 3) int array
    leave : (M,) float array, increasing to 1; a point gives its one voxel.
    """
    voxel = np.empty(3, np.int64)
    step = np.zeros(3, np.int64)
    crossing = np.full(3, np.inf)  # share of the segment at the next face of each axis
    between = np.full(3, np.inf)  # share of the segment from face to face
    capacity = 4
    for axis in range(3):
        extent = end[axis] - start[axis]
        voxel[axis] = math.floor(start[axis])
        capacity += abs(math.floor(end[axis]) - voxel[axis])
        if extent > 0:
            step[axis] = 1
            between[axis] = 1.0 / extent
            crossing[axis] = (voxel[axis] + 1 - start[axis]) / extent
        elif extent < 0:
            step[axis] = -1
            between[axis] = -1.0 / extent
            crossing[axis] = (voxel[axis] - start[axis]) / extent
    voxels = np.empty((capacity, 3), np.int64)
    leave = np.empty(capacity)
    count = 0
    reached = 0.0
    while True:
        face = min(1.0, crossing[0], crossing[1], crossing[2])
        if face > 1.0 - SAME_SHARE:
            face = 1.0
        if face > reached or (count == 0 and face == 1.0):
            for axis in range(3):
                voxels[count, axis] = voxel[axis]
            leave[count] = face
            count += 1
        if face == 1.0:
            return voxels[:count], leave[:count]
        reached = face
        for axis in range(3):
            if crossing[axis] <= face + SAME_SHARE:
                voxel[axis] += step[axis]
                crossing[axis] += between[axis]


def voxels_on_polyline(points: np.ndarray, cell: float, origin: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Voxels that the legs between points (N, 3) [m], at least two, pass through, and their length in each [m]."""
    cells = np.ascontiguousarray((points - origin) / cell)
    passed = np.abs(np.diff(cells, axis=0)).sum()
    if passed > MOST_PASSED or np.abs(cells).max() > FARTHEST:
        raise ValueError(
            f"points must lie nearer to the map: they pass through about {passed:.2g} voxels of {cell:g} m, at most "
            f"{MOST_PASSED:,} can be told apart"
        )
    voxels, lengths = [], []
    for n in range(len(points) - 1):
        index, leave = voxels_on_segment(cells[n], cells[n + 1])
        voxels.append(index)
        lengths.append(np.diff(leave, prepend=0.0) * np.linalg.norm(points[n + 1] - points[n]))
    return np.concatenate(voxels), np.concatenate(lengths)


@compiled
def distance_to_obstacle(occupied, clearance, cell, point, exact_within):
    """Distance [cells] from a point (3,) [cells] to the nearest occupied voxel; see `City.distance`.

    `clearance` is that of the voxels' centres [m], `cell` their edge [m], `exact_within` in cells.
    """
    nx, ny, nz = occupied.shape
    x, y, z = point
    i = min(max(math.floor(x), 0), nx - 1)
    j = min(max(math.floor(y), 0), ny - 1)
    k = min(max(math.floor(z), 0), nz - 1)
    off = math.sqrt((x - i - 0.5) ** 2 + (y - j - 0.5) ** 2 + (z - k - 0.5) ** 2)
    from_centre = clearance[i, j, k] / cell
    if from_centre - off >= exact_within:
        return from_centre - off
    least = min(from_centre + off, exact_within)
    for a in range(max(math.floor(x - least), 0), min(math.floor(x + least) + 1, nx)):
        dx = max(a - x, 0.0, x - a - 1)
        for b in range(max(math.floor(y - least), 0), min(math.floor(y + least) + 1, ny)):
            dy = max(b - y, 0.0, y - b - 1)
            left = least * least - dx * dx - dy * dy
            if left <= 0.0:
                continue
            left = math.sqrt(left)
            for c in range(max(math.floor(z - left), 0), min(math.floor(z + left) + 1, nz)):
                if occupied[a, b, c]:
                    dz = max(c - z, 0.0, z - c - 1)
                    least = min(least, math.sqrt(dx * dx + dy * dy + dz * dz))
    return least


@compiled
def distances_to_obstacle(occupied, clearance, cell, points, exact_within):
    distances = np.empty(len(points))
    for n in range(len(points)):
        distances[n] = distance_to_obstacle(occupied, clearance, cell, points[n], exact_within)
    return distances


@compiled
def is_free_line(blocked, start, end):
    """Whether a straight line [cells] touches no blocked voxel, not even an edge or a corner, and stays on the map."""
    if touches_blocked(blocked, start, end, 0.0):
        return False
    voxels, leave = voxels_on_segment(start, end)
    entered = 0.0
    for m in range(len(voxels)):
        i, j, k = voxels[m]
        if not (0 <= i < blocked.shape[0] and 0 <= j < blocked.shape[1] and 0 <= k < blocked.shape[2]):
            return False
        if touches_blocked(blocked, start, end, (entered + leave[m]) / 2) or touches_blocked(
            blocked, start, end, leave[m]
        ):
            return False
        entered = leave[m]
    return True


@compiled
def touches_blocked(blocked, start, end, share):
    """Whether the point at a share of a line lies in a blocked voxel or on its surface, edge or corner."""
    x = start[0] + share * (end[0] - start[0])
    y = start[1] + share * (end[1] - start[1])
    z = start[2] + share * (end[2] - start[2])
    nx, ny, nz = blocked.shape
    for i in range(max(math.floor(x - SURFACE), 0), min(math.floor(x + SURFACE), nx - 1) + 1):
        for j in range(max(math.floor(y - SURFACE), 0), min(math.floor(y + SURFACE), ny - 1) + 1):
            for k in range(max(math.floor(z - SURFACE), 0), min(math.floor(z + SURFACE), nz - 1) + 1):
                if blocked[i, j, k]:
                    return True
    return False
