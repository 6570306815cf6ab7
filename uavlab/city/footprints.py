"""Polygons of a GeoJSON file as footprints: mended where their rings are broken, sorted into buildings and others."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Mapping, Sequence
from functools import reduce
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import shapely

from uavlab.city.buildings import polygons_in
from uavlab.city.documents import progress
from uavlab.city.place import common_system
from uavlab.city.source import Notes

OTHER = "no obstacle"
BUILDING, PART = "building", "building part"

TALL = {
    "aerialway": {"cable_car", "chair_lift", "gondola", "pylon"},
    "bridge": {"yes", "viaduct"},
    "generator:source": {"wind"},
    "man_made": {
        "bridge", "chimney", "communications_tower", "cooling_tower", "crane", "gasometer", "lighthouse", "mast",
        "silo", "storage_tank", "tower", "water_tower", "windmill",
    },
    "natural": {"tree", "tree_row"},
    "power": {"catenary_mast", "line", "minor_line", "pole", "portal", "tower"},
}  # fmt: skip
"""OpenStreetMap's tags of obstacles that are no buildings, by key."""

TAGS = ("tags", "all_tags", "other_tags")
"""Properties in which exports of OpenStreetMap keep tags: as an object or its text (osm2geojson, pyrosm), or as GDAL's
text `"height"=>"12","building:levels"=>"3"`."""

ARROW = re.compile(r'"((?:[^"\\]|\\.)*)"\s*=>\s*"((?:[^"\\]|\\.)*)"')

WITHOUT_AREA = ("Point", "MultiPoint", "LineString", "MultiLineString", "GeometryCollection", "Polygon", "MultiPolygon")
"""The geometries of GeoJSON, which may all be without an area."""


class Footprint(NamedTuple):
    """A feature with polygons."""

    label: str
    name: str
    polygons: shapely.MultiPolygon
    properties: Mapping[str, Any]


def features_of(document: Mapping[str, Any], path: Path) -> list[Mapping[str, Any]]:
    """The features of a GeoJSON document; a bare geometry is a feature without properties."""
    kind = document.get("type")
    if kind == "Feature":
        return [document]
    if kind != "FeatureCollection" and ("coordinates" in document or "geometries" in document):
        return [{"geometry": document}]
    if kind is None and "geometryType" in document:
        raise ValueError(f"{path.name} is Esri JSON, not GeoJSON: ask the server for f=geojson, or convert it")
    features = document.get("features")
    if not isinstance(features, list):
        raise ValueError(
            f"{path.name} is not GeoJSON: expected a FeatureCollection with a list of features, "
            f"got type {kind!r} (CityJSON is read by read_cityjson)"
        )
    for index, feature in enumerate(features):
        if not isinstance(feature, dict):
            raise ValueError(f"feature {index} (counted from 0) of {path.name} is no object {{...}}: {feature!r:.60}")
    return features


def declared_system(documents: Sequence[Mapping[str, Any]], file: str) -> Any:
    """What the "crs" members of a file name; None where there is none."""
    return common_system([named_system(document.get("crs")) for document in documents], file)


def named_system(crs: Any) -> Any:
    """What a "crs" member names: a name, a code, or a link."""
    if isinstance(crs, dict) and isinstance(crs.get("properties"), dict):
        return next((crs["properties"][key] for key in ("name", "code", "href") if crs["properties"].get(key)), None)
    return crs if isinstance(crs, str | int) else None


def properties_of(feature: Mapping[str, Any]) -> Mapping[str, Any]:
    """The properties of a feature, with the tags that stand packed in one of them, see `TAGS`."""
    properties = feature.get("properties") or {}
    tags = {key: value for member in TAGS for key, value in unpacked(properties.get(member)).items()}
    return tags | {key: value for key, value in properties.items() if value is not None} if tags else properties


