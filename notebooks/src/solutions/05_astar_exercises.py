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
# They belong to the notebook [05 A*](../05_astar.ipynb). Put your answer in the place of `raise NotImplementedError` or
# of the dots, run the cell and then the check below it. The check says what is right, or what is wrong and what to
# think about; ask it as often as you like.

# %%
import heapq
import itertools
import math

import numpy as np

from uavlab import exercises
from uavlab.city import table1_city
from uavlab.planners import astar, penalty_zone

# %% [markdown]
# ## 05.1 What does the proof say?
#
# *Warm-up · 5 minutes*
#
# A* has just taken the goal out of the open list, with $f = 66.4$ m. Its estimate is admissible. Thousands of nodes
# still wait. A friend says: "Stop! One of the nodes that wait may lead to a shorter route." Why can't that be?
#
# - **a** Every node that waits is farther than 66.4 m from the start.
# - **b** A* has looked at every route by now; the nodes that wait are left over from routes that ended at a wall.
# - **c** Any other route has a node that waits, and this node's $f$ is at most the length of that route. But no $f$ in
#   the list is below 66.4 m.
# - **d** At every node that was expanded, the estimate was the exact length of the rest.

# %%
### BEGIN SOLUTION
# It is steps 1 to 5 of the proof in one sentence.
choice_1 = "c"
### END SOLUTION

# %%
exercises.check("05.1", choice_1)

# %% tags=["solution"]
assert exercises.check("05.1", choice_1)

# %% [markdown] tags=["solution"]
# Take any other route $\mathcal R$. Its first node that isn't closed waits in the open list, with a $g$ not above the
# length of $\mathcal R$ up to there. Its estimate is not above the rest of $\mathcal R$. So its $f$ is not above the
# length of $\mathcal R$. The goal came out first, so this $f$ is at least 66.4 m, and $\mathcal R$ is at least as long.
#
# *a* confuses $f$ with $g$. A node that waits may be 2 m from the start, if it lies on the wrong side. *b* would be a
# search of everything; the point of A* is that it needn't. *d* would be a perfect estimate. Admissible is enough.

# %% [markdown]
# ## 05.2 The octile distance
#
# *Warm-up · 10 minutes*
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

# %% [markdown] tags=["solution"]
# A move through a corner brings us forward in three directions at once, so we make as many as the smallest difference
# allows. What is left of the other two differences is `middle - shortest` and `longest - shortest`. Diagonal moves use
# up the first, and then `longest - middle` is left for straight moves. Signs don't matter, since each move exists in
# all directions, and the order doesn't matter, since we sort.

# %% [markdown]
# ## 05.3 Which moves are legal?
#
# *Code · 20 minutes*
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
moves = [move for move in itertools.product((-1, 0, 1), repeat=3) if any(move)]
print(f"beside one obstacle {sum(legal(occupied, (1, 1, 1), move) for move in moves)} of 26 moves are legal")

# %% [markdown] tags=["solution"]
# A straight move has a box of 2 voxels, a diagonal one of 4, a move through a corner of 8. A slice from the smaller to
# the larger index covers all of them at once. The border must be looked at before that: an index of −1 doesn't raise an
# error in NumPy, it takes the last voxel, on the far side of the map. A drone that leaves in the west would arrive in
# the east.

# %% [markdown]
# ## 05.4 Repair an A*
#
# *Code · 25 minutes*
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

# %% [markdown] tags=["solution"]
# The first mistake: `cost` is the $f$ of the place, so the estimate leaks into $g$ and is added again at every place.
# Take $g$ from the table instead. The second: a neighbour that was found before is never looked at again. The direct
# road from the harbour to the bridge is found first and costs 6. The way over the market costs 4, and it comes too
# late. So the question has to be whether the new way is *cheaper*, not whether the place is new.

# %% [markdown]
# ## 05.5 Where does the route tip?
#
# *Experiment · 25 minutes*
#
# In the chapter the drone leaves the notch with $D_\text{min} = 3.5$ m. A smaller drone needs only $D_\text{min} = 2.5$
# m. **From which $\omega$ on does its route keep 2.5 m?** Find the least such $\omega$, to within 0.01.
# `out_of_the_notch` flies it once, and gives the length $L$, the metres in the zone $Z$ and the least clearance. You
# can scan, or halve an interval again and again. Or you find out which routes there are, and compute where the cost $C
# = L + \omega Z$ of one falls below that of the other.


