"""Whether the vehicle takes an item of a mission, a fence or rally points, and what it answers if not."""

from __future__ import annotations

from typing import Any

from uavlab.mavlink.coding import item_of
from uavlab.mavlink.dialect import ACCEPTED, FENCE, MISSION, RALLY_POINTS
from uavlab.mission.items import (
    CHANGE_SPEED,
    COMMANDS,
    EXCLUDE,
    FRAMES,
    INCLUDE,
    PLACED,
    RALLY,
    WAYPOINT,
    Item,
)

UNSUPPORTED_FRAME, UNSUPPORTED, NO_SPACE, INVALID, INVALID_SEQUENCE, DENIED = 2, 3, 4, 5, 13, 14
"""Answers of the mission protocol (MAV_MISSION_RESULT)."""

INVALID_HOLD, INVALID_SPEED, INVALID_PLACE, INVALID_ALTITUDE = 6, 7, 10, 12
"""The same of the first, second, fifth and seventh parameter."""

WRONG = {"parameters": INVALID, "altitude": INVALID_ALTITUDE}
"""What to answer, by what is wrong with an item; else it is its place."""


def judged(message: Any, kind: int) -> tuple[int, Item | None]:
    """An item, or None and why it isn't taken."""
    known = {MISSION: tuple(COMMANDS), FENCE: (INCLUDE, EXCLUDE), RALLY_POINTS: (RALLY,)}[kind]
    if message.command not in known:
        return UNSUPPORTED, None
    try:
        item = item_of(message)
    except ValueError as error:
        return next((answer for word, answer in WRONG.items() if word in str(error)), INVALID_PLACE), None
    placed = kind != MISSION or item.command in PLACED
    if placed and item.frame not in FRAMES.values():
        return UNSUPPORTED_FRAME, None
    if item.command == CHANGE_SPEED and not item.parameters[1] > 0:
        return INVALID_SPEED, None
    if item.command == WAYPOINT and item.parameters[0] < 0:
        return INVALID_HOLD, None
    return ACCEPTED, item
