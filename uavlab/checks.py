"""Checks of arguments that many functions share: each names the argument, its value and the range."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from decimal import Decimal
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

MOST = 10**9
"""What is counted to more than this never ends."""

MOST_JOBS = 10_000
"""Processes; what is beyond is a mistake."""

NO_NUMBERS = {"U": "text", "S": "text", "c": "complex numbers", "M": "dates", "m": "times", "V": "records"}
"""By NumPy's kinds of arrays; from some of them it would make numbers."""


def numbers(name: str, value: npt.ArrayLike) -> np.ndarray:
    """The argument as floats; text, dates and None are refused, even where NumPy would read a number in them."""
    if np.ma.is_masked(value) or (isinstance(value, list | tuple) and any(map(np.ma.is_masked, value))):
        raise ValueError(f"{name} has masked values, for which no number stands: fill them, or leave them out")
    try:
        values = np.asarray(value)
        if values.dtype.kind in NO_NUMBERS:
            raise ValueError(f"got {NO_NUMBERS[values.dtype.kind]}, {value!r:.60}")
        if value is None:
            raise ValueError("got None")
        texts = [item for item in values.flat if isinstance(item, str | bytes)] if values.dtype == object else []
        if texts:
            raise ValueError(f"got text, {texts[0]!r:.60}")
        return np.asarray(values, dtype=float)
    except (TypeError, ValueError, OverflowError) as wrong:
        raise ValueError(f"{name} must be a number or an array of numbers: {wrong}") from wrong


def frozen(values: npt.ArrayLike, kind: npt.DTypeLike = float) -> np.ndarray:
    """The values as an array that can't be written to: a copy, unless nobody else could write to it either."""
    array = np.asarray(values, dtype=kind)
    if array.flags.writeable or not array.flags.owndata or not array.flags.c_contiguous:
        array = np.array(array, order="C")
        array.setflags(write=False)
    return array


def number(name: str, value: npt.ArrayLike, check: Callable[..., Any] | None = None, *limits: Any) -> float:
    """The argument as one float: 10 of 8 bits, times 3600, would be too much for them.

    With `check`, such as `positive`, it must stand that, too: `number("share", share, within, 0.0, 1.0, "of all")`.
    """
    if not isinstance(value, float):
        values = numbers(name, value)
        if values.shape:
            raise ValueError(f"{name} must be one number, got an array of shape {values.shape}")
        value = float(values)
    if check is not None:
        check(name, value, *limits)
    return float(value)


def whole(name: str, value: int, least: int, most: int = MOST) -> int:
    if not (isinstance(value, int | np.integer) and not isinstance(value, bool) and value >= least):
        raise ValueError(f"{name} must be a whole number of at least {least}, got {value!r}")
    if value > most:
        raise ValueError(
            f"{name} must be at most {most:,}, or it never ends, got {Decimal(int(value)).normalize():.3g}"
        )
    return int(value)


def processes(name: str, value: int) -> int:
    """A number of processes, as joblib takes it."""
    known = isinstance(value, int | np.integer) and not isinstance(value, bool)
    if not (known and 0 < abs(value) <= MOST_JOBS):
        raise ValueError(
            f"{name} must be a number of processes, or −1 for one per core, got {value!r:.60}; at most {MOST_JOBS:,}"
        )
    return int(value)


def generator(name: str, rng: np.random.Generator | int | Sequence[int]) -> np.random.Generator:
    """The generator itself, or a new one from a seed; what gives other numbers each time is refused."""
    if isinstance(rng, np.random.Generator):
        return rng
    if all(map(is_seed, rng if isinstance(rng, list | tuple) and rng else [rng])):
        return np.random.default_rng(rng)
    raise ValueError(
        f"{name} must be a numpy.random.Generator, or a seed (a whole number of at least 0, or a list of some), so "
        f"that the result can be had again, got {rng!r:.60}"
    )


def is_seed(value: object) -> bool:
    return isinstance(value, int | np.integer) and not isinstance(value, bool) and bool(value >= 0)


