"""The flight envelope: which wind and which rain ground which load.

Three limits, in closed form. Rain and load eat the lift that safety asks for. What thrust is left sideways bounds the
gust that a hovering UAV can hold. And the wind that it flies against bounds the speed over ground. A weather is inside
the envelope when it stays below all three.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.compiled import compiled
from uavlab.vehicle import UAV
from uavlab.weather.forces import GUST_FACTOR, SAFETY_FACTOR, STANDARD_AIR, Weather, lift_margin, rain_force

CREEP = 0.1
"""Who is slower than this over ground gets nowhere [m/s]."""

CRUISE = 0.8
"""Share of the thrust left over sideways that steady drag may take on a planned flight."""


def wind_limit(
    uav: UAV,
    rain: npt.ArrayLike = 0.0,
    *,
    air_density: npt.ArrayLike = STANDARD_AIR,
    safety_factor: float = SAFETY_FACTOR,
) -> np.ndarray:
    """Strongest gust that the UAV can just hold in hover.

    V = √(2 R/(ρ C S)): its drag (REPARE Eq. 5) equals the horizontal reserve R(F_r) of the thrust.

    Parameters
    ----------
    uav : UAV
        With its payload.
    rain : float or array
        Force of the rain F_r [N], `rain_force`.
    air_density : float or array
        ρ [kg/m³], above 0.
    safety_factor : float
        δ of REPARE Eq. 2, at least 1.

    Returns
    -------
    float or array
        V [m/s]; 0 where the lift margin isn't positive.

    Raises
    ------
    ValueError
        If `uav` is no UAV, `rain` is negative, `air_density` is not above 0, or `safety_factor` is below 1.

    See Also
    --------
    mean_wind_limit : the limit of the mean wind.
    grounded_by : asks all three limits.
    uavlab.vehicle.UAV.horizontal_reserve : the force that is left against the wind.

    Examples
    --------
    >>> from uavlab.vehicle import LIGHT_QUADROTOR
    >>> from uavlab.weather import wind_limit
    >>> [round(float(wind_limit(LIGHT_QUADROTOR.loaded(load))), 1) for load in (0.0, 0.6, 1.0, 1.2)]
    [25.5, 22.7, 19.2, 0.0]
    """
    checks.instance("uav", uav, UAV)
    checks.positive("air_density", air_density)
    safe = lift_margin(uav, rain, safety_factor=safety_factor) > 0
    held = np.sqrt(2.0 * uav.horizontal_reserve(rain) / (np.asarray(air_density) * uav.drag_area))
    return np.where(safe, held, 0.0)[()]


def course_wind_limit(air_speed: float, ground_speed: npt.ArrayLike, wind_angle: npt.ArrayLike = np.pi) -> np.ndarray:
    """Strongest wind in which the UAV can still fly a course at exactly this ground speed.

    W = V_d cos θ + √(V_uav² − V_d² sin² θ): the wind triangle solved for its third side (law of cosines). A stronger
    wind blows it off the course, stops it or, from behind, makes it faster than asked for.

    Parameters
    ----------
    air_speed : float
        Greatest speed V_uav through the air [m/s], above 0.
    ground_speed : float or array
        Speed to hold over ground V_d [m/s], from 0 to V_uav.
    wind_angle : float or array
        Angle θ between where the wind blows to and the course [rad]; π, the default and the worst, is a head wind.

    Returns
    -------
    float or array
        W [m/s].

    Raises
    ------
    ValueError
        If `air_speed` is not above 0, `ground_speed` is not within 0 and `air_speed`, or `wind_angle` is not finite.

    See Also
    --------
    reachable_ground_speed : the same triangle, solved for the ground speed.
    mean_wind_limit : the limit from any side, with thrust and gusts.

    Examples
    --------
    >>> import numpy as np
    >>> from uavlab.weather import course_wind_limit
    >>> course_wind_limit(10.0, 6.0, np.radians([0.0, 90.0, 180.0])).round(1)  # from behind, across, ahead
    array([16.,  8.,  4.])
    """
    air_speed = checks.positive_number("air_speed", air_speed)
    checks.within("ground_speed", ground_speed, 0.0, air_speed, "m/s, the air_speed")
    checks.finite("wind_angle", wind_angle)
    speed, angle = np.asarray(ground_speed, dtype=float), np.asarray(wind_angle, dtype=float)
    along, across = speed * np.cos(angle), speed * np.sin(angle)
    return along + np.sqrt(air_speed**2 - across**2)


def mean_wind_limit(
    uav: UAV,
    rain: npt.ArrayLike = 0.0,
    *,
    ground_speed: float = 0.0,
    air_density: npt.ArrayLike = STANDARD_AIR,
    safety_factor: float = SAFETY_FACTOR,
    gust_factor: float = GUST_FACTOR,
    keep_speed: bool = False,
) -> np.ndarray:
    """Strongest mean wind, from any side, in which the UAV can fly its mission.

    The least of two: the gust that it holds over the gust factor, and the air speed that it reaches less the ground
    speed that it needs. That air speed is the top speed, or less when the load leaves no thrust for it. The top speed
    limits steady flight; for the seconds of a gust the thrust alone counts.

    W = min(V/G, min(V, V_top) − V_d), V of `wind_limit`, G the gust factor: a gust may slow the UAV down to a halt and
    never pushes it back. With `keep_speed` it flies on against the gust: (V − V_d)/G in place of V/G.

    Parameters
    ----------
    uav : UAV
        With its payload.
    rain, air_density, safety_factor
        As for `wind_limit`.
    ground_speed : float
        Speed to hold over ground V_d [m/s], at least 0; 0 for hovering.
    gust_factor : float
        Strongest gust over mean wind, at least 1.
    keep_speed : bool
        Whether it holds the ground speed against the strongest gust, too.

    Returns
    -------
    float or array
        Mean wind [m/s]; 0 where the UAV is grounded in calm air, by its load, the rain or a ground speed out of reach.

    Raises
    ------
    ValueError
        If `uav` is no UAV, `ground_speed` or `rain` is negative, `air_density` is not above 0, `gust_factor` or
        `safety_factor` is below 1, or `keep_speed` is not True or False.

    See Also
    --------
    wind_limit : the strongest gust.
    grounded_by : the same question for one weather, answered in words.

    Examples
    --------
    >>> from uavlab.vehicle import LIGHT_QUADROTOR
    >>> from uavlab.weather import mean_wind_limit
    >>> [round(float(mean_wind_limit(LIGHT_QUADROTOR, ground_speed=speed)), 1) for speed in (0.0, 5.0, 15.0)]
    [14.5, 13.0, 3.0]
    >>> f"{mean_wind_limit(LIGHT_QUADROTOR, ground_speed=5.0, keep_speed=True):.1f} m/s"
    '11.7 m/s'
    """
    ground_speed = checks.not_negative_number("ground_speed", ground_speed)
    gust_factor = checks.number("gust_factor", gust_factor, checks.at_least_one)
    gust = wind_limit(uav, rain, air_density=air_density, safety_factor=safety_factor)
    against = np.maximum(np.minimum(gust, uav.top_speed) - ground_speed, 0.0)
    left = np.maximum(gust - ground_speed, 0.0) if checks.flag("keep_speed", keep_speed) else gust
    return np.minimum(left / gust_factor, against)


def air_speed_held(uav: UAV, rain: float = 0.0, *, air_density: float = STANDARD_AIR, share: float = 1.0) -> float:
    """Greatest steady speed through the air [m/s]: the top speed, or less where the thrust left over holds less.

    V = min(V_top, √(2 share R(F_r)/(ρ C S))), R the horizontal reserve of the thrust.

    Parameters
    ----------
    uav : UAV
        With its payload.
    rain : float
        Force of the rain F_r [N], at least 0.
    air_density : float
        ρ [kg/m³], above 0.
    share : float
        Of the horizontal reserve that steady drag may take, 0 to 1.

    Returns
    -------
    float
        V [m/s].

    Raises
    ------
    ValueError
        If `uav` is no UAV, `rain` is negative, `air_density` is not above 0, or `share` is not within 0 to 1.

    See Also
    --------
    ground_speed_held : what is left of it over ground.
    wind_limit : the gust that the whole reserve holds.

    Examples
    --------
    >>> from uavlab.vehicle import LIGHT_QUADROTOR
    >>> from uavlab.weather import air_speed_held
    >>> [round(air_speed_held(LIGHT_QUADROTOR.loaded(load), share=0.4), 1) for load in (0.0, 0.6, 1.0)]
    [16.1, 14.4, 12.1]
    """
    checks.instance("uav", uav, UAV)
    rain = checks.not_negative_number("rain", rain)
    air_density = checks.positive_number("air_density", air_density)
    share = checks.number("share", share, checks.within, 0.0, 1.0, "of the reserve")
    return steady_air_speed(uav, rain, air_density, share)


def steady_air_speed(uav: UAV, rain: float, air_density: float = STANDARD_AIR, share: float = 1.0) -> float:
    """`air_speed_held` of arguments that are right."""
    held = share * float(uav.horizontal_reserve(rain))
    return min(uav.top_speed, float(np.sqrt(2.0 * held / (air_density * uav.drag_area))))


def ground_speed_held(
    uav: UAV,
    direction: npt.ArrayLike,
    wind: npt.ArrayLike = (0.0, 0.0, 0.0),
    *,
    rain_mm_per_h: float = 0.0,
    air_density: float = STANDARD_AIR,
    share: float = CRUISE,
) -> np.ndarray:
    """Greatest steady speed over ground along directions, at which a flight is planned.

    The wind triangle (`reachable_ground_speed`) at `air_speed_held`, and no faster up and down than the UAV can.

    V = min(W_∥ + √(V_a² − W_⊥²), V_climb/n_z), with V_a of `air_speed_held`, the wind's parts along and across the
    direction n, and V_sink/|n_z| on the way down.

    Parameters
    ----------
    uav : UAV
        With its payload.
    direction : (..., 3) array
        Unit vectors.
    wind : (2,) or (3,) array
        Mean wind, where the air moves to [m/s].
    rain_mm_per_h : float
        Rain rate [mm/h], at least 0.
    air_density : float
        ρ [kg/m³], above 0.
    share : float
        Of the horizontal reserve that steady drag may take, 0 to 1; the rest is for gusts and turns.

    Returns
    -------
    (...) array
        V [m/s]; −∞ where the wind blows it off its course.

    Raises
    ------
    ValueError
        If `uav` is no UAV, `direction` is not of shape (..., 3) or not finite, `wind` is not two or three finite
        numbers, `rain_mm_per_h` is negative, `air_density` is not above 0, or `share` is not within 0 to 1.

    See Also
    --------
    reachable_ground_speed : the wind triangle alone.
    air_speed_held : the speed through the air that it starts from.

    Examples
    --------
    >>> from uavlab.vehicle import LIGHT_QUADROTOR
    >>> from uavlab.weather import ground_speed_held
    >>> ways = [(1.0, 0.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 0.0, 1.0)]  # with the wind, against it, up
    >>> ground_speed_held(LIGHT_QUADROTOR, ways, wind=(6.0, 0.0)).round(1)
    array([24., 12.,  5.])
    """
    checks.instance("uav", uav, UAV)
    mean, along_it = np.array(checks.three("wind", wind)), checks.array("direction", direction, ..., 3)
    rain = float(rain_force(checks.number("rain_mm_per_h", rain_mm_per_h), uav.rain_area))
    fastest = air_speed_held(uav, rain, air_density=air_density, share=share)
    ways = np.ascontiguousarray(along_it.reshape(-1, 3))
    return speeds_over_ground(ways, mean, fastest, uav.climb_speed, uav.sink_speed).reshape(along_it.shape[:-1])


@compiled
def speeds_over_ground(directions, wind, fastest, climb, sink):
    """`speed_over_ground` along each of the directions (M, 3)."""
    speeds = np.empty(len(directions))
    for m in range(len(directions)):
        speeds[m] = speed_over_ground(directions[m], wind, fastest, climb, sink)
    return speeds


@compiled
def speed_over_ground(direction, wind, fastest, climb, sink):
    """The wind triangle along one direction (3,) at an air speed, and no faster up and down than that [m/s]."""
    along = direction[0] * wind[0] + direction[1] * wind[1] + direction[2] * wind[2]
    across = math.sqrt(max(wind[0] ** 2 + wind[1] ** 2 + wind[2] ** 2 - along**2, 0.0))
    if across >= fastest:
        return -np.inf
    level = along + math.sqrt(max(fastest**2 - across**2, 0.0))
    if direction[2] == 0.0:
        return level
    return min(level, (climb if direction[2] > 0 else sink) / abs(direction[2]))


def grounded_by(
    uav: UAV, weather: Weather, *, ground_speed: float = 0.0, safety_factor: float = SAFETY_FACTOR
) -> tuple[str, ...]:
    """What keeps the UAV on the ground in this weather: the one rule that flights, planners and pages ask.

    Weight and rain take the lift that safety asks for (REPARE Eq. 2); the strongest gust pushes harder than the thrust
    holds; or the mean wind leaves no way against it. The reference wind (REPARE Eq. 3) gives the mean wind and the
    gust; the wind may come from any side.

    Parameters
    ----------
    uav : UAV
        With its payload.
    weather : Weather
        With its wind and rain.
    ground_speed : float
        Speed to hold over ground V_d [m/s], at least 0.
    safety_factor : float
        δ of REPARE Eq. 2, at least 1.

    Returns
    -------
    tuple of str
        One sentence for each limit that is broken; empty when it may fly.

    Raises
    ------
    ValueError
        If `uav` is no UAV, `weather` is no Weather, `ground_speed` is negative, or `safety_factor` is below 1.

    See Also
    --------
    wind_limit, mean_wind_limit : the limits as numbers.
    uavlab.resilience.resilience_level : the paper's own table of when not to fly.

    Examples
    --------
    >>> from uavlab.vehicle import LIGHT_QUADROTOR
    >>> from uavlab.weather import Weather, grounded_by
    >>> grounded_by(LIGHT_QUADROTOR, Weather(forecast_wind=6.0))
    ()
    >>> grounded_by(LIGHT_QUADROTOR.loaded(1.0), Weather(forecast_wind=12.0))
    ('gusts: 21.0 m/s, and the thrust left over holds 19.2 m/s',)
    """
    checks.instance("uav", uav, UAV)
    checks.instance("weather", weather, Weather)
    ground_speed = checks.not_negative_number("ground_speed", ground_speed)
    mean, gust = weather.reference_wind
    rain = float(rain_force(weather.rain_mm_per_h, uav.rain_area))
    return limits_broken(uav, mean, gust, rain, weather.air_density, ground_speed, safety_factor)


def limits_broken(
    uav: UAV,
    mean: float,
    gust: float,
    rain: float,
    air_density: float,
    ground_speed: float = 0.0,
    safety_factor: float = SAFETY_FACTOR,
) -> tuple[str, ...]:
    """`grounded_by` for a mean wind and a gust [m/s] and a force of rain [N]."""
    margin = lift_margin(uav, rain, safety_factor=safety_factor)
    if margin <= 0:
        return (f"lift: {-margin:.2f} N short of {safety_factor:g} times weight and rain",)
    held = float(wind_limit(uav, rain, air_density=air_density, safety_factor=safety_factor))
    speed = steady_air_speed(uav, rain, air_density)
    reasons = []
    if gust > held:
        reasons.append(f"gusts: {gust:.1f} m/s, and the thrust left over holds {held:.1f} m/s")
    if mean > speed - ground_speed:
        reasons.append(f"head wind: {mean:.1f} m/s of {speed:.1f} m/s air speed leave less than {ground_speed:g} m/s")
    return tuple(reasons)
