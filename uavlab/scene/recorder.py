"""A drawing as commands for meshcat's viewer, packed into one page that needs no server."""

from __future__ import annotations

import base64
import gzip
import html
import json
from collections.abc import Mapping
from functools import lru_cache
from importlib.resources import files
from types import MappingProxyType
from typing import Any, NamedTuple

import meshcat
import meshcat.geometry as g
import numpy as np
import umsgpack
from matplotlib.colors import to_hex, to_rgb

from uavlab.scene.camera import CHASE, CLOSEST, FIELD_OF_VIEW_DEG, MARGIN, Camera
from uavlab.scene.content import MOST_NAMED
from uavlab.scene.drawing import Dots, Drawing, Lines, Part, Surface, plain_values
from uavlab.scene.legend import legend
from uavlab.scene.raster import AMBIENT, SKY, SUNLIT

STEPS = 512
"""Coordinates are rounded to so many parts of a metre, so that pages are small."""
PARTS = {"position": STEPS, "color": 255}
THROUGH = {"transparent": True, "depthWrite": False}


class Recorder:
    """Stands where meshcat expects its window to the server: keeps the commands, and their arrays apart from them.

    Arrays are kept as whole numbers: `STEPS` parts of a metre, 255 parts of a colour, positions of corners. Of each
    column only the differences from row to row are written, the least significant bytes first, all that have the same
    place together: then most bytes are 0, and packing makes an array three to five times smaller.
    """

    def __init__(self) -> None:
        self.commands: dict[tuple[str, str], Any] = {}
        self.names: dict[str, str] = {}
        self.arrays = bytearray()

    def send(self, command: Any) -> None:
        """Keep a command; a later one for the same thing replaces it."""
        lowered = command.lower()
        kind = lowered["type"] + lowered.get("property", "")
        self.commands[lowered["path"], kind] = self.stable(lowered)

    def stable(self, value: Any, name: str = "") -> Any:
        """The same value with random identifiers replaced by a count, and arrays by where they are kept."""
        if isinstance(value, dict) and isinstance(value.get("array"), umsgpack.Ext):
            kind = np.uint32 if name == "index" else np.float32
            numbers = np.frombuffer(value["array"].data, dtype=kind).astype(float)
            return {**value, "array": self.kept(numbers, value["itemSize"], PARTS.get(name, 1))}
        if isinstance(value, dict):
            return {key: self.stable(item, key) for key, item in value.items()}
        if isinstance(value, list):
            return [self.stable(item) for item in value]
        if isinstance(value, str) and len(value) == 36 and value.count("-") == 4:
            return self.names.setdefault(value, f"id{len(self.names)}")
        return value

    def kept(self, numbers: np.ndarray, columns: int, parts: int) -> dict[str, int]:
        """Write an array to the others; the viewer's player reads it again."""
        whole = np.round(parts * numbers.reshape(-1, columns)).astype(np.int32)
        change = np.diff(whole, axis=0, prepend=np.int32(0))
        folded = ((change << 1) ^ (change >> 31)).astype("<u4")  # 0, -1, 1, -2 … as 0, 1, 2, 3 …
        begin = len(self.arrays)
        self.arrays += folded.T.ravel().view(np.uint8).reshape(-1, 4).T.tobytes()
        return {"at": begin, "rows": len(whole), "columns": columns, "parts": parts}


class Joined(g.TriangularMeshGeometry):
    """Triangles or lines that share their corners: those that are equal are kept once."""

    def __init__(self, shapes: np.ndarray, colors: np.ndarray | None = None) -> None:
        corners = np.round(STEPS * shapes.reshape(-1, 3)).astype(np.int64)
        tones = np.zeros((len(corners), 0)) if colors is None else np.round(255 * colors)
        rows = np.column_stack([corners, tones.astype(np.int64)])
        _, first, number = np.unique(rows, axis=0, return_index=True, return_inverse=True)
        order = np.argsort(first)  # as they come: neighbours stay neighbours, and pack well
        place = np.empty_like(order)
        place[order] = np.arange(len(order))
        kept = rows[first[order]]
        super().__init__(kept[:, :3] / STEPS, np.zeros((0, 3)), None if colors is None else kept[:, 3:] / 255)
        self.faces = place[number.ravel()].reshape(-1, shapes.shape[1]).astype(np.uint32)

    def lower(self, object_data: Any) -> Any:
        lowered = super().lower(object_data)
        lowered["data"]["index"]["itemSize"] = 1
        return lowered


def record(drawing: Drawing) -> Recorder:
    """The commands that draw it."""
    window = Recorder()
    scene = meshcat.Visualizer(window=window)
    scene["/Background"].set_property("top_color", SKY[0].tolist())
    scene["/Background"].set_property("bottom_color", SKY[1].tolist())
    for name in ("/Axes", "/Grid", "/Lights/PointLightNegativeX", "/Lights/PointLightPositiveX"):
        scene[name].set_property("visible", False)
    scene["/Lights/AmbientLight/<object>"].set_property("intensity", AMBIENT)
    scene["/Lights/FillLight/<object>"].set_property("position", [-4.0, -7.0, 9.0])
    scene["/Lights/FillLight/<object>"].set_property("intensity", SUNLIT)
    scene["/Cameras/default/rotated/<object>"].set_property("fov", FIELD_OF_VIEW_DEG)
    for name, part in drawing.parts.items():
        draw(scene[name], part, drawing.center)
    for number, mover in enumerate(drawing.movers):
        draw(scene[f"mover{number}"]["body"], mover.body, np.zeros(3))
        if mover.ball is not None:
            draw(scene[f"mover{number}"]["ball"], mover.ball, np.zeros(3))
    return window


