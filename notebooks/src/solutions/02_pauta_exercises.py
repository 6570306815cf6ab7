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
# They belong to the chapter [02 The Pauta criterion](../02_pauta.ipynb). Put your answer in the place of
# `raise NotImplementedError` or of the dots, run the cell and then the check below it. The check says what is right, or
# what is wrong and what to think about. Ask it as often as you like.

# %%
import math

import numpy as np

from uavlab import exercises, offsets, plot

# %% [markdown]
# ## 02.1 What does 3σ promise?
#
# *Warm-up · 5 minutes*
#
# A route passes a single wall. The room between the body and the wall is exactly $3\sigma$ of the offset across the
# route, which is Gaussian with mean 0. Which sentence is true?
#
# - **a** 99.73 % of all flights along this wall don't touch it.
# - **b** At a moment that we pick at random, the chance to be in the wall is 0.135 %.
# - **c** At a moment that we pick at random, the chance to be in the wall is 0.27 %.
# - **d** The UAV never touches the wall, because what lies beyond $3\sigma$ is a gross error.

# %%
### BEGIN SOLUTION
choice_1 = "b"
### END SOLUTION

# %%
exercises.check("02.1", choice_1)

# %% [markdown] tags=["solution"]
# The share 99.73 % counts moments, on one axis, on both sides. The wall stands on one side, so half of the missing
# 0.27 % remains. For a whole flight we need to know how long it lasts and how fast the offset changes (Eq. 15).

# %% [markdown]
# ## 02.2 How much does the plane hold?
#
# *Warm-up · 10 minutes*
#
# Offsets on two axes are Gaussian and independent, with mean 0 and the same $\sigma$. Write the probability, from 0 to
# 1, that the offset lies within a circle of $k\sigma$ around the route. On one axis it would be
# $\operatorname{erf}(k/\sqrt 2)$.


# %%
def coverage_in_the_plane(k):
    """Probability that an offset in the plane lies within a circle of k standard deviations."""
    ### BEGIN SOLUTION
    return 1 - math.exp(-(k**2) / 2)
    ### END SOLUTION


# %%
exercises.check("02.2", coverage_in_the_plane)

# %% tags=["solution"]
assert exercises.check("02.2", coverage_in_the_plane)
print(f"3σ holds {coverage_in_the_plane(3):.3%}")

# %% [markdown] tags=["solution"]
# The ring from $s$ to $s + ds$ has the area $2\pi s\,ds$, and the density on it is $e^{-s^2/2}/2\pi$. The product
# $s\,e^{-s^2/2}$ is the derivative of $-e^{-s^2/2}$, so the integral from 0 to $k$ is $1 - e^{-k^2/2}$. It is one of the few
# cases in which more dimensions make a formula simpler.

# %% [markdown]
# ## 02.3 The distance to keep, in the plane and with wind
#
# *Code · 15 minutes*
#
# Write the least distance between route and wall [m] for a UAV that gusts push about in the plane, with the same
# `sigma` [m] on both axes. A circle of $k\sigma$ around the route is to hold 99.73 % of the offsets, in whatever
# direction they point. The steady wind holds the UAV off its route by `mean_offset` (east, north) [m]. `normal` is a
# unit vector that points away from the wall. Wind towards the wall makes the distance larger. Wind away from it doesn't
# make it smaller, because it may drop.
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

# %% [markdown] tags=["solution"]
# We solve $1 - e^{-k^2/2} = P$ for $k$: $k = \sqrt{-2\ln(1 - P)}$. The body reaches half its diameter from its centre.
# `np.dot(mean_offset, normal)` is how far the wind holds the UAV *away* from the wall. Where that is negative, we add as
# much. A circle is more than a single wall needs: towards one wall, 3σ would leave out 0.135 %. The circle is the answer
# when walls may stand anywhere.

# %% [markdown]
# ## 02.4 How long beside the wall?
#
# *Code · 20 minutes*
#
# Turn the first formula of Eq. 15 round. For how many seconds may a UAV fly beside a wall, so that the chance to touch
# it isn't above `chance`? Given are the `distance` between route and wall [m], `uav_diameter` [m], the `sigma` of the
# offset [m] and the natural frequency `omega` of the position control [rad/s]. There is no wind. If the chance is too
# large even for one moment, return 0.
#
# At 5.23 m, with a body of 1 m, $\sigma = 1$ m, 1 rad/s and a chance of 0.00135, the answer is about 611 s.


# %%
def longest_time(distance, uav_diameter, sigma, omega, chance):
    """How long a UAV may fly beside a wall [s], so that it touches it with at most this chance."""
    ### BEGIN SOLUTION
    room = distance - uav_diameter / 2
    outside = 0.5 * (1 + math.erf(room / sigma / math.sqrt(2)))  # q = Φ(u/σ): not in the wall at the start
    rate = omega / (2 * math.pi) * math.exp(-(room**2) / (2 * sigma**2))
    if chance <= 1 - outside:
        return 0.0
    return outside / rate * math.log(outside / (1 - chance))
    ### END SOLUTION


# %%
exercises.check("02.4", longest_time)

# %% tags=["solution"]
assert exercises.check("02.4", longest_time)
for distance in (3.5, 4.0, 4.5, 5.0, 5.5):
    print(f"{distance} m: {longest_time(distance, 1.0, 1.0, 1.0, 0.01):8.1f} s until the chance is 1 %")

