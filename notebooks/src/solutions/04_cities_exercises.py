# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 04 Cities: exercises
#
# Six exercises for the chapter [04 Cities](../04_cities.ipynb). Put your answer in the place of the line that raises
# `NotImplementedError`, or of the dots. Run the cell, then the one after it. `exercises.check` says whether the answer
# is right, and if not, what to think about. Ask it as often as you like.

# %%
import math
from itertools import product

import numpy as np

from uavlab import exercises
from uavlab.city import Building, City, table1_city

# %% [markdown]
# ## 04.1 What a free voxel tells you
#
# *Warm-up · 5 minutes*
#
# A city map was made by the rule of *centres*, with voxels of 2 m. In this map a planner finds a row of free voxels
# between two houses. What do you know about the real gap between them?
#
# - **a** The free voxels hold no part of a house, so the gap is at least 2 m wide.
# - **b** The centres of these voxels lie in no house. The real gap may be much narrower than 2 m.
# - **c** Nothing, since the map may have been shifted.
# - **d** The gap is wider than 2 m, because centres make houses larger.

# %%
### BEGIN SOLUTION
choice_1 = "b"
### END SOLUTION

# %%
exercises.check("04.1", choice_1)

# %% [markdown] tags=["solution"]
# Only the centre of each voxel was looked at. The two walls may come near to it from both sides. So the gap can be a
# few centimetres wide. By touch, answer a would be right.

# %% [markdown]
# ## 04.2 From a code back to its voxel
#
# *Warm-up · 10 minutes*
#
# Eq. 3 of the chapter gives each voxel one number: $n = i\,N_yN_z + j\,N_z + k$. A planner that has found its goal holds
# a chain of such numbers. It has to turn each of them into a place again. Undo the formula, with whole-number division
# `//` and the remainder `%`.
#
# Try it on paper first, on a map of 4 × 5 × 6 voxels. How many codes does one slab $i$ take up? Which voxel has the code
# 37?


# %%
def node_index(code, shape):
    """The voxel (i, j, k) with this code on a map of `shape` (nx, ny, nz) voxels."""
    ### BEGIN SOLUTION
    _, ny, nz = shape
    return code // (ny * nz), code // nz % ny, code % nz
    ### END SOLUTION


# %%
exercises.check("04.2", node_index)

# %% tags=["solution"]
assert exercises.check("04.2", node_index)
city = table1_city()
assert node_index(37, (4, 5, 6)) == (1, 1, 1)
assert node_index(901_830, city.shape) == tuple(city.index_of(901_830)) == (90, 18, 30)

# %% [markdown] tags=["solution"]
# A slab has $N_yN_z$ codes, so `code // (ny * nz)` is how many whole slabs come before: that is $i$. In the same way
# `code // nz` is how many rows come before, in all slabs. The remainder by $N_y$ leaves those of the own slab: $j$. What
# remains within a row is $k$. On the map of 4 × 5 × 6 voxels, 37 = 1·30 + 1·6 + 1.

# %% [markdown]
# ## 04.3 The distance to a voxel
#
# *Code · 15 minutes*
#
# The clearance of Eq. 4 is measured from the centre of a voxel. A UAV is seldom there. Write the distance from **any**
# point to the nearest surface of one voxel, in metres. Voxel $(i', j', k')$ covers $i'$ to $i'+1$ cells on the x axis,
# $j'$ to $j'+1$ on the y axis and $k'$ to $k'+1$ on the z axis. The map begins at (0, 0, 0). Inside the voxel the
# distance is 0.
#
# Think of one axis first. The voxel is an interval. How far is a point from an interval when it is left of it, right of
# it, or in it?


# %%
def box_clearance(point, voxel, cell):
    """Distance [m] from a point (3,) [m] to the voxel with indices (3,), whose edge is `cell` [m]."""
    ### BEGIN SOLUTION
    centre = (np.asarray(voxel) + 0.5) * cell
    outside = np.maximum(np.abs(np.asarray(point) - centre) - cell / 2, 0)
    return float(np.sqrt((outside**2).sum()))
    ### END SOLUTION


# %%
exercises.check("04.3", box_clearance)

# %% [markdown]
# Once it is right, it should agree with the library. The smallest distance from a node to any occupied voxel is
# `city.clearance`:

# %%
if exercises.check("04.3", box_clearance):
    coarse, node = table1_city(4.0), (9, 1, 12)
    nearest = min(box_clearance(coarse.center_of(node), voxel, coarse.cell) for voxel in np.argwhere(coarse.occupied))
    print(f"yours {nearest:.3f} m, the library's {coarse.clearance[node]:.3f} m")

# %% tags=["solution"]
assert exercises.check("04.3", box_clearance)
assert math.isclose(nearest, coarse.clearance[node])

# %% [markdown] tags=["solution"]
# On each axis the point is `|x - centre|` from the middle of an interval with the half length `cell / 2`. The rest is
# outside of it, and never negative. The three rests are at right angles, so Pythagoras joins them. A second way is to
# clip the point to the voxel with `np.clip` and to measure the distance to the clipped point.

# %% [markdown]
# ## 04.4 How much of a street is left?
#
# *Code · 25 minutes*
#
# Two long, high walls stand `gap` metres apart, across the x axis. The map is made by centres. A centre that lies on the
# face of a wall counts as inside. You don't choose where the grid begins, so expect the worst. How much clearance is a
# planner **sure** to find in the street, at its best node, on the most unlucky grid? Return 0 when an unlucky grid closes
# the street.
#
# Take three steps. How many centres are sure to lie strictly between the walls? These are the free voxels, in a row.
# Which of them is farthest from the occupied voxels on both sides? How far is its centre from their surface? Draw a row
# of three and a row of four.


# %%
def street_clearance(gap, cell):
    """Clearance [m] that is certain somewhere between walls `gap` [m] apart, with voxels of edge `cell` [m]."""
    ### BEGIN SOLUTION
    free = math.ceil(gap / cell) - 1
    return (math.ceil(free / 2) - 0.5) * cell if free > 0 else 0.0
    ### END SOLUTION


# %%
exercises.check("04.4", street_clearance)

# %% [markdown]
# Then use it. A street is 10 m wide, and the UAV must keep 3.5 m. Which is the coarsest of 0.5, 1, 2 and 4 m? Does a
# coarser voxel always leave less? Look at 3 m.

# %%
if exercises.check("04.4", street_clearance):
    for cell in (0.5, 1.0, 2.0, 3.0, 4.0):
        print(f"street of 10 m, voxels of {cell:g} m: {street_clearance(10.0, cell):.2f} m are certain")

# %% tags=["solution"]
assert exercises.check("04.4", street_clearance)
assert [cell for cell in (0.5, 1.0, 2.0, 4.0) if street_clearance(10.0, cell) >= 3.5] == [0.5, 1.0]
assert street_clearance(10.0, 3.0) > street_clearance(10.0, 2.0)  # coarser is not always worse

# %% [markdown] tags=["solution"]
# Centres are `cell` apart. The most unlucky grid has as few of them between the walls as possible: `ceil(gap / cell) -
# 1`. A row of $m$ free voxels has its best node in the middle. With an odd $m$ that node is $m/2$ cells from both
# surfaces. With an even $m$ there is no node in the middle, and the best one is $(m-1)/2$ cells away. Both are
# `(ceil(m / 2) - 0.5)` cells.
#
# 1 m is the coarsest that will do. 2 m leaves 3 m: a grid whose centres fall on both walls loses a voxel on either side.
# And 3 m leaves 4.5 m, because three voxels in a row have one in the middle, and four have none. But this is clearance
# from *voxels*. By centres a wall may stand up to half a voxel before the voxels that stand for it, so of these 4.5 m
# only 3 m are certain. The same by trying grids, without a formula:


# %% tags=["solution"]
def tried(gap, cell, shift):
    """The best clearance in the street when the grid is shifted by `shift` [m]."""
    centres = shift + cell * (np.arange(-20, math.ceil(gap / cell) + 20) + 0.5)
    occupied = (centres <= 0) | (centres >= gap)
    return City(occupied[:, None, None], cell).clearance.max()


for cell in (0.5, 1.0, 2.0, 3.0, 4.0):
    shifts = np.append(np.random.default_rng(1).uniform(0, cell, 200), cell / 2)  # and one with a centre on the wall
    worst = min(tried(10.0, cell, shift) for shift in shifts)
    print(f"{cell:g} m: {worst:.2f} m on the worst of {len(shifts)} grids")
    assert math.isclose(worst, street_clearance(10.0, cell))

