"""The ground: a surface of triangles, from a relief, a raster of heights, or the feet of buildings.

A raster is a surface, too: the centres of its pixels, joined by triangles. So one rule says how high the ground is at a
place, and how high at most in a column of voxels, whatever it came from. Where a surface ends the ground may go on
as far as is known (linear in gaps, nearest beyond), or the map is refused there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.city.columns import share_out
from uavlab.city.numbering import whole_numbers
from uavlab.city.place import LOCAL, Place, System, check_fits, place_of, system_of
from uavlab.city.rasterise import range_of_ground, ranges_of
from uavlab.city.triangles import heights_of, rims_of, triangulated

LOWEST, HIGHEST = -500.0, 9000.0
"""No ground on Earth is lower or higher [m]: such a number stands for "no data"."""

BEYOND = ("refuse", "nearest")

COVERED = 1 - 1e-6
"""Share of a column from which on a surface covers it: the rest is rounding of coordinates."""

FINEST = 0.01
"""Pixels that are smaller [m] are ones in degrees."""

MOST_PIXELS = 25_000_000
"""A raster with more is refused: as a surface it would need more than 7 GB."""


@dataclass(frozen=True, eq=False)
class Terrain:
    """A surface of triangles.

    Attributes
    ----------
    points : (N, 3) float array
        Corners; those of no triangle count only in gaps. In metres of the city, or in the system and its units.
    triangles : (T, 3) int array
        Points of each triangle.
    system : System, or None
        Of the points; None: the city's own metres.
    beyond : {"refuse", "nearest"}
        Whether the ground goes on where no triangle is: linear between the points in gaps, beyond them as at the
        nearest.

    Raises
    ------
    ValueError
        If `points` hasn't shape (N, 3), is not finite, has a height that is none on Earth, or lies outside of where
        `system` is used; `triangles` hasn't shape (T, 3) and whole numbers, or names points that there aren't; `system`
        is no `System`; or `beyond` is none of the two.

    See Also
    --------
    read_terrain : reads a raster of heights.
    City.from_buildings : puts buildings on the ground.

    Examples
    --------
    A slope of one metre in ten, as two triangles.

    >>> from uavlab.city import Terrain
    >>> slope = Terrain([(0, 0, 0), (100, 0, 10), (100, 100, 10), (0, 100, 0)], [(0, 1, 2), (0, 2, 3)])
    >>> slope
    <Terrain: 4 points, 2 triangles, heights from 0 to 10 m>
    >>> slope.heights_at([(25, 50), (120, 50)])
    array([2.5, nan])
    """

    points: np.ndarray
    triangles: np.ndarray
    system: System | None = None
    beyond: str = "refuse"

    def __post_init__(self) -> None:
        points = checks.frozen(checks.numbers("points", self.points))
        if points.ndim != 2 or points.shape[1] != 3 or len(points) == 0:
            raise ValueError(f"points of a terrain must have shape (N, 3), at least one, got {points.shape}")
        if not np.isfinite(points).all():
            raise ValueError("points of a terrain must be finite: leave out what has no data")
        triangles = checked_triangles(self.triangles, len(points))
        if self.system is not None:
            checks.instance("system", self.system, System)
        if self.system is None:  # counted from anywhere on Earth
            check_heights(points[:, 2], LOWEST - HIGHEST, HIGHEST - LOWEST)
        else:
            check_heights(points[:, 2], LOWEST, HIGHEST, self.system.height_factor)
        checks.one_of("beyond", self.beyond, BEYOND)
        if self.system is not None:
            box = np.array([*points[:, :2].min(axis=0), *points[:, :2].max(axis=0)])
            ranges = f"({box[0]:g}, {box[1]:g}) to ({box[2]:g}, {box[3]:g})"
            in_degrees = bool((np.abs(box) <= [180, 90, 180, 90]).all())
            check_fits(box, self.system, "terrain", ranges, in_degrees)
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "triangles", triangles)

    def __repr__(self) -> str:
        factor, place = (1.0, "") if self.system is None else (self.system.height_factor, f", in {self.system.name}")
        low, high = factor * self.points[:, 2].min(), factor * self.points[:, 2].max()
        counts = f"{len(self.points):,} points, {len(self.triangles):,} triangles"
        return f"<Terrain: {counts}, heights from {low:.4g} to {high:.4g} m{place}>"

    @classmethod
    def from_raster(
        cls, heights: npt.ArrayLike, bounds: Sequence[float], *, crs: Any = None, beyond: str = "refuse"
    ) -> Terrain:
        """The ground from a raster of heights; between the centres of its pixels it is even.

        Parameters
        ----------
        heights : (rows, columns) array
            As in a picture: the first row lies in the north, the first column in the west. In metres, or in the unit of
            heights of the system. NaN, or masked: no data, a hole.
        bounds : (west, south, east, north)
            Of the whole raster, pixels' outer edges: in metres of the city, or in the coordinates of the system.
        crs : anything that `uavlab.city.place.system_of` takes, optional
            The reference system of the bounds. "local", or none: metres of the city.
        beyond : {"refuse", "nearest"}
            As for `Terrain`.

        Raises
        ------
        ValueError
            If `heights` isn't two-dimensional, has no data at all, over 25 million pixels, or a height that is infinite
            or none on Earth; `bounds` are not in order, or in degrees without `crs`; `crs` is no system that pyproj
            knows or not that of `bounds`; or `beyond` is none of the two.

        See Also
        --------
        read_terrain : the same from a file.
        Terrain.from_points : the ground through scattered points.

        Examples
        --------
        >>> from uavlab.city import Terrain
        >>> hill = Terrain.from_raster([[2, 4], [0, 2]], (0, 0, 20, 20))  # the first row lies in the north
        >>> hill
        <Terrain: 16 points, 18 triangles, heights from 0 to 4 m>
        >>> hill.heights_at([(5, 5), (15, 15), (10, 10)])
        array([0., 4., 2.])
        """
        raster, edges = checked_raster("heights", heights, bounds)
        check_pixels("heights", *raster.shape)
        west, south, east, north = edges
        pixel = max((east - west) / raster.shape[1], (north - south) / raster.shape[0])
        if crs is None and pixel < FINEST:
            raise ValueError(
                f"bounds give pixels of {pixel:.2g} m, got {bounds!r}: in degrees they need crs='EPSG:4326' (plain "
                "metres are crs='local')"
            )
        x, y = pixels_and_edge(west, east, raster.shape[1]), pixels_and_edge(north, south, raster.shape[0])
        grid = np.stack([*np.meshgrid(x, y), np.pad(raster, 1, mode="edge")], axis=-1)
        local = crs is None or (isinstance(crs, str) and crs == LOCAL)
        return cls.from_grid(grid, None if local else system_of(crs), beyond)

    @classmethod
    def from_grid(cls, grid: np.ndarray, system: System | None = None, beyond: str = "refuse") -> Terrain:
        """The ground from points on a grid, which may be turned or uneven: two triangles per mesh.

        Parameters
        ----------
        grid : (rows, columns, 3) float array
            Points in metres of the city, or in the system and its units; NaN where there is no data.
        system : System, optional
            Their reference system.
        beyond : {"refuse", "nearest"}
            As for `Terrain`.

        Returns
        -------
        Terrain
            With holes in the meshes that have a corner without data.

        Raises
        ------
        ValueError
            If `grid` hasn't shape (rows, columns, 3), has no data at all, a height that is none on Earth, or lies
            outside of where `system` is used; `system` is no `System`; or `beyond` is none of the two.

        See Also
        --------
        Terrain.from_raster : from heights and bounds alone.

        Examples
        --------
        >>> import numpy as np
        >>> from uavlab.city import Terrain
        >>> x, y = np.meshgrid([0.0, 10.0, 30.0], [0.0, 10.0])
        >>> Terrain.from_grid(np.stack([x, y, x / 10], axis=-1))
        <Terrain: 6 points, 4 triangles, heights from 0 to 3 m>
        """
        grid = checks.array("grid", grid, None, None, 3, finite=False)
        if system is not None:
            checks.instance("system", system, System)
        rows, columns = grid.shape[:2]
        number = np.arange(rows * columns).reshape(rows, columns)
        north_west, north_east = number[:-1, :-1].ravel(), number[:-1, 1:].ravel()
        south_west, south_east = number[1:, :-1].ravel(), number[1:, 1:].ravel()
        triangles = np.concatenate(
            [np.stack([north_west, south_west, south_east], 1), np.stack([north_west, south_east, north_east], 1)]
        )
        points = grid.reshape(-1, 3)
        known = np.isfinite(points).all(axis=1)
        if not known.any():
            raise ValueError("heights have no data at all: every one in the grid is NaN or masked")
        check_heights(points[known, 2], LOWEST, HIGHEST, 1.0 if system is None else system.height_factor)
        renumbered = np.cumsum(known) - 1
        return cls(points[known], renumbered[triangles[known[triangles].all(axis=1)]], system, beyond)

    @classmethod
    def from_points(cls, points: npt.ArrayLike) -> Terrain:
        """The ground through points: linear between them (Delaunay), beyond them as high as the nearest.

        Parameters
        ----------
        points : (N, 3) array
            [m], in any order; of two above each other the lower one counts.

        Returns
        -------
        Terrain

        Raises
        ------
        ValueError
            If `points` hasn't shape (N, 3) with N of at least 1, is not finite, or has a height that is none on Earth.

        See Also
        --------
        Terrain.from_raster : the ground from a raster of heights.

        Examples
        --------
        >>> from uavlab.city import Terrain
        >>> feet = Terrain.from_points([(0, 0, 1), (40, 0, 1), (0, 40, 5)])
        >>> feet.heights_at([(0, 20), (-30, 50)])
        array([3., 5.])
        """
        known = checks.numbers("points", points)
        if known.ndim != 2 or known.shape[1] != 3 or len(known) == 0:
            raise ValueError(f"points must have shape (N, 3), at least one, got {known.shape}")
        known = known[np.lexsort((known[:, 2], known[:, 1], known[:, 0]))]  # of two above each other, the lower one
        known = known[np.concatenate([[True], (np.diff(known[:, :2], axis=0) != 0).any(axis=1)])]
        return cls(known, triangulated(known), beyond="nearest")

    def placed(self, place: Place | None) -> Terrain:
        """The terrain in metres of a city at a place; as it is when it has no system.

        Parameters
        ----------
        place : Place, or None
            Of x = y = z = 0 of the city, such as `city.reference`.

        Returns
        -------
        Terrain
            Its heights count from that of the place.

        Raises
        ------
        ValueError
            If the terrain has a `system` and `place` is None, `place` is no place on Earth, or a point has none in that
            system.

        See Also
        --------
        City.checked_reference : the place of a city.

        Examples
        --------
        >>> from uavlab.city import Place, Terrain
        >>> survey = Terrain.from_raster([[230, 240], [240, 250]], (9.0, 48.0, 9.002, 48.001), crs="EPSG:4326")
        >>> survey
        <Terrain: 16 points, 18 triangles, heights from 230 to 250 m, in EPSG:4326 (WGS 84)>
        >>> ground = survey.placed(Place(9.0, 48.0, 230.0))
        >>> ground, ground.points[:, :2].max(axis=0).round(1)
        (<Terrain: 16 points, 18 triangles, heights from 0 to 20 m>, array([149.3, 111.2]))
        """
        if place is not None:
            place = place_of("place", place)
        if self.system is None:
            return self
        if place is None:
            raise ValueError(
                f"terrain has a reference system, {self.system.name}, but the city doesn't know its place on Earth: "
                "give the city's crs=..., or the terrain in metres of the city"
            )
        plan = place.east_north(self.system.to_lonlat(self.points[:, :2]))
        heights = self.points[:, 2] * self.system.height_factor - place.height
        return replace(self, points=np.column_stack([plan, heights]), system=None)

    def filled(self) -> Terrain:
        """The same ground that goes on where it has no data."""
        return replace(self, beyond="nearest")

    def heights_at(self, places: npt.ArrayLike) -> np.ndarray:
        """Heights of the ground at places in plan: linear on each triangle.

        Parameters
        ----------
        places : (N, 2) array
            In the coordinates of `points`: in metres, if there is no `system`.

        Returns
        -------
        (N,) array
            [m], or in the unit of the system; NaN where it isn't known, which is nowhere with `beyond="nearest"`.

        Raises
        ------
        ValueError
            If `places` hasn't shape (N, 2) or is not finite.

        See Also
        --------
        Terrain.filled : the same ground that goes on where it has no data.
        City.height_above_ground : height of points above the ground of a city.

        Examples
        --------
        >>> import numpy as np
        >>> from uavlab.city import Terrain
        >>> ground = Terrain.from_raster([[0, 1, np.nan]], (0, 0, 30, 10))
        >>> ground.heights_at([(10, 5), (29, 5)]), ground.filled().heights_at([(10, 5), (29, 5)])
        (array([0.5, nan]), array([0.5, 1. ]))
        """
        from scipy.spatial import cKDTree

        plan = checks.numbers("places", places)
        if plan.ndim != 2 or plan.shape[1] != 2 or not np.isfinite(plan).all():
            raise ValueError(f"places must be finite and have shape (N, 2), got {plan.shape}")
        heights = heights_of(self.points, self.triangles, plan)
        missing = np.isnan(heights)
        if self.beyond == "nearest" and missing.any():
            heights[missing] = heights_of(self.points, self.bridges, plan[missing])
            missing = np.isnan(heights)
            if missing.any():
                nearest = cKDTree(self.points[:, :2]).query(plan[missing])[1]
                heights[missing] = self.points[nearest, 2]
        return heights

    @cached_property
    def bridges(self) -> np.ndarray:
        """Triangles (G, 3) that join the rims of the surface and what points lie beside it, for its gaps."""
        rims = rims_of(self.triangles, len(self.points))
        return checks.frozen(rims[triangulated(self.points[rims])], np.int64)


def checked_terrain(terrain: Any) -> Terrain | float | None:
    """A terrain, the height of level ground [m] as a float, or None."""
    if terrain is None or isinstance(terrain, Terrain):
        return terrain
    if not isinstance(terrain, int | float | np.generic | np.ndarray) or np.ndim(terrain):
        checks.instance("terrain", terrain, Terrain)
    return checks.number("terrain", terrain, checks.finite)


def ground_and_top(
    terrain: Terrain, origin: np.ndarray, cell: float, shape: Sequence[int]
) -> tuple[np.ndarray, np.ndarray]:
    """Height of the ground at the centres of columns, and its highest point in each column, (nx, ny) each [m].

    Raises
    ------
    ValueError
        If the terrain doesn't cover the columns and doesn't go on; it says how many, where, and what would help.
    """
    if terrain.system is not None:
        raise ValueError("terrain must be in metres of the city: use terrain.placed(place) first")
    x, y = (origin[axis] + cell * (np.arange(shape[axis]) + 0.5) for axis in range(2))
    centers = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    ground = terrain.heights_at(centers).reshape(shape[0], shape[1])
    top, covered = top_and_cover(terrain.points, terrain.triangles, origin, cell, shape)
    gaps = np.isnan(ground) | (covered < COVERED)
    if terrain.beyond == "refuse" and gaps.any():
        i, j = np.argwhere(gaps)[0]
        low, high = terrain.points[:, :2].min(axis=0), terrain.points[:, :2].max(axis=0)
        raise ValueError(
            f"terrain says nothing about {gaps.sum()} of the map's {ground.size} columns, or parts of them, the first "
            f"is at ({x[i]:.1f}, {y[j]:.1f}); it reaches over x {low[0]:.1f} to {high[0]:.1f}, y {low[1]:.1f} to "
            f"{high[1]:.1f} m, the map over x {x[0] - cell / 2:.1f} to {x[-1] + cell / 2:.1f}, "
            f"y {y[0] - cell / 2:.1f} to {y[-1] + cell / 2:.1f} m: give a larger one, or terrain.filled(), which "
            "goes on beyond its edges and through holes"
        )
    if gaps.any():
        middle = terrain.points[terrain.bridges, :2].mean(axis=1)
        over_gaps = np.isnan(heights_of(terrain.points, terrain.triangles, middle))
        bridged, _ = top_and_cover(terrain.points, terrain.bridges[over_gaps], origin, cell, shape)
        top[gaps] = np.maximum(top, bridged)[gaps]
    return ground, np.maximum(top, range_of_ground(ground)[1])


def top_and_cover(
    points: np.ndarray, triangles: np.ndarray, origin: np.ndarray, cell: float, shape: Sequence[int]
) -> tuple[np.ndarray, np.ndarray]:
    """Highest point of triangles (T, 3) in each column [m], and the share of it that they cover, (nx, ny) each."""
    plan = (points[:, :2] - origin[:2]) / cell
    sides = np.concatenate([plan <= 0, plan >= np.asarray(shape[:2])], axis=1) @ np.array([1, 2, 4, 8])
    a, b, c = triangles.T
    near = triangles[(sides[a] & sides[b] & sides[c]) == 0]  # the others lie beyond one side of the map
    top, covered, unused = np.full(shape[:2], -np.inf), np.zeros(shape[:2]), np.zeros(shape[:2])
    if len(near):
        window, _, high = ranges_of(points[near], shape, cell, origin)
        top[window] = high
        share_out(plan[near], np.ones(len(near)), unused, covered)
    return top, covered


def pixels_and_edge(first: float, last: float, count: int) -> np.ndarray:
    """Centres of pixels between two edges, and both edges, (count + 2,)."""
    step = (last - first) / count
    return np.concatenate([[first], first + step * (np.arange(count) + 0.5), [last]])


def check_heights(heights: np.ndarray, lowest: float, highest: float, unit: float = 1.0) -> None:
    """Refuse numbers that can't be heights of the ground, between two limits [m]."""
    wrong = heights[(heights * unit < lowest) | (heights * unit > highest)]
    if len(wrong):
        raise ValueError(
            f"points of a terrain must be heights on Earth, {lowest:g} to {highest:g} m, got {wrong[0]:g}, "
            f"{len(wrong)} times: if it stands for no data, declare it (in the file), or make it NaN"
        )


