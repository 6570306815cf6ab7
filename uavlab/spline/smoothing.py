"""From a route to a curve that touches nothing: a B-spline over its waypoints, repaired where it cuts a corner."""

import numpy as np

from uavlab import checks
from uavlab.city import City
from uavlab.route import Route
from uavlab.spline.curve import CONTACT, Curve, between
from uavlab.vehicle import UAV

MIDPOINT_ROUNDS = 6
"""Then a leg has 64 parts. What still touches is held by points that stand twice or three times."""


def smooth(
    route: Route,
    city: City,
    uav: UAV,
    *,
    min_clearance: float = 0.0,
    min_height: float = 0.0,
    max_height: float = np.inf,
) -> Curve:
    """A cubic B-spline with the waypoints as control points, repaired until it is as clear as the route.

    It cuts corners. Where the body would then touch an obstacle, or the curve enters a voxel that the planner had
    closed, midpoints are inserted into the legs around, which pull it to them; after six rounds the waypoints around
    are doubled and tripled, which leaves straight lines with corners. Both make turns tighter: see `feasibility`.

    Parameters
    ----------
    route : Route
        At least two waypoints, none of them the same as the one before.
    city : City
    uav : UAV
        Its body is a ball of its diameter.
    min_clearance : float
        Least clearance of the voxels that the curve passes through [m], as the planner was asked for it.
    min_height, max_height : float
        Least and greatest height above ground [m], as the planner was asked for them.

    Returns
    -------
    Curve
        `info["rounds"]` of repair, points `info["inserted"]` and `info["repeated"]`.

    Raises
    ------
    ValueError
        If the route didn't arrive, repeats a waypoint, or isn't clear itself; the message says where.
    """
    checks.instance("route", route, Route)
    checks.instance("city", city, City)
    checks.instance("uav", uav, UAV)
    blocked = city.blocked(min_clearance, min_height=min_height, max_height=max_height)
    refuse_route(route, city, uav, blocked)
    control = route.points
    inserted = repeated = rounds = 0
    while True:
        info = {"rounds": rounds, "inserted": inserted, "repeated": repeated}
        curve = Curve(control, step=uav.diameter / 8, planner=f"{route.planner} + B-spline", info=info)
        wrong = touching_segments(curve, city, uav, blocked)
        if not wrong.any():
            return curve
        before = len(control)
        if rounds < MIDPOINT_ROUNDS:
            control = with_midpoints(control, wrong)
            inserted += len(control) - before
        else:
            control = with_repeated(control, wrong)
            repeated += len(control) - before
        if len(control) == before:
            where = checks.show(curve.at(np.flatnonzero(wrong)[0] + 0.5))
            raise ValueError(f"route passes an obstacle so closely at {where} that not even straight lines are clear")
        rounds += 1


def refuse_route(route: Route, city: City, uav: UAV, blocked: np.ndarray) -> None:
    """`ValueError` if a route can't be smoothed, or isn't clear before."""
    if not route.reached:
        raise ValueError(f"route doesn't arrive ({route.reason}): plan one that does")
    points = route.points
    if len(points) < 2:
        raise ValueError(f"route must have at least two waypoints, got {len(points)}")
    same = np.flatnonzero((np.diff(points, axis=0) == 0).all(axis=1))
    if len(same):
        raise ValueError(f"route repeats waypoint {same[0]} at {checks.show(points[same[0]])}: drop one of the two")
    for leg in range(len(points) - 1):
        if enters(points[leg : leg + 2], city, blocked):
            ends = f"waypoints {leg} {checks.show(points[leg])} and {leg + 1} {checks.show(points[leg + 1])}"
            raise ValueError(
                f"route passes through a closed voxel or leaves the map between {ends}, before it is smoothed: "
                "give the min_clearance that it was planned with"
            )
    radius = uav.diameter / 2
    fine = route.resample(radius / 4)
    distance = between(fine.points, np.zeros(len(fine.points) - 1), city, radius)
    worst = int(np.argmin(distance))
    if distance[worst] < (1 - CONTACT / 2) * radius:
        where = checks.show(fine.points[worst])
        raise ValueError(
            f"route comes within {distance[worst]:.2f} m of an obstacle at {where}, before it is smoothed; "
            f"a body of {uav.diameter:g} m needs {radius:g} m: plan with a larger min_clearance"
        )


def touching_segments(curve: Curve, city: City, uav: UAV, blocked: np.ndarray) -> np.ndarray:
    """Which segments of a curve touch an obstacle or enter a blocked voxel, (S,) bool."""
    radius = uav.diameter / 2
    touches = curve.least_distances(city, radius) < (1 - CONTACT) * radius
    segment = np.minimum(curve.parameter.astype(int), int(curve.parameter[-1]) - 1)
    wrong = np.zeros(segment[-1] + 1, dtype=bool)
    wrong[segment[:-1][touches]] = True
    for number in np.flatnonzero(~wrong):
        within = np.flatnonzero(segment == number)
        wrong[number] = enters(curve.points[within[0] : within[-1] + 2], city, blocked)
    return wrong


def enters(points: np.ndarray, city: City, blocked: np.ndarray) -> bool:
    """Whether a polyline passes through a blocked voxel or leaves the map; by exact traversal."""
    voxels = city.cell_of(points)
    stays = (voxels[:-1] == voxels[1:]).all(axis=1)
    crossed = [city.voxels_along(points[leg : leg + 2])[0] for leg in np.flatnonzero(~stays)]
    index = np.concatenate([voxels[:-1][stays], *crossed])
    outside = ((index < 0) | (index >= city.shape)).any()
    return bool(outside or blocked[tuple(index.T)].any())


def with_midpoints(control: np.ndarray, wrong: np.ndarray) -> np.ndarray:
    """Control points with one more in the middle of each leg that a wrong segment depends on."""
    around = np.pad(wrong, 1)
    legs = around[:-2] | around[1:-1] | around[2:]
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
