"""Missions flown by the simulated vehicle: order, corners, holds, fence, battery, home."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from uavlab.city import City, Place, Terrain
from uavlab.flight import GPS
from uavlab.mission import FencePolygon, Item, Mission
from uavlab.mission.corridor import cut_off, distance_to_leg
from uavlab.route import Route
from uavlab.vehicle_sim.pilot import CRASHED, HOLDING, READY
from uavlab.vehicle_sim.stages import rounded
from uavlab.weather import Wind

PLACE = Place(8.5, 47.25, 420.0)
SQUARE = [(0, 0, 30), (60, 0, 30), (60, 60, 30), (0, 60, 40)]


def ready(pilot, mission):
    pilot.watch(mission.fence)
    pilot.take(mission.items)
    assert pilot.arm() == ""
    assert pilot.start() == ""
    return pilot


def from_plan(mission, city, points):
    way = mission.path(city).points
    return np.min([distance_to_leg(points, a, b) for a, b in pairwise(way)], axis=0)


@pytest.mark.parametrize("altitudes", ["home", "sea", "terrain"])
def test_a_mission_is_flown_along_its_legs(campus, meadow, standing, flown, altitudes):
    route = Route(SQUARE)
    mission = Mission.from_route(route, meadow, campus.uav, speed=5.0, altitudes=altitudes, home=(8.5, 47.25, 420.0))
    pilot = ready(standing(meadow, (0, 0, 5)), mission)
    track, words, reached = flown(pilot)
    assert pilot.mode == READY
    assert not pilot.armed
    assert pilot.finished
    assert words == ["landed"]
    assert reached == [n for n, item in enumerate(mission.items) if item.command != 178]
    assert from_plan(mission, meadow, track[:, 1:]).max() < mission.corner_radius / 2 + 0.2
    assert track[-1, 1:] == pytest.approx([0, 60, 0], abs=0.3)
    assert track[:, 3].max() == pytest.approx(40.0, abs=0.3)


@pytest.mark.parametrize(("radius", "most"), [(1.0, 0.75), (4.0, 2.3), (8.0, 4.3)])
def test_corners_are_rounded_within_their_triangle(campus, meadow, standing, flown, radius, most):
    mission = Mission.from_route(Route(SQUARE), meadow, campus.uav, speed=3.0, corner_radius=radius)
    track, _, _ = flown(ready(standing(meadow, (0, 0, 5)), mission))
    off = from_plan(mission, meadow, track[:, 1:])
    assert off.max() < most
    assert off.max() > 0.2 * radius / 2


def test_the_way_around_a_corner_stays_in_the_triangle(campus, meadow):
    mission = Mission.from_route(Route(SQUARE), meadow, campus.uav, corner_radius=5.0)
    items = [item for item in mission.items if item.command == 16]
    points = np.array(SQUARE[1:], float)
    legs = [(n, point, 5.0, item) for n, (point, item) in enumerate(zip(points, items, strict=True))]
    stage = rounded(np.array(SQUARE[0], float), legs, 0.0)
    bound = cut_off(np.array([1.0, 0, 0]), np.array([0, 1.0, 0]), 5.0)
    way = np.array(SQUARE, float)
    apart = np.min([distance_to_leg(stage.points, a, b) for a, b in pairwise(way)], axis=0)
    assert apart.max() <= bound + 1e-9
    assert stage.reached[-1][0] == pytest.approx(
        np.linalg.norm(np.diff(np.vstack([SQUARE[0], stage.points]), axis=0), axis=1).sum()
    )


def test_it_stops_where_it_is_to_hold(campus, meadow, standing, flown):
    mission = Mission.from_route(Route(SQUARE), meadow, campus.uav, speed=5.0, hold=4.0)
    items = list(mission.items)
    corner = next(n for n, item in enumerate(items) if item.command == 16)
    items[corner] = items[corner]._replace(parameters=(3.0, 2.0, 0.0, 0.0))
    track, _, _ = flown(ready(standing(meadow, (0, 0, 5)), replace(mission, items=tuple(items))))
    for place, seconds in (((60, 0, 30), 3.0), ((0, 60, 40), 4.0)):
        near = np.linalg.norm(track[:, 1:] - place, axis=1) < 0.3
        assert seconds - 1.5 < 0.1 * near.sum() < seconds + 6


def test_speeds_change_on_the_way(campus, meadow, standing, flown):
    mission = Mission.from_route(Route(SQUARE), meadow, campus.uav, speed=[2.0, 8.0, 4.0])
    track, _, _ = flown(ready(standing(meadow, (0, 0, 5)), mission))
    speed = np.linalg.norm(np.gradient(track[:, 1:], track[:, 0], axis=0), axis=1)
    first = (track[:, 1] > 20) & (track[:, 1] < 50) & (track[:, 2] < 3)
    second = (track[:, 2] > 25) & (track[:, 2] < 40) & (track[:, 1] > 57)
    assert np.median(speed[first]) == pytest.approx(2.0, rel=0.05)
    assert np.median(speed[second]) == pytest.approx(8.0, rel=0.05)


def test_it_lands_on_a_roof_and_takes_off_from_it(campus, town, standing, flown):
    route = Route([(10, 10, 30), (50, 50, 30)])
    there = Mission.from_route(route, town, campus.uav, speed=5.0)
    pilot = ready(standing(town, (10, 10, 5)), there)
    track, _, _ = flown(pilot)
    assert track[-1, 3] == pytest.approx(20.0, abs=0.1)
    assert pilot.mode == READY
    back = Mission.from_route(Route([(50, 50, 30), (10, 10, 30)]), town, campus.uav, speed=5.0)
    assert back.items[0].altitude == pytest.approx(10.0)
    pilot = ready(standing(town, (50, 50, 40)), back)
    assert pilot.home[2] == pytest.approx(20.0)
    track, _, _ = flown(pilot)
    assert track[-1, 1:] == pytest.approx([10, 10, 0], abs=0.3)


def test_altitudes_above_terrain_follow_it(campus, standing, flown):
    """Over a ridge of 20 m between two waypoints that are 30 m above the ground."""
    x = np.linspace(0.0, 200.0, 41)
    ridge = np.tile(20.0 * np.exp(-(((x - 100.0) / 25.0) ** 2)), (41, 1))
    ground = Terrain.from_raster(ridge, (0.0, 0.0, 200.0, 200.0), beyond="nearest")
    city = City.from_buildings([], cell=5.0, origin=(0, 0, -5), size=(200, 200, 100), terrain=ground, reference=PLACE)
    route = Route([(20, 100, 30 + ridge[0, 4]), (180, 100, 30 + ridge[0, 36])]).resample(5.0)
    over = route.points.copy()
    over[:, 2] += 30 - city.height_above_ground(over)
    mission = Mission.from_route(Route(over), city, campus.uav, speed=5.0, altitudes="terrain", corridor=50.0)
    assert sum(item.command == 16 for item in mission.items) <= 2
    track, _, _ = flown(ready(standing(city, over[0]), mission))
    way = track[(track[:, 1] > 30) & (track[:, 1] < 170), 1:]
    assert city.height_above_ground(way) == pytest.approx(30.0, abs=1.5)
    assert way[:, 2].max() > 48


def test_what_stands_between_a_waypoint_and_the_landing_changes_nothing(campus, meadow, standing, flown):
    mission = Mission.from_route(Route(SQUARE), meadow, campus.uav, speed=5.0)
    slower = Item(178, 2, (1.0, 2.0, -1.0, 0.0))
    mission = replace(mission, items=(*mission.items[:-1], slower, mission.items[-1]))
    track, words, reached = flown(ready(standing(meadow, (0, 0, 5)), mission))
    assert words == ["landed"]
    assert reached == [0, 2, 3, 4, 6]
    assert track[-1, 1:] == pytest.approx([0, 60, 0], abs=0.3)


def test_a_mission_that_just_ends_hovers_there(campus, meadow, standing, flown):
    mission = Mission.from_route(Route(SQUARE), meadow, campus.uav, speed=5.0, end="stay")
    for items in (mission.items, mission.items[:-1]):
        pilot = ready(standing(meadow, (0, 0, 5)), replace(mission, items=items))
        track, _, _ = flown(pilot, seconds=120.0)
        assert track[-1, 1:] == pytest.approx([0, 60, 40], abs=0.3)
        assert pilot.armed


def test_it_crashes_where_there_is_a_wall(campus, town, standing, flown):
    mission = Mission.from_route(Route([(10, 50, 30), (90, 50, 30)]), town, campus.uav, speed=5.0)
    low = tuple(item._replace(altitude=10.0) if item.command in (16, 22) else item for item in mission.items)
    pilot = ready(standing(town, (10, 50, 5)), replace(mission, items=low))
    track, words, _ = flown(pilot)
    assert pilot.mode == CRASHED
    assert words[-1].startswith("crashed at (39.8, 50.0, 10.0)")
    assert track[-1, 1] == pytest.approx(40 - campus.uav.diameter / 2, abs=0.05)
    assert pilot.arm() == "it crashed"


def test_who_leaves_the_fence_goes_home(campus, meadow, standing, flown):
    mission = Mission.from_route(Route(SQUARE), meadow, campus.uav, speed=5.0)
    pilot = ready(standing(meadow, (0, 0, 5)), mission)
    pilot.watch((fence_of(meadow, [(-20, -20), (40, -20), (40, 80), (-20, 80)], True),))
    track, words, reached = flown(pilot)
    assert words == ["fence breached, going home", "landed"]
    assert 40 < track[:, 1].max() < 48
    assert track[-1, 1:] == pytest.approx([0, 0, 0], abs=0.3)
    assert not pilot.finished
    assert 3 not in reached


def test_a_fence_that_only_says_so(campus, meadow, standing, flown):
    mission = Mission.from_route(Route(SQUARE), meadow, campus.uav, speed=5.0)
    pilot = ready(standing(meadow, (0, 0, 5)), mission)
    pilot.fence_returns = False
    pilot.watch((fence_of(meadow, [(20, -5), (40, -5), (40, 5), (20, 5)], False),))
    track, words, _ = flown(pilot)
    assert words == ["fence breached", "landed"]
    assert track[-1, 1:] == pytest.approx([0, 60, 0], abs=0.3)


def fence_of(city, corners, inside):
    degrees = city.reference.longitude_latitude(np.array(corners, float))
    return FencePolygon(tuple((north, east) for east, north in degrees.tolist()), inside)


def test_who_has_only_the_reserve_left_goes_home(campus, meadow, standing, flown):
    mission = Mission.from_route(Route(SQUARE), meadow, campus.uav, speed=5.0)
    uav = replace(campus.uav, battery=11_000.0, reserve=0.6)
    pilot = ready(standing(meadow, (0, 0, 5), uav=uav), mission)
    track, words, _ = flown(pilot)
    assert words[0].startswith("battery: only the reserve is left")
    assert words[-1] == "landed"
    assert track[-1, 1:] == pytest.approx([0, 0, 0], abs=0.3)
    assert pilot.body.where.used < uav.battery


def test_an_empty_battery_ends_in_the_air(campus, meadow, standing, flown):
    mission = Mission.from_route(Route(SQUARE), meadow, campus.uav, speed=5.0)
    pilot = ready(standing(meadow, (0, 0, 5), uav=replace(campus.uav, battery=4000.0, reserve=0.1)), mission)
    _, words, _ = flown(pilot)
    assert pilot.mode == CRASHED
    assert words[-1].startswith("the battery is empty at")


def test_it_returns_at_the_height_that_it_was_told(campus, meadow, standing, flown):
    mission = Mission.from_route(Route(SQUARE), meadow, campus.uav, speed=5.0, end="return")
    pilot = standing(meadow, (0, 0, 5))
    pilot.return_height = 55.0
    track, _, _ = flown(ready(pilot, mission))
    assert track[:, 3].max() == pytest.approx(55.0, abs=0.3)
    assert track[-1, 1:] == pytest.approx([0, 0, 0], abs=0.3)
    assert pilot.finished


def test_the_nearest_rally_point_is_home_too(campus, meadow, standing, flown):
    mission = Mission.from_route(Route(SQUARE), meadow, campus.uav, speed=5.0)
    pilot = ready(standing(meadow, (0, 0, 5)), mission)
    pilot.rally = (np.array([70.0, 70.0, 0.0]),)
    flown(pilot, until=lambda p: p.body.where.position[1] > 40)
    assert pilot.go_home() == ""
    track, _, _ = flown(pilot)
    assert track[-1, 1:] == pytest.approx([70, 70, 0], abs=0.3)


def test_hold_land_and_go_on(campus, meadow, standing, flown):
    mission = Mission.from_route(Route(SQUARE), meadow, campus.uav, speed=5.0)
    pilot = ready(standing(meadow, (0, 0, 5)), mission)
    flown(pilot, until=lambda p: p.body.where.position[0] > 20)
    assert pilot.hold() == ""
    track, _, _ = flown(pilot, seconds=pilot.body.time + 10)
    assert pilot.mode == HOLDING
    assert np.ptp(track[-30:, 1:], axis=0).max() < 0.1
    assert pilot.start() == ""  # to the waypoint that it flew to, as fast as before
    track, _, _ = flown(pilot, until=lambda p: p.body.where.position[1] > 20)
    assert np.linalg.norm(np.diff(track[:, 1:], axis=0), axis=1).max() < 0.1 * 5.2
    assert np.linalg.norm(track[:, 1:] - (60, 0, 30), axis=1).min() < 2.0
    assert pilot.land_here() == ""
    track, words, _ = flown(pilot)
    assert words == ["landed"]
    assert track[-1, 3] == pytest.approx(0.0, abs=0.1)
    for told in (pilot.hold, pilot.land_here, pilot.go_home):
        assert told() == "it isn't flying"


def test_what_it_refuses(campus, meadow, standing):
    mission = Mission.from_route(Route(SQUARE), meadow, campus.uav)
    pilot = standing(meadow, (0, 0, 5))
    assert pilot.start() == "no mission"
    pilot.take(mission.items)
    assert pilot.start() == "not armed"
    pilot.arm()
    pilot.take(mission.items[2:])
    assert "must begin with a take-off" in pilot.start()


def test_gps_drifts_and_the_vehicle_with_it(campus, meadow, standing, flown):
    mission = Mission.from_route(Route(SQUARE), meadow, campus.uav, speed=5.0)
    pilot = ready(standing(meadow, (0, 0, 5), gps=GPS, wind=Wind((3.0, 0.0), deviation=1.0)), mission)
    flown(pilot, until=lambda p: p.body.time > 30)
    where = pilot.body.where
    assert np.linalg.norm(where.seen - where.position) > 0.3
    assert np.linalg.norm(where.seen - where.target) < 1.5


def test_the_same_seed_is_the_same_flight(campus, meadow, standing, flown):
    mission = Mission.from_route(Route(SQUARE), meadow, campus.uav, speed=5.0)
    windy = Wind((3.0, 0.0), deviation=1.0)
    one, same, other = (
        flown(ready(standing(meadow, (0, 0, 5), gps=GPS, wind=windy, seed=seed), mission))[0] for seed in (1, 1, 2)
    )
    assert np.array_equal(one, same)
    assert len(one) != len(other) or not np.array_equal(one, other)
