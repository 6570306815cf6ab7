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
# | **Time** | 20 minutes to read, 1 minute to run; two days for a project |
# | **Paper** | none: here you write it |
#
# ## How to work
#
# 1. Choose **Save Notebook As** in the menu **File**, and call your copy `my_city.ipynb`. Work in the copy.
# 2. Choose **Run All** once. You see the whole project on a small invented district, which the notebook writes as files.
# 3. Fetch your files. Put them into a folder `my_city` beside the notebook.
# 4. Change the cell **Settings**, with your guesses in it, and no other code. Choose **Restart Kernel and Run All Cells**.
# 5. If a cell stops with an error, read its last line. It names the settings to look at, and places as they have them.
#    For another place in metres, x to the east and y to the north, `as_setting((166, 50, 30))` in a new cell gives
#    longitude, latitude and height above the ground. Delete that cell afterwards.
# 6. Answer the nine questions in the cells that begin with **Answer**. Double-click such a cell to write.
# 7. Make the page (at the end), compare it with the checklist, and hand it in.

# %% tags=["guide"]
import json
import re
import warnings
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np
import shapely
from IPython.display import Markdown, display
from pyproj import CRS
from scipy.ndimage import distance_transform_edt

# %% tags=["guide"]
from uavlab import __version__, plot, scene
from uavlab.city import Place, read_city, read_terrain
from uavlab.flight import GPS, Autopilot, crash_rate, fly, monte_carlo
from uavlab.mission import Mission, preflight
from uavlab.planners import astar, least_risk, shortcut
from uavlab.resilience import safe_distance
from uavlab.risk import CARS_BY_CLASS, RiskMap, ground_risk_buffer, osm_layers, read_people, shelter_layer
from uavlab.spline import feasibility, greatest_speed, smooth
from uavlab.statistics import share_interval
from uavlab.weather import Weather, Wind, grounded_by, read_weather

warnings.filterwarnings("ignore", ".*city.source tells all")  # it is shown whole
COLORS = {"straight line": plot.BLACK, "shortest": plot.BLUE, "least risk": plot.ORANGE, "streets": "0.6"}

# %% [markdown] tags=["guide"]
# ## Where to get a city
#
# Take 300 m to 800 m on each side; 0.01° of latitude is 1 100 m. Roads and land that run out of it are cut. Ten
# buildings are too few to be interesting, and a thousand take long to read.
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
# masts and power lines are points or lines, have no outline, and are *left out*. That matters to you. So does water,
# which isn't asked for: a raster's residents are spread over a river, too. Roads come from `highway`, `lanes` and
# `width`. Shelter is 0.25 on land that is residential, a park, a garden, a cemetery, an orchard, scrub or a row of trees,
# 0.5 in woods, 0.75 below roofs, and 1 on industrial land; the greatest counts, and other land has none. Whole countries,
# for GIS programs, are at [download.geofabrik.de](https://download.geofabrik.de).
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
# these from OpenStreetMap for `ROADS`, or write `None`. Bridges and plants in them are obstacles that shelter like roofs.
#
# ## Where to get people, terrain and weather
#
# | what | where | what it is | licence |
# |---|---|---|---|
# | people | [GHS-POP](https://human-settlement.emergency.copernicus.eu/download.php?ds=pop), the world in tiles | residents in each pixel of 100 m or 3″: take the epoch next to this year and the tile of your place, unpack the `.zip` | CC BY 4.0 |
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
# The piece has to reach 50 m beyond the buildings on each side. An ASCII grid (`.asc`) names its system of coordinates in
# a file of the same name with the ending `.prj`. If yours has none, its page says the system: `TERRAIN_CRS =
# "EPSG:25832"`. Heights of `TERRAIN` have to be above the sea. In a flat place take `None`; do so, too, if you only have a
# surface with roofs, because they would count as hills. The ground of a CityJSON file comes from that file.
#
# `RECORD` is a CSV file of hours: that of PVGIS as it is, or one whose first line names its columns, `wind speed [m/s]`.
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
# "terms of use", and copy the notice that they ask for. The licence of a repository is often that of its programs: the
# data's own counts. If you find none, you have no permission.
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
#
# > **Predict first.** Before you run it on your files, write into `GUESSES`: how much longer will the route of least risk
# > be than the shortest one, how much of its risk will be left, and how many of 200 flights will crash?

# %% tags=["guide"]
from uavlab.vehicle import LIGHT_QUADROTOR

