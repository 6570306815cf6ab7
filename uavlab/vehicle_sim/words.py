"""What the vehicle says of itself: where it is, what it does, what it can."""

from __future__ import annotations

from typing import Any

import numpy as np

from uavlab.mavlink.dialect import ARDUPILOT, ARDUPILOT_MODES, ARMED, EMERGENCY, ON_GROUND, PX4, PX4_MODES, messages
from uavlab.vehicle_sim.pilot import CRASHED, HOLDING, LANDING, READY, Pilot

MODES = {ARDUPILOT: ARDUPILOT_MODES, PX4: PX4_MODES}
NUMBERS = {autopilot: {name: number for number, name in modes.items()} for autopilot, modes in MODES.items()}
"""Of what it does, by its name."""

INSTEAD = {READY: HOLDING, CRASHED: LANDING}
"""What it says of modes that have no number."""

PX4_AUTO = 4
"""PX4's main mode of all these."""

VERSION = 148
"""Number of the message that says what an autopilot can do."""

CAN = 4 | 8 | 8192 | 16384 | 32768
"""Missions and commands as whole numbers, MAVLink 2, fences, rally points (MAV_PROTOCOL_CAPABILITY)."""

QUADROTOR, OWN_MODES, GUIDED = 2, 1, 8
"""MAV_TYPE and bits of MAV_MODE_FLAG."""

STANDBY, ACTIVE, IN_AIR = 3, 4, 2
"""MAV_STATE and MAV_LANDED_STATE."""

GPS_SENSOR, FIX_3D, SATELLITES, BOUNDARY, WARNING, UNKNOWN = 32, 3, 12, 3, 4, 65535
LONGEST_TEXT = 50


def state_of(pilot: Pilot, autopilot: int) -> list[Any]:
    """What it says once a second: heartbeat, battery, whether it stands, its fence, its GPS."""
    words, where, uav = messages(), pilot.body.where, pilot.body.uav
    base = OWN_MODES | GUIDED | ARMED * pilot.armed
    number = NUMBERS[autopilot][INSTEAD.get(pilot.mode, pilot.mode)]
    mode = number if autopilot == ARDUPILOT else PX4_AUTO << 16 | number << 24
    status = EMERGENCY if pilot.mode == CRASHED else ACTIVE if pilot.armed else STANDBY
    left = max(round(100 * (1 - where.used / uav.battery)), 0) if np.isfinite(uav.battery) else -1
    sensors = [GPS_SENSOR] * 3
    return [
        words.MAVLink_heartbeat_message(QUADROTOR, autopilot, base, mode, status, 3),
        words.MAVLink_sys_status_message(*sensors, 0, UNKNOWN, -1, left, 0, 0, 0, 0, 0, 0),
        words.MAVLink_extended_sys_state_message(0, ON_GROUND if pilot.body.path is None else IN_AIR),
        words.MAVLink_fence_status_message(int(pilot.breached), 0, BOUNDARY * pilot.breached, 0),
        words.MAVLink_gps_raw_int_message(
            round(1e6 * where.time), FIX_3D, *degrees(pilot, where.seen), *[UNKNOWN] * 4, SATELLITES
        ),
    ]


def position_of(pilot: Pilot) -> Any:
    """Where it believes to be, and how fast."""
    where = pilot.body.where
    east, north, up = (round(100 * float(value)) for value in where.velocity)
    above = round(1000 * float(where.seen[2] - pilot.home[2]))
    return messages().MAVLink_global_position_int_message(
        round(1000 * where.time), *degrees(pilot, where.seen), above, north, east, -up, UNKNOWN
    )


def home_of(pilot: Pilot) -> Any:
    """Where it would return to."""
    return messages().MAVLink_home_position_message(*degrees(pilot, pilot.home), 0, 0, 0, [1, 0, 0, 0], 0, 0, 0)


def version() -> Any:
    """What it can do."""
    return messages().MAVLink_autopilot_version_message(CAN, 0, 0, 0, 0, [0] * 8, [0] * 8, [0] * 8, 0, 0, 0)


def spoken(pilot: Pilot) -> list[Any]:
    """What it said since it was asked last, cut to what fits."""
    said = [messages().MAVLink_statustext_message(WARNING, words.encode()[:LONGEST_TEXT]) for words in pilot.words]
    pilot.words.clear()
    return said


def degrees(pilot: Pilot, point: np.ndarray) -> tuple[int, int, int]:
    """Latitude, longitude, and height in millimetres of a point of the map, as they travel."""
    longitude, latitude, height = pilot.city.to_geographic(point).tolist()
    return round(latitude * 1e7), round(longitude * 1e7), round(1000 * height)
