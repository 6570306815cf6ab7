"""The open list against sorting, and against heapq's own idea of the smallest."""

import heapq

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from uavlab.planners.heap import OpenList, code_type, open_list, pop, push

NODES = 12
few_keys = st.sampled_from([0.0, 0.5, 1.0, 1.0 + 1e-12, 2.0, 3.0, np.inf])  # few, so that keys are often equal
pushes = st.tuples(st.integers(0, NODES - 1), few_keys)
actions = st.lists(st.one_of(pushes, st.none()), max_size=80)


def drain(waiting):
    return [int(pop(waiting)) for _ in range(waiting.size[0])]


@given(actions)
@settings(deadline=None, max_examples=300)
def test_pop_gives_the_smallest_key_and_among_equals_the_smallest_node(actions):
    waiting, model = open_list(NODES), {}
    for action in actions:
        if action is None:
            if model:
                expected = min(model, key=lambda node: (model[node], node))
                assert pop(waiting) == expected
                del model[expected]
        else:
            node, key = action
            model[node] = min(key, model.get(node, np.inf))
            push(waiting, node, model[node])
        assert waiting.size[0] == len(model)
        assert {node for node in range(NODES) if waiting.slot[node]} == set(model)
    assert drain(waiting) == sorted(model, key=lambda node: (model[node], node))


def test_many_nodes_come_out_as_from_heapq():
    rng = np.random.default_rng(2)
    keys = rng.integers(0, 500, 10_000) / 7
    waiting, heap = open_list(10_000), []
    for node in rng.permutation(10_000):
        push(waiting, node, keys[node])
        heapq.heappush(heap, (keys[node], node))
    assert drain(waiting) == [int(heapq.heappop(heap)[1]) for _ in range(10_000)]


def test_better_keys_move_nodes_up_without_doubling_them():
    rng = np.random.default_rng(3)
    waiting = open_list(2000)
    best = np.full(2000, np.inf)
    for node, share in zip(rng.integers(0, 2000, 20_000), rng.random(20_000), strict=True):
        best[node] = share if np.isinf(best[node]) else best[node] * share
        push(waiting, node, best[node])
    waits = np.flatnonzero(np.isfinite(best))
    assert waiting.size[0] == len(waits)
    assert drain(waiting) == sorted(waits.tolist(), key=lambda node: (best[node], node))


@pytest.mark.parametrize("order", [(0, 1, 2, 3, 4), (4, 3, 2, 1, 0), (2, 4, 0, 3, 1)])
def test_equal_keys_come_out_by_node_code_however_they_went_in(order):
    waiting = open_list(5)
    for node in order:
        push(waiting, node, 1.0)
    assert drain(waiting) == [0, 1, 2, 3, 4]


def test_a_node_may_come_back_after_it_left():
    waiting = open_list(2)
    push(waiting, 1, 5.0)
    assert pop(waiting) == 1
    push(waiting, 0, 4.0)
    push(waiting, 1, 3.0)
    assert drain(waiting) == [1, 0]


def test_codes_of_nodes_have_room():
    """Before, node 2 159 000 000 came out as −2 135 967 296: nine states for each voxel of a large map."""
    assert [code_type(nodes) for nodes in (9, 2**31 - 1, 2**31, 2_159_000_001)] == [
        np.int32,
        np.int32,
        np.int64,
        np.int64,
    ]
    waiting = OpenList(np.empty(11, np.int64), np.empty(11), np.zeros(10, np.int64), np.zeros(1, np.int64))
    for node in (7, 3, 9):
        push(waiting, node, 10.0 - node)
    assert [pop(waiting) for _ in range(3)] == [9, 7, 3]
