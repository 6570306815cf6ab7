# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown] tags=["guide"]
# # 16 Your own city: can you plan a flight over a place that you know?
#
# All chapters so far gave you a city, people and a weather. Now you choose them. You take a district that you know,
# plan a drone's flight over it, check the plan, and hand in one page that somebody else can judge. At the end there is a
# table of points. Nothing is flown: what is still missing for a real flight is one of your answers.
#
# | | |
# |---|---|
# | **You will be able to** | get a city, people and terrain as files, and name their licences; find out what a reader assumed; plan, compare and check a flight over a real place; defend it in writing |
# | **You need** | chapters [04](04_cities.ipynb) (files), [05](05_astar.ipynb) (A\*), [08](08_risk_maps.ipynb) (risk), [12](12_bsplines_and_feasibility.ipynb) (curves), [13](13_flying_in_gusts.ipynb) (flights) and [14](14_from_route_to_autopilot.ipynb) (missions); a network to fetch files |
# | **Time** | 20 minutes to read, 30 seconds to run; two days for a project |
# | **Paper** | none: here you write it |
#
# ## How to work
#
# 1. Choose **Save Notebook As** in the menu **File**, and call your copy `my_city.ipynb`. Work in the copy.
# 2. Choose **Run All** once. You see the whole project on a small invented district, which the notebook writes as files.
# 3. Fetch your files. Put them into a folder `my_city` beside the notebook.
# 4. Change the cell **Settings**, and no other code. Choose **Restart Kernel and Run All Cells**.
# 5. If a cell stops with an error, read its last line. It names the setting, and says what would be right. It names
#    places in metres, x to the east and y to the north: `city.to_geographic((166, 50, 22))` in a new cell tells their
#    longitude and latitude.
# 6. Answer the nine questions in the cells that begin with **Answer**. Double-click such a cell to write.
# 7. Make the page (at the end), compare it with the checklist, and hand it in.

# %% tags=["guide"]
import json
import warnings
from pathlib import Path

import numpy as np
from IPython.display import Markdown
from pyproj import CRS

from uavlab import __version__, plot, scene
from uavlab.city import Place, read_city
from uavlab.flight import Autopilot, crash_rate, fly, monte_carlo
from uavlab.mission import Mission, preflight
from uavlab.planners import astar, least_risk, shortcut
from uavlab.resilience import safe_distance
from uavlab.risk import CARS_BY_CLASS, RiskMap, osm_layers, read_people, shelter_layer
from uavlab.route import Route
from uavlab.spline import feasibility, greatest_speed, smooth

warnings.filterwarnings("ignore", ".*city.source tells all")  # it is shown whole
COLORS = {"straight line": plot.BLACK, "shortest": plot.BLUE, "least risk": plot.ORANGE}

