"""A picture of triangles and lines, each pixel by what is nearest there: a rasteriser with a depth buffer.

Every corner is brought to the frame by the pinhole camera, x = f a / w, with w its depth. Inside a triangle 1/w is
linear in the picture, so its depth at a pixel is exact, and no triangle has to be sorted or cut: two that pass through
each other are drawn as they are. What can be looked through is drawn last, from far to near, over what is behind it.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.colors import to_rgb

from uavlab.compiled import compiled
from uavlab.scene.camera import FIELD_OF_VIEW_DEG, View
from uavlab.scene.drawing import Dots, Lines, Part, Surface

FINER = 2
"""Pixels are drawn so many times finer on each axis and averaged, so that edges are smooth."""
AMBIENT, SUNLIT = 0.6, 0.45
SUN = np.array([-4.0, -7.0, 9.0]) / np.linalg.norm([-4.0, -7.0, 9.0])
"""Light: as in the page, from the south-west and above."""
SKY = np.array([(0.86, 0.92, 1.0), (1.0, 1.0, 1.0)])
"""Of the background, above and below."""
NEAREST = 0.02
"""What is nearer to the eye, as a share of its distance from the target, is cut off."""
LIFTED = 1.002
"""Lines are drawn by so much nearer than they are: those on a face are on it, not in it."""


class Frame:
    """A picture that is being drawn, of a width and height in pixels, as a view sees it."""

    def __init__(self, view: View, width: int, height: int) -> None:
        self.view, self.shape = view, (FINER * height, FINER * width)
        share = np.linspace(0.0, 1.0, self.shape[0])[:, None, None]
        self.pixels = np.broadcast_to((1 - share) * SKY[0] + share * SKY[1], (*self.shape, 3)).copy()
        self.near = np.zeros(self.shape)
        """1/w of what is drawn: 0 is far away."""
        back = view.eye - view.target
        self.distance = float(np.linalg.norm(back))
        back = back / self.distance
        self.axes = np.array([np.cross(view.up, back), view.up, back])
        self.focus = self.shape[0] / 2 / np.tan(np.radians(FIELD_OF_VIEW_DEG) / 2)

    def projected(self, points: np.ndarray) -> np.ndarray:
        """Points (..., 3) [m] in the fine picture: column, row, and 1/w; 1/w is not above 0 behind the eye."""
        a, b, back = np.moveaxis((points - self.view.eye) @ self.axes.T, -1, 0)
        with np.errstate(divide="ignore"):
            inverse = np.where(-back > NEAREST * self.distance, 1.0 / -back, -1.0)
        return np.stack([
            self.shape[1] / 2 + self.focus * a * inverse, self.shape[0] / 2 - self.focus * b * inverse, inverse
        ], axis=-1)  # fmt: skip

    def draw(self, parts: Mapping[str, Part], center: np.ndarray) -> None:
        """Draw parts, whose coordinates are counted from a centre (3,) [m]."""
        surfaces = [part for part in parts.values() if isinstance(part, Surface) and len(part.triangles)]
        solid = [surface for surface in surfaces if surface.opacity == 1]
        glass = [surface for surface in surfaces if surface.opacity < 1]
        for surface in solid:
            self.fill(surface, center)
        for part in parts.values():
            if isinstance(part, Lines):
                ends = self.projected(self.shortened((part.ends - center).reshape(-1, 2, 3)))
                stroke(self.pixels, self.near, ends, np.array(to_rgb(part.color)), FINER)
            elif isinstance(part, Dots):
                places = self.projected(part.points - center)
                dot(self.pixels, self.near, places, np.array(to_rgb(part.color)), part.size * self.focus)
        for surface in sorted(glass, key=lambda one: -float(np.linalg.norm(one.triangles.mean((0, 1)) - center
                                                                           - self.view.eye))):  # fmt: skip
            self.fill(surface, center)

    def fill(self, surface: Surface, center: np.ndarray) -> None:
        """Draw a surface; one that can be looked through from its farthest triangle to its nearest."""
        triangles = surface.triangles - center
        colors = shaded(triangles, surface.colors, self.view.eye) if surface.lit else surface.colors
        triangles, colors = self.cut(triangles, colors)
        order = np.arange(len(triangles))
        if surface.opacity < 1:
            order = np.argsort(-np.linalg.norm(triangles.mean(axis=1) - self.view.eye, axis=1), kind="stable")
        corners = self.projected(triangles[order])
        fill(self.pixels, self.near, corners, np.ascontiguousarray(colors[order], dtype=float), surface.opacity)

    def cut(self, triangles: np.ndarray, colors: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Triangles (T, 3, 3) and their colours (T, 3), those that reach behind the eye cut off in front of it."""
        depth = self.ahead(triangles)
        ahead = depth > 0
        kept, tones = [triangles[ahead.all(axis=1)]], [colors[ahead.all(axis=1)]]
        for number in np.flatnonzero(ahead.any(axis=1) & ~ahead.all(axis=1)):
            polygon = []
            for corner in range(3):
                here, there = triangles[number, corner], triangles[number, (corner + 1) % 3]
                d, e = depth[number, corner], depth[number, (corner + 1) % 3]
                if d > 0:
                    polygon.append(here)
                if (d > 0) != (e > 0):
                    polygon.append(here + d / (d - e) * (there - here))
            kept += [np.array([[polygon[0], polygon[n], polygon[n + 1]]]) for n in range(1, len(polygon) - 1)]
            tones += [colors[number : number + 1]] * (len(polygon) - 2)
        return np.concatenate(kept), np.concatenate(tones)

    def shortened(self, ends: np.ndarray) -> np.ndarray:
        """Lines (L, 2 ends, 3), those that reach behind the eye cut off in front of it."""
        depth = self.ahead(ends)
        crosses = (depth > 0).any(axis=1) & (depth <= 0).any(axis=1)
        cut = ends.copy()
        for end, other in ((0, 1), (1, 0)):
            behind = crosses & (depth[:, end] <= 0)
            share = depth[behind, other] / (depth[behind, other] - depth[behind, end])
            cut[behind, end] = ends[behind, other] + share[:, None] * (ends[behind, end] - ends[behind, other])
        return cut

    def ahead(self, points: np.ndarray) -> np.ndarray:
        """How far points (..., 3) lie before the plane in front of the eye where things are cut off [m]."""
        return -((points - self.view.eye) @ self.axes[2]) - 1.01 * NEAREST * self.distance

    def picture(self) -> np.ndarray:
        """(height, width, 3) from 0 to 1, averaged from the finer one."""
        height, width = self.shape
        fine = self.pixels.reshape(height // FINER, FINER, width // FINER, FINER, 3)
        return np.clip(fine.mean(axis=(1, 3)), 0.0, 1.0)

    def places(self, points: np.ndarray) -> np.ndarray:
        """Column and row (N, 2) of points (N, 3) [m] from the centre in the picture; NaN behind the eye."""
        found = self.projected(points)
        return np.where(found[..., 2:] > 0, found[..., :2] / FINER, np.nan)


def shaded(triangles: np.ndarray, colors: np.ndarray, eye: np.ndarray) -> np.ndarray:
    """Colours (T, 3) of triangles (T, 3, 3) in the light that falls on the side that is seen."""
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True) + 1e-12
    away = np.einsum("ij,ij->i", normals, eye - triangles[:, 0]) < 0
    normals[away] *= -1
    return np.clip((AMBIENT + SUNLIT * np.clip(normals @ SUN, 0.0, 1.0))[:, None] * colors, 0.0, 1.0)


