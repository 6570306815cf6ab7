"""Offsets: radii against chi-square, laws against integration and samples, the chance of collisions against flights."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy import integrate, stats
from scipy.special import erf, gammainc, ndtr

from uavlab import offsets
from uavlab.offsets import (
    PAUTA_COVERAGE,
    JointOffset,
    OffsetModel,
    SkewedOffset,
    collision_probability,
    crossing_rate,
    magnitude,
    minimum_safe_distance,
    offset_paths,
    pauta_filter,
    pauta_radius,
    safety_domain,
)

SEEDS = range(8)
INTENSITIES = [0.05, 0.1, 0.2, 0.3, 0.5, 0.8, 1.0]
TILTED = JointOffset((0.4, -0.2), (0.8, 1.5), 0.6)


def interval(values, width=4.0):
    """Ends of `width` standard errors around the mean of several seeds."""
    values = np.asarray(values)
    half = width * values.std(ddof=1) / np.sqrt(len(values))
    return values.mean() - half, values.mean() + half


@pytest.mark.parametrize("dimensions", [1, 2, 3])
@pytest.mark.parametrize("share", [0.01, 0.5, 0.9, 0.95, PAUTA_COVERAGE, 0.999999])
def test_radius_is_that_of_chi_square(dimensions, share):
    assert pauta_radius(dimensions, share) == pytest.approx(np.sqrt(stats.chi2.ppf(share, dimensions)), abs=1e-12)


@pytest.mark.parametrize("dimensions", [1, 2, 3])
def test_coverage_is_that_of_chi_square_and_of_the_incomplete_gamma_function(dimensions):
    k = np.linspace(0, 8, 81)
    assert offsets.coverage(k, dimensions) == pytest.approx(stats.chi2.cdf(k**2, dimensions), abs=1e-12)
    assert offsets.coverage(k, dimensions) == pytest.approx(gammainc(dimensions / 2, k**2 / 2), abs=1e-12)


def test_closed_forms_of_coverage():
    k = np.linspace(0.1, 6, 60)
    assert offsets.coverage(k, 1) == pytest.approx(erf(k / np.sqrt(2)), abs=1e-14)
    assert offsets.coverage(k, 2) == pytest.approx(1 - np.exp(-(k**2) / 2), abs=1e-14)
    maxwell = erf(k / np.sqrt(2)) - np.sqrt(2 / np.pi) * k * np.exp(-(k**2) / 2)
    assert offsets.coverage(k, 3) == pytest.approx(maxwell, abs=1e-14)


def test_pauta_radii_in_one_two_and_three_dimensions():
    assert [pauta_radius(d) for d in (1, 2, 3)] == pytest.approx([3, 3.43935, 3.76250], abs=1e-5)
    assert pauta_radius(1) == pytest.approx(3, abs=1e-12)
    assert offsets.coverage(3, 2) == pytest.approx(0.98889, abs=1e-5)
    assert offsets.coverage(3, 3) == pytest.approx(0.97071, abs=1e-5)


@pytest.mark.parametrize("dimensions", [1, 2, 3])
def test_radius_holds_its_share_of_drawn_offsets(dimensions):
    within = [
        (np.linalg.norm(np.random.default_rng(seed).standard_normal((100_000, dimensions)), axis=1) <= 3).mean()
        for seed in SEEDS
    ]
    low, high = interval(within)
    assert low < offsets.coverage(3, dimensions) < high
    assert high - low < 2e-3


@settings(deadline=None)
@given(st.floats(1e-6, 1 - 1e-6), st.sampled_from([1, 2, 3]))
def test_radius_is_the_inverse_of_coverage(share, dimensions):
    assert offsets.coverage(pauta_radius(dimensions, share), dimensions) == pytest.approx(share, rel=1e-10)


@settings(deadline=None)
@given(st.floats(0.01, 6))
def test_more_dimensions_hold_less(k):
    one, two, three = (offsets.coverage(k, d) for d in (1, 2, 3))
    assert one > two > three


def test_gaussian_density_has_its_moments():
    model = OffsetModel(0.7, 1.8)
    for power, expected in ((0, 1), (1, 0.7), (2, 0.7**2 + 1.8**2)):
        found = integrate.quad(lambda x, n=power: x**n * model.density(x), -20, 20, epsabs=1e-12)[0]
        assert found == pytest.approx(expected, abs=1e-9)
    assert model.boundary() == pytest.approx(0.7 + 3 * 1.8)
    assert model.beyond(model.boundary()) == pytest.approx((1 - PAUTA_COVERAGE) / 2)
    assert model.density([0, 1]) == pytest.approx(stats.norm(0.7, 1.8).pdf([0, 1]))


def test_gaussian_is_found_again_in_its_samples():
    fits = [OffsetModel.fit(OffsetModel(-0.4, 2.0).sample(20_000, seed)) for seed in SEEDS]
    for found, true in (([f.mean for f in fits], -0.4), ([f.sigma for f in fits], 2.0)):
        low, high = interval(found)
        assert low < true < high
        assert high - low < 0.1


def test_fit_is_that_of_numpy():
    assert OffsetModel.fit([1, 2, 3, 6]) == OffsetModel(3.0, float(np.std([1, 2, 3, 6], ddof=1)))


def test_same_seed_same_samples():
    for model in (OffsetModel(0, 1), SkewedOffset(0, 1, 0.3), TILTED):
        assert (model.sample(5, 3) == model.sample(5, np.random.default_rng(3))).all()
        assert (model.sample(5, 3) != model.sample(5, 4)).any()


def force_moments_by_integration(intensity):
    """Mean, standard deviation, skewness of |V| V by quadrature over the wind, split where it turns round."""

    def expected(function):
        def weighted(z):
            speed = 1 + intensity * z
            return function(abs(speed) * speed) * stats.norm.pdf(z)

        still = -1 / intensity
        pieces = [(max(still, -30.0), 30.0)] + ([(-30.0, still)] if still > -30 else [])
        return sum(integrate.quad(weighted, *piece, epsabs=1e-13, limit=300)[0] for piece in pieces)

    mean = expected(lambda q: q)
    sigma = np.sqrt(expected(lambda q: (q - mean) ** 2))
    return mean, sigma, expected(lambda q: ((q - mean) / sigma) ** 3)


@pytest.mark.parametrize("intensity", INTENSITIES)
def test_moments_of_the_force_by_integration(intensity):
    model = SkewedOffset(0, 1, intensity)
    assert model.force_moments == pytest.approx(force_moments_by_integration(intensity), rel=1e-8)


@pytest.mark.parametrize("intensity", [0.1, 0.3, 0.6])
def test_moments_and_tail_by_sampling(intensity):
    model = SkewedOffset(0.5, 2.0, intensity)
    drawn = [model.sample(100_000, seed) for seed in SEEDS]
    measured = {
        0.5: [x.mean() for x in drawn],
        2.0: [x.std() for x in drawn],
        model.skewness: [stats.skew(x) for x in drawn],
        float(model.beyond(6.5)): [(x > 6.5).mean() for x in drawn],
        float(model.beyond(0.0)): [(x > 0.0).mean() for x in drawn],
    }
    for expected, values in measured.items():
        low, high = interval(values)
        assert low < expected < high


def test_turbulence_intensity_of_cities():
    city = SkewedOffset(0, 1, 0.3)
    assert city.skewness == pytest.approx(0.8676, abs=1e-4)
    assert city.beyond(3) == pytest.approx(0.00883, abs=1e-5)
    assert city.beyond(3) / OffsetModel(0, 1).beyond(3) == pytest.approx(6.54, abs=0.01)
    assert city.boundary() == pytest.approx(4.108, abs=1e-3)


@pytest.mark.parametrize("intensity", [0.1, 0.2, 0.3])
def test_without_turned_wind_it_is_noncentral_chi_square(intensity):
    square = stats.ncx2(1, 1 / intensity**2, scale=intensity**2)
    mean, variance, skewness = square.stats("mvs")
    found = SkewedOffset(0, 1, intensity).force_moments
    assert found == pytest.approx((mean, np.sqrt(variance), skewness), rel=3e-4)
    beyond = square.sf(mean + 3 * np.sqrt(variance))
    assert SkewedOffset(0, 1, intensity).beyond(3) == pytest.approx(beyond, rel=2e-4)


@pytest.mark.parametrize("intensity", INTENSITIES)
def test_density_of_the_skewed_law_is_the_slope_of_its_distribution(intensity):
    model = SkewedOffset(-0.3, 1.4, intensity)
    still = float(model.offset_of(-1 / intensity))
    for low, high in ((still + 1e-3, still + 1), (0, 1), (1, 8), (still - 1, still - 1e-3)):
        if low < still < high:
            continue
        expected = model.beyond(low) - model.beyond(high)
        assert integrate.quad(model.density, low, high, limit=200)[0] == pytest.approx(expected, rel=1e-7, abs=1e-12)


def test_skewed_law_without_turbulence_is_gaussian():
    x = np.linspace(-4, 4, 81)
    nearly, gaussian = SkewedOffset(0.2, 1.0, 1e-5), OffsetModel(0.2, 1.0)
    assert nearly.beyond(x) == pytest.approx(gaussian.beyond(x), abs=1e-4)
    assert nearly.density(x) == pytest.approx(gaussian.density(x), abs=1e-4)
    assert nearly.skewness == pytest.approx(3e-5, rel=1e-6)


@settings(deadline=None)
@given(st.floats(0.01, 1), st.floats(-5, 5), st.floats(0.1, 5), st.floats(0.001, 0.999))
def test_quantile_is_the_inverse_of_beyond(intensity, mean, sigma, probability):
    for model in (SkewedOffset(mean, sigma, intensity), OffsetModel(mean, sigma)):
        assert model.beyond(model.quantile(probability)) == pytest.approx(1 - probability, abs=1e-6)


@settings(deadline=None)
@given(st.floats(0.02, 0.99))
def test_skewness_grows_with_turbulence(intensity):
    assert SkewedOffset(0, 1, intensity).skewness < SkewedOffset(0, 1, 1.01 * intensity).skewness


def test_offsets_of_an_uncorrected_wind():
    model = SkewedOffset.from_wind(0.8, 0.3)
    speed = 1 + 0.3 * np.random.default_rng(0).standard_normal(1_000_000)
    pushed = 0.8 * np.abs(speed) * speed
    assert model.mean == pytest.approx(pushed.mean(), abs=4 * pushed.std() / 1000)
    assert model.sigma == pytest.approx(pushed.std(), rel=5e-3)
    assert model.offset_of(0.0) == pytest.approx(0.8)


@pytest.mark.parametrize("intensity", [0.2, 0.4])
def test_skewed_law_is_found_again_in_its_samples(intensity):
    true = SkewedOffset(0.3, 1.2, intensity)
    fits = [SkewedOffset.fit(true.sample(50_000, seed)) for seed in SEEDS]
    for name in ("mean", "sigma", "turbulence_intensity"):
        low, high = interval([getattr(fit, name) for fit in fits])
        assert low < getattr(true, name) < high
        assert high - low < 0.06


def test_left_skewed_samples_are_no_wind():
    samples = -SkewedOffset(0, 1, 0.3).sample(1000, 0)
    with pytest.raises(ValueError, match=r"skewness of -0\.\d+; .* turn the axis downwind"):
        SkewedOffset.fit(samples)
    with pytest.raises(ValueError, match=r"gives 0 to 1\.91"):
        SkewedOffset.fit(np.random.default_rng(0).pareto(2.0, 1000))


def test_filter_finds_gross_errors_of_any_size():
    for seed in SEEDS:
        rng = np.random.default_rng(seed)
        samples = rng.normal(0.3, 0.5, 500)
        wrong = rng.choice(500, 12, replace=False)
        samples[wrong] = rng.choice([-1, 1], 12) * rng.uniform(5, 60, 12)
        found = pauta_filter(samples)
        assert not found.kept[wrong].any()
        assert found.kept.sum() >= 500 - 12 - 8
        assert found.rounds >= 2
        assert abs(found.mean - 0.3) < 4 * 0.5 / np.sqrt(488)
        assert 0.44 < found.sigma < 0.55
        assert (np.abs(samples[found.kept] - found.mean) <= 3 * found.sigma).all()


def test_one_round_leaves_what_the_largest_error_hides():
    samples = np.concatenate([np.tile([-1.0, 1.0], 25), [20.0, 400.0]])
    once = np.abs(samples - samples.mean()) <= 3 * samples.std(ddof=1)
    assert once[-2]
    assert not once[-1]
    found = pauta_filter(samples)
    assert found.kept.tolist() == [True] * 50 + [False] * 2
    assert (found.rounds, found.mean, found.sigma) == (2, 0.0, pytest.approx(np.sqrt(50 / 49)))


def test_filter_takes_few_good_samples():
    removed, sigma = zip(
        *((1 - f.kept.mean(), f.sigma) for f in (pauta_filter(OffsetModel(0, 1).sample(20_000, s)) for s in SEEDS)),
        strict=True,
    )
    assert 0.0027 < np.mean(removed) < 0.0040
    assert np.mean(sigma) == pytest.approx(0.985, abs=0.004)


def test_filter_leaves_clean_samples_alone():
    samples = np.linspace(-1, 1, 30)
    found = pauta_filter(samples)
    assert found.kept.all()
    assert found.rounds == 0


def test_below_eleven_samples_nothing_can_be_a_gross_error():
    for count in range(2, 30):
        z = (count - 1) / np.sqrt(count)
        samples = np.zeros(count)
        samples[-1] = 1e6
        assert abs((samples[-1] - samples.mean()) / samples.std(ddof=1)) == pytest.approx(z)
        if count < 11:
            with pytest.raises(ValueError, match=rf"at least 11 for 3σ, got {count}: .* = {z:.2f}σ"):
                pauta_filter(samples)
        else:
            assert not pauta_filter(samples).kept[-1]


@settings(deadline=None)
@given(st.floats(1, 6))
def test_least_number_of_samples_is_the_first_that_works(radius):
    with pytest.raises(ValueError, match="samples must be at least") as error:
        pauta_filter([0.0, 1.0], radius)
    least = int(str(error.value).split("at least ")[1].split(" ")[0])
    assume(abs((least - 1) / np.sqrt(least) - radius) > 1e-9)
    spike = np.zeros(least)
    spike[0] = 1.0
    assert pauta_filter(spike, radius).kept.tolist() == [False] + [True] * (least - 1)
    with pytest.raises(ValueError, match=f"at least {least} "):
        pauta_filter(spike[:-1], radius)


@settings(deadline=None)
@given(st.lists(st.floats(-100, 100), min_size=12, max_size=60), st.floats(0.1, 10), st.floats(-50, 50))
def test_filter_doesnt_depend_on_unit_or_origin(values, scale, shift):
    samples = np.round(values, 3)
    assume(np.ptp(samples) > 0.1)
    kept = pauta_filter(samples)
    assume(np.min(np.abs(np.abs(samples - kept.mean) - 3 * kept.sigma)) > 1e-6)
    moved = pauta_filter(scale * samples + shift)
    assert moved.kept.sum() == kept.kept.sum()
    assert moved.mean == pytest.approx(scale * kept.mean + shift, abs=1e-6)


def test_minimum_safe_distance_gives_the_papers_three_distances():
    assert minimum_safe_distance([3, 4, 5], 1.0).tolist() == [3.5, 4.5, 5.5]
    assert minimum_safe_distance(3.0, 1.0) == 3.5


def test_wind_towards_the_wall_widens_and_wind_away_doesnt():
    wall_in_the_west = (1.0, 0.0)
    assert minimum_safe_distance(3, 1, mean_offset=(-2, 5), normal=wall_in_the_west) == 5.5
    assert minimum_safe_distance(3, 1, mean_offset=(2, 5), normal=wall_in_the_west) == 3.5
    assert minimum_safe_distance(3, 1, mean_offset=(0, -2), normal=(0, 9)) == 5.5


def test_widening_takes_maps_of_normals():
    angle = np.linspace(0, 2 * np.pi, 24).reshape(4, 6)
    normals = np.stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)], axis=-1)
    widened = minimum_safe_distance(np.full((4, 6), 3.0), 1, mean_offset=(1.5, 0, 0), normal=normals)
    assert widened == pytest.approx(3.5 + 1.5 * np.maximum(0, -np.cos(angle)))


@settings(deadline=None)
@given(st.floats(0, 20), st.floats(0.01, 3), st.tuples(*[st.floats(-5, 5)] * 3), st.floats(0, 2 * np.pi))
def test_widened_distance_lies_between_the_still_one_and_that_plus_the_mean_offset(offset, diameter, mean, angle):
    still = minimum_safe_distance(offset, diameter)
    widened = minimum_safe_distance(
        offset, diameter, mean_offset=mean, normal=(np.cos(angle), np.sin(angle), np.sin(3 * angle))
    )
    assert still <= widened <= still + np.linalg.norm(mean) + 1e-9


def test_joint_density_integrates_to_one_and_has_gaussian_marginals():
    whole = integrate.dblquad(lambda y, x: TILTED.density((x, y)), -8, 8, -13, 13, epsabs=1e-9)[0]
    assert whole == pytest.approx(1, abs=1e-7)
    for axis, other in ((0, 1), (1, 0)):
        marginal = OffsetModel(TILTED.mean[axis], TILTED.sigma[axis])
        for x in (-1.0, 0.3, 2.0):
            line = np.zeros((20_001, 2))
            line[:, axis], line[:, other] = x, np.linspace(-15, 15, 20_001)
            assert integrate.simpson(TILTED.density(line), x=line[:, other]) == pytest.approx(marginal.density(x))


def test_joint_density_is_that_of_scipy_and_may_exceed_one():
    points = np.random.default_rng(0).normal(size=(4, 5, 2))
    expected = stats.multivariate_normal(TILTED.mean, TILTED.covariance).pdf(points)
    assert TILTED.density(points) == pytest.approx(expected)
    assert JointOffset((0, 0), (0.2, 0.2)).density((0, 0)) == pytest.approx(1 / (2 * np.pi * 0.04))
    assert JointOffset((0, 0), (0.2, 0.2)).density((0, 0)) > 3


@pytest.mark.parametrize("share", [0.5, 0.95, PAUTA_COVERAGE])
def test_ellipse_holds_its_share(share):
    outline = TILTED.ellipse(share)
    assert outline[0] == pytest.approx(outline[-1])
    assert TILTED.radius_in_sigma(outline) == pytest.approx(np.full(181, pauta_radius(2, share)))
    within = [(TILTED.radius_in_sigma(TILTED.sample(50_000, s)) <= pauta_radius(2, share)).mean() for s in SEEDS]
    low, high = interval(within)
    assert low < share < high


@pytest.mark.parametrize("radius", [0.3, 1.0, 2.5, 5.0])
def test_circle_holds_its_share(radius):
    within = [(np.linalg.norm(TILTED.sample(50_000, s), axis=1) <= radius).mean() for s in SEEDS]
    low, high = interval(within)
    assert low < TILTED.within_circle(radius) < high


def test_circle_of_equal_axes_is_rayleighs_and_with_a_mean_rices():
    assert JointOffset((0, 0), (2, 2)).circle() == pytest.approx(2 * pauta_radius(2), abs=1e-9)
    assert JointOffset((0, 0), (2, 2)).within_circle(6) == pytest.approx(offsets.coverage(3, 2), abs=1e-12)
    shifted = JointOffset((0.6, -0.8), (1.5, 1.5))
    law = magnitude(1.5, 1.0)
    assert shifted.within_circle(3.0) == pytest.approx(law.cdf(3.0), abs=1e-10)
    assert shifted.circle() == pytest.approx(law.ppf(PAUTA_COVERAGE), abs=1e-7)
    assert JointOffset((0, 0), (1, 1)).within_circle(0) == 0


@settings(deadline=None, max_examples=40)
@given(
    st.tuples(*[st.floats(-3, 3)] * 2),
    st.tuples(*[st.floats(0.05, 5)] * 2),
    st.floats(-0.99, 0.99),
    st.floats(0.1, 0.9999),
)
def test_circle_is_the_inverse_of_within_circle(mean, sigma, correlation, share):
    joint = JointOffset(mean, sigma, correlation)
    assert joint.within_circle(joint.circle(share)) == pytest.approx(share, abs=1e-9)


def test_joint_offset_is_found_again_in_its_samples():
    fits = [JointOffset.fit(TILTED.sample(20_000, seed)) for seed in SEEDS]
    columns = np.array([(*f.mean, *f.sigma, f.correlation) for f in fits]).T
    for values, true in zip(columns, (*TILTED.mean, *TILTED.sigma, TILTED.correlation), strict=True):
        low, high = interval(values)
        assert low < true < high
        assert high - low < 0.06


def test_magnitude_is_rayleigh():
    law = magnitude(1.7)
    assert law.mean() == pytest.approx(1.7 * np.sqrt(np.pi / 2))
    assert law.mean() == pytest.approx(1.2533 * 1.7, abs=1e-4)
    assert law.ppf(PAUTA_COVERAGE) == pytest.approx(1.7 * pauta_radius(2))
    drawn = [np.linalg.norm(np.random.default_rng(s).normal(0, 1.7, (20_000, 2)), axis=1) for s in SEEDS]
    low, high = interval([d.mean() for d in drawn])
    assert low < law.mean() < high


def test_magnitude_with_a_mean_offset_is_rice():
    law = magnitude(1.2, 2.0)
    drawn = [np.linalg.norm(np.random.default_rng(s).normal((2, 0), 1.2, (20_000, 2)), axis=1) for s in SEEDS]
    for expected, measured in (
        (law.mean(), [d.mean() for d in drawn]),
        (law.std(), [d.std() for d in drawn]),
        (law.sf(4.0), [(d > 4).mean() for d in drawn]),
    ):
        low, high = interval(measured)
        assert low < expected < high
    assert magnitude(1.2, 1e-6).ppf(0.9) == pytest.approx(magnitude(1.2).ppf(0.9))


def test_paths_have_the_autocorrelation_they_should():
    lags = np.array([0, 10, 20, 40, 80])
    for rough in (False, True):
        measured = []
        for seed in SEEDS:
            time, path = offset_paths(0.7, 8.0, seed, count=4000, step=0.05, natural_frequency=1.5, rough=rough)
            measured.append([(path[:, 60] * path[:, 60 + lag]).mean() for lag in lags])
        assert path.shape == (4000, len(time)) == (4000, 161)
        assert time[-1] == pytest.approx(8.0)
        decay = 1.5 * 0.05 * lags
        expected = 0.49 * (np.exp(-decay / 2) if rough else (1 + decay) * np.exp(-decay))
        for values, value in zip(np.array(measured).T, expected, strict=True):
            low, high = interval(values)
            assert low < value < high
            assert high - low < 0.06


def test_paths_follow_the_differential_equation_at_any_step():
    coarse, fine = ([offset_paths(1, 40, s, count=500, step=h)[1][:, -1].std() for s in SEEDS] for h in (4.0, 0.1))
    for values in (coarse, fine):
        low, high = interval(values)
        assert low < 1 < high


def test_same_seed_same_paths():
    assert (offset_paths(1, 2, 5, count=3)[1] == offset_paths(1, 2, 5, count=3)[1]).all()
    assert (offset_paths(1, 2, 5, count=3)[1] != offset_paths(1, 2, 6, count=3)[1]).any()


@pytest.mark.parametrize("level", [0.0, 1.0, 2.0])
def test_crossings_are_as_frequent_as_rice_says(level):
    rates = []
    for seed in SEEDS:
        _, path = offset_paths(1.3, 20, seed, count=1000, step=0.02, natural_frequency=2.0)
        rates.append(((path[:, :-1] <= 1.3 * level) & (path[:, 1:] > 1.3 * level)).sum() / (1000 * 20))
    low, high = interval(rates)
    # a step can hide a pair of crossings: 1 % of them at this step
    assert low < crossing_rate(1.3 * level, 1.3, 2.0) < 1.015 * high


def test_rough_offsets_have_no_rate():
    counts = []
    for step in (0.08, 0.02, 0.005):
        _, path = offset_paths(1, 20, 0, count=500, step=step, rough=True)
        counts.append(((path[:, :-1] <= 1) & (path[:, 1:] > 1)).sum())
    assert counts[1] / counts[0] == pytest.approx(2, rel=0.1)
    assert counts[2] / counts[1] == pytest.approx(2, rel=0.1)


def collided(margin, duration, rough=False, step=0.02, count=20_000, **setting):
    """Share of flights of each seed that exceed a margin."""
    return [
        (offset_paths(1, duration, seed, count=count, step=step, rough=rough, **setting)[1].max(axis=1) > margin).mean()
        for seed in SEEDS
    ]


def test_eight_seconds_beside_a_wall():
    predicted = float(collision_probability(3.5, 1.0, 8.0, uav_diameter=1.0))
    assert predicted == pytest.approx(0.0154, abs=5e-5)
    low, high = interval(collided(3.0, 8.0), width=3)
    assert 0.0135 < low < high < 0.0160
    assert low < predicted
    rough_low, _ = interval(collided(3.0, 8.0, rough=True))
    assert rough_low > 2 * predicted


@pytest.mark.parametrize(("margin", "duration", "frequency"), [(2.5, 8, 1.0), (3.0, 20, 0.7), (2.5, 4, 2.0)])
def test_chance_over_a_flight_by_flying(margin, duration, frequency):
    measured = collided(margin, duration, natural_frequency=frequency, count=10_000)
    low, high = interval(measured)
    predicted = collision_probability(margin, 1.0, duration, frequency)
    assert low < predicted < 1.15 * high
    assert predicted > np.mean(measured) * 0.97


def test_at_once_it_is_the_gaussian_tail():
    u = np.array([-40.0, -2.0, 0.0, 1.0, 3.0, 8.0, 37.0])
    assert collision_probability(50, 1, 0, mean_away=u - 50) == pytest.approx(ndtr(-u), rel=1e-9)


@settings(deadline=None)
@given(st.floats(0, 8), st.floats(0.1, 3), st.floats(0, 1000), st.floats(0.1, 5), st.floats(-4, 4))
def test_laws_of_the_chance_over_a_flight(distance, sigma, duration, frequency, mean):
    setting = {"uav_diameter": 0.5, "mean_away": mean}
    chance = collision_probability(distance, sigma, duration, frequency, **setting)
    assert 0 <= chance <= 1
    assert collision_probability(distance, sigma, duration + 10, frequency, **setting) >= chance
    assert collision_probability(distance + 0.5, sigma, duration, frequency, **setting) <= chance
    margin = distance - 0.25 + mean
    bound = ndtr(-margin / sigma) + crossing_rate(margin, sigma, frequency) * duration
    assert chance <= bound * (1 + 1e-9)
    if bound < 1e-3:
        assert chance == pytest.approx(bound, rel=2e-3)


def test_chance_takes_arrays():
    chance = collision_probability([[2.0], [3.0]], [0.5, 1.0, 1.5], 60.0)
    assert chance.shape == (2, 3)
    assert chance[1, 1] == collision_probability(3.0, 1.0, 60.0)


NAN = float("nan")


@pytest.mark.parametrize("share", [0.5, 0.9, PAUTA_COVERAGE])
def test_a_safety_domain_holds_its_share_of_the_offsets_it_was_made_of(share):
    """Over seeds; its outline and its radius hold that share of the fitted law exactly."""
    domains = [safety_domain(TILTED.sample(20_000, seed), share) for seed in SEEDS]
    for field in ("in_ellipse", "in_circle"):
        low, high = interval([getattr(domain, field) for domain in domains])
        assert low < share < high
        assert high - low < 0.02
    for domain in domains[:3]:
        assert domain.coverage == pytest.approx(share)
        assert domain.model.radius_in_sigma(domain.ellipse) == pytest.approx(np.full(181, pauta_radius(2, share)))
        assert domain.ellipse[0] == pytest.approx(domain.ellipse[-1])
        assert domain.model.within_circle(domain.radius) == pytest.approx(share)


def test_shares_of_a_safety_domain_are_counts_of_its_samples():
    samples = TILTED.sample(500, 3)
    domain = safety_domain(samples, 0.8)
    assert domain.model == JointOffset.fit(samples)
    along, across = np.linalg.eigh(domain.model.covariance)
    inside = (((samples - domain.model.mean) @ across) ** 2 / along).sum(axis=1) <= stats.chi2.ppf(0.8, 2)
    assert domain.in_ellipse == inside.mean()
    assert domain.in_circle == (np.linalg.norm(samples, axis=1) <= domain.radius).mean()


@pytest.mark.parametrize("seed", range(4))
def test_as_printed_a_safety_domain_is_an_eighth_too_small(seed):
    samples = JointOffset((0.0, 0.0), (1.3, 1.3)).sample(100_000, seed)
    printed, meant = safety_domain(samples, as_printed=True), safety_domain(samples)
    assert printed.coverage == pytest.approx(1 - np.exp(-4.5))
    assert printed.in_ellipse == pytest.approx(0.98889, abs=4 * np.sqrt(0.011 / 100_000))
    assert meant.in_ellipse == pytest.approx(PAUTA_COVERAGE, abs=4 * np.sqrt(0.0027 / 100_000))
    assert printed.radius == pytest.approx(3 * max(printed.model.sigma))
    assert printed.radius / meant.radius == pytest.approx(0.8723, abs=0.01)
    assert printed.ellipse - printed.model.mean == pytest.approx((meant.ellipse - meant.model.mean) * 0.8723, abs=1e-3)
    assert printed.in_circle < meant.in_circle


def test_a_mean_offset_moves_the_ellipse_and_widens_the_circle():
    samples = JointOffset((0.0, 0.0), (1.0, 0.5)).sample(5000, 1)
    still, pushed = safety_domain(samples), safety_domain(np.add(samples, (2.0, 0.0)))
    assert pushed.ellipse == pytest.approx(np.add(still.ellipse, (2.0, 0.0)))
    assert pushed.in_ellipse == pytest.approx(still.in_ellipse)
    assert still.radius + 1 < pushed.radius < still.radius + 2  # it is around the route


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: OffsetModel(0, -1), r"sigma must be finite and above 0, got -1"),
        (lambda: OffsetModel(0, 0), r"sigma must be finite and above 0, got 0"),
        (lambda: OffsetModel(NAN, 1), r"mean must be finite, got nan"),
        (lambda: OffsetModel(0, 1).boundary(1), r"coverage must be between 0 and 1, without the ends, got 1"),
        (lambda: OffsetModel(0, 1).quantile([0.5, 0]), r"probability must be between 0 and 1, .*, got 0"),
        (lambda: OffsetModel.fit([1.0]), r"samples must be at least 2, got 1"),
        (lambda: OffsetModel.fit([[1.0, 2.0]]), r"samples must have shape \(N,\), got \(1, 2\)"),
        (lambda: OffsetModel.fit([1, NAN, 3, np.inf]), r"finite: 2 of 4 are not, at 1, 3; drop or repair"),
        (lambda: OffsetModel.fit([NAN] * 9), r"9 of 9 are not, at 0, 1, 2, 3, 4, …;"),
        (lambda: OffsetModel.fit([2, 2, 2]), r"samples must differ: all are equal"),
        (lambda: SkewedOffset(0, -1, 0.3), r"sigma must be finite and above 0"),
        (lambda: SkewedOffset(np.inf, 1, 0.3), r"mean must be finite"),
        (lambda: SkewedOffset(0, 1, 0), r"turbulence_intensity must be above 0 and at most 1, got 0; .* OffsetModel"),
        (lambda: SkewedOffset(0, 1, 30), r"turbulence_intensity must be above 0 and at most 1, got 30"),
        (lambda: SkewedOffset(0, 1, NAN), r"turbulence_intensity must be above 0"),
        (lambda: SkewedOffset.from_wind(-1, 0.3), r"steady_offset must be finite and above 0, got -1"),
        (lambda: SkewedOffset.fit([1, 2]), r"samples must be at least 3, got 2"),
        (lambda: SkewedOffset(0, 1, 0.3).boundary(0), r"coverage must be between 0 and 1"),
        (lambda: offsets.coverage(-1, 2), r"radius_in_sigma must be finite and at least 0, got -1"),
        (lambda: offsets.coverage(3, 4), r"dimensions must be 1, 2 or 3, got 4"),
        (lambda: offsets.coverage(3, 0), r"dimensions must be 1, 2 or 3, got 0"),
        (lambda: pauta_radius(2.5), r"dimensions must be 1, 2 or 3, got 2.5"),
        (lambda: pauta_radius(2, 99.73), r"coverage must be between 0 and 1, without the ends, got 99.73"),
        (lambda: pauta_radius(2, NAN), r"coverage must be between 0 and 1, .* got nan"),
        (lambda: pauta_filter([1, 2, NAN] * 5), r"5 of 15 are not, at 2, 5, 8, 11, 14; drop"),
        (lambda: pauta_filter(np.ones(20)), r"samples must differ"),
        (lambda: pauta_filter(np.arange(20), 0.5), r"radius_in_sigma must be finite and at least 1, got 0.5"),
        (lambda: minimum_safe_distance(-1, 1), r"offset must be finite and at least 0, got -1"),
        (lambda: minimum_safe_distance(NAN, 1), r"offset must be finite and at least 0, got nan"),
        (lambda: minimum_safe_distance(1, 0), r"uav_diameter must be finite and above 0, got 0"),
        (lambda: minimum_safe_distance(1, 1, normal=(1, 0)), r"mean_offset and normal belong together"),
        (lambda: minimum_safe_distance(1, 1, mean_offset=(1, 0)), r"mean_offset and normal belong together"),
        (
            lambda: minimum_safe_distance(1, 1, mean_offset=(1, 0), normal=[(1, 0), (0, 0)]),
            r"normal must be a direction away from the wall, 1 of 2 have length 0",
        ),
        (lambda: minimum_safe_distance(1, 1, mean_offset=(NAN, 0), normal=(1, 0)), r"mean_offset must be finite"),
        (lambda: minimum_safe_distance(1, 1, mean_offset=(1, 0), normal=(np.inf, 0)), r"normal must be finite"),
        (lambda: minimum_safe_distance("3", 1), r"offset must be a number or an array of numbers: got text, '3'"),
        (
            lambda: minimum_safe_distance(1, 1, mean_offset=(1, 0, 0), normal=(1, 0)),
            r"mean_offset \(3,\), normal \(2,\)",
        ),
        (lambda: minimum_safe_distance(1, 1, mean_offset=1, normal=1), r"mean_offset must be a vector"),
        (lambda: pauta_filter([]), r"samples must be at least 2, got 0"),
        (lambda: JointOffset.fit(np.empty((0, 2))), r"samples must be at least 3, got 0"),
        (lambda: JointOffset.fit([[0, 0], [1, 2], [2, 4]]), r"samples lie on a line"),
        (lambda: JointOffset.fit([[0, 0], [1, -0.3], [3, -0.9]]), r"samples lie on a line"),
        (lambda: OffsetModel.fit([[1], [1, 2]]), r"samples must be a number or an array of numbers"),
        (lambda: TILTED.density([[1.0], [2.0]]), r"points must have shape \(\.\.\., 2\), got \(2, 1\)"),
        (lambda: TILTED.density(1.0), r"points must have shape \(\.\.\., 2\), got \(\)"),
        (lambda: JointOffset((0, 0, 0), (1, 1)), r"mean must be two numbers, .* got shape \(3,\)"),
        (lambda: JointOffset((0, 0), 1), r"sigma must be two numbers, .* got shape \(\)"),
        (lambda: JointOffset((0, NAN), (1, 1)), r"mean must be finite"),
        (lambda: JointOffset((0, 0), (1, -1)), r"sigma must be finite and above 0, got -1"),
        (lambda: JointOffset((0, 0), (1, 1), 1), r"correlation must be between -1 and 1, without the ends, got 1"),
        (lambda: JointOffset((0, 0), (1, 1), NAN), r"correlation must be between -1 and 1"),
        (lambda: JointOffset.fit([[0, 1], [1, 0]]), r"samples must be at least 3, got 2"),
        (lambda: JointOffset.fit([0, 1, 2]), r"samples must have shape \(N, 2\), got \(3,\)"),
        (lambda: JointOffset.fit([[0, 1], [NAN, 0], [2, 2]]), r"1 of 3 are not, at 1;"),
        (lambda: JointOffset.fit([[0, 1], [1, 1], [2, 1]]), r"samples must differ"),
        (lambda: TILTED.circle(1.5), r"coverage must be between 0 and 1"),
        (lambda: safety_domain([[0, 1], [1, 0]]), r"samples must be at least 3, got 2"),
        (lambda: safety_domain([[0, 1], [NAN, 0], [2, 2]]), r"1 of 3 are not, at 1;"),
        (lambda: safety_domain([[0, 0], [1, 2], [2, 4]]), r"samples lie on a line"),
        (lambda: safety_domain([0, 1, 2]), r"samples must have shape \(N, 2\), got \(3,\)"),
        (lambda: safety_domain([[0, 0], [1, 2], [2, 0]], 1.0), r"coverage must be between 0 and 1"),
        (lambda: safety_domain([[0, 0], [1, 2], [2, 0]], 99.73, as_printed=True), r"coverage must be between 0 and 1"),
        (lambda: TILTED.ellipse(0), r"coverage must be between 0 and 1"),
        (lambda: TILTED.within_circle(-1), r"radius must be finite and at least 0"),
        (lambda: magnitude(0), r"sigma must be finite and above 0"),
        (lambda: magnitude(1, -1), r"mean_length must be finite and at least 0"),
        (lambda: crossing_rate(NAN, 1), r"margin must be finite"),
        (lambda: crossing_rate(1, 0), r"sigma must be finite and above 0"),
        (lambda: crossing_rate(1, 1, 0), r"natural_frequency must be finite and above 0"),
        (lambda: collision_probability(-1, 1, 1), r"distance must be finite and at least 0, got -1"),
        (lambda: collision_probability(1, -1, 1), r"sigma must be finite and above 0, got -1"),
        (lambda: collision_probability(1, 1, -1), r"duration must be finite and at least 0, got -1"),
        (lambda: collision_probability(1, 1, 1, -1), r"natural_frequency must be finite and above 0, got -1"),
        (lambda: collision_probability(1, 1, 1, uav_diameter=-1), r"uav_diameter must be finite and at least 0"),
        (lambda: collision_probability(1, 1, 1, mean_away=NAN), r"mean_away must be finite"),
        (lambda: offset_paths(-1, 1, 0), r"sigma must be finite and above 0"),
        (lambda: offset_paths(1, 0.01, 0), r"duration must be finite and at least one step of 0.05 s, got 0.01"),
        (lambda: offset_paths(1, NAN, 0), r"duration must be finite"),
        (lambda: offset_paths(1, 1, 0, step=0), r"step must be finite and above 0"),
        (lambda: offset_paths(1, 1, 0, step=1e-6), r"step must be at least 0.0001/natural_frequency"),
        (lambda: offset_paths(1, 1, 0, count=0), r"count must be a whole number of at least 1, got 0"),
        (lambda: offset_paths(1, 1, 0, count=2.5), r"count must be a whole number of at least 1, got 2.5"),
        (lambda: offset_paths(1, "8", 0), r"duration must be a number .* got text, '8'"),
        (lambda: offset_paths(1, 1, 0, natural_frequency=-1), r"natural_frequency must be finite and above 0"),
    ],
)
def test_wrong_questions_are_refused_by_name(call, message):
    with pytest.raises(ValueError, match=message):
        call()
