"""The benchmark's contenders do the same work: untimed, on small maps, with the peers that every test run has."""

import math

import astar as benchmark
import numpy as np
import pytest

from uavlab.city import City, table1_city
from uavlab.planners import penalty_zone


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
    twice = costs(benchmark.ours_shortened(city, tighter=True), pairs)
    assert (twice <= once + 1e-9).all()
    assert (once <= routes + 1e-9).all()
    assert twice.sum() < routes.sum() - 1.0


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
