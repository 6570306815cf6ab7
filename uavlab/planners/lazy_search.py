"""A* on a map that doesn't fit into memory: voxels and nodes are there only where the search looks.

Where a route may not be is kept as bits, in blocks of columns that are made when the search comes to them. Nodes are
handed out in bricks; a node is its place among them, so that the open list is that of every other planner.

In a large city A* looks at few nodes if the goal is easy to come to, and at millions if it lies in a courtyard. So two
searches begin, from either end, and take turns; see `uavlab.planners.both_ends`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from uavlab.compiled import compiled
from uavlab.planners.astar import COST_ROUNDING, START, UNSEEN
from uavlab.planners.grid import BOXES, LENGTHS, MOVES, distance_left
from uavlab.planners.heap import pop, push

BLOCK, BRICK = 64, 8
"""Edges of a block of columns and of a brick of nodes [voxels]."""

BLOCK_BITS, BRICK_BITS = 6, 3
IN_BLOCK, WITHIN = BLOCK - 1, BRICK - 1
"""Powers of two, so that >> and & count: a division for each neighbour takes a third of the time of a search."""

IN_BRICK = BRICK**3

ARRIVED, EXHAUSTED, MISSING, FULL, SPENT, MET = range(6)
"""Why a search paused: it arrived, there is nothing left, a block must be made, memory or its turn is over, and no
better way is left than the best through a node that both searches know."""


class Blocks(NamedTuple):
    """Where a route may not be, in blocks of columns with one more column on each side."""

    number: np.ndarray  # (blocks along x, along y) int32: its place in `bits`, 0 if it isn't made yet
    bits: np.ndarray  # (blocks + 1, BLOCK + 2, BLOCK + 2, words) uint64: bit k + 1 of a column is voxel k
    missing: np.ndarray  # (2,) int: the block that the search needs


class Tree(NamedTuple):
    """What a search knows of the nodes that it came to."""

    brick: np.ndarray  # (bricks along x, y, z) int32: which brick of nodes lies there, 0 if none does
    corner: np.ndarray  # (bricks, 3) int32: where that is [bricks]
    g: np.ndarray  # (nodes,) cost so far [cells]
    parent: np.ndarray  # (nodes,) uint8: as in `uavlab.planners.astar`
    used: np.ndarray  # (1,) int: bricks, without brick 0, which is nobody's


class Aim(NamedTuple):
    """Where a search is going, and its estimate of the rest: the greatest of a distance and of planes."""

    goal: np.ndarray  # (3,) int
    heuristic: int
    weight: float
    slope: np.ndarray  # (P, 3): of each plane, which is 0 at the end of the search
    offset: np.ndarray  # (P,) by which it is higher [cells]
    end: np.ndarray  # (3,) int: the end of the search, from which the other one begins


@compiled
def node_at(tree, i, j, k):
    """The node of a voxel, in a new brick if need be."""
    a, b, c = i >> BRICK_BITS, j >> BRICK_BITS, k >> BRICK_BITS
    brick = tree.brick[a, b, c]
    if brick == 0:
        tree.used[0] += 1
        brick = tree.used[0]
        tree.brick[a, b, c] = brick
        tree.corner[brick, 0], tree.corner[brick, 1], tree.corner[brick, 2] = a, b, c
    return brick * IN_BRICK + place_in_brick(i, j, k)


@compiled
def place_in_brick(i, j, k):
    return ((i & WITHIN) << 2 * BRICK_BITS) + ((j & WITHIN) << BRICK_BITS) + (k & WITHIN)


@compiled
def voxel_of(tree, node):
    """The voxel (i, j, k) of a node."""
    brick = node >> 3 * BRICK_BITS
    i = (tree.corner[brick, 0] << BRICK_BITS) + (node >> 2 * BRICK_BITS & WITHIN)
    j = (tree.corner[brick, 1] << BRICK_BITS) + (node >> BRICK_BITS & WITHIN)
    return i, j, (tree.corner[brick, 2] << BRICK_BITS) + (node & WITHIN)


@compiled
def cost_at(tree, i, j, k):
    """What it costs to come to a voxel, as far as a search knows; infinite if it doesn't."""
    brick = tree.brick[i >> BRICK_BITS, j >> BRICK_BITS, k >> BRICK_BITS]
    node = brick * IN_BRICK + place_in_brick(i, j, k)
    return tree.g[node] if brick > 0 and tree.parent[node] != UNSEEN else np.inf


@compiled
def estimate(aim, i, j, k):
    """The rest of the way [cells]; a little more, so that of equal ways the one with less left is tried first."""
    rest = distance_left(aim.heuristic, aim.goal[0] - i, aim.goal[1] - j, aim.goal[2] - k)
    di, dj, dk = i - aim.end[0], j - aim.end[1], k - aim.end[2]
    for n in range(len(aim.offset)):
        rest = max(rest, aim.slope[n, 0] * di + aim.slope[n, 1] * dj + aim.slope[n, 2] * dk + aim.offset[n])
    return aim.weight * rest


