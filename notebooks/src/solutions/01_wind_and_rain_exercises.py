# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 01 Wind and rain: exercises
#
# They belong to the notebook [01 Wind and rain](../01_wind_and_rain.ipynb). Put your answer in the place of `raise
# NotImplementedError` or of the dots `...`. Run the cell and then the check below it. The check says what is right, or
# what is wrong and what to think about. Ask it as often as you like.

# %%
import math

import numpy as np

from uavlab import exercises
from uavlab.vehicle import LIGHT_QUADROTOR
from uavlab.weather import dryden_gusts, lift_margin, wind_limit

# %% [markdown]
# ## 01.1 A gust on the way
#
# *Warm-up · 5 minutes*
#
# The thrust of a UAV holds air of 20 m/s. The gust factor is $G = 1.75$. The UAV flies straight against the wind with
# 5 m/s over ground, and it is to keep that speed in gusts. Nothing else limits it. What is the strongest mean wind?
#
# - **a** 11.4 m/s
# - **b** 15.0 m/s
# - **c** 8.6 m/s
# - **d** 6.4 m/s

# %%
### BEGIN SOLUTION
choice_1 = "c"
### END SOLUTION

# %%
exercises.check("01.1", choice_1)

# %% tags=["solution"]
assert exercises.check("01.1", choice_1)

# %% [markdown] tags=["solution"]
# In a gust the air comes with $G W$ over ground. The UAV flies into it with 5 m/s, so the air passes it with
# $G W + 5$ m/s. This must be at most 20 m/s, so $W \le (20 - 5)/1.75 = 8.6$ m/s. The three other answers forget one
# thing each: the UAV's own speed, the gust, or that a gust makes only the air faster, not the UAV.

# %% [markdown]
# ## 01.2 The force of rain
#
# *Warm-up · 10 minutes*
#
# Rain of `rain_mm_per_h` falls on an area of `area` m². Its drops come down with `drop_speed` m/s and bounce back with
# the share `restitution` of that speed (0: they stick). A cubic metre of water has 1000 kg. How hard does the rain
# press, in newtons?


# %%
def rain_newtons(rain_mm_per_h, area, drop_speed, restitution):
    """Downward force of rain [N]."""
    ### BEGIN SOLUTION
    metres_per_second = rain_mm_per_h / 1000 / 3600
    kilograms_per_second = 1000 * metres_per_second * area
    return kilograms_per_second * drop_speed * (1 + restitution)
    ### END SOLUTION


# %%
exercises.check("01.2", rain_newtons)

# %% tags=["solution"]
assert exercises.check("01.2", rain_newtons)
print(f"100 mm/h on 0.1 m²: {rain_newtons(100, 0.1, 9, 0):.3f} N")

# %% [markdown] tags=["solution"]
# A force is momentum per second. First we ask how many kilograms arrive each second. A millimetre of rain on a square
# metre is a litre, so this is a matter of units. Then we ask by how much each kilogram changes its speed: from
# `drop_speed` downwards to `restitution * drop_speed` upwards. Both parts press the same way, so they add up.

# %% [markdown]
# ## 01.3 Drag, with a direction
#
# *Code · 15 minutes*
#
# `wind` and `velocity` are arrays (east, north, up) in m/s. The first says where the air moves to, the second where the
# UAV moves over ground. `drag_area` is $C_D A$ in m², and `density` that of the air in kg/m³. With which force, as an
# array in newtons, does the air push the UAV?


# %%
def drag(wind, velocity, drag_area, density):
    """Force of the air on the UAV, (3,) [N]."""
    ### BEGIN SOLUTION
    relative = wind - velocity
    return 0.5 * density * drag_area * np.linalg.norm(relative) * relative
    ### END SOLUTION


# %%
exercises.check("01.3", drag)

# %% tags=["solution"]
assert exercises.check("01.3", drag)
wind, velocity = np.array([4.0, 3.0, 0.0]), np.array([0.0, 6.0, 0.0])
print("flying north in a wind to the north-east:", drag(wind, velocity, 0.06, 1.225).round(2), "N")

# %% [markdown] tags=["solution"]
# We look from the UAV: the air moves past it with `wind - velocity`. The force points the same way as that vector, and
# its size goes with the square of the vector's length. Length times vector gives both at once. Squaring each component
# by itself would turn the force away from the air's direction and lose its sign.
#
# In the example the wind carries the UAV along to the north a little, but the UAV is faster. So the air pushes it back
# to the south, and to the east.

# %% [markdown]
# ## 01.4 The heading that holds a course
#
# *Code · 20 minutes*
#
# A UAV flies through the air with `air_speed` m/s. `wind` is an array (east, north) in m/s, where the air moves to. Its
# *heading* is the direction in which it flies through the air. Which heading makes it move along `course` over ground?
# Heading and course are in degrees clockwise from north, as on a compass: 0 is north, 90 is east. If the crosswind is
# stronger than the UAV, there is no such heading: return `None`.


# %%
def heading(air_speed, wind, course):
    """Heading that holds the course [degrees clockwise from north], or None where there is none."""
    ### BEGIN SOLUTION
    east, north = math.sin(math.radians(course)), math.cos(math.radians(course))
    crosswind = wind[0] * north - wind[1] * east  # to the right of the course
    if abs(crosswind) > air_speed:
        return None
    return (course - math.degrees(math.asin(crosswind / air_speed))) % 360
    ### END SOLUTION


