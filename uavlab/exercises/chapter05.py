"""Exercises of chapter 5, A*: the proof, the octile distance, legal moves, a search to repair, a price, and a trap.

A hint says which mistake the answers look like and why it is one. Mistakes are recognised by what they answer, not
by how they are written.
"""

from __future__ import annotations

import heapq
import itertools
import math
import operator
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from uavlab.exercises.hints import each_alike, recognised, recognised_value
from uavlab.exercises.kinds import Quiz, asks_for, asks_for_value, described, is_number, number, thing, truth

Move = tuple[int, ...]
Graph = Mapping[Any, Mapping[Any, float]]

MOVES: list[Move] = [move for move in itertools.product((-1, 0, 1), repeat=3) if any(move)]


exercise_1 = Quiz(
    right="c",
    because="Whatever the other route is, its first node that isn't closed waits, and its f was not below 66.4 m.",
    wrong={
        "a": "A node that waits may be 2 m from the start, if the goal lies on the other side. By what does A* order "
        "the nodes that wait: by g alone?",
        "b": "Then A* would have nothing to gain over a search of everything. Most of the city was never looked at. "
        "What does the proof say about them?",
        "d": "An estimate that is exact everywhere would lead straight to the goal, and nobody has one. Which weaker "
        "property did the proof use?",
    },
)


@asks_for(number("the length of the way [cells]"))
def exercise_2(octile: Callable[[int, int, int], float]) -> str:
    """05.2: the shortest way over 26 moves on an empty map, from the differences of the coordinates."""
    sorted_ahead = [(5, 3, 1), (7, 7, 2), (9, 4, 4), (6, 0, 0), (3, 3, 3), (8, 2, 0), (0, 0, 0)]
    if is_octile(octile, sorted_ahead):
        shuffled = [order for offset in sorted_ahead for order in itertools.permutations(offset)]
        if not is_octile(octile, shuffled):
            return "It is right where |dx| ≥ |dy| ≥ |dz|. The goal may lie anywhere: which of the three is largest?"
        mirrored = [tuple(s * d for s, d in zip(sign, o, strict=True)) for sign in MOVES for o in shuffled if all(sign)]
        if not is_octile(octile, mirrored):
            return (
                "It is right for goals to the north-east and above. What are dx, dy, dz when the goal lies to the west?"
            )
        return ""
    return recognised(octile, OCTILE_MISTAKES, sorted_ahead, partial(same_at, offsets=sorted_ahead)) or (
        f"For (5, 3, 1) you get {octile(5, 3, 1):.3f}. Which five moves make the shortest way, and how long are they?"
    )


def same_at(octile: Callable[..., float], wanted: Sequence[float], offsets: Sequence[Move]) -> bool:
    """Whether a function gives these distances; it is asked no further than the first that is wrong."""
    given = itertools.starmap(octile, offsets)
    return each_alike(given, wanted, partial(math.isclose, rel_tol=1e-9, abs_tol=1e-9))


def is_octile(octile: Callable[..., float], offsets: Sequence[Move]) -> bool:
    return same_at(octile, [octile_distance(*offset) for offset in offsets], offsets)


def octile_distance(dx: int, dy: int, dz: int) -> float:
    c, b, a = sorted((abs(dx), abs(dy), abs(dz)))
    return math.sqrt(3) * c + math.sqrt(2) * (b - c) + (a - b)


OCTILE_MISTAKES: list[tuple[Callable[[int, int, int], float], str]] = [
    (math.hypot,
     "That is the straight distance. It is never too high, but (2, 1, 0) shows that no two moves are as short: "
     "count in moves."),
    (lambda a, b, c: a + b + c,
     "That counts straight moves only. It is too high: (1, 1, 1) is one move away, and you charge three."),
    (lambda a, b, c: a,
     "That is the number of moves. They are not equally long: how long is one through a corner?"),
    (lambda a, b, c: a + (math.sqrt(2) - 1) * b,
     "You get the same for (5, 3, 1) as for (5, 3, 0). That is the octile distance of a plane: where is the height?"),
    (lambda a, b, c: a + math.sqrt(2) * b + math.sqrt(3) * c,
     "Too high: a move through a corner goes forward in all three directions at once. How much of the other two "
     "is left after c of them?"),
    (lambda a, b, c: math.sqrt(2) * c + math.sqrt(3) * (b - c) + (a - b),
     "Almost: which move is √2 long, and which one √3?"),
]  # fmt: skip


