"""Stages: what a simulated vehicle flies without a stop.

From waypoint to waypoint it turns before it is there, as autopilots do: corners are rounded by arcs of a parabola. Only
where the item says wait, and at the end, does it fly up to the point itself.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from uavlab.mission.corridor import corner
from uavlab.mission.items import Item

NO_LENGTH = 0.1
"""Legs that are shorter have no direction, and their corners aren't rounded [m]."""

CORNER_POINTS = 6
USUAL_RADIUS = 2.0
"""Of acceptance, where an item has none [m]."""


class Stage(NamedTuple):
    """What is flown without a stop."""

    points: np.ndarray
    """(N, 3) [m]"""
    speeds: np.ndarray
    """On the way to each of them [m/s]."""
    reached: tuple[tuple[float, int], ...]
    """How far along the path each item is reached [m], and its number."""
    hold: float
    """At its end [s]; infinite to stay."""
    low: bool
    """Whether it takes off or lands, and may touch the ground."""


BETWEEN = -1
"""Number of what is passed between items."""

Passed = tuple[int, np.ndarray, float, Item]
"""Number of an item, its point (3,) [m], speed on the way there [m/s], and the item."""


def rounded(begin: np.ndarray, legs: list[Passed], hold: float) -> Stage:
    """Waypoints with their corners rounded, but for the last one, where it stops."""
    places = np.vstack([begin, *[point for _, point, _, _ in legs]])
    points, speeds, marks = [], [], []
    for at, (number, here, speed, item) in enumerate(legs, 1):
        lengths = [float(np.linalg.norm(places[n + 1] - places[n])) for n in range(at - 1, min(at + 1, len(legs)))]
        if at == len(legs) or number == BETWEEN or min(lengths) < NO_LENGTH:
            arc = here[None]
        else:
            into, out, reach = corner(places[at - 1], here, places[at + 1], item.parameters[1] or USUAL_RADIUS)
            share = np.linspace(0.0, 1.0, CORNER_POINTS)[:, None]
            arc = here - (1 - share) ** 2 * reach * into + share**2 * reach * out
        points.append(arc)
        speeds.append(np.full(len(arc), speed))
        if number != BETWEEN:
            done = np.vstack([begin, *points[:-1], arc[: len(arc) // 2 + 1]])
            marks.append((float(np.linalg.norm(np.diff(done, axis=0), axis=1).sum()), number))
    return Stage(np.vstack(points), np.concatenate(speeds), tuple(marks), hold, False)
