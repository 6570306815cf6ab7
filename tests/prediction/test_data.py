"""The tables to learn from: their size and split, real hours, and what is refused."""

import math

import numpy as np
import pytest

from uavlab.prediction import FEATURES, SETTINGS, Setting, make_dataset, median_offsets, offset_class, synthetic_weather
from uavlab.vehicle import LIGHT_QUADROTOR as UAV
from uavlab.weather import Weather, greensboro_weather


@pytest.mark.parametrize("setting", SETTINGS)
def test_dataset_has_the_papers_size_and_split(setting):
    data = make_dataset(setting, 1)
    assert data.features.shape == (7330, 6)
    assert tuple(data.features.columns) == FEATURES
    assert (data.train.sum(), data.test.sum()) == (5864, 1466)
    assert not (data.train & data.test).any()
    assert np.array_equal(data.classes, offset_class(data.offsets, data.class_count))
    assert set(data.classes) == set(range(1, data.class_count + 1))
    site = {"channelling": data.setting.channelling}
    assert np.allclose(data.log_median, np.log(median_offsets(data.features, UAV, **site)), rtol=0, atol=1e-12)
    assert np.log(data.offsets) - data.log_median == pytest.approx(0, abs=6 * data.noise)
    assert np.std(np.log(data.offsets) - data.log_median) == pytest.approx(data.noise, rel=0.05)
    again, other = make_dataset(setting, 1), make_dataset(setting, 2)
    assert np.array_equal(again.offsets, data.offsets)
    assert np.array_equal(again.train, data.train)
    assert not np.array_equal(other.offsets, data.offsets)


def test_greensboro_features_are_hours_of_the_record_each_at_most_once():
    record = set(map(tuple, greensboro_weather().reset_index()[list(FEATURES)].to_numpy().tolist()))
    features = make_dataset("greensboro", 0).features
    assert set(map(tuple, features.to_numpy().tolist())) <= record
    everything = make_dataset("greensboro", 0, count=8760)
    assert everything.features.sum().to_numpy() == pytest.approx(greensboro_weather()[list(FEATURES)].sum().to_numpy())


def test_synthetic_weather_is_weather():
    hours = synthetic_weather(20_000, 0)
    Weather(*hours.iloc[0, :3])  # within its ranges
    assert hours.temperature_c.between(-25, 50).all()
    assert hours.humidity_percent.between(8, 100).all()
    assert hours.wind_from_deg.between(0, 360).all()
    assert (hours.radiation == 0).mean() == pytest.approx(0.5, abs=0.03)  # nights
    assert hours.radiation.max() < 1100
    assert hours.wind_speed.mean() == pytest.approx(4 * math.gamma(1.5), rel=0.02)
    assert hours.temperature_c.corr(hours.radiation) > 0.3
    assert hours.temperature_c.corr(hours.pressure_hpa) < -0.3


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: make_dataset("berlin"), "setting must be one of 'paper', 'steady wind', 'greensboro', got 'berlin'"),
        (lambda: make_dataset(count=100, train_count=100), "train_count must be from 1 to count - 1 = 99, got 100"),
        (lambda: make_dataset("greensboro", count=9000), "count must be at most 8760"),
        (lambda: make_dataset(train_count=0.8), "train_count must be a whole number"),
        (lambda: synthetic_weather(5, 0, wind_scale=-1), "wind_scale must be finite and above 0"),
        (lambda: Setting(noise=0.0), "noise must be finite and above 0, got 0"),
        (lambda: Setting(wind_shape=-1.0), "wind_shape must be finite and above 0"),
        (lambda: Setting(wind_scale=math.nan), "wind_scale must be finite and above 0, got nan"),
        (lambda: Setting(channelling=1.0), "channelling must be from 0 to below 1, got 1.0"),
        (lambda: Setting(class_count=1), "class_count must be a whole number of at least 2, got 1"),
    ],
)
def test_wrong_input_is_named(call, message):
    with pytest.raises(ValueError) as error:  # noqa: PT011 - the message is compared below
        call()
    assert message in str(error.value)
