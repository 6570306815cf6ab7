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
# A city is walls, roofs and courtyards. A planner wants something simpler: a finite set of places, and for each of them
# two answers: *may I be here?* and *how far is the nearest wall?* This notebook makes the one into the other. It builds
# the city in which the paper REPARE tests its planner for drones (UAVs), from the corners in its Table 1, cuts it into
# cubes, measures the distance to the walls exactly, and then asks what the size of a cube costs: in memory, in time,
# and in alleys that close and walls that vanish. Then the ground gets a hill, and a file gets the mistakes that files
# have. At the end you read a real city from a file of your own.
#
# *Run All* (in the menu **Run**) brings the 3D scenes and the slider to life; until then a still picture stands in
# their place. The comment `NBVAL_CHECK_OUTPUT` is for our tests.

# %%
import json
import tempfile
import time
import warnings
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import shapely
from scipy.ndimage import distance_transform_edt
from scipy.spatial import ConvexHull, HalfspaceIntersection
from shapely.affinity import rotate, translate
from shapely.geometry import mapping

# %%
from uavlab import plot, scene
from uavlab.city import (
    Building,
    City,
    NoFlyZone,
    Place,
    Terrain,
    read_city,
    read_cityjson,
    read_geojson,
    read_voxels,
    table1_city,
)
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
# In the scene 1 is orange, 2 light blue, 3 green, 4 dark blue, 5 yellow. Drag to turn it, scroll to zoom.

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

# %% tags=["nbval-check-output"]
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
# The overlap is convex again: it lies behind the faces of both. SciPy finds its corners from the faces and one point
# inside.


# %% tags=["nbval-check-output"]
def volume_of(building):
    """Volume of the pieces [m³]; where they overlap it counts twice."""
    return sum(ConvexHull(piece).volume for piece in building.pieces)


notch = city.buildings[0]
filled = Building.hull(np.vstack(notch.pieces))
in_the_notch = (80, 30, 30)
overlap = HalfspaceIntersection(np.vstack([hull.equations for hull in notch.hulls]), np.array([65.0, 40.0, 30.0]))
notch_volume = volume_of(notch) - ConvexHull(overlap.intersections).volume
print(f"{in_the_notch} is inside: hull {filled.contains(in_the_notch)}, two wings {notch.contains(in_the_notch)}")
print(f"volume: hull {volume_of(filled):,.0f} m³, two wings {notch_volume:,.0f} m³")

# %%
assert filled.contains(in_the_notch)
assert not notch.contains(in_the_notch)
assert volume_of(filled) / notch_volume == pytest.approx(1.48, abs=0.005)

# %% [markdown]
# ## From buildings to voxels
#
# Cut the box into cubes with edge $c$, called *voxels*. Voxel $(i, j, k)$ counts from 0 on each axis, and its
# centre is
#
# $$\mathbf x_{ijk} = \mathbf x_0 + c\,\bigl(i+\tfrac12,\; j+\tfrac12,\; k+\tfrac12\bigr), \tag{3}$$
#
# with $\mathbf x_0$ the lowest corner of the map. The centres are the *nodes* that a planner visits. One rule decides
# what a planner sees, and there are two to choose from:
#
# - `voxels="touched"`: **a voxel is occupied when a building reaches into it.** This is the library's default. A
#   free voxel then holds no part of any building.
# - `voxels="centres"`: a voxel is occupied when its *centre* lies in a building. The papers don't say which rule
#   is theirs; we take it to be this one. Its volume is right on average, but it loses what is thin. `table1_city()`
#   uses it, so that our numbers can be compared with REPARE's.
#
# REPARE's map has $c = 1$ m. Its five buildings by both rules:

# %% tags=["nbval-check-output"]
exact = {b.name: volume_of(b) for b in city.buildings} | {notch.name: notch_volume}
counts = {rule: [] for rule in ("centres", "touched")}
for building in city.buildings:
    for rule, numbers in counts.items():
        alone = City.from_buildings([building], origin=(0, 0, 0), size=(100, 100, 100), voxels=rule)
        numbers.append(int(alone.occupied.sum()))
print(f"{'':<11} {'centres':>10} {'touched':>9}")
for name, volume, *both in zip(exact, exact.values(), *counts.values(), strict=True):
    print(f"{name:<11} {both[0]:>10,} {both[1]:>9,} voxels, {volume:>9,.0f} m³")
total, exact_volume = int(city.occupied.sum()), sum(exact.values())
print(f"{'together':<11} {total:>10,} {sum(counts['touched']):>9,} voxels, {exact_volume:>9,.0f} m³")

# %%
assert total == 144_858 == sum(counts["centres"])  # no voxel belongs to two buildings
assert counts["centres"] == [37_360, 62_094, 34_340, 7_500, 3_564]
assert counts["centres"][4] / exact["5 spire"] - 1 == pytest.approx(0.057, abs=5e-4)
assert total / exact_volume - 1 == pytest.approx(0.0034, abs=5e-5)
assert sum(counts["touched"]) / exact_volume - 1 == pytest.approx(0.018, abs=5e-4)

# %% [markdown]
# A voxel has one cubic metre, so the counts are volumes. By centres they are 144 858 m³ against 144 372 m³ in truth,
# 0.3 % too much. The spire is the worst, 5.7 % too large: its section has 35 m², and 37 centres lie in it. By touch
# they are 1.8 % too much. That is little, because most walls of Table 1 lie on whole metres, just between two voxels;
# below we shift the grid.
#
# This is what the planner sees, at a coarser 4 m so that you can tell the voxels apart. Gone are the roofs; there
# are steps.

