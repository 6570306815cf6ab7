"""One page for a scene, and its display in a notebook."""

from __future__ import annotations

import base64
import html
from collections.abc import Mapping, Sequence
from typing import Any

from uavlab import checks
from uavlab.city import City
from uavlab.flight import Flight
from uavlab.plot.pictures import png_of
from uavlab.plot.style import DPI, Drawn
from uavlab.risk import RiskMap
from uavlab.scene.camera import Camera
from uavlab.scene.content import drawing_of
from uavlab.scene.legend import words_of
from uavlab.scene.recorder import motion_of, page_of
from uavlab.scene.stills import chase_size, checked_moment, checked_view, picture_of
from uavlab.vehicle import LIGHT_QUADROTOR, UAV
from uavlab.weather import Wind

MOST_PIXELS = 10_000
"""Of a frame's height; no screen has as many."""


class Scene:
    """A page with a scene in it; the last line of a notebook's cell shows it.

    Attributes
    ----------
    page : str
        One self-contained HTML page, 300 to 400 kB for a small city; `uavlab.scene.page` makes it.
    height : int
        Of the frame in the notebook [pixels]; 480 is usual.
    still : bytes
        A PNG picture, for places that can't run scripts.
    words : str
        What the picture shows, for readers who don't see it.

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

    def __init__(self, page: str, height: int, still: bytes, words: str) -> None:
        self.page = page
        self.height = height
        self.still = still
        self.words = words

    def __repr__(self) -> str:
        return f"<Scene: page of {len(self.page) / 1000:.0f} kB, {self.height} pixels high>"

    def _repr_mimebundle_(self, **_: Any) -> tuple[dict[str, Any], dict[str, Any]]:
        frame = (
            f'<div class="uavlab-scene"><iframe srcdoc="{html.escape(self.page)}" title="3D scene" '
            f'allow="fullscreen" style="width:100%;height:{self.height}px;border:0"></iframe></div>'
        )
        data = {"text/html": frame, "image/png": base64.b64encode(self.still).decode(), "text/plain": repr(self)}
        return data, {"image/png": {"alt": self.words}}


def show(
    city: City,
    *routes: Drawn,
    safe_distance: float | None = None,
    expansion: bool = False,
    risk: RiskMap | None = None,
    slice_height: float | None = None,
    flights: Sequence[Flight] | Mapping[str, Flight] = (),
    wind: Wind | None = None,
    uav: UAV = LIGHT_QUADROTOR,
    colors: Mapping[str, str] | None = None,
    camera: Camera = "overview",
    start_paused: bool = False,
    start_at: float = 0.0,
    height: int = 480,
) -> Scene:
    """The scene for a notebook: a page to turn, zoom and play, and beside it a still picture.

    Parameters
    ----------
    city, routes, safe_distance, expansion, risk, slice_height, flights, wind, uav, colors
        As for `page`.
    camera, start_paused, start_at
        As for `page`.
    height : int
        Of the frame [pixels], 1 to 10 000; 400 to 700 is usual.

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
    still : The picture alone.

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
    content, picture, words = made(
        city, routes, camera, start_paused, start_at, safe_distance=safe_distance, expansion=expansion, risk=risk,
        slice_height=slice_height, flights=flights, wind=wind, uav=uav, colors=colors,
    )  # fmt: skip
    return Scene(content, height, picture, words)


