# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 07 REPARE: A* with a force in its price
#
# A* finds the shortest way and scrapes along walls ([05 A*](05_astar.ipynb)). A potential field keeps away from walls
# and gets stuck in front of them ([06 potential field](06_potential_field.ipynb)). REPARE (Sensors 2022, 22, 2151,
# [doi:10.3390/s22062151](https://doi.org/10.3390/s22062151)) wants both virtues: the open list of the one, the forces
# of the other, and a distance to keep that follows wind and load. Its pseudo-code computes a resultant force and then
# never uses it. So the question of this notebook is: **how may a force enter the price of a route?** We repair the
# algorithm, try three answers, two of which are wrong, repeat the paper's Tables 2 to 4 and its figures, and then ask
# what the price of a metre near a wall *should* be. ("Eq. 3" is an equation of this notebook, "REPARE Eq. 16" one of
# the paper's.)
#
# *Run All* (in the menu **Run**) brings the 3D scenes and the sliders to life.

# %%
import math
from dataclasses import replace

import numpy as np
from matplotlib.colors import LogNorm
from scipy.optimize import linprog

from uavlab import offsets, planners, plot, resilience, scene
from uavlab.city import City, table1_city
from uavlab.planners import astar, flight_conditions, hazard_astar, potential_field, repare, repare_price, shortcut
from uavlab.resilience import DISTURBANCES, LOADS, ConditionCheck, Monitor, resilience_level, safe_distance
from uavlab.route import Route
from uavlab.vehicle import GRAVITY, LIGHT_QUADROTOR
from uavlab.weather import Wind, rain_force

# %%
city = table1_city()
notch, middle = (90, 18, 30), (50, 44, 30)  # REPARE Fig. 12
print(f"{city.name}: {city.occupied.sum():,} of {city.occupied.size:,} voxels of 1 m are occupied")

# %% [markdown]
# ## Algorithm 1, line by line
#
# The paper's only description of the search is its Algorithm 1. Can it be run? Here is what it says, in our words.
#
# | line | printed | missing or wrong | what we do |
# |---|---|---|---|
# | 4 | choose ξ for the disturbance, once | line 13 measures it again and again | plan anew when it changes |
# | 7–9 | stop when the open list is empty | nothing is ever taken out of it | take out the node of least $g + h$ |
# | 11, 26 | put neighbours on the open list, twice | no best $g$, no parent: no route | keep and update both |
# | 12, 14 | does the outer ring meet an obstacle? | the inner ring isn't tested: through walls | test each move's box |
# | 15–17, 20 | the resultant force $F_\text{fin}$ | never used; no directions | vectors, in the weight ω: below |
# | 21 | total cost of the inner ring's nodes | a factor on the whole way so far | price per metre (05, Eqs 8, 9) |
# | 22 | put the node on the closed list | nobody reads it: nodes come again for ever | again only if it got cheaper |
# | 27 | return the nodes planned | also when there is no way: fails silently | `reached=False` and a reason |
#
# With all of that repaired it is A* with a price. What is left to decide is the price.

# %% tags=["nbval-check-output"]
occupied = np.zeros((20, 20, 12), bool)
occupied[10] = True
cut = City(occupied, name="A wall without a door")
for answer in (
    repare(cut, (4.5, 10.5, 6.5), (16.5, 10.5, 6.5)),
    repare(city, notch, middle, load="heavy", disturbance="heavy"),
):
    print(answer.reached, "-", answer.reason)
try:
    repare(city, (71.5, 33.0, 30.5), middle)
except ValueError as error:
    print(error)

# %% [markdown]
# A goal behind a wall and a load too heavy for the wind are answers. A start within the distance to keep is a wrong
# question: it is refused, and the message says which point would do.
#
# ## How a force may enter the cost
#
# Inside the distance $D_\text{min}$ a wall pushes with (REPARE Eq. 15, as a vector, $R = D_\text{min}$)
#
# $$ \mathbf F_\text{rep} = k_\text{rep}\left(\frac1D - \frac1{D_\text{min}}\right)\frac1{D^2}\,\mathbf n,
#    \qquad k_\text{rep} = \tfrac14 D_\text{min}^3, \tag{1} $$
#
# with $\mathbf n$ away from it. The goal pulls with a force of constant size, $F_\text{tra} = 1$, which makes all
# forces plain numbers. The wind pushes with $\mathbf F_\text{dist}$: the drag of the gusts over the thrust that is
# left against them. REPARE Eq. 16 adds all of them up. And then?
#
# ### Way 1: the force does work
#
# The first idea is from mechanics. A step $\Delta\mathbf x$ that the force favours should be cheap, so let it cost
# $-\mathbf F\cdot\Delta\mathbf x$. But the force is minus the gradient of a potential, and then the cost of a route is
#
# $$ -\int \mathbf F\cdot d\mathbf x = U(\text{goal}) - U(\text{start}), \tag{2} $$
#
# **the same for every route.** Along the way that scrapes and the way that keeps 3.5 m:

# %% tags=["nbval-check-output"]
for route in (astar(city, notch, middle), repare(city, notch, middle)):
    fine = route.resample(0.02)
    steps = np.diff(fine.points, axis=0)
    pull, push, _ = planners.potential_forces(city, fine.points[:-1] + steps / 2, route.points[-1])
    by_goal, by_walls = -(pull * steps).sum(), -(push * steps).sum()
    print(f"{route.planner:<6} {route.length:.1f} m, {route.clearance(city)} m from walls: "
          f"cost {by_goal:.2f} by the goal's pull, {abs(by_walls):.2f} by the walls' push")  # fmt: skip
    assert math.isclose(by_goal, -np.linalg.norm(route.points[-1] - route.points[0]), abs_tol=1e-3)
    assert abs(by_walls) < 1e-3

# %% [markdown]
# What the walls charge on the way in they refund on the way out, and the pull of the goal only measures the straight
# distance. The cost is also negative. A* needs prices of at least 0: with a negative one, flying in circles pays.
#
# One may rescue the idea by adding the length and cutting off what is below 0. A* charges places, not moves, so let
# the move point to the goal, along the unit vector $\mathbf t$:
#
# $$ p_1 = \max\bigl(0,\; 1 - (\mathbf F_\text{rep} + \mathbf F_\text{dist})\cdot\mathbf t\bigr). \tag{3} $$
#
# ### Way 2: the size of the sum
#
# The text around REPARE Eq. 16 says that the *size* of the resultant decides. So let it scale the weight
# $\omega = \omega_0 F$ of the zone, $\omega_0 = 2$:
#
# $$ p_2 = 1 + \omega_0\,\frac{|\mathbf F_\text{rep} + \mathbf F_\text{dist}|}{F_\text{tra}}\, O_\text{risk}. \tag{4} $$
#
# ### Way 3: ours
#
# Three reasons make a metre near a wall worse: the wall is near, gusts push *towards* it, and a heavy load leaves
# little thrust. Reasons add up and must not cancel. So, with the load ratio $\lambda$ (weight over thrust) and
# REPARE's weighting factors $\vartheta_F$ and $\vartheta_G$ (both 1 here),
#
# $$ p_3 = 1 + \omega\, O_\text{risk}, \qquad
#    \omega = \omega_0\,\frac{1 + |\mathbf F_\text{rep}| + \vartheta_F \max(0, -\mathbf F_\text{dist}\cdot\mathbf n)
#    + \vartheta_G\, \lambda}{F_\text{tra}}. \tag{5} $$
#
# `repare_price` is Eq. 5. The other two, on any city:


# %%
def forces_near(town, now):
    """Push of the nearest wall (nx, ny, nz, 3) and of the gusts (3,), for known wind."""
    size = planners.repulsion(np.maximum(town.clearance, town.cell / 2), now.safe_distance**3 / 4, now.safe_distance)
    return size[..., None] * town.wall_normal, now.push * np.array(now.wind) / np.linalg.norm(now.wind)


def work_price(town, now, goal):
    """Eq. 3: a metre towards the goal, less what the forces do for it; and the share of voxels where it is negative."""
    walls, gusts = forces_near(town, now)
    way = np.asarray(goal) - town.center_of(np.moveaxis(np.indices(town.shape), 0, -1))
    way /= np.maximum(np.linalg.norm(way, axis=-1, keepdims=True), 1e-9)
    price = 1 - ((walls + gusts) * way).sum(axis=-1)
    return np.maximum(price, 0.0), np.mean(price[~town.occupied] < 0)


def size_price(town, now):
    """Eq. 4: the size of the sum of the forces, in the zone."""
    walls, gusts = forces_near(town, now)
    return planners.penalty_zone(town, now.safe_distance, penalty=2.0 * np.linalg.norm(walls + gusts, axis=-1))


# %% [markdown]
# An endless wall, and a UAV with a light load that flies along it. The wind blows with 9 m/s towards the wall, along
# it (with the flight), or away from it. Table 4 says $D_\text{min} = 5.5$ m.

# %% tags=["nbval-check-output"]
occupied = np.zeros((14, 3, 3), bool)
occupied[:2] = True
wall = City(occupied, name="A wall")
winds = {"towards the wall": (-9.0, 0.0), "along it": (0.0, 9.0), "away from it": (9.0, 0.0)}
along = {}
for name, wind in winds.items():
    now = flight_conditions("light", Wind(wind))
    priced = work_price(wall, now, (8.5, 1e9, 1.5))[0], size_price(wall, now), repare_price(wall, now)
    along[name] = [price[2:, 1, 1] for price in priced]
distance = wall.clearance[2:, 1, 1]
print(f"D_min = {now.safe_distance} m, gusts push with {now.push:.2f} of the thrust left, λ = {now.load_ratio:.2f}")
print("price of a metre at", *(f"{d:>10.1f} m" for d in distance[:6]))
for way in range(3):
    for name, prices in along.items():
        print(f"way {way + 1}, {name:<16}", *(f"{p:>8.2f}" for p in prices[way][:6]))
assert np.allclose(along["towards the wall"][0], 1.0)
assert along["towards the wall"][1][3] < 1.2 < along["away from it"][1][3]
assert (along["towards the wall"][2] >= along["away from it"][2]).all()

# %% tags=["figure"]
figure, panels = plot.new_panels(1, 3, share="y", width=11.4)
titles = "way 1: work of the force (Eq. 3)", "way 2: size of the sum (Eq. 4)", "way 3: reasons add up (Eq. 5)"
for way, (axes, title) in enumerate(zip(panels, titles, strict=True)):
    winds = {f"wind {name}": prices[way] for name, prices in along.items()}
    plot.lines(distance, winds, "distance to the wall [m]", "price of a metre along the wall [1]", steps=True, log="y",
               places={"D_min": 5.5}, x_range=(0, 9), y_range=(0.3, 1000), title=title, axes=axes)  # fmt: skip
figure

# %% [markdown]
# *Way 1.* The wall pushes sideways and the UAV flies along: no work. The price along the wall is that far from any wall,
# at every distance: free flight along a wall, and only wind from behind makes a difference.
#
# *Way 2.* At 3.5 m the price falls to 1.12 just when the wind blows *towards* the wall: there push of the wall and
# push of the wind cancel, and a UAV would rather fly at 3.5 m than at 5 m. Wind *away* from the wall makes it more expensive.
# Both are upside down.
#
# *Way 3* rises towards the wall in every wind, and most in the wind that blows towards it.
#
# ### On routes
#
# Forty *blocked* pairs of Table 1's city, for which plain A* comes within half a metre of a wall. The wind blows with
# 9 m/s to the east. What happens on a route is measured in two ways. Rice's formula (notebook 02) says how often an
# offset crosses a margin outwards, so the number of wall touches to be expected on a flight at speed $v$ is
#
# $$ N = \int \nu(u)\,\frac{ds}{v}, \qquad \nu(u) = \frac{\omega_n}{2\pi}\, e^{-u^2/2\sigma^2}, \qquad
#    u = D(\mathbf x + \boldsymbol\mu) - r, \tag{6} $$
#
# with body radius $r = 0.5$ m, $v = 5$ m/s, $\omega_n = 1$ rad/s, and $3\sigma = D_\text{min} - r$ (Pauta, REPARE Eq.
# 7). And for each route 200 flights with offsets drawn by `offset_paths`, towards the wall that is nearest.


# %%
def margins(route, mean=(0.0, 0.0, 0.0), radius=0.5):
    """Room to the nearest wall in each voxel along the route, and metres flown in it."""
    index, metres = city.voxels_along(route.points)
    away = city.distance(city.center_of(index) + mean, exact_within=20.0)
    return np.maximum(away - radius, 0.0), metres


def touches(route, sigma, speed=5.0, **where):
    """Eq. 6: wall touches to be expected on a flight."""
    room, metres = margins(route, **where)
    return float(offsets.crossing_rate(room, sigma) @ metres / speed)


def crashes(route, sigma, rng, speed=5.0, count=200, **where):
    """Share of drawn flights that touch a wall."""
    room, metres = margins(route, **where)
    clock, pushed = offsets.offset_paths(sigma, route.length / speed, rng, count=count, step=0.1)
    at = np.minimum(np.searchsorted(np.cumsum(metres), speed * clock), len(room) - 1)
    return np.mean((pushed > room[at]).any(axis=1))


