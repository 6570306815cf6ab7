"""Footprints with heights from GeoJSON, as exports of OpenStreetMap and of city registers have them.

Where a height stands, how it is written, and in which system the coordinates are, differs from file to file. What can
be understood is; what has to be assumed is said in `City.source`, and in one warning; what can't be known is asked for.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import shapely

from uavlab import checks
from uavlab.city.buildings import Building, convex_parts, extrude
from uavlab.city.documents import count, lowest_corner, progress, read_json
from uavlab.city.footprints import (
    BUILDING,
    OTHER,
    PART,
    Footprint,
    declared_system,
    features_of,
    footprints_of,
    kinds_of,
    rest_of,
    without_parts,
)
from uavlab.city.heights import Wording, heights_of
from uavlab.city.model import City
from uavlab.city.place import Place, System, metres_per, system_for
from uavlab.city.rasters import read_terrain
from uavlab.city.source import Notes
from uavlab.city.terrain import Terrain
from uavlab.city.zones import NoFlyZone

STOREY_HEIGHT = 3.0
"""Of a storey [m], where a file counts storeys."""

ABOVE = ("auto", "ground", "sea")

OSM_BASE = "min_height"
"""OpenStreetMap's key of an underside, which is always above ground."""

SAMPLES = 2.0
"""Between the places at which the ground under a footprint is looked at [m]."""


def read_geojson(
    path: str | Path,
    *,
    height: str | float = "height",
    base: str | float = OSM_BASE,
    default_height: float | None = None,
    storey_height: float = STOREY_HEIGHT,
    heights_above: str = "auto",
    height_unit: str | None = None,
    crs: Any = None,
    terrain: Terrain | str | Path | float | None = None,
    cell: float = 1.0,
    margin: float = 20.0,
    voxels: str = "touched",
    no_fly: Sequence[NoFlyZone] = (),
) -> City:
    """Read footprints with heights from a GeoJSON file (RFC 7946), for example an export of OpenStreetMap.

    Every polygon of a building becomes a prism. In a file with OpenStreetMap's keys, other polygons are no buildings
    unless they have a height, and parts (`building:part`) override the outline that they lie in. Broken outlines are
    mended. x = y = 0 is the south-west corner of the buildings, z = 0 the lowest ground at one.

    Parameters
    ----------
    path : str or Path
        UTF-8 text: a feature collection, a feature or a geometry; or a sequence of these.
    height : str or float
        Property that holds the height of the roof above ground, a number or a text like "12,5 m" or "40 ft"; one whose
        name ends in "levels" counts storeys. Or one height for all buildings [m]. Where it says nothing, the height is
        `building:levels` (or `num_floors`) times `storey_height`, plus that of the roof, else `default_height`.
    base : str or float
        Property that holds the height of the underside above ground, or one for all [m]; else `building:min_level` (or
        `min_floor`) times `storey_height`, else 0. Above 0 the building floats.
    default_height : float, optional
        Of buildings whose height isn't known [m]; without it they are refused.
    storey_height : float
        [m], above 0.
    heights_above : {"auto", "ground", "sea"}
        What heights and bases are measured from. "sea": bases are the heights of the ground above the sea, and the
        ground goes through them. "auto" takes that where `base` is not OpenStreetMap's `min_height` and most bases are
        1 m and more.
    height_unit : {"m", "ft", "us-ft"}, optional
        Of heights without a unit; by default that of the reference system.
    crs : anything that pyproj takes, or "local", optional
        The reference system of the coordinates; by default the one that the file names, else degrees where they can
        be, else metres from somewhere ("local") where they are small.
    terrain : Terrain, path of one, or float, optional
        The ground; a building then stands from the lowest ground under its footprint to its height above the highest,
        which is the safe side. By default it is flat at z = 0.
    cell, margin, voxels, no_fly
        As for `City.from_buildings`.

    Returns
    -------
    City
        `source` says what was taken, mended, derived, assumed and left out.

    Raises
    ------
    ValueError
        If the file is broken or has no polygon; a height is not known; the reference system is not known, or can't be
        that of the coordinates; or the map would have over 500 million voxels.

    Warns
    -----
    UserWarning
        If anything was assumed or left out.
    """
    checks.positive_number("storey_height", storey_height)
    if default_height is not None:
        checks.positive_number("default_height", default_height)
    checks.one_of("heights_above", heights_above, ABOVE)
    path, notes = Path(path), Notes()
    documents = read_json(path)
    features = [feature for document in documents for feature in features_of(document, path)]
    footprints = footprints_of(features, notes)
    if not footprints:
        kinds = count(kind_of_geometry(feature) for feature in features)
        raise ValueError(f"{path.name} has no polygon; its features are {kinds}")
    bounds = shapely.total_bounds([footprint.polygons for footprint in footprints])
    system = system_for(bounds, declared_system(documents[0]), crs, path.name)
    factor = metres_per(height_unit) if height_unit is not None else 1.0 if system is None else system.height_factor
    note_system(notes, system, crs, declared_system(documents[0]), height_unit)
    wording = Wording(height, base, default_height, storey_height, factor)
    place = None if system is None else Place(*system.to_lonlat(bounds[:2]).tolist())
    bodies = bodies_of(footprints, placed(footprints, system, place, bounds[:2]), wording, notes)
    bodies = with_heights(bodies, wording, notes, path)
    bodies = overridden_by_parts(bodies, notes)
    lowest_corner(np.array([[*body.plan.bounds[a : a + 2], 0.0] for body in bodies for a in (0, 2)]), advice_on(system))
    above_sea = heights_above == "sea" or (
        heights_above == "auto" and base != OSM_BASE and mostly_raised(bodies, notes)
    )
    ground, zero = ground_below(bodies, above_sea, terrain, place, notes)
    buildings = [
        building_of(body, *extent)
        for body, extent in zip(progress(bodies, "buildings"), extents_of(bodies, above_sea, ground), strict=True)
    ]
    source = notes.source(path.name, "GeoJSON")
    city = City.from_buildings(
        buildings,
        cell=cell,
        margin=margin,
        name=path.name.split(".")[0],
        reference=None if place is None else place._replace(height=zero),
        source=source,
        terrain=ground,
        voxels=voxels,
        no_fly=no_fly,
    )
    source.warn()
    return city


