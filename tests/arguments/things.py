"""What the calls of the table are made from: small, quick, and with numbers that 32 bits hold exactly."""

import json
import tempfile
import threading
import time
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from uuid import uuid4

import numpy as np
import pandas

from uavlab.city import Building, City, NoFlyZone, Place, Source, Terrain
from uavlab.city.source import Entry
from uavlab.flight import PERFECT_GPS, Autopilot, Flights, OffsetProcess, fly
from uavlab.mavlink import FlightLog, Telemetry, connect, start, upload
from uavlab.mavlink.dialect import PX4
from uavlab.mission import Check, Mission, Preflight
from uavlab.offsets import JointOffset, OffsetModel, SkewedOffset, safety_domain
from uavlab.planners import Comparison, ant_colony, astar, flight_conditions
from uavlab.prediction import FEATURES, OffsetPredictor, make_dataset
from uavlab.resilience import ConditionCheck, Monitor
from uavlab.risk import RiskMap
from uavlab.route import Route
from uavlab.spline import Curve, feasibility
from uavlab.vehicle import UAV
from uavlab.vehicle_sim.pilot import Pilot
from uavlab.vehicle_sim.server import Server, Service
from uavlab.weather import Weather, WeatherRecord, Wind

PLACE = Place(8.5, 47.25, 400.0)
SQUARE = ((4.0, 4.0), (7.0, 4.0), (7.0, 7.0), (4.0, 7.0))
HOUSE = Building.prism(SQUARE, 5.0)
ZONE = NoFlyZone(((9.0, 1.0), (11.0, 1.0), (11.0, 3.0), (9.0, 3.0)), 0.0, 6.0)
TOWN = City.from_buildings([HOUSE], origin=(0, 0, 0), size=(12, 12, 8), reference=PLACE, no_fly=[ZONE], name="town")
LAZY = City.from_buildings([HOUSE], origin=(0, 0, 0), size=(12, 12, 8), no_fly=[ZONE], name="town", lazy=True)
OCCUPIED = TOWN.occupied
PRICES = np.ones(TOWN.shape)
START, GOAL = (1.5, 1.5, 2.5), (10.5, 10.5, 3.5)
PLAN = np.arange(144.0).reshape(12, 12) / 256

VEHICLE = {
    "mass": 1.5, "thrust": 28.0, "drag_area": 0.0625, "rain_area": 0.125, "diameter": 0.5, "cruise_speed": 5.0,
    "top_speed": 18.0, "max_tilt": 1.0, "climb_speed": 5.0, "sink_speed": 4.0, "rotor_area": 0.25,
    "figure_of_merit": 0.625, "drive_efficiency": 0.75, "battery": 262144.0, "reserve": 0.25,
    "fall_drag_area": 0.03125, "payload": 0.25, "name": "a quadrotor",
}  # fmt: skip
DRONE = UAV(**VEHICLE)
BREEZE = Wind((2.0, 1.0, 0.0), "ou", 0.5, 2.0)
STILL, CALM = Wind((1.0, 0.0, 0.0), "ou", 0.25, 2.0), Wind((0.5, 0.0, 0.0), "ou", 0.25, 2.0)
MILD = Weather(measured_wind=2.0, forecast_wind=3.0, forecast_max_wind=4.0, wind_from_deg=90.0)
WAY = ((1.5, 1.5, 2.5), (1.5, 9.5, 2.5), (10.5, 10.5, 3.5))
LINE = Route(WAY, "line", cost=30.0, priced="")
EXACT = Route(WAY, "exact", cost=25.0)
CURVE = Curve(
    np.array([(1.5, 1.5, 2.5), (1.5, 5.0, 2.5), (1.5, 9.5, 2.5), (6.0, 10.5, 3.0), (10.5, 10.5, 3.5)]), step=0.5
)
RISK = RiskMap(TOWN, 0.015625, 0.25, 0.0078125, DRONE, safe_height=0.5)
SEARCHED = astar(TOWN, START, GOAL, record=True)
SAMPLES = np.random.default_rng(0).integers(-64, 64, (40, 2)) / 32
SKEWED = np.array([0.0, 0.25, 0.25, 0.5, 0.5, 0.5, 0.75, 0.75, 1.0, 1.25, 1.5, 2.25])
PROCESS = OffsetProcess(0.25)
FLIGHT = fly(Route([(1.5, 1.5, 2.5), (1.5, 9.5, 2.5)]), TOWN, DRONE, PROCESS, rng=0, time_step=0.0625)
FLIGHTS = Flights(np.array(["arrived", "crashed"]), np.full(2, 2.0), np.ones(2), np.ones(2), np.zeros((2, 3)),
                  np.zeros((2, 2, 3)))  # fmt: skip
