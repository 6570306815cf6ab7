"""Surfaces to solids: no point of a surface may be lost, whatever the surfaces are."""

import numpy as np
import pytest
from files import BOX, TRIANGULATED_BOX, box

from uavlab.city import Building
from uavlab.city.relief import feet_of, ground_below
from uavlab.city.solids import Body, Column, bare_walls, enclosed, filled
from uavlab.city.terrain import Terrain

NEAR = 5e-3
"""What a piece may be off [m]: files have three decimals."""


def body(vertices, surfaces, tight=False):
    points = np.array(vertices, dtype=float)
    return Body([[points[ring] for ring in rings] for rings in surfaces], tight)


def outside(pieces, points):
    """Distance [m] of points (N, 3) from the nearest of convex pieces, at most; 0 within."""
    nearest = np.full(len(points), np.inf)
    for hull in Building(tuple(pieces)).hulls:
        beyond = (points @ hull.equations[:, :3].T + hull.equations[:, 3]).max(axis=1)
        nearest = np.minimum(nearest, np.maximum(beyond, 0))
    return nearest


def points_on(surface, rng, count=40):
    """Points (N, 3) on a triangle, or on a convex quadrilateral in a plane."""
    shares = rng.dirichlet(np.ones(len(surface[0])), count)
    return shares @ surface[0]


@pytest.mark.parametrize("seed", range(8))
def test_no_point_of_any_surface_is_lost(seed):
    rng = np.random.default_rng(seed)
    triangles = rng.uniform(0, 10, (12, 3, 3)).round(3)
    upright = rng.uniform(0, 10, (6, 3, 3)).round(3)
    upright[:, 2, :2] = (upright[:, 0, :2] + upright[:, 1, :2]) / 2
    level = rng.uniform(0, 10, (6, 3, 3)).round(3)
    level[..., 2] = level[:, :1, 2]
    surfaces = [[triangle] for triangle in np.concatenate([triangles, upright, level])]
    points = np.concatenate([points_on(surface, rng) for surface in surfaces])
    between, _ = enclosed(Body(surfaces, False))
    assert outside(between, points).max() < NEAR
    below, _ = filled([Body(surfaces, False)], 0.0)
    assert outside(below, points).max() < NEAR
    under = points * np.column_stack([np.ones((len(points), 2)), rng.random(len(points))])
    from_roofs = np.repeat([True, False, True], [12 * 40, 6 * 40, 6 * 40])
    assert outside(below, under[from_roofs]).max() < NEAR


@pytest.mark.parametrize("surfaces", [BOX, TRIANGULATED_BOX])
@pytest.mark.parametrize("tight", [True, False])
def test_box_is_one_piece_with_or_without_its_walls(surfaces, tight):
    pieces, solid = enclosed(body(box((0, 0, 2), (4, 3, 7)), surfaces, tight))
    assert (len(pieces), solid) == (1, True)
    assert outside(pieces, np.array([(2, 1.5, 4.0), (0, 0, 2), (2, 1.5, 1.0)])).tolist() == pytest.approx([0, 0, 1])


def test_planes_that_cross_keep_what_is_between_them():
    column = Column(np.array([(0, 0), (2, 0), (2, 2), (0, 2.0)]), np.array([(1, 0, 0), (-1, 0, 2.0)]))
    assert outside([column.corners], np.array([(0, 1, 1), (2, 1, 1), (0, 1, 0), (0, 1, 2.0)])).max() < 1e-9


def test_wall_is_cut_where_columns_hide_it():
    wall = body([(0, 0, 0), (10, 0, 0), (10, 0, 5), (0, 0, 5)], [[[0, 1, 2, 3]]]).surfaces
    column = Column(np.array([(2, 0), (6, 0), (6, 3), (2, 3.0)]), np.array([(0, 0, 0), (0, 0, 5.0)]))
    slabs = bare_walls([column], [column.corners], wall)
    assert outside(slabs, np.array([(1, 0, 2), (8, 0, 4.0)])).max() == 0
    assert outside(slabs, np.array([(4, 0, 2.5)]))[0] == pytest.approx(2, abs=NEAR)
    assert len(bare_walls([], [], wall)) == 1
    assert bare_walls([column], [column.corners], []) == []


def test_feet_are_the_lowest_floor_never_a_roof_or_a_balcony():
    house = box((0, 0, 2), (4, 3, 7)) + box((4, 0, 5), (6, 3, 5.2))
    floor = [ring for shell in (BOX, [[[i + 8 for i in ring] for ring in rings] for rings in BOX]) for ring in shell]
    assert {tuple(foot) for foot in feet_of([body(house, floor)])} == {(0, 0, 2), (4, 0, 2), (4, 3, 2), (0, 3, 2)}
    slope = [(x, y, z + 0.25 * x) for x, y, z in house[:8]]
    assert {tuple(foot) for foot in feet_of([body(slope, BOX)])} == {(0, 0, 2), (4, 0, 3), (4, 3, 3), (0, 3, 2)}
    walls = feet_of([body(house[:8], BOX[2:])])
    assert set(walls[:, 2]) == {2}


def test_ground_is_level_where_all_feet_are():
    feet = np.array([(0, 0, 1), (5, 0, 1.0), (5, 5, 1.0)])
    assert ground_below([], np.empty((0, 3))) == 0
    assert ground_below([], feet) == 1
    slope = ground_below([], np.array([(0, 0, 1), (5, 0, 1.0), (5, 5, 6.0)]))
    assert isinstance(slope, Terrain)
    assert slope.heights_at([(5, 2.5), (9, 9)]) == pytest.approx([3.5, 6])


def test_relief_wins_over_feet_within_it():
    relief = body([(0, 0, 3), (9, 0, 3), (9, 9, 3), (0, 9, 3)], [[[0, 1, 2, 3]]]).surfaces
    ground = ground_below(relief, np.array([(4, 4, 0.0), (19, 4, 0.0)]))
    assert ground.heights_at([(4, 4), (14, 4), (30, 4)]) == pytest.approx([3, 1.5, 0])
