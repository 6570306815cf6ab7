"""Exercises of chapter 10: other ways to the answer pass; typical mistakes fail, each with a hint of its own."""

import math

import numpy as np
import pytest

from uavlab.exercises import check


def shared(weights):
    return weights / weights.sum()


def logs_of(tau, eta, alpha, beta):
    return alpha * np.log(tau) + beta * np.log(eta)


def shifted_by_mean(*case):
    logs = logs_of(*case)
    return shared(np.exp(logs - logs.mean()))


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # some of them overflow, which is the mistake
@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda t, e, a, b: t**a * e**b, "Those are weights"),
        (lambda *case: np.exp(logs_of(*case) - logs_of(*case).max()), "largest of yours is always 1"),
        (lambda t, e, a, b: shared(t * e), "doesn't depend on α and β"),
        (lambda t, e, a, b: shared(t**b * e**a), "swapped"),
        (lambda t, e, a, b: shared(e**b), "smell nothing"),
        (lambda t, e, a, b: shared(t**a), "don't know where the goal is"),
        (lambda t, e, a, b: shared(a * t + b * e), "A product says"),
        (lambda t, e, a, b: shared(t**a + e**b), "Eq. 2 multiplies"),
        (lambda *case: shared(logs_of(*case)), "takes a logarithm back"),
        (lambda t, e, a, b: shared(t**a / e**b), "run away from the goal"),
        (lambda t, e, a, b: shared(t**a * e**b), "which power left the range"),
        (lambda *case: shared(np.exp(logs_of(*case))), "which power left the range"),
        (shifted_by_mean, "nobody goes there"),
        (lambda t, e, a, b: shared(np.maximum(t, 0.05) ** a * e ** (b / 2)), "How many times likelier"),
        (lambda t, e, a, b: 2 * shared(t**a * e**b), "add up to 1, yours to 2"),
        (lambda *case: 0.5, "a probability for each neighbour"),
        (lambda *case: None, "returns nothing"),
    ],
)
def test_mistakes_with_the_odds(answer, hint):
    assert not check("10.1", answer)
    assert hint in check("10.1", answer).hint


@pytest.mark.filterwarnings("ignore:divide by zero")
def test_odds_by_logaddexp_are_right():
    assert check("10.1", lambda *case: np.exp(logs_of(*case) - np.logaddexp.reduce(logs_of(*case))))


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


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda t, w, n, r, q, lo, hi: np.clip(r * t + laid(t, w, n, q), lo, hi), "ρ is what goes"),
        (lambda t, w, n, r, q, lo, hi: np.clip(t + laid(t, w, n, q), lo, hi), "Nothing evaporates"),
        (walked_only, "only the nodes evaporate that were walked"),
        (lambda t, w, n, r, q, lo, hi: np.clip((1 - r) * (t + laid(t, w, n, q)), lo, hi), "fresh scent"),
        (
            lambda t, w, n, r, q, lo, hi: np.clip((1 - r) * t + laid(t, w, [1] * len(n), q), lo, hi),
            "however long its way",
        ),
        (
            lambda t, w, n, r, q, lo, hi: np.clip((1 - r) * t + laid(t, w, [1 / x for x in n], q), lo, hi),
            "long ways smell stronger",
        ),
        (by_concatenation, "you count one of them"),
        (lambda t, w, n, r, q, lo, hi: (1 - r) * t + laid(t, w, n, q), "Where are the limits"),
        (lambda t, w, n, r, q, lo, hi: np.minimum((1 - r) * t + laid(t, w, n, q), hi), "What about the lower"),
        (lambda t, w, n, r, q, lo, hi: np.maximum((1 - r) * t + laid(t, w, n, q), lo), "after the deposits"),
        (lambda t, w, n, r, q, lo, hi: np.clip((1 - r) * t, lo, hi) + laid(t, w, n, q), "after the deposits"),
        (in_place, "changes an array that it is given"),
        (lambda t, *rest: t, "Node 3 was walked by nobody"),
        (lambda t, *rest: t[:2], "The answer is the scent of each node"),
        (lambda *case: None, "returns nothing"),
    ],
)
def test_mistakes_with_the_update(answer, hint):
    assert not check("10.2", answer)
    assert hint in check("10.2", answer).hint


def test_update_of_all_ants_at_once_is_right():
    def update(tau, ways, lengths, rho, deposit, least, most):
        after = (1 - rho) * tau
        np.add.at(after, np.concatenate(ways), np.repeat(deposit / np.array(lengths), [len(way) for way in ways]))
        return np.maximum(np.minimum(after, most), least)

    assert check("10.2", update)


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


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda f, m, q, n, r, most: math.ceil((most - f) / (m * q / n)), "nothing evaporate meanwhile"),
        (lambda f, m, q, n, r, most: counted(f, m, q, n, r, most, gain=q / n), "one ant pass"),
        (lambda f, m, q, n, r, most: counted(f, m, q, n, r, most, kept=r), "ρ is what goes"),
        (lambda *case: counted(*case, fresh_fades=True), "fresh scent"),
        (lambda *case: counted(*case, late=1), "One too many"),
        (lambda *case: counted(*case, late=-1), "One too few"),
        (lambda *case: counted(*case) if counted(*case) is not None else 1000, "never reaches 15"),
        (lambda *case: counted(*case) if case[0] < 15 else None, "0 generations"),
        (lambda *case: 7, "Write down the scent"),
        (lambda *case: [3], "one whole number"),
        (lambda *case: None, "always return None"),
    ],
)
def test_mistakes_with_the_limit(answer, hint):
    assert not check("10.3", answer)
    assert hint in check("10.3", answer).hint


@pytest.mark.parametrize("answer", [counted, by_formula])
def test_limit_by_loop_and_by_formula_is_right(answer):
    assert check("10.3", answer)


def test_solution_agrees_with_the_steady_state(solutions):
    until = solutions["generations_until_capped"]
    binding = 10 * 100 / (150 * 15)  # ρ at which n Q/(ρ L) = τ_max
    assert until(0.05, 10, 100.0, 150.0, 0.99 * binding, 15.0) > 0
    assert until(0.05, 10, 100.0, 150.0, 1.01 * binding, 15.0) is None
