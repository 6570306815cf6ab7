"""The Pauta criterion: the radius that holds nearly all of what chance does, gross errors, and the distance to keep."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.special import erf, gammainc, gammaincinv

from uavlab import checks

PAUTA_COVERAGE = float(erf(3.0 / np.sqrt(2.0)))
"""Probability that a Gaussian offset on one axis lies within 3σ: 0.9973."""


def coverage(radius_in_sigma: npt.ArrayLike, dimensions: int) -> np.ndarray:
    """Probability that a Gaussian offset on several equal, independent axes lies within a radius of kσ.

    P(|x| ≤ kσ) = P(χ²_d ≤ k²); 1 − exp(−k²/2) in the plane.

    Parameters
    ----------
    radius_in_sigma : float or array
        k, at least 0.
    dimensions : int
        d, 1 to 3.

    Returns
    -------
    float or array
        The shape of k; for k = 3: 0.99730, 0.98889, 0.97071.

    Raises
    ------
    ValueError
        If `radius_in_sigma` is negative or not finite, or `dimensions` is not 1, 2 or 3.

    See Also
    --------
    pauta_radius : the inverse, from a share to a radius.

    Examples
    --------
    >>> from uavlab.offsets import coverage
    >>> [round(float(coverage(3.0, dimensions)), 4) for dimensions in (1, 2, 3)]
    [0.9973, 0.9889, 0.9707]
    """
    checks.not_negative("radius_in_sigma", radius_in_sigma)
    return gammainc(checked_dimensions(dimensions) / 2, 0.5 * np.asarray(radius_in_sigma, dtype=float) ** 2)


def pauta_radius(dimensions: int, coverage: float = PAUTA_COVERAGE) -> float:
    """How many σ a radius must have to hold a share of the offsets, in 1, 2 or 3 dimensions.

    k = √(χ²_d quantile of the coverage): the inverse of `coverage`. 3, 3.439 and 3.763 for the Pauta criterion.

    Parameters
    ----------
    dimensions : int
        d, 1 to 3.
    coverage : float
        Between 0 and 1; that of 3σ on one axis by default.

    Returns
    -------
    float
        k.

    Raises
    ------
    ValueError
        If `dimensions` is not 1, 2 or 3, or `coverage` is not between 0 and 1, without the ends.

    See Also
    --------
    coverage : the inverse, from a radius to a share.
    minimum_safe_distance : the distance to keep, with k of here times σ.

    Examples
    --------
    >>> from uavlab.offsets import pauta_radius
    >>> [round(pauta_radius(dimensions), 3) for dimensions in (1, 2, 3)]
    [3.0, 3.439, 3.763]
    """
    share = checks.number("coverage", coverage, checks.share)
    return float(np.sqrt(2 * gammaincinv(checked_dimensions(dimensions) / 2, share)))


class Filtered(NamedTuple):
    """What `pauta_filter` left: which samples it kept, their mean and σ [m], and in how many rounds it removed some.

    See Also
    --------
    pauta_filter : makes it.

    Examples
    --------
    >>> from uavlab.offsets import pauta_filter
    >>> filtered = pauta_filter([0.1, -0.2, 0.3, -0.1, 0.2, -0.3, 0.0, 0.1, -0.2, 0.2, -0.1, 0.3, 9.0])
    >>> filtered
    <Filtered: 12 of 13 samples kept, rounds: 1, mean 0.025 m, σ 0.205 m>
    >>> filtered.kept
    array([ True,  True,  True,  True,  True,  True,  True,  True,  True,
            True,  True,  True, False])
    """

    kept: np.ndarray
    mean: float
    sigma: float
    rounds: int

    def __repr__(self) -> str:
        counts = f"{self.kept.sum()} of {len(self.kept)} samples kept"
        return f"<Filtered: {counts}, rounds: {self.rounds}, mean {self.mean:.3f} m, σ {self.sigma:.3f} m>"


def pauta_filter(samples: npt.ArrayLike, radius_in_sigma: float = 3.0) -> Filtered:
    """Remove gross errors: samples farther than 3σ from the mean, again and again until none is left.

    A gross error widens the σ it is judged by, so one round isn't enough. Nor is any number of rounds for few samples:
    no sample can be farther from the mean than (n − 1)/√n times σ, which is below 3 for n < 11. Of good Gaussian
    samples 0.27 % go as well, and more in later rounds; σ comes out 1 to 2 % too small.

    Parameters
    ----------
    samples : (N,) array
        Offsets on one axis [m]; N at least 11 for 3σ.
    radius_in_sigma : float
        At least 1; 3 for the Pauta criterion.

    Returns
    -------
    Filtered
        Mask of the kept samples (N,), their mean and standard deviation (n − 1), and the rounds that removed some.

    Raises
    ------
    ValueError
        If `radius_in_sigma` is below 1, or `samples` are not finite, all equal, not of shape (N,), or too few for any
        to be removed.

    See Also
    --------
    OffsetModel.fit : the model of samples that are left.

    References
    ----------
    R. E. Shiffler, Maximum Z Scores and Outliers, The American Statistician, 1988: why few samples have no outlier.

    Examples
    --------
    >>> import numpy as np
    >>> from uavlab.offsets import pauta_filter
    >>> offsets = np.random.default_rng(0).normal(0.0, 1.0, 200)
    >>> offsets[:3] = 5.0, 20.0, 80.0  # gross errors: the largest hides the others
    >>> pauta_filter(offsets)
    <Filtered: 197 of 200 samples kept, rounds: 2, mean 0.012 m, σ 0.970 m>
    """
    radius_in_sigma = checks.number("radius_in_sigma", radius_in_sigma, checks.at_least_one)
    values = checks.samples(samples, least=2)
    farthest = (len(values) - 1) / np.sqrt(len(values))
    if farthest <= radius_in_sigma:
        least = int((radius_in_sigma + np.sqrt(radius_in_sigma**2 + 4)) ** 2 / 4) + 1
        raise ValueError(
            f"samples must be at least {least} for {radius_in_sigma:g}σ, got {len(values)}: among so few none can be "
            f"farther than (n − 1)/√n = {farthest:.2f}σ from the mean, whatever its value"
        )
    kept, rounds = np.ones(len(values), dtype=bool), 0
    while True:
        mean, sigma = float(values[kept].mean()), float(values[kept].std(ddof=1))
        good = kept & (np.abs(values - mean) <= radius_in_sigma * sigma)
        if good.sum() == kept.sum():
            return Filtered(kept, mean, sigma, rounds)
        kept, rounds = good, rounds + 1


def minimum_safe_distance(
    offset: npt.ArrayLike,
    uav_diameter: float,
    *,
    mean_offset: npt.ArrayLike | None = None,
    normal: npt.ArrayLike | None = None,
) -> np.ndarray:
    """Least distance to keep from obstacles, REPARE Eq. 7.

    D_min = ξ + D_uav / 2: where gusts may push the centre, plus half the body. With a mean offset μ and the direction
    n away from the wall it widens towards the wind: D_min(x) = ξ + D_uav / 2 + max(0, −μ·n).

    Parameters
    ----------
    offset : float or array
        Route offset ξ = kσ to be survived [m], at least 0; `pauta_radius` gives k.
    uav_diameter : float
        Body diameter D_uav [m], above 0.
    mean_offset : (..., D) array, optional
        μ, where the steady wind holds the UAV, from its route [m]; together with `normal`.
    normal : (..., D) array, optional
        n, away from the nearest wall, any length but 0; the gradient of the clearance.

    Returns
    -------
    float or array
        D_min [m]; the shape of `offset`, broadcast with that of μ·n.

    Raises
    ------
    ValueError
        If `offset` is negative or not finite, `uav_diameter` is not above 0, `mean_offset` or `normal` is not made of
        two or three finite numbers or they don't have as many, `normal` has length 0, or only one of the two is given.

    See Also
    --------
    pauta_radius : k in ξ = kσ.
    JointOffset.circle : ξ for all directions at once.
    uavlab.resilience.safe_distance : D_min of REPARE Table 4.

    Examples
    --------
    >>> from uavlab.offsets import minimum_safe_distance
    >>> float(minimum_safe_distance(3.0, uav_diameter=1.0))
    3.5
    >>> walls = [(-1.0, 0.0), (1.0, 0.0)]  # away from a wall in the east, and from one in the west
    >>> minimum_safe_distance(3.0, 1.0, mean_offset=(0.5, 0.0), normal=walls)
    array([4. , 3.5])
    """
    checks.not_negative("offset", offset)
    uav_diameter = checks.positive_number("uav_diameter", uav_diameter)
    distance = np.asarray(offset, dtype=float) + uav_diameter / 2
    if mean_offset is None and normal is None:
        return distance[()]
    if mean_offset is None or normal is None:
        raise ValueError("mean_offset and normal belong together: give both or neither")
    mean, away = checks.vectors(mean_offset=mean_offset, normal=normal)
    length = np.linalg.norm(away, axis=-1)
    if not (length > 0).all():
        raise ValueError(
            f"normal must be a direction away from the wall, {int((length == 0).sum())} of {length.size} have length 0"
        )
    return distance + np.maximum(0.0, -(mean * away).sum(axis=-1) / length)


def checked_dimensions(dimensions: int) -> int:
    whole = isinstance(dimensions, int | np.integer) and not isinstance(dimensions, bool)
    if not whole or dimensions not in (1, 2, 3):
        raise ValueError(f"dimensions must be 1, 2 or 3, got {dimensions!r}")
    return dimensions
