# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 04 Cities: what does a planner see of a city?
#
# A computer that plans a flight wants a finite list of places, and two answers for each of them. May the UAV (unmanned
# aerial vehicle) be here? How far is the nearest wall? So we cut a city into cubes and measure distances to them. Large
# cubes need little memory, but they close alleys, and by some rules they lose walls. Then a route leads through a wall.
# How small must they be? At the end you read a city from a file.
#
# | | |
# |---|---|
# | **You will be able to** | decide whether a point is inside a building; turn buildings into voxels by two rules and say how each rule errs; compute the distance to the nearest wall; choose a size for the voxels that suits your alleys and your UAV; read a city from a file and judge the report |
# | **You need** | vectors and their scalar product, NumPy; from chapter [02](02_pauta.ipynb) only that gusts push a UAV aside, so that it must keep a distance from obstacles |
# | **Time** | 70 minutes to read, 30 seconds to run |
# | **Paper** | REPARE, sections 2.3.1 and 3.1, Tables 1 and 4 ([doi:10.3390/s22062151](https://doi.org/10.3390/s22062151)) |
#
# *Run All* (in the menu **Run**) brings the 3D scenes and the sliders to life.

# %%
import json
import warnings
from dataclasses import replace
from itertools import product
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import shapely
from matplotlib.colors import PowerNorm
from scipy.spatial import ConvexHull, HalfspaceIntersection

from uavlab import plot, scene
from uavlab.city import Building, City, Place, Terrain, read_city, table1_city
from uavlab.planners import astar, penalty_zone
from uavlab.route import Route

COLORS = {"occupied voxels": "0.5", "true walls": plot.ORANGE, "edges of the voxels": "0.85"}

# %% [markdown]
# ## The papers' test city
#
# REPARE is a planner: its routes keep a distance from walls (chapter [07](07_repare.ipynb)). Its paper tests it in
# this city of 100 × 100 × 100 m. Table 1 there gives five buildings as lists of corners.
#
# | | shape | what the corners say |
# |---|---|---|
# | 1 | notch | 15 corners: an L of two wings, walls up to 65 m, and a ridge (the top line of the roof) along both wings at 70 m |
# | 2 | hip roof | walls up to 60 m, then a roof that slopes on all four sides, up to a ridge at 65 m |
# | 3 | frustum | walls up to 80 m, then a pyramid that is cut off at 90 m |
# | 4 | floating | a slab from 45 to 60 m above the ground, oblique to the axes; there is air below it |
# | 5 | spire | a thin tower with six sides, 5 × 9 m: walls up to 95 m, and one tip at 99 m |

# %%
city = replace(table1_city(), name="the papers' test city")

# %% tags=["figure"]
scene.show(city)


# %% tags=["figure"]
def outlines(buildings):
    """Outlines from above, with a row of NaN after each."""
    hulls = [[shapely.convex_hull(shapely.MultiPoint(p[:, :2])) for p in b.pieces] for b in buildings]
    return np.vstack([[*shapely.get_coordinates(shapely.union_all(hull)), [np.nan, np.nan]] for hull in hulls])


heights = dict(zip(city.buildings, ("to 70 m", "to 65 m", "to 90 m", "45 to 60 m", "to 99 m"), strict=True))
plot.diagram("x, east [m]", "y, north [m]", areas={f"{b.name}, {high}": outlines([b])[:-1] for b, high in heights.items()},
             colors={f"{b.name}, {high}": b.color for b, high in heights.items()} | {"walls, from above": "0.4"}, x_range=(0, 100), y_range=(0, 100),
             paths={"walls, from above": outlines(city.buildings)}, notes={b.name[0]: b.pieces[0][:, :2].mean(0) for b in city.buildings},
             title="The papers' test city from above, with its heights")  # fmt: skip

# %% [markdown]
# *The papers' test city in three dimensions and from above.*
#
# ## Is a point inside a building?
#
# A body is *convex* when the straight line between any two of its points stays inside. Buildings 2 to 5 are convex.
#
# Take one face. Let $\mathbf p$ be one of its corners. Let $\mathbf u$ be the vector of length 1 at right angles to the
# face that points out of the body (its *normal*). Then $\mathbf u\cdot(\mathbf x-\mathbf p)$ is how far a point
# $\mathbf x$ lies in front of the plane of the face, in metres. Behind the face it is negative. A convex body is what
# lies behind all of its faces:
#
# $$\mathbf x \text{ is inside} \iff \mathbf u\cdot(\mathbf x - \mathbf p) \le 0 \quad\text{for every face}. \tag{1}$$
#
# SciPy's `ConvexHull` makes the faces from the corners. Each row of its `equations` has the three numbers of $\mathbf
# u$, and then $-\mathbf u\cdot\mathbf p$. (It cuts faces into triangles, so some rows are equal. We keep one of
# each: a floor, four walls, four slopes. `pieces` are the convex pieces of a building.) We test two points 62 m high in
# building 2, whose walls end at 60 m and whose ridge is at 65 m.

# %% tags=["nbval-check-output"]
hip_roof = city.buildings[1]
faces = np.unique(ConvexHull(np.vstack(hip_roof.pieces)).equations.round(9), axis=0)
for name, point in {"near the ridge": (22, 35, 62), "at the west wall": (12, 35, 62)}.items():
    in_front = faces[:, :3] @ point + faces[:, 3]
    print(f"{name + ':':<17} largest of {len(faces)} values {in_front.max():+.2f} m, inside: {in_front.max() <= 0}")

# %% tags=["check"]
assert len(faces) == 9  # floor, four walls, four slopes
assert hip_roof.contains([(22, 35, 62), (12, 35, 62)]).tolist() == [True, False]

# %% [markdown]
# The second point lies 1.08 m in front of the western slope.
#
# The smallest convex body around some corners is their *convex hull*. For building 1 it also contains the air in the
# notch. So this building is a *union* of two convex pieces, its wings: a point is inside when it is inside at least one
# of them. We compare the volumes, and look at a point between the wings:

# %% tags=["nbval-check-output"]
notch = city.buildings[0]
filled = Building.hull(np.vstack(notch.pieces))  # the hull of all corners
west, east = (ConvexHull(piece) for piece in notch.pieces)
in_both = np.array([65.0, 40.0, 30.0])  # a point in both wings
overlap = HalfspaceIntersection(np.vstack([west.equations, east.equations]), in_both)
notch_volume = west.volume + east.volume - ConvexHull(overlap.intersections).volume  # the overlap only once
print(f"the hull is {ConvexHull(np.vstack(notch.pieces)).volume / notch_volume - 1:.0%} larger")
in_the_notch = (80, 30, 30)
print("inside, by the hull:", filled.contains(in_the_notch), "by the wings:", notch.contains(in_the_notch))

# %% tags=["check"]
assert filled.contains(in_the_notch)
assert not notch.contains(in_the_notch)
assert abs(ConvexHull(np.vstack(notch.pieces)).volume / notch_volume - 1.48) < 0.005

