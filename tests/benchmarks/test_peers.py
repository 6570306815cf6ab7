"""The benchmark's contenders do the same work: untimed, on small maps, with the peers that every test run has."""

import math

import astar as benchmark
import flight as flying
import numpy as np
import pytest

from uavlab.city import City, table1_city
from uavlab.flight import Autopilot, fly
from uavlab.planners import penalty_zone
from uavlab.resilience import Controller
from uavlab.route import Route
from uavlab.vehicle import LIGHT_QUADROTOR
from uavlab.weather import Wind
from uavlab.weather.wind import gust_deviations


@pytest.fixture(scope="module")
def city():
    return table1_city(4.0)


@pytest.fixture(scope="module")
def pairs(city):
    return benchmark.random_pairs(city, 3, seed=2022)


@pytest.fixture(scope="module")
def noise(city):
    return benchmark.smooth_price(city.shape, seed=1, sigma=2.0)


def costs(contender, pairs, price=None):
    return benchmark.compete([contender], pairs, price)[contender.name].costs


def test_pairs_are_free_far_apart_and_repeatable(city, pairs):
    for start, goal, source, target in pairs:
        assert city.is_free([start, goal]).all()
        assert np.linalg.norm(goal - start) >= 40.0
        assert city.center_of([source, target]) == pytest.approx(np.array([start, goal]))
    again = benchmark.random_pairs(city, 3, seed=2022)
    assert [pair.source for pair in again] == [pair.source for pair in pairs]


def test_cost_of_a_route():
    points = np.array([[0, 0, 0], [1, 0, 0], [2, 1, 1]])
    assert benchmark.cost_of(points) == pytest.approx(1 + math.sqrt(3))
    price = np.ones((3, 2, 2))
    price[2, 1, 1] = 5.0
    assert benchmark.cost_of(points, price) == pytest.approx(1 + 3 * math.sqrt(3))


def test_scipy_agrees_in_the_city(city, pairs, noise):
    for price in (None, noise, penalty_zone(city, 6.0, penalty=2.0)):
        ours = costs(benchmark.ours(city, price), pairs, price)
        assert costs(benchmark.scipy_dijkstra(city, price), pairs, price) == pytest.approx(ours, rel=1e-9)


def test_scikit_image_agrees_where_there_is_no_corner_to_cut(city, pairs, noise):
    empty = City(np.zeros_like(city.occupied), city.cell)
    ours = costs(benchmark.ours(empty, noise), pairs, noise)
    assert costs(benchmark.scikit_image(empty, noise), pairs, noise) == pytest.approx(ours, rel=1e-9)


def test_scikit_image_is_never_dearer_in_the_city(city, pairs, noise):
    ours = costs(benchmark.ours(city, noise), pairs, noise)
    theirs = costs(benchmark.scikit_image(city, noise), pairs, noise)
    assert (theirs <= ours * (1 + 1e-9)).all()
    assert benchmark.scikit_image(city).note == "cuts corners"


def test_a_legal_move_keeps_its_bounding_box_free():
    occupied = np.zeros((2, 2, 2), bool)
    occupied[1, 0, 0] = True
    assert not benchmark.legal(occupied, (1, 1, 1))[0, 0, 0]
    assert benchmark.legal(occupied, (0, 1, 1))[0, 0, 0]
    assert not benchmark.legal(occupied, (-1, 0, 0))[0, 0, 0]  # leaves the map


def test_the_bits_for_dijkstra3d_are_the_legal_moves():
    corner = benchmark.voxel_graph(np.zeros((2, 2, 2), bool))[0, 0, 0]
    bits = {bit for bit in range(32) if corner >> bit & 1}
    assert bits == {0, 2, 4, 6, 10, 12, 18}  # +x, +y, +z, xy, xz, yz, xyz, in the order of its README
    occupied = np.random.default_rng(3).random((6, 5, 4)) < 0.2
    graph = benchmark.graph_of(City(occupied), np.ones(occupied.shape))
    assert np.bitwise_count(benchmark.voxel_graph(occupied)).sum() == graph.nnz


def test_a_line_is_free_when_it_touches_nothing():
    occupied = np.zeros((4, 4, 4), bool)
    occupied[1, 1, 0] = True
    is_free = benchmark.free_line(City(occupied, 2.0, origin=(10, 0, 0)))
    assert is_free((11, 1, 1), (17, 1, 1))
    assert not is_free((11, 1, 1), (15, 5, 1))  # through it
    assert not is_free((11, 5, 1), (15, 1, 1))
    assert not is_free((11, 3, 1), (13, 5, 1))  # touches its edge
    assert not is_free((13, 3, 1), (13, 3, 1))
    assert not is_free((9, 1, 1), (11, 1, 1))  # from outside of the map


def test_shortcuts_shorten(city, pairs):
    routes = costs(benchmark.ours(city), pairs) * city.cell
    once = costs(benchmark.ours_shortened(city), pairs)
    any_angle = costs(benchmark.ours_any_angle(city), pairs)
    assert (once <= routes + 1e-9).all()
    assert any_angle.sum() <= once.sum()
    assert any_angle.sum() < routes.sum() - 1.0


def test_tables_are_printed(city, pairs, capsys):
    benchmark.expansions(city, pairs)
    contenders = [benchmark.ours(city), benchmark.scikit_image(city)]
    benchmark.print_results("Title", contenders, benchmark.compete(contenders, pairs))
    printed = capsys.readouterr().out
    assert "### Title\n\n|  | total [s] | times ours |" in printed
    assert "| scikit-image MCP_Geometric | " in printed
    octile, euclidean, zero = (int(line.split("|")[2].replace(",", "")) for line in printed.splitlines()[5:8])
    assert octile < euclidean < zero


