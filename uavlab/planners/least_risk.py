"""The exact optimum on a risk map, under limits on turns, climb and length: the yardstick for every other planner.

What is asked stands in `risk_question`, how it is searched in `risk_search`, what to loosen where there is no route in
`advice`.
"""

from __future__ import annotations

import time

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.planners.advice import what_binds
from uavlab.planners.risk_labels import constrained, costs_nothing, shortest_of_cheapest
from uavlab.planners.risk_question import (
    MAX_TURN,
    Weights,
    checked_length,
    checked_limits,
    city_lengths,
    finished,
    flyable_endpoints,
    in_cells,
    price_per_cell,
    query_of,
)
from uavlab.planners.risk_search import solve
from uavlab.risk import RiskMap
from uavlab.route import Route
from uavlab.spline.limits import MAX_PITCH

MOST_LENGTHS = 10**4
"""Of a front: each takes a search."""


NO_SAFE_WAY = "no route from {start} to {goal}"


def least_risk(
    risk_map: RiskMap,
    start: npt.ArrayLike,
    goal: npt.ArrayLike,
    *,
    risk_weight: float = 1.0,
    length_weight: float = 0.0,
    threat_weight: float = 0.0,
    max_turn: float = MAX_TURN,
    max_pitch: float = MAX_PITCH,
    max_length: float | None = None,
    min_clearance: float = 0.0,
    min_height: float | None = None,
    max_height: float = np.inf,
    max_igrc: int | None = None,
    ground_risk_buffer: float = 0.0,
    drift: bool = False,
    as_printed: bool = False,
    heuristic: str = "backward",
) -> Route:
    """The route of least cost among all over 26 neighbours that keep the limits.

    cost = w_r·∫ r ds/dx + w_l·L + w_s·∫ threat ds/dx with weights w_r [h], w_l [1/m] and w_s [1/m].
    Of routes that cost the same, the one is taken that the search finds first, and its order is fixed; where cells
    cost nothing, the shortest.

    Parameters
    ----------
    risk_map : RiskMap
        Its `flyable` voxels are the ones to choose from.
    start, goal : (3,) arrays
        Positions [m]. The route goes from the centre of the start's voxel to the centre of the goal's.
    risk_weight, length_weight, threat_weight : float
        w_r, w_l and w_s, at least 0 and not all of them 0. (1, 0, 0) minimises risk; (0, 1, 0) is risk-blind and
        shortest; (0, 0.5, 0.2) is J0, what the papers minimise when they leave risk aside.
    max_turn : float
        Greatest change of heading from leg to leg [rad]. Legs turn by multiples of 45°, so 60° means 45°. A vertical
        leg keeps the heading of the leg before.
    max_pitch : float
        Greatest climb or descent of a leg [rad]: from 35.3° on through corners, from 45° on through edges, at 90°
        vertical.
    max_length : float, optional
        Greatest length [m], but for take-off and landing.
    min_clearance : float
        Least distance to obstacles [m], see `City.clearance`.
    min_height, max_height : float
        Least and greatest height above ground [m], by default the map's `min_height` and none. A start or goal below
        it is left and reached vertically, whatever the other limits.
    max_igrc : int, optional
        Highest intrinsic ground risk class of the ground below the route (SORA 2.5), 1 to 10, see `RiskMap.igrc`.
        Take-off and landing below `min_height` keep it, too. What is done to the route later, such as smoothing,
        doesn't know of it: `RiskMap.highest_igrc` measures it.
    ground_risk_buffer : float
        Distance [m], at least 0, within which the ground beside the route must be of these classes, too.
    drift : bool
        Take the risk where the wreck lands, ahead of the UAV, see `RiskMap.rate_ahead`.
    as_printed : bool
        Minimise the papers' sum Σ r over the voxels passed (RISK-ACO Eq. 3, PSO-BAS Eq. 1) instead of the integral, so
        that a diagonal move costs no more than a straight one. A voxel entered again would count again. Only without
        other weights and `drift`.
    heuristic : {"backward", "zero"}
        Estimate of the remaining cost: Dijkstra backwards without headings; none (plain Dijkstra over the states).

    Returns
    -------
    Route
        `cost` as above, or Σ r; `info["expanded"]`, nodes and states expanded by both searches; `info["elapsed"]` [s].
        Where no route keeps the limits `reached` is False, and `reason` says which limit to loosen.

    Raises
    ------
    ValueError
        If `risk_map` is no RiskMap. If `start` or `goal` is not three finite numbers, lies off the map, in an obstacle
        or a no-fly zone, nearer to an obstacle than `min_clearance`, lower above roofs than the map's `safe_height`, or
        above `max_height`, or over ground that `max_igrc` closes. If both lie in one voxel. If `risk_weight`,
        `length_weight` or `threat_weight` is negative or not finite, or all are 0. If `max_turn` is not from 0 to π, or
        `max_pitch` not from 0 to π/2. If `min_clearance`, `min_height` or `ground_risk_buffer` is negative or not
        finite. If `max_height` is not above `min_height`. If `max_igrc` is no whole number from 1 to 10. If
        `max_length` is not above 0. If `drift` or `as_printed` is neither True nor False, or `as_printed` is asked for
        together with weights or `drift`. If `heuristic` is unknown.

    See Also
    --------
    pareto_front : For each length that one is ready to fly.
    ant_colony : Without a guarantee, as the papers do.
    refine : Makes it a better curve, off the grid.

    Examples
    --------
    >>> from uavlab.planners import least_risk
    >>> from uavlab.risk import CAMPUS_FLIGHT, reference_campus
    >>> campus = reference_campus()
    >>> safest = least_risk(campus, *CAMPUS_FLIGHT)
    >>> shortest = least_risk(campus, *CAMPUS_FLIGHT, risk_weight=0.0, length_weight=1.0)
    >>> safest, shortest
    (<Route by least risk: 189.0 m, 33 waypoints>, <Route by shortest: 140.9 m, 21 waypoints>)
    >>> round(campus.integral(shortest) / campus.integral(safest), 1)  # times the risk
    11.2
    """
    began = time.perf_counter()
    checks.one_of("heuristic", heuristic, ("backward", "zero"))
    allowed = checked_length(max_length)
    limits = checked_limits(
        risk_map, max_turn, max_pitch, min_clearance, min_height, max_height, max_igrc, ground_risk_buffer
    )
    weights = Weights.checked(risk_weight, length_weight, threat_weight, drift, as_printed)
    price = price_per_cell(risk_map, weights)
    ends = flyable_endpoints(risk_map, start, goal, limits)
    query = query_of(risk_map, price, ends.source, ends.target, limits)
    if allowed == np.inf:
        nodes, cost, expanded = solve(query, heuristic == "backward")
        if costs_nothing(query, nodes):
            nodes, more = shortest_of_cheapest(query, cost)
            expanded += more
    else:
        longest = in_cells(risk_map.city, allowed)
        routes, expanded = constrained(query, city_lengths(query), np.array([longest]))
        nodes, cost = routes[0] if routes else (np.empty(0, np.int64), np.inf)
    info = {"expanded": expanded, "elapsed": time.perf_counter() - began}
    if len(nodes) == 0:
        nowhere = NO_SAFE_WAY.format(start=checks.show(start), goal=checks.show(goal))
        reason = f"{nowhere}: {what_binds(risk_map, query, limits, max_length)}"
        return Route.none(weights.name, reason, **info)
    city = risk_map.city
    route = Route(city.center_of(city.index_of(nodes)), weights.name, cost=cost, info=info)
    return finished(route, ends, price, weights, allowed)


