# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # From buildings to voxels: what a planner sees
#
# A city is walls, roofs and courtyards. A planner wants something simpler: a finite set of places, and for each of
# them two answers: *may I be here?* and *how far is the nearest wall?* This notebook makes the one into the other.
# It builds the city of REPARE Table 1 from its corners, cuts it into cubes, measures the distance to the walls
# exactly, and then asks what the size of a cube costs: in memory, in time, and in alleys that close and walls that
# vanish. At the end you read a real city from a file of your own.
#
# *Run All* (in the menu **Run**) brings the 3D scenes and the slider to life; until then a still picture stands in
# their place.

# %%
import json
import tempfile
import time
from itertools import pairwise
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest
import shapely
from ipywidgets import IntSlider, interact
from matplotlib.colors import ListedColormap
from scipy.ndimage import distance_transform_edt
from scipy.spatial import ConvexHull, HalfspaceIntersection
from shapely.affinity import rotate, translate
from shapely.geometry import mapping

from uavlab import plot, scene
from uavlab.city import Building, City, read_city, read_cityjson, read_geojson, read_voxels, table1_city
from uavlab.planners import astar, penalty_zone, shortcut

# %% [markdown]
# ## Five buildings
#
# REPARE tests its planner in a box of 100 × 100 × 100 m with five buildings, given as lists of corners (Table 1):
#
# | | shape | what its corners say |
# |---|---|---|
# | 1 | notch | an L of two wings, walls to 65 m, a ridge along both wings at 70 m |
# | 2 | hip roof | walls to 60 m, a roof that slopes on all four sides up to a ridge at 65 m |
# | 3 | frustum | walls to 80 m, then a pyramid that is cut off at 90 m |
# | 4 | floating | a slab, oblique to the axes, from 45 to 60 m above the ground; air below it |
# | 5 | spire | a thin tower with six sides, walls to 95 m, one apex at 99 m |
#
# Drag the scene to turn it, scroll to zoom.

# %%
city = table1_city()
scene.show(city)

# %% [markdown]
# ## Is a point inside a building?
#
# Four of the five are *convex*: the straight line between any two points of the building stays inside. A convex
# body is what is left of space after cutting along each of its faces. Give face $f$ a unit normal $\mathbf n_f$
# that points outwards and an offset $d_f$; then a point $\mathbf x$ is
#
# $$\text{inside} \iff \mathbf n_f\cdot\mathbf x + d_f \le 0 \quad\text{for every face } f. \tag{1}$$
#
# The left side is the distance to the plane of the face, negative behind it. So one matrix product answers the
# question for a million points. Here it is by hand for the hip roof, with one point below the ridge and one at the
# same height over the edge of the roof:

# %%
# NBVAL_CHECK_OUTPUT
hip_roof = city.buildings[1]
faces = np.unique(hip_roof.hulls[0].equations.round(9), axis=0)  # the hull has triangles: two for a rectangle
points = {"below the ridge": (22, 35, 62), "over the eaves": (12, 35, 62)}
for name, point in points.items():
    behind = faces[:, :3] @ point + faces[:, 3]
    print(f"{name:<16} {point}: farthest in front of a face {behind.max():+.2f} m, inside: {behind.max() <= 0}")
print(f"{len(faces)} faces: floor, four walls, four slopes")

# %%
assert len(faces) == 9
assert hip_roof.contains(list(points.values())).tolist() == [True, False]

# %% [markdown]
# ### The notch is no convex body
#
# The one that is left, the L, has a corner that points inwards. Eq. 1 with all of its corners would fill the notch
# with stone: the convex hull contains the air between the wings, where REPARE's Fig. 12 shows a UAV trapped. So a
# building is a *union* of convex pieces, here two wings, and a point is inside when it is inside one of them. Their
# volumes must not simply be added, since the wings overlap where they meet:
#
# $$V(A\cup B) = V(A) + V(B) - V(A\cap B). \tag{2}$$
#
# The overlap is convex again: it lies behind the faces of both.

# %%
# NBVAL_CHECK_OUTPUT
notch = city.buildings[0]
filled = Building.hull(np.vstack(notch.pieces))
in_the_notch = (80, 30, 30)
overlap = HalfspaceIntersection(np.vstack([hull.equations for hull in notch.hulls]), np.array([65.0, 40.0, 30.0]))
notch_volume = sum(hull.volume for hull in notch.hulls) - ConvexHull(overlap.intersections).volume
print(f"{in_the_notch} is inside: hull {filled.contains(in_the_notch)}, two wings {notch.contains(in_the_notch)}")
print(f"volume: hull {filled.hulls[0].volume:,.0f} m³, two wings {notch_volume:,.0f} m³")

