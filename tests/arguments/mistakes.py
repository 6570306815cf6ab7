"""Plausible mistakes, and rightful variants, by the kind of a parameter; and what is rightful though it looks wrong.

The kind follows from the parameter's annotation and from the rightful value in the table of calls, the range from what
the documentation says of it, else from its name.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas
import things

HUGE = 10**400
DATE = np.datetime64("2026-01-01")

OURS = {
    "City": things.TOWN, "UAV": things.DRONE, "RiskMap": things.RISK, "Route": things.LINE, "Curve": things.CURVE,
    "Weather": things.MILD, "Wind": things.BREEZE, "Flight": things.FLIGHT, "Mission": things.MISSION,
}  # fmt: skip
"""Instances that are mistaken for each other."""

STANDS_FOR = {
    "Way": ("Curve", "Flight"), "Curve": ("Flight",), "Drawn": ("Route", "Curve", "Flight", "Mapping"),
    "Disturbance": ("Wind", "Weather"),
}  # fmt: skip
"""What else an annotation takes; a flight has a route, as a curve has."""

FREE_TEXT = {
    "name", "title", "label", "unit", "reason", "planner", "advice", "what", "priced", "color", "colors", "x_label",
    "y_label", "row_label", "column_label", "point_label", "band_label", "level",
}  # fmt: skip
"""Texts that may say anything, or that somebody else looks at."""

ROWS = {
    "samples", "lengths", "t", "knots", "log_median", "offsets", "predicted", "counts", "parameter", "code", "width",
    "cars_per_km", "x",
}  # fmt: skip
"""One-dimensional arrays of any length; the others are vectors."""

ANY_COLUMNS = {
    "spline.bspline.control", "spline.cubic_bspline.control", "spline.fitted.points", "spline.subdivided.control",
    "statistics.over_maps.values", "statistics.share_over_maps.values", "city.Terrain.from_raster.heights",
    "risk.raster_layer.values",
}  # fmt: skip
"""Arrays whose last axis may be of any length."""

OUTER_AXES = {"offsets.JointOffset.density.points", "offsets.JointOffset.radius_in_sigma.points",
              "city.Building.contains.points", "planners.potential_forces.points"}  # fmt: skip
"""Arrays with any number of axes before the last, of which the documentation has no "(..."."""

SIGNED = {
    "bottom", "eaves", "top", "temperature_c", "longitude", "latitude", "mean", "mean_length", "margin", "x", "gust",
    "correlation", "mean_away", "pitch", "street_axis_deg", "azimuth_deg", "elevation_deg", "wind_angle", "cost", "low",
    "high", "terrain", "target", "base", "lower", "upper", "jobs", "time", "fill", "most", "height", "default_height",
    "values", "a",
}  # fmt: skip
"""Numbers that may be below 0, in some calls at least; but see `NOT_NEGATIVE`."""

NOT_NEGATIVE = {
    "scene.show.height", "plot.section.height", "plot.risk.height", "plot.field.height", "plot.new_figure.height",
    "flight.Gps.correlation", "weather.Wind.correlation", "weather.Wind.from_weather.correlation",
    "city.City.from_buildings.margin", "city.read_geojson.margin", "city.read_cityjson.margin",
    "risk.shelter_layer.high",
}  # fmt: skip
"""Numbers of those names that may not; in plots, heights that lie below the map."""

ARRAYS_NOT_NEGATIVE = {
    "price",
    "population_density",
    "shelter",
    "vehicle_share",
    "offsets",
    "counts",
    "lengths",
    "sigma",
}

ABOVE_ZERO = {
    "cell", "mass", "thrust", "drag_area", "diameter", "cruise_speed", "top_speed", "max_tilt", "rotor_area",
    "figure_of_merit", "drive_efficiency", "step", "time_step", "natural_frequency", "speed_share", "tilt_share",
    "predicted", "hold", "interval", "every", "spacing", "spare", "air_density", "storey_height", "lane_width",
    "acceptance_radius", "wind_scale", "wind_shape", "averaging_time", "width", "air_speed", "altitude", "stiffness",
    "still_offset", "even_odds_energy", "least_fatal_energy", "least", "max_length", "bank", "class_count", "flights",
    "budget", "ants", "swarm", "waypoints", "total", "trials", "per_segment", "dimensions", "max_steps", "until",
    "probes", "block", "jobs", "train_count", "safety_factor", "gust_factor", "weight", "rate", "bit_rate", "pace",
    "lifetime", "ceiling",
}  # fmt: skip
"""Numbers that are never 0, where the documentation doesn't say it."""

