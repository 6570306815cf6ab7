"""Cities, routes and flights that several tests draw."""

import numpy as np
import pytest

from uavlab.city import Building, City, NoFlyZone
from uavlab.flight import OffsetProcess, fly
from uavlab.planners import astar, repare
from uavlab.vehicle import LIGHT_QUADROTOR

ENDS = (90, 18, 30), (50, 44, 30)


@pytest.fixture(scope="session")
def route(table1):
    """A*'s, with the order in which it expanded its nodes."""
    return astar(table1, *ENDS, record=True)


@pytest.fixture(scope="session")
def crash_and_safe(table1):
    """Two flights of REPARE Fig. 12's pair in offsets of 1 m: A* ends at a wall, REPARE arrives."""
    routes = astar(table1, *ENDS), repare(table1, *ENDS)
    crash, safe = (fly(route, table1, LIGHT_QUADROTOR, OffsetProcess(1.0), rng=3) for route in routes)
    assert (crash.outcome, safe.outcome) == ("crashed", "arrived")
    return {"A*": crash, "REPARE": safe}


@pytest.fixture(scope="session")
def hill():
    """Ground that rises to 20 m in the middle, a house, and two no-fly zones."""
    x, y = np.meshgrid(np.arange(30) - 14.5, np.arange(20) - 9.5, indexing="ij")
    house = Building.prism([(12, 12), (24, 12), (24, 24), (12, 24)], 10)
    zones = (
        NoFlyZone([(70, 20), (90, 20), (90, 30)], 0.0, 20.0, name="<school>"),
        NoFlyZone([(20, 50), (30, 50), (30, 60), (20, 60)], 10.0, name="church"),
    )
    grid, ground = np.zeros((30, 20, 15), dtype=bool), 20 * np.exp(-(x**2 + y**2) / 30)
    return City(grid, 4.0, buildings=(house,), name="hill", ground=ground, no_fly=zones)