class Body(NamedTuple):
    """A footprint on the map with its heights."""

    footprint: Footprint
    kind: str
    plan: shapely.MultiPolygon
    """[m]"""
    base: float
    """[m]; NaN where it isn't known."""
    top: float


def kind_of_geometry(feature: Mapping[str, Any]) -> Any:
    geometry = feature.get("geometry")
    return geometry.get("type") if isinstance(geometry, dict) else geometry


def note_system(notes: Notes, system: System | None, given: Any, declared: Any, height_unit: str | None) -> None:
    """Say in which system coordinates and heights are."""
    if system is None:
        kind = "derived" if given is not None else "assumed"
        notes.add(kind, "coordinates in metres, of an unknown place (crs='EPSG:...' names their system)", count=0)
    else:
        named = " (no crs: longitude and latitude, as in RFC 7946)" if given is None and declared is None else ""
        notes.add("derived", f"place: {system.accuracy}{named}", count=0)
    unit = height_unit or ("metre" if system is None else system.height_unit)
    if unit not in ("metre", "m"):
        notes.add("derived", f"heights without a unit are in {unit}", count=0)


def advice_on(system: System | None) -> str:
    if system is not None and system.degrees:
        return "coordinates were read as degrees; if they are metres, pass crs='local'"
    return "if the coordinates are in another system, pass its code, as in crs='EPSG:4326'"


def placed(
    footprints: Sequence[Footprint], system: System | None, place: Place | None, corner: np.ndarray
) -> list[shapely.MultiPolygon]:
    """The polygons in metres east and north of the place, all at once."""
    polygons = np.array([footprint.polygons for footprint in footprints], dtype=object)
    points = shapely.get_coordinates(polygons)
    local = points - corner if system is None or place is None else place.east_north(system.to_lonlat(points))
    return list(shapely.set_coordinates(polygons, local))


def bodies_of(
    footprints: Sequence[Footprint], plans: Sequence[shapely.MultiPolygon], wording: Wording, notes: Notes
) -> list[Body]:
    """Buildings and their parts, with the heights that are known."""
    heights = [heights_of(footprint, wording, notes) for footprint in footprints]
    kinds = kinds_of(footprints, [not np.isnan(top) for _, top in heights])
    others = kinds.count(OTHER)
    if others:
        notes.add("derived", f"{OTHER}: polygons that are no building and have no height", count=others)
    return [
        Body(footprint, kind, plan, base, top)
        for footprint, kind, plan, (base, top) in zip(footprints, kinds, plans, heights, strict=True)
        if kind != OTHER
    ]


def with_heights(bodies: Sequence[Body], wording: Wording, notes: Notes, path: Path) -> list[Body]:
    """All bodies with a height; parts without one wait for their outline. `ValueError` where none is known."""
    unknown = [body for body in bodies if np.isnan(body.top) and body.kind == BUILDING]
    if unknown and wording.default_height is None:
        known = sorted({key for body in bodies for key in body.footprint.properties})
        raise ValueError(
            f"{len(unknown)} of {len(bodies)} buildings in {path.name} have no height that can be understood, with "
            f"height={wording.height!r}, nor storeys; the first is {unknown[0].footprint.label!r} with "
            f"{unknown[0].footprint.properties.get(str(wording.height))!r}. Properties in the file: "
            f"{', '.join(known) or 'none'}. Pass default_height=10.0, or height='one of them', or a number for all"
        )
    for body in unknown:
        notes.add("assumed", f"height of {wording.default_height:g} m (default_height)", body.footprint.label)
    return [
        body._replace(top=max(float(wording.default_height), body.base + 1.0))
        if np.isnan(body.top) and body.kind == BUILDING and wording.default_height is not None
        else body
        for body in bodies
    ]


