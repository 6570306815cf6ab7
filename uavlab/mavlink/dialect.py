"""MAVLink's words: pymavlink's messages of version 2, and what their numbers mean."""

from __future__ import annotations

from functools import cache
from typing import Any

from uavlab.requirements import require

MISSION, FENCE, RALLY_POINTS, EVERYTHING = 0, 1, 2, 255
"""Types of plans that a vehicle keeps (MAV_MISSION_TYPE)."""

PLANS = {MISSION: "mission", FENCE: "fence", RALLY_POINTS: "rally points"}

ACCEPTED = 0
"""MAV_MISSION_RESULT and MAV_RESULT alike."""

CANCELLED = 15
"""MAV_MISSION_OPERATION_CANCELLED: who waited for items gave up."""

ARDUPILOT, PX4 = 3, 12
"""MAV_AUTOPILOT."""

RETURN_HEIGHTS = {ARDUPILOT: ("RTL_ALT", 100.0), PX4: ("RTL_RETURN_ALT", 1.0)}
"""What autopilots call the height at which they return, and in which parts of a metre."""

ARMED, EMERGENCY, ON_GROUND = 128, 6, 1
"""Bit of a mode (MAV_MODE_FLAG); a state (MAV_STATE), with motors that stand a crash; MAV_LANDED_STATE."""

PX4_MODES = {2: "take off", 3: "hold", 4: "mission", 5: "return", 6: "land"}
ARDUPILOT_MODES = {3: "mission", 5: "hold", 6: "return", 9: "land"}
"""What autopilots do on their own, by their numbers for it; of PX4 those below its main mode of that."""

ARM, START_MISSION, SET_MODE, GO_HOME, LAND_HERE, REQUEST_MESSAGE = 400, 300, 176, 20, 21, 512
"""Commands that are sent alone (MAV_CMD)."""

HOME_POSITION = 242
"""Number of that message."""


@cache
def messages() -> Any:
    """The module of pymavlink with all messages."""
    return require("pymavlink.dialects.v20.common", "mavlink")


def codec(system: int, component: int) -> Any:
    """What packs messages of one sender, and reads those of others; a corrupted one becomes BAD_DATA."""
    made = messages().MAVLink(None, srcSystem=system, srcComponent=component)
    made.robust_parsing = True
    return made


def packed(codec: Any, message: Any) -> bytes:
    """A message as it travels, with the next sequence number."""
    data = message.pack(codec)
    codec.seq = (codec.seq + 1) % 256
    return data


def sender_of(message: Any) -> tuple[int, int]:
    """System and component that a message is from."""
    return message.get_srcSystem(), message.get_srcComponent()


def name_of(enumeration: str, value: int) -> str:
    """What a number means, in words: "MAV_MISSION_INVALID_PARAM5_X" is "invalid param5 x"."""
    entry = messages().enums[enumeration].get(value)
    if entry is None:
        return f"number {value}"
    prefix = "MAV_MISSION_" if enumeration == "MAV_MISSION_RESULT" else f"{enumeration}_"
    return entry.name.removeprefix(prefix).replace("_", " ").lower()
