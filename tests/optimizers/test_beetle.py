"""Beetle antennae: each step against what the beetle smelled, how far it can come, and which directions it prefers."""

import re

import numpy as np
import pytest
from scipy import stats

from uavlab.optimizers import bas, pso_bas
from uavlab.optimizers.beetle import ANTENNA, DECAY, LONGER, SHORTER, SHORTEST

BOUNDS = np.tile([-5.0, 5.0], (6, 1))
RANGE = 10.0
SEEDS = range(6)
COUNT = 6000  # directions drawn


def sphere(x):
    return (x**2).sum(axis=1)


def rastrigin(x):
    return (10 + x**2 - 10 * np.cos(2 * np.pi * x)).sum(axis=1)


def life(f, budget, rng, bounds=BOUNDS, **options):
    """Where a beetle stood (S + 1, D), the tips (S, 2, D) it smelled there, and what was found."""
    asked = []

    def spy(x):
        asked.append(x.copy())
        return f(x)

    found = bas(spy, bounds, budget, rng, **options)
    bodies = np.concatenate([points for points in asked if len(points) == 1])
    return bodies, np.array([points for points in asked if len(points) == 2]), found


def directions(dimensions, count, **options):
    """Unit vectors along the antennae of a beetle that stays in the middle."""
    box = np.tile([-1.0, 1.0], (dimensions, 1))
    _, tips, _ = life(
        lambda x: np.ones(len(x)), 2 * count + 1, 0, box, start=np.zeros(dimensions), greedy=True, decay=1.0, **options
    )
    return tips[:, 0] / np.linalg.norm(tips[:, 0], axis=1, keepdims=True)


@pytest.mark.parametrize("as_printed", [False, True])
def test_a_beetle_walks_to_the_side_that_smells_better_even_if_it_is_worse_there(as_printed):
    for seed in SEEDS:
        bodies, tips, _ = life(sphere, 400, seed, as_printed=as_printed)
        better = np.array([sphere(pair).argmin() for pair in tips])
        assert np.array_equal(bodies[1:], tips[np.arange(len(tips)), better])
        assert 0.2 < (np.diff(sphere(bodies)) > 0).mean() < 0.6  # measured 0.38 to 0.43


def test_a_beetle_stands_in_the_middle_of_its_antennae_which_shrink_with_each_step():
    bodies, tips, _ = life(sphere, 301, 2, decay=0.9, antenna=0.02)
    assert np.abs(tips).max() < 5  # no wall cuts them
    assert tips.mean(axis=1) == pytest.approx(bodies[:-1], abs=1e-12)
    half = np.linalg.norm(tips[:, 0] - tips[:, 1], axis=1) / 2
    assert half == pytest.approx(RANGE * 0.02 * 0.9 ** np.arange(len(tips)), rel=1e-6, abs=1e-14)


@pytest.mark.parametrize(("antenna", "decay"), [(0.01, 0.95), (0.02, 0.9), (0.1, 0.5)])
def test_a_beetle_comes_as_far_as_its_first_step_over_one_minus_the_decay_whatever_the_function(antenna, decay):
    wide = 100 * BOUNDS
    for seed in SEEDS:
        bodies, _, _ = life(lambda x: x.sum(axis=1), 3001, seed, wide, start=np.zeros(6), antenna=antenna, decay=decay)
        way = np.linalg.norm(np.diff(bodies, axis=0), axis=1).sum()
        assert way == pytest.approx(antenna * 1000 / (1 - decay), rel=1e-9)
        assert np.linalg.norm(bodies[-1]) < way


def test_default_antennae_cross_a_range_six_times():
    assert pytest.approx(6) == ANTENNA / (1 - DECAY)


def test_a_beetle_that_smells_the_same_on_both_sides_stays():
    bodies, tips, _ = life(lambda x: np.ones(len(x)), 61, 0)
    assert (bodies == bodies[0]).all()
    assert len(np.unique(tips.reshape(-1, 6), axis=0)) == 40


def test_a_walking_beetle_remembers_the_best_it_met_and_ends_elsewhere():
    bodies, tips, found = life(sphere, 400, 0)
    assert found.value == min(sphere(bodies).min(), sphere(tips.reshape(-1, 6)).min())
    assert np.array_equal(found.swarm, bodies[-1:])
    assert sphere(found.swarm)[0] > found.value


@pytest.mark.parametrize("decay", [0.95, None])
@pytest.mark.parametrize("block", [None, 1, 2])
def test_a_greedy_beetle_never_gets_worse(decay, block):
    for seed in SEEDS:
        bodies, tips, found = life(rastrigin, 401, seed, greedy=True, decay=decay, block=block)
        body = bodies[0]
        assert len(bodies) == 1
        for pair in tips:
            best = pair[rastrigin(pair).argmin()]
            body = best if rastrigin(best[None]) < rastrigin(body[None]) else body
        assert np.array_equal(found.swarm[0], body)
        assert np.array_equal(found.best, body)
        assert found.value < rastrigin(bodies)[0]


