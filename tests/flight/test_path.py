"""Plans of speed against what was asked for, and why a UAV stays on the ground."""

from dataclasses import replace

import numpy as np
import pytest
from places import EXACT, SKY, straight
from scipy.spatial.transform import Rotation

from uavlab.flight import OffsetProcess, fly, monte_carlo
from uavlab.flight.path import BANK, BRAKING, TURN_JUMP, planned_speed, vehicle_in
from uavlab.flight.reference import speed_at, steps_to_goal
from uavlab.flight.simulation import setup_of
from uavlab.resilience import ADVANCED, Controller
from uavlab.route import Route
from uavlab.spline import Curve
from uavlab.vehicle import GRAVITY, LIGHT_QUADROTOR, RISK_QUADROTOR
from uavlab.weather import Weather, Wind, grounded_by, rain_force, reachable_ground_speed
from uavlab.weather.envelope import CREEP
from uavlab.weather.wind import gust_deviations, why_grounded

CALM = Wind(gusts="none")
BREEZE = Wind((-3.0, 5.0, 0.5), rain_mm_per_h=20.0)


def wanderings(seed, count=12):
    """Waypoints of a random walk with legs from a few centimetres to 40 m."""
    rng = np.random.default_rng(seed)
    legs = rng.standard_normal((count, 3)) * [1, 1, 0.4]
    legs *= 10 ** rng.uniform(-1.3, 1.6, (count, 1)) / np.linalg.norm(legs, axis=1, keepdims=True)
    return Route(np.cumsum(np.vstack([[300, 150, 50], legs]), axis=0))


def speeds_along(path, step=0.01):
    """Distances [m] and planned speeds [m/s] along a path."""
    distance = np.arange(0, path.distance[-1], step)
    legs = np.clip(np.searchsorted(path.distance, distance, side="right") - 1, 0, len(path.on_legs) - 1)
    return distance, legs, np.array([speed_at(path, s, leg) for s, leg in zip(distance, legs, strict=True)])


@pytest.mark.parametrize("seed", range(8))
def test_planned_speeds_are_within_what_is_asked_and_what_brakes_hold(seed):
    route = wanderings(seed)
    path = planned_speed(route, LIGHT_QUADROTOR, BREEZE, 9.0)
    distance, legs, speeds = speeds_along(path)
    reachable = reachable_ground_speed(LIGHT_QUADROTOR.top_speed, BREEZE.mean, path.direction)
    assert (speeds <= np.minimum(9.0, reachable)[legs] + 1e-12).all()
    assert (speeds > 0).all()
    gained = np.diff(speeds**2) / (2 * np.diff(distance))  # d(v²/2)/ds is the acceleration
    assert abs(gained).max() < path.braking + 1e-6
    assert path.braking <= BRAKING
    assert speeds[0] == CREEP
    assert speeds[-1] == pytest.approx(np.sqrt(CREEP**2 + 2 * path.braking * (path.distance[-1] - distance[-1])))


@pytest.mark.parametrize("seed", range(8))
def test_the_velocity_jumps_little_at_corners(seed):
    path = planned_speed(wanderings(seed), LIGHT_QUADROTOR, CALM, 9.0)
    turned = np.linalg.norm(np.diff(path.direction, axis=0), axis=1)
    jumps = path.at_points[1:-1] * turned
    assert (jumps <= np.maximum(TURN_JUMP, CREEP * turned) + 1e-9).all()
    assert jumps.max() > 0.3


def test_a_corner_far_from_others_is_passed_with_just_that_jump():
    path = planned_speed(Route([(0, 0, 9), (80, 0, 9), (80, 80, 9)]), LIGHT_QUADROTOR, CALM, 5.0)
    assert path.at_points == pytest.approx([CREEP, TURN_JUMP / np.sqrt(2), CREEP])


