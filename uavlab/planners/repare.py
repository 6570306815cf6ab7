"""REPARE: A* with a zone around buildings whose price follows the forces (REPARE Algorithm 1, Eqs 7-16).

The paper's pseudo-code has no step that takes the cheapest node, no parents, and never uses the resultant force that it
computes. Here it is A* with a price per metre, 1 + ω·O_risk: O_risk = 1 where an obstacle is nearer than D_min, and ω
grows with the repulsion there, with a disturbance that pushes towards the wall, and with the load. Where the wind is
steady the zone reaches farther on the side that it blows to. When the disturbance changes in flight, the rest of
the route is planned again.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.city import City
from uavlab.city.extent import locked
from uavlab.city.kept import kept_for_city
from uavlab.compiled import compilable
from uavlab.planners.astar import cheapest_route, penalty_zone
from uavlab.planners.potential_field import push_at
from uavlab.planners.question import Airspace, checked_price, endpoints, nearest_allowed, timed
from uavlab.resilience import gust_force, kind_and_speed, load_class, payload_of, resilience_level, safe_distance
from uavlab.route import Route
from uavlab.vehicle import LIGHT_QUADROTOR, UAV
from uavlab.weather import Weather, Wind, grounded_by
from uavlab.weather.wind import why_grounded, wind_of

PENALTY = 2.0
"""ω₀: what a metre in the zone costs more, before any force."""


class Conditions(NamedTuple):
    """What a load and a disturbance mean for planning."""

    name: str
    grounded: str
    """Why it may not fly; empty if it may."""
    safe_distance: float
    """D_min [m]."""
    wind: tuple[float, ...] | None
    """Mean wind [m/s]; None where only its class is known, so that it may come from any side."""
    push: float
    """Drag of the gusts over the thrust that is left against them, |F_dist|."""
    load_ratio: float
    """Weight over thrust, λ."""

    def __repr__(self) -> str:
        grounded = f", grounded: {self.grounded}" if self.grounded else ""
        return f"<Conditions {self.name}: D_min {self.safe_distance:g} m{grounded}>"


def repare(
    city: City,
    start: npt.ArrayLike,
    goal: npt.ArrayLike,
    *,
    load: str | float = "light",
    disturbance: Disturbance | Callable[[float], Disturbance] = "mild",
    uav: UAV = LIGHT_QUADROTOR,
    reading: str = "table",
    mean_offset: npt.ArrayLike = (0.0, 0.0, 0.0),
    penalty: float = PENALTY,
    force_weight: float = 1.0,
    load_weight: float = 1.0,
    zone: str = "ball",
    interval: float = 1.0,
    min_height: float = 0.0,
    max_height: float = np.inf,
    as_printed: bool = False,
    record: bool = False,
) -> Route:
    """Plan a route that keeps D_min where it can, and replan in flight when the disturbance changes.

    cost = Σ d·(1 + ω·O_risk), see `repare_price`.

    Parameters
    ----------
    city : City
    start, goal : (3,) arrays
        Positions [m].
    load : {"dead", "light", "moderate", "heavy"} or float
        Class of the payload (REPARE Table 3), or the payload [kg].
    disturbance : {"none", "mild", "moderate", "heavy"}, Wind, Weather, or callable
        A class; or what the air does, of which the direction of its mean counts; or a function of the time in flight
        [s] that returns one of these.
    uav : UAV
        Its payload is replaced by the load.
    reading : {"table", "physical"}
        Of D_min, see `uavlab.resilience.safe_distance`.
    mean_offset : (2,) or (3,) array
        μ, where a steady wind holds the UAV, from its route [m]: the zone is wider by it before walls that the wind
        blows to. It stays as it is when the disturbance changes.
    penalty : float
        ω₀, at least 0.
    force_weight, load_weight : float
        θ_F and θ_G of Eq. 16, at least 0.
    zone : {"ball", "ring"}
        See `penalty_zone`.
    interval : float
        How often the disturbance is looked at in flight [s], above 0; at the next waypoint after it.
    min_height, max_height : float
        As for `astar` [m].
    as_printed : bool
        Eq. 13 with the 26 points of the outer ring and a fixed ω₀: forces and mean offset aren't used, and the route
        depends on the direction of travel.
    record : bool
        Keep the order of expansion of the last plan in `info["order"]`.

    Returns
    -------
    Route
        `cost` is Σ d·(1 + ω·O_risk) [m]; after replanning, of the last plan. `info["expanded"]`, `info["elapsed"]` [s],
        `info["safe_distance"]` [m], and `info["plans"]`: when, where and for what it was planned. Conditions that
        ground the UAV give `reached` False with the reason, and the points flown until then.

    Raises
    ------
    ValueError
        If `city` is no City. If `start` or `goal` is not three finite numbers, lies off the map, in an obstacle or a
        no-fly zone, nearer to an obstacle than D_min, or above `max_height`. If both lie in one voxel. If `load` is no
        class, negative or too heavy to lift. If `disturbance` is no class, Wind or Weather. If `reading` or `zone` is
        unknown. If `mean_offset` is not two or three finite numbers. If `penalty`, `force_weight` or `load_weight` is
        negative or not finite. If `interval` is not above 0. If `uav` is no UAV. If `as_printed` or `record` is neither
        True nor False. If `min_height` is negative or not finite. If `max_height` is not above `min_height`.

    See Also
    --------
    repare_price : The price that it plans with.
    flight_conditions : What load and disturbance mean.
    hazard_astar : With a price that falls smoothly.

    Examples
    --------
    >>> from uavlab.city import table1_city
    >>> from uavlab.planners import repare
    >>> city = table1_city()
    >>> repare(city, (5, 5, 30), (95, 95, 30), load="light", disturbance="mild")
    <Route by REPARE: 150.7 m, 131 waypoints>
    >>> repare(city, (5, 5, 30), (95, 95, 30), load="heavy", disturbance="heavy").reason
    'grounded: heavy load in heavy disturbance (REPARE Table 3)'
    """
    began = time.perf_counter()
    as_printed, record = checks.flag("as_printed", as_printed), checks.flag("record", record)
    interval = checks.positive_number("interval", interval)
    offset, weights, zone = checked_terms(mean_offset, penalty, force_weight, load_weight, zone)
    widening = (0.0, 0.0, 0.0) if as_printed else offset
    if callable(disturbance):
        checks.function("disturbance", disturbance, "disturbance(time)")

    def conditions_at(clock: float) -> Conditions:
        observed = disturbance(clock) if callable(disturbance) else disturbance
        return flight_conditions(load, observed, uav, reading=reading, clock=clock)

    now = conditions_at(0.0)
    airspace = Airspace(city, 0.0, min_height, max_height, radius=uav.diameter / 2)
    ends = endpoints(airspace, start, goal)
    if now.grounded:
        info = {"expanded": 0, "plans": [], "safe_distance": now.safe_distance}
        return timed(Route.none("REPARE", f"grounded: {now.grounded}", **info), began)
    for name, point, node in (("start", start, ends.source), ("goal", goal, ends.target)):
        refuse_swallowed(city, name, point, node, now.safe_distance, widening)

    def plan(here: npt.ArrayLike, given: Conditions) -> Route:
        source = int(city.code_of(city.cell_of(here)))
        if as_printed:
            ring = penalty_zone(city, given.safe_distance, penalty=weights[0], zone="ring")
            return cheapest_route(
                city, source, ends.target, airspace.blocked, *checked_price(city, ring),
                heuristic="euclidean", as_printed=True, record=record,
            )  # fmt: skip
        price = cached_price(city, given, widening, weights, zone)
        return cheapest_route(city, source, ends.target, airspace.blocked, price, cheapest=1.0, record=record)

    route = plan(city.center_of(city.index_of(ends.source)), now)
    if callable(disturbance) and route.reached:
        route = replanned(route, now, plan, conditions_at, uav.cruise_speed, interval)
    else:
        place = tuple(route.points[:1].ravel().tolist())
        route = as_repare(route, route.points, [Plan(0.0, place, now.name, now.safe_distance)])
    return timed(ends.added_to(route, priced="REPARE's zone"), began)


def replanned(
    route: Route,
    now: Conditions,
    plan: Callable[[npt.ArrayLike, Conditions], Route],
    conditions_at: Callable[[float], Conditions],
    speed: float,
    interval: float,
) -> Route:
    """Fly a route; where the conditions have changed at the first waypoint after an interval, plan the rest anew.

    In flight a UAV, or its goal, may find itself nearer to a wall than the new D_min: then the dear zone drives it out
    as soon as it can, and lets it in as late as it can.
    """
    goal = route.points[-1]
    plans = [Plan(0.0, tuple(route.points[0].tolist()), now.name, now.safe_distance)]
    flown, clock = [route.points[0]], 0.0
    expanded = route.info["expanded"]
    while (flown[-1] != goal).any():
        ahead = int(np.searchsorted(route.distance[1:-1], speed * interval - 1e-9)) + 1
        flown.extend(route.points[1 : ahead + 1])
        clock += float(route.distance[ahead]) / speed
        route = replace(route, points=route.points[ahead:])
        then = conditions_at(clock)
        if then == now or (flown[-1] == goal).all():
            continue
        now = then
        plans.append(Plan(clock, tuple(flown[-1].tolist()), now.name, now.safe_distance))
        if now.grounded:
            reason = f"grounded after {clock:.1f} s at {checks.show(flown[-1])}: {now.grounded}"
            return replace(as_repare(route, flown, plans), reached=False, reason=reason, cost=np.inf)
        route = plan(flown[-1], now)
        expanded += route.info["expanded"]
    return as_repare(replace(route, info=route.info | {"expanded": expanded}), flown, plans)


def refuse_swallowed(
    city: City,
    name: str,
    point: npt.ArrayLike,
    node: int,
    safe_distance: float,
    mean_offset: tuple[float, ...],
) -> None:
    """`ValueError` if a start or goal lies in the zone; it says by how much and which point would do."""
    index = tuple(city.index_of(node))
    if city.clearance[index] == np.inf:  # there are no obstacles
        return
    center = city.center_of(index)
    widened = float(city.clearance[index] - city.segment_distance(center, center + mean_offset))
    short = safe_distance + widened - float(city.clearance[index])
    if short > 1e-9 * city.cell:
        outside = city.clearance_along(mean_offset, at_most=safe_distance) >= safe_distance - 1e-9 * city.cell
        instead = "no voxel of the map keeps it"
        if outside.any():
            instead = nearest_allowed(city, city.center_of(index), outside)
        needed = f"D_min of {safe_distance:g} m" + (f" and {widened:.2f} m of mean offset" if widened else "")
        raise ValueError(
            f"{name} {checks.show(point)} is {city.clearance[index]:.2f} m from the nearest obstacle, {short:.2f} m "
            f"nearer than {needed}; {instead}"
        )


class Plan(NamedTuple):
    """When, where and for what a route was planned."""

    time: float
    place: tuple[float, ...]
    conditions: str
    safe_distance: float


def as_repare(route: Route, points: npt.ArrayLike, plans: list[Plan]) -> Route:
    """The route with the points flown, REPARE's name and its plans."""
    info = route.info | {"plans": plans, "safe_distance": plans[-1].safe_distance}
    return replace(route, points=np.asarray(points), planner="REPARE", info=info)


