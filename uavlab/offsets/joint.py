"""Offsets on two axes at once: the joint density of REPARE Eq. 17, and the magnitude it gives."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.special import ndtr

from uavlab import checks
from uavlab.offsets.pauta import PAUTA_COVERAGE, pauta_radius
from uavlab.offsets.pauta import coverage as coverage_of

NEARLY_NORMAL = 30.0
"""Of the mean offset over σ: from here on the distance is normal to a millionth, and Rice's law overflows."""


@dataclass(frozen=True)
class JointOffset:
    """Gaussian offset on two signed axes, REPARE Eq. 17.

    f(x, y) = exp(−r²/2) / (2π σ₁ σ₂ √(1 − ρ²)),  r² = (u² − 2ρuv + v²)/(1 − ρ²),  u = (x − μ₁)/σ₁,  v = (y − μ₂)/σ₂

    The paper calls f a probability; it is a density [1/m²], and may be above 1. Its ξ_hor, an offset parallel to the
    ground, must be one signed axis (across the route, say): the magnitude of two is not Gaussian, see `magnitude`.

    Attributes
    ----------
    mean : (2,)
        μ₁, μ₂ [m].
    sigma : (2,)
        σ₁, σ₂ [m], above 0.
    correlation : float
        ρ, between −1 and 1.

    Raises
    ------
    ValueError
        If `mean` or `sigma` is not two finite numbers, one of `sigma` is not above 0, or `correlation` is not one
        number between −1 and 1, without the ends.

    See Also
    --------
    JointOffset.fit : the model of samples.
    safety_domain : fits it, and says where a share of the offsets stays.
    OffsetModel : one axis.

    Examples
    --------
    >>> from uavlab.offsets import JointOffset
    >>> model = JointOffset(mean=(0.0, 0.0), sigma=(1.0, 0.5), correlation=-0.6)
    >>> model
    <JointOffset: μ = (0, 0) m, σ = (1, 0.5) m, ρ = -0.6>
    >>> f"{model.density((0.0, 0.0)):.3f} per m² on the route, a circle of {model.circle():.2f} m holds 99.73 %"
    '0.398 per m² on the route, a circle of 3.18 m holds 99.73 %'
    """

    mean: tuple[float, float]
    sigma: tuple[float, float]
    correlation: float = 0.0

    def __post_init__(self) -> None:
        for name in ("mean", "sigma"):
            pair = checks.numbers(name, getattr(self, name))
            if pair.shape != (2,):
                raise ValueError(f"{name} must be two numbers, one for each axis, got shape {pair.shape}")
            object.__setattr__(self, name, tuple(pair.tolist()))
        checks.set_fields(self, checks.number, "correlation")
        checks.finite("mean", self.mean)
        checks.positive("sigma", self.sigma)
        if not -1 < self.correlation < 1:
            raise ValueError(f"correlation must be between -1 and 1, without the ends, got {self.correlation:g}")

    def __repr__(self) -> str:
        (one, two), (first, second) = self.mean, self.sigma
        means, sigmas = f"μ = ({one:.3g}, {two:.3g}) m", f"σ = ({first:.3g}, {second:.3g}) m"
        return f"<JointOffset: {means}, {sigmas}, ρ = {self.correlation:.3g}>"

    @classmethod
    def fit(cls, samples: npt.ArrayLike) -> JointOffset:
        """The model with the means, standard deviations (n − 1) and correlation of samples.

        Parameters
        ----------
        samples : (N, 2) array
            Offsets [m], N at least 3.

        Returns
        -------
        JointOffset
            Gross errors count as well.

        Raises
        ------
        ValueError
            If `samples` are not finite, fewer than 3, all equal on an axis, on a line, or not of shape (N, 2).

        See Also
        --------
        safety_domain : the fit, and what it holds of the samples.
        OffsetModel.fit : along one axis.

        Examples
        --------
        >>> from uavlab.offsets import JointOffset
        >>> JointOffset.fit([(0.4, 0.1), (-0.3, 0.2), (0.1, -0.4), (-0.2, 0.0), (0.5, -0.2)])
        <JointOffset: μ = (0.1, -0.06) m, σ = (0.354, 0.241) m, ρ = -0.382>
        """
        values = checks.samples(samples, least=3, axes=2)
        mean, covariance = values.mean(axis=0), np.cov(values.T)
        sigma = np.sqrt(np.diag(covariance))
        correlation = float(covariance[0, 1] / sigma.prod())
        if abs(correlation) > 1 - 1e-12:
            raise ValueError("samples lie on a line, so one axis says all: fit an OffsetModel along it")
        return cls(tuple(mean), tuple(sigma), correlation)

    @property
    def covariance(self) -> np.ndarray:
        """Covariance matrix (2, 2) [m²]."""
        one, two = self.sigma
        return np.array([[one**2, self.correlation * one * two], [self.correlation * one * two, two**2]])

    def density(self, points: npt.ArrayLike) -> np.ndarray:
        """f [1/m²] at points (..., 2) [m].

        Parameters
        ----------
        points : (..., 2) array
            Offsets on the two axes [m].

        Returns
        -------
        (...) array
            f [1/m²].

        Raises
        ------
        ValueError
            If `points` is not of shape (..., 2) or not finite.

        See Also
        --------
        JointOffset.radius_in_sigma : r in f.

        Examples
        --------
        >>> from uavlab.offsets import JointOffset
        >>> JointOffset(mean=(0.0, 0.0), sigma=(0.3, 0.3)).density([(0.0, 0.0), (0.3, 0.0)]).round(2)
        array([1.77, 1.07])
        """
        height = 2 * np.pi * self.sigma[0] * self.sigma[1] * np.sqrt(1 - self.correlation**2)
        return np.exp(-0.5 * self.radius_in_sigma(points) ** 2) / height

    def radius_in_sigma(self, points: npt.ArrayLike) -> np.ndarray:
        """r of points (..., 2) [m]: which ellipse around the mean they lie on (the Mahalanobis distance).

        Parameters
        ----------
        points : (..., 2) array
            Offsets on the two axes [m].

        Returns
        -------
        (...) array
            r, at least 0; 1 on the ellipse of one σ.

        Raises
        ------
        ValueError
            If `points` is not of shape (..., 2) or not finite.

        See Also
        --------
        JointOffset.ellipse : the outline of one r.
        coverage : what an r holds.

        References
        ----------
        P. C. Mahalanobis, On the Generalised Distance in Statistics, Proceedings of the National Institute of Sciences
        of India, 1936.

        Examples
        --------
        >>> from uavlab.offsets import JointOffset
        >>> model = JointOffset(mean=(0.0, 0.0), sigma=(1.0, 0.5))
        >>> model.radius_in_sigma([(2.0, 0.0), (0.0, 2.0)])
        array([2., 4.])
        """
        where = checks.array("points", points, ..., 2)
        u, v = np.moveaxis((where - self.mean) / self.sigma, -1, 0)
        return np.sqrt((u**2 - 2 * self.correlation * u * v + v**2) / (1 - self.correlation**2))

    def ellipse(self, coverage: float = PAUTA_COVERAGE, count: int = 181) -> np.ndarray:
        """Closed outline (count, 2) [m] of the ellipse of equal density that holds `coverage`.

        r = k of `pauta_radius` in two dimensions.

        Parameters
        ----------
        coverage : float
            Share of the offsets, between 0 and 1; 0.9973 by default.
        count : int
            Points of the outline, at least 2; the last is the first.

        Returns
        -------
        (count, 2) array
            [m]

        Raises
        ------
        ValueError
            If `coverage` is not between 0 and 1, without the ends, or `count` is no whole number of at least 2.

        See Also
        --------
        JointOffset.circle : the circle around the route instead.

        Examples
        --------
        >>> from uavlab.offsets import JointOffset
        >>> outline = JointOffset(mean=(0.0, 0.0), sigma=(1.0, 0.5)).ellipse()
        >>> outline.shape, outline.max(axis=0).round(2)
        ((181, 2), array([3.44, 1.72]))
        """
        angle = np.linspace(0, 2 * np.pi, checks.whole("count", count, 2))
        circle = pauta_radius(2, coverage) * np.column_stack([np.cos(angle), np.sin(angle)])
        return self.mean + circle @ np.linalg.cholesky(self.covariance).T

    def within_circle(self, radius: float) -> float:
        """Probability of an offset of at most `radius` [m] from the route, in whichever direction.

        Exact, by integrating the Gaussian across the circle along the principal axes.

        P = ∬ f(x, y) dx dy over x² + y² ≤ R².

        Parameters
        ----------
        radius : float
            R [m], at least 0.

        Returns
        -------
        float
            0 to 1.

        Raises
        ------
        ValueError
            If `radius` is negative or not finite.

        See Also
        --------
        JointOffset.circle : the inverse.
        coverage : where both axes have one σ and no mean.

        Examples
        --------
        >>> from uavlab.offsets import JointOffset
        >>> model = JointOffset(mean=(0.5, 0.0), sigma=(1.0, 1.0))
        >>> [round(model.within_circle(radius), 3) for radius in (1.0, 2.0, 3.0, 4.0)]
        [0.357, 0.831, 0.982, 0.999]
        """
        from scipy.integrate import quad

        radius = checks.not_negative_number("radius", radius)
        variance, axes = np.linalg.eigh(self.covariance)
        (mean, other_mean), (sigma, other_sigma) = self.mean @ axes, np.sqrt(variance)

        def slice_at(x: float) -> float:
            half = np.sqrt(max(radius**2 - x**2, 0.0))
            share = ndtr((half - other_mean) / other_sigma) - ndtr((-half - other_mean) / other_sigma)
            return float(share * np.exp(-0.5 * ((x - mean) / sigma) ** 2) / (np.sqrt(2 * np.pi) * sigma))

        low, high = max(-radius, mean - 12 * sigma), min(radius, mean + 12 * sigma)
        return float(quad(slice_at, low, high, epsabs=1e-13, epsrel=1e-12, limit=200)[0]) if low < high else 0.0

    def circle(self, coverage: float = PAUTA_COVERAGE) -> float:
        """Radius [m] of the circle around the route that holds `coverage`: the ξ of Eq. 7 for all directions.

        Parameters
        ----------
        coverage : float
            Share of the offsets, between 0 and 1; 0.9973 by default.

        Returns
        -------
        float
            [m]

        Raises
        ------
        ValueError
            If `coverage` is not between 0 and 1, without the ends.

        See Also
        --------
        JointOffset.within_circle : the inverse.
        minimum_safe_distance : the distance to keep for it.

        Examples
        --------
        >>> from uavlab.offsets import JointOffset
        >>> [round(JointOffset(mean=(push, 0.0), sigma=(1.0, 1.0)).circle(), 2) for push in (0.0, 0.5, 1.0)]
        [3.44, 3.63, 4.02]
        """
        from scipy.optimize import brentq

        share = checks.number("coverage", coverage, checks.share)
        widest = np.sqrt(np.linalg.eigvalsh(self.covariance)[-1])
        around_ellipse = np.hypot(*self.mean) + 1.01 * pauta_radius(2, coverage) * widest
        return float(brentq(lambda radius: self.within_circle(radius) - share, 0.0, around_ellipse, xtol=1e-12))

    def sample(self, count: int, rng: np.random.Generator | int) -> np.ndarray:
        """Independent offsets (count, 2) [m].

        Parameters
        ----------
        count : int
            How many, at least 0.
        rng : numpy.random.Generator or int
            Or a seed.

        Returns
        -------
        (count, 2) array
            [m]

        Raises
        ------
        ValueError
            If `count` is no whole number of at least 0, or `rng` is neither a generator nor a seed.

        See Also
        --------
        JointOffset.fit : the way back.

        Examples
        --------
        >>> from uavlab.offsets import JointOffset
        >>> model = JointOffset(mean=(0.0, 0.0), sigma=(1.0, 0.5), correlation=-0.6)
        >>> drawn = model.sample(10_000, rng=0)
        >>> drawn.shape, drawn.std(axis=0).round(1)
        ((10000, 2), array([1. , 0.5]))
        """
        count = checks.whole("count", count, 0)
        return checks.generator("rng", rng).multivariate_normal(self.mean, self.covariance, count, method="cholesky")


