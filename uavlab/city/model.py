"""The city as planners see it: a box of voxels, free or occupied, and the distance to the nearest wall.

A voxel (i, j, k) covers `origin + cell·[i, i+1)` on each axis, its centre is the node that planners visit. A voxel is
occupied when a building or the ground reaches into it, so that what is free is free. Outside of the box nothing may
fly; the border itself is no obstacle. A city without `ground` has the papers' open floor, which is none either.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.city.buildings import Building
from uavlab.city.extent import (
    check_segments,
    checked_bound,
    checked_cell,
    checked_grid,
    checked_ground,
    checked_heights,
    checked_occupied,
    checked_origin,
    extent_and_ground,
    lazy_extent,
    locked,
)
from uavlab.city.near import WIDEST, near_obstacles
from uavlab.city.numbering import MOST_PAIRS, checked_index, codes_of, indices_of, pairs_apart, whole_numbers
from uavlab.city.place import Place, place_of
from uavlab.city.rasterise import bilinear, mark_ground, range_of_ground, rasterise, reaches_into, surface_below
from uavlab.city.segments import Runs, runs_of, segment_clearances
from uavlab.city.source import Source
from uavlab.city.terrain import Terrain, checked_terrain
from uavlab.city.voxels import SURFACE, distances_to_obstacle, least_kept, put_clearance, voxels_on_polyline
from uavlab.city.zones import NoFlyZone, body_of, checked_zones


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
        If `occupied` is not a three-dimensional array with voxels in it, has masked ones or others than True, False,
        1 and 0; `cell` is not above 0 and finite; `origin` is not three finite numbers; `buildings` or `no_fly` has
        something else than buildings or zones; `name` is no text; `reference` is no place on Earth; `ground` hasn't one
        finite height for each column; or `source` is no `Source`.

    See Also
    --------
    City.from_buildings : rasterises buildings.
    read_city : reads a city from a file.
    table1_city : the city of REPARE.

    Examples
    --------
    >>> import numpy as np
    >>> from uavlab.city import City
    >>> occupied = np.zeros((5, 1, 3), dtype=bool)
    >>> occupied[2, 0, :2] = True  # a tower of two voxels
    >>> city = City(occupied, cell=10.0, name="tower")
    >>> city
    <City tower: 5 × 1 × 3 voxels of 10 m, 0 buildings>
    >>> city.clearance[:, 0, 0]
    array([15.,  5.,  0.,  5., 15.])
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
        occupied = checked_occupied(self.occupied)
        self.check_names()
        if self.ground is not None:
            object.__setattr__(self, "ground", checked_ground(self.ground, occupied.shape[:2]))
            solid = occupied.copy()
            mark_ground(solid, self.range_of_ground[1], self.cell, self.origin[2])
            occupied = locked(solid)
        object.__setattr__(self, "occupied", occupied)

    def check_names(self) -> None:
        """Check and set all but the voxels and the ground; `City` does it when it is made."""
        object.__setattr__(self, "origin", checked_origin(self.origin))
        object.__setattr__(self, "cell", checked_cell(self.cell))
        buildings = checks.several("buildings", self.buildings, Building, least=0)
        object.__setattr__(self, "buildings", tuple(buildings))
        object.__setattr__(self, "name", checks.text("name", self.name))
        object.__setattr__(self, "no_fly", checked_zones(self.no_fly))
        if self.source is not None:
            checks.instance("source", self.source, Source)
        if self.reference is not None:
            object.__setattr__(self, "reference", place_of("reference", self.reference))

    def __repr__(self) -> str:
        shape = " × ".join(map(str, self.shape))
        return (
            f"<{type(self).__name__} {self.name}: {shape} voxels of {self.cell:g} m, {len(self.buildings)} buildings>"
        )

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
        lazy: bool = False,
    ) -> City:
        """Rasterise buildings and the ground that they stand on.

        Voxel (i, j, k) is occupied when a building or the ground reaches into origin + cell·[i, i+1) × [j, j+1) ×
        [k, k+1).

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
        lazy : bool
            Make voxels where somebody looks, for maps that don't fit into memory: up to 100 billion voxels, on level
            ground. What needs all of them at once is refused; see `uavlab.city.LazyCity`.

        Returns
        -------
        City

        Raises
        ------
        ValueError
            If `buildings` is no list of `Building`, or is empty and `origin` or `size` is missing; `cell` or `size` is
            not above 0; `margin` is negative; `origin` is not three finite numbers; `terrain` is neither terrain nor a
            finite number, doesn't cover the map, or has a reference system; `voxels` is none of the two; the map would
            have over 500 million voxels; `lazy` isn't True or False, or comes with ground that isn't level, with
            "centres" or with over 100 billion voxels; or `name`, `reference`, `source` or `no_fly` is what `City`
            refuses.

        See Also
        --------
        read_city : reads buildings from a file and does this.
        Building.prism : a building to begin with.
        Terrain.from_raster : ground that isn't level.

        References
        ----------
        The touched voxels are found with the clipping of I. E. Sutherland and G. W. Hodgman, "Reentrant polygon
        clipping", Communications of the ACM, 1974.

        Examples
        --------
        A wall of 0.3 m is thinner than a voxel. By the rule of centres it disappears.

        >>> from uavlab.city import Building, City
        >>> wall = Building.prism([(0, 0), (20, 0), (20, 0.3), (0, 0.3)], 10)
        >>> city = City.from_buildings([wall], margin=5)
        >>> city, int(city.occupied.sum())
        (<City city: 30 × 11 × 15 voxels of 1 m, 1 buildings>, 200)
        >>> int(City.from_buildings([wall], margin=5, voxels="centres").occupied.sum())
        0
        """
        buildings = checks.several("buildings", buildings, Building, least=0)
        cell, margin = checked_grid(cell, margin, voxels)
        terrain, zones = checked_terrain(terrain), checked_zones(no_fly)
        if checks.flag("lazy", lazy):
            from uavlab.city.lazy import lazy_city

            extent = lazy_extent(buildings, cell, origin, size, margin, terrain, voxels)
            return lazy_city(buildings, cell, *extent, name, reference, zones, source)
        corner, shape, ground, top = extent_and_ground(buildings, cell, origin, size, margin, terrain)
        occupied = np.zeros(shape, dtype=bool)
        if top is not None:
            mark_ground(occupied, top, cell, corner[2])
        hulls = (hull for building in buildings for hull in building.hulls)
        rasterise(hulls, occupied, cell, corner, voxels)
        return cls(locked(occupied), cell, corner, tuple(buildings), name, reference, ground, zones, source)

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

        See Also
        --------
        City.distance : from any points.

        References
        ----------
        P. F. Felzenszwalb and D. P. Huttenlocher, "Distance transforms of sampled functions", Theory of
        Computing, 2012.

        Examples
        --------
        >>> import numpy as np
        >>> from uavlab.city import City
        >>> City(np.array([[[False]], [[False]], [[True]]]), cell=2.0).clearance.ravel()
        array([3., 1., 0.])
        """
        clearance = np.empty(self.shape)
        put_clearance(self.occupied, self.cell, clearance)
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
        """How much of a vector points towards the nearest wall, max(0, −v·n), with n the `wall_normal`.

        Parameters
        ----------
        vector : (3,) array
            (east, north, up), in any unit, such as a wind [m/s].

        Returns
        -------
        (nx, ny, nz) array
            In the unit of the vector; 0 where it points away from the wall, or where there is none.

        Raises
        ------
        ValueError
            If `vector` is not three finite numbers.

        See Also
        --------
        City.clearance_along : how far the wall is on the way of an offset.

        Examples
        --------
        A wind of 6 m/s to the north pushes towards the frustum from the voxel south of it, not from the one farther
        south, which is as near to another building.

        >>> from uavlab.city import table1_city
        >>> city = table1_city(cell=5.0)
        >>> push = city.towards_wall((0.0, 6.0, 0.0))
        >>> [round(float(push[tuple(city.cell_of(point))]), 2) for point in [(82.5, 57.5, 32.5), (82.5, 52.5, 32.5)]]
        [6.0, 0.0]
        """
        direction = checks.array("vector", vector, 3)
        if not direction.any():
            return np.zeros(self.shape)
        return np.maximum(0.0, self.wall_normal @ -direction)

    def clearance_along(self, offset: npt.ArrayLike, *, at_most: float = np.inf) -> np.ndarray:
        """Least distance to obstacles on the way from each voxel's centre to where an offset takes it.

        min over 0 ≤ t ≤ 1 of D(c + t·offset), with the centre c and the distance D to the nearest obstacle.

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
            If `offset` isn't two or three finite numbers, or `at_most` is not one number of at least 0.

        See Also
        --------
        City.segment_distance : the same for straight lines from anywhere.
        City.towards_wall : which way the nearest wall is.

        Examples
        --------
        The voxel is 2.5 m from the building south of it. The wind carries away from it, the other way against it.

        >>> from uavlab.city import table1_city
        >>> city = table1_city(cell=5.0)
        >>> here = tuple(city.cell_of((82.5, 47.5, 32.5)))
        >>> [round(float(city.clearance_along((0.0, north))[here]), 2) for north in (5.0, -2.0, -4.0)]
        [2.5, 0.5, 0.0]
        """
        way = np.array(checks.three("offset", offset))
        at_most = float(checked_bound("at_most", checks.number("at_most", at_most)))
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
        """Height of points above the ground below them, z − g(x, y): bilinear between the columns' centres.

        Beyond the border of the map the ground goes on as it is at it.

        Parameters
        ----------
        points : (..., 3) array
            [m]

        Returns
        -------
        (...) array
            [m]; negative below the ground. Without terrain, above the bottom of the map.

        Raises
        ------
        ValueError
            If `points` hasn't shape (..., 3) or is not finite.

        See Also
        --------
        City.blocked : keeps routes between heights above ground.

        Examples
        --------
        >>> from uavlab.city import City, table1_buildings
        >>> city = City.from_buildings(table1_buildings(), cell=5.0, terrain=12.0)
        >>> city.height_above_ground([(80, 50, 30), (80, 50, 8)])
        array([18., -4.])
        """
        points = checks.array("points", points, ..., 3)
        if self.ground is None:
            return points[..., 2] - self.origin[2]
        return points[..., 2] - bilinear(self.ground, (points[..., :2] - self.origin[:2]) / self.cell)

    @cached_property
    def surface_below(self) -> np.ndarray:
        """Highest point of ground and roofs below each centre, anywhere in its column, (nx, ny, nz) [m].

        Roofs are taken from the buildings, exactly; from the voxels where the city knows none.
        """
        ground, levels = self.range_of_ground[1], self.coordinates(2)
        return locked(surface_below(self.buildings, self.occupied, ground, levels, self.cell, self.origin))

    @cached_property
    def height_above_surface(self) -> np.ndarray:
        """Height of each centre above what lies below it in its column, see `surface_below`, (nx, ny, nz) [m].

        0 in an obstacle.
        """
        return locked(np.where(self.occupied, 0.0, np.maximum(self.coordinates(2) - self.surface_below, 0.0)))

    def distance(self, points: npt.ArrayLike, exact_within: float | None = None) -> np.ndarray:
        """Distance from points to the nearest obstacle's surface, where `clearance` has it from centres only.

        D(p) = min |p − q| over all points q of occupied voxels.

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

        See Also
        --------
        City.segment_distance : of straight lines, all along.
        City.is_free : whether points lie in obstacles.

        Examples
        --------
        >>> from uavlab.city import table1_city
        >>> city = table1_city(cell=5.0)
        >>> city.distance([(80, 50, 30), (80, 70, 30)])
        array([5., 0.])
        >>> far = (5, 95, 90)
        >>> round(float(city.distance(far)), 2), round(float(city.distance(far, exact_within=50)), 2)
        (33.34, 35.0)
        """
        points = checks.array("points", points, ..., 3)
        cells = np.ascontiguousarray((points.reshape(-1, 3) - self.origin) / self.cell)
        within = 4.0 * self.cell if exact_within is None else checks.number("exact_within", exact_within)
        near = float(checked_bound("exact_within", within)) / self.cell
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

        min over 0 ≤ t ≤ 1 of D(start + t·(end − start)), with the distance D of a point as in `distance`.

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
            If `start` or `end` hasn't shape (..., 3) or is not finite, `at_most` is negative, or the three have shapes
            that don't go together.

        See Also
        --------
        City.is_free_line : whether the line keeps a distance.
        uavlab.route.Route.clearance : of a whole route.

        Examples
        --------
        Between two buildings, and straight through one.

        >>> from uavlab.city import table1_city
        >>> city = table1_city(cell=5.0)
        >>> city.segment_distance([(60, 52, 30), (5, 5, 30)], [(95, 52, 30), (95, 95, 30)]).round(2)
        array([7., 0.])
        """
        first, last = checks.array("start", start, ..., 3), checks.array("end", end, ..., 3)
        bound = checked_bound("at_most", at_most)
        shape = check_segments(first, last, bound)
        within = np.broadcast_to(bound / self.cell, shape).flatten()
        starts, ends = (
            np.array(np.broadcast_to((points - self.origin) / self.cell, (*shape, 3)), order="C").reshape(-1, 3)
            for points in (first, last)
        )
        distances = segment_clearances(self.runs, self.clearance, self.cell, starts, ends, within)
        return self.cell * distances.reshape(shape)

    def is_free_line(self, start: npt.ArrayLike, end: npt.ArrayLike, min_clearance: float = 0.0) -> np.ndarray:
        """Whether straight lines are free of obstacles all along, exactly: a line of sight.

        Parameters
        ----------
        start, end : (..., 3) arrays
            Their ends [m].
        min_clearance : float
            Least distance that the line has to keep to obstacles [m]; with 0 it must not touch one.

        Returns
        -------
        (...) bool array
            False for a line that leaves the map.

        Raises
        ------
        ValueError
            If `start` or `end` hasn't shape (..., 3) or is not finite, or `min_clearance` is negative or not finite.

        See Also
        --------
        City.segment_distance : how far from obstacles the line is.
        City.is_free : the same for points.

        Examples
        --------
        >>> from uavlab.city import table1_city
        >>> city = table1_city(cell=5.0)
        >>> city.is_free_line((60, 52, 30), [(95, 52, 30), (95, 95, 30)]).tolist()
        [True, False]
        >>> bool(city.is_free_line((60, 52, 30), (95, 52, 30), min_clearance=8.0))
        False
        """
        keep = checks.not_negative_number("min_clearance", min_clearance)
        distance = self.segment_distance(start, end, at_most=keep + SURFACE * self.cell)
        clear = (distance >= keep - SURFACE * self.cell) & (distance > 0.5 * SURFACE * self.cell)
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

        See Also
        --------
        City.is_free : asks only for obstacles.
        City.out_of_heights : the part of the heights alone.

        Examples
        --------
        A seventh of REPARE's map is built. A clearance of 5 m closes more than a third of it.

        >>> from uavlab.city import table1_city
        >>> city = table1_city(cell=5.0)
        >>> [int(city.blocked(clearance).sum()) for clearance in (0.0, 5.0)], city.occupied.size
        ([1162, 2844], 8000)
        >>> int(city.blocked(5.0, min_height=20.0, max_height=60.0).sum())
        6352
        """
        min_clearance = checks.number("min_clearance", min_clearance)
        if not (np.isfinite(min_clearance) and min_clearance >= 0):
            raise ValueError(f"min_clearance must be a distance in metres, at least 0, got {min_clearance:g}")
        min_height, max_height = checked_heights(min_height, max_height)
        blocked = self.occupied
        if min_clearance > 0:
            if "clearance" in vars(self) or min_clearance > WIDEST * self.cell:
                blocked = self.clearance < least_kept(min_clearance, self.cell)
            else:
                blocked = near_obstacles(self, min_clearance)
        if self.no_fly:
            blocked = blocked | self.in_no_fly
        if min_height > 0 or max_height < np.inf:
            blocked = blocked | self.out_of_heights(min_height, max_height)
        return locked(blocked)

    def out_of_heights(self, min_height: float, max_height: float) -> np.ndarray:
        """Which voxels' centres are too low or too high above ground, as `blocked` counts it.

        Parameters
        ----------
        min_height, max_height : float
            Least and greatest height above ground [m]; infinite for no upper limit.

        Returns
        -------
        (nx, ny, nz) bool array

        Raises
        ------
        ValueError
            If `min_height` is negative or not finite, or `max_height` not above it.

        See Also
        --------
        City.blocked : with obstacles and no-fly zones.
        City.height_above_ground : height of points.

        Examples
        --------
        >>> from uavlab.city import table1_city
        >>> city = table1_city(cell=5.0)
        >>> outside = city.out_of_heights(20.0, 60.0)
        >>> city.coordinates(2)[~outside[0, 0]]
        array([22.5, 27.5, 32.5, 37.5, 42.5, 47.5, 52.5, 57.5])
        """
        min_height, max_height = checked_heights(min_height, max_height)
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
        """A no-fly zone as a body on this map: cut off at the map's top and bottom.

        Parameters
        ----------
        zone : NoFlyZone

        Returns
        -------
        Building
            From `lower` above the lowest ground below the zone to `upper` above the highest [m].

        Raises
        ------
        ValueError
            If `zone` is no `NoFlyZone`.

        See Also
        --------
        NoFlyZone.pieces : its pieces between any two heights.
        City.zone_at : which zone is at a point.

        Examples
        --------
        >>> from uavlab.city import NoFlyZone, table1_city
        >>> airway = NoFlyZone([(0, 0), (20, 0), (20, 100), (0, 100)], lower=30.0, name="airway")
        >>> table1_city(cell=5.0).zone_building(airway)  # the map ends at 100 m
        <Building airway: 1 convex piece, 20 × 100 m, z from 30 to 100 m>
        """
        checks.instance("zone", zone, NoFlyZone)
        return body_of(zone, self.range_of_ground, self.bounds, self.shape, self.cell)

    def cell_of(self, points: npt.ArrayLike) -> np.ndarray:
        """Indices of the voxels in which points lie, ⌊(p − origin) / cell⌋.

        Parameters
        ----------
        points : (..., 3) array
            [m]

        Returns
        -------
        (..., 3) int array
            Out of range outside of the map; −1 for NaN.

        Raises
        ------
        ValueError
            If `points` hasn't shape (..., 3).

        See Also
        --------
        City.center_of : from indices to centres.
        City.inside : whether the indices are on the map.

        Examples
        --------
        >>> from uavlab.city import table1_city
        >>> city = table1_city(cell=5.0)
        >>> city.cell_of([(80, 50, 30), (-1, 50, 30)])
        array([[16, 10,  6],
               [-1, 10,  6]])
        """
        points = checks.array("points", points, ..., 3, finite=False)
        index = np.floor((points - self.origin) / self.cell)
        return np.where(np.abs(index) < 2.0**62, index, -1).astype(np.int64)

    def coordinates(self, axis: int) -> np.ndarray:
        """Coordinates of the centres along an axis, origin + cell·(i + ½).

        Parameters
        ----------
        axis : int
            0 east, 1 north, 2 up.

        Returns
        -------
        (n,) array
            [m]

        Raises
        ------
        ValueError
            If `axis` is none of the three.

        See Also
        --------
        City.center_of : centres of single voxels.

        Examples
        --------
        >>> from uavlab.city import table1_city
        >>> table1_city(cell=25.0).coordinates(0)
        array([12.5, 37.5, 62.5, 87.5])
        """
        if checks.whole("axis", axis, 0) > 2:
            raise ValueError(f"axis must be 0 (east), 1 (north) or 2 (up), got {axis}")
        return self.origin[axis] + self.cell * (np.arange(self.shape[axis]) + 0.5)

    def center_of(self, index: npt.ArrayLike) -> np.ndarray:
        """Centres of voxels, origin + cell·(index + ½): the nodes that planners visit.

        Parameters
        ----------
        index : (..., 3) array of int
            May lie outside of the map.

        Returns
        -------
        (..., 3) array
            [m]

        Raises
        ------
        ValueError
            If `index` hasn't shape (..., 3) or whole numbers.

        See Also
        --------
        City.cell_of : the inverse.

        Examples
        --------
        >>> from uavlab.city import table1_city
        >>> table1_city(cell=5.0).center_of((16, 10, 6))
        array([82.5, 52.5, 32.5])
        """
        return self.origin + self.cell * (checked_index(index) + 0.5)

    def code_of(self, index: npt.ArrayLike, *, as_printed: bool = False) -> np.ndarray:
        """Node codes of voxels: k + nz·(j + ny·i), the position in `occupied.ravel()`.

        Parameters
        ----------
        index : (..., 3) array of int
            Voxels (i, j, k) of the map.
        as_printed : bool
            Number them as RISK-ACO does (section 1): from left to right, from the back to the front, from the top down.
            We take left to be west, the back north, and begin with 1: 1 + i + nx·((ny − 1 − j) + ny·(nz − 1 − k)).

        Returns
        -------
        (...) int array

        Raises
        ------
        ValueError
            If `index` hasn't shape (..., 3) or whole numbers, or lies outside of the map, or `as_printed` isn't True or
            False.

        See Also
        --------
        City.index_of : the inverse.

        Examples
        --------
        The lowest corner in the south-west comes first; as printed, it is one of the last.

        >>> from uavlab.city import table1_city
        >>> city = table1_city(cell=5.0)
        >>> int(city.code_of((0, 0, 0))), int(city.code_of((0, 0, 0), as_printed=True))
        (0, 7981)
        """
        return codes_of(checked_index(index), self.shape, checks.flag("as_printed", as_printed))

    def index_of(self, code: npt.ArrayLike, *, as_printed: bool = False) -> np.ndarray:
        """Indices of the voxels with these node codes; the inverse of `code_of`.

        Parameters
        ----------
        code : int, or array of them
            From 0 to one less than the number of voxels; as printed, from 1 to their number.
        as_printed : bool
            As for `code_of`.

        Returns
        -------
        (..., 3) int array

        Raises
        ------
        ValueError
            If `code` is no whole number or out of its range, or `as_printed` isn't True or False.

        See Also
        --------
        City.code_of : the inverse.

        Examples
        --------
        >>> from uavlab.city import table1_city
        >>> city = table1_city(cell=5.0)
        >>> city.index_of(6606), int(city.code_of(city.index_of(6606)))
        (array([16, 10,  6]), 6606)
        """
        return indices_of(whole_numbers("code", code), self.shape, checks.flag("as_printed", as_printed))

    def inside(self, points: npt.ArrayLike) -> np.ndarray:
        """Whether points lie in the map's box, origin ≤ p < origin + cell·shape.

        Parameters
        ----------
        points : (..., 3) array
            [m]

        Returns
        -------
        (...) bool array
            False for NaN.

        Raises
        ------
        ValueError
            If `points` hasn't shape (..., 3).

        See Also
        --------
        City.is_free : and in no obstacle.

        Examples
        --------
        >>> from uavlab.city import table1_city
        >>> table1_city(cell=5.0).inside([(0, 0, 0), (50, 50, 100)]).tolist()  # the upper end belongs to the next voxel
        [True, False]
        """
        index = self.cell_of(points)
        return np.all((index >= 0) & (index < self.shape), axis=-1)

    def is_free(self, points: npt.ArrayLike) -> np.ndarray:
        """Whether points lie in free voxels; outside of the map is not free, a no-fly zone is.

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
            If `points` hasn't shape (..., 3).

        See Also
        --------
        City.is_free_line : the same for straight lines.
        City.distance : how far from obstacles they lie.
        City.blocked : voxels that are closed for planners.

        Examples
        --------
        >>> from uavlab.city import table1_city
        >>> city = table1_city(cell=5.0)
        >>> city.is_free([(80, 50, 30), (80, 70, 30), (80, 120, 30)]).tolist()  # free, in a building, off the map
        [True, False, False]
        """
        index = self.cell_of(points)
        inside = np.all((index >= 0) & (index < self.shape), axis=-1)
        index = np.where(inside[..., None], index, 0)
        return inside & ~self.occupied[tuple(np.moveaxis(index, -1, 0))]

    def building_at(self, point: npt.ArrayLike) -> str:
        """Name of what occupies the voxel of a point, for messages.

        Parameters
        ----------
        point : (3,) array
            In an occupied voxel [m]; whether it is occupied is not looked at.

        Returns
        -------
        str
            A building that reaches into the voxel; where there is none, the ground of a city that has some, else
            "an obstacle".

        Raises
        ------
        ValueError
            If `point` hasn't shape (3,) or is not finite.

        See Also
        --------
        City.is_free : whether the voxel is occupied at all.
        City.zone_at : the no-fly zone at a point.

        Examples
        --------
        >>> from uavlab.city import table1_city
        >>> table1_city(cell=5.0).building_at((80, 70, 30))
        "building '3 frustum'"
        """
        voxel = self.center_of(self.cell_of(checks.array("point", point, 3))) - self.cell / 2
        for building in self.buildings:
            if reaches_into(building, voxel, self.cell):
                return f"building {building.name!r}"
        return "the ground" if self.ground is not None else "an obstacle"

    def zone_at(self, point: npt.ArrayLike) -> str:
        """Name of a no-fly zone that reaches into the voxel of a point.

        Parameters
        ----------
        point : (3,) array
            [m]

        Returns
        -------
        str
            Of the first such zone; empty if there is none.

        Raises
        ------
        ValueError
            If `point` hasn't shape (3,) or is not finite.

        See Also
        --------
        City.building_at : what occupies the voxel.
        NoFlyZone : what a zone is.

        Examples
        --------
        >>> import dataclasses
        >>> from uavlab.city import NoFlyZone, table1_city
        >>> park = NoFlyZone([(0, 0), (10, 0), (10, 10), (0, 10)], upper=40.0, name="park")
        >>> city = dataclasses.replace(table1_city(cell=5.0), no_fly=[park])
        >>> city.zone_at((5, 5, 30)), city.zone_at((5, 5, 50))
        ('park', '')
        """
        voxel = self.center_of(self.cell_of(checks.array("point", point, 3))) - self.cell / 2
        for zone in self.no_fly:
            if reaches_into(self.zone_building(zone), voxel, self.cell):
                return zone.name
        return ""

    def to_geographic(self, points: npt.ArrayLike) -> np.ndarray:
        """Longitude, latitude and height of points of this map.

        The height is in the vertical system of the file that the city was read from: z plus that of the `reference`.

        Parameters
        ----------
        points : (..., 3) array
            [m]

        Returns
        -------
        (..., 3) array
            Longitude and latitude [degrees, WGS84], and height [m].

        Raises
        ------
        ValueError
            If the city has no `reference`, or `points` hasn't shape (..., 3) or is not finite.

        See Also
        --------
        City.from_geographic : the inverse.
        Place.longitude_latitude : without heights.

        Examples
        --------
        >>> import numpy as np
        >>> from uavlab.city import City
        >>> city = City(np.zeros((20, 20, 10), dtype=bool), 5.0, reference=(13.3777, 52.5163, 34.0))
        >>> city.to_geographic((100, 0, 30)).round(4)
        array([13.3792, 52.5163, 64.    ])
        """
        points, place = checks.array("points", points, ..., 3), self.checked_reference()
        lonlat = place.longitude_latitude(points[..., :2])
        return np.concatenate([lonlat, points[..., 2:] + place.height], axis=-1)

    def from_geographic(self, points: npt.ArrayLike) -> np.ndarray:
        """Points of this map from longitudes, latitudes and heights: the inverse of `to_geographic`.

        Parameters
        ----------
        points : (..., 3) array
            Longitude and latitude [degrees, WGS84], and height [m] in the city's vertical system.

        Returns
        -------
        (..., 3) array
            [m]

        Raises
        ------
        ValueError
            If the city has no `reference`, or `points` hasn't shape (..., 3), is not finite, or has a latitude that is
            not from −90 to 90.

        See Also
        --------
        City.to_geographic : the inverse.

        Examples
        --------
        >>> import numpy as np
        >>> from uavlab.city import City
        >>> city = City(np.zeros((20, 20, 10), dtype=bool), 5.0, reference=(13.3777, 52.5163, 34.0))
        >>> city.from_geographic((13.3787, 52.5168, 64.0)).round(1)
        array([67.9, 55.6, 30. ])
        """
        points, place = checks.array("points", points, ..., 3), self.checked_reference()
        checks.within("points: latitudes", points[..., 1], -90.0, 90.0, "degrees (order: longitude, latitude, height)")
        return np.concatenate([place.east_north(points[..., :2]), points[..., 2:] - place.height], axis=-1)

    def checked_reference(self) -> Place:
        """The reference; `ValueError` with the cure where there is none.

        Returns
        -------
        Place

        Raises
        ------
        ValueError
            If `reference` is None.

        See Also
        --------
        City.to_geographic : what needs it.

        Examples
        --------
        >>> import numpy as np
        >>> from uavlab.city import City
        >>> City(np.zeros((4, 4, 4), dtype=bool), reference=(13.3777, 52.5163)).checked_reference()
        Place(longitude=13.3777, latitude=52.5163, height=0.0)
        """
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
            How many pairs, at most 100 000.
        rng : numpy.random.Generator or int
            A generator, or the seed of one.
        apart : float
            Least straight distance between start and goal [m], at least 0.
        min_clearance : float
            Least distance of both to obstacles [m]; 0 allows every free voxel.

        Returns
        -------
        (count, 2, 3) float array
            Start and goal of each pair [m].

        Raises
        ------
        ValueError
            If `count` is not from 1 to 100 000, `rng` is neither generator nor seed, `apart` or `min_clearance` is
            negative or not finite, or no such pairs are found, the two being too much for this city.

        See Also
        --------
        City.blocked : where starts and goals may not be.

        Examples
        --------
        >>> import numpy as np
        >>> from uavlab.city import table1_city
        >>> pairs = table1_city(cell=5.0).random_pairs(100, rng=7, apart=60.0)
        >>> pairs.shape, bool((np.linalg.norm(pairs[:, 1] - pairs[:, 0], axis=1) >= 60.0).all())
        ((100, 2, 3), True)
        """
        count, rng = checks.whole("count", count, 1, MOST_PAIRS), checks.generator("rng", rng)
        apart = checks.not_negative_number("apart", apart)
        allowed = np.flatnonzero(~self.blocked(min_clearance))
        pairs = pairs_apart(allowed, self.shape, self.cell, self.origin, count, rng, apart)
        if len(pairs) < count:
            extents = " × ".join(f"{extent:g}" for extent in np.ptp(self.bounds, axis=0))
            raise ValueError(
                f"no {count} pairs found that are apart={apart:g} m from each other and "
                f"min_clearance={min_clearance:g} m from obstacles; the map measures {extents} m"
            )
        return np.array(pairs)

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

        See Also
        --------
        uavlab.route.Route.integral : sums values over them.

        References
        ----------
        J. Amanatides and A. Woo, "A fast voxel traversal algorithm for ray tracing", Eurographics, 1987.

        Examples
        --------
        >>> from uavlab.city import table1_city
        >>> index, length = table1_city(cell=5.0).voxels_along([(2.5, 2.5, 2.5), (12.5, 7.5, 2.5)])
        >>> index.tolist(), length.round(2)
        ([[0, 0, 0], [1, 0, 0], [1, 1, 0], [2, 1, 0]], array([2.8, 2.8, 2.8, 2.8]))
        """
        points = checks.array("points", points, None, 3)
        if len(points) < 2:
            return self.cell_of(points), np.zeros(len(points))
        return voxels_on_polyline(points, self.cell, self.origin)
