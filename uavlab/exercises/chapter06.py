"""Exercises of chapter 6, the potential field: the push of a voxel, where a wall stops the UAV, and the best move.

A hint says which mistake the answers look like and why it is one. Mistakes are recognised by what they answer, not
by how they are written.
"""

from __future__ import annotations

import itertools
import math
import operator
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np
from scipy.optimize import brentq

from uavlab.exercises.hints import alike, each_alike, recognised
from uavlab.exercises.kinds import asks_for, number, numbers
from uavlab.planners import repulsion

Vector = Sequence[float] | np.ndarray
Move = tuple[int, ...]

MOVES: list[Move] = [move for move in itertools.product((-1, 0, 1), repeat=3) if any(move)]


@asks_for(numbers((3,), "the force, a vector of three numbers, also where it is zero"))
def exercise_2(push_of_voxel: Callable[..., np.ndarray]) -> str:
    """06.2: the force of one voxel on a UAV at a point."""
    rng = np.random.default_rng(71)
    lows = rng.integers(-5, 5, (60, 3))
    offsets = rng.uniform(-4, 4, (60, 3))
    points = np.where(offsets > 0, lows + 1 + offsets, lows + offsets)
    points[::4, 0] = lows[::4, 0] + 0.3  # beside a face or an edge, too
    questions = [(point, low, 7.0, 4.0) for point, low in zip(points, lows, strict=True)]
    answers = [push_of_voxel(*question) for question in questions]
    within = np.array([distance_to_voxel(*question[:2]) <= 4.0 for question in questions])
    given = np.array(answers, dtype=float)
    same = partial(alike, relative=1e-9, absolute=1e-12)
    near, far = (list(itertools.compress(questions, chosen)) for chosen in (within, ~within))
    if same(given[within], [push_within_reach(*question) for question in near]):
        if same(given[~within], [push_everywhere(*question) for question in far]):
            return "Right within the reach. Beyond it your voxel attracts: what is the sign of 1/D − 1/R there?"
        if not same(given[~within], [push_within_reach(*question) for question in far]):
            return "Right within the reach. How large is the force beyond it?"
        return ""
    if hint := recognised(given[within], PUSH_MISTAKES, near, same):
        return hint
    point, low = (3.0, 0.5, 0.5), (0, 0, 0)
    size = float(np.linalg.norm(push_of_voxel(point, low, 7.0, 4.0)))
    return (
        f"2 m east of a voxel, with k_rep = 7 and R = 4 m, your force has the size {size:.4f}. Go through it by hand: "
        "the voxel's nearest point, the distance to it, the size of the push, its direction."
    )


def away_from_voxel(point: Vector, low: Vector) -> np.ndarray:
    """From the nearest point of a voxel with edges of 1 m."""
    return np.asarray(point, dtype=float) - np.clip(point, low, np.add(low, 1))


def distance_to_voxel(point: Vector, low: Vector) -> float:
    return float(np.linalg.norm(away_from_voxel(point, low)))


def push_along(away: np.ndarray, push: float, reach: float) -> np.ndarray:
    """The push as its formula has it, at any distance."""
    distance = np.linalg.norm(away)
    return push * (1 / distance - 1 / reach) / distance**3 * away


def push_everywhere(point: Vector, low: Vector, push: float, reach: float) -> np.ndarray:
    return push_along(away_from_voxel(point, low), push, reach)


def push_within_reach(point: Vector, low: Vector, push: float, reach: float) -> np.ndarray:
    return push_everywhere(point, low, push, reach) * (distance_to_voxel(point, low) <= reach)


def push_from_center(point: Vector, low: Vector, push: float, reach: float) -> np.ndarray:
    return push_along(np.asarray(point, dtype=float) - np.add(low, 0.5), push, reach)


def push_from_center_within_reach(point: Vector, low: Vector, push: float, reach: float) -> np.ndarray:
    away = np.asarray(point, dtype=float) - np.add(low, 0.5)
    return push_along(away, push, reach) * (np.linalg.norm(away) <= reach)


