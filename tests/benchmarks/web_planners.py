"""Planners and flights in a browser against the same functions in Python: the same work in one run, as one table.

Each question is asked on all sides in turn: of the public function, with its checks and its route; of that of
`uavlab.web.functions`, as numba compiles it; and as `planners.wasm` has it, in Chromium. The ratio is that of the
browser's time to the public function's, or to the other's where there is no public one, or one that keeps its answers.
What is asked once for a city (clearance, runs) is asked five times. A browser's clock shows tenths of milliseconds, and
it takes time to make the best of a function that it has just got; so the first three questions are asked unclocked
before, and sums over many are compared. Run it as
`python tests/benchmarks/web_planners.py`; `--quick` takes ten pairs.
"""

import argparse
import copy
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
from astar import machine, print_table
from playwright.sync_api import sync_playwright

sys.path += [str(Path(__file__).parents[1]), str(Path(__file__).parents[1] / "web")]  # where pytest looks, too
from chromium import FLAGS, chromium_path
from sides import InBrowser, InPython, Town

from uavlab.city import City, table1_city
from uavlab.flight import Autopilot
from uavlab.flight.simulation import TIME_STEP, flown, setup_of
from uavlab.planners import (
    astar,
    flight_conditions,
    hazard_astar,
    least_risk,
    penalty_zone,
    potential_field,
    repare_price,
    theta_star,
)
from uavlab.planners.hazard import CRASH_PRICE
from uavlab.planners.repare import PENALTY
from uavlab.planners.risk_question import MAX_TURN, Query, Weights, checked_limits, price_per_cell, query_of
from uavlab.risk import CAMPUS_FLIGHT, random_campus
from uavlab.spline.limits import MAX_PITCH
from uavlab.vehicle import LIGHT_QUADROTOR
from uavlab.weather import Wind
from uavlab.web.craft import craft_of, state_of

Question = Callable[[Town, Any], object]
"""What a town is asked of a case, such as a start and a goal."""

Public = Callable[[Any], object] | None
"""The same of the public function, checks and route and all."""


def set_price(town: Town, name: str) -> None:
    """The price of all voxels that a planner takes."""
    call, cell = town.side.call, town.city.cell
    if name == "penalty zone":
        call("price_zone", town.clearance, 3.5, 1.5, cell, town.price)
    elif name == "hazard":
        call("price_hazard", town.clearance, 1.0, 0.5, CRASH_PRICE / 5.0, town.price)
    else:
        now = flight_conditions("light", "mild")
        forces = now.push, now.load_ratio
        call("price_repare", town.clearance, now.safe_distance, PENALTY, *forces, cell, town.price)


def set_clearance(town: Town, _: None) -> None:
    town.side.call("clear", town.occupied, town.city.cell, town.clearance)


def priced(town: Town, pair: np.ndarray) -> Any:
    return town.astar(*pair, min_clearance=0.5, cheapest=1.0)


def city_questions(city: City, pairs: np.ndarray) -> Iterator[tuple[str, Sequence[Any], Question, Public]]:
    """By name what a city is asked, of each of some cases; prices stay as they were set last."""
    once = [None] * 5
    yield "clearance of all voxels", once, set_clearance, None
    yield "runs of all columns", once, lambda town, _: town.runs_of(town.occupied), None
    yield "A*", pairs, lambda town, pair: town.astar(*pair), lambda pair: astar(city, *pair)
    zone, repare_s = penalty_zone(city, 3.5, penalty=1.5), repare_price(city, flight_conditions("light", "mild"))
    public: dict[str, Callable[[Any], object]] = {
        "penalty zone": lambda pair: astar(city, *pair, price=zone, min_clearance=0.5),
        "REPARE": lambda pair: astar(city, *pair, price=repare_s, min_clearance=0.5),
        "hazard": lambda pair: hazard_astar(city, *pair, sigma=1.0, any_angle=False),
    }
    for name, solve in public.items():
        yield f"price of all voxels, {name}", [name] * 5, set_price, None
        yield f"A*, {name}", pairs, priced, solve
    yield (
        "A*, hazard, and straight lines",
        pairs,
        lambda town, pair: town.straighten(len(priced(town, pair).points), 0.5),
        lambda pair: hazard_astar(city, *pair, sigma=1.0),
    )
    yield "Theta*", pairs, lambda town, pair: town.theta_star(*pair), lambda pair: theta_star(city, *pair)
    for moves, free in (("lattice", False), ("continuous", True)):
        yield (
            f"potential field, {moves}",
            pairs,
            lambda town, pair, free=free: town.potential_field(*pair, free),  # type: ignore[misc]
            lambda pair, moves=moves: potential_field(city, *pair, moves=moves, max_steps=2000),  # type: ignore[misc]
        )
    yield "curve, 8 control points", pairs, lambda town, pair: town.curve(np.linspace(*pair, 8), 0.25), None


