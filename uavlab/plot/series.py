"""Lines over a quantity, and points of two: the kinds of figures that most chapters need.

Both take named data, the labels of both axes with their units, and limits by name. Lines that lie on each other are
told apart: the lower one is wider, and the upper one dashed.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from uavlab import checks
from uavlab.plot.colors import LineStyle, Style
from uavlab.plot.frames import Frame, checked_frame, framed
from uavlab.plot.panels import (
    MARKERS,
    by_few_names,
    explain,
    finite_or_gaps,
    panel,
    rows_of_points,
    styles_on,
)
from uavlab.plot.style import plain

WIDTH, ROUGH_WIDTH, WIDER = 1.6, 0.9, 2.4
"""Of a line and of one that is noise [points], and how much wider than the line on it is one that lies below."""
TOGETHER, OFTEN = 0.01, 0.2
"""Lines lie on each other that are within this share of the axis, on more than that share of their length."""
CLOUD = 100
"""From so many points on they are drawn small and pale, below the lines."""
Numbers = Mapping[str, npt.ArrayLike]
Range = tuple[float | None, float | None]


def lines(
    x: npt.ArrayLike,
    series: Numbers,
    x_label: str,
    y_label: str,
    *,
    points: Numbers | None = None,
    point_label: str = "",
    bands: Mapping[str, Sequence[npt.ArrayLike]] | None = None,
    band_label: str = "",
    limits: Numbers | None = None,
    places: Numbers | None = None,
    notes: Numbers | None = None,
    log: str = "",
    steps: bool = False,
    x_range: Range | None = None,
    y_range: Range | None = None,
    title: str = "",
    colors: Mapping[str, str] | None = None,
    axes: Axes | None = None,
) -> Figure:
    """Named quantities over another one, with limits, bands and points.

    Parameters
    ----------
    x : (N,) array
        Where the values are, finite, at least one.
    series : mapping of arrays (N,)
        Values by name, at most seven; NaN is a gap. A line may lie on an earlier one: that is drawn wider then.
    x_label, y_label : str
        Quantity and unit of each axis; ", logarithmic" is added where it is.
    points : mapping of arrays (M, 2), optional
        Marks (x, y) by name, at most seven names; NaN isn't drawn. Under the name of a series they have its colour.
    point_label : str
        What the points are that have the name of a series, such as "flown"; to be given if there are some.
    bands : mapping of pairs, optional
        Lower and upper ends, each (N,) or a number, by name. Under the name of a series they have its colour.
    band_label : str
        What the bands are that have the name of a series, such as "95 %"; to be given if there are some.
    limits, places : mapping of float or pairs, optional
        Lines across the panel at values of y, and upright ones at values of x, by name; two numbers are a span.
    notes : mapping of pairs, optional
        Texts with the point (x, y) beside which each stands, where it touches no line.
    log : {"", "x", "y", "xy"}
        Logarithmic axes; there what isn't above 0 is a gap.
    steps : bool
        Whether a value holds from halfway to the one before to halfway to the next, as that of an hour.
    x_range, y_range : pair of float, optional
        Ends of an axis, None where it ends by itself. Where all values are positive, y begins at 0 unless they are far
        from it.
    title : str
        Above the panel.
    colors : mapping of str, optional
        Name → colour, also of limits; the others get one as by `styles`.
    axes : matplotlib.axes.Axes, optional
        A panel to draw on, of `new_panels` or `new_figure`; by default a new figure. Names keep their colours in all
        panels of a figure and stand in one legend.

    Returns
    -------
    matplotlib.figure.Figure
        The new one, or that of `axes`.

    Raises
    ------
    ValueError
        If `x` is no finite array (N,); `series` or `bands` haven't its length; one of `series`, `points`, `bands`,
        `limits`, `places`, `notes`, `colors` is no mapping or has too many names; `x_label` or `y_label` says nothing;
        `point_label` or `band_label` is missing; `log` is none of those words, `steps` no bool, `x_range` or `y_range`
        no pair from less to more, `title` no text, or `axes` are none of matplotlib.

    See Also
    --------
    points : Points alone.
    new_panels : Several panels in a figure.
    diagram : Lines in a plane with equal scales.

    Examples
    --------
    >>> import numpy as np
    >>> from uavlab import plot
    >>> wind = np.linspace(0, 12, 121)
    >>> offsets = {"1 kg": 0.02 * wind**2, "2 kg": 0.03 * wind**2}
    >>> figure = plot.lines(wind, offsets, "wind [m/s]", "offset σ [m]", limits={"room": 2.5})
    >>> [text.get_text() for text in figure.legends[0].get_texts()], figure.axes[0].texts[0].get_text()
    (['1 kg', '2 kg'], 'room')
    """
    x = checks.array("x", x, None)
    if not len(x):
        raise ValueError("x must hold at least one value, got none")
    drawn = {
        name: finite_or_gaps(f"series[{name!r}]", y, len(x))
        for name, y in by_few_names("series", series, least=0).items()
    }
    marks = {name: rows_of_points(f"points[{name!r}]", xy) for name, xy in by_few_names("points", points).items()}
    ranges = {name: band_ends(name, pair, len(x)) for name, pair in by_few_names("bands", bands).items()}
    said_of("point_label", point_label, "points", drawn.keys() & marks.keys())
    said_of("band_label", band_label, "bands", drawn.keys() & ranges.keys())
    frame = checked_frame(x_label, y_label, log=log, x_range=x_range, y_range=y_range, limits=limits, places=places,
                          notes=notes, title=title, colors=colors)  # fmt: skip
    form = "steps-mid" if checks.flag("steps", steps) else "default"
    axes = panel(axes)
    styles = styles_on(axes, list(dict.fromkeys([*drawn, *ranges, *marks])), colors)
    for name, (low, high) in ranges.items():
        axes.fill_between(x, low, high, color=styles[name].color, alpha=0.22, linewidth=0, zorder=1,
                          step="mid" if steps else None, label=None if name in drawn else plain(name))  # fmt: skip
    for (name, y), (width, line) in zip(drawn.items(), told_apart(drawn, styles, frame), strict=True):
        axes.plot(x, y, color=styles[name].color, linestyle=line, linewidth=width, drawstyle=form, label=plain(name),
                  alpha=0.5 if width > WIDTH else 1.0)  # fmt: skip
    draw_points(axes, marks, styles, drawn)
    for said, marker in ((band_label and f"band: {band_label}", ""), (point_label, "o")):
        if said:
            explain(axes, said, marker=marker)
    axes.margins(x=0.02 if marks else 0.0)
    return framed(axes, frame, styles, from_zero=True)


def points(
    groups: Numbers,
    x_label: str,
    y_label: str,
    *,
    limits: Numbers | None = None,
    places: Numbers | None = None,
    notes: Numbers | None = None,
    log: str = "",
    x_range: Range | None = None,
    y_range: Range | None = None,
    title: str = "",
    colors: Mapping[str, str] | None = None,
    axes: Axes | None = None,
) -> Figure:
    """Points of two quantities, each group in a colour and with a mark of its own.

    Parameters
    ----------
    groups : mapping of arrays (M, 2)
        Points (x, y) by name, one to seven names; NaN isn't drawn. A hundred and more points are small and pale.
    x_label, y_label : str
        Quantity and unit of each axis; ", logarithmic" is added where it is.
    limits, places : mapping of float or pairs, optional
        Lines across the panel at values of y, and upright ones at values of x, by name; two numbers are a span.
    notes : mapping of pairs, optional
        Texts with the point (x, y) beside which each stands, where it touches nothing.
    log : {"", "x", "y", "xy"}
        Logarithmic axes.
    x_range, y_range : pair of float, optional
        Ends of an axis, None where it ends by itself.
    title : str
        Above the panel.
    colors : mapping of str, optional
        Name → colour, also of limits; the others get one as by `styles`.
    axes : matplotlib.axes.Axes, optional
        A panel to draw on, of `new_panels` or `new_figure`; by default a new figure.

    Returns
    -------
    matplotlib.figure.Figure
        The new one, or that of `axes`.

    Raises
    ------
    ValueError
        If one of `groups` hasn't shape (M, 2) or is infinite; one of `groups`, `limits`, `places`, `notes`, `colors` is
        no mapping or has too many names; `x_label` or `y_label` says nothing; `log` is none of those words, `x_range`
        or `y_range` no pair from less to more, `title` no text, or `axes` are none of matplotlib.

    See Also
    --------
    lines : Lines, and points on them.
    runs : Values of several runs by name.

    Examples
    --------
    >>> from uavlab import plot
    >>> routes = {"A*": [(66.4, 0.2)], "least risk": [(74.1, 0.05), (80.0, 0.02)]}
    >>> figure = plot.points(routes, "length [m]", "risk [1/h]", log="y")
    >>> figure.axes[0].get_ylabel()
    'risk [1/h], logarithmic'
    """
    marks = {
        name: rows_of_points(f"groups[{name!r}]", xy) for name, xy in by_few_names("groups", groups, least=1).items()
    }
    frame = checked_frame(x_label, y_label, log=log, x_range=x_range, y_range=y_range, limits=limits, places=places,
                          notes=notes, title=title, colors=colors)  # fmt: skip
    axes = panel(axes)
    styles = styles_on(axes, list(marks), colors)
    draw_points(axes, marks, styles)
    return framed(axes, frame, styles, from_zero=True)


def draw_points(
    axes: Axes, marks: Mapping[str, np.ndarray], styles: Mapping[str, Style], explained: Collection[str] = ()
) -> None:
    """Points by name, each name with a mark of its own; those that are explained already aren't in the legend."""
    for (name, xy), marker in zip(marks.items(), MARKERS, strict=False):
        label = None if name in explained else plain(name)
        if len(xy) < CLOUD:
            axes.plot(*xy.T, marker, color=styles[name].color, markersize=7, markeredgecolor="white",
                      markeredgewidth=0.6, label=label, zorder=2.5)  # fmt: skip
            continue
        axes.plot(*xy.T, ".", color=styles[name].color, markersize=3, alpha=0.35, zorder=1)
        if label:
            axes.plot([], [], ".", color=styles[name].color, markersize=8, label=label)


