"""What a flight consists of, for compiled code: body, air, offsets, obstacles, and all that changes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from uavlab.city.segments import Runs
from uavlab.compiled import compiled
from uavlab.flight.path import Path

COLUMNS = ("time", "x", "y", "z", "x_ref", "y_ref", "z_ref", "along", "across", "up", "thrust", "speed")
"""What is logged: position and reference [m], offset in the route's frame [m], thrust [N], speed over ground [m/s]."""

NONE, GAUSSIAN, OU, DRYDEN = range(4)
FLYING, ARRIVED, CRASHED, BLOWN_BACK, BATTERY_EMPTY = range(5)
LEAST, NOW, BATTERY, INDUCED, PROFILE, DRAG, WIND, RAIN, BRAKED = range(9)
"""What a flight sums up: least and present distance to obstacles [m], energy from the battery, and where that went [J].

See `uavlab.flight.Energy`."""


class Body(NamedTuple):
    """The vehicle and its autopilot."""

    mass: float
    thrust: float
    drag: float  # ½ ρ C S [kg/m]
    tan_tilt: float
    rain: float  # [N]
    disc: float  # 2 ρ A of its rotors [kg/m]
    profile: float  # drag of the blades in hover, over the ideal power
    efficiency: float  # of motors and their control
    charge: float  # energy that the flight may take from the battery [J]
    trim: np.ndarray  # (3,) the mean wind that the autopilot reckons with [m/s]
    omega: float  # ω_n of its position control [rad/s]
    pace: float  # share of the planned speed
    gps_fixes: float  # per step
    gps_keep: float  # share of the error that is left at the next fix
    gps_enter: np.ndarray  # (3,) σ of what is new in it [m]
    gps_velocity: float  # [m/s]


class Air(NamedTuple):
    """The mean wind, and how gusts go on from step to step."""

    mean: np.ndarray  # (3,) [m/s]
    kind: int
    frame: np.ndarray  # (3, 3) columns: along, across, up
    deviation: np.ndarray  # (3,) [m/s]
    keep: np.ndarray  # (3, 2, 2) transition of two lags; OU gusts use the first
    enter: np.ndarray  # (3, 2, 2) of the noise
    read: np.ndarray  # (3, 2) gust from lags
    every: int  # steps from draw to draw


class Spring(NamedTuple):
    """Offsets on three axes without a body."""

    mean: np.ndarray  # (3,) [m]
    sigma: np.ndarray  # (3,) [m]
    keep: np.ndarray  # (2, 2)
    enter: np.ndarray  # (2, 2)
    omega: float  # ω_n [rad/s]
    pace: float


class Obstacles(NamedTuple):
    """The city, and what of it a body touches."""

    occupied: np.ndarray
    runs: Runs
    clearance: np.ndarray  # [m]
    origin: np.ndarray
    cell: float
    touching: float  # distance at which the body collides [m]
    near_goal: float  # distance from the goal at which it has arrived [m]; infinite for offsets, which have no body


class Course(NamedTuple):
    """Where a flight goes, what is around, and how finely it is looked at."""

    path: Path
    obstacles: Obstacles
    dt: float  # [s]


class State(NamedTuple):
    """All that changes; flights go on from it."""

    position: np.ndarray  # (3,) [m]
    before: np.ndarray  # (3,) a step ago
    velocity: np.ndarray
    target: np.ndarray  # (3,) where it should be
    seen_position: np.ndarray  # as the autopilot has it
    seen_velocity: np.ndarray
    lags: np.ndarray  # (3, 2) of the gusts, or offsets and their speeds
    gust: np.ndarray  # (3,) [m/s]
    gps_error: np.ndarray  # (3,) [m]
    heading: np.ndarray  # (2,) of the route, level
    way: np.ndarray  # (2,) distance along the route [m], its leg
    sums: np.ndarray  # (9,) see LEAST to BRAKED
    counts: np.ndarray  # (2,) steps made, rows logged


@compiled
def start_of(start):
    """At the start of the route (3,), at rest, in still air."""
    sums = np.zeros(9)
    sums[LEAST] = sums[NOW] = np.inf
    return State(
        start.copy(), start.copy(), np.zeros(3), start.copy(), start.copy(), np.zeros(3), np.zeros((3, 2)), np.zeros(3),
        np.zeros(3), np.array([1.0, 0.0]), np.zeros(2), sums, np.zeros(2, np.int64),
    )  # fmt: skip