TITLE, NAME = "A parcel over the invented district", "Ada Example"
COURSE, DATE, PLACE = "Planning flights, group 3", "1 May", "an invented district at 50° N, 11° E"
CITY = "example_district/buildings.geojson"  # GeoJSON or CityJSON
READING = {"default_height": 9.0}  # options of the reader; for CityJSON {}
ROADS = "example_district/buildings.geojson"  # GeoJSON with roads and land, or None
PEOPLE = "example_district/people.asc"  # GeoTIFF or ASCII grid of people per pixel, or None
ASSUMED_PEOPLE = 5000  # per km², where PEOPLE says nothing
TERRAIN = "example_district/terrain.asc"  # GeoTIFF or ASCII grid of heights above the sea, or None
TERRAIN_CRS = None  # such as "EPSG:25832", for an .asc without a .prj
START, GOAL = (11.00011, 50.00101, 25), (11.0043, 50.00105, 25)  # longitude, latitude, height above the ground [m]
CELL, MIN_HEIGHT, MAX_HEIGHT = 4.0, 15.0, 120.0  # edge of a voxel, least and greatest height above the ground [m]
UAV = LIGHT_QUADROTOR.loaded(0.5)  # with a load of 0.5 kg
WEATHER = Weather(forecast_wind=4, wind_from_deg=240)  # m/s; the wind comes from there; rain_mm_per_h=1 for rain
RECORD = None  # CSV of hours to compare with, or None
GPS_SIGMAS = 2.0  # room for GPS, in standard deviations of its error
DETOUR, CHOICE = 0.2, "least risk"  # how much longer it may be than the shortest; or "shortest", for the mission
GUESSES = {"longer [%]": 5, "risk left [%]": 50, "crashes of 200": 0}  # before you run
SOURCES = ["Buildings, roads, land, people and terrain: invented; nobody has to be named"]

# %% [markdown] tags=["guide"]
# **When something is missing.** `PEOPLE = None`: as many people everywhere, `ASSUMED_PEOPLE`. `ROADS = None`: no cars,
# and no shelter but roofs. `TERRAIN = None`: level ground, or what the city's file says. A city *without a place on
# Earth*: `PEOPLE` and `ROADS` have to be `None`, `START` and `GOAL` are x and y in metres and the height above the
# ground, and the mission begins at 0° N, 0° E. The project says so in each case. A large city: take a larger `CELL`.
# With half the `CELL` there are eight times as many voxels; for a million of them planning takes about a minute.
#
# The next cell looks at your settings, and helps later ones to say which of them is wrong.

# %% tags=["guide"]
FILES = {"CITY": CITY, "ROADS": ROADS, "PEOPLE": PEOPLE, "TERRAIN": TERRAIN, "RECORD": RECORD}
for setting, file in FILES.items():
    if isinstance(file, str) and not Path(file).is_file():
        raise ValueError(f"{setting} = {file!r}: there is no such file. Paths begin at {Path.cwd()}")
for setting, place in {"START": START, "GOAL": GOAL}.items():
    if len(place) != 3:
        raise ValueError(f"{setting} = {place} must be three numbers: longitude, latitude, height above the ground")
if CHOICE not in ("least risk", "shortest"):
    raise ValueError(f"CHOICE = {CHOICE!r} must be 'least risk' or 'shortest'")
if DETOUR < 0 or GPS_SIGMAS < 0:
    raise ValueError("DETOUR and GPS_SIGMAS must not be negative")
if str(TERRAIN).endswith(".asc") and not TERRAIN_CRS and not Path(TERRAIN).with_suffix(".prj").is_file():
    raise ValueError(f"TERRAIN_CRS: {TERRAIN} has no .prj beside it. Give its system, such as 'EPSG:25832', or 'local'")


def as_setting(point):
    """A place on the map [m], its height z as on the map, as START and GOAL have it."""
    plan = point[:2] if city.reference is None else city.to_geographic(point)[:2]
    return (*np.round(plan, 6).tolist(), round(float(city.height_above_ground(point)), 1))


# %% tags=["guide"]
@contextmanager
def using(*settings):
    """Errors in here name the settings that they may come from."""
    try:
        yield
    except (ValueError, OSError, ImportError) as error:
        found = re.findall(r"\((-?\d[\d.]*), (-?\d[\d.]*), (-?\d[\d.]*)\)", str(error)) if "city" in globals() else []
        places = [f"({', '.join(xyz)}) m is {as_setting(np.array(xyz, float))} as a setting" for xyz in found[-1:]]
        raise ValueError("; ".join([f"look at {', '.join(settings)}: {error}", *places])) from None


