# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 08 Risk maps: exercises
#
# They belong to the notebook [08 Risk maps](../08_risk_maps.ipynb). Put your answer in the place of `raise
# NotImplementedError` or of the dots, run the cell and then the check below it. The check says what is right, or what
# is wrong and what to think about; ask it as often as you like.

# %%
from dataclasses import replace
from itertools import pairwise

import numpy as np

from uavlab import exercises, risk
from uavlab.city import City
from uavlab.risk import RiskMap, reference_campus
from uavlab.route import Route
from uavlab.vehicle import RISK_QUADROTOR

# %% [markdown]
# ## 08.1 A parachute
#
# *Warm-up · 5 minutes*
#
# The UAV (1.38 kg, 16 m/s) gets a parachute, with which the wreck sinks at 4 m/s. It fails 30 m above a square without
# shelter. What do the papers' fall and the full fall say about its risk, compared with a wreck without a parachute?
#
# - **a** Less risk in both falls, because the blow is softer.
# - **b** About four times the risk in the papers' fall, and none at all in the full fall.
# - **c** About four times the risk in both falls, because the wreck comes in flat.
# - **d** No risk at all in the papers' fall, and about four times the risk in the full fall.

# %%
### BEGIN SOLUTION
# In the papers' fall the wreck keeps its 16 m/s forward, in the full fall it loses them.
choice_1 = "b"
### END SOLUTION

# %%
exercises.check("08.1", choice_1)

# %% tags=["solution"]
assert exercises.check("08.1", choice_1)
chute = replace(RISK_QUADROTOR, fall_drag_area=2 * 1.38 * 9.81 / (1.225 * 4.0**2))
for ballistic in (False, True):
    rates = [float(risk.person_rate(30.0, uav=uav, ballistic=ballistic)) for uav in (RISK_QUADROTOR, chute)]
    name = "full fall" if ballistic else "papers' fall"
    print(f"{name}: {rates[0]:.1e} without, {rates[1]:.1e} with the parachute [deaths per hour]")
assert rates[1] == 0

# %% [markdown] tags=["solution"]
# In the papers' fall the wreck keeps 16 m/s forward, which alone is an energy of 177 J, far above 34 J. So every hit
# still kills. But now $d = 1.65 \cdot 16/4 = 6.6$ m, and $A_\text{exp} = 0.9 \cdot 6.6 + 0.64 = 6.6$ m² instead of 1.65.
# In the full fall the parachute takes the forward speed, too. What is left is $\tfrac12 \cdot 1.38 \cdot 4^2 = 11$ J,
# less than 34 J, and nobody dies. To judge a parachute, don't use the papers' fall.

# %% [markdown]
# ## 08.2 The cars of a whole road
#
# *Warm-up · 10 minutes*
#
# A traffic count gives the cars per kilometre of a *whole* road, all lanes together: `cars_per_km`. The road is `width`
# metres wide. Return the deaths in cars per hour of flight above it, $r_\text{cars}$. A car covers 8.4 m² and costs
# three lives if it is hit; the UAV fails $6.4\cdot10^{-5}$ times per hour.


# %%
def deaths_on_road(cars_per_km, width):
    """Deaths in cars per hour of flight above a road [1/h]."""
    ### BEGIN SOLUTION
    cars_per_metre = cars_per_km / 1000
    covered = 8.4 * cars_per_metre / width  # share of the road's area
    return 6.4e-5 * covered * 3
    ### END SOLUTION


# %%
exercises.check("08.2", deaths_on_road)

# %% tags=["solution"]
assert exercises.check("08.2", deaths_on_road)
print(f"20 cars per km on 6 m: {deaths_on_road(20.0, 6.0):.2e}, on 12 m: {deaths_on_road(20.0, 12.0):.2e} per hour")

# %% [markdown] tags=["solution"]
# The cars of all lanes stand on the area of all lanes, so here the width of the road stays in the formula: the same
# cars on twice the width are hit half as often. In the chapter $K$ counts the cars of *one* lane. Then a road of twice
# the width has twice the cars, and the width drops out. You get the chapter's formula with 10 cars per km and 3 m.

# %% [markdown]
# ## 08.3 Does the blow kill?
#
# *Code · 15 minutes*
#
# Write the chance to die for a person who is hit with `energy` [J] behind a `shelter` $p_s$ from 0 to 1 (Eq. 7). Test
# what your root covers by the meaning of $E_\alpha = 10^6$ J, the energy that kills one in two at $p_s = 0.5$. $E_\beta$
# is 34 J. At $p_s = 0$ there is no formula, only a limit. (We don't ask for exactly 34 J there.)

