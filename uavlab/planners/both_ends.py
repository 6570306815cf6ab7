"""The cheapest route on a lazy city, by two searches that take turns, each with what the other knows.

A* from one end has no idea of a courtyard at the other. The search that begins there leaves it after few nodes; its
open list then tells the first one how much more than the straight estimate the rest will cost (perimeter search:
Dillenburg and Nelson 1994). The octile distance is the greatest of 48 planes; to each of them the least excess over
all nodes that wait is added. That is never too high, so the route is a cheapest one. To find it soon, a search first
aims at the middle of the other's way: if both together cost no more than what any route must, that is a cheapest one.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import permutations, product
from typing import NamedTuple

import numpy as np

from uavlab.city.lazy import LazyCity
from uavlab.city.near import bits_of
from uavlab.planners.astar import TIE_BREAK, no_way
from uavlab.planners.grid import HEURISTICS
from uavlab.planners.heap import OpenList, open_list, sparse_array
from uavlab.planners.lazy_search import (
    ARRIVED,
    BLOCK,
    BRICK,
    EXHAUSTED,
    FULL,
    IN_BRICK,
    MET,
    MISSING,
    Aim,
    Blocks,
    Tree,
    aim_anew,
    begin_at,
    cost_at,
    offsets_of,
    search_on,
    voxel_of,
    way_to,
)
from uavlab.planners.question import Airspace, blocked_columns
from uavlab.route import Route

FIRST_TURN = 20_000
"""So many nodes a search expands before it is the other's turn."""

MOST_NODES = 1 << 24
"""Room for so many nodes has each search; both together then take about 0.9 GB."""

MOST_BLOCKS = 8192
"""Room for so many blocks: 0.6 GB on a map of 120 voxels in height."""

GROWTH = 3
"""And so many times as many in the next turn."""

PLANES = 8
"""So many planes are asked for an estimate: those that are highest at the begin."""

SLOPES = np.array(
    [
        [sign * size for sign, size in zip(signs, sizes, strict=True)]
        for sizes in permutations((1.0, np.sqrt(2.0) - 1.0, np.sqrt(3.0) - np.sqrt(2.0)))
        for signs in product((1, -1), repeat=3)
    ]
)
"""The planes (48, 3) of which the octile distance is the greatest."""

NO_PLANES = np.empty((0, 3)), np.empty(0)


class Side(NamedTuple):
    """A search from one end to the other."""

    begin: np.ndarray  # (3,) int
    end: np.ndarray
    tree: Tree
    waiting: OpenList
    planes: list[tuple[np.ndarray, np.ndarray]]  # one, the estimate that the other search gave last
    proven: np.ndarray  # (1,) what any route costs at least [cells]
    expanded: np.ndarray  # (1,) int
    full: np.ndarray  # (1,) bool: whether it has no room left


class Question(NamedTuple):
    """What both searches share."""

    airspace: Airspace
    blocks: Blocks
    heuristic: int
    best: np.ndarray  # (4,) cost [cells] of the best way through a voxel that both know, and the voxel


def route_on_lazy(airspace: Airspace, source: int, target: int, heuristic: str) -> Route:
    """A cheapest route between two voxels of a lazy city."""
    city = airspace.city
    start, goal = city.index_of([source, target])
    blocks, best = no_blocks(city.shape), np.array([np.inf, -1.0, -1.0, -1.0])
    question = Question(airspace, blocks, HEURISTICS[heuristic], best)
    back, forth = side_of(city.shape, goal, start), side_of(city.shape, start, goal)
    outcome, turn = "", FIRST_TURN
    while not outcome:
        outcome = take_turn(question, back, forth, turn) or take_turn(question, forth, back, turn)
        if not outcome and back.full[0] and forth.full[0]:
            outcome = "full"
        turn *= GROWTH
    expanded = int(back.expanded[0] + forth.expanded[0])
    info = {"expanded": expanded, "heuristic": heuristic, "blocks": int(np.count_nonzero(blocks.number))}
    if outcome == "full":
        reason = gave_up(expanded, best[0] * city.cell, max(back.proven[0], forth.proven[0]) * city.cell)
        return Route.none("A*", reason, goal=city.center_of(goal), **info)
    if best[0] == np.inf:
        nowhere = no_way(city, source, target, expanded)
        return replace(nowhere, info=nowhere.info | info)
    i, j, k = best[1:].astype(np.int64)
    way = np.concatenate([way_to(forth.tree, i, j, k), way_to(back.tree, i, j, k)[-2::-1]])
    return Route(city.center_of(way), "A*", cost=float(best[0]) * city.cell, info=info)


def gave_up(expanded: int, known: float, proven: float) -> str:
    """Words for a search that ran out of memory; costs [m] of a route that is known and of what is proven."""
    way = f"a route of {known:.1f} m is known, but not proven to be cheapest" if known < np.inf else "no route is known"
    return (
        f"{way} after {expanded:,} voxels, for which there is memory; the cheapest has at least {proven:.1f} m: ask "
        "for a greater max_height or less min_clearance, or take city.part(...)"
    )