Disturbance = str | Wind | Weather


def flight_conditions(
    load: str | float,
    disturbance: Disturbance,
    uav: UAV = LIGHT_QUADROTOR,
    *,
    reading: str = "table",
    clock: float = 0.0,
) -> Conditions:
    """What a load and a disturbance mean for planning.

    push = F_gust/√(T² − (m g)²), λ = m g/T, with the payload in m.

    Parameters
    ----------
    load, disturbance, uav, reading
        As for `repare`, but no function.
    clock : float
        Time in flight [s], at least 0, for messages.

    Returns
    -------
    Conditions
        `name`, `grounded`, `safe_distance` [m], `wind`, `push` and `load_ratio`.

    Raises
    ------
    ValueError
        If `load` is no class, negative or too heavy to lift. If `disturbance` is no class, Wind or Weather. If `uav` is
        no UAV. If `reading` is unknown. If `clock` is negative or not finite.

    See Also
    --------
    repare_price : Takes them.
    uavlab.resilience.safe_distance : D_min alone.

    Examples
    --------
    >>> from uavlab.planners import flight_conditions
    >>> from uavlab.weather import Wind
    >>> flight_conditions("light", "mild")
    <Conditions light load, mild disturbance: D_min 3.5 m>
    >>> flight_conditions("light", Wind(mean=(5, 0)))
    <Conditions light load, wind 5.0 m/s (mild disturbance): D_min 3.5 m>
    >>> flight_conditions("heavy", "heavy").grounded
    'heavy load in heavy disturbance (REPARE Table 3)'
    """
    checks.instance("uav", uav, UAV)
    clock = checks.not_negative_number("clock", clock)
    loaded = uav.loaded(payload_of(load))
    kind, speed = kind_and_speed(disturbance, f"disturbance after {clock:.1f} s" if clock else "disturbance")
    load_name = load if isinstance(load, str) else load_class(load)
    carried = f"{load} load" if isinstance(load, str) else f"load of {load:g} kg"
    wind = None
    if isinstance(disturbance, str):
        name, grounded = f"{carried}, {kind} disturbance", grounded_by(loaded, Weather(forecast_wind=speed))
    else:
        name, wind = f"{carried}, wind {speed:.1f} m/s ({kind} disturbance)", wind_of(disturbance).mean
        if isinstance(disturbance, Weather):
            grounded = grounded_by(loaded, disturbance)
        else:
            grounded = why_grounded(loaded, disturbance)
    if resilience_level(load_name, kind) == "grounded":
        grounded = (f"{load_name} load in {kind} disturbance (REPARE Table 3)",)
    force, reserve = gust_force(loaded, speed), float(loaded.horizontal_reserve())
    return Conditions(
        name, "; ".join(grounded), safe_distance(load, disturbance, reading=reading, uav=uav), wind, force / reserve,
        loaded.weight / loaded.thrust,
    )  # fmt: skip


