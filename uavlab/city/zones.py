"""No-fly zones: closed for planners, but nothing that one could hit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

from uavlab import checks
from uavlab.city.buildings import convex_parts, extrude, footprint_polygon
from uavlab.city.documents import read_json
from uavlab.city.footprints import Footprint, declared_system, features_of, footprints_of
from uavlab.city.lengths import length_in_metres
from uavlab.city.place import LOCAL, system_for
from uavlab.city.source import Notes

if TYPE_CHECKING:
    from uavlab.city.model import City


@dataclass(frozen=True, eq=False)
class NoFlyZone:
    """A polygon between two heights that planners stay out of; flights and clearance don't know it.

    It is a prism: from `lower` above the lowest ground below it to `upper` above the highest, so that on a slope it
    closes rather more than less.

    Attributes
    ----------
    outline : (M, 2) array
        Corners [m], either way round, closed or not.
    lower, upper : float
        Heights above ground [m], `upper` above `lower`, may be infinite.
    holes : sequence of (H, 2) arrays
        Where one may fly inside of the outline [m].
    name : str
        What messages and legends call it.

    Raises
    ------
    ValueError
        If `outline` or one of `holes` has fewer than three different corners or one that is not finite, they cross,
        `lower` is not finite, or `upper` is not above `lower`.

    See Also
    --------
    read_no_fly : reads zones from a file.
    City.blocked : where a UAV may not be.

    Examples
    --------
    >>> import dataclasses
    >>> from uavlab.city import NoFlyZone, table1_city
    >>> school = NoFlyZone([(0, 0), (20, 0), (20, 10), (0, 10)], upper=50.0, name="school")
    >>> school
    <NoFlyZone school: 4 corners, 0 to 50 m above ground>
    >>> city = dataclasses.replace(table1_city(cell=5.0), no_fly=[school])
    >>> city.zone_at((10, 5, 20)), bool(city.is_free((10, 5, 20)))
    ('school', True)
    """

    outline: np.ndarray
    lower: float = 0.0
    upper: float = np.inf
    holes: tuple[np.ndarray, ...] = ()
    name: str = "no-fly zone"

    def __post_init__(self) -> None:
        for bound in ("lower", "upper"):
            checks.number(bound, getattr(self, bound))
        if not (np.isfinite(self.lower) and self.upper > self.lower):
            raise ValueError(f"upper of {self.name!r} must be above its lower ({self.lower:g} m), got {self.upper:g} m")
        polygon = footprint_polygon(self.outline, self.holes, self.name)
        object.__setattr__(self, "outline", shapely.get_coordinates(polygon.exterior)[:-1])
        object.__setattr__(self, "holes", tuple(shapely.get_coordinates(ring)[:-1] for ring in polygon.interiors))
        for corners in (self.outline, *self.holes):
            corners.setflags(write=False)

    def __repr__(self) -> str:
        corners = sum(map(len, (self.outline, *self.holes)))
        heights = f"{self.lower:g} m and up" if self.upper == np.inf else f"{self.lower:g} to {self.upper:g} m"
        return f"<NoFlyZone {self.name}: {corners} corners, {heights} above ground>"

    @cached_property
    def polygon(self) -> shapely.Polygon:
        """In plan [m]."""
        return shapely.Polygon(self.outline, self.holes)

    def pieces(self, low: float, high: float) -> list[np.ndarray]:
        """Convex prisms that make it up between two heights of the map; its own `lower` and `upper` aren't asked.

        Parameters
        ----------
        low, high : float
            Heights z of their lower and upper end [m].

        Returns
        -------
        list of (2M, 3) arrays
            Corners of each [m].

        See Also
        --------
        City.zone_building : the zone as a body on a map, at its own heights above ground.

        Examples
        --------
        >>> from uavlab.city import NoFlyZone
        >>> lot = NoFlyZone([(0, 0), (20, 0), (20, 10), (10, 10), (10, 20), (0, 20)])
        >>> pieces = lot.pieces(0, 50)
        >>> len(pieces), pieces[0].shape
        (4, (6, 3))
        """
        return [extrude(part, low, high) for part in convex_parts(self.polygon)]


def checked_zones(no_fly: object) -> tuple[NoFlyZone, ...]:
    """No-fly zones as a tuple; one zone, or outlines (M, 2), are taken as well."""
    if isinstance(no_fly, NoFlyZone):
        return (no_fly,)
    if not isinstance(no_fly, Sequence):
        raise ValueError(f"no_fly must be a list of NoFlyZone, got {type(no_fly).__name__}")
    for number, zone in enumerate(no_fly):
        checks.instance(f"no_fly[{number}]", zone, NoFlyZone)
    return tuple(no_fly)


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
        If the file at `path` is broken or has no polygon; `lower` or `upper` is neither a text nor a number, the height
        that a zone has there can't be understood, or is out of the range of `NoFlyZone`; `crs` is no system that pyproj
        knows; or `city` has no `reference` though the zones lie on Earth.
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
    for bound, limit in (("lower", lower), ("upper", upper)):
        if not isinstance(limit, str | int | float | np.integer | np.floating):
            raise ValueError(f"{bound} must be the name of a property, or a height in metres, got {limit!r:.60}")
    path, notes = Path(path), Notes()
    documents = read_json(path)
    features = [feature for document in documents for feature in features_of(document, path)]
    zones = footprints_of(features, notes, lambda properties: True)
    if not zones:
        raise ValueError(f"{path.name} has no polygon with an area, so no zone")
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
