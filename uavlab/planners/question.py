"""What all planners share: where a route may be, where it begins and ends, and vertical take-off and landing.

A route keeps `min_clearance` to obstacles and flies between `min_height` and `max_height` above ground, out of no-fly
zones. A start or a goal below `min_height` is left and reached vertically: the planner looks for a way from the first
voxel above it that is high enough, and the vertical legs are added to what it finds.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.city import City, LazyCity
from uavlab.city.extent import locked
from uavlab.city.lazy import check_kept
from uavlab.compiled import compiled
from uavlab.risk.model import high_enough
from uavlab.route import PROMISES, Route

NEARBY = 64
"""So far [cells] around a start or a goal on a lazy city it is looked for what is in the way."""

MOST_LOOKED = 100_000_000
"""Of so many voxels, and no more, a free one is looked for."""


class Airspace(NamedTuple):
    """Where a route may be. Between its start and its goal there must be a move: both in one voxel is an error."""

    city: City
    min_clearance: float = 0.0
    min_height: float = 0.0
    max_height: float = np.inf
    safe_height: float = 0.0
    """Least height above what lies below [m], of a risk map."""
    radius: float = 0.0
    """Of a body that must not touch anything [m], where greater distances are only dear."""
    closed: np.ndarray | None = None
    """Ground over which it may not be, (nx, ny) bool."""
    why_closed: str = ""
    """In words, for a start or a goal over it."""

    @property
    def blocked(self) -> np.ndarray:
        """Where it may not be, (nx, ny, nz) bool."""
        clearance = self.promises["min_clearance"]
        blocked = self.city.blocked(clearance, min_height=self.min_height, max_height=self.max_height)
        if self.safe_height > 0:
            blocked = locked(blocked | ~high_enough(self.city, self.safe_height))
        return blocked if self.closed is None else locked(blocked | self.closed[..., None])

    @property
    def promises(self) -> dict[str, Any]:
        """What a route in it keeps, see `Route`."""
        clearance = max(self.min_clearance, self.radius) if self.radius else self.min_clearance
        return dict(zip(PROMISES, (clearance, self.min_height, self.max_height, self.safe_height), strict=True))


class Ends(NamedTuple):
    """Codes of the voxels between which a way is looked for, and of those passed vertically before and after."""

    airspace: Airspace
    source: int
    target: int
    takeoff: tuple[int, ...] = ()
    """From the start up to below the source; empty where the start is the source."""
    landing: tuple[int, ...] = ()
    """From below the target down to the goal."""

    def added_to(
        self, route: Route, price: np.ndarray | None = None, *, priced: str = "", max_length: float = np.inf
    ) -> Route:
        """The route with what it promises, and its vertical legs, at a `price` (nx, ny, nz) per metre."""
        city = self.airspace.city
        route = replace(route, **self.airspace.promises, priced=priced, max_length=max_length)
        if not (self.takeoff or self.landing) or not len(route.points):
            return route
        before, after = (city.center_of(city.index_of(np.array(codes, int))) for codes in (self.takeoff, self.landing))
        parts = [before, route.points, after] if route.reached else [before, route.points]
        cost = route.cost
        for codes in ((*self.takeoff, self.source), (self.target, *self.landing)):
            prices = np.ones(len(codes)) if price is None else price.reshape(-1)[list(codes)]
            cost += city.cell * float((prices[:-1] + prices[1:]).sum()) / 2
        return replace(
            route,
            points=np.concatenate(parts),
            cost=cost,
            takeoff=len(before),
            landing=len(after) if route.reached else 0,
        )


def timed(route: Route, began: float) -> Route:
    """The answer with the time since the question was asked, in `info["elapsed"]` [s]."""
    return replace(route, info=route.info | {"elapsed": time.perf_counter() - began})


def endpoints(airspace: Airspace, start: npt.ArrayLike, goal: npt.ArrayLike) -> Ends:
    """Where a way is to be looked for; `ValueError` if start or goal can't be flown from or to, or both are one."""
    city = airspace.city
    checks.instance("city", city, City)
    if isinstance(city, LazyCity):
        source, takeoff = end_nearby(airspace, city, start, "start")
        target, landing = end_nearby(airspace, city, goal, "goal")
    else:
        blocked = airspace.blocked
        source, takeoff = end_at(airspace, blocked, start, "start")
        target, landing = end_at(airspace, blocked, goal, "goal")
    if (takeoff or (source,))[0] == (landing or (target,))[0]:
        raise ValueError(
            f"start {checks.show(start)} and goal {checks.show(goal)} lie in the same voxel: "
            f"there is no route to plan; choose a goal at least one cell ({city.cell:g} m) away"
        )
    if source == target:
        raise ValueError(
            f"start {checks.show(start)} and goal {checks.show(goal)} lie above each other, below "
            f"min_height={airspace.min_height:g} m, where only take-off and landing are allowed: ask for less"
        )
    return Ends(airspace, source, target, takeoff, landing[::-1])