# %% [markdown] tags=["guide"]
# ## Where to get a city
#
# Take 300 m to 800 m on each side. Ten buildings are too few to be interesting, and a thousand take long to read.
#
# **OpenStreetMap**, anywhere on Earth. Open [overpass-turbo.eu](https://overpass-turbo.eu), move the map to your
# district, paste this, and press **Run**. Then choose **Export**, **GeoJSON**, **download**.
#
# ```
# [out:json][timeout:60][bbox:{{bbox}}];
# (
#   nwr["building"];
#   nwr["building:part"];
#   way["highway"];
#   nwr["landuse"];
#   nwr["leisure"~"^(park|garden)$"];
#   nwr["natural"~"^(wood|scrub|tree|tree_row)$"];
#   nwr["man_made"~"^(tower|mast|chimney|crane|silo|water_tower|storage_tank)$"];
#   nwr["power"~"^(tower|pole|portal|line|minor_line)$"];
# );
# out body;
# >;
# out skel qt;
# ```
#
# The reader takes heights from `height`, else from `building:levels` with 3 m for each storey (and `roof:height` or
# `roof:levels` on top), and undersides from `min_height`. Parts of a building (`building:part`) replace its outline.
# Many buildings have no height: then give `READING = {"default_height": 9.0}` with a height that is usual there. Trees,
# masts and power lines are points or lines, have no outline, and are *left out*. That matters to you. Roads come from
# `highway`, `lanes` and `width`, shelter from `landuse`, `leisure` and `natural`. Whole countries, for GIS programs,
# are at [download.geofabrik.de](https://download.geofabrik.de).
#
# **City models** in CityJSON have roofs. The [3DBAG](https://3dbag.nl) has all of the Netherlands in tiles (CC BY 4.0).
# Unpack the `.gz` file, and cut a large tile with the tool [cjio](https://github.com/cityjson/cjio):
#
# ```
# cjio tile.city.json subset --bbox 85000 446000 85500 446500 save my_city/city.city.json
# ```
#
# Other cities are listed at
# [github.com/OloOcki/awesome-citygml](https://github.com/OloOcki/awesome-citygml); CityGML can be converted with
# [citygml-tools](https://github.com/citygml4j/citygml-tools). CityJSON tells its system of coordinates and its unit;
# where it doesn't, `READING = {"crs": "EPSG:…"}` does, and `"height_unit": "ft"`. Such models have no roads: fetch
# these from OpenStreetMap for `ROADS`, or write `None`.
#
# ## Where to get people, terrain and weather
#
# | what | where | what it is | licence |
# |---|---|---|---|
# | people | [GHS-POP](https://human-settlement.emergency.copernicus.eu/download.php?ds=pop), the world in tiles | residents in each pixel of 100 m or 3″, GeoTIFF | CC BY 4.0 |
# | people | [WorldPop](https://hub.worldpop.org), by country | residents in each pixel of 3″ (about 100 m), GeoTIFF | CC BY 4.0 |
# | terrain | your country's survey: search for "DTM" | heights of the ground, often of 1 m to 10 m pixels | see there |
# | terrain | [Copernicus DEM](https://copernicus-dem-30m.s3.amazonaws.com/readme.html), nearly the world | heights of the *surface*, with roofs and trees, 30 m, GeoTIFF | its own, free, with a notice |
# | weather | [PVGIS](https://re.jrc.ec.europa.eu/pvg_tools/en/tools.html), "TMY" | a typical year of hours, CSV | see there |
#
# `read_people` reads only the part around your city, so the file may be large. A file of terrain is read whole, so cut it
# first. The tool comes with rasterio; the bounds are west, south, east and north in degrees:
#
# ```
# rio clip large.tif my_city/terrain.tif --geographic --bounds "11.00 50.00 11.01 50.01"
# ```
#
# The piece has to reach 50 m beyond the buildings on each side. In a flat place take `TERRAIN = None`; do so, too, if you
# only have a surface with roofs, because they would count as hills. The ground of a CityJSON file comes from that file.
#
# `RECORD` is a CSV file of hours, whose first line names the columns with their units. Of a file of PVGIS keep the column
# `WS10m` alone, and call it `wind speed [m/s]`.
#
# ## What the licences ask
#
# **ODbL**, of OpenStreetMap. Your page is a *produced work*: it has to say where the data are from, "© OpenStreetMap
# contributors", with a link to [openstreetmap.org/copyright](https://www.openstreetmap.org/copyright), which names the
# licence. A *database* that you make from the data and give to others, such as your GeoJSON file with better heights, has to
# be under the ODbL as well ("share-alike").
#
# **CC BY 4.0.** Name who made the data, link the licence, and say what you changed ("cut to the district, brought to a
# grid of 4 m"). GHS-POP also asks to be cited as its page for downloads says. **Others**: look for "licence" or
# "terms of use", and copy the notice that they ask for. If you find none, you have no permission.
#
# This is no legal advice. Look also whether the place is sensitive: a plan over a prison or an airport is a bad idea.