# %%
assert filled.contains(in_the_notch)
assert not notch.contains(in_the_notch)
assert filled.hulls[0].volume / notch_volume == pytest.approx(1.48, abs=0.005)

# %% [markdown]
# ## From buildings to voxels
#
# Cut the box into cubes with edge $c$, called *voxels*. Voxel $(i, j, k)$ counts from 0 on each axis, and its
# centre is
#
# $$\mathbf x_{ijk} = \mathbf x_0 + c\,\bigl(i+\tfrac12,\; j+\tfrac12,\; k+\tfrac12\bigr), \tag{3}$$
#
# with $\mathbf x_0$ the lowest corner of the map. The centres are the *nodes* that a planner visits. The rule that
# decides what a planner sees is one line: **a voxel is occupied when its centre lies in a building.** REPARE's map
# has $c = 1$ m.

# %%
# NBVAL_CHECK_OUTPUT
exact = {b.name: sum(hull.volume for hull in b.hulls) for b in city.buildings} | {notch.name: notch_volume}
counts = {
    b.name: int(City.from_buildings([b], origin=(0, 0, 0), size=(100, 100, 100)).occupied.sum()) for b in city.buildings
}
for name, count in counts.items():
    print(f"{name:<11} {count:>7,} voxels, {exact[name]:>9,.0f} m³")
total, exact_volume = int(city.occupied.sum()), sum(exact.values())
print(f"{'together':<11} {total:>7,} voxels, {exact_volume:>9,.0f} m³, {city.occupied.mean():.1%} of the map")

# %%
assert total == 144_858 == sum(counts.values())  # no voxel belongs to two buildings
assert list(counts.values()) == [37_360, 62_094, 34_340, 7_500, 3_564]
assert counts["5 spire"] / exact["5 spire"] - 1 == pytest.approx(0.057, abs=5e-4)
assert total / exact_volume - 1 == pytest.approx(0.0034, abs=5e-5)

# %% [markdown]
# A cubic metre per voxel, so the counts are volumes: 144 858 m³ against 144 372 m³ in truth, 0.3 % too much. The
# spire is the worst, 5.7 % too large: its section has 35 m², and 37 centres lie in it.
#
# This is what the planner sees, at a coarser 4 m so that you can tell the voxels apart. Gone are the roofs; there
# are steps.

# %%
coarse = table1_city(4.0)
scene.show(City(coarse.occupied, coarse.cell, name="What the planner sees, voxels of 4 m"))

# %% [markdown]
# ### One number per node
#
# Planners keep a cost, a parent, a pheromone for each node, in plain arrays. So each node needs one number, its
# *code*:
#
# $$n = k + n_z\,(j + n_y\, i), \qquad 0 \le n < n_x n_y n_z, \tag{4}$$
#
# with $n_x, n_y, n_z$ the numbers of voxels along each axis. Reading the formula from the inside: $i$ slabs of $n_y
# n_z$ voxels, then $j$ rows of $n_z$, then $k$. It is the position of the voxel in `city.occupied.ravel()`. One
# step east adds $n_y n_z$ to the code, one step north adds $n_z$, one step up adds 1. RISK-ACO (section 1) and
# PSO-BAS (section 2) number their nodes too, without a formula. Which order is taken doesn't matter as long as it
# can be undone.

# %%
# NBVAL_CHECK_OUTPUT
point = (90.2, 18.0, 30.7)
i, j, k = (int(index) for index in city.cell_of(point))
nx, ny, nz = city.shape
code = k + nz * (j + ny * i)
print(f"point {point} m lies in voxel {(i, j, k)}, code {code:,}")
print(f"back: voxel {tuple(city.index_of(code).tolist())}, centre {tuple(city.center_of((i, j, k)).tolist())} m")

# %%
assert code == city.code_of((i, j, k)) == 901_830
assert not city.occupied.ravel()[code]
assert (city.index_of(code) == (i, j, k)).all()

# %% [markdown]
# ## How far is the nearest wall?
#
# "May I be here" is not enough: gusts push a UAV, and REPARE's Eq. 7 asks for a distance $D_{min}$ to obstacles.
# The *clearance* of a node is the distance from its centre to the nearest **surface** of an occupied voxel. The
# obstacle is the whole cube, so on each axis half a cell of the way between two centres is already inside it:
#
# $$D(\mathbf x_{ijk}) = c\,\min_{(a,b,e)\ \text{occupied}}
#   \sqrt{\textstyle\sum_{\text{axes}} \max\bigl(|\Delta| - \tfrac12,\, 0\bigr)^2},
#   \qquad \Delta = i-a,\; j-b,\; k-e. \tag{5}$$
#
# The usual shortcut is the distance between the centres, which every image library has. It is wrong, and not by a
# constant that one could subtract. Two free nodes, each exactly 3 m from the centre of the only occupied voxel:

