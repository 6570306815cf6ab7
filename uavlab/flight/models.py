"""Two ways to move a UAV through a time step, made ready for compiled code from wind, vehicle and autopilot."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from uavlab.flight.autopilot import Autopilot
from uavlab.flight.disturbance import GUSTS, OffsetProcess, Wind, gust_deviations
from uavlab.flight.motion import Air, Body, Spring, State, drift_on, fly_on
from uavlab.resilience import Controller
from uavlab.vehicle import GRAVITY, UAV
from uavlab.weather import dryden_parameters, rain_force
from uavlab.weather.turbulence import OUTPUT, lag_step


class Model(NamedTuple):
    """A way to move on, and what it needs to know."""

    move: Callable[..., int]
    parts: tuple
    pace: float

    def run(self, *arguments: Any) -> int:
        return self.move(*self.parts, *arguments)

    def hand_over(self, state: State, to: "Model") -> None:
        """Offsets without a body are kept in units of σ: they stay what they are in metres."""
        if isinstance(self.parts[0], Spring):
            old, new = self.parts[0], to.parts[0]
            ratio = np.divide(old.sigma, new.sigma, out=np.zeros(3), where=new.sigma > 0)
            state.lags[:, 0] *= ratio
            state.lags[:, 1] *= ratio * old.omega / new.omega


def model_of(
    now: Wind | OffsetProcess, controller: Controller, uav: UAV, autopilot: Autopilot, altitude: float, time_step: float
) -> Model:
    """How a disturbance and a controller move the UAV."""
    if isinstance(now, OffsetProcess):
        sigma, keep, enter = now.step(time_step, controller)
        spring = Spring(np.array(now.mean), sigma, keep, enter, controller.natural_frequency, controller.speed_share)
        return Model(drift_on, (spring,), controller.speed_share)
    gps = autopilot.gps
    body = Body(
        mass=uav.weight / GRAVITY,
        thrust=uav.thrust,
        drag=0.5 * now.air_density * uav.drag_area,
        tan_tilt=float(np.tan(uav.max_tilt)),
        rain=float(rain_force(now.rain_mm_per_h, uav.rain_area)),
        trim=np.array(now.mean) if autopilot.trimmed else np.zeros(3),
        omega=controller.natural_frequency,
        pace=controller.speed_share,
        gps_position=gps.position,
        gps_velocity=gps.velocity,
        gps_every=max(round(1 / (gps.rate * time_step)), 1),
    )
    return Model(fly_on, (body, air_of(now, uav, altitude, time_step)), controller.speed_share)


def air_of(wind: Wind, uav: UAV, altitude: float, time_step: float) -> Air:
    """The wind for compiled code; the frame of Dryden gusts is that of the mean wind."""
    frame, keep, enter, read = np.eye(3), np.zeros((3, 2, 2)), np.zeros((3, 2, 2)), np.zeros((3, 2))
    if wind.gusts == "ou":
        share = np.exp(-time_step / wind.correlation)
        keep[:, 0, 0], enter[:, 0, 0] = share, np.sqrt(1 - share**2)
    elif wind.gusts == "dryden":
        east, north = np.array(wind.mean[:2]) / np.linalg.norm(wind.mean[:2])
        frame = np.array([[east, -north, 0.0], [north, east, 0.0], [0.0, 0.0, 1.0]])
        passing = np.hypot(wind.speed, uav.cruise_speed)
        for axis, length in enumerate(dryden_parameters(altitude, wind.speed).scale_lengths):
            keep[axis], covariance = lag_step(time_step * passing / length)
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
