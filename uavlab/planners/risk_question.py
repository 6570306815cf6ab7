"""What the planners on a risk map ask alike: weights, limits on turns and climb, and the price of each move.

A limit on turns makes the way to a voxel matter, so a state is a node and a heading: nine times as many as nodes.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.city import City
from uavlab.city.bounds import rounding_of
from uavlab.city.extent import checked_heights
from uavlab.compiled import compiled
from uavlab.planners.grid import LENGTHS, MOVES
from uavlab.planners.question import Airspace, Ends, endpoints
from uavlab.risk import RiskMap
from uavlab.route import Route

MAX_TURN = np.pi / 3
"""Greatest change of heading at a waypoint [rad] (RISK-ACO 3.2 and 4), as large as `MAX_PITCH`."""

HEADINGS = 8
NO_HEADING = HEADINGS  # before the first leg that isn't vertical
STATES = HEADINGS + 1


MOVE_HEADING = np.where(
    (MOVES[:, :2] == 0).all(axis=1), NO_HEADING, np.round(np.arctan2(MOVES[:, 1], MOVES[:, 0]) / (np.pi / 4)) % HEADINGS
).astype(np.int64)
"""Heading of each move (26,), in eighths of a turn from east; a vertical move has none."""

UPWARDS = int(np.flatnonzero((MOVES == (0, 0, 1)).all(axis=1))[0])
"""The move straight up."""

MOVE_PITCH = np.abs(np.arctan2(MOVES[:, 2], np.hypot(MOVES[:, 0], MOVES[:, 1])))

RISK_AHEAD = "risk where the wreck lands"

LEAST_PRICE = 1e-15
"""Of the highest price, the least that a voxel costs: over a lake, where nobody is at risk, a short way is taken."""


def finished(route: Route, ends: Ends, price: np.ndarray, weights: Weights, max_length: float) -> Route:
    """The route with take-off and landing, at a price per cell of way (1 or 26, nodes), and what it promises."""
    upwards = price[UPWARDS if len(price) > 1 else 0]
    route = ends.added_to(route, upwards / ends.airspace.city.cell, priced=weights.priced, max_length=max_length)
    if weights.as_printed:  # each move costs half of both voxels: the ends lack a half
        first, last = (ends.takeoff or (ends.source,))[0], (ends.landing or (ends.target,))[-1]
        route = replace(route, cost=route.cost + float(upwards[first] + upwards[last]) / 2)
    return route


class Weights(NamedTuple):
    """What a cost consists of, see `least_risk`."""

    risk: float = 1.0
    length: float = 0.0
    threat: float = 0.0
    drift: bool = False
    as_printed: bool = False

    @classmethod
    def checked(cls, risk: float, length: float, threat: float, drift: bool, as_printed: bool = False) -> Weights:
        """Those of a planner's arguments."""
        named = {"risk_weight": risk, "length_weight": length, "threat_weight": threat}
        weights = [checks.not_negative_number(name, weight) for name, weight in named.items()]
        if not any(weights):
            raise ValueError(f"{', '.join(named)} are all 0: give at least one of them a weight above 0")
        checks.flag("drift", drift)
        if checks.flag("as_printed", as_printed) and (drift or weights != [1.0, 0.0, 0.0]):
            raise ValueError(
                f"as_printed sums up the risk straight below, and nothing else: leave {', '.join(named)} and drift "
                "as they are by default"
            )
        return cls(weights[0], weights[1], weights[2], drift, as_printed)

    @property
    def priced(self) -> str:
        """What a route pays for beside its length, see `Route.priced`."""
        words = [RISK_AHEAD if self.drift else "risk"] if self.risk > 0 else []
        return " and ".join(words + ["threat"] * (self.threat > 0))

    @property
    def name(self) -> str:
        """Of a route of least cost."""
        if self.length == self.threat == 0:
            return "least risk"
        return "shortest" if self.risk == self.threat == 0 else "least cost"


class Limits(NamedTuple):
    """What a route must keep."""

    max_turn: float
    max_pitch: float
    min_clearance: float
    safe_height: float
    min_height: float
    max_height: float
    max_igrc: float = np.inf
    ground_risk_buffer: float = 0.0


class Query(NamedTuple):
    """A question as arrays, for compiled code."""

    blocked: np.ndarray  # (nx, ny, nz) bool
    price: np.ndarray  # (1 or 26, nx·ny·nz): cost per cell of way, the same for all moves or for each
    climb: np.ndarray  # (26,) bool: whether a move is flat enough
    turn: np.ndarray  # (STATES, 26) bool: whether a move may follow a heading
    source: int
    target: int


