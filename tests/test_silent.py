"""What was taken silently and came out wrong: small integers, masks, texts for flags, classes, counts without end."""

import gc
import weakref
from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import norm

from uavlab import scene
from uavlab.city import City
from uavlab.flight import Autopilot, OffsetProcess, fly, monte_carlo
from uavlab.offsets import crossing_rate, joint, magnitude
from uavlab.optimizers import bas, pso, pso_bas
from uavlab.planners import (
    ant_colony,
    astar,
    flight_conditions,
    hazard_price,
    least_risk,
    penalty_zone,
    repare,
    repare_price,
    waypoint_swarm,
)
from uavlab.resilience import Controller
from uavlab.risk import RiskMap, ballistic_fall, fall_speed, person_rate, random_campus
from uavlab.route import Route
from uavlab.scene.shapes import tube
from uavlab.spline import Curve, basis_functions, feasibility
from uavlab.spline.basis import fitted, subdivided
from uavlab.vehicle import LIGHT_QUADROTOR, RISK_QUADROTOR, UAV
from uavlab.weather import Weather, Wind, lift_margin, rain_force, reference_wind, wind_drag

OPEN = City(np.zeros((20, 20, 10), bool))
ENDS = (1.5, 1.5, 5.5), (18.5, 18.5, 5.5)
LINE = Route(ENDS)
FLOWN = LINE, OPEN, LIGHT_QUADROTOR, Wind()
FLAT = RiskMap(OPEN, 0.01, 0.5, safe_height=0.0)

NARROW = (np.int8, np.uint8, np.int16, np.float16, np.float32, np.int64)

SCALED = {
    "fatalities": lambda x: FLAT.fatalities(LINE, speed=x),
    "horizontal_reserve": lambda x: UAV(1, 40, 0.05, 0.1, 0.5, 5, 10).horizontal_reserve(x),
    "thrust": lambda x: UAV(0.5, x, 0.05, 0.1, 0.5, x, x, battery=x).horizontal_reserve(),
    "payload": lambda x: replace(LIGHT_QUADROTOR, mass=x / 10, thrust=70.0).weight,
    "weather": lambda x: Weather(temperature_c=x, humidity_percent=x, forecast_wind=x).air_density,
    "reference_wind": lambda x: reference_wind(x, x, x),
    "rain_force": lambda x: rain_force(x, x, drop_speed=x),
    "wind_drag": lambda x: wind_drag((x, x), (0, 0), x),
    "person_rate": lambda x: person_rate(x, 0.01, 0.5, speed=x),
    "ballistic_fall": lambda x: ballistic_fall(x, speed=x).drift,
    "magnitude": lambda x: magnitude(x, x).mean(),
    "crossing_rate": lambda x: crossing_rate(x, x, x),
    "hazard_price": lambda x: hazard_price(OPEN, x, speed=x, crash_price=x),
    "penalty_zone": lambda x: penalty_zone(OPEN, x, penalty=x),
    "astar": lambda x: astar(OPEN, *ENDS, min_clearance=x / 10, max_height=x).length,
    "least_risk": lambda x: least_risk(FLAT, *ENDS, length_weight=x, max_length=x * 10).cost,
    "feasibility": lambda x: feasibility(Curve(ENDS), OPEN, LIGHT_QUADROTOR, speed=x)["tilt"].worst,
    "fly": lambda x: fly(LINE, OPEN, LIGHT_QUADROTOR, Wind(), Autopilot(speed=x / 3), rng=1).duration,
}


@pytest.mark.parametrize("ask", SCALED.values(), ids=SCALED)
def test_numpy_scalars_of_any_width_count_as_the_numbers_that_they_are(ask):
    """The finding: fatalities(speed=int16(10)) is -2.9e-11, UAV(thrust=uint8(28)) has no reserve."""
    for kind in NARROW:
        assert ask(kind(10)) == pytest.approx(ask(10.0), rel=5e-3 if kind is np.float16 else 1e-6), kind


