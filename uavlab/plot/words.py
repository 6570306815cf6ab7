"""What a figure shows, in words, for readers who don't see it: made from what is drawn.

Each panel is a sentence or two: its title, its axes with their ranges, what its colours mean, and each thing with a
name, as `"A*, 66.4 m" (blue, solid)`, with where it begins and ends and what it reaches.
"""

from __future__ import annotations

import re
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PathCollection
from matplotlib.colors import to_rgb
from matplotlib.container import BarContainer
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from uavlab import checks
from uavlab.plot.colors import BLACK, BLUE, CRASH_COLOR, GREEN, LINES, ORANGE, PINK, SKY, YELLOW, Style

COLOR_WORDS = {
    BLACK: "black", BLUE: "blue", ORANGE: "orange", GREEN: "green", PINK: "pink", YELLOW: "yellow", SKY: "sky blue",
    CRASH_COLOR: "red", "#FFFFFF": "white", "#666666": "grey", "#CCCCCC": "light grey",
}  # fmt: skip
LINE_WORDS = {"-": "solid", "--": "dashed", "-.": "dash-dotted", ":": "dotted"}
DASH_WORDS = {GREEN: "dash-dot-dotted", YELLOW: "long dashes", SKY: "dash-dotted in pairs"}
MARKER_WORDS = {
    "o": "discs", "^": "triangles", "s": "squares", "x": "crosses", "D": "diamonds", "v": "triangles down",
    "P": "pluses", "*": "stars", "|": "ticks", "+": "pluses", ".": "dots",
}  # fmt: skip
MOST_LETTERS = 1200
MOST_NAMES = 9
"""In a panel; of others it is said how many they are."""


def alt_text(figure: Figure) -> str:
    """What a figure shows, in words, for readers who don't see it.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        Any; figures that `finished` returns carry this text into notebooks and their HTML.

    Returns
    -------
    str
        Some sentences, at most 1 200 letters.

    Raises
    ------
    ValueError
        If `figure` is none of matplotlib.

    See Also
    --------
    finished : Figures that it returns have this text in a notebook.

    References
    ----------
    W3C, Web Content Accessibility Guidelines (WCAG) 2.2, 2023: success criterion 1.1.1.

    Examples
    --------
    >>> from uavlab import plot
    >>> plot.alt_text(plot.bars({"A*": 66.4, "any angle": 63.9}, "length [m]"))
    'Bars over "length [m]": A* 66.4, any angle 63.9.'
    """
    checks.instance("figure", figure, Figure)
    bars = {id(axes) for axes in every_panel(figure) if hasattr(axes, "_colorbar")}
    panels = [axes for axes in every_panel(figure) if id(axes) not in bars and axes.get_visible()]
    said = [panel_words(axes) for axes in panels]
    keys = [key for legend in figure.legends for key in zip(legend.legend_handles, legend.get_texts(), strict=False)]
    named = {text for words in said for text in re.findall(r'"([^"]*)"', words)}
    keys = [(handle, text) for handle, text in keys if plain_words(text.get_text()) not in named]
    if keys:
        said.append("Key: " + ", ".join(with_look(text.get_text(), handle) for handle, text in keys))
    if len(panels) > 1:
        said = [f"{len(panels)} panels", *said]
    text = ". ".join(words[:1].upper() + words[1:] for words in said if words) + "."
    return text if len(text) <= MOST_LETTERS else text[: text.rfind(" ", 0, MOST_LETTERS - 20)] + " … and more."


def every_panel(figure: Figure) -> list[Axes]:
    """All axes of a figure, also those within others, such as colour bars."""
    return [one for axes in figure.axes for one in (axes, *(c for c in axes.child_axes if isinstance(c, Axes)))]


def panel_words(axes: Axes) -> str:
    """One panel in words."""
    title = plain_words(axes.get_title())
    bars = [container for container in axes.containers if isinstance(container, BarContainer) and len(container)]
    if bars and not axes.lines:
        return " ".join(filter(None, [title + ":" if title else "", bar_words(axes, bars[0])]))
    things = [words for words in map(thing_words, named_things(axes)) if words]
    if len(things) > MOST_NAMES:
        things = [*things[:MOST_NAMES], f"and {len(things) - MOST_NAMES} more"]
    parts = [title, axes_words(axes), color_words(axes), "; ".join(things)]
    return ". ".join(part for part in parts if part)


def axes_words(axes: Axes) -> str:
    """Both axes with their labels, ranges and scales."""
    if not axes.axison:
        return ""
    said = []
    for name, label, limits, scale in (
        ("across", axes.get_xlabel(), axes.get_xlim(), axes.get_xscale()),
        ("up", axes.get_ylabel(), axes.get_ylim(), axes.get_yscale()),
    ):
        kind = {"log": ", logarithmic", "symlog": ", logarithmic away from 0"}.get(scale, "")
        words = f' "{plain_words(label)}"' if label else ""
        said.append(f"{name}{words} from {number(limits[0])} to {number(limits[1])}{kind}")
    kind = "map" if axes.get_xlabel().startswith("x, east") else "chart"
    return f"{kind}, {', '.join(said)}"


