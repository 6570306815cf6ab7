"""Reading a city from a file: the format is found by looking, voxel maps are read here.

In a city that was read x points to true east, y to true north, both in metres; x = y = 0 is near the south-west corner
of the buildings and z = 0 the lowest ground at one. The map begins `margin` metres before them, a layer lower.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from inspect import signature
from pathlib import Path
from typing import Any

import numpy as np

from uavlab.city.cityjson import read_cityjson
from uavlab.city.documents import advice_on, read_json
from uavlab.city.geojson import read_geojson
from uavlab.city.model import MOST_VOXELS, City

FIRST_BYTES = 65_536
GEOJSON = ("FeatureCollection", "Feature", "GeometryCollection", "Polygon", "MultiPolygon")
KIND = re.compile(rb'"type"\s*:\s*"(CityJSON|FeatureCollection)"')


def read_city(path: str | Path, **options: Any) -> City:
    """Read a city from a file of any known format, chosen by what the file contains.

    Parameters
    ----------
    path : str or Path
        GeoJSON, CityJSON (also as a sequence, one feature per line), or a voxel map (.3dmap).
    **options
        Passed on to `read_geojson`, `read_cityjson` or `read_voxels`, for example `cell=2.0`.

    Raises
    ------
    ValueError
        If the format is none of these, or the file is broken.
    FileNotFoundError
        If there is no such file.
    """
    path = Path(path)
    with path.open("rb") as file:
        start = file.read(FIRST_BYTES).removeprefix(b"\xef\xbb\xbf").lstrip(b" \t\r\n\x1e")
    if path.suffix.lower() == ".3dmap" or start.startswith(b"voxel"):
        return read_voxels(path, **fitting(read_voxels, options, "a voxel map"))
    if start.startswith(b"{") or path.suffix.lower() in {".json", ".jsonl", ".geojson"}:
        kind = KIND.search(start)  # not by parsing, which takes long for a large file
        found = kind[1].decode() if kind else read_json(path)[0].get("type")
        if found == "CityJSON":
            return read_cityjson(path, **fitting(read_cityjson, options, "CityJSON"))
        if found in GEOJSON:
            return read_geojson(path, **fitting(read_geojson, options, "GeoJSON"))
    raise ValueError(
        f"{path.name} is not a city that can be read. Known are GeoJSON (.geojson, .json: footprints with heights), "
        f"CityJSON (.city.json, .json, .jsonl: models with roofs) and voxel maps (.3dmap){advice_on(path)}"
    )


def fitting(reader: Callable[..., City], options: dict[str, Any], kind: str) -> dict[str, Any]:
    """The options, if the reader takes them."""
    known = [name for name in signature(reader).parameters if name != "path"]
    for name in options:
        if name not in known:
            raise ValueError(f"{name} is no option for {kind}, which takes {', '.join(known)}")
    return options


def read_voxels(path: str | Path, *, cell: float = 1.0) -> City:
    """Read a voxel map of the 3-D pathfinding benchmarks (Brewer and Sturtevant 2018, `.3dmap`).

    The first line is `voxel W H D`, the number of voxels along x, y and z. Each line after it is a blocked voxel,
    `x y z`, counted from 0. The map begins at (0, 0, 0) and knows no buildings.

    Parameters
    ----------
    path : str or Path
    cell : float
        Edge of a voxel [m].

    Raises
    ------
    ValueError
        If the header or a line is not as described; the message names the line.
    """
    path = Path(path)
    with path.open(encoding="utf-8-sig", errors="replace") as file:
        header = file.readline().strip()
        empty = not any(line.strip() for line in file)
    match = re.fullmatch(r"voxel\s+(\d+)\s+(\d+)\s+(\d+)", header)
    if match is None:
        raise ValueError(f"{path.name}, line 1: expected 'voxel W H D' with three whole numbers, got {header[:60]!r}")
    shape = tuple(int(digits) for digits in match.groups())
    if not 0 < np.prod(shape, dtype=float) <= MOST_VOXELS:
        raise ValueError(f"{path.name}, line 1: a map must have from 1 to {MOST_VOXELS:,} voxels, got {header!r}")
    occupied = np.zeros(shape, dtype=bool)
    if not empty:
        try:
            blocked = np.loadtxt(path, dtype=np.int64, comments=None, skiprows=1, ndmin=2, encoding="utf-8-sig")
            occupied[tuple(blocked.T)] = True
            wrong = blocked.shape[1] != 3 or blocked.min() < 0
        except (IndexError, ValueError):
            wrong = True
        if wrong:
            raise ValueError(f"{path.name}, {first_wrong_line(path, shape)}")
    return City(occupied, cell, name=path.name.split(".")[0])


def first_wrong_line(path: Path, shape: Sequence[int]) -> str:
    """Words for the first line of a voxel map that is not a voxel within its shape."""
    ranges = ", ".join(f"{axis} 0 to {extent - 1}" for axis, extent in zip("xyz", shape, strict=True))
    lines = path.read_text(encoding="utf-8-sig", errors="replace").split("\n")
    for number, line in enumerate(lines[1:], 2):
        voxel = re.fullmatch(r"\s*([+-]?\d+)\s+([+-]?\d+)\s+([+-]?\d+)\s*", line)
        if voxel is None and line.strip():
            return f"line {number}: expected three whole numbers 'x y z', got {line.strip()[:60]!r}"
        if voxel and not all(0 <= int(v) < extent for v, extent in zip(voxel.groups(), shape, strict=True)):
            return f"line {number}: voxel {line.strip()!r} lies outside of the map: {ranges}"
    return "expected three whole numbers 'x y z' on every line after the first"