# %%
coarse = table1_city(4.0)
scene.show(City(coarse.occupied, coarse.cell, name="What the planner sees, voxels of 4 m"))

# %% [markdown]
# ### One number per node
#
# Planners keep some values for each node, such as its cost, in plain arrays. So each node needs one number, its
# *code*:
#
# $$n = k + n_z\,(j + n_y\, i), \qquad 0 \le n < n_x n_y n_z, \tag{4}$$
#
# with $n_x, n_y, n_z$ the numbers of voxels along each axis. Reading the formula from the inside: $i$ slabs of $n_y
# n_z$ voxels, then $j$ rows of $n_z$, then $k$. It is the position of the voxel in `city.occupied.ravel()`, where
# `city.occupied` is a Boolean array. One step east adds $n_y n_z$ to the code, one step north adds $n_z$, one step up
# adds 1. The course's other two papers number their nodes too, without a formula: RISK-ACO (section 1) from left to
# right, from the back to the front, from the top down, which `as_printed=True` does; PSO-BAS (section 2) doesn't say.
# Which order is taken doesn't matter as long as it can be undone.

# %% tags=["nbval-check-output"]
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
assert city.index_of(city.code_of((i, j, k), as_printed=True), as_printed=True).tolist() == [i, j, k]

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

# %% tags=["nbval-check-output"]
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
# Straight ahead half a cell is lost; towards an edge or a corner it is up to half the diagonal of a voxel, 0.87 m. In
# the whole city, with 3.5 m, the smallest safe distance of REPARE's Table 4, as an example:

# %% tags=["nbval-check-output"]
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
# `city.clearance` is exact and computed once for all voxels, one axis after the other (Felzenszwalb and Huttenlocher
# 2012), so its cost grows only with the number of voxels. It counts occupied voxels only, so Table 1's open floor and
# the border of the map are no obstacles.
#
# A section at 50 m cuts all five buildings, the floating one too. Between the buildings the clearance has ridges,
# where two walls are equally far: these are the streets that a careful UAV flies along.

# %%
plot.section(city, 50.0, np.minimum(city.clearance, 15.0), label="clearance [m], 15 m and more in yellow")

# %% [markdown]
# Move the section up and down. Up to which height can you pass below the floating building, and from which height
# on does the spire stand alone? (Up to 45 m, and from 90 m on.)


# %%
def section_at(height):
    return plot.section(city, height, np.minimum(city.clearance, 15.0), label="clearance [m], at most 15 m")


heights, labels = [*range(0, 100, 5), 99], {"height": "height [m]"}
plot.sliders(section_at, title="clearance", labels=labels, start={"height": 30}, progress=False, height=heights)


# %% [markdown]
# ## The ring and the ball
#
# REPARE has no clearance. Its UAV looks at 26 nodes, the *outer ring* (its Fig. 5): those at $(i + r\,a,\; j + r\,b,\;
# k + r\,e)$, where each of $a, b, e$ is −1, 0 or 1, and not all are 0. With $r = 1$ they would be its neighbours. If
# one of them is occupied, the node counts as risky and costs more (REPARE's Eq. 12). What distance is that?
#
# Stand in front of a flat wall. The ring meets it as long as the nearest wall voxel is at most $r$ cells away. The
# first node that escapes has it $r+1$ cells away, centre to centre, so
#
# $$D_{ring} = \bigl(r + \tfrac12\bigr)\, c \quad\text{from its centre to the surface.} \tag{6}$$
#
# Radii 3, 4 and 5 on a map of 1 m give 3.5, 4.5 and 5.5 m: exactly the three safe distances of REPARE Table 4, and
# with a body of 1 m exactly REPARE's Eq. 7: $D_{min} = \xi + D_{uav}/2$ with offsets $\xi$ of 3, 4 and 5 m.


# %% tags=["nbval-check-output"]
def accepted_by_ring(radius, thickness):
    """Smallest clearance [m] that a ring calls free of risk, in front of a wall this thick [m]."""
    wall = City(np.pad(np.ones((thickness, 41, 41), dtype=bool), ((0, 20), (0, 0), (0, 0))))
    risky = penalty_zone(wall, radius + 0.5, penalty=1.0, zone="ring") > 1
    return float(wall.clearance[:, 20, 20][~risky[:, 20, 20]].min())


for radius, table4 in ((3, 3.5), (4, 4.5), (5, 5.5)):
    kept = accepted_by_ring(radius, thickness=10)
    print(f"outer ring of radius {radius}: keeps {kept} m from a thick wall, Table 4 asks for {table4} m")
    assert kept == table4

# %% [markdown]
# The exact test is a *ball*: a node is risky when $D < D_{min}$. (`penalty_zone` gives the factor on the cost of each
# node, by either test; above 1 it is risky.) Before this wall, 10 m thick, ring and ball agree. But the ring looks $r$
# cells away and nowhere else: it looks *through* a wall that is thinner than $r$ cells, once the UAV is near enough.

# %% tags=["nbval-check-output"]
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

# %% tags=["nbval-check-output"]
ring_zones, missed, added, kept = {}, {}, {}, {}
print("radius  ball     ring misses  ring adds  clearance that the ring accepts")
for r in range(1, 9):
    ring = ring_zones[r] = (penalty_zone(city, r + 0.5, penalty=1.0, zone="ring") > 1) & free
    ball = (penalty_zone(city, r + 0.5, penalty=1.0) > 1) & free
    missed[r], added[r] = (ball & ~ring).sum() / ball.sum(), (ring & ~ball).sum() / ball.sum()
    kept[r] = city.clearance[free & ~ring].min()
    print(f"{r:>4} m  < {r + 0.5} m  {missed[r]:>10.1%} {added[r]:>10.1%} {kept[r]:>13.2f} m")