# %% tags=["guide"]
def wind_record(path):
    """A record of weather; of a file of PVGIS, which has lines before and after its table, the wind alone."""
    lines = Path(path).read_text(encoding="utf-8-sig").splitlines()
    first = next((n for n, line in enumerate(lines) if "WS10m" in line.split(",")), None)
    if first is None:
        return read_weather(path)
    column, rows = lines[first].split(",").index("WS10m"), [line.split(",") for line in lines[first + 1 :]]
    speeds = [row[column] for row in rows if len(row) > column]
    short = Path(path).with_suffix(".wind.csv")
    short.write_text("\n".join(["wind speed [m/s]", *speeds]))
    return read_weather(short)


# %% tags=["guide"]
def streets():
    """Lines of the streets on the map [m] by name, and all in one array with gaps."""
    found = json.loads(Path(ROADS).read_text(encoding="utf-8"))["features"] if ROADS else []
    lines, gap = {}, np.full((1, 2), np.nan)
    for road in (one for one in found if one["geometry"]["type"] == "LineString" and "highway" in one["properties"]):
        lonlat = np.array([at[:2] for at in road["geometry"]["coordinates"]])
        line = city.from_geographic(np.column_stack([lonlat, np.zeros(len(lonlat))]))[:, :2]
        lines.setdefault(road["properties"].get("name", ""), []).append(line)
    return lines, np.vstack([gap, *(part for several in lines.values() for line in several for part in (line, gap))])


# %% tags=["guide"]
rows = {"buildings": f"`{Path(CITY).name}`, read with `{READING}`", "roads, land": ROADS and f"`{Path(ROADS).name}`"}
rows |= {"people": PEOPLE and f"`{Path(PEOPLE).name}`, elsewhere {ASSUMED_PEOPLE} per km²", "terrain": TERRAIN}
rows |= {"start, goal": f"{START}, {GOAL}: longitude, latitude (or x, y), height above the ground [m]"}
rows |= {
    "heights": f"{MIN_HEIGHT:g} m to {MAX_HEIGHT:g} m above the ground, voxels of {CELL:g} m",
    "UAV": str(UAV)[1:-1],
}
rows |= {"weather": str(WEATHER)[1:-1], "record": RECORD, "room for GPS": f"{GPS_SIGMAS:g} σ"}
rows |= {"detour": f"{100 * DETOUR:g} % at most", "choice": CHOICE, "guesses": str(GUESSES)[1:-1].replace("'", "")}

# %% [markdown] tags=["guide"]
# ## What a good answer is
#
# A good answer has a number or names a thing in a figure, says where it comes from, and admits what isn't known. Three
# to six sentences are enough. Below each heading stands what to do; your answer goes into the cell after the question.

# %%
table = "\n".join(f"| {name} | {value or 'none'} |" for name, value in rows.items())
words = f"{NAME}, {COURSE}, {DATE}. The place: {PLACE}."
made = f"A plan made with uavlab {__version__}. It is an exercise, not to be flown."
Markdown(f"# {TITLE}\n\n{words}\n\n{made}\n\n| setting | |\n|:--|:--|\n{table}")

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
with using("CITY", "READING", "TERRAIN", "TERRAIN_CRS"):
    terrain = read_terrain(TERRAIN, crs=TERRAIN_CRS) if isinstance(TERRAIN, str) else TERRAIN
    city = replace(read_city(CITY, cell=CELL, terrain=terrain, **READING), name=TITLE)
if city.reference is None:
    print("This city has no place on Earth: START and GOAL are in metres.")
else:
    corners = city.to_geographic([(*city.bounds[end, :2], 0.0) for end in (0, 1)])
    print("from {:.5f}°, {:.5f}° to {:.5f}°, {:.5f}° (longitude, latitude)".format(*corners[:, :2].ravel()))
print(city)
city.source

# %% tags=["nbval-check-output"]
roofs = np.maximum(city.surface_below[:, :, -1] - city.range_of_ground[1], 0.0)  # height above the ground [m]
empty = distance_transform_edt(roofs < 0.5) * CELL > 50
print(f"{100 * empty.mean():.0f} % of the map are over 50 m from any object in the file: is nothing there, or no data?")


