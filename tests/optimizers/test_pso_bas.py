"""PSO-BAS: what the antennae probe, what is done with what they find, and how many evaluations that takes."""

import re

import numpy as np
import pytest

from uavlab.optimizers import bas, pso, pso_bas
from uavlab.optimizers.beetle import DECAY, LONGER, SHORTER
from uavlab.optimizers.pso_bas import ANTENNA

BOUNDS = np.tile([-5.0, 5.0], (6, 1))
WIDE = 1e3 * BOUNDS  # no wall cuts antennae of 1e-4 that begin near the middle
RANGE = 1e4
NEAR = np.random.default_rng(0).uniform(-5, 5, (8, 6))
SEEDS = range(6)


def sphere(x):
    return (x**2).sum(axis=1)


def rastrigin(x):
    return (10 + x**2 - 10 * np.cos(2 * np.pi * x)).sum(axis=1)


def batches(f, budget, rng, bounds=BOUNDS, **options):
    """The points that f is asked for, call by call, and what was found."""
    asked = []

    def spy(x):
        asked.append(x.copy())
        return f(x)

    return asked, pso_bas(spy, bounds, budget, rng, **options)


def better_of(one, other):
    """Row by row the point (N, D) of less value; the first where they are equal."""
    return np.where((sphere(other) < sphere(one))[:, None], other, one)


@pytest.mark.parametrize("antennae", ["best", "current"])
@pytest.mark.parametrize("probes", [1, 3])
def test_antennae_probe_what_they_should_go_to_the_better_tip_and_follow_success(antennae, probes):
    iterations = 12
    budget = 8 + iterations * 8 * (2 * probes + 1)
    asked, found = batches(sphere, budget, 1, WIDE, start=NEAR, swarm=8, antennae=antennae, probes=probes, antenna=1e-4)
    calls = iter(asked)
    now = best = next(calls)
    length, differ = np.full(8, 1e-4), 0
    for _ in range(iterations):
        differ += int((now != best).any(axis=1).sum())
        for _ in range(probes):
            probed = best if antennae == "best" else now
            tips = next(calls).reshape(2, 8, 6)
            assert tips.mean(axis=0) == pytest.approx(probed, abs=1e-9)
            assert np.linalg.norm(tips[0] - tips[1], axis=1) / 2 == pytest.approx(RANGE * length, rel=1e-6)
            tip = better_of(*tips)
            gained = sphere(tip) < sphere(probed)
            length = np.minimum(length * np.where(gained, LONGER, SHORTER), 1e-4)
            probed = better_of(probed, tip)
            best = better_of(best, probed)
            now = probed if antennae == "current" else now
        now = next(calls)
        best = better_of(best, now)
    assert next(calls, None) is None
    assert differ > 8  # the two choices are two
    assert np.array_equal(found.swarm, best[np.argsort(sphere(best))])


def test_the_choice_of_what_to_probe_matters():
    one, other = (pso_bas(rastrigin, BOUNDS, 1000, 0, antennae=choice) for choice in ("best", "current"))
    assert not np.array_equal(one.history, other.history)
    assert np.array_equal(pso_bas(rastrigin, BOUNDS, 1000, 0).history, one.history)


@pytest.mark.parametrize("antennae", ["best", "current"])
@pytest.mark.parametrize("as_printed", [False, True])
def test_no_particle_forgets_its_best(antennae, as_printed):
    """The same search stopped later: constant inertia, for else the budget sets it."""
    for seed in SEEDS:
        before = np.full(20, np.inf)
        for budget in (20, 37, 160, 200, 500, 1000):
            found = pso_bas(
                rastrigin, BOUNDS, budget, seed, inertia=(0.7, 0.7), antennae=antennae, as_printed=as_printed
            )
            values = rastrigin(found.swarm)
            assert (values <= before).all()
            before = values


@pytest.mark.parametrize("antennae", ["best", "current"])
def test_as_printed_antennae_walk_to_the_better_side_even_if_it_is_worse(antennae):
    asked, found = batches(
        sphere, 8 + 12 * 32, 2, WIDE, start=NEAR, swarm=8, antennae=antennae, antenna=1e-4, as_printed=True
    )
    calls = iter(asked)
    now = best = next(calls)
    worse = 0
    for number in range(12):
        tips, walked = next(calls).reshape(2, 8, 6), next(calls)
        probed = best if antennae == "best" else now
        assert tips.mean(axis=0) == pytest.approx(probed, abs=1e-9)
        half = np.linalg.norm(tips[0] - tips[1], axis=1) / 2
        assert half == pytest.approx(np.full(8, RANGE * 1e-4 * DECAY**number), rel=1e-6)
        assert walked == pytest.approx(better_of(*tips), abs=1e-9)
        worse += int((sphere(walked) > sphere(probed)).sum())
        best = better_of(best, walked)
        now = next(calls)
        best = better_of(best, now)
    assert next(calls, None) is None
    assert worse > 0
    assert np.array_equal(found.swarm, best[np.argsort(sphere(best))])


@pytest.mark.parametrize("antennae", ["best", "current"])
def test_as_printed_a_swarm_without_pulls_shows_who_moves(antennae):
    """Without pulls and speed nobody flies; at present positions the walk goes on, at the best it begins anew there."""
    asked, _ = batches(
        sphere, 8 + 12 * 32, 2, WIDE, start=NEAR, swarm=8, c1=0, c2=0, antennae=antennae, antenna=1e-4, as_printed=True
    )
    walked, now = asked[2::3], asked[3::3]
    for there, stood in zip(walked, now, strict=True):
        assert np.array_equal(stood, there if antennae == "current" else NEAR)


