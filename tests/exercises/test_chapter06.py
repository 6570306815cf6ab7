"""Exercises of chapter 06: other ways to the answer pass; typical mistakes fail, each with a hint of its own."""

import heapq
import math
from itertools import product

import numpy as np
import pytest
from scipy.ndimage import distance_transform_edt
from solved import EXERCISES

from uavlab.city import table1_city
from uavlab.exercises import chapter06, check
from uavlab.planners import potential_field

NUMBERS = ("06.1", "06.2", "06.3", "06.4", "06.5", "06.6")


@pytest.mark.parametrize("number", NUMBERS)
def test_solution_passes_and_the_blank_fails(number, solutions):
    assert check(number, solutions[EXERCISES[number]])
    assert "no answer yet" in check(number, None).hint


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


def nearest(point, lows, push, reach, *, at=None, beyond=False, times=lambda d: 1.0):
    """The push of the nearest voxel, which can be broken in several ways."""
    nearest_points = np.clip(point, lows, lows + 1) if at is None else lows + at
    away = point - nearest_points
    distance = np.linalg.norm(away, axis=1)
    away, distance = away[distance.argmin()], distance.min()
    if distance > reach and not beyond:
        return np.zeros(3)
    return push * (1 / distance - 1 / reach) / distance**2 * times(distance) * away / distance


def all_of_them(point, lows, push, reach):
    return np.sum([nearest(point, low[None], push, reach) for low in lows], axis=0)


def first_of_them(point, lows, push, reach):
    return nearest(point, lows[:1], push, reach)


def nearest_center(point, lows, push, reach):
    """The right push, of the voxel whose centre is nearest."""
    chosen = np.linalg.norm(point - lows - 0.5, axis=1).argmin()
    return nearest(point, lows[chosen : chosen + 1], push, reach)


def flat_size(point, lows, push, reach):
    """1/D for 1/D²."""
    return nearest(point, lows, push, reach, times=lambda d: d)


def one_by_one(point, lows, push, reach):
    """Another right way: loops, and a list as the answer."""
    best = (math.inf, None)
    for low in lows.tolist():
        near = [min(max(x, a), a + 1) for x, a in zip(point, low, strict=True)]
        best = min(best, (math.dist(point, near), near))
    d, near = best
    size = push * (1 / d - 1 / reach) / d**2 if d < reach else 0.0
    return [size * (x - q) / d for x, q in zip(point, near, strict=True)]


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


def straight(free, goal):
    x, y = np.indices(free.shape)
    return np.hypot(x - goal[0], y - goal[1])


def cost(free, goal, price):
    """The cost-to-go for a price per metre."""
    found = np.full(free.shape, np.inf)
    found[goal] = 0.0
    waiting = [(0.0, goal)]
    while waiting:
        way, (x, y) = heapq.heappop(waiting)
        if way > found[x, y]:
            continue
        for dx, dy in product((-1, 0, 1), repeat=2):
            u, v = x + dx, y + dy
            inside = (dx or dy) and 0 <= u < free.shape[0] and 0 <= v < free.shape[1]
            if inside and free[u, v] and free[x, v] and free[u, y]:
                total = way + math.hypot(dx, dy) * (price[x, y] + price[u, v]) / 2
                if total < found[u, v]:
                    found[u, v] = total
                    heapq.heappush(waiting, (total, (u, v)))
    return found


def unpriced(free, goal):
    return cost(free, goal, np.ones(free.shape))


def closed(free, goal):
    roomy = free & (distance_transform_edt(free) >= 3.5)
    roomy[goal] = True
    return cost(roomy, goal, np.ones(free.shape))


def smooth(free, goal):
    return cost(free, goal, 1 + 3 / np.maximum(distance_transform_edt(free) - 0.5, 0.1) ** 2)


def steep(free, goal):
    return cost(free, goal, np.where(distance_transform_edt(free) < 3.5, 1e6, 1.0))


def harmonic(free, goal):
    value = np.zeros(free.shape)
    for _ in range(3000):
        value[goal] = 1.0
        padded = np.pad(value, 1)
        value = np.where(free, (padded[2:, 1:-1] + padded[:-2, 1:-1] + padded[1:-1, 2:] + padded[1:-1, :-2]) / 4, 0.0)
    value[goal] = 1.0
    return -value


def uphill(free, goal):
    return -np.where(free, unpriced(free, goal), 0.0)


