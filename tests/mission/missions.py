"""What several tests of missions share: small towns with a place, landmarks in any system, and ways sampled densely."""

import json
from dataclasses import replace
from functools import cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import pyproj

from uavlab.city import Building, City, Place, Terrain, read_cityjson, read_geojson, table1_city
from uavlab.mission import FencePolygon, Item, Mission
from uavlab.mission.items import LAND, TAKEOFF, WAYPOINT
from uavlab.risk import random_campus
from uavlab.route import Route

DELFT = Place(4.36, 52.01, 3.0)
CENTIMETRE = 0.01
"""What 1e-7 degrees may move a place."""

LAYOUT = {"A": (0, 0), "B": (1000, 120), "C": (880, 960), "D": (40, 870), "E": (480, 430)}
"""South-west corners of landmarks [m] from the corner of the town."""

SIDE, ROOF = 12.0, {"A": 6.0, "B": 9.0, "C": 21.0, "D": 15.0, "E": 12.0}
"""How wide and how high they are [m]."""

FOOT = {"A": 4.0, "B": 4.5, "C": 5.0, "D": 4.2, "E": 4.1}
"""Heights of their feet in the file [m]."""

WGS84 = pyproj.Geod(ellps="WGS84")


class Town(NamedTuple):
    """A city that was read from a file, and what stands in the file."""

    city: City
    source: dict[str, tuple[float, float]]
    """South-west corners by name, in the file's own coordinates."""

    def corner(self, name):
        """The same corner on the map, (2,) [m]."""
        (building,) = (each for each in self.city.buildings if each.name == name)
        corners = np.concatenate(building.pieces)[:, :2]
        return corners[np.argmin(corners.sum(axis=1))]

    def over(self, name, above_roof=40.0):
        """A point above a landmark's corner, (3,) [m]; z = 0 is the lowest foot."""
        return np.array([*self.corner(name), FOOT[name] - FOOT["A"] + ROOF[name] + above_roof])

    def route(self, names="ABCDE", above_roof=40.0):
        return Route([self.over(name, above_roof) for name in names])


def scales(corner, degrees, unit):
    """Units of the file per metre, east and north."""
    if not degrees:
        return 1 / unit, 1 / unit
    return 1 / (111_320 * np.cos(np.radians(corner[1]))), 1 / 110_900


def box_faces(first):
    """Faces of a box whose eight corners begin with this number."""
    faces = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
    return [[[first + number for number in face]] for face in faces]


def cityjson_town(path, crs, corner, *, degrees=False, unit=1.0, height_unit=1.0, cell=20.0):
    """Landmarks in a CityJSON file in a system, whose south-west corner is given in its coordinates."""
    east, north = scales(corner, degrees, unit)
    vertices, objects, source = [], {}, {}
    for name, (x, y) in LAYOUT.items():
        west, south = corner[0] + x * east, corner[1] + y * north
        plan = [(west, south), (west + SIDE * east, south), (west + SIDE * east, south + SIDE * north),
                (west, south + SIDE * north)]  # fmt: skip
        faces = box_faces(len(vertices))
        vertices += [(*xy, (FOOT[name] + top) / height_unit) for top in (0.0, ROOF[name]) for xy in plan]
        objects[name] = {"type": "Building", "geometry": [{"type": "Solid", "lod": "1", "boundaries": [faces]}]}
        source[name] = west, south
    document = {"type": "CityJSON", "version": "2.0", "CityObjects": objects, "vertices": vertices}
    path.write_text(json.dumps(document))
    return Town(read_cityjson(path, crs=crs, cell=cell, margin=80.0), source)


def geojson_town(path, corner, *, cell=20.0, **options):
    """The same in a GeoJSON file, in longitudes and latitudes."""
    east, north = scales(corner, True, 1.0)
    features, source = [], {}
    for name, (x, y) in LAYOUT.items():
        west, south = corner[0] + x * east, corner[1] + y * north
        wide, deep = SIDE * east, SIDE * north
        ring = [[west, south], [west + wide, south], [west + wide, south + deep], [west, south + deep], [west, south]]
        features.append(
            {
                "type": "Feature",
                "properties": {"name": name, "height": ROOF[name] + FOOT[name] - FOOT["A"]},
                "geometry": {"type": "Polygon", "coordinates": [ring]},
            }
        )
        source[name] = west, south
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    return Town(read_geojson(path, cell=cell, margin=80.0, **options), source)


