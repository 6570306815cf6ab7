"""Whether a UAV can fly a curve: each limit, the worst value and where it is.

The papers call a curve flyable when its curvature is below 1 per coding unit and its pitch below π/3. But a curvature
says nothing without a speed: on a circle of 5 m a UAV at 16 m/s accelerates sideways with v²κ = 51 m/s², 5.2 g. What
counts is the thrust that holds weight, wind and the turn together, and how far the UAV must tilt for it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.city import City
from uavlab.city.bounds import slack_of
from uavlab.city.extent import checked_heights
from uavlab.route import promises_of
from uavlab.spline.curve import BANK, Curve, checked_bank, contact_distance, curvature
from uavlab.vehicle import GRAVITY, UAV
from uavlab.weather import wind_drag

MAX_PITCH = np.pi / 3
"""θ_max of RISK-ACO; PSO-BAS asks for π/4."""

MAX_TURN = np.pi / 3
"""Δψ_max of RISK-ACO, over a voxel's length; PSO-BAS leaves it open."""

LEVEL = 0.1
"""Of the direction: where less of it is level, as in a steep climb, there is no heading."""

OUTSIDE = 1e-3
"""Who is so far from a no-fly zone is outside of it [m]."""

LEAST_SPEED, TRIED = 0.001, 65
"""`greatest_speed` tells a millimetre per second, and looks at so many speeds first."""


@dataclass(frozen=True)
class Limit:
    """One limit and how a curve keeps it.

    Attributes
    ----------
    name, unit : str
    limit, worst : float
        In the unit; the worst is the value nearest to the limit, or farthest beyond it.
    at_least : bool
        Whether the limit is a lower one.
    distance : float
        Where it is worst, distance flown [m].
    place : tuple of float
        And in space [m].

    See Also
    --------
    feasibility : Finds them.

    Examples
    --------
    >>> from uavlab.city import table1_city
    >>> from uavlab.spline import Curve, feasibility
    >>> from uavlab.vehicle import LIGHT_QUADROTOR
    >>> curve = Curve([(5, 5, 30), (40, 5, 30), (40, 50, 30)])
    >>> report = feasibility(curve, table1_city(), LIGHT_QUADROTOR, speed=12.0)
    >>> report["curvature"]
    <Limit curvature: 0.0686 1/m, at most 0.0393, NOT met>
    >>> report["clearance"].met
    True
    """

    name: str
    unit: str
    limit: float
    worst: float
    at_least: bool
    distance: float
    place: tuple[float, ...]

    @property
    def met(self) -> bool:
        """Whether it is kept, to rounding."""
        slack = 1e-9 * abs(self.limit)
        return self.worst >= self.limit - slack if self.at_least else self.worst <= self.limit + slack

    def __repr__(self) -> str:
        bound = f"at {'least' if self.at_least else 'most'} {self.limit:.3g}"
        return f"<Limit {self.name}: {self.worst:.3g} {self.unit}, {bound}, {'met' if self.met else 'NOT met'}>"