# %% [markdown]
# ## From buildings to voxels
#
# Cut the box into cubes with the edge $a$, called *voxels* or *cells*, and count them from 0 on each axis. With
# $\mathbf x_0$ for the lowest corner of the map, the centre of voxel $(i, j, k)$ is
#
# $$\mathbf x_{ijk} = \mathbf x_0 + a\,\bigl(i+\tfrac12,\; j+\tfrac12,\; k+\tfrac12\bigr). \tag{2}$$
#
# The centres are the *nodes*: a planner chooses its way among them. In arrays, each node has one number, its *code*
#
# $$n = i\,N_yN_z + j\,N_z + k, \tag{3}$$
#
# where $N_y$ and $N_z$ are the numbers of voxels along y and z: $i$ slabs come before it, then $j$ rows, then $k$
# voxels. (Planners store routes as such codes.)
#
# A voxel is free or occupied, as a whole. There are two rules for that:
#
# - **By centres.** A voxel is occupied when its centre lies in a building.
# - **By touch.** A voxel is occupied when a building reaches into it (not only to its border). So a free voxel holds no
#   part of any building.
#
# The text that we have of the paper doesn't name a rule. For the test city the library takes centres, as its walls
# mostly lie on whole metres; else it marks by touch. Centres need only Eq. 1, so we do the hip roof by hand:

# %% tags=["nbval-check-output"]
steps = np.arange(100) + 0.5
centres = np.stack(np.meshgrid(steps, steps, steps, indexing="ij"), axis=-1)
by_hand = np.ones((100, 100, 100), dtype=bool)
for face in faces:
    by_hand &= centres @ face[:3] + face[3] <= 1e-9  # 1e-9 m, for rounding
box = {"origin": (0, 0, 0), "size": (100, 100, 100)}  # lowest corner and extent of the map [m]
library = City.from_buildings([hip_roof], cell=1.0, voxels="centres", **box)
same = np.array_equal(by_hand, library.occupied)
print(f"{by_hand.sum():,} of {by_hand.size:,} voxels, as in the library: {same}")

# %% tags=["check"]
assert by_hand.sum() == 62_094
assert city.code_of((90, 18, 30)) == 901_830 == 90 * 10_000 + 18 * 100 + 30

# %% [markdown]
# Both rules, for a block and a thin wall oblique to the axes:

# %% tags=["figure"]
block = Building.prism([(3, 3), (11, 6), (9.5, 10), (1.5, 7)], 2)
fence = Building.prism([(14, 2), (20, 10), (19.5, 10.4), (13.5, 2.4)], 2)

edges = [[(x, 0), (x, 12), (np.nan, np.nan)] for x in range(0, 23, 2)]
edges += [[(0, y), (22, y), (np.nan, np.nan)] for y in range(0, 13, 2)]
figure, panels = plot.new_panels(1, 2, share="y", width=9.4, height=3.3)
for axes, rule, title in zip(panels, ("centres", "touched"), ("By centres (the dots)", "By touch"), strict=True):
    small = City.from_buildings([block, fence], cell=2.0, origin=(0, 0, 0), size=(22, 12, 2), voxels=rule)
    axes.plot(*np.meshgrid(small.coordinates(0), small.coordinates(1)), ".", color="0.2", markersize=3)
    plot.area_map(small, {"occupied voxels": small.occupied[:, :, 0]}, title=title, axes=axes,
                  paths={"edges of the voxels": np.vstack(edges), "true walls": outlines([block, fence])}, colors=COLORS)  # fmt: skip
    axes.set_xticks(range(0, 23, 4))
figure

# %% [markdown]
# *A block and a wall of about 0.6 m from above, in voxels of 2 m.* By centres two voxels of the wall are left. By touch
# nothing is lost, but block and wall are too large.
#
# The five buildings:

# %% tags=["nbval-check-output"]
touched = City.from_buildings(city.buildings, cell=1.0, voxels="touched", **box)
between = touched.occupied & ~city.occupied
convex = [ConvexHull(np.vstack(building.pieces)).volume for building in city.buildings[1:]]
exact_volume = notch_volume + sum(convex)
print(f"exact volume {exact_volume:,.0f} m³")
for rule, grid in (("centres", city), ("touch", touched)):
    n, share = grid.occupied.sum(), grid.occupied.mean()
    print(f"by {rule}: {n:,} voxels of 1 m³ ({share:.1%} of the map), {n / exact_volume - 1:+.1%}")
print(f"free by centres, although a building reaches into them: {between.sum():,} voxels")

# %% tags=["check"]
assert city.occupied.sum() == 144_858
assert round(exact_volume) == 144_372
assert between.sum() == 2_099
assert not (city.occupied & ~touched.occupied).any()
assert abs(city.occupied.sum() / exact_volume - 1.0034) < 5e-5
assert abs(touched.occupied.sum() / exact_volume - 1.018) < 5e-4

# %% [markdown]
# By centres the volume is nearly right. But 2 099 free voxels hold a piece of a wall or a roof.

# %% tags=["figure"]
coarse = table1_city(4.0)
scene.show(City(coarse.occupied, coarse.cell, name="The papers' test city in voxels of 4 m, by centres"))

# %% [markdown]
# *The same city in voxels of 4 m: roofs are steps, and the spire is a block.*
#
# ## How far is the nearest wall?
#
# A UAV has to keep away from obstacles. So for each node we want the *clearance* $D$: the distance from its centre to
# the nearest **surface** of an occupied voxel.
#
# So clearance is measured to the map, not to the true walls. By touch, the true walls are at least as far away. By
# centres a wall may be nearer.
#
# > **Predict first.** One voxel of 1 m is occupied. Two free nodes are both exactly 5 m away from its centre. One is
# > five voxels to the east, the other three to the east and four to the north. Do they have the same clearance?
#
# Take the x axis first. An occupied voxel $i'$ is an interval of one cell around its centre. The node $i$
# is $|i-i'|$ cells from this centre, and half a cell less from the end of the interval:
#
# $$\operatorname{gap}(s) = \max\bigl(|s| - \tfrac12,\; 0\bigr)$$
#
# The three axes are at right angles, so by Pythagoras
#
# $$D = a\,\min_{(i',j',k')\ \text{occupied}} \sqrt{\operatorname{gap}(i-i')^2 + \operatorname{gap}(j-j')^2 + \operatorname{gap}(k-k')^2}. \tag{4}$$
#
# For the two nodes of the question, $D$ is 4.5 m and $\sqrt{2.5^2+3.5^2} = 4.30$ m. **They differ.** The
# distance between centres would be too large by half a cell straight ahead, and by up to half the diagonal,
# $\tfrac12\sqrt3 = 0.87$ cells, towards a corner.

