"""Whether a UAV can fly a curve: each limit, the worst value and where it is.

The papers call a curve flyable when its curvature is below 1 per coding unit and its pitch below π/3. But a curvature
says nothing without a speed: on a circle of 5 m a UAV at 16 m/s needs five times its weight. What counts is the thrust
that holds weight, wind and the turn together, and how far the UAV must tilt for it.
"""

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.city import City
from uavlab.spline.curve import BANK, CONTACT, Curve, checked_bank
from uavlab.vehicle import GRAVITY, UAV
from uavlab.weather import wind_drag

MAX_PITCH = np.pi / 3
"""θ_max of RISK-ACO; PSO-BAS asks for π/4."""

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
        return self.worst >= self.limit if self.at_least else self.worst <= self.limit


@dataclass(frozen=True, repr=False)
class Feasibility:
    """What `feasibility` found.

    Attributes
    ----------
    limits : tuple of Limit
    speed : float
        For which it holds [m/s].
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
        """Of its table: limit, worst value, where, verdict."""
        return [
            (
                limit.name,
                f"{'≥' if limit.at_least else '≤'} {limit.limit:.3g} {limit.unit}",
                f"{limit.worst:.3g} {limit.unit}",
                f"{limit.distance:.1f} m, {checks.show(np.round(limit.place, 1))}",
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
        rows = "".join("<tr>" + "".join(f"<td>{cell}</td>" for cell in row) + "</tr>" for row in self.rows())
        return f"<table><tr>{heads}</tr>{rows}</table>"


def feasibility(
    curve: Curve,
    uav: UAV,
    city: City,
    *,
    speed: float | None = None,
    wind: npt.ArrayLike = (0.0, 0.0, 0.0),
    bank: float = BANK,
    max_pitch: float = MAX_PITCH,
    min_clearance: float | None = None,
    as_printed: bool = False,
) -> Feasibility:
    """Check a curve against what a UAV can do, at a constant speed over ground; but for take-off and landing.

    Parameters
    ----------
    curve : Curve
    uav : UAV
    city : City
    speed : float, optional
        v [m/s], above 0; by default the UAV's cruise speed.
    wind : (2,) or (3,) array
        Mean wind, where the air moves to [m/s].
    bank : float
        Bank angle that turns may take [rad], between 0 and π/2; limits the level curvature to g·tan(bank)/v².
    max_pitch : float
        Steepest climb or descent [rad], above 0, at most π/2.
    min_clearance : float, optional
        Least distance to obstacles [m]; by default half the body, less the 2 % of contact that `smooth` allows.
    as_printed : bool
        RISK-ACO's and PSO-BAS's own check: curvature below 1 per voxel, pitch within `max_pitch`. It doesn't know the
        speed.

    Returns
    -------
    Feasibility
        "clearance" [m], "curvature" [1/m], "pitch" [°], "thrust" [N] and "tilt" [°] that hold weight, wind and turn,
        "air speed" [m/s].

    Raises
    ------
    ValueError
        If an argument is out of its range.
    """
    checks.instance("curve", curve, Curve)
    checks.instance("uav", uav, UAV)
    checks.instance("city", city, City)
    whole, curve = curve, curve.en_route
    begins = float(whole.distance[np.searchsorted(whole.parameter, whole.takeoff)])
    speed = uav.cruise_speed if speed is None else speed
    checks.positive_number("speed", speed)
    pitch = np.degrees(np.abs(curve.pitch))
    checks.positive_number("max_pitch", max_pitch)
    checks.within("max_pitch", max_pitch, 0.0, np.pi / 2, "rad (from degrees: numpy.radians)")
    steepest = upper(curve, "pitch", "°", np.degrees(max_pitch), pitch)
    if as_printed:
        per_voxel = upper(curve, "curvature", "per voxel", 1.0, curve.curvature * city.cell)
        return feasibility_after(begins, (per_voxel, steepest), speed)
    sharpest = GRAVITY * np.tan(checked_bank(bank)) / speed**2
    thrust, tilt = tilted_thrust(curve, uav, speed, wind)
    air_speed = np.linalg.norm(speed * curve.tangent - checks.three("wind", wind), axis=1)
    body = (1 - CONTACT) * uav.diameter / 2 if min_clearance is None else min_clearance
    checks.not_negative_number("min_clearance", body)
    distances = curve.least_distances(city)
    least = float(distances.min())
    nearest = int(np.flatnonzero(distances <= (1 + 1e-9) * least)[0])
    return feasibility_after(
        begins,
        (
            Limit("clearance", "m", body, least, True, *whereabouts(curve, nearest)),
            upper(curve, "curvature", "1/m", sharpest, curve.level_curvature),
            steepest,
            upper(curve, "thrust", "N", uav.thrust, thrust),
            upper(curve, "tilt", "°", np.degrees(uav.max_tilt), np.degrees(tilt)),
            upper(curve, "air speed", "m/s", uav.top_speed, air_speed),
        ),
        float(speed),
    )


def feasibility_after(begins: float, limits: tuple[Limit, ...], speed: float) -> Feasibility:
    """The limits of a part of a curve, which begins after so many metres of take-off."""
    return Feasibility(tuple(replace(limit, distance=begins + limit.distance) for limit in limits), speed)


def upper(curve: Curve, name: str, unit: str, limit: float, values: np.ndarray) -> Limit:
    """An upper limit and where the values (P,) at the curve's points are worst."""
    worst = float(values.max())
    first = int(np.flatnonzero(values >= (1 - 1e-9) * worst)[0])  # of equals, whatever the rounding
    return Limit(name, unit, float(limit), worst, False, *whereabouts(curve, first))


