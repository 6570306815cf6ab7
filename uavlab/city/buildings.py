"""Buildings as unions of convex pieces.

A convex piece is the hull of its corners: a box, a prism, a tower with a pointed roof, a frustum. Whether a point
lies inside is one matrix product, its faces are what a scene draws, and anything that is not convex (an L, a
courtyard) is a union of pieces. Footprints of any shape are cut into triangles.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import shapely

from uavlab import checks
from uavlab.city.surface import outer_surface

FACE_TOLERANCE = 1e-9
"""How far outside a face [m] a point still counts as inside: rounding, not thickness."""

THINNEST = 1e-4
"""Twice the area of a polygon by half of its length [m]: what is thinner is rounding, and spans no volume."""


class Hull(NamedTuple):
    """The surface of a convex piece, as Qhull gives it."""

    points: np.ndarray
    """(M, 3) corners [m]."""
    simplices: np.ndarray
    """(T, 3) of them for each triangle."""
    equations: np.ndarray
    """(T, 4) a, b, c, d of each triangle's plane: a·x + b·y + c·z + d is how far a point lies outside [m]."""

    @property
    def triangles(self) -> np.ndarray:
        """(T, 3 corners, 3) [m]"""
        return self.points[self.simplices]


@dataclass(frozen=True, eq=False)
class Building:
    """A solid: the union of convex pieces.

    Attributes
    ----------
    pieces : tuple of (M, 3) arrays
        Corners of each convex piece [m]; at least four, not all in one plane.
    name : str
        What messages and legends call it.
    color : str
        Any matplotlib colour.

    Raises
    ------
    ValueError
        If `pieces` is no list of arrays, or empty; one of them hasn't shape (M, 3), has a corner that is not finite, or
        has no volume; or `name` or `color` is no text.

    See Also
    --------
    City.from_buildings : rasterises buildings.
    table1_buildings : the five buildings of REPARE.

    Examples
    --------
    >>> from uavlab.city import Building
    >>> house = Building.roofed([(0, 0), (8, 0), (8, 6), (0, 6)], 5, [(0, 3, 8), (8, 3, 8)], name="house")
    >>> house
    <Building house: 1 convex piece, 8 × 6 m, z from 0 to 8 m>
    >>> tower = Building.prism([(0, 6), (3, 6), (3, 9), (0, 9)], 20)
    >>> Building(house.pieces + tower.pieces, name="church")
    <Building church: 2 convex pieces, 8 × 9 m, z from 0 to 20 m>
    """

    pieces: tuple[np.ndarray, ...]
    name: str = "building"
    color: str = "lightsteelblue"

    def __post_init__(self) -> None:
        checks.text("name", self.name)
        checks.text("color", self.color)
        pieces = tuple(
            checks.frozen(checks.array(f"pieces[{number}] of {self.name!r}", piece, None, 3))
            for number, piece in enumerate(checks.listed("pieces", self.pieces, "arrays of corners (M, 3)"))
        )
        if not pieces:
            raise ValueError(f"pieces of {self.name!r} is empty: give at least one array of corners")
        object.__setattr__(self, "pieces", pieces)
        self.hulls  # noqa: B018  a piece without volume is refused now, not when it is drawn

    def __repr__(self) -> str:
        pieces = f"{len(self.pieces)} convex piece{'s' if len(self.pieces) > 1 else ''}"
        (west, south, bottom), (east, north, top) = np.round(self.bounds, 2)
        width, depth = east - west, north - south
        return f"<Building {self.name}: {pieces}, {width:g} × {depth:g} m, z from {bottom:g} to {top:g} m>"

    @classmethod
    def hull(cls, corners: npt.ArrayLike, *, name: str = "building", color: str = "lightsteelblue") -> Building:
        """The convex hull of corners: a frustum, a spire, any convex body, on the ground or above it.

        Parameters
        ----------
        corners : (M, 3) array
            [m]; at least four, not all in one plane.
        name, color : str
            As for `Building`.

        Returns
        -------
        Building
            Of one piece.

        Raises
        ------
        ValueError
            If `corners` hasn't shape (M, 3), is not finite, or spans no volume, or `name` or `color` is no text.

        See Also
        --------
        Building.roofed : walls with a roof.
        Building.prism : a footprint of any shape.

        Examples
        --------
        >>> from uavlab.city import Building
        >>> pyramid = Building.hull([(0, 0, 0), (10, 0, 0), (10, 10, 0), (0, 10, 0), (5, 5, 12)], name="pyramid")
        >>> pyramid
        <Building pyramid: 1 convex piece, 10 × 10 m, z from 0 to 12 m>
        >>> pyramid.contains([[5, 5, 9], [1, 1, 9]]).tolist()
        [True, False]
        """
        return cls((checks.array("corners", corners, None, 3),), name, color)

    @classmethod
    def roofed(
        cls,
        footprint: npt.ArrayLike,
        eaves: float,
        ridge: npt.ArrayLike,
        *,
        bottom: float = 0.0,
        name: str = "building",
        color: str = "lightsteelblue",
    ) -> Building:
        """Walls over a convex footprint (M, 2) from `bottom` to `eaves` [m], and a roof up to the ridge points (R, 3).

        One ridge point makes a spire, two a gable or hip roof, a smaller polygon a frustum.

        Parameters
        ----------
        footprint : (M, 2) array
            Convex outline [m], either way round, closed or not.
        eaves, bottom : float
            Heights of the walls' upper and lower end [m].
        ridge : (R, 3) array, or one point (3,)
            Corners of the roof [m]; only what lies above the eaves shows.
        name, color : str
            As for `Building`.

        Returns
        -------
        Building
            Of one piece, the hull of walls and ridge.

        Raises
        ------
        ValueError
            If `footprint` is no simple convex polygon of shape (M, 2), `eaves` is not above `bottom`, one of them is
            not finite, `ridge` hasn't shape (R, 3) or is not finite, or `name` or `color` is no text.

        See Also
        --------
        Building.prism : with a flat roof, over a footprint of any shape.
        Building.hull : any convex body.

        Examples
        --------
        A gable roof: in the middle it reaches 8 m, at the walls 5 m.

        >>> from uavlab.city import Building
        >>> house = Building.roofed([(0, 0), (8, 0), (8, 6), (0, 6)], 5, [(0, 3, 8), (8, 3, 8)])
        >>> house.contains([[4, 3, 7.5], [4, 0.5, 7.5]]).tolist()
        [True, False]
        """
        bottom, eaves = checked_ends(bottom, "eaves", eaves, name)
        points = np.atleast_2d(checks.numbers("ridge", ridge))
        if points.ndim != 2 or points.shape[1] != 3 or not len(points):
            raise ValueError(f"ridge of {name!r} must have shape (R, 3), got {np.shape(ridge)}")
        checks.finite("ridge", points)
        polygon = footprint_polygon(footprint, (), name)
        if not is_convex(polygon):
            raise ValueError(f"footprint of {name!r} must be convex under a roof: join several convex pieces instead")
        walls = extrude(shapely.get_coordinates(polygon)[:-1], bottom, eaves)
        return cls.hull(np.vstack([walls, points]), name=name, color=color)

    @classmethod
    def prism(
        cls,
        footprint: npt.ArrayLike,
        top: float,
        *,
        bottom: float = 0.0,
        holes: Sequence[npt.ArrayLike] = (),
        name: str = "building",
        color: str = "lightsteelblue",
    ) -> Building:
        """A footprint of any shape, with or without courtyards, between two heights.

        Parameters
        ----------
        footprint : array (M, 2)
            Outline [m], either way round, closed or not.
        top, bottom : float
            Heights of roof and floor [m]; a floor above 0 makes a floating building.
        holes : sequence of (H, 2) arrays
            Courtyards [m].
        name, color : str
            As for `Building`.

        Returns
        -------
        Building
            Of one piece over a convex footprint, else of one for each triangle that the footprint is cut into.

        Raises
        ------
        ValueError
            If `footprint` or one of `holes` hasn't shape (M, 2), has fewer than three different corners or one that is
            not finite; they cross; `top` is not above `bottom`, or one of them is not finite; or `name` or `color` is
            no text.

        See Also
        --------
        Building.roofed : with a pointed roof, over a convex footprint.
        City.from_buildings : rasterises buildings.

        Examples
        --------
        >>> from uavlab.city import Building
        >>> block = [(0, 0), (30, 0), (30, 20), (0, 20)]
        >>> courtyard = [(10, 5), (20, 5), (20, 15), (10, 15)]
        >>> Building.prism(block, 12, holes=[courtyard]).contains([[5, 5, 6], [15, 10, 6]]).tolist()
        [True, False]
        """
        bottom, top = checked_ends(bottom, "top", top, name)
        polygon = footprint_polygon(footprint, holes, name)
        return cls(tuple(extrude(part, bottom, top) for part in convex_parts(polygon)), name, color)

    @cached_property
    def hulls(self) -> tuple[Hull, ...]:
        """The surface of each piece."""
        from scipy.spatial import ConvexHull, QhullError

        try:
            found = [ConvexHull(piece) for piece in self.pieces]
        except (QhullError, ValueError):
            raise ValueError(
                f"pieces of {self.name!r} must each span a volume: at least four corners, not all in one plane"
            ) from None
        return tuple(Hull(piece, h.simplices, h.equations) for piece, h in zip(self.pieces, found, strict=True))

    @cached_property
    def bounds(self) -> np.ndarray:
        """Lowest and highest corner of the bounding box, (2, 3) [m]."""
        corners = np.vstack(self.pieces)
        return np.array([corners.min(axis=0), corners.max(axis=0)])

    def contains(self, points: npt.ArrayLike) -> np.ndarray:
        """Whether points lie inside or on the surface: behind all faces of a piece, n·p + d ≤ 0.

        Parameters
        ----------
        points : (..., 3) array
            [m]

        Returns
        -------
        (...) bool array

        Raises
        ------
        ValueError
            If `points` hasn't shape (..., 3) or is not finite.

        See Also
        --------
        City.is_free : asks the voxels instead.

        Examples
        --------
        >>> from uavlab.city import Building
        >>> box = Building.prism([(0, 0), (4, 0), (4, 4), (0, 4)], 10)
        >>> box.contains([[2, 2, 5], [2, 2, 10], [2, 2, 10.1]]).tolist()
        [True, True, False]
        """
        points = checks.array("points", points, ..., 3)
        inside = np.zeros(points.shape[:-1], dtype=bool)
        for hull in self.hulls:
            normals, offsets = hull.equations[:, :3], hull.equations[:, 3]
            inside |= (points @ normals.T + offsets <= FACE_TOLERANCE).all(axis=-1)
        return inside

    def triangles(self) -> np.ndarray:
        """The surface as triangles, (T, 3 corners, 3) [m], seen counter-clockwise from outside, to be drawn.

        Facets that two pieces share are left out.
        """
        return self.surface[0]

    def edges(self) -> np.ndarray:
        """Ends (2E, 3) [m] of the surface's edges, two rows an edge, to be drawn."""
        return self.surface[1]

    @cached_property
    def surface(self) -> tuple[np.ndarray, np.ndarray]:
        """Triangles and edges."""
        triangles, edges = outer_surface(self.hulls)
        return checks.frozen(triangles), checks.frozen(edges)


