"""The whole way once, for the command line: city, premises, route, curve, flights.

Each step takes the options of `python -m uavlab`; what they found is put together by `uavlab.report`.
"""

from __future__ import annotations

import argparse
import sys
import warnings
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from uavlab.report import Premises, Trial

if TYPE_CHECKING:
    from uavlab.city import City
    from uavlab.risk import RiskMap
    from uavlab.route import Route

TABLE1_FLIGHT = ((90.0, 18.0, 30.0), (20.0, 75.0, 75.0))
"""From inside the notch of building 1 to above the floating building [m]."""

EFFORT = {"astar": (50, 3e-7), "any-angle": (50, 3e-7), "least-risk": (550, 1e-5)}
"""Memory [bytes] and time [s] that planning takes for each voxel, roughly."""

READING = 30, 1.0
"""Memory [bytes] and time [µs] for each byte of a file."""

FLIGHT = 2e-3
"""Time of a flight of half a minute [s]."""

LONG = 5.0
"""What takes more seconds is told before."""


def planner_of(options: argparse.Namespace, risk_map: RiskMap | None) -> str:
    """The planner that was asked for, or the usual one."""
    return options.planner or ("any-angle" if risk_map is None else "least-risk")


def tell_effort(city: City, planner: str) -> None:
    """Say before what planning takes, if it is long; refuse what there is no memory for."""
    size, seconds = (city.occupied.size * each for each in EFFORT[planner])
    free = free_memory()
    if free is not None and size > free:
        raise ValueError(
            f"a map of {city.occupied.size:,} voxels needs about {size / 1e9:.1f} GB of memory to plan on, "
            f"{free / 1e9:.1f} GB are free: take a larger --cell"
        )
    tell(f"planning on {city.occupied.size:,} voxels", seconds, size)


def tell(what: str, seconds: float, size: float = 0.0) -> None:
    """Say what comes and how long it takes, if it is long."""
    if seconds > LONG:
        memory = f", {size / 1e9:.1f} GB" if size > 1e8 else ""
        print(f"{what}: about {seconds:.0f} s{memory}; Ctrl-C stops it", file=sys.stderr, flush=True)


def free_memory() -> float | None:
    """What may be used [bytes], where the system says it."""
    try:
        lines = Path("/proc/meminfo").read_text().splitlines()
        return 1024.0 * next(int(line.split()[1]) for line in lines if line.startswith("MemAvailable:"))
    except (OSError, StopIteration, ValueError):
        return None


def heights_of(options: argparse.Namespace, risk_map: RiskMap | None) -> dict[str, Any]:
    """Limits of height above ground, for planners."""
    usual = 0.0 if risk_map is None else risk_map.min_height
    return {
        "min_height": usual if options.min_height is None else options.min_height,
        "max_height": np.inf if options.max_height is None else options.max_height,
    }


def position_of(options: argparse.Namespace, city: City, name: str) -> np.ndarray | None:
    """A start or a goal that was asked for [m]."""
    lonlat = getattr(options, f"{name}_lonlat")
    if lonlat is None:
        return getattr(options, name)
    point = city.from_geographic([*lonlat[:2], 0.0])
    point[2] = lonlat[2] + (point[2] - city.height_above_ground(point))
    return point


def premises_of(options: argparse.Namespace, risk_map: RiskMap | None) -> Premises:
    """From weather and load to the offset to be survived, and the distance to keep (REPARE Eqs 3, 5 and 7)."""
    from uavlab.resilience import safe_distance
    from uavlab.vehicle import LIGHT_QUADROTOR
    from uavlab.weather import Weather, Wind, grounded_by

    if options.city == "campus" and risk_map is not None:
        uav = risk_map.uav.loaded(options.payload or 0.0)
    else:
        uav = LIGHT_QUADROTOR.loaded(0.25 if options.payload is None else options.payload)
    weather = Weather(forecast_wind=options.wind, wind_from_deg=options.wind_from, rain_mm_per_h=options.rain)
    wind = Wind.from_weather(weather)
    reasons = grounded_by(uav, weather)
    if reasons:
        return Premises(uav, wind, weather.reference_wind.gust, np.inf, np.inf, "; ".join(reasons))
    needed = safe_distance(uav.payload, weather, reading="physical", uav=uav)
    clearance = needed if options.clearance is None else options.clearance
    return Premises(uav, wind, weather.reference_wind.gust, (needed - uav.diameter / 2) / 3, clearance, "")


