"""What flights leave behind: crash rates against exact intervals, offsets in the route's frame, columns."""

from dataclasses import replace

import numpy as np
import pytest
from places import EXACT, SKY, beside_wall, straight
from scipy.stats import binomtest

from uavlab.flight import Flight, Flights, OffsetProcess, Rate, crash_rate, fly, monte_carlo
from uavlab.flight.state import COLUMNS
from uavlab.resilience import ConditionCheck, Monitor
from uavlab.route import Route
from uavlab.spline import Curve
from uavlab.vehicle import LIGHT_QUADROTOR
from uavlab.weather import Wind


def flights_of(crashed):
    outcome = np.where(crashed, "crashed", "arrived")
    count = len(outcome)
    return Flights(
        outcome, np.ones(count), np.ones(count), np.ones(count), np.zeros((count, 3)), np.zeros((count, 0, 3))
    )


def made(outcome="arrived", reason="", rows=3):
    log = np.arange(rows * len(COLUMNS), dtype=float).reshape(rows, len(COLUMNS))
    return Flight(outcome, reason, log, 2.0, 30.0)


@pytest.mark.parametrize(("crashed", "total"), [(0, 10), (0, 1000), (1, 50), (37, 400), (49, 50), (20, 20)])
def test_the_interval_of_one_route_is_clopper_and_pearson_s(crashed, total):
    rate = crash_rate(flights_of(np.arange(total) < crashed))
    exact = binomtest(crashed, total).proportion_ci(0.95, method="exact")
    assert rate == pytest.approx((1000 * crashed / total, 1000 * exact.low, 1000 * exact.high))
    assert rate.low <= rate.per_thousand <= rate.high


def test_the_interval_holds_the_truth_at_least_95_times_of_100():
    """Over 2 000 draws of 60 flights; Clopper and Pearson's is conservative."""
    rng = np.random.default_rng(0)
    rates = [crash_rate(flights_of(rng.random(60) < 0.07)) for _ in range(2000)]
    held = np.mean([rate.low <= 70 <= rate.high for rate in rates])
    assert 0.945 < held < 0.999


@pytest.mark.parametrize("seed", range(5))
def test_over_several_routes_it_is_never_narrower_than_for_one(seed):
    rng = np.random.default_rng(seed)
    crashed = rng.random((20, 50)) < 0.1
    several, pooled = crash_rate([flights_of(row) for row in crashed]), crash_rate(flights_of(crashed.ravel()))
    assert several.per_thousand == pooled.per_thousand
    assert several.low <= pooled.low
    assert several.high >= pooled.high
    alike = crash_rate([flights_of(np.arange(50) < 5)] * 20)
    together = crash_rate(flights_of(np.tile(np.arange(50) < 5, 20)))
    assert alike.high - alike.low < 1.2 * (together.high - together.low)


def test_routes_that_differ_make_it_wider():
    """Half of them always crash: the share is that of 20 routes, not of 1 000 flights."""
    crashed = np.repeat(np.arange(20) < 10, 50).reshape(20, 50)
    several, pooled = crash_rate([flights_of(row) for row in crashed]), crash_rate(flights_of(crashed.ravel()))
    assert several.high - several.low > 5 * (pooled.high - pooled.low)
    routes = binomtest(10, 20).proportion_ci(0.95)
    assert several.low == pytest.approx(1000 * routes.low, abs=60)
    assert several.high == pytest.approx(1000 * routes.high, abs=60)


def test_no_crashes_of_many_say_more_than_of_few():
    few, many = ([flights_of(np.zeros(count, bool))] * 5 for count in (10, 1000))
    assert crash_rate(few).low == crash_rate(many).low == 0
    assert crash_rate(few).high > 1000 * (1 - 0.025 ** (1 / 50))
    assert 1000 * (1 - 0.025 ** (1 / 5000)) < crash_rate(many).high < crash_rate(few).high


def test_a_rate_reads_as_a_sentence():
    assert str(Rate(12.345, 8.0, 17.25)) == "12.3 [8, 17.2] per 1 000"


def grounded():
    return monte_carlo(straight(), SKY, replace(LIGHT_QUADROTOR, top_speed=6.0), Wind((-9, 0)), rng=0, flights=2)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: crash_rate([]), r"runs must be at least one, with as many flights each"),
        (lambda: crash_rate([flights_of([0, 1]), flights_of([0])]), r"runs must be at least one, with as many"),
        (lambda: crash_rate(grounded()), r"runs\[0\] is grounded \(head wind: 9.0 m/s .*\), and what never flew"),
        (lambda: crash_rate([flights_of([0, 1]), grounded()]), r"runs\[1\] is grounded"),
        (lambda: crash_rate([made()]), r"runs\[0\] must be a Flights, got Flight: monte_carlo"),
        (lambda: crash_rate([flights_of([0]), 3.0]), r"runs\[1\] must be a Flights, got float"),
        (lambda: made().column("height"), r"name must be one of 'time', 'x', .*, got 'height'"),
    ],
)
def test_wrong_questions_are_refused_by_name(call, message):
    with pytest.raises(ValueError, match=message):
        call()


def test_columns_are_read_by_name_and_in_groups():
    flight = made()
    for number, name in enumerate(COLUMNS):
        assert flight.column(name).tolist() == [number, number + 12, number + 24]
    assert flight.time.tolist() == [0, 12, 24]
    assert flight.position.tolist()[0] == [1, 2, 3]
    assert flight.reference.tolist()[0] == [4, 5, 6]
    assert flight.offset.tolist()[0] == [7, 8, 9]
    assert flight.duration == 24.0


