"""The user's own record: names, units, gaps and times of CSV files, and what of them is refused."""

import re

import numpy as np
import pytest

from uavlab.prediction.generator import median_offsets
from uavlab.vehicle import LIGHT_QUADROTOR
from uavlab.weather import Weather, greensboro_weather, mean_wind, read_weather, reference_wind
from uavlab.weather.own_record import QUANTITIES

AMERICAN = """# station KGSO
Date,Time,Temp [°F],Relative humidity (%),Pressure [inHg],Wind speed [mph],Wind gust (kn),Wind direction [°],Note
2026-03-01,13:00,50,40,29.92,10,20,270,fair
2026-03-01,14:00,59,45,29.90,0,0,,calm
2026-03-01,17:00,NA,50,29.80,12,-,200,
"""

METRIC = (
    "time;temperature_c;humidity_percent;pressure_hpa;wind_speed_kmh;wind_from_deg;rain rate [mm/h];GHI [W/m²]\n"
    + ("2026-03-01T13:00+01:00;12,5;60;1013,2;36;180;2,5;500\n2026-03-01T13:10+01:00;12,6;61;1013,1;18;190;0;510\n")
)


def written(tmp_path, text, name="weather.csv", encoding="utf-8"):
    path = tmp_path / name
    path.write_bytes(text.encode(encoding))
    return path


def test_an_american_record_is_converted_and_its_gaps_are_said(tmp_path):
    with pytest.warns(
        UserWarning, match=r"weather\.csv: temperature_c is missing in 1 of 3 rows, first in row 2; gust_s"
    ):
        record = read_weather(written(tmp_path, AMERICAN))
    assert len(record) == 3
    assert record.columns["temperature_c"] == pytest.approx([10, 15, np.nan], nan_ok=True)
    assert record.columns["pressure_hpa"] == pytest.approx([1013.2, 1012.5, 1009.1], abs=0.1)
    assert record.columns["wind_speed"] == pytest.approx([4.4704, 0, 5.36448])
    assert record.columns["gust_speed"] == pytest.approx([10.289, 0, np.nan], abs=1e-3, nan_ok=True)
    assert record.columns["wind_from_deg"].tolist() == [270, 0, 200]  # a calm has no direction
    assert record.time.astype(str).tolist() == ["2026-03-01T13:00:00", "2026-03-01T14:00:00", "2026-03-01T17:00:00"]
    assert record.ignored == ("Note",)
    assert record.assumed == ("rain_mm_per_h", "radiation")
    assert any("1 gaps in time, the first after 2026-03-01T14:00:00" in gap for gap in record.gaps)
    assert repr(record).startswith("<WeatherRecord weather.csv: 3 rows of temperature_c, humidity_percent, ")
    weather = record.weather(0)
    assert isinstance(weather, Weather)
    assert weather.reference_wind == reference_wind(0.0, 10 * 0.44704, 20 * 1852 / 3600)
    assert weather.wind_from_deg == 270
    assert record.weather("2026-03-01T14:30") == record.weather(1)
    assert record.weather(np.datetime64("2026-03-01T14:00")).temperature_c == pytest.approx(15.0)
    with pytest.raises(
        ValueError, match=r"at row 2 \(2026-03-01T17:00:00\) the record has no temperature_c, gust_speed"
    ):
        record.weather(2)
    with pytest.raises(ValueError, match=r"features need radiation, which weather\.csv doesn't have"):
        _ = record.features


def test_a_metric_record_with_decimal_commas_becomes_weather_and_features(tmp_path, recwarn):
    record = read_weather(written(tmp_path, METRIC))
    assert not recwarn.list
    assert record.gaps == record.ignored == ()
    assert record.columns["wind_speed"].tolist() == [10, 5]
    assert record.time[0] == np.datetime64("2026-03-01T12:00:00")  # UTC
    weather = record.weather(0)
    assert (weather.temperature_c, weather.pressure_hpa, weather.rain_mm_per_h) == (12.5, 1013.2, 2.5)
    features = record.features
    assert list(features.columns) == list(greensboro_weather().columns)
    assert features.shape == (2, 6)
    offsets = median_offsets(features, LIGHT_QUADROTOR)
    assert offsets[0] > offsets[1] > 0
    with pytest.raises(ValueError, match="read-only"):
        record.columns["wind_speed"][0] = 1.0


def test_features_are_of_the_rows_that_have_them_all(tmp_path):
    text = METRIC.replace("12,6;61", ";61")
    with pytest.warns(UserWarning, match="temperature_c is missing in 1 of 2 rows"):
        record = read_weather(written(tmp_path, text))
    assert record.features.index.tolist() == [0]


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "latin-1"])
@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_encodings_and_separators_are_understood(tmp_path, encoding, separator):
    text = separator.join(["Temperature (°C)", "WIND [m/s]"]) + "\n" + separator.join(["-3.5", "2"]) + "\n"
    record = read_weather(written(tmp_path, text, encoding=encoding))
    assert record.columns["temperature_c"].tolist() == [-3.5]
    assert record.columns["wind_speed"].tolist() == [2.0]
    assert record.time is None
    assert record.weather(0).measured_wind == 2.0