def end_at(
    airspace: Airspace, blocked: np.ndarray, point: npt.ArrayLike, argument: str,
    nearest: Callable[[], str] | None = None,
) -> tuple[int, tuple[int, ...]]:  # fmt: skip
    """The code of the voxel at a start or a goal, or above it; and those below, from the point upwards.

    `nearest` gives the words for the nearest point that would do, by default of those that aren't `blocked`.

    Raises
    ------
    ValueError
        If it isn't three finite numbers, lies outside of the map, in an obstacle or a no-fly zone, nearer to an
        obstacle than `min_clearance`, or too high; the message names the argument, what is in the way, and the nearest
        point that would do.
    """
    city, position = airspace.city, checked_position(airspace.city, point, argument)
    code = int(city.code_of(city.cell_of(position)))
    wrong = what_blocks(airspace, blocked, position)
    if not wrong:
        return code, ()
    if wrong == TOO_LOW:
        top = int(first_above(blocked, city.blocked(), code))
        if top >= 0:
            return top, tuple(range(code, top))
        wrong = f"{TOO_LOW}={airspace.min_height:g} m, and there is no free way straight up from it"
    instead = nearest() if nearest else nearest_allowed(city, position, ~blocked)
    raise ValueError(f"{argument} {checks.show(position)} {wrong}; {instead}")


def end_nearby(airspace: Airspace, city: LazyCity, point: npt.ArrayLike, argument: str) -> tuple[int, tuple[int, ...]]:
    """`end_at` on a lazy city, from what is around the point."""
    position = checked_position(city, point, argument)
    min_clearance = airspace.promises["min_clearance"]
    check_kept(city, min_clearance)
    margin = NEARBY * city.cell + min_clearance  # of the part, which so has the clearance at the point
    part = city.part(position, margin=margin)
    first = np.round((part.origin - city.origin) / city.cell).astype(int)
    blocked = blocked_columns(airspace, city, first[:2], part.shape[:2])
    local = airspace._replace(city=part)
    code, passed = end_at(local, blocked, position, argument, lambda: nearest_on_lazy(airspace, city, position))
    codes = city.code_of(part.index_of([code, *passed]) + first).tolist()
    return codes[0], tuple(codes[1:])


def blocked_columns(airspace: Airspace, city: LazyCity, first: np.ndarray, count: tuple[int, int]) -> np.ndarray:
    """Where a route may not be on some columns of a lazy city, (*count, nz) bool."""
    clearance = airspace.promises["min_clearance"]
    corner = int(first[0]), int(first[1])
    return city.blocked_window(corner, count, clearance, airspace.min_height, airspace.max_height)


def nearest_on_lazy(airspace: Airspace, city: LazyCity, position: np.ndarray) -> str:
    """`nearest_allowed` on a lazy city, looked for in windows that grow."""
    place = (position - city.origin) / city.cell
    reach = NEARBY
    while True:
        first = np.maximum(np.floor(place[:2]).astype(int) - reach, 0)
        last = np.minimum(np.floor(place[:2]).astype(int) + reach + 1, city.shape[:2])
        count = int(last[0] - first[0]), int(last[1] - first[1])
        if count[0] * count[1] * city.shape[2] > MOST_LOOKED and reach > NEARBY:
            return f"no voxel within {reach // 2 * city.cell:g} m of it is free"
        corner = np.array([*first, 0])
        node = nearest_node(blocked_columns(airspace, city, first, count), place - corner)
        index = np.array(np.unravel_index(max(node, 0), (*count, city.shape[2]))) + corner
        everything = count == city.shape[:2]
        if node >= 0 and (everything or np.linalg.norm(index + 0.5 - place) <= reach):
            return f"the nearest free point is {checks.show(city.center_of(index))}"
        if everything:
            return "no voxel of the map is free"
        reach *= 2