@dataclass(frozen=True, repr=False)
class Feasibility:
    """What `feasibility` found.

    Attributes
    ----------
    limits : tuple of Limit
    speed : float
        For which it holds [m/s].

    See Also
    --------
    feasibility : Finds it.
    Limit : One of its limits.

    Examples
    --------
    >>> from uavlab.city import table1_city
    >>> from uavlab.spline import Curve, feasibility
    >>> from uavlab.vehicle import LIGHT_QUADROTOR
    >>> curve = Curve([(5, 5, 30), (40, 5, 30), (40, 50, 30)])
    >>> report = feasibility(curve, table1_city(), LIGHT_QUADROTOR, speed=12.0)
    >>> report.feasible
    False
    >>> [limit.name for limit in report.limits if not limit.met]
    ['curvature']
    """

    limits: tuple[Limit, ...]
    speed: float

    @property
    def feasible(self) -> bool:
        """Whether all limits are met."""
        return all(limit.met for limit in self.limits)

    def __getitem__(self, name: str) -> Limit:
        """The limit with a name."""
        return {limit.name: limit for limit in self.limits}[checks.one_of("name", name, [x.name for x in self.limits])]

    def rows(self) -> list[tuple[str, ...]]:
        """Rows of its table, text only: limit, what it asks for, worst value, where, verdict."""
        return [
            (
                limit.name,
                f"{'>=' if limit.at_least else '<='} {limit.limit:.3g} {limit.unit}",
                f"{limit.worst:.3g} {limit.unit}",
                f"{limit.distance:.1f} m, {checks.show(np.round(limit.place, 1) + 0.0)}",
                "yes" if limit.met else "NO",
            )
            for limit in self.limits
        ]

    def __str__(self) -> str:
        table = [("limit", f"at {self.speed:.3g} m/s", "worst", "after, at", "met"), *self.rows()]
        widths = [max(map(len, column)) for column in zip(*table, strict=True)]
        return "\n".join("  ".join(map(str.ljust, row, widths)).rstrip() for row in table)

    __repr__ = __str__

    def _repr_html_(self) -> str:
        heads = "".join(
            f"<th>{head}</th>" for head in ("limit", f"at {self.speed:.3g} m/s", "worst", "after, at", "met")
        )
        signs = str.maketrans({">": "≥", "<": "≤", "=": ""})  # which not every terminal can print
        rows = "".join(
            "<tr>" + "".join(f"<td>{cell.translate(signs)}</td>" for cell in row) + "</tr>" for row in self.rows()
        )
        return f"<table><tr>{heads}</tr>{rows}</table>"


