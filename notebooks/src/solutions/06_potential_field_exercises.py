# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 06 The potential field: exercises
#
# They belong to the notebook [06 The potential field](../06_potential_field.ipynb). Put your answer in the place of
# `raise NotImplementedError`, or of the dots. Run the cell and then the check below it. The check says what is right,
# or what is wrong and what to think about. Ask it as often as you like.
#
# | | | |
# |---|---|---|
# | 06.1 Everything doubled | warm-up | 5 minutes |
# | 06.2 Where a wall stops the UAV | warm-up | 10 minutes |
# | 06.3 Only the nearest voxel pushes | to code | 20 minutes |
# | 06.4 The best move | to code | 15 minutes |
# | 06.5 How high must the goal be? | experiment | 15 minutes |
# | 06.6 A potential of your own | open | 40 minutes |

# %%
import heapq
import math
from itertools import product

import numpy as np
from scipy.ndimage import distance_transform_edt

from uavlab import exercises
from uavlab.city import table1_city
from uavlab.planners import potential_field

# %% [markdown]
# ## 06.1 Everything doubled
#
# *Warm-up · 5 minutes*
#
# A UAV flies with the chapter's `follow`, with a conic pull. Now you double both constants: $k_\text{tra}$ becomes 2,
# and $k_\text{rep}$ becomes 10 m³. The range $R$ stays as it is. What happens to the route?
#
# - **a** It keeps farther away from the walls.
# - **b** Nothing.
# - **c** It comes nearer to the walls.
# - **d** It stays the same, but the UAV needs half as many steps.
#
# The answer is one letter in quotes, such as `"a"`.

# %%
### BEGIN SOLUTION
doubled = "b"
### END SOLUTION

# %%
exercises.check("06.1", doubled)

# %% [markdown] tags=["solution"]
# Pull and push are both twice as large at each place, so the resultant is twice as large and points in the same
# direction. `follow` divides it by its size. Where pull and push cancel, they still do. So only the ratio
# $k_\text{rep}/k_\text{tra}$ can be tuned, and the forces have no newtons.

# %% [markdown]
# ## 06.2 Where a wall stops the UAV
#
# *Warm-up · 10 minutes*
#
# The goal lies behind a wide wall, straight across. The wall pushes only from its nearest point, with the size
#
# $$ k_\text{rep} \left(\frac1D - \frac1R\right) \frac1{D^2} $$
#
# within the range $R$ (`reach`). The goal pulls with the constant size `pull`. Return the distance $D$ from the wall at
# which the two cancel [m]. Any method will do, with an error below a micrometre. (The push is infinite at the wall and
# falls steadily to 0 at $R$.)


# %%
def balance(pull, push, reach):
    """Distance from the wall at which pull and push cancel [m]; `push` is k_rep."""
    ### BEGIN SOLUTION
    near, far = 0.0, reach  # the push wins at the one, the pull at the other
    for _ in range(100):
        middle = (near + far) / 2
        if push * (1 / middle - 1 / reach) / middle**2 > pull:
            near = middle
        else:
            far = middle
    return near
    ### END SOLUTION


# %%
exercises.check("06.2", balance)

# %% tags=["solution"]
assert exercises.check("06.2", balance)
for push in (5.0, 500.0, 50_000.0):
    print(f"k_rep = {push:>6g} m³, R = 5 m: it stops {balance(1.0, push, 5.0):.2f} m from the wall")

# %% [markdown] tags=["solution"]
# The push falls steadily, so it equals the pull at just one distance. We halve the interval that holds it, 100 times.
# (Multiplied out, the condition is the cubic equation $k_\text{tra} D^3 + (k_\text{rep}/R)\,D = k_\text{rep}$. That
# can be solved, too.)
#
# A push that is ten thousand times as strong moves the place from 1.5 m to 4.9 m. It never gets beyond $R$. So a
# stronger push doesn't remove the trap. It only moves it away from the wall.

# %% [markdown]
# ## 06.3 Only the nearest voxel pushes
#
# *Code · 20 minutes*
#
# In the chapter all voxels within the range push. Now write the other kind, `obstacles="surface"`: only the voxel that is
# nearest to the UAV pushes. `lows` is an array (M, 3) with the lowest corner of each of M voxels. A voxel is a cube with
# edges of 1 m, so it reaches from `low` to `low + 1` on all three axes. It pushes a UAV at `point` away from the cube's
# nearest point, with the size of 06.2 within `reach`, and not at all beyond. Return the force as a vector (3,). The UAV
# is never inside a voxel.


