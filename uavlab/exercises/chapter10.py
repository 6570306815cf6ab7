"""Exercises of chapter 10, ant colony: a quiz, the scent's update, the choice in logarithms, a limit, two experiments.

A hint says which mistake the answers look like and why it is one. Mistakes are recognised by what they answer, not
by how they are written.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np
import numpy.typing as npt

from uavlab.exercises.hints import each_alike, recognised
from uavlab.exercises.kinds import Quiz, asks_for, asks_for_value, described, is_number, numbers, thing, whole_number
from uavlab.planners import ant_colony, compare_planners
from uavlab.risk import random_campus

Odds = Callable[[np.ndarray, np.ndarray, float, float], npt.ArrayLike]
Update = Callable[[np.ndarray, list[list[int]], list[float], float, float, float, float], npt.ArrayLike]
Until = Callable[[float, int, float, float, float, float], int | None]


exercise_1 = Quiz(
    right="c",
    because="53 % [38, 67] contains 50 %, so these pairs can't tell. More campuses might.",
    wrong={
        "a": "More than half of these pairs, yes. But how often does a fair coin show heads in 53 % of so many throws? "
        "What does the interval say?",
        "b": "The interval goes up to 67 %. Could a rule that helps in 67 % of all pairs have given these runs?",
        "d": "The pairs have the same campus, the same seed and as many ants, and only one thing differs. What would "
        "be unfair about that? And would an unfair comparison explain a wide interval?",
    },
)


@asks_for(numbers(lambda tau, *_: tau.shape, "the scent of each node"), unchanged=True)
def exercise_2(update: Update) -> str:
    """10.2: the pheromone after a generation, with evaporation, deposits and limits."""
    case = (np.array([10.0, 10.0, 10.0, 10.0]), [[0, 1], [0, 2]], [20.0, 50.0], 0.8, 100.0, 0.0, 15.0)
    cases = (case, *UPDATES)
    answers = [update(*one) for one in cases]
    same = partial(each_alike, same=np.allclose)
    if same(answers, [updated(*one) for one in cases]):
        return ""
    return recognised(answers, UPDATE_MISTAKES, cases, same) or (
        f"Four nodes with τ = 10, two ants over nodes (0, 1) and (0, 2), of 20 and 50 m, ρ = 0.8, Q = 100, no limits "
        f"that bind: you get {np.round(np.asarray(answers[0], dtype=float), 3)}. Node 3 was walked by nobody: what is "
        "left of its scent? And what comes on top at node 0?"
    )


def updated(
    tau: np.ndarray,
    ways: Sequence[Sequence[int]],
    lengths: Sequence[float],
    evaporation: float,
    deposit: float,
    least: float,
    most: float,
    *,
    kept: float | None = None,
    unit: Callable[[float, float], float] = lambda deposit, length: deposit / length,
    each: bool = True,
    fades_after: bool = False,
    only_walked: bool = False,
    limits: str = "after",
) -> np.ndarray:
    """Pheromone after a generation, by rules that may be wrong."""
    kept = 1 - evaporation if kept is None else kept
    laid = np.zeros_like(tau)
    for way, length in zip(ways, lengths, strict=True):
        laid[list(way)] = laid[list(way)] * each + unit(deposit, length)
    faded = np.where((laid > 0) | (not only_walked), kept * tau, tau)
    after = kept * (tau + laid) if fades_after else faded + laid
    low = least if limits in ("after", "least") else -np.inf
    return np.clip(after, low, most if limits in ("after", "most") else np.inf)


def drawn_updates() -> list[tuple]:
    """Cases in which both limits bind somewhere, and some nodes are walked by several ants; and one with little Q."""
    rng = np.random.default_rng(92)
    cases = []
    for evaporation, deposit in ((0.3, 100.0), (0.8, 100.0), (0.1, 40.0), (0.6, 150.0), (0.4, 0.05)):
        ways = [sorted(rng.choice(12, 5, replace=False).tolist()) for _ in range(6)]
        tau = np.concatenate([rng.uniform(0.05, 15.0, 12), [0.06, 0.07, 12.0, 3.0]])
        cases.append((tau, ways, rng.uniform(20, 60, 6).tolist(), evaporation, deposit, 0.05, 15.0))
    return cases


UPDATES = drawn_updates()

UPDATE_MISTAKES: list[tuple[Callable[..., np.ndarray], str]] = [
    (lambda *case: updated(*case, kept=case[3]),
     "You keep the share ρ and let the rest evaporate. ρ is what goes."),
    (lambda *case: updated(*case, kept=1.0),
     "Nothing evaporates: then the first ants are never forgotten, and every scent ends at τ_max."),
    (lambda *case: updated(*case, only_walked=True),
     "You let only the nodes evaporate that were walked. The others must fade too, or nothing is ever forgotten."),
    (lambda *case: updated(*case, fades_after=True),
     "You let the fresh scent evaporate as well. In Eq. 4 it comes on top of what is left of the old."),
    (lambda *case: updated(*case, unit=lambda deposit, length: deposit),
     "Every ant lays Q, however long its way: nothing tells short ways from long ones."),
    (lambda *case: updated(*case, unit=lambda deposit, length: deposit * length),
     "Your long ways smell stronger than the short ones."),
    (lambda *case: updated(*case, each=False),
     "Where several ants walked, you count one of them. The sum in Eq. 4 goes over all ants that passed."),
    (lambda *case: updated(*case, limits="none"),
     "Evaporation and deposits are right. Where are the limits τ_min and τ_max?"),
    (lambda *case: updated(*case, limits="most"), "The upper limit is right. What about the lower one?"),
    (lambda *case: updated(*case, limits="least"),
     "The lower limit is right. Above τ_max there is scent left: is the upper limit kept, and after the deposits?"),
]  # fmt: skip


@asks_for(numbers(lambda tau, *_: tau.shape, "a probability for each neighbour"))
def exercise_3(odds: Odds) -> str:
    """10.3: probabilities of an ant's next step, also where floats end."""
    rng = np.random.default_rng(91)
    usual = [
        (rng.uniform(0.1, 15, n), 1 / rng.uniform(2, 30, n), rng.uniform(0.5, 4), rng.uniform(0.5, 4))
        for n in (2, 3, 5, 8, 17)
    ]
    answers = [odds(*case) for case in usual]
    if any(np.shape(answer) != case[0].shape for answer, case in zip(answers, usual, strict=True)):
        return f"For two neighbours the answer is two probabilities; yours has the shape {np.shape(answers[0])}."
    if not each_alike(answers, [right_odds(*case) for case in usual]):
        if hint := recognised(answers, ODDS_MISTAKES, usual, each_alike):
            return hint
        sums = [float(np.sum(answer)) for answer in answers]
        if not np.allclose(sums, 1.0):
            return f"The ant goes somewhere for certain: the probabilities should add up to 1, yours to {sums[0]:.4g}."
        return (
            "They add up to 1, but the shares are wrong. By hand: two neighbours, τ = (1, 4), η = (1, 1), α = 0.5, "
            "any β. How many times likelier is the second?"
        )
    return beyond_floats(odds)