def repare_price(
    city: City,
    conditions: Conditions,
    *,
    mean_offset: npt.ArrayLike = (0.0, 0.0, 0.0),
    penalty: float = PENALTY,
    force_weight: float = 1.0,
    load_weight: float = 1.0,
    zone: str = "ball",
) -> np.ndarray:
    """Price of a metre, 1 + ω(x)·O_risk(x), kept for the next query in the same conditions.

    ω = ω₀·(1 + |F_rep| + θ_F·max(0, −F_dist·n) + θ_G·λ) / F_tra, n away from the nearest wall, |F_tra| = 1 (conic),
    |F_rep| = k_rep (1/D − 1/D_min)/D² with k_rep = D_min³/4. O_risk = 1 where D < D_min anywhere on the way from the
    voxel to where the mean offset μ holds the UAV, so before every wall that the wind blows to. All forces are numbers:
    F_dist is the drag of the gusts over the thrust left against them, λ the weight over the thrust.

    Parameters
    ----------
    city : City
    conditions : Conditions
        D_min, the push of the gusts and the load ratio λ. Where the wind's direction is unknown the push counts as
        if it went towards the wall.
    mean_offset : (2,) or (3,) array
        μ [m].
    penalty, force_weight, load_weight : float
        ω₀, θ_F and θ_G, at least 0.
    zone : {"ball", "ring"}

    Returns
    -------
    (nx, ny, nz) array
        For `astar(..., price=...)` and `shortcut(..., price=...)`; not to be written to.

    Raises
    ------
    ValueError
        If `city` is no City, or `conditions` are none of `flight_conditions`. If `penalty`, `force_weight` or
        `load_weight` is negative or not finite. If `mean_offset` is not two or three finite numbers. If `zone` is
        unknown.

    See Also
    --------
    repare : Plans with it.
    penalty_zone : With a fixed ω.

    Examples
    --------
    >>> from uavlab.city import table1_city
    >>> from uavlab.planners import flight_conditions, repare_price
    >>> city = table1_city()
    >>> price = repare_price(city, flight_conditions("light", "mild"))
    >>> price[[9, 8, 7, 6], 30, 30].round(1)  # 0.5, 1.5, 2.5 and 3.5 m from a wall
    array([151.6,   8.2,   5. ,   1. ])
    """
    checks.instance("city", city, City)
    checks.instance("conditions", conditions, Conditions)
    return cached_price(city, conditions, *checked_terms(mean_offset, penalty, force_weight, load_weight, zone))


