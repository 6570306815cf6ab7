"""`python -m uavlab`: the whole way once, from the weather to flights, as one HTML page that opens anywhere.

Weather, offset, distance to keep, route, curve, feasibility, flights in gusts. Without arguments it takes the city of
REPARE Table 1 and its case of a light load in mild wind; `--city campus` plans over people, by risk. The page holds the
3D scene, the profile of height and clearance, and tables of what was measured; it needs neither Jupyter nor a network.
With `--live` it is a scene in which start, goal and wind are dragged, and planners and flights answer in the page.
"""

from __future__ import annotations

import argparse
import errno
import io
import os
import sys
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from uavlab import __version__
from uavlab.files import beside, written_whole
from uavlab.report import grounded_page, report
from uavlab.requirements import require
from uavlab.whole_way import (
    default_flight,
    heights_of,
    live_page,
    load_city,
    plan,
    planner_of,
    position_of,
    premises_of,
    refuse_heights,
    tell_effort,
    try_out,
)

PLANNERS = {
    "astar": "A* over 26 neighbours",
    "any-angle": "A*, then straight lines where nothing is in between",
    "least-risk": "least risk to people on the ground, within --detour",
}
STOPPED = 130
"""What a shell gives for who was interrupted."""


def main(arguments: list[str] | None = None) -> int:
    """Run the command line; 0 when the route arrives, 1 when there is none, 2 for a wrong question, 130 for Ctrl-C."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # not every terminal can print every name
            stream.reconfigure(errors="replace")
    options = parser().parse_args(joined(sys.argv[1:] if arguments is None else arguments))
    try:
        return run(options)
    except (ValueError, OSError, OverflowError, ImportError) as error:
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
        "--live",
        action="store_true",
        help="write a page in which start, goal and wind are dragged, and the planners answer, in place of the report",
    )
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
    require("meshcat", "scene")  # before any work
    if not 0 <= options.flights <= MOST_FLIGHTS:
        raise ValueError(f"--flights must be from 0 to {MOST_FLIGHTS:,}, got {options.flights:.6g}")
    if options.live:
        refuse_heights(options)
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
    if options.live:
        write(options.out, live_page(options, city, risk_map, start, goal, premises))
        print(f"{time.perf_counter() - began:.1f} s; open {options.out.resolve()}")
        return 0
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


def refuse_unwritable(path: Path) -> None:
    """`OSError` before any work if a page can't be written there."""
    try:
        if path.is_dir():
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
        part = beside(path)
        part.touch()
        part.unlink()
    except OSError as error:
        raise OSError(f"can't write {path}: {error.strerror}; choose another file with --out") from error


def write(path: Path, page: str) -> None:
    """Write a page; an old one isn't lost if that fails."""
    try:
        with written_whole(path) as part:
            part.write_text(page, encoding="utf-8")
    except OSError as error:
        raise OSError(f"can't write {path}: {error.strerror}; choose another file with --out") from error


if __name__ == "__main__":
    sys.exit(main())
