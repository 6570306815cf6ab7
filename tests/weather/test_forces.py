"""Forces against closed forms and against derivations that share nothing with them: drops, a fall, all headings."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from uavlab.vehicle import GRAVITY, LIGHT_QUADROTOR
from uavlab.weather import (
    ReferenceWind,
    Weather,
    air_density,
    lift_margin,
    rain_force,
    reachable_ground_speed,
    reference_wind,
    wind_drag,
)

speeds = st.floats(-30, 30, allow_subnormal=False)
vectors = st.tuples(speeds, speeds, speeds).map(np.array)


@pytest.mark.parametrize(
    ("temperature", "humidity", "density"),
    [
        (15.0, 0.0, 1.2250),  # International Standard Atmosphere
        (0.0, 0.0, 1.2922),
        (20.0, 0.0, 1.2041),
        (20.0, 50.0, 1.1992),  # CIPM-2007
        (30.0, 100.0, 1.1463),  # ASHRAE's table of saturated air: 1.0273 kg in 0.8962 m³
    ],
)
def test_density_is_that_of_tables(temperature, humidity, density):
    assert air_density(temperature, humidity, 1013.25) == pytest.approx(density, rel=6e-4)


@given(st.floats(-30, 50), st.floats(0, 100), st.floats(700, 1080))
def test_density_is_that_of_the_virtual_temperature(temperature, humidity, pressure):
    """With the vapour pressure of Buck (1981) in place of Magnus."""
    vapour = humidity / 100 * 6.1121 * np.exp((18.678 - temperature / 234.5) * temperature / (257.14 + temperature))
    virtual = (temperature + 273.15) / (1 - vapour / pressure * (1 - 0.62198))
    assert air_density(temperature, humidity, pressure) == pytest.approx(100 * pressure / (287.05 * virtual), rel=3e-4)


@given(st.floats(-40, 59), st.floats(0, 99), st.floats(400, 1100))
def test_warmer_and_wetter_air_is_lighter(temperature, humidity, pressure):
    density = air_density(temperature, humidity, pressure)
    assert air_density(temperature + 1, humidity, pressure) < density
    assert air_density(temperature, humidity + 1, pressure) < density
    assert air_density(temperature, humidity, pressure - 1) < density


@pytest.mark.parametrize(
    ("air", "words"),
    [
        ((288.15, 50, 1013), r"temperature_c must be from -60 to 60 °C \(kelvin\? subtract 273.15\), got 288.15"),
        ((15, 101, 1013), "humidity_percent must be from 0 to 100 %, got 101"),
        ((15, [50, -1], 1013), "humidity_percent must be from 0 to 100 %, got -1"),
        ((15, 50, 101_325), "pressure_hpa must be in hPa, got 101325, which looks like Pa: divide by 100"),
        ((15, 50, 1.0), "pressure_hpa must be from 300 to 1100 hPa, got 1"),
        ((np.nan, 50, 1013), "temperature_c must be .* got nan"),
        ((15, 50, [1013, np.nan]), "pressure_hpa must be .* got nan"),
    ],
)
def test_wrong_air_is_refused(air, words):
    with pytest.raises(ValueError, match=words):
        air_density(*air)
    if np.ndim(air[1]) == np.ndim(air[2]) == 0:
        with pytest.raises(ValueError, match=words):
            Weather(*air)


def test_rain_force_of_a_cloudburst():
    assert rain_force(100, 0.1) == pytest.approx(0.025)
    assert rain_force(100, 0.1, restitution=1.0) == pytest.approx(0.05)
    assert rain_force([0, 50, 100], 0.1, drop_speed=4.5) == pytest.approx([0, 0.00625, 0.0125])


def test_rain_force_counts_the_momentum_of_drops():
    """Drops of 3 mm, as many per cubic metre as 100 mm/h need: those that a plate of 0.1 m² meets in 300 s."""
    rng = np.random.default_rng(1)
    speed, seconds, volume = 8.0, 300.0, np.pi / 6 * 0.003**3
    per_cubic_metre = 0.1 / 3600 / volume / speed
    column = 0.4 * 0.4 * speed * seconds  # a column of air over a square that holds the plate
    x, y = rng.uniform(-0.2, 0.2, size=(2, rng.poisson(per_cubic_metre * column)))
    hits = ((np.abs(x) < 0.125) & (np.abs(y) < 0.2)).sum()
    force = hits * 1000.0 * volume * speed * (1 + 0.2) / seconds
    expected = rain_force(100, 0.1, drop_speed=speed, restitution=0.2)
    assert hits > 5000
    assert force == pytest.approx(expected, rel=4 / np.sqrt(hits))


def test_printed_rain_is_a_pressure_that_vanishes_when_drops_stick():
    assert rain_force(100, 0.1, as_printed=True) == 0
    bouncing = rain_force(100, 0.1, restitution=1.0, as_printed=True)
    assert bouncing == pytest.approx(0.25)
    assert bouncing == rain_force(100, 7.0, restitution=1.0, as_printed=True)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"rain_mm_per_h": -1}, "rain_mm_per_h must be finite and at least 0, got -1"),
        ({"rain_mm_per_h": [1, np.nan]}, "rain_mm_per_h must be finite and at least 0, got nan"),
        ({"area": 0}, "area must be finite and above 0, got 0"),
        ({"drop_speed": -9}, "drop_speed must be finite and above 0, got -9"),
        ({"restitution": 1.1}, r"restitution must be from 0 to 1 \(0: drops stick, 1: they bounce back\), got 1.1"),
    ],
)
def test_wrong_rain_is_refused(arguments, words):
    with pytest.raises(ValueError, match=words):
        rain_force(**({"rain_mm_per_h": 10, "area": 0.1} | arguments))


def test_lift_margin_puts_the_rain_under_the_safety_factor():
    uav = LIGHT_QUADROTOR.loaded(0.6)
    assert lift_margin(uav) == pytest.approx(28 - 1.1 * 2.1 * 9.81)
    assert lift_margin(uav, 1.0, safety_factor=1.5) == pytest.approx(28 - 1.5 * (2.1 * 9.81 + 1.0))
    printed = lift_margin(uav, [0, 2], as_printed=True) - lift_margin(uav, [0, 2])
    assert printed == pytest.approx([0, 0.2])


def test_rain_weighs_less_than_any_payload():
    """Note 2 under REPARE Table 3 grounds the UAV when rain outweighs its payload: it takes metres of water an hour."""
    assert rain_force(100, LIGHT_QUADROTOR.rain_area) < 0.0026 * GRAVITY
    assert rain_force(9_000, LIGHT_QUADROTOR.rain_area) < 0.25 * GRAVITY < rain_force(10_000, LIGHT_QUADROTOR.rain_area)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"rain": -1}, "rain must be finite and at least 0, got -1"),
        ({"safety_factor": 0.9}, "safety_factor must be finite and at least 1, got 0.9"),
        ({"safety_factor": np.nan}, "safety_factor must be finite and at least 1, got nan"),
    ],
)
def test_wrong_lift_is_refused(arguments, words):
    with pytest.raises(ValueError, match=words):
        lift_margin(LIGHT_QUADROTOR, **arguments)


def test_reference_wind_is_the_stronger_mean_and_the_stronger_gust():
    assert reference_wind(4, 6) == ReferenceWind(6, 10.5)
    assert reference_wind(6, 4, 12) == ReferenceWind(6, 12)
    assert reference_wind(6, 4, 12, gust_factor=2.5) == ReferenceWind(6, 15)
    assert reference_wind(6, 4, 12, as_printed=True) == ReferenceWind(6, 6)


@pytest.mark.parametrize(
    ("winds", "words"),
    [
        ((-1, 0, 0), "forecast_mean must be finite and at least 0, got -1"),
        (([1, 2], 0, 0), r"forecast_mean must be one number, got an array of shape \(2,\)"),
        ((0, np.nan, 0), "measured_mean must be .* got nan"),
        ((0, 0, np.inf), "forecast_max must be .* got inf"),
    ],
)
def test_wrong_winds_are_refused(winds, words):
    with pytest.raises(ValueError, match=words):
        reference_wind(*winds)


def test_gust_factor_below_one_is_refused():
    with pytest.raises(ValueError, match="gust_factor must be finite and at least 1, got 0"):
        reference_wind(1, 1, gust_factor=0.5)


@pytest.mark.parametrize(
    ("wind", "course", "speed"),
    [
        ((5, 0), (1, 0), 20),  # tail wind
        ((-5, 0), (3, 0), 10),  # head wind
        ((0, 9), (1, 0), 12),  # cross wind: 9, 12, 15
        ((0, 0, 0), (0, 0, 1), 15),
        ((-20, 0), (1, 0), -5),  # blown backwards
        ((0, 15), (1, 0), 0),
    ],
)
def test_ground_speed_in_simple_winds(wind, course, speed):
    assert reachable_ground_speed(15, wind, course) == pytest.approx(speed, abs=1e-6)


def test_ground_speed_is_the_best_of_all_headings():
    """Every heading in the plane, a thousandth of a degree apart: those that stay on the course, and the fastest."""
    rng = np.random.default_rng(4)
    angles = np.radians(np.arange(0, 360, 0.001))
    headings = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    for _ in range(10):
        wind, course = rng.uniform(-8, 8, 2), rng.normal(size=2)
        course /= np.linalg.norm(course)
        ground = 14.0 * headings + wind
        along = ground @ course
        drift = np.abs(ground[:, 0] * course[1] - ground[:, 1] * course[0])
        assert reachable_ground_speed(14.0, wind, course) == pytest.approx(along[drift < 5e-4].max(), abs=2e-3)


@given(st.floats(1, 40), vectors, vectors)
def test_ground_speed_is_at_most_both_speeds_together(air_speed, wind, course):
    assume(np.linalg.norm(course) > 1e-3)
    assume(np.linalg.norm(wind) < air_speed)
    reached = reachable_ground_speed(air_speed, wind, course)
    assert reached <= air_speed + np.linalg.norm(wind) + 1e-9
    assert reached >= air_speed - np.linalg.norm(wind) - 1e-9
    direction = course / np.linalg.norm(course)
    assert np.linalg.norm(reached * direction - wind) == pytest.approx(air_speed)  # the triangle closes


def test_ground_speed_over_many_courses():
    courses = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]])
    assert reachable_ground_speed(5, (3, 0), courses) == pytest.approx([8, 4, 2])


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((15, (0, 16), (1, 0)), "crosswind of 16.0 m/s is above air_speed 15 m/s: no heading holds the course"),
        ((0, (0, 1), (1, 0)), "air_speed must be finite and above 0, got 0"),
        ((15, (0, np.nan), (1, 0)), "wind must be finite, got"),
        ((15, (0, 1), (0, 0)), "course must be a direction, got one of length 0"),
        ((15, (0, 1), (1, np.inf)), "course must be finite"),
        ((15, (0, 1), (1, 0, 0)), r"as many components, got shapes wind \(2,\), course \(3,\)"),
        ((15, 3.0, (1, 0)), r"wind must be a vector \(east, north\) or \(east, north, up\), got shape \(\)"),
    ],
)
def test_wrong_triangles_are_refused(arguments, words):
    with pytest.raises(ValueError, match=words):
        reachable_ground_speed(*arguments)


def test_drag_at_ten_metres_a_second():
    right = wind_drag((0, 0), (10, 0), 0.05, air_density=1.2)
    assert right == pytest.approx([-3.0, 0])
    assert wind_drag((0, 0), (10, 0), 0.05, air_density=1.2, as_printed=True) == pytest.approx([0.3, 0])


def test_printed_drag_ignores_the_wind():
    assert wind_drag((10, 0), (0, 0), 0.05, as_printed=True) == pytest.approx([0, 0])
    assert wind_drag((10, 0), (0, 0), 0.05) == pytest.approx([0.5 * 1.225 * 0.05 * 100, 0])


@given(vectors, vectors)
def test_drag_is_antisymmetric_and_along_the_relative_wind(wind, velocity):
    drag = wind_drag(wind, velocity, 0.05)
    assert wind_drag(velocity, wind, 0.05) == pytest.approx(-drag)
    assert np.linalg.norm(drag) == pytest.approx(0.030625 * np.linalg.norm(wind - velocity) ** 2)
    assert drag @ (wind - velocity) >= 0


def test_drag_of_a_falling_body_is_that_of_the_closed_form():
    """v = v_t tanh(g t/v_t), h = v_t²/g ln cosh(g t/v_t), solved with the library's drag in three dimensions."""
    uav, calm = LIGHT_QUADROTOR, np.zeros(3)

    def motion(time, state):
        force = wind_drag(calm, state[3:], uav.drag_area) - [0, 0, uav.weight]
        return np.concatenate([state[3:], force / uav.mass])

    end = solve_ivp(motion, (0, 4), np.zeros(6), rtol=1e-10, atol=1e-10).y[:, -1]
    terminal = np.sqrt(2 * uav.weight / (1.225 * uav.drag_area))
    assert terminal == pytest.approx(20.0, abs=0.05)
    assert end[5] == pytest.approx(-terminal * np.tanh(GRAVITY * 4 / terminal), rel=1e-8)
    assert end[2] == pytest.approx(-(terminal**2) / GRAVITY * np.log(np.cosh(GRAVITY * 4 / terminal)), rel=1e-8)
    assert end[[0, 1, 3, 4]] == pytest.approx(0)


