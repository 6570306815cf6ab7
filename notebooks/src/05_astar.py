# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 05 A*: the shortest way through a city, and a safer one
#
# A UAV stands in the notch of a building. Which of all the ways to its goal is the shortest, how do we know that
# there is no shorter one, and how can we tell the planner to keep away from walls without losing that certainty? A*
# answers the first two questions with one idea: expand nodes in the order of *way so far plus a guess of the rest*.
# REPARE (Sensors 2022, 22, 2151, [doi:10.3390/s22062151](https://doi.org/10.3390/s22062151), section 2.3.1, Eqs 8–13)
# adds a penalty near obstacles. We build A* from nothing, prove why it is exact, and then look closely at that
# penalty: as the paper prints it, the way there and the way back are not the same. ("Eq. 3" is an equation of this
# notebook, "REPARE Eq. 9" one of the paper's.)

# %%
import heapq
import math
import time

import numpy as np

from uavlab import plot, scene
from uavlab.city import City, table1_city
from uavlab.planners import astar, penalty_zone, shortcut, theta_star
from uavlab.route import Route

COLORS = {"shortest": plot.BLUE, "with a penalty zone": plot.ORANGE}

# %% [markdown]
# ## The graph: 26 neighbours
#
# A planner sees the city as voxels ([04 cities](04_cities.ipynb)). Each free voxel is a node, and from each there are
# 26 moves, to every voxel around it: 6 straight ones, 12 diagonal ones, 8 through a corner. With the voxel's edge as
# the unit a move $(d_x, d_y, d_z)$, each $-1$, $0$ or $1$, is as long as
#
# $$ d = \sqrt{d_x^2 + d_y^2 + d_z^2} \in \{1, \sqrt 2, \sqrt 3\}. \tag{1} $$
#
# A move is **legal** when every voxel of its bounding box is free: 2 voxels for a straight move, 4 for a diagonal
# one, 8 for one through a corner. To look only at the voxel where the move ends is a common shortcut, and a UAV that
# follows it touches the edges of buildings: it *cuts corners*.

# %%
MOVES = [(dx, dy, dz) for dx in (-1, 0, 1) for dy in (-1, 0, 1) for dz in (-1, 0, 1) if (dx, dy, dz) != (0, 0, 0)]


def neighbours(free, node, cut_corners=False):
    """Where one legal move leads from a node, and how long the move is [cells]; `free` is the set of free nodes."""
    x, y, z = node
    for dx, dy, dz in MOVES:
        box = [(x + a, y + b, z + c) for a in {0, dx} for b in {0, dy} for c in {0, dz}]
        target = (x + dx, y + dy, z + dz)
        if target in free and (cut_corners or all(voxel in free for voxel in box)):
            yield target, math.dist(node, target)


lengths = [length for _, length in neighbours(set(MOVES) | {(0, 0, 0)}, (0, 0, 0))]
for length in sorted(set(lengths)):
    print(f"{lengths.count(length):2d} moves of {length:.3f} cells")
assert len(lengths) == 26

# %% [markdown]
# One occupied voxel beside the node forbids far more than the move into it:

# %% tags=["nbval-check-output"]
cube = {(x, y, z) for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1)}
legal = {
    place: len(list(neighbours(cube - {voxel}, (0, 0, 0))))
    for place, voxel in {"a face": (1, 0, 0), "an edge": (1, 1, 0), "a corner": (1, 1, 1)}.items()
}
for place, count in legal.items():
    print(f"obstacle across {place:<8}: {count} of 26 moves are legal")
assert legal == {"a face": 17, "an edge": 23, "a corner": 25}

# %% tags=["figure"]
ways = {target for target, _ in neighbours(cube - {(1, 0, 0)}, (0, 0, 0))}
level = [move for move in MOVES if move[2] == 0]
arrows = {
    name: [[(0, 0), (0.95 * x, 0.95 * y)] for x, y, z in level if ((x, y, z) in ways) == legal_one]
    for name, legal_one in (("legal", True), ("forbidden: its box is not free", False))
}
square = [(0.5, -0.5), (1.5, -0.5), (1.5, 0.5), (0.5, 0.5)]
figure = plot.diagram("x [cells]", "y [cells]", areas={"obstacle": square}, arrows=arrows, x_range=(-1.5, 1.5),
                      y_range=(-1.5, 1.5), colors={"obstacle": "0.35"})  # fmt: skip
for axis in (figure.axes[0].xaxis, figure.axes[0].yaxis):
    axis.set_ticks([-1, 0, 1])
    axis.set_ticks([-0.5, 0.5], minor=True)
figure.axes[0].grid(which="minor", color="0.8")
figure

# %% [markdown]
# The forbidden diagonals run exactly along a corner of the obstacle. A UAV has a body, so it would hit.
#
# ## A* in 25 lines
#
# For each node $n$ let $g(n)$ be the length of the best way found so far from the start (REPARE Eq. 10) and $h(n)$ an
# estimate of the way that remains. A* keeps the nodes that it knows but hasn't expanded in an *open list*, and always
# takes out the one with the least
#
# $$ f(n) = g(n) + h(n). \tag{2} $$
#
# The estimate here is the **octile distance**. Sort the three coordinate differences to the goal, $a \ge b \ge c$:
# make $c$ moves through corners, then $b - c$ diagonal ones, then $a - b$ straight ones:
#
# $$ h_\text{oct} = \sqrt3\,c + \sqrt2\,(b - c) + (a - b). \tag{3} $$


