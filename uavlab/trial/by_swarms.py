"""What PSO-BAS says of its swarm: less risk than PSO and ACO, after fewer iterations, and what the beetles add."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import Any

import numpy as np

from uavlab.optimizers import pso, pso_bas
from uavlab.planners import Comparison, ant_colony, compare_planners, waypoint_swarm
from uavlab.risk import random_campus
from uavlab.trial.judging import Measured
from uavlab.trial.measures import percent, statistic_of

SWARM = partial(waypoint_swarm, refinement=0.0)
PRINTED = partial(SWARM, as_printed=True)
EVALUATIONS = 4000
ONE_RUN: dict[str, Any] = {"budget": EVALUATIONS, "seeds": [0], "progress": False}
ITERATIONS_200 = 200 + 20 + 199 * 80
"""Evaluations in 200 iterations of 20 particles with antennae, and of the arcs that it begins with."""


def run(planners: Mapping[str, Any], size: int, seed: int, **options: Any) -> Comparison:
    maps = [random_campus(seed + n) for n in range(size)]
    return compare_planners(planners, maps, **(ONE_RUN | options))


def as_printed(size: int, seed: int) -> dict[str, Measured]:
    """PSO-BAS against PSO and ACO with the papers' settings, and when each is at its end."""
    planners = {"BAS": PRINTED, "PSO": partial(PRINTED, optimizer="pso"), "ACO": partial(ant_colony, as_printed=True)}
    runs, sample = run(planners, size, seed), f"{size} random campuses, {EVALUATIONS} evaluations"
    gaps, (_, ends) = runs.gaps, runs.converged()
    long = run({"BAS": PRINTED}, size, seed, budget=ITERATIONS_200).converged()[1][0]
    found = {
        f"less risk than {name}": percent(gaps[0, :, 0] < gaps[n, :, 0], sample) for n, name in ((1, "PSO"), (2, "ACO"))
    }
    found |= {
        f"sooner than {name}": percent(long[:, 0] < ends[n, :, 0], f"{size} random campuses")
        for n, name in ((1, "PSO"), (2, "ACO"))
    }
    return found | {"iterations": statistic_of(long, f"{size} random campuses, 200 iterations", np.median)}


def ours(size: int, seed: int) -> dict[str, Measured]:
    """The same with our settings, refined alike."""
    planners = {"BAS": SWARM, "PSO": partial(SWARM, optimizer="pso"), "ACO": ant_colony}
    gaps = run(planners, size, seed, refinement=0.4).gaps
    sample = f"{size} random campuses, {EVALUATIONS} evaluations, refined"
    return {
        f"less risk than {name}": percent(gaps[0, :, 0] < gaps[n, :, 0], sample) for n, name in ((1, "PSO"), (2, "ACO"))
    }


def sphere(x: np.ndarray) -> np.ndarray:
    return (x**2).sum(axis=1)


def rosenbrock(x: np.ndarray) -> np.ndarray:
    return (100 * (x[:, 1:] - x[:, :-1] ** 2) ** 2 + (1 - x[:, :-1]) ** 2).sum(axis=1)


def rastrigin(x: np.ndarray) -> np.ndarray:
    return (10 + x**2 - 10 * np.cos(2 * np.pi * x)).sum(axis=1)


def functions(size: int, seed: int) -> dict[str, Measured]:
    """Whether beetles help a swarm on three functions, with the printed settings and with ours."""
    found = {}
    for how, printed in (("printed", True), ("ours", False)):
        for f, half in ((sphere, 5.0), (rosenbrock, 2.0), (rastrigin, 5.0)):
            least = [
                [method(f, [(-half, half)] * 6, EVALUATIONS, seed + n, as_printed=printed).value for n in range(size)]
                for method in (pso_bas, pso)
            ]
            found[f"{f.__name__}, {how}"] = percent(np.less(*np.array(least)), f"{size} runs")
    return found