# %%
# NBVAL_CHECK_OUTPUT
lonely = np.zeros((4, 4, 3), dtype=bool)
lonely[0, 0, 0] = True
for offset in ((3, 0, 0), (2, 2, 1)):
    apart = np.linalg.norm(offset)
    clearance = City(lonely).clearance[offset]
    print(f"offset {offset}: centres {apart:.2f} m apart, clearance {clearance:.2f} m")

# %%
assert City(lonely).clearance[3, 0, 0] == 2.5
assert City(lonely).clearance[2, 2, 1] == pytest.approx(np.sqrt(1.5**2 + 1.5**2 + 0.5**2))

# %% [markdown]
# Straight ahead half a cell is lost; towards an edge or a corner it is up to half the diagonal of a voxel, 0.87 m.
# In the whole city:

# %%
# NBVAL_CHECK_OUTPUT
free = ~city.occupied
between_centres = distance_transform_edt(free)
too_far = (between_centres - city.clearance)[free]
print(f"centre distance minus clearance: {too_far.min():.2f} to {too_far.max():.2f} m, mean {too_far.mean():.2f} m")
judged_safe = between_centres >= 3.5
wrongly = judged_safe & (city.clearance < 3.5)
print(f"{judged_safe.sum():,} nodes with centres 3.5 m apart or more; clearance below 3.5 m: {wrongly.sum():,} of them")

# %%
assert too_far.min() == 0.5
assert too_far.max() == pytest.approx(np.sqrt(3) / 2)
assert wrongly.sum() == 6_916

# %% [markdown]
# `city.clearance` is exact and computed once for all voxels, one axis after the other (Felzenszwalb and
# Huttenlocher 2012), so its cost grows only with the number of voxels. It counts buildings only, neither the ground
# nor the border of the map.
#
# A section at 50 m cuts all five buildings, the floating one too. Between the buildings the clearance has ridges,
# where two walls are equally far: these are the streets that a careful UAV flies along.

# %%
plot.section(city, 50.0, np.minimum(city.clearance, 15.0), label="clearance [m], 15 m and more in yellow")

# %% [markdown]
# Move the section up and down. Up to which height can you pass below the floating building, and from which height
# on does the spire stand alone?


# %%
@interact(height=IntSlider(30, 0, 99, 1, continuous_update=False, description="height [m]"))
def section_at(height):
    return plot.section(city, height, np.minimum(city.clearance, 15.0), label="clearance [m], at most 15 m")


# %% [markdown]
# ## The ring and the ball
#
# REPARE has no clearance. Its UAV looks at the 26 nodes of an *outer ring* (Fig. 5): one cell away would be its
# neighbours, the outer ring is $r$ cells away, along the axes and all their diagonals. If one of them is occupied,
# the node counts as risky and costs more (Eq. 12). What distance is that?
#
# Stand in front of a flat wall. The ring meets it as long as the nearest wall voxel is at most $r$ cells away. The
# first node that escapes has it $r+1$ cells away, centre to centre, so
#
# $$D_{ring} = \bigl(r + \tfrac12\bigr)\, c \quad\text{from its centre to the surface.} \tag{6}$$
#
# Radii 3, 4 and 5 on a map of 1 m give 3.5, 4.5 and 5.5 m: exactly the three safe distances of REPARE Table 4, and
# with a body of 1 m exactly Eq. 7: $D_{min} = \xi + D_{uav}/2$ with offsets $\xi$ of 3, 4 and 5 m.


# %%
# NBVAL_CHECK_OUTPUT
def accepted_by_ring(radius, thickness):
    """Smallest clearance [m] that a ring calls free of risk, in front of a wall this thick [m]."""
    wall = City(np.pad(np.ones((thickness, 41, 41), dtype=bool), ((0, 20), (0, 0), (0, 0))))
    risky = penalty_zone(wall, radius + 0.5, penalty=1.0, shape="ring") > 1
    return float(wall.clearance[:, 20, 20][~risky[:, 20, 20]].min())


for radius, table4 in ((3, 3.5), (4, 4.5), (5, 5.5)):
    kept = accepted_by_ring(radius, thickness=10)
    print(f"outer ring of radius {radius}: keeps {kept} m from a thick wall, Table 4 asks for {table4} m")
    assert kept == table4