TERRAIN = Terrain.from_raster(np.arange(16.0).reshape(4, 4) / 8, (-2.0, -2.0, 14.0, 14.0), beyond="nearest")
SOURCE = Source("town.geojson", "GeoJSON", (Entry("taken", "Building", 1, ("a",)),))
NORMAL, JOINT, SKEW = OffsetModel(0.5, 1.0), JointOffset((0.0, 0.5), (1.0, 0.5), 0.25), SkewedOffset(0.5, 1.0, 0.25)
DOMAIN = safety_domain(SAMPLES)
MODES = flight_conditions("light", "mild")
FOUND = feasibility(CURVE, TOWN, DRONE)
COMPARISON = Comparison(
    ["ants", "swarm"], np.arange(8.0).reshape(2, 2, 2) / 8, np.arange(40.0)[::-1].reshape(2, 2, 2, 5) / 32,
    [np.array([2, 5]), np.array([1, 3, 5])], np.ones((2, 2, 2)), [EXACT, EXACT],
)  # fmt: skip
HOURS = pandas.DataFrame(
    {
        "temperature_c": [15.0, 20.0],
        "humidity_percent": [50.0, 75.0],
        "pressure_hpa": [1000.0, 1016.0],
        "wind_speed": [3.0, 5.0],
        "wind_from_deg": [90.0, 180.0],
        "radiation": [0.0, 512.0],
    }
)
RECORD = WeatherRecord(
    {"temperature_c": np.array([15.0, 16.0]), "wind_speed": np.array([2.0, 3.0])},
    np.array(["2026-01-01T00:00", "2026-01-01T01:00"], dtype="datetime64[s]"), (), (), "record.csv",
)  # fmt: skip
MISSION = Mission.from_route(LINE, TOWN, DRONE, corner_radius=0.25, fence_margin=4.0, rally=[(3.5, 3.5, 2.5)])
PREFLIGHT = Preflight((Check("greatest height", 3.5, 120.0, "m", False, "on the way to item 3"),), MISSION)
HEARD = Telemetry(9.0, 8.5, 47.25, 402.5, 2.5, (4.0, 3.0, 0.0), 97.0, "mission", True, 2)
LOG = FlightLog(MISSION, TOWN, (HEARD, HEARD._replace(time=9.5, above_home=2.75)))

FOLDER = tempfile.TemporaryDirectory(prefix="arguments")


def condition_check():
    return ConditionCheck(1.0)


def monitor():
    return Monitor(condition_check(), 0.5)


def autopilot():
    return Autopilot(speed=5.0, interval=0.5, trimmed=True)


@cache
def data():
    return make_dataset("paper", 0, count=60, train_count=40)


@cache
def table():
    """Rows to learn from, and their offsets."""
    return data().features.iloc[:30].round(3), np.round(64 * data().offsets[:30]) / 64


@cache
def predictor():
    return OffsetPredictor(FEATURES, 6).fit(*table())


def written(name, content):
    path = Path(FOLDER.name) / name
    if not path.exists():
        path.write_text(content if isinstance(content, str) else json.dumps(content), encoding="utf-8")
    return path


def lonlat(*points):
    """Longitudes and latitudes of points near the town's place."""
    return np.round(PLACE.longitude_latitude(np.array(points, dtype=float)), 9).tolist()


def collection(kind, points, **properties):
    corners = lonlat(*points)
    geometry = {"type": kind, "coordinates": [[*corners, corners[0]]] if kind == "Polygon" else corners}
    return {
        "type": "FeatureCollection",
        "features": [{"type": "Feature", "properties": properties, "geometry": geometry}],
    }


