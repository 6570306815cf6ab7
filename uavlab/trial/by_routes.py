"""What REPARE says of routes: lengths, traps, distances to walls and costs, over pairs of places in a city."""

from __future__ import annotations

from functools import cache
from itertools import product
from typing import Any

import numpy as np

from uavlab.city import City, table1_city
from uavlab.planners import astar, penalty_zone, potential_field, repare
from uavlab.route import Route
from uavlab.trial.judging import Measured
from uavlab.trial.measures import exact, fewer, percent, ratio_of_sums, statistic_of
from uavlab.vehicle import LIGHT_QUADROTOR

NOTCH, MIDDLE = (90.0, 18.0, 30.0), (50.0, 44.0, 30.0)
"""Start and goal of REPARE's Fig. 12, read off the figure [m]."""
FIELDS: dict[str, dict[str, Any]] = {
    "lattice, weak": {"moves": "lattice", "push": 5.0, "reach": 5.0},
    "lattice, medium": {"moves": "lattice", "obstacles": "surface", "push": 200.0, "reach": 8.0},
    "continuous, weak": {"moves": "continuous", "push": 5.0, "reach": 5.0},
    "continuous, strong": {"moves": "continuous", "push": 500.0, "reach": 8.0},
}
"""Four potential fields, as in chapter 06; the paper names no constants."""
FITTED = "lattice, weak"
"""The field whose constants were chosen so that it meets Table 2."""
UNFITTED = [name for name in FIELDS if name != FITTED]
CASES = {"light, mild": ("light", "mild"), "heavy, mild": ("heavy", "mild"), "light, heavy": ("light", "heavy")}
"""Loads and winds of REPARE's Table 4."""
DISTANCES = dict(zip(CASES, (3.5, 4.5, 5.5), strict=True))
"""The distances to keep that it prints for them [m]."""


@cache
def papers_city(cell: float = 1.0) -> City:
    return table1_city(cell)


def lengths_of(routes: list[Route]) -> np.ndarray:
    """Lengths [m]; NaN where a route doesn't arrive."""
    return np.array([route.length if route.reached else np.nan for route in routes])


def nearest(routes: list[Route]) -> np.ndarray:
    """Least distance of each route to a wall [m]."""
    return np.array([route.clearance(papers_city()) for route in routes])


def table_2(size: int, seed: int) -> dict[str, Measured]:
    """Lengths of A* and REPARE over the field's, for four fields; who arrives, who keeps away, and who works more."""
    city = papers_city()
    pairs = city.random_pairs(300, seed, apart=40, min_clearance=4.5)[:size]
    plain = [astar(city, *pair) for pair in pairs]
    careful, found = {}, {}
    for name, (load, wind) in CASES.items():
        free = [n for n, pair in enumerate(pairs) if city.distance(pair).min() >= DISTANCES[name]]
        careful[name] = [repare(city, *pairs[n], load=load, disturbance=wind) for n in free]
        ratio = lengths_of(careful[name]) / lengths_of(plain)[free]
        found[f"REPARE / A*, {name}"] = statistic_of(ratio, f"{len(free)} pairs")
    light = careful["light, mild"]  # of all pairs: their ends are farther from walls
    found["REPARE arrives"] = percent([route.reached for route in light], f"{size} pairs")
    work = [[route.info["expanded"] for route in both] for both in zip(light, plain, strict=True)]
    found["work"] = statistic_of(work, f"{size} pairs, nodes expanded", ratio_of_sums)
    for name, field in FIELDS.items():
        found |= beside_field(name, [potential_field(city, *pair, **field) for pair in pairs], plain, light)
    return found


def beside_field(name: str, field: list[Route], plain: list[Route], careful: list[Route]) -> dict[str, Measured]:
    """One field against A* and REPARE, where it arrives."""
    length, there = lengths_of(field), np.array([route.reached for route in field])
    sample = f"{there.sum()} of {len(field)} pairs, where the field arrives"
    rows = np.flatnonzero(there)
    found = {
        f"A*, {name}": statistic_of((lengths_of(plain) / length)[there], sample),
        f"REPARE, {name}": statistic_of((lengths_of(careful) / length)[there], sample),
        f"fails, {name}": percent(~there, f"{len(field)} pairs"),
    }
    apart, own = (nearest([routes[n] for n in rows]) for routes in (plain, field))
    found[f"safer, {name}"] = fewer(apart, own, f"{there.sum()} pairs")
    near, far = np.abs(lengths_of(careful) - lengths_of(plain)), np.abs(length - lengths_of(plain))
    found[f"alike, {name}"] = fewer(near[there], far[there], f"{there.sum()} pairs")
    return found