# %% [markdown]
# So far the ring is as good as a *ball*, that is as asking $D < D_{min}$. But the wall was thick. The ring looks
# $r$ cells away and nowhere else: it looks *through* a wall that is thinner than $r$ cells, once the UAV is near
# enough.

# %%
# NBVAL_CHECK_OUTPUT
print("thickness of the wall    2 m    3 m    4 m    5 m    6 m")
for radius in (3, 4, 5):
    accepted = [accepted_by_ring(radius, thickness) for thickness in range(2, 7)]
    print(f"ring of radius {radius} accepts", *(f"{clearance:>4} m" for clearance in accepted))
    assert [clearance == radius + 0.5 for clearance in accepted] == [t >= radius for t in range(2, 7)]

# %% [markdown]
# And 26 nodes are few: walls are not always parallel to an axis, and between two nodes of the ring there is a gap
# of $r$ cells through which something slim can slip. Let us measure, over all free voxels of the city: the share of
# the ball that the ring misses, what it adds, and the smallest clearance of a node that the ring calls free of
# risk.

# %%
# NBVAL_CHECK_OUTPUT
ring_zones, missed, added, kept = {}, {}, {}, {}
print("radius  ball     ring misses  ring adds  clearance that the ring accepts")
for r in range(1, 9):
    ring = ring_zones[r] = (penalty_zone(city, r + 0.5, penalty=1.0, shape="ring") > 1) & free
    ball = (penalty_zone(city, r + 0.5, penalty=1.0) > 1) & free
    missed[r], added[r] = (ball & ~ring).sum() / ball.sum(), (ring & ~ball).sum() / ball.sum()
    kept[r] = city.clearance[free & ~ring].min()
    print(f"{r:>4} m  < {r + 0.5} m  {missed[r]:>10.1%} {added[r]:>10.1%} {kept[r]:>13.2f} m")

# %%
assert [round(100 * missed[r], 1) for r in (3, 4, 5, 6)] == [0.8, 1.0, 1.4, 2.8]
assert [round(100 * added[r], 1) for r in (3, 4, 5, 6)] == [4.7, 4.0, 6.8, 7.3]
assert [round(kept[r], 2) for r in (3, 4, 5, 6)] == [2.55, 3.54, 3.81, 0.5]

# %% [markdown]
# At Table 4's radii the ring misses about one voxel in a hundred, so as a *price* it does nearly what it should. As
# a *guarantee* it doesn't hold: beside the oblique wall of the floating building it accepts 2.55 m where 3.5 m is
# meant, and 3.81 m where 5.5 m is meant. From radius 6 on it fails altogether: the spire is 5 m wide, the ring
# looks through it, and a node beside its wall counts as free of risk.

# %%
zones = ListedColormap(["white", "#56B4E9", "#E69F00", "#D55E00", "black"])  # Okabe and Ito
names = ["no penalty", "ring and ball", "ring only (adds)", "ball only (misses)", "building"]
figure, panels = plt.subplots(1, 2, figsize=(9.4, 5.0), dpi=plot.DPI, layout="constrained", sharey=True)
for axes, r in zip(panels, (3, 6), strict=True):
    ring, ball = ring_zones[r][:, :, 50], (city.clearance < r + 0.5)[:, :, 50]
    kind = np.select([city.occupied[:, :, 50], ring & ball, ring, ball], [4, 1, 2, 3], 0)
    plot.draw_map(axes, city, kind, zones, vmin=-0.5, vmax=4.5)
    axes.set(xlim=(0, 62), ylim=(40, 100), title=f"outer ring of radius {r} m against ball of {r + 0.5} m")
panels[1].set_ylabel("")
patches = [plt.Rectangle((0, 0), 1, 1, facecolor=zones(n), edgecolor="0.4", label=name) for n, name in enumerate(names)]
figure.legend(handles=patches, loc="outside lower center", ncols=5)
figure.suptitle("Section at 50 m: floating building and spire")
plot.finished(figure)

# %% [markdown]
# Does it matter how the distance is measured? With the distance between *centres*, the ball of radius $r$ is
# smaller, and the ring seems to miss nothing up to $r = 4$ and to add a sixth to a fifth. The truth depends on the
# definition, so say which one you use. In this course it is always the exact clearance, and `penalty_zone` takes
# the ball unless asked for the ring.

