"""What the optimisers share: a function that counts its calls, questions asked well, and the result."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from uavlab import checks

Function = Callable[[np.ndarray], npt.ArrayLike]
"""Takes points (N, D), returns their values (N,)."""


@dataclass(frozen=True, eq=False)
class Result:
    """The best that was found, and how the search went.

    Attributes
    ----------
    best : (D,) array
        The point of least value; NaN if no evaluation gave a number.
    value : float
        f there; infinite if no evaluation gave a number.
    history : (E,) array
        Least value after each evaluation of f.
    iterations : (I,) int array
        How many evaluations had been made at the end of each iteration.
    not_a_number : int
        How often f returned NaN; it counted as worst.
    swarm : (N, D) array
        The best of each particle, best first; for a beetle that walks, where it ended.

    See Also
    --------
    pso, bas, pso_bas : Return it.

    Examples
    --------
    >>> from uavlab.optimizers import pso
    >>> def sphere(points):
    ...     return (points**2).sum(axis=1)
    >>> found = pso(sphere, [(-5, 5)] * 3, budget=100, rng=1)
    >>> found.iterations  # evaluations made: 20 particles at a time
    array([ 20,  40,  60,  80, 100])
    >>> bool(found.history[-1] == found.value)
    True
    """

    best: np.ndarray
    value: float
    history: np.ndarray
    iterations: np.ndarray
    not_a_number: int
    swarm: np.ndarray

    def __repr__(self) -> str:
        nan = f", {self.not_a_number} of them NaN" if self.not_a_number else ""
        return f"<Result: {self.value:g} after {len(self.history)} evaluations{nan}>"


class Counter:
    """f with a budget: it evaluates points, remembers the best, and counts NaN as worst.

    It is over when the budget is spent, or the best is at most the target.
    """

    def __init__(self, f: Function, dimensions: int, budget: int, target: float | None = None) -> None:
        if target is not None:
            target = checks.number("target", target, checks.finite)
        self.f = checks.function("f", f, "f(points)")
        self.target = -np.inf if target is None else target
        self.left = budget
        self.best = np.full(dimensions, np.nan)
        self.value = np.inf
        self.not_a_number = 0
        self.histories: list[np.ndarray] = []
        self.iterations: list[int] = []
        self.made = 0

    def __call__(self, points: np.ndarray) -> np.ndarray:
        """Values (N,) of points (N, D); those beyond the budget are not evaluated, and infinite."""
        values = np.full(len(points), np.inf)
        asked = points[: self.left]
        if len(asked) == 0:
            return values
        given = np.array(checks.numbers("what f returns", self.f(asked.copy())))  # it may keep both, or change them
        if given.shape != (len(asked),):
            raise ValueError(
                f"f must return one value per point: for {asked.shape} shape ({len(asked)},), got {given.shape}; "
                "a function of one point: lambda points: np.array([f(point) for point in points])"
            )
        nan = np.isnan(given)
        if nan.any():
            self.not_a_number += int(nan.sum())
            given[nan] = np.inf
        self.histories.append(given)
        self.made += len(asked)
        self.left -= len(asked)
        least = given.argmin()
        if given[least] < self.value:
            self.value, self.best = float(given[least]), asked[least].copy()
        values[: len(asked)] = given
        return values

    @property
    def over(self) -> bool:
        return self.left <= 0 or self.value <= self.target

    def end_iteration(self) -> None:
        self.iterations.append(self.made)

    def result(self, swarm: np.ndarray, values: np.ndarray) -> Result:
        """What was found; the swarm (N, D) with its values (N,) is put in order."""
        history, ends = np.minimum.accumulate(np.concatenate(self.histories)), np.array(self.iterations)
        return Result(self.best, self.value, history, ends, self.not_a_number, swarm[np.argsort(values)])


def checked_bounds(bounds: npt.ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper bounds (D,) from an array (D, 2)."""
    box = checks.numbers("bounds", bounds)
    if box.ndim != 2 or box.shape[1] != 2 or len(box) == 0:
        raise ValueError(f"bounds must have shape (D, 2), lower and upper for each coordinate, got {box.shape}")
    wrong = np.flatnonzero(~np.isfinite(box).all(axis=1))
    if len(wrong):
        raise ValueError(f"bounds must be finite, for points are drawn within them: {box[wrong[0]]} at {wrong[0]}")
    wrong = np.flatnonzero(box[:, 0] >= box[:, 1])
    if len(wrong):
        raise ValueError(f"bounds must be (lower, upper): {box[wrong[0]]} at {wrong[0]} is reversed or empty")
    return box[:, 0].copy(), box[:, 1].copy()


def first_points(
    start: npt.ArrayLike | None, low: np.ndarray, high: np.ndarray, count: int, rng: np.random.Generator
) -> np.ndarray:
    """`count` points (count, D): those given, then some drawn evenly within the bounds."""
    drawn = rng.uniform(low, high, (count, len(low)))
    if start is None:
        return drawn
    given = np.atleast_2d(checks.numbers("start", start))
    if given.ndim != 2 or given.shape[1] != len(low):
        raise ValueError(f"start must have shape (M, {len(low)}), one row per point, got {np.shape(start)}")
    if len(given) > count:
        raise ValueError(f"start has {len(given)} points, there is room for {count}: give the best of them")
    outside = ~((given >= low) & (given <= high)).all(axis=1)  # NaN is outside too
    if outside.any():
        row = int(outside.argmax())
        raise ValueError(f"start must lie within the bounds, its row {row} doesn't: {given[row]}")
    drawn[: len(given)] = given
    return drawn


def checked_budget(budget: int, least: int, what: str) -> int:
    checks.whole("budget", budget, least=1)
    if budget < least:
        raise ValueError(f"budget must be at least {least}, {what}, got {budget}")
    return int(budget)


def keep_better(best: np.ndarray, value: np.ndarray, found: np.ndarray, gained: np.ndarray) -> np.ndarray:
    """Replace in place what is known, (N, D) and (N,), where something better was found; and where that was."""
    better = gained < value
    np.copyto(best, found, where=better[:, None])
    np.copyto(value, gained, where=better)
    return better
