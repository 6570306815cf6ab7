"""Missions to a vehicle and back: whole or not at all, whatever gets lost."""

import threading
import time
from dataclasses import replace

import pytest

from uavlab.city import Place
from uavlab.mavlink import CommandDeniedError, MissionRejectedError, connect, download, start, upload
from uavlab.mission import Check, FencePolygon, Item, Mission, Preflight
from uavlab.vehicle_sim import P840, DataLink

FIELDS = ("items", "fence", "rally")


def address(server):
    return f"udpout:127.0.0.1:{server.port}"


def same(one, other):
    return all(getattr(one, name) == getattr(other, name) for name in FIELDS)


@pytest.mark.parametrize("firmware", ["px4", "ardupilot"])
def test_a_mission_comes_back_as_it_was_sent(campus, mission, served, firmware):
    mission = replace(mission, rally=(Place(8.501, 47.2505, 10.0),))
    with served(campus.city, firmware=firmware) as server, connect(address(server)) as link:
        back = upload(mission, link)
        assert same(back, mission)
        assert (back.home, back.place, back.speed) == (mission.home, mission.place, mission.speed)
        read = download(link)
        assert same(read, mission)
        assert read.home == mission.home
        assert server.vehicle.pilot.return_height == pytest.approx(mission.return_height, abs=0.1)
        assert server.vehicle.pilot.items == mission.items


def test_an_address_does_for_a_link(campus, mission, served):
    with served(campus.city) as server:
        assert same(upload(mission, address(server)), mission)
        assert same(download(address(server)), mission)


def test_300_items_over_a_link_that_loses_a_tenth(meadow, long_mission, served):
    with served(meadow, (0, 0, 5), link=DataLink(loss=0.1), pace=1.0) as server, connect(address(server)) as link:
        assert upload(long_mission, link, timeout=20.0).items == long_mission.items
        assert server.vehicle.pilot.items == long_mission.items
        assert download(link).items == long_mission.items


def test_a_slow_radio_delivers_too(meadow, square, served):
    with served(meadow, (0, 0, 5), link=P840, pace=1.0) as server:
        began = time.monotonic()
        assert same(upload(square, address(server)), square)
        assert time.monotonic() - began > 2 * len(square.items) * P840.delay


def test_progress_is_shown(meadow, square, served, capsys):
    with served(meadow, (0, 0, 5)) as server:
        upload(square, address(server), progress=True)
    assert "100%" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("item", "why"),
    [
        (Item(203, 2), "unsupported"),
        (Item(16, 1, (0, 0, 0, 0), 47.25, 8.5, 30.0), "unsupported frame"),
        (Item(178, 2, (1.0, -3.0, 0, 0)), "invalid param2"),
        (Item(16, 3, (-1.0, 0, 0, 0), 47.25, 8.5, 30.0), "invalid param1"),
    ],
)
@pytest.mark.parametrize(("firmware", "number"), [("px4", 2), ("ardupilot", 3)])
def test_an_item_that_the_vehicle_refuses_is_named(meadow, square, served, item, why, firmware, number):
    wrong = replace(square, items=(*square.items[:2], item, *square.items[2:]))
    with served(meadow, (0, 0, 5), firmware=firmware) as server, connect(address(server)) as link:
        with pytest.raises(MissionRejectedError, match=f"doesn't take item {number} of the mission.*: {why}$"):
            upload(wrong, link)
        assert server.vehicle.pilot.items == ()
        with pytest.raises(CommandDeniedError, match="no mission"):
            start(link)


def test_more_than_there_is_room_for(meadow, served):
    far = Mission(tuple(Item(16, 3, (0, 2, 0, 0), 47.25, 8.5, 30.0) for _ in range(1001)), Place(8.5, 47.25))
    refused = pytest.raises(MissionRejectedError, match="doesn't take a mission of 1001 items: no space")
    with served(meadow, (0, 0, 5)) as server, refused:
        upload(far, address(server))


def test_an_old_mission_doesn_t_outlive_a_new_one_that_fails(meadow, square, served):
    with served(meadow, (0, 0, 5)) as server, connect(address(server)) as link:
        upload(square, link)
        wrong = replace(square, items=(*square.items, Item(203, 2)))
        with pytest.raises(MissionRejectedError):
            upload(wrong, link)
        assert server.vehicle.pilot.items == ()
        with pytest.raises(ValueError, match="the vehicle has no mission"):
            download(link)


