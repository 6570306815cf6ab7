# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 02 The Pauta criterion: exercises
#
# They belong to the notebook [02 The Pauta criterion](../02_pauta.ipynb). Put your answer in the place of
# `raise NotImplementedError`, run the cell and then the check below it. The check says what is right, or what is wrong
# and what to think about; ask it as often as you like.

# %%
import math

import numpy as np

from uavlab import exercises

# %% [markdown]
# ## 02.2 How much does the plane hold?
#
# Offsets on two axes are Gaussian and independent, with mean 0 and the same $\sigma$. Write the probability, from 0 to
# 1, that the offset lies within a circle of $k\sigma$ around the route. On one axis it would be
# $\operatorname{erf}(k/\sqrt 2)$.


# %%
def coverage_in_the_plane(k):
    """Probability that an offset in the plane lies within a circle of k standard deviations."""
    ### BEGIN SOLUTION
    # the ring from r to r + dr holds exp(-r²/2) / 2π · 2πr dr, and that integrates from 0 to k
    return 1 - math.exp(-(k**2) / 2)
    ### END SOLUTION


# %%
exercises.check("02.2", coverage_in_the_plane)

# %% tags=["solution"]
assert exercises.check("02.2", coverage_in_the_plane)
print(f"3σ holds {coverage_in_the_plane(3):.3%}")

# %% [markdown]
# ## 02.3 The distance to keep, in the plane and with wind
#
# Write the least distance between route and wall [m] for a UAV that gusts push about in the plane, with the same
# `sigma` [m] on both axes. 99.73 % of the offsets are to be survived, whatever their direction: the radius $k$ is that
# of the plane. The steady wind holds the UAV off its route by `mean_offset` (east, north) [m]; `normal` is a unit
# vector that points away from the wall. Wind towards the wall widens the distance. Wind away from it doesn't narrow
# it: it may turn.
#
# For a body of 1 m, $\sigma = 1$ m and no wind the answer is 3.94 m.


# %%
def safe_distance(sigma, uav_diameter, mean_offset, normal):
    """Least distance to keep from a wall [m], for gusts in the plane and a steady wind."""
    ### BEGIN SOLUTION
    share = math.erf(3 / math.sqrt(2))  # what 3σ holds on one axis, 99.73 %
    k = math.sqrt(-2 * math.log(1 - share))  # 02.2 turned round: 3.439
    away_from_wall = np.dot(mean_offset, normal)
    return k * sigma + uav_diameter / 2 + max(0.0, -away_from_wall)
    ### END SOLUTION


# %%
exercises.check("02.3", safe_distance)

# %% tags=["solution"]
assert exercises.check("02.3", safe_distance)
for mean_offset in ((0.0, 0.0), (-1.0, 0.0), (1.0, 0.0)):
    print(f"wall in the west, mean offset {mean_offset} m: keep {safe_distance(1.0, 1.0, mean_offset, (1, 0)):.2f} m")

# %% [markdown]
# ## 02.4 The Pauta filter by hand
#
# Write the filter for gross errors. `samples` is an array of offsets on one axis. Compute the mean and the standard
# deviation (with $n - 1$) of the samples that are left, remove all that are farther than $3\sigma$ from the mean, on
# either side, and go on until a round removes nothing. Return the samples that are left, in their order. Don't use
# `pauta_filter`.


# %%
def without_gross_errors(samples):
    """The samples that are left when nothing lies beyond three standard deviations any more."""
    ### BEGIN SOLUTION
    left = np.array(samples, dtype=float)
    while True:
        near = np.abs(left - left.mean()) <= 3 * left.std(ddof=1)
        if near.all():
            return left
        left = left[near]
    ### END SOLUTION


# %%
exercises.check("02.4", without_gross_errors)

# %% tags=["solution"]
assert exercises.check("02.4", without_gross_errors)
rng = np.random.default_rng(23)
left = without_gross_errors(np.concatenate([rng.normal(0, 1, 60), [9.0, 30.0, 200.0]]))
print(f"{len(left)} samples left, σ = {left.std(ddof=1):.2f} m")
assert left.max() < 9