# %%
def octile(node, goal):
    """Way from node to goal over 26 moves when nothing is in between [cells]."""
    c, b, a = sorted(abs(u - v) for u, v in zip(node, goal, strict=True))
    return math.sqrt(3) * c + math.sqrt(2) * (b - c) + (a - b)


print(f"to (5, 3, 1): {octile((0, 0, 0), (5, 3, 1)):.3f} cells, straight {math.dist((0, 0, 0), (5, 3, 1)):.3f}")

# %% [markdown]
# And now the search itself. Python's `heapq` can't change the key of an entry, so a better way to a node that waits
# already adds a second entry, and the old one is passed over when it comes out.


# %%
def search(free, start, goal, estimate=octile, **rule):
    """A*: the best g of every node seen, the node before each, and how many were expanded."""
    g, parent, expanded = {start: 0.0}, {start: None}, 0
    open_list = [(estimate(start, goal), start)]
    while open_list:
        f, node = heapq.heappop(open_list)
        if node == goal:
            break
        if f > g[node] + estimate(node, goal):
            continue  # an old entry: a better way to this node was found after it
        expanded += 1
        for neighbour, length in neighbours(free, node, **rule):
            cost = g[node] + length
            if cost < g.get(neighbour, math.inf):
                g[neighbour], parent[neighbour] = cost, node
                heapq.heappush(open_list, (cost + estimate(neighbour, goal), neighbour))
    return g, parent, expanded


# %% [markdown]
# Does it agree with the library's `astar`? On Table 1's city in voxels of 4 m, over the pair of REPARE Fig. 12 (from
# inside the notch to a point in the middle of the map) and 19 random ones:

# %%
coarse = table1_city(cell=4.0)
notch, middle = (90, 18, 30), (50, 44, 30)  # REPARE Fig. 12
asked = [(notch, middle), *coarse.random_pairs(19, 6, apart=40)]
free = set(map(tuple, np.argwhere(~coarse.occupied).tolist()))
print(f"{len(free):,} free voxels, {len(asked)} pairs")

# %%
ends = [[tuple(coarse.cell_of(point).tolist()) for point in pair] for pair in asked]
began = time.perf_counter()
answers = [search(free, start, goal) for start, goal in ends]
plain_seconds = time.perf_counter() - began
plain_costs = [coarse.cell * g[goal] for (g, _, _), (_, goal) in zip(answers, ends, strict=True)]

astar(coarse, *asked[0])  # the first call compiles
began = time.perf_counter()
routes = [astar(coarse, start, goal) for start, goal in asked]
library_seconds = time.perf_counter() - began
costs = [route.cost for route in routes]

assert np.allclose(plain_costs, costs, rtol=1e-12, atol=0)
print(f"largest difference in cost: {max(abs(np.subtract(plain_costs, costs))):.1e} m")
print(f"the library is {plain_seconds / library_seconds:,.0f} times as fast")

# %% [markdown]
# The same costs, up to the rounding of the last digit. The library runs the same algorithm, compiled, with a heap
# that can move a waiting node up, and with the 27 voxels around a node packed into one word of bits.
#
# What would cutting corners have "saved"? In voxels of 1 m, between the two points of Fig. 12:

# %% tags=["nbval-check-output"]
city = table1_city()
free_fine = set(map(tuple, np.argwhere(~city.occupied).tolist()))
begin, end = (tuple(city.cell_of(point).tolist()) for point in (notch, middle))
cutting = search(free_fine, begin, end, cut_corners=True)[0][end]
shortest = astar(city, notch, middle)
print(f"legal moves {shortest.length:.2f} m, cutting corners {cutting:.2f} m")
assert math.isclose(cutting, 65.799, abs_tol=5e-4)
assert math.isclose(shortest.length, 66.385, abs_tol=5e-4)

# %% [markdown]
# ## Why it is exact
#
# Let $d(n, m)$ be the length of the move from $n$ to $m$ and $d^*(n)$ the length of the shortest way from $n$ to the
# goal. An estimate is **admissible** when it is never too high, and **consistent** when it never falls by more along
# a move than the move is long:
#
# $$ h(n) \le d^*(n), \tag{4} $$
# $$ h(n) \le d(n, m) + h(m), \qquad h(\text{goal}) = 0. \tag{5} $$
#
# *Consistent implies admissible*: add up Eq. 5 along the shortest way to the goal.
#
# *Admissible makes A\* exact.* Look at the moment when the goal is taken out, with $f = g(\text{goal})$. Any other
# route to the goal has a node that still waits in the open list, and its $f$ is at most the length of that route,
# since $h$ is not too high. But the goal came out first, so its $f$ is not above that one: no other route is shorter.
#
# *Consistent makes A\* fast.* Along any way, $f = g + h$ never falls. So nodes come out in order of $f$, and when a
# node comes out, its $g$ is already the best: each node is expanded at most once.
#
# The straight distance (REPARE Eqs 8 and 9),
#
# $$ h_\text{euc} = \sqrt{a^2 + b^2 + c^2}, \tag{6} $$
#
# is consistent: Eq. 5 is the triangle inequality. The octile distance is consistent too, and it is more: **on an
# empty map it is the exact distance.** Nothing higher is admissible without a look at the obstacles. Eq. 3 gives a
# way of that length. That there is no shorter one takes one line. Write Eq. 3 as a weighted sum,
#
# $$ h_\text{oct} = w_1 a + w_2 b + w_3 c, \qquad w = (1,\ \sqrt2 - 1,\ \sqrt3 - \sqrt2), \tag{7} $$
#
# and look at what one move adds to this sum: at most $w_1 = 1$ if it is straight, $w_1 + w_2 = \sqrt2$ if diagonal,
# $w_1 + w_2 + w_3 = \sqrt3$ through a corner. That is exactly its length, so no chain of moves can add up to Eq. 7
# and be shorter.
#
# Now in numbers. First, the distance on an empty map of 12³ voxels, by a search without an estimate (Dijkstra):