def told_apart(
    drawn: Mapping[str, np.ndarray], styles: Mapping[str, Style], frame: Frame
) -> list[tuple[float, LineStyle]]:
    """Width and line style of each: where later lines lie on an earlier one, that is wider and they are dashed."""
    least, most = (end if given is None else given for given, end in zip(frame.ends[1], (-np.inf, np.inf), strict=True))
    with np.errstate(invalid="ignore", divide="ignore"):
        shown = [np.where((y >= least) & (y <= most), y, np.nan) for y in drawn.values()]
        heights = [np.log(np.where(y > 0, y, np.nan)) if "y" in frame.log else y for y in shown]
    every = np.concatenate([np.empty(0), *heights])
    every = every[np.isfinite(every)]
    reach = TOGETHER * np.ptp(every) if len(every) else 0.0
    bottom = every.min() + 2 * reach if reach > 0 else -np.inf  # near it many lines end, without a doubt
    found: list[tuple[float, LineStyle]] = [
        (ROUGH_WIDTH, "-") if is_rough(y) else (WIDTH, styles[name].line) for name, y in drawn.items()
    ]
    for low in reversed(range(len(found))):
        for high in range(low + 1, len(found)):
            near = np.abs(heights[low] - heights[high]) <= reach
            if np.mean(near & (heights[low] > bottom)) > OFTEN:
                found[low] = max(found[low][0], found[high][0] + WIDER), found[low][1]
                if found[high][1] == found[low][1]:
                    found[high] = found[high][0], "--" if found[low][1] == "-" else "-"
    return found


