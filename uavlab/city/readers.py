"""Readers for real cities: GeoJSON footprints with heights, CityJSON models with roofs, and voxel maps.

Real coordinates are degrees, or metres counted from far away. Here x points east, y north, x = y = 0 is the south-west
corner of the buildings' bounding box and z = 0 the ground; the map begins `margin` metres before it. What can't be read
is refused with its place in the file and a cure: a building left out in silence is one that a UAV flies into.
"""

import json
import re
import warnings
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
import shapely

from uavlab.city.buildings import Building, convex_parts, extrude, footprint_polygon
from uavlab.city.model import MOST_VOXELS, City

EQUATORIAL_RADIUS, FLATTENING = 6_378_137.0, 1 / 298.257223563
"""The ellipsoid WGS84 [m, 1]."""

WEB_MERCATOR = {3857, 3785, 102100, 900913}
"""Codes of the projection of web maps. Its metres are too long, by 1/cos(latitude)."""

THINNEST = 1e-3
"""What is thinner or lower [m] is nothing, or a wall seen from above; files of city models keep three decimals."""

NESTING = {"MultiSurface": 0, "CompositeSurface": 0, "Solid": 1, "MultiSolid": 2, "CompositeSolid": 2}
"""Geometries of CityJSON that have surfaces, and how many levels of lists stand around them."""


def read_city(path: str | Path, **options: Any) -> City:
    """Read a city from a file of any known format, chosen by what the file contains.

    Parameters
    ----------
    path : str or Path
        GeoJSON, CityJSON (also as a sequence, one feature per line), or a voxel map (.3dmap).
    **options
        Passed on to `read_geojson`, `read_cityjson` or `read_voxels`, for example `cell=2.0`.

    Raises
    ------
    ValueError
        If the format is none of these, or the file is broken.
    FileNotFoundError
        If there is no such file.
    """
    path = Path(path)
    with path.open("rb") as file:
        start = file.read(64).removeprefix(b"\xef\xbb\xbf").lstrip()
    if path.suffix.lower() == ".3dmap" or start.startswith(b"voxel"):
        return read_voxels(path, **options)
    if start.startswith(b"{") or path.suffix.lower() in {".json", ".jsonl", ".geojson"}:
        kind = read_json(path)[0].get("type")
        if kind == "CityJSON":
            return read_cityjson(path, **options)
        if kind in {"FeatureCollection", "Feature", "GeometryCollection", "Polygon", "MultiPolygon"}:
            return read_geojson(path, **options)
    raise ValueError(
        f"{path.name} is not a city that can be read. Known are GeoJSON (.geojson, .json: footprints with heights), "
        "CityJSON (.city.json, .json, .jsonl: models with roofs) and voxel maps (.3dmap)"
    )


