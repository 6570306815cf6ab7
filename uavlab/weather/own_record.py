"""The user's own weather: a CSV file with named columns and units becomes states of the weather and features."""

from __future__ import annotations

import csv
import re
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.weather.forces import Weather
from uavlab.weather.records import FEATURES

if TYPE_CHECKING:
    import pandas

SPEEDS = {
    "m/s": 1.0, "ms": 1.0, "m s-1": 1.0, "mps": 1.0,
    "km/h": 1 / 3.6, "kmh": 1 / 3.6, "kph": 1 / 3.6, "km h-1": 1 / 3.6,
    "kn": 1852 / 3600, "kt": 1852 / 3600, "kts": 1852 / 3600, "knots": 1852 / 3600, "mph": 0.44704,
}  # fmt: skip


class Quantity(NamedTuple):
    """A column that a record may have."""

    names: tuple[str, ...]
    units: Mapping[str, float | Callable[[np.ndarray], np.ndarray]]
    """What a value is multiplied with, or goes through, for our unit."""
    low: float
    high: float


QUANTITIES = {
    "temperature_c": Quantity(
        ("air temperature", "temperature", "temp", "t"),
        {
            "°c": 1.0, "c": 1.0, "degc": 1.0, "celsius": 1.0,
            "°f": lambda f: (f - 32) / 1.8, "f": lambda f: (f - 32) / 1.8, "degf": lambda f: (f - 32) / 1.8,
            "fahrenheit": lambda f: (f - 32) / 1.8, "k": lambda k: k - 273.15, "kelvin": lambda k: k - 273.15,
        },
        -60.0, 60.0,
    ),
    "humidity_percent": Quantity(
        ("relative humidity", "humidity", "rh"), {"%": 1.0, "percent": 1.0, "1": 100.0, "fraction": 100.0}, 0.0, 100.0
    ),
    "pressure_hpa": Quantity(
        ("station pressure", "air pressure", "pressure"),
        {"hpa": 1.0, "mbar": 1.0, "mb": 1.0, "pa": 0.01, "kpa": 10.0, "inhg": 33.8639, "mmhg": 1.333224},
        300.0, 1100.0,
    ),
    "wind_speed": Quantity(("mean wind", "wind speed", "windspeed", "wind"), SPEEDS, 0.0, 120.0),
    "gust_speed": Quantity(("wind gust", "gust speed", "gusts", "gust"), SPEEDS, 0.0, 150.0),
    "wind_from_deg": Quantity(
        ("wind direction", "wind from", "winddir", "wind dir", "direction"),
        {"°": 1.0, "deg": 1.0, "degree": 1.0, "degrees": 1.0, "rad": 180 / np.pi}, 0.0, 360.0,
    ),
    "rain_mm_per_h": Quantity(
        ("rain rate", "precipitation rate", "precipitation", "rain"),
        {"mm/h": 1.0, "mm per h": 1.0, "mmh": 1.0, "mm h-1": 1.0, "in/h": 25.4}, 0.0, 500.0,
    ),
    "radiation": Quantity(
        ("global radiation", "solar radiation", "radiation", "ghi", "irradiance"),
        {"w/m²": 1.0, "w/m2": 1.0, "w m-2": 1.0, "wm2": 1.0, "kw/m²": 1000.0, "kw/m2": 1000.0},
        0.0, 1500.0,
    ),
}  # fmt: skip
"""Columns of a record by our names, in our units, and the range that is believed."""

TIMES = ("time", "timestamp", "datetime", "date time", "date", "valid")

GAPS = {"", "-", "--", "na", "n/a", "nan", "null", "none", "missing", "-999", "-999.0", "-9999", "-9999.0"}
"""What stands for a value that is missing."""

LONGER = 1.5
"""Times the usual step: from here on a step between two times is a gap."""