@asks_for(truth("whether the move is legal"))
def exercise_3(legal: Callable[[np.ndarray, Move, Move], bool]) -> str:
    """05.3: whether a move is legal: every voxel of its bounding box lies in the map and is free."""
    rng = np.random.default_rng(62)
    maps = [rng.random((5, 5, 5)) < share for share in (0.1, 0.2, 0.3)]
    cases = [
        (occupied, (i, j, k), move)
        for occupied in maps
        for i, j, k in np.argwhere(~occupied).tolist()
        for move in MOVES
    ]
    within = [case for case in cases if is_inside(case[0], target_of(*case[1:]))]
    beyond = [case for case in cases if not is_inside(case[0], target_of(*case[1:]))]
    answers = [bool(legal(*case)) for case in within]
    if answers != [box_is_free(*case) for case in within]:
        if hint := recognised(answers, LEGAL_MISTAKES, within, operator.eq):
            return hint
        wrong = next(case for case, answer in zip(within, answers, strict=True) if answer != box_is_free(*case))
        blocked = int(sum(wrong[0][voxel] for voxel in box_of(*wrong[1:])))
        return (
            f"From {wrong[1]} by {wrong[2]} there are {blocked} occupied voxels in the move's bounding box of "
            f"{len(box_of(*wrong[1:]))}, and you say {not box_is_free(*wrong)}."
        )
    try:
        allowed = [case for case in beyond if legal(*case)]
    except IndexError:
        return "Inside of the map it is right. At its upper borders it raises IndexError: is the target on the map?"
    if allowed:
        node, move = allowed[0][1:]
        return (
            f"Inside of the map it is right. But you let the UAV leave it: from {node} by {move} is no voxel. "
            "(To NumPy the index −1 is the last voxel, on the far side.)"
        )
    return ""


def target_of(node: Move, move: Move) -> Move:
    return node[0] + move[0], node[1] + move[1], node[2] + move[2]


def is_inside(occupied: np.ndarray, voxel: Move) -> bool:
    return all(0 <= index < size for index, size in zip(voxel, occupied.shape, strict=True))


def box_of(node: Move, move: Move) -> list[Move]:
    """The voxels of a move's bounding box."""
    return [target_of(node, part) for part in itertools.product(*({0, d} for d in move))]


def box_is_free(occupied: np.ndarray, node: Move, move: Move) -> bool:
    return not any(occupied[voxel] for voxel in box_of(node, move))


def faces_are_free(occupied: np.ndarray, node: Move, move: Move) -> bool:
    """The target and the voxels across the faces that the move leaves by, but not those across edges."""
    faces = [target_of(node, (move[0], 0, 0)), target_of(node, (0, move[1], 0)), target_of(node, (0, 0, move[2]))]
    return not any(occupied[voxel] for voxel in [*faces, target_of(node, move)])


LEGAL_MISTAKES: list[tuple[Callable[[np.ndarray, Move, Move], bool], str]] = [
    (lambda occupied, node, move: not occupied[target_of(node, move)],
     "You look at the voxel where the move ends, and nowhere else: that cuts corners. Which voxels does a "
     "diagonal move touch on its way?"),
    (faces_are_free,
     "Straight and diagonal moves are right. A move through a corner passes edges, too: its bounding box has eight "
     "voxels, you look at five of them."),
    (lambda occupied, node, move: not box_is_free(occupied, node, move),
     "It is the wrong way round: `occupied` is True where there is an obstacle."),
]  # fmt: skip


def zero(place: Any) -> float:
    """An estimate that knows nothing."""
    return 0.0


TRAPS: list[tuple[Graph, str, Callable[[Any], float], float, str]] = [
    ({"a": {"b": 1.0}, "b": {"c": 1.0}, "c": {}}, "c", {"a": 2.0, "b": 1.0, "c": 0.0}.__getitem__, 2.0,
     "The only way is a–b–c, twice 1 long, and the estimate is exact: your cost is {}. "
     "What has been added to g that is no road?"),
    ({"a": {"b": 1.0, "c": 4.0}, "b": {"d": 3.0}, "c": {"d": 1.0}, "d": {}}, "d",
     {"a": 4.0, "b": 3.0, "c": 1.0, "d": 0.0}.__getitem__, 4.0,
     "a–b–d is 1 + 3 long, a–c–d is 4 + 1: your cost is {}. c is nearer to the goal than b, but the way to "
     "it is longer. In which order do nodes come out of the open list?"),
    ({"a": {"b": 5.0, "c": 1.0}, "b": {"d": 1.0}, "c": {"b": 1.0}, "d": {}}, "d", zero, 3.0,
     "a–b is 5, a–c and c–b are 1 each, b–d is 1: your cost from a to d is {}. "
     "The direct way to b is found first. What happens when a better one turns up while b still waits?"),
    ({"a": {"c": 10.0, "b": 1.0}, "b": {"c": 1.0}, "c": {}}, "c", zero, 2.0,
     "a–c is 10, a–b and b–c are 1 each: your cost from a to c is {}. When is the way to the goal known to "
     "be the cheapest: when the goal is put into the open list, or when it is taken out?"),
    ({"a": {}, "b": {}}, "b", zero, math.inf,
     "Where there is no way the cost is infinite: return math.inf when the open list is empty."),
]  # fmt: skip
"""Roads, the goal, an estimate, the cost from a, and what a search with another cost should be asked."""