FLAGGED = {
    "fall_speed": lambda flag: fall_speed(30.0, as_printed=flag),
    "person_rate": lambda flag: person_rate(30.0, as_printed=flag),
    "RiskMap": lambda flag: replace(FLAT, as_printed=flag),
    "rain_force": lambda flag: rain_force(5.0, 0.1, as_printed=flag),
    "lift_margin": lambda flag: lift_margin(LIGHT_QUADROTOR, as_printed=flag),
    "reference_wind": lambda flag: reference_wind(1.0, 2.0, as_printed=flag),
    "wind_drag": lambda flag: wind_drag((1, 0), (0, 0), 0.1, as_printed=flag),
    "safety_domain": lambda flag: joint.safety_domain(np.random.default_rng(0).normal(size=(50, 2)), as_printed=flag),
    "astar": lambda flag: astar(OPEN, *ENDS, price=np.ones(OPEN.shape), as_printed=flag),
    "repare": lambda flag: repare(OPEN, *ENDS, as_printed=flag),
    "ant_colony": lambda flag: ant_colony(FLAT, *ENDS, rng=0, budget=20, as_printed=flag),
    "waypoint_swarm": lambda flag: waypoint_swarm(FLAT, *ENDS, rng=0, budget=400, as_printed=flag),
    "feasibility": lambda flag: feasibility(Curve(ENDS), OPEN, LIGHT_QUADROTOR, as_printed=flag),
    "basis_functions": lambda flag: basis_functions(0.5, [0, 0, 1, 1], 1, as_printed=flag),
    **{
        search.__name__: lambda flag, search=search: search(
            lambda x: (x**2).sum(axis=1), [(-1, 1)] * 2, 60, 0, as_printed=flag
        )
        for search in (pso, bas, pso_bas)
    },
}


@pytest.mark.parametrize("ask", FLAGGED.values(), ids=FLAGGED)
def test_a_flag_is_true_or_false_and_no_text(ask):
    for wrong in ("False", "no", 2, None):
        with pytest.raises(ValueError, match="as_printed must be True or False, got"):
            ask(wrong)
    ask(np.bool_(True))


MASKED = np.ma.masked_array([1.0, 2.0, 3.0], [False, True, False])
MASKED_MAP = np.ma.masked_array(np.ones(OPEN.shape), np.arange(OPEN.occupied.size).reshape(OPEN.shape) == 7)


@pytest.mark.parametrize(
    "ask",
    [
        lambda: rain_force(MASKED, 0.1),
        lambda: astar(OPEN, MASKED, ENDS[1]),
        lambda: astar(OPEN, *ENDS, price=MASKED_MAP),
        lambda: penalty_zone(OPEN, MASKED_MAP, penalty=1.0),
        lambda: Route([MASKED, (4.0, 5.0, 6.0)]),
        lambda: LINE.integral(OPEN, MASKED_MAP),
        lambda: RiskMap(OPEN, np.ma.masked_array(np.full((20, 20), 0.01), np.eye(20, dtype=bool)), 0.5),
        lambda: City(np.ma.masked_array(np.zeros((2, 2, 2), bool), np.eye(2, dtype=bool)[..., None] & [True, False])),
        lambda: wind_drag(MASKED, (0, 0, 0), 0.1),
        lambda: Curve(np.ma.masked_array(np.zeros((3, 3)), np.eye(3, dtype=bool))),
    ],
)
def test_masks_are_refused_where_nothing_says_what_is_missing(ask):
    with pytest.raises(ValueError, match="masked"):
        ask()


@pytest.mark.parametrize("wrong", [10**400, None, "3", 3 + 1j, np.datetime64("2026-01-01"), b"3", [1, [2, 3]]])
def test_what_is_no_number_is_named(wrong):
    with pytest.raises(ValueError, match="rain_mm_per_h must be a number or an array of numbers"):
        rain_force(wrong, 0.1)


