"""The risk map: deaths per hour of flight in each voxel, and what a route costs on it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.city import City
from uavlab.city.extent import locked
from uavlab.city.lazy import check_plain
from uavlab.risk.drift import Falls, falls_of, landing_rate
from uavlab.risk.rates import check_density, person_rate, vehicle_rate
from uavlab.risk.sora import highest_within, igrc
from uavlab.risk.threat import building_threat
from uavlab.route import Route, Way, as_route
from uavlab.vehicle import RISK_QUADROTOR, UAV

SAFE_HEIGHT = 3.0
"""H_safe [m] (PSO-BAS Table 2): least height above what lies below."""


@dataclass(frozen=True, eq=False)
class RiskMap:
    """Ground risk over a city: layers of the ground, and the rates that follow from them.

    Attributes
    ----------
    city : City
        Over which it flies.
    population_density : (nx, ny) array, or one number for all
        ρ [1/m²], 0 to 10; 0.03 is 30 000 per km².
    shelter : (nx, ny) array, or one number
        p_s, 0 (none) to 1 (industry), see `SHELTER`.
    vehicle_share : (nx, ny) array, or one number
        C, share of the ground that cars cover, see `road_layer` and `vehicle_share`; 0 off the roads.
    uav : UAV
        What falls down; at its cruise speed.
    safe_height : float
        H_safe [m], the least height above the roof or ground below.
    min_height : float
        Least height above the ground, whatever is below [m]; planners take it unless they are given another.
    as_printed : bool
        With the papers' fall speed (half the exponent).

    Raises
    ------
    ValueError
        If `population_density`, `shelter` or `vehicle_share` is neither one number nor of the shape of the city's
        ground plan; `population_density` is not from 0 to 10 per m²; `shelter` or `vehicle_share` is not from 0 to 1;
        `safe_height` or `min_height` is negative or not finite; `city` is no `City`; `uav` is no `UAV`; or `as_printed`
        isn't True or False.

    See Also
    --------
    reference_campus : a map to begin with.
    read_people : people from a file.
    raster_layer : people from a raster.
    uavlab.planners.least_risk : plans over it.

    Examples
    --------
    Deaths in a million hours of flight, low and high, over open ground in a city.

    >>> import numpy as np
    >>> from uavlab.city import City
    >>> from uavlab.risk import RiskMap
    >>> risk = RiskMap(City(np.zeros((10, 10, 8), dtype=bool), cell=5.0), population_density=0.03, shelter=0.0)
    >>> risk, (1e6 * risk.rate[0, 0, [1, 7]]).round(2)
    (<RiskMap of city: 10 × 10 × 8 voxels of 5 m>, array([5.02, 2.98]))
    """

    city: City
    population_density: np.ndarray
    shelter: np.ndarray
    vehicle_share: np.ndarray = 0.0  # type: ignore[assignment]
    uav: UAV = RISK_QUADROTOR
    safe_height: float = SAFE_HEIGHT
    min_height: float = 0.0
    as_printed: bool = False

    def __post_init__(self) -> None:
        check_plain(self.city, "a risk map")
        checks.instance("uav", self.uav, UAV)
        for name in ("population_density", "shelter", "vehicle_share"):
            object.__setattr__(self, name, checked_layer(self.city, name, getattr(self, name)))
        check_density(self.population_density)
        checks.within("shelter", self.shelter, 0.0, 1.0, "(0 none, 1 industry)")
        checks.within("vehicle_share", self.vehicle_share, 0.0, 1.0, "of the ground")
        checks.set_fields(self, checks.not_negative_number, "safe_height", "min_height")
        checks.flag("as_printed", self.as_printed)

    def __repr__(self) -> str:
        return f"<RiskMap of {self.city.name}: {' × '.join(map(str, self.city.shape))} voxels of {self.city.cell:g} m>"

    @cached_property
    def person_rate(self) -> np.ndarray:
        """P1, deaths of people on the ground per hour of flight, (nx, ny, nz) [1/h]."""
        population, shelter = self.population_density[..., None], self.shelter[..., None]
        return person_rate(self.city.height_above_surface, population, shelter, self.uav, as_printed=self.as_printed)

    @cached_property
    def vehicle_rate(self) -> np.ndarray:
        """P2, deaths in cars per hour of flight, (nx, ny) [1/h]; the same at all heights."""
        return vehicle_rate(self.vehicle_share)

    @cached_property
    def rate(self) -> np.ndarray:
        """r = P1 + P2, (nx, ny, nz) [1/h]."""
        return self.person_rate + self.vehicle_rate[..., None]

    @cached_property
    def igrc(self) -> np.ndarray:
        """Intrinsic ground risk class of each cell of the ground for this UAV, (nx, ny) int, see `uavlab.risk.igrc`.

        From `population_density` alone: SORA counts people, whatever shelters them, and cars by the people in them.
        """
        uav = self.uav
        mass, speed = uav.mass + uav.payload, max(uav.top_speed, uav.cruise_speed)
        return locked(np.asarray(igrc(self.population_density, uav.diameter, speed, mass=mass)))

    def igrc_within(self, ground_risk_buffer: float) -> np.ndarray:
        """The highest class below and within a ground risk buffer, for a flight above each cell.

        Parameters
        ----------
        ground_risk_buffer : float
            Distance [m], at least 0, from the centre of a cell to the nearest point of the others; 0 is the cell alone.
            See `uavlab.risk.ground_risk_buffer`.

        Returns
        -------
        (nx, ny) array of int
            Beyond the edge of the map nothing is known and nothing counted.

        Raises
        ------
        ValueError
            If `ground_risk_buffer` is negative or not finite.

        Examples
        --------
        A crowd in a meadow, which a flight has to pass at a distance.

        >>> import numpy as np
        >>> from uavlab.city import City
        >>> from uavlab.risk import RiskMap
        >>> people = np.full((7, 7), 10e-6)
        >>> people[3, 3] = 0.1
        >>> risk = RiskMap(City(np.zeros((7, 7, 8), dtype=bool), cell=5.0), people, shelter=0.0)
        >>> [int((risk.igrc_within(buffer) > 6).sum()) for buffer in (0.0, 5.0, 10.0)]
        [1, 9, 21]
        """
        return highest_within(
            self.igrc, checks.not_negative_number("ground_risk_buffer", ground_risk_buffer), self.city.cell
        )

    def highest_igrc(self, route: Route | Way, *, ground_risk_buffer: float = 0.0) -> int:
        """The class of a flight: the highest below the voxels that a route passes, and within a buffer.

        Parameters
        ----------
        route : Route or Curve
            On the map; not arriving is no hindrance, if it has points.
        ground_risk_buffer : float
            As for `igrc_within` [m].

        Returns
        -------
        int
            1 to 10, or `uavlab.risk.sora.NO_CLASS`.

        Raises
        ------
        ValueError
            If `ground_risk_buffer` is negative or not finite, or `route` leaves the map, was not found, or is neither
            route nor curve.

        See Also
        --------
        uavlab.planners.least_risk : With `max_igrc` keeps to lower classes.

        Examples
        --------
        >>> from uavlab.planners import least_risk
        >>> from uavlab.risk import CAMPUS_FLIGHT, reference_campus
        >>> campus = reference_campus()
        >>> route = least_risk(campus, *CAMPUS_FLIGHT)
        >>> campus.highest_igrc(route)
        6
        """
        index, length = found(route).voxels(self.city)
        passed = index[length > 1e-9 * self.city.cell]
        return int(self.igrc_within(ground_risk_buffer)[passed[:, 0], passed[:, 1]].max())

    @cached_property
    def threat(self) -> np.ndarray:
        """Threat of the buildings, (nx, ny, nz) [m], see `building_threat`."""
        return building_threat(self.city)

    @cached_property
    def flyable(self) -> np.ndarray:
        """Free voxels that are `safe_height` above what lies below and `min_height` above the ground, bool."""
        return locked(high_enough(self.city, self.safe_height) & ~self.city.blocked(min_height=self.min_height))

    @cached_property
    def rate_ahead(self) -> np.ndarray:
        """Rate where the wreck lands, for each of the 26 moves, (26, nx, ny, nz) [1/h].

        The UAV flies at cruise speed in the direction of the move (`uavlab.planners.grid.MOVES`) and fails at the
        voxel's centre; its ballistic fall ends on the ground, on a roof or against a wall. It is slower on impact than
        in `rate`, which keeps the forward speed as the papers do: without drift r would be about a tenth lower.
        Beyond the border of the map the ground is taken to go on as it is at the border, and to be free of buildings.
        """
        index = np.argwhere(np.ones(self.city.shape, dtype=bool))
        moves = np.argwhere(np.ones((3, 3, 3), dtype=bool)) - 1
        moves = moves[(moves != 0).any(axis=1)]
        return np.stack([landing_rate(self.falls, index, move).reshape(self.city.shape) for move in moves])

    @cached_property
    def falls(self) -> Falls:
        """Falls in any direction of flight, for compiled code."""
        return falls_of(self.city, self.uav, self.population_density, self.shelter, self.vehicle_share)

    def integral(self, route: Route | Way, *, drift: bool = False) -> float:
        """∫ r ds / dx, the cost that planners minimise [1/h]: by exact voxel traversal, diagonals at their length.

        Divided by the edge dx of a voxel it is on the scale of the papers' sums over cells.

        Parameters
        ----------
        route : Route or Curve
            On the map; not arriving is no hindrance, if it has points.
        drift : bool
            Take the rate where the wreck lands that fails while it flies along the route, see `rate_ahead`.

        Returns
        -------
        float
            [1/h]

        Raises
        ------
        ValueError
            If `route` leaves the map, was not found, or is neither route nor curve, or `drift` isn't True or False.

        See Also
        --------
        RiskMap.fatalities : deaths per mission.
        RiskMap.cell_sum : the papers' sum.

        Examples
        --------
        The UAV flies over trees towards an open square. Its wreck may land there, which is over 40 times the risk.

        >>> from uavlab.city import City
        >>> from uavlab.risk import RiskMap
        >>> from uavlab.route import Route
        >>> city = City.from_buildings([], cell=5.0, origin=(0, 0, 0), size=(50, 50, 40))
        >>> risk = RiskMap(city, 0.03, shelter=[[0.5] * 10] * 5 + [[0.0] * 10] * 5)
        >>> route = Route([(2.5, 7.5, 22.5), (25, 7.5, 22.5)])
        >>> [f"{risk.integral(route, drift=drift):.1e}" for drift in (False, True)]
        ['3.3e-07', '1.5e-05']
        """
        route = found(route)
        if not checks.flag("drift", drift):
            return route.integral(self.city, self.rate) / self.city.cell
        route.voxels(self.city)  # refuses a route that leaves the map
        total = 0.0
        for start, end in pairwise(route.points):
            index, length = self.city.voxels_along(np.array([start, end]))
            total += float(landing_rate(self.falls, index, end - start) @ length) if (end != start).any() else 0.0
        return total / self.city.cell

    def cell_sum(self, route: Route | Way) -> float:
        """Σ r over the voxels that the route passes, as printed (RISK-ACO Eq. 3, PSO-BAS Eq. 1) [1/h].

        Each voxel counts once, however long the way in it: diagonals come free, and halving the voxels doubles it.

        Parameters
        ----------
        route : Route or Curve
            On the map; not arriving is no hindrance, if it has points.

        Returns
        -------
        float
            [1/h]

        Raises
        ------
        ValueError
            If `route` leaves the map, was not found, or is neither route nor curve.

        See Also
        --------
        RiskMap.integral : the cost that planners minimise.

        Examples
        --------
        A diagonal through all ten voxels is √2 times as long as a straight way, and has the same sum.

        >>> import numpy as np
        >>> from uavlab.city import City
        >>> from uavlab.risk import RiskMap
        >>> from uavlab.route import Route
        >>> risk = RiskMap(City(np.zeros((10, 10, 8), dtype=bool), cell=5.0), 0.03, 0.0)
        >>> ways = [Route([(0, 0, 22.5), (49.999, north, 22.5)]) for north in (0, 49.999)]
        >>> [f"{risk.cell_sum(way):.2e} {risk.integral(way):.2e}" for way in ways]
        ['3.45e-05 3.45e-05', '3.45e-05 4.88e-05']
        """
        route = found(route)
        city = self.city
        index, length = route.voxels(city)
        passed = np.unique(city.code_of(index[length > 1e-9 * city.cell]))
        return float(self.rate.ravel()[passed].sum())

    def fatalities(self, route: Route | Way, speed: float | None = None) -> float:
        """Expected deaths per mission, ∫ r ds / (3600 V).

        Parameters
        ----------
        route : Route or Curve
            On the map; not arriving is no hindrance, if it has points.
        speed : float, optional
            V over ground [m/s], above 0; the UAV's cruise speed by default.

        Returns
        -------
        float
            Deaths, far below 1.

        Raises
        ------
        ValueError
            If `speed` is not above 0 and finite, or `route` leaves the map, was not found, or is neither route nor
            curve.

        See Also
        --------
        RiskMap.integral : the cost that planners minimise.

        Examples
        --------
        At a quarter of the speed the UAV is over people for four times as long.

        >>> from uavlab.risk import reference_campus
        >>> from uavlab.route import Route
        >>> campus, route = reference_campus(), Route([(12.5, 17.5, 72.5), (112.5, 112.5, 72.5)])
        >>> f"{campus.fatalities(route):.2e} {campus.fatalities(route, speed=4.0):.2e}"
        '3.43e-09 1.37e-08'
        """
        speed = checks.positive_number("speed", self.uav.cruise_speed if speed is None else speed)
        route = found(route)
        return route.integral(self.city, self.rate) / (3600 * speed)


def high_enough(city: City, safe_height: float) -> np.ndarray:
    """Free voxels that are high enough above what lies below, (nx, ny, nz) bool."""
    return ~city.occupied & (city.height_above_surface >= safe_height - 1e-9)


def found(way: Route | Way) -> Route:
    """A route, unless it was not found: it would cost nothing, less than any other."""
    route = as_route(way)
    if not (route.reached or len(route.points)):
        raise ValueError(f"route must be one that was found (route.reached), got none: {route.reason}")
    return route


def checked_layer(city: City, name: str, values: npt.ArrayLike) -> np.ndarray:
    """A layer as floats (nx, ny); one number holds for the whole ground plan."""
    layer = checks.numbers(name, values)
    if layer.shape not in ((), city.shape[:2]):
        raise ValueError(
            f"{name} must have the shape of the city's ground plan {city.shape[:2]} or be one number, "
            f"got {layer.shape}; raster_layer and road_layer bring others onto it"
        )
    return np.broadcast_to(layer, city.shape[:2])
