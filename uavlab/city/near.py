"""Which voxels are nearer to an obstacle than a distance: the truth of `City.clearance < m`, and nothing more of it.

The voxels of a column are the bits of words, so that one operation moves 64 of them. Around an obstacle the voxels that
are too near fill a ball; in each column of the ball they reach a known number of voxels up and down. All obstacles are
moved up and down so far, and sideways over the ball's columns, and what they cover is near. Distances are squares of
whole half cells, so the answer is that of the clearance to the last bit, in a fiftieth of its time and memory.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from uavlab.city.extent import locked
from uavlab.city.kept import kept_for_city
from uavlab.city.voxels import least_kept
from uavlab.compiled import compiled

if TYPE_CHECKING:
    from uavlab.city.model import City

WIDEST = 40
"""From a distance of so many cells on the clearance of all voxels takes less time."""

WORD = 64
"""Bits."""


def reaches_of(min_clearance: float, cell: float, most: int) -> np.ndarray:
    """How many voxels up and down are too near in the columns of the ball around an obstacle, (R + 1, R + 1).

    By how far a column is along x and y; −1 where none is. A ball wider than `most` cells is cut off there.
    """
    least = least_kept(min_clearance, cell)
    squared = 4.0 * (least / cell) ** 2  # [half cells]; the next but one is a whole number that is surely less
    limit = max(math.floor(min(squared, 16.0 * (most + 1.0) ** 2)) - 2, 0)
    while math.sqrt(0.25 * limit) * cell < least and limit <= 16 * (most + 1) ** 2:  # as the clearance is computed
        limit += 1
    apart = np.maximum(2 * np.arange(most + 1) - 1, 0) ** 2  # of a centre from a voxel so many cells away
    apart = apart[apart < limit]
    left = limit - apart[:, None] - apart
    return np.where(left > 0, np.searchsorted(apart, left.ravel()).reshape(left.shape) - 1, -1)


def bits_of(occupied: np.ndarray) -> np.ndarray:
    """Voxels (nx, ny, nz) as bits, (nx, ny, words) uint64: bit k % 64 of word k // 64 of a column."""
    nx, ny, nz = occupied.shape
    packed = np.zeros((nx, ny, -(-nz // WORD) * WORD // 8), np.uint8)
    packed[..., : -(-nz // 8)] = np.packbits(occupied, axis=-1, bitorder="little")
    return packed.view("<u8").astype(np.uint64, copy=False)


def voxels_of(bits: np.ndarray, height: int) -> np.ndarray:
    """The inverse of `bits_of`, for columns of this many voxels."""
    packed = bits.astype("<u8", copy=False).view(np.uint8)
    return np.unpackbits(packed, axis=-1, count=height, bitorder="little").view(bool)


@kept_for_city(1)
def near_obstacles(city: City, min_clearance: float) -> np.ndarray:
    """Whether the clearance of each voxel (nx, ny, nz) is below `min_clearance` [m], to rounding, see `least_kept`."""
    return locked(near_voxels(city.occupied, reaches_of(min_clearance, city.cell, max(city.shape))))


def near_voxels(occupied: np.ndarray, reaches: np.ndarray) -> np.ndarray:
    """Which voxels (nx, ny, nz) are too near to occupied ones of them, by `reaches_of` the distance."""
    bits = bits_of(occupied)
    near = np.zeros_like(bits)
    widen_balls(bits, reaches, near)
    return voxels_of(near, occupied.shape[2])


@compiled
def widen_balls(bits, reaches, near):
    """Set the bits (nx, ny, words) of all voxels in balls around those that are set, columns as `reaches_of` has them.

    One plane of columns after the other: moved up and down by all that is needed, then over the ball's columns.
    """
    nx, ny, words = bits.shape
    radius = len(reaches) - 1
    moved = np.zeros((reaches[0, 0] + 1, ny * words), np.uint64)
    row = np.empty(ny * words, np.uint64)
    for i in range(nx):
        if not bits[i].any():
            continue
        moved[0] = bits[i].ravel()
        for reach in range(1, len(moved)):
            move_up_and_down(moved[reach - 1], words, moved[reach])
        for di in range(min(radius, max(i, nx - 1 - i)) + 1):
            row[:] = 0
            for dj in range(min(radius, ny - 1) + 1):
                reach = reaches[di, dj]
                if reach < 0:
                    break
                cover(row[dj * words :], moved[reach])
                cover(row, moved[reach, dj * words :])
            for target in (i - di, i + di):
                if 0 <= target < nx:
                    cover(near[target].reshape(-1), row)


@compiled
def cover(bits, others):
    """Set all bits that others have, as far as both reach."""
    for n in range(min(len(bits), len(others))):
        bits[n] |= others[n]


@compiled
def move_up_and_down(bits, words, moved):
    """Bits of columns, so many words each, with those one up and one down; what leaves a column is gone."""
    one, last = np.uint64(1), np.uint64(WORD - 1)
    for n in range(len(bits)):
        moved[n] = bits[n] | bits[n] << one | bits[n] >> one
        if n % words > 0:
            moved[n] |= bits[n - 1] >> last
        if n % words < words - 1:
            moved[n] |= bits[n + 1] << last
