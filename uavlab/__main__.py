"""`python -m uavlab`: the whole way once, from the weather to flights, as one HTML page that opens anywhere.

Weather, offset, distance to keep, route, curve, feasibility, flights in gusts. Without arguments it takes the city of
REPARE Table 1 and its case of a light load in mild wind; `--city campus` plans over people, by risk. The page holds the
3D scene, the profile of height and clearance, and tables of what was measured; it needs neither Jupyter nor a network.
"""

from __future__ import annotations

import argparse
import errno
import io
import os
import sys
import time
import warnings
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from uavlab import __version__
from uavlab.report import Premises, Trial, grounded_page, report

if TYPE_CHECKING:  # imported late, so that --help answers at once
    from uavlab.city import City
    from uavlab.risk import RiskMap
    from uavlab.route import Route

TABLE1_FLIGHT = ((90.0, 18.0, 30.0), (20.0, 75.0, 75.0))
"""From inside the notch of building 1 to above the floating building [m]."""

PLANNERS = {
    "astar": "A* over 26 neighbours",
    "any-angle": "A*, then straight lines where nothing is in between",
    "least-risk": "least risk to people on the ground, within --detour",
}


STOPPED = 130
"""What a shell gives for who was interrupted."""

EFFORT = {"astar": (50, 3e-7), "any-angle": (50, 3e-7), "least-risk": (550, 1e-5)}
"""Memory [bytes] and time [s] that planning takes for each voxel, roughly."""

READING = 30, 1.0
"""Memory [bytes] and time [µs] for each byte of a file."""

FLIGHT = 2e-3
"""Time of a flight of half a minute [s]."""

LONG = 5.0
"""What takes more seconds is told before."""


