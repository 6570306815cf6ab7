"""Curves: curvature and pitch along them, and how they pass corners."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from uavlab import checks
from uavlab.city import City
from uavlab.plot.charts import finite_or_nan
from uavlab.plot.colors import BLACK, BLUE, ORANGE, styles
from uavlab.plot.ground import draw_cut
from uavlab.plot.style import (
    DPI,
    Drawn,
    draw_map,
    finished,
    label_of,
    level_of,
    named_routes,
    plain,
)
from uavlab.spline import Curve
from uavlab.spline.curve import BANK, contact_distance
from uavlab.spline.limits import MAX_PITCH
from uavlab.vehicle import GRAVITY

LABEL_HEIGHT = 0.17
"""Of two lines beside a panel, as a share of its height: limits nearer than that are labelled above and below."""


def curve_profile(
    *curves: Curve | Mapping[str, Curve],
    speed: float,
    cell: float,
    bank: float = BANK,
    max_pitch: float = MAX_PITCH,
    colors: Mapping[str, str] | None = None,
) -> Figure:
    """Curvature and pitch along curves, with the papers' limits and ours (RISK-ACO Figs 9-10, PSO-BAS Figs 7-8).

    A bank holds a level turn up to κ = g·tan(bank)/v²; the papers ask for κ below 1 per voxel.

    Parameters
    ----------
    curves : Curve, or mapping of curves by name
        At least one, each in a colour of its own.
    speed : float
        v [m/s], above 0; 5 to 16 is usual.
    cell : float
        Edge of a voxel [m], above 0; 1 to 5 is usual.
    bank, max_pitch : float
        Limits of the bank, below π/2, and of the pitch, at most π/2 [rad], above 0.
    colors : mapping of str, optional
        Name → colour, for what should look the same elsewhere, as for `styles`.

    Returns
    -------
    matplotlib.figure.Figure
        Curvature [1/m] above, pitch [°] below, both over the distance flown [m].

    Raises
    ------
    ValueError
        If `curves` is empty or holds anything else than curves, `speed`, `cell`, `bank` or `max_pitch` is not above 0,
        `bank` is not below π/2, `max_pitch` is above it, or `colors` are no colours by name.

    See Also
    --------
    uavlab.spline.feasibility : Says whether the limits hold.
    uavlab.spline.allowed_speed : How fast a curvature can be flown.
    corner : Where curves pass a corner.

    Examples
    --------
    >>> import numpy as np
    >>> from uavlab import plot
    >>> from uavlab.spline import Curve
    >>> curve = Curve(np.array([[10.0, 10, 30], [40, 10, 30], [40, 40, 30]]), planner="bend")
    >>> figure = plot.curve_profile(curve, speed=8.0, cell=5.0)
    >>> [text.get_text() for text in figure.axes[0].texts]
    ['papers: 1 per\\nvoxel of 5 m', '30° of bank\\nat 8 m/s']
    """
    drawn = drawn_curves(curves)
    speed, cell, bank, max_pitch = (
        checks.positive_number(name, value)
        for name, value in (("speed", speed), ("cell", cell), ("bank", bank), ("max_pitch", max_pitch))
    )
    if not bank < np.pi / 2:
        raise ValueError(f"bank must be below π/2 rad (degrees? np.radians makes radians of them), got {bank:g}")
    checks.within("max_pitch", max_pitch, 0.0, np.pi / 2, "rad (degrees? np.radians makes radians of them)")
    figure, (above, below) = plt.subplots(2, 1, sharex=True, figsize=(8.4, 5.4), dpi=DPI, layout="constrained")
    for curve, (color, line) in zip(drawn, styles([curve.planner for curve in drawn], colors), strict=True):
        look = {"color": color, "linestyle": line}
        above.plot(curve.distance, finite_or_nan(curve.curvature), label=plain(curve.planner), **look)
        above.plot(curve.distance, finite_or_nan(curve.level_curvature), color=color, linewidth=3.5, alpha=0.25)
        below.plot(curve.distance, np.degrees(curve.pitch), **look)
    above.plot([], color="0.3", linewidth=3.5, alpha=0.25, label="level part of it")
    papers, banked = 1 / cell, GRAVITY * np.tan(bank) / speed**2
    highest = 1.15 * max(above.get_ylim()[1], papers, banked)
    sides = ("bottom", "top") if papers >= banked else ("top", "bottom")
    if abs(papers - banked) > LABEL_HEIGHT * highest:
        sides = ("center", "center")
    limits = (
        (above, papers, f"papers: 1 per\nvoxel of {cell:g} m", sides[0]),
        (above, banked, f"{np.degrees(bank):.0f}° of bank\nat {speed:g} m/s", sides[1]),
        (below, np.degrees(max_pitch), f"±{np.degrees(max_pitch):.0f}°", "center"),
        (below, -np.degrees(max_pitch), "", "center"),
    )
    for axes, limit, text, side in limits:
        axes.axhline(limit, color="0.3", linewidth=1)
        axes.annotate(text, (1.01, limit), xycoords=("axes fraction", "data"), va=side, fontsize=8, color="0.3")
    above.set(ylabel="curvature κ [1/m]", ylim=(0, highest))
    below.set(xlabel="distance flown [m]", ylabel="pitch [°]")
    below.set_ylim(*(1.25 * max(np.degrees(max_pitch), *np.abs(below.get_ylim())) * np.array([-1, 1])))
    figure.legend(fontsize=8, loc="outside upper center", ncols=4)
    for axes in (above, below):
        axes.grid(alpha=0.3)
        axes.margins(x=0.01)
    return finished(figure)


def corner(
    city: City,
    *curves: Curve | Mapping[str, Curve],
    center: npt.ArrayLike,
    reach: float,
    uav_diameter: float,
    route: Drawn | None = None,
) -> Figure:
    """Curves about a point from above, as wide as the body, with their control points; obstacles at its height dark.

    Where the body touches an obstacle the curve is drawn in thick orange.

    Parameters
    ----------
    city : City
        Whose obstacles are shown.
    curves : Curve, or mapping of curves by name
        A panel for each, at least one.
    center : (3,) array
        Where to look [m].
    reach : float
        How far to see to each side [m], above 0.
    uav_diameter : float
        Of the body [m], above 0.
    route : Route, or mapping with one, optional
        What was smoothed; drawn dashed.

    Returns
    -------
    matplotlib.figure.Figure
        A panel for each curve, with its least clearance and its sharpest curvature in the title.

    Raises
    ------
    ValueError
        If `city` is no `City`; `curves` is empty or holds anything else than curves; `center` is not three finite
        numbers or its height lies outside of the map; `reach` or `uav_diameter` is not above 0; or `route` is no
        route.

    See Also
    --------
    uavlab.spline.smooth : Makes curves that touch nothing.
    curve_profile : Curvature and pitch along curves.
    section : The whole map at a height.

    Examples
    --------
    >>> import numpy as np
    >>> from uavlab import plot
    >>> from uavlab.city import table1_city
    >>> from uavlab.spline import Curve
    >>> curve = Curve(np.array([[50.0, 12, 30], [58, 10, 30], [66, 18, 30], [72, 10, 30]]), planner="through")
    >>> figure = plot.corner(table1_city(), curve, center=(64, 15, 30), reach=8.0, uav_diameter=2.0)
    >>> figure.axes[0].get_title()
    'through: 0.00 m clear, κ ≤ 0.33 1/m'
    """
    checks.instance("city", city, City)
    planned = [] if route is None else named_routes(route, "route")
    drawn = drawn_curves(curves)
    x, y, z = checks.array("center", center, 3).tolist()
    reach = checks.positive_number("reach", reach)
    uav_diameter = checks.positive_number("uav_diameter", uav_diameter)
    k = level_of(city, z, "center's height")
    layer = np.where(city.occupied[:, :, k], 1.0, np.nan)
    figure, panels = plt.subplots(1, len(drawn), figsize=(0.8 + 3.7 * len(drawn), 4.4), dpi=DPI, squeeze=False,
                                  sharey=True, layout="constrained")  # fmt: skip
    for axes, curve in zip(panels[0], drawn, strict=True):
        draw_map(axes, city, layer, "Greys", vmin=0.0, vmax=1.6)
        draw_cut(axes, city, k)
        for way in planned:
            axes.plot(*way.points[:, :2].T, "--", color=BLACK, linewidth=1.2, label=label_of(way))
        axes.add_collection(PolyCollection(list(swept(curve, uav_diameter)), facecolor=BLUE, alpha=0.35))
        axes.plot(*curve.points[:, :2].T, color=BLUE, label=f"curve and its body of {uav_diameter:g} m")
        touches = np.append(curve.least_distances(city, uav_diameter) < contact_distance(uav_diameter), False)
        axes.plot(*np.where(touches[:, None], curve.points, np.nan)[:, :2].T, color=ORANGE, linewidth=4,
                  label="touches an obstacle")  # fmt: skip
        axes.plot(*curve.control[:, :2].T, "o", color=BLACK, markersize=4, label="control points")
        axes.set(xlim=(x - reach, x + reach), ylim=(y - reach, y + reach))
        clear, sharpest = curve.clearance(city), curve.curvature.max()
        axes.set_title(f"{plain(curve.planner)}: {clear:.2f} m clear, κ ≤ {sharpest:.2f} 1/m", fontsize=9)
    for axes in panels[0, 1:]:
        axes.set_ylabel("")
    handles, names = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, names, loc="outside lower center", ncols=len(names), fontsize=8)
    return finished(figure)


def swept(curve: Curve, width: float) -> np.ndarray:
    """Corners of a quadrilateral between each two points of a curve, (P − 1, 4, 2) [m]: a band on the ground plan."""
    east, north = curve.tangent[:, :2].T
    side = np.column_stack([-north, east]) / np.maximum(np.hypot(east, north), 1e-9)[:, None] * width / 2
    left, right = curve.points[:, :2] + side, curve.points[:, :2] - side
    return np.stack([left[:-1], left[1:], right[1:], right[:-1]], axis=1)


def drawn_curves(curves: Sequence[Curve | Mapping[str, Curve]]) -> list[Curve]:
    """Curves to draw, each with its name as its planner; what isn't one is refused, and none at all."""
    drawn: list[Curve] = []
    for one in curves:
        for name, curve in one.items() if isinstance(one, Mapping) else [(None, one)]:
            checks.instance("curves", curve, Curve)
            drawn.append(curve if name is None else replace(curve, planner=str(name)))
    if not drawn:
        raise ValueError("curves is empty: give at least one, as from smooth(route, city, uav)")
    return drawn
