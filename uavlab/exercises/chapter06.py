"""Exercises of chapter 6: what stops a UAV in a potential field, pushes of walls, moves, and a potential without traps.

A hint says which mistake the answers look like and why it is one. Mistakes are recognised by what they answer, not
by how they are written.
"""

from __future__ import annotations

import itertools
import math
import operator
from collections.abc import Callable, Iterator, Sequence
from functools import cache, partial
from typing import Any

import numpy as np
from scipy.ndimage import distance_transform_edt
from scipy.optimize import brentq

from uavlab.city import table1_city
from uavlab.exercises.hints import alike, each_alike, recognised
from uavlab.exercises.kinds import Quiz, asks_for, asks_for_value, number, numbers, whole_number
from uavlab.planners import repulsion

Vector = Sequence[float] | np.ndarray
Move = tuple[int, ...]
Cell = tuple[int, int]
Push = Callable[..., np.ndarray]

MOVES: list[Move] = [move for move in itertools.product((-1, 0, 1), repeat=3) if any(move)]

exercise_1 = Quiz(
    "b",
    "A common factor changes the size of the resultant and leaves its direction alone, and only the direction steers. "
    "That is why the chapter could set k_tra to 1.",
    {
        "a": "The pushes are twice as large at each place, that is true. What has become of the pull that they have to "
        "stand up to?",
        "c": "The pull is twice as large, that is true. Write down the condition that pull and push cancel, and divide "
        "both sides by two.",
        "d": "How long is a step of `follow`? Look for the place where the force is divided by its own size.",
    },
)


@asks_for(number("the distance [m]"))
def exercise_2(balance: Callable[[float, float, float], float]) -> str:
    """06.2: the distance at which pull and push cancel, in front of a wall."""
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


@asks_for(numbers((3,), "the force, a vector of three numbers, also where it is zero"))
def exercise_3(push_of_nearest: Push) -> str:
    """06.3: the force of the nearest of several voxels on a UAV."""
    rng = np.random.default_rng(71)
    points = rng.uniform(-1, 1, (60, 3))
    several = [np.array([voxel_beside(rng, point) for _ in range(4)]) for point in points]
    questions = [(point, lows, 7.0, 4.0) for point, lows in zip(points, several, strict=True)]
    questions += [(point, lows[:1], 7.0, 4.0) for point, lows in zip(points, several, strict=True)]
    answers = np.array([push_of_nearest(*question) for question in questions], dtype=float)
    within = np.array([distance_to_voxel(point, nearest_of(point, lows)) <= 4.0 for point, lows, *_ in questions])
    same = partial(alike, relative=1e-9, absolute=1e-12)
    near, far = (list(itertools.compress(questions, chosen)) for chosen in (within, ~within))
    if same(answers[within], [by_nearest(push_within_reach)(*question) for question in near]):
        if same(answers[~within], [by_nearest(push_everywhere)(*question) for question in far]):
            return "Right within the range. Beyond it your voxel attracts: what is the sign of 1/D − 1/R there?"
        if not same(answers[~within], np.zeros((len(far), 3))):
            return "Right within the range. How large is the force beyond it?"
        return ""
    if hint := recognised(answers[within], PUSH_MISTAKES, near, same):
        return hint
    alone = within & (np.arange(len(questions)) >= len(points))
    singles = list(itertools.compress(questions, alone))
    if same(answers[alone], [by_nearest(push_within_reach)(*question) for question in singles]):
        return "With one voxel it is right. With several you choose another than the nearest: nearest to which point?"
    size = float(np.linalg.norm(push_of_nearest(np.array([3.0, 0.5, 0.5]), np.zeros((1, 3)), 7.0, 4.0)))
    return (
        f"2 m east of a single voxel, with k_rep = 7 and R = 4 m, your force has the size {size:.4f}. Go through it by "
        "hand: the voxel's nearest point, the distance to it, the size of the push, its direction."
    )


def voxel_beside(rng: np.random.Generator, point: np.ndarray) -> np.ndarray:
    """The lowest corner of a voxel from 0.3 to 5 m away from a point."""
    while True:
        low = rng.integers(-5, 5, 3).astype(float)
        if 0.3 < distance_to_voxel(point, low) < 5:
            return low


def nearest_of(point: Vector, lows: np.ndarray) -> np.ndarray:
    return min(lows, key=lambda low: distance_to_voxel(point, low))


def by_nearest(push: Push, at: float | None = None) -> Push:
    """The push of the nearest voxel, from a push of one; measured to its nearest point, or to one that all share."""

    def pushed(point: Vector, lows: np.ndarray, *setting: float) -> np.ndarray:
        if at is None:
            return push(point, nearest_of(point, lows), *setting)
        return push(point, min(lows, key=lambda low: math.dist(point, low + at)), *setting)

    return pushed


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


def potential_size(point: Vector, low: Vector, push: float, reach: float) -> np.ndarray:
    """Along the force, but as large as the potential."""
    distance = distance_to_voxel(point, low)
    return push_everywhere(point, low, push, reach) * distance**2 * (1 / distance - 1 / reach) / 2


