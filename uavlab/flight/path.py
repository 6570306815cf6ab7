"""How fast a route can be flown: a speed for each waypoint and leg, so that turns and stops stay within what holds."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from uavlab.compiled import compiled
from uavlab.route import Route
from uavlab.spline.curve import BANK
from uavlab.vehicle import GRAVITY, UAV
from uavlab.weather import rain_force
from uavlab.weather.envelope import CREEP, CRUISE, speed_over_ground, steady_air_speed
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
    points = without_standing(route)
    distance, direction = legs_of(points)
    return Path(points, distance, direction, np.full(len(points), speed), np.full(len(points) - 1, speed), BRAKING)


def planned_speed(route: Route, uav: UAV, wind: Wind, speed: float | np.ndarray) -> Path:
    """As fast as asked, but for turns, head winds, drag that the thrust holds, climb, descent and what it can brake.

    Asked is one speed, or one for each leg. Half of what the rotors have left beside weight, rain and mean wind is for
    turns, half for gusts; it may bank by 30° at most.
    """
    points = without_standing(route)
    asked = np.broadcast_to(np.asarray(speed, dtype=float), len(points) - 1).copy()
    return plan(points, asked, np.array(wind.mean), vehicle_in(uav, wind))


class Vehicle(NamedTuple):
    """What a plan has to know of a vehicle in an air density and in rain."""

    mass: float  # [kg]
    held: float  # what its rotors can pull sideways beside weight and rain [N]
    drag: float  # ½ ρ C S [kg/m]
    fastest: float  # through the air, at which a flight is planned [m/s]
    climb: float  # greatest speed upwards [m/s]
    sink: float  # and down


def vehicle_in(uav: UAV, wind: Wind) -> Vehicle:
    """The vehicle in a wind's rain and air."""
    rain = float(rain_force(wind.rain_mm_per_h, uav.rain_area))
    return Vehicle(
        uav.weight / GRAVITY,
        float(uav.horizontal_reserve(rain)),
        0.5 * wind.air_density * uav.drag_area,
        steady_air_speed(uav, rain, wind.air_density, CRUISE),
        uav.climb_speed,
        uav.sink_speed,
    )


@compiled
def plan(points, asked, wind, vehicle):
    """A path over points (N, 3), no faster than asked (N − 1,), in a mean wind (3,); its legs have lengths above 0."""
    distance, direction = legs_of(points)
    legs = len(direction)
    agility = agility_in(wind, vehicle)
    on_legs, at_points = np.empty(legs), np.full(legs + 1, CREEP)
    for leg in range(legs):
        held = speed_over_ground(direction[leg], wind, vehicle.fastest, vehicle.climb, vehicle.sink)
        on_legs[leg] = max(min(held, max(asked[leg], CREEP)), CREEP)
    for n in range(1, legs):
        along = 0.0
        for a in range(3):
            along += direction[n - 1, a] * direction[n, a]
        turn = math.acos(min(max(along, -1.0), 1.0))
        apart = (distance[n] - distance[n - 1] + distance[n + 1] - distance[n]) / 2
        fastest = min(on_legs[n - 1], on_legs[n])
        if turn > 0.0:
            fastest = min(fastest, math.sqrt(agility * apart / turn), TURN_JUMP / (2 * math.sin(turn / 2)))
        at_points[n] = max(fastest, CREEP)
    braking = min(BRAKING, agility)
    brake(at_points, distance, braking)
    return Path(points, distance, direction, at_points, on_legs, braking)


@compiled
def legs_of(points):
    """Distance of each point along a line (N,) [m], and the directions of its legs (N − 1, 3)."""
    distance, direction = np.zeros(len(points)), np.empty((len(points) - 1, 3))
    for leg in range(len(direction)):
        squared = 0.0
        for a in range(3):
            direction[leg, a] = points[leg + 1, a] - points[leg, a]
            squared += direction[leg, a] ** 2
        length = math.sqrt(squared)
        distance[leg + 1] = distance[leg] + length
        for a in range(3):
            direction[leg, a] /= length
    return distance, direction


@compiled
def agility_in(wind, vehicle):
    """Acceleration for turns [m/s²]: half of what the thrust holds beside the mean wind's drag in hover."""
    pushed = vehicle.drag * (wind[0] ** 2 + wind[1] ** 2 + wind[2] ** 2)
    return max(min(GRAVITY * math.tan(BANK), 0.5 * (vehicle.held - pushed) / vehicle.mass), LEAST_AGILITY)


@compiled
def brake(at_points, distance, braking):
    """Lower speeds to those that can be reached from those before and braked to those after, however short the legs."""
    last = len(at_points) - 1
    squared = at_points**2
    for n in range(1, last + 1):
        squared[n] = min(squared[n], squared[n - 1] + 2 * braking * (distance[n] - distance[n - 1]))
    for n in range(last - 1, -1, -1):
        squared[n] = min(squared[n], squared[n + 1] + 2 * braking * (distance[n + 1] - distance[n]))
    for n in range(last + 1):
        at_points[n] = min(max(math.sqrt(max(squared[n], 0.0)), CREEP), at_points[n])


def without_standing(route: Route) -> np.ndarray:
    """The points (N, 3) of a route without legs of no length."""
    return route.points[np.concatenate([[True], route.leg_lengths > 0])]
