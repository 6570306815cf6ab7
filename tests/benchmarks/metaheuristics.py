"""The ant colony against a loop in plain Python, and the particle swarm against pyswarms, printed as tables.

The loop is what one writes who has read the formulas: lists, sets, dictionaries, and `random`. It follows the rules of
`ant_colony` with its settings and its budget; it may remember the neighbours of a voxel, or not. The swarms minimise a
function that costs next to nothing, so that what is measured is the swarm. All contenders of a table run in turn,
several times; the clock counts processor time, and medians are printed. Run it as
`python tests/benchmarks/metaheuristics.py`; `--quick` takes a quarter of the ants and fewer repetitions.
"""

import argparse
import contextlib
import math
import random
import sys
import tempfile
import time
from collections.abc import Callable
from importlib.metadata import version
from itertools import product
from typing import Any, NamedTuple

import numpy as np
from astar import Voxel, machine, print_table

from uavlab.optimizers import pso
from uavlab.planners import ant_colony, least_risk
from uavlab.planners.ant_colony import ANTS, OURS
from uavlab.planners.risk_question import MAX_TURN
from uavlab.risk import CAMPUS_FLIGHT, RiskMap, random_campus, reference_campus
from uavlab.spline.limits import MAX_PITCH


class Way(NamedTuple):
    """A neighbour of a voxel: where it is, how far, in which direction, and what it costs per cell."""

    voxel: Voxel
    length: float
    direction: tuple[int, int]
    price: float


