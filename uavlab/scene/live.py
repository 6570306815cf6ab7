"""Scenes that answer: a reader drags start, goal or wind, and the library's own planners reply, without Python."""

from __future__ import annotations

import hashlib
import html
from collections.abc import Mapping, Sequence
from dataclasses import replace
from importlib.resources import files
from typing import Any

import numpy.typing as npt

from uavlab import checks
from uavlab.city import City
from uavlab.planners.astar import NO_WAY
from uavlab.planners.least_risk import NO_SAFE_WAY
from uavlab.planners.potential_field import REASONS
from uavlab.planners.question import checked_position
from uavlab.plot.colors import CRASH_COLOR, Style, styles
from uavlab.plot.pictures import png_of
from uavlab.plot.style import DPI
from uavlab.risk import RiskMap
from uavlab.route import Route
from uavlab.scene.camera import Camera
from uavlab.scene.content import draw_routes, signs, width_of
from uavlab.scene.drawing import Drawing
from uavlab.scene.legend import line_of, words_of
from uavlab.scene.live_offers import OFFERS, SLIDERS, Settings, checked_offers, conditions_told, settings_of
from uavlab.scene.live_parts import Bytes, city_told, flights_told, risk_told
from uavlab.scene.pages import MOST_PIXELS, Scene
from uavlab.scene.recorder import Extra, compact, motion_of, page_of
from uavlab.scene.shapes import DASHES
from uavlab.scene.stage import begun, draw_ground, draw_risk, draw_zones
from uavlab.scene.stills import checked_view, picture_of
from uavlab.vehicle import LIGHT_QUADROTOR, UAV
from uavlab.web.module import facts_on, wasm_bytes

MOST_FLIGHTS = 1000
"""Of each route, in a page."""

ROOM = 20_000
"""Points of a route in a page."""


def live(
    city: City,
    start: npt.ArrayLike,
    goal: npt.ArrayLike,
    *,
    planners: Sequence[str] = ("A*",),
    shown: Sequence[str] | None = None,
    settings: Mapping[str, float] | None = None,
    risk: RiskMap | None = None,
    flights: int = 0,
    expansions: bool = False,
    uav: UAV = LIGHT_QUADROTOR,
    colors: Mapping[str, str] | None = None,
    camera: Camera = "overview",
    height: int = 640,
) -> Scene:
    """A scene in which a reader drags start and goal, and the library's planners answer at once, without Python.

    The planners run in the page, as WebAssembly made from the same compiled functions as here. A panel has the planners
    with length, clearance, expanded nodes and time of each; sliders for what they depend on; and the calls that give
    the same routes in Python.

    Parameters
    ----------
    city : City
    start, goal : (3,) arrays
        Where the route begins and ends at first [m]; the centres of their voxels are taken.
    planners : sequence of str
        Which are offered: "A*", "A*, straight estimate", "Dijkstra", "A* in a penalty zone", "Theta*", "hazard A*",
        "REPARE", "potential field"; with a risk map "least risk" and "shortest".
    shown : sequence of str, optional
        Which of them are drawn at first, all by default.
    settings : mapping of str, optional
        Where sliders stand at first: "keep" [m], "omega", "sigma" [m], "reach" [m], "conditions" (the number of a line
        of the list), "wind" [m/s], "towards" [degrees, clockwise from north], "gusts" [m/s].
    risk : RiskMap, optional
        Of the same city: paints the ground, and has planners of its own.
    flights : int
        How often a button flies each route, at most 1000; 200 is usual, 0 leaves it out. They are the flights of
        `monte_carlo(..., rng=0)`.
    expansions : bool
        Offer to draw the voxels that searches expand.
    uav : UAV
        What flies.
    colors, camera, height
        As for `show`.

    Returns
    -------
    Scene
        Without WebAssembly it shows the routes as they are at first.

    Raises
    ------
    ValueError
        If `city` is no `City` or has over 6 million voxels; `start` or `goal` is what the planners refuse; `planners`,
        `shown`, `settings` or `colors` have unknown names, or values out of range; `risk` is no `RiskMap` of this city;
        `flights` is no whole number from 0 to 1000; `expansions` is neither True nor False; `uav` is no `UAV`; or
        `camera` or `height` is wrong as for `show`.
    RuntimeError
        If the module of planners was made for another version of the library.

    See Also
    --------
    live_page : The page alone, to be written to a file.
    show : A scene that plays.

    Examples
    --------
    >>> from uavlab.city import table1_city
    >>> from uavlab.scene import live
    >>> live(table1_city(), (90.5, 18.5, 30.5), (50.5, 44.5, 30.5), planners=["A*", "REPARE"], flights=200)
    <Scene: page of ... kB, 640 pixels high>
    """
    height = checks.whole("height", height, 1, MOST_PIXELS)
    content, picture, words = made_live(
        city, start, goal, planners=planners, shown=shown, settings=settings, risk=risk, flights=flights,
        expansions=expansions, uav=uav, colors=colors, camera=camera, title=None,
    )  # fmt: skip
    return Scene(content, height, picture, words)


