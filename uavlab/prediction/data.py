"""From the weather to how far gusts push: a physical generator of offsets, and tables to learn from.

REPARE's flight data (section 2.2.3) are not published, so nobody has offsets that were measured. Every offset here is
drawn by `simulate_offsets`; only the weather may be real. What is drawn is known: the chance of each class, and with it
the best accuracy that any model can reach.

An offset ξ [m] is what the strongest gust of a flight reaches. Its class is the offset rounded up.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
from scipy.special import ndtr

from uavlab import checks
from uavlab.prediction.requirements import require
from uavlab.vehicle import LIGHT_QUADROTOR, UAV
from uavlab.weather import Weather, air_density, greensboro_weather

if TYPE_CHECKING:
    import pandas

FEATURES = ("temperature_c", "humidity_percent", "pressure_hpa", "wind_speed", "wind_from_deg", "radiation")
"""The paper's six: [°C], [%], [hPa], [m/s], [degrees], [W/m²]."""

SAMPLES, TRAINING_SAMPLES = 7330, 5864
"""Of REPARE: the other 1 466 are for the test."""


def checked_class_count(class_count: int) -> None:
    if not (isinstance(class_count, int | np.integer) and class_count >= 2):
        raise ValueError(f"class_count must be a whole number of at least 2, got {class_count!r}")


@dataclass(frozen=True)
class Setting:
    """Where offsets to learn from come from.

    Attributes
    ----------
    channelling : float
        How much stronger the wind is along the streets than its mean over all directions, and how much weaker across
        them, as a share; 0 (no street) to below 1.
    noise : float
        Spread s of the logarithm of the offset in one and the same weather; 0.1 to 0.4.
    class_count : int
        Classes 1, 2, ... of 1 m; the last one holds all that is larger.
    wind_scale, wind_shape : float
        Of the synthetic wind's Weibull distribution [m/s] and [-]: a shape of 2 is usual weather, 8 a steady wind.
    real_weather : bool
        Take the hours of `greensboro_weather` for the features.

    Raises
    ------
    ValueError
        If a number is out of its range.
    """

    channelling: float = 0.38
    noise: float = 0.21
    class_count: int = 6
    wind_scale: float = 4.0
    wind_shape: float = 2.0
    real_weather: bool = False

    def __post_init__(self) -> None:
        checks.positive("noise", self.noise)
        checks.positive("wind_scale", self.wind_scale)
        checks.positive("wind_shape", self.wind_shape)
        if not 0 <= self.channelling < 1:
            raise ValueError(f"channelling must be from 0 to below 1, got {self.channelling!r}")
        checked_class_count(self.class_count)


SETTINGS: Mapping[str, Setting] = {
    "paper": Setting(),
    "steady wind": Setting(channelling=0.8, noise=0.3, class_count=4, wind_scale=2.8, wind_shape=9.0),
    "greensboro": Setting(real_weather=True),
}
""""paper": GaussianNB and XGBoost do about as well as in REPARE. "steady wind": Ridge's R² is at the same time about as
low as the figure that REPARE prints for it. "greensboro": as "paper", with real weather."""