# %% [markdown]
# ## 04.5 A mast that the ring doesn't see
#
# *Experiment · 20 minutes*
#
# In the test city the ring of 26 nodes missed about 1 % of the nodes that are too near. The buildings there are large. A
# mast is thin. Here is one, a column of voxels of 1 m, with the ring of the chapter.
#
# The exact zone of radius $q$ are the free nodes with a clearance below $q + \tfrac12$ metres. What share of the exact
# zone does the ring **miss**, for $q = 3$, 4 and 5? Guess first. Then compute the three shares (numbers from 0 to 1), and
# put them into a list. What does the result mean for a planner that trusts its ring?


# %%
def ring_meets_obstacle(occupied, radius):
    """Whether a node of the ring is occupied, for each voxel."""
    padded = np.pad(occupied, radius)
    nx, ny, nz = occupied.shape
    meets = np.zeros(occupied.shape, dtype=bool)
    for i, j, k in product((0, radius, 2 * radius), repeat=3):
        meets |= padded[i : i + nx, j : j + ny, k : k + nz]
    return meets


mast = np.zeros((31, 31, 11), dtype=bool)
mast[15, 15, :] = True

# %%
### BEGIN SOLUTION
free, clearance = ~mast, City(mast).clearance
missed_by_ring = []
for radius in (3, 4, 5):
    zone = free & (clearance < radius + 0.5)
    missed_by_ring.append((zone & ~ring_meets_obstacle(mast, radius)).sum() / zone.sum())
missed_shares = missed_by_ring
### END SOLUTION

# %%
exercises.check("04.5", missed_shares)

# %% tags=["solution"]
assert exercises.check("04.5", missed_shares)
print("missed:", ", ".join(f"{share:.1%}" for share in missed_shares))

# %% [markdown] tags=["solution"]
# The ring misses 91, 95 and 96 %. Seen from above, it has only nine places: the middle and eight around it. A thin mast is
# in one of the eight only for eight nodes of a layer, and only four of these are in the zone (the four corners are
# $\sqrt2\,q$ away). The zone has 44, 76 and 108 nodes in a layer. So the ring sees 4 of 44, 4 of 76 and 4 of 108. A planner
# that trusts its ring flies right beside a mast, a crane or a flagpole, and pays nothing for it.

# %% [markdown]
# ## 04.6 A map of your own
#
# *Open · 30 minutes*
#
# Make a map of this quarter: four houses and two crossing streets, which are 5.3 m and 5.2 m wide. A small computer on
# the UAV has room for 50 000 voxels. Your map, a `City`, has to do all of the following:
#
# 1. It covers at least the box from (0, 0, 0) to (56, 42, 20) m.
# 2. It has at most 50 000 voxels.
# 3. No free voxel holds a piece of a house.
# 4. In the middle of each street (between the houses, at 5 m height) some node has a clearance of at least 2 m.
# 5. The occupied voxels have at most 15 % more volume than the houses.
#
# You may choose `cell`, `origin` and `size` of `City.from_buildings`. The check says what your map has. Several answers
# are right.

# %%
houses = [
    Building.prism([(west, south), (east, south), (east, north), (west, north)], 14.0)
    for west, east in ((4.2, 23.3), (28.6, 51.4))
    for south, north in ((3.1, 16.9), (22.1, 38.7))
]
first_try = City.from_buildings(houses, cell=1.0, origin=(0, 0, 0), size=(56, 42, 20))
print(first_try, f"{first_try.occupied.size:,} voxels")

# %%
### BEGIN SOLUTION
own_map = City.from_buildings(houses, cell=1.0, origin=(-0.6, 0, 0), size=(57, 42, 20))
### END SOLUTION

# %%
exercises.check("04.6", own_map)

# %% tags=["solution"]
assert exercises.check("04.6", own_map)
assert not exercises.check("04.6", first_try)

# %% [markdown] tags=["solution"]
# 50 000 voxels for 47 040 m³: with voxels of 1 m or a little less there is no room to be finer. With an odd number of free
# voxels in a row, one is in the middle. Five voxels of 1 m in a row leave 2.5 m, four leave only 1.5 m. By touch, a street
# of 5.3 m from x = 23.3 to 28.6 has five whole voxels only if a face of the grid lies between 23.3 and 23.6. So the origin
# must be moved to the west by 0.4 to 0.7 m, for example by 0.6 m. The other street, from y = 16.9 to 22.1, has faces at 17
# and 22 already. A grid is our choice: where it matters, put it where it fits.
