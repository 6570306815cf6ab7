"""Gusts: Dryden turbulence after MIL-F-8785C at low altitude.

The model freezes the turbulence: a field of gusts that doesn't change, through which the UAV flies with its air speed
V. What is long in space (scale lengths) so becomes slow in time, and the gusts along, across and vertical each have a
spectrum that a filter of first or second order makes from white noise. Here the filters are run exactly: the samples
have the model's own covariance at any time step, from the first one on.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.special import gammainc

from uavlab import checks

FOOT = 0.3048
"""[m]"""

LOWEST, HIGHEST = 10 * FOOT, 1000 * FOOT
"""Altitudes between which the low-altitude model holds [m]."""

OUTPUT = np.array([[np.sqrt(2.0), 0.0], [np.sqrt(3.0), 1.0 - np.sqrt(3.0)], [np.sqrt(3.0), 1.0 - np.sqrt(3.0)]])
"""Gust along, across and vertical from the two lags, in units of its standard deviation."""

STATIONARY = np.array([[0.5, 0.25], [0.25, 0.25]])
"""Covariance of two lags in a row when they have run for ever, x₁' = −x₁ + white noise and x₂' = x₁ − x₂, with the
time in units of the time scale L/V."""


class DrydenParameters(NamedTuple):
    """Scale lengths [m] and standard deviations [m/s] of the gusts along, across and vertical, each (3,).

    See Also
    --------
    dryden_parameters : from the height and the wind.

    Examples
    --------
    >>> from uavlab.weather import dryden_parameters
    >>> dryden_parameters(altitude=30.0, wind_at_6m=7.7)
    <DrydenParameters: scale lengths 152.46, 152.46, 30.00 m, deviations 1.32, 1.32, 0.77 m/s>
    """

    scale_lengths: np.ndarray
    deviations: np.ndarray

    def __repr__(self) -> str:
        lengths, deviations = (", ".join(f"{value:.2f}" for value in axes) for axes in self)
        return f"<DrydenParameters: scale lengths {lengths} m, deviations {deviations} m/s>"


def dryden_parameters(altitude: float, wind_at_6m: float) -> DrydenParameters:
    """How long and how strong gusts are near the ground, MIL-F-8785C 3.7.3.

    With the altitude h in feet: L_w = h, L_u = L_v = h/(0.177 + 0.000823 h)^1.2, σ_w = 0.1 W20,
    σ_u = σ_v = σ_w/(0.177 + 0.000823 h)^0.4.

    Parameters
    ----------
    altitude : float
        Height above the ground h [m], 3.048 to 304.8 (10 to 1000 ft).
    wind_at_6m : float
        Mean wind W20 at 20 ft (6.1 m) above the ground [m/s], at least 0; 7.7 is light, 15 moderate, 23 severe.

    Returns
    -------
    DrydenParameters
        Scale lengths L_u, L_v, L_w [m] and standard deviations σ_u, σ_v, σ_w [m/s].

    Raises
    ------
    ValueError
        If `altitude` is not within 3.048 to 304.8, or `wind_at_6m` is negative.

    See Also
    --------
    dryden_spectrum : how such gusts are spread over frequencies.
    dryden_gusts : samples of them.

    References
    ----------
    MIL-F-8785C, Flying Qualities of Piloted Airplanes, US Department of Defense, 1980.

    Examples
    --------
    >>> from uavlab.weather import dryden_parameters
    >>> low, high = (dryden_parameters(altitude, wind_at_6m=10.0) for altitude in (10.0, 100.0))
    >>> f"σ along {low.deviations[0]:.2f} m/s at 10 m, {high.deviations[0]:.2f} m/s at 100 m"
    'σ along 1.89 m/s at 10 m, 1.38 m/s at 100 m'
    """
    metres = "m, the low-altitude range of MIL-F-8785C"
    altitude = checks.number("altitude", altitude, checks.within, LOWEST, HIGHEST, metres)
    wind_at_6m = checks.not_negative_number("wind_at_6m", wind_at_6m)
    feet = altitude / FOOT
    shape = 0.177 + 0.000823 * feet
    horizontal = altitude / shape**1.2
    return DrydenParameters(
        np.array([horizontal, horizontal, altitude]),
        0.1 * wind_at_6m * np.array([shape**-0.4, shape**-0.4, 1.0]),
    )


def dryden_spectrum(omega: npt.ArrayLike, air_speed: float, altitude: float, wind_at_6m: float) -> np.ndarray:
    """Spectral density of the gusts that a UAV meets, MIL-F-8785C 3.7.1.2.

    Along 2σ²τ/π / (1 + (τω)²), across and vertical σ²τ/π · (1 + 3(τω)²)/(1 + (τω)²)², with the time scale τ = L/V.
    One-sided: the integral over ω from 0 to infinity is σ².

    Parameters
    ----------
    omega : (...) array
        Angular frequency ω [rad/s], at least 0.
    air_speed : float
        Speed V through the air [m/s], above 0.
    altitude, wind_at_6m : float
        As for `dryden_parameters`.

    Returns
    -------
    (..., 3) array
        Density along, across and vertical [m²/s² per rad/s].

    Raises
    ------
    ValueError
        If `omega` or `wind_at_6m` is negative, `altitude` is not within 3.048 to 304.8, or `air_speed` is not above 0;
        for hovering see `dryden_gusts`.

    See Also
    --------
    dryden_gusts : gusts with this spectrum.
    gust_spectrum : that of any wind.

    References
    ----------
    MIL-F-8785C, Flying Qualities of Piloted Airplanes, US Department of Defense, 1980.

    Examples
    --------
    >>> import numpy as np
    >>> from uavlab.weather import dryden_parameters, dryden_spectrum
    >>> omega = np.linspace(0.0, 300.0, 300_001)
    >>> density = dryden_spectrum(omega, air_speed=10.0, altitude=30.0, wind_at_6m=10.0)
    >>> variance = np.trapezoid(density, omega, axis=0)
    >>> (variance / dryden_parameters(30.0, 10.0).deviations ** 2).round(2)
    array([1., 1., 1.])
    """
    checks.not_negative("omega", omega)
    scale, deviations = time_scales(air_speed, altitude, wind_at_6m)
    square = (scale * np.asarray(omega, dtype=float)[..., None]) ** 2
    along = 2.0 / (1.0 + square[..., :1])
    others = (1.0 + 3.0 * square[..., 1:]) / (1.0 + square[..., 1:]) ** 2
    return deviations**2 * scale / np.pi * np.concatenate([along, others], axis=-1)


def dryden_gusts(
    duration: float,
    time_step: float,
    air_speed: float,
    altitude: float,
    wind_at_6m: float,
    rng: np.random.Generator | int,
) -> np.ndarray:
    """Gusts that a UAV meets, to be added to the mean wind.

    Two lags per axis with the time scale τ = L/V, driven by white noise and read out so that the spectrum is that of
    `dryden_spectrum`. They start in their stationary distribution and are stepped exactly (`lag_step`), so that no
    time step is too long and none falsifies the variance.

    Parameters
    ----------
    duration : float
        How long [s], above 0.
    time_step : float
        Between samples [s], above 0 and at most the duration; 0.01 to 0.1 to see every gust.
    air_speed : float
        Speed V through the air [m/s], above 0. When the UAV hovers, the wind carries the gusts past it: V is then the
        mean wind.
    altitude : float
        Height above the ground [m], 3.048 to 304.8.
    wind_at_6m : float
        Mean wind at 20 ft (6.1 m) above the ground [m/s], at least 0.
    rng : numpy.random.Generator or int
        Where the noise comes from; a seed makes it repeatable.

    Returns
    -------
    (N, 3) array
        Gusts along, across and vertical [m/s]; N = duration / time_step, rounded, the first at time 0.

    Raises
    ------
    ValueError
        If `duration`, `time_step` or `air_speed` is not above 0, `time_step` is longer than `duration` or leaves more
        than 1,000,000,000 samples, `altitude` is not within 3.048 to 304.8, `wind_at_6m` is negative, or `rng` is
        neither a generator nor a seed.

    See Also
    --------
    dryden_spectrum : their spectrum.
    Wind : takes them along on a flight, `Wind(mean, gusts="dryden")`.

    References
    ----------
    MIL-F-8785C, Flying Qualities of Piloted Airplanes, US Department of Defense, 1980.

    Examples
    --------
    >>> from uavlab.weather import dryden_gusts, dryden_parameters
    >>> gusts = dryden_gusts(3600.0, 0.1, air_speed=10.0, altitude=30.0, wind_at_6m=10.0, rng=0)
    >>> gusts.shape
    (36000, 3)
    >>> gusts.std(axis=0).round(1)
    array([1.7, 1.7, 1. ])
    >>> dryden_parameters(30.0, 10.0).deviations.round(1)
    array([1.7, 1.7, 1. ])
    """
    duration = checks.positive_number("duration", duration)
    time_step = checks.positive_number("time_step", time_step)
    if time_step > duration:
        raise ValueError(f"time_step {time_step:g} s is longer than the duration of {duration:g} s")
    if duration / time_step > checks.MOST:
        raise ValueError(f"time_step must leave at most {checks.MOST:,} samples in {duration:g} s, got {time_step:g}")
    scales, deviations = time_scales(air_speed, altitude, wind_at_6m)
    noise = checks.generator("rng", rng).standard_normal((3, round(duration / time_step), 2))
    gusts = [
        two_lags(normal, time_step / scale) @ output
        for normal, scale, output in zip(noise, scales, OUTPUT, strict=True)
    ]
    return deviations * np.stack(gusts, axis=1)


def time_scales(air_speed: float, altitude: float, wind_at_6m: float) -> tuple[np.ndarray, np.ndarray]:
    """Time scales L/V [s] and standard deviations [m/s] along, across and vertical."""
    air_speed = checks.number("air_speed", air_speed)
    if air_speed == 0:
        raise ValueError(
            "air_speed is 0: frozen turbulence doesn't move past a UAV that rests in the air; "
            "in hover give the mean wind, which carries it past"
        )
    checks.positive_number("air_speed", air_speed)
    lengths, deviations = dryden_parameters(altitude, wind_at_6m)
    return lengths / air_speed, deviations


def two_lags(normal: np.ndarray, step: float) -> np.ndarray:
    """States (N, 2) of the two lags, made from standard normal numbers (N, 2), a step (in time scales) apart."""
    from scipy.signal import lfilter

    transition, covariance = lag_step(step)
    driven = normal @ np.linalg.cholesky(covariance).T
    driven[0] = np.linalg.cholesky(STATIONARY) @ normal[0]
    recursion = [1.0, -transition[0, 0]]  # the same for both: two equal lags
    first = lfilter([1.0], recursion, driven[:, 0])
    driven[1:, 1] += transition[1, 0] * first[:-1]
    return np.stack([first, lfilter([1.0], recursion, driven[:, 1])], axis=1)


def lag_step(step: float) -> tuple[np.ndarray, np.ndarray]:
    """How the two lags go on over a step h (in time scales): transition matrix, covariance of the noise that enters.

    What enters the first lag is e⁻ˢ of itself a time s later, and s e⁻ˢ in the second. The covariance is the integral
    of their products over the step, ∫ sⁿ e⁻²ˢ ds = n!/2ⁿ⁺¹ · P(n + 1, 2h), P the regularised incomplete gamma function.
    """
    transition = np.exp(-step) * np.array([[1.0, 0.0], [step, 1.0]])
    one, two, three = gammainc([1, 2, 3], 2.0 * step)
    return transition, np.array([[2.0 * one, two], [two, three]]) / 4.0
