"""Addresses, heartbeats, ports, packets that are none, and the record."""

import socket
import struct
import time

import pytest
from pymavlink import mavutil

from uavlab.mavlink import Link, connect, follow, start, upload
from uavlab.mavlink.dialect import codec, messages, packed

HERE = "udp:127.0.0.1:0"


@pytest.mark.parametrize(
    "address",
    ["", "127.0.0.1:14550", "udp:127.0.0.1", "udp::14550", "udp:127.0.0.1:port", "udp:127.0.0.1:70000",
     "tcp:127.0.0.1:5760", "/dev/ttyACM0", "udp:127.0.0.1:-1", "udp:127.0.0.1:1.5"],
)  # fmt: skip
def test_what_is_no_address_is_refused(address):
    with pytest.raises(ValueError, match=r"address must be as udp:127\.0\.0\.1:14550"):
        connect(address, timeout=0.1)


@pytest.mark.parametrize(
    "host", ["192.168.1.7", "0.0.0.0", "10.0.0.1", "drone.example", "8.8.8.8", "255.255.255.255", "127.0.0.1.nip.io"]
)
@pytest.mark.parametrize("kind", ["udp", "udpin", "udpout"])
def test_other_machines_need_leave(kind, host):
    with pytest.raises(ValueError, match="allow_network=True"):
        connect(f"{kind}:{host}:14550", timeout=0.1)


def test_other_machines_can_be_allowed(monkeypatch):
    bound = []
    monkeypatch.setattr(socket.socket, "bind", lambda self, where: bound.append(where), raising=False)

    class Silent(socket.socket):
        def bind(self, where):
            bound.append(where)

    monkeypatch.setattr("uavlab.mavlink.link.socket.socket", Silent)
    connect("udp:192.168.1.7:14550", wait=False, allow_network=True).close()
    assert bound == [("192.168.1.7", 14550)]


@pytest.mark.parametrize(
    ("more", "name"),
    [({"timeout": 0}, "timeout"), ({"timeout": float("nan")}, "timeout"), ({"record": 3}, "record"),
     ({"wait": 1}, "wait"), ({"allow_network": "yes"}, "allow_network")],
)  # fmt: skip
def test_wrong_options_are_named(more, name):
    with pytest.raises(ValueError, match=name):
        connect(HERE, **({"timeout": 0.1} | more))


@pytest.mark.parametrize(
    ("address", "tried"), [(HERE, "listened on udp"), ("udpout:127.0.0.1:9", "sent heartbeats to udp")]
)
def test_nobody_answers(address, tried):
    began = time.monotonic()
    with pytest.raises(TimeoutError, match=rf"no vehicle was heard: {tried} 127\.0\.0\.1:\d+ for 0\.3 s"):
        connect(address, timeout=0.3)
    assert time.monotonic() - began < 3


def test_a_port_that_is_taken_is_said():
    with connect(HERE, wait=False) as first, pytest.raises(OSError, match="another ground station may be open there"):
        connect(f"udp:127.0.0.1:{first.port}", timeout=0.2)


def test_a_record_that_cant_be_written_is_said(tmp_path):
    """And not that the port is taken."""
    with pytest.raises(FileNotFoundError, match=r"No such file or directory: '.*none.flight\.tlog'"):
        connect(HERE, record=tmp_path / "none" / "flight.tlog", wait=False)


def test_a_failed_connection_frees_its_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    for _ in range(3):
        with pytest.raises(TimeoutError):
            connect(f"udp:127.0.0.1:{port}", timeout=0.1)


def test_it_listens_to_a_vehicle_that_calls(meadow, campus, served):
    with connect(HERE, wait=False) as link, served(meadow, (0, 0, 5)) as server:
        server.peers[("127.0.0.1", link.port)] = float("inf")
        assert link.receive("HEARTBEAT", timeout=5.0) is not None
        assert link.vehicle == (1, 1)
        assert link.autopilot == 12
        assert "listens on" in repr(link)
        assert "vehicle 1" in repr(link)


def test_a_closed_link_is_refused(mission):
    link = connect(HERE, wait=False)
    link.close()
    link.close()
    assert "closed" in repr(link)
    with pytest.raises(ValueError, match="vehicle must be an open link"):
        upload(mission, link)
    for use in (start, follow):
        with pytest.raises(ValueError, match="link must be one on which a vehicle was heard"):
            use(link)


def test_noise_is_counted_and_no_vehicle():
    with connect(HERE, wait=False) as link, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as noise:
        for _ in range(20):
            noise.sendto(b"\xfd\x09\x00\x00 not a message at all", ("127.0.0.1", link.port))
        assert link.receive(timeout=0.3) is None
        assert link.vehicle is None
        assert link.corrupted > 0


def test_other_ground_stations_are_no_vehicle():
    beat = packed(codec(255, 190), messages().MAVLink_heartbeat_message(6, 8, 0, 0, 0, 3))
    with connect(HERE, wait=False) as link, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        for _ in range(5):
            other.sendto(beat, ("127.0.0.1", link.port))
        assert link.receive(timeout=0.3) is None
        assert link.vehicle is None


def test_corrupted_packets_are_left_out(meadow, served):
    with served(meadow, (0, 0, 5)) as server:
        speak, count = server.send, iter(range(10**9))

        def garbled(data, peer):
            data = bytearray(data)
            if next(count) % 3 == 0:
                data[len(data) // 2] ^= 0x55
            speak(bytes(data), peer)

        server.vehicle.send = garbled
        with connect(f"udpout:127.0.0.1:{server.port}") as link:
            heard = [message for _ in range(100) if (message := link.receive(timeout=2.0)) is not None]
        assert len(heard) == 100
        assert link.corrupted > 10


def test_the_record_is_one_that_tools_open(meadow, square, served, tmp_path):
    path = tmp_path / "flight.tlog"
    with served(meadow, (0, 0, 5)) as server, connect(f"udpout:127.0.0.1:{server.port}", record=path) as link:
        upload(square, link)
        for _ in range(50):
            link.receive(timeout=1.0)
    log = mavutil.mavlink_connection(str(path), dialect="common")
    kinds, moments = [], []
    while (message := log.recv_match()) is not None:
        kinds.append(message.get_type())
        moments.append(message._timestamp)
    assert {"HEARTBEAT", "MISSION_COUNT", "MISSION_ITEM_INT", "MISSION_ACK", "GLOBAL_POSITION_INT"} <= set(kinds)
    assert "BAD_DATA" not in kinds
    assert abs(moments[0] - time.time()) < 60
    assert moments == sorted(moments)
    first = struct.unpack(">Q", path.read_bytes()[:8])[0]
    assert abs(first / 1e6 - time.time()) < 60


def test_a_link_is_one_for_one_vehicle(meadow, served):
    """What another vehicle says is left out."""
    with served(meadow, (0, 0, 5)) as server, connect(f"udpout:127.0.0.1:{server.port}") as link:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger:
            for system in (7, 1):  # by its number, or from elsewhere
                other = packed(codec(system, 1), messages().MAVLink_statustext_message(4, b"I am another"))
                stranger.sendto(other, ("127.0.0.1", link.port))
        assert link.receive("STATUSTEXT", timeout=0.5) is None
        assert isinstance(link, Link)
