"""A route and what can be measured on it: length, angles, and how near it comes to the buildings."""

from __future__ import annotations

import csv
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from uavlab import checks
from uavlab.city import City, LazyCity
from uavlab.city.extent import checked_heights
from uavlab.city.segments import least_clearance
from uavlab.files import written_whole

PROMISES = ("min_clearance", "min_height", "max_height", "safe_height")
"""What routes and curves remember that they keep [m]."""

MOST_WAYPOINTS = 10_000_000
"""Of a route that is resampled; more fill the memory."""


def check_promises(of: Any) -> None:
    """Refuse a route or a curve whose promises are out of their range.

    Parameters
    ----------
    of : Route or Curve
        Or anything else with `min_clearance`, `min_height`, `max_height` and `safe_height` [m].

    Raises
    ------
    ValueError
        If `min_clearance`, `min_height` or `safe_height` is negative or not finite, or `max_height` is not above
        `min_height`.

    See Also
    --------
    promises_of : The promises themselves.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> from uavlab.route import check_promises
    >>> check_promises(SimpleNamespace(min_clearance=-1.0, min_height=0.0, max_height=120.0, safe_height=0.0))
    Traceback (most recent call last):
        ...
    ValueError: min_clearance must be finite and at least 0, got -1
    """
    for name in ("min_clearance", "safe_height"):
        checks.not_negative_number(name, getattr(of, name))
    checked_heights(of.min_height, of.max_height)


def promises_of(one: Any, **instead: float | None) -> dict[str, Any]:
    """What a route or a curve promises, but for what is asked for instead.

    Parameters
    ----------
    one : Route or Curve
    **instead : float or None
        By the names of the promises [m]; None leaves what is promised.

    Returns
    -------
    dict
        `min_clearance`, `min_height`, `max_height` and `safe_height` [m].

    See Also
    --------
    check_promises : Refuses what is out of its range.

    Examples
    --------
    >>> from uavlab.route import Route, promises_of
    >>> route = Route([(5, 5, 30), (40, 5, 30)], min_clearance=3.5)
    >>> promises_of(route, max_height=120.0)
    {'min_clearance': 3.5, 'min_height': 0.0, 'max_height': 120.0, 'safe_height': 0.0}
    """
    return {name: getattr(one, name) if instead.get(name) is None else instead[name] for name in PROMISES}


def as_route(way: Route | Way, name: str = "route") -> Route:
    """What is drawn, measured or flown as a route: itself, or a curve's points, joined by straight legs.

    Parameters
    ----------
    way : Route or Curve
        Or anything else with a method `route()`.
    name : str
        Of the argument, for the message.

    Returns
    -------
    Route

    Raises
    ------
    ValueError
        If `way` is neither a route nor can be made one, or `name` is no text.

    See Also
    --------
    uavlab.spline.Curve.route : With legs of any length.

    Examples
    --------
    >>> from uavlab.route import as_route
    >>> from uavlab.spline import Curve
    >>> as_route(Curve([(5, 5, 30), (40, 5, 30), (40, 50, 30)]))
    <Route by curve: 69.7 m, 901 waypoints>
    """
    checks.text("name", name)
    made: Any = way
    if not isinstance(way, type) and callable(getattr(way, "route", None)):
        made = made.route()
    checks.instance(name, made, Route)
    return made


class Way(Protocol):
    """What can be made a route, such as a `uavlab.spline.Curve`.

    See Also
    --------
    as_route : Takes it.

    Examples
    --------
    >>> from uavlab.spline import Curve
    >>> way = Curve([(5, 5, 30), (40, 5, 30), (40, 50, 30)])
    >>> way.route()
    <Route by curve: 69.7 m, 901 waypoints>
    """

    def route(self) -> Route: ...


