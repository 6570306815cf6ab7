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
# the place of `raise NotImplementedError` or of the dots, run the cell and then the check below it. The check says what
# is right, or what is wrong and what to think about; ask it as often as you like.

# %%
import numpy as np

from uavlab import exercises, plot
from uavlab.city import City
from uavlab.route import Route
from uavlab.spline import Curve, feasibility, greatest_speed, smooth
from uavlab.vehicle import RISK_QUADROTOR

uav = RISK_QUADROTOR

# %% [markdown]
# ## 12.1 Below 1 of what?
#
# *Warm-up · 5 minutes*
#
# Two planners smooth their routes, and both report "curvature at most 0.8 per voxel". Planner A has voxels of 1 m,
# planner B of 10 m. All bends are level. A UAV wants to fly at 8 m/s with a bank of at most 30°, which allows 5.66 m/s²
# sideways. Leave drag aside. Whose route can it fly?
#
# - **a** Both: 0.8 is below 1.
# - **b** Only B's.
# - **c** Neither: $8^2 \cdot 0.8 = 51$ m/s² are far too much.
# - **d** Only A's: its voxels are smaller, so its curve is smoother.

# %%
### BEGIN SOLUTION
# A's sharpest bend has a radius of 1/0.8 = 1.25 m, B's of 12.5 m.
choice_1 = "b"
### END SOLUTION

# %%
exercises.check("12.1", choice_1)

# %% tags=["solution"]
assert exercises.check("12.1", choice_1)

# %% [markdown] tags=["solution"]
# We need $\kappa$ in 1/m. For A it is $0.8 / (1\ \text{m}) = 0.8$ 1/m, for B $0.8 / (10\ \text{m}) = 0.08$ 1/m. At 8
# m/s the bends ask for $64 \cdot 0.8 = 51$ and $64 \cdot 0.08 = 5.1$ m/s². Only the second is below 5.66.

# %% [markdown]
# ## 12.2 Curvature
#
# *Warm-up · 10 minutes*
#
# `first` and `second` (N, 3) are the first and second derivatives of a curve in three dimensions at $N$ places. Return
# the curvature $\kappa$ at each, (N,) (Eq. 6 of the chapter). The derivatives are by any parameter: it needn't be the
# distance flown, and the curve may run along it at an uneven pace.


# %%
def curvature(first, second):
    """Curvature κ (N,) [1/m] of a curve with these derivatives."""
    ### BEGIN SOLUTION
    across = np.cross(first, second)
    return np.linalg.norm(across, axis=1) / np.linalg.norm(first, axis=1) ** 3
    ### END SOLUTION


# %%
exercises.check("12.2", curvature)

# %% tags=["solution"]
assert exercises.check("12.2", curvature)
angle = np.linspace(0.0, 3.0, 4)
along = 5 * np.column_stack([-np.sin(angle), np.cos(angle), 0 * angle])
inwards = -5 * np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
print("on a circle of 5 m:", curvature(along, inwards), "1/m")

# %% [markdown] tags=["solution"]
# The vector product leaves only the part of $\mathbf r''$ across the curve: the part along it makes the curve faster,
# and doesn't bend it. Why the third power? Let the parameter run twice as fast. Then $|\mathbf r'|$ doubles and
# $|\mathbf r''|$ is four times as large, so the vector product is eight times as large. The curve is the same, so we
# have to divide by $2^3$.

# %% [markdown]
# ## 12.3 Through the waypoints
#
# *Code · 20 minutes*
#
# A B-spline cuts the corners at its control points. At the knot of point $j$ it is at $(\mathbf P_{j-1} + 4\mathbf P_j
# +
# \mathbf P_{j+1})/6$ (Eq. 2). A UAV that takes pictures has to be *at* its waypoints. So turn it around. `waypoints` (N,
# D), N at least 3, are where the curve with phantom points has to be at its knots. Return the control points (N, D)
# that do it. (With phantom points the curve begins at $\mathbf P_0$ and ends at $\mathbf P_{N-1}$. For those in between
# there are as many equations as unknown points: `numpy.linalg.solve`.)


