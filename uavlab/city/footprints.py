"""Polygons of a GeoJSON file as footprints: mended where their rings are broken, sorted into buildings and others."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import shapely

from uavlab.city.documents import progress
from uavlab.city.source import Notes

NARROWEST = 0.1
"""What parts leave of an outline counts from this width on [m]; less is how two outlines were drawn apart."""

OTHER = "no obstacle"
BUILDING, PART = "building", "building part"


class Footprint(NamedTuple):
    """A feature with polygons."""

    label: str
    name: str
    polygons: shapely.MultiPolygon
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


def declared_system(document: Mapping[str, Any]) -> Any:
    """What a "crs" member names; None where there is none."""
    crs = document.get("crs")
    if isinstance(crs, dict) and isinstance(crs.get("properties"), dict):
        return crs["properties"].get("name") or crs["properties"].get("code")
    return crs if isinstance(crs, str | int) else None


def footprints_of(features: Sequence[Mapping[str, Any]], notes: Notes) -> list[Footprint]:
    """All features with polygons that have an area, mended; what has none is noted."""
    found, without = [], 0
    for index, feature in enumerate(progress(features, "features")):
        footprint = footprint_of(feature, index, notes)
        if footprint is None:
            without += 1
        else:
            found.append(footprint)
    if without:
        notes.add("derived", f"{OTHER}: points, lines, features without geometry", count=without)
    return found


def footprint_of(feature: Mapping[str, Any], index: int, notes: Notes) -> Footprint | None:
    """A feature's polygons; None where it has none."""
    properties = feature.get("properties") or {}
    label = f"feature {index} (counted from 0)"
    try:
        identifier = feature.get("id", properties.get("id", properties.get("@id")))
        label = label if identifier is None else f"feature {identifier}"
        outlines = outlines_of(feature.get("geometry"))
    except (AttributeError, IndexError, KeyError, OverflowError, RecursionError, TypeError, ValueError) as error:
        raise ValueError(f"{label!r} is malformed: {error!r:.200}") from None
    if not outlines:
        return None
    whole = [mended(rings) for rings in outlines]
    polygons = [polygon for mend, _ in whole for polygon in mend]
    if not polygons:
        notes.add("left out", "polygon without area", label)
        return None
    if any(broken for _, broken in whole):
        notes.add("mended", "outline that crossed or touched itself, or a ring without area", label)
    return Footprint(label, str(properties.get("name") or label), shapely.MultiPolygon(polygons), properties)


def outlines_of(geometry: Mapping[str, Any] | None) -> list[list[np.ndarray]]:
    """The rings (M, 2) of each polygon in a geometry, the outline first."""
    if geometry is None:
        return []
    if geometry["type"] == "GeometryCollection":
        return [outline for part in geometry["geometries"] for outline in outlines_of(part)]
    if geometry["type"] not in ("Polygon", "MultiPolygon"):
        return []
    polygons = geometry["coordinates"] if geometry["type"] == "MultiPolygon" else [geometry["coordinates"]]
    return [[ring_of(ring) for ring in polygon] for polygon in polygons if polygon]


def ring_of(ring: Sequence[Sequence[float]]) -> np.ndarray:
    corners = np.array([(x, y) for x, y, *_ in ring], float).reshape(-1, 2)
    if not np.isfinite(corners).all():
        raise ValueError("a coordinate is NaN or infinite")
    return corners


def mended(rings: Sequence[np.ndarray]) -> tuple[list[shapely.Polygon], bool]:
    """Simple polygons with the area of an outline and its holes, none if it has none; and whether it was broken."""
    shell, *holes = rings
    proper = [hole for hole in holes if len(np.unique(hole, axis=0)) > 2]
    if len(np.unique(shell, axis=0)) < 3:
        return [], True
    polygon = shapely.Polygon(shell, proper)
    broken = len(proper) < len(holes) or not polygon.is_valid
    if broken:
        polygon = shapely.make_valid(polygon)
    return polygons_in(polygon), broken


def polygons_in(geometry: shapely.Geometry) -> list[shapely.Polygon]:
    """The polygons of a geometry, without the lines and points that a repair may leave."""
    parts = shapely.get_parts(shapely.get_parts(geometry))
    return [part for part in parts if part.geom_type == "Polygon" and part.area > 0]


def is_set(properties: Mapping[str, Any], key: str) -> bool:
    return str(properties.get(key) or "no").lower() not in ("no", "false", "0")


def kinds_of(footprints: Sequence[Footprint], has_height: Sequence[bool]) -> list[str]:
    """What each footprint is: a building, a part of one, or no obstacle.

    In a file with OpenStreetMap's `building`, other polygons are land and water, unless they have a height.
    """
    marked = any("building" in f.properties or "building:part" in f.properties for f in footprints)
    kinds = []
    for footprint, high in zip(footprints, has_height, strict=True):
        if is_set(footprint.properties, "building:part"):
            kinds.append(PART)
        elif marked and not is_set(footprint.properties, "building") and not high:
            kinds.append(OTHER)
        else:
            kinds.append(BUILDING)
    return kinds


def without_parts(outlines: Sequence[shapely.MultiPolygon], parts: Sequence[shapely.MultiPolygon]) -> list[list[int]]:
    """For each outline [m] the numbers of the parts that override it: those at least half of which lie in it."""
    tree = shapely.STRtree(parts)
    members: list[list[int]] = []
    for outline in outlines:
        near = tree.query(outline, predicate="intersects")
        members.append([int(n) for n in near if parts[n].intersection(outline).area >= 0.5 * parts[n].area])
    return members


def rest_of(outline: shapely.MultiPolygon, parts: Sequence[shapely.MultiPolygon]) -> shapely.MultiPolygon:
    """What parts leave of an outline [m], where it is wide enough to be more than two ways to draw a line."""
    left = outline.difference(shapely.union_all(parts))
    opened = left.buffer(-NARROWEST / 2)
    return shapely.MultiPolygon([p for p in polygons_in(left) if not p.intersection(opened).is_empty])