@dataclass(frozen=True, eq=False)
class WeatherRecord:
    """Weather over time, N rows.

    Attributes
    ----------
    columns : mapping of str to (N,) arrays
        temperature_c [°C], humidity_percent [%], pressure_hpa [hPa], wind_speed and gust_speed [m/s], wind_from_deg
        [degrees clockwise from north], rain_mm_per_h [mm/h], radiation [W/m²], as far as the file has them; NaN where a
        value is missing.
    time : (N,) array of datetime64, optional
        UTC, where the file says an offset; else as it stands there.
    gaps : tuple of str
        What is missing, in words.
    ignored : tuple of str
        Columns of the file that aren't weather.
    name : str
        Of the file.

    See Also
    --------
    read_weather : makes one from a CSV file.
    WeatherRecord.weather : one row as a `Weather`.

    Examples
    --------
    >>> import numpy as np
    >>> from uavlab.weather import WeatherRecord
    >>> columns = {"temperature_c": np.array([18.0, 21.0]), "wind_speed": np.array([3.0, 5.5])}
    >>> times = np.array(["2026-03-01T12", "2026-03-01T13"], dtype="datetime64[s]")
    >>> record = WeatherRecord(columns, times, gaps=(), ignored=(), name="roof")
    >>> record
    <WeatherRecord roof: 2 rows of temperature_c, wind_speed>
    >>> record.assumed
    ('humidity_percent', 'pressure_hpa', 'wind_from_deg', 'rain_mm_per_h', 'radiation')
    """

    columns: Mapping[str, np.ndarray]
    time: np.ndarray | None
    gaps: tuple[str, ...]
    ignored: tuple[str, ...]
    name: str

    def __len__(self) -> int:
        return len(next(iter(self.columns.values())))

    def __repr__(self) -> str:
        gaps = f"; {len(self.gaps)} kinds of gaps" if self.gaps else ""
        return f"<WeatherRecord {self.name}: {len(self)} rows of {', '.join(self.columns)}{gaps}>"

    @property
    def assumed(self) -> tuple[str, ...]:
        """What the file doesn't have, so that `weather` takes the defaults of `Weather`."""
        return tuple(name for name in QUANTITIES if name not in self.columns and name != "gust_speed")

    def weather(self, at: int | str | np.datetime64) -> Weather:
        """The weather in a row, or at a time.

        The wind counts as measured, the gust as the strongest of the forecast.

        Parameters
        ----------
        at : int, str or datetime64
            A row from 0, or a time in ISO 8601: the last row that isn't after it.

        Returns
        -------
        Weather
            What the file doesn't have (`assumed`) has the defaults of `Weather`.

        Raises
        ------
        ValueError
            If `at` is no row of the record or no time in it, or the record has no times; if a value is missing there.

        See Also
        --------
        grounded_by : whether a UAV may fly in it.
        WeatherRecord.row : which row it is.

        Examples
        --------
        >>> import numpy as np
        >>> from uavlab.weather import WeatherRecord
        >>> columns = {"temperature_c": np.array([18.0, 21.0]), "wind_speed": np.array([3.0, 5.5])}
        >>> times = np.array(["2026-03-01T12", "2026-03-01T13"], dtype="datetime64[s]")
        >>> record = WeatherRecord(columns, times, gaps=(), ignored=(), name="roof")
        >>> record.weather(1).measured_wind
        5.5
        >>> record.weather("2026-03-01T12:40").measured_wind
        3.0
        """
        row = self.row(at)
        values = {name: float(column[row]) for name, column in self.columns.items()}
        missing = [name for name, value in values.items() if np.isnan(value)]
        if missing:
            raise ValueError(f"at {self.place(row)} the record has no {', '.join(missing)}: take another row")
        wind = {"measured_wind": values.pop("wind_speed", 0.0), "forecast_max_wind": values.pop("gust_speed", 0.0)}
        return Weather(**values, **wind)

    def row(self, at: int | str | np.datetime64) -> int:
        """The number of a row, or of the last one that isn't after a time.

        Parameters
        ----------
        at : int, str or datetime64
            A row from 0, or a time in ISO 8601.

        Returns
        -------
        int
            From 0.

        Raises
        ------
        ValueError
            If `at` is no row of the record, no time in ISO 8601, before the first time or more than a usual step after
            the last, or the record has no times.

        See Also
        --------
        WeatherRecord.weather : the weather in that row.

        Examples
        --------
        >>> import numpy as np
        >>> from uavlab.weather import WeatherRecord
        >>> times = np.array(["2026-03-01T12", "2026-03-01T13"], dtype="datetime64[s]")
        >>> record = WeatherRecord({"wind_speed": np.array([3.0, 5.5])}, times, gaps=(), ignored=(), name="roof")
        >>> record.row("2026-03-01T12:40")
        0
        """
        if isinstance(at, int | np.integer) and not isinstance(at, bool):
            if not 0 <= at < len(self):
                raise ValueError(f"at must be a row from 0 to {len(self) - 1}, got {at}")
            return int(at)
        if self.time is None:
            raise ValueError(f"at must be a row, for the record has no times, got {at!r}")
        when = parsed_time(str(at), "at")
        row = int(np.searchsorted(self.time, when, side="right")) - 1
        if row < 0 or when > self.time[-1] + usual_step(self.time):
            raise ValueError(f"at must be from {self.time[0]} to {self.time[-1]}, got {when}")
        return row

    def place(self, row: int) -> str:
        """A row in words.

        Parameters
        ----------
        row : int
            From 0.

        Returns
        -------
        str
            With its time, if the record has times.

        Raises
        ------
        ValueError
            If `row` is no row of the record.

        See Also
        --------
        WeatherRecord.row : the number of a row.

        Examples
        --------
        >>> import numpy as np
        >>> from uavlab.weather import WeatherRecord
        >>> times = np.array(["2026-03-01T12", "2026-03-01T13"], dtype="datetime64[s]")
        >>> record = WeatherRecord({"wind_speed": np.array([3.0, 5.5])}, times, gaps=(), ignored=(), name="roof")
        >>> record.place(1)
        'row 1 (2026-03-01T13:00:00)'
        """
        if checks.whole("row", row, 0) >= len(self):
            raise ValueError(f"row must be a row from 0 to {len(self) - 1}, got {row}")
        return f"row {row}" if self.time is None else f"row {row} ({self.time[row]})"

    @property
    def features(self) -> pandas.DataFrame:
        """The six features of `uavlab.prediction`, of the rows that have them all.

        Raises
        ------
        ValueError
            If the file lacks one of the columns.
        """
        from uavlab.requirements import require

        lacking = [name for name in FEATURES.values() if name not in self.columns]
        if lacking:
            raise ValueError(f"features need {', '.join(lacking)}, which {self.name} doesn't have")
        frame = require("pandas", "prediction").DataFrame({name: self.columns[name] for name in FEATURES.values()})
        return frame.dropna().rename_axis("row")


