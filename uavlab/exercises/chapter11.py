"""Exercises of chapter 11: what a mean says, a beetle, a swarm, shares of wins, a cost that is cheated, a search.

A hint says which mistake the answers look like and why it is one. Mistakes are recognised by what they answer, not
by how they are written.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from uavlab.exercises.asked import BUDGET, Asked, holes, valley
from uavlab.exercises.hints import alike, recognised, recognised_value
from uavlab.exercises.kinds import Quiz, asks_for, asks_for_value, number, numbers
from uavlab.optimizers import pso

Step = tuple[np.ndarray, np.ndarray]
Search = Callable[..., np.ndarray]

same = partial(alike, relative=1e-9)

exercise_1 = Quiz(
    right="b",
    because="Far to the left and far to the right have a mean of 0 as well. So we need the mean of x².",
    wrong={
        "a": "Particles at one point have a mean of 0. Is every swarm with that mean at one point? Take two.",
        "c": "Put ω = 0.9 and c₁ + c₂ = 3.5 into Eq. 4: both conditions are fulfilled. So the mean does die out.",
        "d": "Eq. 2 moves each coordinate by itself, with random numbers of its own. How many coordinates there are "
        "doesn't matter for one of them.",
    },
)


@asks_for(numbers(lambda f, x, *_: x.shape, "a point, with as many coordinates as x"), unchanged=True)
def exercise_2(walk: Callable[..., Any]) -> str:
    """11.2: where a beetle stands after one step."""
    rng = np.random.default_rng(1020)
    questions = [
        (f, rng.uniform(-2, 2, 3), rng.normal(size=3) * rng.uniform(0.2, 5), rng.uniform(0.5, 3), rng.uniform(0.1, 0.4))
        for f in (bowl, slope, waves) * 20
    ]
    given = [np.asarray(walk(*question), dtype=float) for question in questions]
    if same(given, [walked(*question) for question in questions]):
        stay = walk(lambda point: 1.0, np.zeros(3), np.ones(3), 1.0, 1.0)
        if np.allclose(stay, 0.0):
            return ""
        return "Where both sides smell the same your beetle walks. Which side is better there?"
    if hint := recognised(given, WALK_MISTAKES, questions, same):
        return hint
    _, x, b, reach, step = questions[0]
    gone, along = given[0] - x, b / np.linalg.norm(b)
    return (
        f"With f = |x|², x = {np.round(x, 2)}, b = {np.round(b, 2)}, reach = {reach:.2f} and step = {step:.2f} your "
        f"beetle goes {np.linalg.norm(gone):.3f} far, {gone @ along:+.3f} of it along b. How far should it go, along "
        "what, and to which side?"
    )


def bowl(point: np.ndarray) -> float:
    return float(np.sum(np.square(point)))


def slope(point: np.ndarray) -> float:
    return float(np.dot(point, (1.0, -2.0, 0.5)))


def waves(point: np.ndarray) -> float:
    return float(np.sum(np.sin(3 * np.asarray(point)) + 0.1 * np.square(point)))


def walked(
    *question: Any,
    uphill: bool = False,
    unit: bool = True,
    half: float = 1.0,
    far: bool = False,
    one_side: bool = False,
    by_size: bool = False,
    greedy: bool = False,
) -> np.ndarray:
    """A step by rules that may be wrong."""
    f, x, b, reach, step = question
    along = b / np.linalg.norm(b) if unit else b
    left = f(x + half * reach * along)
    right = f(x) if one_side else f(x - half * reach * along)
    side = (left - right) if by_size else np.sign(left - right)
    moved = x - (-1 if uphill else 1) * (reach if far else step) * along * side
    return x if greedy and f(moved) >= f(x) else moved


def wrongly_walked(**how: Any) -> Callable[..., np.ndarray]:
    return lambda *question: walked(*question, **how)


WALK_MISTAKES: list[tuple[Callable[..., np.ndarray], str]] = [
    (wrongly_walked(uphill=True),
     "Your beetle walks to the side where f is larger. If f is larger on the left, which sign has the difference, "
     "and which way is it then to the right?"),
    (wrongly_walked(unit=False),
     "How far your beetle looks and walks depends on the length of b. Only its direction counts: what is left of a "
     "vector when its length is taken out?"),
    (wrongly_walked(far=True),
     "Your beetle walks as far as its antennae reach. It looks with one length and walks with the other."),
    (wrongly_walked(half=0.5),
     "Your tips are half of `reach` away from the body. It is the distance from the body to one tip (Eq. 7), not "
     "from tip to tip."),
    (wrongly_walked(one_side=True),
     "You compare one tip with the place where the beetle stands. It has two antennae."),
    (wrongly_walked(by_size=True),
     "The larger the difference, the further your beetle walks. Only the sign of it counts."),
    (wrongly_walked(greedy=True),
     "Your beetle stays where walking would make it worse. That is the greedy one; this one walks all the same."),
]  # fmt: skip


@asks_for(
    numbers(lambda x, *_: (2, *x.shape), "two parts, positions and velocities, each of the shape of x"), unchanged=True
)
def exercise_3(fly: Callable[..., Any]) -> str:
    """11.3: positions and velocities of a swarm after one step, the velocity limited, the box closed."""
    questions = [swarm_question(seed) for seed in range(6)]
    given = [tuple(np.asarray(part, dtype=float) for part in fly(*question)) for question in questions]
    right = [flown(*question) for question in questions]
    if same(given, right):
        return ""
    if hint := recognised(given, FLIGHT_MISTAKES, questions, same):
        return hint
    if same([x for x, _ in given], [x for x, _ in right]):
        return "The positions are right. The velocities should be those with which the particles flew there."
    if same([v for _, v in given], [v for _, v in right]):
        return (
            "The velocities are right. Where does a particle come with its new velocity, and what if that is outside?"
        )
    x, v = (float(part[0, 0]) for part in (given[0][0], given[0][1]))
    right_x, right_v = (float(part[0, 0]) for part in right[0])
    return (
        f"A coordinate at {questions[0][0][0, 0]:.3f} with velocity {questions[0][1][0, 0]:.3f} comes to {x:.3f} with "
        f"{v:.3f}, and should to {right_x:.3f} with {right_v:.3f}. Write the three terms of the velocity "
        "one below the other: how large is each?"
    )


def swarm_question(seed: int) -> tuple[Any, ...]:
    """Seven particles in three dimensions, some near the border, some that would be too fast."""
    rng = np.random.default_rng(1010 + seed)
    x, best = rng.uniform(-4, 4, (2, 7, 3))
    v = rng.normal(0, 1.5, (7, 3))
    r1, r2 = rng.random((2, 7, 3))
    return x, v, best, rng.uniform(-4, 4, 3), float(rng.uniform(0.4, 1.0)), r1, r2, 1.8, -4.0, 4.0


def flown(
    *question: Any,
    c1: float = 1.5,
    c2: float = 2.0,
    sign: float = 1.0,
    limit: str = "both",
    closed: bool = True,
    with_old: bool = False,
) -> Step:
    """One step by rules that may be wrong."""
    x, v, best, leader, inertia, r1, r2, v_max, low, high = question
    new = inertia * v + sign * (c1 * r1 * (best - x) + c2 * r2 * (leader - x))
    limited = {
        "both": np.clip(new, -v_max, v_max),
        "above": np.minimum(new, v_max),
        "none": new,
        "length": new * np.minimum(1, v_max / np.maximum(np.linalg.norm(new, axis=1, keepdims=True), 1e-12)),
    }[limit]
    moved = x + (v if with_old else limited)
    return (np.clip(moved, low, high) if closed else moved), limited


def wrongly_flown(**how: Any) -> Callable[..., Step]:
    return lambda *question: flown(*question, **how)


def limited_late(*question: Any) -> Step:
    """The velocity limited only after the particle has moved."""
    moved, _ = flown(*question, limit="none")
    return moved, flown(*question)[1]


def one_number(*question: Any) -> Step:
    """The same random number for both pulls."""
    same = (*question[:6], question[5], *question[7:])
    return flown(*same)


OPEN = "Some particles leave the box. Where do they stop?"
FLIGHT_MISTAKES: list[tuple[Callable[..., Step], str]] = [
    (wrongly_flown(with_old=True),
     "Your particles move with the velocity they had. In Eq. 2 the velocity is new before the place is."),
    (wrongly_flown(limit="none"), "The velocities have no limit: what is v_max for?"),
    (wrongly_flown(limit="above"),
     "Forwards the velocity is limited, backwards it isn't. Which is the smallest that is allowed?"),
    (wrongly_flown(limit="length"),
     "You limit the length of the velocity. The exercise limits each of its parts."),
    (limited_late, "You limit the velocity after the particles have moved with it."),
    (wrongly_flown(closed=False), OPEN),
    (wrongly_flown(closed=False, limit="none"),
     "Neither velocities nor places have a limit: what are v_max, low and high for?"),
    (wrongly_flown(c1=2.0, c2=1.5),
     "c1 and c2 are exchanged: which of them pulls to the particle's own best?"),
    (wrongly_flown(sign=-1.0),
     "Your particles fly away from both bests. From where to where does best − x point?"),
    (one_number, "Both pulls use r1. They are drawn independently of each other."),
    (wrongly_flown(c2=0.0), "The pull to the leader is missing: what does one particle learn of the others?"),
    (wrongly_flown(c1=0.0), "The pull to the particle's own best is missing."),
]  # fmt: skip


@asks_for(numbers((3,), "three numbers: the share, and both ends of its interval"))
def exercise_4(share_of_wins: Callable[..., Any]) -> str:
    """11.4: the share of runs that are won, and its interval by resampling maps."""
    questions = [gaps_of(seed) for seed in range(10)]
    answers = []
    for seed, (ours, theirs) in enumerate(questions):
        answer = share_of_wins(ours, theirs, np.random.default_rng(seed))
        answers.append(np.asarray(answer, dtype=float))
    given = np.array(answers)
    same_shares = partial(alike, relative=1e-5, absolute=1e-9)
    right = [won(*question).mean() for question in questions]
    if not same_shares(given[:, 0], right):
        return recognised(given[:, 0], SHARE_MISTAKES, questions, same_shares) or (
            f"For the first of our questions your share is {given[0, 0]:.4f}; it should be {right[0]:.4f}."
        )
    return interval_hint(given, [won(*question) for question in questions])


def interval_hint(given: np.ndarray, wins: list[np.ndarray]) -> str:
    """What is wrong with the interval where the share is right."""
    if (given[:, 1] > given[:, 2]).any():
        return "The lower end of your interval is above the upper one."
    right = np.array([interval(runs, maps=True) for runs in wins])
    ratio = np.mean((given[:, 2] - given[:, 1]) / (right[:, 1] - right[:, 0]))
    if 0.94 < ratio < 1.06:
        if np.allclose(given[:, 1:], right, atol=0.06):
            return ""
        return "Your interval is as wide as it should be, but lies elsewhere. Which quantiles are its two ends?"
    of_runs = np.array([interval(runs, maps=False) for runs in wins])
    narrow = np.mean((of_runs[:, 1] - of_runs[:, 0]) / (right[:, 1] - right[:, 0]))
    if abs(ratio - narrow) < 0.04:
        return (
            "The share is right, the interval much too narrow: so it would be if all runs were independent. Many seeds "
            "on one map tell about one map. What has to be drawn, runs or maps?"
        )
    for level, ends in ((0.9, "5 % and 95 %"), (0.6827, "about 16 % and 84 %")):
        other = np.array([interval(runs, maps=True, level=level) for runs in wins])
        if abs(ratio - np.mean((other[:, 1] - other[:, 0]) / (right[:, 1] - right[:, 0]))) < 0.04:
            return f"Your ends are the quantiles of {ends}. How much may lie below and above an interval of 95 %?"
    if (given[:, 1] == given[:, 2]).all():
        return "Both ends are the same. Is something drawn anew each time?"
    return (
        f"The share is right. The interval is {ratio:.2f} times as wide as it should be: how many maps are drawn each "
        "time, with replacement or without, and do all their seeds come along?"
    )


def gaps_of(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Gaps of two planners (12 maps, 8 seeds): maps matter more than seeds; some ties, some that didn't arrive."""
    rng = np.random.default_rng(1030 + seed)
    theirs = rng.exponential(8.0, (12, 8)).round(2)
    ours = (theirs - rng.normal(0.5, 5.0, (12, 1)) - rng.normal(0, 0.8, (12, 8))).round(2)
    tie = rng.random((12, 8)) < 0.15
    ours[tie] = theirs[tie]
    ours[rng.random((12, 8)) < 0.05] = np.inf
    theirs[rng.random((12, 8)) < 0.03] = np.inf
    ours[0, 0] = theirs[0, 0] = np.inf
    return ours, theirs


