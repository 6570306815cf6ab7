"""Figures in matplotlib: plans from above, profiles along a route, sections, stills of a scene.

Every function returns a `Figure`: the last line of a notebook's cell shows it, `figure.savefig("name.png")` writes it.
Colours are those of Okabe and Ito, or of a map that is even in lightness, so that colour-blind readers can tell them
apart.
"""

from collections.abc import Mapping, Sequence
from itertools import cycle
from typing import Any

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.colors import LogNorm, Normalize, to_hex, to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator, NullLocator
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from uavlab import checks
from uavlab.city import City
from uavlab.flight import Flight, Rate
from uavlab.offsets import SafetyDomain
from uavlab.planners.comparison import Comparison
from uavlab.planners.potential_field import potential_forces
from uavlab.risk import RiskMap
from uavlab.route import Route
from uavlab.spline import Curve
from uavlab.spline.limits import BANK, MAX_PITCH
from uavlab.vehicle import GRAVITY

ROUTE_COLORS = ("#D55E00", "#0072B2", "#000000", "#CC79A7", "#009E73", "#E69F00")
CONVERGENCE_STYLES = tuple(zip(ROUTE_COLORS, ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (8, 2))), strict=True))
"""Colour and line style of one planner among several: told apart in grey, too."""

CRASH_COLOR = "#D00000"
"""Of an X; nothing else has that shape, for readers to whom red is brown."""

TRACK_STEP = 0.2
"""From point to point of a flight's track [s]."""

SEQUENTIAL = matplotlib.colormaps["cividis"]
DPI = 100
SUN = np.array([-0.45, -0.7, 0.55])
"""Where the light comes from in a still."""


def route_colors(count: int) -> list[str]:
    """A colour for each of `count` routes, as #rrggbb."""
    return [ROUTE_COLORS[i % len(ROUTE_COLORS)] for i in range(count)]


def sequential_color(share: float) -> str:
    """The colour of a share from 0 (dark) to 1 (bright), as #rrggbb."""
    return to_hex(SEQUENTIAL(share))


def plan(city: City, *routes: Route) -> Figure:
    """The city from above, darker where it is higher, with routes.

    Parameters
    ----------
    city : City
    routes : Route
        Those without points are named in the legend.
    """
    check_drawn(city, routes)
    figure, axes = new_figure(6.4, 5.4)
    tops = np.where(city.occupied, (np.arange(city.shape[2]) + 1) * city.cell, 0).max(axis=2)
    image = draw_map(axes, city, np.where(tops > 0, tops, np.nan), "Greys", vmin=0.0, vmax=1.3 * max(tops.max(), 1.0))
    add_color_bar(figure, axes, image, "top of the buildings above the ground [m]").ax.set_ylim(0, max(tops.max(), 1.0))
    draw_routes(axes, routes)
    axes.set_title(city.name)
    return finished(figure)


RISK_LABEL = "risk r [deaths per hour of flight]"


def section(
    city: City,
    height: float,
    values: np.ndarray | None = None,
    *routes: Route,
    label: str = "clearance [m]",
    norm: Normalize | None = None,
) -> Figure:
    """A horizontal section: buildings black, and values of the voxels at this height in colour.

    Parameters
    ----------
    city : City
    height : float
        Where to cut [m].
    values : (nx, ny, nz) array, optional
        What to colour; the clearance by default.
    routes : Route
        Seen from above.
    label : str
        Of the colour bar, with a unit.
    norm : matplotlib.colors.Normalize, optional
        From values to colours; by default evenly over the values shown.

    Raises
    ------
    ValueError
        If the height lies outside of the map.
    """
    check_drawn(city, routes)
    k = level_of(city, height)
    figure, axes = new_figure(6.4, 5.4)
    layer = (city.clearance if values is None else np.asarray(values))[:, :, k]
    image = draw_map(axes, city, np.where(city.occupied[:, :, k], np.nan, layer), SEQUENTIAL, norm=norm)
    add_color_bar(figure, axes, image, label)
    axes.set_facecolor("black")
    draw_routes(axes, routes)
    axes.set_title(f"{city.name}, {height:g} m above the ground (buildings black)")
    return finished(figure)


