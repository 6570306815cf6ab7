"""City models with roofs from CityJSON.

Every surface that is not a wall is extruded down to the ground, which turns a model of surfaces into solids of convex
pieces. What lies beneath a roof is filled, which is the safe side.
"""

import warnings
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import shapely

from uavlab.city.buildings import Building, convex_parts, extrude
from uavlab.city.documents import count, lowest_corner, read_json
from uavlab.city.model import City

THINNEST = 1e-3
"""What is thinner or lower [m] is nothing, or a wall seen from above; files of city models keep three decimals."""

NESTING = {"MultiSurface": 0, "CompositeSurface": 0, "Solid": 1, "MultiSolid": 2, "CompositeSolid": 2}
"""Geometries of CityJSON that have surfaces, and how many levels of lists stand around them."""


def read_cityjson(path: str | Path, *, cell: float = 1.0, margin: float = 20.0) -> City:
    """Read buildings from a CityJSON file (1.0 to 2.0), or a sequence of features, with the shapes of their roofs.

    Every surface that is not a wall is extruded down to z = 0, the lowest point of all buildings. So passages
    under buildings and the space below a house on a hill are filled, which is the safe side. A building and its parts
    are one `Building`; each takes its highest level of detail. x = y = 0 is the lower corner of the
    buildings' bounding box; `City.reference` is None.

    Parameters
    ----------
    path : str or Path
        UTF-8 text with metric coordinates.
    cell : float
        Edge of a voxel [m], typically 0.5 to 5.
    margin : float
        Free space around and above the buildings [m].

    Raises
    ------
    ValueError
        If the file is broken, has no building with a height, is not in metres, or the map would have over
        500 million voxels.

    Warns
    -----
    UserWarning
        If some buildings have no surface above the ground in a level of detail above 0 (a footprint).
    """
    path = Path(path)
    documents = read_json(path)
    if documents[0].get("type") != "CityJSON":
        raise ValueError(f"{path.name} is not CityJSON: type must be 'CityJSON', got {documents[0].get('type')!r}")
    surfaces: dict[str, list[list[np.ndarray]]] = defaultdict(list)
    for document in documents:
        for key, found in building_surfaces(document, documents[0].get("transform"), path):
            surfaces[key] += found
    if not surfaces:
        kinds = count(item.get("type") for document in documents for item in document.get("CityObjects", {}).values())
        raise ValueError(f"{path.name} has no Building or BuildingPart; its objects are {kinds}")
    rings = [ring for found in surfaces.values() for rings in found for ring in rings]
    low = lowest_corner(np.vstack(rings), "convert the file to a reference system in metres") if rings else np.zeros(3)
    pieces = {key: pieces_below([[ring - low for ring in rings] for rings in found]) for key, found in surfaces.items()}
    buildings = [Building(tuple(found), key) for key, found in pieces.items() if found]
    if len(buildings) < len(pieces):
        without = [key for key, found in pieces.items() if not found]
        message = (
            f"{len(without)} of {len(pieces)} buildings in {path.name} have no surface above the ground "
            f"in a level of detail above 0, the first is {without[0]!r}"
        )
        if not buildings:
            raise ValueError(message)
        warnings.warn(f"{message}; they are left out", stacklevel=2)
    return City.from_buildings(buildings, cell=cell, margin=margin, name=path.name.split(".")[0])


