"""The generator of offsets: its physics by hand, its noise by its law, and what it refuses."""

import math

import numpy as np
import pandas as pd
import pytest
from scipy.stats import norm

from uavlab.prediction import (
    FEATURES,
    SETTINGS,
    bayes_accuracy,
    class_probabilities,
    make_dataset,
    median_offsets,
    offset_class,
    simulate_offsets,
    synthetic_weather,
)
from uavlab.vehicle import LIGHT_QUADROTOR as UAV
from uavlab.weather import Weather, air_density

CALM = pd.DataFrame([dict(zip(FEATURES, (15.0, 50.0, 1013.25, 0.0, 0.0, 0.0), strict=True))])


def weather(**changes):
    return CALM.assign(**changes)


def test_median_is_drag_over_reserve():
    air = weather(wind_speed=5.0, wind_from_deg=60.0, radiation=500.0)  # along the street
    intensity = 0.2 + 0.3 * 0.5 / (1 + 5 / 3)
    gust = 5.0 * 1.4 * 1.38 * (1 + 2.5 * intensity)
    drag = 0.5 * float(air_density(15.0, 50.0, 1013.25)) * UAV.drag_area * gust**2
    expected = 0.5 + 8.5 * drag / UAV.horizontal_reserve()
    assert median_offsets(air, UAV) == pytest.approx([expected], rel=1e-12)


def test_wind_along_the_street_pushes_further_than_across():
    winds = pd.concat([weather(wind_speed=6.0, wind_from_deg=angle) for angle in (60.0, 240.0, 150.0, 330.0, 105.0)])
    along, back, across, against, between = median_offsets(winds, UAV, channelling=0.4) - 0.5
    assert along == pytest.approx(back, rel=1e-12)
    assert across == pytest.approx(against, rel=1e-12)
    assert along / across == pytest.approx((1.4 / 0.6) ** 2, rel=1e-12)
    assert along / between == pytest.approx(1.4**2, rel=1e-12)
    assert np.ptp(median_offsets(winds, UAV, channelling=0.0)) < 1e-12


def test_sun_cold_and_load_push_further_and_calm_does_not_push():
    breeze = weather(wind_speed=4.0)
    (usual,) = median_offsets(breeze, UAV)
    assert median_offsets(breeze.assign(radiation=900.0), UAV)[0] > 1.1 * usual
    assert median_offsets(breeze.assign(temperature_c=-15.0), UAV)[0] > usual
    assert median_offsets(breeze.assign(humidity_percent=100.0), UAV)[0] < usual  # moist air is lighter
    assert median_offsets(breeze, UAV.loaded(1.0))[0] > usual
    assert median_offsets(CALM, UAV) == pytest.approx([0.5])


def test_sun_matters_most_in_light_wind():
    def gain(wind):
        dark, bright = median_offsets(
            pd.concat([weather(wind_speed=wind), weather(wind_speed=wind, radiation=1000.0)]), UAV
        )
        return (bright - 0.5) / (dark - 0.5)

    assert gain(1.0) > gain(5.0) > gain(12.0) > 1


def test_stiffness_is_the_one_of_table_4():
    """8.5 m: heavy load in a mild wind of 6 m/s with gusts of 1.75 times gives ξ = 4 when 1 m is the still offset."""
    for payload, wind, distance in ((0.25, 6.0, 3), (1.0, 6.0, 4), (0.25, 9.0, 5)):
        air = weather(wind_speed=wind)
        median = median_offsets(
            air, UAV.loaded(payload), channelling=0.0, height_factor=1.75, peak_factor=0.0, still_offset=1.0
        )
        assert offset_class(median)[0] == distance


def test_noise_is_log_normal_with_the_given_spread():
    air = pd.concat([weather(wind_speed=5.0)] * 20_000)
    for seed in range(3):
        ratio = np.log(simulate_offsets(air, UAV, seed, noise=0.25) / median_offsets(air, UAV))
        assert ratio.mean() == pytest.approx(0, abs=4 * 0.25 / math.sqrt(20_000))
        assert ratio.std() == pytest.approx(0.25, rel=4 / math.sqrt(2 * 20_000))
        assert (ratio > 1.6449 * 0.25).mean() == pytest.approx(0.05, abs=0.0062)


def test_no_noise_gives_the_median_and_same_seed_the_same_offsets():
    air = synthetic_weather(50, 1)
    assert np.array_equal(simulate_offsets(air, UAV, 0, noise=0.0), median_offsets(air, UAV))
    assert np.array_equal(simulate_offsets(air, UAV, 5), simulate_offsets(air, UAV, 5))
    assert not np.array_equal(simulate_offsets(air, UAV, 5), simulate_offsets(air, UAV, 6))


def test_a_weather_state_and_a_dictionary_are_tables_too():
    state = Weather(forecast_wind=3.0, measured_wind=5.0, wind_from_deg=60.0)
    table = weather(wind_speed=5.0, wind_from_deg=60.0)
    assert median_offsets(state, UAV) == pytest.approx(median_offsets(table, UAV), rel=1e-12)
    assert median_offsets(dict(table), UAV) == pytest.approx(median_offsets(table, UAV), rel=1e-12)


def test_class_is_rounded_up_and_clipped():
    assert offset_class([0.0, 0.2, 1.0, 1.0001, 2.0, 5.5, 6.0, 40.0]).tolist() == [1, 1, 1, 2, 2, 6, 6, 6]
    assert offset_class([3.2, 5.5], 4).tolist() == [4, 4]


