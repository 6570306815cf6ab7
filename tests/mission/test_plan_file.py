"""Plans of QGroundControl: written and read back, read by MAVSDK, foreign ones, and hostile ones."""

import copy
import json
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from missions import DELFT, FIELDS, SQUARE, WGS84, campus, plain, table1
from pymavlink.dialects.v20 import common

from uavlab.city import Place
from uavlab.mission import FencePolygon, Item, Mission, read_plan
from uavlab.mission.plan_file import plan_of
from uavlab.planners import astar
from uavlab.route import Route
from uavlab.vehicle import LIGHT_QUADROTOR, RISK_QUADROTOR

LATITUDES = st.floats(-90.0, 90.0) | st.sampled_from([-90.0, 90.0, 0.0, -0.0, 1e-7, -33.8567844])
LONGITUDES = st.floats(-180.0, 180.0) | st.sampled_from([-180.0, 180.0, 179.99999999, -179.9999999, -0.0, 151.2152967])
HEIGHTS = st.floats(-20_000.0, 20_000.0)
NUMBERS = st.floats(width=32, allow_nan=False, allow_infinity=False).filter(lambda value: abs(value) < 3e38)
PARAMETERS = st.tuples(*[NUMBERS | st.sampled_from([math.nan, 0.0, -0.0, 1.0, 0.001])] * 4)
FRAMES = st.sampled_from([0, 2, 3, 10, 1, 4, 7, 8, 9, 12, 255])
COMMANDS = st.sampled_from([16, 17, 20, 21, 22, 178, 201, 205, 206, 177, 19]) | st.integers(0, 65_535)
ITEMS = st.builds(Item, COMMANDS, FRAMES, PARAMETERS, LATITUDES, LONGITUDES, HEIGHTS)
PLACES = st.builds(Place, LONGITUDES, LATITUDES, HEIGHTS)
TEXTS = st.text(st.characters(exclude_categories=["Cs"]), max_size=20)
FENCES = st.builds(
    FencePolygon,
    st.lists(
        st.tuples(LATITUDES, st.floats(-179.0, 179.0)), min_size=3, max_size=6, unique_by=lambda c: round(c[0], 3)
    ),
    st.booleans(),
).map(lambda polygon: polygon._replace(corners=tuple(polygon.corners)))
MISSIONS = st.builds(
    Mission,
    st.lists(ITEMS, min_size=1, max_size=6).map(tuple),
    PLACES,
    st.lists(FENCES, max_size=3).map(tuple),
    st.lists(PLACES, max_size=3).map(tuple),
    st.floats(1e-3, 1e3),
    st.floats(1e-3, 1e3),
    st.sampled_from(["above sea", "ellipsoidal", "unknown"]),
    st.none() | PLACES,
    st.floats(0.0, 1e4),
    TEXTS,
    st.lists(TEXTS, max_size=2).map(tuple),
)


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    return tmp_path_factory.mktemp("plans") / "flight.plan"


def written(path, document):
    """A document as a file; a text or bytes as they are."""
    if isinstance(document, bytes):
        path.write_bytes(document)
    else:
        path.write_text(document if isinstance(document, str) else json.dumps(document), encoding="utf-8")
    return path


@settings(max_examples=200)
@given(MISSIONS)
def test_what_is_written_is_read_back_in_all_fields(file, mission):
    mission.to_plan(file)
    found = read_plan(file)
    for name in FIELDS:
        assert getattr(found, name) == getattr(mission, name), name
    assert [polygon[:2] for polygon in found.fence] == [polygon[:2] for polygon in mission.fence]
    json.loads(file.read_text(encoding="utf-8"), parse_constant=pytest.fail)  # no NaN, which JSON doesn't know


def test_what_a_plan_says():
    plan = plan_of(plain(fence=(SQUARE,), rally=(Place(4.361, 52.011, 12.0),), name="survey"))
    assert (plan["fileType"], plan["version"]) == ("Plan", 1)
    mission = plan["mission"]
    assert (mission["version"], plan["geoFence"]["version"], plan["rallyPoints"]["version"]) == (2, 2, 2)
    assert mission["plannedHomePosition"] == [52.01, 4.36, 3.0]
    assert (mission["vehicleType"], mission["hoverSpeed"], mission["cruiseSpeed"]) == (2, 5.0, 5.0)
    first, second = mission["items"]
    assert [first["doJumpId"], second["doJumpId"]] == [1, 2]  # home is none of them
    assert second == {
        "type": "SimpleItem", "autoContinue": True, "command": 16, "doJumpId": 2, "frame": 3,
        "params": [0.0, 2.0, 0.0, 90.0, 52.011, 4.361, 30.0], "AMSLAltAboveTerrain": None, "Altitude": 30.0,
        "AltitudeMode": 1,
    }  # fmt: skip
    assert plan["geoFence"]["circles"] == []
    assert plan["geoFence"]["polygons"] == [
        {"inclusion": True, "version": 1, "polygon": [[52.0, 4.35], [52.0, 4.37], [52.02, 4.37], [52.02, 4.35]]}
    ]
    assert plan["rallyPoints"]["points"] == [[52.011, 4.361, 12.0]]


