"""Shapes of a scene: tubes, cones, a quadrotor, as one mesh for each kind of thing."""

from __future__ import annotations

from itertools import pairwise

import meshcat
import meshcat.geometry as g
import numpy as np
from meshcat.transformations import translation_matrix

from uavlab.city import City
from uavlab.route import Route

FAR_OFF = 1000.0
"""Scenes lie about the multiple of this that is next to their map's centre [m]: viewers count in float32."""


def nearby(city: City, points: np.ndarray) -> np.ndarray:
    """Points (..., 3) [m] of a map that may lie far off, such as in UTM, from a multiple of a kilometre near it."""
    return points - FAR_OFF * np.round(city.bounds.mean(axis=0) / FAR_OFF)


def draw_route(scene: meshcat.Visualizer, city: City, route: Route, color: str, *, thin: bool = False) -> None:
    """A route as a tube, a ball at its start and a cone at its goal."""
    draw_way(scene, city, route.points, color, thickness=0.4 if thin else 1.0)
    draw_goal(scene["goal"], city, route.points[-1], color)


def draw_way(scene: meshcat.Visualizer, city: City, points: np.ndarray, color: str, *, thickness: float = 1.0) -> None:
    """A tube along points, and a ball at the first of them."""
    radius, material = tube_radius(city), g.MeshLambertMaterial(color=as_number(color))
    surface = tube(nearby(city, points), thickness * radius)
    if len(surface):  # a UAV that stays where it is leaves none
        scene["tube"].set_object(mesh(surface), material)
    scene["start"].set_object(g.Sphere(2.5 * radius), material)
    scene["start"].set_transform(translation_matrix(nearby(city, points[0])))


def draw_goal(scene: meshcat.Visualizer, city: City, goal: np.ndarray, color: str) -> None:
    """A cone around the goal."""
    radius = tube_radius(city)
    cone = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 6 * radius]])
    shape = mesh(tube(cone, 3 * radius, end_radius=0.0))
    scene.set_object(shape, g.MeshLambertMaterial(color=as_number(color)))
    scene.set_transform(translation_matrix(nearby(city, goal) - [0.0, 0.0, 3 * radius]))


def tube_radius(city: City) -> float:
    """Of a route's tube [m], by the size of the map."""
    return 0.004 * float(np.linalg.norm(city.bounds[1] - city.bounds[0]))


def as_number(color: str) -> int:
    """#rrggbb as meshcat has it."""
    return int(color.lstrip("#"), 16)


def draw_uav(scene: meshcat.Visualizer, city: City, safe_distance: float | None) -> None:
    """A quadrotor, larger than life, with the ball around it that should stay clear."""
    scale = 0.02 * float(np.linalg.norm(city.bounds[1] - city.bounds[0]))
    scene["body"].set_object(mesh(quadrotor(scale)), g.MeshLambertMaterial(color=0x222222, side=2))
    if safe_distance is not None:
        scene["clearance"].set_object(
            g.Sphere(safe_distance), g.MeshLambertMaterial(color=0xFFFFFF, transparent=True, opacity=0.35)
        )


def mesh(triangles: np.ndarray, colors: np.ndarray | None = None) -> g.TriangularMeshGeometry:
    """Triangles (T, 3, 3) as a geometry; no corner is shared, so that the light shows each face flat."""
    vertices = np.asarray(triangles, dtype=np.float32).reshape(-1, 3)
    return g.TriangularMeshGeometry(vertices, np.arange(len(vertices)).reshape(-1, 3), color=colors)


def draw_lines(scene: meshcat.Visualizer, ends: np.ndarray, color: int) -> None:
    """Straight lines between each two of the points (2L, 3)."""
    geometry = g.PointsGeometry(np.asarray(ends, dtype=np.float32).T)
    scene.set_object(g.LineSegments(geometry, g.LineBasicMaterial(color=color)))


def tube(points: np.ndarray, radius: float, *, end_radius: float | None = None, sides: int = 8) -> np.ndarray:
    """Triangles (T, 3, 3) of a round tube along a polyline (N, 3); with `end_radius` each leg is a cone."""
    angle = np.linspace(0.0, 2 * np.pi, sides + 1)[:, None]
    triangles = []
    for start, end in pairwise(np.asarray(points, dtype=float)):
        along = end - start
        length = np.linalg.norm(along)
        if length == 0:
            continue
        along = along / length
        across = np.cross(along, [0.0, 0.0, 1.0] if abs(along[2]) < 0.9 else [1.0, 0.0, 0.0])
        across /= np.linalg.norm(across)
        ring = np.cos(angle) * across + np.sin(angle) * np.cross(along, across)
        low, high = start + radius * ring, end + (radius if end_radius is None else end_radius) * ring
        triangles.append(np.stack([low[:-1], low[1:], high[1:]], axis=1))
        triangles.append(np.stack([low[:-1], high[1:], high[:-1]], axis=1))
        triangles.append(np.stack([low[1:], low[:-1], np.broadcast_to(start, (sides, 3))], axis=1))
        triangles.append(np.stack([high[:-1], high[1:], np.broadcast_to(end, (sides, 3))], axis=1))
    return np.concatenate(triangles) if triangles else np.empty((0, 3, 3))


def quadrotor(size: float) -> np.ndarray:
    """Triangles of a small quadrotor, `size` metres from rotor axis to centre: two arms and four discs."""
    tips = size * np.array([(1, 1, 0), (-1, 1, 0), (-1, -1, 0), (1, -1, 0)]) / np.sqrt(2)
    parts = [tube(tips[[0, 2]], 0.08 * size), tube(tips[[1, 3]], 0.08 * size)]
    axle = np.array([[0.0, 0.0, 0.1 * size], [0.0, 0.0, 0.14 * size]])
    parts += [tube(tip + axle, 0.55 * size, sides=16) for tip in tips]
    parts.append(tube(np.array([[0.0, 0.0, -0.15 * size], [0.0, 0.0, 0.15 * size]]), 0.3 * size))
    return np.concatenate(parts)
