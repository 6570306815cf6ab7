"""Exercises of chapter 05: other ways to the answer pass; typical mistakes fail, each with a hint of its own."""

import heapq
import itertools
import math

import numpy as np
import pytest

from uavlab.exercises import check


def octile_of_largest_first(dx, dy, dz):
    return math.sqrt(3) * abs(dz) + math.sqrt(2) * (abs(dy) - abs(dz)) + abs(dx) - abs(dy)


def octile_without_abs(dx, dy, dz):
    c, b, a = sorted((dx, dy, dz))
    return math.sqrt(3) * c + math.sqrt(2) * (b - c) + a - b


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (math.hypot, "the straight distance"),
        (lambda *d: sum(map(abs, d)), "straight moves only"),
        (lambda *d: max(map(abs, d)), "not equally long"),
        (lambda *d: max(map(abs, d)) + (2**0.5 - 1) * sorted(map(abs, d))[1], "where is the height"),
        (lambda *d: np.dot(sorted(map(abs, d)), (3**0.5, 2**0.5, 1)), "is left after c of them"),
        (lambda *d: np.dot(np.diff(sorted(map(abs, d)), prepend=0), (2**0.5, 3**0.5, 1)), "which one √3"),
        (octile_of_largest_first, "which of the three is largest"),
        (octile_without_abs, "to the west"),
        (lambda *d: 7.0, "you get 7.000"),
        (lambda *d: "six", "returns text, 'six'"),
    ],
)
def test_mistakes_with_the_octile_distance(answer, hint):
    assert not check("05.2", answer)
    assert hint in check("05.2", answer).hint


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


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (cuts_corners, "cuts corners"),
        (forgets_edges, "you look at five of them"),
        (wraps_around, "let the UAV leave it"),
        (falls_off, "is the target on the map"),
        (turned_round, "wrong way round"),
        (lambda *case: True, "and you say True"),
        (lambda *case: False, "and you say False"),
    ],
)
def test_mistakes_with_legal_moves(answer, hint):
    assert not check("05.3", answer)
    assert hint in check("05.3", answer).hint


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


@pytest.mark.parametrize(
    ("mistake", "hint"),
    [
        ({"leak": True}, "no road"),
        ({"leak": True, "better": False}, "no road"),
        ({"better": False}, "while b still waits"),
        ({"early": True}, "when it is taken out"),
        ({"none": None}, "math.inf where there is none"),
        ({"greedy": True}, "In which order"),
        ({"weight": 1.5}, "which step doesn't hold"),
    ],
)
def test_mistakes_with_the_search(mistake, hint):
    verdict = check("05.4", lambda *question: search(*question, **mistake))
    assert not verdict
    assert hint in verdict.hint


def test_search_without_a_mistake_is_right():
    assert check("05.4", search)


def test_dijkstra_s_search_is_told_so():
    verdict = check("05.4", lambda graph, start, goal, estimate: search(graph, start, goal, lambda place: 0.0))
    assert "never asks for the estimate" in verdict.hint


def test_search_that_returns_nothing_is_told_so():
    assert "returns nothing" in check("05.4", lambda *question: None).hint


def test_the_broken_search_of_the_exercise_is_told_what_is_wrong(solutions):
    assert solutions["search"](solutions["roads"], "harbour", "castle", solutions["left"].get) != 7
    assert "no road" in check("05.4", solutions["search"]).hint
