"""The hazard planner: A* that pays for the chance to touch a wall, then straight lines (beyond REPARE).

REPARE forbids a zone softly: a metre just inside of it costs as much as one at the wall, one just outside nothing. But
the chance that a gust throws the UAV against a wall falls smoothly with the distance, and Rice's formula says how
fast. As a price per metre it lets a route pass a gap quickly where that is worth it, and keep off where it is not.
"""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.city import City
from uavlab.city.extent import locked
from uavlab.city.kept import kept_for_city
from uavlab.compiled import compilable
from uavlab.offsets.exposure import rate_at
from uavlab.planners.astar import cheapest_route
from uavlab.planners.question import Airspace, endpoints, timed
from uavlab.planners.shortcut import shortcut
from uavlab.route import Route

DIAMETER = 1.0
"""Of the papers' body [m]."""

NO_HAZARD = 40.0
"""So many σ away the chance is no number above 0."""

CRASH_PRICE = 3000.0
"""λ [m]: how many metres of detour a crash is worth, when it is certain."""


def hazard_price(
    city: City,
    sigma: float,
    *,
    uav_diameter: float = DIAMETER,
    mean_offset: npt.ArrayLike = (0.0, 0.0, 0.0),
    speed: float = 5.0,
    natural_frequency: float = 1.0,
    crash_price: float = CRASH_PRICE,
) -> np.ndarray:
    """Price of a metre, 1 + λ·ν/v with Rice's rate ν = (ω_n/2π) exp(−u²/2σ²) at the margin u; kept for the next query.

    Parameters
    ----------
    city : City
    sigma : float
        σ of the offset on one axis [m], above 0.
    uav_diameter : float
        D_uav [m], at least 0. The margin is u = D − D_uav/2, at least 0, with D the least distance to obstacles on the
        way from the route to where the mean offset holds the UAV.
    mean_offset : (2,) or (3,) array
        μ, where the steady wind holds the UAV, from its route [m]. Away from a wall it gives no credit.
    speed : float
        v over ground [m/s], above 0: who passes faster is exposed for less time.
    natural_frequency : float
        ω_n of the position control [rad/s], above 0.
    crash_price : float
        λ [m], at least 0.

    Returns
    -------
    (nx, ny, nz) array
        For `astar(..., price=...)` and `shortcut(..., price=...)`; not to be written to.

    Raises
    ------
    ValueError
        If `city` is no City. If `sigma`, `speed` or `natural_frequency` is not finite and above 0. If `uav_diameter` or
        `crash_price` is negative or not finite. If `mean_offset` is not two or three finite numbers.

    See Also
    --------
    hazard_astar : Plans with it.
    penalty_zone : REPARE's, with an edge.
    uavlab.offsets.crossing_rate : ν.

    References
    ----------
    Rice, Mathematical analysis of random noise, 1944 and 1945.

    Examples
    --------
    >>> from uavlab.city import table1_city
    >>> from uavlab.planners import hazard_price
    >>> city = table1_city()
    >>> price = hazard_price(city, sigma=1.0)
    >>> price[[9, 8, 7, 6], 30, 30].round(1)  # 0.5, 1.5, 2.5 and 3.5 m from a wall
    array([96.5, 58.9, 13.9,  2.1])
    """
    checks.instance("city", city, City)
    sigma, speed = checks.positive_number("sigma", sigma), checks.positive_number("speed", speed)
    natural_frequency = checks.positive_number("natural_frequency", natural_frequency)
    radius = checks.not_negative_number("uav_diameter", uav_diameter) / 2
    crash_price = checks.not_negative_number("crash_price", crash_price)
    mean = checks.three("mean_offset", mean_offset)
    return cached_price(city, sigma, radius, mean, crash_price * natural_frequency / speed)


@kept_for_city(4)
def cached_price(
    city: City, sigma: float, radius: float, mean_offset: tuple[float, ...], crash_price: float
) -> np.ndarray:
    clearance = city.clearance_along(mean_offset, at_most=radius + NO_HAZARD * sigma)
    return locked(price_at(clearance, sigma, radius, crash_price))


@compilable
def price_at(clearance, sigma, radius, crash_price):
    """Of a metre at a clearance [m], at most NO_HAZARD σ from touching."""
    return 1.0 + crash_price * rate_at(np.maximum(clearance - radius, 0.0), sigma, 1.0)


def hazard_astar(
    city: City,
    start: npt.ArrayLike,
    goal: npt.ArrayLike,
    *,
    sigma: float,
    uav_diameter: float = DIAMETER,
    any_angle: bool = True,
    min_height: float = 0.0,
    max_height: float = np.inf,
    mean_offset: npt.ArrayLike = (0.0, 0.0, 0.0),
    speed: float = 5.0,
    natural_frequency: float = 1.0,
    crash_price: float = CRASH_PRICE,
) -> Route:
    """The route of least length plus hazard, over 26 neighbours, then by straight lines at the same price.

    cost = ∫ (1 + λ·ν/v) ds, see `hazard_price`.

    Parameters
    ----------
    city : City
    start, goal : (3,) arrays
        Positions [m].
    sigma : float
        σ of the offset on one axis [m], above 0.
    uav_diameter : float
        Of the body [m]: nothing on the route is nearer to an obstacle than half of it.
    any_angle : bool
        Join by straight lines what that makes no more expensive, see `shortcut`.
    min_height, max_height : float
        As for `astar` [m].
    mean_offset, speed, natural_frequency, crash_price
        As for `hazard_price`.

    Returns
    -------
    Route
        `cost` is ∫ price ds [m].

    Raises
    ------
    ValueError
        If `city` is no City. If `start` or `goal` is not three finite numbers, lies off the map, in an obstacle or a
        no-fly zone, so near to an obstacle that the body touches it, or above `max_height`. If both lie in one voxel.
        If `sigma`, `speed` or `natural_frequency` is not above 0. If `uav_diameter` or `crash_price` is negative. If
        `any_angle` is neither True nor False. If `mean_offset` is not two or three finite numbers. If `min_height` is
        negative or not finite. If `max_height` is not above `min_height`.

    See Also
    --------
    hazard_price : The price alone.
    repare : The paper's, with a zone.
    uavlab.flight.crash_rate : Of flights on a route.

    Examples
    --------
    >>> from uavlab.city import table1_city
    >>> from uavlab.planners import hazard_astar
    >>> city = table1_city()
    >>> calm = hazard_astar(city, (5, 5, 30), (95, 95, 30), sigma=0.3)
    >>> rough = hazard_astar(city, (5, 5, 30), (95, 95, 30), sigma=1.5)
    >>> calm, round(calm.clearance(city), 1)
    (<Route by hazard A*: 137.2 m, 6 waypoints>, 1.4)
    >>> rough, round(rough.clearance(city), 1)
    (<Route by hazard A*: 146.4 m, 11 waypoints>, 6.3)
    """
    began = time.perf_counter()
    any_angle = checks.flag("any_angle", any_angle)
    price = hazard_price(
        city, sigma, uav_diameter=uav_diameter, mean_offset=mean_offset, speed=speed,
        natural_frequency=natural_frequency, crash_price=crash_price,
    )  # fmt: skip
    airspace = Airspace(city, 0.0, min_height, max_height, radius=uav_diameter / 2)
    ends = endpoints(airspace, start, goal)
    route = cheapest_route(city, ends.source, ends.target, airspace.blocked, price, cheapest=1.0)
    route = ends.added_to(route, price, priced="hazard")
    if any_angle:
        route = shortcut(route, city, price=price)
    return timed(replace(route, planner="hazard A*"), began)