# %%
EVEN_ODDS_ENERGY, LEAST_FATAL_ENERGY = 1e6, 34.0  # E_α and E_β [J]


def fatality(energy, shelter):
    """Chance that a person who is hit dies, 0 to 1."""
    ### BEGIN SOLUTION
    if shelter == 0:
        return 1.0 if energy > LEAST_FATAL_ENERGY else 0.0
    root = np.sqrt(EVEN_ODDS_ENERGY / LEAST_FATAL_ENERGY)  # alone: at E = E_α and p_s = 1/2 it cancels the power
    return 1 / (1 + root * (LEAST_FATAL_ENERGY / energy) ** (1 / (4 * shelter)))
    ### END SOLUTION


# %%
exercises.check("08.3", fatality)

# %% tags=["solution"]
assert exercises.check("08.3", fatality)
print("555 J:", ", ".join(f"{fatality(555.0, shelter):.1%} at p_s = {shelter}" for shelter in (0, 0.25, 0.5, 0.75, 1)))

# %% [markdown] tags=["solution"]
# With $E = E_\alpha$ and $p_s = \tfrac12$ the power is $(E_\beta/E_\alpha)^{1/2}$. The answer has to be $\tfrac12$, so what
# stands before the power must be $(E_\alpha/E_\beta)^{1/2}$: the root covers the fraction alone. Without shelter the
# exponent grows beyond all bounds. A fraction $E_\beta/E$ below 1 then goes to 0, and the chance to 1; one above 1 goes
# to infinity, and the chance to 0.

# %% [markdown]
# ## 08.4 How many deaths does a route cost?
#
# *Code · 25 minutes*
#
# `rate` is a risk map, deaths per hour of flight in each voxel `(i, j, k)`. `voxels` is a route, an array $(N, 3)$ of
# whole numbers: the voxels whose centres it joins, each a neighbour of the one before, over a face, an edge or a
# corner. Voxels have the edge `cell` [m], the UAV flies at `speed` [m/s]. Return the expected deaths per flight, $F$.
# (The papers' sum over voxels is something else.)


# %%
def deaths(rate, voxels, cell, speed):
    """Expected deaths per flight, ∫ r ds / (3600 v)."""
    ### BEGIN SOLUTION
    lengths = cell * np.linalg.norm(np.diff(voxels, axis=0), axis=1)
    along = rate[tuple(voxels.T)]
    mean = (along[:-1] + along[1:]) / 2  # half of each leg lies in either voxel
    return (mean * lengths).sum() / (3600 * speed)
    ### END SOLUTION


# %%
exercises.check("08.4", deaths)

# %% tags=["solution"]
assert exercises.check("08.4", deaths)
campus = reference_campus()
route = Route([(12.5, 17.5, 27.5), (37.5, 17.5, 27.5), (67.5, 47.5, 57.5), (67.5, 112.5, 57.5)])
steps = [(2, 3, 5), (7, 3, 5), (13, 9, 11), (13, 22, 11)]
voxels = np.array([steps[0]])
for one, other in pairwise(steps):
    leg = np.subtract(other, one)
    voxels = np.vstack([voxels, voxels[-1] + np.arange(1, abs(leg).max() + 1)[:, None] * np.sign(leg)])
mine = deaths(campus.rate, voxels, campus.city.cell, 16.0)
print(f"a route on the campus: {mine:.3e}, the library says {campus.fatalities(route):.3e}")
assert np.isclose(mine, campus.fatalities(route), rtol=1e-9)

# %% [markdown] tags=["solution"]
# A move from centre to centre runs half in one voxel and half in the other, so it is flown at the mean of both rates. Its
# length is 1, $\sqrt2$ or $\sqrt3$ edges. Length over speed is a time in seconds; a rate per hour needs hours, so we
# divide by 3600.

# %% [markdown]
# ## 08.5 How fast should it fly?
#
# *Experiment · 20 minutes*
#
# A slow UAV stays over the people for longer. A fast one hits more of them, and harder. **Which speed, from 1 to 40 m/s,
# makes the fewest expected deaths per metre flown over sparse trees ($p_s = 0.25$), 30 m high?** Find it to within 0.2
# m/s. `risk.person_rate(30.0, shelter=0.25, speed=v)` gives the risk with the papers' fall. Look at other shelters, too:
# where is the best speed without shelter, and why?

