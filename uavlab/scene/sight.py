"""From which side a scene shows most of the ways in it, rather than the buildings before them."""

from __future__ import annotations

import numpy as np

from uavlab.city import City
from uavlab.scene.camera import DIRECTIONS, axes_of
from uavlab.scene.drawing import Drawing

SIDES = 24
"""Azimuths that are tried for the overview."""
PLACES, FEWEST = 600, 20
"""On all ways together, evenly spaced, and on each."""
GAIN = 0.05
"""Another side than the usual one has to show so much more, as a share of all places."""
END = 0.1
"""Where a way ends, at its goal or in a crash, counts as much as this share of its places."""


def overview_of(city: City, drawing: Drawing) -> tuple[float, float]:
    """Azimuth and elevation [degrees] from which the ways of a scene are seen best: the usual ones, unless clearly more
    of them is seen from another side.
    """
    usual = DIRECTIONS["overview"]
    count = max(PLACES // len(drawing.movers), FEWEST)
    ways = [evenly(mover.points, count) for mover in drawing.movers]
    places = np.concatenate([np.concatenate([way, np.repeat(way[-1:], int(END * count), axis=0)]) for way in ways])
    turns = sorted(np.linspace(-180, 180, SIDES, endpoint=False), key=lambda turn: (abs(turn), turn))
    sides = [(float((usual[0] + turn + 180) % 360 - 180), usual[1]) for turn in turns]
    seen = [float(in_sight(city, places, side).mean()) for side in sides]
    best = int(np.argmax(seen))
    return sides[best] if seen[best] > seen[0] + GAIN else usual


def evenly(points: np.ndarray, count: int) -> np.ndarray:
    """As many places (count, 3) along a polyline (K, 3)."""
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    return np.stack([np.interp(np.linspace(0, along[-1], count), along, axis) for axis in points.T], axis=1)


def in_sight(city: City, places: np.ndarray, side: tuple[float, float]) -> np.ndarray:
    """Which places (N, 3) [m] nothing stands before, bool (N,), for an eye that is far away on a side."""
    toward = axes_of(*side)[2]
    low, high = city.bounds
    far = (high[2] - places[:, 2].min()) / max(toward[2], 0.05)
    free = np.ones(len(places), bool)
    for step in np.arange(city.cell, min(far, float(np.linalg.norm(high - low))) + city.cell, 0.5 * city.cell):
        points = places[free] + step * toward
        cells = np.floor((points - low) / city.cell).astype(int)
        on_map = ((cells >= 0) & (cells < city.shape)).all(axis=1)
        if not on_map.any():
            break
        hidden = np.zeros(len(points), bool)
        hidden[on_map] = city.occupied[tuple(cells[on_map].T)]
        free[np.flatnonzero(free)[hidden]] = False
    return free
