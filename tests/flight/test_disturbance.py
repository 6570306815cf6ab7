"""Gusts in the loop against their spectra and correlations, offsets by gusts against closed forms."""

from dataclasses import replace

import numba
import numpy as np
import pytest
from places import EXACT, SKY, straight
from scipy.integrate import quad

from uavlab.flight import OffsetProcess, fly, offset_sigma
from uavlab.flight.models import air_of, passing_speed
from uavlab.flight.motion import next_gust
from uavlab.flight.path import planned_speed
from uavlab.flight.simulation import setup_of
from uavlab.flight.state import start_of
from uavlab.resilience import ADVANCED, BASIC, Controller
from uavlab.route import Route
from uavlab.vehicle import GRAVITY, LIGHT_QUADROTOR
from uavlab.weather import Weather, Wind, dryden_gusts, dryden_parameters, gust_spectrum
from uavlab.weather.forces import STANDARD_AIR
from uavlab.weather.wind import gust_deviations

DT = 0.05
ALTITUDE = 50.0
AIR_SPEED = 9.0
NAN = float("nan")


@numba.njit
def blown(air, state, steps, rng, gusts):
    """Gusts of so many steps, again and again from the start until the array is full."""
    for row in range(len(gusts)):
        next_gust(air, state, row % steps, rng)
        gusts[row] = state.gust


def gusts_of(wind, count=400, duration=40.0, seed=0):
    """Gusts (count, steps, 3) [m/s] as flights meet them, each from its first step on."""
    gusts = np.empty((count, round(duration / DT), 3))
    setup, _ = setup_of(straight(), SKY, LIGHT_QUADROTOR, wind, EXACT, DT)
    air = air_of(wind, AIR_SPEED, ALTITUDE, DT)
    for one, rng in zip(gusts, np.random.default_rng(seed).spawn(count), strict=True):
        blown(air, start_of(setup.path.points[0]), len(one), rng, one)
    return gusts


def correlation_of(wind, lag):
    """R(lag)/σ² along, across and up, in the frame of the wind."""
    if wind.gusts == "dryden":
        turn = lag * AIR_SPEED
        turn = turn / dryden_parameters(ALTITUDE, wind.speed).scale_lengths
        return np.exp(-turn) * [1.0, 1 - turn[1] / 2, 1 - turn[2] / 2]
    if wind.gusts == "ou":
        return np.full(3, np.exp(-lag / wind.correlation))
    return np.full(3, max(1 - lag / wind.correlation, 0.0))


WINDS = [
    Wind((3, 4), "ou", deviation=1.5, correlation=0.8),
    Wind((3, 4), "gaussian", deviation=1.5, correlation=0.8),
    Wind((0, 8), "dryden"),
    Wind((-8, 0), "dryden"),
]