def test_as_printed_takes_the_place_of_the_settings_it_names():
    one = pso_bas(rastrigin, BOUNDS, 1000, 0, as_printed=True)
    other = pso_bas(
        rastrigin, BOUNDS, 1000, 0,
        inertia=(0.1, 0.1), v_max=0.01, decay=0.5, probes=7, as_printed=True,
    )  # fmt: skip
    assert np.array_equal(one.history, other.history)
    assert not np.array_equal(one.history, pso_bas(rastrigin, BOUNDS, 1000, 0, as_printed=True, c1=1.0).history)


@pytest.mark.parametrize(("swarm", "probes"), [(20, 3), (7, 1), (5, 4), (1, 2)])
def test_an_iteration_is_two_evaluations_per_probe_and_one_more(swarm, probes):
    each = (2 * probes + 1) * swarm
    for budget in (swarm, swarm + 1, swarm + 5 * each, swarm + 5 * each + each // 2):
        ends = pso_bas(rastrigin, BOUNDS, budget, 0, swarm=swarm, probes=probes).iterations
        assert ends.tolist() == [*range(swarm, budget, each), budget]


def test_a_printed_iteration_is_four_evaluations_per_particle():
    """Two tips, the place it walks to, and the place it flies to."""
    assert pso_bas(rastrigin, BOUNDS, 500, 0, as_printed=True).iterations.tolist() == [*range(20, 500, 80), 500]


def test_antennae_shrink_with_each_probe_if_told_to():
    asked, _ = batches(lambda x: np.ones(len(x)), 8 + 5 * 8 * 5, 0, WIDE, start=NEAR, swarm=8, probes=2, decay=0.9)
    tips = [points.reshape(2, 8, 6) for points in asked if len(points) == 16]
    half = np.linalg.norm([pair[0] - pair[1] for pair in tips], axis=2) / 2
    assert half == pytest.approx(np.repeat(RANGE * ANTENNA * 0.9 ** np.arange(10)[:, None], 8, axis=1), rel=1e-9)


@pytest.mark.parametrize("block", [1, 2, 3])
def test_a_particle_probes_one_block_of_neighbouring_coordinates_at_a_time(block):
    asked, _ = batches(rastrigin, 1000, 0, swarm=8, probes=2, block=block)
    pairs = np.concatenate([points.reshape(2, 8, 6).transpose(1, 0, 2) for points in asked if len(points) == 16])
    probed = (pairs[:, 0] != pairs[:, 1]).reshape(len(pairs), -1, block).any(axis=2)
    assert (probed.sum(axis=1) == 1).all()
    assert (probed.sum(axis=0) > 0.5 * len(pairs) * block / 6).all()
    assert len({tuple(row) for row in probed[:8]}) > 1  # particles choose each for itself


@pytest.mark.parametrize("options", [{"swarm": 1}, {"swarm": 3, "block": 1}])
def test_on_one_axis_the_least_value_is_found(options):
    for seed in SEEDS:
        found = pso_bas(lambda x: (x[:, 0] - 1.25) ** 2, [[-5, 5]], 2000, seed, **options)
        assert found.best == pytest.approx([1.25], abs=1e-4)  # measured up to 2e-6 over 30 seeds


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"antennae": "both"}, "antennae must be one of 'best', 'current', got 'both'"),
        ({"antennae": None}, "antennae must be one of 'best', 'current', got None"),
        ({"probes": 0}, "probes must be a whole number of at least 1, got 0"),
        ({"probes": 2.0}, "probes must be a whole number of at least 1, got 2.0"),
    ],
)
def test_a_wrong_choice_is_named(options, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        pso_bas(sphere, BOUNDS, 60, 0, **options)


def test_as_printed_the_beetle_has_three_dimensions_where_that_divides_all():
    """m = 3 (Table 3); with 3 it is 12 % from the optimum on campuses where all 21 coordinates at once leave 17 %."""
    box = np.tile((-3.0, 4.0), (6, 1))

    def history(bounds, **options):
        return pso_bas(rastrigin, bounds, 800, 0, as_printed=True, **options).history

    assert np.array_equal(history(box), history(box, block=3))
    assert not np.array_equal(history(box), history(box, block=6))
    assert np.array_equal(history(box[:4]), history(box[:4], block=4))
    assert not np.array_equal(history(box[:4]), history(box[:4], block=2))


@pytest.mark.parametrize("search", [pso, bas, pso_bas])
def test_a_search_stops_at_the_iteration_that_reaches_the_target(search):
    whole = search(sphere, BOUNDS, 2000, 3)
    target = float(whole.history[len(whole.history) // 3])
    stopped = search(sphere, BOUNDS, 2000, 3, target=target)
    made = len(stopped.history)
    assert stopped.value <= target < whole.history[stopped.iterations[-2] - 1]
    assert made == stopped.iterations[-1] < 2000
    if search is bas:  # in swarms the inertia follows the budget, which is the same
        assert np.array_equal(stopped.history, whole.history[:made])
    assert np.array_equal(search(sphere, BOUNDS, 300, 3, target=-1.0).history, search(sphere, BOUNDS, 300, 3).history)
    for wrong in (np.nan, np.inf, "low"):
        with pytest.raises(ValueError, match="target must be"):
            search(sphere, BOUNDS, 300, 3, target=wrong)
