"""Exercises of chapter 02: other ways to the answer pass; typical mistakes fail, each with a hint of its own."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from uavlab.exercises import check
from uavlab.exercises.chapter02 import share_found, touches
from uavlab.offsets import collision_probability, coverage

K = 3.43935


def time_beside(distance, body, sigma, omega, chance, half=0.5, turns=2 * math.pi, start=True, power=True, sign=1):
    """The answer to 02.4, which can be broken in several ways."""
    room = distance - half * body
    rate = omega / turns * math.exp(-(room**2) / 2 / sigma**2)
    outside = 0.5 * (1 + math.erf(room / sigma / math.sqrt(2))) if start else 1.0
    return max(0.0, math.log(outside / (1 - chance))) * (outside if power else 1.0) / rate * sign


def by_root(distance, body, sigma, omega, chance):
    def over(seconds):
        return collision_probability(distance, sigma, seconds, omega, uav_diameter=body) - chance

    return 0.0 if over(0.0) > 0 else brentq(over, 0.0, 1e9)


def by_bound(distance, body, sigma, omega, chance):
    room = distance - body / 2
    start = 0.5 * math.erfc(room / sigma / math.sqrt(2))
    return max(0.0, chance - start) / (omega / 2 / math.pi * math.exp(-(room**2) / 2 / sigma**2))


MISTAKES = {
    "02.2": {
        "That is one axis": lambda k: math.erf(k / math.sqrt(2)),
        "a square of side": lambda k: math.erf(k / math.sqrt(2)) ** 2,
        "outside of the circle": lambda k: math.exp(-(k**2) / 2),
        "which power of e": lambda k: 1 - math.exp(-(k**2)),
    },
    "02.3": {
        "You take 3σ": lambda s, d, m, n: 3 * s + d / 2 + max(0, -np.dot(m, n)),
        "how much of the body": lambda s, d, m, n: K * s + d + max(0, -np.dot(m, n)),
        "which sign has wind towards it": lambda s, d, m, n: K * s + d / 2 + max(0, np.dot(m, n)),
        "it may drop": lambda s, d, m, n: K * s + d / 2 - np.dot(m, n),
    },
    "02.4": {
        "You leave the body out": lambda *case: time_beside(*case, half=0.0),
        "You take away the whole body": lambda *case: time_beside(*case, half=1.0),
        "how many turns per second": lambda *case: time_beside(*case, turns=1.0),
        "at its very start": lambda *case: time_beside(*case, start=False),
        "you take −νt": lambda *case: time_beside(*case, power=False),
        "That is the bound": by_bound,
        "The sign is the wrong way round": lambda *case: time_beside(*case, sign=-1),
        "right for a body of 1 m and σ = 1 m": lambda d, body, sigma, w, p: time_beside(d, 1.0, 1.0, w, p),
        "the answer is 0": lambda *case: time_beside(*case) or -3.0,
        "see which chance comes out": lambda *case: 60.0,
    },
    "02.5": {
        "in per cent": 10.0,
        "1 in 9": 1 / 9,
        "what a median bears": 0.5,
        "how many *good* samples": 0.0027,
        "go higher": 0.05,
        "go lower": 0.2,
        "lies between 0 and 1": 20.0,
    },
    "02.6": {
        "in the middle of the street": (6.0, 4.0),
        "nearer to the eastern wall": (7.0, 4.0),
        "how does the chance change with the time": (5.0, 2.0),
        "at most 5 m/s": (5.0, 9.0),
        "doesn't fit": (0.2, 4.0),
        "Which wall is the worse one": (4.5, 4.0),
    },
}


@pytest.mark.parametrize("number", ["02.2", "02.3", "02.4"])
def test_function_that_returns_nothing_is_told_so(number):
    assert "returns nothing" in check(number, lambda *question: None).hint


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda k: math.erf(k / math.sqrt(2)), "That is one axis"),
        (lambda k: math.erf(k / math.sqrt(2)) ** 2, "a square of side"),
        (lambda k: coverage(k, 3), "the ball in three dimensions"),
        (lambda k: math.exp(-(k**2) / 2), "outside of the circle"),
        (lambda k: 1 - math.exp(-(k**2)), "which power of e"),
        (lambda k: k * math.exp(-(k**2) / 2), "is its integral"),
        (lambda k: 100 - 100 * math.exp(-(k**2) / 2), "in per cent"),
        (lambda k: 1 - math.exp(-(k**2) / 2) if k else 1.0, "radius 0 holds nothing"),
        (lambda k: 0.997, "For k = 3 you get 0.9970"),
    ],
)
def test_mistakes_with_the_plane(answer, hint):
    assert not check("02.2", answer)
    assert hint in check("02.2", answer).hint


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda s, d, m, n: 3 * s + d / 2 + max(0, -np.dot(m, n)), "You take 3σ"),
        (lambda s, d, m, n: 3.7625 * s + d / 2, "a ball in three dimensions"),
        (lambda s, d, m, n: K * s + d + max(0, -np.dot(m, n)), "how much of the body"),
        (lambda s, d, m, n: K * s + max(0, -np.dot(m, n)), "The body has a width"),
        (lambda s, d, m, n: K * s**2 + d / 2, "what is in metres"),
        (lambda s, d, m, n: 3.94, "you get 3.940 m"),
        (lambda s, d, m, n: K * s + d / 2, "you get the same"),
        (lambda s, d, m, n: K * s + d / 2 + max(0, np.dot(m, n)), "which sign has wind towards it"),
        (lambda s, d, m, n: K * s + d / 2 - np.dot(m, n), "it may drop"),
        (lambda s, d, m, n: K * s + d / 2 + np.dot(m, n), "shrinks where the wind blows towards"),
        (lambda s, d, m, n: K * s + d / 2 + abs(np.dot(m, n)), "both sides of the wind"),
        (lambda s, d, m, n: K * s + d / 2 + math.hypot(*m), "Along the wall it does no harm"),
        (lambda s, d, m, n: K * s + d / 2 + max(0, -m[0]), "which part of the mean offset"),
    ],
)
def test_mistakes_with_the_distance(answer, hint):
    assert not check("02.3", answer)
    assert hint in check("02.3", answer).hint


def test_a_rounded_radius_is_right():
    assert check("02.3", lambda s, d, m, n: 3.439 * s + d / 2 + max(0, -np.dot(m, n)))


def test_other_ways_to_the_time_are_right():
    assert check("02.4", time_beside)
    assert check("02.4", by_root)
    assert check("02.4", lambda *case: np.float64(by_root(*case)))


def test_a_body_that_is_fixed_is_not_taken_for_right():
    assert "where do they enter" in check("02.4", lambda d, body, sigma, w, p: time_beside(d, 1.0, sigma, w, p)).hint


@pytest.mark.parametrize("share", [0.1, 0.098, np.float64(0.102), 1 / 10])
def test_shares_near_a_tenth_are_right(share):
    assert check("02.5", share)


def test_the_filter_is_blind_from_a_tenth_on():
    assert [share_found(share) for share in (0.05, 0.095, 0.1, 0.105, 0.3)] == [1.0, 1.0, 0.0, 0.0, 0.0]


@pytest.mark.parametrize("plan", [(5.0, 4.0), [5.1, 5.0], np.array([5.0, 2.7]), (4.7, 5)])
def test_several_plans_are_right(plan):
    assert check("02.6", plan)


def test_wind_makes_the_walls_of_the_street_differ():
    assert touches(5.0, 4.0)[0] == pytest.approx(touches(5.0, 4.0)[1])
    west, east = touches(6.0, 4.0)
    assert east > 100 * west


def test_solutions_answer_examples(solutions):
    assert solutions["coverage_in_the_plane"](3) == pytest.approx(0.98889, abs=1e-5)
    assert solutions["safe_distance"](1.0, 1.0, (0.0, 0.0), (1.0, 0.0)) == pytest.approx(3.94, abs=0.005)
    assert solutions["longest_time"](5.23, 1.0, 1.0, 1.0, 0.00135) == pytest.approx(611, abs=1)
    assert solutions["longest_time"](5.0, 1.0, 1.2, 0.8, 0.01) == pytest.approx(by_root(5.0, 1.0, 1.2, 0.8, 0.01))
