"""What all figures share: maps from above, routes on them, labels."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.colors import Colormap
from matplotlib.figure import Figure

from uavlab import checks
from uavlab.city import City
from uavlab.plot.colors import BLACK, styles
from uavlab.plot.pictures import Picture
from uavlab.risk import RiskMap
from uavlab.route import Route, Way, as_route

DPI = 100
Area = tuple[float, float, float, float]
"""Of a map: west, east, south and north end [m]."""
MAP_WIDTH = 6.4
"""Of a figure with a map and its colour bar [inches]."""
MOST_INCHES = 650
"""Along a side of a figure; matplotlib can't save larger ones in this resolution."""


def level_of(city: City, height: float, name: str = "height") -> int:
    """Index of the layer of voxels at a height [m]; `ValueError` if it lies outside of the map."""
    height = checks.number(name, height)
    k = int(city.cell_of((city.origin[0], city.origin[1], height))[2])
    if not 0 <= k < city.shape[2]:
        low, high = city.bounds[:, 2]
        raise ValueError(f"{name} must lie on the map, {low:g} to {high:g} m, got {height:g}")
    return k


def area_of(city: City, area: Area | None) -> Area:
    """West, east, south and north end [m] of what is to be shown, which is all of the map by default."""
    (left, lowest), (right, highest) = city.bounds[:, :2].tolist()
    if area is None:
        return left, right, lowest, highest
    west, east, south, north = checks.array("area", area, 4).tolist()
    if not (west < east and south < north):
        raise ValueError(f"area must be (west, east, south, north), each from less to more, got {area!r:.60}")
    if not (west < right and east > left and south < highest and north > lowest):
        map_words = f"{left:g} to {right:g} m east, {lowest:g} to {highest:g} m north"
        raise ValueError(f"area must lie on the map, {map_words}, got {area!r:.60}")
    return west, east, south, north


def map_size(window: Area) -> tuple[float, float]:
    """Width and height [inches] of a figure with a map of this part, so that a long one leaves no empty frame."""
    west, east, south, north = window
    return MAP_WIDTH, float(np.clip(1.2 + (MAP_WIDTH - 2.2) * (north - south) / (east - west), 3.6, 8.0))


def with_gaps(values: npt.ArrayLike) -> np.ndarray:
    """Values as floats, what is masked as NaN, which isn't drawn."""
    if not isinstance(values, np.ma.MaskedArray):
        return checks.numbers("values", values)
    return np.where(np.ma.getmaskarray(values), np.nan, checks.numbers("values", np.ma.getdata(values)))


Drawn = Route | Way | Mapping[str, Route | Way]
"""What figures and scenes draw: a route or a curve, named by who planned it; or several by name."""


def drawn_routes(city: City, routes: Sequence[Drawn], risk_map: RiskMap | None = None) -> tuple[Route, ...]:
    """Routes to draw, each with its name as its planner; what can't be drawn is refused, such as a list of them."""
    checks.instance("city", city, City)
    if risk_map is not None:
        checks.instance("risk", risk_map, RiskMap)
        if risk_map.city.shape != city.shape or not np.array_equal(risk_map.city.bounds, city.bounds):
            raise ValueError(f"risk must be a map of the same city, got one of {risk_map.city!r}, city is {city!r}")
    return tuple(route for one in routes for route in named_routes(one))


def named_routes(drawn: Drawn, argument: str = "routes") -> list[Route]:
    """A route or several, each with its name as its planner."""
    if not isinstance(drawn, Mapping):
        return [as_route(drawn, argument)]
    return [replace(as_route(way, f"{argument}[{name!r}]"), planner=str(name)) for name, way in drawn.items()]


