"""Flying a route in gusts: what planners promise, put to the test.

A UAV as a point mass whose autopilot tilts a limited thrust against wind, rain and load; or, simpler and as REPARE has
it, offsets that are added to the route. One flight with all its steps, or thousands; crashes with intervals, offsets,
clearance, time, energy. A monitor may change how it is flown while the weather turns.
"""

from uavlab.flight.autopilot import GPS, PERFECT_GPS, Autopilot, Gps
from uavlab.flight.disturbance import OffsetProcess, offset_sigma
from uavlab.flight.results import Energy, Flight, Flights, Rate, crash_rate
from uavlab.flight.simulation import fly, monte_carlo

__all__ = [
    "GPS",
    "PERFECT_GPS",
    "Autopilot",
    "Energy",
    "Flight",
    "Flights",
    "Gps",
    "OffsetProcess",
    "Rate",
    "crash_rate",
    "fly",
    "monte_carlo",
    "offset_sigma",
]