@pytest.mark.parametrize(("frame", "mode"), [(3, 1), (0, 2), (10, 4)])
def test_altitude_modes(frame, mode):
    """As QGroundControl counts them: relative 1, absolute 2, terrain frame 4."""
    items = Item(178, 2, (1, 5, -1, 0)), Item(16, frame, (0, 2, 0, math.nan), 52.01, 4.36, 30.0)
    mission = plan_of(plain(items=items))["mission"]
    assert mission["globalPlanAltitudeMode"] == mission["items"][1]["AltitudeMode"] == mode
    assert mission["items"][1]["params"][3] is None
    assert "AltitudeMode" not in mission["items"][0]


@pytest.mark.parametrize(("frame", "firmware"), [(3, 12), (0, 12), (10, 3)])
def test_a_plan_above_terrain_is_one_for_ardupilot(frame, firmware):
    """PX4 refuses the frame."""
    mission = plan_of(plain(items=(Item(16, frame, (0, 2, 0, 0), 52.01, 4.36, 30.0),)))["mission"]
    assert mission["firmwareType"] == firmware
    assert firmware in (common.MAV_AUTOPILOT_PX4, common.MAV_AUTOPILOT_ARDUPILOTMEGA)


def same(found, item):
    """Whether an item of MAVSDK is one of ours."""
    degrees = round(item.latitude * 1e7), round(item.longitude * 1e7)
    numbers = np.float32([*item.parameters, item.altitude])
    return (
        (found.command, found.frame, found.x, found.y) == (item.command, item.frame, *degrees)
        and np.array_equal(
            np.float32([found.param1, found.param2, found.param3, found.param4, found.z]), numbers, equal_nan=True
        )
        and found.autocontinue == 1
    )


def missions_of_cities():
    city = campus(1)
    route = astar(city, (12.5, 17.5, 22.5), (112.5, 112.5, 27.5), min_clearance=2.0)
    yield Mission.from_route(route, city, RISK_QUADROTOR, end="return", rally=[(70, 5, 30), (5, 145, 40)])
    yield Mission.from_route(
        Route([(5, 5, 30), (5, 95, 40), (50, 98, 40)]), table1(), LIGHT_QUADROTOR, altitudes="terrain", hold=3.0
    )
    yield Mission.from_route(
        Route([(5, 5, 30), (5, 95, 40)]),
        table1(),
        LIGHT_QUADROTOR,
        altitudes="sea",
        home=(4.36, 52.01, 3.0),
        end="stay",
    )
    yield plain(
        items=(
            Item(22, 3, (0, 0, 0, math.nan), -33.8567844, 151.2152967, 20.5),
            Item(20),
            Item(178, 2, (1, 7.25, -1, 0)),
        ),
        fence=(SQUARE, SQUARE._replace(inclusion=False)),
    )


@pytest.mark.parametrize("number", range(4))
@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
def test_mavsdk_reads_mission_fence_and_rally_points(number, autopilot, tmp_path, request):
    mission = list(missions_of_cities())[number]
    mission.to_plan(tmp_path / "flight.plan")
    found = request.getfixturevalue(autopilot).import_qgroundcontrol_mission(str(tmp_path / "flight.plan"))
    items = found.mission_items
    if autopilot == "ardupilot":  # whose item 0 is home: MAVSDK takes it from the plan
        home, *items = items
        assert same(home, Item(16, 5, (0, 0, 0, 0), mission.home.latitude, mission.home.longitude, mission.home.height))
        assert (home.seq, home.current) == (0, 0)
    assert len(items) == len(mission.items)
    assert all(map(same, items, mission.items))
    assert [item.current for item in items] == [1] + [0] * (len(items) - 1)
    assert [item.seq for item in found.mission_items] == list(range(len(found.mission_items)))
    corners = [(polygon, corner) for polygon in mission.fence for corner in polygon.corners]
    assert len(found.geofence_items) == len(corners)
    for item, (polygon, (latitude, longitude)) in zip(found.geofence_items, corners, strict=True):
        assert item.command == (5001 if polygon.inclusion else 5002)
        assert (item.x, item.y) == (round(latitude * 1e7), round(longitude * 1e7))
        assert item.param1 == len(polygon.corners)
    assert len(found.rally_items) == len(mission.rally)
    for item, place in zip(found.rally_items, mission.rally, strict=True):
        assert (item.command, item.frame, item.z) == (5100, 3, np.float32(place.height))
        assert (item.x, item.y) == (round(place.latitude * 1e7), round(place.longitude * 1e7))


