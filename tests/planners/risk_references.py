"""What routes on risk maps are held against: limits, costs, SciPy's Dijkstra over states; and small maps."""

import itertools
from collections import defaultdict, deque

import numpy as np

from uavlab.city import Building, City
from uavlab.risk import RiskMap, random_campus, reference_campus

OFFSETS = [offset for offset in itertools.product((-1, 0, 1), repeat=3) if any(offset)]
ANY_LIMITS = {"max_turn": np.pi, "max_pitch": np.pi / 2}
WEIGHTS = [
    {},
    {"risk_weight": 0.0, "length_weight": 1.0},
    {"risk_weight": 0.0, "threat_weight": 1.0},
    {"risk_weight": 0.0, "length_weight": 0.5, "threat_weight": 0.2},
    {"risk_weight": 1e6, "length_weight": 0.3, "threat_weight": 0.1},
    {"drift": True},
    {"risk_weight": 3e6, "length_weight": 0.1, "drift": True},
]


def angle_between(one, other):
    """Between two directions in the plane [rad], by the scalar product."""
    return np.arccos(np.clip(np.dot(one, other) / np.linalg.norm(one) / np.linalg.norm(other), -1, 1))


def prices(risk_map, *, risk_weight=1.0, length_weight=0.0, threat_weight=0.0, drift=False):
    """Cost per cell, one row for each offset (26, nodes)."""
    rate = risk_map.rate_ahead if drift else np.broadcast_to(risk_map.rate, (26, *risk_map.city.shape))
    threats = risk_map.threat if threat_weight else 0.0
    return (risk_weight * rate + length_weight * risk_map.city.cell + threat_weight * threats).reshape(26, -1)


def allowed(risk_map, min_clearance=0.0):
    return risk_map.flyable & (risk_map.city.clearance >= min_clearance - 1e-9)


def random_map(rng):
    """A small map with buildings, floating voxels, and layers of all kinds; in places there is nobody at all."""
    shape = rng.integers(3, 9, 3)
    cell, origin = rng.uniform(0.5, 5), rng.uniform(-100, 100, 3)
    buildings = []
    for number in range(rng.integers(1, 4)):
        low = origin[:2] + rng.uniform(0, 0.8, 2) * shape[:2] * cell
        (x0, y0), (x1, y1) = low, low + rng.uniform(1, 2.5, 2) * cell
        outline = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
        top = origin[2] + rng.uniform(0.5, 1.0) * shape[2] * cell
        buildings.append(Building.prism(outline, top, bottom=origin[2], name=f"block {number}"))
    solid = City.from_buildings(buildings, cell=cell, origin=origin, size=shape * cell).occupied
    city = City(solid | (rng.random(shape) < rng.uniform(0, 0.3)), cell, origin, tuple(buildings))
    return RiskMap(
        city,
        10 ** rng.uniform(-4, -1.5, shape[:2]) * (rng.random(shape[:2]) >= 0.2),
        rng.choice((0, 0.25, 0.5, 0.75, 1), shape[:2]),
        rng.random(shape[:2]) * 1e-4 * (rng.random(shape[:2]) < 0.3),
        safe_height=rng.choice((0.0, 1.0, 2.0)) * cell,
        min_height=rng.choice((0.0, 1.0)) * cell,
    )


def random_case(seed):
    """A random map, limits, and a start and a goal that keep them."""
    rng = np.random.default_rng(seed)
    while True:
        risk_map = random_map(rng)
        limits = {
            "max_turn": np.radians(rng.choice((0, 45, 60, 90, 135, 180))),
            "max_pitch": np.radians(rng.choice((0, 36, 45, 60, 90, 90))),
            "min_clearance": rng.choice((0.0, 0.0, 0.5, 1.0)) * risk_map.city.cell,
        }
        free = np.argwhere(allowed(risk_map, limits["min_clearance"]))
        if len(free) > 1:
            return risk_map, limits, risk_map.city.center_of(rng.permutation(free)[:2])


def code(risk_map, point):
    return int(risk_map.city.code_of(risk_map.city.cell_of(point)))


def keeps_limits(risk_map, route, *, max_turn, max_pitch, min_clearance=0.0):
    """Whether all voxels along the route, and all of the boxes of its moves, may be flown, and all angles kept."""
    city, free = risk_map.city, allowed(risk_map, min_clearance)
    index = city.cell_of(route.points)
    boxes = [
        free[tuple(slice(min(a, b), max(a, b) + 1) for a, b in zip(here, there, strict=True))].all()
        for here, there in itertools.pairwise(index.tolist())
    ]
    return (
        free[tuple(city.voxels_along(route.points)[0].T)].all()
        and all(boxes)
        and np.array_equal(route.points, city.center_of(index))
        and (np.abs(np.diff(index, axis=0)).max(axis=1) == 1).all()
        and (route.turn <= max_turn + 1e-9).all()
        and (np.abs(route.pitch) <= max_pitch + 1e-9).all()
    )


def cost_along(risk_map, route, *, risk_weight=1.0, length_weight=0.0, threat_weight=0.0, drift=False):
    """w_r·∫ r ds/dx + w_l·L + w_s·∫ threat ds/dx, measured on the route."""
    threats = route.integral(risk_map.city, risk_map.threat) / risk_map.city.cell
    return risk_weight * risk_map.integral(route, drift=drift) + length_weight * route.length + threat_weight * threats


