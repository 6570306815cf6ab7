"""Exercises of chapter 05: other ways to the answer pass; typical mistakes fail, each with a hint of its own."""

import heapq
import itertools
import math

import numpy as np
import pytest

from uavlab.exercises import chapter05, check


def octile_of_largest_first(dx, dy, dz):
    return math.sqrt(3) * abs(dz) + math.sqrt(2) * (abs(dy) - abs(dz)) + abs(dx) - abs(dy)


def octile_without_abs(dx, dy, dz):
    c, b, a = sorted((dx, dy, dz))
    return math.sqrt(3) * c + math.sqrt(2) * (b - c) + a - b


def box(node, move):
    return [tuple(np.add(node, part)) for part in itertools.product(*({0, d} for d in move))]


def on_map(occupied, node, move):
    return all(0 <= a + d < size for a, d, size in zip(node, move, occupied.shape, strict=True))


def cuts_corners(occupied, node, move):
    return on_map(occupied, node, move) and not occupied[tuple(np.add(node, move))]


def forgets_edges(occupied, node, move):
    faces = [tuple(d if a == axis else 0 for a, d in enumerate(move)) for axis in range(3)]
    return on_map(occupied, node, move) and not any(occupied[tuple(np.add(node, part))] for part in [*faces, move])


def wraps_around(occupied, node, move):
    return not any(occupied[tuple(np.mod(voxel, occupied.shape))] for voxel in box(node, move))


def falls_off(occupied, node, move):
    return not any(occupied[voxel] for voxel in box(node, move))


def turned_round(occupied, node, move):
    return on_map(occupied, node, move) and any(occupied[voxel] for voxel in box(node, move))


def search(
    graph, start, goal, estimate, *, better=True, leak=False, early=False, greedy=False, weight=1.0, none=math.inf
):
    """An A* that can be broken in several ways."""
    g, open_list = {start: 0.0}, [(estimate(start), start)]
    closed = set()
    while open_list:
        f, place = heapq.heappop(open_list)
        if place == goal:
            return g[goal]
        if place in closed:
            continue
        closed.add(place)
        for neighbour, length in graph[place].items():
            cost = (f if leak else g[place]) + length
            if neighbour not in g or (better and cost < g[neighbour]):
                g[neighbour] = cost
                if early and neighbour == goal:
                    return cost
                heapq.heappush(open_list, (weight * estimate(neighbour) + (0 if greedy else cost), neighbour))
    return none


def broken(**mistake):
    return lambda *question: search(*question, **mistake)


TOWN = {"start": {"bridge": 3, "market": 1}, "market": {"bridge": 1}, "bridge": {"goal": 3}, "goal": {}}


def trap(market=4, bridge=0, start=0, goal=0, **longer):
    """A map and an estimate; `longer` changes roads as in start_bridge=4."""
    roads = {place: dict(ways) for place, ways in TOWN.items()}
    for road, length in longer.items():
        one, other = road.split("_")
        roads[one][other] = length
    return roads, {"start": start, "market": market, "bridge": bridge, "goal": goal}


