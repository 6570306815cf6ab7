"""The artificial potential field: the goal pulls, obstacles push, and the UAV goes where the sum points (REPARE 2.3.2).

It looks only at where it is. That makes it simple, lets it keep a distance to walls, and traps it wherever pull and
push cancel: in front of a wall across the way, in a notch. Not arriving is found out and said, with the place.
"""

from __future__ import annotations

import math
import time
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.city import City
from uavlab.city.voxels import is_free_line
from uavlab.compiled import compilable, compiled
from uavlab.planners.grid import BOXES, LENGTHS, MOVES, blocked_around
from uavlab.planners.question import Airspace, endpoints, timed
from uavlab.planners.shortcut import distance
from uavlab.route import Route

ATTRACTIONS = ("conic", "quadratic")
OBSTACLES = ("voxels", "surface")
CLOSEST = 0.05
"""The push of a wall that is touched would be infinite; it is taken at this distance [m]."""

MOST_STEPS = 10**8
"""More take all of the memory."""

WINDOW = 1000
"""A continuous walk that is within two steps of where it was so many steps ago trembles on the spot.

After 100 steps it may yet creep on along a wall: in Table 1's city up to 1 % of the routes that then look stuck arrive.
"""


class Field(NamedTuple):
    """What pulls and pushes, as numbers for compiled code; lengths in metres from the map's origin."""

    occupied: np.ndarray
    closed: np.ndarray  # where it may not fly; obstacles, and what doesn't push
    cell: float
    goal: np.ndarray
    conic: bool
    pull: float
    push: float
    reach: float
    nearest_only: bool


def potential_field(
    city: City,
    start: npt.ArrayLike,
    goal: npt.ArrayLike,
    *,
    attraction: str = "conic",
    obstacles: str = "voxels",
    moves: str = "lattice",
    pull: float = 1.0,
    push: float = 5.0,
    reach: float = 5.0,
    step: float | None = None,
    max_steps: int = 5000,
    min_height: float = 0.0,
    max_height: float = np.inf,
    record: bool = False,
) -> Route:
    """Follow the resultant of attraction and repulsion from the start (REPARE Eqs 14-16).

    F = F_tra + F_rep as vectors. F_tra = −k (x − x_goal), "quadratic", or of constant size k, "conic".
    F_rep = Σ k_rep (1/D − 1/R)/D² ∇D over obstacles nearer than R. Printed are sizes without directions, which
    can't steer, and a range D_min that may differ from R, see `repulsion`.

    Parameters
    ----------
    city : City
    start, goal : (3,) arrays
        Positions [m]. On the lattice the route goes from the centre of the start's voxel to that of the goal's.
    attraction : {"conic", "quadratic"}
        Of constant size, or growing with the distance.
    obstacles : {"voxels", "surface"}
        Every occupied voxel in range pushes, from its nearest point; or only the nearest one.
    moves : {"lattice", "continuous"}
        To one of the 26 neighbours, the one nearest to the direction of F that is legal; or a step along F.
    pull, push : float
        k_tra and k_rep, above 0. The defaults give REPARE Table 2's lengths on its map.
    reach : float
        R [m], above 0: obstacles farther away don't push.
    step : float, optional
        Length of a continuous step [m]; half a cell by default.
    max_steps : int
        After so many, at least 1 and at most 10⁸, it gives up.
    min_height, max_height : float
        As for `astar` [m]. They close voxels, as no-fly zones do, and don't push.
    record : bool
        Keep the forces in `info["attraction"]` and `info["repulsion"]`, (N, 3) at the waypoints.

    Returns
    -------
    Route
        `cost` is the length; `info["expanded"]`, its steps, and `info["elapsed"]` [s]. If it is trapped, flies into an
        obstacle or gives up, `reached` is False, `reason` says where, the points are the way until there, and
        `info["goal"]` is where it should have ended.

    Raises
    ------
    ValueError
        If `city` is no City. If `start` or `goal` is not three finite numbers, lies off the map, in an obstacle or a
        no-fly zone, or above `max_height`. If both lie in one voxel. If `attraction`, `obstacles` or `moves` is
        unknown. If `pull`, `push`, `reach` or `step` is not above 0. If `max_steps` is below 1 or above 10⁸. If
        `record` is neither True nor False. If `min_height` is negative or not finite. If `max_height` is not above
        `min_height`.

    See Also
    --------
    potential_forces : The field, for drawing.
    repulsion : Size of one push.
    repare : A* whose price follows such forces, so that nothing traps it.

    References
    ----------
    Khatib, Real-time obstacle avoidance for manipulators and mobile robots, 1986.

    Examples
    --------
    >>> from uavlab.city import table1_city
    >>> from uavlab.planners import potential_field
    >>> city = table1_city()
    >>> potential_field(city, (5, 5, 30), (5, 95, 30))
    <Route by potential field: 90.0 m, 91 waypoints>
    >>> potential_field(city, (5, 5, 30), (95, 95, 30)).reason
    'stuck in a local minimum at (67.5, 57.5, 30.5), 47.2 m from the goal: it goes back and forth there'
    """
    began = time.perf_counter()
    checks.instance("city", city, City)
    checks.one_of("moves", moves, ("lattice", "continuous"))
    step = checks.positive_number("step", city.cell / 2 if step is None else step)
    max_steps, record = checks.whole("max_steps", max_steps, 1, MOST_STEPS), checks.flag("record", record)
    airspace = Airspace(city, 0.0, min_height, max_height)
    ends = endpoints(airspace, start, goal)
    first, last = city.index_of([ends.source, ends.target])
    begin, aim = city.center_of([first, last])
    if moves == "continuous":
        begin = begin if ends.takeoff else np.asarray(start, dtype=float)
        aim = aim if ends.landing else np.asarray(goal, dtype=float)
    field = field_of(city, aim, attraction, obstacles, pull, push, reach)._replace(closed=airspace.blocked)
    if moves == "lattice":
        nodes, outcome = walk_lattice(field, first, last, max_steps)
        points = city.center_of(nodes)
    else:
        points, outcome = walk_freely(field, begin - city.origin, step, max_steps)
        points = points + city.origin
    info: dict = {"expanded": len(points) - 1}
    if record:
        pulls, pushes, _ = forces_at(field, points - city.origin)
        info |= {"attraction": pulls, "repulsion": pushes}
    place = checks.show(points[-1])
    reason = REASONS[outcome].format(place=place, left=np.linalg.norm(points[-1] - aim), steps=max_steps)
    cost = np.inf if reason else Route(points).length
    if reason:
        info["goal"] = np.asarray(goal, dtype=float)
    route = Route(points, "potential field", reached=not reason, reason=reason, cost=cost, info=info)
    return timed(ends.added_to(route), began)


