"""Exercises of chapter 07: other ways to the answer pass; typical mistakes fail, each with a hint of its own."""

import math

import numpy as np
import pytest

from uavlab.exercises import check
from uavlab.resilience import DISTURBANCES, LOADS


def price(distance, keep, wind, normal, load, *, blown=None, push=None, scale=2.0, one=1.0, open_air=1.0, zone=True):
    """The price of a metre, which can be broken in several ways."""
    if zone and distance >= keep:
        return 1.0
    force = keep**3 / 4 * (1 / distance - 1 / keep) / distance**2 if push is None else push(distance, keep)
    gust = max(0.0, -np.dot(wind, normal)) if blown is None else blown(np.array(wind), np.array(normal))
    return open_air + scale * (one + force + gust + load)


def by_size(distance, keep, wind, normal, load):
    force = keep**3 / 4 * (1 / distance - 1 / keep) / distance**2
    size = np.linalg.norm(force * np.array(normal) + wind)
    return 1 + 2 * (1 + load + size) if distance < keep else 1.0


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda *case: price(*case, open_air=0.0), "That is ω"),
        (lambda *case: price(*case, one=0.0), "doesn't depend on anything"),
        (lambda *case: price(*case[:4], 0.0), "The load is missing"),
        (lambda *case: price(*case, scale=1.0), "weighed against the open"),
        (lambda *case: price(*case, push=lambda d, k: k**3 / 4 * (1 / d - 1 / k)), "another factor"),
        (lambda *case: price(*case, push=lambda d, k: (1 / d - 1 / k) / d**2), "k_rep for 1"),
        (lambda *case: price(*case, zone=False), "what is O_risk there"),
        (lambda *case: price(*case, blown=lambda w, n: max(0.0, w @ n)), "Where does n point"),
        (lambda *case: price(*case, blown=lambda w, n: -w @ n), "metre cheaper"),
        (lambda *case: price(*case, blown=lambda w, n: abs(w @ n)), "Only one of them"),
        (lambda *case: price(*case, blown=lambda w, n: np.linalg.norm(w)), "the whole wind"),
        (lambda *case: price(*case, blown=lambda w, n: 0.0), "where is F_dist"),
        (lambda *case: price(*case, blown=lambda w, n: (w @ n) ** 2), "which part of it"),
        (by_size, "way 2"),
        (lambda *case: 2.0, "you get 2.000"),
        (lambda *case: None, "returns nothing"),
    ],
)
def test_mistakes_with_the_price(answer, hint):
    assert not check("07.2", answer)
    assert hint in check("07.2", answer).hint


def test_price_written_otherwise_is_right():
    assert check("07.2", price)


RIGHT = ({"dead": 0, "light": 2, "moderate": 8, "heavy": 10}, {"none": 0, "mild": 6, "moderate": 10, "heavy": 14})


def test_another_score_is_right():
    loads = {"dead": 0, "light": 1, "moderate": 4, "heavy": 5}
    disturbances = {"none": 0, "mild": 3, "moderate": 5, "heavy": 7}
    assert check("07.3", lambda: (loads, disturbances, (2.5, 4.5, 7.5, 10.5)))


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        ((*RIGHT, (5, 9, 15)), "four thresholds"),
        ((*RIGHT, (9, 5, 15, 21)), "must rise"),
        ((*RIGHT, (5, 9, 15, 23)), "15 of 16"),
        ((dict.fromkeys(LOADS, 0), dict.fromkeys(DISTURBANCES, 0), (5, 9, 15, 21)), "Table 3 has"),
        (({name: i for i, name in enumerate(LOADS)}, RIGHT[1], (5, 9, 15, 21)), "of 16 are right"),
        (({"dead": 0, "light": 2, "moderate": 8}, RIGHT[1], (5, 9, 15, 21)), "load 'heavy'"),
        ((RIGHT[0], {"none": 0, "mild": 6, "heavy": 14}, (5, 9, 15, 21)), "disturbance 'moderate'"),
        (RIGHT, "has 3 parts"),
        (None, "returns nothing"),
    ],
)
def test_mistakes_with_the_score(answer, hint):
    assert not check("07.3", lambda: answer)
    assert hint in check("07.3", lambda: answer).hint


def walk(observed, predicted, step, hold, release, *, mistake=""):
    """The boundary as in the exercise, which can be broken in several ways."""
    boundary, calm, history = predicted, 0, []
    for offset in observed:
        level = boundary if mistake == "boundary" else boundary - step
        if offset < (1.0 if mistake == "release" else release) * level:
            calm += 1
        elif mistake != "not in a row":
            calm = 0
        if offset > boundary:
            calm = 0
            boundary += step
            while mistake != "one step" and boundary < offset:
                boundary += step
        elif mistake != "never" and calm >= (1 if mistake == "flutter" else hold):
            calm = calm if mistake == "not fresh" else 0
            lower = predicted if mistake == "at once" else boundary - step
            boundary = lower if mistake == "no floor" else max(lower, predicted)
        history.append(boundary)
    return history


@pytest.mark.parametrize(
    ("mistake", "hint"),
    [
        ("never", "never comes down"),
        ("flutter", "fluttering"),
        ("one step", "still below it"),
        ("no floor", "below what was predicted"),
        ("at once", "one step at a time"),
        ("boundary", "push it up again"),
        ("release", "what is `release` for"),
        ("not in a row", "have to follow each other"),
        ("not fresh", "the next follows at once"),
    ],
)
def test_mistakes_with_the_boundary(mistake, hint):
    verdict = check("07.4", lambda *case: walk(*case, mistake=mistake))
    assert not verdict
    assert hint in verdict.hint


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda observed, *rest: None, "returns nothing"),
        (lambda observed, *rest: [2.0], "returns a list of 1. The answer is a list with a boundary for each"),
        (lambda observed, *rest: [2.0] * len(observed), "should rise"),
        (lambda observed, *rest: [9.0] * len(observed), "should not be 9 m"),
        (lambda observed, *rest: math.nan, "returns one number, nan"),
    ],
)
def test_other_answers_for_the_boundary(answer, hint):
    assert not check("07.4", answer)
    assert hint in check("07.4", answer).hint


def test_boundary_written_otherwise_is_right():
    assert check("07.4", walk)


def test_solutions_agree_with_the_example(solutions):
    found = solutions["boundaries"]([1, 2.7, 1, 1, 1, 1], 2, 0.5, 3, 0.8)
    assert found == [2, 3, 3, 3, 2.5, 2.5]