@cache
def table1(cell=5.0):
    """REPARE's city with a place; heights of an unknown system."""
    return replace(table1_city(cell=cell), reference=DELFT)


@cache
def campus(seed):
    """A campus drawn at random, with a place."""
    return replace(random_campus(seed).city, reference=DELFT)


@cache
def hills(seed, height=12.0, cell=4.0):
    """A town of six houses on hills that are drawn at random, 120 × 120 m."""
    rng = np.random.default_rng(seed)
    raster = height * rng.random((9, 9))
    ground = Terrain.from_raster(raster, (-10.0, -10.0, 130.0, 130.0))
    houses = []
    for west, south in ((15, 20), (60, 15), (95, 45), (20, 70), (60, 60), (80, 95)):
        low = float(ground.heights_at(np.array([[west + 5.0, south + 5.0]]))[0])
        plan = [(west, south), (west + 12, south), (west + 12, south + 12), (west, south + 12)]
        houses.append(Building.prism(plan, low + 10.0 + 10.0 * rng.random(), bottom=low - 12.0))
    return City.from_buildings(
        houses, cell=cell, origin=(0, 0, -8), size=(120, 120, 80), terrain=ground, name="hills", reference=DELFT
    )


def apart(item, lonlat):
    """Metres between an item and a place, on the ellipsoid."""
    return abs(WGS84.inv(item.longitude, item.latitude, *lonlat)[2])


def placed(mission, *commands):
    """The items with these commands, take-off and waypoints by default."""
    return [item for item in mission.items if item.command in (commands or (TAKEOFF, WAYPOINT))]


def samples(points, step=0.05):
    """Points along a polyline, at most so far apart [m]."""
    return Route(points).resample(step).points


def way(mission, city):
    """Waypoints of a mission on the map, from above home to above where it lands."""
    points = mission.path(city).points
    return points[1:-1] if any(item.command == LAND for item in mission.items) else points[1:]


def followed(city, start, end, step=0.05):
    """A leg whose height above ground changes evenly, sampled densely."""
    count = max(int(np.ceil(np.linalg.norm(end - start) / step)), 1)
    share = np.linspace(0.0, 1.0, count + 1)[:, None]
    points = start + share * (end - start)
    above = city.height_above_ground(np.array([start, end]))
    points[:, 2] += above[0] + share[:, 0] * (above[1] - above[0]) - city.height_above_ground(points)
    return points


def distance_to_polyline(points, line):
    """Of points (N, 3) to the nearest point of straight legs (M, 3) [m]."""
    least = np.full(len(points), np.inf)
    for start, end in pairwise(line):
        leg = end - start
        share = np.clip((points - start) @ leg / max(leg @ leg, 1e-30), 0.0, 1.0)
        least = np.minimum(least, np.linalg.norm(points - start - share[:, None] * leg, axis=1))
    return least


def triangle(first, here, last, count=24):
    """Points all over a triangle."""
    one, other = np.meshgrid(np.linspace(0, 1, count), np.linspace(0, 1, count))
    inside = one + other <= 1 + 1e-9
    return here + one[inside][:, None] * (first - here) + other[inside][:, None] * (last - here)


def corners(mission, city):
    """Corners that may be rounded, each as points all over its triangle, as far as the item's own radius reaches."""
    points = mission.path(city).points
    items = placed(mission)
    for number in range(1, len(items) - 1):
        before, here, after = points[number : number + 3]
        item = items[number]
        if item.parameters[0] > 0:
            continue
        into, out = here - before, after - here
        before_it, after_it = (min(item.parameters[1] / np.linalg.norm(leg), 1.0) for leg in (into, out))
        yield triangle(here - before_it * into, here, here + after_it * out)


def plain(**fields):
    """A mission of two items, with these fields."""
    items = (Item(22, 3, (0, 0, 0, 0), 52.01, 4.36, 20.0), Item(16, 3, (0, 2, 0, 90), 52.011, 4.361, 30.0))
    return Mission(**{"items": items, "home": DELFT, **fields})


SQUARE = FencePolygon(((52.0, 4.35), (52.0, 4.37), (52.02, 4.37), (52.02, 4.35)), True)
FIELDS = ("items", "home", "rally", "speed", "corner_radius", "heights", "place", "return_height", "name", "notes")
