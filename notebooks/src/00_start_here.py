# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # Start here: a route through a city in five minutes
#
# A small UAV hovers in the notch of an L-shaped building, 30 m above the ground. It has to get to a point above another
# building, and there is wind. How far will gusts push it, which way is short, and which way is still safe? This
# notebook goes the whole way once: weather, offset, distance to keep, route, curve, flights. The others open each step.
#
# *Run All* (in the menu **Run**) executes everything and brings the 3D scenes to life. Until then a still picture
# stands in their place.

# %%

import numpy as np

from uavlab import plot, scene
from uavlab.city import table1_city
from uavlab.flight import OffsetProcess, crash_rate, fly, monte_carlo
from uavlab.offsets import minimum_safe_distance
from uavlab.planners import astar, least_risk, shortcut
from uavlab.prediction import OffsetPredictor, make_dataset
from uavlab.risk import CAMPUS_FLIGHT, reference_campus
from uavlab.spline import feasibility, smooth
from uavlab.vehicle import LIGHT_QUADROTOR
from uavlab.weather import Weather, Wind, rain_force, wind_drag

COLORS = {"safe curve": plot.SKY, "shortest route": plot.BLUE, "safest of the shortest": plot.ORANGE}

# %% [markdown]
# ## The weather
#
# A light breeze from the south-west and a little rain, on a quadrotor of 1.5 kg that carries 250 g. Gusts are stronger
# than the mean wind, and their force grows with the square of the speed. The rain hardly counts.

# %% tags=["nbval-check-output"]
uav = LIGHT_QUADROTOR.loaded(0.25)
weather = Weather(12, 80, 985, forecast_wind=3, wind_from_deg=240, rain_mm_per_h=2, radiation=150)
gust = weather.reference_wind.gust * weather.wind_direction  # where the air moves to, east and north
drag = wind_drag(gust, (0, 0), uav.drag_area, air_density=weather.air_density)
print(f"gusts of {np.linalg.norm(gust):.1f} m/s push with {np.linalg.norm(drag):.2f} N")
print(f"rain of {weather.rain_mm_per_h} mm/h presses with {rain_force(2, uav.rain_area):.4f} N")
print(f"left against them: {uav.horizontal_reserve():.1f} N of {uav.thrust:.0f} N of thrust")

# %% [markdown]
# Where this comes from, and which weather grounds which load: [01 wind and rain](01_wind_and_rain.ipynb).
#
# ## How far will it be pushed?
#
# REPARE, one of the three papers that this course works through, learns it from flights: from the weather to the
# offset in whole metres, rounded up. There are no such flights to download, so ours are simulated, in a year of real
# hourly weather. What XGBoost predicts for today goes into the paper's Eq. 7: the distance to keep is the offset plus
# half the body.

# %% tags=["nbval-check-output"]
year = make_dataset("greensboro", rng=1, uav=uav)
predictor = OffsetPredictor().fit(year.features[year.train], year.offsets[year.train])
offset = predictor.predict_offset(weather)[0]
safe_distance = minimum_safe_distance(offset, uav.diameter)
print(f"offset to be survived: {offset:.0f} m; distance to keep from walls: {safe_distance:.1f} m")
assert safe_distance == 3.5  # REPARE Table 4: light load, mild disturbance

# %% [markdown]
# How far "3σ" reaches, and when it doesn't: [02 the Pauta criterion](02_pauta.ipynb). How good such a prediction can
# be at best: [03 predicting the disturbance](03_predicting_the_disturbance.ipynb).
#
# ## The city
#
# REPARE tests its planner in a city of five buildings (its Table 1). A planner sees it as a million cubes of one metre,
# each free or occupied.

# %% tags=["nbval-check-output"]
city = table1_city()
print(f"{city.occupied.size:,} voxels, {city.occupied.sum():,} of them occupied ({city.occupied.mean():.1%})")
for building in city.buildings:
    print(f"  {building.name:<11} up to {building.bounds[1, 2]:.0f} m")

# %%
assert city.occupied.sum() == 144_858
scene.show(city)

