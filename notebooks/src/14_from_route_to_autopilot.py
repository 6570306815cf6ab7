# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 14 From route to autopilot: does anybody fly it?
#
# So far a route was a list of points in metres, and a flight was a function call. A real drone knows neither. It has an
# *autopilot*, a small computer that steers it. The autopilot wants places as degrees on the Earth, and it has to be
# told what heights are above. The pilot stands on the ground with a *ground station*, a laptop with a radio. The paper
# RISK-ACO ends with such a flight (section 4, Figs 13 to 15). In this chapter we repeat it as far as a laptop can: a
# planned route becomes a mission, is checked, goes over a poor radio to a vehicle in another process, and is flown in
# wind while we look on.
#
# | | |
# |---|---|
# | **You will be able to** | turn a route into a mission with a fence; say what a height is above; run a checklist before a flight; upload a mission over a radio that loses packets; fly it against a simulated vehicle and compare track and plan |
# | **You need** | chapters [09](09_route_of_least_risk.ipynb) (risk), [05](05_astar.ipynb) (A\*, the notch of Table 1), [12](12_bsplines_and_feasibility.ipynb) (corners) and [13](13_flying_in_gusts.ipynb) (flights, GPS); nothing of radio |
# | **Time** | 45 minutes to read, a minute to run |
# | **Paper** | RISK-ACO, section 4, Figs 13 to 15 |
#
# Everything here stays on your machine. The vehicle is a program, and its radio is a *loopback* address, 127.0.0.1,
# which no packet leaves. The last section says what would have to change before a real flight.

# %%
from dataclasses import replace
from pathlib import Path

import numpy as np
from IPython.display import display
from pyproj import Proj

from uavlab import plot, scene
from uavlab.city import Place, table1_city
from uavlab.flight import GPS, PERFECT_GPS, Autopilot, monte_carlo
from uavlab.mavlink import CommandDeniedError, FlightLog, connect, download, follow, start, upload
from uavlab.mission import FencePolygon, Mission, preflight, read_plan, read_wpl
from uavlab.planners import astar, least_risk
from uavlab.risk import CAMPUS_FLIGHT, reference_campus
from uavlab.route import Route
from uavlab.vehicle import LIGHT_QUADROTOR
from uavlab.vehicle_sim import P840, simulated_vehicle
from uavlab.weather import Weather, Wind

# %% [markdown]
# ## What the paper flew
#
# RISK-ACO's Fig. 13 is a drawing of four boxes. We put ours beside them.
#
# | box | RISK-ACO, section 4 | here |
# |---|---|---|
# | vehicle | a multirotor of their own design; no mass, no size | the 1.38 kg quadrotor of the risk chapters, as a program |
# | autopilot | a Pixhawk ("PIX"), with GPS at 10 Hz | a simulated one, GPS at 10 Hz with errors that drift |
# | data link | Microhard P400-840, 840 MHz, by a serial cable | a simulated radio, which delays packets and loses some; how many is our assumption |
# | ground station | a laptop; its program isn't named | this notebook |
#
# Pixhawk autopilots speak a language that is called *MAVLink*: short packets with a number for each kind of message.
# Our vehicle and our ground station speak it, too. So the vehicle could be flown by other ground stations, such
# as the free program QGroundControl, and ours could talk to other vehicles.
#
# ## From metres to degrees
#
# Our job is a delivery: from the south-west of the campus to the roof of building 10. The campus of chapter 08 is made
# up, so it has no place on Earth. We give it one. `Place` says where its corner x = y = z = 0 lies: longitude,
# latitude, and a height.

# %%
campus = reference_campus()
city = replace(campus.city, reference=Place(8.5, 47.25, 420.0))
roof = (94.0, 133.0, 47.0)  # 12 m above the roof of building 10
route = least_risk(campus, CAMPUS_FLIGHT[0], roof, min_clearance=4.0)
print(route)
print(city.to_geographic(route.points[[0, -1]]).round(7))

# %% [markdown]
# Longitude comes first here, then latitude, then height. (MAVLink puts latitude first, and so do the items below.) One
# step of the seventh digit is a centimetre. The route ends in the middle of a voxel, at (92.5, 132.5).
#
# It looks as if we only had to divide by the length of a degree. On a map in a *projection* that would be wrong. A
# projection draws the round Earth on flat paper. Its "up" is the north of the paper, which differs from true north by a
# small angle. Here is that angle for a street in Rotterdam in the Dutch national grid:

