"""What a mission flies on a map, leg by leg from take-off to landing, and how flights of it go in a weather.

A mission says where to be, not how to get there. Here it is spelled out: up from home, straight or along the ground
from item to item, with corners that may be cut, back home if it says so, and down to what lies there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from uavlab.city import City
from uavlab.flight.autopilot import Autopilot, Gps
from uavlab.flight.results import Flight
from uavlab.flight.simulation import TIME_STEP, Setup, flown, setup_of
from uavlab.mission.corridor import above_ground, corner, cut_off, floor_below, touchable
from uavlab.mission.items import CHANGE_SPEED, LAND, LOITER, PLACED, RETURN, TAKEOFF, TERRAIN, WAYPOINT, Item, has_place
from uavlab.mission.model import Mission
from uavlab.power import power_needed
from uavlab.route import Route
from uavlab.vehicle import UAV
from uavlab.weather import Wind, ground_speed_held
from uavlab.weather.envelope import CREEP

CLIMB, SINK, TOUCH_DOWN, LAST_METRES = 3.0, 2.0, 0.7, 5.0
"""Vertical speeds: taking off, descending, and the last metres [m/s]; and how many these are [m]. `uavlab.vehicle_sim`
flies so, and most autopilots do unless they are told otherwise."""

ROUNDED = 0.01
"""So far degrees and altitudes of a mission, which are rounded, may move its way [m]."""

FARTHEST = 50e3
"""From the map [m]; a mission that is farther belongs to another one."""

NEVER = 10**9
"""In so many steps a row of a flight's log, besides its last."""

MOST = 0.95
"""The share of flights for which the energy is enough, and how sure that is."""


class Stop(NamedTuple):
    """Where a leg ends."""

    point: np.ndarray
    number: int
    """Of the item that leads there; −1 of home."""
    speed: float
    """On the way there [m/s]."""
    hold: float = 0.0
    radius: float = 0.0
    """From how near on it may turn to the next one [m]; 0 where it stops."""
    follows: bool = False
    """Whether the way there follows the ground."""


class Leg(NamedTuple):
    """A straight piece of the way."""

    start: np.ndarray
    end: np.ndarray
    aside: float
    """How far from it the way may lie [m]."""
    stop: Stop

    @property
    def named(self) -> str:
        return f"on the way to item {self.stop.number}"


class MissionWay(NamedTuple):
    """All that a mission flies."""

    mission: Mission
    city: City
    stops: list[Stop]
    """Home, above home, and so on."""
    takes_off: bool
    lands: bool
    legs: list[Leg]
    corners: list[Leg]
    """As far before and after as they may be rounded, two by two or more."""

    @property
    def begin(self) -> np.ndarray:
        """Above home, (3,) [m]."""
        return self.stops[1].point

    @property
    def end(self) -> np.ndarray:
        """Where it hovers or begins to land, (3,) [m]."""
        return self.stops[-1].point

    @property
    def columns(self) -> list[Leg]:
        """Take-off and landing."""
        floor = np.array([*self.end[:2], min(floor_below(self.city, self.end)[0], self.end[2])])
        down = Leg(self.end, floor, 0.0, self.stops[-1]._replace(speed=SINK))
        return [Leg(self.stops[0].point, self.begin, 0.0, self.stops[1])] + [down] * self.lands


def way_of(mission: Mission, city: City) -> MissionWay:
    """What a mission flies on a map, item by item, until it lands or stays."""
    stops, speed = [Stop(mission.home_on(city), -1, CLIMB)], mission.speed
    takes_off = lands = False
    for number, item in enumerate(mission.items):
        if item.command == CHANGE_SPEED:
            speed = said(item.parameters[1], speed)
        elif item.command == RETURN or has_place(item):
            takes_off = takes_off or (len(stops) == 1 and item.command == TAKEOFF)
            for stop in stops_of(mission, city, stops, number, item, speed):
                last = stops[-1]
                if len(stops) > 1 and np.linalg.norm(stop.point - last.point) <= ROUNDED:
                    stops[-1] = last._replace(hold=last.hold + stop.hold, radius=0.0)
                else:
                    stops.append(stop)
            lands = item.command in (LAND, RETURN)
            if lands or item.command == LOITER:
                break
    if len(stops) == 1:
        raise ValueError("mission must have an item at a place, and has none: add waypoints")
    inside = room_inside(city, np.array([stop.point for stop in stops]))
    if inside < -FARTHEST:
        raise ValueError(
            f"mission lies {-inside / 1000:.0f} km off city {city.name!r}: give the city that it is flown in"
        )
    legs = [leg for one, other in pairwise(stops[1:]) for leg in along(city, one.point, other)]
    corners = [leg for three in zip(stops[1:], stops[2:], stops[3:], strict=False) for leg in rounded(city, *three)]
    hover = Leg(stops[1].point, stops[1].point, 0.0, stops[1])
    return MissionWay(mission, city, stops, takes_off, lands, legs or [hover], corners)