# %%
assert [round(100 * missed[r], 1) for r in (3, 4, 5, 6)] == [0.8, 1.0, 1.4, 2.8]
assert [round(100 * added[r], 1) for r in (3, 4, 5, 6)] == [4.7, 4.0, 6.8, 7.3]
assert [round(kept[r], 2) for r in (3, 4, 5, 6)] == [2.55, 3.54, 3.81, 0.5]

# %% [markdown]
# At Table 4's radii the ring misses about 1 % of the ball and adds 4 to 7 %. As a *price* that is nearly right. As a
# *guarantee* it doesn't hold: off the corners of the spire and of the floating building it accepts 2.55 m where 3.5 m
# is meant, and 3.81 m where 5.5 m is meant. From radius 6 on it fails altogether: the spire is 5 m wide, the ring looks
# through it, and a node beside its wall counts as free of risk.

# %% tags=["figure"]
figure, panels = plot.new_panels(1, 2, share="y", width=9.4, height=5.0)
colors = {"ring and ball": plot.SKY, "ring only (adds)": plot.YELLOW, "ball only (misses)": plot.ORANGE}
for axes, r in zip(panels, (3, 6), strict=True):
    ring, ball = ring_zones[r][:, :, 50], (city.clearance < r + 0.5)[:, :, 50]
    parts = {"ring and ball": ring & ball, "ring only (adds)": ring & ~ball, "ball only (misses)": ball & ~ring}
    plot.area_map(city, parts | {"building": city.occupied[:, :, 50]}, area=(0, 62, 40, 100), colors=colors, axes=axes,
                  title=f"50 m high: outer ring of radius {r} m, ball of {r + 0.5} m")  # fmt: skip
figure

# %% [markdown]
# Does it matter how the distance is measured? With the distance between *centres*, the ball of radius $r$ is
# smaller, and the ring seems to miss nothing up to $r = 4$ and to add a sixth to a fifth. The truth depends on the
# definition, so say which one you use. In this course it is always the exact clearance, and `penalty_zone` takes
# the ball unless asked for the ring.

# %% tags=["nbval-check-output"]
for r in (2, 3, 4, 5, 6):
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
# voxels: half the cell, eight times the voxels and the memory. REPARE says in its conclusion that a finer map would
# increase its work significantly. Here the clearance takes most of the time, and on large maps that grows about as $N$
# does. The times are of the machine that ran this page last.

# %%
cells = (4.0, 2.0, 1.0, 0.5)
models = {}
for cell in cells:
    began = time.perf_counter()
    models[cell] = table1_city(cell)
    built = time.perf_counter()
    models[cell].clearance  # computed when first asked for
    print(f"{cell:g} m: grid {built - began:6.3f} s, clearance {time.perf_counter() - built:6.3f} s")

# %% tags=["nbval-check-output"]
for cell, model in models.items():
    error = model.occupied.sum() * cell**3 / exact_volume - 1
    memory = (model.occupied.nbytes + model.clearance.nbytes) / 1e6
    print(f"{cell:g} m: {model.occupied.size:>9,} voxels {memory:>5.1f} MB, volume {error:+.1%}")

# %% [markdown]
# Memory goes as Eq. 7 says. The volume doesn't: it is wrong by 8 % at 4 m and by *more*, 9 %, at 2 m. The reason is
# an accident of the numbers. Walls at 15, 35, 45 or 55 m run through the centres of voxels of 2 m, a centre on the
# wall counts as inside, and so a house gains up to half a cell on either side: the hip roof is 26 × 42 m large
# instead of 25 × 40 m. Shift the grid by a random part of a cell and the accident is gone. Here are both rules:

# %% tags=["nbval-check-output"]
rng, spread, excess = np.random.default_rng(4), {}, {}
for cell in (4.0, 2.0, 1.0):
    shifts = rng.uniform(0, cell, (20, 3))
    for rule in ("centres", "touched"):
        options = {"cell": cell, "size": np.full(3, 100 + cell), "voxels": rule}
        shifted = [City.from_buildings(city.buildings, origin=-shift, **options) for shift in shifts]
        errors = np.array([one.occupied.sum() for one in shifted]) * cell**3 / exact_volume - 1
        spread[rule, cell], excess[rule, cell] = errors.std(ddof=1), errors.mean()
        print(f"{cell:g} m, 20 random grids, {rule}: volume {errors.mean():+.1%}, spread (1σ) {errors.std(ddof=1):.1%}")

# %%
assert all(abs(excess["centres", c]) < 3 * spread["centres", c] / np.sqrt(20) for c in (4.0, 2.0, 1.0))  # no bias
assert spread["centres", 4.0] > 2 * spread["centres", 2.0] > 4 * spread["centres", 1.0]
assert [round(100 * excess["touched", c]) for c in (4.0, 2.0, 1.0)] == [53, 26, 12]

# %% [markdown]
# By centres a voxel city has the right volume on average; a single one is off by a spread that falls faster than the
# cell. By touch it is always too large, about in proportion to the cell: each wall moves outwards by half a cell on
# average. The lesson for both: **a voxel map is one throw of the dice**. If you compare planners at one resolution,
# shift the grid as well.
#
# The same section at all four resolutions, by centres, true outlines in orange:

# %% tags=["figure"]
outlines = [shapely.convex_hull(shapely.MultiPoint(p[:, :2])) for b in city.buildings for p in b.pieces]
rings = [np.vstack([shapely.get_coordinates(outline), [[np.nan, np.nan]]]) for outline in outlines]
figure, panels = plot.new_panels(2, 2, share="xy", width=7.6, height=7.6)
for axes, (cell, model) in zip(panels, models.items(), strict=True):
    plot.area_map(model, {"occupied voxels": model.occupied[:, :, int(50 / cell)]}, paths={"true walls": np.vstack(rings)},
                  title=f"voxels of {cell:g} m, 50 m high", colors={"occupied voxels": "0.6", "true walls": plot.ORANGE}, axes=axes)  # fmt: skip
figure

# %% [markdown]
# ## Alleys that close, walls that vanish
#
# Volume is not what a UAV hits. Two things are, and neither shows in the volume. Let $w$ be the width of an alley
# between two parallel walls, $t$ the thickness of a wall, and let the grid begin anywhere.
#
# By *centres* the alley is open when at least one centre falls between the walls. The wall is seen when at least one
# centre falls into it. So with probabilities
#
# $$P(\text{alley closed}) = \max\Bigl(0,\; 1-\frac wc\Bigr), \qquad
#   P(\text{wall vanishes}) = \max\Bigl(0,\; 1-\frac tc\Bigr). \tag{8}$$
#
# By *touch* a wall of any thickness lies in some voxel, so it never vanishes. The alley is open only when a whole voxel
# fits between the walls:
#
# $$P(\text{alley closed}) = \min\Bigl(1,\; \max\Bigl(0,\; 2-\frac wc\Bigr)\Bigr), \qquad
#   P(\text{wall vanishes}) = 0. \tag{9}$$
#
# A closed alley costs a detour. A wall that has vanished costs the UAV. *Predict first:* an alley of 1.5 m, a wall of
# 0.8 m, voxels of 2 m. How often does either rule close the alley, how often does it lose the wall? We build the city
# on 200 random grids for each cell and rule:

# %%
WIDTH, THICKNESS = 1.5, 0.8  # of the alley and of the wall [m]


def slab(west, east, south=0.0, north=8.0, *, height=8.0, name="block"):
    return Building.prism([(west, south), (east, south), (east, north), (west, north)], height, name=name)


row = [slab(0, 10), slab(10 + WIDTH, 20), slab(30, 30 + THICKNESS)]
rng, measured = np.random.default_rng(8), {"centres": {}, "touched": {}}
for cell in (0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0):
    for rule, shares in measured.items():
        closed = gone = 0
        for shift in rng.uniform(0, cell, 200):
            grid = City.from_buildings(row, cell=cell, origin=(-shift, 0, 0), size=(45, cell, cell), voxels=rule)
            x, solid = grid.coordinates(0), grid.occupied[:, 0, 0]
            closed += solid[(x > 5) & (x < 16)].all()
            gone += not solid[x > 26].any()
        shares[cell] = closed / 200, gone / 200

# %% tags=["nbval-check-output"]
for cell in (0.5, 1.0, 2.0, 4.0):
    shown = (f"{rule}: alley closed {shares[cell][0]:>4.0%}, wall lost {shares[cell][1]:>4.0%}"
             for rule, shares in measured.items())  # fmt: skip
    print(f"{cell:g} m", *shown, sep="   ")

# %%
for cell in measured["centres"]:
    expected = [max(0, 1 - WIDTH / cell), max(0, 1 - THICKNESS / cell)], [np.clip(2 - WIDTH / cell, 0, 1), 0]
    assert np.allclose([shares[cell] for shares in measured.values()], expected, atol=0.12)  # 200 throws: 3.4 σ
figure, panels = plot.new_panels(1, 2, share="y", width=9.0)
c = np.linspace(0.4, 4.2, 400)
by_rule = {'"centres"': (1 - WIDTH / c, 1 - THICKNESS / c), '"touched"': (np.minimum(2 - WIDTH / c, 1), 0 * c)}
for number, (axes, title) in enumerate(zip(panels, ("alley of 1.5 m closed", "wall of 0.8 m lost"), strict=True)):
    curves = {rule: 100 * np.maximum(both[number], 0) for rule, both in by_rule.items()}
    marks = {
        f'"{rule}"': [(cell, 100 * share[number]) for cell, share in shares.items()]
        for rule, shares in measured.items()
    }
    plot.lines(c, curves, "edge of a voxel [m]", "share of grids [%]", points=marks, point_label="measured",
               title=title, axes=axes)  # fmt: skip
figure

# %% [markdown]
# At 2 m the centres lose the wall on six grids in ten, and close the alley on three in ten (Eq. 8: a quarter). Touch
# loses nothing, and closes the alley always. Even at 1 m, touch closes the alley on half of the grids. Centres never
# do: the alley is wider than a voxel, so that a centre always falls into it. So the two rules err on different sides:
# by touch the planner misses ways that there are, by centres it takes ways that there aren't.
#
# Here is what it does to a route. Two blocks as high as the map, 8 m, leave an alley of 1.5 m (at $x = 19.2$ to $20.7$
# m); north of it stands a free wall 0.8 m thick. A\* looks for a way from south to north.

# %% tags=["nbval-check-output"]
blocks = [
    slab(0, 19.2, 5.5, 14.5, name="west"),
    slab(20.7, 40, 5.5, 14.5, name="east"),
    slab(8, 32, 19.6, 20.4, name="thin wall"),
]
thin_wall, town_map = blocks[2], {"origin": (0, 0, 0), "size": (40, 28, 8)}
towns = {(rule, cell): City.from_buildings(blocks, cell=cell, voxels=rule, **town_map)
         for rule in ("centres", "touched") for cell in (2.0, 1.0, 0.5)}  # fmt: skip
