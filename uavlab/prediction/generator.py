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
        With its payload.
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
        If `channelling` is not from 0 to below 1, `height_factor`, `convective_wind`, `stiffness` or `still_offset` is
        not above 0, `mechanical_turbulence`, `convective_turbulence` or `peak_factor` is negative, or `street_axis_deg`
        is not finite. If `weather` is no table, lacks a column or has a value that is no number or outside of its
        range. If `uav` is no UAV, or has no thrust left against the wind.

    See Also
    --------
    simulate_offsets : the same with noise.
    uavlab.weather.wind_drag : the force.
    uavlab.resilience.gust_offset : the offset from the mean wind alone.

    Examples
    --------
    >>> from uavlab.prediction import median_offsets
    >>> from uavlab.vehicle import LIGHT_QUADROTOR
    >>> from uavlab.weather import Weather
    >>> along, across = Weather(forecast_wind=8.0, wind_from_deg=60.0), Weather(forecast_wind=8.0, wind_from_deg=150.0)
    >>> [round(float(median_offsets(weather, LIGHT_QUADROTOR)[0]), 1) for weather in (along, across)]
    [7.5, 1.9]
    """
    checks.instance("uav", uav, UAV)
    street_axis_deg = checks.number("street_axis_deg", street_axis_deg, checks.finite)
    channelling = checked_channelling(channelling)
    height_factor = checks.positive_number("height_factor", height_factor)
    convective_wind = checks.positive_number("convective_wind", convective_wind)
    stiffness = checks.positive_number("stiffness", stiffness)
    still_offset = checks.positive_number("still_offset", still_offset)
    mechanical_turbulence = checks.not_negative_number("mechanical_turbulence", mechanical_turbulence)
    convective_turbulence = checks.not_negative_number("convective_turbulence", convective_turbulence)
    peak_factor = checks.not_negative_number("peak_factor", peak_factor)
    reserve = uav.horizontal_reserve()
    if reserve <= 0:
        raise ValueError(f"uav has no thrust left against the wind: {uav.name}, carry less")
    table = feature_table(weather, argument="weather")
    temperature, humidity, pressure, wind, wind_from, radiation = table.to_numpy(dtype=float).T
    checks.not_negative("wind_speed", wind)
    checks.not_negative("radiation", radiation)
    density = air_density(temperature, humidity, pressure)
    street = 1.0 + channelling * np.cos(2.0 * np.radians(wind_from - street_axis_deg))
    turbulence = mechanical_turbulence + convective_turbulence * radiation / 1000.0 / (1.0 + wind / convective_wind)
    gust = wind * height_factor * street * (1.0 + peak_factor * turbulence)
    drag = 0.5 * density * uav.drag_area * gust**2
    return still_offset + stiffness * drag / reserve


def checked_channelling(channelling: float) -> float:
    channelling = checks.number("channelling", channelling)
    if not 0 <= channelling < 1:
        raise ValueError(f"channelling must be from 0 to below 1, got {channelling!r}")
    return channelling


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
        With its payload.
    rng : numpy.random.Generator or int
        Or a seed.
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
        If `noise` is negative, or `rng` is neither a generator nor a seed; for `weather`, `uav` and `site` as
        `median_offsets`.

    See Also
    --------
    median_offsets : the physics in it.
    bayes_accuracy : what the noise leaves to be known.

    Examples
    --------
    >>> from uavlab.prediction import median_offsets, simulate_offsets, synthetic_weather
    >>> from uavlab.vehicle import LIGHT_QUADROTOR
    >>> hours = synthetic_weather(10_000, rng=0)
    >>> ratio = simulate_offsets(hours, LIGHT_QUADROTOR, rng=1, noise=0.2) / median_offsets(hours, LIGHT_QUADROTOR)
    >>> f"{(ratio > 1).mean():.1f} of the offsets are above the median, {(ratio > 1.49).mean():.3f} above 1.49 times it"
    '0.5 of the offsets are above the median, 0.022 above 1.49 times it'
    """
    noise = checks.not_negative_number("noise", noise)
    median = median_offsets(weather, uav, **site)
    return median * np.exp(noise * checks.generator("rng", rng).standard_normal(len(median)))


