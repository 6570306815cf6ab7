"""A ground station: missions to a vehicle by MAVLink, and what it says in flight.

`upload` gives a mission with its fence and reads it back, `start` lets the vehicle fly it, `follow` tells how it goes.
Needs pymavlink, the extra `mavlink`. A vehicle to talk to without leaving the desk is `uavlab.vehicle_sim`.
"""

from uavlab.mavlink.commands import CommandDeniedError, go_home, hold, land, start
from uavlab.mavlink.link import Link, connect
from uavlab.mavlink.telemetry import FlightLog, Telemetry, follow
from uavlab.mavlink.transfer import MissionRejectedError, download, upload

__all__ = [
    "CommandDeniedError",
    "FlightLog",
    "Link",
    "MissionRejectedError",
    "Telemetry",
    "connect",
    "download",
    "follow",
    "go_home",
    "hold",
    "land",
    "start",
    "upload",
]
