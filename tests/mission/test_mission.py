"""A mission itself: its fields, and its way on maps."""

from dataclasses import FrozenInstanceError, replace

import numpy as np
import pytest
from missions import CENTIMETRE, DELFT, FIELDS, SQUARE, cityjson_town, hills, placed, plain, table1, way

from uavlab.city import City, Place
from uavlab.mission import Item, Mission, read_plan, read_wpl
from uavlab.route import Route
from uavlab.vehicle import LIGHT_QUADROTOR, RISK_QUADROTOR

HOME = 4.36, 52.01, 3.0


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"items": ()}, "items must hold at least 1 Item, got 0"),
        ({"items": 5}, "items must be a list of Item"),
        ({"items": (Item(20),) * 65_536}, "items must be at most 65,535, got 65,536"),
        ({"home": "here"}, "home must be a number"),
        ({"home": None}, "home must be a number"),
        ({"home": Place(4.0, 52.0, 1e39)}, "home: height must be from -20000 to 20000 m"),
        ({"fence": 5}, "fence must be a list of FencePolygon"),
        ({"rally": 5}, "rally must be a list of places"),
        ({"rally": (DELFT, "there")}, r"rally\[1\] must be a number"),
        ({"rally": (Place(4.0, 52.0, 1e39),)}, r"rally\[0\]: height must be"),
        ({"speed": 0.0}, "speed must be finite and above 0"),
        ({"speed": "fast"}, "speed must be a number"),
        ({"corner_radius": -1.0}, "corner_radius must be finite and above 0"),
        ({"return_height": -1.0}, "return_height must be finite and at least 0"),
        ({"heights": "low"}, "heights must be one of 'above sea', 'ellipsoidal', 'unknown', got 'low'"),
        ({"place": 5.0}, "place must be a Place"),
        ({"name": 5}, "name must be text"),
        ({"notes": "one"}, "notes must be a list of sentences"),
        ({"notes": (5,)}, r"notes\[0\] must be text"),
    ],
)
def test_fields_that_make_no_sense_are_refused(fields, message):
    with pytest.raises(ValueError, match=message):
        plain(**fields)


def test_fields_may_be_given_in_other_forms():
    mission = plain(
        items=list(plain().items), home=(4.36, 52.01, 3.0), fence=[SQUARE], rally=[(4.0, 52.0, 5.0)], speed=5
    )
    assert isinstance(mission.items, tuple)
    assert mission.home == DELFT
    assert mission.rally == (Place(4.0, 52.0, 5.0),)
    assert (mission.fence, mission.speed) == ((SQUARE,), 5.0)
    with pytest.raises(FrozenInstanceError):
        mission.speed = 3.0


def test_a_mission_in_words():
    mission = plain(fence=(SQUARE,), name="survey", notes=("one", "two"))
    assert repr(mission) == "<Mission survey: 2 items, 5 m/s, altitudes above home, fence of 1 polygon>"
    lines = str(mission).splitlines()
    assert lines[0] == repr(mission)[1:-1]
    assert lines[1] == "    0 take off at 52.0100000°, 4.3600000°, 20.0 m above home"
    assert lines[-2:] == ["  note: one", "  note: two"]
    assert "fence of nothing" in repr(plain())
    assert "fence of 2 polygons" in repr(plain(fence=(SQUARE, SQUARE)))


def test_what_altitudes_are_above():
    items = Item(16, 3), Item(16, 0), Item(16, 10), Item(178, 2)
    assert plain(items=items[:1]).altitudes == "home"
    assert plain(items=items).altitudes == "home and sea and terrain"
    assert plain(items=items[3:]).altitudes == "nothing"


@pytest.mark.parametrize("altitudes", ["home", "sea", "terrain"])
@pytest.mark.parametrize("end", ["land", "return", "stay"])
def test_the_path_is_the_route(altitudes, end):
    city = table1()
    route = Route([(5, 5, 30), (5, 95, 40), (50, 98, 40)])
    mission = Mission.from_route(route, city, LIGHT_QUADROTOR, home=HOME, altitudes=altitudes, end=end)
    path = mission.path(city)
    expected = [(0, 0, 0), (0, 0, 30), *route.points]  # home is at x = y = 0, where the city's place is
    expected += {"land": [(50, 98, 0)], "return": [(50, 98, mission.return_height)], "stay": []}[end]
    assert path.points == pytest.approx(np.array(expected), abs=CENTIMETRE)
    assert (path.takeoff, path.landing, path.planner) == (1, int(end == "land"), "the city of REPARE Table 1")


