"""No-fly zones from GeoJSON files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import shapely

from uavlab import checks
from uavlab.city.documents import read_json
from uavlab.city.footprints import Footprint, declared_system, features_of, footprints_of
from uavlab.city.lengths import length_in_metres
from uavlab.city.model import City
from uavlab.city.place import LOCAL, system_for
from uavlab.city.source import Notes
from uavlab.city.zones import NoFlyZone


def read_no_fly(
    path: str | Path,
    city: City,
    *,
    lower: str | float = "lower",
    upper: str | float = "upper",
    crs: Any = None,
) -> tuple[NoFlyZone, ...]:
    """No-fly zones from the polygons of a GeoJSON file, for `dataclasses.replace(city, no_fly=...)`.

    A point, a line or what else has no area gives no zone, which a warning says.

    Parameters
    ----------
    path : str or Path
        UTF-8 text, as for `read_geojson`.
    city : City
        On whose map they lie.
    lower, upper : str or float
        Properties that hold the limits above ground, a number of metres or a text like "400 ft", or one for all [m];
        where they are absent, 0 and no upper limit.
    crs : anything that pyproj takes, or "local", optional
        The reference system of the coordinates, as for `read_geojson`; "local": the city's own metres,
        as where neither file nor city knows where on Earth it lies.

    Returns
    -------
    tuple of NoFlyZone
        One for each polygon.

    Raises
    ------
    ValueError
        If the file at `path` is broken or has no polygon; `lower` or `upper` is neither a text nor a number, or names a
        property that no zone has; the height that a zone has there can't be understood, or is out of the range of
        `NoFlyZone`; `crs` is no system that pyproj knows; or `city` is no `City`, or has no `reference` though the
        zones lie on Earth.
    FileNotFoundError
        If there is no file at `path`.

    Warns
    -----
    UserWarning
        If a feature has no area.

    See Also
    --------
    NoFlyZone : one made by hand.
    read_geojson : reads buildings from such a file.

    Examples
    --------
    >>> import json, pathlib, tempfile
    >>> from uavlab.city import read_no_fly, table1_city
    >>> field = {"type": "Polygon", "coordinates": [[[0, 0], [30, 0], [30, 20], [0, 20], [0, 0]]]}
    >>> zone = {"type": "Feature", "properties": {"name": "airfield", "upper": "400 ft"}, "geometry": field}
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder, "zones.geojson")
    ...     _ = path.write_text(json.dumps(zone))
    ...     zones = read_no_fly(path, table1_city(cell=5.0), crs="local")
    >>> zones
    (<NoFlyZone airfield: 4 corners, 0 to 121.92 m above ground>,)
    """
    checks.instance("city", city, City)
    for bound, limit in (("lower", lower), ("upper", upper)):
        if not isinstance(limit, str | int | float | np.integer | np.floating):
            raise ValueError(f"{bound} must be the name of a property, or a height in metres, got {limit!r:.60}")
    path, notes = checks.path("path", path), Notes()
    documents = read_json(path)
    features = [feature for document in documents for feature in features_of(document, path)]
    zones = footprints_of(features, notes, lambda properties: True)
    if not zones:
        raise ValueError(f"{path.name} has no polygon with an area, so no zone")
    for bound, limit in (("lower", lower), ("upper", upper)):
        check_limit(bound, limit, zones, path)
    bounds = shapely.total_bounds([zone.polygons for zone in zones])
    declared = declared_system(documents, path.name)
    if declared is None and crs is None and city.reference is None:
        crs = LOCAL  # neither knows where on Earth it lies
    system = system_for(bounds, declared, crs, path.name)
    polygons = np.array([zone.polygons for zone in zones], dtype=object)
    if system is not None:
        local = city.checked_reference().east_north(system.to_lonlat(shapely.get_coordinates(polygons)))
        polygons = shapely.set_coordinates(polygons, local)
    found = []
    for zone, plan in zip(zones, polygons, strict=True):
        low, high = limit_of(zone, lower, 0.0), limit_of(zone, upper, np.inf)
        for polygon in plan.geoms:
            holes = tuple(shapely.get_coordinates(ring) for ring in polygon.interiors)
            found.append(NoFlyZone(shapely.get_coordinates(polygon.exterior), low, high, holes, zone.name))
    notes.source(path.name, "GeoJSON").warn("They close nothing: draw an outline around each")
    return tuple(found)


def check_limit(bound: str, limit: str | float, zones: Sequence[Footprint], path: Path) -> None:
    """Refuse a property that the caller names and no zone has: it is misspelt, and all would take the usual limit."""
    known = sorted({key for zone in zones for key in zone.properties})
    if isinstance(limit, str) and limit != bound and limit not in known:
        raise ValueError(
            f"{bound}={limit!r} is no property of any zone in {path.name}, which have {known!r:.300}: name one of "
            "them, or give a height for all"
        )


def limit_of(zone: Footprint, limit: str | float, otherwise: float) -> float:
    """A limit of a zone [m]; `ValueError` where it stands there and can't be understood."""
    if not isinstance(limit, str):
        return float(limit)
    value = zone.properties.get(limit)
    if value in (None, ""):
        return otherwise
    metres = length_in_metres(value)
    if np.isnan(metres):
        raise ValueError(
            f"{limit} of {zone.label!r} must be a height in metres, such as 120 or '400 ft', got {value!r}"
        )
    return metres
