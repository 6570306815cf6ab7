"""How fast a route can be flown: a speed for each waypoint and leg, so that turns and stops stay within what holds."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from uavlab.route import Route
from uavlab.spline.curve import BANK
from uavlab.vehicle import GRAVITY, UAV
from uavlab.weather import ground_speed_held, rain_force, wind_drag
from uavlab.weather.envelope import CREEP
from uavlab.weather.wind import Wind

TURN_JUMP = 1.0
"""By how much the velocity may jump at a waypoint [m/s]; the autopilot begins to turn a moment before."""

BRAKING = 2.0
"""Along the route [m/s²]."""

LEAST_AGILITY = 0.1
"""Of a UAV that a wind which came in flight leaves nothing [m/s²]."""


class Path(NamedTuple):
    """A route for compiled code."""

    points: np.ndarray  # (N, 3) [m]
    distance: np.ndarray  # (N,) [m]
    direction: np.ndarray  # (N − 1, 3) of the legs
    at_points: np.ndarray  # (N,) greatest speed there [m/s]
    on_legs: np.ndarray  # (N − 1,) and in between
    braking: float  # [m/s²]


def constant_speed(route: Route, speed: float) -> Path:
    """The same speed all the way."""
    return Path(*geometry(route), np.full(len(route.points), speed), np.full(len(route.points) - 1, speed), BRAKING)


def planned_speed(route: Route, uav: UAV, wind: Wind, speed: float | np.ndarray) -> Path:
    """As fast as asked, but for turns, head winds, drag that the thrust holds, climb, descent and what it can brake.

    Asked is one speed, or one for each leg. Half of what the rotors have left beside weight, rain and mean wind is for
    turns, half for gusts; it may bank by 30° at most.
    """
    points, distance, direction = geometry(route)
    mass = uav.weight / GRAVITY
    held, pushed = level_thrust(uav, wind)
    agility = max(min(GRAVITY * np.tan(BANK), 0.5 * (held - pushed) / mass), LEAST_AGILITY)
    held_there = ground_speed_held(
        uav, direction, wind.mean, rain_mm_per_h=wind.rain_mm_per_h, air_density=wind.air_density
    )
    on_legs = np.clip(held_there, CREEP, np.maximum(speed, CREEP))
    at_points = np.full(len(points), CREEP)
    turn = np.arccos(np.clip((direction[:-1] * direction[1:]).sum(axis=1), -1.0, 1.0))
    apart = (np.diff(distance)[:-1] + np.diff(distance)[1:]) / 2
    with np.errstate(divide="ignore"):
        smooth = np.sqrt(agility * apart / turn)
        sharp = TURN_JUMP / (2 * np.sin(turn / 2))
    at_points[1:-1] = np.maximum(np.min([on_legs[:-1], on_legs[1:], smooth, sharp], axis=0), CREEP)
    braking = min(BRAKING, agility)
    return Path(points, distance, direction, within_braking(at_points, distance, braking), on_legs, braking)


def within_braking(at_points: np.ndarray, distance: np.ndarray, braking: float) -> np.ndarray:
    """Speeds that can be reached from those before and braked to those after, however short the legs."""
    gained = 2 * braking * distance
    squared = np.minimum.accumulate(at_points**2 - gained) + gained
    squared = np.minimum.accumulate((squared + gained)[::-1])[::-1] - gained
    return np.clip(np.sqrt(np.maximum(squared, 0.0)), CREEP, at_points)


def geometry(route: Route) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points, distances and directions of a route, without legs of no length."""
    flown = Route(route.points[np.concatenate([[True], route.leg_lengths > 0])])
    return flown.points, flown.distance, np.diff(flown.points, axis=0) / flown.leg_lengths[:, None]


def level_thrust(uav: UAV, wind: Wind) -> tuple[float, float]:
    """What rotors can pull sideways beside weight and rain, and what the mean wind pushes while hovering [N]."""
    held = float(uav.horizontal_reserve(rain_force(wind.rain_mm_per_h, uav.rain_area)))
    drag = wind_drag(wind.mean, (0.0, 0.0, 0.0), uav.drag_area, air_density=wind.air_density)
    return held, float(np.linalg.norm(drag))