@pytest.mark.parametrize("name", QUANTITIES)
def test_every_unit_of_every_quantity_is_read_with_and_without_brackets(tmp_path, name):
    quantity = QUANTITIES[name]
    middle = {"temperature_c": 20.0, "pressure_hpa": 1000.0}.get(name, quantity.high / 4)
    for unit, convert in quantity.units.items():
        value = {"°f": 68.0, "f": 68.0, "degf": 68.0, "fahrenheit": 68.0, "k": 293.15, "kelvin": 293.15}.get(unit)
        value = middle / convert if value is None else value
        titles = [f"{alias} [{unit}]" for alias in quantity.names]
        if not unit[0].isdigit():
            titles.append(f"{quantity.names[0]} {unit}".replace(" ", "_"))
        for title in titles:
            record = read_weather(written(tmp_path, f"{title.upper()}\n{value!r}\n"))
            assert record.columns[name] == pytest.approx([middle], rel=1e-9), title


def test_a_row_of_greensboro_written_and_read_is_the_same(tmp_path):
    year = greensboro_weather().head(48)
    record = read_weather(written(tmp_path, year.to_csv(index=False)))
    assert np.array_equal(record.features.to_numpy(), year.to_numpy())


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "temp,wind [m/s]\n3,4\n",
            "column 'temp' needs a unit that is known, as in 'temp [°c]'; of temperature_c these",
        ),
        ("temp [°X],wind [m/s]\n3,4\n", "column 'temp [°X]' needs a unit that is known"),
        ("wind [m/s],wind speed [km/h]\n3,4\n", "two columns of wind_speed, 'wind [m/s]' and 'wind speed [km/h]'"),
        ("wind [m/s]\nstrong\n", "wind_speed in row 0 must be a number or empty, got 'strong'"),
        ("wind [m/s]\n3\n-4\n", "wind_speed in row 1 must be from 0 to 120, got -4"),
        ("pressure [hPa]\n101325\n", "pressure_hpa in row 0 must be from 300 to 1100, got 101325 (101325 hpa): is the"),
        ("temp [°C]\n295\n", "temperature_c in row 0 must be from -60 to 60, got 295"),
        ("wind [m/s],temp [°C]\n3\n", "row 0 of weather.csv must have 2 cells as its names, got 1"),
        ("wind [m/s]\n", "must have a row of names and at least one of values, got 1 rows"),
        ("", "must have a row of names and at least one of values, got 0 rows"),
        (
            "a,b\n1,2\n",
            "has no column of weather among 'a', 'b'; known are 'air temperature [°c]', 'relative humidity [%]'",
        ),
        ("time,wind [m/s]\n01.03.2026,3\n", "time in row 0 must be in ISO 8601, as 2026-03-01T14:00, got '01.03.2026'"),
        ("time,wind [m/s]\n2026-03-02,3\n2026-03-01,3\n", "time in row 1 must be after the one before, got 2026-03-01"),
        ("time,wind [m/s]\n2026-03-02,3\n2026-03-02,3\n", "time in row 1 must be after the one before"),
    ],
)
def test_what_is_wrong_is_said_with_row_and_column(tmp_path, text, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        read_weather(written(tmp_path, text))


def test_rows_and_times_that_are_not_there_are_refused(tmp_path):
    record = read_weather(written(tmp_path, METRIC))
    for at, message in (
        (2, "at must be a row from 0 to 1, got 2"),
        (-1, "at must be a row from 0 to 1, got -1"),
        ("2026-03-01T11:59", "at must be from 2026-03-01T12:00:00 to 2026-03-01T12:10:00, got 2026-03-01T11:59:00"),
        ("2026-03-01T13:00", "at must be from"),
        ("noon", "at must be in ISO 8601"),
    ):
        with pytest.raises(ValueError, match=re.escape(message)):
            record.weather(at)
    assert record.weather("2026-03-01T12:15") == record.weather(1)
    timeless = read_weather(written(tmp_path, "wind [m/s]\n3\n"))
    with pytest.raises(ValueError, match="at must be a row, for the record has no times"):
        timeless.weather("2026-03-01T12:15")
    with pytest.raises(FileNotFoundError):
        read_weather(tmp_path / "nowhere.csv")


def test_the_wind_of_eq_3_is_the_mean_of_the_last_samples():
    speeds = np.concatenate([np.full(100, 9.0), np.tile([3.0, 5.0], 30)])
    assert mean_wind(speeds, 1.0) == pytest.approx(4.0)
    assert mean_wind(speeds, 1.0, 120.0) == pytest.approx((60 * 9 + 60 * 4) / 120)
    assert mean_wind(speeds, 0.5, 30.0) == pytest.approx(4.0)
    turning = np.array([(3.0, 0.0), (0.0, 3.0)] * 30)
    assert mean_wind(turning, 1.0) == pytest.approx([1.5, 1.5])
    assert Weather(forecast_wind=3.0, measured_wind=float(mean_wind(speeds, 1.0))).reference_wind.mean == 4.0
    for wrong, message in (
        ((speeds, 0.0), "interval must be finite and above 0"),
        ((speeds, 1.0, 0.0), "averaging_time must be finite and above 0"),
        ((speeds, 1.0, 161.0), "samples must cover averaging_time = 161 s, which are 161 of them, got 160"),
        ((-speeds, 1.0), "samples must be finite and at least 0"),
        ((np.zeros((3, 4)), 1.0), r"samples must have shape \(N,\), \(N, 2\) or \(N, 3\)"),
        ((np.full(60, np.nan), 1.0), "samples must be finite"),
    ):
        with pytest.raises(ValueError, match=message):
            mean_wind(*wrong)
