"""Ant colony on a risk map (RISK-ACO section 3): ants walk from voxel to voxel, and good ways smell stronger.

An ant goes on to a neighbour that turns and climbs little enough and that it hasn't visited, by roulette with weights
τ^α·η^β: the pheromone there, and how promising it looks. As printed η knows only the way left, so the ants don't see
what is to be minimised, and β = 80 sends nearly all of them the same way. Here they also see the risk, and pheromone is
laid for low cost. All weights are logarithms: 30^80 and 0.2^500 are no numbers to multiply.
"""

import math
import time
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.compiled import compiled
from uavlab.planners.grid import BOXES, LENGTHS, blocked_around_node, steps_of
from uavlab.planners.least_risk import (
    MAX_PITCH,
    MAX_TURN,
    MOVE_HEADING,
    NO_HEADING,
    STATES,
    Query,
    checked_length,
    checked_limits,
    city_lengths,
    edge,
    finished,
    flyable_endpoints,
    in_cells,
    price_per_cell,
    priced_by,
    query_of,
    solve,
    state_after,
    what_binds,
)
from uavlab.risk import RiskMap
from uavlab.route import Route

ANTS, PRINTED_ITERATIONS = 10, 50
"""m and NC_max (RISK-ACO Table 3)."""


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


OURS = Habits(alpha=1.0, beta=12.0, gamma=2.0, evaporation=0.1, deposit=1.5, least=0.05, first=15.0, most=15.0)

PRINTED = Habits(alpha=0.5, beta=80.0, gamma=0.0, evaporation=0.8, deposit=100.0, least=0.0, first=15.0, most=15.0)
"""α, β, ρ, Q, τ_min and τ_max (RISK-ACO Table 3). What τ is at first it doesn't say."""