# %%
def on_map(name, point):
    """A place of the settings on the map [m]."""
    x, y = point[:2] if city.reference is None else city.from_geographic((*point[:2], 0.0))[:2]
    if not city.inside((x, y, city.bounds[:, 2].mean())):
        box = [as_setting((*city.bounds[end, :2], 0.0))[:2] for end in (0, 1)]
        raise ValueError(
            f"{name} = {point} is off the map, which goes from {box[0]} to {box[1]}: longitude comes first"
        )
    height = max(point[2], MIN_HEIGHT + CELL / 2)  # the mission adds take-off and landing
    return np.array([x, y, height - city.height_above_ground((x, y, 0.0))])


start, goal = on_map("START", START), on_map("GOAL", GOAL)
straight = float(np.linalg.norm(goal - start))
ends = {"start": [start[:2]], "goal": [goal[:2]]}
road_lines, road_plan = streets()
on_streets = {"streets": road_plan} if ROADS else {}

# %% tags=["guide"]
read = Path(CITY).read_text(encoding="utf-8-sig").lstrip("\x1e")
document = json.loads(read if CITY.endswith("json") else read.splitlines()[0])
tags = {
    one["properties"].get("name") or f"feature {one.get('id')}": one["properties"]
    for one in document.get("features", [])
}
tags |= {
    name: {"type": one["type"], **one.get("attributes", {})} for name, one in document.get("CityObjects", {}).items()
}
TOLD = ("type", "class", "building", "building:part", "height", "measuredHeight", "building:levels", "roof:levels",
        "min_height")  # fmt: skip
tall = {
    one: float(city.height_above_ground((*one.bounds[:, :2].mean(axis=0), one.bounds[1, 2]))) for one in city.buildings
}


# %% tags=["guide"]
def described(number, building):
    """A row of the table: the height that was taken, and what the file says."""
    said = tags.get(building.name) or tags.get(building.name.split()[-1], {})
    words = ", ".join(f"{key}={said[key]}" for key in TOLD if key in said)
    return f"| {number} | {building.name[:24]} | {tall[building]:.1f} | {tall[building] / 3:.1f} | {words} |"


def order(building):
    """Those with names first, then those that don't stand as the file says, then buildings, then the highest."""
    said = tags.get(building.name) or tags.get(building.name.split()[-1], {})
    named = not building.name.startswith("feature ") and "CityObjects" not in document
    unfinished = said.get("building") in ("construction", "ruins")
    return not named, not unfinished, "Building" not in said.get("type", "Building"), -tall[building]


# %% tags=["nbval-check-output"]
shown = sorted(tall, key=order)[:12]
table = "\n".join(described(number, building) for number, building in enumerate(shown, 1))
Markdown(
    f"| on the map | name in the file | height [m] | in storeys of 3 m | the file says |\n|:--|:--|:--|:--|:--|\n{table}"
)

# %% tags=["figure"]
classes = {"nothing within 50 m": empty, "up to 15 m": (roofs >= 0.5) & (roofs <= 15)}
classes |= {"15 m to 30 m": (roofs > 15) & (roofs <= 30), "over 30 m": roofs > 30}
shades = {"nothing within 50 m": "#f3e3c3", "up to 15 m": "#b8c4d8", "15 m to 30 m": "#6f7fa5", "over 30 m": "#27304f"}
notes = {str(number): building.bounds[:, :2].mean(axis=0) for number, building in enumerate(shown, 1)}
plot.area_map(
    city, {name: where for name, where in classes.items() if where.any()},
    paths=on_streets | {"straight line": np.array([start[:2], goal[:2]])}, points=ends, notes=notes, title=TITLE,
    colors=COLORS | shades,
)  # fmt: skip

# %% [markdown]
# *The district from above, heights above the ground; numbers as in the table, which has those with names, then those
# under construction or in ruins, then the highest. Heights z in figures and messages count from the lowest ground at a building.*
#
# > **Question 2.** What did the reader assume, mend and leave out? Compare three buildings of the table with what you see
# > on the spot, or in pictures. What isn't there (trees, cranes, cables), and where does the file say nothing at all?
# > What does that mean for the flight?

# %% [markdown]
# **Answer 2.** …

# %% [markdown] tags=["guide"]
# A good answer quotes the table ("2 × height of 9 m"), compares heights with storeys that you counted, and says on which
# side the error lies: too high costs a detour, too low costs a drone.

