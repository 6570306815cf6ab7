"""How a UAV moves in a scene: where it is at each moment, and how it turns and tilts for it.

A multirotor pushes along its own axis only. So its axis points where the force does that accelerates it, holds it up
and overcomes the drag of the air that passes it: T n = m (a + g) + ½ ρ C S |v − w| (v − w).
"""

from __future__ import annotations

import numpy as np
from matplotlib.colors import to_rgb
from scipy.ndimage import uniform_filter1d
from scipy.spatial.transform import Rotation

from uavlab.flight import Flight
from uavlab.plot.colors import Style
from uavlab.route import Route
from uavlab.scene.drawing import Mover, Surface
from uavlab.scene.shapes import ball, quadrotor
from uavlab.vehicle import GRAVITY, UAV
from uavlab.weather import Wind

MOST_KEYS = 300
"""Of one UAV's motion, so that its page stays small."""
SMOOTHED = 0.6
"""Over how long velocities are averaged [s]: logged ones shake, and a route's jump at each waypoint."""
CALM = Wind(deviation=0.0)


def along_route(route: Route, uav: UAV) -> tuple[np.ndarray, np.ndarray]:
    """When a UAV at cruise speed is where on a route: time (K,) [s], and (K, 3) [m]."""
    corners = route.distance / uav.cruise_speed
    time = np.union1d(corners, np.linspace(0.0, corners[-1], MOST_KEYS // 2))
    return time, np.column_stack([np.interp(time, corners, axis) for axis in route.points.T])


def along_flight(flight: Flight, keys: int) -> tuple[np.ndarray, np.ndarray]:
    """When a UAV was where on a flight: time (K,) [s], at most about so many, and (K, 3) [m]; the end is exact."""
    rows = np.unique(np.linspace(0, len(flight.log) - 1, min(keys, len(flight.log))).astype(int))
    return flight.time[rows] - flight.time[0], flight.position[rows]


def turned(time: np.ndarray, points: np.ndarray, uav: UAV, wind: Wind) -> np.ndarray:
    """How the body is turned at each moment (K, 4), as x, y, z, w: its nose along the way, its axis along the force."""
    if len(time) < 2 or time[-1] <= time[0]:
        return np.tile([0.0, 0.0, 0.0, 1.0], (len(time), 1))
    even = np.linspace(time[0], time[-1], max(2, min(4 * MOST_KEYS, int(20 * (time[-1] - time[0])) + 2)))
    step = even[1] - even[0]
    path = np.column_stack([np.interp(even, time, axis) for axis in points.T])
    window = max(1, round(SMOOTHED / step))
    velocity = uniform_filter1d(np.gradient(path, step, axis=0), window, axis=0, mode="nearest")
    acceleration = uniform_filter1d(np.gradient(velocity, step, axis=0), window, axis=0, mode="nearest")
    air = velocity - np.array(wind.mean)
    drag = 0.5 * wind.air_density * uav.drag_area / (uav.weight / GRAVITY)
    force = acceleration + [0.0, 0.0, GRAVITY] + drag * np.linalg.norm(air, axis=1, keepdims=True) * air
    force[:, 2] = np.maximum(force[:, 2], 0.2 * GRAVITY)
    upward = np.column_stack([np.interp(time, even, axis) for axis in force.T])
    nose = headings(velocity)[np.round((time - time[0]) / step).astype(int)]
    axis = upward / np.linalg.norm(upward, axis=1, keepdims=True)
    left = np.cross(axis, np.column_stack([nose, np.zeros(len(nose))]))
    left /= np.linalg.norm(left, axis=1, keepdims=True)
    turn = Rotation.from_matrix(np.stack([np.cross(left, axis), left, axis], axis=-1)).as_quat()
    back = np.einsum("ij,ij->i", turn[1:], turn[:-1]) < 0  # q and -q are one turn, but what lies between them isn't
    turn[1:] *= np.where(np.cumsum(back) % 2, -1.0, 1.0)[:, None]
    return turn


def headings(velocity: np.ndarray) -> np.ndarray:
    """Where the nose points (K, 2): along the way on the map, and as before while it only climbs or hovers."""
    level = velocity[:, :2]
    speed = np.linalg.norm(level, axis=1)
    moves = np.flatnonzero(speed > 0.2)
    if not len(moves):
        return np.tile([1.0, 0.0], (len(velocity), 1))
    last = np.maximum(np.searchsorted(moves, np.arange(len(velocity)), side="right") - 1, 0)
    return level[moves[last]] / speed[moves[last], None]


def mover(
    time: np.ndarray, points: np.ndarray, style: Style, uav: UAV, wind: Wind, safe_distance: float | None
) -> Mover:
    """A UAV at its size, in the colour of its track, with the ball of the distance to keep."""
    body = Surface(*quadrotor(uav.diameter, to_rgb(style.color)), closed=True)
    around = None if safe_distance is None else Surface(ball(safe_distance), style.color, opacity=0.22)
    return Mover(style.color, time, points, turned(time, points, uav, wind), body, around)
