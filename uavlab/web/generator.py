"""NumPy's default generator for compiled code that has no NumPy around it: the same numbers from the same state.

PCG64 (O'Neill 2014), and normal numbers by the ziggurat of Marsaglia and Tsang (2000) with the tables that numba has of
NumPy's. Where compiled code asks a `numpy.random.Generator` for normal numbers, a `Stream` does as well.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import types
from numba.extending import overload_method
from numba.np.random._constants import fi_double, ki_double, wi_double, ziggurat_nor_inv_r, ziggurat_nor_r

from uavlab.compiled import compiled

LAYERS, WIDTHS, HEIGHTS = ki_double, wi_double, fi_double
"""Of the ziggurat (256,): up to which whole number a draw lies within, metres per unit, and heights of the density."""

MULTIPLIER_HIGH, MULTIPLIER_LOW = np.uint64(2549297995355413924), np.uint64(4865540595714422341)
WORD, HALF = np.uint64(0xFFFFFFFF), np.uint64(32)
ONE, EIGHT, ELEVEN, SIXTY_FOUR = np.uint64(1), np.uint64(8), np.uint64(11), np.uint64(64)
MANTISSA, BYTE, ROTATION = np.uint64(0x000FFFFFFFFFFFFF), np.uint64(0xFF), np.uint64(58)
STEP = 1.0 / 9007199254740992.0
"""Between two doubles that are drawn, 2⁻⁵³."""


class Stream(NamedTuple):
    """A generator's state."""

    state: np.ndarray  # (4,) uint64: the number of 128 bits and its increment, high words first

    def standard_normal(self) -> float:
        return normal_from(self.state)


@overload_method(types.NamedUniTuple, "standard_normal")
def standard_normal_of(stream):
    """Compiled code calls the method of a stream as that of a generator."""
    if stream.instance_class is Stream:
        return lambda stream: normal_from(stream.state)
    return None


@compiled
def normal_from(state):
    """One standard normal number."""
    while True:
        word = next_word(state)
        layer = np.int64(word & BYTE)
        word >>= EIGHT
        whole = (word >> ONE) & MANTISSA
        x = np.float64(whole) * WIDTHS[layer]
        if word & ONE:
            x = -x
        if whole < LAYERS[layer]:
            return x
        if layer == 0:
            while True:
                beyond = -ziggurat_nor_inv_r * np.log1p(-next_double(state))
                room = -np.log1p(-next_double(state))
                if room + room > beyond * beyond:
                    return -(ziggurat_nor_r + beyond) if (whole >> EIGHT) & ONE else ziggurat_nor_r + beyond
        if (HEIGHTS[layer - 1] - HEIGHTS[layer]) * next_double(state) + HEIGHTS[layer] < np.exp(-0.5 * x * x):
            return x


@compiled
def next_double(state):
    """One number from 0 to 1, without 1."""
    return (next_word(state) >> ELEVEN) * STEP


@compiled
def next_word(state):
    """64 bits; the state goes on, state·multiplier + increment in 128 bits."""
    high, low = multiplied(state[1], MULTIPLIER_LOW)
    high += state[0] * MULTIPLIER_LOW + state[1] * MULTIPLIER_HIGH + state[2]
    low += state[3]
    if low < state[3]:
        high += ONE
    state[0], state[1] = high, low
    mixed, turn = high ^ low, high >> ROTATION
    return (mixed >> turn) | (mixed << ((SIXTY_FOUR - turn) & (SIXTY_FOUR - ONE)))


@compiled
def multiplied(one, other):
    """Product of two numbers of 64 bits: its high and its low word."""
    one_low, one_high, other_low, other_high = one & WORD, one >> HALF, other & WORD, other >> HALF
    carried = (one_low * other_low) >> HALF
    middle = one_high * other_low + carried
    other_middle = one_low * other_high + (middle & WORD)
    return one_high * other_high + (middle >> HALF) + (other_middle >> HALF), one * other
