"""Over many campuses: the safe height above true roofs, and the clearance, at each point of what swarms find."""

import numpy as np
import pytest

from uavlab.planners import least_risk, refine, waypoint_swarm
from uavlab.risk import CAMPUS_FLIGHT, random_campus

CLEAR = 2.4


def least_height(city, route):
    """Least height above roof or ground along a route [m]; all buildings of a campus are upright prisms."""
    points = route.resample(0.1).points
    below = np.full(len(points), city.origin[2])
    for building in city.buildings:
        low, high = building.bounds[:, 2]
        over = building.contains(np.column_stack([points[:, :2], np.full(len(points), (low + high) / 2)]))
        below[over] = np.maximum(below[over], high)
    return (points[:, 2] - below).min()


@pytest.mark.parametrize("seed", range(20))
def test_swarms_and_refined_routes_keep_the_safe_height_and_the_clearance_at_each_point(seed):
    risk_map = random_campus(seed)
    exact = least_risk(risk_map, *CAMPUS_FLIGHT, min_clearance=CLEAR)
    assert exact.reached
    routes = [
        exact,
        refine(risk_map, exact, rng=0, budget=400, min_clearance=CLEAR),
        waypoint_swarm(risk_map, *CAMPUS_FLIGHT, rng=0, budget=800, min_clearance=CLEAR),
        waypoint_swarm(risk_map, *CAMPUS_FLIGHT, rng=0, budget=800, min_clearance=CLEAR, risk=0.0, length=1.0),
    ]
    arrived = [route for route in routes if route.reached]
    assert len(arrived) >= 3
    for route in arrived:
        assert least_height(risk_map.city, route) >= risk_map.safe_height - 1e-6
        assert route.clearance(risk_map.city) >= CLEAR - 1e-8
        assert risk_map.city.distance(route.resample(0.1).points, 4.0).min() >= CLEAR - 1e-8