@asks_for(number("the cost of the cheapest way, math.inf where there is none"))
def exercise_4(search: Callable[[Graph, Any, Any, Callable[[Any], float]], float]) -> str:
    """05.4: the cost of the cheapest way through a graph, by an A* that is right."""
    for roads, goal, estimate_of, right, hint in TRAPS:
        cost = search(roads, "a", goal, estimate_of)
        if cost != right:
            return hint.format(cost)
    asked: list[Any] = []
    for seed in range(40):
        graph, distance = random_roads(seed)

        def estimate(place: Any, distance: Mapping[Any, float] = distance) -> float:
            asked.append(place)
            return distance[place]

        cost, cheapest = search(graph, 0, 11, estimate), cheapest_way(graph, 0, 11)
        if not math.isclose(cost, cheapest, rel_tol=1e-9):
            return (
                f"On a map of 12 places the cheapest way costs {cheapest:.3f}, yours {cost:.3f}. Go through the proof "
                "in the notebook: which step doesn't hold for your search?"
            )
    if not asked:
        return (
            "All costs are right, but your search never asks for the estimate. That is Dijkstra's: it looks at every "
            "place that is nearer than the goal. Where does h belong, so that it is A*?"
        )
    return ""


def random_roads(seed: int) -> tuple[Graph, dict[int, float]]:
    """Roads between 12 random places, and the straight distance from each to the last."""
    rng = np.random.default_rng(seed)
    places = rng.random((12, 2))
    graph: dict[int, dict[int, float]] = {place: {} for place in range(12)}
    for one, other in itertools.combinations(range(12), 2):
        if rng.random() < 0.4:
            graph[one][other] = graph[other][one] = float(math.dist(places[one], places[other]) * rng.uniform(1, 2))
    return graph, {place: math.dist(places[place], places[11]) for place in range(12)}


def cheapest_way(graph: Graph, start: Any, goal: Any) -> float:
    """Cost of the cheapest way: as many rounds over all roads as there are places (Bellman and Ford)."""
    cost = dict.fromkeys(graph, math.inf) | {start: 0.0}
    for _ in graph:
        for place, roads in graph.items():
            for neighbour, length in roads.items():
                cost[neighbour] = min(cost[neighbour], cost[place] + length)
    return cost[goal]


FIRST, TIPPING = 0.1597, math.sqrt(2) - 1
"""ω at which the route out of the notch leaves the wall, and at which it keeps 2.5 m: ΔL/ΔZ of the routes there are."""
NEAR = 0.01


@asks_for_value(number("the least ω at which the route keeps 2.5 m"))
def exercise_5(omega: float) -> str:
    """05.5: from which ω on the route out of the notch keeps 2.5 m."""
    value = float(omega)
    if abs(value - TIPPING) <= NEAR:
        return ""
    if hint := recognised_value(value, TIPPING_MISTAKES, absolute=NEAR):
        return hint
    if not value > 0:
        return "ω is a price, so it is above 0. At 0 the route is the shortest, which scrapes along the wall."
    if value > TIPPING:
        return f"At ω = {value:g} the route keeps 2.5 m. But it does so at a smaller ω, too. Try the values below."
    return f"At ω = {value:g} the route doesn't keep 2.5 m yet: look at its least clearance."


TIPPING_MISTAKES: list[tuple[float, str]] = [
    (FIRST, "There the route changes for the first time. What is the least clearance of the route that it changes to?"),
    (0.331, "That is where 3.5 m are kept. Here the zone is 2.5 m wide, so it holds fewer metres."),
    (0.2335, "That compares the shortest route with the safe one. Is there no third route that is cheaper than both?"),
    (1 / TIPPING, "That is metres in the zone per metre of detour. ω is the other way round: the detour that one of "
     "them is worth."),
    (1.757, "That is a difference of lengths in metres. How many metres in the zone does this detour avoid?"),
]  # fmt: skip