# %% [markdown]
# How such a grid is made, what it costs, and how to read a real city from a file: [04 cities](04_cities.ipynb).
#
# ## The shortest way
#
# A* (read: A star) finds the shortest route from voxel to voxel. Start and goal are in metres: x to the east, y to the
# north, z up. The route begins and ends in the centres of their voxels, at most half a metre off on each axis.

# %% tags=["nbval-check-output"]
start, goal = (90, 18, 30), (20, 75, 75)
shortest = astar(city, start, goal)
print(f"{shortest.length:.1f} m, {shortest.info['expanded']:,} voxels looked at")
print(f"nearest to a building: {shortest.clearance(city):.1f} m")

# %%
assert shortest.reached
assert shortest.clearance(city) == 0.5  # it scrapes along the wall
plot.profile(city, shortest)

# %% [markdown]
# It is the shortest way, and nobody would fly it: for a part of it the centre of the UAV is half a metre from a wall.
#
# ## A way that keeps its distance
#
# The weather asks for 3.5 m. Voxels that are nearer to a wall are now closed. And since nothing forces a UAV to turn by
# 45° or 90° from voxel to voxel, `shortcut` then joins by straight lines what can see each other.

# %% tags=["nbval-check-output"]
safe = astar(city, start, goal, min_clearance=safe_distance)
straight = shortcut(safe, city)
for route in (shortest, safe, straight):
    print(f"{route.planner:<14} {route.length:6.1f} m, nearest to a building {route.clearance(city):.1f} m")

# %%
assert safe.clearance(city) >= safe_distance
assert straight.clearance(city) >= safe_distance
assert straight.length < shortest.length  # keeping away costs less than the detours of the grid
plot.profile(city, straight, shortest, safe_distance=safe_distance)

# %% [markdown]
# Seen from above, and in three dimensions. Drag the scene to turn it, scroll to zoom; the ball around the UAV is the
# distance that it keeps.

# %%
plot.plan(city, straight, shortest)

# %%
scene.show(city, straight, shortest, safe_distance=safe_distance)

# %% [markdown]
# ## A curve without corners
#
# No UAV turns on the spot at full speed. A B-spline with the waypoints as control points has no corners; but it cuts
# them, and what was clear may touch. `smooth` looks, and where it would, it pulls the curve back to the straight lines.
# `feasibility` then holds the curve against what this UAV can do, and says where it comes nearest to each limit.

# %% tags=["nbval-check-output"]
curve = smooth(straight, city, uav)
wind = Wind.from_weather(weather)
report = feasibility(curve, city, uav, wind=wind.mean)
print(f"{curve.length:.1f} m, {curve.info['rounds']} rounds of repair")
print(report)
assert report.feasible

# %% [markdown]
# Where the curve comes from, and why "curvature below 1", as two of the papers ask, says nothing about 16 m/s:
# [12 B-splines and feasibility](12_bsplines_and_feasibility.ipynb).
#
# ## Flown, five hundred times
#
# Now the wind blows. The UAV is a mass that a limited thrust holds against gusts, rain and load, and that an autopilot
# pulls along the curve by what GPS says. We fly the shortest route, too, and the safe curve once more with offsets as
# large as its distance was chosen for: one metre is a third of the three that were to be survived.

# %% tags=["nbval-check-output"]
flown = {
    "shortest route, this wind": monte_carlo(shortest, city, uav, wind, rng=1, flights=500),
    "safe curve, this wind": monte_carlo(curve, city, uav, wind, rng=1, flights=500),
    "safe curve, offsets of 1 m": monte_carlo(curve, city, uav, OffsetProcess(sigma=offset / 3), rng=1, flights=500),
}
for name, flights in flown.items():
    across, up = flights.samples.std(axis=0)
    print(f"{name:<27} crashes: {crash_rate(flights)!s:<32} offsets: {across:.2f} m across, {up:.2f} m up")

# %%
assert flown["shortest route, this wind"].crashed.mean() > 0.5
assert not flown["safe curve, this wind"].crashed.any()
assert crash_rate(flown["safe curve, offsets of 1 m"]).per_thousand < 30
crash = fly(shortest, city, uav, wind, rng=2)
arrival = fly(curve, city, uav, wind, rng=2)
assert (crash.outcome, arrival.outcome) == ("crashed", "arrived")
scene.show(city, flights={"safe curve": arrival, "shortest route": crash}, safe_distance=safe_distance, wind=wind, uav=uav,
           colors=COLORS, start_paused=True, start_at=crash.duration)  # fmt: skip