def push_from_corner(point: Vector, low: Vector, push: float, reach: float) -> np.ndarray:
    return push_along(np.subtract(point, low).astype(float), push, reach)


def push_from_corner_within_reach(point: Vector, low: Vector, push: float, reach: float) -> np.ndarray:
    return push_from_corner(point, low, push, reach) * (np.linalg.norm(np.subtract(point, low)) <= reach)


CENTER = "You measure from the voxel's centre. It is a cube: which of its points is nearest to the UAV?"
CORNER = "You measure from the voxel's lowest corner. It is a cube: which of its points is nearest to the UAV?"
PUSH_MISTAKES: list[tuple[Callable[..., np.ndarray], str]] = [
    (
        lambda *q: -push_everywhere(*q),
        "The size is right, but your voxel attracts. From where to where does the vector point?",
    ),
    (
        lambda *q: push_everywhere(*q) * distance_to_voxel(*q[:2]),
        "The direction is right. Its vector is as long as the distance, so the force gets D times too large: what is "
        "a direction's length?",
    ),
    (push_from_center, CENTER),
    (push_from_center_within_reach, CENTER),
    (push_from_corner, CORNER),
    (push_from_corner_within_reach, CORNER),
    (
        lambda point, low, push, reach: (
            push_everywhere(point, low, push, reach)
            * distance_to_voxel(point, low) ** 2
            * (1 / distance_to_voxel(point, low) - 1 / reach)
            / 2
        ),
        "That has the size of the potential. The force is its slope: where does the factor 1/D² come from?",
    ),
]


@asks_for(number("the distance [m]"))
def exercise_3(balance: Callable[[float, float, float], float]) -> str:
    """06.3: the distance at which pull and push cancel, in front of a wall."""
    questions = [
        (1.0, 5.0, 5.0), (2.0, 5.0, 5.0), (1.0, 500.0, 5.0), (1.0, 5.0, 12.0), (0.3, 80.0, 2.5), (40.0, 0.7, 3.0),
    ]  # fmt: skip
    answers = [balance(*question) for question in questions]
    same = partial(each_alike, same=partial(math.isclose, abs_tol=1e-6))
    if same(answers, [stopping_distance(*question) for question in questions]):
        return ""
    if hint := recognised(answers, BALANCE_MISTAKES, questions, same):
        return hint
    pull, push, reach = questions[0]
    if not 0 < answers[0] <= reach:
        return f"For a pull of 1, k_rep = 5 and R = 5 m you get {answers[0]:.4g} m. Between which two must it lie?"
    there = float(repulsion(answers[0], push, reach))
    if math.isclose(there, pull, rel_tol=1e-2):
        return (
            f"Nearly: at your {answers[0]:.6f} m the push is {there:.6f}, the pull {pull:g}. It has to be more exact."
        )
    return (
        f"For a pull of {pull:g}, k_rep = {push:g} and R = {reach:g} m you get {answers[0]:.4f} m. There the push is "
        f"{there:.3f}: too {'much' if there > pull else 'little'} to cancel the pull."
    )


def stopping_distance(pull: float, push: float, reach: float) -> float:
    return float(brentq(lambda distance: float(repulsion(distance, push, reach)) - pull, 1e-9, reach, xtol=1e-12))


BALANCE_MISTAKES: list[tuple[Callable[[float, float, float], float], str]] = [
    (
        lambda pull, push, reach: math.cbrt(push / pull),
        "That is where k_rep / D³ equals the pull. It is right for a reach without end: what does 1/R take away?",
    ),
    (
        lambda pull, push, reach: stopping_distance(1.0, push, reach),
        "It doesn't depend on the pull. Should the UAV not come nearer when the goal pulls harder?",
    ),
    (
        lambda pull, push, reach: 1 / (math.sqrt(2 * pull / push) + 1 / reach),
        "That is where the potential of the wall is as large as the pull. What cancels is forces: their slopes.",
    ),
    (
        lambda pull, push, reach: 1 / (pull / push + 1 / reach),
        "You solve k_rep (1/D − 1/R) = pull. Which factor of the push is missing?",
    ),
    (
        lambda pull, push, reach: reach,
        "At its reach the push is 0, and the pull goes on. How near does the UAV come before the push is as large?",
    ),
]


