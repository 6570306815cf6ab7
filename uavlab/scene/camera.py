"""From where a scene is seen: so that what is to be seen fills the frame, whatever its shape."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from uavlab import checks

FIELD_OF_VIEW_DEG = 40.0
"""From the lower to the upper end of the frame."""
MARGIN = 1.04
"""The frame over what is to be seen."""
CLOSEST = 0.1
"""What is to be seen is at least so far from the eye, as a share of the distance of the target."""
DIRECTIONS = {"overview": (-61.0, 38.0), "above": (-90.0, 90.0), "side": (-90.0, 4.0)}
"""Azimuth, from east to north, and height above the horizon of the eye, as seen from the map [degrees]."""
CAMERAS = (*DIRECTIONS, "chase")
CHASE = (6.0, 2.5)
"""How far the eye is behind the UAV that it follows, and how far above it, in sizes of what is to be in view."""

Camera = str | tuple[float, float]


class View(NamedTuple):
    """An eye and what it looks at, both (3,) [m], and which way is up."""

    eye: np.ndarray
    target: np.ndarray
    up: np.ndarray


def checked_camera(camera: Camera) -> Camera:
    """A known camera, or an azimuth and an elevation [degrees]."""
    if isinstance(camera, str):
        return checks.one_of("camera", camera, CAMERAS)
    words = f"camera must be one of {', '.join(CAMERAS)}, or (azimuth, elevation) in degrees"
    try:
        azimuth, elevation = checks.array("camera", camera, 2).tolist()
    except ValueError as problem:
        raise ValueError(f"{words}: {problem}") from None
    if not -90.0 <= elevation <= 90.0:
        raise ValueError(f"{words}: the elevation must be from -90 to 90, got {elevation:g}")
    return azimuth, elevation


def axes_of(azimuth_deg: float, elevation_deg: float) -> np.ndarray:
    """Rows (3, 3): right, up in the picture, and from the target to the eye."""
    azimuth, elevation = np.radians([azimuth_deg, elevation_deg])
    right = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
    back = np.array([*(np.cos(elevation) * np.array([np.cos(azimuth), np.sin(azimuth)])), np.sin(elevation)])
    return np.array([right, np.cross(back, right), back])


def fitted(corners: np.ndarray, azimuth_deg: float, elevation_deg: float, aspect: float) -> View:
    """The nearest view in a direction that has all points (N, 3) in a frame of an aspect, width over height.

    With a, b, w the coordinates to the right, up and towards the eye, and t the tangent of half of the field of view,
    a point is in the frame of an eye at (x, D) if |a − x| ≤ (D − w) t; so D = (max(a + w t) + max(−a + w t)) / 2t,
    unless a point would be at the eye. Then x is where the picture is in the middle.
    """
    axes = axes_of(azimuth_deg, elevation_deg)
    upright = np.tan(np.radians(FIELD_OF_VIEW_DEG) / 2) / MARGIN
    *sideways, toward = axes @ corners.T
    middle = (toward.min() + toward.max()) / 2  # the target lies there, amid of what is to be seen
    toward = toward - middle
    distance = toward.max() / (1 - CLOSEST)
    for across, tangent in zip(sideways, (aspect * upright, upright), strict=True):
        high, low = (across + tangent * toward).max(), (-across + tangent * toward).max()
        distance = max(distance, (high + low) / (2 * tangent))
    target = np.array([middle_of(across, distance - toward) for across in sideways] + [middle]) @ axes
    return View(target + distance * axes[2], target, axes[1])


def middle_of(across: np.ndarray, depth: np.ndarray) -> float:
    """From where points (N,) at depths (N,) [m] reach equally far to both sides in the picture, by bisection."""
    low, high = float(across.min()), float(across.max())
    for _ in range(40):
        middle = (low + high) / 2
        seen = (across - middle) / depth
        low, high = (middle, high) if seen.max() > -seen.min() else (low, middle)
    return (low + high) / 2


def chasing(place: np.ndarray, heading: np.ndarray, size: float) -> View:
    """Behind and above a UAV that flies along a heading (2,), of a size [m]."""
    behind, above = CHASE
    level = np.array([*heading, 0.0]) / max(float(np.hypot(*heading)), 1e-9)
    eye = place - behind * size * level + [0.0, 0.0, above * size]
    right = np.array([level[1], -level[0], 0.0])
    return View(eye, place, np.cross(right, place - eye) / np.linalg.norm(place - eye))