def checked_ends(bottom: float, what: str, upper: float, name: str) -> tuple[float, float]:
    """Heights of the lower and the upper end of walls [m]."""
    bottom, upper = checks.number("bottom", bottom), checks.number(what, upper)
    if not upper > bottom:
        raise ValueError(f"{what} of {name!r} must be above its bottom ({bottom:g} m), got {upper:g} m")
    checks.finite("bottom", bottom)
    checks.finite(what, upper)
    return bottom, upper


def footprint_polygon(
    outline: npt.ArrayLike, holes: Sequence[npt.ArrayLike], name: str, argument: str = "footprint"
) -> shapely.Polygon:
    """A checked polygon; `ValueError` says where an outline crosses itself."""
    checks.text("name", name)
    holes = checks.listed("holes", holes, "outlines (H, 2)")
    shell = checked_ring(outline, f"{argument} of {name!r}")
    inner = [checked_ring(hole, f"holes[{n}], a hole in the {argument} of {name!r},") for n, hole in enumerate(holes)]
    polygon = shapely.Polygon(shell, inner)
    if not polygon.is_valid:
        raise ValueError(
            f"{argument} of {name!r} is not a simple polygon: {shapely.is_valid_reason(polygon)}; "
            f"repair the outline{' and its holes' * bool(inner)} so that it doesn't cross or touch itself"
        )
    return polygon