def check_pixels(name: str, rows: int, columns: int) -> None:
    """Refuse a raster that would need more memory than computers have."""
    if rows * columns > MOST_PIXELS:
        raise ValueError(
            f"{name} has {rows:,} × {columns:,} pixels, more than {MOST_PIXELS:,}: cut it to the city first, for "
            "example with gdal_translate -projwin, or take every other pixel"
        )


def checked_raster(name: str, values: npt.ArrayLike, bounds: Sequence[float]) -> tuple[np.ndarray, np.ndarray]:
    """A raster (rows, columns), NaN where it is masked, and its bounds (west, south, east, north)."""
    raster = filled_masks(name, values)
    if raster.ndim != 2 or raster.size == 0:
        raise ValueError(f"{name} must have shape (rows, columns), got {raster.shape}")
    edges = checks.numbers("bounds", bounds)
    if edges.shape != (4,) or not (np.isfinite(edges).all() and edges[0] < edges[2] and edges[1] < edges[3]):
        raise ValueError(f"bounds must be (west, south, east, north) in increasing order, got {bounds!r}")
    return raster, edges


def filled_masks(name: str, values: npt.ArrayLike) -> np.ndarray:
    """Numbers as floats, NaN where they are masked; `ValueError` if one is infinite."""
    if isinstance(values, np.ma.MaskedArray):
        numbers = np.where(np.ma.getmaskarray(values), np.nan, checks.numbers(name, np.ma.getdata(values)))
    else:
        numbers = checks.numbers(name, values)
    endless = np.count_nonzero(np.isinf(numbers))
    if endless:
        raise ValueError(f"{name} must not be infinite, {endless} are: make it NaN, or mask it, where there is no data")
    return numbers


def checked_triangles(triangles: npt.ArrayLike, count: int) -> np.ndarray:
    """Triangles (T, 3) as numbers of points that there are."""
    array = whole_numbers("triangles", triangles)
    if array.size == 0:
        return checks.frozen(np.empty((0, 3)), np.int64)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"triangles must have shape (T, 3), got {array.shape}")
    wrong = array[(array < 0) | (array >= count)]
    if len(wrong):
        raise ValueError(f"triangles must be numbers of points, 0 to {count - 1}, got {wrong[0]}")
    return checks.frozen(array, np.int64)