# %%
angle = Proj("EPSG:28992").get_factors(4.48, 51.92).meridian_convergence
print(f"grid north is {abs(angle):.2f}° off: after 1 km {1000 * np.sin(np.radians(abs(angle))):.0f} m to the side")

# %% tags=["check"]
assert 0.5 < abs(angle) < 1.0

# %% [markdown]
# On the 200 m of our route that would be 2.5 m, most of the 4 m that it keeps to the walls. `City.to_geographic`
# therefore doesn't divide. It knows where true north is, whatever system a city's file was in.
#
# ## How high is 30 metres?
#
# A height is a distance from something. Autopilots know three answers. We ask for the same mission in each of them.
# `Mission.from_route` does the whole translation; we look at its parts one after the other.

# %%
home = city.to_geographic((12.5, 17.5, 0.0))  # with these we say: its 420 m are above the sea
for altitudes in ("home", "sea", "terrain"):
    mission = Mission.from_route(route, city, campus.uav, home=home, altitudes=altitudes)
    print(f"{altitudes:<8}", mission.items[2])

# %% [markdown]
# The first number is above *home*, where the drone takes off. The second is above the *sea*, as on maps. The third is
# above the *terrain* below the drone. Here the ground is level, so that first and third agree.
#
# There is a fourth answer, and it is a trap. GPS itself measures heights above an *ellipsoid*, a slightly
# flattened ball without hills. In Switzerland the ellipsoid lies about 50 m below the level of the sea. A program that
# takes a height above the sea for one above the ellipsoid flies 50 m too low. The other way round it flies 50 m too
# high. So a mission above the sea is refused where nobody says what the city's heights are above. Without `home`:

# %%
try:
    Mission.from_route(route, city, campus.uav, altitudes="sea")
except ValueError as error:
    print(error)

# %% [markdown]
# ## Few waypoints, and all of them clear
#
# The planner's route has a point in every voxel. An autopilot wants few *waypoints*: it flies straight from one to the
# next. The textbook way to leave points out is that of Ramer, Douglas and Peucker: keep the two ends; if some point
# between them is farther than a tolerance from the straight line, keep the farthest one, too, and do the same with both
# halves. We write it down:


# %%
def simplified(points, tolerance):
    """The points that are left, by Ramer, Douglas and Peucker."""
    start, end = points[0], points[-1]
    if len(points) < 3:
        return [start, end]
    along = (end - start) / np.linalg.norm(end - start)
    off = (points - start) - np.outer((points - start) @ along, along)
    distance = np.linalg.norm(off, axis=1)
    farthest = int(distance.argmax())
    if distance[farthest] <= tolerance:
        return [start, end]
    return simplified(points[: farthest + 1], tolerance)[:-1] + simplified(points[farthest:], tolerance)


# %% [markdown]
# We try it on chapter 05's route out of the notch of Table 1, which hugs the walls at 3.5 m.

# %%
table1 = table1_city()
notch = astar(table1, (90, 18, 30), (20, 75, 75), min_clearance=3.5)
print(f"planned: {len(notch.points)} points, {notch.clearance(table1):.1f} m clear")
for tolerance in (1.0, 3.0, 6.0):
    few = Route(simplified(notch.points, tolerance))
    print(f"tolerance {tolerance:g} m: {len(few.points)} points, {few.clearance(table1):.1f} m clear")

# %% [markdown]
# With a tolerance of 6 m the line goes through a wall.
#
# > **Predict first.** What would you change in `simplified`, so that the planner's 3.5 m are always kept?
#
# The tolerance says how far the new line may be from the old one, and nothing about walls. `Mission.from_route` asks a
# second question of each leg: does it keep the promised distance, all along? If not, the leg is split like one that is
# too far off. The `corridor` is our tolerance.

# %%
for width in (1.0, 3.0, 6.0):
    made = Mission.from_route(notch, table1, LIGHT_QUADROTOR, home=(8.5, 47.25), corridor=width)
    way = made.path(table1).en_route
    print(f"corridor {width:g} m: {len(way.points)} waypoints, {way.clearance(table1):.1f} m clear; {made.notes[-1]}")

