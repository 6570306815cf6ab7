"""Layers from OpenStreetMap's properties: cars on its roads, shelter under its woods and roofs.

What a map of the world says of roads and land is turned into what the papers ask for, by tables that stand here. They
are assumptions, and are said: the papers give one number of cars for all roads, and five classes of shelter.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import shapely

from uavlab import checks
from uavlab.city import City
from uavlab.city.documents import read_json
from uavlab.city.footprints import (
    declared_system,
    features_of,
    is_set,
    mended_all,
    outlines_of,
    properties_of,
    ring_of,
)
from uavlab.city.lazy import check_plain
from uavlab.city.lengths import length_in_metres
from uavlab.city.place import system_for
from uavlab.city.source import Notes, Source
from uavlab.risk.layers import column_centers, road_layer, shelter_layer
from uavlab.risk.rates import CARS_PER_KM, LANE_WIDTH, SHELTER

LANES = {
    "motorway": 2, "trunk": 2, "primary": 2, "secondary": 2, "tertiary": 2, "unclassified": 2, "residential": 2,
    "living_street": 1, "service": 1, "motorway_link": 1, "trunk_link": 1, "primary_link": 1, "secondary_link": 1,
    "tertiary_link": 1,
}  # fmt: skip
"""Lanes of a road that doesn't say, by `highway`; other ways have no cars.

OpenStreetMap draws the two directions of a motorway, or of another road that is divided, as two ways.
"""

CARS_BY_CLASS = {
    "motorway": 6.0, "trunk": 5.0, "primary": 4.0, "secondary": 3.0, "tertiary": 1.5, "unclassified": 0.5,
    "residential": 0.5, "living_street": 0.5, "service": 0.2, "motorway_link": 6.0, "trunk_link": 5.0,
    "primary_link": 4.0, "secondary_link": 3.0, "tertiary_link": 1.5,
}  # fmt: skip
"""Assumed cars per kilometre of a lane at day, by `highway`, for `osm_layers(..., cars_per_km=CARS_BY_CLASS)`.

