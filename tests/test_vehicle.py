"""The vehicle: what it refuses, and the thrust that is left against the wind."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from uavlab.vehicle import GRAVITY, LIGHT_QUADROTOR, RISK_QUADROTOR, UAV


def test_weight_includes_the_payload():
    assert LIGHT_QUADROTOR.weight == pytest.approx(14.715)
    assert LIGHT_QUADROTOR.loaded(0.6).weight == pytest.approx(2.1 * GRAVITY)
    assert LIGHT_QUADROTOR.loaded(0.6).loaded(0.0) == LIGHT_QUADROTOR


def test_presets_have_the_published_values():
    assert (RISK_QUADROTOR.mass, RISK_QUADROTOR.top_speed) == (1.38, 16.0)
    assert RISK_QUADROTOR.fall_drag_area == pytest.approx(0.00564)
    assert RISK_QUADROTOR.rain_area == pytest.approx(0.12566, abs=1e-5)


def test_reserve_closes_the_triangle_of_forces():
    """A thrust of 5 against a weight of 3 leaves 4."""
    uav = replace(LIGHT_QUADROTOR, mass=3.0 / GRAVITY, thrust=5.0, max_tilt=np.radians(80))
    assert uav.horizontal_reserve() == pytest.approx(4.0)
    assert uav.horizontal_reserve(1.0) == pytest.approx(3.0)


def test_reserve_is_bounded_by_the_tilt():
    """At 30° the thrust that holds the height has tan 30° of it sideways, however strong the rotors are."""
    uav = replace(LIGHT_QUADROTOR, thrust=1000.0, max_tilt=np.radians(30))
    assert uav.horizontal_reserve() == pytest.approx(uav.weight / np.sqrt(3))


def test_reserve_over_an_array_ends_where_the_lift_does():
    rain = np.array([0.0, 5.0, 28.0 - LIGHT_QUADROTOR.weight, 20.0])
    reserve = LIGHT_QUADROTOR.horizontal_reserve(rain)
    assert reserve[:2] == pytest.approx([np.sqrt(28**2 - 14.715**2), np.sqrt(28**2 - 19.715**2)])
    assert reserve[2:] == pytest.approx([0.0, 0.0], abs=1e-5)


@given(st.floats(0, 1.35), st.floats(0, 60))
def test_thrust_is_never_exceeded(payload, force):
    uav = LIGHT_QUADROTOR.loaded(payload)
    reserve = uav.horizontal_reserve(force)
    assert reserve >= 0
    assert reserve == 0 or np.hypot(reserve, uav.weight + force) <= uav.thrust * (1 + 1e-12)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"mass": 0.0}, "mass must be finite and above 0, got 0"),
        ({"mass": -1.5}, "mass must be finite and above 0, got -1.5"),
        ({"thrust": np.nan}, "thrust must be finite and above 0, got nan"),
        ({"drag_area": np.inf}, "drag_area must be finite and above 0, got inf"),
        ({"rain_area": 0}, "rain_area must be finite and above 0"),
        ({"diameter": -1.0}, "diameter must be finite and above 0"),
        ({"payload": -0.1}, "payload must be finite and at least 0, got -0.1"),
        ({"mass": "1.5"}, "mass must be a number or an array of numbers: got text, '1.5'"),
        ({"payload": np.array([0.1, 0.2])}, r"payload must be one number, got an array of shape \(2,\)"),
        ({"max_tilt": 35.0}, "max_tilt must be below π/2 in radians, got 35; convert with numpy.radians"),
        ({"cruise_speed": 20.0}, "cruise_speed 20 m/s is above top_speed 18 m/s"),
        ({"payload": 1.4}, r"thrust 28 N can't lift 1.5 kg \+ payload 1.4 kg \(28.4 N\): carry less"),
    ],
)
def test_wrong_vehicles_are_refused(change, words):
    with pytest.raises(ValueError, match=words):
        replace(LIGHT_QUADROTOR, **change)


@pytest.mark.parametrize("force", [-0.1, np.nan, [0.0, np.inf]])
def test_wrong_forces_are_refused(force):
    with pytest.raises(ValueError, match="downward_force must be finite and at least 0, got"):
        LIGHT_QUADROTOR.horizontal_reserve(force)


def test_a_vehicle_needs_no_payload():
    assert UAV(1.0, 20.0, 0.05, 0.1, 0.5, 5.0, 10.0).payload == 0.0