def feasibility(
    curve: Curve,
    city: City,
    uav: UAV,
    *,
    speed: float | None = None,
    wind: npt.ArrayLike = (0.0, 0.0, 0.0),
    bank: float = BANK,
    max_pitch: float = MAX_PITCH,
    max_turn: float | None = None,
    min_clearance: float | None = None,
    min_height: float | None = None,
    max_height: float | None = None,
    safe_height: float | None = None,
    as_printed: bool = False,
    reading: str = "plan",
) -> Feasibility:
    """Check a curve against what a UAV can do, at a constant speed over ground; but for take-off and landing.

    Whatever is measured between the curve's points is bounded, not sampled.

    Bank, with the level part of the curvature: κ ≤ g·tan(bank)/v². Thrust: |T| ≤ T_max, see `tilted_thrust`.

    Parameters
    ----------
    curve : Curve
    city : City
    uav : UAV
    speed : float, optional
        v [m/s], above 0; by default the UAV's cruise speed.
    wind : (2,) or (3,) array
        Mean wind, where the air moves to [m/s].
    bank : float
        Bank angle that turns may take [rad], between 0 and π/2; limits the level curvature to g·tan(bank)/v².
    max_pitch : float
        Steepest climb or descent [rad], above 0, at most π/2.
    max_turn : float, optional
        Greatest change of heading over a voxel's length [rad], above 0, at most π (PSO-BAS Eq. 9); by default none, as
        the curvature's limit knows the speed; with `as_printed` π/3, RISK-ACO's.
    min_clearance : float, optional
        Least distance to obstacles [m]; by default what the curve promises, at least half the body, less the 2 % of
        contact that `smooth` allows.
    min_height, max_height : float, optional
        Least and greatest height above ground [m]; by default what the curve promises.
    safe_height : float, optional
        H_safe, least height above roofs and ground below [m] (PSO-BAS Eq. 11); by default what the curve promises.
    as_printed : bool
        RISK-ACO's and PSO-BAS's own check: curvature below 1 per voxel, heading and pitch within their limits. It
        knows neither the speed nor the city.
    reading : {"plan", "space"}
        Of the printed curvature: in plan, as turns have a limit of their own "in the horizontal direction", or of the
        track in space.

    Returns
    -------
    Feasibility
        "clearance", "map" (how far inside of it) and "height" above ground [m], "curvature" (its level part, which the
        bank limits) [1/m], "pitch" [°], "thrust" [N] and "tilt" [°] that hold weight, wind and turn, "air speed" [m/s];
        where they are limited also "height at most", "height above roofs" and "distance to no-fly zones" [m], "heading
        change" [° per voxel], "climb rate" and "sink rate" [m/s].

    Raises
    ------
    ValueError
        If `curve`, `city` or `uav` is of another kind. If `speed` is not above 0. If `wind` is not two or three finite
        numbers. If `bank` is not between 0 and π/2. If `max_pitch` is not above 0 and at most π/2, or `max_turn` not
        above 0 and at most π. If `min_clearance`, `min_height` or `safe_height` is negative. If `max_height` is not
        above `min_height`. If `reading` is unknown.

    See Also
    --------
    greatest_speed : The fastest at which bank, thrust, tilt and air speed are in limits.
    smooth : Makes the curve from a route.
    tilted_thrust : What the turn and the wind ask for.

    Examples
    --------
    >>> from uavlab.city import table1_city
    >>> from uavlab.spline import Curve, feasibility
    >>> from uavlab.vehicle import LIGHT_QUADROTOR
    >>> curve = Curve([(5, 5, 30), (40, 5, 30), (40, 50, 30)])
    >>> feasibility(curve, table1_city(), LIGHT_QUADROTOR, speed=5.0).feasible
    True
    >>> fast = feasibility(curve, table1_city(), LIGHT_QUADROTOR, speed=12.0)
    >>> fast["curvature"]  # at 12 m/s a bank of 30° holds turns of 25 m radius, not of 15 m
    <Limit curvature: 0.0686 1/m, at most 0.0393, NOT met>
    """
    checks.instance("curve", curve, Curve)
    checks.instance("uav", uav, UAV)
    checks.instance("city", city, City)
    speed = checks.positive_number("speed", uav.cruise_speed if speed is None else speed)
    wind, bank = checks.three("wind", wind), checked_bank(bank)
    max_pitch = checked_angle("max_pitch", max_pitch, np.pi / 2)
    checks.one_of("reading", reading, ("plan", "space"))
    whole, curve = curve, curve.en_route
    heights = heights_kept(curve, min_height, max_height, safe_height)
    least = max(contact_distance(uav.diameter), curve.min_clearance - slack_of(city) * city.cell)
    least = checks.not_negative_number("min_clearance", least if min_clearance is None else min_clearance)
    begins = float(whole.distance[np.searchsorted(whole.parameter, whole.takeoff)])
    if checks.flag("as_printed", as_printed) and max_turn is None:
        max_turn = MAX_TURN
    turned = limits_of_turn(curve, city, max_turn)
    steepest = upper(curve, "pitch", "°", np.degrees(max_pitch), np.degrees(np.abs(curve.pitch)))
    if as_printed:
        bends = plan_curvature(curve) if reading == "plan" else curve.curvature
        per_voxel = upper(curve, f"curvature in {reading}", "per voxel", 1.0, bends * city.cell)
        return feasibility_after(begins, (per_voxel, *turned, steepest), speed)
    sharpest = GRAVITY * np.tan(bank) / speed**2
    thrust, tilt = tilted_thrust(curve, uav, speed, wind)
    air_speed = np.linalg.norm(speed * curve.tangent - wind, axis=1)
    return feasibility_after(
        begins,
        (
            lower(curve, "clearance", "m", least, curve.least_distances(city)),
            *limits_of_place(curve, city, *heights),
            upper(curve, "curvature", "1/m", sharpest, curve.level_curvature),
            *turned,
            steepest,
            upper(curve, "thrust", "N", uav.thrust, thrust),
            upper(curve, "tilt", "°", np.degrees(uav.max_tilt), np.degrees(tilt)),
            upper(curve, "air speed", "m/s", uav.top_speed, air_speed),
            *limits_of_climb(curve, uav, speed),
        ),
        speed,
    )


def checked_angle(name: str, angle: float, most: float) -> float:
    """A limit on an angle [rad], above 0."""
    angle = checks.positive_number(name, angle)
    checks.within(name, angle, 0.0, most, "rad (from degrees: numpy.radians)")
    return angle


