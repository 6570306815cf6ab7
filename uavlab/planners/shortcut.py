"""Any-angle shortcuts: leave out the waypoints that a straight line makes needless.

A route over 26 neighbours zigzags. Among all ways to skip waypoints, dynamic programming finds the cheapest: best[j] is
the least over i < j of best[i] plus the straight line from i to j, if it keeps its distance to obstacles all along. To
integrate a price along all those lines takes time with the cube of the waypoints; so with a price a line skips at most
`LOOKBACK` of them, and what is left is gone over again, until nothing is skipped any more.
A line that touches the edge or the corner of an obstacle is blocked, the same rule as for the moves on the grid.
"""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.city import City, LazyCity
from uavlab.city.bounds import bounds_of, keeps
from uavlab.city.lazy import refuse
from uavlab.city.segments import ROUNDING, distance_to_box
from uavlab.city.voxels import voxels_on_segment
from uavlab.compiled import compiled
from uavlab.planners.question import checked_price
from uavlab.route import Route, promises_of

LOOKBACK = 128
"""With a price, so many waypoints before one are looked at."""

PIECE = 300.0
"""Of a route on a lazy city so much is looked at in one go [cells]."""


def shortcut(
    route: Route,
    city: City,
    *,
    price: npt.ArrayLike | None = None,
    min_clearance: float | None = None,
    min_height: float | None = None,
    max_height: float | None = None,
    safe_height: float | None = None,
) -> Route:
    """The cheapest route over a subset of the waypoints; it keeps what the route promised, and is no longer.

    With a price and more than 128 waypoints it is the cheapest of those found in several rounds, see `LOOKBACK`; on a
    lazy city each 300 cells of the way are straightened by themselves, in two rounds that overlap.

    best[j] = min over i < j of best[i] + ∫ price ds from i to j, over the lines that keep what is asked for.

    Parameters
    ----------
    route : Route
        With waypoints one or two cells apart the result is best; `route.resample` adds some.
    city : City
    price : float or (nx, ny, nz) array, optional
        Cost of a metre in each voxel, the one that the route was planned with; a leg costs the integral along it. A
        route that was planned at a price needs one; 1.0 stands for its length alone.
    min_clearance : float, optional
        Least distance [m] that each leg keeps to obstacles, all along; by default the route's. 0: it touches none.
    min_height, max_height, safe_height : float, optional
        Least and greatest height above ground [m], in each column that a leg passes: above the highest ground there,
        below the lowest; and least height above roofs. By default the route's. Vertical take-off and landing stay as
        they are.

    Returns
    -------
    Route
        With the same ends; `cost` is its length or, with a price, the integral. A route that didn't arrive comes
        back as it is.

    Raises
    ------
    ValueError
        If `route` or `city` is of another kind. If `route` itself doesn't keep `min_clearance`, `min_height`,
        `max_height` or `safe_height` (the message says between which waypoints). If it was planned at a price and
        `price` is not given. If `price` is one number that is not finite and above 0, or an array that hasn't the
        city's shape, is negative or not finite. If `min_clearance`, `min_height` or `safe_height` is negative. If
        `max_height` is not above `min_height`.

    See Also
    --------
    theta_star : Looks for straight lines while it plans.
    uavlab.spline.smooth : Makes the route a curve.

    Examples
    --------
    >>> from uavlab.city import table1_city
    >>> from uavlab.planners import astar, penalty_zone, shortcut
    >>> city = table1_city()
    >>> zone = penalty_zone(city, 3.5, penalty=2.0)
    >>> route = astar(city, (5, 5, 30), (95, 95, 30), price=zone)
    >>> route, shortcut(route, city, price=zone)
    (<Route by A*: 150.7 m, 131 waypoints>, <Route by A* + shortcut: 140.3 m, 6 waypoints>)
    """
    checks.instance("route", route, Route)
    checks.instance("city", city, City)
    prices, cheapest = price_or_length(city, price)
    if not route.reached or len(route.points) < 2:
        return route
    if price is None and route.priced:
        raise ValueError(
            f"price must be the one that the route was planned with ({route.priced}), or straight lines lead where it "
            "is dear; price=1.0 shortens by length alone"
        )
    promises = promises_of(
        route, min_clearance=min_clearance, min_height=min_height, max_height=max_height, safe_height=safe_height
    )
    free = route.en_route
    if isinstance(city, LazyCity):
        kept, cost, leg = straightened_in_parts(free.points, city, promises)
    else:
        bounds = bounds_of(city, **promises)
        kept, cost, leg = straightened(free.points, city.origin, city.cell, bounds, prices, cheapest)
    if leg:
        ends = f"{leg - 1} {checks.show(free.points[leg - 1])} and {leg} {checks.show(free.points[leg])}"
        raise ValueError(
            f"route comes too near to an obstacle or a zone, too low or too high, between waypoints {ends}: "
            f"shorten only routes that themselves keep {told(promises)} all along"
        )
    before_and_after = route.points[: route.takeoff], route.points[len(route.points) - route.landing :]
    points = np.concatenate([before_and_after[0], free.points[kept], before_and_after[1]])
    vertical = replace(route, points=points[: route.takeoff + 1]), replace(route, points=points[-route.landing - 1 :])
    cost *= city.cell
    for part in vertical:
        cost += part.length if prices is None else part.integral(city, prices)
    if prices is None and price is not None:
        cost *= float(np.asarray(price))  # the same everywhere
    priced = "" if prices is None else route.priced or "price"
    return replace(route, points=points, planner=f"{route.planner} + shortcut", cost=cost, priced=priced, **promises)