def read_weather(path: str | Path) -> WeatherRecord:
    r"""Read a record of the weather from a CSV file.

    The first row names the columns, each with its unit: "temperature [°F]", "wind speed (km/h)", "pressure_hpa".
    °F, K, km/h, knots, mph, Pa, kPa, inHg and others are converted. Names and units may be in small or capital letters;
    commas, semicolons and tabs separate; with semicolons a decimal comma is understood; lines that begin with # are
    left out. A column "time" (or "date" and "time") is in ISO 8601. Empty cells, "NA", "-", −999 and −9999 are gaps,
    except that a calm needs no direction.

    Parameters
    ----------
    path : str or Path
        The CSV file, in UTF-8 or else Latin-1.

    Returns
    -------
    WeatherRecord
        A warning says what is missing, and what isn't weather.

    Raises
    ------
    ValueError
        If `path` is no name of a file; if the file has no row or no known column, a column has no unit or an unknown
        one, or appears twice; if a value is no number or not to be believed, or times aren't in order. The message says
        which row and column.
    OSError
        If the file at `path` can't be read.

    See Also
    --------
    WeatherRecord.weather : a row as a `Weather`.
    WeatherRecord.features : its rows for `uavlab.prediction`.
    greensboro_weather : a year that comes with pvlib.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> from uavlab.weather import read_weather
    >>> with TemporaryDirectory() as folder:
    ...     path = Path(folder, "station.csv")
    ...     _ = path.write_text("temperature [°F];wind speed (km/h)\n59;18\n68;36\n", encoding="utf-8")
    ...     record = read_weather(path)
    >>> record
    <WeatherRecord station.csv: 2 rows of temperature_c, wind_speed>
    >>> record.columns["wind_speed"].round(1)
    array([ 5., 10.])
    """
    path = checks.path("path", path)
    header, rows = table_of(path)
    known, times, ignored = columns_of(header, path.name)
    if not known:
        raise ValueError(
            f"{path.name} has no column of weather among {', '.join(map(repr, header))}; known are "
            + ", ".join(repr(f"{quantity.names[0]} [{next(iter(quantity.units))}]") for quantity in QUANTITIES.values())
        )
    time = times_of(rows, times) if times else None
    columns = {name: values_of(rows, at, name, unit) for name, (at, unit) in known.items()}
    if "wind_speed" in columns and "wind_from_deg" in columns:
        calm = (columns["wind_speed"] == 0) & np.isnan(columns["wind_from_deg"])
        columns["wind_from_deg"] = np.where(calm, 0.0, columns["wind_from_deg"])
    gaps = gaps_of(columns, time)
    record = WeatherRecord(columns, time, gaps, tuple(ignored), path.name)
    said = [*gaps, *([f"not weather: {', '.join(ignored)}"] if ignored else [])]
    if said:
        warnings.warn(f"{path.name}: {'; '.join(said)}", UserWarning, stacklevel=2)
    return record


