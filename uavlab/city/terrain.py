"""The ground: a surface of triangles, from a relief, a raster of heights, or the feet of buildings.

A raster is a surface, too: the centres of its pixels, joined by triangles. So one rule says how high the ground is at a
place, and how high at most in a column of voxels, whatever it came from. Where a surface ends the ground may go on
as far as is known (linear in gaps, nearest beyond), or the map is refused there.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.spatial import Delaunay, QhullError, cKDTree

from uavlab import checks
from uavlab.city.place import LOCAL, Place, System, system_of
from uavlab.city.rasterise import range_of_ground, ranges_of
from uavlab.compiled import compiled

LOWEST, HIGHEST = -500.0, 9000.0
"""No ground on Earth is lower or higher [m]: such a number stands for "no data"."""

BEYOND = ("refuse", "nearest")
ROUNDING = 1e-9


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
        If a shape is wrong, a point is not finite, or no number of a height on Earth.
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
        triangles = checks.frozen(np.asarray(self.triangles).reshape(-1, 3), np.int64)
        if len(triangles) and not 0 <= triangles.min() <= triangles.max() < len(points):
            raise ValueError(f"triangles must be numbers of points, 0 to {len(points) - 1}, got {triangles.max()}")
        heights = points[:, 2] * (1.0 if self.system is None else self.system.height_factor)
        wrong = np.flatnonzero((heights < LOWEST) | (heights > HIGHEST))
        if len(wrong):
            raise ValueError(
                f"points of a terrain must be heights on Earth, {LOWEST:g} to {HIGHEST:g} m, got "
                f"{points[wrong[0], 2]:g}, {len(wrong)} times: if it stands for no data, make it NaN"
            )
        checks.one_of("beyond", self.beyond, BEYOND)
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "triangles", triangles)

    @classmethod
    def from_raster(
        cls, heights: npt.ArrayLike, bounds: Sequence[float], *, crs: Any = None, beyond: str = "refuse"
    ) -> "Terrain":
        """The ground from a raster of heights; between the centres of its pixels it is even.

        Parameters
        ----------
        heights : (rows, columns) array
            As in a picture: the first row lies in the north, the first column in the west. In metres, or in the unit of
            heights of the system. NaN, or masked: no data, a hole.
        bounds : (west, south, east, north)
            Of the whole raster, pixels' outer edges: in metres of the city, or in the coordinates of the system.
        crs : anything that `uavlab.city.place.system_of` takes, optional
            The reference system of the bounds.
        beyond : {"refuse", "nearest"}
            As for `Terrain`.

        Raises
        ------
        ValueError
            If there are no heights, bounds are not in order, pyproj doesn't know the system, or a height is none.
        """
        raster = filled_masks("heights", heights)
        if raster.ndim != 2 or raster.size == 0:
            raise ValueError(f"heights must have shape (rows, columns), got {raster.shape}")
        edges = checks.numbers("bounds", bounds)
        if edges.shape != (4,) or not (np.isfinite(edges).all() and edges[0] < edges[2] and edges[1] < edges[3]):
            raise ValueError(f"bounds must be (west, south, east, north) in increasing order, got {bounds!r}")
        west, south, east, north = edges
        x, y = pixels_and_edge(west, east, raster.shape[1]), pixels_and_edge(north, south, raster.shape[0])
        grid = np.stack([*np.meshgrid(x, y), np.pad(raster, 1, mode="edge")], axis=-1)
        return cls.from_grid(grid, None if crs is None or crs == LOCAL else system_of(crs), beyond)

    @classmethod
    def from_grid(cls, grid: np.ndarray, system: System | None = None, beyond: str = "refuse") -> "Terrain":
        """The ground from points on a grid (rows, columns, 3), NaN where there is no data: two triangles per mesh."""
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
            raise ValueError("heights have no data at all: every one is NaN or masked")
        renumbered = np.cumsum(known) - 1
        return cls(points[known], renumbered[triangles[known[triangles].all(axis=1)]], system, beyond)

    @classmethod
    def from_points(cls, points: npt.ArrayLike) -> "Terrain":
        """The ground through points (N, 3) [m]: linear between them (Delaunay), beyond them as high as the nearest."""
        known = checks.numbers("points", points)
        if known.ndim != 2 or known.shape[1] != 3 or len(known) == 0:
            raise ValueError(f"points must have shape (N, 3), at least one, got {known.shape}")
        known = known[np.lexsort((known[:, 2], known[:, 1], known[:, 0]))]  # of two above each other, the lower one
        known = known[np.concatenate([[True], (np.diff(known[:, :2], axis=0) != 0).any(axis=1)])]
        return cls(known, triangulated(known), beyond="nearest")

    def placed(self, place: Place | None) -> "Terrain":
        """The terrain in metres of a city at a place; as it is when it has no system.

        Raises
        ------
        ValueError
            If it has a system and the place isn't known.
        """
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

    def filled(self) -> "Terrain":
        """The same ground that goes on where it has no data."""
        return replace(self, beyond="nearest")

    def heights_at(self, places: npt.ArrayLike) -> np.ndarray:
        """Heights (N,) [m] of the ground at places (N, 2); NaN where it isn't known."""
        plan = checks.numbers("places", places)
        if plan.ndim != 2 or plan.shape[1] != 2 or not np.isfinite(plan).all():
            raise ValueError(f"places must be finite and have shape (N, 2), got {plan.shape}")
        heights = heights_of(self.points[self.triangles], plan)
        missing = np.isnan(heights)
        if self.beyond == "nearest" and missing.any():
            heights[missing] = heights_of(self.points[triangulated(self.points)], plan[missing])
            missing = np.isnan(heights)
            if missing.any():
                nearest = cKDTree(self.points[:, :2]).query(plan[missing])[1]
                heights[missing] = self.points[nearest, 2]
        return heights


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
    missing = np.argwhere(np.isnan(ground))
    if len(missing):
        i, j = missing[0]
        low, high = terrain.points[:, :2].min(axis=0), terrain.points[:, :2].max(axis=0)
        raise ValueError(
            f"terrain says nothing about {len(missing)} of the map's {ground.size} columns, the first is at "
            f"({x[i]:.1f}, {y[j]:.1f}); it reaches over x {low[0]:.1f} to {high[0]:.1f}, y {low[1]:.1f} to "
            f"{high[1]:.1f} m, the map over x {x[0] - cell / 2:.1f} to {x[-1] + cell / 2:.1f}, "
            f"y {y[0] - cell / 2:.1f} to {y[-1] + cell / 2:.1f} m: give a larger one, or terrain.filled(), which "
            "goes on beyond its edges and through holes"
        )
    top = range_of_ground(ground)[1]
    if len(terrain.triangles):
        window, _, high = ranges_of(terrain.points[terrain.triangles], shape, cell, origin)
        top[window] = np.maximum(top[window], high)
    return ground, top