MAY_BE_INFINITE = {
    "max_height", "battery", "climb_speed", "sink_speed", "at_most", "upper", "curvature", "clearance", "cost",
    "max_length", "target", "exact_within", "omega", "x", "gust", "price", "v_max", "max_pheromone", "bit_rate",
}  # fmt: skip

MAY_BE_NAN = {
    "route.Route.cost",  # none is known
    "city.Terrain.from_raster.heights", "city.Terrain.from_grid.grid", "risk.raster_layer.values",  # no data
    "plot.section.values", "plot.value_map.values", "plot.heat_map.values", "plot.matrix.values",  # isn't drawn
    "city.City.cell_of.points", "city.City.inside.points", "city.City.is_free.points",  # lies outside of every map
    "city.LazyCity.is_free.points",
}  # fmt: skip

MAY_BE_MASKED = {
    "city.Terrain.from_raster.heights", "risk.raster_layer.values", "plot.section.values", "plot.value_map.values",
}  # fmt: skip
"""Where masked means the same as NaN."""

EVERYTHING = "everything"

RIGHTFUL = {
    "exercises.check.answer": {EVERYTHING},  # what a student hands in is looked at by each exercise
    "exercises.grade.answer": {EVERYTHING},
    "route.Route.none.elapsed": {EVERYTHING},  # a note
    "planners.compare_planners.seeds": {"3 inside"},  # a seed
    "prediction.compare_models.seeds": {"3 inside"},
    "prediction.OffsetPredictor.fit.groups": {"halves", "texts", "negative", "10**12"},  # any labels
    "planners.pareto_front.lengths": {"one number", "3", "3 inside", "a half", "a float", "one in a list", "a list"},
    "planners.flight_conditions.disturbance": {"a word"},  # has a class of wind
    "planners.repare.disturbance": {"a word"},
    "city.read_geojson.height": {"an unknown one"},  # a property that the file hasn't
    "city.read_geojson.base": {"an unknown one"},
    "city.read_no_fly.lower": {"an unknown one"},
    "city.read_no_fly.upper": {"an unknown one"},
    "plot.in_flight.flights": {"a list"},  # by number
    "scene.page.flights": {"a mapping"},
    "scene.live.flights": {"zero"},  # without a button
    "scene.show.flights": {"a list"},
    "scene.still.flights": {"a list"},
    "plot.styles.names": {"nothing", "twice"},  # two things of one name
    "risk.osm_layers.cars_per_km": {"3", "a mapping"},  # the same for all classes
    "statistics.grouped_share_interval.counts": {"bools"},  # whether there was an event
    "risk.shelter_layer.ground": {"one number"},
    "city.City.from_buildings.terrain": {"3"},
    "city.LazyCity.part.around": {"a Route"},
    "route.Route.integral.values": {"NaN inside", "None inside", "inf inside"},  # refused only where the route passes
    "statistics.over_maps.values": {"inf inside"},  # runs that failed have infinite gaps; their median is asked for
    "mission.Item.altitude": {"negative", "zero"},
    "mission.Item.parameters": {"NaN inside", "None inside"},  # as it is
    "mission.Mission.from_route.hold": {"zero"},
    "mission.Mission.heights": {"an unknown one"},
    "mission.Mission.notes": {"nothing", "twice"},
    "optimizers.bas.start": {"deeper"},  # one point as a row of several
    "optimizers.pso.start": {"deeper"},
    "optimizers.pso_bas.start": {"deeper"},
    **{f"plot.{kind}.x_range": {"None inside"} for kind in ("diagram", "intervals", "lines", "points", "runs")},
    **{f"plot.{kind}.y_range": {"None inside"} for kind in ("diagram", "lines", "points")},  # ends by itself
    "plot.heat_map.contours": {"too short"},
    "plot.sliders.labels": {"a word inside"},  # is one
    "trial.claims_table.links": {"a word inside"},  # is a file's name
    "plot.bars.values": {"NaN inside"},  # has no bar, such as the clearance of a route that doesn't arrive
}
"""Mistakes that are none, by function and parameter."""

LENIENT = {"empty", "no rows", "numbers for names"}
"""What may be taken, but must not end in an error that doesn't name it, or in NaN."""


