"""The exact optimum on a risk map, under limits on turns, climb and length: the yardstick for every other planner.

A limit on turns makes the way to a voxel matter, so a state is a node and a heading: nine times as many as nodes. First
a Dijkstra search backwards from the goal, over nodes and without headings, gives the exact rest of the cost where turns
are free. That never says too much, so it is an estimate for A* over the states, and nearly always the right one: the
second search walks almost straight to the goal. With a limit on the length too, a state may be reached in
several ways that are worth keeping, cheaper or shorter; each is a label.
"""

import heapq
import time
from bisect import bisect_left
from functools import partial
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.city import City
from uavlab.city.bounds import rounding_of
from uavlab.city.model import check_heights
from uavlab.compiled import compiled
from uavlab.planners.astar import ROUNDING, TIE_BREAK
from uavlab.planners.grid import BOXES, LENGTHS, MOVES, blocked_around_node, steps_of
from uavlab.planners.heap import open_list, pop, push, room
from uavlab.planners.question import Airspace, Ends, endpoints
from uavlab.risk import RiskMap
from uavlab.route import Route

MAX_TURN = MAX_PITCH = np.pi / 3
"""Greatest change of heading at a waypoint and greatest climb or descent of a leg [rad] (RISK-ACO 3.2 and 4)."""

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


def least_risk(
    risk_map: RiskMap,
    start: npt.ArrayLike,
    goal: npt.ArrayLike,
    *,
    risk: float = 1.0,
    length: float = 0.0,
    threat: float = 0.0,
    max_turn: float = MAX_TURN,
    max_pitch: float = MAX_PITCH,
    max_length: float | None = None,
    min_clearance: float = 0.0,
    min_height: float | None = None,
    max_height: float = np.inf,
    drift: bool = False,
    heuristic: str = "backward",
) -> Route:
    """The route of least cost among all over 26 neighbours that keep the limits.

    cost = w_r·∫ r ds/dx + w_l·L + w_s·∫ threat ds/dx with the weights `risk` [h], `length` [1/m] and `threat` [1/m].
    Of routes that cost the same, the one is taken that the search finds first, and its order is fixed; where cells
    cost nothing, the shortest.

    Parameters
    ----------
    risk_map : RiskMap
        Its `flyable` voxels are the ones to choose from.
    start, goal : (3,) arrays
        Positions [m]. The route goes from the centre of the start's voxel to the centre of the goal's.
    risk, length, threat : float
        Weights, at least 0 and not all of them 0. (1, 0, 0) minimises risk; (0, 1, 0) is risk-blind and shortest;
        (0, 0.5, 0.2) is J0, what the papers minimise when they leave risk aside.
    max_turn : float
        Greatest change of heading from leg to leg [rad]. Legs turn by multiples of 45°, so 60° means 45°. A vertical
        leg keeps the heading of the leg before.
    max_pitch : float
        Greatest climb or descent of a leg [rad]: from 35.3° on through corners, from 45° on through edges, at 90°
        vertical.
    max_length : float, optional
        Greatest length [m], but for take-off and landing.
    min_clearance : float
        Least distance to obstacles [m], see `City.clearance`.
    min_height, max_height : float
        Least and greatest height above ground [m], by default the map's `min_height` and none. A start or goal below
        it is left and reached vertically, whatever the other limits.
    drift : bool
        Take the risk where the wreck lands, ahead of the UAV, see `RiskMap.rate_ahead`.
    heuristic : {"backward", "zero"}
        Estimate of the remaining cost: Dijkstra backwards without headings; none (plain Dijkstra over the states).

    Returns
    -------
    Route
        `cost` as above; `info["expanded"]`, nodes and states expanded by both searches; `info["elapsed"]` [s]. Where
        no route keeps the limits `reached` is False, and `reason` says which limit to loosen.

    Raises
    ------
    ValueError
        If start or goal can't be flown from or to, or an argument is out of its range.
    """
    began = time.perf_counter()
    if heuristic not in ("backward", "zero"):
        raise ValueError(f"heuristic must be 'backward' or 'zero', got {heuristic!r}")
    allowed = checked_length(max_length)
    limits = checked_limits(risk_map, max_turn, max_pitch, min_clearance, min_height, max_height)
    price = price_per_cell(risk_map, risk, length, threat, drift)
    ends = flyable_endpoints(risk_map, start, goal, limits)
    query = query_of(risk_map, price, ends.source, ends.target, limits)
    if allowed == np.inf:
        nodes, cost, expanded = solve(query, heuristic == "backward")
        if costs_nothing(query, nodes):
            nodes, more = shortest_of_cheapest(query, cost)
            expanded += more
    else:
        longest = in_cells(risk_map.city, allowed)
        routes, expanded = constrained(query, city_lengths(query), np.array([longest]))
        nodes, cost = routes[0] if routes else (np.empty(0, np.int64), np.inf)
    info = {"expanded": expanded, "elapsed": time.perf_counter() - began}
    name = "least risk" if length == threat == 0 else "shortest" if risk == threat == 0 else "least cost"
    if len(nodes) == 0:
        asked = f"from {checks.show(start)} to {checks.show(goal)}"
        reason = f"no route {asked}: {what_binds(risk_map, query, limits, max_length)}"
        return Route(np.empty((0, 3)), name, reached=False, reason=reason, cost=np.inf, info=info)
    city = risk_map.city
    route = Route(city.center_of(city.index_of(nodes)), name, cost=cost, info=info)
    return finished(route, ends, price, priced_by(risk, threat, drift), allowed)