def beyond_floats(odds: Odds) -> str:
    """A hint for where powers leave the range of floats, or a scent is gone."""
    far = 1 / np.array([30.0, 31.0, 29.0])
    for name, case in {
        "β = 80, 150 m from the goal, after 440 generations": (
            np.full(3, 15 * 0.2**440), np.array([1 / 150, 1 / 155, 1 / 145]), 0.5, 80.0
        ),
        "β = 500, 30 m from the goal": (np.full(3, 15.0), far, 0.5, 500.0),
        "η = 30 and β = 500": (np.full(3, 15.0), 1000 * far, 0.5, 500.0),
    }.items():  # fmt: skip
        with np.errstate(all="ignore"):
            answer = np.asarray(odds(*case), dtype=float)
        if not np.isfinite(answer).all():
            return f"Right for usual numbers. For {name} you get {answer}: which power left the range of floats?"
        if not np.allclose(answer, right_odds(*case), atol=1e-9):
            return (
                f"Right for usual numbers. For {name} you get {answer}, which should be {right_odds(*case).round(4)}. "
                "Before taking exp, subtract something that makes the largest exponent 0."
            )
    with np.errstate(all="ignore"):
        gone = np.asarray(odds(np.array([0.0, 3.0, 3.0]), np.ones(3), 1.0, 2.0), dtype=float)
    if not np.allclose(gone, [0.0, 0.5, 0.5], atol=1e-9):
        return f"Where the scent of one of three neighbours is 0, nobody goes there; you get {gone}."
    return ""


