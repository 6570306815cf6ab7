"""MAVSDK, another program that speaks MAVLink: as a ground station for our vehicle, and as a vehicle for ours."""

import socket
import time

import pytest
from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.logging import log_subscribe, log_unsubscribe
from mavsdk.plugins.action.action import Action
from mavsdk.plugins.mission_raw.mission_raw import MissionRaw
from mavsdk.plugins.mission_raw_server.mission_raw_server import MissionRawServer
from mavsdk.plugins.telemetry.telemetry import Telemetry

from uavlab.mavlink import connect, transfer
from uavlab.mavlink.coding import items_of
from uavlab.mavlink.dialect import MISSION

PATIENCE = 20.0


@pytest.fixture
def mavsdk():
    """A function that makes one; all of them are closed in the end."""
    opened = []
    log_subscribe(lambda level, message, file, line: True)

    def make(kind):
        opened.append(Mavsdk(Configuration.create_with_component_type(kind)))
        return opened[-1]

    yield make
    for one in opened:
        one.destroy()
    log_unsubscribe()


def wait(condition):
    """Wait until something holds."""
    end = time.monotonic() + PATIENCE
    while not condition() and time.monotonic() < end:
        time.sleep(0.05)
    assert condition()


@pytest.mark.parametrize("firmware", ["px4", "ardupilot"])
def test_it_flies_our_vehicle(meadow, square, served, mavsdk, firmware, tmp_path):
    square.to_plan(tmp_path / "square.plan")
    with served(meadow, (0, 0, 5), firmware=firmware) as server:
        station = mavsdk(ComponentType.GROUND_STATION)
        station.add_any_connection(f"udpout://127.0.0.1:{server.port}")
        system = station.first_autopilot(PATIENCE)
        raw, telemetry, action = MissionRaw(system), Telemetry(system), Action(system)
        plan = raw.import_qgroundcontrol_mission(str(tmp_path / "square.plan"))
        raw.upload_geofence(plan.geofence_items)
        raw.upload_mission(plan.mission_items)
        assert server.vehicle.pilot.items == square.items
        assert len(server.vehicle.pilot.areas) == len(square.fence)
        back = raw.download_mission()
        assert [(i.command, i.x, i.y, i.z) for i in back] == [(i.command, i.x, i.y, i.z) for i in plan.mission_items]
        action.arm()
        raw.start_mission()
        wait(lambda: telemetry.in_air())
        wait(lambda: telemetry.position().relative_altitude_m > 25)
        assert telemetry.position().latitude_deg == pytest.approx(47.25, abs=0.002)
        action.return_to_launch()
        wait(lambda: not telemetry.armed())
        assert telemetry.position().relative_altitude_m == pytest.approx(0.0, abs=3.0)


def test_it_takes_our_missions(square, long_mission, mavsdk):
    """Nothing of this vehicle is ours; it knows missions alone, so fence and rally points stay here."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    with connect(f"udp:127.0.0.1:{port}", wait=False) as link:
        vehicle = mavsdk(ComponentType.AUTOPILOT)
        vehicle.add_any_connection(f"udpout://127.0.0.1:{port}")
        taken = []
        server = MissionRawServer(vehicle.server_component(0))
        server.subscribe_incoming_mission(lambda result, plan, _: taken.append((result.name, plan.mission_items)))
        end = time.monotonic() + PATIENCE
        while link.vehicle is None and time.monotonic() < end:
            link.receive("HEARTBEAT", timeout=1.0)
        assert link.vehicle is not None
        for mission in (square, long_mission):
            taken.clear()
            items = items_of(mission, MISSION, link.autopilot)
            transfer.give(link, MISSION, items, 10.0, Silent())
            wait(lambda: taken)
            name, found = taken[0]
            assert name == "SUCCESS"
            wanted = [(i.command, i.frame, round(i.latitude * 1e7), round(i.longitude * 1e7)) for i in items]
            assert [(i.command, i.frame, i.x, i.y) for i in found] == wanted
            assert [i.z for i in found] == pytest.approx([i.altitude for i in items], abs=1e-3)


class Silent:
    """A bar that isn't shown."""

    def update(self, count):
        pass