@pytest.mark.parametrize("uav", [LIGHT_QUADROTOR, LIGHT_QUADROTOR.loaded(1.2)], ids=["bank", "thrust"])
def test_on_a_dense_arc_the_lateral_acceleration_is_what_bank_or_half_the_thrust_holds(uav):
    radius, angle = 12.0, np.linspace(0, np.pi, 300)
    wind = Wind((0, 8))
    arc = Route(np.column_stack([radius * np.cos(angle), radius * np.sin(angle), np.full(300, 30.0)]))
    path = planned_speed(arc, uav, wind, 15.0)
    drag = 0.5 * 1.225 * uav.drag_area * 8.0**2
    held = 0.5 * (float(uav.horizontal_reserve()) - drag) / (uav.weight / GRAVITY)
    assert (held < GRAVITY * np.tan(BANK)) == (uav.payload > 0)
    lateral = path.at_points**2 / radius
    assert lateral.max() == pytest.approx(min(held, GRAVITY * np.tan(BANK)), rel=1e-3)


def test_a_dense_straight_line_is_flown_like_one_leg():
    """However near its waypoints stand, as those of a curve do, it gathers speed and brakes all the way."""
    plans = [planned_speed(route, LIGHT_QUADROTOR, CALM, 5.0) for route in (straight(), straight().resample(0.1))]
    (_, _, one), (_, _, dense) = map(speeds_along, plans)
    assert dense == pytest.approx(one, abs=1e-6)
    assert one.max() == 5.0


def test_a_curve_slows_down_well_before_its_end():
    curve = Curve([(20, 20, 30), (40, 20, 30), (60, 40, 35), (60, 80, 30)])
    flight = fly(curve, SKY, LIGHT_QUADROTOR, CALM, EXACT, rng=0)
    speeds = np.linalg.norm(np.diff(flight.reference, axis=0), axis=1) / 0.02
    assert flight.outcome == "arrived"
    assert abs(np.diff(speeds)[:-1]).max() / 0.02 < 1.2 * BRAKING  # steps of 0.02 s look a little ahead
    assert flight.reference[-1] == pytest.approx((60, 80, 30))
    assert speeds.max() == pytest.approx(5.0)


def test_head_wind_slows_to_what_the_top_speed_leaves():
    limits = [planned_speed(straight(), LIGHT_QUADROTOR, Wind(wind), 16.0).on_legs[0] for wind in ((-9, 0), (9, 0))]
    assert limits == [18 - 9, 16]
    across = planned_speed(straight(), LIGHT_QUADROTOR, Wind((0, 12)), 16.0).on_legs[0]
    assert across == pytest.approx(np.sqrt(18**2 - 12**2))
    durations = [fly(straight(), SKY, LIGHT_QUADROTOR, Wind((wind, 0)), EXACT, rng=0).duration for wind in (-15, 0)]
    assert durations[0] > 1.4 * durations[1]  # 3 m/s in place of 5


WEAK = replace(LIGHT_QUADROTOR, thrust=17.0, max_tilt=np.radians(20))
SLOW = replace(LIGHT_QUADROTOR, top_speed=6.0)


@pytest.mark.parametrize(
    ("uav", "wind", "reason"),
    [
        (LIGHT_QUADROTOR.loaded(1.2), CALM, "lift: 1.14 N short of 1.1 times weight and rain"),
        (WEAK, Wind((0, 10.0)), "gusts: 13.0 m/s, and the thrust left over holds 12.1 m/s"),
        (SLOW, Wind((-1, 7.0)), "head wind: 7.1 m/s of 6.0 m/s air speed leave less than 0.1 m/s"),
        (LIGHT_QUADROTOR, Wind((0, 9.0), "dryden"), ""),
    ],
    ids=["lift", "gusts", "head wind", "none"],
)
def test_one_rule_grounds_flights_and_weather(uav, wind, reason):
    """What `grounded_by` says of a weather with this wind and its gusts."""
    found = "; ".join(why_grounded(uav, wind, 30.0))
    assert found == reason
    gust = wind.speed + 3 * gust_deviations(wind, 30.0)[0]
    weather = Weather(forecast_wind=wind.speed, forecast_max_wind=gust)
    by_weather = grounded_by(uav, weather, ground_speed=CREEP)
    assert bool(by_weather) == bool(found)
    flight = fly(straight(), SKY, uav, wind, rng=0)
    assert fly(straight(), SKY, uav, wind, replace(EXACT, heeds_limits=False), rng=0).duration > 0
    if not found:
        assert flight.outcome == "arrived"
        return
    flights = monte_carlo(straight(), SKY, uav, wind, rng=0, flights=3)
    assert (flight.outcome, flight.reason) == ("grounded", found)
    assert (flights.outcome.tolist(), flights.reason) == (["grounded"] * 3, found)
    assert (flight.duration, flight.energy, len(flight.log), flight.clearance) == (0.0, None, 0, np.inf)
    assert not flights.crashed.any()
    assert flights.samples.shape == (0, 2)
    assert repr(flight) == f"<Flight: grounded: {found}>"