def unpacked(tags: Any) -> Mapping[str, Any]:
    """Tags from an object or a text; empty if it is neither."""
    if isinstance(tags, str) and tags.lstrip().startswith("{"):
        try:
            tags = json.loads(tags)
        except ValueError:
            return {}
    elif isinstance(tags, str):
        return {re.sub(r"\\(.)", r"\1", key): re.sub(r"\\(.)", r"\1", value) for key, value in ARROW.findall(tags)}
    return tags if isinstance(tags, dict) else {}


def is_tall(properties: Mapping[str, Any]) -> bool:
    """Whether a feature is tagged as an obstacle."""
    return any(str(properties.get(key)) in values for key, values in TALL.items()) or any(
        is_set(properties, key) for key in ("building", "building:part")
    )


def footprints_of(
    features: Sequence[Mapping[str, Any]], notes: Notes, counts: Callable[[Mapping[str, Any]], bool]
) -> list[Footprint]:
    """All features with polygons that have an area, mended.

    What has none is noted; as left out where `counts` says of its properties that it should be here.
    """
    found: list[tuple[str, str, Mapping[str, Any]]] = []
    outlines: list[list[list[np.ndarray]]] = []
    without = raised = 0
    for index, feature in enumerate(progress(features, "features")):
        label, name, properties, rings, has_altitude = read_feature(feature, index)
        raised += has_altitude
        geometry = feature.get("geometry") or {"type": None}
        if rings:
            found.append((label, name, properties))
            outlines.append(rings)
        elif geometry["type"] not in (None, *WITHOUT_AREA):
            notes.add("left out", f"geometry of type {geometry['type']!r:.40}, which GeoJSON doesn't know", label)
        elif counts(properties):
            notes.add("left out", f"{geometry['type'] or 'feature without geometry'} that has no outline", label)
        else:
            without += 1
    if without:
        notes.add("derived", f"{OTHER}: points, lines, features without geometry", count=without)
    if raised:
        notes.add("derived", "third coordinates, which say nothing about heights here", count=raised)
    footprints = []
    for (label, name, properties), (polygons, broken) in zip(found, mended_all(outlines), strict=True):
        if polygons is None:
            notes.add("left out", "polygon without area", label)
            continue
        if broken:
            notes.add("mended", "outline that crossed or touched itself, or a ring without area", label)
        footprints.append(Footprint(label, name, polygons, properties))
    return footprints


def read_feature(
    feature: Mapping[str, Any], index: int
) -> tuple[str, str, Mapping[str, Any], list[list[np.ndarray]], bool]:
    """Label, name, properties and outlines of a feature, and whether it has altitudes; `ValueError` names it."""
    label = f"feature {index} (counted from 0)"
    try:
        properties = properties_of(feature)
        identifier = feature.get("id", properties.get("id", properties.get("@id")))
        label = label if identifier is None else f"feature {identifier}"
        geometry = feature.get("geometry")
        outlines = outlines_of(geometry)
        has_altitude = geometry is not None and bool(outlines) and has_altitudes(geometry)
    except (AttributeError, IndexError, KeyError, OverflowError, RecursionError, TypeError, ValueError) as error:
        raise ValueError(f"{label!r:.200} is malformed: {error!r:.200}") from None
    return label, str(properties.get("name") or label), properties, outlines, has_altitude


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
    corners = np.array([(x, y) for x, y, *_ in ring] or np.empty((0, 2)))
    if corners.dtype.kind not in "fi":
        raise ValueError(f"coordinates must be numbers that a float can hold, got {ring[0]!r:.60}")
    if not np.isfinite(corners).all():
        raise ValueError("a coordinate is NaN or infinite")
    return corners.astype(float, copy=False)


def has_altitudes(geometry: Mapping[str, Any]) -> bool:
    """Whether a ring has a third coordinate that isn't 0."""
    if geometry["type"] == "GeometryCollection":
        return any(has_altitudes(part) for part in geometry["geometries"])
    if geometry["type"] not in ("Polygon", "MultiPolygon"):
        return False
    polygons = geometry["coordinates"] if geometry["type"] == "MultiPolygon" else [geometry["coordinates"]]
    return any(len(point) > 2 and point[2] for polygon in polygons for ring in polygon for point in ring)


