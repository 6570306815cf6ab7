"""Exposure: the longer a flight passes beside a wall, the likelier it touches it (Rice 1944)."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.special import log_ndtr

from uavlab import checks
from uavlab.compiled import compilable


def crossing_rate(margin: npt.ArrayLike, sigma: npt.ArrayLike, natural_frequency: float = 1.0) -> np.ndarray:
    """How often an offset crosses a boundary outwards, by Rice's formula.

    ν = (ω_n/2π) exp(−u²/2σ²)

    ω_n/2π stands for √(−R″(0)/R(0))/2π, R the autocorrelation. It equals that for a second-order system that white
    noise drives, at any damping; smoother gusts give less. An offset whose speed has no variance, such as an
    Ornstein-Uhlenbeck process, has no such rate: it crosses infinitely often.

    Parameters
    ----------
    margin : float or array
        From the mean offset to the boundary, u [m]; either sign.
    sigma : float or array
        σ of the offset on the axis towards the boundary [m], above 0.
    natural_frequency : float
        ω_n of the position control [rad/s], above 0; 1 throughout the course.

    Returns
    -------
    float or array
        ν [1/s].

    Raises
    ------
    ValueError
        If `margin` is not finite, or `sigma` or `natural_frequency` is not above 0.

    See Also
    --------
    collision_probability : the chance over a whole flight.

    References
    ----------
    S. O. Rice, Mathematical Analysis of Random Noise, Bell System Technical Journal, 1944 and 1945.

    Examples
    --------
    >>> from uavlab.offsets import crossing_rate
    >>> (3600 * crossing_rate([2.0, 3.0, 4.0], sigma=1.0)).round(1)  # an hour, at 2, 3 and 4σ
    array([77.5,  6.4,  0.2])
    """
    checks.finite("margin", margin)
    checks.positive("sigma", sigma)
    natural_frequency = checks.positive_number("natural_frequency", natural_frequency)
    return rate_at(np.asarray(margin, dtype=float), np.asarray(sigma, dtype=float), natural_frequency)


@compilable
def rate_at(margin, sigma, natural_frequency):
    """`crossing_rate` of arguments that are right."""
    return natural_frequency / (2 * np.pi) * np.exp(-0.5 * (margin / sigma) ** 2)


def collision_probability(
    distance: npt.ArrayLike,
    sigma: npt.ArrayLike,
    duration: npt.ArrayLike,
    natural_frequency: float = 1.0,
    *,
    uav_diameter: float = 0.0,
    mean_away: npt.ArrayLike = 0.0,
) -> np.ndarray:
    """Chance of touching a wall at least once while flying along it.

    P = 1 − q exp(−ν t/q),  q = Φ(u/σ),  u = distance − D_uav/2 + μ·n

    1 − q is the chance to be in the wall at the start, ν/q the rate of `crossing_rate` while not being there. It
    takes the offset for Gaussian, stationary and differentiable, and crossings for independent. They come in small
    groups, so the chance is overstated: by about a tenth for walls at 1 to 3σ and flights of 8 s. It is never above
    the strict bound (1 − q) + ν t.

    Parameters
    ----------
    distance : float or array
        From the route to the wall's surface [m], at least 0.
    sigma : float or array
        σ of the offset on the axis towards the wall [m], above 0.
    duration : float or array
        Time beside the wall t [s], at least 0.
    natural_frequency : float
        ω_n [rad/s], above 0.
    uav_diameter : float
        D_uav [m], at least 0.
    mean_away : float or array
        Mean offset away from the wall μ·n [m]; negative when the wind pushes towards it.

    Returns
    -------
    float or array
        P, 0 to 1.

    Raises
    ------
    ValueError
        If `distance`, `duration` or `uav_diameter` is negative, `sigma` or `natural_frequency` is not above 0, or
        `mean_away` is not finite.

    See Also
    --------
    crossing_rate : ν.
    offset_paths : paths to count touches on.

    References
    ----------
    S. O. Rice, Mathematical Analysis of Random Noise, Bell System Technical Journal, 1944 and 1945.

    Examples
    --------
    >>> from uavlab.offsets import collision_probability
    >>> collision_probability([3.0, 4.0, 5.0], sigma=1.0, duration=60.0, uav_diameter=1.0).round(4)
    array([0.3485, 0.0209, 0.0004])
    >>> collision_probability(4.0, sigma=1.0, duration=[0.0, 60.0, 600.0], uav_diameter=1.0).round(4)
    array([0.0002, 0.0209, 0.1887])
    """
    checks.not_negative("distance", distance)
    checks.positive("sigma", sigma)
    natural_frequency = checks.positive_number("natural_frequency", natural_frequency)
    checks.not_negative("duration", duration)
    uav_diameter = checks.not_negative_number("uav_diameter", uav_diameter)
    checks.finite("mean_away", mean_away)
    margin = np.asarray(distance, dtype=float) - uav_diameter / 2 + np.asarray(mean_away, dtype=float)
    z = margin / np.asarray(sigma, dtype=float)
    clear = log_ndtr(z)  # log q; rates and chances far in the tail would underflow
    rate = natural_frequency / (2 * np.pi) * np.exp(-0.5 * z**2 - clear)
    return -np.expm1(clear - np.asarray(duration, dtype=float) * rate)


def offset_paths(
    sigma: float,
    duration: float,
    rng: np.random.Generator | int,
    *,
    count: int = 1,
    step: float = 0.05,
    natural_frequency: float = 1.0,
    rough: bool = False,
) -> tuple[np.ndarray, np.ndarray]:
    """Offsets over time on one axis, of a position control that white noise shakes.

    x″ + 2 ω_n x′ + ω_n² x = noise: critically damped, R(τ) = σ² (1 + ω_n|τ|) exp(−ω_n|τ|). Each step is exact, so
    its size decides only how closely the path is looked at.

    Parameters
    ----------
    sigma : float
        σ of the offset [m], above 0; paths start in the stationary state.
    duration : float
        How long [s], at least one step.
    rng : numpy.random.Generator or int
        Or a seed.
    count : int
        Number of paths, at least 1.
    step : float
        Between looks [s], above 0.
    natural_frequency : float
        ω_n [rad/s], above 0.
    rough : bool
        An Ornstein-Uhlenbeck process instead, R(τ) = σ² exp(−ω_n|τ|/2): the same σ and correlation time 2/ω_n, but
        without a speed.

    Returns
    -------
    time : (T,) array
        [s], from 0 on.
    offset : (count, T) array
        [m].

    Raises
    ------
    ValueError
        If `sigma`, `step` or `natural_frequency` is not above 0, `duration` is less than `step`, not finite or more
        than 1,000,000,000 steps, `step` is below 0.0001/`natural_frequency`, `count` is no whole number of at least 1,
        `rough` is not True or False, or `rng` is neither a generator nor a seed.

    See Also
    --------
    collision_probability : the formula that such paths test.
    OffsetModel.sample : offsets that don't follow each other.

    References
    ----------
    G. E. Uhlenbeck and L. S. Ornstein, On the Theory of the Brownian Motion, Physical Review, 1930: the rough paths.

    Examples
    --------
    >>> from uavlab.offsets import offset_paths
    >>> time, offset = offset_paths(sigma=1.0, duration=30.0, rng=0, count=1000)
    >>> offset.shape
    (1000, 601)
    >>> f"{(offset > 2.0).mean():.1%} of the time beyond 2σ, {(offset > 2.0).any(axis=1).mean():.0%} of the paths ever"
    '2.3% of the time beyond 2σ, 46% of the paths ever'
    """
    sigma, step = checks.positive_number("sigma", sigma), checks.positive_number("step", step)
    natural_frequency = checks.positive_number("natural_frequency", natural_frequency)
    count, duration = checks.whole("count", count, 1), checks.number("duration", duration)
    if not step <= duration < np.inf:
        raise ValueError(f"duration must be finite and at least one step of {step:g} s, got {duration!r}")
    if duration / step > checks.MOST:
        raise ValueError(f"duration must be at most {checks.MOST:,} steps of {step:g} s, got {duration:g}")
    steps, turn = round(duration / step), natural_frequency * step
    if turn < 1e-4:
        raise ValueError(
            f"step must be at least 0.0001/natural_frequency for its noise to be told from 0, got {step:g}"
        )
    generator = checks.generator("rng", rng)
    if checks.flag("rough", rough):
        transition, stationary = np.array([[np.exp(-turn / 2)]]), np.eye(1)
    else:
        transition, stationary = spring_transition(turn), np.eye(2)
    noise = np.linalg.cholesky(stationary - transition @ transition.T)
    state = generator.standard_normal((len(stationary), count))
    offset = np.empty((steps + 1, count))
    offset[0] = state[0]
    for i in range(1, steps + 1):
        state = transition @ state + noise @ generator.standard_normal(state.shape)
        offset[i] = state[0]
    return step * np.arange(steps + 1), sigma * offset.T


def spring_transition(turn: float) -> np.ndarray:
    """Offset and speed (in units of σ and ω_n σ) a time of `turn`/ω_n later, when nothing shakes: (2, 2)."""
    return np.exp(-turn) * np.array([[1 + turn, turn], [-turn, 1 - turn]])
