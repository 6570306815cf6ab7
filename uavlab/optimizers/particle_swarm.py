"""Particle swarm optimisation (PSO-BAS Eqs 13-16): particles that remember their best and see the swarm's.

v ← ω v + c1 r1 (p_best − x) + c2 r2 (g_best − x), x ← x + v. Whether a particle comes to rest depends on ω, c1 and c2
(`stability`). With the printed ω = 1 none ever does. Here ω falls from 0.9 to 0.4: the swarm roams first and settles
later; and no step is longer than a fifth of the range.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.optimizers.result import (
    Counter,
    Function,
    Result,
    checked_bounds,
    checked_budget,
    first_points,
    keep_better,
)

SWARM, C1, C2 = 20, 1.5, 2.0
"""N, c1 and c2 (PSO-BAS Table 3)."""

INERTIA, PRINTED_INERTIA = (0.9, 0.4), (1.0, 1.0)
"""ω at the beginning and at the end: ours, and that of PSO-BAS Table 3."""

V_MAX = 0.2
"""Longest step on each coordinate, as a share of its range; the paper has none."""


def pso(
    f: Function,
    bounds: npt.ArrayLike,
    budget: int,
    rng: np.random.Generator | int,
    *,
    swarm: int = SWARM,
    inertia: Sequence[float] = INERTIA,
    c1: float = C1,
    c2: float = C2,
    v_max: float = V_MAX,
    start: npt.ArrayLike | None = None,
    target: float | None = None,
    as_printed: bool = False,
) -> Result:
    """Minimise a function with a particle swarm.

    v ← ω v + c1 r1 (p_best − x) + c2 r2 (g_best − x), x ← x + v, with r1 and r2 drawn from 0 to 1 for each coordinate.

    Parameters
    ----------
    f : callable
        Takes points (N, D), returns their values (N,). NaN counts as worst, and is counted.
    bounds : (D, 2) array
        Lower and upper bound of each coordinate. A particle that would leave them stops there.
    budget : int
        How often f may be evaluated; at least once per particle.
    rng : numpy.random.Generator or int
        Or a seed for one.
    swarm : int
        Particles N, at least 1; usual are 10 to 50.
    inertia : (2,) sequence
        ω at the beginning and at the end, falling evenly in between.
    c1, c2 : float
        Pulls of the particle's own best and of the swarm's, at least 0.
    v_max : float
        Longest step as a share of the range of each coordinate, above 0; infinite for no limit.
    start : (M, D) or (D,) array, optional
        First positions of M ≤ N particles; the others are drawn evenly within the bounds.
    target : float, optional
        Stop at the end of the iteration in which the best value is at most this, PSO-BAS's "accuracy standard" (4.3,
        step 6); by default only the budget ends the search.
    as_printed : bool
        ω = 1 throughout and no limit of the step, in place of `inertia` and `v_max`.

    Returns
    -------
    Result
        `best` and `value`, and how the search went.

    Raises
    ------
    ValueError
        If `bounds` haven't shape (D, 2), are reversed or not finite. If `budget` is below `swarm`, or `swarm` below 1.
        If `inertia` is not two finite numbers. If `c1` or `c2` is negative or not finite. If `v_max` is not above 0. If
        `start` lies outside of the bounds or has more than `swarm` rows. If `target` is not finite. If `rng` is no
        generator and no seed. If `f` is no function, or doesn't return one value per point. If `as_printed` is neither
        True nor False.

    See Also
    --------
    bas : One beetle instead of a swarm.
    pso_bas : A swarm whose particles have antennae.
    uavlab.planners.waypoint_swarm : Moves the waypoints of a route by one of them.

    References
    ----------
    - Kennedy and Eberhart, Particle swarm optimization, 1995.
    - Shi and Eberhart, A modified particle swarm optimizer, 1998: the inertia ω.

    Examples
    --------
    >>> from uavlab.optimizers import pso
    >>> def sphere(points):
    ...     return (points**2).sum(axis=1)
    >>> found = pso(sphere, [(-5, 5)] * 3, budget=2000, rng=1)
    >>> found.best.shape, found.value < 1e-3
    ((3,), True)
    >>> printed = pso(sphere, [(-5, 5)] * 3, budget=2000, rng=1, as_printed=True)
    >>> printed.value > 100 * found.value  # with ω = 1 no particle comes to rest
    True
    """
    rng = checks.generator("rng", rng)
    settings = swarm_settings(inertia, c1, c2, v_max, as_printed)
    low, high = checked_bounds(bounds)
    swarm = checks.whole("swarm", swarm, least=1)
    count = Counter(f, len(low), checked_budget(budget, swarm, "one swarm"), target)
    x = first_points(start, low, high, swarm, rng)
    velocity = np.zeros_like(x)
    best, value = x.copy(), count(x)
    count.end_iteration()
    while not count.over:
        x, velocity = flown(x, velocity, best, best[value.argmin()], low, high, settings, count.made / budget, rng)
        keep_better(best, value, x, count(x))
        count.end_iteration()
    return count.result(best, value)


def flown(x, velocity, best, leader, low, high, settings, used, rng):
    """Positions and velocities (N, D) after one step of Eq. 16, with the share `used` of the budget gone."""
    (first, last), c1, c2, v_max = settings
    r1, r2 = rng.random((2, *x.shape))
    inertia = first + (last - first) * used
    velocity = inertia * velocity + c1 * r1 * (best - x) + c2 * r2 * (leader - x)
    longest = v_max * (high - low)
    velocity = np.minimum(np.maximum(velocity, -longest), longest)  # numpy.clip takes twice as long
    moved = np.minimum(np.maximum(x + velocity, low), high)
    velocity *= (moved > low) & (moved < high)
    return moved, velocity


def swarm_settings(inertia, c1, c2, v_max, as_printed):
    """ω's ends, c1, c2 and v_max, checked."""
    checks.flag("as_printed", as_printed)
    ends = checks.numbers("inertia", PRINTED_INERTIA if as_printed else inertia)
    if ends.shape != (2,) or not np.isfinite(ends).all():
        raise ValueError(f"inertia must be two numbers, ω at the beginning and at the end, got {inertia!r}")
    c1, c2 = checks.not_negative_number("c1", c1), checks.not_negative_number("c2", c2)
    v_max = checks.number("v_max", v_max)
    if not v_max > 0:
        raise ValueError(f"v_max must be a share of the range, above 0, got {v_max!r}; infinite for no limit")
    return tuple(ends.tolist()), c1, c2, np.inf if as_printed else v_max