class Spot(NamedTuple):
    """A parameter in a rightful call."""

    function: str
    """Its key, without ": …"."""
    name: str
    """Of the parameter; of what stands under **site, its own."""
    note: str
    """Annotation."""
    said: str
    """Its entry in the documentation, else all of that."""
    optional: bool
    """Whether None is rightful."""
    value: Any

    @property
    def full(self) -> str:
        return f"{self.function}.{self.name}"

    @property
    def words(self) -> set[str]:
        """Names in the annotation."""
        return set(re.findall(r"\w+", self.note))

    @property
    def range_said(self) -> bool:
        """Whether the documentation has an entry for it alone, which then tells the range."""
        head = self.said.partition("\n")[0]
        return " : " in head and ("," not in head.partition(" : ")[0] or self.name not in SIGNED)

    def takes(self, kind: str) -> bool:
        """Whether the annotation takes one of ours."""
        return kind in self.words or any(kind in STANDS_FOR.get(word, ()) for word in self.words)

    @property
    def above_zero(self) -> bool:
        return self.name in ABOVE_ZERO or (
            self.range_said and re.search(r"\b(above 0|at least 1\b)", self.said) is not None
        )

    @property
    def may_be_negative(self) -> bool:
        if self.range_said and re.search(r"\b(above 0|at least [01]\b)", self.said):
            return False
        return self.name in SIGNED and self.full not in NOT_NEGATIVE

    @property
    def may_be_infinite(self) -> bool:
        return self.name in MAY_BE_INFINITE or self.full in MAY_BE_NAN

    @property
    def any_axes(self) -> bool:
        """Whether an array may have more axes in front."""
        head = self.said.partition("\n")[0]
        plain = re.search(r" : (float or )?array", head) is not None and "(" not in head
        return "(..." in self.said or plain or self.full in OUTER_AXES

    @property
    def or_number(self) -> bool:
        """Whether a number may stand for an array."""
        return (
            self.name in ROWS
            or "float" in self.words
            or bool(re.search(r"\b(float or|one number|number, or)", self.said))
        )


def kind_of(spot: Spot) -> str:
    """What kind of thing a parameter takes."""
    value, words = spot.value, spot.words
    if spot.name in ("rng", "crs"):
        return {"rng": "seed", "crs": "system"}[spot.name]
    if type(value).__name__ == "function":
        return "function"
    if isinstance(value, Path):
        return "path"
    if isinstance(value, pandas.DataFrame):
        return "table"
    if isinstance(value, bool):
        return "flag"
    if isinstance(value, str):
        return "words" if spot.name in FREE_TEXT else "choice"
    if isinstance(value, int):
        return "count"
    if isinstance(value, float):
        return "numbers" if words & {"ArrayLike", "ndarray"} else "number"
    if isinstance(value, Mapping):
        return "mapping"
    if isinstance(value, np.ndarray):
        whole = value.dtype.kind in "iu" and spot.name != "predicted"
        return "occupancy" if value.dtype == bool else "indices" if whole else "array"
    if type(value) in (list, tuple) and len(value):
        return kind_of_items(spot, value[0])
    return "thing"


def kind_of_items(spot: Spot, first: Any) -> str:
    if isinstance(first, str):
        return "names"
    nested = isinstance(first, tuple | list | np.ndarray) and not spot.words & {"Sequence", "tuple"}
    if isinstance(first, float) or (nested and spot.words & {"ArrayLike", "ndarray"}):
        return "array"
    return "sequence"


def mistakes_for(spot: Spot) -> Iterator[tuple[str, Any]]:
    """Mistakes by their names."""
    rightful = RIGHTFUL.get(spot.full, set())
    if EVERYTHING in rightful:
        return
    if not spot.optional and "None" not in rightful:
        yield "None", None
    for mistake, wrong in MAKERS[kind_of(spot)](spot):
        if mistake not in rightful:
            yield mistake, wrong


def no_numbers(spot: Spot) -> Iterator[tuple[str, Any]]:
    """What is no number at all."""
    if "str" not in spot.words:
        yield "the text '3'", "3"
        yield "a word", "much"
    if "datetime64" not in spot.words:
        yield "a date", DATE
    yield "complex", complex(1, 2)
    yield "pandas.NA", pandas.NA
    yield "masked", np.ma.masked
    yield "10**400", HUGE
    yield "ragged", [1.0, [2.0, 3.0]]
    yield "a City", things.TOWN
    yield "a class", float
    if "Mapping" not in spot.words:
        yield "a mapping", {"value": 1.0}