@compiled
def first_above(blocked, barred, code):
    """The code of the first voxel straight up where a route may be, −1 if what is barred, or nothing, is above."""
    flags, bars, nz = blocked.ravel(), barred.ravel(), blocked.shape[2]
    for above in range(code, code // nz * nz + nz):
        if not flags[above]:
            return above
        if bars[above]:
            return -1
    return -1


TOO_LOW = "lies below min_height"


def what_blocks(airspace: Airspace, blocked: np.ndarray, position: np.ndarray) -> str:
    """Why nobody may be at a point [m] of the map, in words; empty if one may; `TOO_LOW` if one may land there."""
    city = airspace.city
    index = tuple(city.cell_of(position))
    if not blocked[index]:
        return ""
    if city.occupied[index]:
        return f"lies in {city.building_at(position)}"
    if city.no_fly and city.in_no_fly[index]:
        return f"lies in no-fly zone {city.zone_at(position)!r}"
    if airspace.closed is not None and airspace.closed[index[:2]]:
        return airspace.why_closed
    height = city.height_above_ground(position)
    if city.out_of_heights(0.0, airspace.max_height)[index]:
        return f"is {height:.1f} m above ground, max_height allows {airspace.max_height:g} m"
    if city.out_of_heights(airspace.min_height, np.inf)[index]:
        return TOO_LOW
    clearance = city.clearance[index]
    if clearance < airspace.radius - 1e-9 * city.cell:
        return f"is {clearance:.2f} m from the nearest obstacle, the body needs {airspace.radius:g} m"
    if clearance < airspace.min_clearance:
        return f"is {clearance:.2f} m from the nearest obstacle, min_clearance asks for {airspace.min_clearance:g} m"
    above = city.height_above_surface[index]
    return f"is {above:.1f} m above what lies below, safe_height asks for {airspace.safe_height:g} m"


def checked_position(city: City, point: npt.ArrayLike, argument: str) -> np.ndarray:
    """A start or a goal as three finite numbers on the map."""
    position = checks.numbers(argument, point)
    if position.shape != (3,):
        raise ValueError(f"{argument} must be three numbers (x, y, z) in metres, got shape {position.shape}")
    if not np.isfinite(position).all():
        raise ValueError(f"{argument} must be finite, got {checks.show(position)}")
    if not city.inside(position):
        low, high = city.bounds
        ranges = ", ".join(f"{a} {lo:g} to {hi:g}" for a, lo, hi in zip("xyz", low, high, strict=True))
        raise ValueError(f"{argument} {checks.show(position)} lies outside of the map: {ranges} m")
    return position


def nearest_allowed(city: City, position: np.ndarray, allowed: np.ndarray) -> str:
    """Words for the centre nearest to a position among allowed voxels (nx, ny, nz), looked for in boxes that grow."""
    node = nearest_node(~allowed, (position - city.origin) / city.cell)
    if node < 0:
        return "no voxel of the map is free"
    return f"the nearest free point is {checks.show(city.center_of(city.index_of(node)))}"


@compiled
def nearest_node(blocked, point):
    """The code of the free voxel whose centre is nearest to a point (3,) [cells], −1 if none is free.

    Looked for in boxes around the point that grow until nothing outside of them can be nearer.
    """
    nx, ny, nz = blocked.shape
    most = max(nx, ny, nz)
    radius = 4
    while True:
        least, nearest = np.inf, -1
        for i in range(max(math.floor(point[0]) - radius, 0), min(math.floor(point[0]) + radius + 1, nx)):
            for j in range(max(math.floor(point[1]) - radius, 0), min(math.floor(point[1]) + radius + 1, ny)):
                for k in range(max(math.floor(point[2]) - radius, 0), min(math.floor(point[2]) + radius + 1, nz)):
                    if not blocked[i, j, k]:
                        x, y, z = i + 0.5 - point[0], j + 0.5 - point[1], k + 0.5 - point[2]
                        squared = x * x + y * y + z * z
                        if squared < least:
                            least, nearest = squared, (i * ny + j) * nz + k
        if least < radius * radius or radius > most:
            return nearest
        radius *= 2


def checked_price(city: City, price: npt.ArrayLike) -> tuple[np.ndarray, float]:
    """A price per metre as a float array of the city's shape, and the cheapest."""
    checked = np.ascontiguousarray(checks.numbers("price", price))
    if checked.shape != city.shape:
        raise ValueError(f"price must have the city's shape {city.shape}, got {checked.shape}")
    cheapest = float(checked.min())
    if not 0 <= cheapest <= checked.max() < np.inf:  # NaN fails too
        raise ValueError("price must be finite and at least 0 everywhere; use min_clearance to forbid voxels")
    return checked, cheapest