# %%
def control_points(waypoints):
    """Control points (N, D) of the B-spline with phantom points whose knots are the waypoints (N, D)."""
    ### BEGIN SOLUTION
    count = len(waypoints)
    weights = (4 * np.eye(count) + np.eye(count, k=1) + np.eye(count, k=-1)) / 6
    weights[[0, -1]] = np.eye(count)[[0, -1]]  # the ends are control points themselves
    return np.linalg.solve(weights, waypoints)
    ### END SOLUTION


# %%
exercises.check("12.3", control_points)

# %% tags=["solution"]
assert exercises.check("12.3", control_points)
waypoints = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [20.0, 10.0]])
print(control_points(waypoints).round(2).tolist())

# %% [markdown] tags=["solution"]
# Each waypoint in between gives one equation with three unknown points, and the equations share the points. So they
# have to be solved together. In the matrix each row has the weights 1, 4, 1 over 6 around its diagonal; the first and
# the last row say $\mathbf P_0$ = first waypoint and $\mathbf P_{N-1}$ = last waypoint. The control points lie farther
# out than the waypoints. (Check such a curve against the walls: it may leave the lines to the outside.)

# %% [markdown]
# ## 12.4 Slow only where it bends
#
# *Code · 25 minutes*
#
# The chapter flies a curve at one speed, that of its sharpest bend. Better: as fast as each bend allows, and brake in
# time. `distance` (P,) is the distance flown to each point of a curve, rising; `allowed` (P,) is the greatest speed at
# each [m/s]; `acceleration` is the greatest acceleration and braking along the curve [m/s²], the same for both. The UAV
# begins and ends at rest. Return the speed at each point (P,), as fast as possible. Between two points it accelerates
# or brakes evenly, so that $v_2^2 - v_1^2 = 2\,a_\parallel s$ over a distance $s$. (One pass along the curve takes care
# of the acceleration. What takes care of the braking?)


# %%
def speeds(distance, allowed, acceleration):
    """Greatest speed at each point (P,) [m/s], from rest to rest."""
    ### BEGIN SOLUTION
    squared = np.square(allowed).astype(float)
    squared[[0, -1]] = 0.0
    gain = 2 * acceleration * np.diff(distance)
    for i in range(1, len(squared)):  # accelerating
        squared[i] = min(squared[i], squared[i - 1] + gain[i - 1])
    for i in range(len(squared) - 2, -1, -1):  # braking is accelerating, seen backwards
        squared[i] = min(squared[i], squared[i + 1] + gain[i])
    return np.sqrt(squared)
    ### END SOLUTION


# %%
exercises.check("12.4", speeds)

# %% tags=["solution"]
from uavlab.planners import least_risk
from uavlab.risk import CAMPUS_FLIGHT, reference_campus
from uavlab.spline import allowed_speed

assert exercises.check("12.4", speeds)
curve = Curve(least_risk(reference_campus(), *CAMPUS_FLIGHT).points)
allowed = np.minimum(allowed_speed(curve.level_curvature), 16.0)
v = speeds(curve.distance, allowed, 3.0)
seconds = np.sum(2 * np.diff(curve.distance) / (v[1:] + v[:-1]))
print(f"least risk, by the bank alone: {seconds:.1f} s, against {curve.length / allowed.min():.1f} s at one speed")

# %% [markdown] tags=["solution"]
# The square of the speed grows by at most $2\,a_\parallel s$ from one point to the next: a pass forwards sees to that.
# Braking is the same rule, seen from the end: a pass backwards. Both passes only lower speeds, so the second can't
# break what the first has done. The result is the greatest speed at every point at once.

# %% [markdown]
# ## 12.5 How long must the legs be?
#
# *Experiment · 20 minutes*
#
# A route turns by a right angle between equal legs. **How long must the legs be at least, so that the UAV of the chapter
# can fly the curve at 15 m/s?** Find the length to within half a metre. `fastest` flies a corner within all limits. You
# can halve an interval again and again, or compute the length by Eqs 8 and 10 and try whether it is right.