@pytest.mark.parametrize("wind", WINDS, ids=lambda wind: f"{wind.gusts} {wind.mean[:2]}")
def test_gusts_in_the_loop_have_their_deviation_and_correlation(wind):
    """Means over flights, which are independent, within 4.5 of their standard errors; stationary from the start."""
    gusts = gusts_of(wind)
    along = np.array(wind.mean[:2]) / wind.speed if wind.gusts == "dryden" else np.array([1.0, 0.0])
    across = np.array([-along[1], along[0]])
    framed = np.stack([gusts[..., :2] @ along, gusts[..., :2] @ across, gusts[..., 2]], axis=-1)
    framed /= gust_deviations(wind, ALTITUDE)
    for first, last in ((0, 100), (600, 800)):
        for lag in (0.0, 0.2, 0.4, 2.0):
            steps = round(lag / DT)
            if wind.gusts == "gaussian":  # only from draw to draw is it the same at all times
                starts = np.arange(first, last - steps)
                starts = starts[: len(starts) // 16 * 16]
                products = (framed[:, starts] * framed[:, starts + steps]).mean(axis=1)
            else:
                products = (framed[:, first : last - steps] * framed[:, first + steps : last]).mean(axis=1)
            error = products.std(axis=0) / np.sqrt(len(products))
            assert (abs(products.mean(axis=0) - correlation_of(wind, lag)) < 4.5 * error).all(), (first, lag)
            assert (error < 0.1).all()


def test_the_axes_of_a_gust_are_independent_and_no_gusts_are_none():
    framed = gusts_of(WINDS[0])
    for one, other in ((0, 1), (0, 2), (1, 2)):
        products = (framed[..., one] * framed[..., other]).mean(axis=1)
        assert abs(products.mean()) < 4.5 * products.std() / np.sqrt(len(products))
    assert not gusts_of(Wind((3, 4), "none", deviation=2.0), count=2).any()


def test_dryden_gusts_are_stationary_from_the_first_moment():
    """Over 100 000 starts, whose variance is known to 0.45 %; the two lags of a gust belong together."""
    gusts = np.empty((300_000, 3))
    setup, _ = setup_of(straight(), SKY, LIGHT_QUADROTOR, WINDS[2], EXACT, DT)
    blown(air_of(WINDS[2], AIR_SPEED, ALTITUDE, DT), start_of(setup.path.points[0]), 3, np.random.default_rng(0), gusts)
    started = gusts.reshape(-1, 3, 3)[..., [1, 0, 2]] / gust_deviations(WINDS[2], ALTITUDE)
    assert (started**2).mean(axis=0) == pytest.approx(np.ones((3, 3)), abs=0.02)


def test_dryden_gusts_pass_with_the_air_that_meets_the_uav():
    """Mean over the legs of wind less ground velocity; never below 1 m/s, so that they don't stand still."""
    there_and_back = Route([(20, 150, 50), (120, 150, 50), (20, 150, 50)])
    path = planned_speed(there_and_back, LIGHT_QUADROTOR, WINDS[3], 5.0)
    assert passing_speed(WINDS[3], path, BASIC) == pytest.approx((13 + 3) / 2)
    assert passing_speed(WINDS[2], path, ADVANCED) == pytest.approx(np.hypot(8, 2.5))
    tail = planned_speed(straight(), LIGHT_QUADROTOR, Wind((5, 0)), 5.0)
    assert passing_speed(Wind((5, 0)), tail, BASIC) == 1.0
    assert fly(straight(), SKY, LIGHT_QUADROTOR, Wind((5, 0), "dryden"), EXACT, rng=0).outcome == "arrived"


def test_gaussian_gusts_stand_still_between_draws():
    jumps = np.diff(gusts_of(WINDS[1], count=3), axis=1).any(axis=(0, 2))
    assert np.array_equal(np.flatnonzero(jumps) + 1, np.arange(16, 800, 16))


def test_dryden_gusts_are_as_strong_as_those_of_the_weather():
    wind = WINDS[2]
    others = np.array([dryden_gusts(40.0, DT, AIR_SPEED, ALTITUDE, wind.speed, seed) for seed in range(400)])
    power = (gusts_of(wind)[..., [1, 0, 2]] ** 2).mean(axis=1)  # it blows to the north
    other = (others**2).mean(axis=1)
    error = np.hypot(power.std(axis=0), other.std(axis=0)) / np.sqrt(400)
    assert (abs(power.mean(axis=0) - other.mean(axis=0)) < 4.5 * error).all()


@pytest.mark.parametrize("wind", WINDS[:3], ids=lambda wind: wind.gusts)
def test_the_spectrum_holds_the_variance_and_is_the_transform_of_the_correlation(wind):
    """A sum to 3 000 rad/s; beyond it lie less than 4/(π 3 000 τ) = 0.1 % of the variance."""
    omega = (np.arange(600_000) + 0.5) * 5e-3
    density = gust_spectrum(wind, omega, AIR_SPEED, ALTITUDE)
    variance = gust_deviations(wind, ALTITUDE) ** 2
    for lag in (0.0, 0.3, 1.0):
        transform = (density * np.cos(omega * lag)[:, None]).sum(axis=0) * 5e-3
        assert transform == pytest.approx(variance * correlation_of(wind, lag), abs=2e-3 * variance.max())
    assert not gust_spectrum(Wind(gusts="none"), omega[:3], 5.0).any()


@pytest.mark.parametrize("controller", [BASIC, ADVANCED, Controller("stiff", 1.0, 3.0)], ids=lambda c: c.name)
@pytest.mark.parametrize("correlation", [0.01, 0.5, 1.0, 20.0])
def test_offsets_by_correlated_gusts_are_those_of_the_closed_form(controller, correlation):
    """x″ + c x′ + k x = f, f with variance s² and rate b: σ² = s² (b + c)/(c k (b² + b c + k))."""
    wind = Wind((0, -6, 0), deviation=0.7, correlation=correlation)
    drag = 0.5 * STANDARD_AIR * LIGHT_QUADROTOR.drag_area * np.hypot(6, 4) / (LIGHT_QUADROTOR.weight / GRAVITY)
    own = drag * np.array([2, 1, 1])
    s = own * 0.7 * np.array([1, 1, 0.5])
    b, c, k = 1 / correlation, 2 * controller.natural_frequency + own, controller.natural_frequency**2
    expected = np.sqrt(s**2 * (b + c) / (c * k * (b**2 + b * c + k)))
    found = offset_sigma(LIGHT_QUADROTOR, wind, ground_velocity=(4, 0), controller=controller)
    assert found == pytest.approx(expected, rel=1e-6)


def test_theory_gives_heavier_vehicles_smaller_offsets_and_no_gusts_none():
    wind = Wind((0, 8))
    light, heavy = (offset_sigma(LIGHT_QUADROTOR.loaded(load), wind) for load in (0.0, 1.0))
    assert (heavy < light).all()
    assert heavy == pytest.approx(light * 1.5 / 2.5, rel=0.05)  # drag damps the lighter one a little more
    assert offset_sigma(LIGHT_QUADROTOR, Wind((0, 8), "none")).tolist() == [0, 0, 0]


def test_theory_takes_a_state_of_the_weather_for_its_wind():
    weather = Weather(forecast_wind=5.0, forecast_max_wind=9.0, measured_wind=5.0)
    assert (offset_sigma(LIGHT_QUADROTOR, weather) == offset_sigma(LIGHT_QUADROTOR, Wind.from_weather(weather))).all()


@pytest.mark.parametrize("rough", [False, True])
def test_two_steps_of_an_offset_process_are_one_of_twice_the_length(rough):
    process = OffsetProcess(0.8, rough=rough)
    _, once, noise = process.step(0.05, ADVANCED)
    sigma, twice, all_noise = process.step(0.1, ADVANCED)
    assert once @ once == pytest.approx(twice, abs=1e-12)
    covariance = noise @ noise.T
    assert once @ covariance @ once.T + covariance == pytest.approx(all_noise @ all_noise.T, abs=1e-12)
    assert sigma == pytest.approx([0.8 * 1.6**-1.5] * 3)


def test_wind_of_a_weather_blows_where_it_goes_with_three_sigma_to_the_gust():
    weather = Weather(forecast_wind=6.0, forecast_max_wind=12.0, wind_from_deg=270.0, rain_mm_per_h=5.0)
    wind = Wind.from_weather(weather, "gaussian", 2.0)
    assert wind.mean == pytest.approx((6, 0, 0), abs=1e-12)
    assert wind.speed == pytest.approx(6)
    assert (wind.deviation, wind.gusts, wind.correlation) == (2.0, "gaussian", 2.0)
    assert (wind.rain_mm_per_h, wind.air_density) == (5.0, weather.air_density)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: Wind((1,)), r"mean must be two or three finite numbers"),
        (lambda: Wind((1, NAN)), r"mean must be two or three finite numbers"),
        (lambda: Wind(gusts="storm"), r"gusts must be one of 'none', 'gaussian', 'ou', 'dryden', got 'storm'"),
        (lambda: Wind(deviation=-1), r"deviation must be finite and at least 0, got -1"),
        (lambda: Wind(deviation=(1, 1)), r"deviation must be one number"),
        (lambda: Wind(correlation=0), r"correlation must be finite and above 0, got 0"),
        (lambda: Wind(rain_mm_per_h=-1), r"rain_mm_per_h must be finite and at least 0, got -1"),
        (lambda: Wind(air_density=0), r"air_density must be finite and above 0, got 0"),
        (lambda: Wind((0, 0, 3), "dryden"), r"mean is calm, and Dryden gusts take their strength from it"),
        (lambda: OffsetProcess(-1), r"sigma must be finite and at least 0, got -1"),
        (lambda: OffsetProcess((1, 1)), r"sigma must be one number or three .* got shape \(2,\)"),
        (lambda: OffsetProcess(NAN), r"sigma must be finite"),
        (lambda: OffsetProcess(1, mean=(1, 2, 3, 4)), r"mean must be two or three finite numbers"),
        (lambda: offset_sigma(LIGHT_QUADROTOR, Wind((5, 0)), ground_velocity=(5, 0)), r"the air stands still"),
        (lambda: offset_sigma(LIGHT_QUADROTOR, Wind((5, 0)), ground_velocity=(5, NAN)), r"ground_velocity must be"),
        (lambda: offset_sigma(BASIC, Wind((5, 0))), r"uav must be a UAV, got Controller"),
        (lambda: offset_sigma(LIGHT_QUADROTOR, LIGHT_QUADROTOR), r"wind must be a Wind, got UAV"),
        (lambda: offset_sigma(LIGHT_QUADROTOR, Wind((5, 0)), altitude=0), r"altitude must be finite and above 0"),
        (lambda: offset_sigma(LIGHT_QUADROTOR, Wind((5, 0)), controller=2), r"controller must be a Controller"),
        (lambda: OffsetProcess(1, rough="no"), r"rough must be True or False, got 'no'"),
        (lambda: OffsetProcess(1).step(0, BASIC), r"time_step must be finite and above 0, got 0"),
        (lambda: OffsetProcess(1).step(0.02, "basic"), r"controller must be a Controller, got str"),
        (lambda: gust_spectrum(Wind((5, 0)), "fast", 5.0), r"omega must be a number or an array"),
    ],
)
def test_wrong_disturbances_are_refused_by_name(call, message):
    with pytest.raises(ValueError, match=message):
        call()


