"""The body of the vehicle: the point mass of `uavlab.flight` in wind, which goes where its pilot sends it.

A flight of `uavlab.flight.fly` has one route from its start to its goal. This one goes on: it stands on the ground,
takes off, hovers, and gets a new path in mid-flight. Forces, gusts, GPS and battery are the same, by the same code.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from uavlab.city import City
from uavlab.flight.autopilot import Autopilot
from uavlab.flight.models import Model, model_of
from uavlab.flight.path import Path, planned_speed
from uavlab.flight.simulation import TIME_STEP, flown_by
from uavlab.flight.state import (
    ARRIVED,
    BATTERY,
    BATTERY_EMPTY,
    BLOWN_BACK,
    COLUMNS,
    CRASHED,
    FLYING,
    LEAST,
    Course,
    Obstacles,
    State,
    start_of,
)
from uavlab.mission.corridor import floor_below, touchable
from uavlab.route import Route
from uavlab.spline.curve import contact_distance
from uavlab.vehicle import UAV
from uavlab.weather import Wind
from uavlab.weather.turbulence import HIGHEST, LOWEST

GONE_ON = 1e-3
"""A path of no length is made so long [m]."""

BRAKING = 2.0
"""With which it comes to a stop [m/s²]."""


class Where(NamedTuple):
    """What is known of a moment; the truth, and what the autopilot believes."""

    time: float
    """Since the vehicle was switched on [s]."""
    position: np.ndarray
    seen: np.ndarray
    """As GPS has it, (3,) [m]."""
    velocity: np.ndarray
    """As GPS has it [m/s]."""
    target: np.ndarray
    """Where it should be."""
    used: float
    """Energy from the battery [J]."""


class Body:
    """A multirotor on a map, in wind."""

    def __init__(
        self, city: City, uav: UAV, wind: Wind, autopilot: Autopilot, at: np.ndarray, rng: np.random.Generator
    ) -> None:
        self.city, self.uav, self.wind, self.autopilot, self.rng = city, uav, wind, autopilot, rng
        self.state: State = start_of(at)
        touching = contact_distance(uav.diameter)
        self.obstacles = Obstacles(city.occupied, city.runs, city.clearance, city.origin, city.cell, touching, 0.0)
        self.path: Path | None = None
        self.model: Model | None = None
        self.time = 0.0
        self.altitude = LOWEST
        self.log = np.empty((2, len(COLUMNS)))

    @property
    def where(self) -> Where:
        state = self.state
        return Where(
            self.time, state.position.copy(), state.seen_position.copy(), state.seen_velocity.copy(),
            state.target.copy(), float(state.sums[BATTERY]),
        )  # fmt: skip

    @property
    def flown(self) -> float:
        """How far along its path the reference is [m]."""
        return float(self.state.way[0])

    @property
    def at_end(self) -> bool:
        """Whether the reference stands at the end of the path."""
        return self.path is not None and self.flown >= self.path.distance[-1]

    @property
    def from_end(self) -> float:
        """How far the vehicle sees itself from there [m]."""
        return (
            float("inf")
            if self.path is None
            else float(np.linalg.norm(self.state.seen_position - self.path.points[-1]))
        )

    @property
    def least_clearance(self) -> float:
        """To obstacles since it left the ground [m]."""
        return float(self.state.sums[LEAST])

    def follow(self, points: np.ndarray, speeds: np.ndarray | float) -> None:
        """A new path from where the reference is to points (N, 3), with speeds on all legs, or each (N,) [m/s]."""
        speeds = np.broadcast_to(speeds, len(points))
        points = np.vstack([self.state.target, points])
        far = np.linalg.norm(np.diff(points, axis=0), axis=1) > GONE_ON
        if not far.any():
            far[-1], points[-1] = True, points[-1] + (0.0, 0.0, 2 * GONE_ON)
        flown_uav = flown_by(self.uav, self.autopilot.controller)
        self.path = planned_speed(Route(points[np.append(True, far)]), flown_uav, self.wind, speeds[far])
        self.altitude = float(np.clip(points[:, 2].mean() - self.city.origin[2], LOWEST, HIGHEST))
        self.model = model_of(
            self.wind, self.autopilot.controller, flown_uav, self.autopilot, self.path, self.altitude, TIME_STEP
        )
        self.state.way[:] = 0.0

    def hover(self) -> None:
        """Come to a stop."""
        velocity = self.state.velocity
        speed = float(np.linalg.norm(velocity))
        self.follow((self.state.target + velocity * speed / (2 * BRAKING))[None], max(speed, 1.0))

    def stand(self, seconds: float) -> None:
        """Time goes by on the ground."""
        self.time += seconds

    def fly(self, seconds: float, low: bool) -> int:
        """Fly on: FLYING, CRASHED, BLOWN_BACK or BATTERY_EMPTY. Low, near what it may land on, it may touch it."""
        assert self.path is not None
        assert self.model is not None
        space = self.obstacles
        position = self.state.position
        if low and position[2] < touchable(self.city, position, self.uav.diameter):
            space = space._replace(touching=0.0)
        before = float(self.state.sums[LEAST])
        self.state.counts[1] = 0
        steps = max(round(seconds / TIME_STEP), 1)
        outcome = self.model.run(Course(self.path, space, TIME_STEP), self.state, steps, 10**9, self.rng, self.log)
        if space.touching == 0.0:
            self.state.sums[LEAST] = before
        self.time += steps * TIME_STEP
        return FLYING if outcome == ARRIVED else outcome

    def height(self) -> float:
        """Above what lies below it [m]."""
        return float(self.state.position[2] - floor_below(self.city, self.state.position)[0])

    def land(self, at: np.ndarray) -> None:
        """Stand at a place on the ground, from where a new reference begins."""
        for place in (self.state.position, self.state.before, self.state.target):
            place[:] = at
        self.state.seen_position[:] = at + self.state.gps_error
        self.state.velocity[:] = 0.0
        self.state.seen_velocity[:] = 0.0
        self.path = self.model = None


OVER = {CRASHED: "crashed", BLOWN_BACK: "blown away", BATTERY_EMPTY: "the battery is empty"}
"""How flights end in the air."""