def field(
    city: City,
    height: float,
    goal: npt.ArrayLike,
    *routes: Route,
    area: tuple[float, float, float, float] | None = None,
    spacing: float = 3.0,
    **setting: Any,
) -> Figure:
    """A potential field in a horizontal section: its potential as colours and lines, arrows along its force.

    Parameters
    ----------
    city : City
    height : float
        Where to cut [m].
    goal : (3,) array
        What attracts [m].
    routes : Route
        Seen from above.
    area : (west, east, south, north), optional
        Part of the map to show [m]; by default all of it.
    spacing : float
        From arrow to arrow [m].
    setting
        Of the field, as for `potential_forces`.

    Raises
    ------
    ValueError
        If the height lies outside of the map, or an argument is out of its range.
    """
    check_drawn(city, routes)
    checks.positive("spacing", spacing)
    k = level_of(city, height)
    west, east, south, north = (*city.bounds[:, 0], *city.bounds[:, 1]) if area is None else area

    def sampled(step: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        x, y = np.meshgrid(np.arange(west + step / 2, east, step), np.arange(south + step / 2, north, step))
        points = np.stack([x, y, np.full(x.shape, height)], axis=-1)
        pull, push, potential = potential_forces(city, points, goal, **setting)
        free = city.is_free(points)
        return points, np.where(free[..., None], pull + push, np.nan), np.where(free, potential, np.nan)

    figure, axes = new_figure(6.4, 5.4)
    draw_map(axes, city, np.where(city.occupied[:, :, k], 1.0, np.nan), "gray_r", vmin=0, vmax=1)
    points, _, potential = sampled(max(east - west, north - south) / 200)
    levels = MaxNLocator(20).tick_values(np.nanmin(potential), np.nanquantile(potential, 0.93))  # walls rise out of it
    image = axes.contourf(*points[..., :2].T, potential.T, levels, cmap=SEQUENTIAL, extend="max")
    axes.contour(*points[..., :2].T, potential.T, levels, colors="white", linewidths=0.4)
    add_color_bar(figure, axes, image, "potential U [unit of force · m]")
    points, force, _ = sampled(spacing)
    with np.errstate(invalid="ignore"):
        direction = force / np.linalg.norm(force, axis=-1, keepdims=True)
    axes.quiver(*points[..., :2].T, *direction[..., :2].T, pivot="mid", angles="xy", scale_units="xy",
                scale=1.2 / spacing, width=0.005, edgecolor="white", linewidth=0.5)  # fmt: skip
    draw_routes(axes, routes)
    axes.set(xlim=(west, east), ylim=(south, north))
    axes.set_title(f"{city.name}, {height:g} m above the ground (buildings black)")
    return finished(figure)


def risk(risk_map: RiskMap, height: float, *routes: Route) -> Figure:
    """The risk of flying at a height; buildings black, hatched where the UAV would be too low.

    Colours are a scale of factors, the same at all heights.

    Parameters
    ----------
    risk_map : RiskMap
    height : float
        Where to cut [m].
    routes : Route
        Seen from above.

    Raises
    ------
    ValueError
        If the height lies outside of the map.
    """
    checks.instance("risk_map", risk_map, RiskMap)
    city = risk_map.city
    k = level_of(city, height)
    figure = section(city, height, risk_map.rate, *routes, label=RISK_LABEL, norm=risk_norm(risk_map))
    too_low = ~(risk_map.flyable | city.occupied)[:, :, k]
    if too_low.any():
        axes = figure.axes[0]
        axes.set_title(f"{city.name}, {height:g} m above the ground (too low hatched)")
        axes.contourf(
            city.coordinates(0), city.coordinates(1), too_low.T, levels=[0.5, 1.5], colors="none", hatches=["////"]
        )
    return finished(figure)


def layers(risk_map: RiskMap) -> Figure:
    """What a risk map was made from: people, shelter and cars, on three plans."""
    checks.instance("risk_map", risk_map, RiskMap)
    figure, panels = plt.subplots(1, 3, figsize=(11.4, 4.0), dpi=DPI, layout="constrained", sharey=True)
    shown = (
        (1e3 * risk_map.population_density, "thousands of people per km²"),
        (risk_map.shelter, "shelter $p_s$ (0 none, 1 industry)"),
        (1e6 * risk_map.vehicle_share, "ground under cars [m² per km²]"),
    )
    for axes, (layer, label) in zip(panels, shown, strict=True):
        image = draw_map(axes, risk_map.city, layer, SEQUENTIAL)
        figure.colorbar(image, ax=axes, location="bottom", label=label)
    for axes in panels[1:]:
        axes.set_ylabel("")
    return finished(figure)


def front(routes: Sequence[Route], *marked: Route, label: str = "risk ∫ r ds/dx [1/h]") -> Figure:
    """Length against risk (the routes' `cost`): a Pareto front as a line with its points, other routes marked.

    Parameters
    ----------
    routes : sequence of Route
        As from `pareto_front`.
    marked : Route
        Others to compare, each with its cost in the same unit.
    label : str
        Of the vertical axis, with a unit.

    Raises
    ------
    ValueError
        If none of the routes arrives.
    """
    if not isinstance(routes, Sequence):
        raise ValueError(f"routes must be a list, as from pareto_front, got {type(routes).__name__}")
    for route in (*routes, *marked):
        checks.instance("routes", route, Route)
    if not any(route.reached for route in routes):
        why = f": {routes[0].reason}" if routes else ", it is empty"
        raise ValueError(f"routes must hold one that arrives{why}")
    figure, axes = new_figure(6.4, 4.2)
    axes.plot([r.length for r in routes], [r.cost for r in routes], "o-", color=ROUTE_COLORS[1], label="Pareto front",
              drawstyle="steps-post", linewidth=1)  # fmt: skip
    colors = [color for color in ROUTE_COLORS if color != ROUTE_COLORS[1]]
    styles = cycle(zip(colors, "^sDvP", strict=True))
    for route, (color, marker) in zip(marked, styles, strict=False):
        axes.plot(route.length, route.cost, marker, color=color, markersize=9, label=label_of(route))
    axes.set(xlabel="length [m]", ylabel=label, yscale="log")
    axes.grid(alpha=0.3, which="both")
    axes.legend(fontsize=8)
    return finished(figure)


def convergence(
    comparison: Comparison,
    by: str = "evaluations",
    *,
    until: int | None = None,
) -> Figure:
    """How planners came near the exact optimum: median gap over maps and seeds, with a band between the quartiles.

    The gap is even up to 10 % and by factors beyond. A line begins where half of the runs have a route, and a band
    ends where a quarter of them has none.

    Parameters
    ----------
    comparison : Comparison
    by : {"evaluations", "iterations"}
        What counts as effort.
    until : int, optional
        Last evaluation or iteration to show; by default all of them.

    Raises
    ------
    ValueError
        If `by` is neither, `until` is below 2, there are more than six planners, or no planner has a route in half of
        its runs.
    """
    if not isinstance(comparison, Comparison):
        raise ValueError(f"comparison must be a Comparison, as from compare_planners, got {type(comparison).__name__}")
    if by not in ("evaluations", "iterations"):
        raise ValueError(f"by must be 'evaluations' or 'iterations', got {by!r}")
    if until is not None:
        checks.whole("until", until, least=2)
    if len(comparison.planners) > len(CONVERGENCE_STYLES):
        raise ValueError(f"comparison must have at most {len(CONVERGENCE_STYLES)} planners, to tell their lines apart")
    figure, axes = new_figure(8.4, 4.4)
    runs = zip(comparison.planners, comparison.histories, comparison.iterations, strict=True)
    for (name, histories, ends), (color, style) in zip(runs, CONVERGENCE_STYLES, strict=False):
        made = np.arange(1, histories.shape[-1] + 1) if by == "evaluations" else ends
        effort = made if by == "evaluations" else np.arange(1, len(ends) + 1)
        gaps = 100 * histories.reshape(-1, histories.shape[-1])[:, made - 1]
        low, high = np.quantile(gaps, [0.25, 0.75], axis=0, method="nearest")
        shown = slice(until)
        axes.plot(effort[shown], finite_or_nan(np.median(gaps, axis=0))[shown], color=color, linestyle=style,
                  linewidth=2, label=name)  # fmt: skip
        axes.fill_between(effort[shown], finite_or_nan(low)[shown], finite_or_nan(high)[shown], color=color, alpha=0.13,
                          linewidth=0)  # fmt: skip
    if not any(np.isfinite(line.get_ydata()).any() for line in axes.lines):
        raise ValueError("comparison must have a planner with a route in half of its runs, to have a median gap")
    axes.axhline(0.0, color="0.4", linewidth=1)
    axes.annotate("exact optimum on the grid", (0.99, 0.0), (0, -3), xycoords=("axes fraction", "data"),
                  textcoords="offset points", ha="right", va="top", fontsize=8, color="0.3")  # fmt: skip
    axes.set_yscale("symlog", linthresh=10.0, linscale=1.0)
    axes.set_yticks([-10, -5, 0, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000], minor=False)
    axes.yaxis.set_major_formatter("{x:g} %")
    axes.yaxis.set_minor_locator(NullLocator())
    effort, gaps = np.concatenate([line.get_xydata() for line in axes.lines[:-1]]).T
    axes.set(xlabel=f"{by} made", ylabel="gap to the exact optimum", xlim=(0, effort.max()))
    axes.set_ylim(min(-2.0, 1.2 * np.nanmin(gaps)), max(12.0, 1.5 * np.nanmax(gaps)))
    axes.xaxis.set_major_formatter("{x:,g}")
    axes.grid(alpha=0.3)
    axes.legend(title="median, band: quartiles", title_fontsize=8, fontsize=8, loc="upper left",
                bbox_to_anchor=(1.0, 1.0))  # fmt: skip
    return finished(figure)


def finite_or_nan(values: np.ndarray) -> np.ndarray:
    """The values, those that aren't finite as NaN, where nothing is drawn."""
    return np.where(np.isfinite(values), values, np.nan)


def profile(city: City, *routes: Route, safe_distance: float | None = None) -> Figure:
    """Height and clearance along routes, with the distance to keep as a dashed line if it is given [m]."""
    check_drawn(city, routes)
    figure, (above, below) = plt.subplots(2, 1, sharex=True, figsize=(7.2, 4.6), dpi=DPI, layout="constrained")
    for route, color in zip(routes, route_colors(len(routes)), strict=True):
        if len(route.points) < 2:
            continue
        above.plot(route.distance, route.points[:, 2] - city.origin[2], color=color, label=label_of(route))
        distance, clearance = route.clearance_profile(city)
        below.plot(distance, clearance, color=color)
    if safe_distance is not None:
        below.axhline(safe_distance, color="0.3", linestyle="--", linewidth=1)
        below.annotate(f"to keep: {safe_distance:g} m", (0.995, safe_distance), xycoords=("axes fraction", "data"),
                       ha="right", va="bottom", fontsize=8, color="0.3")  # fmt: skip
    above.set_ylabel("height [m]")
    below.set_ylabel("clearance [m]")
    below.set_xlabel("distance flown [m]")
    if above.lines:
        above.legend(fontsize=8)
    for axes in (above, below):
        axes.grid(alpha=0.3)
        axes.margins(x=0.01)
        axes.set_ylim(0, 1.05 * axes.get_ylim()[1])
    return finished(figure)


def curve_profile(
    *curves: Curve, speed: float, cell: float, bank: float = BANK, max_pitch: float = MAX_PITCH
) -> Figure:
    """Curvature and pitch along curves, with the papers' limits and ours (RISK-ACO Figs 9-10, PSO-BAS Figs 7-8).

    Parameters
    ----------
    curves : Curve
    speed : float
        v [m/s], above 0: a bank holds a level turn up to the curvature g·tan(bank)/v².
    cell : float
        Edge of a voxel [m], above 0: the papers ask for a curvature below 1 per voxel.
    bank, max_pitch : float
        [rad]

    Raises
    ------
    ValueError
        If there is no curve, or a number is not above 0.
    """
    check_curves(curves)
    for name, value in (("speed", speed), ("cell", cell), ("bank", bank), ("max_pitch", max_pitch)):
        checks.positive_number(name, value)
    figure, (above, below) = plt.subplots(2, 1, sharex=True, figsize=(8.4, 5.4), dpi=DPI, layout="constrained")
    for curve, color in zip(curves, route_colors(len(curves)), strict=True):
        above.plot(curve.distance, finite_or_nan(curve.curvature), color=color, label=curve.planner)
        above.plot(curve.distance, finite_or_nan(curve.level_curvature), ":", color=color, linewidth=1.2)
        below.plot(curve.distance, np.degrees(curve.pitch), color=color)
    above.plot([], ":", color="0.3", linewidth=1.2, label="level part of it")
    limits = (
        (above, 1 / cell, f"papers: 1 per\nvoxel of {cell:g} m"),
        (above, GRAVITY * np.tan(bank) / speed**2, f"{np.degrees(bank):.0f}° of bank\nat {speed:g} m/s"),
        (below, np.degrees(max_pitch), f"±{np.degrees(max_pitch):.0f}°"),
        (below, -np.degrees(max_pitch), ""),
    )
    for axes, limit, text in limits:
        axes.axhline(limit, color="0.3", linestyle="--", linewidth=1)
        axes.annotate(text, (1.01, limit), xycoords=("axes fraction", "data"), va="center", fontsize=8, color="0.3")
    above.set(ylabel="curvature κ [1/m]", ylim=(0, 1.15 * max(above.get_ylim()[1], 1 / cell)))
    below.set(xlabel="distance flown [m]", ylabel="pitch [°]")
    below.set_ylim(*(1.25 * max(np.degrees(max_pitch), *np.abs(below.get_ylim())) * np.array([-1, 1])))
    figure.legend(fontsize=8, loc="outside upper center", ncols=4)
    for axes in (above, below):
        axes.grid(alpha=0.3)
        axes.margins(x=0.01)
    return finished(figure)


def corner(
    city: City, *curves: Curve, center: npt.ArrayLike, reach: float, diameter: float, route: Route | None = None
) -> Figure:
    """Curves about a point from above, as wide as the body, and with their control points; voxels at its height black.

    Where the body touches an obstacle the curve is drawn in thick orange.

    Parameters
    ----------
    city : City
    curves : Curve
        A panel for each.
    center : (3,) array
        Where to look [m].
    reach : float
        How far to see to each side [m], above 0.
    diameter : float
        Of the body [m], above 0.
    route : Route, optional
        What was smoothed; drawn dashed.

    Raises
    ------
    ValueError
        If there is no curve, the point's height isn't on the map, or a number is not above 0.
    """
    check_drawn(city, () if route is None else (route,))
    check_curves(curves)
    x, y, z = checks.three("center", center)
    for name, value in (("reach", reach), ("diameter", diameter)):
        checks.positive_number(name, value)
    layer = np.where(city.occupied[:, :, level_of(city, z)], 1.0, np.nan)
    figure, panels = plt.subplots(1, len(curves), figsize=(0.8 + 3.7 * len(curves), 4.4), dpi=DPI, squeeze=False,
                                  sharey=True, layout="constrained")  # fmt: skip
    for axes, curve in zip(panels[0], curves, strict=True):
        draw_map(axes, city, layer, "Greys", vmin=0.0, vmax=1.6)
        if route is not None:
            axes.plot(*route.points[:, :2].T, "--", color=ROUTE_COLORS[2], linewidth=1.2, label=label_of(route))
        axes.add_collection(PolyCollection(list(swept(curve, diameter)), facecolor=ROUTE_COLORS[1], alpha=0.35))
        axes.plot(*curve.points[:, :2].T, color=ROUTE_COLORS[1], label=f"curve and its body of {diameter:g} m")
        touches = np.append(curve.least_distances(city, diameter) < diameter / 2, False)
        axes.plot(*np.where(touches[:, None], curve.points, np.nan)[:, :2].T, color=ROUTE_COLORS[0], linewidth=4,
                  label="touches an obstacle")  # fmt: skip
        axes.plot(*curve.control[:, :2].T, "o", color=ROUTE_COLORS[2], markersize=4, label="control points")
        axes.set(xlim=(x - reach, x + reach), ylim=(y - reach, y + reach))
        clear, sharpest = curve.clearance(city), curve.curvature.max()
        axes.set_title(f"{curve.planner}: {clear:.2f} m clear, κ ≤ {sharpest:.2f} 1/m", fontsize=9)
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


def check_curves(curves: Sequence[Curve]) -> None:
    """Refuse what isn't a curve, or none at all."""
    if not curves:
        raise ValueError("curves is empty: give at least one, as from smooth(route, city, uav)")
    for curve in curves:
        checks.instance("curves", curve, Curve)


def expansions(city: City, *routes: Route) -> Figure:
    """Which columns of the map each search expanded, and when: dark first, bright last.

    Parameters
    ----------
    city : City
    routes : Route
        Planned with `record=True`.

    Raises
    ------
    ValueError
        If a route didn't record its order, or none is given.
    """
    if not routes or any("order" not in route.info for route in routes):
        raise ValueError("routes must be planned with record=True, at least one")
    figure, all_axes = plt.subplots(
        1, len(routes), figsize=(3.4 * len(routes) + 1, 3.7), dpi=DPI, squeeze=False, layout="constrained"
    )
    built = city.occupied.any(axis=2)
    for axes, route in zip(all_axes[0], routes, strict=True):
        order = route.info["order"]
        first = np.full(city.shape[:2], np.inf)
        index = city.index_of(order)
        np.minimum.at(first, (index[:, 0], index[:, 1]), np.arange(len(order)) / len(order))
        draw_map(axes, city, np.where(built, 1.0, np.nan), "Greys", vmin=0, vmax=3)
        image = draw_map(axes, city, np.where(np.isfinite(first), first, np.nan), SEQUENTIAL, vmin=0, vmax=1)
        if len(route.points) > 1:
            axes.plot(*route.points[:, :2].T, color=ROUTE_COLORS[0], linewidth=1.5)
        axes.set_title(f"{route.info.get('heuristic', route.planner)}: {len(order):,} expanded", fontsize=10)
    figure.colorbar(image, ax=all_axes, label="first looked at, as a share of the search")
    return finished(figure)


def bars(values: dict[str, float], label: str, *, title: str = "") -> Figure:
    """Named values as horizontal bars, each with its number; `label` names the quantity and its unit."""
    figure, axes = plt.subplots(figsize=(6.4, 0.5 * len(values) + 1.1), dpi=DPI, layout="constrained")
    drawn = axes.barh(list(values), list(values.values()), color=ROUTE_COLORS[1])
    axes.bar_label(drawn, [f"{v:,.0f}" if abs(v) >= 100 else f"{v:.3g}" for v in values.values()], padding=3)
    axes.invert_yaxis()
    axes.xaxis.set_major_formatter("{x:,g}")
    axes.set_xlabel(label)
    axes.set_title(title)
    axes.margins(x=0.15)
    axes.spines[["top", "right"]].set_visible(False)
    return finished(figure)


def tracks(
    city: City,
    flights: Mapping[str, Sequence[Flight]],
    routes: Mapping[str, Route] | None = None,
    *,
    area: tuple[float, float, float, float] | None = None,
) -> Figure:
    """Flights from above, a panel for each name: their tracks, and a red X where one crashed.

    Parameters
    ----------
    city : City
    flights : mapping of sequences of Flight
        By name, as that of a planner; an empty one leaves the panel to its route.
    routes : mapping of Route, optional
        What was to be flown, for some of the names or for others; drawn dashed, with a square where one that doesn't
        arrive ends.
    area : (west, east, south, north), optional
        Part of the map to show [m]; by default all of it.

    Raises
    ------
    ValueError
        If there is no name, or what stands behind it isn't flights.
    """
    planned = dict(routes or {})
    check_drawn(city, tuple(planned.values()))
    named = {name: list(named_flights(flights.get(name, ())).values()) for name in (planned | dict(flights))}
    if not named:
        raise ValueError("flights is empty: give at least one name, as in {'A*': [flight]}")
    (west, south, _), (east, north, _) = city.bounds
    west, east, south, north = (west, east, south, north) if area is None else area
    height = 3.1 * (north - south) / (east - west) + 1.2
    figure, panels = plt.subplots(1, len(named), figsize=(3.1 * len(named) + 0.5, height), dpi=DPI, squeeze=False,
                                  sharey=True, layout="constrained")  # fmt: skip
    built = np.where(city.occupied.any(axis=2), 1.0, np.nan)
    for axes, (name, flown) in zip(panels[0], named.items(), strict=True):
        draw_map(axes, city, built, "Greys", vmin=0.0, vmax=3.0)
        for flight in flown:
            axes.plot(*track(flight)[1][:, :2].T, color=ROUTE_COLORS[1], linewidth=0.8, alpha=0.6)
        ends = np.array([flight.position[-1, :2] for flight in flown if flight.outcome == "crashed"]).reshape(-1, 2)
        title = f"{name}: {len(ends)} of {len(flown)} crash" if flown else name
        if name in planned:
            way = planned[name]
            axes.plot(*way.points[:, :2].T, "--", color=ROUTE_COLORS[2], linewidth=1.2)
            axes.plot(*way.points[:1, :2].T, "o", color=ROUTE_COLORS[2], markersize=7)
            mark = "^" if way.reached else "s"
            axes.plot(*way.points[-1:, :2].T, mark, color=ROUTE_COLORS[2], markersize=7)
            title = title if way.reached else f"{name}: doesn't arrive"
        axes.plot(*ends.T, "x", color=CRASH_COLOR, markersize=8, markeredgewidth=2, zorder=5)
        axes.set(xlim=(west, east), ylim=(south, north))
        axes.set_title(title, fontsize=10)
    for axes in panels[0, 1:]:
        axes.set_ylabel("")
    parts: list[tuple[str, Any, str, str]] = [
        (ROUTE_COLORS[1], "-", "", "flown"),
        (ROUTE_COLORS[2], "--", "", "planned"),
        (CRASH_COLOR, "", "x", "crash"),
        (ROUTE_COLORS[2], "", "o", "start"),
        (ROUTE_COLORS[2], "", "^", "goal"),
    ]
    if any(not way.reached for way in planned.values()):
        parts.append((ROUTE_COLORS[2], "", "s", "trapped"))
    handles = [Line2D([], [], color=c, linestyle=line, marker=m, label=label) for c, line, m, label in parts]
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles), fontsize=8)
    return finished(figure)