# %% tags=["nbval-check-output"]
drawn = city.random_pairs(150, 8, apart=40, min_clearance=8.0)
blocked = [pair for pair in drawn if astar(city, *pair).clearance(city) <= 0.5][:40]
now = flight_conditions("light", Wind((9.0, 0.0)))
sigma = (now.safe_distance - 0.5) / 3
prices = {"plain A*": None, "way 2": size_price(city, now), "way 3": repare_price(city, now)}
routes = {name: [astar(city, *pair, price=price) for pair in blocked] for name, price in prices.items()}
rng = np.random.default_rng(8)
print("            length   least clearance   below D_min   touches per 1000 flights: Rice, drawn")
table = {}
for name, flown in routes.items():
    least = np.array([route.clearance(city) for route in flown])
    expected = 1000 * np.mean([touches(route, sigma) for route in flown])
    seen = 1000 * np.mean([crashes(route, sigma, rng) for route in flown])
    table[name] = np.mean([route.length for route in flown]), least.min(), np.sum(least < 5.5), expected, seen
    print("{:<9} {:6.1f} m {:11.1f} m {:10d} of 40 {:20.0f} {:11.0f}".format(name, *table[name]))
assert table["way 2"][3] > 1.2 * table["way 3"][3]

# %% [markdown]
# Way 2 lets 7 of 40 routes into the zone, down to 3.5 m, where its price has its dip. It gains 2 m of length and pays
# with a third more touches. (Two notes. On plain A* one flight touches more than once, so the share of flights is
# below the expected number. Elsewhere it is a little above: Eq. 6 takes the margin for constant, and a UAV that turns
# towards a wall comes nearer with up to 5 m/s.)
#
# Way 1 gets the first eight pairs only; it is slow, since with a price of 0 somewhere there is no estimate left.

# %% tags=["nbval-check-output"]
worked = [work_price(city, now, goal) for _, goal in blocked[:8]]
routes["way 1"] = [astar(city, *pair, price=price) for pair, (price, _) in zip(blocked, worked, strict=False)]
for name in ("plain A*", "way 1"):
    expected = np.mean([touches(route, sigma) for route in routes[name][:8]])
    print(
        f"{name:<9} {np.mean([r.length for r in routes[name][:8]]):6.1f} m, {expected:.1f} touches a flight (8 pairs)"
    )
print(f"way 1 is cut off at 0 in {np.mean([share for _, share in worked]):.1%} of the free voxels")
assert expected > 3

# %%
first = {"A*": routes["plain A*"][0], "way 1": routes["way 1"][0], "REPARE, way 3": routes["way 3"][0]}
scene.show(city, first)

# %% [markdown]
# Where the wall lies behind the UAV its push helps, the price is cut off at 0, and metres there are free. So way 1
# tours all the walls that it can find. From here on the price is way 3.
#
# ## Wider towards the wind
#
# A steady wind leaves a mean offset $\boldsymbol\mu$ that the autopilot doesn't take out. Then $3\sigma$ has to be
# counted from where the UAV really is (notebook 02, Eq. 14), and on the way there. The zone is where
#
# $$ \min_{0 \le s \le 1} D(\mathbf x + s\,\boldsymbol\mu) < r + 3\sigma. \tag{7} $$
#
# Before a flat wall that widens it by $\max(0, -\boldsymbol\mu\cdot\mathbf n)$; between two walls both count.
#
# The zone in a wind to the east that holds the UAV 2 m off, 30 m above the ground. West of each building it is wider:


# %%
mean = (2.0, 0.0, 0.0)
mild = Wind((6.0, 0.0))
keep = safe_distance("light", mild)
pair = (2.5, 35.5, 30.5), (60.5, 50.5, 30.5)
straight, widened = (
    repare(city, *pair, disturbance=mild),
    repare(city, *pair, disturbance=mild, mean_offset=mean),
)

# %% tags=["figure"]
wider = city.clearance_along(mean, at_most=10.0)[:, :, 30] < keep
zones = {"added for the wind": wider, "nearer than 3.5 m": (city.clearance < keep)[:, :, 30]}
zones["building"] = city.occupied[:, :, 30]
both_zones = {"route, 3.5 m all around": straight.points[:, :2], "route, wider for the wind": widened.points[:, :2]}
ZONE_ROUTES = {"route, 3.5 m all around": plot.GREEN, "route, wider for the wind": plot.BLACK}
ends = {"start": pair[0][:2], "goal": pair[1][:2]}
plot.area_map(city, zones, paths=both_zones, points=ends, notes={"wind, mean\noffset 2 m →": (12, 62)},
              title="Zones in wind to the east, 30.5 m above the ground",
              colors={"added for the wind": plot.SKY, "nearer than 3.5 m": plot.YELLOW} | ZONE_ROUTES)  # fmt: skip

# %% tags=["nbval-check-output"]
seen = {}
for push in (0.0, 1.0, 2.0):
    mean = (push, 0.0, 0.0)
    print(f"mean offset {push:g} m:", end="")
    for name, counted in (("3.5 m all around", (0.0, 0.0, 0.0)), ("widened", mean)):
        flown = [repare(city, *pair, disturbance=mild, mean_offset=counted) for pair in blocked]
        seen[push, name] = 1000 * np.mean([touches(route, 1.0, mean=mean) for route in flown])
        print(f"  {name} {np.mean([r.length for r in flown]):.1f} m, {seen[push, name]:.1f} touches per 1000", end=";")
    print()
assert seen[2.0, "3.5 m all around"] > 12 * seen[0.0, "widened"] > 12 * seen[2.0, "widened"]

# %% [markdown]
# Without the widening a mean offset of 1 m makes nearly four times as many touches, one of 2 m fifteen times. With it
# there are a quarter fewer than without any wind, for a third of a metre of length: what is lost on the windward sides
# is made up for, and on the lee sides the wind holds the UAV off.
#
# ## Table 2: longer than A*, shorter than the field
#
# REPARE's Table 2 compares mean length and time over random pairs, relative to the potential field. The lengths can be
# met only with a field that moves on the same lattice of 26 moves ([notebook 05](06_potential_field.ipynb) tries six
# fields). Here it is the default of `potential_field`: every occupied voxel within 5 m pushes. A thousand pairs, 40 m
# or more apart, both ends 4.5 m or more from walls. Intervals are 95 %, by drawing pairs again (bootstrap). Each figure
# is a ratio of mean lengths. Pairs on which the field doesn't arrive can't be compared with it; between A* and REPARE
# all thousand count.