def said(value: float, otherwise: float) -> float:
    """What a parameter says; 0, NaN and less say nothing."""
    return value if value > 0 else otherwise


def stops_of(mission: Mission, city: City, so_far: Sequence[Stop], number: int, item: Item, speed: float) -> list[Stop]:
    """Where an item leads, from the last stop so far."""
    home, here = so_far[0].point, so_far[-1].point
    if item.command not in (*PLACED, RETURN):
        raise ValueError(f"mission: items[{number}], {item!r}, has a place, and what is flown there isn't known")
    if len(so_far) == 1 and item.command in (RETURN, LAND):
        raise ValueError(f"mission: items[{number}] lands before it has flown anywhere: add waypoints")
    if item.command == RETURN:
        top = max(here[2], home[2] + mission.return_height)
        return [Stop(np.array([*here[:2], top]), number, CLIMB), Stop(np.array([*home[:2], top]), number, speed)]
    point = mission.point_of(item, city, home)
    if item.command == LAND:
        return [Stop(np.array([*point[:2], here[2]]), number, speed)]
    first, second = item.parameters[:2]
    hold = said(first, 0.0) if item.command == WAYPOINT else 0.0
    radius = said(second, mission.corner_radius) if item.command == WAYPOINT and hold == 0 else 0.0
    rises = item.command == TAKEOFF or len(so_far) == 1
    risen = [Stop(np.array([*here[:2], point[2]]), number, CLIMB)] if rises else []
    return [*risen, Stop(point, number, speed, hold, radius, item.frame == TERRAIN)]


def along(
    city: City, start: np.ndarray, stop: Stop, first: float = 0.0, last: float = 1.0, aside: float = 0.0
) -> list[Leg]:
    """A leg, or a share of it; one that follows the ground in pieces, in which the ground leaves a straight line."""
    leg = stop.point - start
    if not stop.follows or city.ground is None:
        return [Leg(start + first * leg, start + last * leg, aside, stop)]
    share, _ = above_ground(city, start + first * leg, start + last * leg)
    share = first + (last - first) * share[..., None]
    height = city.height_above_ground(np.array([start, stop.point]))
    points = start + share * leg
    points[..., 2] += height[0] + share[..., 0] * (height[1] - height[0]) - city.height_above_ground(points)
    bulge = np.linalg.norm(points[1] - (points[0] + points[2]) / 2, axis=1)
    return [Leg(a, b, aside + float(off), stop) for a, b, off in zip(points[0], points[2], bulge, strict=True)]


def rounded(city: City, before: Stop, here: Stop, after: Stop) -> list[Leg]:
    """What a corner that may be rounded takes beside its legs."""
    if here.radius == 0:
        return []
    into, out, reach = corner(before.point, here.point, after.point, here.radius)
    aside = cut_off(into, out, reach)
    share_in, share_out = (reach / float(np.linalg.norm(here.point - other.point)) for other in (before, after))
    return along(city, before.point, here, 1 - share_in, 1.0, aside) + [
        leg._replace(stop=here) for leg in along(city, here.point, after, 0.0, share_out, aside)
    ]


def room_inside(city: City, points: np.ndarray) -> float:
    """How far inside of the map all points (N, 2 or 3) are [m], negative outside; upwards where something goes on."""
    bounds = city.bounds
    if not (city.occupied[..., -1].any() or city.in_no_fly[..., -1].any()):
        bounds[1, 2] = np.inf
    low, high = bounds[:, : points.shape[1]]
    return float(np.minimum(points - low, high - points).min())


def least_room(space: City, legs: Sequence[Leg]) -> tuple[float, Leg]:
    """Least distance of legs to what is occupied [m], and of which."""
    room = space.segment_distance([leg.start for leg in legs], [leg.end for leg in legs])
    room = room - [leg.aside for leg in legs]
    return float(room.min()), legs[int(room.argmin())]


def speeds_of(legs: Sequence[Leg], uav: UAV, wind: Wind) -> tuple[np.ndarray, np.ndarray]:
    """Speeds over ground on legs that are asked for, and that the UAV holds, (N,) each [m/s]."""
    length = np.array([np.linalg.norm(leg.end - leg.start) for leg in legs])
    ways = np.array([leg.end - leg.start for leg in legs]) / np.maximum(length, 1e-9)[:, None]
    held = ground_speed_held(uav, ways, wind.mean, rain_mm_per_h=wind.rain_mm_per_h, air_density=wind.air_density)
    return np.array([leg.stop.speed for leg in legs]), np.maximum(held, 0.0)