def offset_class(offsets: npt.ArrayLike, class_count: int = 6) -> np.ndarray:
    """Class of an offset: metres, rounded up, from 1 to the last class.

    k = ⌈ξ⌉, from 1 to the number of classes.

    Parameters
    ----------
    offsets : array
        ξ [m], at least 0.
    class_count : int
        At least 2; the last class holds all that is larger.

    Returns
    -------
    array of int
        The shape of `offsets`.

    Raises
    ------
    ValueError
        If `offsets` has a negative value or one that is not finite, or `class_count` is no whole number of at least 2.

    See Also
    --------
    class_probabilities : the chance of each class.

    Examples
    --------
    >>> from uavlab.prediction import offset_class
    >>> offset_class([0.0, 1.0, 1.01, 3.5, 20.0])
    array([1, 1, 2, 4, 6])
    """
    class_count = checks.whole("class_count", class_count, 2)
    checks.not_negative("offsets", offsets)
    return np.clip(np.ceil(np.asarray(offsets, dtype=float)), 1, class_count).astype(int)


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
        If `log_median` is not of shape (N,) or not finite, `noise` is not above 0, or `class_count` is no whole number
        of at least 2.

    See Also
    --------
    offset_class : the class of an offset.
    bayes_accuracy : the mean of the largest ones.

    Examples
    --------
    >>> import numpy as np
    >>> from uavlab.prediction import class_probabilities
    >>> class_probabilities(np.log([1.5, 2.0]), noise=0.21, class_count=4).round(2)
    array([[0.03, 0.89, 0.08, 0.  ],
           [0.  , 0.5 , 0.47, 0.03]])
    """
    class_count = checks.whole("class_count", class_count, 2)
    noise = checks.positive_number("noise", noise)
    middle = checks.array("log_median", np.atleast_1d(checks.numbers("log_median", log_median)), None)
    below = ndtr((np.log(np.arange(1, class_count)) - middle[:, None]) / noise)
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

    Raises
    ------
    ValueError
        If `log_median` is empty, not of shape (N,) or not finite, `noise` is not above 0, or `class_count` is no whole
        number of at least 2.

    See Also
    --------
    class_probabilities : P.
    score : how far a model stays below it.

    Examples
    --------
    >>> import numpy as np
    >>> from uavlab.prediction import bayes_accuracy
    >>> [round(bayes_accuracy(np.log([median]), noise=0.21), 2) for median in (1.5, 2.0)]  # in a class, and between two
    [0.89, 0.5]
    """
    chances = class_probabilities(log_median, noise, class_count)
    if not len(chances):
        raise ValueError("log_median must have at least one value, got none")
    return float(chances.max(axis=1).mean())


def feature_table(weather: Any, names: tuple[str, ...] = FEATURES, argument: str = "features") -> pandas.DataFrame:
    """The named columns of a weather, in order and without gaps, as a table; raises ValueError as `checked_columns`."""
    table = checked_columns(weather, names, argument)
    wrong = missing_values(table)
    if wrong:
        raise ValueError(f"{argument}: {wrong}; leave these rows out, or fill the gaps")
    return table


def checked_columns(weather: Any, names: tuple[str, ...] = FEATURES, argument: str = "features") -> pandas.DataFrame:
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
    if isinstance(weather, type) or not hasattr(weather, "keys"):
        got = type(weather).__name__
        raise ValueError(f"{argument} must be a table with the columns {', '.join(names)}, got {got}")
    table = weather if isinstance(weather, pandas.DataFrame) else table_of(dict(weather), argument)
    columns = list(table.columns)
    missing = [name for name in names if name not in columns]
    if missing:
        others = [str(name) for name in columns if name not in names]
        instead = f"; unknown: {', '.join(others)}" if others else ""
        raise ValueError(f"{argument} must have {', '.join(missing)}{instead}")
    twice = [name for name in names if columns.count(name) > 1]
    if twice:
        raise ValueError(f"{argument} must have {', '.join(twice)} once, and not several times")
    return pandas.DataFrame(
        {name: checks.numbers(f"{argument}: {name}", table[name]) for name in names}, index=table.index
    )


def table_of(columns: dict[str, Any], argument: str) -> pandas.DataFrame:
    """Columns of one length as a table; numbers stand for all rows."""
    one_row = not any(np.ndim(value) for value in columns.values())
    try:
        return require("pandas", "prediction").DataFrame(columns, index=[0] if one_row else None)
    except (TypeError, ValueError) as wrong:
        raise ValueError(f"{argument} must have columns of one length, each of shape (N,): {wrong}") from wrong


def missing_values(table: pandas.DataFrame) -> str:
    """How many rows have a value that is no number, in which columns, and where; empty when there is none."""
    wrong = ~np.isfinite(table.to_numpy(dtype=float))
    rows = table.index[wrong.any(axis=1)]
    if not len(rows):
        return ""
    counts = [f"{count} in {name}" for name, count in zip(table.columns, wrong.sum(axis=0), strict=True) if count]
    shown = ", ".join(map(str, rows[:5])) + (", ..." if len(rows) > 5 else "")
    return f"{len(rows)} of {len(table)} rows have NaN or infinite values: {', '.join(counts)} (rows {shown})"