@pytest.mark.parametrize("after", [3, 40, 150])
def test_a_link_that_is_lost_in_mid_upload(meadow, long_mission, served, after):
    """Nothing half uploaded is flown: the vehicle has no mission, and gives up waiting for the rest."""
    with served(meadow, (0, 0, 5)) as server, connect(address(server)) as link:
        send, sent = link.send, iter(range(10**6))

        def failing(message):
            if message.get_type() == "HEARTBEAT" or next(sent) < after:
                send(message)

        link.send = failing
        began = time.monotonic()
        with pytest.raises(TimeoutError, match=r"of the mission and didn't answer for 1 s|old mission"):
            upload(long_mission, link, timeout=1.0)
        assert time.monotonic() - began < 10
        link.send = send
        deadline = time.monotonic() + 10
        while server.vehicle.upload is not None and time.monotonic() < deadline:
            time.sleep(0.05)
        assert server.vehicle.upload is None
        assert server.vehicle.pilot.items == ()
        with pytest.raises(CommandDeniedError, match="no mission"):
            start(link)
        assert upload(long_mission, link).items == long_mission.items  # and all is well again


def test_a_second_ground_station_waits_its_turn(meadow, long_mission, square, served):
    slow = DataLink(delay=0.005)
    with served(meadow, (0, 0, 5), link=slow, pace=1.0) as server:
        done = []
        first = threading.Thread(target=lambda: done.append(upload(long_mission, address(server))))
        first.start()
        while server.vehicle.upload is None:
            time.sleep(0.01)
        with pytest.raises(MissionRejectedError, match="talking to another ground station"):
            upload(square, address(server))
        first.join(60)
        assert done[0].items == long_mission.items == server.vehicle.pilot.items
        assert same(upload(square, address(server)), square)


def test_a_mission_that_leaves_its_fence_isn_t_flown(meadow, square, served):
    small = FencePolygon(((47.2499, 8.4999), (47.2501, 8.4999), (47.2501, 8.5001), (47.2499, 8.5001)), inclusion=True)
    with served(meadow, (0, 0, 5)) as server, connect(address(server)) as link:
        upload(replace(square, fence=(small,)), link)
        with pytest.raises(CommandDeniedError, match="the mission leaves the fence"):
            start(link)
        zone = FencePolygon(
            ((47.2499, 8.5003), (47.2501, 8.5003), (47.2501, 8.5005), (47.2499, 8.5005)), inclusion=False
        )
        upload(replace(square, fence=(zone,)), link)
        with pytest.raises(CommandDeniedError, match="crosses a closed zone"):
            start(link)


def test_what_is_read_back_is_compared(meadow, square, served):
    with served(meadow, (0, 0, 5)) as server, connect(address(server)) as link:
        take = server.vehicle.take

        def forgetful(kind, items):
            return take(kind, [*items[:-1], items[-1]._replace(altitude=items[-1].altitude + 1.0)] if items else items)

        server.vehicle.take = forgetful
        with pytest.raises(MissionRejectedError, match="read back, fence and mission differ"):
            upload(square, link)
        assert server.vehicle.plans[0] == []


def test_a_vehicle_without_the_parameter_is_warned_of(meadow, square, served):
    with served(meadow, (0, 0, 5)) as server:
        server.vehicle.parameters = {"OTHER": 1.0, "THING": 2.0}
        with pytest.warns(UserWarning, match="didn't take RTL_RETURN_ALT"):
            upload(square, address(server))


def test_a_checklist_that_failed_stops_the_upload(meadow, square, served):
    passed = Preflight((Check("height", 30.0, 120.0, "m", False, ""),), square)
    failed = Preflight(
        (Check("height", 130.0, 120.0, "m", False, ""), Check("wind", 9.0, 8.0, "m/s", False, "")), square
    )
    with served(meadow, (0, 0, 5)) as server, connect(address(server)) as link:
        with pytest.raises(ValueError, match="checked: the checklist failed, height, wind"):
            upload(square, link, failed)
        assert server.vehicle.pilot.items == ()
        with pytest.raises(ValueError, match="checked must be the preflight of this mission"):
            upload(replace(square, name="another"), link, passed)
        assert server.vehicle.pilot.items == ()
        assert same(upload(square, link, passed), square)
        assert same(upload(square, link, failed, despite=True), square)


def test_wrong_arguments_are_named(square):
    for wrong in (None, [square], "mission.plan"):
        with pytest.raises(ValueError, match="mission must be"):
            upload(wrong, "udp:127.0.0.1:0", timeout=0.1)
    for wrong in (None, 14550, square):
        with pytest.raises(ValueError, match="vehicle must be a Link or an address"):
            upload(square, wrong, timeout=0.1)
        with pytest.raises(ValueError, match="vehicle must be a Link or an address"):
            download(wrong, timeout=0.1)
    with pytest.raises(ValueError, match="timeout"):
        upload(square, "udp:127.0.0.1:0", timeout=-1)
    with pytest.raises(ValueError, match="despite"):
        upload(square, "udp:127.0.0.1:0", despite="yes")
    with pytest.raises(ValueError, match="checked must be a Preflight"):
        upload(square, "udp:127.0.0.1:0", True)
    with pytest.raises(ValueError, match="checked must be given for a vehicle that isn't on this machine"):
        upload(square, "udp:192.168.1.7:14550", allow_network=True, timeout=0.1)