def read_geojson(
    path: str | Path,
    *,
    height: str | float = "height",
    base: str | float = "min_height",
    cell: float = 1.0,
    margin: float = 20.0,
    units: str = "auto",
) -> City:
    """Read footprints with heights from a GeoJSON file (RFC 7946), for example an export of OpenStreetMap.

    Every feature with polygons becomes one building, a prism over each polygon without its holes; points and lines
    are skipped. The ground is level at z = 0.

    Parameters
    ----------
    path : str or Path
        UTF-8 text: a feature collection, a feature or a geometry; or one of these per line.
    height : str or float
        Property that holds the height of the roof above ground [m], a number or a text like "12.5 m"; or one height
        for all buildings [m], above 0.
    base : str or float
        Property that holds the height of the underside [m], or one for all; where it is absent, 0. Above 0 the
        building floats.
    cell : float
        Edge of a voxel [m], typically 0.5 to 5.
    margin : float
        Free space around and above the buildings [m].
    units : {"auto", "degrees", "metres"}
        Degrees are longitude and latitude on WGS84, projected onto the plane that touches the ellipsoid at the
        south-west corner, which `City.reference` names. Metres are shifted until this corner is x = y = 0, and
        `City.reference` is None. "auto" takes metres where a coordinate is out of the range of degrees or the file has
        a "crs" member with the EPSG code of a projection, else degrees.

    Raises
    ------
    ValueError
        If the file is broken or has no polygon; an outline crosses itself; a height is missing or not above the base;
        units were mistaken; or the map would have over 500 million voxels.
    """
    if units not in ("auto", "degrees", "metres"):
        raise ValueError(f"units must be 'auto', 'degrees' or 'metres', got {units!r}")
    path = Path(path)
    documents = read_json(path)
    features = [feature for document in documents for feature in features_of(document, path)]
    footprints = [footprint_of(feature, index) for index, feature in enumerate(features)]
    footprints = [footprint for footprint in footprints if footprint.polygons]
    if not footprints:
        kinds = count((feature.get("geometry") or {}).get("type") for feature in features)
        raise ValueError(f"{path.name} has no polygon; its features are {kinds}")
    heights = heights_above_base(footprints, height, base)
    bounds = shapely.total_bounds([polygon for footprint in footprints for polygon in footprint.polygons])
    degrees = in_degrees(bounds, documents[0].get("crs"), units)
    corner = bounds[:2]

    def local(points: np.ndarray) -> np.ndarray:
        return east_north(points, corner) if degrees else points - corner

    buildings = []
    for footprint, (bottom, top) in zip(footprints, heights, strict=True):
        parts = [part for polygon in footprint.polygons for part in convex_parts(shapely.transform(polygon, local))]
        buildings.append(Building(tuple(extrude(part, bottom, top) for part in parts), footprint.name))
    taken, other = ("degrees", "metres") if degrees else ("metres", "degrees")
    advice = f"coordinates were read as {taken}; if they are {other}, pass units='{other}'"
    low = lowest_corner(np.vstack([building.bounds for building in buildings]), advice)
    return City.from_buildings(
        buildings,
        cell=cell,
        origin=(low[0] - margin, low[1] - margin, 0.0),
        margin=margin,
        name=path.name.split(".")[0],
        reference=(float(corner[0]), float(corner[1])) if degrees else None,
    )


class Footprint(NamedTuple):
    """A feature, with its polygons in the coordinates of the file; points and lines have none."""

    label: str
    name: str
    polygons: list[shapely.Polygon]
    properties: Mapping[str, Any]


def features_of(document: Mapping[str, Any], path: Path) -> list[Mapping[str, Any]]:
    """The features of a GeoJSON document; a bare geometry is a feature without properties."""
    features = [document] if document.get("type") == "Feature" else document.get("features")
    if "coordinates" in document or "geometries" in document:
        features = [{"geometry": document}]
    if not isinstance(features, list) or not all(isinstance(feature, dict) for feature in features):
        raise ValueError(
            f"{path.name} is not GeoJSON: expected a FeatureCollection with a list of features, "
            f"got type {document.get('type')!r} (CityJSON is read by read_cityjson)"
        )
    return features


