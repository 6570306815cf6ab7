"""The vehicle: what it weighs, how hard its rotors pull, how much of that is left against the wind, and how long.

A multirotor in hover holds its weight with the vertical part of its thrust. What remains sideways, the horizontal
reserve, is all it has against a gust: a heavy load takes it away twice, by its weight and by leaving less to tilt. The
presets stand beside the data sheets of real aircraft.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from uavlab import checks

GRAVITY = 9.81
"""Acceleration of free fall [m/s²]."""

STANDARD_AIR = 1.225
"""Density of dry air at 15 °C and 1013.25 hPa [kg/m³]."""

WATT_HOUR = 3600.0
"""[J]"""

INDUCED = 1.15
"""Of the ideal power what rotors truly spend on the induced flow, as it isn't even (Leishman 2006, 2.8)."""

UNLIMITED = ("climb_speed", "sink_speed", "battery")
"""What may be infinite."""


@dataclass(frozen=True)
class UAV:
    """A multirotor.

    Attributes
    ----------
    mass : float
        Of the airframe with its battery, without payload [kg].
    thrust : float
        Greatest total thrust of the rotors [N]; must exceed the weight.
    drag_area : float
        Drag coefficient times frontal area in flight, C·S [m²]; 0.02 to 0.1 for small quadrotors.
    rain_area : float
        Area that rain falls on, seen from above [m²].
    diameter : float
        Of the body, rotors included, D_uav [m].
    cruise_speed, top_speed : float
        Airspeed on missions and at most [m/s].
    max_tilt : float
        Greatest tilt of the rotor plane [rad].
    climb_speed, sink_speed : float
        Greatest vertical speeds, up and down, REPARE's "maximum ascent speed" (2.1.2) [m/s]; infinite where nothing but
        the top speed limits them.
    rotor_area : float
        Area of all rotor discs together [m²]; four of 25 cm across have 0.2.
    figure_of_merit : float
        Ideal over true power of the rotors in hover, above 0, below 0.87; 0.5 to 0.7 for small ones (Leishman,
        Principles of Helicopter Aerodynamics, 2006, 2.8).
    drive_efficiency : float
        Share of the battery's power that reaches the rotors through motors and their control, above 0, at most 1.
    battery : float
        Energy when full [J]; 1 Wh is 3600 J. Infinite where it isn't known.
    reserve : float
        Share of it that a flight leaves in the battery, at least 0, below 1.
    fall_drag_area : float, optional
        C·A of the wreck in free fall [m²]; by default `drag_area`.
    payload : float
        Load carried [kg].
    name : str

    Raises
    ------
    ValueError
        If an attribute other than `name` is not one number above 0 (`payload` and `reserve`: at least 0), or `name` is
        no text. Only `climb_speed`, `sink_speed` and `battery` may be infinite. If `max_tilt` is π/2 or more,
        `figure_of_merit` 0.87 or more, `drive_efficiency` above 1, `reserve` 1 or more, or `cruise_speed` above
        `top_speed`. If `thrust` can't lift `mass` and `payload`.

    See Also
    --------
    UAV.loaded : the same with another payload.
    uavlab.power.power_needed : what flying it costs.
    uavlab.weather.grounded_by : whether it may fly in a weather.

    References
    ----------
    J. G. Leishman, Principles of Helicopter Aerodynamics, 2006.

    Examples
    --------
    >>> from uavlab.vehicle import LIGHT_QUADROTOR
    >>> LIGHT_QUADROTOR
    <UAV light quadrotor for REPARE's cases: 1.5 kg with 0 kg of payload, thrust 28 N, 1 m across, cruise 5 m/s>
    >>> f"{LIGHT_QUADROTOR.weight:.1f} N, hovers for {LIGHT_QUADROTOR.endurance / 60:.0f} min"
    '14.7 N, hovers for 27 min'
    """

    mass: float
    thrust: float
    drag_area: float
    rain_area: float
    diameter: float
    cruise_speed: float
    top_speed: float
    max_tilt: float = np.radians(35.0)
    climb_speed: float = np.inf
    sink_speed: float = np.inf
    rotor_area: float = 0.2
    figure_of_merit: float = 0.6
    drive_efficiency: float = 0.75
    battery: float = np.inf
    reserve: float = 0.2
    fall_drag_area: float | None = None
    payload: float = 0.0
    name: str = "UAV"

    def __post_init__(self) -> None:
        for item in fields(self):
            value = getattr(self, item.name)
            checked: str | float
            if item.name == "name":
                checked = checks.text("name", value)
            elif item.name == "fall_drag_area" and value is None:
                continue
            elif item.name in UNLIMITED and checks.number(item.name, value) == np.inf:
                checked = np.inf
            elif item.name in ("payload", "reserve"):
                checked = checks.not_negative_number(item.name, value)
            else:
                checked = checks.positive_number(item.name, value)
            object.__setattr__(self, item.name, checked)
        if self.figure_of_merit >= 1 / INDUCED:
            raise ValueError(
                f"figure_of_merit must be below {1 / INDUCED:.2f}, what losses of the induced flow leave, "
                f"got {self.figure_of_merit:g}"
            )
        if self.drive_efficiency > 1:
            raise ValueError(f"drive_efficiency is a share and must be at most 1, got {self.drive_efficiency:g}")
        if self.reserve >= 1:
            raise ValueError(f"reserve is a share of the battery and must be below 1, got {self.reserve:g}")
        if self.max_tilt >= np.pi / 2:
            raise ValueError(
                f"max_tilt must be below π/2 in radians, got {self.max_tilt:g}; convert with numpy.radians"
            )
        if self.cruise_speed > self.top_speed:
            raise ValueError(f"cruise_speed {self.cruise_speed:g} m/s is above top_speed {self.top_speed:g} m/s")
        if self.thrust <= self.weight:
            raise ValueError(
                f"thrust {self.thrust:g} N can't lift {self.mass:g} kg + payload {self.payload:g} kg "
                f"({self.weight:.1f} N): carry less"
            )

    def __repr__(self) -> str:
        return (
            f"<UAV {self.name}: {self.mass:g} kg with {self.payload:g} kg of payload, "
            f"thrust {self.thrust:g} N, {self.diameter:g} m across, cruise {self.cruise_speed:g} m/s>"
        )

    @property
    def weight(self) -> float:
        """Weight with payload, G_uav + G_s [N]."""
        return (self.mass + self.payload) * GRAVITY

    def loaded(self, payload: float) -> UAV:
        """The same vehicle with another payload.

        Parameters
        ----------
        payload : float
            Load carried [kg], at least 0; in place of the load before.

        Returns
        -------
        UAV
            This one stays as it is.

        Raises
        ------
        ValueError
            If `payload` is negative or not finite, or the rotors can't lift it.

        See Also
        --------
        UAV.horizontal_reserve : what the load leaves against the wind.

        Examples
        --------
        >>> from uavlab.vehicle import LIGHT_QUADROTOR
        >>> [round(LIGHT_QUADROTOR.loaded(payload).endurance / 60) for payload in (0.0, 0.5, 1.0)]  # minutes
        [27, 17, 12]
        """
        return replace(self, payload=payload)

    def hover_power(self, air_density: float = STANDARD_AIR) -> float:
        """Power from the battery in hover, T^1.5/√(2 ρ A) over figure of merit and drive efficiency [W].

        Parameters
        ----------
        air_density : float
            ρ [kg/m³], above 0.

        Returns
        -------
        float
            [W], with T the weight and A the area of the rotors.

        Raises
        ------
        ValueError
            If `air_density` is not one finite number above 0.

        See Also
        --------
        uavlab.power.power_needed : in flight and in wind.

        References
        ----------
        J. G. Leishman, Principles of Helicopter Aerodynamics, 2006, 2.8: the figure of merit.

        Examples
        --------
        >>> from uavlab.vehicle import LIGHT_QUADROTOR
        >>> round(LIGHT_QUADROTOR.hover_power()), round(LIGHT_QUADROTOR.loaded(1.0).hover_power())
        (179, 386)
        """
        air_density = checks.positive_number("air_density", air_density)
        ideal = self.weight**1.5 / np.sqrt(2 * air_density * self.rotor_area)
        return float(ideal / (self.figure_of_merit * self.drive_efficiency))

    @property
    def usable_energy(self) -> float:
        """What flights may take from a full battery [J]; infinite where its energy isn't known."""
        return (1 - self.reserve) * self.battery

    @property
    def endurance(self) -> float:
        """How long it hovers in standard air until only the reserve is left [s]."""
        return self.usable_energy / self.hover_power()

    def horizontal_reserve(self, downward_force: npt.ArrayLike = 0.0) -> np.ndarray:
        """Force left against the wind while hovering.

        √(T² − (G + F)²), and no more than (G + F)·tan(tilt limit).

        Parameters
        ----------
        downward_force : float or array
            Force F on top of the weight [N], such as rain, at least 0; 0 when it is dry.

        Returns
        -------
        float or array
            Reserve [N]; 0 when the rotors can only just hold the height, or not even that.

        Raises
        ------
        ValueError
            If `downward_force` is negative or not finite.

        See Also
        --------
        uavlab.weather.wind_limit : the gust that it holds.
        uavlab.weather.rain_force : a downward force.

        Examples
        --------
        >>> from uavlab.vehicle import LIGHT_QUADROTOR
        >>> [round(float(LIGHT_QUADROTOR.loaded(payload).horizontal_reserve()), 1) for payload in (0.0, 0.5, 1.0)]
        [23.8, 20.0, 13.5]
        """
        checks.not_negative("downward_force", downward_force)
        down = self.weight + np.asarray(downward_force, dtype=float)
        return np.minimum(np.sqrt(np.maximum(self.thrust**2 - down**2, 0.0)), down * np.tan(self.max_tilt))


