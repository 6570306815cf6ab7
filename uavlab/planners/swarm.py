"""Waypoints moved by a swarm: a few free points between start and goal, a curve along them, an optimiser (PSO-BAS 4).

How a route becomes a vector decides more than which optimiser moves it. Here it is a few free points in space, control
points of a cubic B-spline; the swarm begins on the best of some random arcs; and in the end twice as many points on the
same curve are moved one by one. The same refinement makes any route better, also the exact optimum on the grid.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from inspect import signature
from typing import Any

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.optimizers import Result, bas, pso, pso_bas
from uavlab.optimizers.particle_swarm import SWARM
from uavlab.planners.ant_colony import ANTS, ant_colony
from uavlab.planners.curves import PER_SEGMENT, Measure, Task, breaches, costs_of, task_of
from uavlab.planners.encoding import Encoding, sideways_of, space_of
from uavlab.planners.question import Ends, timed
from uavlab.planners.risk_question import (
    MAX_TURN,
    RISK_AHEAD,
    Weights,
    checked_length,
    checked_limits,
    finished,
    flyable_endpoints,
    price_per_cell,
)
from uavlab.risk import RiskMap
from uavlab.route import Route, promises_of
from uavlab.spline.limits import MAX_PITCH

OPTIMIZERS: dict[str, tuple[Callable[..., Result], dict[str, Any]]] = {
    "pso_bas": (pso_bas, {"probes": 5, "decay": 0.98}),
    "pso": (pso, {}),
    "bas": (bas, {}),
    "pso_aco": (pso, {}),
}
"""Each with settings that suit waypoints."""

WAYPOINTS, MOST_WAYPOINTS = 7, 10**4
ARCS = 200
"""Random arcs to begin with, of which the best make the first swarm."""

HUMPS, WIDTH, HEIGHT = 6, 0.2, 3.0
"""Half waves of an arc; how wide they usually are, as a share of the distance; how high [cells]."""

REFINE, CANDIDATES = 0.4, 3
"""Share of the budget for moving more waypoints one by one; of how many curves."""

REFINE_ANTENNA = 0.05
"""First length of the antennae in refinement, as a share of the map."""

ANTS_SHARE = 0.25
"""Of the budget, in "pso_aco"; PSO-BAS only names this hybrid."""

SPACING = 2.0
"""Between the waypoints of a route that is refined [cells]."""


def waypoint_swarm(
    risk_map: RiskMap,
    start: npt.ArrayLike,
    goal: npt.ArrayLike,
    *,
    rng: np.random.Generator | int,
    budget: int = 4000,
    optimizer: str = "pso_bas",
    waypoints: int = WAYPOINTS,
    encoding: str = "points",
    curve: str = "spline",
    arcs: int = ARCS,
    initial: Route | None = None,
    refinement: float = REFINE,
    risk_weight: float = 1.0,
    length_weight: float = 0.0,
    threat_weight: float = 0.0,
    max_turn: float = MAX_TURN,
    max_pitch: float = MAX_PITCH,
    max_length: float | None = None,
    min_clearance: float = 0.0,
    min_height: float | None = None,
    max_height: float = np.inf,
    drift: bool = False,
    **settings: Any,
) -> Route:
    """A route of low cost along a few waypoints that a swarm moves (PSO-BAS section 4).

    A curve that flies where it may not, turns or climbs too much is worse than any that doesn't, the worse the more.

    cost = w_r·∫ r ds/dx + w_l·L + w_s·∫ threat ds/dx along the curve, as for `least_risk`.

    Parameters
    ----------
    risk_map, start, goal, risk_weight, length_weight, threat_weight, max_pitch
        As for `least_risk`.
    max_length, min_clearance, min_height, max_height
        As for `least_risk`.
    rng : numpy.random.Generator or int
        Or a seed for one.
    budget : int
        How many curves are measured in all; the ants of "pso_aco" count as well.
    optimizer : {"pso_bas", "pso", "bas", "pso_aco"}
        Those of `uavlab.optimizers`; "pso_aco" is PSO with a particle on the best route of an ant colony, which takes
        a quarter of the budget.
    waypoints : int
        Free points K between start and goal, from 1 to 10,000.
    encoding : {"points", "planes"}
        What a waypoint is free to do: three numbers, anywhere on the map; or two, sideways and up on one of K vertical
        planes across the way.
    curve : {"spline", "polyline"}
        Whether waypoints are control points of a B-spline, see `uavlab.spline`, or corners.
    arcs : int
        Random arcs to measure first; the swarm begins on the best of them. 0: anywhere on the map.
    initial : Route, optional
        One particle begins near this route.
    refinement : float
        Share of the budget, from 0 to below 1, for `refine` with twice as many waypoints, from the best three curves.
    max_turn : float
        Greatest change of heading [rad], at a corner; on legs shorter than a voxel per length of a voxel, as
        on the grid of `least_risk`.
    drift : bool
        Take the risk where the wreck lands, in each leg's own direction; the ants of "pso_aco" know those of the grid.
    **settings
        For the optimiser, such as `swarm=10` or `as_printed=True`.

    Returns
    -------
    Route
        The curve as short straight legs, in "pso_aco" the ants' route if no curve is better; `cost` as for
        `least_risk`; `info["control"]`, its control points or corners [m]; `info["evaluations"]`, and
        `info["refined"]`, how many of them for refinement; `info["history"]`, the least cost after each of them,
        infinite until a curve keeps the limits; `info["iterations"]`, how many had been made at the end of each
        iteration of the swarm; `info["elapsed"]` [s]. Where none keeps the limits `reached` is False, and `reason` says
        what the best does wrong.

    Raises
    ------
    ValueError
        If `risk_map`, `start`, `goal`, `risk_weight`, `length_weight`, `threat_weight`, `max_turn`, `max_pitch`,
        `max_length`, `min_clearance`, `min_height` or `max_height` is what `least_risk` refuses. If `rng` is no
        generator and no seed. If `budget` doesn't cover arcs, one swarm and refinement. If `optimizer`, `encoding` or
        `curve` is unknown. If `waypoints` is below 1 or above 10,000, or `arcs` below 0. If `initial` is no Route, or
        doesn't lead from start to goal. If `refinement` is not from 0 to below 1. If a setting is out of the
        optimiser's range.
    TypeError
        If the optimiser doesn't take one of `settings`.

    See Also
    --------
    refine : The last part alone, for any route.
    least_risk : The least cost on the grid.
    uavlab.optimizers.pso_bas : What moves the waypoints.

    Examples
    --------
    >>> from uavlab.planners import least_risk, optimality_gap, waypoint_swarm
    >>> from uavlab.risk import CAMPUS_FLIGHT, reference_campus
    >>> campus = reference_campus()
    >>> route = waypoint_swarm(campus, *CAMPUS_FLIGHT, rng=1, budget=2000)
    >>> route.reached, len(route.info["control"])
    (True, 17)
    >>> abs(optimality_gap(route, least_risk(campus, *CAMPUS_FLIGHT))) < 0.2
    True
    """
    began = time.perf_counter()
    rng = checks.generator("rng", rng)
    checks.one_of("optimizer", optimizer, OPTIMIZERS)
    checks.one_of("encoding", encoding, ("points", "planes"))
    checks.one_of("curve", curve, ("spline", "polyline"))
    swarm = checked_swarm(optimizer, settings)
    waypoints, arcs = checks.whole("waypoints", waypoints, 1, MOST_WAYPOINTS), checks.whole("arcs", arcs, 0)
    budget, refinement = checks.whole("budget", budget, 1), checked_refinement(refinement)
    if initial is not None:
        checks.instance("initial", initial, Route)
    limits = checked_limits(risk_map, max_turn, max_pitch, min_clearance, min_height, max_height)
    weights = Weights.checked(risk_weight, length_weight, threat_weight, drift)
    longest = checked_length(max_length)
    price = price_per_cell(risk_map, weights)
    ends = flyable_endpoints(risk_map, start, goal, limits)
    task = task_of(risk_map, ends, price, weights, limits, curve == "spline", longest)
    space = space_of(task, waypoints, encoding)
    ants, left, last = shares(budget, optimizer, arcs, refinement, swarm)
    measure = Measure(task)
    if ants:
        walked = ant_colony(
            risk_map, start, goal, rng=rng, budget=ants, risk_weight=risk_weight, length_weight=length_weight,
            threat_weight=threat_weight, max_turn=max_turn, max_pitch=max_pitch, max_length=max_length,
            min_clearance=min_clearance, min_height=min_height, max_height=max_height, drift=drift,
        )  # fmt: skip
        measure.note(walked.info["history"], walked.info["iterations"])
        initial = walked if walked.reached else initial
    begin = None if initial is None else near(task, initial.en_route, risk_map, waypoints, "initial")
    first = first_vectors(measure, space, arcs, begin, rng)
    found = searched(measure, space, optimizer, first[:swarm], left, rng, settings)
    if last:
        move_finer(measure, space, found, last, rng)
    route = finished(route_of(measure, risk_map, f"{optimizer} waypoints"), ends, price, weights, longest)
    if ants and walked.cost < route.cost:
        route = replace(walked, planner=route.planner, info={"control": walked.points})
    info = {
        **route.info,
        "expanded": measure.made,
        "evaluations": measure.made,
        "refined": last,
        "history": measure.history,
        "iterations": np.array(measure.iterations),
        "elapsed": time.perf_counter() - began,
    }
    if not route.reached:
        reason = f"the best of {measure.made} curves from {checks.show(start)} to {checks.show(goal)} {route.reason}"
        return Route.none(route.planner, reason, **info)
    return replace(route, info=info)


def checked_swarm(optimizer: str, settings: dict[str, Any]) -> int:
    """How many particles the settings ask for; a setting that the optimiser doesn't take is refused."""
    search, _ = OPTIMIZERS[optimizer]
    own, taken = (named_only(function) for function in (waypoint_swarm, search))
    for name in settings:
        if name not in taken:
            raise TypeError(
                f"waypoint_swarm has no argument {name!r}; it takes {', '.join(own)}, and for optimizer={optimizer!r} "
                + ", ".join(setting for setting in taken if setting != "start")
            )
    return checks.whole("swarm", settings.get("swarm", SWARM if "swarm" in taken else 1), least=1)


