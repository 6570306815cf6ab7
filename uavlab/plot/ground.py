"""What figures say and draw of the ground and of no-fly zones: heights in words, contours, cuts, prisms.

Where the ground is level, heights are counted from it, and figures say so. Where it isn't, they are heights z of the
map, and figures say how high the ground is.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from matplotlib.ticker import MaxNLocator

from uavlab.city import City, NoFlyZone
from uavlab.city.rasterise import TOUCH, rasterise, touches
from uavlab.plot.style import draw_map, plain, titled

LAND_COLOR = "#E3E1D6"
"""Of terrain from above and in space."""
CUT_COLOR = "#4A3B2A"
"""Of terrain that a section or a profile cuts; buildings are black there."""
ZONE_COLOR = "#882255"
"""Of no-fly zones; no route has it."""
LEVEL = 0.01
"""Ground whose heights differ by less is level [m]."""
MOST_QUADS = 128
"""Along each side of a terrain in a scene; a finer one is thinned out, so that its page stays small."""


def extent_of_ground(city: City) -> tuple[float, float]:
    """Lowest and highest z of the ground [m]; without terrain the bottom of the map."""
    lowest, highest = city.range_of_ground
    return float(lowest.min()), float(highest.max())


def datum_of(city: City) -> float | None:
    """Height z [m] of level ground, from which figures count heights; None where the ground isn't level."""
    low, high = extent_of_ground(city)
    return low if high - low < LEVEL else None


def height_words(city: City, height: float) -> str:
    """A height z [m] of the map in words that say above what it is."""
    low, high = extent_of_ground(city)
    if datum_of(city) is not None:
        return f"{round(height - low, 6):g} m above the ground"
    if height <= low:
        return f"z = {height:g} m, below the ground"
    above = f"{round(height - high)} to" if height >= high else "up to"
    return f"z = {height:g} m, {above} {round(height - low)} m above the ground"


def height_label(city: City) -> str:
    """Label of an axis of heights: above the ground, or z with the heights of the map's ground."""
    return "height above the ground [m]" if datum_of(city) is not None else f"height z [m]\n({ground_words(city)})"


def ground_words(city: City) -> str:
    """From where to where the ground of a map reaches; empty where it is level."""
    low, high = extent_of_ground(city)
    return f"ground at z = {round(low)} to {round(high)} m" if datum_of(city) is None else ""


def title_of(city: City, height: float, dark: str) -> str:
    """Title of a section: the city, the height [m] and above what, and what is dark or hatched."""
    apart = " " if datum_of(city) is not None else "\n"  # the longer words take a line more
    if city.ground is not None and height < extent_of_ground(city)[1] + city.cell:
        dark += ", ground brown"
    return f"{titled(city.name)}, {height_words(city, height)}{apart}({dark})"


def ground_lattice(city: City, most: int = MOST_QUADS) -> np.ndarray:
    """Points (m + 1, n + 1, 3) [m] of the ground on the corners of at most `most` quads along each side.

    Without thinning these are the columns' corners; the height there is bilinear between the columns' centres.
    """
    (west, south, _), (east, north, _) = city.bounds
    x = np.linspace(west, east, min(city.shape[0], most) + 1)
    y = np.linspace(south, north, min(city.shape[1], most) + 1)
    points = np.stack([*np.meshgrid(x, y, indexing="ij"), np.zeros((len(x), len(y)))], axis=-1)
    points[..., 2] = ground_below(city, points)
    return points


def ground_below(city: City, points: np.ndarray) -> np.ndarray:
    """Height z of the ground below or above points (..., 3), (...) [m]."""
    return points[..., 2] - city.height_above_ground(points)


def lattice_triangles(shape: Sequence[int]) -> np.ndarray:
    """Corners (2·m·n, 3) of two triangles for each quad of a lattice of (m + 1, n + 1) points, as positions in it."""
    index = np.arange(np.prod(shape)).reshape(shape)
    quads = [index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]]
    return np.stack([quads[corner] for corner in (0, 1, 2, 0, 2, 3)], axis=-1).reshape(-1, 3)


def voxels_above_ground(city: City) -> np.ndarray:
    """Occupied voxels that the ground doesn't reach into, (nx, ny, nz) bool."""
    if city.ground is None:
        return city.occupied
    bottoms = city.coordinates(2) - city.cell / 2
    return city.occupied & (bottoms >= city.range_of_ground[1][..., None] - TOUCH)


def built_columns(city: City) -> np.ndarray:
    """Columns with a building in them, (nx, ny) bool: with ground, all have something that is occupied."""
    if city.ground is None or not city.buildings:
        return np.any(voxels_above_ground(city), axis=2)
    return np.any([touches(building, city.shape, city.cell, city.origin) for building in city.buildings], axis=0)


def cut_ground(city: City, k: int) -> np.ndarray:
    """Which occupied voxels of a layer are ground, (nx, ny) bool: those without a building, or that lie too low."""
    if city.ground is None:
        return np.zeros(city.shape[:2], dtype=bool)
    level = city.coordinates(2)[k]
    bottom, top = level - city.cell / 2, level + city.cell / 2
    if city.buildings:
        built = np.zeros((*city.shape[:2], 1), dtype=bool)
        corner = np.array([*city.origin[:2], bottom])
        for building in city.buildings:
            if building.bounds[0, 2] < top and building.bounds[1, 2] > bottom:
                rasterise(building.hulls, built, city.cell, corner, "touched")
        built = built[..., 0]
    else:
        built = bottom >= city.range_of_ground[1] - TOUCH
    return city.occupied[:, :, k] & (~built | (level < city.ground))


