"""Offsets on one axis: Gaussian, and the skewed law of a force that grows with the square of the wind."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.special import ndtr, ndtri

from uavlab import checks
from uavlab.offsets.pauta import PAUTA_COVERAGE


@dataclass(frozen=True)
class OffsetModel:
    """Gaussian offset on one axis, REPARE Eq. 6.

    n(x) = exp(−(x − μ)²/2σ²) / (√(2π) σ)

    Attributes
    ----------
    mean : float
        μ [m], what the autopilot doesn't correct; positive downwind or upwards.
    sigma : float
        σ [m], the paper's risk level; above 0.

    Raises
    ------
    ValueError
        If `mean` is not finite or `sigma` is not above 0.

    See Also
    --------
    OffsetModel.fit : the model of samples.
    SkewedOffset : for a force that grows with the square of the wind.
    JointOffset : on two axes at once.

    Examples
    --------
    >>> from uavlab.offsets import OffsetModel
    >>> model = OffsetModel(mean=0.5, sigma=1.0)
    >>> round(model.boundary(), 2)
    3.5
    >>> f"{model.beyond(3.5):.5f}"
    '0.00135'
    """

    mean: float
    sigma: float

    def __post_init__(self) -> None:
        checks.set_fields(self, checks.number, "mean", check=checks.finite)
        checks.set_fields(self, checks.positive_number, "sigma")

    @classmethod
    def fit(cls, samples: npt.ArrayLike) -> OffsetModel:
        """The model with the mean and the standard deviation of samples.

        μ = Σ x/n, σ² = Σ (x − μ)²/(n − 1)

        Parameters
        ----------
        samples : (N,) array
            Offsets on one axis [m]; at least 2, not all equal.

        Returns
        -------
        OffsetModel
            Gross errors count as well: `pauta_filter` removes them first.

        Raises
        ------
        ValueError
            If `samples` are not finite, all equal, fewer than 2, or not of shape (N,).

        See Also
        --------
        pauta_filter : removes gross errors.
        SkewedOffset.fit : takes the skewness as well.

        Examples
        --------
        >>> from uavlab.offsets import OffsetModel
        >>> model = OffsetModel.fit([0.4, -0.2, 0.9, 0.1, 0.3])
        >>> f"μ = {model.mean:.2f} m, σ = {model.sigma:.2f} m"
        'μ = 0.30 m, σ = 0.41 m'
        """
        values = checks.samples(samples, least=2)
        return cls(float(values.mean()), float(values.std(ddof=1)))

    def density(self, x: npt.ArrayLike) -> np.ndarray:
        """n(x) [1/m] at offsets x [m].

        Parameters
        ----------
        x : float or array
            Offsets [m].

        Returns
        -------
        float or array
            n(x) [1/m], the shape of `x`.

        Raises
        ------
        ValueError
            If `x` is not made of numbers; infinite ones are right.

        See Also
        --------
        OffsetModel.beyond : the probability above an offset.

        Examples
        --------
        >>> from uavlab.offsets import OffsetModel
        >>> OffsetModel(mean=0.0, sigma=0.5).density([0.0, 0.5, 1.5]).round(3)
        array([0.798, 0.484, 0.009])
        """
        checks.within("x", x, -np.inf, np.inf, "m")
        z = (np.asarray(x, dtype=float) - self.mean) / self.sigma
        return np.exp(-0.5 * z**2) / (np.sqrt(2 * np.pi) * self.sigma)

    def beyond(self, x: npt.ArrayLike) -> np.ndarray:
        """Probability of an offset above x [m], on that side only.

        P = Φ((μ − x)/σ)

        Parameters
        ----------
        x : float or array
            Offsets [m].

        Returns
        -------
        float or array
            0 to 1, the shape of `x`.

        Raises
        ------
        ValueError
            If `x` is not made of numbers; infinite ones are right.

        See Also
        --------
        OffsetModel.quantile : the inverse.
        crossing_rate : how often that happens in a time.

        Examples
        --------
        >>> from uavlab.offsets import OffsetModel
        >>> OffsetModel(mean=0.0, sigma=1.0).beyond([0.0, 1.0, 2.0, 3.0]).round(4)
        array([0.5   , 0.1587, 0.0228, 0.0013])
        """
        checks.within("x", x, -np.inf, np.inf, "m")
        return ndtr((self.mean - np.asarray(x, dtype=float)) / self.sigma)

    def quantile(self, probability: npt.ArrayLike) -> np.ndarray:
        """The offset [m] that is exceeded with a chance of 1 − probability.

        x = μ + σ Φ⁻¹(probability)

        Parameters
        ----------
        probability : float or array
            Chance to stay below, between 0 and 1.

        Returns
        -------
        float or array
            x [m], the shape of `probability`.

        Raises
        ------
        ValueError
            If `probability` is not between 0 and 1, without the ends.

        See Also
        --------
        OffsetModel.boundary : of both sides together.

        Examples
        --------
        >>> from uavlab.offsets import OffsetModel
        >>> OffsetModel(mean=0.0, sigma=1.0).quantile([0.5, 0.95, 0.99]).round(2)
        array([0.  , 1.64, 2.33])
        """
        return self.mean + self.sigma * ndtri(checks.share("probability", probability))

    def boundary(self, coverage: float = PAUTA_COVERAGE) -> float:
        """Upper end [m] of the interval around the mean that holds `coverage`; μ + 3σ by default.

        Parameters
        ----------
        coverage : float
            Share of the offsets, between 0 and 1; 0.9973 by default.

        Returns
        -------
        float
            [m]; the lower end lies as far below μ.

        Raises
        ------
        ValueError
            If `coverage` is not between 0 and 1, without the ends.

        See Also
        --------
        minimum_safe_distance : the distance to keep for it.
        SkewedOffset.boundary : that of the skewed law.

        Examples
        --------
        >>> from uavlab.offsets import OffsetModel
        >>> model = OffsetModel(mean=0.5, sigma=1.0)
        >>> [round(model.boundary(share), 2) for share in (0.6827, 0.9545, 0.9973)]
        [1.5, 2.5, 3.5]
        """
        return float(self.quantile((1 + checks.number("coverage", coverage, checks.share)) / 2))

    def sample(self, count: int, rng: np.random.Generator | int) -> np.ndarray:
        """Independent offsets [m], (count,).

        Parameters
        ----------
        count : int
            How many, at least 0.
        rng : numpy.random.Generator or int
            Or a seed.

        Returns
        -------
        (count,) array
            [m]

        Raises
        ------
        ValueError
            If `count` is no whole number of at least 0, or `rng` is neither a generator nor a seed.

        See Also
        --------
        offset_paths : offsets that follow each other in time.

        Examples
        --------
        >>> from uavlab.offsets import OffsetModel
        >>> drawn = OffsetModel(mean=0.5, sigma=1.0).sample(10_000, rng=0)
        >>> f"μ = {drawn.mean():.1f} m, σ = {drawn.std():.1f} m"
        'μ = 0.5 m, σ = 1.0 m'
        """
        return checks.generator("rng", rng).normal(self.mean, self.sigma, checks.whole("count", count, 0))


@dataclass(frozen=True)
class SkewedOffset:
    """Offset on one axis by a force that grows with the square of a Gaussian wind speed.

    x = μ + σ (Q − E Q)/√(Var Q),  Q = |V| V,  V = 1 + I z,  z standard normal

    Drag is |V| V, not V²: a gust that turns the wind round pushes back. V² alone would be a noncentral chi-square
    variable; the two differ by what the chance Φ(−1/I) of V < 0 does, 0.0004 at I = 0.3. All is exact: |V| V rises
    with V, so probabilities are those of z. As I goes to 0 it becomes `OffsetModel`.

    Attributes
    ----------
    mean, sigma : float
        μ and σ of the offset [m], on an axis that points downwind; σ above 0.
    turbulence_intensity : float
        I, standard deviation of the wind speed over its mean, above 0 and at most 1; 0.1 over water, 0.3 in cities.

    Raises
    ------
    ValueError
        If `mean` is not finite, `sigma` is not above 0, or `turbulence_intensity` is not above 0 and at most 1.

    See Also
    --------
    SkewedOffset.from_wind : from the offset in a steady wind.
    OffsetModel : the Gaussian that it becomes without turbulence.
    uavlab.weather.wind_drag : the force.

    Examples
    --------
    >>> from uavlab.offsets import OffsetModel, SkewedOffset
    >>> round(OffsetModel(0.0, 1.0).boundary(), 2)
    3.0
    >>> [round(SkewedOffset(0.0, 1.0, intensity).boundary(), 2) for intensity in (0.1, 0.2, 0.3)]
    [3.39, 3.76, 4.11]
    """

    mean: float
    sigma: float
    turbulence_intensity: float

    def __post_init__(self) -> None:
        checks.set_fields(self, checks.number, "mean", check=checks.finite)
        checks.set_fields(self, checks.positive_number, "sigma")
        checks.set_fields(self, checks.number, "turbulence_intensity")
        if not 0 < self.turbulence_intensity <= 1:
            raise ValueError(
                f"turbulence_intensity must be above 0 and at most 1, got {self.turbulence_intensity:g}; "
                "without turbulence use OffsetModel"
            )

    @classmethod
    def from_wind(cls, steady_offset: float, turbulence_intensity: float) -> SkewedOffset:
        """The model of a UAV that corrects nothing, from the offset that the mean wind alone would hold it at.

        μ = x₀ E Q, σ = x₀ √(Var Q)

        Parameters
        ----------
        steady_offset : float
            x₀, force of the mean wind over the stiffness of the position control [m], above 0.
        turbulence_intensity : float
            I, above 0 and at most 1.

        Returns
        -------
        SkewedOffset
            Its mean is above x₀, as gusts add more force than lulls take away.

        Raises
        ------
        ValueError
            If `steady_offset` is not above 0, or `turbulence_intensity` is not above 0 and at most 1.

        See Also
        --------
        SkewedOffset.fit : from samples.
        uavlab.weather.wind_drag : the force of the mean wind.

        Examples
        --------
        >>> from uavlab.offsets import SkewedOffset
        >>> model = SkewedOffset.from_wind(steady_offset=1.0, turbulence_intensity=0.3)
        >>> f"μ = {model.mean:.2f} m, σ = {model.sigma:.2f} m"
        'μ = 1.09 m, σ = 0.61 m'
        """
        steady_offset = checks.positive_number("steady_offset", steady_offset)
        shape = cls(0.0, 1.0, turbulence_intensity)
        mean, sigma, _ = shape.force_moments
        return cls(steady_offset * mean, steady_offset * sigma, turbulence_intensity)

    @classmethod
    def fit(cls, samples: npt.ArrayLike) -> SkewedOffset:
        """The model with the mean, standard deviation and skewness of samples [m], at least 3.

        Parameters
        ----------
        samples : (N,) array
            Offsets on an axis that points downwind [m]; thousands, as the skewness of few is uncertain.

        Returns
        -------
        SkewedOffset
            With the turbulence intensity that gives this skewness.

        Raises
        ------
        ValueError
            If `samples` are not finite, all equal, fewer than 3, or not of shape (N,); if their skewness isn't one that
            I from 0 to 1 can give.

        See Also
        --------
        OffsetModel.fit : where the skewness is about 0.

        Examples
        --------
        >>> from uavlab.offsets import SkewedOffset
        >>> samples = SkewedOffset(mean=1.0, sigma=0.5, turbulence_intensity=0.3).sample(100_000, rng=0)
        >>> round(SkewedOffset.fit(samples).turbulence_intensity, 1)
        0.3
        """
        from scipy.optimize import brentq
        from scipy.stats import skew

        values = checks.samples(samples, least=3)
        least, most = (cls(0.0, 1.0, intensity).skewness for intensity in (1e-6, 1.0))
        found = float(skew(values))
        if not least < found <= most:
            raise ValueError(
                f"samples have a skewness of {found:.3f}; a force that grows with the square of the wind gives "
                f"0 to {most:.2f}. If it is negative, turn the axis downwind; if it is about 0, use OffsetModel"
            )
        intensity = brentq(lambda i: cls(0.0, 1.0, i).skewness - found, 1e-6, 1.0, xtol=1e-12)
        return cls(float(values.mean()), float(values.std(ddof=1)), float(intensity))

    @property
    def force_moments(self) -> tuple[float, float, float]:
        """Mean, standard deviation and skewness of the force Q, in units of the force of the mean wind."""
        spread = self.turbulence_intensity
        mean, variance, third = 1 + spread**2, 4 * spread**2 + 2 * spread**4, 24 * spread**4 + 8 * spread**6  # of V²
        below = ndtr(-1 / spread)
        backward = [below, below - spread * np.exp(-0.5 / spread**2) / np.sqrt(2 * np.pi)]  # E[Vⁿ; V < 0]
        for n in range(2, 7):  # integrating by parts
            backward.append(backward[-1] + (n - 1) * spread**2 * backward[-2])
        turned = 2 * backward[2]
        third += 3 * turned * (variance - mean**2) + 6 * mean * turned**2 - 2 * turned**3 - 2 * backward[6]
        variance += 2 * mean * turned - turned**2
        return float(mean - turned), float(np.sqrt(variance)), float(third / variance**1.5)

    @property
    def skewness(self) -> float:
        """Third standardised moment, 0 for a Gaussian; about 3 I for small I."""
        return self.force_moments[2]

    def density(self, x: npt.ArrayLike) -> np.ndarray:
        """Density [1/m] at offsets x [m]; infinite at the one point where the wind stands still.

        Parameters
        ----------
        x : float or array
            Offsets [m].

        Returns
        -------
        float or array
            [1/m], the shape of `x`.

        Raises
        ------
        ValueError
            If `x` is not made of numbers; infinite ones are right.

        See Also
        --------
        SkewedOffset.beyond : the probability above an offset.

        Examples
        --------
        >>> from uavlab.offsets import SkewedOffset
        >>> SkewedOffset(mean=0.0, sigma=1.0, turbulence_intensity=0.3).density([-2.0, 0.0, 2.0]).round(3)
        array([0.   , 0.386, 0.059])
        """
        checks.within("x", x, -np.inf, np.inf, "m")
        mean, sigma, _ = self.force_moments
        slope = np.abs(mean + sigma * (np.asarray(x, dtype=float) - self.mean) / self.sigma) ** 0.5
        with np.errstate(divide="ignore"):
            per_z = sigma / (2 * self.turbulence_intensity * slope * self.sigma)
        return np.exp(-0.5 * self.gust_of(x) ** 2) / np.sqrt(2 * np.pi) * per_z

    def beyond(self, x: npt.ArrayLike) -> np.ndarray:
        """Probability of an offset above x [m], on that side only.

        P = Φ(−z) of the gust z that pushes as far as x.

        Parameters
        ----------
        x : float or array
            Offsets [m].

        Returns
        -------
        float or array
            0 to 1, the shape of `x`.

        Raises
        ------
        ValueError
            If `x` is not made of numbers; infinite ones are right.

        See Also
        --------
        SkewedOffset.quantile : the inverse.
        SkewedOffset.gust_of : z.

        Examples
        --------
        >>> from uavlab.offsets import OffsetModel, SkewedOffset
        >>> gaussian, skewed = OffsetModel(0.0, 1.0), SkewedOffset(0.0, 1.0, turbulence_intensity=0.3)
        >>> f"{skewed.beyond(3.0) / gaussian.beyond(3.0):.1f} times as often beyond 3σ"
        '6.5 times as often beyond 3σ'
        """
        return ndtr(-self.gust_of(x))

    def quantile(self, probability: npt.ArrayLike) -> np.ndarray:
        """The offset [m] that is exceeded with a chance of 1 − probability.

        Parameters
        ----------
        probability : float or array
            Chance to stay below, between 0 and 1.

        Returns
        -------
        float or array
            [m], the shape of `probability`.

        Raises
        ------
        ValueError
            If `probability` is not between 0 and 1, without the ends.

        See Also
        --------
        SkewedOffset.beyond : the inverse.
        SkewedOffset.boundary : of both sides together.

        Examples
        --------
        >>> from uavlab.offsets import SkewedOffset
        >>> SkewedOffset(mean=0.0, sigma=1.0, turbulence_intensity=0.3).quantile([0.01, 0.5, 0.99]).round(2)
        array([-1.63, -0.15,  2.92])
        """
        return self.offset_of(ndtri(checks.share("probability", probability)))

    def boundary(self, coverage: float = PAUTA_COVERAGE) -> float:
        """Upper end [m] of the interval that holds `coverage`, with equal chances above and below.

        Parameters
        ----------
        coverage : float
            Share of the offsets, between 0 and 1; 0.9973 by default.

        Returns
        -------
        float
            [m]; of a high coverage the lower end lies nearer to μ.

        Raises
        ------
        ValueError
            If `coverage` is not between 0 and 1, without the ends.

        See Also
        --------
        OffsetModel.boundary : that of the Gaussian.
        minimum_safe_distance : the distance to keep for it.

        Examples
        --------
        >>> from uavlab.offsets import SkewedOffset
        >>> model = SkewedOffset(mean=0.0, sigma=1.0, turbulence_intensity=0.3)
        >>> [round(model.boundary(share), 2) for share in (0.6827, 0.9545, 0.9973)]
        [0.98, 2.4, 4.11]
        """
        return float(self.quantile((1 + checks.number("coverage", coverage, checks.share)) / 2))

    def sample(self, count: int, rng: np.random.Generator | int) -> np.ndarray:
        """Independent offsets [m], (count,).

        Parameters
        ----------
        count : int
            How many, at least 0.
        rng : numpy.random.Generator or int
            Or a seed.

        Returns
        -------
        (count,) array
            [m]

        Raises
        ------
        ValueError
            If `count` is no whole number of at least 0, or `rng` is neither a generator nor a seed.

        See Also
        --------
        SkewedOffset.fit : the way back.

        Examples
        --------
        >>> from uavlab.offsets import SkewedOffset
        >>> drawn = SkewedOffset(mean=1.0, sigma=0.5, turbulence_intensity=0.3).sample(10_000, rng=0)
        >>> f"μ = {drawn.mean():.1f} m, σ = {drawn.std():.1f} m"
        'μ = 1.0 m, σ = 0.5 m'
        """
        return self.offset_of(checks.generator("rng", rng).standard_normal(checks.whole("count", count, 0)))

    def offset_of(self, gust: npt.ArrayLike) -> np.ndarray:
        """Offset [m] when the wind is `gust` standard deviations above its mean.

        x = μ + σ (|V| V − E Q)/√(Var Q), V = 1 + I z

        Parameters
        ----------
        gust : float or array
            z, standard deviations of the wind speed; −3 to 3.

        Returns
        -------
        float or array
            x [m], the shape of `gust`.

        Raises
        ------
        ValueError
            If `gust` is not made of numbers; infinite ones are right.

        See Also
        --------
        SkewedOffset.gust_of : the inverse.

        Examples
        --------
        >>> from uavlab.offsets import SkewedOffset
        >>> model = SkewedOffset.from_wind(steady_offset=1.0, turbulence_intensity=0.3)
        >>> model.offset_of([-3.0, 0.0, 3.0]).round(2)
        array([0.01, 1.  , 3.61])
        """
        checks.within("gust", gust, -np.inf, np.inf, "standard deviations")
        mean, sigma, _ = self.force_moments
        speed = 1 + self.turbulence_intensity * np.asarray(gust, dtype=float)
        return self.mean + self.sigma * (np.abs(speed) * speed - mean) / sigma

    def gust_of(self, x: npt.ArrayLike) -> np.ndarray:
        """How many standard deviations above its mean the wind is when the offset is x [m].

        Parameters
        ----------
        x : float or array
            Offsets [m].

        Returns
        -------
        float or array
            z, the shape of `x`.

        Raises
        ------
        ValueError
            If `x` is not made of numbers; infinite ones are right.

        See Also
        --------
        SkewedOffset.offset_of : the inverse.

        Examples
        --------
        >>> from uavlab.offsets import SkewedOffset
        >>> model = SkewedOffset.from_wind(steady_offset=1.0, turbulence_intensity=0.3)
        >>> model.gust_of([1.0, 2.0, 4.0]).round(2)  # twice the wind pushes four times as far
        array([0.  , 1.38, 3.33])
        """
        checks.within("x", x, -np.inf, np.inf, "m")
        mean, sigma, _ = self.force_moments
        force = mean + sigma * (np.asarray(x, dtype=float) - self.mean) / self.sigma
        return (np.sign(force) * np.sqrt(np.abs(force)) - 1) / self.turbulence_intensity