routes = {key: astar(town, (20.1, 1, 4), (20.1, 27, 4)) for key, town in towns.items()}
through_the_wall = {}
for (rule, cell), route in routes.items():
    through_the_wall[rule, cell] = route.reached and bool(thin_wall.contains(route.resample(0.05).points).any())
    verdict = "no way" if not route.reached else f"{route.length:.1f} m"
    print(f"{rule}, {cell:g} m: {verdict}" + (", THROUGH the thin wall" if through_the_wall[rule, cell] else ""))

# %%
assert [route.reached for route in routes.values()] == [False, True, True, False, False, True]
assert list(through_the_wall.values()) == [False, True, False, False, False, False]
assert not towns["centres", 2.0].occupied[10, 9:11].any()  # the wall is gone there, too
boxes = [shapely.get_coordinates(shapely.box(*building.bounds[:, :2].ravel())) for building in blocks]
walls = np.vstack([np.vstack([box, [[np.nan, np.nan]]]) for box in boxes])
figure, panels = plot.new_panels(2, 3, share="xy", width=9.6, height=5.8)
for axes, (key, route) in zip(panels, routes.items(), strict=True):
    ways = {"true walls": walls} | ({"A*": route.points[:, :2]} if route.reached else {})
    plot.area_map(towns[key], {"occupied voxels": towns[key].occupied[:, :, 0]}, paths=ways, axes=axes,
                  title=f"{key[0]}, {key[1]:g} m: " + (f"{route.length:.1f} m" if route.reached else "no way"),
                  colors={"occupied voxels": "0.6", "true walls": plot.ORANGE})  # fmt: skip
figure

# %% [markdown]
# By centres the wall is gone at 2 m and at 1 m. At 2 m the closed alley hides that: there is no way at all. At 1 m
# there is one, the planner is content, and its route goes through the wall. By touch the answer at 2 m and at 1 m is
# "no way". That is too careful, since a way exists. But no route hits a wall. At 0.5 m both rules find it. So when a
# planner finds no way through a narrow street, try a smaller cell before you believe it.
#
# Nor is the thin wall the only danger. A route of straight legs in any direction, as `shortcut` makes it ([05
# A\*](05_astar.ipynb)), passes voxels anywhere, not only through their centres. By centres a wall may reach into a free
# voxel, almost to its middle. A leg through that voxel can cut the corner or the roof of even a thick building. By
# touch a free voxel holds no part of any building. A leg that stays in free voxels therefore meets no wall. We check 50
# routes between Table 1's buildings, ten on each of five random grids, every 0.1 m:

# %% tags=["nbval-check-output"]
cut = {}
for cell in (4.0, 2.0, 1.0):
    for rule in ("centres", "touched"):
        rng, cut[rule, cell] = np.random.default_rng(4), 0
        for shift in rng.uniform(0, cell, (5, 3)):
            options = {"cell": cell, "size": np.full(3, 100 + cell), "voxels": rule}
            town = City.from_buildings(city.buildings, origin=-shift, **options)
            for start, goal in town.random_pairs(10, rng, apart=60.0):
                points = shortcut(astar(town, start, goal), town).resample(0.1).points
                cut[rule, cell] += any(building.contains(points).any() for building in town.buildings)
    print(f"{cell:g} m: routes that cut a building: by centres {cut['centres', cell]} of 50, "
          f"by touch {cut['touched', cell]} of 50")  # fmt: skip

# %%
assert [cut["centres", cell] for cell in (4.0, 2.0, 1.0)] == [11, 9, 7]
assert [cut["touched", cell] for cell in (4.0, 2.0, 1.0)] == [0, 0, 0]

# %% [markdown]
# A smaller cell doesn't cure the centres: at 1 m still 7 routes of 50 cut a building.
#
# ## The ground isn't flat
#
# Table 1 stands on an open floor: the bottom of the map, which is no obstacle. Real ground has hills, and a map
# without them is as wrong as one without houses. A `Terrain` is a surface of triangles. It comes from a raster of
# heights (`Terrain.from_raster`), from single points with heights (`Terrain.from_points`), or from a file
# (`read_terrain`: ESRI ASCII grid, GeoTIFF). Here two houses of 12 m have a hill of 30 m between them, given as a
# raster with pixels of 5 m:

# %% tags=["nbval-check-output"]
x, y = np.meshgrid(np.arange(-17.5, 140, 5), np.arange(77.5, -20, -5))  # centres of pixels, the first row in the north
raster = 30 * np.exp(-((x - 60) ** 2 + 0.3 * (y - 30) ** 2) / (2 * 18**2))
hill = Terrain.from_raster(raster, bounds=(-20, -20, 140, 80))  # west, south, east, north
houses = [slab(0, 14, 20, 40, height=12.0, name="west"), slab(106, 120, 20, 40, height=12.0, name="east")]
flat = City.from_buildings(houses, cell=2.0, name="Without the hill")
valley = City.from_buildings(houses, cell=2.0, terrain=hill, name="A hill between two houses")
print(f"ground: {valley.ground.shape} columns, {valley.ground.min():.1f} to {valley.ground.max():.1f} m")
print(f"voxels occupied: {flat.occupied.sum():,} without the hill, {valley.occupied.sum():,} with it")
print(f"a point at z = 35 m over the top is {valley.height_above_ground((60, 30, 35)):.1f} m above ground")

# %% [markdown]
# `city.ground` holds the height of the ground at the centre of each column, in the $z$ of the map. All voxels that the
# ground reaches into are occupied, and all below them. So clearance and planners treat it like a wall.
# `city.height_above_ground(points)` says how high a point is above the ground below it.
#
# *Predict first:* we plan from house to house, 8 m high, on both maps (from the centre of a voxel to that of another,
# so at 9 m). What does the first route do?

