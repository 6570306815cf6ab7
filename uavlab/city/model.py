"""The city as planners see it: a box of voxels, free or occupied, and the distance to the nearest wall.

A voxel (i, j, k) covers `origin + cell·[i, i+1)` on each axis, its centre is the node that planners visit. A voxel is
occupied when a building or the ground reaches into it, so that what is free is free. Outside of the box nothing may
fly; the border itself is no obstacle. A city without `ground` has the papers' open floor, which is none either.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.city.buildings import Building
from uavlab.city.extent import (
    check_heights,
    checked_cell,
    checked_origin,
    checked_points,
    extent_and_ground,
    locked,
)
from uavlab.city.place import Place
from uavlab.city.rasterise import RULES, bilinear, mark_ground, raise_surface, range_of_ground, rasterise, touches
from uavlab.city.segments import Runs, runs_of, segment_clearances
from uavlab.city.source import Source
from uavlab.city.terrain import Terrain
from uavlab.city.voxels import TOUCH, distances_to_obstacle, squared_clearance, voxels_on_segment
from uavlab.city.zones import NoFlyZone, checked_zones

TINY = 1e-300
"""A clearance below this is that of an obstacle."""


@dataclass(frozen=True, eq=False)
class City:
    """An occupancy grid and the buildings and the ground that it came from.

    Its arrays can't be written to, and those that it is given are copied.

    Attributes
    ----------
    occupied : (nx, ny, nz) bool array
        True where a building or the ground is; what lies below `ground` is added.
    cell : float
        Edge of a voxel [m], above 0.
    origin : (3,) float array
        Lowest corner of the map [m].
    buildings : tuple of Building
        For drawing and for messages; may be empty, as after `read_voxels`.
    name : str
    reference : Place, or (longitude, latitude[, height]), or None
        Where on Earth x = y = z = 0 lies [degrees, m], when a reader knows.
    ground : (nx, ny) float array, or None
        Height of the terrain at the centre of each column [m], solid below. None: the bottom of the map is the
        ground, and no obstacle.
    no_fly : tuple of NoFlyZone
        Closed for planners, no obstacles.
    source : Source, or None
        What a reader made of the file.

    Raises
    ------
    ValueError
        If `occupied` is not a three-dimensional array with voxels in it, `cell` is not above 0, or `ground` doesn't
        fit.
    """

    occupied: np.ndarray
    cell: float = 1.0
    origin: np.ndarray = field(default_factory=lambda: np.zeros(3))
    buildings: tuple[Building, ...] = ()
    name: str = "city"
    reference: Place | None = None
    ground: np.ndarray | None = None
    no_fly: tuple[NoFlyZone, ...] = ()
    source: Source | None = None

    def __post_init__(self) -> None:
        if np.ma.is_masked(self.occupied):
            raise ValueError("occupied has masked voxels: say of each whether it is occupied")
        occupied = checks.frozen(self.occupied, bool)
        if occupied.ndim != 3 or occupied.size == 0:
            raise ValueError(f"occupied must be an array (nx, ny, nz) with at least one voxel, got {occupied.shape}")
        object.__setattr__(self, "origin", checked_origin(self.origin))
        object.__setattr__(self, "cell", checked_cell(self.cell))
        object.__setattr__(self, "buildings", tuple(self.buildings))
        object.__setattr__(self, "no_fly", checked_zones(self.no_fly))
        if self.reference is not None:
            object.__setattr__(self, "reference", Place(*self.reference))
        if self.ground is not None:
            ground = checks.frozen(checks.numbers("ground", self.ground))
            if ground.shape != occupied.shape[:2] or not np.isfinite(ground).all():
                raise ValueError(
                    f"ground must have one finite height for each column {occupied.shape[:2]}, got shape "
                    f"{ground.shape} with {np.count_nonzero(~np.isfinite(ground))} that are NaN or infinite"
                )
            object.__setattr__(self, "ground", ground)
            solid = occupied.copy()
            mark_ground(solid, self.range_of_ground[1], self.cell, self.origin[2])
            occupied = locked(solid)
        object.__setattr__(self, "occupied", occupied)

    def __repr__(self) -> str:
        shape = " × ".join(map(str, self.occupied.shape))
        return f"<City {self.name}: {shape} voxels of {self.cell:g} m, {len(self.buildings)} buildings>"

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
        reference: Place | None = None,
        source: Source | None = None,
        terrain: Terrain | float | None = None,
        voxels: str = "touched",
        no_fly: Sequence[NoFlyZone] = (),
    ) -> City:
        """Rasterise buildings and the ground that they stand on.

        Parameters
        ----------
        buildings : sequence of Building
        cell : float
            Edge of a voxel [m], typically 0.5 to 5.
        origin, size : (3,) arrays, optional
            Lowest corner and extent of the map [m]. By default the bounding box of buildings and ground, `margin` wider
            on each side of the buildings and above all; the ground, where there is one, gets a layer of solid voxels.
        margin : float
            Free space around and above [m] when `size` is not given, at least 0.
        name, reference, source, no_fly
            As for `City`.
        terrain : Terrain or float, optional
            The ground, in the coordinates of the buildings; one number for level ground at that height. Without it the
            bottom of the map is the ground, and no obstacle: the lowest floor. Where all buildings float, give terrain
            or origin, or falls end at the lowest of them.
        voxels : {"touched", "centres"}
            A voxel is occupied when a building reaches into it; or, as in the papers, only when its centre lies in
            one, which loses what is thinner than a voxel.

        Raises
        ------
        ValueError
            If there are neither buildings nor a size, `cell` is not above 0, the terrain doesn't cover the map, or the
            map would have over 500 million voxels.
        """
        cell = checked_cell(cell)
        checks.one_of("voxels", voxels, RULES)
        checks.not_negative_number("margin", margin)
        corner, shape, ground, top = extent_and_ground(buildings, cell, origin, size, margin, terrain)
        occupied = np.zeros(shape, dtype=bool)
        if top is not None:
            mark_ground(occupied, top, cell, corner[2])
        hulls = (hull for building in buildings for hull in building.hulls)
        rasterise(hulls, occupied, cell, corner, voxels)
        return cls(locked(occupied), cell, corner, tuple(buildings), name, reference, ground, tuple(no_fly), source)

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
        return locked(clearance)

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
        return locked(normal)

    def towards_wall(self, vector: npt.ArrayLike) -> np.ndarray:
        """How much of a vector (3,) points towards the nearest wall, max(0, −v·n), (nx, ny, nz)."""
        direction = np.asarray(vector, dtype=float)
        if direction.shape != (3,) or not np.isfinite(direction).all():
            raise ValueError(f"vector must be three finite numbers (east, north, up), got {vector!r}")
        if not direction.any():
            return np.zeros(self.shape)
        return np.maximum(0.0, self.wall_normal @ -direction)

    def clearance_along(self, offset: npt.ArrayLike, *, at_most: float = np.inf) -> np.ndarray:
        """Least distance to obstacles on the way from each voxel's centre to where an offset takes it.

        Parameters
        ----------
        offset : (2,) or (3,) array
            (east, north[, up]) [m].
        at_most : float
            Where it is more than this [m], this is given instead, and found sooner.

        Returns
        -------
        (nx, ny, nz) array
            [m], exact; `clearance` for an offset of 0.

        Raises
        ------
        ValueError
            If the offset isn't two or three finite numbers, or `at_most` is negative.
        """
        way = np.array(checks.three("offset", offset))
        checks.number("at_most", at_most)
        checks.refuse(np.asarray(at_most), np.asarray(at_most) >= 0, "at_most must be a distance in metres, at least 0")
        least = np.minimum(self.clearance, at_most)
        if way.any():
            index = np.argwhere((self.clearance - np.linalg.norm(way) < at_most) & ~self.occupied)
            begin, there = self.center_of(index), tuple(index.T)
            least[there] = self.segment_distance(begin, begin + way, at_most=least[there])
        return least

    @cached_property
    def range_of_ground(self) -> tuple[np.ndarray, np.ndarray]:
        """Lowest and highest ground in each column, (nx, ny) each [m]; without terrain the bottom of the map."""
        if self.ground is None:
            floor = locked(np.full(self.occupied.shape[:2], self.origin[2]))
            return floor, floor
        lowest, highest = range_of_ground(self.ground)
        return locked(lowest), locked(highest)

    def height_above_ground(self, points: npt.ArrayLike) -> np.ndarray:
        """Height of points (..., 3) [m] above the ground below them, (...) [m]: bilinear between the columns' centres.

        Beyond the border of the map the ground goes on as it is at it.

        Raises
        ------
        ValueError
            If `points` hasn't shape (..., 3) or is not finite.
        """
        points = checked_points(points)
        if self.ground is None:
            return points[..., 2] - self.origin[2]
        return points[..., 2] - bilinear(self.ground, (points[..., :2] - self.origin[:2]) / self.cell)

    @cached_property
    def surface_below(self) -> np.ndarray:
        """Highest point of ground and roofs below each centre, anywhere in its column, (nx, ny, nz) [m].

        Roofs are taken from the buildings, exactly; from the voxels where the city knows none.
        """
        levels = self.coordinates(2)
        surface = np.empty(self.shape)
        surface[:] = np.minimum(self.range_of_ground[1][..., None], levels)
        if self.buildings:
            for building in self.buildings:
                raise_surface(building, surface, levels, self.cell, self.origin)
        else:
            above_ground = levels - self.cell / 2 >= self.range_of_ground[1][..., None]
            tops = np.where(self.occupied & above_ground, levels + self.cell / 2, surface)
            surface = np.maximum.accumulate(tops, axis=2)
        return locked(surface)

    @cached_property
    def height_above_surface(self) -> np.ndarray:
        """Height of each centre above what lies below it in its column, see `surface_below`, (nx, ny, nz) [m].

        0 in an obstacle.
        """
        return locked(np.where(self.occupied, 0.0, np.maximum(self.coordinates(2) - self.surface_below, 0.0)))

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

    @cached_property
    def runs(self) -> Runs:
        """The occupied voxels as boxes, one above the other in each column, for compiled code."""
        return runs_of(self.occupied)

    def segment_distance(
        self, start: npt.ArrayLike, end: npt.ArrayLike, *, at_most: npt.ArrayLike = np.inf
    ) -> np.ndarray:
        """Least distance of straight lines, all along, to the nearest obstacle's surface.

        Parameters
        ----------
        start, end : (..., 3) arrays
            [m]; of what lies beyond the map nothing is known, only the obstacles on it count.
        at_most : float, or (...) array
            Where it is more than this [m], this is given instead, and found sooner.

        Returns
        -------
        (...) array
            [m]; exact; 0 through an obstacle, infinite where there is none at all.

        Raises
        ------
        ValueError
            If `start` or `end` haven't shape (..., 3) or are not finite, or `at_most` is negative.
        """
        first, last = np.broadcast_arrays(checked_points(start), checked_points(end))
        checks.refuse(np.asarray(at_most), np.asarray(at_most) >= 0, "at_most must be a distance in metres, at least 0")
        shape = np.broadcast_shapes(first.shape[:-1], np.shape(at_most))
        within = np.broadcast_to(np.asarray(at_most, dtype=float) / self.cell, shape).flatten()
        starts, ends = (
            np.array(np.broadcast_to((points - self.origin) / self.cell, (*shape, 3))).reshape(-1, 3)
            for points in (first, last)
        )
        distances = segment_clearances(self.runs, self.clearance, self.cell, starts, ends, within)
        return self.cell * distances.reshape(shape)

    def is_free_line(self, start: npt.ArrayLike, end: npt.ArrayLike, min_clearance: float = 0.0) -> np.ndarray:
        """Whether straight lines are free of obstacles all along, exactly: a line of sight.

        Parameters
        ----------
        start, end : (..., 3) arrays
            [m]
        min_clearance : float
            Least distance that the line has to keep to obstacles [m]; with 0 it must not touch one.

        Returns
        -------
        (...) bool array
            False for a line that leaves the map.

        Raises
        ------
        ValueError
            If `start` or `end` haven't shape (..., 3) or are not finite, or `min_clearance` is negative.
        """
        keep = checks.not_negative_number("min_clearance", min_clearance)
        distance = self.segment_distance(start, end, at_most=keep + TOUCH * self.cell)
        clear = (distance >= keep - TOUCH * self.cell) & (distance > 0.5 * TOUCH * self.cell)
        return clear & self.inside(start) & self.inside(end)

    def blocked(self, min_clearance: float = 0.0, *, min_height: float = 0.0, max_height: float = np.inf) -> np.ndarray:
        """Where a UAV may not be: obstacles and what is near them, no-fly zones, and what is too low or too high.

        Parameters
        ----------
        min_clearance : float
            Least clearance allowed [m]; 0 leaves every free voxel open.
        min_height, max_height : float
            Least and greatest height above ground [m]. They hold for every point of a route in the voxel: above the
            highest ground in its column, below the lowest; for its centre, as for `min_clearance`.

        Returns
        -------
        (nx, ny, nz) bool array
            Not to be written to.

        Raises
        ------
        ValueError
            If `min_clearance` or `min_height` is negative or not finite, or `max_height` not above `min_height`.
        """
        checks.number("min_clearance", min_clearance)
        if not (np.isfinite(min_clearance) and min_clearance >= 0):
            raise ValueError(f"min_clearance must be a distance in metres, at least 0, got {min_clearance!r}")
        check_heights(min_height, max_height)
        blocked = self.occupied
        if min_clearance > 0:
            blocked = self.clearance < max(min_clearance - 1e-9 * self.cell, TINY)
        if self.no_fly:
            blocked = blocked | self.in_no_fly
        if min_height > 0 or max_height < np.inf:
            blocked = blocked | self.out_of_heights(min_height, max_height)
        return locked(blocked)

    def out_of_heights(self, min_height: float, max_height: float) -> np.ndarray:
        """Which voxels' centres are too low or too high above ground, (nx, ny, nz) bool, see `blocked`."""
        lowest, highest = self.range_of_ground
        levels = self.coordinates(2)
        too_low = levels < (highest + (min_height - 1e-9))[..., None]
        return too_low | (levels > (lowest + (max_height + 1e-9))[..., None])

    @cached_property
    def in_no_fly(self) -> np.ndarray:
        """Which voxels no-fly zones reach into, (nx, ny, nz) bool."""
        inside = np.zeros(self.shape, dtype=bool)
        for zone in self.no_fly:
            rasterise(self.zone_building(zone).hulls, inside, self.cell, self.origin, "touched")
        return locked(inside)

    def zone_building(self, zone: NoFlyZone) -> Building:
        """A no-fly zone as a body on this map: cut off at the map's top and bottom [m]."""
        (low, high), column = self.bounds[:, 2], np.zeros(self.shape[:2], dtype=bool)
        for piece in zone.pieces(low, high):
            column |= touches(Building((piece,)), self.shape, self.cell, self.origin)
        lowest, highest = self.range_of_ground
        if column.any():
            low, high = (
                np.clip(zone.lower + lowest[column].min(), low, high - 1e-3),
                np.clip(zone.upper + highest[column].max(), low + 1e-3, high),
            )
        return Building(tuple(zone.pieces(low, max(high, low + 1e-3))), zone.name)

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

    def code_of(self, index: npt.ArrayLike, *, as_printed: bool = False) -> np.ndarray:
        """Node codes of voxels (..., 3): k + nz·(j + ny·i), the position in `occupied.ravel()`.

        Parameters
        ----------
        index : (..., 3) array of int
        as_printed : bool
            Number them as RISK-ACO does (section 1): from left to right, from the back to the front, from the top down.
            We take left to be west, the back north, and begin with 1: 1 + i + nx·((ny − 1 − j) + ny·(nz − 1 − k)).

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
        if checks.flag("as_printed", as_printed):
            nx, ny, nz = self.shape
            return 1 + index[..., 0] + nx * ((ny - 1 - index[..., 1]) + ny * (nz - 1 - index[..., 2]))
        return np.ravel_multi_index(tuple(np.moveaxis(index, -1, 0)), self.shape)

    def index_of(self, code: npt.ArrayLike, *, as_printed: bool = False) -> np.ndarray:
        """Indices (..., 3) of the voxels with these node codes; the inverse of `code_of`.

        Raises
        ------
        ValueError
            If a code is not between 0 and the number of voxels.
        """
        first = 1 if checks.flag("as_printed", as_printed) else 0
        code = np.asarray(code)
        beyond = (code < first) | (code >= self.occupied.size + first)
        if beyond.any():
            raise ValueError(
                f"code must be from {first} to {self.occupied.size - 1 + first}, got {code[beyond].flat[0]}"
            )
        if as_printed:
            nx, ny, nz = self.shape
            k, j, i = np.unravel_index(code - first, (nz, ny, nx))
            return np.stack([i, ny - 1 - j, nz - 1 - k], axis=-1)
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
        """Name of what is in the voxel of a point [m]: a building, the ground, or "an obstacle"."""
        voxel = self.center_of(self.cell_of(point)) - self.cell / 2
        for building in self.buildings:
            here = np.zeros((1, 1, 1), dtype=bool)
            rasterise(building.hulls, here, self.cell, voxel, "touched")
            if here.any():
                return f"building {building.name!r}"
        return "the ground" if self.ground is not None else "an obstacle"

    def zone_at(self, point: npt.ArrayLike) -> str:
        """Name of a no-fly zone that reaches into the voxel of a point [m]; empty if there is none."""
        voxel = self.center_of(self.cell_of(point)) - self.cell / 2
        for zone in self.no_fly:
            here = np.zeros((1, 1, 1), dtype=bool)
            rasterise(self.zone_building(zone).hulls, here, self.cell, voxel, "touched")
            if here.any():
                return zone.name
        return ""

    def to_geographic(self, points: npt.ArrayLike) -> np.ndarray:
        """Longitude and latitude [degrees, WGS84] and height of points (..., 3) [m] of this map, (..., 3).

        The height [m] is in the vertical system of the file that the city was read from.

        Raises
        ------
        ValueError
            If the city has no `reference`, or `points` hasn't shape (..., 3) or is not finite.
        """
        points, place = checked_points(points), self.checked_reference()
        lonlat = place.longitude_latitude(points[..., :2])
        return np.concatenate([lonlat, points[..., 2:] + place.height], axis=-1)

    def from_geographic(self, points: npt.ArrayLike) -> np.ndarray:
        """Points (..., 3) [m] of this map from longitudes, latitudes and heights (..., 3), see `to_geographic`.

        Raises
        ------
        ValueError
            If the city has no `reference`, or `points` hasn't shape (..., 3), is not finite, or out of range.
        """
        points, place = checked_points(points), self.checked_reference()
        checks.within("points: latitudes", points[..., 1], -90.0, 90.0, "degrees (order: longitude, latitude, height)")
        return np.concatenate([place.east_north(points[..., :2]), points[..., 2:] - place.height], axis=-1)

    def checked_reference(self) -> Place:
        """The reference; `ValueError` with the cure where there is none."""
        if self.reference is None:
            raise ValueError(
                f"{self.name!r} doesn't know where on Earth it lies: read it with crs=..., or give City its "
                "reference=(longitude, latitude, height) of x = y = z = 0"
            )
        return self.reference

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
        rng = checks.generator("rng", rng)
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
