"""The scene as a picture: city, routes and flights in three dimensions, lit and sorted by depth."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt
from matplotlib.cm import ScalarMappable
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection
from scipy.ndimage import maximum_filter

from uavlab import checks
from uavlab.city import City
from uavlab.flight import Flight
from uavlab.plot.colors import CRASH_COLOR, SEQUENTIAL, route_colors
from uavlab.plot.flights import cross, label_of_flight, named_flights, track
from uavlab.plot.ground import (
    LAND_COLOR,
    ZONE_COLOR,
    built_columns,
    ground_lattice,
    lattice_triangles,
    voxels_above_ground,
    zone_label,
    zone_surface,
    zones_at,
)
from uavlab.plot.maps import RISK_LABEL, ground_risk, risk_norm
from uavlab.plot.style import (
    DPI,
    Drawn,
    drawn_routes,
    finished,
    label_of,
    plain,
)
from uavlab.risk import RiskMap
from uavlab.route import Route

SUN = np.array([-0.45, -0.7, 0.55]) / np.linalg.norm([-0.45, -0.7, 0.55])
"""Where the light comes from in a still."""
LAND_QUADS = 70
"""Of terrain along each side of a still."""


def still(
    city: City,
    *routes: Drawn,
    risk: RiskMap | None = None,
    flights: Sequence[Flight] | Mapping[str, Flight] = (),
    elevation_deg: float = 32.0,
    azimuth_deg: float = -60.0,
) -> Figure:
    """The scene as a picture, for paper and previews: city and routes in three dimensions, equal scales.

    Parameters
    ----------
    city : City
        Drawn from its buildings, or from its voxels where it knows no buildings.
    routes : Route or Curve, or mapping
        By name if it is a mapping.
    risk : RiskMap, optional
        Paints the ground with the risk just above it.
    flights : sequence of Flight, or mapping
        Their tracks, by name if it is a mapping; a crash is a red X. Routes are drawn thinner then.
    elevation_deg, azimuth_deg : float
        From where it is seen [degrees]: height above the horizon, direction counted from east to north.

    Returns
    -------
    matplotlib.figure.Figure
        One panel in three dimensions.

    Raises
    ------
    ValueError
        If `city` is no `City`, one of `routes` is neither a route nor a curve, `risk` is no `RiskMap` of this city,
        `flights` holds anything else than flights, or `elevation_deg` or `azimuth_deg` is no finite number.

    See Also
    --------
    uavlab.scene.show : The scene to turn and fly through.
    plan : The same from above.

    Examples
    --------
    >>> from uavlab import plot
    >>> from uavlab.city import table1_city
    >>> from uavlab.planners import astar
    >>> city = table1_city()
    >>> figure = plot.still(city, astar(city, (90, 18, 30), (50, 44, 30)), azimuth_deg=-120.0)
    >>> figure.axes[0].get_zlabel(), figure.axes[0].azim
    ('z, up [m]', -120.0)
    """
    planned = drawn_routes(city, routes, risk)
    named = named_flights(flights)
    for name, angle in (("elevation_deg", elevation_deg), ("azimuth_deg", azimuth_deg)):
        checks.number(name, angle, checks.finite)
    figure = plt.figure(figsize=(7.2, 5.4), dpi=DPI)
    axes: Any = figure.add_axes((0, 0.04, 1, 0.9), projection="3d", computed_zorder=False)
    low, high = city.bounds
    longest = float((high - low).max())
    polygons, colors = [], []
    for triangles, color in city_surface(city):
        pieces = subdivided(triangles, longest / (14 if city.ground is None else 40))  # small ones meet a slope evenly
        polygons.append(pieces)
        colors.append((0.75 + 0.25 * sunlight(pieces))[:, None] * to_rgb(color))
    norm = paint = None
    if risk is not None:
        norm = risk_norm(risk)
        paint = np.repeat(SEQUENTIAL(norm(ground_risk(risk).ravel()))[:, :3], 2, axis=0)
    if city.ground is not None or paint is not None:
        land, tones, below = drawn_land(city, paint)
        polygons.append(land[~below])
        colors.append(tones[~below])
        if below.any():
            tones = tones[below]
            axes.add_collection3d(Poly3DCollection(land[below], facecolors=tones, edgecolors=tones, lw=0.3, zorder=0))
    zones = zones_at(city)
    if zones:
        walls, edges = zone_surface(city)
        axes.add_collection3d(Poly3DCollection(walls, zorder=8, facecolors=ZONE_COLOR, alpha=0.2, edgecolors="none"))
        axes.add_collection3d(Line3DCollection(edges.reshape(-1, 2, 3), zorder=8, colors=ZONE_COLOR, linewidths=0.8))
        axes.plot([], [], [], color=ZONE_COLOR, linewidth=6, alpha=0.4, label=plain(zone_label(zones)))
    ways = [(label_of(route), route, 0.4 if named else 1.0) for route in planned]
    ways += [(plain(label_of_flight(name, flight)), Route(track(flight)[1]), 1.0) for name, flight in named.items()]
    for (label, way, thickness), color in zip(ways, route_colors(len(ways)), strict=True):
        axes.plot([], [], [], color=color, linewidth=3 * thickness, label=label)
        if len(way.points) > 1:
            ribbon = ribbons(way.resample(longest / 60).points, thickness * longest / 180)
            axes.plot(*way.points.T, color=color, linewidth=0.8, alpha=0.5, zorder=9)  # what a building hides
            polygons.append(ribbon)
            colors.append(np.tile(to_rgb(color), (len(ribbon), 1)))
    for flight in named.values():
        if flight.outcome == "crashed":
            for arm in cross(flight.position[-1], longest / 30):
                axes.plot(*arm.T, color=CRASH_COLOR, linewidth=3.5, zorder=10)
    if norm is not None:
        bar = figure.add_axes((0.08, 0.1, 0.24, 0.025))
        figure.colorbar(ScalarMappable(norm, SEQUENTIAL), cax=bar, orientation="horizontal").set_label(
            RISK_LABEL, fontsize=8
        )
    if sum(map(len, polygons)):
        faces = np.concatenate(colors)
        axes.add_collection3d(Poly3DCollection(np.concatenate(polygons), facecolors=faces, edgecolors=faces, lw=0.3))
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set(xlabel="x, east [m]", ylabel="y, north [m]", zlabel="z, up [m]", title=plain(city.name))
    axes.set_box_aspect(high - low, zoom=0.95)
    axes.zaxis.set_major_locator(MaxNLocator(2 + round(4 * (high - low)[2] / longest)))
    axes.view_init(float(elevation_deg), float(azimuth_deg))
    if ways or zones:
        axes.legend(loc="upper left", fontsize=8)
    return finished(figure)


def drawn_land(city: City, paint: np.ndarray | None) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The ground as triangles (T, 3, 3) [m], their colours (T, 3), and which of them are to be drawn first.

    Those are below buildings or beside them, where they would be taken for nearer than a wall; level ground hides
    nothing at all.
    """
    lattice = ground_lattice(city, LAND_QUADS if paint is None else max(city.shape))
    land = lattice.reshape(-1, 3)[lattice_triangles(lattice.shape[:2])]
    below = np.ones(len(land), dtype=bool)
    if city.ground is not None:
        reach = -(-max(city.shape[:2]) // LAND_QUADS)
        i, j, _ = city.cell_of(land.mean(axis=1)).T
        below = maximum_filter(built_columns(city), 2 * reach + 1)[i, j]
    light = np.clip(1.0 + 0.6 * (sunlight(land) - SUN[2]), 0.0, 1.0)
    return land, light[:, None] * to_rgb(LAND_COLOR) if paint is None else paint, below


def sunlight(triangles: np.ndarray) -> np.ndarray:
    """How straight the sun shines on triangles (T, 3, 3), (T,): the cosine of its angle with their normals."""
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True) + 1e-12
    return normals @ SUN


