"""The flight envelope: each limit against the balance of forces or the triangle of winds that it solves."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from uavlab.vehicle import LIGHT_QUADROTOR, RISK_QUADROTOR
from uavlab.weather import (
    Weather,
    course_wind_limit,
    grounded_by,
    lift_margin,
    mean_wind_limit,
    rain_force,
    reachable_ground_speed,
    wind_drag,
    wind_limit,
)


@given(st.floats(0, 0.87), st.floats(0, 2), st.floats(0.9, 1.4))
def test_drag_at_the_limit_is_the_reserve(payload, rain, density):
    uav = LIGHT_QUADROTOR.loaded(payload)
    limit = wind_limit(uav, rain, air_density=density)
    if lift_margin(uav, rain) <= 0:
        assert limit == 0
    else:
        drag = wind_drag((0, limit), (0, 0), uav.drag_area, air_density=density)
        assert drag[1] == pytest.approx(uav.horizontal_reserve(rain))
        assert np.hypot(drag[1], uav.weight + rain) <= uav.thrust * (1 + 1e-12)


def test_limit_over_rain_ends_where_the_lift_margin_does():
    uav = LIGHT_QUADROTOR.loaded(0.85)
    rain = np.array([0.0, 0.2, 0.27, 0.29, 5.0])  # the margin is 0 at (28/1.2 − 23.05) N = 0.28 N
    limit = wind_limit(uav, rain, safety_factor=1.2)
    assert (limit[:3] > 20).all()
    assert (np.diff(limit[:3]) < 0).all()
    assert (limit[3:] == 0).all()


def test_limit_of_the_unloaded_quadrotor_by_hand():
    reserve = np.sqrt(28**2 - 14.715**2)
    assert wind_limit(LIGHT_QUADROTOR) == pytest.approx(np.sqrt(2 * reserve / (1.225 * 0.06)))
    assert wind_limit(LIGHT_QUADROTOR) == pytest.approx(25.46, abs=0.005)


def test_a_heavy_load_needs_a_smaller_safety_factor():
    heavy = LIGHT_QUADROTOR.loaded(1.0)
    assert wind_limit(heavy, safety_factor=1.2) == 0
    assert wind_limit(heavy) == pytest.approx(19.17, abs=0.005)


@given(st.floats(0, 14.9), st.floats(-np.pi, np.pi))
def test_wind_of_the_course_limit_leaves_just_the_ground_speed(ground_speed, angle):
    wind = course_wind_limit(15.0, ground_speed, angle)
    along, across = wind * np.array([np.cos(angle), np.sin(angle)])
    assert np.hypot(ground_speed - along, across) == pytest.approx(15.0)  # all of the air speed is used
    assume(abs(across) < 15 - 1e-9)
    if along <= ground_speed:  # else the UAV has to fly against a wind that would carry it faster
        assert reachable_ground_speed(15.0, (along, across), (1, 0)) == pytest.approx(ground_speed, abs=1e-4)
    assert wind >= course_wind_limit(15.0, ground_speed) - 1e-9  # no wind is worse than a head wind


def test_head_wind_tail_wind_and_cross_wind():
    angles = np.radians([180, 0, 90])
    assert course_wind_limit(15.0, 9.0, angles) == pytest.approx([6.0, 24.0, 12.0])
    assert course_wind_limit(15.0, [0.0, 5.0, 15.0]) == pytest.approx([15.0, 10.0, 0.0])


def test_mean_wind_limit_is_the_least_of_both():
    light, loaded = LIGHT_QUADROTOR, LIGHT_QUADROTOR.loaded(0.85)
    assert mean_wind_limit(light, ground_speed=5) == pytest.approx(13.0)  # top speed 18 less 5
    assert mean_wind_limit(light) == pytest.approx(wind_limit(light) / 1.75)
    assert mean_wind_limit(loaded, ground_speed=5) == pytest.approx(wind_limit(loaded) / 1.75)
    assert mean_wind_limit(light, ground_speed=30) == 0
    assert mean_wind_limit(LIGHT_QUADROTOR.loaded(1.1)) == 0


def test_a_load_that_leaves_no_thrust_slows_the_uav_down():
    heavy = LIGHT_QUADROTOR.loaded(1.25)
    held = wind_limit(heavy, safety_factor=1.0)
    assert 10 < held < heavy.top_speed
    assert mean_wind_limit(heavy, ground_speed=10, safety_factor=1.0) == pytest.approx(held - 10)
    assert mean_wind_limit(heavy, ground_speed=held + 0.1, safety_factor=1.0) == 0
    (reason,) = grounded_by(heavy, Weather(forecast_wind=6), ground_speed=10, safety_factor=1.0)
    assert reason == f"head wind: 6.0 m/s of {held:.1f} m/s air speed leave less than 10 m/s"


def test_against_the_gust_the_ground_speed_comes_on_top():
    for load, limit in ((0.0, 11.7), (0.6, 10.1), (0.85, 9.0)):
        uav = LIGHT_QUADROTOR.loaded(load)
        kept = float(mean_wind_limit(uav, ground_speed=5, keep_speed=True))
        drag = wind_drag((-1.75 * kept, 0.0), (5.0, 0.0), uav.drag_area)[0]
        assert kept == pytest.approx(limit, abs=0.05)
        assert -drag == pytest.approx(uav.horizontal_reserve())
        assert kept < mean_wind_limit(uav, ground_speed=5)
    assert mean_wind_limit(uav, keep_speed=True) == mean_wind_limit(uav)  # the same in hover
    assert mean_wind_limit(uav, ground_speed=30, keep_speed=True) == 0
    light = mean_wind_limit(LIGHT_QUADROTOR, ground_speed=15, keep_speed=True)
    assert light == pytest.approx(3.0)  # the top speed binds


def test_mean_wind_limit_over_rain_and_air():
    limits = mean_wind_limit(LIGHT_QUADROTOR, [[0.0], [5.0]], air_density=np.array([1.0, 1.2, 1.3]))
    assert limits.shape == (2, 3)
    assert (np.diff(limits, axis=1) < 0).all()
    assert (limits[1] < limits[0]).all()


@given(st.floats(0, 1.2), st.floats(0, 300), st.floats(0, 25), st.floats(0, 10), st.floats(-20, 40))
def test_grounding_and_limit_agree(payload, rain, wind, ground_speed, temperature):
    uav = LIGHT_QUADROTOR.loaded(payload)
    weather = Weather(temperature_c=temperature, forecast_wind=wind, rain_mm_per_h=rain)
    force = rain_force(rain, uav.rain_area)
    limit = mean_wind_limit(uav, force, ground_speed=ground_speed, air_density=weather.air_density)
    assume(abs(limit - wind) > 1e-9)
    assert bool(grounded_by(uav, weather, ground_speed=ground_speed)) == (wind > limit)


def test_reasons_name_what_is_broken():
    calm = Weather()
    assert grounded_by(LIGHT_QUADROTOR, calm) == ()
    (lift,) = grounded_by(LIGHT_QUADROTOR.loaded(1.2), calm)
    assert lift == "lift: 1.14 N short of 1.1 times weight and rain"
    assert grounded_by(LIGHT_QUADROTOR.loaded(1.0), Weather(forecast_wind=9)) == ()  # REPARE's heaviest case
    (gusts,) = grounded_by(LIGHT_QUADROTOR, Weather(forecast_wind=5, forecast_max_wind=26))
    assert gusts.startswith("gusts: 26.0 m/s, and the thrust left over holds 25.")
    (head,) = grounded_by(LIGHT_QUADROTOR, Weather(measured_wind=14), ground_speed=5)
    assert head == "head wind: 14.0 m/s of 18.0 m/s air speed leave less than 5 m/s"
    assert len(grounded_by(LIGHT_QUADROTOR, Weather(forecast_wind=16), ground_speed=5)) == 2


def test_envelope_knows_the_tilt_limit():
    """35° hold a gust of 17.6 m/s; a mean wind of 10 m/s is what the data sheet of a Phantom 4 names."""
    assert wind_limit(RISK_QUADROTOR) == pytest.approx(
        np.sqrt(2 * RISK_QUADROTOR.weight * np.tan(np.radians(35)) / (1.225 * 0.05))
    )
    assert wind_limit(RISK_QUADROTOR) == pytest.approx(17.6, abs=0.05)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: wind_limit(LIGHT_QUADROTOR, -1.0), "rain must be finite and at least 0, got -1"),
        (lambda: wind_limit(LIGHT_QUADROTOR, air_density=0.0), "air_density must be finite and above 0, got 0"),
        (lambda: wind_limit(LIGHT_QUADROTOR, safety_factor=0.5), "safety_factor must be finite and at least 1"),
        (lambda: course_wind_limit(0.0, 0.0), "air_speed must be finite and above 0, got 0"),
        (lambda: course_wind_limit(15.0, 16.0), "ground_speed must be from 0 to 15 m/s, the air_speed, got 16"),
        (lambda: course_wind_limit(15.0, 5.0, np.nan), "wind_angle must be finite, got nan"),
        (lambda: mean_wind_limit(LIGHT_QUADROTOR, ground_speed=-1.0), "ground_speed must be finite and at least 0"),
        (lambda: mean_wind_limit(LIGHT_QUADROTOR, gust_factor=0.0), "gust_factor must be finite and at least 1, got 0"),
        (lambda: grounded_by(LIGHT_QUADROTOR, Weather(), ground_speed=np.nan), "ground_speed must be .* got nan"),
    ],
)
def test_wrong_questions_are_refused(call, words):
    with pytest.raises(ValueError, match=words):
        call()