@compiled
def around_in(bits, a, b, k):
    """The word of 27 bits of the voxels around voxel k of column (a, b) of a block; see `blocked_around`."""
    word, bit = np.int64(0), 1
    first, shift = k >> 6, np.uint64(k & 63)
    over = np.uint64(64) - shift
    for i in range(a, a + 3):
        for j in range(b, b + 3):
            three = bits[i, j, first] >> shift
            if (k & 63) > 61:
                three |= bits[i, j, first + 1] << over
            word |= np.int64(three & np.uint64(7)) * bit
            bit <<= 3
    return word


@compiled
def search_on(tree, waiting, blocks, aim, other, best, turn):
    """Expand up to `turn` nodes in the order of g + estimate; why it paused, and how many were expanded.

    `other` is the tree of the search from the other end. `best` (4,) is the least cost through a node that both know,
    and its voxel.
    """
    room = len(tree.corner) - 27
    goal_i, goal_j, goal_k = aim.goal
    expanded = 0
    while waiting.size[0] > 0:
        node = waiting.node[1]
        i, j, k = voxel_of(tree, node)
        if waiting.key[1] >= best[0]:
            return MET, expanded
        if i == goal_i and j == goal_j and k == goal_k:
            return ARRIVED, expanded
        if expanded == turn:
            return SPENT, expanded
        if tree.used[0] >= room:
            return FULL, expanded
        number = blocks.number[i >> BLOCK_BITS, j >> BLOCK_BITS]
        if number == 0:
            blocks.missing[0], blocks.missing[1] = i >> BLOCK_BITS, j >> BLOCK_BITS
            return MISSING, expanded
        pop(waiting)
        expanded += 1
        so_far = tree.g[node]
        whole = so_far + cost_at(other, i, j, k)
        if whole < best[0]:
            best[0], best[1], best[2], best[3] = whole, i, j, k
        around = around_in(blocks.bits[number], i & IN_BLOCK, j & IN_BLOCK, k)
        for move in range(26):
            if around & BOXES[move]:
                continue
            di, dj, dk = MOVES[move]
            neighbour = node_at(tree, i + di, j + dj, k + dk)
            cost = so_far + LENGTHS[move]
            if tree.parent[neighbour] == UNSEEN or cost < tree.g[neighbour] * COST_ROUNDING:
                tree.g[neighbour] = cost
                tree.parent[neighbour] = move + 1
                push(waiting, neighbour, cost + estimate(aim, i + di, j + dj, k + dk))
    return EXHAUSTED, expanded


@compiled
def begin_at(tree, waiting, i, j, k):
    """Begin a search at a voxel."""
    node = node_at(tree, i, j, k)
    tree.g[node] = 0.0
    tree.parent[node] = START
    push(waiting, node, 0.0)


@compiled
def aim_anew(tree, waiting, aim):
    """Order the open list by another estimate; nodes that are closed stay so, as their costs are exact."""
    nodes = waiting.node[1 : waiting.size[0] + 1].copy()
    waiting.size[0] = 0
    for node in nodes:
        waiting.slot[node] = 0
    for node in nodes:
        i, j, k = voxel_of(tree, node)
        push(waiting, node, tree.g[node] + estimate(aim, i, j, k))


@compiled
def offsets_of(tree, waiting, begin, slopes):
    """How much higher than planes (P, 3) through its begin the cost is wherever a search could still go, (P,) [cells].

    Every way to its begin passes a node that waits, and from there on costs what that node says.
    """
    offset = np.full(len(slopes), np.inf)
    for slot in range(1, waiting.size[0] + 1):
        node = waiting.node[slot]
        i, j, k = voxel_of(tree, node)
        for n in range(len(slopes)):
            along = slopes[n, 0] * (i - begin[0]) + slopes[n, 1] * (j - begin[1]) + slopes[n, 2] * (k - begin[2])
            offset[n] = min(offset[n], tree.g[node] - along)
    return offset


@compiled
def way_to(tree, i, j, k):
    """Voxels (N, 3) from where a search began to one that it knows."""
    count = 0
    way = np.empty((1024, 3), np.int64)
    while True:
        if count == len(way):
            way = np.concatenate((way, np.empty_like(way)))
        way[count, 0], way[count, 1], way[count, 2] = i, j, k
        count += 1
        parent = tree.parent[node_at(tree, i, j, k)]
        if parent == START:
            return way[:count][::-1].copy()
        di, dj, dk = MOVES[parent - 1]
        i, j, k = i - di, j - dj, k - dk
