"""How UAVs move in scenes: where they are when, how they lean, where their nose points."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from uavlab.flight import fly
from uavlab.plot.colors import Style
from uavlab.route import Route
from uavlab.scene.content import drawing_of
from uavlab.scene.motion import CALM, along_flight, along_route, mover, turned
from uavlab.vehicle import GRAVITY, LIGHT_QUADROTOR
from uavlab.weather import Wind

BLUE = Style("#0072B2", "-")
TRACK = 0.1
"""How far a UAV may be from the log [m] in a flight of seconds: between the rows that are kept it flies straight on."""


def flown(route, wind=CALM, safe_distance=None):
    return mover(*along_route(route, LIGHT_QUADROTOR), BLUE, LIGHT_QUADROTOR, wind, safe_distance)


def body_axes(one, moment):
    """Nose, left, and up of its body, as rows."""
    return Rotation.from_quat(one.at(moment)[1]).as_matrix().T


def test_on_a_route_it_flies_at_cruise_speed_through_all_corners():
    route = Route([(1, 2, 3), (40, 2, 3), (40, 2, 30), (40, 50, 30), (40, 50, 30), (70, 60, 10)])
    one = flown(route)
    legs = np.linalg.norm(np.diff(route.points, axis=0), axis=1)
    when = np.concatenate([[0], np.cumsum(legs)]) / LIGHT_QUADROTOR.cruise_speed
    for moment, point in zip(when, route.points, strict=True):
        assert one.at(moment)[0] == pytest.approx(point)
    moments = np.linspace(0, when[-1], 3000)
    places = np.array([one.at(moment)[0] for moment in moments])
    assert np.linalg.norm(np.diff(places, axis=0), axis=1).sum() == pytest.approx(route.length, rel=1e-3)
    assert one.at(-5.0)[0] == pytest.approx(route.points[0])
    assert one.at(1e9)[0] == pytest.approx(route.points[-1])


def test_on_a_flight_it_is_where_the_log_says_and_ends_where_it_ended(table1, crash_and_safe):
    movers = drawing_of(table1, (), flights=crash_and_safe).movers
    for flight, one in zip(crash_and_safe.values(), movers, strict=True):
        places = np.array([one.at(moment - flight.time[0])[0] for moment in flight.time])
        assert np.linalg.norm(places - flight.position, axis=1).max() < TRACK
        assert np.array_equal(one.points[[0, -1]], flight.position[[0, -1]])
        assert one.time[-1] == pytest.approx(flight.time[-1] - flight.time[0])
        assert len(one.time) <= 300


def test_rows_of_a_log_are_left_out_evenly_and_its_ends_stay(crash_and_safe):
    flight = crash_and_safe["REPARE"]
    time, points = along_flight(flight, 50)
    assert len(time) == 50
    assert np.ptp(np.diff(time)) < 0.05
    assert np.array_equal(points[[0, -1]], flight.position[[0, -1]])
    for rows in (1, 2, 3):
        short = replace(flight, log=flight.log[:rows])
        time, points = along_flight(short, 50)
        assert np.array_equal(points, short.position)
        assert np.isfinite(turned(time, points, LIGHT_QUADROTOR, CALM)).all()


@pytest.mark.parametrize("wind", [(0.0, 0.0), (-5.0, 0.0), (4.0, 0.0), (0.0, 7.0), (-3.0, 6.0), (2.0, -1.0, 1.5)])
def test_in_steady_flight_its_axis_is_along_weight_and_drag(wind):
    """tan of the lean = drag over weight; in wind from the side it leans sideways, its nose along the way."""
    route = Route([(0, 0, 50), (0, 400, 50)])
    air = Wind(wind, air_density=1.1)
    nose, left, up = body_axes(flown(route, air), 25.0)
    passing = np.array([0, LIGHT_QUADROTOR.cruise_speed, 0]) - np.array([*wind, 0.0])[:3]
    drag = 0.5 * 1.1 * LIGHT_QUADROTOR.drag_area * np.linalg.norm(passing) * passing
    force = np.add(drag, [0, 0, LIGHT_QUADROTOR.weight])
    assert up == pytest.approx(force / np.linalg.norm(force), abs=1e-3)
    if len(wind) == 2:
        lean = np.arctan2(np.linalg.norm(drag), LIGHT_QUADROTOR.weight)
        assert np.arccos(up[2]) == pytest.approx(lean, abs=1e-3)
    assert left[1] == pytest.approx(0, abs=1e-3)
    assert nose[1] > 0.9
    assert np.cross(nose, left) == pytest.approx(up)


def test_it_leans_into_turns_and_back_to_brake():
    """On a circle a = v² / r is towards its centre."""
    angle, radius, speed = np.linspace(0, 2 * np.pi, 200), 40.0, 8.0
    points = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), np.full(200, 30.0)])
    turns = turned(radius * angle / speed, points, replace(LIGHT_QUADROTOR, drag_area=1e-9), CALM)
    for at in (50, 100, 150):
        up = Rotation.from_quat(turns[at]).apply([0, 0, 1])
        expected = np.append(-points[at, :2] / radius * speed**2 / radius, GRAVITY)
        assert up == pytest.approx(expected / np.linalg.norm(expected), abs=5e-3)
        nose = Rotation.from_quat(turns[at]).apply([1, 0, 0])
        assert nose[:2] @ [-np.sin(angle[at]), np.cos(angle[at])] > 0.97
    time = np.linspace(0, 10, 200)
    braking = np.column_stack([10 * time - time**2 / 2, np.zeros(200), np.full(200, 30.0)])  # a = -1 m/s²
    up = Rotation.from_quat(turned(time, braking, replace(LIGHT_QUADROTOR, drag_area=1e-9), CALM)[100])
    assert up.apply([0, 0, 1])[0] == pytest.approx(-1 / np.hypot(1, GRAVITY), abs=5e-3)


@pytest.mark.parametrize("far", [(50.0, 0.0, 0.0), (48.0, 0.0, 0.0), (33.0, 21.0, 0.0), (0.0, 0.0, 30.0)])
def test_a_way_back_turns_it_round(far):
    there = np.array([0.5, 0.5, 5.0])
    one = flown(Route([there, there + far, there]))
    assert np.isfinite(one.turn).all()
    assert np.linalg.norm(one.turn, axis=1) == pytest.approx(np.ones(len(one.turn)))
    away, back = (body_axes(one, share * one.time[-1])[0] for share in (0.25, 0.75))
    if any(far[:2]):
        level = np.array(far) / np.linalg.norm(far)
        assert away @ level > 0.95
        assert back @ level < -0.95


def test_between_two_moments_it_turns_no_more_than_between_them():
    """Round a full circle of headings: nowhere does a body that is turned by q and then by -q tumble."""
    angle = np.linspace(0, 4 * np.pi, 400)
    points = np.column_stack([30 * np.cos(angle), 30 * np.sin(angle), np.full(400, 30.0)])
    one = mover(30 * angle / 8, points, BLUE, LIGHT_QUADROTOR, CALM, None)
    moments = np.linspace(one.time[0], one.time[-1], 5000)
    noses = np.array([body_axes(one, moment)[0] for moment in moments])
    assert np.degrees(np.arccos(np.clip((noses[1:] * noses[:-1]).sum(axis=1), -1, 1))).max() < 3.0
    ups = np.array([body_axes(one, moment)[2] for moment in moments])
    assert ups[:, 2].min() > 0.9


def test_climbing_and_hovering_keep_the_nose_where_it_was():
    one = flown(Route([(0, 0, 5), (0, -80, 5), (0, -80, 90)]))
    assert body_axes(one, one.time[-1])[0][1] < -0.99
    still = mover(np.zeros(1), np.array([[1.0, 2, 3]]), BLUE, LIGHT_QUADROTOR, CALM, None)
    for moment in (0.0, 7.0):
        place, turn = still.at(moment)
        assert place.tolist() == [1, 2, 3]
        assert turn.tolist() == [0, 0, 0, 1]


def test_body_and_ball_are_true_to_scale():
    one = flown(Route([(0, 0, 5), (9, 0, 5)]), safe_distance=3.5)
    corners = one.body.triangles.reshape(-1, 3)
    across = corners[:, None, :2] - corners[None, :, :2]
    assert np.linalg.norm(across, axis=2).max() == pytest.approx(LIGHT_QUADROTOR.diameter, rel=0.02)
    radius = np.linalg.norm(one.ball.triangles, axis=2)
    assert radius == pytest.approx(np.full(radius.shape, 3.5))
    assert one.ball.opacity < 0.5
    assert flown(Route([(0, 0, 5), (9, 0, 5)])).ball is None
    large = mover(np.zeros(1), np.zeros((1, 3)), BLUE, replace(LIGHT_QUADROTOR, diameter=4.0), CALM, None)
    assert np.ptp(large.body.triangles[..., 0]) == pytest.approx(
        4.0 / LIGHT_QUADROTOR.diameter * np.ptp(one.body.triangles[..., 0])
    )


def test_a_long_flight_is_kept_small(table1, route):
    flight = fly(route, table1, LIGHT_QUADROTOR, CALM, rng=1)
    long = replace(flight, log=np.repeat(flight.log, 40, axis=0))
    assert len(along_flight(long, 300)[0]) <= 300
