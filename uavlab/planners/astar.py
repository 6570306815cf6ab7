"""A* on the voxels of a city, with a price per metre, and REPARE's penalty zone around buildings.

A* expands nodes in the order of g + h: the cost so far plus an estimate of the rest. With an estimate that is never too
high the first route found is a cheapest one. REPARE (Eqs 11-13) adds a penalty near obstacles; here it is a price per
metre on the edges, which keeps A* exact and the cost of a route the same in both directions.
"""

from __future__ import annotations

import time
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.city import City, LazyCity
from uavlab.city.lazy import refuse
from uavlab.compiled import compilable, compiled
from uavlab.planners.coarse import coarse_estimate, estimated, is_uneven
from uavlab.planners.grid import (
    BOXES,
    HEURISTICS,
    LENGTHS,
    MOVES,
    OCTILE,
    blocked_around,
    distance_left,
    steps_of,
)
from uavlab.planners.heap import open_list, pop, push, sparse_array
from uavlab.planners.question import Airspace, checked_price, endpoints, timed
from uavlab.route import Route

TIE_BREAK = 1 + 1e-9
"""Among routes that seem equally short, try the one with less way left: the estimate counts a billionth more."""

COST_ROUNDING = 1 - 1e-12
"""A cost counts as lower only if it is so by more than the rounding of a sum."""


def astar(
    city: City,
    start: npt.ArrayLike,
    goal: npt.ArrayLike,
    *,
    price: npt.ArrayLike | None = None,
    heuristic: str = "auto",
    min_clearance: float = 0.0,
    min_height: float = 0.0,
    max_height: float = np.inf,
    as_printed: bool = False,
    record: bool = False,
) -> Route:
    """Cheapest route over 26 neighbours, A* (REPARE 2.3.1, Eqs 8-13).

    cost = Σ d·(price at both ends)/2 over the moves, d their lengths; without a price, the length. It is the same both
    ways, so the search begins where the price is higher: the estimate knows nothing of a dear goal, and would
    have to look everywhere else before it pays for the last metres.

    On a lazy city, two searches from both ends find a route of the same cost; there it has no price and no record.

    Parameters
    ----------
    city : City
    start, goal : (3,) arrays
        Positions [m]. The route goes from the centre of the start's voxel to the centre of the goal's.
    price : (nx, ny, nz) array, optional
        Cost of a metre in each voxel, at least 0; `penalty_zone` gives REPARE's 1 + ω·O_risk.
    heuristic : {"auto", "octile", "euclidean", "zero", "coarse"}
        Estimate of the remaining way: by 26 moves on an empty map; straight (Eq. 9); none (Dijkstra); or, with a
        `price`, by the least prices of blocks of 4 × 4 × 4 voxels. "auto" is "coarse" where nine tenths of the map
        cost at least 1.5 times what the cheapest voxel costs, else "octile". Each gives a cheapest route; of several
        that cost the same it may be another one.
    min_clearance : float
        Distance to obstacles that no point of the route may fall below [m], for example D_min (Eq. 7).
    min_height, max_height : float
        Least and greatest height above ground [m], on every point of the route; a legal ceiling is often 120 m. A start
        or goal below `min_height` is left and reached vertically, there through any free voxels.
    as_printed : bool
        Order the open list by Eq. 13: T = g·price + h. The factor multiplies the whole way so far and no
        successor inherits it, so it is no cost of a route: the result depends on the direction of travel, and
        `Route.cost` is the length.
    record : bool
        Keep the order of expansion in `info["order"]`; it begins at the goal where the price is higher there.

    Returns
    -------
    Route
        `cost`; `info["expanded"]`, the number of expansions, `info["elapsed"]` [s], `info["heuristic"]` and, with
        `record`, `info["order"]`, the node codes as they were expanded. `reached` is False where no way exists, or on a
        lazy city where none can be proven to be cheapest within memory; `reason` tells.

    Raises
    ------
    ValueError
        If `city` is no City. If `start` or `goal` is not three finite numbers, lies off the map, in an obstacle or a
        no-fly zone, nearer to an obstacle than `min_clearance`, or above `max_height`. If both lie in one voxel. If
        `price` hasn't the city's shape, is negative or not finite. If `heuristic` is unknown, or "coarse" without a
        `price` or `as_printed`. If `min_clearance` or `min_height` is negative or not finite. If `max_height` is not
        above `min_height`. If `as_printed` comes without a `price`. If a `price` or `record` is asked for on a lazy
        city.

    See Also
    --------
    theta_star : Shorter, at any angle.
    penalty_zone : A price that keeps it off buildings.
    shortcut : Straightens the route afterwards.

    References
    ----------
    Hart, Nilsson and Raphael, A formal basis for the heuristic determination of minimum cost paths, 1968.

    Examples
    --------
    >>> from uavlab.city import table1_city
    >>> from uavlab.planners import astar
    >>> city = table1_city()
    >>> astar(city, (5, 5, 30), (95, 95, 30))
    <Route by A*: 146.0 m, 123 waypoints>
    >>> safe = astar(city, (5, 5, 30), (95, 95, 30), min_clearance=3.5)
    >>> safe, round(safe.clearance(city), 2)
    (<Route by A*: 151.9 m, 133 waypoints>, 3.5)
    """
    began = time.perf_counter()
    heuristic = checks.one_of("heuristic", heuristic, ("auto", *HEURISTICS, "coarse"))
    as_printed, record = checks.flag("as_printed", as_printed), checks.flag("record", record)
    if as_printed and price is None:
        raise ValueError("as_printed needs a price: without a penalty zone Eq. 13 is plain A*")
    if heuristic == "coarse" and (as_printed or price is None):
        raise ValueError('heuristic="coarse" estimates what a way costs: give a price, and leave as_printed False')
    airspace = Airspace(city, min_clearance, min_height, max_height)
    if isinstance(city, LazyCity) and (price is not None or record):
        refuse(city, "record" if price is None else "a price")
    ends = endpoints(airspace, start, goal)
    prices, cheapest = (None, 1.0) if price is None else checked_price(city, price)
    if heuristic == "auto":
        heuristic = "coarse" if prices is not None and not as_printed and is_uneven(prices, cheapest) else "octile"
    if isinstance(city, LazyCity):
        from uavlab.planners.both_ends import route_on_lazy

        return timed(ends.added_to(route_on_lazy(airspace, ends.source, ends.target, heuristic)), began)
    route = cheapest_route(
        city,
        ends.source,
        ends.target,
        airspace.blocked,
        prices,
        cheapest,
        heuristic=heuristic,
        as_printed=as_printed,
        record=record,
    )
    route = ends.added_to(route, None if as_printed else prices, priced="" if price is None else "price")
    return timed(route, began)