MISTAKES = {
    "05.2": {
        "the straight distance": math.hypot,
        "straight moves only": lambda *d: sum(map(abs, d)),
        "not equally long": lambda *d: max(map(abs, d)),
        "where is the height": lambda *d: max(map(abs, d)) + (2**0.5 - 1) * sorted(map(abs, d))[1],
        "is left after c of them": lambda *d: np.dot(sorted(map(abs, d)), (3**0.5, 2**0.5, 1)),
        "which one √3": lambda *d: np.dot(np.diff(sorted(map(abs, d)), prepend=0), (2**0.5, 3**0.5, 1)),
        "which of the three is largest": octile_of_largest_first,
        "to the west": octile_without_abs,
        "you get 7.000": lambda *d: 7.0,
        "returns text, 'six'": lambda *d: "six",
    },
    "05.3": {
        "cuts corners": cuts_corners,
        "you look at five of them": forgets_edges,
        "let the UAV leave it": wraps_around,
        "is the target on the map": falls_off,
        "wrong way round": turned_round,
        "and you say True": lambda *case: True,
        "and you say False": lambda *case: False,
    },
    "05.4": {
        "no road": broken(leak=True),
        "while b still waits": broken(better=False),
        "when it is taken out": broken(early=True),
        "math.inf where there is none": broken(none=None),
        "In which order": broken(greedy=True),
        "which step doesn't hold": broken(weight=1.5),
        "never asks for the estimate": lambda roads, start, goal, h: search(roads, start, goal, lambda place: 0.0),
    },
    "05.5": {
        "changes for the first time": 0.16,
        "That is where 3.5 m are kept": 0.33,
        "Is there no third route": 0.2335,
        "the other way round": 2.41,
        "a difference of lengths": 1.76,
        "above 0": -0.4,
        "at a smaller ω, too": 0.5,
        "look at its least clearance": 0.38,
    },
    "05.6": {
        "it isn't admissible": trap(market=4.5),
        "Your estimate is consistent": trap(market=1),
        "but not by enough": trap(start_bridge=2.1),
        "Which place must it close": trap(market=2, start_bridge=4),
        "no way leads to goal": ({"start": {}, "goal": {}}, {"start": 0, "goal": 0}),
        "is a dictionary of dictionaries": ([1, 2], {}),
        "No place is called 'goal'": ({"start": {}}, {"start": 0}),
        "needs a length above 0": trap(start_bridge=-1),
        "has no entry for 'tower'": trap(market_tower=1),
        "or no number": (TOWN, {"start": 0, "goal": 0}),
        "with the estimate of each place": (TOWN, 3),
        "half of them are enough": (TOWN | {str(n): {} for n in range(5)}, {}),
        "There are two": (1, 2, 3),
        "by texts": (TOWN | {3: {}}, {}),
    },
}


def test_two_mistakes_in_the_search_are_told_one_by_one():
    assert "no road" in check("05.4", broken(leak=True, better=False)).hint


@pytest.mark.parametrize("omega", [0.4142, 0.415, np.float64(0.42), 0.41])
def test_tipping_price_is_right_to_a_hundredth(omega):
    assert check("05.5", omega)


def test_tipping_prices_are_those_of_the_planner(solutions):
    routes = [np.array(solutions["out_of_the_notch"](omega)) for omega in (0.1, 0.3, 0.5)]
    crossings = [(b[0] - a[0]) / (a[1] - b[1]) for a, b in itertools.pairwise(routes)]
    assert crossings == pytest.approx([chapter05.FIRST, chapter05.TIPPING], abs=1e-3)
    (length, inside, _), (longest, nothing, kept) = routes[0], routes[2]
    assert (longest - length) / (inside - nothing) == pytest.approx(0.2335, abs=1e-3)
    assert kept == 2.5


@pytest.mark.parametrize("answer", [trap(), trap(start_bridge=4), trap(start=2, bridge=0.5)])
def test_other_traps_are_right(answer):
    assert check("05.6", answer)


def test_the_program_of_the_exercise_is_the_one_that_is_caught(solutions):
    for answer in (trap(), trap(market=2, start_bridge=4), trap(start_bridge=2.1), trap(market=1)):
        assert solutions["hasty"](*answer) == chapter05.hasty_way(*answer)


def test_search_without_a_mistake_is_right():
    assert check("05.4", search)


def test_search_that_returns_nothing_is_told_so():
    assert "returns nothing" in check("05.4", lambda *question: None).hint


def test_the_broken_search_of_the_exercise_is_told_what_is_wrong(solutions):
    assert solutions["search"](solutions["roads"], "harbour", "castle", solutions["left"].get) != 7
    assert "no road" in check("05.4", solutions["search"]).hint
