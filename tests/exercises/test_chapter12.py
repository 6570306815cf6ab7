"""Exercises of chapter 12: other ways to the answer pass; typical mistakes fail, each with a hint of its own."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.optimize import linprog

from uavlab.exercises import check
from uavlab.spline import curvature as curvature_of_uavlab


@pytest.mark.parametrize("number", ["12.1", "12.2", "12.3"])
def test_a_blank_answer_is_no_answer(number, blank):
    assert "still raises NotImplementedError" in check(number, blank).hint
    assert "return" in check(number, lambda *_: None).hint


@pytest.mark.parametrize(("number", "name"), [("12.1", "curvature"), ("12.2", "control_points"), ("12.3", "speeds")])
def test_the_solutions_are_right(number, name, solutions):
    assert check(number, solutions[name])


def by_gram(first, second):
    """κ by scalar products alone, without a vector product."""
    a, b, c = ((u * v).sum(axis=1) for u, v in ((first, first), (second, second), (first, second)))
    return np.sqrt(a * b - c**2) / a**1.5


@pytest.mark.parametrize("answer", [by_gram, curvature_of_uavlab])
def test_curvature_written_otherwise_is_right(answer):
    assert check("12.1", answer)


def across(first, second):
    return np.linalg.norm(np.cross(first, second), axis=1)


def level(vectors):
    return vectors * (1, 1, 0)


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda r1, r2: across(r1, r2) / (r1**2).sum(axis=1) ** (2 / 3), "wrong way up: it isn't 2/3"),
        (lambda r1, r2: across(r1, r2) / np.linalg.norm(r1, axis=1) ** (2 / 3), "wrong way up: 2/3 of |r′|"),
        (lambda r1, r2: across(r1, r2) / (r1**2).sum(axis=1), "divide by |r′|²"),
        (lambda r1, r2: across(r1, r2) / (r1**2).sum(axis=1) ** 3, "already the second power"),
        (lambda r1, r2: np.linalg.norm(r2, axis=1), "one metre per unit"),
        (lambda r1, r2: np.linalg.norm(r2, axis=1) / (r1**2).sum(axis=1), "all of r″"),
        (across, "numerator alone"),
        (lambda r1, r2: by_gram(level(r1), level(r2)), "leave out the height"),
        (lambda r1, r2: np.cross(r1, r2)[:, 2] / np.hypot(r1[:, 0], r1[:, 1]) ** 3, "a sign for left and right"),
        (lambda r1, r2: np.abs((r1 * r2).sum(axis=1)) / np.linalg.norm(r1, axis=1) ** 3, "scalar product"),
        (lambda r1, r2: 1 / by_gram(r1, r2), "That is the radius"),
        (lambda r1, r2: np.linalg.norm(np.cross(r1, r2)) / np.linalg.norm(r1) ** 3, "a curvature for each point"),
        (lambda r1, r2: 2 * by_gram(r1, r2), "Try it on a circle"),
    ],
)
def test_mistakes_with_the_curvature(answer, hint):
    verdict = check("12.1", answer)
    assert not verdict
    assert hint in verdict.hint


def by_scipy(waypoints):
    """From SciPy's natural spline: at a knot the curve is r″/6 off its control point, and unbent at its ends."""
    knots = np.arange(len(waypoints))
    return waypoints - CubicSpline(knots, waypoints, bc_type="natural")(knots, 2) / 6


def test_control_points_found_otherwise_are_right():
    assert check("12.2", by_scipy)


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


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda waypoints: waypoints.copy(), "the waypoints themselves"),
        (smoothed, "the wrong way round"),
        (lambda waypoints: 2 * waypoints - smoothed(waypoints), "found together"),
        (lambda waypoints: equations(waypoints, ends="none"), "a neighbour outside is taken for 0"),
        (lambda waypoints: equations(waypoints, ends="doubled"), "as its own neighbour"),
        (lambda waypoints: equations(waypoints, sixth=1.0), "too near to the origin"),
        (lambda waypoints: equations(waypoints, sixth=1.0, ends="none"), "add up to 6"),
        (lambda waypoints: equations(waypoints, ends="twice"), "doesn't begin or end"),
        (lambda waypoints: equations(waypoints) + 1.0, "passes the six waypoints"),
        (lambda waypoints: equations(waypoints)[1:-1], "a control point for each waypoint"),
        (doubled_in_place, "changes an array"),
    ],
)
def test_mistakes_with_the_control_points(answer, hint):
    verdict = check("12.2", answer)
    assert not verdict
    assert hint in verdict.hint


def by_linear_program(distance, allowed, acceleration):
    """The greatest squares of speeds under all limits at once."""
    count = len(distance)
    change = np.diff(np.eye(count), axis=0)
    gain = 2 * acceleration * np.diff(distance)
    bounds = [(0, 0 if i in (0, count - 1) else v**2) for i, v in enumerate(allowed)]
    found = linprog(-np.ones(count), np.vstack([change, -change]), np.concatenate([gain, gain]), bounds=bounds)
    return np.sqrt(found.x)


def test_speeds_found_by_a_linear_program_are_right():
    assert check("12.3", by_linear_program)


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


@pytest.mark.parametrize(
    ("broken", "hint"),
    [
        ({"passes": "forward"}, "never brakes"),
        ({"passes": "backward"}, "brakes in time, but"),
        ({"passes": "none"}, "it jumps, where the UAV can't"),
        ({"rest": False}, "begins and ends at rest"),
        ({"start": False}, "begins and ends at rest"),
        ({"factor": 1.0}, "half of what it may"),
        ({"power": 1, "factor": 1.0}, "You add a·s to the speed"),
        ({"power": 1}, "add 2as to the speed itself"),
        ({"factor": 4.0}, "are allowed"),
    ],
)
def test_mistakes_with_the_speeds(broken, hint):
    verdict = check("12.3", lambda *question: drive(*question, **broken))
    assert not verdict
    assert hint in verdict.hint


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda *question: 0.9 * drive(*question), "not as fast as possible"),
        (lambda *question: -drive(*question), "negative or not numbers"),
        (lambda *question: drive(*question)[1:], "a speed for each point"),
        (lambda distance, allowed, a: drive(distance, 1.2 * allowed, a), "m/s, "),
    ],
)
def test_other_answers_for_the_speeds(answer, hint):
    verdict = check("12.3", answer)
    assert not verdict
    assert hint in verdict.hint


def test_solutions_answer_examples(solutions):
    circle = solutions["curvature"](np.array([[0.0, 10.0, 0.0]]), np.array([[-20.0, 7.0, 0.0]]))
    assert circle == pytest.approx([0.2])
    straight = np.column_stack([np.arange(4.0), np.zeros(4)])
    assert solutions["control_points"](straight) == pytest.approx(straight)
    along = solutions["speeds"](np.array([0.0, 2.0, 4.0, 6.0, 8.0]), np.full(5, 3.0), 1.0)
    assert along == pytest.approx([0.0, 2.0, np.sqrt(8.0), 2.0, 0.0])
