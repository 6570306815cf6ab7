"""Shapes of a scene as triangles: tubes, balls, arrows, a wind sock, a quadrotor."""

from __future__ import annotations

import numpy as np

from uavlab.plot.colors import LineStyle

SIDES = 6
"""Of a tube."""
DASHES: dict[str, tuple[float, ...]] = {"-": (), "--": (3.7, 1.6), "-.": (6.4, 1.6, 1.0, 1.6), ":": (1.0, 1.65)}
"""Lengths drawn and left out, in widths of the line, as in matplotlib."""


def tube(points: np.ndarray, radius: float) -> np.ndarray:
    """Triangles (T, 3, 3) of a closed tube along a polyline (N, 3), mitred where it bends."""
    points = without_repeats(np.asarray(points, dtype=float))
    if len(points) < 2:
        return np.empty((0, 3, 3))
    legs = np.diff(points, axis=0)
    legs /= np.linalg.norm(legs, axis=1, keepdims=True)
    along = np.vstack([legs[:1], legs[:-1] + legs[1:], legs[-1:]])
    sharp = np.linalg.norm(along, axis=1) < 0.5
    along[sharp] = np.vstack([legs, legs[-1:]])[sharp]
    angle = 2 * np.pi * np.arange(SIDES) / SIDES
    rings = np.empty((len(points), SIDES, 3))
    side = np.cross(along[0], np.eye(3)[np.abs(along[0]).argmin()])
    for number, direction in enumerate(along / np.linalg.norm(along, axis=1, keepdims=True)):
        side = side - side @ direction * direction  # carried along, so that the tube doesn't twist
        if np.linalg.norm(side) < 1e-6:
            side = np.cross(direction, np.eye(3)[np.abs(direction).argmin()])
        side /= np.linalg.norm(side)
        ring = np.cos(angle)[:, None] * side + np.sin(angle)[:, None] * np.cross(direction, side)
        rings[number] = points[number] + radius * ring
    ends = fan(rings[0][::-1], points[0]), fan(rings[-1], points[-1])
    return np.concatenate([wall(rings), *ends])


def wall(rings: np.ndarray) -> np.ndarray:
    """Triangles between rings (R, S, 3), each joined to the next."""
    low, high = rings[:-1], rings[1:]
    next_low, next_high = np.roll(low, -1, axis=1), np.roll(high, -1, axis=1)
    halves = np.stack([low, next_low, next_high], axis=2), np.stack([low, next_high, high], axis=2)
    return np.concatenate(halves).reshape(-1, 3, 3)


def fan(ring: np.ndarray, tip: np.ndarray) -> np.ndarray:
    """Triangles between a ring (S, 3) and a point."""
    return np.stack([ring, np.roll(ring, -1, axis=0), np.broadcast_to(tip, ring.shape)], axis=1)


def without_repeats(points: np.ndarray) -> np.ndarray:
    """A polyline (N, 3) without points that are where the one before them is."""
    return points[np.concatenate([[True], (np.diff(points, axis=0) != 0).any(axis=1)])]


def thinned(points: np.ndarray, tolerance: float) -> np.ndarray:
    """A polyline without the points that lie within a tolerance [m] of the line between their neighbours."""
    points = without_repeats(points)
    kept = np.arange(len(points))
    for tries in range(40):
        before, here, after = points[kept[:-2]], points[kept[1:-1]], points[kept[2:]]
        leg = after - before
        share = np.einsum("ij,ij->i", here - before, leg) / np.maximum(np.einsum("ij,ij->i", leg, leg), 1e-18)
        distance = np.linalg.norm(here - before - np.clip(share, 0, 1)[:, None] * leg, axis=1)
        needless = distance < tolerance / 8  # several rounds add up
        needless[(np.arange(len(needless)) + tries) % 2 == 0] = False  # never two neighbours at once
        if not needless.any() and tries % 2:
            break
        kept = np.delete(kept, np.flatnonzero(needless) + 1)
    return points[kept]


def dashed(points: np.ndarray, line: LineStyle, width: float) -> list[np.ndarray]:
    """The pieces of a polyline that a line style draws, each a polyline; `width` is that of the line [m]."""
    pattern = np.array(DASHES[line] if isinstance(line, str) else line[1]) * width
    points = without_repeats(points)
    if not len(pattern) or len(points) < 2:
        return [points]
    distance = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    turns = int(np.ceil(distance[-1] / pattern.sum()))
    marks = np.concatenate([[0.0], np.cumsum(np.tile(pattern, turns))])
    pieces = []
    for begin, end in zip(marks[:-1:2], np.minimum(marks[1::2], distance[-1]), strict=True):
        if begin < end:
            inner = points[(distance > begin) & (distance < end)]
            tips = np.column_stack([np.interp((begin, end), distance, axis) for axis in points.T])
            pieces.append(np.vstack([tips[:1], inner, tips[1:]]))
    return pieces


