"""Power of rotors against closed forms, other solvers, and what makers measured."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from uavlab.power import induced_velocity, power_needed, profile_share
from uavlab.vehicle import DATA_SHEETS, GRAVITY, INDUCED, LIGHT_QUADROTOR, RISK_QUADROTOR, UAV

PRESETS = [LIGHT_QUADROTOR, LIGHT_QUADROTOR.loaded(1.0), RISK_QUADROTOR]
MATRICE = {sheet.name: sheet for sheet in DATA_SHEETS}["DJI Matrice 100, TB47D battery"]


def described(sheet, drag_area=0.03):
    """A UAV with the mass, the rotors and the battery of a data sheet, and nothing else of it."""
    return UAV(
        mass=sheet.mass,
        thrust=2.5 * sheet.mass * GRAVITY,
        drag_area=drag_area,
        rain_area=0.1,
        diameter=0.5,
        cruise_speed=10.0,
        top_speed=sheet.top_speed,
        rotor_area=np.pi * sheet.rotor_diameter**2,
        battery=sheet.battery,
        reserve=0.0,
    )


@pytest.mark.parametrize("uav", PRESETS, ids=lambda uav: f"{uav.mass:g} kg")
@pytest.mark.parametrize("air_density", [1.225, 0.9])
def test_hover_is_the_ideal_rotor_over_its_efficiencies(uav, air_density):
    ideal = uav.weight**1.5 / np.sqrt(2 * air_density * uav.rotor_area)
    power = power_needed(uav, (0.0, 0.0, 0.0), air_density=air_density)
    assert power.induced == pytest.approx(INDUCED * ideal)
    assert power.induced + power.profile == pytest.approx(ideal / uav.figure_of_merit)
    assert power.useful == 0
    assert power.battery == pytest.approx(uav.hover_power(air_density))
    assert profile_share(uav) == pytest.approx(1 / uav.figure_of_merit - INDUCED)


@pytest.mark.parametrize("through", [-9.0, -4.0, -1.0, 0.0, 2.0, 8.0])
@pytest.mark.parametrize("across", [0.0, 0.5, 3.0, 12.0])
def test_glauert_has_been_solved(through, across):
    hover = 5.0
    induced = induced_velocity(hover, through, across)
    assert induced * np.hypot(across, through + induced) == pytest.approx(hover**2, rel=1e-8)
    if across * -through < hover**2:  # the largest of its solutions, that of climbs
        found = brentq(lambda w: w * np.hypot(across, through + w) - hover**2, max(0.0, -through), 30.0)
        assert induced == pytest.approx(found, rel=1e-8)


def test_climb_and_descent_have_their_closed_forms():
    """w = −V/2 + √(V²/4 + w_h²); and in fast forward flight w = w_h²/V."""
    for climb in (-6.0, -2.0, 0.0, 3.0, 10.0):
        assert induced_velocity(5.0, climb, 0.0) == pytest.approx(-climb / 2 + np.sqrt(climb**2 / 4 + 25))
    assert induced_velocity(5.0, 0.0, 50.0) == pytest.approx(25 / 50, rel=1e-3)


def test_air_that_stands_still_relative_to_the_ground_is_no_special_case():
    """What counts is the speed through the air."""
    calm = power_needed(RISK_QUADROTOR, (8.0, 3.0, 1.0))
    windy = power_needed(RISK_QUADROTOR, (10.0, -1.0, 1.0), (2.0, -4.0, 0.0))
    assert np.array(windy) == pytest.approx(np.array(calm))
    drag = 0.5 * 1.225 * RISK_QUADROTOR.drag_area * (8**2 + 3**2 + 1) ** 1.5
    assert calm.useful == pytest.approx(drag + RISK_QUADROTOR.weight * 1.0)


def test_power_of_many_velocities_is_that_of_each():
    velocities = np.random.default_rng(0).uniform(-9, 9, (4, 3, 3))
    many = power_needed(LIGHT_QUADROTOR, velocities, (2.0, 1.0), rain_mm_per_h=20)
    one = power_needed(LIGHT_QUADROTOR, velocities[2, 1], (2.0, 1.0), rain_mm_per_h=20)
    assert many.battery.shape == (4, 3)
    assert np.array([part[2, 1] for part in many]) == pytest.approx(np.array(one))
    level = power_needed(LIGHT_QUADROTOR, velocities[..., :2], (2.0, 1.0))
    flat = power_needed(LIGHT_QUADROTOR, velocities * [1, 1, 0], (2.0, 1.0))
    assert level.battery == pytest.approx(flat.battery)


def test_power_is_never_negative_and_a_climb_costs_its_height():
    velocities = np.random.default_rng(1).uniform(-18, 18, (3000, 3))
    for uav in PRESETS:
        power = power_needed(uav, velocities)
        assert (power.battery >= 0).all()
        climbing = velocities[:, 2] > 0
        lifted = uav.weight * velocities[climbing, 2] / uav.drive_efficiency
        assert (power.battery[climbing] > lifted).all()


@pytest.mark.parametrize(("payload", "minutes"), [(0.0, 22), (0.5, 17), (1.0, 13)])
def test_hover_of_a_matrice_is_within_15_percent_of_the_data_sheet(payload, minutes):
    """Battery over time of hover, with loads; that it lands with a tenth of the battery is said there. Measured: 245,
    317 and 415 W; here 269, 360 and 458. No parameter was chosen by it.
    """
    measured = 0.9 * MATRICE.battery / (60 * minutes)
    assert described(MATRICE).loaded(payload).hover_power() == pytest.approx(measured, rel=0.15)


@pytest.mark.parametrize(("kilometres_per_hour", "minutes"), [(25, 31), (50, 21.6)])
def test_cruise_over_hover_of_a_mavic_is_within_15_percent_of_the_data_sheet(kilometres_per_hour, minutes):
    """29 min of hover, 31 min at 25 km/h, 18 km at 50 km/h; C·S from its tilt of 35° at 20 m/s."""
    sheet = {sheet.name: sheet for sheet in DATA_SHEETS}["DJI Mavic 2 Pro"]
    drag_area = 2 * sheet.mass * GRAVITY * np.tan(np.radians(35)) / (1.225 * sheet.top_speed**2)
    uav = described(sheet, drag_area)
    ratio = power_needed(uav, (kilometres_per_hour / 3.6, 0.0)).battery / uav.hover_power()
    assert ratio == pytest.approx(29 / minutes, rel=0.15)


def test_presets_stand_beside_real_aircraft():
    """Wind, climb, descent and endurance within a factor that data sheets have among themselves."""
    for uav in (RISK_QUADROTOR, LIGHT_QUADROTOR):
        assert uav.climb_speed in {sheet.climb_speed for sheet in DATA_SHEETS}
        assert uav.sink_speed in {sheet.sink_speed for sheet in DATA_SHEETS}
        assert 20 * 60 < uav.endurance < 30 * 60
    assert replace(RISK_QUADROTOR, reserve=0.0).endurance == pytest.approx(28 * 60, rel=0.15)
    assert np.isinf(replace(RISK_QUADROTOR, battery=np.inf).endurance)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: power_needed(RISK_QUADROTOR, (1.0, 2.0, np.nan)), "velocity must be finite"),
        (lambda: power_needed(RISK_QUADROTOR, (1.0, 2.0, 0.0), (1.0,)), "wind must be"),
        (lambda: power_needed(RISK_QUADROTOR, (1.0, 0.0, 0.0), air_density=0), "air_density must be finite and above"),
        (lambda: replace(RISK_QUADROTOR, figure_of_merit=0.9), "figure_of_merit must be below 0.87"),
        (lambda: replace(RISK_QUADROTOR, drive_efficiency=1.1), "drive_efficiency is a share and must be at most 1"),
        (lambda: replace(RISK_QUADROTOR, reserve=1.0), "reserve is a share of the battery and must be below 1"),
        (lambda: replace(RISK_QUADROTOR, battery=0.0), "battery must be finite and above 0"),
        (lambda: replace(RISK_QUADROTOR, climb_speed=np.nan), "climb_speed must be finite and above 0"),
        (lambda: replace(RISK_QUADROTOR, mass=np.inf), "mass must be finite and above 0"),
    ],
)
def test_wrong_questions_are_refused_by_name(call, words):
    with pytest.raises(ValueError, match=words):
        call()
