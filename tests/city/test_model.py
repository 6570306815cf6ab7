"""City: codes, cells, freedom, clearance, traversal, and what is refused."""

import itertools
import re
import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog
from scipy.spatial import ConvexHull
from scipy.stats import chisquare

from uavlab.city import Building, City
from uavlab.city.rasterise import TOUCH

BOX = Building.prism([(2, 2), (5, 2), (5, 4), (2, 4)], 3, name="box")
EMPTY = np.zeros((4, 5, 6), bool)


def random_city(seed):
    rng = np.random.default_rng(seed)
    occupied = rng.random(rng.integers(3, 9, 3)) < rng.uniform(0.02, 0.3)
    return City(occupied, cell=rng.uniform(0.3, 7), origin=rng.uniform(-1e3, 1e3, 3))


def from_boxes(city, points):
    """Distance from points (N, 3) to the nearest occupied box, by looking at all of them."""
    low = city.origin + city.cell * np.argwhere(city.occupied)
    gap = np.maximum(np.maximum(low - points[:, None], points[:, None] - low - city.cell), 0.0)
    return np.linalg.norm(gap, axis=2).min(axis=1, initial=np.inf)


def random_points(city, seed, beyond=0.0, count=400):
    """Points anywhere in the map and so many voxels around it, some on faces, edges and corners of voxels."""
    rng = np.random.default_rng(seed)
    cells = rng.uniform(-beyond, np.array(city.shape) + beyond, (count, 3))
    on_faces = rng.random((count, 3)) < 0.2
    return city.origin + city.cell * np.where(on_faces, np.round(cells), cells)


@given(st.tuples(*[st.integers(1, 9)] * 3), st.data())
@settings(deadline=None)
def test_code_and_index_are_inverse_of_each_other(shape, data):
    city = City(np.zeros(shape, bool))
    i, j, k = index = tuple(data.draw(st.integers(0, n - 1)) for n in shape)
    code = city.code_of(index)
    assert code == k + shape[2] * (j + shape[1] * i)
    assert city.index_of(code).tolist() == list(index)


def test_codes_number_all_voxels_as_ravel_does():
    city = City(np.random.default_rng(0).random((4, 3, 5)) < 0.5)
    codes = np.arange(60)
    assert np.array_equal(city.code_of(city.index_of(codes)), codes)
    assert np.array_equal(city.occupied[tuple(city.index_of(codes).T)], city.occupied.ravel())
    assert city.index_of(codes.reshape(3, 4, 5)).shape == (3, 4, 5, 3)


@pytest.mark.parametrize("seed", range(5))
def test_center_lies_in_its_cell_and_cell_covers_half_an_edge_around_it(seed):
    city = random_city(seed)
    index = city.index_of(np.arange(city.occupied.size))
    for shift in itertools.product((-0.499, 0.0, 0.499), repeat=3):
        assert np.array_equal(city.cell_of(city.center_of(index) + city.cell * np.array(shift)), index)
    assert city.center_of((0, 0, 0)) == pytest.approx(city.origin + city.cell / 2)
    assert city.bounds == pytest.approx(np.array([city.origin, city.origin + city.cell * np.array(city.shape)]))


def test_a_cell_holds_its_lower_faces_but_not_its_upper_ones():
    city = City(EMPTY, cell=2.0, origin=(10, 0, 0))
    assert city.cell_of([(10, 0, 0), (11.999, 0, 0), (12, 0, 0), (9.999, 0, 0)])[:, 0].tolist() == [0, 0, 1, -1]


def test_free_is_inside_and_not_occupied():
    city = City.from_buildings([BOX], origin=(0, 0, 0), size=(8, 8, 8))
    assert city.is_free([(1, 1, 1), (3, 3, 5), (7.9, 7.9, 7.9)]).all()
    assert not city.is_free([(3, 3, 1), (2.1, 2.1, 2.9)]).any()
    assert not city.is_free([(-0.1, 1, 1), (1, 8, 1), (1, 1, 8), (1e9, 1, 1)]).any()
    assert city.is_free((1, 1, 1)).shape == ()


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 1e300])
def test_what_is_no_place_is_not_free(value):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert not City(EMPTY).is_free((value, 1, 1))


@pytest.mark.parametrize("seed", range(20))
def test_clearance_is_the_distance_from_center_to_nearest_occupied_voxel(seed):
    city = random_city(seed)
    centers = city.center_of(city.index_of(np.arange(city.occupied.size)))
    low = city.origin + city.cell * np.argwhere(city.occupied)
    outside = np.maximum(np.maximum(low[None] - centers[:, None], centers[:, None] - low[None] - city.cell), 0.0)
    nearest = np.linalg.norm(outside, axis=-1).min(axis=1, initial=np.inf)
    assert city.clearance.ravel() == pytest.approx(nearest, rel=1e-9, abs=1e-9 * city.cell)
    assert np.array_equal(city.clearance == 0, city.occupied)


