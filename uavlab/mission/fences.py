"""The fence of a mission: a polygon to stay inside of, and no-fly zones to stay outside of."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely

from uavlab.city import City, NoFlyZone
from uavlab.city.buildings import convex_parts
from uavlab.city.place import Place
from uavlab.mission.items import FencePolygon, on_wire

CORNERS = 2
"""Of the fence, for a quarter of a circle around a corner of the hull."""


def inclusion(place: Place, points: np.ndarray, margin: float) -> FencePolygon:
    """The convex hull of points (N, 2) [m], wider by a margin: with it the straight way home is inside, too."""
    reach = margin / np.cos(np.pi / (4 * CORNERS))  # corners lie on a circle, the edges between them are nearer
    hull = shapely.MultiPoint(points).buffer(reach, quad_segs=CORNERS).convex_hull
    return polygon_at(place, hull, True, "fence")


def exclusions(city: City, place: Place, points: np.ndarray) -> tuple[list[FencePolygon], list[str]]:
    """No-fly zones as polygons; and the names of those that the way through points (N, 3) passes above or below.

    A fence knows no heights. So a zone that the way crosses in plan can't be in it, or no autopilot would take the
    mission; whether the way is clear of the zone itself is asked elsewhere.
    """
    line = shapely.LineString(points[:, :2])
    closed, left_out = [], []
    for zone in city.no_fly:
        parts = pieces(zone)
        if any(part.intersects(line) for part in parts):
            left_out.append(zone.name)
        else:
            closed += [polygon_at(place, part, False, zone.name) for part in parts]
    return closed, left_out


def pieces(zone: NoFlyZone) -> Sequence[shapely.Polygon]:
    """A zone in polygons without holes."""
    if not zone.holes:
        return [zone.polygon]
    return [shapely.Polygon(part) for part in convex_parts(zone.polygon)]


def polygon_at(place: Place, polygon: shapely.Polygon, inside: bool, name: str) -> FencePolygon:
    """A polygon on the map [m] as one of a fence; corners that are the same as they travel are one."""
    degrees = place.longitude_latitude(shapely.get_coordinates(polygon.exterior)[:-1])
    corners = tuple((on_wire(latitude), on_wire(longitude)) for longitude, latitude in degrees.tolist())
    return FencePolygon(tuple(dict.fromkeys(corners)), inside, name)


def polygon_on(place: Place, polygon: FencePolygon) -> shapely.Polygon:
    """The way back: a polygon of a fence on the map [m]."""
    return shapely.Polygon(place.east_north(np.array(polygon.corners)[:, ::-1]))