def test_drag_carries_a_body_along_with_the_wind():
    """u' = −k u² for the relative speed: u = u₀/(1 + k u₀ t)."""
    uav, wind = LIGHT_QUADROTOR, np.array([6.0, 8.0])

    def motion(time, velocity):
        return wind_drag(wind, velocity, uav.drag_area) / uav.mass

    end = solve_ivp(motion, (0, 20), np.zeros(2), rtol=1e-10, atol=1e-12).y[:, -1]
    k = 0.5 * 1.225 * uav.drag_area / uav.mass
    assert np.linalg.norm(wind - end) == pytest.approx(10 / (1 + k * 10 * 20), rel=1e-8)


def test_drag_over_many_winds():
    winds = np.array([[1.0, 0, 0], [0, 2.0, 0], [0, 0, -3.0]])
    assert wind_drag(winds, (0, 0, 0), 2.0, air_density=1.0) == pytest.approx(np.diag([1.0, 4.0, -9.0]))


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"drag_area": 0}, "drag_area must be finite and above 0, got 0"),
        ({"air_density": -1.2}, "air_density must be finite and above 0, got -1.2"),
        ({"wind": (np.nan, 0)}, "wind must be finite, got"),
        ({"wind": np.full((1000, 2), np.nan)}, r"wind must be finite, got \[nan, nan\]$"),  # one of them is enough
        ({"wind": [("calm", 0)]}, "wind must be a number or an array of numbers: got text"),
        ({"ground_velocity": (0, np.inf)}, "ground_velocity must be finite, got"),
        ({"wind": (1, 0, 0)}, "as many components"),
        ({"wind": (1, 0, 0, 0)}, "wind must be a vector"),
    ],
)
def test_wrong_drag_is_refused(arguments, words):
    with pytest.raises(ValueError, match=words):
        wind_drag(**({"wind": (1, 0), "ground_velocity": (0, 0), "drag_area": 0.05} | arguments))


