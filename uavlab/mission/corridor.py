"""Few waypoints for a route of many, within a corridor that stays clear, and where to stop instead of cutting a corner.

An autopilot flies straight from waypoint to waypoint and rounds each corner as soon as it is near. So a leg may replace
a piece of the route if it stays near it and keeps what the route promises all along; and a corner may be rounded if
what lies inside of it is clear, too.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uavlab import checks
from uavlab.city import City
from uavlab.city.bounds import Bounds, keeps
from uavlab.spline.curve import contact_distance

STOP = 1.0
"""How long it stops where it can't round the corner [s]."""

LEAST_RADIUS = 0.01
"""Of acceptance [m]; 0 would be the autopilot's own."""


@dataclass(frozen=True)
class Corridor:
    """Where the legs of a mission may be, and how far from the route."""

    city: City
    bounds: Bounds
    """Obstacles, zones and heights that they keep."""
    width: float
    """How far from the route [m]."""
    follows: bool
    """Whether they follow the ground, or are straight."""
    ceiling: float = np.inf
    """Greatest height above ground [m]."""

    def clear(self, start: np.ndarray, end: np.ndarray, aside: float = 0.0) -> bool:
        """Whether a leg keeps the bounds, with so much room around it [m]."""
        origin, cell = self.city.origin, self.city.cell
        room = (aside + self.rise(start, end)) / cell
        kept = keeps(self.bounds, (start - origin) / cell, (end - origin) / cell, room, 0.0)[0]
        return bool(kept) and self.highest(start, end) <= self.ceiling + 1e-6

    def highest(self, start: np.ndarray, end: np.ndarray) -> float:
        """Greatest height of a leg above the ground [m]; of one that follows it that is at an end."""
        _, above = above_ground(self.city, start, end)
        return float((above if self.follows else extremes(above)).max())

    def rise(self, start: np.ndarray, end: np.ndarray) -> float:
        """How far a leg that follows the ground leaves the straight line, up or down [m]."""
        if not self.follows or self.city.ground is None:
            return 0.0
        share, above = above_ground(self.city, start, end)
        evenly = above[0, 0] + share * (above[2, -1] - above[0, 0])
        return float(np.abs(extremes(above - evenly)).max())

    def thinned(self, points: np.ndarray) -> np.ndarray:
        """Which of the points (N, 3) are waypoints: all others are within the corridor's width of clear legs.

        Raises
        ------
        ValueError
            If the route itself isn't clear, or follows the ground and its own legs are too long for that.
        """
        kept = {0, len(points) - 1}
        pieces = [(0, len(points) - 1)]
        while pieces:
            first, last = pieces.pop()
            if first == last:
                continue
            start, end = points[first], points[last]
            inner = points[first + 1 : last]
            apart = distance_to_leg(inner, start, end)
            farthest = self.rise(start, end) + apart.max(initial=0.0)
            if farthest <= self.width and self.clear(start, end):
                continue
            if len(inner) == 0:
                self.refuse(first, start, end)
            middle = first + 1 + int(np.argmax(apart)) if apart.max() > 0 else (first + last) // 2
            kept.add(middle)
            pieces += [(first, middle), (middle, last)]
        return np.array(sorted(kept))

    def refuse(self, number: int, start: np.ndarray, end: np.ndarray) -> None:
        """Raise: a leg of the route itself can't be flown."""
        between = f"between waypoints {number} {checks.show(start)} and {number + 1} {checks.show(end)}"
        if self.follows and self.rise(start, end) > self.width:
            raise ValueError(
                f"route leaves the ground's slope by {self.rise(start, end):.1f} m {between}, and altitudes='terrain' "
                f"follows it: use route.resample({max(self.city.cell, self.width):g}), or altitudes='home'"
            )
        apart = float(self.city.segment_distance(start, end))
        raise ValueError(
            f"route isn't clear {between}: {apart:.2f} m to an obstacle where it has to keep "
            f"{self.bounds.keep * self.city.cell:.2f} m, or in a no-fly zone, too low or too high; plan it with "
            "min_clearance, min_height and max_height that this UAV can keep"
        )

    def stops(self, points: np.ndarray, radius: float) -> np.ndarray:
        """At which of the waypoints (N, 3) an autopilot that rounds corners by a radius [m] has to stop, (N,) bool."""
        stops = np.zeros(len(points), dtype=bool)
        for number in range(1, len(points) - 1):
            before, here, after = points[number - 1 : number + 2]
            into, out, reach = corner(before, here, after, radius)
            aside = cut_off(into, out, reach)
            parts = (here - reach * into, here), (here, here + reach * out)
            stops[number] = not all(self.clear(*part, aside) for part in parts)
        return stops


