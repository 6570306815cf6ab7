"""PSO-BAS (PSO-BAS section 4.3): a particle swarm whose particles have antennae.

The paper's step 3, "update individual and global optimality through BAS", leaves open what the antennae probe. Around
each particle's best they are a local search, which can only improve it. At its present position they are one more
random step.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.optimizers.beetle import DECAY, antennae_of, first_lengths, improve, walked
from uavlab.optimizers.particle_swarm import C1, C2, INERTIA, SWARM, V_MAX, flown, swarm_settings
from uavlab.optimizers.result import Counter, Function, Result, checked_budget, first_points, keep_better

ANTENNA = 0.15
"""d0 as a share of the range: ours, for a swarm of greedy antennae."""


PRINTED_BLOCK = 3
"""m (PSO-BAS Table 3): the beetle's dimension, as its section 4.2 calls it; so that of one waypoint, not of all."""


def pso_bas(
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
    antennae: str = "best",
    antenna: float = ANTENNA,
    decay: float | None = None,
    probes: int = 3,
    block: int | None = None,
    start: npt.ArrayLike | None = None,
    target: float | None = None,
    as_printed: bool = False,
) -> Result:
    """Minimise a function with a particle swarm that probes to both sides.

    In each iteration every particle first probes with its antennae, greedily: it goes to the better tip if that is
    better. Then the swarm flies on (Eq. 16).

    x ← x ± d b, whichever tip is better and if it is better than x, with a random direction b; then as `pso`.

    Parameters
    ----------
    f, bounds, budget, rng, swarm, inertia, c1, c2, v_max, start, target
        As for `pso`.
    antennae : {"best", "current"}
        What they probe: the particle's best, or its present position.
    antenna : float
        First length of the antennae, d0, as a share of the range of each coordinate, above 0.
    decay : float, optional
        η per probe, above 0 and at most 1; by default the antennae follow success, as in `bas`.
    probes : int
        Pairs of evaluations per particle and iteration, at least 1.
    block : int, optional
        Probe along so many neighbouring coordinates at a time, such as the 3 of one waypoint; all by default, as
        printed 3, if they divide the coordinates: the beetle's m of PSO-BAS 4.2 and Table 3.
    as_printed : bool
        ω = 1 and no limit of the step; one probe, in a direction from a cube; the beetle then walks to the better
        side, better or not (Eq. 19); η = 0.95. In place of the parameters concerned.

    Returns
    -------
    Result
        `best` and `value`, and how the search went.

    Raises
    ------
    ValueError
        If `antennae` is unknown. If `antenna` is not above 0. If `decay` is not above 0 and at most 1. If `probes` is
        below 1. If `block` doesn't divide the coordinates. If `f`, `bounds`, `budget`, `rng`, `swarm`, `inertia`, `c1`,
        `c2`, `v_max`, `start`, `target` or `as_printed` is out of its range, see `pso`.

    See Also
    --------
    pso : The swarm without antennae.
    bas : The antennae without a swarm.

    Examples
    --------
    >>> from uavlab.optimizers import pso, pso_bas
    >>> def valley(points):  # Rosenbrock's, curved and flat at the bottom
    ...     return 100 * (points[:, 1] - points[:, 0] ** 2) ** 2 + (1 - points[:, 0]) ** 2
    >>> found = pso_bas(valley, [(-2, 2)] * 2, budget=2000, rng=1)
    >>> found.best.round(1), found.value < 1e-3
    (array([1., 1.]), True)
    """
    rng = checks.generator("rng", rng)
    settings = swarm_settings(inertia, c1, c2, v_max, as_printed)
    checks.one_of("antennae", antennae, ("best", "current"))
    probes, swarm = checks.whole("probes", probes, least=1), checks.whole("swarm", swarm, least=1)
    if as_printed:
        decay = DECAY
        if block is None and len(checks.numbers("bounds", bounds)) % PRINTED_BLOCK == 0:
            block = PRINTED_BLOCK
    feelers = antennae_of(bounds, antenna, decay, block, as_printed)
    low, high = feelers.low, feelers.high
    count = Counter(f, len(low), checked_budget(budget, swarm, "one swarm"), target)
    x = first_points(start, low, high, swarm, rng)
    velocity, length = np.zeros_like(x), first_lengths(feelers, swarm)
    now = count(x)
    best, value = x.copy(), now.copy()
    count.end_iteration()
    while not count.over:
        probed, smelled = (best, value) if antennae == "best" else (x, now)
        if as_printed:
            found = walked(feelers, length, count, probed, rng)
            smelled = count(found)
            if antennae == "current":
                x = found
            keep_better(best, value, found, smelled)
        else:
            for _ in range(probes):
                improve(feelers, length, count, probed, smelled, rng)
            keep_better(best, value, probed, smelled)
        x, velocity = flown(x, velocity, best, best[value.argmin()], low, high, settings, count.made / budget, rng)
        now = count(x)
        keep_better(best, value, x, now)
        count.end_iteration()
    return count.result(best, value)
