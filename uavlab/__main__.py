"""`python -m uavlab`: the whole way once, from the weather to flights, as one HTML page that opens anywhere.

Weather, offset, distance to keep, route, curve, feasibility, flights in gusts. Without arguments it takes the city of
REPARE Table 1 and its case of a light load in mild wind; `--city campus` plans over people, by risk. The page holds the
3D scene, the profile of height and clearance, and tables of what was measured; it needs neither Jupyter nor a network.
"""

import argparse
import base64
import html
import io
import sys
import time
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from uavlab import __version__

if TYPE_CHECKING:  # imported late, so that --help answers at once
    from uavlab.city import City
    from uavlab.flight import Flight, Flights, Wind
    from uavlab.risk import RiskMap
    from uavlab.route import Route
    from uavlab.spline import Curve, Feasibility
    from uavlab.vehicle import UAV

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
    command.add_argument("--start", type=position, metavar="X,Y,Z", help="metres; default: near the south-west corner")
    command.add_argument("--goal", type=position, metavar="X,Y,Z", help="metres; default: near the north-east corner")
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


def run(options: argparse.Namespace) -> int:
    """Plan, smooth, fly, draw, write; print where the page is."""
    began = time.perf_counter()
    if options.flights < 0:
        raise ValueError(f"--flights must be at least 0, got {options.flights}")
    city, risk_map = load_city(options.city, options.cell)
    conditions = conditions_of(options, risk_map)
    if conditions.grounded:
        print(f"grounded: {conditions.grounded}")
        return 1
    start, goal = (
        point if point is not None else default
        for point, default in zip(
            (options.start, options.goal), default_flight(city, conditions.clearance), strict=True
        )
    )
    routes, risk_map = plan(options, city, risk_map, start, goal, conditions.clearance)
    trial = try_out(routes[0], city, conditions, options.flights, options.seed)
    page = report(city, routes, start, goal, conditions, trial, risk_map)
    try:
        options.out.write_text(page, encoding="utf-8")
    except OSError as error:
        raise OSError(f"can't write {options.out}: {error.strerror}; choose another file with --out") from error
    print(f"{routes[0].planner}: {routes[0].length:.1f} m" if routes[0].reached else f"not reached: {routes[0].reason}")
    for line in trial.lines():
        print(line)
    print(f"{time.perf_counter() - began:.1f} s; open {options.out.resolve()}")
    return 1 if trial.problem else 0


class Conditions(NamedTuple):
    """Who flies in what, and how far it has to keep from walls."""

    uav: "UAV"
    wind: "Wind"
    gust: float
    sigma: float
    clearance: float
    grounded: str


def conditions_of(options: argparse.Namespace, risk_map: "RiskMap | None") -> Conditions:
    """From weather and load to the offset to be survived, and the distance to keep (REPARE Eqs 3, 5 and 7)."""
    from uavlab.flight import Wind
    from uavlab.resilience import gust_force, physical_distance
    from uavlab.vehicle import LIGHT_QUADROTOR
    from uavlab.weather import Weather

    if options.city == "campus" and risk_map is not None:
        uav = risk_map.uav.loaded(options.payload or 0.0)
    else:
        uav = LIGHT_QUADROTOR.loaded(0.25 if options.payload is None else options.payload)
    weather = Weather(forecast_wind=options.wind, wind_from_deg=options.wind_from, rain_mm_per_h=options.rain)
    wind = Wind.from_weather(weather)
    pushed, held = gust_force(uav, wind.speed), float(uav.horizontal_reserve())
    if pushed >= held:
        why = f"gusts push with {pushed:.1f} N, the thrust left over holds {held:.1f} N: {pushed - held:.1f} N short"
        return Conditions(uav, wind, weather.reference_wind.gust, np.inf, np.inf, why)
    needed = physical_distance(uav, wind.speed)
    clearance = needed if options.clearance is None else options.clearance
    return Conditions(uav, wind, weather.reference_wind.gust, (needed - uav.diameter / 2) / 3, clearance, "")


