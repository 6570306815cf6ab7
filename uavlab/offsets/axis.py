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
        If the mean is not finite or σ not above 0.
    """

    mean: float
    sigma: float

    def __post_init__(self) -> None:
        checks.finite("mean", self.mean)
        checks.positive("sigma", self.sigma)

    @classmethod
    def fit(cls, samples: npt.ArrayLike) -> OffsetModel:
        """The model with the mean and the standard deviation (n − 1) of samples [m], at least 2, not all equal."""
        values = checks.samples(samples, least=2)
        return cls(float(values.mean()), float(values.std(ddof=1)))

    def density(self, x: npt.ArrayLike) -> np.ndarray:
        """n(x) [1/m] at offsets x [m]."""
        z = (np.asarray(x, dtype=float) - self.mean) / self.sigma
        return np.exp(-0.5 * z**2) / (np.sqrt(2 * np.pi) * self.sigma)

    def beyond(self, x: npt.ArrayLike) -> np.ndarray:
        """Probability of an offset above x [m], on that side only."""
        return ndtr((self.mean - np.asarray(x, dtype=float)) / self.sigma)

    def quantile(self, probability: npt.ArrayLike) -> np.ndarray:
        """The offset [m] that is exceeded with a chance of 1 − probability."""
        return self.mean + self.sigma * ndtri(checks.share("probability", probability))

    def boundary(self, coverage: float = PAUTA_COVERAGE) -> float:
        """Upper end [m] of the interval around the mean that holds `coverage`; μ + 3σ by default."""
        return float(self.quantile((1 + checks.share("coverage", coverage)) / 2))

    def sample(self, count: int, rng: np.random.Generator | int) -> np.ndarray:
        """Independent offsets [m], (count,)."""
        return checks.generator("rng", rng).normal(self.mean, self.sigma, count)


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
        If an argument is not finite or out of its range.
    """

    mean: float
    sigma: float
    turbulence_intensity: float

    def __post_init__(self) -> None:
        checks.finite("mean", self.mean)
        checks.positive("sigma", self.sigma)
        if not 0 < self.turbulence_intensity <= 1:
            raise ValueError(
                f"turbulence_intensity must be above 0 and at most 1, got {self.turbulence_intensity!r}; "
                "without turbulence use OffsetModel"
            )

    @classmethod
    def from_wind(cls, steady_offset: float, turbulence_intensity: float) -> SkewedOffset:
        """The model of a UAV that corrects nothing, from the offset that the mean wind alone would hold it at.

        Parameters
        ----------
        steady_offset : float
            Force of the mean wind over the stiffness of the position control [m], above 0.
        turbulence_intensity : float
            I, above 0 and at most 1.
        """
        checks.positive("steady_offset", steady_offset)
        shape = cls(0.0, 1.0, turbulence_intensity)
        mean, sigma, _ = shape.force_moments
        return cls(steady_offset * mean, steady_offset * sigma, turbulence_intensity)

    @classmethod
    def fit(cls, samples: npt.ArrayLike) -> SkewedOffset:
        """The model with the mean, standard deviation and skewness of samples [m], at least 3.

        Raises
        ------
        ValueError
            If a sample is not finite, or the skewness isn't one that I from 0 to 1 can give.
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
        """Density [1/m] at offsets x [m]; infinite at the one point where the wind stands still."""
        mean, sigma, _ = self.force_moments
        slope = np.abs(mean + sigma * (np.asarray(x, dtype=float) - self.mean) / self.sigma) ** 0.5
        with np.errstate(divide="ignore"):
            per_z = sigma / (2 * self.turbulence_intensity * slope * self.sigma)
        return np.exp(-0.5 * self.gust_of(x) ** 2) / np.sqrt(2 * np.pi) * per_z

    def beyond(self, x: npt.ArrayLike) -> np.ndarray:
        """Probability of an offset above x [m], on that side only."""
        return ndtr(-self.gust_of(x))

    def quantile(self, probability: npt.ArrayLike) -> np.ndarray:
        """The offset [m] that is exceeded with a chance of 1 − probability."""
        return self.offset_of(ndtri(checks.share("probability", probability)))

    def boundary(self, coverage: float = PAUTA_COVERAGE) -> float:
        """Upper end [m] of the interval that holds `coverage`, with equal chances above and below."""
        return float(self.quantile((1 + checks.share("coverage", coverage)) / 2))

    def sample(self, count: int, rng: np.random.Generator | int) -> np.ndarray:
        """Independent offsets [m], (count,)."""
        return self.offset_of(checks.generator("rng", rng).standard_normal(count))

    def offset_of(self, gust: npt.ArrayLike) -> np.ndarray:
        """Offset [m] when the wind is `gust` standard deviations above its mean."""
        mean, sigma, _ = self.force_moments
        speed = 1 + self.turbulence_intensity * np.asarray(gust, dtype=float)
        return self.mean + self.sigma * (np.abs(speed) * speed - mean) / sigma

    def gust_of(self, x: npt.ArrayLike) -> np.ndarray:
        """How many standard deviations above its mean the wind is when the offset is x [m]."""
        mean, sigma, _ = self.force_moments
        force = mean + sigma * (np.asarray(x, dtype=float) - self.mean) / self.sigma
        return (np.sign(force) * np.sqrt(np.abs(force)) - 1) / self.turbulence_intensity