@pytest.mark.parametrize("as_printed", [False, True])
@pytest.mark.parametrize("count", [3, 4])  # 3 is also the number of components
def test_each_drag_has_its_own_density(count, as_printed):
    winds, density = np.arange(3.0 * count).reshape(count, 3), np.linspace(1.0, 1.3, count)
    together = wind_drag(winds, -winds, 0.05, air_density=density, as_printed=as_printed)
    one_by_one = [
        wind_drag(wind, -wind, 0.05, air_density=float(rho), as_printed=as_printed)
        for wind, rho in zip(winds, density, strict=True)
    ]
    assert together == pytest.approx(np.array(one_by_one))


def test_weather_joins_what_belongs_to_it():
    weather = Weather(forecast_wind=6, measured_wind=4, forecast_max_wind=12, wind_from_deg=270)
    assert weather.reference_wind == ReferenceWind(6, 12)
    assert weather.air_density == pytest.approx(air_density(15, 50, 1013.25))
    assert weather.wind_direction == pytest.approx([1, 0])  # a west wind blows to the east
    assert Weather(wind_from_deg=0).wind_direction == pytest.approx([0, -1])
    assert Weather(wind_from_deg=90).wind_direction == pytest.approx([-1, 0])


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"forecast_wind": -1}, "forecast_wind must be finite and at least 0, got -1"),
        ({"forecast_max_wind": np.nan}, "forecast_max_wind must be"),
        ({"measured_wind": np.inf}, "measured_wind must be"),
        ({"rain_mm_per_h": -0.5}, "rain_mm_per_h must be finite and at least 0, got -0.5"),
        ({"radiation": -10}, "radiation must be"),
        ({"radiation": "bright"}, "radiation must be a number or an array of numbers: got text, 'bright'"),
        ({"rain_mm_per_h": "5"}, "rain_mm_per_h must be a number"),  # NumPy would take it for 5.0
        ({"measured_wind": None}, "measured_wind must be a number .* got None"),
        ({"measured_wind": np.array([3.0, 4.0])}, r"measured_wind must be one number, .* shape \(2,\)"),
        ({"wind_from_deg": 361}, "wind_from_deg must be from 0 to 360 degrees, got 361"),
        ({"wind_from_deg": np.nan}, "wind_from_deg must be from 0 to 360 degrees, got nan"),
    ],
)
def test_wrong_weather_is_refused(values, words):
    with pytest.raises(ValueError, match=words):
        Weather(**values)