def won(ours: np.ndarray, theirs: np.ndarray) -> np.ndarray:
    return np.where(ours == theirs, 0.5, ours < theirs)


SHARE_MISTAKES: list[tuple[Callable[[np.ndarray, np.ndarray], Any], str]] = [
    (lambda ours, theirs: (1 - won(ours, theirs)).mean(),
     "That is how often the other one wins: the smaller gap is better."),
    (lambda ours, theirs: (ours < theirs).mean(), "You count ties as lost. What counts a tie?"),
    (lambda ours, theirs: (ours <= theirs).mean(), "You count ties as won. What counts a tie?"),
    (lambda ours, theirs: (100 * won(ours, theirs)).mean(), "That is in per cent. A share lies between 0 and 1."),
    (lambda ours, theirs: won(np.median(ours, axis=1), np.median(theirs, axis=1)).mean(),
     "You compare the medians of each map. The question is about runs: each seed against the same seed."),
    (lambda ours, theirs: (ours < theirs)[ours != theirs].mean(),
     "You leave the ties out. Each run counts, a tie half."),
    (lambda ours, theirs: won(ours, theirs)[np.isfinite(ours) & np.isfinite(theirs)].mean(),
     "You leave out runs that didn't arrive. A run that doesn't arrive has lost against one that does."),
]  # fmt: skip


