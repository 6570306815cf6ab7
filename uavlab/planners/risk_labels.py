"""The exact search with a limit on the length too: a state may then be reached in several ways that are worth keeping.

Each way to a state, cheaper or shorter than the others, is a label. Their number grows with the map, to many millions
where the risk depends on the direction of flight. A search that needs many begins anew, with bounds that tell which of
them can't lead to any route that is asked for (`multipliers`). They change neither the answers nor their order.
"""

from __future__ import annotations

import heapq
from typing import NamedTuple

import numpy as np

from uavlab.compiled import compiled
from uavlab.planners.astar import COST_ROUNDING
from uavlab.planners.grid import BOXES, blocked_around_node, steps_of
from uavlab.planners.heap import open_list
from uavlab.planners.multipliers import bounds_of, no_bounds, of_use
from uavlab.planners.risk_question import LEAST_PRICE, NO_HEADING, STATES, Query, city_lengths, edge, state_after
from uavlab.planners.risk_search import NOWHERE, rest_of_cost

PATIENCE = 250_000
"""Labels after which bounds are worth their time: a tenth of a second."""


def costs_nothing(query: Query, nodes: np.ndarray) -> bool:
    """Whether a route passes nodes that cost no more than the least there is, `LEAST_PRICE`."""
    return bool((query.price[:, nodes] <= 1.001 * LEAST_PRICE * query.price.max()).any())


def shortest_of_cheapest(query: Query, cost: float) -> tuple[np.ndarray, int]:
    """Nodes of the shortest of all routes of this least cost, to rounding, and how many expansions it took.

    Where nobody is at risk the lengths of ways would drown in the sum of costs.
    """
    routes, expanded = constrained(city_lengths(query), query, np.array([cost]))
    return routes[0][0], expanded


def constrained(query: Query, by_length: Query, limits: np.ndarray) -> tuple[list[tuple[np.ndarray, float]], int]:
    """For each greatest length [cells] the nodes and the cost of the cheapest route, shortest first, each once.

    `by_length` is what is limited; anything that adds up may be.
    """
    count = query.blocked.size
    rest, expanded = rest_of_cost(query, NOWHERE, open_list(count))
    rest_length, more = rest_of_cost(by_length, NOWHERE, open_list(count))
    expanded += more
    bounds = no_bounds()
    labels = search_labels(query, by_length, rest, rest_length, limits, bounds, PATIENCE)
    if not labels.ended:
        bounds, more = bounds_of(query, by_length, rest, limits)
        expanded += len(labels.state) + more
        labels = search_labels(query, by_length, rest, rest_length, limits, bounds, np.inf)
    routes = [(nodes_of(labels, label), float(labels.cost[label])) for label in labels.found[::-1]]
    return routes, expanded + len(labels.state)


def nodes_of(labels: Labels, label: int) -> np.ndarray:
    """The way that a label stands for, from the start on."""
    nodes = []
    while label >= 0:
        nodes.append(labels.state[label] // STATES)
        label = labels.parent[label]
    return np.array(nodes[::-1])


class Labels(NamedTuple):
    """What a search found."""

    state: np.ndarray  # (labels,)
    parent: np.ndarray  # (labels,) the label before
    cost: np.ndarray  # (labels,)
    found: np.ndarray  # those at the goal that are answers, longest first
    ended: bool  # False if it was given up


@compiled
def search_labels(query, by_length, rest, rest_length, limits, bounds, patience):
    """Cheapest routes not longer than each of the limits [cells], by labels: ways to a state, cheaper or shorter.

    Labels are expanded in order of cost + rest. Of two at one state the later one costs more, so it is worth
    keeping only if it is shorter. The first label at the goal is the cheapest route within the largest limit; from
    then on only shorter ones are of interest, for the next smaller limit. It is given up after so many labels.
    """
    steps = steps_of(query.blocked)
    shortest = np.full(query.blocked.size * STATES, np.inf)  # of the labels expanded at each state
    states, parent, costs, lengths = [query.source * STATES + NO_HEADING], [-1], [0.0], [0.0]
    limit, left = limits[-1] / COST_ROUNDING, len(bounds.limit)
    found, waiting = [-1], [(rest[query.source], rest_length[query.source], 0)]
    while len(waiting) > 0 and len(states) <= patience:
        _, least, label = heapq.heappop(waiting)
        state, length = states[label], lengths[label]
        node, heading = state // STATES, state % STATES
        if least > limit or length >= shortest[state] * COST_ROUNDING:
            continue
        if not of_use(bounds, left, node, costs[label], length, least):  # no more, as the longest answer is found
            continue
        shortest[state] = length
        if node == query.target:
            found.append(label)
            shorter = limits[limits < length * COST_ROUNDING]
            if len(shorter) == 0:
                break
            limit, left = shorter[-1] / COST_ROUNDING, np.searchsorted(bounds.limit, shorter[-1]) + 1
            continue
        around = blocked_around_node(query.blocked, node)
        for move in range(26):
            if around & BOXES[move] or not query.climb[move] or not query.turn[heading, move]:
                continue
            neighbour = node + steps[move]
            follower = state_after(heading, move, neighbour)
            way = length + edge(by_length, move, node, neighbour)
            least = way + rest_length[neighbour]
            if least > limit or way >= shortest[follower] * COST_ROUNDING:
                continue
            cost = costs[label] + edge(query, move, node, neighbour)
            if not of_use(bounds, left, neighbour, cost, way, least):
                continue
            states.append(follower)
            parent.append(label)
            costs.append(cost)
            lengths.append(way)
            heapq.heappush(waiting, (cost + rest[neighbour], least, len(states) - 1))
    return Labels(np.array(states), np.array(parent), np.array(costs), np.array(found[1:]), len(states) <= patience)
