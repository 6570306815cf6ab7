"""Exercises of chapter 02: other ways to the answer pass; typical mistakes fail, each with a hint of its own."""

import math

import numpy as np
import pytest

from uavlab.exercises import check
from uavlab.exercises.chapter02 import contaminated_samples
from uavlab.offsets import coverage, pauta_filter

K = 3.43935


@pytest.mark.parametrize("number", ["02.2", "02.3", "02.4"])
def test_function_that_returns_nothing_is_told_so(number):
    assert "returns nothing" in check(number, lambda *question: None).hint


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda k: math.erf(k / math.sqrt(2)), "That is one axis"),
        (lambda k: math.erf(k / math.sqrt(2)) ** 2, "a square of side"),
        (lambda k: coverage(k, 3), "the ball in space"),
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
        (lambda s, d, m, n: 3.7625 * s + d / 2, "a ball in space"),
        (lambda s, d, m, n: K * s + d + max(0, -np.dot(m, n)), "how much of the body"),
        (lambda s, d, m, n: K * s + max(0, -np.dot(m, n)), "The body has a width"),
        (lambda s, d, m, n: K * s**2 + d / 2, "what is in metres"),
        (lambda s, d, m, n: 3.94, "you get 3.940 m"),
        (lambda s, d, m, n: K * s + d / 2, "you get the same"),
        (lambda s, d, m, n: K * s + d / 2 + max(0, np.dot(m, n)), "which sign has wind towards it"),
        (lambda s, d, m, n: K * s + d / 2 - np.dot(m, n), "it may turn"),
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


def filtered(samples, rounds=100, radius=3.0, center=np.mean, far=np.abs):
    """A filter that can be broken in several ways."""
    for _ in range(rounds):
        if len(samples):
            samples = samples[far(samples - center(samples)) <= radius * samples.std(ddof=1)]
    return samples


def with_n(samples):
    while (far := np.abs(samples - np.mean(samples)) > 3 * np.std(samples)).any():
        samples = samples[~far]
    return samples


def in_place(samples):
    samples[:] = np.sort(samples)
    return filtered(samples)


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda x: filtered(x, rounds=1), "That is one round"),
        (lambda x: filtered(x, center=lambda _: 0.0), "You measure from 0"),
        (lambda x: filtered(x, far=lambda z: z), "below the mean as well"),
        (lambda x: filtered(x, radius=2), "You cut at 2σ"),
        (with_n, "your σ divides by n"),
        (lambda x: x[~pauta_filter(x).kept], "You return the gross errors"),
        (lambda x: x, "You keep everything"),
        (lambda x: pauta_filter(x).kept, "You return a mask"),
        (lambda x: np.sort(filtered(x)), "in another order"),
        (in_place, "Work on a copy"),
        (lambda x: filtered(x, rounds=2), "should be left, you keep"),
        (lambda x: x[:0], "you keep 0"),
        (lambda x: 3.0, "returns one number, 3. The answer is the array"),
    ],
)
def test_mistakes_with_the_filter(answer, hint):
    assert not check("02.4", answer)
    assert hint in check("02.4", answer).hint


def test_variants_of_the_filter_are_right():
    """The worst sample first: the same samples are left."""

    def worst_first(samples):
        while np.max(away := np.abs(samples - samples.mean())) > 3 * samples.std(ddof=1):
            samples = np.delete(samples, np.argmax(away))
        return samples

    for answer in (worst_first, filtered, lambda x: list(filtered(x))):
        assert check("02.4", answer)


def test_questions_need_several_rounds_and_have_errors_to_find():
    found = [pauta_filter(samples) for samples in contaminated_samples()]
    assert [int((~one.kept).sum()) for one in found] == [4, 6, 3, 2, 0, 0]
    assert max(one.rounds for one in found) >= 3
