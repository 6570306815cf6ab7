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
# `raise NotImplementedError` or of the dots, run the cell and then the check below it. The check says what is right, or
# what is wrong and what to think about; ask it as often as you like.

# %%
import math

import numpy as np
from scipy.stats import beta

from uavlab import exercises
from uavlab.city import table1_city
from uavlab.flight import Autopilot, crash_rate, monte_carlo, offset_sigma
from uavlab.planners import hazard_astar, repare
from uavlab.statistics import grouped_share_interval, share_interval
from uavlab.vehicle import LIGHT_QUADROTOR
from uavlab.weather import Wind

# %% [markdown]
# ## 13.1 How sure are thirty crashes?
#
# *Warm-up · 5 minutes*
#
# A planner made routes between 100 random pairs of points. Each was flown 20 times. Of the 2 000 flights 30 crashed, 18
# of them on one and the same route. A friend wants the interval of the mean rate over *all such pairs*. She takes
# `share_interval(30, 2000)`, the exact one, and gets 10 to 21 per 1 000. What do you say?
#
# - **a** It is right: the formula is exact, and 2 000 flights are plenty.
# - **b** It is too narrow: the flights of one route resemble each other, and only 100 routes were drawn.
# - **c** It is too wide: the flights of one route resemble each other, so they scatter less.
# - **d** The one bad route is an outlier. She should leave it out first.

# %%
### BEGIN SOLUTION
# What counts is how many routes were drawn.
choice_1 = "b"
### END SOLUTION

# %%
exercises.check("13.1", choice_1)

# %% tags=["solution"]
assert exercises.check("13.1", choice_1)
counts = [18] + 12 * [1] + 87 * [0]
print("as if independent:", *(f"{1000 * end:.0f}" for end in share_interval(30, 2000)))
print("over routes:      ", *(f"{1000 * end:.0f}" for end in grouped_share_interval(counts, 20)))

# %% [markdown] tags=["solution"]
# More than half of the crashes lie on one pair. Another hundred pairs may hold no such pair, or three. So what we know
# of the mean rate is what a hundred routes tell, and the honest interval goes from 4 to 50 per 1 000. *c* turns it
# round: flights that resemble each other repeat what we know already. *d* throws away what we want to know.

# %% [markdown]
# ## 13.2 What accelerates a UAV?
#
# *Warm-up · 10 minutes*
#
# Write the acceleration of the point mass, Eq. 2 of the chapter. `thrust` [N], `wind` (with its gust) and `velocity`
# [m/s] are arrays (east, north, up); `mass` is in kg, `drag_area` is $C_D A$ in m². $g = 9.81$ m/s², $\rho = 1.225$
# kg/m³.


# %%
def acceleration(thrust, wind, velocity, mass, drag_area):
    """Acceleration (3,) of a UAV in moving air [m/s²]."""
    ### BEGIN SOLUTION
    stream = wind - velocity
    drag = 0.5 * 1.225 * drag_area * np.linalg.norm(stream) * stream
    return (thrust + drag) / mass - np.array([0.0, 0.0, 9.81])
    ### END SOLUTION


# %%
exercises.check("13.2", acceleration)

# %% tags=["solution"]
assert exercises.check("13.2", acceleration)
hover, still = np.array([0.0, 0.0, 1.75 * 9.81]), np.zeros(3)
for wind in ((6.0, 0.0, 0.0), (9.0, 0.0, 0.0), (-9.0, 9.0, 0.0)):
    print(wind, acceleration(hover, np.array(wind), still, 1.75, 0.06).round(2))

# %% [markdown] tags=["solution"]
# Drag belongs to the air *relative* to the drone, so it is that of `wind - velocity`, and points along it. Its size
# goes with the square of that vector's length: once as the length, once as the vector itself. If each component were
# squared on its own, the drag would depend on how the axes are turned. Forces are divided by the mass; $g$ is an
# acceleration already.

# %% [markdown]
# ## 13.3 How sure is a crash rate?
#
# *Code · 20 minutes*
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
exercises.check("13.3", crash_interval)

# %% tags=["solution"]
assert exercises.check("13.3", crash_interval)
for crashed, flights in ((0, 100), (0, 20_000), (1, 20_000), (20, 2000)):
    low, high = crash_interval(crashed, flights)
    print(f"{crashed:2d} of {flights:6,}: {1000 * low:.3g} to {1000 * high:.3g} per 1 000")

# %% [markdown] tags=["solution"]
# Count the flights that didn't crash: there are $n - k$ of them. The lower end of *their* share is the quantile 0.025
# of a beta distribution with $a = n - k$, $b = k + 1$. One minus it is the upper end for the crashes: the quantile
# 0.975 with $a = k + 1$, $b = n - k$. Where none crashed, no probability is too small, so the lower end is 0. The upper
# one is still far from 0: after 100 flights without a crash it is 36 per 1 000.

# %% [markdown]
# ## 13.4 Not more than one of a thousand
#
# *Code · 20 minutes*
#
# A UAV flies beside a wall for `seconds`, its offsets are those of Eq. 1 with `sigma` [m] and $\omega_n = 1$ rad/s. How
# far from the wall does the *route* have to be, so that the expected number of touches is `allowed` (0.001, say)?
# Take the crossings per second from Rice's formula (chapter [02](../02_pauta.ipynb), Eq. 14) with the room $u$ between
# body and wall.
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
exercises.check("13.4", distance_to_keep)