def test_clearance_of_a_single_voxel_in_metres():
    occupied = np.zeros((7, 7, 7), bool)
    occupied[3, 3, 3] = True
    clearance = City(occupied, cell=2.0, origin=(100, -50, 3)).clearance
    assert clearance[3, 3, 3] == 0
    assert clearance[4, 3, 3] == pytest.approx(1)
    assert clearance[6, 3, 3] == pytest.approx(5)
    assert clearance[5, 5, 3] == pytest.approx(3 * np.sqrt(2))
    assert clearance[0, 0, 0] == pytest.approx(5 * np.sqrt(3))


@pytest.mark.parametrize("density", [0.001, 0.01, 0.2])
@pytest.mark.parametrize("seed", range(6))
def test_distance_is_exact_within_four_voxels_and_a_lower_bound_beyond(seed, density):
    rng = np.random.default_rng(seed)
    occupied = rng.random(rng.integers(10, 25, 3)) < density
    occupied[tuple(rng.integers(occupied.shape))] = True
    city = City(occupied, cell=rng.uniform(0.3, 7), origin=rng.uniform(-1e3, 1e3, 3))
    points = random_points(city, seed)
    right, distance = from_boxes(city, points), city.distance(points)
    near = right <= 4 * city.cell
    assert near.any()
    assert distance[near] == pytest.approx(right[near], rel=0, abs=1e-9)
    assert (distance[~near] >= 4 * city.cell - 1e-9).all()
    assert (distance <= right + 1e-9).all()
    assert (right - distance < 2 * city.cell).all()
    if density < 0.01:
        assert (right - distance > 0.5 * city.cell).any()  # so the bound is used


@pytest.mark.parametrize("within", [0.0, 0.3, 2.0, 7.5, 100.0, np.inf])
@pytest.mark.parametrize("seed", range(3))
def test_distance_is_exact_as_far_as_is_asked(seed, within):
    city = City(np.random.default_rng(seed).random((20, 15, 10)) < 0.002, cell=2.5, origin=(-7, 3, 100))
    points = random_points(city, seed)
    right, distance = from_boxes(city, points), city.distance(points, within)
    near = right <= within
    assert distance[near] == pytest.approx(right[near], rel=0, abs=1e-9)
    assert (distance[~near] >= within - 1e-9).all()
    assert (distance <= right + 1e-9).all()
    assert (right - distance < 2 * city.cell).all()
    assert near.all() == (within >= 100)


@pytest.mark.parametrize("seed", range(6))
def test_distance_beyond_the_map_is_that_to_the_obstacles_on_it(seed):
    city = random_city(seed)
    points = random_points(city, seed, beyond=15)
    outside = ~city.inside(points)
    right = from_boxes(city, points)
    assert (outside & (right <= 4 * city.cell)).any()
    distance = city.distance(points)
    near = right <= 4 * city.cell
    assert distance[near] == pytest.approx(right[near], rel=0, abs=1e-9)
    assert (distance <= right + 1e-9).all()
    assert (distance[~near] >= 4 * city.cell - 1e-9).all()
    assert city.distance(points, np.inf) == pytest.approx(right, rel=0, abs=1e-9)


@pytest.mark.parametrize("seed", range(5))
def test_distance_at_a_centre_is_the_clearance_there(seed):
    city = random_city(seed)
    centres = city.center_of(np.moveaxis(np.indices(city.shape), 0, -1))
    assert city.distance(centres) == pytest.approx(city.clearance, rel=0, abs=1e-9)


@pytest.mark.parametrize("seed", range(5))
def test_distance_is_zero_in_an_obstacle_and_nowhere_else(seed):
    city = random_city(seed)
    points = random_points(city, seed)
    whole = np.abs((points - city.origin) / city.cell % 1 - 0.5).max(axis=1) < 0.499  # off the faces
    inside, distance = city.inside(points), city.distance(points)
    assert (distance[inside & ~city.is_free(points)] == 0).all()
    assert (distance[city.is_free(points) & whole] > 0).all()


def test_without_obstacles_every_distance_is_infinite():
    points = random_points(City(EMPTY), 0, beyond=3)
    for within in (None, 0.0, 10.0, np.inf):
        assert np.isinf(City(EMPTY).distance(points, within)).all()


def test_distance_has_the_shape_of_the_points():
    city = random_city(1)
    points = random_points(city, 1, count=24)
    assert city.distance(points[0]).shape == ()
    assert city.distance(points[:0]).shape == (0,)
    together = city.distance(points.reshape(2, 3, 4, 3))
    assert together.shape == (2, 3, 4)
    assert np.array_equal(together.ravel(), [city.distance(point) for point in points])


def test_clearance_is_infinite_without_obstacles_and_computed_once():
    city = City(EMPTY)
    assert np.isinf(city.clearance).all()
    assert city.clearance is city.clearance


