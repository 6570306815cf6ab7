"""What the papers minimise when risk is left aside: the length of the way and the threat of tall buildings.

J0 = ω1·J_l + ω2·J_s (RISK-ACO section 2.3, PSO-BAS section 3.3), with J_l the length and J_s = f1 over the distance to
a building (RISK-ACO Eq. 1). As printed J_s is a minimum over the route, which no search can add up edge by edge, knows
one building of any height, and is infinite above its centre. As a layer it adds up.
"""

from __future__ import annotations

import numpy as np

from uavlab import checks
from uavlab.city import Building, City
from uavlab.city.lazy import check_plain
from uavlab.route import Route

THREAT_CONSTANT = 100.0
"""f1 [m²], ours: the papers give none. A building 10 m away then counts like 10 m of way."""

LENGTH_WEIGHT, THREAT_WEIGHT = 0.5, 0.2
"""ω1 and ω2 (RISK-ACO and PSO-BAS Table 3)."""


def building_threat(city: City, *, constant: float = THREAT_CONSTANT) -> np.ndarray:
    """Threat of the buildings to a UAV in each voxel, Σ f1 / max(D, 1 m), below their roofs (RISK-ACO Eq. 1).

    D = max(|y − y_a|, (a/b)·|x − x_a|), the distance that the paper measures, with the centre (x_a, y_a) of a
    building's bounding box and its half extents b to the east and a to the north.

    Parameters
    ----------
    city : City
        Only buildings count that it knows as such.
    constant : float
        f1 [m²], at least 0.

    Returns
    -------
    (nx, ny, nz) array
        [m]; 0 above all roofs.

    Raises
    ------
    ValueError
        If `city` knows no buildings though voxels are occupied, or is no `City`, or `constant` is negative or not
        finite.

    See Also
    --------
    printed_threat : the papers' minimum over a route.
    RiskMap.threat : the same, kept with a map.

    Examples
    --------
    A row of voxels past a house of 20 × 10 m, half of them below its sides. Above the roof there is no threat.

    >>> from uavlab.city import Building, City
    >>> from uavlab.risk import building_threat
    >>> house = Building.prism([(10, 10), (30, 10), (30, 20), (10, 20)], 15)
    >>> threat = building_threat(City.from_buildings([house], cell=5.0, origin=(0, 0, 0), size=(40, 30, 30)))
    >>> threat[:, 2, 0].round(1), float(threat[:, :, 3:].max())
    (array([11.4, 16. , 26.7, 40. , 40. , 26.7, 16. , 11.4]), 0.0)
    """
    check_plain(city, "a threat in each voxel")
    constant = checks.not_negative_number("constant", constant)
    if not city.buildings and city.occupied.any():
        raise ValueError("city must know its buildings, not only voxels: use read_geojson or City.from_buildings")
    x, y, z = (city.coordinates(axis) for axis in range(3))
    threat = np.zeros(city.shape)
    for building in city.buildings:
        below = z < building.bounds[1, 2]
        near = constant / np.maximum(scaled_distance(building, x[:, None], y[None, :]), 1.0)
        threat[:, :, below] += near[:, :, None]
    return threat


def printed_threat(route: Route, city: City, *, constant: float = THREAT_CONSTANT) -> float:
    """J_s as printed: f1 over the least distance D of any waypoint to any building (RISK-ACO Eq. 1).

    J_s = f1 / min D, with D as in `building_threat`. Height plays no part, so a route high above a roof's centre is an
    infinite threat; waypoints alone are looked at.

    Parameters
    ----------
    route : Route
        With at least one point.
    city : City
        Only buildings count that it knows as such.
    constant : float
        f1 [m²], at least 0.

    Returns
    -------
    float
        J_s [m], may be infinite.

    Raises
    ------
    ValueError
        If `city` knows no buildings or is no `City`, `route` has no points or is no `Route`, or `constant` is negative
        or not finite.

    See Also
    --------
    building_threat : as a layer, which planners can add up.

    Examples
    --------
    The second route passes over the house, and has no waypoint there.

    >>> from uavlab.city import Building, City
    >>> from uavlab.risk import printed_threat
    >>> from uavlab.route import Route
    >>> house = Building.prism([(10, 10), (30, 10), (30, 20), (10, 20)], 15)
    >>> city = City.from_buildings([house], cell=5.0)
    >>> [printed_threat(Route([(0, 15, 20), *over, (40, 15, 20)]), city) for over in ([(20, 15, 20)], [])]
    [inf, 10.0]
    """
    checks.instance("route", route, Route)
    checks.instance("city", city, City)
    constant = checks.not_negative_number("constant", constant)
    if not city.buildings or len(route.points) == 0:
        raise ValueError("the printed threat needs a route with points and a city that knows its buildings")
    x, y, _ = route.points.T
    nearest = min(float(scaled_distance(building, x, y).min()) for building in city.buildings)
    return constant / nearest if nearest > 0 else np.inf


def scaled_distance(building: Building, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """max(|y − y_a|, (a/b)·|x − x_a|) [m]: distance in units of y, even all around the outline of a box."""
    low, high = building.bounds
    (east, north, _), (b, a, _) = (low + high) / 2, (high - low) / 2
    return np.maximum(np.abs(y - north), a / b * np.abs(x - east))
