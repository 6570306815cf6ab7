"""The frame of a panel: labels with units, scales, ends, limits and notes, checked first and drawn last.

All kinds of figures that have two axes share it. What is wrong is refused before anything is drawn, and notes and names
of limits are placed when all else stands.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogFormatterSciNotation, LogLocator, NullLocator

from uavlab import checks
from uavlab.plot.colors import Style, checked_colors
from uavlab.plot.labels import Limits, checked_limits, checked_notes, draw_limits, name_limits, write_notes
from uavlab.plot.panels import with_legend
from uavlab.plot.style import plain

FROM_ZERO = 0.35
"""An axis begins at 0 when no value is negative and the least is below this share of the greatest."""
FEW_DECADES = 2.5
"""Of a logarithmic axis; it has numbers between powers of ten, too."""
Ends = tuple[float | None, float | None]


class Frame(NamedTuple):
    """What a panel has besides its data, checked."""

    labels: tuple[str, str]
    log: str
    ends: tuple[Ends, Ends]
    limits: Limits
    places: Limits
    notes: dict[str, np.ndarray]
    title: str
    colors: dict[str, str]


def checked_frame(
    x_label: str, y_label: str, *, log: str = "", x_range: Any = None, y_range: Any = None, limits: Any = None,
    places: Any = None, notes: Any = None, title: str = "", colors: Any = None, x_name: str = "x_label",
) -> Frame:  # fmt: skip
    """The frame that is asked for, by the names of the kinds' parameters."""
    label(x_name, x_label)
    label("y_label", y_label)
    checks.one_of("log", log, ("", "x", "y", "xy"))
    ends = (value_range("x_range", x_range, "x" in log), value_range("y_range", y_range, "y" in log))
    return Frame((x_label, y_label), log, ends, checked_limits("limits", limits), checked_limits("places", places),
                 checked_notes(notes), checks.text("title", title), checked_colors(colors))  # fmt: skip


def label(name: str, text: str) -> None:
    """Refuse a label that says nothing: an axis needs its quantity and unit."""
    if not checks.text(name, text).strip():
        raise ValueError(f"{name} must say the quantity and its unit, as in 'wind [m/s]', got {text!r}")


def value_range(name: str, pair: Any, logarithmic: bool = False) -> Ends:
    """The two ends of an axis, None where it ends by itself."""
    if pair is None:
        return None, None
    ends = checks.listed(name, pair, "two ends, as in (0, 10)")
    if len(ends) != 2:
        raise ValueError(f"{name} must be two ends, as in (0, 10) or (0, None), got {pair!r:.60}")
    low, high = (None if end is None else checks.number(name, end, checks.finite) for end in ends)
    if low is not None and high is not None and low >= high:
        raise ValueError(f"{name} must go from less to more, got {pair!r:.60}")
    if logarithmic and low is not None and low <= 0:
        raise ValueError(f"{name} must be above 0 on a logarithmic axis, got {pair!r:.60}")
    return low, high


def framed(axes: Axes, frame: Frame, styles: Mapping[str, Style] | None = None, *, from_zero: bool = False) -> Figure:
    """The figure with all that its panel has besides its data."""
    colors = {name: style.color for name, style in (styles or {}).items()} | frame.colors
    draw_limits(axes, frame.limits, frame.places, colors)
    for side in (0, 1):
        set_axis(axes, side, frame, from_zero and side == 1)
    figure = with_legend(axes)
    above = name_limits(axes, frame.limits, frame.places, colors)
    axes.set_title(plain(frame.title), fontsize=10, pad=6 + 11 * above)
    write_notes(axes, frame.notes)
    return figure


def set_axis(axes: Axes, side: int, frame: Frame, from_zero: bool) -> None:
    """Label, scale and ends of an axis; a logarithmic one says so."""
    axis, set_ends = ((axes.xaxis, axes.set_xlim), (axes.yaxis, axes.set_ylim))[side]
    logarithmic = "xy"[side] in frame.log
    axis.set_label_text(plain(frame.labels[side]) + (", logarithmic" if logarithmic else ""))
    if logarithmic:
        (axes.set_xscale, axes.set_yscale)[side]("log", nonpositive="mask")
    low, high = frame.ends[side]
    least, most = axis.get_data_interval()
    if from_zero and not logarithmic and low is None and 0 <= least < FROM_ZERO * most:
        low = 0.0
    if low is not None or high is not None:
        set_ends(low, high)
    axes.grid(visible=True, alpha=0.3)
    if logarithmic:
        write_plainly(axis)


def write_plainly(axis: Any) -> None:
    """Numbers as they are on a logarithmic axis, unless they are too long; also between powers of ten if it has few."""
    low, high = sorted(axis.get_view_interval())
    decades = np.log10(high / low)
    few = decades < FEW_DECADES
    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if few else (1.0,), numticks=12))
    if low >= 1e-4 and high <= 1e6:
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.7g}"))
    elif few:
        axis.set_major_formatter(LogFormatterSciNotation(minor_thresholds=(np.inf, np.inf)))  # 5·10ⁿ, too
    if few:
        axis.set_minor_locator(NullLocator())
