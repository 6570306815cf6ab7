"""What the graph planners share: 26 neighbours, which moves are legal, and heuristics.

A node is a voxel, named by its code (`City.code_of`). From it there are 26 moves, to all voxels around it. A move is
legal when every voxel of its bounding box is free: 1 for a straight move, 3 more for a diagonal one, 7 for
one through a corner; so nothing is cut. The voxels around a node fit into one word of 27 bits, and a move is legal
when the word has no bit in common with the bounding box of the move.
"""

from __future__ import annotations

import numpy as np

from uavlab.compiled import compiled

MOVES = np.array([(i, j, k) for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1) if (i, j, k) != (0, 0, 0)])
"""The 26 moves (26, 3) [cells], in the order in which they are tried."""

LENGTHS = np.sqrt((MOVES**2).sum(axis=1))
"""Their lengths [cells]: 1, √2 or √3."""


def bit_of(i: int, j: int, k: int) -> int:
    """The bit of the word of 27 that stands for the voxel at offset (i, j, k), each −1, 0 or 1."""
    return 1 << (9 * (i + 1) + 3 * (j + 1) + (k + 1))


def bounding_box(move: np.ndarray) -> int:
    """The word of 27 bits with those set that the move's bounding box covers, but for the node itself."""
    covered = [sorted({0, int(offset)}) for offset in move]
    word = sum(bit_of(i, j, k) for i in covered[0] for j in covered[1] for k in covered[2])
    return word & ~bit_of(0, 0, 0)


BOXES = np.array([bounding_box(move) for move in MOVES])
"""Voxels that must be free for each move (26,), as words of 27 bits."""

EUCLIDEAN, OCTILE, ZERO = 0, 1, 2
HEURISTICS = {"octile": OCTILE, "euclidean": EUCLIDEAN, "zero": ZERO}
"""Estimates of the way that remains. None is above the true cost, so A* stays exact."""


@compiled
def blocked_around(blocked, i, j, k):
    """The word of 27 bits with those set whose voxels around (i, j, k) are blocked or outside of the map."""
    nx, ny, nz = blocked.shape
    word = 0
    bit = 1
    if 0 < i < nx - 1 and 0 < j < ny - 1 and 0 < k < nz - 1:  # nearly always, and then three voxels at once
        for a in range(i - 1, i + 2):
            for b in range(j - 1, j + 2):
                row = blocked[a, b]
                word |= (row[k - 1] | row[k] << 1 | row[k + 1] << 2) * bit
                bit <<= 3
        return word
    for a in range(i - 1, i + 2):
        for b in range(j - 1, j + 2):
            for c in range(k - 1, k + 2):
                if a < 0 or b < 0 or c < 0 or a >= nx or b >= ny or c >= nz or blocked[a, b, c]:
                    word |= bit
                bit <<= 1
    return word


@compiled
def steps_of(blocked):
    """By how much each move (26,) changes the code of a node."""
    ny, nz = blocked.shape[1], blocked.shape[2]
    return (MOVES[:, 0] * ny + MOVES[:, 1]) * nz + MOVES[:, 2]


@compiled
def blocked_around_node(blocked, node):
    """`blocked_around` a node with this code."""
    ny, nz = blocked.shape[1], blocked.shape[2]
    return blocked_around(blocked, node // (ny * nz), node // nz % ny, node % nz)


@compiled
def distance_left(heuristic, di, dj, dk):
    """Estimate of the way [cells] over (di, dj, dk): straight (Eq. 9), by 26 moves (octile), or nothing."""
    di, dj, dk = abs(di), abs(dj), abs(dk)
    if heuristic == EUCLIDEAN:
        return np.sqrt(di * di + dj * dj + dk * dk)
    if heuristic == OCTILE:  # as many corner moves as the shortest side, then diagonals, then straight ones
        least = min(di, dj, dk)
        most = max(di, dj, dk)
        middle = di + dj + dk - least - most
        return (np.sqrt(3.0) - np.sqrt(2.0)) * least + (np.sqrt(2.0) - 1.0) * middle + most
    return 0.0