# %%
# NBVAL_CHECK_OUTPUT
for r in (2, 3, 4, 6):
    ball, ring = (between_centres <= r) & free, ring_zones[r]
    misses, adds = (ball & ~ring).sum() / ball.sum(), (ring & ~ball).sum() / ball.sum()
    print(f"radius {r}: of the ball between centres the ring misses {misses:.1%}, adds {adds:.1%}")
    assert (misses == 0) == (r <= 4)
    assert 0.16 < adds < 0.20

# %% [markdown]
# ## What resolution costs
#
# A box with edges $L$ has
#
# $$N = (L/c)^3 \tag{7}$$
#
# voxels: half the cell, eight times the memory and eight times the work. REPARE says in its conclusion that a finer
# map would increase its work significantly; this is by how much. The times are of the machine that ran this page
# last.

# %%
cells = (4.0, 2.0, 1.0, 0.5)
models = {}
for cell in cells:
    began = time.perf_counter()
    models[cell] = table1_city(cell)
    built = time.perf_counter()
    models[cell].clearance  # computed when first asked for
    print(f"{cell:g} m: grid {built - began:6.3f} s, clearance {time.perf_counter() - built:6.3f} s")

# %%
# NBVAL_CHECK_OUTPUT
for cell, model in models.items():
    error = model.occupied.sum() * cell**3 / exact_volume - 1
    memory = (model.occupied.nbytes + model.clearance.nbytes) / 1e6
    print(f"{cell:g} m: {model.occupied.size:>9,} voxels {memory:>5.1f} MB, volume {error:+.1%}")

# %% [markdown]
# Memory goes as Eq. 7 says. The volume doesn't: it is wrong by 8 % at 4 m and by *more*, 9 %, at 2 m. The reason is
# an accident of the numbers. Walls at 15, 35, 45 or 55 m run through the centres of voxels of 2 m, a centre on the
# wall counts as inside, and so a house gains up to half a cell on either side: the hip roof is 26 × 42 m large
# instead of 25 × 40 m. Shift the grid by a random part of a cell and the accident is gone:

# %%
# NBVAL_CHECK_OUTPUT
rng, spread = np.random.default_rng(4), {}
for cell in (4.0, 2.0, 1.0):
    volumes = []
    for shift in rng.uniform(0, cell, (20, 3)):
        shifted = City.from_buildings(city.buildings, cell=cell, origin=-shift, size=np.full(3, 100 + cell))
        volumes.append(shifted.occupied.sum() * cell**3)
    errors = np.array(volumes) / exact_volume - 1
    spread[cell] = errors.std(ddof=1)
    print(f"{cell:g} m, 20 random grids: volume {errors.mean():+.1%}, spread (1σ) {spread[cell]:.1%}")
    assert abs(errors.mean()) < 3 * spread[cell] / np.sqrt(20)  # no systematic error is left
assert spread[4.0] > 2 * spread[2.0] > 4 * spread[1.0]

# %% [markdown]
# On average a voxel city has the right volume; a single one is off by a spread that falls faster than the cell. The
# lesson: **a voxel map is one throw of the dice**. Whoever compares planners at one resolution should also shift
# the grid.
#
# The same section at all four resolutions, true outlines in orange:

# %%
outlines = [shapely.convex_hull(shapely.MultiPoint(p[:, :2])) for b in city.buildings for p in b.pieces]
figure, panels = plt.subplots(2, 2, figsize=(7.6, 7.6), dpi=plot.DPI, layout="constrained", sharex=True, sharey=True)
for axes, (cell, model) in zip(panels.flat, models.items(), strict=True):
    plot.draw_map(axes, model, np.where(model.occupied[:, :, int(50 / cell)], 1.0, np.nan), "Greys", vmin=0, vmax=2)
    for outline in outlines:
        axes.plot(*outline.exterior.xy, color="#D55E00", linewidth=1.2, label="true walls")
    axes.set_title(f"voxels of {cell:g} m")
    axes.label_outer()
panels[0, 0].legend(*(entries[:1] for entries in axes.get_legend_handles_labels()), loc="lower left", fontsize=8)
figure.suptitle("Section at 50 m, occupied voxels grey")
plot.finished(figure)

# %% [markdown]
# ## Alleys that close, walls that vanish
#
# Volume is not what a UAV hits. Two things are, and neither shows in the volume. Let $w$ be the width of an alley
# between two parallel walls, $t$ the thickness of a wall, and let the grid begin anywhere. The alley is open when
# at least one centre falls between the walls; the wall is seen when at least one centre falls into it:
#
# $$P(\text{alley closed}) = \max\Bigl(0,\; 1-\frac wc\Bigr), \qquad
#   P(\text{wall vanishes}) = \max\Bigl(0,\; 1-\frac tc\Bigr). \tag{8}$$
#
# So both are safe only with a cell smaller than the thinnest thing that counts. A closed alley costs a detour. A
# wall that has vanished costs the UAV. For an alley of 1.5 m and a wall of 0.6 m, by throwing 10 000 grids:

# %%
# NBVAL_CHECK_OUTPUT
rng = np.random.default_rng(8)
print("cell    alley of 1.5 m closed   wall of 0.6 m gone   (Eq. 8 in brackets)")
for cell in cells:
    first_centre = rng.uniform(0, cell, 10_000)  # of those beyond the near wall
    closed, gone = (first_centre >= 1.5).mean(), (first_centre > 0.6).mean()
    expected = [max(0, 1 - 1.5 / cell), max(0, 1 - 0.6 / cell)]
    print(f"{cell:g} m {closed:>14.1%} ({expected[0]:.1%}) {gone:>15.1%} ({expected[1]:.1%})")
    assert np.allclose([closed, gone], expected, atol=0.02)

# %% [markdown]
# And here is what it does to a route. Two tall blocks leave an alley of 1.5 m (at $x = 19.2$ to $20.7$ m); north of
# it stands a free wall 0.6 m thick. A\* looks for a way from south to north.

# %%
outlines = [[(0, 5.5), (19.2, 14.5)], [(20.7, 5.5), (40, 14.5)], [(8, 19.7), (32, 20.3)]]
blocks = [
    Building.prism([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], 8, name=name)
    for name, [(x0, y0), (x1, y1)] in zip(("west", "east", "thin wall"), outlines, strict=True)
]
towns = {cell: City.from_buildings(blocks, cell=cell, origin=(0, 0, 0), size=(40, 28, 8)) for cell in cells}
routes = {cell: astar(town, (20.1, 1, 4), (20.1, 27, 4)) for cell, town in towns.items()}
figure, panels = plt.subplots(2, 2, figsize=(9.0, 6.8), dpi=plot.DPI, layout="constrained", sharex=True, sharey=True)
for axes, (cell, route) in zip(panels.flat, routes.items(), strict=True):
    plot.draw_map(axes, towns[cell], np.where(towns[cell].occupied[:, :, 0], 1.0, np.nan), "Greys", vmin=0, vmax=2)
    for (x0, y0), (x1, y1) in outlines:
        axes.plot([x0, x1, x1, x0, x0], [y0, y0, y1, y1, y0], color="#D55E00")
    axes.plot(*route.points[:, :2].T, color="#0072B2", linewidth=2.5)
    axes.set_title(f"voxels of {cell:g} m: " + (f"{route.length:.1f} m" if route.reached else "no way"))
    axes.label_outer()
figure.suptitle("True walls orange, occupied voxels grey, route blue")
plot.finished(figure)

# %%
# NBVAL_CHECK_OUTPUT
through_the_wall = {}
for cell, route in routes.items():
    through_the_wall[cell] = route.reached and bool(blocks[2].contains(route.resample(0.05).points).any())
    verdict = "no way" if not route.reached else f"{route.length:.1f} m"
    print(f"{cell:g} m: {verdict}" + (", straight THROUGH the thin wall" if through_the_wall[cell] else ""))

# %%
assert [route.reached for route in routes.values()] == [False, False, True, True]
assert list(through_the_wall.values()) == [False, False, True, False]

# %% [markdown]
# Four resolutions, three answers. At 4 and 2 m there is no way at all. At 1 m there is one, and it is the worst of
# the answers: the wall is gone, the planner is content, and the route goes through it. Only 0.5 m, less than the
# thinnest thing on the map, gets it right. What can be done when a cell that small costs too much? Make thin things
# thicker before they become voxels: half a cell on each side, and every wall is at least one cell thick. And keep
# more distance than asked for, since even a wall that is seen may stand about half a cell before its voxels.
#
# ## A real city
#
# Nobody types corners. Three readers make a `City` from what can be had:
#
# | reader | format | where from |
# |---|---|---|
# | `read_geojson` | outlines with heights, in degrees or metres | OpenStreetMap exports, open data of cities |
# | `read_cityjson` | models with roofs | national 3D registers, for example of the Netherlands |
# | `read_voxels` | voxel maps `.3dmap` | benchmarks of 3-D path finding |
#
# and `read_city` chooses one by what is in the file. So that this page needs no network, it writes its own file:
# four blocks of the kind that makes up the Eixample in Barcelona, invented but true to scale. They are squares of
# 113 m with cut corners, a courtyard inside, streets of 20 m between them, turned by 45° against north.

