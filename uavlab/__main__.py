"""`python -m uavlab`: plan a route through a city and draw it, as one HTML page that opens anywhere.

Without arguments it takes the city of REPARE Table 1; `--city campus` plans over people, by risk. The page holds the 3D
scene, the profile of height and clearance, and a table of what was measured; it needs neither Jupyter nor a network.
"""

import argparse
import base64
import html
import io
import sys
import time
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from uavlab import __version__

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


def main(arguments: list[str] | None = None) -> int:
    """Run the command line; 0 when the route arrives, 1 when there is none, 2 for a wrong question."""
    options = parser().parse_args(arguments)
    try:
        return run(options)
    except (ValueError, OSError) as error:
        print(f"uavlab: {error}", file=sys.stderr)
        return 2


def parser() -> argparse.ArgumentParser:
    command = argparse.ArgumentParser(
        prog="python -m uavlab",
        description="Plan a route through a city and write it as one HTML page: 3D scene, profile, table.",
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
    command.add_argument("--start", type=position, metavar="X,Y,Z", help="metres; default: near the south-west corner")
    command.add_argument("--goal", type=position, metavar="X,Y,Z", help="metres; default: near the north-east corner")
    command.add_argument(
        "--clearance",
        type=float,
        default=3.5,
        metavar="M",
        help="least distance to obstacles in metres; default %(default)s (REPARE Table 4: light load, mild wind)",
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


def run(options: argparse.Namespace) -> int:
    """Plan, draw, write; print where the page is."""
    from uavlab.planners import astar, shortcut

    began = time.perf_counter()
    city, risk_map = load_city(options.city, options.cell)
    start, goal = (
        point if point is not None else default
        for point, default in zip((options.start, options.goal), default_flight(city, options.clearance), strict=True)
    )
    planner = options.planner or ("any-angle" if risk_map is None else "least-risk")
    if planner == "least-risk":
        risk_map = risk_map or assumed_risk(city)
        routes = by_risk(risk_map, start, goal, options.clearance, options.detour)
    else:
        routes = [astar(city, start, goal, min_clearance=options.clearance)]
    if planner == "any-angle":
        routes = [shortcut(routes[0], city, min_clearance=options.clearance)]
    route = routes[0]
    try:
        options.out.write_text(report(city, routes, start, goal, options.clearance, risk_map), encoding="utf-8")
    except OSError as error:
        raise OSError(f"can't write {options.out}: {error.strerror}; choose another file with --out") from error
    print(f"{route.planner}: {route.length:.1f} m" if route.reached else f"not reached: {route.reason}")
    print(f"{time.perf_counter() - began:.1f} s; open {options.out.resolve()}")
    return 0 if route.reached else 1


def load_city(name: str, cell: float | None) -> tuple["City", "RiskMap | None"]:
    """A city by name, or from a file, and its risk map where it has one."""
    from uavlab.city import read_city, table1_city
    from uavlab.risk import reference_campus

    if name == "table1":
        return table1_city(cell=1.0 if cell is None else cell), None
    if name == "campus":
        risk_map = reference_campus(cell=5.0 if cell is None else cell)
        return risk_map.city, risk_map
    if not Path(name).is_file():
        raise ValueError(f"--city {name}: neither a known name (table1, campus) nor a file")
    return read_city(name, cell=2.0 if cell is None else cell), None


def assumed_risk(city: "City") -> "RiskMap":
    """A risk map where nothing is known of the people: as many everywhere, sparse trees beside the buildings."""
    from uavlab.risk import POPULATION_DENSITY, RiskMap, shelter_layer

    return RiskMap(city, POPULATION_DENSITY, shelter_layer(city, "sparse trees"))  # type: ignore[arg-type]


def by_risk(
    risk_map: "RiskMap", start: np.ndarray, goal: np.ndarray, clearance: float, detour_percent: float
) -> list["Route"]:
    """The route of least risk within a detour, and beside it the safest of the shortest."""
    from uavlab.planners import least_risk

    if not 0 <= detour_percent < np.inf:
        raise ValueError(f"--detour must be a percentage, finite and at least 0, got {detour_percent:g}")
    blind = least_risk(risk_map, start, goal, length=1.0, min_clearance=clearance)  # a metre outweighs all risk
    blind = replace(blind, planner="shortest")
    if not blind.reached:
        return [blind]
    longest = blind.length * (1 + detour_percent / 100)
    return [least_risk(risk_map, start, goal, max_length=longest, min_clearance=clearance), blind]


def default_flight(city: "City", clearance: float) -> tuple[np.ndarray, np.ndarray]:
    """A flight across the map: a known one, else from the south-west to the north-east, amid the buildings."""
    from uavlab.risk import CAMPUS_FLIGHT

    known = {"Table 1": TABLE1_FLIGHT, "reference campus": CAMPUS_FLIGHT}
    if city.name in known:
        return np.array(known[city.name][0]), np.array(known[city.name][1])
    free = np.argwhere(~city.blocked(clearance))
    if len(free) == 0:
        raise ValueError(f"--clearance {clearance:g}: no voxel of the map is that far from all obstacles; ask for less")
    built = np.flatnonzero(city.occupied.any(axis=(0, 1)))
    height = 0.4 * (built[-1] + 1 if len(built) else city.shape[2])
    size = np.array(city.shape)
    wanted = np.array([0.1, 0.1, 0.0]) * size + [0, 0, height], np.array([0.9, 0.9, 0.0]) * size + [0, 0, height]
    nearest = [free[np.argmin(((free + 0.5 - point) ** 2).sum(axis=1))] for point in wanted]
    return city.center_of(nearest[0]), city.center_of(nearest[1])


def report(
    city: "City",
    routes: list["Route"],
    start: np.ndarray,
    goal: np.ndarray,
    clearance: float,
    risk_map: "RiskMap | None",
) -> str:
    """The page as HTML: the first route is the answer, others are there to compare."""
    from uavlab import plot, scene

    picture = io.BytesIO()
    plot.profile(city, *routes, safe_distance=clearance).savefig(picture, format="svg")
    profile = base64.b64encode(picture.getvalue()).decode()
    measured = table(city, routes[0], start, goal)
    if risk_map is not None:
        measured += risk_table(risk_map, routes)
    rows = "".join(f"<tr><th>{name}</th><td>{value}</td></tr>" for name, value in measured)
    ball = clearance if clearance > 0 else None
    return PAGE.format(
        title=html.escape(f"{routes[0].planner} through {city.name}"),
        scene=html.escape(scene.page(city, *routes, safe_distance=ball, risk=risk_map)),
        profile=f'<img alt="height and clearance along the route" src="data:image/svg+xml;base64,{profile}">',
        rows=rows,
        version=__version__,
    )


def table(city: "City", route: "Route", start: np.ndarray, goal: np.ndarray) -> list[tuple[str, str]]:
    """What was planned and measured, as name and value."""
    from uavlab.checks import show

    rows = [
        ("city", f"{city.name}: {' × '.join(map(str, city.shape))} voxels of {city.cell:g} m, "
                 f"{city.occupied.mean():.1%} occupied, {len(city.buildings)} buildings"),
        ("start, goal", f"{show(start)} m to {show(goal)} m"),
        ("planner", route.planner),
    ]  # fmt: skip
    if route.reached:
        rows += [
            ("length", f"{route.length:.1f} m in {len(route.points) - 1} straight legs"),
            ("least clearance", f"{route.clearance(city):.2f} m"),
            ("steepest climb or descent", f"{np.degrees(np.abs(route.pitch).max()):.0f}°"),
            ("sharpest turn", f"{np.degrees(route.turn.max(initial=0.0)):.0f}°"),
        ]
    else:
        rows.append(("not reached", route.reason))
    free = np.count_nonzero(~city.occupied)
    rows.append(("search", f"{route.info['expanded']:,} expansions on {free:,} free nodes"))
    return [(name, html.escape(value)) for name, value in rows]


def risk_table(risk_map: "RiskMap", routes: list["Route"]) -> list[tuple[str, str]]:
    """What the routes cost on the risk map, as name and value."""
    people, speed = 1e6 * risk_map.population_density, risk_map.uav.cruise_speed
    rows = [
        ("people on the ground", f"{people.mean():,.0f} per km² on average, at most {people.max():,.0f}"),
        ("the UAV", risk_map.uav.name),
    ]
    for route in routes:
        if route.reached:
            risk, deaths = risk_map.integral(route), risk_map.fatalities(route)
            costs = f"{risk:.2e} per hour (∫ r ds/dx), {deaths:.1e} deaths per flight at {speed:g} m/s"
            rows.append((f"risk: {route.planner}, {route.length:.1f} m", costs))
    if len(routes) == 2:
        saved = 1 - risk_map.integral(routes[0]) / risk_map.integral(routes[1])
        longer = routes[0].length / routes[1].length - 1
        rows.append(("against the shortest route", f"{saved:.0%} less risk for {longer:.1%} more way"))
    return [(name, html.escape(value)) for name, value in rows]


PAGE = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>{title}</title>
<style>
body{{font:15px/1.5 system-ui,sans-serif;max-width:960px;margin:1em auto;padding:0 1em;color:#222}}
iframe{{width:100%;height:560px;border:1px solid #ccc}} img{{width:100%}}
th{{text-align:left;padding-right:2em;font-weight:600;vertical-align:top}}
</style></head><body>
<h1>{title}</h1>
<iframe title="3D scene" srcdoc="{scene}"></iframe>
<p>Drag to turn, scroll to zoom, right-drag to move.</p>
<h2>Height and clearance along the route</h2>
{profile}
<h2>Measured</h2>
<table>{rows}</table>
<p>uavlab {version}</p>
</body></html>
"""

if __name__ == "__main__":
    sys.exit(main())
