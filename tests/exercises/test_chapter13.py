"""Exercises of chapter 13: other ways to the answer pass; typical mistakes fail, each with a hint of its own."""

import math
from functools import partial

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.stats import beta, binom, norm

from uavlab.exercises import chapter13, check
from uavlab.flight import offset_sigma
from uavlab.planners import astar, hazard_astar, potential_field, repare, theta_star
from uavlab.route import Route
from uavlab.vehicle import LIGHT_QUADROTOR
from uavlab.weather import Wind

CITY, ENDS = chapter13.test_city(), chapter13.ENDS


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


def by_roots(crashed, flights):
    """The definition, solved: where as many or more, or as many or fewer, are seen in 2.5 % of the trials."""
    low, high = 0.0, 1.0
    if crashed > 0:
        low = brentq(lambda p: binom.sf(crashed - 1, flights, p) - 0.025, 1e-12, 1 - 1e-12, xtol=1e-14, rtol=1e-12)
    if crashed < flights:
        high = brentq(lambda p: binom.cdf(crashed, flights, p) - 0.025, 1e-12, 1 - 1e-12, xtol=1e-14, rtol=1e-12)
    return low, high


def normal(crashed, flights):
    rate = crashed / flights
    half = norm.ppf(0.975) * math.sqrt(rate * (1 - rate) / flights)
    return rate - half, rate + half


def quantiles(low, high, k, n):
    """Ends from two beta distributions, each (share, a, b); 0 where no crash makes a lower end NaN, 1 where all do."""
    return np.nan_to_num([beta.ppf(*low(k, n)), beta.ppf(*high(k, n))], nan=float(k == n))


def ends_at(low_share, high_share, k, n):
    return quantiles(lambda k, n: (low_share, k, n - k + 1), lambda k, n: (high_share, k + 1, n - k), k, n)


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


def always_a_margin(sigma, seconds, allowed, radius):
    return radius + sigma * math.sqrt(abs(2 * math.log(seconds / (2 * math.pi * allowed))))


def broken(function, mistake):
    return partial(function, mistake=mistake)


MISTAKES = {
    "13.2": {
        "against the stream": broken(acceleration, "against"),
        "stands still": broken(acceleration, "still"),
        "where is the wind?": broken(acceleration, "no wind"),
        "You add wind and velocity": broken(acceleration, "sum"),
        "twice too large": broken(acceleration, "no half"),
        "each component on its own": broken(acceleration, "each"),
        "A square has no sign": broken(acceleration, "no sign"),
        "not with its square": broken(acceleration, "linear"),
        "has no weight": broken(acceleration, "no weight"),
        "pulls up": broken(acceleration, "up"),
        "divide g by the mass": broken(acceleration, "g by mass"),
        "That is the force": broken(acceleration, "force"),
        "a heavy UAV feels less of it": broken(acceleration, "light drag"),
        "a vector of three numbers": lambda *question: acceleration(*question)[2],
        "Begin with what is simplest": lambda *question: np.zeros(3),
        "how long is that vector": lambda f, w, v, m, a: f / m + 3 * (w - v) - [0, 0, 9.81],
    },
    "13.3": {
        "no width": normal,
        "is NaN": lambda k, n: (beta.ppf(0.025, k, n - k + 1), beta.ppf(0.975, k + 1, n - k)),
        "is the upper one": lambda k, n: by_roots(k, n)[::-1],
        "per 1 000": lambda k, n: 1000 * np.array(by_roots(k, n)),
        "even prior": lambda k, n: beta.ppf([0.025, 0.975], k + 1, n - k + 1),
        "holds 90 %": partial(ends_at, 0.05, 0.95),
        "The lower end is right": lambda k, n: np.nan_to_num(beta.ppf([0.025, 0.975], [k, k], n - k + 1)),
        "The upper end is right": partial(ends_at, 0.05, 0.975),
        "when all do": lambda k, n: np.nan_to_num(beta.ppf([0.025, 0.975], [k, k + 1], [n - k + 1, n - k])),
        "How often would 3 or fewer be seen": lambda k, n: (0.1, 0.2),
        "two numbers": lambda k, n: by_roots(k, n)[0],
    },
    "13.4": {
        "count a radian as a turn": broken(keep, "radian"),
        "the same for a second and for an hour": broken(keep, "no exposure"),
        "Check the exponent": broken(keep, "no two"),
        "natural logarithm": broken(keep, "base 10"),
        "grows with σ²": broken(keep, "square"),
        "first thing that touches": broken(keep, "centre"),
        "half of it already": broken(keep, "twice"),
        "short or long": lambda s, t, p, r: r + 3 * s,
        "one moment on one side": lambda s, t, p, r: r + s * norm.ppf(1 - p),
        "and the wall is on one side": lambda s, t, p, r: r + s * norm.ppf(1 - p / 2),
        "no margin at all": always_a_margin,
        "solve for u": lambda s, t, p, r: 2.0,
    },
    "13.5": {
        "for the heavy load": 15.3,
        "in flight against the wind": 0.52,
        "You took the spectrum as flat": 1.04,
        "for gusts that last for ever": 1.51,
        "above 0": -1.0,
        "The shorter gusts last": 3.0,
        "let the gusts last longer": 0.8,
    },
    "13.6": {
        "doesn't arrive": potential_field(CITY, *ENDS),
        "Your route begins at": repare(CITY, *ENDS[::-1]),
        "leads through a building": Route(np.array(ENDS)),
        "it needs no gust": astar(CITY, *ENDS),
        "Distance from walls alone is easy": hazard_astar(CITY, *ENDS, sigma=2.0),
        "The intervals overlap": repare(CITY, *ENDS),
        "it is more than a third": hazard_astar(CITY, *ENDS, sigma=1.0),
    },
}