FOREIGN = {
    "fileType": "Plan",
    "geoFence": {
        "circles": [{"circle": {"center": [47.3977, 8.5456], "radius": 250.0}, "inclusion": True, "version": 1},
                    {"circle": {"center": [47.3985, 8.5470], "radius": 30.0}, "inclusion": False, "version": 1}],
        "polygons": [{"inclusion": False, "version": 1,
                      "polygon": [[47.397, 8.544], [47.3975, 8.544], [47.3975, 8.5445]]}],
        "version": 2,
    },
    "groundStation": "QGroundControl",
    "mission": {
        "cruiseSpeed": 15, "firmwareType": 12, "globalPlanAltitudeMode": 1, "hoverSpeed": 7, "vehicleType": 2,
        "version": 2, "plannedHomePosition": [47.3977419, 8.545594, 487.989],
        "items": [
            {"AMSLAltAboveTerrain": None, "Altitude": 50, "AltitudeMode": 1, "autoContinue": True, "command": 22,
             "doJumpId": 1, "frame": 3, "params": [15, 0, 0, None, 47.3977419, 8.545594, 50], "type": "SimpleItem"},
            {"autoContinue": True, "command": 205, "doJumpId": 2, "frame": 2, "params": [-45, 0, 10, 0, 0, 0, 2],
             "type": "SimpleItem"},
            {"autoContinue": True, "command": 2000, "doJumpId": 3, "frame": 2,
             "params": [0, 0, 1, None, None, None, None], "type": "SimpleItem"},
            {"AMSLAltAboveTerrain": 512.5, "Altitude": 25, "AltitudeMode": 3, "autoContinue": True, "command": 16,
             "doJumpId": 4, "frame": 5, "params": [2.5, 0, 0, None, 47.398, 8.546, 512.5], "type": "SimpleItem"},
            {"AMSLAltAboveTerrain": None, "Altitude": 30, "AltitudeMode": 1, "autoContinue": False, "command": 16,
             "doJumpId": 5, "frame": 6, "params": [0, 0, 0, 90, 47.3985, 8.5465, 30], "type": "SimpleItem"},
            {"AMSLAltAboveTerrain": None, "Altitude": 20, "AltitudeMode": 4, "autoContinue": True, "command": 16,
             "doJumpId": 6, "frame": 11, "params": [0, 0, 0, None, 47.399, 8.547, 20], "type": "SimpleItem"},
            {"autoContinue": True, "command": 20, "doJumpId": 7, "frame": 2, "params": [0, 0, 0, 0, 0, 0, 0],
             "type": "SimpleItem"},
        ],
    },
    "rallyPoints": {"points": [[47.3975, 8.5450, 50]], "version": 2},
    "version": 1,
}  # fmt: skip
"""As QGroundControl writes plans: null for "as it is", gimbals, cameras, heights from terrain, circles."""


def test_a_plan_of_qgroundcontrol(file):
    mission = read_plan(written(file, FOREIGN))
    takeoff, gimbal, camera, first, second, third, back = mission.items
    assert takeoff == Item(22, 3, (15.0, 0.0, 0.0, math.nan), 47.3977419, 8.545594, 50.0)
    assert gimbal == Item(205, 2, (-45.0, 0.0, 10.0, 0.0), 0.0, 0.0, 2.0)
    assert camera == Item(2000, 2, (0.0, 0.0, 1.0, math.nan))
    assert first == Item(16, 0, (2.5, 0.0, 0.0, math.nan), 47.398, 8.546, 512.5)
    assert second == Item(16, 3, (0.0, 0.0, 0.0, 90.0), 47.3985, 8.5465, 30.0)
    assert third == Item(16, 10, (0.0, 0.0, 0.0, math.nan), 47.399, 8.547, 20.0)
    assert back == Item(20)
    assert mission.home == Place(8.545594, 47.3977419, 487.989)
    assert (mission.heights, mission.speed, mission.place, mission.name) == ("above sea", 7.0, None, "flight")
    assert mission.rally == (Place(8.545, 47.3975, 50.0),)
    assert mission.notes == ("2 circles of the fence are polygons of 32 corners here",)
    assert [polygon.inclusion for polygon in mission.fence] == [False, True, False]
    assert mission.fence[0].corners == ((47.397, 8.544), (47.3975, 8.544), (47.3975, 8.5445))


