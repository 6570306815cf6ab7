"""Quantities along a route, of several planners, or by name."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import cycle

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from uavlab import checks
from uavlab.city import City
from uavlab.planners.comparison import Comparison
from uavlab.plot.colors import BLUE, LINES, Style, styles
from uavlab.plot.ground import CUT_COLOR, datum_of, ground_below, height_label
from uavlab.plot.style import (
    DPI,
    Drawn,
    drawn_routes,
    finished,
    label_of,
    named_routes,
    new_figure,
    plain,
)
from uavlab.route import Route

MOST_BARS = 1000
"""In one figure."""


def front(
    routes: Sequence[Route],
    *marked: Route | Mapping[str, Route],
    label: str = "risk ∫ r ds/dx [1/h]",
    colors: Mapping[str, str] | None = None,
) -> Figure:
    """Length against risk (the routes' `cost`): a Pareto front as a line with its points, other routes marked.

    Parameters
    ----------
    routes : sequence of Route
        As from `pareto_front`.
    marked : Route, or mapping
        Others to compare, by name if it is a mapping, each with its cost in the same unit; the first five are drawn.
    label : str
        Of the vertical axis, with a unit.
    colors : mapping of str, optional
        Name → colour, for what should look the same elsewhere, as for `styles`.

    Returns
    -------
    matplotlib.figure.Figure
        Length [m] across, risk up on a logarithmic scale.

    Raises
    ------
    ValueError
        If `routes` is no list of `Route` or none of them arrives, one of `marked` is neither a route nor a mapping of
        routes, one that arrives has no cost, `label` is no text, or `colors` are no colours by name.

    See Also
    --------
    uavlab.planners.pareto_front : Finds the front.
    risk : Shows one of the routes on the map.

    Examples
    --------
    >>> from uavlab import plot
    >>> from uavlab.planners import pareto_front
    >>> from uavlab.risk import CAMPUS_FLIGHT, reference_campus
    >>> figure = plot.front(pareto_front(reference_campus(), *CAMPUS_FLIGHT))
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_yscale()
    ('length [m]', 'log')
    """
    routes = checks.several("routes", routes, Route, least=0)
    others = [route for one in marked for route in named_routes(one, "marked")]
    checks.text("label", label)
    for name, ways in (("routes", routes), ("marked", others)):
        if any(route.reached and np.isnan(route.cost) for route in ways):
            raise ValueError(f"{name} must have a cost, as those of planners; RiskMap.integral(route) gives it")
    if not any(route.reached for route in routes):
        why = f": {routes[0].reason}" if routes else ", it is empty"
        raise ValueError(f"routes must hold one that arrives{why}")
    figure, axes = new_figure(6.4, 4.2)
    looks = styles(["Pareto front", *(route.planner for route in others)], colors)
    axes.plot([r.length for r in routes], [r.cost for r in routes], "o-", color=looks[0].color, label="Pareto front",
              drawstyle="steps-post", linewidth=1)  # fmt: skip
    for route, look, marker in zip(others, looks[1:], cycle("^sDvP"), strict=False):
        axes.plot(route.length, route.cost, marker, color=look.color, markersize=9, label=label_of(route))
    axes.set(xlabel="length [m]", ylabel=label, yscale="log")
    axes.grid(alpha=0.3, which="both")
    axes.legend(fontsize=8)
    return finished(figure)


def convergence(
    comparison: Comparison,
    by: str = "evaluations",
    *,
    until: int | None = None,
    colors: Mapping[str, str] | None = None,
) -> Figure:
    """How planners came near the exact optimum: median gap over maps and seeds, with a band between the quartiles.

    The scale is linear up to a gap of 10 % and logarithmic beyond. A line begins where half of the runs have a route,
    and a band ends where a quarter of them has none.

    Parameters
    ----------
    comparison : Comparison
        Of one to seven planners.
    by : {"evaluations", "iterations"}
        What counts as effort.
    until : int, optional
        Last evaluation or iteration to show, at least 2; by default all of them.
    colors : mapping of str, optional
        Name → colour, for what should look the same elsewhere, as for `styles`.

    Returns
    -------
    matplotlib.figure.Figure
        Effort across, gap [%] up.

    Raises
    ------
    ValueError
        If `comparison` is no `Comparison`, has more than seven planners, or none that has a route in half of its runs;
        `by` is neither "evaluations" nor "iterations"; `until` is no whole number of at least 2; or `colors` are no
        colours by name.

    See Also
    --------
    uavlab.planners.compare_planners : Makes the runs.
    uavlab.planners.optimality_gap : What is drawn, of one route.

    Examples
    --------
    >>> from uavlab import plot
    >>> from uavlab.planners import ant_colony, compare_planners
    >>> from uavlab.risk import reference_campus
    >>> ants = {"ants": ant_colony}
    >>> comparison = compare_planners(ants, reference_campus(), seeds=range(2), budget=200, progress=False)
    >>> figure = plot.convergence(comparison)
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_yscale()
    ('evaluations made', 'symlog')
    """
    checks.instance("comparison", comparison, Comparison)
    checks.one_of("by", by, ("evaluations", "iterations"))
    if until is not None:
        until = checks.whole("until", until, least=2)
    if len(comparison.planners) > len(LINES):
        raise ValueError(f"comparison must have at most {len(LINES)} planners, to tell their lines apart")
    figure, axes = new_figure(8.4, 4.4)
    runs = zip(comparison.planners, comparison.histories, comparison.iterations, strict=True)
    for (name, histories, ends), (color, style) in zip(runs, styles(comparison.planners, colors), strict=True):
        made = np.arange(1, histories.shape[-1] + 1) if by == "evaluations" else ends
        effort = made if by == "evaluations" else np.arange(1, len(ends) + 1)
        gaps = 100 * histories.reshape(-1, histories.shape[-1])[:, made - 1]
        low, high = np.quantile(gaps, [0.25, 0.75], axis=0, method="nearest")
        shown = slice(until)
        axes.plot(effort[shown], finite_or_nan(np.median(gaps, axis=0))[shown], color=color, linestyle=style,
                  linewidth=2, label=plain(name))  # fmt: skip
        axes.fill_between(effort[shown], finite_or_nan(low)[shown], finite_or_nan(high)[shown], color=color, alpha=0.13,
                          linewidth=0)  # fmt: skip
    if not any(np.isfinite(line.get_ydata()).any() for line in axes.lines):
        raise ValueError("comparison must have a planner with a route in half of its runs, to have a median gap")
    axes.axhline(0.0, color="0.4", linewidth=1)
    axes.annotate("exact optimum on the grid", (0.99, 0.0), (0, -3), xycoords=("axes fraction", "data"),
                  textcoords="offset points", ha="right", va="top", fontsize=8, color="0.3")  # fmt: skip
    set_gap_scale(axes, f"{by} made")
    axes.legend(title="median, band: quartiles", title_fontsize=8, fontsize=8, loc="upper left",
                bbox_to_anchor=(1.0, 1.0), handlelength=4.5)  # fmt: skip
    return finished(figure)


def set_gap_scale(axes: Axes, label: str) -> None:
    """A gap in per cent up, linear near 0 and logarithmic beyond; the last of its lines marks the optimum."""
    axes.set_yscale("symlog", linthresh=10.0, linscale=1.0)
    axes.set_yticks([-10, -5, 0, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000], minor=False)
    axes.yaxis.set_major_formatter("{x:g} %")
    axes.yaxis.set_minor_locator(NullLocator())
    effort, gaps = np.concatenate([line.get_xydata() for line in axes.lines[:-1]]).T
    axes.set(
        xlabel=label,
        ylabel="gap to the exact optimum\n(linear to 10 %, logarithmic beyond)",
        xlim=(0, effort.max()),
    )
    axes.set_ylim(min(-2.0, 1.2 * np.nanmin(gaps)), max(12.0, 1.5 * np.nanmax(gaps)))
    axes.xaxis.set_major_formatter("{x:,g}")
    axes.grid(alpha=0.3)


def finite_or_nan(values: np.ndarray) -> np.ndarray:
    """The values, those that aren't finite as NaN, where nothing is drawn."""
    return np.where(np.isfinite(values), values, np.nan)


def profile(
    city: City, *routes: Drawn, safe_distance: float | None = None, colors: Mapping[str, str] | None = None
) -> Figure:
    """Height and clearance along routes, with the distance to keep as a line if it is given.

    The clearance is the exact distance to the nearest obstacle, every quarter of a voxel and where it is least. Lines
    that coincide show as one within the other.

    On level ground heights are counted from it. Else they are z of the map, and the ground below each route is an
    area: brown, or of several routes in their colours. Dotted lines are the tops of the occupied voxels below.

    Parameters
    ----------
    city : City
        To which the clearance is measured.
    routes : Route or Curve, or mapping
        By name if it is a mapping.
    safe_distance : float, optional
        Distance to keep [m], above 0; 1 to 6 is usual.
    colors : mapping of str, optional
        Name → colour, for what should look the same elsewhere, as for `styles`.

    Returns
    -------
    matplotlib.figure.Figure
        Height [m] above, clearance [m] below, both over the distance flown [m].

    Raises
    ------
    ValueError
        If `city` is no `City`, one of `routes` is neither a route nor a curve, `safe_distance` is not above 0, or
        `colors` are no colours by name.

    See Also
    --------
    plan : The same routes from above.
    curve_profile : Curvature and pitch along curves.
    uavlab.resilience.safe_distance : The distance to keep in a wind.

    Examples
    --------
    >>> from uavlab import plot
    >>> from uavlab.city import table1_city
    >>> from uavlab.planners import astar
    >>> city = table1_city()
    >>> figure = plot.profile(city, astar(city, (90, 18, 30), (50, 44, 30), min_clearance=3), safe_distance=3.0)
    >>> [axes.get_ylabel() for axes in figure.axes]
    ['height above the ground [m]', 'clearance [m]']
    >>> f"{figure.axes[1].lines[0].get_ydata().min():.2f} m"  # the least clearance on the way
    '3.50 m'
    """
    planned = drawn_routes(city, routes)
    if safe_distance is not None:
        safe_distance = checks.positive_number("safe_distance", safe_distance)
    figure, (above, below) = plt.subplots(2, 1, sharex=True, figsize=(7.2, 4.6), dpi=DPI, layout="constrained")
    zero = datum_of(city) or 0.0
    looks = styles([route.planner for route in planned], colors)
    drawn = [(route, look) for route, look in zip(planned, looks, strict=True) if len(route.points) > 1]
    for number, (route, (color, line)) in enumerate(drawn):
        look = {"color": color, "linestyle": line, "linewidth": max(3.2 - 0.8 * number, 1.2)}
        above.plot(route.distance, route.points[:, 2] - zero, label=label_of(route), **look)
        below.plot(*route.clearance_profile(city), **look)
    if safe_distance is not None:
        below.axhline(safe_distance, color="0.3", linewidth=1)
        below.annotate(f"to keep: {safe_distance:g} m", (0.995, safe_distance), xycoords=("axes fraction", "data"),
                       ha="right", va="bottom", fontsize=8, color="0.3")  # fmt: skip
    lowest = 0.0
    if drawn and city.ground is not None:
        lowest = draw_below(above, city, drawn, zero)
    above.set_ylabel(height_label(city))
    below.set_ylabel("clearance [m]")
    below.set_xlabel("distance flown [m]")
    if above.lines:
        figure.legend(loc="outside upper center", ncols=2, fontsize=8, handlelength=4.0)
    for axes in (above, below):
        axes.grid(alpha=0.3)
        axes.margins(x=0.01)
        axes.set_ylim(lowest if axes is above else 0.0, 1.05 * axes.get_ylim()[1])
    return finished(figure)


def draw_below(axes: Axes, city: City, drawn: Sequence[tuple[Route, Style]], zero: float) -> float:
    """Ground and obstacles below each route, above height `zero`; returns the lowest height."""
    ways = [(route.resample(city.cell / 2), look.color) for route, look in drawn]
    grounds = [ground_below(city, way.points) - zero for way, _ in ways]
    lowest = min(0.0, *(float(ground.min()) for ground in grounds))
    alone = len(ways) == 1
    for (way, color), ground in zip(ways, grounds, strict=True):
        shade, alpha = (CUT_COLOR, 0.75) if alone else (color, 0.25)
        axes.fill_between(way.distance, lowest, ground, linewidth=0, color=shade, alpha=alpha)
        axes.plot(way.distance, tops_below(city, way.points) - zero, color=color, linewidth=0.8, linestyle=":")
    shade, name = (CUT_COLOR, "ground") if alone else ("0.8", "ground below each route")
    axes.fill_between([], [], [], linewidth=0, color=shade, alpha=0.75, label=name)
    axes.plot([], [], color="0.3", linewidth=0.8, linestyle=":", label="occupied voxels below it")
    return lowest


def tops_below(city: City, points: np.ndarray) -> np.ndarray:
    """Height z of the highest occupied voxel at or below each of the points (N, 3), (N,) [m]."""
    i, j, k = np.clip(city.cell_of(points), 0, np.array(city.shape) - 1).T
    below = city.occupied[i, j] & (np.arange(city.shape[2]) <= k[:, None])
    layers = city.shape[2] - below[:, ::-1].argmax(axis=1)
    return city.origin[2] + city.cell * np.where(below.any(axis=1), layers, 0)


def bars(values: Mapping[str, float], label: str, *, title: str = "") -> Figure:
    """Named values as horizontal bars, each with its number.

    Parameters
    ----------
    values : dict of float
        By name, drawn from top to bottom, at most a thousand; NaN has no bar.
    label : str
        The quantity and its unit, below the axis.
    title : str
        Above the bars; none by default.

    Returns
    -------
    matplotlib.figure.Figure
        One panel, a bar for each name.

    Raises
    ------
    ValueError
        If `values` are no numbers by name, one of them is infinite, or they are more than a thousand, or `label` or
        `title` is no text.

    See Also
    --------
    crash_rates : Rates with their intervals.
    profile : How a quantity changes along a route.

    Examples
    --------
    >>> from uavlab import plot
    >>> figure = plot.bars({"A*": 66.4, "any angle": 63.9}, "length [m]")
    >>> [text.get_text() for text in figure.axes[0].texts]
    ['66.4', '63.9']
    """
    checks.text("label", label)
    checks.text("title", title)
    named = checks.by_name("values", values, least=0)
    lengths = [checks.number(f"values[{name!r}]", value) for name, value in named.items()]
    if np.isinf(lengths).any():
        raise ValueError(f"values must be finite, or NaN for no bar, got {lengths}")
    if len(lengths) > MOST_BARS:
        raise ValueError(f"values must be at most {MOST_BARS:,}, got {len(lengths):,}")
    figure, axes = plt.subplots(figsize=(6.4, 0.5 * len(lengths) + 1.1), dpi=DPI, layout="constrained")
    drawn = axes.barh([plain(name) for name in named], lengths, color=BLUE)
    axes.bar_label(drawn, [f"{v:,.0f}" if abs(v) >= 100 else f"{v:.3g}" for v in lengths], padding=3)
    axes.invert_yaxis()
    axes.xaxis.set_major_formatter("{x:,g}")
    axes.set_xlabel(label)
    axes.set_title(title)
    axes.margins(x=0.15)
    axes.spines[["top", "right"]].set_visible(False)
    return finished(figure)
