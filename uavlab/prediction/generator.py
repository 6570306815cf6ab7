"""A physical generator of offsets: how far gusts push in a given weather, and how sure anyone can be of it.

REPARE's flight data (section 2.2.3) are not published, so nobody has offsets that were measured. Every offset here is
drawn by `simulate_offsets`; only the weather may be real. What is drawn is known: the chance of each class, and with it
the best accuracy that any model can reach.

An offset ξ [m] is what the strongest gust of a flight reaches. Its class is the offset rounded up.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
from scipy.special import ndtr

from uavlab import checks
from uavlab.requirements import require
from uavlab.vehicle import UAV
from uavlab.weather import Weather, air_density

if TYPE_CHECKING:
    import pandas

FEATURES = ("temperature_c", "humidity_percent", "pressure_hpa", "wind_speed", "wind_from_deg", "radiation")
"""The paper's six: [°C], [%], [hPa], [m/s], [degrees], [W/m²]."""


def median_offsets(
    weather: Any,
    uav: UAV,
    *,
    channelling: float = 0.38,
    street_axis_deg: float = 60.0,
    height_factor: float = 1.4,
    mechanical_turbulence: float = 0.2,
    convective_turbulence: float = 0.3,
    convective_wind: float = 3.0,
    peak_factor: float = 2.5,
    stiffness: float = 8.5,
    still_offset: float = 0.5,
) -> np.ndarray:
    """Median of the offset in a weather, by the physics alone.

    ξ = ξ₀ + 8.5 m · F / F_reserve with the drag F = ½ ρ C S V² (`wind_drag`) of the gust
    V = V_station · height factor · [1 + channelling · cos 2(wind direction − street)] · (1 + peak factor · I), the
    turbulence intensity I = I_m + I_c · (radiation / 1000 W/m²) / (1 + V_station/V_c), which the sun raises most when
    the wind is light, ρ of moist air, and F_reserve the thrust that the weight leaves sideways.

    Parameters
    ----------
    weather : pandas.DataFrame, mapping of arrays or numbers, or Weather
        With the columns `FEATURES`, N rows.
    uav : UAV
    channelling : float
        Share by which the wind is stronger along the streets and weaker across them, 0 to below 1.
    street_axis_deg : float
        Direction of the streets [degrees], clockwise from north; 180 more is the same.
    height_factor : float
        Wind where the UAV flies over wind at the station; 1.4 is a power law of exponent 0.22 from 10 to 45 m.
    mechanical_turbulence : float
        Turbulence intensity I_m without sun, about 0.2 over a city.
    convective_turbulence : float
        I_c, added at 1000 W/m² in calm; 0.2 to 0.4.
    convective_wind : float
        Wind V_c that halves what the sun adds [m/s]; 2 to 5.
    peak_factor : float
        Strongest gust, in standard deviations above the mean; 2 to 3.5.
    stiffness : float
        Offset when the drag eats the whole reserve [m]. 8.5 gives the distances of REPARE Table 4 with the ξ₀ = 1 m and
        the gusts of 1.75 times the mean of `uavlab.resilience`; with the defaults here they are 1 m less.
    still_offset : float
        ξ₀ in calm [m], above 0: no position is held exactly.

    Returns
    -------
    (N,) array
        Median offset [m].

    Raises
    ------
    ValueError
        If a parameter or a value of the weather is out of its range, a column is missing, or the rotors have no
        reserve.
    """
    checks.finite("street_axis_deg", street_axis_deg)
    checks.positive("height_factor", height_factor)
    checks.positive("convective_wind", convective_wind)
    checks.positive("stiffness", stiffness)
    checks.positive("still_offset", still_offset)
    checks.not_negative("mechanical_turbulence", mechanical_turbulence)
    checks.not_negative("convective_turbulence", convective_turbulence)
    checks.not_negative("peak_factor", peak_factor)
    if not 0 <= channelling < 1:
        raise ValueError(f"channelling must be from 0 to below 1, got {channelling!r}")
    reserve = uav.horizontal_reserve()
    if reserve <= 0:
        raise ValueError(f"uav has no thrust left against the wind: {uav.name}, carry less")
    table = feature_table(weather)
    temperature, humidity, pressure, wind, wind_from, radiation = table.to_numpy(dtype=float).T
    checks.not_negative("wind_speed", wind)
    checks.not_negative("radiation", radiation)
    density = air_density(temperature, humidity, pressure)
    street = 1.0 + channelling * np.cos(2.0 * np.radians(wind_from - street_axis_deg))
    turbulence = mechanical_turbulence + convective_turbulence * radiation / 1000.0 / (1.0 + wind / convective_wind)
    gust = wind * height_factor * street * (1.0 + peak_factor * turbulence)
    drag = 0.5 * density * uav.drag_area * gust**2
    return still_offset + stiffness * drag / reserve