# %% [markdown]
# ## 3 The people below

# %% tags=["nbval-check-output"]
assumed = ASSUMED_PEOPLE / 1e6
with using("PEOPLE", "ASSUMED_PEOPLE"):
    people = read_people(city, PEOPLE, elsewhere=assumed) if PEOPLE else None
with using("ROADS"):
    ground = osm_layers(city, ROADS, cars_per_km=CARS_BY_CLASS) if ROADS else None
shelter, cars = (ground.shelter, ground.vehicle_share) if ROADS else (shelter_layer(city), 0.0)
risk_map = RiskMap(city, people.density if PEOPLE else assumed, shelter, cars, uav=UAV, min_height=MIN_HEIGHT)
print(people.source if PEOPLE else f"ASSUMED: {ASSUMED_PEOPLE} people per km² everywhere")
area, count = np.prod(city.shape[:2]) * CELL**2 / 1e6, risk_map.population_density.sum() * CELL**2
print(f"{count:,.0f} people on {area:.3f} km², {count / area:,.0f} per km²")
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
# cause, in whole metres, and its diameter $D_\text{uav}$. To this come `GPS_SIGMAS` standard deviations of GPS, whose error
# grows with the time of flight. Gusts are three standard deviations of the wind above its mean. *Routes keep this
# distance. Flights use it up*: past a wall, about half of them come nearer, as errors lead to either side. Only a flight
# that uses all of it touches the wall. Part 7 counts how many come nearer, and how many use up what was meant for GPS.

# %% tags=["nbval-check-output"]
reasons = grounded_by(UAV, WEATHER)
if reasons:
    raise ValueError(f"WEATHER grounds the UAV: {'; '.join(reasons)}")
seconds = ((1 + DETOUR) * straight + START[2] + GOAL[2]) / UAV.cruise_speed
sigma = GPS.drift * np.sqrt(1 - np.exp(-2 * seconds / GPS.correlation))  # to the east, and to the north
needed = safe_distance(UAV.payload, WEATHER, reading="physical", uav=UAV)
distance = round(needed + GPS_SIGMAS * sigma, 1)
print(UAV, WEATHER, sep="\n")
print(f"GPS after {seconds:.0f} s: σ = {sigma:.2f} m, so {GPS_SIGMAS:g} σ are {GPS_SIGMAS * sigma:.1f} m")
print(f"{needed:g} m for gusts and the body, the rest for GPS: keep {distance:g} m")

# %% tags=["nbval-check-output"]
if RECORD:
    with using("RECORD"):
        winds = wind_record(RECORD).columns["wind_speed"]
    winds, limit = winds[np.isfinite(winds)], WEATHER.reference_wind.mean
    print(
        f"{100 * np.mean(winds <= limit):.0f} % of {len(winds)} hours in {RECORD} have at most {limit:.2g} m/s of wind"
    )

# %% [markdown]
# > **Try it.** How does the distance change with the wind, and with the room for GPS?

# %% tags=["try-it"]
for speed in (2, 4, 6, 8):
    more = safe_distance(UAV.payload, Weather(forecast_wind=speed), reading="physical", uav=UAV)
    print(
        f"wind of {speed} m/s:", ", ".join(f"{more + sigmas * sigma:.1f} m with {sigmas} σ" for sigmas in (0, 1, 2, 3))
    )

# %% [markdown]
# > **Question 4.** Why this weather? How often is it worse there, and what would you do then? Why so many σ for GPS, and
# > what would three cost, which the preflight asks of the fence?

# %% [markdown]
# **Answer 4.** …

# %% [markdown] tags=["guide"]
# A good answer names a source (a station, a typical year) and a share of the hours. For GPS see chapter
# [13](13_flying_in_gusts.ipynb). If a city model's place is uncertain by some metres (its table says so), that adds to it.

# %% [markdown]
# ## 5 Two planners
#
# A\* looks for the shortest route that keeps the distance, and `least_risk` for the one with the fewest expected deaths on
# the ground, at most `DETOUR` longer. Both go from voxel to voxel, so `shortcut` then draws straight lines where nothing
# gets worse. All that follows is about these two routes. They keep half a metre more than the distance: in it the curves
# of part 6 round their corners. Their ends are centres of voxels, up to half a `CELL` off yours.

