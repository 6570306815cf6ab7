"""REPARE, the hazard planner and the potential field against A*: expansions, time and length, printed as tables.

All answer the same pairs in one run, each in turn: random pairs, and pairs between which A* flies along a wall. The
price of a metre depends on the city and the conditions alone. It is computed once, off the clock; what that takes is
printed on its own. Weights and steps are the planners' defaults. The clock counts processor time, the median of up to
five runs; nobody uses more than one thread. Run it as `python tests/benchmarks/repare.py`; `--quick` takes five pairs
of each kind.
"""

import argparse
import time
from collections.abc import Callable

import numpy as np
from astar import machine, print_table

from uavlab.city import City, table1_city
from uavlab.offsets import crossing_rate
from uavlab.planners import (
    astar,
    flight_conditions,
    hazard_astar,
    hazard_price,
    potential_field,
    repare,
    repare_price,
)
from uavlab.planners.hazard import cached_price as cached_hazard
from uavlab.planners.repare import cached_price as cached_repare
from uavlab.route import Route

TABLE_4 = ("light", "mild", 3.0), ("heavy", "mild", 4.0), ("light", "heavy", 5.0)
"""Load, disturbance, and ξ [m]: D_min less half a metre."""

SPEED = 5.0
"""Over ground [m/s]."""

HEADER = [
    "",
    "expansions",
    "to A*",
    "time a pair [ms]",
    "to A*",
    "length to A*",
    "wall touches a flight",
    "arrives",
]

Planner = Callable[[np.ndarray, np.ndarray], Route]


def clocked(solve: Callable[[], Route]) -> tuple[Route, float]:
    """A route, and the median processor time of up to five runs [s]."""
    times: list[float] = []
    while len(times) < 5 and sum(times) < 1.0:
        began = time.process_time()
        route = solve()
        times.append(time.process_time() - began)
    return route, float(np.median(times))


def pairs_of_both_kinds(city: City, count: int, seed: int, min_clearance: float) -> dict[str, np.ndarray]:
    """Random pairs, and those between which A* comes within half a metre of a wall."""
    candidates = city.random_pairs(60 * count, seed, min_clearance=min_clearance)
    blocked = [pair for pair in candidates if astar(city, *pair).clearance(city) <= 0.5 + 1e-9]
    return {"random": candidates[:count], "blocked": np.array(blocked[:count])}


def planners_for(city: City, load: str, disturbance: str, offset: float) -> dict[str, Planner]:
    price = repare_price(city, flight_conditions(load, disturbance))
    conditions = {"load": load, "disturbance": disturbance}
    return {
        "A*": lambda start, goal: astar(city, start, goal),
        "A*, Euclidean": lambda start, goal: astar(city, start, goal, heuristic="euclidean"),
        "A* on REPARE's price": lambda start, goal: astar(city, start, goal, price=price),
        "A* on REPARE's price, Euclidean": lambda start, goal: astar(
            city, start, goal, price=price, heuristic="euclidean"
        ),
        "REPARE": lambda start, goal: repare(city, start, goal, **conditions),
        "hazard": lambda start, goal: hazard_astar(city, start, goal, sigma=offset / 3, any_angle=False),
        "hazard + shortcut": lambda start, goal: hazard_astar(city, start, goal, sigma=offset / 3),
        "potential field": lambda start, goal: potential_field(city, start, goal),
    }


def compare(city: City, pairs: np.ndarray, planners: dict[str, Planner], offset: float) -> list[list[str]]:
    """Sums over the pairs, and their ratios to A*'s with the same estimate; lengths and touches where it arrives."""
    for solve in planners.values():
        solve(*pairs[0])  # compiles, and computes the price
    seconds = {name: np.empty(len(pairs)) for name in planners}
    routes: dict[str, list[Route]] = {name: [] for name in planners}
    for n, pair in enumerate(pairs):
        for name, solve in planners.items():
            route, seconds[name][n] = clocked(lambda solve=solve, pair=pair: solve(*pair))  # type: ignore[misc]
            routes[name].append(route)
    rate = crossing_rate(np.clip(city.clearance - 0.5, 0.0, 100.0), offset / 3)
    rows = []
    for name, found in routes.items():
        arrived = [(route, plain) for route, plain in zip(found, routes["A*"], strict=True) if route.reached]
        alike = "A*, Euclidean" if name.endswith("Euclidean") else "A*"
        expanded = sum(route.info.get("expanded", 0) for route in found)
        rows.append(
            [
                name,
                f"{expanded:,}" if expanded else "",
                f"{expanded / sum(route.info['expanded'] for route in routes[alike]):.2f}" if expanded else "",
                f"{1e3 * seconds[name].mean():.3g}",
                f"{seconds[name].sum() / seconds[alike].sum():.2f}",
                f"{np.mean([route.length / plain.length for route, plain in arrived]):.3f}",
                f"{np.mean([route.integral(city, rate) / SPEED for route, _ in arrived]):.2g}",
                f"{len(arrived)} of {len(pairs)}",
            ]
        )
    return rows


def prices(city: City) -> None:
    """What is kept: the time of computing a price."""
    _ = city.clearance, city.wall_normal
    now, windy = flight_conditions("light", "mild"), flight_conditions("light", (4.0, 4.0))
    rows = []
    for name, compute in (
        ("REPARE", lambda: cached_repare.__wrapped__(city, now, (0.0, 0.0, 0.0), (2.0, 1.0, 1.0), "ball")),
        ("REPARE, wind", lambda: cached_repare.__wrapped__(city, windy, (0.5, 0.5, 0.0), (2.0, 1.0, 1.0), "ball")),
        ("hazard", lambda: cached_hazard.__wrapped__(city, 1.0, 0.5, (0.0, 0.0, 0.0), 600.0)),
        ("kept", lambda: (repare_price(city, now), hazard_price(city, 1.0))),
    ):
        compute()
        rows.append([name, f"{1e3 * clocked(compute)[1]:.3g}"])
    print_table("A price, once for a city and its conditions", ["", "time [ms]"], rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pairs", type=int, default=50, help="how many pairs of each kind")
    parser.add_argument("--seed", type=int, default=2022, help="of the pairs")
    parser.add_argument("--quick", action="store_true", help="five pairs of each kind")
    options = parser.parse_args()
    city = table1_city()
    kinds = pairs_of_both_kinds(city, 5 if options.quick else options.pairs, options.seed, min_clearance=5.5)
    print(f"{len(kinds['random'])} pairs of each kind, seed {options.seed}; {', '.join(machine())}")
    for load, disturbance, offset in TABLE_4:
        planners = planners_for(city, load, disturbance, offset)
        for kind, pairs in kinds.items():
            rows = compare(city, pairs, planners, offset)
            print_table(f"{load} load, {disturbance} disturbance (ξ = {offset:g} m), {kind} pairs", HEADER, rows)
    prices(city)


if __name__ == "__main__":
    main()