def seeds(name: str, values: Iterable[int]) -> list[int]:
    """Seeds of several runs."""
    if isinstance(values, str | Mapping) or not isinstance(values, Iterable):
        raise ValueError(f"{name} must be whole numbers, such as range(10), got {values!r:.60}")
    several = list(values)
    for seed in several:
        if not is_seed(seed):
            raise ValueError(f"{name} must be whole numbers of at least 0, such as range(10), got {seed!r:.60} in them")
    return [int(seed) for seed in several]


def within(name: str, value: npt.ArrayLike, low: float, high: float, unit: str) -> None:
    if isinstance(value, float) and low <= value <= high:  # most are, and arrays of one number take ten times as long
        return
    values = numbers(name, value)
    refuse(values, (values >= low) & (values <= high), f"{name} must be from {low:g} to {high:g} {unit}")


def not_negative(name: str, value: npt.ArrayLike) -> None:
    if isinstance(value, float) and 0 <= value < np.inf:
        return
    values = numbers(name, value)
    refuse(values, np.isfinite(values) & (values >= 0), f"{name} must be finite and at least 0")


def positive(name: str, value: npt.ArrayLike) -> None:
    if isinstance(value, float) and 0 < value < np.inf:
        return
    values = numbers(name, value)
    refuse(values, np.isfinite(values) & (values > 0), f"{name} must be finite and above 0")


def not_negative_number(name: str, value: npt.ArrayLike) -> float:
    if isinstance(value, float) and 0 <= value < np.inf:  # most are
        return float(value)
    return number(name, value, not_negative)


def positive_number(name: str, value: npt.ArrayLike) -> float:
    if isinstance(value, float) and 0 < value < np.inf:
        return float(value)
    return number(name, value, positive)


def at_least_one(name: str, value: npt.ArrayLike) -> None:
    if isinstance(value, float) and 1 <= value < np.inf:
        return
    values = numbers(name, value)
    refuse(values, np.isfinite(values) & (values >= 1), f"{name} must be finite and at least 1")


def one_of(name: str, value: str, known: Iterable[str]) -> str:
    """The argument, if it is among the known ones."""
    known = list(known)
    if not isinstance(value, str) or value not in known:
        raise ValueError(f"{name} must be one of {', '.join(map(repr, known))}, got {value!r}")
    return str(value)


def flag(name: str, value: object) -> bool:
    """Refuse what isn't True or False: the text "False" would count as true."""
    if not isinstance(value, bool | np.bool_):
        raise ValueError(f"{name} must be True or False, got {value!r}")
    return bool(value)


def array(name: str, value: npt.ArrayLike, *shape: Any, finite: bool = True) -> np.ndarray:
    """The argument as floats of a shape: `array("points", points, None, 3)` for (N, 3), `..., 3` for (..., 3)."""
    values = numbers(name, value)
    tail = shape[1:] if shape[:1] == (...,) else shape
    fits = values.ndim >= len(tail) if len(tail) < len(shape) else values.ndim == len(shape)
    ends = values.shape[values.ndim - len(tail) :]
    if not (fits and all(asked in (None, got) for asked, got in zip(tail, ends, strict=False))):
        letters = iter("NMKL")
        words = ["..." if part is ... else next(letters) if part is None else str(part) for part in shape]
        wanted = f"({', '.join(words)}{',' * (len(words) == 1)})"
        raise ValueError(f"{name} must have shape {wanted}, got {values.shape}")
    if finite and not np.isfinite(values).all():
        raise ValueError(f"{name} must be finite, got {values[~np.isfinite(values)].flat[0]:g} in it")
    return values


def text(name: str, value: str) -> str:
    """Refuse what isn't text."""
    if not isinstance(value, str):
        raise ValueError(f"{name} must be text, got {value!r:.60}")
    return str(value)


def path(name: str, value: str | PathLike[str]) -> Path:
    """The name of a file as a path; a number would be a file that is open already."""
    if not isinstance(value, str | PathLike) or value == "":
        raise ValueError(f"{name} must be the name of a file, got {value!r:.60}")
    return Path(value)


def function(name: str, value: Any, how: str = "") -> Any:
    """Refuse what can't be called, and a class, which makes something else; `how` says how it is called."""
    if not callable(value) or isinstance(value, type):
        raise ValueError(f"{name} must be a function{f', called as {how}' * bool(how)}, got {value!r:.60}")
    return value