def new_figure(width: float, height: float) -> tuple[Figure, Axes]:
    """An empty figure with one panel, in the layout and resolution of all figures here.

    Parameters
    ----------
    width, height : float
        [inches], above 0, at most 650; 6.4 and 4 to 5.4 are usual.

    Returns
    -------
    figure : matplotlib.figure.Figure
        To be given to `finished` in the end.
    axes : matplotlib.axes.Axes
        To draw on.

    Raises
    ------
    ValueError
        If `width` or `height` is not above 0, or above 650.

    See Also
    --------
    draw_map : Draws values on the ground plan.
    finished : Closes the figure for pyplot.

    Examples
    --------
    >>> from uavlab import plot
    >>> figure, axes = plot.new_figure(6.4, 4.0)
    >>> plot.finished(figure).get_size_inches().tolist()
    [6.4, 4.0]
    """
    size = checks.positive_number("width", width), checks.positive_number("height", height)
    for name, value in zip(("width", "height"), size, strict=True):
        checks.within(name, value, 0.0, MOST_INCHES, "inches")
    return plt.subplots(figsize=size, dpi=DPI, layout="constrained")


def draw_map(axes: Axes, city: City, values: npt.ArrayLike, colors, **limits):
    """Values on the ground plan, with axes in metres and equal scales.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        To draw on.
    city : City
        Whose columns of voxels the values belong to.
    values : (nx, ny) array
        One for each column, in any unit; where it is NaN or masked, nothing is drawn.
    colors : str or matplotlib.colors.Colormap
        Such as `SEQUENTIAL`.
    limits
        For `matplotlib.axes.Axes.imshow`, such as `vmin`, `vmax` or `norm`.

    Returns
    -------
    matplotlib.image.AxesImage
        For a colour bar.

    Raises
    ------
    ValueError
        If `axes` are no axes of matplotlib, `city` is no `City`, `values` hasn't shape (nx, ny), `colors` is no colour
        map nor the name of one, or `vmin` or `vmax` among the `limits` is not finite.

    See Also
    --------
    new_figure : An empty figure.
    section : A whole figure of values at a height.

    Examples
    --------
    >>> from uavlab import plot
    >>> from uavlab.city import table1_city
    >>> city = table1_city()
    >>> figure, axes = plot.new_figure(6.4, 5.4)
    >>> image = plot.draw_map(axes, city, city.occupied.sum(axis=2), plot.SEQUENTIAL)
    >>> axes.get_xlabel(), axes.get_aspect(), image.get_array().shape
    ('x, east [m]', 1.0, (100, 100))
    """
    checks.instance("axes", axes, Axes)
    checks.instance("city", city, City)
    shown = checks.array("values", with_gaps(values), *city.shape[:2], finite=False)
    named = isinstance(colors, str) and colors in matplotlib.colormaps
    if not (colors is None or named or isinstance(colors, Colormap)):
        raise ValueError(f"colors must be a colour map of matplotlib or the name of one, got {colors!r:.60}")
    for name in ("vmin", "vmax"):
        if limits.get(name) is not None:
            limits[name] = checks.number(name, limits[name], checks.finite)
    (west, south, _), (east, north, _) = city.bounds
    axes.set(xlabel="x, east [m]", ylabel="y, north [m]", aspect="equal")
    return axes.imshow(shown.T, origin="lower", extent=(west, east, south, north), cmap=colors, **limits)


def add_color_bar(figure: Figure, axes: Axes, image, label: str):
    """A colour bar beside a map, as high as the map; panels of one row and norm share that of the last."""
    for other in [one for one in figure.axes if in_one_row(one, axes)]:
        for drawn in [*other.images, *other.collections]:
            bar = drawn.colorbar
            if bar is not None and drawn.norm is image.norm and bar.ax.get_ylabel() == label:
                bar.remove()
    return figure.colorbar(image, cax=axes.inset_axes((1.03, 0.0, 0.04, 1.0)), label=label)


def in_one_row(one: Axes, other: Axes) -> bool:
    """Whether two panels of a figure stand beside each other."""
    first, second = one.get_subplotspec(), other.get_subplotspec()
    return first is not None and second is not None and first.rowspan == second.rowspan and one is not other


