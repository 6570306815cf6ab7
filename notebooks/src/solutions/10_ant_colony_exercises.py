# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 10 Ant colony: exercises
#
# They belong to the notebook [10 Ant colony](../10_ant_colony.ipynb). Put your answer in the place of
# `raise NotImplementedError`, run the cell and then the check below it. The check says what is right, or what is wrong
# and what to think about; ask it as often as you like.

# %%
import numpy as np

from uavlab import exercises

# %% [markdown]
# ## 10.1 The roulette, in logarithms
#
# Write the probabilities with which an ant goes to its neighbours: Eq. 2 of the notebook, computed by Eq. 3.
# `pheromone` and `visibility` are arrays with one number per neighbour. It has to work for $\beta = 500$, and for
# trails that have almost vanished. (One may have vanished altogether, $\tau = 0$: NumPy's `log` gives −inf, with a
# warning, and that is right. At least one neighbour always has some.)


# %%
def odds(pheromone, visibility, alpha, beta):
    """Probability of each neighbour."""
    ### BEGIN SOLUTION
    logs = alpha * np.log(pheromone) + beta * np.log(visibility)
    weights = np.exp(logs - logs.max())
    return weights / weights.sum()
    ### END SOLUTION


# %%
exercises.check("10.1", odds)

# %% tags=["solution"]
assert exercises.check("10.1", odds)
for beta in (2, 12, 80):
    print(f"β = {beta}:", odds(np.ones(3), 1 / np.array([27.0, 28.0, 29.0]), 1.0, beta).round(3))

# %% [markdown]
# ## 10.2 Evaporate, lay, limit
#
# Write the pheromone after one generation: Eq. 4. `pheromone` has one number per node; `ways` are lists of node
# numbers, one per ant that arrived, without a node twice in a way; `lengths` are their lengths $L_k$ [m]. Return a
# new array. For four nodes with $\tau = 10$, the ways `[[0, 1], [0, 2]]` of 20 and 50 m, $\rho = 0.8$, $Q = 100$ and
# limits 0 and 15 it is 9, 7, 4, 2.


# %%
def update(pheromone, ways, lengths, evaporation, deposit, least, most):
    """Pheromone of each node after a generation."""
    ### BEGIN SOLUTION
    after = (1 - evaporation) * pheromone
    for way, length in zip(ways, lengths, strict=True):
        after[way] += deposit / length
    return np.clip(after, least, most)
    ### END SOLUTION


# %%
exercises.check("10.2", update)

# %% tags=["solution"]
assert exercises.check("10.2", update)
pheromone = np.array([15.0, 15.0])
for _ in range(30):  # ten ants over node 0, none over node 1
    pheromone = update(pheromone, [[0]] * 10, [150.0] * 10, 0.8, 100.0, 0.0, 15.0)
print(f"after 30 generations {pheromone[0]:.3f} and {pheromone[1]:.1e}; Eq. 7 has {10 * 100 / (0.8 * 150):.3f}")

# %% [markdown]
# ## 10.3 When does τ_max bind?
#
# All `ants` of every generation pass one node, on ways of the same `length` [m]. Its pheromone is `first` at the
# beginning and follows Eq. 4, without limits. After how many generations is it at τ_max, `most`, or above, for the
# first time? 0 if it is there from the beginning; `None` if it never will be. (Think before you write a loop: when
# would it never end?)


# %%
def generations_until_capped(first, ants, deposit, length, evaporation, most):
    """How many generations until the pheromone reaches τ_max; None if it never does."""
    ### BEGIN SOLUTION
    gain = ants * deposit / length
    if first < most and evaporation > 0 and gain / evaporation <= most:  # it comes to rest below, or just there
        return None
    generations, pheromone = 0, first
    while pheromone < most:
        pheromone = (1 - evaporation) * pheromone + gain
        generations += 1
    return generations
    ### END SOLUTION


# %%
exercises.check("10.3", generations_until_capped)

# %% tags=["solution"]
assert exercises.check("10.3", generations_until_capped)
for evaporation in (0.1, 0.2, 0.4, 0.44, 0.45, 0.8):
    print(f"ρ = {evaporation}:", generations_until_capped(0.05, 10, 100.0, 150.0, evaporation, 15.0))