def heights_kept(
    curve: Curve, min_height: float | None, max_height: float | None, safe_height: float | None
) -> tuple[float, float, float]:
    """`min_height`, `max_height` and `safe_height`, by default what the curve promises."""
    asked = promises_of(curve, min_height=min_height, max_height=max_height, safe_height=safe_height)
    heights = checked_heights(asked["min_height"], asked["max_height"])
    return *heights, checks.not_negative_number("safe_height", asked["safe_height"])


def limits_of_place(
    curve: Curve, city: City, min_height: float, max_height: float, safe_height: float
) -> tuple[Limit, ...]:
    """The map's box, heights above ground and roofs, no-fly zones: where a UAV may be."""
    fine = curve if curve.step <= city.cell else replace(curve, step=city.cell)
    low, high = city.bounds
    ends = np.minimum(fine.points - low, high - fine.points).min(axis=1)
    inside = np.minimum(ends[:-1], ends[1:]) - fine.sagitta
    lowest, highest = city.range_of_ground
    limits = [
        lower(fine, "map", "m", 0.0, inside),
        lower(fine, "height", "m", min_height, heights_over(fine, city, highest[..., None])),
    ]
    if max_height < np.inf:
        above = -heights_over(fine, city, lowest[..., None], highest=True)
        limits.append(upper(fine, "height at most", "m", max_height, np.append(above, above[-1])))
    if safe_height > 0:
        limits.append(lower(fine, "height above roofs", "m", safe_height, heights_over(fine, city, city.surface_below)))
    if city.no_fly:
        zones = City(city.in_no_fly, city.cell, city.origin)
        limits.append(lower(fine, "distance to no-fly zones", "m", OUTSIDE, fine.least_distances(zones)))
    return tuple(limits)


def limits_of_turn(curve: Curve, city: City, max_turn: float | None) -> tuple[Limit, ...]:
    """Of the heading over a voxel's length, if there is one."""
    if max_turn is None:
        return ()
    max_turn = checked_angle("max_turn", max_turn, np.pi)
    return (upper(curve, "heading change", "° per voxel", np.degrees(max_turn), heading_change(curve, city.cell)),)


def limits_of_climb(curve: Curve, uav: UAV, speed: float) -> tuple[Limit, ...]:
    """Vertical speeds, where the UAV has limits for them."""
    climb = speed * curve.tangent[:, 2]
    rates = (("climb rate", uav.climb_speed, climb), ("sink rate", uav.sink_speed, -climb))
    return tuple(upper(curve, name, "m/s", most, rate) for name, most, rate in rates if most < np.inf)


