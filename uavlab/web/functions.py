"""What a page can ask: the functions of `planners.wasm`, put together from the library's own compiled code.

Each takes numbers and arrays that are handed in, and writes its answer into some of the arrays. Positions are metres in
the map's frame. All of it runs in Python, too, where tests hold it against the public functions.
"""

from __future__ import annotations

from typing import Annotated

import numpy as np

from uavlab.city.bounds import Bounds
from uavlab.city.segments import Runs, first_runs, least_clearance, runs_in_columns, segment_clearances
from uavlab.city.voxels import least_kept, put_clearance
from uavlab.compiled import compiled
from uavlab.flight.models import air_with_memory
from uavlab.flight.motion import fly_on
from uavlab.flight.path import Vehicle, legs_of, plan
from uavlab.flight.reference import most_steps
from uavlab.flight.state import BATTERY, FLYING, LEAST, Body, Course, Obstacles, start_of
from uavlab.planners.astar import TIE_BREAK as ASTAR_TIE_BREAK
from uavlab.planners.astar import Query, Tree, cheapest_nodes, price_in_zone
from uavlab.planners.hazard import NO_HAZARD, price_at
from uavlab.planners.heap import OpenList
from uavlab.planners.potential_field import ARRIVED, Field, walk_freely, walk_lattice
from uavlab.planners.question import first_above, nearest_node
from uavlab.planners.repare import forces_at
from uavlab.planners.risk_question import STATES
from uavlab.planners.risk_question import Query as RiskQuery
from uavlab.planners.risk_search import rest_of_cost, search_states
from uavlab.planners.risk_search import trace as trace_states
from uavlab.planners.shortcut import line_price, straightened
from uavlab.planners.theta_star import WEIGHT as STRAIGHT_WEIGHT
from uavlab.planners.theta_star import Query as StraightQuery
from uavlab.planners.theta_star import Tree as StraightTree
from uavlab.planners.theta_star import pulled_taut, straight_nodes
from uavlab.spline.sampling import bends_at, mirrored, points_at, sagittas, speed_in_turn, steps_on, tangents_of
from uavlab.weather.wind import GUST_SHARES, strongest_gust
from uavlab.web.generator import Stream

Flags1 = Annotated[np.ndarray, "boolean", 1]
Flags2 = Annotated[np.ndarray, "boolean", 2]
Flags3 = Annotated[np.ndarray, "boolean", 3]
Floats1 = Annotated[np.ndarray, "float64", 1]
Floats2 = Annotated[np.ndarray, "float64", 2]
Floats3 = Annotated[np.ndarray, "float64", 3]
Ints1 = Annotated[np.ndarray, "int32", 1]
Longs1 = Annotated[np.ndarray, "int64", 1]
Words1 = Annotated[np.ndarray, "uint64", 1]

COST, EXPANDED, REACHED, RECORDED, OUTCOME, STEPS, NEAREST, ENERGY, BEND, FASTEST, STEEPEST = range(11)
ANSWERS = (
    "cost", "expanded", "reached", "recorded", "outcome", "steps", "nearest", "energy", "bend", "fastest", "steepest",
)  # fmt: skip
"""Where answers stand in `facts`: a route's cost, expanded nodes, voxels within reach where there is no way, nodes that
are recorded, how a walk or a flight ended, its logged steps, least distance to obstacles [m], energy used [J], and
of a curve the greatest curvature on the plan [1/m], the speed [m/s] at which
a bank angle holds it, and the greatest climb or descent, as a share of the way."""


@compiled
def clear(occupied: Flags3, cell: float, clearance: Floats3) -> int:
    """Exact clearance of each voxel's centre."""
    put_clearance(occupied, cell, clearance)
    return 0


@compiled
def count_runs(occupied: Flags3, first: Longs1) -> int:
    """How many runs there are, and the number of the first in each column (nx·ny + 1,)."""
    first[:] = first_runs(occupied)
    return first[-1]


@compiled
def put_runs(occupied: Flags3, first: Longs1, low: Ints1, high: Ints1, inner: Flags1) -> int:
    """The runs themselves."""
    low[:], high[:], inner[:] = runs_in_columns(occupied, first)
    return 0


@compiled
def close(occupied: Flags3, closed: Flags3, clearance: Floats3, min_clearance: float, cell: float, out: Flags3) -> int:
    """Where a route may not be; how many voxels that are."""
    least = least_kept(min_clearance, cell)
    blocked, shut, kept = out.ravel(), closed.ravel(), clearance.ravel()
    for n in range(len(blocked)):  # counting in here is miscompiled for CPUs with AVX: a fourth isn't written
        blocked[n] = shut[n] or kept[n] < least
    return int(np.count_nonzero(out))


