"""Two ways to move a UAV through a time step, made ready for compiled code from wind, vehicle and autopilot."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from uavlab.compiled import compiled
from uavlab.flight.autopilot import Autopilot
from uavlab.flight.disturbance import OffsetProcess, stepped
from uavlab.flight.motion import drift_on, fly_on
from uavlab.flight.path import Path
from uavlab.flight.state import OU, Air, Body, Course, Spring, State
from uavlab.power import profile_share
from uavlab.resilience import Controller
from uavlab.vehicle import GRAVITY, UAV
from uavlab.weather import dryden_parameters, rain_force
from uavlab.weather.turbulence import OUTPUT, lag_step
from uavlab.weather.wind import GUSTS, Wind, gust_deviations


class Model(NamedTuple):
    """A way to move on, and what it needs to know."""

    move: Callable[..., int]
    parts: tuple
    pace: float

    def run(self, course: Course, state: State, *arguments: Any) -> int:
        """Move on: how many steps at most, every how many a row, random numbers, and the log."""
        return self.move(*self.parts, course, state, *arguments)

    def hand_over(self, state: State, to: Model) -> None:
        """Offsets without a body are kept in units of σ: they stay what they are in metres."""
        if isinstance(self.parts[0], Spring):
            old, new = self.parts[0], to.parts[0]
            offset = old.mean + old.sigma * state.lags[:, 0] - new.mean
            speed = old.sigma * state.lags[:, 1] * old.omega / new.omega
            for lag, value in enumerate((offset, speed)):
                state.lags[:, lag] = np.divide(value, new.sigma, out=np.zeros(3), where=new.sigma > 0)


def model_of(
    now: Wind | OffsetProcess,
    controller: Controller,
    uav: UAV,
    autopilot: Autopilot,
    path: Path,
    altitude: float,
    time_step: float,
) -> Model:
    """How a disturbance and a controller move the UAV along a path."""
    if isinstance(now, OffsetProcess):
        sigma, keep, enter = stepped(now, time_step, controller)
        spring = Spring(np.array(now.mean), sigma, keep, enter, controller.natural_frequency, controller.speed_share)
        return Model(drift_on, (spring,), controller.speed_share)
    gps = autopilot.gps
    remaining = float(np.exp(-1 / (gps.rate * gps.correlation)))
    body = Body(
        mass=uav.weight / GRAVITY,
        thrust=uav.thrust,
        drag=0.5 * now.air_density * uav.drag_area,
        tan_tilt=float(np.tan(uav.max_tilt)),
        rain=float(rain_force(now.rain_mm_per_h, uav.rain_area)),
        disc=2 * now.air_density * uav.rotor_area,
        profile=profile_share(uav),
        efficiency=uav.drive_efficiency,
        charge=uav.usable_energy,
        trim=np.array(now.mean) if autopilot.trimmed else np.zeros(3),
        omega=controller.natural_frequency,
        pace=controller.speed_share,
        gps_fixes=gps.rate * time_step,
        gps_keep=remaining,
        gps_enter=np.sqrt(1 - remaining**2) * np.array([gps.drift, gps.drift, gps.vertical_drift]),
        gps_velocity=gps.velocity,
    )
    return Model(
        fly_on, (body, air_of(now, passing_speed(now, path, controller), altitude, time_step)), controller.speed_share
    )


def passing_speed(wind: Wind, path: Path, controller: Controller) -> float:
    """Speed of the mean wind past the UAV, its mean over a path; at least 1 m/s, or Dryden gusts would stand still."""
    ground_velocity = controller.speed_share * path.on_legs[:, None] * path.direction
    streams = np.linalg.norm(wind.mean - ground_velocity, axis=1)
    return max(float(np.average(streams, weights=np.diff(path.distance))), 1.0)


def air_of(wind: Wind, air_speed: float, altitude: float, time_step: float) -> Air:
    """The wind for compiled code; the frame of Dryden gusts is that of the mean wind."""
    if wind.gusts == "ou":
        return air_with_memory(np.array(wind.mean), gust_deviations(wind, altitude), wind.correlation, time_step)
    frame, keep, enter, read = np.eye(3), np.zeros((3, 2, 2)), np.zeros((3, 2, 2)), np.zeros((3, 2))
    if wind.gusts == "dryden":
        east, north = np.array(wind.mean[:2]) / np.linalg.norm(wind.mean[:2])
        frame = np.array([[east, -north, 0.0], [north, east, 0.0], [0.0, 0.0, 1.0]])
        for axis, length in enumerate(dryden_parameters(altitude, wind.speed).scale_lengths):
            keep[axis], covariance = lag_step(time_step * air_speed / length)
            enter[axis] = np.linalg.cholesky(covariance)
        read = OUTPUT
    return Air(
        mean=np.array(wind.mean),
        kind=GUSTS.index(wind.gusts),
        frame=frame,
        deviation=gust_deviations(wind, altitude),
        keep=keep,
        enter=enter,
        read=read,
        every=max(round(wind.correlation / time_step), 1),
    )


@compiled
def air_with_memory(mean, deviation, correlation, time_step):
    """Ornstein-Uhlenbeck gusts of σ (3,) [m/s] that forget with a correlation time [s], around a mean wind (3,)."""
    keep, enter = np.zeros((3, 2, 2)), np.zeros((3, 2, 2))
    share = math.exp(-time_step / correlation)
    keep[:, 0, 0] = share
    enter[:, 0, 0] = math.sqrt(1 - share**2)
    return Air(mean, OU, np.eye(3), deviation, keep, enter, np.zeros((3, 2)), 1)
