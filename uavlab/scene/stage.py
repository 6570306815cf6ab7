"""What a scene shows of a city: ground and grid, buildings or voxels, no-fly zones, risk, wind."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from matplotlib.colors import is_color_like, to_rgb

from uavlab.city import City
from uavlab.plot.colors import SEQUENTIAL
from uavlab.plot.flights import WIND_COLOR
from uavlab.plot.ground import (
    LAND_COLOR,
    MOST_QUADS,
    ZONE_COLOR,
    built_columns,
    ground_below,
    ground_lattice,
    ground_words,
    lattice_triangles,
    voxels_above_ground,
    zone_label,
    zone_surface,
    zones_at,
)
from uavlab.plot.maps import ground_risk, risk_norm
from uavlab.plot.style import level_of
from uavlab.risk import RiskMap
from uavlab.scene.drawing import Drawing, Entry, Lines, Surface
from uavlab.scene.shapes import arrow, wind_sock
from uavlab.weather import Wind

LEVEL_COLOR = "#E9E9E4"
GRID_COLOR = "#B8B8B0"
EDGE_COLOR = "#555555"
VOXEL_COLOR = "#B0C4DE"
THIN = 0.25
"""Sheets that are thinner [m] are drawn once, not from both sides; edges shorter than four times it aren't drawn."""
MOST_TRIANGLES = 20_000
"""Of a city; beyond it thin sheets and short edges are looked for."""
MOST_EDGES = 60_000
"""Of voxels; more would be a grey surface."""


def begun(city: City, title: str | None) -> Drawing:
    """A drawing of the city alone."""
    low, high = city.bounds
    floor = low[2] if city.ground is None else city.ground.min()
    box = np.array([[*low[:2], floor], [*high[:2], floor]])
    drawing = Drawing(title or city.name, (low + high) / 2, box)
    drawing.seen.append(np.array([(x, y, floor) for x in box[:, 0] for y in box[:, 1]]))
    draw_city(drawing, city)
    return drawing


def show_too(drawing: Drawing, points: np.ndarray) -> None:
    """Make room in the frame for points (..., 3) [m]."""
    points = points.reshape(-1, 3)
    drawing.seen.append(points)
    drawing.box[1, 2] = max(drawing.box[1, 2], float(points[:, 2].max()))


def draw_ground(drawing: Drawing, city: City, risk_map: RiskMap | None) -> None:
    """The ground, unless risk is painted on it, and a grid of round lengths."""
    (west, south, bottom), (east, north, _) = city.bounds
    lift = 0.001 * float(np.hypot(east - west, north - south))
    if city.ground is None:
        corners = np.array([(west, south, 0.0), (east, south, 0.0), (east, north, 0.0), (west, north, 0.0)])
        corners[:, 2] = bottom - lift
        drawing.parts["ground"] = Surface(corners[[[0, 1, 2], [0, 2, 3]]], LEVEL_COLOR, lit=False)
    elif risk_map is None:
        lattice = ground_lattice(city)
        triangles = lattice.reshape(-1, 3)[lattice_triangles(lattice.shape[:2])]
        drawing.parts["ground"] = Surface(triangles, LAND_COLOR)
        show_too(drawing, lattice)
    drawing.parts["grid"] = Lines(grid_lines(city, lift if city.ground is not None or risk_map else 0.0), GRID_COLOR)
    drawing.notes.append(f"squares of {grid_spacing(city):g} m")
    drawing.notes += filter(None, [ground_words(city)])


def grid_lines(city: City, lift: float) -> np.ndarray:
    """Ends (2L, 3) [m] of a grid's lines, `lift` above the map's bottom, or above its ground, which they follow."""
    (low, high), spacing = city.bounds, grid_spacing(city)
    lines = []
    for axis, other in ((0, 1), (1, 0)):
        count = 2 if city.ground is None else min(city.shape[other], MOST_QUADS) + 1
        for value in np.arange(np.ceil(low[axis] / spacing) * spacing, high[axis] + 1e-9, spacing):
            points = np.full((count, 3), low[2])
            points[:, axis] = value
            points[:, other] = np.linspace(low[other], high[other], count)
            if city.ground is not None:
                points[:, 2] = ground_below(city, points)
            points[:, 2] += lift
            lines.append(np.repeat(points, 2, axis=0)[1:-1])
    return np.concatenate(lines)


def grid_spacing(city: City) -> float:
    """A round number of metres that divides the map into about ten squares."""
    extent = float((city.bounds[1] - city.bounds[0])[:2].max())
    magnitude = 10.0 ** np.floor(np.log10(extent / 10))
    return float(magnitude * min((1, 2, 5, 10), key=lambda m: abs(extent / (magnitude * m) - 10)))


