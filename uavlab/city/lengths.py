"""Heights as people write them: "12.5", "12,5 m", "40 ft", "40'6\\"", "10+", "4;5"."""

import math
import re
from typing import Any

FOOT, INCH = 0.3048, 0.0254

PLAIN = re.compile(r"[~≈]?\s*\+?(\d+(?:[.,]\d+)?|[.,]\d+)\s*(m|metres?|meters?|ft|feet|foot)?\.?\s*\+?", re.IGNORECASE)
FEET_AND_INCHES = re.compile(r"(\d+(?:\.\d+)?)\s*['′]\s*(?:(\d+(?:\.\d+)?)\s*(?:\"|″|''))?")


def length_in_metres(value: Any, unit: float = 1.0) -> float:
    """A length as a number or as text, in metres; NaN if it isn't understood, below 0 or not finite.

    Parameters
    ----------
    value : number or str
        Of several, as in "4;5", the largest counts.
    unit : float
        Metres per unit, where the text names none.
    """
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        return math.nan
    if not isinstance(value, str):
        try:
            number = float(value) * unit
        except OverflowError:
            return math.nan
        return number if 0 <= number < math.inf else math.nan
    lengths = [one_length(part.strip(), unit) for part in value.split(";")]
    return math.nan if any(map(math.isnan, lengths)) else max(lengths)


def one_length(text: str, unit: float) -> float:
    plain = PLAIN.fullmatch(text)
    if plain:
        number, name = plain.groups()
        factor = unit if name is None else 1.0 if name.lower().startswith("m") else FOOT
        return float(number.replace(",", ".")) * factor
    imperial = FEET_AND_INCHES.fullmatch(text)
    if imperial:
        return float(imperial[1]) * FOOT + float(imperial[2] or 0.0) * INCH
    return math.nan