def plan(
    options: argparse.Namespace,
    city: City,
    risk_map: RiskMap | None,
    start: np.ndarray,
    goal: np.ndarray,
    clearance: float,
    heights: dict[str, Any],
) -> tuple[list[Route], RiskMap | None]:
    """The route asked for, others to compare it with, and the risk map if there is one."""
    from uavlab.planners import astar, shortcut

    planner = planner_of(options, risk_map)
    if planner == "least-risk":
        risk_map = risk_map or assumed_risk(city)
        return by_risk(risk_map, start, goal, {"min_clearance": clearance, **heights}, options.detour), risk_map
    route = astar(city, start, goal, min_clearance=clearance, **heights)
    return [shortcut(route, city) if planner == "any-angle" else route], risk_map


def try_out(
    route: Route,
    city: City,
    premises: Premises,
    heights: dict[str, Any],
    safe_height: float,
    flights: int,
    seed: int,
) -> Trial:
    """Smooth a route, check the curve at the greatest speed that it can be flown at, up to cruise, and fly it so."""
    from uavlab.flight import Autopilot, OffsetProcess, fly, monte_carlo
    from uavlab.spline import feasibility, greatest_speed, smooth

    if not route.reached:
        return Trial("there is no route")
    uav, wind = premises.uav, premises.wind
    try:
        curve = smooth(route, city, uav, min_clearance=premises.safe_distance, **heights)
    except ValueError as error:
        return Trial(str(error))
    speed = min(greatest_speed(curve, uav, wind.mean), uav.cruise_speed) or uav.cruise_speed
    limits = feasibility(curve, city, uav, speed=speed, wind=wind.mean, safe_height=safe_height, **heights)
    trial = Trial("", curve, limits)
    if flights == 0:
        return trial
    autopilot = Autopilot(speed=speed)
    flight = fly(curve, city, uav, wind, autopilot, rng=seed)
    if flight.outcome == "grounded":
        return trial._replace(problem=f"grounded: {flight.reason}")
    seconds = 2 * flights * FLIGHT * flight.duration / 30
    tell(f"flying {flights:,} times, in these gusts and with the offsets planned for", seconds)
    flown, as_planned = (
        monte_carlo(curve, city, uav, gusts, autopilot, rng=seed, flights=flights, progress=seconds > LONG)
        for gusts in (wind, OffsetProcess(premises.sigma))
    )
    return trial._replace(flight=flight, flights=flown, as_planned=as_planned)


def load_city(options: argparse.Namespace) -> tuple[City, RiskMap | None]:
    """A city by name, or from a file, and its risk map where it has one."""
    from uavlab.city import read_city, read_no_fly, table1_city
    from uavlab.risk import reference_campus

    name, cell = options.city, options.cell
    asked = {key: getattr(options, key) for key in ("height", "default_height", "storey_height", "crs", "terrain")}
    reading: dict[str, Any] = {key: value for key, value in asked.items() if value is not None}
    if reading and name in ("table1", "campus"):
        option = next(iter(reading)).replace("_", "-")
        raise ValueError(f"--{option} is for cities from a file, not for {name}")
    risk_map = None
    if name == "table1":
        city = table1_city(cell=1.0 if cell is None else cell)
    elif name == "campus":
        risk_map = reference_campus(cell=5.0 if cell is None else cell)
        city = risk_map.city
    elif Path(name).is_file():
        size = Path(name).stat().st_size
        tell(f"reading {name}, {size / 1e6:.0f} MB", READING[1] * size / 1e6, READING[0] * size)
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", ".*city.source tells all")  # its report is printed whole
            city = read_city(name, cell=2.0 if cell is None else cell, **reading)
    else:
        raise ValueError(f"--city {name}: neither a known name (table1, campus) nor a file")
    if options.no_fly is not None:
        city = replace(city, no_fly=read_no_fly(options.no_fly, city))
        risk_map = None if risk_map is None else replace(risk_map, city=city)
    return city, risk_map


