"""What comes down when a UAV fails: how fast, how hard, how far ahead, and over how large an area.

The papers let the wreck keep its forward speed and fall with drag downwards only, which has a closed form (RISK-ACO
Eq. 7, PSO-BAS Eq. 5). The full ballistic fall, where the drag acts against the whole velocity, has none; it is here
to judge the closed form, and because the wreck of a UAV at 16 m/s doesn't land where it failed.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.vehicle import GRAVITY, RISK_QUADROTOR, UAV

AIR_DENSITY = 1.225
"""ρ_A [kg/m³] (RISK-ACO and PSO-BAS Table 2). Their g = 9.8 m/s² is `uavlab.vehicle.GRAVITY`, 9.81, here."""

PERSON_RADIUS, PERSON_HEIGHT = 0.25, 1.65
"""r_p and h_p [m] (RISK-ACO and PSO-BAS Table 2)."""

HIGHEST = 50_000.0
"""From which a fall is followed [m]; air as dense as on the ground is wrong long before."""


def terminal_speed(uav: UAV = RISK_QUADROTOR, *, air_density: float = AIR_DENSITY) -> float:
    """Speed at which drag carries the weight, √(2 m g / (R_I A ρ_A)); 62.6 m/s with the papers' values.

    Parameters
    ----------
    uav : UAV
        Its mass m with payload, and its drag area R_I·A as a wreck.
    air_density : float
        ρ_A [kg/m³], above 0; 1.225 at sea level, 1.0 at 2000 m.

    Returns
    -------
    float
        [m/s]

    Raises
    ------
    ValueError
        If `air_density` is not one number that is above 0 and finite, or `uav` is no `UAV`.

    See Also
    --------
    fall_speed : how near a fall from a height comes to it.

    Examples
    --------
    >>> from uavlab.risk import terminal_speed
    >>> from uavlab.vehicle import RISK_QUADROTOR
    >>> round(terminal_speed(), 1), round(terminal_speed(RISK_QUADROTOR.loaded(0.5)), 1)
    (62.6, 73.1)
    """
    checks.instance("uav", uav, UAV)
    air_density = checks.positive_number("air_density", air_density)
    area = uav.drag_area if uav.fall_drag_area is None else uav.fall_drag_area
    return float(np.sqrt(2 * uav.weight / (area * air_density)))


def fall_speed(
    height: npt.ArrayLike, uav: UAV = RISK_QUADROTOR, *, air_density: float = AIR_DENSITY, as_printed: bool = False
) -> np.ndarray:
    """Vertical speed after a fall from rest with quadratic drag (RISK-ACO Eq. 7, PSO-BAS Eq. 5).

    V_y = √((2 m g / (R_I A ρ_A)) · (1 − exp(−h R_I A ρ_A / m)))

    Parameters
    ----------
    height : float or array
        h [m], at least 0.
    uav : UAV
        Its mass with payload, and its drag area R_I·A as a wreck.
    air_density : float
        ρ_A [kg/m³].
    as_printed : bool
        Half the exponent: V_y² → g h instead of 2 g h for small h, so half of the energy is lost. At 30 m it gives
        16.8 instead of 23.4 m/s.

    Returns
    -------
    float or array
        V_y [m/s], the shape of `height`.

    Raises
    ------
    ValueError
        If `height` is negative or not finite, `air_density` is not above 0 and finite, `uav` is no `UAV`, or
        `as_printed` isn't True or False.

    See Also
    --------
    ballistic_fall : with drag on the forward speed too.
    terminal_speed : the limit for a long fall.

    Examples
    --------
    >>> from uavlab.risk import fall_speed
    >>> fall_speed([10, 30, 60]).round(1)
    array([13.8, 23.4, 31.9])
    >>> fall_speed([10, 30, 60], as_printed=True).round(1)  # as of half the height
    array([ 9.8, 16.8, 23.4])
    """
    checks.not_negative("height", drop := checks.numbers("height", height))
    fastest = terminal_speed(uav, air_density=air_density)
    exponent = -2 * GRAVITY * drop / fastest**2
    return fastest * np.sqrt(-np.expm1(exponent / 2 if checks.flag("as_printed", as_printed) else exponent))


class Fall(NamedTuple):
    """Where and how a wreck arrives; each of the shape of the height asked for.

    See Also
    --------
    ballistic_fall : what gives one.

    Examples
    --------
    >>> from uavlab.risk import ballistic_fall
    >>> fall = ballistic_fall(30.0)
    >>> fall
    <Fall of 2.5 s: lands 38.2 m ahead, at 14.1 m/s forward and 23.1 m/s down>
    >>> round(float(fall.drift), 1)
    38.2
    """

    duration: np.ndarray
    """Of the fall [s]."""
    drift: np.ndarray
    """How far ahead of the failure it lands [m]."""
    forward_speed: np.ndarray
    """Horizontal speed when it lands [m/s]."""
    fall_speed: np.ndarray
    """Vertical speed when it lands [m/s], positive downwards."""

    def __repr__(self) -> str:
        if not np.size(self.duration):
            return "<Fall: none>"
        duration, drift, forward, down = map(span, self)
        return f"<Fall of {duration} s: lands {drift} m ahead, at {forward} m/s forward and {down} m/s down>"


def span(values: np.ndarray) -> str:
    """Least and greatest of numbers in words; one number if they are equal."""
    low, high = np.min(values), np.max(values)
    return f"{low:.1f}" if low == high else f"{low:.1f} to {high:.1f}"


def ballistic_fall(
    height: npt.ArrayLike,
    uav: UAV = RISK_QUADROTOR,
    *,
    speed: float | None = None,
    pitch: float = 0.0,
    air_density: float = AIR_DENSITY,
) -> Fall:
    """A fall with drag against the whole velocity: dv/dt = g − (R_I A ρ_A / 2m)·|v|·v, in still air.

    Parameters
    ----------
    height : float or array
        Height lost [m], 0 to 50 000.
    uav : UAV
        Its mass m with payload, and its drag area R_I·A as a wreck.
    speed : float, optional
        Airspeed when the UAV fails [m/s], at least 0; its cruise speed by default.
    pitch : float
        Climb angle at that moment [rad], −π/2 to π/2; a UAV that climbs first rises on.
    air_density : float
        ρ_A [kg/m³], above 0.

    Returns
    -------
    Fall

    Raises
    ------
    ValueError
        If `height` is not from 0 to 50 000 m, `speed` is negative or not finite, `pitch` is not from −π/2 to π/2,
        `air_density` is not above 0 and finite, or `uav` is no `UAV`.

    See Also
    --------
    fall_speed : the papers' closed form, with drag downwards only.
    RiskMap.rate_ahead : the risk where such falls end.

    Examples
    --------
    A wreck from 30 m lands far ahead of the failure, if the UAV flew level or climbed.

    >>> import numpy as np
    >>> from uavlab.risk import ballistic_fall
    >>> [round(float(ballistic_fall(30, pitch=np.radians(degrees)).drift), 1) for degrees in (-45, 0, 45)]
    [17.6, 38.2, 41.4]
    """
    checks.within("height", heights := checks.numbers("height", height), 0.0, HIGHEST, "m")
    path = wreck_path(uav, speed, pitch, float(heights.max(initial=0.0)), air_density)
    apex = max(float(path.t_events[1][0]) if len(path.t_events[1]) else 0.0, 0.0)
    times = apex + (path.t[-1] - apex) * np.linspace(0.0, 1.0, 1000) ** 2  # the first millimetres take long
    time = np.interp(heights, path.sol(times)[1], times)
    for _ in range(3):  # Newton: from the height at a time to the time at a height
        drop, down = path.sol(time.ravel())[[1, 3]].reshape(2, *time.shape)
        time = np.clip(time - (drop - heights) / np.maximum(down, 1e-6), apex, path.t[-1])
    drift, _, forward, down = path.sol(time.ravel()).reshape(4, *time.shape)
    return Fall(time, drift, forward, np.maximum(down, 0.0))


def wreck_path(uav: UAV, speed: float | None, pitch: float, depth: float, air_density: float) -> Any:
    """SciPy's solution of the fall until `depth` metres are lost: `sol(t)` is (distance, drop, and their rates)."""
    from scipy.integrate import solve_ivp

    checks.instance("uav", uav, UAV)
    speed = checks.not_negative_number("speed", uav.cruise_speed if speed is None else speed)
    pitch = checks.number("pitch", pitch, checks.within, -np.pi / 2, np.pi / 2, "rad (from degrees: numpy.radians)")
    motion, enough = fall_motion(uav, speed, depth, air_density)

    def landing(_: float, state: np.ndarray) -> float:
        return state[1] - depth - 1e-3

    def apex(_: float, state: np.ndarray) -> float:
        return state[3]

    landing.terminal, landing.direction, apex.direction = True, 1, 1  # type: ignore[attr-defined]
    begin = [0.0, 0.0, speed * np.cos(pitch), -speed * np.sin(pitch)]
    return solve_ivp(motion, (0.0, enough), begin, events=(landing, apex), dense_output=True, rtol=1e-9, atol=1e-9)