def cheapest_route(
    city: City,
    source: int,
    target: int,
    blocked: np.ndarray,
    prices: np.ndarray | None,
    cheapest: float,
    *,
    heuristic: str = "octile",
    as_printed: bool = False,
    record: bool = False,
) -> Route:
    """A* between two node codes with prices known to be finite and not below `cheapest`: `astar` without its checks.

    To look for a minimum among a million prices takes a tenth of the time of a search.
    """
    g = sparse_array(np.empty, city.occupied.size, np.float64)
    parent = sparse_array(np.zeros, city.occupied.size, np.uint8)
    weight = (1.0 if as_printed else cheapest) * TIE_BREAK
    query = Query(blocked, as_printed, HEURISTICS.get(heuristic, OCTILE), weight, source, target)
    coarse = None
    if heuristic == "coarse" and prices is not None:
        first, last = (target, source) if begins_at_goal(query, prices) else (source, target)
        coarse = coarse_estimate(blocked, prices, cheapest, first, last)
    waiting = open_list(city.occupied.size)
    nodes, cost, expanded, order = cheapest_nodes(query, prices, Tree(g, parent), waiting, record, coarse)
    info = {"expanded": expanded, "heuristic": heuristic}
    if record:
        info["order"] = order
    if len(nodes) == 0:
        nowhere = no_way(city, source, target, int(np.count_nonzero(parent)))
        return replace(nowhere, info=nowhere.info | info)
    return Route(city.center_of(city.index_of(nodes)), "A*", cost=cost * city.cell, info=info)


NO_WAY = "no free way from {start} to {goal}: all {reach} voxels within reach were searched"