def checked_ring(ring: npt.ArrayLike, what: str) -> np.ndarray:
    """Corners (M, 2) of an outline or a hole."""
    corners = checks.numbers(what, ring)
    plane = corners.ndim == 2 and corners.shape[1] in (2, 3)  # heights of corners are left out
    if not plane or len(np.unique(corners[:, :2], axis=0)) < 3:
        raise ValueError(f"{what} needs at least three different corners (x, y), got an array of shape {corners.shape}")
    if not np.isfinite(corners).all():
        raise ValueError(f"{what} has a corner that is NaN or infinite")
    return corners[:, :2]


def is_convex(polygon: shapely.Polygon) -> bool:
    return not polygon.interiors and polygon.convex_hull.area - polygon.area <= 1e-9 * polygon.area


def convex_parts(polygon: shapely.Polygon) -> list[np.ndarray]:
    """The polygon itself if it is convex, else triangles that cover it; each as corners (M, 2).

    Only what is narrower than a tenth of a millimetre is dropped: rounding, which spans no volume.
    """
    corners = shapely.get_coordinates(polygon)
    if len(corners) == 4 or is_convex(polygon):
        return [corners[:-1]]
    triangles = shapely.constrained_delaunay_triangles(polygon).geoms
    return [shapely.get_coordinates(each)[:3] for each in triangles if 2 * each.area > THINNEST * each.length / 2]


def polygons_in(geometry: shapely.Geometry) -> list[shapely.Polygon]:
    """The polygons of a geometry that have an area, without the lines and points that a repair may leave."""
    if geometry.geom_type == "Polygon":
        return [geometry] if geometry.area > 0 else []
    parts: Iterable[shapely.Geometry] = shapely.get_parts(shapely.get_parts(geometry))
    return [part for part in parts if part.geom_type == "Polygon" and part.area > 0]


def extrude(outline: np.ndarray, bottom: float, top: float) -> np.ndarray:
    """Corners (2M, 3) of the prism over a convex outline (M, 2)."""
    return np.vstack([np.column_stack([outline, np.full(len(outline), z)]) for z in (bottom, top)])
