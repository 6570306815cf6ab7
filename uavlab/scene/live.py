"""Scenes that answer: a reader drags start, goal or wind, and the library's own planners reply, without Python."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import replace
from importlib.resources import files
from typing import Any

import numpy as np
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
from uavlab.scene.drawing import Drawing, Entry
from uavlab.scene.legend import words_of
from uavlab.scene.live_offers import OFFERS, Settings, checked_offers, conditions_told, settings_of, sliders_told
from uavlab.scene.live_panel import panel
from uavlab.scene.live_parts import Bytes, city_told, flights_told, risk_told
from uavlab.scene.pages import MOST_PIXELS, Scene
from uavlab.scene.recorder import Extra, compact, motion_of, page_of
from uavlab.scene.shapes import DASHES
from uavlab.scene.stage import begun, draw_ground, draw_risk, draw_zones
from uavlab.scene.stills import checked_view, picture_of
from uavlab.spline import Curve
from uavlab.spline.curve import BANK, checked_bank
from uavlab.vehicle import LIGHT_QUADROTOR, UAV
from uavlab.web.module import facts_on, wasm_bytes

MOST_FLIGHTS = 1000
"""Of each route, in a page."""

ROOM = 20_000
"""Points of a route in a page."""

MOST_CONTROL = 40
"""Points that a reader can tell apart."""


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
    title: str | None = None,
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
        How often a button flies each route, 0 (there is none) to 1000; 200 is usual. They are the flights of
        `monte_carlo(..., rng=0)`.
    expansions : bool
        Offer to draw the voxels that searches expand.
    uav : UAV
        What flies.
    colors, camera, height
        As for `show`.
    title : str, optional
        Of the page; by default the city's name.

    Returns
    -------
    Scene
        Its `page`, under 600 kB for a small city, can be written to a file and needs no network; there the state is in
        the address, to be shared as a link. Without WebAssembly it shows the routes as they are at first.

    Raises
    ------
    ValueError
        If `city` is no `City` or has over 6 million voxels; `start` or `goal` is what the planners refuse; `planners`,
        `shown`, `settings` or `colors` have unknown names, or values out of range; `risk` is no `RiskMap` of this city;
        `flights` is no whole number from 0 to 1000; `expansions` is neither True nor False; `uav` is no `UAV`; `title`
        is no text; or `camera` or `height` is wrong as for `show`.
    RuntimeError
        If the module of planners was made for another version of the library.

    See Also
    --------
    live_curve : A curve whose control points are dragged.
    show : A scene that plays.

    Examples
    --------
    >>> from uavlab.city import table1_city
    >>> from uavlab.scene import live
    >>> live(table1_city(), (90.5, 18.5, 30.5), (50.5, 44.5, 30.5), planners=["A*", "REPARE"], flights=200)
    <Scene: page of ... kB, 640 pixels high>
    """
    height = checks.whole("height", height, 1, MOST_PIXELS)
    check_things(city, risk, uav, title)
    names = checked_offers("planners", planners, risk)
    first = names if shown is None else checked_offers("shown", shown, risk)
    if not set(first) <= set(names):
        raise ValueError(f"shown: {sorted(set(first) - set(names))} aren't among planners")
    flights, expansions = checks.whole("flights", flights, 0, MOST_FLIGHTS), checks.flag("expansions", expansions)
    now = settings_of(names, flights > 0, settings)
    named = (("start", start), ("goal", goal))
    ends = [city.center_of(city.cell_of(checked_position(city, end, name))) for name, end in named]
    kept = Bytes()
    closed, told = city.in_no_fly, dict[str, Any]()
    if risk is not None:
        told["risk"], blocked = risk_told(risk, kept)
        closed = blocked & ~city.occupied
    told |= city_told(city, closed, kept)
    looks = dict(zip(names, styles(names, colors), strict=True))
    where = city if risk is None else risk
    routes = [replace(OFFERS[name].plan(where, *ends, now), planner=name) for name in names if name in first]
    drawing = drawing_with(city, routes, looks, risk, title)
    given = ["city"] + ["risk"] * (risk is not None) + ["uav"] * (flights > 0 and uav != LIGHT_QUADROTOR)
    if flights:
        told["flights"] = flights_told(flights, uav, kept)
    told |= {
        "ends": [["start", ends[0].tolist()], ["goal", ends[1].tolist()]],
        "offers": [offer_told(name, looks[name], name in first) for name in names], "sliders": sliders_told(now),
        "conditions": conditions_told() if "conditions" in now else [], "expansions": expansions,
        "given": ", ".join(given),
        "words": {"no_way": NO_WAY, "no_risk": NO_SAFE_WAY, "field": REASONS},
    }  # fmt: skip
    said = {route.planner: f"{route.length:.1f} m" if route.reached else route.reason for route in routes}
    return scene_of(drawing, looks, said, now, told, kept, camera, height)


def check_things(city: City, risk: RiskMap | None, uav: UAV, title: str | None) -> None:
    checks.instance("city", city, City)
    checks.instance("uav", uav, UAV)
    if risk is not None:
        checks.instance("risk", risk, RiskMap)
        if risk.city is not city:
            raise ValueError("risk must be a map of this city: give risk.city as the city")
    if title is not None:
        checks.text("title", title)


