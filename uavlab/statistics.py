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
        If there are no trials, or more events than trials.
    """
    from scipy.stats import beta

    checks.whole("total", total, least=1)
    checks.whole("count", count, least=0)
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
        If there are no groups, or a count isn't a whole number from 0 to `trials`.
    """
    checks.whole("trials", trials, least=1)
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
    """Below what a share of the mass (V,) between ascending edges (V + 1,) lies."""
    return float(np.interp(share, np.append(0.0, np.cumsum(mass) / mass.sum()), edges))


def likely_means(events: np.ndarray, trials: int) -> tuple[np.ndarray, np.ndarray]:
    """Edges (V + 1,) between means m of groups' shares, ascending, and the likelihood of each given the events (M,)."""
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
    """95 % interval of a statistic of values (M, S), by resampling the maps (bootstrap)."""
    rng = np.random.default_rng(0)
    drawn = values[rng.integers(len(values), size=(RESAMPLES, len(values)))]
    low, high = np.quantile(statistic(drawn.reshape(RESAMPLES, -1), axis=1), [0.025, 0.975], method="nearest")
    return float(low), float(high)


def share_over_maps(values: np.ndarray) -> tuple[float, float]:
    """95 % interval of a share, from values (M, S) between 0 and 1 on M maps.

    By resampling the maps; where all maps agree, so that this says nothing, that of as many independent trials as there
    are maps: 12 of 12 is [74 %, 100 %].
    """
    low, high = over_maps(np.mean, values)
    exact = share_interval(round(float(values.mean()) * len(values)), len(values))
    return (low, high) if low < high else (min(low, exact[0]), max(high, exact[1]))
