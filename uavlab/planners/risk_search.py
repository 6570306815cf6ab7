"""The exact search on a risk map: nodes without headings backwards, states with headings forwards, labels with lengths.

First a Dijkstra search backwards from the goal, over nodes and without headings, gives the exact rest of the cost where
turns are free. That never says too much, so it is an estimate for A* over the states, and nearly always the right one:
the second search walks almost straight to the goal. With a limit on the length too, a state may be reached in several
ways that are worth keeping, cheaper or shorter; each is a label.
"""

from __future__ import annotations

import heapq

import numpy as np

from uavlab.compiled import compiled
from uavlab.planners.astar import COST_ROUNDING, TIE_BREAK
from uavlab.planners.grid import BOXES, blocked_around_node, steps_of
from uavlab.planners.heap import open_list, pop, push, sparse_array
from uavlab.planners.risk_question import LEAST_PRICE, NO_HEADING, STATES, Query, city_lengths, edge, state_after


def solve(query: Query, backward: bool) -> tuple[np.ndarray, float, int]:
    """Nodes of the cheapest route (none if there is none), its cost, and how many expansions it took."""
    count = query.blocked.size
    rest, expanded = np.zeros(count), 0
    if backward:
        rest, expanded = rest_of_cost(query, query.source, open_list(count))
        if rest[query.source] == np.inf:
            return np.empty(0, np.int64), np.inf, expanded
    g = sparse_array(np.empty, count * STATES, np.float64)
    parent = sparse_array(np.zeros, count * STATES, np.uint8)
    last, more = search_states(query, rest, g, parent, open_list(count * STATES))
    if last < 0:
        return np.empty(0, np.int64), np.inf, expanded + more
    return trace(query, parent, last), float(g[last]), expanded + more


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
    states, parent, cost, found = search_labels(query, by_length, rest, rest_length, limits)
    routes = []
    for label in found[::-1]:
        nodes = []
        at = label
        while at >= 0:
            nodes.append(states[at] // STATES)
            at = parent[at]
        routes.append((np.array(nodes[::-1]), float(cost[label])))
    return routes, expanded + more + len(states)


NOWHERE = -1
UNSEEN, START = 0, 255  # values of `parent`; between them 1 + move·STATES + the heading before


@compiled
def rest_of_cost(query, until, waiting):
    """Least cost from every node to the goal where turns are free: Dijkstra backwards from the goal.

    It stops when the node `until` is reached; farther nodes then get the cost of that one, which is not too much.
    Returns the costs, infinite where no way leads to the goal, and how many nodes were expanded.
    """
    steps = steps_of(query.blocked)
    rest = np.full(query.blocked.size, np.inf)
    rest[query.target] = 0.0
    expanded = 0
    push(waiting, query.target, 0.0)
    while waiting.size[0] > 0:
        node = pop(waiting)
        if node == until:
            return np.minimum(rest, rest[node]), expanded
        expanded += 1
        around = blocked_around_node(query.blocked, node)
        for back in range(26):
            move = 25 - back  # the moves stand in an order in which opposite ones mirror each other
            if around & BOXES[back] or not query.climb[move]:
                continue
            neighbour = node + steps[back]
            cost = rest[node] + edge(query, move, neighbour, node)
            if cost < rest[neighbour] * COST_ROUNDING:
                rest[neighbour] = cost
                push(waiting, neighbour, cost)
    return rest, expanded


@compiled
def search_states(query, rest, g, parent, waiting):
    """A* over states, node·STATES + heading, until one at the goal is expanded: that state, or −1, and the count."""
    steps = steps_of(query.blocked)
    first = query.source * STATES + NO_HEADING
    expanded = 0
    g[first] = 0.0
    parent[first] = START
    push(waiting, first, 0.0)
    while waiting.size[0] > 0:
        state = pop(waiting)
        node, heading = state // STATES, state % STATES
        if node == query.target:
            return state, expanded
        expanded += 1
        around = blocked_around_node(query.blocked, node)
        for move in range(26):
            if around & BOXES[move] or not query.climb[move] or not query.turn[heading, move]:
                continue
            neighbour = node + steps[move]
            cost = g[state] + edge(query, move, node, neighbour)
            follower = state_after(heading, move, neighbour)
            if parent[follower] == UNSEEN or cost < g[follower] * COST_ROUNDING:
                g[follower] = cost
                parent[follower] = 1 + move * STATES + heading
                push(waiting, follower, cost + TIE_BREAK * rest[neighbour])
    return -1, expanded


@compiled
def trace(query, parent, last):
    """Nodes from the start to the last state, back along the moves that led there."""
    steps = steps_of(query.blocked)
    count, state = 1, last
    while parent[state] != START:
        state = state_before(steps, parent, state)
        count += 1
    nodes = np.empty(count, np.int64)
    state = last
    for n in range(count - 1, -1, -1):
        nodes[n] = state // STATES
        if n > 0:
            state = state_before(steps, parent, state)
    return nodes


@compiled
def state_before(steps, parent, state):
    """The state that a state was reached from."""
    move, heading = divmod(np.int64(parent[state]) - 1, STATES)
    return (state // STATES - steps[move]) * STATES + heading


@compiled
def search_labels(query, by_length, rest, rest_length, limits):
    """Cheapest routes not longer than each of the limits [cells], by labels: ways to a state, cheaper or shorter.

    Labels are expanded in order of cost + rest. Of two at one state the later one costs more, so it is worth
    keeping only if it is shorter. The first label at the goal is the cheapest route within the largest limit; from
    then on only shorter ones are of interest, for the next smaller limit. Returns state, predecessor and
    cost of all labels, and those found at the goal, longest first.
    """
    steps = steps_of(query.blocked)
    shortest = np.full(query.blocked.size * STATES, np.inf)  # of the labels expanded at each state
    states, parent, costs, lengths = [query.source * STATES + NO_HEADING], [-1], [0.0], [0.0]
    found = [-1]
    limit = limits[-1] / COST_ROUNDING
    waiting = [(rest[query.source], rest_length[query.source], 0)]
    while len(waiting) > 0:
        _, least, label = heapq.heappop(waiting)
        state, length = states[label], lengths[label]
        node, heading = state // STATES, state % STATES
        if least > limit or length >= shortest[state] * COST_ROUNDING:
            continue
        shortest[state] = length
        if node == query.target:
            found.append(label)
            shorter = limits[limits < length * COST_ROUNDING]
            if len(shorter) == 0:
                break
            limit = shorter[-1] / COST_ROUNDING
            continue
        around = blocked_around_node(query.blocked, node)
        for move in range(26):
            if around & BOXES[move] or not query.climb[move] or not query.turn[heading, move]:
                continue
            neighbour = node + steps[move]
            follower = state_after(heading, move, neighbour)
            way = length + edge(by_length, move, node, neighbour)
            if way + rest_length[neighbour] > limit or way >= shortest[follower] * COST_ROUNDING:
                continue
            cost = costs[label] + edge(query, move, node, neighbour)
            states.append(follower)
            parent.append(label)
            costs.append(cost)
            lengths.append(way)
            heapq.heappush(waiting, (cost + rest[neighbour], way + rest_length[neighbour], len(states) - 1))
    return np.array(states), np.array(parent), np.array(costs), np.array(found[1:])
