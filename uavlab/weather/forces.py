"""From the weather to forces: the density of air, rain from above, wind from the side, and wind along a course.

REPARE Eqs 1-5, each in the form that has the right unit and sign; `as_printed=True` gives the paper's. Forces are in
newtons, speeds in m/s. Wind is where the air moves to: a vector (east, north) or (east, north, up). Only the
meteorologist's direction, in `Weather`, is where the wind comes from.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.vehicle import STANDARD_AIR, UAV

WATER_DENSITY = 1000.0
"""Of rain [kg/m³]."""

DROP_SPEED = 9.0
"""Fall speed of large drops, about 5 mm wide [m/s]; drops of drizzle fall at 2 m/s."""

SAFETY_FACTOR = 1.1
"""δ of Eq. 2. REPARE gives no number; 1.1 leaves a margin and lets the heaviest load of its Table 3 fly."""

GUST_FACTOR = 1.75
"""Of the strongest gust to the mean wind, that of Eurocode 1 at 30 m over a city (EN 1991-1-4, section 4): √(1 + 7 I)
with the turbulence intensity I = 1/ln(30 m/1 m). Over open land it is 1.45."""

DRY_AIR, WATER_VAPOUR = 287.05, 461.5  # gas constants [J/(kg K)]


@dataclass(frozen=True)
class Weather:
    """One state of the weather, as a forecast or a station gives it.

    Attributes
    ----------
    temperature_c : float
        Air temperature [°C], −60 to 60.
    humidity_percent : float
        Relative humidity [%], 0 to 100.
    pressure_hpa : float
        Air pressure at the place [hPa], 300 to 1100.
    forecast_wind, forecast_max_wind : float
        Mean and strongest wind of the forecast, V_μF and V_MaxF [m/s].
    measured_wind : float
        Mean wind that the UAV measures, V_μS [m/s].
    wind_from_deg : float
        Where the wind comes from [degrees], clockwise from north, 0 to 360.
    rain_mm_per_h : float
        Rain rate [mm/h]; above 50 is a cloudburst.
    radiation : float
        Global horizontal solar radiation [W/m²].

    Raises
    ------
    ValueError
        If `temperature_c`, `humidity_percent`, `pressure_hpa` or `wind_from_deg` is outside of the range above, another
        attribute is negative, or one is not a single finite number. A pressure in Pa is recognised.

    See Also
    --------
    Wind : moving air as a flight has it, from `Wind.from_weather`.
    grounded_by : what keeps a UAV on the ground in this weather.
    read_weather : states of the weather from a file.

    Examples
    --------
    >>> from uavlab.weather import Weather
    >>> weather = Weather(temperature_c=30.0, forecast_wind=6.0, measured_wind=7.0, wind_from_deg=270.0)
    >>> weather
    <Weather: 30 °C, 50 %, 1013 hPa, wind 7 m/s from 270°, gusts 12.2 m/s, rain 0 mm/h>
    >>> round(weather.air_density, 3)
    1.155
    >>> weather.wind_direction.round(2)
    array([1., 0.])
    """

    temperature_c: float = 15.0
    humidity_percent: float = 50.0
    pressure_hpa: float = 1013.25
    forecast_wind: float = 0.0
    forecast_max_wind: float = 0.0
    measured_wind: float = 0.0
    wind_from_deg: float = 0.0
    rain_mm_per_h: float = 0.0
    radiation: float = 0.0

    def __post_init__(self) -> None:
        checks.set_fields(self, checks.number, "temperature_c", "humidity_percent", "pressure_hpa", "wind_from_deg")
        checks.air(self.temperature_c, self.humidity_percent, self.pressure_hpa)
        winds = "forecast_wind", "forecast_max_wind", "measured_wind"
        checks.set_fields(self, checks.not_negative_number, *winds, "rain_mm_per_h", "radiation")
        checks.within("wind_from_deg", self.wind_from_deg, 0.0, 360.0, "degrees")

    def __repr__(self) -> str:
        mean, gust = self.reference_wind
        air = f"{self.temperature_c:.3g} °C, {self.humidity_percent:.3g} %, {self.pressure_hpa:.0f} hPa"
        wind = f"wind {mean:.3g} m/s from {self.wind_from_deg:.0f}°, gusts {gust:.3g} m/s"
        return f"<Weather: {air}, {wind}, rain {self.rain_mm_per_h:.3g} mm/h>"

    @property
    def air_density(self) -> float:
        """Density of the moist air [kg/m³]."""
        return float(air_density(self.temperature_c, self.humidity_percent, self.pressure_hpa))

    @property
    def reference_wind(self) -> ReferenceWind:
        """The wind to reckon with, Eq. 3."""
        return reference_wind(self.forecast_wind, self.measured_wind, self.forecast_max_wind)

    @property
    def wind_direction(self) -> np.ndarray:
        """Unit vector (east, north) of where the wind blows to."""
        angle = np.radians(self.wind_from_deg)
        return np.array([-np.sin(angle), -np.cos(angle)])


class ReferenceWind(NamedTuple):
    """Mean wind and gust to reckon with [m/s].

    Attributes
    ----------
    mean, gust : float
        V_res of REPARE Eq. 3, and the strongest gust [m/s].

    See Also
    --------
    reference_wind : from forecast and measurement.

    Examples
    --------
    >>> from uavlab.weather import Weather
    >>> Weather(forecast_wind=4.0).reference_wind
    ReferenceWind(mean=4.0, gust=7.0)
    """

    mean: float
    gust: float


def air_density(
    temperature_c: npt.ArrayLike, humidity_percent: npt.ArrayLike, pressure_hpa: npt.ArrayLike
) -> np.ndarray:
    """Density of moist air: that of dry air and of water vapour at their partial pressures.

    ρ = (p − e)/(R_d T) + e/(R_v T), e = humidity · 6.112 hPa · exp(17.62 t/(243.12 + t)) (Magnus formula, WMO).

    Parameters
    ----------
    temperature_c : float or array
        Temperature t [°C], −60 to 60.
    humidity_percent : float or array
        Relative humidity [%], 0 to 100.
    pressure_hpa : float or array
        Pressure p [hPa], 300 to 1100.

    Returns
    -------
    array
        ρ [kg/m³]; moist air is lighter than dry air.

    Raises
    ------
    ValueError
        If `temperature_c` is not within −60 to 60, `humidity_percent` 0 to 100, or `pressure_hpa` 300 to 1100. A
        pressure in Pa is recognised.

    See Also
    --------
    wind_drag : the force that grows with it.

    References
    ----------
    World Meteorological Organization, Guide to Meteorological Instruments and Methods of Observation, WMO-No. 8, 2008.

    Examples
    --------
    >>> from uavlab.weather import air_density
    >>> air_density([0.0, 15.0, 30.0], 0.0, 1013.25).round(3)
    array([1.292, 1.225, 1.164])
    >>> air_density(30.0, [0.0, 100.0], 1013.25).round(3)
    array([1.164, 1.146])
    """
    checks.air(temperature_c, humidity_percent, pressure_hpa)
    celsius = np.asarray(temperature_c, dtype=float)
    kelvin = celsius + 273.15
    vapour = np.asarray(humidity_percent) * 6.112 * np.exp(17.62 * celsius / (243.12 + celsius))  # [Pa]: % · hPa
    return (100.0 * np.asarray(pressure_hpa) - vapour) / (DRY_AIR * kelvin) + vapour / (WATER_VAPOUR * kelvin)


def rain_force(
    rain_mm_per_h: npt.ArrayLike,
    area: float,
    *,
    drop_speed: float = DROP_SPEED,
    restitution: float = 0.0,
    as_printed: bool = False,
) -> np.ndarray:
    """Downward force of rain on the body, REPARE Eq. 1.

    F = ρ (H/t) S V (1 + e): the momentum that falls on the area each second, and that with which drops bounce.

    Parameters
    ----------
    rain_mm_per_h : float or array
        Rain rate H/t [mm/h], at least 0.
    area : float
        Area S seen from above [m²], above 0.
    drop_speed : float
        Fall speed V of the drops [m/s]; 2 to 9.
    restitution : float
        Share e of their speed with which drops bounce, 0 (they stick) to 1.
    as_printed : bool
        H ρ V (1 − η)/t, η = 1 − e: the area is missing, so it is a pressure [Pa], and it vanishes when drops stick.

    Returns
    -------
    array
        F [N].

    Raises
    ------
    ValueError
        If `rain_mm_per_h` is negative, `area` or `drop_speed` is not above 0, `restitution` is not within 0 to 1, or
        `as_printed` is not True or False.

    See Also
    --------
    lift_margin : whether the rotors carry it.

    References
    ----------
    R. Gunn and G. D. Kinzer, The Terminal Velocity of Fall for Water Droplets in Stagnant Air, Journal of Meteorology,
    1949: drops of 5 mm fall at 9 m/s.

    Examples
    --------
    >>> from uavlab.weather import rain_force
    >>> rain_force([10.0, 50.0, 100.0], area=0.1).round(4)
    array([0.0025, 0.0125, 0.025 ])
    """
    checks.not_negative("rain_mm_per_h", rain_mm_per_h)
    area, drop_speed = checks.positive_number("area", area), checks.positive_number("drop_speed", drop_speed)
    sticking = "(0: drops stick, 1: they bounce back)"
    restitution = checks.number("restitution", restitution, checks.within, 0.0, 1.0, sticking)
    pressure = WATER_DENSITY * np.asarray(rain_mm_per_h, dtype=float) / 3.6e6 * drop_speed
    return pressure * restitution if checks.flag("as_printed", as_printed) else pressure * area * (1.0 + restitution)


def lift_margin(
    uav: UAV, rain: npt.ArrayLike = 0.0, *, safety_factor: float = SAFETY_FACTOR, as_printed: bool = False
) -> np.ndarray:
    """Thrust left above what safety asks for, REPARE Eq. 2.

    F_zMax − δ (G_uav + G_s + F_r); safe when above 0.

    Parameters
    ----------
    uav : UAV
        With its payload.
    rain : float or array
        Force of the rain F_r [N], `rain_force`.
    safety_factor : float
        δ, at least 1; 1.1 to 2.
    as_printed : bool
        F_zMax − δ (G_uav + G_s) − F_r: the rain stands outside of the safety factor.

    Returns
    -------
    array
        Margin [N]; negative: don't take off.

    Raises
    ------
    ValueError
        If `uav` is no UAV, `rain` is negative, `safety_factor` is below 1, or `as_printed` is not True or False.

    See Also
    --------
    rain_force : the force of the rain, REPARE Eq. 1.
    wind_limit : the gust that the rest of the thrust can hold.

    Examples
    --------
    >>> from uavlab.vehicle import LIGHT_QUADROTOR
    >>> from uavlab.weather import lift_margin
    >>> [round(float(lift_margin(LIGHT_QUADROTOR.loaded(load), rain=0.1)), 2) for load in (0.0, 1.0, 1.3)]
    [11.7, 0.91, -2.32]
    """
    checks.instance("uav", uav, UAV)
    checks.not_negative("rain", rain)
    safety_factor = checks.number("safety_factor", safety_factor)
    checks.at_least_one("safety_factor", safety_factor)
    counted = np.asarray(rain, dtype=float) * (1.0 if checks.flag("as_printed", as_printed) else safety_factor)
    return uav.thrust - safety_factor * uav.weight - counted


def reference_wind(
    forecast_mean: float,
    measured_mean: float,
    forecast_max: float = 0.0,
    *,
    gust_factor: float = GUST_FACTOR,
    as_printed: bool = False,
) -> ReferenceWind:
    """Wind to reckon with, REPARE Eq. 3.

    V_res = max(V_μF, V_μS), and the gust max(V_MaxF, gust factor · V_res).

    Parameters
    ----------
    forecast_mean, measured_mean, forecast_max : float
        V_μF, V_μS and V_MaxF [m/s], at least 0.
    gust_factor : float
        Strongest gust over mean wind, at least 1.
    as_printed : bool
        Take V_res for the gust as well: the paper introduces V_MaxF and never uses it.

    Returns
    -------
    ReferenceWind
        Mean and gust [m/s].

    Raises
    ------
    ValueError
        If `forecast_mean`, `measured_mean` or `forecast_max` is negative, `gust_factor` is below 1, or `as_printed` is
        not True or False.

    See Also
    --------
    mean_wind : the mean that the UAV measures.
    Weather : has this as its `reference_wind`.

    Examples
    --------
    >>> from uavlab.weather import reference_wind
    >>> reference_wind(forecast_mean=4.0, measured_mean=6.0, forecast_max=9.0)
    ReferenceWind(mean=6.0, gust=10.5)
    """
    forecast_mean = checks.not_negative_number("forecast_mean", forecast_mean)
    measured_mean = checks.not_negative_number("measured_mean", measured_mean)
    forecast_max = checks.not_negative_number("forecast_max", forecast_max)
    gust_factor = checks.number("gust_factor", gust_factor, checks.at_least_one)
    mean = max(forecast_mean, measured_mean)
    return ReferenceWind(mean, mean if checks.flag("as_printed", as_printed) else max(forecast_max, gust_factor * mean))


def reachable_ground_speed(air_speed: float, wind: npt.ArrayLike, course: npt.ArrayLike) -> np.ndarray:
    """Ground speed along a course at full air speed, in place of REPARE Eq. 4.

    V = √(V_uav² − V_⊥²) + V_∥, with the wind's parts along and across the course. The UAV points into the crosswind so
    that the two cancel. Eq. 4 as printed compares vectors, which has no meaning; compare this with V_d.

    Parameters
    ----------
    air_speed : float
        Greatest speed V_uav through the air [m/s], above 0.
    wind : (..., D) array
        Where the air moves to [m/s].
    course : (..., D) array
        Direction to fly, any length but 0.

    Returns
    -------
    (...) array
        V [m/s]; negative when the head wind is stronger than the UAV.

    Raises
    ------
    ValueError
        If `air_speed` is not above 0 or less than the crosswind, as no heading then holds the course; if `wind` or
        `course` is not made of two or three finite numbers, or `course` has no length.

    See Also
    --------
    course_wind_limit : the strongest wind for a ground speed.
    ground_speed_held : the same for a UAV, with its thrust and vertical speeds.

    Examples
    --------
    >>> from uavlab.weather import reachable_ground_speed
    >>> winds = [(6.0, 0.0), (0.0, 6.0), (-6.0, 0.0)]  # from behind, across, ahead
    >>> reachable_ground_speed(10.0, winds, course=(1.0, 0.0)).round(2)
    array([16.,  8.,  4.])
    """
    air_speed = checks.positive_number("air_speed", air_speed)
    wind, course = checks.vectors(wind=wind, course=course)
    size = np.linalg.norm(course, axis=-1, keepdims=True)
    if (size == 0).any():
        raise ValueError("course must be a direction, got one of length 0")
    direction = course / size
    along = (wind * direction).sum(axis=-1)
    across = np.linalg.norm(wind - along[..., None] * direction, axis=-1)
    if (across > air_speed).any():
        raise ValueError(
            f"crosswind of {np.max(across):.1f} m/s is above air_speed {air_speed:g} m/s: no heading holds the course; "
            "wait, or turn into the wind"
        )
    return np.sqrt(air_speed**2 - across**2) + along


def wind_drag(
    wind: npt.ArrayLike,
    ground_velocity: npt.ArrayLike,
    drag_area: float,
    *,
    air_density: npt.ArrayLike = STANDARD_AIR,
    as_printed: bool = False,
) -> np.ndarray:
    """Drag of the wind on the body, REPARE Eq. 5.

    F = ½ ρ C S |V_rel| V_rel, V_rel = wind − ground velocity.

    Parameters
    ----------
    wind, ground_velocity : (..., D) arrays
        Where the air and the UAV move to [m/s].
    drag_area : float
        C·S [m²], above 0.
    air_density : float or (...) array
        ρ [kg/m³], above 0.
    as_printed : bool
        ½ C ρ S V_d, with the ground velocity for V_d: linear in the speed, so not a force, and without the wind.

    Returns
    -------
    (..., D) array
        F [N], in the direction in which the air pushes.

    Raises
    ------
    ValueError
        If `drag_area` or `air_density` is not above 0, `wind` or `ground_velocity` is not made of two or three finite
        numbers, both don't have as many, or `as_printed` is not True or False.

    See Also
    --------
    air_density : ρ of moist air.
    wind_limit : the wind whose drag the UAV can just hold.

    Examples
    --------
    >>> from uavlab.weather import wind_drag
    >>> hover = wind_drag((10.0, 0.0), (0.0, 0.0), drag_area=0.06)
    >>> twice = wind_drag((20.0, 0.0), (0.0, 0.0), drag_area=0.06)
    >>> f"{hover[0]:.2f} N, and {twice[0] / hover[0]:.0f} times that in twice the wind"
    '3.67 N, and 4 times that in twice the wind'
    """
    drag_area = checks.positive_number("drag_area", drag_area)
    checks.positive("air_density", air_density)
    wind, ground_velocity = checks.vectors(wind=wind, ground_velocity=ground_velocity)
    half = 0.5 * np.asarray(air_density, dtype=float)[..., None] * drag_area
    if checks.flag("as_printed", as_printed):
        return half * ground_velocity
    relative = wind - ground_velocity
    return half * np.linalg.norm(relative, axis=-1, keepdims=True) * relative
