"""Footprints with heights from GeoJSON, as exports of OpenStreetMap and of city registers have them.

Where a height stands, how it is written, and in which system the coordinates are, differs from file to file. What can
be understood is; what has to be assumed is said in `City.source`, and in one warning; what can't be known is asked for.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import shapely

from uavlab import checks
from uavlab.city.blocks import (
    Block,
    check_extent,
    extents_of,
    ground_below,
    lowest_ground,
    moved,
    placed,
    shifted,
)
from uavlab.city.buildings import Building, convex_parts, extrude
from uavlab.city.documents import count, progress, read_json
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
from uavlab.city.place import System, metres_per, system_for
from uavlab.city.source import Notes
from uavlab.city.terrain import Terrain
from uavlab.city.zones import NoFlyZone

STOREY_HEIGHT = 3.0
"""Of a storey [m], where a file counts storeys."""

ABOVE = ("auto", "ground", "sea")

OSM_BASE = "min_height"
"""OpenStreetMap's key of an underside, which is always above ground."""


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
    blocks = blocks_of(footprints, wording, notes)
    blocks = with_heights(blocks, wording, notes, path)
    place, blocks = placed(blocks, system)
    check_extent(blocks, system)
    blocks = overridden_by_parts(blocks, notes)
    above_sea = heights_above == "sea" or (
        heights_above == "auto" and base != OSM_BASE and mostly_raised(blocks, notes)
    )
    ground = ground_below(blocks, above_sea, terrain, place, notes)
    zero = lowest_ground(blocks, ground)
    if place is None:
        ground = shifted(ground, zero)
    elif zero:  # metres at that height are a little longer
        place, blocks = moved(blocks, place, place._replace(height=zero))
        ground = ground_below(blocks, above_sea, terrain, place, Notes())
    buildings = [
        building_of(block, *extent)
        for block, extent in zip(
            progress(blocks, "buildings"), extents_of(blocks, above_sea, ground, zero), strict=True
        )
    ]
    source = notes.source(path.name, "GeoJSON")
    city = City.from_buildings(
        buildings,
        cell=cell,
        margin=margin,
        name=path.name.split(".")[0],
        reference=place,
        source=source,
        terrain=ground,
        voxels=voxels,
        no_fly=no_fly,
    )
    source.warn()
    return city


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


def blocks_of(footprints: Sequence[Footprint], wording: Wording, notes: Notes) -> list[Block]:
    """Buildings and their parts in the coordinates of the file, with the heights that are known."""
    heights = [heights_of(footprint, wording, notes) for footprint in footprints]
    kinds = kinds_of(footprints, [not np.isnan(top) for _, top in heights])
    others = kinds.count(OTHER)
    if others:
        notes.add("derived", f"{OTHER}: polygons that are no building and have no height", count=others)
    return [
        Block(footprint, kind, footprint.polygons, base, top)
        for footprint, kind, (base, top) in zip(footprints, kinds, heights, strict=True)
        if kind != OTHER
    ]


def with_heights(blocks: Sequence[Block], wording: Wording, notes: Notes, path: Path) -> list[Block]:
    """All blocks with a height; parts without one wait for their outline. `ValueError` where none is known."""
    unknown = [block for block in blocks if np.isnan(block.top) and block.kind == BUILDING]
    if unknown and wording.default_height is None:
        known = sorted({key for block in blocks for key in block.footprint.properties})
        raise ValueError(
            f"{len(unknown)} of {len(blocks)} buildings in {path.name} have no height that can be understood, with "
            f"height={wording.height!r}, nor storeys; the first is {unknown[0].footprint.label!r} with "
            f"{unknown[0].footprint.properties.get(str(wording.height))!r}. Properties in the file: "
            f"{', '.join(known) or 'none'}. Pass default_height=10.0, or height='one of them', or a number for all"
        )
    for block in unknown:
        notes.add("assumed", f"height of {wording.default_height:g} m (default_height)", block.footprint.label)
    return [
        block._replace(top=max(float(wording.default_height), block.base + 1.0))
        if np.isnan(block.top) and block.kind == BUILDING and wording.default_height is not None
        else block
        for block in blocks
    ]


def overridden_by_parts(blocks: Sequence[Block], notes: Notes) -> list[Block]:
    """Bodies without the outlines that are described by their parts; what no part covers stays as high as it was."""
    parts = [block for block in blocks if block.kind == PART]
    outlines = [block for block in blocks if block.kind != PART]
    if not parts:
        notes.add("taken", BUILDING, count=len(blocks))
        return list(blocks)
    kept: list[Block] = []
    heirs: dict[int, float] = {}
    for block, members in zip(
        outlines, without_parts([b.plan for b in outlines], [p.plan for p in parts]), strict=True
    ):
        heirs |= {number: max(heirs.get(number, 0.0), block.top) for number in members}
        if not members:
            kept.append(block)
            continue
        notes.add("derived", "outline overridden by its parts", block.footprint.label)
        rest = rest_of(block.plan, [parts[number].plan for number in members])
        if not rest.is_empty:
            notes.add("derived", "what no part covers, as high as its outline", block.footprint.label)
            kept.append(block._replace(plan=rest))
    for number, part in enumerate(parts):
        if np.isnan(part.top):
            if number not in heirs:
                notes.add("left out", "part without height and outline", part.footprint.label)
                continue
            notes.add("derived", "part as high as its outline", part.footprint.label)
            part = part._replace(top=max(heirs[number], part.base + 1.0))
        kept.append(part)
    notes.add("taken", BUILDING, count=sum(block.kind != PART for block in kept))
    notes.add("taken", PART, count=sum(block.kind == PART for block in kept))
    return kept


def mostly_raised(blocks: Sequence[Block], notes: Notes) -> bool:
    """Whether bases are heights above the sea, as most of them are not at 0; says so."""
    if 2 * sum(block.base >= 1.0 for block in blocks) <= len(blocks):
        return False
    notes.add("assumed", "heights above the sea, as most bases are above 1 m (heights_above='ground' if not)", count=0)
    return True


def building_of(block: Block, bottom: float, top: float) -> Building:
    """A prism over each polygon."""
    parts = [part for polygon in block.plan.geoms for part in convex_parts(polygon)]
    return Building(tuple(extrude(part, bottom, top) for part in parts), block.footprint.name)