def pareto_front(
    risk_map: RiskMap,
    start: npt.ArrayLike,
    goal: npt.ArrayLike,
    *,
    lengths: int | npt.ArrayLike = 12,
    max_turn: float = MAX_TURN,
    max_pitch: float = MAX_PITCH,
    min_clearance: float = 0.0,
    min_height: float | None = None,
    max_height: float = np.inf,
    max_igrc: int | None = None,
    ground_risk_buffer: float = 0.0,
    drift: bool = False,
) -> list[Route]:
    """The least risk for each length that one is ready to fly, exactly (ε-constraint method).

    min ∫ r ds/dx subject to L ≤ ε, for one ε after another.

    Parameters
    ----------
    risk_map, start, goal, max_turn, max_pitch, min_clearance, min_height, max_height
        As for `least_risk`.
    max_igrc, ground_risk_buffer, drift
        As for `least_risk`.
    lengths : int or array
        Greatest lengths to ask for [m]; or how many, from 2 to 10,000, spread evenly from the shortest route's to that
        of the route of least risk.

    Returns
    -------
    list of Route
        From short and risky to long and safe, each with its risk ∫ r ds/dx as `cost`. No route is both longer and
        riskier than another, so there may be fewer than lengths asked for; lengths below the shortest route's give
        none. One route with `reached` False where the limits leave no route at all.

    Raises
    ------
    ValueError
        If `risk_map`, `start`, `goal`, `max_turn`, `max_pitch`, `min_clearance`, `min_height`, `max_height`, `max_igrc`
        or `ground_risk_buffer` is what `least_risk` refuses, or `drift` neither True nor False. If `lengths` is empty,
        has more than one axis, is as a count below 2 or above 10,000, or a length is not finite and above 0.

    See Also
    --------
    least_risk : One of them, at one length.
    uavlab.plot.front : Draws it.

    References
    ----------
    Haimes, Lasdon and Wismer, On a bicriterion formulation of the problems of integrated system identification and
    system optimization, 1971: the ε-constraint method.

    Examples
    --------
    >>> from uavlab.planners import pareto_front
    >>> from uavlab.risk import CAMPUS_FLIGHT, reference_campus
    >>> campus = reference_campus()
    >>> front = pareto_front(campus, *CAMPUS_FLIGHT, lengths=4)
    >>> [(round(route.length), round(1e6 * route.cost, 1)) for route in front]  # m, and 10⁻⁶/h
    [(141, 41.9), (156, 6.6), (172, 5.6), (189, 5.5)]
    """
    began = time.perf_counter()
    limits = checked_limits(
        risk_map, max_turn, max_pitch, min_clearance, min_height, max_height, max_igrc, ground_risk_buffer
    )
    count = None
    if isinstance(lengths, int | np.integer):
        count = checks.whole("lengths", int(lengths), 2, MOST_LENGTHS)
    elif (asked := np.atleast_1d(checks.numbers("lengths", lengths))).size == 0:
        raise ValueError("lengths is empty: give how many, or at least one length [m]")
    else:
        checks.positive("lengths", checks.array("lengths", asked, None, finite=False))
    ends = flyable_endpoints(risk_map, start, goal, limits)
    weights = Weights(drift=checks.flag("drift", drift))
    price = price_per_cell(risk_map, weights)
    query = query_of(risk_map, price, ends.source, ends.target, limits)
    by_length = city_lengths(query)
    city = risk_map.city
    shortest, least, _ = solve(by_length, True)
    if len(shortest) == 0:
        return [
            least_risk(
                risk_map, start, goal, max_turn=max_turn, max_pitch=max_pitch,
                min_clearance=min_clearance, min_height=min_height, max_height=max_height,
                max_igrc=max_igrc, ground_risk_buffer=ground_risk_buffer,
            )
        ]  # fmt: skip
    if count is None:
        asked = asked / city.cell
    else:
        safest, cost, _ = solve(query, True)
        if costs_nothing(query, safest):
            safest, _ = shortest_of_cheapest(query, cost)
        longest = np.linalg.norm(np.diff(city.index_of(safest), axis=0), axis=1).sum()
        asked = np.linspace(least, longest, count)
    routes, expanded = constrained(query, by_length, np.unique(asked))
    info = {"expanded": expanded, "elapsed": time.perf_counter() - began}
    found = [
        Route(city.center_of(city.index_of(nodes)), "least risk", cost=cost, info=dict(info)) for nodes, cost in routes
    ]
    return [finished(route, ends, price, weights, route.length) for route in found]