def draw_city(drawing: Drawing, city: City) -> None:
    """Buildings as they are with their edges; without any, the voxels with theirs."""
    if not city.buildings:
        draw_voxels(drawing, city)
        return
    surfaces = [building.triangles() for building in city.buildings]
    triangles, colors = np.concatenate(surfaces), colors_of(city, [len(surface) for surface in surfaces])
    count = len(triangles)
    edges = np.concatenate([building.edges() for building in city.buildings])
    if len(triangles) > MOST_TRIANGLES:
        kept = not_twice(triangles)
        triangles, colors = triangles[kept], colors[kept]
        edges = edges.reshape(-1, 2, 3)
        edges = edges[np.linalg.norm(edges[:, 1] - edges[:, 0], axis=1) > 4 * THIN]
        edges = edges[not_twice(edges)].reshape(-1, 3)
    drawing.parts["buildings"] = Surface(triangles, colors, closed=len(triangles) == count)
    if len(edges):
        drawing.parts["edges"] = Lines(edges, EDGE_COLOR)
    show_too(drawing, triangles)


def colors_of(city: City, counts: list[int]) -> np.ndarray:
    """The buildings' colours, one for each of their triangles."""
    for building in city.buildings:
        if not is_color_like(building.color):
            raise ValueError(
                f"color of {building.name!r:.60} must be a colour of matplotlib, such as 'steelblue', "
                f"got {building.color!r:.40}"
            )
    return np.repeat([to_rgb(building.color) for building in city.buildings], counts, axis=0)


def not_twice(shapes: np.ndarray) -> np.ndarray:
    """Positions of the triangles or edges (N, corners, 3) that aren't thinner than `THIN` nor twins within it."""
    corners = shapes.shape[1]
    places = np.round(shapes.reshape(-1, 3) / THIN).astype(np.int64)
    near = np.sort(np.unique(places, axis=0, return_inverse=True)[1].reshape(-1, corners), axis=1)
    wide = np.flatnonzero((np.diff(near, axis=1) > 0).all(axis=1))
    return np.sort(wide[np.unique(near[wide], axis=0, return_index=True)[1]])


def draw_voxels(drawing: Drawing, city: City) -> None:
    """Occupied voxels above the ground, with the edges of each, if there aren't too many to see."""
    occupied = voxels_above_ground(city)
    if not occupied.any():
        return
    surface = voxel_surface(city)
    drawing.parts["voxels"] = Surface(surface, VOXEL_COLOR, closed=True)
    show_too(drawing, surface)
    edges = voxel_edges(city)
    if len(edges) <= 2 * MOST_EDGES:
        drawing.parts["edges"] = Lines(edges, EDGE_COLOR)
        drawing.notes.append(f"voxels of {city.cell:g} m")


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
            corner, extent = rows_of(occupied & ~beyond, along)
            corner[:, axis] += side
            step = np.eye(3)[across]
            quad = [corner, corner + step, corner + step + extent, corner + extent]
            if (side == 1) != (np.cross(step, np.eye(3)[along])[axis] > 0):
                quad = quad[::-1]  # counter-clockwise seen from outside
            triangles += [np.stack([quad[0], quad[1], quad[2]], axis=1), np.stack([quad[0], quad[2], quad[3]], axis=1)]
    return city.origin + city.cell * np.concatenate(triangles)


def voxel_edges(city: City) -> np.ndarray:
    """Ends (2E, 3) [m] of the edges of faces between occupied voxels and free ones; rows of edges are one line."""
    padded = np.pad(voxels_above_ground(city), 1)
    lines = []
    for along in range(3):
        first, second = sorted({0, 1, 2} - {along})
        count = padded.astype(np.int8)
        count = count + np.roll(count, 1, axis=first)
        count = count + np.roll(count, 1, axis=second)  # of the four voxels around the edge at their lower corner
        inner = [slice(1, None)] * 3
        inner[along] = slice(1, -1)
        corner, extent = rows_of(((count > 0) & (count < 4))[tuple(inner)], along)
        lines.append(np.stack([corner, corner + extent], axis=1).reshape(-1, 3))
    return city.origin + city.cell * np.concatenate(lines)


def rows_of(cells: np.ndarray, along: int) -> tuple[np.ndarray, np.ndarray]:
    """Rows of True along an axis: corner (R, 3) of the first of each, and extent (R, 3) [cells]."""
    turned = np.moveaxis(cells, along, -1)
    steps = np.diff(turned.astype(np.int8), axis=-1, prepend=0, append=0)
    first, last = np.argwhere(steps == 1), np.argwhere(steps == -1)  # of each row: same order, so they pair up
    corner, extent = np.zeros((2, len(first), 3))
    kept = [axis for axis in range(3) if axis != along]
    corner[:, kept], corner[:, along] = first[:, :2], first[:, 2]
    extent[:, along] = last[:, 2] - first[:, 2]
    return corner, extent