def crash_rates(rates: Mapping[str, Mapping[str, Rate]], *, least: float = 0.01) -> Figure:
    """Crashes per 1 000 flights with their intervals, by factors: a group for each case, a colour for each planner.

    Parameters
    ----------
    rates : mapping of mappings
        Case → planner → what `uavlab.flight.crash_rate` returns.
    least : float
        Where the axis begins; a rate of 0 is an arrow down from the upper end of its interval.

    Raises
    ------
    ValueError
        If there is no case, or there are more than six planners.
    """
    planners = list(dict.fromkeys(name for by_planner in rates.values() for name in by_planner))
    if not 1 <= len(planners) <= len(ROUTE_COLORS):
        raise ValueError(f"rates must hold one to {len(ROUTE_COLORS)} planners, got {len(planners)}")
    checks.positive_number("least", least)
    figure, axes = new_figure(8.6, 0.62 * len(rates) * max(len(planners) / 4, 0.7) + 1.5)
    apart = 0.8 / len(planners)
    for number, (name, color, marker) in enumerate(zip(planners, ROUTE_COLORS, "osD^vP", strict=False)):
        axes.plot([], [], marker, color=color, label=name)
        for row, by_planner in enumerate(rates.values()):
            if name not in by_planner:
                continue
            rate, y = by_planner[name], row + (number - (len(planners) - 1) / 2) * apart
            if rate.per_thousand > 0:
                axes.plot([max(rate.low, least), rate.high], [y, y], color=color, linewidth=2)
                axes.plot(rate.per_thousand, y, marker, color=color, markersize=6)
            else:
                axes.annotate("", (least, y), (rate.high, y), arrowprops={"arrowstyle": "-|>", "color": color})
                axes.plot(rate.high, y, "|", color=color, markersize=8, markeredgewidth=2)
    axes.set(xscale="log", xlim=(least, 1300), ylim=(len(rates) - 0.45, -0.55),
             xlabel="crashes per 1 000 flights, with 95 % intervals (arrow: none seen)")  # fmt: skip
    axes.set_yticks(range(len(rates)), list(rates))
    axes.xaxis.set_major_formatter("{x:,g}")
    axes.grid(axis="x", alpha=0.3)
    for border in range(1, len(rates)):
        axes.axhline(border - 0.5, color="0.85", linewidth=0.8)
    axes.legend(fontsize=8, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return finished(figure)


def in_flight(flights: Mapping[str, Flight], **limits: float) -> Figure:
    """How flights went, over time: offset across the route, speed over ground and thrust.

    Parameters
    ----------
    flights : mapping of Flight
        By name, at most six; an X where one crashed.
    limits : float
        Thrust limits [N] to mark, by name.

    Raises
    ------
    ValueError
        If there is none that flew, or there are more than six.
    """
    flown = {name: flight for name, flight in named_flights(flights).items() if len(flight.log)}
    if not 1 <= len(flown) <= len(CONVERGENCE_STYLES):
        raise ValueError(f"flights must hold one to {len(CONVERGENCE_STYLES)} that flew, got {len(flown)}")
    figure, panels = plt.subplots(3, 1, figsize=(8.6, 6.4), dpi=DPI, sharex=True, layout="constrained")
    quantities = ("across", "offset across the route,\nleft is positive [m]"), ("speed", "speed over ground\n[m/s]")
    for axes, (column, label) in zip(panels, (*quantities, ("thrust", "thrust [N]")), strict=True):
        for (name, flight), (color, style) in zip(flown.items(), CONVERGENCE_STYLES, strict=False):
            values = flight.column(column)
            axes.plot(flight.time, values, color=color, linestyle=style, linewidth=1.2, label=name)
            if flight.outcome == "crashed":
                axes.plot(flight.time[-1], values[-1], "x", color=CRASH_COLOR, markersize=9, markeredgewidth=2.5)
        axes.set_ylabel(label)
        axes.grid(alpha=0.3)
    for name, limit in limits.items():
        panels[2].axhline(limit, color="0.4", linewidth=1, linestyle=":")
        panels[2].annotate(name, (0.995, limit), (0, 1), xycoords=("axes fraction", "data"),
                           textcoords="offset points", ha="right", va="bottom", fontsize=8, color="0.3")  # fmt: skip
    panels[2].margins(y=0.12)
    panels[0].axhline(0.0, color="0.4", linewidth=1)
    panels[1].set_ylim(bottom=0.0)
    panels[2].set(xlabel="time in flight [s]", xlim=(0, max(flight.duration for flight in flown.values())))
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper center", ncols=3, fontsize=8)
    return finished(figure)


def safety_domain(samples: npt.ArrayLike, **domains: SafetyDomain) -> Figure:
    """Offsets as a heat map of their density, with the ellipses of safety domains around them (REPARE Fig. 18).

    Parameters
    ----------
    samples : (N, 2) array
        Offsets across the route and up [m], such as `Flights.samples`.
    domains : SafetyDomain
        By name (`_` for a blank), at most three.

    Raises
    ------
    ValueError
        If the samples aren't (N, 2) and finite, or there are more than three domains.
    """
    points = checks.samples(samples, least=3, axes=2)
    if len(domains) > 3:
        raise ValueError(f"domains must be at most three, got {len(domains)}")
    outlines = [domain.ellipse for domain in domains.values()]
    reach = 1.15 * max([np.quantile(np.abs(points), 0.9995), *(np.abs(outline).max() for outline in outlines)])
    figure, axes = new_figure(6.6, 5.6)
    edges = np.linspace(-reach, reach, 61)
    counts = np.histogram2d(points[:, 0], points[:, 1], bins=[edges, edges])[0]
    density = counts / len(points) / (edges[1] - edges[0]) ** 2
    image = axes.pcolormesh(edges, edges, np.where(density > 0, density, np.nan).T, cmap=SEQUENTIAL, norm=LogNorm())
    axes.set_facecolor("0.93")
    styles = zip((ROUTE_COLORS[0], "#FFFFFF", ROUTE_COLORS[3]), ("-", "--", "-."), strict=True)
    for (name, domain), (color, style) in zip(domains.items(), styles, strict=False):
        label = f"{name.replace('_', ' ')}: {domain.in_ellipse:.2%} inside"
        axes.plot(*domain.ellipse.T, color="black", linewidth=3.6)
        axes.plot(*domain.ellipse.T, style, color=color, linewidth=2.2, label=label)
    axes.set(xlabel="offset across the route, left is positive [m]", ylabel="offset up [m]", aspect="equal")
    add_color_bar(figure, axes, image, "density [1/m²], grey: none seen")
    if domains:
        axes.legend(fontsize=8, loc="upper right", facecolor="0.75", framealpha=1.0)
    return finished(figure)


def still(
    city: City,
    *routes: Route,
    risk: RiskMap | None = None,
    flights: Sequence[Flight] | Mapping[str, Flight] = (),
    elevation_deg: float = 32.0,
    azimuth_deg: float = -60.0,
) -> Figure:
    """The scene as a picture, for paper and previews: city and routes in three dimensions, equal scales.

    Parameters
    ----------
    city : City
    routes : Route
    risk : RiskMap, optional
        Paints the ground with the risk just above it.
    flights : sequence of Flight, or mapping
        Their tracks, by name if it is a mapping; a crash is a red X. Routes are drawn thinner then.
    elevation_deg, azimuth_deg : float
        From where it is seen [degrees]: height above the horizon, direction counted from east.
    """
    check_drawn(city, routes, risk)
    figure = plt.figure(figsize=(7.2, 5.4), dpi=DPI)
    axes: Any = figure.add_axes((0, 0.04, 1, 0.9), projection="3d", computed_zorder=False)
    low, high = city.bounds
    longest = float((high - low).max())
    polygons, colors = [], []
    for triangles, color in city_surface(city):
        pieces = subdivided(triangles, longest / 14)
        normals = np.cross(pieces[:, 1] - pieces[:, 0], pieces[:, 2] - pieces[:, 0])
        normals /= np.linalg.norm(normals, axis=1, keepdims=True) + 1e-12
        light = 0.75 + 0.25 * (normals @ (SUN / np.linalg.norm(SUN)))
        polygons.append(pieces)
        colors.append(light[:, None] * np.array(to_rgb(color)))
    named = named_flights(flights)
    ways = [(label_of(route), route, 0.4 if named else 1.0) for route in routes]
    ways += [(label_of_flight(name, flight), Route(track(flight)[1]), 1.0) for name, flight in named.items()]
    for (label, way, thickness), color in zip(ways, route_colors(len(ways)), strict=True):
        axes.plot([], [], [], color=color, linewidth=3 * thickness, label=label)
        if len(way.points) > 1:
            ribbon = ribbons(way.resample(longest / 60).points, thickness * longest / 180)
            axes.plot(*way.points.T, color=color, linewidth=0.8, alpha=0.5, zorder=9)  # what a building hides
            polygons.append(ribbon)
            colors.append(np.tile(to_rgb(color), (len(ribbon), 1)))
    for flight in named.values():
        if flight.outcome == "crashed":
            for arm in cross(flight.position[-1], longest / 30):
                axes.plot(*arm.T, color=CRASH_COLOR, linewidth=3.5, zorder=10)
    if risk is not None:
        norm = risk_norm(risk)
        paint = np.repeat(SEQUENTIAL(norm(ground_risk(risk).ravel())), 2, axis=0)
        ground = layer_triangles(city, low[2]).reshape(-1, 3, 3)
        axes.add_collection3d(Poly3DCollection(ground, facecolors=paint, edgecolors=paint, lw=0.3, zorder=0))
        bar = figure.add_axes((0.08, 0.1, 0.24, 0.025))
        figure.colorbar(ScalarMappable(norm, SEQUENTIAL), cax=bar, orientation="horizontal").set_label(
            RISK_LABEL, fontsize=8
        )
    if polygons:
        faces = np.concatenate(colors)
        axes.add_collection3d(Poly3DCollection(np.concatenate(polygons), facecolors=faces, edgecolors=faces, lw=0.3))
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set(xlabel="x, east [m]", ylabel="y, north [m]", zlabel="z, up [m]", title=city.name)
    axes.set_box_aspect(high - low, zoom=0.95)
    axes.zaxis.set_major_locator(MaxNLocator(2 + round(4 * (high - low)[2] / longest)))
    axes.view_init(elevation_deg, azimuth_deg)
    if ways:
        axes.legend(loc="upper left", fontsize=8)
    return finished(figure)


def named_flights(flights: Sequence[Flight] | Mapping[str, Flight]) -> dict[str, Flight]:
    """Flights by name, or by number where they have none."""
    if not isinstance(flights, Sequence | Mapping):
        raise ValueError(f"flights must be a list of Flight, or Flight by name, got {type(flights).__name__}")
    named = flights if isinstance(flights, Mapping) else {f"flight {n + 1}": f for n, f in enumerate(flights)}
    for flight in named.values():
        checks.instance("flights", flight, Flight)
    return dict(named)


def track(flight: Flight) -> tuple[np.ndarray, np.ndarray]:
    """Time (P,) [s] and position (P, 3) [m] every fifth of a second, and where it ended."""
    last = len(flight.log) - 1
    step = flight.duration / max(last, 1) or TRACK_STEP
    rows = list(range(0, last, max(round(TRACK_STEP / step), 1)))
    if last >= 0:
        rows.append(last)
    return flight.time[rows], flight.position[rows]


def cross(place: np.ndarray, reach: float) -> np.ndarray:
    """The two arms of an upright X as seen from the south-east, (2, 2, 3) [m]."""
    across = np.array([np.cos(np.pi / 6), np.sin(np.pi / 6), 0.0])
    arms = np.array([[-across, across], [across, -across]])
    arms[:, 0, 2], arms[:, 1, 2] = -1.0, 1.0
    return place + reach * arms


def label_of_flight(name: str, flight: Flight) -> str:
    """Who flew, and what became of it."""
    when = "" if flight.outcome == "grounded" else f" after {flight.duration:.1f} s"
    return f"{name}: {flight.outcome}{when}"


def risk_norm(risk_map: RiskMap) -> LogNorm:
    """From risk to colours by factors: from the least above 0 to the greatest where the UAV may fly, or farther down.

    It spans a factor of ten at least, so that nearly equal risks look so, and the bar can be read.
    """
    rates = risk_map.rate[risk_map.flyable & (risk_map.rate > 0)]
    least, most = (rates.min(), rates.max()) if len(rates) else (1e-9, 1e-9)
    return LogNorm(min(least, most / 10), most, clip=True)


def ground_risk(risk_map: RiskMap) -> np.ndarray:
    """Risk in the lowest voxel of each column where the UAV may fly, (nx, ny) [1/h]."""
    lowest = risk_map.flyable.argmax(axis=2)
    return np.take_along_axis(risk_map.rate, lowest[..., None], axis=2)[..., 0]


def layer_triangles(city: City, height: float) -> np.ndarray:
    """Two triangles for each column of voxels, (nx·ny, 2, 3, 3) [m], at a height."""
    i, j = (index.ravel() for index in np.indices(city.shape[:2]))
    corners = np.stack(
        [np.column_stack([i + a, j + b, np.zeros(len(i))]) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))], axis=1
    )
    corners = city.origin + city.cell * corners
    corners[..., 2] = height
    return corners[:, [[0, 1, 2], [0, 2, 3]]]


