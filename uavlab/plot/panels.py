"""What the kinds of figures share: panels, colours by name, one legend, labelled limits, notes that touch nothing.

A kind makes a figure of its own, or draws on a panel that it is given. What it draws has a name. A name keeps its
colour in all panels of a figure, and stands once in the legend, which lies below the panels and so covers nothing.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D

from uavlab import checks
from uavlab.plot.colors import Style, checked_colors, styles
from uavlab.plot.style import DPI, MOST_INCHES, finished, plain

MOST_PANELS = 40
"""In one figure."""
MOST_NAMES = 7
"""Of one sort in a figure: there are seven colours."""
GREY = "#737373"
"""Of what isn't named: what bands and marks are."""
MARKERS = "o^sDvP*"


def new_panels(
    rows: int, columns: int, *, width: float | None = None, height: float | None = None, share: str = ""
) -> tuple[Figure, list[Axes]]:
    """An empty figure with several panels, for kinds of figures to draw on by their `axes=`.

    Parameters
    ----------
    rows, columns : int
        At least 1 each, at most 40 panels together.
    width, height : float, optional
        Of all of it [inches], above 0, at most 650; by default what panels of 3.8 × 3.2 inches need.
    share : {"", "x", "y", "xy"}
        Axes that are the same in all panels; their labels stand only at the outer panels.

    Returns
    -------
    figure : matplotlib.figure.Figure
        The last line of a cell: it shows itself.
    panels : list of matplotlib.axes.Axes
        Row by row.

    Raises
    ------
    ValueError
        If `rows` or `columns` is no whole number of at least 1, or they are more than 40 panels; `width` or `height`
        is not above 0, or above 650; or `share` is none of those words.

    See Also
    --------
    new_figure : With one panel.
    lines : Draws on a panel.

    Examples
    --------
    >>> import numpy as np
    >>> from uavlab import plot
    >>> figure, panels = plot.new_panels(1, 2, share="y")
    >>> time = np.linspace(0, 10, 101)
    >>> for axes, speed in zip(panels, (1.0, 2.0), strict=True):
    ...     _ = plot.lines(time, {"way": speed * time}, "time [s]", "way [m]", title=f"{speed} m/s", axes=axes)
    >>> [axes.get_ylabel() for axes in figure.axes]
    ['way [m]', '']
    """
    rows, columns = checks.whole("rows", rows, 1, MOST_PANELS), checks.whole("columns", columns, 1, MOST_PANELS)
    if rows * columns > MOST_PANELS:
        raise ValueError(f"rows × columns must be at most {MOST_PANELS} panels, got {rows} × {columns}")
    checks.one_of("share", share, ("", "x", "y", "xy"))
    size = {
        "width": 0.4 + 3.8 * columns if width is None else width,
        "height": 0.5 + 3.2 * rows if height is None else height,
    }
    for name, value in size.items():
        size[name] = checks.positive_number(name, value)
        checks.within(name, size[name], 0.0, MOST_INCHES, "inches")
    figure, panels = plt.subplots(
        rows, columns, figsize=tuple(size.values()), dpi=DPI, layout="constrained", squeeze=False, sharex="x" in share,
        sharey="y" in share,
    )  # fmt: skip
    return finished(figure), list(panels.flat)


def panel(axes: Axes | None, width: float = 7.2, height: float = 4.2) -> Axes:
    """The panel to draw on: the one that was given, or that of a new figure."""
    if axes is None:
        return plt.subplots(figsize=(width, height), dpi=DPI, layout="constrained")[1]
    checks.instance("axes", axes, Axes)
    if figure_of(axes).get_layout_engine() is None:
        figure_of(axes).set_layout_engine("constrained")  # which keeps a place for the legend
    return axes


def figure_of(axes: Axes) -> Figure:
    """The whole figure that a panel belongs to."""
    figure = axes.figure
    return figure.figure if isinstance(figure, SubFigure) else figure


def by_few_names(name: str, values: Any, most: int = MOST_NAMES, *, least: int | None = None) -> dict[str, Any]:
    """Things by name, not more than can be told apart; without `least` it may be None, which is none at all."""
    if values is None and least is None:
        return {}
    named = checks.by_name(name, values, least=least or 0)
    if len(named) > most:
        raise ValueError(f"{name} must be at most {most}, to be told apart, got {len(named)}")
    return named


def finite_or_gaps(name: str, values: npt.ArrayLike, *shape: Any) -> np.ndarray:
    """Floats of a shape: finite, or NaN for a gap."""
    array = checks.array(name, values, *shape, finite=False)
    if np.isinf(array).any():
        raise ValueError(f"{name} must be finite, or NaN for a gap, got an infinite value")
    return array


def rows_of_points(name: str, values: npt.ArrayLike) -> np.ndarray:
    """Points (N, 2) with NaN for gaps; one point may be a pair."""
    array = checks.numbers(name, values)
    return finite_or_gaps(name, array[None] if array.shape == (2,) else array, None, 2)


def styles_on(axes: Axes, names: list[str], colors: Mapping[str, str] | None) -> dict[str, Style]:
    """A style for each name: one that another panel of the figure has drawn keeps its colour."""
    asked = checked_colors(colors)
    before = {label: color for label, color in named_so_far(figure_of(axes)).items() if color != GREY}
    every = list(dict.fromkeys([*before, *map(plain, names)]))
    chosen = styles(every, before | {plain(name): color for name, color in asked.items()})
    found = dict(zip(every, chosen, strict=True))
    return {name: found[plain(name)] for name in names}


def named_so_far(figure: Figure) -> dict[str, str]:
    """Colours by label, as #RRGGBB, of all that a legend of the figure tells."""
    found: dict[str, str] = {}
    for axes in figure.axes:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            drawn: Any = handle  # a line, else an area
            color: Any = drawn.get_color() if isinstance(handle, Line2D) else np.ravel(drawn.get_facecolor())[:3]
            found.setdefault(label, to_hex(color).upper())
    return found


def explain(axes: Axes, label: str, *, marker: str = "", color: str = GREY, alpha: float = 0.4) -> None:
    """An entry of the legend alone: an area, or a mark."""
    if marker:
        axes.plot([], [], marker, color=color, label=plain(label))
    else:
        axes.fill_between([], [], [], color=color, alpha=alpha, linewidth=0, label=plain(label))


def with_legend(axes: Axes) -> Figure:
    """The figure with one legend below all panels, each name once, and labels at the outer panels only."""
    figure = figure_of(axes)
    for legend in list(figure.legends):
        legend.remove()
    entries: dict[str, Any] = {}
    for one in figure.axes:
        for handle, label in zip(*one.get_legend_handles_labels(), strict=True):
            entries.setdefault(label, handle)
    if entries:
        wide = 46 + 4.6 * max(map(len, entries))  # points
        figure.legend(entries.values(), entries, loc="outside lower center", fontsize=8, handlelength=3.2,
                      ncols=int(np.clip(72 * figure.get_figwidth() // wide, 1, len(entries))))  # fmt: skip
    place = axes.get_subplotspec()
    if place is not None:
        if len(axes.get_shared_x_axes().get_siblings(axes)) > 1 and not place.is_last_row():
            axes.set_xlabel("")
        if len(axes.get_shared_y_axes().get_siblings(axes)) > 1 and not place.is_first_col():
            axes.set_ylabel("")
    return finished(figure)