# %% tags=["check"]
for width in (1.0, 3.0, 6.0):
    made = Mission.from_route(notch, table1, LIGHT_QUADROTOR, home=(8.5, 47.25), corridor=width)
    assert made.path(table1).en_route.clearance(table1) >= 3.49
assert Route(simplified(notch.points, 3.0)).clearance(table1) >= 3.49
assert Route(simplified(notch.points, 6.0)).clearance(table1) == 0.0

# %% [markdown]
# One thing is left: corners. An autopilot doesn't stop at a waypoint. As soon as it is near (2 m, the *corner radius*),
# it turns to the next one and cuts the corner. We assume that it stays in the triangle between the two legs. Let the
# legs turn by an angle $\tau$ and let $R$ be the radius, or half of a leg that is shorter than two radii. The point of
# the triangle that is farthest from the nearer leg is the middle of its third side. That side's half is
# $R\cos(\tau/2)$ long, and it meets the legs at the angle $\tau/2$.
# So the distance is
#
# $$ d = R\cos\frac\tau2\,\sin\frac\tau2 = \frac R2 \sin\tau . \tag{1} $$
#
# `from_route` asks for that much more room at each corner. Where there isn't, it tells the autopilot to stop there for
# a second: those are the corners that the last words above count. (Beyond a right angle it takes $R/2$, to be on the
# safe side.)
#
# Here is the mission for our delivery, at 5 m/s, with a corridor of 3 m.

# %%
mission = Mission.from_route(route, city, campus.uav, home=home, speed=5.0, corridor=3.0)
print(mission)

# %% tags=["figure"]
plot.plan(city, {"planned: least risk, 4 m clear": route, "mission, with take-off and landing": mission.path(city)})

# %% [markdown]
# *The planned route and the legs of the mission, from above: a disc at the start, a triangle at the goal.* They are
# nowhere more than 3 m apart. The grey squares are what the planner sees of the buildings: voxels of 5 m.
#
# > **Try it.** Ask for a corner radius of 0.5 m on the way out of the notch. At how many corners does the mission stop
# > now? Why does it still stop at some?

# %% tags=["try-it"]
print(Mission.from_route(notch, table1, LIGHT_QUADROTOR, home=(8.5, 47.25), corner_radius=0.5).notes[-1])

# %% [markdown]
# At some corners it stops whatever the radius is: the planner's route itself is just 3.5 m from the wall on the inside
# of the corner, so that nothing may be cut.

# %% [markdown]
# ## A fence, and files
#
# Around the way runs a *fence*: a polygon on the map, at all heights, that the autopilot watches on its own. If the
# drone gets outside, ours flies home; a real one does what its settings say. No-fly zones go into the fence as polygons
# to stay outside of.
#
# A mission can be written for other programs: `to_plan` for QGroundControl, with fence; `to_wpl` for Mission Planner
# and MAVProxy; `to_kml`, `to_gpx` and `to_geojson` for maps. `read_plan` and `read_wpl` read it back. This is the
# second format. Line 0 is home. Each further line is an item: its number, 0, the frame (0 above sea, 3 above home), the
# command (22 take off, 178 change speed, 16 waypoint), four parameters, latitude, longitude, altitude, and a 1.

# %%
mission.to_plan("campus.plan")
mission.to_wpl("campus.waypoints")
print(*Path("campus.waypoints").read_text().expandtabs(6).splitlines()[:6], sep="\n")

# %% tags=["check"]
assert read_plan("campus.plan").items == read_wpl("campus.waypoints").items == mission.items
for name in ("campus.plan", "campus.waypoints"):
    Path(name).unlink()

# %% [markdown]
# ## Before every flight: the checklist
#
# Pilots don't trust their memory. They read a list aloud. `preflight` is such a list as a function. Each line has what
# was found, what was asked for, and where. For the battery and for crashes it flies the mission 200 times in the given
# weather.
#
# > **Predict first.** Chapter 08's route of least risk asks for no distance to the walls. It ends up 2.5 m from them at
# > the nearest place. We fly it 200 times at 5 m/s, in a wind of 3 m/s, with GPS that drifts. How many hit a wall? And
# > how many if the planner is asked for 4 m?