# %% [markdown] tags=["guide"]
# ## A district to begin with
#
# The next cells write the example: buildings, roads and land as OpenStreetMap exports them, people as WorldPop has them
# (only as text), and terrain. Everything in it is invented.

# %% tags=["guide"]
FOLDER = Path("example_district")
FOLDER.mkdir(exist_ok=True)
CORNER = Place(11.0, 50.0)


def ring(west, south, east, north):
    """A rectangle in metres as a closed ring of longitudes and latitudes."""
    corners = [(west, south), (east, south), (east, north), (west, north), (west, south)]
    return CORNER.longitude_latitude(corners).round(7).tolist()


def feature(number, kind, coordinates, **tags):
    """An object as Overpass turbo exports it: an id, and tags as text."""
    name = f"{'relation' if len(coordinates) == 2 and kind == 'Polygon' else 'way'}/{number}"
    tags = {key.replace("__", ":"): value for key, value in tags.items()}
    geometry = {"type": kind, "coordinates": coordinates}
    return {"type": "Feature", "properties": {"@id": name, **tags}, "geometry": geometry, "id": name}


# %% tags=["guide"]
B = [  # west, south, east, north [m], and tags
    ((180, 20, 240, 80), {"building": "commercial", "height": "12"}),
    ((190, 30, 220, 60), {"building:part": "yes", "height": "45", "name": "tower"}),
    ((20, 140, 60, 158), {"building": "house"}), ((70, 140, 110, 158), {"building": "house"}),
    ((180, 140, 232, 200), {"building": "office", "building:levels": "12"}),
    ((255, 140, 283, 205), {"building": "church", "height": "38 m"}),
    ((262, 20, 310, 80), {"building": "warehouse", "height": "9.5"}),
    ((15, 172, 140, 235), {"leisure": "park"}), ((15, 200, 90, 235), {"natural": "wood"}),
]  # fmt: skip
features = [feature(n, "Polygon", [ring(*box)], **tags) for n, (box, tags) in enumerate(B, 100)]
court = [ring(20, 20, 110, 88), ring(45, 42, 85, 66)[::-1]]
features.append(feature(90, "Polygon", court, building="school", building__levels="4"))
R = {"primary": [(-10, 112), (330, 112)], "residential": [(148, -10), (148, 250)], "service": [(148, 165), (15, 165)]}
for n, (kind, line) in enumerate(R.items(), 200):
    lanes = {"lanes": "4"} if kind == "primary" else {}
    features.append(feature(n, "LineString", CORNER.longitude_latitude(line).tolist(), highway=kind, **lanes))
features.append(feature(300, "Point", CORNER.longitude_latitude((130, 60)).tolist(), natural="tree"))
_ = (FOLDER / "buildings.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": features}))
# %% tags=["guide"]
people = [[2, 1, 1, 4, 9, 12, 9, 5], [2, 2, 3, 30, 90, 40, 9, 5], [3, 4, 6, 160, 240, 90, 8, 5], [3, 40, 60, 90, 80, 20, 4, 5],
          [3, 5, 9, 8, 5, 5, 3, 2]]  # fmt: skip
x, y = np.meshgrid(np.arange(12), np.arange(12)[::-1])  # the first row lies in the north
hill = 210 + 0.3 * x + 0.5 * y
grids = {"people": (people, 10.9985, 49.9985, 1 / 1200), "terrain": (hill.round(2), 10.9985, 49.999, 1 / 1800)}
for name, (rows, west, south, pixel) in grids.items():
    head = f"ncols {len(rows[0])}\nnrows {len(rows)}\nxllcorner {west}\nyllcorner {south}\ncellsize {pixel:.9f}\n"
    (FOLDER / f"{name}.asc").write_text(head + "\n".join(" ".join(map(str, row)) for row in rows))
    (FOLDER / f"{name}.prj").write_text(CRS(4326).to_wkt("WKT1_ESRI"))

