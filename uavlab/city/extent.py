"""Where a map begins, how far it reaches, and how many voxels that makes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.city.buildings import Building
from uavlab.city.terrain import Terrain, ground_and_top

MOST_VOXELS = 500_000_000
"""More than this is refused: half a gigabyte for the occupancy alone."""


def checked_cell(cell: float) -> float:
    if not (np.isfinite(cell) and cell > 0):
        raise ValueError(f"cell must be the edge of a voxel in metres, above 0, got {cell!r}")
    return float(cell)


def checked_origin(origin: npt.ArrayLike) -> np.ndarray:
    corner = checks.frozen(checks.numbers("origin", origin))
    if corner.shape != (3,) or not np.isfinite(corner).all():
        raise ValueError(f"origin must be three finite numbers (x, y, z) in metres, got {origin!r}")
    return corner


def locked(array: np.ndarray) -> np.ndarray:
    """The array, from now on not to be written to."""
    array.setflags(write=False)
    return array


def checked_points(points: npt.ArrayLike) -> np.ndarray:
    array = checks.numbers("points", points)
    if array.shape[-1:] != (3,) or not np.isfinite(array).all():
        raise ValueError(f"points must be finite and have shape (..., 3), got shape {array.shape}")
    return array


def check_heights(min_height: float, max_height: float) -> None:
    """Refuse heights above ground that leave nothing in between."""
    checks.not_negative_number("min_height", min_height)
    checks.number("max_height", max_height)
    if not max_height > min_height:
        raise ValueError(f"max_height must be above min_height ({min_height:g} m), got {max_height!r}")


def extent_and_ground(
    buildings: Sequence[Building],
    cell: float,
    origin: npt.ArrayLike | None,
    size: npt.ArrayLike | None,
    margin: float,
    terrain: Terrain | float | None,
) -> tuple[np.ndarray, tuple[int, int, int], np.ndarray | None, np.ndarray | None]:
    """Lowest corner [m] and shape of a map, and its ground at the columns' centres and highest, (nx, ny) each [m]."""
    corner, shape = extent_of(buildings, cell, origin, size, margin, terrain)
    ground = top = None
    if isinstance(terrain, Terrain):
        ground, top = ground_and_top(terrain, corner, cell, shape)
        if origin is None or size is None:  # the extent in height follows the ground of this map alone
            least, most = float(ground.min()), float(top.max())
            low = least if origin is None else corner[2]
            high = max(corner[2] + cell * shape[2], most + margin) if size is None else corner[2] + cell * shape[2]
            corner[2] = np.floor(least / cell - 1e-9) * cell - cell if origin is None else low
            shape = (*shape[:2], int(np.ceil((high - corner[2]) / cell - 1e-9)))
    elif terrain is not None:
        checks.finite("terrain", level := checks.number("terrain", terrain))
        ground = np.full(shape[:2], level)
    check_size(shape, cell)
    return corner, shape, ground, top


def extent_of(
    buildings: Sequence[Building],
    cell: float,
    origin: npt.ArrayLike | None,
    size: npt.ArrayLike | None,
    margin: float,
    terrain: Terrain | float | None,
) -> tuple[np.ndarray, tuple[int, int, int]]:
    """Lowest corner [m] and shape of a map, see `City.from_buildings`."""
    if size is None or origin is None:
        if not buildings:
            raise ValueError(
                "buildings is empty, so the extent of the map is unknown: give origin and size, "
                "for example origin=(0, 0, 0), size=(100, 100, 100)"
            )
        low = np.min([building.bounds[0] for building in buildings], axis=0)
        low[2] = min(low[2], 0.0)  # where all buildings float, the ground is below them
        high = np.max([building.bounds[1] for building in buildings], axis=0)
        if isinstance(terrain, int | float):
            low[2], high[2] = min(low[2], terrain), max(high[2], terrain)
            low[2] = np.floor(low[2] / cell + 1e-9) * cell - cell  # one layer of voxels is solid
        around = np.array([margin, margin, 0.0])
        origin = low - around if origin is None else checked_origin(origin)
        size = high + np.array([margin, margin, margin]) - origin if size is None else size
    corner, extent = np.array(checked_origin(origin)), np.asarray(size, dtype=float)
    if extent.shape != (3,) or not (np.isfinite(extent) & (extent > 0)).all():
        raise ValueError(f"size must be three positive extents (x, y, z) in metres, got {size!r}")
    nx, ny, nz = np.ceil(extent / cell - 1e-9)
    check_size((nx, ny, nz), cell)
    return corner, (int(nx), int(ny), int(nz))


def check_size(shape: Sequence[float], cell: float) -> None:
    """Refuse a map of too many voxels; the cell that would do is rounded up, so that it does."""
    if np.prod(shape, dtype=float) > MOST_VOXELS:
        extent = cell * np.array(shape)
        edge = cell * (np.prod(shape, dtype=float) / MOST_VOXELS) ** (1 / 3)
        step = 10.0 ** (np.floor(np.log10(edge)) - 2)
        edge = step * np.ceil(edge / step)
        while np.prod(np.ceil(extent / edge)) > MOST_VOXELS:  # whole voxels are a little more
            edge += step
        raise ValueError(
            f"cell={cell:g} m gives {shape[0]:.0f} × {shape[1]:.0f} × {shape[2]:.0f} voxels over "
            f"{extent[0]:.0f} × {extent[1]:.0f} × {extent[2]:.0f} m, more than {MOST_VOXELS:,}: "
            f"use a cell of at least {edge:.3g} m or a smaller size"
        )