def box_city(cell=1.0):
    """A block of 3 × 3 × 3 voxels in the middle of 13 × 13 × 13."""
    occupied = np.zeros((13, 13, 13), bool)
    occupied[5:8, 5:8, 5:8] = True
    return City(occupied, cell)


@pytest.mark.parametrize("cell", [0.5, 4.0])
def test_normals_point_away_from_the_faces_edges_and_corners_of_a_block(cell):
    normal = box_city(cell).wall_normal
    for axis, side in itertools.product(range(3), (-1, 1)):
        away = np.eye(3)[axis] * side
        for steps in (2, 3, 6):  # from the block's centre; its faces are 1½ cells off
            assert normal[tuple((6 + steps * away).astype(int))] == pytest.approx(away)
    for signs in itertools.product((-1, 0, 1), repeat=3):
        if any(signs):
            expected = np.array(signs) / np.linalg.norm(signs)
            assert normal[tuple(6 + 4 * np.array(signs))] == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("seed", range(5))
def test_normals_are_unit_vectors_or_nothing_and_the_way_to_more_clearance(seed):
    city = random_city(seed)
    size = np.linalg.norm(city.wall_normal, axis=-1)
    assert city.wall_normal.shape == (*city.shape, 3)
    assert (np.isclose(size, 1) | (size == 0)).all()
    assert city.wall_normal is city.wall_normal
    for axis in range(3):
        rises = np.gradient(city.clearance, axis=axis)
        assert np.array_equal(np.sign(city.wall_normal[..., axis]), np.sign(np.where(size > 0, rises, 0)))


def test_between_two_walls_equally_near_there_is_no_direction_across():
    occupied = np.zeros((9, 5, 5), bool)
    occupied[[0, -1]] = True
    normal = City(occupied).wall_normal
    assert normal[:, 2, 2, 0].tolist()[1:8] == [1, 1, 1, 0, -1, -1, -1]
    assert (normal[4] == 0).all()


def test_without_obstacles_or_with_one_layer_only_there_is_nothing_to_point_from():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert (City(EMPTY).wall_normal == 0).all()
        assert (City(EMPTY).towards_wall((1, 2, 3)) == 0).all()
        flat = City(np.eye(5, dtype=bool)[:, :, None]).wall_normal
    assert (flat[..., 2] == 0).all()
    assert flat[0, 4, 0] == pytest.approx(np.array([-1, 1, 0]) / 2**0.5)


def test_what_points_towards_the_wall_is_the_part_of_a_vector_against_its_normal():
    city = box_city()
    east, corner = (8, 6, 6), (9, 9, 9)
    assert city.towards_wall((-3, 4, 5))[east] == pytest.approx(3)
    assert city.towards_wall((3, 4, 5))[east] == 0
    assert city.towards_wall((-1, -2, -3))[corner] == pytest.approx(6 / 3**0.5)
    assert city.towards_wall((-1, -2, 3.5))[corner] == 0
    assert (city.towards_wall((0, 0, 0)) == 0).all()


@given(st.tuples(*[st.floats(-10, 10)] * 3))
def test_a_vector_and_its_opposite_never_both_point_towards_the_wall(vector):
    city = box_city()
    there, back = city.towards_wall(vector), city.towards_wall(np.negative(vector))
    assert there.shape == city.shape
    assert (np.minimum(there, back) == 0).all()
    assert there - back == pytest.approx(-(city.wall_normal @ vector), abs=1e-12)
    assert there.max() <= np.linalg.norm(vector) * (1 + 1e-12) + 1e-100


@pytest.mark.parametrize("vector", [(1, 2), 3.0, (1, 2, np.nan), [(1, 2, 3)], (np.inf, 0, 0)])
def test_what_is_no_direction_is_refused(vector):
    with pytest.raises(ValueError, match=r"vector must (have shape|be finite)"):
        City(EMPTY).towards_wall(vector)


HOUSE = Building.roofed([(2, 3), (22, 3), (22, 13), (2, 13)], 5, [(7, 8, 10), (17, 8, 10)], name="hip roof")


def hip_roof(x, y):
    """Height of HOUSE: 5 m at the eaves, rising one in one from all four sides."""
    return 5 + np.minimum(np.minimum(x - 2, 22 - x), np.minimum(y - 3, 13 - y))


def heights(city):
    """Height of each centre above the map's floor, (nx, ny, nz)."""
    return np.broadcast_to(city.cell * (np.arange(city.shape[2]) + 0.5), city.shape)


def test_height_above_an_empty_map_is_that_above_its_floor():
    city = City(EMPTY, cell=2.0, origin=(3, 4, -50))
    assert city.height_above_surface == pytest.approx(heights(city))
    assert city.height_above_surface is city.height_above_surface


