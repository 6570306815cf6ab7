"""Exercises of chapter 10: other ways to the answer pass; typical mistakes fail, each with a hint of its own."""

import math

import numpy as np
import pytest

from uavlab.exercises import chapter10, check
from uavlab.risk import random_campus


def shared(weights):
    return weights / weights.sum()


def logs_of(tau, eta, alpha, beta):
    return alpha * np.log(tau) + beta * np.log(eta)


def shifted_by_mean(*case):
    logs = logs_of(*case)
    return shared(np.exp(logs - logs.mean()))


def laid(tau, ways, lengths, deposit):
    on_top = np.zeros_like(tau)
    for way, length in zip(ways, lengths, strict=True):
        on_top[way] += deposit / length
    return on_top


def in_place(tau, ways, lengths, rho, deposit, least, most):
    tau *= 1 - rho
    tau += laid(tau, ways, lengths, deposit)
    return np.clip(tau, least, most)


def by_concatenation(tau, ways, lengths, rho, deposit, least, most):
    after = (1 - rho) * tau
    nodes = np.concatenate(ways)
    after[nodes] += np.repeat(deposit / np.array(lengths), [len(way) for way in ways])
    return np.clip(after, least, most)


def walked_only(tau, ways, lengths, rho, deposit, least, most):
    after = tau.copy()
    nodes = np.unique(np.concatenate(ways))
    after[nodes] *= 1 - rho
    return np.clip(after + laid(tau, ways, lengths, deposit), least, most)


def counted(first, ants, deposit, length, rho, most, *, gain=None, kept=None, fresh_fades=False, late=0):
    """A loop that stops after 1 000 generations, which can be broken in several ways."""
    gain = ants * deposit / length if gain is None else gain
    kept = 1 - rho if kept is None else kept
    for generation in range(1000):
        if first >= most:
            return generation + late
        first = kept * (first + gain) if fresh_fades else kept * first + gain
    return None


def by_formula(first, ants, deposit, length, rho, most):
    rest = ants * deposit / (rho * length)
    if first >= most:
        return 0
    return None if rest <= most else math.ceil(math.log((rest - most) / (rest - first)) / math.log(1 - rho))