Flow over speed: 660 cars an hour at 110 km/h are 6 a kilometre, 150 at 50 km/h are 3, 15 at 30 km/h are 0.5. These
flows are guesses of an ordinary city, not measured: give your own where they are known.
"""

SHELTERED = {
    ("natural", "wood"): "trees or low buildings", ("landuse", "forest"): "trees or low buildings",
    ("natural", "scrub"): "sparse trees", ("natural", "tree_row"): "sparse trees",
    ("landuse", "orchard"): "sparse trees", ("leisure", "park"): "sparse trees", ("leisure", "garden"): "sparse trees",
    ("landuse", "cemetery"): "sparse trees", ("landuse", "residential"): "sparse trees",
    ("landuse", "industrial"): "industry",
}  # fmt: skip
"""Class of PSO-BAS Table 1 for land, the greater where several lie over each other."""


class Layers(NamedTuple):
    """What a file says of the ground, for `RiskMap`; see `osm_layers`."""

    shelter: np.ndarray
    """(nx, ny) p_s."""
    vehicle_share: np.ndarray
    """(nx, ny) share of the ground under cars."""
    source: Source
    """What was taken and assumed."""

    def __repr__(self) -> str:
        nx, ny = self.shelter.shape
        return f"<Layers from {self.source.name}: shelter and vehicle_share of {nx} × {ny} columns>"


def osm_layers(
    city: City,
    path: str | Path,
    *,
    cars_per_km: float | Mapping[str, float] = CARS_PER_KM,
    lane_width: float = LANE_WIDTH,
    crs: Any = None,
) -> Layers:
    """Roads and shelter from a GeoJSON file with OpenStreetMap's properties, such as the one that the city came from.

    Parameters
    ----------
    city : City
        It must know its `reference`.
    path : str or Path
        UTF-8 text, as for `read_geojson`.
    cars_per_km : float, or mapping from classes of `highway` to floats
        K, cars per kilometre of a lane, at least 0. By default the papers' 0.1 on all roads, next to none;
        `CARS_BY_CLASS` has, by class, assumed values of an ordinary day. A class that a mapping leaves out has no cars.
    lane_width : float
        D_road [m], above 0, of roads that tell their lanes or nothing.
    crs : anything that pyproj takes, optional
        The reference system of the coordinates, as for `read_geojson`.

    Returns
    -------
    Layers
        For `RiskMap(city, population_density, layers.shelter, layers.vehicle_share)`.

    Raises
    ------
    ValueError
        If the file at `path` is broken or in metres of an unknown place; `cars_per_km` is negative, not finite, or has
        a class that is none; `lane_width` is not above 0 and finite; `crs` is not known, or can't be that of the
        coordinates; or `city` has no `reference`, or is no `City`.
    FileNotFoundError
        If there is no file at `path`.

    See Also
    --------
    uavlab.city.read_geojson : reads the buildings.
    road_layer : cars on roads from elsewhere.
    shelter_layer : shelter without a file.

    Examples
    --------
    >>> import json, pathlib, tempfile
    >>> from uavlab.city import City, Place
    >>> from uavlab.risk import CARS_BY_CLASS, osm_layers
    >>> city = City.from_buildings([], origin=(0, 0, 0), size=(40, 30, 30), reference=Place(13.377, 52.516), cell=5.0)
    >>> road = {"type": "Feature", "properties": {"highway": "primary"},
    ...         "geometry": {"type": "LineString", "coordinates": [[13.377, 52.5161], [13.378, 52.5161]]}}
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder, "roads.geojson")
    ...     _ = path.write_text(json.dumps(road))
    ...     layers = osm_layers(city, path, cars_per_km=CARS_BY_CLASS)
    >>> layers, round(float(layers.vehicle_share.max()), 4)
    (<Layers from roads.geojson: shelter and vehicle_share of 8 × 6 columns>, 0.0092)
    """
    check_plain(city, "a layer of a risk map")
    lane_width = checks.positive_number("lane_width", lane_width)
    by_class = cars_by_class(cars_per_km)
    path, notes = checks.path("path", path), Notes()
    documents = read_json(path)
    features = [feature for document in documents for feature in features_of(document, path)]
    lines, widths, cars, areas = [], [], [], []
    for number, feature in enumerate(features):
        try:
            properties, geometry = properties_of(feature), feature.get("geometry")
            if geometry is None:
                continue
            if geometry["type"] in ("LineString", "MultiLineString"):
                found = roads_of(geometry, properties, lane_width, notes)
                lines += [line for line, _ in found]
                widths += [width for _, width in found]
                cars += [by_class.get(str(properties.get("highway")), 0.0)] * len(found)
            elif kind := kind_of(properties):
                areas.append((kind, outlines_of(geometry)))
        except (AttributeError, IndexError, KeyError, OverflowError, TypeError, ValueError) as error:
            raise ValueError(f"feature {number} (counted from 0) of {path.name} is malformed: {error!r:.200}") from None
    everything = [*lines, *(ring for _, outlines in areas for outline in outlines for ring in outline)]
    shelter = np.full(city.shape[:2], SHELTER["none"])
    if not everything:
        notes.add("left out", "no road and no land with a class of shelter in the file", count=0)
        return Layers(shelter_layer(city, shelter), np.zeros(city.shape[:2]), notes.source(path.name, "GeoJSON"))
    points = np.concatenate(everything)
    bounds = np.array([*points.min(axis=0), *points.max(axis=0)])
    system = system_for(bounds, declared_system(documents, path.name), crs, path.name)
    if system is None:
        raise ValueError(
            f"{path.name} is in metres of an unknown place, which a reader has moved to the corner of the buildings: "
            "give crs='EPSG:...' here and where the city is read, or use road_layer and shelter_layer with metres of "
            "the city"
        )
    place = city.checked_reference()

    def local(ring: np.ndarray) -> np.ndarray:
        return place.east_north(system.to_lonlat(ring))

    centers = column_centers(city).reshape(-1, 2)
    columns = shapely.STRtree(shapely.points(centers))
    sheltered = shelter.reshape(-1)  # the same memory
    lands = mended_all([[[local(ring) for ring in outline] for outline in outlines] for _, outlines in areas])
    for (kind, _), (land, _) in zip(areas, lands, strict=True):
        if land is None:
            notes.add("left out", "land without area")
            continue
        notes.add("taken", f"land as {kind}")
        inside = columns.query(land, predicate="contains")
        sheltered[inside] = np.maximum(sheltered[inside], SHELTER[kind])
    share = road_layer(city, [local(line) for line in lines], widths, cars_per_km=cars, lane_width=lane_width)
    if lines:
        notes.add("assumed", f"cars per km of each lane: {told_of(cars_per_km)}", count=0)
    return Layers(shelter_layer(city, shelter), share, notes.source(path.name, "GeoJSON"))


def cars_by_class(cars_per_km: float | Mapping[str, float]) -> Mapping[str, float]:
    """Cars per kilometre of a lane, by class of road; `ValueError` if a class or a number is none."""
    if not isinstance(cars_per_km, Mapping):
        checks.not_negative_number("cars_per_km", cars_per_km)
        return dict.fromkeys(LANES, float(cars_per_km))
    for name, cars in cars_per_km.items():
        checks.one_of("cars_per_km: highway", name, LANES)
        checks.not_negative_number(f"cars_per_km of {name!r}", cars)
    return cars_per_km


def told_of(cars_per_km: float | Mapping[str, float]) -> str:
    if isinstance(cars_per_km, Mapping):
        return f"{min(cars_per_km.values(), default=0):g} to {max(cars_per_km.values(), default=0):g}, by class"
    return f"{cars_per_km:g}, on all roads"


def roads_of(
    geometry: Mapping[str, Any], properties: Mapping[str, Any], lane_width: float, notes: Notes
) -> list[tuple[np.ndarray, float]]:
    """Middle lines (M, 2) of a road, and its width [m]; none for ways without cars, in tunnels, or without length."""
    lanes = LANES.get(str(properties.get("highway")))
    if lanes is None or is_set(properties, "tunnel"):
        return []
    width = length_in_metres(properties.get("width"))
    told = length_in_metres(properties.get("lanes"))
    if width > 0:
        notes.add("taken", "road with its width")
    elif told > 0:
        width = told * lane_width
        notes.add("derived", f"width of a road from its lanes of {lane_width:g} m")
    else:
        width = lanes * lane_width
        notes.add("assumed", f"width of a road from the usual lanes of its class, of {lane_width:g} m")
    parts = geometry["coordinates"] if geometry["type"] == "MultiLineString" else [geometry["coordinates"]]
    lines = [ring_of(part) for part in parts]
    return [(line, width) for line in lines if len(np.unique(line, axis=0)) > 1]


def kind_of(properties: Mapping[str, Any]) -> str:
    """Class of shelter of a piece of land; empty where it has none."""
    kinds = [kind for (key, value), kind in SHELTERED.items() if properties.get(key) == value]
    return max(kinds, key=SHELTER.__getitem__, default="")