# %%
weather = Weather(forecast_wind=3.0, wind_from_deg=240.0)
trials = {}
for name, clearance, gps in (("0 m, perfect GPS", 0.0, PERFECT_GPS), ("0 m", 0.0, GPS), ("4 m", 4.0, GPS)):
    flight = Mission.from_route(
        least_risk(campus, *CAMPUS_FLIGHT, min_clearance=clearance), city, campus.uav, speed=5.0
    )
    trials[name] = preflight(flight, city, campus.uav, weather, gps=gps)["flights"]
    print(f"asked for {name}: {trials[name].value} of 200 crash")

# %% [markdown]
# Fifteen of 200 crash, though nothing is wrong with the route: with a perfect GPS none does. The autopilot doesn't know
# exactly where it is. Four metres are enough for this flight. This is the whole checklist of our delivery:

# %%
found = preflight(mission, city, campus.uav, weather)
print(found)

# %% tags=["check"]
assert found.passed
assert [trial.value for trial in trials.values()] == [0, 15, 0]

# %% [markdown]
# How to read it: in each line *found* has to keep what is *asked for*, and *in words* says where it is worst. The first
# half is geometry. "lift" and the wind are the limits of chapter 01. The last two lines no map could tell: they come
# from the flights. None of 200 crashed. That doesn't show that none ever will. The interval says: at most 1.8 %.
#
# > **Try it.** A payload of 0.9 kg, and a storm. Which checks fail, and which of them is the cause of the others?

# %% tags=["try-it"]
stormy = preflight(mission, city, campus.uav.loaded(0.9), Weather(forecast_wind=13.0, rain_mm_per_h=20.0), flights=60)
for check in stormy.failed:
    print(check.name, "|", check.words)

# %% [markdown]
# ## A radio that loses packets
#
# The mission has to get into the vehicle. A radio may lose any packet. So MAVLink's *mission protocol* never sends
# blindly. The ground station says how many items there are. The vehicle asks for item 0, gets it, asks for item 1, and
# so on. When an answer doesn't come, it asks again. In the end it says "accepted".
#
# Let a packet get lost with the probability $\ell$. A question with its answer gets through with $(1-\ell)^2$. With up
# to $k$ questions for each of $n$ items, all items arrive with the probability
#
# $$ P = \left(1 - \bigl(1 - (1-\ell)^2\bigr)^k\right)^n . \tag{2} $$

# %%
for tries in (1, 2, 5, 12):
    print(
        f"300 items, 10 % lost, up to {tries:2d} questions each: {(1 - (1 - 0.9**2) ** tries) ** 300:.3%} arrive whole"
    )

# %% [markdown]
# To ask once isn't enough; to ask up to twelve times nearly always is. But "nearly" isn't enough for a flight. What if
# the link breaks after item 150? Half a mission must never be flown. Three rules make sure of that:
#
# - The old mission is deleted first, so that it isn't flown by mistake. The fence comes before the mission, so that
#   there is never a mission without its fence.
# - The vehicle takes a mission whole or not at all.
# - The ground station reads all of it back and compares.
#
# Now we start the vehicle, in a process of its own. It stands at (12.5, 17.5) on the campus, and its radio is like the
# paper's: slow and late. We let it lose a tenth of all packets, ten times what we assume for the paper's radio. To save
# your time, its clock runs ten times as fast as yours.

# %%
gusty = Wind((2.6, 1.5), deviation=1.0, correlation=3.0)  # 3 m/s from 240°, gusts of 1 m/s that last 3 s
poor = replace(P840, loss=0.1)
print(P840, poor, sep="\n")

# %% [markdown]
# `jitter` is by how much the delay varies. The next function is the whole flight. The vehicle notes where it really was
# in a file (`truth`); no ground station could know that.


# %%
def flown(mission, checklist, wind, link=P840, screen=None, despite=False):
    """Upload a mission to a new vehicle, fly it, and give what the ground station heard."""
    log = FlightLog(mission, city, samples := [])
    started = simulated_vehicle(city, campus.uav, wind, (12.5, 17.5), rng=14, link=link, pace=10.0, truth="truth.csv")
    with started as vehicle, connect(vehicle.address) as radio:
        upload(mission, radio, checklist, despite=despite)
        print("read back:", repr(download(radio)))
        start(radio)
        for sample in follow(radio):
            samples.append(sample)
            if screen is not None and len(samples) % 150 == 0:
                screen.update(plot.ground_station(log))
    return log