def no_way(city: City, source: int, target: int, reach: int) -> Route:
    """A route that doesn't arrive, as all voxels within reach were searched."""
    start, goal = city.center_of(city.index_of([source, target]))
    reason = NO_WAY.format(start=checks.show(start), goal=checks.show(goal), reach=reach)
    return Route.none("A*", reason, goal=goal)


def penalty_zone(city: City, safe_distance: npt.ArrayLike, *, penalty: npt.ArrayLike, zone: str = "ball") -> np.ndarray:
    """Price per metre 1 + ω·O_risk: 1 far from obstacles, more near them (REPARE Eq. 12).

    Parameters
    ----------
    city : City
    safe_distance : float or (nx, ny, nz) array
        D_min [m] (Eq. 7), typically 3.5 to 5.5: O_risk = 1 where an obstacle is nearer.
    penalty : float or (nx, ny, nz) array
        ω, at least 0; typically 0.1 to 2.
    zone : {"ball", "ring"}
        "ball" measures the distance to the nearest surface. "ring" looks, as the paper does, only at the 26 points
        of the outer ring, r cells away along each axis; r is the least with r + ½ cells ≥ D_min. It looks through
        walls thinner than r cells and between its points.

    Returns
    -------
    (nx, ny, nz) float array
        At least 1; for `astar(..., price=...)` and `shortcut(..., price=...)`.

    Raises
    ------
    ValueError
        If `city` is no City. If `safe_distance` is not finite and above 0, `penalty` not finite and at least 0, or one
        of them neither one number nor of the city's shape. If `zone` is unknown.

    See Also
    --------
    repare_price : With a ω that follows the forces.
    hazard_price : Falls smoothly with the distance.

    Examples
    --------
    >>> from uavlab.city import table1_city
    >>> from uavlab.planners import astar, penalty_zone
    >>> city = table1_city()
    >>> zone = penalty_zone(city, 3.5, penalty=2.0)
    >>> float(zone.min()), float(zone.max())
    (1.0, 3.0)
    >>> astar(city, (5, 5, 30), (95, 95, 30), price=zone)  # 4.7 m longer than without
    <Route by A*: 150.7 m, 131 waypoints>
    """
    checks.instance("city", city, City)
    distance, weight = checks.numbers("safe_distance", safe_distance), checks.numbers("penalty", penalty)
    checks.positive("safe_distance", distance)
    checks.not_negative("penalty", weight)
    for name, values in (("safe_distance", distance), ("penalty", weight)):
        if values.shape not in ((), city.shape):
            raise ValueError(f"{name} must be one number or have the city's shape {city.shape}, got {values.shape}")
    if checks.one_of("zone", zone, ("ball", "ring")) == "ball":
        return price_in_zone(city.clearance, distance, weight, city.cell)
    radii = np.clip(np.ceil(distance / city.cell - 0.5 - 1e-9), 1, max(city.shape)).astype(int)
    near = np.zeros(city.shape, dtype=bool)
    for radius in np.unique(radii):
        near |= (radii == radius) & ring_meets_obstacle(city.occupied, int(radius))
    return 1.0 + weight * near


@compilable
def price_in_zone(clearance, safe_distance, penalty, cell):
    """1 + ω·O_risk by the distance to the nearest surface."""
    return 1.0 + penalty * (clearance < safe_distance - 1e-9 * cell)


def ring_meets_obstacle(occupied: np.ndarray, radius: int) -> np.ndarray:
    """Whether one of the 26 outer ring nodes, `radius` cells away, is occupied (REPARE Fig. 5), (nx, ny, nz) bool."""
    near = occupied.copy()
    inner = tuple(slice(radius, radius + n) for n in occupied.shape)
    padded = np.pad(occupied, radius)
    for move in MOVES:
        near |= padded[
            tuple(slice(s.start + radius * m, s.stop + radius * m) for s, m in zip(inner, move, strict=True))
        ]
    return near


UNSEEN, START = 0, 27  # values of `parent`; 1 to 26: the move that led to the node


class Query(NamedTuple):
    """A question, for compiled code; the price comes beside it, so that none costs nothing."""

    blocked: np.ndarray  # (nx, ny, nz) bool
    as_printed: bool
    heuristic: int
    weight: float  # of the estimate
    start: int
    goal: int