def seconds_of(question: Question, town: Town, case: Any) -> float:
    """Those of the functions that a question calls, but for what is measured on its answer."""
    seconds: list[float] = []
    call = town.side.call

    def clocked(name: str, *arguments: object) -> object:
        answer = call(name, *arguments)
        if name != "measure":
            seconds.append(town.side.seconds)
        return answer

    town.side.call = clocked
    try:
        question(town, case)
    finally:
        town.side.call = call
    return sum(seconds)


def compare(towns: list[Town], question: Question, cases: Sequence[Any], public: Public = None) -> np.ndarray:
    """Seconds of each question (questions, 3): in Python, in the browser, and of the public function, NaN without."""
    seconds = np.full((len(cases), 3), np.nan)
    for case in cases[:3]:
        for town in towns:
            question(town, case)
        if public:
            public(case)
    for n, case in enumerate(cases):
        seconds[n, :2] = [seconds_of(question, town, case) for town in towns]
        if public:
            began = time.perf_counter()
            public(case)
            seconds[n, 2] = time.perf_counter() - began
    return seconds


def flights(city: City, count: int) -> tuple[list[np.random.Generator], Question, Public]:
    """Generators for one route that is flown again and again, and how."""
    route, wind, autopilot = astar(city, (5, 5, 30), (60, 46, 32)), Wind((3, -2), deviation=1.0), Autopilot()
    setup, _ = setup_of(route, city, LIGHT_QUADROTOR, wind, autopilot, TIME_STEP)
    assert setup is not None
    craft, space = craft_of(LIGHT_QUADROTOR, wind, autopilot, TIME_STEP), setup.obstacles
    way = route.points, setup.speed, wind, craft
    ends = space.touching, space.near_goal
    return (
        np.random.default_rng(1).spawn(count),
        lambda town, generator: town.fly(*way, state_of(generator), *ends, every=5),
        lambda generator: flown(setup, copy.deepcopy(generator), 5),
    )


def least_risks(sides: list[Any], count: int) -> np.ndarray:
    """Seconds of the route of least risk over so many random campuses, (campuses, 3)."""
    seconds = []
    for seed in range(count):
        campus = random_campus(seed)
        towns = [Town(side, campus.city) for side in sides]
        limits = checked_limits(campus, MAX_TURN, MAX_PITCH, 0.0, None, np.inf)
        query = query_of(campus, price_per_cell(campus, Weights()), *towns[0].codes(*CAMPUS_FLIGHT), limits)

        def asked(town: Town, query: Query) -> None:
            arrays = [town.side.array(array) for array in query[:4]]
            town.least_risk(*arrays, *query[4:])

        seconds.append(compare(towns, asked, [query], lambda _, campus=campus: least_risk(campus, *CAMPUS_FLIGHT)))  # type: ignore[misc]
    return np.concatenate(seconds)


def row_of(name: str, seconds: np.ndarray) -> list[str]:
    """Means, and how many times as long the browser takes, with an interval by the bootstrap over questions."""
    rng, count = np.random.default_rng(0), len(seconds)
    against = seconds[:, 0 if np.isnan(seconds[0, 2]) else 2]
    drawn = np.stack([seconds[:, 1], against])[:, rng.integers(0, count, (1000, count))].sum(axis=2)
    low, high = np.quantile(drawn[0] / drawn[1], [0.025, 0.975])
    times = [f"{1000 * mean:.3g}" if mean == mean else "" for mean in seconds[:, [2, 0, 1]].mean(axis=0)]
    return [name, str(count), *times, f"{seconds[:, 1].sum() / against.sum():.2f}", f"{low:.2f} to {high:.2f}"]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="ten pairs")
    count = 10 if parser.parse_args().quick else 50
    city = table1_city()
    pairs = city.random_pairs(count, rng=2022, min_clearance=0.5)
    rows = []
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium_path(), args=FLAGS)
        sides = [InPython(), InBrowser(browser.new_page())]
        versions = ", ".join(f"{package} {version(package)}" for package in ("numpy", "numba"))
        print(f"> {count} pairs, seed 2022; {next(machine())}, {versions}, Chromium {browser.version}", flush=True)
        towns = [Town(side, city) for side in sides]
        for name, cases, question, public in city_questions(city, pairs):
            rows.append(row_of(name, compare(towns, question, cases, public)))
        generators, flight, public = flights(city, count)
        rows.append(row_of("a flight", compare(towns, flight, generators, public)))
        rows.append(row_of("least risk, campus of 5 m", least_risks(sides, count // 2)))
        browser.close()
    header = ["", "questions", "public function [ms]", "Python [ms]", "browser [ms]", "ratio", "95 %"]
    print_table("The same functions, natively and in a browser", header, rows)


if __name__ == "__main__":
    main()