def test_height_above_a_box_is_exact_where_its_roof_cuts_through_voxels():
    city = City.from_buildings([Building.prism([(2, 2), (8, 2), (8, 6), (2, 6)], 7.3)], cell=2.0, margin=6)
    above, height = city.height_above_surface, heights(city)
    under = np.zeros(city.shape, bool)
    under[3:6, 3:5] = True  # the map begins at (−4, −4)
    assert above[~under] == pytest.approx(height[~under])
    assert above[under] == pytest.approx(np.where(height < 8, 0, height - 7.3)[under])
    assert above[3, 3, 4] == pytest.approx(9 - 7.3)


@pytest.mark.parametrize("cell", [0.5, 1.0, 1.7])
def test_height_above_a_hip_roof_is_that_above_its_highest_point_in_the_column(cell):
    city = City.from_buildings([HOUSE], cell=cell, origin=(0, 0, 0), size=(24, 16, 20))
    x, y, z = np.moveaxis(city.center_of(np.moveaxis(np.indices(city.shape), 0, -1)), -1, 0)
    half = cell / 2  # the roof rises towards its ridge, so it is highest at the point of the column nearest to that
    x, y = x + np.clip(12 - x, -half, half), y + np.clip(8 - y, -half, half)
    under = (x > 2) & (x < 22) & (y > 3) & (y < 13)
    roof = np.where(under, hip_roof(x, y), 0.0)
    expected = np.where(city.occupied, 0.0, z - roof)
    assert city.height_above_surface == pytest.approx(expected, abs=1e-5)


def test_height_below_a_floating_building_is_that_above_what_stands_there():
    yard = [(0, 0), (4, 0), (4, 4), (0, 4)]
    shed, bridge = Building.prism(yard, 3.5), Building.prism([(0, 0), (8, 0), (8, 4), (0, 4)], 9.2, bottom=6)
    for buildings in ([shed, bridge], [bridge, shed]):
        city = City.from_buildings(buildings, origin=(0, 0, 0), size=(10, 4, 13))
        above = city.height_above_surface
        assert above[2, 2] == pytest.approx([0, 0, 0, 0, 1, 2, 0, 0, 0, 0, 1.3, 2.3, 3.3])
        assert above[6, 2] == pytest.approx([0.5, 1.5, 2.5, 3.5, 4.5, 5.5, 0, 0, 0, 0, 1.3, 2.3, 3.3])
        assert above[9, 2] == pytest.approx(np.arange(13) + 0.5)


def test_height_in_a_city_of_voxels_goes_by_their_tops():
    occupied = np.zeros((2, 1, 6), bool)
    occupied[0, 0, [0, 3]] = True
    above = City(occupied, cell=2.0, origin=(0, 0, 100)).height_above_surface
    assert above[0, 0].tolist() == [0, 1, 3, 0, 1, 3]
    assert above[1, 0].tolist() == [1, 3, 5, 7, 9, 11]
    assert (City(np.ones((2, 2, 2), bool)).height_above_surface == 0).all()


@pytest.mark.parametrize("seed", range(8))
def test_height_above_any_buildings_is_found_by_looking_down(seed):
    """Bodies of any shape, overlapping, floating, cut by the border and the floor of a map that begins anywhere."""
    rng = np.random.default_rng(seed)
    origin = rng.uniform(-500, 500, 3)
    bodies = [
        Building.hull(origin + rng.uniform((-2, -2, -3), (14, 12, 10)) + rng.uniform(-4, 4, (8, 3))) for _ in range(5)
    ]
    outline = np.array([(0, 0), (6, 0), (6, 2), (2, 2), (2, 6), (0, 6)])
    ell = Building.prism(origin[:2] + rng.uniform(0, 5, 2) + outline, origin[2] + 8.5, bottom=origin[2] - 1)
    city = City.from_buildings([*bodies, ell], cell=1.3, origin=origin, size=(12, 11, 12))
    pieces = [ConvexHull(piece).equations for building in city.buildings for piece in building.pieces]
    for i, j in np.ndindex(city.shape[:2]):
        low, high = city.center_of((i, j, 0)) - 0.65, city.center_of((i, j, 0)) + 0.65
        tops = [highest_point(piece, low[:2] + TOUCH, high[:2] - TOUCH) for piece in pieces]
        for k in range(city.shape[2]):
            level = city.center_of((i, j, k))[2]
            if city.occupied[i, j, k]:
                assert city.height_above_surface[i, j, k] == 0
            else:
                surface = max(top for top in [origin[2], *tops] if top < level)
                assert city.height_above_surface[i, j, k] == pytest.approx(level - surface, abs=1e-6)


def highest_point(equations, low, high):
    """Highest z of a convex piece over a rectangle, by linear programming."""
    bounds = [*zip(low, high, strict=True), (None, None)]
    found = linprog([0, 0, -1], A_ub=equations[:, :3], b_ub=-equations[:, 3], bounds=bounds)
    return found.x[2] if found.status == 0 else -np.inf