CENTER = "You measure from the voxel's centre. It is a cube: which of its points is nearest to the UAV?"
CORNER = "You measure from the voxel's lowest corner. It is a cube: which of its points is nearest to the UAV?"
PUSH_MISTAKES: list[tuple[Push, str]] = [
    (
        lambda point, lows, *q: np.sum([push_within_reach(point, low, *q) for low in lows], axis=0),
        "You add up the pushes of all voxels, as the chapter does. Which single one is asked for here?",
    ),
    (
        by_nearest(lambda *q: -push_everywhere(*q)),
        "The size is right, but your voxel attracts. From where to where does the vector point?",
    ),
    (
        by_nearest(lambda *q: push_everywhere(*q) * distance_to_voxel(*q[:2])),
        "The direction is right, and the force D times too large. Either the vector for the direction has the length D "
        "instead of 1, or a factor 1/D is missing in the size: compare with Eq. 5.",
    ),
    (by_nearest(push_from_center, 0.5), CENTER),
    (by_nearest(push_from_center_within_reach, 0.5), CENTER),
    (by_nearest(push_from_corner, 0.0), CORNER),
    (by_nearest(push_from_corner_within_reach, 0.0), CORNER),
    (
        by_nearest(potential_size),
        "That has the size of the potential. The force is its slope: where does the factor 1/D² come from?",
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
                "them, against the force. What does the UAV do at the bottom of a local minimum?"
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


@asks_for_value(whole_number("the height of the lowest goal with which the UAV arrives [m]"))
def exercise_5(lowest: float) -> str:
    """06.5: how high the goal has to be for the UAV to get out of the notch."""
    return "" if lowest == 63 else HEIGHTS.get(int(lowest), "That isn't it. Go up in steps of 1 m and print each one.")


HEIGHTS = {
    30: "At 30 m it is stuck: that is the trap of the chapter.",
    62: "With 62 m it is still stuck. Asked for is the first height with which it arrives, not the last without.",
    65: "The wall is 65 m high, so that was a good guess. Did you fly? Print the outcome for each height from 55 m on.",
    66: "With 66 m it arrives, but a lower goal does, too. Which moves do you fly with? Continuous ones are asked for.",
    70: "The ridge of the roof is 70 m high. Does the UAV have to pass over it? Fly, and print the outcome.",
}


@asks_for(numbers(lambda free, goal: free.shape, "the potential, one number for each cell of `free`"))
def exercise_6(my_potential: Callable[[np.ndarray, Cell], np.ndarray]) -> str:
    """06.6: a potential whose way downhill arrives from everywhere, keeps a distance and is short."""
    for free, goal, where in ((small_maze(), (17, 3), "a small maze"), (slice_at_30_m(), (50, 44), "the map at 30 m")):
        heights = np.array(my_potential(free, goal), dtype=float)
        if unknown := int((~np.isfinite(heights[free])).sum()):
            return (
                f"On {where} your potential is no finite number in {unknown} free cells. A UAV that starts there can't "
                "know where to go. A place near a wall may be expensive, but not closed."
            )
        if heights[goal] > heights[free].min():
            return f"On {where} the goal isn't your lowest free cell. Does your potential rise or fall towards it?"
        free_cells = [(x, y) for x, y in np.argwhere(free).tolist()]
        traps = [cell for cell in free_cells if cell != goal and not any(lower_neighbours(heights, free, cell))]
        if traps:
            return f"On {where} {len(traps)} free cells have no lower neighbour, such as {traps[0]}: these are traps."
    way = way_downhill(heights, free, (90, 18))
    room = float(distance_transform_edt(free)[tuple(np.transpose(way))].min())
    length = float(np.linalg.norm(np.diff(way, axis=0), axis=1).sum())
    if room < 3.5:
        return (
            f"No traps. From the notch the way is {length:.1f} m long, but it comes to {room:.1f} m from the centre of "
            "an occupied cell. How could a metre near a wall count more than a metre elsewhere?"
        )
    if length > 72:
        return (
            f"No traps, and never nearer than {room:.1f} m. But the way from the notch is {length:.1f} m long, "
            "and 72 m are possible. Does your potential keep away from walls more than it has to?"
        )
    return ""


@cache
def slice_at_30_m() -> np.ndarray:
    return ~table1_city().occupied[:, :, 30]


@cache
def small_maze() -> np.ndarray:
    """Three walls with a gap each, at alternate ends."""
    free = np.ones((21, 21), bool)
    free[5, 4:] = free[10, :17] = free[15, 4:] = False
    return free


def lower_neighbours(heights: np.ndarray, free: np.ndarray, cell: Cell) -> Iterator[tuple[float, Cell]]:
    """Where legal moves lead down, with the drop per metre."""
    for dx, dy in itertools.product((-1, 0, 1), repeat=2):
        x, y = cell[0] + dx, cell[1] + dy
        inside = 0 <= x < free.shape[0] and 0 <= y < free.shape[1]
        if inside and free[x, y] and free[cell[0], y] and free[x, cell[1]] and heights[x, y] < heights[cell]:
            yield float(heights[cell] - heights[x, y]) / math.hypot(dx, dy), (x, y)


def way_downhill(heights: np.ndarray, free: np.ndarray, cell: Cell) -> list[Cell]:
    way = [cell]
    while lower := list(lower_neighbours(heights, free, way[-1])):
        way.append(max(lower)[1])
    return way
