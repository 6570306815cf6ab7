"""Where wrecks land: columns by hand on small maps, the rate there, and the planner's cost along its routes.

Each column gets its own share of cars and no people, so that a rate tells the column.
"""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from uavlab.city import City
from uavlab.planners import least_risk
from uavlab.planners.grid import MOVES
from uavlab.risk import (
    CAMPUS_FLIGHT,
    RiskMap,
    ballistic_fall,
    impact_fatality,
    lethal_area,
    person_rate,
    random_campus,
    vehicle_rate,
)
from uavlab.risk.drift import STEPS_PER_CELL, landing_rate
from uavlab.route import Route
from uavlab.vehicle import RISK_QUADROTOR

EAST = (1, 0, 0)


def marked(occupied, cell):
    """A map without people whose columns differ by their cars."""
    share = np.linspace(0.001, 0.9, occupied[..., 0].size).reshape(occupied.shape[:2])
    return RiskMap(City(occupied, cell=cell), 0.0, 0.0, share)


def landing(risk_map, index, direction):
    """The column in which the wreck lands, told by its rate."""
    rate = landing_rate(risk_map.falls, np.array([index]), np.array(direction))
    (column,) = np.argwhere(np.isclose(risk_map.vehicle_rate, rate, rtol=1e-9, atol=0))
    return tuple(column)


def field(nx=20, ny=3, nz=8, cell=5.0):
    return marked(np.zeros((nx, ny, nz), bool), cell)


@pytest.mark.parametrize(("level", "ahead"), [(0, 2), (2, 5), (4, 7), (5, 7), (6, 8)])
def test_wreck_lands_cells_ahead_on_open_ground(level, ahead):
    """It failed 2.5 m into its voxel, and drifts 11.3, 25.0, 33.2, 36.6 and 39.7 m."""
    drift = ballistic_fall(5 * level + 2.5).drift
    assert ahead == (2.5 + drift) // 5
    assert landing(field(), (3, 1, level), EAST) == (3 + ahead, 1)
    assert landing(field(), (16, 1, level), (-1, 0, 0)) == (16 - ahead, 1)


@given(st.integers(0, 11), st.floats(0.5, 8), st.sampled_from([-1, 0, 1]), st.floats(0, 2 * np.pi))
def test_wreck_lands_where_the_ballistic_fall_ends(level, cell, climb, heading):
    direction = np.array([np.cos(heading), np.sin(heading), climb])
    n = 2 * int(np.ceil(90 / cell)) + 1
    flat = marked(np.zeros((n, n, 12), bool), cell)
    here = n // 2
    found = np.array(landing(flat, (here, here, level), direction))
    drift = ballistic_fall((level + 0.5) * cell, pitch=np.arctan2(climb, 1.0)).drift / cell
    place = here + 0.5 + drift * direction[:2]
    assert (np.abs(found + 0.5 - place) <= 0.5 + 1 / STEPS_PER_CELL + 1e-9).all()


