"""Footprints with heights on their way to the map: where they lie on Earth, and on what ground they stand."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import shapely

from uavlab import checks
from uavlab.city.documents import lowest_corner
from uavlab.city.footprints import Footprint
from uavlab.city.place import Place, System
from uavlab.city.rasters import read_terrain
from uavlab.city.source import Notes
from uavlab.city.terrain import Terrain

SAMPLES = 2.0
"""Between the places at which the ground under a footprint is looked at [m]."""


class Block(NamedTuple):
    """A footprint on the map with its heights."""

    footprint: Footprint
    kind: str
    plan: shapely.MultiPolygon
    """[m]"""
    base: float
    """[m]; NaN where it isn't known."""
    top: float


def advice_on(system: System | None) -> str:
    if system is not None and system.degrees:
        return "coordinates were read as degrees; if they are metres, pass crs='local'"
    return "if the coordinates are in another system, pass its code, as in crs='EPSG:4326'"


def placed(blocks: Sequence[Block], system: System | None) -> tuple[Place | None, list[Block]]:
    """Where on Earth the south-west corner of the buildings is, and the buildings in metres east and north of it."""
    plans = np.array([block.plan for block in blocks], dtype=object)
    points = shapely.get_coordinates(plans)
    if system is None:
        return None, with_plans(blocks, points - points.min(axis=0))
    lonlat = system.to_lonlat(points)
    place = Place(*lonlat[0].tolist())
    for _ in range(3):  # the axes turn a little when their origin moves
        place = Place(*place.longitude_latitude(place.east_north(lonlat).min(axis=0)).tolist())
    return place, with_plans(blocks, place.east_north(lonlat))


def moved(blocks: Sequence[Block], old: Place, new: Place) -> tuple[Place, list[Block]]:
    """The blocks of a place in metres of another one, and that."""
    points = shapely.get_coordinates(np.array([block.plan for block in blocks], dtype=object))
    return new, with_plans(blocks, new.east_north(old.longitude_latitude(points)))


def with_plans(blocks: Sequence[Block], points: np.ndarray) -> list[Block]:
    """The blocks with other coordinates (N, 2) of all their corners."""
    plans = shapely.set_coordinates(np.array([block.plan for block in blocks], dtype=object), points)
    return [block._replace(plan=plan) for block, plan in zip(blocks, plans, strict=True)]


def check_extent(blocks: Sequence[Block], system: System | None) -> None:
    """Refuse what is no city, most of all metres that were read as degrees."""
    bounds = shapely.bounds(np.array([block.plan for block in blocks], dtype=object)).reshape(-1, 2)
    lowest_corner(np.column_stack([bounds, np.zeros(len(bounds))]), advice_on(system))


def ground_below(
    blocks: Sequence[Block], above_sea: bool, terrain: Any, place: Place | None, notes: Notes
) -> Terrain | float:
    """The ground on the map, above the height of the place [m]."""
    height = 0.0 if place is None else place.height
    if terrain is None and not above_sea:
        notes.add("derived", "level ground at z = 0", count=0)
        return -height
    if isinstance(terrain, int | float):
        checks.finite("terrain", terrain)
        return float(terrain) - height
    if terrain is None:
        corners, owner = shapely.get_coordinates(
            np.array([block.plan for block in blocks], dtype=object), return_index=True
        )
        bases = np.array([block.base for block in blocks])[owner]
        notes.add("derived", "ground through the feet of the buildings, linear in between", count=0)
        return Terrain.from_points(np.column_stack([corners, bases - height]))
    surface = read_terrain(terrain) if isinstance(terrain, str | Path) else terrain
    checks.instance("terrain", surface, Terrain)
    notes.add("derived", "ground from the terrain given", count=0)
    return shifted(surface, height) if surface.system is None else surface.placed(place)


def lowest_ground(blocks: Sequence[Block], ground: Terrain | float) -> float:
    """Of the ground under the buildings [m]."""
    return min(low for low, _ in ranges_under(blocks, ground)) if isinstance(ground, Terrain) else float(ground)


def shifted(ground: Terrain | float, zero: float) -> Terrain | float:
    """The same ground, with heights counted from `zero` [m]."""
    if not isinstance(ground, Terrain):
        return ground - zero
    return Terrain(ground.points - [0.0, 0.0, zero], ground.triangles, beyond=ground.beyond)


def ranges_under(blocks: Sequence[Block], surface: Terrain) -> list[tuple[float, float]]:
    """Lowest and highest ground under each footprint, looked for at its corners and every few metres inside [m]."""
    places = [places_in(block.plan) for block in blocks]
    heights = surface.heights_at(np.concatenate(places))
    ends = np.cumsum([len(some) for some in places])
    ranges = []
    for block, under in zip(blocks, np.split(heights, ends[:-1]), strict=True):
        if np.isnan(under).any():
            raise ValueError(
                f"terrain says nothing about the ground under {block.footprint.label!r}: give a larger one, or "
                "terrain.filled(), which goes on beyond its edges and through holes"
            )
        ranges.append((float(under.min()), float(under.max())))
    return ranges


def places_in(plan: shapely.MultiPolygon) -> np.ndarray:
    west, south, east, north = plan.bounds
    x, y = np.meshgrid(np.arange(west, east, SAMPLES), np.arange(south, north, SAMPLES))
    inside = shapely.contains_xy(plan, x, y)
    return np.concatenate([shapely.get_coordinates(plan), np.column_stack([x[inside], y[inside]])])


def extents_of(
    blocks: Sequence[Block], above_sea: bool, ground: Terrain | float, zero: float
) -> list[tuple[float, float]]:
    """Underside and roof of each block on the map [m]."""
    if above_sea:
        return [(block.base - zero, block.top - zero) for block in blocks]
    if not isinstance(ground, Terrain):
        return [(block.base, block.top) for block in blocks]
    ranges = ranges_under(blocks, ground)
    return [(low + block.base, high + block.top) for block, (low, high) in zip(blocks, ranges, strict=True)]