# %% [markdown]
# ## The flight
#
# Run the next cell and look at the screen of the ground station. It is drawn anew every fifteen seconds of flight.

# %% tags=["figure"]
screen = display(plot.ground_station(FlightLog(mission, city, [])), display_id=True)
log = flown(mission, found, gusty, poor, screen=screen)
screen.update(plot.ground_station(log))

# %%
print(log, log.outcome)
print(f"farthest from the plan: {log.deviation.max():.2f} m; battery left: {log.battery[-1]:.0f} %")
for sample in log.samples:
    if sample.said:
        print(f"after {sample.time - log.time[0]:.0f} s the vehicle said:", *sample.said)

# %% tags=["check"]
assert log.outcome == "arrived"
assert log.deviation.max() < 2.5
assert np.hypot(*(log.position[-1] - roof)[:2]) < 4

# %% [markdown]
# *The paper's Fig. 15, with a plan beside the track.* The blue track lies on the dashed plan and rounds the corners. The
# whole flight is never more than about a metre off. It ends on the roof. The same in three dimensions, where the track
# hides the plan, and where you see that it climbs first:

# %% tags=["figure"]
scene.show(
    city, {"plan": mission.path(city)}, flights={"flown": log.flight()}, colors={"plan": plot.BLACK, "flown": plot.BLUE}
)

# %% [markdown]
# `log.to_csv("flight.csv")` keeps the track as a table. `connect(..., record="flight.tlog")` keeps every packet that
# was sent or heard, in the format that MAVLink's own tools replay.
#
# ## What the ground station doesn't see
#
# > **Predict first.** The track was never more than about a metre from the plan. How far was the *drone* from it?

# %%
truth = np.genfromtxt("truth.csv", delimiter=",", names=True)
wrong = np.hypot(truth["x_m"] - truth["gps_x_m"], truth["y_m"] - truth["gps_y_m"])
print(f"GPS was wrong by {wrong.max():.1f} m at most, and by {wrong[-1]:.1f} m in the end")

# %% tags=["check"]
Path("truth.csv").unlink()
assert wrong.max() > 1.0

# %% [markdown]
# The track is where the drone *believes* to be. The autopilot steers until GPS says "on the line". When GPS is wrong by
# 3 m, the drone is 3 m off, and the ground station shows a perfect flight. No picture like Fig. 15 can show that error.
#
# One flight is an anecdote. We fly the legs of the mission 200 times and note the true offset to
# the side. Two things push the drone there, and they are independent. Gusts push with a $\sigma_\text{g}$, which we
# measure in 200 flights with a GPS that doesn't err. GPS drifts: its error begins at 0 and after the time $t$ has
#
# $$ \sigma_\text{GPS}(t) = \sigma_0\sqrt{1 - e^{-2t/T}}, \qquad \sigma_0 = 4.7\text{ m},\quad T = 1100\text{ s} \tag{3} $$
#
# (Beard and McLain, section 7.5). That it begins at 0 is an assumption, and a kind one: home was surveyed, and the
# autopilot corrects its GPS there. A drone that is just switched on is off by $\sigma_0$ from the first second.
#
# So the offset to the side should have $\sigma^2 = \sigma_\text{g}^2 + \sigma_\text{GPS}^2(t)$.

# %%
legs = mission.path(city).en_route


def sideways(gps):
    """True offsets to the side (200, seconds) [m]."""
    autopilot = Autopilot(speed=5.0, gps=gps)
    return monte_carlo(legs, city, campus.uav, gusty, autopilot, rng=14, flights=200).offsets[..., 1]


offsets, push = sideways(GPS), np.nanstd(sideways(PERFECT_GPS))
time = np.arange(offsets.shape[1])
sigma = np.sqrt(push**2 + GPS.drift**2 * (1 - np.exp(-2 * time / GPS.correlation)))
inside = (np.abs(offsets) < 3 * sigma)[np.isfinite(offsets)]
print(f"gusts alone: σ = {push:.2f} m; with GPS {inside.mean():.1%} of {inside.size:,} moments are within 3σ")
print(f"after 40 s: σ = {np.nanstd(offsets[:, 40]):.2f} m flown, {sigma[40]:.2f} m by Eq. 3")

