"""A* on maps of real size: 120 million voxels with and without clearance, and a city of 12 billion that is lazy.

Each row is measured in a process of its own, so that its peak of memory is its own. Compiled code is there before the
clock runs. Run it as `python tests/benchmarks/large_maps.py`; `--pairs 40` asks for more routes across the city, and
`--seed` for another one.
"""

import argparse
import multiprocessing
import resource
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from typing import NamedTuple

import numpy as np

from uavlab.city import Building, City
from uavlab.planners import astar

CLEARANCE = 4.0
"""[m]"""

LOTS, LOT = 200, 50.0
"""Buildings along x and y, and how far they are from each other [m]."""

TOP = 120.0
"""Of both maps [m]."""


class Row(NamedTuple):
    """What a call took."""

    what: str
    seconds: float
    expanded: int
    length: float  # [m], infinite where no cheapest route was proven
    peak: float  # of the process so far [GB]


def buildings_of(seed: int, lots: int = LOTS) -> list[Building]:
    """A building in each lot, of any size and direction, most of them low: 40 000 on 10 km × 10 km."""
    rng = np.random.default_rng(seed)
    made = []
    for i, j in np.ndindex(lots, lots):
        width, depth = rng.uniform(12.0, 36.0, size=2)
        angle, height = rng.uniform(0.0, np.pi), float(np.clip(16.0 * rng.lognormal(0.0, 0.6), 4.0, 105.0))
        along = np.array([np.cos(angle), np.sin(angle)])
        across = np.array([-along[1], along[0]])
        centre = LOT * (np.array([i, j]) + rng.uniform(0.4, 0.6, size=2))
        corners = [
            centre + a * width / 2 * along + b * depth / 2 * across for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))
        ]
        made.append(Building.prism(corners, height, name=f"{i}-{j}"))
    return made


def city_of(seed: int, lots: int = LOTS, lazy: bool = True) -> City:
    """A city of these buildings at 1 m."""
    size = (lots * LOT, lots * LOT, TOP)
    return City.from_buildings(buildings_of(seed, lots), origin=(0, 0, 0), size=size, lazy=lazy)


def pairs_across(city: City, count: int, seed: int, apart: float) -> list[np.ndarray]:
    """Starts and goals at this distance in plan [m], 5 to 100 m high, that keep the clearance."""
    rng, pairs = np.random.default_rng(seed), []
    low, high = city.bounds
    while len(pairs) < count:
        angle, begin = rng.uniform(0.0, 2 * np.pi), rng.uniform(low, high)
        end = begin + apart * np.array([np.cos(angle), np.sin(angle), 0.0])
        begin[2], end[2] = rng.uniform(5.0, 100.0, size=2)
        ends = np.floor([begin, end]) + 0.5
        if city.inside(ends).all() and (city.distance(ends) >= CLEARANCE).all():
            pairs.append(ends)
    return pairs


def measured(what: str, city: City, pair: np.ndarray, min_clearance: float) -> Row:
    """One call; its peak of memory is that of the process so far."""
    began = time.perf_counter()
    route = astar(city, *pair, min_clearance=min_clearance)
    seconds = time.perf_counter() - began
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / (1e9 if sys.platform == "darwin" else 1e6)
    return Row(what, seconds, route.info["expanded"], route.length if route.reached else np.inf, peak)


def plain(seed: int, min_clearance: float) -> list[Row]:
    """1 km × 1 km × 120 m, a route from corner to corner."""
    city = city_of(seed, 20, lazy=False)
    astar(city_of(seed, 2, lazy=False), (1.5, 1.5, 110.5), (98.5, 98.5, 110.5), min_clearance=min_clearance)  # compiles
    pair = np.array([(2.5, 2.5, 30.5), (997.5, 985.5, 40.5)])
    return [measured(f"120 million voxels, {min_clearance:g} m", city, pair, min_clearance) for _ in range(2)]


def lazy(seed: int, pairs: int) -> list[Row]:
    """10 km × 10 km × 120 m, routes of about 12 km."""
    small = city_of(seed, 4)
    astar(small, (1.5, 1.5, 110.5), (198.5, 198.5, 110.5), min_clearance=CLEARANCE)  # compiles
    began = time.perf_counter()
    city = city_of(seed)
    print(f"40 000 buildings made in {time.perf_counter() - began:.0f} s", flush=True)
    rows = []
    for ends in pairs_across(city, pairs, seed, 12_000.0):
        rows.append(measured("12 billion voxels, 4 m", city, ends, CLEARANCE))
        print(rows[-1], ends.tolist(), flush=True)
    return rows


def told(rows: list[Row]) -> str:
    """A line for what was measured with the same question."""
    seconds = np.sort([row.seconds for row in rows])
    none = sum(row.length == np.inf for row in rows)
    return (
        f"{rows[0].what:28} first {rows[0].seconds:6.2f} s   median {np.median(seconds):6.2f} s   "
        f"most {seconds[-1]:6.2f} s   under 10 s {np.mean(seconds < 10):4.0%}   not proven {none}   "
        f"peak {rows[-1].peak:.2f} GB"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pairs", type=int, default=10, help="routes across the city (10)")
    parser.add_argument("--seed", type=int, default=1, help="of buildings and of pairs (1)")
    options = parser.parse_args()
    for work, *question in (
        (plain, options.seed, 0.0),
        (plain, options.seed, CLEARANCE),
        (lazy, options.seed, options.pairs),
    ):
        with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as process:
            print(told(process.submit(work, *question).result()), flush=True)


if __name__ == "__main__":
    main()
