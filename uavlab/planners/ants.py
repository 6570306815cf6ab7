"""How ants walk from voxel to voxel, and where they leave pheromone.

The pheromone is kept as its logarithm, and evaporation, which is the same everywhere, as one number: so that only nodes
that ants walked on are touched.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from uavlab.compiled import compiled
from uavlab.planners.grid import BOXES, LENGTHS, blocked_around_node, steps_of
from uavlab.planners.risk_question import MOVE_HEADING, NO_HEADING, STATES, Query, edge, state_after


class Habits(NamedTuple):
    """How ants choose and what they leave behind."""

    alpha: float
    beta: float
    gamma: float
    evaporation: float
    deposit: float
    least: float
    first: float
    most: float


class Colony(NamedTuple):
    """What stays the same from piece to piece."""

    query: Query
    habits: Habits
    height_guided: bool
    all_lay: bool
    ants: int
    rng: np.random.Generator


class Search(NamedTuple):
    """What came of a search for one piece of the route."""

    nodes: np.ndarray  # of the best way; none if no ant arrived
    cost: float
    costs: np.ndarray  # of all ants' ways
    walkers: list[int]  # how many there were in each generation
    pheromone: list[np.ndarray]


class Found(NamedTuple):
    """What came of all searches, for the whole route and for its pieces."""

    nodes: np.ndarray  # none if no ant arrived
    cost: float
    history: np.ndarray  # least cost of the whole after each ant
    searches: list[Search]
    splits: int  # made


def forage_and_split(
    colony: Colony, budget: int, splits: int, demand: float | None, longest: float, record: bool
) -> Found:
    """Search a route with `budget` ants; split it as often as asked, or until it costs no more than the demand."""
    ends, nothing = np.array([colony.query.source, colony.query.target]), np.empty(0, np.int64)
    half = budget // (splits + 1) // 2
    found = forage(colony, ends, nothing, nothing, budget - 2 * splits * half, longest, record)
    pieces, searches, total = [found.nodes], [found], found.cost
    history = [np.minimum.accumulate(found.costs)]
    made = 0
    while made < splits and not (demand is not None and total <= demand):
        made += 1
        most = max(range(len(pieces)), key=lambda piece: len(pieces[piece]))
        if len(pieces[most]) < 3:  # no route yet, or none that can be split: one more search for the whole
            found = forage(colony, ends, nothing, nothing, 2 * half, longest)
            history.append(np.minimum(np.minimum.accumulate(found.costs), total))
            if found.cost < total:
                pieces, total = [found.nodes], found.cost
            searches.append(found)
            continue
        middle = len(pieces[most]) // 2
        pieces[most : most + 1] = [pieces[most][: middle + 1], pieces[most][middle:]]
        for at in (most, most + 1):
            others = sum(way_length(colony.query, piece) for number, piece in enumerate(pieces) if number != at)
            found = forage(colony, pieces[at], joined(pieces[:at]), joined(pieces[at + 1 :]), half, longest - others)
            saved = way_cost(colony.query, pieces[at], moves_of(colony.query, pieces[at])) - found.costs
            history.append(total - np.maximum(np.maximum.accumulate(saved), 0.0))
            if saved.max() > 0:
                pieces[at], total = found.nodes, float(history[-1][-1])
            searches.append(found)
    return Found(joined(pieces), total, np.concatenate(history), searches, made)


NO_MOVE = -1
TAKEN = -1


class Ground(NamedTuple):
    """What ants of one generation find, for compiled code."""

    query: Query
    trail: np.ndarray  # (nodes,) log τ, but for what evaporated
    least: float  # the least that it counts
    attraction: np.ndarray  # (nodes,) see `attraction`
    alpha: float
    heading: int  # with which ants come to the source
    leaving_move: int  # with which they leave the target, or NO_MOVE
    visited_by: np.ndarray  # (nodes,) the last ant that was there, from 1; TAKEN: the node belongs to another piece
    longest: float  # [cells]


def forage(
    colony: Colony,
    piece: np.ndarray,
    before: np.ndarray,
    after: np.ndarray,
    budget: int,
    longest: float,
    record: bool = False,
) -> Search:
    """Search a way from the first to the last node of a piece, to go between the nodes before and after it.

    No longer than `longest` cells.
    """
    source, target = int(piece[0]), int(piece[-1])
    query, habits = colony.query._replace(source=source, target=target), colony.habits
    arrival, departure = level_moves(query, before), level_moves(query, after)
    visited_by = np.zeros(query.blocked.size, np.int64)
    visited_by[before], visited_by[after] = TAKEN, TAKEN
    visited_by[[source, target]] = 0
    trail, faded = np.full(query.blocked.size, np.log(habits.first)), 0.0
    ground = Ground(
        query, trail, -np.inf, attraction(query, habits, colony.height_guided), float(habits.alpha),
        int(MOVE_HEADING[arrival[-1]]) if len(arrival) else NO_HEADING,
        int(departure[0]) if len(departure) else NO_MOVE, visited_by, float(longest),
    )  # fmt: skip
    ways = np.empty((colony.ants, 4 * sum(query.blocked.shape)), np.int64)
    best, least = np.empty(0, np.int64), np.inf
    costs, walkers, pheromone = [], [], [pheromone_of(trail, faded, habits)] if record else []
    made = 0
    while made < budget:
        count = min(colony.ants, budget - made)
        ground = ground._replace(least=log(habits.least) - faded)
        ends, found, lengths = generation(ground, made + 1, colony.rng, ways[:count])
        made += count
        leader = found.argmin()
        if found[leader] < least:
            best, least = ways[leader, : ends[leader]].copy(), float(found[leader])
        if colony.all_lay:
            laid = [(ways[ant, : ends[ant]], habits.deposit / lengths[ant]) for ant in np.flatnonzero(ends)]
        else:
            laid = [(best, habits.deposit)]
        faded = lay(trail, faded, habits, laid)
        costs.append(found)
        walkers.append(count)
        if record:
            pheromone.append(pheromone_of(trail, faded, habits))
    return Search(best, least, np.concatenate(costs), walkers, pheromone)


def attraction(query: Query, habits: Habits, height_guided: bool) -> np.ndarray:
    """log(η^β·C^−γ) of each node (Eqs 11-13), distances in cells; the goal itself is taken by whoever can reach it."""
    index = np.stack(np.unravel_index(np.arange(query.blocked.size), query.blocked.shape), axis=1)
    away = index - index[query.target]
    left = np.linalg.norm(away, axis=1) + (np.abs(away[:, 2]) if height_guided else 0.0)
    left[query.target] = 1.0
    return -habits.beta * np.log(left) - habits.gamma * np.log(query.price.mean(axis=0))


def lay(trail: np.ndarray, faded: float, habits: Habits, laid: list[tuple[np.ndarray, float]]) -> float:
    """Evaporate, and lay pheromone on ways, in place (Eqs 15-17); what evaporated by now.

    log τ is `trail` + `faded`, but at least log τ_min. What evaporates does so everywhere alike, so it is one
    number, and only nodes that ants walked on are touched.
    """
    least = log(habits.least) - faded
    faded += log(1 - habits.evaporation)
    for nodes, amount in laid:
        more = np.logaddexp(np.maximum(trail[nodes], least), log(amount) - faded)
        trail[nodes] = np.minimum(more, log(habits.most) - faded)
    return faded


def pheromone_of(trail: np.ndarray, faded: float, habits: Habits) -> np.ndarray:
    """Pheromone τ of each node."""
    return np.maximum(np.exp(trail + faded), habits.least)


def log(value: float) -> float:
    return math.log(value) if value > 0 else -math.inf


@compiled
def generation(ground, first, rng, ways):
    """Let ants walk, one row of `ways` each: how many nodes (0 for none that arrive), cost, and length [cells].

    `first` is the number of the first of them.
    """
    ends, costs, lengths = np.zeros(len(ways), np.int64), np.full(len(ways), np.inf), np.zeros(len(ways))
    for ant in range(len(ways)):
        ends[ant], cost, lengths[ant] = walk(ground, first + ant, rng, ways[ant])
        if ends[ant] > 0:
            costs[ant] = cost
    return ends, costs, lengths


@compiled
def walk(ground, ant, rng, nodes):
    """One ant's way from source to target, into `nodes`: how many there are (0 in a dead end), cost, length [cells].

    It visits no node that is TAKEN, and none twice.
    """
    query, visited_by, heading = ground.query, ground.visited_by, ground.heading
    steps = steps_of(query.blocked)
    weights = np.empty(26)
    node = query.source
    nodes[0] = node
    visited_by[node] = ant
    cost = length = 0.0
    for count in range(1, len(nodes)):
        around = blocked_around_node(query.blocked, node)
        highest = -np.inf
        chosen = NO_MOVE
        for move in range(26):
            weights[move] = -np.inf
            if around & BOXES[move] or not query.climb[move] or not query.turn[heading, move]:
                continue
            neighbour = node + steps[move]
            if visited_by[neighbour] == ant or visited_by[neighbour] == TAKEN:
                continue
            if neighbour == query.target:
                if may_leave(ground, state_after(heading, move, neighbour) % STATES):
                    chosen = move
                continue
            weights[move] = ground.alpha * max(ground.trail[neighbour], ground.least) + ground.attraction[neighbour]
            highest = max(highest, weights[move])
        if chosen == NO_MOVE:
            if highest == -np.inf:
                return 0, np.inf, 0.0
            chosen = roulette(weights, highest, rng)
        neighbour = node + steps[chosen]
        cost += edge(query, chosen, node, neighbour)
        length += LENGTHS[chosen]
        if length > ground.longest:
            return 0, np.inf, 0.0
        heading = state_after(heading, chosen, neighbour) % STATES
        node = neighbour
        nodes[count] = node
        visited_by[node] = ant
        if node == query.target:
            return count + 1, cost, length
    return 0, np.inf, 0.0


@compiled
def may_leave(ground, heading):
    """Whether an ant that reaches the target with a heading can go on as the next piece of the route does."""
    return ground.leaving_move == NO_MOVE or ground.query.turn[heading, ground.leaving_move]


@compiled
def roulette(log_weights, highest, rng):
    """An index drawn with probabilities in proportion to the weights (Eq. 14)."""
    total = 0.0
    for i in range(len(log_weights)):
        log_weights[i] = math.exp(log_weights[i] - highest)
        total += log_weights[i]
    left = rng.random() * total
    last = -1
    for i in range(len(log_weights)):
        if log_weights[i] > 0:
            last = i
            left -= log_weights[i]
            if left < 0:
                break
    return last


def moves_of(query: Query, nodes: np.ndarray) -> np.ndarray:
    """The moves (N − 1,) that lead along nodes (N,)."""
    index = np.stack(np.unravel_index(nodes, query.blocked.shape), axis=1)
    code = (np.diff(index, axis=0) + 1) @ (9, 3, 1)
    return code - (code > 13)  # staying is no move


def level_moves(query: Query, nodes: np.ndarray) -> np.ndarray:
    """Those of the moves that have a heading."""
    moves = moves_of(query, nodes)
    return moves[MOVE_HEADING[moves] != NO_HEADING]


@compiled
def way_cost(query, nodes, moves):
    cost = 0.0
    for leg in range(len(moves)):
        cost += edge(query, moves[leg], nodes[leg], nodes[leg + 1])
    return cost


def way_length(query: Query, nodes: np.ndarray) -> float:
    return float(LENGTHS[moves_of(query, nodes)].sum())


def joined(pieces: list[np.ndarray]) -> np.ndarray:
    """Nodes of consecutive pieces, each of which begins where the one before ends."""
    if not pieces:
        return np.empty(0, np.int64)
    return np.concatenate([piece[:-1] for piece in pieces[:-1]] + [pieces[-1]])