def color_words(axes: Axes) -> str:
    """What colours stand for, where there is a colour bar."""
    said = []
    for one in [*axes.images, *axes.collections]:
        bar = getattr(one, "colorbar", None)
        if bar is not None:
            label = plain_words(bar.ax.get_ylabel() or bar.ax.get_xlabel())
            low, high = one.get_clim()
            said.append(f'colours: "{label}" from {number(low)} to {number(high)}')
    return "; ".join(dict.fromkeys(said))


def named_things(axes: Axes) -> list[Any]:
    """Lines, points and areas that have a name."""
    drawn = [*axes.lines, *axes.collections, *axes.patches]
    return [one for one in drawn if str(one.get_label()) and not str(one.get_label()).startswith("_")]


def thing_words(thing: Any) -> str:
    """A named thing: how it looks, where it begins and ends, what it reaches."""
    look = with_look(str(thing.get_label()), thing)
    if isinstance(thing, Line2D):
        points: Any = np.column_stack(
            [np.ma.filled(np.ma.asarray(axis, dtype=float), np.nan) for axis in thing.get_data()]
        )
    elif isinstance(thing, PathCollection):
        points = np.asarray(np.ma.filled(thing.get_offsets(), np.nan), dtype=float)
        return f"{look}: {np.isfinite(points).all(axis=1).sum()} points"
    else:
        return look
    points = points[np.isfinite(points).all(axis=1)]
    if len(points) < 2:
        return look if not len(points) else f"{look} at ({number(points[0, 0])}, {number(points[0, 1])})"
    (x, y), (u, v) = points[0], points[-1]
    low, high = points[points[:, 1].argmin()], points[points[:, 1].argmax()]
    reach = (
        ""
        if len(points) == 2
        else f", least {number(low[1])} at {number(low[0])}, most {number(high[1])} at {number(high[0])}"
    )
    return f"{look} from ({number(x)}, {number(y)}) to ({number(u)}, {number(v)}){reach}"


def bar_words(axes: Axes, bars: BarContainer) -> str:
    """Each bar with its name and length."""
    level = bars.orientation == "horizontal"
    names = [tick.get_text() for tick in (axes.get_yticklabels() if level else axes.get_xticklabels())]
    values = [patch.get_width() if level else patch.get_height() for patch in bars.patches]
    label = plain_words(axes.get_xlabel() if level else axes.get_ylabel())
    pairs = zip(names, values, strict=False)
    return f'Bars over "{label}": ' + ", ".join(f"{plain_words(name)} {number(value)}" for name, value in pairs)


def with_look(name: str, thing: Any) -> str:
    """A name in quotes with its colour and line style or marker."""
    return f'"{plain_words(name)}" ({", ".join(looks_of(thing))})'


def with_style(name: str, style: Style) -> str:
    """A name in quotes with its colour and line style."""
    line = LINE_WORDS.get(style.line, "solid") if isinstance(style.line, str) else DASH_WORDS.get(style.color, "dashed")
    return f'"{plain_words(name)}" ({color_word(to_rgb(style.color))}, {line})'


def looks_of(thing: Any) -> list[str]:
    """Colour and line style or marker in words."""
    if not isinstance(thing, Line2D):
        color = thing.get_facecolor() if hasattr(thing, "get_facecolor") else thing.get_color()
        colors = np.atleast_2d(np.asarray(color, dtype=float))
        edge = (
            np.atleast_2d(np.asarray(thing.get_edgecolor(), dtype=float)) if hasattr(thing, "get_edgecolor") else colors
        )
        shown = next((c[0] for c in (colors, edge) if len(c) and (c.shape[1] < 4 or c[0, 3] > 0)), None)
        return ["hatched" if shown is None else color_word(shown[:3])]
    marker = MARKER_WORDS.get(str(thing.get_marker()), "")
    word = color_word(to_rgb(thing.get_color()))
    if thing.get_linestyle() in ("None", "none", "", " "):
        return [word, marker or "points"]
    line = LINE_WORDS.get(str(thing.get_linestyle()), "solid")
    custom = thing._unscaled_dash_pattern[1]  # type: ignore[attr-defined]
    for color, style in LINES.items():
        if not isinstance(style, str) and custom is not None and tuple(custom) == tuple(style[1]):
            line = DASH_WORDS[color]
    return [word, line, *([f"with {marker}"] if marker else [])]


def color_word(rgb: Any) -> str:
    """The nearest of the colours that have a name."""
    return min(COLOR_WORDS.items(), key=lambda item: float(np.abs(np.subtract(to_rgb(item[0]), rgb)).sum()))[1]


def number(value: float) -> str:
    """A number with three digits, four of thousands."""
    rounded = float(f"{float(value):.{4 if abs(value) >= 1000 else 3}g}")
    return f"{rounded:,.0f}" if abs(rounded) >= 100 and rounded == round(rounded) else f"{rounded:.3g}"


def plain_words(text: str) -> str:
    """A text without TeX, line breaks and what keeps matplotlib from reading it as TeX."""
    text = re.sub(r"\\(?:text|mathrm|mathit|rm)\b", "", text.replace("\u200b", "").replace(r"\$", "\0"))
    text = re.sub(r"[${}]", "", text).replace("\0", "$").replace('"', "'")
    return re.sub(r"\s+", " ", text.replace("\\", "")).strip()