# %% tags=["nbval-check-output"]
limits = {"min_clearance": distance + 0.5, "min_height": MIN_HEIGHT, "max_height": MAX_HEIGHT}
price = np.maximum(risk_map.rate, 1e-15 * risk_map.rate.max())
with using("START", "GOAL", "MIN_HEIGHT", "MAX_HEIGHT", "WEATHER", "GPS_SIGMAS", "CELL"):
    on_grid = astar(city, start, goal, **limits)
    if not on_grid.reached:
        raise ValueError(f"no route, {on_grid.reason}")


def less_risky(detour):
    """The straightened route of least risk that is so much longer at most."""
    found = least_risk(risk_map, start, goal, max_length=(1 + detour) * on_grid.en_route.length, **limits)
    if not found.reached:
        raise ValueError(f"no route of least risk, {found.reason}")
    return shortcut(found, city, price=price)


with using("DETOUR", "START", "GOAL", "MIN_HEIGHT", "MAX_HEIGHT", "WEATHER", "GPS_SIGMAS", "CELL"):
    routes = {"shortest": shortcut(on_grid, city), "least risk": less_risky(DETOUR)}

# %% tags=["nbval-check-output"]
deaths = {name: risk_map.fatalities(route) for name, route in routes.items()}
for name, route in routes.items():
    rate = 1e5 * deaths[name] * UAV.cruise_speed * 3600 / route.length
    buffer = ground_risk_buffer(city.height_above_ground(route.points).max(), UAV.diameter)
    sora = risk_map.highest_igrc(route, ground_risk_buffer=buffer)
    print(f"{name}: {route.length:.0f} m, clearance {route.en_route.clearance(city):.1f} m")
    print(f"    {1e9 * deaths[name]:.3g} deaths in 10⁹ flights, {rate:.2g} in 100 000 hours of flight")
    print(f"    intrinsic ground risk class of SORA: {sora}")

# %% tags=["nbval-check-output"]
found = {"longer [%]": 100 * (routes["least risk"].length / routes["shortest"].length - 1)}
found |= {"risk left [%]": 100 * deaths["least risk"] / deaths["shortest"]}
for what, value in found.items():
    print(f"{what}: guessed {GUESSES.get(what)}, found {value:.1f}")

# %% tags=["check"]
assert all(route.en_route.clearance(city) >= distance + 0.5 - 1e-9 for route in routes.values())
assert routes["least risk"].en_route.length <= (1 + DETOUR) * on_grid.en_route.length + 1e-9

# %% tags=["figure"]
plans = {name: route.points[:, :2] for name, route in routes.items()}
plot.value_map(
    city, np.where(risk_map.flyable.any(axis=2), plot.ground_risk(risk_map), np.nan), plot.RISK_LABEL,
    paths=on_streets | plans, points=ends, norm=plot.risk_norm(risk_map), colors=COLORS,
    title=f"Risk at the least height, {MIN_HEIGHT:g} m above the ground or above a roof",
)  # fmt: skip

# %% tags=["figure"]
plot.profile(city, routes, safe_distance=distance, colors=COLORS)

# %% tags=["nbval-check-output"]
for name, plan in plans.items():
    way, crossed = shapely.LineString(plan), {}
    for street, lines in road_lines.items():
        for at in shapely.get_coordinates(
            [way.intersection(shapely.LineString(line)) for line in lines if len(line) > 1]
        ):
            crossed[way.project(shapely.Point(at))] = street or "a street without a name"
    print(
        f"{name} crosses", ", ".join(f"{crossed[at]} after {at:.0f} m" for at in sorted(crossed)) or "no street known"
    )

# %% [markdown]
# *Above: the risk of flying low over each place, whatever the height of its ground, with streets and both routes. In the
# middle: height and clearance along them. Below: what they cross.*
#
# > **Try it.** What does a smaller detour save, and a larger one?

# %% tags=["try-it"]
for more in (0.05, 0.5):
    other = less_risky(more)
    print(
        f"at most {100 * more:g} % longer: {other.length:.0f} m, {1e9 * risk_map.fatalities(other):.3g} deaths in 10⁹ flights"
    )

# %% [markdown]
# > **Question 5.** Compare both routes in length, clearance, risk and class. What does the second avoid, and which do you
# > choose? If a longer detour saves nothing, why? How far off were your guesses?

# %% [markdown]
# **Answer 5.** …

