"""Route: lengths, angles, the clearance of every metre, resampling, and its file."""

import csv
import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from uavlab.city import City
from uavlab.planners import astar, shortcut
from uavlab.route import Route, as_route

ZIGZAG = Route([(0, 0, 0), (3, 4, 0), (3, 4, 12), (3, 4, 12)])


def hallway():
    """A hallway of 20 × 5 × 5 voxels with a wall one voxel thin across it."""
    occupied = np.zeros((20, 5, 5), bool)
    occupied[10] = True
    return City(occupied)


def test_length_and_distance_add_up_the_legs():
    assert ZIGZAG.leg_lengths.tolist() == [5, 12, 0]
    assert ZIGZAG.length == 17
    assert ZIGZAG.distance.tolist() == [0, 5, 17, 17]


@pytest.mark.parametrize(
    ("leg", "pitch"),
    [
        ((1, 0, 0), 0.0),
        ((3, 4, 5), np.pi / 4),
        ((0, -2, -2), -np.pi / 4),
        ((np.sqrt(3), 0, 1), np.pi / 6),
        ((0, 0, 2), np.pi / 2),
        ((0, 0, -2), -np.pi / 2),
    ],
)
def test_pitch_is_the_climb_angle(leg, pitch):
    assert Route([(1, 2, 3), np.add((1, 2, 3), leg)]).pitch == pytest.approx([pitch])


@pytest.mark.parametrize("corners", [3, 4, 5, 6, 12])
@pytest.mark.parametrize("way_round", [1, -1])
def test_turns_of_a_regular_polygon_are_its_outer_angles(corners, way_round):
    angle = way_round * 2 * np.pi * np.arange(corners + 2) / corners
    polygon = Route(np.column_stack([np.cos(angle), np.sin(angle), 0.1 * np.arange(corners + 2)]))
    assert polygon.turn == pytest.approx(np.full(corners, 2 * np.pi / corners))


@pytest.mark.parametrize("heading", np.linspace(-3, 3, 7))
def test_u_turn_is_half_a_circle(heading):
    there = (np.cos(heading), np.sin(heading), 0.0)
    assert Route([(0, 0, 0), there, (0, 0, 1)]).turn == pytest.approx([np.pi])


def test_vertical_legs_keep_the_heading_of_the_leg_before():
    corner = Route([(0, 0, 0), (1, 0, 0), (1, 0, 5), (1, 0, 9), (1, 2, 9)])
    assert corner.turn == pytest.approx([0, 0, np.pi / 2])
    assert Route([(0, 0, 0), (0, 0, 5), (1, 1, 5), (1, 2, 5)]).turn == pytest.approx([0, np.pi / 4])
    assert Route([(0, 0, 0), (0, 0, 5), (0, 0, 2)]).turn.tolist() == [0]


def test_a_straight_line_neither_turns_nor_climbs():
    line = Route(np.outer(np.arange(5), (-1.0, 0.0, 0.0)))
    assert not line.turn.any()
    assert not line.pitch.any()


def test_clearance_sees_a_thin_wall_between_two_waypoints():
    city = hallway()
    through = Route([(5.5, 2.5, 2.5), (15.5, 2.5, 2.5)])
    assert city.clearance[5, 2, 2] == 4.5
    assert city.clearance[15, 2, 2] == 4.5
    assert through.clearance(city) == 0


def test_clearance_profile_is_the_distance_every_quarter_of_a_voxel():
    distance, clearance = Route([(5.5, 2.5, 2.5), (15.5, 2.5, 2.5)]).clearance_profile(hallway())
    assert distance == pytest.approx(np.arange(0, 10.1, 0.25))
    assert clearance == pytest.approx(np.maximum(np.abs(distance - 5) - 0.5, 0))


def test_clearance_profile_has_the_least_distance_between_its_samples():
    pole = np.zeros((20, 5, 5), dtype=bool)
    pole[10, 2] = True
    route = Route([(4.1, 0.3, 2.2), (16.5, 1.4, 2.2)])
    distance, clearance = route.clearance_profile(City(pole))
    assert clearance.min() == route.clearance(City(pole))
    assert (np.diff(distance) >= 0).all()
    assert (
        np.abs(np.diff(clearance)).max() <= np.diff(distance).max() + 1e-9
    )  # nobody comes nearer faster than it flies


