"""Pictures that share one palette: many frames of one figure in few bytes.

The colours of lines by name and the most frequent others of all frames are kept exactly, so that two lines on a map
stay two; the rest, of smooth edges and colour maps, is brought together by Pillow's median cut. Equal colours get equal
numbers in all frames, so that what two frames have in common can be left out of the second.
"""

from __future__ import annotations

import io
from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from PIL import Image

from uavlab.plot.colors import CRASH_COLOR, LINES

COLORS = 127
"""Of a palette. With 255 charts are 15 % larger, and nobody sees it."""
EXACT = 32
"""Of those, kept as they are: those of lines first, which are rare on maps."""
LINE_CODES = [int(color[1:], 16) for color in (*LINES, CRASH_COLOR)]
TRANSPARENT = 255
"""Number of a pixel that isn't drawn."""
STRIP = 500_000
"""Pixels that stand for all frames when their palette is chosen."""


def codes_of(picture: bytes) -> np.ndarray:
    """Colours of a PNG on white paper, (height, width), each as one number 0xRRGGBB."""
    drawn = Image.open(io.BytesIO(picture)).convert("RGBA")
    paper = Image.new("RGBA", drawn.size, "white")
    paper.alpha_composite(drawn)
    red, green, blue, _ = np.moveaxis(np.asarray(paper, dtype=np.uint32), -1, 0)
    return red << 16 | green << 8 | blue


def colors_of(codes: np.ndarray) -> np.ndarray:
    """Red, green and blue (N, 3) of codes (N,)."""
    return np.stack([codes >> 16, codes >> 8 & 255, codes & 255], axis=-1).astype(np.uint8)


def indexed(pictures: Sequence[bytes]) -> tuple[np.ndarray, np.ndarray]:
    """One palette (C, 3) for PNGs of one size, and each of their pixels as a number in it, (frames, height, width)."""
    found, counts = zip(*(np.unique(codes_of(picture), return_counts=True) for picture in pictures), strict=True)
    codes, places = np.unique(np.concatenate(found), return_inverse=True)
    palette = chosen_palette(codes, np.bincount(places, np.concatenate(counts)))
    numbers = nearest(colors_of(codes), palette)
    return palette, np.stack([numbers[np.searchsorted(codes, codes_of(picture))] for picture in pictures])


def chosen_palette(codes: np.ndarray, counts: np.ndarray) -> np.ndarray:
    """At most `COLORS` colours (C, 3) that stand for those that are there so often."""
    if len(codes) <= COLORS:
        return colors_of(codes)
    order = np.lexsort((-counts, ~np.isin(codes, LINE_CODES)))
    weights = np.sqrt(counts[order[EXACT:]])  # by their counts alone, large areas would take all of the palette
    repeats = np.ceil(weights * min(1.0, STRIP / weights.sum())).astype(int)
    strip = np.repeat(colors_of(codes[order[EXACT:]]), repeats, axis=0)
    quantized = Image.fromarray(strip[None]).quantize(COLORS - EXACT, Image.Quantize.MEDIANCUT, kmeans=3)
    rest = np.array(quantized.getpalette(), dtype=np.uint8).reshape(-1, 3)
    return np.concatenate([colors_of(codes[order[:EXACT]]), rest[: COLORS - EXACT]])


def nearest(colors: np.ndarray, palette: np.ndarray) -> np.ndarray:
    """Number of the nearest colour of a palette (C, 3) for each of some colours (N, 3), (N,)."""
    chosen = np.empty(len(colors), dtype=np.uint8)
    for first in range(0, len(colors), 4096):
        apart = colors[first : first + 4096, None].astype(int) - palette[None]
        chosen[first : first + 4096] = (apart**2).sum(axis=-1).argmin(axis=-1)
    return chosen


def png(numbers: np.ndarray, palette: np.ndarray) -> bytes:
    """A picture (height, width) as a PNG with no more of the palette in it than it needs."""
    used, places = np.unique(numbers, return_inverse=True)
    image = Image.fromarray(places.reshape(numbers.shape).astype(np.uint8))
    image.putpalette(np.where(used[:, None] == TRANSPARENT, 0, palette[used % len(palette)]).astype(np.uint8).tobytes())
    clear = {"transparency": len(used) - 1} if used[-1] == TRANSPARENT else {}
    written = io.BytesIO()
    image.save(written, "png", optimize=True, **clear)
    return written.getvalue()


def commonest(frames: np.ndarray) -> np.ndarray:
    """What each pixel is in most frames (frames, height, width), (height, width): so little of each has to be drawn."""
    ordered = np.sort(frames, axis=0)
    run = np.ones(ordered.shape[1:], dtype=int)
    longest, value = run.copy(), ordered[0].copy()
    for before, now in pairwise(ordered):
        run = np.where(now == before, run + 1, 1)
        longer = run > longest
        longest[longer], value[longer] = run[longer], now[longer]
    return value


def difference(frame: np.ndarray, base: np.ndarray) -> tuple[int, int, np.ndarray]:
    """What has to be drawn over `base` to make it `frame`: left and upper end [pixels], and the piece."""
    changed = frame != base
    if not changed.any():
        return 0, 0, np.full((1, 1), TRANSPARENT, dtype=np.uint8)
    rows, columns = (np.flatnonzero(changed.any(axis=axis)) for axis in (1, 0))
    window = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
    return int(columns[0]), int(rows[0]), np.where(changed, frame, TRANSPARENT)[window].astype(np.uint8)
