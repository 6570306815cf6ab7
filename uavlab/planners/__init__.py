"""Planners: from a city, a start and a goal to a `Route`."""

from uavlab.planners.astar import astar, penalty_zone
from uavlab.planners.least_risk import least_risk, pareto_front
from uavlab.planners.shortcut import shortcut

__all__ = ["astar", "least_risk", "pareto_front", "penalty_zone", "shortcut"]