MISTAKES = {
    "10.2": {
        "ρ is what goes": lambda t, w, n, r, q, lo, hi: np.clip(r * t + laid(t, w, n, q), lo, hi),
        "Nothing evaporates": lambda t, w, n, r, q, lo, hi: np.clip(t + laid(t, w, n, q), lo, hi),
        "only the nodes evaporate that were walked": walked_only,
        "fresh scent": lambda t, w, n, r, q, lo, hi: np.clip((1 - r) * (t + laid(t, w, n, q)), lo, hi),
        "however long its way": lambda t, w, n, r, q, lo, hi: np.clip(
            (1 - r) * t + laid(t, w, [1] * len(n), q), lo, hi
        ),
        "long ways smell stronger": lambda t, w, n, r, q, lo, hi: np.clip(
            (1 - r) * t + laid(t, w, [1 / x for x in n], q), lo, hi
        ),
        "you count one of them": by_concatenation,
        "Where are the limits": lambda t, w, n, r, q, lo, hi: (1 - r) * t + laid(t, w, n, q),
        "What about the lower": lambda t, w, n, r, q, lo, hi: np.minimum((1 - r) * t + laid(t, w, n, q), hi),
        "after the deposits": lambda t, w, n, r, q, lo, hi: np.maximum((1 - r) * t + laid(t, w, n, q), lo),
        "changes an array that it is given": in_place,
        "Node 3 was walked by nobody": lambda t, *rest: t,
        "The answer is the scent of each node": lambda t, *rest: t[:2],
    },
    "10.3": {
        "Those are weights": lambda t, e, a, b: t**a * e**b,
        "largest of yours is always 1": lambda *case: np.exp(logs_of(*case) - logs_of(*case).max()),
        "doesn't depend on α and β": lambda t, e, a, b: shared(t * e),
        "swapped": lambda t, e, a, b: shared(t**b * e**a),
        "smell nothing": lambda t, e, a, b: shared(e**b),
        "don't know where the goal is": lambda t, e, a, b: shared(t**a),
        "A product says": lambda t, e, a, b: shared(a * t + b * e),
        "Eq. 1 multiplies": lambda t, e, a, b: shared(t**a + e**b),
        "takes a logarithm back": lambda *case: shared(logs_of(*case)),
        "run away from the goal": lambda t, e, a, b: shared(t**a / e**b),
        "which power left the range": lambda t, e, a, b: shared(t**a * e**b),
        "nobody goes there": shifted_by_mean,
        "How many times likelier": lambda t, e, a, b: shared(np.maximum(t, 0.05) ** a * e ** (b / 2)),
        "add up to 1, yours to 2": lambda t, e, a, b: 2 * shared(t**a * e**b),
        "a probability for each neighbour": lambda *case: 0.5,
    },
    "10.4": {
        "nothing evaporate meanwhile": lambda f, m, q, n, r, most: math.ceil((most - f) / (m * q / n)),
        "one ant pass": lambda f, m, q, n, r, most: counted(f, m, q, n, r, most, gain=q / n),
        "ρ is what goes": lambda f, m, q, n, r, most: counted(f, m, q, n, r, most, kept=r),
        "fresh scent": lambda *case: counted(*case, fresh_fades=True),
        "One too many": lambda *case: counted(*case, late=1),
        "One too few": lambda *case: counted(*case, late=-1),
        "never reaches 15": lambda *case: counted(*case) if counted(*case) is not None else 1000,
        "0 generations": lambda *case: counted(*case) if case[0] < 15 else None,
        "Write down the scent": lambda *case: 7,
        "one whole number": lambda *case: [3],
        "always return None": lambda *case: None,
    },
    "10.5": {
        "*any turn* has the lower cost": (26, 84, "hurts"),
        "says nothing about which is better": (58, 100, "not shown"),
        "count ties as wins": (74, 100, "helps"),
        "twenty campuses of the example": (11, 16, "not shown"),
        "That is our colony": (99, 100, "helps"),
        "different seeds": (59, 95, "helps"),
        "contain 50 %": (58, 84, "not shown"),
        "is that bad": (58, 84, "hurts"),
        "The verdict is one of": (58, 84, "better"),
        "Which number comes first": (84, 58, "helps"),
        "Hand over counts": (0.5, 0.69, "helps"),
        "There are three": (58, 84),
        "are numbers of campuses": ("58", 84, "helps"),
        "Costs are the same when": (40, 70, "not shown"),
    },
    "10.6": {
        "isn't to be changed": {"budget": 10**6},
        "don't see the risk": {"gamma": 0.0},
        "The colony refuses": {"evaporation": 1.0},
        "walks exactly as ours": {"max_pheromone": 15.0},
        "it is worse": {"beta": 80.0},
        "not shown to be better": {"gamma": 3.0},
        "is one number": {"beta": "large"},
        "is a dictionary of habits": [12.0, 2.0],
    },
}


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize(
    ("number", "answer", "words"),
    [
        ("10.2", lambda t, w, n, r, q, lo, hi: np.clip((1 - r) * t, lo, hi) + laid(t, w, n, q), "after the deposits"),
        ("10.3", lambda *case: shared(np.exp(logs_of(*case))), "which power left the range"),
    ],
)
def test_the_same_mistake_in_another_form(number, answer, words):
    assert words in check(number, answer).hint


@pytest.mark.filterwarnings("ignore:divide by zero")
def test_odds_by_logaddexp_are_right():
    assert check("10.3", lambda *case: np.exp(logs_of(*case) - np.logaddexp.reduce(logs_of(*case))))


def test_update_of_all_ants_at_once_is_right():
    def update(tau, ways, lengths, rho, deposit, least, most):
        after = (1 - rho) * tau
        np.add.at(after, np.concatenate(ways), np.repeat(deposit / np.array(lengths), [len(way) for way in ways]))
        return np.maximum(np.minimum(after, most), least)

    assert check("10.2", update)


@pytest.mark.parametrize("answer", [counted, by_formula])
def test_limit_by_loop_and_by_formula_is_right(answer):
    assert check("10.4", answer)


def test_solution_agrees_with_the_steady_state(solutions):
    until = solutions["generations_until_capped"]
    binding = 10 * 100 / (150 * 15)  # ρ at which n Q/(ρ L) = τ_max
    assert until(0.05, 10, 100.0, 150.0, 0.99 * binding, 15.0) > 0
    assert until(0.05, 10, 100.0, 150.0, 1.01 * binding, 15.0) is None


@pytest.mark.parametrize("answer", [(58, 84, "helps"), (np.int64(57), 84.0, "helps"), (58, 85, "helps")])
def test_counts_are_right_to_a_rounding_or_two(answer):
    assert check("10.5", answer)


def test_counts_are_those_of_the_colony(solutions):
    pairs = [solutions["with_and_without"](random_campus(number)) for number in range(200, 300)]
    costs = np.array(pairs)
    change = costs[:, 0] / costs[:, 1] - 1
    assert ((change < -1e-6).sum(), (abs(change) > 1e-6).sum()) == (chapter10.BETTER, chapter10.DIFFER)


def test_another_colony_that_is_better_passes():
    assert check("10.6", {"beta": 24, "gamma": np.float64(4.0), "evaporation": 0.3})