def voxel_surface(city: City) -> np.ndarray:
    """Triangles (T, 3, 3) [m] between occupied voxels and free ones or the border; rows of faces are one rectangle."""
    padded = np.pad(city.occupied, 1)
    triangles = []
    for axis in range(3):
        across, along = sorted({0, 1, 2} - {axis})
        for side in (0, 1):
            beyond = np.roll(padded, 1 - 2 * side, axis=axis)[1:-1, 1:-1, 1:-1]
            exposed = np.moveaxis(city.occupied & ~beyond, along, -1)
            steps = np.diff(exposed.astype(np.int8), axis=-1, prepend=0, append=0)
            first, last = np.argwhere(steps == 1), np.argwhere(steps == -1)  # of each row: same order, so they pair up
            corner, extent = np.zeros((2, len(first), 3))
            kept = [a for a in range(3) if a != along]
            corner[:, kept], corner[:, along] = first[:, :2], first[:, 2]
            corner[:, axis] += side
            extent[:, along] = last[:, 2] - first[:, 2]
            step = np.eye(3)[across]
            quad = [corner, corner + step, corner + step + extent, corner + extent]
            if (side == 1) != (np.cross(step, np.eye(3)[along])[axis] > 0):
                quad = quad[::-1]  # counter-clockwise seen from outside
            triangles += [np.stack([quad[0], quad[1], quad[2]], axis=1), np.stack([quad[0], quad[2], quad[3]], axis=1)]
    return city.origin + city.cell * np.concatenate(triangles)


