"""A city of more voxels than fit into memory: they are made where somebody looks.

What looks only around a point, a line or a route asks for windows: some columns of the map, at their whole height. A
window has the voxels that the whole map would have, to the last one, whatever its corner. What needs all voxels at once
is refused, and told how to ask for less.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import Any, NoReturn

import numpy as np
import numpy.typing as npt
import shapely

from uavlab import checks
from uavlab.city.buildings import Building
from uavlab.city.extent import (
    MOST_LAZY,
    MOST_VOXELS,
    check_segments,
    checked_bound,
    locked,
)
from uavlab.city.model import City
from uavlab.city.near import WIDEST, near_voxels, reaches_of
from uavlab.city.numbering import MOST_PAIRS, TRIES, whole_numbers
from uavlab.city.place import Place
from uavlab.city.rasterise import Window, mark_ground, rasterise
from uavlab.city.segments import runs_of, segment_distances
from uavlab.city.source import Source
from uavlab.city.voxels import least_kept, put_clearance
from uavlab.city.zones import NoFlyZone

TILE = 64
"""Lines are looked at in pieces of so many cells, together with others that are near."""

MARGINS = (16, 64)
"""Obstacles are looked for within so many cells, all at once; farther away building by building, the nearest first."""

ENDLESS = 2.0**40
"""No distance is more [cells]."""

MOST_KEPT = 256
"""More min_clearance [cells] is refused: what surrounds a block of columns would be hundreds of millions of voxels."""


@dataclass(frozen=True, eq=False, repr=False)
class LazyCity(City):
    """A city whose voxels are made where they are asked for, as `City.from_buildings(..., lazy=True)` gives it.

    `astar`, `Route.clearance`, `is_free`, `is_free_line`, `segment_distance`, `distance` and
    `random_pairs` work as on any city, as they look only locally. `occupied`, `clearance`, `blocked` and whatever else
    has a value for each voxel is a `ValueError`; `part` gives a plain city of what is around a route.

    Attributes
    ----------
    extent : (nx, ny, nz) tuple
        Number of voxels along x, y and z.
    level : float, or None
        Height of the ground [m], solid below. None: the bottom of the map is the ground, and no obstacle.
    cell, origin, buildings, name, reference, no_fly, source
        As for `City`; `ground` is None.

    Raises
    ------
    ValueError
        If `extent` is not three whole numbers of at least 1, or has over 100 billion voxels; `level` is not finite;
        `ground` is given; or another attribute is what `City` refuses.

    See Also
    --------
    City.from_buildings : makes one.
    LazyCity.part : a plain `City` of some of it.

    Examples
    --------
    Ten by ten kilometres, with a tower in the middle.

    >>> from uavlab.city import Building, City
    >>> tower = Building.prism([(5000, 5000), (5030, 5000), (5030, 5020), (5000, 5020)], 80, name="tower")
    >>> city = City.from_buildings([tower], origin=(0, 0, 0), size=(10_000, 10_000, 120), lazy=True)
    >>> city
    <LazyCity city: 10000 × 10000 × 120 voxels of 1 m, 1 buildings>
    >>> city.is_free([(5010, 5010, 40), (5010, 5010, 90)]).tolist(), float(city.distance((5010, 5010, 90)))
    ([False, True], 10.0)
    >>> city.part((5010, 5010, 40), margin=50)
    <City city: 101 × 101 × 120 voxels of 1 m, 1 buildings>
    """

    occupied: np.ndarray = field(init=False)
    extent: tuple[int, int, int] = field(default=(0, 0, 0), kw_only=True)
    level: float | None = field(default=None, kw_only=True)

    def __post_init__(self) -> None:
        if np.array_equal(self.extent, (0, 0, 0)):
            raise ValueError("extent is missing: make a lazy city by City.from_buildings(..., lazy=True)")
        counts = whole_numbers("extent", self.extent)
        if counts.shape != (3,) or counts.min() < 1:
            raise ValueError(f"extent must be three whole numbers of at least 1, got {self.extent!r}")
        extent = tuple(counts.tolist())
        if np.prod(extent, dtype=float) > MOST_LAZY:
            raise ValueError(f"extent {extent} has more than {MOST_LAZY:,} voxels: use a larger cell or a smaller size")
        if self.ground is not None:
            raise ValueError("ground can't be given to a lazy city: it is level, at the height `level`")
        if self.level is not None:
            object.__setattr__(self, "level", checks.number("level", self.level, checks.finite))
        object.__setattr__(self, "extent", extent)
        self.check_names()

    def __getattribute__(self, name: str) -> Any:
        if name in WHOLE:
            refuse(self, name)
        return object.__getattribute__(self, name)

    @property
    def shape(self) -> tuple[int, int, int]:
        """Number of voxels along x, y and z."""
        return self.extent

    @cached_property
    def range_of_ground(self) -> tuple[np.ndarray, np.ndarray]:
        """Lowest and highest ground in each column, (nx, ny) each [m]: the same everywhere."""
        level = self.origin[2] if self.level is None else self.level
        everywhere = np.broadcast_to(np.float64(level), self.shape[:2])
        return everywhere, everywhere

    def height_above_ground(self, points: npt.ArrayLike) -> np.ndarray:
        """Height of points above the ground, as on any city; see `City.height_above_ground`.

        Parameters
        ----------
        points : (..., 3) array
            [m]

        Returns
        -------
        (...) array
            [m]
        """
        points = checks.array("points", points, ..., 3)
        return points[..., 2] - (self.origin[2] if self.level is None else self.level)

    @cached_property
    def plans(self) -> shapely.STRtree:
        """Where to look for buildings: the boxes around them."""
        low, high = (np.array([building.bounds[end, :2] for building in self.buildings]) for end in (0, 1))
        return shapely.STRtree(shapely.box(*low.T, *high.T) if self.buildings else [])

    @cached_property
    def boxes(self) -> tuple[np.ndarray, np.ndarray]:
        """Lowest and highest corners of what buildings occupy [cells], and up to a voxel more, (N, 3) each."""
        low, high = (np.array([building.bounds[n] for building in self.buildings]).reshape(-1, 3) for n in (0, 1))
        return (low - self.origin) / self.cell - 1.0, (high - self.origin) / self.cell + 1.0

    @cached_property
    def solid(self) -> np.ndarray:
        """Number of voxels along x, y and z that the ground fills, (3,), from the corner of the map."""
        column = np.zeros((1, 1, self.shape[2]), dtype=bool)
        if self.level is not None:
            mark_ground(column, np.full((1, 1), self.level), self.cell, self.origin[2])
        return np.array([*self.shape[:2], np.count_nonzero(column)], float)

    @cached_property
    def zones(self) -> tuple[Building, ...]:
        """No-fly zones as bodies."""
        return tuple(self.zone_building(zone) for zone in self.no_fly)

    def buildings_over(self, first: tuple[int, int], count: tuple[int, int]) -> list[Building]:
        """The buildings that may reach into columns from `first` on, in their order."""
        low = self.origin[:2] + self.cell * (np.array(first) - 1.0)
        high = low + self.cell * (np.array(count) + 2.0)
        return [self.buildings[n] for n in np.sort(self.plans.query(shapely.box(*low, *high)))]

    def window(self, first: tuple[int, int], count: tuple[int, int]) -> np.ndarray:
        """Occupied voxels of the columns from `first` (i, j) on, (*count, nz) bool."""
        occupied = np.zeros((*count, self.shape[2]), dtype=bool)
        if self.level is not None:
            mark_ground(occupied, np.full(count, self.level), self.cell, self.origin[2])
        hulls = [hull for building in self.buildings_over(first, count) for hull in building.hulls]
        rasterise(hulls, occupied, self.cell, self.origin, "touched", Window(first, self.shape[:2]))
        return occupied

    def blocked_window(
        self, first: tuple[int, int], count: tuple[int, int], min_clearance: float, min_height: float, max_height: float
    ) -> np.ndarray:
        """`City.blocked` of the columns from `first` on, which must lie on the map, (*count, nz) bool."""
        check_kept(self, min_clearance)
        reach = int(np.ceil(min_clearance / self.cell)) + 1
        low, high = np.maximum(np.array(first) - reach, 0), np.minimum(np.array(first) + count + reach, self.shape[:2])
        occupied = self.window((int(low[0]), int(low[1])), (int(high[0] - low[0]), int(high[1] - low[1])))
        i, j = np.array(first) - low
        blocked = nearer_than(occupied, min_clearance, self.cell)[i : i + count[0], j : j + count[1]].copy()
        for zone in self.zones:
            rasterise(zone.hulls, blocked, self.cell, self.origin, "touched", Window(first, self.shape[:2]))
        levels, ground = self.coordinates(2), self.range_of_ground[0][0, 0]
        blocked |= (levels < ground + (min_height - 1e-9)) & (min_height > 0)  # as in `City.out_of_heights`
        blocked |= levels > ground + (max_height + 1e-9)
        return blocked

    def part(self, around: Any, *, margin: float = 50.0) -> City:
        """A plain city of what is around a route, a curve or points, at the whole height of the map.

        Its voxels are those that the whole map has there; beyond its border nothing is known.

        Parameters
        ----------
        around : Route, Curve, or (..., 3) array
            Or anything else with `points`, or points themselves [m].
        margin : float
            How far it reaches beyond them, along x and y [m], at least 0.

        Returns
        -------
        City
            In the same coordinates, with the buildings that reach into it.

        Raises
        ------
        ValueError
            If `around` has no points of three finite numbers, or none near the map; `margin` is negative; or the part
            would have over 500 million voxels.

        See Also
        --------
        City.from_buildings : a lazy city.

        Examples
        --------
        A map for a flight, which needs all voxels that it might come to.

        >>> from uavlab.city import City, table1_buildings
        >>> city = City.from_buildings(table1_buildings(), origin=(0, 0, 0), size=(5000, 5000, 100), lazy=True)
        >>> around = city.part([(5, 5, 30), (95, 95, 30)], margin=20.0)
        >>> around, round(float(around.clearance.max()), 1)
        (<City city: 116 × 116 × 100 voxels of 1 m, 5 buildings>, 59.6)
        """
        points = checks.array("around", getattr(around, "points", around), ..., 3).reshape(-1, 3)
        margin = checks.not_negative_number("margin", margin)
        if not len(points):
            raise ValueError("around has no points")
        cells = (points[:, :2] - self.origin[:2]) / self.cell
        ends = np.clip([cells.min(axis=0) - margin / self.cell, cells.max(axis=0) + margin / self.cell], -1, 2.0**40)
        first = np.maximum(np.floor(ends[0]).astype(int), 0)
        last = np.minimum(np.floor(ends[1]).astype(int) + 1, self.shape[:2])
        if (first >= last).any():
            raise ValueError(f"around must have points near the map, within {margin:g} m, got {points[0].tolist()}")
        count = int(last[0] - first[0]), int(last[1] - first[1])
        if count[0] * count[1] * self.shape[2] > MOST_VOXELS:
            raise ValueError(
                f"around {count[0] * self.cell:g} × {count[1] * self.cell:g} m is a part of more than {MOST_VOXELS:,} "
                "voxels: take it around less of the way, or with a smaller margin"
            )
        corner = int(first[0]), int(first[1])
        ground = None if self.level is None else np.full(count, self.level)
        return City(
            locked(self.window(corner, count)), self.cell, self.origin + self.cell * np.array([*corner, 0.0]),
            tuple(self.buildings_over(corner, count)), self.name, self.reference, ground, self.no_fly, self.source,
        )  # fmt: skip

    def is_free(self, points: npt.ArrayLike) -> np.ndarray:
        """Whether points lie in free voxels, as on any city; see `City.is_free`.

        Parameters
        ----------
        points : (..., 3) array
            [m]

        Returns
        -------
        (...) bool array
        """
        index = self.cell_of(points)
        free = np.array(np.all((index >= 0) & (index < self.shape), axis=-1))
        tiles = index[..., :2] // TILE
        for a, b in np.unique(tiles[free], axis=0).tolist():
            here = np.array(free & (tiles == (a, b)).all(axis=-1))
            i, j, k = index[here].T
            count = (min(TILE, self.shape[0] - a * TILE), min(TILE, self.shape[1] - b * TILE))
            free[here] = ~self.window((a * TILE, b * TILE), count)[i - a * TILE, j - b * TILE, k]
        return free[()]

    def distance(self, points: npt.ArrayLike, exact_within: float | None = None) -> np.ndarray:
        """Distance from points to the nearest obstacle's surface; see `City.distance`.

        Parameters
        ----------
        points : (..., 3) array
            [m]
        exact_within : float, optional
            Isn't needed: it is exact at any distance.

        Returns
        -------
        (...) array
            [m]
        """
        if exact_within is not None:
            checked_bound("exact_within", checks.number("exact_within", exact_within))
        points = checks.array("points", points, ..., 3)
        return self.segment_distance(points, points)

    def segment_distance(
        self, start: npt.ArrayLike, end: npt.ArrayLike, *, at_most: npt.ArrayLike = np.inf
    ) -> np.ndarray:
        """Least distance of straight lines to the nearest obstacle, as on any city; see `City.segment_distance`.

        Parameters
        ----------
        start, end : (..., 3) arrays
            [m]
        at_most : float, or (...) array
            [m]

        Returns
        -------
        (...) array
            [m]
        """
        first, last = checks.array("start", start, ..., 3), checks.array("end", end, ..., 3)
        bound = checked_bound("at_most", at_most)
        shape = check_segments(first, last, bound)
        starts, ends = (
            np.broadcast_to((points - self.origin) / self.cell, (*shape, 3)).reshape(-1, 3) for points in (first, last)
        )
        least = np.broadcast_to(bound / self.cell, shape).flatten()
        if self.buildings or self.level is not None:
            pieces = np.maximum(np.ceil(np.linalg.norm(ends - starts, axis=1) / TILE).astype(int), 1)
            of = np.repeat(np.arange(len(starts)), pieces)
            share = (np.arange(len(of)) - np.repeat(np.cumsum(pieces) - pieces, pieces)) / pieces[of]
            step = (ends - starts) / pieces[:, None]
            begin = starts[of] + share[:, None] * (ends - starts)[of]
            lower_distances(self, begin, begin + step[of], of, least)
        return self.cell * least.reshape(shape)

    def random_pairs(
        self, count: int, rng: np.random.Generator | int, *, apart: float = 40.0, min_clearance: float = 0.0
    ) -> np.ndarray:
        """Starts and goals for experiments, see `City.random_pairs`; a seed gives others than on a plain city."""
        count, rng = checks.whole("count", count, 1, MOST_PAIRS), checks.generator("rng", rng)
        apart = checks.not_negative_number("apart", apart)
        keep = checks.not_negative_number("min_clearance", min_clearance)
        pairs: list[np.ndarray] = []
        for _ in range(TRIES * count):
            index = rng.integers(self.shape, size=(2, 3))
            ends = self.center_of(index)
            if np.linalg.norm(ends[1] - ends[0]) >= apart and not any(is_blocked(self, one, keep) for one in index):
                pairs.append(ends)
            if len(pairs) == count:
                return np.array(pairs)
        raise ValueError(
            f"no {count} pairs found that are apart={apart:g} m and min_clearance={keep:g} m from obstacles"
        )


def lower_distances(city: LazyCity, starts: np.ndarray, ends: np.ndarray, of: np.ndarray, least: np.ndarray) -> None:
    """Lower the distances [cells] of lines (M,) to those of their short pieces (N, 3), piece n of line `of[n]`."""
    left = np.arange(len(starts))
    for margin in MARGINS:
        tiles = np.floor((starts[left, :2] + ends[left, :2]) / 2 / TILE).astype(np.int64)
        _, group = np.unique(tiles, axis=0, return_inverse=True)
        far = []
        for n in range(group.max(initial=-1) + 1):
            here = left[group.ravel() == n]
            bound = np.minimum(least[of[here]], margin)
            found = near_distances(city, starts[here], ends[here], bound)
            np.minimum.at(least, of[here], np.where(found < bound, found, np.inf))
            far.append(here[found >= margin])
        left = np.concatenate([*far, left[:0]])
        left = left[least[of[left]] > margin]
    for n in left.tolist():
        least[of[n]] = far_distance(city, starts[n], ends[n], least[of[n]])


def near_distances(city: LazyCity, starts: np.ndarray, ends: np.ndarray, at_most: np.ndarray) -> np.ndarray:
    """Distances [cells] of lines near each other, from one window; at_most (N,) where nothing is nearer."""
    corners = np.concatenate([starts[:, :2], ends[:, :2]])
    reach = at_most.max() + 1.0
    first = np.clip(np.floor(corners.min(axis=0) - reach).astype(np.int64), 0, np.array(city.shape[:2]) - 1)
    last = np.clip(np.ceil(corners.max(axis=0) + reach).astype(np.int64), first + 1, city.shape[:2])
    corner, count = (int(first[0]), int(first[1])), (int(last[0] - first[0]), int(last[1] - first[1]))
    if city.level is None and not city.buildings_over(corner, count):
        return at_most
    offset = np.array([*first, 0.0])
    return segment_distances(runs_of(city.window(corner, count)), starts - offset, ends - offset, at_most)


def far_distance(city: LazyCity, start: np.ndarray, end: np.ndarray, at_most: float) -> float:
    """Distance [cells] of a line that is far from all obstacles: one after the other, the nearest boxes first."""
    low, high = city.boxes
    least = at_most if city.level is None else min(at_most, distance_to_corner_box(start, end, city.solid))
    apart = np.maximum(np.maximum(low - np.maximum(start, end), np.minimum(start, end) - high), 0.0)
    lower = np.linalg.norm(apart, axis=1)
    for n in np.argsort(lower, kind="stable"):
        if lower[n] >= least:
            break
        first = np.maximum(np.floor(low[n, :2]).astype(np.int64), 0)
        count = np.minimum(np.ceil(high[n, :2]).astype(np.int64), city.shape[:2]) - first
        if (count <= 0).any():
            continue
        runs = runs_of(city.window((int(first[0]), int(first[1])), (int(count[0]), int(count[1]))))
        offset, bound = np.array([*first, 0.0]), min(least, ENDLESS)
        found = float(segment_distances(runs, (start - offset)[None], (end - offset)[None], np.array([bound]))[0])
        least = found if found < bound else least
    return least


def distance_to_corner_box(start: np.ndarray, end: np.ndarray, high: np.ndarray) -> float:
    """Least distance of a straight line to the box from (0, 0, 0) to `high`, infinite if that is flat."""
    if high.min() <= 0:
        return np.inf
    with np.errstate(divide="ignore", invalid="ignore"):
        faces = np.concatenate([-start, high - start]) / np.tile(end - start, 2)
    shares = np.unique(np.clip([0.0, 1.0, *faces[np.isfinite(faces)]], 0.0, 1.0))
    points = start + shares[:, None] * (end - start)
    gaps = points - np.clip(points, 0.0, high)  # a straight line between any two shares
    steps = np.diff(gaps, axis=0)
    squares = np.sum(steps**2, axis=1)
    share = np.clip(-np.sum(gaps[:-1] * steps, axis=1) / np.where(squares > 0, squares, 1.0), 0.0, 1.0)
    return float(np.linalg.norm(gaps[:-1] + share[:, None] * steps, axis=1).min())


def is_blocked(city: LazyCity, index: np.ndarray, min_clearance: float) -> bool:
    """`City.blocked` of one voxel."""
    i, j, k = index.tolist()
    return bool(city.blocked_window((i, j), (1, 1), min_clearance, 0.0, np.inf)[0, 0, k])


def lazy_city(
    buildings: Sequence[Building], cell: float, corner: np.ndarray, extent: tuple[int, int, int], level: float | None,
    name: str, reference: Place | None, no_fly: tuple[NoFlyZone, ...], source: Source | None,
) -> LazyCity:  # fmt: skip
    """What `City.from_buildings` gives with `lazy`."""
    return LazyCity(cell, corner, tuple(buildings), name, reference, None, no_fly, source, extent=extent, level=level)


def check_kept(city: LazyCity, min_clearance: float) -> None:
    """`ValueError` if windows can't hold what is so near [m] to a block."""
    if min_clearance > MOST_KEPT * city.cell:
        raise ValueError(
            f"min_clearance of {min_clearance:g} m is more than {MOST_KEPT} voxels, too much for a lazy city: ask for "
            "less, or make the city with a larger cell"
        )