def out_of_range(spot: Spot) -> Iterator[tuple[str, Any]]:
    if spot.full not in MAY_BE_NAN:
        yield "NaN", np.nan
    if not spot.may_be_infinite:
        yield "inf", np.inf
    if not spot.may_be_negative:
        yield "negative", -abs(spot.value) - 0.25
    if spot.above_zero:
        yield "zero", 0.0


def number_mistakes(spot: Spot) -> Iterator[tuple[str, Any]]:
    yield from no_numbers(spot)
    yield from out_of_range(spot)
    if not spot.words & {"tuple", "Sequence"}:
        yield "one in a list", [spot.value]
        yield "a list", [spot.value, spot.value]


def numbers_mistakes(spot: Spot) -> Iterator[tuple[str, Any]]:
    """Of numbers that may be arrays."""
    value = spot.value
    yield from no_numbers(spot)
    yield from out_of_range(spot)
    yield "None in a list", [value, None]
    yield "NaN in a list", [value, np.nan]
    yield "texts in a list", [str(value), str(value)]
    yield "one masked", np.ma.masked_array([value, value], [False, True])


def count_mistakes(spot: Spot) -> Iterator[tuple[str, Any]]:
    yield from no_numbers(spot)
    yield "one in a list", [spot.value]
    yield "NaN", np.nan
    yield "inf", np.inf
    yield "a half", spot.value + 0.5
    yield "a float", float(spot.value)
    yield "a bool", True
    yield "10**30", 10**30
    if not spot.may_be_negative:
        yield "negative", -1
    if spot.above_zero:
        yield "zero", 0


def flag_mistakes(spot: Spot) -> Iterator[tuple[str, Any]]:
    yield "the text 'False'", "False"
    yield "2", 2
    yield "0.0", 0.0
    yield "NaN", np.nan
    yield "a list", [True]
    yield "an array", np.array([True, False])
    yield "a City", things.TOWN
    yield "pandas.NA", pandas.NA


def words_mistakes(spot: Spot) -> Iterator[tuple[str, Any]]:
    yield "3", 3
    yield "NaN", np.nan
    yield "bytes", b"name"
    yield "a list", [spot.value]
    yield "a City", things.TOWN


def choice_mistakes(spot: Spot) -> Iterator[tuple[str, Any]]:
    if spot.name != "at":
        yield "empty", ""
    yield "an unknown one", "unknown"
    if not spot.words & {"float", "int", "ArrayLike", "ndarray"}:
        yield "3", 3
    yield "NaN", np.nan
    yield "bytes", spot.value.encode()
    yield "a list", [spot.value]
    yield "an array", np.array([spot.value, spot.value])
    yield "a City", things.TOWN
    yield "complex", 1 + 2j
    yield "pandas.NA", pandas.NA


def path_mistakes(spot: Spot) -> Iterator[tuple[str, Any]]:
    yield "2", 2
    yield "True", True
    yield "0.5", 0.5
    yield "a list", [str(spot.value)]
    yield "a City", things.TOWN
    yield "empty text", ""


def seed_mistakes(spot: Spot) -> Iterator[tuple[str, Any]]:
    yield "the text '1'", "1"
    yield "negative", -1
    yield "a float", 1.0
    yield "NaN", np.nan
    yield "a bool", True
    yield "complex", 1 + 2j
    yield "numpy.random", np.random
    yield "an old generator", np.random.mtrand._rand
    yield "an array of floats", np.array([0.5])
    yield "a class", np.random.Generator
    yield "an empty list", []


def system_mistakes(spot: Spot) -> Iterator[tuple[str, Any]]:
    yield "a word", "nowhere"
    yield "0.5", 0.5
    yield "NaN", np.nan
    yield "a City", things.TOWN
    yield "a list", [4326]