def test_steps_and_their_evaluations():
    assert bas(sphere, BOUNDS, 12, 0).iterations.tolist() == [1, 4, 7, 10, 12]
    assert bas(sphere, BOUNDS, 8, 0, greedy=True).iterations.tolist() == [1, 3, 5, 7, 8]


@pytest.mark.parametrize("block", [1, 2, 3, 6])
def test_antennae_that_follow_success_grow_after_a_gain_and_shrink_after_none_along_each_block(block):
    start = np.linspace(-0.4, 0.5, 6)
    bodies, tips, _ = life(sphere, 241, 1, start=start, greedy=True, decay=None, block=block, antenna=0.05)
    body, length, gains = bodies[0], np.full(6 // block, 0.05), 0
    for pair in tips:
        step = (pair[0] - pair[1]) / 2
        number = int(np.flatnonzero(step)[0]) // block
        assert pair.mean(axis=0) == pytest.approx(body, abs=1e-12)
        assert np.linalg.norm(step) == pytest.approx(RANGE * length[number], rel=1e-6)
        gained = sphere(pair).min() < sphere(body[None])[0]
        body = pair[sphere(pair).argmin()] if gained else body
        length[number] = min(length[number] * (LONGER if gained else SHORTER), 0.05)
        gains += gained
    assert 10 < gains < 80


def test_antennae_that_follow_success_keep_a_least_length():
    _, tips, _ = life(lambda x: np.ones(len(x)), 601, 0, start=np.zeros(6), greedy=True, decay=None)
    half = np.linalg.norm(tips[:, 0] - tips[:, 1], axis=1) / 2
    assert half == pytest.approx(RANGE * np.maximum(ANTENNA * SHORTER ** np.arange(300), SHORTEST), rel=1e-9)
    assert half[-1] == pytest.approx(RANGE * SHORTEST, rel=1e-9)


def test_antennae_hold_their_length_where_one_probe_in_four_gains():
    assert pytest.approx(1, abs=0.02) == LONGER * SHORTER**3


def test_following_success_goes_on_where_shrinking_with_the_clock_has_stopped():
    """From 2 400 away, with steps of 10 at first: in all, a clock of 0.95 lets it come 200 far."""
    long_way = np.array([[0.0, 1000.0]] * 6)
    for seed in SEEDS:
        options = {"start": np.full(6, 1000.0), "greedy": True, "antenna": 0.01}
        by_clock = bas(sphere, long_way, 1500, seed, **options)
        by_success = bas(sphere, long_way, 1500, seed, decay=None, **options)
        assert by_success.value < by_clock.value / 1000


@pytest.mark.parametrize("greedy", [False, True])
@pytest.mark.parametrize("block", [1, 2, 3])
def test_a_probe_along_a_block_moves_only_neighbouring_coordinates(greedy, block):
    _, tips, _ = life(rastrigin, 601, 0, greedy=greedy, block=block)
    moved = tips[:, 0] != tips[:, 1]
    probed = moved.reshape(len(tips), -1, block).any(axis=2)
    assert (probed.sum(axis=1) == 1).all()
    # each of 6/block blocks as often: a binomial of at least 200 probes, 5 standard deviations
    count, share = len(tips), block / 6
    assert probed.sum(axis=0) == pytest.approx(count * share, abs=5 * np.sqrt(count * share * (1 - share)))


def test_a_block_of_all_coordinates_is_the_default():
    assert np.array_equal(bas(sphere, BOUNDS, 400, 0, block=6).history, bas(sphere, BOUNDS, 400, 0).history)


def test_antennae_are_a_share_of_the_range_of_each_coordinate():
    bounds = np.array([[0.0, 1.0], [0.0, 1000.0]])
    _, tips, _ = life(lambda x: np.ones(len(x)), 2001, 0, bounds, start=(0.5, 500), greedy=True, antenna=0.1, decay=1.0)
    half = (tips[:, 0] - tips[:, 1]) / 2 / (1.0, 1000.0)
    assert np.linalg.norm(half, axis=1) == pytest.approx(np.full(1000, 0.1), rel=1e-9)
    assert np.abs(half[:, 0]).mean() == pytest.approx(np.abs(half[:, 1]).mean(), rel=0.1)


@pytest.mark.parametrize("dimensions", [2, 3, 6])
def test_gaussian_directions_are_even_on_the_sphere(dimensions):
    """Σu⁴ has a mean of 3/(D + 2) there, u² on an axis is Beta(½, (D − 1)/2): 4 standard errors, a p-value of 1e-4."""
    drawn = directions(dimensions, COUNT)
    fourth = (drawn**4).sum(axis=1)
    assert fourth.mean() == pytest.approx(3 / (dimensions + 2), abs=4 * fourth.std() / np.sqrt(COUNT))
    assert drawn.mean(axis=0) == pytest.approx(np.zeros(dimensions), abs=4 / np.sqrt(dimensions * COUNT))
    assert stats.kstest(drawn[:, 0] ** 2, stats.beta(0.5, (dimensions - 1) / 2).cdf).pvalue > 1e-4


@pytest.mark.parametrize("dimensions", [2, 3, 6])
def test_directions_from_a_cube_prefer_its_corners(dimensions):
    drawn = directions(dimensions, COUNT, as_printed=True)
    fourth = (drawn**4).sum(axis=1)
    assert fourth.mean() < 3 / (dimensions + 2) - 10 * fourth.std() / np.sqrt(COUNT)
    assert stats.kstest(drawn[:, 0] ** 2, stats.beta(0.5, (dimensions - 1) / 2).cdf).pvalue < 1e-10


def test_in_the_plane_corners_are_twice_as_dense_as_axes():
    """From the axis to the corner the density grows as 1/cos², so that Σu⁴ has a mean of 3/2 − π/4."""
    drawn = directions(2, COUNT, as_printed=True)
    fourth = (drawn**4).sum(axis=1)
    assert fourth.mean() == pytest.approx(1.5 - np.pi / 4, abs=4 * fourth.std() / np.sqrt(COUNT))
    from_axis = np.abs((np.arctan2(drawn[:, 1], drawn[:, 0]) + np.pi / 4) % (np.pi / 2) - np.pi / 4)
    assert stats.kstest(np.tan(from_axis), stats.uniform.cdf).pvalue > 1e-4
    assert (from_axis > np.radians(40)).sum() / (from_axis < np.radians(5)).sum() == pytest.approx(
        1.84, abs=0.4
    )  # (1 − tan 40°)/tan 5°, 4 standard errors


def test_on_one_axis_a_beetle_comes_as_near_as_its_last_step_is_long():
    for seed in SEEDS:
        found = bas(lambda x: (x[:, 0] - 1.25) ** 2, [[-5, 5]], 301, seed, decay=0.9)
        assert found.best == pytest.approx([1.25], abs=RANGE * ANTENNA * 0.9**99)


def test_one_point_may_be_given_as_a_row():
    row = bas(sphere, BOUNDS, 40, 0, start=[np.ones(6)])
    assert np.array_equal(row.history, bas(sphere, BOUNDS, 40, 0, start=np.ones(6)).history)
    assert row.history[0] == 6


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"antenna": 0.0}, "antenna must be finite and above 0, got 0"),
        ({"antenna": -0.3}, "antenna must be finite and above 0, got -0.3"),
        ({"antenna": np.inf}, "antenna must be finite and above 0, got inf"),
        ({"antenna": [0.1, 0.2]}, "antenna must be one number, got an array of shape (2,)"),
        ({"decay": 0.0}, "decay must be above 0 and at most 1, or None, got 0.0"),
        ({"decay": 1.01}, "decay must be above 0 and at most 1, or None, got 1.01"),
        ({"decay": np.nan}, "decay must be above 0 and at most 1, or None, got nan"),
        ({"decay": "slow"}, "decay must be a number or an array of numbers"),
        ({"block": 0}, "block must be a whole number of at least 1, got 0"),
        ({"block": 1.5}, "block must be a whole number of at least 1, got 1.5"),
        ({"block": 4}, "block must divide the 6 coordinates, got 4"),
        ({"block": 12}, "block must divide the 6 coordinates, got 12"),
    ],
)
@pytest.mark.parametrize("optimizer", [bas, pso_bas])
def test_a_wrong_setting_of_the_antennae_is_named(optimizer, options, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        optimizer(sphere, BOUNDS, 60, 0, **options)


@pytest.mark.parametrize("greedy", ["False", 2, None])
def test_whether_it_is_greedy_is_true_or_false(greedy):
    with pytest.raises(ValueError, match=re.escape(f"greedy must be True or False, got {greedy!r}")):
        bas(sphere, BOUNDS, 60, 0, greedy=greedy)


def test_a_beetle_that_walks_either_way_has_no_success_to_follow():
    with pytest.raises(ValueError, match="decay must be a number unless greedy"):
        bas(sphere, BOUNDS, 60, 0, decay=None)
