"""Flights: tracks with crashes, crash rates, what happens over time, the safety domain."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from uavlab import checks
from uavlab.city import City
from uavlab.flight import Flight, Rate
from uavlab.offsets import SafetyDomain
from uavlab.plot.colors import BLACK, CRASH_COLOR, LINES, ORANGE, PINK, SEQUENTIAL, styles
from uavlab.plot.ground import built_columns
from uavlab.plot.style import (
    DPI,
    add_color_bar,
    area_of,
    draw_map,
    drawn_routes,
    finished,
    new_figure,
    plain,
)
from uavlab.route import Route, Way
from uavlab.weather import Wind

TRACK_STEP = 0.2
"""From point to point of a flight's track [s]."""
WIND_COLOR = "#3B6E8F"
"""Of its arrows."""
MARKERS = "osD^vP*"
CORNER = np.radians(10.0)
"""Sharper bends of a route are corners."""


def tracks(
    city: City,
    flights: Mapping[str, Sequence[Flight]],
    routes: Mapping[str, Route | Way] | None = None,
    *,
    area: tuple[float, float, float, float] | None = None,
    wind: Wind | None = None,
    colors: Mapping[str, str] | None = None,
) -> Figure:
    """Flights from above, a panel for each name: their tracks in its colour, and a red X where one crashed.

    Parameters
    ----------
    city : City
        Its buildings are grey.
    flights : mapping of sequences of Flight
        By name, as that of a planner; an empty one leaves the panel to its route.
    routes : mapping of Route or Curve, optional
        What was to be flown, for some of the names or for others; drawn dashed, with a square where one that doesn't
        arrive ends.
    area : (west, east, south, north), optional
        Part of the map to show [m], on the map at least in part; by default all of it.
    wind : Wind, optional
        An arrow shows where its mean blows to, and how fast.
    colors : mapping of str, optional
        Name → colour, for what should look the same elsewhere, as for `styles`.

    Returns
    -------
    matplotlib.figure.Figure
        A panel for each name, with how many flights crashed in its title.

    Raises
    ------
    ValueError
        If `city` is no `City`, `flights` and `routes` together have no name, what stands behind a name in `flights`
        isn't flights, what stands behind one in `routes` is neither a route nor a curve, or `area` is not four finite
        numbers, each second one above the one before it, or lies beside the map; `wind` is no `Wind`; or `colors` are
        no colours by name.

    See Also
    --------
    uavlab.flight.fly : Makes the flights.
    in_flight : How flights went over time.
    uavlab.scene.show : The same in three dimensions.

    Examples
    --------
    >>> from uavlab import plot
    >>> from uavlab.flight import OffsetProcess, fly
    >>> from uavlab.planners import least_risk
    >>> from uavlab.risk import CAMPUS_FLIGHT, reference_campus
    >>> campus = reference_campus()
    >>> flight = fly(least_risk(campus, *CAMPUS_FLIGHT), campus.city, campus.uav, OffsetProcess(1.0), rng=1)
    >>> plot.tracks(campus.city, {"least risk": [flight]}).axes[0].get_title()
    'least risk: 0 of 1 crash'
    """
    planned = {route.planner: route for route in drawn_routes(city, () if routes is None else (routes,))}
    if not isinstance(flights, Mapping):
        raise ValueError(f"flights must be lists by name, as in {{'A*': [flight]}}, got {type(flights).__name__}")
    made = {str(name): list(named_flights(listed).values()) for name, listed in flights.items()}
    named = {name: made.get(name, []) for name in planned | made}
    if not named:
        raise ValueError("flights is empty: give at least one name, as in {'A*': [flight]}")
    if wind is not None:
        checks.instance("wind", wind, Wind)
    west, east, south, north = area_of(city, area)
    height = 3.1 * (north - south) / (east - west) + 1.2
    figure, panels = plt.subplots(1, len(named), figsize=(3.1 * len(named) + 0.5, height), dpi=DPI, squeeze=False,
                                  sharey=True, layout="constrained")  # fmt: skip
    built = np.where(built_columns(city), 1.0, np.nan)
    looks = styles(list(named), colors)
    for axes, (name, flown), look in zip(panels[0], named.items(), looks, strict=True):
        draw_map(axes, city, built, "Greys", vmin=0.0, vmax=3.0)
        for flight in flown:
            axes.plot(*track(flight)[1][:, :2].T, color=look.color, linewidth=0.8, alpha=0.6)
        ends = np.array([flight.position[-1, :2] for flight in flown if flight.outcome == "crashed"]).reshape(-1, 2)
        title = f"{plain(name)}: {len(ends)} of {len(flown)} crash" if flown else plain(name)
        if name in planned:
            draw_planned(axes, planned[name])
            title = title if planned[name].reached else f"{plain(name)}: doesn't arrive"
        axes.plot(*ends.T, "x", color=CRASH_COLOR, markersize=8, markeredgewidth=2, zorder=5)
        axes.set(xlim=(west, east), ylim=(south, north))
        axes.set_title(title, fontsize=10)
        if wind is not None:
            draw_wind(axes, wind)
    for axes in panels[0, 1:]:
        axes.set_ylabel("")
    explain_tracks(figure, looks[0].color if len(named) == 1 else "", any(not way.reached for way in planned.values()))
    return finished(figure)


