"""Distances of segments against all boxes, one by one, by a search that knows nothing of planes and columns."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

from uavlab.city import City
from uavlab.city.segments import distance_to_box, least_clearance, runs_of, segment_clearance
from uavlab.planners.grid import MOVES

maps = arrays(bool, array_shapes(min_dims=3, max_dims=3, min_side=1, max_side=8))
halves = st.integers(-4, 20).map(lambda number: number / 2)  # on faces, edges, corners and centres
numbers = st.one_of(halves, st.floats(-2, 10).map(lambda number: round(number, 3)))
points = arrays(float, 3, elements=numbers)


def nearest_box(occupied, start, end):
    """Least distance of a segment to all boxes: golden section, as the distance to a box along it is convex."""
    boxes = np.argwhere(occupied)
    low, high = np.zeros(len(boxes)), np.ones(len(boxes))

    def distance(share):
        point = start + share[:, None] * (end - start)
        return np.linalg.norm(np.maximum(np.maximum(boxes - point, point - boxes - 1), 0), axis=1)

    for _ in range(90):
        first, second = low + 0.382 * (high - low), low + 0.618 * (high - low)
        left = distance(first) <= distance(second)
        low, high = np.where(left, low, first), np.where(left, second, high)
    return distance((low + high) / 2).min(initial=np.inf)


@given(maps, points, points, st.floats(0, 12))
@settings(deadline=None, max_examples=400)
def test_distance_is_that_to_the_nearest_of_all_boxes(occupied, start, end, at_most):
    right = nearest_box(occupied, start, end)
    runs = runs_of(occupied)
    assert segment_clearance(runs, start, end, at_most) == pytest.approx(min(right, at_most), rel=0, abs=1e-7)
    if occupied.any():
        assert segment_clearance(runs, start, end, 99.0) == pytest.approx(right, rel=0, abs=1e-7)
        clearance = City(occupied).clearance
        way = np.array([start, end, start[::-1]])
        whole = min(right, nearest_box(occupied, end, start[::-1]))
        assert least_clearance(runs, clearance, 1.0, way) == pytest.approx(whole, rel=0, abs=1e-7)


@given(points, points, st.integers(-3, 3), st.integers(1, 6))
@settings(deadline=None, max_examples=300)
def test_distance_to_one_box_is_the_least_of_dense_samples(start, end, low, height):
    shares = np.linspace(0, 1, 4001)[:, None]
    sampled = start + shares * (end - start)
    low_corner, high_corner = np.array([2, 3, low]), np.array([3, 4, low + height])
    gap = np.linalg.norm(np.maximum(np.maximum(low_corner - sampled, sampled - high_corner), 0), axis=1).min()
    distance = distance_to_box(start, end, 2, 3, low, low + height)
    assert gap - np.linalg.norm(end - start) / 8000 <= distance <= gap + 1e-12


@given(maps)
@settings(deadline=None, max_examples=100)
def test_runs_are_the_occupied_voxels(occupied):
    runs = runs_of(occupied)
    again = np.zeros_like(occupied)
    for i, j in np.ndindex(occupied.shape[:2]):
        column = slice(runs.first[j + occupied.shape[1] * i], runs.first[j + occupied.shape[1] * i + 1])
        for low, high, inner in zip(runs.low[column], runs.high[column], runs.inner[column], strict=True):
            assert not again[i, j, max(low - 1, 0) : high].any()  # apart from each other
            again[i, j, low:high] = True
            around = [
                0 <= a < occupied.shape[0] and 0 <= b < occupied.shape[1] and occupied[a, b, low:high].all()
                for a, b in ((i - 1, j), (i + 1, j), (i, j - 1), (i, j + 1))
            ]
            assert inner == all(around)
    assert np.array_equal(again, occupied)
    assert not any(array.flags.writeable for array in runs[1:])


def test_within_a_block_and_beside_it_columns_around_do_not_hide_what_is_nearest():
    occupied = np.zeros((12, 12, 8), bool)
    occupied[2:10, 2:10, :5] = True
    runs = runs_of(occupied)
    for start, end, right in (
        ((5.5, 5.5, 1.5), (6.5, 5.5, 2.5), 0.0),
        ((5.5, 5.5, 6.5), (6.5, 5.5, 5.5), 0.5),
        ((5.5, 5.5, 7.5), (5.5, 5.5, 5.25), 0.25),
        ((0.5, 0.5, 2.5), (0.5, 11.5, 2.5), 1.5),
        ((0.5, 5.5, 2.5), (0.5, 5.5, 2.5), 1.5),
    ):
        assert segment_clearance(runs, np.array(start), np.array(end), 50.0) == right


@pytest.mark.parametrize("cell", [0.1, 1.0, 5.0])
@pytest.mark.parametrize("origin", [(0.0, 0.0, 0.0), (5e6, -5e6, 100.0)])
def test_a_city_s_segment_distance_is_in_metres_wherever_it_lies(cell, origin):
    rng = np.random.default_rng(1)
    city = City(rng.random((14, 11, 9)) < 0.03, cell, origin)
    starts, ends = (rng.uniform(*city.bounds, (40, 3)) for _ in range(2))
    distance = city.segment_distance(starts, ends)
    right = [
        cell * nearest_box(city.occupied, (start - city.origin) / cell, (end - city.origin) / cell)
        for start, end in zip(starts, ends, strict=True)
    ]
    assert distance == pytest.approx(np.array(right), rel=0, abs=1e-7 * cell)
    assert city.segment_distance(starts, ends, at_most=cell) == pytest.approx(np.minimum(distance, cell), abs=1e-12)
    one = city.segment_distance(starts[0], ends.reshape(8, 5, 3))
    assert one.shape == (8, 5)
    assert one[2, 3] == city.segment_distance(starts[0], ends[13])
    assert np.isinf(City(np.zeros((3, 3, 3), bool)).segment_distance((1, 1, 1), (2, 2, 2)))


@pytest.mark.parametrize(
    ("start", "end", "at_most", "message"),
    [
        ((1, 1), (2, 2), 1.0, r"start must have shape \(..., 3\), got \(2,\)"),
        ((1, 1, 1), (2, 2, np.nan), 1.0, "end must be finite, got nan"),
        (np.ones((2, 3)), np.ones((3, 3)), 1.0, "start, end and at_most must be as many, or one for all"),
        ((1, 1, 1), (2, 2, 2), -1.0, "at_most must be a distance in metres, at least 0, got -1"),
        ((1, 1, 1), (2, 2, 2), np.nan, "at_most must be a distance in metres, at least 0, got nan"),
    ],
)
def test_what_is_no_segment_is_refused(start, end, at_most, message):
    with pytest.raises(ValueError, match=message):
        City(np.zeros((3, 3, 3), bool)).segment_distance(start, end, at_most=at_most)


@given(arrays(bool, (5, 5, 5)), st.sampled_from(MOVES.tolist()), st.floats(0, 3))
@settings(deadline=None, max_examples=400)
def test_moves_on_the_grid_between_centres_that_keep_a_clearance_keep_it_all_along(occupied, move, clearance):
    """Every voxel of a move's bounding box keeps it, see `uavlab.planners.grid`; so the whole move does."""
    city = City(occupied)
    start, end = np.array([2, 2, 2]), np.array([2, 2, 2]) + move
    box = tuple(slice(low, high + 1) for low, high in zip(np.minimum(start, end), np.maximum(start, end), strict=True))
    least = city.clearance[box].min()
    if clearance <= least and least > 0:
        assert city.segment_distance(start + 0.5, end + 0.5) >= clearance - 1e-12