# %% [markdown] tags=["guide"]
# A good answer says how certain the risk is: a factor of two in the number of people changes both routes' risks, but
# hardly their ratio. It compares the risk with something else: chapter [08](08_risk_maps.ipynb) expects 6.4 failures in
# 100 000 hours of flight. The class of SORA decides what an authority asks for, see [09](09_route_of_least_risk.ipynb); it
# counts the most crowded place within the height of the flight, so a detour may leave it as it is. This is no legal advice.

# %% [markdown]
# ## 6 A curve that can be flown

# %%
wind = Wind.from_weather(WEATHER)
with using("CELL", "START", "GOAL", "MIN_HEIGHT"):
    curves = {name: smooth(route, city, UAV, min_clearance=distance) for name, route in routes.items()}
able = {name: greatest_speed(curve, UAV, wind.mean) for name, curve in curves.items()}
speed = min([UAV.cruise_speed, *(fastest for fastest in able.values() if fastest > 0)])

# %%
for name, curve in curves.items():
    beyond = feasibility(curve, city, UAV, speed=max(1.02 * able[name], 0.1), wind=wind.mean)
    why = ", ".join(f"{limit.name} after {limit.distance:.0f} m" for limit in beyond.limits if not limit.met)
    print(f"{name}: {curve.length:.0f} m, at most {able[name]:.1f} m/s (then beyond its limit: {why})")
print(
    f"both are flown at {speed:.1f} m/s, the UAV's cruise speed of {UAV.cruise_speed:g} m/s or what the slower allows"
)
for name, curve in curves.items():
    print(name)
    display(feasibility(curve, city, UAV, speed=speed, wind=wind.mean))

# %% [markdown]
# > **Question 6.** What slows each curve, and where? Which other limit is nearest, in parts of its limit, or broken? What
# > would you change?

# %% [markdown]
# **Answer 6.** …

# %% [markdown] tags=["guide"]
# A good answer names the limit with its number, and a cure that fits: a slower flight doesn't help against a wall.

# %% [markdown]
# ## 7 Two hundred flights
#
# > **Predict first.** On which of the two curves will more flights use up their room, and where?

# %% tags=["nbval-check-output"]
flights = {
    name: monte_carlo(curve, city, UAV, wind, Autopilot(speed=speed), rng=1, flights=200)
    for name, curve in curves.items()
}
rates = {name: crash_rate(flown) for name, flown in flights.items()}

# %% tags=["nbval-check-output"]
for name, flown in flights.items():
    outcomes = dict(zip(*np.unique(flown.outcome, return_counts=True), strict=True))
    said = ", ".join(f"{count} {outcome}" for outcome, count in outcomes.items())
    near, beyond = (int((flown.clearance < least).sum()) for least in (distance, needed))
    low, high = (100 * share for share in share_interval(beyond, 200))
    print(f"{name}: {said}; crashes {rates[name]}, guessed {GUESSES.get('crashes of 200')}")
    print(
        f"    {near} of 200 came nearer than {distance:g} m; {beyond} nearer than {needed:g} m: {low:.1f} % to {high:.1f} %"
    )
    print(
        f"    the nearest centre was {flown.clearance.min():.2f} m from a wall, half the UAV is {UAV.diameter / 2:g} m"
    )

# %% tags=["figure"]
ones = {name: fly(curve, city, UAV, wind, Autopilot(speed=speed), rng=1) for name, curve in curves.items()}
scene.show(city, flights=ones, risk=risk_map, wind=wind, uav=UAV, colors=COLORS)

# %% [markdown]
# *One flight along each curve, in three dimensions. Drag turns the scene. The ground is coloured by its risk.*
#
# > **Question 7.** What do the 200 flights show, and what do they not? Quote the interval. How many used up
# > their room for GPS, and would you give more? How far off was your guess?

# %% [markdown]
# **Answer 7.** …

# %% [markdown] tags=["guide"]
# No crash in 200 flights agrees with a rate of up to 18 in 1 000. A good answer says so, and what the simulation lacks.

# %% [markdown]
# ## 8 Preflight, and the mission

# %%
home, begin = None, routes[CHOICE].points[0]
if city.reference is None:
    home = (0.0, 0.0)
elif TERRAIN is not None:  # whose heights are above the sea
    home = tuple(city.to_geographic((*begin[:2], city.surface_below[tuple(city.cell_of(begin))])))
with using("START", "GOAL", "CELL"):
    mission = Mission.from_route(curves[CHOICE], city, UAV, home=home, speed=speed, corridor=2.0)