def whereabouts(curve: Curve, number: int) -> tuple[float, tuple[float, ...]]:
    return float(curve.distance[number]), tuple(curve.points[number].tolist())


def tilted_thrust(
    curve: Curve, uav: UAV, speed: float, wind: npt.ArrayLike = (0.0, 0.0, 0.0)
) -> tuple[np.ndarray, np.ndarray]:
    """Thrust and tilt that hold a UAV on a curve at a constant speed.

    T = m (v² κ n + g ẑ) − F_drag

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
    """
    checks.positive_number("speed", speed)
    drag = wind_drag(checks.three("wind", wind), speed * curve.tangent, uav.drag_area)
    force = uav.weight / GRAVITY * speed**2 * curve.bend - drag + [0.0, 0.0, uav.weight]
    tilt = np.arctan2(np.hypot(force[:, 0], force[:, 1]), force[:, 2])
    return np.linalg.norm(force, axis=1), np.where(np.isnan(tilt), np.pi, tilt)


def greatest_speed(curve: Curve, uav: UAV, wind: npt.ArrayLike = (0.0, 0.0, 0.0), *, bank: float = BANK) -> float:
    """The greatest constant speed over ground [m/s] at which bank, thrust, tilt and air speed stay within limits.

    Between take-off and landing; 0 when there is none, as at a corner; to a millimetre per second. In a strong tail
    wind a UAV may have to be fast: the speeds that work needn't begin at 0. Of ranges of speeds that work only one
    narrower than a 64th of what air speed and bank allow may be overlooked.
    """
    checks.instance("curve", curve, Curve)
    checks.instance("uav", uav, UAV)
    curve, wind = curve.en_route, np.array(checks.three("wind", wind))
    checked_bank(bank)
    along = curve.tangent @ wind
    across = np.maximum((wind**2).sum() - along**2, 0.0)
    if (across > uav.top_speed**2).any():
        return 0.0
    either_way = np.sqrt(uav.top_speed**2 - across)
    sharpest = curve.level_curvature.max()
    banked = np.sqrt(GRAVITY * np.tan(bank) / sharpest) if sharpest > 0 else np.inf
    slowest, fastest = max((along - either_way).max(), LEAST_SPEED), min((along + either_way).min(), banked)
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