@pytest.mark.parametrize("shift", [(1e4, -3e4, 250.0), (-0.37, 12.1, -80.0)])
def test_height_doesnt_depend_on_where_the_map_lies(shift):
    moved = Building.hull(HOUSE.pieces[0] + shift)
    here = City.from_buildings([HOUSE], origin=(0, 0, 0), size=(24, 16, 20))
    there = City.from_buildings([moved], origin=shift, size=(24, 16, 20))
    assert there.height_above_surface == pytest.approx(here.height_above_surface, abs=1e-6)


@pytest.mark.parametrize("seed", range(10))
def test_random_pairs_are_free_apart_and_clear(seed):
    city = City(np.random.default_rng(seed).random((8, 9, 7)) < 0.02, cell=2.5, origin=(-40, 3, 1))
    for apart, least in ((0.0, 0.0), (7.5, 0.0), (12.0, 2.5)):
        pairs = city.random_pairs(50, seed, apart=apart, min_clearance=least)
        assert pairs.shape == (50, 2, 3)
        index = city.cell_of(pairs)
        assert np.array_equal(city.center_of(index), pairs)
        assert city.is_free(pairs).all()
        assert city.clearance[tuple(np.moveaxis(index, -1, 0))].min() >= least
        assert np.linalg.norm(pairs[:, 1] - pairs[:, 0], axis=1).min() >= apart


def test_random_pairs_are_the_seed_s_or_the_generator_s(table1):
    pairs = table1.random_pairs(20, 6)
    assert np.array_equal(table1.random_pairs(20, 6), pairs)
    assert np.array_equal(table1.random_pairs(20, np.random.default_rng(6)), pairs)
    assert np.array_equal(table1.random_pairs(5, 6), pairs[:5])
    assert not np.array_equal(table1.random_pairs(20, 7), pairs)
    rng = np.random.default_rng(6)
    in_two_parts = [table1.random_pairs(12, rng), table1.random_pairs(8, rng)]  # each goes on where the last one ended
    assert np.array_equal(np.concatenate(in_two_parts), pairs)


def test_random_pairs_leave_the_global_state_alone():
    before = np.random.get_state()[1].tolist()  # noqa: NPY002
    City(EMPTY).random_pairs(10, 1, apart=1)
    assert np.random.get_state()[1].tolist() == before  # noqa: NPY002


@pytest.mark.parametrize("seed", range(5))
def test_random_pairs_are_drawn_evenly(seed):
    occupied = np.zeros((4, 3, 2), bool)
    occupied[1, 1] = True
    city = City(occupied)
    count = np.zeros(city.shape)
    np.add.at(count, tuple(city.cell_of(city.random_pairs(1100, seed, apart=0)).reshape(-1, 3).T), 1)
    assert not count[occupied].any()
    assert chisquare(count[~occupied]).pvalue > 1e-3  # 22 voxels, 100 times each


def test_random_pairs_may_keep_just_the_distances_asked_for():
    wall = np.zeros((9, 2, 1), bool)
    wall[0] = True
    pairs = City(wall).random_pairs(200, 3, apart=3.0, min_clearance=4.5)  # rows 4.5 to 7.5 m from the wall
    assert np.unique(pairs[..., 0]).tolist() == [5.5, 8.5]
    assert np.linalg.norm(pairs[:, 1] - pairs[:, 0], axis=1).min() == 3.0


def test_without_obstacles_every_clearance_is_kept():
    assert City(EMPTY).random_pairs(3, 0, apart=2, min_clearance=1e6).shape == (3, 2, 3)


grid_or_any = st.one_of(st.floats(-3, 9), st.integers(-6, 18).map(lambda half: half / 2))
polylines = st.lists(st.tuples(grid_or_any, grid_or_any, grid_or_any), min_size=2, max_size=5)


@given(polylines, st.floats(0.3, 5), st.tuples(*[st.floats(-100, 100)] * 3))
@settings(deadline=None, max_examples=300)
def test_traversal_stays_in_each_voxel_for_its_length(corners, cell, origin):
    city = City(EMPTY, cell=cell, origin=origin)
    points = city.origin + cell * np.array(corners)
    length = np.linalg.norm(np.diff(points, axis=0), axis=1)
    index, stays = city.voxels_along(points)
    assert stays.sum() == pytest.approx(length.sum(), abs=1e-9)
    assert (stays >= 0).all()
    flown = np.cumsum(stays)
    ends = np.concatenate([[0], np.cumsum(length)])
    for voxel, entered, left in zip(index, flown - stays, flown, strict=True):
        if left - entered > 1e-9:
            stay = [at_distance(points, ends, d) for d in (entered, (entered + left) / 2, left)]
            low = city.origin + cell * voxel
            assert (np.array(stay) >= low - 1e-6).all()  # convex: with its ends, all of the stay is inside
            assert (np.array(stay) <= low + cell + 1e-6).all()