# %% [markdown] tags=["guide"]
# ## Settings
#
# Everything that is yours stands in this cell. On [openstreetmap.org](https://www.openstreetmap.org) a right click and
# **Show address** shows a place as latitude, longitude. Here *longitude comes first*. Heights are above the ground; that of
# `START` and `GOAL` is raised to `MIN_HEIGHT` if it is lower, and the mission adds take-off and landing.

# %%
from uavlab.vehicle import LIGHT_QUADROTOR
from uavlab.weather import Weather, Wind, grounded_by, read_weather

TITLE, NAME = "A parcel over the invented district", "Ada Example"
CITY = "example_district/buildings.geojson"  # GeoJSON or CityJSON
READING = {"default_height": 9.0}  # options of the reader; for CityJSON {}
ROADS = "example_district/buildings.geojson"  # GeoJSON with roads and land, or None
PEOPLE = "example_district/people.asc"  # GeoTIFF or ASCII grid of people per pixel, or None
ASSUMED_PEOPLE = 5000  # per km², where PEOPLE says nothing
TERRAIN = "example_district/terrain.asc"  # GeoTIFF or ASCII grid of heights, or None
START, GOAL = (11.00011, 50.00101, 25), (11.0043, 50.00105, 25)  # longitude, latitude, height above the ground [m]
CELL, MIN_HEIGHT, MAX_HEIGHT = 4.0, 15.0, 120.0  # edge of a voxel, least and greatest height above the ground [m]
UAV = LIGHT_QUADROTOR.loaded(0.5)  # with a load of 0.5 kg
WEATHER = Weather(forecast_wind=4, wind_from_deg=240)  # m/s; the wind comes from there; rain_mm_per_h=1 for rain
RECORD = None  # CSV of hours to compare with, or None
GPS_ROOM = 1.5  # room for GPS errors [m]
DETOUR = 0.2  # how much longer the route of least risk may be than the shortest
CHOICE = "least risk"  # or "shortest": what becomes the mission
SOURCES = ["Buildings, roads, land, people and terrain: invented; nobody has to be named"]

# %% [markdown] tags=["guide"]
# **When something is missing.** `PEOPLE = None`: as many people everywhere, `ASSUMED_PEOPLE`. `ROADS = None`: no cars,
# and no shelter but roofs. `TERRAIN = None`: level ground, or what the city's file says. A city *without a place on
# Earth*: `PEOPLE` and `ROADS` have to be `None`, `START` and `GOAL` are x and y in metres and the height above the
# ground, and the mission begins at 0° N, 0° E. The project says so in each case. A large city: take a larger `CELL`.
# Planning takes about 20 s for a million voxels.
#
# ## What a good answer is
#
# A good answer has a number or names a thing in a figure, says where it comes from, and admits what isn't known. Three
# to six sentences are enough. Below each heading stands what to do; your answer goes into the cell after the question.

# %%
Markdown(f"# {TITLE}\n\n{NAME}. A plan made with uavlab {__version__}. It is an exercise, not to be flown.")

# %% [markdown]
# ## 1 The question
#
# > **Question 1.** Who flies what from where to where, why by air, and who on the ground could be harmed?

# %% [markdown]
# **Answer 1.** …

# %% [markdown] tags=["guide"]
# A good answer names a sender and a receiver, a load with its mass, and the other way of doing it (a bicycle?).

# %% [markdown]
# ## 2 The city as it was read

# %% tags=["nbval-check-output"]
city = read_city(CITY, cell=CELL, terrain=TERRAIN, **READING)
if city.reference is None:
    print("This city has no place on Earth: START and GOAL are in metres.")
else:
    corners = city.to_geographic([(*city.bounds[end, :2], 0.0) for end in (0, 1)])
    print("from {:.5f}°, {:.5f}° to {:.5f}°, {:.5f}° (longitude, latitude)".format(*corners[:, :2].ravel()))
print(city)
city.source


