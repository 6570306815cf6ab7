"""No-fly zones: closed for planners, but nothing that one could hit."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely

from uavlab import checks
from uavlab.city.buildings import convex_parts, extrude, footprint_polygon


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
        If the outline crosses itself or has fewer than three corners, or `upper` is not above `lower`.
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

    @cached_property
    def polygon(self) -> shapely.Polygon:
        """In plan [m]."""
        return shapely.Polygon(self.outline, self.holes)

    def pieces(self, low: float, high: float) -> list[np.ndarray]:
        """Corners (2M, 3) of convex prisms [m] that make it up between two heights."""
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
