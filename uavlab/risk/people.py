"""People from a file: the rasters of residents that the world has, such as GHS-POP and WorldPop, for `RiskMap`.

Such files cover a country or more, so only the part around the city is read.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from uavlab import checks
from uavlab.city import City
from uavlab.city.place import LOCAL, System, system_for, system_of
from uavlab.city.rasters import ascii_grid, one_band, system_beside
from uavlab.city.source import Notes, Source
from uavlab.city.terrain import COVERED
from uavlab.risk.layers import PER, border_of, pixels_of, raster_layer

BESIDE = 2
"""Pixels that are read on each side of the city."""

Part = tuple[np.ndarray, tuple[float, float, float, float], System | None]
"""Values, bounds, and the reference system of the bounds."""


class People(NamedTuple):
    """People on the ground, for `RiskMap`; see `read_people`."""

    density: np.ndarray
    """(nx, ny) ρ [1/m²]."""
    source: Source
    """What was taken and assumed."""

    def __repr__(self) -> str:
        nx, ny = self.density.shape
        return f"<People from {self.source.name}: density of {nx} × {ny} columns>"


def read_people(
    city: City, path: str | Path, *, per: str = "pixel", crs: Any = None, elsewhere: float | None = None
) -> People:
    """People on the ground from a raster: a GeoTIFF (needs rasterio: uavlab[raster]), or an ESRI ASCII grid (.asc).

    Their sum stays what it was, see `raster_layer`. A number below 0 stands for no data.

    Parameters
    ----------
    city : City
        On whose columns they are brought.
    path : str or Path
        Which of the two it is, is found by looking. A GeoTIFF may be larger than the memory.
    per : {"pixel", "km²", "m²"}
        What the numbers count: people in each pixel, as in GHS-POP and WorldPop, or per area.
    crs : anything that pyproj takes, or "local", optional
        Its reference system; a GeoTIFF names its own, an .asc in a .prj file of its name, else degrees where they can
        be. "local": metres of the city.
    elsewhere : float, optional
        Density ρ [1/m²], at least 0, where the file says nothing; without it that is an error.

    Returns
    -------
    People
        `density` for `RiskMap(city, people.density, …)`; `source` says how many people are on the map.

    Raises
    ------
    ValueError
        If the file at `path` is broken, turned, or doesn't reach the city; `per` is none of its words; `crs` isn't
        known, can't be its own, or is missing for a GeoTIFF that names none; `elsewhere` is negative or not finite, or
        isn't given, and the file has no data for a part of the city; or `city` has no `reference`, or is no `City`.
    ImportError
        If a GeoTIFF is to be read without rasterio.
    FileNotFoundError
        If there is no file at `path`.

    See Also
    --------
    raster_layer : the same from an array.
    osm_layers : roads and shelter from a file.

    Examples
    --------
    A pixel of 3″ with 50 people.

    >>> import pathlib, tempfile
    >>> from uavlab.city import City, Place
    >>> from uavlab.risk import read_people
    >>> city = City.from_buildings([], origin=(0, 0, 0), size=(40, 30, 30), reference=Place(13.377, 52.516), cell=5.0)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder, "people.asc")
    ...     _ = path.write_text("ncols 1\\nnrows 1\\nxllcorner 13.3769\\nyllcorner 52.5159\\ncellsize 0.000833333\\n50")
    ...     people = read_people(city, path)
    >>> people, round(1e6 * float(people.density.mean()))  # per km²
    (<People from people.asc: density of 8 × 6 columns>, 9531)
    """
    checks.instance("city", city, City)
    checks.one_of("per", per, [name for name in PER if name])
    if elsewhere is not None:
        elsewhere = checks.not_negative_number("elsewhere", elsewhere)
    path, notes = checks.path("path", path), Notes()
    with path.open("rb") as file:
        tiff = file.read(2) in (b"II", b"MM")
    try:
        values, bounds, system = (geotiff_around if tiff else grid_around)(city, path, crs)
        below = int(np.count_nonzero(values < 0))
        if below:
            notes.add("derived", "pixel below 0 counts as no data", count=below)
            values = np.where(values < 0, np.nan, values)
        density = raster_layer(city, values, bounds, crs=system, per=per, fill=0.0)
        known = np.where(np.isfinite(values), 1.0, np.nan)
        covered = raster_layer(city, known, bounds, crs=system, fill=0.0)
    except ValueError as error:
        raise ValueError(str(error) if path.name in str(error) else f"{path.name}: {error}") from None
    missing = int(np.count_nonzero(covered < COVERED))
    if missing and elsewhere is None:
        raise ValueError(
            f"{path.name} says nothing about {missing} of the city's {covered.size} columns, or parts of them; say "
            "with elsewhere how many people per m² to take there"
        )
    if missing and elsewhere is not None:
        density = density + elsewhere * np.where(covered < COVERED, 1.0 - covered, 0.0)
        said = f"{1e6 * elsewhere:,.0f} people per km², where the file has no data"
        notes.add("assumed", f"column of {covered.size:,}, or part of one, with {said}", count=missing)
    corners = pixels_of(city, (1, 1), np.array(bounds), system)[0] * city.cell
    across, along = np.ptp(corners, axis=0) / values.shape[::-1]
    notes.add("taken", f"{density.sum() * city.cell**2:,.0f} people on the map, from pixels of about "
                       f"{across:.0f} × {along:.0f} m", count=0)  # fmt: skip
    where = "metres of the city" if system is None else system.name
    notes.add("derived", f"place from {where}", count=0)
    return People(density, notes.source(path.name, "GeoTIFF" if tiff else "ASCII grid"))


def grid_around(city: City, path: Path, crs: Any) -> Part:
    """An ASCII grid, whole."""
    values, bounds = ascii_grid(path)
    return values, bounds, system_for(bounds, system_beside(path), crs, path.name)


def geotiff_around(city: City, path: Path, crs: Any) -> Part:
    """The part of a GeoTIFF with one band that lies around a city."""
    with one_band(path, "people") as file:
        grid = file.transform
        if grid.is_identity or grid.is_degenerate or grid.b or grid.d or grid.a < 0 or grid.e > 0:
            raise ValueError(f"{path.name} doesn't say where it lies, or is turned: use raster_layer, or gdalwarp")
        if crs is None and file.crs is None:
            raise ValueError(f"{path.name} names no reference system: give crs='EPSG:...', or crs='local'")
        local = isinstance(crs, str) and crs == LOCAL
        system = None if local else system_of(file.crs.to_wkt() if crs is None else crs)
        border = border_of(city, system)
        pixels = np.nan_to_num((border[:, ::-1] - (grid.f, grid.c)) / (grid.e, grid.a), nan=-1e9)
        ends = np.stack([np.floor(pixels.min(axis=0)) - BESIDE, np.ceil(pixels.max(axis=0)) + BESIDE])
        (top, left), (bottom, right) = np.clip(ends, 0, file.shape).astype(int).tolist()
        if top >= bottom or left >= right:
            raise ValueError(f"{path.name} doesn't reach the city: is it the tile of that place?")
        read = file.read(1, window=((top, bottom), (left, right)), masked=True)
        values = np.where(np.ma.getmaskarray(read), np.nan, np.ma.getdata(read).astype(float))
        values = values * file.scales[0] + file.offsets[0]
        bounds = grid.c + left * grid.a, grid.f + bottom * grid.e, grid.c + right * grid.a, grid.f + top * grid.e
    return values, bounds, system
