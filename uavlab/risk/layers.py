"""Layers of the ground for any city: population from a raster, cars from road lines, shelter from what stands there.

Each gives one number per column of voxels, (nx, ny), for `RiskMap`. A raster is read at the columns' centres; roads
count by the share of a column that they cover, so that narrow roads on coarse maps keep their cars.
"""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import shapely

from uavlab import checks
from uavlab.city import City
from uavlab.risk.rates import CARS_PER_KM, LANE_WIDTH, SHELTER, vehicle_share

HIGH_BUILDING = 10.0
"""From this height on [m] a building counts as high; the papers draw no line."""

SHORTEST_ROAD = 0.1
"""A road that is shorter [m] is one in degrees: 0.1° are 10 km."""


def raster_layer(
    city: City,
    values: npt.ArrayLike,
    bounds: Sequence[float],
    *,
    geographic: bool = False,
    fill: float | None = None,
) -> np.ndarray:
    """Values of a raster at the columns of a city.

    Parameters
    ----------
    city : City
    values : (rows, columns) array
        As in a picture: the first row lies in the north, the first column in the west. NaN is "no data". For
        `RiskMap(population_density=...)` in people per m²: divide counts by the area of a pixel.
    bounds : (west, south, east, north)
        Of the whole raster: in metres of the city, or in degrees.
    geographic : bool
        Bounds are longitudes and latitudes on WGS84; the city must know its `reference`.
    fill : float, optional
        What to take where the raster says nothing, finite; without it that is an error.

    Returns
    -------
    (nx, ny) array

    Raises
    ------
    ValueError
        If `values` isn't two-dimensional, bounds are not in order or lie elsewhere, the city has no reference for
        degrees, or the raster doesn't cover the city and there is no `fill`.
    """
    checks.instance("city", city, City)
    raster = checks.numbers("values", values)
    if raster.ndim != 2 or raster.size == 0:
        raise ValueError(f"values must have shape (rows, columns), got {raster.shape}")
    edges = checks.numbers("bounds", bounds)
    if edges.shape != (4,) or not (np.isfinite(edges).all() and edges[0] < edges[2] and edges[1] < edges[3]):
        raise ValueError(f"bounds must be (west, south, east, north) in increasing order, got {bounds!r}")
    if fill is not None:
        checks.number("fill", fill)
        checks.finite("fill", fill)
    points = column_centers(city)
    if geographic:
        check_degrees("bounds", edges.reshape(2, 2))
        points = city.checked_reference().longitude_latitude(points)
    west, south, east, north = edges
    column = np.floor((points[..., 0] - west) / (east - west) * raster.shape[1]).astype(int)
    row = np.floor((north - points[..., 1]) / (north - south) * raster.shape[0]).astype(int)
    inside = (column >= 0) & (column < raster.shape[1]) & (row >= 0) & (row < raster.shape[0])
    if not inside.any():
        ranges = ", ".join(f"{points[..., a].min():g} to {points[..., a].max():g}" for a in range(2))
        unit = "degrees" if geographic else "m (in degrees? say geographic=True)"
        raise ValueError(f"bounds must lie around the city, whose columns are at {ranges} {unit}, got {bounds!r}")
    layer = np.full(city.shape[:2], np.nan)
    layer[inside] = raster[row[inside], column[inside]]
    missing = np.isnan(layer)
    if missing.any() and fill is None:
        raise ValueError(
            f"values say nothing about {missing.sum()} of the city's {missing.size} columns "
            "(outside of bounds, or no data); "
            "give a larger raster, or say with fill what to take there"
        )
    if fill is not None:
        layer[missing] = fill
    return layer


