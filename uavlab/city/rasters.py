"""Heights of the ground from files: ESRI ASCII grids and GeoTIFF."""

import re
from pathlib import Path
from typing import Any

import numpy as np

from uavlab.city.place import LOCAL, system_of
from uavlab.city.terrain import Terrain, filled_masks, pixels_and_edge


def read_terrain(path: str | Path, *, crs: Any = None) -> Terrain:
    """Read a raster of heights: an ESRI ASCII grid (.asc), or a GeoTIFF (needs rasterio: uavlab[raster]).

    Parameters
    ----------
    path : str or Path
    crs : anything that `uavlab.city.place.system_of` takes, optional
        Its reference system; a GeoTIFF names its own. "local", or an .asc without crs: metres of the city.

    Raises
    ------
    ValueError
        If the file is broken, or a height is no height on Earth and not declared as no data.
    ImportError
        If a GeoTIFF is to be read without rasterio.
    """
    path = Path(path)
    with path.open("rb") as file:
        start = file.read(4)
    return read_geotiff(path, crs) if start[:2] in (b"II", b"MM") else read_ascii_grid(path, crs)


HEADER = {"ncols", "nrows", "cellsize", "xllcorner", "yllcorner", "xllcenter", "yllcenter", "nodata_value", "dx", "dy"}


def read_ascii_grid(path: Path, crs: Any) -> Terrain:
    """An ESRI ASCII grid: lines "name value", then rows of heights from north to south."""
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except UnicodeDecodeError:
        raise ValueError(f"{path.name} is neither a GeoTIFF nor an ASCII grid of heights (.asc)") from None
    header: dict[str, float] = {}
    for number, line in enumerate(lines, 1):
        words = line.split()
        if not words or not re.match(r"[A-Za-z]", words[0]) or words[0].lower() == "nan":
            break
        if words[0].lower() not in HEADER or len(words) != 2:
            raise ValueError(f"{path.name}, line {number}: expected a line such as 'ncols 100', got {line[:60]!r}")
        header[words[0].lower()] = number_in(words[1], path, number)
    needed = {"ncols", "nrows"} | (set() if {"dx", "dy"} <= header.keys() else {"cellsize"})
    corner = ["xllcenter" if "xllcenter" in header else "xllcorner"]
    corner += ["yllcenter" if "yllcenter" in header else "yllcorner"]
    absent = [name for name in (*sorted(needed), *corner) if name not in header]
    if absent:
        raise ValueError(f"{path.name} has no line {absent[0]!r} in its header: is it an ASCII grid of heights (.asc)?")
    rows, columns = int(header["nrows"]), int(header["ncols"])
    try:
        values = np.array(" ".join(lines[len(header) :]).split(), dtype=float)
    except ValueError:
        for number, line in enumerate(lines[len(header) :], len(header) + 1):
            for word in line.split():
                number_in(word, path, number)
        raise
    if rows < 1 or columns < 1 or len(values) != rows * columns:
        raise ValueError(f"{path.name} must have {rows} × {columns} heights, as its header says, got {len(values)}")
    heights = values.reshape(rows, columns)
    heights[heights == header.get("nodata_value", -9999.0)] = np.nan
    dx, dy = header.get("dx", header.get("cellsize", 0.0)), header.get("dy", header.get("cellsize", 0.0))
    west = header[corner[0]] - (dx / 2 if corner[0] == "xllcenter" else 0.0)
    south = header[corner[1]] - (dy / 2 if corner[1] == "yllcenter" else 0.0)
    return Terrain.from_raster(heights, (west, south, west + columns * dx, south + rows * dy), crs=crs)


def number_in(word: str, path: Path, line: int) -> float:
    """A number, or an error that names the line."""
    try:
        return float(word)
    except ValueError:
        raise ValueError(f"{path.name}, line {line}: expected a number, got {word[:30]!r}") from None


def read_geotiff(path: Path, crs: Any) -> Terrain:
    """A GeoTIFF with one band of heights; a turned one is as good."""
    try:
        import rasterio
    except ImportError:
        raise ImportError(f'{path.name} is a GeoTIFF, which needs rasterio: pip install "uavlab[raster]"') from None
    try:
        with rasterio.open(path) as file:
            if file.count != 1:
                raise ValueError(f"{path.name} has {file.count} bands, expected one, of heights")
            heights = filled_masks("heights", file.read(1, masked=True).astype(float))
            transform, declared = file.transform, file.crs
    except rasterio.errors.RasterioError as error:
        raise ValueError(f"{path.name} is no GeoTIFF that can be read: {error}") from None
    if crs is None and declared is None:
        raise ValueError(
            f"{path.name} names no reference system: give crs='EPSG:...', or crs='local' for the city's metres"
        )
    system = None if isinstance(crs, str) and crs == LOCAL else system_of(crs or declared.to_wkt())
    column = pixels_and_edge(0, heights.shape[1], heights.shape[1])
    row = pixels_and_edge(0, heights.shape[0], heights.shape[0])
    at = np.stack([*np.meshgrid(column, row), np.ones((len(row), len(column)))], axis=-1)
    plan = at @ np.array(transform).reshape(3, 3)[:2].T
    return Terrain.from_grid(np.concatenate([plan, np.pad(heights, 1, mode="edge")[..., None]], axis=-1), system)