def listed(name: str, values: Any, what: str) -> list[Any]:
    """Anything that can be gone through as a list, but for text and mappings; `what` says of what."""
    if isinstance(values, str | Mapping) or not isinstance(values, Iterable):
        raise ValueError(f"{name} must be a list of {what}, got {type(values).__name__}")
    return list(values)


def several(name: str, values: Any, kind: type, *, least: int = 1) -> list[Any]:
    """A list of things of a kind; one of them alone is refused, and too few."""
    things = listed(name, values, kind.__name__)
    for number, thing in enumerate(things):
        instance(f"{name}[{number}]", thing, kind)
    if len(things) < least:
        raise ValueError(f"{name} must hold at least {least} {kind.__name__}, got {len(things)}")
    return things


def by_name(name: str, values: Any, kind: type | None = None, *, least: int = 1) -> dict[str, Any]:
    """Things by name, all of a kind if one is said."""
    what = "something" if kind is None else kind.__name__
    if not isinstance(values, Mapping):
        raise ValueError(f"{name} must be {what} by name, as in {{'A*': ...}}, got {type(values).__name__}")
    for key, thing in values.items():
        text(f"the names of {name}", key)
        if kind is not None:
            instance(f"{name}[{key!r}]", thing, kind)
    if len(values) < least:
        raise ValueError(f"{name} must hold at least {least}, got {len(values)}")
    return dict(values)


def vectors(**named: npt.ArrayLike) -> list[np.ndarray]:
    """The arguments as float arrays (..., D), all finite and with the same D, 2 or 3."""
    arrays = {name: numbers(name, value) for name, value in named.items()}
    for name, array in arrays.items():
        if array.ndim == 0 or array.shape[-1] not in (2, 3):
            raise ValueError(f"{name} must be a vector (east, north) or (east, north, up), got shape {array.shape}")
        if not np.isfinite(array).all():
            wrong = array[~np.isfinite(array).all(axis=-1)]
            raise ValueError(f"{name} must be finite, got {wrong[0].tolist()}")
    if len({array.shape[-1] for array in arrays.values()}) > 1:
        shapes = ", ".join(f"{name} {array.shape}" for name, array in arrays.items())
        raise ValueError(f"all vectors must have as many components, got shapes {shapes}")
    return list(arrays.values())


def three(name: str, value: npt.ArrayLike) -> tuple[float, float, float]:
    """A vector (east, north[, up]) as three numbers that a cache can take; without the third it is level."""
    vector = numbers(name, value)
    if vector.shape not in ((2,), (3,)) or not np.isfinite(vector).all():
        raise ValueError(f"{name} must be two or three finite numbers (east, north[, up]), got {value!r}")
    east, north, up = (*vector.tolist(), 0.0)[:3]
    return east, north, up


def show(point: npt.ArrayLike) -> str:
    """A point for a message: (90.0, 18.0, 30.0)."""
    return "(" + ", ".join(f"{coordinate:.1f}" for coordinate in np.asarray(point, dtype=float)) + ")"


MAKERS = {
    "Autopilot": "Autopilot() is the usual one",
    "Axes": "new_figure(width, height) makes some, too",
    "Comparison": "compare_planners(planners, maps, ...) makes one",
    "Controller": "uavlab.resilience has BASIC and ADVANCED",
    "Figure": "all functions of uavlab.plot give one",
    "Gps": "Gps() is the usual one, PERFECT_GPS one without errors",
    "Monitor": "Monitor(ConditionCheck(predicted), uav_diameter) is one",
    "Normalize": "Normalize(vmin, vmax) and LogNorm(vmin, vmax) of matplotlib.colors are some",
    "Rate": "crash_rate(flights) gives one",
    "SafetyDomain": "safety_domain(samples) of uavlab.offsets gives one",
    "Flight": "fly(route, city, uav, disturbance, rng=...) makes one",
    "Flights": "monte_carlo(route, city, uav, disturbance, rng=...) makes some",
    "Conditions": "flight_conditions(load, disturbance) makes some",
    "City": "read_city(path) reads one, a RiskMap has one as its .city",
    "RiskMap": "RiskMap(city, population_density, shelter) makes one",
    "Terrain": "Terrain.from_raster(heights, bounds) makes one, read_terrain(path) reads one",
    "NoFlyZone": "NoFlyZone(outline, lower, upper) makes one",
    "Route": "planners give one, Route(points) makes one; several are given one by one, as in *routes, or by name",
    "Curve": "smooth(route, city, uav) makes one",
    "Mission": "Mission.from_route(route, city, uav) makes one, read_plan(path) reads one",
    "Item": "Mission.from_route(route, city, uav) makes some",
    "FencePolygon": "Mission.from_route(route, city, uav) makes some",
    "Check": "preflight(mission, city, uav, weather) makes some",
    "Preflight": "preflight(mission, city, uav, weather) makes one",
    "Link": "connect(address) of uavlab.mavlink makes one",
    "Telemetry": "follow(link) gives some",
    "FlightLog": "FlightLog(mission, city, list(follow(link))) is one",
    "DataLink": "DataLink() is one that is perfect, P840 one that isn't",
    "UAV": "uavlab.vehicle has some",
    "Wind": "Wind(mean=(east, north)) is one, and so is a Weather",
}