def at_distance(points, ends, distance):
    return np.array([np.interp(distance, ends, points[:, axis]) for axis in range(3)])


def test_traversal_goes_through_corners_and_leaves_the_map():
    index, stays = City(EMPTY, cell=2.0).voxels_along(np.array([(1, 1, 1), (7, 7, 7), (7, 7, -3)]))
    assert index[:4].tolist() == [[0, 0, 0], [1, 1, 1], [2, 2, 2], [3, 3, 3]]
    assert index[4:].tolist() == [[3, 3, k] for k in (3, 2, 1, 0, -1, -2)]
    assert stays == pytest.approx([3**0.5, 2 * 3**0.5, 2 * 3**0.5, 3**0.5, 1, 2, 2, 2, 2, 1])


def test_a_single_waypoint_stays_nowhere():
    index, stays = City(EMPTY).voxels_along(np.array([(1.2, 2.3, 3.4)]))
    assert index.tolist() == [[1, 2, 3]]
    assert stays.tolist() == [0]


def test_extent_is_by_default_the_buildings_and_a_margin():
    floating = Building.prism([(0, 0), (1, 0), (1, 1)], 9, bottom=6)
    city = City.from_buildings([BOX, floating], margin=4)
    assert city.bounds.tolist() == [[-4, -4, 0], [9, 8, 13]]
    assert city.buildings == (BOX, floating)
    assert City.from_buildings([BOX], origin=(0, 0, 0), margin=4).bounds.tolist() == [[0, 0, 0], [9, 8, 7]]


def test_extent_is_rounded_up_to_whole_cells():
    assert City.from_buildings([], cell=0.7, origin=(0, 0, 0), size=(7, 7.1, 0.1)).shape == (10, 11, 1)


def test_what_sticks_out_of_the_map_is_cut_off():
    inside = City.from_buildings([BOX], origin=(3, 3, 1), size=(10, 10, 10))
    assert inside.occupied.sum() == 2 * 1 * 2
    assert inside.occupied[:2, 0, :2].all()
    assert not City.from_buildings([BOX], origin=(50, 50, 50), size=(5, 5, 5)).occupied.any()


@pytest.mark.parametrize("seed", range(10))
def test_occupied_is_where_a_building_contains_the_centre(seed):
    rng = np.random.default_rng(seed)
    buildings = [Building.hull(rng.uniform(-4, 14, 3) + rng.uniform(-4, 4, (8, 3))) for _ in range(4)]
    outline = np.array([(0, 0), (6, 0), (6, 2), (2, 2), (2, 6), (0, 6)])
    ell = Building.prism(outline + rng.uniform(0, 5, 2), 8.5)
    city = City.from_buildings([*buildings, ell], cell=0.7, origin=(-1, 0, 1), size=(12, 11, 10), voxels="centres")
    centers = city.center_of(np.moveaxis(np.indices(city.shape), 0, -1))
    assert np.array_equal(city.occupied, np.any([b.contains(centers) for b in city.buildings], axis=0))


def test_a_voxel_whose_centre_lies_on_a_face_is_occupied():
    building = Building.prism([(1.5, 2.5), (3.5, 2.5), (3.5, 4.5), (1.5, 4.5)], 3.5, bottom=0.5)
    occupied = City.from_buildings([building], origin=(0, 0, 0), size=(8, 8, 8), voxels="centres").occupied
    assert occupied.sum() == 3 * 3 * 4
    assert occupied[1:4, 2:5, 0:4].all()


def test_a_name_is_given_to_what_stands_at_a_point(table1):
    assert table1.building_at((65, 20, 30)) == "building '1 notch'"
    assert City(table1.occupied).building_at((65, 20, 30)) == "an obstacle"