def test_an_acceleration_written_otherwise_is_right():
    assert check("13.2", acceleration)


def test_an_interval_from_its_definition_is_right():
    assert check("13.3", by_roots)


def test_a_clipped_normal_interval_is_told_what_it_is():
    assert "no width" in check("13.3", lambda k, n: np.clip(normal(k, n), 0, 1)).hint


@pytest.mark.parametrize("answer", [keep, lambda s, t, p, r: keep(s, t, -math.log(1 - p), r)])
def test_a_distance_by_search_or_for_the_chance_of_a_touch_is_right(answer):
    assert check("13.4", answer)


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        (lambda s, t, p, r: keep(s, t, p, r) if t > 1 else 0.0, "has a radius of 0.4 m"),
        (lambda s, t, p, r: keep(s, t, p, r) + 0.1, "0.001 are allowed"),
    ],
)
def test_other_answers_for_the_distance(answer, words):
    assert words in check("13.4", answer).hint


@pytest.mark.parametrize("memory", [1.59, np.float64(1.6), "closed form"])
def test_a_memory_to_three_hundredths_is_right(memory):
    if memory == "closed form":  # of the integral, for gusts that forget exponentially
        d, strength = 1.225 * 0.06 * 9.0 / 1.75, 4.0
        damping = 2 + d

        def sigma(time):
            pace = 1 / time
            return d * strength * math.sqrt((damping + pace) / (damping * (pace**2 + damping * pace + 1)))

        memory = brentq(lambda time: sigma(time) - 1, 0.1, 10)
        assert memory == pytest.approx(chapter13.MEMORY, abs=1e-3)
    assert check("13.5", memory)


def test_memories_of_the_hints_are_those_of_the_formula():
    def solved(load, ground):
        uav = LIGHT_QUADROTOR.loaded(load)
        return brentq(
            lambda time: (
                offset_sigma(uav, Wind((9.0, 0.0), deviation=4.0, correlation=time), ground_velocity=ground)[0] - 1
            ),
            0.1,
            60,
        )

    heavy, against = chapter13.MEMORIES[0][0], chapter13.MEMORIES[1][0]
    assert solved(1.0, (0.0, 0.0)) == pytest.approx(heavy, rel=0.01)
    assert solved(0.25, (-5.0, 0.0)) == pytest.approx(against, rel=0.01)


def test_another_safe_route_is_right():
    assert check("13.6", theta_star(CITY, *ENDS, min_clearance=5.0))


def test_solutions_answer_examples(solutions):
    assert solutions["acceleration"](np.zeros(3), np.array([3.0, 4, 0]), np.zeros(3), 1.0, 0.08) == pytest.approx(
        [0.735, 0.98, -9.81]
    )
    assert solutions["crash_interval"](0, 1000) == pytest.approx((0.0, 1 - 0.025 ** (1 / 1000)))
    assert solutions["crash_interval"](7, 50) == pytest.approx(by_roots(7, 50))
    assert solutions["distance_to_keep"](1.0, 2 * math.pi, math.exp(-4.5), 0.5) == pytest.approx(3.5)
