"""From a city, routes, risk and flights to the drawing of them: what `page`, `show` and `still` have in common."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from uavlab import checks
from uavlab.city import City
from uavlab.flight import Flight
from uavlab.plot.colors import CRASH_COLOR, Style, sequential_color, styles
from uavlab.plot.flights import label_of_flight, named_flights
from uavlab.plot.style import Drawn, drawn_routes, level_of
from uavlab.risk import RiskMap
from uavlab.route import Route
from uavlab.scene.drawing import Dots, Drawing, Entry, Marker, MarkerKind, Surface
from uavlab.scene.motion import CALM, MOST_KEYS, along_flight, along_route, mover
from uavlab.scene.shapes import dashed, thinned, tube
from uavlab.scene.sight import overview_of
from uavlab.scene.stage import begun, draw_ground, draw_risk, draw_wind, draw_zones, show_too
from uavlab.vehicle import LIGHT_QUADROTOR, UAV
from uavlab.weather import Wind

EXPANSION_BATCHES = 40
MOST_POINTS = 12_000
"""Larger expansions are thinned out evenly, so that their page stays small."""
MOST_FLIGHTS = 24
"""That are drawn and fly; of more, some are left out evenly, and the legend says so."""
MOST_NAMED = 7
"""Flights of which each has a colour of its own; more have the colour of how they ended."""
OUTCOME_COLORS = {"arrived": "#0072B2", "crashed": "#D55E00", "landed": "#009E73", "gave up": "#CC79A7"}
NEAR_WIDTH = 0.1
"""Of a route's tube as it is seen from near [m]: a UAV isn't hidden in it."""
CLOSEUP = 100.0
"""A view is near when the eye's distance is less than so many widths of a tube."""
MOST_METRES = 1e6
"""Farther from the centre of the map, coordinates are those of another map."""


def drawing_of(
    city: City,
    routes: Sequence[Drawn],
    *,
    safe_distance: float | None = None,
    expansion: bool = False,
    risk: RiskMap | None = None,
    slice_height: float | None = None,
    flights: Sequence[Flight] | Mapping[str, Flight] = (),
    wind: Wind | None = None,
    uav: UAV = LIGHT_QUADROTOR,
    colors: Mapping[str, str] | None = None,
    title: str | None = None,
) -> Drawing:
    """Check everything, and draw it; arguments are those of `uavlab.scene.page`."""
    planned = drawn_routes(city, routes, risk)
    named = named_flights(flights)
    if safe_distance is not None:
        safe_distance = checks.positive_number("safe_distance", safe_distance)
    if title is not None:
        checks.text("title", title)
    if wind is not None:
        checks.instance("wind", wind, Wind)
    checks.instance("uav", uav, UAV)
    slice_height = checked_slice(city, risk, slice_height)
    if checks.flag("expansion", expansion) and not (planned and "order" in planned[0].info):
        raise ValueError("expansion needs a first route planned with record=True")
    if expansion and named:
        raise ValueError("expansion and flights are two animations: show them in two scenes")

    drawing = begun(city, title)
    draw_ground(drawing, city, risk)
    if risk is not None:
        draw_risk(drawing, risk, slice_height)
    looks = looks_of(planned, named, colors)
    draw_routes(drawing, planned, looks, thin=bool(named))
    fly: Any = {"uav": uav, "wind": wind or CALM, "safe_distance": safe_distance}
    if expansion:
        draw_expansion(drawing, city, planned[0].info["order"])
    elif named:
        draw_flights(drawing, named, looks[len(planned) :], **fly)
    else:
        fly_routes(drawing, planned, looks, **fly)
    signs(drawing)
    draw_zones(drawing, city)
    if wind is not None:
        draw_wind(drawing, city, wind)
    if drawing.movers:
        say_sizes(drawing, uav, safe_distance)
        drawing.overview = overview_of(city, drawing)
    return drawing