def draw(scene: meshcat.Visualizer, part: Part, center: np.ndarray) -> None:
    """One part as meshcat has it."""
    if isinstance(part, Dots):
        points = (part.points - center).T.astype(np.float32)
        color = np.array(to_rgb(part.color), dtype=np.float32)[:, None]
        size = part.size / np.tan(np.radians(FIELD_OF_VIEW_DEG) / 2)  # the viewer's sizes are those at 90 degrees
        scene.set_object(g.PointCloud(points, np.tile(color, points.shape[1]), size=size))
    elif isinstance(part, Lines):
        geometry = Joined((part.ends - center).reshape(-1, 2, 3))
        scene.set_object(g.LineSegments(geometry, g.LineBasicMaterial(color=as_number(part.color))))
    else:
        scene.set_object(geometry_of(part, center), material_of(part))


def geometry_of(surface: Surface, center: np.ndarray) -> Joined:
    colors = None if isinstance(surface.color, str) else np.repeat(surface.colors, 3, axis=0)
    return Joined(surface.triangles - center, colors)


def material_of(surface: Surface) -> g.GenericMaterial:
    """Seen from both sides, unless it is closed; glass hides nothing behind it."""
    kind = g.MeshLambertMaterial if surface.lit else g.MeshBasicMaterial
    glass = {**THROUGH, "opacity": surface.opacity} if surface.opacity < 1 else {}
    side = 0 if surface.closed else 2
    if isinstance(surface.color, str):
        return kind(color=as_number(to_hex(surface.color)), side=side, **glass)
    return kind(vertexColors=True, side=side, **glass)


def as_number(color: str) -> int:
    """#rrggbb as meshcat has it."""
    return int(color.lstrip("#"), 16)


def motion_of(drawing: Drawing, camera: Camera, start_paused: bool, start_at: float, size: float) -> dict[str, Any]:
    """All that moves, signs and cameras, for the page's player."""
    box = drawing.near(drawing.box)
    movers = [
        {
            "time": plain_values(mover.time, 3),
            "points": plain_values(drawing.near(mover.points), 3),
            "turn": plain_values(mover.turn, 3),
            "color": mover.color,
        }
        for mover in drawing.movers
    ]
    markers = [
        {"kind": kind, "place": plain_values(drawing.near(place), 2), "color": color, "since": round(since, 3)}
        for kind, place, color, since in drawing.markers
    ]
    uav = max((float(np.ptp(mover.body.triangles[..., 0])) for mover in drawing.movers), default=0.0)
    return {
        "movers": movers, "markers": markers, "since": drawing.since, "duration": round(drawing.duration, 3),
        "unit": drawing.unit, "paused": start_paused, "at": start_at, "camera": camera, "cameras": drawing.cameras,
        "corners": plain_values(drawing.outline(), 2), "margin": MARGIN, "closest": CLOSEST,
        "chase": CHASE, "size": round(size, 3),
        "near": sorted(drawing.near_only), "far": sorted(drawing.far_only), "closeup": round(drawing.closeup, 3),
        "rings": len(drawing.movers) <= MOST_NAMED, "uav": round(uav, 3),
        "reach": round(float(np.linalg.norm(box[1] - box[0])), 3),
        "wind": plain_values(drawing.wind, 2) if drawing.wind.any() else None,
    }  # fmt: skip


class Extra(NamedTuple):
    """What a page has beyond a scene that plays."""

    panel: str = ""
    """HTML above the legend."""
    style: str = ""
    """CSS."""
    scripts: Mapping[str, bytes] = MappingProxyType({})
    """Run before anything else, by name."""
    data: Mapping[str, bytes] = MappingProxyType({})
    begin: str = ""
    """A statement that is run when the scene is there."""


PLAIN = Extra()


def page_of(drawing: Drawing, motion: dict[str, Any], still: bytes, words: str, extra: Extra = PLAIN) -> str:
    """The whole page."""
    player, window = files("uavlab.scene").joinpath("player"), record(drawing)
    return player.joinpath("page.html").read_text("utf-8").format(
        title=html.escape(drawing.title[:1].upper() + drawing.title[1:]),
        style=player.joinpath("page.css").read_text("utf-8") + extra.style,
        words=html.escape(words),
        still=base64.b64encode(still).decode(),
        legend=legend(drawing),
        viewer=viewer_script(),
        player=compressed(player.joinpath("player.js").read_bytes()),
        commands=compressed(compact(list(window.commands.values()))),
        arrays=compressed(bytes(window.arrays)),
        motion=compressed(compact(motion)),
        panel=extra.panel,
        scripts=", ".join(f'"{name}"' for name in extra.scripts),
        more="".join(f', {name}: "{compressed(content)}"' for name, content in {**extra.scripts, **extra.data}.items()),
        begin=extra.begin,
    )  # fmt: skip


def compact(value: Any) -> bytes:
    return json.dumps(value, separators=(",", ":")).encode()


@lru_cache(1)
def viewer_script() -> str:
    return compressed(files("meshcat").joinpath("viewer/dist/main.min.js").read_bytes())


def compressed(content: bytes) -> str:
    return base64.b64encode(gzip.compress(content, 9, mtime=0)).decode()