def test_the_class_of_a_disturbance_is_no_disturbance():
    """The finding: called with the time it makes one whose σ is the time."""
    for kind in (OffsetProcess, Wind):
        with pytest.raises(
            ValueError, match=rf"disturbance must be one {kind.__name__}, as {kind.__name__}\(\), got its"
        ):
            monte_carlo(LINE, OPEN, LIGHT_QUADROTOR, kind, rng=1, flights=2)


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda: pso(lambda x: x[:, 0], [(0, 1)], 10**30, 0), r"budget must be at most 1,000,000,000, .* got 1e\+30"),
        (lambda: ant_colony(FLAT, *ENDS, rng=0, budget=10**30), "budget must be at most 1,000,000,000"),
        (
            lambda: monte_carlo(LINE, OPEN, LIGHT_QUADROTOR, Wind(), rng=0, flights=10**8),
            "flights must be at most 1,000,000",
        ),
        (
            lambda: fly(LINE, OPEN, LIGHT_QUADROTOR, Wind(), rng=0, time_step=1e-300),
            r"time_step of 1e-300 s makes .* steps",
        ),
        (
            lambda: fly(LINE, OPEN, LIGHT_QUADROTOR, Wind(), rng=0, time_step=1e-7),
            "of which at most 5,000,000 are made",
        ),
        (
            lambda: fly(*FLOWN, Autopilot(controller=Controller("x", 1e-300, 1.0)), rng=0),
            "the controller's speed_share must be from 0.01",
        ),
        (lambda: ballistic_fall(1e18), "height must be from 0 to 50000 m"),
        (lambda: LINE.to_csv(2), "path must be the name of a file, got 2"),
        (lambda: pso(lambda x: x[:, 0], [(0, 1)], True, 0), "budget must be a whole number"),
    ],
)
def test_what_would_never_end_or_write_elsewhere_is_refused(ask, message):
    with pytest.raises(ValueError, match=message):
        ask()


def test_prices_are_kept_for_a_city_can_not_be_written_to_and_go_with_it():
    """The findings: p[:] = 1 changed what the planner later took, and the cache kept deleted cities alive."""
    city = random_campus(0).city
    now = flight_conditions("light", "mild")
    for price in (hazard_price(city, 0.3), repare_price(city, now)):
        with pytest.raises(ValueError, match="read-only"):
            price[:] = 1.0
    assert hazard_price(city, 0.3) is hazard_price(city, 0.3)
    assert repare_price(city, now) is repare_price(city, now)
    for sigma in (0.4, 0.5, 0.6, 0.7):
        hazard_price(city, sigma)
    alive, kept = weakref.ref(city), weakref.ref(hazard_price(city, 0.7))
    del city, price
    gc.collect()
    assert alive() is None
    assert kept() is None


@pytest.mark.parametrize("ratio", [5.0, 29.9, 30.1, 38.7, 100.0, 1e6])
def test_the_law_of_the_distance_goes_on_where_rice_s_overflows(ratio):
    """The finding: its mean is NaN from a mean offset of 38.75 σ on."""
    law, drawn = magnitude(0.5, 0.5 * ratio), np.random.default_rng(0).normal((ratio, 0.0), 1.0, (200_000, 2))
    sample = 0.5 * np.hypot(*drawn.T)
    assert law.mean() == pytest.approx(sample.mean(), abs=0.01)
    assert law.std() == pytest.approx(sample.std(), abs=0.005)
    assert law.cdf(0.5 * ratio) == pytest.approx(norm.cdf(-0.5 / ratio), abs=2e-3 if ratio > 20 else 0.02)


def test_what_is_right_is_taken():
    """NumPy scalars for lengths, lists for points."""
    for distance in (np.int64(3), np.float32(3), 3):
        scene.page(OPEN, LINE, safe_distance=distance)
    points = [[0.0, 0.0, 0.0], [5.0, 1.0, 0.0], [9.0, 9.0, 1.0]]
    assert np.array_equal(fitted(points, 4), fitted(np.array(points), 4))
    assert np.array_equal(subdivided(points), subdivided(np.array(points)))
    assert np.array_equal(tube(points, 0.1), tube(np.array(points), 0.1))
    assert RISK_QUADROTOR.loaded(np.float32(0.5)).payload == 0.5
