"""How fast a route can be flown: a speed for each waypoint and leg, so that turns and stops stay within what holds."""

from typing import NamedTuple

import numpy as np

from uavlab.flight.disturbance import Wind
from uavlab.route import Route
from uavlab.spline.curve import BANK
from uavlab.vehicle import GRAVITY, UAV
from uavlab.weather import rain_force, wind_drag

TURN_JUMP = 1.0
"""By how much the velocity may jump at a waypoint [m/s]; the autopilot begins to turn a moment before."""

BRAKING = 2.0
"""Along the route [m/s²]."""

CRUISE = 0.8
"""Share of the thrust left over sideways that steady drag may take; the rest is for gusts and turns."""

LEAST_AGILITY = 0.1
"""Of a UAV that a wind which came in flight leaves nothing [m/s²]."""

CREEP = 0.1
"""With what a flight begins and ends [m/s]."""


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


def planned_speed(route: Route, uav: UAV, wind: Wind, speed: float) -> Path:
    """As fast as asked, but for turns, for head winds, for the drag that the thrust holds and what it can brake.

    Half of what the rotors have left beside weight, rain and mean wind is for turns, half for gusts; it may bank by
    30° at most.
    """
    points, distance, direction = geometry(route)
    mass = uav.weight / GRAVITY
    held, pushed = level_thrust(uav, wind)
    agility = max(min(GRAVITY * np.tan(BANK), 0.5 * (held - pushed) / mass), LEAST_AGILITY)
    on_legs = np.clip(ground_speed_held(uav, wind, direction, CRUISE), CREEP, max(speed, CREEP))
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


def air_speed_held(uav: UAV, wind: Wind, share: float = 1.0) -> float:
    """Greatest steady speed through the air [m/s]: the top speed, or less where a share of the thrust holds less."""
    held, _ = level_thrust(uav, wind)
    return min(uav.top_speed, float(np.sqrt(2 * share * held / (wind.air_density * uav.drag_area))))


def ground_speed_held(uav: UAV, wind: Wind, direction: np.ndarray, share: float = 1.0) -> np.ndarray:
    """Greatest steady speed over ground on each leg (L, 3), (L,) [m/s]; −∞ where the wind blows it off its course."""
    fastest, along = air_speed_held(uav, wind, share), direction @ wind.mean
    across = np.sqrt(np.maximum(wind.speed**2 - along**2, 0.0))
    return np.where(across < fastest, along + np.sqrt(np.maximum(fastest**2 - across**2, 0.0)), -np.inf)


def why_grounded(route: Route, uav: UAV, wind: Wind) -> str:
    """Why a UAV can't fly a route in a wind; empty if it can."""
    held, pushed = level_thrust(uav, wind)
    if pushed >= held:
        return (
            f"a wind of {wind.speed:.1f} m/s pushes with {pushed:.1f} N, the thrust left over holds {held:.1f} N: "
            f"{pushed - held:.1f} N short"
        )
    direction = geometry(route)[2]
    along = direction @ wind.mean
    across = np.sqrt(np.maximum(wind.speed**2 - along**2, 0.0))
    worst = int(np.argmax(across))
    fastest = air_speed_held(uav, wind)
    limit = f"the top speed is {uav.top_speed:g} m/s"
    if fastest < uav.top_speed:
        limit = f"its thrust holds {fastest:.1f} m/s through the air"
    if across[worst] >= fastest:
        return f"crosswind of {across[worst]:.1f} m/s on leg {worst}, {limit}"
    slowest = ground_speed_held(uav, wind, direction)
    worst = int(np.argmin(slowest))
    if slowest[worst] <= CREEP:
        side = "head wind" if -along[worst] >= across[worst] else "crosswind"
        return f"{side} of {max(-along[worst], across[worst]):.1f} m/s on leg {worst}, {limit}"
    return ""
