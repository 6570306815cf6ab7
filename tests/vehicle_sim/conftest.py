"""What the tests of the simulated vehicle share."""

from dataclasses import replace

import numpy as np
import pytest

from uavlab.city import Building, City, Place
from uavlab.flight import PERFECT_GPS, Autopilot
from uavlab.risk import reference_campus
from uavlab.vehicle_sim.pilot import Pilot
from uavlab.weather import Wind

PLACE = Place(8.5, 47.25, 420.0)


@pytest.fixture(scope="session")
def campus():
    found = reference_campus()
    return replace(found, city=replace(found.city, reference=PLACE))


@pytest.fixture(scope="session")
def meadow():
    return City(np.zeros((40, 40, 12), bool), cell=10.0, origin=(-200.0, -200.0, 0.0), reference=PLACE, name="meadow")


@pytest.fixture(scope="session")
def town():
    """One tower with a flat roof at 20 m, 20 m wide, around x = y = 50."""
    tower = Building.prism([(40, 40), (60, 40), (60, 60), (40, 60)], 20.0, name="tower")
    return City.from_buildings([tower], cell=2.0, origin=(0, 0, 0), size=(100, 100, 60), reference=PLACE, name="town")


@pytest.fixture
def standing(campus):
    """A function that makes a pilot on the ground, in calm air and with perfect GPS unless said otherwise."""

    def make(city, at, *, wind=None, gps=PERFECT_GPS, uav=None, seed=1):
        wind = wind or Wind(gusts="none")
        autopilot = Autopilot(gps=gps, heeds_limits=False)
        return Pilot.standing(
            city, uav or campus.uav, wind, autopilot, np.array(at, float), np.random.default_rng(seed)
        )

    return make


@pytest.fixture
def flown():
    """A function that lets a pilot fly until it stands again, and gives what happened: (time, position) and words."""

    def fly(pilot, seconds=400.0, until=None):
        track, words, reached = [], [], []
        while pilot.body.time < seconds:
            pilot.tick()
            track.append((pilot.body.time, *pilot.body.where.position))
            words += pilot.words
            reached += pilot.reached
            pilot.words.clear()
            pilot.reached.clear()
            if pilot.body.path is None or (until is not None and until(pilot)):
                break
        return np.array(track), words, reached

    return fly
