"""What a flight in `planners.wasm` takes: a vehicle and its autopilot as numbers, and a generator's state."""

from __future__ import annotations

import numpy as np

from uavlab import checks
from uavlab.flight.autopilot import Autopilot
from uavlab.flight.models import model_of
from uavlab.flight.path import constant_speed, vehicle_in
from uavlab.flight.simulation import flown_by
from uavlab.route import Route
from uavlab.vehicle import UAV
from uavlab.weather import Wind

CRAFT = (
    "mass", "thrust", "drag", "tan_tilt", "rain", "disc", "profile", "efficiency", "charge", "omega", "pace",
    "gps_fixes", "gps_keep", "gps_level", "gps_up", "gps_velocity", "held", "fastest", "climb", "sink",
)  # fmt: skip
"""Numbers of a vehicle and its autopilot, as `Body` and `Vehicle` have them."""


def craft_of(uav: UAV, wind: Wind, autopilot: Autopilot, time_step: float) -> np.ndarray:
    """Numbers of a vehicle and its autopilot in a wind's air and rain, in the order of `CRAFT`.

    Parameters
    ----------
    uav : UAV
    wind : Wind
        Its air density and its rain count; its gusts must be "ou", the ones that a page has.
    autopilot : Autopilot
        Must know the mean wind, and have no monitor that is listened to.
    time_step : float
        [s], above 0.

    Returns
    -------
    (20,) array

    Raises
    ------
    ValueError
        If `uav`, `wind` or `autopilot` is of another kind, or one that a page can't have; or `time_step` is not above
        0.

    See Also
    --------
    uavlab.web.functions.fly : Takes them.
    uavlab.flight.fly : The same flight in Python.

    Examples
    --------
    >>> from uavlab.flight import Autopilot
    >>> from uavlab.vehicle import LIGHT_QUADROTOR
    >>> from uavlab.weather import Wind
    >>> from uavlab.web.craft import CRAFT, craft_of
    >>> craft = craft_of(LIGHT_QUADROTOR, Wind((6, 0)), Autopilot(), 0.02)
    >>> {name: round(float(craft[CRAFT.index(name)]), 2) for name in ("mass", "thrust", "climb")}
    {'mass': 1.5, 'thrust': 28.0, 'climb': 5.0}
    """
    checks.instance("uav", uav, UAV)
    checks.instance("wind", wind, Wind)
    checks.instance("autopilot", autopilot, Autopilot)
    time_step = checks.positive_number("time_step", time_step)
    if wind.gusts != "ou":
        raise ValueError(f'wind must have gusts="ou", the ones that a page has, got {wind.gusts!r}')
    if not autopilot.trimmed:
        raise ValueError("autopilot must know the mean wind: trimmed=False isn't flown on a page")
    if autopilot.monitor is not None and autopilot.strategy != "fixed":
        raise ValueError("autopilot must have no monitor that is listened to: on a page nothing changes its controller")
    flown = flown_by(uav, autopilot.controller)
    anywhere = constant_speed(Route(np.array([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0)])), 1.0)
    body, _ = model_of(wind, autopilot.controller, flown, autopilot, anywhere, 0.0, time_step).parts
    named = body._asdict() | vehicle_in(flown, wind)._asdict()
    named |= {"gps_level": body.gps_enter[0], "gps_up": body.gps_enter[2]}
    return np.array([named[name] for name in CRAFT], dtype=float)


def state_of(generator: np.random.Generator) -> np.ndarray:
    """The state of a `numpy.random.default_rng`, (4,) uint64."""
    known = generator.bit_generator.state
    if known["bit_generator"] != "PCG64":
        raise ValueError(f"generator must be a default_rng, which is a PCG64, got a {known['bit_generator']}")
    words = [known["state"][name] >> shift & (2**64 - 1) for name in ("state", "inc") for shift in (64, 0)]
    return np.array(words, dtype=np.uint64)
