"""What the properties of a feature say about heights: metres or storeys, above the ground or above the sea.

Reading comes first and decides nothing; then one rule each for heights above ground and above the sea makes an
underside and a roof of what was read. In doubt both take the lower underside and the higher roof: the safe side.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from uavlab.city.lengths import length_in_metres, number_of

STOREYS = ("building:levels", "num_floors")
"""Properties that count storeys: of OpenStreetMap and of Overture."""

STOREYS_BELOW = ("building:min_level", "min_floor")
"""Properties that count the storeys that a building has not, below its underside."""

COUNTING = re.compile(r"(?!.*height).*(levels$|floors|storeys|stories|etages|floor_?(count|number))", re.IGNORECASE)
"""In the names of properties that count storeys, such as `storeysAboveGround` or `FLOOR_COUNT`."""

ROOFS = ("roof:height", "roof_height")
"""Properties that hold the height of a roof above the storeys: of OpenStreetMap and of Overture."""


class Wording(NamedTuple):
    """Where heights stand, and in what units."""

    height: str | float
    base: str | float
    storey_height: float
    """[m]"""
    unit: float = 1.0
    """Metres per unit, where a height has none."""


class Heights(NamedTuple):
    """What a feature says [m]; NaN where it says nothing that can be understood."""

    base: float
    """Of the underside, as stated."""
    lift: float
    """Of the underside above ground, from storeys."""
    top: float
    """Of the roof, as stated."""
    rise: float
    """Of the roof above ground, from storeys or one for all buildings."""
    in_storeys: bool
    unclear: bool
    """Whether a height stands there that can't be understood."""

    @property
    def own(self) -> bool:
        """Whether the feature itself has a height, not only one that holds for all."""
        return self.top > 0 or self.in_storeys


class Extent(NamedTuple):
    """Underside and roof [m], NaN where they aren't known, with what was done to find them."""

    base: float
    top: float
    done: tuple[tuple[str, str], ...]
    """Kind and words of notes, see `uavlab.city.source.Notes`."""


def heights_of(properties: Mapping[str, Any], wording: Wording) -> Heights:
    """What a feature says about its heights."""
    storeys = (wording.height, *STOREYS) if counts_storeys(wording.height) else STOREYS
    top, rise = math.nan, from_storeys(properties, storeys, wording)
    in_storeys, unclear = rise > 0, False
    if not isinstance(wording.height, str):
        rise, in_storeys = float(wording.height), False
    elif not counts_storeys(wording.height):
        stated = properties.get(wording.height)
        top = length_in_metres(stated, wording.unit, max, signed=True)
        unclear = math.isnan(top) and stated not in (None, "")
    lift = first_number(properties, STOREYS_BELOW, min) * wording.storey_height
    if not isinstance(wording.base, str):
        base = float(wording.base)
    elif counts_storeys(wording.base):
        base, lift = math.nan, number_of(properties.get(wording.base), min) * wording.storey_height
    else:
        base = length_in_metres(properties.get(wording.base), wording.unit, min, signed=True)
    return Heights(base, lift, top, rise, in_storeys, unclear)


def counts_storeys(name: str | float) -> bool:
    """Whether a property counts storeys, by its name."""
    return isinstance(name, str) and (COUNTING.match(name) is not None or name in STOREYS_BELOW)


def from_storeys(properties: Mapping[str, Any], names: Sequence[Any], wording: Wording) -> float:
    """Height [m] of the storeys and the roof above them; NaN where no storeys are counted."""
    storeys = first_number(properties, names, max)
    if not storeys > 0:
        return math.nan
    roof = first_of(length_in_metres(properties.get(name), wording.unit) for name in ROOFS)
    if math.isnan(roof):
        levels = number_of(properties.get("roof:levels"))
        roof = 0.0 if math.isnan(levels) else levels * wording.storey_height
    return storeys * wording.storey_height + roof


def first_number(properties: Mapping[str, Any], names: Sequence[Any], of_several: Any) -> float:
    """The first of several numbers of storeys that is there; else NaN."""
    return first_of(number_of(properties.get(name), of_several) for name in names)


def first_of(numbers: Iterable[float]) -> float:
    """The first that is not NaN; else NaN."""
    return next((number for number in numbers if not math.isnan(number)), math.nan)


def above_ground(heights: Heights, wording: Wording) -> Extent:
    """Underside and roof above the ground; the underside is the ground unless it is stated above it."""
    done = notes_on(heights, wording, heights.top)
    base = heights.base if heights.base >= 0 else heights.lift if heights.lift >= 0 else 0.0
    top = heights.top if heights.top > 0 else heights.rise
    if top == heights.rise and heights.in_storeys and not heights.top > 0:
        done.append(("derived", f"height from storeys of {wording.storey_height:g} m"))
    if top <= base:
        done.append(("mended", "underside not below the roof: taken from the ground"))
        base = 0.0
    return Extent(base, top, tuple(done))


def above_sea(heights: Heights, wording: Wording, ground: float, from_base: bool) -> Extent:
    """Underside and roof above the sea.

    Parameters
    ----------
    ground : float
        Lowest ground under the building [m], its underside where none is stated.
    from_base : bool
        Whether the roofs of this file are counted from the undersides, and only these from the sea.
    """
    done = notes_on(heights, wording, math.inf)
    base = heights.base
    if math.isnan(base):
        base = ground
        done.append(("derived", "underside from the ground nearby"))
    if math.isnan(heights.top):
        if heights.in_storeys:
            done.append(("derived", f"height from storeys of {wording.storey_height:g} m"))
        return Extent(base, base + heights.rise, tuple(done))
    if heights.top > base and not from_base:
        return Extent(base, heights.top, tuple(done))
    if heights.top <= 0:  # neither above the underside nor above the sea
        done += notes_on(heights, wording, heights.top)
        return Extent(base, base + heights.rise, tuple(done))
    if not from_base:
        done.append(("mended", "roof not above its underside: counted from there"))
    return Extent(base, base + heights.top, tuple(done))


def notes_on(heights: Heights, wording: Wording, top: float) -> list[tuple[str, str]]:
    """Notes about a height that stands there and is none."""
    if heights.unclear:
        return [("derived", f"a {wording.height} that can't be understood counts as unknown")]
    return [("derived", "a height of 0 or less counts as unknown")] if top <= 0 else []
