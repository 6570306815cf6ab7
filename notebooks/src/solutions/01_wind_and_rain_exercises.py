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
# NotImplementedError`, run the cell and then the check below it. The check says what is right, or what is wrong and
# what to think about; ask it as often as you like.

# %%
import math

import numpy as np

from uavlab import exercises

# %% [markdown]
# ## 01.2 The force of rain
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

# %% [markdown]
# ## 01.3 Drag, with a direction
#
# `wind` and `velocity` are arrays (east, north, up) in m/s: where the air moves to, and where the UAV moves over
# ground. `drag_area` is $C S$ in m², `density` that of the air in kg/m³. With which force, as an array in newtons,
# does the air push the UAV?


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

# %% [markdown]
# ## 01.4 The heading that holds a course
#
# A UAV flies through the air with `air_speed` m/s. `wind` is an array (east, north) in m/s, where the air moves to.
# Into which direction must it fly through the air, so that over ground it moves along `course`? Both directions are
# in degrees clockwise from north, as on a compass: 0 is north, 90 east. If the crosswind is stronger than the UAV,
# there is no such heading: return `None`.


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
