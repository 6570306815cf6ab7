# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 11 Particle swarm and beetles: exercises
#
# They belong to the notebook [11 Particle swarm and beetles](../11_particle_swarm_and_beetles.ipynb). Put your answer in
# the place of `raise NotImplementedError` or of the dots, run the cell and then the check below it. The check says what
# is right, or what is wrong and what to think about; ask it as often as you like.

# %%
from functools import partial

import numpy as np

from uavlab import exercises
from uavlab.optimizers import bas, pso, pso_bas
from uavlab.risk import CAMPUS_FLIGHT, reference_campus
from uavlab.route import Route
from uavlab.spline import cubic_bspline
from uavlab.statistics import share_interval

# %% [markdown]
# ## 11.1 What does a mean of 0 say?
#
# *Warm-up · 5 minutes*
#
# A swarm has $\omega = 0.9$, $c_1 = 1.5$ and $c_2 = 2$. By Eq. 4 of the chapter the mean of $x$ dies out. A friend
# concludes: "So each particle comes to rest at the best point." What do you answer?
#
# - **a** You are right: a mean of 0 says that all particles are at the best point.
# - **b** The mean is only the balance of both sides. The particles may jump farther and farther, to both sides alike.
# - **c** Eq. 4 isn't fulfilled here, so the mean doesn't die out.
# - **d** Eq. 4 is true for one coordinate. A route has 21 coordinates, and then it needs 21 times smaller pulls.

# %%
### BEGIN SOLUTION
# The mean square has to die out: Eq. 6, not Eq. 4.
choice_1 = "b"
### END SOLUTION

# %%
exercises.check("11.1", choice_1)

# %% tags=["solution"]
assert exercises.check("11.1", choice_1)

# %% [markdown] tags=["solution"]
# Two particles at −100 and 100 have a mean of 0. Distances are measured by $E[x^2]$, whose recursion also contains the
# variance of the pull. At $\omega = 0.9$ the root mean square grows by 9.5 % in a step, and even half of the particles
# move away, by 1.4 % in a step.
#
# *a* takes the mean of many particles for the place of each. *c*: $0.9 < 1$ and $3.5 < 4 \cdot 1.9$, so Eq. 4 holds.
# *d*: each coordinate follows Eq. 3 by itself, so the number of coordinates doesn't enter.

# %% [markdown]
# ## 11.2 One step of a beetle
#
# *Warm-up · 10 minutes*
#
# A beetle stands at `x`, an array of shape (D,). It looks along the random vector `b` (D,), which may have any length:
# only its direction counts. It smells at both tips, $d$ (`reach`) away from its body. Then it walks $\delta$ (`step`)
# towards the side where the function `f` is **less** (Eq. 7 of the chapter). If both sides smell the same, it stays. `f`
# takes one point (D,) and returns a number. Return where the beetle stands then; leave `x` itself as it is.


# %%
def walk(f, x, b, reach, step):
    """Where the beetle stands after a step, (D,)."""
    ### BEGIN SOLUTION
    direction = b / np.linalg.norm(b)
    left, right = f(x + reach * direction), f(x - reach * direction)
    return x - step * direction * np.sign(left - right)
    ### END SOLUTION


# %%
exercises.check("11.2", walk)

# %% tags=["solution"]
assert exercises.check("11.2", walk)
x, rng = np.array([3.0, 4.0]), np.random.default_rng(10)
for made in range(41):
    if made % 10 == 0:
        print(f"after {made:2d} steps {np.linalg.norm(x):.3f} from the least of a bowl")
    x = walk(lambda point: point @ point, x, rng.normal(size=2), 0.3 * 0.95**made, 0.3 * 0.95**made)

# %% [markdown] tags=["solution"]
# The difference `left - right` is positive where the left side is worse. Then its sign is 1, and the minus leads to the
# right. `np.sign(0)` is 0, so the beetle stays between two equal sides. The steps get shorter, and all together they
# are at most $0.3 / 0.05 = 6$.

# %% [markdown]
# ## 11.3 One step of a swarm
#
# *Code · 20 minutes*
#
# Move $N$ particles in $D$ dimensions by one step of Eq. 2. `x`, `v` and `best` have shape (N, D): where the particles
# are, how fast, and where each was best. `leader` (D,) is where the swarm was best. `r1` and `r2` (N, D) are random
# numbers from 0 to 1, drawn for you. $c_1 = 1.5$ and $c_2 = 2$. No part of a velocity may exceed `v_max` in either
# direction. No particle may leave the box from `low` to `high`: it stops at the border. Return the new positions and the
# velocities with which the particles flew there (at the border, too).


