"""The exact search on a risk map: nodes without headings backwards, then states with headings forwards.

First a Dijkstra search backwards from the goal, over nodes and without headings, gives the exact rest of the cost where
turns are free. That never says too much, so it is an estimate for A* over the states, and nearly always the right one:
the second search walks almost straight to the goal.
"""

from __future__ import annotations

import numpy as np

from uavlab.compiled import compiled
from uavlab.planners.astar import COST_ROUNDING, TIE_BREAK
from uavlab.planners.grid import BOXES, blocked_around_node, steps_of
from uavlab.planners.heap import open_list, pop, push, sparse_array
from uavlab.planners.risk_question import NO_HEADING, STATES, Query, edge, state_after


def solve(query: Query, backward: bool) -> tuple[np.ndarray, float, int]:
    """Nodes of the cheapest route (none if there is none), its cost, and how many expansions it took."""
    count = query.blocked.size
    rest, expanded = np.zeros(count), 0
    if backward:
        rest, expanded = rest_of_cost(query, query.source, open_list(count))
        if rest[query.source] == np.inf:
            return np.empty(0, np.int64), np.inf, expanded
    nodes, cost, more = solve_knowing(query, rest)
    return nodes, cost, expanded + more


def solve_knowing(query: Query, rest: np.ndarray) -> tuple[np.ndarray, float, int]:
    """The same with an estimate of the rest of the cost from each node (nodes,)."""
    count = query.blocked.size * STATES
    g = sparse_array(np.empty, count, np.float64)
    parent = sparse_array(np.zeros, count, np.uint8)
    last, expanded = search_states(query, rest, g, parent, open_list(count))
    if last < 0:
        return np.empty(0, np.int64), np.inf, expanded
    return trace(query, parent, last), float(g[last]), expanded


NOWHERE = -1
"""Where a search backwards ends that is to reach all nodes."""

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