def live_curve(
    city: City,
    control: npt.ArrayLike,
    *,
    step: float = Curve.step,
    bank: float = BANK,
    colors: Mapping[str, str] | None = None,
    camera: Camera = "overview",
    height: int = 560,
    title: str | None = None,
) -> Scene:
    """A scene with a cubic B-spline whose control points a reader drags.

    Beside it stand its length, its clearance, its tightest bend on the plan with the speed at which a bank holds that,
    and its steepest climb or descent.

    Parameters
    ----------
    city : City
    control : (N, 3) array
        Control points at first [m], on the map, 3 to 40.
    step : float
        As for `uavlab.spline.Curve` [m].
    bank : float
        [rad], between 0 and π/2; 30° is usual.
    colors, camera, height
        As for `show`; the curve's name is "curve".
    title : str, optional
        Of the page; by default the city's name.

    Returns
    -------
    Scene

    Raises
    ------
    ValueError
        If `city` is no `City` or has over 6 million voxels; `control` isn't 3 to 40 points on the map; `step` is not
        above 0 or too short for the page; `bank` is not between 0 and π/2; `colors` are none by name; `title` is no
        text; or `camera` or `height` is wrong as for `show`.
    RuntimeError
        If the module of planners was made for another version of the library.

    See Also
    --------
    live : Planners that answer.
    uavlab.spline.Curve : The curve in Python.

    Examples
    --------
    >>> from uavlab.city import table1_city
    >>> from uavlab.scene import live_curve
    >>> live_curve(table1_city(), [(5, 60, 30), (30, 60, 40), (45, 80, 40), (60, 60, 30)])
    <Scene: page of ... kB, 560 pixels high>
    """
    height = checks.whole("height", height, 1, MOST_PIXELS)
    checks.instance("city", city, City)
    if title is not None:
        checks.text("title", title)
    points = checks.array("control", control, None, 3)
    if not 3 <= len(points) <= MOST_CONTROL or not city.inside(points).all():
        raise ValueError(
            f"control must be 3 to {MOST_CONTROL} points on the map, got {len(points)} of which "
            f"{int(city.inside(points).sum())} lie on it"
        )
    curve = Curve(points, step=step, planner="curve")
    if len(curve.parameter) > ROOM:
        raise ValueError(
            f"step must leave at most {ROOM:,} points, got {step:g} m, which makes {len(curve.parameter):,}"
        )
    bank = checked_bank(bank)
    look = styles(["curve"], colors)[0]
    kept = Bytes()
    told = city_told(city, city.in_no_fly, kept) | {
        "ends": [[f"point {number}", point] for number, point in enumerate(points.tolist())],
        "curve": {"step": curve.step, "bank": bank, "degrees": round(float(np.degrees(bank)), 1)},
        "offers": [{"name": "curve", "shown": True, "color": look.color, "dashes": dashes_of(look)}],
        "sliders": [], "conditions": [], "expansions": False, "words": {},
    }  # fmt: skip
    drawing = drawing_with(city, [curve.route()], {"curve": look}, None, title)
    return scene_of(drawing, {"curve": look}, {"curve": f"{curve.length:.1f} m"}, {}, told, kept, camera, height)


def scene_of(
    drawing: Drawing, looks: Mapping[str, Style], said: Mapping[str, str], now: Settings, told: dict[str, Any],
    kept: Bytes, camera: Camera, height: int,
) -> Scene:  # fmt: skip
    """The scene, of a drawing of how it is at first, and of what its page is told."""
    camera = checked_view(drawing, camera)
    picture, words = png_of(picture_of(drawing, camera, 0.0, 1.0), DPI), words_of(drawing)
    signs_here = [Entry("start", "start", "#000000"), Entry("goal", "goal", "#000000")]
    if any(offer.get("kind") == "field" for offer in told["offers"]):
        signs_here.append(Entry("stopped", "stopped", "#000000"))
    if "flights" in told:
        signs_here.append(Entry("crash", "crash", CRASH_COLOR))
    others = ("line", "start", "goal", "stopped", "missed")
    drawing.legend = signs_here + [entry for entry in drawing.legend if entry.kind not in others]
    told |= {
        "id": hashlib.sha256(compact([drawing.title, told["shape"], told["ends"], list(looks)])).hexdigest()[:8],
        "center": drawing.center.tolist(), "width": width_of(drawing), "room": ROOM, "crash": CRASH_COLOR,
        "arrays": kept.places,
    }  # fmt: skip
    routes = [name for name in drawing.parts if name.startswith("route")]
    player, module = files("uavlab.scene").joinpath("player"), files("uavlab.web").joinpath("planners.js")
    extra = Extra(
        panel(looks, said, now, told),
        player.joinpath("live.css").read_text("utf-8"),
        {"planners": module.read_bytes(), "live": player.joinpath("live.js").read_bytes()},
        {"wasm": wasm_bytes(), "facts": compact(facts_on()), "told": compact(told), "kept": bytes(kept.content)},
        "await beginLive(stage, unpack, read, packed);",
    )
    motion = motion_of(drawing, camera, False, 0.0, 1.0) | {"routes": routes}
    return Scene(page_of(drawing, motion, picture, words, extra), height, picture, words)


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
