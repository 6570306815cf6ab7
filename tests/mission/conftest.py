"""An autopilot that isn't there, for MAVSDK's reader of missions."""

import time

import pytest
from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.logging import log_subscribe, log_unsubscribe
from mavsdk.plugins.mission_raw.mission_raw import MissionRaw
from pymavlink.dialects.v20 import common

LONGEST = 5.0
"""How long MAVSDK may take to know an autopilot by its heartbeats [s]."""


@pytest.fixture(scope="session")
def importer():
    """MAVSDK's reader of missions for an autopilot, by its MAV_AUTOPILOT: heartbeats are passed as bytes, no port."""
    opened = []
    log_subscribe(lambda level, message, file, line: True)

    def reader(autopilot):
        known = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
        opened.append(known)
        known.add_any_connection("raw://")
        coder = common.MAVLink(None, srcSystem=1, srcComponent=1)
        heartbeat = coder.heartbeat_encode(common.MAV_TYPE_QUADROTOR, autopilot, 0, 0, common.MAV_STATE_STANDBY)
        began, system = time.monotonic(), None
        while system is None and time.monotonic() - began < LONGEST:
            known.pass_received_raw_bytes(heartbeat.pack(coder))
            system = known.first_autopilot(0.1)
        assert system is not None
        return MissionRaw(system)

    yield reader
    for known in opened:
        known.destroy()
    log_unsubscribe()


@pytest.fixture(scope="session")
def px4(importer):
    return importer(common.MAV_AUTOPILOT_PX4)


@pytest.fixture(scope="session")
def ardupilot(importer):
    return importer(common.MAV_AUTOPILOT_ARDUPILOTMEGA)
