"""Values over two parameters: as a heat map with contours and marks, or as a matrix with its numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from uavlab import checks
from uavlab.plot.colors import SEQUENTIAL
from uavlab.plot.frames import checked_frame, framed
from uavlab.plot.frames import label as checked_label
from uavlab.plot.panels import by_few_names, figure_of, finite_or_gaps, panel, styles_on
from uavlab.plot.planes import checked_mask, checked_paths, draw_paths
from uavlab.plot.series import draw_points
from uavlab.plot.style import add_color_bar, plain

HATCHES = ("///", "...", "xx", "\\\\\\", "++", "oo", "--")
MOST_CELLS = 2500
"""Of a matrix; more numbers can't be read."""


def heat_map(
    x: npt.ArrayLike,
    y: npt.ArrayLike,
    values: npt.ArrayLike,
    x_label: str,
    y_label: str,
    label: str,
    *,
    contours: Sequence[float] = (),
    hatched: Mapping[str, npt.ArrayLike] | None = None,
    paths: Mapping[str, npt.ArrayLike] | None = None,
    points: Mapping[str, npt.ArrayLike] | None = None,
    notes: Mapping[str, npt.ArrayLike] | None = None,
    norm: Normalize | None = None,
    equal: bool = False,
    title: str = "",
    colors: Mapping[str, str] | None = None,
    axes: Axes | None = None,
) -> Figure:
    """A quantity over two others as colours, with contours, regions that are hatched, lines and points.

    Parameters
    ----------
    x, y : (nx,), (ny,) array
        Where the values are, rising, at least two of each.
    values : (nx, ny) array
        One for each pair; NaN isn't drawn.
    x_label, y_label, label : str
        Quantity and unit of the axes and of the colours.
    contours : sequence of float
        Values whose contours are drawn and numbered.
    hatched : mapping of arrays (nx, ny), optional
        Where something holds (bool), by name, at most seven: grey and hatched.
    paths : mapping of arrays (M, 2), optional
        Lines through points (x, y), by name, at most seven; NaN is a gap.
    points : mapping of arrays (M, 2), optional
        Marks at points (x, y), by name, at most seven.
    notes : mapping of pairs, optional
        Texts with the point (x, y) beside which each stands.
    norm : matplotlib.colors.Normalize, optional
        From values to colours, such as `LogNorm()`; by default evenly over the values. Panels in one row that
        have the same share a colour bar.
    equal : bool
        Whether both axes have the same scale, as two lengths have.
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
        If `x` or `y` doesn't rise, `values` or one of `hatched` hasn't their shape, `contours` aren't finite numbers
        that differ, one of `hatched`, `paths`, `points`, `notes`, `colors` is no mapping or has too many names, one of
        `x_label`, `y_label`, `label` says nothing, `norm` is no `Normalize`, `equal` no bool, `title` no text, or
        `axes` are none of matplotlib.

    See Also
    --------
    matrix : Few values, with their numbers.
    value_map : Values on the map of a city.

    Examples
    --------
    >>> import numpy as np
    >>> from uavlab import plot
    >>> load, rain = np.linspace(0, 1.2, 25), np.linspace(0, 300, 31)
    >>> wind = 13.0 - 2.0 * load[:, None] - 0.001 * rain
    >>> figure = plot.heat_map(load, rain, wind, "load [kg]", "rain [mm/h]", "wind [m/s]", contours=[11, 12])
    >>> figure.axes[0].get_xlabel(), figure.axes[0].child_axes[0].get_ylabel()
    ('load [kg]', 'wind [m/s]')
    """
    x, y = rising("x", x), rising("y", y)
    shown = finite_or_gaps("values", values, len(x), len(y))
    levels = sorted(checks.array("contours", list(checks.listed("contours", contours, "numbers")), None).tolist())
    if len(set(levels)) < len(levels):
        raise ValueError(f"contours must differ from each other, got {contours!r:.60}")
    masks = {name: checked_mask(f"hatched[{name!r}]", mask, shown.shape)
             for name, mask in by_few_names("hatched", hatched).items()}  # fmt: skip
    lines, marks = checked_paths("paths", paths), checked_paths("points", points)
    checked_label("label", label)
    if norm is not None:
        checks.instance("norm", norm, Normalize)
    frame = checked_frame(x_label, y_label, notes=notes, title=title, colors=colors)
    scale = "equal" if checks.flag("equal", equal) else "auto"
    axes = panel(axes, 7.2, 4.8)
    image = axes.pcolormesh(x, y, shown.T, cmap=SEQUENTIAL, norm=norm, shading="nearest", rasterized=True)
    add_color_bar(figure_of(axes), axes, image, plain(label))
    if levels:
        drawn = axes.contour(x, y, shown.T, levels, colors="white", linewidths=1.2)
        axes.clabel(drawn, fmt="%g", fontsize=8)
    for (name, mask), hatch in zip(masks.items(), HATCHES, strict=False):
        axes.contourf(x, y, mask.T.astype(float), [0.5, 1.5], colors=["0.88"], hatches=[hatch])
        axes.fill_between([], [], [], facecolor="0.88", edgecolor="black", hatch=hatch, linewidth=0, label=plain(name))
    styles = styles_on(axes, list(dict.fromkeys([*lines, *marks])), colors)
    draw_paths(axes, lines, styles, halo=True)
    draw_points(axes, marks, styles, lines)
    axes.set(aspect=scale, xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))
    figure = framed(axes, frame, styles)
    axes.grid(visible=False)
    return figure


