"""Exercises of chapter 06: other ways to the answer pass; typical mistakes fail, each with a hint of its own."""

import math

import numpy as np
import pytest
from solved import EXERCISES

from uavlab.exercises import check

NUMBERS = ("06.2", "06.3", "06.4")


@pytest.mark.parametrize("number", NUMBERS)
def test_solution_passes_and_the_blank_fails(number, solutions, blank):
    assert check(number, solutions[EXERCISES[number]])
    assert "no answer yet" in check(number, blank).hint
    assert "no answer yet" in check(number, None).hint


def push(point, low, push, reach, *, middle=None, beyond=False, times=lambda d: 1.0):
    """A push of a voxel that can be broken in several ways."""
    nearest = np.clip(point, low, np.add(low, 1)) if middle is None else np.add(low, middle)
    away = point - nearest
    distance = np.linalg.norm(away)
    if distance > reach and not beyond:
        return np.zeros(3)
    return push * (1 / distance - 1 / reach) / distance**2 * times(distance) * away / distance


def as_a_number(*question):
    return np.linalg.norm(push(*question))


def number_beyond(*question):
    force = push(*question)
    return force if force.any() else 0


def nothing_beyond(*question):
    force = push(*question)
    return force if force.any() else None


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (as_a_number, "returns one number, "),
        (number_beyond, "also where it is zero"),
        (nothing_beyond, "needs a line with `return`. The answer is the force"),
        (lambda *q: push(*q)[:2], "an array of shape (2,)"),
        (lambda *q: -push(*q), "your voxel attracts. From where to where"),
        (lambda *q: push(*q, times=lambda d: d), "what is a direction's length"),
        (lambda *q: push(*q, beyond=True), "Beyond it your voxel attracts"),
        (lambda *q: push(*q, beyond=True) if push(*q).any() else np.ones(3), "How large is the force beyond it"),
        (lambda *q: push(*q, middle=0.5), "from the voxel's centre"),
        (lambda *q: push(*q, middle=0.5, beyond=True), "from the voxel's centre"),
        (lambda *q: push(*q, middle=0.0), "lowest corner"),
        (lambda *q: push(*q, middle=0.0, beyond=True), "lowest corner"),
        (lambda *q: push(*q, times=lambda d: d**2 * (1 / d - 1 / q[3]) / 2), "size of the potential"),
        (lambda *q: 2 * push(*q), "Go through it by hand"),
        (lambda *q: "east", "returns text, 'east'"),
        (lambda *q: q[9], "raises IndexError"),
    ],
)
def test_mistakes_with_the_push_of_a_voxel(answer, hint):
    assert not check("06.2", answer)
    assert hint in check("06.2", answer).hint


def by_newton(pull, push, reach):
    """Another way to the same distance: Newton from near the wall, where the push is convex."""
    distance = 1e-3
    for _ in range(200):
        excess = push * (1 / distance - 1 / reach) / distance**2 - pull
        distance -= excess / (push * (-3 / distance**4 + 2 / (reach * distance**3)))
    return distance


def by_cubic(pull, push, reach):
    """The roots of pull·D³ + (k/R)·D − k."""
    roots = np.roots([pull, 0, push / reach, -push])
    return float(roots[np.isreal(roots)].real[0])


@pytest.mark.parametrize("answer", [by_newton, by_cubic])
def test_other_ways_to_the_balance(answer):
    assert check("06.3", answer)


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda pull, push, reach: (push / pull) ** (1 / 3), "what does 1/R take away"),
        (lambda pull, push, reach: by_cubic(1, push, reach), "doesn't depend on the pull"),
        (lambda pull, push, reach: 1 / (math.sqrt(2 * pull / push) + 1 / reach), "their slopes"),
        (lambda pull, push, reach: 1 / (pull / push + 1 / reach), "Which factor of the push is missing"),
        (lambda pull, push, reach: reach, "At its reach the push is 0"),
        (lambda pull, push, reach: -1.0, "Between which two must it lie"),
        (lambda pull, push, reach: round(by_cubic(pull, push, reach), 3), "It has to be more exact"),
        (lambda pull, push, reach: 1.0, "too much to cancel the pull"),
        (lambda pull, push, reach: 2.0, "too little to cancel the pull"),
        (lambda pull, push, reach: None, "returns nothing"),
        (lambda pull, push, reach: [1.0, 2.0], "The answer is one number"),
    ],
)
def test_mistakes_with_the_balance(answer, hint):
    assert not check("06.3", answer)
    assert hint in check("06.3", answer).hint


def along(force, move):
    return np.dot(force, move) / np.linalg.norm(move)


def by_angle(force, moves):
    angles = [math.acos(min(1.0, along(force, move) / np.linalg.norm(force))) for move in moves]
    return moves[int(np.argmin(angles))] if angles and min(angles) < math.pi / 2 - 1e-12 else None


def best(force, moves, measure=along, *, least=0.0):
    """A choice among moves that can be broken in several ways."""
    return max(
        (move for move in moves if measure(force, move) > least), key=lambda move: measure(force, move), default=None
    )


def downhill(force, moves):
    return next((move for move in moves if along(force, move) > 0), None)


def backwards(force, moves):
    return best(-np.asarray(force), moves)


def tip(force, moves):
    return min(moves, key=lambda move: np.linalg.norm(np.subtract(force, move)))


@pytest.mark.parametrize("answer", [by_angle, best, lambda force, moves: (m := best(force, moves)) and np.array(m)])
def test_other_ways_to_the_best_move(answer):
    assert check("06.4", answer)


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda force, moves: best(force, moves, np.dot), "largest scalar product"),
        (lambda force, moves: best(force, moves, lambda f, m: np.dot(f, m) / np.dot(m, m)), "squared length"),
        (backwards, "uphill"),
        (tip, "only its direction should count"),
        (downhill, "the first move that leads downhill"),
        (lambda force, moves: max(moves, key=lambda move: along(force, move), default=None), "bottom of a pond"),
        (lambda force, moves: best(force, moves, least=-1e-9), "below 90°"),
        (lambda force, moves: best(force, moves) if moves else (0, 0, 0), "there is none to return"),
        (lambda force, moves: tuple(np.sign(force).astype(int).tolist()), "not among the legal moves"),
        (lambda force, moves: None, "always returns None"),
        (lambda force, moves: moves[0], "The smallest angle is"),
        (lambda force, moves: best(np.round(force), moves), "The smallest angle is"),
    ],
)
def test_mistakes_with_the_best_move(answer, hint):
    assert not check("06.4", answer)
    assert hint in check("06.4", answer).hint
