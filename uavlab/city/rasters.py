"""Heights of the ground from files: ESRI ASCII grids and GeoTIFF."""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from uavlab import checks
from uavlab.city.place import LOCAL, System, metres_per, system_of
from uavlab.city.terrain import Terrain, check_pixels, checked_terrain, filled_masks, pixels_and_edge


def read_terrain(path: str | Path, *, crs: Any = None) -> Terrain:
    """Read a raster of heights: an ESRI ASCII grid (.asc), or a GeoTIFF (needs rasterio: uavlab[raster]).

    Parameters
    ----------
    path : str or Path
        Which of the two it is, is found by looking.
    crs : anything that `uavlab.city.place.system_of` takes, optional
        Its reference system; a GeoTIFF names its own, an .asc in a .prj file of its name. "local", or an .asc without
        any: metres of the city.

    Returns
    -------
    Terrain
        In the reference system, if there is one.

    Raises
    ------
    ValueError
        If the file at `path` is broken, has over 25 million pixels, or a height that is none on Earth and not declared
        as no data; or `crs` isn't known, can't be its own, or is missing for a GeoTIFF that names none.
    ImportError
        If a GeoTIFF is to be read without rasterio.
    FileNotFoundError
        If there is no file at `path`.

    See Also
    --------
    Terrain.from_raster : from an array.
    read_geojson : puts buildings on it, with `terrain=path`.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> from uavlab.city import read_terrain
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder, "hill.asc")
    ...     _ = path.write_text("ncols 2\\nnrows 2\\nxllcorner 0\\nyllcorner 0\\ncellsize 10\\n2 4\\n0 -9999")
    ...     hill = read_terrain(path)
    >>> hill.heights_at([(5, 5), (15, 5)]), hill.filled().heights_at([(5, 5), (15, 5)])
    (array([ 0., nan]), array([0., 4.]))
    """
    path = checks.path("path", path)
    with path.open("rb") as file:
        start = file.read(4)
    return read_geotiff(path, crs) if start[:2] in (b"II", b"MM") else read_ascii_grid(path, crs)


HEADER = {"ncols", "nrows", "cellsize", "xllcorner", "yllcorner", "xllcenter", "yllcenter", "nodata_value", "dx", "dy"}


def terrain_or_file(terrain: Any) -> Terrain | Path | float | None:
    """What a reader of cities takes for its ground: a terrain, the name of its file, a level [m], or nothing."""
    return checks.path("terrain", terrain) if isinstance(terrain, str | Path) else checked_terrain(terrain)


def read_ascii_grid(path: Path, crs: Any) -> Terrain:
    """An ESRI ASCII grid of heights."""
    heights, bounds = ascii_grid(path)
    return Terrain.from_raster(heights, bounds, crs=system_beside(path) if crs is None else crs)


def ascii_grid(path: Path) -> tuple[np.ndarray, tuple[float, float, float, float]]:
    """Values and bounds of an ESRI ASCII grid: lines "name value", then rows from north to south; NaN for no data."""
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except UnicodeDecodeError:
        raise ValueError(f"{path.name} is neither a GeoTIFF nor an ASCII grid (.asc)") from None
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
        raise ValueError(f"{path.name} has no line {absent[0]!r} in its header: is it an ASCII grid (.asc)?")
    dx, dy = (header.get(name, header.get("cellsize", 0.0)) for name in ("dx", "dy"))
    rows, columns = (whole_number(name, header[name], path) for name in ("nrows", "ncols"))
    if not (0 < dx < np.inf and 0 < dy < np.inf):
        raise ValueError(f"{path.name}: cellsize (or dx, dy) must be finite and above 0, got {min(dx, dy):g}")
    if not np.isfinite([header[name] for name in corner]).all():
        raise ValueError(f"{path.name}: {corner[0]} and {corner[1]} must be finite")
    check_pixels(path.name, rows, columns)
    try:
        values = np.array(" ".join(lines[len(header) :]).split(), dtype=float)
    except ValueError:
        for number, line in enumerate(lines[len(header) :], len(header) + 1):
            for word in line.split():
                number_in(word, path, number)
        raise
    if len(values) != rows * columns:
        raise ValueError(f"{path.name} must have {rows} × {columns} values, as its header says, got {len(values)}")
    grid = values.reshape(rows, columns)
    grid[np.isclose(grid, header.get("nodata_value", -9999.0), rtol=1e-6, atol=0.0)] = np.nan  # it may be rounded
    west = header[corner[0]] - (dx / 2 if corner[0] == "xllcenter" else 0.0)
    south = header[corner[1]] - (dy / 2 if corner[1] == "yllcenter" else 0.0)
    return grid, (west, south, west + columns * dx, south + rows * dy)


