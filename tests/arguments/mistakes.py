"""Plausible mistakes, and rightful variants, by the kind of a parameter; and what is rightful though it looks wrong.

The kind follows from the parameter's annotation and from the rightful value in the table of calls.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas
import things

HUGE = 10**400
DATE = np.datetime64("2026-01-01")
RAGGED = [1.0, [2.0, 3.0]]

OURS = {
    "City": things.TOWN, "UAV": things.DRONE, "RiskMap": things.RISK, "Route": things.LINE, "Curve": things.CURVE,
    "Weather": things.MILD, "Wind": things.BREEZE, "Flight": things.FLIGHT,
}  # fmt: skip
"""Instances that are mistaken for each other."""

TAKEN_FOR = {
    "Way": ("Route", "Curve", "Flight"),
    "Drawn": ("Route", "Curve", "Flight"),
    "Disturbance": ("Wind", "Weather"),
    "Layers": (),
}
"""Names in annotations that stand for several types."""

FREE_TEXT = {"name", "title", "label", "unit", "reason", "planner", "advice", "what", "priced", "color", "colors"}
"""Texts that may say anything, or that somebody else checks."""

ROWS = {
    "samples", "lengths", "t", "knots", "log_median", "offsets", "predicted", "counts", "parameter", "code", "seeds",
    "width", "cars_per_km", "x",
}  # fmt: skip
"""One-dimensional arrays of any length; the others are vectors."""

SIGNED = {
    "bottom", "eaves", "top", "temperature_c", "longitude", "latitude", "mean", "mean_length", "margin", "x", "gust",
    "correlation", "mean_away", "pitch", "street_axis_deg", "azimuth_deg", "elevation_deg", "wind_angle", "cost", "low",
    "high", "terrain", "target", "base", "lower", "upper", "jobs", "time", "fill", "omega", "vmin", "most", "values",
    "height", "default_height", "clock", "wind_from_deg", "at",
}  # fmt: skip
"""Numbers that may be below 0, in some calls at least; see `NOT_NEGATIVE`."""

NOT_NEGATIVE = {
    "risk.lethal_area.height", "risk.fall_speed.height", "risk.ballistic_fall.height", "risk.person_rate.height",
    "scene.show.height", "plot.section.height", "plot.risk.height", "plot.field.height", "flight.Gps.correlation",
    "weather.Wind.correlation", "weather.Wind.from_weather.correlation", "city.City.from_buildings.margin",
    "city.read_geojson.margin", "city.read_cityjson.margin", "planners.flight_conditions.clock",
    "risk.shelter_layer.high", "weather.WeatherRecord.weather.at", "weather.WeatherRecord.row.at",
}  # fmt: skip

ARRAYS_NOT_NEGATIVE = {"price", "population_density", "shelter", "vehicle_share", "offsets", "counts", "lengths", "sigma",
                       "size", "ground_of_shelter"}  # fmt: skip

ABOVE_ZERO = {
    "cell", "mass", "thrust", "drag_area", "diameter", "cruise_speed", "top_speed", "max_tilt", "rotor_area",
    "figure_of_merit", "drive_efficiency", "step", "time_step", "duration_of_flight", "sigma_of_model",
    "natural_frequency", "speed_share", "tilt_share", "predicted", "hold", "interval", "every", "spacing", "spare",
    "air_density", "storey_height", "lane_width", "acceptance_radius", "wind_scale", "wind_shape", "averaging_time",
    "width", "air_speed", "altitude", "stiffness", "still_offset", "even_odds_energy", "least_fatal_energy", "least",
    "max_pitch", "max_turn", "evaporation", "max_length", "bank", "class_count", "count", "flights", "budget", "ants",
    "swarm", "waypoints", "arcs", "total", "trials", "per_segment", "dimensions", "max_steps", "until", "probes", "block",
    "jobs", "train_count", "lengths", "safety_factor", "gust_factor", "weight", "rate",
}  # fmt: skip

MAY_BE_INFINITE = {
    "max_height", "battery", "climb_speed", "sink_speed", "at_most", "upper", "curvature", "clearance", "cost",
    "max_length", "target", "exact_within", "omega",
}  # fmt: skip

MAY_BE_NAN = {"cost"}

RIGHTFUL = {}
"""By "callable.parameter": mistakes that are none, each with its reason."""


def annotation_words(note: str) -> set[str]:
    return set(re.findall(r"\w+", note))


def kind_of(key: str, name: str, note: str, value: Any) -> str:
    """What kind of thing a parameter takes."""
    words = annotation_words(note)
    if name == "rng":
        return "seed"
    if name == "crs":
        return "crs"
    if (
        ("Callable" in words and callable(value))
        or words & {"Function", "Planner"}
        or (callable(value) and not isinstance(value, type) and type(value).__name__ == "function")
    ):
        return "function"
    if isinstance(value, bool):
        return "flag"
    if isinstance(value, Path):
        return "path"
    if isinstance(value, pandas.DataFrame):
        return "table"
    if isinstance(value, str):
        return "words" if name in FREE_TEXT else "choice"
    if isinstance(value, int):
        return "count"
    if isinstance(value, float):
        return "numbers" if words & {"ArrayLike", "ndarray"} else "number"
    if isinstance(value, Mapping):
        return "mapping"
    if isinstance(value, np.ndarray) and value.dtype == bool:
        return "bools"
    if isinstance(value, np.ndarray) and value.dtype.kind in "iu" and name != "predicted":
        return "indices"
    if isinstance(value, np.ndarray):
        return "array"
    if type(value) in (list, tuple) and len(value):
        first = value[0]
        if isinstance(first, str):
            return "names"
        if isinstance(first, int | float) and not isinstance(first, bool) and "int" not in words:
            return "array"
        if isinstance(first, tuple | list | np.ndarray) and name not in ("lines", "holes", "pieces", "bounds"):
            return "array"
        return "sequence"
    return "thing"


def mistakes_for(key: str, name: str, note: str, optional: bool, value: Any) -> Iterator[tuple[str, Any]]:
    """Mistakes by their names."""
    kind = kind_of(key, name, note, value)
    words = annotation_words(note)
    makers = {
        "number": number_mistakes, "numbers": numbers_mistakes, "count": count_mistakes, "flag": flag_mistakes,
        "words": words_mistakes, "choice": choice_mistakes, "path": path_mistakes, "seed": seed_mistakes,
        "array": array_mistakes, "bools": bools_mistakes, "indices": indices_mistakes, "mapping": mapping_mistakes,
        "names": names_mistakes, "sequence": sequence_mistakes, "thing": thing_mistakes, "table": table_mistakes,
        "function": function_mistakes, "crs": crs_mistakes,
    }  # fmt: skip
    full = f"{key.split(':')[0]}.{name}"
    allowed = RIGHTFUL.get(full, {}) | RIGHTFUL.get(f"{key}.{name}", {}) | RIGHTFUL.get(f"*.{name}", {})
    if not optional:
        yield from [("None", None)] if "None" not in allowed else []
    for mistake, wrong in makers[kind](full, name, words, value):
        if mistake not in allowed:
            yield mistake, wrong


def may_be_negative(full, name):
    return name in SIGNED and full not in NOT_NEGATIVE


def no_numbers(value):
    """What is no number at all."""
    yield "the text '3'", "3"
    yield "a word", "much"
    yield "complex", complex(1, 2)
    yield "a date", DATE
    yield "pandas.NA", pandas.NA
    yield "masked", np.ma.masked
    yield "10**400", HUGE
    yield "ragged", RAGGED
    yield "a City", things.TOWN
    yield "a class", float
    yield "a mapping", {"value": 1.0}


def number_mistakes(full, name, words, value):
    for mistake, wrong in no_numbers(value):
        if not ("str" in words and mistake in ("the text '3'", "a word")):
            yield mistake, wrong
    yield "one in a list", [value]
    yield "a list", [value, value]
    if name not in MAY_BE_NAN:
        yield "NaN", np.nan
    if name not in MAY_BE_INFINITE:
        yield "inf", np.inf
    if not may_be_negative(full, name):
        yield "negative", -abs(value) - 0.25
    if name in ABOVE_ZERO:
        yield "zero", 0.0


def numbers_mistakes(full, name, words, value):
    yield from no_numbers(value)
    yield "NaN", np.nan
    yield "NaN in a list", [value, np.nan]
    yield "None in a list", [value, None]
    yield "texts in a list", [str(value), str(value)]
    yield "one masked", np.ma.masked_array([value, value], [False, True])
    if name not in MAY_BE_INFINITE:
        yield "inf", np.inf
    if not may_be_negative(full, name):
        yield "negative", -abs(value) - 0.25
    if name in ABOVE_ZERO:
        yield "zero", 0.0


def count_mistakes(full, name, words, value):
    for mistake, wrong in no_numbers(value):
        if not ("str" in words and mistake in ("the text '3'", "a word")) and not (
            mistake == "a date" and "datetime64" in words
        ):
            yield mistake, wrong
    yield "one in a list", [value]
    yield "NaN", np.nan
    yield "inf", np.inf
    yield "a half", value + 0.5
    yield "a float", float(value)
    yield "a bool", True
    yield "10**30", 10**30
    if not may_be_negative(full, name):
        yield "negative", -1
    if name in ABOVE_ZERO:
        yield "zero", 0


def flag_mistakes(full, name, words, value):
    yield "the text 'False'", "False"
    yield "2", 2
    yield "0.0", 0.0
    yield "NaN", np.nan
    yield "a list", [True]
    yield "an array", np.array([True, False])
    yield "a City", things.TOWN
    yield "pandas.NA", pandas.NA


def words_mistakes(full, name, words, value):
    yield "3", 3
    yield "NaN", np.nan
    yield "bytes", b"name"
    yield "a list", [value]
    yield "a City", things.TOWN


def choice_mistakes(full, name, words, value):
    numeric = bool(words & {"float", "int", "ArrayLike", "ndarray"})
    yield "an unknown one", "unknown"
    yield "empty", ""
    if not numeric:
        yield "3", 3
    yield "NaN", np.nan
    yield "bytes", value.encode()
    yield "a list", [value]
    yield "an array", np.array([value, value])
    yield "a City", things.TOWN
    yield "complex", 1 + 2j
    yield "pandas.NA", pandas.NA


def path_mistakes(full, name, words, value):
    yield "2", 2
    yield "True", True
    yield "0.5", 0.5
    yield "a list", [str(value)]
    yield "a City", things.TOWN


def seed_mistakes(full, name, words, value):
    yield "the text '1'", "1"
    yield "negative", -1
    yield "a float", 1.0
    yield "NaN", np.nan
    yield "a bool", True
    yield "complex", 1 + 2j
    yield "numpy.random", np.random
    yield "a RandomState", np.random.RandomState(0)
    yield "an array of floats", np.array([0.5])
    yield "a class", np.random.Generator
    yield "empty", []


def crs_mistakes(full, name, words, value):
    yield "a word", "nowhere"
    yield "0.5", 0.5
    yield "NaN", np.nan
    yield "a City", things.TOWN
    yield "a list", [4326]


def array_mistakes(full, name, words, value):
    array = np.asarray(value, dtype=float)
    one = np.unravel_index(array.size // 2, array.shape)

    def with_one(wrong, kind):
        changed = array.astype(kind)
        changed[one] = wrong
        return changed

    yield "a word", "much"
    yield "NaN inside", with_one(np.nan, float)
    if name not in MAY_BE_INFINITE:
        yield "inf inside", with_one(np.inf, float)
    yield "None inside", with_one(None, object).tolist()
    yield "pandas.NA inside", with_one(pandas.NA, object).tolist()
    yield "10**400 inside", with_one(HUGE, object).tolist()
    yield "texts", array.astype(str)
    yield "complex", array + 1j
    yield "dates", np.full(array.shape, DATE)
    mask = np.zeros(array.shape, bool)
    mask[one] = True
    yield "masked", np.ma.masked_array(array, mask)
    yield "a City", things.TOWN
    yield "a class", np.ndarray
    yield "a mapping", {"x": 1.0}
    ragged = array.tolist()
    ragged[-1] = [*ragged[-1][:-1]] if array.ndim > 1 else [ragged[-1], ragged[-1]]
    yield "ragged", ragged
    row = array.ndim == 1 and name in ROWS
    if "float" not in words or array.ndim > 1:
        yield "one number", 0.5
    if not row:
        yield "too short", array[..., :1]
        yield "too long", np.concatenate([array, array, array], axis=-1)[..., : array.shape[-1] + 2]
    if array.ndim > 1:
        yield "flat", array.ravel()
    yield "deeper", array[None]
    yield "empty", array[:0]
    if name in ARRAYS_NOT_NEGATIVE:
        yield "negative", -array - 0.25


def bools_mistakes(full, name, words, value):
    yield "a word", "much"
    yield "texts", value.astype(str)
    yield "NaN inside", np.where(np.arange(value.size).reshape(value.shape) == 0, np.nan, value)
    yield "twos", value.astype(int) + 1
    yield "complex", value.astype(complex)
    yield "dates", np.full(value.shape, DATE)
    yield "masked", np.ma.masked_array(value, np.arange(value.size).reshape(value.shape) == 0)
    yield "flat", value.ravel()
    yield "one", True
    yield "a City", things.TOWN
    yield "empty", value[:0]


def indices_mistakes(full, name, words, value):
    yield "a word", "much"
    yield "halves", value + 0.5
    yield "NaN inside", np.where(np.arange(value.size).reshape(value.shape) == 0, np.nan, value)
    yield "None inside", [None, *value.tolist()[1:]]
    yield "texts", value.astype(str)
    yield "complex", value + 1j
    yield "dates", np.full(value.shape, DATE)
    yield "bools", value > 0
    yield "masked", np.ma.masked_array(value, np.arange(value.size).reshape(value.shape) == 0)
    yield "10**400 inside", [HUGE, *value.tolist()[1:]]
    yield "negative", -value - 1
    yield "10**12", value + 10**12
    yield "a City", things.TOWN
    if value.ndim > 1:
        yield "too short", value[..., :1]
        yield "ragged", [value[0].tolist(), value[1].tolist()[:-1]]


def mapping_mistakes(full, name, words, value):
    yield "a list", list(value.values())
    yield "a word", "much"
    yield "3", 3
    yield "NaN", np.nan
    yield "a City", things.TOWN
    if not value or name in ("info",):
        return
    first = next(iter(value))
    yield "None inside", {**value, first: None}
    yield "a word inside", {**value, first: "much"}
    yield "NaN inside", {**value, first: np.nan}
    yield "a City inside", {**value, first: things.TOWN}
    yield "a class inside", {**value, first: float}
    yield "numbers for names", {1: value[first]}


def names_mistakes(full, name, words, value):
    yield "a word", value[0]
    yield "empty", ()
    yield "3", 3
    yield "twice", (value[0], value[0])
    yield "numbers", (1, 2)
    yield "None inside", (value[0], None)
    yield "NaN", np.nan
    yield "a City", things.TOWN


def sequence_mistakes(full, name, words, value):
    """Of sequences of things of ours, of outlines, of keyword arguments."""
    yield "a word", "much"
    yield "3", 3
    yield "NaN", np.nan
    yield "None inside", [*value, None]
    yield "a word inside", [*value, "much"]
    yield "3 inside", [*value, 3]
    yield "a class inside", [type(value[0])]
    others = [kind for kind in OURS if not isinstance(value[0], type(OURS[kind])) and not taken(kind, words)]
    for kind in others[:3]:
        yield f"a {kind} inside", [OURS[kind]]
        yield f"a {kind}", OURS[kind]


def taken(kind, words):
    """Whether an annotation takes one of ours."""
    return kind in words or any(kind in TAKEN_FOR.get(word, ()) for word in words)


def thing_mistakes(full, name, words, value):
    yield "a word" if "str" not in words else "bytes", "much" if "str" not in words else b"much"
    yield "3" if "float" not in words else "complex", 3 if "float" not in words else 3j
    yield "NaN", np.nan
    yield "a list", [value]
    yield "empty", []
    yield "a mapping", {"value": value}
    if value is not None:
        yield "a class", type(value)
    for kind, other in OURS.items():
        if not taken(kind, words) and not isinstance(value, type(other)):
            yield f"a {kind}", other


def table_mistakes(full, name, words, value):
    first = value.columns[0]
    yield "a word", "much"
    yield "3", 3
    yield "a list", value.to_numpy().tolist()
    yield "an array", value.to_numpy()
    yield "a column missing", value.drop(columns=first)
    yield "a column twice", pandas.concat([value, value[[first]]], axis=1)
    yield "texts", value.assign(**{first: "much"})
    yield "numbers as texts", value.assign(**{first: value[first].astype(str)})
    yield "None inside", value.assign(**{first: [None, *value[first][1:]]})
    yield "NaN inside", value.assign(**{first: [np.nan, *value[first][1:]]})
    yield "inf inside", value.assign(**{first: [np.inf, *value[first][1:]]})
    yield "pandas.NA inside", value.assign(**{first: pandas.array([None, *[1] * (len(value) - 1)], dtype="Int64")})
    yield "complex", value.assign(**{first: 1 + 2j})
    yield "dates", value.assign(**{first: DATE})
    yield "no rows", value.iloc[:0]
    yield "a City", things.TOWN
    yield "a class", pandas.DataFrame


def function_mistakes(full, name, words, value):
    yield "a word", "much"
    yield "3", 3
    yield "a City", things.TOWN
    if full.startswith("sweep."):
        return
    yield "returns None", lambda *given, **named: None
    yield "returns text", lambda *given, **named: "much"
    yield "returns a wrong shape", lambda *given, **named: np.zeros((2, 3, 5))
    yield "returns a City", lambda *given, **named: things.TOWN
    yield "returns complex", lambda *given, **named: np.full(len(given[0]) if given else 1, 1j)


def variants_for(key: str, name: str, note: str, value: Any) -> Iterator[tuple[str, Any]]:
    """Other ways to say the same, which have to give the same."""
    kind = kind_of(key, name, note, value)
    if kind in ("number", "numbers"):
        yield "float32", np.float32(value)
        yield "float64", np.float64(value)
        if value == round(value):
            yield "int", int(value)
            yield "int64", np.int64(value)
            if 0 <= value < 256:
                yield "uint8", np.uint8(value)
        yield "0-d array", np.array(value)
    elif kind == "count":
        yield "int64", np.int64(value)
        yield "int32", np.int32(value)
        if 0 <= value < 256:
            yield "uint8", np.uint8(value)
    elif kind == "flag":
        yield "numpy bool", np.bool_(value)
    elif kind in ("choice", "words"):
        yield "numpy str", np.str_(value)
    elif kind == "path":
        yield "str", str(value)
    elif kind == "seed":
        yield "int64", np.int64(value)
        yield "generator", np.random.default_rng(value)
    elif kind in ("array", "bools", "indices"):
        yield from array_variants(kind, name, value)
    elif kind in ("names", "sequence"):
        yield "list", list(value)
        yield "tuple", tuple(value)


def array_variants(kind, name, value):
    array = np.asarray(value)
    yield "list", array.tolist()
    yield "tuple", tuple(map(tuple, array)) if array.ndim == 2 else tuple(array.tolist())
    yield "array", array.copy()
    if kind == "array":
        yield "float32", array.astype(np.float32)
    if kind == "array" and (array == np.round(array)).all():
        yield "int64", array.astype(np.int64)
    if kind == "indices":
        yield "uint8", array.astype(np.uint8)
        yield "int32", array.astype(np.int32)
    fixed = array.copy()
    fixed.setflags(write=False)
    yield "read-only", fixed
    if array.ndim > 1:
        yield "Fortran", np.asfortranarray(array)
    wide = np.repeat(array, 2, axis=-1)
    yield "non-contiguous", wide[..., ::2]
    if array.ndim == 1:
        yield "pandas.Series", pandas.Series(array, index=range(5, 5 + len(array)))