# %% tags=["nbval-check-output"]
def zero(node, goal):
    """No estimate at all."""
    return 0.0


empty = {(x, y, z) for x in range(12) for y in range(12) for z in range(12)}
exact, _, _ = search(empty, (2, 3, 5), None, zero)
error = max(abs(distance - octile((2, 3, 5), node)) for node, distance in exact.items())
print(f"{len(exact)} nodes, largest difference between octile distance and shortest way: {error:.1f} cells")
assert len(exact) == 12**3
assert error < 1e-12

# %% [markdown]
# Second, Eq. 5 on every move of Table 1's city in 4 m voxels. The largest fall of $h$ per metre must not be above 1;
# an estimate that is half as much again breaks it:


# %% tags=["nbval-check-output"]
def euclidean(node, goal):
    """Straight distance, REPARE Eq. 9 [cells]."""
    return math.dist(node, goal)


def too_high(node, goal):
    """Half as much again as the octile distance: not admissible."""
    return 1.5 * octile(node, goal)


moves = [(node, *move) for node in free for move in neighbours(free, node)]
goal = ends[0][1]
for estimate in (octile, euclidean, zero, too_high):
    falls = np.array([(estimate(n, goal) - estimate(m, goal)) / length for n, m, length in moves])
    print(f"{estimate.__name__:<9} falls by at most {falls.max():.3f} m per metre, on {len(falls):,} moves")
    assert (falls.max() <= 1 + 1e-9) == (estimate is not too_high)

# %% [markdown]
# ## When the estimate is too high
#
# What goes wrong, then? The search runs for the goal and closes its eyes to a way that starts off in another
# direction. With $w$ times an admissible estimate the route costs at most $w$ times the shortest (the proof above,
# with $w$ in one place), and some of that is used:

# %% tags=["nbval-check-output"]
hurried = [search(free, start, goal, too_high) for start, goal in ends]
hurried_costs = np.array([coarse.cell * g[goal] for (g, _, _), (_, goal) in zip(hurried, ends, strict=True)])
excess = hurried_costs / costs - 1
longer = excess > 1e-9
print(f"{longer.sum()} of {len(ends)} routes are longer, by up to {excess.max():.1%}")
fewer = sum(expanded for _, _, expanded in hurried) / sum(expanded for _, _, expanded in answers)
print(f"expansions: {fewer:.2f} times as many")
assert longer.any()
assert excess.max() <= 0.5


# %%
def way_to(parent, node):
    """The nodes from the start to this one."""
    nodes = [node]
    while (node := parent[node]) is not None:
        nodes.append(node)
    return nodes[::-1]


worst = int(excess.argmax())
nodes = way_to(hurried[worst][1], ends[worst][1])
plot.profile(coarse, {"estimate 1.5 times too high": Route(coarse.center_of(nodes)), "octile estimate": routes[worst]})

# %% [markdown]
# The hurried search climbs to the goal's height at once, as if nothing were in between. Then it has to dive below the
# floating building and climb a second time.
#
# Too high an estimate is not forbidden: it buys time with length, and the price is known in advance. But it has to be
# a decision, not an accident. It becomes an accident when the unit changes: an estimate in metres is too high as soon
# as a metre costs less than 1.
#
# ## Three estimates compared
#
# All three below are consistent, so all give the same cost. They differ in how much of the city they look at. Forty
# random pairs, 40 m or more apart, in voxels of 2 m:

# %% tags=["nbval-check-output"]
medium = table1_city(cell=2.0)
forty = medium.random_pairs(40, 6, apart=40)
estimates = ("octile", "euclidean", "zero")
found = {name: [astar(medium, *pair, heuristic=name) for pair in forty] for name in estimates}
expanded = {name: sum(route.info["expanded"] for route in found[name]) / len(forty) for name in estimates}
for name in estimates:
    assert np.allclose([r.cost for r in found[name]], [r.cost for r in found["octile"]], rtol=1e-9)
    print(f"{name:<9} {expanded[name]:9,.0f} expansions a route")
assert expanded["octile"] < expanded["euclidean"] < expanded["zero"]

# %%
names = {"octile": "octile (Eq. 3)", "euclidean": "Euclidean (REPARE Eq. 9)", "zero": "zero (Dijkstra)"}
drawn = {names[name]: expanded[name] for name in estimates}
plot.bars(drawn, "expansions a route, mean of 40 pairs", title="Table 1's city in 2 m voxels")