def test_climbing_it_lands_farther_and_descending_nearer():
    columns = [landing(field(), (1, 1, 5), (1, 0, climb))[0] for climb in (-1, 0, 1)]
    pitched = [ballistic_fall(27.5, pitch=pitch).drift for pitch in (-np.pi / 4, 0, np.pi / 4)]
    assert columns == [1 + (2.5 + drift) // 5 for drift in pitched]
    assert columns[0] < columns[1] < columns[2]


def test_it_may_rise_above_the_map_before_it_falls():
    low = marked(np.zeros((20, 3, 2), bool), 5.0)
    assert landing(low, (1, 1, 1), (1, 0, 1)) == landing(field(), (1, 1, 1), (1, 0, 1))
    assert landing(low, (1, 1, 1), (0, 0, 1)) == (1, 1)
    beside = np.zeros((20, 3, 2), bool)
    beside[:, 2] = True  # beside its way, and next to the air above it in memory
    low = marked(beside, 5.0)
    assert landing(low, (1, 1, 1), (1, 0, 1)) == landing(field(), (1, 1, 1), (1, 0, 1))


def test_a_wall_in_the_way_stops_it():
    occupied = np.zeros((20, 3, 8), bool)
    occupied[6] = True
    assert landing(marked(occupied, 5.0), (3, 1, 5), EAST) == (6, 1)
    assert landing(marked(occupied, 5.0), (10, 1, 5), (-1, 0, 0)) == (6, 1)
    assert landing(marked(occupied, 5.0), (10, 1, 5), EAST) == (17, 1)


def test_it_lands_on_roofs_that_it_comes_down_to_and_flies_over_lower_ones():
    """From 27.5 m it is 5 cells ahead 15.3 m lower: at 12.2 m, in the third level."""
    assert ballistic_fall(15.3).drift == pytest.approx(27.5, abs=0.1)
    for roof, column in ((1, 10), (2, 10), (3, 8), (5, 8)):
        occupied = np.zeros((20, 3, 8), bool)
        occupied[8, :, :roof] = True
        assert landing(marked(occupied, 5.0), (3, 1, 5), EAST) == (column, 1)


def test_it_flies_below_a_floating_building():
    occupied = np.zeros((20, 3, 8), bool)
    occupied[5:8, :, 6:] = True
    assert landing(marked(occupied, 5.0), (3, 1, 5), EAST) == (10, 1)
    occupied[4:8, :, 5] = True
    assert landing(marked(occupied, 5.0), (3, 1, 5), EAST) == (4, 1)


def test_beyond_the_border_the_layers_go_on_as_at_it():
    assert landing(field(), (17, 1, 5), EAST) == (19, 1)
    assert landing(field(), (2, 2, 5), (0, 1, 0)) == (2, 2)
    assert landing(field(), (2, 0, 5), (-1, -1, 0)) == (0, 0)


def test_straight_down_it_doesnt_drift_and_hits_the_roof_below():
    occupied = np.zeros((3, 3, 8), bool)
    occupied[1, 1, :3] = True
    city = City(occupied, cell=5.0)
    people = np.linspace(0.01, 0.09, 9).reshape(3, 3)
    no_shelter = RiskMap(city, people, 0.0)
    index = np.argwhere(~occupied)
    rate = landing_rate(no_shelter.falls, index, np.array([0, 0, -1]))
    disc = np.pi * 0.45**2
    assert rate == pytest.approx(6.4e-5 * people[index[:, 0], index[:, 1]] * disc, rel=1e-9)
    # the rate straight below differs by its glide alone, which a dive doesn't have
    below = no_shelter.rate[tuple(index.T)]
    height = city.height_above_surface[tuple(index.T)]
    down = np.sqrt(person_energy_per_mass(height))
    assert below / rate == pytest.approx(lethal_area(height, 16.0, down) / disc, rel=1e-9)


def person_energy_per_mass(height):
    """Square of the vertical speed after a fall, 2 m g/k·(1 − exp(−k h/m)), with the papers' vehicle."""
    per_metre = 0.3 * 0.0188 * 1.225 / 1.38
    return 2 * 9.81 / per_metre * -np.expm1(-per_metre * height)


def test_a_dive_onto_a_roof_is_softer_than_one_past_it():
    occupied = np.zeros((2, 1, 10), bool)
    occupied[0, 0, :8] = True
    sheltered = RiskMap(City(occupied, cell=5.0), 0.03, 0.5)
    onto, past = landing_rate(sheltered.falls, np.array([(0, 0, 9), (1, 0, 9)]), np.array([0, 0, -1]))
    disc = 6.4e-5 * 0.03 * np.pi * 0.45**2
    for rate, height in ((onto, 7.5), (past, 47.5)):
        down = ballistic_fall(height, pitch=-np.pi / 2).fall_speed
        assert rate == pytest.approx(disc * impact_fatality(0.69 * down**2, 0.5), rel=0.03)
    assert onto < 0.8 * past


@pytest.mark.parametrize("shelter", [0.0, 0.25, 1.0])
def test_over_even_ground_the_rate_is_that_of_the_ballistic_fall(shelter):
    even = RiskMap(City(np.zeros((60, 1, 30), bool)), 0.02, shelter, 0.1)
    index = np.array([(2, 0, k) for k in (5, 14, 29)])
    expected = person_rate(index[:, 2] + 0.5, 0.02, shelter, ballistic=True) + vehicle_rate(0.1)
    assert landing_rate(even.falls, index, np.array(EAST)) == pytest.approx(expected, rel=0.02)


def test_people_shelter_and_cars_are_those_of_the_place_where_it_lands():
    people, shelter, share = (np.zeros((20, 3)) for _ in range(3))
    people[10, 1], shelter[10, 1], share[10, 1] = 0.03, 0.5, 0.2
    there = RiskMap(City(np.zeros((20, 3, 8), bool), cell=5.0), people, shelter, share)
    rate = landing_rate(there.falls, np.array([(3, 1, 5), (10, 1, 5), (4, 1, 5)]), np.array(EAST))
    assert rate[0] == pytest.approx(person_rate(27.5, 0.03, 0.5, ballistic=True) + vehicle_rate(0.2), rel=0.02)
    assert rate[1:].tolist() == [0, 0]


def test_length_of_a_direction_doesnt_matter():
    campus = random_campus(3)
    index = np.argwhere(campus.flyable)[::50]
    direction = np.array([1.0, -1.0, 0.5])
    assert np.array_equal(
        landing_rate(campus.falls, index, direction), landing_rate(campus.falls, index, 40 * direction)
    )


def test_rate_ahead_has_the_order_of_the_planners_moves():
    flat = marked(np.zeros((21, 21, 4), bool), 5.0)
    assert flat.rate_ahead.shape == (26, 21, 21, 4)
    for move, rate in zip(MOVES, flat.rate_ahead, strict=True):
        (column,) = np.argwhere(np.isclose(flat.vehicle_rate, rate[10, 10, 3], rtol=1e-9, atol=0))
        assert np.sign(column - 10).tolist() == move[:2].tolist()
        assert rate[10, 10, 3] == landing_rate(flat.falls, np.array([(10, 10, 3)]), move)


@pytest.mark.parametrize("seed", range(6))
def test_integral_with_drift_is_the_planner_s_cost(seed):
    campus = random_campus(seed)
    route = least_risk(campus, *CAMPUS_FLIGHT, drift=True)
    assert route.reached
    assert campus.integral(route, drift=True) == pytest.approx(route.cost, rel=1e-9)
    blind = least_risk(campus, *CAMPUS_FLIGHT)
    assert campus.integral(blind) == pytest.approx(blind.cost, rel=1e-9)
    assert campus.integral(route, drift=True) <= campus.integral(blind, drift=True) * (1 + 1e-9)


@pytest.mark.parametrize("seed", range(6))
def test_integral_with_drift_is_the_planner_s_cost_among_random_obstacles(seed):
    rng = np.random.default_rng(seed)
    city = City(rng.random((12, 10, 8)) < 0.1, cell=3.0, origin=(-7, 20, 3))
    risk_map = RiskMap(
        city, rng.uniform(0, 0.1, (12, 10)), rng.uniform(0, 1, (12, 10)), rng.uniform(0, 0.01, (12, 10)), safe_height=0
    )
    free = city.center_of(np.argwhere(risk_map.flyable))
    start, goal = free[0], free[-1]
    route = least_risk(risk_map, start, goal, drift=True, max_turn=np.pi, max_pitch=np.pi / 2)
    assert route.reached
    assert risk_map.integral(route, drift=True) == pytest.approx(route.cost, rel=1e-9)


def test_with_drift_the_way_back_has_another_risk():
    campus = random_campus(1)
    route = Route([(12.5, 17.5, 42.5), (112.5, 112.5, 67.5)])
    back = Route(route.points[::-1])
    assert campus.integral(route) == pytest.approx(campus.integral(back), rel=1e-9)
    assert campus.integral(route, drift=True) != pytest.approx(campus.integral(back, drift=True), rel=0.05)


def test_integral_with_drift_by_hand():
    """Two voxels and a half to the east, one to the north, at 27.5 m: it lands 36.6 m ahead, or beyond the border."""
    flat = field(nx=20, ny=3)
    route = Route([(12.5, 7.5, 27.5), (25, 7.5, 27.5), (25, 7.5, 27.5), (25, 12.5, 27.5)])
    cars = flat.vehicle_rate
    expected = 0.5 * cars[9, 1] + cars[10, 1] + cars[11, 1] + 0.5 * cars[5, 2] + 0.5 * cars[5, 2]
    assert flat.integral(route, drift=True) == pytest.approx(expected, rel=1e-9)


def test_a_route_that_leaves_the_map_or_has_no_legs():
    flat = field()
    with pytest.raises(ValueError, match="the route leaves the map"):
        flat.integral(Route([(12.5, 7.5, 27.5), (12.5, 15.5, 27.5)]), drift=True)
    assert flat.integral(Route(np.empty((0, 3))), drift=True) == 0
    assert flat.integral(Route([(12.5, 7.5, 27.5)]), drift=True) == 0


def test_a_payload_makes_the_blow_harder():
    """Behind shelter a heavier wreck kills more often, by the energy of mass and payload."""
    people = RiskMap(City(np.zeros((40, 5, 8), bool), cell=5.0), 0.01, 0.5, uav=RISK_QUADROTOR)
    loaded = replace(people, uav=RISK_QUADROTOR.loaded(0.7))
    index = np.array([(3, 2, 5)])
    light, heavy = (float(landing_rate(each.falls, index, np.array(EAST))[0]) for each in (people, loaded))
    falls = [each.falls for each in (people, loaded)]
    row = falls[0].last.size // 2
    energies = [fall.energy[row, fall.last[row]] for fall in falls]
    drop = ballistic_fall(40.0, RISK_QUADROTOR)
    expected = 0.5 * 1.38 * (drop.forward_speed**2 + drop.fall_speed**2)
    assert energies[0] == pytest.approx(expected, rel=1e-3)
    assert energies[1] > 1.4 * energies[0]
    assert heavy > light
