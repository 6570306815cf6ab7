"""From a route to an autopilot: missions, their files, and what to look at before they are flown.

A route is metres on a map. A mission is degrees on the Earth, altitudes above something that is said, few waypoints
that stay clear, and a fence around them. Ground stations read its files, `uavlab.mavlink` takes it to a vehicle.
"""

from uavlab.mission.items import FencePolygon, Item
from uavlab.mission.model import Mission
from uavlab.mission.preflight import Check, Preflight, preflight
from uavlab.mission.readers import read_plan, read_wpl

__all__ = [
    "Check",
    "FencePolygon",
    "Item",
    "Mission",
    "Preflight",
    "preflight",
    "read_plan",
    "read_wpl",
]