# %% tags=["solution"]
assert exercises.check("13.4", distance_to_keep)
for seconds in (1.0, 8.0, 60.0, 600.0):
    print(f"{seconds:5g} s beside the wall: {distance_to_keep(1.0, seconds, 0.001, 0.5):.2f} m; Pauta says 3.5 m")

# %% [markdown] tags=["solution"]
# In all the seconds $t$ there are $\nu t = \frac{\omega_n t}{2\pi}\,e^{-u^2/2\sigma^2}$ touches to be expected. We set
# this equal to what is allowed and take logarithms: $u = \sigma\sqrt{2\ln(\omega_n t/2\pi p)}$, with $p$ allowed
# touches. If no more than $p$ are expected with no room at all, the body's radius is enough. A hundred times the time
# costs less than a metre, since the exponential is so steep.

# %% [markdown]
# ## 13.5 How long must a gust last?
#
# *Experiment · 20 minutes*
#
# The drone with the light load hovers in a wind of 9 m/s, with gusts of $\sigma_u = 4$ m/s. The longer the gusts last,
# the farther they push. **For which memory $\tau_u$ is $\sigma$ along the wind just 1 m?** Find it to within 0.03 s.
# `sigma_along` gives $\sigma$ by Eq. 7. Scan, halve an interval again and again, or solve. Guess first: will $\sigma$
# grow without end?


# %%
def sigma_along(memory):
    """σ of the offset along the wind [m], for gusts with this memory [s]."""
    wind = Wind((9.0, 0.0), deviation=4.0, correlation=memory)
    return offset_sigma(LIGHT_QUADROTOR.loaded(0.25), wind)[0]


for memory in (0.5, 5.0, 50.0):
    print(f"memory {memory:g} s: σ = {sigma_along(memory):.2f} m")

# %%
### BEGIN SOLUTION
short, long = 0.5, 5.0  # below a metre, above it
while long - short > 0.001:
    halfway = (short + long) / 2
    if sigma_along(halfway) < 1.0:
        short = halfway
    else:
        long = halfway
memory_for_a_metre = long
### END SOLUTION

# %%
exercises.check("13.5", memory_for_a_metre)

# %% tags=["solution"]
assert exercises.check("13.5", memory_for_a_metre)
gamma = 1.225 * 0.06 * 9.0 / 1.75
print(f"{memory_for_a_metre:.2f} s; for gusts that last for ever σ = γ σ_u / ω_n² = {gamma * 4.0:.2f} m")

# %% [markdown] tags=["solution"]
# At first $\sigma$ grows fast, then it levels off. A gust that lasts much longer than the spring needs is a steady
# push. Then the drone stands off by $\gamma\,u/\omega_n^2$ ($\gamma$ of Eq. 5), so that $\sigma$ can't exceed
# $\gamma\,\sigma_u/\omega_n^2 = 1.51$ m.
# A very short gust is over before the drone has moved: for $\tau_u \to 0$ the spectrum becomes flat and low, and
# $\sigma$ goes with $\sqrt{\tau_u}$.

# %% [markdown]
# ## 13.6 Out of the notch in a storm
#
# *Open · 40 minutes*
#
# The chapter's storm blows with 9 m/s from the west, with gusts of 4 m/s that last 3 s, and GPS drifts. **Find a route
# out of the notch**, from (90, 18, 30) to (50, 44, 30), that is no longer than REPARE's and crashes **at most a third**
# as often. Hand over a `Route`: from a planner, with settings of your choice, or by points of your own. The check flies
# yours and REPARE's 1 000 times with numbers of its own. It also wants the two intervals to lie apart. `flown_in_storm`
# shows how a route does. Which planners and settings of the course keep distance where it is cheap?


# %%
city, ends = table1_city(), ((90, 18, 30), (50, 44, 30))
storm = Wind((9.0, 0.0), deviation=4.0, correlation=3.0)


def flown_in_storm(route, flights=500):
    """Length, and crashes of flights with drifting GPS."""
    runs = monte_carlo(
        route, city, LIGHT_QUADROTOR.loaded(0.25), storm, Autopilot(), rng=1, flights=flights, time_step=0.04
    )
    return f"{route.length:.2f} m, crashes {crash_rate(runs)}"


print("REPARE:", flown_in_storm(repare(city, *ends)))

# %%
### BEGIN SOLUTION
safer_route = hazard_astar(city, *ends, sigma=1.2)
### END SOLUTION

# %%
exercises.check("13.6", safer_route)

# %% tags=["solution"]
assert exercises.check("13.6", safer_route)
for sigma in (0.8, 1.0, 1.2, 1.5):
    print(f"hazard A*, σ = {sigma:g} m:", flown_in_storm(hazard_astar(city, *ends, sigma=sigma)))

# %% [markdown] tags=["solution"]
# Hazard A* isn't bound to 26 directions, so its route is shorter than REPARE's at the same distance from walls. This
# length can be spent on distance, by telling it a larger $\sigma$. That isn't cheating: in the storm with drifting GPS
# the offsets across have $\sigma = 1.3$ m, and not the metre that REPARE was planned for. With 1.5 m the route is
# nearly free of crashes, but longer than REPARE's. `theta_star` with `min_clearance=5` does it, too.
