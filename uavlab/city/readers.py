"""Reading a city from a file: the format is found by looking.

In a city that was read x points to true east, y to true north, both in metres; x = y = 0 is near the south-west corner
of the buildings and z = 0 the lowest ground at one. The map begins `margin` metres before them, a layer lower.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from inspect import signature
from pathlib import Path
from typing import Any

from uavlab import checks
from uavlab.city.cityjson import read_cityjson
from uavlab.city.documents import advice_on, read_json
from uavlab.city.geojson import read_geojson
from uavlab.city.model import City
from uavlab.city.voxel_map import read_voxels

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

    Returns
    -------
    City

    Raises
    ------
    ValueError
        If the file at `path` is of none of these formats or broken, or one of `options` is none of its reader or out of
        its range.
    FileNotFoundError
        If there is no file at `path`.

    Warns
    -----
    UserWarning
        If the reader assumed or left out anything.

    See Also
    --------
    read_geojson : footprints with heights.
    read_cityjson : models with roofs.
    read_voxels : voxel maps.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> from uavlab.city import read_city
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder, "maze.3dmap")
    ...     _ = path.write_text("voxel 4 3 2")
    ...     read_city(path, cell=2.0)
    <City maze: 4 × 3 × 2 voxels of 2 m, 0 buildings>
    """
    path = checks.path("path", path)
    with path.open("rb") as file:
        start = file.read(FIRST_BYTES).removeprefix(b"\xef\xbb\xbf").lstrip(b" \t\r\n\x1e")
    if path.suffix.lower() == ".3dmap" or start.startswith(b"voxel"):
        return read_voxels(path, **fitting(read_voxels, options, "a voxel map"))
    if start.startswith(b"{") or path.suffix.lower() in {".json", ".jsonl", ".geojson"}:
        kind = KIND.search(start)  # not by parsing, which takes long for a large file
        head = {} if kind else read_json(path)[0]
        found = kind[1].decode() if kind else head.get("type")
        if found == "CityJSON":
            return read_cityjson(path, **fitting(read_cityjson, options, "CityJSON"))
        if found in GEOJSON:
            return read_geojson(path, **fitting(read_geojson, options, "GeoJSON"))
        if isinstance(head.get("elements"), list):
            raise ValueError(
                f"{path.name} is Overpass' own JSON, which isn't GeoJSON: in Overpass turbo choose Export, GeoJSON, or "
                "convert it with osmtogeojson"
            )
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