# %%
def push_of_nearest(point, lows, push, reach):
    """Force of the nearest of several voxels on a UAV at a point, (3,)."""
    ### BEGIN SOLUTION
    away = point - np.clip(point, lows, lows + 1)  # from the nearest point of each cube, (M, 3)
    distance = np.linalg.norm(away, axis=1)
    nearest = distance.argmin()
    away, distance = away[nearest], distance[nearest]
    if distance > reach:
        return np.zeros(3)
    return push * (1 / distance - 1 / reach) / distance**2 * away / distance
    ### END SOLUTION


# %%
exercises.check("06.3", push_of_nearest)

# %% tags=["solution"]
assert exercises.check("06.3", push_of_nearest)
wall = np.array([(0, y, z) for y in range(-10, 10) for z in range(-10, 10)])
print("2 m in front of a wall:", push_of_nearest(np.array([3.0, 0.5, 0.5]), wall, push=5.0, reach=5.0))

# %% [markdown] tags=["solution"]
# `np.clip(point, low, low + 1)` is the nearest point of a cube: on each axis the coordinate itself, if it lies between
# the two faces, and else the nearer face. It works for all cubes at once. The vector `away` is as long as the distance.
# So it has to be divided by the distance to become a direction.
#
# This kind of push is a gradient, too: of Eq. 4 with the smallest of all $D$. But it jumps from one direction to another
# where two voxels are equally near, for instance in the middle of a street.

# %% [markdown]
# ## 06.4 The best move
#
# *Code · 15 minutes*
#
# With lattice moves the UAV takes the move that points best along the force. `force` is a vector (3,). `moves` is a list
# of the legal moves, each `(i, j, k)` with parts $-1$, $0$ or $1$. Return the move whose *direction* makes the smallest
# angle with the force. Return `None` if no legal move has an angle below 90°. (The check asks nothing with two equally
# good moves.) Beware: the moves aren't equally long.


# %%
def best_move(force, moves):
    """The legal move with the smallest angle to the force; None when all lead sideways or back."""
    ### BEGIN SOLUTION
    best, most_along = None, 0.0
    for move in moves:
        along = np.dot(force, move) / np.linalg.norm(move)
        if along > most_along:
            best, most_along = move, along
    return best
    ### END SOLUTION


# %%
exercises.check("06.4", best_move)

# %% tags=["solution"]
assert exercises.check("06.4", best_move)
print("force (3, 1, 0):", best_move((3, 1, 0), [(1, 0, 0), (1, 1, 0), (1, 1, 1), (0, 1, 0)]))

# %% [markdown] tags=["solution"]
# The cosine of the angle is $\mathbf F\cdot\mathbf m/(|\mathbf F|\,|\mathbf m|)$. The force is the same for all moves, so
# $|\mathbf F|$ doesn't change the order. The length of the move does. For the force (3, 1, 0) the scalar product alone
# prefers (1, 1, 0), with 4 against 3. But (1, 0, 0) has the smaller angle, 18° against 27°.
#
# A cosine above 0 means an angle below 90°. At the bottom of a local minimum the force is small and all moves along
# it may be blocked. Then there is nothing to do.

# %% [markdown]
# ## 06.5 How high must the goal be?
#
# *Experiment · 15 minutes*
#
# The notch is open at the top: its walls end at 65 m, and above them the roof rises to a ridge at 70 m. Fly from (90,
# 18, 30) to the goal (50, 44, z), with continuous moves and otherwise the library's usual settings. With z = 30 the
# UAV is stuck. With z = 75 it arrives. What is the smallest whole number of metres for z with which it arrives?
#
# *Predict first:* will it be 65, 70, or something else? Why? What does the UAV do with a goal at 50 m?

# %%
### BEGIN SOLUTION
arriving = []
for z in range(30, 76):
    flight = potential_field(table1_city(), (90, 18, 30), (50, 44, z), moves="continuous")
    if flight.reached:
        arriving.append(z)
lowest_goal = min(arriving)
### END SOLUTION

# %%
exercises.check("06.5", lowest_goal)

# %% tags=["solution"]
assert exercises.check("06.5", lowest_goal)
for z in (50, 62, 63, 70):
    flight = potential_field(table1_city(), (90, 18, 30), (50, 44, z), moves="continuous")
    end = (
        f"arrives after {flight.length:.1f} m"
        if flight.reached
        else f"is stuck at a height of {flight.points[-1, 2]:.1f} m"
    )
    print(f"goal at {z} m: the UAV {end}; greatest height {flight.points[:, 2].max():.1f} m")

