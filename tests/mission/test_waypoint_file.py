"""Waypoints as text: written and read back, read by pymavlink and MAVSDK, and hostile ones."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from missions import DELFT, plain, table1
from pymavlink.mavwp import MAVWPError, MAVWPLoader
from test_plan_file import ITEMS, PLACES, missions_of_cities, same, written

from uavlab.city import Place
from uavlab.mission import Item, Mission, read_wpl
from uavlab.route import Route
from uavlab.vehicle import LIGHT_QUADROTOR

HOME_LINE = "0\t1\t0\t16\t0\t0\t0\t0\t52.0100000\t4.3600000\t3.000\t1"
WAYPOINT_LINE = "1\t0\t3\t16\t0\t2\t0\t90\t52.0110000\t4.3610000\t30.000\t1"
FILE = f"QGC WPL 110\n{HOME_LINE}\n{WAYPOINT_LINE}\n"


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    return tmp_path_factory.mktemp("waypoints") / "flight.waypoints"


@settings(max_examples=200)
@given(st.lists(ITEMS, min_size=1, max_size=8), PLACES)
def test_what_is_written_is_read_back(file, items, home):
    mission = Mission(tuple(items), home)
    mission.to_wpl(file)
    found = read_wpl(file)
    assert found.items == mission.items
    assert found.home == mission.home
    assert (found.fence, found.rally, found.place, found.name) == ((), (), None, "flight")


def test_the_lines_of_a_file(file):
    plain(items=(Item(16, 3, (0, 2, 0, 90), 52.011, 4.361, 30.0),)).to_wpl(file)
    assert file.read_bytes() == FILE.encode()


def test_home_is_line_0_and_current(file):
    """As ArduPilot counts, and ground stations: of the items, the first one is number 1."""
    plain().to_wpl(file)
    rows = [line.split("\t") for line in file.read_text().splitlines()[1:]]
    assert [row[0] for row in rows] == ["0", "1", "2"]
    assert [row[1] for row in rows] == ["1", "0", "0"]
    assert rows[0][2:4] == ["0", "16"]
    assert {len(row) for row in rows} == {12}
    assert {row[11] for row in rows} == {"1"}


def test_the_speed_is_the_greatest_that_is_asked_for(file):
    mission = Mission.from_route(
        Route([(5, 5, 30), (5, 95, 40), (50, 98, 40)]), table1(), LIGHT_QUADROTOR, speed=[3.0, 7.5]
    )
    mission.to_wpl(file)
    assert read_wpl(file).speed == 7.5
    plain().to_wpl(file)
    assert read_wpl(file).speed == 5.0
    plain(items=(Item(178, 2, (1.0, math.nan, -1.0, 0.0)), Item(178, 2, (1.0, -1.0, 50.0, 0.0)))).to_wpl(file)
    assert read_wpl(file).speed == 5.0


@pytest.mark.parametrize("number", range(4))
def test_pymavlink_reads_it(file, number):
    mission = list(missions_of_cities())[number]
    mission.to_wpl(file)
    loader = MAVWPLoader()
    assert loader.load(str(file)) == len(mission.items) + 1
    home, *items = (loader.wp(n) for n in range(loader.count()))
    assert (home.seq, home.current, home.frame, home.command) == (0, 1, 0, 16)
    assert (home.x, home.y, home.z) == (mission.home.latitude, mission.home.longitude, mission.home.height)
    for seq, (found, item) in enumerate(zip(items, mission.items, strict=True), 1):
        assert (found.seq, found.current, found.autocontinue) == (seq, 0, 1)
        assert (found.command, found.frame) == (item.command, item.frame)
        assert np.array_equal([found.param1, found.param2, found.param3, found.param4], item.parameters, equal_nan=True)
        assert (found.x, found.y, found.z) == (item.latitude, item.longitude, item.altitude)


def test_what_pymavlink_writes_is_read(file, tmp_path):
    """It puts comments above items."""
    mission = next(missions_of_cities())
    mission.to_wpl(file)
    loader = MAVWPLoader()
    loader.load(str(file))
    loader.wp(2).comment = "mind the tree"
    loader.save(str(tmp_path / "again.waypoints"))
    assert "# mind the tree" in (tmp_path / "again.waypoints").read_text()
    again = read_wpl(tmp_path / "again.waypoints")
    for found, item in zip(again.items, mission.items, strict=True):
        assert found[:3] == item[:3]
        assert found[3:] == pytest.approx(item[3:], abs=1e-6)  # it writes six digits


@pytest.mark.parametrize("number", range(4))
@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
def test_mavsdk_reads_it_with_home_as_an_item(file, number, autopilot, request):
    """Line 0 is home to ground stations; MAVSDK takes it for the first item, and for ArduPilot adds home once more."""
    mission = list(missions_of_cities())[number]
    mission.to_wpl(file)
    found = request.getfixturevalue(autopilot).import_mission_planner_mission(str(file)).mission_items
    homes = 2 if autopilot == "ardupilot" else 1
    assert len(found) == len(mission.items) + homes
    for home in found[:homes]:
        assert (home.command, home.x, home.y) == (
            16, round(mission.home.latitude * 1e7), round(mission.home.longitude * 1e7),
        )  # fmt: skip
        assert home.z == np.float32(mission.home.height)
    assert all(map(same, found[homes:], mission.items))


@pytest.mark.parametrize(("frame", "same_frame"), [(5, 0), (6, 3), (11, 10), (3, 3), (4, 4)])
def test_frames_with_other_numbers_and_the_same_meaning(file, frame, same_frame):
    text = FILE.replace("1\t0\t3\t16", f"1\t0\t{frame}\t16")
    assert read_wpl(written(file, text)).items[0].frame == same_frame


def test_spaces_byte_order_marks_line_ends_empty_lines_and_comments(file):
    expected = read_wpl(written(file, FILE))
    assert expected.items == (Item(16, 3, (0.0, 2.0, 0.0, 90.0), 52.011, 4.361, 30.0),)
    assert (expected.home, expected.heights) == (DELFT, "above sea")
    for text in (
        FILE.replace("\t", "  "),
        FILE.replace("\n", "\r\n"),
        "\ufeff" + FILE,
        FILE.rstrip(),
        FILE.replace("\n", "\n\n"),
        FILE.replace(WAYPOINT_LINE, f"# the first one\n{WAYPOINT_LINE}"),
    ):
        found = read_wpl(written(file, text.encode()))
        assert (found.items, found.home) == (expected.items, expected.home)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "not enough values|is no file of waypoints"),
        ("QGC WPL 120\n", "its first line must be 'QGC WPL 110', got 'QGC WPL 120'"),
        (FILE.replace(WAYPOINT_LINE, ""), "must have home and at least one item, got 1"),
        ("QGC WPL 110\n", "must have home and at least one item, got 0"),
        (FILE.replace("\t90\t", "\t"), "line 3 must have 12 columns, got 11"),
        (
            FILE.replace("1\t0\t3", "2\t0\t3"),
            "line 3 must be that of item 1, got 2: a line is missing, or stands twice",
        ),
        (FILE + WAYPOINT_LINE, "line 4 must be that of item 2, got 1"),
        (FILE.replace("\t90\t", "\tnorth\t"), "could not convert"),
        (FILE.replace("\t90\t", "\tinf\t"), "line 3 must have finite numbers"),
        (FILE.replace("\t90\t", "\t1e400\t"), "line 3 must have finite numbers"),
        (FILE.replace("\t90\t", "\t1e39\t"), "too large for 32 bits"),
        (FILE.replace("52.0110000", "92.0"), r"items\[0\]: latitude must be"),
        (FILE.replace("52.0110000", "nan"), r"items\[0\]: latitude must be from -90"),
        (FILE.replace("52.0100000", "nan"), "latitude must be"),
        (FILE.replace("52.0100000", "4.36e9"), "latitude must be"),
        (FILE.replace("\t3.000", "\tnan"), "height must be finite"),
        (FILE.replace("\t30.000", "\tnan"), r"items\[0\]\.altitude"),
        (FILE.replace("\t30.000", "\t1e9"), r"items\[0\]\.altitude must be from"),
        (FILE.replace("1\t0\t3\t16", "1\t0\t3\t-16"), r"items\[0\]\.command"),
        (FILE.replace("1\t0\t3\t16", "1\t0\t3000\t16"), r"items\[0\]\.frame"),
        (FILE.replace("1\t0\t3\t16", f"1\t0\t3\t{'9' * 5000}"), "digits"),
        (FILE.encode("utf-16"), "codec can't decode"),
        (b"\x00\xff\x00\xfe" * 50, "is no file of waypoints"),
        (FILE.encode() + b"\xff", "codec can't decode"),
    ],
)
def test_what_is_no_file_of_waypoints_is_refused(file, text, message):
    with pytest.raises(ValueError, match=message) as refused:
        read_wpl(written(file, text))
    assert "flight.waypoints" in str(refused.value)


def test_pymavlink_agrees_on_what_is_none(file):
    with pytest.raises(MAVWPError):
        MAVWPLoader().load(str(written(file, "QGC WPL 130\n")))


def test_a_file_that_isnt_there(tmp_path):
    with pytest.raises(FileNotFoundError):
        read_wpl(tmp_path / "nowhere.waypoints")
    with pytest.raises(ValueError, match="path must be the name of a file"):
        read_wpl(5)


def refuses(path):
    """Whether it is refused, by a ValueError with the file's name; anything else comes through."""
    try:
        read_wpl(path)
    except ValueError as error:
        return path.name in str(error) or pytest.fail(f"without the file's name: {error}")
    return False


