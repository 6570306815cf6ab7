"""Particle swarm: a particle's path against Eq. 16 by hand, its stability against closed forms and drawn paths."""

import re

import numpy as np
import pytest

from uavlab.optimizers import pso, pso_bas
from uavlab.optimizers.particle_swarm import C1, C2, INERTIA, flown, stability

BOUNDS = np.tile([-5.0, 5.0], (6, 1))
OMEGA = np.linspace(-1.2, 1.2, 49)
SUM = np.linspace(-1.0, 10.0, 111)
SEEDS = range(8)


def sphere(x):
    return (x**2).sum(axis=1)


def batches(f, budget, rng, bounds=BOUNDS, **options):
    """The points that f is asked for, iteration by iteration."""
    asked = []

    def spy(x):
        asked.append(x.copy())
        return f(x)

    pso(spy, bounds, budget, rng, **options)
    return asked


def spread(points):
    """Mean standard deviation over coordinates, as a share of the range."""
    return points.std(axis=0).mean() / 10


def test_the_mean_comes_to_rest_within_the_triangle():
    inertia, total = np.meshgrid(OMEGA, SUM, indexing="ij")
    inside = (np.abs(inertia) < 1) & (total > 0) & (total < 4 * (1 + inertia))
    edges = np.minimum.reduce([np.abs(np.abs(inertia) - 1), np.abs(total), np.abs(total - 4 * (1 + inertia))])
    for share in (0.0, 0.3, 0.5, 1.0):  # only the sum of c1 and c2 matters
        mean, _ = stability(inertia, share * total, (1 - share) * total)
        away = edges > 1e-6
        assert away.sum() > 4000
        assert np.array_equal((mean < 1)[away], inside[away])


def test_the_variance_comes_to_rest_within_the_closed_region():
    inertia, total = np.meshgrid(OMEGA, SUM, indexing="ij")
    highest = 24 * (1 - inertia**2) / (7 - 5 * inertia)
    inside = (np.abs(inertia) < 1) & (total > 0) & (total < highest)
    away = np.minimum.reduce([np.abs(np.abs(inertia) - 1), np.abs(total), np.abs(total - highest)]) > 1e-6
    mean, variance = stability(inertia, total / 2, total / 2)
    assert np.array_equal((variance < 1)[away], inside[away])
    assert (variance >= mean**2 - 1e-9).all()  # a mean square is at least the square of the mean
    assert ((mean < 1) & (variance > 1))[away].sum() > 200  # a region of its own


@pytest.mark.parametrize("inertia", [-0.6, 0.0, 0.5, 0.729, 0.9])
def test_on_the_closed_boundary_the_variance_neither_grows_nor_falls(inertia):
    c = 12 * (1 - inertia**2) / (7 - 5 * inertia)
    assert stability(inertia, c, c)[1] == pytest.approx(1, abs=1e-9)
    assert stability(inertia, 2 * (1 + inertia), 2 * (1 + inertia))[0] == pytest.approx(1, abs=1e-7)


def drawn_paths(inertia, c1, c2, steps, paths, seed):
    """Where particles are whose bests and leader stand at 0, by the code of the swarm itself, without walls."""
    rng = np.random.default_rng(seed)
    before, x, none = np.ones((paths, 1)), np.full((paths, 1), 0.3), np.zeros((paths, 1))
    wall, velocity = np.array([1e12]), x - before
    for _ in range(steps):
        x, velocity = flown(x, velocity, none, none[0], -wall, wall, ((inertia, inertia), c1, c2, np.inf), 0.5, rng)
    return x[:, 0]


@pytest.mark.parametrize(
    ("inertia", "c1", "c2"),
    [(0.4, 1.5, 2.0), (0.729, 1.494, 1.494), (0.9, 1.5, 2.0), (1.0, 1.5, 2.0), (-0.3, 0.2, 1.0)],
)
def test_drawn_paths_have_the_moments_of_the_recursions(inertia, c1, c2):
    """Six steps: later, few paths make up the mean square. 5 standard errors over 8 seeds of 50 000 paths."""
    kept, of_pull = 1 + inertia - (c1 + c2) / 2, (c1**2 + c2**2) / 12
    of_mean = np.array([[kept, -inertia], [1, 0]])
    of_square = np.array([[kept**2 + of_pull, -2 * inertia * kept, inertia**2], [kept, -inertia, 0], [1, 0, 0]])
    mean = (np.linalg.matrix_power(of_mean, 6) @ [0.3, 1.0])[0]
    square = (np.linalg.matrix_power(of_square, 6) @ [0.09, 0.3, 1.0])[0]
    paths = [drawn_paths(inertia, c1, c2, 6, 50_000, seed) for seed in SEEDS]
    for values, expected in (([x.mean() for x in paths], mean), ([(x**2).mean() for x in paths], square)):
        error = np.std(values, ddof=1) / np.sqrt(len(values))
        assert np.mean(values) == pytest.approx(expected, abs=5 * error)
        assert error < 0.01 * np.sqrt(square)
    radii = [np.abs(np.linalg.eigvals(step)).max() for step in (of_mean, of_square)]
    assert stability(inertia, c1, c2) == pytest.approx(radii, rel=1e-12)