def layer_triangles(city: City, height: npt.ArrayLike) -> np.ndarray:
    """Two triangles for each column of voxels, (nx·ny, 2, 3, 3) [m], at a height or at those of its corners.

    Parameters
    ----------
    city : City
    height : float or (nx + 1, ny + 1) array
        z [m] of all, or of each corner of the columns, as from `ground_lattice`.
    """
    i, j = np.indices((city.shape[0] + 1, city.shape[1] + 1))
    corners = city.origin + city.cell * np.stack([i, j, np.zeros(i.shape)], axis=-1)
    corners[..., 2] = height
    return corners.reshape(-1, 3)[lattice_triangles(i.shape)].reshape(-1, 2, 3, 3)


def voxel_surface(city: City) -> np.ndarray:
    """Triangles (T, 3, 3) [m] between occupied voxels and free ones or the border; rows of faces are one rectangle.

    Where the city has ground, what it reaches into is left out.
    """
    occupied = voxels_above_ground(city)
    padded = np.pad(occupied, 1)
    triangles = []
    for axis in range(3):
        across, along = sorted({0, 1, 2} - {axis})
        for side in (0, 1):
            beyond = np.roll(padded, 1 - 2 * side, axis=axis)[1:-1, 1:-1, 1:-1]
            exposed = np.moveaxis(occupied & ~beyond, along, -1)
            steps = np.diff(exposed.astype(np.int8), axis=-1, prepend=0, append=0)
            first, last = np.argwhere(steps == 1), np.argwhere(steps == -1)  # of each row: same order, so they pair up
            corner, extent = np.zeros((2, len(first), 3))
            kept = [a for a in range(3) if a != along]
            corner[:, kept], corner[:, along] = first[:, :2], first[:, 2]
            corner[:, axis] += side
            extent[:, along] = last[:, 2] - first[:, 2]
            step = np.eye(3)[across]
            quad = [corner, corner + step, corner + step + extent, corner + extent]
            if (side == 1) != (np.cross(step, np.eye(3)[along])[axis] > 0):
                quad = quad[::-1]  # counter-clockwise seen from outside
            triangles += [np.stack([quad[0], quad[1], quad[2]], axis=1), np.stack([quad[0], quad[2], quad[3]], axis=1)]
    return city.origin + city.cell * np.concatenate(triangles)


