"""Colours that colour-blind readers can tell apart, and which thing has which, in all figures and scenes."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from itertools import cycle
from typing import NamedTuple

import matplotlib
from matplotlib.colors import is_color_like, to_hex

BLACK, BLUE, ORANGE, GREEN, PINK, YELLOW, SKY = (
    "#000000", "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"
)  # fmt: skip
LineStyle = str | tuple[int, tuple[int, ...]]
LINES: dict[str, LineStyle] = {
    BLUE: "-", ORANGE: "--", BLACK: "-.", PINK: ":", GREEN: (0, (5, 1, 1, 1, 1, 1)), YELLOW: (0, (8, 2)),
    SKY: (0, (3, 1, 1, 1)),
}  # fmt: skip
"""The line style that belongs to a colour: told apart in grey, too. In this order names without a colour get them."""
PLANNER_COLORS = {
    "A*": BLUE, "potential field": ORANGE, "REPARE": GREEN, "hazard A*": PINK, "Theta*": YELLOW, "A* + shortcut": SKY,
    "least risk": BLACK, "least energy": YELLOW, "ant colony": ORANGE, "ACO": ORANGE, "PSO": PINK, "PSO-BAS": GREEN,
    "PSO-ACO": YELLOW, "BAS": SKY,
}  # fmt: skip
"""What a planner is drawn in wherever it is drawn; planners that are compared have colours of their own."""
CRASH_COLOR = "#D00000"
"""Of an X; nothing else has that shape, for readers to whom red is brown."""
SEQUENTIAL = matplotlib.colormaps["cividis"]


class Style(NamedTuple):
    """How one thing is drawn, in every figure and scene.

    See Also
    --------
    styles : Gives each name one.

    Examples
    --------
    >>> from uavlab import plot
    >>> plot.styles(["A*"])[0]
    Style(color='#0072B2', line='-')
    """

    color: str
    """As #rrggbb."""
    line: LineStyle
    """A line style of matplotlib; it belongs to the colour."""


def styles(names: Sequence[str], colors: Mapping[str, str] | None = None) -> list[Style]:
    """One colour and line style for each name: what is asked for, or the planner's own, or one that is still free.

    So a planner looks the same in all figures and scenes, and `colors` keeps anything else the same. A name that begins
    with a planner's, such as "A* in gusts", has that planner's colour where it is free. After seven colours they come
    again.

    Parameters
    ----------
    names : sequence of str
        Of routes, flights, planners or curves, in the order of the legend; one that comes twice is two things.
    colors : mapping of str, optional
        Name → colour, as matplotlib writes them, such as `plot.BLUE`; it may have names that aren't drawn.

    Returns
    -------
    list of Style
        One for each name.

    Raises
    ------
    ValueError
        If `names` is no sequence of texts, or `colors` no mapping from texts to colours.

    See Also
    --------
    plan : Draws routes in these colours, as do scenes and profiles.

    References
    ----------
    M. Okabe and K. Ito, Color Universal Design: How to Make Figures and Presentations That Are Friendly to Colorblind
    People, 2008.

    Examples
    --------
    >>> from uavlab import plot
    >>> [style.color for style in plot.styles(["safe curve", "A*"])]  # A* is blue wherever it is drawn
    ['#D55E00', '#0072B2']
    >>> plot.styles(["safe curve", "A*"], {"safe curve": plot.GREEN})[0].color == plot.GREEN
    True
    """
    if isinstance(names, str) or not isinstance(names, Sequence) or not all(isinstance(name, str) for name in names):
        raise ValueError(f"names must be a list of texts, got {names!r:.60}")
    asked = checked_colors(colors)
    chosen: list[str | None] = [asked.get(name) for name in names]
    for wanted in (PLANNER_COLORS.get, color_of_variant):
        for number, name in enumerate(names):
            color = wanted(name)
            if chosen[number] is None and color not in chosen:
                chosen[number] = color
    free = cycle([color for color in LINES if color not in chosen] or list(LINES))
    return [Style(color, LINES.get(color, "-")) for color in (one or next(free) for one in chosen)]


def color_of_variant(name: str) -> str | None:
    """The colour of the planner whose name another begins with."""
    begun = [planner for planner in PLANNER_COLORS if re.match(rf"{re.escape(planner)}(?![\w*+-]| \+)", name)]
    return PLANNER_COLORS[max(begun, key=len)] if begun else None


def checked_colors(colors: Mapping[str, str] | None) -> dict[str, str]:
    """Colours by name as #RRGGBB; `ValueError` for what is none."""
    if colors is None:
        return {}
    if not isinstance(colors, Mapping):
        raise ValueError(f"colors must be colours by name, as in {{'A*': '#0072B2'}}, got {colors!r:.60}")
    for name, color in colors.items():
        if not isinstance(name, str) or not is_color_like(color):
            raise ValueError(f"colors[{name!r:.40}] must be a colour, such as plot.BLUE, got {color!r:.40}")
    return {name: to_hex(color).upper() for name, color in colors.items()}


def sequential_color(share: float) -> str:
    """The colour of a share from 0 (dark) to 1 (bright), as #rrggbb."""
    return to_hex(SEQUENTIAL(share))
