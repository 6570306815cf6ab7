"""Exercises of chapter 12: other ways to the answer pass; typical mistakes fail, each with a hint of its own."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.optimize import linprog

from uavlab.exercises import chapter12, check
from uavlab.spline import curvature as curvature_of_uavlab


def by_gram(first, second):
    """κ by scalar products alone, without a vector product."""
    a, b, c = ((u * v).sum(axis=1) for u, v in ((first, first), (second, second), (first, second)))
    return np.sqrt(a * b - c**2) / a**1.5


def across(first, second):
    return np.linalg.norm(np.cross(first, second), axis=1)


def level(vectors):
    return vectors * (1, 1, 0)


def by_scipy(waypoints):
    """From SciPy's natural spline: at a knot the curve is r″/6 off its control point, and unbent at its ends."""
    knots = np.arange(len(waypoints))
    return waypoints - CubicSpline(knots, waypoints, bc_type="natural")(knots, 2) / 6


def equations(waypoints, *, sixth=6.0, ends="right"):
    count = len(waypoints)
    matrix = (4 * np.eye(count) + np.eye(count, k=1) + np.eye(count, k=-1)) / sixth
    if ends == "right":
        matrix[[0, -1]] = np.eye(count)[[0, -1]]
    if ends == "doubled":
        matrix[[0, -1], [0, -1]] = 5 / sixth
    if ends == "twice":
        matrix[[0, -1]] = 2 * np.eye(count)[[0, -1]]
    return np.linalg.solve(matrix, waypoints)


def smoothed(waypoints):
    inner = (waypoints[:-2] + 4 * waypoints[1:-1] + waypoints[2:]) / 6
    return np.vstack([waypoints[:1], inner, waypoints[-1:]])


def doubled_in_place(waypoints):
    waypoints *= 2
    return waypoints


def by_linear_program(distance, allowed, acceleration):
    """The greatest squares of speeds under all limits at once."""
    count = len(distance)
    change = np.diff(np.eye(count), axis=0)
    gain = 2 * acceleration * np.diff(distance)
    bounds = [(0, 0 if i in (0, count - 1) else v**2) for i, v in enumerate(allowed)]
    found = linprog(-np.ones(count), np.vstack([change, -change]), np.concatenate([gain, gain]), bounds=bounds)
    return np.sqrt(found.x)


def drive(distance, allowed, acceleration, *, passes="both", factor=2.0, power=2, rest=True, start=True):
    """Speeds by passes along the curve and back, which can be broken in several ways."""
    speed = allowed**power
    if rest:
        speed[-1] = 0.0
    if rest and start:
        speed[0] = 0.0
    step = factor * acceleration * np.diff(distance)
    for _ in range(2):
        if passes in ("both", "forward"):
            for i, gain in enumerate(step):
                speed[i + 1] = min(speed[i + 1], speed[i] + gain)
        if passes in ("both", "backward"):
            for i, gain in reversed(list(enumerate(step))):
                speed[i] = min(speed[i], speed[i + 1] + gain)
    return speed ** (1 / power)


def broken(**mistake):
    return lambda *question: drive(*question, **mistake)


def street_points(*between):
    """Control points of 12.6 at the height of the street's ends."""
    return np.array([chapter12.START, *((x, y, 10) for x, y in between), chapter12.GOAL], dtype=float)