@asks_for(numbers((3,), "one of the moves that you are given, or None", none=True))
def exercise_4(best_move: Callable[[Vector, list[Move]], Any]) -> str:
    """06.4: the legal move with the smallest angle to the force, or None."""
    rng = np.random.default_rng(73)
    forces = rng.standard_normal((200, 3)) * 10 ** rng.uniform(-2, 2, (200, 1))
    legal = [[MOVES[n] for n in rng.permutation(26)[: rng.integers(3, 26)]] for _ in forces]
    questions = list(zip(forces, legal, strict=True))
    answers = [best_move(*question) for question in questions]
    chosen = [None if answer is None else tuple(np.ravel(answer).tolist()) for answer in answers]
    wanted = [smallest_angle(*question) for question in questions]
    if all(answer is None for answer in chosen):
        return "Your function always returns None, also when a move leads straight along the force."
    strange = [a for a, (_, moves) in zip(chosen, questions, strict=True) if a is not None and a not in moves]
    if strange:
        return f"You return {strange[0]}, which is not among the legal moves: choose one of those that you are given."
    open_way = [n for n, move in enumerate(wanted) if move is not None]
    if all(chosen[n] == wanted[n] for n in open_way):
        if chosen != wanted:
            return (
                "Where there is a way on, it is right. But when all legal moves lead sideways or back you take one of "
                "them, against the force. What does the UAV do at the bottom of a pond?"
            )
        if best_move((1.0, 0.0, 0.0), [(0, 1, 0), (0, 0, -1)]) is not None:
            return "A move at 90° to the force gains nothing, and you take it: it should be below 90°."
        return "" if best_move((1.0, 0.0, 0.0), []) is None else "Without a legal move there is none to return: None."
    answered = [n for n in open_way if chosen[n] is not None]
    moves_taken = [chosen[n] for n in answered]
    if hint := recognised(moves_taken, MOVE_MISTAKES, [questions[n] for n in answered], operator.eq):
        return hint
    n = next(n for n in open_way if chosen[n] != wanted[n])
    force, moves = questions[n]
    given = "None" if chosen[n] is None else f"{chosen[n]}, at {angle_deg(force, chosen[n]):.0f}°"
    return (
        f"The force is ({', '.join(f'{part:.2f}' for part in force)}), {len(moves)} moves are legal, and you return "
        f"{given}. The smallest angle is {min(angle_deg(force, move) for move in moves):.0f}°."
    )


def angle_deg(force: Vector, move: Any) -> float:
    cosine = np.dot(force, move) / (np.linalg.norm(force) * np.linalg.norm(move))
    return float(np.degrees(np.arccos(np.clip(cosine, -1, 1))))


def smallest_angle(force: Vector, moves: list[Move]) -> Move | None:
    best = min(moves, key=lambda move: angle_deg(force, move))
    return best if angle_deg(force, best) < 90 else None


MOVE_MISTAKES: list[tuple[Callable[[Vector, list[Move]], Move], str]] = [
    (
        lambda force, moves: max(moves, key=lambda move: float(np.dot(force, move))),
        "You take the largest scalar product. A move through a corner is √3 long, and that makes its product large at "
        "a large angle, too: what is left of it when the length is taken out?",
    ),
    (
        lambda force, moves: max(moves, key=lambda move: angle_deg(force, move)),
        "You take the largest angle: uphill. Which sign has the scalar product along the force?",
    ),
    (
        lambda force, moves: min(moves, key=lambda move: float(np.linalg.norm(np.subtract(force, move)))),
        "You take the move that ends nearest to the force's tip. That depends on how large the force is; only its "
        "direction should count.",
    ),
    (
        lambda force, moves: next(move for move in moves if float(np.dot(force, move)) > 0),
        "You take the first move that leads downhill. There may be a better one among the rest.",
    ),
    (
        lambda force, moves: max(moves, key=lambda move: float(np.dot(force, move)) / float(np.dot(move, move))),
        "You divide by the squared length. To get the direction of a move, by what is it divided?",
    ),
]