def draw_cut(axes: Axes, city: City, k: int) -> None:
    """The ground in a layer of voxels, brown and hatched."""
    cut = cut_ground(city, k)
    if cut.any():
        draw_map(axes, city, np.where(cut, 1.0, np.nan), ListedColormap([CUT_COLOR]))
        hatch(axes, city, cut, "\\\\\\", LAND_COLOR)


def hatch(axes: Axes, city: City, columns: np.ndarray, pattern: str, color: str = "black") -> None:
    """Hatch columns (nx, ny) bool in plan."""
    if min(city.shape[:2]) > 1:
        lines = axes.contourf(city.coordinates(0), city.coordinates(1), columns.T, levels=[0.5, 1.5], colors="none",
                              hatches=[pattern])  # fmt: skip
        lines.set(edgecolor=color, linewidth=0.0)


def draw_contours(axes: Axes, city: City) -> None:
    """Lines of equal height of the ground at whole metres z, with their heights, where it rises by more than one."""
    low, high = extent_of_ground(city)
    if high - low < 1.0 or min(city.shape[:2]) < 2:
        return
    points = ground_lattice(city, 4 * MOST_QUADS)
    levels = MaxNLocator(8, integer=True).tick_values(low, high)
    lines = axes.contour(*points.T, levels=levels, colors=CUT_COLOR, linewidths=0.8, alpha=0.7)
    axes.clabel(lines, fontsize=7, fmt="%g")
    axes.plot([], [], color=CUT_COLOR, linewidth=0.8, alpha=0.7, label="height z of the ground [m]")


def zone_label(zones: Sequence[NoFlyZone]) -> str:
    """One entry of a legend for all zones, with their names."""
    names = list(dict.fromkeys(zone.name for zone in zones if zone.name != NoFlyZone.name))
    if len(names) > 3:
        names = [*names[:3], "…"]
    kind = "no-fly zone" if len(zones) == 1 else "no-fly zones"
    return f"{kind}: {', '.join(names)}" if names else kind


def zone_polygons(city: City, zone: NoFlyZone) -> list[shapely.Polygon]:
    """What of a zone lies on the map, in plan [m]."""
    within = shapely.intersection(zone.polygon, shapely.box(*city.bounds[:, :2].ravel()))
    return [part for part in shapely.get_parts(within) if isinstance(part, shapely.Polygon) and not part.is_empty]


def zones_at(city: City, height: float | None = None) -> list[NoFlyZone]:
    """The zones on the map that reach a height [m]; all of them without one."""
    shown = []
    for zone in city.no_fly:
        low, high = city.zone_building(zone).bounds[:, 2]
        if zone_polygons(city, zone) and (height is None or low <= height <= high):
            shown.append(zone)
    return shown


def draw_zones(axes: Axes, city: City, height: float | None = None) -> None:
    """Outlines of no-fly zones in plan, hatched, with one entry in the legend; at a height those that reach it."""
    zones = zones_at(city, height)
    for number, polygon in enumerate(part for zone in zones for part in zone_polygons(city, zone)):
        rings = [Path(shapely.get_coordinates(ring), closed=True) for ring in (polygon.exterior, *polygon.interiors)]
        path = Path.make_compound_path(*rings)
        axes.add_patch(PathPatch(path, facecolor="none", edgecolor="white", linewidth=3.0))
        axes.add_patch(PathPatch(path, facecolor="none", edgecolor=ZONE_COLOR, linewidth=1.5, hatch="xx",
                                 label="_" if number else plain(zone_label(zones))))  # fmt: skip


def zone_surface(city: City) -> tuple[np.ndarray, np.ndarray]:
    """Walls and caps of all no-fly zones as triangles (T, 3, 3), and ends (2E, 3) of their edges [m]."""
    triangles, edges = [np.empty((0, 3, 3))], [np.empty((0, 3))]
    for zone in city.no_fly:
        low, high = city.zone_building(zone).bounds[:, 2]
        for polygon in zone_polygons(city, zone):
            for part in shapely.constrained_delaunay_triangles(polygon).geoms:
                cap = shapely.get_coordinates(part)[:3]
                triangles += [np.column_stack([cap, np.full(3, z)])[None] for z in (low, high)]
            for ring in (polygon.exterior, *polygon.interiors):
                corners = shapely.get_coordinates(ring)
                foot, head = (np.column_stack([corners, np.full(len(corners), z)]) for z in (low, high))
                triangles.append(np.stack([foot[:-1], foot[1:], head[1:]], axis=1))
                triangles.append(np.stack([foot[:-1], head[1:], head[:-1]], axis=1))
                ends = (foot[:-1], foot[1:]), (head[:-1], head[1:]), (foot[:-1], head[:-1])
                edges += [np.stack(pair, axis=1).reshape(-1, 3) for pair in ends]
    return np.concatenate(triangles), np.concatenate(edges)
