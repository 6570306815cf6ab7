# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 03 Predicting the disturbance: exercises
#
# They belong to the notebook [03 Predicting the disturbance](../03_predicting_the_disturbance.ipynb). Put your answer
# in the place of `raise NotImplementedError`, run the cell and then the check below it. The check says what is right,
# or what is wrong and what to think about; ask it as often as you like.

# %%
import math

import numpy as np
from scipy.stats import norm

from uavlab import exercises

# %% [markdown]
# ## 03.2 How often is a model too low?
#
# `true` and `predicted` are arrays of classes, one for each flight. Return the share of all flights whose class was
# predicted too low, from 0 to 1: those on which the planner kept too small a distance.


# %%
def under_prediction(true, predicted):
    """Share of all flights that were pushed further than predicted."""
    ### BEGIN SOLUTION
    return float(np.mean(np.asarray(predicted) < np.asarray(true)))
    ### END SOLUTION


# %%
exercises.check("03.2", under_prediction)

# %% tags=["solution"]
assert exercises.check("03.2", under_prediction)
print(f"{under_prediction([1, 2, 3, 4], [1, 3, 2, 4]):.0%} of the four flights")

# %% [markdown]
# ## 03.3 The most probable class
#
# The offset of a flight is $\xi = \tilde\xi\, e^{s\,\varepsilon}$ with a standard normal $\varepsilon$; `median` is
# $\tilde\xi$ in metres and `spread` is $s$. Class 1 holds all offsets up to 1 m, class 2 those above 1 and up to 2 m,
# and so on; the last one, `class_count`, holds all that is larger. Return the class with the highest probability. It
# is what the best possible model would say, and not always the median rounded up. (`norm.cdf` is $\Phi$.)


# %%
def most_probable_class(median, spread, class_count):
    """The class that an offset with this median and log-normal scatter most probably has."""
    ### BEGIN SOLUTION
    boundaries = np.log(np.arange(1, class_count))
    below = norm.cdf((boundaries - math.log(median)) / spread)
    probability = np.diff(below, prepend=0.0, append=1.0)
    return 1 + int(probability.argmax())
    ### END SOLUTION


# %%
exercises.check("03.3", most_probable_class)

# %% tags=["solution"]
assert exercises.check("03.3", most_probable_class)
print("median 4.6 m: class", most_probable_class(4.6, 0.3, 6), "of 6,", most_probable_class(4.6, 0.3, 12), "of 12")

# %% [markdown]
# ## 03.4 Can it be a count?
#
# A paper prints an accuracy of `percent`, rounded to three decimals, on a test of `samples` flights. If it is a share
# of them, some number of right answers $k$ gives exactly this figure: 100 k / samples, rounded to three decimals.
# Return that $k$, or `-1` if there is none.


# %%
def right_answers(percent, samples):
    """How many right answers out of `samples` are printed as this percentage, or -1 if no number is."""
    ### BEGIN SOLUTION
    k = round(percent / 100 * samples)  # if one fits, it is the nearest
    return k if abs(round(100 * k / samples, 3) - percent) < 1e-9 else -1
    ### END SOLUTION


# %%
exercises.check("03.4", right_answers)

# %% tags=["solution"]
assert exercises.check("03.4", right_answers)
for percent in (9.424, 59.426, 72.852):
    print(f"{percent} % of 1466:", right_answers(percent, 1466))