class DataSheet(NamedTuple):
    """What a maker says of an aircraft.

    See Also
    --------
    UAV : the vehicle to calculate with.

    Examples
    --------
    >>> from uavlab.vehicle import DATA_SHEETS
    >>> DATA_SHEETS[0]
    <DataSheet DJI Phantom 4: 1.38 kg, wind 10 m/s, top speed 20 m/s, 28 min>
    """

    name: str
    mass: float
    """With its battery [kg]."""
    wind: float
    """Strongest wind to fly in [m/s]."""
    top_speed: float
    climb_speed: float
    sink_speed: float
    """[m/s]"""
    endurance: float
    """Hovering, with no load [s]."""
    battery: float
    """[J]"""
    rotor_diameter: float
    """Of each of its four rotors [m]."""

    def __repr__(self) -> str:
        limits = f"wind {self.wind:g} m/s, top speed {self.top_speed:g} m/s, {self.endurance / 60:.0f} min"
        return f"<DataSheet {self.name}: {self.mass:g} kg, {limits}>"


DATA_SHEETS = (
    DataSheet("DJI Phantom 4", 1.38, 10.0, 20.0, 6.0, 4.0, 28 * 60, 81.3 * WATT_HOUR, 9.4 * 0.0254),
    DataSheet("DJI Matrice 100, TB47D battery", 2.355, 10.0, 22.0, 5.0, 4.0, 22 * 60, 99.9 * WATT_HOUR, 13.0 * 0.0254),
    DataSheet("DJI Mavic 2 Pro", 0.907, 10.5, 20.0, 5.0, 3.0, 29 * 60, 59.29 * WATT_HOUR, 8.7 * 0.0254),
)
"""Real quadrotors after the makers' data sheets of 2015 to 2018, beside which the presets' limits stand.

The Phantom's 28 minutes are its longest flight, not hovering; 16 m/s is the speed of its second fastest mode."""

