"""What a scene consists of, whoever draws it: the page in a browser, or the still on paper.

Coordinates are metres in the map's frame, east, north, up. Both drawers count from `Drawing.center`, so that a map far
from its origin, as in UTM, is drawn exactly in the 32 bits of a graphics card.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Literal, NamedTuple

import numpy as np
from matplotlib.colors import LogNorm, to_rgb
from scipy.spatial import ConvexHull, QhullError
from scipy.spatial.transform import Rotation

from uavlab.plot.colors import Style
from uavlab.scene.camera import DIRECTIONS


@dataclass(frozen=True, eq=False)
class Surface:
    """Triangles of one kind of thing."""

    triangles: np.ndarray
    """(T, 3, 3) [m]"""
    color: str | np.ndarray
    """One for all, or a colour (T, 3) for each triangle."""
    opacity: float = 1.0
    lit: bool = True
    """Whether its brightness depends on how it lies to the light."""
    closed: bool = False
    """Whether it is seen from outside only: that is drawn in half of the time."""

    @property
    def colors(self) -> np.ndarray:
        """Of each triangle, (T, 3)."""
        colors = to_rgb(self.color) if isinstance(self.color, str) else self.color
        return np.broadcast_to(colors, (len(self.triangles), 3))


@dataclass(frozen=True, eq=False)
class Lines:
    """Straight lines, one pixel wide."""

    ends: np.ndarray
    """(2L, 3) [m], each two make a line."""
    color: str


@dataclass(frozen=True, eq=False)
class Dots:
    """Points that are as large as a voxel."""

    points: np.ndarray
    """(N, 3) [m]"""
    color: str
    size: float
    """[m]"""


Part = Surface | Lines | Dots

MarkerKind = Literal["start", "goal", "stopped", "missed", "crash"]
"""A disc, a triangle, a square, a hollow triangle where it should have arrived, an X: as in plans."""


class Marker(NamedTuple):
    """A sign that is as large from everywhere and that nothing hides."""

    kind: MarkerKind
    place: np.ndarray
    """(3,) [m]"""
    color: str
    since: float = 0.0
    """On the clock of the animation."""


@dataclass(frozen=True, eq=False)
class Mover:
    """A UAV on its way."""

    color: str
    time: np.ndarray
    """(K,) on the clock of the animation, rising."""
    points: np.ndarray
    """(K, 3) where it is then [m]."""
    turn: np.ndarray
    """(K, 4) how its body is turned: quaternion x, y, z, w."""
    body: Surface
    """About its centre, nose to the east [m]."""
    ball: Surface | None = None
    """The distance to keep."""

    def at(self, moment: float) -> tuple[np.ndarray, np.ndarray]:
        """Place (3,) [m] and turn (4,) at a moment, between the keys linearly."""
        place = np.array([np.interp(moment, self.time, axis) for axis in self.points.T])
        turn = np.array([np.interp(moment, self.time, part) for part in self.turn.T])
        return place, turn / np.linalg.norm(turn)


class Entry(NamedTuple):
    """A line of the legend."""

    kind: Literal["line", "thin", "patch", "ball", "wind"] | MarkerKind
    text: str
    color: str
    style: Style | None = None


@dataclass(eq=False)
class Drawing:
    """A whole scene."""

    title: str
    center: np.ndarray
    """(3,) from where coordinates are counted [m]."""
    box: np.ndarray
    """(2, 3) lowest and highest corner of what is to be seen [m]."""
    parts: dict[str, Part] = field(default_factory=dict)
    near_only: set[str] = field(default_factory=set)
    """Parts that are there only while the eye is nearer to its target than `closeup`, in place of `far_only`."""
    far_only: set[str] = field(default_factory=set)
    closeup: float = 0.0
    """[m]"""
    since: dict[str, float] = field(default_factory=dict)
    """When parts appear on the animation's clock; those that aren't named are always there."""
    movers: list[Mover] = field(default_factory=list)
    markers: list[Marker] = field(default_factory=list)
    legend: list[Entry] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    """Sentences below the legend."""
    risk: LogNorm | None = None
    """Its scale, where colours are risk."""
    order: int = 0
    """How many expanded nodes the colours of the order stand for."""
    duration: float = 0.0
    """Of the animation, on its clock: seconds of flight, or expanded nodes."""
    unit: Literal["s", "nodes"] = "s"
    wind: np.ndarray = field(default_factory=lambda: np.zeros(2))
    """(2,) where the mean wind blows to, east and north [m/s]."""
    overview: tuple[float, float] = DIRECTIONS["overview"]
    """From which side most of the ways is seen: azimuth and elevation [degrees]."""
    seen: list[np.ndarray] = field(default_factory=list)
    """Points (N, 3) [m] that a camera should have in its frame."""

    @property
    def cameras(self) -> dict[str, tuple[float, float]]:
        """Azimuth and elevation of the cameras that have a name [degrees]."""
        return DIRECTIONS | {"overview": self.overview}

    def near(self, points: np.ndarray) -> np.ndarray:
        """Points (..., 3) from the centre [m]."""
        return points - self.center

    def outline(self) -> np.ndarray:
        """The outermost of the points to be seen, (N, 3) from the centre [m]: a frame that has them has all."""
        points = self.near(np.unique(np.round(np.concatenate(self.seen), 2), axis=0))
        try:
            return points[ConvexHull(points).vertices]
        except QhullError:  # all in one plane: flat ground
            return points[ConvexHull(points[:, :2]).vertices]

    def shown(self, moment: float, distance: float) -> dict[str, Part]:
        """The parts that are there at a moment, seen from a distance [m], and the UAVs where they are then."""
        hidden = self.far_only if distance < self.closeup else self.near_only
        parts = {
            name: part
            for name, part in self.parts.items()
            if self.since.get(name, 0.0) <= moment and name not in hidden
        }
        for number, mover in enumerate(self.movers):
            place, turn = mover.at(moment)
            for name, surface in (("uav", mover.body), ("ball", mover.ball)):
                if surface is not None:
                    parts[f"{name}{number}"] = moved(surface, place, turn)
        return parts


def moved(surface: Surface, place: np.ndarray, turn: np.ndarray) -> Surface:
    """A surface about the origin, turned by a quaternion and brought to a place."""
    triangles = Rotation.from_quat(turn).apply(surface.triangles.reshape(-1, 3)).reshape(-1, 3, 3) + place
    return Surface(triangles, surface.color, surface.opacity, surface.lit, surface.closed)


def plain_values(values: np.ndarray, digits: int) -> list[Any]:
    """Numbers as a page keeps them: rounded, so that they take little room."""
    return np.round(values, digits).tolist()