# %%
for v in (5.0, 10.0, 20.0, 30.0):
    print(f"{v:4.1f} m/s: {float(risk.person_rate(30.0, shelter=0.25, speed=v)):.2e} deaths per hour of flight")

# %%
### BEGIN SOLUTION
speeds = np.arange(1.0, 40.0, 0.05)
per_hour = np.array([float(risk.person_rate(30.0, shelter=0.25, speed=v)) for v in speeds])
per_metre = per_hour / (3600 * speeds)
best_speed = speeds[per_metre.argmin()]
### END SOLUTION

# %%
exercises.check("08.5", best_speed)

# %% tags=["solution"]
assert exercises.check("08.5", best_speed)
print(f"sparse trees: {best_speed:.2f} m/s")
for shelter in (0.0, 0.25, 0.5):
    found = [float(risk.person_rate(30.0, shelter=shelter, speed=v)) / v for v in speeds]
    print(f"shelter {shelter:g}: best at {speeds[np.argmin(found)]:.1f} m/s of those from 1 to 40 m/s")

# %% [markdown] tags=["solution"]
# Deaths per metre are $r(v)/(3600\,v)$. At $p_s = 0.25$ the exponent of Eq. 7 is 1, and the chance to die is small, so it
# goes with the energy. So $r$ is proportional to $(d' v + \pi R_\text{hit}^2)\,(v^2 + v_z^2)$, with $d' = 2 R_\text{hit} h_p/v_z$.
# Divided by $v$ that is $(d' + \pi R_\text{hit}^2/v)\,(v^2 + v_z^2)$. For small $v$ the second term is large: the UAV
# stays for long. For large $v$ the energy is. In between lies the best speed, 13 m/s.
#
# Without shelter everybody who is hit dies, however hard. Then $r/v$ goes with $d' + \pi R_\text{hit}^2/v$, which falls
# all the way: the faster, the better. The risk *per hour* is least at the lowest speed everywhere. That is no answer,
# as the flight then takes the most hours.

# %% [markdown]
# ## 08.6 Two routes that fool the sum
#
# *Open · 30 minutes*
#
# On `field` people and shelter are the same everywhere. **Find two routes from `start` to `goal` of which the papers'
# sum over voxels prefers the wrong one.** The sum of the first is to be at most 1/1.2 of that of the second, and its
# deaths per flight at least 1.2 times those of the second. Each is a list of points (x, y, z) in metres, as many as you
# like; it begins with `start` and ends with `goal`, stays on the map (0 to 60 m in all directions) and at least 3 m
# high. Hand over `pair = (first, second)`. `compare` shows both measures.
#
# A hint: how long can the way through one voxel be? And by how little must a diagonal be shifted to pass twice as many?

# %%
field = RiskMap(City(np.zeros((12, 12, 12), dtype=bool), cell=5.0), 0.03, shelter=0.5)
start, goal = (2.5, 2.5, 27.5), (47.5, 47.5, 27.5)


def compare(first, second):
    """The papers' sum and the deaths of two routes."""
    for points in (first, second):
        route = Route(points)
        print(f"{route.length:.1f} m: sum {field.cell_sum(route):.2e} per hour, {field.fatalities(route):.2e} deaths")


compare([start, goal], [start, (47.5, 2.5, 27.5), goal])

# %%
### BEGIN SOLUTION
zigzag = [(2.5 + 5 * n, 2.5 + 5 * n, 27.5 + 5 * (n % 2)) for n in range(9)]  # ends at (42.5, 42.5, 27.5)
first = [*zigzag, goal]
second = [start, (25.2, 24.8, 27.5), goal]
pair = (first, second)
### END SOLUTION

# %%
exercises.check("08.6", pair)

# %% tags=["solution"]
assert exercises.check("08.6", pair)
compare(*pair)

# %% [markdown] tags=["solution"]
# The first goes up and down in zigzag through the corners of voxels. Each move is $\sqrt3$ edges long and needs one voxel
# more, as a straight move of one edge does. The second is the straight line, bent by 30 cm in the middle. So it doesn't
# run through the edges between voxels but passes a third one at each, 19 in all. A planner that minimises the sum would
# fly the zigzag. There are other ways: circles within one voxel cost nothing at all in the papers' sum.