def price_or_length(city: City, price: npt.ArrayLike | None) -> tuple[np.ndarray | None, float]:
    """A price (nx, ny, nz) and the cheapest; None where the length alone counts, for which one number stands, too."""
    if isinstance(city, LazyCity) and np.ndim(price) > 0:  # type: ignore[arg-type]
        refuse(city, "a price")
    if price is not None and (values := checks.numbers("price", price)).ndim > 0:
        return checked_price(city, values)
    if price is not None:
        checks.positive("price", values)
    return None, 1.0


def straightened_in_parts(
    points: np.ndarray, city: LazyCity, promises: dict[str, float]
) -> tuple[np.ndarray, float, int]:
    """`straightened` on a lazy city: `PIECE` of the way at a time, and once more with pieces that overlap these."""
    kept = np.arange(len(points))
    for shift in (0.0, 0.5):
        way = np.linalg.norm(np.diff(points[kept], axis=0), axis=1).cumsum() / (PIECE * city.cell)
        ends = [0, *(np.flatnonzero(np.diff(np.floor(way + shift))) + 1), len(kept) - 1]
        chosen, cost = [kept[:1]], 0.0
        for first, last in pairwise(ends):
            piece = points[kept[first : last + 1]]
            part = city.part(piece, margin=promises["min_clearance"] + 2 * city.cell)
            inner, added, leg = straightened(piece, part.origin, part.cell, bounds_of(part, **promises), None, 1.0)
            if leg:
                return kept, np.inf, int(kept[first + leg])
            chosen.append(kept[first + inner[1:]])
            cost += added
        kept = np.concatenate(chosen)
    return kept, cost, 0


@compiled
def straightened(points, origin, cell, bounds, price, cheapest):
    """Which of the waypoints (N, 3) [m] to keep, (K,), what the way over them costs [cells], and the end of the first
    leg that isn't free, or 0."""
    points = (points - origin) / cell
    same, lookback = ROUNDING, len(points)
    if price is not None:
        same, lookback = ROUNDING * price.max(), LOOKBACK
    kept = np.arange(len(points))
    while True:
        best, parent = cheapest_subset(points[kept], bounds, price, cheapest, same, lookback)
        for n in range(len(kept)):
            if best[n] == np.inf:
                return kept, np.inf, n
        chosen = np.zeros(len(kept), np.bool_)
        at = len(kept) - 1
        while not chosen[at]:
            chosen[at] = True
            at = parent[at]
        done = len(kept) <= lookback or chosen.all()
        kept = kept[chosen]
        if done:
            return kept, best[-1], 0


def told(promises: dict[str, float]) -> str:
    """Promises as words."""
    return ", ".join(f"{name}={value:g} m" for name, value in promises.items() if 0 < value < np.inf) or "off obstacles"


@compiled
def cheapest_subset(points, bounds, price, least_price, same, lookback):
    """Least cost from the first to each waypoint, and the waypoint before it on the way, at most `lookback` before.

    Costs that differ by less than `same` are the same; of those, the way that skips most wins. What was in the way of
    a leg from a waypoint is probably in the way of the next one from there, too, so that is looked at first.
    """
    best = np.full(len(points), np.inf)
    parent = np.zeros(len(points), np.int64)
    in_the_way = np.full((len(points), 5), -1.0)
    best[0] = 0.0
    for j in range(1, len(points)):
        free, _ = keeps(bounds, points[j - 1], points[j], 0.0, 0.0)
        most = best[j - 1] + line_price(price, least_price, points[j - 1], points[j], np.inf) + same if free else np.inf
        for i in range(max(j - lookback, 0), j):
            limit = min(best[j] - same, most) - best[i]
            if least_price * distance(points[i], points[j]) >= limit:
                continue
            a, b, low, high, keep = in_the_way[i]
            if a >= 0 and distance_to_box(points[i], points[j], a, b, low, high) < keep:
                continue
            free, box = keeps(bounds, points[i], points[j], 0.0, 0.0)
            if not free:
                in_the_way[i] = np.array(box)
                continue
            cost = line_price(price, least_price, points[i], points[j], limit)
            if cost < limit:
                best[j] = best[i] + cost
                parent[j] = i
        if best[j] == np.inf:
            break
    return best, parent


@compiled
def line_price(price, least_price, start, end, limit):
    """Integral of the price along a straight line [cells], its length without one; infinite where over the limit."""
    length = distance(start, end)
    if price is None:
        return length
    voxels, leave = voxels_on_segment(start, end)
    cost = 0.0
    entered = 0.0
    for m in range(len(voxels)):
        i, j, k = voxels[m]
        cost += (leave[m] - entered) * length * price[i, j, k]
        entered = leave[m]
        if cost + (1.0 - entered) * length * least_price >= limit:
            return np.inf
    return cost


@compiled
def distance(start, end):
    return math.sqrt((end[0] - start[0]) ** 2 + (end[1] - start[1]) ** 2 + (end[2] - start[2]) ** 2)