def finished(route: Route, ends: Ends, price: np.ndarray, priced: str, max_length: float) -> Route:
    """The route with take-off and landing, at a price per cell of way (1 or 26, nodes), and what it promises."""
    upwards = price[UPWARDS if len(price) > 1 else 0] / ends.airspace.city.cell
    return ends.added_to(route, upwards, priced=priced, max_length=max_length)


def priced_by(risk: float, threat: float, drift: bool) -> str:
    """What a route with these weights pays for beside its length, see `Route.priced`."""
    words = [RISK_AHEAD if drift else "risk"] if risk > 0 else []
    return " and ".join(words + ["threat"] * (threat > 0))


def pareto_front(
    risk_map: RiskMap,
    start: npt.ArrayLike,
    goal: npt.ArrayLike,
    *,
    lengths: int | npt.ArrayLike = 12,
    max_turn: float = MAX_TURN,
    max_pitch: float = MAX_PITCH,
    min_clearance: float = 0.0,
    min_height: float | None = None,
    max_height: float = np.inf,
    drift: bool = False,
) -> list[Route]:
    """The least risk for each length that one is ready to fly, exactly (ε-constraint method).

    Parameters
    ----------
    risk_map, start, goal, max_turn, max_pitch, min_clearance, min_height, max_height, drift
        As for `least_risk`.
    lengths : int or array
        Greatest lengths to ask for [m]; or how many, spread evenly from the shortest route's to that of the route of
        least risk.

    Returns
    -------
    list of Route
        From short and risky to long and safe, each with its risk ∫ r ds/dx as `cost`. No route is both longer and
        riskier than another, so there may be fewer than lengths asked for; lengths below the shortest route's give
        none. One route with `reached` False where the limits leave no route at all.

    Raises
    ------
    ValueError
        If start or goal can't be flown from or to, or an argument is out of its range.
    """
    began = time.perf_counter()
    limits = checked_limits(risk_map, max_turn, max_pitch, min_clearance, min_height, max_height)
    count = int(lengths) if isinstance(lengths, int | np.integer) else None
    if count is not None:
        checks.whole("lengths", count, least=2)
    elif np.size(lengths) == 0:
        raise ValueError("lengths is empty: give how many, or at least one length [m]")
    else:
        checks.positive("lengths", lengths)
    ends = flyable_endpoints(risk_map, start, goal, limits)
    price = price_per_cell(risk_map, 1.0, 0.0, 0.0, drift)
    query = query_of(risk_map, price, ends.source, ends.target, limits)
    by_length = city_lengths(query)
    city = risk_map.city
    shortest, least, _ = solve(by_length, True)
    if len(shortest) == 0:
        return [
            least_risk(
                risk_map, start, goal, max_turn=max_turn, max_pitch=max_pitch,
                min_clearance=min_clearance, min_height=min_height, max_height=max_height,
            )
        ]  # fmt: skip
    if count is None:
        asked = checks.numbers("lengths", lengths).ravel() / city.cell
    else:
        safest, cost, _ = solve(query, True)
        if costs_nothing(query, safest):
            safest, _ = shortest_of_cheapest(query, cost)
        longest = np.linalg.norm(np.diff(city.index_of(safest), axis=0), axis=1).sum()
        asked = np.linspace(least, longest, count)
    routes, expanded = constrained(query, by_length, np.unique(asked))
    info = {"expanded": expanded, "elapsed": time.perf_counter() - began}
    found = [
        Route(city.center_of(city.index_of(nodes)), "least risk", cost=cost, info=dict(info)) for nodes, cost in routes
    ]
    return [finished(route, ends, price, priced_by(1.0, 0.0, drift), route.length) for route in found]