def overridden_by_parts(bodies: Sequence[Body], notes: Notes) -> list[Body]:
    """Bodies without the outlines that are described by their parts; what no part covers stays as high as it was."""
    parts = [body for body in bodies if body.kind == PART]
    outlines = [body for body in bodies if body.kind != PART]
    if not parts:
        notes.add("taken", BUILDING, count=len(bodies))
        return list(bodies)
    kept: list[Body] = []
    heirs: dict[int, float] = {}
    for body, members in zip(outlines, without_parts([b.plan for b in outlines], [p.plan for p in parts]), strict=True):
        heirs |= {number: max(heirs.get(number, 0.0), body.top) for number in members}
        if not members:
            kept.append(body)
            continue
        notes.add("derived", "outline overridden by its parts", body.footprint.label)
        rest = rest_of(body.plan, [parts[number].plan for number in members])
        if not rest.is_empty:
            notes.add("derived", "what no part covers, as high as its outline", body.footprint.label)
            kept.append(body._replace(plan=rest))
    for number, part in enumerate(parts):
        if np.isnan(part.top):
            if number not in heirs:
                notes.add("left out", "part without height and outline", part.footprint.label)
                continue
            notes.add("derived", "part as high as its outline", part.footprint.label)
            part = part._replace(top=max(heirs[number], part.base + 1.0))
        kept.append(part)
    notes.add("taken", BUILDING, count=sum(body.kind != PART for body in kept))
    notes.add("taken", PART, count=sum(body.kind == PART for body in kept))
    return kept


def mostly_raised(bodies: Sequence[Body], notes: Notes) -> bool:
    """Whether bases are heights above the sea, as most of them are not at 0; says so."""
    if 2 * sum(body.base >= 1.0 for body in bodies) <= len(bodies):
        return False
    notes.add("assumed", "heights above the sea, as most bases are above 1 m (heights_above='ground' if not)", count=0)
    return True


def ground_below(
    bodies: Sequence[Body], above_sea: bool, terrain: Any, place: Place | None, notes: Notes
) -> tuple[Terrain | float, float]:
    """The ground on the map, and how high its zero is in the file's vertical system [m]."""
    if terrain is None and not above_sea:
        notes.add("derived", "level ground at z = 0", count=0)
        return 0.0, 0.0
    if isinstance(terrain, int | float):
        checks.finite("terrain", terrain)
        return 0.0, float(terrain)
    if terrain is None:
        feet = [
            np.column_stack([c, np.full(len(c), b.base)]) for b in bodies for c in [shapely.get_coordinates(b.plan)]
        ]
        surface = Terrain.from_points(np.concatenate(feet))
        notes.add("derived", "ground through the feet of the buildings, linear in between", count=0)
    else:
        surface = read_terrain(terrain) if isinstance(terrain, str | Path) else terrain
        checks.instance("terrain", surface, Terrain)
        surface = surface.placed(None if place is None else place._replace(height=0.0))
        notes.add("derived", "ground from the terrain given", count=0)
    zero = float(min(low for low, _ in ranges_under(bodies, surface)))
    return shifted(surface, zero), zero


def shifted(surface: Terrain, zero: float) -> Terrain:
    return Terrain(surface.points - [0.0, 0.0, zero], surface.triangles, beyond=surface.beyond)


def ranges_under(bodies: Sequence[Body], surface: Terrain) -> list[tuple[float, float]]:
    """Lowest and highest ground under each footprint, looked for at its corners and every few metres inside [m]."""
    places = [places_in(body.plan) for body in bodies]
    heights = surface.heights_at(np.concatenate(places))
    ends = np.cumsum([len(some) for some in places])
    ranges = []
    for body, under in zip(bodies, np.split(heights, ends[:-1]), strict=True):
        if np.isnan(under).any():
            raise ValueError(
                f"terrain says nothing about the ground under {body.footprint.label!r}: give a larger one, or "
                "terrain.filled(), which goes on beyond its edges and through holes"
            )
        ranges.append((float(under.min()), float(under.max())))
    return ranges


def places_in(plan: shapely.MultiPolygon) -> np.ndarray:
    west, south, east, north = plan.bounds
    x, y = np.meshgrid(np.arange(west, east, SAMPLES), np.arange(south, north, SAMPLES))
    inside = shapely.contains_xy(plan, x, y)
    return np.concatenate([shapely.get_coordinates(plan), np.column_stack([x[inside], y[inside]])])


def extents_of(bodies: Sequence[Body], above_sea: bool, ground: Terrain | float) -> list[tuple[float, float]]:
    """Underside and roof of each body on the map [m]."""
    if not isinstance(ground, Terrain):
        return [(body.base, body.top) for body in bodies]
    if above_sea:
        zero = min(body.base for body in bodies)
        return [(body.base - zero, body.top - zero) for body in bodies]
    ranges = ranges_under(bodies, ground)
    return [(low + body.base, high + body.top) for body, (low, high) in zip(bodies, ranges, strict=True)]


def building_of(body: Body, bottom: float, top: float) -> Building:
    """A prism over each polygon."""
    parts = [part for polygon in body.plan.geoms for part in convex_parts(polygon)]
    return Building(tuple(extrude(part, bottom, top) for part in parts), body.footprint.name)