@dataclass(frozen=True, eq=False)
class SafetyDomain:
    """Where offsets on two axes are to stay, as REPARE Fig. 18 draws it over their joint density.

    Attributes
    ----------
    model : JointOffset
        Fitted to the offsets.
    coverage : float
        Share of the model within the ellipse.
    ellipse : (181, 2) array
        Closed outline [m] around the mean.
    radius : float
        Of the circle around the route [m], the ξ of Eq. 7 for all directions.
    in_ellipse, in_circle : float
        Share of the offsets within each.

    See Also
    --------
    safety_domain : makes it.

    Examples
    --------
    >>> from uavlab.offsets import JointOffset, safety_domain
    >>> domain = safety_domain(JointOffset(mean=(0.0, 0.0), sigma=(1.0, 0.5)).sample(1000, rng=0))
    >>> domain.ellipse.shape
    (181, 2)
    >>> round(domain.radius, 1)
    3.1
    """

    model: JointOffset
    coverage: float
    ellipse: np.ndarray
    radius: float
    in_ellipse: float
    in_circle: float

    def __repr__(self) -> str:
        held = f"{self.in_ellipse:.2%} of the offsets in the ellipse, {self.in_circle:.2%} within {self.radius:.2f} m"
        return f"<SafetyDomain for {self.coverage:.2%}: {held}>"