def checked_slice(city: City, risk_map: RiskMap | None, height: float | None) -> float | None:
    """A height [m] on the map where the risk is cut."""
    if height is None:
        return None
    if risk_map is None:
        raise ValueError("slice_height needs risk=..., the map to cut")
    height = checks.number("slice_height", height)
    level_of(city, height, "slice_height")
    return height


def looks_of(routes: Sequence[Route], flights: Mapping[str, Flight], colors: Mapping[str, str] | None) -> list[Style]:
    """How each route looks, and then each flight: like the route that it flies, where one has its name."""
    planners = [route.planner for route in routes]
    others = [name for name in flights if name not in planners]
    looks = styles(planners + others, colors)
    by_name = dict(zip(reversed(planners + others), reversed(looks), strict=True))  # the first of a name
    return looks[: len(planners)] + [by_name[name] for name in flights]


def say_sizes(drawing: Drawing, uav: UAV, safe_distance: float | None) -> None:
    """What of a UAV is true to scale."""
    ring = "" if len(drawing.movers) > MOST_NAMED else "; a ring shows where it is"
    drawing.notes.append(f"UAVs are drawn at their size, {uav.diameter:g} m{ring}")
    if safe_distance is not None:
        drawing.legend.append(Entry("ball", f"distance to keep, {safe_distance:g} m", drawing.movers[0].color))


def width_of(drawing: Drawing) -> float:
    """Of a route's tube [m], by the size of the map."""
    return 0.0045 * float(np.linalg.norm((drawing.box[1] - drawing.box[0])[:2]))


def way(drawing: Drawing, name: str, points: np.ndarray, style: Style, *, thickness: float = 1.0) -> None:
    """A polyline as a tube in a line style, from near as thin as the arms of a UAV; and room for it in the frame."""
    reach = np.abs(drawing.near(points)).max()
    if reach > MOST_METRES:
        raise ValueError(
            f"routes and flights must lie within {MOST_METRES / 1000:,.0f} km of the map's centre, in its coordinates, "
            f"got one {reach / 1000:,.4g} km away"
        )
    width = thickness * width_of(drawing)
    thin = min(NEAR_WIDTH, width)
    for part, across, known in ((name, width, drawing.far_only), (f"{name} near", thin, drawing.near_only)):
        pieces = [tube(piece, across / 2) for piece in dashed(thinned(points, 0.1 * across), style.line, width)]
        if sum(map(len, pieces)):
            drawing.parts[part] = Surface(np.concatenate(pieces), style.color, closed=True)
            known.add(part)
    drawing.closeup = CLOSEUP * width_of(drawing)
    show_too(drawing, points)


def draw_routes(drawing: Drawing, routes: Sequence[Route], looks: Sequence[Style], *, thin: bool) -> None:
    """Routes with their starts, and where they arrive, or stop and should have arrived."""
    for number, (route, style) in enumerate(zip(routes, looks, strict=False)):
        words = f"{route.length:.1f} m" if route.reached else f"doesn't arrive, {route.reason}"
        drawing.legend.append(Entry("thin" if thin else "line", f"{route.planner}: {words}", style.color, style))
        if len(route.points):
            way(drawing, f"route{number}", route.points, style, thickness=0.4 if thin else 1.0)
            drawing.markers.append(Marker("start", route.points[0], style.color))
            drawing.markers.append(Marker("goal" if route.reached else "stopped", route.points[-1], style.color))
        missed = route.info.get("goal")
        if not route.reached and missed is not None:
            draw_missed(drawing, missed, style)


def draw_missed(drawing: Drawing, goal: np.ndarray, style: Style) -> None:
    """A sign where a UAV should have arrived, and room for it in the frame."""
    goal = np.asarray(goal, dtype=float)
    drawing.markers.append(Marker("missed", goal, style.color))
    show_too(drawing, goal)


