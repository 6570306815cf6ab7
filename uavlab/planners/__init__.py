"""Planners: from a city, a start and a goal to a `Route`."""

from uavlab.planners.astar import astar, penalty_zone
from uavlab.planners.shortcut import shortcut

__all__ = ["astar", "penalty_zone", "shortcut"]