# %% tags=["figure"]
corners = [(0, 0), (1, 0), (1, 1), (0, 1), (0, 0)]
nodes = {"straight ahead": (5.5, 0.5), "aslant": (3.5, 4.5)}
lines = [[(x, -0.5), (x, 5.5), (np.nan, np.nan)] for x in range(7)]
lines += [[(-0.5, y), (6.5, y), (np.nan, np.nan)] for y in range(6)]
plot.diagram("x, east [cells]", "y, north [cells]", areas={"occupied voxel": corners}, points={"two nodes": list(nodes.values())},
             paths={"edges of the voxels": np.vstack(lines), "between centres": [(0.5, 0.5), (5.5, 0.5), (np.nan, np.nan), (0.5, 0.5), (3.5, 4.5)],
                    "clearance": [(1, 0.5), (5.5, 0.5), (np.nan, np.nan), (1, 1), (3.5, 4.5)]},
             notes={"4.50 cells": (3.2, 0.15), "4.30 cells": (2.7, 2.5)}, title="Clearance ends at the surface, not at the centre",
             colors=COLORS | {"occupied voxel": "0.4", "between centres": plot.ORANGE, "clearance": plot.BLUE, "two nodes": plot.BLACK})  # fmt: skip

# %% [markdown]
# *The two nodes from above. Straight ahead, blue lies on orange.*
#
# ### All nodes at once
#
# A million nodes times 144 858 occupied voxels are 145 billion distances. But each of the three terms under the root
# depends on one index only. So we can take three minima one after the other, first over $k'$, then over $j'$, then
# over $i'$:
#
# $$\begin{aligned}
# Z_1(i',j',k) &= \min_{k'}\bigl[\operatorname{gap}(k-k')^2 + Z_0(i',j',k')\bigr], \\
# Z_2(i',j,k) &= \min_{j'}\bigl[\operatorname{gap}(j-j')^2 + Z_1(i',j',k)\bigr], \\
# D^2 &= a^2\,\min_{i'}\bigl[\operatorname{gap}(i-i')^2 + Z_2(i',j,k)\bigr],
# \end{aligned} \tag{5}$$
#
# where $Z_0$ is 0 for occupied voxels and infinite for free ones. Each minimum runs along one line of voxels. This is
# the *distance transform*. By hand:


# %%
def distance_transform(occupied, cell):
    """Clearance of each voxel [m]."""
    squared = np.where(occupied, 0.0, np.inf)
    for axis in (2, 1, 0):
        lines = np.moveaxis(squared, axis, -1)  # now each line of voxels is a last axis
        index = np.arange(lines.shape[-1])
        apart = np.maximum(np.abs(index[:, None] - index) - 0.5, 0.0)  # row: node, column: voxel
        lowest = (lines[..., None, :] + apart**2).min(axis=-1)  # for each node of a line, over its voxels
        squared = np.moveaxis(lowest, -1, axis)
    return cell * np.sqrt(squared)


by_hand = distance_transform(coarse.occupied, coarse.cell)
print(f"largest difference from coarse.clearance: {np.abs(by_hand - coarse.clearance).max():.0e} m")

# %% tags=["check"]
assert np.allclose(by_hand, coarse.clearance, rtol=0, atol=1e-9)
lonely = np.zeros((6, 6, 3), dtype=bool)
lonely[0, 0, 0] = True
assert distance_transform(lonely, 1.0)[5, 0, 0] == City(lonely).clearance[5, 0, 0] == 4.5
assert round(distance_transform(lonely, 1.0)[3, 4, 0], 2) == round(City(lonely).clearance[3, 4, 0], 2) == 4.3

# %% [markdown]
# With 100 voxels along each axis, that is 300 comparisons for each node instead of 144 858. Clearance counts occupied
# voxels only: neither the border of the map nor the floor of this city is a wall.

# %% [markdown]
# Move the section up and down. Where can a UAV pass below building 4?


# %% tags=["figure"]
def section_at(height):
    return plot.section(city, height, np.minimum(city.clearance, 12.0), label="clearance [m], yellow: 12 m and more",
                        norm=PowerNorm(0.6, 0, 12))  # fmt: skip


heights = [*range(0, 100, 5), 99]
plot.sliders(section_at, title="clearance in the papers' test city", labels={"height": "height [m]"},
             start={"height": 40}, progress=False, height=heights)  # fmt: skip

# %% tags=["check"]
below = city.clearance[30, 80]  # a column below the floating building
assert below[41] == 3.5  # the centre of layer 41 is at 41.5 m
assert below[42] < 3.5
assert city.occupied[:, :, 89].sum() > city.occupied[45:51, 50:65, 89].sum()
assert city.occupied[:, :, 90].sum() == city.occupied[45:51, 50:65, 90].sum() > 0

# %% [markdown]
# *A horizontal section; at first below building 4, the grey strip.* A line that is brighter than both of its sides
# is equally far from two walls. A UAV that keeps 3.5 m may pass below building 4 with its centre up to 45 − 3.5 = 41.5
# m high.
#
# ## What 26 points see
#
# REPARE's UAV looks at 26 nodes around it, the *outer ring*. If one of them lies in an obstacle, the place counts as
# risky. We read it as the points
#
# $$(i + q\,s_x,\;\; j + q\,s_y,\;\; k + q\,s_z), \qquad s_x, s_y, s_z \in \{-1, 0, 1\}, \text{ not all } 0, \tag{6}$$
#
# with $q$, the radius of the ring in cells. As a loop over shifted copies of the map:


# %%
def ring_meets_obstacle(occupied, radius):
    """Whether a node of the ring is occupied, for each voxel; beyond the map nothing is."""
    padded = np.pad(occupied, radius)
    nx, ny, nz = occupied.shape
    meets = np.zeros(occupied.shape, dtype=bool)
    for i, j, k in product((0, radius, 2 * radius), repeat=3):  # 27 places, one is the voxel itself
        meets |= padded[i : i + nx, j : j + ny, k : k + nz]
    return meets


free = ~city.occupied
ring = ring_meets_obstacle(city.occupied, 3)
print(f"radius 3: the ring meets an obstacle from {(ring & free).sum():,} of {free.sum():,} free nodes")

# %% tags=["check"]
assert np.array_equal(ring, penalty_zone(city, 3.5, penalty=1.0, zone="ring") > 1)

# %% [markdown]
# Which distance is that? Stand in front of a wall that is parallel to an axis and at least $q$ cells thick. The nearest
# node that the ring calls safe is $q+1$ cells from the centre of the nearest wall voxel. That is $q+\tfrac12$ cells
# from the surface:
#
# $$D_\text{ring} = \bigl(q + \tfrac12\bigr)\,a. \tag{7}$$
#
# With $a = 1$ m and $q = 3, 4, 5$ that is 3.5, 4.5 and 5.5 m. These are the minimum safe distances in REPARE's Table 4,
# for three pairs of load and disturbance. (We chose $q$ to fit.) The exact test is a *ball*: a node is risky when
# $D < (q+\tfrac12)\,a$.
#
# > **Predict first.** The wall is 2 m thick, and the ring has a radius of 3. How near to the wall can a UAV be while
# > its ring calls the place safe?

# %% tags=["nbval-check-output"]
print("smallest clearance that the ring calls safe")
print("thickness of the wall ", *(f"{thickness:>4} m" for thickness in range(2, 7)))
for radius in (3, 4, 5):
    accepted = []
    for thickness in range(2, 7):
        wall = np.zeros((30, 21, 21), dtype=bool)
        wall[:thickness] = True
        safe = ~wall & ~ring_meets_obstacle(wall, radius)
        accepted.append(City(wall).clearance[safe].min())
    print(f"ring of radius {radius}      ", *(f"{clearance:>4} m" for clearance in accepted))