def plan(
    options: argparse.Namespace,
    city: "City",
    risk_map: "RiskMap | None",
    start: np.ndarray,
    goal: np.ndarray,
    clearance: float,
) -> tuple[list["Route"], "RiskMap | None"]:
    """The route asked for, others to compare it with, and the risk map if there is one."""
    from uavlab.planners import astar, shortcut

    planner = options.planner or ("any-angle" if risk_map is None else "least-risk")
    if planner == "least-risk":
        risk_map = risk_map or assumed_risk(city)
        return by_risk(risk_map, start, goal, clearance, options.detour), risk_map
    route = astar(city, start, goal, min_clearance=clearance)
    return [shortcut(route, city, min_clearance=clearance) if planner == "any-angle" else route], risk_map


class Trial(NamedTuple):
    """A route as a curve, and flown."""

    problem: str = ""
    """Why it can't be flown; empty if it can."""
    curve: "Curve | None" = None
    limits: "Feasibility | None" = None
    flight: "Flight | None" = None
    flights: "Flights | None" = None
    as_planned: "Flights | None" = None
    """With offsets as large as the distance was chosen for."""

    def lines(self) -> list[str]:
        """What to say in a terminal."""
        if self.problem:
            return [f"not flown: {self.problem}"]
        said = []
        if self.curve is not None and self.limits is not None:
            kept = "all limits kept" if self.limits.feasible else "limits exceeded: " + ", ".join(self.exceeded())
            said.append(f"smoothed: {self.curve.length:.1f} m, at {self.limits.speed:g} m/s {kept}")
        if self.flights is not None:
            said.append(f"flown {len(self.flights.outcome)} times in gusts, crashed {self.flights.crashed.sum()} times")
        return said

    def exceeded(self) -> list[str]:
        return [] if self.limits is None else [limit.name for limit in self.limits.limits if not limit.met]


def try_out(route: "Route", city: "City", conditions: Conditions, flights: int, seed: int) -> Trial:
    """Smooth a route, check the curve, and fly it."""
    from uavlab.flight import OffsetProcess, fly, monte_carlo
    from uavlab.spline import feasibility, smooth

    if not route.reached:
        return Trial("there is no route")
    uav, wind = conditions.uav, conditions.wind
    try:
        curve = smooth(route, city, uav, min_clearance=conditions.clearance)
    except ValueError as error:
        return Trial(str(error))
    trial = Trial("", curve, feasibility(curve, uav, city, wind=wind.mean))
    if flights == 0:
        return trial
    flight = fly(curve, city, uav, wind, rng=seed)
    if flight.outcome == "grounded":
        return trial._replace(problem=f"grounded: {flight.reason}")
    flown = monte_carlo(curve, city, uav, wind, rng=seed, flights=flights)
    offsets = OffsetProcess(conditions.sigma)
    return trial._replace(
        flight=flight, flights=flown, as_planned=monte_carlo(curve, city, uav, offsets, rng=seed, flights=flights)
    )


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
    conditions: Conditions,
    trial: Trial,
    risk_map: "RiskMap | None",
) -> str:
    """The page as HTML: the curve is the answer, or the first route where there is none; others are to compare."""
    from matplotlib import rc_context

    from uavlab import plot, scene

    drawn = routes if trial.curve is None else [trial.curve.route(city.cell), *routes[1:]]
    clearance = conditions.clearance
    picture = io.BytesIO()
    with rc_context({"svg.hashsalt": "uavlab"}):  # same question, same bytes
        profile = plot.profile(city, *drawn, safe_distance=clearance)
        profile.savefig(picture, format="svg", metadata={"Date": None})
    drawing = base64.b64encode(picture.getvalue()).decode()
    measured = conditions_table(conditions) + table(city, routes[0], start, goal)
    if risk_map is not None:
        measured += risk_table(risk_map, routes, trial.curve)
    measured += trial_table(trial, conditions)
    rows = "".join(f"<tr><th>{name}</th><td>{value}</td></tr>" for name, value in measured)
    ball = clearance if clearance > 0 else None
    flights = {} if trial.flight is None else {f"{drawn[0].planner}, flown in these gusts": trial.flight}
    shown = drawn[1:] if flights else drawn  # the track covers its curve
    limits = ""
    if trial.limits is not None:
        limits = f"<h2>Can it be flown?</h2>{trial.limits._repr_html_()}"
    return PAGE.format(
        title=html.escape(f"{routes[0].planner} through {city.name}"),
        scene=html.escape(scene.page(city, *shown, flights=flights, safe_distance=ball, risk=risk_map)),
        profile=f'<img alt="height and clearance along the route" src="data:image/svg+xml;base64,{drawing}">',
        rows=rows,
        limits=limits,
        version=__version__,
    )