# %%
def fly(x, v, best, leader, inertia, r1, r2, v_max, low, high):
    """Positions and velocities after one step, (N, D) each."""
    ### BEGIN SOLUTION
    v = inertia * v + 1.5 * r1 * (best - x) + 2.0 * r2 * (leader - x)
    v = np.clip(v, -v_max, v_max)
    return np.clip(x + v, low, high), v
    ### END SOLUTION


# %%
exercises.check("11.3", fly)

# %% tags=["solution"]
assert exercises.check("11.3", fly)
one = np.ones((1, 1))
for v_max in (10.0, 1.0):
    x, v = fly(0 * one, one, 2 * one, np.array([4.0]), 0.9, 0.5 * one, 0.5 * one, v_max, -5.0, 5.0)
    print(f"v_max = {v_max:g}: from 0 to {x[0, 0]:g}, v = {v[0, 0]:g}")

# %% [markdown] tags=["solution"]
# The order matters: first the new velocity, then its limit, then the place. `leader` has one row less than `x`; NumPy
# repeats it for each particle. Note that `v = …` makes a new array. `v *= inertia` would change the caller's.

# %% [markdown]
# ## 11.4 Is one planner better than another?
#
# *Code · 25 minutes*
#
# `ours` and `theirs` (M, S) are gaps of two planners on the same $M$ maps, with the same $S$ seeds on each. A run that
# didn't arrive has an infinite gap. Return three numbers: the share of runs in which ours has the smaller gap (a tie
# counts half, also where neither arrived), and the two ends of its 95 % interval. The seeds of a map aren't independent:
# a map that is good for ours is so for every seed. So take a *bootstrap over the maps*. Draw $M$ maps with replacement,
# all seeds of a map with it, and take the share. Do so 2 000 times with `rng`. The ends are the 2.5 % and the 97.5 %
# quantile of these shares.


# %%
def share_of_wins(ours, theirs, rng):
    """Share of runs that ours wins, and both ends of its 95 % interval."""
    ### BEGIN SOLUTION
    won = np.where(ours == theirs, 0.5, ours < theirs)
    maps = len(won)
    shares = [won[rng.integers(maps, size=maps)].mean() for _ in range(2000)]
    return won.mean(), *np.quantile(shares, [0.025, 0.975])
    ### END SOLUTION


# %%
exercises.check("11.4", share_of_wins)

# %% tags=["solution"]
assert exercises.check("11.4", share_of_wins)
rng = np.random.default_rng(10)
of_the_map = rng.normal(0.5, 2.0, (12, 1))  # how much better ours is there, in the mean [%]
theirs = rng.exponential(8.0, (12, 10))
ours = theirs - of_the_map - rng.normal(0.0, 1.0, (12, 10))
print("{:.0%} of 120 runs on 12 maps, [{:.0%}, {:.0%}]".format(*share_of_wins(ours, theirs, rng)))
print("won on all 12 maps: bootstrap", *share_of_wins(theirs - 1, theirs, rng)[1:], end="; ")
print("exact [{:.0%}, {:.0%}]".format(*share_interval(12, 12)))

# %% [markdown] tags=["solution"]
# `won[drawn]` takes whole rows, so all seeds of a map come along. If ours wins every run on every map, each bootstrap
# share is 1 and the interval has no width, as if you were sure. You aren't: 12 of 12 maps agree with any true share of
# maps above 74 %. There take the exact binomial interval, with one count per map. The chapter has one run per map, so it
# can always take that.

# %% [markdown]
# ## 11.5 What does an optimiser do with an error of its cost?
#
# *Experiment · 25 minutes*
#
# Usually the cost of a curve is *sampled*: the curve is drawn as straight legs, and each leg gets the risk of the voxel
# in which its middle lies. That is `sampled` below. `exact` integrates Eq. 1 voxel by voxel, along the same legs. With
# `legs=4` a leg is about as long as a voxel, and for a curve that nobody has optimised the two hardly differ. Now let
# `pso_bas` make the *sampled* cost small, as in the last line of the cell, for the seeds 0 to 4. For each seed compute
# the claimed cost `best.value` over the exact cost of `best.best`, less 1. Hand over the median of the five. Predict
# first: will it be 0?

# %%
campus = reference_campus()
city = campus.city
ends = city.center_of(city.cell_of(CAMPUS_FLIGHT))
low, high = city.bounds[0], city.bounds[1] - 1e-6
box = np.tile(np.stack([low, high], axis=1), (7, 1))  # seven waypoints, 21 coordinates


