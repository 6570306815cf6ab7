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
    neighbors: np.ndarray
    """(T, 3) triangles opposite of the corners."""

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
        If there is no piece, a corner is not finite, or a piece has no volume.
    """

    pieces: tuple[np.ndarray, ...]
    name: str = "building"
    color: str = "lightsteelblue"

    def __post_init__(self) -> None:
        pieces = tuple(checks.frozen(piece) for piece in self.pieces)
        if not pieces:
            raise ValueError(f"pieces of {self.name!r} is empty: give at least one array of corners")
        for piece in pieces:
            if piece.ndim != 2 or piece.shape[1] != 3:
                raise ValueError(f"pieces of {self.name!r} must have shape (M, 3), got {piece.shape}")
            if not np.isfinite(piece).all():
                raise ValueError(f"pieces of {self.name!r} have a corner that is NaN or infinite")
        object.__setattr__(self, "pieces", pieces)
        self.hulls  # noqa: B018  a piece without volume is refused now, not when it is drawn

    @classmethod
    def hull(cls, corners: npt.ArrayLike, *, name: str = "building", color: str = "lightsteelblue") -> Building:
        """The convex hull of corners (M, 3) [m]: a frustum, a spire, any convex body, on the ground or above it."""
        return cls((np.asarray(corners, dtype=float),), name, color)

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

        Raises
        ------
        ValueError
            If the footprint is no simple convex polygon, `eaves` is not above `bottom`, or `ridge` hasn't shape (R, 3).
        """
        if not eaves > bottom:
            raise ValueError(f"eaves of {name!r} must be above its bottom ({bottom:g} m), got {eaves:g} m")
        points = np.atleast_2d(np.asarray(ridge, dtype=float))
        if points.ndim != 2 or points.shape[1] != 3:
            raise ValueError(f"ridge of {name!r} must have shape (R, 3), got {np.shape(ridge)}")
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

        Raises
        ------
        ValueError
            If the outline crosses itself or has fewer than three corners, or `top` is not above `bottom`.
        """
        if not top > bottom:
            raise ValueError(f"top of {name!r} must be above its bottom ({bottom:g} m), got {top:g} m")
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
        return tuple(
            Hull(piece, h.simplices, h.equations, h.neighbors) for piece, h in zip(self.pieces, found, strict=True)
        )

    @cached_property
    def bounds(self) -> np.ndarray:
        """Lowest and highest corner of the bounding box, (2, 3) [m]."""
        corners = np.vstack(self.pieces)
        return np.array([corners.min(axis=0), corners.max(axis=0)])

    def contains(self, points: npt.ArrayLike) -> np.ndarray:
        """Whether each of the points (..., 3) [m] lies inside or on the surface, (...) bool."""
        points = np.asarray(points, dtype=float)
        inside = np.zeros(points.shape[:-1], dtype=bool)
        for hull in self.hulls:
            normals, offsets = hull.equations[:, :3], hull.equations[:, 3]
            inside |= (points @ normals.T + offsets <= FACE_TOLERANCE).all(axis=-1)
        return inside

    def triangles(self) -> np.ndarray:
        """Surface triangles of all pieces, (T, 3 corners, 3) [m], seen counter-clockwise from outside."""
        surfaces = []
        for hull in self.hulls:
            corners = hull.triangles
            normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            inward = np.einsum("ij,ij->i", normals, hull.equations[:, :3]) < 0
            corners[inward] = corners[inward][:, ::-1]
            surfaces.append(corners)
        return np.concatenate(surfaces)

    def edges(self) -> np.ndarray:
        """Ends (2E, 3) [m] of the edges of all pieces, two rows an edge, for drawing."""
        return np.concatenate([crease_edges(hull) for hull in self.hulls])


def crease_edges(hull: Hull) -> np.ndarray:
    """Ends (2E, 3) of the edges between faces of a convex hull that don't lie in one plane."""
    across = hull.neighbors  # [f, c]: the face across the edge of f that lies opposite of its corner c
    creased = ~np.isclose(hull.equations[:, None], hull.equations[across], atol=1e-6).all(axis=-1)
    face, corner = np.nonzero(creased & (np.arange(len(across))[:, None] < across))
    ends = hull.simplices[face[:, None], (corner[:, None] + [1, 2]) % 3]
    return hull.points[ends].reshape(-1, 3)


def footprint_polygon(outline: npt.ArrayLike, holes: Sequence[npt.ArrayLike], name: str) -> shapely.Polygon:
    """A checked polygon; `ValueError` says where an outline crosses itself."""
    shell, *inner = (
        checked_ring(ring, f"{part} of {name!r}")
        for ring, part in [(outline, "footprint"), *((hole, "a hole in the footprint") for hole in holes)]
    )
    polygon = shapely.Polygon(shell, inner)
    if not polygon.is_valid:
        raise ValueError(
            f"footprint of {name!r} is not a simple polygon: {shapely.is_valid_reason(polygon)}; "
            "repair the outline so that it doesn't cross or touch itself"
        )
    return polygon


def checked_ring(ring: npt.ArrayLike, what: str) -> np.ndarray:
    """Corners (M, 2) of an outline or a hole."""
    corners = np.asarray(ring, dtype=float)
    if corners.ndim != 2 or corners.shape[1] < 2 or len(np.unique(corners[:, :2], axis=0)) < 3:
        raise ValueError(f"{what} needs at least three different corners (x, y)")
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