# %%
def ratio(ones, others, seed=8):
    """Mean of the one over the mean of the other, with its 95 % interval over pairs drawn anew."""
    ones, others = np.asarray(ones), np.asarray(others)
    again = np.random.default_rng(seed).integers(len(ones), size=(2000, len(ones)))
    low, high = np.percentile(ones[again].mean(axis=1) / others[again].mean(axis=1), [2.5, 97.5])
    return ones.mean() / others.mean(), low, high


thousand = city.random_pairs(1000, 8, apart=40, min_clearance=4.5)
compared = {
    "A*": [astar(city, *pair) for pair in thousand],
    "potential field": [potential_field(city, *pair) for pair in thousand],
    "REPARE": [repare(city, *pair) for pair in thousand],
    "REPARE, 4.5 m": [repare(city, *pair, load="heavy") for pair in thousand],
}
arrives = np.array([route.reached for route in compared["potential field"]])
length = {name: np.array([route.length for route in flown]) for name, flown in compared.items()}

# %% tags=["nbval-check-output"]
print(f"the potential field doesn't arrive on {np.mean(~arrives):.1%} of the pairs")
searched = ("A*", "REPARE", "REPARE, 4.5 m")
table2 = {name: ratio(length[name][arrives], length["potential field"][arrives]) for name in searched}
table2 |= {f"{name}, over A*": ratio(length[name], length["A*"]) for name in searched[1:]}
for name, printed in zip(table2, (0.952, 0.973, 0.973, 0.973 / 0.952, 0.973 / 0.952), strict=True):
    print(f"{name:<22} {table2[name][0]:.3f} [{table2[name][1]:.3f}, {table2[name][2]:.3f}], paper {printed:.3f}")
expanded = {name: sum(r.info["expanded"] for r in compared[name]) for name in ("A*", "REPARE")}
print(f"expansions, REPARE/A*: {expanded['REPARE'] / expanded['A*']:.2f}")
assert length["A*"].mean() < length["REPARE"].mean()
assert table2["REPARE"][2] < 1
assert abs(table2["A*"][0] - 0.952) < 0.01
assert abs(table2["REPARE, 4.5 m"][0] - 0.973) < 0.01

# %% [markdown]
# Notebook 06 has slightly other figures: other pairs (seed 7), the mean of the pairs' ratios, and a ring with a fixed
# price for REPARE. Both statistics, on both sets of pairs, with REPARE at 3.5 m:

# %% tags=["nbval-check-output"]
others = city.random_pairs(1000, 7, apart=40, min_clearance=4.5)
planned = {8: [compared[name] for name in ("A*", "REPARE", "potential field")]}
planned[7] = [[planner(city, *pair) for pair in others] for planner in (astar, repare, potential_field)]
for seed, flown in planned.items():
    ok = np.array([route.reached for route in flown[2]])
    a, r, f = (np.array([route.length for route in routes_of]) for routes_of in flown)
    of_means = a[ok].mean() / f[ok].mean(), r[ok].mean() / f[ok].mean(), r.mean() / a.mean()
    of_pairs = (a / f)[ok].mean(), (r / f)[ok].mean(), (r / a).mean()
    for kind, values in (("ratio of means", of_means), ("mean of ratios", of_pairs)):
        print(f"seed {seed}, {kind}: A* {values[0]:.3f}, REPARE {values[1]:.3f}, REPARE/A* {values[2]:.3f}")
    assert of_means[0] < of_pairs[0] < of_means[0] + 0.011

# %% [markdown]
# The statistic makes the difference, not the pairs. And the distance to keep:

# %% tags=["nbval-check-output"]
roomy = city.random_pairs(300, 8, apart=40, min_clearance=5.5)
plain = [astar(city, *pair).length for pair in roomy]
for load, disturbance in (("light", "none"), ("light", "mild"), ("heavy", "mild"), ("light", "heavy")):
    flown = [repare(city, *pair, load=load, disturbance=disturbance) for pair in roomy]
    value, low, high = ratio([route.length for route in flown], plain)
    keep = flown[0].info["safe_distance"]
    print(f"{load} load, {disturbance:<4} disturbance, D_min = {keep} m: REPARE/A* {value:.3f} [{low:.3f}, {high:.3f}]")

# %%
took = {name: sum(route.info["elapsed"] for route in flown) for name, flown in compared.items()}
took["A*, straight estimate"] = sum(astar(city, *pair, heuristic="euclidean").info["elapsed"] for pair in thousand)
for name, seconds in took.items():
    print(f"{name:<22} {seconds / took['potential field']:.2f} of the potential field's time")

# %% [markdown]
# **Length.** A* is at 0.950 of the potential field, the paper's 0.952 lies inside of the interval. The paper doesn't
# say which $D_\text{min}$ its table was made with, and for REPARE that decides. With 3.5 m ours is 1.4 % longer than
# A*, with 4.5 m 2.2 %, as in the paper. Over the field that is 0.963, a hundredth below the paper's 0.973: pairs with
# a long way round a building drop out of this column, since the field is trapped there. The order, A* before REPARE
# before the field, holds on the lattice. (A field that may fly in any direction is shorter than both: notebook 06.)
#
# **Time.** We print it and claim nothing. A* with the octile estimate takes a fraction of what it takes with the
# straight distance, at the same cost; a field that sums over voxels in a slow loop is slow, one that looks up a
# distance is fast. "Shorter running time than the potential field" is a statement about a program, not about an
# algorithm. What counts on every machine: REPARE expands 1.40 times as many nodes as A*.
#
# ## The same way there and back
#
# With `as_printed=True` the planner is the paper's: the cost of REPARE Eq. 13, a fixed $\omega$, a ring of 26 points,
# the straight distance as the estimate. Notebook 05 shows why its routes depend on the direction. On the first hundred
# of the thousand pairs:


# %% tags=["nbval-check-output"]
def there_and_back(**options):
    """REPARE on the hundred pairs in both directions."""
    return [(repare(city, one, other, **options), repare(city, other, one, **options)) for one, other in thousand[:100]]


for omega in (0.1, 0.2):
    printed, ours = there_and_back(penalty=omega, as_printed=True), there_and_back(penalty=omega)
    gap = np.array([abs(there.length - back.length) for there, back in printed])
    differ = gap > 1e-6
    print(f"ω₀ = {omega}, as printed: {differ.sum()} of 100 pairs differ, by {gap[differ].mean():.1f} m on average,",
          f"{gap.max():.1f} m at most")  # fmt: skip
    largest = max(abs(there.cost - back.cost) for there, back in ours)
    print(f"ω₀ = {omega}, additive: the costs of all pairs agree to 1e-9 m: {largest < 1e-9}")
    assert largest < 1e-9

