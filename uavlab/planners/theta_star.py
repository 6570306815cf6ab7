"""Lazy Theta*: routes at any angle, found in the search itself (Nash, Koenig and Tovey 2010).

A* on the grid decides for one of 26 directions at each step, and so on which side to pass a building; a shortcut
afterwards can't change it. Theta* lets the parent of a node be any node that it can be reached from in a straight line.
Lazy: a node is taken to be in sight of its parent's parent, and only when its turn comes is the line looked at, once.
Where it isn't free, or dear, the best of the neighbours that were expanded is the parent.
"""

from __future__ import annotations

import time
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.city import City
from uavlab.city.bounds import Bounds, bounds_of, keeps
from uavlab.compiled import compiled
from uavlab.planners.astar import COST_ROUNDING, no_way
from uavlab.planners.grid import BOXES, LENGTHS, MOVES, blocked_around, steps_of
from uavlab.planners.heap import code_type, open_list, pop, push, sparse_array
from uavlab.planners.question import Airspace, checked_price, endpoints, timed
from uavlab.planners.shortcut import distance, line_price, straightened
from uavlab.route import Route

WEIGHT = 1.15
"""Of the estimate: a sixth of the expansions of 1, routes 0.04 % longer on Table 1's city."""

TAUT_STEPS, TAUT_POINTS = (0.5, 0.25), 12
"""A route is pulled taut by shortcuts over so many points on each side of its corners, so many voxels apart."""

UNSEEN, OPEN, CLOSED = 0, 1, 2


class Query(NamedTuple):
    """A question, for compiled code; the price comes beside it, so that none costs nothing."""

    blocked: np.ndarray  # (nx, ny, nz) bool
    bounds: Bounds
    cheapest: float  # price
    weight: float  # of the estimate
    start: int
    goal: int


class Tree(NamedTuple):
    """What is known of each node (nodes,); see `search`."""

    g: np.ndarray
    parent: np.ndarray
    bound: np.ndarray
    guess: np.ndarray  # a node + 1, or 0
    state: np.ndarray  # UNSEEN, OPEN, CLOSED


def theta_star(
    city: City,
    start: npt.ArrayLike,
    goal: npt.ArrayLike,
    *,
    price: npt.ArrayLike | None = None,
    weight: float = WEIGHT,
    taut: bool = True,
    min_clearance: float = 0.0,
    min_height: float = 0.0,
    max_height: float = np.inf,
) -> Route:
    """A short route of straight legs at any angle, by Lazy Theta*; shorter than `shortcut` makes that of `astar`.

    cost = ∫ price ds; without a price, the length. The turns are at centres of voxels, or pulled taut around
    corners. Not exact: at any angle no search on a grid is. A taut route passes corners as closely as it may, and
    leaves a curve little room: for `smooth`, plan with more clearance than it has to keep, or with `taut=False`.

    Parameters
    ----------
    city, start, goal, min_clearance, min_height, max_height
        As for `astar`.
    price : (nx, ny, nz) array, optional
        As for `astar`; a leg costs the integral along it.
    weight : float
        Of the estimate, at least 1: the more, the fewer nodes are expanded, and the longer the route may get.
    taut : bool
        Pull the route taut at the end, see `TAUT_STEPS`.

    Returns
    -------
    Route
        `cost`; `info["expanded"]`, the number of expansions, and `info["elapsed"]` [s]. `reached` is False where no way
        exists.

    Raises
    ------
    ValueError
        If `city`, `start`, `goal`, `price`, `min_clearance`, `min_height` or `max_height` is what `astar` refuses. If
        `weight` is below 1 or not finite. If `taut` is neither True nor False.

    See Also
    --------
    astar : Over 26 directions, exactly.
    shortcut : Straightens a route of another planner.

    References
    ----------
    Nash, Koenig and Tovey, Lazy Theta*: any-angle path planning and path length analysis in 3D, 2010.

    Examples
    --------
    >>> from uavlab.city import table1_city
    >>> from uavlab.planners import astar, shortcut, theta_star
    >>> city = table1_city()
    >>> theta_star(city, (5, 5, 30), (95, 95, 30))
    <Route by Theta*: 134.7 m, 4 waypoints>
    >>> shortcut(astar(city, (5, 5, 30), (95, 95, 30)), city)  # straightened only afterwards
    <Route by A* + shortcut: 135.5 m, 5 waypoints>
    """
    began = time.perf_counter()
    weight = checks.number("weight", weight, checks.at_least_one)
    taut = checks.flag("taut", taut)
    airspace = Airspace(city, min_clearance, min_height, max_height)
    ends = endpoints(airspace, start, goal)
    prices, cheapest = (None, 1.0) if price is None else checked_price(city, price)
    count = city.occupied.size
    code = code_type(count)
    tree = Tree(
        sparse_array(np.empty, count, np.float64), sparse_array(np.empty, count, code),
        sparse_array(np.empty, count, np.float64), sparse_array(np.zeros, count, code),
        sparse_array(np.zeros, count, np.uint8),
    )  # fmt: skip
    bounds = bounds_of(city, **airspace.promises)
    query = Query(airspace.blocked, bounds, cheapest, weight, ends.source, ends.target)
    nodes, cost, expanded = straight_nodes(query, prices, tree, open_list(count))
    info = {"expanded": expanded}
    if len(nodes) == 0:
        nowhere = no_way(city, ends.source, ends.target, expanded)
        route = replace(nowhere, planner="Theta*", info=nowhere.info | info)
    else:
        points = city.center_of(city.index_of(nodes))
        if taut:
            points, cost = pulled_taut(points, city.origin, city.cell, bounds, prices, cheapest)
        route = Route(points, "Theta*", cost=cost * city.cell, info=info, **airspace.promises)
    return timed(ends.added_to(route, prices, priced="" if price is None else "price"), began)


