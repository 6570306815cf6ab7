"""Checks of arguments that several functions of the weather share: each names the argument, its value and the range."""

import numpy as np
import numpy.typing as npt


def within(name: str, value: npt.ArrayLike, low: float, high: float, unit: str) -> None:
    values = np.asarray(value, dtype=float)
    refuse(values, (values >= low) & (values <= high), f"{name} must be from {low:g} to {high:g} {unit}")


def not_negative(name: str, value: npt.ArrayLike) -> None:
    values = np.asarray(value, dtype=float)
    refuse(values, np.isfinite(values) & (values >= 0), f"{name} must be finite and at least 0")


def positive(name: str, value: npt.ArrayLike) -> None:
    values = np.asarray(value, dtype=float)
    refuse(values, np.isfinite(values) & (values > 0), f"{name} must be finite and above 0")


def at_least_one(name: str, value: npt.ArrayLike) -> None:
    values = np.asarray(value, dtype=float)
    refuse(values, np.isfinite(values) & (values >= 1), f"{name} must be finite and at least 1")


def vectors(**named: npt.ArrayLike) -> list[np.ndarray]:
    """The arguments as float arrays (..., D), all finite and with the same D, 2 or 3."""
    arrays = {name: np.asarray(value, dtype=float) for name, value in named.items()}
    for name, array in arrays.items():
        if array.ndim == 0 or array.shape[-1] not in (2, 3):
            raise ValueError(f"{name} must be a vector (east, north) or (east, north, up), got shape {array.shape}")
        if not np.isfinite(array).all():
            raise ValueError(f"{name} must be finite, got {array[~np.isfinite(array).all(axis=-1)].tolist()}")
    if len({array.shape[-1] for array in arrays.values()}) > 1:
        shapes = ", ".join(f"{name} {array.shape}" for name, array in arrays.items())
        raise ValueError(f"all vectors must have as many components, got shapes {shapes}")
    return list(arrays.values())


def air(temperature_c: npt.ArrayLike, humidity_percent: npt.ArrayLike, pressure_hpa: npt.ArrayLike) -> None:
    within("temperature_c", temperature_c, -60.0, 60.0, "°C (kelvin? subtract 273.15)")
    within("humidity_percent", humidity_percent, 0.0, 100.0, "%")
    highest = np.asarray(pressure_hpa, dtype=float).max(initial=0.0)
    if highest > 30_000:
        raise ValueError(f"pressure_hpa must be in hPa, got {highest:g}, which looks like Pa: divide by 100")
    within("pressure_hpa", pressure_hpa, 300.0, 1100.0, "hPa")


def refuse(values: np.ndarray, right: np.ndarray, demand: str) -> None:
    """Raise a ValueError with the first value that isn't right, if there is one."""
    if not right.all():
        raise ValueError(f"{demand}, got {values[~right].flat[0]:g}")
