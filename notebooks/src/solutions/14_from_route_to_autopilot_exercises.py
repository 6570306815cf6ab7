# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 14 From route to autopilot: exercises
#
# They belong to the notebook [14 From route to autopilot](../14_from_route_to_autopilot.ipynb). Put your answer in the
# place of `raise NotImplementedError`, run the cell and then the check below it. The check says what is right, or what
# is wrong and what to think about; ask it as often as you like.
#
# | | | |
# |---|---|---|
# | 14.1 How far is one step? | warm-up | 5 minutes |
# | 14.2 One point, three altitudes | warm-up | 5 minutes |
# | 14.3 Around the corner | to code | 20 minutes |
# | 14.4 Over a link that loses messages | to code | 15 minutes |
# | 14.5 How long can you trust GPS? | experiment | 25 minutes |
# | 14.6 A mission of your own | open | 30 minutes |

# %%
import math
from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np

from uavlab import exercises, plot
from uavlab.city import Place
from uavlab.mission import Mission
from uavlab.planners import astar, least_risk, shortcut
from uavlab.risk import CAMPUS_FLIGHT, reference_campus

# %% [markdown]
# ## 14.1 How far is one step?
#
# *Warm-up · 5 minutes*
#
# A MAVLink message has latitude and longitude as whole numbers. One step of such a number is
# $10^{-7}$ degrees. How many metres is one step to the north, and how many is one step to the east, at the latitude
# `latitude_deg` (in degrees)? Take the Earth as a sphere with a radius of 6 371 000 m. Return both, `(north, east)`.
#
# When you fly north, you follow a circle around the whole Earth, through both poles. When you fly east, you follow the
# circle of all places at your latitude. Draw both.


# %%
def digit_in_metres(latitude_deg):
    """Length of a step of 1e-7 degrees (north, east) [m]."""
    ### BEGIN SOLUTION
    north = math.radians(1e-7) * 6_371_000.0
    return north, north * math.cos(math.radians(latitude_deg))
    ### END SOLUTION


# %%
exercises.check("14.1", digit_in_metres)

# %% tags=["solution"]
assert exercises.check("14.1", digit_in_metres)
for latitude in (0.0, 30.0, 47.25, 60.0, 80.0):
    north, east = digit_in_metres(latitude)
    print(f"at {latitude:5.2f}°: {1000 * north:.1f} mm north, {1000 * east:.1f} mm east")
print(f"a 32-bit float next to 47.25: {np.spacing(np.float32(47.25)) / 1e-7 * digit_in_metres(47.25)[0]:.2f} m north")

# %% [markdown] tags=["solution"]
# An angle in radians, times the radius, is the length of the arc. The circle to the east has the radius
# $R\cos(\text{latitude})$, so its steps are shorter. A step is about a centimetre, so rounding moves a waypoint by half
# a centimetre at most, north and east.
#
# Why whole numbers? A message has 32 bits for each of the two. As a number with a point (a float) they would hold seven
# digits, and the next latitude after 47.25° would be 0.42 m away. As a whole number, 32 bits hold every step from −214
# to 214 degrees.

# %% [markdown]
# ## 14.2 One point, three altitudes
#
# *Warm-up · 5 minutes*
#
# An altitude says nothing until we say what it is measured from. MAVLink calls that the *frame*:
# "home" measures from where the UAV takes off, "sea" from the level of the sea, "terrain" from the ground below the
# point. A map has a zero of its own, which may be any height. On this map the point is at height `z`, home at `home_z`,
# and the ground below the point at `ground_z`. Home lies `home_above_sea` above the sea. All four are in metres. Return
# the altitude of the point in `frame`.


# %%
def altitude(frame, z, home_z, home_above_sea, ground_z):
    """Altitude of a point [m] in the frame "home", "sea" or "terrain"."""
    ### BEGIN SOLUTION
    if frame == "home":
        return z - home_z
    if frame == "sea":
        return z - home_z + home_above_sea
    return z - ground_z
    ### END SOLUTION


# %%
exercises.check("14.2", altitude)

# %% tags=["solution"]
assert exercises.check("14.2", altitude)
for frame in ("home", "sea", "terrain"):
    print(f"{frame:8}{altitude(frame, z=50.0, home_z=10.0, home_above_sea=420.0, ground_z=35.0):6.1f} m")

# %% [markdown] tags=["solution"]
# All three numbers are the same point, 50 m above the map's zero. It is 40 m above home. Home is 420 m above the sea,
# so the point is 460 m above the sea. The ground below it rises to 35 m, so only 15 m are left there.
#
# Each frame is wrong in another way if something isn't known. "home" needs no map, but knows no hills. "sea" needs the
# height of home above the sea: with an error of 3 m there, the whole flight is 3 m too high or too low. "terrain" needs
# an autopilot that knows the ground.

