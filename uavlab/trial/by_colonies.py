"""What RISK-ACO says of its colony: height in the choice, limits of the pheromone, splits, and Tables 4 and 5."""

from __future__ import annotations

import math
from functools import partial
from typing import Any

import numpy as np

from uavlab.planners import Comparison, ant_colony, compare_planners, least_risk
from uavlab.risk import CAMPUS_FLIGHT, RiskMap, random_campus, reference_campus
from uavlab.trial.by_campuses import LENGTHS, RISKS
from uavlab.trial.judging import Measured
from uavlab.trial.measures import percent, share_of_maps, statistic_of, wins

COLONY: dict[str, Any] = {"alpha": 0.5, "beta": 80.0, "gamma": 0.0, "evaporation": 0.8, "min_pheromone": 0.0}
COLONY |= {"all_lay": True, "deposit": 100.0}
"""RISK-ACO Table 3, 50 generations of 10 ants."""
SEEDS = (0, 1)


def run(colonies: dict, size: int, seed: int, ants: int) -> Comparison:
    """Runs of colonies on random campuses, with two seeds each."""
    planners = {name: partial(ant_colony, **(COLONY | habits)) for name, habits in colonies.items()}
    maps = [random_campus(seed + n) for n in range(size)]
    return compare_planners(planners, maps, seeds=SEEDS, budget=ants, progress=False)


def habits(size: int, seed: int) -> dict[str, Measured]:
    """What height in the choice is worth, and the improved colony against the basic one."""
    basic = {"height_guided": False, "max_turn": math.pi}
    kinds = {"improved": {}, "no height": {"height_guided": False}, "basic": basic}
    gaps = 1 + run(kinds, size, seed, 500).gaps
    sample = f"{size} random campuses × {len(SEEDS)} runs"
    return {
        "height": wins(gaps[0], gaps[1], sample),
        "less risk": statistic_of(100 * (1 - gaps[0] / gaps[2]), sample, np.median),
    }


def limits(size: int, seed: int) -> dict[str, Measured]:
    """Runs [%] that find something better after the first 10 of 100 generations."""
    histories = run({"improved": {}}, size, seed, 1000).histories[0]
    sample = f"{size} random campuses × {len(SEEDS)} runs, 1000 ants"
    return {"still better": share_of_maps(histories[..., -1] < histories[..., 99], sample)}


def splits(size: int, seed: int) -> dict[str, Measured]:
    """Whether three splits are worth as many ants without a split."""
    both = run({"split": {"splits": 3}, "walk on": {}}, size, seed, 2000).gaps
    sample = f"{size} random campuses × {len(SEEDS)} runs, 2000 ants"
    return {
        "better": wins(both[0], both[1], sample),
        "less risk": statistic_of(100 * (1 - (1 + both[0]) / (1 + both[1])), sample, np.median),
    }


def gains(risk_map: RiskMap, runs: int) -> list[tuple[bool, bool]]:
    """Of each of some runs of the paper's colony: whether it meets Table 5, and whether no turn exceeds 60°."""
    base, found = least_risk(risk_map, *CAMPUS_FLIGHT, length_weight=1.0), []
    for seed in range(runs):
        route = ant_colony(risk_map, *CAMPUS_FLIGHT, rng=seed, budget=500, **COLONY)
        left, longer = risk_map.integral(route) / risk_map.integral(base), route.length / base.length
        met = left <= RISKS["RISK-ACO"] and longer <= LENGTHS["RISK-ACO"] + 1e-9
        found.append((bool(met), bool(np.abs(route.turn).max() <= math.pi / 3 + 1e-9)))
    return found


def table_5(size: int, seed: int) -> dict[str, Measured]:
    """How often [%] the paper's own colony meets Table 5 on the campus that was drawn for it, and keeps its turns."""
    met, kept = np.transpose(gains(reference_campus(), size))
    return {"met": percent(met, f"{size} runs, reference campus"), "turns": percent(kept, f"{size} runs")}