MISTAKES = {
    "06.2": {
        "what does 1/R take away": lambda pull, push, reach: (push / pull) ** (1 / 3),
        "doesn't depend on the pull": lambda pull, push, reach: by_cubic(1, push, reach),
        "their slopes": lambda pull, push, reach: 1 / (math.sqrt(2 * pull / push) + 1 / reach),
        "Which factor of the push is missing": lambda pull, push, reach: 1 / (pull / push + 1 / reach),
        "At its reach the push is 0": lambda pull, push, reach: reach,
        "Between which two must it lie": lambda pull, push, reach: -1.0,
        "It has to be more exact": lambda pull, push, reach: round(by_cubic(pull, push, reach), 3),
        "too much to cancel the pull": lambda pull, push, reach: 1.0,
        "too little to cancel the pull": lambda pull, push, reach: 2.0,
    },
    "06.3": {
        "You add up the pushes of all": all_of_them,
        "your voxel attracts. From where to where": lambda *q: -nearest(*q),
        "the force D times too large": flat_size,
        "Beyond it your voxel attracts": lambda *q: nearest(*q, beyond=True),
        "How large is the force beyond it": lambda *q: nearest(*q) if nearest(*q).any() else np.ones(3),
        "from the voxel's centre": lambda *q: nearest(*q, at=0.5),
        "lowest corner": lambda *q: nearest(*q, at=0.0),
        "size of the potential": lambda *q: nearest(*q, times=lambda d: d**2 * (1 / d - 1 / q[3]) / 2),
        "nearest to which point": nearest_center,
        "Go through it by hand": lambda *q: 2 * nearest(*q),
        "returns one number": lambda *q: np.linalg.norm(nearest(*q)),
    },
    "06.4": {
        "largest scalar product": lambda force, moves: best(force, moves, np.dot),
        "squared length": lambda force, moves: best(force, moves, lambda f, m: np.dot(f, m) / np.dot(m, m)),
        "uphill": backwards,
        "only its direction should count": tip,
        "the first move that leads downhill": downhill,
        "bottom of a local minimum": lambda f, moves: max(moves, key=lambda move: along(f, move), default=None),
        "below 90°": lambda force, moves: best(force, moves, least=-1e-9),
        "there is none to return": lambda force, moves: best(force, moves) if moves else (0, 0, 0),
        "not among the legal moves": lambda force, moves: tuple(np.sign(force).astype(int).tolist()),
        "always returns None": lambda force, moves: None,
        "The smallest angle is": lambda force, moves: moves[0],
    },
    "06.5": {
        "that is the trap of the chapter": 30,
        "still stuck": 62,
        "that was a good guess": 65,
        "Which moves do you fly with": 66,
        "The ridge of the roof": 70.0,
        "Go up in steps of 1 m": 64,
        "The answer is a whole number": 63.5,
    },
    "06.6": {
        "free cells have no lower neighbour": straight,
        "comes to 1.0 m from the centre": unpriced,
        "may be expensive, but not closed": closed,
        "72 m are possible": harmonic,
        "Does your potential rise or fall": uphill,
    },
}


@pytest.mark.parametrize(
    ("number", "answer"),
    [
        ("06.2", by_newton),
        ("06.2", by_cubic),
        ("06.3", one_by_one),
        ("06.4", by_angle),
        ("06.4", best),
        ("06.4", lambda force, moves: (m := best(force, moves)) and np.array(m)),
        ("06.5", 63.0),
        ("06.5", np.int64(63)),
        ("06.6", smooth),
        ("06.6", steep),
    ],
)
def test_other_ways_to_the_answer(number, answer):
    assert check(number, answer), check(number, answer)


def test_quiz_explains_each_wrong_choice():
    for letter in "acd":
        assert check("06.1", letter).hint == chapter06.exercise_1.wrong[letter]
    assert "only the direction steers" in repr(check("06.1", "b"))


def test_more_mistakes_with_moves_and_pushes():
    assert "The smallest angle is" in check("06.4", lambda force, moves: best(np.round(force), moves)).hint
    assert "raises IndexError" in check("06.3", lambda *q: q[9]).hint
    assert "also where it is zero" in check("06.3", lambda *q: nearest(*q) if nearest(*q).any() else 0).hint
    assert "your force has the size" in check("06.3", lambda *q: 2 * nearest(*q)).hint


def test_heights_of_the_experiment_are_those_that_are_flown():
    """62 m is stuck and 63 m arrives, also with other steps: it isn't a matter of rounding."""
    city = table1_city()
    for step in (0.3, 0.5, 0.6):
        reached = [
            potential_field(city, (90, 18, 30), (50, 44, z), moves="continuous", step=step).reached for z in (62, 63)
        ]
        assert reached == [False, True]
    assert potential_field(city, (90, 18, 30), (50, 44, 66)).reached
    assert not potential_field(city, (90, 18, 30), (50, 44, 65)).reached