def test_a_file_that_is_cut_off_is_refused_or_shorter(file):
    """At the end of a line nothing tells that others followed."""
    plain().to_wpl(file)
    whole = file.read_bytes()
    lines = [n for n in range(len(whole) + 1) if whole[:n].endswith((b"\n", b"\t1"))]
    for length in range(0, len(whole), 3):
        if not refuses(written(file, whole[:length])):
            assert any(abs(length - end) <= 1 for end in lines)
            assert len(read_wpl(file).items) < 2 or length >= len(whole) - 2


JUNK = (
    "",
    "x",
    "nan",
    "inf",
    "-inf",
    "1e400",
    "1e39",
    "-1",
    "1.5",
    "9" * 400,
    "9" * 5000,
    "0x10",
    "١",
    "1_0",
    "\x00",
    "é",
)


def test_any_word_may_be_anything(file):
    rows = [HOME_LINE.split("\t"), WAYPOINT_LINE.split("\t")]
    refused = 0
    for row in range(2):
        for column in range(12):
            for junk in JUNK:
                words = [list(each) for each in rows]
                words[row][column] = junk
                refused += refuses(written(file, "\n".join(["QGC WPL 110", *map("\t".join, words)])))
    assert refused > 200


@settings(max_examples=300)
@given(st.data())
def test_bytes_may_be_anything(file, data):
    whole = FILE.encode()
    at = data.draw(st.integers(0, len(whole) - 1))
    junk = data.draw(st.binary(max_size=4))
    refuses(written(file, whole[:at] + junk + whole[at + data.draw(st.integers(0, 3)) :]))


def test_home_at_the_date_line(file):
    mission = plain(home=Place(179.99999999, -17.7, 0.0), items=(Item(16, 3, (0, 2, 0, 0), -17.7, 180.0, 30.0),))
    mission.to_wpl(file)
    assert read_wpl(file).home == mission.home
    assert read_wpl(file).items == mission.items
