"""What is nearer than a distance, against the clearance of all voxels, to the last bit."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

from uavlab.city import City, table1_city
from uavlab.city.near import bits_of, reaches_of, voxels_of
from uavlab.city.voxels import least_kept

maps = arrays(bool, array_shapes(min_dims=3, max_dims=3, max_side=8), elements=st.booleans())
cells = st.sampled_from([1.0, 0.1, 0.3, 1 / 3, 2.0, 7.7, 1e-3, 1e5])
exact = st.integers(1, 900).map(lambda quarters: np.sqrt(quarters) / 2)
"""Distances between centres and surfaces [cells]."""
distances = st.one_of(exact, exact.map(lambda d: d * (1 + 1e-9)), exact.map(lambda d: d + 2e-9), st.floats(1e-12, 1e9))


def both(city, min_clearance):
    """`blocked` before the city has its clearance, and the rule by it."""
    assert "clearance" not in vars(city)
    found = city.blocked(min_clearance)
    return found, city.clearance < least_kept(min_clearance, city.cell)


@given(maps, cells, distances)
@settings(deadline=None, max_examples=400)
def test_near_is_what_the_clearance_says(occupied, cell, distance):
    found, expected = both(City(occupied, cell), distance * cell)
    assert np.array_equal(found, expected)


@pytest.mark.parametrize("density", [0.0, 0.0005, 0.01, 0.2])
@pytest.mark.parametrize("shape", [(23, 17, 11), (1, 40, 64), (30, 1, 65), (12, 9, 130), (40, 40, 1)])
def test_near_on_larger_maps_and_columns_of_several_words(density, shape):
    occupied = np.random.default_rng(7).random(shape) < density
    for distance in (0.5, 1.5, 4.0, 9.3, 27.0, 39.9, 40.1, 200.0):
        found, expected = both(City(occupied, 2.0), 2.0 * distance)
        assert np.array_equal(found, expected), distance


@pytest.mark.parametrize("height", [1, 7, 8, 63, 64, 65, 128, 130])
def test_bits_are_the_voxels(height):
    occupied = np.random.default_rng(3).random((3, 5, height)) < 0.4
    bits = bits_of(occupied)
    assert bits.shape == (3, 5, -(-height // 64))
    k = height - 1
    assert bool(bits[1, 2, k // 64] >> np.uint64(k % 64) & np.uint64(1)) == occupied[1, 2, k]
    assert np.array_equal(voxels_of(bits, height), occupied)


def test_reaches_are_those_of_a_ball():
    # columns 0, 1, 2 away are 0, 0.5, 1.5 from the obstacle, and 1.5² + 1.5² < 2.2² < 1.5² + 2.5²
    assert reaches_of(2.2, 1.0, 10).tolist() == [[2, 2, 2], [2, 2, 2], [2, 2, 1]]
    assert reaches_of(0.5, 1.0, 10).tolist() == [[0]]
    assert len(reaches_of(1e9, 1.0, 10)) == 11


def test_near_needs_no_clearance_and_is_kept():
    city = table1_city(cell=5.0)
    near = city.blocked(5.0)
    assert "clearance" not in vars(city)
    assert city.blocked(5.0) is near
    assert not near.flags.writeable
    assert np.array_equal(city.clearance < 5.0, near)


@pytest.mark.parametrize("distance", [1.0, 1.5, 2.5, 4.0])
def test_what_is_exactly_as_far_as_is_kept_is_not_near(distance):
    asked = distance + 1e-9
    assert least_kept(asked, 1.0) == distance  # to the last bit
    occupied = np.zeros((11, 11, 11), dtype=bool)
    occupied[5, 5, 5] = True
    found, expected = both(City(occupied), asked)
    assert np.array_equal(found, expected)
    if distance % 1 == 0.5:
        assert not found[5, 5, 5 + round(distance + 0.5)]
