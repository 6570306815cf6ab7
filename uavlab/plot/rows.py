"""Values by name, in rows: with their intervals, or as the single runs that they come from."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from uavlab import checks
from uavlab.plot.colors import Style
from uavlab.plot.frames import checked_frame, framed
from uavlab.plot.panels import MARKERS, by_few_names, explain, finite_or_gaps, panel, styles_on
from uavlab.plot.style import plain

MOST_ROWS = 60
"""In a panel."""
ROW_HEIGHT = 0.3
"""Of a series in a row [inches]."""
PAPER = {"facecolor": "white", "edgecolor": "none", "pad": 0.4, "alpha": 0.8}
"""Behind numbers."""
Range = tuple[float | None, float | None]


def intervals(
    values: Mapping[str, Mapping[str, npt.ArrayLike]],
    label: str,
    *,
    level: str = "95 %",
    digits: int | None = None,
    places: Mapping[str, npt.ArrayLike] | None = None,
    log: bool = False,
    x_range: Range | None = None,
    title: str = "",
    colors: Mapping[str, str] | None = None,
    axes: Axes | None = None,
) -> Figure:
    """Named values with their intervals, a row for each name and a colour for each series.

    Parameters
    ----------
    values : mapping of mappings
        Series → row → value, or three numbers (value, low, high); NaN isn't drawn. One to seven series, at most sixty
        rows, in the order in which they come.
    label : str
        Quantity and unit; what the intervals are is added where there are some.
    level : str
        What the intervals are, such as "95 %".
    digits : int, optional
        Writes each value beside its mark, with so many digits after the point, 0 to 9.
    places : mapping of float or pairs, optional
        Upright lines at values, by name; two numbers are a span. The name of a series gives its colour.
    log : bool
        Whether the axis is logarithmic.
    x_range : pair of float, optional
        Ends of the axis, None where it ends by itself.
    title : str
        Above the panel.
    colors : mapping of str, optional
        Name → colour; the other series get one as by `styles`.
    axes : matplotlib.axes.Axes, optional
        A panel to draw on, of `new_panels` or `new_figure`; by default a new figure.

    Returns
    -------
    matplotlib.figure.Figure
        The new one, or that of `axes`.

    Raises
    ------
    ValueError
        If `values` are no numbers by row by series, an interval doesn't hold its value, there are more than seven
        series or sixty rows; `label` or `level` says nothing, `digits` is no whole number from 0 to 9, `log` no bool,
        `places` or `colors` is no mapping, `x_range` no pair from less to more, `title` no text, or `axes` are none of
        matplotlib.

    See Also
    --------
    runs : The single values behind.
    bars : One value for each name.
    crash_rates : Rates of crashes, on a logarithmic scale.

    Examples
    --------
    >>> from uavlab import plot
    >>> lengths = {"A*": {"town": (0.95, 0.93, 0.97), "campus": (0.96, 0.95, 0.97)}, "REPARE": {"town": 0.98}}
    >>> figure = plot.intervals(lengths, "length / length of the potential field's route")
    >>> figure.axes[0].get_xlabel(), [text.get_text() for text in figure.axes[0].get_yticklabels()]
    ("length / length of the potential field's route, with 95 % intervals", ['town', 'campus'])
    """
    table = {
        series: {row: with_interval(f"values[{series!r}][{row!r}]", value) for row, value in by_row.items()}
        for series, by_row in checked_rows(values).items()
    }
    if not checks.text("level", level).strip():
        raise ValueError(f"level must say what the intervals are, as in '95 %', got {level!r}")
    widened = any(np.isfinite(value[1:]).any() for by_row in table.values() for value in by_row.values())
    return drawn_rows(table, label, f", with {level} intervals" if widened else "", draw_interval, digits, places, log,
                      x_range, title, colors, axes)  # fmt: skip


def runs(
    values: Mapping[str, Mapping[str, npt.ArrayLike]],
    label: str,
    *,
    digits: int | None = None,
    places: Mapping[str, npt.ArrayLike] | None = None,
    log: bool = False,
    x_range: Range | None = None,
    title: str = "",
    colors: Mapping[str, str] | None = None,
    axes: Axes | None = None,
) -> Figure:
    """The values of single runs, a row for each name and a colour for each series, with their median.

    Parameters
    ----------
    values : mapping of mappings of arrays
        Series → row → values of its runs (K,), at least one; NaN isn't drawn, as a run that didn't arrive. One to seven
        series, at most sixty rows.
    label : str
        Quantity and unit.
    digits : int, optional
        Writes each median beside its mark, with so many digits after the point, 0 to 9.
    places : mapping of float or pairs, optional
        Upright lines at values, by name; two numbers are a span. The name of a series gives its colour.
    log : bool
        Whether the axis is logarithmic.
    x_range : pair of float, optional
        Ends of the axis, None where it ends by itself.
    title : str
        Above the panel.
    colors : mapping of str, optional
        Name → colour; the other series get one as by `styles`.
    axes : matplotlib.axes.Axes, optional
        A panel to draw on, of `new_panels` or `new_figure`; by default a new figure.

    Returns
    -------
    matplotlib.figure.Figure
        The new one, or that of `axes`.

    Raises
    ------
    ValueError
        If `values` are no numbers by row by series, there are more than seven series or sixty rows; `label` says
        nothing, `digits` is no whole number from 0 to 9, `log` no bool, `places` or `colors` is no mapping, `x_range`
        no pair from less to more, `title` no text, or `axes` are none of matplotlib.

    See Also
    --------
    intervals : Values with intervals.
    uavlab.statistics.over_maps : The interval of a mean over runs and maps.

    Examples
    --------
    >>> from uavlab import plot
    >>> gaps = {"seeds 0 to 4": {"PSO": [31, 28, 40, 25, 33], "PSO-BAS": [22, 19, 27, 24, 20]}}
    >>> figure = plot.runs(gaps, "gap to the exact optimum [%]", digits=0)
    >>> [text.get_text() for text in figure.axes[0].texts]
    ['31', '22']
    """
    table = {
        series: {row: finite_or_gaps(f"values[{series!r}][{row!r}]", np.atleast_1d(checks.numbers(
            f"values[{series!r}][{row!r}]", value)), None) for row, value in by_row.items()}
        for series, by_row in checked_rows(values).items()
    }  # fmt: skip
    return drawn_rows(table, label, "", draw_runs, digits, places, log, x_range, title, colors, axes)


def checked_rows(values: Any) -> dict[str, dict[str, Any]]:
    """Series → row → what stands there."""
    table = by_few_names("values", values, least=1)
    table = {series: checks.by_name(f"values[{series!r}]", by_row) for series, by_row in table.items()}
    count = len({row for by_row in table.values() for row in by_row})
    if count > MOST_ROWS:
        raise ValueError(f"values must have at most {MOST_ROWS} rows, got {count}")
    return table


def with_interval(name: str, value: Any) -> np.ndarray:
    """Value, low and high; NaN for an interval that isn't given."""
    array = finite_or_gaps(name, value, ...)
    if array.shape not in ((), (3,)):
        raise ValueError(f"{name} must be a value, or (value, low, high), got shape {array.shape}")
    middle, low, high = array.tolist() if array.shape else (float(array), np.nan, np.nan)
    if low > middle or high < middle:
        raise ValueError(f"{name} must lie within its interval: {middle:g}, got {low:g} to {high:g}")
    return np.array([middle, low, high])


