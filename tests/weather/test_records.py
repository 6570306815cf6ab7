"""A year of Greensboro: complete, in the right units, in the right order."""

import subprocess
import sys
from importlib.resources import files

import numpy as np
import pvlib
import pytest

from uavlab.weather import air_density, greensboro_weather
from uavlab.weather.records import FEATURES


@pytest.fixture(scope="module")
def year():
    return greensboro_weather()


def test_every_hour_has_exactly_the_six_features(year):
    assert year.shape == (8760, 6)
    assert list(year.columns) == list(FEATURES.values())
    assert list(year.columns) == [
        "temperature_c", "humidity_percent", "pressure_hpa", "wind_speed", "wind_from_deg", "radiation",
    ]  # fmt: skip
    assert np.isfinite(year.to_numpy()).all()
    assert year.index.tolist() == list(range(8760))
    assert year.index.name == "hour"


def test_values_are_in_the_units_that_the_names_say(year):
    assert year.temperature_c.between(-20, 40).all()
    assert year.humidity_percent.between(0, 100).all()
    assert year.pressure_hpa.between(950, 1020).all()  # 273 m above the sea
    assert year.wind_speed.between(0, 20).all()
    assert year.wind_from_deg.between(0, 360).all()
    assert year.radiation.between(0, 1361).all()
    assert year.mean().to_dict() == pytest.approx(
        {
            "temperature_c": 14.42,
            "humidity_percent": 69.52,
            "pressure_hpa": 986.92,
            "wind_speed": 3.054,
            "wind_from_deg": 165.17,
            "radiation": 178.79,
        },
        rel=1e-3,
    )


def test_hours_are_in_the_order_of_the_year(year):
    """Nights are dark, noons bright; July is warmer than January."""
    by_hour = year.radiation.groupby(year.index % 24).mean()
    assert by_hour.idxmax() in (11, 12)
    assert by_hour.loc[[0, 1, 2, 22, 23]].max() == 0
    assert year.temperature_c[4344:5088].mean() > year.temperature_c[:744].mean() + 15


def test_first_hour_is_that_of_the_file(year):
    assert year.iloc[0].to_dict() == {
        "temperature_c": 10.0,
        "humidity_percent": 77.0,
        "pressure_hpa": 993.0,
        "wind_speed": 6.2,
        "wind_from_deg": 200.0,
        "radiation": 0.0,
    }


def test_density_of_a_year_is_plausible(year):
    density = air_density(year.temperature_c, year.humidity_percent, year.pressure_hpa)
    assert density.mean() == pytest.approx(1.19, abs=0.01)


def test_rain_of_the_file_is_not_usable():
    """What the docstring says of it."""
    path = files("pvlib") / "data" / "723170TYA.CSV"
    records, _ = pvlib.iotools.read_tmy3(str(path), map_variables=True)
    assert records["Lprecip depth (mm)"].sum() == 8345


def test_a_change_does_not_reach_the_next_reader(year):
    changed = greensboro_weather()
    changed.iloc[0, 0] = 99.0
    assert greensboro_weather().iloc[0, 0] == year.iloc[0, 0] == 10.0


def test_missing_pvlib_is_told_with_the_command(monkeypatch):
    monkeypatch.setitem(sys.modules, "pvlib", None)
    with pytest.raises(ImportError, match="pip install pvlib"):
        greensboro_weather()


def test_weather_needs_no_pvlib():
    """It is imported only where the records are read."""
    code = "import sys, uavlab.weather; print(any(name.split('.')[0] in ('pvlib', 'pandas') for name in sys.modules))"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "False\n"