@dataclass(frozen=True, eq=False)
class Dataset:
    """Weather, offsets that belong to it, and what the generator knows of them; N rows.

    Attributes
    ----------
    features : pandas.DataFrame
        (N, 6), the columns `FEATURES`.
    offsets : (N,) array
        ξ [m].
    classes : (N,) array of int
        1 to `class_count`.
    log_median : (N,) array
        Logarithm of the median offset in this weather, before any noise [log m].
    noise : float
        Spread s of the logarithm of the offset about it.
    class_count : int
    train : (N,) array of bool
        Rows to learn from; the others are for the test.
    setting : Setting
    """

    features: "pandas.DataFrame"
    offsets: np.ndarray
    classes: np.ndarray
    log_median: np.ndarray
    noise: float
    class_count: int
    train: np.ndarray
    setting: Setting

    @property
    def test(self) -> np.ndarray:
        """Rows for the test, (N,) bool."""
        return ~self.train


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

    ξ = ξ₀ + 8.5 m · F / F_reserve with the drag F = ½ ρ C S V² (REPARE Eq. 5) of the gust
    V = V_station · height factor · [1 + channelling · cos 2(wind direction − street)] · (1 + peak factor · I), the
    turbulence intensity I = I_m + I_c · (radiation / 1000 W/m²) / (1 + V_station/V_c), which the sun raises most when
    the wind is light, ρ of moist air, and F_reserve the thrust that the weight leaves sideways.

    Parameters
    ----------
    weather : pandas.DataFrame, mapping of arrays or Weather
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
        Offset when the drag eats the whole reserve [m]; 8.5 gives the distances of REPARE Table 4.
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
    weather : pandas.DataFrame, mapping of arrays or Weather
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
    return median * np.exp(noise * np.random.default_rng(rng).standard_normal(len(median)))


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
    checked_class_count(class_count)
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
        If the noise or the number of classes is out of its range.
    """
    checked_class_count(class_count)
    checks.positive("noise", noise)
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


def synthetic_weather(
    count: int, rng: np.random.Generator | int, *, wind_scale: float = 4.0, wind_shape: float = 2.0
) -> "pandas.DataFrame":
    """Hours of a made-up year at 40° north: seasons, days, clouds, wind from everywhere.

    Parameters
    ----------
    count : int
        Hours, drawn independently.
    rng : numpy.random.Generator or int
    wind_scale, wind_shape : float
        Of the wind's Weibull distribution [m/s] and [-], above 0.

    Returns
    -------
    pandas.DataFrame
        (count, 6), the columns `FEATURES`.
    """
    rng = np.random.default_rng(rng)
    day, hour = rng.uniform(0, 365, count), rng.uniform(0, 24, count)
    season, warmth = np.cos(2 * np.pi * (day - 200) / 365), np.cos(2 * np.pi * (hour - 15) / 24)
    latitude, declination = np.radians(40.0), np.radians(23.44) * np.cos(2 * np.pi * (day - 172) / 365)
    sun = np.sin(latitude) * np.sin(declination) - np.cos(latitude) * np.cos(declination) * np.cos(np.pi * hour / 12)
    clear = rng.beta(4, 2, count)
    temperature = 13 + 13 * season + 4 * warmth + rng.normal(0, 3, count)
    humidity = np.clip(60 - 12 * warmth - 30 * (clear - 0.66) + rng.normal(0, 13, count), 8, 100)
    pressure = 1015 - 0.5 * (temperature - 13) + rng.normal(0, 6, count)
    columns = (
        temperature,
        humidity,
        pressure,
        wind_scale * rng.weibull(wind_shape, count),
        rng.uniform(0, 360, count),
        1050 * np.maximum(sun, 0) * clear,
    )
    return require("pandas").DataFrame(dict(zip(FEATURES, columns, strict=True)))


def make_dataset(
    setting: str | Setting = "paper",
    rng: np.random.Generator | int = 0,
    *,
    uav: UAV = LIGHT_QUADROTOR,
    count: int = SAMPLES,
    train_count: int = TRAINING_SAMPLES,
) -> Dataset:
    """A table to learn from, split at random as REPARE splits its own (section 2.2.3).

    The offsets are always simulated, with real weather as well.

    Parameters
    ----------
    setting : str or Setting
        "paper", "steady wind" or "greensboro" of `SETTINGS`, or one of your own.
    rng : numpy.random.Generator or int
    uav : UAV
    count, train_count : int
        Rows in all, and those to learn from; with real weather at most 8 760 different hours.

    Returns
    -------
    Dataset

    Raises
    ------
    ValueError
        If the setting is unknown, or there are not that many hours or rows.
    """
    if isinstance(setting, str):
        if setting not in SETTINGS:
            raise ValueError(f"setting must be one of {', '.join(map(repr, SETTINGS))}, got {setting!r}")
        setting = SETTINGS[setting]
    if not 0 < train_count < count:
        raise ValueError(f"train_count must be from 1 to count - 1 = {count - 1}, got {train_count!r}")
    rng = np.random.default_rng(rng)
    if setting.real_weather:
        hours = greensboro_weather()
        if count > len(hours):
            raise ValueError(f"count must be at most {len(hours)}, the hours of the record, got {count!r}")
        chosen = rng.choice(len(hours), count, replace=False)
        features = hours[list(FEATURES)].iloc[chosen].reset_index(drop=True)
    else:
        features = synthetic_weather(count, rng, wind_scale=setting.wind_scale, wind_shape=setting.wind_shape)
    median = median_offsets(features, uav, channelling=setting.channelling)
    offsets = simulate_offsets(features, uav, rng, noise=setting.noise, channelling=setting.channelling)
    train = np.zeros(count, dtype=bool)
    train[rng.permutation(count)[:train_count]] = True
    classes = offset_class(offsets, setting.class_count)
    return Dataset(features, offsets, classes, np.log(median), setting.noise, setting.class_count, train, setting)


def feature_table(weather: Any, names: tuple[str, ...] = FEATURES) -> "pandas.DataFrame":
    """The named columns of a weather, in order and without gaps, as a table; raises ValueError as `checked_columns`."""
    table = checked_columns(weather, names)
    wrong = missing_values(table)
    if wrong:
        raise ValueError(f"{wrong}; leave these rows out, or fill the gaps")
    return table


def checked_columns(weather: Any, names: tuple[str, ...] = FEATURES) -> "pandas.DataFrame":
    """The named columns in this order; a ValueError lists those that are missing, and what there is instead."""
    pandas = require("pandas")
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
    table = weather if isinstance(weather, pandas.DataFrame) else pandas.DataFrame(dict(weather))
    missing = [name for name in names if name not in table.columns]
    if missing:
        others = [str(name) for name in table.columns if name not in names]
        instead = f"; unknown: {', '.join(others)}" if others else ""
        raise ValueError(f"features lack {', '.join(missing)}{instead}")
    return table[list(names)].astype(float)


def missing_values(table: "pandas.DataFrame") -> str:
    """How many rows have a value that is no number, in which columns, and where; empty when there is none."""
    wrong = ~np.isfinite(table.to_numpy(dtype=float))
    rows = table.index[wrong.any(axis=1)]
    if not len(rows):
        return ""
    counts = [f"{count} in {name}" for name, count in zip(table.columns, wrong.sum(axis=0), strict=True) if count]
    shown = ", ".join(map(str, rows[:5])) + (", ..." if len(rows) > 5 else "")
    return f"{len(rows)} of {len(table)} rows have NaN or infinite values: {', '.join(counts)} (rows {shown})"
