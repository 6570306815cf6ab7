"""Layers from OpenStreetMap's properties: cars on its roads, shelter under its woods and roofs.

What a map of the world says of roads and land is turned into what the papers ask for, by tables that stand here. They
are assumptions, and are said: the papers give one number of cars for all roads, and five classes of shelter.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import shapely

from uavlab import checks
from uavlab.city import City
from uavlab.city.documents import read_json
from uavlab.city.footprints import declared_system, features_of, outlines_of
from uavlab.city.lengths import length_in_metres
from uavlab.city.place import system_for
from uavlab.city.source import Notes, Source
from uavlab.risk.layers import column_centers, road_layer, shelter_layer
from uavlab.risk.rates import CARS_PER_KM, LANE_WIDTH, SHELTER

LANES = {
    "motorway": 4, "trunk": 4, "primary": 2, "secondary": 2, "tertiary": 2, "unclassified": 2, "residential": 2,
    "living_street": 1, "service": 1, "motorway_link": 1, "trunk_link": 1, "primary_link": 1, "secondary_link": 1,
    "tertiary_link": 1,
}  # fmt: skip
"""Lanes of a road that doesn't say, by `highway`; other ways have no cars."""

SHELTERED = {
    ("natural", "wood"): "trees or low buildings", ("landuse", "forest"): "trees or low buildings",
    ("natural", "scrub"): "sparse trees", ("natural", "tree_row"): "sparse trees",
    ("landuse", "orchard"): "sparse trees", ("leisure", "park"): "sparse trees", ("leisure", "garden"): "sparse trees",
    ("landuse", "cemetery"): "sparse trees", ("landuse", "residential"): "sparse trees",
    ("landuse", "industrial"): "industry",
}  # fmt: skip
"""Class of PSO-BAS Table 1 for land, the greater where several lie over each other."""


class Layers(NamedTuple):
    """What a file says of the ground, for `RiskMap`."""

    shelter: np.ndarray
    """(nx, ny) p_s."""
    vehicle_share: np.ndarray
    """(nx, ny) share of the ground under cars."""
    source: Source
    """What was taken and assumed."""


def osm_layers(
    city: City, path: str | Path, *, cars_per_km: float = CARS_PER_KM, lane_width: float = LANE_WIDTH, crs: Any = None
) -> Layers:
    """Roads and shelter from a GeoJSON file with OpenStreetMap's properties, such as the one that the city came from.

    Parameters
    ----------
    city : City
    path : str or Path
    cars_per_km : float
        K, cars per kilometre of a lane, the same on all roads: the papers' 0.1, a road at night; 10 is a busy one.
    lane_width : float
        D_road [m], of roads that tell their lanes or nothing.
    crs : anything that pyproj takes, or "local", optional
        The reference system of the coordinates, as for `read_geojson`.

    Returns
    -------
    Layers
        For `RiskMap(city, population_density, layers.shelter, layers.vehicle_share)`.

    Raises
    ------
    ValueError
        If the file is broken, or the city doesn't know where on Earth it lies.
    """
    checks.instance("city", city, City)
    checks.positive_number("lane_width", lane_width)
    path, notes = Path(path), Notes()
    documents = read_json(path)
    features = [feature for document in documents for feature in features_of(document, path)]
    lines, widths, areas = [], [], []
    for number, feature in enumerate(features):
        try:
            properties, geometry = feature.get("properties") or {}, feature.get("geometry")
            if geometry is None:
                continue
            if geometry["type"] in ("LineString", "MultiLineString"):
                found = roads_of(geometry, properties, lane_width, notes)
                lines += [line for line, _ in found]
                widths += [width for _, width in found]
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
    system = system_for(bounds, declared_system(documents[0]), crs, path.name)

    def local(ring: np.ndarray) -> np.ndarray:
        return ring if system is None else city.checked_reference().east_north(system.to_lonlat(ring))

    at = column_centers(city)
    for kind, outlines in areas:
        notes.add("taken", f"land as {kind}")
        for shell, *holes in outlines:
            polygon = shapely.make_valid(shapely.Polygon(local(shell), [local(hole) for hole in holes]))
            inside = shapely.contains_xy(polygon, at[..., 0], at[..., 1])
            shelter[inside] = np.maximum(shelter[inside], SHELTER[kind])
    share = road_layer(city, [local(line) for line in lines], widths, cars_per_km=cars_per_km, lane_width=lane_width)
    if lines:
        notes.add("assumed", f"{cars_per_km:g} cars per km of each lane, on all roads", count=0)
    return Layers(shelter_layer(city, shelter), share, notes.source(path.name, "GeoJSON"))


def roads_of(
    geometry: Mapping[str, Any], properties: Mapping[str, Any], lane_width: float, notes: Notes
) -> list[tuple[np.ndarray, float]]:
    """Middle lines (M, 2) of a road, and its width [m]; none for ways without cars, in tunnels, or without length."""
    lanes = LANES.get(str(properties.get("highway")))
    if lanes is None or str(properties.get("tunnel", "no")) != "no":
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
    lines = [np.array([(x, y) for x, y, *_ in part], float).reshape(-1, 2) for part in parts]
    return [(line, width) for line in lines if len(np.unique(line, axis=0)) > 1]


def kind_of(properties: Mapping[str, Any]) -> str:
    """Class of shelter of a piece of land; empty where it has none."""
    kinds = [kind for (key, value), kind in SHELTERED.items() if properties.get(key) == value]
    return max(kinds, key=SHELTER.__getitem__, default="")
