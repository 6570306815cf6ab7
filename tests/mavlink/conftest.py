"""A vehicle that listens, in a thread of the test; missions for it."""

import threading
from contextlib import contextmanager
from dataclasses import replace

import numpy as np
import pytest

from uavlab.city import City, Place
from uavlab.flight import Autopilot
from uavlab.mavlink.dialect import ARDUPILOT, PX4
from uavlab.mission import Item, Mission
from uavlab.risk import CAMPUS_FLIGHT, reference_campus
from uavlab.route import Route
from uavlab.vehicle_sim import PERFECT_LINK
from uavlab.vehicle_sim.pilot import Pilot
from uavlab.vehicle_sim.server import Server, Service
from uavlab.weather import Wind

PLACE = Place(8.5, 47.25, 420.0)
FIRMWARES = {"px4": PX4, "ardupilot": ARDUPILOT}


@pytest.fixture(scope="session")
def campus():
    found = reference_campus()
    return replace(found, city=replace(found.city, reference=PLACE))


@pytest.fixture(scope="session")
def meadow():
    return City(np.zeros((40, 40, 12), bool), cell=10.0, origin=(-200.0, -200.0, 0.0), reference=PLACE, name="meadow")


@pytest.fixture(scope="session")
def mission(campus):
    """Over the roofs of the campus, far from all walls."""
    route = Route([(12.5, 17.5, 70.0), (60.0, 20.0, 70.0), (112.5, 60.0, 72.0), (112.5, 112.5, 70.0)])
    return Mission.from_route(route, campus.city, campus.uav, speed=8.0)


@pytest.fixture(scope="session")
def square(meadow, campus):
    """A mission around a square on the meadow."""
    route = Route([(0, 0, 30), (60, 0, 30), (60, 60, 30), (0, 60, 35)])
    return Mission.from_route(route, meadow, campus.uav, speed=8.0, end="return")


@pytest.fixture
def served(campus):
    """A function that starts a vehicle in a thread and gives the context of it."""
    running = []

    @contextmanager
    def start(city, at=CAMPUS_FLIGHT[0], *, link=PERFECT_LINK, firmware="px4", pace=50.0, wind=None, uav=None, **more):
        pilot = Pilot.standing(
            city, uav or campus.uav, wind or Wind((2.0, 1.0), deviation=0.5), Autopilot(heeds_limits=False, **more),
            np.array(at, float), np.random.default_rng(1),
        )  # fmt: skip
        server = Server(pilot, FIRMWARES[firmware], Service(link=link, pace=pace), np.random.default_rng(2))
        thread = threading.Thread(target=server.run)
        running.append((server, thread))
        thread.start()
        try:
            yield server
        finally:
            server.over.set()
            thread.join(10)

    yield start
    for server, thread in running:
        server.over.set()
        thread.join(10)
        assert not thread.is_alive()


@pytest.fixture
def long_mission():
    """300 waypoints."""
    rng = np.random.default_rng(3)
    items = [
        Item(16, 3, (0.0, 2.0, 0.0, float(rng.uniform(0, 360))), *(PLACE.latitude + 0.01 * rng.random(),
             PLACE.longitude + 0.01 * rng.random()), float(rng.uniform(10, 100)))
        for _ in range(300)
    ]  # fmt: skip
    return Mission(tuple(items), PLACE)