def test_a_flight_tells_its_end_and_gives_its_way():
    arrived, crashed = made(), made("crashed", "crashed after 24.0 s at (1.0, 2.0, 3.0)")
    assert repr(arrived) == "<Flight: arrived after 24.0 s>"
    assert repr(crashed) == "<Flight: crashed after 24.0 s at (1.0, 2.0, 3.0)>"
    assert (arrived.route().reached, arrived.route().planner) == (True, "flown: arrived")
    assert (crashed.route().reached, crashed.route().reason) == (False, crashed.reason)
    assert np.array_equal(crashed.route().points, crashed.position)
    assert made("grounded", "too windy", rows=0).duration == 0.0
    assert len(made("grounded", "too windy", rows=0).route().points) == 0


def test_flights_count_their_ends_and_drop_what_is_not_there():
    offsets = np.array([[[1, 2, 3], [4, 5, 6]], [[7, 8, 9], [np.nan] * 3]])
    flights = replace(flights_of([True, False]), offsets=offsets)
    assert repr(flights) == "<Flights: 1 arrived, 1 crashed>"
    assert flights.crashed.tolist() == [True, False]
    assert flights.samples.tolist() == [[2, 3], [5, 6], [8, 9]]
    assert repr(grounded()) == "<Flights: 2 grounded>"


@pytest.mark.parametrize(
    ("course", "along", "left"),
    [
        ((1, 0, 0), (1, 0), (0, 1)),
        ((0, 1, 0), (0, 1), (-1, 0)),
        ((-3, 4, 0), (-0.6, 0.8), (-0.8, -0.6)),
        ((3, -4, 5), (0.6, -0.8), (0.8, 0.6)),
    ],
)
def test_offsets_are_along_the_level_course_to_its_left_and_up(course, along, left):
    """An offset that stands: 2 m east, 3 m north, 1 m down."""
    route = Route([(150, 150, 40), np.add((150, 150, 40), np.multiply(5, course))])
    flight = fly(route, SKY, LIGHT_QUADROTOR, OffsetProcess(0.0, mean=(2.0, 3.0, -1.0)), rng=0)
    expected = [np.dot(along, (2, 3)), np.dot(left, (2, 3)), -1.0]
    assert flight.offset == pytest.approx(np.tile(expected, (len(flight.log), 1)))
    assert flight.position - flight.reference == pytest.approx(np.tile([2, 3, -1], (len(flight.log), 1)))


def test_a_vertical_leg_keeps_the_course_before_it_and_east_if_there_is_none():
    mean = OffsetProcess(0.0, mean=(2.0, 3.0, -1.0))
    up = fly(Route([(50, 50, 10), (50, 50, 30)]), SKY, LIGHT_QUADROTOR, mean, rng=0)
    assert up.offset == pytest.approx(np.tile([2, 3, -1], (len(up.log), 1)))
    after = fly(Route([(50, 50, 10), (50, 90, 10), (50, 90, 40)]), SKY, LIGHT_QUADROTOR, mean, rng=0)
    assert after.offset == pytest.approx(np.tile([3, -2, -1], (len(after.log), 1)))


def test_a_flight_knows_where_it_should_have_arrived():
    """Whether it arrives, crashes, or stays on the ground; of a curve, too."""
    city, route = beside_wall(1.0)
    crash = fly(route, city, LIGHT_QUADROTOR, OffsetProcess(3.0), rng=1)
    arrived = fly(straight(), SKY, LIGHT_QUADROTOR, OffsetProcess(0.1), rng=1)
    grounded = fly(straight(), SKY, LIGHT_QUADROTOR, Wind((40.0, 0.0)), rng=1)
    curve = Curve([(20, 150, 50), (60, 150, 50), (90, 180, 60), (120, 180, 60)])
    curved = fly(curve, SKY, LIGHT_QUADROTOR, OffsetProcess(0.1), rng=1)
    outcomes = [flight.outcome for flight in (crash, arrived, grounded, curved)]
    assert outcomes == ["crashed", "arrived", "grounded", "arrived"]
    assert crash.goal == pytest.approx(route.points[-1])
    for flight in (arrived, grounded):
        assert flight.goal == pytest.approx([120, 150, 50])
    assert curved.goal == pytest.approx([120, 180, 60])


def test_a_flown_log_agrees_with_itself():
    """Speed is that of the positions, offsets those of position and reference; time goes on step by step."""
    flight = fly(straight(), SKY, LIGHT_QUADROTOR, Wind((0, 5)), EXACT, rng=0)
    assert np.array_equal(np.round(flight.time / 0.02), np.arange(len(flight.log)))
    velocity = np.linalg.norm(np.diff(flight.position, axis=0), axis=1) / 0.02
    assert flight.column("speed")[1:] == pytest.approx(velocity, abs=1e-9)
    assert flight.offset == pytest.approx(flight.position - flight.reference, abs=1e-9)  # to the east


def test_changes_of_a_crashed_flight_are_kept():
    city, route = beside_wall(2.5)
    pilot = replace(EXACT, monitor=Monitor(ConditionCheck(1.0), 1.0))
    flights = [fly(route, city, LIGHT_QUADROTOR, OffsetProcess(2.5), pilot, rng=0, number=n) for n in range(10)]
    crashed = [flight for flight in flights if flight.outcome == "crashed"]
    assert any(flight.changes for flight in crashed)
    assert all(change.time <= flight.duration + 0.02 for flight in crashed for change in flight.changes)
