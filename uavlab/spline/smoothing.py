"""From a route to a curve that touches nothing: a B-spline over its waypoints, repaired where it cuts a corner."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from uavlab import checks
from uavlab.city import City
from uavlab.city.bounds import Bounds, bounds_of, legs_keep
from uavlab.route import Route, promises_of
from uavlab.spline.curve import CONTACT, Curve, contact_distance
from uavlab.vehicle import UAV

MIDPOINT_ROUNDS = 6
"""Then a leg has 64 parts. What still touches is held by points that stand twice or three times."""


def smooth(
    route: Route,
    city: City,
    uav: UAV,
    *,
    min_clearance: float | None = None,
    min_height: float | None = None,
    max_height: float | None = None,
    safe_height: float | None = None,
) -> Curve:
    """A cubic B-spline with the waypoints as control points, repaired until it keeps what the route keeps.

    It cuts corners. Where the body would then touch an obstacle, or the curve come too near to one, into a no-fly zone,
    too low or too high, midpoints are inserted into the legs around, which pull it to them; after six rounds the
    waypoints around are doubled and tripled, which leaves straight lines with corners. Both make turns tighter: see
    `feasibility`. A route that turns around an obstacle no farther away than `min_clearance` leaves no other way: plan
    it with a little more.

    Parameters
    ----------
    route : Route
        At least two waypoints, none of them the same as the one before. Between its vertical take-off or landing and
        the rest the curve has a corner, to hover at: the waypoint stands three times.
    city : City
    uav : UAV
        Its body is a ball of its diameter.
    min_clearance : float, optional
        Least distance to obstacles [m], all along but for take-off and landing, which need room only for the body; by
        default the route's.
    min_height, max_height, safe_height : float, optional
        Least and greatest height above ground [m] between take-off and landing, all along, and least height above
        roofs; by default the route's.

    Returns
    -------
    Curve
        It promises the same.
        `info["rounds"]` of repair, points `info["inserted"]` and `info["repeated"]` by it.

    Raises
    ------
    ValueError
        If `route`, `city` or `uav` is of another kind. If `route` didn't arrive, repeats a waypoint, comes so near to
        an obstacle that the body touches it, or doesn't keep `min_clearance`, `min_height`, `max_height`, `safe_height`
        before it is smoothed (the message says where). If `min_clearance`, `min_height` or `safe_height` is negative,
        or `max_height` not above `min_height`.

    See Also
    --------
    uavlab.planners.shortcut : Leaves out needless waypoints first.
    feasibility : Whether a UAV can fly the curve.

    Examples
    --------
    >>> from uavlab.city import table1_city
    >>> from uavlab.planners import astar, shortcut
    >>> from uavlab.spline import smooth
    >>> from uavlab.vehicle import LIGHT_QUADROTOR
    >>> city = table1_city()
    >>> route = shortcut(astar(city, (5, 5, 30), (95, 95, 30), min_clearance=2.0), city)
    >>> curve = smooth(route, city, LIGHT_QUADROTOR)
    >>> curve, curve.clearance(city) >= 2.0
    (<Curve by A* + shortcut + B-spline: 138.2 m, 14 control points>, True)
    """
    checks.instance("route", route, Route)
    checks.instance("city", city, City)
    checks.instance("uav", uav, UAV)
    promises = promises_of(
        route, min_clearance=min_clearance, min_height=min_height, max_height=max_height, safe_height=safe_height
    )
    bounds = bounds_of(city, **promises)
    refuse_route(route, city, uav, bounds)
    bounds = bounds._replace(keep=max(bounds.keep, contact_distance(uav.diameter) / city.cell))
    before, after = route.points[: route.takeoff], route.points[len(route.points) - route.landing :]
    way = route.en_route.points
    control = np.concatenate([way[:1]] * 2 * bool(route.takeoff) + [way] + [way[-1:]] * 2 * bool(route.landing))
    inserted = repeated = rounds = 0
    while True:
        info = {"rounds": rounds, "inserted": inserted, "repeated": repeated}
        curve = Curve(control, step=uav.diameter / 8, planner=f"{route.planner} + B-spline", info=info)
        wrong = wrong_segments(curve, city, bounds)
        if not wrong.any():
            return replace(
                curve,
                control=np.concatenate([before, control, after]),
                takeoff=len(before) + 1 if len(before) else 0,
                landing=len(after) + 1 if len(after) else 0,
                **promises,
            )
        count = len(control)
        if rounds < MIDPOINT_ROUNDS:
            control = with_midpoints(control, wrong)
            inserted += len(control) - count
        else:
            control = with_repeated(control, wrong)
            repeated += len(control) - count
        if len(control) == count:
            where = checks.show(curve.at(np.flatnonzero(wrong)[0] + 0.5))
            raise ValueError(f"route passes an obstacle so closely at {where} that not even straight lines are clear")
        rounds += 1


def refuse_route(route: Route, city: City, uav: UAV, bounds: Bounds) -> None:
    """`ValueError` if a route can't be smoothed, or doesn't keep the bounds before."""
    if not route.reached:
        raise ValueError(f"route doesn't arrive ({route.reason}): plan one that does")
    points = route.points
    if len(points) < 2:
        raise ValueError(f"route must have at least two waypoints, got {len(points)}")
    same = np.flatnonzero((np.diff(points, axis=0) == 0).all(axis=1))
    if len(same):
        raise ValueError(f"route repeats waypoint {same[0]} at {checks.show(points[same[0]])}: drop one of the two")
    legs = np.arange(len(points) - 1)
    vertical = (legs < route.takeoff) | (legs >= len(legs) - route.landing)
    cells, nothing = (points - city.origin) / city.cell, np.zeros(len(legs))
    kept = legs_keep(bounds, cells, nothing, nothing)
    kept |= vertical & legs_keep(bounds_of(city), cells, nothing, nothing)
    if not kept.all():
        leg = int(np.argmin(kept))
        ends = f"waypoints {leg} {checks.show(points[leg])} and {leg + 1} {checks.show(points[leg + 1])}"
        raise ValueError(
            f"route comes too near to an obstacle or a zone, too low or too high, or leaves the map between {ends}, "
            "before it is smoothed: give the min_clearance and heights that it was planned with"
        )
    radius = uav.diameter / 2
    distance = city.segment_distance(points[:-1], points[1:], at_most=radius)
    worst = int(np.argmin(distance))
    if distance[worst] < (1 - CONTACT / 2) * radius:
        fine = Route(points[worst : worst + 2]).resample(radius / 4).points
        where = checks.show(fine[np.argmin(city.distance(fine, radius))])
        raise ValueError(
            f"route comes within {distance[worst]:.2f} m of an obstacle at {where}, before it is smoothed; "
            f"a body of {uav.diameter:g} m needs {radius:g} m: plan with a larger min_clearance"
        )


def wrong_segments(curve: Curve, city: City, bounds: Bounds) -> np.ndarray:
    """Which segments of a curve don't keep the bounds, (S,) bool."""
    points = (curve.points - city.origin) / city.cell
    kept = legs_keep(bounds, points, curve.sagitta / city.cell, curve.rise / city.cell)
    segment = np.minimum(curve.parameter.astype(int), int(curve.parameter[-1]) - 1)
    wrong = np.zeros(segment[-1] + 1, dtype=bool)
    wrong[segment[:-1][~kept]] = True
    return wrong


def with_midpoints(control: np.ndarray, wrong: np.ndarray) -> np.ndarray:
    """Control points with one more in the middle of each leg that a wrong segment depends on."""
    around = np.pad(wrong, 1)
    legs = (around[:-2] | around[1:-1] | around[2:]) & (np.diff(control, axis=0) != 0).any(axis=1)
    middle = (control[:-1] + control[1:])[legs] / 2
    return np.insert(control, np.flatnonzero(legs) + 1, middle, axis=0)


def with_repeated(control: np.ndarray, wrong: np.ndarray) -> np.ndarray:
    """Control points where those at the ends of wrong segments stand once more, at most three times."""
    first = np.concatenate([[True], (np.diff(control, axis=0) != 0).any(axis=1)])
    group = np.cumsum(first) - 1  # those that stand together
    here = np.zeros(group[-1] + 1, dtype=bool)
    here[group[:-1][wrong]] = here[group[1:][wrong]] = True
    more = np.flatnonzero(first)[here & (np.bincount(group) < 3)]
    return np.insert(control, more, control[more], axis=0)
