"""The city as planners see it: a box of voxels, free or occupied, and the distance to the nearest wall.

A voxel (i, j, k) covers `origin + cell·[i, i+1)` on each axis, its centre is the node that planners visit. A voxel is
occupied when its centre lies in a building. Outside of the box nothing may fly; the border itself is no obstacle,
so clearance is measured to buildings alone, neither to the border nor to the ground.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise

import numpy as np
import numpy.typing as npt
from scipy.spatial import ConvexHull

from uavlab.city.buildings import FACE_TOLERANCE, Building
from uavlab.city.voxels import distances_to_obstacle, squared_clearance, voxels_on_segment

MOST_VOXELS = 500_000_000
"""More than this is refused: half a gigabyte for the occupancy alone."""


@dataclass(frozen=True, eq=False)
class City:
    """An occupancy grid and the buildings that it came from.

    Attributes
    ----------
    occupied : (nx, ny, nz) bool array
        True where the centre of the voxel lies in a building.
    cell : float
        Edge of a voxel [m], above 0.
    origin : (3,) float array
        Lowest corner of the map [m].
    buildings : tuple of Building
        For drawing and for messages; may be empty, as after `read_voxels`.
    name : str
    reference : (longitude, latitude) or None
        Where on Earth x = y = 0 lies [degrees], when a reader knows.

    Raises
    ------
    ValueError
        If `occupied` is not a three-dimensional array with voxels in it, or `cell` is not above 0.
    """

    occupied: np.ndarray
    cell: float = 1.0
    origin: np.ndarray = field(default_factory=lambda: np.zeros(3))
    buildings: tuple[Building, ...] = ()
    name: str = "city"
    reference: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        occupied = np.ascontiguousarray(self.occupied, dtype=bool)
        if occupied.ndim != 3 or occupied.size == 0:
            raise ValueError(f"occupied must be an array (nx, ny, nz) with at least one voxel, got {occupied.shape}")
        object.__setattr__(self, "occupied", occupied)
        object.__setattr__(self, "origin", checked_origin(self.origin))
        object.__setattr__(self, "cell", checked_cell(self.cell))
        object.__setattr__(self, "buildings", tuple(self.buildings))

    @classmethod
    def from_buildings(
        cls,
        buildings: Sequence[Building],
        *,
        cell: float = 1.0,
        origin: npt.ArrayLike | None = None,
        size: npt.ArrayLike | None = None,
        margin: float = 20.0,
        name: str = "city",
        reference: tuple[float, float] | None = None,
    ) -> "City":
        """Rasterise buildings: a voxel is occupied when its centre lies in one.

        Parameters
        ----------
        buildings : sequence of Building
        cell : float
            Edge of a voxel [m], typically 0.5 to 5.
        origin, size : (3,) arrays, optional
            Lowest corner and extent of the map [m]. By default the buildings' bounding box, `margin` wider on each
            side and above, down to the lowest building's floor.
        margin : float
            Free space around the buildings [m] when `size` is not given.

        Raises
        ------
        ValueError
            If there are neither buildings nor a size, `cell` is not above 0, or the map would have over
            500 million voxels.
        """
        cell = checked_cell(cell)
        if size is None or origin is None:
            if not buildings:
                raise ValueError(
                    "buildings is empty, so the extent of the map is unknown: give origin and size, "
                    "for example origin=(0, 0, 0), size=(100, 100, 100)"
                )
            low = np.min([building.bounds[0] for building in buildings], axis=0)
            high = np.max([building.bounds[1] for building in buildings], axis=0)
            around = np.array([margin, margin, 0.0])
            origin = low - around if origin is None else checked_origin(origin)
            size = high + np.array([margin, margin, margin]) - origin if size is None else size
        corner, extent = checked_origin(origin), np.asarray(size, dtype=float)
        if extent.shape != (3,) or not (np.isfinite(extent) & (extent > 0)).all():
            raise ValueError(f"size must be three positive extents (x, y, z) in metres, got {size!r}")
        shape = np.ceil(extent / cell - 1e-9)
        if shape.prod() > MOST_VOXELS:
            edge = (extent.prod() / MOST_VOXELS) ** (1 / 3)
            raise ValueError(
                f"cell={cell:g} m gives {shape[0]:.0f} × {shape[1]:.0f} × {shape[2]:.0f} voxels over "
                f"{extent[0]:.0f} × {extent[1]:.0f} × {extent[2]:.0f} m, more than {MOST_VOXELS:,}: "
                f"use a cell of at least {edge:.2g} m or a smaller size"
            )
        occupied = np.zeros(shape.astype(int), dtype=bool)
        for building in buildings:
            rasterise(building, occupied, cell, corner)
        return cls(occupied, cell, corner, tuple(buildings), name, reference)

    @property
    def shape(self) -> tuple[int, int, int]:
        """Number of voxels along x, y and z."""
        nx, ny, nz = self.occupied.shape
        return nx, ny, nz

    @property
    def bounds(self) -> np.ndarray:
        """Lowest and highest corner of the map, (2, 3) [m]."""
        return np.array([self.origin, self.origin + self.cell * np.array(self.shape)])

    @cached_property
    def clearance(self) -> np.ndarray:
        """Distance from each centre to the nearest obstacle surface, (nx, ny, nz) [m].

        0 in an obstacle, infinite where there is none at all. Exact: the obstacle is the whole voxel, not its centre.
        """
        clearance = squared_clearance(self.occupied)
        np.sqrt(clearance, out=clearance)
        clearance *= self.cell
        return clearance

    @cached_property
    def wall_normal(self) -> np.ndarray:
        """Unit vectors away from the nearest wall, (nx, ny, nz, 3): the direction of the clearance's gradient.

        By central differences, so between two walls that are equally near it points along both; 0 where there is none.
        """
        clearance = np.where(np.isfinite(self.clearance), self.clearance, 0.0)
        normal = np.zeros((*self.shape, 3))
        for axis, count in enumerate(self.shape):
            if count > 1:
                normal[..., axis] = np.gradient(clearance, axis=axis)
        size = np.linalg.norm(normal, axis=-1, keepdims=True)
        normal /= np.where(size > 1e-9, size, np.inf)
        return normal

    def towards_wall(self, vector: npt.ArrayLike) -> np.ndarray:
        """How much of a vector (3,) points towards the nearest wall, max(0, −v·n), (nx, ny, nz)."""
        direction = np.asarray(vector, dtype=float)
        if direction.shape != (3,) or not np.isfinite(direction).all():
            raise ValueError(f"vector must be three finite numbers (east, north, up), got {vector!r}")
        if not direction.any():
            return np.zeros(self.shape)
        return np.maximum(0.0, self.wall_normal @ -direction)

    @cached_property
    def height_above_surface(self) -> np.ndarray:
        """Height of each centre above the next roof below it, else above the floor of the map, (nx, ny, nz) [m].

        0 in an obstacle. Roofs are taken from the buildings, exactly; from the voxels where the city knows none.
        """
        levels = self.coordinates(2)
        if self.buildings:
            surface = np.full(self.shape, self.origin[2])
            for building in self.buildings:
                raise_surface(building, surface, levels, self.cell, self.origin)
        else:
            tops = np.where(self.occupied, levels + self.cell / 2, self.origin[2])
            surface = np.maximum.accumulate(tops, axis=2)
        return np.where(self.occupied, 0.0, np.maximum(levels - surface, 0.0))

    def distance(self, points: npt.ArrayLike, exact_within: float | None = None) -> np.ndarray:
        """Distance from points to the nearest obstacle's surface, where `clearance` has it from centres only.

        Parameters
        ----------
        points : (..., 3) array
            [m]; of what lies beyond the map nothing is known, only the obstacles on it count.
        exact_within : float, optional
            Up to this distance [m] it is exact, by default four voxels. Beyond it is a lower bound, on the map less
            than two voxels too low: the clearance of the nearest voxel's centre less the way there.

        Returns
        -------
        (...) array
            [m]; 0 in an obstacle, infinite where there is none at all.

        Raises
        ------
        ValueError
            If `points` hasn't shape (..., 3) or is not finite, or `exact_within` is negative.
        """
        points = np.asarray(points, dtype=float)
        if points.shape[-1:] != (3,) or not np.isfinite(points).all():
            raise ValueError(f"points must be finite and have shape (..., 3), got shape {points.shape}")
        if exact_within is not None and not exact_within >= 0:
            raise ValueError(f"exact_within must be a distance in metres, at least 0, got {exact_within!r}")
        cells = (points.reshape(-1, 3) - self.origin) / self.cell
        near = 4.0 if exact_within is None else exact_within / self.cell
        distances = distances_to_obstacle(self.occupied, self.clearance, self.cell, cells, near)
        return self.cell * distances.reshape(points.shape[:-1])

    def blocked(self, min_clearance: float) -> np.ndarray:
        """Where a UAV may not be: obstacles, and what is nearer to them than a distance.

        Parameters
        ----------
        min_clearance : float
            Least clearance allowed [m]; 0 leaves every free voxel open.

        Returns
        -------
        (nx, ny, nz) bool array

        Raises
        ------
        ValueError
            If `min_clearance` is negative or not finite.
        """
        if not (np.isfinite(min_clearance) and min_clearance >= 0):
            raise ValueError(f"min_clearance must be a distance in metres, at least 0, got {min_clearance!r}")
        if min_clearance == 0:
            return self.occupied
        return self.clearance < min_clearance - 1e-9 * self.cell

    def cell_of(self, points: npt.ArrayLike) -> np.ndarray:
        """Indices (..., 3) of the voxels in which points (..., 3) [m] lie; out of range outside of the map or for NaN.

        Raises
        ------
        ValueError
            If `points` hasn't shape (..., 3).
        """
        points = np.asarray(points, dtype=float)
        if points.shape[-1:] != (3,):
            raise ValueError(f"points must have shape (..., 3), got {points.shape}")
        index = np.floor((points - self.origin) / self.cell)
        return np.where(np.abs(index) < 2.0**62, index, -1).astype(np.int64)

    def coordinates(self, axis: int) -> np.ndarray:
        """Coordinates of the centres along an axis, 0 east, 1 north, 2 up, (n,) [m]."""
        return self.origin[axis] + self.cell * (np.arange(self.shape[axis]) + 0.5)

    def center_of(self, index: npt.ArrayLike) -> np.ndarray:
        """Centres (..., 3) [m] of the voxels with indices (..., 3)."""
        return self.origin + self.cell * (np.asarray(index) + 0.5)

    def code_of(self, index: npt.ArrayLike) -> np.ndarray:
        """Node codes of voxels (..., 3): k + nz·(j + ny·i), the position in `occupied.ravel()`.

        Raises
        ------
        ValueError
            If an index is outside of the map or hasn't shape (..., 3).
        """
        index = np.asarray(index)
        if index.shape[-1:] != (3,):
            raise ValueError(f"index must have shape (..., 3), got {index.shape}")
        if ((index < 0) | (index >= self.shape)).any():
            wrong = index[((index < 0) | (index >= self.shape)).any(axis=-1)].reshape(-1, 3)[0]
            raise ValueError(f"index {tuple(wrong.tolist())} lies outside of the map of {self.shape} voxels")
        return np.ravel_multi_index(tuple(np.moveaxis(index, -1, 0)), self.shape)

    def index_of(self, code: npt.ArrayLike) -> np.ndarray:
        """Indices (..., 3) of the voxels with these node codes; the inverse of `code_of`.

        Raises
        ------
        ValueError
            If a code is not between 0 and the number of voxels.
        """
        code = np.asarray(code)
        if ((code < 0) | (code >= self.occupied.size)).any():
            wrong = code[(code < 0) | (code >= self.occupied.size)].flat[0]
            raise ValueError(f"code must be from 0 to {self.occupied.size - 1}, got {wrong}")
        return np.stack(np.unravel_index(code, self.shape), axis=-1)

    def inside(self, points: npt.ArrayLike) -> np.ndarray:
        """Whether points (..., 3) [m] lie in the map's box, (...) bool."""
        index = self.cell_of(points)
        return np.all((index >= 0) & (index < self.shape), axis=-1)

    def is_free(self, points: npt.ArrayLike) -> np.ndarray:
        """Whether points (..., 3) [m] lie in free voxels, (...) bool; outside of the map is not free."""
        points = np.asarray(points, dtype=float)
        inside = self.inside(points)
        index = np.where(inside[..., None], self.cell_of(points), 0)
        return inside & ~self.occupied[tuple(np.moveaxis(index, -1, 0))]

    def building_at(self, point: npt.ArrayLike) -> str:
        """Name of the building in whose voxels a point [m] lies; "an obstacle" if the map knows no buildings."""
        center = self.center_of(self.cell_of(point))
        return next((f"building {b.name!r}" for b in self.buildings if b.contains(center)), "an obstacle")

    def random_pairs(
        self, count: int, rng: np.random.Generator | int, *, apart: float = 40.0, min_clearance: float = 0.0
    ) -> np.ndarray:
        """Starts and goals for experiments: centres of voxels, drawn evenly, at least `apart` from each other.

        Parameters
        ----------
        count : int
            How many pairs.
        rng : numpy.random.Generator or int
            A generator, or the seed of one.
        apart : float
            Least straight distance between start and goal [m].
        min_clearance : float
            Least distance of both to obstacles [m]; 0 allows every free voxel.

        Returns
        -------
        (count, 2, 3) float array
            Start and goal of each pair [m].

        Raises
        ------
        ValueError
            If no such pairs are found in this city, `count` is below 1, or `min_clearance` is negative.
        """
        if count < 1:
            raise ValueError(f"count must be at least 1, got {count!r}")
        rng = np.random.default_rng(rng)
        allowed = np.flatnonzero(~self.blocked(min_clearance))
        pairs: list[np.ndarray] = []
        for _ in range(1000 * count if len(allowed) else 0):
            start, goal = self.center_of(self.index_of(allowed[rng.integers(len(allowed), size=2)]))
            if np.linalg.norm(goal - start) >= apart:
                pairs.append(np.array([start, goal]))
            if len(pairs) == count:
                return np.array(pairs)
        raise ValueError(
            f"no {count} pairs found that are apart={apart:g} m from each other and min_clearance={min_clearance:g} m "
            f"from obstacles; the map measures {' × '.join(f'{extent:g}' for extent in np.ptp(self.bounds, axis=0))} m"
        )

    def voxels_along(self, points: npt.ArrayLike) -> tuple[np.ndarray, np.ndarray]:
        """The voxels that a polyline passes through, none left out, and its length in each.

        Parameters
        ----------
        points : (N, 3) array
            Waypoints [m].

        Returns
        -------
        index : (M, 3) int array
            Voxels in order; out of range where the polyline leaves the map.
        length : (M,) array
            Length within each [m]; sums to the polyline's.

        Raises
        ------
        ValueError
            If `points` hasn't shape (N, 3) or is not finite.
        """
        points = np.asarray(points, dtype=float)
        if points.ndim != 2 or points.shape[1] != 3 or not np.isfinite(points).all():
            raise ValueError(f"points must be finite and have shape (N, 3), got shape {points.shape}")
        voxels, lengths = [], []
        for start, end in pairwise(points):
            index, leave = voxels_on_segment((start - self.origin) / self.cell, (end - self.origin) / self.cell)
            voxels.append(index)
            lengths.append(np.diff(leave, prepend=0.0) * np.linalg.norm(end - start))
        if not voxels:
            return self.cell_of(points), np.zeros(len(points))
        return np.concatenate(voxels), np.concatenate(lengths)