def mended_all(outlines: Sequence[Sequence[Sequence[np.ndarray]]]) -> list[tuple[shapely.MultiPolygon | None, bool]]:
    """The polygons of each feature with outlines, None where they have no area; and whether any was broken.

    All at once, because a city has many; only the broken ones are looked at one by one.
    """
    polygons = [rings for some in outlines for rings in some]
    owner = np.repeat(np.arange(len(outlines)), [len(some) for some in outlines])
    rings = [ring for some in polygons for ring in some]
    of_polygon = np.repeat(np.arange(len(polygons)), [len(some) for some in polygons])
    poor = np.array([different(ring) < 3 for ring in rings], dtype=bool)
    broken = np.zeros(len(polygons), dtype=bool)
    broken[of_polygon[poor]] = True
    whole = np.flatnonzero(~broken)
    good = [ring for ring, of in zip(rings, of_polygon, strict=True) if not broken[of]]
    if good:
        loops = shapely.linearrings(np.concatenate(good), indices=np.repeat(np.arange(len(good)), [*map(len, good)]))
        shapes = shapely.polygons(loops, indices=np.searchsorted(whole, of_polygon[~broken[of_polygon]]))
        broken[whole[~shapely.is_valid(shapes)]] = True
        valid, owners = shapes[~broken[whole]], owner[whole[~broken[whole]]]
    else:
        valid, owners = np.empty(0, dtype=object), np.empty(0, dtype=int)
    mends = [(int(owner[n]), part) for n in np.flatnonzero(broken) for part in mended(polygons[n])]
    parts = np.array([*valid, *(part for _, part in mends)], dtype=object)
    owners = np.concatenate([owners, [of for of, _ in mends]]).astype(int)
    order = np.argsort(owners, kind="stable")
    present = np.unique(owners)
    found = np.full(len(outlines), None, dtype=object)
    if len(parts):
        found[present] = shapely.multipolygons(parts[order], indices=np.searchsorted(present, owners[order]))
    were_broken = np.bincount(owner[broken], minlength=len(outlines)) > 0
    return list(zip(found, were_broken.tolist(), strict=True))


def different(ring: np.ndarray) -> int:
    """How many corners of a ring differ from each other."""
    return len(set(map(tuple, ring.tolist())))


def mended(rings: Sequence[np.ndarray]) -> list[shapely.Polygon]:
    """Simple polygons with the area of an outline and its holes, none if it has none.

    What an outline goes around is inside, twice or in whatever direction; what several holes share, or what lies
    outside of the outline, is no hole. So nothing that somebody may have meant to be built is lost.
    """
    shell, *holes = (repaired(ring) for ring in rings)
    courtyards = reduce(shapely.symmetric_difference, holes, shapely.Polygon())
    left = shapely.difference(shell, courtyards)
    return polygons_in(left if left.area > 0 else shell)


def repaired(ring: np.ndarray) -> shapely.Geometry:
    """All that a ring goes around."""
    if different(ring) < 3:
        return shapely.Polygon()
    return shapely.make_valid(shapely.Polygon(ring), method="structure", keep_collapsed=False)


def is_set(properties: Mapping[str, Any], key: str) -> bool:
    return str(properties.get(key) or "no").lower() not in ("no", "false", "0")


def kinds_of(footprints: Sequence[Footprint], has_height: Sequence[bool]) -> list[str]:
    """What each footprint is: a building, a part of one, or no obstacle.

    In a file with OpenStreetMap's `building`, other polygons are land and water, unless they have a height or are
    tagged as something tall.
    """
    marked = any("building" in f.properties or "building:part" in f.properties for f in footprints)
    kinds = []
    for footprint, high in zip(footprints, has_height, strict=True):
        if is_set(footprint.properties, "building:part"):
            kinds.append(PART)
        elif marked and not is_tall(footprint.properties) and not high:
            kinds.append(OTHER)
        else:
            kinds.append(BUILDING)
    return kinds