def live_page(
    city: City,
    start: npt.ArrayLike,
    goal: npt.ArrayLike,
    *,
    planners: Sequence[str] = ("A*",),
    shown: Sequence[str] | None = None,
    settings: Mapping[str, float] | None = None,
    risk: RiskMap | None = None,
    flights: int = 0,
    expansions: bool = False,
    uav: UAV = LIGHT_QUADROTOR,
    colors: Mapping[str, str] | None = None,
    camera: Camera = "overview",
    title: str | None = None,
) -> str:
    """The page of a live scene. Its state is in its address, so that it can be shared as a link.

    Parameters
    ----------
    city, start, goal, planners, shown, settings, risk, flights, expansions, uav, colors, camera
        As for `live`.
    title : str, optional
        Of the page; by default the city's name.

    Returns
    -------
    str
        HTML, under 600 kB for a small city; needs no network.

    Raises
    ------
    ValueError
        If an argument is wrong as for `live`, or `title` is no text.

    See Also
    --------
    live : The scene in a notebook.

    Examples
    --------
    >>> from uavlab.city import table1_city
    >>> from uavlab.scene import live_page
    >>> len(live_page(table1_city(), (90.5, 18.5, 30.5), (50.5, 44.5, 30.5))) < 600_000
    True
    """
    return made_live(
        city, start, goal, planners=planners, shown=shown, settings=settings, risk=risk, flights=flights,
        expansions=expansions, uav=uav, colors=colors, camera=camera, title=title,
    )[0]  # fmt: skip


def made_live(
    city: City, start: npt.ArrayLike, goal: npt.ArrayLike, *, planners: Sequence[str], shown: Sequence[str] | None,
    settings: Mapping[str, float] | None, risk: RiskMap | None, flights: int, expansions: bool, uav: UAV,
    colors: Mapping[str, str] | None, camera: Camera, title: str | None,
) -> tuple[str, bytes, str]:  # fmt: skip
    """The page, its still, and what it shows in words."""
    checks.instance("city", city, City)
    checks.instance("uav", uav, UAV)
    if risk is not None and checks.instance("risk", risk, RiskMap).city is not city:
        raise ValueError("risk must be a map of this city: give risk.city as the city")
    if title is not None:
        checks.text("title", title)
    names = checked_offers(planners, risk)
    first = names if shown is None else checked_offers(shown, risk)
    if not set(first) <= set(names):
        raise ValueError(f"shown: {sorted(set(first) - set(names))} aren't among planners")
    flights, expansions = checks.whole("flights", flights, 0, MOST_FLIGHTS), checks.flag("expansions", expansions)
    now = settings_of(names, flights > 0, settings)
    named = (("start", start), ("goal", goal))
    ends = [city.center_of(city.cell_of(checked_position(city, end, name))) for name, end in named]
    kept = Bytes()
    closed, told = city.in_no_fly, {}
    if risk is not None:
        told["risk"], blocked = risk_told(risk, kept)
        closed = blocked & ~city.occupied
    told |= city_told(city, closed, kept)
    looks = dict(zip(names, styles(names, colors), strict=True))
    where = city if risk is None else risk
    routes = [replace(OFFERS[name].plan(where, *ends, now), planner=name) for name in names if name in first]
    drawing = drawing_with(city, routes, looks, risk, title)
    camera = checked_view(drawing, camera)
    picture, words = png_of(picture_of(drawing, camera, 0.0, 1.0), DPI), words_of(drawing)
    if flights:
        own = uav != LIGHT_QUADROTOR
        told["flights"] = flights_told(flights, uav, "uav" if own else "LIGHT_QUADROTOR", kept)
    told |= {
        "id": hashlib.sha256(repr((city.name, city.shape, names, now, ends)).encode()).hexdigest()[:8],
        "start": ends[0].tolist(), "goal": ends[1].tolist(), "center": drawing.center.tolist(),
        "offers": [offer_told(name, looks[name], name in first) for name in names],
        "sliders": [
            {"name": name, "value": value, "least": SLIDERS[name].least, "most": SLIDERS[name].most,
             "unit": SLIDERS[name].unit, "plans": SLIDERS[name].plans}
            for name, value in now.items()
        ],
        "conditions": conditions_told() if "conditions" in now else [], "expansions": expansions,
        "width": width_of(drawing), "room": ROOM, "crash": CRASH_COLOR, "arrays": kept.places,
        "words": {"no_way": NO_WAY, "no_risk": NO_SAFE_WAY, "field": REASONS},
    }  # fmt: skip
    drawing.legend = [entry for entry in drawing.legend if entry.kind != "line"]
    motion = motion_of(drawing, camera, False, 0.0, 1.0) | {
        "routes": [name for name in drawing.parts if name.startswith("route")]
    }
    player, module = files("uavlab.scene").joinpath("player"), files("uavlab.web").joinpath("planners.js")
    extra = Extra(
        panel(names, looks, routes, now, told),
        player.joinpath("live.css").read_text("utf-8"),
        {"planners": module.read_bytes(), "live": player.joinpath("live.js").read_bytes()},
        {"wasm": wasm_bytes(), "facts": compact(facts_on()), "told": compact(told), "kept": bytes(kept.content)},
        "await beginLive(stage, unpack, read, packed);",
    )
    return page_of(drawing, motion, picture, words, extra), picture, words