def fall_motion(uav: UAV, speed: float, depth: float, air_density: float) -> tuple[Any, float]:
    """The equation of N falls, states (4·N,) of distances, drops and their rates; and seconds until all are down."""
    fastest = terminal_speed(uav, air_density=air_density)
    drag = GRAVITY / fastest**2

    def motion(_: float, state: np.ndarray) -> np.ndarray:
        forward, down = state.reshape(4, -1)[2:]
        against = drag * np.hypot(forward, down)
        return np.concatenate([forward, down, -against * forward, GRAVITY - against * down])

    return motion, 10 * (1 + (speed + depth) / GRAVITY) + 2 * depth / fastest


def impact_energy(mass: float, forward_speed: npt.ArrayLike, fall_speed: npt.ArrayLike) -> np.ndarray:
    """Kinetic energy on impact, E_imp = m (V² + V_y²) / 2 (below RISK-ACO Eq. 8, PSO-BAS Eq. 6).

    Parameters
    ----------
    mass : float
        m with payload [kg], above 0.
    forward_speed, fall_speed : float or arrays
        V and V_y on impact [m/s], at least 0.

    Returns
    -------
    float or array
        E_imp [J].

    Raises
    ------
    ValueError
        If `mass` is not one number above 0, `forward_speed` or `fall_speed` is negative, or one of them is not finite.

    See Also
    --------
    impact_fatality : the chance that it kills.
    fall_speed : V_y after a fall.

    Examples
    --------
    >>> from uavlab.risk import fall_speed, impact_energy
    >>> impact_energy(1.38, 16.0, fall_speed([10, 30, 60])).round()
    array([309., 554., 878.])
    """
    mass = checks.positive_number("mass", mass)
    forward, down = checks.numbers("forward_speed", forward_speed), checks.numbers("fall_speed", fall_speed)
    checks.not_negative("forward_speed", forward)
    checks.not_negative("fall_speed", down)
    return 0.5 * mass * (forward**2 + down**2)