class Limits(NamedTuple):
    """What a route must keep."""

    max_turn: float
    max_pitch: float
    min_clearance: float
    safe_height: float
    min_height: float
    max_height: float


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
    return Airspace(risk_map.city, limits.min_clearance, limits.min_height, limits.max_height, limits.safe_height)


def city_lengths(query: Query) -> Query:
    """The same question with the length [cells] as the cost."""
    return query._replace(price=np.ones((1, query.blocked.size)))


def price_per_cell(risk_map: RiskMap, risk: float, length: float, threat: float, drift: bool) -> np.ndarray:
    """Cost per cell of way in each voxel, (1 or 26, nx·ny·nz)."""
    risk, length, threat = (
        checks.not_negative_number(name, weight)
        for name, weight in (("risk", risk), ("length", length), ("threat", threat))
    )
    if risk == length == threat == 0:
        raise ValueError("risk, length and threat are all 0: give at least one of them a weight above 0")
    price = base_price(risk_map, 0.0 if drift else risk, length, threat)[None]
    if drift and risk > 0:
        price = price + risk * risk_map.rate_ahead
    return np.maximum(price, LEAST_PRICE * price.max() + 1e-300).reshape(len(price), -1)


def base_price(risk_map: RiskMap, risk: float, length: float, threat: float) -> np.ndarray:
    """Cost per cell of way, whatever its direction, (nx, ny, nz)."""
    price = np.full(risk_map.city.shape, length * risk_map.city.cell)
    if risk > 0:
        price += risk * risk_map.rate
    if threat > 0:
        price += threat * risk_map.threat
    return price


def checked_limits(
    risk_map: RiskMap,
    max_turn: float,
    max_pitch: float,
    min_clearance: float,
    min_height: float | None,
    max_height: float,
) -> Limits:
    checks.instance("risk_map", risk_map, RiskMap)
    checks.number("min_clearance", min_clearance)
    checks.finite("min_clearance", min_clearance)
    for name, angle, most in (("max_turn", max_turn, np.pi), ("max_pitch", max_pitch, np.pi / 2)):
        checks.number(name, angle)
        checks.within(name, angle, 0.0, most + 1e-9, "rad (from degrees: numpy.radians)")
    lowest = risk_map.min_height if min_height is None else min_height
    check_heights(lowest, max_height)
    return Limits(max_turn, max_pitch, min_clearance, risk_map.safe_height, lowest, max_height)


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


def what_binds(risk_map: RiskMap, query: Query, limits: Limits, max_length: float | None) -> str:
    """Words for what would open a route: each limit that does it alone, and how far to loosen it; else several."""
    price = city_lengths(query).price
    any_length = np.finfo(float).max
    most = any_length if max_length is None else max_length

    def shortest(kept: Limits) -> float:
        """Length of the shortest route that keeps other limits [m]."""
        return solve(query_of(risk_map, price, query.source, query.target, kept), True)[1] * risk_map.city.cell

    def opens(kept: Limits, name: str, value: float) -> bool:
        return shortest(kept._replace(**{name: value})) <= most

    length = shortest(limits)
    if np.isfinite(length):
        return f"max_length is {max_length:g} m, the shortest route has {up(length):.2f} m"
    looser = looser_values(risk_map, limits)
    cures = []
    for name, values in looser.items():
        first = bisect_left(values, True, key=partial(opens, limits, name))
        cures += [setting(name, value) for value in values[first : first + 1]]
    if cures:
        return "there would be one with " + ", or with ".join(cures)
    together = limits._replace(**{name: values[-1] for name, values in looser.items() if values})
    if shortest(together) == np.inf:
        return "obstacles close every way"
    if shortest(together) > most:
        most = any_length
    for name in reversed(looser):
        values = [getattr(limits, name), *looser[name]]
        first = bisect_left(values, True, key=partial(opens, together, name))
        together = together._replace(**{name: values[first]})
    cures = [setting(*item) for item in together._asdict().items() if item not in limits._asdict().items()]
    if max_length is not None and most == any_length:
        cures.append(f"max_length={up(shortest(together)):.2f} m")
    return "there would be one with " + " and ".join(cures)