ARRIVED, TRAPPED, CIRCLES, CRASHED, FORBIDDEN, GAVE_UP = range(6)
REASONS = (
    "",
    "stuck in a local minimum at {place}, {left:.1f} m from the goal: no move goes along the force",
    "stuck in a local minimum at {place}, {left:.1f} m from the goal: it goes back and forth there",
    "flies into an obstacle at {place}, {left:.1f} m from the goal: the push is too weak or the step too long",
    "flies where it may not at {place}, {left:.1f} m from the goal: zones and limits of height don't push",
    "gave up after {steps} steps at {place}, {left:.1f} m from the goal",
)


def potential_forces(
    city: City,
    points: npt.ArrayLike,
    goal: npt.ArrayLike,
    *,
    attraction: str = "conic",
    obstacles: str = "voxels",
    pull: float = 1.0,
    push: float = 5.0,
    reach: float = 5.0,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The field at points, for drawing: attraction, repulsion and potential.

    F = −∇U, with U_tra = k d ("conic") or k d²/2 ("quadratic"), d the distance to the goal, and
    U_rep = Σ k_rep (1/D − 1/R)²/2. It doesn't hold inside of an obstacle and up to 5 cm from it: there U is cut off.

    Parameters
    ----------
    city : City
    points : (..., 3) array
        Where to look [m].
    goal : (3,) array
        What pulls [m].
    attraction, obstacles, pull, push, reach
        As for `potential_field`.

    Returns
    -------
    attraction, repulsion : (..., 3) arrays
        F_tra and F_rep.
    potential : (...) array
        U_tra + U_rep.

    Raises
    ------
    ValueError
        If `city` is no City. If `points` or `goal` haven't three finite coordinates. If `attraction` or `obstacles` is
        unknown. If `pull`, `push` or `reach` is not above 0.

    See Also
    --------
    potential_field : Follows the forces.
    repulsion : Size of one push.

    Examples
    --------
    >>> from uavlab.city import table1_city
    >>> from uavlab.planners import potential_forces
    >>> attraction, repulsion, potential = potential_forces(table1_city(), (8, 30.5, 30.5), (95, 30.5, 30.5))
    >>> f"pull {attraction[0]:.2f}, push {repulsion[0]:.2f}"  # eastwards; the wall is 2 m to the east
    'pull 1.00, push -6.87'
    """
    checks.instance("city", city, City)
    at, aim = checks.vectors(points=points, goal=goal)
    if at.shape[-1] != 3 or aim.shape != (3,):
        raise ValueError(f"points must have shape (..., 3) and goal (3,), got {at.shape} and {aim.shape}")
    field = field_of(city, aim, attraction, obstacles, pull, push, reach)
    pulls, pushes, potentials = forces_at(field, np.ascontiguousarray(at.reshape(-1, 3) - city.origin))
    return pulls.reshape(at.shape), pushes.reshape(at.shape), potentials.reshape(at.shape[:-1])


def field_of(
    city: City, goal: np.ndarray, attraction: str, obstacles: str, pull: float, push: float, reach: float
) -> Field:
    """The arguments, checked."""
    for name, value, known in (("attraction", attraction, ATTRACTIONS), ("obstacles", obstacles, OBSTACLES)):
        checks.one_of(name, value, known)
    named = {"pull": pull, "push": push, "reach": reach}
    pull, push, reach = (checks.positive_number(name, number) for name, number in named.items())
    return Field(
        city.occupied, city.occupied, city.cell, goal - city.origin, attraction == "conic",
        pull, push, reach, obstacles == "surface",
    )  # fmt: skip


def repulsion(distance: npt.ArrayLike, push: float, reach: float, *, safe_distance: float | None = None) -> np.ndarray:
    """Size of the push of an obstacle, k_rep (1/D − 1/R)/D² within R (REPARE Eq. 15).

    Parameters
    ----------
    distance : float or array
        D [m], above 0.
    push, reach : float
        k_rep and R [m], above 0.
    safe_distance : float, optional
        D_min [m], to which the printed form reaches instead of R. If D_min < R the push jumps there; if D_min > R it
        is negative in between, and the obstacle attracts.

    Returns
    -------
    float or array
        F_rep, the shape of `distance`; 0 beyond the range.

    Raises
    ------
    ValueError
        If `distance`, `push`, `reach` or `safe_distance` is not finite and above 0.

    See Also
    --------
    potential_forces : Of all obstacles, with directions.

    Examples
    --------
    >>> from uavlab.planners import repulsion
    >>> repulsion([1, 2, 4, 6], push=5.0, reach=5.0).round(3)
    array([4.   , 0.375, 0.016, 0.   ])
    >>> repulsion([4, 6], push=5.0, reach=5.0, safe_distance=8.0).round(3)  # as printed: at 6 m it attracts
    array([ 0.016, -0.005])
    """
    distances = checks.numbers("distance", distance)
    checks.positive("distance", distances)
    push, reach = checks.positive_number("push", push), checks.positive_number("reach", reach)
    end = reach if safe_distance is None else checks.positive_number("safe_distance", safe_distance)
    return push_at(distances, push, reach, end)


@compilable
def push_at(distance, push, reach, end):
    """`repulsion` of arguments that are right, up to the distance `end`."""
    return (distance <= end) * (push * (1 / distance - 1 / reach) / distance**2) + 0.0  # beyond it 0, and not −0


@compiled
def put_forces(field, point, pull, push):
    """Write attraction (3,) and repulsion (3,) at a point (3,) [m]; their potential."""
    cell, reach = field.cell, field.reach
    left = 0.0
    for a in range(3):
        pull[a] = field.goal[a] - point[a]
        push[a] = 0.0
        left += pull[a] * pull[a]
    left = math.sqrt(left)
    strength = field.pull
    if field.conic:
        strength = field.pull / left if left > 0 else 1.0
    for a in range(3):
        pull[a] *= strength
    potential = field.pull * left if field.conic else 0.5 * field.pull * left * left
    pushed = 0.0
    nearest = reach
    nx, ny, nz = field.occupied.shape
    low, high = within(point[1], reach, cell, ny)
    bottom, top = within(point[2], reach, cell, nz)
    for a in range(*within(point[0], reach, cell, nx)):
        x = point[0] - min(max(point[0], a * cell), (a + 1) * cell)  # from the voxel's nearest point
        for b in range(low, high):
            y = point[1] - min(max(point[1], b * cell), (b + 1) * cell)
            for c in range(bottom, top):
                if not field.occupied[a, b, c]:
                    continue
                z = point[2] - min(max(point[2], c * cell), (c + 1) * cell)
                apart = max(math.sqrt(x * x + y * y + z * z), CLOSEST)
                if apart >= nearest:
                    continue
                if field.nearest_only:
                    nearest = apart
                    push[:] = 0.0
                    pushed = 0.0
                size = field.push * (1 / apart - 1 / reach) / apart**3
                push[0] += x * size
                push[1] += y * size
                push[2] += z * size
                pushed += 0.5 * field.push * (1 / apart - 1 / reach) ** 2
    return potential + pushed


@compiled
def within(x, reach, cell, count):
    """The first of so many voxels along an axis that are within reach of a coordinate, and where they end."""
    return max(math.floor((x - reach) / cell), 0), min(math.floor((x + reach) / cell) + 1, count)


@compiled
def put_resultant(field, point, pull, push, resultant):
    """Write the sum of both forces (3,) at a point [m]; its size."""
    put_forces(field, point, pull, push)
    squared = 0.0
    for a in range(3):
        resultant[a] = pull[a] + push[a]
        squared += resultant[a] * resultant[a]
    return math.sqrt(squared)


@compiled
def forces_at(field, points):
    """Both forces at each of the points (M, 3) [m from the map's corner], and their potential."""
    pulls, pushes, potentials = np.empty((len(points), 3)), np.empty((len(points), 3)), np.empty(len(points))
    for m in range(len(points)):
        potentials[m] = put_forces(field, points[m], pulls[m], pushes[m])
    return pulls, pushes, potentials


@compiled
def walk_lattice(field, start, goal, most):
    """Voxels (N, 3) from the start along the legal moves that point best along the force, and how it ended."""
    nodes = np.empty((most + 1, 3), np.int64)
    nodes[0] = start
    seen = np.zeros(field.occupied.shape, np.bool_)
    pull, push, resultant, here = np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    for n in range(most + 1):
        i, j, k = nodes[n]
        if i == goal[0] and j == goal[1] and k == goal[2]:
            return nodes[: n + 1], ARRIVED
        if seen[i, j, k]:  # the force has no memory: it would go round for ever
            return nodes[: n + 1], CIRCLES
        if n == most:
            break
        seen[i, j, k] = True
        for a in range(3):
            here[a] = (nodes[n, a] + 0.5) * field.cell
        size = put_resultant(field, here, pull, push, resultant)
        around = blocked_around(field.closed, i, j, k)
        best, most_along = -1, 1e-12 * size
        for move in range(26):
            if not around & BOXES[move]:
                di, dj, dk = MOVES[move]
                along = (resultant[0] * di + resultant[1] * dj + resultant[2] * dk) / LENGTHS[move]
                if along > most_along * (1 + 1e-12):
                    best, most_along = move, along
        if best < 0:
            return nodes[: n + 1], TRAPPED
        for a in range(3):
            nodes[n + 1, a] = nodes[n, a] + MOVES[best, a]
    return nodes, GAVE_UP


@compiled
def walk_freely(field, start, step, most):
    """Points (N, 3) from the start by steps along the force, and how it ended."""
    points = np.empty((most + 1, 3))
    points[0] = start
    top, pull, push, resultant = np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    for axis in range(3):  # the border itself is outside
        top[axis] = (field.occupied.shape[axis] - 1e-6) * field.cell
    for n in range(most + 1):
        here = points[n]
        if distance(here, field.goal) == 0.0:
            return points[: n + 1], ARRIVED
        if n >= WINDOW and distance(here, points[n - WINDOW]) < 2 * step:
            return points[: n + 1], CIRCLES
        if n == most:
            break
        if distance(here, field.goal) <= step:
            points[n + 1] = field.goal
        else:
            put_resultant(field, here, pull, push, resultant)
            for axis in range(3):  # along the border of the map, where the force points out of it
                if (here[axis] <= 0 and resultant[axis] < 0) or (here[axis] >= top[axis] and resultant[axis] > 0):
                    resultant[axis] = 0.0
            size = math.sqrt(resultant[0] ** 2 + resultant[1] ** 2 + resultant[2] ** 2)
            if size < 1e-9 * field.pull:
                return points[: n + 1], TRAPPED
            for axis in range(3):
                points[n + 1, axis] = min(max(here[axis] + resultant[axis] * (step / size), 0.0), top[axis])
        for axis in range(3):
            pull[axis], push[axis] = here[axis] / field.cell, points[n + 1, axis] / field.cell
        if not is_free_line(field.occupied, pull, push):
            return points[: n + 1], CRASHED
        if not is_free_line(field.closed, pull, push):
            return points[: n + 1], FORBIDDEN
    return points, GAVE_UP