def system_beside(path: Path) -> System | None:
    """The reference system in the .prj file of a grid, if there is one."""
    for beside in (path.with_suffix(".prj"), path.with_suffix(".PRJ")):
        if beside.exists():
            return system_of(beside.read_text(errors="replace"), beside.name)
    return None


def whole_number(name: str, value: float, path: Path) -> int:
    """A count in a header."""
    if not (1 <= value < np.inf and value == int(value)):
        raise ValueError(f"{path.name}: {name} must be a whole number of at least 1, got {value:g}")
    return int(value)


def number_in(word: str, path: Path, line: int) -> float:
    """A number, or an error that names the line."""
    try:
        return float(word)
    except ValueError:
        raise ValueError(f"{path.name}, line {line}: expected a number, got {word[:30]!r}") from None


@contextmanager
def one_band(path: Path, what: str) -> Iterator[Any]:
    """A GeoTIFF with one band, open; without rasterio an `ImportError`, a `ValueError` if it can't be read."""
    try:
        import rasterio
    except ImportError:
        raise ImportError(f'{path.name} is a GeoTIFF, which needs rasterio: pip install "uavlab[raster]"') from None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", rasterio.errors.NotGeoreferencedWarning)  # refused below
            file = rasterio.open(path)
        with file:
            if file.count != 1:
                raise ValueError(f"{path.name} has {file.count} bands, expected one, of {what}")
            yield file
    except rasterio.errors.RasterioError as error:
        raise ValueError(f"{path.name} is no GeoTIFF that can be read: {error}") from None


def read_geotiff(path: Path, crs: Any) -> Terrain:
    """A GeoTIFF with one band of heights, in their own unit and scale if they have one; a turned one is as good."""
    with one_band(path, "heights") as file:
        check_pixels(path.name, file.height, file.width)
        heights = filled_masks(f"heights of {path.name}", file.read(1, masked=True))
        heights = heights * file.scales[0] + file.offsets[0]
        transform, declared, unit = file.transform, file.crs, file.units[0]
    if transform.is_identity or transform.is_degenerate:
        raise ValueError(f"{path.name} doesn't say where it lies: use Terrain.from_raster(heights, bounds)")
    if crs is None and declared is None:
        raise ValueError(
            f"{path.name} names no reference system: give crs='EPSG:...', or crs='local' for the city's metres"
        )
    system = None if isinstance(crs, str) and crs == LOCAL else system_of(declared.to_wkt() if crs is None else crs)
    if unit:  # otherwise that of the system
        factor = 1.0 if system is None else system.height_factor
        heights = heights * (metres_per(unit, f"unit of heights in {path.name}") / factor)
    column = pixels_and_edge(0, heights.shape[1], heights.shape[1])
    row = pixels_and_edge(0, heights.shape[0], heights.shape[0])
    at = np.stack([*np.meshgrid(column, row), np.ones((len(row), len(column)))], axis=-1)
    plan = at @ np.array(transform).reshape(3, 3)[:2].T
    return Terrain.from_grid(np.concatenate([plan, np.pad(heights, 1, mode="edge")[..., None]], axis=-1), system)
