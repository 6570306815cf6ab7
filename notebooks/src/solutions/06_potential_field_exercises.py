# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 06 The potential field: exercises
#
# They belong to the notebook [06 The potential field](../06_potential_field.ipynb). Put your answer in the place of
# `raise NotImplementedError`, run the cell and then the check below it. The check says what is right, or what is wrong
# and what to think about; ask it as often as you like.

# %%
import numpy as np

from uavlab import exercises

# %% [markdown]
# ## 06.2 The push of one voxel
#
# An obstacle is a cube with edges of 1 m; `low` is its lowest corner, so it reaches to `low + 1` on all three axes. It
# pushes a UAV at `point` away from the point of the cube that is nearest to it, with the size
#
# $$ k_\text{rep} \left(\frac1D - \frac1R\right) \frac1{D^2} $$
#
# within the reach $R$, and not at all beyond. Return the force as a vector (3,). The UAV is never inside of the cube.


# %%
def push_of_voxel(point, low, push, reach):
    """Force on a UAV at a point, (3,)."""
    ### BEGIN SOLUTION
    point, low = np.asarray(point, dtype=float), np.asarray(low, dtype=float)
    away = point - np.clip(point, low, low + 1)
    distance = np.linalg.norm(away)
    if distance > reach:
        return np.zeros(3)
    return push * (1 / distance - 1 / reach) / distance**2 * away / distance
    ### END SOLUTION


# %%
exercises.check("06.2", push_of_voxel)

# %% tags=["solution"]
assert exercises.check("06.2", push_of_voxel)
print("2 m east of a voxel:", push_of_voxel((3.0, 0.5, 0.5), (0, 0, 0), push=5.0, reach=5.0))

# %% [markdown]
# ## 06.3 Where a wall stops the UAV
#
# The goal lies behind a wall, straight across. The wall pushes from its nearest point alone, with the size above, and
# the goal pulls with the constant size `pull`. Return the distance from the wall at which the two cancel [m]. Any
# method will do, with an error below a micrometre. (The push falls all the way from infinity to 0 at `reach`.)


# %%
def balance(pull, push, reach):
    """Distance from the wall at which pull and push cancel [m]."""
    ### BEGIN SOLUTION
    near, far = 0.0, reach  # the push wins at the one, the pull at the other
    for _ in range(100):
        middle = (near + far) / 2
        if push * (1 / middle - 1 / reach) / middle**2 > pull:
            near = middle
        else:
            far = middle
    return near
    ### END SOLUTION


# %%
exercises.check("06.3", balance)

# %% tags=["solution"]
assert exercises.check("06.3", balance)
for push in (5.0, 500.0, 50_000.0):
    print(f"k_rep = {push:>7,.0f}, R = 5 m: it stops {balance(1.0, push, 5.0):.2f} m from the wall")

# %% [markdown]
# ## 06.4 The best move
#
# On the lattice the UAV takes the move that points best along the force. `force` is a vector (3,), `moves` a list of
# the legal moves, each `(i, j, k)` with parts $-1$, $0$ or $1$. Return the move whose *direction* makes the smallest
# angle with the force, or `None` when no legal move has an angle below 90°. The check knows no ties. Beware: the moves
# aren't equally long.


# %%
def best_move(force, moves):
    """The legal move with the smallest angle to the force; None when all lead sideways or back."""
    ### BEGIN SOLUTION
    best, most_along = None, 0.0
    for move in moves:
        along = np.dot(force, move) / np.linalg.norm(move)
        if along > most_along:
            best, most_along = move, along
    return best
    ### END SOLUTION


# %%
exercises.check("06.4", best_move)

# %% tags=["solution"]
assert exercises.check("06.4", best_move)
print("force (3, 1, 0):", best_move((3, 1, 0), [(1, 0, 0), (1, 1, 0), (1, 1, 1), (0, 1, 0)]))
