"""Footprints with heights from GeoJSON, in degrees or in metres.

Longitude and latitude are projected onto the plane that touches the Earth at the south-west corner of the buildings;
metres counted from far away are shifted there. An outline that crosses itself or a height that is missing is refused
with its place in the file and a cure: a building left out in silence is one that a UAV flies into.
"""

import json
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
import shapely

from uavlab.city.buildings import Building, convex_parts, extrude, footprint_polygon
from uavlab.city.documents import count, lowest_corner, read_json
from uavlab.city.model import City
from uavlab.city.place import Place

EQUATORIAL_RADIUS, FLATTENING = 6_378_137.0, 1 / 298.257223563
"""The ellipsoid WGS84 [m, 1]."""

WEB_MERCATOR = {3857, 3785, 102100, 900913}
"""Codes of the projection of web maps. Its metres are too long, by 1/cos(latitude)."""


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
        reference=Place(float(corner[0]), float(corner[1])) if degrees else None,
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


def longitude_latitude(points: npt.ArrayLike, reference: npt.ArrayLike) -> np.ndarray:
    """Longitude and latitude (..., 2) [degrees] of points (..., 2) [m] east and north of a reference.

    The inverse of `east_north`, exact: the line through the point, upright on the plane, meets the ellipsoid
    (x² + y²)/a² + z²/b² = 1 where a quadratic equation says, the nearer of its two roots. Longitudes go on past ±180
    instead of jumping.
    """
    east, north = np.moveaxis(np.asarray(points, dtype=float), -1, 0)
    longitude, latitude = np.asarray(reference, dtype=float)
    up_x, up_z = np.cos(np.radians(latitude)), np.sin(np.radians(latitude))  # with x towards the reference's meridian
    start_x, _, start_z = earth_centred((0.0, latitude))
    x, z = start_x - up_z * north, start_z + up_x * north
    squeezed = (1 - FLATTENING) ** 2  # (b/a)²
    half = up_x * x + up_z * z / squeezed
    beyond = x**2 + east**2 + z**2 / squeezed - EQUATORIAL_RADIUS**2
    up = -beyond / (half + np.sqrt(half**2 - (up_x**2 + up_z**2 / squeezed) * beyond))
    x, z = x + up * up_x, z + up * up_z
    turned = np.degrees(np.arctan2(east, x))
    return np.stack([longitude + turned, np.degrees(np.arctan2(z, squeezed * np.hypot(x, east)))], axis=-1)


def earth_centred(lonlat: npt.ArrayLike) -> np.ndarray:
    """Cartesian coordinates (..., 3) [m] of points (..., 2) [degrees] on the ellipsoid WGS84."""
    lon, lat = np.moveaxis(np.radians(np.asarray(lonlat, dtype=float)), -1, 0)
    eccentricity_squared = FLATTENING * (2 - FLATTENING)
    normal = EQUATORIAL_RADIUS / np.sqrt(1 - eccentricity_squared * np.sin(lat) ** 2)
    x, y = normal * np.cos(lat) * np.cos(lon), normal * np.cos(lat) * np.sin(lon)
    return np.stack([x, y, normal * (1 - eccentricity_squared) * np.sin(lat)], axis=-1)