def query_of(risk_map: RiskMap, price: np.ndarray, source: int, target: int, limits: Limits) -> Query:
    """The question with these limits; heading NO_HEADING allows every move, and so does a vertical move."""
    apart = np.abs(MOVE_HEADING - np.arange(STATES)[:, None]) * np.pi / 4
    turn = np.minimum(apart, 2 * np.pi - apart) <= limits.max_turn + 1e-9
    turn[NO_HEADING] = turn[:, MOVE_HEADING == NO_HEADING] = True
    blocked = airspace_of(risk_map, limits).blocked
    return Query(blocked, price, limits.max_pitch + 1e-9 >= MOVE_PITCH, turn, source, target)


def airspace_of(risk_map: RiskMap, limits: Limits) -> Airspace:
    """Where the limits allow to be."""
    airspace = Airspace(risk_map.city, limits.min_clearance, limits.min_height, limits.max_height, limits.safe_height)
    if limits.max_igrc == np.inf:
        return airspace
    closed = risk_map.igrc_within(limits.ground_risk_buffer) > limits.max_igrc
    where = f"within {limits.ground_risk_buffer:g} m" if limits.ground_risk_buffer else "below it"
    why = f"has ground of a class above max_igrc={limits.max_igrc:g} {where}"
    return airspace._replace(closed=closed, why_closed=why)


def city_lengths(query: Query) -> Query:
    """The same question with the length [cells] as the cost."""
    return query._replace(price=np.ones((1, query.blocked.size)))


def price_per_cell(risk_map: RiskMap, weights: Weights) -> np.ndarray:
    """Cost per cell of way in each voxel, (1 or 26, nx·ny·nz)."""
    price = base_price(risk_map, weights)[None]
    if weights.drift and weights.risk > 0:
        price = price + weights.risk * risk_map.rate_ahead
    if weights.as_printed:  # a sum over voxels: a move costs the same, however long it is
        price = price / LENGTHS[:, None, None, None]
    return np.maximum(price, LEAST_PRICE * price.max() + 1e-300).reshape(len(price), -1)


def base_price(risk_map: RiskMap, weights: Weights) -> np.ndarray:
    """Cost per cell of way, whatever its direction, (nx, ny, nz)."""
    price = np.full(risk_map.city.shape, weights.length * risk_map.city.cell)
    if weights.risk > 0 and not weights.drift:
        price += weights.risk * risk_map.rate
    if weights.threat > 0:
        price += weights.threat * risk_map.threat
    return price


def checked_limits(
    risk_map: RiskMap,
    max_turn: float,
    max_pitch: float,
    min_clearance: float,
    min_height: float | None,
    max_height: float,
    max_igrc: int | None = None,
    ground_risk_buffer: float = 0.0,
) -> Limits:
    """A planner's arguments as limits; `min_height` is the map's by default."""
    checks.instance("risk_map", risk_map, RiskMap)
    min_clearance = checks.not_negative_number("min_clearance", min_clearance)
    radians = "rad (from degrees: numpy.radians)"
    max_turn = checks.number("max_turn", max_turn, checks.within, 0.0, np.pi + 1e-9, radians)
    max_pitch = checks.number("max_pitch", max_pitch, checks.within, 0.0, np.pi / 2 + 1e-9, radians)
    heights = checked_heights(risk_map.min_height if min_height is None else min_height, max_height)
    highest = np.inf if max_igrc is None else float(checks.whole("max_igrc", max_igrc, 1, 10))
    buffer = checks.not_negative_number("ground_risk_buffer", ground_risk_buffer)
    return Limits(max_turn, max_pitch, min_clearance, risk_map.safe_height, *heights, highest, buffer)


def checked_length(max_length: float | None) -> float:
    """The greatest length [m], infinite for None."""
    if max_length is None:
        return np.inf
    length = checks.number("max_length", max_length)
    checks.refuse(np.asarray(length), np.asarray(length) > 0, "max_length must be above 0")
    return length


def in_cells(city: City, length: float) -> float:
    """A greatest length [cells], with room for the rounding of each move."""
    return length / city.cell * (1 + rounding_of(city))


def flyable_endpoints(risk_map: RiskMap, start: npt.ArrayLike, goal: npt.ArrayLike, limits: Limits) -> Ends:
    """Between which voxels to look; `ValueError` if the UAV may not fly there."""
    for name, point in (("start", start), ("goal", goal)):
        checks.numbers(name, point)
    return endpoints(airspace_of(risk_map, limits), start, goal)


@compiled
def edge(query, move, node, neighbour):
    """Cost of a move from a node to its neighbour [cells]: half of the way in each, as the exact integral has it."""
    row = move if query.price.shape[0] > 1 else 0
    return LENGTHS[move] * 0.5 * (query.price[row, node] + query.price[row, neighbour])


@compiled
def state_after(heading, move, neighbour):
    """The state in which a move arrives at a node; a vertical move keeps the heading."""
    return neighbour * STATES + (heading if MOVE_HEADING[move] == NO_HEADING else MOVE_HEADING[move])
