"""The fence around a mission, with a margin, and no-fly zones in it."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import example, given, settings
from hypothesis import strategies as st
from missions import CENTIMETRE, DELFT, table1, way

from uavlab.city import City, NoFlyZone
from uavlab.mission import Mission
from uavlab.mission.fences import exclusions, inclusion, polygon_on
from uavlab.route import Route
from uavlab.vehicle import LIGHT_QUADROTOR

OPEN = City(np.zeros((60, 60, 12), bool), 5.0, reference=DELFT, name="open")
ALONG = Route([(50, 50, 30), (250, 50, 30), (250, 200, 30)])


def zone(west, south, east, north, lower=0.0, upper=np.inf, holes=(), name="zone"):
    return NoFlyZone([(west, south), (east, south), (east, north), (west, north)], lower, upper, holes, name)


def areas(mission, city):
    """Polygons of the fence on the map, by whether to stay inside."""
    found = {True: [], False: []}
    for polygon in mission.fence:
        found[polygon.inclusion].append(polygon_on(mission.place_on(city), polygon))
    return found


@settings(max_examples=100)
@given(
    st.lists(st.tuples(st.integers(10, 280), st.integers(10, 280)), min_size=1, max_size=8),
    st.floats(0.5, 60.0),
)
@example([(18, 61), (74, 190), (222, 236)], 1.0)  # cut corners may be shorter than a centimetre
def test_all_points_are_inside_with_the_margin(plan, margin):
    """A single point and points on a line too."""
    fence = inclusion(DELFT, np.array(plan, float), margin)
    area = polygon_on(DELFT, fence)
    assert area.is_valid
    assert area.contains(shapely.MultiPoint(plan).convex_hull.buffer(margin - CENTIMETRE, quad_segs=64))
    assert not area.contains(shapely.MultiPoint(plan).convex_hull.buffer(1.2 * margin + 0.1, quad_segs=64))
    assert len(set(fence.corners)) == len(fence.corners) >= 3


@pytest.mark.parametrize("end", ["land", "return"])
def test_the_fence_holds_way_home_and_rally_points(end):
    home = OPEN.to_geographic((20, 60, 0))[:2]
    mission = Mission.from_route(
        ALONG, OPEN, LIGHT_QUADROTOR, home=home, rally=[(100, 250, 5), (280, 20, 0.5)], fence_margin=15.0, end=end
    )
    (area,) = areas(mission, OPEN)[True]
    inside = [*way(mission, OPEN)[:, :2], (20, 60), (100, 250), (280, 20)]
    for point in inside:
        assert area.exterior.distance(shapely.Point(point)) >= 15.0 - CENTIMETRE
        assert area.contains(shapely.Point(point))
    back = shapely.LineString([way(mission, OPEN)[-1, :2], (20, 60)])
    assert area.contains(back.buffer(15.0 - CENTIMETRE))


def test_a_greater_margin_is_a_wider_fence():
    narrow, wide = (
        areas(Mission.from_route(ALONG, OPEN, LIGHT_QUADROTOR, fence_margin=margin), OPEN)[True][0]
        for margin in (20.0, 40.0)
    )
    assert wide.contains(narrow.buffer(18.0))
    usual = Mission.from_route(ALONG, OPEN, LIGHT_QUADROTOR)
    assert areas(usual, OPEN)[True][0].equals_exact(narrow, CENTIMETRE)


def test_zones_stay_outside():
    city = replace(OPEN, no_fly=[zone(100, 100, 120, 130, name="school"), zone(10, 270, 30, 290, name="far")])
    mission = Mission.from_route(ALONG, city, LIGHT_QUADROTOR)
    school, far = areas(mission, city)[False]
    assert shapely.hausdorff_distance(school, shapely.box(100, 100, 120, 130)) < CENTIMETRE
    assert shapely.hausdorff_distance(far, shapely.box(10, 270, 30, 290)) < CENTIMETRE
    assert [polygon.name for polygon in mission.fence] == ["fence", "school", "far"]
    assert [polygon.inclusion for polygon in mission.fence] == [True, False, False]
    assert not any("fence leaves out" in note for note in mission.notes)


@pytest.mark.parametrize(("lower", "upper"), [(0.0, 20.0), (45.0, np.inf)])
def test_a_zone_that_the_way_passes_above_or_below_is_left_out_and_told(lower, upper):
    """A fence knows no heights: no autopilot would take the mission."""
    city = replace(OPEN, no_fly=[zone(100, 40, 120, 60, lower, upper, name="airway")])
    mission = Mission.from_route(ALONG, city, LIGHT_QUADROTOR)
    assert areas(mission, city)[False] == []
    assert "the fence leaves out airway: the way crosses it in plan" in mission.notes


@pytest.mark.parametrize("end", ["land", "return"])
def test_a_zone_that_only_the_way_home_crosses_is_left_out_only_then(end):
    city = replace(OPEN, no_fly=[zone(140, 100, 160, 140, 0.0, 10.0, name="market")])
    mission = Mission.from_route(ALONG, city, LIGHT_QUADROTOR, end=end)
    left_out = "the fence leaves out market: the way crosses it in plan" in mission.notes
    assert left_out is (end == "return")
    assert len(areas(mission, city)[False]) == int(end == "land")


def test_one_may_fly_in_a_hole_of_a_zone():
    hole = [(80, 80), (120, 80), (120, 120), (80, 120)]
    ring = zone(60, 60, 140, 140, holes=[hole], name="ring")
    city = replace(OPEN, no_fly=[ring])
    inside = Mission.from_route(Route([(90, 90, 30), (110, 110, 30)]), city, LIGHT_QUADROTOR)
    pieces = areas(inside, city)[False]
    assert len(pieces) > 1
    assert all(piece.is_valid and not piece.interiors for piece in pieces)
    assert shapely.union_all(pieces).symmetric_difference(ring.polygon).area < 1.0
    closed, crossed = exclusions(city, DELFT, np.array([(0, 90, 30), (100, 90, 30)]))
    assert (closed, crossed) == ([], ["ring"])


def test_a_zone_with_a_bay_is_one_polygon():
    bay = NoFlyZone([(100, 100), (160, 100), (160, 160), (130, 110), (100, 160)], name="bay")
    city = replace(OPEN, no_fly=[bay])
    (area,) = areas(Mission.from_route(ALONG, city, LIGHT_QUADROTOR), city)[False]
    assert shapely.hausdorff_distance(area, bay.polygon) < CENTIMETRE


def test_fences_are_where_the_map_is():
    """By the city's own way to longitude and latitude."""
    city = table1()
    mission = Mission.from_route(Route([(5, 5, 30), (5, 95, 30)]), city, LIGHT_QUADROTOR, fence_margin=10.0)
    corners = np.array(mission.fence[0].corners)
    on_map = city.from_geographic(np.column_stack([corners[:, ::-1], np.zeros(len(corners))]))[:, :2]
    assert -5.9 < on_map[:, 0].min() <= -5.0
    assert 105.0 <= on_map[:, 1].max() < 105.9