def road_layer(
    city: City,
    lines: Sequence[npt.ArrayLike],
    width: float | Sequence[float],
    *,
    cars_per_km: float | Sequence[float] = CARS_PER_KM,
    lane_width: float = LANE_WIDTH,
    geographic: bool = False,
) -> np.ndarray:
    """Share of the ground that cars cover, from the middle lines of roads: for `RiskMap(vehicle_share=...)`.

    Parameters
    ----------
    city : City
    lines : sequence of (M, 2) arrays
        Middle line of each road, x and y [m].
    width : float, or one for each line
        Of the roadway [m], above 0.
    cars_per_km : float, or one for each line
        K, cars per kilometre of a lane, at least 0.
    lane_width : float
        D_road [m], above 0.
    geographic : bool
        Lines are longitudes and latitudes on WGS84; the city must know its `reference`.

    Returns
    -------
    (nx, ny) array
        C·(share of the column that roads cover). Where roads overlap, the busier counts.

    Raises
    ------
    ValueError
        If a line hasn't shape (M, 2) with M of at least 2 or is a mere point, a number is out of its range, or the
        city has no reference for degrees.
    """
    checks.instance("city", city, City)
    if not isinstance(lines, Sequence | np.ndarray):
        raise ValueError(f"lines must be a list of lines (M, 2), got {type(lines).__name__}")
    widths, densities = (
        per_line(name, value, len(lines)) for name, value in (("width", width), ("cars_per_km", cars_per_km))
    )
    checks.positive("width", widths)
    covered = vehicle_share(densities, lane_width)
    centers, half = column_centers(city).reshape(-1, 2), city.cell / 2
    left = shapely.box(*(centers - half).T, *(centers + half).T)
    layer = np.zeros(len(left))
    for number in np.argsort(-covered, kind="stable"):  # the busiest first: what it covers is taken
        line = checks.numbers(f"lines[{number}]", lines[number])
        if line.ndim != 2 or line.shape[1] != 2 or len(line) < 2 or not np.isfinite(line).all():
            raise ValueError(f"lines[{number}] must be at least two finite points (M, 2), got shape {line.shape}")
        if geographic:
            check_degrees(f"lines[{number}]", line)
            line = city.checked_reference().east_north(line)
        elif np.ptp(line, axis=0).max() < SHORTEST_ROAD:
            raise ValueError(f"lines[{number}] lies within {SHORTEST_ROAD:g} m; in degrees it needs geographic=True")
        roadway = shapely.LineString(line).buffer(widths[number] / 2, cap_style="flat", join_style="mitre")
        near = np.flatnonzero(shapely.intersects(left, roadway))
        layer[near] += covered[number] * shapely.area(shapely.intersection(left[near], roadway)) / city.cell**2
        left[near] = shapely.difference(left[near], roadway)
    return np.minimum(layer, 1.0).reshape(city.shape[:2])


def shelter_layer(city: City, ground: npt.ArrayLike = "none", *, high: float = HIGH_BUILDING) -> np.ndarray:
    """Shelter p_s of each column: 0.5 under low buildings, 0.75 under high ones, as given elsewhere.

    Parameters
    ----------
    city : City
    ground : name, number, or (nx, ny) array of either
        Open ground: "none", "sparse trees", "trees or low buildings", "high buildings", "industry" (PSO-BAS
        Table 1), or p_s itself.
    high : float
        Height of roofs above the ground from which a building counts as high [m].

    Returns
    -------
    (nx, ny) array

    Raises
    ------
    ValueError
        If a name is none of Table 1's, a number not in [0, 1], or the shape not the city's ground plan.
    """
    checks.instance("city", city, City)
    checks.not_negative_number("high", high)
    open_ground = np.asarray(ground)
    if open_ground.dtype.kind == "O":  # names from pandas
        open_ground = np.asarray(open_ground.tolist())
    if open_ground.dtype.kind == "U":
        unknown = sorted(set(open_ground.ravel().tolist()) - set(SHELTER))
        if unknown:
            raise ValueError(f"ground must be one of {', '.join(map(repr, SHELTER))}, got {unknown[0]!r}")
        open_ground = np.vectorize(SHELTER.__getitem__, otypes=[float])(open_ground)
    open_ground = checks.numbers("ground", open_ground)
    checks.within("ground", open_ground, 0.0, 1.0, "(0 none, 1 industry)")
    if open_ground.shape not in ((), city.shape[:2]):
        raise ValueError(f"ground must have the city's ground plan {city.shape[:2]}, got {open_ground.shape}")
    highest, above = city.cell * (city.shape[2] - 0.5), city.height_above_surface[..., -1]
    roof = np.where(city.occupied[..., -1], city.cell * city.shape[2], np.round(highest - above, 6))
    built = np.where(roof >= high, SHELTER["high buildings"], SHELTER["trees or low buildings"])
    return np.where(roof > 0, built, open_ground)


def column_centers(city: City) -> np.ndarray:
    """Centres (nx, ny, 2) of the columns of voxels, x and y [m]."""
    return np.stack(np.meshgrid(city.coordinates(0), city.coordinates(1), indexing="ij"), axis=-1)


def check_degrees(name: str, points: np.ndarray) -> None:
    """Refuse what can't be longitudes and latitudes (..., 2)."""
    for axis, kind, most in ((0, "longitudes", 180.0), (1, "latitudes", 90.0)):
        checks.within(f"{name}: {kind}", points[..., axis], -most, most, "degrees (metres? leave geographic out)")


def per_line(name: str, value: npt.ArrayLike, count: int) -> np.ndarray:
    numbers = checks.numbers(name, value)
    if numbers.shape not in ((), (count,)):
        raise ValueError(f"{name} must be one number or one for each of the {count} lines, got shape {numbers.shape}")
    return np.broadcast_to(numbers, (count,))
