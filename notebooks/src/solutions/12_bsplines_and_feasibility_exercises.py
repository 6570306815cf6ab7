# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 12 B-splines and feasibility: exercises
#
# They belong to the notebook [12 B-splines and feasibility](../12_bsplines_and_feasibility.ipynb). Put your answer in
# the place of `raise NotImplementedError`, run the cell and then the check below it. The check says what is right, or
# what is wrong and what to think about; ask it as often as you like.

# %%
import numpy as np

from uavlab import exercises

# %% [markdown]
# ## 12.1 Curvature
#
# `first` and `second` (N, 3) are the first and second derivatives of a curve in space by a parameter, at $N$ places.
# Return the curvature at each, (N,) (Eq. 6 of the notebook). The parameter is any: it needn't be the distance flown,
# and the curve may run along it at an uneven pace.


# %%
def curvature(first, second):
    """Curvature κ (N,) [1/m] of a curve with these derivatives."""
    ### BEGIN SOLUTION
    across = np.cross(first, second)
    return np.linalg.norm(across, axis=1) / np.linalg.norm(first, axis=1) ** 3
    ### END SOLUTION


# %%
exercises.check("12.1", curvature)

# %% tags=["solution"]
assert exercises.check("12.1", curvature)
angle = np.linspace(0.0, 3.0, 4)
along = 5 * np.column_stack([-np.sin(angle), np.cos(angle), 0 * angle])
inwards = -5 * np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
print("on a circle of 5 m:", curvature(along, inwards), "1/m")

# %% [markdown]
# ## 12.2 Through the waypoints
#
# A B-spline passes its control points by (Eq. 2 of the notebook): at the knot of point $i$ it is at
# $(\mathbf P_{i-1} + 4\mathbf P_i + \mathbf P_{i+1})/6$. A UAV that takes pictures has to be *at* its waypoints.
# So turn it around: `waypoints` (N, D), N ≥ 3, are where the curve with phantom ends has to be at its knots; return the
# control points (N, D) that do it. (With phantom ends the curve begins at $\mathbf P_0$ and ends at
# $\mathbf P_{N-1}$. For those in between there are as many equations as unknown points: `numpy.linalg.solve`.)


# %%
def control_points(waypoints):
    """Control points (N, D) of the B-spline with phantom ends whose knots are the waypoints (N, D)."""
    ### BEGIN SOLUTION
    count = len(waypoints)
    weights = (4 * np.eye(count) + np.eye(count, k=1) + np.eye(count, k=-1)) / 6
    weights[[0, -1]] = np.eye(count)[[0, -1]]
    return np.linalg.solve(weights, waypoints)
    ### END SOLUTION


# %%
exercises.check("12.2", control_points)

# %% tags=["solution"]
assert exercises.check("12.2", control_points)
waypoints = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [20.0, 10.0]])
print(control_points(waypoints).round(2).tolist())

# %% [markdown]
# ## 12.3 Slow only where it bends
#
# The notebook flies a curve at one speed, that of its sharpest bend. Better: as fast as each bend allows, and brake in
# time. `distance` (P,) is the distance flown to each point of a curve, rising; `allowed` (P,) the greatest speed at
# each [m/s]; `acceleration` the greatest acceleration and braking along the curve [m/s²], the same for both. The UAV
# begins and ends at rest. Return the speed at each point (P,), as fast as possible. Between two points it accelerates
# or brakes evenly, so that $v_2^2 - v_1^2 = 2 a s$ over a distance $s$. (One pass along the curve takes care of the
# acceleration. What takes care of the braking?)


# %%
def speeds(distance, allowed, acceleration):
    """Greatest speed at each point (P,) [m/s], from rest to rest."""
    ### BEGIN SOLUTION
    squared = np.square(allowed).astype(float)
    squared[[0, -1]] = 0.0
    gain = 2 * acceleration * np.diff(distance)
    for i in range(1, len(squared)):
        squared[i] = min(squared[i], squared[i - 1] + gain[i - 1])
    for i in range(len(squared) - 2, -1, -1):
        squared[i] = min(squared[i], squared[i + 1] + gain[i])
    return np.sqrt(squared)
    ### END SOLUTION


# %%
exercises.check("12.3", speeds)

# %% tags=["solution"]
from uavlab.planners import least_risk
from uavlab.risk import CAMPUS_FLIGHT, reference_campus
from uavlab.spline import Curve, allowed_speed

assert exercises.check("12.3", speeds)
curve = Curve(least_risk(reference_campus(), *CAMPUS_FLIGHT).points)
allowed = np.minimum(allowed_speed(curve.level_curvature), 16.0)
v = speeds(curve.distance, allowed, 3.0)
seconds = np.sum(2 * np.diff(curve.distance) / (v[1:] + v[:-1]))
print(f"exact route: {seconds:.1f} s, against {curve.length / allowed.min():.1f} s at the speed of its sharpest bend")