def test_the_large_map_is_searched_from_a_file(tmp_path):
    np.save(tmp_path / "occupied.npy", np.zeros((20, 20, 20), bool))
    found = benchmark.search_large(str(tmp_path / "occupied.npy"), np.full(3, 0.6), np.full(3, 4.6))
    assert found["expanded"] == 16
    assert 0 < found["before"] <= found["after"]


@pytest.fixture(scope="module")
def corner():
    return Route(np.array([[0.0, 0.0, 20.0], [15.0, 0.0, 20.0], [25.0, 10.0, 24.0]]))


@pytest.fixture(scope="module")
def sky(corner):
    return flying.sky_of("6 m/s, OU", len(flying.reference_of(corner, LIGHT_QUADROTOR).position), seed=1)


def test_the_point_mass_flies_through_recorded_air_as_fly_does(corner, sky):
    def now(time):
        step = min(round(time / flying.TIME_STEP), len(sky.air) - 1)
        return Wind(tuple(sky.air[step]), "none") if step else Wind(gusts="none")  # planned in calm air

    calm_first = sky._replace(air=np.vstack([np.zeros(3), sky.air[1:]]))
    track = flying.point_mass(corner, LIGHT_QUADROTOR, 1.6, calm_first, trimmed=False)
    autopilot = Autopilot(Controller("", 1.0, 1.6), trimmed=False, gps=flying.STATE_GPS, interval=flying.TIME_STEP)
    flight = fly(corner, flying.empty_sky(), LIGHT_QUADROTOR, now, autopilot, rng=0)
    assert track == pytest.approx(flight.position, abs=1e-9)
    reference = flying.reference_of(corner, LIGHT_QUADROTOR)
    assert reference.position == pytest.approx(flight.reference, abs=1e-9)
    assert flying.across(reference, track) == pytest.approx(np.hypot(*flight.offset[:, 1:].T).mean(), rel=0.2)


def test_a_known_mean_wind_leaves_the_gusts(corner, sky):
    still = sky._replace(air=np.tile(sky.mean, (len(sky.air), 1)))
    reference = flying.reference_of(corner, LIGHT_QUADROTOR)
    blown, held, gusty = (
        flying.across(reference, flying.point_mass(corner, LIGHT_QUADROTOR, 1.6, air, trimmed))
        for air, trimmed in ((still, False), (still, True), (sky, True))
    )
    assert held < 0.1 * blown
    assert held < 0.5 * gusty


def test_wind_has_the_mean_and_the_gusts_that_it_is_called_by():
    for kind, (speed, _) in flying.KINDS.items():
        sky = flying.sky_of(kind, 200_000, seed=3)
        assert np.linalg.norm(sky.mean) == pytest.approx(speed)
        gusts = sky.air - sky.mean
        # σ from T = 4 000 s of gusts with the correlation time τ is some √(τ/2T) off: 1 % for OU's 1 s, 5 % for the
        # 20 s of Dryden's longest; four times that is allowed
        if kind.endswith("Dryden"):
            along = gusts @ np.array([*sky.mean[:2], 0.0]) / speed
            level, _, up = gust_deviations(Wind((speed, 0.0), "dryden"), 30.0)
            assert [along.std(), gusts[:, 2].std()] == pytest.approx([level, up], rel=0.2)
        if kind.endswith("OU"):
            assert gusts.std(axis=0) == pytest.approx(speed / 3 * np.array([1.0, 1.0, 0.5]), rel=0.05)
            lagged = (gusts[50:] * gusts[:-50]).mean(axis=0) / gusts.var(axis=0)
            assert lagged == pytest.approx(np.full(3, np.exp(-1.0)), abs=0.1)


def test_the_error_is_the_distance_across_the_direction_of_flight(corner):
    reference = flying.reference_of(corner, LIGHT_QUADROTOR)
    direction = reference.velocity / np.linalg.norm(reference.velocity, axis=1, keepdims=True)
    assert flying.across(reference, reference.position + 0.7 * direction) == pytest.approx(0.0, abs=1e-9)
    side = np.cross(direction, [0.0, 0.0, 1.0])
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    assert flying.across(reference, reference.position + 0.7 * side) == pytest.approx(0.7)
    aside = reference.position + np.array([0.3, -0.2, 0.1])
    assert flying.across(reference, aside) > 0.1
    assert flying.across(reference, aside, centred=True) == pytest.approx(0.0, abs=1e-9)


def test_the_peer_is_told_the_same_reference_and_the_same_air(corner, sky):
    reference = flying.reference_of(corner, LIGHT_QUADROTOR)
    push = np.tile([0.0, 0.0, 0.5], (len(reference.position), 1))
    trajectory = flying.Trajectory(reference, push, along=False)
    assert trajectory.update(0.0)["x"] == pytest.approx(corner.points[0])
    for step in (1, 7, 200):
        told = trajectory.update(step * flying.TIME_STEP)
        assert told["x"] == pytest.approx(reference.position[step])
        assert told["x_dot"] == pytest.approx(reference.velocity[step])
        assert told["x_ddot"] == pytest.approx(reference.acceleration[step] + push[0])
        half = trajectory.update((step + 0.5) * flying.TIME_STEP)
        assert half["x"] == pytest.approx(reference.position[step : step + 2].mean(axis=0))
    assert trajectory.update(1e9)["x"] == pytest.approx(reference.position[-1])
    wind = flying.Recorded(sky.air)
    met = [wind.update((step + 1) / flying.RATE, corner.points[0]) for step in range(2 * len(sky.air))]
    assert np.array(met) == pytest.approx(np.repeat(sky.air, 2, axis=0))
