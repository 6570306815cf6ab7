"""Voxels by their indices and by their numbers: the position in `occupied.ravel()`, or as RISK-ACO counts them.

Two of them are start and goal of an experiment, drawn evenly.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from uavlab import checks

EXACT = 2.0**53
"""Up to here floats hold every whole number."""

MOST_PAIRS = 100_000
"""Of starts and goals."""

TRIES = 1000
"""For each pair, before none is expected."""


def whole_numbers(name: str, value: npt.ArrayLike) -> np.ndarray:
    """The argument as whole numbers of 64 bits: those of 8 can't count the voxels of a map."""
    if isinstance(value, np.ndarray) and value.dtype.kind in "iu" and not np.ma.is_masked(value):
        return np.asarray(value, dtype=np.int64)
    values = checks.numbers(name, value)
    if np.asarray(value).dtype == bool:
        raise ValueError(f"{name} must be whole numbers, got True or False: numpy.argwhere says where they are true")
    checks.refuse(values, (np.abs(values) <= EXACT) & (values == np.round(values)), f"{name} must be whole numbers")
    return values.astype(np.int64)


def checked_index(index: npt.ArrayLike) -> np.ndarray:
    """Indices (..., 3) of voxels, on the map or not."""
    index = whole_numbers("index", index)
    if index.shape[-1:] != (3,):
        raise ValueError(f"index must have shape (..., 3), got {index.shape}")
    return index


def codes_of(index: np.ndarray, shape: tuple[int, int, int], as_printed: bool) -> np.ndarray:
    """Node codes of voxels (..., 3) of a map."""
    beyond = (index < 0) | (index >= shape)
    if beyond.any():
        wrong = index[beyond.any(axis=-1)].reshape(-1, 3)[0]
        raise ValueError(f"index {tuple(wrong.tolist())} lies outside of the map of {shape} voxels")
    if as_printed:
        nx, ny, nz = shape
        return np.asarray(1 + index[..., 0] + nx * ((ny - 1 - index[..., 1]) + ny * (nz - 1 - index[..., 2])))
    return np.ravel_multi_index(tuple(np.moveaxis(index, -1, 0)), shape)


def indices_of(code: np.ndarray, shape: tuple[int, int, int], as_printed: bool) -> np.ndarray:
    """The voxels (..., 3) of a map that have these node codes."""
    nx, ny, nz = shape
    first, count = int(as_printed), nx * ny * nz
    beyond = (code < first) | (code >= count + first)
    if beyond.any():
        raise ValueError(f"code must be from {first} to {count - 1 + first}, got {code[beyond].flat[0]}")
    if as_printed:
        k, j, i = np.unravel_index(code - first, (nz, ny, nx))
        return np.stack([i, ny - 1 - j, nz - 1 - k], axis=-1)
    return np.stack(np.unravel_index(code, shape), axis=-1)


def pairs_apart(
    allowed: np.ndarray, shape: tuple[int, int, int], cell: float, origin: np.ndarray, count: int,
    rng: np.random.Generator, apart: float,
) -> list[np.ndarray]:  # fmt: skip
    """Centres (2, 3) [m] of two allowed voxels (N,) that are at least `apart` [m]; fewer pairs where hardly any are."""
    pairs: list[np.ndarray] = []
    farthest = cell * float(np.linalg.norm(shape))
    for _ in range(TRIES * count if len(allowed) and apart <= farthest else 0):
        ends = origin + cell * (indices_of(allowed[rng.integers(len(allowed), size=2)], shape, False) + 0.5)
        if np.linalg.norm(ends[1] - ends[0]) >= apart:
            pairs.append(ends)
        if len(pairs) == count:
            break
    return pairs
