"""Figures: axes with units, equal scales, and data that is the route's."""

import numpy as np
import pytest

from uavlab import plot
from uavlab.city import City
from uavlab.planners import astar
from uavlab.route import Route


@pytest.fixture(scope="module")
def route(table1):
    return astar(table1, (90, 18, 30), (50, 44, 30), record=True)


def labels(figure):
    return [axes.get_xlabel() for axes in figure.axes] + [axes.get_ylabel() for axes in figure.axes]


def test_plan_has_equal_scales_and_the_route(table1, route):
    figure = plot.plan(table1, route)
    axes = figure.axes[0]
    assert axes.get_aspect() == 1.0
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("x, east [m]", "y, north [m]")
    assert any(np.array_equal(line.get_xydata(), route.points[:, :2]) for line in axes.lines)
    assert figure.legends[0].get_texts()[0].get_text() == "A*, 66.4 m"


def test_plan_shows_how_high_the_buildings_are(table1):
    image = plot.plan(table1).axes[0].images[0].get_array()
    assert image[70, 80] == 90  # row y, column x: the frustum
    assert np.ma.getmaskarray(image)[5, 5]


def test_section_cuts_at_the_height_asked_for(table1):
    image = plot.section(table1, 30.4).axes[0].images[0].get_array()
    assert image[18, 90] == pytest.approx(table1.clearance[90, 18, 30])
    assert np.ma.getmaskarray(image)[20, 65]  # building 1


def test_section_outside_of_the_map(table1):
    with pytest.raises(ValueError, match="height must lie on the map, 0 to 100 m, got 120"):
        plot.section(table1, 120)


def test_profile_draws_height_and_clearance(table1, route):
    above, below = plot.profile(table1, route, safe_distance=3.5).axes
    assert above.lines[0].get_ydata() == pytest.approx(route.points[:, 2])
    assert below.lines[0].get_ydata().min() == pytest.approx(route.clearance(table1))
    assert below.lines[1].get_ydata() == pytest.approx([3.5, 3.5])
    assert below.get_xlabel() == "distance flown [m]"


def test_expansions_needs_a_recorded_order(table1, route):
    assert "18,007 expanded" in plot.expansions(table1, route).axes[0].get_title()
    with pytest.raises(ValueError, match="record=True"):
        plot.expansions(table1, astar(table1, (90, 18, 30), (50, 44, 30)))


def test_bars_carry_their_numbers():
    axes = plot.bars({"octile": 12.0, "zero": 1234.0}, "expansions").axes[0]
    assert {text.get_text() for text in axes.texts} == {"12", "1,234"}


def test_still_names_its_axes(table1, route):
    axes = plot.still(table1, route).axes[0]
    assert axes.get_zlabel() == "z, up [m]"
    assert axes.collections


def test_route_that_did_not_arrive_is_named_and_not_drawn(table1):
    lost = Route(np.empty((0, 3)), "A*", reached=False, reason="no free way")
    for figure in (plot.plan(table1, lost), plot.profile(table1, lost), plot.still(table1, lost)):
        assert figure.axes
    assert plot.plan(table1, lost).legends[0].get_texts()[0].get_text() == "A*: not reached"


def test_voxel_surface_encloses_the_occupied_volume():
    occupied = np.random.default_rng(1).random((6, 7, 5)) < 0.4
    origin = np.array([3.0, -2.0, 1.0])
    triangles = plot.voxel_surface(City(occupied, cell=2.0, origin=origin)) - origin
    volume = np.einsum("ij,ij->i", triangles[:, 0], np.cross(triangles[:, 1], triangles[:, 2])).sum() / 6
    assert volume == pytest.approx(8 * occupied.sum())


def test_subdivided_triangles_keep_their_area():
    triangles = np.random.default_rng(2).random((5, 3, 3)) * 20

    def area(t):
        return np.linalg.norm(np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]), axis=1).sum()

    pieces = plot.subdivided(triangles, 3.0)
    assert area(pieces) == pytest.approx(area(triangles))
    assert np.linalg.norm(np.roll(pieces, -1, axis=1) - pieces, axis=2).max() <= 3.0


def test_empty_city_can_be_drawn():
    city = City(np.zeros((5, 5, 5), dtype=bool))
    assert plot.plan(city).axes
    assert plot.still(city).axes