class PlainColony:
    """RISK-ACO with a price in the ants' eyes, in plain Python."""

    def __init__(self, risk_map: RiskMap, seed: int, remember: bool) -> None:
        self.shape = risk_map.city.shape
        self.free = {tuple(voxel) for voxel in np.argwhere(risk_map.flyable).tolist()}
        self.price = risk_map.rate.tolist()
        self.source, self.target = (tuple(risk_map.city.cell_of(end).tolist()) for end in np.array(CAMPUS_FLIGHT))
        self.random = random.Random(seed)
        self.remembered: dict[Voxel, list[Way]] | None = {} if remember else None

    def neighbours(self, voxel: Voxel) -> list[Way]:
        """Those to which a move is legal and flat enough."""
        if self.remembered is not None and voxel in self.remembered:
            return self.remembered[voxel]
        ways = []
        i, j, k = voxel
        for a, b, c in product((-1, 0, 1), repeat=3):
            if a == b == c == 0 or math.atan2(abs(c), math.hypot(a, b)) > MAX_PITCH + 1e-9:
                continue
            box = product({0, a}, {0, b}, {0, c})
            if all((i + x, j + y, k + z) in self.free for x, y, z in box):
                price = self.price[i + a][j + b][k + c]
                ways.append(Way((i + a, j + b, k + c), math.sqrt(a * a + b * b + c * c), (a, b), price))
        if self.remembered is not None:
            self.remembered[voxel] = ways
        return ways

    def weight(self, way: Way, pheromone: float) -> float:
        """τ^α·η^β·C^−γ with η = 1/(d + Δl)."""
        left = math.dist(way.voxel, self.target) + abs(way.voxel[2] - self.target[2])
        return pheromone**OURS.alpha * (1 / left) ** OURS.beta * way.price**-OURS.gamma

    def walk(self, pheromone: dict[Voxel, float]) -> tuple[list[Voxel], float]:
        """One ant's way and its cost; an infinite one if it got stuck."""
        way, visited, heading, cost = [self.source], {self.source}, (0, 0), 0.0
        i, j, k = self.source
        here = self.price[i][j][k]
        while len(way) < 4 * sum(self.shape):
            options = [
                step
                for step in self.neighbours(way[-1])
                if step.voxel not in visited and not turns_too_far(heading, step.direction)
            ]
            if not options:
                break
            chosen = next((step for step in options if step.voxel == self.target), None)
            if chosen is None:
                weights = [self.weight(step, pheromone[step.voxel]) for step in options]
                (chosen,) = self.random.choices(options, weights)
            cost += chosen.length * (here + chosen.price) / 2
            here = chosen.price
            heading = chosen.direction if chosen.direction != (0, 0) else heading
            way.append(chosen.voxel)
            visited.add(chosen.voxel)
            if chosen.voxel == self.target:
                return way, cost
        return way, math.inf

    def search(self, budget: int) -> float:
        """Cost of the best way of all ants."""
        pheromone = dict.fromkeys(self.free, OURS.first)
        best, least = [], math.inf
        for _ in range(budget // ANTS):
            for _ in range(ANTS):
                way, cost = self.walk(pheromone)
                if cost < least:
                    best, least = way, cost
            for voxel, level in pheromone.items():
                pheromone[voxel] = max((1 - OURS.evaporation) * level, OURS.least)
            for voxel in best:
                pheromone[voxel] = min(pheromone[voxel] + OURS.deposit, OURS.most)
        return least


def turns_too_far(heading: tuple[int, int], direction: tuple[int, int]) -> bool:
    """Whether a level direction lies more than the greatest turn off the heading; (0, 0) is none."""
    if heading == (0, 0) or direction == (0, 0):
        return False
    turn = math.atan2(direction[1], direction[0]) - math.atan2(heading[1], heading[0])
    return abs((turn + math.pi) % (2 * math.pi) - math.pi) > MAX_TURN + 1e-9


def in_turn(contenders: dict[str, Callable[[int], float]], repetitions: int) -> dict[str, tuple[float, float]]:
    """Of each contender, called with a seed: median processor time [s], and median of what it found."""
    times: dict[str, list[float]] = {name: [] for name in contenders}
    found: dict[str, list[float]] = {name: [] for name in contenders}
    for seed in range(repetitions):
        for name, run in contenders.items():
            began = time.process_time()
            found[name].append(run(seed))
            times[name].append(time.process_time() - began)
    return {name: (float(np.median(times[name])), float(np.median(found[name]))) for name in contenders}


def ants(budget: int, repetitions: int) -> None:
    rows = []
    for title, risk_map in (("reference", reference_campus()), ("random, seed 1", random_campus(1))):
        _ = risk_map.rate, risk_map.flyable  # the map's work, not the colonies'
        exact = least_risk(risk_map, *CAMPUS_FLIGHT).cost
        contenders: dict[str, Callable[[int], float]] = {
            "uavlab": lambda seed, m=risk_map: ant_colony(m, *CAMPUS_FLIGHT, rng=seed, budget=budget).cost,
            "plain Python": lambda seed, m=risk_map: PlainColony(m, seed, False).search(budget),
            "plain Python that remembers neighbours": lambda seed, m=risk_map: PlainColony(m, seed, True).search(
                budget
            ),
        }
        results = in_turn(contenders, repetitions)
        for name, (seconds, cost) in results.items():
            ratio = f"{seconds / results['uavlab'][0]:.3g}"
            rows.append([title, name, f"{1e6 * seconds / budget:.3g}", ratio, f"{100 * (cost / exact - 1):.1f}"])
    print_table(
        f"{budget} ants over a campus",
        ["campus", "", "time an ant [µs]", "times ours", "median gap to the optimum [%]"],
        rows,
    )


def sphere(points: np.ndarray) -> np.ndarray:
    return (points * points).sum(axis=1)


def their_swarm(particles: int, iterations: int, dimensions: int, bounded: bool) -> Callable[[int], float]:
    from pyswarms.single import GlobalBestPSO

    box = (np.full(dimensions, -5.0), np.full(dimensions, 5.0)) if bounded else None

    def run(seed: int) -> float:
        np.random.seed(seed)  # noqa: NPY002  pyswarms draws from the global state
        options = {"c1": 1.5, "c2": 2.0, "w": 0.7}
        swarm = GlobalBestPSO(particles, dimensions, options, bounds=box)
        return swarm.optimize(sphere, iterations, verbose=False)[0]

    return run


def our_swarm(particles: int, iterations: int, dimensions: int) -> Callable[[int], float]:
    bounds = np.tile([-5.0, 5.0], (dimensions, 1))
    return lambda seed: pso(sphere, bounds, particles * iterations, seed, swarm=particles).value


def swarms(repetitions: int, iterations: int = 200, dimensions: int = 10) -> None:
    rows: list[list[Any]] = []
    for particles in (20, 100, 500):
        contenders = {
            "uavlab": our_swarm(particles, iterations, dimensions),
            "pyswarms": their_swarm(particles, iterations, dimensions, True),
            "pyswarms without bounds": their_swarm(particles, iterations, dimensions, False),
        }
        in_turn(contenders, 2)  # what is filled once
        results = in_turn(contenders, repetitions)
        for name, (seconds, value) in results.items():
            each = f"{1e6 * seconds / (particles * iterations):.3g}"
            rows.append([str(particles), name, each, f"{seconds / results['uavlab'][0]:.3g}", f"{value:.0e}"])
    title = f"{iterations} iterations over a sphere in {dimensions} dimensions"
    print_table(title, ["particles", "", "time an evaluation [µs]", "times ours", "median found"], rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--budget", type=int, default=4000, help="how many ants walk")
    parser.add_argument("--repetitions", type=int, default=3, help="of a colony; swarms run ten times as often")
    parser.add_argument("--quick", action="store_true", help="a thousand ants, one repetition")
    options = parser.parse_args()
    if options.quick:
        options.budget, options.repetitions = 1000, 1
    versions = ", ".join(f"{package} {version(package)}" for package in ("numpy", "numba", "pyswarms"))
    print(f"{next(machine())}, Python {sys.version.split()[0]}, {versions}")
    ant_colony(reference_campus(), *CAMPUS_FLIGHT, rng=0, budget=20)  # compiles
    ants(options.budget, options.repetitions)
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):  # where pyswarms leaves its report.log
        swarms(10 * options.repetitions)


if __name__ == "__main__":
    main()