@compiled
def nearest(blocked: Flags3, point: Floats1, origin: Floats1, cell: float) -> int:
    """The code of the free voxel nearest to a point, −1 if none is free."""
    return nearest_node(blocked, (point - origin) / cell)


@compiled
def above(blocked: Flags3, barred: Flags3, code: int) -> int:
    """`first_above`, where a route that takes off below its least height begins."""
    return first_above(blocked, barred, code)


@compiled
def price_zone(clearance: Floats3, distance: float, penalty: float, cell: float, price: Floats3) -> float:
    """`penalty_zone`; the cheapest."""
    out, known = price.ravel(), clearance.ravel()
    cheapest = np.inf
    for n in range(len(out)):
        out[n] = price_in_zone(known[n], distance, penalty, cell)
        cheapest = min(cheapest, out[n])
    return cheapest


@compiled
def price_hazard(clearance: Floats3, sigma: float, radius: float, crash_price: float, price: Floats3) -> int:
    """`hazard_price` without a mean offset; `crash_price` is λ·ω_n/v."""
    out, known = price.ravel(), clearance.ravel()
    for n in range(len(out)):
        out[n] = price_at(min(known[n], radius + NO_HAZARD * sigma), sigma, radius, crash_price)
    return 0


@compiled
def price_repare(
    clearance: Floats3, safe_distance: float, penalty: float, blown: float, loaded: float, cell: float, price: Floats3
) -> int:
    """`repare_price` without a mean offset, for a wind from any side."""
    out, known = price.ravel(), clearance.ravel()
    for n in range(len(out)):
        omega = 0.0  # where no wall is near, as for most
        if known[n] < safe_distance:
            omega = penalty * forces_at(known[n], safe_distance, cell, blown, loaded)
        out[n] = price_in_zone(known[n], safe_distance, omega, cell)
    return 0


@compiled
def astar(
    blocked: Flags3, heuristic: int, start: int, goal: int, origin: Floats1, cell: float,
    points: Floats2, order: Ints1, facts: Floats1,
) -> int:  # fmt: skip
    """`astar` between two codes: how many points, 0 if there is no way; `order` takes expanded nodes."""
    query = Query(blocked, False, heuristic, ASTAR_TIE_BREAK, start, goal)
    return written(searched(query, None, order, facts), blocked, origin, cell, points, order, facts)


@compiled
def astar_priced(
    blocked: Flags3, price: Floats3, cheapest: float, heuristic: int, start: int, goal: int, origin: Floats1,
    cell: float, points: Floats2, order: Ints1, facts: Floats1,
) -> int:  # fmt: skip
    """The same with a price, and one that none is below, with which the estimate counts.

    That is the least for `astar`, and 1 for `hazard_astar` and `repare`.
    """
    query = Query(blocked, False, heuristic, cheapest * ASTAR_TIE_BREAK, start, goal)
    return written(searched(query, price, order, facts), blocked, origin, cell, points, order, facts)


@compiled
def searched(query, price, order, facts):
    """Nodes, cost [cells], expansions and their order, if there is room for any."""
    count = query.blocked.size
    tree = Tree(np.empty(count), np.zeros(count, np.uint8))
    answer = cheapest_nodes(query, price, tree, waiting_list(count), len(order) > 0)
    if len(answer[0]) == 0:
        facts[REACHED] = np.count_nonzero(tree.parent)
    return answer


@compiled
def waiting_list(count):
    """`open_list`."""
    return OpenList(
        np.empty(count + 1, np.int32), np.empty(count + 1), np.zeros(count, np.int32), np.zeros(1, np.int64)
    )


