"""A curve and what can be measured on it: length, curvature, pitch, and how near it comes to the buildings."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.city import City
from uavlab.route import PROMISES, Route, check_promises, promises_of
from uavlab.spline.basis import checked_count, checked_derivative, with_ends
from uavlab.spline.sampling import (
    bends_at,
    curvature_vectors,
    points_at,
    sagittas,
    speed_in_turn,
    steps_on,
    tangents_of,
)

BANK = np.radians(30.0)
"""What a turn may take, as is usual for multirotors [rad]."""

MOST_POINTS = 10**7
"""At which a curve may be measured; more take all of the memory."""

CONTACT = 0.02
"""Share of its radius by which a body may overlap an obstacle before that is contact; half of it for the route."""


def contact_distance(diameter):
    """How far [m] the middle of a body is from what it touches."""
    return (1 - CONTACT) * diameter / 2


def curvature(velocity: npt.ArrayLike, acceleration: npt.ArrayLike) -> np.ndarray:
    """Curvature κ = |r′ × r″|/|r′|³ of a curve r(t): one over the radius of the circle that fits best there.

    Parameters
    ----------
    velocity, acceleration : (..., 3) or (..., 2) arrays
        First and second derivative by any parameter t. With east and north only: the curvature of the plan.

    Returns
    -------
    (...) array
        κ [1/m]; NaN where the curve stands still.

    Raises
    ------
    ValueError
        If `velocity` or `acceleration` is not finite, hasn't two or three components, or not as many as the other.

    See Also
    --------
    allowed_speed : How fast a turn may be flown.
    Curve : Measures it all along.

    Examples
    --------
    >>> from uavlab.spline import curvature
    >>> round(float(curvature((0, 5), (-5, 0))), 3)  # on a circle of 5 m, one radian per unit of t
    0.2
    """
    first, second = checks.vectors(velocity=velocity, acceleration=acceleration)
    shape = np.broadcast_shapes(first.shape, second.shape)
    ways = (np.ascontiguousarray(np.broadcast_to(each, shape)).reshape(-1, shape[-1]) for each in (first, second))
    return np.linalg.norm(curvature_vectors(*ways), axis=-1).reshape(shape[:-1])


def allowed_speed(curvature: npt.ArrayLike, bank: float = BANK) -> np.ndarray:
    """Greatest speed √(g·tan(bank)/κ) at which a bank angle holds a level turn.

    Parameters
    ----------
    curvature : float or array
        κ of the plan [1/m], at least 0; infinite at a corner.
    bank : float
        [rad], between 0 and π/2; 30° is usual for multirotors.

    Returns
    -------
    float or array
        [m/s]; infinite on a straight line.

    Raises
    ------
    ValueError
        If `curvature` is negative, or `bank` is not between 0 and π/2.

    See Also
    --------
    greatest_speed : Of a whole curve, with thrust, tilt and wind.
    curvature : From two derivatives.

    Examples
    --------
    >>> import numpy as np
    >>> from uavlab.spline import allowed_speed
    >>> radius = np.array([5, 20, 80])
    >>> allowed_speed(1 / radius).round(1)  # four times the radius, twice the speed
    array([ 5.3, 10.6, 21.3])
    """
    values = checks.numbers("curvature", curvature)
    checks.refuse(values, values >= 0, "curvature must be at least 0")
    bank = checked_bank(bank)
    with np.errstate(divide="ignore"):
        return speed_in_turn(values, bank)


def checked_bank(bank: float) -> float:
    return checks.number("bank", bank, checks.within, 1e-6, np.pi / 2 - 1e-6, "rad (from degrees: numpy.radians)")


def checked_step(step: float, control: np.ndarray) -> float:
    """The step of a curve with these control points; it is refused if it leaves too many points."""
    step = checks.positive_number("step", step)
    length = float(np.linalg.norm(np.diff(control, axis=0), axis=1).sum())
    if length > MOST_POINTS * step:
        raise ValueError(
            f"step must be at least {length / MOST_POINTS:.1g} m, or a curve of {length:.0f} m would have more than "
            f"{MOST_POINTS:,} points, got {step:g}"
        )
    return step


@dataclass(frozen=True, eq=False)
class Curve:
    """A cubic B-spline in 3D, and what can be measured on it.

    S_i(t) = [t³ t² t 1]·M·[P_i … P_i+3]ᵀ/6, 0 ≤ t ≤ 1, see `cubic_bspline`.

    Attributes
    ----------
    control : (N, 3) array
        Control points [m], N ≥ 2.
    ends : {"phantom", "clamped"}
        How it is held to its ends, see `cubic_bspline`.
    step : float
        At most so far apart [m] are the points at which it is measured.
    planner : str
        Whose route it smooths.
    info : dict
        What `smooth` noted.
    takeoff, landing : int
        How many of its first and last segments are vertical take-off and landing, between which and the rest it hovers.
    min_clearance, min_height, max_height, safe_height : float
        What it promises in between [m], see `Route`.

    Raises
    ------
    ValueError
        If `control` hasn't shape (N, 3), has fewer than two points or a value that is not finite. If `ends` is unknown.
        If `step` is not above 0, or so small that there would be more than ten million points. If `planner` is no text,
        or `info` no mapping. If `takeoff` or `landing` is negative, or both together leave no segment. If
        `min_clearance`, `min_height` or `safe_height` is negative or not finite. If `max_height` is not above
        `min_height`.

    See Also
    --------
    smooth : Makes one from a route, clear of the buildings.
    feasibility : Whether a UAV can fly it.
    cubic_bspline : Its points alone.

    Examples
    --------
    >>> from uavlab.spline import Curve
    >>> curve = Curve([(5, 5, 30), (40, 5, 30), (40, 50, 30)])
    >>> curve  # the corner is cut: the legs are 80 m long
    <Curve by curve: 69.7 m, 3 control points>
    >>> round(float(curve.curvature.max()), 3)
    0.069
    """

    control: np.ndarray
    ends: str = "phantom"
    step: float = 0.1
    planner: str = "curve"
    info: dict[str, Any] = field(default_factory=dict)
    takeoff: int = 0
    landing: int = 0
    min_clearance: float = 0.0
    min_height: float = 0.0
    max_height: float = np.inf
    safe_height: float = 0.0

    def __post_init__(self) -> None:
        checks.set_fields(self, checks.number, *PROMISES)
        check_promises(self)
        control = checks.numbers("control", self.control).copy()
        checks.set_fields(self, checks.one_of, "ends", known=("phantom", "clamped"))
        checked_count(control, self.ends)
        object.__setattr__(self, "control", checks.array("control", control, None, 3))
        object.__setattr__(self, "step", checked_step(self.step, control))
        checks.set_fields(self, checks.whole, "takeoff", "landing", least=0)
        if self.takeoff + self.landing > len(control) - 2:
            raise ValueError(
                f"takeoff and landing must leave a segment between {len(control)} control points, "
                f"got {self.takeoff} and {self.landing}"
            )
        checks.set_fields(self, checks.text, "planner")
        checks.set_fields(self, checks.by_name, "info", least=0)

    def __repr__(self) -> str:
        return f"<Curve by {self.planner}: {self.length:.1f} m, {len(self.control)} control points>"

    @property
    def en_route(self) -> Curve:
        """The curve between take-off and landing: what is promised of heights, clearance and turns holds there."""
        control = self.control[self.takeoff : len(self.control) - self.landing]
        return replace(self, control=control, takeoff=0, landing=0) if self.takeoff or self.landing else self

    @cached_property
    def parameter(self) -> np.ndarray:
        """Parameters (P,) of its points, from 0, one per segment, so near each other that no arc exceeds `step`.

        Its derivative is a mean of three legs of the polygon, so it never runs faster than the longest of them.
        """
        return steps_on(with_ends(self.control, self.ends), self.step)

    def at(self, parameter: npt.ArrayLike, derivative: int = 0) -> np.ndarray:
        """Points at parameters, or derivatives by the parameter there.

        Parameters
        ----------
        parameter : float or array (...)
            From 0 to the number of segments, one per segment.
        derivative : {0, 1, 2}
            By the parameter.

        Returns
        -------
        (..., 3) array
            [m]; derivatives per segment.

        Raises
        ------
        ValueError
            If `parameter` is below 0 or above the number of segments, or `derivative` is not 0, 1 or 2.

        See Also
        --------
        cubic_bspline : At even parameters.

        Examples
        --------
        >>> from uavlab.spline import Curve
        >>> curve = Curve([(5, 5, 30), (40, 5, 30), (40, 50, 30)])
        >>> curve.at([0, 1, 2]).round(1)
        array([[ 5. ,  5. , 30. ],
               [34.2, 12.5, 30. ],
               [40. , 50. , 30. ]])
        """
        padded = with_ends(self.control, self.ends)
        where = checks.numbers("parameter", parameter)
        derivative = checked_derivative(derivative)
        checks.within("parameter", where, 0.0, len(padded) - 3, "(segments)")
        return points_at(padded, where.ravel(), derivative).reshape(*where.shape, padded.shape[-1])

    @cached_property
    def points(self) -> np.ndarray:
        """(P, 3) [m], from the first control point to the last."""
        points = self.at(self.parameter)
        points[[0, -1]] = self.control[[0, -1]]
        return points

    @cached_property
    def distance(self) -> np.ndarray:
        """Distance flown to each point, (P,) [m]."""
        return self.route().distance

    @property
    def length(self) -> float:
        """[m]"""
        return float(self.distance[-1])

    @cached_property
    def velocity(self) -> np.ndarray:
        """First derivative by the parameter at each point, (P, 3) [m]."""
        return self.at(self.parameter, 1)

    @cached_property
    def acceleration(self) -> np.ndarray:
        """Second derivative by the parameter at each point, (P, 3) [m]."""
        return self.at(self.parameter, 2)

    @cached_property
    def tangent(self) -> np.ndarray:
        """Unit vectors along the curve at each point, (P, 3); where it stands still, as it goes on from there."""
        return tangents_of(self.velocity)

    @cached_property
    def bend(self) -> np.ndarray:
        """Curvature vectors at each point, (P, 3) [1/m]: towards the inside of the turn, κ long; infinite at a corner.

        A corner is where the curve stands still and goes on in another direction, as at a point that stands three
        times. A turn that is too tight for `step` to resolve counts as even between the two points.
        """
        return bends_at(self.points, self.velocity, self.acceleration)

    @cached_property
    def curvature(self) -> np.ndarray:
        """κ at each point, (P,) [1/m]."""
        return np.linalg.norm(self.bend, axis=1)

    @property
    def level_curvature(self) -> np.ndarray:
        """Level part of the curvature vector at each point, (P,) [1/m]: what a bank angle has to hold."""
        return np.hypot(self.bend[:, 0], self.bend[:, 1])

    @cached_property
    def pitch(self) -> np.ndarray:
        """Climb angle at each point, (P,) [rad]."""
        return np.arctan2(self.tangent[:, 2], np.hypot(self.tangent[:, 0], self.tangent[:, 1]))

    @cached_property
    def rise(self) -> np.ndarray:
        """How far above or below the straight lines between its points the curve can be, (P − 1,) [m]."""
        second = np.abs(self.acceleration[:, 2])
        return np.maximum(second[:-1], second[1:]) * np.diff(self.parameter) ** 2 / 8

    @cached_property
    def sagitta(self) -> np.ndarray:
        """How far the curve can be from the straight lines between its points, (P − 1,) [m]: max|r″|·Δt²/8.

        Where it runs along a line without turning back only the part of r″ across the line counts.
        """
        return sagittas(self.points, self.velocity, self.acceleration, self.parameter)

    def least_distances(self, city: City, at_most: float = np.inf) -> np.ndarray:
        """A lower bound of the distance to the obstacles between each two of its points.

        That of the straight line, less the sagitta.

        Parameters
        ----------
        city : City
        at_most : float
            Where the line is farther away than this [m], this counts instead, and is found sooner.

        Returns
        -------
        (P − 1,) array
            [m], at least 0; infinite in a city without obstacles.

        Raises
        ------
        ValueError
            If `city` is no City, or `at_most` is no number or negative.

        See Also
        --------
        Curve.clearance : The least of them.

        Examples
        --------
        >>> from uavlab.city import table1_city
        >>> from uavlab.spline import Curve
        >>> curve = Curve([(5, 5, 30), (40, 5, 30), (40, 50, 30)])
        >>> distances = curve.least_distances(table1_city(), at_most=10)
        >>> len(distances) == len(curve.points) - 1, round(float(distances.max()), 1)
        (True, 10.0)
        """
        checks.instance("city", city, City)
        at_most = checks.number("at_most", at_most)
        straight = city.segment_distance(self.points[:-1], self.points[1:], at_most=at_most)
        return np.maximum(straight - self.sagitta, 0.0)

    def clearance(self, city: City) -> float:
        """A lower bound of its least distance to the obstacles, too low by the sagitta, about κ·step²/8.

        Parameters
        ----------
        city : City

        Returns
        -------
        float
            [m]; 0 if it may touch one, infinite in a city without obstacles.

        Raises
        ------
        ValueError
            If `city` is no City.

        See Also
        --------
        Curve.least_distances : All along.
        uavlab.route.Route.clearance : Of straight legs, exactly.

        Examples
        --------
        >>> from uavlab.city import table1_city
        >>> from uavlab.spline import Curve
        >>> curve = Curve([(5, 5, 30), (40, 5, 30), (40, 50, 30)])
        >>> round(curve.clearance(table1_city()), 1)
        0.7
        """
        return float(self.least_distances(city).min())

    def route(self, step: float | None = None) -> Route:
        """The curve as straight lines, with the same promises.

        Parameters
        ----------
        step : float, optional
            At most so long are they [m], above 0; by default the curve's own. Longer ones draw faster.

        Returns
        -------
        Route

        Raises
        ------
        ValueError
            If `step` is not above 0.

        See Also
        --------
        uavlab.route.as_route : Of a route or a curve.

        Examples
        --------
        >>> from uavlab.spline import Curve
        >>> curve = Curve([(5, 5, 30), (40, 5, 30), (40, 50, 30)])
        >>> curve.route(step=5.0)
        <Route by curve: 69.7 m, 19 waypoints>
        """
        points = (self if step is None else replace(self, step=step)).points
        return Route(points, self.planner, **promises_of(self))