def test_printed_settings_never_rest_and_ours_do_in_the_end():
    first, last = INERTIA
    mean, variance = stability([1.0, first, last], C1, C2)
    assert mean == pytest.approx([1, np.sqrt(first), np.sqrt(last)])  # complex modes: a radius of √ω
    assert variance == pytest.approx([1.299, 1.199, 0.768], abs=5e-4)


def test_paths_drawn_with_the_inertia_at_the_end_come_to_rest_and_those_at_the_beginning_and_as_printed_do_not():
    def typical(inertia):
        return np.median(np.abs(drawn_paths(inertia, C1, C2, 200, 2000, 0)))

    assert typical(INERTIA[1]) < 1e-20  # measured 4e-27
    assert 1 < typical(INERTIA[0]) < 100  # 8
    assert typical(1.0) > 1e4  # 1e5


def test_stability_of_arrays_is_that_of_each_number():
    inertia, c1 = np.array([[0.2], [0.5], [0.9]]), np.array([0.5, 1.5])
    mean, variance = stability(inertia, c1, 2.0)
    assert mean.shape == variance.shape == (3, 2)
    for i in range(3):
        for j in range(2):
            assert stability(inertia[i, 0], c1[j], 2.0) == pytest.approx((mean[i, j], variance[i, j]), rel=1e-12)


@pytest.mark.parametrize("name", ["inertia", "c1", "c2"])
def test_stability_of_what_is_not_finite_is_refused(name):
    with pytest.raises(ValueError, match=f"{name} must be finite, got nan"):
        stability(**({"inertia": 0.5, "c1": 1.0, "c2": 1.0} | {name: np.nan}))


def by_hand(f, bounds, budget, seed, swarm, inertia, c1, c2, v_max):
    """Eq. 16, number by number; the same random numbers in the same order."""
    rng = np.random.default_rng(seed)
    particles, axes = range(swarm), range(len(bounds))
    x = [[float(number) for number in row] for row in rng.uniform(*bounds.T, (swarm, len(bounds)))]
    v = [[0.0] * len(bounds) for _ in particles]
    best, value = [list(row) for row in x], [f(row) for row in x]
    asked, made = [list(row) for row in x], swarm
    while made < budget:
        leader = list(best[min(particles, key=lambda n: value[n])])
        r = rng.random((2, swarm, len(bounds)))
        w = inertia[0] + (inertia[1] - inertia[0]) * made / budget
        for n in particles:
            for d in axes:
                low, high = bounds[d]
                pull = c1 * r[0, n, d] * (best[n][d] - x[n][d]) + c2 * r[1, n, d] * (leader[d] - x[n][d])
                longest = v_max * (high - low)
                v[n][d] = min(max(w * v[n][d] + pull, -longest), longest)
                x[n][d] = min(max(x[n][d] + v[n][d], low), high)
                if x[n][d] in (low, high):
                    v[n][d] = 0.0
        for n in list(particles)[: budget - made]:
            asked.append(list(x[n]))
            if f(x[n]) < value[n]:
                best[n], value[n] = list(x[n]), f(x[n])
        made = min(made + swarm, budget)
    return np.array(asked)


@pytest.mark.parametrize(
    "options",
    [
        {"swarm": 8, "inertia": (0.9, 0.4), "c1": 1.5, "c2": 2.0, "v_max": 0.2},
        {"swarm": 5, "inertia": (0.7, 0.7), "c1": 0.0, "c2": 2.5, "v_max": np.inf},
        {"swarm": 3, "inertia": (0.2, 1.1), "c1": 2.5, "c2": 0.0, "v_max": 0.01},
    ],
)
def test_particles_fly_by_the_equation(options):
    bounds = np.array([[-1.0, 3.0], [0.5, 2.5], [-4.0, -1.0]])
    expected = by_hand(lambda x: sum(number**2 for number in x), bounds, 157, 3, **options)
    assert np.concatenate(batches(sphere, 157, 3, bounds, **options)) == pytest.approx(expected, abs=1e-9)


