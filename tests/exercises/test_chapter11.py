"""Exercises of chapter 11: other ways to the answer pass; typical mistakes fail, each with a hint of its own."""

from functools import partial

import numpy as np
import pytest

from uavlab.exercises import chapter11, check
from uavlab.optimizers import bas, pso, pso_bas


def fly(x, v, best, leader, inertia, r1, r2, v_max, low, high, *, mistake=""):
    """A step of a swarm, particle by particle, which can be broken in several ways."""
    places, speeds = np.empty_like(x), np.empty_like(v)
    for n in range(len(x)):
        own, swarm = (1.5, 2.0) if mistake != "exchanged" else (2.0, 1.5)
        second = r1 if mistake == "one number" else r2
        pull = own * r1[n] * (best[n] - x[n]) + swarm * second[n] * (leader - x[n])
        if mistake == "no leader":
            pull = own * r1[n] * (best[n] - x[n])
        if mistake == "no own":
            pull = swarm * r2[n] * (leader - x[n])
        fast = inertia * v[n] + (-pull if mistake == "away" else pull)
        slow = np.maximum(np.minimum(fast, v_max), -v_max)
        if mistake == "above":
            slow = np.minimum(fast, v_max)
        if mistake in ("no limit", "wild"):
            slow = fast
        if mistake == "length":
            slow = fast * min(1.0, v_max / np.linalg.norm(fast))
        there = x[n] + {"old": v[n], "late": fast}.get(mistake, slow)
        places[n] = there if mistake in ("open", "wild") else np.clip(there, low, high)
        speeds[n] = slow
    return places, speeds


def walk(f, x, b, reach, step, *, mistake=""):
    """A step of a beetle, which can be broken in several ways."""
    along = b if mistake == "long" else b / np.sqrt((b**2).sum())
    tip = (reach / 2 if mistake == "span" else reach) * along
    ahead, behind = f(x + tip), f(x if mistake == "one tip" else x - tip)
    if ahead == behind and mistake != "restless":
        return x.copy()
    forth = ahead < behind if mistake != "uphill" else ahead > behind
    length = {"far": reach, "by size": step * abs(ahead - behind)}.get(mistake, step)
    there = x + length * along if forth else x - length * along
    return x.copy() if mistake == "greedy" and f(there) >= f(x) else there


def moved_in_place(f, x, b, reach, step):
    x += walk(f, x, b, reach, step) - x
    return x


def in_place(x, v, *rest):
    places, speeds = fly(x, v, *rest)
    x[:], v[:] = places, speeds
    return x, v


def wins(ours, theirs, rng, *, count=1000, runs=False, ends=(2.5, 97.5), replace=True, maps=None, seeds=False):
    """Share and interval, which can be broken in several ways."""
    won = 0.5 * (ours < theirs) + 0.5 * (ours <= theirs)
    rows = won.reshape(-1, 1) if runs else won
    size = len(rows) if maps is None else maps
    drawn = [rows[rng.choice(len(rows), size, replace=replace)] for _ in range(count)]
    if seeds:
        drawn = [row[:, rng.integers(row.shape[1], size=1)] for row in drawn]
    low, high = np.percentile([rows.mean() for rows in drawn], ends)
    return won.mean(), low, high


def only_arrived(ours, theirs, rng):
    both = np.isfinite(ours) & np.isfinite(theirs)
    return np.where(ours == theirs, 0.5, ours < theirs)[both].mean(), 0.0, 1.0


def swarm_then_beetle(f, box, budget, rng, share=0.7, spent=1.0):
    rough = pso(f, box, int(share * budget), rng)
    rest = int(spent * budget) - len(rough.history)
    return bas(f, box, rest, rng, start=rough.best, greedy=True, decay=None, antenna=0.03).best


def last_point(f, box, budget, rng):
    return pso(f, box, budget, rng).swarm[-1]


def outside(f, box, budget, rng):
    return pso(f, 3 * box, budget, rng).best


def at_random(f, box, budget, rng):
    x = rng.uniform(*box.T, (budget, len(box)))
    return x[f(x).argmin()]


def flown(mistake):
    return lambda *question: fly(*question, mistake=mistake)


def walked(mistake):
    return lambda *question: walk(*question, mistake=mistake)