@dataclass(frozen=True, eq=False)
class Route:
    """What a planner returns.

    Attributes
    ----------
    points : (N, 3) float array
        Waypoints [m], joined by straight legs; (0, 3) when there is no route.
    planner : str
        Who made it.
    reached : bool
        Whether it arrives. Not arriving is an answer, not an error.
    reason : str
        Why it doesn't arrive; empty when it does.
    cost : float
        What the planner minimised, in the planner's own unit; infinite when it didn't arrive.
    info : dict
        What the planner noted. Of every planner: `elapsed`, the time from the call to the answer [s], and `expanded`,
        how much it looked at: nodes that were expanded, steps along a force, ways of ants, curves of a swarm.
    takeoff, landing : int
        How many of its first and last legs are vertical take-off and landing, below the planner's `min_height`.
    min_clearance, min_height, max_height, safe_height : float
        What its planner promises all along, but for take-off and landing [m]: least distance to obstacles, least and
        greatest height above ground, least height above roofs and ground below. `shortcut`, `smooth` and `refine` keep
        it, `feasibility` asks for it.
    max_length : float
        The length that it may have between take-off and landing [m]; `refine` keeps it.
    priced : str
        What a metre of it paid for beside its length, such as "risk"; empty if nothing. Without a price `shortcut`
        would lead it where that is dear.

    Raises
    ------
    ValueError
        If `points` hasn't shape (N, 3) or is not finite. If `min_clearance`, `min_height` or `safe_height` is negative
        or not finite. If `max_height` is not above `min_height`. If `max_length` is not above 0. If `planner`, `reason`
        or `priced` is no text, `reached` neither True nor False, `cost` no number, `info` no dict, or `takeoff` or
        `landing` no whole number of at least 0.

    See Also
    --------
    uavlab.planners.astar : Plans one, as all planners do.
    uavlab.spline.smooth : Makes it a curve.
    as_route : Makes a curve a route.

    Examples
    --------
    >>> import numpy as np
    >>> from uavlab.route import Route
    >>> route = Route([(5, 5, 30), (40, 5, 30), (40, 50, 30)])
    >>> route
    <Route by given: 80.0 m, 3 waypoints>
    >>> np.degrees(route.turn).round(1), route.distance
    (array([90.]), array([ 0., 35., 80.]))
    """

    points: np.ndarray
    planner: str = "given"
    reached: bool = True
    reason: str = ""
    cost: float = np.nan
    info: dict[str, Any] = field(default_factory=dict)
    takeoff: int = 0
    landing: int = 0
    min_clearance: float = 0.0
    min_height: float = 0.0
    max_height: float = np.inf
    safe_height: float = 0.0
    max_length: float = np.inf
    priced: str = ""

    def __post_init__(self) -> None:
        checks.set_fields(self, checks.number, "cost", "max_length", *PROMISES)
        check_promises(self)
        if not self.max_length > 0:
            raise ValueError(f"max_length must be above 0, got {self.max_length:g}")
        checks.instance("info", self.info, dict)
        object.__setattr__(self, "points", checks.array("points", self.points, None, 3).copy())
        checks.set_fields(self, checks.flag, "reached")
        checks.set_fields(self, checks.text, "planner", "reason", "priced")
        checks.set_fields(self, checks.whole, "takeoff", "landing", least=0)

    @classmethod
    def none(cls, planner: str, reason: str, **info: Any) -> Route:
        """The answer of a planner that found no way, and why.

        Parameters
        ----------
        planner : str
            Who looked for one.
        reason : str
            Why there is none.
        **info
            What the planner noted, see `info`.

        Returns
        -------
        Route
            Without points, `reached` False, of infinite cost.

        See Also
        --------
        Route.reached : What to ask a route first.

        Examples
        --------
        >>> from uavlab.route import Route
        >>> route = Route.none("A*", "no free way", expanded=12)
        >>> route, route.cost
        (<Route by A*: not reached, no free way>, inf)
        """
        return cls(np.empty((0, 3)), planner, reached=False, reason=reason, cost=np.inf, info=info)

    def __repr__(self) -> str:
        if not self.reached:
            return f"<Route by {self.planner}: not reached, {self.reason}>"
        return f"<Route by {self.planner}: {self.length:.1f} m, {len(self.points)} waypoints>"

    @property
    def en_route(self) -> Route:
        """The route between take-off and landing; what planners promise of heights and clearance holds there."""
        return replace(self, points=self.points[self.takeoff : len(self.points) - self.landing], takeoff=0, landing=0)

    @cached_property
    def leg_lengths(self) -> np.ndarray:
        """Length of each leg, (N − 1,) [m]."""
        return np.linalg.norm(np.diff(self.points, axis=0), axis=1)

    @property
    def length(self) -> float:
        """Length of the whole route [m]."""
        return float(np.cumsum(self.leg_lengths)[-1]) if len(self.points) > 1 else 0.0

    @property
    def distance(self) -> np.ndarray:
        """Distance flown at each waypoint, (N,) [m]."""
        return np.concatenate([[0.0], np.cumsum(self.leg_lengths)])[: len(self.points)]

    @property
    def pitch(self) -> np.ndarray:
        """Climb angle of each leg, (N − 1,) [rad]; positive upwards, ±π/2 for a vertical leg."""
        legs = np.diff(self.points, axis=0)
        return np.arctan2(legs[:, 2], np.hypot(legs[:, 0], legs[:, 1]))

    @property
    def turn(self) -> np.ndarray:
        """Change of heading at each inner waypoint, (N − 2,) [rad], 0 to π.

        A vertical leg has no heading of its own; it keeps the one of the leg before it.
        """
        legs = np.diff(self.points, axis=0)
        heading = np.arctan2(legs[:, 1], legs[:, 0])
        level = np.flatnonzero(np.hypot(legs[:, 0], legs[:, 1]) > 0)
        if len(level) == 0:
            return np.zeros(max(len(self.points) - 2, 0))
        last_level = np.maximum.accumulate(np.where(np.isin(np.arange(len(legs)), level), np.arange(len(legs)), -1))
        heading = heading[np.where(last_level < 0, level[0], last_level)]
        return np.abs((np.diff(heading) + np.pi) % (2 * np.pi) - np.pi)

    def clearance_profile(self, city: City) -> tuple[np.ndarray, np.ndarray]:
        """Distance to the nearest obstacle all along the route, every quarter of a voxel, and where it is least.

        Parameters
        ----------
        city : City

        Returns
        -------
        distance : (M,) array
            Distance flown [m], rising.
        clearance : (M,) array
            Exact distance to an obstacle's surface there [m]; 0 outside of the map. Its least is `Route.clearance`.

        Raises
        ------
        ValueError
            If `city` is no City.

        See Also
        --------
        Route.clearance : The least of it.
        uavlab.city.City.distance : Of any points.
        uavlab.plot.profile : Draws it.

        Examples
        --------
        >>> from uavlab.city import table1_city
        >>> from uavlab.route import Route
        >>> route = Route([(5, 5, 30), (40, 5, 30), (40, 50, 30)])
        >>> distance, clearance = route.clearance_profile(table1_city())
        >>> f"from {clearance.min():.1f} to {clearance.max():.1f} m"
        'from 5.0 to 11.2 m'
        """
        checks.instance("city", city, City)
        if len(self.points) == 0:
            return np.empty(0), np.empty(0)
        everywhere = float(np.linalg.norm(city.bounds[1] - city.bounds[0]))
        way = self.resample(city.cell / 4)
        clearance = np.where(city.inside(way.points), city.distance(way.points, everywhere), 0.0)
        least = self.clearance(city)
        if clearance.min() <= least:
            return way.distance, clearance

        def points_at(flown: np.ndarray) -> np.ndarray:
            return np.column_stack([np.interp(flown, self.distance, axis) for axis in self.points.T])

        _, length = city.voxels_along(self.points)
        leave = np.cumsum(length)
        stay = int(city.segment_distance(points_at(leave - length), points_at(leave)).argmin())
        within = np.linspace(leave[stay] - length[stay], leave[stay], 101)
        there = within[city.distance(points_at(within), everywhere).argmin()]
        place = np.searchsorted(way.distance, there)
        return np.insert(way.distance, place, there), np.insert(clearance, place, least)

    def clearance(self, city: City) -> float:
        """Least distance to an obstacle's surface on the whole way, exact, whatever the voxels that are passed.

        Parameters
        ----------
        city : City

        Returns
        -------
        float
            [m]; 0 where it leaves the map, NaN for a route without points.

        Raises
        ------
        ValueError
            If `city` is no City.

        See Also
        --------
        Route.clearance_profile : Along the way.
        uavlab.city.City.segment_distance : Of any straight lines.

        Examples
        --------
        >>> from uavlab.city import table1_city
        >>> from uavlab.route import Route
        >>> route = Route([(5, 5, 30), (40, 5, 30), (40, 50, 30)])
        >>> round(route.clearance(table1_city()), 2)
        5.0
        """
        checks.instance("city", city, City)
        if len(self.points) == 0:
            return float("nan")
        if not city.inside(self.points).all():
            return 0.0
        if isinstance(city, LazyCity):
            last = max(len(self.points) - 1, 1)
            return float(city.segment_distance(self.points[:last], self.points[-last:]).min())
        points = (self.points - city.origin) / city.cell
        return city.cell * float(least_clearance(city.runs, city.clearance, city.cell, points))

    def integral(self, city: City, values: np.ndarray) -> float:
        """∫ values ds along the route, by exact voxel traversal; the values hold for a whole voxel.

        Parameters
        ----------
        city : City
            Whose voxels the values belong to.
        values : (nx, ny, nz) array
            A price per metre gives the cost of the route, True in a zone the metres within it.

        Returns
        -------
        float
            In the unit of the values times metres.

        Raises
        ------
        ValueError
            If `city` is no City, `values` haven't its shape or aren't finite where the route passes, or the route
            leaves the map.

        See Also
        --------
        Route.voxels : The lengths by which the values are weighed.
        uavlab.risk.RiskMap.integral : Of risk.

        Examples
        --------
        >>> from uavlab.city import table1_city
        >>> from uavlab.route import Route
        >>> route = Route([(5, 5, 30), (40, 5, 30), (40, 50, 30)])
        >>> city = table1_city()
        >>> round(route.integral(city, city.clearance < 7.0), 1)  # metres nearer than 7 m to a building
        39.0
        """
        checks.instance("city", city, City)
        values = values if type(values) is np.ndarray else checks.numbers("values", values)
        if values.shape != city.shape:
            raise ValueError(f"values must have the city's shape {city.shape}, got {values.shape}")
        index, length = self.voxels(city)
        passed = checks.numbers("values", values[tuple(index.T)])
        checks.finite("values", passed)
        return float(passed @ length)

    def voxels(self, city: City) -> tuple[np.ndarray, np.ndarray]:
        """The voxels that the route passes through, in order, and its length in each.

        Parameters
        ----------
        city : City

        Returns
        -------
        index : (M, 3) int array
            i, j, k of each voxel.
        length : (M,) array
            [m]

        Raises
        ------
        ValueError
            If `city` is no City, or the route leaves the map.

        See Also
        --------
        Route.integral : Of values in the voxels.
        uavlab.city.City.voxels_along : Of any points.

        Examples
        --------
        >>> from uavlab.city import table1_city
        >>> from uavlab.route import Route
        >>> route = Route([(0.5, 0.5, 30.5), (2.5, 0.5, 30.5)])
        >>> index, length = route.voxels(table1_city())
        >>> index.tolist(), length.round(2)
        ([[0, 0, 30], [1, 0, 30], [2, 0, 30]], array([0.5, 1. , 0.5]))
        """
        checks.instance("city", city, City)
        if not city.inside(self.points).all():
            raise ValueError("the route leaves the map, about which nothing is known")
        return city.voxels_along(self.points)

    def resample(self, step: float) -> Route:
        """The same way with a waypoint at least every `step` metres; all waypoints stay.

        Parameters
        ----------
        step : float
            [m], above 0; typically half a voxel to some voxels.

        Returns
        -------
        Route
            With the same promises.

        Raises
        ------
        ValueError
            If `step` is not finite and above 0, or makes more than ten million waypoints.

        See Also
        --------
        uavlab.planners.shortcut : Leaves out waypoints instead.

        Examples
        --------
        >>> from uavlab.route import Route
        >>> route = Route([(5, 5, 30), (40, 5, 30), (40, 50, 30)])
        >>> route.resample(10.0)
        <Route by given: 80.0 m, 10 waypoints>
        """
        step = checks.positive_number("step", step)
        if self.length > MOST_WAYPOINTS * step:
            least = self.length / MOST_WAYPOINTS
            raise ValueError(f"step must be at least {least:.2g} m on {self.length:.0f} m of route, got {step:g}")
        if len(self.points) < 2:
            return self
        parts = np.maximum(np.ceil(self.leg_lengths / step - 1e-9).astype(int), 1)
        legs = [
            np.linspace(start, end, n, endpoint=False)
            for start, end, n in zip(self.points[:-1], self.points[1:], parts, strict=True)
        ]
        takeoff, landing = int(parts[: self.takeoff].sum()), int(parts[len(parts) - self.landing :].sum())
        return replace(self, points=np.vstack([*legs, self.points[-1:]]), takeoff=takeoff, landing=landing)

    def to_csv(self, path: str | Path) -> None:
        """Write waypoints and the distance flown to each, in metres: columns x_m, y_m, z_m, distance_m.

        Parameters
        ----------
        path : str or Path
            What is there is overwritten.

        Raises
        ------
        ValueError
            If `path` is no path (a number would be a file that is open already).

        See Also
        --------
        uavlab.scene.page : A page to look at.

        Examples
        --------
        >>> import tempfile
        >>> from pathlib import Path
        >>> from uavlab.route import Route
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     path = Path(folder) / "route.csv"
        ...     Route([(5, 5, 30), (40, 5, 30)]).to_csv(path)
        ...     print(path.read_text().rstrip())
        x_m,y_m,z_m,distance_m
        5.0,5.0,30.0,0.0
        40.0,5.0,30.0,35.0
        """
        with (
            written_whole(checks.path("path", path)) as part,
            part.open("w", newline="", encoding="utf-8") as file,
        ):
            writer = csv.writer(file)
            writer.writerow(["x_m", "y_m", "z_m", "distance_m"])
            writer.writerows(
                [repr(float(value)) for value in row] for row in np.column_stack([self.points, self.distance])
            )