def curves(x, legs):
    """Curves (N, P, 3) with so many legs on each of 8 segments, from points (N, 21)."""
    first, last = (np.broadcast_to(end, (len(x), 1, 3)) for end in ends)
    return np.clip(cubic_bspline(np.concatenate([first, x.reshape(-1, 7, 3), last], axis=1), legs), low, high)


# %%
def sampled(x, legs=4):
    """Costs (N,) by the middles of the legs; where the UAV may not fly, more than any route's."""
    lines = curves(x, legs)
    i, j, k = np.moveaxis(city.cell_of((lines[:, 1:] + lines[:, :-1]) / 2), -1, 0)
    metres = np.linalg.norm(np.diff(lines, axis=1), axis=-1)
    return (campus.rate[i, j, k] * metres).sum(axis=1) / city.cell + 1e-2 * (~campus.flyable[i, j, k]).mean(axis=1)


def exact(x, legs=4):
    """Cost of one curve, x (21,)."""
    return campus.integral(Route(curves(x[None], legs)[0], "curve"))


# %%
def first_curves(seed):
    """20 points (20, 21): curves beside the straight line."""
    rng = np.random.default_rng(seed)
    line = np.linspace(*ends, 9)[1:-1]
    beside = np.concatenate([rng.normal(0, 15, (20, 7, 2)), np.abs(rng.normal(0, 6, (20, 7, 1)))], axis=2)
    return np.clip(line + beside, low, high).reshape(20, 21)


def optimised(seed, legs=4):
    cost = partial(sampled, legs=legs)
    return pso_bas(cost, box, 3000, seed, start=first_curves(seed), probes=5, decay=0.98, block=3)


best = optimised(seed=0)

# %%
claim = ...  # your answer

### BEGIN SOLUTION
found = [optimised(seed) for seed in range(5)]
claim = np.median([best.value / exact(best.best) - 1 for best in found])
### END SOLUTION

# %%
exercises.check("11.5", claim)

# %% tags=["solution"]
assert exercises.check("11.5", claim)
for legs, about in ((14, "a quarter of a voxel"), (4, "a voxel"), (2, "two voxels")):
    before = [
        sampled(x[None], legs)[0] / exact(x, legs) - 1 for x in first_curves(0) if sampled(x[None], legs)[0] < 1e-3
    ]
    best = optimised(0, legs)
    print(f"legs of about {about}: not optimised {np.median(before):+.0%}, ", end="")
    print(f"optimised {best.value / exact(best.best, legs) - 1:+.0%}")

# %% [markdown] tags=["solution"]
# The optimised curves claim a third less than they cost. A sampled cost is the true cost plus an error, now positive,
# now negative. For a given curve the error is small in the mean. But an optimiser doesn't take a given curve: it looks
# for the least *sum* of truth and error, and finds curves whose samples just miss the risky voxels. Shorter legs help,
# but with legs of a quarter of a voxel some per cent are left. As long as two optimisers differ by a few per cent, such
# a cost rewards the one that cheats better. So the library integrates exactly.

# %% [markdown]
# ## 11.6 A swarm of your own
#
# *Open · 40 minutes*
#
# Write an optimiser that is better than the library's `pso` where a swarm is weak. `f` takes points of shape (N, 6) and
# returns N values. `box` (6, 2) has the lower and upper end of each coordinate. You may evaluate at most 4 000 points
# (`budget`), all within the box. Return the best point that you evaluated. The check takes two functions of the chapter,
# moved to a random place, with nine seeds each. In the *valley* your median value must be at most 0.7 of that of `pso`.
# Among the *holes* it may be at most twice that of `pso`. You may use `pso`, `bas` and `pso_bas`, or nothing of it.


# %%
def search(f, box, budget, rng):
    """The best point found, (6,)."""
    ### BEGIN SOLUTION
    rough = pso(f, box, int(0.6 * budget), rng)
    left = budget - len(rough.history)
    fine = bas(f, box, left, rng, start=rough.best, greedy=True, decay=None, antenna=0.05)
    return fine.best
    ### END SOLUTION


# %%
exercises.check("11.6", search)

# %% tags=["solution"]
assert exercises.check("11.6", search)

# %% [markdown] tags=["solution"]
# A swarm is good at finding the right hole, and slow along the bottom of a valley. A greedy beetle is the other way
# round. So the swarm gets 60 % of the budget, and a beetle begins at its best point with short antennae (a twentieth of
# the range), which then follow success. It evaluates its first point again and never leaves it for a worse one, so
# `fine.best` is the best of all. That is also the way of the chapter's planners: first a swarm, then a refinement.