def lethal_area(
    height: npt.ArrayLike,
    forward_speed: npt.ArrayLike,
    fall_speed: npt.ArrayLike,
    uav_diameter: float = RISK_QUADROTOR.diameter,
    *,
    person_radius: float = PERSON_RADIUS,
    person_height: float = PERSON_HEIGHT,
) -> np.ndarray:
    """Ground on which a person is hit (RISK-ACO Eq. 6 and Fig. 4, PSO-BAS Eq. 4 and Fig. 2).

    A_exp = 2 (r_p + R_uav) d + π (r_p + R_uav)², d = h_p / tan θ = h_p V / V_y: how far the wreck glides between
    the height of a head and the ground.

    Parameters
    ----------
    height : float or array
        Height that it falls from [m], at least 0. Below a person's height it glides from there only, so that d goes to
        0 instead of growing without bound where V_y → 0.
    forward_speed, fall_speed : float or arrays
        V and V_y on impact [m/s], at least 0.
    uav_diameter : float
        2 R_uav [m], at least 0.
    person_radius : float
        r_p [m], at least 0.
    person_height : float
        h_p [m], at least 0.

    Returns
    -------
    float or array
        A_exp [m²].

    Raises
    ------
    ValueError
        If `height`, `forward_speed`, `fall_speed`, `uav_diameter`, `person_radius` or `person_height` is negative or
        not finite, or `fall_speed` is 0 where `height` and `forward_speed` are above 0.

    See Also
    --------
    fall_speed : V_y after a fall.
    person_rate : what the area is for.

    Examples
    --------
    The faster it comes down, the shorter it glides past a person.

    >>> from uavlab.risk import fall_speed, lethal_area
    >>> lethal_area([10, 30, 60], 16.0, fall_speed([10, 30, 60])).round(2)
    array([2.35, 1.65, 1.38])
    """
    for name, value in (("height", height), ("forward_speed", forward_speed), ("fall_speed", fall_speed)):
        checks.not_negative(name, value)
    uav_diameter = checks.not_negative_number("uav_diameter", uav_diameter)
    person_radius = checks.not_negative_number("person_radius", person_radius)
    person_height = checks.not_negative_number("person_height", person_height)
    height, forward, down = np.broadcast_arrays(*(np.asarray(v, float) for v in (height, forward_speed, fall_speed)))
    if ((down == 0) & (height > 0) & (forward > 0)).any():
        raise ValueError("fall_speed must be above 0 where height and forward_speed are: it would glide for ever")
    glide = np.minimum(height, person_height) * np.divide(forward, down, out=np.zeros(height.shape), where=down > 0)
    reach = person_radius + uav_diameter / 2
    return 2 * reach * glide + np.pi * reach**2
