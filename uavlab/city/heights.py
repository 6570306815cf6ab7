"""Where the heights of a footprint stand among its properties, and what they mean: metres, or storeys."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from uavlab.city.footprints import Footprint
from uavlab.city.lengths import length_in_metres
from uavlab.city.source import Notes


class Wording(NamedTuple):
    """Where heights stand, and in what units."""

    height: str | float
    base: str | float
    default_height: float | None
    storey_height: float
    unit: float


def heights_of(footprint: Footprint, wording: Wording, notes: Notes) -> tuple[float, float]:
    """Base and top of a footprint [m]; the top NaN where the file doesn't say."""
    properties, unit, storey = footprint.properties, wording.unit, wording.storey_height
    base = stated(wording.base, properties, wording)
    if np.isnan(base):
        storeys = first_of(properties, ("building:min_level", "min_floor"))
        base = 0.0 if np.isnan(storeys) else storeys * storey
    top = stated(wording.height, properties, wording)
    if np.isnan(top):
        if isinstance(wording.height, str) and properties.get(wording.height) not in (None, ""):
            notes.add("derived", f"a {wording.height} that can't be understood counts as unknown", footprint.label)
        storeys = first_of(properties, ("building:levels", "num_floors"))
        if storeys > 0:
            roof = length_in_metres(properties.get("roof:height"), unit)
            roof = roof if roof >= 0 else max(0.0, np.nan_to_num(first_of(properties, ("roof:levels",)))) * storey
            top = storeys * storey + roof
            notes.add("derived", f"height from storeys of {storey:g} m", footprint.label)
    if top <= 0:
        notes.add("derived", "a height of 0 counts as unknown", footprint.label)
        top = np.nan
    if top <= base:
        notes.add("mended", "underside not below the roof: taken from the ground", footprint.label)
        base = 0.0
    return base, top


def stated(what: str | float, properties: Mapping[str, Any], wording: Wording) -> float:
    """A height [m] given for all, or by a property; NaN where that says nothing that can be understood."""
    if not isinstance(what, str):
        return float(what)
    if what.endswith("levels"):
        return length_in_metres(properties.get(what)) * wording.storey_height
    return length_in_metres(properties.get(what), wording.unit)


def first_of(properties: Mapping[str, Any], names: Sequence[str]) -> float:
    """The first of several numbers that is there; else NaN."""
    for name in names:
        number = length_in_metres(properties.get(name))
        if not np.isnan(number):
            return number
    return np.nan
