"""What `python -m uavlab` found, as one page: the scene, the profile of height and clearance, tables of measurements.

The page needs neither Jupyter nor a network.
"""

from __future__ import annotations

import base64
import html
import io
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from uavlab import __version__
from uavlab.vehicle import WATT_HOUR

if TYPE_CHECKING:  # imported late, so that --help answers at once
    from matplotlib.figure import Figure

    from uavlab.city import City
    from uavlab.flight import Flight, Flights
    from uavlab.risk import RiskMap
    from uavlab.route import Route
    from uavlab.spline import Curve, Feasibility
    from uavlab.vehicle import UAV
    from uavlab.weather import Wind


class Premises(NamedTuple):
    """Who flies in what, and how far it has to keep from walls."""

    uav: UAV
    wind: Wind
    gust: float
    sigma: float
    safe_distance: float
    grounded: str


class Trial(NamedTuple):
    """A route as a curve, and flown."""

    problem: str = ""
    """Why it can't be flown; empty if it can."""
    curve: Curve | None = None
    limits: Feasibility | None = None
    flight: Flight | None = None
    flights: Flights | None = None
    as_planned: Flights | None = None
    """With offsets as large as the distance was chosen for."""

    def lines(self) -> list[str]:
        """What to say in a terminal."""
        if self.problem:
            return [f"not flown: {self.problem}"]
        said = []
        if self.curve is not None and self.limits is not None:
            kept = "all limits kept" if self.limits.feasible else "limits exceeded: " + ", ".join(self.exceeded())
            said.append(f"smoothed: {self.curve.length:.1f} m, at {self.limits.speed:.3g} m/s {kept}")
        if self.flights is not None:
            given_up = int((self.flights.outcome == "gave up").sum())
            said.append(
                f"flown {len(self.flights.outcome)} times in gusts, crashed {self.flights.crashed.sum()} times"
                + f", gave up {given_up} times" * bool(given_up)
            )
        return said

    def exceeded(self) -> list[str]:
        return [] if self.limits is None else [limit.name for limit in self.limits.limits if not limit.met]


def report(
    city: City,
    routes: list[Route],
    start: np.ndarray,
    goal: np.ndarray,
    premises: Premises,
    trial: Trial,
    risk_map: RiskMap | None,
) -> str:
    """The page as HTML: the curve is the answer, or the first route where there is none; others are to compare."""
    from uavlab import plot, scene

    drawn = routes if trial.curve is None else [trial.curve.route(city.cell), *routes[1:]]
    ball = premises.safe_distance if premises.safe_distance > 0 else None
    flights = {} if trial.flight is None else {drawn[0].planner: trial.flight}
    shown = drawn[1:] if flights else drawn  # the track covers its curve
    names = [route.planner for route in drawn]
    colors = {name: style.color for name, style in zip(names, plot.styles(names), strict=True)}
    measured = premises_table(premises) + table(city, routes[0], start, goal)
    if risk_map is not None:
        measured += risk_table(risk_map, routes, trial.curve)
    measured += trial_table(trial, premises)
    rows = "".join(f"<tr><th>{name}</th><td>{value}</td></tr>" for name, value in measured)
    read = "" if city.source is None else f"<h2>What was read</h2>{city.source._repr_html_()}"
    limits = ""
    if trial.limits is not None:
        limits = f"<h2>Can it be flown?</h2>{trial.limits._repr_html_()}"
    return PAGE.format(
        title=html.escape(f"{routes[0].planner} through {city.name}"),
        scene=html.escape(
            scene.page(
                city,
                *shown,
                flights=flights,
                safe_distance=ball,
                risk=risk_map,
                wind=premises.wind,
                uav=premises.uav,
                colors=colors,
            )
        ),
        profile=picture_of(plot.profile(city, *drawn, safe_distance=ball, colors=colors)),
        rows=rows,
        limits=limits,
        read=read,
        version=__version__,
    )


def picture_of(figure: Figure) -> str:
    """A figure as a drawing within the page, with words for those who don't see it."""
    from matplotlib import rc_context

    from uavlab.plot import alt_text

    drawn = io.BytesIO()
    with rc_context({"svg.hashsalt": "uavlab"}):  # same question, same bytes
        figure.savefig(drawn, format="svg", metadata={"Date": None})
    drawing = base64.b64encode(drawn.getvalue()).decode()
    return f'<img alt="{html.escape(alt_text(figure))}" src="data:image/svg+xml;base64,{drawing}">'


def grounded_page(city: City, premises: Premises) -> str:
    """The page where nothing flies: so that no older one seems to be the answer."""
    measured = [*premises_table(premises), ("grounded", html.escape(premises.grounded))]
    rows = "".join(f"<tr><th>{name}</th><td>{value}</td></tr>" for name, value in measured)
    return GROUNDED.format(title=html.escape(f"Grounded in {city.name}"), rows=rows, version=__version__)