WIDE = street_points((30, 5.4), (50, 5.4), (66, 14), (74.6, 30), (74.6, 50))
MISTAKES = {
    "12.2": {
        "wrong way up: it isn't 2/3": lambda r1, r2: across(r1, r2) / (r1**2).sum(axis=1) ** (2 / 3),
        "wrong way up: 2/3 of |r′|": lambda r1, r2: across(r1, r2) / np.linalg.norm(r1, axis=1) ** (2 / 3),
        "divide by |r′|²": lambda r1, r2: across(r1, r2) / (r1**2).sum(axis=1),
        "already the second power": lambda r1, r2: across(r1, r2) / (r1**2).sum(axis=1) ** 3,
        "one metre per unit": lambda r1, r2: np.linalg.norm(r2, axis=1),
        "all of r″": lambda r1, r2: np.linalg.norm(r2, axis=1) / (r1**2).sum(axis=1),
        "numerator alone": across,
        "leave out the height": lambda r1, r2: by_gram(level(r1), level(r2)),
        "a sign for left and right": lambda r1, r2: np.cross(r1, r2)[:, 2] / np.hypot(r1[:, 0], r1[:, 1]) ** 3,
        "scalar product": lambda r1, r2: np.abs((r1 * r2).sum(axis=1)) / np.linalg.norm(r1, axis=1) ** 3,
        "That is the radius": lambda r1, r2: 1 / by_gram(r1, r2),
        "a curvature for each point": lambda r1, r2: np.linalg.norm(np.cross(r1, r2)) / np.linalg.norm(r1) ** 3,
        "Try it on a circle": lambda r1, r2: 2 * by_gram(r1, r2),
    },
    "12.3": {
        "the waypoints themselves": lambda waypoints: waypoints.copy(),
        "the wrong way round": smoothed,
        "found together": lambda waypoints: 2 * waypoints - smoothed(waypoints),
        "a neighbour outside is taken for 0": lambda waypoints: equations(waypoints, ends="none"),
        "as its own neighbour": lambda waypoints: equations(waypoints, ends="doubled"),
        "too near to the origin": lambda waypoints: equations(waypoints, sixth=1.0),
        "The weights 1, 4, 1 add up to 6": lambda waypoints: equations(waypoints, sixth=1.0, ends="none"),
        "doesn't begin or end": lambda waypoints: equations(waypoints, ends="twice"),
        "passes the six waypoints": lambda waypoints: equations(waypoints) + 1.0,
        "a control point for each waypoint": lambda waypoints: equations(waypoints)[1:-1],
        "changes an array": doubled_in_place,
    },
    "12.4": {
        "never brakes": broken(passes="forward"),
        "brakes in time, but": broken(passes="backward"),
        "it jumps, where the UAV can't": broken(passes="none"),
        "begins and ends at rest": broken(rest=False),
        "half of what it may": broken(factor=1.0),
        "You add a·s to the speed": broken(power=1, factor=1.0),
        "add 2as to the speed itself": broken(power=1),
        "are allowed": broken(factor=4.0),
        "not as fast as possible": lambda *question: 0.9 * drive(*question),
        "negative or not numbers": lambda *question: -drive(*question),
        "a speed for each point": lambda *question: drive(*question)[1:],
        " there.": lambda distance, allowed, a: drive(distance, 1.2 * allowed, a),
    },
    "12.5": {
        "has drag in it": 112.4,
        "of the tilt does the drag take": 92.6,
        "how many radii": 47.7,
        "for all limits": 39.7,
        "cruise speed": 187.5,
        "corner of 45°": 42.8,
        "above 0": -135.0,
        "shorter ones do, too": 150.0,
        "can't be flown at 15 m/s": 120.0,
    },
    "12.6": {
        "touches the inner wall": street_points((70, 10)),
        "touches the outer wall": street_points((78, 2), (78, 20)),
        "of a wall; keep 1 m": street_points((30, 5), (50, 5), (65, 15), (75, 30), (75, 50)),
        "can be flown at": street_points((40, 5), (75, 5), (75, 40)),
        "without a needless wave": WIDE + 4.0 * (np.arange(7) == 3)[:, None] * [0, 0, 1],
        "12 are allowed": np.linspace(chapter12.START, chapter12.GOAL, 13),
        "The first control point": WIDE[1:],
        "The last control point": WIDE[:-1],
        "not finite": WIDE * [1, 1, np.nan],
        "an array of control points": WIDE[:, :2],
    },
}


@pytest.mark.parametrize(
    ("number", "answer"),
    [
        ("12.2", by_gram),
        ("12.2", curvature_of_uavlab),
        ("12.3", by_scipy),
        ("12.4", by_linear_program),
        ("12.5", 134.5),
        ("12.5", np.float64(135.4)),
        ("12.6", WIDE),
        ("12.6", WIDE.tolist()),
    ],
)
def test_answers_found_otherwise_are_right(number, answer):
    assert check(number, answer)


def test_a_uav_that_starts_in_flight_is_told_so():
    assert "begins and ends at rest" in check("12.4", broken(start=False)).hint


def test_the_legs_are_those_that_the_library_flies(solutions):
    assert solutions["fastest"](chapter12.LEG) == pytest.approx(chapter12.FAST, abs=0.01)
    assert solutions["fastest"](112.36) == pytest.approx(14.3, abs=0.05)


def test_the_street_of_the_exercise_is_the_one_that_is_checked(solutions):
    assert (solutions["street"].occupied == chapter12.street().occupied).all()
    assert "5.8 m/s" in check("12.6", solutions["middle_line"].control).hint


def test_solutions_answer_examples(solutions):
    circle = solutions["curvature"](np.array([[0.0, 10.0, 0.0]]), np.array([[-20.0, 7.0, 0.0]]))
    assert circle == pytest.approx([0.2])
    straight = np.column_stack([np.arange(4.0), np.zeros(4)])
    assert solutions["control_points"](straight) == pytest.approx(straight)
    along = solutions["speeds"](np.array([0.0, 2.0, 4.0, 6.0, 8.0]), np.full(5, 3.0), 1.0)
    assert along == pytest.approx([0.0, 2.0, np.sqrt(8.0), 2.0, 0.0])
