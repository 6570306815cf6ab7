"""Footprints with heights from GeoJSON, as exports of OpenStreetMap and of city registers have them.

Where a height stands, how it is written, and in which system the coordinates are, differs from file to file. What can
be understood is; what has to be assumed is said in `City.source`, and in one warning; what can't be known is asked for.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import shapely

from uavlab import checks
from uavlab.city.blocks import (
    Block,
    check_size,
    extents_of,
    ground_below,
    lowest_ground,
    moved,
    placed,
    ranges_of_blocks,
    shifted,
    with_volume,
)
from uavlab.city.buildings import Building, convex_parts, extrude
from uavlab.city.documents import count, progress, read_json
from uavlab.city.extent import checked_grid
from uavlab.city.footprints import (
    BUILDING,
    OTHER,
    Footprint,
    declared_system,
    features_of,
    footprints_of,
    is_tall,
    kinds_of,
)
from uavlab.city.heights import Wording, above_ground, above_sea, heights_of
from uavlab.city.model import City
from uavlab.city.parts import overridden_by_parts
from uavlab.city.place import ABOVE_SEA, NOWHERE, UNKNOWN, System, metres_per, system_for
from uavlab.city.rasters import terrain_or_file
from uavlab.city.source import FIRST, Notes
from uavlab.city.terrain import Terrain
from uavlab.city.zones import NoFlyZone, checked_zones

STOREY_HEIGHT = 3.0
"""Of a storey [m], where a file counts storeys."""

ABOVE = ("auto", "ground", "sea")

MOST_NAMES = 40
"""Of properties in a message."""

UNFINISHED = ("construction", "ruins", "collapsed", "proposed", "demolished")
"""Values of OpenStreetMap's `building` of what doesn't stand, or not yet, or not any more, at its full height."""

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
    lazy: bool = False,
) -> City:
    """Read footprints with heights from a GeoJSON file (RFC 7946), for example an export of OpenStreetMap.

    Every polygon of a building becomes a prism. In a file with OpenStreetMap's keys, other polygons are no buildings
    unless they have a height or are tagged as something tall (a tower, a tank, a bridge), and parts (`building:part`)
    override the outline that they lie in. Broken outlines are mended. Points and lines with a height or such a tag
    (masts, trees, power lines) are left out, with a warning. x = y = 0 is the south-west corner of the buildings,
    z = 0 the lowest ground at one.

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
    cell, margin, voxels, no_fly, lazy
        As for `City.from_buildings`.

    Returns
    -------
    City
        `source` says what was taken, mended, derived, assumed and left out.

    Raises
    ------
    ValueError
        If the file at `path` is broken or has no building with an area; a height is not known, and `default_height` is
        not given; `height`, `default_height` or `storey_height` is a number that is not above 0; `base` is a number
        that is not finite, or is negative where it counts from the ground; `heights_above` or `height_unit` is none of
        its words; `crs` is not known, or can't be that of the coordinates; `terrain` doesn't cover the map; or `cell`,
        `margin`, `voxels`, `no_fly` or `lazy` is what `City.from_buildings` refuses, as for over 500 million voxels.
    FileNotFoundError
        If there is no file at `path`.

    Warns
    -----
    UserWarning
        If anything was assumed or left out.

    See Also
    --------
    read_city : finds out the format.
    read_no_fly : no-fly zones from such a file.
    uavlab.risk.osm_layers : roads and shelter from such a file.

    References
    ----------
    H. Butler and others, "The GeoJSON format", RFC 7946, 2016.

    Examples
    --------
    >>> import json, pathlib, tempfile
    >>> from uavlab.city import read_geojson
    >>> outline = [[13.377, 52.516], [13.378, 52.516], [13.378, 52.5164], [13.377, 52.5164], [13.377, 52.516]]
    >>> house = {"type": "Feature", "properties": {"height": "26 m"},
    ...          "geometry": {"type": "Polygon", "coordinates": [outline]}}
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder, "town.geojson")
    ...     _ = path.write_text(json.dumps(house))
    ...     city = read_geojson(path, cell=2.0)
    >>> city, city.reference
    (<City town: 54 × 43 × 24 voxels of 2 m, 1 buildings>, Place(longitude=13.377, latitude=52.516, height=0.0))
    """
    path, notes = checks.path("path", path), Notes()
    wording = checked_wording(height, base, storey_height, checks.one_of("heights_above", heights_above, ABOVE))
    if default_height is not None:
        default_height = checks.positive_number("default_height", default_height)
    cell, margin = checked_grid(cell, margin, voxels)
    terrain, no_fly = terrain_or_file(terrain), checked_zones(no_fly)
    footprints, declared = read_footprints(path, wording, notes)
    bounds = shapely.total_bounds([footprint.polygons for footprint in footprints])
    system = system_for(bounds, declared, crs, path.name)
    factor = metres_per(height_unit) if height_unit is not None else 1.0 if system is None else system.height_factor
    note_system(notes, system, crs, declared, height_unit)
    wording = wording._replace(unit=factor, height=spelled(height, footprints, notes))
    blocks = blocks_of(footprints, wording, path, notes)
    others = len(footprints) - len(blocks)
    place, blocks = placed(blocks, system)
    check_size(blocks, system)
    blocks = with_volume(blocks, notes)
    from_sea = heights_above == "sea" or (heights_above == "auto" and mostly_raised(blocks, wording, notes))
    ground = ground_below(blocks, from_sea, terrain, place)
    blocks = from_the_sea(blocks, wording, ground, notes) if from_sea else from_the_ground(blocks, wording, notes)
    if others:
        notes.add("derived", f"{OTHER}: polygons that are no building and have no height", count=others)
    blocks = with_default(blocks, wording, default_height, from_sea, path, notes)
    blocks = overridden_by_parts(blocks, notes)
    if not blocks:
        raise ValueError(f"{path.name} has no building with a height and an area: {notes.source('all', 'GeoJSON')}")
    note_ground(notes, from_sea, terrain)
    feet_are_ground = from_sea and terrain is None
    zero = min(block.base for block in blocks) if feet_are_ground else lowest_ground(blocks, ground)
    if place is None:
        ground = shifted(ground, zero)
    elif zero:  # metres at that height are a little longer
        place, blocks = moved(blocks, place, place._replace(height=zero))
        ground = ground_below(blocks, from_sea, terrain, place)
    extents = extents_of(blocks, from_sea, ground, zero, notes)
    buildings = buildings_of(blocks, extents, notes)
    source = notes.source(path.name, "GeoJSON", ABOVE_SEA if from_sea else UNKNOWN)
    city = City.from_buildings(
        buildings, cell=cell, margin=margin, name=path.name.split(".")[0], reference=place, source=source,
        terrain=ground, voxels=voxels, no_fly=no_fly, lazy=lazy,
    )  # fmt: skip
    source.warn()
    return city


def checked_wording(height: str | float, base: str | float, storey_height: float, heights_above: str) -> Wording:
    """Where heights stand, or what they are."""
    if not isinstance(height, str):
        height = checks.positive_number("height", height)
    if not isinstance(base, str):
        base = checks.number("base", base)
        (checks.finite if heights_above == "sea" else checks.not_negative)("base", base)
    return Wording(height, base, checks.positive_number("storey_height", storey_height))


def read_footprints(path: Path, wording: Wording, notes: Notes) -> tuple[list[Footprint], Any]:
    """All footprints of a file, and the reference system that it names; the rest of the file is forgotten.

    Points and lines of obstacles, by their tags or as they have a height, are noted as left out.
    """

    def is_obstacle(properties: Mapping[str, Any]) -> bool:
        return is_tall(properties) or heights_of(properties, wording).own

    documents = read_json(path)
    features = [feature for document in documents for feature in features_of(document, path)]
    footprints = footprints_of(features, notes, is_obstacle)
    if not footprints:
        kinds = count(kind_of_geometry(feature) for feature in features)
        raise ValueError(f"{path.name} has no polygon with an area; its features are {kinds}")
    return footprints, declared_system(documents, path.name)


def spelled(height: str | float, footprints: Sequence[Footprint], notes: Notes) -> str | float:
    """The property that holds heights as the file spells it: where none has its name, the one that has in capitals."""
    if not isinstance(height, str) or any(height in footprint.properties for footprint in footprints):
        return height
    alike = sorted({key for f in footprints for key in f.properties if key.lower() == height.lower()})
    if len(alike) != 1:
        return height
    notes.add("derived", f"heights from {alike[0]!r}", count=0)
    return alike[0]


def kind_of_geometry(feature: Mapping[str, Any]) -> str:
    geometry = feature.get("geometry")
    return str(geometry.get("type") if isinstance(geometry, dict) else geometry)[:40]


def note_system(notes: Notes, system: System | None, given: Any, declared: Any, height_unit: str | None) -> None:
    """Say in which system coordinates and heights are."""
    if system is None:
        kind = "derived" if given is not None else "assumed"
        notes.add(kind, NOWHERE, count=0)
    else:
        named = " (no crs: longitude and latitude, as in RFC 7946)" if given is None and declared is None else ""
        notes.add("derived", f"place: {system.accuracy}{named}", count=0)
    unit = height_unit or ("metre" if system is None else system.height_unit)
    if unit not in ("metre", "m"):
        notes.add("derived", f"heights without a unit are in {unit}", count=0)


def note_ground(notes: Notes, from_sea: bool, terrain: Any) -> None:
    """Say what the ground was made of."""
    if isinstance(terrain, float):
        notes.add("derived", f"level ground at {terrain:g} m, as given", count=0)
    elif terrain is not None:
        notes.add("derived", "ground from the terrain given", count=0)
    elif from_sea:
        notes.add("derived", "ground through the feet of the buildings, linear in between", count=0)
    else:
        notes.add("derived", "level ground at z = 0", count=0)


def blocks_of(footprints: Sequence[Footprint], wording: Wording, path: Path, notes: Notes) -> list[Block]:
    """Buildings and their parts in the coordinates of the file, with what it says about their heights."""
    heights = [heights_of(footprint.properties, wording) for footprint in footprints]
    kinds = kinds_of(footprints, [stated.own for stated in heights])
    blocks = [
        Block(footprint, kind, footprint.polygons, stated)
        for footprint, kind, stated in zip(footprints, kinds, heights, strict=True)
        if kind != OTHER
    ]
    for block in blocks:
        state = str(block.footprint.properties.get("building"))
        if state in UNFINISHED:
            notes.add("assumed", f"finished building, though building={state}", block.label)
    if not blocks:
        raise ValueError(
            f"{path.name} has no building: none of its {len(kinds)} polygons has a height, or is tagged as one"
        )
    return blocks


def mostly_raised(blocks: Sequence[Block], wording: Wording, notes: Notes) -> bool:
    """Whether bases are heights above the sea, as most of them are not at 0; says so."""
    if not isinstance(wording.base, str) or wording.base == OSM_BASE:
        return False
    if 2 * sum(abs(block.heights.base) >= 1.0 for block in blocks) <= len(blocks):
        return False
    notes.add("assumed", "heights above the sea, as most bases are above 1 m (heights_above='ground' if not)", count=0)
    return True


def from_the_ground(blocks: Sequence[Block], wording: Wording, notes: Notes) -> list[Block]:
    """The blocks with base and top above the ground."""
    found = []
    for block in blocks:
        base, top, done = above_ground(block.heights, wording)
        found.append(block._replace(base=base, top=top))
        for kind, what in done:
            notes.add(kind, what, block.label)
    return found


def from_the_sea(blocks: Sequence[Block], wording: Wording, ground: Terrain | float, notes: Notes) -> list[Block]:
    """The blocks with base and top above the sea; where no base is stated, it is the lowest ground nearby."""
    baseless = [n for n, block in enumerate(blocks) if np.isnan(block.heights.base)]
    lowest = np.full(len(blocks), ground if not isinstance(ground, Terrain) else np.nan)
    if isinstance(ground, Terrain):
        lowest[baseless] = [low for low, _ in ranges_of_blocks([blocks[n] for n in baseless], ground)]
    stated = [block.heights for block in blocks if not np.isnan(block.heights.top)]
    from_base = 2 * sum(heights.top <= heights.base for heights in stated) > len(stated)
    if from_base:
        notes.add("assumed", "roofs are counted from the bases, as most are not above them", count=0)
    elif stated:
        notes.add("derived", "roofs are above the sea, too, as most are above the bases", count=0)
    found = []
    for block, low in zip(blocks, lowest, strict=True):
        base, top, done = above_sea(block.heights, wording, float(low), from_base)
        found.append(block._replace(base=base, top=top))
        for kind, what in done:
            notes.add(kind, what, block.label)
    return found


def with_default(
    blocks: Sequence[Block],
    wording: Wording,
    default_height: float | None,
    from_sea: bool,
    path: Path,
    notes: Notes,
) -> list[Block]:
    """All buildings with a height; parts without one wait for their outline. `ValueError` where none is known."""
    unknown = [block for block in blocks if np.isnan(block.top) and block.kind == BUILDING]
    if unknown and default_height is None:
        values = [block.footprint.properties.get(str(wording.height)) for block in unknown[:FIRST]]
        first = ", ".join(f"{block.label!r} with {value!r}" for block, value in zip(unknown, values, strict=False))
        known = sorted({key for block in blocks for key in block.footprint.properties})
        more = f" and {len(known) - MOST_NAMES} more" if len(known) > MOST_NAMES else ""
        raise ValueError(
            f"{len(unknown)} of {len(blocks)} buildings in {path.name} have no height that can be understood, with "
            f"height={wording.height!r}, nor storeys; first {first:.300}. Properties in the file: "
            f"{', '.join(known[:MOST_NAMES]) or 'none'}{more}. "
            "Pass default_height=10.0, or height='one of them', or a number for all"
        )
    for block in unknown:
        notes.add("assumed", f"height of {default_height:g} m (default_height)", block.label)
    return [
        block._replace(top=block.base + default_height if from_sea else max(float(default_height), block.base + 1.0))
        if np.isnan(block.top) and block.kind == BUILDING and default_height is not None
        else block
        for block in blocks
    ]


def buildings_of(blocks: Sequence[Block], extents: Sequence[tuple[float, float]], notes: Notes) -> list[Building]:
    """A prism over each polygon."""
    buildings = []
    for block, (bottom, top) in zip(progress(blocks, "buildings"), extents, strict=True):
        parts = [part for polygon in block.plan.geoms for part in convex_parts(polygon)]
        if parts:
            pieces = tuple(extrude(part, bottom, top) for part in parts)
            buildings.append(Building(pieces, block.footprint.name))
        else:
            notes.add("left out", "polygon without area", block.label)
    return buildings
