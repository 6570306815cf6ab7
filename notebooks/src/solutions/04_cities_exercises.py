# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # Exercises: from buildings to voxels
#
# Three functions to write; the chapter is [04 cities](../04_cities.ipynb). Put your answer in the place of the line
# that raises `NotImplementedError`, run the cell, then the one after it: `exercises.check` says whether the answer
# is right, and if not, what to think about.

# %%
import math

import numpy as np

from uavlab import exercises
from uavlab.city import City, table1_city

city = table1_city()

# %% [markdown]
# ## 04.2 From a code back to its voxel
#
# Eq. 4 of the chapter gives each voxel one number, $n = k + n_z\,(j + n_y\,i)$. A planner that has found its goal
# holds a chain of such numbers, and has to turn each into a place again. Undo the formula, with whole-number
# division `//` and the remainder `%`.
#
# *Try it on paper first:* a map of 4 × 5 × 6 voxels. How many codes does one slab $i$ take up? Which voxel has code
# 37?


# %%
def node_index(code, shape):
    """The voxel (i, j, k) with this node code on a map of `shape` (nx, ny, nz) voxels."""
    ### BEGIN SOLUTION
    _, ny, nz = shape
    return code // (ny * nz), code // nz % ny, code % nz
    ### END SOLUTION


# %%
exercises.check("04.2", node_index)

# %% tags=["solution"]
assert exercises.check("04.2", node_index)
assert node_index(37, (4, 5, 6)) == (1, 1, 1)
assert node_index(901_830, city.shape) == tuple(city.index_of(901_830)) == (90, 18, 30)

# %% [markdown]
# ## 04.3 The distance to a voxel
#
# The clearance of Eq. 5 is measured from the centre of a voxel. A UAV is seldom there. Write the distance from
# **any** point to the nearest surface of one voxel, in metres. Voxel $(a, b, e)$ covers $[a, a+1) \times [b, b+1)
# \times [e, e+1)$ cells; the map begins at (0, 0, 0). Inside the voxel the distance is 0.
#
# *Think of one axis first:* the voxel is an interval. How far is a point from an interval, left of it, right of it,
# in it?


# %%
def box_clearance(point, voxel, cell):
    """Distance [m] from a point (3,) [m] to the voxel with indices (3,), whose edge is `cell` [m]."""
    ### BEGIN SOLUTION
    center = (np.asarray(voxel) + 0.5) * cell
    outside = np.maximum(np.abs(np.asarray(point) - center) - cell / 2, 0)
    return float(np.sqrt((outside**2).sum()))
    ### END SOLUTION


# %%
exercises.check("04.3", box_clearance)

# %% tags=["solution"]
assert exercises.check("04.3", box_clearance)

# %% [markdown]
# Once it is right, it should agree with the library: the smallest distance from a node to any of the occupied voxels
# is `city.clearance`.

# %%
if exercises.check("04.3", box_clearance):
    coarse, node = table1_city(4.0), (9, 1, 12)
    nearest = min(box_clearance(coarse.center_of(node), voxel, coarse.cell) for voxel in np.argwhere(coarse.occupied))
    print(f"yours {nearest:.3f} m, the library's {coarse.clearance[node]:.3f} m")
    assert math.isclose(nearest, coarse.clearance[node])

# %% [markdown]
# ## 04.4 How much of a street is left?
#
# Two long, high walls stand `gap` metres apart, across the x axis. The map takes the papers' rule: a voxel is occupied
# when its centre lies in a wall (`voxels="centres"`). You don't choose where the grid begins, so expect the worst. How
# much clearance is a planner **sure** to find in the street, at its best node, on the most unlucky grid? Return 0 when
# an unlucky grid closes the street.
#
# *Three things to count with:* How many centres are sure to lie strictly between the walls (a centre on a wall is
# inside it)? They are the free voxels, in a row. Which of them is farthest from the occupied ones on both sides?
# And how far is its centre from their surface? Draw a row of three and a row of four.
#
# Then use it: a street is 10 m wide and the UAV must keep 3.5 m. Which is the coarsest of 0.5, 1, 2 and 4 m? Does a
# coarser cell always leave less? Try 3 m.


# %%
def street_clearance(gap, cell):
    """Clearance [m] that is certain somewhere between walls `gap` [m] apart, with voxels of edge `cell` [m]."""
    ### BEGIN SOLUTION
    free = math.ceil(gap / cell) - 1
    return (math.ceil(free / 2) - 0.5) * cell if free > 0 else 0.0
    ### END SOLUTION


# %%
exercises.check("04.4", street_clearance)

# %% tags=["solution"]
assert exercises.check("04.4", street_clearance)
assert [cell for cell in (0.5, 1.0, 2.0, 4.0) if street_clearance(10.0, cell) >= 3.5] == [0.5, 1.0]
assert street_clearance(10.0, 3.0) > street_clearance(10.0, 2.0)  # coarser is not always worse

# %%
if exercises.check("04.4", street_clearance):
    for cell in (0.5, 1.0, 2.0, 3.0, 4.0):
        print(f"street of 10 m, voxels of {cell:g} m: {street_clearance(10.0, cell):.2f} m are certain")

# %% [markdown] tags=["solution"]
# 1 m is the coarsest that will do: 2 m leaves 3 m, because a grid whose centres fall on both walls loses a voxel on
# either side. And 3 m leaves 4.5 m: three voxels in a row have one in the middle, four have none. But this is clearance
# from voxels: by centres a wall may stand up to half a cell before its voxels, so 3 m of the 4.5 m are certain. With
# `voxels="touched"` only `floor(gap / cell) - 1` voxels are sure to be free, and what they keep is true. The same by
# throwing grids, without a formula:


# %% tags=["solution"]
def thrown(gap, cell, shift):
    """The best clearance in the street when the grid is shifted by `shift` [m]."""
    centers = shift + cell * (np.arange(-20, math.ceil(gap / cell) + 20) + 0.5)
    occupied = (centers <= 0) | (centers >= gap)
    return City(np.tile(occupied[:, None, None], (1, 1, 1)), cell).clearance.max()


for cell in (0.5, 1.0, 2.0, 3.0, 4.0):
    shifts = np.append(np.random.default_rng(1).uniform(0, cell, 200), cell / 2)  # and one with a centre on the wall
    worst = min(thrown(10.0, cell, shift) for shift in shifts)
    print(f"{cell:g} m: {worst:.2f} m on the worst of {len(shifts)} grids")
    assert math.isclose(worst, street_clearance(10.0, cell))