# %% [markdown]
# In voxels of 1 m there is more of everything, and the first two compare as before:

# %% tags=["nbval-check-output"]
hundred = city.random_pairs(100, 6, apart=40, min_clearance=3.5)
count = {
    name: sum(astar(city, *pair, heuristic=name).info["expanded"] for pair in hundred)
    for name in ("octile", "euclidean")
}
octile_share = count["octile"] / count["euclidean"]
print(f"octile expands {octile_share:.2f} of what the straight distance expands, at the same cost")
assert octile_share < 0.3

# %%
example = (20, 8, 20), (80, 95, 60)
recorded = [astar(city, *example, heuristic=name, record=True) for name in estimates]
assert math.isclose(min(route.length for route in recorded), max(route.length for route in recorded))
plot.expansions(city, *recorded)

# %% [markdown]
# The colour says when a search first looked at a column of the map, as a share of that search: dark at its start,
# bright at its end; the title counts its expansions. The octile search runs along a thread, which the route covers.
# The straight distance is always a little too low (a lattice can't fly straight), so routes that lead away from the
# goal seem worth a look. Without an estimate the search looks at nearly everything. The three routes differ, and are
# equally long: on a lattice the shortest route is rarely the only one.
#
# Where obstacles make any estimate too low, even the octile search has to flood the place. Out of the notch (REPARE
# Fig. 12) it fills the notch (dark) and spills out of it (bright), until it finds the way around. From above, and
# then in space: run the notebook to see the nodes appear in their order.

# %%
flooding = astar(city, notch, middle, record=True)
plot.expansions(city, flooding)

# %%
scene.show(city, flooding, expansion=True)

# %% [markdown]
# ## A price near walls
#
# The shortest way scrapes along walls: its clearance is half a metre, so the UAV's centre is in the voxel next to the
# wall. REPARE asks for a distance $D_\text{min}$ (its Eq. 7; for light load and mild wind its Table 4 has 3.5 m) and
# marks with $O_\text{risk} = 1$ the nodes where an obstacle is nearer, with 0 all others. How should that enter the
# search? The physical reading is a **price per metre**: a metre in the zone costs $1 + \omega$ metres.
#
# $$ p(n) = 1 + \omega\, O_\text{risk}(n), \qquad c(n, m) = d(n, m)\, \frac{p(n) + p(m)}{2}. \tag{8} $$
#
# Half of each move lies in one voxel and half in the other, so a route's cost is
#
# $$ C = \underbrace{L}_{\text{length}} + \;\omega\, \underbrace{Z}_{\text{metres in the zone}}. \tag{9} $$
#
# All of the proof still holds. $p \ge 1$, so no move costs less than its length and the estimates stay consistent.
# And $c(n, m) = c(m, n)$, so a route costs the same in both directions. Out of the notch, with $\omega = 0.5$:

# %% tags=["nbval-check-output"]
safe_distance = 3.5
shortest = astar(city, notch, middle)
priced = astar(city, notch, middle, price=penalty_zone(city, safe_distance, penalty=0.5))
both = {"shortest": shortest, "with a penalty zone": priced}
for name, route in both.items():
    print(f"{name:<19} {route.length:.2f} m, smallest clearance {route.clearance(city):.1f} m")
assert math.isclose(priced.length, 71.213, abs_tol=5e-4)
assert (shortest.clearance(city), priced.clearance(city)) == (0.5, 3.5)

# %%
plot.profile(city, both, safe_distance=safe_distance, colors=COLORS)

# %% [markdown]
# Seven per cent more length buys seven times the clearance.

# %%
scene.show(city, both, safe_distance=safe_distance, colors=COLORS)

# %% [markdown]
# ## Why the printed cost is no cost of a route
#
# REPARE writes the penalty differently (REPARE Eqs 11–13). With $g$ the length so far, it orders the open list by
#
# $$ T(n) = g(n)\,\bigl(1 + O_\text{risk}(n)\,\omega\bigr) + h(n). \tag{10} $$
#
# The factor stands on the *whole way so far*, and only while $n$ itself is in the zone. Two things follow. The toll
# for one voxel, $\omega\, g$, grows with the distance flown before: forty metres after take-off it is ten times that
# of four metres after. And no successor inherits it: one step out of the zone, all is forgiven, and at a goal in the
# open $T = g$, the plain length.
#
# By hand: a straight corridor of 13 voxels (1 m each), three of them in the zone, $\omega = 0.5$. There from left to
# right, and back:

# %% tags=["nbval-check-output"]
omega = 0.5
zone = np.array([0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 0, 0])
east = np.arange(13)
west = east[::-1]
forth = east * (1 + omega * zone) + west  # g = metres from the left end, h = metres to the right one
back = west * (1 + omega * zone) + east
print("in the zone  ", *(f"{'yes' if o else '':>4}" for o in zone))
print("T on the way →", *(f"{t:4.1f}" for t in forth))
print("T on the way ←", *(f"{t:4.1f}" for t in back))
print(f"additive cost (Eq. 9) both ways: {12 + omega * 3:.1f}")
assert (forth.max(), back.max()) == (17, 14)
assert forth[-1] == back[0] == 12