def main(arguments: list[str] | None = None) -> int:
    """Run the command line; 0 when the route arrives, 1 when there is none, 2 for a wrong question, 130 for Ctrl-C."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # not every terminal can print every name
            stream.reconfigure(errors="replace")
    options = parser().parse_args(joined(sys.argv[1:] if arguments is None else arguments))
    try:
        return run(options)
    except (ValueError, OSError, OverflowError) as error:
        print(f"uavlab: {error}", file=sys.stderr)
    except MemoryError as error:
        print(f"uavlab: the memory isn't enough ({error}): take a larger --cell, or fewer --flights", file=sys.stderr)
    except KeyboardInterrupt:
        print("uavlab: stopped; no page was written", file=sys.stderr)
        return STOPPED
    return 2


POSITIONS = ("--start", "--goal", "--start-lonlat", "--goal-lonlat")


def joined(arguments: Sequence[str]) -> list[str]:
    """The arguments with positions as --start=-10,10,25: argparse takes a negative number alone for an option."""
    words = list(arguments)
    for number in range(len(words) - 1, 0, -1):
        if words[number - 1] in POSITIONS and words[number].startswith("-"):
            words[number - 1 : number + 1] = [f"{words[number - 1]}={words[number]}"]
    return words


def parser() -> argparse.ArgumentParser:
    command = argparse.ArgumentParser(
        prog="python -m uavlab",
        description="From the weather to a route, a curve and flights in gusts; written as one HTML page.",
    )
    command.add_argument(
        "--city",
        default="table1",
        metavar="NAME|FILE",
        help="table1 (REPARE Table 1, the default), campus (people, roads and shelter, for planning by risk), or a "
        "file: GeoJSON with heights, CityJSON, or .3dmap voxels",
    )
    command.add_argument(
        "--cell", type=float, metavar="M", help="edge of a voxel in metres; default 1, for the campus 5, for a file 2"
    )
    command.add_argument(
        "--planner",
        choices=PLANNERS,
        help="; ".join(f"{name}: {what}" for name, what in PLANNERS.items())
        + "; default any-angle, for the campus least-risk",
    )
    command.add_argument(
        "--detour",
        type=float,
        default=10.0,
        metavar="PERCENT",
        help="how much longer than the shortest route a route of least risk may be; default %(default)s",
    )
    for name, corner in (("start", "south-west"), ("goal", "north-east")):
        one = command.add_mutually_exclusive_group()
        one.add_argument(f"--{name}", type=position, metavar="X,Y,Z", help=f"metres; default: near the {corner} corner")
        one.add_argument(
            f"--{name}-lonlat", type=position, metavar="LON,LAT,HEIGHT", help="degrees, and metres above ground"
        )
    files = command.add_argument_group("reading a file")
    files.add_argument("--height", type=number_or_name, metavar="PROPERTY|M", help="GeoJSON: where the height stands")
    files.add_argument("--default-height", type=float, metavar="M", help="GeoJSON: of buildings without a height")
    files.add_argument("--storey-height", type=float, metavar="M", help="GeoJSON: of a storey; default 3")
    files.add_argument("--crs", metavar="CODE", help="reference system, such as EPSG:2263, or local for plain metres")
    files.add_argument("--terrain", type=number_or_name, metavar="FILE|M", help="the ground: an .asc grid or a GeoTIFF")
    files.add_argument("--no-fly", type=Path, metavar="FILE", help="GeoJSON with zones, limits in lower and upper")
    command.add_argument("--min-height", type=float, metavar="M", help="least height above ground; default 0")
    command.add_argument("--max-height", type=float, metavar="M", help="greatest height above ground; default none")
    command.add_argument(
        "--wind", type=float, default=6.0, metavar="M/S", help="mean wind; default %(default)s, a mild disturbance"
    )
    command.add_argument(
        "--wind-from",
        type=float,
        default=240.0,
        metavar="DEG",
        help="where it comes from; default %(default)s (0: north)",
    )
    command.add_argument("--rain", type=float, default=0.0, metavar="MM/H", help="rain rate; default %(default)s")
    command.add_argument(
        "--payload", type=float, metavar="KG", help="load carried; default 0.25, a light load, for the campus 0"
    )
    command.add_argument(
        "--clearance",
        type=float,
        metavar="M",
        help="least distance to obstacles; default: what wind and load ask for, 3.5 m unless you change them, as in "
        "REPARE Table 4",
    )
    command.add_argument(
        "--flights", type=int, default=200, metavar="N", help="how often to fly it in gusts; default %(default)s"
    )
    command.add_argument("--seed", type=int, default=1, metavar="N", help="of the gusts; default %(default)s")
    command.add_argument(
        "--out", type=Path, default=Path("uavlab-route.html"), metavar="FILE", help="the page; default %(default)s"
    )
    command.add_argument("--version", action="version", version=f"uavlab {__version__}")
    return command


def position(text: str) -> tuple[float, ...]:
    """Three numbers, as in 90,20,30."""
    try:
        coordinates = tuple(float(part) for part in text.split(","))
    except ValueError:
        coordinates = ()
    if len(coordinates) != 3:
        raise argparse.ArgumentTypeError(f"{text!r} is not a position: give three numbers in metres, as in 90,20,30")
    return coordinates


def number_or_name(text: str) -> float | str:
    """A number where it is one."""
    try:
        return float(text)
    except ValueError:
        return text


def run(options: argparse.Namespace) -> int:
    """Plan, smooth, fly, draw, write; print where the page is."""
    from uavlab.flight.simulation import MOST_FLIGHTS

    began = time.perf_counter()
    if not 0 <= options.flights <= MOST_FLIGHTS:
        raise ValueError(f"--flights must be from 0 to {MOST_FLIGHTS:,}, got {options.flights:.6g}")
    if not 0 <= options.detour < np.inf:
        raise ValueError(f"--detour must be a percentage, finite and at least 0, got {options.detour:g}")
    if Path(options.city).is_file() and options.out.exists() and options.out.samefile(options.city):
        raise ValueError(f"--out {options.out} is the city's own file: choose another")
    refuse_unwritable(options.out)
    city, risk_map = load_city(options)
    if city.source is not None:
        print(city.source)
    premises = premises_of(options, risk_map)
    if premises.grounded:
        print(f"grounded: {premises.grounded}")
        write(options.out, grounded_page(city, premises))
        print(f"{time.perf_counter() - began:.1f} s; open {options.out.resolve()}")
        return 1
    tell_effort(city, planner_of(options, risk_map))
    heights = heights_of(options, risk_map)
    asked = (position_of(options, city, name) for name in ("start", "goal"))
    usual = default_flight(city, premises.safe_distance, heights)
    start, goal = (default if point is None else point for point, default in zip(asked, usual, strict=True))
    routes, risk_map = plan(options, city, risk_map, start, goal, premises.safe_distance, heights)
    above_roofs = 0.0 if risk_map is None else risk_map.safe_height
    trial = try_out(routes[0], city, premises, heights, above_roofs, options.flights, options.seed)
    page = report(city, routes, start, goal, premises, trial, risk_map)
    write(options.out, page)
    print(f"{routes[0].planner}: {routes[0].length:.1f} m" if routes[0].reached else f"not reached: {routes[0].reason}")
    for line in trial.lines():
        print(line)
    print(f"{time.perf_counter() - began:.1f} s; open {options.out.resolve()}")
    return 1 if trial.problem else 0


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


def refuse_unwritable(path: Path) -> None:
    """`OSError` before any work if a page can't be written there."""
    try:
        if path.is_dir():
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
        beside = beside_of(path)
        beside.touch()
        beside.unlink()
    except OSError as error:
        raise OSError(f"can't write {path}: {error.strerror}; choose another file with --out") from error


def beside_of(path: Path) -> Path:
    """Where a page is written before it takes the place of an old one."""
    return path.with_name(f"{path.name}.{os.getpid()}.part")


def write(path: Path, page: str) -> None:
    """Write a page beside its place first, so that an old one isn't lost if that fails."""
    beside = beside_of(path)
    try:
        beside.write_text(page, encoding="utf-8")
        beside.replace(path)
    except OSError as error:
        beside.unlink(missing_ok=True)
        raise OSError(f"can't write {path}: {error.strerror}; choose another file with --out") from error


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

    known = {"Table 1": TABLE1_FLIGHT, "reference campus": CAMPUS_FLIGHT}
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


if __name__ == "__main__":
    sys.exit(main())
