"""The vehicle: what it weighs, how hard its rotors pull, and how much of that is left against the wind.

A multirotor in hover holds its weight with the vertical part of its thrust. What remains sideways, the horizontal
reserve, is all it has against a gust: a heavy load takes it away twice, by its weight and by leaving less to tilt.
"""

from dataclasses import dataclass, fields, replace

import numpy as np
import numpy.typing as npt

from uavlab import checks

GRAVITY = 9.81
"""Acceleration of free fall [m/s²]."""


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
        Drag coefficient times frontal area, C·S [m²]; 0.02 to 0.1 for small quadrotors.
    rain_area : float
        Area that rain falls on, seen from above [m²].
    diameter : float
        Of the body, rotors included, D_uav [m].
    cruise_speed, top_speed : float
        Airspeed on missions and at most [m/s].
    max_tilt : float
        Greatest tilt of the rotor plane [rad].
    rotor_area : float
        Area of all rotor discs together [m²]; four of 25 cm across have 0.2.
    payload : float
        Load carried [kg].
    name : str

    Raises
    ------
    ValueError
        If a value is not one finite number or out of its range, or the rotors can't lift the weight.
    """

    mass: float
    thrust: float
    drag_area: float
    rain_area: float
    diameter: float
    cruise_speed: float
    top_speed: float
    max_tilt: float = np.radians(35.0)
    rotor_area: float = 0.2
    payload: float = 0.0
    name: str = "UAV"

    def __post_init__(self) -> None:
        for item in fields(self):
            if item.name == "name":
                continue
            checks.number(item.name, getattr(self, item.name))
            check = checks.not_negative if item.name == "payload" else checks.positive
            check(item.name, getattr(self, item.name))
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

    @property
    def weight(self) -> float:
        """Weight with payload, G_uav + G_s [N]."""
        return (self.mass + self.payload) * GRAVITY

    def loaded(self, payload: float) -> "UAV":
        """The same vehicle with another payload [kg]; a ValueError if the rotors can't lift it."""
        return replace(self, payload=payload)

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
            If the force is negative or not finite.
        """
        checks.not_negative("downward_force", downward_force)
        down = self.weight + np.asarray(downward_force, dtype=float)
        return np.minimum(np.sqrt(np.maximum(self.thrust**2 - down**2, 0.0)), down * np.tan(self.max_tilt))


RISK_QUADROTOR = UAV(
    mass=1.38,
    thrust=28.0,
    drag_area=0.3 * 0.0188,
    rain_area=np.pi * 0.2**2,
    diameter=0.4,
    cruise_speed=16.0,
    top_speed=20.0,
    rotor_area=0.18,
    name="1.38 kg quadrotor of PSO-BAS Table 2",
)
"""Mass, radius 0.2 m, speed 16 m/s, C = 0.3 and A = 0.0188 m² from PSO-BAS Table 2, where C·A is that of the wreck
in free fall; thrust about twice the weight, the top speed and rotors of 24 cm are ours, usual for the class."""

LIGHT_QUADROTOR = UAV(
    mass=1.5,
    thrust=28.0,
    drag_area=0.06,
    rain_area=0.1,
    diameter=1.0,
    cruise_speed=5.0,
    top_speed=18.0,
    max_tilt=np.radians(60.0),
    name="light quadrotor for REPARE's cases",
)
"""REPARE gives no vehicle. With these values a payload of 0, 0.25, 0.6 or 1 kg and a wind of 1.5, 6, 7.5 or 9 m/s give
the distances of its Table 4; a diameter of 1 m is what its 3.5/4.5/5.5 m leave for rings of 3/4/5 m."""
