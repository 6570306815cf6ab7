"""An estimate for uneven prices: the least prices of blocks, and ways around these blocks, backwards from the goal.

With weights w of the three axes, 1, √2 − 1 and √3 − √2 in any order, a move over (x, y, z) cells is at least as long as
w₁|x| + w₂|y| + w₃|z|. The corners of blocks make a lattice. Let a step on it along an axis cost its length times the
weight of the axis times the least price of the blocks that it touches, and let H be the least cost of such steps from a
corner to the goal's block. Inside a block H is interpolated between the corners, on all three axes. Its slope along an
axis is then a mean of those of four steps, so at most the weight of the axis times the price of any voxel of the block.
Half of a move lies in each of two voxels, and on each half the estimate changes by no more than that half costs. So it
changes along a move by no more than the move costs (it is consistent); it is 0 at the goal, and hence never above the
true cost: A* stays exact. The greatest of several such estimates, one for each order of the weights, and all of them
cut off at one value, have these properties, too.
"""

from __future__ import annotations

from itertools import permutations
from typing import NamedTuple

import numpy as np

from uavlab.compiled import compiled
from uavlab.planners.grid import OCTILE, distance_left
from uavlab.planners.heap import open_list, pop, push, sparse_array

BLOCK = 4
"""Edge of a block [cells]. Smaller ones tell more and take longer; 3 to 5 are equally fast."""

WEIGHTS = np.array(list(permutations(np.sqrt([1.0, 2.0, 3.0]) - np.sqrt([0.0, 1.0, 2.0]))))
"""Of the axes, in each order (6, 3): which one tells most depends on the direction of the way."""

BEYOND = 1.05
"""Corners are of interest as far as the start, and some more, as a search looks behind its start, too."""

UNEVEN = 1.5
"""Of the cheapest price: where the cheapest tenth of a map costs more than that, blocks tell more than distances."""

GOLDEN = (5**0.5 - 1) / 2
SAMPLE = 2_000
"""Voxels that are looked at to tell so."""


WALL = 100.0
"""Price of a block without a free voxel, in greatest prices: any will do, as no move crosses it, and a high one tells
that ways lead around it."""


class Coarse(NamedTuple):
    """The estimate, for compiled code."""

    corner: np.ndarray  # (6, blocks + 1 along each axis) H by each order of the weights
    telling: np.ndarray  # (blocks along each axis) uint8: which of them may be the greatest in a block, as bits
    left: np.ndarray  # (nodes,) what was estimated, for nodes that were seen
    cheapest: float  # price per cell
    goal: tuple[int, int, int]


def is_uneven(price: np.ndarray, cheapest: float) -> bool:
    """Whether nearly every voxel costs much more than the cheapest."""
    everywhere = np.arange(SAMPLE) * GOLDEN % 1  # evenly, and in step with no axis
    sample = price.reshape(-1)[(everywhere * price.size).astype(int)]
    tenth = len(sample) // 10
    return bool(np.partition(sample, tenth)[tenth] > UNEVEN * cheapest)