def box_distances(city, points):
    """Distance of points (N, 3) to the nearest occupied voxel, from all of them [m]."""
    low = city.center_of(np.argwhere(city.occupied)) - city.cell / 2
    gap = np.maximum(np.maximum(low - points[:, None], points[:, None] - low - city.cell), 0)
    return np.linalg.norm(gap, axis=2).min(axis=1)


@pytest.mark.parametrize("origin", [(-4.0, 7.0, 1.0), (5e6, -5e6, 0.0)])
@pytest.mark.parametrize("cell", [0.1, 2.5, 5.0])
def test_clearance_is_the_least_distance_of_dense_samples_to_the_boxes(cell, origin):
    rng = np.random.default_rng(3)
    city = City(rng.random((12, 12, 12)) < 0.02, cell=cell, origin=origin)
    rounding = 4e-16 * np.abs(city.bounds).max()
    for _ in range(25):
        route = Route(rng.uniform(*city.bounds, (4, 3)))
        sampled = box_distances(city, route.resample(0.02 * cell).points)
        assert sampled.min() - 0.01 * cell - rounding <= route.clearance(city) <= sampled.min() + rounding
        distance, clearance = route.clearance_profile(city)
        assert clearance.min() == pytest.approx(route.clearance(city), abs=1e-9 * cell + 4 * rounding)
        points = np.stack([np.interp(distance, route.distance, axis) for axis in route.points.T], axis=1)
        lowest = clearance.argmin()  # its place is known to a hundredth of a voxel
        off = np.where(np.arange(len(distance)) == lowest, 0.02 * cell, 1e-9 * cell) + 4 * rounding
        assert (np.abs(box_distances(city, points) - clearance) <= off).all()


def test_clearance_of_a_long_route_takes_no_time(table1):
    points = table1.bounds[0] + 0.5 + 99 * np.random.default_rng(0).random((10_000, 3)) * (1, 1, 0.99)
    route = Route(points[np.argsort(points[:, 0])])
    route.clearance(table1)
    began = time.perf_counter()
    route.clearance(table1)
    assert time.perf_counter() - began < 1


def test_outside_of_the_map_there_is_no_clearance():
    city = hallway()
    distance, clearance = Route([(-1.5, 2.5, 2.5), (1.5, 2.5, 2.5)]).clearance_profile(city)
    assert clearance == pytest.approx([0] * 6 + [10 - distance[i] + 1.5 for i in range(6, 13)])
    assert Route([(-1.5, 2.5, 2.5), (1.5, 2.5, 2.5)]).clearance(city) == 0


def test_clearance_of_one_waypoint_is_its_own_and_of_none_unknown():
    assert Route([(5.7, 2.5, 2.5)]).clearance(hallway()) == pytest.approx(4.3)
    assert np.isnan(Route(np.empty((0, 3))).clearance(hallway()))
    assert np.isinf(Route([(1, 1, 1), (2, 2, 2)]).clearance(City(np.zeros((3, 3, 3)))))


def test_integral_weighs_each_voxel_by_the_metres_in_it():
    city = hallway()
    along = np.broadcast_to(np.arange(20)[:, None, None], city.shape)
    through = Route([(5.5, 2.5, 2.5), (15.5, 2.5, 2.5)])
    assert through.integral(city, along) == pytest.approx(5 / 2 + sum(range(6, 15)) + 15 / 2)
    assert through.integral(city, np.ones(city.shape)) == pytest.approx(through.length)


def test_integral_over_a_zone_is_the_metres_within_it():
    city = hallway()
    near = city.clearance < 3
    assert near.dtype == bool
    assert Route([(5.5, 2.5, 2.5), (15.5, 2.5, 2.5)]).integral(city, near) == pytest.approx(7)
    assert Route([(5.5, 1.5, 2.5), (8.5, 4.5, 2.5)]).integral(city, near) == pytest.approx(1.5 * np.sqrt(2))
    assert Route([(1.5, 1.5, 2.5), (6.5, 4.5, 2.5)]).integral(city, near) == 0


@pytest.mark.parametrize("seed", range(10))
def test_integral_agrees_with_fine_sampling(seed):
    rng = np.random.default_rng(seed)
    city = City(np.zeros((12, 10, 8), bool), cell=2.5, origin=(-4, 7, 1))
    values = rng.uniform(0, 1, city.shape)
    for zone in (values, values > 0.7):
        route = Route(rng.uniform(*city.bounds, (4, 3)))
        fine = route.resample(1e-3)
        middles = (fine.points[1:] + fine.points[:-1]) / 2
        sampled = zone[tuple(city.cell_of(middles).T)] @ fine.leg_lengths
        crossings = len(city.voxels_along(route.points)[0])
        assert route.integral(city, zone) == pytest.approx(sampled, abs=0.5e-3 * crossings)  # half a step at each
        assert Route(route.points[::-1]).integral(city, zone) == pytest.approx(route.integral(city, zone))