# %% tags=["nbval-check-output"]
start, goal = (20, 30, 8), (100, 30, 8)
blind = shortcut(astar(flat, start, goal), flat)
seeing = shortcut(astar(valley, start, goal), valley)
limits = {"min_height": 10.0, "max_height": 30.0}  # above ground
legal = shortcut(astar(valley, start, goal, **limits), valley, **limits)
above = {}
for name, route in {"without the hill": blind, "with the hill": seeing, "10 to 30 m above ground": legal}.items():
    cruise = route.points[route.takeoff : len(route.points) - route.landing]  # without take-off and landing
    cruise = replace(route, points=cruise, takeoff=0, landing=0).resample(0.5).points
    above[name] = valley.height_above_ground(cruise)
    print(f"{name}: {route.length:.1f} m, highest z {route.points[:, 2].max():.0f} m, "
          f"above the true ground {above[name].min():+.1f} to {above[name].max():+.1f} m")  # fmt: skip

# %%
assert above["without the hill"].min() == pytest.approx(-20.6, abs=0.05)
assert above["with the hill"].min() == pytest.approx(1.4, abs=0.05)
assert above["10 to 30 m above ground"].min() >= 10
assert above["10 to 30 m above ground"].max() <= 30
assert legal.takeoff > 0 < legal.landing
named = {"10 to 30 m above ground": legal, "with the hill": seeing, "without the hill": blind}
plot.profile(valley, named)

# %% [markdown]
# Each route has its own hill here, since the axis is the distance flown: who flies a longer way meets the top later. A
# vertical climb is a slope of 45°.
#
# The first route is straight, and in truth it is a tunnel, up to 20.6 m below the ground. With the hill in the map the
# UAV flies over it, but the planner takes any free voxel, and so it skims the ground: 1.4 m are left. The clearance in
# the lower panel is less: it counts the steps of the occupied voxels (dotted), which stand above the smooth ground.
# Neighbours want more, and laws have a ceiling, such as 120 m above ground in the European Union. All planners take
# `min_height` and `max_height`. They count from the ground below the UAV, not from the start: the allowed band climbs
# over the hill. Start and goal may lie below `min_height`; then the UAV takes off and lands vertically.
#
# The same in 3D:

# %%
scene.show(valley, named)

# %% [markdown]
# ## A real city
#
# Nobody types corners. Three readers make a `City` from what can be had:
#
# | reader | format | where from |
# |---|---|---|
# | `read_geojson` | outlines with heights, in any reference system | OpenStreetMap exports, open data of cities |
# | `read_cityjson` | models with roofs | national 3D registers, for example of the Netherlands |
# | `read_voxels` | voxel maps `.3dmap` | benchmarks of 3-D path finding |
#
# and `read_city` chooses one by what is in the file. So that this page needs no network, it writes its own file:
# four blocks of the kind that makes up the Eixample in Barcelona, invented but true to scale. They are squares of
# 113 m with cut corners, a courtyard inside, streets of 20 m between them, turned by 45° against north.

# %%
CENTRE = 2.1620, 41.3900  # longitude and latitude [degrees], in Barcelona


def block(column, row, height):
    """A GeoJSON feature: one block with its courtyard."""
    square = shapely.box(-56.5, -56.5, 56.5, 56.5)
    outline = square.buffer(-14).buffer(14, join_style="bevel")  # cuts the corners
    ring = outline.difference(outline.buffer(-28, join_style="mitre"))
    placed = rotate(translate(ring, 133 * column, 133 * row), 45, origin=(0, 0))
    lonlat = shapely.transform(placed, Place(*CENTRE).longitude_latitude)  # from metres east and north
    return {"type": "Feature", "properties": {"height": height}, "geometry": mapping(lonlat)}


heights = {(-0.5, -0.5): 20, (0.5, -0.5): 24, (-0.5, 0.5): 28, (0.5, 0.5): "22 m"}
blocks = {"type": "FeatureCollection", "features": [block(*place, height) for place, height in heights.items()]}
print(json.dumps(blocks)[:220], "…")

# %% [markdown]
# Heights count from the ground. Coordinates without a named system are degrees of longitude and latitude; any other
# system is read with `crs="EPSG:..."`, by its number in the EPSG register, and plain metres with `crs="local"`. The
# reader projects the degrees onto the plane that touches the Earth in the south-west corner of the buildings. There it
# puts $x = y = 0$, with $x$ to the true east and $y$ to the true north.

# %% tags=["nbval-check-output"]
with tempfile.TemporaryDirectory() as folder:
    path = Path(folder) / "blocks.geojson"
    path.write_text(json.dumps(blocks))
    town = read_geojson(path, cell=2.0)
built = sum(volume_of(building) for building in town.buildings)
in_voxels = town.occupied[:, :, 1:].sum() * town.cell**3  # without the ground
print(f"{len(town.buildings)} buildings, {town.shape[0]} × {town.shape[1]} × {town.shape[2]} voxels of {town.cell:g} m")
print(f"lowest layer, from z = {town.origin[2]:g} m on: {town.occupied[:, :, 0].mean():.0%} occupied")
print(f"built volume {built:,.0f} m³, in voxels {in_voxels / built - 1:+.1%}")
print("x = y = 0 lies at longitude {:.4f}°, latitude {:.4f}°".format(*town.reference))