def planned_time(way: MissionWay, uav: UAV, wind: Wind) -> float:
    """How long a mission takes in the mean wind [s]."""
    legs = [*way.legs, *way.columns]
    speed = np.maximum(np.minimum(*speeds_of(legs, uav, wind)), CREEP)
    length = np.array([np.linalg.norm(leg.end - leg.start) for leg in legs])
    return float((length / speed).sum()) + sum(stop.hold for stop in way.stops)


def drift_after(seconds: float, gps: Gps) -> float:
    """σ of GPS, to the east or north, so long after the start [m]."""
    return gps.drift * float(np.sqrt(1 - np.exp(-2 * seconds / gps.correlation)))


class Trial(NamedTuple):
    """How one simulated flight went."""

    energy: float
    """[J]"""
    seconds: float
    failed: str
    """Why it didn't arrive."""


def ready(way: MissionWay, uav: UAV, wind: Wind, gps: Gps) -> Setup:
    """What is simulated: the way from just above the ground to the ground, each leg at its speed, no battery."""
    low = np.array([*way.begin[:2], min(touchable(way.city, way.begin, uav.diameter), way.begin[2])])
    points, speeds = [low, way.begin, *(leg.end for leg in way.legs)], [CLIMB, *(leg.stop.speed for leg in way.legs)]
    if way.lands:
        floor = way.columns[1].end
        points += [np.array([*floor[:2], min(way.end[2], floor[2] + LAST_METRES)]), floor]
        speeds += [SINK, TOUCH_DOWN]
    far = np.linalg.norm(np.diff(points, axis=0), axis=1) > ROUNDED / 100
    if not far.any():
        raise ValueError("mission must fly somewhere, and stays where it begins: add waypoints")
    route, speed = Route(np.array(points)[np.append(True, far)]), np.array(speeds)[far]
    autopilot = Autopilot(gps=gps, speed=float(speed.max()), heeds_limits=False)
    step = min(TIME_STEP, 1 / gps.rate)
    setup, _ = setup_of(route, way.city, replace(uav, battery=np.inf), wind, autopilot, step)
    assert setup is not None
    return replace(setup, speed=speed)  # one for each leg, which its path takes as well


def tried_out(setup: Setup, way: MissionWay, generators: Sequence[np.random.Generator]) -> list[Trial]:
    """The flights, with what is added to each: rising from the ground, hovering, and what is left to the ground."""
    uav, wind, start = setup.uav, setup.disturbance, setup.route.points[0]
    assert isinstance(wind, Wind)
    up, down = min(CLIMB, uav.climb_speed), min(TOUCH_DOWN, uav.sink_speed)
    power = power_needed(
        uav, [(0, 0, up), (0, 0, 0), (0, 0, -down)], wind.mean, rain_mm_per_h=wind.rain_mm_per_h,
        air_density=wind.air_density,
    ).battery  # fmt: skip
    rising, holding = max(start[2] - way.stops[0].point[2], 0.0) / up, sum(stop.hold for stop in way.stops)
    trials = []
    for generator in generators:
        flight = flown(setup, generator, every=NEVER)
        last, failed = flight.position[-1], "" if flight.outcome == "arrived" else flight.reason
        if failed and touched_down(flight, way, uav):
            failed = ""
        left = max(last[2] - floor_below(way.city, last)[0], 0.0) / down if way.lands else 0.0
        seconds = np.array([rising, holding, left])
        assert flight.energy is not None
        trials.append(Trial(flight.energy.battery + float(power @ seconds), flight.duration + seconds.sum(), failed))
    return trials


def touched_down(flight: Flight, way: MissionWay, uav: UAV) -> bool:
    """Whether a flight that crashed has landed: on its last leg, touching what lies below it."""
    place, target = flight.position[-1], flight.reference[-1]
    landing = way.lands and np.hypot(*(target - way.end)[:2]) <= ROUNDED and target[2] < way.end[2]
    return flight.outcome == "crashed" and bool(landing) and bool(place[2] < touchable(way.city, place, uav.diameter))


def most_take(values: Sequence[float]) -> tuple[float, str]:
    """What 95 % of all such values don't exceed, from above, with a confidence of 95 %; the greatest of too few."""
    from scipy.stats import binom

    count = len(values)
    rank = int(binom.ppf(MOST, count, MOST)) + 1
    if rank > count:
        return max(values), f"the most of {count} flights; a bound for 95 % of all needs 59"
    return sorted(values)[
        rank - 1
    ], f"95 % of all flights need no more; of that we are 95 % sure, by {count} that arrived"