class Tree(NamedTuple):
    """What is known of each node (nodes,)."""

    g: np.ndarray  # cost so far
    parent: np.ndarray


@compiled
def begins_at_goal(query, price):
    """Whether to search from the goal to the start: where the price is higher there."""
    return price is not None and not query.as_printed and price.ravel()[query.start] < price.ravel()[query.goal]


@compiled
def cheapest_nodes(query, price, tree, waiting, record, coarse=None):
    """Nodes of the cheapest route (none if there is none), its cost [cells], how many were expanded, and which.

    The search begins at the end where the price is higher, and so leaves a zone at once. `coarse` estimates the rest
    of the cost to the other end, if it is given.
    """
    backwards = False
    if price is not None:
        backwards = begins_at_goal(query, price)
    first, last = (query.goal, query.start) if backwards else (query.start, query.goal)
    turned = Query(query.blocked, query.as_printed, query.heuristic, query.weight, first, last)
    expanded, order = search(turned, price, tree, waiting, record, coarse)
    if tree.parent[last] == UNSEEN:
        return np.empty(0, np.int64), np.inf, expanded, order[:expanded]
    nodes = trace(tree.parent, first, last, query.blocked)
    return nodes[::-1].copy() if backwards else nodes, tree.g[last], expanded, order[:expanded]


@compiled
def search(query, price, tree, waiting, record, coarse):
    """Expand nodes in order of g + h until the goal is the first; `parent` then holds the tree.

    Returns how many nodes were expanded and, with `record`, which, in order; a node may be expanded again (Eq. 13).
    """
    blocked, as_printed, goal = query.blocked, query.as_printed, query.goal
    g, parent = tree
    ny, nz = blocked.shape[1], blocked.shape[2]
    steps = steps_of(blocked)
    goal_i, goal_j, goal_k = goal // (ny * nz), goal // nz % ny, goal % nz
    prices = price.ravel() if price is not None else None
    expanded, order = 0, np.empty(1024 if record else 0, np.int32)
    g[query.start] = 0.0
    parent[query.start] = START
    push(waiting, query.start, 0.0)
    while waiting.size[0] > 0:
        node = pop(waiting)
        if node == goal:
            break
        if record:
            if expanded == order.size:
                order = np.concatenate((order, np.empty_like(order)))
            order[expanded] = node
        expanded += 1
        i, j, k = node // (ny * nz), node // nz % ny, node % nz
        around = blocked_around(blocked, i, j, k)
        so_far = g[node]
        price_here = prices[node] if prices is not None else 1.0
        for move in range(26):
            if around & BOXES[move]:
                continue
            neighbour = node + steps[move]
            cost = LENGTHS[move]
            if prices is not None and not as_printed:
                cost *= 0.5 * (price_here + prices[neighbour])
            cost += so_far
            unseen = parent[neighbour] == UNSEEN
            if unseen or cost < g[neighbour] * COST_ROUNDING:
                g[neighbour] = cost
                parent[neighbour] = move + 1
                di, dj, dk = MOVES[move]
                left = left_from(query, coarse, neighbour, unseen, goal_i - i - di, goal_j - j - dj, goal_k - k - dk)
                factor = prices[neighbour] if prices is not None and as_printed else 1.0
                push(waiting, neighbour, cost * factor + left)
    return expanded, order


@compiled
def left_from(query, coarse, node, unseen, di, dj, dk):
    """Estimate of the rest of the cost from a node, with the goal (di, dj, dk) cells away; kept where it takes long."""
    if coarse is None:
        return query.weight * distance_left(query.heuristic, di, dj, dk)
    if unseen:
        goal = coarse.goal
        coarse.left[node] = TIE_BREAK * estimated(coarse, goal[0] - di, goal[1] - dj, goal[2] - dk)
    return coarse.left[node]


@compiled
def trace(parent, source, target, blocked):
    """Node codes from source to target, back along the moves that led there."""
    steps = steps_of(blocked)
    count, node = 1, target
    while node != source:
        node -= steps[parent[node] - 1]
        count += 1
    nodes = np.empty(count, np.int64)
    node = target
    for n in range(count - 1, -1, -1):
        nodes[n] = node
        node -= steps[parent[node] - 1] if n > 0 else 0
    return nodes