def right_odds(tau: np.ndarray, eta: np.ndarray, alpha: float, beta: float) -> np.ndarray:
    with np.errstate(divide="ignore"):
        logs = alpha * np.log(tau) + beta * np.log(eta)
    weight = np.exp(logs - logs.max())
    return weight / weight.sum()


def shares(weight: np.ndarray) -> np.ndarray:
    return weight / weight.sum()


ODDS_MISTAKES: list[tuple[Callable[..., np.ndarray], str]] = [
    (lambda t, e, a, b: t**a * e**b, "Those are weights. A probability is a share of their sum."),
    (lambda t, e, a, b: np.exp(a * np.log(t) + b * np.log(e) - (a * np.log(t) + b * np.log(e)).max()),
     "The largest of yours is always 1. What is left to do, so that they add up to 1?"),
    (lambda t, e, a, b: shares(t * e), "Your answer doesn't depend on α and β."),
    (lambda t, e, a, b: shares(t**b * e**a), "α belongs to the pheromone, β to the visibility: you have swapped them."),
    (lambda t, e, a, b: shares(e**b), "The pheromone is missing: your ants smell nothing."),
    (lambda t, e, a, b: shares(t**a), "The visibility is missing: your ants don't know where the goal is."),
    (lambda t, e, a, b: shares(a * t + b * e),
     "You add the two. A product says *and*: a neighbour without scent isn't chosen, however near it is."),
    (lambda t, e, a, b: shares(t**a + e**b), "You add the two powers. Eq. 1 multiplies them."),
    (lambda t, e, a, b: shares(a * np.log(t) + b * np.log(e)),
     "You share out the logarithms themselves. They only carry the weights; what takes a logarithm back?"),
    (lambda t, e, a, b: shares(t**a * e**-b),
     "Your ants run away from the goal. η is already one over the distance."),
]  # fmt: skip


@asks_for(whole_number("a number of generations, or None", none=True))
def exercise_4(until: Until) -> str:
    """10.4: the generation in which the scent of the busiest node reaches τ_max, or None."""
    first = REACHED[0]
    answers = [until(*case) for case in REACHED]
    if all(answer is None for answer in answers):
        return (
            f"You always return None. With ρ = {first[4]:g} and 10 ants on {first[3]:g} m each generation brings "
            f"{first[1] * first[2] / first[3]:.2f}: where does that come to rest?"
        )
    same = partial(each_alike, same=same_generation)
    if not same(answers, [capped(*case) for case in REACHED]):
        if hint := recognised(answers, CAP_MISTAKES, REACHED, same):
            return hint
        wrong = next(n for n, (a, c) in enumerate(zip(answers, REACHED, strict=True)) if a != capped(*c))
        start, ants, deposit, length, evaporation, most = REACHED[wrong]
        return (
            f"τ = {start:g} at first, {ants} ants on {length:g} m, Q = {deposit:g}, ρ = {evaporation:g}, τ_max = "
            f"{most:g}: you say {answers[wrong]}. Write down the scent after generations 1, 2 and 3."
        )
    for case in NEVER_REACHED:
        answer = until(*case)
        if answer is not None:
            rest = case[1] * case[2] / (case[4] * case[3])
            return (
                f"Right where τ_max is reached. But with ρ = {case[4]:g} the scent comes to rest at {rest:.2f} and "
                f"never reaches {case[5]:g}; you say {answer}."
            )
    if until(15.0, 10, 100.0, 150.0, 0.8, 15.0) != 0:
        return "Where the scent is at τ_max from the beginning, the answer is 0 generations."
    return ""