def explain_tracks(figure: Figure, color: str, stopped: bool) -> None:
    """The legend of flights from above; without a colour each panel has its own."""
    parts: list[tuple[str, Any, str, str]] = [
        (color or "0.35", "-", "", "flown" if color else "flown, in a colour for each panel"),
        (BLACK, "--", "", "planned"),
        (CRASH_COLOR, "", "x", "crash"),
        (BLACK, "", "o", "start"),
        (BLACK, "", "^", "goal"),
    ]
    if stopped:
        parts.append((BLACK, "", "s", "stopped"))
    handles = [Line2D([], [], color=c, linestyle=line, marker=m, label=label) for c, line, m, label in parts]
    figure.legend(handles=handles, loc="outside lower center", ncols=3 if len(figure.axes) == 1 else 6, fontsize=8)


def draw_wind(axes: Axes, wind: Wind) -> None:
    """An arrow in a corner of a plan, along the mean wind, with its speed."""
    blows = np.array(wind.mean[:2])
    speed = float(np.hypot(*blows))
    if speed == 0:
        return
    x, y = 0.06 * blows / speed
    box = {"boxstyle": "round,pad=0.2", "facecolor": "white", "edgecolor": "0.8", "alpha": 0.9}
    axes.text(
        0.15, 0.04, f"wind {speed:.3g} m/s", transform=axes.transAxes, fontsize=7, ha="center", bbox=box, zorder=6
    )
    axes.annotate("", (0.15 + x, 0.17 + y), (0.15 - x, 0.17 - y), xycoords="axes fraction", zorder=6,
                  arrowprops={"arrowstyle": "simple", "color": WIND_COLOR, "mutation_scale": 14})  # fmt: skip


def draw_planned(axes: Axes, route: Route) -> None:
    """What was to be flown, dashed: a disc where it starts, a triangle at its goal, a square where it got stuck."""
    axes.plot(*route.points[:, :2].T, "--", color=BLACK, linewidth=1.2)
    axes.plot(*route.points[:1, :2].T, "o", color=BLACK, markersize=7)
    axes.plot(*route.points[-1:, :2].T, "^" if route.reached else "s", color=BLACK, markersize=7)