# %% [markdown]
# On a third of the pairs the printed cost flies another way back. (Notebook 05 has 44 and 40 of its hundred pairs, by
# up to 5.4 m: the count depends on the pairs, the fault doesn't.)
#
# ## Table 3: how much resilience
#
# Before the flight REPARE's Table 3 says how much of the resilience system to switch on:

# %% tags=["nbval-check-output"]
print(f"{'':<10}", *(f"{load:<13}" for load in LOADS))
for disturbance in DISTURBANCES:
    print(f"{disturbance:<10}", *(f"{resilience_level(load, disturbance):<13}" for load in LOADS))

# %% [markdown]
# Sixteen entries look like sixteen decisions. They aren't: the table is an **additive score**. Give points to each
# load and to each disturbance, add the two, and cut the sum at four thresholds. Whether such points exist is a
# question of linear inequalities: in each entry the sum must reach its level's threshold and stay a point below the
# next one. (Which points? That is an exercise.)


# %%
def is_additive(level_of):
    """Whether points for loads and disturbances and four thresholds give these levels."""
    above, bounds = [], []
    for row, disturbance in enumerate(DISTURBANCES):
        for column, load in enumerate(LOADS):
            level = resilience.LEVELS.index(level_of(load, disturbance))
            points = np.zeros(12)  # of four loads, four disturbances; then the four thresholds
            points[[column, 4 + row]] = 1
            for sign, threshold, bound in ((-1, level - 1, 0), (1, level, -1)):
                if 0 <= threshold < 4:
                    above.append(sign * (points - np.eye(12)[8 + threshold]))
                    bounds.append(bound)
    return linprog(np.ones(12), A_ub=above, b_ub=bounds).status == 0


# %% tags=["nbval-check-output"]
turned = {("light", "mild"): "advanced", ("light", "heavy"): "lower"}
print("Table 3:", is_additive(resilience_level))
print("with two entries changed:", is_additive(lambda *at: turned.get(at, resilience_level(*at))))
assert is_additive(resilience_level)
assert not is_additive(lambda *at: turned.get(at, resilience_level(*at)))

# %% [markdown]
# A score is easy to defend and easy to extend. Its weakness is that nobody says what a point is.
#
# Note 2 under the table adds a reason to stay on the ground: heavy rain may weigh more than the largest payload. Ours
# is 1 kg, and 0.1 m² catch the drops:

# %% tags=["nbval-check-output"]
cloudburst = float(rain_force(100.0, LIGHT_QUADROTOR.rain_area))
needed = LOADS["heavy"] * GRAVITY / cloudburst * 100
print(f"100 mm/h press with {cloudburst:.3f} N, as {1000 * cloudburst / GRAVITY:.1f} g do")
print(f"to weigh as much as {LOADS['heavy']:g} kg it has to rain {needed:,.0f} mm/h")
assert needed > 30_000

# %% [markdown]
# Forty metres of water an hour: the note describes no rain ([01 wind and rain](01_wind_and_rain.ipynb)).
#
# ## Table 4: how far to keep off
#
# REPARE's Table 4 has three cases: light load in mild disturbance, *Intermediate*, 3.5 m; heavy load in mild,
# *Advanced*, 4.5 m; light load in heavy, *Advanced*, 5.5 m. Two things don't fit. Table 3 calls the first case
# *Lower* (we follow Table 3). And two *Advanced* cases have different distances, so **the distance is no function of
# the factor**: one needs a second rule. We know two that give all three values. The first is arithmetic: with $L$ and
# $D$ the numbers 0 to 3 of load and disturbance,
#
# $$ D_\text{min} = 2 + \tfrac12 L + D. \tag{8} $$
#
# The second is physical. What a gust can do depends on the thrust $T$ that is *left over* when the weight $m g$ is
# carried:
#
# $$ D_\text{min} = \Bigl\lceil \xi_0 + c\,\frac{F_\text{gust}}{\sqrt{T^2 - (m g)^2}} \Bigr\rceil
#    + \tfrac12 D_\text{uav}, \qquad \xi_0 = 1\text{ m},\; c = 8.5\text{ m}. \tag{9} $$
#
# Our vehicle (1.5 kg, 28 N), payloads, winds and the two constants were chosen so that it meets the three cases.

# %% tags=["nbval-check-output"]
printed = {("light", "mild"): 3.5, ("heavy", "mild"): 4.5, ("light", "heavy"): 5.5}
print("D_min [m] by Eq. 8 / by Eq. 9 (g: grounded, * in Table 4)")
print(f"{'':<9}", *(f"{load:>12}" for load in LOADS))
for disturbance in DISTURBANCES:
    entries = []
    for load in LOADS:
        both = [safe_distance(load, disturbance, reading=reading) for reading in ("table", "physical")]
        mark = (
            "*" if (load, disturbance) in printed else "g" if resilience_level(load, disturbance) == "grounded" else " "
        )
        entries.append(f"{both[0]:.1f} / {both[1]:.1f}{mark}")
        assert printed.get((load, disturbance), both[0]) == both[0]
        assert printed.get((load, disturbance), both[1]) == both[1]
    print(f"{disturbance:<9}", *(f"{entry:>12}" for entry in entries))
reserve = {load: float(LIGHT_QUADROTOR.loaded(LOADS[load]).horizontal_reserve()) for load in ("light", "heavy")}
print(f"thrust left: {reserve['light']:.1f} N with a light load, {reserve['heavy']:.1f} N with a heavy one")

# %% [markdown]
# A heavy load leaves 13.5 N where a light one leaves 22.1 N: the same gust pushes farther. That is why two *Advanced*
# cases differ, and why the load enters at all. Beyond the three cases the two rules part: three points don't fix
# sixteen entries.
#
# Do routes keep these distances? In Fig. 12's pair and in the forty blocked ones:

# %% tags=["nbval-check-output"]
cases = {f"{load} load, {disturbance} disturbance": (load, disturbance) for load, disturbance in printed}
kept = {}
for name, (load, disturbance) in cases.items():
    flown = [repare(city, *pair, load=load, disturbance=disturbance) for pair in [(notch, middle), *blocked]]
    kept[name] = flown[0]
    least = [route.clearance(city) for route in flown]
    print(f"{name:<30} {flown[0].length:.1f} m, clearance {least[0]} m; least of all {len(flown)}: {min(least)} m")
    assert min(least) == least[0] == printed[load, disturbance] == flown[0].info["safe_distance"]

# %% [markdown]
# To the centimetre, on all 41 pairs (the distances are half-integers in voxels of 1 m, so there is no rounding). What
# can't be checked are the words about Figs 15 to 17, that one UAV is slow and another moderate: the paper gives no
# dynamics.
#
# ## Figures 8 to 17
#
# *Figs 8 to 10*: three planners, no disturbance. The field's route is the longest, though its smallest clearance is no
# larger than REPARE's:

# %%
far = (20, 8, 20), (80, 95, 60)
quiet, plain, field = repare(city, *far, disturbance="none"), astar(city, *far), potential_field(city, *far)
calm = {"REPARE, no disturbance": quiet, "A*": plain, "potential field": field}
for name, route in calm.items():
    print(f"{name:<22} {route.length:.1f} m, smallest clearance {route.clearance(city):.1f} m")
assert plain.length < quiet.length < field.length
assert field.clearance(city) <= quiet.clearance(city)
scene.show(city, calm, safe_distance=quiet.info["safe_distance"])

# %% [markdown]
# *Figs 11 to 14*: the same three in gusts, out of the notch. A* flies half a metre from the wall. We push it off its
# route with drawn offsets, $\sigma = 1$ m on each axis, until it is in a wall: the X of Fig. 11, a square here. The
# potential field is trapped in the notch: the X of Fig. 12, another square. REPARE leaves it.


# %%
def blown(route, sigma, seed):
    """A route as it is flown in gusts, up to where it meets a wall."""
    fine = route.resample(0.5)
    clock, pushed = offsets.offset_paths(sigma, route.length / 5.0, seed, count=3)
    points = fine.points + np.stack([np.interp(fine.distance / 5.0, clock, axis) for axis in pushed], axis=1)
    hit = ~city.is_free(points)
    if not hit.any():
        return replace(fine, points=points, planner=f"{route.planner} in gusts")
    end = int(hit.argmax())
    where = "({:.0f}, {:.0f}, {:.0f})".format(*points[end])
    return Route(points[: end + 1], f"{route.planner} in gusts", reached=False, reason=f"hits a wall at {where}",
                 info={"goal": route.points[-1]})  # fmt: skip


flights = [blown(route, 1.0, 8) for route in (repare(city, notch, middle), astar(city, notch, middle))]
trapped = potential_field(city, notch, middle)
scene.show(city, flights[0], flights[1], trapped)

# %% tags=["nbval-check-output"]
print(trapped.reason)
hits = {}
for route in (astar(city, notch, middle), repare(city, notch, middle)):
    ends = [blown(route, 1.0, seed).reached for seed in range(200)]
    print(f"{route.planner:<6} {route.length:.1f} m, {route.clearance(city)} m clear:",
          f"{200 - sum(ends)} of 200 flights hit a wall")  # fmt: skip
    hits[route.planner] = 200 - sum(ends)
assert hits == {"A*": 106, "REPARE": 1}
assert not trapped.reached

# %% [markdown]
# *Figs 15 to 17*: the three cases of Table 4.

# %%
CASE_COLORS = dict(zip(cases, (plot.BLACK, plot.SKY, plot.ORANGE), strict=True))
scene.show(city, kept, colors=CASE_COLORS)

# %% tags=["figure"]
figure, (above, along) = plot.new_panels(1, 2, width=11, height=4.4)
ways = {name: route.points[:, :2] for name, route in kept.items()}
plot.area_map(city, {"building": city.occupied[:, :, 30]}, paths=ways, points={"start": notch[:2], "goal": middle[:2]},
              area=(45, 100, 5, 50), colors=CASE_COLORS, axes=above)  # fmt: skip
metres = np.linspace(12, 44, 321)
room = {name: np.interp(metres, *route.clearance_profile(city)) for name, route in kept.items()}
plot.lines(metres, room, "distance flown [m]", "distance to the nearest obstacle [m]", y_range=(0, 12),
           colors=CASE_COLORS, axes=along, limits={f"{route.info['safe_distance']} m": route.info["safe_distance"] for route in kept.values()})  # fmt: skip
figure

# %% [markdown]
# ## In flight: the boundary
#
# The prediction may be wrong. REPARE 2.2.4 therefore compares the offsets that are observed with the boundary $\xi$
# that was predicted: too small an offset costs only efficiency, too large a one is dangerous. How the boundary is
# moved is left open. `ConditionCheck` raises it at once, to the next step above the offset, and lowers it by one step
# only after a calm of 20 s: offsets below 0.8 times the *next lower* boundary. Two thresholds and a wait keep it from
# fluttering (hysteresis).
#
# `Monitor` is REPARE 2.1.3: two controllers and somebody who chooses. When the boundary and half the body no longer
# fit between route and wall, the *advanced* controller takes over. It flies at half the speed and is stiffer,
# $\omega_n = 1.6$ instead of 1 rad/s, which makes offsets smaller by $1.6^{-3/2} = 0.49$. When there has been half a
# metre to spare for 5 s, the *basic* controller comes back. (Under the stiff one offsets count twice as much. Otherwise
# its own calm would be taken for the weather's, and the two would take turns.)
#
# Five minutes beside a wall, 4 m off. The calm wind was predicted with 2 m. From 60 to 110 s it is three times as
# gusty.

# %% tags=["nbval-check-output"]
clock, loose = offsets.offset_paths(1.0, 300.0, 8, step=0.1)
stiff = resilience.ADVANCED.natural_frequency
_, tight = offsets.offset_paths(stiff**-1.5, 300.0, 9, step=0.1, natural_frequency=stiff)
gustiness = np.interp(clock, [50, 60, 110, 120], [0.5, 1.5, 1.5, 0.5])
check = ConditionCheck(predicted=2.0)
monitor = Monitor(check, uav_diameter=1.0)
seen, boundary = [], []
for moment, level, by_basic, by_advanced in zip(clock, gustiness, loose[0], tight[0], strict=True):
    offset = level * abs(by_advanced if monitor.controller is resilience.ADVANCED else by_basic)
    monitor.observe(moment, offset, clearance=4.0)
    seen.append(offset)
    boundary.append(check.boundary)
for change in (*check.log, *monitor.log):
    print(f"{change.time:6.1f} s  {change.value!s:<9} {change.reason}")

# %% tags=["figure"]
assert [change.value for change in monitor.log] == ["advanced", "basic"]
switches = {f"{change.value}\nfrom {change.time:.0f} s": change.time for change in monitor.log}
observed = {"offset observed": seen, "boundary ξ": boundary, "σ under the basic controller": gustiness}
plot.lines(clock, observed, "time in flight [s]", "offset and boundary [m]", places=switches,
           limits={"room: 4 m less\nhalf the body": 3.5}, x_range=(0, 300), y_range=(0, 4.8))  # fmt: skip