def test_class_probabilities_are_those_of_the_log_normal():
    median, noise = np.array([0.7, 1.9, 2.0, 5.4]), 0.21
    found = class_probabilities(np.log(median), noise, 6)
    assert found.sum(axis=1) == pytest.approx(1.0, abs=1e-12)
    law = norm(np.log(median), noise)
    assert found[:, 0] == pytest.approx(law.cdf(0.0), abs=1e-12)
    assert found[:, 1] == pytest.approx(law.cdf(np.log(2)) - law.cdf(0.0), abs=1e-12)
    assert found[:, 5] == pytest.approx(law.sf(np.log(5)), abs=1e-12)
    assert found[2, :2].sum() == pytest.approx(0.5, abs=1e-12)  # the median lies on the boundary


@pytest.mark.parametrize("setting", SETTINGS)
def test_bayes_accuracy_agrees_with_draws(setting):
    data = make_dataset(setting, 3)
    exact = bayes_accuracy(data.log_median, data.noise, data.class_count)
    best = 1 + class_probabilities(data.log_median, data.noise, data.class_count).argmax(axis=1)
    rng = np.random.default_rng(4)
    hits = [
        (
            offset_class(np.exp(data.log_median + data.noise * rng.standard_normal(7330)), data.class_count) == best
        ).mean()
        for _ in range(40)
    ]
    assert np.mean(hits) == pytest.approx(exact, abs=4 * np.std(hits, ddof=1) / math.sqrt(40))
    assert np.std(hits, ddof=1) < 0.01  # so that the line above can fail
    other = np.where(best > 1, best - 1, 2)
    assert (other == data.classes).mean() < exact - 0.3


def test_bayes_accuracy_falls_with_the_noise():
    data = make_dataset("paper", 0)
    limits = [bayes_accuracy(data.log_median, noise) for noise in (1e-6, 0.1, 0.21, 0.4, 50.0)]
    assert limits == sorted(limits, reverse=True)
    assert limits[0] == pytest.approx(1.0, abs=1e-3)
    assert limits[-1] == pytest.approx(0.5, abs=0.02)  # above or below all boundaries


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: class_probabilities([0.0], 0.2, 2.5), "class_count must be a whole number"),
        (lambda: median_offsets(CALM, UAV, street_axis_deg=math.nan), "street_axis_deg must be finite"),
        (lambda: class_probabilities([math.nan], 0.2), "log_median must be finite"),
        (lambda: class_probabilities([0.0], 0.0), "noise must be finite and above 0"),
        (lambda: offset_class([1.0, -2.0]), "offsets must be finite and at least 0, got -2"),
        (lambda: offset_class([math.nan]), "offsets must be finite"),
        (lambda: simulate_offsets(CALM, UAV, 0, noise=-0.1), "noise must be finite and at least 0, got -0.1"),
        (lambda: median_offsets(CALM, UAV, channelling=1.5), "channelling must be from 0 to below 1, got 1.5"),
        (lambda: median_offsets(CALM, UAV, height_factor=0.0), "height_factor must be finite and above 0"),
        (lambda: median_offsets(CALM, UAV, convective_wind=0.0), "convective_wind must be finite and above 0"),
        (lambda: median_offsets(CALM, UAV, stiffness=-1.0), "stiffness must be finite and above 0"),
        (lambda: median_offsets(CALM, UAV, still_offset=0.0), "still_offset must be finite and above 0"),
        (lambda: median_offsets(CALM, UAV, peak_factor=-1.0), "peak_factor must be finite and at least 0"),
        (lambda: median_offsets(CALM, UAV, mechanical_turbulence=-1.0), "mechanical_turbulence must be finite"),
        (lambda: median_offsets(CALM, UAV, convective_turbulence=-1.0), "convective_turbulence must be finite"),
        (lambda: median_offsets(weather(wind_speed=-1.0), UAV), "wind_speed must be finite and at least 0, got -1"),
        (lambda: median_offsets(weather(radiation=-5.0), UAV), "radiation must be finite and at least 0, got -5"),
        (lambda: median_offsets(weather(pressure_hpa=101325.0), UAV), "looks like Pa: divide by 100"),
        (lambda: median_offsets(weather(humidity_percent=120.0), UAV), "humidity_percent must be from 0 to 100 %"),
        (
            lambda: median_offsets(CALM.rename(columns={"radiation": "sun", "wind_speed": "wind"}), UAV),
            "weather must have wind_speed, radiation; unknown: wind, sun",
        ),
        (
            lambda: median_offsets(pd.concat([CALM] * 4, ignore_index=True).assign(
                wind_speed=[1.0, math.nan, 2.0, math.nan], radiation=[0.0, 0.0, math.inf, math.nan]), UAV),
            "3 of 4 rows have NaN or infinite values: 2 in wind_speed, 2 in radiation (rows 1, 2, 3); leave these",
        ),
        (lambda: median_offsets([[1, 2, 3, 4, 5, 6]], UAV), "must be a table with the columns temperature_c"),
    ],
)  # fmt: skip
def test_wrong_input_is_named(call, message):
    with pytest.raises(ValueError) as error:  # noqa: PT011 - the message is compared below
        call()
    assert message in str(error.value)