def interval(values: np.ndarray, *, maps: bool, level: float = 0.95) -> tuple[float, float]:
    """Ends of a bootstrap interval of the mean of values (M, S), by drawing maps or runs."""
    rng = np.random.default_rng(0)
    rows = values if maps else values.reshape(-1, 1)
    shares = rows[rng.integers(len(rows), size=(4000, len(rows)))].mean(axis=(1, 2))
    low, high = np.quantile(shares, [(1 - level) / 2, (1 + level) / 2])
    return float(low), float(high)


CHEATED, NEAR = -0.329, 0.05
"""Claimed over true cost, less 1, of curves that were optimised with legs of about a voxel; median of five seeds."""


@asks_for_value(number("claimed cost over true cost, less 1; the median of the five seeds"))
def exercise_5(claim: float) -> str:
    """11.5: by how much an optimiser makes a sampled cost too low."""
    value = float(claim)
    if abs(value - CHEATED) <= NEAR:
        return ""
    if hint := recognised_value(value, CLAIM_MISTAKES):
        return hint
    if value > 0:
        return f"You say that the claim is {value:.2g} above the truth. Which cost did the optimiser make small?"
    return f"We find another value than {value:.3g}. Seeds 0 to 4, 3000 evaluations and legs=4 each: one ratio a seed."


