# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 11 Particle swarm and beetle antennae: exercises
#
# They belong to the notebook [11 Particle swarm and beetle antennae](../11_particle_swarm_and_beetles.ipynb). Put your
# answer in the place of `raise NotImplementedError`, run the cell and then the check below it. The check says what is
# right, or what is wrong and what to think about; ask it as often as you like.

# %%
import numpy as np

from uavlab import exercises

# %% [markdown]
# ## 11.1 One step of a swarm
#
# Fly $N$ particles in $D$ dimensions one step on (Eq. 1 of the notebook). `x`, `v` and `best` are arrays (N, D), where
# they are, how fast, and where each was best; `leader` (D,) is where the swarm was best; `r1` and `r2` (N, D) are
# random numbers between 0 and 1, drawn for you. $c_1 = 1.5$, $c_2 = 2$. No part of a velocity may be larger than
# `v_max`, in either direction; and no particle may leave the box from `low` to `high`: it stops at the border. Return
# the new positions and the new velocities. (What becomes of the velocity at the border is up to you, and isn't asked
# for: return that with which the particle flew.)


# %%
def fly(x, v, best, leader, inertia, r1, r2, v_max, low, high):
    """Positions and velocities after one step, (N, D) each."""
    ### BEGIN SOLUTION
    v = inertia * v + 1.5 * r1 * (best - x) + 2.0 * r2 * (leader - x)
    v = np.clip(v, -v_max, v_max)
    return np.clip(x + v, low, high), v
    ### END SOLUTION


# %%
exercises.check("11.1", fly)

# %% tags=["solution"]
assert exercises.check("11.1", fly)
one = np.ones((1, 1))
for v_max in (10.0, 1.0):
    x, v = fly(0 * one, one, 2 * one, np.array([4.0]), 0.9, 0.5 * one, 0.5 * one, v_max, -5.0, 5.0)
    print(f"v_max = {v_max:g}: from 0 to {x[0, 0]:g}, v = {v[0, 0]:g}")

# %% [markdown]
# ## 11.2 One step of a beetle
#
# A beetle stands at `x` (D,), and looks along a random vector `b` (D,), drawn for you, of any length: only its
# direction counts. It smells at both tips, $d$ (`reach`) away from its body, and walks $\delta$ (`step`) towards the
# side where the function `f` is **less** (Eq. 6 of the notebook, PSO-BAS Eqs 17 to 19). If both sides smell the same it
# stays. `f` takes one point (D,) and returns a number. Return where it stands then. (`x` itself must stay as it is.)


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
for number in range(41):
    if number % 10 == 0:
        print(f"after {number:2d} steps {np.linalg.norm(x):.3f} from the least of a bowl")
    x = walk(lambda point: point @ point, x, rng.normal(size=2), 0.3 * 0.95**number, 0.3 * 0.95**number)

# %% [markdown]
# ## 11.3 Is one planner better than another?
#
# `ours` and `theirs` (M, S) are gaps of two planners on the same $M$ maps with the same $S$ seeds; a run that didn't
# arrive has an infinite gap. Return three numbers: the share of runs in which ours has the smaller gap (a tie counts
# half, also if neither arrived), and the two ends of its 95 % interval. The seeds of a map aren't independent of each
# other: a map that is good for ours is so for every seed. So take a *bootstrap over the maps*: draw $M$ maps with
# replacement, all their seeds with them, take the share; do so 2 000 times with `rng`; the ends are the 2.5 % and 97.5
# % quantiles of the shares.


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
exercises.check("11.3", share_of_wins)

# %% tags=["solution"]
assert exercises.check("11.3", share_of_wins)
rng = np.random.default_rng(10)
of_the_map = rng.normal(0.5, 2.0, (12, 1))  # how much better ours is there, in the mean [%]
theirs = rng.exponential(8.0, (12, 10))
ours = theirs - of_the_map - rng.normal(0.0, 1.0, (12, 10))
print("{:.0%} of 120 runs on 12 maps, [{:.0%}, {:.0%}]".format(*share_of_wins(ours, theirs, rng)))