def mean_wind(samples: npt.ArrayLike, interval: float, averaging_time: float = 60.0) -> np.ndarray:
    """Mean of the wind that was measured last, V_μS over the time t_w (REPARE Eq. 3).

    V_μS = Σ V/n over the last n = t_w/interval samples.

    Parameters
    ----------
    samples : (N,) or (N, D) array
        Speeds, or vectors, D = 2 or 3 [m/s], evenly in time, the latest last.
    interval : float
        Between two samples [s], above 0.
    averaging_time : float
        t_w [s], above 0; the paper gives no number. Weather services take 600 s, a UAV has less time.

    Returns
    -------
    () or (D,) array
        [m/s]; the length of a mean vector is less than the mean speed, where the direction changes.

    Raises
    ------
    ValueError
        If `samples` has another shape, is not finite, has a negative speed or doesn't cover `averaging_time`, or if
        `interval` or `averaging_time` is not above 0.

    See Also
    --------
    reference_wind : takes it beside the forecast.

    Examples
    --------
    >>> import numpy as np
    >>> from uavlab.weather import mean_wind
    >>> speeds = np.concatenate([np.full(60, 4.0), np.full(60, 7.0)])  # one a second, the wind freshens
    >>> [float(mean_wind(speeds, 1.0, averaging_time=time)) for time in (30.0, 90.0, 120.0)]
    [7.0, 6.0, 5.5]
    """
    winds = checks.numbers("samples", samples)
    if winds.ndim not in (1, 2) or (winds.ndim == 2 and winds.shape[1] not in (2, 3)):
        raise ValueError(f"samples must have shape (N,), (N, 2) or (N, 3), got {winds.shape}")
    checks.finite("samples", winds)
    if winds.ndim == 1:
        checks.not_negative("samples", winds)
    interval = checks.positive_number("interval", interval)
    averaging_time = checks.positive_number("averaging_time", averaging_time)
    count = max(round(averaging_time / interval), 1)
    if len(winds) < count:
        raise ValueError(
            f"samples must cover averaging_time = {averaging_time:g} s, which are {count} of them, got {len(winds)}"
        )
    return winds[-count:].mean(axis=0)


