"""A scene as a picture: the same drawing from the same camera, with its legend."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from typing import Any

import matplotlib.patheffects
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from uavlab import checks
from uavlab.city import City
from uavlab.flight import Flight
from uavlab.plot.colors import SEQUENTIAL
from uavlab.plot.maps import RISK_LABEL
from uavlab.plot.style import DPI, Drawn, finished, plain, titled
from uavlab.risk import RiskMap
from uavlab.scene.camera import FIELD_OF_VIEW_DEG, Camera, View, chasing, checked_camera, fitted
from uavlab.scene.content import MOST_NAMED, drawing_of
from uavlab.scene.drawing import Drawing, Entry
from uavlab.scene.raster import FINER, Frame
from uavlab.vehicle import LIGHT_QUADROTOR, UAV
from uavlab.weather import Wind

HALO = [matplotlib.patheffects.withStroke(linewidth=2.5, foreground="white")]
"""About letters on the picture."""
WIDTH, HEIGHT = 7.2, 4.8
"""Of the picture alone [inches]."""
SIGNS: dict[str, dict[str, Any]] = {
    "start": {"marker": "o"}, "goal": {"marker": "^"}, "stopped": {"marker": "s"},
    "missed": {"marker": "^", "markerfacecolor": "none"}, "crash": {"marker": "x", "markeredgewidth": 3.0},
}  # fmt: skip
SHORT, LONGEST = 46, 95
"""Letters of a legend's line: two columns of short ones fit below the picture; longer ones go on in the next line."""
SMALLEST = 12
"""A UAV that is drawn with fewer pixels has a ring around it."""


def still(
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
    start_at: float | None = None,
) -> Figure:
    """The scene as a picture, for paper: what `page` draws, from the same camera, with the legend below it.

    Parameters
    ----------
    city, routes, safe_distance, expansion, risk, slice_height, flights, wind, uav, colors, camera
        As for `page`.
    start_at : float, optional
        Moment that is shown [s of flight, or expanded nodes], at least 0; by default the end.

    Returns
    -------
    matplotlib.figure.Figure
        One panel without axes.

    Raises
    ------
    ValueError
        If `start_at` lies outside of the animation, or another argument is wrong as for `page`.

    See Also
    --------
    show : The scene to turn and fly through.
    uavlab.plot.plan : The same from above.

    Examples
    --------
    >>> from uavlab.city import table1_city
    >>> from uavlab.planners import astar
    >>> from uavlab.scene import still
    >>> city = table1_city()
    >>> figure = still(city, astar(city, (90, 18, 30), (50, 44, 30)), camera=(-120.0, 30.0))
    >>> [text.get_text() for text in figure.legends[0].get_texts()]
    ['A*: 66.4 m', 'start', 'goal']
    """
    drawing = drawing_of(
        city, routes, safe_distance=safe_distance, expansion=expansion, risk=risk, slice_height=slice_height,
        flights=flights, wind=wind, uav=uav, colors=colors,
    )  # fmt: skip
    camera = checked_view(drawing, camera)
    moment = drawing.duration if start_at is None else checked_moment(drawing, start_at)
    return picture_of(drawing, camera, moment, chase_size(uav, safe_distance))


def checked_view(drawing: Drawing, camera: Camera) -> Camera:
    """A camera that has something to follow, if it follows."""
    camera = checked_camera(camera)
    if camera == "chase" and not drawing.movers:
        raise ValueError("camera='chase' follows a UAV: give a route or a flight")
    return camera


def checked_moment(drawing: Drawing, start_at: float) -> float:
    """A moment of the animation."""
    moment = checks.not_negative_number("start_at", start_at)
    if moment > drawing.duration:
        unit = "s" if drawing.unit == "s" else "expanded nodes"
        raise ValueError(
            f"start_at must be at most {drawing.duration:g} {unit}, the animation's length, got {moment:g}"
        )
    return moment


def chase_size(uav: UAV, safe_distance: float | None) -> float:
    """What the camera that follows a UAV has in view [m]."""
    return max(2 * uav.diameter, 0.6 * (safe_distance or 0.0))


def view_of(drawing: Drawing, camera: Camera, moment: float, size: float, aspect: float) -> View:
    """From where a drawing is seen at a moment, in coordinates about its centre."""
    if camera == "chase":
        place, turn = drawing.movers[0].at(moment)
        x, y, z, w = turn
        nose = np.array([1 - 2 * (y * y + z * z), 2 * (x * y + z * w)])
        return chasing(drawing.near(place), nose, size)
    direction = drawing.cameras[camera] if isinstance(camera, str) else camera
    return fitted(drawing.outline(), *direction, aspect)


def picture_of(drawing: Drawing, camera: Camera, moment: float, size: float) -> Figure:
    """The picture with its legend below, and the scale of its colours."""
    view = view_of(drawing, camera, moment, size, WIDTH / HEIGHT)
    frame = Frame(view, round(WIDTH * DPI), round(HEIGHT * DPI))
    frame.draw(drawing.shown(moment, frame.distance), drawing.center)
    figure, axes = plt.subplots(figsize=(WIDTH, HEIGHT + legend_height(drawing)), dpi=DPI, layout="constrained")
    axes.imshow(frame.picture(), interpolation="none")
    axes.set_axis_off()
    axes.autoscale(False)
    axes.set_title(titled(drawing.title), fontsize=11)
    draw_signs(axes, frame, drawing, moment)
    draw_compass(axes, frame, view, drawing)
    scale: Normalize | None = None
    if drawing.risk is not None:
        scale, label = drawing.risk, f"{RISK_LABEL}, logarithmic scale"
    elif drawing.order:
        scale, label = Normalize(0, drawing.order), "order in which nodes were expanded"
    if scale is not None:
        bar = figure.colorbar(ScalarMappable(scale, SEQUENTIAL), ax=axes, location="bottom", shrink=0.6, aspect=40)
        bar.set_label(label, fontsize=8)
        bar.ax.tick_params(labelsize=8)
    handles = [handle_of(entry) for entry in drawing.legend]
    if handles:
        figure.legend(handles=handles, loc="outside lower center", ncols=columns_of(drawing), fontsize=8,
                      handlelength=4.0)  # fmt: skip
    return finished(figure)


