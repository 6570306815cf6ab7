"""The city from above or in section, with routes, fields, risk and searches."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from uavlab import checks
from uavlab.city import City
from uavlab.planners.potential_field import potential_forces
from uavlab.plot.colors import BLACK, SEQUENTIAL, styles
from uavlab.plot.ground import (
    LAND_COLOR,
    built_columns,
    draw_contours,
    draw_cut,
    draw_zones,
    hatch,
    title_of,
)
from uavlab.plot.panels import explain
from uavlab.plot.style import (
    DPI,
    SIGNS,
    Drawn,
    add_color_bar,
    area_of,
    draw_map,
    draw_routes,
    drawn_routes,
    finished,
    label_of,
    level_of,
    map_size,
    new_figure,
    plain,
    signs_of,
    titled,
    with_gaps,
    within,
)
from uavlab.risk import RiskMap


def plan(city: City, *routes: Drawn, colors: Mapping[str, str] | None = None) -> Figure:
    """The city from above, darker where it is higher, with routes, heights of the ground and no-fly zones.

    Parameters
    ----------
    city : City
        Its columns of voxels are grey, by the height of their tops.
    routes : Route or Curve, or mapping
        By name if it is a mapping; those without points are named in the legend. One that doesn't arrive ends in a
        square, and where it should have arrived is a hollow triangle.
    colors : mapping of str, optional
        Name → colour, for what should look the same elsewhere, as for `styles`.

    Returns
    -------
    matplotlib.figure.Figure
        One map with equal scales, in metres.

    Raises
    ------
    ValueError
        If `city` is no `City`, one of `routes` is neither a route nor a curve (a list of them has to be unpacked), or
        `colors` are no colours by name.

    See Also
    --------
    section : The map cut at a height.
    profile : Height and clearance along the routes.
    uavlab.scene.still : The same in three dimensions.

    Examples
    --------
    >>> from uavlab import plot
    >>> from uavlab.city import table1_city
    >>> from uavlab.planners import astar
    >>> city = table1_city()
    >>> figure = plot.plan(city, astar(city, (90, 18, 30), (50, 44, 30)))
    >>> figure.legends[0].get_texts()[0].get_text()
    'A*, 66.4 m'
    """
    planned = drawn_routes(city, routes)
    figure, axes = new_figure(*map_size(area_of(city, None)))
    tops = np.where(city.occupied, (np.arange(city.shape[2]) + 1) * city.cell, 0).max(axis=2)
    if city.ground is not None:
        tops = np.where(built_columns(city), np.maximum(city.origin[2] + tops - city.ground, 0.0), 0.0)
        axes.set_facecolor(LAND_COLOR)
    image = draw_map(axes, city, np.where(tops > 0, tops, np.nan), "Greys", vmin=0.0, vmax=1.3 * max(tops.max(), 1.0))
    add_color_bar(figure, axes, image, "top of the buildings above the ground [m]").ax.set_ylim(0, max(tops.max(), 1.0))
    draw_contours(axes, city)
    draw_zones(axes, city)
    draw_routes(axes, planned, colors)
    axes.set_title(titled(city.name))
    return finished(figure)


RISK_LABEL = "risk r [deaths per hour of flight]"


def section(
    city: City,
    height: float,
    values: npt.ArrayLike | None = None,
    *routes: Drawn,
    label: str = "clearance [m]",
    norm: Normalize | None = None,
    colors: Mapping[str, str] | None = None,
) -> Figure:
    """A horizontal section: buildings black, ground brown, and values of the voxels at this height in colour.

    No-fly zones that reach the height are hatched.

    Parameters
    ----------
    city : City
        What to cut.
    height : float
        Where to cut, z [m], on the map.
    values : (nx, ny, nz) array, optional
        What to colour, a value for each voxel; the clearance by default. Where it is NaN or masked, the map is black.
    routes : Route or Curve, or mapping
        Seen from above.
    label : str
        Of the colour bar, with a unit.
    norm : matplotlib.colors.Normalize, optional
        From values to colours; by default evenly over the values shown.
    colors : mapping of str, optional
        Name → colour, for what should look the same elsewhere, as for `styles`.

    Returns
    -------
    matplotlib.figure.Figure
        One map with equal scales, in metres, and its colour bar.

    Raises
    ------
    ValueError
        If `city` is no `City`, `height` lies outside of the map, `values` haven't the city's shape, one of `routes` is
        neither a route nor a curve, `label` is no text, `norm` is no `Normalize`, or `colors` are no colours by name.

    See Also
    --------
    risk : The same for the rate of a risk map.
    plan : The city from above.

    Examples
    --------
    >>> from uavlab import plot
    >>> from uavlab.city import table1_city
    >>> figure = plot.section(table1_city(), 30.0)
    >>> figure.axes[0].get_title()
    'The city of REPARE Table 1, 30 m above the ground (buildings black)'
    """
    planned = drawn_routes(city, routes)
    height = checks.number("height", height)
    k = level_of(city, height)
    layer = layer_of(city, city.clearance if values is None else values, k)
    checks.text("label", label)
    if norm is not None:
        checks.instance("norm", norm, Normalize)
    figure, axes = new_figure(*map_size(area_of(city, None)))
    image = draw_map(axes, city, np.where(city.occupied[:, :, k], np.nan, layer), SEQUENTIAL, norm=norm)
    add_color_bar(figure, axes, image, label)
    axes.set_facecolor("black")
    draw_cut(axes, city, k)
    draw_zones(axes, city, height)
    draw_routes(axes, planned, colors)
    axes.set_title(title_of(city, height, "buildings black"))
    return finished(figure)


def layer_of(city: City, values: npt.ArrayLike, k: int) -> np.ndarray:
    """One layer of values of all voxels (nx, ny, nz), as floats: the others are left as they are."""
    every = values if isinstance(values, np.ndarray) else checks.numbers("values", values)
    if every.shape != city.shape:
        raise ValueError(f"values must have the city's shape {city.shape}, got {every.shape}")
    return with_gaps(every[:, :, k])


MOST_ARROWS = 100_000
"""In a field; nobody could tell more apart."""


def field(
    city: City,
    height: float,
    goal: npt.ArrayLike,
    *routes: Drawn,
    area: tuple[float, float, float, float] | None = None,
    spacing: float = 3.0,
    colors: Mapping[str, str] | None = None,
    **setting: Any,
) -> Figure:
    """A potential field in a horizontal section: its potential U as colours and lines, arrows along its force −∇U.

    The goal is a triangle; of routes, as in `plan`.

    Parameters
    ----------
    city : City
        Whose obstacles repel.
    height : float
        Where to cut, z [m], on the map.
    goal : (3,) array
        What attracts [m].
    routes : Route or Curve, or mapping
        Seen from above.
    area : (west, east, south, north), optional
        Part of the map to show [m], on the map at least in part; by default all of it.
    spacing : float
        From arrow to arrow [m], above 0, so that there are at most 100 000; 2 to 5 is usual.
    colors : mapping of str, optional
        Name → colour, for what should look the same elsewhere, as for `styles`.
    setting
        Of the field, as for `uavlab.planners.potential_forces`: `pull`, `push`, `reach`, `attraction`, `obstacles`.

    Returns
    -------
    matplotlib.figure.Figure
        One map with equal scales, in metres, and its colour bar.

    Raises
    ------
    ValueError
        If `city` is no `City`, `height` lies outside of the map, `goal` is not three finite numbers, one of `routes`
        is neither a route nor a curve, `area` is not four finite numbers, each second one above the one before it, or
        lies beside the map, or has no free point at that height, `spacing` is not above 0, or so small that there are
        more than 100 000 arrows, `colors` are no colours by name, or one of `setting` is wrong as for
        `uavlab.planners.potential_forces`.

    See Also
    --------
    uavlab.planners.potential_forces : What is drawn.
    uavlab.planners.potential_field : Follows the force.

    References
    ----------
    O. Khatib, Real-Time Obstacle Avoidance for Manipulators and Mobile Robots, 1986.

    Examples
    --------
    >>> from uavlab import plot
    >>> from uavlab.city import table1_city
    >>> figure = plot.field(table1_city(), 30.0, (50, 44, 30), area=(66, 96, 20, 32), reach=3.0)
    >>> figure.axes[0].child_axes[0].get_ylabel()
    'potential U [unit of force · m]'
    """
    planned = drawn_routes(city, routes)
    height, spacing = checks.number("height", height), checks.positive_number("spacing", spacing)
    k = level_of(city, height)
    west, east, south, north = area_of(city, area)
    least = np.sqrt((east - west) * (north - south) / MOST_ARROWS)
    if spacing < least:
        raise ValueError(f"spacing must be at least {least:.2g} m on this area, got {spacing:g}")

    def sampled(step: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        x, y = np.meshgrid(np.arange(west + step / 2, east, step), np.arange(south + step / 2, north, step))
        points = np.stack([x, y, np.full(x.shape, height)], axis=-1)
        pull, push, potential = potential_forces(city, points, goal, **setting)
        free = city.is_free(points)
        return points, np.where(free[..., None], pull + push, np.nan), np.where(free, potential, np.nan)

    points, _, potential = sampled(max(east - west, north - south) / 200)
    if not np.isfinite(potential).any():
        raise ValueError(f"area must have a free point {height:g} m high, to have a field there")
    figure, axes = new_figure(*map_size((west, east, south, north)))
    draw_map(axes, city, np.where(city.occupied[:, :, k], 1.0, np.nan), "gray_r", vmin=0, vmax=1)
    draw_cut(axes, city, k)
    levels = MaxNLocator(20).tick_values(np.nanmin(potential), np.nanquantile(potential, 0.93))  # walls rise out of it
    image = axes.contourf(*points[..., :2].T, potential.T, levels, cmap=SEQUENTIAL, extend="max")
    axes.contour(*points[..., :2].T, potential.T, levels, colors="white", linewidths=0.4)
    add_color_bar(figure, axes, image, "potential U [unit of force · m]")
    points, force, _ = sampled(spacing)
    with np.errstate(invalid="ignore"):
        direction = force / np.linalg.norm(force, axis=-1, keepdims=True)
    axes.quiver(*points[..., :2].T, *direction[..., :2].T, pivot="mid", angles="xy", scale_units="xy",
                scale=1.2 / spacing, width=0.005, edgecolor="white", linewidth=0.5)  # fmt: skip
    draw_zones(axes, city, height)
    end, window = np.asarray(goal, dtype=float), (west, east, south, north)
    if not planned and within(end, window):
        look = SIGNS["goal"] | {"markersize": 9, "markeredgecolor": "white", "linestyle": ""}
        axes.plot(*end[:2], color=BLACK, label="goal", zorder=3, **look)
    draw_routes(axes, planned, colors, window)
    axes.set(xlim=(west, east), ylim=(south, north))
    axes.set_title(title_of(city, height, "buildings black"))
    return finished(figure)


def risk(risk_map: RiskMap, height: float, *routes: Drawn, colors: Mapping[str, str] | None = None) -> Figure:
    """The risk of flying at a height; buildings black, hatched where the UAV would be too low.

    Colours are on a logarithmic scale, the same at all heights.

    Parameters
    ----------
    risk_map : RiskMap
        Its rate is shown.
    height : float
        Where to cut, z [m], on the map.
    routes : Route or Curve, or mapping
        Seen from above.
    colors : mapping of str, optional
        Name → colour, for what should look the same elsewhere, as for `styles`.

    Returns
    -------
    matplotlib.figure.Figure
        One map with equal scales, in metres, and its colour bar.

    Raises
    ------
    ValueError
        If `risk_map` is no `RiskMap`, `height` lies outside of the map, one of `routes` is neither a route nor a
        curve, or `colors` are no colours by name.

    See Also
    --------
    layers : What the risk was made from.
    risk_norm : The scale of the colours.
    front : Length against risk of several routes.

    Examples
    --------
    >>> from uavlab import plot
    >>> from uavlab.planners import least_risk
    >>> from uavlab.risk import CAMPUS_FLIGHT, reference_campus
    >>> campus = reference_campus()
    >>> figure = plot.risk(campus, 30.0, least_risk(campus, *CAMPUS_FLIGHT))
    >>> figure.axes[0].get_title()
    'Reference campus, 30 m above the ground (too low hatched)'
    """
    checks.instance("risk_map", risk_map, RiskMap)
    city, height = risk_map.city, checks.number("height", height)
    k = level_of(city, height)
    figure = section(city, height, risk_map.rate, *routes, label=RISK_LABEL, norm=risk_norm(risk_map), colors=colors)
    closed = city.in_no_fly if city.no_fly else city.occupied
    too_low = ~(risk_map.flyable | city.occupied | closed)[:, :, k]
    if too_low.any():
        axes = figure.axes[0]
        axes.set_title(title_of(city, height, "too low hatched"))
        hatch(axes, city, too_low, "////")
    return finished(figure)


def layers(risk_map: RiskMap) -> Figure:
    """What a risk map was made from: people, shelter and cars, on three plans.

    Parameters
    ----------
    risk_map : RiskMap
        Its population density, shelter and share of ground under cars are shown.

    Returns
    -------
    matplotlib.figure.Figure
        Three maps, each with its colour bar below.

    Raises
    ------
    ValueError
        If `risk_map` is no `RiskMap`.

    See Also
    --------
    risk : The risk that they make at a height.
    uavlab.risk.osm_layers : Makes such layers for a real place.

    Examples
    --------
    >>> from uavlab import plot
    >>> from uavlab.risk import reference_campus
    >>> figure = plot.layers(reference_campus())
    >>> figure.axes[3].get_xlabel()  # below the first map
    'thousands of people per km²'
    """
    checks.instance("risk_map", risk_map, RiskMap)
    figure, panels = plt.subplots(1, 3, figsize=(11.4, 4.0), dpi=DPI, layout="constrained", sharey=True)
    shown = (
        (1e3 * risk_map.population_density, "thousands of people per km²"),
        (risk_map.shelter, "shelter $p_s$ (0 none, 1 industry)"),
        (1e6 * risk_map.vehicle_share, "ground under cars [m² per km²]"),
    )
    for axes, (layer, label) in zip(panels, shown, strict=True):
        low, high = float(layer.min()), float(layer.max())
        limits = {} if low < high else {"vmin": 0.0, "vmax": high or 1.0}  # one value everywhere
        image = draw_map(axes, risk_map.city, layer, SEQUENTIAL, **limits)
        figure.colorbar(image, ax=axes, location="bottom", label=label)
    for axes in panels[1:]:
        axes.set_ylabel("")
    return finished(figure)


def expansions(city: City, *routes: Drawn, colors: Mapping[str, str] | None = None) -> Figure:
    """Which columns of the map each search expanded, and when: dark first, bright last.

    Parameters
    ----------
    city : City
        On which the routes were planned.
    routes : Route, or mapping
        At least one, planned with `record=True`.
    colors : mapping of str, optional
        Name → colour, for what should look the same elsewhere, as for `styles`.

    Returns
    -------
    matplotlib.figure.Figure
        A map for each route, with its name, or that of its estimate, and how many nodes were expanded in its title.

    Raises
    ------
    ValueError
        If `city` is no `City`, `routes` is empty or holds one that didn't record its order, or `colors` are no colours
        by name.

    See Also
    --------
    uavlab.planners.astar : A search that can record its order.
    uavlab.scene.show : Shows the order in three dimensions, as an animation.

    Examples
    --------
    >>> from uavlab import plot
    >>> from uavlab.city import table1_city
    >>> from uavlab.planners import astar
    >>> city = table1_city()
    >>> searches = [astar(city, (90, 18, 30), (50, 44, 30), heuristic=h, record=True) for h in ("zero", "octile")]
    >>> [axes.get_title() for axes in plot.expansions(city, *searches).axes[:2]]
    ['zero: 235,320 expanded', 'octile: 18,007 expanded']
    """
    searches = drawn_routes(city, routes)
    if not searches or any("order" not in route.info for route in searches):
        raise ValueError("routes must be planned with record=True, at least one")
    names = [name for one in routes for name in (one if isinstance(one, Mapping) else [""])]
    figure, all_axes = plt.subplots(
        1, len(searches), figsize=(3.4 * len(searches) + 1, 4.0), dpi=DPI, squeeze=False, layout="constrained"
    )
    built = built_columns(city)
    looks, told = styles([route.planner for route in searches], colors), set[str]()
    for axes, route, name, look in zip(all_axes[0], searches, names, looks, strict=True):
        order = route.info["order"]
        first = np.full(city.shape[:2], np.inf)
        index = city.index_of(order)
        np.minimum.at(first, (index[:, 0], index[:, 1]), np.arange(len(order)) / len(order))
        draw_map(axes, city, np.where(built, 1.0, np.nan), "Greys", vmin=0, vmax=3)
        image = draw_map(axes, city, np.where(np.isfinite(first), first, np.nan), SEQUENTIAL, vmin=0, vmax=1)
        if len(route.points) > 1:
            axes.plot(*route.points[:, :2].T, color="white", linewidth=3.0)
            axes.plot(*route.points[:, :2].T, color=look.color, linewidth=1.5, label=label_of(route))
        for sign, place in signs_of(route).items():
            edge = BLACK if sign == "goal not reached" else "white"
            axes.plot(*place[:2], color=BLACK, zorder=3, **{"linestyle": "", "markeredgecolor": edge} | SIGNS[sign],
                      label=None if sign in told else sign)  # fmt: skip
            told.add(sign)
        axes.set_title(
            f"{plain(name or route.info.get('heuristic', route.planner))}: {len(order):,} expanded", fontsize=10
        )
    explain(all_axes[0][0], "building")
    figure.legend(loc="outside lower center", fontsize=8, ncols=len(searches) + 3)
    figure.colorbar(image, ax=all_axes, label="first looked at, as a share of the search")
    return finished(figure)


def risk_norm(risk_map: RiskMap) -> LogNorm:
    """From risk to colours, on a logarithmic scale, from the least above 0 to the greatest where the UAV may fly.

    It spans a factor of ten at least, farther down if need be, so that nearly equal risks look so, and the bar can be
    read.

    Parameters
    ----------
    risk_map : RiskMap
        Whose rates [1/h] are to be coloured.

    Returns
    -------
    matplotlib.colors.LogNorm
        0 at the least risk, 1 at the greatest; what lies beyond is clipped.

    Raises
    ------
    ValueError
        If `risk_map` is no `RiskMap`.

    See Also
    --------
    risk : Colours a map by it.
    draw_map : Takes it as `norm`.

    Examples
    --------
    >>> from uavlab import plot
    >>> from uavlab.risk import reference_campus
    >>> norm = plot.risk_norm(reference_campus())
    >>> f"{norm.vmin:.1e} to {norm.vmax:.1e} deaths per hour of flight"
    '2.7e-08 to 1.6e-05 deaths per hour of flight'
    """
    checks.instance("risk_map", risk_map, RiskMap)
    rates = risk_map.rate[risk_map.flyable & (risk_map.rate > 0)]
    least, most = (rates.min(), rates.max()) if len(rates) else (1e-9, 1e-9)
    return LogNorm(min(least, most / 10), most, clip=True)


def ground_risk(risk_map: RiskMap) -> np.ndarray:
    """Risk in the lowest voxel of each column where the UAV may fly.

    Parameters
    ----------
    risk_map : RiskMap
        Its rate is looked at where it is flyable.

    Returns
    -------
    (nx, ny) array
        r [1/h], deaths per hour of flight.

    Raises
    ------
    ValueError
        If `risk_map` is no `RiskMap`.

    See Also
    --------
    risk : A figure of the risk at a height.
    draw_map : Draws such an array.

    Examples
    --------
    >>> from uavlab import plot
    >>> from uavlab.risk import reference_campus
    >>> campus = reference_campus()
    >>> plot.ground_risk(campus).shape == campus.city.shape[:2]
    True
    """
    checks.instance("risk_map", risk_map, RiskMap)
    lowest = risk_map.flyable.argmax(axis=2)
    return np.take_along_axis(risk_map.rate, lowest[..., None], axis=2)[..., 0]