def city_surface(city: City) -> list[tuple[np.ndarray, str]]:
    """Triangles and colour of each building, or of all voxels where the city knows no buildings."""
    if city.buildings:
        return [(building.triangles(), building.color) for building in city.buildings]
    return [(voxel_surface(city), "lightsteelblue")] if city.occupied.any() else []


def subdivided(triangles: np.ndarray, longest: float) -> np.ndarray:
    """Triangles cut in halves until no edge is longer: small ones can be sorted by depth."""
    while True:
        edges = np.linalg.norm(np.roll(triangles, -1, axis=1) - triangles, axis=2)
        large = edges.max(axis=1) > longest
        if not large.any():
            return triangles
        first = edges[large].argmax(axis=1)
        a, b, c = (triangles[large][np.arange(large.sum()), (first + corner) % 3] for corner in range(3))
        middle = (a + b) / 2
        halves = [np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)]
        triangles = np.concatenate([triangles[~large], *halves])


def ribbons(points: np.ndarray, width: float) -> np.ndarray:
    """Triangles of two crossed ribbons along a polyline: a line that has a depth of its own."""
    start, end = points[:-1], points[1:]
    along = end - start
    across = np.cross(along, [0.0, 0.0, 1.0])
    across[np.linalg.norm(across, axis=1) < 1e-9] = [1.0, 0.0, 0.0]
    surfaces = []
    for direction in (across, np.cross(along, across)):
        side = width * direction / np.linalg.norm(direction, axis=1, keepdims=True)
        surfaces.append(np.stack([start - side, end - side, end + side], axis=1))
        surfaces.append(np.stack([start - side, end + side, start + side], axis=1))
    return np.concatenate(surfaces)


