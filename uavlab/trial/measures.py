"""From samples to a value with its interval."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from uavlab.statistics import over_maps, share_interval, share_over_maps
from uavlab.trial.judging import Measured


def exact(value: Any, sample: str = "computed exactly") -> Measured:
    """A value that no chance is in."""
    return Measured(float(value), float(value), float(value), sample)


def percent(events: Any, sample: str) -> Measured:
    """Share of True [%] among independent trials."""
    events = np.asarray(events, dtype=bool)
    low, high = share_interval(int(events.sum()), events.size)
    return Measured(100 * float(events.mean()), 100 * low, 100 * high, sample)


def fewer(ours: Any, theirs: Any, sample: str) -> Measured:
    """On how many of the pairs that differ [%] the first number is the lower one."""
    ours, theirs = np.asarray(ours), np.asarray(theirs)
    differ = ours != theirs
    if not differ.any():
        return Measured(50.0, 0.0, 100.0, f"none of {sample} differs")
    return percent((ours < theirs)[differ], f"of {differ.sum()} that differ, of {sample}")


def share_of_maps(values: Any, sample: str) -> Measured:
    """Mean [%] of values between 0 and 1, (maps, seeds); the interval is over maps."""
    low, high = share_over_maps(np.asarray(values, dtype=float))
    return Measured(100 * float(np.mean(values)), 100 * low, 100 * high, sample)


def wins(ours: Any, theirs: Any, sample: str) -> Measured:
    """In how many runs (maps, seeds) [%] the first number is the lower one, ties half."""
    return share_of_maps(np.where(np.equal(ours, theirs), 0.5, np.less(ours, theirs)), sample)


def statistic_of(values: Any, sample: str, statistic: Callable[..., Any] = np.mean) -> Measured:
    """A statistic of values (maps,) or (maps, seeds), by default their mean, by resampling the maps."""
    values = np.asarray(values, dtype=float)
    values = values.reshape(len(values), -1)
    value = float(statistic(values))
    low, high = over_maps(statistic, values)
    return Measured(value, min(low, value), max(high, value), sample)


def ratio_of_sums(values: np.ndarray, axis: int | None = None) -> Any:
    """Sum of each first value over that of each second one: pairs follow each other along the last axis."""
    both = values.reshape(-1, 2) if axis is None else values.reshape(len(values), -1, 2)
    sums = both.sum(axis=-2)
    return sums[..., 0] / sums[..., 1]
