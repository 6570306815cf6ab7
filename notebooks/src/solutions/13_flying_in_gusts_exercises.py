# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 13 Flying in gusts: exercises
#
# They belong to the notebook [13 Flying in gusts](../13_flying_in_gusts.ipynb). Put your answer in the place of
# `raise NotImplementedError`, run the cell and then the check below it. The check says what is right, or what is wrong
# and what to think about; ask it as often as you like.

# %%
import math

import numpy as np
from scipy.stats import beta

from uavlab import exercises

# %% [markdown]
# ## 13.1 What accelerates a UAV
#
# Write the acceleration of the point mass: Eq. 2 of the notebook, in dry air. `thrust` [N], `wind` and `velocity` [m/s]
# are arrays (east, north, up); `mass` is in kg, `drag_area` is $CS$ in m². $g = 9.81$ m/s², $\varrho = 1.225$ kg/m³.


# %%
def acceleration(thrust, wind, velocity, mass, drag_area):
    """Acceleration (3,) of a UAV in moving air [m/s²]."""
    ### BEGIN SOLUTION
    stream = wind - velocity
    drag = 0.5 * 1.225 * drag_area * np.linalg.norm(stream) * stream
    return (thrust + drag) / mass - np.array([0.0, 0.0, 9.81])
    ### END SOLUTION


# %%
exercises.check("13.1", acceleration)

# %% tags=["solution"]
assert exercises.check("13.1", acceleration)
hover, still = np.array([0.0, 0.0, 1.75 * 9.81]), np.zeros(3)
for wind in ((6.0, 0.0, 0.0), (9.0, 0.0, 0.0), (-9.0, 9.0, 0.0)):
    print(wind, acceleration(hover, np.array(wind), still, 1.75, 0.06).round(2))

# %% [markdown]
# ## 13.2 How sure is a crash rate?
#
# Of `flights` independent flights `crashed` ended in a wall. Write the exact 95 % interval (Clopper and Pearson) of the
# crash *probability*, `(low, high)`. The lower end is the probability at which as many crashes **or more** would be
# seen in 2.5 % of such trials; the upper end that at which as many **or fewer** would. The quantiles of a beta
# distribution give both, `beta.ppf(share, a, b)`:
#
# - lower end: share 0.025, $a = k$, $b = n - k + 1$, for $k$ crashes of $n$;
# - upper end: you find it by counting the flights that *didn't* crash in the same way.
#
# Mind the trials in which none crashes, or all do.


# %%
def crash_interval(crashed, flights):
    """95 % interval of the crash probability (low, high)."""
    ### BEGIN SOLUTION
    low = beta.ppf(0.025, crashed, flights - crashed + 1) if crashed > 0 else 0.0
    high = beta.ppf(0.975, crashed + 1, flights - crashed) if crashed < flights else 1.0
    return low, high
    ### END SOLUTION


# %%
exercises.check("13.2", crash_interval)

# %% tags=["solution"]
assert exercises.check("13.2", crash_interval)
for crashed, flights in ((0, 100), (0, 20_000), (1, 20_000), (20, 2000)):
    low, high = crash_interval(crashed, flights)
    print(f"{crashed:2d} of {flights:6,}: {1000 * low:.3g} to {1000 * high:.3g} per 1 000")

# %% [markdown]
# ## 13.3 Not more than one of a thousand
#
# A UAV flies beside a wall for `seconds`, its offsets are those of Eq. 1 with `sigma` [m] and $\omega_n = 1$ rad/s. How
# far from the wall does the *route* have to be, so that the expected number of touches is `allowed` (0.001, say)?
# Rice's formula (notebook 02; the hazard planner's price in notebook 07): a margin $u$ is crossed
#
# $$ \nu(u) = \frac{\omega_n}{2\pi}\,e^{-u^2/2\sigma^2} \quad\text{times a second.} $$
#
# The body has a radius of `radius` [m]. Where any distance would do, the body still has to fit beside the wall.


# %%
def distance_to_keep(sigma, seconds, allowed, radius):
    """Least distance of the route from the wall [m]."""
    ### BEGIN SOLUTION
    at_no_margin = seconds / (2 * math.pi)
    if at_no_margin <= allowed:
        return radius
    return radius + sigma * math.sqrt(2 * math.log(at_no_margin / allowed))
    ### END SOLUTION


# %%
exercises.check("13.3", distance_to_keep)

# %% tags=["solution"]
assert exercises.check("13.3", distance_to_keep)
for seconds in (1.0, 8.0, 60.0, 600.0):
    print(f"{seconds:5g} s beside the wall: {distance_to_keep(1.0, seconds, 0.001, 0.5):.2f} m; Pauta says 3.5 m")