def test_the_limit_of_gusts_ends_where_the_reserve_is_used_up():
    reserve = WEAK.horizontal_reserve(rain_force(30, WEAK.rain_area))
    assert vehicle_in(WEAK, Wind(rain_mm_per_h=30)).held == pytest.approx(reserve)
    most = np.sqrt(reserve / (0.5 * 1.225 * WEAK.drag_area)) - 3.0  # gusts of σ = 1 m/s
    assert why_grounded(WEAK, Wind((0, most - 1e-6), rain_mm_per_h=30), 30.0) == ()
    assert why_grounded(WEAK, Wind((0, most + 1e-6), rain_mm_per_h=30), 30.0)[0].startswith("gusts: ")


@pytest.mark.parametrize("slope", [1.0, -1.0, 0.1, -0.3])
def test_it_climbs_and_sinks_no_faster_than_it_can(slope):
    route = Route([(50, 50, 50), (50 + 40, 50, 50 + 40 * slope)])
    path = planned_speed(route, LIGHT_QUADROTOR, CALM, 15.0)
    limit = LIGHT_QUADROTOR.climb_speed if slope > 0 else LIGHT_QUADROTOR.sink_speed
    vertical = path.on_legs[0] * abs(path.direction[0, 2])
    assert vertical == pytest.approx(min(limit, 15.0 * abs(path.direction[0, 2])))
    flight = fly(route, SKY, LIGHT_QUADROTOR, CALM, replace(EXACT, speed=15.0), rng=0)
    assert abs(np.diff(flight.position[:, 2])).max() / 0.02 < 1.1 * limit


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("controller", [EXACT.controller, ADVANCED, Controller("odd", 0.7, 1.0)], ids=lambda c: c.name)
@pytest.mark.parametrize("disturbance", [CALM, OffsetProcess(0.1)], ids=["wind", "offsets"])
def test_steps_to_the_goal_are_the_steps_flown(seed, controller, disturbance):
    pilot = replace(EXACT, controller=controller)
    setup, _ = setup_of(wanderings(seed), SKY, LIGHT_QUADROTOR, disturbance, pilot, 0.02)
    flight = fly(wanderings(seed), SKY, LIGHT_QUADROTOR, disturbance, pilot, rng=0)
    assert len(flight.log) == steps_to_goal(setup.path, controller.speed_share, 0.02)
    assert flight.outcome == "arrived"
    assert flight.reference[0] == pytest.approx(wanderings(seed).points[0])
    assert flight.reference[-1] == pytest.approx(wanderings(seed).points[-1])
    assert flight.time == pytest.approx(0.02 * np.arange(len(flight.log)))


def test_offsets_fly_at_constant_speed_whatever_the_turns():
    flight = fly(wanderings(1), SKY, LIGHT_QUADROTOR, OffsetProcess(0.0), EXACT, rng=0)
    assert flight.duration == pytest.approx(wanderings(1).length / 5.0, abs=0.02)


def test_waypoints_that_stand_twice_change_nothing():
    twice = Route(np.repeat(wanderings(2).points, 2, axis=0))
    plain, doubled = (fly(route, SKY, LIGHT_QUADROTOR, BREEZE, rng=4) for route in (wanderings(2), twice))
    assert np.array_equal(plain.log, doubled.log)


def test_turning_a_route_turns_its_plan():
    turn = Rotation.from_euler("z", 0.8)
    route, wind = wanderings(3), np.array(BREEZE.mean)
    plan = planned_speed(route, RISK_QUADROTOR, BREEZE, 9.0)
    turned = planned_speed(
        Route(turn.apply(route.points)), RISK_QUADROTOR, replace(BREEZE, mean=tuple(turn.apply(wind))), 9.0
    )
    assert turned.at_points == pytest.approx(plan.at_points)
    assert turned.on_legs == pytest.approx(plan.on_legs)