def coarse_estimate(blocked: np.ndarray, price: np.ndarray, cheapest: float, start: int, goal: int) -> Coarse:
    """The estimate of the cost [cells × price] to a goal, for a search that begins at a node."""
    first, last = (np.array(np.unravel_index(node, blocked.shape)) for node in (start, goal))
    steps = prices_of_steps(least_prices(blocked, price, WALL * price.max()))
    size = steps[0].size
    corner = np.stack([
        costs_of_corners(steps, BLOCK * weights, first // BLOCK, last // BLOCK, open_list(size)) for weights in WEIGHTS
    ])  # fmt: skip
    left = sparse_array(np.empty, blocked.size, np.float64)
    return Coarse(corner, greatest_in_blocks(corner), left, cheapest, (int(last[0]), int(last[1]), int(last[2])))


@compiled
def least_prices(blocked, price, without):
    """The least price among the free voxels of each block; one for blocks without any."""
    nx, ny, nz = blocked.shape
    least = np.full(((nx - 1) // BLOCK + 1, (ny - 1) // BLOCK + 1, (nz - 1) // BLOCK + 1), without)
    for i in range(nx):
        for j in range(ny):
            closed, paid, row = blocked[i, j], price[i, j], least[i // BLOCK, j // BLOCK]
            for block in range(len(row)):
                for k in range(block * BLOCK, min(block * BLOCK + BLOCK, nz)):
                    if not closed[k] and paid[k] < row[block]:
                        row[block] = paid[k]
    return least


@compiled
def prices_of_steps(least):
    """Price of the step along each axis (3,) from each corner: the least of the up to four blocks that it touches."""
    nx, ny, nz = least.shape
    price = np.full((3, nx + 1, ny + 1, nz + 1), np.inf)
    for i in range(nx):
        for j in range(ny):
            for k in range(nz):
                for a in range(2):
                    for b in range(2):
                        price[0, i, j + a, k + b] = min(price[0, i, j + a, k + b], least[i, j, k])
                        price[1, i + a, j, k + b] = min(price[1, i + a, j, k + b], least[i, j, k])
                        price[2, i + a, j + b, k] = min(price[2, i + a, j + b, k], least[i, j, k])
    return price


@compiled
def costs_of_corners(steps, weights, start, goal, waiting):
    """Least cost from each corner to the goal's block, cut off behind the start's: Dijkstra along the axes."""
    nx, ny, nz = steps[0].shape
    prices, strides = steps.reshape(3, -1), np.array([ny * nz, nz, 1])
    cost = np.full(nx * ny * nz, np.inf)
    ends = np.array([nx - 1, ny - 1, nz - 1])
    missing, most = 8, np.inf  # corners of the start's block
    for node in corners_of(goal, strides):
        cost[node] = 0.0
        push(waiting, node, 0.0)
    while waiting.size[0] > 0:
        node = pop(waiting)
        if cost[node] >= most:
            break
        at = (node // (ny * nz), node // nz % ny, node % nz)
        if 0 <= at[0] - start[0] <= 1 and 0 <= at[1] - start[1] <= 1 and 0 <= at[2] - start[2] <= 1:
            missing -= 1
            if missing == 0:
                most = BEYOND * cost[node]
        for axis in range(3):
            for ahead in range(2):
                if at[axis] == ends[axis] * ahead:
                    continue
                other = node + strides[axis] * (2 * ahead - 1)
                reached = cost[node] + weights[axis] * prices[axis, min(node, other)]
                if reached < cost[other]:
                    cost[other] = reached
                    push(waiting, other, reached)
    return np.minimum(cost, most).reshape(nx, ny, nz)


@compiled
def corners_of(block, strides):
    """The codes of its eight corners."""
    corners = np.empty(8, np.int64)
    for n in range(8):
        corners[n] = ((block + np.array([n >> 2, n >> 1 & 1, n & 1])) * strides).sum()
    return corners


@compiled
def greatest_in_blocks(corner):
    """Which of the estimates may be the greatest somewhere in each block: all but those below another everywhere."""
    orders, nx, ny, nz = corner.shape
    telling = np.zeros((nx - 1, ny - 1, nz - 1), np.uint8)
    for i in range(nx - 1):
        for j in range(ny - 1):
            for k in range(nz - 1):
                here = corner[:, i : i + 2, j : j + 2, k : k + 2]
                for one in range(orders):
                    for other in range(orders):
                        if other != one and is_below(here[one], here[other], other < one):
                            break
                    else:
                        telling[i, j, k] |= 1 << one
    return telling


@compiled
def is_below(one, other, or_equal):
    """Whether an estimate is nowhere in a block above another: at no corner, as both are interpolated."""
    equal = True
    for a in range(2):
        for b in range(2):
            for c in range(2):
                if one[a, b, c] > other[a, b, c]:
                    return False
                equal &= one[a, b, c] == other[a, b, c]
    return or_equal or not equal


@compiled
def estimated(coarse, i, j, k):
    """The greatest of the estimates at a voxel, or the distance at the cheapest price."""
    goal = coarse.goal
    left = coarse.cheapest * distance_left(OCTILE, goal[0] - i, goal[1] - j, goal[2] - k)
    telling = coarse.telling[i // BLOCK, j // BLOCK, k // BLOCK]
    for order in range(len(coarse.corner)):
        if telling >> order & 1:
            left = max(left, interpolated(coarse.corner[order], i, j, k))
    return left


@compiled
def interpolated(corner, i, j, k):
    """At the centre of a voxel, between the corners of its block."""
    a, b, c = i // BLOCK, j // BLOCK, k // BLOCK
    x, y, z = (i % BLOCK + 0.5) / BLOCK, (j % BLOCK + 0.5) / BLOCK, (k % BLOCK + 0.5) / BLOCK
    low = (1 - y) * between(corner[a, b], c, z) + y * between(corner[a, b + 1], c, z)
    high = (1 - y) * between(corner[a + 1, b], c, z) + y * between(corner[a + 1, b + 1], c, z)
    return (1 - x) * low + x * high


@compiled
def between(row, n, share):
    """Between two corners in a row."""
    return (1 - share) * row[n] + share * row[n + 1]
