"""Diagrams in a plane with equal scales, and values or areas on the map of a city with paths and points on it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import matplotlib.patheffects
import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap, Normalize, to_rgb
from matplotlib.figure import Figure

from uavlab import checks
from uavlab.city import City
from uavlab.plot.colors import BLACK, SEQUENTIAL, Style
from uavlab.plot.frames import Frame, checked_frame, framed
from uavlab.plot.frames import label as checked_label
from uavlab.plot.panels import by_few_names, explain, figure_of, finite_or_gaps, panel, rows_of_points, styles_on
from uavlab.plot.series import draw_points
from uavlab.plot.style import Area, add_color_bar, area_of, draw_map, map_size, plain, with_gaps

HALO = [matplotlib.patheffects.Stroke(linewidth=4.0, foreground="white"), matplotlib.patheffects.Normal()]
"""About lines on colours."""
Named = Mapping[str, npt.ArrayLike]
Range = tuple[float | None, float | None]


def diagram(
    x_label: str,
    y_label: str,
    *,
    paths: Named | None = None,
    areas: Named | None = None,
    arrows: Named | None = None,
    points: Named | None = None,
    notes: Named | None = None,
    x_range: Range | None = None,
    y_range: Range | None = None,
    title: str = "",
    colors: Mapping[str, str] | None = None,
    axes: Axes | None = None,
) -> Figure:
    """Lines, areas, arrows and points in a plane, with equal scales.

    Parameters
    ----------
    x_label, y_label : str
        Quantity and unit of each axis.
    paths, areas : mapping of arrays (M, 2), optional
        Lines through points (x, y), and outlines that are filled, by name, at most seven; a row of NaN begins another.
    arrows : mapping of arrays (2, 2) or (K, 2, 2), optional
        From where to where, by name, at most seven; one or several.
    points : mapping of arrays (M, 2), optional
        Marks at points (x, y), by name, at most seven.
    notes : mapping of pairs, optional
        Texts with the point (x, y) beside which each stands, where it touches no line.
    x_range, y_range : pair of float, optional
        Ends of an axis, None where it ends by itself.
    title : str
        Above the panel.
    colors : mapping of str, optional
        Name → colour; the others get one as by `styles`. What has the same name has the same colour.
    axes : matplotlib.axes.Axes, optional
        A panel to draw on, of `new_panels` or `new_figure`; by default a new figure.

    Returns
    -------
    matplotlib.figure.Figure
        The new one, or that of `axes`.

    Raises
    ------
    ValueError
        If `x_label` or `y_label` says nothing; one of `paths`, `areas`, `arrows`, `points`, `notes`, `colors` is no
        mapping, has too many names, or something of another shape, or there is nothing to draw in them; `x_range` or
        `y_range` is no pair from less to more, `title` no text, or `axes` are none of matplotlib.

    See Also
    --------
    lines : Quantities over another one.
    area_map : Areas on the map of a city.

    Examples
    --------
    >>> from uavlab import plot
    >>> flown, wind = [(0, 0), (12, 8)], [(12, 8), (9, 0)]
    >>> arrows = {"through the air": flown, "wind": wind, "over ground": [(0, 0), (9, 0)]}
    >>> figure = plot.diagram("east [m/s]", "north [m/s]", arrows=arrows)
    >>> figure.axes[0].get_aspect(), len(figure.legends[0].get_texts())
    (1.0, 3)
    """
    lines, fields = checked_paths("paths", paths), checked_paths("areas", areas)
    darts, marks = checked_arrows(arrows), checked_paths("points", points)
    if not lines | fields | darts | marks:
        raise ValueError("paths, areas, arrows and points are all empty: there is nothing to draw")
    frame = checked_frame(x_label, y_label, notes=notes, title=title, colors=colors, x_range=x_range, y_range=y_range)
    axes = panel(axes, 7.2, 4.6)
    styles = styles_on(axes, list(dict.fromkeys([*lines, *fields, *darts, *marks])), colors)
    for name, outline in fields.items():
        for piece in pieces(outline):
            axes.fill(*piece.T, facecolor=styles[name].color, alpha=0.35, linewidth=0, zorder=1)
        if name not in lines:
            explain(axes, name, color=styles[name].color)
    draw_paths(axes, lines, styles)
    for name, ends in darts.items():
        color, label = styles[name].color, None if name in lines else plain(name)
        for start, end in ends:
            axes.plot(*np.transpose([start, end]), color=color, linewidth=2, label=label)
            head = {"arrowstyle": "-|>", "color": color, "linewidth": 2, "shrinkA": 0, "shrinkB": 0}
            axes.annotate("", end, start + 0.9 * (end - start), arrowprops=head)
            label = None
    draw_points(axes, marks, styles, lines | darts | fields)
    axes.set_aspect("equal")
    return framed(axes, frame, styles)


def value_map(
    city: City,
    values: npt.ArrayLike,
    label: str,
    *,
    paths: Named | None = None,
    points: Named | None = None,
    notes: Named | None = None,
    area: Area | None = None,
    norm: Normalize | None = None,
    title: str = "",
    colors: Mapping[str, str] | None = None,
    axes: Axes | None = None,
) -> Figure:
    """Values of the columns of a city as colours on its map, with paths and points.

    Parameters
    ----------
    city : City
        Whose map it is.
    values : (nx, ny) array
        One for each column; black where it is NaN or masked.
    label : str
        Of the colours, with a unit.
    paths : mapping of arrays (M, 2), optional
        Lines through points (east, north) [m], by name, at most seven, such as `route.points[:, :2]`; a row of NaN
        begins another.
    points : mapping of arrays (M, 2), optional
        Marks at points (east, north) [m], by name, at most seven; the first is a disc, the second a triangle, as start
        and goal elsewhere; points called "start" and "goal" are black unless `colors` says otherwise.
    notes : mapping of pairs, optional
        Texts with the point (east, north) [m] beside which each stands.
    area : (west, east, south, north), optional
        Part of the map to show [m], on the map at least in part; by default all of it.
    norm : matplotlib.colors.Normalize, optional
        From values to colours; by default evenly over the values. Panels that are compared need the same;
        those in one row share a colour bar then.
    title : str
        Above the panel.
    colors : mapping of str, optional
        Name → colour of paths and points; the others get one as by `styles`.
    axes : matplotlib.axes.Axes, optional
        A panel to draw on, of `new_panels` or `new_figure`; by default a new figure.

    Returns
    -------
    matplotlib.figure.Figure
        The new one, or that of `axes`, with a colour bar.

    Raises
    ------
    ValueError
        If `city` is no `City`, `values` hasn't shape (nx, ny) or is infinite, `label` says nothing; one of `paths`,
        `points`, `notes`, `colors` is no mapping, has too many names, or something of another shape; `area` is not four
        numbers, or lies beside the map; `norm` is no `Normalize`, `title` no text, or `axes` are none of matplotlib.

    See Also
    --------
    area_map : What holds where, instead of values.
    section : Values of the voxels at a height, with routes.
    heat_map : Values over other quantities than places.

    Examples
    --------
    >>> from uavlab import plot
    >>> from uavlab.city import table1_city
    >>> city = table1_city()
    >>> figure = plot.value_map(city, city.occupied.sum(axis=2), "occupied voxels", points={"start": (90, 18)})
    >>> figure.legends[0].get_texts()[0].get_text()
    'start'
    """
    checks.instance("city", city, City)
    shown = finite_or_gaps("values", with_gaps(values), *city.shape[:2])
    checked_label("label", label)
    if norm is not None:
        checks.instance("norm", norm, Normalize)
    lines, marks, frame, window = checked_map(city, paths, points, notes, area, title, colors)
    axes = panel(axes, *map_size(window))
    axes.set_facecolor("black")
    image = draw_map(axes, city, shown, SEQUENTIAL, norm=norm)
    add_color_bar(figure_of(axes), axes, image, plain(label))
    return on_map(axes, frame, lines, marks, MAP_COLORS | frame.colors, window)


def area_map(
    city: City,
    areas: Named,
    *,
    paths: Named | None = None,
    points: Named | None = None,
    notes: Named | None = None,
    area: Area | None = None,
    title: str = "",
    colors: Mapping[str, str] | None = None,
    axes: Axes | None = None,
) -> Figure:
    """What holds in which columns of a city, a colour for each name, on its map with paths and points.

    Parameters
    ----------
    city : City
        Whose map it is.
    areas : mapping of arrays (nx, ny)
        Where something holds (bool), by name, one to seven; a later one covers earlier ones. One that is called
        "building" is dark grey unless `colors` says otherwise.
    paths : mapping of arrays (M, 2), optional
        Lines through points (east, north) [m], by name, at most seven; a row of NaN begins another.
    points : mapping of arrays (M, 2), optional
        Marks at points (east, north) [m], by name, at most seven; the first is a disc, the second a triangle, as start
        and goal elsewhere; points called "start" and "goal" are black unless `colors` says otherwise.
    notes : mapping of pairs, optional
        Texts with the point (east, north) [m] beside which each stands.
    area : (west, east, south, north), optional
        Part of the map to show [m], on the map at least in part; by default all of it.
    title : str
        Above the panel.
    colors : mapping of str, optional
        Name → colour; the others get one as by `styles`.
    axes : matplotlib.axes.Axes, optional
        A panel to draw on, of `new_panels` or `new_figure`; by default a new figure.

    Returns
    -------
    matplotlib.figure.Figure
        The new one, or that of `axes`.

    Raises
    ------
    ValueError
        If `city` is no `City`; one of `areas`, `paths`, `points`, `notes`, `colors` is no mapping, has too many names,
        or something of another shape or kind; `area` is not four numbers, or lies beside the map; `title` is no text,
        or `axes` are none of matplotlib.

    See Also
    --------
    value_map : Values instead of names.
    plan : A city with routes.

    Examples
    --------
    >>> from uavlab import plot
    >>> from uavlab.city import table1_city
    >>> city = table1_city()
    >>> near = (city.clearance < 3.5)[:, :, 30]
    >>> figure = plot.area_map(city, {"too near": near, "building": city.occupied[:, :, 30]})
    >>> [text.get_text() for text in figure.legends[0].get_texts()]
    ['too near', 'building']
    """
    checks.instance("city", city, City)
    fields = {name: checked_mask(f"areas[{name!r}]", mask, city.shape[:2])
              for name, mask in by_few_names("areas", areas, least=1).items()}  # fmt: skip
    lines, marks, frame, window = checked_map(city, paths, points, notes, area, title, colors)
    axes = panel(axes, *map_size(window))
    asked = MAP_COLORS | frame.colors
    styles = styles_on(axes, list(dict.fromkeys(["building", *fields, *lines, *marks])), asked)
    for name, field in fields.items():
        color = styles[name].color
        draw_map(axes, city, np.where(field, 0.0, np.nan), ListedColormap([1 - AREA * (1 - np.array(to_rgb(color)))]))
        explain(axes, name, color=color, alpha=AREA)
    return on_map(axes, frame, lines, marks, asked, window)


MAP_COLORS = {"building": BLACK, "start": BLACK, "goal": BLACK}
"""On every map, unless asked otherwise."""
AREA = 0.65
"""Of the colour of a name in an area, the rest white, so that lines and marks stand out."""


def checked_map(
    city: City, paths: Any, points: Any, notes: Any, area: Any, title: str, colors: Any
) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray], Frame, Area]:
    """What both maps have in common, checked."""
    frame = checked_frame("x, east [m]", "y, north [m]", notes=notes, title=title, colors=colors)
    return checked_paths("paths", paths), checked_paths("points", points), frame, area_of(city, area)


def on_map(
    axes: Axes, frame: Frame, lines: dict[str, np.ndarray], marks: dict[str, np.ndarray], colors: Any, window: Area
) -> Figure:
    """Paths and points on a map that is drawn, and its frame."""
    styles = styles_on(axes, list(dict.fromkeys([*lines, *marks])), colors)
    draw_paths(axes, lines, styles, halo=True)
    draw_points(axes, marks, styles, lines)
    figure = framed(axes, frame, styles)
    axes.grid(visible=False)
    axes.set(xlim=window[:2], ylim=window[2:])
    return figure


def checked_paths(name: str, paths: Any) -> dict[str, np.ndarray]:
    """Points (M, 2) by name, with NaN between pieces."""
    return {key: rows_of_points(f"{name}[{key!r}]", xy) for key, xy in by_few_names(name, paths).items()}


def checked_arrows(arrows: Any) -> dict[str, np.ndarray]:
    """Starts and ends (K, 2, 2) by name."""
    found = {}
    for key, ends in by_few_names("arrows", arrows).items():
        array = checks.array(f"arrows[{key!r}]", ends, ..., 2, 2)
        found[key] = array.reshape(-1, 2, 2)
    return found


def checked_mask(name: str, mask: npt.ArrayLike, shape: tuple[int, ...]) -> np.ndarray:
    """Where something holds, as bools of a shape."""
    array = np.asarray(mask)
    if array.dtype != bool or array.shape != shape:
        raise ValueError(f"{name} must be True and False of shape {shape}, got {array.dtype} of shape {array.shape}")
    return array


def pieces(points: np.ndarray) -> list[np.ndarray]:
    """Stretches between rows of NaN."""
    gaps = np.flatnonzero(np.isnan(points).any(axis=1))
    found = np.split(points, gaps)
    return [piece for part in found if len(piece := part[~np.isnan(part).any(axis=1)])]


def draw_paths(axes: Axes, lines: Mapping[str, np.ndarray], styles: Mapping[str, Style], *, halo: bool = False) -> None:
    """Lines by name; with a halo on colours."""
    for name, xy in lines.items():
        axes.plot(*xy.T, color=styles[name].color, linestyle=styles[name].line, linewidth=2, label=plain(name),
                  path_effects=HALO if halo else None)  # fmt: skip