SIGNS: dict[str, dict[str, Any]] = {
    "start": {"marker": "o"},
    "goal": {"marker": "^"},
    "stopped": {"marker": "s"},
    "goal not reached": {"marker": "^", "markerfacecolor": "none", "markeredgewidth": 1.8},
}
"""Where routes begin and end, in plans and scenes."""


def draw_routes(
    axes: Axes, routes: Sequence[Route], colors: Mapping[str, str] | None = None, window: Area | None = None
) -> None:
    """Routes from above, each with its start and where it arrives, or stops and should have arrived, if on the map."""
    looks = styles([route.planner for route in routes], colors)
    signs = []
    for route, (color, line) in zip(routes, looks, strict=True):
        axes.plot(*route.points[:, :2].T, color="white", linewidth=3.5)
        axes.plot(*route.points[:, :2].T, color=color, linestyle=line, linewidth=2, label=label_of(route))
        signs += [(name, tuple(place[:2]), color) for name, place in signs_of(route).items() if within(place, window)]
    for number, (name, place, color) in enumerate(signs):
        above = sum(place == other for _, other, _ in signs[number + 1 :])  # the lower one is larger, and shows
        look = {"markeredgecolor": "white"} | SIGNS[name] | {"markersize": 9 + 4 * above, "linestyle": ""}
        if name == "goal not reached":
            look["markeredgecolor"] = color
        axes.plot(*place, color=color, zorder=3, **look)
    for name in SIGNS:
        if any(name == one for one, _, _ in signs):
            axes.plot([], [], linestyle="", color=BLACK, markersize=7, label=name, **SIGNS[name])
    if axes.get_legend_handles_labels()[0]:
        axes.figure.legend(loc="outside lower center", fontsize=8, ncols=2, handlelength=3.5)


def within(place: np.ndarray, window: Area | None) -> bool:
    """Whether a place lies on the part of a map that is shown, which is all of it by default."""
    if window is None:
        return True
    west, east, south, north = window
    return bool(west <= place[0] <= east and south <= place[1] <= north)


def signs_of(route: Route) -> dict[str, np.ndarray]:
    """Where a route begins and ends, (3,) each [m], by name."""
    places = {}
    if len(route.points):
        places = {"start": route.points[0], "goal" if route.reached else "stopped": route.points[-1]}
    if not route.reached and route.info.get("goal") is not None:
        places["goal not reached"] = np.asarray(route.info["goal"], dtype=float)
    return places


def label_of(route: Route) -> str:
    name = plain(route.planner)
    return f"{name}, {route.length:.1f} m" if route.reached else f"{name}: not reached"


def plain(name: str) -> str:
    """A name as matplotlib is to show it: no TeX in it, and no underscore first, which would hide it in legends."""
    return name.replace("$", r"\$").replace("_", "\u200b_", 1 if name.startswith("_") else 0)


def titled(name: str) -> str:
    """A name as it begins a title."""
    return plain(name[:1].upper() + name[1:])


def finished(figure: Figure) -> Figure:
    """The figure, closed for pyplot: a notebook shows it once, where the cell returns it, with a text of what it shows.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        All is drawn on it.

    Returns
    -------
    matplotlib.figure.Figure
        The same one; it can still be saved. In a notebook its picture has the alternative text of `alt_text`.

    Raises
    ------
    ValueError
        If `figure` is none of matplotlib.

    See Also
    --------
    new_figure : Begins a figure.
    alt_text : What it shows, in words.

    Examples
    --------
    >>> from uavlab import plot
    >>> figure, axes = plot.new_figure(6.4, 4.0)
    >>> plot.finished(figure) is figure
    True
    """
    checks.instance("figure", figure, Figure)
    plt.close(figure)
    if type(figure) is Figure:
        figure.__class__ = Picture
    return figure
