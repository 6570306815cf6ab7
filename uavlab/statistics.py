"""How sure a number is: intervals for shares, for rates of events in groups, and for statistics over maps.

Runs on one map, or flights of one route, resemble each other. Twenty flights of five routes say less than a hundred
flights of a hundred routes, and an interval that doesn't know that is too narrow.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.special import betaln

from uavlab import checks

RESAMPLES = 2000
"""Of maps, for intervals."""

LEAST_MEAN = 1e-7
"""From here to as near to 1 means of groups are looked at."""

MEANS, ALIKE = 120, 40
"""Of how many means below 0.1, up to 0.9 and beyond, and of how many ρ the likelihood of groups is computed."""


def share_interval(count: int, total: int) -> tuple[float, float]:
    """95 % interval of a share, exact for independent trials (Clopper and Pearson 1934).

    Parameters
    ----------
    count, total : int
        Events among trials; at least one trial.

    Returns
    -------
    (float, float)
        0 at the least where there were none, 1 at the most where there was nothing else; never of no width.

    Raises
    ------
    ValueError
        If `total` is no whole number of at least 1, or `count` is none from 0 to `total`.

    See Also
    --------
    grouped_share_interval : where trials come in groups that resemble each other.

    References
    ----------
    C. J. Clopper and E. S. Pearson, The Use of Confidence or Fiducial Limits Illustrated in the Case of the Binomial,
    Biometrika, 1934.

    Examples
    --------
    >>> from uavlab.statistics import share_interval
    >>> [round(end, 3) for end in share_interval(0, 100)]  # no crash in 100 flights
    [0.0, 0.036]
    >>> [round(end, 3) for end in share_interval(50, 100)]
    [0.398, 0.602]
    """
    from scipy.stats import beta

    total, count = checks.whole("total", total, least=1), checks.whole("count", count, least=0)
    if count > total:
        raise ValueError(f"count must be at most total = {total}, got {count}")
    low = float(beta.ppf(0.025, count, total - count + 1)) if count else 0.0
    high = float(beta.ppf(0.975, count + 1, total - count)) if count < total else 1.0
    return low, high


def grouped_share_interval(counts: npt.ArrayLike, trials: int) -> tuple[float, float]:
    """95 % interval of the mean share of events, over groups each of which has a share of its own.

    Shares of groups are Beta with mean m and variance ρ m (1 − m), so that counts are beta-binomial. √ρ is as likely a
    priori anywhere from 0 to 1; for the upper end m is, too, for the lower end log m, so that each end errs outwards.
    2.5 % of m given the counts lie beyond each end. It is never narrower than that of independent trials, nor than by
    resampling the groups, where their shares aren't Beta.

    Parameters
    ----------
    counts : (M,) array of int
        Events in each group.
    trials : int
        In each group, at least 1.

    Returns
    -------
    (float, float)
        From 0, where no group had an event, and to 1, where all had nothing else.

    Raises
    ------
    ValueError
        If `trials` is no whole number of at least 1, `counts` is not of shape (M,) with at least one group, or a count
        is no whole number from 0 to `trials`.

    See Also
    --------
    share_interval : for independent trials.
    share_over_maps : by resampling alone.

    References
    ----------
    J. G. Skellam, A Probability Distribution Derived from the Binomial Distribution by Regarding the Probability of
    Success as Variable between the Sets of Trials, Journal of the Royal Statistical Society B, 1948.

    Examples
    --------
    >>> from uavlab.statistics import grouped_share_interval, share_interval
    >>> [round(end, 2) for end in grouped_share_interval([20, 0, 0, 0, 0], trials=20)]  # all on one of five routes
    [0.0, 0.6]
    >>> [round(end, 2) for end in share_interval(20, 100)]
    [0.13, 0.29]
    """
    trials = checks.whole("trials", trials, least=1)
    events = checks.numbers("counts", counts)
    if events.ndim != 1 or not len(events):
        raise ValueError(f"counts must have shape (M,), with at least one group, got {events.shape}")
    checks.refuse(
        events, (events >= 0) & (events <= trials) & (events == np.round(events)),
        f"counts must be whole and from 0 to {trials}",
    )  # fmt: skip
    low, high = share_interval(int(events.sum()), trials * len(events))
    if len(events) == 1:
        return low, high
    edges, likelihood = likely_means(events, trials)
    even, even_in_log = np.diff(edges), np.diff(np.log(edges))
    least = 0.0 if low == 0 else quantile(0.025, edges, likelihood * even_in_log)
    most = 1.0 if high == 1 else quantile(0.975, edges, likelihood * even)
    drawn = over_maps(np.mean, events[:, None] / trials)
    return min(low, least, drawn[0]), max(high, most, drawn[1])


def quantile(share: float, edges: np.ndarray, mass: np.ndarray) -> float:
    """Below what a share of the mass (V,) between ascending edges (V + 1,) lies.

    Parameters
    ----------
    share : float
        0 to 1.
    edges : (V + 1,) array
        Ascending.
    mass : (V,) array
        Between the edges, at least 0; need not add up to 1.

    Returns
    -------
    float
        In the unit of the edges.

    See Also
    --------
    likely_means : edges and masses.

    Examples
    --------
    >>> import numpy as np
    >>> from uavlab.statistics import quantile
    >>> quantile(0.75, np.array([0.0, 1.0, 3.0]), np.array([2.0, 2.0]))
    2.0
    """
    return float(np.interp(share, np.append(0.0, np.cumsum(mass) / mass.sum()), edges))


def likely_means(events: np.ndarray, trials: int) -> tuple[np.ndarray, np.ndarray]:
    """Means m of groups' shares, and how likely each makes the events.

    L(m) = Σ_ρ Π_groups B(a + k, b + n − k)/B(a, b), a = m (1/ρ − 1), b = (1 − m)(1/ρ − 1), B the beta function

    Parameters
    ----------
    events : (M,) array
        k, events in each group.
    trials : int
        n in each group, at least 1.

    Returns
    -------
    edges : (V + 1,) array
        Between the means, ascending.
    likelihood : (V,) array
        Between the edges, not normalised.

    See Also
    --------
    grouped_share_interval : the interval that follows.

    Examples
    --------
    >>> import numpy as np
    >>> from uavlab.statistics import likely_means
    >>> edges, likelihood = likely_means(np.array([3.0, 2.0, 4.0, 3.0]), trials=10)
    >>> f"{edges[likelihood.argmax()]:.1f}"
    '0.3'
    """
    small = np.geomspace(LEAST_MEAN, 0.1, MEANS)
    edges = np.concatenate([small, np.linspace(0.1, 0.9, MEANS)[1:-1], 1 - small[::-1]])
    mean = ((edges[:-1] + edges[1:]) / 2)[:, None]
    alike = (((np.arange(ALIKE) + 0.5) / ALIKE) ** 2)[None, :]
    first, second = mean * (1 / alike - 1), (1 - mean) * (1 / alike - 1)
    likelihood = np.zeros(np.broadcast_shapes(mean.shape, alike.shape))
    for count, groups in zip(*np.unique(events, return_counts=True), strict=True):
        likelihood += groups * (betaln(first + count, second + trials - count) - betaln(first, second))
    return edges, np.exp(likelihood - likelihood.max()).sum(axis=1)


def over_maps(statistic: Callable[..., Any], values: np.ndarray) -> tuple[float, float]:
    """95 % interval of a statistic of values (M, S), by resampling the maps (bootstrap).

    Parameters
    ----------
    statistic : callable
        Of an array and an `axis`, as `numpy.mean` and `numpy.median`.
    values : (M, S) array
        S values on each of M maps; infinite ones are for medians.

    Returns
    -------
    (float, float)
        Of 2000 resamples, always the same ones.

    Raises
    ------
    ValueError
        If `values` is not of shape (M, S), empty or has NaN in it, or `statistic` is no function that returns a number
        for each row.

    See Also
    --------
    share_over_maps : for shares.

    References
    ----------
    B. Efron, Bootstrap Methods: Another Look at the Jackknife, The Annals of Statistics, 1979.

    Examples
    --------
    >>> import numpy as np
    >>> from uavlab.statistics import over_maps
    >>> lengths = np.repeat(np.arange(20.0, 40.0), 50).reshape(20, 50)  # 50 routes on each map are alike
    >>> [round(end) for end in over_maps(np.mean, lengths)]
    [27, 32]
    >>> [round(end) for end in over_maps(np.mean, lengths.reshape(1000, 1))]  # as if they were independent: too narrow
    [29, 30]
    """
    checks.function("statistic", statistic, "statistic(values, axis=1)")
    values = checks.array("values", values, None, None, finite=False)
    if values.size == 0 or np.isnan(values).any():
        raise ValueError(f"values must be numbers, at least one on each map, got {values!r:.60}")
    rng = np.random.default_rng(0)
    drawn = values[rng.integers(len(values), size=(RESAMPLES, len(values)))]
    found = statistic(drawn.reshape(RESAMPLES, -1), axis=1)
    found = checks.array("what statistic returns, for many rows,", found, RESAMPLES, finite=False)
    low, high = np.quantile(found, [0.025, 0.975], method="nearest")
    return float(low), float(high)


def share_over_maps(values: np.ndarray) -> tuple[float, float]:
    """95 % interval of a share, from values (M, S) between 0 and 1 on M maps.

    By resampling the maps; where all maps agree, so that this says nothing, that of as many independent trials as there
    are maps: 12 of 12 is [74 %, 100 %].

    Parameters
    ----------
    values : (M, S) array
        0 to 1, S on each of M maps.

    Returns
    -------
    (float, float)
        0 to 1.

    Raises
    ------
    ValueError
        If `values` is not of shape (M, S), empty, or has a value that is not within 0 to 1.

    See Also
    --------
    over_maps : for any statistic.
    share_interval : for independent trials.

    Examples
    --------
    >>> import numpy as np
    >>> from uavlab.statistics import share_over_maps
    >>> [round(end, 2) for end in share_over_maps(np.ones((12, 5)))]  # all reached on 12 maps
    [0.74, 1.0]
    """
    values = checks.array("values", values, None, None)
    checks.within("values", values, 0.0, 1.0, "(shares)")
    low, high = over_maps(np.mean, values)
    exact = share_interval(round(float(values.mean()) * len(values)), len(values))
    return (low, high) if low < high else (min(low, exact[0]), max(high, exact[1]))