# %% tags=["figure"]
angle = np.linspace(0, 2 * np.pi, 100)
ring_points = [(3 * x, 3 * y) for x, y in product((-1, 0, 1), repeat=2) if (x, y) != (0, 0)]
thin = [(0.5, -4.5), (2.5, -4.5), (2.5, 4.5), (0.5, 4.5), (0.5, -4.5)]
plot.diagram("x, east [cells]", "y, north [cells]", areas={"wall, 2 cells thick": thin, "voxel of the UAV": [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)]},
             paths={"ball of radius 3.5": 3.5 * np.column_stack([np.cos(angle), np.sin(angle)])},
             points={"ring of radius 3": ring_points, "UAV": [(0, 0)]}, title="A ring looks through a thin wall",
             colors={"wall, 2 cells thick": "0.4", "voxel of the UAV": plot.SKY, "ball of radius 3.5": plot.BLUE, "UAV": plot.BLACK, "ring of radius 3": plot.ORANGE})  # fmt: skip

# %% [markdown]
# *Ring and ball from above; the ring has nine more points above and nine below.* **A ring looks through walls that are
# thinner than $q$ cells**, and then it accepts a UAV right at the wall.
#
# Now the test city. The *zone* are all free nodes with $D < (q+\tfrac12)\,a$. "Misses" are its nodes that the ring
# calls safe. "Adds" are nodes outside that it calls risky: its corners are $\sqrt3\,q$ cells away. Both are shares of
# the zone.

# %% tags=["nbval-check-output"]
missed, added, kept = {}, {}, {}
print("radius  distance  ring misses  ring adds  smallest clearance that it calls safe")
for q in range(2, 7):
    ring = ring_meets_obstacle(city.occupied, q) & free
    ball = (city.clearance < q + 0.5) & free
    missed[q], added[q] = (ball & ~ring).sum() / ball.sum(), (ring & ~ball).sum() / ball.sum()
    kept[q] = city.clearance[free & ~ring].min()
    print(f"{q:>6}  {q + 0.5:>6} m {missed[q]:>12.1%} {added[q]:>10.1%} {kept[q]:>12.2f} m")

# %% tags=["check"]
assert [round(100 * missed[q], 1) for q in (2, 3, 4, 5, 6)] == [0.2, 0.8, 1.0, 1.4, 2.8]
assert [round(100 * added[q], 1) for q in (2, 3, 4, 5, 6)] == [0.3, 4.7, 4.0, 6.8, 7.3]
assert [round(kept[q], 2) for q in (3, 4, 5, 6)] == [2.55, 3.54, 3.81, 0.5]

# %% [markdown]
# Up to $q = 4$ the ring misses at most 1.0 % of the zone. That is no guarantee, as a route may go just there: with
# $q = 3$ a node near a corner of the oblique building 4 has 2.55 m instead of 3.5 m, and the ring calls it safe. With
# $q = 6$ it calls nodes safe right beside the spire, which is 5 m wide and fits between two points of the ring.
#
# ## What the size of a voxel does
#
# Half the edge makes eight times the voxels, and eight times the memory. Why not take large ones? In the next
# figure, the second slider moves the grid by a part of a voxel. Where is the spire?


# %% tags=["figure"]
def section_in_voxels(cell, shift, rule):
    box = {"origin": (cell * (shift - 1), 0, 0), "size": (100 + 2 * cell, 100 + cell, 100)}
    grid = City.from_buildings(city.buildings, cell=cell, voxels=rule, **box)
    layer = {"occupied voxels": grid.occupied[:, :, grid.cell_of((50, 50, 50.1))[2]]}
    return plot.area_map(grid, layer, paths={"true walls": outlines(city.buildings)}, area=(0, 100, 0, 100), colors=COLORS,
                         title=f"Voxels of {cell:g} m by {'centres' if rule == 'centres' else 'touch'}, shift {shift:g}, 50 m high")  # fmt: skip


plot.sliders(section_in_voxels, title="the test city in voxels", progress=False, start={"cell": 8, "rule": "centres"},
             labels={"cell": "edge of a voxel [m]", "shift": "shift to the east [voxels]", "rule": "rule"},
             cell=[1, 2, 4, 8], shift=[0, 0.25, 0.5, 0.75], rule=["centres", "touched"])  # fmt: skip

# %% tags=["check"]
spire = {}
for rule, shift in product(("centres", "touched"), (0, 0.25, 0.5, 0.75)):
    grid = {"cell": 8.0, "origin": (8 * (shift - 1), 0, 0), "size": (116, 108, 100), "voxels": rule}
    spire[rule, shift] = City.from_buildings(city.buildings[4:], **grid).occupied[:, :, 6].sum()
assert [spire["centres", shift] for shift in (0, 0.25, 0.5, 0.75)] == [0, 1, 1, 1]
assert all(spire["touched", shift] > 0 for shift in (0, 0.25, 0.5, 0.75))

# %% [markdown]
# *A section of the test city in voxels; orange lines are the true walls.* With voxels of 8 m by centres the spire is
# gone when the shift is 0. By touch it is always there. **Where the grid begins matters, and it is an accident.** We
# take 20 grids with random shifts (2.09 is Student's t for 20 values):

# %% tags=["nbval-check-output"]
for cell in (1.0, 4.0):
    shifts = np.random.default_rng(4).uniform(0, cell, (20, 3))
    size = np.full(3, 100 + cell)
    grids = [City.from_buildings(city.buildings, cell=cell, origin=-shift, size=size) for shift in shifts]
    errors = np.array([one.occupied.sum() * cell**3 / exact_volume - 1 for one in grids])
    mean, half = errors.mean(), 2.09 * errors.std(ddof=1) / np.sqrt(20)
    print(f"by touch, {cell:g} m: {mean:.1%} too large (95 % interval {mean - half:.1%} to {mean + half:.1%})")

# %% [markdown]
# The 1.8 % above were luck: most walls of this city lie on whole metres.

# %% tags=["check"]
sizes = {cell: table1_city(cell).occupied.size for cell in (4.0, 2.0, 1.0, 0.5)}
assert all(sizes[cell / 2] == 8 * sizes[cell] for cell in (4.0, 2.0, 1.0))

# %% [markdown]
# ## Alleys that close, walls that vanish
#
# Take an alley of breadth $b_\text{alley}$ between two walls, and a single wall of thickness $b_\text{wall}$, all
# parallel to an axis. Let the grid begin anywhere, each place with the same probability.
#
# **By centres.** The centres of a row are $a$ apart. So a strip of breadth $b < a$ contains a centre with the
# probability $b/a$, and a broader one always does. The alley is closed when no centre falls into the alley. The
# wall is lost when no centre falls into the wall:
#
# $$P(\text{alley closed}) = \max\Bigl(0,\; 1-\frac{b_\text{alley}}a\Bigr), \qquad
#   P(\text{wall lost}) = \max\Bigl(0,\; 1-\frac{b_\text{wall}}a\Bigr). \tag{8}$$
#
# **By touch.** A wall is never lost. The alley is open when a whole voxel fits in. If the alley runs from $x = 0$ to
# $b_\text{alley}$, the western face of this voxel lies between 0 and $b_\text{alley} - a$. Western faces are $a$ apart,
# so one of them lies there with the probability $(b_\text{alley}-a)/a$, if that is between 0 and 1. So
#
# $$P(\text{alley closed}) = \min\Bigl(1,\; \max\Bigl(0,\; 2-\frac{b_\text{alley}}a\Bigr)\Bigr), \qquad
#   P(\text{wall lost}) = 0. \tag{9}$$
#
# > **Predict first.** An alley of 1.5 m, a wall of 0.8 m, voxels of 2 m. How often does each rule close the alley? How
# > often does it lose the wall?
#
# We count, on 200 evenly shifted grids:


# %%
def shares(cell, rule, alley=1.5, wall=0.8):
    """Shares of 200 grids on which the alley is closed, and on which the wall is lost."""
    walls, closed, lost = [(0, 10), (10 + alley, 20), (30, 30 + wall)], 0, 0
    for shift in cell * (np.arange(200) + 0.5) / 200:
        low = np.arange(-shift, 45, cell)  # western faces of the voxels in a row
        occupied = np.zeros(low.size, dtype=bool)
        for west, east in walls:
            if rule == "touched":
                occupied |= (low < east) & (low + cell > west)
            else:
                occupied |= (low + cell / 2 >= west) & (low + cell / 2 <= east)
        centre = low + cell / 2
        closed += occupied[(centre > 5) & (centre < 15 + alley)].all()
        lost += not occupied[centre > 26].any()
    return closed / 200, lost / 200


# %% tags=["nbval-check-output"]
cells = (0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0)
counted = {rule: {cell: shares(cell, rule) for cell in cells} for rule in ("centres", "touched")}
for rule, found_shares in counted.items():
    for cell in (0.5, 1.0, 2.0, 4.0):
        closed, lost = found_shares[cell]
        print(f"{rule}, {cell:g} m: alley closed on {closed:4.0%} of the grids, wall lost on {lost:4.0%}")

# %% tags=["check"]
for cell in cells:
    expected = [max(0, 1 - 1.5 / cell), max(0, 1 - 0.8 / cell)], [np.clip(2 - 1.5 / cell, 0, 1), 0]
    assert np.allclose([counted[rule][cell] for rule in ("centres", "touched")], expected, atol=0.006)
row = [Building.prism([(w, 0), (e, 0), (e, 8), (w, 8)], 8) for w, e in ((0, 10), (11.5, 20), (30, 30.8))]
for rule in ("centres", "touched"):  # the library marks the same voxels
    marked = City.from_buildings(row, cell=2.0, origin=(-0.3, 0, 0), size=(46, 8, 8), voxels=rule)
    low = np.arange(-0.3, 45, 2.0)
    walls = [(0, 10), (11.5, 20), (30, 30.8)]
    by_rule = [
        ((low < e) & (low + 2 > w)) if rule == "touched" else ((low + 1 >= w) & (low + 1 <= e)) for w, e in walls
    ]
    assert np.array_equal(marked.occupied[:, 0, 0], np.any(by_rule, axis=0))

# %% tags=["figure"]
figure, panels = plot.new_panels(1, 2, share="y", width=9.0)
c = np.linspace(0.4, 4.2, 400)
names = {"centres": "by centres", "touched": "by touch"}
formulas = {"by centres": (1 - 1.5 / c, 1 - 0.8 / c), "by touch": (np.minimum(2 - 1.5 / c, 1), 0 * c)}
for number, (axes, title) in enumerate(zip(panels, ("alley of 1.5 m closed", "wall of 0.8 m lost"), strict=True)):
    curves = {f"{rule}, formula": 100 * np.maximum(both[number], 0) for rule, both in formulas.items()}
    marks = {f"{names[rule]}, counted": [(cell, 100 * share[number]) for cell, share in found_shares.items()]
             for rule, found_shares in counted.items()}  # fmt: skip
    plot.lines(c, curves, "edge of a voxel [m]", "share of the grids [%]", points=marks, title=title, axes=axes,
               colors={f"{rule}, {how}": color for how in ("formula", "counted")
                       for rule, color in (("by centres", plot.BLUE), ("by touch", plot.ORANGE))})  # fmt: skip
    axes.set_ylim(-5, 105)
figure

# %% [markdown]
# *The counts lie on the lines of Eqs 8 and 9.* **Centres err on both sides.** Touch loses nothing, but with 2 m the
# alley is always closed.
#
# > **Try it.** How wide must an alley be so that touch with 2 m always finds it?

# %% tags=["try-it"]
for alley in (2.0, 3.0, 3.9, 4.0):
    print(f"alley of {alley:g} m: closed on {shares(2.0, 'touched', alley=alley)[0]:.0%} of the grids")

# %% [markdown]
# It must be $2a$ = 4 m wide, as Eq. 9 says.
#
# ### A size for a UAV with a body
#
# The centre of a UAV must keep a distance $D_\text{min}$: its radius $r$, and in gusts the offset of chapter 02 as
# well. Which edge $a$ is small enough, wherever the grid begins? Mark by touch, and let $e$ be how far a voxel reaches
# across the alley. If the alley is parallel to an axis, $e = a$. If it is oblique, with upright walls, $e$ is at most
# the voxel's diagonal from above, $\sqrt2\,a$.

# %% tags=["figure"]
voxels = {"occupied voxels": [(-0.05, 0), (0.95, 0), (0.95, 1), (-0.05, 1), (np.nan, np.nan), (4.95, 0), (5.95, 0), (5.95, 1), (4.95, 1)],
          "voxel of the middle line": [(1.95, 0), (2.95, 0), (2.95, 1), (1.95, 1)]}  # fmt: skip
figure, panels = plot.new_panels(1, 1, width=8.0, height=2.6)
plot.diagram("across the alley [cells]", "along it [cells]", areas=voxels, x_range=(-0.3, 6.1), y_range=(-0.3, 1.3),
             paths={"true walls": [(0, -0.3), (0, 1.3), (np.nan, np.nan), (5.8, -0.3), (5.8, 1.3)], "middle line": [(2.9, -0.3), (2.9, 1.3)],
                    "taken by the voxel: below e": [(0, 0.5), (0.95, 0.5)], "clearance": [(0.95, 0.5), (2.45, 0.5)], "off the middle: at most e/2": [(2.45, 0.5), (2.9, 0.5)]},
             points={"centre": [(2.45, 0.5)]}, title="What is sure to be left of an alley, by touch", axes=np.ravel(panels)[0],
             colors=COLORS | {"voxel of the middle line": plot.SKY, "middle line": "0.3", "taken by the voxel: below e": plot.GREEN, "off the middle: at most e/2": plot.PINK, "clearance": plot.BLUE, "centre": plot.BLACK})  # fmt: skip
figure