def simulate_offsets(
    weather: Any, uav: UAV, rng: np.random.Generator | int, *, noise: float = 0.21, **site: float
) -> np.ndarray:
    """Draw the offsets of flights, one in each weather; they are simulated, never measured.

    ξ = median · exp(s·N(0, 1)): the same weather doesn't push twice as far.

    Parameters
    ----------
    weather : pandas.DataFrame, mapping of arrays or numbers, or Weather
        With the columns `FEATURES`, N rows.
    uav : UAV
    rng : numpy.random.Generator or int
    noise : float
        Spread s of the logarithm, at least 0; 0.1 to 0.4.
    site : float
        The parameters of `median_offsets`: streets, turbulence, control.

    Returns
    -------
    (N,) array
        ξ [m].

    Raises
    ------
    ValueError
        As `median_offsets`; if the noise is negative.
    """
    checks.not_negative("noise", noise)
    median = median_offsets(weather, uav, **site)
    return median * np.exp(noise * checks.generator("rng", rng).standard_normal(len(median)))


def offset_class(offsets: npt.ArrayLike, class_count: int = 6) -> np.ndarray:
    """Class of an offset: metres, rounded up, from 1 to the last class.

    Parameters
    ----------
    offsets : array
        ξ [m], at least 0.
    class_count : int
        At least 2; the last class holds all that is larger.

    Returns
    -------
    array of int

    Raises
    ------
    ValueError
        If an offset is negative or not finite.
    """
    checks.whole("class_count", class_count, 2)
    checks.not_negative("offsets", offsets)
    return np.clip(np.ceil(offsets), 1, class_count).astype(int)


def class_probabilities(log_median: npt.ArrayLike, noise: float, class_count: int = 6) -> np.ndarray:
    """Probability of each class when the logarithm of the offset is normal.

    P(k) = Φ[(ln k − m)/s] − Φ[(ln(k−1) − m)/s]; what lies beyond the ends goes to the first and the last class.

    Parameters
    ----------
    log_median : (N,) array
        m [log m].
    noise : float
        s, above 0.
    class_count : int
        At least 2.

    Returns
    -------
    (N, class_count) array
        Each row adds up to 1.

    Raises
    ------
    ValueError
        If a median is not finite, or the noise or the number of classes out of its range.
    """
    checks.whole("class_count", class_count, 2)
    checks.positive("noise", noise)
    checks.finite("log_median", log_median)
    middle = np.atleast_1d(np.asarray(log_median, dtype=float))[:, None]
    below = ndtr((np.log(np.arange(1, class_count)) - middle) / noise)
    return np.diff(below, axis=1, prepend=0.0, append=1.0)


def bayes_accuracy(log_median: npt.ArrayLike, noise: float, class_count: int = 6) -> float:
    """The best accuracy that any model can expect: it knows the physics, but not the noise.

    Mean over the samples of max_k P(k | weather).

    Parameters
    ----------
    log_median, noise, class_count
        As for `class_probabilities`; `Dataset` has them.

    Returns
    -------
    float
        From 1/class_count to 1.
    """
    return float(class_probabilities(log_median, noise, class_count).max(axis=1).mean())


def feature_table(weather: Any, names: tuple[str, ...] = FEATURES) -> pandas.DataFrame:
    """The named columns of a weather, in order and without gaps, as a table; raises ValueError as `checked_columns`."""
    table = checked_columns(weather, names)
    wrong = missing_values(table)
    if wrong:
        raise ValueError(f"{wrong}; leave these rows out, or fill the gaps")
    return table


def checked_columns(weather: Any, names: tuple[str, ...] = FEATURES) -> pandas.DataFrame:
    """The named columns in this order; a ValueError lists those that are missing, and what there is instead."""
    pandas = require("pandas", "prediction")
    if isinstance(weather, Weather):
        weather = {
            "temperature_c": [weather.temperature_c],
            "humidity_percent": [weather.humidity_percent],
            "pressure_hpa": [weather.pressure_hpa],
            "wind_speed": [weather.reference_wind.mean],
            "wind_from_deg": [weather.wind_from_deg],
            "radiation": [weather.radiation],
        }
    if not hasattr(weather, "keys"):
        raise ValueError(f"features must be a table with the columns {', '.join(names)}, got {type(weather).__name__}")
    if isinstance(weather, pandas.DataFrame):
        table = weather
    else:
        one_row = not any(np.ndim(value) for value in dict(weather).values())
        table = pandas.DataFrame(dict(weather), index=[0] if one_row else None)
    missing = [name for name in names if name not in table.columns]
    if missing:
        others = [str(name) for name in table.columns if name not in names]
        instead = f"; unknown: {', '.join(others)}" if others else ""
        raise ValueError(f"features lack {', '.join(missing)}{instead}")
    return pandas.DataFrame({name: checks.numbers(name, table[name]) for name in names}, index=table.index)


def missing_values(table: pandas.DataFrame) -> str:
    """How many rows have a value that is no number, in which columns, and where; empty when there is none."""
    wrong = ~np.isfinite(table.to_numpy(dtype=float))
    rows = table.index[wrong.any(axis=1)]
    if not len(rows):
        return ""
    counts = [f"{count} in {name}" for name, count in zip(table.columns, wrong.sum(axis=0), strict=True) if count]
    shown = ", ".join(map(str, rows[:5])) + (", ..." if len(rows) > 5 else "")
    return f"{len(rows)} of {len(table)} rows have NaN or infinite values: {', '.join(counts)} (rows {shown})"