# %%
CENTRE = 2.1620, 41.3900  # longitude and latitude [degrees], in Barcelona
METRES_PER_DEGREE = 83_634, 111_062  # east and north at this latitude


def block(column, row, height):
    """A GeoJSON feature: one block with its courtyard."""
    square = shapely.box(-56.5, -56.5, 56.5, 56.5)
    outline = square.buffer(-14).buffer(14, join_style="bevel")  # cuts the corners
    ring = outline.difference(outline.buffer(-28, join_style="mitre"))
    placed = rotate(translate(ring, 133 * column, 133 * row), 45, origin=(0, 0))
    lonlat = shapely.transform(placed, lambda points: points / METRES_PER_DEGREE + CENTRE)
    return {"type": "Feature", "properties": {"height": height}, "geometry": mapping(lonlat)}


heights = {(-0.5, -0.5): 20, (0.5, -0.5): 24, (-0.5, 0.5): 28, (0.5, 0.5): "22 m"}
blocks = {"type": "FeatureCollection", "features": [block(*place, height) for place, height in heights.items()]}
print(json.dumps(blocks)[:220], "…")

# %% [markdown]
# The reader takes heights as numbers or as texts with "m", projects the degrees onto a plane that touches the
# ellipsoid in the south-west corner of the buildings, and puts $x = y = 0$ there.

# %%
# NBVAL_CHECK_OUTPUT
with tempfile.TemporaryDirectory() as folder:
    path = Path(folder) / "blocks.geojson"
    path.write_text(json.dumps(blocks))
    town = read_geojson(path, cell=2.0)
built = sum(hull.volume for building in town.buildings for hull in building.hulls)
print(f"{len(town.buildings)} buildings, {town.shape[0]} × {town.shape[1]} × {town.shape[2]} voxels of {town.cell:g} m")
print(f"built volume {built:,.0f} m³, in voxels {town.occupied.sum() * town.cell**3 / built - 1:+.1%}")
print("x = y = 0 lies at longitude {:.4f}°, latitude {:.4f}°".format(*town.reference))

# %%
ground = 113**2 - 4 * 14**2 / 2 - 57**2  # square, without its corners and its courtyard
assert built == pytest.approx(ground * (20 + 24 + 28 + 22), rel=1e-4)  # degrees there and back
plot.section(town, 11.0, np.minimum(town.clearance, 25.0), label="clearance [m], 25 m and more in yellow")

# %% [markdown]
# The courtyards are there. A flight from one to another has to climb over the roofs. A\* with 3.5 m of clearance,
# then the straight lines of `shortcut` ([06 A*](06_astar.ipynb) explains both):

# %%
# NBVAL_CHECK_OUTPUT
on_grid = astar(town, (70, 164, 11), (258, 164, 11), min_clearance=3.5)
straight = shortcut(on_grid, town, min_clearance=3.5)
for route in (on_grid, straight):
    print(f"{route.planner}: {route.length:.1f} m, highest {route.points[:, 2].max():.0f} m, "
          f"clearance {route.clearance(town):.1f} m")  # fmt: skip
assert straight.reached
assert straight.clearance(town) >= 3.5

# %%
scene.show(town, straight, on_grid, safe_distance=3.5)

# %% [markdown]
# ### Roofs and voxels from files
#
# A CityJSON model knows every face of a roof. Its coordinates are whole numbers, which `transform` turns into
# metres. Here is the smallest one that makes sense, a house of 12 × 8 m with a gable roof; the reader fills what
# lies below its faces.

# %%
# NBVAL_CHECK_OUTPUT
corners = [(x, y, z) for z in (0, 6000) for x, y in ((0, 0), (12000, 0), (12000, 8000), (0, 8000))]
corners += [(0, 4000, 9000), (12000, 4000, 9000)]  # the ridge
faces = [(3, 2, 1, 0), (0, 1, 5, 4), (2, 3, 7, 6), (1, 2, 6, 9, 5), (3, 0, 4, 8, 7), (4, 5, 9, 8), (6, 7, 8, 9)]
solid = {"type": "Solid", "lod": "2.2", "boundaries": [[[face] for face in faces]]}
model = {
    "type": "CityJSON",
    "version": "2.0",
    "transform": {"scale": [0.001, 0.001, 0.001], "translate": [85000, 447000, 0]},
    "CityObjects": {"house": {"type": "Building", "geometry": [solid]}},
    "vertices": corners,
}
with tempfile.TemporaryDirectory() as folder:
    path = Path(folder) / "house.city.json"
    path.write_text(json.dumps(model))
    house = read_cityjson(path, cell=0.5, margin=5.0)
