"""The route that takes least from the battery in a uniform wind, over 26 neighbours, exactly.

A metre against the wind costs more than one with it, and a metre up more than one down. In a wind that is the same
everywhere the energy of a move depends on its direction only, so that the shortest way between two points of an empty
map is known for each pair: it combines the three moves whose cone holds the goal. That estimate makes A* exact.
"""

from __future__ import annotations

import time
from dataclasses import replace
from functools import partial

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.city import City
from uavlab.compiled import compiled
from uavlab.planners.astar import COST_ROUNDING, START, TIE_BREAK, UNSEEN, trace
from uavlab.planners.grid import BOXES, LENGTHS, MOVES, blocked_around_node, steps_of
from uavlab.planners.heap import open_list, pop, push, sparse_array
from uavlab.planners.question import Airspace, endpoints, timed
from uavlab.power import energy_per_metre
from uavlab.route import Route
from uavlab.vehicle import UAV
from uavlab.weather import Weather, Wind
from uavlab.weather.wind import wind_of

CALM = Wind(gusts="none")


def least_energy(
    city: City,
    start: npt.ArrayLike,
    goal: npt.ArrayLike,
    uav: UAV,
    disturbance: Wind | Weather = CALM,
    *,
    speed: float | None = None,
    min_clearance: float = 0.0,
    min_height: float = 0.0,
    max_height: float = np.inf,
) -> Route:
    """Route of least energy over 26 neighbours in a uniform wind, by A*.

    cost = Σ d·e over the moves, e = `energy_per_metre` in the direction of the move. It is that of steady flight: what
    turns, starting and gusts take isn't known to it.

    Parameters
    ----------
    city : City
    start, goal : (3,) arrays
        Positions [m].
    uav : UAV
    disturbance : Wind or Weather
        Its mean wind, rain and air; by default none moves.
    speed : float, optional
        Over ground, where nothing limits it [m/s]; by default the UAV's cruise speed.
    min_clearance, min_height, max_height
        As for `astar`.

    Returns
    -------
    Route
        `cost` [J]; `info["expanded"]` and `info["elapsed"]` [s]. `reached` is False where no way exists, or the wind
        leaves none.

    Raises
    ------
    ValueError
        If `city`, `start`, `goal`, `min_clearance`, `min_height` or `max_height` is what `astar` refuses. If `uav` is
        no UAV. If `disturbance` is neither Wind nor Weather. If `speed` is not above 0.

    See Also
    --------
    uavlab.power.energy_per_metre : e.
    astar : Of least length.

    Examples
    --------
    >>> from uavlab.city import table1_city
    >>> from uavlab.planners import least_energy
    >>> from uavlab.vehicle import LIGHT_QUADROTOR
    >>> from uavlab.weather import Wind
    >>> city, wind = table1_city(), Wind(mean=(10, 0), gusts="none")
    >>> with_it = least_energy(city, (5, 5, 30), (95, 5, 30), LIGHT_QUADROTOR, wind)
    >>> against = least_energy(city, (95, 5, 30), (5, 5, 30), LIGHT_QUADROTOR, wind)
    >>> f"{with_it.cost / 1000:.1f} kJ with the wind, {against.cost / 1000:.1f} kJ against it"
    '2.9 kJ with the wind, 5.4 kJ against it'
    """
    began = time.perf_counter()
    checks.instance("uav", uav, UAV)
    air = wind_of(disturbance)
    airspace = Airspace(city, min_clearance, min_height, max_height)
    ends = endpoints(airspace, start, goal)
    per_metre = partial(
        energy_per_metre, uav, wind=air.mean, speed=speed, rain_mm_per_h=air.rain_mm_per_h,
        air_density=air.air_density,
    )  # fmt: skip
    costs = city.cell * LENGTHS * per_metre(MOVES)
    g, parent = (
        sparse_array(np.empty, city.occupied.size, np.float64),
        sparse_array(np.zeros, city.occupied.size, np.uint8),
    )
    expanded = search(
        airspace.blocked, costs, slopes_of(costs), ends.source, ends.target, g, parent, open_list(city.occupied.size)
    )
    info = {"expanded": expanded}
    if parent[ends.target] == UNSEEN:
        ways = (
            f"the wind leaves {np.isfinite(costs).sum()} of 26 directions" if np.isinf(costs).any() else "no free way"
        )
        reason = f"{ways}: all {np.count_nonzero(parent)} voxels within reach were searched"
        return timed(Route.none("least energy", reason, **info), began)
    nodes = trace(parent, ends.source, ends.target, airspace.blocked)
    route = ends.added_to(Route(city.center_of(city.index_of(nodes)), "least energy", info=info), priced="energy")
    legs = np.diff(route.points, axis=0)
    return timed(replace(route, cost=float((route.leg_lengths * per_metre(legs)).sum())), began)


def slopes_of(costs: np.ndarray) -> np.ndarray:
    """Vectors y (V, 3) such that max(y·d) is the least cost of a way d [cells] on an empty map, by any moves.

    The corners of the polyhedron y·move ≤ cost (linear programming's dual); one of zeros where a move is free.
    """
    from scipy.spatial import HalfspaceIntersection

    known = np.isfinite(costs)
    if costs.min() <= 0 or np.linalg.matrix_rank(MOVES[known]) < 3:
        return np.zeros((1, 3))
    scale = costs[known].max()
    halves = np.column_stack([MOVES[known], -costs[known] / scale])
    corners = HalfspaceIntersection(halves, np.zeros(3)).intersections
    finite = corners[np.isfinite(corners).all(axis=1)]
    return scale * np.unique(finite.round(12), axis=0)


@compiled
def search(blocked, costs, slopes, start, goal, g, parent, waiting):
    """Expand nodes in order of g + h until the goal is the first; `parent` then holds the tree. Returns how many."""
    ny, nz = blocked.shape[1], blocked.shape[2]
    steps = steps_of(blocked)
    goal_i, goal_j, goal_k = goal // (ny * nz), goal // nz % ny, goal % nz
    expanded = 0
    g[start] = 0.0
    parent[start] = START
    push(waiting, start, 0.0)
    while waiting.size[0] > 0:
        node = pop(waiting)
        if node == goal:
            break
        expanded += 1
        di, dj, dk = goal_i - node // (ny * nz), goal_j - node // nz % ny, goal_k - node % nz
        around = blocked_around_node(blocked, node)
        for move in range(26):
            if around & BOXES[move] or costs[move] == np.inf:
                continue
            neighbour = node + steps[move]
            cost = g[node] + costs[move]
            if parent[neighbour] == UNSEEN or cost < g[neighbour] * COST_ROUNDING:
                g[neighbour] = cost
                parent[neighbour] = move + 1
                i, j, k = MOVES[move]
                push(waiting, neighbour, cost + TIE_BREAK * energy_left(slopes, di - i, dj - j, dk - k))
    return expanded


@compiled
def energy_left(slopes, di, dj, dk):
    """Least energy of a way on an empty map."""
    least = 0.0
    for n in range(len(slopes)):
        least = max(least, slopes[n, 0] * di + slopes[n, 1] * dj + slopes[n, 2] * dk)
    return least
