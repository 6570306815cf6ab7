"""What a scene shows of a city: ground and grid, buildings, no-fly zones, risk; and from where it is seen."""

from __future__ import annotations

import meshcat
import meshcat.geometry as g
import numpy as np
import numpy.typing as npt
from matplotlib.colors import to_rgb
from meshcat.transformations import translation_matrix

from uavlab.city import City
from uavlab.plot.colors import SEQUENTIAL
from uavlab.plot.ground import (
    LAND_COLOR,
    MOST_QUADS,
    ZONE_COLOR,
    ground_below,
    ground_lattice,
    lattice_triangles,
    zone_surface,
)
from uavlab.plot.maps import ground_risk, risk_norm
from uavlab.plot.stills import layer_triangles, voxel_surface
from uavlab.plot.style import level_of
from uavlab.risk import RiskMap
from uavlab.scene.shapes import as_number, draw_lines, mesh, nearby

FIELD_OF_VIEW_DEG = 40.0


def set_stage(scene: meshcat.Visualizer, city: City, *, painted: bool = False) -> None:
    """Ground, if it isn't painted, light and a camera that sees the whole map."""
    low, high = city.bounds
    size = high - low
    center = (low + high) / 2
    top = max((building.bounds[1, 2] for building in city.buildings), default=high[2])
    floor = low[2] if city.ground is None else city.ground.min()
    center[2] = floor + 0.34 * (max(top, floor) - floor)
    reach = float(np.hypot(size[0], size[1]))
    scene["/Background"].set_property("top_color", [0.86, 0.92, 1.0])
    scene["/Background"].set_property("bottom_color", [1.0, 1.0, 1.0])
    scene["/Axes"].set_property("visible", False)
    scene["/Grid"].set_property("visible", False)
    scene["/Lights/FillLight/<object>"].set_property("position", [-4.0, -7.0, 9.0])
    scene["/Lights/FillLight/<object>"].set_property("intensity", 0.45)
    scene.set_transform(translation_matrix(-nearby(city, center)))  # the camera circles the origin
    camera = scene["/Cameras/default/rotated/<object>"]
    camera.set_property("fov", FIELD_OF_VIEW_DEG)
    camera.set_property("near", reach / 100)
    camera.set_property("far", 20 * reach)
    camera.set_property("position", [0.48 * reach, 0.86 * reach, 1.18 * reach])  # east, up, south
    if city.ground is None:
        corners = np.array([(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])])
        ground = nearby(city, np.column_stack([corners, np.full(4, low[2] - 0.002 * reach)]))
        scene["ground"].set_object(mesh(ground[[[0, 1, 2], [0, 2, 3]]]), g.MeshBasicMaterial(color=0xE9E9E4))
    elif not painted:
        lattice = nearby(city, ground_lattice(city))
        vertices = np.round(256 * lattice.reshape(-1, 3)) / 256  # short numbers make small pages
        land = g.TriangularMeshGeometry(vertices.astype(np.float32), lattice_triangles(lattice.shape[:2]))
        scene["ground"].set_object(land, g.MeshLambertMaterial(color=as_number(LAND_COLOR), side=2))
    draw_lines(scene["grid"], nearby(city, grid_lines(city, 0.002 * reach)), 0xB8B8B0)


def grid_lines(city: City, lift: float) -> np.ndarray:
    """Ends (2L, 3) [m] of a grid's lines: on the bottom of the map, or `lift` above its ground, which they follow."""
    (low, high), spacing = city.bounds, grid_spacing(city)
    lines = []
    for axis, other in ((0, 1), (1, 0)):
        count = 2 if city.ground is None else min(city.shape[other], MOST_QUADS) + 1
        for value in np.arange(np.ceil(low[axis] / spacing) * spacing, high[axis] + 1e-9, spacing):
            points = np.full((count, 3), low[2])
            points[:, axis] = value
            points[:, other] = np.linspace(low[other], high[other], count)
            if city.ground is not None:
                points[:, 2] = ground_below(city, points) + lift
            lines.append(np.repeat(points, 2, axis=0)[1:-1])
    return np.concatenate(lines)


def grid_spacing(city: City) -> float:
    """A round number of metres that divides the map into about ten squares."""
    extent = float((city.bounds[1] - city.bounds[0])[:2].max())
    magnitude = 10.0 ** np.floor(np.log10(extent / 10))
    return float(magnitude * min((1, 2, 5, 10), key=lambda m: abs(extent / (magnitude * m) - 10)))


def draw_city(scene: meshcat.Visualizer, city: City) -> None:
    """All buildings as one mesh with their colours, and their edges as lines."""
    if not city.buildings:
        surface = nearby(city, voxel_surface(city))
        if len(surface):
            scene["voxels"].set_object(mesh(surface), g.MeshLambertMaterial(color=0xB0C4DE))
        return
    surfaces = [building.triangles() for building in city.buildings]
    colors = [
        np.tile(to_rgb(building.color), (3 * len(triangles), 1))
        for building, triangles in zip(city.buildings, surfaces, strict=True)
    ]
    scene["buildings"].set_object(
        mesh(nearby(city, np.concatenate(surfaces)), np.concatenate(colors)), g.MeshLambertMaterial(vertexColors=True)
    )
    edges = np.concatenate([building.edges() for building in city.buildings])
    draw_lines(scene["edges"], nearby(city, edges), 0x555555)


def draw_zones(scene: meshcat.Visualizer, city: City) -> None:
    """All no-fly zones as one mesh that one can look through, and their edges as lines."""
    surface, edges = zone_surface(city)
    if len(surface):
        color = as_number(ZONE_COLOR)
        glass = g.MeshLambertMaterial(color=color, transparent=True, opacity=0.28, side=2, depthWrite=False)
        scene["walls"].set_object(mesh(nearby(city, surface)), glass)
        draw_lines(scene["edges"], nearby(city, edges), color)


def draw_risk(scene: meshcat.Visualizer, risk_map: RiskMap, slice_height: float | None) -> None:
    """The ground painted with the risk above it, and a slice at a height, both on one logarithmic scale."""
    city = risk_map.city
    norm = risk_norm(risk_map)

    def paint(name: str, values: np.ndarray, shown: np.ndarray, height: npt.ArrayLike, opacity: float) -> None:
        triangles = layer_triangles(city, height)[shown.ravel()].reshape(-1, 3, 3)
        colors = np.repeat(SEQUENTIAL(norm(values[shown]))[:, :3], 6, axis=0)
        material = g.MeshBasicMaterial(vertexColors=True, transparent=opacity < 1, opacity=opacity, side=2)
        scene[name].set_object(mesh(nearby(city, triangles), colors), material)

    everywhere = np.ones(city.shape[:2], dtype=bool)
    below = city.origin[2] if city.ground is None else ground_lattice(city, max(city.shape))[..., 2]
    paint("ground", ground_risk(risk_map), everywhere, below + 0.01 * city.cell, 1.0)
    if slice_height is not None:
        k = level_of(city, slice_height)
        paint("slice", risk_map.rate[:, :, k], risk_map.flyable[:, :, k], slice_height, 0.6)