# %% [markdown]
# ## 14.3 Around the corner
#
# *Code · 20 minutes*
#
# An autopilot doesn't fly to a waypoint and turn there. It leaves the first leg before the
# waypoint and joins the second leg behind it. Both places are equally far from the waypoint. We call that distance the
# *reach*. It is `radius`, but not more than half of either leg, because the other half belongs to the next corner.
#
# Three points make a triangle: the waypoint, and the two places where the UAV leaves and joins. We only know that the
# UAV stays in this triangle. **How far from the nearer leg can it be at most?** That much room is needed next to the
# legs. `before`, `here` and `after` are three waypoints, arrays (3,) in metres; the corner is at `here`. The *turn* is
# the angle between the direction in which the UAV comes and the one in which it goes, 0 if it flies straight on. So:
#
# 1. For turns up to a right angle, find the farthest point of the triangle and its distance from the legs.
# 2. For turns beyond a right angle return half the reach. That is a bound on the safe side.


# %%
def corner_margin(before, here, after, radius):
    """Greatest distance from the legs when a corner is rounded [m]."""
    ### BEGIN SOLUTION
    lengths = np.linalg.norm(here - before), np.linalg.norm(after - here)
    into, out = (here - before) / lengths[0], (after - here) / lengths[1]
    reach = min(radius, lengths[0] / 2, lengths[1] / 2)
    cosine = np.clip(into @ out, -1.0, 1.0)
    sine = math.sqrt(1 - cosine**2) if cosine > 0 else 1.0
    return reach / 2 * sine
    ### END SOLUTION


# %%
exercises.check("14.3", corner_margin)

# %% tags=["solution"]
assert exercises.check("14.3", corner_margin)
share = np.sort(np.random.default_rng(14).random((100_000, 2)), axis=1)
for turn in (0, 20, 45, 70, 90, 120, 160):
    angle = math.radians(turn)
    into, out = np.array([1.0, 0, 0]), np.array([math.cos(angle), math.sin(angle), 0])
    points = -2.0 * share[:, :1] * into + 2.0 * (1 - share[:, 1:]) * out  # all over the triangle
    farthest = np.min([np.linalg.norm(np.cross(points, leg), axis=1) for leg in (into, out)], axis=0).max()
    margin = corner_margin(-20 * into, np.zeros(3), 20 * out, 2.0)
    print(f"turn of {turn:3d}°, reach 2 m: {margin:.3f} m; farthest of 100 000 points {farthest:.3f} m")

# %% [markdown] tags=["solution"]
# Let $\alpha$ be the inner angle of the corner, so turn $= 180° - \alpha$. Two sides of the triangle lie on the legs
# and are as long as the reach $r$. The points that are equally far from both legs lie on the line that halves $\alpha$.
# The farthest of them is in the middle of the third side, $r\cos(\alpha/2)$ away from the corner. Its distance from
# each leg is
#
# $$ r\cos\frac\alpha2\,\sin\frac\alpha2 = \frac r2\sin\alpha = \frac r2\sin(\text{turn}). $$
#
# At a right angle that is half the reach. Beyond it the triangle gets narrow again. But a UAV that turns back needs
# room to brake, so we don't take credit for that. With a radius of 2 m, 1 m next to each leg is always enough.

# %% [markdown]
# ## 14.4 Over a link that loses messages
#
# *Code · 15 minutes*
#
# The vehicle asks for one item of a mission after the other. Each item needs a question from the
# vehicle and an answer from the ground station. Each message is lost with the probability `loss`, independently of all
# others. If the answer doesn't come, the vehicle asks the same question again, up to `tries` times in all. If it gets
# no answer to its last question either, it gives up the whole mission. What is the probability that all `items` arrive?
#
# *Predict first:* a link loses one message in ten, and a mission has 300 items. How often does a vehicle that asks only
# once get the mission? And one that asks up to five times?


# %%
def chance_of_transfer(items, loss, tries):
    """Probability that all items of a mission arrive."""
    ### BEGIN SOLUTION
    try_fails = 1 - (1 - loss) ** 2
    item_fails = try_fails**tries
    return (1 - item_fails) ** items
    ### END SOLUTION


# %%
exercises.check("14.4", chance_of_transfer)

# %% tags=["solution"]
assert exercises.check("14.4", chance_of_transfer)
for tries in (1, 2, 3, 5, 8, 12):
    chance = chance_of_transfer(300, 0.1, tries)
    print(f"{tries:2d} tries: {chance:.6g} that all arrive, {1 - chance:.2g} that at least one is missing")

