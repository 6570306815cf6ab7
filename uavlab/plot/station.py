"""What a ground station shows: the track beside the plan, height, battery, and how far it is off."""

from __future__ import annotations

from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from uavlab import checks
from uavlab.mavlink import FlightLog
from uavlab.mission.fences import polygon_on
from uavlab.plot.colors import BLACK, BLUE, CRASH_COLOR, GREEN, ORANGE
from uavlab.plot.flights import draw_planned
from uavlab.plot.ground import built_columns
from uavlab.plot.style import DPI, draw_map, finished

FLOWN, PLANNED, FENCE, BREACH = BLUE, BLACK, GREEN, ORANGE
BUILT = "#c7c7c7"
"""As the map has it."""


def ground_station(log: FlightLog) -> Figure:
    """A flight as a ground station sees it, while it goes on or after it.

    Parameters
    ----------
    log : FlightLog
        With what was heard so far.

    Returns
    -------
    matplotlib.figure.Figure
        From above, the plan, the fence and the track; over time, height above home, distance from the plan, speed and
        battery. A diamond where the fence was left, an X where it crashed.

    Raises
    ------
    ValueError
        If `log` is no FlightLog.

    See Also
    --------
    uavlab.mavlink.follow : What is heard.
    tracks : Many flights from above.

    Examples
    --------
    >>> from uavlab import plot
    >>> from uavlab.city import table1_city
    >>> from uavlab.mavlink import FlightLog, Telemetry
    >>> from uavlab.mission import Mission
    >>> from uavlab.route import Route
    >>> from uavlab.vehicle import LIGHT_QUADROTOR
    >>> city, route = table1_city(), Route([(5, 5, 30), (40, 5, 30), (40, 50, 30)])
    >>> mission = Mission.from_route(route, city, LIGHT_QUADROTOR, home=(4.36, 52.01))
    >>> heard = Telemetry(9.0, 4.36, 52.01, 31.0, 31.0, (5.0, 0.0, 0.0), 97.0, "mission", True, 2)
    >>> [axes.get_ylabel() for axes in plot.ground_station(FlightLog(mission, city, [heard])).axes]
    ['y, north [m]', 'height above home [m]', 'off the plan [m]', 'speed [m/s]', 'battery [%]']
    """
    checks.instance("log", log, FlightLog)
    figure = plt.figure(figsize=(11.0, 6.0), dpi=DPI, layout="constrained")
    grid = figure.add_gridspec(4, 2, width_ratios=(1.15, 1.0))
    seen_from_above(figure.add_subplot(grid[:, 0]), log)
    panels = [figure.add_subplot(grid[row, 1]) for row in range(4)]
    position, home = log.position, log.mission.home_on(log.city)
    speed = np.array([np.linalg.norm(one.velocity) for one in log.samples])
    began = log.time[0] if len(log.samples) else 0.0
    series = (
        ("height above home [m]", position[:, 2] - home[2]),
        ("off the plan [m]", log.deviation),
        ("speed [m/s]", speed),
        ("battery [%]", log.battery),
    )
    for axes, (label, values) in zip(panels, series, strict=True):
        axes.plot(log.time - began, values, color=FLOWN)
        for moment in log.breaches - began:
            axes.axvline(moment, color=BREACH, linestyle=":")
        axes.set_ylabel(label, fontsize=8)
        axes.grid(alpha=0.3)
        axes.set_ylim(bottom=0.0, top=105.0 if label.startswith("battery") else None)
    for axes in panels[:-1]:
        axes.sharex(panels[-1])
        axes.tick_params(labelbottom=False)
    panels[-1].set_xlabel("time since the station began to follow [s]")
    return finished(figure)


def seen_from_above(axes: Axes, log: FlightLog) -> None:
    """The map with plan, fence and track."""
    city, mission, position = log.city, log.mission, log.position
    draw_map(axes, city, np.where(built_columns(city), 1.0, np.nan), "Greys", vmin=0.0, vmax=3.0)
    draw_planned(axes, mission.path(city))
    parts: list[tuple[str, Any, str, str]] = [
        (BUILT, "", "s", "building"), (PLANNED, "--", "", "plan"), (FLOWN, "-", "", "track, as GPS has it"),
        (PLANNED, "", "o", "home"), (PLANNED, "", "^", "end"),
    ]  # fmt: skip
    for polygon in mission.fence:
        x, y = polygon_on(mission.place_on(city), polygon).exterior.xy
        axes.plot(x, y, color=FENCE, linestyle="-." if polygon.inclusion else ":", linewidth=1.4)
    if mission.fence:
        parts.append((FENCE, "-.", "", "fence"))
    axes.plot(*position[:, :2].T, color=FLOWN, linewidth=1.6)
    there = position[np.isin(log.time, log.breaches)]
    if len(there):
        axes.plot(*there[:, :2].T, "D", color=BREACH, markersize=8, markeredgecolor="white")
        parts.append((BREACH, "", "D", "fence left"))
    if log.outcome == "crashed":
        axes.plot(*position[-1:, :2].T, "x", color=CRASH_COLOR, markersize=9, markeredgewidth=2.5)
        parts.append((CRASH_COLOR, "", "x", "crash"))
    latest = log.samples[-1] if len(log.samples) else None
    mode = "" if latest is None else latest.mode if latest.armed else log.outcome
    axes.set_title(
        "nothing heard yet" if latest is None else f"after {latest.time - log.time[0]:.0f} s: {mode}", fontsize=10
    )
    axes.margins(0.02)
    axes.autoscale()
    handles = [Line2D([], [], color=c, linestyle=line, marker=m, label=label) for c, line, m, label in parts]
    axes.figure.legend(handles=handles, loc="outside lower center", ncols=len(handles), fontsize=8)