def draw_zones(drawing: Drawing, city: City) -> None:
    """All no-fly zones as one surface that one can look through, and their edges."""
    surface, edges = zone_surface(city)
    if len(surface):
        drawing.parts["no-fly zones"] = Surface(surface, ZONE_COLOR, opacity=0.28)
        drawing.parts["their edges"] = Lines(edges, ZONE_COLOR)
        drawing.legend.append(Entry("patch", zone_label(zones_at(city)), ZONE_COLOR))
        show_too(drawing, np.minimum(surface, city.bounds[1]))


def draw_risk(drawing: Drawing, risk_map: RiskMap, slice_height: float | None) -> None:
    """The ground painted with the risk above it, and a slice at a height, both on one logarithmic scale."""
    city = risk_map.city
    drawing.risk = norm = risk_norm(risk_map)

    def painted(values: np.ndarray, shown: np.ndarray, height: npt.ArrayLike, opacity: float) -> Surface:
        triangles = layer_triangles(city, height)[shown.ravel()].reshape(-1, 3, 3)
        return Surface(triangles, np.repeat(SEQUENTIAL(norm(values[shown]))[:, :3], 2, axis=0), opacity, lit=False)

    below = city.origin[2] if city.ground is None else ground_lattice(city, max(city.shape))[..., 2]
    everywhere = np.ones(city.shape[:2], dtype=bool)
    drawing.parts["risk on the ground"] = painted(ground_risk(risk_map), everywhere, below + 0.01 * city.cell, 1.0)
    if slice_height is not None:
        k = level_of(city, slice_height)
        flyable = risk_map.flyable[:, :, k]
        drawing.parts["risk at a height"] = painted(risk_map.rate[:, :, k], flyable, slice_height, 0.6)
        drawing.notes.append(f"the plane shows the risk at z = {slice_height:g} m")
        show_too(drawing, drawing.parts["risk at a height"].triangles)  # type: ignore[union-attr]


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


def draw_wind(drawing: Drawing, city: City, wind: Wind) -> None:
    """A wind sock where nothing is built, and arrows where the mean wind comes onto the map."""
    size = 0.07 * float(np.linalg.norm((city.bounds[1] - city.bounds[0])[:2]))
    drawing.wind = blows = np.array(wind.mean[:2])
    sock, colors = wind_sock(place_of_sock(city, 0.6 * size), blows, size)
    drawing.parts["wind sock"] = Surface(sock, colors)
    drawing.seen.append(sock.reshape(-1, 3))
    speed = float(np.linalg.norm(blows))
    spread = f"gusts of σ = {wind.deviation:g} m/s" if wind.deviation else "no gusts"
    gusts = {"none": "no gusts", "dryden": "Dryden gusts"}.get(wind.gusts, spread)
    words = f"wind {speed:.3g} m/s, {gusts}" if speed else f"no mean wind, {gusts}"
    drawing.legend.append(Entry("wind", words, WIND_COLOR))
    if speed:
        height = max(float(drawing.box[:, 2].mean()), float(drawing.box[0, 2]) + size)
        shafts = wind_arrows(city, blows / speed, size, height)
        drawing.parts["wind"] = Surface(shafts, WIND_COLOR)
        drawing.seen.append(shafts.reshape(-1, 3))


def place_of_sock(city: City, inward: float) -> np.ndarray:
    """On the ground (3,) [m]: near the first corner of the map that isn't built on, else the free column nearest to it.

    `inward` is how far from the border a corner's place is [m].
    """
    low, high = city.bounds[:, :2]
    free = ~built_columns(city)
    centers = np.stack(np.meshgrid(city.coordinates(0), city.coordinates(1), indexing="ij"), axis=-1)
    places = np.array([np.where(upper, high - inward, low + inward) for upper in ((0, 0), (1, 0), (0, 1), (1, 1))])
    columns = [np.unravel_index(np.linalg.norm(centers - place, axis=-1).argmin(), free.shape) for place in places]
    place = next((place for place, column in zip(places, columns, strict=True) if free[column]), None)
    if place is None:
        distance = np.where(free, np.linalg.norm(centers - places[0], axis=-1), np.inf)
        place = centers[np.unravel_index(distance.argmin(), free.shape)]
    foot = np.array([*place, city.bounds[0, 2]])
    return np.array([*place, ground_below(city, foot)])


def wind_arrows(city: City, along: np.ndarray, size: float, height: float) -> np.ndarray:
    """Triangles of three arrows along a level direction (2,) that begin where it enters the map, at a height [m]."""
    low, high = city.bounds[:, :2]
    reach = ((high - low) / 2 / np.maximum(np.abs(along), 1e-9)).min()
    tail = (low + high) / 2 - reach * along
    ahead, beside = np.array([*along, 0.0]), np.array([-along[1], along[0], 0.0]) * (high - low).min()
    feet = [np.array([*tail, height]) + share * beside for share in (-0.3, 0.0, 0.3)]
    return np.concatenate([arrow(foot, foot + 1.2 * size * ahead, 0.1 * size) for foot in feet])
