"""Clearance and traversal against computations that share nothing with them."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

from uavlab.city.voxels import distance_to_obstacle, put_clearance, voxels_on_segment

maps = arrays(bool, array_shapes(min_dims=3, max_dims=3, max_side=7), elements=st.booleans())
on_grid = st.integers(-12, 12).map(lambda half: half / 2)
coordinate = st.one_of(st.floats(-6, 6, allow_subnormal=False), on_grid)
points = st.tuples(coordinate, coordinate, coordinate).map(lambda xyz: np.round(xyz, 9) + 0.0)


def nearest_box(occupied):
    """Squared distance from every centre to the nearest occupied unit box, by looking at all of them."""
    index = np.argwhere(np.ones_like(occupied))
    boxes = np.argwhere(occupied)
    gap = np.maximum(np.abs(index[:, None] - boxes[None]) - 0.5, 0.0)
    inside = (index[:, None] == boxes[None]).all(axis=-1)
    squared = np.where(inside, 0.0, (gap**2).sum(axis=-1))
    return squared.min(axis=1, initial=np.inf).reshape(occupied.shape)


def clearance_of(occupied, cell=1.0):
    clearance = np.full(occupied.shape, np.nan)
    put_clearance(occupied, cell, clearance)
    return clearance


@given(maps)
@settings(deadline=None, max_examples=200)
def test_clearance_is_the_distance_to_the_nearest_box(occupied):
    assert np.array_equal(clearance_of(occupied, 3.0), 3.0 * np.sqrt(nearest_box(occupied)))


@pytest.mark.parametrize("density", [0.002, 0.02, 0.3])
def test_clearance_on_larger_random_maps(density):
    occupied = np.random.default_rng(7).random((23, 17, 11)) < density
    assert occupied.any()
    assert np.array_equal(clearance_of(occupied, 3.0), 3.0 * np.sqrt(nearest_box(occupied)))


def test_clearance_is_infinite_without_obstacles_and_zero_within():
    assert np.isinf(clearance_of(np.zeros((3, 4, 5), bool))).all()
    assert not clearance_of(np.ones((3, 4, 5), bool)).any()


@given(maps, points, st.one_of(st.floats(0, 12), st.just(np.inf)))
@settings(deadline=None, max_examples=300)
def test_distance_from_any_point_is_that_to_the_nearest_box_as_far_as_it_is_to_be_exact(occupied, point, within):
    clearance = clearance_of(occupied)
    boxes = np.argwhere(occupied)
    gap = np.maximum(np.maximum(boxes - point, point - boxes - 1), 0.0)
    right = np.linalg.norm(gap, axis=1).min(initial=np.inf)
    distance = distance_to_obstacle(occupied, 3.0 * clearance, 3.0, point, within)
    if right <= within:
        assert distance == pytest.approx(right, rel=0, abs=1e-12)
    else:
        assert within - 1e-12 <= distance <= right + 1e-12


def crossed(start, end):
    """Voxels of a segment and the shares at which they are left, by sorting its crossings with all grid planes."""
    shares = [0.0, 1.0]
    for a, b in zip(start, end, strict=True):
        if a != b:
            planes = np.arange(np.ceil(min(a, b)), np.floor(max(a, b)) + 1)
            shares.extend((planes - a) / (b - a))
    shares = np.sort(shares)
    apart = shares[np.r_[True, np.diff(shares) > 1e-9]]
    apart[-1] = 1.0
    middle = start + np.outer((apart[:-1] + apart[1:]) / 2, end - start)
    return np.floor(middle).astype(int), apart[1:]


@given(points, points)
@settings(deadline=None, max_examples=500)
def test_segment_passes_the_voxels_between_its_crossings(start, end):
    if np.linalg.norm(end - start) < 1e-3:
        end = start + np.array([1.0, 0.25, -0.5])
    voxels, leave = voxels_on_segment(start, end)
    expected_voxels, expected_leave = crossed(start, end)
    stay, expected_stay = np.diff(leave, prepend=0.0), np.diff(expected_leave, prepend=0.0)
    assert leave[-1] == 1.0
    assert (stay > 0).all()
    assume(not (abs(np.log2(np.concatenate([stay, expected_stay]) / 1e-8)) < 1).any())  # which may round to either side
    kept = stay > 1e-8  # touching a voxel at its corner to rounding may count or not
    assert np.array_equal(voxels[kept], expected_voxels[expected_stay > 1e-8])


@pytest.mark.parametrize("signs", [(1, 1, 1), (-1, 1, 1), (1, -1, -1), (-1, -1, -1)])
def test_space_diagonal_goes_straight_through_corners(signs):
    voxels, leave = voxels_on_segment(np.full(3, 0.5), 0.5 + 3.0 * np.array(signs))
    assert np.array_equal(voxels, np.outer(range(4), signs))
    assert leave == pytest.approx([1 / 6, 3 / 6, 5 / 6, 1])


@pytest.mark.parametrize("signs", [(1, 1, 0), (-1, 0, 1), (0, -1, -1)])
def test_face_diagonal_goes_straight_through_edges(signs):
    voxels, _ = voxels_on_segment(np.full(3, 0.5), 0.5 + 40.0 * np.array(signs))
    assert np.array_equal(voxels, np.outer(range(41), signs))


def test_long_diagonals_do_not_drift():
    start, end = np.array([0.5, 0.5, 0.5]), np.array([900.5, 600.5, 300.5])  # through a corner every (3, 2, 1)
    voxels, leave = voxels_on_segment(start, end)
    back, back_leave = voxels_on_segment(end, start)
    assert np.array_equal(voxels, back[::-1])
    assert np.diff(leave, prepend=0.0) == pytest.approx(np.diff(back_leave, prepend=0.0)[::-1], abs=1e-9)


def test_a_point_gives_its_one_voxel():
    voxels, leave = voxels_on_segment(np.array([2.5, -0.5, 7.0]), np.array([2.5, -0.5, 7.0]))
    assert voxels.tolist() == [[2, -1, 7]]
    assert leave.tolist() == [1.0]


def test_ends_on_faces_add_no_empty_stay():
    voxels, _ = voxels_on_segment(np.array([3.0, 0.5, 0.5]), np.array([1.0, 0.5, 0.5]))
    assert voxels[:, 0].tolist() == [2, 1]
    voxels, _ = voxels_on_segment(np.array([1.0, 0.5, 0.5]), np.array([3.0, 0.5, 0.5]))
    assert voxels[:, 0].tolist() == [1, 2]
