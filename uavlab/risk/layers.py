"""Layers of the ground for any city: population from a raster, cars from road lines, shelter from what stands there.

Each gives one number per column of voxels, (nx, ny), for `RiskMap`. Rasters and roads count by the share of a column
that they cover, so that nobody is lost or counted twice, and narrow roads on coarse maps keep their cars.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
import shapely

from uavlab import checks
from uavlab.city import City
from uavlab.city.columns import share_out
from uavlab.city.lazy import check_plain
from uavlab.city.place import System, system_of
from uavlab.city.terrain import COVERED, checked_raster
from uavlab.risk.rates import CARS_PER_KM, LANE_WIDTH, SHELTER, vehicle_share

HIGH_BUILDING = 10.0
"""From this height on [m] a building counts as high; the papers draw no line."""

LONGEST_MITRE = 1.5
"""Of half the width: beyond it the outside of a bend is cut off, or a hairpin would reach far beyond the road."""

SHORTEST_ROAD = 0.1
"""A road that is shorter [m] is one in degrees: 0.1° are 10 km."""


PER = {None: 1.0, "m²": 1.0, "km²": 1e-6, "pixel": 1.0}
"""What values of a raster are per; a layer of people is per m²."""


def raster_layer(
    city: City,
    values: npt.ArrayLike,
    bounds: Sequence[float],
    *,
    crs: Any = None,
    per: str | None = None,
    fill: float | None = None,
) -> np.ndarray:
    """A raster on the columns of a city, shared out by area: its sum over the map stays what it was.

    A column has Σ vᵢ Aᵢ / Σ Aᵢ, with the area Aᵢ that it shares with pixel i of value vᵢ.

    Parameters
    ----------
    city : City
        On whose columns it is brought.
    values : (rows, columns) array
        As in a picture: the first row lies in the north, the first column in the west. NaN, or masked: no data.
    bounds : (west, south, east, north)
        Of the whole raster: in metres of the city, or in the coordinates of `crs`.
    crs : anything that pyproj takes, optional
        The reference system of the bounds, such as "EPSG:4326" for degrees; the city must know its `reference`.
    per : {None, "m²", "km²", "pixel"}
        None, "m²": values are taken as they are, as a mean over the area of a column. "km²": and divided by a million.
        "pixel": counts of each pixel, divided by its area. With the last three `RiskMap` takes it as a density.
    fill : float, optional
        What to take where the raster says nothing, in the unit of the values; without it that is an error.

    Returns
    -------
    (nx, ny) array
        In the unit of the values, or per m² where `per` is given.

    Raises
    ------
    ValueError
        If `values` isn't two-dimensional, has something infinite, or is below 0 with `per`; `bounds` are not in order
        or lie elsewhere; `per` is none of its words; `crs` is no system that pyproj knows; `city` has no `reference`
        for it, or is no `City`; `fill` is not one finite number, or is below 0 with `per`; or the raster doesn't cover
        the city and there is no `fill`.

    See Also
    --------
    read_people : people from a file.
    road_layer : cars from the lines of roads.
    uavlab.city.Terrain.from_raster : heights of the ground from a raster.

    References
    ----------
    Pixels are cut to columns as in I. E. Sutherland and G. W. Hodgman, "Reentrant polygon clipping", Communications of
    the ACM, 1974.

    Examples
    --------
    Two pixels with 30 and 6 people, brought to three columns of 100 m: people per m², and people.

    >>> import numpy as np
    >>> from uavlab.city import City
    >>> from uavlab.risk import raster_layer
    >>> city = City(np.zeros((3, 1, 1), dtype=bool), cell=100.0)
    >>> people = raster_layer(city, [[30, 6]], (0, 0, 300, 100), per="pixel")
    >>> people.ravel().round(5), (people * 100**2).ravel().round(1)
    (array([0.002 , 0.0012, 0.0004]), array([20., 12.,  4.]))
    """
    check_plain(city, "a layer of a risk map")
    factor = PER[per] if per is None else PER[checks.one_of("per", per, [name for name in PER if name])]
    raster, edges = checked_raster("values", values, bounds)
    if fill is not None:
        fill = checks.number("fill", fill)
        (checks.finite if per is None else checks.not_negative)("fill", fill)
    system = None if crs is None else system_of(crs)
    raster, edges = part_around(city, raster, edges, system)
    if per is not None and (raster < 0).any():
        raise ValueError(
            f"values per {per} must be at least 0, {np.count_nonzero(raster < 0)} on the map are not, the lowest "
            f"{np.nanmin(raster):g}: if it stands for no data, make it NaN, or mask it"
        )
    quads = pixels_of(city, raster.shape, edges, system)
    known = np.isfinite(raster.ravel())
    amounts = raster.ravel() * factor
    if per == "pixel":
        amounts = amounts / (city.cell**2 * areas_of(quads))
    sums, areas = np.zeros(city.shape[:2]), np.zeros(city.shape[:2])
    share_out(quads[known], amounts[known], sums, areas)
    missing = areas < COVERED
    if missing.any() and fill is None:
        raise ValueError(
            f"values say nothing about {missing.sum()} of the city's {missing.size} columns, or parts of them "
            "(outside of bounds, or no data); give a larger raster, or say with fill what to take there"
        )
    if fill is None:
        return sums / areas
    filled = fill * factor if per != "pixel" else fill / (city.cell**2 * float(np.mean(areas_of(quads))))
    return sums + np.maximum(1.0 - areas, 0.0) * filled


def part_around(
    city: City, raster: np.ndarray, edges: np.ndarray, system: System | None
) -> tuple[np.ndarray, np.ndarray]:
    """The pixels of a raster that may lie on the map, and their bounds; `ValueError` if there are none."""
    border = border_of(city, system)
    rows, columns = raster.shape
    width, height = (edges[2] - edges[0]) / columns, (edges[3] - edges[1]) / rows
    first_column, last_column = (np.array([border[:, 0].min(), border[:, 0].max()]) - edges[0]) / width
    first_row, last_row = (edges[3] - np.array([border[:, 1].max(), border[:, 1].min()])) / height
    if last_column <= 0 or first_column >= columns or last_row <= 0 or first_row >= rows:
        ranges = ", ".join(f"{border[:, a].min():g} to {border[:, a].max():g}" for a in range(2))
        unit = "m (in degrees? say crs='EPSG:4326')" if system is None else f"in {system.name}"
        raise ValueError(f"bounds must lie around the city, which is at {ranges} {unit}, got {edges.tolist()}")
    c0, c1 = max(int(np.floor(first_column)) - 1, 0), min(int(np.ceil(last_column)) + 1, columns)
    r0, r1 = max(int(np.floor(first_row)) - 1, 0), min(int(np.ceil(last_row)) + 1, rows)
    part = np.array([edges[0] + c0 * width, edges[3] - r1 * height, edges[0] + c1 * width, edges[3] - r0 * height])
    return raster[r0:r1, c0:c1], part


def border_of(city: City, system: System | None) -> np.ndarray:
    """Points (N, 2) around the map, in metres of the city or in a system."""
    (west, south), (east, north) = city.bounds[:, :2]
    along = np.linspace(0.0, 1.0, 33)
    border = np.concatenate(
        [np.column_stack([west + along * (east - west), np.full(33, y)]) for y in (south, north)]
        + [np.column_stack([np.full(33, x), south + along * (north - south)]) for x in (west, east)]
    )
    return border if system is None else system.from_lonlat(city.checked_reference().longitude_latitude(border))


def pixels_of(city: City, shape: tuple[int, ...], edges: np.ndarray, system: System | None) -> np.ndarray:
    """Corners of all pixels, row by row, (rows · columns, 4, 2) [cells from the corner of the map]."""
    x, y = np.linspace(edges[0], edges[2], shape[1] + 1), np.linspace(edges[3], edges[1], shape[0] + 1)
    corners = np.stack(np.meshgrid(x, y), axis=-1)
    if system is not None:
        corners = city.checked_reference().east_north(system.to_lonlat(corners))
    corners = (corners - city.origin[:2]) / city.cell
    quads = [corners[1:, :-1], corners[1:, 1:], corners[:-1, 1:], corners[:-1, :-1]]
    return np.stack(quads, axis=2).reshape(-1, 4, 2)


def areas_of(quads: np.ndarray) -> np.ndarray:
    """Areas (N,) of quadrilaterals (N, 4, 2), from their diagonals."""
    one, other = quads[:, 2] - quads[:, 0], quads[:, 3] - quads[:, 1]
    return np.abs(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]) / 2


def road_layer(
    city: City,
    lines: Sequence[npt.ArrayLike],
    width: float | Sequence[float],
    *,
    cars_per_km: float | Sequence[float] = CARS_PER_KM,
    lane_width: float = LANE_WIDTH,
    crs: Any = None,
) -> np.ndarray:
    """Share of the ground that cars cover, from the middle lines of roads: for `RiskMap(vehicle_share=...)`.

    Parameters
    ----------
    city : City
        On whose columns they are brought.
    lines : sequence of (M, 2) arrays
        Middle line of each road, x and y [m], or in the coordinates of `crs`.
    width : float, or one for each line
        Of the roadway [m], above 0.
    cars_per_km : float, or one for each line
        K, cars per kilometre of a lane, at least 0.
    lane_width : float
        D_road [m], above 0.
    crs : anything that pyproj takes, optional
        The reference system of the lines, such as "EPSG:4326" for degrees; the city must know its `reference`.

    Returns
    -------
    (nx, ny) array
        C·(share of the column that roads cover). Where roads overlap, the busier counts.

    Raises
    ------
    ValueError
        If `lines` is no list, or one of them hasn't shape (M, 2) with M of at least 2, is not finite or shorter than
        0.1 m; `width` or `cars_per_km` is neither one number nor one for each line; `width` or `lane_width` is not
        above 0; `cars_per_km` is negative, or more than fit on a lane; `crs` is no system that pyproj knows; or `city`
        has no `reference` for it, or is no `City`.

    See Also
    --------
    vehicle_share : C of a road.
    osm_layers : roads from a file.

    Examples
    --------
    A road of two lanes and 40 m with 10 cars per km of each has 0.8 cars, of 8.4 m² each.

    >>> import numpy as np
    >>> from uavlab.city import City
    >>> from uavlab.risk import road_layer
    >>> city = City(np.zeros((8, 3, 1), dtype=bool), cell=5.0)
    >>> share = road_layer(city, [[(0, 7.5), (40, 7.5)]], 6.0, cars_per_km=10.0)
    >>> share[0].round(4), round(float(share.sum() * 5.0**2 / 8.4), 3)
    (array([0.0028, 0.028 , 0.0028]), 0.8)
    """
    check_plain(city, "a layer of a risk map")
    if not isinstance(lines, Sequence | np.ndarray):
        raise ValueError(f"lines must be a list of lines (M, 2), got {type(lines).__name__}")
    widths, densities = (
        per_line(name, value, len(lines)) for name, value in (("width", width), ("cars_per_km", cars_per_km))
    )
    checks.positive("width", widths)
    covered = vehicle_share(densities, checks.number("lane_width", lane_width))
    system = None if crs is None else system_of(crs)
    busiest = np.argsort(-covered, kind="stable")
    roadways = [roadway(checked_line(f"lines[{n}]", lines[n], city, system), widths[n]) for n in busiest]
    own = without_sooner(shapely.intersection(roadways, shapely.box(*city.bounds[:, :2].ravel())))
    polygons, road = shapely.get_parts(own, return_index=True)
    flat = shapely.get_type_id(polygons) == shapely.GeometryType.POLYGON  # else it only touches
    triangles, part = shapely.get_parts(shapely.constrained_delaunay_triangles(polygons[flat]), return_index=True)
    corners = shapely.get_coordinates(triangles).reshape(-1, 4, 2)[:, :3]
    layer, unused = np.zeros(city.shape[:2]), np.zeros(city.shape[:2])
    share_out((corners - city.origin[:2]) / city.cell, covered[busiest][road[flat][part]], layer, unused)
    return np.minimum(layer, 1.0)


def roadway(line: np.ndarray, width: float) -> shapely.Polygon:
    """The area of a road, from end to end of its line; the outside of sharp bends is cut off."""
    return shapely.LineString(line).buffer(width / 2, cap_style="flat", join_style="mitre", mitre_limit=LONGEST_MITRE)


def without_sooner(areas: np.ndarray) -> np.ndarray:
    """What each of several areas has for itself: without what those before it cover."""
    pairs = shapely.STRtree(areas).query(areas, predicate="intersects")
    later, sooner = pairs[:, np.argsort(pairs[0], kind="stable")]
    later, sooner = later[sooner < later], sooner[sooner < later]
    own = areas.copy()
    for number in np.unique(later):
        first, last = np.searchsorted(later, [number, number + 1])
        own[number] = areas[number].difference(shapely.union_all(areas[sooner[first:last]]))
    return own


def checked_line(name: str, line: npt.ArrayLike, city: City, system: System | None) -> np.ndarray:
    """A line (M, 2) in metres of a city; `ValueError` if it is none, or so short that it is one in degrees."""
    points = checks.numbers(name, line)
    if points.ndim != 2 or points.shape[1] != 2 or len(points) < 2 or not np.isfinite(points).all():
        raise ValueError(f"{name} must be at least two finite points (M, 2), got shape {points.shape}")
    if system is not None:
        points = city.checked_reference().east_north(system.to_lonlat(points))
    if np.ptp(points, axis=0).max() < SHORTEST_ROAD:
        cure = "in degrees it needs crs='EPSG:4326'" if system is None else f"is crs, {system.name}, its own?"
        raise ValueError(f"{name} lies within {SHORTEST_ROAD:g} m; {cure}")
    return np.asarray(points)


def shelter_layer(city: City, ground: npt.ArrayLike = "none", *, high: float = HIGH_BUILDING) -> np.ndarray:
    """Shelter p_s of each column: 0.5 under low buildings, 0.75 under high ones, as given elsewhere.

    Parameters
    ----------
    city : City
        Whose roofs give shelter.
    ground : name, number, or (nx, ny) array of either
        Open ground: "none", "sparse trees", "trees or low buildings", "high buildings", "industry" (PSO-BAS
        Table 1), or p_s itself.
    high : float
        Height of roofs above the ground from which a building counts as high [m], at least 0.

    Returns
    -------
    (nx, ny) array
        p_s, 0 to 1.

    Raises
    ------
    ValueError
        If `ground` has a name that is none of Table 1's, a number that is not from 0 to 1, or another shape than the
        city's ground plan; `high` is negative or not finite; or `city` is no `City`.

    See Also
    --------
    osm_layers : open ground from a file.
    impact_fatality : what shelter is for.

    Examples
    --------
    >>> from uavlab.city import Building, City
    >>> from uavlab.risk import shelter_layer
    >>> shed = Building.prism([(5, 0), (10, 0), (10, 5), (5, 5)], 4)
    >>> tower = Building.prism([(10, 0), (15, 0), (15, 5), (10, 5)], 40)
    >>> city = City.from_buildings([shed, tower], cell=5.0, origin=(0, 0, 0), size=(20, 5, 50))
    >>> shelter_layer(city, "sparse trees").ravel()
    array([0.25, 0.5 , 0.75, 0.25])
    """
    check_plain(city, "a layer of a risk map")
    checks.not_negative_number("high", high)
    open_ground = shelter_of(ground)
    if open_ground.shape not in ((), city.shape[:2]):
        raise ValueError(f"ground must have the city's ground plan {city.shape[:2]}, got {open_ground.shape}")
    ground, top = city.range_of_ground[1], city.bounds[1, 2]
    roof = np.round(np.where(city.occupied[..., -1], top, city.surface_below[..., -1]) - ground, 5)
    built = np.where(roof >= high, SHELTER["high buildings"], SHELTER["trees or low buildings"])
    return np.where(roof > 0, built, open_ground)


def shelter_of(ground: npt.ArrayLike) -> np.ndarray:
    """Shelter p_s of open ground, given by itself or by the names of Table 1."""
    try:
        names = np.asarray(ground)
        if names.dtype.kind == "O":  # names from pandas
            names = np.asarray(names.tolist())
    except ValueError as wrong:
        raise ValueError(f"ground must be a name, a number, or an array of either: {wrong}") from wrong
    if names.dtype.kind == "U":
        unknown = sorted(set(names.ravel().tolist()) - set(SHELTER))
        if unknown:
            raise ValueError(f"ground must be one of {', '.join(map(repr, SHELTER))}, got {unknown[0]!r}")
        return np.vectorize(SHELTER.__getitem__, otypes=[float])(names)
    shelter = checks.numbers("ground", ground)
    checks.within("ground", shelter, 0.0, 1.0, "(0 none, 1 industry)")
    return shelter


def column_centers(city: City) -> np.ndarray:
    """Centres (nx, ny, 2) of the columns of voxels, x and y [m]."""
    return np.stack(np.meshgrid(city.coordinates(0), city.coordinates(1), indexing="ij"), axis=-1)


def per_line(name: str, value: npt.ArrayLike, count: int) -> np.ndarray:
    numbers = checks.numbers(name, value)
    if numbers.shape not in ((), (count,)):
        raise ValueError(f"{name} must be one number or one for each of the {count} lines, got shape {numbers.shape}")
    return np.broadcast_to(numbers, (count,))