def is_rough(y: np.ndarray) -> bool:
    """Whether a line goes up and down from point to point, as noise does: dashes would be lost in it."""
    return len(y) > CLOUD and bool(np.mean(np.diff(np.sign(np.diff(y))) != 0) > OFTEN)


def band_ends(name: str, pair: Any, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper end of a band, each (N,)."""
    ends = checks.listed(f"bands[{name!r}]", pair, "two, its lower and its upper end")
    if len(ends) != 2:
        raise ValueError(f"bands[{name!r}] must be its lower and its upper end, got {len(ends)} of them")
    low, high = (checks.numbers(f"bands[{name!r}]", end) for end in ends)
    low, high = (np.full(count, end) if end.ndim == 0 else end for end in (low, high))
    low, high = (finite_or_gaps(f"bands[{name!r}]", end, count) for end in (low, high))
    if (low > high).any():
        raise ValueError(
            f"bands[{name!r}] must have its lower end below its upper one, got {low[low > high][0]:g} as lower"
        )
    return low, high


def said_of(name: str, text: str, what: str, shared: Collection[str]) -> None:
    """Refuse bands or points under the names of lines when nobody says what they are."""
    if bool(checks.text(name, text).strip()) != bool(shared):
        raise ValueError(
            f"{name} must say what the {what} of {', '.join(sorted(shared))} are, got {text!r}" if shared
            else f"{name} is of {what} that have the name of a line, and there are none"
        )  # fmt: skip