@pytest.mark.parametrize("name", ["plan", "waypoints"])
def test_the_path_of_a_mission_from_a_file(name, tmp_path):
    city = table1()
    route = Route([(5, 5, 30), (5, 95, 40), (50, 98, 40)])
    mission = Mission.from_route(route, city, LIGHT_QUADROTOR)
    (mission.to_plan if name == "plan" else mission.to_wpl)(tmp_path / "a")
    found = (read_plan if name == "plan" else read_wpl)(tmp_path / "a")
    assert found.path(city).points == pytest.approx(mission.path(city).points, abs=1e-6)


def test_the_path_on_another_map_of_the_place(tmp_path):
    """Its origin is elsewhere: the way goes over the same places of the Earth."""
    corner = 84_616.5, 447_423.0
    town = cityjson_town(tmp_path / "one.city.json", "EPSG:7415", corner)
    mission = Mission.from_route(town.route(), town.city, RISK_QUADROTOR)
    other = replace(town.city, reference=town.city.to_geographic((-30.0, 12.0, 0.0)))
    expected = town.route().points + np.array([30.0, -12.0, 0.0])
    found = way(mission, other)
    assert found[:, :2] == pytest.approx(expected[:, :2], abs=0.1)  # north is turned a little there
    assert np.ptp(found[:, 2] - expected[:, 2]) < CENTIMETRE


def test_a_map_without_a_place():
    nowhere = replace(table1(), reference=None)
    with pytest.raises(ValueError, match="'the city of REPARE Table 1' doesn't know where on Earth it lies"):
        plain().path(nowhere)
    with pytest.raises(ValueError, match="city must be a City"):
        plain().path("Delft")
    made = Mission.from_route(Route([(5, 5, 30), (5, 95, 30)]), nowhere, LIGHT_QUADROTOR, home=HOME)
    assert way(made, nowhere) == pytest.approx(np.array([(5, 5, 30), (5, 95, 30)]), abs=CENTIMETRE)
    assert made.place is not None


def test_a_path_needs_a_known_frame():
    with pytest.raises(ValueError, match=r"has a place in frame 9, known are 0 \(above sea\), 3 \(above home\) and 10"):
        plain(items=(Item(16, 9, (0, 0, 0, 0), 52.01, 4.36, 5.0),)).path(table1())


def test_altitudes_above_the_ground_of_the_map():
    city = hills(0)
    there = city.to_geographic((60, 60, 0))
    mission = plain(items=(Item(16, 10, (0, 0, 0, 0), there[1], there[0], 25.0),), home=there)
    assert city.height_above_ground(mission.path(city).points[1]) == pytest.approx(25.0, abs=2e-3)


def test_altitudes_above_the_sea_need_that_of_home():
    city = City(np.zeros((20, 20, 20), bool), 5.0, reference=DELFT)
    item = Item(16, 0, (0, 0, 0, 0), DELFT.latitude, DELFT.longitude, 53.0)
    mission = plain(items=(item,), home=DELFT, place=DELFT, heights="above sea")
    assert mission.path(city).points[1] == pytest.approx((0, 0, 50.0), abs=1e-3)


def test_a_mission_without_take_off_or_landing():
    mission = plain(items=plain().items[1:])
    path = mission.path(table1())
    assert (path.takeoff, path.landing, len(path.points)) == (0, 0, 2)


def test_all_that_is_made_is_kept_in_its_fields():
    mission = Mission.from_route(
        Route([(5, 5, 30), (5, 95, 30)]), table1(), LIGHT_QUADROTOR, home=HOME, corner_radius=3.0, speed=4.0
    )
    assert mission.name == "the city of REPARE Table 1"
    assert (mission.speed, mission.corner_radius) == (4.0, 3.0)
    assert mission.place[:2] == table1().reference[:2]
    assert mission.home == Place(*HOME)
    assert mission.return_height == pytest.approx(30.0)
    assert {name for name in FIELDS if not hasattr(mission, name)} == set()
    assert placed(mission)[-1].parameters == (0.0, 3.0, 0.0, 0.0)