# %% [markdown] tags=["solution"]
# A try succeeds if both messages arrive, with probability $0.9^2 = 0.81$. It fails with probability 0.19. With a single
# try for each item, all 300 arrive with a probability of $0.81^{300}$, about $3.5\cdot10^{-28}$: never. With five tries
# an item is missing with probability $0.19^5$, one in 4 000, and the mission arrives in 93 of 100 uploads. With twelve
# tries one upload in 1.5 million fails. A vehicle that asks four times a second has twelve tries in 3 seconds. Asking
# again costs little and makes a good link of a bad one.

# %% [markdown]
# ## 14.5 How long can you trust GPS?
#
# *Experiment · 25 minutes*
#
# The position that GPS gives drifts. At take-off the autopilot knows where it stands, so the
# error begins at 0. Then it wanders off: it is a *Gauss–Markov process*, which forgets where it was with a time
# constant $\tau$. On each axis the error is normally distributed around 0, with a standard deviation that grows:
#
# $$ \sigma(t) = \sigma\,\sqrt{1 - e^{-2t/\tau}}. $$
#
# A route keeps a `margin` [m] for this error. How long may a flight be, in seconds, so that $3\,\sigma(t)$ stays within
# the margin? `sigma` [m] is the standard deviation in the long run, `correlation` is $\tau$ [s]. If the flight may be
# as long as you like, return `math.inf`.


# %%
def longest_flight(margin, sigma, correlation):
    """How long 3σ of the drift stays within a margin [s]."""
    ### BEGIN SOLUTION
    if 3 * sigma <= margin:
        return math.inf
    return -correlation / 2 * math.log(1 - (margin / (3 * sigma)) ** 2)
    ### END SOLUTION


# %%
exercises.check("14.5", longest_flight)

# %% [markdown]
# Now the experiment. `beyond` simulates flights with the values of the library's GPS, $\sigma$ = 4.7 m and
# $\tau$ = 1100 s. It returns two shares of all flights: those that are beyond the margin at the end, and those that
# were beyond it at any time. Of a normal distribution 0.27 % are farther than 3σ from its middle. *Predict first:* for
# flights as long as you worked out, which of the two shares is 0.27 %? How large is the other one? (The flight that may
# be as long as you like is simulated for an hour.)


# %%
def beyond(margin, seconds, rng, flights=100_000, steps=200):
    """Shares of flights whose error on one axis is beyond a margin: at the end, and ever."""
    kept = math.exp(-seconds / steps / 1100.0)  # of the error, in one step
    error, ever = np.zeros(flights), np.zeros(flights, dtype=bool)
    for _ in range(steps):
        error = kept * error + 4.7 * math.sqrt(1 - kept**2) * rng.standard_normal(flights)
        ever |= np.abs(error) > margin
    return (np.abs(error) > margin).mean(), ever.mean()


if exercises.check("14.5", longest_flight):
    rng = np.random.default_rng(145)
    for margin in (1.0, 2.0, 3.0, 5.0, 15.0):
        seconds = longest_flight(margin, 4.7, 1100.0)
        at_the_end, ever = beyond(margin, min(seconds, 3600.0), rng)
        print(f"{margin:4g} m: {seconds:5.1f} s; beyond it {at_the_end:.2%} at the end, {ever:.2%} ever")

# %% tags=["solution"]
rng, t, kept = np.random.default_rng(14), np.arange(301), math.exp(-1 / 1100)
errors = np.zeros((301, 25))
for second in range(1, 301):
    errors[second] = kept * errors[second - 1] + 4.7 * math.sqrt(1 - kept**2) * rng.standard_normal(25)
band = 3 * 4.7 * np.sqrt(1 - np.exp(-2 * t / 1100))
figure, axes = plt.subplots(figsize=(9.0, 3.6), layout="constrained")
axes.plot(t, errors, color="0.6", linewidth=0.8, label=["25 simulated flights"] + [None] * 24)
axes.plot(t, band, "k", label="3σ(t), to either side")
axes.plot(t, -band, "k")
for margin, color in ((2.0, "C0"), (5.0, "C1")):
    end = longest_flight(margin, 4.7, 1100.0)
    corners = [margin, margin, -margin, -margin]
    axes.plot([0, end, end, 0], corners, color, label=f"margin of {margin:g} m: {end:.0f} s")
axes.set(xlabel="time since take-off [s]", ylabel="error to the east [m]", title="GPS drifts away from the take-off")
axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
plot.finished(figure)