def fly_routes(drawing: Drawing, routes: Sequence[Route], looks: Sequence[Style], **fly: Any) -> None:
    """A UAV on each route, at cruise speed."""
    for route, style in zip(routes, looks, strict=True):
        if route.length > 0:
            time, points = along_route(route, fly["uav"])
            drawing.movers.append(mover(time, points, style, **fly))
            drawing.duration = max(drawing.duration, float(time[-1]))


def draw_flights(drawing: Drawing, named: Mapping[str, Flight], looks: Sequence[Style], **fly: Any) -> None:
    """Tracks of flights and a UAV on each, by one clock; a crash is an X that appears when it happens."""
    many = len(named) > MOST_NAMED
    if many:
        looks = [Style(OUTCOME_COLORS.get(flight.outcome, "#000000"), "-") for flight in named.values()]
        outcomes = [flight.outcome for flight in named.values()]
        for outcome in dict.fromkeys(outcomes):
            style = looks[outcomes.index(outcome)]
            drawing.legend.append(Entry("line", f"{outcome}: {outcomes.count(outcome)} flights", style.color, style))
    else:
        for (name, flight), style in zip(named.items(), looks, strict=True):
            drawing.legend.append(Entry("line", label_of_flight(name, flight), style.color, style))
    flown = [(flight, style) for flight, style in zip(named.values(), looks, strict=True) if len(flight.log)]
    shown = flown[:: -(-len(flown) // MOST_FLIGHTS)] if flown else []
    if len(shown) < len(flown):
        drawing.notes.append(f"{len(shown)} of {len(flown)} flights are drawn")
    for number, (flight, style) in enumerate(shown):
        time, points = along_flight(flight, max(60, MOST_KEYS // max(1, len(shown) // 4)))
        way(drawing, f"flight{number}", points, style, thickness=0.4 if many else 0.8)
        drawing.movers.append(mover(time, points, style, **fly))
        drawing.duration = max(drawing.duration, float(time[-1]))
        drawing.markers.append(Marker("start", points[0], style.color))
        if flight.outcome == "crashed":
            drawing.markers.append(Marker("crash", points[-1], CRASH_COLOR, float(time[-1])))
        else:
            arrived = flight.outcome == "arrived"
            since = 0.0 if arrived else float(time[-1])
            drawing.markers.append(Marker("goal" if arrived else "stopped", points[-1], style.color, since))
        if flight.outcome != "arrived" and flight.goal is not None:
            draw_missed(drawing, flight.goal, style)


def draw_expansion(drawing: Drawing, city: City, order: np.ndarray) -> None:
    """Expanded nodes as points that appear in the order of their expansion, first ones dark, last ones bright."""
    shown = order[:: -(-len(order) // MOST_POINTS)]
    batches = np.array_split(shown, min(EXPANSION_BATCHES, len(shown)))
    for number, nodes in enumerate(batches):
        name = f"expanded{number:02d}"
        color = sequential_color(number / max(len(batches) - 1, 1))
        drawing.parts[name] = Dots(city.center_of(city.index_of(nodes)), color, 0.9 * city.cell)
        drawing.since[name] = number * len(order) / len(batches)
    drawing.order, drawing.duration, drawing.unit = len(order), float(len(order)), "nodes"
    if len(shown) < len(order):
        drawing.notes.append(f"{len(shown):,} of {len(order):,} expanded nodes are drawn")


def signs(drawing: Drawing) -> None:
    """Lines of the legend for the signs that are there."""
    words: dict[MarkerKind, str] = {
        "start": "start", "goal": "goal", "stopped": "stopped", "missed": "goal not reached", "crash": "crash",
    }  # fmt: skip
    drawing.markers = list({(m.kind, *np.round(m.place, 2), m.color, m.since): m for m in drawing.markers}.values())
    there = {marker.kind for marker in drawing.markers}
    for kind, text in words.items():
        if kind in there:
            drawing.legend.append(Entry(kind, text, CRASH_COLOR if kind == "crash" else "#000000"))