def nearer_than(occupied: np.ndarray, min_clearance: float, cell: float) -> np.ndarray:
    """Which voxels (nx, ny, nz) are less than `min_clearance` [m] from occupied ones of them."""
    if min_clearance <= WIDEST * cell:
        return near_voxels(occupied, reaches_once(min_clearance, cell)) if min_clearance > 0 else occupied
    clearance = np.empty(occupied.shape)
    put_clearance(occupied, cell, clearance)
    return clearance < least_kept(min_clearance, cell)


WHOLE = (
    "occupied", "clearance", "runs", "wall_normal", "surface_below", "height_above_surface", "in_no_fly",
    "blocked", "out_of_heights", "towards_wall", "clearance_along",
)  # fmt: skip
"""What has a value for each voxel."""


def refuse(city: LazyCity, what: str) -> NoReturn:
    """`ValueError` for what would need everything."""
    count = int(np.prod(city.shape, dtype=np.int64))
    cure = "make the city without lazy=True" if count <= MOST_VOXELS else "make the city with a larger cell"
    raise ValueError(
        f"{what} needs all {count:,} voxels of {city.name!r}, which a lazy city never has at once: take "
        f"city.part(around=..., margin=...), a plain City, or {cure}"
    )


def check_plain(city: City, what: str) -> None:
    """`ValueError` unless it is a city that has all of its voxels at once."""
    checks.instance("city", city, City)
    if isinstance(city, LazyCity):
        refuse(city, what)


@lru_cache(8)
def reaches_once(min_clearance: float, cell: float) -> np.ndarray:
    """`reaches_of` a distance that is asked for block by block."""
    return reaches_of(min_clearance, cell, WIDEST + 2)