@pytest.mark.parametrize("seed", range(5))
def test_integral_of_the_price_is_what_planners_pay(seed):
    rng = np.random.default_rng(seed)
    city = City(rng.random((12, 12, 12)) < 0.1, cell=2.5, origin=(-4, 7, 1))
    price = rng.uniform(1, 5, city.shape)
    for start, goal in city.random_pairs(5, rng, apart=15):
        route = astar(city, start, goal, price=price)
        assert route.integral(city, price) == pytest.approx(route.cost)
        straight = shortcut(route, city, price=price)
        assert straight.integral(city, price) == pytest.approx(straight.cost)


@pytest.mark.parametrize("count", [0, 1])
def test_integral_of_less_than_two_waypoints_is_0(count):
    assert Route(np.ones((count, 3))).integral(hallway(), np.ones((20, 5, 5))) == 0


coordinate = st.floats(-1e3, 1e3).map(lambda x: round(x, 3))
routes = st.lists(st.tuples(coordinate, coordinate, coordinate), min_size=2, max_size=6).map(Route)


@given(routes, st.floats(0.5, 500))
@settings(deadline=None)
def test_resampling_keeps_all_waypoints_and_the_length(route, step):
    fine = route.resample(step)
    assert fine.length == pytest.approx(route.length)
    assert fine.leg_lengths.max() <= step * (1 + 1e-6)
    position = 0
    for waypoint in route.points:  # in order, to the last bit
        position += int(np.flatnonzero((fine.points[position:] == waypoint).all(axis=1))[0])
    assert np.array_equal(fine.points[-1], route.points[-1])


def test_resampling_divides_legs_evenly_and_keeps_the_rest_of_the_route():
    route = Route([(0, 0, 0), (3, 0, 0), (3, 1, 0)], planner="A*", cost=4.0, info={"expanded": 3})
    fine = route.resample(1.0)
    assert fine.points.tolist() == [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0], [3, 1, 0]]
    assert (fine.planner, fine.cost, fine.info) == ("A*", 4.0, {"expanded": 3})
    assert route.resample(100).points.tolist() == route.points.tolist()
    assert len(Route(np.empty((0, 3))).resample(1).points) == 0


@given(routes)
@settings(deadline=None, max_examples=30)
def test_csv_brings_back_every_float(tmp_path_factory, route):
    path = tmp_path_factory.mktemp("route") / "route.csv"
    route.to_csv(path)
    with open(path, newline="", encoding="utf-8") as file:
        header, *rows = csv.reader(file)
    assert header == ["x_m", "y_m", "z_m", "distance_m"]
    assert np.array_equal(np.array(rows, dtype=float), np.column_stack([route.points, route.distance]))


def test_csv_of_no_route_is_its_header(tmp_path):
    Route(np.empty((0, 3))).to_csv(tmp_path / "none.csv")
    assert (tmp_path / "none.csv").read_text(encoding="utf-8").strip() == "x_m,y_m,z_m,distance_m"


@pytest.mark.parametrize("count", [0, 1])
def test_less_than_two_waypoints_have_no_legs(count):
    route = Route(np.ones((count, 3)))
    assert route.length == 0
    assert route.distance.tolist() == [0.0] * count
    assert len(route.pitch) == len(route.turn) == len(route.leg_lengths) == 0


def test_a_route_does_not_change_with_the_array_that_it_came_from():
    points = np.zeros((2, 3))
    route = Route(points)
    points[1] = 5
    assert route.length == 0


def test_what_a_route_says_of_itself():
    assert repr(ZIGZAG) == "<Route by given: 17.0 m, 4 waypoints>"
    stuck = Route(np.empty((0, 3)), "A*", reached=False, reason="no free way")
    assert repr(stuck) == "<Route by A*: not reached, no free way>"


