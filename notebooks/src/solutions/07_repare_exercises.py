# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 07 REPARE: exercises
#
# They belong to the notebook [07 REPARE](../07_repare.ipynb). Put your answer in the place of
# `raise NotImplementedError`, run the cell and then the check below it. The check says what is right, or what is wrong
# and what to think about; ask it as often as you like.

# %%
import math

import numpy as np

from uavlab import exercises

# %% [markdown]
# ## 07.2 The price of a metre
#
# Write the price of a metre at a `distance` [m] from a wall: Eq. 5 of the notebook, with $\omega_0 = 2$,
# $\vartheta_F = \vartheta_G = 1$ and $F_\text{tra} = 1$. The size of the wall's push is that of Eq. 1. `wind` is
# $\mathbf F_\text{dist}$ and `normal` the unit vector $\mathbf n$ away from the wall, both (east, north); `load_ratio`
# is $\lambda$.


# %%
def price(distance, safe_distance, wind, normal, load_ratio):
    """Price of a metre near a wall, 1 in the open."""
    ### BEGIN SOLUTION
    if distance >= safe_distance:
        return 1.0
    push = safe_distance**3 / 4 * (1 / distance - 1 / safe_distance) / distance**2
    towards_wall = max(0.0, -np.dot(wind, normal))
    return 1 + 2 * (1 + push + towards_wall + load_ratio)
    ### END SOLUTION


# %%
exercises.check("07.2", price)

# %% tags=["solution"]
assert exercises.check("07.2", price)
for wind in ((-0.4, 0.0), (0.0, 0.4), (0.4, 0.0)):
    print(f"wall in the west, wind {wind}: {price(3.5, 5.5, wind, (1, 0), 0.6):.2f}")

# %% [markdown]
# ## 07.3 Table 3 as a score
#
# Find points for each load and each disturbance, and four thresholds, so that the sum of the two points gives Table 3:
# a sum below the first threshold is "off", from the first on "lower", from the second "intermediate", from the third
# "advanced", from the fourth "grounded". There are many right answers. (Begin with the row *mild* and ask which loads
# must differ; then compare entries of one level.)


# %%
def score():
    """Points by load, points by disturbance, and the four thresholds."""
    ### BEGIN SOLUTION
    loads = {"dead": 0, "light": 2, "moderate": 8, "heavy": 10}
    disturbances = {"none": 0, "mild": 6, "moderate": 10, "heavy": 14}
    return loads, disturbances, (5, 9, 15, 21)
    ### END SOLUTION


# %%
exercises.check("07.3", score)

# %% tags=["solution"]
assert exercises.check("07.3", score)
loads, disturbances, thresholds = score()
for disturbance, points in disturbances.items():
    print(f"{disturbance:<9}", *(f"{points + more:3d}" for more in loads.values()))

# %% [markdown]
# ## 07.4 A boundary that doesn't flutter
#
# Once a second an offset [m] is observed. The boundary begins at `predicted`. Write the boundaries that hold after
# each observation, as a list:
#
# - An offset above the boundary raises it at once, to the least `predicted + n * step` that is not below the offset.
# - An observation is *calm* when it is below `release` times the **next lower** boundary, `boundary - step`.
# - After `hold` calm observations in a row, counted from the last change, the boundary comes down by one `step`. It
#   never falls below `predicted`.
#
# With `predicted=2`, `step=0.5`, `hold=3`, `release=0.8` the offsets 1, 2.7, 1, 1, 1, 1 give 2, 3, 3, 3, 2.5, 2.5.


# %%
def boundaries(observed, predicted, step, hold, release):
    """The boundary after each of the observed offsets [m]."""
    ### BEGIN SOLUTION
    steps, calm, history = 0, 0, []
    for offset in observed:
        boundary = predicted + steps * step
        calm = calm + 1 if offset < release * (boundary - step) else 0
        if offset > boundary:
            steps, calm = math.ceil((offset - predicted) / step), 0
        elif steps > 0 and calm >= hold:
            steps, calm = steps - 1, 0
        history.append(predicted + steps * step)
    return history
    ### END SOLUTION


# %%
exercises.check("07.4", boundaries)

# %% tags=["solution"]
assert exercises.check("07.4", boundaries)
print(boundaries([1, 2.7, 1, 1, 1, 1], predicted=2, step=0.5, hold=3, release=0.8))