# %% [markdown]
# The first gusts lift the boundary step by step; at 75 s it no longer fits, and the advanced controller takes over. In
# the figure the offsets shrink at once, though it is as gusty as before. At 95 s the boundary comes down by a step: by
# chance, 20 s were calm. The other steps follow when the gusts have ended, and at 141 s there is room again. The half
# minute after the gusts is the price of not fluttering. (At a switch our offset jumps from one drawn path to another;
# a real one can't.)
#
# ## In flight: a new plan
#
# Given a function of time as its disturbance, `repare` looks every second, and where the conditions have changed it
# plans the rest of the route anew. Mild wind that becomes heavy six seconds after take-off:

# %% tags=["nbval-check-output"]
whole = {f"planned for {kind}": repare(city, *far, disturbance=kind) for kind in ("mild", "heavy")}
changing = repare(city, *far, disturbance=lambda moment: "mild" if moment < 6.0 else "heavy")
for plan in changing.info["plans"]:
    place = ", ".join(f"{part:.1f}" for part in plan.place)
    print(f"{plan.time:4.1f} s at ({place}): {plan.conditions}, D_min = {plan.safe_distance} m")
for name, route in {**whole, "REPARE, replanned": changing}.items():
    print(f"{name:<18} {route.length:.1f} m")
grounded = repare(city, *far, load="heavy", disturbance=lambda moment: "mild" if moment < 6.0 else "heavy")
print("heavy load:", grounded.reason)
assert whole["planned for mild"].length < changing.length < whole["planned for heavy"].length
assert not grounded.reached

# %%
scene.show(city, {"REPARE, replanned": changing, **whole}, safe_distance=5.5,
           colors={"planned for mild": plot.BLACK, "planned for heavy": plot.ORANGE})  # fmt: skip

# %% [markdown]
# ## What should a metre cost?
#
# REPARE's zone has an edge. A metre at 3.4 m from a wall costs several times as much as one at 3.6 m. A gust knows no
# such edge. What should it cost, then? Say a touch is as bad as $\lambda$ metres of detour. The route is to have the
# least
#
# $$ C = L + \lambda\,P(\text{touch}) \le L + \lambda N
#      = \int \Bigl(1 + \frac{\lambda}{v}\,\nu(u)\Bigr) ds, \tag{10} $$
#
# since the chance of at least one touch is never above the expected number $N$ of Eq. 6. The integrand *is* the
# price of a metre:
#
# $$ p(\mathbf x) = 1 + \lambda\,\frac{\omega_n}{2\pi v}\,
#    \exp\Bigl(-\frac{u^2}{2\sigma^2}\Bigr), \qquad u = D - r - \max(0, -\boldsymbol\mu\cdot\mathbf n). \tag{11} $$
#
# Every symbol can be measured but $\lambda$, and that one is a decision: 3000 m here. The price is at least 1, so A*
# stays exact. It is smooth, so straight lines at any angle (`shortcut`) can weigh detour against distance all along.
# Who passes faster pays less.

# %%
occupied = np.zeros((16, 3, 3), bool)
occupied[:2] = True
wall = City(occupied)
away = np.linspace(0.5, 12, 400)
curves, steps, colors = {}, {}, {}
for name, case in cases.items():
    now = flight_conditions(*case)
    sigma = (now.safe_distance - 0.5) / 3
    hazard, zone = f"price by hazard, σ = {sigma:.2f} m", f"price of REPARE, {name}"
    curves[hazard] = 3000 / 5 * offsets.crossing_rate(away - 0.5, sigma)
    centre, extra = wall.clearance[2:, 1, 1], repare_price(wall, now)[2:, 1, 1] - 1
    steps[zone] = np.column_stack([centre, extra])[extra > 0]
    colors |= {hazard: CASE_COLORS[name], zone: CASE_COLORS[name]}
plot.lines(away, curves, "distance to the wall [m]", "price of a metre, above 1", points=steps, log="y", colors=colors,
           x_range=(0, 10), y_range=(1e-3, 1e3))  # fmt: skip

# %% [markdown]
# (Marks: REPARE, nothing from $D_\text{min}$ on.) At $D_\text{min}$ itself, three standard deviations from the body,
# Rice still charges a metre for a metre, and REPARE nothing. Half a metre from the wall REPARE charges more than the
# touches are worth; nobody goes there anyway.
#
# ### The comparison
#
# Sixty blocked pairs, Table 4's three cases, $3\sigma = D_\text{min} - r$. REPARE, hazard A* with any angle,
# and, to be fair, two more: REPARE with any angle, and the same with a zone 1 m wider. The last column is for gusts
# 1.5 times as strong as everybody assumed.

# %%
drawn = city.random_pairs(140, 8, apart=40, min_clearance=6.5)
sixty = [pair for pair in drawn if astar(city, *pair).clearance(city) <= 0.5][:60]
shortest = np.array([astar(city, *pair).length for pair in sixty])
results = {}
for name, (load, disturbance) in cases.items():
    keep = safe_distance(load, disturbance)
    step = repare_price(city, flight_conditions(load, disturbance))
    wide = planners.penalty_zone(city, keep + 1.0, penalty=10.0)
    lattice = [repare(city, *pair, load=load, disturbance=disturbance) for pair in sixty]
    results[name] = {
        "REPARE": lattice,
        "REPARE, any angle": [shortcut(route, city, price=step) for route in lattice],
        "the same, zone 1 m wider": [shortcut(astar(city, *pair, price=wide), city, price=wide) for pair in sixty],
        "hazard A*, any angle": [hazard_astar(city, *pair, sigma=(keep - 0.5) / 3) for pair in sixty],
    }
print(len(sixty), "pairs")

# %% tags=["nbval-check-output"]
print(f"{'':<27}length/A* [95 %]        clearance: least, median   touches per 1000 flights   σ · 1.5")
found = {}
for name, by_planner in results.items():
    sigma = (safe_distance(*cases[name]) - 0.5) / 3
    print(f"{name}, σ = {sigma:.2f} m")
    for planner, flown in by_planner.items():
        share = ratio([route.length for route in flown], shortest)
        least = [route.clearance(city) for route in flown]
        expected = [1000 * np.mean([touches(route, factor * sigma) for route in flown]) for factor in (1.0, 1.5)]
        found[name, planner] = share[0], *expected
        print("  {:<25}{:.3f} [{:.3f}, {:.3f}]".format(planner, *share),
              f"{min(least):10.1f} m, {np.median(least):.1f} m {expected[0]:21.1f} {expected[1]:18.0f}")  # fmt: skip
for name in results:
    assert found[name, "hazard A*, any angle"][0] < found[name, "REPARE"][0] - 0.03
    assert found[name, "hazard A*, any angle"][1] < found[name, "REPARE"][1] / 20
    assert found[name, "hazard A*, any angle"][2] < found[name, "REPARE"][2] / 5