def test_what_a_foreign_plan_says_survives_our_writing(file, tmp_path):
    mission = read_plan(written(file, FOREIGN))
    mission.to_plan(tmp_path / "again.plan")
    again = read_plan(tmp_path / "again.plan")
    assert again.items == mission.items
    assert [polygon[:2] for polygon in again.fence] == [polygon[:2] for polygon in mission.fence]
    assert again.rally == mission.rally


def test_circles_become_polygons_on_the_safe_side(file):
    """Inside of one to stay in, around one to stay out of."""
    _, wide, small = read_plan(written(file, FOREIGN)).fence
    for polygon, (latitude, longitude), radius in ((wide, (47.3977, 8.5456), 250.0), (small, (47.3985, 8.547), 30.0)):
        corners = np.array(polygon.corners)
        assert len(corners) == 32
        middles = (corners + np.roll(corners, 1, axis=0)) / 2
        out, half_way = (
            np.array([WGS84.inv(longitude, latitude, east, north)[2] for north, east in points])
            for points in (corners, middles)
        )
        if polygon.inclusion:
            assert out == pytest.approx(radius, abs=0.05)
        else:
            assert half_way == pytest.approx(radius, abs=0.05)


def test_home_of_an_unknown_height(file):
    """QGroundControl writes null where it has no data of the terrain."""
    plan = copy.deepcopy(FOREIGN)
    plan["mission"]["plannedHomePosition"][2] = None
    mission = read_plan(written(file, plan))
    assert (mission.home, mission.heights) == (Place(8.545594, 47.3977419, 0.0), "unknown")


@pytest.mark.parametrize(("command", "frame"), [(16, 2), (16, 3), (201, 3)])
def test_an_item_without_its_place_is_refused(file, command, frame):
    """0° N, 0° E would be one."""
    plan = copy.deepcopy(FOREIGN)
    plan["mission"]["items"][3] |= {"command": command, "frame": frame, "params": [0, 0, 0, None, None, None, None]}
    with pytest.raises(ValueError, match=r"items\[3\] has no place, or no altitude"):
        read_plan(written(file, plan))


def test_a_plan_with_a_survey_is_refused_with_the_cure(file):
    plan = copy.deepcopy(FOREIGN)
    plan["mission"]["items"].insert(2, {"type": "ComplexItem", "complexItemType": "survey", "version": 5})
    with pytest.raises(
        ValueError, match=r"items\[2\] is a 'survey': only simple items can be read, let QGroundControl"
    ):
        read_plan(written(file, plan))


def test_parts_that_may_be_missing(file):
    plan = {"fileType": "Plan", "mission": {"items": FOREIGN["mission"]["items"], "plannedHomePosition": [47, 8, 400]}}
    mission = read_plan(written(file, plan))
    assert (mission.fence, mission.rally, mission.speed, len(mission.items)) == ((), (), 5.0, 7)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig"])
@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_byte_order_marks_and_line_ends(file, encoding, newline):
    plan = plan_of(plain(name="Straße 北", notes=("naïve",)))
    text = json.dumps(plan, indent=2, ensure_ascii=False).replace("\n", newline)
    mission = read_plan(written(file, text.encode(encoding)))
    assert (mission.name, mission.notes, mission.items) == ("Straße 北", ("naïve",), plain().items)


@pytest.mark.parametrize(
    ("document", "message"),
    [
        ("", "is not valid JSON"),
        ("[]", "must hold a JSON object"),
        ("{}", "its fileType is None, not 'Plan'"),
        ('{"fileType": "Mission"}', "its fileType is 'Mission', not 'Plan'"),
        ('{"fileType": "Plan"}', "it has no 'mission'"),
        ('{"fileType": "Plan", "mission": 5}', "an object was expected"),
        ('{"fileType": "Plan", "mission": {"items": {}, "plannedHomePosition": [1, 2, 3]}}', "items must be a list"),
        (json.dumps(FOREIGN) * 2, "more than one"),
        (b"\xff\xfe{\x00}\x00", "is not UTF-8 text.*UTF-16"),
        (b"\x00\x01\x02", "is not valid JSON"),
        (json.dumps(FOREIGN).replace("250.0", "NaN"), "NaN is not a number"),
        (json.dumps(FOREIGN).replace("250.0", "1e400"), "radius must be finite"),
        (json.dumps(FOREIGN).replace("250.0", "0"), "radius must be finite and above 0"),
        ("[" * 100_000, "nested too deeply"),
    ],
)
def test_what_is_no_plan_is_refused(file, document, message):
    with pytest.raises(ValueError, match=message) as refused:
        read_plan(written(file, document))
    assert "flight.plan" in str(refused.value)