# %% [markdown]
# *An alley with its least favourable voxels, from above.*
#
# - **The alley is open** if $e \le b_\text{alley}/2$: then the voxel around any point of the middle line reaches no
#   wall. So $a \le b_\text{alley}/2$ is enough, and in an oblique alley $a \le b_\text{alley}/(2\sqrt2)$.
# - **It has the clearance $D_\text{min}$** if $e \le (b_\text{alley} - 2D_\text{min})/3$. A wall is $b_\text{alley}/2$
#   from the middle line. Of this, the occupied voxel takes less than $e$, and the centre is at most $e/2$ from the
#   line. So at least $b_\text{alley}/2 - \tfrac32 e$ is left. So $a \le (b_\text{alley} - 2D_\text{min})/3$, in an
#   oblique alley $a \le (b_\text{alley} - 2D_\text{min})/(3\sqrt2)$.
# - **True walls are as far as the map says**, with any $a$. (By centres no $a$ ensures that.)
#
# Larger voxels may do, too. A closed alley costs a detour, a lost wall costs the UAV. **So mark by touch.** When a
# planner finds no way through a street, try smaller voxels before you believe it.

# %% tags=["check"]
rng = np.random.default_rng(1)


def middle_line(breadth, cell, angle):
    """Least clearance [m] on the middle line of an alley in any direction, marked by touch on a shifted grid."""
    along, across = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    sides = [
        [along * u + across * side * v + 10 for u, v in product((-6, 6), (breadth / 2, breadth / 2 + 3))]
        for side in (1, -1)
    ]
    walls = [Building.prism([tuple(side[i]) for i in (0, 2, 3, 1)], 1) for side in sides]
    grid = City.from_buildings(walls, cell=cell, origin=(*-rng.uniform(0, cell, 2), 0), size=(21, 21, 1))
    line = 10 + np.linspace(-4, 4, 500)[:, None] * along
    return grid.clearance[tuple(grid.cell_of(np.column_stack([line, np.full(500, cell / 2)])).T)].min()


assert min(middle_line(1.5, 1.5 / np.sqrt(8), angle) for angle in rng.uniform(0, np.pi, 20)) > 0
assert min(middle_line(3.0, (3.0 - 2 * 0.5) / np.sqrt(18), angle) for angle in rng.uniform(0, np.pi, 20)) >= 0.5
assert all(min(middle_line(1.5, 1 / 6, angle) for _ in range(10)) >= 0.5 - 1e-9 for angle in (0, np.pi / 2))

# %% [markdown]
# ### A route through a wall
#
# In an invented quarter, two blocks leave an alley of 1.5 m and reach the sides of the map. North of them stands a wall
# of 0.8 m, with a way around its ends. All are as high as the map. The UAV has $r = 0.5$ m. `astar`, the search of
# chapter [05](05_astar.ipynb), goes from centre to centre, also diagonally, but only if all nodes of the smallest box
# around the leg have `min_clearance`. Along a leg, each gap of Eq. 4 only grows or only shrinks. So nowhere on it is
# the clearance below the least at these nodes.

# %%
parts = {"west": (0, 19.2, 5.5, 14.5), "east": (20.7, 40, 5.5, 14.5), "wall": (8, 32, 19.6, 20.4)}
quarter = [Building.prism([(w, s), (e, s), (e, n), (w, n)], 8) for w, e, s, n in parts.values()]
true_walls = shapely.union_all([shapely.box(w, s, e, n) for w, e, s, n in parts.values()])


def plan(rule, cell, keep):
    """A map of the quarter, and a route on it that keeps a clearance [m]."""
    grid = City.from_buildings(quarter, cell=cell, origin=(0, 0, 0), size=(40, 28, 8), voxels=rule)
    route = astar(grid, (20.1, 1.1, 4.1), (20.1, 27.1, 4.1), min_clearance=keep)
    words = "no way"
    if route.reached:
        on_map = min(grid.clearance[tuple(grid.cell_of(point))] for point in route.points)
        truth = shapely.distance(true_walls, shapely.LineString(route.points[:, :2]))
        words = f"{route.length:.1f} m long, walls at {on_map:.2f} m on the map, {truth:.2f} m in truth"
    print(f"{rule}, {cell:g} m, clearance of {keep:g} m: {words}")
    return grid, route


# %% [markdown]
# > **Predict first.** By touch with 0.5 m the alley is sure to be open. Can the UAV fly the route?

# %% tags=["nbval-check-output"]
cases = [
    ("centres", 1.0, 0.0),
    ("touched", 1.0, 0.0),
    ("touched", 0.5, 0.0),
    ("touched", 0.5, 0.5),
    ("touched", 0.25, 0.5),
]
planned = {case: plan(*case) for case in cases}

# %% tags=["check"]
assert [route.reached for _, route in planned.values()] == [True, False, True, False, True]
nearest = {}
for case, (grid, route) in planned.items():
    if route.reached:
        path = shapely.LineString(route.points[:, :2])
        nearest[case] = [shapely.distance(path, shapely.box(w, s, e, n)) for w, e, s, n in parts.values()]
        on_map = min(grid.clearance[tuple(grid.cell_of(point))] for point in route.points)
        assert case[0] == "centres" or on_map <= min(nearest[case]) + 1e-9
assert np.allclose(nearest["centres", 1.0, 0.0], [1.3, 0.2, 0.0])
assert np.allclose(min(nearest["touched", 0.5, 0.0]), 0.25)
assert np.allclose(min(nearest["touched", 0.25, 0.5]), 0.625)
grid, route = planned["centres", 1.0, 0.0]
assert min(grid.clearance[tuple(grid.cell_of(point))] for point in route.points) == 0.5
assert np.isclose((1.5 - 2 * 0.5) / 3, 1 / 6)

# %% tags=["check"]
for (_, cell, keep), (grid, route) in planned.items():  # along the legs too, by exact distances to the voxels
    if route.reached:
        x, y = grid.coordinates(0), grid.coordinates(1)
        boxes = [shapely.box(x[i] - cell / 2, y[j] - cell / 2, x[i] + cell / 2, y[j] + cell / 2)
                 for i, j in np.argwhere(grid.occupied[:, :, 0])]  # fmt: skip
        legs = shapely.distance(shapely.union_all(boxes), shapely.LineString(route.points[:, :2]))
        assert legs >= max(keep, min(grid.clearance[tuple(grid.cell_of(point))] for point in route.points)) - 1e-9

# %% tags=["figure"]
ROUTES = {"by centres, 1 m": (cases[0], plot.PINK), "by touch, 0.5 m": (cases[2], plot.GREEN),
          "by touch, 0.25 m, clearance of 0.5 m": (cases[4], plot.BLUE)}  # fmt: skip
zooms = [("by centres, 1 m", (20.5, 13.0), "By centres: 0.2 m from the eastern block"), ("by centres, 1 m", (20.5, 20.0), "By centres: the wall isn't on the map"),
         ("by touch, 0.5 m", (32.0, 20.0), "By touch, 0.5 m: 0.25 m from the wall"), ("by touch, 0.25 m, clearance of 0.5 m", (32.0, 20.0), "By touch, 0.25 m: 0.62 m from the wall")]  # fmt: skip