# %%
def on_map(name, point):
    """A place of the settings on the map [m]."""
    x, y = point[:2] if city.reference is None else city.from_geographic((*point[:2], 0.0))[:2]
    if not city.inside((x, y, city.bounds[:, 2].mean())):
        box = np.round(city.bounds[:, :2]).tolist()
        raise ValueError(
            f"{name} = {point} is at x = {x:.0f} m, y = {y:.0f} m, off the map from {box[0]} to {box[1]}: "
            "longitude comes first"
        )
    height = max(point[2], MIN_HEIGHT + CELL / 2)  # the mission adds take-off and landing
    return np.array([x, y, height - city.height_above_ground((x, y, 0.0))])


start, goal = on_map("START", START), on_map("GOAL", GOAL)

# %% tags=["figure"]
plot.plan(city, Route([start, goal], "straight line"), colors=COLORS)

# %% [markdown]
# *The district from above: darker is higher. A disc marks the start, a triangle the goal.*
#
# > **Question 2.** What did the reader assume, mend and leave out? Look at three buildings and at what isn't there
# > (trees, cranes, cables): compare with what you see on the spot, or in pictures. What does that mean for the flight?

# %% [markdown]
# **Answer 2.** …

# %% [markdown] tags=["guide"]
# A good answer quotes the table ("2 × height of 9 m"), compares heights with storeys that you counted, and says on which
# side the error lies: too high costs a detour, too low costs a drone.

# %% [markdown]
# ## 3 The people below

# %% tags=["nbval-check-output"]
assumed = ASSUMED_PEOPLE / 1e6
people = read_people(city, PEOPLE, elsewhere=assumed) if PEOPLE else None
ground = osm_layers(city, ROADS, cars_per_km=CARS_BY_CLASS) if ROADS else None
shelter, cars = (ground.shelter, ground.vehicle_share) if ROADS else (shelter_layer(city), 0.0)
risk_map = RiskMap(city, people.density if PEOPLE else assumed, shelter, cars, uav=UAV, min_height=MIN_HEIGHT)
print(people.source if PEOPLE else f"ASSUMED: {ASSUMED_PEOPLE} people per km² everywhere")
print(ground.source if ROADS else "ASSUMED: no cars, and no shelter but roofs")

# %% tags=["figure"]
plot.layers(risk_map)

# %% tags=["check"]
assert risk_map.population_density.shape == city.shape[:2]
assert (risk_map.person_rate >= 0).all()

# %% [markdown]
# *What lies on the ground: people, shelter by roofs, trees and industry, and cars.*
#
# > **Question 3.** Where are the people, and when? The file counts residents, as if all were at home and outdoors but for
# > the shelter of roofs. Which place has more people at the time of your flight than the map shows?

# %% [markdown]
# **Answer 3.** …

# %% [markdown] tags=["guide"]
# A good answer gives the number of people on the map, says whether it is plausible, and names a school, a station or a
# market with its hours.

# %% [markdown]
# ## 4 The weather, and the distance to keep
#
# As in chapter 00 the UAV keeps $D_\text{min} = \xi + D_\text{uav}/2$ to all walls, with the offset $\xi$ that gusts
# cause and its diameter $D_\text{uav}$. To this comes room for errors of GPS.

# %% tags=["nbval-check-output"]
reasons = grounded_by(UAV, WEATHER)
if reasons:
    raise ValueError(f"WEATHER grounds the UAV: {'; '.join(reasons)}")
needed = safe_distance(UAV.payload, WEATHER, reading="physical", uav=UAV)
distance = needed + GPS_ROOM
print(WEATHER)
print(f"{needed:g} m for gusts and the body, {GPS_ROOM:g} m for GPS: keep {distance:g} m")
if RECORD:
    winds = read_weather(RECORD).columns["wind_speed"]
    share = np.mean(winds[np.isfinite(winds)] <= WEATHER.reference_wind.mean)
    print(f"{100 * share:.0f} % of {np.isfinite(winds).sum()} hours in {RECORD} have no more wind than that")

# %% [markdown]
# > **Try it.** How does the distance change with the wind?