def instance(name: str, value: object, kind: type) -> None:
    """Refuse a thing of another kind, such as a RiskMap where a City is asked for."""
    if not isinstance(value, kind):
        article = "an" if kind.__name__.startswith("A") else "a"
        raise ValueError(
            f"{name} must be {article} {kind.__name__}, got {type(value).__name__}"
            + (f": {MAKERS[kind.__name__]}" if kind.__name__ in MAKERS else "")
        )


def air(temperature_c: npt.ArrayLike, humidity_percent: npt.ArrayLike, pressure_hpa: npt.ArrayLike) -> None:
    within("temperature_c", temperature_c, -60.0, 60.0, "°C (kelvin? subtract 273.15)")
    within("humidity_percent", humidity_percent, 0.0, 100.0, "%")
    highest = numbers("pressure_hpa", pressure_hpa).max(initial=0.0)
    if highest > 30_000:
        raise ValueError(f"pressure_hpa must be in hPa, got {highest:g}, which looks like Pa: divide by 100")
    within("pressure_hpa", pressure_hpa, 300.0, 1100.0, "hPa")


def finite(name: str, value: npt.ArrayLike) -> None:
    if isinstance(value, float) and -np.inf < value < np.inf:
        return
    values = numbers(name, value)
    refuse(values, np.isfinite(values), f"{name} must be finite")


def share(name: str, value: npt.ArrayLike) -> np.ndarray:
    values = numbers(name, value)
    refuse(values, (values > 0) & (values < 1), f"{name} must be between 0 and 1, without the ends")
    return values


def samples(values: npt.ArrayLike, *, least: int, axes: int = 1) -> np.ndarray:
    """Samples (N,), or (N, axes), as floats: finite, enough of them, and not all equal on any axis."""
    values = numbers("samples", values)
    if values.ndim != min(axes, 2) or (axes > 1 and values.shape[1] != axes):
        wanted = "(N,)" if axes == 1 else f"(N, {axes})"
        raise ValueError(f"samples must have shape {wanted}, got {values.shape}")
    bad = np.flatnonzero(~np.isfinite(values.reshape(len(values), axes)).all(axis=1))
    if len(bad):
        rows = ", ".join(map(str, bad[:5])) + (", …" if len(bad) > 5 else "")
        raise ValueError(f"samples must be finite: {len(bad)} of {len(values)} are not, at {rows}; drop or repair them")
    if len(values) < least:
        raise ValueError(f"samples must be at least {least}, got {len(values)}")
    if (np.ptp(values, axis=0) == 0).any():
        raise ValueError("samples must differ: all are equal, so σ would be 0")
    return values


def set_fields(thing: object, check: Callable[..., Any], /, *names: str, **limits: Any) -> None:
    """Make of fields of a dataclass, frozen or not, what a check makes of them: `set_fields(self, number, "sigma")`."""
    for name in names:
        object.__setattr__(thing, name, check(name, getattr(thing, name), **limits))


def refuse(values: np.ndarray, right: np.ndarray, demand: str) -> None:
    """Raise a ValueError with the first value that isn't right, if there is one."""
    if not right.all():
        raise ValueError(f"{demand}, got {values[~right].flat[0]:g}")
