"""Heights as people write them: "13.5", "12,5 m", "40 ft", "40'6\\"", "10+", "4;5", "3-4"."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable
from typing import Any

FOOT, INCH = 0.3048, 0.0254

NUMBER = r"\d+(?:[.,]\d+)?|[.,]\d+"
PLAIN = re.compile(rf"[~≈]?\s*([+-]?)\s*({NUMBER})\s*(m|metres?|meters?|ft|feet|foot)?\.?\s*\+?", re.IGNORECASE)
FEET_AND_INCHES = re.compile(
    r"(\d+(?:\.\d+)?)\s*(?:['′]|ft\.?)\s*(?:(\d+(?:\.\d+)?)\s*(?:\"|″|''|in\.?))?", re.IGNORECASE
)
RANGE = re.compile(rf"({NUMBER})\s*[-–]\s*({NUMBER})([^-–]*)")
"""From one length to another, in the same unit."""
THOUSANDS = re.compile(r"\d{1,3},\d{3}")
"""May be a thousand and more, or a decimal comma: nobody can tell."""


def length_in_metres(
    value: Any, unit: float = 1.0, of_several: Callable[[Iterable[float]], float] = max, signed: bool = False
) -> float:
    """A length as a number or as text, in metres; NaN if it isn't understood or not finite.

    Parameters
    ----------
    value : number or str
    unit : float
        Metres per unit, where the text names none.
    of_several : max or min
        Which of several lengths counts, as in "4;5" or "4-5": the largest of roofs, the smallest of undersides.
    signed : bool
        Whether a length below 0 is one, as heights above the sea may be; else NaN.
    """
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        return math.nan
    try:
        lengths = (
            [one_length(part.strip(), unit) for part in RANGE.sub(r"\1\3;\2\3", value).split(";")]
            if isinstance(value, str)
            else [float(value) * unit]
        )
    except OverflowError:  # whole numbers of hundreds of digits
        return math.nan
    if not all(math.isfinite(length) and (signed or length >= 0) for length in lengths):
        return math.nan
    return of_several(lengths)


def one_length(text: str, unit: float) -> float:
    plain = PLAIN.fullmatch(text)
    if plain:
        sign, number, name = plain.groups()
        if THOUSANDS.fullmatch(number):
            return math.nan
        factor = unit if name is None else 1.0 if name.lower().startswith("m") else FOOT
        return float(sign + number.replace(",", ".")) * factor
    imperial = FEET_AND_INCHES.fullmatch(text)
    if imperial:
        return float(imperial[1]) * FOOT + float(imperial[2] or 0.0) * INCH
    return math.nan


def number_of(value: Any, of_several: Callable[[Iterable[float]], float] = max) -> float:
    """A number of storeys as a number or as text; NaN if it isn't understood, below 0, or a length."""
    if isinstance(value, str) and any(letter.isalpha() or letter in "'\"′″" for letter in value):
        return math.nan
    return length_in_metres(value, 1.0, of_several)