volume = house.occupied.sum() * house.cell**3
print(f"{house.buildings[0].name}: {volume:.0f} m³ in voxels; by hand {12 * 8 * 6 + 12 * 8 * 3 / 2:.0f} m³")

# %%
assert volume == pytest.approx(720, rel=0.05)
scene.show(house, height=360)

# %% [markdown]
# A voxel map holds no buildings at all, only the blocked voxels, one per line and counted from 0. Table 1's city at
# 4 m, written and read back:

# %%
# NBVAL_CHECK_OUTPUT
lines = ["voxel 25 25 25", *(f"{i} {j} {k}" for i, j, k in np.argwhere(coarse.occupied))]
with tempfile.TemporaryDirectory() as folder:
    path = Path(folder) / "table1.3dmap"
    path.write_text("\n".join(lines))
    again = read_voxels(path, cell=4.0)
print(f"{lines[0]!r}, then {len(lines) - 1:,} lines like {lines[1]!r}; the same city: ", end="")
print(np.array_equal(again.occupied, coarse.occupied))
assert np.array_equal(again.occupied, coarse.occupied)

# %% [markdown]
# ### Your city
#
# **Put the path of a file into the next cell and run it.** GeoJSON with a property for the height (add
# `height="..."` to `read_city` if it isn't called `height`), CityJSON, or `.3dmap`. What can't be read is refused
# with its place in the file and what to do about it. Begin with a large cell: Eq. 7. Then plan through it:
# `astar(my_city, start, goal, min_clearance=3.5)`, with two points within `my_city.bounds`.

# %%
MY_CITY = None  # put a path here, as in "downloads/delft.city.json"

my_city = None if MY_CITY is None else read_city(MY_CITY, cell=2.0)
if my_city is None:
    print("no file given: set MY_CITY and run this cell again")
else:
    size = my_city.bounds[1] - my_city.bounds[0]
    print(f"{my_city.name}: {len(my_city.buildings)} buildings, {my_city.occupied.size:,} voxels")
    print(f"{size[0]:.0f} × {size[1]:.0f} × {size[2]:.0f} m, {my_city.occupied.mean():.1%} built")
None if my_city is None else scene.show(my_city)

# %% [markdown]
# ## What the paper says, what we find
#
# | REPARE | says | we find |
# |---|---|---|
# | Table 1 | a map of 100 × 100 × 100 m in units of 1 m | 1 000 000 voxels, 144 858 occupied (14.5 %) |
# | Table 1 | five buildings by their corners | together 144 372 m³; the voxels hold 0.3 % more |
# | Table 1, no. 1 | one list of 15 corners | not convex, its hull would fill the notch: two wings |
# | Fig. 5, Table 4 | safe distances 3.5, 4.5, 5.5 m | rings of radius 3, 4, 5 keep just these from a flat wall |
# | Fig. 5 | 26 nodes watch the zone | as a price nearly: they miss 0.8, 1.0, 1.4 % of it |
# | Fig. 5 | a safe distance is kept | as a guarantee no: 2.55, 3.54, 3.81 m are accepted |
# | Fig. 5 | no limit to the radius | walls thinner than $r$ cells are looked through; at 6 m the spire, too |
# | Section 4 | a finer map takes much more work | 8 times the voxels for half the cell |
#
# The paper prints no count of voxels and doesn't say from where a distance is measured. Our reading, from the
# centre of the UAV to the surface, is the one in which Table 4, Eq. 7 and the ring agree.

# %%
# NBVAL_CHECK_OUTPUT
radii = (3, 4, 5)
print("ring radius  Table 4  zone missed  smallest clearance accepted")
for r, table4 in zip(radii, (3.5, 4.5, 5.5), strict=True):
    print(f"{r:>9} m {table4:>6} m {missed[r]:>11.1%} {kept[r]:>14.2f} m")
    assert kept[r] < table4 == r + 0.5
assert city.occupied.size == 1_000_000
assert round(exact_volume) == 144_372
assert kept[6] == 0.5
assert all(fine.occupied.size == 8 * rough.occupied.size for rough, fine in pairwise(models.values()))

# %% [markdown]
# ## Your turn, and the way on
#
# Three exercises: from a code back to its voxel, the distance from any point to a voxel, and how much clearance an
# alley keeps on the most unlucky grid: [exercises](exercises/04_cities_exercises.ipynb).
#
# Next: [06 A*](06_astar.ipynb) finds the cheapest way through these voxels, and shows what Eqs 11-13 do with the
# ring's penalty.