def geojson_file():
    return written("town.geojson", collection("Polygon", SQUARE, height=5.0, min_height=0.0, name="a"))


def zone_file():
    return written("zones.geojson", collection("Polygon", SQUARE, lower=0, upper=120, name="z"))


def road_file():
    return written("roads.geojson", collection("LineString", [(0, 9), (12, 9)], highway="residential"))


def voxel_file():
    return written("town.3dmap", "voxel 4 4 3\n1 1 0\n1 1 1\n")


def terrain_file():
    rows = "\n".join("1.0 2.0 2.5" for _ in range(3))
    return written(
        "ground.asc", f"ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 4\nNODATA_value -9999\n{rows}\n"
    )


def people_file():
    return written("people.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 6\n4 5\n6 7\n")


def weather_file():
    return written(
        "weather.csv", "time,temperature [°C],wind speed (km/h)\n2026-01-01T00:00,15,10\n2026-01-01T01:00,16,11\n"
    )


def cityjson_file():
    corners = [[x, y, z] for z in (0, 3) for x, y in ((0, 0), (4, 0), (4, 4), (0, 4))]
    box = [[[0, 3, 2, 1]], [[4, 5, 6, 7]], [[0, 1, 5, 4]], [[1, 2, 6, 5]], [[2, 3, 7, 6]], [[3, 0, 4, 7]]]
    house = {"type": "Building", "geometry": [{"type": "Solid", "lod": "1", "boundaries": [box]}]}
    return written(
        "town.city.json",
        {
            "type": "CityJSON",
            "version": "2.0",
            "transform": {"scale": [1, 1, 1], "translate": [0, 0, 0]},
            "CityObjects": {"a": house},
            "vertices": corners,
        },
    )


def model_file():
    path = Path(FOLDER.name) / "predictor.json"
    if not path.exists():
        predictor().save(path)
    return path


def out(name):
    return Path(FOLDER.name) / name


def fresh(name):
    """A file that isn't there yet, for what goes on with one that is."""
    return out(f"{uuid4().hex}.{name}")


def grid():
    """Points (3, 4, 3) of the ground."""
    x, y = np.meshgrid(np.arange(4.0), np.arange(3.0)[::-1])
    return np.stack([x, y, x / 4], axis=-1)


def ants(risk_map, start, goal, *, budget, rng):
    return ant_colony(risk_map, start, goal, budget=budget, rng=rng, ants=5, max_turn=3.0)


def plan_file():
    path = out("flight.plan")
    if not path.exists():
        MISSION.to_plan(path)
    return path


def waypoint_file():
    path = out("flight.waypoints")
    if not path.exists():
        MISSION.to_wpl(path)
    return path


def served():
    """A vehicle in a thread, ten times as fast as the world, which ends after a minute if nobody ends it."""
    gps = Autopilot(gps=PERFECT_GPS, heeds_limits=False)
    pilot = Pilot.standing(TOWN, DRONE, CALM, gps, np.array(START), np.random.default_rng(1))
    server = Server(pilot, PX4, Service(pace=10.0, lifetime=60.0), np.random.default_rng(2))
    threading.Thread(target=server.run, daemon=True).start()
    return server


STATIONS = []
"""When the last vehicle came, and a link to it."""


def station():
    """A link to a vehicle that stands and has a mission; a new one where the last one may soon be gone."""
    if not STATIONS or time.monotonic() - STATIONS[0] > 20.0:
        for link in STATIONS[1:]:
            link.close()
        STATIONS[:] = time.monotonic(), connect(f"udpout:127.0.0.1:{served().port}")
        upload(MISSION, STATIONS[1])
    return STATIONS[1]


@contextmanager
def in_flight(flies=True):
    """A link to a vehicle that has a mission, and flies it."""
    server = served()
    try:
        with connect(f"udpout:127.0.0.1:{server.port}") as link:
            upload(MISSION, link)
            if flies:
                start(link)
            yield link
    finally:
        server.over.set()