def matrix(
    values: npt.ArrayLike,
    rows: Sequence[str],
    columns: Sequence[str],
    row_label: str,
    column_label: str,
    label: str,
    *,
    shares: bool = False,
    digits: int = 0,
    norm: Normalize | None = None,
    title: str = "",
    axes: Axes | None = None,
) -> Figure:
    """A table of numbers, each on a colour of its size; such as a confusion matrix.

    Parameters
    ----------
    values : (R, C) array
        Written in the cells; NaN isn't.
    rows, columns : sequence of str
        Names of the R rows, from top to bottom, and of the C columns, all different.
    row_label, column_label, label : str
        What rows, columns and colours are.
    shares : bool
        Whether the colour is the share in its row, 0 to 1, instead of the value; the values are at least 0 then.
    digits : int
        Behind the decimal point of what is written, 0 to 9.
    norm : matplotlib.colors.Normalize, optional
        From values to colours; by default evenly over the values. Panels that are compared need the same;
        those in one row share a colour bar then.
    title : str
        Above the panel.
    axes : matplotlib.axes.Axes, optional
        A panel to draw on, of `new_panels` or `new_figure`; by default a new figure.

    Returns
    -------
    matplotlib.figure.Figure
        The new one, or that of `axes`, with a colour bar.

    Raises
    ------
    ValueError
        If `values` hasn't the shape of `rows` and `columns`, more than 2,500 cells, or with `shares` negative values or
        a row whose sum is 0; one of `row_label`, `column_label`, `label` says nothing; `shares` is no bool, `digits` no
        whole number from 0 to 9, `norm` no `Normalize`, `title` no text, or `axes` are none of matplotlib.

    See Also
    --------
    heat_map : Many values over two quantities.

    Examples
    --------
    >>> from uavlab import plot
    >>> counts = [[40, 3], [5, 52]]
    >>> figure = plot.matrix(counts, ["1", "2"], ["1", "2"], "true class", "predicted class", "share", shares=True)
    >>> [text.get_text() for text in figure.axes[0].texts]
    ['40', '3', '5', '52']
    """
    names = {"rows": checked_texts("rows", rows), "columns": checked_texts("columns", columns)}
    table = finite_or_gaps("values", values, len(names["rows"]), len(names["columns"]))
    if table.size > MOST_CELLS:
        raise ValueError(f"values must be at most {MOST_CELLS:,} cells, to be read, got {table.size:,}")
    for name, text in (("row_label", row_label), ("column_label", column_label), ("label", label)):
        checked_label(name, text)
    digits = checks.whole("digits", digits, 0, 9)
    if norm is not None:
        checks.instance("norm", norm, Normalize)
    checks.text("title", title)
    shade = table
    if checks.flag("shares", shares):
        total = np.nansum(table, axis=1, keepdims=True)
        if (table < 0).any() or (total == 0).any():
            raise ValueError("values must be at least 0, with a sum above 0 in each row, to have shares")
        shade, norm = table / total, norm or Normalize(0.0, 1.0)
    axes = panel(axes, 2.4 + 0.55 * len(names["columns"]), 1.4 + 0.5 * len(names["rows"]))
    image = axes.imshow(shade, cmap=SEQUENTIAL, norm=norm, aspect="auto")
    add_color_bar(figure_of(axes), axes, image, plain(label))
    for (i, j), value in np.ndenumerate(table):
        if np.isfinite(value):
            dark = float(np.ma.filled(image.norm(shade[i, j]), 0.0)) < 0.55
            axes.text(
                j, i, f"{value:,.{digits}f}", ha="center", va="center", fontsize=8, color="white" if dark else "black"
            )
    axes.set_xticks(range(len(names["columns"])), map(plain, names["columns"]))
    axes.set_yticks(range(len(names["rows"])), map(plain, names["rows"]))
    figure = framed(axes, checked_frame(column_label, row_label, title=title))
    axes.grid(visible=False)
    axes.set(xlim=(-0.5, table.shape[1] - 0.5), ylim=(table.shape[0] - 0.5, -0.5))
    return figure


def rising(name: str, values: npt.ArrayLike) -> np.ndarray:
    """At least two finite numbers, each above the one before."""
    array = checks.array(name, values, None)
    if len(array) < 2 or (np.diff(array) <= 0).any():
        raise ValueError(f"{name} must be at least two numbers, each above the one before, got {values!r:.60}")
    return array


def checked_texts(name: str, values: Any) -> list[str]:
    """At least one text."""
    texts = [checks.text(f"{name}[{n}]", text) for n, text in enumerate(checks.listed(name, values, "texts"))]
    if not texts:
        raise ValueError(f"{name} must hold at least one text, got none")
    if len(set(texts)) < len(texts):
        raise ValueError(f"{name} must differ from each other, got {texts!r:.60}")
    return texts