def table_of(path: Path) -> tuple[list[str], list[list[str]]]:
    """The names of the columns, and the rows, as text."""
    raw = path.read_bytes()
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = raw.decode("latin-1")
    lines = [line for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#")]
    if len(lines) < 2:
        raise ValueError(f"{path.name} must have a row of names and at least one of values, got {len(lines)} rows")
    separator = max(";\t,", key=lines[0].count)
    rows = [[cell.strip() for cell in row] for row in csv.reader(lines, delimiter=separator)]
    for number, row in enumerate(rows[1:]):
        if len(row) != len(rows[0]):
            raise ValueError(f"row {number} of {path.name} must have {len(rows[0])} cells as its names, got {len(row)}")
    if separator == ";":
        rows[1:] = [[cell.replace(",", ".") for cell in row] for row in rows[1:]]
    return rows[0], rows[1:]


def columns_of(header: Sequence[str], file: str) -> tuple[dict[str, tuple[int, str]], list[int], list[str]]:
    """Which columns are weather, (number, unit) by our names, which are times, and the names of the others."""
    known: dict[str, tuple[int, str]] = {}
    times, ignored = [], []
    for at, title in enumerate(header):
        plain = re.sub(r"[_\s]+", " ", title.lower()).strip()
        if plain in TIMES:
            times.append(at)
            continue
        name, unit = meaning(plain, title)
        if not name:
            ignored.append(title)
            continue
        if name in known:
            raise ValueError(f"{file} has two columns of {name}, {header[known[name][0]]!r} and {title!r}: keep one")
        known[name] = at, unit
    return known, times, ignored


def meaning(plain: str, title: str) -> tuple[str, str]:
    """Our name of a column and its unit; no name, if it isn't weather."""
    for name, quantity in QUANTITIES.items():
        if plain == name.replace("_", " "):
            return name, next(iter(quantity.units))
    bracketed = re.fullmatch(r"(.*?)\s*[\[(]\s*([^\])]*?)\s*[\])]", plain)
    for name, quantity in QUANTITIES.items():
        for alias in quantity.names:
            if bracketed and bracketed[1].strip() == alias:
                unit = bracketed[2]
            elif not bracketed and (plain == alias or plain.startswith(alias + " ")):
                unit = plain[len(alias) :].strip()
            else:
                continue
            if unit in quantity.units:
                return name, unit
            if bracketed or not unit:
                known = ", ".join(quantity.units)
                raise ValueError(
                    f"column {title!r} needs a unit that is known, as in '{title.split('[')[0].split('(')[0].strip()} "
                    f"[{next(iter(quantity.units))}]'; of {name} these are {known}"
                )
    return "", ""


def values_of(rows: Sequence[Sequence[str]], at: int, name: str, unit: str) -> np.ndarray:
    """A column in our unit, (N,), NaN where it has a gap."""
    values = np.empty(len(rows))
    for number, row in enumerate(rows):
        cell = row[at]
        try:
            values[number] = np.nan if cell.lower() in GAPS else float(cell)
        except ValueError:
            raise ValueError(f"{name} in row {number} must be a number or empty, got {cell!r}") from None
    convert = QUANTITIES[name].units[unit]
    values = convert(values) if callable(convert) else values * convert
    low, high = QUANTITIES[name].low, QUANTITIES[name].high
    wrong = np.flatnonzero(~np.isnan(values) & ~((values >= low) & (values <= high)))
    if len(wrong):
        raise ValueError(
            f"{name} in row {wrong[0]} must be from {low:g} to {high:g}, got {values[wrong[0]]:g} "
            f"({rows[wrong[0]][at]} {unit}): is the unit right?"
        )
    values.setflags(write=False)
    return values


def times_of(rows: Sequence[Sequence[str]], at: Sequence[int]) -> np.ndarray:
    """Times of the rows, (N,) datetime64, in order."""
    texts = ["T".join(row[column] for column in at) for row in rows]
    times = np.array([parsed_time(text, f"time in row {number}") for number, text in enumerate(texts)])
    back = np.flatnonzero(np.diff(times) <= np.timedelta64(0, "s"))
    if len(back):
        raise ValueError(f"time in row {back[0] + 1} must be after the one before, got {times[back[0] + 1]}: sort rows")
    times.setflags(write=False)
    return times


def parsed_time(text: str, argument: str) -> np.datetime64:
    """A time in ISO 8601, to the second; UTC where it has an offset."""
    try:
        moment = datetime.fromisoformat(text)
    except ValueError:
        raise ValueError(f"{argument} must be in ISO 8601, as 2026-03-01T14:00, got {text!r}") from None
    if moment.tzinfo is not None:
        moment = moment.astimezone(UTC).replace(tzinfo=None)
    return np.datetime64(moment, "s")


def usual_step(time: np.ndarray) -> Any:
    """The step between times that is usual: their median, the lower one of two."""
    return np.sort(np.diff(time))[(len(time) - 2) // 2] if len(time) > 1 else np.timedelta64(0, "s")


def gaps_of(columns: Mapping[str, np.ndarray], time: np.ndarray | None) -> tuple[str, ...]:
    """What is missing, in words."""
    said = []
    for name, values in columns.items():
        missing = np.flatnonzero(np.isnan(values))
        if len(missing):
            said.append(f"{name} is missing in {len(missing)} of {len(values)} rows, first in row {missing[0]}")
    if time is not None and len(time) > 2:
        steps, usual = np.diff(time), usual_step(time)
        long = np.flatnonzero(steps > LONGER * usual)
        if len(long):
            said.append(
                f"{len(long)} gaps in time, the first after {time[long[0]]}: {steps[long[0]]} instead of {usual}"
            )
    return tuple(said)