def reaches(points: np.ndarray, radius: float) -> np.ndarray:
    """From how near of each waypoint (N, 3) on an autopilot may turn to the next, (N,) [m]: half the legs, where short.

    Else it would be at the next waypoint before it came to this one, and cut more than one corner.
    """
    half = np.linalg.norm(np.diff(points, axis=0), axis=1) / 2
    inner = np.minimum(half[:-1], half[1:])
    return np.clip(np.concatenate([[radius], inner, [radius]]), LEAST_RADIUS, radius)


def corner(
    before: np.ndarray, here: np.ndarray, after: np.ndarray, radius: float
) -> tuple[np.ndarray, np.ndarray, float]:
    """Directions into a corner and out of it, and from how far before to how far after it is rounded [m]."""
    into, out = here - before, after - here
    lengths = float(np.linalg.norm(into)), float(np.linalg.norm(out))
    return into / lengths[0], out / lengths[1], min(radius, lengths[0] / 2, lengths[1] / 2)


def cut_off(into: np.ndarray, out: np.ndarray, reach: float) -> float:
    """How far inside of a corner a way may lie from its legs: half the reach times the sine of the turn.

    The way stays in the triangle of the corner and the ends of the reach. Of all points in it, the middle of the third
    side is farthest from both legs. Beyond a right angle that is taken as half the reach.
    """
    along = float(np.clip(into @ out, -1.0, 1.0))
    return reach / 2 * (float(np.sqrt(1 - along**2)) if along > 0 else 1.0)