# %%
mission.to_plan(Path(CITY).parent / "mission.plan")
mission.to_kml(Path(CITY).parent / "mission.kml", city)
print(f"{len(mission.items)} items, home at {mission.home.height:.0f} m, heights: {mission.heights}")
print(*mission.notes, sep="\n")
if city.reference is None:
    print("The mission's place on Earth is invented.")
checklist = preflight(mission, city, UAV, WEATHER, min_clearance=distance)
checklist

# %% [markdown]
# > **Question 8.** Did the checklist pass? Explain the two lines that are nearest to their limits, or that fail; not the
# > return height and the flights, which lie at theirs by design. What is missing before this could be flown: on the map,
# > in the drone, in law?

# %% [markdown]
# **Answer 8.** …

# %% [markdown] tags=["guide"]
# Two files of the mission now lie beside your city: `mission.plan` for QGroundControl, and `mission.kml` for maps. An item
# is a waypoint or another command of it. If no `TERRAIN` is given, the height of home above the sea isn't known.
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
used = "; ".join(f"{what} from {Path(file).name}" for what, file in files.items() if isinstance(file, str))
untold = "invented; nobody" in "".join(SOURCES) and "example_district" not in CITY
said = [*SOURCES, "**`SOURCES` still speaks of the example: who made these files isn't said.**"][
    : len(SOURCES) + untold
]
said += [f"Files: {used}", f"The weather that was flown in: {str(WEATHER)[1:-1].removeprefix('Weather: ')}"]
Markdown("\n".join(f"- {one}" for one in said))

# %% [markdown] tags=["guide"]
# ## The page to hand in
#
# 1. **Restart Kernel and Run All Cells**, then **Save Notebook**. The page holds what was saved: nothing is run again.
# 2. Open a **Terminal** in JupyterLab, go to the course's folder `notebooks`, and call
#    `python build.py --page my_city.ipynb`, with the path of your copy. It writes `my_city.html` beside the copy.
# 3. Open that file in a browser. It needs no network: figures, tables, the scene and your answers are inside. Our
#    explanations are left out, and code is folded.
# 4. Hand in the page, and with it, in one `.zip`, the notebook, your files, `mission.plan` and `mission.kml`.
#
# The command refuses a notebook whose cells weren't run from top to bottom. It lists questions without an answer, and
# code that isn't the chapter's, also on the page. If you have the notebook alone and not its folder, `jupyter nbconvert
# --to html my_city.ipynb` does nearly the same: the scene is in, our explanations too, and equations need a network.
#
# ## Before you hand in
#
# - All nine answers are written, each with a number or a thing in a figure.
# - `SOURCES` names each file: who made it, its licence with a link, the day, and what you changed. For example: `"Buildings,
#   roads, land: © OpenStreetMap contributors, ODbL 1.0, https://www.openstreetmap.org/copyright, exported 1 May"`.
# - You looked at the reader's table, and at three buildings. Title, course, date, place and guesses are yours.
# - No cell failed. What is assumed is said as assumed.
# - You opened the page on another computer, or without a network, and the scene turns.
#
# ## How it is marked
#
# | | first half | second half | none | points |
# |---|---|---|---|---|
# | Question | who flies what, from where to where | who may be harmed; another way is weighed | a flight without a reason | 10 |
# | City | the reader's table is explained | three buildings are compared, what is left out is judged | the table is copied | 15 |
# | People | the number is checked for plausibility | time of day, shelter and cars are discussed | the map is described | 15 |
# | Weather and distance | weather from a source, with a share of hours | the room for GPS is argued, with the flights that came nearer | default values | 10 |
# | Planners | length, clearance, risk and class compared, with the guesses | the difference is explained on the map, a choice is defended | numbers alone | 15 |
# | Curve and flights | what limits each speed is explained | the interval is quoted and understood | "no crash, so it is safe" | 15 |
# | Preflight | two lines are explained, and failed ones acted on | what is missing for a real flight | "passed" | 6 |
# | Judgement | the strongest reasons for and against | the file that would change most | a feeling | 4 |
# | Page | opens offline, reads well, can be run again from the files | all sources with licences and changes | no sources | 10 |
# | **Total** | | | | **100** |
#
# Half the points of a row are for each half.
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
# Before: [15 The papers on trial](15_the_papers_on_trial.ipynb).
