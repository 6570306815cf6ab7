"""One page for a scene, and its display in a notebook."""

from __future__ import annotations

import base64
import html
import io
from collections.abc import Mapping, Sequence
from typing import Any

import meshcat
import numpy as np
from meshcat.animation import Animation

from uavlab import checks
from uavlab.city import City
from uavlab.flight import Flight
from uavlab.plot.colors import CRASH_COLOR, route_colors, sequential_color
from uavlab.plot.flights import label_of_flight, named_flights
from uavlab.plot.ground import ZONE_COLOR, ground_words, zone_label, zones_at
from uavlab.plot.maps import risk_norm
from uavlab.plot.stills import still
from uavlab.plot.style import Drawn, drawn_routes, level_of
from uavlab.risk import RiskMap
from uavlab.route import Route
from uavlab.scene.animation import FLIGHT_SECONDS, FRAMES_PER_SECOND, animate_expansion, animate_flight, animate_route
from uavlab.scene.recorder import CommandRecorder
from uavlab.scene.shapes import draw_route
from uavlab.scene.stage import draw_city, draw_risk, draw_zones, grid_spacing, set_stage

MOST_PIXELS = 10_000
"""Of a frame's height; no screen has as many."""


class Scene:
    """A page with a scene in it; the last line of a notebook's cell shows it.

    Attributes
    ----------
    page : str
        One self-contained HTML page, about 300 kB; `uavlab.scene.page` makes it.
    height : int
        Of the frame in the notebook [pixels]; 480 is usual.
    still : bytes
        A PNG picture, for places that can't run scripts.

    See Also
    --------
    show : Makes one.
    page : The page alone, to be written to a file.

    Examples
    --------
    >>> from uavlab.city import table1_city
    >>> from uavlab.scene import show
    >>> scene = show(table1_city(), height=600)
    >>> scene
    <Scene: page of ... kB, 600 pixels high>
    >>> scene.still[1:4]
    b'PNG'
    """

    def __init__(self, page: str, height: int, still: bytes) -> None:
        self.page = page
        self.height = height
        self.still = still

    def __repr__(self) -> str:
        return f"<Scene: page of {len(self.page) / 1000:.0f} kB, {self.height} pixels high>"

    def _repr_mimebundle_(self, **_: Any) -> dict[str, Any]:
        frame = (
            f'<div class="uavlab-scene"><iframe srcdoc="{html.escape(self.page)}" title="3D scene" '
            f'style="width:100%;height:{self.height}px;border:0"></iframe></div>'
        )
        return {"text/html": frame, "image/png": base64.b64encode(self.still).decode(), "text/plain": repr(self)}


def show(
    city: City,
    *routes: Drawn,
    safe_distance: float | None = None,
    expansion: bool = False,
    risk: RiskMap | None = None,
    slice_height: float | None = None,
    flights: Sequence[Flight] | Mapping[str, Flight] = (),
    height: int = 480,
) -> Scene:
    """The scene for a notebook: a page to turn and zoom, and beside it a still picture.

    Parameters
    ----------
    city, routes, safe_distance, expansion, risk, slice_height, flights
        As for `page`.
    height : int
        Of the frame [pixels], 1 to 10 000; 300 to 700 is usual.

    Returns
    -------
    Scene
        Shown where it is the last line of a notebook's cell.

    Raises
    ------
    ValueError
        If `height` is no whole number from 1 to 10 000, or another argument is wrong as for `page`.

    See Also
    --------
    page : The page alone, to be written to a file.
    uavlab.plot.still : The picture alone.

    Examples
    --------
    >>> from uavlab.city import table1_city
    >>> from uavlab.planners import astar
    >>> from uavlab.scene import show
    >>> city = table1_city()
    >>> show(city, astar(city, (90, 18, 30), (50, 44, 30), min_clearance=3.0), safe_distance=3.0)
    <Scene: page of ... kB, 480 pixels high>
    """
    height = checks.whole("height", height, 1, MOST_PIXELS)
    content = page(
        city,
        *routes,
        safe_distance=safe_distance,
        expansion=expansion,
        risk=risk,
        slice_height=slice_height,
        flights=flights,
    )
    picture = io.BytesIO()
    still(city, *routes, risk=risk, flights=flights).savefig(picture, format="png", dpi=72)
    return Scene(content, height, picture.getvalue())