def safety_domain(
    samples: npt.ArrayLike, coverage: float = PAUTA_COVERAGE, *, as_printed: bool = False
) -> SafetyDomain:
    """Fit the joint density to offsets, and find where a share of them stays (REPARE 3.4, Fig. 18).

    Parameters
    ----------
    samples : (N, 2) array
        Offsets [m], such as `Flights.samples`; N at least 3.
    coverage : float
        Between 0 and 1; 99.73 % by default.
    as_printed : bool
        The Pauta criterion of one axis, 3σ, for two: the ellipse then holds 98.89 % where 99.73 % are meant.

    Returns
    -------
    SafetyDomain
        The model, its ellipse and circle, and the share of `samples` within each.

    Raises
    ------
    ValueError
        If `samples` are not finite, fewer than 3, on a line, or not of shape (N, 2), `coverage` is not between 0 and 1,
        without the ends, or `as_printed` is not True or False.

    See Also
    --------
    JointOffset : the model.
    uavlab.plot.safety_domain : draws it.

    Examples
    --------
    >>> from uavlab.offsets import JointOffset, safety_domain
    >>> samples = JointOffset(mean=(0.0, 0.0), sigma=(1.0, 0.5)).sample(10_000, rng=0)
    >>> [round(safety_domain(samples, as_printed=printed).coverage, 4) for printed in (False, True)]
    [0.9973, 0.9889]
    """
    model = JointOffset.fit(samples)
    radius_in_sigma = float(pauta_radius(1 if checks.flag("as_printed", as_printed) else 2, coverage))
    held = float(coverage_of(radius_in_sigma, 2))
    radius = radius_in_sigma * max(model.sigma) if as_printed else model.circle(coverage)
    points = np.asarray(samples, dtype=float)
    return SafetyDomain(
        model,
        held,
        model.ellipse(held),
        radius,
        float((model.radius_in_sigma(points) <= radius_in_sigma).mean()),
        float((np.hypot(*points.T) <= radius).mean()),
    )