# %% [markdown]
# The same three voxels raise $T$ to 17 on the way there and to 14 on the way back, and at the end $T$ is 12, as if
# there were no zone. Since the open list hands out the least $T$ first, what decides is the *highest* $T$ on a way:
# the search enters the corridor's zone only when nothing with a smaller $T$ waits. Give it a detour of 16 m that
# stays in the open. There, 16 is less than 17: it takes the detour. Back, 14 is less than 16: it flies through the
# zone.

# %% tags=["figure"]
corridor = {"T of the corridor, there (→)": forth, "T of the corridor, back (←)": back}
limits = {"highest T of\nthe detour": 16, "length of\nthe corridor": 12}
plot.lines(east, corridor, "place in the corridor [m]", "T [m]", places={"in the zone": (7.5, 10.5)}, limits=limits,
           y_range=(11, 18))  # fmt: skip

# %% tags=["nbval-check-output"]
occupied = np.zeros((13, 3, 1), bool)
occupied[1:12, 1] = True  # a wall between the corridor and the detour
corridor = City(occupied, name="A corridor and a detour")
price = np.ones(occupied.shape)
price[:, 0, 0] += omega * zone
left, right = (0.5, 0.5, 0.5), (12.5, 0.5, 0.5)
ways = (left, right), (right, left)
printed = [astar(corridor, *way, price=price, as_printed=True, heuristic="euclidean") for way in ways]
ours = [astar(corridor, *way, price=price) for way in ways]
print("as printed: there {:.0f} m, back {:.0f} m".format(*(route.length for route in printed)))
print("additive:   there {:.0f} m, back {:.0f} m,".format(*(route.length for route in ours)), f"cost {ours[0].cost}")
assert [route.length for route in printed] == [16, 12]
assert [route.cost for route in ours] == [13.5, 13.5]

# %% [markdown]
# The additive cost is 13.5 in both directions, less than the detour's 16, and the route is the same.
#
# ### How often does it happen in a city?
#
# REPARE's planner as printed (REPARE Eq. 13, straight distance, a ring of 26 points as the zone) and ours, there and
# back, on a hundred random pairs of Table 1's city, 40 m or more apart, both ends 3.5 m or more from walls:


# %% tags=["nbval-check-output"]
def there_and_back(price, **options):
    """Routes for each of the hundred pairs, in both directions."""
    return [(astar(city, a, b, price=price, **options), astar(city, b, a, price=price, **options)) for a, b in hundred]


printed, gap = {}, {}
for omega in (0.1, 0.2):
    ring = penalty_zone(city, safe_distance, penalty=omega, zone="ring")
    printed[omega] = there_and_back(ring, as_printed=True, heuristic="euclidean")
    gap[omega] = np.array([abs(there.length - home.length) for there, home in printed[omega]])
    differ = gap[omega] > 1e-6
    mean, most = gap[omega][differ].mean(), gap[omega].max()
    print(
        f"ω = {omega}, as printed: {differ.sum()} of 100 pairs differ, by {mean:.1f} m on average, {most:.1f} m at most"
    )

# %% tags=["nbval-check-output"]
for omega in (0.1, 0.2):
    ours = there_and_back(penalty_zone(city, safe_distance, penalty=omega))
    largest = max(abs(there.cost - home.cost) for there, home in ours)
    print(f"ω = {omega}, additive: the costs of all {len(ours)} pairs agree to 1e-9 m: {largest < 1e-9}")
    assert largest < 1e-9

# %% tags=["figure"]
sorted_gaps = {f"ω = {omega} (additive, Eq. 9: 0 everywhere)": np.sort(gaps)[::-1] for omega, gaps in gap.items()}
plot.lines(range(1, 101), sorted_gaps, "pairs, largest difference first", "|length there − back| [m]", steps=True,
           x_range=(0, 60), title="REPARE Eq. 13 as printed: same pair, other direction")  # fmt: skip

# %% [markdown]
# The pair that differs most, from above. One way stays out of the zone, the other one doesn't:

# %%
worst = int(gap[0.2].argmax())
there, home = printed[0.2][worst]
print(f"clearance there {there.clearance(city):.1f} m, back {home.clearance(city):.1f} m")
assert there.clearance(city) < safe_distance <= home.clearance(city)
assert math.isclose(abs(there.length - home.length), gap[0.2].max())
plot.plan(city, {"as printed, there": there, "as printed, back": home})

# %% [markdown]
# ## What does ω buy?
#
# By Eq. 9, $\omega$ is a rate of exchange: how many metres of detour one metre in the zone is worth. Raise it, and
# the length $L$ of the best route can only grow and its metres in the zone $Z$ only shrink. (Say $\omega' > \omega$
# with best routes $R'$ and $R$. Each is no worse than the other at its own rate: $L + \omega Z \le L' + \omega Z'$
# and $L' + \omega' Z' \le L + \omega' Z$. Add them: $(\omega' - \omega)(Z' - Z) \le 0$, so $Z' \le Z$, and with that
# the first gives $L \le L'$.) Over the hundred pairs:

# %% tags=["nbval-check-output"]
near = penalty_zone(city, safe_distance, penalty=1.0) > 1
rates = (0.0, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0)
length, inside, least = np.zeros((3, len(rates), 100))
for row, omega in enumerate(rates):
    price = penalty_zone(city, safe_distance, penalty=omega)
    for column, pair in enumerate(hundred):
        route = astar(city, *pair, price=price)
        length[row, column], inside[row, column] = route.length, route.integral(city, near)
        least[row, column] = route.clearance(city)
        assert math.isclose(route.cost, route.length + omega * inside[row, column])  # Eq. 9
print("    ω   length  in the zone  keep 3.5 m")
for omega, *means, kept in zip(rates, length.mean(1), inside.mean(1), (least >= safe_distance).mean(1), strict=True):
    print(f"{omega:5.2f}  {means[0]:5.1f} m  {means[1]:9.2f} m  {kept:10.0%}")
assert (np.diff(length, axis=0) > -1e-9).all()
assert (np.diff(inside, axis=0) < 1e-9).all()
assert np.ptp(length[rates.index(0.5) :], axis=0).max() < 1e-9  # nothing changes any more

# %% tags=["figure"]
means = np.column_stack([inside.mean(axis=1), length.mean(axis=1)])
names = ["ω = 0", "ω = 0.05", "ω = 0.1", "ω = 0.2", "ω = 0.5 and more"]
plot.lines(means[:, 0], {"A* with a penalty zone": means[:, 1]}, "metres in the zone, mean of 100 routes [m]",
           "length, mean of 100 routes [m]", points={"one ω": means}, notes=dict(zip(names, means, strict=False)),
           colors={"one ω": plot.BLUE})  # fmt: skip

# %% [markdown]
# The first metres are cheap: most of the time in the zone goes at almost no extra length. And there is an end to it.
# The paper says that a larger $\omega$ reserves a larger distance. It doesn't: the distance is $D_\text{min}$, and
# $\omega$ only decides at which detour it is given up. From $\omega = 0.5$ on nothing changes any more on these
# hundred routes.
#
# Turn it yourself. Out of the notch the route flips between $\omega = 0.2$ and $0.5$:


# %%
def draw(omega):
    price = penalty_zone(city, safe_distance, penalty=omega)
    turned = {"shortest": shortest, f"ω = {omega:.2f}": astar(city, notch, middle, price=price)}
    return plot.profile(city, turned, safe_distance=safe_distance, colors=COLORS)


values = {"omega": np.round(np.arange(0.0, 1.01, 0.05), 2)}
plot.sliders(draw, title="out of the notch", labels={"omega": "ω"}, start={"omega": 0.5}, progress=False, **values)


# %% [markdown]
# The same in numbers:

# %% tags=["nbval-check-output"]
for omega in (0.2, 0.3, 0.5, 2.0):
    route = astar(city, notch, middle, price=penalty_zone(city, safe_distance, penalty=omega))
    print(f"ω = {omega}: {route.length:.1f} m, smallest clearance {route.clearance(city):.1f} m")

# %% [markdown]
# ## A ring or a ball?
#
# Which nodes are in the zone? The paper's UAV looks at its *outer ring*: the 26 points $r$ cells away along each move
# (REPARE Fig. 5). A ring of radius $r$ reaches to the surface of an obstacle $r + \tfrac12$ cells away, so $r = 3$
# stands for 3.5 m. The library's default is the *ball*: every node whose distance to the nearest surface is below
# $D_\text{min}$. The 26 points of the ring reach further out at its corners, $\sqrt3\, r$, and see nothing in
# between:

# %% tags=["nbval-check-output"]
prices = {shape: penalty_zone(city, safe_distance, penalty=0.5, zone=shape) for shape in ("ball", "ring")}
zones = {shape: (price > 1) & ~city.occupied for shape, price in prices.items()}
missed = (zones["ball"] & ~zones["ring"]).sum() / zones["ball"].sum()
added = (zones["ring"] & ~zones["ball"]).sum() / zones["ball"].sum()
print(f"of the ball's {zones['ball'].sum():,} voxels the ring misses {missed:.1%}, and it adds {added:.1%}")
for shape, price in prices.items():
    route = astar(city, notch, middle, price=price)
    print(f"{shape}: {route.length:.2f} m, smallest clearance {route.clearance(city):.1f} m")
pole = np.zeros((11, 11, 11), bool)
pole[5, 5] = True
beside = {shape: penalty_zone(City(pole), safe_distance, penalty=1.0, zone=shape)[6, 6, 5] for shape in zones}
print(f"price diagonally beside a pole: ball {beside['ball']:.0f}, ring {beside['ring']:.0f}")
assert beside == {"ball": 2, "ring": 1}
assert (round(missed, 3), round(added, 3)) == (0.008, 0.047)

# %% tags=["figure"]
ball, ring = (zones[shape][:, :, 52] for shape in ("ball", "ring"))
areas = {"in both zones": ball & ring, "ring only": ring & ~ball, "ball only": ball & ~ring}
areas["building"] = city.occupied[:, :, 52]
plot.area_map(city, areas, area=(4, 62, 46, 100), title="Zones of 3.5 m, 52 m above the ground",
              colors={"in both zones": plot.SKY, "ring only": plot.YELLOW, "ball only": plot.ORANGE})  # fmt: skip

