"""No-fly zones: closed for planners, but nothing that one could hit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely

from uavlab import checks
from uavlab.city.buildings import Building, convex_parts, extrude, footprint_polygon
from uavlab.city.rasterise import touches


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
        If `outline` or one of `holes` hasn't shape (M, 2), has fewer than three different corners or one that is not
        finite; they cross; `lower` is not finite, or `upper` not above it; or `name` is no text.

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
        checks.set_fields(self, checks.number, "lower", "upper")
        if not (np.isfinite(self.lower) and self.upper > self.lower):
            raise ValueError(f"upper of {self.name!r} must be above its lower ({self.lower:g} m), got {self.upper:g} m")
        polygon = footprint_polygon(self.outline, self.holes, self.name, "outline")
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

        Raises
        ------
        ValueError
            If `high` is not above `low`, or one of them is not finite.

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
        low, high = checks.number("low", low, checks.finite), checks.number("high", high, checks.finite)
        if not high > low:
            raise ValueError(f"high must be above low ({low:g} m), got {high:g} m")
        return [extrude(part, low, high) for part in convex_parts(self.polygon)]


def body_of(
    zone: NoFlyZone, ground: tuple[np.ndarray, np.ndarray], bounds: np.ndarray, shape: Sequence[int], cell: float
) -> Building:
    """A zone as a body on a map with these bounds (2, 3) [m], where the ground has these lowest and highest points."""
    (low, high), column = bounds[:, 2], np.zeros(tuple(shape[:2]), dtype=bool)
    for piece in zone.pieces(low, high):
        column |= touches(Building((piece,)), shape, cell, bounds[0])
    lowest, highest = ground
    if column.any():
        low, high = (
            np.clip(zone.lower + lowest[column].min(), low, high - 1e-3),
            np.clip(zone.upper + highest[column].max(), low + 1e-3, high),
        )
    return Building(tuple(zone.pieces(low, max(high, low + 1e-3))), zone.name)


def checked_zones(no_fly: object) -> tuple[NoFlyZone, ...]:
    """No-fly zones as a tuple; one zone is taken as well."""
    zones = [no_fly] if isinstance(no_fly, NoFlyZone) else no_fly
    return tuple(checks.several("no_fly", zones, NoFlyZone, least=0))