# %%
exercises.check("01.4", heading)

# %% tags=["solution"]
assert exercises.check("01.4", heading)
print(f"course 90°, wind of 9 m/s to the south: heading {heading(18.0, np.array([0.0, -9.0]), 90.0):.0f}°")

# %% [markdown] tags=["solution"]
# Split the wind into a part along the course and a part across it. Only the part across moves the UAV off its course.
# The UAV cancels it by flying into it through the air. The air speed is the long side (hypotenuse) of a right-angled
# triangle, and the crosswind is the side opposite to the angle, so the sine of the angle is crosswind over air speed.
# If the crosswind is larger than the air speed, no angle has such a sine.

# %% [markdown]
# ## 01.5 How long is a mean?
#
# *Experiment · 20 minutes*
#
# REPARE averages the measured wind over a time $t_w$ and doesn't say how long. A UAV hovers 30 m above grass in a mean
# wind of 8 m/s with Dryden's gusts, as in the chapter. It measures the wind along its mean direction once a second and
# averages over $t_w$. Each time it does so, it finds another mean.
#
# Make many records, with one seed each: `8 + dryden_gusts(1200, 1.0, air_speed=8.0, altitude=30.0, wind_at_6m=6.0,
# rng=seed)[:, 0]`. Take the mean of the first $t_w$ seconds of each. How do these means scatter from record to record?
# Find the $t_w$ at which their standard deviation is 0.4 m/s, which is 5 % of the wind. Hand over `averaging_time` in
# seconds; within 15 % is near enough.

# %%
### BEGIN SOLUTION
records = np.array(
    [8 + dryden_gusts(1200, 1.0, air_speed=8.0, altitude=30.0, wind_at_6m=6.0, rng=seed)[:, 0] for seed in range(1000)]
)
means = np.cumsum(records, axis=1) / np.arange(1, 1201)  # column k: of the first k + 1 seconds
scatter = means.std(axis=0)
averaging_time = 1 + int(np.argmax(scatter < 0.4))
### END SOLUTION

# %%
exercises.check("01.5", averaging_time)

# %% tags=["solution"]
assert exercises.check("01.5", averaging_time)
print(
    f"{averaging_time} s; after 10 s the means still scatter by {scatter[9]:.2f} m/s, after 600 s by {scatter[599]:.2f}"
)

# %% [markdown] tags=["solution"]
# About four minutes. If each second brought an independent wind, 7 seconds would do, because $1.03/\sqrt 7 = 0.39$
# m/s. But a gust lasts: what is measured in the next second is nearly the same. For gusts whose correlation is $e^{-s/\tau_u}$, as in
# the chapter, a long mean has the variance $2\sigma_u^2 \tau_u/t_w$ (integrate the correlation on both sides). So one independent
# value comes every $2\tau_u = 38$ s, and $t_w = 2 \cdot 19 \cdot 1.03^2/0.4^2 = 254$ s. The exact integral gives 233
# s. The ten minutes of the meteorologists bring it down to about 0.25 m/s.

# %% [markdown]
# ## 01.6 As much as possible
#
# *Open · 30 minutes*
#
# Our quadrotor, `LIGHT_QUADROTOR`, delivers parcels 2 km away, straight against a mean wind of 7 m/s, and comes back
# without load and with the wind from behind. It is dry, and $G = 1.75$. You choose the load [kg], the ground speed on
# the way out and the ground speed on the way back [m/s]. Loading and unloading take 120 s a round. Maximise the
# kilograms per hour, so `load / (2000/out + 2000/back + 120) * 3600`. You may do what you like, as long as the UAV
#
# - has a positive lift margin, with $\delta = 1.1$,
# - flies through the mean wind with at most 18 m/s, on both ways,
# - keeps its ground speed against the strongest gust on the way out.
#
# Hand over `delivery = (load, out, back)`. It is right if nobody can do 3 % better. `uav.loaded(load)`, `lift_margin`
# and `wind_limit` help.

# %%
### BEGIN SOLUTION
best = (0.0, (0.0, 0.0, 0.0))
for load in np.arange(0.01, 1.2, 0.01):
    loaded = LIGHT_QUADROTOR.loaded(load)
    if lift_margin(loaded) <= 0:
        continue
    out = min(float(wind_limit(loaded)) - 1.75 * 7, 18.0 - 7)
    back = 18.0 + 7
    rate = load / (2000 / out + 2000 / back + 120) * 3600
    best = max(best, (rate, (load, out - 1e-6, back - 1e-6)))
delivery = best[1]
### END SOLUTION

# %%
exercises.check("01.6", delivery)

# %% tags=["solution"]
assert exercises.check("01.6", delivery)
load, out, back = delivery
print(f"load {load:.2f} kg, out {out:.1f} m/s, back {back:.1f} m/s: {best[0]:.2f} kg/h")

# %% [markdown] tags=["solution"]
# The way back is easy: full air speed, and the wind adds its 7 m/s. On the way out a gust brings
# $1.75 \cdot 7 = 12.25$ m/s, and what the thrust holds above that is left for flying. For a given load, both speeds
# are therefore as large as allowed. Then only the load has to be searched. A light load flies fast and brings little.
# The heaviest load that lifts creeps against the gusts. The best lies between them, and the top of the curve is flat:
# a few per cent of load more or less hardly matter.
