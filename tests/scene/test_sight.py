"""The overview is from the side from which most of the ways is seen."""

import numpy as np
import pytest

from uavlab import scene
from uavlab.city import City
from uavlab.planners import astar, repare
from uavlab.route import Route
from uavlab.scene.camera import DIRECTIONS, axes_of
from uavlab.scene.content import drawing_of
from uavlab.scene.sight import evenly, in_sight, overview_of

USUAL = DIRECTIONS["overview"]


def walled(side):
    """A map of 40 m with a wall of 20 m along one of its sides, and a route at 5 m along it."""
    occupied = np.zeros((40, 40, 30), bool)
    place = {"south": np.s_[:, 10:12, :20], "north": np.s_[:, 28:30, :20], "east": np.s_[28:30, :, :20]}[side]
    occupied[place] = True
    ends = {"south": [(2, 14), (38, 14)], "north": [(2, 26), (38, 26)], "east": [(26, 2), (26, 38)]}[side]
    return City(occupied, name="Wall"), Route(np.array([(*end, 5.0) for end in ends]), "along the wall")


@pytest.mark.parametrize("side", ["south", "north", "east"])
def test_what_is_behind_a_wall_is_seen_from_the_other_side(side):
    city, route = walled(side)
    drawing = drawing_of(city, (route,))
    ways = evenly(route.points, 50)
    assert in_sight(city, ways, drawing.overview).mean() > 0.9
    outward = {"south": (0, -1, 0), "north": (0, 1, 0), "east": (1, 0, 0)}[side]
    assert axes_of(*drawing.overview)[2] @ outward < 0.2
    assert (drawing.overview == USUAL) == (side == "north")  # from the south-east it was seen before


def test_without_ways_or_without_need_it_is_the_usual_side(table1):
    assert drawing_of(table1, ()).overview == USUAL
    empty = City(np.zeros((20, 20, 10), bool))
    assert drawing_of(empty, (Route([(1, 1, 1), (19, 19, 9)], "r"),)).overview == USUAL
    high = Route([(10, 10, 99), (90, 90, 99)], "above all")
    assert drawing_of(table1, (high,)).overview == USUAL


@pytest.mark.parametrize("scattered", [False, True])
def test_line_of_sight_is_that_of_rays_step_by_step(table1, scattered):
    rng = np.random.default_rng(1)
    city = City(rng.random((100, 100, 100)) < 0.003, name="Single voxels") if scattered else table1
    places = rng.uniform((0, 0, 0), (100, 100, 90), (60, 3))
    places = places[city.is_free(places)]
    for side in (USUAL, (20.0, 10.0), (170.0, 60.0), (-90.0, 90.0)):
        toward = axes_of(*side)[2]
        ways = places[:, None] + np.arange(1.0, 400.0, 0.5)[:, None] * toward
        inside = ((ways >= 0) & (ways < 100)).all(axis=-1)
        free = np.ones(ways.shape[:2], bool)
        free[inside] = ~city.occupied[tuple(np.floor(ways[inside]).astype(int).T)]
        assert in_sight(city, places, side).tolist() == free.all(axis=1).tolist()


def test_a_little_more_in_sight_is_no_reason_to_turn():
    occupied = np.zeros((60, 60, 40), bool)
    occupied[30, :, :20] = True
    city = City(occupied, name="Wall")
    turned = {}
    for name, lowest, last in (("short dip", 15.5, 21), ("long dip", 8, 21), ("short, but the end", 21, 15)):
        way = [(28, 5, 21), (28, 30, 21), (28, 30, lowest), (28, 30, 21), (28, 55, 21), (28, 55, last)]
        drawing = drawing_of(city, (Route(np.array(way, float), "behind the wall's top"),))
        turned[name] = drawing.overview != USUAL
    assert turned == {"short dip": False, "long dip": True, "short, but the end": True}


def test_where_a_way_ends_counts_more(table1):
    """A crash behind a building is not hidden for the sake of the way to it."""
    occupied = np.zeros((60, 60, 40), bool)
    occupied[30:34, 20:40, :30] = True
    city = City(occupied, name="Slab")
    shown = {}
    for end in (36.0, 27.0):  # behind the slab as seen from the west, before it
        way = Route(np.array([(5, 45, 20), (33, 45, 20), (end, 30, 20)]), "w")
        drawing = drawing_of(city, (way,))
        shown[end] = drawing.overview
        assert in_sight(city, way.points[-1:], drawing.overview).all()
    assert axes_of(*shown[36.0])[2][0] > 0


def test_places_lie_evenly():
    places = evenly(np.array([(0.0, 0, 0), (10, 0, 0), (10, 30, 0)]), 5)
    assert places.tolist() == [[0, 0, 0], [10, 0, 0], [10, 10, 0], [10, 20, 0], [10, 30, 0]]
    assert evenly(np.array([(1.0, 2, 3), (1, 2, 3)]), 3).tolist() == 3 * [[1, 2, 3]]


def test_page_still_and_camera_agree(table1):
    far = (20, 8, 20), (80, 95, 60)
    routes = repare(table1, *far), astar(table1, *far)
    drawing = drawing_of(table1, routes)
    assert drawing.overview != USUAL
    ways = np.concatenate([route.points for route in routes])
    assert in_sight(table1, ways, drawing.overview).mean() > in_sight(table1, ways, USUAL).mean() + 0.2
    assert overview_of(table1, drawing) == drawing.overview
    assert scene.show(table1, *routes).still == scene.show(table1, *routes, camera=drawing.overview).still