def drawn_rows(
    table: dict[str, dict[str, np.ndarray]], label: str, added: str, draw: Any, digits: Any, places: Any, log: Any,
    x_range: Any, title: str, colors: Any, axes: Axes | None,
) -> Figure:  # fmt: skip
    """A figure of rows; `draw` draws what stands in one of them at a height, and returns what is written there."""
    logarithmic = "x" if checks.flag("log", log) else ""
    frame = checked_frame(label, "rows", log=logarithmic, x_range=x_range, places=places, title=title, colors=colors,
                          x_name="label")  # fmt: skip
    if digits is not None:
        digits = checks.whole("digits", digits, 0, 9)
    names = list(dict.fromkeys(row for by_row in table.values() for row in by_row))
    axes = panel(axes, 7.2, 1.1 + ROW_HEIGHT * len(names) * max(1.0, 0.7 * len(table)))
    styles = styles_on(axes, list(table), colors)
    for number, ((series, by_row), marker) in enumerate(zip(table.items(), MARKERS, strict=False)):
        axes.plot([], [], marker, color=styles[series].color, label=plain(series))
        for row, values in by_row.items():
            height = names.index(row) + (number - (len(table) - 1) / 2) * 0.7 / len(table)
            end, value = draw(axes, values, height, styles[series], marker)
            if digits is not None and np.isfinite(value):
                axes.annotate(f"{value:.{digits}f}", (end, height), (6, 0), textcoords="offset points", va="center",
                              fontsize=8, color="0.2", bbox=PAPER)  # fmt: skip
    if draw is draw_runs and any(len(values) > 1 for by_row in table.values() for values in by_row.values()):
        explain(axes, "a run (the large mark: their median)", marker="|")
    axes.margins(x=0.12 if digits is not None else 0.05)
    figure = framed(axes, frame._replace(labels=(label + added, "")), styles)
    axes.set_yticks(range(len(names)), [plain(name) for name in names])
    axes.set_ylim(len(names) - 0.5, -0.5)
    axes.grid(visible=False, axis="y")
    return figure


def draw_interval(axes: Axes, values: np.ndarray, height: float, style: Style, marker: str) -> tuple[float, float]:
    """A mark with its interval; returns where that ends, and the value."""
    middle, low, high = values
    axes.plot([low, high], [height, height], "|-", color=style.color, linewidth=1.6, markersize=7)
    axes.plot(middle, height, marker, color=style.color, markersize=6)
    return (high if np.isfinite(high) else middle), middle


def draw_runs(axes: Axes, values: np.ndarray, height: float, style: Style, marker: str) -> tuple[float, float]:
    """A tick for each run and a mark at their median; returns where the last one is, and the median."""
    values = values[np.isfinite(values)]
    if not len(values):
        return np.nan, np.nan
    if len(values) > 1:
        axes.plot(values, np.full(len(values), height), "|", color=style.color, markersize=9, alpha=0.6)
    axes.plot(np.median(values), height, marker, color=style.color, markersize=8, markeredgecolor="white")
    return float(values.max()), float(np.median(values))