# %% [markdown] tags=["solution"]
# From $P = 1 - q\,e^{-\nu t/q}$ follows $e^{-\nu t/q} = (1 - P)/q$, so
#
# $$ t = \frac{q}{\nu}\,\ln\frac{q}{1 - P} . $$
#
# The logarithm is negative when $q < 1 - P$, that is, when the chance of one moment, $1 - q$, is above $P$ already.
# Look at the printed times: each half metre makes them six to eleven times as long. A little more
# distance buys very much time.

# %% [markdown]
# ## 02.5 How many errors does the filter bear?
#
# *Experiment · 20 minutes*
#
# The Pauta filter finds a single gross error among many samples. What if there are more of them, and all in the same
# place, because the sensor is stuck there? The cell below mixes good samples ($\sigma = 1$ m) with gross errors that all
# lie at `place`, and counts how many of the errors `offsets.pauta_filter` removes.
#
# *Predict first:* 5 % of 10 000 samples are wrong, all at 1000 m. Does the filter find them? And if it is 20 %?


# %%
def found(share, place=1000.0, count=10_000):
    """Share of the gross errors that the filter removes."""
    wrong = round(share * count)
    good = np.random.default_rng(25).normal(0.0, 1.0, count - wrong)
    kept = offsets.pauta_filter(np.append(good, np.full(wrong, place))).kept
    return 1 - kept[len(good) :].mean()


for share in (0.01, 0.05, 0.2, 0.4):
    print(f"{share:.0%} wrong: {found(share):.0%} of them found")

# %% [markdown]
# Somewhere in between the filter goes blind. From which share of wrong samples on, of *all* samples, does it find none
# of them? Vary `share` until you know it to half a per cent. Give it as a number from 0 to 1.

# %%
### BEGIN SOLUTION
blind_from = 0.10
### END SOLUTION

# %%
exercises.check("02.5", blind_from)

# %% tags=["solution"]
shares = np.linspace(0.02, 0.2, 37)
lines = {f"errors at {place:g} m": [100 * found(s, place) for s in shares] for place in (10.0, 1000.0)}
plot.lines(100 * shares, lines, "wrong samples, of all [%]", "errors that the filter finds [%]", places={"10 %": 10},
           title="From one in ten on, the Pauta filter is blind")  # fmt: skip

# %% [markdown] tags=["solution"]
# Let a share $p$ of the samples lie at a place $a$ that is far away, and the rest near 0. The mean is $pa$. The variance is
# $p\,(a - pa)^2 + (1-p)\,(pa)^2 = p\,(1-p)\,a^2$ (the good samples add next to nothing). So the errors are
#
# $$ \frac{a - pa}{\sqrt{p(1-p)}\,a} = \sqrt{\frac{1-p}{p}} $$
#
# standard deviations from the mean. That is 3 or less as soon as $p \ge 1/10$, however large $a$ is. It is the same "one in
# ten" as that of Eq. 4. (For errors at 10 m the good samples count, too, and the filter goes blind a little earlier.)
# A filter that measures from the *median*, and takes for its scale the median of the deviations from it (the *median
# absolute deviation*), bears up to half of the samples.

# %% [markdown]
# ## 02.6 A route through a street
#
# *Open · 30 minutes*
#
# A street runs north. It is 300 m long and 12 m wide, with a wall on each side. A UAV of 1 m has to fly through it. The
# offset across the street has $\sigma = 1.2$ m and $\omega_n = 1$ rad/s. A steady wind holds the UAV 1 m to the *east* of
# its route.
#
# Design the route: choose `from_west`, the distance of the route from the western wall [m], and `speed` [m/s], at most
# 5 m/s. The chance to touch either wall during the flight is to be at most 1 in 1000. The check adds the chances of both
# walls by Eq. 15. Your tool is `offsets.collision_probability(distance, sigma, duration,
# natural_frequency, uav_diameter=..., mean_away=...)`; look it up with `help`.
#
# There are many right answers. Once yours is right: which is the slowest speed for which there is one?

# %%
### BEGIN SOLUTION
from_west, speed = 5.0, 4.0
plan = (from_west, speed)
### END SOLUTION

# %%
exercises.check("02.6", plan)


# %% tags=["solution"]
def chance(from_west, speed):
    """Chance to touch one of the walls: an upper bound."""
    west, east = (
        offsets.collision_probability(distance, 1.2, 300.0 / speed, 1.0, uav_diameter=1.0, mean_away=away)
        for distance, away in ((from_west, 1.0), (12.0 - from_west, -1.0))
    )
    return west + east


where = np.linspace(4.0, 6.5, 251)
chances = {f"{v:g} m/s": [1000 * chance(x, v) for x in where] for v in (2.7, 4.0, 5.0)}
print(f"5 m from the west, 4 m/s: {1000 * chance(5.0, 4.0):.2f} in 1000; in the middle {1000 * chance(6.0, 4.0):.0f}")
plot.lines(where, chances, "route's distance from the western wall [m]", "flights that touch, of 1000", log="y",
           limits={"allowed": 1.0}, title="The best route isn't in the middle of the street")  # fmt: skip

# %% [markdown] tags=["solution"]
# The wind moves the UAV 1 m to the east, so the route has to lie 1 m to the *west* of the middle, at 5 m: then the UAV is
# in the middle. The room on each side is $6 - 0.5 = 5.5$ m, or $4.58\sigma$. In the middle of the street only $3.75\sigma$ would
# be left in the east, and 11 of 1000 flights would touch.
#
# The second choice is the speed. A slower flight is longer, and the chance grows in proportion to the time. At 5 m from
# the west wall it reaches 1 in 1000 at about 2.6 m/s. Flying faster widens the choice of routes, but even at 5 m/s it is only
# a third of a metre to either side.
