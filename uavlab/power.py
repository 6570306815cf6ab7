"""What flight costs: momentum theory of rotors, and the power that a multirotor takes from its battery.

A rotor that pulls with T pushes air down with the induced velocity w (Glauert 1926). Its shaft turns against the thrust
times the speed of the air through the disc, which holds the climb and the drag of the body, and against the drag of its
own blades. Whatever the flight, that is where the energy goes.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.compiled import compiled
from uavlab.vehicle import INDUCED, STANDARD_AIR, UAV
from uavlab.weather import ground_speed_held, rain_force, wind_drag
from uavlab.weather.envelope import CREEP

BLADE_LOADING = 0.012
"""Thrust coefficient T/(ρ A U²), tip speed U; of small rotors 0.01 to 0.015, whatever they pull, as U follows."""

ADVANCE = 4.65
"""By how much the drag of blades grows with the square of the advance ratio V/U (Leishman 2006, 5.4)."""

NEWTON = 12
"""Steps of Newton's method at most; four or five are enough."""


class Power(NamedTuple):
    """What the power of a flight is spent on [W]; each a number, or an array.

    See Also
    --------
    power_needed : makes it.

    Examples
    --------
    >>> from uavlab.power import power_needed
    >>> from uavlab.vehicle import LIGHT_QUADROTOR
    >>> power_needed(LIGHT_QUADROTOR, velocity=(0.0, 0.0, 0.0))
    <Power: induced 92.7, profile 41.7, useful 0.0, battery 179.2 W>
    """

    induced: np.ndarray
    """On pushing air down."""
    profile: np.ndarray
    """On the drag of the blades."""
    useful: np.ndarray
    """Thrust times the speed of the UAV through the air: climb and drag of the body. Negative in descent."""
    battery: np.ndarray
    """All of it over the efficiency of the drive; at least 0: what a fast descent would give back is lost."""

    def __repr__(self) -> str:
        spans = [f"{np.min(part):.1f}" + f" to {np.max(part):.1f}" * (np.size(part) > 1) for part in self]
        return f"<Power: {', '.join(f'{name} {span}' for name, span in zip(self._fields, spans, strict=True))} W>"


@compiled
def induced_velocity(hover, through, across):
    """Induced velocity w of a rotor, Glauert: w √(V_∥² + (V_n + w)²) = w_h².

    Vertical descent at up to twice w_h has no momentum theory, as the rotor works in its own wake (vortex ring). There
    this goes on along the branch of climbs, which asks for up to a fifth of the ideal hover power less than what was
    measured on rotors (Leishman 2006, 2.13.5).

    Parameters
    ----------
    hover : float
        w_h = √(T/(2 ρ A)), the induced velocity in hover [m/s], at least 0.
    through, across : float
        V_n, speed of the UAV through the air along the thrust, and V_∥, across it [m/s].

    Returns
    -------
    float
        w [m/s].

    See Also
    --------
    rotor_power : the power that it costs.

    References
    ----------
    H. Glauert, A General Theory of the Autogyro, Aeronautical Research Committee, Reports and Memoranda 1111, 1926.

    J. G. Leishman, Principles of Helicopter Aerodynamics, 2006.

    Examples
    --------
    >>> from uavlab.power import induced_velocity
    >>> [round(induced_velocity(5.0, 0.0, across), 2) for across in (0.0, 5.0, 20.0)]  # less in forward flight
    [5.0, 3.93, 1.25]
    >>> [round(induced_velocity(5.0, through, 0.0), 2) for through in (-5.0, 0.0, 5.0)]  # less in climb
    [8.09, 5.0, 3.09]
    """
    low, high = 0.0, hover + max(-through, 0.0)
    induced = high
    for _ in range(NEWTON):
        flow = through + induced
        speed = math.sqrt(across * across + flow * flow)
        surplus = induced * speed - hover * hover
        if surplus > 0:
            high = induced
        else:
            low = induced
        slope = speed + induced * flow / speed if speed > 0 else 0.0
        following = induced - surplus / slope if slope > 0 else low
        if not low <= following <= high:
            following = (low + high) / 2
        if abs(following - induced) <= 1e-9 * hover:
            return following
        induced = following
    return induced