# %%
def out_of_the_notch(omega):
    """Length [m], metres in the zone [m] and least clearance [m] of the cheapest route with D_min = 2.5 m."""
    route = astar(city, (90, 18, 30), (50, 44, 30), price=penalty_zone(city, 2.5, penalty=omega))
    return route.length, route.integral(city, city.clearance < 2.5), route.clearance(city)


city = table1_city()
for omega in (0.05, 1.0):
    length, inside, clearance = out_of_the_notch(omega)
    print(f"ω = {omega}: {length:.2f} m, {inside:.2f} m in the zone, least clearance {clearance:.1f} m")

# %%
### BEGIN SOLUTION
low, high = 0.05, 1.0  # not kept, kept
while high - low > 0.001:
    halfway = (low + high) / 2
    if out_of_the_notch(halfway)[2] >= 2.5:
        high = halfway
    else:
        low = halfway
tipping = high
### END SOLUTION

# %%
exercises.check("05.5", tipping)

# %% tags=["solution"]
assert exercises.check("05.5", tipping)
print(f"by halving: {tipping:.3f}")
for omega in (0.10, 0.20, 0.50):
    length, inside, clearance = out_of_the_notch(omega)
    print(f"ω = {omega:.2f}: {length:.3f} m, {inside:.3f} m in the zone, least clearance {clearance:.1f} m")

# %% [markdown] tags=["solution"]
# There are three routes. The second comes as near as 0.7 m, is 68.04 m long and has 4.24 m in the zone. The third keeps
# 2.5 m, is 69.80 m long and has nothing in the zone. They cost the same when $68.04 + 4.24\,\omega = 69.80$, so $\omega
# = 1.757/4.243 = 0.414$. It is $\sqrt2 - 1$. For three diagonal moves in the zone, $3\sqrt2 = 4.24$ m long, the third
# route makes six straight ones of 1 m outside of it, and $3\sqrt2\,(1 + \omega) = 6$.
#
# The route tips a first time at $\omega = 0.16$, from the first route to the second. That doesn't keep 2.5 m yet. And
# if you compare the first route with the third, you get 0.23. At that price the two cost the same, but the second is
# cheaper than both.

# %% [markdown]
# ## 05.6 A trap for programs that never reopen
#
# *Open · 40 minutes*
#
# Many programs keep a list of places that were expanded, and never look at those again. Here is one. It is right if the
# estimate is consistent. If the estimate is only admissible, it can be wrong. **Build a map and an estimate that prove
# it.**
#
# Hand over both as `trap = (roads, estimate)`; call them as you like. The roads are one-way: `roads[place][neighbour]`
# is the length of a road, above 0. There are at most eight places, and one of them is called "start" and one "goal".
# `estimate[place]` is your $h$. It must be admissible: at least 0, and never above the true way from that place to the
# goal. On your map `hasty` must return a way that is at least a tenth longer than the shortest.
#
# A hint: `hasty` has to reach some place by the wrong road *first*. What must the estimate of the places on the right
# road look like, so that they wait for too long? And what is the estimate of the place itself?


# %%
def hasty(roads, estimate):
    """A*, but a place that was expanded is never looked at again."""
    g, closed = {"start": 0.0}, set()
    open_list = [(estimate["start"], "start")]
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
                heapq.heappush(open_list, (g[neighbour] + estimate[neighbour], neighbour))
    return math.inf


# %%
### BEGIN SOLUTION
town = {
    "start": {"bridge": 3, "market": 1},
    "market": {"bridge": 1},
    "bridge": {"goal": 3},
    "goal": {},
}
guess = {"start": 0, "market": 4, "bridge": 0, "goal": 0}
trap = (town, guess)
### END SOLUTION

# %%
exercises.check("05.6", trap)

# %% tags=["solution"]
assert exercises.check("05.6", trap)
print("hasty:", hasty(*trap), "m; the search of 05.4:", repaired(town, "start", "goal", guess.get), "m")

# %% [markdown] tags=["solution"]
# The shortest way is start, market, bridge, goal: 1 + 1 + 3 = 5. From the market the true rest is 4, and the estimate
# says so. From the bridge the true rest is 3, but the estimate says 0. So $f(\text{market}) = 1 + 4 = 5$ and
# $f(\text{bridge}) = 3 + 0 = 3$. The bridge comes out first, over the direct road of 3, and is closed. Then the market
# comes out and would offer the bridge a way of 2. `hasty` doesn't listen. Its answer is 6.
#
# The estimate isn't consistent: from the market to the bridge it falls by 4, along a road of length 1. Admissible it
# is. The search of exercise 05.4 has the same estimate and finds 5, because it looks at the bridge once more.