@compiled
def fill(pixels, near, corners, colors, opacity):
    """Draw triangles (T, 3 corners, 3) given by column, row and 1/w where nothing nearer is drawn yet."""
    height, width = near.shape
    for t in range(len(corners)):
        (ax, ay, aw), (bx, by, bw), (cx, cy, cw) = corners[t]
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if aw <= 0 or bw <= 0 or cw <= 0 or area == 0:
            continue
        if area < 0:
            (bx, by, bw), (cx, cy, cw), area = (cx, cy, cw), (bx, by, bw), -area
        left, right = max(0, int(np.floor(min(ax, bx, cx)))), min(width - 1, int(np.ceil(max(ax, bx, cx))))
        top, bottom = max(0, int(np.floor(min(ay, by, cy)))), min(height - 1, int(np.ceil(max(ay, by, cy))))
        for row in range(top, bottom + 1):
            y = row + 0.5
            for column in range(left, right + 1):
                x = column + 0.5
                a, b, c = inward(bx, by, cx, cy, x, y), inward(cx, cy, ax, ay, x, y), inward(ax, ay, bx, by, x, y)
                if a < 0 or b < 0 or c < 0:
                    continue
                depth = (a * aw + b * bw + c * cw) / area
                if depth <= near[row, column]:
                    continue
                for channel in range(3):
                    behind = pixels[row, column, channel]
                    pixels[row, column, channel] = opacity * colors[t, channel] + (1.0 - opacity) * behind
                if opacity == 1.0:
                    near[row, column] = depth


@compiled
def inward(px, py, qx, qy, x, y):
    """Twice the area between an edge and a point, below 0 outside; an edge belongs to one of its two triangles."""
    area = (px - x) * (qy - y) - (py - y) * (qx - x)
    if area == 0 and (qy < py or (qy == py and qx < px)):
        return -1.0
    return area


@compiled
def stroke(pixels, near, ends, color, width):
    """Draw lines (L, 2 ends, 3) given by column, row and 1/w, `width` fine pixels wide."""
    rows, columns = near.shape
    for number in range(len(ends)):
        (ax, ay, aw), (bx, by, bw) = ends[number]
        if aw <= 0 or bw <= 0:
            continue
        begin, end = 0.0, 1.0  # of it lies in the picture
        for place, reach, size in ((ax, bx - ax, columns), (ay, by - ay, rows)):
            if reach != 0:
                first, last = (-width - place) / reach, (size + width - place) / reach
                begin, end = max(begin, min(first, last)), min(end, max(first, last))
            elif place < -width or place > size + width:
                end = -1.0
        if begin > end:
            continue
        steps = int((end - begin) * max(abs(bx - ax), abs(by - ay))) + 1
        for step in range(steps + 1):
            share = begin + (end - begin) * step / steps
            x, y = ax + share * (bx - ax), ay + share * (by - ay)
            depth = (aw + share * (bw - aw)) * LIFTED
            column, row = int(np.floor(x - width / 2 + 0.5)), int(np.floor(y - width / 2 + 0.5))
            for i in range(max(0, row), min(rows, row + width)):
                for j in range(max(0, column), min(columns, column + width)):
                    if depth > near[i, j]:
                        pixels[i, j] = color
                        near[i, j] = depth


@compiled
def dot(pixels, near, places, color, size):
    """Draw squares about places (N, 3) given by column, row and 1/w, as large as `size` times 1/w."""
    rows, columns = near.shape
    for x, y, depth in places:
        if depth <= 0:
            continue
        half = max(0.5, size * depth / 2)
        for i in range(max(0, int(np.ceil(y - half - 0.5))), min(rows, int(np.floor(y + half - 0.5)) + 1)):
            for j in range(max(0, int(np.ceil(x - half - 0.5))), min(columns, int(np.floor(x + half - 0.5)) + 1)):
                if depth > near[i, j]:
                    pixels[i, j] = color
                    near[i, j] = depth
