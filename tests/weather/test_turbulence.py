"""Dryden gusts against their spectra, variances and correlations."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.signal import welch
from scipy.stats import chi2, kstest

from uavlab.weather import dryden_gusts, dryden_parameters, dryden_spectrum
from uavlab.weather.turbulence import OUTPUT, STATIONARY, lag_step, two_lags

CASE = {"air_speed": 8.0, "altitude": 30.0, "wind_at_6m": 6.0}
WHERE = {"altitude": 30.0, "wind_at_6m": 6.0}


def correlation(axis, lag):
    """Of the Dryden model, over a lag in time scales: longitudinal, or transverse."""
    return np.exp(-lag) * (1.0 if axis == 0 else 1.0 - lag / 2)


def test_parameters_by_hand():
    """At 1000 ft the horizontal and vertical scales agree, and so do the deviations; at 100 ft they don't."""
    lengths, deviations = dryden_parameters(304.8, 15.0)
    assert lengths == pytest.approx([304.8] * 3)
    assert deviations == pytest.approx([1.5] * 3)
    lengths, deviations = dryden_parameters(30.48, 15.0)
    assert lengths == pytest.approx([0.3048 * 100 / 0.2593**1.2] * 2 + [30.48])
    assert deviations == pytest.approx([1.5 / 0.2593**0.4] * 2 + [1.5])


@pytest.mark.parametrize("altitude", [3.05, 30.0, 300.0])
@pytest.mark.parametrize("air_speed", [2.0, 20.0])
def test_spectra_integrate_to_the_variances(air_speed, altitude):
    lengths, deviations = dryden_parameters(altitude, 6.0)
    for axis in range(3):
        corner = air_speed / lengths[axis]
        area, _ = quad(
            lambda x, a=axis, c=corner: c * dryden_spectrum(c * x, air_speed, altitude, 6.0)[a], 0, np.inf, limit=200
        )
        assert area == pytest.approx(deviations[axis] ** 2, rel=1e-6)


def test_spectrum_has_the_shape_of_its_frequencies():
    assert dryden_spectrum(1.0, **CASE).shape == (3,)
    assert dryden_spectrum(np.ones((4, 5)), **CASE).shape == (4, 5, 3)
    assert (dryden_spectrum([0.0, 0.1], 8.0, 30.0, 0.0) == 0).all()


@given(st.floats(1e-7, 200.0))
def test_step_keeps_the_stationary_covariance(step):
    transition, covariance = lag_step(step)
    assert transition @ STATIONARY @ transition.T + covariance == pytest.approx(STATIONARY, abs=1e-12)
    assert np.linalg.eigvalsh(covariance)[0] > 0


@settings(deadline=None)
@given(st.floats(1e-3, 3.0))
def test_step_agrees_with_the_integral_and_with_two_halves(step):
    """Covariance ∫ e^{As} B Bᵀ e^{Aᵀs} ds; e^{As} B = e^{−s} (1, s)."""
    transition, covariance = lag_step(step)
    entries = [quad(lambda s, n=n: np.exp(-2 * s) * s**n, 0, step, epsabs=1e-14)[0] for n in (0, 1, 2)]
    assert covariance == pytest.approx(np.array([[entries[0], entries[1]], [entries[1], entries[2]]]), abs=1e-12)
    half, noise = lag_step(step / 2)
    assert half @ half == pytest.approx(transition, abs=1e-12)
    assert half @ noise @ half.T + noise == pytest.approx(covariance, abs=1e-12)


@pytest.mark.parametrize("step", [1e-12, 1e-6, 1e-3])
def test_short_step_has_the_covariance_of_integrated_noise(step):
    """To a relative 2h, entry by entry: h, h²/2 and h³/3, of which the last is easily lost beside the first."""
    expected = np.array([[step, step**2 / 2], [step**2 / 2, step**3 / 3]])
    assert lag_step(step)[1] / expected == pytest.approx(np.ones((2, 2)), abs=2 * step + 1e-12)


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("lag", [0.0, 0.01, 0.5, 2.0, 5.0])
def test_model_has_the_correlation_of_dryden(axis, lag):
    """Exactly, before any noise is drawn: the output's covariance over a lag, in time scales."""
    transition = lag_step(lag)[0] if lag else np.eye(2)
    assert OUTPUT[axis] @ transition @ STATIONARY @ OUTPUT[axis] == pytest.approx(correlation(axis, lag), abs=1e-12)


def test_recursion_is_the_plain_one():
    """The two filters against a loop over time steps."""
    normal = np.random.default_rng(0).standard_normal((50, 2))
    transition, covariance = lag_step(0.3)
    state = np.linalg.cholesky(STATIONARY) @ normal[0]
    for sample, draw in zip(two_lags(normal, 0.3), [*normal[1:], normal[0]], strict=True):
        assert sample == pytest.approx(state, abs=1e-12)
        state = transition @ state + np.linalg.cholesky(covariance) @ draw


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_spectrum_of_long_series_is_the_one_asked_for(seed):
    """Welch's estimate, averaged over K segments without overlap, times 2K/density is chi-square with 2K degrees.

    Averages over bands: each within the bounds that a chi-square leaves with one chance in 10⁵.
    """
    step, length, segments = 0.05, 4096, 300
    gusts = dryden_gusts(step * length * segments, step, **CASE, rng=seed)
    hertz, density = welch(gusts, 1 / step, "hann", length, 0, axis=0, detrend=False)
    omega = 2 * np.pi * hertz
    # sampling folds what is above half the sampling rate back: add the first ten folds
    folds = [omega] + [np.abs(side * omega + 2 * np.pi / step * k) for k in range(1, 11) for side in (-1, 1)]
    expected = 2 * np.pi * sum(dryden_spectrum(fold, **CASE) for fold in folds)
    for low, high in [(3, 6), (6, 12), (12, 25), (25, 50), (50, 100), (100, 200), (200, 500), (500, 2000)]:
        count = segments * (high - low) / 1.5  # a Hann window ties neighbours together
        bounds = chi2.ppf([5e-6, 1 - 5e-6], 2 * count) / (2 * count)
        ratio = (density[low:high] / expected[low:high]).mean(axis=0)
        # the window leaks from the steep part near zero and folds go on beyond the tenth: 2 %
        assert ((ratio > bounds[0] - 0.02) & (ratio < bounds[1] + 0.02)).all(), (low, high, ratio, bounds)