figure, panels = plot.new_panels(2, 2, width=8.4, height=8.2)
circle = np.column_stack([np.cos(angle), np.sin(angle)]) / 2
for axes, (name, (east, north), title) in zip(panels, zooms, strict=True):
    grid, route = planned[ROUTES[name][0]]
    flown = route.resample(0.02).points[:, :2]
    here = flown[(np.abs(flown - (east, north)) < 1.9).all(axis=1)]
    uav = here[np.argmin(shapely.distance(true_walls, shapely.points(here)))]
    plot.area_map(grid, {"occupied voxels": grid.occupied[:, :, 0]}, axes=axes, area=(east - 2.5, east + 2.5, north - 2.5, north + 2.5),
                  title=title, paths={"true walls": outlines(quarter), name: route.points[:, :2], "UAV, 1 m across": uav + circle},
                  colors=COLORS | {label: color for label, (_, color) in ROUTES.items()} | {"UAV, 1 m across": plot.BLACK})  # fmt: skip
figure

# %% [markdown]
# *Where three routes are near walls, from above.* **By centres** the wall has vanished from the map. The UAV scrapes
# along the eastern block, and then hits the wall.
#
# **By touch** with 1 m no way is found, although one exists. With 0.5 m one is found, but only for a point, as
# `min_clearance` was 0. Asked for 0.5 m, it finds none: two voxels are free across the alley, with their centres 0.25 m
# from occupied ones. With voxels of 0.25 m it finds one. (Our rule is sure only of $a \le \tfrac16$ m.)
#
# > **Try it.** Voxels of 0.75 m are half the alley. Is there a way for a point? For the UAV?

# %% tags=["try-it"]
for least in (0.0, 0.5):
    plan("touched", 0.75, least)

# %% [markdown]
# For a point only: 0.48 m is less than the radius.


# %% tags=["figure"]
def part_of(route, lift):
    """The part of a route in the picture, `lift` metres higher."""
    points = route.resample(0.1).points
    return Route(points[(points[:, 1] > 12) & (points[:, 1] < 25)] + (0, 0, lift), "part of a route")


cut = {"west": (14, 19.2, 11, 14.5), "east": (20.7, 23, 11, 14.5), "wall": (14, 32, 19.6, 20.4)}
blocks = [Building.prism([(w, s), (e, s), (e, n), (w, n)], 8) for w, e, s, n in cut.values()]
near = City.from_buildings(blocks, cell=0.5, origin=(14, 11, 0), size=(22, 15, 8), name="Routes between the true walls")
both = {
    "by centres, 1 m (drawn 2 m higher)": part_of(planned[cases[0]][1], 2.0),
    "by touch, 0.25 m": part_of(planned[cases[4]][1], 0.0),
}
scene.show(near, both, camera=(-30.0, 35.0), start_paused=True, start_at=1.45,
           colors={"by centres, 1 m (drawn 2 m higher)": plot.PINK, "by touch, 0.25 m": plot.BLUE})  # fmt: skip

# %% [markdown]
# *First and last route from the alley on, among the true walls. One UAV, 1 m across, hits the wall.*
#
# ## The ground isn't flat
#
# Real ground has hills. A `Terrain` holds their heights. All voxels that the ground reaches into are occupied, and all
# below them. Here is a hill between two houses. Somebody planned on a flat map: straight over, 9 m high.

# %%
x, y = np.meshgrid(np.arange(-17.5, 140, 5), np.arange(77.5, -20, -5))  # the first row lies in the north
heights_on_grid = 30 * np.exp(-((x - 60) ** 2 + 0.3 * (y - 30) ** 2) / (2 * 18**2))
hill = Terrain.from_raster(heights_on_grid, bounds=(-20, -20, 140, 80))  # west, south, east, north
houses = [Building.prism([(w, 20), (w + 14, 20), (w + 14, 40), (w, 40)], 12) for w in (0, 106)]
valley = City.from_buildings(houses, cell=2.0, terrain=hill, name="a hill between two houses")

# %% tags=["nbval-check-output"]
straight = Route([(20, 30, 9), (100, 30, 9)], "planned on a flat map")
above = valley.height_above_ground(straight.resample(0.5).points)
print(f"top of the hill {heights_on_grid.max():.1f} m")
print(f"route {above.min():+.1f} to {above.max():+.1f} m above the ground")

# %% tags=["check"]
assert round(above.min(), 1) == -20.6
assert not valley.is_free(straight.resample(0.5).points).all()

# %% tags=["figure"]
places = np.column_stack([np.arange(-10.0, 131.0), np.full(141, 30.0)])
ground = np.vstack([[(-10, 0)], np.column_stack([places[:, 0], hill.heights_at(places)]), [(130, 0)]])
column = valley.occupied[:, valley.cell_of((0, 30, 9))[1], :].sum(axis=1) * 2.0 + valley.bounds[0][2]
tops = np.column_stack([np.repeat(valley.coordinates(0), 2) + np.tile([-1, 1], column.size), np.repeat(column, 2)])
figure, panels = plot.new_panels(1, 1, width=8.0, height=3.2)
fronts = [(0, 0), (14, 0), (14, 12), (0, 12), (np.nan, np.nan), (106, 0), (120, 0), (120, 12), (106, 12)]
plot.diagram("x, east [m]", "height [m]", areas={"houses": fronts, "ground": ground}, x_range=(-10, 130), y_range=(0, 40),
             paths={"planned on a flat map": straight.points[:, [0, 2]], "top of the occupied voxels": tops}, title="A route through a hill, from the south",
             colors={"houses": plot.BLACK, "ground": "#8c6d46", "planned on a flat map": plot.BLUE, "top of the occupied voxels": "0.4"}, axes=np.ravel(panels)[0])  # fmt: skip

# %% [markdown]
# *A section through houses and hill, with equal scales. Voxels of 2 m.* The route is up to 20.6 m below the ground.
#
# ## A real city
#
# Cities come in files of several formats, and `read_city` recognises them:
#
# | format | holds | where from |
# |---|---|---|
# | GeoJSON | outlines with heights, as text | exports of OpenStreetMap, open data of cities |
# | CityJSON | walls and roofs, face by face | 3D models of cities and countries |
# | `.3dmap` | occupied voxels | benchmarks of path search |
#
# Real files have mistakes. We make a small one with seven invented *features* (things with an outline), as in
# OpenStreetMap. GeoJSON's coordinates are degrees: longitude, then latitude.

# %%
PLACE = Place(2.1620, 41.3900)  # longitude and latitude: somewhere in Barcelona


def feature(name, corners, **properties):
    """A GeoJSON feature with corners in metres east and north of our place."""
    ring = PLACE.longitude_latitude([*corners, corners[0]]).tolist()
    shape = {"type": "Polygon", "coordinates": [ring]}
    return {"type": "Feature", "properties": {"name": name, "building": "yes"} | properties, "geometry": shape}


def square(west, south, size=20):
    return [(west, south), (west + size, south), (west + size, south + size), (west, south + size)]