def drawing_with(
    city: City, routes: Sequence[Route], looks: Mapping[str, Style], risk: RiskMap | None, title: str | None
) -> Drawing:
    """The city, and the routes as they are at first; nothing moves."""
    drawing = begun(city, title)
    draw_ground(drawing, city, risk)
    if risk is not None:
        draw_risk(drawing, risk, None)
    draw_routes(drawing, routes, [looks[route.planner] for route in routes], thin=False)
    signs(drawing)
    draw_zones(drawing, city)
    return drawing


def offer_told(name: str, look: Style, shown: bool) -> dict[str, Any]:
    """A planner for the page."""
    offer = OFFERS[name]
    return {
        "name": name, "kind": offer.kind, "shown": shown, "color": look.color, "dashes": dashes_of(look),
        "python": offer.python, "imports": [offer.imports], **offer.more,
    }  # fmt: skip


def dashes_of(look: Style) -> tuple[float, ...]:
    return DASHES[look.line] if isinstance(look.line, str) else look.line[1]


def panel(
    names: Sequence[str], looks: Mapping[str, Style], routes: Sequence[Route], now: Settings, told: dict[str, Any]
) -> str:
    """What stands beside the scene: planners, settings, flights, the calls in Python."""
    first = {route.planner: f"{route.length:.1f} m" if route.reached else route.reason for route in routes}
    rows = "".join(
        f'<li id="offer-{number}"><label><input type="checkbox"{" checked" * (name in first)}>'
        f'<svg viewBox="0 0 18 14" aria-hidden="true" style="color:{looks[name].color}">{line_of(looks[name], 4)}</svg>'
        f'{html.escape(name)}</label><span class="found">{html.escape(first.get(name, ""))}</span>'
        '<span class="flown" role="status"></span></li>'
        for number, name in enumerate(names)
    )
    sliders = "".join(control(name, value, told["conditions"]) for name, value in now.items())
    expanded = '<label class="tick"><input type="checkbox" id="expanded">Show expanded voxels</label>'
    times = told.get("flights", {}).get("total", 0)
    fly = f'<button id="fly">Fly each {times} times</button>' if times else ""
    return (
        f'<section id="live"><ul id="offers">{rows}</ul>'
        '<p id="wrong" role="alert" hidden><span></span> <button id="instead"></button></p>'
        f'{sliders}{expanded * told["expansions"]}<p class="acts">{fly}<button id="link">Copy link</button></p>'
        '<input id="linked" readonly hidden aria-label="Link"><details><summary>As Python</summary>'
        '<pre id="python" tabindex="0"></pre></details>'
        "<p>Drag start and goal over the map, and the arrow above them for their height.</p>"
        '<p id="lifeless" role="alert" hidden></p></section>'
    )


def control(name: str, value: float, conditions: Sequence[Mapping[str, Any]]) -> str:
    """A slider, or a list to choose from."""
    slider = SLIDERS[name]
    if name == "conditions":
        options = "".join(f'<option value="{n}">{one["label"]}</option>' for n, one in enumerate(conditions))
        return f'<label class="set">{slider.label}<select id="set-{name}">{options}</select></label>'
    return (
        f'<label class="set">{slider.label} <output id="is-{name}">{value:g}{slider.unit}</output>'
        f'<input type="range" id="set-{name}" min="{slider.least:g}" max="{slider.most:g}" step="{slider.step:g}" '
        f'value="{value:g}"></label>'
    )