def array_mistakes(spot: Spot) -> Iterator[tuple[str, Any]]:
    array = np.asarray(spot.value, dtype=float)
    middle = np.unravel_index(array.size // 2, array.shape)

    def with_one(wrong: Any) -> np.ndarray:
        changed = array.astype(float if isinstance(wrong, float) else object)
        changed[middle] = wrong
        return changed

    if "str" not in spot.words:
        yield "a word", "much"
    if spot.full not in MAY_BE_NAN:
        yield "NaN inside", with_one(np.nan)
        yield "None inside", with_one(None).tolist()
    if not spot.may_be_infinite:
        yield "inf inside", with_one(np.inf)
    yield "pandas.NA inside", with_one(pandas.NA).tolist()
    yield "10**400 inside", with_one(HUGE).tolist()
    yield "texts", array.astype(str)
    yield "complex", array + 1j
    yield "dates", np.full(array.shape, DATE)
    if spot.full not in MAY_BE_MASKED:
        yield "masked", np.ma.masked_array(array, np.arange(array.size).reshape(array.shape) == array.size // 2)
    yield "a City", things.TOWN
    yield "a class", np.ndarray
    if "Mapping" not in spot.words:
        yield "a mapping", {"x": 1.0}
    ragged = array.tolist()
    ragged[-1] = ragged[-1][:-1] if array.ndim > 1 else [ragged[-1], ragged[-1]]
    yield "ragged", ragged
    if not spot.or_number:
        yield "one number", 0.5
    if spot.full not in ANY_COLUMNS and not (array.ndim == 1 and spot.name in ROWS):
        yield "too short", array[..., :1]
        yield "too long", np.concatenate([array, array, array], axis=-1)[..., : array.shape[-1] + 2]
    if array.ndim > 1:
        yield "flat", array.ravel()
    if not spot.any_axes:
        yield "deeper", array[None]
    yield "empty", array[:0]
    if spot.name in ARRAYS_NOT_NEGATIVE:
        yield "negative", -array - 0.25


def occupancy_mistakes(spot: Spot) -> Iterator[tuple[str, Any]]:
    value, first = spot.value, np.arange(spot.value.size).reshape(spot.value.shape) == 0
    yield "a word", "much"
    yield "texts", value.astype(str)
    yield "NaN inside", np.where(first, np.nan, value)
    yield "twos", value.astype(int) + 1
    yield "complex", value.astype(complex)
    yield "dates", np.full(value.shape, DATE)
    yield "masked", np.ma.masked_array(value, first)
    yield "flat", value.ravel()
    yield "one", True
    yield "a City", things.TOWN
    yield "no voxel", value[:0]


def indices_mistakes(spot: Spot) -> Iterator[tuple[str, Any]]:
    value, first = spot.value, np.arange(spot.value.size).reshape(spot.value.shape) == 0
    yield "a word", "much"
    yield "halves", value + 0.5
    yield "NaN inside", np.where(first, np.nan, value)
    yield "None inside", np.where(first, None, value).tolist()
    yield "texts", value.astype(str)
    yield "complex", value + 1j
    yield "dates", np.full(value.shape, DATE)
    yield "bools", value > 0
    yield "masked", np.ma.masked_array(value, first)
    yield "10**400 inside", np.where(first, HUGE, value.astype(object)).tolist()
    if spot.full != "city.City.center_of.index":  # voxels beyond the map have centres, too
        yield "negative", -value - 1
        yield "10**12", value + 10**12
    yield "a City", things.TOWN
    if value.ndim > 1:
        yield "too short", value[..., :1]
        yield "ragged", [value[0].tolist(), value[0].tolist()[:-1]]


def mapping_mistakes(spot: Spot) -> Iterator[tuple[str, Any]]:
    value = spot.value
    yield "a list", list(value.values())
    yield "a word", "much"
    if "float" not in spot.words or spot.note.startswith("Mapping") or spot.note.startswith("dict"):
        yield "3", 3
    yield "NaN", np.nan
    yield "a City", things.TOWN
    if value:
        first = next(iter(value))
        yield "None inside", {**value, first: None}
        yield "a word inside", {**value, first: "much"}
        yield "NaN inside", {**value, first: np.nan}
        yield "a City inside", {**value, first: things.TOWN}
        yield "a class inside", {**value, first: float}
        yield "numbers for names", {1: value[first]}
        if callable(value[first]):
            yield "one that returns None", {**value, first: lambda *given, **named: None}
            yield "one that returns text", {**value, first: lambda *given, **named: "much"}


def names_mistakes(spot: Spot) -> Iterator[tuple[str, Any]]:
    first = spot.value[0]
    yield "a word", first
    yield "nothing", ()
    yield "3", 3
    yield "twice", (first, first)
    yield "numbers", (1, 2)
    yield "None inside", (first, None)
    yield "NaN", np.nan
    yield "a City", things.TOWN


def sequence_mistakes(spot: Spot) -> Iterator[tuple[str, Any]]:
    """Of sequences of things of ours, of outlines, of keyword arguments."""
    value = spot.value
    yield "a word", "much"
    yield "3", 3
    yield "NaN", np.nan
    yield "None inside", [*value, None]
    yield "a word inside", [*value, "much"]
    yield "3 inside", [*value, 3]
    yield "a class inside", [type(value[0])]
    for kind in ("City", "UAV", "Route"):
        if not spot.takes(kind):
            yield f"a {kind} inside", [OURS[kind]]
            yield f"a {kind}", OURS[kind]


def thing_mistakes(spot: Spot) -> Iterator[tuple[str, Any]]:
    yield "a word" if "str" not in spot.words else "bytes", "much" if "str" not in spot.words else b"much"
    yield "3" if "float" not in spot.words else "complex", 3 if "float" not in spot.words else 3j
    yield "NaN", np.nan
    if not spot.takes("Sequence"):
        yield "a list", [spot.value]
        yield "an empty list", []
    if not spot.takes("Mapping"):
        yield "a mapping", {"value": spot.value}
    if spot.value is not None:
        yield "a class", type(spot.value)
    for kind, other in OURS.items():
        if not spot.takes(kind) and not isinstance(spot.value, type(other)):
            yield f"a {kind}", other


def table_mistakes(spot: Spot) -> Iterator[tuple[str, Any]]:
    value, first = spot.value, spot.value.columns[0]
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


def function_mistakes(spot: Spot) -> Iterator[tuple[str, Any]]:
    yield "a word", "much"
    yield "3", 3
    yield "a City", things.TOWN
    if not spot.function.startswith("sweep."):  # which takes what it returns
        yield "returns None", lambda *given, **named: None
        yield "returns text", lambda *given, **named: "much"
        yield "returns a wrong shape", lambda *given, **named: np.zeros((2, 3, 5))
        yield "returns a City", lambda *given, **named: things.TOWN
        yield "returns complex", lambda *given, **named: np.full(np.shape(given[0])[:1], 1j)


MAKERS = {
    "number": number_mistakes, "numbers": numbers_mistakes, "count": count_mistakes, "flag": flag_mistakes,
    "words": words_mistakes, "choice": choice_mistakes, "path": path_mistakes, "seed": seed_mistakes,
    "array": array_mistakes, "occupancy": occupancy_mistakes, "indices": indices_mistakes,
    "mapping": mapping_mistakes, "names": names_mistakes, "sequence": sequence_mistakes, "thing": thing_mistakes,
    "table": table_mistakes, "function": function_mistakes, "system": system_mistakes,
}  # fmt: skip


def variants_for(spot: Spot) -> Iterator[tuple[str, Any]]:
    """Other ways to say the same, which have to give the same."""
    kind, value = kind_of(spot), spot.value
    if kind in ("number", "numbers"):
        yield "float32", np.float32(value)
        yield "float64", np.float64(value)
        yield "0-d array", np.array(value)
        if value == round(value):
            yield "int", int(value)
            yield "int64", np.int64(value)
            if 0 <= value < 256:
                yield "uint8", np.uint8(value)
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
        if spot.function not in ("risk.random_campus", "vehicle_sim.simulated_vehicle"):  # which tell the seed
            yield "generator", np.random.default_rng(value)
    elif kind in ("array", "occupancy", "indices"):
        yield from array_variants(kind, np.asarray(value))
    elif kind in ("names", "sequence"):
        yield "list", list(value)
        yield "tuple", tuple(value)


def array_variants(kind: str, array: np.ndarray) -> Iterator[tuple[str, Any]]:
    yield "list", array.tolist()
    yield "tuple", tuple(map(tuple, array)) if array.ndim == 2 else tuple(array.tolist())
    yield "array", array.copy()
    if kind == "array":
        yield "float32", array.astype(np.float32)
        if (array == np.round(array)).all():
            yield "int64", array.astype(np.int64)
    if kind == "indices":
        yield "uint8", array.astype(np.uint8)
        yield "int32", array.astype(np.int32)
    fixed = array.copy()
    fixed.setflags(write=False)
    yield "read-only", fixed
    yield "non-contiguous", np.repeat(array, 2, axis=-1)[..., ::2]
    if array.ndim > 1:
        yield "Fortran", np.asfortranarray(array)
    else:
        yield "pandas.Series", pandas.Series(array, index=range(5, 5 + len(array)))
