"""The vehicle's answers, message by message, and what it makes of nonsense."""

import math

import numpy as np
import pytest

from uavlab.mavlink.coding import corners_of, message_of
from uavlab.mavlink.dialect import ARDUPILOT, FENCE, MISSION, PX4, RALLY_POINTS, codec, messages, packed
from uavlab.mission import FencePolygon, Item
from uavlab.vehicle_sim.vehicle import GIVE_UP, Vehicle

GROUND = ("127.0.0.1", 14550)
OTHER = ("127.0.0.1", 14551)
WAY = (
    Item(22, 3, (0, 0, 0, 0), 47.25, 8.5, 20.0),
    Item(16, 3, (0, 2, 0, 0), 47.2503, 8.5, 20.0),
    Item(21, 3, (0, 0, 0, 0), 47.2503, 8.5, 0.0),
)


class Talk:
    """A ground station that talks to a vehicle without a radio."""

    def __init__(self, pilot, autopilot=PX4):
        self.heard = []
        self.ears = codec(0, 0)
        self.vehicle = Vehicle(pilot, autopilot, self.hear)
        self.mouth = codec(255, 190)
        self.now = 0.0

    def hear(self, data, peer):
        self.heard += [(message, peer) for message in self.ears.parse_buffer(data)]

    def say(self, message, peer=GROUND):
        """Say something, and give what is answered."""
        self.heard.clear()
        self.vehicle.receive(packed(self.mouth, message), peer, self.now)
        return [message for message, _ in self.heard]

    def wait(self, seconds):
        self.heard.clear()
        self.now += seconds
        self.vehicle.advance(seconds, self.now)
        return [message for message, _ in self.heard]

    def count(self, number, kind=MISSION, peer=GROUND):
        return self.say(messages().MAVLink_mission_count_message(1, 1, number, kind), peer)

    def give(self, item, number, kind=MISSION, peer=GROUND):
        return self.say(message_of(item, number, kind, (1, 1)), peer)

    def command(self, number, *parameters):
        values = [*parameters, *[0.0] * (7 - len(parameters))]
        return self.say(messages().MAVLink_command_long_message(1, 1, number, 0, *values))


@pytest.fixture
def talk(meadow, standing):
    return Talk(standing(meadow, (0, 0, 5)))


def kinds(answers):
    return [answer.get_type() for answer in answers]


def test_it_asks_for_each_item_and_takes_all_or_none(talk):
    (asked,) = talk.count(3)
    assert (asked.get_type(), asked.seq, asked.target_system, asked.target_component) == (
        "MISSION_REQUEST_INT",
        0,
        255,
        190,
    )
    for number, item in enumerate(WAY[:2]):
        (asked,) = talk.give(item, number)
        assert asked.seq == number + 1
        assert talk.vehicle.pilot.items == ()
    (done,) = talk.give(WAY[2], 2)
    assert (done.get_type(), done.type) == ("MISSION_ACK", 0)
    assert talk.vehicle.pilot.items == WAY


def test_what_comes_twice_or_too_early_changes_nothing(talk):
    talk.count(3)
    talk.give(WAY[0], 0)
    assert talk.give(WAY[0], 0) == []
    (asked,) = talk.give(WAY[2], 2)
    assert asked.seq == 1
    (asked,) = talk.count(3)  # it didn't hear the question
    assert asked.seq == 1
    talk.give(WAY[1], 1)
    (done,) = talk.give(WAY[2], 2)
    assert done.type == 0
    (again,) = talk.give(WAY[2], 2)  # nor the last word
    assert (again.get_type(), again.type) == ("MISSION_ACK", 0)
    assert talk.give(WAY[1], 1) == []
    assert talk.vehicle.pilot.items == WAY


def test_it_asks_again_and_gives_up_in_the_end(talk):
    talk.count(3)
    talk.give(WAY[0], 0)
    asked = [answer for _ in range(8) for answer in talk.wait(0.1) if answer.get_type() == "MISSION_REQUEST_INT"]
    assert {answer.seq for answer in asked} == {1}
    assert len(asked) >= 2
    late = [
        answer
        for _ in range(math.ceil(10 * GIVE_UP))
        for answer in talk.wait(0.1)
        if answer.get_type() == "MISSION_ACK"
    ]
    assert [answer.type for answer in late] == [15]
    assert talk.vehicle.upload is None
    assert talk.give(WAY[1], 1) == []


def test_one_ground_station_at_a_time(talk):
    talk.count(3)
    (denied,) = talk.count(3, peer=OTHER)
    assert (denied.get_type(), denied.type) == ("MISSION_ACK", 14)
    assert talk.give(WAY[0], 0, peer=OTHER) == []
    (denied,) = talk.say(messages().MAVLink_mission_clear_all_message(1, 1, 255), OTHER)
    assert denied.type == 14
    talk.say(messages().MAVLink_mission_ack_message(1, 1, 15, MISSION))  # the first one gives up
    (asked,) = talk.count(3, peer=OTHER)
    assert asked.seq == 0


