# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 05 A*: exercises
#
# They belong to the notebook [05 A*](../05_astar.ipynb). Put your answer in the place of `raise NotImplementedError`,
# run the cell and then the check below it. The check says what is right, or what is wrong and what to think about;
# ask it as often as you like.

# %%
import heapq
import math

import numpy as np

from uavlab import exercises

# %% [markdown]
# ## 05.2 The octile distance
#
# Write the length of the shortest way over 26 moves on an empty map, in cells. `dx`, `dy` and `dz` are the
# differences of the coordinates between node and goal: whole numbers, of any sign and in any order. Straight moves
# are $1$ long, diagonal ones $\sqrt 2$, and those through a corner $\sqrt 3$.


# %%
def octile(dx, dy, dz):
    """Length of the shortest way over 26 moves when nothing is in between [cells]."""
    ### BEGIN SOLUTION
    shortest, middle, longest = sorted((abs(dx), abs(dy), abs(dz)))
    corner_moves, diagonal_moves, straight_moves = shortest, middle - shortest, longest - middle
    return math.sqrt(3) * corner_moves + math.sqrt(2) * diagonal_moves + straight_moves
    ### END SOLUTION


# %%
exercises.check("05.2", octile)

# %% tags=["solution"]
assert exercises.check("05.2", octile)
print(f"octile(5, -3, 1) = {octile(5, -3, 1):.3f}")

# %% [markdown]
# ## 05.3 Which moves are legal?
#
# `occupied` is an array of the whole map, `True` where there is an obstacle. `node` is a free voxel `(i, j, k)`,
# `move` one of the 26 moves, each part $-1$, $0$ or $1$. A move is legal when every voxel of its bounding box lies on
# the map and is free. Beware of the border: what does NumPy make of the index $-1$?


# %%
def legal(occupied, node, move):
    """Whether the UAV may make this move: every voxel of its bounding box is on the map and free."""
    ### BEGIN SOLUTION
    target = np.add(node, move)
    if (target < 0).any() or (target >= occupied.shape).any():
        return False
    low, high = np.minimum(node, target), np.maximum(node, target)
    box = tuple(slice(first, last + 1) for first, last in zip(low, high, strict=True))
    return not occupied[box].any()
    ### END SOLUTION


# %%
exercises.check("05.3", legal)

# %% tags=["solution"]
assert exercises.check("05.3", legal)
occupied = np.zeros((3, 3, 3), dtype=bool)
occupied[2, 1, 1] = True
moves = [(i, j, k) for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1) if (i, j, k) != (0, 0, 0)]
print(f"beside one obstacle {sum(legal(occupied, (1, 1, 1), move) for move in moves)} of 26 moves are legal")

# %% [markdown]
# ## 05.4 Repair an A*
#
# A* works on any graph: `graph[place][neighbour]` is the length of a road, `estimate(place)` a consistent estimate of
# the way from there to the goal. The `search` below has been in use for years, and it is wrong in two places. Look at
# the roads: from the harbour to the castle the cheapest way costs 7, over market and bridge.

# %%
roads = {
    "harbour": {"bridge": 6, "market": 2},
    "market": {"bridge": 2, "harbour": 2},
    "bridge": {"castle": 3, "market": 2, "harbour": 6},
    "castle": {"bridge": 3},
}
left = {"harbour": 5, "market": 4, "bridge": 3, "castle": 0}
print("harbour – market – bridge – castle:", 2 + 2 + 3)


# %%
def search(graph, start, goal, estimate):
    g = {start: 0}
    open_list = [(estimate(start), start)]
    while open_list:
        cost, place = heapq.heappop(open_list)
        if place == goal:
            return g[goal]
        for neighbour, length in graph[place].items():
            if neighbour not in g:
                g[neighbour] = cost + length
                heapq.heappush(open_list, (g[neighbour] + estimate(neighbour), neighbour))
    return math.inf


print("cost of the broken search:", search(roads, "harbour", "castle", left.get))

# %% [markdown]
# Write it so that it is right: it returns the cost of the cheapest way from `start` to `goal`, and `math.inf` where
# there is none.


# %%
def repaired(graph, start, goal, estimate):
    """Cost of the cheapest way from start to goal, by A*."""
    ### BEGIN SOLUTION
    g = {start: 0}
    open_list = [(estimate(start), start)]
    while open_list:
        f, place = heapq.heappop(open_list)
        if place == goal:
            return g[goal]
        if f > g[place] + estimate(place):  # an old entry: a better way was found since
            continue
        for neighbour, length in graph[place].items():
            cost = g[place] + length  # not f + length: f contains the estimate
            if cost < g.get(neighbour, math.inf):  # a better way counts, also to a place that waits already
                g[neighbour] = cost
                heapq.heappush(open_list, (cost + estimate(neighbour), neighbour))
    return math.inf
    ### END SOLUTION


# %%
exercises.check("05.4", repaired)

# %% tags=["solution"]
assert exercises.check("05.4", repaired)
print("cost of the repaired search:", repaired(roads, "harbour", "castle", left.get))
assert repaired(roads, "harbour", "castle", left.get) == 7
