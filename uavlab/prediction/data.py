"""Tables to learn from: simulated offsets in synthetic or real weather, split as REPARE splits its own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from uavlab import checks
from uavlab.prediction.generator import FEATURES, checked_channelling, median_offsets, offset_class, simulate_offsets
from uavlab.requirements import require
from uavlab.vehicle import LIGHT_QUADROTOR, UAV
from uavlab.weather import greensboro_weather

if TYPE_CHECKING:
    import pandas

SAMPLES, TRAINING_SAMPLES = 7330, 5864
"""Of REPARE: the other 1 466 are for the test."""


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
        If `noise`, `wind_scale` or `wind_shape` is not above 0, `channelling` is not from 0 to below 1, `class_count`
        is no whole number of at least 2, or `real_weather` is not True or False.

    See Also
    --------
    make_dataset : draws a table in it.

    Examples
    --------
    >>> from uavlab.prediction import SETTINGS, Setting, make_dataset
    >>> Setting(noise=0.1).noise < SETTINGS["paper"].noise
    True
    >>> make_dataset(Setting(noise=0.1, class_count=4), count=100, train_count=80)
    <Dataset: 100 rows in 4 classes, 80 of them to learn from>
    """

    channelling: float = 0.38
    noise: float = 0.21
    class_count: int = 6
    wind_scale: float = 4.0
    wind_shape: float = 2.0
    real_weather: bool = False

    def __post_init__(self) -> None:
        checks.set_fields(self, checks.positive_number, "noise", "wind_scale", "wind_shape")
        object.__setattr__(self, "channelling", checked_channelling(self.channelling))
        checks.set_fields(self, checks.whole, "class_count", least=2)
        checks.set_fields(self, checks.flag, "real_weather")


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
        Classes of 1 m.
    train : (N,) array of bool
        Rows to learn from; the others are for the test.
    setting : Setting
        Where it comes from.

    See Also
    --------
    make_dataset : makes one.
    score : how good a prediction for the rows of its test is.

    Examples
    --------
    >>> from uavlab.prediction import make_dataset
    >>> data = make_dataset(count=100, train_count=80)
    >>> data
    <Dataset: 100 rows in 6 classes, 80 of them to learn from>
    >>> data.features.shape, data.classes.shape
    ((100, 6), (100,))
    >>> int(data.test.sum())
    20
    """

    features: pandas.DataFrame
    offsets: np.ndarray
    classes: np.ndarray
    log_median: np.ndarray
    noise: float
    class_count: int
    train: np.ndarray
    setting: Setting

    def __repr__(self) -> str:
        return (
            f"<Dataset: {len(self.train)} rows in {self.class_count} classes, {self.train.sum()} of them to learn from>"
        )

    @property
    def test(self) -> np.ndarray:
        """Rows for the test, (N,) bool."""
        return ~self.train


def synthetic_weather(
    count: int, rng: np.random.Generator | int, *, wind_scale: float = 4.0, wind_shape: float = 2.0
) -> pandas.DataFrame:
    """Hours of a made-up year at 40° north: seasons, days, clouds, wind from everywhere.

    Parameters
    ----------
    count : int
        Hours, drawn independently; at least 0.
    rng : numpy.random.Generator or int
        Or a seed.
    wind_scale, wind_shape : float
        Of the wind's Weibull distribution [m/s] and [-], above 0.

    Returns
    -------
    pandas.DataFrame
        (count, 6), the columns `FEATURES`.

    Raises
    ------
    ValueError
        If `count` is no whole number of at least 0, `wind_scale` or `wind_shape` is not above 0, or `rng` is neither a
        generator nor a seed.

    See Also
    --------
    uavlab.weather.greensboro_weather : real hours with the same columns.
    median_offsets : the offsets that belong to it.

    Examples
    --------
    >>> from uavlab.prediction import synthetic_weather
    >>> hours = synthetic_weather(10_000, rng=0, wind_scale=4.0)
    >>> mean, strong = hours.wind_speed.mean(), hours.wind_speed.quantile(0.99)
    >>> f"wind of {mean:.1f} m/s on average, above {strong:.0f} m/s in one hour of 100"
    'wind of 3.5 m/s on average, above 9 m/s in one hour of 100'
    """
    count = checks.whole("count", count, 0)
    wind_scale = checks.positive_number("wind_scale", wind_scale)
    wind_shape = checks.positive_number("wind_shape", wind_shape)
    rng = checks.generator("rng", rng)
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
    return require("pandas", "prediction").DataFrame(dict(zip(FEATURES, columns, strict=True)))


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
        Or a seed.
    uav : UAV
        Whose offsets they are.
    count, train_count : int
        Rows in all, and those to learn from; with real weather at most 8 760 different hours.

    Returns
    -------
    Dataset
        Features, offsets and classes of `count` rows.

    Raises
    ------
    ValueError
        If `setting` is unknown, `uav` is no UAV, `count` is no whole number of at least 2 or above the hours of real
        weather, `train_count` is not from 1 to `count` − 1, or `rng` is neither a generator nor a seed.

    See Also
    --------
    compare_models : trains models on such tables.
    OffsetPredictor : learns from one.

    Examples
    --------
    >>> from uavlab.prediction import make_dataset
    >>> data = make_dataset("paper", rng=0)
    >>> data
    <Dataset: 7330 rows in 6 classes, 5864 of them to learn from>
    >>> f"{(data.classes == 1).mean():.0%} of the flights stay within 1 m"
    '42% of the flights stay within 1 m'
    """
    setting = known_setting(setting)
    checks.instance("uav", uav, UAV)
    count, train_count = checks.whole("count", count, 2), checks.whole("train_count", train_count, 1)
    if train_count >= count:
        raise ValueError(f"train_count must be from 1 to count - 1 = {count - 1}, got {train_count!r}")
    rng = checks.generator("rng", rng)
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


def known_setting(setting: str | Setting) -> Setting:
    """A setting, or the one of this name."""
    if isinstance(setting, str):
        return SETTINGS[checks.one_of("setting", setting, SETTINGS)]
    checks.instance("setting", setting, Setting)
    return setting