def checked_cell(cell: float) -> float:
    if not (np.isfinite(cell) and cell > 0):
        raise ValueError(f"cell must be the edge of a voxel in metres, above 0, got {cell!r}")
    return float(cell)


def checked_origin(origin: npt.ArrayLike) -> np.ndarray:
    corner = np.asarray(origin, dtype=float)
    if corner.shape != (3,) or not np.isfinite(corner).all():
        raise ValueError(f"origin must be three finite numbers (x, y, z) in metres, got {origin!r}")
    return corner


def rasterise(building: Building, occupied: np.ndarray, cell: float, origin: np.ndarray) -> None:
    """Mark the voxels whose centres lie in the building, in place; what sticks out of the map is cut off."""
    for hull in building.hulls:
        low, high = voxels_around(hull, occupied.shape, cell, origin)
        x, y, z = np.ix_(*(origin[a] + cell * (np.arange(low[a], high[a]) + 0.5) for a in range(3)))
        inside = np.ones(high - low, dtype=bool)
        for a, b, c, d in hull.equations:  # one face after the other, as in Building.contains, for memory's sake
            inside &= a * x + b * y + c * z + d <= FACE_TOLERANCE
        occupied[low[0] : high[0], low[1] : high[1], low[2] : high[2]] |= inside


def raise_surface(building: Building, surface: np.ndarray, levels: np.ndarray, cell: float, origin: np.ndarray) -> None:
    """Raise the surface below each centre (nx, ny, nz) to the building's roofs that lie below it, in place.

    A vertical line meets the face a·x + b·y + c·z + d = 0 of a convex piece at one height, and is inside the piece
    below all faces that look up (c > 0), above all that look down, and behind those that are vertical.
    """
    for hull in building.hulls:
        low, high = voxels_around(hull, surface.shape, cell, origin)
        x, y = np.ix_(*(origin[a] + cell * (np.arange(low[a], high[a]) + 0.5) for a in range(2)))
        roof, floor = np.full(np.broadcast_shapes(x.shape, y.shape), np.inf), np.full((1, 1), -np.inf)
        for a, b, c, d in hull.equations:
            behind = a * x + b * y + d
            if abs(c) <= FACE_TOLERANCE:
                roof = np.where(behind <= FACE_TOLERANCE, roof, -np.inf)
            elif c > 0:
                roof = np.minimum(roof, -behind / c)
            else:
                floor = np.maximum(floor, -behind / c)
        roof = np.where(roof >= floor, roof, -np.inf)[..., None]
        columns = surface[low[0] : high[0], low[1] : high[1]]
        np.maximum(columns, np.where(roof <= levels + FACE_TOLERANCE, roof, -np.inf), out=columns)


def voxels_around(hull: ConvexHull, shape: Sequence[int], cell: float, origin: np.ndarray) -> tuple[np.ndarray, ...]:
    """First and, exclusively, last index (3,) of the voxels whose centres may lie in a hull."""
    low = np.clip(np.floor((hull.min_bound - origin) / cell - 0.5).astype(int), 0, shape)
    high = np.clip(np.ceil((hull.max_bound - origin) / cell + 0.5).astype(int), 0, shape)
    return low, high
