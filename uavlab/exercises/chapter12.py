"""Exercises of chapter 12, B-splines: a limit without a unit, curvature, waypoints, braking, long legs, a wide swing.

A hint says which mistake the answers look like and why it is one. Mistakes are recognised by what they answer, not
by how they are written.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial
from typing import Any

import numpy as np

from uavlab.city import City
from uavlab.exercises.hints import alike, each_alike, recognised, recognised_value
from uavlab.exercises.kinds import Quiz, asks_for, asks_for_value, number, numbers
from uavlab.spline import Curve, cubic_bspline, feasibility, greatest_speed
from uavlab.vehicle import RISK_QUADROTOR

same = partial(each_alike, same=partial(alike, relative=1e-7, absolute=1e-9))


exercise_1 = Quiz(
    right="b",
    because="0.8 per voxel of 10 m is 0.08 1/m, and 64 · 0.08 = 5.1 m/s². On voxels of 1 m it is ten times as much.",
    wrong={
        "a": "Both numbers are below 1, but 1 of what? Work out the radius of each planner's sharpest bend in metres.",
        "c": "You take 0.8 per voxel for 0.8 1/m on both maps. On how many metres does B's curve turn?",
        "d": "Smaller voxels don't make a bend gentler: the same turn happens on fewer metres. What is v²κ for A?",
    },
)


@asks_for(numbers(lambda first, *_: first.shape[:1], "a curvature for each point"), unchanged=True)
def exercise_2(curvature: Callable[..., Any]) -> str:
    """12.2: the curvature of a curve in three dimensions, by any parameter."""
    rng = np.random.default_rng(1110)
    questions = [tuple(rng.normal(0, size, (2, 6, 3))) for size in (0.5, 1.0, 3.0)]
    given = [np.asarray(curvature(*question), dtype=float) for question in questions]
    if same(given, [bent(*question) for question in questions]):
        return ""
    return recognised(given, CURVATURE_MISTAKES, questions, same) or (
        "Try it on a circle of radius 5, r = 5·(cos t, sin t, 0): your answer must be 0.2 everywhere, also when t runs "
        f"twice as fast. For first = {np.round(questions[0][0][0], 2)} and second = {np.round(questions[0][1][0], 2)} "
        f"yours is {given[0][0]:.4f}."
    )


def size(vectors: np.ndarray) -> np.ndarray:
    return np.linalg.norm(vectors, axis=1)


def bent(first: np.ndarray, second: np.ndarray, power: float = 3.0) -> np.ndarray:
    return size(np.cross(first, second)) / size(first) ** power


SQUARED = "You use |r′|², a sum of squares: that is already the second power. Which power of it is |r′|³?"
CURVATURE_MISTAKES: list[tuple[Callable[[np.ndarray, np.ndarray], np.ndarray], str]] = [
    (
        lambda first, second: bent(first, second, 4 / 3),
        "The exponent of the sum of squares is the wrong way up: it isn't 2/3. What does a circle of 5 m give?",
    ),
    (
        lambda first, second: bent(first, second, 2 / 3),
        "The exponent is the wrong way up: 2/3 of |r′|. What does a circle of 5 m give that is run through twice as "
        "fast?",
    ),
    (lambda first, second: bent(first, second, 6.0), SQUARED),
    (
        lambda first, second: bent(first, second, 2.0),
        "You divide by |r′|². Run through the same circle twice as fast: |r′| doubles and |r″| becomes four times as "
        "large. By which power must one divide, for κ to stay the same?",
    ),
    (
        lambda first, second: size(second),
        "That is |r″|: the curvature only where the curve runs one metre per unit of the parameter. Here it doesn't.",
    ),
    (
        lambda first, second: size(second) / size(first) ** 2,
        "You count all of r″. The part of it along the curve makes it faster and doesn't bend it.",
    ),
    (
        lambda first, second: size(np.cross(first, second)),
        "That is the numerator alone.",
    ),
    (
        lambda first, second: bent(first * (1, 1, 0), second * (1, 1, 0)),
        "You leave out the height: that is the curvature of the ground plan.",
    ),
    (
        lambda first, second: np.cross(first, second)[:, 2] / size(first[:, :2]) ** 3,
        "That is the curvature of the ground plan, with a sign for left and right. This curve also climbs.",
    ),
    (
        lambda first, second: np.abs((first * second).sum(axis=1)) / size(first) ** 3,
        "You use the scalar product of r′ and r″: it is largest where the curve is straight and gets faster.",
    ),
    (lambda first, second: 1 / bent(first, second), "That is the radius. The curvature is one over it."),
]


@asks_for(numbers(lambda waypoints: waypoints.shape, "a control point for each waypoint"), unchanged=True)
def exercise_3(control_points: Callable[..., Any]) -> str:
    """12.3: the control points of a B-spline with phantom ends that passes through waypoints."""
    rng = np.random.default_rng(1120)
    questions = [(rng.uniform(-20, 20, (count, axes)),) for count, axes in ((6, 3), (4, 3), (3, 2), (9, 2))]
    given = [np.asarray(control_points(*question), dtype=float) for question in questions]
    waypoints = [question[0] for question in questions]
    knots = [cubic_bspline(points, per_segment=1) for points in given]
    if same(knots, waypoints):
        return ""
    if hint := recognised(given, CONTROL_MISTAKES, questions, same):
        return hint
    if all(np.allclose(k[1:-1], w[1:-1]) for k, w in zip(knots, waypoints, strict=True)):
        return (
            "In between your curve passes through the waypoints, but it doesn't begin or end where it should. "
            "Which equation have the first and the last point, with phantom ends?"
        )
    off = np.linalg.norm(knots[0] - waypoints[0], axis=1)
    return (
        f"At its knots your curve passes the six waypoints of the first question at {off.round(3)} m. Write the "
        "equations of three waypoints down, each with the points that it contains."
    )


def solved(waypoints: np.ndarray, *, sixth: float = 6.0, first: float = 4.0, neighbours: bool = True) -> np.ndarray:
    """Control points by equations that may be wrong: `first` of 4 leaves the ends without phantom points."""
    count = len(waypoints)
    weights = (4 * np.eye(count) + np.eye(count, k=1) + np.eye(count, k=-1)) / sixth
    weights[[0, -1], [0, -1]] = first / sixth
    if not neighbours:
        weights[0, 1] = weights[-1, -2] = 0.0
    return np.linalg.solve(weights, waypoints)


def extrapolated(waypoints: np.ndarray) -> np.ndarray:
    return 2 * waypoints - cubic_bspline(waypoints, per_segment=1)


CONTROL_MISTAKES: list[tuple[Callable[[np.ndarray], np.ndarray], str]] = [
    (
        lambda waypoints: waypoints,
        "Those are the waypoints themselves: the curve passes them by, as in the chapter.",
    ),
    (
        lambda waypoints: cubic_bspline(waypoints, per_segment=1),
        "You work out where the curve with the waypoints as control points is: a smoothing, and the wrong way round. "
        "The waypoints are known, the control points are what is asked for.",
    ),
    (
        solved,
        "Your first and last equation lack a point: a neighbour outside is taken for 0. Where is the curve with "
        "phantom ends when it begins?",
    ),
    (
        lambda waypoints: solved(waypoints, first=5.0),
        "You take each end twice, as its own neighbour. With a phantom point 2P₀ − P₁ before the first, what does the "
        "equation of the first say?",
    ),
    (
        lambda waypoints: solved(waypoints, sixth=1.0, first=1.0, neighbours=False),
        "Your points in between are too near to the origin: the three weights add up to 6. What are they divided by?",
    ),
    (
        lambda waypoints: solved(waypoints, sixth=1.0),
        "The weights 1, 4, 1 add up to 6. What are they divided by?",
    ),
    (
        extrapolated,
        "You push each point out by what the curve misses, once. That moves the neighbours' knots as well: all points "
        "have to be found together.",
    ),
]


@asks_for(numbers(lambda distance, *_: distance.shape, "a speed for each point"), unchanged=True)
def exercise_4(speeds: Callable[..., Any]) -> str:
    """12.4: the fastest speeds along a curve, from rest to rest, with limits on speed and acceleration."""
    questions = [bends(seed) for seed in range(5)]
    given = [np.asarray(speeds(*question), dtype=float) for question in questions]
    if same(given, [driven(*question) for question in questions]):
        return ""
    return recognised(given, SPEED_MISTAKES, questions, same) or wrong_somewhere(given, questions)


def wrong_somewhere(given: list[np.ndarray], questions: list[tuple[Any, ...]]) -> str:
    """A hint by what speeds violate, or that they are too slow."""
    for values, (distance, allowed, acceleration) in zip(given, questions, strict=True):
        if not np.isfinite(values).all() or (values < -1e-9).any():
            return "Some of your speeds are negative or not numbers. Is a square root taken of something below 0?"
        if np.abs(values[[0, -1]]).max() > 1e-6:
            return "The UAV begins and ends at rest."
        over = np.flatnonzero(values > allowed + 1e-6)
        if len(over):
            place, speed, most = (array[over[0]] for array in (distance, values, allowed))
            return f"At {place:.1f} m your speed is {speed:.2f} m/s, but at most {most:.2f} there."
        rate = np.diff(values**2) / (2 * np.diff(distance))
        hard = np.flatnonzero(np.abs(rate) > acceleration * (1 + 1e-6))
        if len(hard):
            verb = "accelerates" if rate[hard[0]] > 0 else "brakes"
            return (
                f"After {distance[hard[0]]:.1f} m your UAV {verb} with {abs(rate[hard[0]]):.2f} m/s², "
                f"{acceleration:.2f} are allowed."
            )
    values, (distance, *_) = given[0], questions[0]
    slow = int(np.argmax(driven(*questions[0]) - values))
    return (
        f"That can be flown, but not as fast as possible: at {distance[slow]:.1f} m more than {values[slow]:.2f} m/s."
    )


def bends(seed: int) -> tuple[np.ndarray, np.ndarray, float]:
    """A curve with three bends and a limit of 16 m/s, points at uneven distances."""
    rng = np.random.default_rng(1130 + seed)
    distance = np.concatenate([[0.0], np.cumsum(rng.uniform(0.2, 1.0, 150))])
    allowed = np.full(len(distance), 16.0)
    for place, slowest in zip((20.0, 45.0, 70.0), rng.uniform(2.0, 6.0, 3), strict=True):
        allowed = np.minimum(allowed, slowest * np.exp(np.square((distance - place) / 3.0)))
    return distance, allowed, float(rng.uniform(2.0, 4.0))


def driven(
    distance: np.ndarray,
    allowed: np.ndarray,
    acceleration: float,
    *,
    rest: bool = True,
    forward: bool = True,
    backward: bool = True,
    twice: float = 2.0,
    linear: bool = False,
) -> np.ndarray:
    """Speeds by rules that may be wrong."""
    power = 1 if linear else 2
    speed = allowed.astype(float) ** power
    if rest:
        speed[[0, -1]] = 0.0
    gain = twice * acceleration * np.diff(distance)
    for i in range(1, len(speed) if forward else 0):
        speed[i] = min(speed[i], speed[i - 1] + gain[i - 1])
    for i in range(len(speed) - 2 if backward else -1, -1, -1):
        speed[i] = min(speed[i], speed[i + 1] + gain[i])
    return np.asarray(speed ** (1 / power))


SPEED_MISTAKES: list[tuple[Callable[..., np.ndarray], str]] = [
    (
        partial(driven, backward=False),
        "Your UAV accelerates well and never brakes: before a bend its speed falls at once. Braking, seen backwards, "
        "is what?",
    ),
    (partial(driven, forward=False), "Your UAV brakes in time, but after a bend it has its full speed at once."),
    (
        partial(driven, forward=False, backward=False),
        "That is the speed allowed at each point: it jumps, where the UAV can't.",
    ),
    (partial(driven, rest=False), "The UAV begins and ends at rest."),
    (partial(driven, twice=1.0), "Your UAV accelerates with half of what it may. Look at v₂² − v₁² once more."),
    (
        partial(driven, linear=True, twice=1.0),
        "You add a·s to the speed. That is metres per second times metres per second: what grows by 2as?",
    ),
    (
        partial(driven, linear=True),
        "You add 2as to the speed itself. What is it that grows by 2as?",
    ),
]


LEG, NEAR, FAST = 134.9, 0.7, 15.0
"""Shortest legs of a right angle that RISK_QUADROTOR can fly at 15 m/s [m]."""


@asks_for_value(number("the length of the legs [m]"))
def exercise_5(leg: float) -> str:
    """12.5: the shortest equal legs of a right angle that can be flown at 15 m/s."""
    value = float(leg)
    if abs(value - LEG) <= NEAR:
        return ""
    if hint := recognised_value(value, LEG_MISTAKES, relative=0.012):
        return hint
    if not value > 0:
        return "A leg has a length above 0."
    if value > LEG:
        return f"With legs of {value:.1f} m the corner can be flown at 15 m/s. But shorter ones do, too."
    return f"With legs of {value:.1f} m the corner can't be flown at 15 m/s: look at what `fastest` says."


LEG_MISTAKES: list[tuple[float, str]] = [
    (112.36, "That is where the bank reaches 30°. Which other limit has drag in it, and binds above 13 m/s?"),
    (92.65, "That is the tilt of 35° without drag. At 15 m/s how much of the tilt does the drag take?"),
    (47.7, "That is the radius of the bend. By Eq. 10 how many radii long is a leg of a right angle?"),
    (39.7, "That is v²/(g tan 30°), a radius, and by the bank alone. The question is for legs, and for all limits."),
    (187.5, "Those are the legs for 16 m/s, the UAV's cruise speed."),
    (42.8, "Those are the legs of a corner of 45°. A right angle turns by twice as much."),
]

SWING, KEEP, MOST = 12.0, 1.0, 12
START, GOAL = (2.0, 10.0, 10.0), (70.0, 78.0, 10.0)


@cache
def street() -> City:
    """A street of 12 m that turns by a right angle."""
    occupied = np.ones((80, 80, 20), dtype=bool)
    occupied[:76, 4:16] = occupied[64:76, 4:] = False
    return City(occupied, name="A street with a corner")


@asks_for_value(numbers((None, 3), "an array of control points (N, 3)"))
def exercise_6(control: np.ndarray) -> str:
    """12.6: control points that take the corner of a street at 12 m/s."""
    points = np.asarray(control, dtype=float)
    if not np.isfinite(points).all():
        return "Some of your coordinates are not finite."
    if not 2 <= len(points) <= MOST:
        return f"You have {len(points)} control points; 2 to {MOST} are allowed."
    for end, wanted, name in ((points[0], START, "first"), (points[-1], GOAL, "last")):
        if not np.allclose(end, wanted, atol=1e-6):
            return f"The {name} control point has to be {wanted}, yours is {tuple(end.round(2).tolist())}."
    curve = Curve(points)
    report = feasibility(curve, street(), RISK_QUADROTOR, speed=SWING, min_clearance=KEEP)
    if report.feasible:
        return ""
    x, y, _ = report["clearance"].place
    if not report["clearance"].met:
        if report["clearance"].worst == 0:
            where = "the inner wall" if x < 70 and y > 10 else "the outer wall"
            return f"Your curve touches {where}, near ({x:.0f}, {y:.0f}). Draw it over the street."
        return f"Near ({x:.0f}, {y:.0f}) your curve comes within {report['clearance'].worst:.2f} m of a wall; keep 1 m."
    speed = greatest_speed(curve, RISK_QUADROTOR)
    if not report["curvature"].met:
        x, y, _ = report["curvature"].place
        return (
            f"All walls are 1 m away, but your curve can be flown at {speed:.1f} m/s only. It is sharpest near "
            f"({x:.0f}, {y:.0f}). Where is there room to begin the bend earlier, or to end it later?"
        )
    failing = ", ".join(limit.name for limit in report.limits if not limit.met)
    return f"Walls and bank are kept, but not: {failing}. Is the curve level, and without a needless wave?"
