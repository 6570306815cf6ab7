"""Texts inside and beside panels: limits with their names, and notes beside points, none of them on another.

A limit is a line across the panel, or a span of it; its name stands outside of the panel. A note stands beside its
point, where it touches no line, no mark and no other note.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from uavlab import checks
from uavlab.plot.panels import by_few_names, figure_of
from uavlab.plot.style import plain

MOST_LABELS = 100
"""Limits, places or notes of a panel; more can't be read."""
LINE_HEIGHT, LETTER = 11.0, 4.6
"""Of labels [points]."""
DIRECTIONS = np.array([(1, 1), (-1, 1), (1, -1), (-1, -1), (1, 0), (-1, 0), (0, 1), (0, -1)])
"""Where a note may stand beside its point, the best one first."""
DISTANCES = (4, 8, 16, 26, 38, 52)
"""From a point to its note [points]; a thin line shows the way from the third on."""
Limits = dict[str, np.ndarray]


def checked_limits(name: str, limits: Any) -> Limits:
    """Places on an axis by name: a number each, or a pair of them for a span."""
    found = {}
    for label, value in by_few_names(name, limits, MOST_LABELS).items():
        ends = checks.numbers(f"{name}[{label!r}]", value)
        if ends.shape not in ((), (2,)) or not np.isfinite(ends).all():
            raise ValueError(f"{name}[{label!r}] must be one finite number, or two for a span, got {value!r:.60}")
        found[label] = np.atleast_1d(ends)
    return found


def draw_limits(axes: Axes, limits: Limits, places: Limits, colors: Mapping[str, str]) -> None:
    """Lines across the panel at `limits`, upright ones at `places`; spans are shaded."""
    for named, line, span in ((limits, axes.axhline, axes.axhspan), (places, axes.axvline, axes.axvspan)):
        for name, ends in named.items():
            color = colors.get(name, "0.35")
            if len(ends) == 1:
                line(*ends, color=color, linestyle=(0, (4, 2)), linewidth=1.1, zorder=1.5)
            else:
                span(*ends, color=color, alpha=0.18, linewidth=0, zorder=0.5)


def name_limits(axes: Axes, limits: Limits, places: Limits, colors: Mapping[str, str]) -> int:
    """Names of limits to the right of the panel, of places above it; returns how many rows of them stand above."""
    wide, high = (float(side) * 72 / figure_of(axes).dpi for side in axes.bbox.size)
    lowest = -np.inf
    for share, name, at in seen(axes, limits, 1):
        half = LINE_HEIGHT * (1 + name.count("\n")) / 2
        middle = max(share * high, lowest + half)
        axes.annotate(plain(name), (1.0, at), (5, middle - share * high), xycoords=("axes fraction", "data"),
                      textcoords="offset points", va="center", fontsize=8, color=colors.get(name, "0.25"))  # fmt: skip
        lowest = middle + half
    ends: list[float] = []  # of the last name in each row
    for share, name, at in seen(axes, places, 0):
        half = LETTER * max(map(len, name.split("\n"))) / 2
        row = next((number for number, end in enumerate(ends) if end < share * wide - half), len(ends))
        ends[row : row + 1] = [share * wide + half + LETTER]
        axes.annotate(plain(name), (at, 1.0), (0, 3 + LINE_HEIGHT * row), xycoords=("data", "axes fraction"),
                      textcoords="offset points", ha="center", fontsize=8, color=colors.get(name, "0.25"))  # fmt: skip
    return len(ends)


def seen(axes: Axes, named: Limits, side: int) -> list[tuple[float, str, float]]:
    """Limits that lie within the panel, in order: as a share of it, by name, and on the axis, spans by their middle."""
    found = []
    for name, ends in named.items():
        points = np.array([axes.transData.inverted().transform(axes.transAxes.transform((0.5, 0.5)))] * len(ends))
        points[:, side] = ends
        shares = axes.transAxes.inverted().transform(axes.transData.transform(points))
        share = float(np.clip(shares[:, side], 0, 1).mean()) if len(ends) == 2 else float(shares[0, side])
        middle = axes.transData.inverted().transform(axes.transAxes.transform(np.full(2, share)))[side]
        if -0.001 <= share <= 1.001:
            found.append((share, name, float(middle)))
    return sorted(found)


def checked_notes(notes: Any) -> dict[str, np.ndarray]:
    """Texts with the point (2,) that each belongs to."""
    named = by_few_names("notes", notes, MOST_LABELS)
    return {text: checks.array(f"notes[{text!r}]", point, 2) for text, point in named.items()}


def write_notes(axes: Axes, notes: dict[str, np.ndarray]) -> None:
    """Each text beside its point, touching nothing."""
    if not notes:
        return
    figure = figure_of(axes)
    figure.draw_without_rendering()  # else the size of the panel isn't known
    paths = [line.get_path().transformed(line.get_transform()) for line in axes.lines]
    marked = [
        path.vertices for path, line in zip(paths, axes.lines, strict=True) if line.get_marker() not in ("", "None")
    ]
    marks = np.concatenate([np.empty((0, 2)), *marked])
    taken: list[Bbox] = []
    for text, point in notes.items():
        note = axes.annotate(
            plain(text), (float(point[0]), float(point[1])), (0, 0), textcoords="offset points", fontsize=8,
            ha="center", va="center",
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.6, "alpha": 0.75},
            arrowprops={"arrowstyle": "-", "color": "0.5", "linewidth": 0.7},
        )  # fmt: skip
        size = np.array(Text.get_window_extent(note).size)
        (right, up), near, box = free_place(axes, axes.transData.transform(point), size, paths, marks, taken)
        note.set_position((right * 72 / figure.dpi, up * 72 / figure.dpi))
        if near and note.arrow_patch is not None:
            note.arrow_patch.set_visible(False)
        taken.append(box)


def free_place(
    axes: Axes, home: np.ndarray, size: np.ndarray, paths: list[Any], marks: np.ndarray, taken: list[Bbox]
) -> tuple[np.ndarray, bool, Bbox]:
    """How far from its point a text stands [pixels], whether that is near, and what it covers; above if all is full."""
    inside = axes.get_window_extent()

    def covered(shift: np.ndarray) -> Bbox:
        return Bbox([home + shift - size / 2, home + shift + size / 2]).padded(2)

    for distance in DISTANCES:
        for direction in DIRECTIONS:
            shift = direction * (size / 2 + distance * figure_of(axes).dpi / 72)
            box = covered(shift)
            if (
                inside.fully_containsx(box.x0) and inside.fully_containsx(box.x1)
                and inside.fully_containsy(box.y0) and inside.fully_containsy(box.y1)
                and not box.count_overlaps(taken) and not box.padded(4).count_contains(marks)
                and not any(path.intersects_bbox(box, filled=False) for path in paths)
            ):  # fmt: skip
                return shift, distance < DISTANCES[2], box
    shift = np.array([0.0, size[1]])
    return shift, True, covered(shift)
