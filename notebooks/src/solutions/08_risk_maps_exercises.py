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
# NotImplementedError`, run the cell and then the check below it. The check says what is right, or what is wrong and
# what to think about; ask it as often as you like.

# %%
import numpy as np

from uavlab import exercises
from uavlab.planners.least_risk import least_risk
from uavlab.risk import CAMPUS_FLIGHT, reference_campus

# %% [markdown]
# ## 08.1 How fast does it fall?
#
# A wreck of `mass` [kg] has fallen through `height` [m] from rest, and the air of `air_density` [kg/m³] has braked
# the fall on the `drag_area` $R_I A$ [m²]. Return its vertical speed in m/s. Both papers print a formula for this.
# Derive it yourself: what does gravity's work become? Take $g = 9.81$ m/s².


# %%
def fall_speed(height, mass, drag_area, air_density):
    """Vertical speed after a fall from rest with drag [m/s]."""
    ### BEGIN SOLUTION
    terminal_speed_squared = 2 * mass * 9.81 / (drag_area * air_density)
    return np.sqrt(terminal_speed_squared * (1 - np.exp(-2 * 9.81 * height / terminal_speed_squared)))
    ### END SOLUTION


# %%
exercises.check("08.1", fall_speed)

# %% tags=["solution"]
assert exercises.check("08.1", fall_speed)
print(f"the papers' quadrotor after 30 m: {fall_speed(30.0, 1.38, 0.3 * 0.0188, 1.225):.2f} m/s")

# %% [markdown]
# ## 08.2 Does the blow kill?
#
# Write the chance to die for a person who is hit with `energy` [J] behind a `shelter` $p_s$ from 0 to 1. In the
# papers a bracket is lost: find out what the root covers from the meaning of $\alpha = 10^6$ J, the energy that kills
# one in two at $p_s = 0.5$; $\beta = 34$ J. And in the open, at $p_s = 0$, there is no formula, only a limit.

# %%
EVEN_ODDS_ENERGY, LEAST_FATAL_ENERGY = 1e6, 34.0  # α and β [J]


def fatality(energy, shelter):
    """Chance that a person who is hit dies, 0 to 1."""
    ### BEGIN SOLUTION
    if shelter == 0:
        return 1.0 if energy > LEAST_FATAL_ENERGY else 0.0
    root = np.sqrt(EVEN_ODDS_ENERGY / LEAST_FATAL_ENERGY)  # alone: at E = α and p_s = 1/2 it cancels the power
    return 1 / (1 + root * (LEAST_FATAL_ENERGY / energy) ** (1 / (4 * shelter)))
    ### END SOLUTION


# %%
exercises.check("08.2", fatality)

# %% tags=["solution"]
assert exercises.check("08.2", fatality)
print("555 J:", ", ".join(f"{fatality(555.0, shelter):.1%} at p_s = {shelter}" for shelter in (0, 0.25, 0.5, 0.75, 1)))

# %% [markdown]
# ## 08.3 What does a route cost?
#
# `rate` is a risk map, deaths per hour of flight in each voxel `(i, j, k)`. `voxels` is a route, an array $(N, 3)$ of
# whole numbers: the voxels whose centres it joins, each a neighbour of the one before, over a face, an edge or a
# corner. Voxels have the edge `cell` [m], the UAV flies at `speed` [m/s]. Return the deaths to expect per mission.
# (The papers' sum over voxels is something else.)


# %%
def deaths(rate, voxels, cell, speed):
    """Expected deaths per mission, ∫ r ds / (3600 V)."""
    ### BEGIN SOLUTION
    lengths = cell * np.linalg.norm(np.diff(voxels, axis=0), axis=1)
    along = rate[tuple(voxels.T)]
    mean = (along[:-1] + along[1:]) / 2  # half of each leg lies in either voxel
    return (mean * lengths).sum() / (3600 * speed)
    ### END SOLUTION


# %%
exercises.check("08.3", deaths)

# %% tags=["solution"]
assert exercises.check("08.3", deaths)
campus = reference_campus()
route = least_risk(campus, *CAMPUS_FLIGHT, max_length=151.0)
mine = deaths(campus.rate, campus.city.cell_of(route.points), campus.city.cell, 16.0)
print(f"aware route on the reference campus: {mine:.3e}, the library says {campus.fatalities(route):.3e}")
assert np.isclose(mine, campus.fatalities(route), rtol=1e-9)