def city_surface(city: City) -> list[tuple[np.ndarray, str]]:
    """Triangles and colour of each building, or of all voxels where the city knows no buildings."""
    if city.buildings:
        return [(building.triangles(), building.color) for building in city.buildings]
    surface = voxel_surface(city)
    return [(surface, "lightsteelblue")] if len(surface) else []


def subdivided(triangles: np.ndarray, longest: float) -> np.ndarray:
    """Triangles cut in halves until no edge is longer: small ones can be sorted by depth."""
    while True:
        edges = np.linalg.norm(np.roll(triangles, -1, axis=1) - triangles, axis=2)
        large = edges.max(axis=1) > longest
        if not large.any():
            return triangles
        first = edges[large].argmax(axis=1)
        a, b, c = (triangles[large][np.arange(large.sum()), (first + corner) % 3] for corner in range(3))
        middle = (a + b) / 2
        halves = [np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)]
        triangles = np.concatenate([triangles[~large], *halves])


def ribbons(points: np.ndarray, width: float) -> np.ndarray:
    """Triangles of two crossed ribbons along a polyline: a line that has a depth of its own."""
    start, end = points[:-1], points[1:]
    moved = (start != end).any(axis=1)
    start, end = start[moved], end[moved]
    along = end - start
    across = np.cross(along, [0.0, 0.0, 1.0])
    across[np.linalg.norm(across, axis=1) < 1e-9] = [1.0, 0.0, 0.0]
    surfaces = []
    for direction in (across, np.cross(along, across)):
        side = width * direction / np.linalg.norm(direction, axis=1, keepdims=True)
        surfaces.append(np.stack([start - side, end - side, end + side], axis=1))
        surfaces.append(np.stack([start - side, end + side, start + side], axis=1))
    return np.concatenate(surfaces)