def page(
    city: City,
    *routes: Drawn,
    safe_distance: float | None = None,
    expansion: bool = False,
    risk: RiskMap | None = None,
    slice_height: float | None = None,
    flights: Sequence[Flight] | Mapping[str, Flight] = (),
    wind: Wind | None = None,
    uav: UAV = LIGHT_QUADROTOR,
    colors: Mapping[str, str] | None = None,
    camera: Camera = "overview",
    start_paused: bool = False,
    start_at: float = 0.0,
    title: str | None = None,
) -> str:
    """One self-contained HTML page with the city, its routes, and UAVs that fly them, all by the same clock.

    With `flights` the UAVs fly those instead. A bar below the picture plays, pauses and scrubs, and chooses speed and
    camera; so do keys: space, Home, arrows, 1 to 4, + and −, f for the full screen, l for the legend.

    Parameters
    ----------
    city : City
        Drawn from its buildings, roofs included; from its voxels, with their edges, where it knows no buildings. Its
        ground is a surface with a grid on it, no-fly zones are prisms that one can look through.
    routes : Route or Curve, or mapping
        By name if it is a mapping. Drawn as tubes, each with a UAV at cruise speed; one that doesn't arrive ends in a
        square, and where it should have arrived is a hollow triangle.
    safe_distance : float, optional
        Radius of a ball around each UAV [m], above 0: the clearance it should keep.
    expansion : bool
        Show in which order the first route's planner expanded its nodes (`record=True`), as an animation.
    risk : RiskMap, optional
        Paints the ground with the risk in the lowest voxels where the UAV may fly; the legend has a colour bar.
    slice_height : float, optional
        Draws the risk at this height [m] too, as a plane that one can look through.
    flights : sequence of Flight, or mapping
        What `uavlab.flight.fly` returns, by name if it is a mapping. Each track is a tube; a crash is a red X that
        appears when and where it happens, through walls. Routes are drawn thinner then. More than seven have the
        colour of how they ended; of more than 24, some are left out evenly, which the legend says.
    wind : Wind, optional
        Shown as a wind sock and arrows; UAVs lean against its mean.
    uav : UAV
        Its diameter is what is drawn, its cruise speed what routes are flown at.
    colors : mapping of str, optional
        Name → colour, for what should look the same elsewhere, as for `uavlab.plot.styles`.
    camera : {"overview", "above", "side", "chase"} or (azimuth, elevation)
        From where it is seen first. The overview is from the side on which buildings hide least of the routes and
        flights; "chase" follows the first UAV. Two numbers are the direction of the eye: from east to north, and height
        above the horizon [degrees].
    start_paused : bool
        Wait for the reader to press play.
    start_at : float
        Where the animation begins [s of flight, or expanded nodes], at least 0, at most its length.
    title : str, optional
        Of the page; by default the city's name.

    Returns
    -------
    str
        HTML, 300 to 400 kB for a small city; needs no network. Without WebGL it shows a still picture.

    Raises
    ------
    ValueError
        If `city` is no `City`, one of `routes` is neither a route nor a curve, `risk` is no `RiskMap` of this city, or
        `flights` holds anything else than flights; `expansion` or `start_paused` is neither True nor False, or an
        expansion is asked for without a route that recorded its order or together with `flights`; `safe_distance` is
        not above 0; `slice_height` lies outside of the map, or there is no `risk` to slice; `wind` is no `Wind`, `uav`
        no `UAV`, `colors` no colours by name; `camera` is unknown or follows where nothing flies; `start_at` lies
        outside of the animation; or `title` is no text.

    See Also
    --------
    show : The scene in a notebook.
    still : A picture of it, for paper.

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
    return made(
        city, routes, camera, start_paused, start_at, safe_distance=safe_distance, expansion=expansion, risk=risk,
        slice_height=slice_height, flights=flights, wind=wind, uav=uav, colors=colors, title=title,
    )[0]  # fmt: skip


def made(
    city: City, routes: Sequence[Drawn], camera: Camera, start_paused: bool, start_at: float, **asked: Any
) -> tuple[str, bytes, str]:
    """The page, its still, and what it shows in words; `asked` are arguments of `drawing_of`."""
    drawing = drawing_of(city, routes, **asked)
    camera, start_at = checked_view(drawing, camera), checked_moment(drawing, start_at)
    start_paused = checks.flag("start_paused", start_paused)
    size, words = chase_size(asked["uav"], asked["safe_distance"]), words_of(drawing)
    picture = png_of(picture_of(drawing, camera, start_at if start_paused else drawing.duration, size), DPI)
    return page_of(drawing, motion_of(drawing, camera, start_paused, start_at, size), picture, words), picture, words