@pytest.mark.parametrize(
    ("message", "result"),
    [
        ({"command": 203}, 3),
        ({"frame": 7}, 2),
        ({"x": 2_000_000_000}, 10),
        ({"z": math.nan}, 12),
        ({"z": 1e9}, 12),
        ({"param1": math.inf}, 5),
    ],
)
def test_an_item_that_can_t_be_flown_is_refused(talk, message, result):
    talk.count(1)
    item = message_of(WAY[0], 0, MISSION, (1, 1))
    for name, value in message.items():
        setattr(item, name, value)
    fields = [getattr(item, name) for name in item.ordered_fieldnames]
    made = dict(zip(item.ordered_fieldnames, fields, strict=True))
    (answer,) = talk.say(messages().MAVLink_mission_item_int_message(**made))
    assert (answer.get_type(), answer.type) == ("MISSION_ACK", result)
    assert talk.vehicle.upload is None


def test_fences_and_rally_points_come_as_items(talk, meadow):
    fence = FencePolygon(((47.249, 8.499), (47.251, 8.499), (47.251, 8.501), (47.249, 8.501)), True)
    corners = corners_of(fence)
    talk.count(4, FENCE)
    for number, corner in enumerate(corners):
        answers = talk.give(corner, number, FENCE)
    assert answers[0].type == 0
    ((area, inside),) = talk.vehicle.pilot.areas
    assert inside
    assert area.area == pytest.approx(222.35 * 151.4, rel=0.01)
    talk.count(1, RALLY_POINTS)
    (done,) = talk.give(Item(5100, 3, (0, 0, 0, 0), 47.2503, 8.5, 5.0), 0, RALLY_POINTS)
    assert done.type == 0
    assert talk.vehicle.pilot.rally[0] == pytest.approx([0.0, 33.35, 5.0], abs=0.05)
    talk.count(3, FENCE)
    for number, corner in enumerate(corners[:3]):  # a polygon that lacks a corner
        answers = talk.give(corner, number, FENCE)
    assert answers[0].type != 0
    assert len(talk.vehicle.pilot.areas) == 1


def test_what_it_has_can_be_read(talk):
    request = messages().MAVLink_mission_request_list_message(1, 1, MISSION)
    (count,) = talk.say(request)
    assert count.count == 0
    talk.count(3)
    for number, item in enumerate(WAY):
        talk.give(item, number)
    (count,) = talk.say(request)
    assert count.count == 3
    for number in range(3):
        (item,) = talk.say(messages().MAVLink_mission_request_int_message(1, 1, number, MISSION))
        assert (item.seq, item.command, item.z) == (number, WAY[number].command, WAY[number].altitude)
    (answer,) = talk.say(messages().MAVLink_mission_request_int_message(1, 1, 3, MISSION))
    assert (answer.get_type(), answer.type) == ("MISSION_ACK", 13)


def test_of_ardupilot_the_first_item_is_home(meadow, standing):
    talk = Talk(standing(meadow, (10, 20, 5)), ARDUPILOT)
    talk.count(4)
    for number, item in enumerate((Item(16, 0, (0, 0, 0, 0), 1.0, 2.0, 3.0), *WAY)):
        talk.give(item, number)
    assert talk.vehicle.pilot.items == WAY
    (home,) = talk.say(messages().MAVLink_mission_request_int_message(1, 1, 0, MISSION))
    east, north, height = meadow.to_geographic(talk.vehicle.pilot.home)
    assert (home.x / 1e7, home.y / 1e7, home.z) == pytest.approx((north, east, height), abs=1e-3)


def test_parameters(talk):
    names = [answer.param_id for answer in talk.say(messages().MAVLink_param_request_list_message(1, 1))]
    assert names == ["RTL_RETURN_ALT", "GF_ACTION"]
    (value,) = talk.say(messages().MAVLink_param_set_message(1, 1, b"RTL_RETURN_ALT", 42.0, 9))
    assert value.param_value == 42.0
    assert talk.vehicle.pilot.return_height == 42.0
    talk.say(messages().MAVLink_param_set_message(1, 1, b"GF_ACTION", 1.0, 9))
    assert not talk.vehicle.pilot.fence_returns
    (value,) = talk.say(messages().MAVLink_param_request_read_message(1, 1, b"", 0))
    assert value.param_value == 42.0
    assert talk.say(messages().MAVLink_param_set_message(1, 1, b"RTL_RETURN_ALT", math.nan, 9)) == []
    assert talk.say(messages().MAVLink_param_set_message(1, 1, b"NOTHING", 1.0, 9)) == []


