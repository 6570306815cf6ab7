"""What REPARE says of flights: who crashes in gusts, a monitor's two controllers, and offsets that stay inside 3σ."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from uavlab import offsets
from uavlab.city import City
from uavlab.flight import PERFECT_GPS, Autopilot, Flights, OffsetProcess, crash_rate, monte_carlo
from uavlab.planners import astar, potential_field, repare
from uavlab.resilience import LOADS, ConditionCheck, Monitor, safe_distance
from uavlab.route import Route
from uavlab.trial.by_routes import FIELDS, UNFITTED, nearest, papers_city
from uavlab.trial.judging import Measured
from uavlab.trial.measures import fewer, percent
from uavlab.vehicle import LIGHT_QUADROTOR

PILOT, UAV = Autopilot(gps=PERFECT_GPS), LIGHT_QUADROTOR.loaded(LOADS["light"])
FLIGHTS = 20
"""Of each route."""
FAR = ((20, 8, 20), (80, 95, 60))


def blocked_pairs(size: int, seed: int) -> list[np.ndarray]:
    """Pairs with a building in the straight way between them."""
    city = papers_city()
    pairs = city.random_pairs(400, seed, min_clearance=6.5)
    blocked = (pair for pair in pairs if city.occupied[tuple(city.voxels_along(pair)[0].T)].any())
    return [pair for pair, _ in zip(blocked, range(size), strict=False)]


def flown(routes: Sequence[Route], sigma: float, autopilot: Autopilot = PILOT, flights: int = FLIGHTS) -> list[Flights]:
    """Flights of each route that arrives, in offsets of so many metres."""
    options: dict[str, Any] = {"flights": flights, "time_step": 0.1}
    return [
        monte_carlo(
            route,
            papers_city(),
            UAV,
            OffsetProcess(sigma),
            autopilot,
            rng=np.random.default_rng([1, number]),
            **options,
        )
        for number, route in enumerate(routes)
        if route.reached
    ]


def crashes(runs: Sequence[Flights], name: str) -> Measured:
    """Share of flights that crash [%]; flights of one route resemble each other."""
    rate = crash_rate(runs)
    sample = f"{len(runs)} {name} × {len(runs[0].outcome)} flights"
    return Measured(rate.per_thousand / 10, rate.low / 10, rate.high / 10, sample)


def each(runs: Sequence[Flights]) -> np.ndarray:
    return np.array([run.crashed.sum() for run in runs])


def in_gusts(size: int, seed: int) -> dict[str, Measured]:
    """A*, the potential field and REPARE in the offsets of mild and of heavy wind."""
    pairs = blocked_pairs(size, seed)
    plain = [astar(papers_city(), *pair) for pair in pairs]
    careful = {wind: [repare(papers_city(), *pair, disturbance=wind) for pair in pairs] for wind in ("mild", "heavy")}
    fields = {name: [potential_field(papers_city(), *pair, **FIELDS[name]) for pair in pairs] for name in UNFITTED}
    there = {name: np.flatnonzero([route.reached for route in field]) for name, field in fields.items()}
    found: dict[str, Measured] = {}
    for wind, own in careful.items():
        sigma = (safe_distance("light", wind) - UAV.diameter / 2) / 3
        a, r = (flown(routes, sigma) for routes in (plain, own))
        found |= {f"A* crashes, {wind}": crashes(a, "routes"), f"REPARE crashes, {wind}": crashes(r, "routes")}
        found[f"REPARE safer, {wind}"] = fewer(each(r), each(a), f"{size} pairs")
        for name, field in fields.items():
            sample = f"{len(there[name])} pairs where the field arrives"
            found[f"field safer, {wind}, {name}"] = fewer(each(flown(field, sigma)), each(a)[there[name]], sample)
    for name, field in fields.items():
        ours, theirs = (nearest([routes[n] for n in there[name]]) for routes in (careful["mild"], field))
        found[f"smaller margin, {name}"] = fewer(ours, theirs, f"{len(there[name])} pairs where the field arrives")
    return found


def worse_after_six_seconds(time: float) -> OffsetProcess:
    """Offsets that double on the way."""
    return OffsetProcess(1.0 if time < 6.0 else 2.0)


def two_controllers(size: int, seed: int) -> dict[str, Measured]:
    """Whether a monitor that may switch to the advanced controller saves flights, when gusts turn out worse."""
    routes, runs = [repare(papers_city(), *pair) for pair in blocked_pairs(size, seed)], {}
    for strategy in ("fixed", "adaptive"):
        monitor = Monitor(ConditionCheck(predicted=3.0), uav_diameter=UAV.diameter, level="lower")
        pilot = Autopilot(monitor=monitor, strategy=strategy)
        options: dict[str, Any] = {"flights": 10, "time_step": 0.1}
        runs[strategy] = [
            monte_carlo(
                route,
                papers_city(),
                UAV,
                worse_after_six_seconds,
                pilot,
                rng=np.random.default_rng([1, number]),
                **options,
            )
            for number, route in enumerate(routes)
        ]
    return {"fewer crashes": fewer(each(runs["adaptive"]), each(runs["fixed"]), f"{size} pairs")}


def beside_a_wall(size: int, seed: int) -> dict[str, Measured]:
    """Flights of eight seconds beside a wall at 3σ that never touch it [%]."""
    batches = [offsets.offset_paths(1.0, 8.0, seed + n, count=20_000, step=0.02)[1] for n in range(size)]
    touched = np.concatenate([(paths > 3.0).any(axis=1) for paths in batches])
    return {"untouched": percent(~touched, f"{len(touched)} flights")}


def safety_domain(size: int, seed: int) -> dict[str, Measured]:
    """Flights [%] that stay for 26 s inside the circle which holds 99.73 % of all moments."""
    nowhere, route = City(np.zeros((100, 100, 100), dtype=bool)), repare(papers_city(), *FAR)
    run = monte_carlo(route, nowhere, UAV, OffsetProcess(1.0), rng=seed, flights=size, every=0.1, time_step=0.05)
    distance = np.hypot(run.offsets[:, :261, 1], run.offsets[:, :261, 2])  # across and up
    return {"inside": percent((distance <= offsets.pauta_radius(2)).all(axis=1), f"{size} flights")}