# %% [markdown]
# Around buildings as large as these the two hardly differ. But the ring overlooks a pole that stands *inside* it, and
# a nearer obstacle should never look safer than a far one. Hence the ball.
#
# ## Any angle
#
# A UAV doesn't have to fly along a lattice. How much longer than needed is a lattice route, even with nothing in the
# way? By Eq. 7 and the Cauchy–Schwarz inequality
#
# $$ h_\text{oct} = w \cdot (a, b, c) \le |w|\, h_\text{euc}, \tag{11} $$
# $$ |w| = \sqrt{1 + (\sqrt2 - 1)^2 + (\sqrt3 - \sqrt2)^2} = 1.128, $$
#
# with equality in the direction $w$ itself: 12.8 % too long, or 8.2 % if the flight stays level.

# %% tags=["figure"]
degrees = np.linspace(0, 90, 181)
azimuth, elevation = np.meshgrid(np.radians(degrees), np.radians(degrees), indexing="ij")
direction = np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)
weights = np.array([math.sqrt(3) - math.sqrt(2), math.sqrt(2) - 1, 1])
excess = np.tensordot(weights, np.sort(direction, axis=0), 1) - 1
assert math.isclose(np.linalg.norm(weights), 1.1281, abs_tol=5e-5)
assert math.isclose(excess.max(), 0.128, abs_tol=1e-3)
assert math.isclose(excess[:, 0].max(), 0.082, abs_tol=1e-3)
plot.heat_map(degrees, degrees, 100 * excess, "direction in the plan, from east to north [°]", "climb angle [°]",
              "lattice route longer than the straight line [%]", equal=True)  # fmt: skip

# %% [markdown]
# `shortcut` repairs that after the search. Number the waypoints of the route $0 \dots N$, and let $c(i, j)$ be the
# cost of the straight line from waypoint $i$ to waypoint $j$: its length, or with a price the integral of the price
# along it, and infinite if the line touches a blocked voxel. Then the cheapest way to $j$ over any subset of the
# waypoints before it is
#
# $$ \text{best}(0) = 0, \qquad \text{best}(j) = \min_{i < j}\, \bigl[\text{best}(i) + c(i, j)\bigr], \tag{12} $$
#
# filled from left to right: *dynamic programming*. On the hundred pairs:

# %% tags=["nbval-check-output"]
lattice = [astar(city, *pair) for pair in hundred]
straightened = [shortcut(route, city) for route in lattice]
means = {
    "A*, 26 moves": np.mean([route.length for route in lattice]),
    "A* + shortcut": np.mean([route.length for route in straightened]),
    "straight, through the walls": np.mean([np.linalg.norm(goal - start) for start, goal in hundred]),
}
gain = np.array([1 - short.length / route.length for route, short in zip(lattice, straightened, strict=True)])
print(f"shorter by {gain.mean():.1%} on average, by {gain.min():.1%} to {gain.max():.1%}")
assert (gain > -1e-12).all()
assert gain.mean() > 0.06

# %%
plot.bars(means, "length, mean of 100 pairs [m]")

# %% [markdown]
# That is no small change. Out of the notch, for example, the straightened route that keeps its distance is nearly as
# short as the lattice's shortest, which scrapes along the wall:

# %% tags=["nbval-check-output"]
price = penalty_zone(city, safe_distance, penalty=1.0)
safe = shortcut(astar(city, notch, middle, price=price), city, price=price)
for name, route in {**both, "A* + shortcut": safe}.items():
    print(f"{name:<19} {route.length:.2f} m, smallest clearance {route.clearance(city):.1f} m")
assert safe.clearance(city) >= safe_distance
assert safe.length < 1.02 * shortest.length

# %%
plot.plan(city, both, safe, colors=COLORS)

# %% [markdown]
# ## Any angle in the search itself
#
# A shortcut comes too late for one decision: on which side to pass a building. There the lattice route has chosen by
# its 26 directions, and a subset of its waypoints is on the same side. *Theta\** looks along straight lines while it
# searches. When A\* expands a node $n$, it offers each neighbour $n'$ the way over $n$. Theta\* offers the straight
# line from the parent of $n$:
#
# $$ g(n') = g(\text{parent}(n)) + c(\text{parent}(n), n'), \tag{13} $$
#
# so that a parent may be any node in sight. But looking along lines takes most of the time. The *lazy* variant (Nash,
# Koenig and Tovey 2010) offers the line as if it were free, and looks only when the neighbour's own turn comes. If
# something is in the way, the best of the neighbours that were expanded becomes the parent instead. `theta_star` does
# this, also with a price, and pulls the route taut around its corners at the end.

# %% tags=["nbval-check-output"]
any_angle = [theta_star(city, *pair) for pair in hundred]
again = np.array([1 - one.length / two.length for one, two in zip(any_angle, straightened, strict=True)])
print(f"Theta* against the shortcut: {again.mean():.1%} shorter on average, by {again.min():.1%} to {again.max():.1%}")
print(f"shorter by more than a thousandth on {(again > 1e-3).sum()} of 100 pairs, longer on {(again < -1e-3).sum()}")
assert again.mean() > 0.005

# %%
most = int(again.argmax())
plot.plan(city, {"A* + shortcut": straightened[most]}, any_angle[most])