def assumed_risk(city: City) -> RiskMap:
    """A risk map where nothing is known of the people: as many everywhere, sparse trees beside the buildings."""
    from uavlab.risk import POPULATION_DENSITY, RiskMap, shelter_layer

    return RiskMap(city, POPULATION_DENSITY, shelter_layer(city, "sparse trees"))  # type: ignore[arg-type]


def by_risk(
    risk_map: RiskMap, start: np.ndarray, goal: np.ndarray, limits: dict[str, Any], detour_percent: float
) -> list[Route]:
    """The route of least risk within a detour, and beside it the safest of the shortest."""
    from uavlab.planners import least_risk

    blind = least_risk(risk_map, start, goal, length_weight=1.0, **limits)  # a metre outweighs all risk
    blind = replace(blind, planner="shortest")
    if not blind.reached:
        return [blind]
    longest = blind.en_route.length * (1 + detour_percent / 100)
    return [least_risk(risk_map, start, goal, max_length=longest, **limits), blind]


def default_flight(city: City, clearance: float, heights: dict[str, Any]) -> tuple[np.ndarray, np.ndarray]:
    """A flight across the map: a known one, else from the south-west to the north-east, amid the buildings.

    From the free voxels that are far enough from obstacles and nearest to its ends.
    """
    from uavlab.risk import CAMPUS_FLIGHT

    known = {"the city of REPARE Table 1": TABLE1_FLIGHT, "reference campus": CAMPUS_FLIGHT}
    free = np.argwhere(~city.blocked(clearance, **heights))
    if len(free) == 0:
        raise ValueError(
            f"--clearance {clearance:g}: no voxel of the map is that far from all obstacles, within the limits of "
            "height; ask for less"
        )
    if city.name in known:
        points = np.array(known[city.name])
        if not city.blocked(clearance, **heights)[tuple(city.cell_of(points).T)].any():
            return points[0], points[1]
    else:
        above = city.height_above_ground(city.center_of(np.argwhere(city.occupied)))
        height = 0.4 * (float(above.max(initial=0.0)) or float(np.ptp(city.bounds[:, 2])))
        points = city.bounds[0] + np.array([[0.1, 0.1, 0.0], [0.9, 0.9, 0.0]]) * np.ptp(city.bounds, axis=0)
        points[:, 2] += height - city.height_above_ground(points)
    nearest = [free[np.argmin(((city.center_of(free) - point) ** 2).sum(axis=1))] for point in points]
    return city.center_of(nearest[0]), city.center_of(nearest[1])


def refuse_heights(options: argparse.Namespace) -> None:
    """`ValueError` if limits of height or a planner are asked for, which a live page hasn't."""
    for name in ("min_height", "max_height", "planner"):
        if getattr(options, name) is not None:
            raise ValueError(
                f"--{name.replace('_', '-')} is nothing that a page with --live has: leave one of the two out"
            )


def live_page(
    options: argparse.Namespace,
    city: City,
    risk_map: RiskMap | None,
    start: np.ndarray,
    goal: np.ndarray,
    premises: Premises,
) -> str:
    """The page in which planners answer, with the wind and the distance to keep that the report would have."""
    from uavlab.scene import live
    from uavlab.scene.live import MOST_FLIGHTS
    from uavlab.scene.live_offers import SLIDERS

    along, across = premises.wind.mean[:2]
    asked = {
        "wind": float(np.hypot(along, across)),
        "towards": float(np.degrees(np.arctan2(along, across))) % 360,
        "gusts": premises.wind.deviation,
        "keep": min(premises.safe_distance, float(city.clearance[tuple(city.cell_of([start, goal]).T)].min())),
    }
    has = {"keep"} if risk_map is None else set()
    has |= {"wind", "towards", "gusts"} if options.flights else set()
    settings = {}
    for name in sorted(has):
        value = asked[name]
        slider = SLIDERS[name]
        settings[name] = float(np.clip(slider.step * np.floor(value / slider.step + 1e-9), slider.least, slider.most))
    names = ["A*", "Theta*", "hazard A*", "potential field"] if risk_map is None else ["least risk", "shortest"]
    return live(
        city, start, goal, planners=names, shown=names[:3], settings=settings, risk=risk_map, uav=premises.uav,
        flights=min(options.flights, MOST_FLIGHTS), expansions=risk_map is None,
    ).page  # fmt: skip
