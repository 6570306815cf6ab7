"""The paper's map has the buildings and the voxels that the paper says."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from uavlab.city import City, table1_buildings, table1_city

VOXELS = {"1 notch": 37_360, "2 hip roof": 62_094, "3 frustum": 34_340, "4 floating": 7_500, "5 spire": 3_564}


def test_map_is_a_cube_of_100_metres_with_144858_occupied_voxels(table1):
    assert table1.shape == (100, 100, 100)
    assert table1.cell == 1.0
    assert np.array_equal(table1.bounds, [(0, 0, 0), (100, 100, 100)])
    assert table1.occupied.sum() == 144_858


def test_buildings_come_in_the_order_of_the_paper():
    assert [building.name for building in table1_buildings()] == list(VOXELS)


@pytest.mark.parametrize("building", table1_buildings(), ids=VOXELS)
def test_voxels_of_each_building(building):
    alone = City.from_buildings([building], origin=(0, 0, 0), size=(100, 100, 100), voxels="centres")
    assert alone.occupied.sum() == VOXELS[building.name]


@pytest.mark.parametrize(
    ("point", "occupied"),
    [
        ((65, 39, 69), True),  # below the ridge where both wings meet
        ((69, 20, 69), False),  # beside the ridge, above the roof
        ((90, 20, 30), False),  # in the notch
        ((22, 35, 64), True),
        ((80, 70, 89), True),
        ((71, 61, 89), False),  # beside the frustum's top
        ((32, 80, 50), True),
        ((32, 80, 30), False),  # below the floating building
        ((48, 58, 97), True),
        ((46, 55.5, 97), False),  # beside the spire
    ],
)
def test_roofs_notch_and_air_below_the_floating_building(table1, point, occupied):
    assert bool(~table1.is_free(point)) is occupied


@pytest.mark.parametrize("cell", [0.8, 2.0])
def test_other_resolutions_hold_the_same_volume_within_half_a_cell_of_the_surface(cell):
    city = table1_city(cell)
    surface = sum(ConvexHull(piece).area for building in city.buildings for piece in building.pieces)
    assert city.shape == (round(100 / cell),) * 3
    assert abs(city.occupied.sum() * cell**3 - 144_858) < 0.5 * (cell + 1) * surface


def test_colours_differ_between_buildings():
    assert len({building.color for building in table1_buildings()}) == 5
