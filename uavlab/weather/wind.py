"""Moving air as flights and planners have it: a mean, gusts around it, and rain."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.compiled import compilable
from uavlab.vehicle import UAV
from uavlab.weather.envelope import CREEP, limits_broken
from uavlab.weather.forces import STANDARD_AIR, Weather, rain_force
from uavlab.weather.turbulence import dryden_parameters, dryden_spectrum

GUSTS = ("none", "gaussian", "ou", "dryden")
"""In the order of the kinds in `uavlab.flight.motion`."""


GUST_SHARES = np.array([1.0, 1.0, 0.5])
"""Of σ of the gusts, along, across and vertical: up and down they are weaker."""


@dataclass(frozen=True)
class Wind:
    """Moving air and rain: a mean, and gusts around it.

    Attributes
    ----------
    mean : (2,) or (3,)
        Where the air moves to, east, north and up [m/s].
    gusts : {"ou", "gaussian", "dryden", "none"}
        "ou": Ornstein-Uhlenbeck, R(t) = σ² exp(−|t|/τ). "gaussian": drawn anew every τ seconds. "dryden": after
        MIL-F-8785C at the route's height; it takes its strength from the mean wind, as that at 6 m, and its pace from
        the air that passes the UAV.
    deviation : float
        σ of each level component [m/s], at least 0; vertical gusts have half of it. Not for "dryden".
    correlation : float
        τ [s], above 0. Not for "dryden".
    rain_mm_per_h : float
        Rain rate [mm/h].
    air_density : float
        [kg/m³]

    Raises
    ------
    ValueError
        If `mean` is not two or three finite numbers, `gusts` is unknown, `deviation` or `rain_mm_per_h` is negative,
        `correlation` or `air_density` is not above 0, or `gusts` is "dryden" and `mean` has no level part.

    See Also
    --------
    Wind.from_weather : the wind of a state of the weather.
    gust_spectrum : how the gusts are spread over frequencies.
    uavlab.flight.fly : a flight in this wind.

    References
    ----------
    MIL-F-8785C, Flying Qualities of Piloted Airplanes, US Department of Defense, 1980.

    G. E. Uhlenbeck and L. S. Ornstein, On the Theory of the Brownian Motion, Physical Review, 1930.

    Examples
    --------
    >>> from uavlab.weather import Wind
    >>> Wind(mean=(3.0, 4.0), deviation=1.5)
    <Wind: mean (3, 4, 0) m/s, ou gusts with σ = 1.5 m/s and τ = 1 s, rain 0 mm/h>
    >>> Wind(mean=(3.0, 4.0)).speed
    5.0
    """

    mean: tuple[float, ...] = (0.0, 0.0, 0.0)
    gusts: str = "ou"
    deviation: float = 1.0
    correlation: float = 1.0
    rain_mm_per_h: float = 0.0
    air_density: float = STANDARD_AIR

    def __post_init__(self) -> None:
        checks.set_fields(self, checks.three, "mean")
        checks.set_fields(self, checks.one_of, "gusts", known=GUSTS)
        checks.set_fields(self, checks.not_negative_number, "deviation", "rain_mm_per_h")
        checks.set_fields(self, checks.positive_number, "correlation", "air_density")
        if self.gusts == "dryden" and not any(self.mean[:2]):
            raise ValueError("mean is calm, and Dryden gusts take their strength from it: give a wind, or other gusts")

    def __repr__(self) -> str:
        east, north, up = self.mean
        gusts = {"none": "no gusts", "dryden": "Dryden gusts"}.get(
            self.gusts, f"{self.gusts} gusts with σ = {self.deviation:.3g} m/s and τ = {self.correlation:.3g} s"
        )
        return f"<Wind: mean ({east:.3g}, {north:.3g}, {up:.3g}) m/s, {gusts}, rain {self.rain_mm_per_h:.3g} mm/h>"

    @classmethod
    def from_weather(cls, weather: Weather, gusts: str = "ou", correlation: float = 1.0) -> Wind:
        """The wind of a state of the weather; its strongest gust counts as 3σ above the mean.

        The mean blows with V_res of REPARE Eq. 3, and σ = (gust − V_res)/3.

        Parameters
        ----------
        weather : Weather
            Its reference wind, direction, rain and air density are taken.
        gusts : {"ou", "gaussian", "dryden", "none"}
            Kind of gusts; "dryden" needs a wind above 0.
        correlation : float
            τ [s], above 0; 1 to 5. Not for "dryden".

        Returns
        -------
        Wind
            Level; it blows to where the weather's wind doesn't come from.

        Raises
        ------
        ValueError
            If `weather` is no Weather, `gusts` is unknown, `correlation` is not above 0, or `gusts` is "dryden" and
            `weather` is calm.

        See Also
        --------
        Weather : the state of the weather.
        reference_wind : the mean and the gust that are taken from it.

        Examples
        --------
        >>> from uavlab.weather import Weather, Wind
        >>> wind = Wind.from_weather(Weather(forecast_wind=4.0, forecast_max_wind=8.5, wind_from_deg=270.0))
        >>> f"{wind.mean[0]:.1f} m/s to the east, σ = {wind.deviation:.1f} m/s"
        '4.0 m/s to the east, σ = 1.5 m/s'
        """
        checks.instance("weather", weather, Weather)
        mean, gust = weather.reference_wind
        return cls(
            mean=tuple(mean * weather.wind_direction),
            gusts=gusts,
            deviation=(gust - mean) / 3,
            correlation=correlation,
            rain_mm_per_h=weather.rain_mm_per_h,
            air_density=weather.air_density,
        )

    @property
    def speed(self) -> float:
        """Of the mean wind [m/s]."""
        return float(np.linalg.norm(self.mean))


def wind_of(disturbance: Wind | Weather, name: str = "disturbance") -> Wind:
    """A wind, or that of a state of the weather; `name` is that of the argument."""
    if isinstance(disturbance, Weather):
        return Wind.from_weather(disturbance)
    checks.instance(name, disturbance, Wind)
    return disturbance


def gust_spectrum(wind: Wind, omega: npt.ArrayLike, air_speed: float, altitude: float = 30.0) -> np.ndarray:
    """One-sided spectral density of gusts (..., 3) [m²/s² per rad/s]: its integral over ω is their variance.

    Of a level component, "ou": 2σ²τ/π / (1 + (τω)²); "gaussian": σ²τ/π · [sin(τω/2)/(τω/2)]²; vertical gusts have a
    quarter of it. "dryden": `dryden_spectrum`.

    Parameters
    ----------
    wind : Wind
        Its `gusts`, `deviation` σ and `correlation` τ are used; of Dryden gusts its mean speed.
    omega : (...) array
        Angular frequency ω [rad/s], at least 0.
    air_speed : float
        Speed through the air [m/s], above 0; for Dryden gusts only.
    altitude : float
        Height above the ground [m], 3.048 to 304.8; for Dryden gusts only.

    Returns
    -------
    (..., 3) array
        Density [m²/s² per rad/s]: along, across and vertical for Dryden gusts, else east, north and up.

    Raises
    ------
    ValueError
        If `wind` is no Wind, `omega` is negative or not finite, or `air_speed` or `altitude` is not above 0; of Dryden
        gusts also if `altitude` is not within its range.

    See Also
    --------
    Wind : the gusts whose spectrum it is.
    dryden_spectrum : that of Dryden turbulence.

    Examples
    --------
    >>> import numpy as np
    >>> from uavlab.weather import Wind, gust_spectrum
    >>> omega = np.linspace(0.0, 200.0, 20_001)
    >>> density = gust_spectrum(Wind(deviation=2.0), omega, air_speed=5.0)
    >>> np.trapezoid(density, omega, axis=0).round(1)  # the variances: 2² level, 1² vertical
    array([4., 4., 1.])
    """
    checks.instance("wind", wind, Wind)
    if wind.gusts == "dryden":
        return dryden_spectrum(omega, air_speed, altitude, wind.speed)
    checks.not_negative("omega", omega)
    checks.positive_number("air_speed", air_speed)
    checks.positive_number("altitude", altitude)
    omega = np.asarray(omega, dtype=float)
    if wind.gusts == "none":
        return np.zeros((*omega.shape, 3))
    turn = omega * wind.correlation
    shape = 2 / (1 + turn**2) if wind.gusts == "ou" else np.sinc(turn / (2 * np.pi)) ** 2
    deviations = wind.deviation * GUST_SHARES
    return wind.correlation / np.pi * shape[..., None] * deviations**2


def gust_deviations(wind: Wind, altitude: float) -> np.ndarray:
    """σ of gusts along, across and vertical, (3,) [m/s]."""
    if wind.gusts == "dryden":
        return dryden_parameters(altitude, wind.speed).deviations
    return (wind.gusts != "none") * wind.deviation * np.array([1.0, 1.0, 0.5])


@compilable
def strongest_gust(mean, deviation):
    """What the strongest gust counts as, 3σ above the mean [m/s]."""
    return mean + 3 * deviation


def why_grounded(uav: UAV, wind: Wind, altitude: float = 30.0) -> tuple[str, ...]:
    """`grounded_by` in a wind."""
    gust = strongest_gust(wind.speed, float(gust_deviations(wind, altitude)[0]))
    rain = float(rain_force(wind.rain_mm_per_h, uav.rain_area))
    return limits_broken(uav, wind.speed, gust, rain, wind.air_density, CREEP)
