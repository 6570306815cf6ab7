"""How a UAV is flown: its controller, what it knows, and who watches."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from uavlab import checks
from uavlab.resilience import BASIC, Controller, Monitor

STRATEGIES = ("adaptive", "grounded", "fixed")


class Gps(NamedTuple):
    """What the autopilot knows of where it is; between fixes it goes on with the last speed.

    Errors of the position last for many minutes, and no control can see them: a first-order Gauss-Markov process,
    R(t) = σ² exp(−|t|/τ). At the start the autopilot knows where it stands, and the error begins at 0; after a minute
    its σ is 1.5 m.

    See Also
    --------
    Autopilot : Flies by it, and refuses values out of their range.

    References
    ----------
    R. W. Beard and T. W. McLain, Small Unmanned Aircraft: Theory and Practice, 2012, section 7.5.

    Examples
    --------
    >>> from math import exp, sqrt
    >>> from uavlab.flight import GPS
    >>> round(GPS.drift * sqrt(1 - exp(-2 * 60 / GPS.correlation)), 2)  # σ east and north after a minute [m]
    1.51
    """

    rate: float = 10.0
    """Fixes per second [Hz]; RISK-ACO section 4 flies with 10."""
    drift: float = 4.7
    """σ of its position, east and north, in the long run [m] (Beard and McLain, Small Unmanned Aircraft, 2012, 7.5)."""
    vertical_drift: float = 1.5
    """And up [m]. Height comes from a barometer: makers say ±0.5 m of hovering up and down, ±1.5 m level."""
    correlation: float = 1100.0
    """τ of the drift [s] (ibid.)."""
    velocity: float = 0.05
    """σ of its speed on each axis, anew at each fix [m/s] (ibid.)."""


GPS = Gps()
PERFECT_GPS = Gps(drift=0.0, vertical_drift=0.0, velocity=0.0)


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
        What it knows of where it is; `PERFECT_GPS` knows it exactly.
    monitor : Monitor, optional
        Watches the flight; each flight has a copy of it.
    strategy : {"adaptive", "grounded", "fixed"}
        What becomes of the monitor's advice: its controller is taken; the UAV lands at once when it would change to the
        advanced one (one that begins with it never asks for that); nothing, as if there were no monitor.
    acceptance_radius : float
        In a wind it has arrived when it is so near to the goal, as GPS has it [m].
    heeds_limits : bool
        Whether it stays on the ground in a wind for which `grounded_by` says so. If not, it flies to see what happens.
    interval : float
        How often the monitor, and a disturbance that changes, are looked at [s].

    Raises
    ------
    ValueError
        If `controller`, `gps` or `monitor` is of another kind; `trimmed` or `heeds_limits` is neither True nor False;
        `speed`, `acceptance_radius`, `interval`, `gps.rate`, `gps.correlation`, or the `speed_share`, the
        `natural_frequency` or the `tilt_share` of `controller` is not above 0; the `tilt_share` is above 1;
        `gps.drift`, `gps.vertical_drift` or `gps.velocity` is negative; or `strategy` is unknown.

    See Also
    --------
    fly : Flies a route with it.
    uavlab.resilience.Monitor : Watches a flight and chooses the controller.

    Examples
    --------
    >>> from uavlab.flight import PERFECT_GPS, Autopilot
    >>> from uavlab.resilience import ConditionCheck, Monitor
    >>> Autopilot(speed=4.0, gps=PERFECT_GPS)
    <Autopilot: basic controller, 4 m/s, mean wind known, GPS drift 0 m, no monitor>
    >>> Autopilot(monitor=Monitor(ConditionCheck(1.6), uav_diameter=1.0), strategy="grounded")
    <Autopilot: basic controller, cruise speed, mean wind known, GPS drift 4.7 m, monitor: grounded>
    """

    controller: Controller = BASIC
    speed: float | None = None
    trimmed: bool = True
    gps: Gps = GPS
    monitor: Monitor | None = None
    strategy: str = "adaptive"
    acceptance_radius: float = 2.0
    heeds_limits: bool = True
    interval: float = 0.5

    def __post_init__(self) -> None:
        if self.monitor is not None:
            checks.instance("monitor", self.monitor, Monitor)
        object.__setattr__(self, "controller", checked_controller(self.controller))
        object.__setattr__(self, "gps", checked_gps(self.gps))
        checks.set_fields(self, checks.one_of, "strategy", known=STRATEGIES)
        checks.set_fields(self, checks.flag, "trimmed", "heeds_limits")
        checks.set_fields(self, checks.positive_number, "acceptance_radius", "interval")
        if self.speed is not None:
            checks.set_fields(self, checks.positive_number, "speed")

    def __repr__(self) -> str:
        speed = "cruise speed" if self.speed is None else f"{self.speed:g} m/s"
        wind = "known" if self.trimmed else "unknown"
        watched = "no monitor" if self.monitor is None else f"monitor: {self.strategy}"
        return (
            f"<Autopilot: {self.controller.name} controller, {speed}, mean wind {wind}, "
            f"GPS drift {self.gps.drift:g} m, {watched}>"
        )


def checked_controller(controller: Controller) -> Controller:
    """The controller, its fields as floats: a named tuple can't look at them itself."""
    checks.instance("controller", controller, Controller)
    checks.text("controller.name", controller.name)
    names = ("speed_share", "natural_frequency", "tilt_share")
    numbers = {name: checks.positive_number(f"controller.{name}", getattr(controller, name)) for name in names}
    if numbers["tilt_share"] > 1:
        raise ValueError(f"controller.tilt_share must be at most 1, got {numbers['tilt_share']:g}")
    return Controller(controller.name, **numbers)


def checked_gps(gps: Gps) -> Gps:
    """The same of GPS."""
    checks.instance("gps", gps, Gps)
    above = {name: checks.positive_number(f"gps.{name}", getattr(gps, name)) for name in ("rate", "correlation")}
    errors = ("drift", "vertical_drift", "velocity")
    return Gps(**above, **{name: checks.not_negative_number(f"gps.{name}", getattr(gps, name)) for name in errors})


AUTOPILOT = Autopilot()
