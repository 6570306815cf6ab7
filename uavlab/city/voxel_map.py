"""Voxel maps of the 3-D pathfinding benchmarks, `.3dmap`: occupied voxels and nothing else."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from uavlab import checks
from uavlab.city.extent import MOST_VOXELS, checked_cell
from uavlab.city.model import City


def read_voxels(path: str | Path, *, cell: float = 1.0) -> City:
    """Read a voxel map of the 3-D pathfinding benchmarks (Brewer and Sturtevant 2018, `.3dmap`).

    The first line is `voxel W H D`, the number of voxels along x, y and z. Each line after it is a blocked voxel,
    `x y z`, counted from 0. The map begins at (0, 0, 0) and knows no buildings.

    Parameters
    ----------
    path : str or Path
        UTF-8 text.
    cell : float
        Edge of a voxel [m], above 0.

    Returns
    -------
    City

    Raises
    ------
    ValueError
        If the header of the file at `path` or a line is not as described, where the message names the line; the map has
        over 500 million voxels; or `cell` is not above 0.
    FileNotFoundError
        If there is no file at `path`.

    See Also
    --------
    read_city : finds out the format.
    City : a city from an array of voxels.

    References
    ----------
    D. Brewer and N. R. Sturtevant, "Benchmarks for pathfinding in 3D voxel space", Symposium on Combinatorial Search,
    2018.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> from uavlab.city import read_voxels
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder, "maze.3dmap")
    ...     _ = path.write_text("voxel 4 3 2\\n0 0 0\\n3 2 1")
    ...     city = read_voxels(path, cell=2.0)
    >>> city, city.is_free([(1, 1, 1), (3, 1, 1)]).tolist()
    (<City maze: 4 × 3 × 2 voxels of 2 m, 0 buildings>, [False, True])
    """
    path, cell = checks.path("path", path), checked_cell(cell)
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