def legend_height(drawing: Drawing) -> float:
    """Room for the legend and a scale [inches]."""
    lines = sum(1 + label_of(entry).count("\n") for entry in drawing.legend)
    return 0.3 + 0.19 * -(-lines // columns_of(drawing)) + 0.55 * bool(drawing.risk is not None or drawing.order)


def columns_of(drawing: Drawing) -> int:
    """Of the legend: two, if all its lines are short."""
    return 2 if all(len(entry.text) <= SHORT for entry in drawing.legend) else 1


def label_of(entry: Entry) -> str:
    """The words of a line of the legend, as matplotlib has them."""
    return plain(textwrap.fill(entry.text, LONGEST))


def draw_signs(axes: Axes, frame: Frame, drawing: Drawing, moment: float) -> None:
    """Starts, goals and crashes, and a ring around each UAV that is too small to be seen."""
    style: dict[str, Any] = {"linestyle": "", "markersize": 8, "zorder": 4}
    for marker in drawing.markers:
        if marker.since <= moment:
            place = frame.places(drawing.near(marker.place)[None])
            look = style | SIGNS[marker.kind]
            if marker.kind in ("crash", "missed"):
                wide = {"color": "white", "markeredgewidth": look.get("markeredgewidth", 1.5) + 2.0}
                axes.plot(*place.T, **(look | wide))
                axes.plot(*place.T, **look, color=marker.color)
            else:
                axes.plot(*place.T, **look, color=marker.color, markeredgecolor="white")
    for mover in drawing.movers if len(drawing.movers) <= MOST_NAMED else ():
        place = drawing.near(mover.at(moment)[0])
        pixels = frame.focus * np.ptp(mover.body.triangles[..., 0]) * frame.projected(place)[2] / FINER
        if 0 < pixels < SMALLEST:
            ring = frame.places(place[None])
            for color, width in (("white", 4.0), (mover.color, 2.0)):
                axes.plot(*ring.T, "o", markersize=13, markerfacecolor="none", markeredgecolor=color,
                          markeredgewidth=width, zorder=3)  # fmt: skip


def draw_compass(axes: Axes, frame: Frame, view: View, drawing: Drawing) -> None:
    """An arrow to the north as it lies in the picture, and the length of a round number of metres at the target."""
    right, up, _ = frame.axes
    foot = np.array([38.0, HEIGHT * DPI - 38.0])

    def arrow(direction: np.ndarray, color: str, width: float, text: str) -> None:
        along = np.array([direction @ right, -(direction @ up)])
        along = along / max(float(np.linalg.norm(direction)), 1e-9)
        tail, tip, (x, y) = foot - 24 * along, foot + 24 * along, foot + 33 * along
        look = {"arrowstyle": "-|>", "color": color, "linewidth": width}
        axes.annotate("", (tip[0], tip[1]), (tail[0], tail[1]), arrowprops=look)
        axes.text(x, y, text, ha="center", va="center", fontsize=8, color=color, weight="bold", path_effects=HALO)

    arrow(np.array([0.0, 1.0, 0.0]), "#222222", 1.5, "N")
    if drawing.wind.any():
        arrow(np.array([*drawing.wind, 0.0]), "#3B6E8F", 2.5, "")
    metre = HEIGHT * DPI / (2 * np.tan(np.radians(FIELD_OF_VIEW_DEG) / 2) * frame.distance)
    most = 150 / metre
    power = 10.0 ** np.floor(np.log10(most))
    length = power * max(step for step in (1, 2, 5) if step * power <= most)
    left, low = 80.0, HEIGHT * DPI - 18.0
    line = np.array([(left, low - 8), (left, low), (left + length * metre, low), (left + length * metre, low - 8)])
    axes.plot(*line.T, color="white", linewidth=4, zorder=2)
    axes.plot(*line.T, color="#222222", linewidth=1.5, zorder=2)
    axes.text(left + length * metre / 2, low - 4, f"{length:g} m", ha="center", va="bottom", fontsize=8,
              path_effects=HALO)  # fmt: skip


def handle_of(entry: Entry) -> Line2D | Patch:
    """A line of the legend as matplotlib has it."""
    label = label_of(entry)
    if entry.kind in SIGNS:
        return Line2D([], [], linestyle="", markersize=8, color=entry.color, label=label, **SIGNS[entry.kind])
    if entry.kind in ("patch", "ball"):
        return Patch(facecolor=entry.color, alpha=0.35, edgecolor=entry.color, label=label)
    line: Any = entry.style.line if entry.style else "-"
    return Line2D([], [], color=entry.color, linestyle=line, linewidth=1.5 if entry.kind == "thin" else 3, label=label)