def same_generation(one: float | None, other: int | None) -> bool:
    return one is other if one is None or other is None else float(one) == other


def capped(
    first: float,
    ants: int,
    deposit: float,
    length: float,
    evaporation: float,
    most: float,
    *,
    gain: Callable[[int, float, float], float] = lambda ants, deposit, length: ants * deposit / length,
    kept: float | None = None,
    fades_after: bool = False,
    offset: int = 0,
) -> int | None:
    """How many generations until τ_max, by rules that may be wrong; None within 10 000."""
    kept = 1 - evaporation if kept is None else kept
    tau, more = first, gain(ants, deposit, length)
    for generation in range(10_000):
        if tau >= most:
            return generation + offset
        tau = kept * (tau + more) if fades_after else kept * tau + more
    return None


REACHED = [
    (1.0, 10, 100.0, 150.0, 0.1, 15.0),
    (0.5, 10, 100.0, 200.0, 0.2, 15.0),
    (0.05, 4, 100.0, 140.0, 0.05, 15.0),
    (2.0, 10, 60.0, 150.0, 0.15, 15.0),
    (0.05, 20, 100.0, 180.0, 0.4, 15.0),
    (6.0, 10, 80.0, 150.0, 0.3, 15.0),
    (0.05, 3, 400.0, 140.0, 0.1, 15.0),
]
NEVER_REACHED = [(9.0, 10, 100.0, 150.0, 0.8, 15.0), (5.0, 10, 100.0, 150.0, 0.5, 15.0)]
"""First τ, ants, Q, length [m], ρ and τ_max; the second list has the printed ρ first."""

CAP_MISTAKES: list[tuple[Callable[..., int | None], str]] = [
    (lambda *case: math.ceil((case[5] - case[0]) * case[3] / (case[1] * case[2])),
     "You let nothing evaporate meanwhile. The more there is, the more of it goes."),
    (lambda *case: capped(*case, gain=lambda ants, deposit, length: deposit / length),
     "You let one ant pass. All of them pass this node, and each lays Q/L."),
    (lambda *case: capped(*case, kept=case[4]), "You keep the share ρ and let the rest evaporate. ρ is what goes."),
    (lambda *case: capped(*case, fades_after=True),
     "You let the fresh scent evaporate as well. In Eq. 4 it comes on top of what is left of the old."),
    (lambda *case: capped(*case, offset=1), "One too many: the scent is already there before your last generation."),
    (lambda *case: capped(*case, offset=-1), "One too few: after so many generations it is still below τ_max."),
]  # fmt: skip


BETTER, DIFFER, CAMPUSES = 58, 84, 100
"""Campuses 200 to 299 on which the colony with the limit has the lower cost, and on which the costs differ."""
VERDICTS = ("helps", "hurts", "not shown")
COUNT_MISTAKES: list[tuple[tuple[int, int], str]] = [
    ((DIFFER - BETTER, DIFFER), "You count the campuses on which *any turn* has the lower cost."),
    ((BETTER, CAMPUSES), "A campus on which both costs are the same says nothing about which is better. Of how many "
     "campuses do the costs differ?"),
    ((BETTER + CAMPUSES - DIFFER, CAMPUSES), "You count ties as wins of the limit. On how many campuses do the costs "
     "differ at all?"),
    ((11, 16), "Those are the twenty campuses of the example. The question is about a hundred, from 200 to 299."),
    ((99, 100), "That is our colony. The question is about the paper's: `as_printed=True`."),
    ((59, 95), "Your two colonies run with different seeds. In a pair all is the same but for the limit."),
]  # fmt: skip