def test_a_file_that_isnt_there(tmp_path):
    with pytest.raises(FileNotFoundError):
        read_plan(tmp_path / "nowhere.plan")
    with pytest.raises(ValueError, match="path must be the name of a file"):
        read_plan(5)


def refuses(path):
    """Whether it is refused, by a ValueError with the file's name; anything else comes through."""
    try:
        read_plan(path)
    except ValueError as error:
        return path.name in str(error) or pytest.fail(f"without the file's name: {error}")
    return False


def ours():
    return json.dumps(plan_of(plain(fence=(SQUARE,), rally=(DELFT,), place=DELFT, notes=("one",))), indent=1)


@pytest.mark.parametrize("whole", [json.dumps(FOREIGN), ours()], ids=["foreign", "ours"])
def test_a_plan_that_is_cut_off_is_refused(file, whole):
    for length in range(0, len(whole.rstrip()), 47):
        assert refuses(written(file, whole[:length].encode()))


JUNK = (
    "null", "true", '"text"', '""', "[]", "[1, 2]", "[[]]", "{}", '{"a": 1}', "-1", "1.5", "1e39", "1e300", "1e400",
    "-1e400", "1" * 400, "1" * 5000, '"\\ud800"',
)  # fmt: skip
MARK = "a mark that stands nowhere else"


def places_in(document, at=()):
    """The ways to all values in a document, whole and part."""
    yield at
    inner = (
        document.items() if isinstance(document, dict) else enumerate(document) if isinstance(document, list) else ()
    )
    for key, value in inner:
        yield from places_in(value, (*at, key))


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("whole", [json.dumps(FOREIGN), ours()], ids=["foreign", "ours"])
def test_any_value_may_be_anything(file, whole):
    """Nothing but a ValueError comes out; what is read nonetheless is a mission that can be written."""
    refused = 0
    for at in list(places_in(json.loads(whole)))[1:]:
        document = json.loads(whole)
        *way, last = at
        part = document
        for key in way:
            part = part[key]
        part[last] = MARK
        text = json.dumps(document)
        for junk in JUNK:
            refused += refuses(written(file, text.replace(f'"{MARK}"', junk)))
    assert refused > 500


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@settings(max_examples=300)
@given(st.data())
def test_bytes_may_be_anything(file, data):
    whole = ours().encode()
    at = data.draw(st.integers(0, len(whole) - 1))
    junk = data.draw(st.sampled_from([b"", b"9", b"-", b'"', b"]", b"{", b",", b"e9", b"\x00", b"\xff", b"\xc3\xa9"]))
    refuses(written(file, whole[:at] + junk + whole[at + data.draw(st.integers(0, 3)) :]))


@pytest.mark.parametrize("name", ["plan", "geojson"])
def test_a_write_that_fails_leaves_the_old_file(tmp_path, name):
    """A name that no encoding can hold."""
    path = tmp_path / "flight.old"
    path.write_text("old")
    write = getattr(plain(name="\ud800"), f"to_{name}")
    with pytest.raises(ValueError, match="surrogates not allowed"):
        write(*([path] if name == "plan" else [path, table1()]))
    assert path.read_text() == "old"
    assert [each.name for each in tmp_path.iterdir()] == ["flight.old"]


@pytest.mark.parametrize("name", ["plan", "wpl", "kml", "gpx", "geojson"])
def test_a_full_disk_leaves_the_old_file(tmp_path, name, monkeypatch):
    path = tmp_path / "flight.old"
    path.write_text("old")

    def full(self, target):
        assert self.stat().st_size > 100
        raise OSError(28, "No space left on device", str(self))

    monkeypatch.setattr(type(path), "replace", full)
    write = getattr(plain(), f"to_{name}")
    with pytest.raises(OSError, match="No space left on device") as failed:
        write(*([path] if name in ("plan", "wpl") else [path, table1()]))
    assert failed.value.filename == str(path)
    assert path.read_text() == "old"
    assert [each.name for each in tmp_path.iterdir()] == ["flight.old"]


@pytest.mark.parametrize("name", ["plan", "wpl", "kml", "gpx", "geojson"])
def test_the_name_of_a_file_is_asked_for(name):
    write = getattr(plain(), f"to_{name}")
    for wrong in (5, "", None):
        with pytest.raises(ValueError, match="path must be the name of a file"):
            write(*([wrong] if name in ("plan", "wpl") else [wrong, table1()]))