def level_of(city: City, height: float) -> int:
    """Index of the layer of voxels at a height [m]; `ValueError` if it lies outside of the map."""
    checks.number("height", height)
    k = int(city.cell_of((city.origin[0], city.origin[1], height))[2])
    if not 0 <= k < city.shape[2]:
        low, high = city.bounds[:, 2]
        raise ValueError(f"height must lie on the map, {low:g} to {high:g} m, got {height!r}")
    return k


def check_drawn(city: City, routes: Sequence[Route], risk_map: RiskMap | None = None) -> None:
    """Refuse what can't be drawn: a risk map in the place of the city, a list of routes in that of a route."""
    checks.instance("city", city, City)
    for route in routes:
        checks.instance("routes", route, Route)
    if risk_map is not None:
        checks.instance("risk", risk_map, RiskMap)


def new_figure(width: float, height: float) -> tuple[Figure, Axes]:
    return plt.subplots(figsize=(width, height), dpi=DPI, layout="constrained")


def draw_map(axes: Axes, city: City, values: np.ndarray, colors, **limits):
    """Values (nx, ny) on the ground plan, with axes in metres and equal scales."""
    (west, south, _), (east, north, _) = city.bounds
    axes.set(xlabel="x, east [m]", ylabel="y, north [m]", aspect="equal")
    return axes.imshow(values.T, origin="lower", extent=(west, east, south, north), cmap=colors, **limits)


def add_color_bar(figure: Figure, axes: Axes, image, label: str):
    """A colour bar beside a map, as high as the map."""
    return figure.colorbar(image, cax=axes.inset_axes((1.03, 0.0, 0.04, 1.0)), label=label)


def draw_routes(axes: Axes, routes: Sequence[Route]) -> None:
    """Routes from above: a disc where each starts, a triangle at its goal."""
    for route, color in zip(routes, route_colors(len(routes)), strict=True):
        axes.plot(*route.points[:, :2].T, color="white", linewidth=3.5)
        axes.plot(*route.points[:, :2].T, color=color, linewidth=2, label=label_of(route))
        for point, marker in ((route.points[:1], "o"), (route.points[-1:], "^")):
            axes.plot(*point[:, :2].T, marker, color=color, markersize=9, markeredgecolor="white")
    if routes:
        axes.figure.legend(loc="outside lower center", fontsize=8)


def label_of(route: Route) -> str:
    return f"{route.planner}, {route.length:.1f} m" if route.reached else f"{route.planner}: not reached"


def finished(figure: Figure) -> Figure:
    """The figure, closed for pyplot: a notebook shows it once, where the cell returns it."""
    plt.close(figure)
    return figure