def ant_colony(
    risk_map: RiskMap,
    start: npt.ArrayLike,
    goal: npt.ArrayLike,
    *,
    rng: np.random.Generator | int,
    budget: int = 4000,
    ants: int = ANTS,
    alpha: float = OURS.alpha,
    beta: float = OURS.beta,
    gamma: float = OURS.gamma,
    evaporation: float = OURS.evaporation,
    deposit: float = OURS.deposit,
    pheromone: tuple[float, float, float] = (OURS.least, OURS.first, OURS.most),
    height_guided: bool = True,
    splits: int = 0,
    demand: float | None = None,
    risk: float = 1.0,
    length: float = 0.0,
    threat: float = 0.0,
    max_turn: float = MAX_TURN,
    max_pitch: float = MAX_PITCH,
    max_length: float | None = None,
    min_clearance: float = 0.0,
    min_height: float | None = None,
    max_height: float = np.inf,
    drift: bool = False,
    record: bool = False,
    as_printed: bool = False,
) -> Route:
    """A route of low cost by an ant colony (RISK-ACO Eqs 11-17).

    An ant's weight of a neighbour is τ^α·η^β·C^−γ with η = 1/(d + Δl) and C its price. After each generation
    τ ← (1 − ρ) τ + Δτ, kept within τ_min and τ_max: the best way so far gets Δτ = Q.

    Parameters
    ----------
    risk_map, start, goal, risk, length, threat, max_turn, max_pitch, max_length
        As for `least_risk`, which finds the least cost there is. Ants whose way gets too long give up.
    min_clearance, min_height, max_height, drift
        As for `least_risk`, too.
    rng : numpy.random.Generator or int
        Or a seed for one.
    budget : int
        How many ants walk in all, at least one generation for each split and one more.
    ants : int
        m, in each generation.
    alpha, beta : float
        α and β, weights of pheromone and of nearness, at least 0.
    gamma : float
        γ, weight of the price of a voxel, at least 0; 0 for ants that don't see it.
    evaporation : float
        ρ, between 0 and 1.
    deposit : float
        Q, above 0.
    pheromone : (3,) floats
        τ_min, τ at first, and τ_max. τ_min may be 0, τ_max infinite: no limits.
    height_guided : bool
        With the difference in height to the goal Δl in η (Eq. 12); else η = 1/d (Eq. 11).
    splits : int
        Points at which to split the route (section 3.4), one after the other: the piece with most nodes is split at its
        middle node, and both halves are planned anew; a half stays as it was unless the new one is better. Each split
        takes an equal part of the budget.
    demand : float, optional
        Greatest cost that the route may have: it is split no more once it keeps this (section 4, step 3), and no more
        ants walk; by default it is split as often as said.
    record : bool
        Keep `info["pheromone"]`.
    as_printed : bool
        α = 0.5, β = 80, ρ = 0.8, Q = 100, τ from 0 to 15, γ = 0 in place of these parameters; all ants that arrive
        lay Δτ = Q/L with L their length [m]: the risk enters nowhere, but for which route is kept.

    Returns
    -------
    Route
        `cost` as for `least_risk`; `info["evaluations"]`, how many ants walked; `info["history"]`, the least cost after
        each of them; `info["ants"]`, the cost of each one's own way (after a split: of its piece), infinite if it got
        stuck; `info["iterations"]`, how many had walked at the end of each generation; `info["splits"]` made;
        `info["elapsed"]` [s]. With `record`, `info["pheromone"]`, τ before the first generation and after each of
        those for the whole route, (G + 1, nx, ny, nz). Where no ant arrives `reached` is False, and `reason` says why.

    Raises
    ------
    ValueError
        If start or goal can't be flown from or to, or an argument is out of its range.
    """
    began = time.perf_counter()
    rng = checks.generator("rng", rng)
    checks.flag("as_printed", as_printed)
    habits = PRINTED if as_printed else checked_habits(alpha, beta, gamma, evaporation, deposit, pheromone)
    checks.whole("ants", ants, least=1)
    checks.whole("splits", splits, least=0)
    if demand is not None:
        checks.positive_number("demand", demand)
    checks.whole("budget", budget, least=1)
    least = ants * (splits + 1) * (2 if splits else 1)
    if budget < least:
        raise ValueError(f"budget must be at least {least}, for {ants} ants and {splits} splits, got {budget}")
    limits = checked_limits(risk_map, max_turn, max_pitch, min_clearance, min_height, max_height)
    allowed = checked_length(max_length)
    longest = in_cells(risk_map.city, allowed)
    price = price_per_cell(risk_map, risk, length, threat, drift)
    between = flyable_endpoints(risk_map, start, goal, limits)
    query = query_of(risk_map, price, between.source, between.target, limits)
    if as_printed:
        habits = habits._replace(deposit=habits.deposit / risk_map.city.cell)  # Q/L: L in metres, ants count cells
    colony = Colony(query, habits, height_guided, as_printed, ants, rng)
    half = budget // (splits + 1) // 2
    ends, nothing = np.array([query.source, query.target]), np.empty(0, np.int64)
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
            others = sum(way_length(query, piece) for number, piece in enumerate(pieces) if number != at)
            found = forage(colony, pieces[at], joined(pieces[:at]), joined(pieces[at + 1 :]), half, longest - others)
            saved = way_cost(query, pieces[at], moves_of(query, pieces[at])) - found.costs
            history.append(total - np.maximum(np.maximum.accumulate(saved), 0.0))
            if saved.max() > 0:
                pieces[at], total = found.nodes, float(history[-1][-1])
            searches.append(found)
    walked = np.concatenate([search.costs for search in searches])
    info = {
        "evaluations": len(walked),
        "history": np.concatenate(history),
        "ants": walked,
        "iterations": np.cumsum(np.concatenate([search.walkers for search in searches])),
        "splits": made,
        "elapsed": time.perf_counter() - began,
    }
    if record:
        info["pheromone"] = np.array(searches[0].pheromone).reshape(-1, *risk_map.city.shape)
    city, nodes = risk_map.city, joined(pieces)
    if len(nodes) == 0:
        reason = f"none of {len(walked)} ants arrived from {checks.show(start)} at {checks.show(goal)}: "
        shortest = solve(city_lengths(query), True)[1]
        if shortest == np.inf or shortest > longest:
            reason += f"there is no way; {what_binds(risk_map, query, limits, max_length)}"
        else:
            reason += "each ran into a dead end of voxels it may not turn to, or had visited; more ants may help, or a "
            reason += "larger max_turn" if longest == np.inf else "larger max_turn or max_length"
        return Route(np.empty((0, 3)), "ant colony", reached=False, reason=reason, cost=np.inf, info=info)
    route = Route(city.center_of(city.index_of(nodes)), "ant colony", cost=total, info=info)
    return finished(route, between, price, priced_by(risk, threat, drift), allowed)