# %% tags=["nbval-check-output"]
features = [
    feature("feet", square(0, 0), height="40 ft"),
    feature("storeys", square(40, 0), **{"building:levels": "4"}),
    feature("silent", square(80, 0)),
    feature("bow tie", [(0, 50), (20, 70), (20, 50), (0, 70)], height=9),
    feature("hall", square(40, 50), height=10),
    feature("tower", square(44, 54, 8), height="30", building="no", **{"building:part": "yes"}),
    feature("lake", square(80, 50, 30), building="no", natural="water"),
]
print(json.dumps(features[0]))

# %% [markdown]
# "storeys" has no height but a number of storeys, "silent" has neither. The outline of "bow tie" crosses itself.
# "tower" is a part of "hall".
#
# > **Predict first.** Which of the seven can a program not understand without asking you? What would you answer?

# %% tags=["nbval-check-output"]
folder = TemporaryDirectory()
path = Path(folder.name) / "quarter.geojson"
path.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
try:
    read_city(path, cell=2.0)
except ValueError as error:
    print(error)

# %% [markdown]
# Feature 2, counted from 0, is "silent". (Six, as the lake is no building.) The reader doesn't invent a height; you
# give one as `default_height`. Take it high: too low a guess costs the UAV. We take 15 m, more than "feet" and
# "storeys" beside it.

# %% tags=["nbval-check-output"]
with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # it warns of the assumed height; we read the whole report instead
    town = read_city(path, cell=2.0, default_height=15.0)
print(town.source)
print("tops:", ", ".join(f"{building.name} {building.bounds[1, 2]:.1f} m" for building in town.buildings))

# %% tags=["check"]
folder.cleanup()
tops = {building.name: round(float(building.bounds[1, 2]), 3) for building in town.buildings}
assert tops == {"feet": 12.192, "storeys": 12.0, "silent": 15.0, "bow tie": 9.0, "hall": 10.0, "tower": 30.0}
bow_tie = next(building for building in town.buildings if building.name == "bow tie")
assert abs(sum(ConvexHull(piece).volume for piece in bow_tie.pieces) / 9 / 200 - 1) < 1e-3

# %% [markdown]
# The report, `town.source`, says what the reader did, but for one thing: it turned 40 ft into 12.2 m. So compare the
# tops as well.
#
# - *taken*: what became obstacles. (The tower is a *building part*.)
# - *mended*: the bow tie. Its two triangles are kept. (A *ring* is a closed outline here.)
# - *derived*: what follows by a rule. The degrees are those of GPS (WGS 84, "CRS84" in the standard), as the file names
#   no other system. A storey counts 3 m. The lake is no obstacle. The tower is cut out of the hall, and what is left of
#   the hall keeps its height. The ground is level.
# - *assumed*: what nobody knows, here the height that we gave.
#
# **Read it before you plan.**

# %% tags=["figure"]
scene.show(replace(town, name="a quarter from a file"))

# %% [markdown]
# *The quarter as the reader understood it.* In front: feet, storeys, silent. Behind: bow tie, and hall with
# tower. The lake isn't drawn.
#
# ### Your city
#
# Put the path of a file into the next cell and run it. Begin with large voxels.

# %%
MY_CITY = None  # put a path here, as in "downloads/delft.city.json"

my_city = None if MY_CITY is None else read_city(MY_CITY, cell=4.0)
if my_city is None:
    print("no file given: set MY_CITY and run this cell again")
else:
    print(my_city, my_city.source, sep="\n")
None if my_city is None else scene.show(my_city)

# %% [markdown]
# ## Remember
#
# - A convex building is what lies behind all its faces.
# - By centres a voxel map closes alleys and loses walls. By touch it only closes alleys, and free voxels are really
#   free.
# - By touch an alley parallel to an axis is sure to be open if $a \le b_\text{alley}/2$. Oblique alleys and a UAV with a
#   body need smaller voxels.
# - Clearance is measured to the surface of an occupied **voxel**. Only by touch are the true walls sure to be as far. A
#   planner keeps only the clearance that you ask for.
# - A ring of 26 points is a rule of thumb where walls are thick. It looks through walls thinner than $q$ cells.
#
# ## What the paper says, what we find
#
# The text of the paper that we have lacks the figures, among them Fig. 5 with the ring.
#
# | REPARE | says | we find |
# |---|---|---|
# | Table 1, section 3.1 | five buildings in 100 × 100 × 100 m; the conclusion: the smallest unit is 1 m | 1 000 000 voxels, 144 858 occupied by centres (14.5 %); the exact volume is 144 372 m³, 0.3 % less |
# | Table 1, no. 1 | one list of 15 corners | two wings: their hull would fill the notch, with 48 % more volume |
# | section 2.3.1 | 26 ring nodes; no radius, in the text that we have | radii of 3, 4 and 5 cells, chosen to fit Table 4, keep its 3.5, 4.5 and 5.5 m from thick walls |
# | same | a risk when a ring node meets an obstacle | with these radii the ring misses 0.8, 1.0 and 1.4 % of the zone and adds 4.7, 4.0 and 6.8 %; the nearest place that it calls safe has 2.55, 3.54 and 3.81 m |
# | same | nothing about thin walls, in the text that we have | walls thinner than the radius are looked through |
# | conclusion | a finer map takes significantly more work | half the edge, eight times the voxels; we didn't measure the work here |
# | not said | which voxels are occupied, and from where a distance is measured | we take centres for the test city, and measure from the UAV's centre to the surface; then Table 4 fits a ring of 3, 4 and 5 cells |

# %% tags=["check"]
assert city.occupied.size == 1_000_000
assert round(100 * city.occupied.mean(), 1) == 14.5
assert all(kept[q] < q + 0.5 for q in (3, 4, 5))

# %% [markdown]
# ## Read on
#
# - P. F. Felzenszwalb and D. P. Huttenlocher, "Distance transforms of sampled functions", *Theory of Computing* 8 (2012)
#   415–428, [doi:10.4086/toc.2012.v008a019](https://doi.org/10.4086/toc.2012.v008a019): each line of the distance
#   transform in one pass.
# - H. Butler and others, "The GeoJSON format", RFC 7946 (2016),
#   [doi:10.17487/RFC7946](https://doi.org/10.17487/RFC7946): what a GeoJSON file may contain.
# - OpenStreetMap Wiki, "Simple 3D buildings",
#   [wiki.openstreetmap.org](https://wiki.openstreetmap.org/wiki/Simple_3D_Buildings): how people enter heights and
#   parts.
# - B. Dukai, H. Ledoux and J. Stoter, "A multi-height LoD1 model of all buildings in the Netherlands", *ISPRS Annals*
#   IV-4/W8 (2019) 51–57,
#   [doi:10.5194/isprs-annals-IV-4-W8-51-2019](https://doi.org/10.5194/isprs-annals-IV-4-W8-51-2019): what "the height"
#   of a building can mean. (LoD1: blocks with flat roofs.)
#
# ## Your turn
#
# Six exercises, from a code back to its voxel to a map of your own, with a mast that the ring doesn't see:
# [exercises/04_cities_exercises.ipynb](exercises/04_cities_exercises.ipynb).
#
# Before: [03 Predicting the disturbance](03_predicting_the_disturbance.ipynb). Next: [05 A\*](05_astar.ipynb).