# %% [markdown] tags=["solution"]
# It is 63 m, two metres below the top of the walls. With a lower goal the UAV climbs along the wall to the height of
# its goal, and is stuck there: nothing in the notch pushes up or down, so the pull alone decides the height.
#
# Near the top this changes. The wall ends at 65 m, and the roof above it leans back. The UAV stops some 3.3 m from the
# wall. From there its range of 5 m covers the wall up to $\sqrt{5^2 - 3.3^2} = 3.8$ m above and below. With the goal at
# 62 m hardly anything is missing above, and what is missing would push very little. With the goal at 63 m more is
# missing. So the pushes from below win, lift the UAV, and after a long climb it gets over the roof. It has flown
# 130.9 m then, and with a goal at 70 m only 75.8 m.

# %% [markdown]
# ## 06.6 A potential of your own
#
# *Open · 40 minutes*
#
# The chapter has two potentials without traps. The cost-to-go makes short ways that scrape along walls. The
# harmonic potential keeps a distance and makes a longer way. Make one that is better than both.
#
# `free` is an array (nx, ny), `True` where a cell of 1 m is free, and `goal` is a cell `(x, y)`. Return an array of the
# same shape with the potential of each free cell. (What you put into occupied cells doesn't matter.) The check goes
# downhill in it with the chapter's rule: to the legal neighbour with the greatest drop per metre. It asks for three
# things.
#
# 1. From *every* free cell the way downhill ends at the goal. That is asked for on two maps: a small maze and the papers'
#    test city at 30 m.
# 2. In the test city, from the notch (90, 18) to the goal (50, 44), all cells of the way are at least 3.5 m from the
#    centre of the nearest occupied cell. `distance_transform_edt(free)` is this distance, for all cells.
# 3. That way is at most 72 m long. (The cost-to-go's is 66.4 m long, the harmonic one's 73.5 m.)
#
# You may use these two functions of the chapter.


# %%
def neighbours(free, cell):
    """Where the legal moves lead, and how long they are [m]."""
    for dx, dy in product((-1, 0, 1), repeat=2):
        x, y = cell[0] + dx, cell[1] + dy
        inside = (dx or dy) and 0 <= x < free.shape[0] and 0 <= y < free.shape[1]
        if inside and free[x, y] and free[cell[0], y] and free[x, cell[1]]:
            yield (x, y), math.hypot(dx, dy)


def downhill(height, free, cell):
    """The cells on the way down, to where no neighbour is lower."""
    way = [cell]
    while True:
        drop, best = max(((height[cell] - height[new]) / length, new) for new, length in neighbours(free, cell))
        if drop <= 0:
            return way
        way.append(cell := best)


# %%
def my_potential(free, goal):
    """A potential (nx, ny) whose ways downhill arrive, keep a distance and are short."""
    ### BEGIN SOLUTION
    price = np.where(distance_transform_edt(free) < 3.5, 4.0, 1.0)  # per metre
    cost = np.full(free.shape, np.inf)
    cost[goal] = 0.0
    waiting = [(0.0, goal)]
    while waiting:
        way, cell = heapq.heappop(waiting)
        if way > cost[cell]:
            continue
        for new, length in neighbours(free, cell):
            total = way + length * (price[cell] + price[new]) / 2
            if total < cost[new]:
                cost[new] = total
                heapq.heappush(waiting, (cost[new], new))
    return cost
    ### END SOLUTION


# %%
exercises.check("06.6", my_potential)

# %% tags=["solution"]
assert exercises.check("06.6", my_potential)
free = ~table1_city().occupied[:, :, 30]
way = np.array(downhill(my_potential(free, (50, 44)), free, (90, 18)))
length = np.linalg.norm(np.diff(way, axis=0), axis=1).sum()
print(f"{length:.1f} m, {distance_transform_edt(free)[tuple(way.T)].min():.1f} m from the nearest occupied centre")

# %% [markdown] tags=["solution"]
# This is the cost-to-go with a price: a metre near a wall counts as four. It isn't closed, so a UAV that starts
# there gets out. Why is there still no trap? The argument of the chapter holds for any positive price. The cheapest way
# from a cell begins with some move, and from the next cell the remaining way is cheaper by the cost of this move.
# So each cell has a lower neighbour.
#
# There are other answers. A price that falls smoothly with the distance, such as $1 + 3/D^2$, does it, too. You have just
# invented the idea of chapter 07: a search that makes sure of the arrival, and a price for being near
# a wall.