def premises_table(premises: Premises) -> list[tuple[str, str]]:
    """Weather, vehicle, and what they ask for, as name and value."""
    uav, wind = premises.uav, premises.wind
    rain = f", {wind.rain_mm_per_h:g} mm/h of rain" if wind.rain_mm_per_h else ""
    rows = [
        ("the UAV", f"{uav.name}, with a load of {uav.payload:g} kg"),
        ("weather", f"wind of {wind.speed:.1f} m/s, gusts up to {premises.gust:.1f} m/s{rain}"),
    ]
    if not premises.grounded:
        rows += [
            ("offsets to be survived", f"{3 * premises.sigma:.1f} m (σ = {premises.sigma:.2f} m)"),
            ("distance to keep", f"{premises.safe_distance:g} m"),
        ]
    return [(name, html.escape(value)) for name, value in rows]


def trial_table(trial: Trial, premises: Premises) -> list[tuple[str, str]]:
    """What became of the curve and its flights, as name and value."""
    from uavlab.flight import crash_rate

    rows = []
    if trial.curve is not None and trial.limits is not None:
        repair = f"{trial.curve.info['rounds']} rounds of repair" if trial.curve.info["rounds"] else "no repair needed"
        speed, cruise = trial.limits.speed, premises.uav.cruise_speed
        slowed = f"; its cruise speed of {cruise:g} m/s breaks limits" if speed < cruise else ""
        kept = "all limits kept" if trial.limits.feasible else "beyond the limits of " + ", ".join(trial.exceeded())
        rows += [
            ("B-spline", f"{trial.curve.length:.1f} m, {len(trial.curve.control)} control points, {repair}"),
            ("flown at", f"{speed:.2g} m/s, {kept}{slowed}"),
        ]
    if trial.flights is not None and trial.as_planned is not None:
        flights = trial.flights
        across, up = flights.samples.std(axis=0)
        rows += [
            ("crashes in these gusts", f"{crash_rate(flights)} ({len(flights.outcome)} flights)"),
            ("gave up in these gusts", f"{np.mean(flights.outcome == 'gave up'):.0%}"),
            ("offsets in these gusts", f"σ {across:.2f} m across the route, {up:.2f} m up and down"),
            ("nearest to an obstacle", f"{flights.clearance.min():.2f} m from the centre of the body"),
            ("time", f"{flights.duration.mean():.0f} s"),
            ("energy", energy_used(flights, premises.uav)),
            (f"crashes with σ = {premises.sigma:.2f} m", str(crash_rate(trial.as_planned))),
        ]
    if trial.problem:
        rows.append(("not flown", trial.problem))
    return [(name, html.escape(value)) for name, value in rows]


def energy_used(flights: Flights, uav: UAV) -> str:
    """What flights take from the battery, in watt-hours, and of what it holds."""
    used = flights.energy.mean()
    share = f", {used / uav.battery:.0%} of it" if np.isfinite(uav.battery) else ""
    return f"{used / WATT_HOUR:.2f} Wh from the battery{share}"


def table(city: City, route: Route, start: np.ndarray, goal: np.ndarray) -> list[tuple[str, str]]:
    """What was planned and measured, as name and value."""
    from uavlab.checks import show

    rows = [
        ("city", f"{city.name}: {' × '.join(map(str, city.shape))} voxels of {city.cell:g} m, "
                 f"{city.occupied.mean():.1%} occupied, {len(city.buildings)} buildings"),
        ("start, goal", f"{show(start)} m to {show(goal)} m{on_earth(city, start, goal)}"),
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


def on_earth(city: City, start: np.ndarray, goal: np.ndarray) -> str:
    """Longitudes and latitudes of start and goal, where they are known."""
    if city.reference is None:
        return ""
    (west, south, _), (east, north, _) = city.to_geographic([start, goal])
    return f" (longitude, latitude {west:.6f}°, {south:.6f}° to {east:.6f}°, {north:.6f}°)"


def risk_table(risk_map: RiskMap, routes: list[Route], curve: Curve | None) -> list[tuple[str, str]]:
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


HEAD = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>{title}</title>
<style>
body{{font:15px/1.5 system-ui,sans-serif;max-width:960px;margin:1em auto;padding:0 1em;color:#222}}
iframe{{width:100%;height:560px;border:1px solid #ccc}} img{{width:100%}}
th{{text-align:left;padding-right:2em;font-weight:600;vertical-align:top}} td{{padding-right:1.5em}}
</style></head><body>
<h1>{title}</h1>
"""

FOOT = """<p>uavlab {version}</p>
</body></html>
"""

GROUNDED = f"""{HEAD}<table>{{rows}}</table>
{FOOT}"""

PAGE = f"""{HEAD}<iframe title="3D scene" allow="fullscreen" srcdoc="{{scene}}"></iframe>
<p>Drag to turn, scroll to zoom, right-drag to move; the bar below plays the flight. Space pauses it.</p>
<h2>Height and clearance along the route</h2>
{{profile}}
<h2>Measured</h2>
<table>{{rows}}</table>
{{limits}}
{{read}}
{FOOT}"""