def looser_values(risk_map: RiskMap, limits: Limits) -> dict[str, list[float]]:
    """For each limit the looser values that make a difference, the loosest last; lengths in whole centimetres."""
    city = risk_map.city

    def above(limit: float, degrees: tuple[float, ...]) -> list[float]:
        return [angle for angle in np.radians(degrees).tolist() if angle > limit + 1e-9]

    def below(limit: float, values: np.ndarray) -> list[float]:
        return np.unique(np.floor(100 * values[values < limit]) / 100)[::-1].tolist()

    return {
        "max_turn": above(limits.max_turn, (45, 90, 135, 180)),
        "max_pitch": above(limits.max_pitch, (35.27, 45, 90)),
        "min_clearance": below(limits.min_clearance, city.clearance),
        "safe_height": below(limits.safe_height, city.height_above_surface),
        "min_height": below(limits.min_height, least_heights(city)),
        "max_height": [np.inf] if limits.max_height < np.inf else [],
    }


def least_heights(city: City) -> np.ndarray:
    """Heights [m] of all centres above the highest ground in their columns, each once, from 0."""
    heights = city.coordinates(2) - city.range_of_ground[1][..., None]
    return np.unique(heights[heights > 0])


def setting(name: str, value: float) -> str:
    """A limit with its value in the unit that people think in."""
    return f"{name}={np.degrees(value):g}°" if name in ("max_turn", "max_pitch") else f"{name}={value:g} m"


def up(length: float) -> float:
    """A length rounded up to centimetres, so that a route of this length keeps it."""
    return float(np.ceil(100 * length) / 100)


def solve(query: Query, backward: bool) -> tuple[np.ndarray, float, int]:
    """Nodes of the cheapest route (none if there is none), its cost, and how many expansions it took."""
    count = query.blocked.size
    rest, expanded = np.zeros(count), 0
    if backward:
        rest, expanded = rest_of_cost(query, query.source, open_list(count))
        if rest[query.source] == np.inf:
            return np.empty(0, np.int64), np.inf, expanded
    g = room(np.empty, count * STATES, np.float64)
    parent = room(np.zeros, count * STATES, np.uint8)
    last, more = search_states(query, rest, g, parent, open_list(count * STATES))
    if last < 0:
        return np.empty(0, np.int64), np.inf, expanded + more
    return trace(query, parent, last), float(g[last]), expanded + more


def costs_nothing(query: Query, nodes: np.ndarray) -> bool:
    """Whether a route passes nodes that cost no more than the least there is, `LEAST_PRICE`."""
    return bool((query.price[:, nodes] <= 1.001 * LEAST_PRICE * query.price.max()).any())


def shortest_of_cheapest(query: Query, cost: float) -> tuple[np.ndarray, int]:
    """Nodes of the shortest of all routes of this least cost, to rounding, and how many expansions it took.

    Where nobody is at risk the lengths of ways would drown in the sum of costs.
    """
    routes, expanded = constrained(city_lengths(query), query, np.array([cost]))
    return routes[0][0], expanded