def test_as_printed_is_the_equation_with_an_inertia_of_one_and_no_limit_of_the_step():
    bounds = np.array([[-1.0, 3.0], [0.5, 2.5], [-4.0, -1.0]])
    printed = {"swarm": 8, "inertia": (1.0, 1.0), "c1": 1.5, "c2": 2.0, "v_max": np.inf}
    expected = by_hand(lambda x: sum(number**2 for number in x), bounds, 157, 3, **printed)
    asked = batches(sphere, 157, 3, bounds, swarm=8, inertia=(0.1, 0.1), v_max=0.01, as_printed=True)
    assert np.concatenate(asked) == pytest.approx(expected, abs=1e-9)


def test_no_step_is_longer_than_its_limit():
    for seed in SEEDS:
        steps = np.abs(np.diff(batches(sphere, 2000, seed, v_max=0.05), axis=0))
        assert 0.4999 < steps.max() <= 0.5 + 1e-12
    assert np.abs(np.diff(batches(sphere, 2000, 0, as_printed=True), axis=0)).max() > 5


def test_our_swarm_ends_at_one_point_and_the_printed_one_all_over_the_box():
    """Spread of the last positions as a share of the range; evenly drawn it is 0.29."""
    for seed in SEEDS:
        asked = batches(sphere, 4000, seed)
        assert spread(asked[0]) > 0.2
        assert spread(asked[-1]) < 1e-5  # measured 1e-8 to 1e-7
        last = batches(sphere, 4000, seed, as_printed=True)[-1]
        assert spread(last) > 0.25  # measured 0.31 to 0.36: more than at the beginning, for many hit a wall
        assert 0.1 < (np.abs(last) == 5).mean() < 0.4  # measured 0.21 to 0.30
        assert spread(batches(sphere, 4000, seed, inertia=(0.9, 0.9))[-1]) > 0.03  # roams to the end


def test_an_iteration_is_one_evaluation_of_each_particle():
    found = pso(sphere, BOUNDS, 50, 0, swarm=20)
    assert found.iterations.tolist() == [20, 40, 50]
    assert pso(sphere, BOUNDS, 20, 0).iterations.tolist() == [20]


def test_a_lone_particle_begins_at_its_best_and_stays_there():
    asked = np.concatenate(batches(sphere, 30, 0, swarm=1))
    assert (asked == asked[0]).all()


def test_a_swarm_finds_the_least_value_on_one_axis():
    for seed in SEEDS:
        found = pso(lambda x: (x[:, 0] - 1.25) ** 2, [[-5, 5]], 1000, seed, swarm=5)
        assert found.best == pytest.approx([1.25], abs=1e-4)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"swarm": 0}, "swarm must be a whole number of at least 1, got 0"),
        ({"swarm": 2.5}, "swarm must be a whole number of at least 1, got 2.5"),
        ({"inertia": 0.7}, "inertia must be two numbers, ω at the beginning and at the end, got 0.7"),
        ({"inertia": (0.9, 0.5, 0.4)}, "inertia must be two numbers"),
        ({"inertia": (0.9, np.nan)}, "inertia must be two numbers"),
        ({"inertia": "falling"}, "inertia must be a number or an array of numbers"),
        ({"c1": -0.1}, "c1 must be finite and at least 0, got -0.1"),
        ({"c1": np.inf}, "c1 must be finite and at least 0, got inf"),
        ({"c2": [1.0, 2.0]}, "c2 must be one number, got an array of shape (2,)"),
        ({"c2": np.nan}, "c2 must be finite and at least 0, got nan"),
        ({"v_max": 0.0}, "v_max must be a share of the range, above 0, got 0.0; infinite for no limit"),
        ({"v_max": -0.2}, "v_max must be a share of the range, above 0, got -0.2"),
        ({"v_max": np.nan}, "v_max must be a share of the range, above 0, got nan"),
    ],
)
@pytest.mark.parametrize("optimizer", [pso, pso_bas])
def test_a_wrong_setting_is_named(optimizer, options, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        optimizer(sphere, BOUNDS, 60, 0, **options)