def distance_to_leg(points: np.ndarray, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Distance of points (N, 3) from a straight leg [m]."""
    share = share_of_leg(points, start, end)
    return np.linalg.norm(points - start - share[:, None] * (end - start), axis=1)


def nearest_on_leg(points: np.ndarray, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """The points of a straight leg that are nearest to points (N, 3), (N, 3) [m]."""
    return start + share_of_leg(points, start, end)[:, None] * (end - start)


def share_of_leg(points: np.ndarray, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Where on a straight leg the nearest points lie, from 0 at its start to 1 at its end, (N,)."""
    leg = end - start
    return np.clip((points - start) @ leg / max(float(leg @ leg), 1e-30), 0.0, 1.0)


def above_ground(city: City, start: np.ndarray, end: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Height of a straight leg above the ground, in pieces in which the ground is a parabola.

    Returns
    -------
    share : (3, P) array
        Of the leg, at the beginning, in the middle and at the end of each piece. Where it crosses a line between the
        centres of columns the ground bends.
    above : (3, P) array
        [m]
    """
    (x, y), (dx, dy) = ((start - city.origin) / city.cell - 0.5)[:2], ((end - start) / city.cell)[:2]
    cuts = [np.array([0.0, 1.0])]
    for first, extent in ((x, dx), (y, dy)):
        lines = np.arange(np.ceil(min(first, first + extent)), np.floor(max(first, first + extent)) + 1)
        cuts += [np.clip((lines - first) / extent, 0.0, 1.0)] if extent else []
    cut = np.unique(np.concatenate(cuts)) if city.ground is not None else cuts[0]
    share = np.stack([cut[:-1], (cut[:-1] + cut[1:]) / 2, cut[1:]])
    return share, city.height_above_ground(start + share[..., None] * (end - start))


def extremes(values: np.ndarray) -> np.ndarray:
    """Values of parabolas at beginning, middle and end (3, P), and where each turns or is next to it, (4, P)."""
    first, middle, last = values
    bend, slope = 2 * (first - 2 * middle + last), 4 * middle - 3 * first - last
    at = np.clip(-slope / np.where(bend == 0, np.inf, 2 * bend), 0.0, 1.0)
    return np.vstack([values, first + at * (slope + at * bend)])


def zone_on_way(city: City, points: np.ndarray) -> str:
    """Name of a no-fly zone that a way through points (N, 3) [m] enters, empty if none; above the map as at its top."""
    highest = city.bounds[1, 2] - city.cell / 2
    index, _ = city.voxels_along(np.column_stack([points[:, :2], np.minimum(points[:, 2], highest)]))
    index = index[((index >= 0) & (index < city.shape)).all(axis=1)]
    closed = index[city.in_no_fly[tuple(index.T)]]
    return city.zone_at(city.center_of(closed[0])) if len(closed) else ""


def floor_below(city: City, point: np.ndarray) -> tuple[float, float]:
    """What a UAV above it would land on [m]: the roof or the ground itself, and the top of the voxels that hold it."""
    i, j, k = np.clip(city.cell_of(point), 0, np.array(city.shape) - 1)
    below = np.flatnonzero(city.occupied[i, j, : k + 1])
    top = float(city.origin[2] + city.cell * (below[-1] + 1)) if len(below) else float(city.origin[2])
    return float(city.surface_below[i, j, k]), top


def touchable(city: City, point: np.ndarray, diameter: float) -> float:
    """Up to which height a UAV that starts or lands below a point may touch what it stands on: its own, a voxel's."""
    return floor_below(city, point)[1] + max(diameter, city.cell)


def room_in_column(city: City, point: np.ndarray, diameter: float) -> tuple[float, str]:
    """Least distance between a column of air, but for its last bit, and what is higher than its floor [m]; to what."""
    floor, high = floor_below(city, point)[1], point[2]
    low = min(touchable(city, point, diameter), high)
    aside = [np.maximum(np.abs(point[axis] - city.coordinates(axis)) - city.cell / 2, 0.0) for axis in (0, 1)]
    bottom = city.origin[2] + city.cell * np.arange(city.shape[2])
    above = np.maximum(np.maximum(bottom - high, low - bottom - city.cell), 0.0)
    apart = np.sqrt(aside[0][:, None, None] ** 2 + aside[1][:, None] ** 2 + above**2)
    higher = city.occupied & (bottom > floor - city.cell / 2)
    room = float(apart[higher].min(initial=np.inf))
    if np.isinf(room):
        return room, "nothing on the map is higher than what lies below,"
    built = (city.occupied & (bottom >= city.range_of_ground[1][..., None])).any(axis=2)
    walls = float(apart[higher & built[..., None]].min(initial=np.inf))
    rising = f"to rising ground, {'no wall on the map' if np.isinf(walls) else f'{walls:.3g} m to walls'},"
    return room, "to walls" if walls <= room else rising


def check_column(city: City, name: str, point: np.ndarray, diameter: float) -> float:
    """Height z of what lies below a point, from where a UAV can rise to it without touching a wall [m].

    Where it is `touchable`, it may touch what it stands on.
    """
    surface, _ = floor_below(city, point)
    low = np.array([*point[:2], touchable(city, point, diameter)])
    if low[2] < point[2]:
        apart = float(city.segment_distance(low, point))
        if apart < contact_distance(diameter):
            raise ValueError(
                f"{name} at {checks.show(point)}: between it and what lies below, {point[2] - surface:.1f} m deeper, a "
                f"wall is {apart:.2f} m away, and a UAV of {diameter:g} m needs {diameter / 2:g} m: begin and end a "
                "route where it can rise and land"
            )
    zone = zone_on_way(city, np.array([(*point[:2], surface), point]))
    if zone:
        raise ValueError(
            f"{name} at {checks.show(point)}: between it and what lies below is no-fly zone {zone!r}: begin and end a "
            "route where it can rise and land"
        )
    return surface
