"""Where a map begins, how far it reaches, and how many voxels that makes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.city.buildings import Building
from uavlab.city.rasterise import RULES
from uavlab.city.terrain import Terrain, ground_and_top

MOST_VOXELS = 500_000_000
"""More than this is refused: half a gigabyte for the occupancy alone."""

MOST_LAZY = 100_000_000_000
"""Of a lazy map: a list of where its voxels are known would no longer fit."""


def checked_cell(cell: float) -> float:
    edge = checks.number("cell", cell)
    if not (np.isfinite(edge) and edge > 0):
        raise ValueError(f"cell must be the edge of a voxel in metres, above 0, got {cell!r}")
    return edge


def checked_grid(cell: float, margin: float, voxels: str) -> tuple[float, float]:
    """Edge of a voxel and free space around buildings [m] as floats; `voxels` must be a rule."""
    checks.one_of("voxels", voxels, RULES)
    return checked_cell(cell), checks.not_negative_number("margin", margin)


def checked_origin(origin: npt.ArrayLike) -> np.ndarray:
    corner = checks.frozen(checks.numbers("origin", origin))
    if corner.shape != (3,) or not np.isfinite(corner).all():
        raise ValueError(f"origin must be three finite numbers (x, y, z) in metres, got {origin!r}")
    return corner


def locked(array: np.ndarray) -> np.ndarray:
    """The array, from now on not to be written to."""
    array.setflags(write=False)
    return array


def checked_occupied(occupied: npt.ArrayLike) -> np.ndarray:
    """Voxels (nx, ny, nz), True where something is, not to be written to; 0 and 1 will do."""
    if np.ma.is_masked(occupied):
        raise ValueError("occupied has masked voxels: say of each whether it is occupied")
    if not (isinstance(occupied, np.ndarray) and occupied.dtype == bool):
        values = checks.numbers("occupied", occupied)
        checks.refuse(values, (values == 0) | (values == 1), "occupied must be True or False in each voxel")
        occupied = values
    voxels = checks.frozen(occupied, bool)
    if voxels.ndim != 3 or voxels.size == 0:
        raise ValueError(f"occupied must be an array (nx, ny, nz) with at least one voxel, got {voxels.shape}")
    return voxels


def checked_ground(ground: npt.ArrayLike, columns: tuple[int, ...]) -> np.ndarray:
    """Heights of the ground (nx, ny) [m], not to be written to."""
    heights = checks.frozen(checks.numbers("ground", ground))
    if heights.shape != columns or not np.isfinite(heights).all():
        raise ValueError(
            f"ground must have one finite height for each column {columns}, got shape "
            f"{heights.shape} with {np.count_nonzero(~np.isfinite(heights))} that are NaN or infinite"
        )
    return heights


def checked_heights(min_height: float, max_height: float) -> tuple[float, float]:
    """Heights above ground as floats; those that leave nothing in between are refused."""
    lowest, highest = checks.not_negative_number("min_height", min_height), checks.number("max_height", max_height)
    if not highest > lowest:
        raise ValueError(f"max_height must be above min_height ({lowest:g} m), got {max_height!r}")
    return lowest, highest


def checked_bound(name: str, distance: npt.ArrayLike) -> np.ndarray:
    """A distance [m], or several, at least 0; infinite ones are taken."""
    bound = checks.numbers(name, distance)
    checks.refuse(bound, bound >= 0, f"{name} must be a distance in metres, at least 0")
    return bound


def check_segments(start: np.ndarray, end: np.ndarray, at_most: np.ndarray) -> tuple[int, ...]:
    """The shape (...) that starts and ends (..., 3) of straight lines and bounds (...) have together."""
    try:
        return np.broadcast_shapes(start.shape[:-1], end.shape[:-1], at_most.shape)
    except ValueError:
        raise ValueError(
            f"start, end and at_most must be as many, or one for all, got shapes {start.shape}, {end.shape} and "
            f"{at_most.shape}"
        ) from None


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
        ground = np.full(shape[:2], terrain)
    check_size(shape, cell)
    return corner, shape, ground, top


def lazy_extent(
    buildings: Sequence[Building],
    cell: float,
    origin: npt.ArrayLike | None,
    size: npt.ArrayLike | None,
    margin: float,
    terrain: Terrain | float | None,
    voxels: str,
) -> tuple[np.ndarray, tuple[int, int, int], float | None]:
    """Lowest corner [m] and shape of a lazy map, and the height of its ground [m]."""
    if isinstance(terrain, Terrain):
        raise ValueError("lazy=True needs level ground, terrain as one number [m]: take a larger cell without it")
    if voxels != "touched":
        raise ValueError(f"lazy=True knows only voxels='touched', got {voxels!r}")
    return *extent_of(buildings, cell, origin, size, margin, terrain, MOST_LAZY), terrain


def extent_of(
    buildings: Sequence[Building],
    cell: float,
    origin: npt.ArrayLike | None,
    size: npt.ArrayLike | None,
    margin: float,
    terrain: Terrain | float | None,
    most: int = MOST_VOXELS,
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
        if isinstance(terrain, float):
            low[2], high[2] = min(low[2], terrain), max(high[2], terrain)
            low[2] = np.floor(low[2] / cell + 1e-9) * cell - cell  # one layer of voxels is solid
        around = np.array([margin, margin, 0.0])
        origin = low - around if origin is None else checked_origin(origin)
        size = high + np.array([margin, margin, margin]) - origin if size is None else size
    corner, extent = np.array(checked_origin(origin)), checks.numbers("size", size)
    if extent.shape != (3,) or not (np.isfinite(extent) & (extent > 0)).all():
        raise ValueError(f"size must be three positive extents (x, y, z) in metres, got {size!r}")
    nx, ny, nz = np.ceil(extent / cell - 1e-9)
    check_size((nx, ny, nz), cell, most)
    return corner, (int(nx), int(ny), int(nz))


def check_size(shape: Sequence[float], cell: float, most: int = MOST_VOXELS) -> None:
    """Refuse a map of too many voxels; the cell that would do is rounded up, so that it does."""
    if np.prod(shape, dtype=float) > most:
        extent = cell * np.array(shape)
        edge = cell * (np.prod(shape, dtype=float) / most) ** (1 / 3)
        step = 10.0 ** (np.floor(np.log10(edge)) - 2)
        edge = step * np.ceil(edge / step)
        while np.prod(np.ceil(extent / edge)) > most:  # whole voxels are a little more
            edge += step
        raise ValueError(
            f"cell={cell:g} m gives {shape[0]:.0f} × {shape[1]:.0f} × {shape[2]:.0f} voxels over "
            f"{extent[0]:.0f} × {extent[1]:.0f} × {extent[2]:.0f} m, more than {most:,}: "
            f"use a cell of at least {edge:.3g} m or a smaller size{', or lazy=True' * (most == MOST_VOXELS)}"
        )
