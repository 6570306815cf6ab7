"""Footprints with heights on their way to the map: where they lie on Earth, and on what ground they stand."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
import shapely

from uavlab.city.buildings import THINNEST, polygons_in
from uavlab.city.footprints import Footprint
from uavlab.city.heights import Heights
from uavlab.city.place import Place, System, check_extent, place_at_corner
from uavlab.city.rasters import read_terrain
from uavlab.city.source import Notes
from uavlab.city.terrain import Terrain

SAMPLES = 2.0
"""Between the places at which the ground under a footprint is looked at [m]."""

MOST_SAMPLES = 100
"""Of those, in each direction; under larger footprints they are farther apart."""

STEEP = 10.0
"""A building whose foot is farther above the ground [m] hardly stands on it."""


class Block(NamedTuple):
    """A footprint on the map with its heights."""

    footprint: Footprint
    kind: str
    plan: shapely.MultiPolygon
    """[m]"""
    heights: Heights
    """As the file states them."""
    base: float = np.nan
    """[m], in the file's vertical system; NaN where it isn't known."""
    top: float = np.nan
    site: shapely.MultiPolygon | None = None
    """Of a part, the outline in which it lies [m]: undersides count from the lowest ground there."""

    @property
    def label(self) -> str:
        return self.footprint.label


def plans_of(blocks: Sequence[Block]) -> np.ndarray:
    """Their plans, as an array for shapely."""
    plans = np.empty(len(blocks), dtype=object)
    plans[:] = [block.plan for block in blocks]
    return plans


def placed(blocks: Sequence[Block], system: System | None) -> tuple[Place | None, list[Block]]:
    """Where on Earth the south-west corner of the buildings is, and the buildings in metres east and north of it."""
    points = shapely.get_coordinates(plans_of(blocks))
    if system is None:
        return None, with_plans(blocks, points - points.min(axis=0))
    lonlat = system.to_lonlat(points)
    place = place_at_corner(lonlat)
    return place, with_plans(blocks, place.east_north(lonlat))


def moved(blocks: Sequence[Block], old: Place, new: Place) -> tuple[Place, list[Block]]:
    """The blocks of a place in metres of another one, and that."""
    points = shapely.get_coordinates(plans_of(blocks))
    return new, with_plans(blocks, new.east_north(old.longitude_latitude(points)))


def with_plans(blocks: Sequence[Block], points: np.ndarray) -> list[Block]:
    """The blocks with other coordinates (N, 2) of all their corners."""
    plans = shapely.set_coordinates(plans_of(blocks), points)
    for n in np.flatnonzero(~shapely.is_valid(plans)):  # rounding made corners meet
        plans[n] = shapely.MultiPolygon(polygons_in(shapely.make_valid(plans[n])))
    return [block._replace(plan=plan) for block, plan in zip(blocks, plans, strict=True)]


def with_volume(blocks: Sequence[Block], notes: Notes) -> list[Block]:
    """The blocks without polygons that are too thin to span a volume; those that have no other are left out."""
    parts, owner = shapely.get_parts(plans_of(blocks), return_index=True)
    thick = 2.0 * shapely.area(parts) > THINNEST * shapely.length(parts) / 2.0
    if thick.all() and len(np.unique(owner)) == len(blocks):
        return list(blocks)
    present = np.unique(owner[thick])
    for n in np.setdiff1d(np.arange(len(blocks)), present):
        notes.add("left out", "polygon without area", blocks[n].label)
    if not len(present):
        return []
    plans = shapely.multipolygons(parts[thick], indices=np.searchsorted(present, owner[thick]))
    return [blocks[n]._replace(plan=plan) for n, plan in zip(present, plans, strict=True)]


def check_size(blocks: Sequence[Block], system: System | None) -> None:
    """Refuse what is no city, most of all metres that were read as degrees."""
    bounds = shapely.bounds(plans_of(blocks)).reshape(-1, 2)
    centers = bounds.reshape(-1, 2, 2).mean(axis=1)
    away = np.linalg.norm(centers - np.median(centers, axis=0), axis=1)
    advice = (
        "coordinates were read as degrees; if they are metres, pass crs='local'"
        if system is not None and system.degrees
        else "if the coordinates are in another system, pass its code, as in crs='EPSG:4326'"
    )
    farthest = f"; the farthest from the others is {blocks[int(away.argmax())].label!r:.100}" if len(blocks) > 1 else ""
    check_extent(bounds, advice + farthest)


def ground_below(
    blocks: Sequence[Block], from_sea: bool, terrain: Terrain | Path | float | None, place: Place | None
) -> Terrain | float:
    """The ground on the map, above the height of the place [m]."""
    height = 0.0 if place is None else place.height
    if terrain is None:
        return ground_through_feet(blocks, height) if from_sea else -height
    if isinstance(terrain, float):
        return terrain - height
    surface = terrain if isinstance(terrain, Terrain) else read_terrain(terrain)
    return shifted(surface, height) if surface.system is None else surface.placed(place)


def ground_through_feet(blocks: Sequence[Block], height: float) -> Terrain:
    """The ground through the corners of all buildings whose underside is known, above a height [m]."""
    corners, owner = shapely.get_coordinates(plans_of(blocks), return_index=True)
    bases = np.array([block.heights.base if np.isnan(block.base) else block.base for block in blocks])[owner]
    known = np.isfinite(bases)
    if not known.any():
        raise ValueError(
            "heights_above='sea', but no building has an underside: give base='the property that holds it', or terrain="
        )
    return Terrain.from_points(np.column_stack([corners, bases - height])[known])


def lowest_ground(blocks: Sequence[Block], ground: Terrain | float) -> float:
    """Of the ground under the buildings [m]."""
    return min(low for low, _ in ranges_of_blocks(blocks, ground)) if isinstance(ground, Terrain) else float(ground)


def shifted(ground: Terrain | float, zero: float) -> Terrain | float:
    """The same ground, with heights counted from `zero` [m]."""
    if not isinstance(ground, Terrain):
        return ground - zero
    return Terrain(ground.points - [0.0, 0.0, zero], ground.triangles, beyond=ground.beyond)


def ranges_of_blocks(blocks: Sequence[Block], surface: Terrain) -> list[tuple[float, float]]:
    """Lowest and highest ground under each block [m]."""
    return ranges_under(plans_of(blocks), [block.label for block in blocks], surface)


def ranges_under(plans: np.ndarray, labels: Sequence[str], surface: Terrain) -> list[tuple[float, float]]:
    """Lowest and highest ground under each of several footprints [m].

    Looked for at the terrain's own corners, so that no summit is missed, along the walls, and every few metres inside.
    """
    if not len(plans):
        return []
    summits = shapely.STRtree(shapely.points(surface.points[:, :2]))
    owner, summit = summits.query(plans, predicate="intersects")
    places = [places_in(plan) for plan in plans]
    heights = np.concatenate([surface.heights_at(np.concatenate(places)), surface.points[summit, 2]])
    of = np.concatenate([np.repeat(np.arange(len(plans)), [len(some) for some in places]), owner])
    lowest, highest = np.full(len(plans), np.inf), np.full(len(plans), -np.inf)
    with np.errstate(invalid="ignore"):  # NaN spreads
        np.minimum.at(lowest, of, heights)
        np.maximum.at(highest, of, heights)
    unknown = np.flatnonzero(np.isnan(lowest))
    if len(unknown):
        raise ValueError(
            f"terrain says nothing about the ground under {labels[unknown[0]]!r} and {len(unknown) - 1} other "
            "buildings: give a larger one, or terrain.filled(), which goes on beyond its edges and through holes"
        )
    return list(zip(lowest.tolist(), highest.tolist(), strict=True))


def places_in(plan: shapely.Geometry) -> np.ndarray:
    """Points (N, 2) along the walls and on a grid inside."""
    west, south, east, north = plan.bounds
    step = max(SAMPLES, float(np.sqrt((east - west) * (north - south))) / MOST_SAMPLES)
    x, y = np.meshgrid(np.arange(west, east, step), np.arange(south, north, step))
    inside = shapely.contains_xy(plan, x, y)
    walls = shapely.get_coordinates(shapely.segmentize(plan, step))
    return np.concatenate([walls, np.column_stack([x[inside], y[inside]])])


def extents_of(
    blocks: Sequence[Block], from_sea: bool, ground: Terrain | float, zero: float, notes: Notes
) -> list[tuple[float, float]]:
    """Underside and roof of each block on the map [m].

    Above the sea a building reaches down to the lowest ground below it: no gap is left open between them.
    """
    if isinstance(ground, Terrain):
        ranges, sites = ranges_of_blocks(blocks, ground), lowest_at_sites(blocks, ground)
    else:
        level = ground if from_sea else 0.0
        ranges, sites = [(level, level)] * len(blocks), [level] * len(blocks)
    if from_sea:
        for block, (low, _) in zip(blocks, ranges, strict=True):
            note_far_ground(block.base - zero, block.top - zero, low, block.label, notes)
        return [(min(b.base - zero, low), b.top - zero) for b, (low, _) in zip(blocks, ranges, strict=True)]
    return [
        (min(low, site) + block.base, high + block.top)
        for block, (low, high), site in zip(blocks, ranges, sites, strict=True)
    ]


def lowest_at_sites(blocks: Sequence[Block], ground: Terrain) -> list[float]:
    """Lowest ground at the site of each part that has its underside above the ground [m]; infinite for others."""
    raised = [n for n, block in enumerate(blocks) if block.base > 0 and block.site is not None]
    sites = np.array([blocks[n].site for n in raised], dtype=object)
    lowest = [np.inf] * len(blocks)
    for n, (low, _) in zip(raised, ranges_under(sites, [blocks[n].label for n in raised], ground), strict=True):
        lowest[n] = low
    return lowest


def note_far_ground(bottom: float, top: float, low: float, name: str, notes: Notes) -> None:
    """Note a building that hardly stands on the lowest ground under it [m]: which is likely of other heights."""
    if top <= low:
        notes.add("assumed", "building is wholly below the ground: is its terrain in the heights of the file?", name)
    elif bottom - low > STEEP:
        what = f"building more than {STEEP:g} m above the ground, filled down to it: is that in its heights?"
        notes.add("assumed", what, name)