def conditions_table(conditions: Conditions) -> list[tuple[str, str]]:
    """Weather, vehicle, and what they ask for, as name and value."""
    uav, wind = conditions.uav, conditions.wind
    rain = f", {wind.rain_mm_per_h:g} mm/h of rain" if wind.rain_mm_per_h else ""
    rows = [
        ("the UAV", f"{uav.name}, with a load of {uav.payload:g} kg"),
        ("weather", f"wind of {wind.speed:.1f} m/s, gusts up to {conditions.gust:.1f} m/s{rain}"),
        ("offsets to be survived", f"{3 * conditions.sigma:.1f} m (σ = {conditions.sigma:.2f} m)"),
        ("distance to keep", f"{conditions.clearance:g} m"),
    ]
    return [(name, html.escape(value)) for name, value in rows]


def trial_table(trial: Trial, conditions: Conditions) -> list[tuple[str, str]]:
    """What became of the curve and its flights, as name and value."""
    from uavlab.flight import crash_rate
    from uavlab.spline import greatest_speed

    rows = []
    if trial.curve is not None:
        repair = f"{trial.curve.info['rounds']} rounds of repair" if trial.curve.info["rounds"] else "no repair needed"
        fastest = greatest_speed(trial.curve, conditions.uav, conditions.wind.mean)
        rows += [
            ("B-spline", f"{trial.curve.length:.1f} m, {len(trial.curve.control)} control points, {repair}"),
            ("fastest without slowing down", f"{fastest:.1f} m/s"),
        ]
    if trial.flights is not None and trial.as_planned is not None:
        flights = trial.flights
        across, up = flights.samples.std(axis=0)
        rows += [
            ("crashes in these gusts", f"{crash_rate(flights)} ({len(flights.outcome)} flights)"),
            ("offsets in these gusts", f"σ {across:.2f} m across the route, {up:.2f} m up and down"),
            ("nearest to an obstacle", f"{flights.clearance.min():.2f} m from the centre of the body"),
            ("time", f"{flights.duration.mean():.0f} s, slower than {conditions.uav.cruise_speed:g} m/s in turns"),
            ("energy", f"{flights.energy.mean() / 3600:.2f} Wh from the battery"),
            (f"crashes with σ = {conditions.sigma:.2f} m", str(crash_rate(trial.as_planned))),
        ]
    if trial.problem:
        rows.append(("not flown", trial.problem))
    return [(name, html.escape(value)) for name, value in rows]


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


def risk_table(risk_map: "RiskMap", routes: list["Route"], curve: "Curve | None") -> list[tuple[str, str]]:
    """What the routes cost on the risk map, as name and value."""
    people, speed = 1e6 * risk_map.population_density, risk_map.uav.cruise_speed
    rows = [("people on the ground", f"{people.mean():,.0f} per km² on average, at most {people.max():,.0f}")]
    smoothed = [] if curve is None else [curve.route()]
    for route in [*routes, *smoothed]:
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
th{{text-align:left;padding-right:2em;font-weight:600;vertical-align:top}} td{{padding-right:1.5em}}
</style></head><body>
<h1>{title}</h1>
<iframe title="3D scene" srcdoc="{scene}"></iframe>
<p>Drag to turn, scroll to zoom, right-drag to move.</p>
<h2>Height and clearance along the route</h2>
{profile}
<h2>Measured</h2>
<table>{rows}</table>
{limits}
<p>uavlab {version}</p>
</body></html>
"""

if __name__ == "__main__":
    sys.exit(main())