RISK_QUADROTOR = UAV(
    mass=1.38,
    thrust=28.0,
    drag_area=0.05,
    rain_area=np.pi * 0.2**2,
    diameter=0.4,
    cruise_speed=16.0,
    top_speed=16.0,
    climb_speed=6.0,
    sink_speed=4.0,
    rotor_area=0.18,
    battery=81.3 * WATT_HOUR,
    fall_drag_area=0.3 * 0.0188,
    name="1.38 kg quadrotor of PSO-BAS Table 2",
)
"""From PSO-BAS Table 2 the mass, a radius of 0.2 m, v_max = 16 m/s and, for the wreck in free fall, C = 0.3 and
A = 0.0188 m². Mass and speed are those of a DJI Phantom 4, from whose data sheet are the vertical speeds, the battery
and rotors of 24 cm. Thrust, about twice the weight, and C·S in flight, with which 16 m/s need a tilt of 30°, are ours.
"""

LIGHT_QUADROTOR = UAV(
    mass=1.5,
    thrust=28.0,
    drag_area=0.06,
    rain_area=0.1,
    diameter=1.0,
    cruise_speed=5.0,
    top_speed=18.0,
    max_tilt=np.radians(60.0),
    climb_speed=5.0,
    sink_speed=4.0,
    battery=100.0 * WATT_HOUR,
    name="light quadrotor for REPARE's cases",
)
"""REPARE gives no vehicle. With these values a payload of 0, 0.25, 0.6 or 1 kg and a wind of 1.5, 6, 7.5 or 9 m/s give
the distances of its Table 4; a diameter of 1 m is what its 3.5/4.5/5.5 m leave for rings of 3/4/5 m. Vertical speeds
and battery are usual for the class (DJI Matrice 100)."""