def ball(radius: float, *, sides: int = 24) -> np.ndarray:
    """Triangles of a ball about the origin."""
    tilt = np.linspace(-np.pi / 2, np.pi / 2, sides // 2 + 1)[1:-1]
    angle = 2 * np.pi * np.arange(sides) / sides
    rings = np.stack(np.broadcast_arrays(
        np.cos(tilt)[:, None] * np.cos(angle), np.cos(tilt)[:, None] * np.sin(angle), np.sin(tilt)[:, None]
    ), axis=-1)  # fmt: skip
    poles = np.array([[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]])
    return radius * np.concatenate([wall(rings), fan(rings[0][::-1], poles[0]), fan(rings[-1], poles[1])])


def cone(foot: np.ndarray, tip: np.ndarray, radius: float, *, tip_radius: float = 0.0) -> np.ndarray:
    """Triangles of a cone or a frustum between two points."""
    along = (tip - foot) / np.linalg.norm(tip - foot)
    side = np.cross(along, np.eye(3)[np.abs(along).argmin()])
    side /= np.linalg.norm(side)
    angle = 2 * np.pi * np.arange(2 * SIDES) / (2 * SIDES)
    ring = np.cos(angle)[:, None] * side + np.sin(angle)[:, None] * np.cross(along, side)
    rings = np.stack([foot + radius * ring, tip + tip_radius * ring])
    return np.concatenate([wall(rings), fan(rings[0][::-1], foot), fan(rings[1], tip)])


def arrow(foot: np.ndarray, tip: np.ndarray, width: float) -> np.ndarray:
    """Triangles of an arrow."""
    neck = foot + 0.65 * (tip - foot)
    return np.concatenate([tube(np.array([foot, neck]), width / 2), cone(neck, tip, 1.5 * width)])


def wind_sock(foot: np.ndarray, wind: np.ndarray, size: float) -> tuple[np.ndarray, np.ndarray]:
    """Triangles of a mast with a wind sock, and their colours (T, 3): striped, the more level the stronger the wind."""
    top = foot + np.array([0.0, 0.0, size])
    speed = float(np.linalg.norm(wind))
    droop = np.arctan(2.0 / max(speed, 1e-3) ** 2)  # weight against dynamic pressure: level from about 8 m/s on
    level = np.append(wind / max(speed, 1e-9), 0.0)
    along = np.cos(droop) * level - np.sin(droop) * np.array([0.0, 0.0, 1.0])
    radii = 0.14 * size * np.linspace(1.0, 0.5, 6)
    places = top + 0.8 * size * np.linspace(0.0, 1.0, 6)[:, None] * along
    parts = [tube(np.array([foot, top]), 0.02 * size)]
    tones = [(0.25, 0.25, 0.25)]
    for number in range(5):
        parts.append(cone(places[number], places[number + 1], radii[number], tip_radius=radii[number + 1]))
        tones.append((0.84, 0.37, 0.0) if number % 2 == 0 else (1.0, 1.0, 1.0))
    colors = [np.broadcast_to(tone, (len(part), 3)) for part, tone in zip(parts, tones, strict=True)]
    return np.concatenate(parts), np.concatenate(colors)


def quadrotor(diameter: float, color: tuple[float, float, float]) -> tuple[np.ndarray, np.ndarray]:
    """Triangles of a quadrotor about its centre, nose to the east, and their colours (T, 3): front rotors are light."""
    arm = diameter / 3.1
    tips = arm * np.array([(1, 1, 0), (-1, 1, 0), (-1, -1, 0), (1, -1, 0)]) / np.sqrt(2)
    axle = arm * np.array([0.0, 0.0, 0.12])
    parts = [tube(tips[[0, 2]], 0.08 * arm), tube(tips[[1, 3]], 0.08 * arm), ball(0.32 * arm, sides=10)]
    parts += [cone(tip + axle, tip + 1.4 * axle, 0.55 * arm, tip_radius=0.55 * arm) for tip in tips]
    dark, light = 0.75 * np.array(color), 0.35 * np.array(color) + 0.65
    tones = [dark, dark, np.array(color), light, dark, dark, light]
    colors = [np.broadcast_to(tone, (len(part), 3)) for part, tone in zip(parts, tones, strict=True)]
    return np.concatenate(parts), np.concatenate(colors)
