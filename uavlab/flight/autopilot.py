"""How a UAV is flown: its controller, what it knows, and who watches."""

from dataclasses import dataclass
from typing import NamedTuple

from uavlab import checks
from uavlab.resilience import BASIC, Controller, Monitor

STRATEGIES = ("adaptive", "grounded", "fixed")


class Gps(NamedTuple):
    """What the autopilot knows of where it is; between fixes it reckons with the last speed."""

    rate: float = 10.0
    """[Hz]"""
    position: float = 0.5
    """σ of a fix on each axis [m]."""
    velocity: float = 0.1
    """σ of its speed on each axis [m/s]."""


GPS = Gps()
PERFECT_GPS = Gps(position=0.0, velocity=0.0)


@dataclass(frozen=True)
class Autopilot:
    """How a UAV is flown.

    Attributes
    ----------
    controller : Controller
        ω_n of the position control, and the share of the speed. A monitor that is listened to chooses its own.
    speed : float, optional
        Over ground [m/s]; by default the UAV's cruise speed.
    trimmed : bool
        Whether it knows the mean wind, at each moment if that changes. If not, the wind holds the UAV off its route.
    gps : Gps
    monitor : Monitor, optional
        Watches the flight; each flight has a copy of it.
    strategy : {"adaptive", "grounded", "fixed"}
        What becomes of the monitor's advice: its controller is taken; the UAV lands at once when it would change to the
        advanced one (one that begins with it never asks for that); nothing, as if there were no monitor.
    acceptance_radius : float
        In a wind it has arrived when it is so near to the goal [m].
    interval : float
        How often the monitor, and a disturbance that changes, are looked at [s].

    Raises
    ------
    ValueError
        If an attribute is out of its range.
    """

    controller: Controller = BASIC
    speed: float | None = None
    trimmed: bool = True
    gps: Gps = GPS
    monitor: Monitor | None = None
    strategy: str = "adaptive"
    acceptance_radius: float = 2.0
    interval: float = 0.5

    def __post_init__(self) -> None:
        for name in ("speed_share", "natural_frequency"):
            checks.positive_number(f"controller.{name}", getattr(self.controller, name))
        if self.speed is not None:
            checks.positive_number("speed", self.speed)
        checks.positive_number("gps.rate", self.gps.rate)
        checks.not_negative_number("gps.position", self.gps.position)
        checks.not_negative_number("gps.velocity", self.gps.velocity)
        checks.one_of("strategy", self.strategy, STRATEGIES)
        checks.positive_number("acceptance_radius", self.acceptance_radius)
        checks.positive_number("interval", self.interval)


AUTOPILOT = Autopilot()