# %% tags=["check"]
assert inside.mean() > 0.98
assert abs(np.nanstd(offsets[:, 40]) / sigma[40] - 1) < 0.2
assert 0.05 < push < 0.3

# %% tags=["figure"]
bands = {"3σ of gusts and GPS": (-3 * sigma, 3 * sigma), "3σ of gusts": (-3 * push + 0 * sigma, 3 * push + 0 * sigma)}
figure = plot.lines(time, {"one of the 200 flights": offsets[0]}, "time after take-off [s]", "offset to the side [m]",
                    bands=bands, colors={"one of the 200 flights": plot.BLACK, "3σ of gusts": plot.ORANGE})  # fmt: skip
figure.axes[0].plot(time, offsets[1:].T, color="0.3", linewidth=0.4, alpha=0.3, label="_")
figure

# %% [markdown]
# *True offsets of 200 flights, a grey line each and one in black.* Nearly all stay within the blue band, which grows like the
# square root of the time; 99.7 % should. (The lines jump where the drone turns: its side is another one then.) What gusts add,
# and the ground station sees, is the narrow orange band. The route keeps 4.3 m to the walls. That is what $3\sigma$ has
# become at the end of this flight. A longer one between such walls needs another way to know where it is.
#
# ## When a check fails
#
# We plan a mission whose fence leaves only 60 cm, and fly it in strong gusts. The checklist fails. So `upload` refuses:

# %%
tight = Mission.from_route(route, city, campus.uav, home=home, speed=5.0, corridor=3.0, fence_margin=0.6)
storm = Wind((6.0, 3.5), deviation=2.5, correlation=4.0)
failed = preflight(tight, city, campus.uav, storm)
try:
    flown(tight, failed, storm)
except ValueError as error:
    print(error)

# %% [markdown]
# A pilot in a hurry says "fly all the same". There is a word for that, `despite=True`. We look at what happens:

# %% tags=["figure"]
hurried = flown(tight, failed, storm, despite=True)
for sample in hurried.samples:
    if sample.said:
        print(f"after {sample.time - hurried.time[0]:.0f} s:", *sample.said)
plot.ground_station(hurried)

# %% tags=["check"]
Path("truth.csv").unlink()
assert len(hurried.breaches) >= 1
assert hurried.outcome != "arrived"

# %% [markdown]
# *The drone gets over its fence (the first orange diamond and dotted line), and turns back home by itself.* Sixty
# centimetres are less than what gusts and a stop above the roof need. The package is not delivered. It is a safe end:
# the straight way home was checked, too, in the line *return height*. (Home itself lies at the edge of this fence. So
# the vehicle says it again while it lands.)
#
# One more mistake that can't happen: a mission that leaves its fence isn't even started.

# %%
corner = [city.to_geographic((x, y, 0.0))[:2][::-1] for x, y in ((0, 0), (60, 0), (60, 60), (0, 60))]
with simulated_vehicle(city, campus.uav, gusty, (12.5, 17.5)) as vehicle, connect(vehicle.address) as radio:
    upload(replace(mission, fence=(FencePolygon(tuple(map(tuple, corner)), inclusion=True),)), radio)
    try:
        start(radio)
    except CommandDeniedError as error:
        print(error)

