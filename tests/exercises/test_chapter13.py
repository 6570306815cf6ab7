"""Exercises of chapter 13: other ways to the answer pass; typical mistakes fail, each with a hint of its own."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.stats import beta, binom, norm

from uavlab.exercises import check


@pytest.mark.parametrize("number", ["13.1", "13.2", "13.3"])
def test_a_blank_answer_is_no_answer(number, blank):
    assert "still raises NotImplementedError" in check(number, blank).hint
    assert "return" in check(number, lambda *_: None).hint


def acceleration(thrust, wind, velocity, mass, drag_area, *, mistake=""):
    """Component by component, and broken in several ways."""
    stream = [
        {"still": w, "no wind": -v, "sum": w + v, "against": v - w}.get(mistake, w - v)
        for w, v in zip(wind, velocity, strict=True)
    ]
    size = math.sqrt(sum(s * s for s in stream))
    half = 1.0 if mistake == "no half" else 0.5
    found = []
    for axis, s in enumerate(stream):
        drag = half * 1.225 * drag_area * {"each": abs(s), "linear": 1.0, "no sign": s}.get(mistake, size) * s
        weight = 9.81 if axis == 2 else 0.0
        if mistake == "force":
            found.append(thrust[axis] + drag - mass * weight)
        elif mistake == "light drag":
            found.append(thrust[axis] / mass + drag - weight)
        elif mistake == "g by mass":
            found.append((thrust[axis] + drag - weight) / mass)
        else:
            found.append((thrust[axis] + drag) / mass - {"no weight": 0.0, "up": -weight}.get(mistake, weight))
    return found


def test_an_acceleration_written_otherwise_is_right():
    assert check("13.1", acceleration)


@pytest.mark.parametrize(
    ("mistake", "hint"),
    [
        ("against", "against the stream"),
        ("still", "stands still"),
        ("no wind", "where is the wind?"),
        ("sum", "You add wind and velocity"),
        ("no half", "twice too large"),
        ("each", "each component on its own"),
        ("no sign", "A square has no sign"),
        ("linear", "not with its square"),
        ("no weight", "has no weight"),
        ("up", "pulls up"),
        ("g by mass", "divide g by the mass"),
        ("force", "That is the force"),
        ("light drag", "a heavy UAV feels less of it"),
    ],
)
def test_mistakes_with_the_acceleration(mistake, hint):
    verdict = check("13.1", lambda *question: acceleration(*question, mistake=mistake))
    assert not verdict
    assert hint in verdict.hint


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda *question: acceleration(*question)[2], "a vector of three numbers"),
        (lambda *question: np.zeros(3), "Begin with what is simplest"),
        (lambda f, w, v, m, a: f / m + 3 * (w - v) - [0, 0, 9.81], "Which way does the air stream past"),
    ],
)
def test_other_answers_for_the_acceleration(answer, hint):
    assert hint in check("13.1", answer).hint


def by_roots(crashed, flights):
    """The definition, solved: where as many or more, or as many or fewer, are seen in 2.5 % of the trials."""
    low, high = 0.0, 1.0
    if crashed > 0:
        low = brentq(lambda p: binom.sf(crashed - 1, flights, p) - 0.025, 1e-12, 1 - 1e-12, xtol=1e-14, rtol=1e-12)
    if crashed < flights:
        high = brentq(lambda p: binom.cdf(crashed, flights, p) - 0.025, 1e-12, 1 - 1e-12, xtol=1e-14, rtol=1e-12)
    return low, high


def test_an_interval_from_its_definition_is_right():
    assert check("13.2", by_roots)


def normal(crashed, flights):
    rate = crashed / flights
    half = norm.ppf(0.975) * math.sqrt(rate * (1 - rate) / flights)
    return rate - half, rate + half


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (normal, "no width"),
        (lambda k, n: np.clip(normal(k, n), 0, 1), "no width"),
        (lambda k, n: (beta.ppf(0.025, k, n - k + 1), beta.ppf(0.975, k + 1, n - k)), "is NaN"),
        (lambda k, n: by_roots(k, n)[::-1], "is the upper one"),
        (lambda k, n: 1000 * np.array(by_roots(k, n)), "per 1 000"),
        (lambda k, n: beta.ppf([0.025, 0.975], k + 1, n - k + 1), "even prior"),
        (lambda k, n: np.nan_to_num(beta.ppf([0.05, 0.95], [k, k + 1], [n - k + 1, n - k]), nan=n == k), "holds 90 %"),
        (lambda k, n: np.nan_to_num(beta.ppf([0.025, 0.975], [k, k], n - k + 1)), "The lower end is right"),
        (lambda k, n: np.nan_to_num(beta.ppf([0.05, 0.975], [k, k + 1], [n - k + 1, n - k])), "The upper end is right"),
        (lambda k, n: np.nan_to_num(beta.ppf([0.025, 0.975], [k, k + 1], [n - k + 1, n - k])), "when all do"),
        (lambda k, n: (0.1, 0.2), "How often would 3 or fewer be seen"),
        (lambda k, n: by_roots(k, n)[0], "two numbers"),
    ],
)
def test_mistakes_with_the_interval(answer, hint):
    verdict = check("13.2", answer)
    assert not verdict
    assert hint in verdict.hint


def keep(sigma, seconds, allowed, radius, *, mistake=""):
    """A distance by search, and broken in several ways."""
    pace = 1.0 if mistake == "radian" else 1 / (2 * math.pi)
    time = 1.0 if mistake == "no exposure" else seconds

    def touches(margin):
        return time * pace * math.exp(-0.5 * (margin / sigma) ** 2)

    margin = brentq(lambda u: touches(u) - allowed, 0, 50 * sigma, xtol=1e-13) if touches(0) > allowed else 0.0
    margin *= {"no two": 1 / math.sqrt(2), "base 10": 1 / math.sqrt(math.log(10)), "square": sigma}.get(mistake, 1.0)
    body = {"centre": 0.0, "twice": 2 * radius}.get(mistake, radius)
    return body + margin


def test_a_distance_by_search_is_right():
    assert check("13.3", keep)


def test_the_chance_of_a_touch_for_their_number_is_right():
    assert check("13.3", lambda s, t, p, r: keep(s, t, -math.log(1 - p), r))


@pytest.mark.parametrize(
    ("mistake", "hint"),
    [
        ("radian", "count a radian as a turn"),
        ("no exposure", "the same for a second and for an hour"),
        ("no two", "Check the exponent"),
        ("base 10", "natural logarithm"),
        ("square", "grows with σ²"),
        ("centre", "first thing that touches"),
        ("twice", "half of it already"),
    ],
)
def test_mistakes_with_the_distance(mistake, hint):
    verdict = check("13.3", lambda *question: keep(*question, mistake=mistake))
    assert not verdict
    assert hint in verdict.hint


def always_a_margin(sigma, seconds, allowed, radius):
    return radius + sigma * math.sqrt(abs(2 * math.log(seconds / (2 * math.pi * allowed))))


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda s, t, p, r: r + 3 * s, "short or long"),
        (lambda s, t, p, r: r + s * norm.ppf(1 - p), "on one side"),
        (lambda s, t, p, r: r + s * norm.ppf(1 - p / 2), "many moments"),
        (always_a_margin, "no margin at all"),
        (lambda s, t, p, r: keep(s, t, p, r) if t > 1 else 0.0, "has a radius of 0.4 m"),
        (lambda s, t, p, r: 2.0, "solve for u"),
        (lambda s, t, p, r: keep(s, t, p, r) + 0.1, "0.001 are allowed"),
    ],
)
def test_other_answers_for_the_distance(answer, hint):
    verdict = check("13.3", answer)
    assert not verdict
    assert hint in verdict.hint


def test_solutions_answer_examples(solutions):
    assert solutions["acceleration"](np.zeros(3), np.array([3.0, 4, 0]), np.zeros(3), 1.0, 0.08) == pytest.approx(
        [0.735, 0.98, -9.81]
    )
    assert solutions["crash_interval"](0, 1000) == pytest.approx((0.0, 1 - 0.025 ** (1 / 1000)))
    assert solutions["crash_interval"](7, 50) == pytest.approx(by_roots(7, 50))
    assert solutions["distance_to_keep"](1.0, 2 * math.pi, math.exp(-4.5), 0.5) == pytest.approx(3.5)
