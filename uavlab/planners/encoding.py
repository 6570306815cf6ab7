"""How a vector stands for waypoints: points anywhere on the map, or on planes across the way."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from uavlab.planners.curves import Task


class Encoding(NamedTuple):
    """How a vector stands for K points: each is an anchor plus its block of numbers along the axes [cells]."""

    ends: np.ndarray  # (2, 3): first and last point of the curve
    anchors: np.ndarray  # (K, 3)
    axes: np.ndarray  # (2 or 3, 3), of length 1
    bounds: np.ndarray  # (K · block, 2)

    def control(self, vectors: np.ndarray) -> np.ndarray:
        """Points with both ends (N, K + 2, 3) from vectors (N, D)."""
        inner = self.anchors + vectors.reshape(len(vectors), len(self.anchors), -1) @ self.axes
        first, last = (np.broadcast_to(end, (len(vectors), 1, 3)) for end in self.ends)
        return np.concatenate([first, inner, last], axis=1)

    def vectors(self, control: np.ndarray) -> np.ndarray:
        """Vectors (N, D) from points with both ends, as near as the bounds allow."""
        inner = (control[:, 1:-1] - self.anchors) @ self.axes.T
        return np.clip(inner.reshape(len(control), len(self.bounds)), *self.bounds.T)


def space_of(task: Task, waypoints: int, encoding: str) -> Encoding:
    """Points anywhere on the map, or on vertical planes that cut the way from start to goal evenly."""
    ends = np.stack([task.source, task.target])
    size = np.array(task.sky.closed.shape, float) - 1e-9  # within the last voxel
    if encoding == "points":
        return Encoding(
            ends, np.zeros((waypoints, 3)), np.eye(3), np.tile(np.stack([0 * size, size], 1), (waypoints, 1))
        )
    side = sideways_of(task)
    anchors = task.source + np.linspace(0, 1, waypoints + 2)[1:-1, None] * (task.target - task.source)
    anchors[:, 2] = 0.0
    bounds = np.zeros((waypoints, 2, 2))
    walls = np.sort([(wall - anchors[:, side != 0]) / side[side != 0] for wall in (0.0, size[side != 0])], axis=0)
    bounds[:, 0, 0], bounds[:, 0, 1] = walls[0].max(axis=1), walls[1].min(axis=1)
    bounds[:, 1, 1] = size[2]
    return Encoding(ends, anchors, np.stack([side, (0.0, 0.0, 1.0)]), bounds.reshape(-1, 2))


def sideways_of(task: Task) -> np.ndarray:
    """Unit vector to the left of the way from start to goal on the map; north if the goal is straight above."""
    way = (task.target - task.source)[:2]
    east, north = way / np.linalg.norm(way) if way.any() else (1.0, 0.0)
    return np.array([-north, east, 0.0])