def building_surfaces(
    document: Mapping[str, Any], transform: Mapping[str, Any] | None, path: Path
) -> list[tuple[str, list[list[np.ndarray]]]]:
    """The key of each building, for a part that of its building, and its surfaces as rings (M, 3) [m]."""
    found = []
    key = "vertices"
    try:
        vertices = np.array(document.get("vertices") or [], dtype=float).reshape(-1, 3)
        if transform is not None:
            vertices = vertices * transform["scale"] + transform["translate"]
        if not np.isfinite(vertices).all():
            raise ValueError("a coordinate is NaN or infinite")
        for key, item in document.get("CityObjects", {}).items():
            if item["type"] == "Building":
                found.append((key, finest_surfaces(item, vertices)))
            elif item["type"] == "BuildingPart":
                found.append(((item.get("parents") or [key])[0], finest_surfaces(item, vertices)))
    except (AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
        raise ValueError(f"{path.name}: {key!r} is malformed: {error!r}") from None
    return found


def finest_surfaces(item: Mapping[str, Any], vertices: np.ndarray) -> list[list[np.ndarray]]:
    """Surfaces of an object in its highest level of detail; none if that is 0, a footprint."""
    levels = defaultdict(list)
    for geometry in item.get("geometry") or []:
        if geometry["type"] in NESTING and float(geometry["lod"]) >= 1:
            levels[float(geometry["lod"])].append(geometry)
    surfaces = []
    for geometry in levels[max(levels)] if levels else []:
        nested = geometry["boundaries"]
        for _ in range(NESTING[geometry["type"]]):
            nested = [inner for outer in nested for inner in outer]
        surfaces += [[vertices[np.array(ring, int)].reshape(len(ring), 3) for ring in rings] for rings in nested]
    return [[ring for ring in rings if len(ring) > 2] for rings in surfaces if rings and len(rings[0]) > 2]


def pieces_below(surfaces: Iterable[Sequence[np.ndarray]]) -> list[np.ndarray]:
    """Convex pieces that fill the space between surfaces, each as rings (M, 3) [m], and the ground z = 0.

    Flat surfaces of one height are joined first, so that a roof of many triangles gives few pieces; floors, which lie
    under other surfaces, give none. Sloped surfaces are cut into triangles.
    """
    flat, slopes, pieces = defaultdict(list), [], []
    for rings in surfaces:
        corners = np.vstack(rings)
        polygon = shapely.make_valid(shapely.Polygon(rings[0][:, :2], [ring[:, :2] for ring in rings[1:]]))
        polygon = shapely.MultiPolygon(polygons_in(polygon))
        if not is_thick(polygon):
            continue
        if np.ptp(corners[:, 2]) < THINNEST:
            flat[round(corners[:, 2].max(), 3)].append(polygon)
        else:
            slopes.append((corners[:, 2].min(), polygon))
            pieces += pieces_below_slope(polygon, corners)
    higher = shapely.Polygon()
    for height in sorted((height for height in flat if height > THINNEST), reverse=True):
        cover = shapely.union_all([higher, *(polygon for low, polygon in slopes if low >= height - THINNEST)])
        level = shapely.union_all(flat[height])
        for polygon in polygons_in(level):
            if is_thick(polygon.difference(cover)):
                pieces += [extrude(part, 0.0, height) for part in convex_parts(polygon)]
        higher = higher.union(level)
    return pieces


def pieces_below_slope(polygon: shapely.MultiPolygon, corners: np.ndarray) -> list[np.ndarray]:
    """A convex piece below each triangle of a surface, given from above and by its corners (M, 3) [m]."""
    pieces = []
    corners = corners[np.argsort(-corners[:, 2])]  # of two corners above each other, the higher one counts
    for triangle in filter(is_thick, shapely.constrained_delaunay_triangles(polygon).geoms):
        outline = shapely.get_coordinates(triangle)[:3]
        nearest = np.linalg.norm(outline[:, None] - corners[:, :2], axis=2).argmin(axis=1)
        piece = extrude(outline, 0.0, 0.0)
        piece[:3, 2] = corners[nearest, 2]
        if piece[:, 2].max() > THINNEST:
            pieces.append(piece)
    return pieces


def is_thick(polygon: shapely.Geometry) -> bool:
    """Whether a polygon is wider than about a millimetre; a wall, seen from above, is not."""
    return 2 * polygon.area > THINNEST * polygon.length


def polygons_in(geometry: shapely.Geometry) -> list[shapely.Polygon]:
    """The polygons of a geometry, without the lines and points that a repair may leave."""
    parts = shapely.get_parts(shapely.get_parts(geometry))
    return [part for part in parts if part.geom_type == "Polygon" and not part.is_empty]