def campus(number):
    """The reference campus, number 0, and random ones."""
    return random_campus(number) if number else reference_campus()


def made_of(occupied, **heights):
    """Voxels of 2 m, one person per 100 m², and no heights to keep but the given ones."""
    return RiskMap(City(occupied, 2.0), 0.01, 0.5, **({"safe_height": 0.0} | heights))


def corridor(*, basement=False, **heights):
    """One voxel wide and high, to the east, then north; with a basement everything below is free."""
    occupied = np.ones((6, 3, 2 if basement else 1), bool)
    occupied[:, 0, -1] = occupied[5, :, -1] = False
    occupied[..., :-1] = False
    return made_of(occupied, **heights)


ROUND_THE_BEND, THROUGH_THE_WALL = ((1, 1, 1), (11, 5, 1)), ((1, 7, 7), (17, 7, 7))


COMPASS = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)]
UNDECIDED = len(COMPASS)  # the heading before the first leg that isn't vertical


def headings_after(heading, offset, max_turn):
    """The heading after a move, as a list; an empty one where the move would turn too far."""
    if offset[:2] == (0, 0):
        return [heading]
    turns = heading != UNDECIDED and angle_between(COMPASS[heading], offset[:2]) > max_turn + 1e-6
    return [] if turns else [COMPASS.index(offset[:2])]


def ways(flyable, max_turn, max_pitch):
    """All moves between states, from the definition: states before and after, and the number of the offset."""
    node = np.arange(flyable.size).reshape(flyable.shape)
    before, after, moves = [], [], []
    for number, offset in enumerate(OFFSETS):
        if abs(offset[2]) / np.linalg.norm(offset) > np.sin(max_pitch) + 1e-6:
            continue
        here = tuple(slice(max(-o, 0), n - max(o, 0)) for o, n in zip(offset, flyable.shape, strict=True))
        free = np.ones(node[here].shape, bool)
        for corner in itertools.product(*({0, o} for o in offset)):
            free &= flyable[tuple(slice(s.start + c, s.stop + c) for s, c in zip(here, corner, strict=True))]
        there = tuple(slice(s.start + o, s.stop + o) for s, o in zip(here, offset, strict=True))
        for heading in range(UNDECIDED + 1):
            for turned in headings_after(heading, offset, max_turn):
                before.append(9 * node[here][free] + heading)
                after.append(9 * node[there][free] + turned)
                moves.append(np.full(free.sum(), number))
    return tuple(np.concatenate(parts) if parts else np.empty(0, int) for parts in (before, after, moves))


def costs_of(moves, price):
    """Cost of each of the moves that `ways` gives: half of the way in each voxel."""
    before, after, number = moves
    return np.linalg.norm(OFFSETS, axis=1)[number] * (price[number, before // 9] + price[number, after // 9]) / 2


def tradeoffs(moves, price, lengths, source, target):
    """All (cost, length) of routes that no other route beats in both, by exhaustive label correction, by length."""
    onward = defaultdict(list)
    for before, after, cost, length in zip(*moves[:2], costs_of(moves, price), lengths[moves[2]], strict=True):
        onward[before].append((after, cost, length))
    kept = defaultdict(list)
    kept[9 * source + UNDECIDED] = [(0.0, 0.0)]
    waiting = deque([(9 * source + UNDECIDED, 0.0, 0.0)])
    while waiting:
        state, cost, length = waiting.popleft()
        if (cost, length) not in kept[state]:
            continue
        for after, more, way in onward[state]:
            new = cost + more, length + way
            if not any(c <= new[0] * (1 + 1e-12) and w <= new[1] + 1e-9 for c, w in kept[after]):
                kept[after] = [(c, w) for c, w in kept[after] if c < new[0] or w < new[1]] + [new]
                waiting.append((after, *new))
    ends = [label for heading in range(9) for label in kept[9 * target + heading]]
    ends.sort(key=lambda label: (round(label[1], 6), label[0]))  # equal lengths, added up in another order, are equal
    return [(c, w) for n, (c, w) in enumerate(ends) if all(c < other * (1 - 1e-12) for other, _ in ends[:n])]


def constrained_case(seed):
    """A tiny map, with all its trade-offs between risk and length [m]; some cannot be crossed."""
    rng = np.random.default_rng(seed)
    occupied = rng.random((5, 5, 3)) < rng.choice((0.05, 0.25))
    occupied[0, 0, 1] = occupied[4, 4, 1] = False
    city = City(occupied, rng.uniform(0.5, 5), rng.uniform(-100, 100, 3))
    risk_map = RiskMap(city, 10 ** rng.uniform(-4, -1.5, (5, 5)), rng.choice((0, 0.5, 1), (5, 5)), safe_height=0.0)
    limits = {
        "max_turn": np.radians(rng.choice((45, 90, 180))),
        "max_pitch": np.radians(rng.choice((0, 60, 90))),
        "drift": bool(rng.random() < 0.3),
    }
    ends = city.center_of([(0, 0, 1), (4, 4, 1)])
    moves = ways(risk_map.flyable, limits["max_turn"], limits["max_pitch"])
    lengths = np.linalg.norm(OFFSETS, axis=1) * city.cell
    codes = [code(risk_map, end) for end in ends]
    return risk_map, ends, limits, tradeoffs(moves, prices(risk_map, drift=limits["drift"]), lengths, *codes)
