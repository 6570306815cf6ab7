import numpy as np
import pytest
from scipy.optimize import linprog
from scipy.spatial import ConvexHull

from uavlab.city import Building, City
from uavlab.city.columns import area_of, share_out
from uavlab.city.rasterise import TOUCH, bilinear, range_of_ground


def random_piece(rng):
    """Corners of a convex body, some of them flat, some of them thin, in a cube of 6 m."""
    flat = rng.choice([1.0, 1.0, 0.3, 0.02], 3)
    return rng.uniform(0.5, 3) + flat * rng.uniform(0, 3, (rng.integers(4, 9), 3))


def reaches_into(equations, low, high):
    """Whether half-spaces have a point in a box, by linear programming."""
    bounds = list(zip(low, high, strict=True))
    return linprog(np.zeros(3), A_ub=equations[:, :3], b_ub=-equations[:, 3], bounds=bounds).status == 0


@pytest.mark.parametrize("seed", range(40))
def test_touched_voxels_are_those_that_linear_programming_finds(seed):
    rng = np.random.default_rng(seed)
    for piece in (random_piece(rng) for _ in range(5)):
        cell = rng.uniform(0.5, 1.5)
        city = City.from_buildings([Building.hull(piece)], cell=cell, origin=(0, 0, 0), size=(7, 7, 7))
        equations = ConvexHull(piece).equations
        low, high = piece.min(axis=0) // cell, piece.max(axis=0) // cell
        for index in np.ndindex(city.shape):
            if (index >= low - 1).all() and (index <= high + 1).all():
                corner = cell * np.array(index)
                assert city.occupied[index] == reaches_into(equations, corner + TOUCH, corner + cell - TOUCH)
            else:
                assert not city.occupied[index]


def test_what_only_touches_a_voxel_doesnt_occupy_it():
    box = Building.prism([(2, 2), (5, 2), (5, 4), (2, 4)], 3.0)
    assert City.from_buildings([box], origin=(0, 0, 0), size=(8, 8, 8)).occupied.sum() == 3 * 2 * 3
    wider = Building.prism([(2, 2), (5.001, 2), (5.001, 4), (2, 4)], 3.001)
    assert City.from_buildings([wider], origin=(0, 0, 0), size=(8, 8, 8)).occupied.sum() == 4 * 2 * 4


@pytest.mark.parametrize("cell", [0.5, 1.0, 2.0, 5.0])
def test_a_wall_thinner_than_a_voxel_is_there(cell):
    angle = np.radians(17)
    along, across = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    ends = np.array([(5.0, 8.0), np.array([5.0, 8.0]) + 25 * along])
    wall = Building.prism([ends[0], ends[1], ends[1] + 0.02 * across, ends[0] + 0.02 * across], 8.0)
    city = City.from_buildings([wall], cell=cell, origin=(0, 0, 0), size=(40, 30, 20))
    middle = ends[0] + np.linspace(0.001, 24.999, 2000)[:, None] * along + 0.01 * across
    assert not city.is_free(np.column_stack([middle, np.full(2000, 4.0)])).any()
    seen = City.from_buildings([wall], cell=cell, origin=(0, 0, 0), size=(40, 30, 20), voxels="centres")
    assert (seen.occupied & ~city.occupied).sum() == 0


@pytest.mark.parametrize("seed", range(5))
def test_shares_of_polygons_in_columns_add_up_to_them(seed):
    rng = np.random.default_rng(seed)
    triangles = rng.uniform(0, 9, (50, 3, 2))
    values = rng.uniform(0, 5, 50)
    sums, areas = np.zeros((9, 9)), np.zeros((9, 9))
    share_out(triangles, values, sums, areas)
    exact = np.array([area_of(triangle, 3) for triangle in triangles])
    assert areas.sum() == pytest.approx(exact.sum(), rel=1e-12)
    assert sums.sum() == pytest.approx(exact @ values, rel=1e-12)


def test_ground_between_centres_is_bilinear_and_its_range_holds_it():
    rng = np.random.default_rng(3)
    ground = rng.uniform(0, 5, (6, 4))
    lowest, highest = range_of_ground(ground)
    places = rng.uniform((0, 0), ground.shape, (5000, 2))
    heights = bilinear(ground, places)
    i, j = np.floor(places).astype(int).T
    assert (heights >= lowest[i, j] - 1e-12).all()
    assert (heights <= highest[i, j] + 1e-12).all()
    index = np.moveaxis(np.indices(ground.shape), 0, -1)
    assert bilinear(ground, index + 0.5) == pytest.approx(ground)
    slope = 0.3 * index[..., 0] - 0.7 * index[..., 1]
    inner = rng.uniform((0.5, 0.5), np.array(ground.shape) - 0.5, (100, 2))
    assert bilinear(slope, inner) == pytest.approx(0.3 * (inner[:, 0] - 0.5) - 0.7 * (inner[:, 1] - 0.5))
    assert bilinear(np.array([[2.0]]), np.array([[0.1, 0.9]])) == pytest.approx(2.0)