CLAIM_MISTAKES: list[tuple[float, float, str]] = [
    (-CHEATED, NEAR, "The size is right. Is the claim above the true cost, or below it?"),
    (1 + CHEATED, NEAR, "That is the ratio of the two costs. How much is it above or below 1?"),
    (1 / (1 + CHEATED) - 1, 0.07, "That compares the truth with the claim. Divide by the true cost."),
    (100 * CHEATED, 100 * NEAR, "That is in per cent. Give a share, so that a tenth too much is 0.1."),
    (-0.053, 0.02, "That is what legs of a quarter of a voxel claim, legs=14. Here it is legs=4."),
    (-0.618, 0.04, "That is what legs of two voxels claim, legs=2. Here it is legs=4."),
    (0.067, 0.05, "For curves that nobody optimised the samples are about right. Take those that `pso_bas` returns."),
    (CHEATED - 0.14, 0.02, "That is the worst of the five seeds. Take their median."),
]  # fmt: skip

LESS_IN_VALLEY, MORE_IN_HOLES = 0.7, 2.0


@asks_for(numbers((6,), "the best point, with six coordinates"))
def exercise_6(search: Search) -> str:
    """11.6: an optimiser that is better than `pso` in a valley and hardly worse among holes."""
    medians = []
    for f, half, shift in ((valley, 2.0, 0.5), (holes, 5.0, 2.0)):
        found, swarm = [], []
        for seed in range(9):
            asked = Asked(f, half, np.random.default_rng(100 + seed).uniform(-shift, shift, 6))
            point = search(asked, asked.box.copy(), BUDGET, np.random.default_rng(seed))
            if hint := asked.complaint():
                return hint
            found.append(asked.value(np.asarray(point, dtype=float)[None])[0])
            if found[-1] > asked.least * (1 + 1e-9) + 1e-12:
                return (
                    f"Your optimiser has seen a point with the value {asked.least:.3g}, and returns one with "
                    f"{found[-1]:.3g}. Keep the best of all that you evaluate."
                )
            swarm.append(pso(asked.value, asked.box, BUDGET, seed).value)
        medians.append((float(np.median(found)), float(np.median(swarm))))
    return judged(*medians)


def judged(in_valley: tuple[float, float], in_holes: tuple[float, float]) -> str:
    """What is missing, from medians of (found, what `pso` finds)."""
    better, good = in_valley[0] <= LESS_IN_VALLEY * in_valley[1], in_holes[0] <= MORE_IN_HOLES * in_holes[1]
    numbers_of = "Medians, yours / pso: valley {:.2f} / {:.2f}, holes {:.2f} / {:.2f}. ".format(*in_valley, *in_holes)
    if better and good:
        return ""
    if better:
        return (
            numbers_of + "You are good in the valley, and get caught among the holes. What finds the right hole first?"
        )
    if good:
        return (
            numbers_of + "Among the holes it is good enough. In the valley, which local search did better than a swarm?"
        )
    return numbers_of + "Both are too large. Begin with `pso`, and ask what the rest of the budget is best used for."