MISTAKES = {
    "11.2": {
        "side where f is larger": walked("uphill"),
        "length of b": walked("long"),
        "as far as its antennae reach": walked("far"),
        "from the body to one tip": walked("span"),
        "two antennae": walked("one tip"),
        "Only the sign": walked("by size"),
        "the greedy one": walked("greedy"),
        "both sides smell the same": walked("restless"),
        "changes an array": moved_in_place,
        "with as many coordinates as x": lambda f, x, b, reach, step: 1.0,
        "How far should it go": lambda f, x, b, reach, step: x + b,
    },
    "11.3": {
        "the velocity they had": flown("old"),
        "what is v_max for?": flown("no limit"),
        "backwards it isn't": flown("above"),
        "each of its parts": flown("length"),
        "after the particles have moved": flown("late"),
        "leave the box": flown("open"),
        "what are v_max, low and high for": flown("wild"),
        "are exchanged": flown("exchanged"),
        "away from both bests": flown("away"),
        "Both pulls use r1": flown("one number"),
        "learn of the others": flown("no leader"),
        "own best is missing": flown("no own"),
        "changes an array": in_place,
        "The positions are right": lambda *q: (fly(*q)[0], 0 * q[1]),
        "The velocities are right": lambda *q: (0 * q[0], fly(*q)[1]),
        "three terms": lambda x, v, *rest: (x, v),
        "two parts, positions and velocities": lambda x, v, *rest: x + v,
    },
    "11.4": {
        "the other one wins": lambda ours, theirs, rng: wins(theirs, ours, rng),
        "ties as lost": lambda ours, theirs, rng: ((ours < theirs).mean(), 0, 1),
        "ties as won": lambda ours, theirs, rng: ((ours <= theirs).mean(), 0, 1),
        "in per cent": lambda ours, theirs, rng: 100 * np.array(wins(ours, theirs, rng)),
        "medians of each map": lambda *q: wins(*(np.median(gaps, axis=1, keepdims=True) for gaps in q[:2]), q[2]),
        "leave the ties out": lambda *q: ((q[0] < q[1])[q[0] != q[1]].mean(), 0, 1),
        "your share is": lambda *q: (0.5, 0.4, 0.6),
        "runs or maps": lambda *q: wins(*q, runs=True),
        "5 % and 95 %": lambda *q: wins(*q, ends=(5, 95)),
        "16 % and 84 %": lambda *q: wins(*q, ends=(16, 84)),
        "above the upper one": lambda *q: wins(*q, ends=(97.5, 2.5)),
        "Both ends are the same": lambda *q: wins(*q, replace=False),
        "how many maps are drawn": lambda *q: wins(*q, maps=4),
        "lies elsewhere": lambda *q: [end + 0.2 * (n > 0) for n, end in enumerate(wins(*q))],
        "three numbers": lambda *q: wins(*q)[0],
        "has lost against one that does": only_arrived,
    },
    "11.5": {
        "above the true cost, or below": 0.33,
        "How much is it above or below 1": 0.67,
        "Divide by the true cost": 0.49,
        "in per cent": -33.0,
        "legs of a quarter of a voxel": -0.053,
        "legs of two voxels": -0.62,
        "nobody optimised": 0.07,
        "the worst of the five": -0.469,
        "make small": 2.0,
        "another value": -0.2,
    },
    "11.6": {
        "caught among the holes": lambda f, box, n, rng: bas(f, box, n, rng, greedy=True, decay=None).best,
        "which local search": lambda f, box, n, rng: pso(f, box, n, rng).best,
        "Both are too large": at_random,
        "and the budget is 4000": partial(swarm_then_beetle, spent=1.2),
        "Keep the best": last_point,
        "outside of the box": outside,
        "never asks f": lambda f, box, n, rng: np.zeros(6),
        "with six coordinates": lambda f, box, n, rng: pso(f, box, n, rng).value,
    },
}


def test_steps_written_otherwise_are_right():
    assert check("11.2", walk)
    assert check("11.3", fly)


def test_an_interval_with_some_of_the_seeds_is_too_wide():
    assert "do all their seeds come along" in check("11.4", lambda *q: wins(*q, seeds=True)).hint


@pytest.mark.parametrize("count", [1000, 3000])
@pytest.mark.parametrize("seed", range(3))
def test_an_interval_by_other_draws_is_right(count, seed):
    other = np.random.default_rng(seed)
    assert check("11.4", lambda ours, theirs, rng: wins(ours, theirs, other, count=count))


@pytest.mark.parametrize("answer", [-0.329, -0.31, np.float64(-0.36), np.array(-0.33)])
def test_claims_near_the_median_are_right(answer):
    assert check("11.5", answer)


def test_the_claim_is_that_of_the_exercise(solutions):
    assert solutions["claim"] == pytest.approx(chapter11.CHEATED, abs=0.01)
    finer = solutions["optimised"](0, legs=14)
    assert -0.1 < finer.value / solutions["exact"](finer.best, 14) - 1 < -0.02


@pytest.mark.parametrize("share", [0.6, 0.75])
def test_other_searches_are_right(share):
    assert check("11.6", partial(swarm_then_beetle, share=share))


def test_a_swarm_with_antennae_is_not_enough_in_the_valley():
    hint = check("11.6", lambda f, box, n, rng: pso_bas(f, box, n, rng).best).hint
    assert "which local search" in hint


def test_solutions_answer_examples(solutions):
    one = np.ones((1, 1))
    places, speeds = solutions["fly"](0 * one, one, 2 * one, np.array([4.0]), 0.9, one / 2, one / 2, 10.0, -5.0, 5.0)
    assert (places[0, 0], speeds[0, 0]) == (5.0, pytest.approx(0.9 + 1.5 + 4.0))
    stands = solutions["walk"](lambda point: point @ point, np.array([3.0, 0.0]), np.array([2.0, 0.0]), 0.5, 0.25)
    assert stands.tolist() == [2.75, 0.0]
    share, low, high = solutions["share_of_wins"](np.zeros((4, 2)), np.ones((4, 2)), np.random.default_rng(0))
    assert (share, low, high) == (1.0, 1.0, 1.0)