# %%
def fastest(leg):
    """Greatest speed over a right angle between legs of this length [m], within all limits [m/s]."""
    steps = np.array([[1, 0, 0]] * 4 + [[0, 1, 0]] * 4)
    control = leg * np.vstack([np.zeros(3), np.cumsum(steps, axis=0)]) + [0, 0, 30]
    return greatest_speed(Curve(control, step=leg / 200), uav)


print([f"legs of {leg} m: {fastest(leg):.1f} m/s" for leg in (20, 40, 80)])

# %%
### BEGIN SOLUTION
low, high = 80.0, 200.0  # too short, long enough
while high - low > 0.1:
    middle = (low + high) / 2
    low, high = (low, middle) if fastest(middle) >= 15 else (middle, high)
shortest = high
### END SOLUTION

# %%
exercises.check("12.5", shortest)

# %% tags=["solution"]
assert exercises.check("12.5", shortest)
print(f"legs of {shortest:.1f} m; with 112.4 m, by the bank alone, {fastest(112.4):.1f} m/s")

# %% [markdown] tags=["solution"]
# By Eq. 10 a right angle has $\kappa L_\text{leg} = 2\sqrt2$. A bank of 30° allows $\kappa = 5.66/15^2$, so legs of
# 112.4 m. But 15 m/s is above the 13.2 m/s at which the tilt takes over. The drag is then $m \cdot 4.99$ m/s², and the
# tilt leaves $\sqrt{6.87^2 - 4.99^2} = 4.72$ m/s² sideways. So $L_\text{leg} = 2\sqrt2 \cdot 15^2/4.72 = 134.9$ m.

# %% [markdown]
# ## 12.6 Swing wide
#
# *Open · 40 minutes*
#
# A street is 12 m wide and turns by a right angle. Along its middle, smoothed, the UAV can fly at 5.8 m/s. **Find
# control points with which it can fly at 12 m/s and keep 1 m to all walls.** Hand over an array (N, 3) with 2 to 12
# points. The first is `start`, the last is `goal`; the others may lie anywhere, also in walls: only the curve is flown.
#
# A hint: how does a racing driver take a bend? And where do the control points have to be for that, if the curve passes
# them on the inside?

# %%
occupied = np.ones((80, 80, 20), dtype=bool)
occupied[:76, 4:16] = occupied[64:76, 4:] = False
street = City(occupied, name="A street with a corner")
start, goal = (2.0, 10.0, 10.0), (70.0, 78.0, 10.0)


def draw(control):
    """The street from above, with a curve and its control points."""
    curve = Curve(np.asarray(control, dtype=float))
    title = f"least clearance {curve.clearance(street):.2f} m, at most {greatest_speed(curve, uav):.1f} m/s"
    points = {"control points": curve.control[:, :2]}
    paths = {"curve": curve.points[:, :2]}
    return plot.area_map(street, {"building": occupied[:, :, 10]}, paths=paths, points=points, title=title)


middle_line = smooth(Route([start, (70.0, 10.0, 10.0), goal]), street, uav, min_clearance=1.0)
draw(middle_line.control)

# %%
### BEGIN SOLUTION
# Out to the far wall before the bend, close to the inner corner, and out to the far wall again.
control = np.array(
    [start, (30, 5, 10), (50, 5, 10), (66, 14, 10), (75, 30, 10), (75, 50, 10), goal],
)
### END SOLUTION

# %%
exercises.check("12.6", control)

# %% tags=["solution"]
assert exercises.check("12.6", control)
print(feasibility(Curve(control), street, uav, speed=12.0, min_clearance=1.0))
draw(control)

# %% [markdown] tags=["solution"]
# In the middle of the street the bend has to fit between its two straight lines. If the UAV first moves to the outer
# wall, then passes near the inner corner and lets itself be carried to the outer wall again, the bend begins earlier
# and ends later. Its radius is larger, and the speed grows with the root of the radius. Eq. 11 isn't broken: it holds
# for control points on the corner of the route with equal legs, and these are neither.