@compiled
def rotor_power(thrust, hover, through, across, profile):
    """Induced, profile and useful power of rotors.

    P_i = κ T w, P_0 = p T w_h (1 + c/2 · 4.65 (V_∥/w_h)²), P_u = T V_n, with w of `induced_velocity`, κ = 1.15 and the
    blade loading c = 0.012

    Parameters
    ----------
    thrust : float
        T [N], at least 0.
    hover, through, across : float
        w_h, V_n and V_∥ [m/s] as for `induced_velocity`.
    profile : float
        p, share of the ideal hover power, `profile_share`.

    Returns
    -------
    induced, profile, useful : float
        [W]

    See Also
    --------
    power_needed : of a UAV that moves through wind.

    References
    ----------
    J. G. Leishman, Principles of Helicopter Aerodynamics, 2006, 5.4.

    Examples
    --------
    >>> from uavlab.power import rotor_power
    >>> [round(part, 1) for part in rotor_power(15.0, 5.0, 0.0, 0.0, 0.5)]
    [86.2, 37.5, 0.0]
    >>> [round(part, 1) for part in rotor_power(15.0, 5.0, 0.0, 12.0, 0.5)]
    [35.4, 43.5, 0.0]
    """
    induced = INDUCED * thrust * induced_velocity(hover, through, across)
    advance = 0.0 if hover == 0 else BLADE_LOADING / 2 * (across / hover) ** 2
    return induced, profile * thrust * hover * (1 + ADVANCE * advance), thrust * through


def profile_share(uav: UAV) -> float:
    """What the drag of the blades takes in hover, over the ideal power: what the figure of merit leaves for it.

    p = 1/FM − κ, κ = 1.15

    Parameters
    ----------
    uav : UAV
        With its `figure_of_merit` FM.

    Returns
    -------
    float
        p, above 0.

    Raises
    ------
    ValueError
        If `uav` is no UAV.

    See Also
    --------
    rotor_power : takes it.

    Examples
    --------
    >>> from uavlab.power import profile_share
    >>> from uavlab.vehicle import LIGHT_QUADROTOR
    >>> round(profile_share(LIGHT_QUADROTOR), 2)
    0.52
    """
    checks.instance("uav", uav, UAV)
    return 1 / uav.figure_of_merit - INDUCED


def power_needed(
    uav: UAV,
    velocity: npt.ArrayLike,
    wind: npt.ArrayLike = (0.0, 0.0, 0.0),
    *,
    rain_mm_per_h: float = 0.0,
    air_density: float = STANDARD_AIR,
) -> Power:
    """Power of steady flight: thrust holds weight, rain and the drag of the body.

    P = κ T w + P₀ (1 + 4.65 (V/U)²) + T·V over the efficiency of the drive, with V through the air, w of Glauert,
    κ = 1.15. P₀ is what the figure of merit leaves in hover beside κ T w_h; it grows with T^1.5 as w_h does.

    Parameters
    ----------
    uav : UAV
        With its payload.
    velocity : (..., 3) or (..., 2) array
        Over ground [m/s].
    wind : (2,) or (3,) array
        Where the air moves to [m/s].
    rain_mm_per_h : float
        Rain rate [mm/h], at least 0.
    air_density : float
        ρ [kg/m³], above 0.

    Returns
    -------
    Power
        Its parts (...) [W]. Whether the rotors can pull so hard isn't asked: `feasibility` and `fly` do.

    Raises
    ------
    ValueError
        If `uav` is no UAV, `velocity` or `wind` is not made of two or three finite numbers, `rain_mm_per_h` is
        negative, or `air_density` is not above 0.

    See Also
    --------
    energy_per_metre : the same for a metre of way.
    uavlab.vehicle.UAV.hover_power : in hover, in closed form.

    References
    ----------
    H. Glauert, A General Theory of the Autogyro, Aeronautical Research Committee, Reports and Memoranda 1111, 1926.

    J. G. Leishman, Principles of Helicopter Aerodynamics, 2006.

    Examples
    --------
    >>> from uavlab.power import power_needed
    >>> from uavlab.vehicle import LIGHT_QUADROTOR
    >>> velocities = [(speed, 0.0, 0.0) for speed in (0.0, 5.0, 10.0, 15.0)]
    >>> power_needed(LIGHT_QUADROTOR, velocities).battery.round()  # hovering isn't the cheapest
    array([179., 162., 177., 298.])
    """
    checks.instance("uav", uav, UAV)
    rain_mm_per_h = checks.not_negative_number("rain_mm_per_h", rain_mm_per_h)
    air_density = checks.positive_number("air_density", air_density)
    (moving,) = checks.vectors(velocity=velocity)
    air = np.array(checks.three("wind", wind))[: moving.shape[-1]]
    flat = np.zeros((*moving.shape[:-1], 3 - moving.shape[-1]))
    through_air = np.concatenate([moving - air, flat], axis=-1)
    thrust = -wind_drag(np.zeros(3), through_air, uav.drag_area, air_density=air_density)
    thrust[..., 2] += uav.weight + rain_force(rain_mm_per_h, uav.rain_area)
    pulled = np.linalg.norm(thrust, axis=-1)
    through = (thrust * through_air).sum(axis=-1) / pulled
    across = np.sqrt(np.maximum((through_air**2).sum(axis=-1) - through**2, 0.0))
    hover = np.sqrt(pulled / (2 * air_density * uav.rotor_area))
    parts = np.vectorize(rotor_power, otypes=[float] * 3)(pulled, hover, through, across, profile_share(uav))
    induced, profile, useful = parts
    battery = np.maximum(induced + profile + useful, 0.0) / uav.drive_efficiency
    return Power(induced, profile, useful, battery)