def stability(inertia: npt.ArrayLike, c1: npt.ArrayLike, c2: npt.ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """Factors by which a particle's mean and mean square shrink per step while both bests stand still at one point.

    With φ = c1 r1 + c2 r2 of mean φ̄ = (c1 + c2)/2 and variance (c1² + c2²)/12, the way from the best goes on as
    x_t+1 = (1 + ω − φ) x_t − ω x_t−1. The factors are the spectral radii of the recursions of E[x] and of E[x²]; below
    1 it comes to rest. The mean does within the triangle |ω| < 1, c1 + c2 < 4 (1 + ω); the variance only in a smaller
    region, for c1 = c2 where c1 + c2 < 24 (1 − ω²)/(7 − 5 ω) (Poli 2009).

    Parameters
    ----------
    inertia, c1, c2 : float or array
        ω, c1, c2, broadcast against each other.

    Returns
    -------
    mean, variance : arrays of their shape
        Factors per step, at least 0; below 1 it comes to rest.

    Raises
    ------
    ValueError
        If `inertia`, `c1` or `c2` is not finite.

    See Also
    --------
    uavlab.optimizers.pso : The swarm that they belong to.

    References
    ----------
    Poli, Mean and variance of the sampling distribution of particle swarm optimizers during stagnation, 2009.

    Examples
    --------
    >>> from uavlab.optimizers.particle_swarm import stability
    >>> mean, variance = stability(inertia=[0.4, 0.7, 1.0], c1=1.5, c2=2.0)
    >>> mean.round(2)  # at ω = 1 the mean only just does not come to rest
    array([0.63, 0.84, 1.  ])
    >>> variance.round(2)  # at ω = 0.7 the mean comes to rest, the spread does not
    array([0.77, 1.01, 1.3 ])
    """
    for name, value in (("inertia", inertia), ("c1", c1), ("c2", c2)):
        checks.finite(name, value)
    w, first, second = np.broadcast_arrays(*(np.asarray(value, dtype=float) for value in (inertia, c1, c2)))
    kept, spread = 1 + w - (first + second) / 2, (first**2 + second**2) / 12
    zero, one = np.zeros_like(w), np.ones_like(w)
    of_mean = np.array([[kept, -w], [one, zero]])
    of_square = np.array([[kept**2 + spread, -2 * w * kept, w**2], [kept, -w, zero], [one, zero, zero]])
    mean, variance = (
        np.abs(np.linalg.eigvals(np.moveaxis(step, (0, 1), (-2, -1)))).max(axis=-1) for step in (of_mean, of_square)
    )
    return mean, variance