@compiled
def straight_nodes(query, price, tree, waiting):
    """Both ends and where the route turns (nothing if there is none), its cost [cells], how many were expanded."""
    expanded = search(query, price, tree, waiting)
    if tree.state[query.goal] == UNSEEN:
        return np.empty(0, np.int64), np.inf, expanded
    count, node = 1, query.goal
    while node != query.start:
        node = tree.parent[node]
        count += 1
    nodes = np.empty(count, np.int64)
    node = query.goal
    for n in range(count - 1, -1, -1):
        nodes[n] = node
        node = tree.parent[node]
    return nodes, tree.g[query.goal], expanded


@compiled
def pulled_taut(points, origin, cell, bounds, price, cheapest):
    """The waypoints (N, 3) [m] pulled around corners, closer and closer, and what the way over them costs [cells]."""
    cost = np.inf
    for step in TAUT_STEPS:
        points = around_corners(points, step * cell)
        kept, cost, _ = straightened(points, origin, cell, bounds, price, cheapest)
        points = points[kept]
    return points, cost


@compiled
def around_corners(points, step):
    """The waypoints (N, 3) with others on the legs before and after each corner, so far apart [m]."""
    finer = np.empty((1 + (2 * TAUT_POINTS + 1) * (len(points) - 1), 3))
    finer[0] = points[0]
    count = 1
    for leg in range(len(points) - 1):
        length = distance(points[leg], points[leg + 1])
        shares = np.empty(2 * TAUT_POINTS)
        for n in range(len(shares)):  # from the one corner and from the other, in the order of the leg
            away = step * (n // 2 + 1) / length
            share = away * (leg > 0) if n % 2 == 0 else 1 - away * (leg < len(points) - 2)
            place = n
            while place > 0 and shares[place - 1] > share:
                shares[place] = shares[place - 1]
                place -= 1
            shares[place] = share
        before = 0.0
        for share in shares:
            if before < share < 1:
                for a in range(3):
                    finer[count, a] = points[leg, a] + share * (points[leg + 1, a] - points[leg, a])
                count += 1
                before = share
        finer[count] = points[leg + 1]
        count += 1
    return finer[:count]


@compiled
def search(query, price, tree, waiting):
    """Expand nodes in order of g + weight·h until the goal is the first; `parent` then holds the tree.

    A node that waits has a cost g that is sure, if its state is OPEN, or one that it can't be below, `bound`, if it
    were in sight of guess − 1; or both. Returns how many were expanded.
    """
    blocked, cheapest, weight = query.blocked, query.cheapest, query.weight
    g, parent, bound, guess, state = tree
    ny, nz = blocked.shape[1], blocked.shape[2]
    here, there, aim = np.empty(3), np.empty(3), np.empty(3)
    put_centre(aim, query.goal, ny, nz)
    steps, expanded = steps_of(blocked), 0
    g[query.start], parent[query.start], state[query.start] = 0.0, query.start, OPEN
    push(waiting, query.start, 0.0)
    while waiting.size[0] > 0:
        key = waiting.key[1]
        node = pop(waiting)
        i, j, k = node // (ny * nz), node // nz % ny, node % nz
        around = blocked_around(blocked, i, j, k)
        put_centre(here, node, ny, nz)
        if guess[node] > 0:
            put_centre(there, guess[node] - 1, ny, nz)
            look(query, price, tree, node, here, there, around, steps)
            later = g[node] + weight * cheapest * distance(here, aim)
            if later * COST_ROUNDING > key:
                push(waiting, node, later)
                continue
        if node == query.goal:
            break
        state[node] = CLOSED
        expanded += 1
        put_centre(there, parent[node], ny, nz)
        for move in range(26):
            neighbour = node + steps[move]
            if around & BOXES[move] or state[neighbour] == CLOSED:
                continue
            di, dj, dk = MOVES[move]
            here[0], here[1], here[2] = i + di + 0.5, j + dj + 0.5, k + dk + 0.5
            low = g[parent[node]] + cheapest * distance(there, here)
            known = bound[neighbour] if guess[neighbour] > 0 else np.inf
            if state[neighbour] == OPEN:
                known = min(known, g[neighbour])
            if low < known * COST_ROUNDING:
                bound[neighbour], guess[neighbour] = low, parent[node] + 1
                push(waiting, neighbour, low + weight * cheapest * distance(here, aim))
    return expanded


@compiled
def look(query, price, tree, node, here, there, around, steps):
    """Make a node's cost sure: by the line from `there`, if it is free, or over a neighbour that was expanded."""
    g, parent, guess, state = tree.g, tree.parent, tree.guess, tree.state
    best = g[node] if state[node] == OPEN else np.inf
    far = guess[node] - 1
    guess[node] = 0
    state[node] = OPEN
    free, _ = keeps(query.bounds, there, here, 0.0, 0.0)
    if free:
        cost = g[far] + line_price(price, query.cheapest, there, here, np.inf)
        if cost < best:
            best, parent[node] = cost, far
    if not free or price is not None:
        for move in range(26):
            if around & BOXES[move]:
                continue
            neighbour = node + steps[move]
            if state[neighbour] != CLOSED:
                continue
            cost = LENGTHS[move]
            if price is not None:
                cost *= 0.5 * (price.ravel()[node] + price.ravel()[neighbour])
            if g[neighbour] + cost < best:
                best, parent[node] = g[neighbour] + cost, neighbour
    g[node] = best


@compiled
def put_centre(point, node, ny, nz):
    """Write the centre of a node's voxel into a point [cells]."""
    point[0] = node // (ny * nz) + 0.5
    point[1] = node // nz % ny + 0.5
    point[2] = node % nz + 0.5
