"""Missions as items of MAVLink: what goes to a vehicle, and what comes back."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from uavlab.city.place import Place
from uavlab.mavlink.dialect import ARDUPILOT, FENCE, MISSION, RALLY_POINTS, messages
from uavlab.mission.items import EXCLUDE, HOME, INCLUDE, RALLY, SEA, WAYPOINT, FencePolygon, Item, checked_item
from uavlab.mission.model import Mission
from uavlab.mission.plan_file import SAME_FRAMES

SCALE = 1e7
"""Degrees travel in whole 1e-7."""


def items_of(mission: Mission, kind: int, autopilot: int) -> list[Item]:
    """A mission, its fence or its rally points as items; of ArduPilot's missions the first one is home."""
    if kind == FENCE:
        return [corner for polygon in mission.fence for corner in corners_of(polygon)]
    if kind == RALLY_POINTS:
        return [Item(RALLY, HOME, (0.0, 0.0, 0.0, 0.0), p.latitude, p.longitude, p.height) for p in mission.rally]
    home = Item(WAYPOINT, SEA, (0.0, 0.0, 0.0, 0.0), mission.home.latitude, mission.home.longitude, mission.home.height)
    return [home] * (autopilot == ARDUPILOT) + list(mission.items)


def corners_of(polygon: FencePolygon) -> list[Item]:
    """A polygon as one item for each corner, each saying how many there are."""
    command = INCLUDE if polygon.inclusion else EXCLUDE
    count = float(len(polygon.corners))
    return [Item(command, SEA, (count, 0.0, 0.0, 0.0), *corner, 0.0) for corner in polygon.corners]


def polygons_of(corners: Sequence[Item]) -> tuple[FencePolygon, ...]:
    """The way back."""
    found, rest = [], list(corners)
    while rest:
        count = int(rest[0].parameters[0])
        ring, rest = rest[:count], rest[count:]
        if count < 3 or len(ring) < count or any(one[:3] != ring[0][:3] for one in ring):
            raise ValueError(f"the vehicle's fence is damaged: a polygon of {count} corners has {len(ring)}")
        found.append(FencePolygon(tuple((c.latitude, c.longitude) for c in ring), ring[0].command == INCLUDE))
    return tuple(found)


def message_of(item: Item, number: int, kind: int, target: tuple[int, int]) -> Any:
    """An item as a message."""
    return messages().MAVLink_mission_item_int_message(
        *target, number, item.frame, item.command, int(number == 0 and kind == MISSION), 1, *item.parameters,
        round(item.latitude * SCALE), round(item.longitude * SCALE), item.altitude, kind,
    )  # fmt: skip


def item_of(message: Any) -> Item:
    """A message as an item; `ValueError` if a number in it is out of its range."""
    parameters = (message.param1, message.param2, message.param3, message.param4)
    frame = SAME_FRAMES.get(message.frame, message.frame)
    if not math.isfinite(message.z):
        raise ValueError("altitude must be finite")
    item = Item(message.command, frame, parameters, message.x / SCALE, message.y / SCALE, message.z)
    return checked_item(f"item {message.seq}", item)


def rally_of(items: Sequence[Item]) -> tuple[Place, ...]:
    """Rally points from their items."""
    return tuple(Place(item.longitude, item.latitude, item.altitude) for item in items)