# %% tags=["try-it"]
for speed in (2, 4, 6, 8):
    more = safe_distance(UAV.payload, Weather(forecast_wind=speed), reading="physical", uav=UAV)
    print(f"wind of {speed} m/s: {more + GPS_ROOM:g} m")

# %% [markdown]
# > **Question 4.** Why this weather? How often is it worse there, and what would you do then? Why this room for GPS?

# %% [markdown]
# **Answer 4.** …

# %% [markdown] tags=["guide"]
# A good answer names a source (a station, a typical year) and a share of the hours. For GPS see chapter
# [13](13_flying_in_gusts.ipynb): its errors grow with the time of flight.

# %% [markdown]
# ## 5 Two planners
#
# A\* looks for the shortest route that keeps the distance. `least_risk` keeps it, too, and looks for the fewest expected
# deaths on the ground, on a route that is at most `DETOUR` longer.
#
# > **Predict first.** How much longer will the second route be, and which part of the risk will be left? Where will it go?

# %% tags=["nbval-check-output"]
limits = {"min_clearance": distance, "min_height": MIN_HEIGHT, "max_height": MAX_HEIGHT}
routes = {"shortest": astar(city, start, goal, **limits)}
longest = (1 + DETOUR) * routes["shortest"].en_route.length  # without take-off and landing
if longest > 0:
    routes["least risk"] = least_risk(risk_map, start, goal, max_length=longest, **limits)
for name, route in routes.items():
    if not route.reached:
        raise ValueError(f"no {name} route, {route.reason}: change START, GOAL, WEATHER, DETOUR, CELL or the heights")
    deaths = 1e9 * risk_map.fatalities(route)
    print(
        f"{name}: {route.length:.0f} m, clearance {route.en_route.clearance(city):.1f} m, {deaths:.3g} deaths in 10⁹ flights"
    )

# %% tags=["check"]
assert all(route.en_route.clearance(city) >= distance - 1e-9 for route in routes.values())
assert routes["least risk"].en_route.length <= longest + 1e-9

# %% tags=["figure"]
plot.risk(risk_map, float(np.median(routes["least risk"].points[:, 2])), routes, colors=COLORS)

# %% tags=["figure"]
plot.profile(city, routes, safe_distance=distance, colors=COLORS)

# %% [markdown]
# *Above: the risk at the height of the route of least risk, and both routes. Below: height and clearance along them.*
#
# > **Try it.** What does a smaller detour save, and a larger one?

# %% tags=["try-it"]
for more in (0.05, 0.5):
    other = least_risk(risk_map, start, goal, max_length=(1 + more) * routes["shortest"].en_route.length, **limits)
    said = f"{1e9 * risk_map.fatalities(other):.3g} deaths in 10⁹ flights" if other.reached else other.reason
    print(f"{100 * more:g} % longer: {said}")

# %% [markdown]
# > **Question 5.** Compare both routes in length, clearance and risk. What does the second avoid, and which do you
# > choose? How far off was your guess?

# %% [markdown]
# **Answer 5.** …

# %% [markdown] tags=["guide"]
# A good answer says how certain the risk is: a factor of two in the number of people changes both routes' risks, but
# hardly their ratio. It compares the risk with something else, such as the failures of 6.4 in 100 000 hours.

# %% [markdown]
# ## 6 A curve that can be flown

# %%
wind = Wind.from_weather(WEATHER)
straight = {"shortest": shortcut(routes["shortest"], city), "least risk": routes["least risk"]}
curves = {name: smooth(route, city, UAV) for name, route in straight.items()}
speeds, reports = {}, {}
for name, curve in curves.items():
    speeds[name] = min(greatest_speed(curve, UAV, wind.mean), UAV.cruise_speed) or UAV.cruise_speed
    reports[name] = feasibility(curve, city, UAV, speed=speeds[name], wind=wind.mean)
    broken = ", ".join(limit.name for limit in reports[name].limits if not limit.met) or "nothing"
    print(f"{name}: {curve.length:.0f} m at {speeds[name]:.1f} m/s; beyond its limit: {broken}")