def checked_terms(
    mean_offset: npt.ArrayLike, penalty: float, force_weight: float, load_weight: float, zone: str
) -> tuple[tuple[float, ...], tuple[float, ...], str]:
    """The mean offset μ, the weights ω₀, θ_F and θ_G, and the shape of the zone."""
    named = {"penalty": penalty, "force_weight": force_weight, "load_weight": load_weight}
    weights = tuple(checks.not_negative_number(name, weight) for name, weight in named.items())
    return checks.three("mean_offset", mean_offset), weights, checks.one_of("zone", zone, ("ball", "ring"))


@kept_for_city(4)
def cached_price(
    city: City,
    now: Conditions,
    mean_offset: tuple[float, ...],
    weights: tuple[float, ...],
    zone: str,
) -> np.ndarray:
    penalty, force_weight, load_weight = weights
    along = city.clearance_along(mean_offset, at_most=now.safe_distance)
    widened = along < now.safe_distance - 1e-9 * city.cell
    reach = now.safe_distance + np.subtract(city.clearance, along, out=np.zeros(city.shape), where=widened)
    near = np.minimum(city.clearance, reach)
    blown = np.asarray(now.push)
    if now.wind is not None:
        blown = now.push * city.towards_wall(now.wind) / max(float(np.linalg.norm(now.wind)), 1e-9)
    omega = penalty * forces_at(near, now.safe_distance, city.cell, force_weight * blown, load_weight * now.load_ratio)
    return locked(penalty_zone(city, reach, penalty=omega, zone=zone))


@compilable
def forces_at(clearance, safe_distance, cell, blown, loaded):
    """(1 + |F_rep| + θ_F·max(0, −F_dist·n) + θ_G·λ)/F_tra at a clearance [m], that of half a cell at the least."""
    away = np.maximum(clearance, cell / 2)
    return 1 + push_at(away, safe_distance**3 / 4, safe_distance, safe_distance) + blown + loaded