def named_only(function: Callable[..., Any]) -> list[str]:
    """Names of the arguments that are given by name only."""
    parameters = signature(function).parameters.values()
    return [parameter.name for parameter in parameters if parameter.kind is parameter.KEYWORD_ONLY]


def searched(
    measure: Measure,
    space: Encoding,
    optimizer: str,
    first: np.ndarray,
    budget: int,
    rng: np.random.Generator,
    settings: dict[str, Any],
) -> Result:
    """What an optimiser finds from the first vectors (N, D) on."""
    search, own = OPTIMIZERS[optimizer]
    if len(first):
        own = {**own, "start": first}
    if optimizer == "pso_bas":
        own = {**own, "block": len(space.axes)}
    before = measure.made
    found = search(lambda vectors: measure(space.control(vectors)), space.bounds, budget, rng, **{**own, **settings})
    measure.iterations += (before + found.iterations).tolist()
    return found


def refine(
    route: Route,
    risk_map: RiskMap,
    *,
    rng: np.random.Generator | int,
    budget: int = 4000,
    risk_weight: float = 1.0,
    length_weight: float = 0.0,
    threat_weight: float = 0.0,
    max_turn: float = MAX_TURN,
    max_pitch: float = MAX_PITCH,
    max_length: float | None = None,
    min_clearance: float | None = None,
    min_height: float | None = None,
    max_height: float | None = None,
    drift: bool | None = None,
) -> Route:
    """A better curve near a route: control points of a B-spline, two voxels apart, moved one by one while it gains.

    Not bound to the grid, it usually costs less than the exact optimum there. It keeps what the route promised.

    Parameters
    ----------
    route : Route
        From the centre of a voxel to that of another; of a planner.
    risk_map, risk_weight, length_weight, threat_weight, max_turn, max_pitch
        As for `waypoint_swarm`.
    max_length, min_clearance, min_height, max_height, drift : optional
        As well; by default what the route promised, the least height at least the map's. `max_length=numpy.inf` lets
        it grow.
    rng : numpy.random.Generator or int
        Or a seed for one.
    budget : int
        How many curves are measured, at least 4.

    Returns
    -------
    Route
        As of `waypoint_swarm`; the route itself, with its cost, where no curve that was found is better and keeps the
        limits.

    Raises
    ------
    ValueError
        If `route` is no Route, doesn't arrive, or takes off or lands to another `min_height`. If `risk_map` is no
        RiskMap. If the route's ends, `risk_weight`, `length_weight`, `threat_weight`, `max_turn`, `max_pitch`,
        `max_length`, `min_clearance`, `min_height` or `max_height` are what `least_risk` refuses. If `rng` is no
        generator and no seed. If `budget` is below 4.

    See Also
    --------
    waypoint_swarm : Finds a route first.
    least_risk : The least cost on the grid, a good one to begin with.

    Examples
    --------
    >>> from uavlab.planners import least_risk, refine
    >>> from uavlab.risk import CAMPUS_FLIGHT, reference_campus
    >>> campus = reference_campus()
    >>> exact = least_risk(campus, *CAMPUS_FLIGHT)
    >>> curve = refine(exact, campus, rng=1, budget=400)
    >>> curve.cost < exact.cost, curve.length < exact.length
    (True, True)
    """
    began = time.perf_counter()
    rng = checks.generator("rng", rng)
    checks.instance("route", route, Route)
    checks.instance("risk_map", risk_map, RiskMap)
    if not route.reached or len(route.points) < 2:
        raise ValueError(f"route must lead from a start to a goal, it doesn't: {route.reason or 'no leg'}")
    budget = checks.whole("budget", budget, least=4)
    kept = promises_of(route, min_clearance=min_clearance, min_height=min_height, max_height=max_height)
    if min_height is None:
        kept["min_height"] = max(kept["min_height"], risk_map.min_height)
    limits = checked_limits(
        risk_map, max_turn, max_pitch, kept["min_clearance"], kept["min_height"], kept["max_height"]
    )
    longest = route.max_length if max_length is None else checked_length(max_length)
    drift = RISK_AHEAD in route.priced if drift is None else drift
    weights = Weights.checked(risk_weight, length_weight, threat_weight, drift)
    price = price_per_cell(risk_map, weights)
    ends = flyable_endpoints(risk_map, route.points[0], route.points[-1], limits)
    refuse_other_heights(route, ends)
    task = task_of(risk_map, ends, price, weights, limits, True, longest)
    measure, route = Measure(task), route.en_route
    count = max(int(route.length / risk_map.city.cell / SPACING), 2) + 1
    one_by_one(measure, near(task, route, risk_map, count - 2, "route"), PER_SEGMENT // 2, budget, rng)
    better = route_of(measure, risk_map, f"{route.planner} + refined")
    cost = cost_of(task, route, risk_map)
    history = np.minimum(measure.history, cost)
    info = {"expanded": budget, "evaluations": budget, "refined": budget, "history": history}
    if better.cost < cost or cost == np.inf:
        route, cost = better, better.cost
    route = replace(route, cost=cost, info={**route.info, **info})
    return timed(finished(route, ends, price, weights, longest), began)


def refuse_other_heights(route: Route, ends: Ends) -> None:
    """`ValueError` if a route takes off or lands to another height than the one that is asked for."""
    if (len(ends.takeoff), len(ends.landing)) != (route.takeoff, route.landing):
        raise ValueError(
            f"route must begin and end, but for take-off and landing, at min_height={ends.airspace.min_height:g} m "
            f"above ground: plan it with that, or give the min_height that it was planned with, {route.min_height:g} m"
        )


def checked_refinement(refinement: float) -> float:
    share = checks.number("refinement", refinement)
    if not 0 <= share < 1:
        raise ValueError(f"refinement must be a share of the budget, from 0 to below 1, got {refinement!r}")
    return share


def shares(budget: int, optimizer: str, arcs: int, refinement: float, swarm: int) -> tuple[int, int, int]:
    """How many evaluations go to ants, to the swarm and to refinement."""
    ants = max(int(ANTS_SHARE * budget), ANTS) if optimizer == "pso_aco" else 0
    last = int(refinement * budget)
    left = budget - ants - arcs - last
    if left < max(swarm, 4) or 0 < last < 6 * CANDIDATES:
        raise ValueError(
            f"budget must leave at least {max(swarm, 4)} evaluations for the swarm, {6 * CANDIDATES} for refinement; "
            f"of {budget} there go {ants} to ants, {arcs} to arcs, {last} to refinement, {left} are left"
        )
    return ants, left, last


def first_vectors(
    measure: Measure, space: Encoding, arcs: int, initial: np.ndarray | None, rng: np.random.Generator
) -> np.ndarray:
    """Where the swarm begins (N, D): near the initial route (K + 2, 3) if there is one, then on the best arcs."""
    first = space.vectors(arcs_between(measure.task, len(space.anchors), arcs, rng))
    if arcs:
        first = first[np.argsort(measure(space.control(first)))]
    return first if initial is None else np.concatenate([space.vectors(initial[None]), first])


def move_finer(measure: Measure, space: Encoding, found: Result, budget: int, rng: np.random.Generator) -> None:
    """Move twice as many points one by one: half of the budget for the best few curves, half for the best of those."""
    task, per_segment = measure.task, PER_SEGMENT // 2
    ends = np.concatenate([found.best[None], found.swarm[1:CANDIDATES]])  # a lone beetle may have left its best
    each = budget // 2 // len(ends)
    moved = [one_by_one(measure, task.finer(control), per_segment, each, rng) for control in space.control(ends)]
    best, _ = min(moved, key=lambda control_and_cost: control_and_cost[1])
    one_by_one(measure, best, per_segment, budget - each * len(ends), rng)


def arcs_between(task: Task, waypoints: int, count: int, rng: np.random.Generator) -> np.ndarray:
    """Random curves (N, K + 2, 3): sums of half waves sideways, the more of them the narrower; and one upwards."""
    along = np.linspace(0, 1, waypoints + 2)
    straight = task.source + along[:, None] * (task.target - task.source)
    distance = np.linalg.norm(task.target - task.source)
    order = np.arange(1, HUMPS + 1)
    waves = np.sin(np.pi * order[:, None] * along)
    sideways = (rng.standard_normal((count, HUMPS)) * WIDTH * distance / order) @ waves
    upwards = np.abs(rng.standard_normal((count, 1))) * HEIGHT @ waves[:1]
    curves = straight + sideways[..., None] * sideways_of(task) + upwards[..., None] * (0.0, 0.0, 1.0)
    return np.clip(curves, 0.0, np.array(task.sky.closed.shape) - 1e-9)


def near(task: Task, route: Route, risk_map: RiskMap, waypoints: int, name: str) -> np.ndarray:
    """Points with both ends (K + 2, 3) of a curve near a route, from the task's start to its goal."""
    points = (route.points - risk_map.city.origin) / risk_map.city.cell
    if len(points) < 2 or np.abs(points[[0, -1]] - (task.source, task.target)).max() > 0.5 + 1e-9:
        raise ValueError(f"{name} must lead from start to goal, within a voxel of both, got {route!r}")
    control = task.nearest(points, waypoints + 2)
    control[0], control[-1] = task.source, task.target
    return control


def cost_of(task: Task, route: Route, risk_map: RiskMap) -> float:
    """What a route costs; infinite if it is somewhere where it may not be, or too long."""
    points = (route.points - risk_map.city.origin) / risk_map.city.cell
    cost, shut, _, longer = (float(values[0]) for values in costs_of(task.sky, points[None]))
    return np.inf if shut > 0 or longer > 0 else cost


def one_by_one(
    measure: Measure, control: np.ndarray, per_segment: int, budget: int, rng: np.random.Generator
) -> tuple[np.ndarray, float]:
    """Points with both ends (K + 2, 3), the inner ones moved one at a time by a greedy beetle, and what they cost."""
    space = space_of(measure.task, len(control) - 2, "points")
    found = bas(
        lambda vectors: measure(space.control(vectors), per_segment), space.bounds, budget, rng,
        start=space.vectors(control[None]), greedy=True, decay=None, block=3, antenna=REFINE_ANTENNA,
    )  # fmt: skip
    return space.control(found.best[None])[0], found.value


def route_of(measure: Measure, risk_map: RiskMap, planner: str) -> Route:
    """The best curve as a route; not reached if it breaks a limit."""
    city, task = risk_map.city, measure.task
    line = task.lines(measure.best[None], measure.per_segment)[0]
    broken = breaches(task, line, city.cell) if measure.least >= task.unflyable else ""
    info = {"control": city.origin + measure.best * city.cell}
    cost = np.inf if broken else float(measure.least)
    return Route(city.origin + line * city.cell, planner, not broken, broken, cost, info)