@compiled
def written(answer, blocked, origin, cell, points, order, facts):
    """Write a route down: its points, what it costs [m] and how it was found; how many points it has."""
    nodes, cost, expanded, recorded = answer
    ny, nz = blocked.shape[1], blocked.shape[2]
    for n in range(min(len(nodes), len(points))):
        points[n, 0] = origin[0] + cell * (nodes[n] // (ny * nz) + 0.5)
        points[n, 1] = origin[1] + cell * (nodes[n] // nz % ny + 0.5)
        points[n, 2] = origin[2] + cell * (nodes[n] % nz + 0.5)
    count = min(len(recorded), len(order))
    order[:count] = recorded[:count]
    facts[COST], facts[EXPANDED], facts[RECORDED] = cost * cell, expanded, count
    return len(nodes)


@compiled
def bounds_between(occupied, apart, runs, zones, slack):
    """What straight legs keep: a distance from obstacles, and off no-fly zones."""
    anywhere = np.zeros((1, 1, 1)), np.zeros((1, 1))
    return Bounds(runs, max(apart - slack, slack), zones, slack, *anywhere, False, occupied.shape)


@compiled
def thetastar(
    blocked: Flags3, min_clearance: float, slack: float, start: int, goal: int, origin: Floats1, cell: float,
    first: Longs1, low: Ints1, high: Ints1, inner: Flags1,
    zone_first: Longs1, zone_low: Ints1, zone_high: Ints1, zone_inner: Flags1,
    points: Floats2, facts: Floats1,
) -> int:  # fmt: skip
    """`theta_star` between two codes; how many points, 0 if there is no way."""
    columns = blocked.shape[0], blocked.shape[1]
    runs, zones = Runs(columns, first, low, high, inner), Runs(columns, zone_first, zone_low, zone_high, zone_inner)
    bounds = bounds_between(blocked, min_clearance / cell, runs, zones, slack)
    count = blocked.size
    tree = StraightTree(
        np.empty(count),
        np.empty(count, np.int32),
        np.empty(count),
        np.zeros(count, np.int32),
        np.zeros(count, np.uint8),
    )
    query = StraightQuery(blocked, bounds, 1.0, STRAIGHT_WEIGHT, start, goal)
    nodes, cost, expanded = straight_nodes(query, None, tree, waiting_list(count))
    count = written((nodes, cost, expanded, nodes[:0]), blocked, origin, cell, points, np.empty(0, np.int32), facts)
    if count == 0:
        return 0
    taut, cost = pulled_taut(points[:count].copy(), origin, cell, bounds, None, 1.0)
    points[: len(taut)] = taut
    facts[COST] = cost * cell
    return len(taut)


@compiled
def straighten(
    points: Floats2, count: int, price: Floats3, min_clearance: float, slack: float, origin: Floats1, cell: float,
    first: Longs1, low: Ints1, high: Ints1, inner: Flags1,
    zone_first: Longs1, zone_low: Ints1, zone_high: Ints1, zone_inner: Flags1,
    facts: Floats1,
) -> int:  # fmt: skip
    """`shortcut` of a route at its price, in place; how many points are left."""
    columns = price.shape[0], price.shape[1]
    runs, zones = Runs(columns, first, low, high, inner), Runs(columns, zone_first, zone_low, zone_high, zone_inner)
    bounds = bounds_between(price, min_clearance / cell, runs, zones, slack)
    kept, cost, _ = straightened(points[:count], origin, cell, bounds, price, price.min())
    points[: len(kept)] = points[:count][kept]
    facts[COST] = cost * cell
    return len(kept)


@compiled
def field(
    occupied: Flags3, blocked: Flags3, cell: float, origin: Floats1, start: Floats1, goal: Floats1, free: bool,
    push: float, reach: float, step: float, most: int, points: Floats2, facts: Floats1,
) -> int:  # fmt: skip
    """`potential_field` from centre to centre, over the grid or freely; how many points."""
    forces = Field(occupied, blocked, cell, goal - origin, True, 1.0, push, reach, False)
    if free:
        way, outcome = walk_freely(forces, start - origin, step, most)
        way = way + origin
    else:
        first = np.floor((start - origin) / cell).astype(np.int64)
        last = np.floor((goal - origin) / cell).astype(np.int64)
        nodes, outcome = walk_lattice(forces, first, last, most)
        way = origin + cell * (nodes + 0.5)
    count = min(len(way), len(points))
    points[:count] = way[:count]
    facts[EXPANDED], facts[OUTCOME] = len(way) - 1, outcome
    facts[COST] = legs_of(way)[0][-1] if outcome == ARRIVED else np.inf
    return len(way)


@compiled
def least_risk(
    blocked: Flags3, price: Floats2, climb: Flags1, turn: Flags2, start: int, goal: int, origin: Floats1, cell: float,
    points: Floats2, facts: Floats1,
) -> int:  # fmt: skip
    """`least_risk` between two codes, with its limits of turns and climbs; how many points, 0 if there is no way."""
    query = RiskQuery(blocked, price, climb, turn, start, goal)
    rest, expanded = rest_of_cost(query, start, waiting_list(blocked.size))
    facts[COST], facts[EXPANDED] = np.inf, expanded
    if rest[start] == np.inf:
        return 0
    states = blocked.size * STATES
    g, parent = np.empty(states), np.zeros(states, np.uint8)
    last, more = search_states(query, rest, g, parent, waiting_list(states))
    facts[EXPANDED] += more
    if last < 0:
        return 0
    nodes = trace_states(query, parent, last)
    found = nodes, 0.0, expanded + more, nodes[:0]
    count = written(found, blocked, origin, cell, points, np.empty(0, np.int32), facts)
    facts[COST] = g[last]  # its prices are per cell
    return count


@compiled
def measure(
    points: Floats2, count: int, clearance: Floats3, first: Longs1, low: Ints1, high: Ints1, inner: Flags1,
    origin: Floats1, cell: float, facts: Floats1,
) -> float:  # fmt: skip
    """Length of a way [m], and its least distance to obstacles."""
    runs = Runs((clearance.shape[0], clearance.shape[1]), first, low, high, inner)
    way = points[:count]
    facts[NEAREST] = cell * least_clearance(runs, clearance, cell, (way - origin) / cell)
    return legs_of(way)[0][-1]


@compiled
def integral(points: Floats2, count: int, values: Floats3, origin: Floats1, cell: float) -> float:
    """`Route.integral` of values that hold for whole voxels."""
    cells, total = (points[:count] - origin) / cell, 0.0
    for n in range(count - 1):
        total += line_price(values, 0.0, cells[n], cells[n + 1], np.inf)
    return cell * total


@compiled
def curve(
    control: Floats2, count: int, step: float, bank: float, clearance: Floats3,
    first: Longs1, low: Ints1, high: Ints1, inner: Flags1, origin: Floats1, cell: float,
    points: Floats2, bend: Floats1, facts: Floats1,
) -> int:  # fmt: skip
    """A cubic B-spline through both ends of its control points: how many points; `bend` their curvature, level."""
    padded = np.empty((count + 2, 3))
    padded[1:-1] = control[:count]
    padded[0], padded[-1] = mirrored(control[0], control[1]), mirrored(control[count - 1], control[count - 2])
    parameter = steps_on(padded, step)
    if len(parameter) > len(points):
        return len(parameter)
    way, velocity = points_at(padded, parameter, 0), points_at(padded, parameter, 1)
    acceleration = points_at(padded, parameter, 2)
    way[0], way[-1] = control[0], control[count - 1]
    bends = bends_at(way, velocity, acceleration)
    for n in range(len(way)):
        points[n] = way[n]
        bend[n] = np.hypot(bends[n, 0], bends[n, 1])
    runs = Runs((clearance.shape[0], clearance.shape[1]), first, low, high, inner)
    cells = (way - origin) / cell
    apart = segment_clearances(runs, clearance, cell, cells[:-1], cells[1:], np.full(len(way) - 1, np.inf))
    off = sagittas(way, velocity, acceleration, parameter)
    least = np.inf
    for n in range(len(off)):
        least = min(least, max(cell * apart[n] - off[n], 0.0))
    facts[NEAREST], facts[COST], facts[BEND] = least, legs_of(way)[0][-1], bend[: len(way)].max()
    facts[FASTEST] = speed_in_turn(facts[BEND], bank)
    facts[STEEPEST] = np.abs(tangents_of(velocity)[:, 2]).max()
    return len(way)


@compiled
def strongest(mean: float, deviation: float) -> float:
    """`strongest_gust` [m/s]."""
    return strongest_gust(mean, deviation)


@compiled
def fly(
    points: Floats2, count: int, speed: float, wind: Floats1, deviation: float, correlation: float, craft: Floats1,
    time_step: float, every: int, touching: float, near_goal: float, occupied: Flags3, clearance: Floats3,
    first: Longs1, low: Ints1, high: Ints1, inner: Flags1, origin: Floats1, cell: float,
    state: Words1, log: Floats2, facts: Floats1,
) -> int:  # fmt: skip
    """A flight of `fly` in a wind with memory, by an autopilot that knows the mean; how many rows it would log.

    `craft` is the vehicle and its autopilot, see `uavlab.web.craft.CRAFT`; `state` that of the flight's generator.
    """
    c = craft
    vehicle = Vehicle(c[0], c[16], c[2], c[17], c[18], c[19])
    path = plan(points[:count].copy(), np.full(count - 1, speed), wind, vehicle)
    entering = np.array([c[13], c[13], c[14]])
    body = Body(c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7], c[8], wind, c[9], c[10], c[11], c[12], entering, c[15])
    air = air_with_memory(wind, deviation * GUST_SHARES, correlation, time_step)
    runs = Runs((clearance.shape[0], clearance.shape[1]), first, low, high, inner)
    obstacles = Obstacles(occupied, runs, clearance, origin, cell, touching, near_goal)
    course, now = Course(path, obstacles, time_step), start_of(path.points[0])
    most = most_steps(path, body.pace, time_step)
    rows, rng = np.empty((most // every + 4, 12)), Stream(state)
    steps, outcome = most + 1, FLYING
    while outcome == FLYING and now.counts[0] <= most + 1:  # where it is out of time, one more step is logged
        outcome = fly_on(body, air, course, now, steps, every, rng, rows)
        steps, every = 1, 1
    logged = now.counts[1]
    kept = min(logged, len(log))
    log[:kept] = rows[:kept]
    log[kept - 1] = rows[logged - 1]
    facts[OUTCOME], facts[STEPS], facts[NEAREST] = outcome, logged, now.sums[LEAST]
    facts[ENERGY] = now.sums[BATTERY]
    return logged
