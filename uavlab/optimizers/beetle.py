"""Beetle antennae search (PSO-BAS Eqs 17-21): a beetle smells to both sides, and walks towards the better one.

Two evaluations tell it which of two sides is better, a third what it finds there. It walks even where that makes things
worse; and antennae and step shrink by a factor each time, so that it comes about δ0/(1 − η) far, whatever the function.
A greedy beetle goes to the better tip of its antennae if it is better there than here, else stays; its antennae
may follow success, not the clock.
"""

from __future__ import annotations

from typing import NamedTuple

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

ANTENNA = 0.3
"""d0 and δ0 as a share of the range; the paper gives neither."""

DECAY = 0.95
"""η_d and η_δ (PSO-BAS Table 3)."""

LONGER, SHORTER, SHORTEST = 1.5, 0.87, 1e-9
"""How antennae that follow success change after a gain and after none: lasting where one probe in four gains."""


def bas(
    f: Function,
    bounds: npt.ArrayLike,
    budget: int,
    rng: np.random.Generator | int,
    *,
    antenna: float = ANTENNA,
    decay: float | None = DECAY,
    greedy: bool = False,
    block: int | None = None,
    start: npt.ArrayLike | None = None,
    target: float | None = None,
    as_printed: bool = False,
) -> Result:
    """Minimise a function with one beetle.

    x ← x − δ b sign(f(x + d b) − f(x − d b)), d ← η d, δ ← η δ, with a random direction b.

    Parameters
    ----------
    f, bounds, budget, rng, target
        As for `pso`; the budget covers the first point and one step, 4 evaluations, or 3 if greedy.
    antenna : float
        First length of antennae and step, d0 = δ0, as a share of the range of each coordinate, above 0. d reaches from
        the body to one tip (Eq. 18); the paper calls it the distance between the tips.
    decay : float, optional
        η per step, above 0 and at most 1. None, for a greedy beetle: antennae grow by half after a gain and shrink to
        0.87 after none, along each block on their own.
    greedy : bool
        Go to the better tip if f is less there than here, else stay: two evaluations per step, not three.
    block : int, optional
        Probe along so many neighbouring coordinates at a time, such as the 3 of one waypoint; all by default.
    start : (D,) or (1, D) array, optional
        Where the beetle begins; else anywhere within the bounds.
    as_printed : bool
        Directions drawn from a cube (Eq. 17), which prefer its corners; else from a Gaussian, even on the sphere.

    Returns
    -------
    Result
        Its `swarm` is the one point where the beetle ended; `best` is the best that it smelled or found.

    Raises
    ------
    ValueError
        If `bounds` haven't shape (D, 2), are reversed or not finite. If `budget` is below 4, or 3 if greedy. If
        `antenna` is not above 0. If `decay` is not above 0 and at most 1, or None without `greedy`. If `block` doesn't
        divide the coordinates. If `start` lies outside of the bounds. If `target` is not finite. If `rng` is no
        generator and no seed. If `f` is no function, or doesn't return one value per point. If `greedy` or `as_printed`
        is neither True nor False.

    See Also
    --------
    pso : A swarm without antennae.
    pso_bas : A swarm with antennae.

    References
    ----------
    Jiang and Li, BAS: Beetle antennae search algorithm for optimization problems, 2017.

    Examples
    --------
    >>> from uavlab.optimizers import bas
    >>> def sphere(points):
    ...     return (points**2).sum(axis=1)
    >>> walks = bas(sphere, [(-5, 5)] * 3, budget=400, rng=1)
    >>> stays = bas(sphere, [(-5, 5)] * 3, budget=400, rng=1, greedy=True, decay=None)
    >>> stays.value < walks.value < 1.0
    True
    """
    rng = checks.generator("rng", rng)
    as_printed, greedy = checks.flag("as_printed", as_printed), checks.flag("greedy", greedy)
    if decay is None and not greedy:
        raise ValueError("decay must be a number unless greedy: a beetle that walks either way has no gain to follow")
    antennae = antennae_of(bounds, antenna, decay, block, as_printed)
    count = Counter(
        f, len(antennae.low), checked_budget(budget, 3 if greedy else 4, "the first point and one step"), target
    )
    x = first_points(start, antennae.low, antennae.high, 1, rng)
    length = first_lengths(antennae, 1)
    value = count(x)
    count.end_iteration()
    while not count.over:
        if greedy:
            improve(antennae, length, count, x, value, rng)
        else:
            x = walked(antennae, length, count, x, rng)
            value = count(x)
        count.end_iteration()
    return count.result(x, value)


class Antennae(NamedTuple):
    """What the beetles of a search have in common."""

    low: np.ndarray
    high: np.ndarray
    longest: float  # a share of the range, as all lengths
    decay: float | None
    block: int
    from_cube: bool


def antennae_of(
    bounds: npt.ArrayLike, antenna: float, decay: float | None, block: int | None, from_cube: bool
) -> Antennae:
    low, high = checked_bounds(bounds)
    block = checks.whole("block", len(low) if block is None else block, least=1)
    if len(low) % block:
        raise ValueError(f"block must divide the {len(low)} coordinates, got {block}")
    if decay is not None and not 0 < (decay := checks.number("decay", decay)) <= 1:
        raise ValueError(f"decay must be above 0 and at most 1, or None, got {decay!r}")
    return Antennae(low, high, checks.positive_number("antenna", antenna), decay, block, from_cube)


def first_lengths(antennae: Antennae, beetles: int) -> np.ndarray:
    """Length of each beetle's antennae along each block of coordinates, (N, blocks)."""
    return np.full((beetles, len(antennae.low) // antennae.block), antennae.longest)


def smell(antennae, length, count, x, rng):
    """Which blocks the beetles at x (N, D) probe, a step along their antennae (N, D), both tips, and f there (2, N)."""
    beetles, blocks = length.shape
    size = (beetles, antennae.block)
    drawn = rng.uniform(-1, 1, size) if antennae.from_cube else rng.standard_normal(size)
    where = np.arange(beetles), rng.integers(blocks, size=beetles)
    step = np.zeros((beetles, blocks, antennae.block))
    step[where] = drawn * (length[where] / np.linalg.norm(drawn, axis=1))[:, None]
    step = step.reshape(x.shape) * (antennae.high - antennae.low)
    tips = np.clip(np.stack([x + step, x - step]), antennae.low, antennae.high)
    return where, step, tips, count(tips.reshape(-1, x.shape[1])).reshape(2, -1)


def walked(antennae, length, count, x, rng):
    """Where the beetles walk to (Eq. 19), for better or worse; nowhere if both sides smell the same."""
    _, step, _, smells = smell(antennae, length, count, x, rng)
    side = (smells[1] > smells[0]).astype(int) - (smells[1] < smells[0])
    length *= antennae.decay
    return np.clip(x + step * side[:, None], antennae.low, antennae.high)


def improve(antennae, length, count, x, value, rng):
    """Move each beetle to the better tip of its antennae if f is less there, in place."""
    where, _, tips, smells = smell(antennae, length, count, x, rng)
    gained = keep_better(x, value, tips[smells.argmin(axis=0), np.arange(len(x))], smells.min(axis=0))
    if antennae.decay is None:
        changed = length[where] * np.where(gained, LONGER, SHORTER)
        length[where] = np.clip(changed, SHORTEST, antennae.longest)
    else:
        length *= antennae.decay