def take_turn(question: Question, one: Side, other: Side, turn: int) -> str:
    """One search goes on, the other then tries to meet it in the middle; "" while nothing is proven."""
    aim = aim_of(question, one)
    why = go_on(question, one, other, aim, turn)
    if why == ARRIVED:
        meet(question, one, other, one.end)
    if why in (ARRIVED, MET, EXHAUSTED):
        return "found"
    one.proven[0] = max(one.proven[0], one.waiting.key[1])
    offset = offsets_of(one.tree, one.waiting, one.begin, SLOPES)
    highest = np.argsort(-(SLOPES @ (one.end - one.begin) + offset))[:PLANES]
    other.planes[0] = SLOPES[highest], offset[highest]
    way = way_to(one.tree, *voxel_of(one.tree, one.waiting.node[1]))
    there = np.linalg.norm(way - one.begin, axis=1) - np.linalg.norm(one.end - one.begin) / 2
    middle = way[np.argmin(np.abs(there))]
    towards = aim._replace(goal=middle, slope=NO_PLANES[0], offset=NO_PLANES[1])
    aim_anew(other.tree, other.waiting, towards)
    why = go_on(question, other, one, towards, turn)
    if why == ARRIVED:
        meet(question, other, one, middle)
    if why == EXHAUSTED:
        return "found"
    aim_anew(other.tree, other.waiting, aim_of(question, other))
    other.proven[0] = max(other.proven[0], other.waiting.key[1])
    return "found" if question.best[0] <= max(one.proven[0], other.proven[0]) else ""


def aim_of(question: Question, side: Side) -> Aim:
    """To the other end, with the estimate that the search from there has given."""
    return Aim(side.end, question.heuristic, TIE_BREAK, *side.planes[0], side.end)


def meet(question: Question, one: Side, other: Side, voxel: np.ndarray) -> None:
    """Remember the way through a voxel that both searches know, if it is the best."""
    cost = cost_at(one.tree, *voxel) + cost_at(other.tree, *voxel)
    if cost < question.best[0]:
        question.best[:] = cost, *voxel


def go_on(question: Question, side: Side, other: Side, aim: Aim, turn: int) -> int:
    """Search on, and make the blocks that the search comes to."""
    blocks = question.blocks
    while True:
        why, expanded = search_on(side.tree, side.waiting, blocks, aim, other.tree, question.best, turn)
        side.expanded[0] += expanded
        turn -= expanded
        if why != MISSING or not make_block(question):
            side.full[0] = why in (FULL, MISSING)
            return int(why)


def make_block(question: Question) -> bool:
    """Make the block that is missing; False where there is no room for it."""
    (a, b), blocks, airspace = question.blocks.missing.tolist(), question.blocks, question.airspace
    city = airspace.city
    assert isinstance(city, LazyCity)
    made = int(blocks.number.max())
    if made + 1 == len(blocks.bits):
        return False
    low = max(a * BLOCK - 1, 0), max(b * BLOCK - 1, 0)
    count = (
        min((a + 1) * BLOCK + 1, city.shape[0]) - low[0],
        min((b + 1) * BLOCK + 1, city.shape[1]) - low[1],
    )
    blocked = np.ones((BLOCK + 2, BLOCK + 2, city.shape[2] + 2), dtype=bool)  # so is what lies off the map
    i, j = low[0] - (a * BLOCK - 1), low[1] - (b * BLOCK - 1)
    blocked[i : i + count[0], j : j + count[1], 1:-1] = blocked_columns(airspace, city, np.array(low), count)
    blocks.bits[made + 1] = bits_of(blocked)
    blocks.number[a, b] = made + 1
    return True


def no_blocks(shape: tuple[int, int, int]) -> Blocks:
    """Room for blocks of a map, none of them made."""
    blocks = -(-shape[0] // BLOCK), -(-shape[1] // BLOCK)
    room = min(blocks[0] * blocks[1], MOST_BLOCKS) + 1, BLOCK + 2, BLOCK + 2, -(-(shape[2] + 2) // 64)
    bits = sparse_array(np.zeros, int(np.prod(room)), np.uint64).reshape(room)
    return Blocks(np.zeros(blocks, np.int32), bits, np.zeros(2, np.int64))


def side_of(shape: tuple[int, int, int], begin: np.ndarray, end: np.ndarray) -> Side:
    """A search that knows its begin alone."""
    bricks = tuple(-(-count // BRICK) for count in shape)
    room = min(int(np.prod(bricks)), MOST_NODES // IN_BRICK) + 28  # nobody's, and those around a last node
    nodes = room * IN_BRICK
    tree = Tree(
        sparse_array(np.zeros, int(np.prod(bricks)), np.int32).reshape(bricks),
        np.zeros((room, 3), np.int32),
        sparse_array(np.empty, nodes, np.float64),
        sparse_array(np.zeros, nodes, np.uint8),
        np.zeros(1, np.int64),
    )
    waiting = open_list(nodes)
    begin_at(tree, waiting, *begin)
    return Side(begin, end, tree, waiting, [NO_PLANES], np.zeros(1), np.zeros(1, np.int64), np.zeros(1, bool))