def notch(size: int, seed: int) -> dict[str, Measured]:
    """Of 200 settings of a field those that stay in the notch [%], spread evenly where fewer are tried."""
    kinds = product(("continuous", "lattice"), ("conic", "quadratic"), ("voxels", "surface"), (1, 5, 50, 500, 5000),
                    (2, 3.5, 5, 8, 12))  # fmt: skip
    chosen = list(kinds)[:: 200 // size]
    names = ("moves", "attraction", "obstacles", "push", "reach")
    fields: list[dict[str, Any]] = [dict(zip(names, kind, strict=True)) for kind in chosen]
    ends = [potential_field(papers_city(), NOTCH, MIDDLE, **field) for field in fields]
    stuck = ["local minimum" in route.reason for route in ends]
    out = astar(papers_city(), NOTCH, MIDDLE)
    return {
        "trapped": percent(stuck, f"{len(chosen)} settings of the field"),
        "A* gets out": exact(100.0 * out.reached, "1 pair"),
    }


def grazing_pairs(size: int, seed: int) -> list[np.ndarray]:
    """Pairs between which A* touches a wall with its body, and which start and end 6.5 m from walls."""
    city, radius = papers_city(), LIGHT_QUADROTOR.diameter / 2
    pairs = city.random_pairs(140, seed, apart=40, min_clearance=6.5)
    return [pair for pair in pairs if astar(city, *pair).clearance(city) <= radius][:size]


def kept(size: int, seed: int) -> dict[str, Measured]:
    """On how many pairs [%] REPARE's route keeps the distance of Table 4, where A*'s touches walls."""
    pairs, found = grazing_pairs(size, seed), {}
    for name, (load, wind) in CASES.items():
        routes = [repare(papers_city(), *pair, load=load, disturbance=wind) for pair in pairs]
        found[name] = percent(nearest(routes) >= DISTANCES[name] - 1e-9, f"{len(pairs)} pairs")
    return found


def estimates(size: int, seed: int) -> dict[str, Measured]:
    """On how many pairs [%] the straight distance as an estimate gives the shortest route."""
    city = papers_city()
    pairs = city.random_pairs(100, seed, apart=40, min_clearance=3.5)[:size]
    both = [[astar(city, *pair, heuristic=h).length for pair in pairs] for h in ("octile", "euclidean")]
    return {"shortest": percent(np.isclose(both[0], both[1], rtol=0, atol=1e-6), f"{size} pairs")}


def there_and_back(size: int, seed: int) -> dict[str, Measured]:
    """The printed cost, with ring and straight distance: on how many pairs [%] the lengths there and back differ."""
    city = papers_city()
    pairs = city.random_pairs(100, seed, apart=40, min_clearance=3.5)[:size]
    printed: dict[str, Any] = {"heuristic": "euclidean", "as_printed": True}
    inside, found = {}, {}
    for weight in (0.1, 0.5):
        price = penalty_zone(city, 3.5, penalty=weight, zone="ring")
        ways = [[astar(city, *pair[::step], price=price, **printed) for pair in pairs] for step in (1, -1)]
        there, back = (lengths_of(routes) for routes in ways)
        found[f"differ, {weight}"] = percent(np.abs(there - back) > 1e-6, f"{size} pairs")
        inside[weight] = np.array([[route.integral(city, city.clearance < 3.5) for route in routes] for routes in ways])
    return found | {"farther": fewer(inside[0.5].sum(axis=0), inside[0.1].sum(axis=0), f"{size} pairs")}


def ring(size: int, seed: int) -> dict[str, Measured]:
    """What a ring of 26 nodes sees [%] of the places that are too near to a wall; and of a thin wall."""
    city, found = papers_city(), {}
    free = ~city.occupied
    for radius in (3, 4, 5):
        seen = penalty_zone(city, radius + 0.5, penalty=1.0, zone="ring") > 1
        zone = (city.clearance < radius + 0.5) & free
        found[f"radius {radius}"] = exact(100 * (zone & seen).sum() / zone.sum(), f"{zone.sum()} places")
    thin = np.zeros((30, 21, 21), dtype=bool)
    thin[:2] = True
    hall = City(thin)
    seen = penalty_zone(hall, 3.5, penalty=1.0, zone="ring") > 1
    found["thin wall"] = exact(hall.clearance[~thin & ~seen].min(), "a wall of 2 m")
    return found


def finer_map(size: int, seed: int) -> dict[str, Measured]:
    """Nodes that A* expands on a map of 1 m over those on one of 2 m."""
    pairs = papers_city().random_pairs(100, seed, apart=40, min_clearance=3.5)[:size]
    fine, coarse = (
        np.array([astar(papers_city(cell), *pair).info["expanded"] for pair in pairs]) for cell in (1.0, 2.0)
    )
    return {"expansions": statistic_of(fine / coarse, f"{size} pairs", np.median)}