# %% [markdown]
# What flies here, which planners survive which gusts, and what "3σ" is worth over a whole flight:
# [13 flying in gusts](13_flying_in_gusts.ipynb).
#
# ## Over people
#
# Walls are not the only concern. A UAV that fails falls on somebody, or on nobody: it depends on what it flies over.
# The other two papers of this course, RISK-ACO and PSO-BAS, count deaths per hour of flight over each place of a
# campus, from the people there, from what shelters them, and from how hard a wreck comes down. The shortest route
# crosses two squares full of people. Which route has the least risk, if it may be 8 % longer?

# %% tags=["nbval-check-output"]
campus = reference_campus()
across = least_risk(campus, *CAMPUS_FLIGHT, length_weight=1)  # a metre outweighs all risk
around = least_risk(campus, *CAMPUS_FLIGHT, max_length=1.08 * across.length)  # only the risk counts
for route in (across, around):
    print(f"{route.length:.1f} m, {campus.fatalities(route):.1e} deaths per flight")
saved = 1 - campus.integral(around) / campus.integral(across)
print(f"{saved:.0%} less risk for {around.length / across.length - 1:.1%} more way")

# %%
assert saved > 0.8
scene.show(campus.city, around, {"safest of the shortest": across}, risk=campus, uav=campus.uav, colors=COLORS)

# %% [markdown]
# Bright ground is where a fall would cost most, on a logarithmic scale. How such a map is made, what its numbers mean
# and whether the papers' claims about it hold: [08 risk maps](08_risk_maps.ipynb).
#
# ## Your turn
#
# Raise the wind to 5 m/s, or the load to 1 kg. Move the goal. What happens when the distance is larger than half the
# gap between two buildings? And when the goal itself is too near to a wall? A question that has no answer is refused,
# with what would do instead:

# %% tags=["nbval-check-output"]
try:
    astar(city, start=(65, 20, 30), goal=goal)
except ValueError as error:
    print(error)

# %% [markdown]
# ## The way on
#
# | notebook | question |
# |---|---|
# | [01 wind and rain](01_wind_and_rain.ipynb) | How hard do wind and rain push, and which weather grounds which load? |
# | [02 the Pauta criterion](02_pauta.ipynb) | How far is "far enough", on one axis, in space, over a flight? |
# | [03 prediction](03_predicting_the_disturbance.ipynb) | How well can a model foresee it? |
# | [04 cities](04_cities.ipynb) | What does a planner see of a city, and what does the resolution cost? |
# | [05 A*](05_astar.ipynb) | Why is A* exact, which estimate is best, and what is wrong with REPARE's Eq. 13? |
# | [06 potential field](06_potential_field.ipynb) | What if the goal just pulls and the walls push? |
# | [07 REPARE](07_repare.ipynb) | How should the weather change the route, and what beats the paper's planner? |
# | [08 risk maps](08_risk_maps.ipynb) | Whom does a falling UAV hit, and what does it cost to fly around them? |
# | [10 ant colony](10_ant_colony.ipynb) | Can ants find the route of least risk, and how far from it do they end? |
# | [11 swarms and beetles](11_particle_swarm_and_beetles.ipynb) | And swarms? What decides, if not the algorithm? |
# | [12 B-splines](12_bsplines_and_feasibility.ipynb) | What does a UAV fly of a list of voxels, and can it? |
# | [13 flying in gusts](13_flying_in_gusts.ipynb) | Which planner's route survives the wind, and how sure is that? |
# | [14 from route to autopilot](14_from_route_to_autopilot.ipynb) | How does a route get into an autopilot, and does it fly it? |
#
# All but this one end with exercises (folder `exercises`); `uavlab.exercises.check` tells you whether an answer is
# right, and if not, what to think about. The whole way as one page, for any city and weather: `python -m uavlab` in a
# terminal. The route of this notebook as a file for other programs: `straight.to_csv("route.csv")`.

# %% tags=["nbval-check-output"]
print(np.round(straight.points, 1))
