"""What a length is worth: bounds that spare the exact search with a limit most of its labels.

With a multiplier λ ≥ 0, every route within a length ε costs at least min(cost + λ·length) − λ·ε, the minimum being that
over all routes (Lagrangian relaxation). The same holds for the rest of a route: a label of cost c and length l leads
within ε only to routes that cost at least c + λ·l + rest_λ − λ·ε, where rest_λ is the least cost + λ·length from there
to the goal, by one search backwards. Where that is more than a known route within ε costs, the label is of no use. Such
routes are known: those of least cost + λ·length, for one λ after another.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from uavlab.compiled import compiled
from uavlab.planners.grid import steps_of
from uavlab.planners.heap import open_list
from uavlab.planners.risk_question import Query, edge
from uavlab.planners.risk_search import rest_of_cost, solve, solve_knowing

MOST_MULTIPLIERS = 14
"""Each takes a search backwards."""

MOST_LIMITS = 32
"""More limits are taken together, neighbours in groups: bounds that hold for all of a group are wider."""

NARROW = 0.01
"""A bound is good enough when it is nearer than this share to what a known route costs."""

SLACK = 1 + 1e-8
"""More than the rounding of a sum, so that no label of a route that is asked for is lost."""


ROUNDING = 5e-13
"""By this share a route may be longer than a limit: half of what the search allows for."""


class Bounds(NamedTuple):
    """What labels may cost, for each multiplier (M,) and limit (K,); for compiled code."""

    multiplier: np.ndarray  # (M,) λ: cost of a cell of length
    rest: np.ndarray  # (nodes, M) least cost + λ·length to the goal, turns being free
    limit: np.ndarray  # (K,) the greatest lengths; of several that are taken together the greatest
    most: np.ndarray  # (K, M) cost + λ·limit of the cheapest route known to be within a limit
    best: np.ndarray  # (K,) which multiplier tells most


def no_bounds() -> Bounds:
    """Nothing is known, and every label may be of use."""
    return Bounds(np.empty(0), np.empty((0, 0)), np.empty(0), np.empty((0, 0)), np.empty(0, np.int64))


def bounds_of(query: Query, by_length: Query, rest: np.ndarray, limits: np.ndarray) -> tuple[Bounds, int]:
    """Bounds for the routes within limits [cells], from short to long, and how many expansions they took.

    `rest` is the least cost from each node to the goal. The next multiplier is always the slope between the two known
    routes around that limit where most is left between what is known and the bound. The first is so high that
    of the shortest routes the cheapest is known.
    """
    groups = np.array_split(limits, min(len(limits), MOST_LIMITS))
    least, limit = (np.array([group[end] for group in groups]) for end in (0, -1))
    nodes, shortest, expanded = solve(by_length, True)
    cheapest, _, more = solve_knowing(query, rest)
    expanded += more
    if len(nodes) == 0:
        return no_bounds(), expanded
    known = [measured(query, by_length, route) for route in (nodes, cheapest)]
    multipliers, rests = [0.0], [rest]
    summed = query._replace(price=np.empty(np.broadcast_shapes(query.price.shape, by_length.price.shape)))
    steepest = 1e9 * query.price.max() / by_length.price.max()
    multiplier = float(np.clip((known[0][0] - known[1][0]) / (1e-6 * shortest), 0.0, steepest))
    while multiplier >= 0 and len(multipliers) <= MOST_MULTIPLIERS:
        np.add(query.price, multiplier * by_length.price, out=summed.price)
        further, more = rest_of_cost(summed, query.source, open_list(query.blocked.size))
        route, _, most = solve_knowing(summed, further)
        expanded += more + most
        known.append(measured(query, by_length, route))
        multipliers.append(multiplier)
        rests.append(further)
        low = np.array([r[query.source] for r in rests])[:, None] - np.outer(multipliers, limit)
        high = cheapest_within(known, least)
        multiplier = next_multiplier(known, limit, low.max(axis=0), high, multipliers)
    used, best = np.unique(low.argmax(axis=0), return_inverse=True)
    kept = np.array(multipliers)[used]
    allowed = SLACK * (high[:, None] + np.outer(limit, kept))
    allowed[limit < shortest / SLACK] = -np.inf
    return Bounds(kept, np.stack([rests[n] for n in used], axis=1), limit, allowed, best), expanded


def cheapest_within(known: list[tuple[float, float]], limits: np.ndarray) -> np.ndarray:
    """What the cheapest known route within each limit costs (K,), infinite where none is known."""
    costs, lengths = np.transpose(known)
    return np.where(lengths[:, None] <= limits * (1 + ROUNDING), costs[:, None], np.inf).min(axis=0)


def next_multiplier(
    known: list[tuple[float, float]], limits: np.ndarray, low: np.ndarray, high: np.ndarray, tried: list[float]
) -> float:
    """The multiplier that promises most, or −1: bounds are near enough, or all that promise anything were tried."""
    for n in np.argsort(np.where(high < np.inf, low / high, 1.0)):
        if not low[n] < (1 - NARROW) * high[n] < np.inf:
            break
        slope = slope_across(known, limits[n])
        if not np.isclose(slope, tried, rtol=1e-6, atol=0.0).any():
            return slope
    return -1.0


def slope_across(known: list[tuple[float, float]], limit: float) -> float:
    """What length is worth between the two known routes, one on each side of a limit, whose line is lowest there."""
    lines = [
        ((cost - saved) / (longer - length), cost - (cost - saved) / (longer - length) * (limit - length))
        for cost, length in known
        for saved, longer in known
        if length <= limit < longer
    ]
    return max(min(lines, key=lambda line: line[1])[0], 0.0) if lines else 0.0


def measured(query: Query, by_length: Query, nodes: np.ndarray) -> tuple[float, float]:
    """Cost and length of a route, added up from the start as the search does."""
    return cost_along(query, nodes), cost_along(by_length, nodes)


@compiled
def cost_along(query, nodes):
    """Cost of a way through nodes."""
    steps = steps_of(query.blocked)
    cost = 0.0
    for n in range(len(nodes) - 1):
        move = np.flatnonzero(steps == nodes[n + 1] - nodes[n])[0]
        cost += edge(query, move, nodes[n], nodes[n + 1])
    return cost


@compiled
def of_use(bounds, left, node, cost, length, least):
    """Whether a label may lead to a route within one of the first limits; it gets at `least` so long."""
    if len(bounds.limit) == 0:
        return True
    for n in range(left - 1, -1, -1):
        if least > SLACK * bounds.limit[n]:
            return False
        if within(bounds, n, bounds.best[n], node, cost, length):
            for m in range(len(bounds.multiplier)):
                if not within(bounds, n, m, node, cost, length):
                    break
            else:
                return True
    return False


@compiled
def within(bounds, n, m, node, cost, length):
    """Whether it may do so as far as one of the multipliers tells."""
    return cost + bounds.multiplier[m] * length + bounds.rest[node, m] <= bounds.most[n, m]