def heights_over(curve: Curve, city: City, surface: np.ndarray, *, highest: bool = False) -> np.ndarray:
    """Least height of a curve above a surface (nx, ny, 1 or nz) [m] between each two of its points, (P − 1,) [m].

    Over all columns that it may touch in between, however it bends; steps must not be longer than a voxel. With
    `highest` how far it is below the surface at the least.
    """
    one, other, side = curve.points[:-1], curve.points[1:], curve.sagitta[:, None]
    west, east = np.minimum(one, other)[:, :2] - side, np.maximum(one, other)[:, :2] + side
    z = np.maximum(one, other)[:, 2] + curve.rise if highest else np.minimum(one, other)[:, 2] - curve.rise
    room = np.full(len(z), np.inf)
    for x in (west[:, 0], east[:, 0]):
        for y in (west[:, 1], east[:, 1]):
            index = ((np.stack([x, y, z], axis=1) - city.origin) // city.cell).astype(int)
            i, j, k = np.clip(index, 0, np.array(surface.shape) - 1).T
            room = np.minimum(room, surface[i, j, k] - z if highest else z - surface[i, j, k])
    return room


def heading_change(curve: Curve, cell: float) -> np.ndarray:
    """By how much the heading turns over the next `cell` metres, (P,) [°]; it has none where it is nearly vertical."""
    east, north = curve.tangent[:, 0], curve.tangent[:, 1]
    level = np.flatnonzero(np.hypot(east, north) > LEVEL)
    turned = np.zeros(len(east))
    if len(level) > 1:
        heading = np.unwrap(np.arctan2(north[level], east[level]))
        distance = curve.distance[level]
        there = np.interp(distance + cell, distance, heading)
        last = np.searchsorted(distance, distance + cell, side="right")
        turned[level] = [np.ptp([*heading[n : last[n]], there[n]]) for n in range(len(level))]
    return np.degrees(turned)


def plan_curvature(curve: Curve) -> np.ndarray:
    """Curvature of the curve's plan, (P,) [1/m]; infinite at a corner, 0 where it is vertical."""
    sharp = np.isinf(curve.bend).any(axis=1)
    bend = np.where(sharp[:, None], 0.0, curve.bend)
    return np.where(sharp, np.inf, np.nan_to_num(curvature(curve.tangent[:, :2], bend[:, :2])))


def feasibility_after(begins: float, limits: tuple[Limit, ...], speed: float) -> Feasibility:
    """The limits of a part of a curve, which begins after so many metres of take-off."""
    return Feasibility(tuple(replace(limit, distance=begins + limit.distance) for limit in limits), speed)


def upper(curve: Curve, name: str, unit: str, limit: float, values: np.ndarray) -> Limit:
    """An upper limit and where the values (P,) at the curve's points are worst."""
    worst = float(values.max()) + 0.0  # −0 is 0
    slack = 1e-9 * abs(worst) if np.isfinite(worst) else 0.0
    first = int(np.flatnonzero(values >= worst - slack)[0])  # of equals, whatever the rounding
    return Limit(name, unit, float(limit), worst, False, *whereabouts(curve, first))


def lower(curve: Curve, name: str, unit: str, limit: float, values: np.ndarray) -> Limit:
    """A lower limit and where the values (P − 1,) between the curve's points are worst."""
    least = float(values.min()) + 0.0
    slack = 1e-9 * abs(least) if np.isfinite(least) else 0.0
    nearest = int(np.flatnonzero(values <= least + slack)[0])
    return Limit(name, unit, float(limit), least, True, *whereabouts(curve, nearest))


def whereabouts(curve: Curve, number: int) -> tuple[float, tuple[float, ...]]:
    return float(curve.distance[number]), tuple(curve.points[number].tolist())


def tilted_thrust(
    curve: Curve, uav: UAV, speed: float, wind: npt.ArrayLike = (0.0, 0.0, 0.0)
) -> tuple[np.ndarray, np.ndarray]:
    """Thrust and tilt that hold a UAV on a curve at a constant speed.

    T = m (v² κ n + g ẑ) − F_drag, and the tilt is the angle between T and ẑ.

    Parameters
    ----------
    curve : Curve
    uav : UAV
    speed : float
        v over ground [m/s], above 0.
    wind : (2,) or (3,) array
        Mean wind [m/s].

    Returns
    -------
    thrust : (P,) array
        |T| [N] at the curve's points; infinite at a corner.
    tilt : (P,) array
        Angle between T and the vertical [rad].

    Raises
    ------
    ValueError
        If `curve` or `uav` is of another kind, `speed` is not above 0, or `wind` is not two or three finite numbers.

    See Also
    --------
    feasibility : Whether the UAV has both.
    uavlab.weather.wind_drag : F_drag.

    Examples
    --------
    >>> import numpy as np
    >>> from uavlab.spline import Curve, tilted_thrust
    >>> from uavlab.vehicle import LIGHT_QUADROTOR
    >>> curve = Curve([(5, 5, 30), (40, 5, 30), (40, 50, 30)])
    >>> thrust, tilt = tilted_thrust(curve, LIGHT_QUADROTOR, speed=6.0)
    >>> f"{thrust.max():.1f} N, {np.degrees(tilt.max()):.0f}°; weight {LIGHT_QUADROTOR.weight:.1f} N"
    '15.2 N, 15°; weight 14.7 N'
    """
    checks.instance("curve", curve, Curve)
    checks.instance("uav", uav, UAV)
    speed = checks.positive_number("speed", speed)
    drag = wind_drag(checks.three("wind", wind), speed * curve.tangent, uav.drag_area)
    force = uav.weight / GRAVITY * speed**2 * curve.bend - drag + [0.0, 0.0, uav.weight]
    tilt = np.arctan2(np.hypot(force[:, 0], force[:, 1]), force[:, 2])
    return np.linalg.norm(force, axis=1), np.where(np.isnan(tilt), np.pi, tilt)


def greatest_speed(curve: Curve, uav: UAV, wind: npt.ArrayLike = (0.0, 0.0, 0.0), *, bank: float = BANK) -> float:
    """The greatest constant speed over ground at which bank, thrust, tilt, air and vertical speed are in limits.

    The greatest v with v² ≤ g·tan(bank)/κ that leaves |T|, tilt, |v t − wind| and v t_z within the UAV's limits, with t
    the tangent. See `tilted_thrust` for T.

    In a strong tail wind a UAV may have to be fast: the speeds that work needn't begin at 0. Of ranges of speeds that
    work only one narrower than a 64th of what air speed and bank allow may be overlooked.

    Parameters
    ----------
    curve : Curve
        What counts is the part between take-off and landing.
    uav : UAV
    wind : (2,) or (3,) array
        Mean wind, where the air moves to [m/s].
    bank : float
        Bank angle that turns may take [rad], between 0 and π/2.

    Returns
    -------
    float
        [m/s], to a millimetre per second; 0 when there is none, as at a corner.

    Raises
    ------
    ValueError
        If `curve` or `uav` is of another kind, `wind` is not two or three finite numbers, or `bank` is not between 0
        and π/2.

    See Also
    --------
    allowed_speed : By the bank angle alone.
    feasibility : Each limit at one speed.

    Examples
    --------
    >>> from uavlab.spline import Curve, greatest_speed
    >>> from uavlab.vehicle import LIGHT_QUADROTOR
    >>> curve = Curve([(5, 5, 30), (40, 5, 30), (40, 50, 30)])
    >>> round(greatest_speed(curve, LIGHT_QUADROTOR), 1)
    9.1
    >>> round(greatest_speed(curve, LIGHT_QUADROTOR, wind=(-15, 0)), 1)  # 18 m/s through the air
    3.0
    """
    checks.instance("curve", curve, Curve)
    checks.instance("uav", uav, UAV)
    curve, wind = curve.en_route, np.array(checks.three("wind", wind))
    bank = checked_bank(bank)
    along = curve.tangent @ wind
    across = np.maximum((wind**2).sum() - along**2, 0.0)
    if (across > uav.top_speed**2).any():
        return 0.0
    either_way = np.sqrt(uav.top_speed**2 - across)
    sharpest = curve.level_curvature.max()
    banked = np.sqrt(GRAVITY * np.tan(bank) / sharpest) if sharpest > 0 else np.inf
    vertical = [
        most / steepest
        for most, steepest in (
            (uav.climb_speed, curve.tangent[:, 2].max()),
            (uav.sink_speed, -curve.tangent[:, 2].min()),
        )
        if steepest > 0
    ]
    slowest, fastest = max((along - either_way).max(), LEAST_SPEED), min((along + either_way).min(), banked, *vertical)
    if not fastest >= slowest:
        return 0.0

    def flyable(speed: float) -> bool:
        thrust, tilt = tilted_thrust(curve, uav, speed, wind)
        return bool(thrust.max() <= uav.thrust and tilt.max() <= uav.max_tilt)

    tried = np.linspace(fastest, slowest, TRIED)
    works = next((number for number, speed in enumerate(tried) if flyable(speed)), None)
    if works is None:
        return 0.0
    low, high = tried[works], tried[max(works - 1, 0)]
    while high - low > LEAST_SPEED / 2:
        middle = (low + high) / 2
        low, high = (middle, high) if flyable(middle) else (low, middle)
    return float(low)