@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("step", [0.02, 1.0, 30.0])
def test_variance_does_not_depend_on_the_time_step(seed, step):
    count = 200_000
    gusts = dryden_gusts(count * step, step, **CASE, rng=seed)
    lengths, deviations = dryden_parameters(**WHERE)
    for axis in range(3):
        lags = np.arange(1, count) * step * 8.0 / lengths[axis]
        factor = 1 + 2 * (correlation(axis, lags) ** 2).sum()  # correlated samples count for fewer
        error = np.sqrt(2 * factor / count)
        assert (gusts[:, axis] ** 2).mean() / deviations[axis] ** 2 == pytest.approx(1, abs=4.5 * error)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_correlation_in_time_is_the_model_s(seed):
    step, count = 0.25, 400_000
    gusts = dryden_gusts(count * step, step, **CASE, rng=seed)
    lengths, deviations = dryden_parameters(**WHERE)
    for axis in range(3):
        scale = lengths[axis] / 8.0
        for lag in (0.5, 1.0, 2.0):
            shift = round(lag * scale / step)
            found = (gusts[shift:, axis] * gusts[:-shift, axis]).mean() / deviations[axis] ** 2
            error = np.sqrt(4 * scale / (count * step))  # a bound: independent stretches of about two time scales
            assert found == pytest.approx(correlation(axis, shift * step / scale), abs=4.5 * error)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_increments_show_the_time_scale(seed):
    """Mean square of the change over a step is 2σ²(1 − correlation): the time scale to a fraction of a per cent."""
    step, count = 0.5, 400_000
    changes = np.diff(dryden_gusts(count * step, step, **CASE, rng=seed), axis=0)
    lengths, deviations = dryden_parameters(**WHERE)
    for axis in range(3):
        expected = 2 * deviations[axis] ** 2 * (1 - correlation(axis, step * 8.0 / lengths[axis]))
        assert (changes[:, axis] ** 2).mean() / expected == pytest.approx(1, abs=4.5 * np.sqrt(2 / count) * 1.2)


def test_gusts_along_across_and_vertical_are_independent():
    gusts = dryden_gusts(40_000 * 60.0, 60.0, **CASE, rng=5)  # a minute apart: independent in time as well
    assert np.abs(np.corrcoef(gusts.T) - np.eye(3)).max() < 4.5 / np.sqrt(40_000)


def test_first_sample_is_as_strong_as_any():
    first = np.array([dryden_gusts(0.2, 0.1, **CASE, rng=seed)[0] for seed in range(2000)])
    for axis, deviation in enumerate(dryden_parameters(**WHERE).deviations):
        assert kstest(first[:, axis] / deviation, "norm").pvalue > 1e-4


def test_same_seed_same_gusts():
    one = dryden_gusts(10, 0.1, **CASE, rng=7)
    assert one.shape == (100, 3)
    assert (one == dryden_gusts(10, 0.1, **CASE, rng=np.random.default_rng(7))).all()
    assert (one != dryden_gusts(10, 0.1, **CASE, rng=8)).all()


def test_no_wind_no_gusts():
    assert (dryden_gusts(10, 0.1, 8.0, 30.0, 0.0, 1) == 0).all()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"altitude": 305.0}, "altitude must be from 3.048 to 304.8 m, the low-altitude range of MIL-F-8785C, got 305"),
        ({"altitude": 3.0}, "altitude must be from 3.048 to 304.8 m"),
        ({"altitude": np.nan}, "altitude must be .* got nan"),
        ({"wind_at_6m": -1.0}, "wind_at_6m must be finite and at least 0, got -1"),
        ({"air_speed": 0.0}, "air_speed is 0: frozen turbulence .* in hover give the mean wind"),
        ({"air_speed": -5.0}, "air_speed must be finite and above 0, got -5"),
        ({"air_speed": np.inf}, "air_speed must be finite and above 0, got inf"),
        ({"duration": 0.0}, "duration must be finite and above 0, got 0"),
        ({"time_step": -0.1}, "time_step must be finite and above 0, got -0.1"),
        ({"time_step": 11.0}, "time_step 11 s is longer than the duration of 10 s"),
    ],
)
def test_wrong_turbulence_is_refused(change, words):
    with pytest.raises(ValueError, match=words):
        dryden_gusts(**({"duration": 10.0, "time_step": 0.1, "rng": 1} | CASE | change))
    if not {"duration", "time_step"} & set(change):
        with pytest.raises(ValueError, match=words):
            dryden_spectrum(1.0, **(CASE | change))


def test_negative_frequencies_are_refused():
    with pytest.raises(ValueError, match="omega must be finite and at least 0, got -1"):
        dryden_spectrum([1.0, -1.0], **CASE)