def test_a_wind_of_two_components_is_level():
    assert Wind((1, 2)).mean == (1.0, 2.0, 0.0)
    total = quad(lambda omega: gust_spectrum(Wind(deviation=2.0), omega, 5.0)[2], 0, np.inf)[0]
    assert total == pytest.approx(1.0, rel=1e-6)  # half of the σ


def test_rough_offsets_are_flown_in_fine_steps_only():
    """The finding: their crash rate depends on the step, 27 per 1 000 at 0.2 s and 44 at 0.02 s."""
    rough = OffsetProcess(1.0, rough=True)
    fly(straight(), SKY, LIGHT_QUADROTOR, rough, EXACT, rng=0, time_step=0.04)
    with pytest.raises(
        ValueError, match=r"time_step must be at most 0\.04 s, for rough offsets at ω_n = 1 rad/s, or crash"
    ):
        fly(straight(), SKY, LIGHT_QUADROTOR, rough, EXACT, rng=0, time_step=0.05)
    tight = replace(EXACT, controller=ADVANCED)
    with pytest.raises(ValueError, match=r"time_step must be at most 0\.025 s, for rough offsets at ω_n = 1\.6 rad/s"):
        fly(straight(), SKY, LIGHT_QUADROTOR, rough, tight, rng=0, time_step=0.03)
    fly(straight(), SKY, LIGHT_QUADROTOR, OffsetProcess(1.0), EXACT, rng=0, time_step=0.2)