def magnitude(sigma: float, mean_length: float = 0.0) -> Any:
    """Law of the distance from the route in the plane, when both axes have the same σ.

    Rayleigh: mean √(π/2) σ = 1.2533 σ, 99.73 % within 3.439 σ. With a mean offset: Rice.

    f(r) = (r/σ²) exp(−(r² + m²)/2σ²) I₀(rm/σ²), m the mean offset's length, I₀ the modified Bessel function.

    Parameters
    ----------
    sigma : float
        σ of each axis [m], above 0.
    mean_length : float
        Length of the mean offset [m], at least 0.

    Returns
    -------
    scipy.stats distribution
        With `pdf`, `cdf`, `ppf`, `mean` and so on.

    Raises
    ------
    ValueError
        If `sigma` is not above 0, `mean_length` is negative, or one is not a single finite number.

    See Also
    --------
    JointOffset.within_circle : the same where the axes differ.
    pauta_radius : k of the circle without a mean offset.

    References
    ----------
    S. O. Rice, Mathematical Analysis of Random Noise, Bell System Technical Journal, 1944 and 1945.

    Examples
    --------
    >>> from uavlab.offsets import PAUTA_COVERAGE, magnitude
    >>> law = magnitude(sigma=1.0)
    >>> f"mean {law.mean():.4f} m, 99.73 % within {law.ppf(PAUTA_COVERAGE):.3f} m, only {law.cdf(3.0):.2%} within 3 m"
    'mean 1.2533 m, 99.73 % within 3.439 m, only 98.89% within 3 m'
    """
    from scipy.stats import norm, rayleigh, rice

    sigma = checks.positive_number("sigma", sigma)
    away = checks.not_negative_number("mean_length", mean_length) / sigma
    if away == 0:
        return rayleigh(scale=sigma)
    if away > NEARLY_NORMAL:  # SciPy's Bessel functions overflow
        return norm(loc=sigma * np.sqrt(away**2 + 1), scale=sigma * np.sqrt(1 - 1 / (2 * away**2)))
    return rice(away, scale=sigma)