LONGER, MOST_PLACES = 1.1, 8


@asks_for_value(thing(tuple, "a pair, (roads, estimate)"))
def exercise_6(trap: tuple[Any, Any]) -> str:
    """05.6: a map and an admissible estimate on which a search that never reopens a place is wrong."""
    if len(trap) != 2:
        return f"Your tuple has {len(trap)} parts. There are two: (roads, estimate)."
    roads, estimate = trap
    if hint := wrong_roads(roads) or wrong_estimate(roads, estimate):
        return hint
    rest = {place: cheapest_way(roads, place, "goal") for place in roads}
    for place in roads:
        if not 0 <= float(estimate[place]) <= rest[place] + 1e-9:
            return (
                f"Your estimate at {place!r} is {float(estimate[place]):g}, and the true rest of the way is "
                f"{rest[place]:g}: it isn't admissible."
            )
    shortest = rest["start"]
    if math.isinf(shortest):
        return "From start no way leads to goal: what should be found?"
    found, falls = hasty_way(roads, estimate), steepest(roads, estimate)
    if found >= LONGER * shortest - 1e-9:
        return ""
    if falls is None:
        return (
            "Your estimate is consistent: along no road does it fall by more than the road is long. Then no place has "
            "to be reopened, and the program is right. Where could it fall by more?"
        )
    if found > shortest + 1e-9:
        return (
            f"The program goes wrong, but not by enough: it finds {found:g}, and the shortest way is {shortest:g}. "
            "Make the roads of the wrong way longer, or the right ones shorter."
        )
    return (
        f"From {falls[0]!r} to {falls[1]!r} your estimate falls by more than the road is long. That is needed. But the "
        f"program still finds the shortest way, {shortest:g}. Which place must it close before the right road to it is "
        "found?"
    )


def wrong_roads(roads: Any) -> str:
    """What is wrong with a map of roads, if anything."""
    if not isinstance(roads, Mapping) or not all(isinstance(ways, Mapping) for ways in roads.values()):
        return 'The first part is a dictionary of dictionaries: roads["start"]["bridge"] is a length.'
    if not all(isinstance(place, str) for place in roads):
        return "Call the places by texts, such as 'bridge'."
    for name in ("start", "goal"):
        if name not in roads:
            return f"No place is called {name!r}. The goal needs an entry, too, if only an empty one."
    if len(roads) > MOST_PLACES:
        return f"There are {len(roads)} places; {MOST_PLACES} are allowed, and half of them are enough."
    for place, ways in roads.items():
        for neighbour, length in ways.items():
            if neighbour not in roads:
                return f"A road leads from {place!r} to {neighbour!r}, but roads has no entry for {neighbour!r}."
            if not is_number(length) or not 0 < float(length) < math.inf:
                return f"The road from {place!r} to {neighbour!r} needs a length above 0."
    return ""


def wrong_estimate(roads: Graph, estimate: Any) -> str:
    """What is wrong with an estimate, before it is looked at closely."""
    if not isinstance(estimate, Mapping):
        return f"The second part is a dictionary with the estimate of each place; you have {described(estimate)}."
    for place in roads:
        if place not in estimate or not is_number(estimate[place]) or math.isnan(float(estimate[place])):
            return f"The estimate of {place!r} is missing, or no number."
    return ""


def steepest(roads: Graph, estimate: Mapping[Any, float]) -> tuple[Any, Any] | None:
    """The first road along which an estimate falls by more than the road is long."""
    for place, ways in roads.items():
        for neighbour, length in ways.items():
            if estimate[place] - estimate[neighbour] > length + 1e-9:
                return place, neighbour
    return None


def hasty_way(roads: Graph, estimate: Mapping[Any, float]) -> float:
    """Cost of the way that an A* finds which never reopens a place."""
    g: dict[Any, float] = {"start": 0.0}
    closed: set[Any] = set()
    open_list: list[tuple[float, Any]] = [(float(estimate["start"]), "start")]
    while open_list:
        _, place = heapq.heappop(open_list)
        if place == "goal":
            return g[place]
        if place in closed:
            continue
        closed.add(place)
        for neighbour, length in roads[place].items():
            if neighbour not in closed and g[place] + length < g.get(neighbour, math.inf):
                g[neighbour] = g[place] + length
                heapq.heappush(open_list, (g[neighbour] + float(estimate[neighbour]), neighbour))
    return math.inf