def page(
    city: City,
    *routes: Drawn,
    safe_distance: float | None = None,
    expansion: bool = False,
    risk: RiskMap | None = None,
    slice_height: float | None = None,
    flights: Sequence[Flight] | Mapping[str, Flight] = (),
    title: str | None = None,
) -> str:
    """One self-contained HTML page with the city, its routes, and a UAV that flies the first of them.

    With `flights` the UAVs fly those instead, all by the same clock.

    Parameters
    ----------
    city : City
        Drawn from its buildings, roofs included; from its voxels where it knows no buildings. Its ground is a surface
        with a grid on it, no-fly zones are prisms that one can look through.
    routes : Route or Curve, or mapping
        By name if it is a mapping. Drawn as tubes, each in a colour of its own; routes that didn't arrive are named in
        the legend.
    safe_distance : float, optional
        Radius of a ball around each UAV [m], above 0: the clearance it should keep.
    expansion : bool
        Show in which order the first route's planner expanded its nodes (`record=True`), as an animation.
    risk : RiskMap, optional
        Paints the ground with the risk in the lowest voxels where the UAV may fly; the legend has a colour bar.
    slice_height : float, optional
        Draws the risk at this height [m] too, as a plane that one can look through.
    flights : sequence of Flight, or mapping
        What `uavlab.flight.fly` returns, by name if it is a mapping. Each track is a tube in a colour of its own; a
        crash is a red X that appears when and where it happens. Routes are drawn thinner then.
    title : str, optional
        Of the page; by default the city's name.

    Returns
    -------
    str
        HTML, about 300 kB; needs no network.

    Raises
    ------
    ValueError
        If `city` is no `City`, one of `routes` is neither a route nor a curve, `risk` is no `RiskMap` of this city, or
        `flights` holds anything else than flights; `expansion` is neither True nor False, or is asked for without a
        route that recorded its order or together with `flights`; `safe_distance` is not above 0; `slice_height` lies
        outside of the map, or there is no `risk` to slice; or `title` is no text.

    See Also
    --------
    show : The scene in a notebook.
    uavlab.plot.still : A picture of it, for paper.

    Examples
    --------
    >>> from uavlab.city import table1_city
    >>> from uavlab.planners import astar
    >>> from uavlab.scene import page
    >>> city = table1_city()
    >>> html = page(city, astar(city, (90, 18, 30), (50, 44, 30)), title="A* in Table 1")
    >>> "<title>A* in Table 1</title>" in html, "A*: 66.4 m" in html, len(html) < 400_000
    (True, True, True)
    """
    planned = drawn_routes(city, routes, risk)
    if slice_height is not None and risk is None:
        raise ValueError("slice_height needs risk=..., the map to cut")
    if slice_height is not None:
        slice_height = checks.number("slice_height", slice_height)
        level_of(city, slice_height, "slice_height")
    if safe_distance is not None:
        safe_distance = checks.positive_number("safe_distance", safe_distance)
    if title is not None:
        checks.text("title", title)
    if checks.flag("expansion", expansion) and not (planned and "order" in planned[0].info):
        raise ValueError("expansion needs a first route planned with record=True")
    named = named_flights(flights)
    if expansion and named:
        raise ValueError("expansion and flights are two animations: show them in two scenes")
    window = CommandRecorder()
    scene = meshcat.Visualizer(window=window)
    set_stage(scene, city, painted=risk is not None)
    draw_city(scene["city"], city)
    if city.no_fly:
        draw_zones(scene["no_fly"], city)
    if risk is not None:
        draw_risk(scene["risk"], risk, slice_height)
    animation = Animation(default_framerate=FRAMES_PER_SECOND)
    colors = route_colors(len(planned) + len(named))
    for number, (route, color) in enumerate(zip(planned, colors, strict=False)):
        if len(route.points) > 1:
            draw_route(scene[f"route{number}"], city, route, color, thin=bool(named))
    flown = {name: flight for name, flight in named.items() if len(flight.log) > 1}
    longest = max((flight.duration for flight in flown.values()), default=0.0)
    for number, (name, color) in enumerate(zip(named, colors[len(planned) :], strict=True)):
        if name in flown:
            animate_flight(scene[f"flight{number}"], city, flown[name], color, longest, safe_distance, animation)
    if expansion:
        animate_expansion(scene["expansion"], city, planned[0].info["order"], animation)
    elif not named and planned and len(planned[0].points) > 1:
        animate_route(scene["uav"], city, planned[0], safe_distance, animation)
    if animation.clips:
        scene.set_animation(animation, repetitions=1000)
    return window.page(title or city.name, legend(city, planned, named, risk))


def legend(city: City, routes: tuple[Route, ...], flights: Mapping[str, Flight], risk: RiskMap | None = None) -> str:
    """What the colours mean and how large things are, as HTML."""
    colors = route_colors(len(routes) + len(flights))
    about = [f"<b>{html.escape(city.name)}</b>", f"squares of {grid_spacing(city):g} m", "x → east, y → north, z → up"]
    lines = [" · ".join(filter(None, [*about, ground_words(city)]))]
    texts = [
        f"{route.planner}: {route.length:.1f} m" if route.reached else f"{route.planner}: {route.reason}"
        for route in routes
    ]
    texts += [label_of_flight(name, flight) for name, flight in flights.items()]
    for text, color in zip(texts, colors, strict=True):
        lines.append(f'<span style="color:{color}">&#9608;&#9608;</span> {html.escape(text)}')
    zones = zones_at(city)
    if zones:
        lines.append(f'<span style="color:{ZONE_COLOR}">&#9618;&#9618;</span> {html.escape(zone_label(zones))}')
    marks = []
    if any(len(route.points) > 1 for route in routes) or any(len(flight.log) > 1 for flight in flights.values()):
        marks += ["&#9679; start", "&#9650; goal"]
    if any(flight.outcome == "crashed" for flight in flights.values()):
        marks.append(f'<b style="color:{CRASH_COLOR}">&#10006;</b> crash')
    if flights:
        longest = max(flight.duration for flight in flights.values())
        marks.append(f"{FLIGHT_SECONDS:g} s show {longest:.1f} s of flight")
    if marks:
        lines.append(" &nbsp; ".join(marks))
    if risk is not None:
        norm = risk_norm(risk)
        stops = ",".join(sequential_color(share) for share in np.linspace(0, 1, 9))
        style = f"display:inline-block;width:9em;height:.8em;background:linear-gradient(90deg,{stops})"
        bar = f'<span style="{style}"></span>'
        lines.append(f"{norm.vmin:.1e} {bar} {norm.vmax:.1e} deaths per hour of flight (logarithmic scale)")
    return "<br>".join(lines)
