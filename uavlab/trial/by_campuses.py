"""What RISK-ACO and PSO-BAS say of routes of least risk: how much risk a detour saves, and what can be flown."""

from __future__ import annotations

from typing import Any

import numpy as np

from uavlab.planners import least_risk
from uavlab.risk import CAMPUS_FLIGHT, RiskMap, random_campus, reference_campus
from uavlab.route import Route
from uavlab.spline import Curve, feasibility
from uavlab.trial.judging import Measured
from uavlab.trial.measures import exact, percent, statistic_of
from uavlab.vehicle import GRAVITY

LENGTHS = {"RISK-ACO": 152.39 / 141.85, "PSO-BAS": 156.74 / 136.48}
"""Of the route that knows the risk over the one that doesn't, as printed."""
RISKS = {"RISK-ACO": 4.82e-6 / 2.37e-5, "PSO-BAS": 8.75e-7 / 6.45e-6}
"""The same of their risks."""


def within(risk_map: RiskMap, length: float, **price: Any) -> Route:
    """The exact route of least risk that is no longer than so many metres."""
    return least_risk(risk_map, *CAMPUS_FLIGHT, max_length=length + 1e-6, **price)


def shortest_length(risk_map: RiskMap) -> float:
    return least_risk(risk_map, *CAMPUS_FLIGHT, risk_weight=0.0, length_weight=1.0).length


def cuts(risk_map: RiskMap) -> dict[str, float]:
    """How much less of the papers' sum [%] the exact route has for each paper's length, against the shortest one."""
    length = shortest_length(risk_map)
    routes = {name: within(risk_map, ratio * length, as_printed=True) for name, ratio in LENGTHS.items()}
    base = within(risk_map, length, as_printed=True).cost
    return {name: 100 * (1 - route.cost / base) for name, route in routes.items()}


def detours(size: int, seed: int) -> dict[str, Measured]:
    """Cuts of risk by the papers' lengths, on the reference campus and on random ones."""
    reference, towns = cuts(reference_campus()), [cuts(random_campus(seed + n)) for n in range(size)]
    found = {}
    for paper in LENGTHS:
        of_towns = np.array([cut[paper] for cut in towns])
        found[f"{paper}, reference"] = exact(reference[paper], "1 campus, drawn for it; exact planner")
        reached = of_towns >= 100 * (1 - RISKS[paper])
        found[f"{paper}, reached"] = percent(reached, f"{size} random campuses, exact planner")
    return found


def wrecks(size: int, seed: int) -> dict[str, Measured]:
    """True cut of risk [%], with the wreck where it falls, of the routes that take it to fall straight below."""
    left: dict[str, list[float]] = {paper: [] for paper in LENGTHS}
    for number in range(size):
        town = random_campus(seed + number)
        length = shortest_length(town)
        base = town.integral(within(town, length), drift=True)
        for paper, ratio in LENGTHS.items():
            left[paper].append(town.integral(within(town, ratio * length), drift=True) / base)
    sample = f"{size} random campuses, exact planner"
    return {paper: statistic_of(100 * (1 - np.array(part)), sample, np.median) for paper, part in left.items()}


def curves(size: int, seed: int) -> dict[str, Measured]:
    """On how many campuses [%] the smooth route of least risk keeps the papers' limits, and can be flown."""
    towns = [random_campus(seed + n) for n in range(size)]
    drawn = [(town, Curve(least_risk(town, *CAMPUS_FLIGHT).points)) for town in towns]
    steep = np.array([np.degrees(np.abs(curve.pitch).max()) for _, curve in drawn])
    bends = {name: [5.0 * getattr(curve, of).max() < 1 for _, curve in drawn] for name, of in BENDS.items()}
    able = [feasibility(curve, town.city, town.uav).feasible for town, curve in drawn]
    limits = {"pitch 60": steep < 60, "pitch 45": steep < 45 - 1e-6, "flown": able}
    press = [TABLE_2_SPEED**2 * curve.level_curvature.max() / GRAVITY for _, curve in drawn]
    found = {name: percent(met, f"{size} random campuses") for name, met in (bends | limits).items()}
    return found | {"least press": exact(min(press), f"times the weight, {size} random campuses")}


TABLE_2_SPEED = 16.0
"""[m/s]"""
BENDS = {"in plan": "level_curvature", "in 3 D": "curvature"}
"""Two readings of a curve's curvature [1/m]; a coding unit is a voxel of 5 m."""