def test_commands(talk):
    (said, refused) = talk.command(300)
    assert (kinds([said, refused]), said.text, refused.result) == (["STATUSTEXT", "COMMAND_ACK"], "no mission", 1)
    (unknown,) = talk.command(9999)
    assert unknown.result == 3
    (home, done) = talk.command(512, 242)
    assert (home.get_type(), done.result) == ("HOME_POSITION", 0)
    (version, done) = talk.command(512, 148)
    assert version.capabilities & 4
    assert talk.command(400, 1.0)[-1].result == 0
    assert talk.command(176, 1, 9, 9)[-1].result == 1
    assert talk.command(176, 1, 4, 3)[-1].result == 0


def test_what_it_says_of_itself(talk):
    said = talk.wait(1.01)
    assert kinds(said).count("GLOBAL_POSITION_INT") == 10
    assert {"HEARTBEAT", "SYS_STATUS", "MISSION_CURRENT", "EXTENDED_SYS_STATE", "FENCE_STATUS", "GPS_RAW_INT"} <= set(
        kinds(said)
    )
    (beat,) = [message for message in said if message.get_type() == "HEARTBEAT"]
    assert (beat.type, beat.autopilot, beat.base_mode & 128, beat.system_status) == (2, PX4, 0, 3)


def test_what_is_for_others_is_ignored(talk):
    assert talk.say(messages().MAVLink_mission_count_message(7, 1, 3, MISSION)) == []
    assert talk.vehicle.upload is None


def test_noise_is_ignored(talk):
    rng = np.random.default_rng(0)
    for _ in range(2000):
        talk.vehicle.receive(rng.bytes(int(rng.integers(1, 300))), GROUND, 0.0)
    whole = packed(talk.mouth, messages().MAVLink_mission_count_message(1, 1, 3, MISSION))
    for place in range(2, len(whole)):
        broken = bytearray(whole)
        broken[place] ^= 0x40
        talk.vehicle.receive(bytes(broken), OTHER, 0.0)
    assert talk.vehicle.upload is None or talk.vehicle.upload.count != 3


WIDTHS = {"uint8_t": 1, "int8_t": 1, "uint16_t": 2, "int16_t": 2, "uint32_t": 4, "int32_t": 4}


def strange(rng, kind, array):
    """A value of a field's type, an odd one."""

    def one():
        if kind in ("float", "double"):
            return float(rng.choice([0.0, 1.0, -1.0, math.nan, math.inf, -math.inf, 1e30, 47.25]))
        bits = 8 * WIDTHS.get(kind, 8)
        low, high = (0, 2**bits - 1) if kind.startswith("u") else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
        usual = [0, 1, 2, 3, 4, 16, 21, 22] + [20, 176, 178, 300, 400] * (bits > 8)
        return [low, high][int(rng.integers(2))] if rng.random() < 0.3 else int(rng.choice(usual))

    if kind == "char":
        return bytes(rng.integers(32, 127, max(array, 1)).tolist())
    return [one() for _ in range(array)] if array else one()


def test_no_message_with_odd_values_stops_it(meadow, standing):
    """Every kind of message that it listens to, with NaN, infinities and the ends of whole numbers, also in the air."""
    rng = np.random.default_rng(7)
    talk = Talk(standing(meadow, (0, 0, 5)))
    words = messages()
    known = [kind for kind in words.mavlink_map.values() if hasattr(talk.vehicle, f"on_{kind.msgname.lower()}")]
    assert len(known) >= 10
    modes = set()
    for number in range(4000):
        if number % 400 == 200 and talk.vehicle.pilot.body.path is None:
            talk.vehicle.pilot.take(WAY)
            talk.vehicle.pilot.arm()
            talk.vehicle.pilot.start()
        modes.add(talk.vehicle.pilot.mode)
        kind = known[int(rng.integers(len(known)))]
        fields = odd_fields(rng, kind)
        fields |= {name: 1 for name in ("target_system", "target_component") if name in fields}
        try:
            data = packed(talk.mouth, kind(**fields))
        except Exception:  # pymavlink can't pack it: nobody can send it
            continue
        talk.vehicle.receive(data, GROUND, number * 0.01)
        if number % 50 == 0:
            talk.vehicle.advance(0.1, number * 0.01)
    assert {"ready", "mission", "land", "return"} <= modes


def odd_fields(rng, kind):
    """Odd values of all fields of a message."""
    types = dict(zip(kind.fieldnames, kind.fieldtypes, strict=True))
    lengths = dict(zip(kind.ordered_fieldnames, kind.array_lengths, strict=True))
    return {name: strange(rng, types[name], lengths[name]) for name in kind.fieldnames}