reports[CHOICE]

# %% [markdown]
# > **Question 6.** Which limit is nearest, or broken, and where? What would you change?

# %% [markdown]
# **Answer 6.** …

# %% [markdown] tags=["guide"]
# A good answer names the limit with its number, and a cure that fits: a slower flight doesn't help against a wall.

# %% [markdown]
# ## 7 Two hundred flights
#
# > **Predict first.** How many of 200 flights will crash on each curve?

# %% tags=["nbval-check-output"]
flights = {
    name: monte_carlo(curve, city, UAV, wind, Autopilot(speed=speeds[name]), rng=1, flights=200)
    for name, curve in curves.items()
}
rates = {name: crash_rate(flown) for name, flown in flights.items()}
for name, flown in flights.items():
    outcomes = dict(zip(*np.unique(flown.outcome, return_counts=True), strict=True))
    said = ", ".join(f"{count} {outcome}" for outcome, count in outcomes.items())
    print(f"{name}: {said}; crashes {rates[name]}; least clearance {flown.clearance.min():.2f} m")

# %% tags=["figure"]
ones = {name: fly(curve, city, UAV, wind, Autopilot(speed=speeds[name]), rng=1) for name, curve in curves.items()}
scene.show(city, flights=ones, risk=risk_map, wind=wind, uav=UAV, colors=COLORS)

# %% [markdown]
# *One flight along each curve, in three dimensions. Drag turns the scene. The ground is coloured by its risk.*
#
# > **Question 7.** What do the 200 flights show, and what do they not? Quote the interval. How far off was your guess?

# %% [markdown]
# **Answer 7.** …

# %% [markdown] tags=["guide"]
# No crash in 200 flights agrees with a rate of up to 18 in 1 000. A good answer says so, and what the simulation lacks.

# %% [markdown]
# ## 8 Preflight, and the mission

# %%
home = None if city.reference else (0.0, 0.0)
mission = Mission.from_route(curves[CHOICE], city, UAV, home=home, speed=speeds[CHOICE], corridor=2.0)
mission.to_plan(Path(CITY).parent / "mission.plan")
mission.to_kml(Path(CITY).parent / "mission.kml", city)
print(f"{len(mission.items)} items", *mission.notes, sep="; ")
if home:
    print("The mission's place on Earth is invented.")
checklist = preflight(mission, city, UAV, WEATHER)
checklist

# %% [markdown]
# > **Question 8.** Did the checklist pass? Explain the two lines that are nearest to their limits, or that fail. What is
# > missing before this could be flown: on the map, in the drone, in law?

# %% [markdown]
# **Answer 8.** …

# %% [markdown] tags=["guide"]
# Two files of the mission now lie beside your city: `mission.plan` for QGroundControl, and `mission.kml` for maps.
# A good answer takes a failed line seriously: change the plan, or say why it must not be flown. Chapter
# [14](14_from_route_to_autopilot.ipynb), "Before a real flight", has a list. Ask the authority of your country.

# %% [markdown]
# ## 9 What follows
#
# > **Question 9.** Would you let it fly? Give the strongest reason for and the strongest against. Which one file or
# > number, if it were better, would change your plan most?

# %% [markdown]
# **Answer 9.** …

# %% [markdown]
# ## Sources and licences

# %%
files = {"city": CITY, "roads and land": ROADS, "people": PEOPLE, "terrain": TERRAIN, "weather": RECORD}
used = "; ".join(f"{what} from {Path(file).name}" for what, file in files.items() if file)
Markdown(
    "\n".join(
        [
            *(f"- {source}" for source in SOURCES),
            f"- Files: {used}",
            f"- Weather: {str(WEATHER)[1:-1].removeprefix('Weather: ')}",
        ]
    )
)

