"""What moves in a scene: a UAV along a route, flights by one clock, the order of a search."""

from __future__ import annotations

import meshcat
import meshcat.geometry as g
import numpy as np
from matplotlib.colors import to_rgb
from meshcat.animation import Animation
from meshcat.transformations import translation_matrix

from uavlab.city import City
from uavlab.flight import Flight
from uavlab.plot.colors import CRASH_COLOR, sequential_color
from uavlab.plot.flights import cross, track
from uavlab.route import Route
from uavlab.scene.shapes import as_number, draw_goal, draw_uav, draw_way, mesh, nearby, tube, tube_radius

FRAMES_PER_SECOND = 30
FLIGHT_SECONDS = 12.0
LAST_FRAME = round(1.2 * FLIGHT_SECONDS * FRAMES_PER_SECOND)
"""Then the animation begins again."""

EXPANSION_BATCHES = 40
MOST_POINTS = 12_000
"""Larger expansions are thinned out evenly, so that their page stays small."""


def animate_route(
    scene: meshcat.Visualizer, city: City, route: Route, safe_distance: float | None, animation: Animation
) -> None:
    """A UAV that flies a route at constant speed, again and again."""
    draw_uav(scene, city, safe_distance)
    share = route.distance / max(route.length, 1e-9)
    move(scene, nearby(city, route.points), share * FLIGHT_SECONDS, animation)


def animate_flight(
    scene: meshcat.Visualizer,
    city: City,
    flight: Flight,
    color: str,
    longest: float,
    safe_distance: float | None,
    animation: Animation,
) -> None:
    """The track of a flight and a UAV on it, by a clock that shows `longest` seconds; a crash is a red X."""
    time, points = track(flight)
    places = nearby(city, np.vstack([points, points[-1]]))
    clock = time / longest * FLIGHT_SECONDS
    draw_way(scene, city, points, color)
    draw_uav(scene["uav"], city, safe_distance)
    move(scene["uav"], places, np.append(clock, LAST_FRAME / FRAMES_PER_SECOND), animation)
    if flight.outcome == "arrived":
        draw_goal(scene["goal"], city, points[-1], color)
    if flight.outcome == "crashed":
        arms = cross(places[-1], 7 * tube_radius(city))
        beams = np.concatenate([tube(arm, 1.6 * tube_radius(city)) for arm in arms])
        through_walls = {"depthTest": False}  # a crash behind a building is to be seen, too
        red = g.MeshBasicMaterial(color=as_number(CRASH_COLOR), transparent=True, **through_walls)
        scene["crash"].set_object(mesh(beams), red)
        appear(scene, "crash", clock[-1] * FRAMES_PER_SECOND, animation)


def move(scene: meshcat.Visualizer, points: np.ndarray, clock: np.ndarray, animation: Animation) -> None:
    """Be at each of the points (N, 3) when the animation's clock (N,) [s] says so."""
    scene.set_transform(translation_matrix(points[0]))
    for point, moment in zip(points, clock, strict=True):
        with animation.at_frame(scene, round(moment * FRAMES_PER_SECOND)) as frame:
            frame.set_transform(translation_matrix(point))


def appear(scene: meshcat.Visualizer, name: str, moment: float, animation: Animation) -> None:
    """Be unseen until a frame, and there until the animation begins again."""
    for frame_number, visible in ((0, False), (max(round(moment), 1), True), (LAST_FRAME, True)):
        with animation.at_frame(scene, frame_number) as frame:
            frame[name].set_property("visible", "boolean", visible)


def animate_expansion(scene: meshcat.Visualizer, city: City, order: np.ndarray, animation: Animation) -> None:
    """Expanded nodes as points that appear in the order of their expansion, first ones dark, last ones bright."""
    shown = order[:: -(-len(order) // MOST_POINTS)]
    batches = np.array_split(shown, min(EXPANSION_BATCHES, len(shown)))
    for number, nodes in enumerate(batches):
        points = nearby(city, city.center_of(city.index_of(nodes))).T.astype(np.float32)
        color = np.array(to_rgb(sequential_color(number / max(len(batches) - 1, 1))), dtype=np.float32)
        name = f"batch{number}"
        scene[name].set_object(g.PointCloud(points, np.tile(color, (len(nodes), 1)).T, size=0.9 * city.cell))
        appear(scene, name, 1 + number * FLIGHT_SECONDS * FRAMES_PER_SECOND / len(batches), animation)