def footprint_of(feature: Mapping[str, Any], index: int) -> Footprint:
    """The polygons of a feature, checked where messages can still name the file's own coordinates."""
    properties = feature.get("properties") or {}
    identifier = feature.get("id", properties.get("id", f"{index} (counted from 0)"))
    label = f"feature {identifier}"
    try:
        outlines = outlines_of(feature.get("geometry"))
    except (AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
        raise ValueError(f"geometry of {label!r} is malformed: {error!r}") from None
    polygons = [footprint_polygon(outline, holes, label) for outline, *holes in outlines]
    return Footprint(label, str(properties.get("name") or label), polygons, properties)


def outlines_of(geometry: Mapping[str, Any] | None) -> list[list[np.ndarray]]:
    """The rings (M, 2) of each polygon in a geometry, the outline first."""
    if geometry is None:
        return []
    if geometry["type"] == "GeometryCollection":
        return [outline for part in geometry["geometries"] for outline in outlines_of(part)]
    if geometry["type"] not in ("Polygon", "MultiPolygon"):
        return []
    polygons = geometry["coordinates"] if geometry["type"] == "MultiPolygon" else [geometry["coordinates"]]
    return [[np.array([(x, y) for x, y, *_ in ring], float) for ring in polygon] for polygon in polygons if polygon]


def heights_above_base(
    footprints: Sequence[Footprint], height: str | float, base: str | float
) -> list[tuple[float, float]]:
    """Underside and roof of each footprint [m]; `ValueError` counts those that have none and says what to do."""
    heights, unusable = [], []
    for footprint in footprints:
        top = footprint.properties.get(height) if isinstance(height, str) else height
        bottom = footprint.properties.get(base) if isinstance(base, str) else base
        heights.append((0.0 if bottom is None else metres(bottom), metres(top)))
        if not heights[-1][1] > heights[-1][0] >= 0:
            unusable.append(f"{footprint.label!r} with height {top!r} and base {bottom!r}")
    if unusable:
        known = sorted({key for footprint in footprints for key in footprint.properties})
        raise ValueError(
            f"{len(unusable)} of {len(footprints)} features with polygons have no usable height, in metres and above "
            f"a base of at least 0, with height={height!r} and base={base!r}; the first is {unusable[0]}. "
            f"Properties in the file: {', '.join(known) or 'none'}. Pass height='one of them' or a number for all"
        )
    return heights


def metres(value: Any) -> float:
    """A length [m] given as a number, as "12.5" or as "12.5 m"; NaN if it is none of these."""
    try:
        number = float(str(value).strip().removesuffix("m"))
    except ValueError:
        return np.nan
    return number if np.isfinite(number) else np.nan


def in_degrees(bounds: np.ndarray, crs: Any, units: str) -> bool:
    """Whether coordinates within bounds (west, south, east, north) are degrees, see `read_geojson`."""
    within = bool((np.abs(bounds) <= [180, 90, 180, 90]).all())
    codes = [int(digits) for digits in re.findall(r"\d{4,6}", json.dumps(crs))]
    if units == "degrees" and not within:
        raise ValueError(
            "units='degrees' takes longitudes within ±180 and latitudes within ±90, but the coordinates reach from "
            f"({bounds[0]:g}, {bounds[1]:g}) to ({bounds[2]:g}, {bounds[3]:g}): pass units='metres'"
        )
    if units == "auto" and not within and WEB_MERCATOR.intersection(codes):
        raise ValueError(
            "coordinates are in Web Mercator (EPSG:3857), whose metres are too long by 1/cos(latitude): "
            "convert the file to longitude and latitude (EPSG:4326)"
        )
    geographic = all(4000 <= code < 5000 for code in codes[-1:])  # where EPSG keeps longitude and latitude
    return units == "degrees" or (units == "auto" and within and geographic)


def east_north(lonlat: npt.ArrayLike, reference: npt.ArrayLike) -> np.ndarray:
    """East and north (..., 2) [m] of points (..., 2) [degrees], in the plane that touches WGS84 at the reference.

    Exact: geodetic → earth-centred → east-north-up, with up left out. A distance of 10 km from the reference is
    4 mm shorter in the plane than on the ellipsoid.
    """
    lon, lat = np.radians(np.asarray(reference, dtype=float))
    east = [-np.sin(lon), np.cos(lon), 0.0]
    north = [-np.sin(lat) * np.cos(lon), -np.sin(lat) * np.sin(lon), np.cos(lat)]
    return (earth_centred(lonlat) - earth_centred(reference)) @ np.transpose([east, north])


def earth_centred(lonlat: npt.ArrayLike) -> np.ndarray:
    """Cartesian coordinates (..., 3) [m] of points (..., 2) [degrees] on the ellipsoid WGS84."""
    lon, lat = np.moveaxis(np.radians(np.asarray(lonlat, dtype=float)), -1, 0)
    eccentricity_squared = FLATTENING * (2 - FLATTENING)
    normal = EQUATORIAL_RADIUS / np.sqrt(1 - eccentricity_squared * np.sin(lat) ** 2)
    x, y = normal * np.cos(lat) * np.cos(lon), normal * np.cos(lat) * np.sin(lon)
    return np.stack([x, y, normal * (1 - eccentricity_squared) * np.sin(lat)], axis=-1)


def lowest_corner(corners: np.ndarray, advice: str) -> np.ndarray:
    """Lowest of corners (N, 3) [m] on each axis; `ValueError` with advice if they span under 1 m or over 100 km."""
    x, y, _ = np.ptp(corners, axis=0)
    if not 1.0 <= max(x, y) <= 100e3:
        raise ValueError(f"the buildings cover {x:.3g} × {y:.3g} m, which is no city: {advice}")
    return corners.min(axis=0)


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


def read_voxels(path: str | Path, *, cell: float = 1.0) -> City:
    """Read a voxel map of the 3-D pathfinding benchmarks (Brewer and Sturtevant 2018, `.3dmap`).

    The first line is `voxel W H D`, the number of voxels along x, y and z. Each line after it is a blocked voxel,
    `x y z`, counted from 0. The map begins at (0, 0, 0) and knows no buildings.

    Parameters
    ----------
    path : str or Path
    cell : float
        Edge of a voxel [m].

    Raises
    ------
    ValueError
        If the header or a line is not as described; the message names the line.
    """
    path = Path(path)
    with path.open(encoding="utf-8-sig", errors="replace") as file:
        header = file.readline().strip()
        empty = not any(line.strip() for line in file)
    match = re.fullmatch(r"voxel\s+(\d+)\s+(\d+)\s+(\d+)", header)
    if match is None:
        raise ValueError(f"{path.name}, line 1: expected 'voxel W H D' with three whole numbers, got {header[:60]!r}")
    shape = tuple(int(digits) for digits in match.groups())
    if not 0 < np.prod(shape, dtype=float) <= MOST_VOXELS:
        raise ValueError(f"{path.name}, line 1: a map must have from 1 to {MOST_VOXELS:,} voxels, got {header!r}")
    occupied = np.zeros(shape, dtype=bool)
    if not empty:
        try:
            blocked = np.loadtxt(path, dtype=np.int64, comments=None, skiprows=1, ndmin=2, encoding="utf-8-sig")
            occupied[tuple(blocked.T)] = True
            wrong = blocked.shape[1] != 3 or blocked.min() < 0
        except (IndexError, ValueError):
            wrong = True
        if wrong:
            raise ValueError(f"{path.name}, {first_wrong_line(path, shape)}")
    return City(occupied, cell, name=path.name.split(".")[0])


def first_wrong_line(path: Path, shape: Sequence[int]) -> str:
    """Words for the first line of a voxel map that is not a voxel within its shape."""
    ranges = ", ".join(f"{axis} 0 to {extent - 1}" for axis, extent in zip("xyz", shape, strict=True))
    lines = path.read_text(encoding="utf-8-sig", errors="replace").split("\n")
    for number, line in enumerate(lines[1:], 2):
        voxel = re.fullmatch(r"\s*([+-]?\d+)\s+([+-]?\d+)\s+([+-]?\d+)\s*", line)
        if voxel is None and line.strip():
            return f"line {number}: expected three whole numbers 'x y z', got {line.strip()[:60]!r}"
        if voxel and not all(0 <= int(v) < extent for v, extent in zip(voxel.groups(), shape, strict=True)):
            return f"line {number}: voxel {line.strip()!r} lies outside of the map: {ranges}"
    return "expected three whole numbers 'x y z' on every line after the first"


def read_json(path: Path) -> list[dict[str, Any]]:
    """The JSON objects in a file: one, or a sequence with one per line."""
    documents: list[dict[str, Any]] = []
    position = 0
    try:
        text = path.read_text(encoding="utf-8-sig").rstrip()
        while position < len(text) or not documents:
            while text[position : position + 1].isspace():
                position += 1
            document, position = json.JSONDecoder().raw_decode(text, position)
            documents.append(document)
    except json.JSONDecodeError as error:
        place = f"line {error.lineno}, column {error.colno}"
        raise ValueError(f"{path.name} is not valid JSON: {error.msg} at {place}") from None
    except UnicodeDecodeError as error:
        raise ValueError(f"{path.name} is not UTF-8 text: {error.reason} at byte {error.start}") from None
    if not all(isinstance(document, dict) for document in documents):
        raise ValueError(f"{path.name} must hold a JSON object {{...}}, got a {type(documents[0]).__name__}")
    return documents


def count(kinds: Iterable[Any]) -> str:
    """Words for how often each kind occurs: "3 Point, 1 LineString"."""
    return ", ".join(f"{number} {kind}" for kind, number in Counter(kinds).most_common()) or "none at all"
