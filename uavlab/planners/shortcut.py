"""Any-angle shortcuts: leave out the waypoints that a straight line makes needless.

A route over 26 neighbours zigzags. Among all ways to skip waypoints, dynamic programming finds the cheapest: best[j] is
the least over i < j of best[i] plus the straight line from i to j, if nothing is in between. A line that touches
the edge or the corner of an obstacle is blocked, the same rule as for the moves on the grid.
"""

import math
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.city import City
from uavlab.city.voxels import voxels_on_segment
from uavlab.compiled import compiled
from uavlab.planners.question import checked_price
from uavlab.route import Route

ROUNDING = 1e-9
"""What is nearer than this [cells] touches; costs that differ by less are the same."""


def shortcut(
    route: Route,
    city: City,
    *,
    price: npt.ArrayLike | None = None,
    min_clearance: float = 0.0,
    min_height: float = 0.0,
    max_height: float = np.inf,
) -> Route:
    """The cheapest route over a subset of the waypoints.

    Parameters
    ----------
    route : Route
        With waypoints one or two cells apart the result is best; `route.resample` adds some.
    city : City
    price : (nx, ny, nz) array, optional
        Cost of a metre in each voxel, the one that the route was planned with; a leg costs the integral along it.
    min_clearance : float
        Clearance [m] that no voxel touched by the route may fall below.
    min_height, max_height : float
        As for `astar` [m]. Vertical take-off and landing stay as they are.

    Returns
    -------
    Route
        With the same ends; `cost` is its length or, with a price, the integral. A route that didn't arrive comes
        back as it is.

    Raises
    ------
    ValueError
        If the route itself passes through a blocked voxel; the message says between which waypoints.
    """
    if not route.reached or len(route.points) < 2:
        return route
    prices, cheapest = (None, 1.0) if price is None else checked_price(city, price)
    free = route.en_route
    points = (free.points - city.origin) / city.cell
    blocked = city.blocked(min_clearance, min_height=min_height, max_height=max_height)
    best, before = cheapest_subset(points, blocked, prices, cheapest)
    if not np.isfinite(best).all():
        leg = int(np.flatnonzero(~np.isfinite(best))[0])
        raise ValueError(
            f"route passes through a blocked voxel between waypoints {leg - 1} {checks.show(free.points[leg - 1])} "
            f"and {leg} {checks.show(free.points[leg])}: shorten only routes that themselves keep "
            f"min_clearance={min_clearance:g} m"
        )
    kept = [len(points) - 1]
    while kept[-1] != 0:
        kept.append(int(before[kept[-1]]))
    before_and_after = route.points[: route.takeoff], route.points[len(route.points) - route.landing :]
    points = np.concatenate([before_and_after[0], free.points[kept[::-1]], before_and_after[1]])
    vertical = replace(route, points=points[: route.takeoff + 1]), replace(route, points=points[-route.landing - 1 :])
    cost = float(best[-1]) * city.cell
    for part in vertical:
        cost += part.length if prices is None else part.integral(city, prices)
    return replace(route, points=points, planner=f"{route.planner} + shortcut", cost=cost)


@compiled
def cheapest_subset(points, blocked, price, least_price):
    """Least cost from the first to each waypoint, and the waypoint before it on the way."""
    best = np.full(len(points), np.inf)
    before = np.zeros(len(points), np.int64)
    best[0] = 0.0
    for j in range(1, len(points)):
        for i in range(j):
            at_least = least_price * distance(points[i], points[j])
            if best[i] + at_least < best[j] - ROUNDING:
                cost = best[i] + line_cost(blocked, price, points[i], points[j])
                if cost < best[j] - ROUNDING:
                    best[j] = cost
                    before[j] = i
        if best[j] == np.inf:
            break
    return best, before


@compiled
def line_cost(blocked, price, start, end):
    """Integral of the price along a straight line [cells], its length without one; infinite if it is blocked."""
    if touches_blocked(blocked, start, end, 0.0):
        return np.inf
    voxels, leave = voxels_on_segment(start, end)
    length = distance(start, end)
    cost = 0.0
    entered = 0.0
    for m in range(len(voxels)):
        i, j, k = voxels[m]
        if not (0 <= i < blocked.shape[0] and 0 <= j < blocked.shape[1] and 0 <= k < blocked.shape[2]):
            return np.inf
        if touches_blocked(blocked, start, end, (entered + leave[m]) / 2) or touches_blocked(
            blocked, start, end, leave[m]
        ):
            return np.inf
        if price is not None:
            cost += (leave[m] - entered) * length * price[i, j, k]
        entered = leave[m]
    return cost if price is not None else length


@compiled
def touches_blocked(blocked, start, end, share):
    """Whether the point at a share of a line lies in a blocked voxel or on its surface, edge or corner."""
    x = start[0] + share * (end[0] - start[0])
    y = start[1] + share * (end[1] - start[1])
    z = start[2] + share * (end[2] - start[2])
    nx, ny, nz = blocked.shape
    for i in range(max(math.floor(x - ROUNDING), 0), min(math.floor(x + ROUNDING), nx - 1) + 1):
        for j in range(max(math.floor(y - ROUNDING), 0), min(math.floor(y + ROUNDING), ny - 1) + 1):
            for k in range(max(math.floor(z - ROUNDING), 0), min(math.floor(z + ROUNDING), nz - 1) + 1):
                if blocked[i, j, k]:
                    return True
    return False


@compiled
def distance(start, end):
    return math.sqrt((end[0] - start[0]) ** 2 + (end[1] - start[1]) ** 2 + (end[2] - start[2]) ** 2)