@asks_for_value(thing(tuple, "a tuple of three parts: (better, differing, verdict)"))
def exercise_5(found: tuple[Any, ...]) -> str:
    """10.5: on how many campuses the limit on turns is better, of how many that differ, and what that shows."""
    if len(found) != 3:
        return f"Your tuple has {len(found)} parts. There are three: (better, differing, verdict)."
    *counts, verdict = found
    if not all(is_number(count) for count in counts):
        return "The first two parts are numbers of campuses."
    if verdict not in VERDICTS:
        return f"The verdict is one of {', '.join(map(repr, VERDICTS))}; yours is {verdict!r}."
    better, differing = (float(count) for count in counts)
    if better > differing:
        return "You say that the limit is better on more campuses than differ. Which number comes first?"
    if 0 < differing < 1:
        return "These are shares. Hand over counts: an interval needs to know of how many."
    if max(abs(better - BETTER), abs(differing - DIFFER)) > 2:
        hints = (hint for (b, d), hint in COUNT_MISTAKES if max(abs(better - b), abs(differing - d)) <= 2)
        return next(hints, "") or (
            f"Campuses 200 to 299, seed 0 and 500 ants for both colonies: you say {better:g} of {differing:g}. Costs "
            "are the same when they agree to a millionth."
        )
    if verdict == "not shown":
        return "The counts are right. Does the interval that `share_interval` gives for them contain 50 %?"
    if verdict == "hurts":
        return "The counts are right. With the limit the cost is *lower* on most of these campuses: is that bad?"
    return ""


HABITS = ("alpha", "beta", "gamma", "evaporation", "deposit", "min_pheromone", "initial_pheromone", "max_pheromone")
HIDDEN = range(300, 330)
"""Seeds of the campuses on which a student's colony is tried."""


@asks_for_value(thing(dict, 'a dictionary of habits, such as {"beta": 10.0}'))
def exercise_6(habits: Mapping[str, Any]) -> str:
    """10.6: a colony that beats ours on campuses that it hasn't seen."""
    for name, value in habits.items():
        if name not in HABITS:
            return f"You hand over {name!r}, which isn't to be changed. The answer is about: {', '.join(HABITS)}."
        if not is_number(value):
            return f"{name} is one number; yours is {described(value)}."
    if habits.get("gamma", 2.0) == 0:
        return "With γ = 0 your ants don't see the risk. What did that do to our colony?"
    colonies: dict[str, Callable] = {"ours": ant_colony, "yours": partial(ant_colony, **habits)}
    try:
        runs = compare_planners(colonies, [*map(random_campus, HIDDEN)], seeds=(0, 1), budget=1000, progress=False)
    except ValueError as error:
        return f"The colony refuses your habits: {error}."
    (ours, yours), (share, low, high) = 100 * np.median(runs.gaps, axis=(1, 2)), runs.wins("yours", "ours")
    words = (
        f"On 30 campuses that you haven't seen, 60 runs of 1000 ants, your median gap is {yours:.1f} %, ours "
        f"{ours:.1f} %. Yours is better in {share:.0%} [{low:.0%}, {high:.0%}] of the pairs"
    )
    if low > 0.5:
        return ""
    if share == 0.5 and low < 0.5 < high and yours == ours:
        return "Your colony walks exactly as ours does. Change something that acts within 1000 ants."
    if high < 0.5:
        return f"{words}: it is worse. Change one habit at a time on campuses of your own, and see which way it goes."
    return f"{words}: not shown to be better. If it was on yours, you tuned it to them. Which two changes helped alone?"
