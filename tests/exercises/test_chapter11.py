"""Exercises of chapter 11: other ways to the answer pass; typical mistakes fail, each with a hint of its own."""

import numpy as np
import pytest

from uavlab.exercises import check


@pytest.mark.parametrize("number", ["11.1", "11.2", "11.3"])
def test_a_blank_answer_is_no_answer(number, blank):
    assert "still raises NotImplementedError" in check(number, blank).hint
    assert "return" in check(number, lambda *_: None).hint


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


def test_a_swarm_written_otherwise_is_right():
    assert check("11.1", fly)


@pytest.mark.parametrize(
    ("mistake", "hint"),
    [
        ("old", "the velocity they had"),
        ("no limit", "what is v_max for?"),
        ("above", "backwards it isn't"),
        ("length", "each of its parts"),
        ("late", "after the particles have moved"),
        ("open", "leave the box"),
        ("wild", "And: Some particles leave the box"),
        ("exchanged", "are exchanged"),
        ("away", "away from both bests"),
        ("one number", "Both pulls use r1"),
        ("no leader", "learn of the others"),
        ("no own", "own best is missing"),
    ],
)
def test_mistakes_with_the_swarm(mistake, hint):
    verdict = check("11.1", lambda *question: fly(*question, mistake=mistake))
    assert not verdict
    assert hint in verdict.hint


def in_place(x, v, *rest):
    places, speeds = fly(x, v, *rest)
    x[:], v[:] = places, speeds
    return x, v


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (in_place, "changes an array"),
        (lambda *question: fly(*question)[0], "two parts"),
        (lambda *question: [part[0] for part in fly(*question)], "each of the shape of x"),
        (lambda *question: (fly(*question)[0], 0 * question[0]), "The positions are right"),
        (lambda *question: (0 * question[0], fly(*question)[1]), "The velocities are right"),
        (lambda *question: (question[0], question[1]), "three terms of the velocity"),
    ],
)
def test_other_answers_for_the_swarm(answer, hint):
    assert not check("11.1", answer)
    assert hint in check("11.1", answer).hint


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


def test_a_beetle_written_otherwise_is_right():
    assert check("11.2", walk)


@pytest.mark.parametrize(
    ("mistake", "hint"),
    [
        ("uphill", "side where f is larger"),
        ("long", "length of b"),
        ("far", "as far as its antennae reach"),
        ("span", "from the body to one tip"),
        ("one tip", "two antennae"),
        ("by size", "Only the sign"),
        ("greedy", "the greedy one"),
        ("restless", "both sides smell the same"),
    ],
)
def test_mistakes_with_the_beetle(mistake, hint):
    verdict = check("11.2", lambda *question: walk(*question, mistake=mistake))
    assert not verdict
    assert hint in verdict.hint


def moved_in_place(f, x, b, reach, step):
    x += walk(f, x, b, reach, step) - x
    return x


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (moved_in_place, "changes an array"),
        (lambda f, x, b, reach, step: 1.0, "with as many coordinates as x"),
        (lambda f, x, b, reach, step: x + b, "How far should it go"),
    ],
)
def test_other_answers_for_the_beetle(answer, hint):
    assert not check("11.2", answer)
    assert hint in check("11.2", answer).hint


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


@pytest.mark.parametrize("count", [1000, 3000])
@pytest.mark.parametrize("seed", range(3))
def test_an_interval_by_other_draws_is_right(count, seed):
    other = np.random.default_rng(seed)
    assert check("11.3", lambda ours, theirs, rng: wins(ours, theirs, other, count=count))


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda ours, theirs, rng: wins(theirs, ours, rng), "the other one wins"),
        (lambda ours, theirs, rng: ((ours < theirs).mean(), 0, 1), "ties as lost"),
        (lambda ours, theirs, rng: ((ours <= theirs).mean(), 0, 1), "ties as won"),
        (lambda ours, theirs, rng: 100 * np.array(wins(ours, theirs, rng)), "in per cent"),
        (lambda *q: wins(*(np.median(gaps, axis=1, keepdims=True) for gaps in q[:2]), q[2]), "medians of each map"),
        (lambda *q: ((q[0] < q[1])[q[0] != q[1]].mean(), 0, 1), "leave the ties out"),
        (lambda *q: (0.5, 0.4, 0.6), "it should be"),
        (lambda *q: wins(*q, runs=True), "runs or maps"),
        (lambda *q: wins(*q, ends=(5, 95)), "5 % and 95 %"),
        (lambda *q: wins(*q, ends=(16, 84)), "16 % and 84 %"),
        (lambda *q: wins(*q, ends=(97.5, 2.5)), "above the upper one"),
        (lambda *q: wins(*q, replace=False), "Both ends are the same"),
        (lambda *q: wins(*q, maps=4), "how many maps are drawn"),
        (lambda *q: wins(*q, seeds=True), "do all their seeds come along"),
        (lambda *q: [end + 0.2 * (n > 0) for n, end in enumerate(wins(*q))], "lies elsewhere"),
        (lambda *q: wins(*q)[0], "three numbers"),
    ],
)
def test_mistakes_with_the_wins(answer, hint):
    verdict = check("11.3", answer)
    assert not verdict
    assert hint in verdict.hint


def test_runs_that_did_not_arrive_are_not_left_out():
    def only_arrived(ours, theirs, rng):
        both = np.isfinite(ours) & np.isfinite(theirs)
        share = np.where(ours == theirs, 0.5, ours < theirs)[both].mean()
        return share, 0.0, 1.0

    assert "has lost against one who does" in check("11.3", only_arrived).hint


def test_solutions_answer_examples(solutions):
    one = np.ones((1, 1))
    places, speeds = solutions["fly"](0 * one, one, 2 * one, np.array([4.0]), 0.9, one / 2, one / 2, 10.0, -5.0, 5.0)
    assert (places[0, 0], speeds[0, 0]) == (5.0, pytest.approx(0.9 + 1.5 + 4.0))
    stands = solutions["walk"](lambda point: point @ point, np.array([3.0, 0.0]), np.array([2.0, 0.0]), 0.5, 0.25)
    assert stands.tolist() == [2.75, 0.0]
    share, low, high = solutions["share_of_wins"](np.zeros((4, 2)), np.ones((4, 2)), np.random.default_rng(0))
    assert (share, low, high) == (1.0, 1.0, 1.0)
