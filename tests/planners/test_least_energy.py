"""Least energy against SciPy's Dijkstra on an independent graph, closed forms, and flights."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from scipy.optimize import linprog
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from uavlab.city import City
from uavlab.flight import PERFECT_GPS, Autopilot, fly
from uavlab.planners import astar, least_energy
from uavlab.planners.grid import LENGTHS, MOVES
from uavlab.planners.least_energy import energy_left, slopes_of
from uavlab.power import energy_per_metre, power_needed
from uavlab.vehicle import LIGHT_QUADROTOR, RISK_QUADROTOR
from uavlab.weather import Wind

WINDS = [(0.0, 0.0, 0.0), (6.0, 0.0, 0.0), (-5.0, 7.0, 0.0), (3.0, 3.0, 1.0)]


def town(seed, shape=(11, 10, 7), cell=4.0):
    rng = np.random.default_rng(seed)
    occupied = rng.random(shape) < 0.25
    occupied[0, 0, 0] = occupied[-1, -1, -1] = occupied[0, -1, 2] = False
    return City(occupied, cell=cell)


def graph_of(city, uav, wind, **options):
    """All legal moves with their energy, from their definition alone."""
    free = ~city.occupied
    rows, columns, costs = [], [], []
    per_metre = energy_per_metre(uav, MOVES, wind, **options)
    for node in np.argwhere(free):
        for move, cost in zip(MOVES, per_metre * LENGTHS * city.cell, strict=True):
            there = node + move
            if (there < 0).any() or (there >= city.shape).any() or np.isinf(cost):
                continue
            low, high = np.minimum(node, there), np.maximum(node, there)
            if free[tuple(slice(a, b + 1) for a, b in zip(low, high, strict=True))].all():
                rows.append(np.ravel_multi_index(node, city.shape))
                columns.append(np.ravel_multi_index(there, city.shape))
                costs.append(cost)
    return csr_array((costs, (rows, columns)), shape=(free.size, free.size))


@pytest.mark.parametrize("wind", WINDS)
@pytest.mark.parametrize("uav", [LIGHT_QUADROTOR, RISK_QUADROTOR], ids=["light", "risk"])
@pytest.mark.parametrize("seed", range(4))
def test_the_energy_is_that_of_dijkstra_on_an_independent_graph(seed, uav, wind):
    city = town(seed)
    nodes = [np.ravel_multi_index(index, city.shape) for index in ((0, 0, 0), (10, 9, 6), (0, 9, 2))]
    least = dijkstra(graph_of(city, uav, wind, speed=9.0), indices=nodes)
    for (one, a), (other, b) in product(enumerate(nodes), repeat=2):
        if one == other:
            continue
        start, goal = city.center_of(city.index_of([a, b]))
        route = least_energy(city, start, goal, uav, Wind(wind), speed=9.0)
        assert route.reached == np.isfinite(least[one, b])
        assert route.cost == pytest.approx(least[one, b], rel=1e-9)


@pytest.mark.parametrize("wind", WINDS)
def test_the_estimate_is_exact_on_an_empty_map(wind):
    """Against linear programming: how much of which moves makes a way."""
    costs = LENGTHS * energy_per_metre(RISK_QUADROTOR, MOVES, wind)
    slopes = slopes_of(costs)
    for way in np.random.default_rng(0).integers(-20, 20, (40, 3)):
        least = linprog(costs, A_eq=MOVES.T, b_eq=way).fun
        assert energy_left(slopes, *way) == pytest.approx(least, rel=1e-8, abs=1e-8)
    city = City(np.zeros((40, 40, 20), bool), cell=2.0)
    route = least_energy(city, (3, 5, 7), (71, 55, 33), RISK_QUADROTOR, Wind(wind))
    assert route.info["expanded"] < 40 * 40 * 20 / 20


def test_energy_of_a_metre_is_power_over_the_speed_that_is_held():
    directions = np.random.default_rng(0).standard_normal((300, 3))
    for wind in WINDS:
        per_metre = energy_per_metre(RISK_QUADROTOR, directions, wind, speed=7.0)
        assert (per_metre >= 0).all()
        slowed = energy_per_metre(RISK_QUADROTOR, (0, 0, 2), wind, speed=7.0)
        assert slowed == pytest.approx(power_needed(RISK_QUADROTOR, (0, 0, 6), wind).battery / 6)
    against, along = energy_per_metre(RISK_QUADROTOR, [(-1, 0, 0), (1, 0, 0)], (8.0, 0.0, 0.0))
    assert against > 1.5 * along
    assert energy_per_metre(LIGHT_QUADROTOR, (1, 0, 0), (-20.0, 0, 0)) == np.inf
    assert energy_per_metre(LIGHT_QUADROTOR, (0, 0, 1)) > LIGHT_QUADROTOR.weight


def test_where_the_wind_leaves_no_way_back_it_says_so():
    city = City(np.zeros((20, 20, 10), bool), cell=5.0)
    weak = replace(LIGHT_QUADROTOR, cruise_speed=4.0, top_speed=5.0)
    with_it = least_energy(city, (10, 50, 25), (90, 50, 25), weak, Wind((8.0, 0, 0)))
    assert with_it.reached
    against = least_energy(city, (90, 50, 25), (10, 50, 25), weak, Wind((8.0, 0, 0)))
    assert not against.reached
    assert against.reason.startswith("the wind leaves ")


def test_a_flight_takes_what_was_planned():
    """Steady flight: what corners and speeding up take is the difference, a tenth on a way of 700 m."""
    occupied = np.zeros((60, 30, 12), bool)
    occupied[30, :20] = True
    city = City(occupied, cell=10.0)
    for wind in ((5.0, 0.0, 0.0), (-5.0, 2.0, 0.0)):
        route = least_energy(city, (50, 100, 50), (550, 150, 60), LIGHT_QUADROTOR, Wind(wind))
        flight = fly(route, city, LIGHT_QUADROTOR, Wind(wind, "none"), Autopilot(gps=PERFECT_GPS), rng=0)
        assert flight.outcome == "arrived"
        assert flight.energy.battery == pytest.approx(route.cost, rel=0.1)
        shortest = astar(city, (50, 100, 50), (550, 150, 60))
        legs = np.diff(shortest.points, axis=0)
        other = (shortest.leg_lengths * energy_per_metre(LIGHT_QUADROTOR, legs, wind)).sum()
        assert route.cost <= other


def test_take_off_and_landing_are_paid_for():
    city = City(np.zeros((20, 20, 20), bool), cell=5.0)
    ground, level = (12.5, 12.5, 2.5), (12.5, 12.5, 42.5)
    route = least_energy(city, ground, (92.5, 12.5, 2.5), LIGHT_QUADROTOR, min_height=40.0)
    assert (route.takeoff, route.landing) == (8, 8)
    up, down = energy_per_metre(LIGHT_QUADROTOR, [(0, 0, 1), (0, 0, -1)]) * 40
    between = least_energy(city, level, (92.5, 12.5, 42.5), LIGHT_QUADROTOR, min_height=40.0)
    assert route.cost == pytest.approx(between.cost + up + down)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"uav": "quadrotor"}, "uav must be a UAV"),
        ({"disturbance": (1.0, 2.0)}, "disturbance must be a Wind, got tuple"),
        ({"speed": 0.0}, "speed must be finite and above 0"),
        ({"goal": (0, 0, 999)}, "goal"),
    ],
)
def test_wrong_questions_are_refused(options, words):
    question = {"city": City(np.zeros((9, 9, 9), bool)), "start": (1, 1, 1), "goal": (7, 7, 7), "uav": LIGHT_QUADROTOR}
    with pytest.raises(ValueError, match=words):
        least_energy(**(question | options))


def test_a_direction_without_a_length_is_refused():
    with pytest.raises(ValueError, match="direction must have shape"):
        energy_per_metre(LIGHT_QUADROTOR, (0, 0, 0))
