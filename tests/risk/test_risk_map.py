"""Risk maps: rates per voxel, routes by hand, what the printed sum depends on, where one may fly, what is refused."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from uavlab.city import Building, City
from uavlab.risk import (
    POPULATION_DENSITY,
    RiskMap,
    ballistic_fall,
    building_threat,
    fall_speed,
    person_rate,
    printed_threat,
    reference_campus,
    vehicle_rate,
)
from uavlab.route import Route
from uavlab.vehicle import LIGHT_QUADROTOR, RISK_QUADROTOR

FLAT = City(np.zeros((6, 5, 4), bool), cell=10.0, name="field")
TOWER = Building.prism([(20, 20), (30, 20), (30, 30), (20, 30)], 12.5, name="tower")
TOWN = City.from_buildings([TOWER], cell=5.0, origin=(0, 0, 0), size=(60, 50, 40), name="town")


def cars_only(share, cell=10.0, levels=4):
    """A map with the same rate at all heights: 6.4e-5·3·share."""
    share = np.asarray(share, dtype=float)
    return RiskMap(City(np.zeros((*share.shape, levels), bool), cell=cell), 0.0, 0.0, share)


def rate_of(share):
    return 6.4e-5 * 3 * share


SHARES = np.arange(1, 13).reshape(4, 3) / 100
LAYERED = cars_only(SHARES)


def test_rate_is_that_of_people_and_of_cars():
    rng = np.random.default_rng(1)
    people, shelter, share = rng.uniform(0, 0.1, (12, 10)), rng.uniform(0, 1, (12, 10)), rng.uniform(0, 0.1, (12, 10))
    risk_map = RiskMap(TOWN, people, shelter, share)
    assert risk_map.rate.shape == TOWN.shape
    assert risk_map.rate == pytest.approx(risk_map.person_rate + risk_map.vehicle_rate[:, :, None])
    assert risk_map.vehicle_rate == pytest.approx(vehicle_rate(share))
    for i, j, k in ((0, 0, 0), (11, 9, 7), (3, 2, 5)):
        expected = person_rate(5 * k + 2.5, people[i, j], shelter[i, j])
        assert risk_map.person_rate[i, j, k] == pytest.approx(float(expected), rel=1e-12)


def test_above_a_roof_the_fall_ends_at_the_roof():
    risk_map = RiskMap(TOWN, 0.03, 0.5)
    above = risk_map.rate[4, 4]  # a column of the tower, 12.5 m high
    assert above[3] == pytest.approx(float(person_rate(17.5 - 12.5, 0.03, 0.5)), rel=1e-12)
    assert above[7] == pytest.approx(float(person_rate(37.5 - 12.5, 0.03, 0.5)), rel=1e-12)
    assert above[7] < risk_map.rate[0, 0, 7]


def test_one_number_holds_for_the_whole_ground_plan():
    numbers = RiskMap(FLAT, 0.03, 0.5, 0.01)
    arrays = RiskMap(FLAT, np.full((6, 5), 0.03), np.full((6, 5), 0.5), np.full((6, 5), 0.01))
    assert np.array_equal(numbers.rate, arrays.rate)
    assert numbers.shelter.shape == (6, 5)
    assert (RiskMap(FLAT, 0.03, 0.5).vehicle_rate == 0).all()


def test_vehicle_and_printed_fall_are_taken_up():
    usual, printed = RiskMap(FLAT, 0.03, 1.0), RiskMap(FLAT, 0.03, 1.0, as_printed=True)
    height = FLAT.height_above_surface
    assert printed.rate == pytest.approx(person_rate(height, 0.03, 1.0, as_printed=True))
    assert (printed.rate != usual.rate).all()
    light = RiskMap(FLAT, 0.03, 1.0, uav=LIGHT_QUADROTOR)
    assert light.rate == pytest.approx(person_rate(height, 0.03, 1.0, LIGHT_QUADROTOR))


def test_rates_are_computed_once_and_the_threat_is_the_city_s():
    risk_map = RiskMap(TOWN, 0.03, 0.5)
    assert risk_map.rate is risk_map.rate
    assert np.array_equal(risk_map.threat, building_threat(TOWN))


def test_integral_of_a_polyline_by_hand():
    """5 m in column (0, 0), straight 10 in (1, 0), 5 + 5√2 in (2, 0) where it turns, 5√2 in (3, 1), up 10 there."""
    route = Route([(5, 5, 5), (25, 5, 5), (35, 15, 5), (35, 15, 15)])
    lengths = {(0, 0): 5, (1, 0): 10, (2, 0): 5 + 50**0.5, (3, 1): 50**0.5 + 10}
    expected = sum(rate_of(SHARES[column]) * length for column, length in lengths.items()) / 10
    assert LAYERED.integral(route) == pytest.approx(expected, rel=1e-12)


def test_integral_through_corners_of_voxels():
    expected = (rate_of(0.01) * 0.5 + rate_of(0.05) + rate_of(0.09) * 0.5) * 3**0.5
    assert LAYERED.integral(Route([(5, 5, 5), (25, 25, 25)])) == pytest.approx(expected, rel=1e-12)


@given(st.lists(st.tuples(st.floats(0, 39.9), st.floats(0, 29.9), st.floats(0, 39.9)), min_size=2, max_size=6))
def test_integral_has_no_direction_and_doesnt_mind_more_waypoints(points):
    route = Route(points)
    integral = LAYERED.integral(route)
    assert LAYERED.integral(Route(route.points[::-1])) == pytest.approx(integral, rel=1e-6, abs=1e-12)
    assert LAYERED.integral(route.resample(3.0)) == pytest.approx(integral, rel=1e-6, abs=1e-12)
    least, most = rate_of(0.01) * route.length / 10, rate_of(0.12) * route.length / 10
    assert least * (1 - 1e-9) <= integral <= most * (1 + 1e-9)


def test_integral_where_the_rate_is_the_same_everywhere_is_the_length():
    even = cars_only(np.full((4, 3), 0.5))
    for points in ([(1, 1, 1), (39, 29, 39)], [(5, 5, 5), (5, 5, 35), (35, 5, 35)]):
        route = Route(points)
        assert even.integral(route) == pytest.approx(rate_of(0.5) * route.length / 10, rel=1e-12)


def test_printed_sum_counts_cells_whatever_the_way_in_them():
    even = cars_only(np.full((8, 8), 0.5), levels=8)
    rate = rate_of(0.5)
    straight = Route([(5, 5, 5), (75, 5, 5)])
    diagonal = Route([(5, 5, 5), (75, 75, 5)])
    through_corners = Route([(5, 5, 5), (75, 75, 75)])
    for route, length in ((straight, 1.0), (diagonal, 2**0.5), (through_corners, 3**0.5)):
        assert even.cell_sum(route) == pytest.approx(8 * rate, rel=1e-12)  # diagonals come free
        assert even.integral(route) == pytest.approx(7 * length * rate, rel=1e-12)
    assert even.cell_sum(Route([(0.5, 5, 5), (79.5, 5, 5)])) == pytest.approx(8 * rate)


def test_printed_sum_depends_on_the_resolution_and_the_integral_in_metres_doesnt():
    route = Route([(1, 1, 1), (79, 1, 1)])
    sums, metres = [], []
    for cell in (10.0, 5.0, 2.5):
        even = cars_only(np.full((int(80 / cell),) * 2, 0.5), cell)
        sums.append(even.cell_sum(route) / rate_of(0.5))
        metres.append(even.integral(route) * cell)
    assert sums == pytest.approx([8, 16, 32])
    assert metres == pytest.approx([rate_of(0.5) * 78] * 3, rel=1e-9)


def test_printed_sum_counts_each_cell_once():
    there = [(5, 5, 5), (35, 5, 5)]
    once, twice = Route(there), Route([*there, there[0]])
    assert LAYERED.cell_sum(once) == pytest.approx(sum(rate_of(SHARES[:, 0])))
    assert LAYERED.cell_sum(twice) == pytest.approx(LAYERED.cell_sum(once), rel=1e-12)
    assert LAYERED.integral(twice) == pytest.approx(2 * LAYERED.integral(once), rel=1e-12)


@pytest.mark.parametrize("seed", range(10))
def test_printed_sum_of_a_grid_route_is_that_of_its_nodes(seed):
    """Rounding at corners must not count the voxels that are only touched."""
    rng = np.random.default_rng(seed)
    cell, origin = rng.uniform(0.3, 7), rng.uniform(-1e4, 1e4, 3)
    city = City(np.zeros((20, 20, 20), bool), cell=cell, origin=origin)
    risk_map = RiskMap(city, rng.uniform(0, 0.1, (20, 20)), rng.uniform(0, 1, (20, 20)))
    nodes = np.clip(10 + np.cumsum(rng.integers(-1, 2, (25, 3)), axis=0), 0, 19)
    expected = risk_map.rate[tuple(np.unique(nodes, axis=0).T)].sum()
    assert risk_map.cell_sum(Route(city.center_of(nodes))) == pytest.approx(expected, rel=1e-12)


def test_fatalities_are_the_rate_over_the_time_of_flight():
    route = Route([(5, 5, 5), (25, 5, 5), (35, 15, 5)])
    assert LAYERED.fatalities(route, 8.0) == pytest.approx(LAYERED.integral(route) * 10 / (3600 * 8), rel=1e-12)
    assert LAYERED.fatalities(route) == pytest.approx(LAYERED.fatalities(route, 16.0), rel=1e-12)
    slow = replace(LAYERED, uav=replace(RISK_QUADROTOR, cruise_speed=4.0))
    assert slow.fatalities(route) == pytest.approx(4 * LAYERED.fatalities(route), rel=1e-12)


def test_an_hour_of_flight_has_the_hourly_rate():
    """20 m there and back for an hour at 1 m/s, over one rate."""
    even = cars_only(np.full((4, 3), 0.5))
    hour = Route(np.tile([(5.0, 5, 5), (25, 5, 5)], (91, 1))[:181])
    assert hour.length == 3600
    assert even.fatalities(hour, 1.0) == pytest.approx(rate_of(0.5), rel=1e-9)


def test_routes_of_no_length_cost_nothing():
    for points in (np.empty((0, 3)), [(5.0, 5, 5)]):
        route = Route(points)
        assert LAYERED.integral(route) == LAYERED.cell_sum(route) == LAYERED.fatalities(route) == 0


def test_one_flies_above_safe_and_min_height():
    risk_map = RiskMap(TOWN, 0.03, 0.5, safe_height=7.5, min_height=12.5)
    roof = np.zeros((12, 10), bool)
    roof[4:6, 4:6] = True
    level = 5 * np.arange(8) + 2.5
    assert (risk_map.flyable[~roof] == (level >= 12.5)).all()  # the ground asks for 7.5 and for 12.5
    assert (risk_map.flyable[roof] == (level >= 20)).all()  # 12.5 m of tower and 7.5 above it
    unlimited = RiskMap(TOWN, 0.03, 0.5, safe_height=0.0)
    assert np.array_equal(unlimited.flyable, ~TOWN.occupied)


def test_by_default_one_flies_three_metres_above_what_lies_below():
    flyable = RiskMap(TOWN, 0.03, 0.5).flyable
    assert flyable[0, 0].tolist() == [False] + [True] * 7
    assert flyable[4, 4].tolist() == [False] * 3 + [True] * 5
    exact = RiskMap(City(np.zeros((1, 1, 4), bool), cell=2.0), 0.03, 0.5, safe_height=3.0)
    assert exact.flyable[0, 0].tolist() == [False, True, True, True]


def test_heights_count_from_the_floor_of_the_map():
    known = RiskMap(TOWN, 0.03, 0.5, min_height=10.0)
    moved = RiskMap(
        City.from_buildings(
            [Building.prism([(-80, 27), (-70, 27), (-70, 37), (-80, 37)], 345.5, bottom=333)],
            cell=5.0,
            origin=(-100, 7, 333),
            size=(60, 50, 40),
        ),
        0.03,
        0.5,
        min_height=10.0,
    )
    assert np.array_equal(moved.flyable, known.flyable)
    assert moved.rate == pytest.approx(known.rate, rel=1e-9)


def test_below_a_floating_building_one_flies_over_the_ground():
    bridge = Building.prism([(20, 0), (30, 0), (30, 50), (20, 50)], 30, bottom=20)
    town = City.from_buildings([bridge], cell=5.0, origin=(0, 0, 0), size=(60, 50, 50))
    risk_map = RiskMap(town, 0.03, 0.5)
    assert risk_map.flyable[4, 4].tolist() == [False, True, True, True, False, False, False, True, True, True]
    assert risk_map.rate[4, 4, 2] == risk_map.rate[0, 0, 2]
    assert risk_map.rate[4, 4, 7] == pytest.approx(float(person_rate(7.5, 0.03, 0.5)))


def test_an_empty_city_has_the_rates_of_the_open_ground():
    empty = RiskMap(FLAT, 0.03, 0.0)
    assert (empty.rate == empty.rate[0, 0]).all()
    assert (np.diff(empty.rate[0, 0]) < 0).all()  # the higher the steeper: less glide, and all blows kill
    assert (empty.threat == 0).all()


def test_a_city_of_one_voxel():
    one = RiskMap(City(np.zeros((1, 1, 1), bool), cell=60.0), POPULATION_DENSITY, 0.0)
    assert one.rate.shape == (1, 1, 1)
    assert one.rate[0, 0, 0] == pytest.approx(3.17e-6, rel=0.01)
    route = Route([(10, 10, 10), (50, 40, 20)])
    assert one.integral(route) == pytest.approx(one.rate[0, 0, 0] * route.length / 60)
    assert one.cell_sum(route) == one.rate[0, 0, 0]
    assert one.flyable.all()
    assert one.rate_ahead.shape == (26, 1, 1, 1)
    full = RiskMap(City(np.ones((1, 1, 1), bool)), 0.03, 0.0)
    assert not full.flyable.any()


def test_a_building_of_one_voxel():
    mast = Building.prism([(27, 22), (28, 22), (28, 23), (27, 23)], 19.0, name="mast")
    town = City.from_buildings([mast], cell=5.0, origin=(0, 0, 0), size=(60, 50, 40))
    assert town.occupied.sum() == 4  # its column holds the centre (27.5, 22.5); 2.5 to 17.5 m
    risk_map = RiskMap(town, 0.03, 0.5)
    assert risk_map.flyable[5, 4].tolist() == [False] * 4 + [True] * 4
    assert risk_map.rate[5, 4, 4] == pytest.approx(float(person_rate(22.5 - 19, 0.03, 0.5)))
    block = City.from_buildings([replace_top(mast, 5.0)], cell=5.0, origin=(0, 0, 0), size=(60, 50, 40))
    assert np.argwhere(block.occupied).tolist() == [[5, 4, 0]]
    assert RiskMap(block, 0.03, 0.5).rate[5, 4, 1] == pytest.approx(float(person_rate(2.5, 0.03, 0.5)))


def replace_top(building, top):
    (corners,) = building.pieces
    return Building.prism(corners[:4, :2], top)


def test_people_per_square_kilometre_are_refused_with_the_unit():
    with pytest.raises(ValueError, match=r"population_density must be in people per m², at most 10 \(divide .* 1e6\)"):
        RiskMap(FLAT, 30_000.0, 0.5)
    crowd = np.full((6, 5), 0.03)
    crowd[2, 3] = 11
    with pytest.raises(ValueError, match=r"people per m².* got 11"):
        RiskMap(FLAT, crowd, 0.5)
    crowd[2, 3] = 10
    assert RiskMap(FLAT, crowd, 0.5).population_density.max() == 10


def test_layers_can_be_exchanged():
    campus = reference_campus()
    sheltered = replace(campus, shelter=1.0)
    assert (sheltered.rate <= campus.rate).all()
    assert sheltered.integral(Route([(12.5, 17.5, 22.5), (12.5, 100, 22.5)])) > 0


LAYER = np.zeros((6, 5))
OUTSIDE = Route([(5, 5, 5), (5, 5, 45)])
NOWHERE = Route(np.empty((0, 3)), reached=False, reason="walled in")


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: RiskMap(FLAT, -0.1, 0.5), "population_density must be finite and at least 0, got -0.1"),
        (lambda: RiskMap(FLAT, LAYER + np.nan, 0.5), "population_density must be finite and at least 0, got nan"),
        (lambda: RiskMap(FLAT, np.inf, 0.5), "population_density must be finite and at least 0, got inf"),
        (lambda: RiskMap(FLAT, "many", 0.5), "population_density must be a number .* got text, 'many'"),
        (lambda: RiskMap(FLAT, None, 0.5), "population_density must be a number .* got None"),
        (
            lambda: RiskMap(FLAT, np.zeros((5, 6)), 0.5),
            r"population_density must have the shape of the city's ground plan \(6, 5\) or be one number, "
            r"got \(5, 6\); raster_layer and road_layer bring others onto it",
        ),
        (lambda: RiskMap(FLAT, np.zeros((6, 5, 4)), 0.5), r"population_density must have .* got \(6, 5, 4\)"),
        (lambda: RiskMap(FLAT, [[1, 2], [3]], 0.5), "population_density must be a number or an array of numbers"),
        (lambda: RiskMap(FLAT, 0.03, 1.1), r"shelter must be from 0 to 1 \(0 none, 1 industry\), got 1.1"),
        (lambda: RiskMap(FLAT, 0.03, LAYER - 0.1), "shelter must be from 0 to 1 .* got -0.1"),
        (lambda: RiskMap(FLAT, 0.03, np.nan), "shelter must be from 0 to 1 .* got nan"),
        (lambda: RiskMap(FLAT, 0.03, "industry"), "shelter must be a number .* got text, 'industry'"),
        (lambda: RiskMap(FLAT, 0.03, np.zeros(6)), r"shelter must have the shape .* got \(6,\)"),
        (lambda: RiskMap(FLAT, 0.03, 0.5, 1.2), "vehicle_share must be from 0 to 1 of the ground, got 1.2"),
        (lambda: RiskMap(FLAT, 0.03, 0.5, LAYER - 1), "vehicle_share must be from 0 to 1 of the ground, got -1"),
        (lambda: RiskMap(FLAT, 0.03, 0.5, np.zeros((6, 4))), r"vehicle_share must have the shape .* got \(6, 4\)"),
        (lambda: RiskMap(FLAT, 0.03, 0.5, safe_height=-3), "safe_height must be finite and at least 0, got -3"),
        (lambda: RiskMap(FLAT, 0.03, 0.5, safe_height="3"), "safe_height must be a number .* got text"),
        (lambda: RiskMap(FLAT, 0.03, 0.5, safe_height=[1, 2]), "safe_height must be one number"),
        (lambda: RiskMap(FLAT, 0.03, 0.5, min_height=np.nan), "min_height must be finite and at least 0"),
        (lambda: LAYERED.integral(OUTSIDE), "the route leaves the map"),
        (lambda: LAYERED.cell_sum(OUTSIDE), "the route leaves the map"),
        (lambda: LAYERED.fatalities(OUTSIDE), "the route leaves the map"),
        (lambda: LAYERED.fatalities(Route([(5, 5, 5)]), 0), "speed must be finite and above 0, got 0"),
        (lambda: LAYERED.fatalities(Route([(5, 5, 5)]), -16), "speed must be finite and above 0, got -16"),
        (lambda: LAYERED.fatalities(Route([(5, 5, 5)]), np.nan), "speed must be finite and above 0, got nan"),
        (lambda: LAYERED.fatalities(Route([(5, 5, 5)]), "16"), "speed must be a number .* got text, '16'"),
        (lambda: LAYERED.fatalities(Route([(5, 5, 5)]), [8, 16]), "speed must be one number"),
        (lambda: RiskMap(LAYERED, 0.03, 0.5), "city must be a City, got RiskMap: .* a RiskMap has one as its .city"),
        (lambda: RiskMap("town.geojson", 0.03, 0.5), r"city must be a City, got str: read_city\(path\) reads one"),
        (lambda: RiskMap(FLAT, 0.03, 0.5, uav=1.38), "uav must be a UAV, got float: uavlab.vehicle has some"),
        (lambda: fall_speed(30.0, 1.38), "uav must be a UAV, got float"),
        (lambda: ballistic_fall(30.0, None), "uav must be a UAV, got NoneType"),
        (lambda: person_rate(30.0, uav="quadrotor"), "uav must be a UAV, got str"),
        (lambda: building_threat(LAYERED), "city must be a City, got RiskMap"),
        (lambda: printed_threat(FLAT, OUTSIDE), "route must be a Route, got City"),
        (
            lambda: LAYERED.integral(np.zeros((2, 3))),
            r"route must be a Route, got ndarray: .* Route\(points\) makes one",
        ),
        (lambda: LAYERED.cell_sum([OUTSIDE]), "route must be a Route, got list"),
        (lambda: LAYERED.fatalities(None), "route must be a Route, got NoneType"),
        (lambda: LAYERED.integral(NOWHERE), "route must be one that was found .*, got none: walled in"),
        (lambda: LAYERED.integral(Route([(5, 5, 5)]), drift="False"), "drift must be True or False, got 'False'"),
        (lambda: LAYERED.integral(NOWHERE, drift=True), "route must be one that was found"),
        (lambda: LAYERED.cell_sum(NOWHERE), "route must be one that was found"),
        (lambda: LAYERED.fatalities(NOWHERE), "route must be one that was found"),
        (lambda: RiskMap(City(TOWN.occupied), 0.03, 0.5).threat, "city must know its buildings, not only voxels"),
    ],
)
def test_wrong_questions_are_refused_by_name(call, message):
    with pytest.raises(ValueError, match=message):
        call()