def pixels_and_edge(first: float, last: float, count: int) -> np.ndarray:
    """Centres of pixels between two edges, and both edges, (count + 2,)."""
    step = (last - first) / count
    return np.concatenate([[first], first + step * (np.arange(count) + 0.5), [last]])


def filled_masks(name: str, values: npt.ArrayLike) -> np.ndarray:
    """Numbers as floats, NaN where they are masked."""
    if isinstance(values, np.ma.MaskedArray):
        return np.ma.filled(values.astype(float), np.nan)
    return checks.numbers(name, values)


def triangulated(points: np.ndarray) -> np.ndarray:
    """Delaunay triangles (T, 3) of points (N, 3) in plan; none where fewer than three are not on a line."""
    try:
        return Delaunay(points[:, :2] - points[:, :2].mean(axis=0)).simplices
    except (QhullError, ValueError):
        return np.empty((0, 3), int)


def heights_of(corners: np.ndarray, plan: np.ndarray) -> np.ndarray:
    """Heights (N,) of triangles (T, 3, 3) at places (N, 2); NaN where there is none."""
    heights = np.full(len(plan), np.nan)
    if len(corners) and len(plan):
        everything = np.concatenate([corners[..., :2].reshape(-1, 2), plan])
        low, extent = everything.min(axis=0), float(np.ptp(everything, axis=0).max())
        bins = max(min(int(math.sqrt(len(corners))), 1000), 1)
        heights_in_bins(corners - [*low, 0.0], plan - low, max(extent, 1e-9) * (1 + 1e-9) / bins, bins, heights)
    return heights


@compiled
def heights_in_bins(corners, places, width, bins, heights):
    """Height of triangles (T, 3, 3) at places (N, 2), into `heights`, the highest where several are above each other.

    Triangles are sorted into square bins by their bounding boxes, so that few are looked at for each place.
    """
    first = np.zeros(bins * bins + 1, np.int64)
    ranges = np.empty((len(corners), 4), np.int64)
    for t in range(len(corners)):
        for axis in range(2):
            least = min(corners[t, 0, axis], corners[t, 1, axis], corners[t, 2, axis])
            most = max(corners[t, 0, axis], corners[t, 1, axis], corners[t, 2, axis])
            ranges[t, axis] = min(max(math.floor(least / width), 0), bins - 1)
            ranges[t, 2 + axis] = min(max(math.floor(most / width), 0), bins - 1)
        for i in range(ranges[t, 0], ranges[t, 2] + 1):
            for j in range(ranges[t, 1], ranges[t, 3] + 1):
                first[i * bins + j + 1] += 1
    first = np.cumsum(first)
    members, filled = np.empty(first[-1], np.int64), first[:-1].copy()
    for t in range(len(corners)):
        for i in range(ranges[t, 0], ranges[t, 2] + 1):
            for j in range(ranges[t, 1], ranges[t, 3] + 1):
                members[filled[i * bins + j]] = t
                filled[i * bins + j] += 1
    for n in range(len(places)):
        i, j = math.floor(places[n, 0] / width), math.floor(places[n, 1] / width)
        if not (0 <= i < bins and 0 <= j < bins):
            continue
        for m in range(first[i * bins + j], first[i * bins + j + 1]):
            height = height_in_triangle(corners[members[m]], places[n])
            if not np.isnan(height) and not height <= heights[n]:
                heights[n] = height


@compiled
def height_in_triangle(corners, place):
    """Height of a triangle (3, 3) at a place in plan; NaN outside of it, or where it stands upright."""
    ax, ay = corners[1, 0] - corners[0, 0], corners[1, 1] - corners[0, 1]
    bx, by = corners[2, 0] - corners[0, 0], corners[2, 1] - corners[0, 1]
    px, py = place[0] - corners[0, 0], place[1] - corners[0, 1]
    twice = ax * by - ay * bx
    if twice == 0:
        return np.nan
    u, v = (px * by - py * bx) / twice, (ax * py - ay * px) / twice
    if u < -ROUNDING or v < -ROUNDING or u + v > 1 + ROUNDING:
        return np.nan
    return corners[0, 2] + u * (corners[1, 2] - corners[0, 2]) + v * (corners[2, 2] - corners[0, 2])
