"""City models from CityJSON: every solid that may be an obstacle, and the ground below.

Buildings are filled from their roofs down to their own lowest point, which closes passages: the safe side. Everything
else that has a height (masts, bridges, trees) keeps its lower surface. The ground comes from a relief in the file, else
from the feet of the buildings. What was left out, and why, stands in `City.source`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import shapely

from uavlab import checks
from uavlab.city.blocks import STEEP, note_far_ground, ranges_under
from uavlab.city.buildings import Building
from uavlab.city.cityobjects import HOUSES, RELIEF, Thing, things_in, with_all_keys
from uavlab.city.documents import progress, read_json
from uavlab.city.extent import checked_grid
from uavlab.city.model import City
from uavlab.city.place import (
    FARTHEST_LOCAL,
    NOWHERE,
    UNKNOWN,
    Place,
    System,
    check_extent,
    common_system,
    metres_per,
    place_at_corner,
    system_for,
)
from uavlab.city.rasters import read_terrain, terrain_or_file
from uavlab.city.relief import feet_of, ground_below
from uavlab.city.solids import THINNEST, Body, Surface, enclosed, filled, has_walls
from uavlab.city.source import Notes
from uavlab.city.terrain import Terrain
from uavlab.city.zones import NoFlyZone, checked_zones

COVER = {"GenericCityObject", "PlantCover"}
"""Types that, like those of extensions, may lie flat on the ground, as grass does."""

FLAT = 1.0
"""A cover of the ground without a volume that is lower than this [m] is none that one could hit."""

Solid = tuple[Thing, list[np.ndarray]]
"""A thing and its convex pieces [m]."""

LEAST = 0.1
"""Extent of a city [m]: a model may have a lamp alone."""


def read_cityjson(
    path: str | Path,
    *,
    cell: float = 1.0,
    margin: float = 20.0,
    crs: str | int | None = None,
    height_unit: str | None = None,
    terrain: Terrain | str | Path | float | None = None,
    voxels: str = "touched",
    no_fly: Sequence[NoFlyZone] = (),
    lazy: bool = False,
) -> City:
    """Read a city model from a CityJSON file (1.0 to 2.0), or a sequence of features.

    A building with its parts is one `Building`, filled from each surface that is not a wall down to its own lowest
    point, and to the ground where that is lower: passages below it are closed. Every other object with a solid or
    surfaces (installations on roofs, bridges, furniture, trees, …) is one of its own, "BuildingInstallation mast-1",
    and keeps its lower surface; a surface that encloses nothing becomes a slab of 0.1 m. Each takes its highest level
    of detail above 0; where that shows less than half of a lower one in plan, both.

    x points east, y to true north; x = y = 0 is the south-west corner of the bounding box of all these objects, z = 0
    the lowest foot of a building. `City.reference` is where that is on Earth, its height as in the file [m].

    Parameters
    ----------
    path : str or Path
        UTF-8 text.
    cell : float
        Edge of a voxel [m], typically 0.5 to 5.
    margin : float
        Free space around and above the buildings [m].
    crs : str or int, optional
        Reference system of the coordinates, such as "EPSG:7415"; by default the file's own. "local" for metres east
        and north of an unknown place, which small coordinates of a file without a system are taken for.
    height_unit : str, optional
        Of heights in the file, such as "ft"; by default that of the reference system.
    terrain : Terrain, path of a raster, or float, optional
        The ground; a number is level ground at this height [m] of the file. By default the `TINRelief` of the file,
        else a surface through the feet of the buildings.
    voxels, no_fly, lazy
        As for `City.from_buildings`.

    Returns
    -------
    City
        `source` says what was taken, mended, derived, assumed and left out.

    Raises
    ------
    ValueError
        If the file at `path` is broken or has nothing that could be an obstacle; `crs` is unknown, or can't be that of
        the coordinates; `height_unit` is no unit of length; `terrain` doesn't cover the map; or `cell`, `margin`,
        `voxels`, `no_fly` or `lazy` is what `City.from_buildings` refuses, as for over 500 million voxels.
    FileNotFoundError
        If there is no file at `path`.

    Warns
    -----
    UserWarning
        If something was assumed or left out; `City.source` tells the rest.

    See Also
    --------
    read_city : finds out the format.
    read_geojson : footprints with heights.

    References
    ----------
    H. Ledoux and others, "CityJSON: a compact and easy-to-use encoding of the CityGML data model", Open Geospatial
    Data, Software and Standards, 2019.

    Examples
    --------
    >>> import json, pathlib, tempfile
    >>> from uavlab.city import read_cityjson
    >>> corners = [[x, y, z] for z in (0, 6) for x, y in ((0, 0), (10, 0), (10, 20), (0, 20))]
    >>> faces = [[[0, 3, 2, 1]], [[4, 5, 6, 7]], [[0, 1, 5, 4]], [[1, 2, 6, 5]], [[2, 3, 7, 6]], [[3, 0, 4, 7]]]
    >>> hall = {"type": "Building", "geometry": [{"type": "Solid", "lod": "1", "boundaries": [faces]}]}
    >>> model = {"type": "CityJSON", "version": "2.0", "CityObjects": {"hall": hall}, "vertices": corners}
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder, "model.city.json")
    ...     _ = path.write_text(json.dumps(model))
    ...     read_cityjson(path, crs="local").buildings
    (<Building hall: 1 convex piece, 10 × 20 m, z from 0 to 6 m>,)
    """
    path, notes = checks.path("path", path), Notes()
    cell, margin = checked_grid(cell, margin, voxels)
    terrain, no_fly = terrain_or_file(terrain), checked_zones(no_fly)
    documents = read_json(path, objects=with_all_keys)
    if documents[0].get("type") != "CityJSON":
        raise ValueError(f"{path.name} is not CityJSON: type must be 'CityJSON', got {documents[0].get('type')!r}")
    found = things_in(documents, path.name, notes)
    things = [thing for thing in found if thing.kind != RELIEF]
    if not things:
        raise ValueError(f"{path.name} has no building, bridge or other solid: {told(notes)}")
    system = system_of_file(documents, things, crs, path.name, notes)
    factor = metres_per_height(system, height_unit, notes)
    rough = factor * float(corners_of(things)[:, 2].min())
    placed = placed_in(found, system, factor, rough)[1]
    low = rough + lowest_foot(placed)
    place, placed = placed_in(found, system, factor, low)
    relief = [surface for thing in placed if thing.kind == RELIEF for body in thing.bodies for surface in body.surfaces]
    solids, feet = solids_of([thing for thing in placed if thing.kind != RELIEF], notes)
    if not solids:
        raise ValueError(f"nothing in {path.name} has a height: {told(notes)}")
    ground = ground_of(terrain, relief, feet, place, low, notes)
    if terrain is not None or relief:  # else it goes through the feet
        solids = grounded(solids, ground, notes)
    buildings = [solid_of(pieces, thing, notes) for thing, pieces in solids]
    source = notes.source(path.name, "CityJSON", UNKNOWN if system is None else system.heights)
    city = City.from_buildings(
        buildings, cell=cell, margin=margin, name=path.name.split(".")[0], reference=place, source=source,
        terrain=ground, voxels=voxels, no_fly=no_fly, lazy=lazy,
    )  # fmt: skip
    source.warn()
    return city


def told(notes: Notes) -> str:
    """All notes in a line, for a message."""
    return "; ".join(map(str, notes.source("", "").entries)) or "it has no objects"


def system_of_file(
    documents: Sequence[Mapping[str, Any]], things: Sequence[Thing], crs: str | int | None, file: str, notes: Notes
) -> System | None:
    """The reference system of the coordinates; None for metres of an unknown place.

    Models without a system are metres of a place of their own; degrees are such that all lies within a degree.
    """
    for document in documents:
        metadata = document.get("metadata") or {}
        if not isinstance(metadata, dict):
            raise ValueError(f"{file}: 'metadata' is malformed: it must be an object {{...}}, got {metadata!r:.60}")
    declared = common_system([(each.get("metadata") or {}).get("referenceSystem") for each in documents], file)
    corners = corners_of(things)[:, :2]
    bounds = (*corners.min(axis=0).tolist(), *corners.max(axis=0).tolist())
    nameless = crs is None and declared is None
    if nameless and np.abs(corners).max() <= FARTHEST_LOCAL and np.ptp(corners, axis=0).max() >= 1.0:
        system = None
    else:
        system = system_for(bounds, declared, crs, file)
    if system is not None:
        notes.add("assumed" if nameless else "derived", f"place from {system.accuracy}", count=0)
    elif nameless:
        notes.add("assumed", NOWHERE, count=0)
    return system


def metres_per_height(system: System | None, height_unit: str | None, notes: Notes) -> float:
    """Metres per unit of the heights, as the caller says or as the reference system has it."""
    if height_unit is not None:
        factor, unit = metres_per(height_unit), height_unit
    elif system is not None:
        factor, unit = system.height_factor, system.height_unit
    else:
        factor, unit = 1.0, "metre"
    notes.add("derived", f"heights in {unit}", count=0)
    return factor


def lowest_foot(placed: Sequence[Thing]) -> float:
    """Height [m] of the lowest building with walls; of whatever there is if there is none."""
    solid = [thing for thing in placed if thing.kind != RELIEF]
    houses = [thing for thing in solid if thing.kind in HOUSES and has_walls(thing.bodies)]
    return float(corners_of(houses or solid)[:, 2].min())


def placed_in(
    found: Sequence[Thing], system: System | None, factor: float, low: float
) -> tuple[Place | None, list[Thing]]:
    """Where on Earth x = y = z = 0 is, and all that was found in metres east, north and up of there.

    That is the south-west corner of the bounding box of all but the relief, and the height `low` [m].
    """
    corners = corners_of(found)
    taken = np.concatenate([np.full(sum(map(len, rings_of(thing))), thing.kind != RELIEF) for thing in found])
    place = None
    if system is None:
        plan = corners[:, :2] - corners[taken, :2].min(axis=0)
    else:
        lonlat = system.to_lonlat(corners[:, :2])
        place = place_at_corner(lonlat[taken], low)
        plan = place.east_north(lonlat)
    check_extent(plan[taken], "pass crs='EPSG:...', the system of the coordinates, or crs='local' for metres", LEAST)
    local = np.column_stack([plan, factor * corners[:, 2] - low])
    rings = iter(np.split(local, np.cumsum([len(ring) for thing in found for ring in rings_of(thing)])))
    return place, [
        thing._replace(
            bodies=[Body([[next(rings) for _ in each] for each in body.surfaces], body.tight) for body in thing.bodies]
        )
        for thing in found
    ]


def rings_of(thing: Thing) -> Iterator[np.ndarray]:
    return (ring for body in thing.bodies for surface in body.surfaces for ring in surface)


def corners_of(things: Iterable[Thing]) -> np.ndarray:
    """All corners of things, (N, 3)."""
    return np.concatenate([ring for thing in things for ring in rings_of(thing)])


def solids_of(things: Sequence[Thing], notes: Notes) -> tuple[list[Solid], np.ndarray]:
    """Things [m] with their convex pieces, and the corners (N, 3) that buildings stand on."""
    solids, feet = [], [np.empty((0, 3))]
    for thing in progress(things, "objects"):
        pieces = house(thing, feet, notes) if thing.kind in HOUSES else obstacle(thing, notes)
        if pieces:
            solids.append((thing, pieces))
            for kind, key in thing.sources:
                notes.add("taken", kind, key)
    return solids, np.concatenate(feet)


def grounded(solids: Sequence[Solid], ground: Terrain | float, notes: Notes) -> list[Solid]:
    """The same solids, of which buildings reach down to the lowest ground under them: no gap is left open.

    Where that is far below, or the roof is, the ground is likely of other heights than the file.
    """
    houses = [n for n, (thing, _) in enumerate(solids) if thing.kind in HOUSES]
    corners = [np.concatenate(solids[n][1]) for n in houses]
    names = [solids[n][0].name for n in houses]
    if isinstance(ground, Terrain):
        plans = np.array([shapely.convex_hull(shapely.MultiPoint(each[:, :2])) for each in corners], dtype=object)
        lowest = [low for low, _ in ranges_under(plans, names, ground)]
    else:
        lowest = [ground] * len(houses)
    found = list(solids)
    for n, low, each, name in zip(houses, lowest, corners, names, strict=True):
        bottom, top = each[:, 2].min(), each[:, 2].max()
        note_far_ground(bottom, top, low, name, notes)
        if low < bottom - THINNEST:
            thing, pieces = solids[n]
            found[n] = thing, [down_to(low, piece, bottom) for piece in pieces]
            if bottom - low <= STEEP:
                notes.add("derived", "Building filled down from its foot to the lowest ground below", name)
    return found


def down_to(low: float, piece: np.ndarray, bottom: float) -> np.ndarray:
    """A convex piece whose foot, where it stands at `bottom`, is lengthened to a height [m]."""
    foot = piece[piece[:, 2] < bottom + THINNEST]
    return np.vstack([piece, np.column_stack([foot[:, :2], np.full(len(foot), low)])])


def solid_of(pieces: Sequence[np.ndarray], thing: Thing, notes: Notes) -> Building:
    """Pieces as one solid; what rounding left without a volume is grown to a millimetre, so that nothing is lost."""
    try:
        return Building(tuple(pieces), thing.name)
    except ValueError:
        notes.add("mended", f"{thing.kind} with a piece thinner than rounding", thing.name)
        grown = [piece if has_volume(piece) else boxed(piece) for piece in pieces]
        return Building(tuple(grown), thing.name)


def has_volume(piece: np.ndarray) -> bool:
    try:
        Building((piece,))
    except ValueError:
        return False
    return True


def boxed(piece: np.ndarray) -> np.ndarray:
    """The bounding box (8, 3) of corners, a millimetre larger."""
    low, high = piece.min(axis=0) - THINNEST, piece.max(axis=0) + THINNEST
    return np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])


def house(thing: Thing, feet: list[np.ndarray], notes: Notes) -> list[np.ndarray]:
    """Pieces of a building [m], filled to its own lowest point; the corners of its feet are added to `feet`.

    Roofs alone tell nothing of a foot; they are filled down to the lowest of the others, z = 0.
    """
    if has_walls(thing.bodies):
        foot = feet_of(thing.bodies)
        bottom = float(corners_of([thing])[:, 2].min())
    else:
        foot, bottom = np.empty((0, 3)), 0.0
    pieces, passage = filled(thing.bodies, bottom)
    if not pieces:
        notes.add("left out", "Building without a height", thing.name)
        return []
    if not len(foot):
        notes.add("derived", "Building of roofs alone, filled to the lowest foot", thing.name)
    if passage:
        notes.add("derived", "Building filled below a passage, a step or an inner floor", thing.name)
    feet.append(foot)
    return pieces


def obstacle(thing: Thing, notes: Notes) -> list[np.ndarray]:
    """Pieces of anything else [m], which keeps its lower surface."""
    found = [enclosed(body) for body in thing.bodies]
    pieces = [piece for each, _ in found for piece in each]
    cover = thing.kind in COVER or thing.kind.startswith("+")
    if cover and not any(solid for _, solid in found) and np.ptp(corners_of([thing])[:, 2]) < FLAT:
        notes.add("left out", f"{thing.kind}: flat", thing.sources[0][1])
        return []
    if not pieces:
        notes.add("left out", f"{thing.kind}: no area", thing.sources[0][1])
    return pieces


def ground_of(
    terrain: Terrain | Path | float | None,
    relief: Sequence[Surface],
    feet: np.ndarray,
    place: Place | None,
    low: float,
    notes: Notes,
) -> Terrain | float:
    """The ground in the city's metres, from where it is known best."""
    if terrain is None:
        if relief:
            notes.add("derived", f"ground from {RELIEF}, beyond it from the feet of buildings or the nearest", count=0)
        elif len(feet):
            notes.add("derived", "ground from the feet of the buildings", count=0)
        else:
            notes.add("assumed", "ground level at the lowest point, no building tells where it is", count=0)
        return ground_below(relief, feet)
    notes.add("derived", "ground from terrain=" + (f", which wins over the file's {RELIEF}" if relief else ""), count=0)
    if isinstance(terrain, float):
        return terrain - low
    return (terrain if isinstance(terrain, Terrain) else read_terrain(terrain)).placed(place)