# %% [markdown]
# The hazard routes are 4 to 6 % shorter than REPARE's and touched less often by a factor of 20 and more. But look at
# what does it. Most of the *length* comes from flying at any angle, which REPARE can have too. (In the third case a
# straight line then cuts a corner of the soft zone, at 5.1 m.) Most of the *safety* comes from one more metre of
# distance. With both of them REPARE comes close: in the first case it is even a little safer, and a little longer. What
# is left for the smooth price is that nobody has to know how wide the zone should be, and that it spends distance where
# it is cheap: in the second case it is shorter by 2 %, in the third touched three times less for the same length.
#
# A warning about the yardstick. Eq. 6 measures by the noise model that the hazard planner minimises: same formula, same
# $\sigma$. It would be odd if it didn't win. When gusts are 1.5 times as strong as assumed, all of them are touched
# far more often, and hazard stays well ahead of REPARE. Whether it does in simulated flights, with a controller and
# turns, is a question for notebook 13.

# %%
name = "light load, heavy disturbance"
both = "REPARE", "hazard A*, any angle"
pairs_of_routes = list(zip(*(results[name][planner] for planner in both), strict=True))
most = max(range(len(sixty)), key=lambda i: pairs_of_routes[i][0].length - pairs_of_routes[i][1].length)
compared_routes = dict(zip(both, pairs_of_routes[most], strict=True))
plot.profile(city, astar(city, *sixty[most]), compared_routes, safe_distance=5.5)

# %% [markdown]
# ## Turn it yourself
#
# Disturbance, load and $\omega_0$. The map shows the zone 30.5 m above the ground (white: outside of it, a metre costs
# a metre), the title its $D_\text{min}$, the line the way out of the notch. Which settings leave the UAV on the ground?
# And what is left of the distance when $\omega_0$ falls to 0.1, and to 0?


# %%
def turn(disturbance="mild", load="light", omega=2.0):
    """REPARE out of the notch, seen from above, with its zone."""
    now = flight_conditions(load, disturbance)
    zone = np.where(city.clearance < now.safe_distance, repare_price(city, now, penalty=omega), np.nan)
    route = repare(city, notch, middle, load=load, disturbance=disturbance, penalty=omega)
    shown = [route] if route.reached else []
    figure = plot.section(city, 30.5, zone, *shown, label="price of a metre in the zone", norm=LogNorm(1, 1000))
    figure.axes[0].set_facecolor("white")  # free air outside of the zone costs 1
    plot.draw_map(figure.axes[0], city, np.where(city.occupied[:, :, 30], 0.0, np.nan), "gray")
    text = f"D_min = {now.safe_distance} m, resilience {resilience_level(load, disturbance)}"
    text += f", keeps {route.clearance(city):.1f} m" if route.reached else f"\n{route.reason}"
    figure.axes[0].set_title(text, fontsize=10)
    return figure


# %%
settings = {"disturbance": list(DISTURBANCES), "load": ["light", "moderate", "heavy"], "omega": [0.0, 0.1, 2.0]}
start = {"disturbance": "mild", "load": "light", "omega": 2.0}
plot.sliders(turn, title="REPARE and its zone", labels={"omega": "ω₀"}, start=start, progress=False, **settings)

# %% [markdown]
# ## What the paper says, what we find

# %% tags=["nbval-check-output"]
print("REPARE Table 2: seed 8, 1000 pairs,", *(f"{k} {v:.3f} [{a:.3f}, {b:.3f}]" for k, (v, a, b) in table2.items()))
print("REPARE Table 4:", *(f"{route.info['safe_distance']} m: {route.length:.1f} m" for route in kept.values()))
print("touches per 1000 flights at σ and 1.5 σ, seed 8, 60 pairs:")
for name in results:
    rows = [found[name, planner] for planner in both]
    print(f"  {name:<30}", *(f"{p} {v[0]:.3f}, {v[1]:.1f}, {v[2]:.0f};" for p, v in zip(both, rows, strict=True)))
assert [round(table2[name][0], 3) for name in table2] == [0.950, 0.958, 0.963, 1.014, 1.022]
assert [round(route.length, 1) for route in kept.values()] == [71.2, 73.2, 74.6]

# %% [markdown]
# | REPARE | says | we find |
# |---|---|---|
# | Table 2 | lengths 0.952 (A\*), 0.973 (REPARE), 1 (field) | 0.950, 0.963 (4.5 m): order holds on the lattice |
# | | REPARE/A\* 1.022 | with 4.5 m 1.022 [1.020, 1.023], with 3.5 m 1.014 [1.013, 1.015]: reached |
# | | (whether the field always arrives isn't said) | it is trapped on 15.3 % of the thousand pairs |
# | | times 0.558, 0.655, 1 | a statement about a program; expansions REPARE/A\* 1.40 |
# | Table 3 | sixteen entries | an additive score |
# | | note 2: rain may outweigh the load | no: it takes 39 metres of water an hour |
# | Table 4 | 3.5, 4.5, 5.5 m | kept exactly, on 41 pairs each |
# | | the first case is *Intermediate* | Table 3 says *Lower* |
# | | (distance by factor) | two *Advanced* differ: thrust left over, 22.1 and 13.5 N |
# | Fig. 11 | A\* crashes when disturbed | yes: 106 of 200 flights, REPARE 1 |
# | Fig. 12 | the field is trapped, REPARE isn't | yes: 71.2 m, 3.5 m clear |
# | Figs 15–17 | slow, moderate | can't be checked: no dynamics given |
# | Eqs 11–13 | the cost of a route | depends on the direction: 38 and 33 of 100 pairs |
# | Eqs 14–16 | a sum of forces decides | as work: the same for all routes; as a size: cancels in the worst wind |
# | | | as reasons that add up (our Eq. 5): keeps $D_\text{min}$ on all pairs |
# | Alg. 1 | pseudo-code | can't be run: eight repairs |
#
# Intervals are 95 % by bootstrap over pairs, seed 8; lengths are ratios of means (seed 7: A\* 0.950, REPARE/A\* 1.015).
# Beyond the paper: the zone widened towards the wind keeps a mean offset of 2 m from making fifteen times as
# many touches, and a price by Rice's formula makes the edge of the zone, and the choice of its width, unnecessary.
#
# ## Your turn
#
# Three exercises: the weight ω, Table 3 as a score, and a boundary that doesn't flutter:
# [exercises/07_repare_exercises.ipynb](exercises/07_repare_exercises.ipynb). Walls are not all that a fall can hit: [08
# risk maps](08_risk_maps.ipynb) ask who is below.
