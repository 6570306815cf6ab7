"""What the tests of flights share: an empty sky, a long wall, and how far two shares may lie apart."""

import numpy as np

from uavlab.city import City
from uavlab.flight import PERFECT_GPS, Autopilot
from uavlab.route import Route

SKY = City(np.zeros((60, 30, 10), bool), cell=10.0)
EXACT = Autopilot(gps=PERFECT_GPS)


def straight(length=100.0, start=(20.0, 150.0, 50.0)):
    """A level leg to the east."""
    return Route([start, np.add(start, (length, 0, 0))])


def beside_wall(distance, length=40):
    """A wall 20 m high, longer than the leg that passes it to the north at half its height."""
    occupied = np.zeros((length + 40, 20, 20), bool)
    occupied[:, 0] = True
    return City(occupied), Route([(20, 1 + distance, 10), (20 + length, 1 + distance, 10)])


def standard_errors_apart(hits, tries, other_hits, other_tries):
    """By how many standard errors two shares differ."""
    pooled = (hits + other_hits) / (tries + other_tries)
    return abs(hits / tries - other_hits / other_tries) / np.sqrt(pooled * (1 - pooled) * (1 / tries + 1 / other_tries))