# %% [markdown] tags=["guide"]
# ## The page to hand in
#
# 1. **Restart Kernel and Run All Cells**, then **Save Notebook**. The page holds what was saved: nothing is run again.
# 2. Open a **Terminal** in JupyterLab, go to the folder of the notebook, and call
#    `python build.py --page my_city.ipynb`. It writes `my_city.html` beside the notebook.
# 3. Open that file in a browser. It needs no network: figures, tables, the scene and your answers are inside. Our
#    explanations are left out, and code is folded.
#
# The command refuses a notebook whose cells weren't run from top to bottom, and lists questions without an answer. If
# you have the notebook alone and not its folder, `jupyter nbconvert --to html my_city.ipynb` does nearly the same: the
# scene is in, our explanations too, and equations need a network.
#
# ## Before you hand in
#
# - All nine answers are written, each with a number or a thing in a figure.
# - `SOURCES` names each file: who made it, its licence with a link, the day, and what you changed. For example: `"Buildings,
#   roads, land: © OpenStreetMap contributors, ODbL 1.0, https://www.openstreetmap.org/copyright, exported 1 May"`.
# - You looked at the table of the reader, and at three buildings.
# - No cell failed. What is assumed is said as assumed.
# - You opened the page on another computer, or without a network, and the scene turns.
#
# ## How it is marked
#
# | | all points | about half | none | points |
# |---|---|---|---|---|
# | Question | who, what, why, and who may be harmed; another way is weighed | a flight without a reason | none | 10 |
# | City | the reader's table is explained, three buildings are compared, what is left out is judged | the table is copied | taken on trust | 15 |
# | People | the number is checked for plausibility; time of day, shelter and cars are discussed | the map is described | not looked at | 15 |
# | Weather and distance | from a source, with a share of hours; GPS is argued | a guess, said as one | default | 10 |
# | Planners | length, clearance and risk compared, the difference is explained on the map, a choice is defended | numbers without reasons | one planner | 15 |
# | Curve and flights | limits and speed explained; interval quoted and understood | "no crash, so it is safe" | none | 15 |
# | Preflight and judgement | nearest or failed lines are explained and acted on; what is missing for a real flight | "passed" | none | 10 |
# | Page | opens offline, reads well, all sources with licences and changes | a licence is missing | no sources | 10 |
#
# A failed checklist that is understood earns more than a passed one that isn't.
#
# ## Remember
#
# - A plan is as good as its files. A reader that says what it assumed tells you where to look.
# - Left out doesn't mean not there: trees, cranes and cables are in no file of buildings.
# - People in a file are at home. Those below your flight are not.
# - Compare two plans on the same map: errors of the map that both share matter less.
# - Free data have authors. Naming them is the price.
#
# ## Read on
#
# - *OpenStreetMap Wiki*, "Simple 3D Buildings", [wiki.openstreetmap.org](https://wiki.openstreetmap.org/wiki/Simple_3D_Buildings):
#   which tags heights and roofs have.
# - *Open Database License*, [opendatacommons.org](https://opendatacommons.org/licenses/odbl/1-0/), and *CC BY 4.0*,
#   [creativecommons.org](https://creativecommons.org/licenses/by/4.0/): the licences themselves, and their summaries.
# - H. Ledoux and others, "CityJSON: a compact and easy-to-use encoding of the CityGML data model", *Open Geospatial
#   Data, Software and Standards* 4 (2019) 4, [doi:10.1186/s40965-019-0064-0](https://doi.org/10.1186/s40965-019-0064-0):
#   the format of city models.
# - M. Schiavina and others, *GHS-POP R2023A*, European Commission, Joint Research Centre 2023,
#   [doi:10.2905/2FF68A52-5B5B-4A22-8F40-C41DA8332CFE](https://doi.org/10.2905/2FF68A52-5B5B-4A22-8F40-C41DA8332CFE): how
#   residents are shared out to pixels.
#
# Before: [14 From route to autopilot](14_from_route_to_autopilot.ipynb).