# %%
footprint = 113**2 - 4 * 14**2 / 2 - 57**2  # square, without its corners and its courtyard [m²]
assert built == pytest.approx(footprint * (20 + 24 + 28 + 22), rel=1e-4)  # degrees there and back
assert town.occupied[:, :, 0].all()
assert in_voxels / built - 1 == pytest.approx(0.067, abs=5e-4)
assert town.clearance[:, :, town.cell_of((0, 0, 11))[2]].max() == 11.0
plot.section(town, 11.0, label="clearance [m]; yellow: the ground, 11 m below, is nearest")

# %% [markdown]
# The ground is solid in every city that was read from a file. This file says nothing about it, so the reader takes it
# as level at $z = 0$. The map begins one layer of voxels deeper, and that layer is occupied everywhere. So clearance
# counts the ground, too: 11 m above it no place has more than 11 m. The voxels hold 6.7 % more than the blocks, since
# files are read by touch.
#
# The courtyards are there. A flight at 11 m from one to another has to climb over the roofs. A\* with 3.5 m of
# clearance, then the straight lines of `shortcut` ([05 A*](05_astar.ipynb) explains both):

# %% tags=["nbval-check-output"]
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
# ### Where on Earth?
#
# A UAV flies by longitude and latitude. The town knows where its origin lies, so it can tell for every waypoint:

# %% tags=["nbval-check-output"]
on_earth = town.to_geographic(straight.points)
for point, (longitude, latitude, height) in zip(straight.points, on_earth, strict=True):
    print(f"({', '.join(f'{part:5.1f}' for part in point)}) m: {longitude:.6f}°, {latitude:.6f}°, {height:.1f} m")
back = town.from_geographic(on_earth)
print(f"there and back: off by less than 1 mm: {np.abs(back - straight.points).max() < 1e-3}")

# %%
assert np.abs(back - straight.points).max() < 1e-3

# %% [markdown]
# Six digits of a degree are about a decimetre. The third number is the height as the file counts it: here in metres
# above the ground.
#
# ## A dirty file
#
# Our blocks were clean. Files of real cities are not: people have typed them, in their own units, and left things out.
# Here are eight features as they occur in exports of OpenStreetMap:


# %%
def feature(name, corners, **properties):
    """A GeoJSON feature with corners in metres from the centre; `building` unless it says otherwise."""
    ring = Place(*CENTRE).longitude_latitude([*corners, corners[0]]).tolist()
    properties = {"name": name, "building": "yes"} | {key.replace("__", ":"): it for key, it in properties.items()}
    return {"type": "Feature", "properties": properties, "geometry": {"type": "Polygon", "coordinates": [ring]}}


def square(west, south, size=20):
    return [(west, south), (west + size, south), (west + size, south + size), (west, south + size)]


# %% tags=["nbval-check-output"]
features = [
    feature("feet", square(0, 0), height="40 ft"),
    feature("comma", square(40, 0), height="12,5 m"),
    feature("storeys", square(80, 0), building__levels="4"),
    feature("silent", square(120, 0)),
    feature("bow tie", [(0, 50), (20, 70), (20, 50), (0, 70)], height=9),
    feature("hall", square(40, 50), height=10),
    feature("tower", square(44, 54, 8), building__part="yes", height=30, building="no"),
    feature("lake", square(80, 50, 30), building="no", natural="water"),
]
for one in features:
    print(one["properties"])

# %% [markdown]
# The outline of "bow tie" crosses itself, so it has no inside that everybody would agree on. "tower" is a *part*: it
# stands within the outline of "hall" and says more about it. "silent" has neither a height nor storeys.
#
# *Predict first:* how many of the eight become obstacles? What is assumed, and what would you assume?

# %% tags=["nbval-check-output"]
folder = tempfile.TemporaryDirectory()
dirty = Path(folder.name) / "dirty.geojson"
dirty.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
try:
    read_geojson(dirty, cell=2.0)
except ValueError as error:
    print(error)

# %% [markdown]
# The reader doesn't invent a height: an obstacle whose height is wrong is worse than a question. You answer it with
# `default_height`. Take it high: too high a guess costs a detour, too low a guess costs the UAV.

# %% tags=["nbval-check-output"]
with warnings.catch_warnings(record=True) as said:
    warnings.simplefilter("always")
    quarter = read_geojson(dirty, cell=2.0, default_height=15.0)
print(f"{len(said)} warning: {said[0].message}\n")
print(quarter.source)
print("\ntops:", ", ".join(f"{b.name} {b.bounds[1, 2]:.1f} m" for b in quarter.buildings))

# %%
tops = {building.name: building.bounds[1, 2] for building in quarter.buildings}
assert [round(top, 3) for top in tops.values()] == [12.192, 12.5, 12.0, 15.0, 9.0, 10.0, 30.0]
assert len(said) == 1
assert len(quarter.buildings) == 7
bow_tie = next(building for building in quarter.buildings if building.name == "bow tie")
assert volume_of(bow_tie) / 9 == pytest.approx(200, rel=1e-3)

# %% [markdown]
# Seven of eight. 40 ft became 12.2 m, and the comma was read as a decimal point. `city.source` says what became of the
# rest, a line for each kind of case. "Derived" is what follows from the file by a rule: storeys of 3 m
# (`storey_height`), the hall's outline without its tower, the lake that is no obstacle. "Mended" is the bow tie: its
# two triangles of 100 m² each are kept. "Assumed" is what nobody knows, and only that makes a warning: the height that
# we gave. **Read this report before you plan.**
#
# ### Where one may not fly
#
# Some places are free of walls and yet closed: a playground, an airfield, a lake with swans. A `NoFlyZone` is an
# outline with a lower and an upper limit above ground. Planners stay out of it. It is no obstacle: nothing can hit it,
# and clearance doesn't count it. We close the lake up to 60 m:

