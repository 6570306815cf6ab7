"""What stands in a page: the commands for meshcat's viewer with their arrays, and what its player moves."""

import base64
import gzip
import json
import re

import numpy as np


def unpacked(page):
    """The parts of a page by name, as bytes."""
    found = dict(re.findall(r'(viewer|player|commands|arrays|motion): "([^"]+)"', page))
    return {name: gzip.decompress(base64.b64decode(text)) for name, text in found.items()}


def motion_of(page):
    """What the player moves and shows."""
    return json.loads(unpacked(page)["motion"])


def commands_of(page):
    """The commands by path and type, arrays as (N, columns)."""
    parts = unpacked(page)
    commands = {}
    for command in json.loads(parts["commands"]):
        for geometry in command.get("object", {}).get("geometries", []):
            data = geometry.get("data", {})
            for attribute in [*data.get("attributes", {}).values(), *([data["index"]] if "index" in data else [])]:
                attribute["array"] = numbers(parts["arrays"], **attribute["array"])
        commands[command["path"], command["type"]] = command
    return commands


def numbers(arrays, at, rows, columns, parts):
    """An array from the differences that a page keeps, byte by byte."""
    values, count = np.zeros((rows, columns)), rows * columns
    for column in range(columns):
        total = 0
        for row in range(rows):
            place = at + column * rows + row
            folded = sum(arrays[place + byte * count] << 8 * byte for byte in range(4))
            total += folded // 2 if folded % 2 == 0 else -(folded + 1) // 2
            values[row, column] = total / parts
    return values


def vertices_of(command):
    return command["object"]["geometries"][0]["data"]["attributes"]["position"]["array"]


def shapes_of(command):
    """Triangles (T, 3, 3) or lines (L, 2, 3) of a mesh."""
    data = command["object"]["geometries"][0]["data"]
    corners = 2 if command["object"]["object"]["type"] == "LineSegments" else 3
    return vertices_of(command)[data["index"]["array"].astype(int).reshape(-1, corners)]


def colors_of(command):
    """A colour for each triangle (T, 3)."""
    data = command["object"]["geometries"][0]["data"]
    return data["attributes"]["color"]["array"][data["index"]["array"].astype(int).reshape(-1, 3)[:, 0]]