# %% [markdown]
# ## Before a real flight
#
# The files of this chapter are in the format of QGroundControl, which talks to real Pixhawks. That doesn't make them
# fit to fly. Before a propeller turns, at least this has to change:
#
# - **The map.** Our campus is made up. A real map has trees, cranes, cables and antennas, and last year's buildings.
#   Walk the route. Look up.
# - **The vehicle.** Mass, thrust, drag and battery have to be those of yours. Measure the energy of a hover first.
# - **GPS.** Eq. 3 begins at 0 and is for open sky. Between buildings signals are reflected, and errors are much larger.
#   4 m are then no distance.
# - **The autopilot's own settings.** What it does when the link is lost, when the battery is low, and at a fence, is
#   set there, not in a mission. So is the height at which it returns; `upload` sets that one.
# - **The radio.** Others can hear and speak MAVLink, as we send it: unsigned, in the clear. And 840 MHz may not be used
#   freely everywhere.
# - **A person** with a transmitter in hand, who sees the drone and can take over.
#
# And the law. In the European Union, and in Switzerland, which has adopted its rules (Regulations 2019/945 and
# 2019/947), the *open category* needs no permission. It asks for a registered operator, a pilot with a
# certificate, a drone that is always in sight, at most 120 m above the
# ground, no flight over assemblies of people, and, for drones like ours, a distance from people who aren't involved.
# Each country adds its own no-fly zones. A delivery over a campus with people below is not in the open category. It
# belongs to the *specific* one, with an assessment of its risk and usually a permission of the authority. There are
# also rules on insurance, on identification by radio, and on privacy. Other countries have other rules.
# This is no legal advice: ask the authority of your country before you fly.
#
# `connect` talks to this machine only, unless you say `allow_network=True`. Then `upload` asks for a passed checklist.
#
# ## Remember
#
# - A mission needs a place on Earth, and its heights need to say what they are above: home, sea or terrain.
# - Leaving out waypoints can lead through a wall. Each leg and each corner has to be checked.
# - A lossy radio is no problem for a protocol that asks again, reads back, and takes a mission whole or not at all.
# - A ground station shows where the drone believes to be. The error of GPS grows with the time of flight, and no track
#   shows it.
# - A checklist is worth something only if a failed check stops the flight.
#
# ## What the paper says, what we find
#
# | RISK-ACO, section 4 | says | we find |
# |---|---|---|
# | Fig. 13 | multirotor, Pixhawk, GPS at 10 Hz, P400-840 at 840 MHz, ground station | the same four boxes in simulation; mass, speed, loss and delay aren't given, ours are assumed |
# | Fig. 14 | photographs in flight and landing | can't be checked; ours lands on a roof of 20 × 18 m |
# | Fig. 15 | the track on the ground station's map, without the plan | a track near the plan shows that the controller works, not where the drone was: gusts alone are 0.1 m, GPS is 1.2 m after 40 s |
# | "flies safely along the planned route of low risk, around the obstacles" | one flight | 0 of 200 of ours crash, so at most 1.8 % do; one flight without a crash only says: at most 97.5 % |
# | the algorithm is "effective and practical" | by that flight | can't be claimed from one flight: no wind, no distance to walls, no number of trials are given |
#
# ## Read on
#
# - *MAVLink Developer Guide*, "Mission protocol" and "Command protocol",
#   [mavlink.io](https://mavlink.io/en/services/mission.html): the messages of this chapter, one by one.
# - *QGroundControl User Guide*, "Plan view", [docs.qgroundcontrol.com](https://docs.qgroundcontrol.com): what your
#   mission looks like in the program that most pilots use.
# - R. W. Beard and T. W. McLain, *Small Unmanned Aircraft: Theory and Practice*, Princeton University Press, 2012,
#   chapters 7, 10 and 11: errors of GPS, and how autopilots follow lines and round corners.
# - U. Ramer, "An iterative procedure for the polygonal approximation of plane curves", *Computer Graphics and Image
#   Processing* 1 (1972) 244–256, and D. H. Douglas and T. K. Peucker, "Algorithms for the
#   reduction of the number of points required to represent a
#   digitized line or its caricature", *Cartographica* 10 (1973) 112–122,
#   [doi:10.3138/FM57-6770-U75U-7727](https://doi.org/10.3138/FM57-6770-U75U-7727): how points are left out.
# - Commission Implementing Regulation (EU) 2019/947,
#   [eur-lex.europa.eu](https://eur-lex.europa.eu/eli/reg_impl/2019/947/oj): who may fly what, where, and how high.
#
# ## Your turn
#
# Six exercises: how long is a digit, which height is meant, how far a corner may be cut, what a lossy link costs, how
# long a flight may be, and a mission of your own:
# [exercises/14_from_route_to_autopilot_exercises.ipynb](exercises/14_from_route_to_autopilot_exercises.ipynb).
#
# Before: [13 flying in gusts](13_flying_in_gusts.ipynb). Next: [15 The papers on trial](15_the_papers_on_trial.ipynb).