def test_a_city_keeps_what_it_was_given():
    city = City([[[0, 1]]], cell=2, name="one", reference=(4.36, 52.0))
    assert city.occupied.dtype == bool
    assert city.occupied.tolist() == [[[False, True]]]
    assert (city.cell, city.name, city.reference, city.buildings) == (2.0, "one", (4.36, 52.0, 0.0), ())


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: City(EMPTY, cell=-1), "cell must be the edge of a voxel in metres, above 0, got -1"),
        (lambda: City(EMPTY, cell=0), "above 0, got 0"),
        (lambda: City(EMPTY, cell=np.nan), "above 0, got nan"),
        (lambda: City(EMPTY, cell=np.inf), "above 0, got inf"),
        (lambda: City.from_buildings([BOX], cell=-2), "above 0, got -2"),
        (lambda: City(np.zeros((0, 3, 3), bool)), r"occupied must be .* at least one voxel, got .*\(0, 3, 3\)"),
        (lambda: City(np.zeros((3, 3), bool)), r"occupied must be .* got .*\(3, 3\)"),
        (lambda: City(EMPTY, origin=(0, 0)), r"origin must be three finite numbers .* got \(0, 0\)"),
        (lambda: City(EMPTY, origin=(0, 0, np.nan)), "origin must be three finite numbers"),
        (lambda: City.from_buildings([BOX], origin=(0, np.inf, 0), size=(3, 3, 3)), "origin must be three finite"),
        (lambda: City.from_buildings([BOX], origin=(0, 0), size=(3, 3, 3)), "origin must be three finite"),
        (lambda: City.from_buildings([]), "buildings is empty, .* give origin and size"),
        (lambda: City.from_buildings([], size=(3, 3, 3)), "buildings is empty, .* give origin and size"),
        (lambda: City.from_buildings([BOX], origin=(0, 0, 0), size=(3, 0, 3)), "size must be three positive extents"),
        (lambda: City.from_buildings([BOX], origin=(0, 0, 0), size=(3, np.nan, 3)), "size must be three positive"),
        (lambda: City.from_buildings([BOX], origin=(0, 0, 0), size=(3, np.inf, 3)), "size must be three positive"),
        (lambda: City.from_buildings([BOX], origin=(0, 0, 0), size=3), "size must be three positive extents"),
        (
            lambda: City.from_buildings([BOX], cell=0.01, origin=(0, 0, 0), size=(10, 10, 10)),
            "cell=0.01 m gives 1000 × 1000 × 1000 voxels .* more than 500,000,000: use a cell of at least 0.0127 m",
        ),
        (lambda: City(EMPTY).random_pairs(0, 1), "count must be a whole number of at least 1, got 0"),
        (lambda: City(EMPTY).random_pairs(1, 1, min_clearance=-1), "min_clearance must be .* at least 0, got -1"),
        (lambda: City(EMPTY).code_of((4, 0, 0)), r"index \(4, 0, 0\) lies outside of the map of \(4, 5, 6\) voxels"),
        (lambda: City(EMPTY).code_of((0, -1, 0)), r"index \(0, -1, 0\) lies outside of the map"),
        (lambda: City(EMPTY).code_of((1, 1)), r"index must have shape \(..., 3\), got \(2,\)"),
        (lambda: City(EMPTY).index_of(120), "code must be from 0 to 119, got 120"),
        (lambda: City(EMPTY).index_of([3, -1]), "code must be from 0 to 119, got -1"),
        (lambda: City(EMPTY).is_free((1, 1)), r"points must have shape \(..., 3\), got \(2,\)"),
        (lambda: City(EMPTY).cell_of(1.0), r"points must have shape \(..., 3\), got \(\)"),
        (
            lambda: City(EMPTY, cell=2.5).random_pairs(3, 0, apart=100),
            "no 3 pairs found that are apart=100 m from each other and min_clearance=0 m from obstacles; "
            "the map measures 10 × 12.5 × 15 m",
        ),
        (
            lambda: City.from_buildings([BOX]).random_pairs(2, 0, apart=5, min_clearance=99),
            "no 2 pairs found that are apart=5 m from each other and min_clearance=99 m",
        ),
        (lambda: City(~EMPTY).random_pairs(1, 0, apart=0), "no 1 pairs found that are apart=0 m"),
        (lambda: City(EMPTY).random_pairs(1, 0, apart=np.nan), "apart must be finite and at least 0, got nan"),
        (lambda: City(EMPTY).random_pairs(10**6, 0), "count must be at most 100,000"),
        (lambda: City(EMPTY).distance((1, 1)), r"points must have shape \(..., 3\), got \(2,\)"),
        (lambda: City(EMPTY).distance(np.zeros((3, 4))), r"have shape \(..., 3\), got \(3, 4\)"),
        (lambda: City(EMPTY).distance(1.0), r"have shape \(..., 3\), got \(\)"),
        (lambda: City(EMPTY).distance((1, np.nan, 1)), "points must be finite"),
        (lambda: City(EMPTY).distance((1, 1, np.inf)), "points must be finite"),
        (lambda: City(EMPTY).distance((1, 1, 1), -0.5), "exact_within must be .* at least 0, got -0.5"),
        (lambda: City(EMPTY).distance((1, 1, 1), np.nan), "exact_within must be .* at least 0, got nan"),
        (lambda: City(EMPTY).voxels_along([(1, 1, 1), (1, np.inf, 1)]), "points must be finite"),
        (lambda: City(EMPTY).voxels_along([(1, 1, 1), (1e9, 1, 1)]), r"points must lie nearer to the map: .* 1e\+09"),
        (lambda: City(EMPTY).voxels_along([(1e20, 1, 1), (1e20, 2, 1)]), "points must lie nearer to the map"),
        (lambda: City(EMPTY + 2), "occupied must be True or False in each voxel, got 2"),
        (lambda: City(np.ma.masked_equal(EMPTY, 0)), "occupied has masked voxels"),
        (lambda: City(EMPTY, name=3), "name must be text, got 3"),
        (lambda: City(EMPTY, buildings=BOX), "buildings must be a list of Building, got Building"),
        (lambda: City(EMPTY, source="town.json"), "source must be a Source, got str"),
        (lambda: City(EMPTY, reference="Delft"), "reference must be a number .* got text"),
        (lambda: City(EMPTY, reference=(52.0,)), "reference must be a Place, or .* got"),
        (lambda: City(EMPTY, reference=(4.36, 152.0)), "latitude must be from -90 to 90 degrees .* got 152"),
        (lambda: City.from_buildings(BOX), "buildings must be a list of Building, got Building"),
        (lambda: City.from_buildings([BOX], terrain="flat"), "terrain must be a Terrain, got str"),
        (lambda: City.from_buildings([BOX], terrain=np.inf), "terrain must be finite, got inf"),
        (lambda: City(EMPTY).coordinates(3), r"axis must be 0 \(east\), 1 \(north\) or 2 \(up\), got 3"),
        (lambda: City(EMPTY).coordinates(-1), "axis must be a whole number of at least 0, got -1"),
        (lambda: City(EMPTY).center_of((0.5, 0, 0)), "index must be whole numbers, got 0.5"),
        (lambda: City(EMPTY).center_of(EMPTY), "index must be whole numbers, got True or False: numpy.argwhere"),
        (lambda: City(EMPTY).index_of(2.5), "code must be whole numbers, got 2.5"),
        (lambda: City(EMPTY).building_at([(1, 1, 1)]), r"point must have shape \(3,\), got \(1, 3\)"),
        (lambda: City(EMPTY).zone_building(BOX), "zone must be a NoFlyZone, got Building"),
        (lambda: City(EMPTY).blocked(min_height=5, max_height=5), r"max_height must be above min_height \(5 m\)"),
        (lambda: City(EMPTY).voxels_along([(1, 1), (1, 2)]), r"points must .* shape \(N, 3\), got .*\(2, 2\)"),
    ],
)
def test_bad_questions_are_refused_with_the_reason(make, message):
    with pytest.raises(ValueError, match=message):
        make()


