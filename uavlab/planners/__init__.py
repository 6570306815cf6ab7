"""Planners: from a city, a start and a goal to a `Route`.

Not arriving is an answer: `reached` is False, and `reason` says why. A question that makes no sense is a `ValueError`;
so is, for every planner, a start and a goal in one voxel, between which there is nothing to plan.
"""

from uavlab.planners.ant_colony import ant_colony
from uavlab.planners.astar import astar, penalty_zone
from uavlab.planners.comparison import Comparison, compare_planners, optimality_gap
from uavlab.planners.hazard import hazard_astar, hazard_price
from uavlab.planners.least_energy import least_energy
from uavlab.planners.least_risk import least_risk, pareto_front
from uavlab.planners.potential_field import potential_field, potential_forces, repulsion
from uavlab.planners.repare import flight_conditions, repare, repare_price
from uavlab.planners.shortcut import shortcut
from uavlab.planners.swarm import refine, waypoint_swarm
from uavlab.planners.theta_star import theta_star

__all__ = [
    "Comparison",
    "ant_colony",
    "astar",
    "compare_planners",
    "flight_conditions",
    "hazard_astar",
    "hazard_price",
    "least_energy",
    "least_risk",
    "optimality_gap",
    "pareto_front",
    "penalty_zone",
    "potential_field",
    "potential_forces",
    "refine",
    "repare",
    "repare_price",
    "repulsion",
    "shortcut",
    "theta_star",
    "waypoint_swarm",
]
