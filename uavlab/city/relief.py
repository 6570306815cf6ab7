"""The ground that a city model tells: from its relief, and where that ends from the feet of the buildings."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely

from uavlab.city.solids import THINNEST, Body, Surface, plans_of, triangles_of
from uavlab.city.terrain import Terrain


def feet_of(bodies: Sequence[Body]) -> np.ndarray:
    """Corners (N, 3) [m] of the lowest surfaces of a building: its level floor, else a sloped one that looks down."""
    surfaces = [surface for body in bodies for surface in body.surfaces]
    heights = [np.concatenate(surface)[:, 2] for surface in surfaces]
    bottom = min(z.min() for z in heights) + THINNEST
    lowest = [(surface, np.ptp(z)) for surface, z in zip(surfaces, heights, strict=True) if z.min() < bottom]
    floors = [surface[0] for surface, rise in lowest if rise < THINNEST]
    floors = floors or [surface[0] for surface, _ in lowest if looks_down(surface[0])]
    if floors:
        return np.concatenate(floors)
    corners = np.concatenate([ring for surface in surfaces for ring in surface])
    return corners[corners[:, 2] < bottom]


def looks_down(ring: np.ndarray) -> bool:
    """Whether a ring runs clockwise, seen from above, around an area that isn't a wall's."""
    x, y = (ring[:, :2] - ring[0, :2]).T
    area = (x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2
    return bool(area < -THINNEST)


def ground_below(relief: Sequence[Surface], feet: np.ndarray) -> Terrain | float:
    """The ground from surfaces of a relief and from feet of buildings (N, 3) [m] beside it; level if all are."""
    plans = plans_of(relief)
    pieces = [
        triangle
        for surface, plan in zip(relief, plans, strict=True)
        for triangle in triangles_of(surface, plan, top_only=True)
    ]
    if pieces:
        within = shapely.STRtree(plans).query(shapely.points(feet[:, :2]), predicate="intersects")[0]
        points, of_triangles = np.unique(np.concatenate(pieces), axis=0, return_inverse=True)
        beside = np.delete(feet, np.unique(within), axis=0)  # corners of no triangle count where the relief ends
        return Terrain(np.vstack([points, beside]), of_triangles.reshape(-1, 3), beyond="nearest")
    if not len(feet):
        return 0.0
    return float(feet[:, 2].min()) if np.ptp(feet[:, 2]) < THINNEST else Terrain.from_points(feet)