def constrained(query: Query, by_length: Query, limits: np.ndarray) -> tuple[list[tuple[np.ndarray, float]], int]:
    """For each greatest length [cells] the nodes and the cost of the cheapest route, shortest first, each once.

    `by_length` is what is limited; anything that adds up may be.
    """
    count = query.blocked.size
    rest, expanded = rest_of_cost(query, NOWHERE, open_list(count))
    rest_length, more = rest_of_cost(by_length, NOWHERE, open_list(count))
    states, before, cost, found = search_labels(query, by_length, rest, rest_length, limits)
    routes = []
    for label in found[::-1]:
        nodes = []
        at = label
        while at >= 0:
            nodes.append(states[at] // STATES)
            at = before[at]
        routes.append((np.array(nodes[::-1]), float(cost[label])))
    return routes, expanded + more + len(states)


NOWHERE = -1
UNSEEN, START = 0, 255  # values of `parent`; between them 1 + move·STATES + the heading before


@compiled
def edge(query, move, node, neighbour):
    """Cost of a move from a node to its neighbour [cells]: half of the way in each, as the exact integral has it."""
    row = move if query.price.shape[0] > 1 else 0
    return LENGTHS[move] * 0.5 * (query.price[row, node] + query.price[row, neighbour])


@compiled
def state_after(heading, move, neighbour):
    """The state in which a move arrives at a node; a vertical move keeps the heading."""
    return neighbour * STATES + (heading if MOVE_HEADING[move] == NO_HEADING else MOVE_HEADING[move])


@compiled
def rest_of_cost(query, until, waiting):
    """Least cost from every node to the goal where turns are free: Dijkstra backwards from the goal.

    It stops when the node `until` is reached; farther nodes then get the cost of that one, which is not too much.
    Returns the costs, infinite where no way leads to the goal, and how many nodes were expanded.
    """
    steps = steps_of(query.blocked)
    rest = np.full(query.blocked.size, np.inf)
    rest[query.target] = 0.0
    expanded = 0
    push(waiting, query.target, 0.0)
    while waiting.size[0] > 0:
        node = pop(waiting)
        if node == until:
            return np.minimum(rest, rest[node]), expanded
        expanded += 1
        around = blocked_around_node(query.blocked, node)
        for back in range(26):
            move = 25 - back  # the moves stand in an order in which opposite ones mirror each other
            if around & BOXES[back] or not query.climb[move]:
                continue
            neighbour = node + steps[back]
            cost = rest[node] + edge(query, move, neighbour, node)
            if cost < rest[neighbour] * ROUNDING:
                rest[neighbour] = cost
                push(waiting, neighbour, cost)
    return rest, expanded


@compiled
def search_states(query, rest, g, parent, waiting):
    """A* over states, node·STATES + heading, until one at the goal is expanded: that state, or −1, and the count."""
    steps = steps_of(query.blocked)
    first = query.source * STATES + NO_HEADING
    expanded = 0
    g[first] = 0.0
    parent[first] = START
    push(waiting, first, 0.0)
    while waiting.size[0] > 0:
        state = pop(waiting)
        node, heading = state // STATES, state % STATES
        if node == query.target:
            return state, expanded
        expanded += 1
        around = blocked_around_node(query.blocked, node)
        for move in range(26):
            if around & BOXES[move] or not query.climb[move] or not query.turn[heading, move]:
                continue
            neighbour = node + steps[move]
            cost = g[state] + edge(query, move, node, neighbour)
            follower = state_after(heading, move, neighbour)
            if parent[follower] == UNSEEN or cost < g[follower] * ROUNDING:
                g[follower] = cost
                parent[follower] = 1 + move * STATES + heading
                push(waiting, follower, cost + TIE_BREAK * rest[neighbour])
    return -1, expanded


def trace(query: Query, parent: np.ndarray, last: int) -> np.ndarray:
    """Nodes from the start to the last state, back along the moves that led there."""
    steps = steps_of(query.blocked)
    nodes = [last // STATES]
    state = last
    while parent[state] != START:
        move, heading = divmod(int(parent[state]) - 1, STATES)
        nodes.append(nodes[-1] - int(steps[move]))
        state = nodes[-1] * STATES + heading
    return np.array(nodes[::-1])


@compiled
def search_labels(query, by_length, rest, rest_length, limits):
    """Cheapest routes not longer than each of the limits [cells], by labels: ways to a state, cheaper or shorter.

    Labels are expanded in order of cost + rest. Of two at one state the later one costs more, so it is worth
    keeping only if it is shorter. The first label at the goal is the cheapest route within the largest limit; from
    then on only shorter ones are of interest, for the next smaller limit. Returns state, predecessor and
    cost of all labels, and those found at the goal, longest first.
    """
    steps = steps_of(query.blocked)
    shortest = np.full(query.blocked.size * STATES, np.inf)  # of the labels expanded at each state
    states, before, costs, lengths = [query.source * STATES + NO_HEADING], [-1], [0.0], [0.0]
    found = [-1]
    limit = limits[-1] / ROUNDING
    waiting = [(rest[query.source], rest_length[query.source], 0)]
    while len(waiting) > 0:
        _, least, label = heapq.heappop(waiting)
        state, length = states[label], lengths[label]
        node, heading = state // STATES, state % STATES
        if least > limit or length >= shortest[state] * ROUNDING:
            continue
        shortest[state] = length
        if node == query.target:
            found.append(label)
            shorter = limits[limits < length * ROUNDING]
            if len(shorter) == 0:
                break
            limit = shorter[-1] / ROUNDING
            continue
        around = blocked_around_node(query.blocked, node)
        for move in range(26):
            if around & BOXES[move] or not query.climb[move] or not query.turn[heading, move]:
                continue
            neighbour = node + steps[move]
            follower = state_after(heading, move, neighbour)
            way = length + edge(by_length, move, node, neighbour)
            if way + rest_length[neighbour] > limit or way >= shortest[follower] * ROUNDING:
                continue
            cost = costs[label] + edge(query, move, node, neighbour)
            states.append(follower)
            before.append(label)
            costs.append(cost)
            lengths.append(way)
            heapq.heappush(waiting, (cost + rest[neighbour], way + rest_length[neighbour], len(states) - 1))
    return np.array(states), np.array(before), np.array(costs), np.array(found[1:])