# %% [markdown] tags=["solution"]
# We solve $3\,\sigma(t) = m$ for $t$: squared, $1 - e^{-2t/\tau} = (m/3\sigma)^2$, so
#
# $$ t = -\frac\tau2\,\ln\left(1 - \left(\frac{m}{3\sigma}\right)^2\right). $$
#
# In the figure that is where a margin meets the black curve. For small margins the time grows with the square of the
# margin: it is 2.8 s for 1 m, 25.5 s for 3 m, and 74 s for 5 m.
#
# For $m \geq 3\sigma$ it would be the logarithm of 0 or of a negative number. There $3\,\sigma(t)$ never exceeds the
# margin. 15 m is such a margin: it is more than 3σ in the long run (14.1 m), so at each moment it holds, whatever the
# time.
#
# At the end, 0.27 % of the flights are beyond the margin, as the rule says (with 100 000 flights, ± 0.03 % is chance).
# But nearly twice as many have been beyond it at *some* time: a flight that came back counts for the second share only.
# The rule speaks of one moment, and a wall stands there during the whole flight. "As long as you like" has the same
# catch. At 15 m the share at one moment never exceeds 0.14 %, but in an hour 2.4 % of the flights were beyond it.

# %% [markdown]
# ## 14.6 A mission of your own
#
# *Open · 30 minutes*
#
# Make a mission on the reference campus. The cell below gives the campus a place on Earth, so
# `Mission.from_route` needs no `home`. Write a function that gets the city, the start and the goal, and returns a
# `Mission`. Any planner of the course will do. The check measures the way of the mission on the map. The mission must
#
# - take off at the start and land at the goal, each within 3 m on the ground plan;
# - keep 3 m from all obstacles, between take-off and landing (a centimetre less is let pass, for the rounding of 14.1);
# - stay at most 60 m above the ground;
# - have at most 12 waypoints, which are the items with command 16;
# - have a fence that contains it.
#
# There are many right answers. Once yours is right, make it better: which mission that passes has the least risk?

# %%
campus = reference_campus()
city = replace(campus.city, reference=Place(8.5, 47.25, 420.0))


def own_mission(city, start, goal):
    """A mission from start to goal (3,) [m] on the campus."""
    ### BEGIN SOLUTION
    way = least_risk(campus, start, goal, min_clearance=3.0, max_height=60.0)
    way = shortcut(way, city, price=campus.rate)
    return Mission.from_route(way, city, campus.uav, end="land")
    ### END SOLUTION


# %%
exercises.check("14.6", own_mission)

# %% tags=["solution"]
assert exercises.check("14.6", own_mission)
print(own_mission(city, *CAMPUS_FLIGHT))


# %% [markdown] tags=["solution"]
# `least_risk` looks for the way with the fewest expected deaths on the ground, within the limits. `shortcut` leaves out
# waypoints, with the same limits. `Mission.from_route` makes the mission and a fence around it.
#
# How good is it? We compare it with missions of other routes. `corridor` says how far from the route a leg of the
# mission may be: the wider it is, the fewer waypoints are needed.


# %% tags=["solution"]
def described(mission):
    """What a mission is between take-off and landing, with the deaths to expect in 10⁹ flights."""
    way = mission.path(city).en_route
    waypoints = sum(item.command == 16 for item in mission.items)
    right = "passes" if exercises.check("14.6", lambda *_: mission) else "fails"
    flown = f"{right}, {waypoints:2d} waypoints, {way.length:.0f} m, {way.clearance(city):.2f} m clear"
    return f"{flown}, {1e9 * campus.fatalities(way):.2f} deaths"


limits = {"min_clearance": 3.0, "max_height": 60.0}
short = shortcut(astar(city, *CAMPUS_FLIGHT, **limits), city)
safe = least_risk(campus, *CAMPUS_FLIGHT, **limits)
print("shortest way: ", described(Mission.from_route(short, city, campus.uav)))
for corridor in (1.0, 3.0, 5.0):
    mission = Mission.from_route(safe, city, campus.uav, corridor=corridor)
    print(f"least risk, {corridor:g} m:", described(mission))
print("with shortcut:", described(own_mission(city, *CAMPUS_FLIGHT)))

# %% [markdown] tags=["solution"]
# All of them but one pass the check: the way of least risk with a corridor of 1 m has 20 waypoints. The shortest way
# needs two waypoints, but it has seven to eight times the risk, because it flies over the crowds. A corridor of 3 m
# gives just 12 waypoints. `shortcut` knows what a metre costs in each voxel (`price`). It leaves out waypoints where
# that saves risk, so its mission is shorter *and* has less risk than the route that it began with. "Least risk" was
# least among ways from voxel to voxel, and a straight line between voxels far apart isn't one of those.
