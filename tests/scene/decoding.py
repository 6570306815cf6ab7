"""A page read again, as a browser does it: commands, arrays, motion."""

import base64
import gzip
import json
import re
from typing import NamedTuple

import numpy as np


class Mesh(NamedTuple):
    """What the viewer gets for one thing."""

    positions: np.ndarray
    """(V, 3) [m] from the centre."""
    index: np.ndarray
    """(N,) of corners; empty for points."""
    colors: np.ndarray | None
    """(V, 3), or None if there is one colour for all."""
    material: dict
    kind: str

    @property
    def shapes(self):
        """Triangles (T, 3, 3), or lines (L, 2, 3)."""
        return self.positions[self.index].reshape(-1, 2 if self.kind == "LineSegments" else 3, 3)


class Content(NamedTuple):
    """All that is in a page."""

    meshes: dict
    properties: dict
    motion: dict


def content_of(page):
    """Meshes by name, properties by path and name, and what moves."""
    packed = dict(re.findall(r'(\w+): "([^"]*)"', re.search(r"const packed = \{(.*?)\};", page)[1]))
    unpacked = {name: gzip.decompress(base64.b64decode(text)) for name, text in packed.items()}
    commands = json.loads(unpacked["commands"])
    properties = {(c["path"], c["property"]): c["value"] for c in commands if c["type"] == "set_property"}
    meshes = {
        c["path"].removeprefix("/meshcat/"): mesh_of(c["object"], unpacked["arrays"])
        for c in commands
        if c["type"] == "set_object"
    }
    return Content(meshes, properties, json.loads(unpacked["motion"]))


def mesh_of(command, content):
    """A mesh whose arrays stand elsewhere."""
    data = command["geometries"][0]["data"]
    numbers = {name: decoded(attribute["array"], content) for name, attribute in data["attributes"].items()}
    index = decoded(data["index"]["array"], content).ravel().astype(int) if data.get("index") else np.zeros(0, int)
    return Mesh(numbers["position"], index, numbers.get("color"), command["materials"][0], command["object"]["type"])


def decoded(place, content):
    """An array (rows, columns): sums of differences, 0, -1, 1, -2 … written as 0, 1, 2, 3 …, bytes apart."""
    count = place["rows"] * place["columns"]
    planes = np.frombuffer(content, dtype=np.uint8, count=4 * count, offset=place["at"]).reshape(4, count)
    folded = (planes.astype(np.int64) * np.array([1, 256, 256**2, 256**3])[:, None]).sum(axis=0)
    change = np.where(folded % 2 == 0, folded // 2, -(folded + 1) // 2)
    return np.cumsum(change.reshape(place["columns"], place["rows"]), axis=1).T / place["parts"]


def unpacked(page, name):
    """One of the things that a page keeps packed, as bytes."""
    return gzip.decompress(base64.b64decode(re.search(rf'[{{ ]{name}: "([^"]*)"', page)[1]))