def crash_rates(
    rates: Mapping[str, Mapping[str, Rate]], *, least: float = 0.01, colors: Mapping[str, str] | None = None
) -> Figure:
    """Crashes per 1 000 flights with their intervals on a logarithmic scale, a group for each case.

    Each planner has a colour. A rate of 0 is an arrow down from the upper end of its interval.

    Parameters
    ----------
    rates : mapping of mappings
        Case → planner → what `uavlab.flight.crash_rate` returns; one to seven planners.
    least : float
        Where the axis begins [crashes per 1 000 flights], above 0 and below 1 000.
    colors : mapping of str, optional
        Name → colour, for what should look the same elsewhere, as for `styles`.

    Returns
    -------
    matplotlib.figure.Figure
        One panel, a row for each planner in each case.

    Raises
    ------
    ValueError
        If `rates` aren't rates by planner by case, have no planner or more than seven, `least` is not above 0 or not
        below 1 000, or `colors` are no colours by name.

    See Also
    --------
    uavlab.flight.crash_rate : A rate with its interval.
    bars : Values without intervals.

    Examples
    --------
    >>> from uavlab import plot
    >>> from uavlab.flight import Rate
    >>> rates = {"calm": {"A*": Rate(0.0, 0.0, 3.7)}, "gusts": {"A*": Rate(70.0, 55.0, 87.6)}}
    >>> figure = plot.crash_rates(rates)
    >>> [label.get_text() for label in figure.axes[0].get_yticklabels()]
    ['calm', 'gusts']
    """
    cases = checks.by_name("rates", rates, least=0)
    rates = {case: checks.by_name(f"rates[{case!r}]", cases[case], Rate, least=0) for case in cases}
    planners = list(dict.fromkeys(name for by_planner in rates.values() for name in by_planner))
    if not 1 <= len(planners) <= len(MARKERS):
        raise ValueError(f"rates must hold one to {len(MARKERS)} planners, got {len(planners)}")
    looks = styles(planners, colors)
    least = checks.positive_number("least", least)
    if least >= 1000:
        raise ValueError(f"least must be below 1,000 crashes per 1,000 flights, got {least:g}")
    figure, axes = new_figure(8.6, 0.62 * len(rates) * max(len(planners) / 4, 0.7) + 1.5)
    apart = 0.8 / len(planners)
    for number, (name, (color, _), marker) in enumerate(zip(planners, looks, MARKERS, strict=False)):
        axes.plot([], [], marker, color=color, label=plain(name))
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
    axes.set_yticks(range(len(rates)), [plain(case) for case in rates])
    axes.xaxis.set_major_formatter("{x:,g}")
    axes.grid(axis="x", alpha=0.3)
    for border in range(1, len(rates)):
        axes.axhline(border - 0.5, color="0.85", linewidth=0.8)
    axes.legend(fontsize=8, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return finished(figure)


def in_flight(flights: Mapping[str, Flight], *, colors: Mapping[str, str] | None = None, **limits: float) -> Figure:
    """How flights went, over time: offset across the route, speed over ground and thrust.

    At a corner of the route its direction jumps, and what was along it is across it then: thin lines show where.

    Parameters
    ----------
    flights : mapping of Flight
        By name, at most seven; an X where one crashed.
    colors : mapping of str, optional
        Name → colour, for what should look the same elsewhere, as for `styles`.
    limits : float
        Thrust limits [N] to mark, by name.

    Returns
    -------
    matplotlib.figure.Figure
        Three panels over the time in flight [s].

    Raises
    ------
    ValueError
        If `flights` holds anything else than flights, none that flew, or more than seven that did, one of `limits` is
        no finite number, or `colors` are no colours by name.

    See Also
    --------
    uavlab.flight.fly : Makes a flight.
    tracks : Flights from above.

    Examples
    --------
    >>> from uavlab import plot
    >>> from uavlab.flight import OffsetProcess, fly
    >>> from uavlab.planners import least_risk
    >>> from uavlab.risk import CAMPUS_FLIGHT, reference_campus
    >>> campus = reference_campus()
    >>> flight = fly(least_risk(campus, *CAMPUS_FLIGHT), campus.city, campus.uav, OffsetProcess(1.0), rng=1)
    >>> [axes.get_ylabel() for axes in plot.in_flight({"gusts": flight}).axes]
    ['offset across the route,\\nleft is positive [m]', 'speed over ground\\n[m/s]', 'thrust [N]']
    """
    flown = {name: flight for name, flight in named_flights(flights).items() if len(flight.log)}
    if not 1 <= len(flown) <= len(LINES):
        raise ValueError(f"flights must hold one to {len(LINES)} that flew, got {len(flown)}")
    looks = styles(list(flown), colors)
    limits = {name: checks.number(name, limit, checks.finite) for name, limit in limits.items()}
    figure, panels = plt.subplots(3, 1, figsize=(8.6, 6.4), dpi=DPI, sharex=True, layout="constrained")
    quantities = ("across", "offset across the route,\nleft is positive [m]"), ("speed", "speed over ground\n[m/s]")
    for axes, (column, label) in zip(panels, (*quantities, ("thrust", "thrust [N]")), strict=True):
        for (name, flight), (color, style) in zip(flown.items(), looks, strict=True):
            values = flight.column(column)
            axes.plot(flight.time, values, color=color, linestyle=style, linewidth=1.2, label=plain(name))
            if flight.outcome == "crashed":
                axes.plot(flight.time[-1], values[-1], "x", color=CRASH_COLOR, markersize=9, markeredgewidth=2.5)
        axes.set_ylabel(label)
        axes.grid(alpha=0.3)
    for name, limit in limits.items():
        panels[2].axhline(limit, color="0.4", linewidth=1, linestyle=":")
        panels[2].annotate(plain(name), (0.995, limit), (0, 1), xycoords=("axes fraction", "data"),
                           textcoords="offset points", ha="right", va="bottom", fontsize=8, color="0.3")  # fmt: skip
    panels[2].margins(y=0.12)
    mark_corners(panels[0], flown.values(), [look.color for look in looks])
    panels[0].axhline(0.0, color="0.4", linewidth=1)
    panels[1].set_ylim(bottom=0.0)
    panels[2].set(xlabel="time in flight [s]", xlim=(0, max(flight.duration for flight in flown.values())))
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper center", ncols=3, fontsize=8)
    return finished(figure)


def mark_corners(axes: Axes, flights: Iterable[Flight], colors: Sequence[str]) -> None:
    """A thin line over time wherever a flight passes a corner of its route, with one entry in the legend."""
    passed = [(moment, color) for flight, color in zip(flights, colors, strict=True) for moment in corner_times(flight)]
    for number, (moment, color) in enumerate(passed):
        label = "_" * bool(number) + "corner of the route"
        axes.axvline(moment, color=color, linewidth=0.7, alpha=0.5, label=label)


def corner_times(flight: Flight) -> np.ndarray:
    """When the route turns below a flight by more than `CORNER` (C,) [s]."""
    legs = np.diff(flight.reference, axis=0)
    moved = np.flatnonzero(np.linalg.norm(legs, axis=1) > 1e-9)
    along = legs[moved] / np.linalg.norm(legs[moved], axis=1, keepdims=True)
    sharp = np.einsum("ij,ij->i", along[:-1], along[1:]) < np.cos(CORNER)
    moments = flight.time[moved[1:][sharp]]
    return moments[np.diff(moments, prepend=-np.inf) > TRACK_STEP]  # a step may end within a corner


def safety_domain(samples: npt.ArrayLike, **domains: SafetyDomain) -> Figure:
    """Offsets as a heat map of their density, with the ellipses of safety domains around them (REPARE Fig. 18).

    Parameters
    ----------
    samples : (N, 2) array
        Offsets across the route and up [m], such as `Flights.samples`; N at least 3.
    domains : SafetyDomain
        By name (`_` for a blank), at most three.

    Returns
    -------
    matplotlib.figure.Figure
        Offset across [m] and up [m], density [1/m²] as colour.

    Raises
    ------
    ValueError
        If `samples` hasn't shape (N, 2), isn't finite, has fewer than 3 rows or is constant on an axis, there are more
        than three `domains`, or one of them is no `SafetyDomain`.

    See Also
    --------
    uavlab.offsets.safety_domain : Fits a domain to offsets.
    uavlab.flight.monte_carlo : Makes offsets, by flying.

    Examples
    --------
    >>> import numpy as np
    >>> from uavlab import offsets, plot
    >>> samples = np.random.default_rng(0).normal(size=(5000, 2)) * (1.0, 0.5)
    >>> figure = plot.safety_domain(samples, two_axes=offsets.safety_domain(samples))
    >>> figure.axes[0].get_legend().get_texts()[0].get_text()  # 99.73 % are meant
    'two axes: 99.74% inside'
    """
    points = checks.samples(samples, least=3, axes=2)
    if len(domains) > 3:
        raise ValueError(f"domains must be at most three, got {len(domains)}")
    for name, domain in domains.items():
        checks.instance(name, domain, SafetyDomain)
    outlines = [domain.ellipse for domain in domains.values()]
    reach = 1.15 * max([np.quantile(np.abs(points), 0.9995), *(np.abs(outline).max() for outline in outlines)])
    figure, axes = new_figure(6.6, 5.6)
    edges = np.linspace(-reach, reach, 61)
    counts = np.histogram2d(points[:, 0], points[:, 1], bins=[edges, edges])[0]
    density = counts / len(points) / (edges[1] - edges[0]) ** 2
    image = axes.pcolormesh(edges, edges, np.where(density > 0, density, np.nan).T, cmap=SEQUENTIAL, norm=LogNorm())
    axes.set_facecolor("0.93")
    looks = zip((ORANGE, "#FFFFFF", PINK), ("-", "--", "-."), strict=True)
    for (name, domain), (color, style) in zip(domains.items(), looks, strict=False):
        label = f"{plain(name.replace('_', ' '))}: {domain.in_ellipse:.2%} inside"
        axes.plot(*domain.ellipse.T, color="black", linewidth=3.6)
        axes.plot(*domain.ellipse.T, style, color=color, linewidth=2.2, label=label)
    axes.set(xlabel="offset across the route, left is positive [m]", ylabel="offset up [m]", aspect="equal")
    add_color_bar(figure, axes, image, "density [1/m²], grey: none seen")
    if domains:
        axes.legend(fontsize=8, loc="upper right", facecolor="0.75", framealpha=1.0)
    return finished(figure)


def named_flights(flights: Sequence[Flight] | Mapping[str, Flight]) -> dict[str, Flight]:
    """Flights by name, or by number where they have none."""
    if not isinstance(flights, Sequence | Mapping):
        raise ValueError(f"flights must be a list of Flight, or Flight by name, got {type(flights).__name__}")
    named = flights if isinstance(flights, Mapping) else {f"flight {n + 1}": f for n, f in enumerate(flights)}
    for flight in named.values():
        checks.instance("flights", flight, Flight)
    return {str(name): flight for name, flight in named.items()}


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