# %% [markdown]
# The pair with the largest gain. Where the shortcut wins, it is by little. Nothing is exact here: any-angle shortest
# paths in three dimensions are a hard problem, for which no search on a grid has the answer.
#
# ## Hard and soft
#
# There are two ways to ask for distance. `penalty_zone` is **soft**: near walls is dear, but where there is no other
# way, the UAV goes near. `min_clearance` is **hard**: nearer voxels are closed like walls. Which one is right depends
# on what happens nearer: a higher chance of a scratch has a price, a propeller in the wall hasn't.
#
# A wall across the map with a door of 5 m by 5 m shows the difference. In the middle of the door the clearance is 2.5
# m:

# %% tags=["nbval-check-output"]
occupied = np.zeros((30, 30, 12), bool)
occupied[15] = True
occupied[15, 17:22, 4:9] = False
hall = City(occupied, name="A wall with a door")
room, yard = (4.5, 8.5, 6.5), (25.5, 8.5, 6.5)
zone = {omega: penalty_zone(hall, 3.5, penalty=omega) for omega in (1, 2)}
ways = {f"soft 3.5 m, ω = {omega}": astar(hall, room, yard, price=price) for omega, price in zone.items()}
ways |= {f"hard {least} m": astar(hall, room, yard, min_clearance=least) for least in (2.5, 3.5)}
for name, route in ways.items():
    result = f"{route.length:.1f} m, {route.clearance(hall):.1f} m clear" if route.reached else route.reason
    print(f"{name:<17} {result}")
assert [route.clearance(hall) for route in ways.values() if route.reached] == [0.5, 2.5, 2.5]
assert not ways["hard 3.5 m"].reached

# %%
plot.section(hall, 6.5, None, ways)

# %% [markdown]
# The soft zone is flat: half a metre from the frame costs as much as three. So with $\omega = 1$ the route takes the
# short way around the frame; only a higher price sends it through the middle, where the zone is thinnest. A zone that
# gets more expensive towards the wall is what REPARE tries to make with a force, in [07 REPARE](07_repare.ipynb).
#
# *There is no way* is an answer, not an error: `reached` is `False`, the cost is infinite, and the reason says how
# far the search got. It is also a proof. A* has seen every voxel within reach, so no route with that clearance exists
# on this grid. (A question that makes no sense, such as a start inside a wall, is an error and is refused.)
#
# One subtlety. Out of the notch, a hard 3.5 m gives a slightly longer route than the soft one that also kept 3.5 m
# all along:

# %% tags=["nbval-check-output"]
closed = astar(city, notch, middle, min_clearance=safe_distance)
print(f"soft {priced.length:.2f} m, hard {closed.length:.2f} m")
assert priced.length < closed.length

# %% [markdown]
# A closed voxel is a wall, and the rule against cutting corners holds for walls. A dear voxel is none: a diagonal
# move past its corner spends no metre inside it.

# %% [markdown]
# ## What the paper says, what we find

# %% tags=["nbval-check-output"]
differing = {omega: int((gaps > 1e-6).sum()) for omega, gaps in gap.items()}
largest = {omega: round(float(gaps.max()), 1) for omega, gaps in gap.items()}
print(f"REPARE Eq. 9:  octile expands {octile_share:.2f} of what the straight distance does")
print("REPARE Eq. 13: pairs of 100 that differ there and back", differing, "by up to [m]", largest)
found = [f"{route.length:.1f} m ({route.clearance(city):.1f} m clear)" for route in (shortest, priced, safe)]
print("REPARE Fig. 12:", *found)
assert round(octile_share, 2) == 0.20
assert differing == {0.1: 44, 0.2: 40}
assert largest == {0.1: 5.4, 0.2: 5.4}
assert (least[rates.index(0.5) :] >= safe_distance).all()
assert [round(route.length, 1) for route in (shortest, priced, safe)] == [66.4, 71.2, 67.7]

# %% [markdown]
# | REPARE | says | we find |
# |---|---|---|
# | Eqs 8–10 | estimate the rest by the straight distance | exact: it is consistent |
# | | | not the best: octile gives the same cost with 0.20 of the expansions |
# | Eqs 11–13 | $T = g\,(1 + O\,\omega) + h$ is the total cost | no cost of a route: it depends on the direction |
# | | | $\omega = 0.1$: there and back differ on 44 of 100 pairs, by up to 5.4 m |
# | | | $\omega = 0.2$: on 40 pairs, by up to 5.4 m |
# | | | as a price per metre (our Eq. 8): equal to $10^{-9}$ m on all |
# | Eq. 12 | larger $\omega$, larger distance | the distance is $D_\text{min}$, kept from $\omega = 0.5$ on |
# | Fig. 5 | a ring of 26 points sees obstacles | misses 0.8 % of the ball here, and a pole inside the ring |
# | Fig. 12 | the open list leads out of the notch | yes: 66.4 m, but 0.5 m from the wall |
# | | | with the penalty zone 71.2 m, straightened 67.7 m, both 3.5 m clear |
#
# Lengths and times against the potential field (REPARE's Table 2) are in
# [06 potential field](06_potential_field.ipynb) and [07 REPARE](07_repare.ipynb).
#
# ## Your turn
#
# Three exercises: write the octile distance, decide which moves are legal, and repair an A* that somebody broke:
# [exercises/05_astar_exercises.ipynb](exercises/05_astar_exercises.ipynb).
