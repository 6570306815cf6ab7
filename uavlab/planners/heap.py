"""The open list: a binary heap that knows where each node waits, so that a better key moves it up.

Textbook form, counted from 1: the children of slot s are 2s and 2s + 1, and no parent is behind its child. The
smallest key comes out first; among equal keys, the smallest node code. That is the rule that breaks ties, so a
route doesn't depend on the machine. Memory that is never written costs nothing: a search that visits few nodes
of a large map is cheap.
"""

from __future__ import annotations

import mmap
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from uavlab.compiled import compiled

LARGE = 32 << 20
"""From this size on [bytes], huge pages cost more than they save."""


class OpenList(NamedTuple):
    """Nodes that wait for expansion, ordered by key."""

    node: np.ndarray  # (N + 1,) int32, or int64 for more than that can count: which node waits in each slot, from 1
    key: np.ndarray  # (N + 1,) float: its key
    slot: np.ndarray  # (N,) of the same type: where a node waits; 0: it doesn't
    size: np.ndarray  # (1,) int: how many wait


def open_list(nodes: int) -> OpenList:
    """An empty list with room for nodes 0 … nodes − 1."""
    code = code_type(nodes)
    return OpenList(
        np.empty(nodes + 1, code), np.empty(nodes + 1), sparse_array(np.zeros, nodes, code), np.zeros(1, np.int64)
    )


def code_type(nodes: int) -> type:
    """The smallest type that can count so many nodes."""
    return np.int32 if nodes <= np.iinfo(np.int32).max else np.int64


def sparse_array(make: Callable, count: int, dtype: type) -> np.ndarray:
    """`np.empty` or `np.zeros`, that on a large map take up memory only around the voxels that a search visits.

    NumPy asks for huge pages of two megabytes, and a route across the map passes through nearly all of them.
    """
    size = count * np.dtype(dtype).itemsize
    return make(count, dtype) if size < LARGE else np.frombuffer(mmap.mmap(-1, size), dtype)


@compiled
def push(waiting, node, key):
    """Put a node into the list, or move it up if it waits already; the key must not be above its present one."""
    slot = waiting.slot[node]
    if slot == 0:
        waiting.size[0] += 1
        slot = waiting.size[0]
    while slot > 1:
        parent = slot // 2
        if not comes_first(key, node, waiting.key[parent], waiting.node[parent]):
            break
        place(waiting, waiting.node[parent], waiting.key[parent], slot)
        slot = parent
    place(waiting, node, key, slot)


@compiled
def pop(waiting):
    """Take out the node with the smallest key."""
    first = waiting.node[1]
    waiting.slot[first] = 0
    size = waiting.size[0] - 1
    waiting.size[0] = size
    if size == 0:
        return first
    node, key = waiting.node[size + 1], waiting.key[size + 1]  # the last one sinks from the top
    slot = 1
    while 2 * slot <= size:
        child = 2 * slot
        if child < size and comes_first(
            waiting.key[child + 1], waiting.node[child + 1], waiting.key[child], waiting.node[child]
        ):
            child += 1
        if not comes_first(waiting.key[child], waiting.node[child], key, node):
            break
        place(waiting, waiting.node[child], waiting.key[child], slot)
        slot = child
    place(waiting, node, key, slot)
    return first


@compiled
def comes_first(key, node, other_key, other_node):
    return key < other_key or (key == other_key and node < other_node)


@compiled
def place(waiting, node, key, slot):
    waiting.node[slot] = node
    waiting.key[slot] = key
    waiting.slot[node] = slot