def test_a_route_keeps_plain_numbers_whatever_they_came_as():
    route = Route(
        [(1, 1, 1)],
        cost=np.float32(2.5),
        takeoff=np.int8(1),
        min_height=np.uint8(200),
        max_length=np.array(9),
        reached=np.True_,
    )
    kept = (route.cost, route.takeoff, route.min_height, route.max_length, route.reached)
    assert list(map(type, kept)) == [float, int, float, float, bool]
    assert kept == (2.5, 1, 200.0, 9.0, True)


def test_values_count_only_where_a_route_passes():
    values = np.full((20, 5, 5), np.nan)
    values[:, 1, 1] = 2.0
    assert Route([(1.5, 1.5, 1.5), (8.5, 1.5, 1.5)]).integral(hallway(), values) == pytest.approx(14.0)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Route([1.0, 2.0, 3.0]), r"points must have shape \(N, 3\), got \(3,\)"),
        (lambda: Route([(1.0, 2.0)]), r"points must have shape \(N, 3\), got \(1, 2\)"),
        (lambda: Route([(1.0, 2.0, np.nan)]), "points must be finite, got nan in it"),
        (lambda: Route([(1.0, np.inf, 2.0)]), "points must be finite"),
        (
            lambda: Route([(1, 1, 1), (2, 2, 2)]).integral(hallway(), np.ones((20, 5))),
            r"values must have the city's shape \(20, 5, 5\), got \(20, 5\)",
        ),
        (lambda: Route([(1, 1, 1)]).integral(hallway(), np.ones((5, 5, 20))), r"got \(5, 5, 20\)"),
        (lambda: Route([(1, 1, 1)]).integral(hallway(), 1.0), r"got \(\)"),
        (lambda: ZIGZAG.integral(hallway(), np.ones((20, 5, 5))), "the route leaves the map"),
        (lambda: Route([(1, 1, 1), (1, 1, 5)]).integral(hallway(), np.ones((20, 5, 5))), "the route leaves the map"),
        (lambda: ZIGZAG.resample(0), "step must be finite and above 0, got 0"),
        (
            lambda: Route([(1, 1, 1), (8, 1, 1)]).integral(hallway(), np.full((20, 5, 5), np.inf)),
            "values must be finite, got inf",
        ),
        (lambda: ZIGZAG.resample(1e-9), r"step must be at least 1.7e-06 m on 17 m of route, got 1e-09"),
        (lambda: ZIGZAG.resample("1"), r"step must be a number"),
        (lambda: Route([(1, 1, 1)], planner=None), "planner must be text, got None"),
        (lambda: Route([(1, 1, 1)], reached="no"), "reached must be True or False, got 'no'"),
        (lambda: Route([(1, 1, 1)], reason=3), "reason must be text, got 3"),
        (lambda: Route([(1, 1, 1)], cost="3"), "cost must be a number"),
        (lambda: Route([(1, 1, 1)], info=[]), "info must be a dict, got list"),
        (lambda: Route([(1, 1, 1)], takeoff=-1), "takeoff must be a whole number of at least 0, got -1"),
        (lambda: Route([(1, 1, 1)], landing=0.5), "landing must be a whole number of at least 0, got 0.5"),
        (lambda: Route([(1, 1, 1)], max_height="120"), "max_height must be a number"),
        (lambda: Route([(1, 1, 1)], max_length=None), "max_length must be a number"),
        (lambda: Route([(1, 1, 1)], priced=True), "priced must be text, got True"),
        (lambda: as_route(ZIGZAG, 3), "name must be text, got 3"),
        (lambda: as_route("ZIGZAG", "way"), "way must be a Route, got str"),
        (lambda: ZIGZAG.resample(-1.0), "above 0, got -1"),
        (lambda: ZIGZAG.resample(np.nan), "above 0, got nan"),
        (lambda: ZIGZAG.resample(np.inf), "above 0, got inf"),
    ],
)
def test_bad_routes_are_refused_with_the_reason(make, message):
    with pytest.raises(ValueError, match=message):
        make()


def test_resampled_routes_know_where_take_off_and_landing_end():
    route = Route([(0, 0, 0), (0, 0, 4), (9, 0, 4), (9, 0, 1)], takeoff=1, landing=1)
    fine = route.resample(1.0)
    assert (fine.takeoff, fine.landing) == (4, 3)
    assert fine.en_route.points[[0, -1]].tolist() == [[0, 0, 4], [9, 0, 4]]
    level = Route([(0, 0, 4), (9, 0, 4)]).resample(2.0)
    assert (level.takeoff, level.landing) == (0, 0)