@pytest.mark.parametrize("level", [5, np.int64(5), np.float32(5), np.uint8(5), np.array(5.0)])
def test_level_ground_is_the_same_in_any_kind_of_number(level):
    asked, city = (City.from_buildings([BOX], terrain=ground) for ground in (level, 5.0))
    assert np.array_equal(asked.bounds, city.bounds)
    assert np.array_equal(asked.occupied, city.occupied)
    assert np.array_equal(asked.ground, city.ground)


@pytest.mark.parametrize("kind", [np.uint8, np.int32, np.uint64, float])
def test_indices_and_codes_of_few_bits_are_counted_in_many(kind):
    city = City(np.zeros((12, 12, 12), bool))
    index = np.array([(1, 2, 3), (11, 10, 9)])
    assert city.code_of(index.astype(kind)).tolist() == city.code_of(index).tolist() == [171, 1713]
    assert city.code_of(index.astype(kind), as_printed=True).tolist() == city.code_of(index, as_printed=True).tolist()
    assert np.array_equal(city.center_of(index.astype(kind)), index + 0.5)
    assert city.index_of(np.array([5, 50], kind)).tolist() == [[0, 0, 5], [0, 4, 2]]
    assert len(city.random_pairs(np.uint8(3), 1, apart=2.0)) == 3


def test_the_cell_that_a_refusal_suggests_is_accepted_by_the_limit():
    with pytest.raises(ValueError, match="use a cell of at least") as refusal:
        City.from_buildings([], cell=0.1, origin=(0, 0, 0), size=(1000, 1000, 100))
    cell = float(re.search(r"at least ([\d.]+) m", str(refusal.value))[1])
    assert np.prod(np.ceil(np.array([1000, 1000, 100]) / cell)) <= 500e6
    assert 1000 * 1000 * 100 / cell**3 == pytest.approx(500e6, rel=0.05)


def test_node_codes_as_printed_run_from_left_to_right_back_to_front_and_top_to_bottom():
    """RISK-ACO section 1."""
    city = City(np.zeros((4, 3, 2), bool))
    index = np.array([(0, 2, 1), (1, 2, 1), (3, 2, 1), (0, 1, 1), (3, 0, 1), (0, 2, 0), (3, 0, 0)])
    assert city.code_of(index, as_printed=True).tolist() == [1, 2, 4, 5, 12, 13, 24]
    every = np.argwhere(~city.occupied)
    codes = city.code_of(every, as_printed=True)
    assert sorted(codes.tolist()) == list(range(1, 25))
    assert np.array_equal(city.index_of(codes, as_printed=True), every)
    for wrong in (0, 25):
        with pytest.raises(ValueError, match=rf"code must be from 1 to 24, got {wrong}"):
            city.index_of(wrong, as_printed=True)
    with pytest.raises(ValueError, match="as_printed must be True or False, got 'False'"):
        city.code_of((0, 0, 0), as_printed="False")