# %% tags=["nbval-check-output"]
south_west = quarter.from_geographic([*Place(*CENTRE).longitude_latitude((80, 50)), 0.0])[:2]
lake = NoFlyZone(square(*south_west, 30), upper=60.0, name="lake")
closed = replace(quarter, no_fly=[lake])
start, goal = (73, 65, 9), (117, 65, 9)
ways = {name: shortcut(astar(one, start, goal), one) for name, one in {"open": quarter, "lake closed": closed}.items()}
for name, way in ways.items():
    over = sum(shapely.contains_xy(lake.polygon, *way.resample(0.1).points[:, :2].T)) * 0.1
    print(f"{name}: {way.length:.1f} m, {over:.0f} m of it over the lake, highest {way.points[:, 2].max():.0f} m")
print(f"the same clearance: {np.array_equal(closed.clearance, quarter.clearance)}")

# %%
assert np.array_equal(closed.clearance, quarter.clearance)
assert not lake.polygon.buffer(-0.01).intersects(shapely.LineString(ways["lake closed"].points[:, :2]))
folder.cleanup()
plot.section(closed, 9.0, None, ways)

# %% [markdown]
# ### Roofs and voxels from files
#
# A CityJSON model knows every face of a roof. Its coordinates are whole numbers, which `transform` turns into the
# metres of the reference system that its `metadata` name. Here is the smallest one that makes sense, a house of
# 12 × 8 m with a gable roof, near Delft. EPSG:7415 is the Dutch system; its heights are above the sea. The reader
# fills what lies below the faces and takes the ground from the foot of the house.

# %%
corners = [(x, y, z) for z in (0, 6000) for x, y in ((0, 0), (12000, 0), (12000, 8000), (0, 8000))]
corners += [(0, 4000, 9000), (12000, 4000, 9000)]  # the ridge
faces = [(3, 2, 1, 0), (0, 1, 5, 4), (2, 3, 7, 6), (1, 2, 6, 9, 5), (3, 0, 4, 8, 7), (4, 5, 9, 8), (6, 7, 8, 9)]
solid = {"type": "Solid", "lod": "2.2", "boundaries": [[[face] for face in faces]]}
model = {
    "type": "CityJSON",
    "version": "2.0",
    "transform": {"scale": [0.001, 0.001, 0.001], "translate": [85000, 447000, 1.5]},
    "metadata": {"referenceSystem": "https://www.opengis.net/def/crs/EPSG/0/7415"},
    "CityObjects": {"house": {"type": "Building", "geometry": [solid]}},
    "vertices": corners,
}

# %% tags=["nbval-check-output"]
with tempfile.TemporaryDirectory() as folder:
    path = Path(folder) / "house.city.json"
    path.write_text(json.dumps(model))
    house = read_cityjson(path, cell=0.5, margin=5.0)
print(house.source)
volume = volume_of(house.buildings[0])
print(f"{house.buildings[0].name}: {volume:.0f} m³; by hand {12 * 8 * 6 + 12 * 8 * 3 / 2:.0f} m³")
print("x = y = z = 0 lies at {:.5f}°, {:.5f}°, {:.1f} m above the sea".format(*house.reference))

# %%
assert volume == pytest.approx(720, rel=1e-3)
assert house.reference.height == 1.5
scene.show(house, height=360)

# %% [markdown]
# A voxel map holds no buildings at all, only the blocked voxels, one per line and counted from 0. Table 1's city at
# 4 m, written and read back:

# %% tags=["nbval-check-output"]
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
# **Put the path of a file into the next cell and run it.** GeoJSON with heights or storeys (add `height="..."` to
# `read_city` if the property isn't called `height`), CityJSON, or `.3dmap`. What can't be read is refused with its
# place in the file and what to do about it. Begin with a large cell: half of it makes eight times the voxels (Eq. 7
# above). For hills add `terrain="heights.asc"`, a GeoTIFF, or a `Terrain`. Then plan through it: `astar(my_city, start,
# goal, min_clearance=3.5)`, with two points within `my_city.bounds`.

# %%
MY_CITY = None  # put a path here, as in "downloads/delft.city.json"

my_city = None if MY_CITY is None else read_city(MY_CITY, cell=2.0)
if my_city is None:
    print("no file given: set MY_CITY and run this cell again")
else:
    size = my_city.bounds[1] - my_city.bounds[0]
    print(f"{my_city.name}: {len(my_city.buildings)} buildings, {my_city.occupied.size:,} voxels")
    print(f"{size[0]:.0f} × {size[1]:.0f} × {size[2]:.0f} m, {my_city.occupied.mean():.1%} solid")
    print(my_city.source)
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
# | Fig. 5 | 26 nodes watch the zone | as a price nearly: they miss 0.8, 1.0, 1.4 % of it and add 4.7, 4.0, 6.8 % |
# | Fig. 5 | a safe distance is kept | as a guarantee no: 2.55, 3.54, 3.81 m are accepted |
# | Fig. 5 | no limit to the radius | walls thinner than $r$ cells are looked through; at 6 m the spire, too |
# | conclusion | a finer map takes much more work | 8 times the voxels for half the cell |
# | not said | which voxels are occupied | by centres thin walls vanish; by touch alleys close, houses grow |
#
# The paper prints no count of voxels and doesn't say from where a distance is measured. Our reading, from the
# centre of the UAV to the surface, is the one in which REPARE's Table 4, its Eq. 7 and the ring agree.

# %% tags=["nbval-check-output"]
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
# Next: [05 A*](05_astar.ipynb) finds the cheapest way through these voxels, and shows what REPARE's Eqs 11-13 do with
# the ring's penalty.
