"""UAVs in a scene: where they are at each moment, and how they lean."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from uavlab.city import City
from uavlab.flight import OffsetProcess, fly
from uavlab.planners import astar
from uavlab.plot.colors import Style
from uavlab.route import Route
from uavlab.scene.content import MOST_FLIGHTS, drawing_of
from uavlab.scene.motion import along_flight, along_route, mover, turned
from uavlab.vehicle import GRAVITY, LIGHT_QUADROTOR
from uavlab.weather import Wind

LOOK = Style("#0072B2", "-")
PLAIN = City(np.zeros((200, 60, 30), dtype=bool), 2.0)


def axis_and_nose(turn):
    rotation = Rotation.from_quat(turn)
    return rotation.apply([0, 0, 1]), rotation.apply([1, 0, 0])


@pytest.mark.parametrize("wind", [(0.0, 0.0), (-6.0, 0.0), (0.0, 5.0)])
def test_in_steady_flight_it_leans_as_much_as_drag_asks_for_with_its_nose_ahead(wind):
    time = np.linspace(0, 20, 60)
    points = np.column_stack([8.0 * time, 0 * time, 30 + 0 * time])
    axis, nose = axis_and_nose(turned(time, points, LIGHT_QUADROTOR, Wind(wind))[30])
    air = np.array([8.0 - wind[0], -wind[1], 0.0])
    drag = 0.5 * Wind().air_density * LIGHT_QUADROTOR.drag_area * np.linalg.norm(air) * air
    force = drag + np.array([0, 0, LIGHT_QUADROTOR.weight])
    assert axis == pytest.approx(force / np.linalg.norm(force), abs=1e-3)
    assert nose[0] > 0.85
    assert abs(nose[1]) < 0.05  # it leans sideways, too


def test_in_a_bend_it_leans_inwards():
    time, radius, speed = np.linspace(0, 30, 300), 20.0, 6.0
    angle = speed * time / radius
    points = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), 0 * time])
    turn = turned(time, points, LIGHT_QUADROTOR, Wind(deviation=0.0))[150]
    axis, _ = axis_and_nose(turn)
    inward = -points[150] / radius
    assert axis @ inward / axis[2] == pytest.approx(speed**2 / radius / GRAVITY, rel=0.05)


def test_a_hovering_uav_is_level_and_one_that_climbs_keeps_its_nose():
    still = turned(np.arange(3.0), np.zeros((3, 3)), LIGHT_QUADROTOR, Wind(deviation=0.0))
    assert axis_and_nose(still[1])[0] == pytest.approx([0, 0, 1])
    time = np.linspace(0, 20, 100)
    points = np.column_stack([np.zeros(100), np.minimum(5 * time, 50), np.maximum(time - 12, 0)])
    nose = axis_and_nose(turned(time, points, LIGHT_QUADROTOR, Wind(deviation=0.0))[90])[1]
    assert nose[1] > 0.95


@pytest.fixture(scope="module")
def crashed(table1):
    route = astar(table1, (90, 18, 30), (50, 44, 30))
    flight = fly(route, table1, LIGHT_QUADROTOR, OffsetProcess(1.0), rng=3)
    assert flight.outcome == "crashed"
    return flight


def test_it_is_where_the_log_says_and_ends_where_it_crashed(crashed):
    time, points = along_flight(crashed, 300)
    flown = mover(time, points, LOOK, LIGHT_QUADROTOR, Wind(deviation=0.0), None)
    for moment, place in zip(crashed.time[::7] - crashed.time[0], crashed.position[::7], strict=True):
        assert np.linalg.norm(flown.at(moment)[0] - place) < 0.1
    assert flown.at(crashed.duration)[0] == pytest.approx(crashed.position[-1])
    assert flown.at(1e9)[0] == pytest.approx(crashed.position[-1])
    assert flown.at(0.0)[0] == pytest.approx(crashed.position[0])


def test_a_route_is_flown_at_cruise_speed_through_every_waypoint():
    route = Route([(1, 1, 10), (41, 1, 10), (41, 31, 20)])
    time, points = along_route(route, LIGHT_QUADROTOR)
    assert time[-1] == pytest.approx(route.length / LIGHT_QUADROTOR.cruise_speed)
    for waypoint, distance in zip(route.points, route.distance, strict=True):
        number = np.abs(time - distance / LIGHT_QUADROTOR.cruise_speed).argmin()
        assert points[number] == pytest.approx(waypoint)
    speeds = np.linalg.norm(np.diff(points, axis=0), axis=1) / np.diff(time)
    assert speeds == pytest.approx(LIGHT_QUADROTOR.cruise_speed)


def test_many_flights_are_thinned_out_and_counted(table1):
    route = astar(table1, (90, 18, 30), (50, 44, 30))
    flights = [fly(route, table1, LIGHT_QUADROTOR, OffsetProcess(0.6), rng=1, number=n) for n in range(60)]
    drawing = drawing_of(table1, (), flights=flights)
    assert len(drawing.movers) <= MOST_FLIGHTS
    assert f"{len(drawing.movers)} of 60 flights are drawn" in drawing.notes
    counts = {entry.text for entry in drawing.legend if entry.kind == "line"}
    for outcome in {flight.outcome for flight in flights}:
        assert f"{outcome}: {sum(flight.outcome == outcome for flight in flights)} flights" in counts


def test_a_flight_remembers_where_it_should_have_arrived(table1, crashed):
    assert crashed.goal == pytest.approx(table1.center_of(table1.cell_of((50, 44, 30))))