def energy_per_metre(
    uav: UAV,
    direction: npt.ArrayLike,
    wind: npt.ArrayLike = (0.0, 0.0, 0.0),
    *,
    speed: float | None = None,
    rain_mm_per_h: float = 0.0,
    air_density: float = STANDARD_AIR,
) -> np.ndarray:
    """Energy from the battery for a metre of way in a direction, at the speed at which that is planned.

    P/v of steady flight, v as fast as asked or as `ground_speed_held` allows: dear against the wind, as it takes long.

    Parameters
    ----------
    uav : UAV
        With its payload.
    direction : (..., 3) array
        To fly in, any length but 0.
    wind, rain_mm_per_h, air_density
        As for `power_needed`.
    speed : float, optional
        Over ground, if nothing limits it [m/s]; by default the UAV's cruise speed.

    Returns
    -------
    (...) array
        [J/m], at least 0; infinite where the wind leaves no way.

    Raises
    ------
    ValueError
        If `uav` is no UAV, `direction` is not of shape (..., 3), not finite or of length 0, `speed` or `air_density` is
        not above 0, `rain_mm_per_h` is negative, or `wind` is not two or three finite numbers.

    See Also
    --------
    power_needed : the power P.
    uavlab.weather.ground_speed_held : the speed v.
    uavlab.planners.least_energy : the route that takes the least.

    Examples
    --------
    >>> from uavlab.power import energy_per_metre
    >>> from uavlab.vehicle import LIGHT_QUADROTOR
    >>> ways = [(1.0, 0.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 0.0, 1.0)]  # with the wind, against it, up
    >>> energy_per_metre(LIGHT_QUADROTOR, ways, wind=(12.0, 0.0)).round()
    array([32., 77., 71.])
    """
    checks.instance("uav", uav, UAV)
    asked = uav.cruise_speed if speed is None else checks.positive_number("speed", speed)
    rain_mm_per_h = checks.not_negative_number("rain_mm_per_h", rain_mm_per_h)
    air_density = checks.positive_number("air_density", air_density)
    (course,) = checks.vectors(direction=direction)
    size = np.linalg.norm(course, axis=-1, keepdims=True)
    if course.shape[-1:] != (3,) or (size == 0).any():
        raise ValueError(f"direction must have shape (..., 3) and a length above 0, got shape {course.shape}")
    unit = course / size
    held = ground_speed_held(uav, unit, wind, rain_mm_per_h=rain_mm_per_h, air_density=air_density)
    ground_speed = np.minimum(held, asked)
    slow = ground_speed < CREEP
    ground_speed = np.where(slow, asked, ground_speed)
    velocity = ground_speed[..., None] * unit
    power = power_needed(uav, velocity, wind, rain_mm_per_h=rain_mm_per_h, air_density=air_density)
    return np.where(slow, np.inf, power.battery / ground_speed)