def checked_habits(
    alpha: float, beta: float, gamma: float, evaporation: float, deposit: float, pheromone: tuple[float, float, float]
) -> Habits:
    for name, value in (("alpha", alpha), ("beta", beta), ("gamma", gamma)):
        checks.not_negative_number(name, value)
    checks.number("evaporation", evaporation)
    checks.share("evaporation", evaporation)
    checks.positive_number("deposit", deposit)
    levels = checks.numbers("pheromone", pheromone)
    if levels.shape != (3,) or not (0 <= levels[0] <= levels[1] <= levels[2] and 0 < levels[1] < np.inf):
        raise ValueError(f"pheromone must be (τ_min, first, τ_max), in order, first above 0, got {pheromone!r}")
    return Habits(alpha, beta, gamma, evaporation, deposit, *levels.tolist())


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


NO_MOVE = -1
TAKEN = -1


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
    come, go = level_moves(query, before), level_moves(query, after)
    seen = np.zeros(query.blocked.size, np.int64)
    seen[before], seen[after] = TAKEN, TAKEN
    seen[[source, target]] = 0
    look = attraction(query, habits, colony.height_guided)
    ways = np.empty((colony.ants, 4 * sum(query.blocked.shape)), np.int64)
    trail, faded = np.full(query.blocked.size, np.log(habits.first)), 0.0
    best, least = np.empty(0, np.int64), np.inf
    costs, walkers, pheromone = [], [], [smell(trail, faded, habits)] if record else []
    made = 0
    while made < budget:
        count = min(colony.ants, budget - made)
        ends, found, lengths = generation(
            query, trail, log(habits.least) - faded, look, habits.alpha,
            MOVE_HEADING[come[-1]] if len(come) else NO_HEADING, go[0] if len(go) else NO_MOVE,
            seen, made + 1, colony.rng, ways[:count], longest,
        )  # fmt: skip
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
            pheromone.append(smell(trail, faded, habits))
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


def smell(trail: np.ndarray, faded: float, habits: Habits) -> np.ndarray:
    """Pheromone τ of each node."""
    return np.maximum(np.exp(trail + faded), habits.least)


def log(value: float) -> float:
    return math.log(value) if value > 0 else -math.inf


@compiled
def generation(query, trail, least, look, alpha, heading, then, seen, mark, rng, ways, longest):
    """Let ants walk, one row of `ways` each: how many nodes (0 for none that arrive), cost, and length [cells]."""
    ends, costs, lengths = np.zeros(len(ways), np.int64), np.full(len(ways), np.inf), np.zeros(len(ways))
    for ant in range(len(ways)):
        ends[ant], cost, lengths[ant] = walk(
            query, trail, least, look, alpha, heading, then, seen, mark + ant, rng, ways[ant], longest
        )
        if ends[ant] > 0:
            costs[ant] = cost
    return ends, costs, lengths


@compiled
def walk(query, trail, least, look, alpha, heading, then, seen, mark, rng, nodes, longest):
    """One ant's way from source to target, into `nodes`: how many there are (0 in a dead end), cost, length [cells].

    It comes with a heading, and leaves the target with the move `then`. It visits no node that is TAKEN, and none
    twice: `seen` has its mark on those where it was.
    """
    steps = steps_of(query.blocked)
    weights = np.empty(26)
    node = query.source
    nodes[0] = node
    seen[node] = mark
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
            if seen[neighbour] == mark or seen[neighbour] == TAKEN:
                continue
            if neighbour == query.target:
                if then == NO_MOVE or query.turn[state_after(heading, move, neighbour) % STATES, then]:
                    chosen = move
                continue
            weights[move] = alpha * max(trail[neighbour], least) + look[neighbour]
            highest = max(highest, weights[move])
        if chosen == NO_MOVE:
            if highest == -np.inf:
                return 0, np.inf, 0.0
            chosen = roulette(weights, highest, rng)
        neighbour = node + steps[chosen]
        cost += edge(query, chosen, node, neighbour)
        length += LENGTHS[chosen]
        if length > longest:
            return 0, np.inf, 0.0
        heading = state_after(heading, chosen, neighbour) % STATES
        node = neighbour
        nodes[count] = node
        seen[node] = mark
        if node == query.target:
            return count + 1, cost, length
    return 0, np.inf, 0.0


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
