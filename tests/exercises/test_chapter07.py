"""Exercises of chapter 07: other ways to the answer pass; typical mistakes fail, each with a hint of its own."""

import math
from functools import partial
from itertools import combinations

import numpy as np
import pytest
from scipy.optimize import linprog

from uavlab.city import table1_city
from uavlab.exercises import check
from uavlab.planners import repare
from uavlab.resilience import DISTURBANCES, LEVELS, LOADS, resilience_level


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
        (lambda *case: price(*case, scale=1.0), "where is ω₀"),
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
        ((RIGHT[0] | {"dead": None}, RIGHT[1], (5, 9, 15, 21)), "load 'dead' are no number"),
        ((*RIGHT, 5), "the thresholds are a list"),
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
        ("flutter", "jump up and down"),
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


def has_score(table):
    """Whether points and thresholds give a table of levels (4, 4): a question of linear inequalities."""
    rows, bounds = [], []
    for (row, column), level in np.ndenumerate(table):
        points = np.zeros(12)  # of loads, of disturbances, then the thresholds
        points[[column, 4 + row]] = 1
        for sign, threshold, bound in ((-1, level - 1, 0), (1, level, -1)):
            if 0 <= threshold < 4:
                rows.append(sign * (points - np.eye(12)[8 + threshold]))
                bounds.append(bound)
    return linprog(np.zeros(12), A_ub=rows, b_ub=bounds, bounds=(None, None)).status == 0


def test_few_swaps_leave_a_table_with_a_score():
    table = np.array([[LEVELS.index(resilience_level(load, wind)) for load in LOADS] for wind in DISTURBANCES])
    assert has_score(table)
    scores = []
    for one, other in combinations(np.ndindex(table.shape), 2):
        swapped = table.copy()
        swapped[one], swapped[other] = table[other], table[one]
        if table[one] != table[other]:
            scores.append(has_score(swapped))
    assert (sum(scores), len(scores)) == (10, 99)


def test_thresholds_in_an_array_are_right():
    assert check("07.3", lambda: (*RIGHT, np.array([5, 9, 15, 21])))


@pytest.mark.parametrize("weight", [0.134, 0.13, np.float64(0.14), np.array(0.137)])
def test_the_smallest_weight(weight):
    assert check("07.5", weight)


@pytest.mark.parametrize(
    "own_price",
    [
        lambda distance: 1 + 3 * np.exp(-distance),
        lambda distance: (1 + 3 * np.exp(-distance)).tolist(),
        lambda distance: 1 + 70 / 31.4 * np.exp(-((distance - 0.5) ** 2) / 2),
    ],
)
def test_other_prices_that_win(own_price):
    assert check("07.6", own_price)


@pytest.mark.parametrize(
    ("own_price", "hint"),
    [
        (lambda distance: 1 + distance, "Both are worse"),
        (lambda distance: np.full_like(distance, np.inf), "an endless price is none"),
        (lambda distance: np.nan * distance, "your price is nan"),
        (lambda distance: 1.0, "an array with a price for each distance"),
        (lambda distance: 1 if distance < 3.5 else 3, "raises ValueError"),
    ],
)
def test_prices_that_do_not_win(own_price, hint):
    assert not check("07.6", own_price)
    assert hint in check("07.6", own_price).hint


def test_the_smallest_weight_is_where_two_costs_meet(solutions):
    below = repare(table1_city(), (90, 18, 30), (50, 44, 30), penalty=0.13)
    safe = repare(table1_city(), (90, 18, 30), (50, 44, 30), penalty=0.14)
    assert below.clearance(table1_city()) < 3.5 == safe.clearance(table1_city())
    where = (safe.length - below.length) / ((below.cost - below.length) / 0.13)
    assert math.isclose(where, solutions["smallest_weight"], rel_tol=0.01)


def step_of(price):
    return lambda distance: np.where(distance < 3.5, price, 1.0)


MISTAKES = {
    "07.2": {
        "where is ω₀": lambda *case: price(*case, scale=1.0),
        "what is O_risk there": lambda *case: price(*case, zone=False),
        "Where does n point": lambda *case: price(*case, blown=lambda w, n: max(0.0, w @ n)),
        "way 2": by_size,
    },
    "07.3": {
        "four thresholds": lambda: (*RIGHT, (5, 9, 15)),
        "must rise": lambda: (*RIGHT, (9, 5, 15, 21)),
        "15 of 16": lambda: (*RIGHT, (5, 9, 15, 23)),
        "load 'heavy'": lambda: ({"dead": 0, "light": 2, "moderate": 8}, RIGHT[1], (5, 9, 15, 21)),
    },
    "07.4": {
        words: partial(walk, mistake=mistake)
        for mistake, words in (
            ("never", "never comes down"), ("flutter", "jump up and down"), ("one step", "still below it"),
            ("boundary", "push it up again"),
        )
    },
    "07.5": {
        "Go on halving": 2.0,
        "look between two tries": 0.2,
        "the route comes to 2.1 m": 0.1,
        "how much longer the safe route is": 71.213 / 66.385 - 1,
        "REPARE is plain A*": 0.0,
    },
    "07.6": {
        "no metre costs less": lambda distance: np.exp(-distance),
        "distance doesn't count": np.ones_like,
        "too often": step_of(3.0),
        "farther than they need to": lambda distance: 1 + 30 * np.exp(-distance),
    },
}  # fmt: skip
