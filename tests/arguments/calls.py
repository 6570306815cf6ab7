"""A rightful call of every public function, class and method, with a value for every parameter.

Keys are the package or module and the name, such as "city.City.blocked"; ": …" after it tells several calls of one
function apart. Each entry makes the keyword arguments anew, so that nothing that a call changes is left for the next.
"self" is what a method is called on; *routes stand under "routes" as a tuple, **site under "site" as a mapping.
"""

import importlib
import inspect
from pathlib import Path
from unittest import mock

import numpy as np
from matplotlib import colors
from matplotlib.figure import Figure
from things import (
    BREEZE,
    CALM,
    COMPARISON,
    CURVE,
    DOMAIN,
    DRONE,
    EXACT,
    FLIGHT,
    FLIGHTS,
    FOUND,
    GOAL,
    HOURS,
    HOUSE,
    JOINT,
    LAZY,
    LINE,
    LOG,
    MILD,
    MISSION,
    MODES,
    NORMAL,
    OCCUPIED,
    PLACE,
    PLAN,
    PREFLIGHT,
    PRICES,
    PROCESS,
    RECORD,
    RISK,
    SAMPLES,
    SEARCHED,
    SKEW,
    SKEWED,
    SOURCE,
    SQUARE,
    START,
    STILL,
    TERRAIN,
    TOWN,
    VEHICLE,
    WAY,
    ZONE,
    ants,
    autopilot,
    cityjson_file,
    condition_check,
    data,
    fresh,
    geojson_file,
    grid,
    in_flight,
    model_file,
    monitor,
    out,
    people_file,
    plan_file,
    predictor,
    road_file,
    station,
    table,
    terrain_file,
    voxel_file,
    waypoint_file,
    weather_file,
    zone_file,
)

from uavlab import plot
from uavlab.city import City, Place
from uavlab.flight import Autopilot, Gps, Rate
from uavlab.mavlink import connect, follow, go_home, land, start
from uavlab.mission import FencePolygon, Item, Mission
from uavlab.prediction import FEATURES, SETTINGS
from uavlab.resilience import ADVANCED, BASIC, Controller
from uavlab.trial import read_findings
from uavlab.vehicle_sim import DataLink, process, simulated_vehicle

ROOT = Path(__file__).parents[2]

PACKAGES = (
    "city", "exercises", "flight", "mavlink", "mission", "offsets", "optimizers", "planners", "plot", "prediction",
    "risk", "scene", "spline", "sweep", "trial", "vehicle_sim", "weather",
)  # fmt: skip
MODULES = ("route", "vehicle", "power", "resilience", "statistics")

MADE_BY_THE_LIBRARY = {
    "city.LazyCity",
    "city.Source", "exercises.Progress", "exercises.Verdict", "flight.Energy", "flight.Flight", "flight.Flights",
    "flight.Rate",
    "mavlink.CommandDeniedError", "mavlink.Link", "mavlink.MissionRejectedError", "mavlink.Telemetry", "mission.Check",
    "offsets.Filtered", "offsets.SafetyDomain", "optimizers.Result", "planners.Comparison", "plot.Sliders",
    "plot.Style", "power.Power",
    "prediction.Dataset", "resilience.Change", "risk.Fall", "scene.Scene", "spline.Feasibility", "spline.Limit",
    "sweep.Failure",
    "trial.Claim", "trial.Experiment", "trial.Finding", "trial.Finding.of", "trial.Measured",
    "vehicle.DataSheet", "vehicle_sim.SimulatedVehicle", "weather.DrydenParameters", "weather.ReferenceWind",
    "weather.WeatherRecord",
}  # fmt: skip
"""Results: nobody else makes them, so that their making needs no checks. Their methods do, and who takes them."""

INSIDE = {
    "city.LazyCity.blocked_window",  # of planners
    "city.LazyCity.buildings_over",  # of its own
    "city.LazyCity.window",  # of its own
    "mavlink.Link.beat",  # of `Link.receive`
    "mavlink.Link.note",  # of its record
    "mavlink.Link.receive",  # a step of `upload`, `follow` and others
    "mavlink.Link.send",  # the same
    "mission.Mission.point_of",  # of `Mission.path`, and of the simulated vehicle
    "power.induced_velocity",  # compiled
    "power.rotor_power",  # compiled
    "resilience.ConditionCheck.change",  # one of its own steps
    "resilience.Monitor.switch",  # one of its own steps
    "route.Way",  # a protocol, for annotations
    "route.check_promises",  # of `Route` and `Curve`
    "route.promises_of",  # of planners
    "statistics.likely_means",  # of `grouped_share_interval`
    "statistics.quantile",  # of `grouped_share_interval`
    "sweep.UnpicklableError",  # raised, with its words
    "sweep.WorkerLostError",  # raised, with its words
    "plot.SEQUENTIAL",  # a colour map of matplotlib
    "plot.draw_map",  # a step of figures
    "plot.finished",  # a step of figures
    "plot.new_figure",  # a step of figures
}
"""No underscore, and yet nobody's but the library's own."""


def colored():
    """What all figures of named things may have."""
    return {"colors": {"curve": "#0072B2"}}


def shown():
    """What all scenes may have."""
    return {
        "city": TOWN, "routes": (SEARCHED, {"curve": CURVE}), "safe_distance": 0.5, "expansion": False, "risk": RISK,
        "slice_height": 2.5, "wind": CALM, "uav": DRONE, **colored(),
    }  # fmt: skip


def bowl(x):
    return ((x - 0.25) ** 2).sum(axis=1)


def changing(time):
    return STILL if time < 1.0 else CALM


def level(x):
    return x * 2.0


def mean(values, axis):
    return np.mean(values, axis=axis)


def class_three(dataset):
    return np.full(np.count_nonzero(~dataset.train), 3)


def one_bar(wind):
    return plot.bars({"a": wind}, "wind [m/s]")


def planned(**more):
    """Of planners over cities."""
    return {"city": TOWN, "start": START, "goal": GOAL, **more}


def heights(**more):
    return {"min_height": 0.5, "max_height": 7.0, **more}


def promised(**more):
    return {"min_clearance": 0.25, **heights(safe_height=0.5), **more}


def weighed(**more):
    """Of planners over risk maps."""
    return {
        "risk_weight": 1.0, "length_weight": 0.5, "threat_weight": 0.0, "max_turn": 3.0, "max_pitch": 1.0,
        "max_length": 64.0, "min_clearance": 0.25, **heights(drift=False), **more,
    }  # fmt: skip


def risked(**more):
    return {"risk_map": RISK, "start": START, "goal": GOAL, **more}


def searched(**more):
    return {"f": bowl, "bounds": [(-1.0, 1.0), (-1.0, 1.0)], "budget": 64, "rng": 1, **more}


def swarmed(**more):
    return searched(
        swarm=8, inertia=(0.75, 0.5), c1=1.5, c2=2.0, v_max=0.25, start=(0.5, 0.5), target=0.0, as_printed=False, **more
    )


def drawn(**more):
    return {"city": TOWN, "routes": (LINE, {"curve": CURVE}), **more}


def panel():
    """To draw on, a new one each time."""
    return Figure(layout="constrained").subplots()


def marked(**more):
    """What diagrams and maps have in common."""
    return {
        "paths": {"way": [[1.0, 1.0], [5.0, 6.0]]}, "points": {"start": [[1.0, 1.0]]}, "notes": {"here": (2.0, 2.0)},
        "title": "map", "colors": {"way": "#0072B2"}, "axes": panel(), **more,
    }  # fmt: skip


def framed(**more):
    """What lines and points have in common."""
    return {
        "x_label": "x [m]", "y_label": "y [m]", "limits": {"most": 8.0, "usual": (1.0, 2.0)}, "places": {"here": 2.0},
        "notes": {"a note": (2.0, 4.0)}, "log": "y", "x_range": (1.0, 4.0), "y_range": (0.25, 16.0), "title": "lines",
        "colors": {"a": "#0072B2"}, "axes": panel(), **more,
    }  # fmt: skip


def flown(**more):
    return {
        "route": LINE, "city": TOWN, "uav": DRONE, "disturbance": PROCESS, "autopilot": autopilot(), "rng": 1,
        "time_step": 0.0625, **more,
    }  # fmt: skip


def site():
    return {
        "channelling": 0.5, "street_axis_deg": 60.0, "height_factor": 1.5, "mechanical_turbulence": 0.25,
        "convective_turbulence": 0.25, "convective_wind": 3.0, "peak_factor": 2.5, "stiffness": 8.5,
        "still_offset": 0.5,
    }  # fmt: skip


def mapped(**more):
    return {"cell": 1.0, "margin": 4.0, "voxels": "touched", "no_fly": [ZONE], "lazy": False, **more}


def routed(**more):
    return {
        "route": LINE, "city": TOWN, "uav": DRONE, "altitudes": "home", "speed": 4.0, "end": "land", "hold": 2.0,
        "corner_radius": 0.25, "corridor": 0.5, "min_clearance": 0.5, "ceiling": 64.0, "fence_margin": 4.0,
        "rally": [(3.5, 3.5, 2.5)], **more,
    }  # fmt: skip


def uploaded(**more):
    return {
        "mission": MISSION, "vehicle": station(), "checked": PREFLIGHT, "despite": False, "timeout": 2.0,
        "progress": False, "allow_network": False, **more,
    }  # fmt: skip


CALLS = {
    # city
    "city.Building": lambda: {"pieces": (np.array(HOUSE.pieces[0]),), "name": "house", "color": "red"},
    "city.Building.hull": lambda: {"corners": HOUSE.pieces[0], "name": "house", "color": "red"},
    "city.Building.roofed": lambda: {
        "footprint": SQUARE, "eaves": 3.0, "ridge": [(5.0, 5.5, 5.0), (6.0, 5.5, 5.0)], "bottom": 0.5, "name": "house",
        "color": "red",
    },
    "city.Building.prism": lambda: {
        "footprint": SQUARE, "top": 3.0, "bottom": 0.5, "holes": [[(5.0, 5.0), (6.0, 5.0), (6.0, 6.0), (5.0, 6.0)]],
        "name": "house", "color": "red",
    },
    "city.Building.contains": lambda: {"self": HOUSE, "points": WAY},
    "city.City": lambda: {
        "occupied": OCCUPIED, "cell": 1.0, "origin": (0.0, 0.0, 0.0), "buildings": (HOUSE,), "name": "town",
        "reference": PLACE, "ground": PLAN, "no_fly": (ZONE,), "source": SOURCE,
    },
    "city.City.from_buildings": lambda: mapped(
        buildings=[HOUSE], origin=(0.0, 0.0, 0.0), size=(12.0, 12.0, 8.0), name="town", reference=PLACE, source=SOURCE,
        terrain=TERRAIN,
    ),
    "city.City.from_buildings: by margin": lambda: mapped(
        buildings=[HOUSE], origin=None, size=None, name="town", reference=PLACE, source=SOURCE, terrain=0.5,
    ),
    "city.LazyCity.part": lambda: {"self": LAZY, "around": WAY, "margin": 2.0},
    "city.LazyCity.height_above_ground": lambda: {"self": LAZY, "points": WAY},
    "city.LazyCity.is_free": lambda: {"self": LAZY, "points": WAY},
    "city.LazyCity.distance": lambda: {"self": LAZY, "points": WAY, "exact_within": 2.0},
    "city.LazyCity.segment_distance": lambda: {"self": LAZY, "start": WAY[:2], "end": WAY[1:], "at_most": 4.0},
    "city.LazyCity.random_pairs": lambda: {"self": LAZY, "count": 2, "rng": 1, "apart": 5.0, "min_clearance": 0.5},
    "city.City.towards_wall": lambda: {"self": TOWN, "vector": (1.0, 0.5, 0.0)},
    "city.City.clearance_along": lambda: {"self": TOWN, "offset": (1.0, 0.5, 0.0), "at_most": 4.0},
    "city.City.height_above_ground": lambda: {"self": TOWN, "points": WAY},
    "city.City.distance": lambda: {"self": TOWN, "points": WAY, "exact_within": 2.0},
    "city.City.segment_distance": lambda: {"self": TOWN, "start": WAY[:2], "end": WAY[1:], "at_most": 4.0},
    "city.City.is_free_line": lambda: {"self": TOWN, "start": WAY[:2], "end": WAY[1:], "min_clearance": 0.5},
    "city.City.blocked": lambda: {"self": TOWN, "min_clearance": 0.5, **heights()},
    "city.City.out_of_heights": lambda: {"self": TOWN, **heights()},
    "city.City.zone_building": lambda: {"self": TOWN, "zone": ZONE},
    "city.City.cell_of": lambda: {"self": TOWN, "points": WAY},
    "city.City.coordinates": lambda: {"self": TOWN, "axis": 1},
    "city.City.center_of": lambda: {"self": TOWN, "index": np.array([(1, 2, 3), (4, 5, 6)])},
    "city.City.code_of": lambda: {"self": TOWN, "index": np.array([(1, 2, 3), (4, 5, 6)]), "as_printed": True},
    "city.City.index_of": lambda: {"self": TOWN, "code": np.array([5, 50]), "as_printed": True},
    "city.City.inside": lambda: {"self": TOWN, "points": WAY},
    "city.City.is_free": lambda: {"self": TOWN, "points": WAY},
    "city.City.building_at": lambda: {"self": TOWN, "point": (5.5, 5.5, 1.5)},
    "city.City.zone_at": lambda: {"self": TOWN, "point": (10.0, 2.0, 1.5)},
    "city.City.to_geographic": lambda: {"self": TOWN, "points": WAY},
    "city.City.from_geographic": lambda: {"self": TOWN, "points": np.array([(8.5, 47.25, 404.0), (8.5, 47.25, 405.0)])},
    "city.City.random_pairs": lambda: {"self": TOWN, "count": 2, "rng": 1, "apart": 5.0, "min_clearance": 0.5},
    "city.City.voxels_along": lambda: {"self": TOWN, "points": WAY},
    "city.NoFlyZone": lambda: {
        "outline": SQUARE, "lower": 1.0, "upper": 9.0, "name": "zone",
        "holes": (np.array([(5.0, 5.0), (6.0, 5.0), (6.0, 6.0), (5.0, 6.0)]),),
    },
    "city.NoFlyZone.pieces": lambda: {"self": ZONE, "low": 0.5, "high": 4.0},
    "city.Place": lambda: {"longitude": 8.5, "latitude": 47.25, "height": 400.0},
    "city.Place.east_north": lambda: {"self": PLACE, "lonlat": np.array([(8.5, 47.25), (8.5009765625, 47.2509765625)])},
    "city.Place.longitude_latitude": lambda: {"self": PLACE, "points": [(1.0, 2.0), (3.0, 4.0)]},
    "city.Source.of": lambda: {"self": SOURCE, "kind": "taken"},
    "city.Source.count": lambda: {"self": SOURCE, "kind": "taken", "what": "Build"},
    "city.Source.warn": lambda: {"self": SOURCE, "advice": "so what"},
    "city.Terrain": lambda: {
        "points": np.array([(0.0, 0.0, 1.0), (8.0, 0.0, 1.5), (0.0, 8.0, 1.0)]), "triangles": np.array([(0, 1, 2)]),
        "system": None, "beyond": "nearest",
    },
    "city.Terrain.from_raster": lambda: {
        "heights": PLAN[:4, :5], "bounds": (0.0, 0.0, 10.0, 8.0), "crs": "local", "beyond": "nearest",
    },
    "city.Terrain.from_grid": lambda: {"grid": grid(), "system": None, "beyond": "nearest"},
    "city.Terrain.from_points": lambda: {"points": np.array([(0.0, 0.0, 1.0), (8.0, 0.0, 1.5), (0.0, 8.0, 1.0)])},
    "city.Terrain.placed": lambda: {"self": TERRAIN, "place": PLACE},
    "city.Terrain.heights_at": lambda: {"self": TERRAIN, "places": [(1.0, 2.0), (3.0, 4.5)]},
    "city.read_city": lambda: {"path": voxel_file(), "options": {"cell": 2.0}},
    "city.read_cityjson": lambda: mapped(
        path=cityjson_file(), crs="local", height_unit="m", terrain=0.5,
    ),
    "city.read_geojson": lambda: mapped(
        path=geojson_file(), height="height", base="min_height", default_height=3.0, storey_height=3.0,
        heights_above="ground", height_unit="m", crs="EPSG:4326", terrain=0.5,
    ),
    "city.read_no_fly": lambda: {
        "path": zone_file(), "city": TOWN, "lower": "lower", "upper": "upper", "crs": "EPSG:4326",
    },
    "city.read_terrain": lambda: {"path": terrain_file(), "crs": "local"},
    "city.read_voxels": lambda: {"path": voxel_file(), "cell": 2.0},
    "city.table1_buildings": lambda: {},
    "city.table1_city": lambda: {"cell": 5.0},
    # exercises
    "exercises.check": lambda: {"number": "05.2", "answer": 3.0},
    "exercises.grade": lambda: {"number": "05.1", "answer": "c"},
    "exercises.progress": lambda: {"folder": str(Path(__file__).parents[2] / "notebooks" / "exercises")},
    # flight
    "flight.Autopilot": lambda: {
        "controller": ADVANCED, "speed": 5.0, "trimmed": True, "gps": Gps(), "monitor": monitor(),
        "strategy": "adaptive", "acceptance_radius": 2.0, "heeds_limits": True, "interval": 0.5,
    },
    "flight.Flight.column": lambda: {"self": FLIGHT, "name": "time"},
    "flight.Gps": lambda: {
        "rate": 10.0, "drift": 4.5, "vertical_drift": 1.5, "correlation": 1024.0, "velocity": 0.0625,
    },
    "flight.OffsetProcess": lambda: {"sigma": (0.5, 0.5, 0.25), "mean": (0.5, 0.0, 0.0), "rough": False},
    "flight.OffsetProcess.step": lambda: {"self": PROCESS, "time_step": 0.0625, "controller": BASIC},
    "flight.crash_rate": lambda: {"runs": [FLIGHTS, FLIGHTS]},
    "flight.fly": lambda: flown(number=1),
    "flight.fly: in wind": lambda: flown(number=1, disturbance=BREEZE),
    "flight.fly: in changing air": lambda: flown(number=1, disturbance=changing),
    "flight.monte_carlo": lambda: flown(flights=3, every=0.5, jobs=1, to=fresh("rows"), progress=False),
    "flight.offset_sigma": lambda: {
        "uav": DRONE, "wind": BREEZE, "ground_velocity": (1.0, 0.0, 0.0), "altitude": 32.0, "controller": ADVANCED,
    },
    # mavlink
    "mavlink.FlightLog": lambda: {"mission": MISSION, "city": TOWN, "samples": LOG.samples},
    "mavlink.FlightLog.to_csv": lambda: {"self": LOG, "path": out("flight.csv")},
    "mavlink.connect": lambda: {
        "address": "udp:127.0.0.1:0", "timeout": 0.5, "record": out("flight.tlog"), "allow_network": False,
        "wait": False,
    },
    "mavlink.download": lambda: {"vehicle": station(), "timeout": 2.0, "allow_network": False},
    "mavlink.download: by an address": lambda: {
        "vehicle": f"udpout:127.0.0.1:{station().address.port}", "timeout": 2.0, "allow_network": False,
    },
    "mavlink.follow": lambda: {"link": station(), "silence": 2.0, "until_landed": False},
    "mavlink.go_home": lambda: {"link": station()},
    "mavlink.hold": lambda: {"link": station()},
    "mavlink.land": lambda: {"link": station()},
    "mavlink.start": lambda: {"link": station()},
    "mavlink.upload": uploaded,
    "mavlink.upload: by an address": lambda: uploaded(vehicle=f"udpout:127.0.0.1:{station().address.port}"),
    # mission
    "mission.FencePolygon": lambda: {
        "corners": ((47.25, 8.5), (47.25, 8.5009765625), (47.2509765625, 8.5)), "inclusion": True, "name": "fence",
    },
    "mission.Item": lambda: {
        "command": 16, "frame": 3, "parameters": (0.0, 2.0, 0.0, 90.0), "latitude": 47.25, "longitude": 8.5,
        "altitude": 30.0,
    },
    "mission.Mission": lambda: {
        "items": MISSION.items, "home": PLACE, "fence": MISSION.fence, "rally": MISSION.rally, "speed": 4.0,
        "corner_radius": 0.25, "heights": "above sea", "place": PLACE, "return_height": 8.0, "name": "mission",
        "notes": ("all is assumed",),
    },
    "mission.Mission.from_route": lambda: routed(home=PLACE),
    "mission.Mission.from_route: by numbers": lambda: routed(
        home=(8.5 + 21 / 2**20, 47.25 + 4 / 2**18, 400.0), speed=[4.0, 2.0]
    ),
    "mission.Mission.home_on": lambda: {"self": MISSION, "city": TOWN},
    "mission.Mission.path": lambda: {"self": MISSION, "city": TOWN},
    "mission.Mission.place_on": lambda: {"self": MISSION, "city": TOWN},
    "mission.Mission.to_geojson": lambda: {"self": MISSION, "path": out("flight.geojson"), "city": TOWN},
    "mission.Mission.to_gpx": lambda: {"self": MISSION, "path": out("flight.gpx"), "city": TOWN},
    "mission.Mission.to_kml": lambda: {"self": MISSION, "path": out("flight.kml"), "city": TOWN},
    "mission.Mission.to_plan": lambda: {"self": MISSION, "path": out("flight.plan")},
    "mission.Mission.to_wpl": lambda: {"self": MISSION, "path": out("flight.waypoints")},
    "mission.Preflight": lambda: {"checks": PREFLIGHT.checks, "mission": MISSION},
    "mission.Preflight.__getitem__": lambda: {"self": PREFLIGHT, "name": "greatest height"},
    "mission.preflight": lambda: {
        "mission": MISSION, "city": TOWN, "uav": DRONE, "weather": CALM, "ceiling": 64.0, "min_clearance": 0.25,
        "fence_margin": 0.5, "flights": 2, "rng": 1, "gps": Gps(),
    },
    "mission.read_plan": lambda: {"path": plan_file()},
    "mission.read_wpl": lambda: {"path": waypoint_file()},
    # offsets
    "offsets.JointOffset": lambda: {"mean": (0.0, 0.5), "sigma": (1.0, 0.5), "correlation": 0.25},
    "offsets.JointOffset.fit": lambda: {"samples": SAMPLES},
    "offsets.JointOffset.density": lambda: {"self": JOINT, "points": SAMPLES[:3]},
    "offsets.JointOffset.radius_in_sigma": lambda: {"self": JOINT, "points": SAMPLES[:3]},
    "offsets.JointOffset.ellipse": lambda: {"self": JOINT, "coverage": 0.75, "count": 9},
    "offsets.JointOffset.within_circle": lambda: {"self": JOINT, "radius": 1.5},
    "offsets.JointOffset.circle": lambda: {"self": JOINT, "coverage": 0.75},
    "offsets.JointOffset.sample": lambda: {"self": JOINT, "count": 3, "rng": 1},
    "offsets.OffsetModel": lambda: {"mean": 0.5, "sigma": 1.0},
    "offsets.OffsetModel.fit": lambda: {"samples": SKEWED},
    "offsets.OffsetModel.density": lambda: {"self": NORMAL, "x": 0.5},
    "offsets.OffsetModel.beyond": lambda: {"self": NORMAL, "x": 0.5},
    "offsets.OffsetModel.quantile": lambda: {"self": NORMAL, "probability": 0.75},
    "offsets.OffsetModel.boundary": lambda: {"self": NORMAL, "coverage": 0.75},
    "offsets.OffsetModel.sample": lambda: {"self": NORMAL, "count": 3, "rng": 1},
    "offsets.SkewedOffset": lambda: {"mean": 0.5, "sigma": 1.0, "turbulence_intensity": 0.25},
    "offsets.SkewedOffset.from_wind": lambda: {"steady_offset": 0.5, "turbulence_intensity": 0.25},
    "offsets.SkewedOffset.fit": lambda: {"samples": SKEWED},
    "offsets.SkewedOffset.density": lambda: {"self": SKEW, "x": 0.5},
    "offsets.SkewedOffset.beyond": lambda: {"self": SKEW, "x": 0.5},
    "offsets.SkewedOffset.quantile": lambda: {"self": SKEW, "probability": 0.75},
    "offsets.SkewedOffset.boundary": lambda: {"self": SKEW, "coverage": 0.75},
    "offsets.SkewedOffset.sample": lambda: {"self": SKEW, "count": 3, "rng": 1},
    "offsets.SkewedOffset.offset_of": lambda: {"self": SKEW, "gust": 0.5},
    "offsets.SkewedOffset.gust_of": lambda: {"self": SKEW, "x": 0.5},
    "offsets.collision_probability": lambda: {
        "distance": 3.0, "sigma": 1.0, "duration": 8.0, "natural_frequency": 1.0, "uav_diameter": 0.5,
        "mean_away": 0.25,
    },
    "offsets.coverage": lambda: {"radius_in_sigma": 3.0, "dimensions": 2},
    "offsets.crossing_rate": lambda: {"margin": 3.0, "sigma": 1.0, "natural_frequency": 1.0},
    "offsets.magnitude": lambda: {"sigma": 1.0, "mean_length": 0.5},
    "offsets.minimum_safe_distance": lambda: {
        "offset": 1.5, "uav_diameter": 0.5, "mean_offset": (0.5, 0.0, 0.0), "normal": (1.0, 0.0, 0.0),
    },
    "offsets.offset_paths": lambda: {
        "sigma": 1.0, "duration": 2.0, "rng": 1, "count": 2, "step": 0.25, "natural_frequency": 1.0, "rough": False,
    },
    "offsets.pauta_filter": lambda: {"samples": SKEWED, "radius_in_sigma": 2.0},
    "offsets.pauta_radius": lambda: {"dimensions": 2, "coverage": 0.75},
    "offsets.safety_domain": lambda: {"samples": SAMPLES, "coverage": 0.75, "as_printed": False},
    # optimizers
    "optimizers.bas": lambda: searched(
        antenna=0.25, decay=0.75, greedy=True, block=1, start=(0.5, 0.5), target=0.0, as_printed=False
    ),
    "optimizers.pso": swarmed,
    "optimizers.pso_bas": lambda: swarmed(antennae="best", antenna=0.25, decay=0.75, probes=2, block=1),
    # planners
    "planners.Comparison.wins": lambda: {"self": COMPARISON, "planner": "ants", "other": "swarm"},
    "planners.Comparison.converged": lambda: {"self": COMPARISON, "within": 0.5},
    "planners.ant_colony": lambda: risked(
        rng=1, budget=40, ants=10, alpha=1.0, beta=12.0, gamma=2.0, evaporation=0.125, deposit=1.5,
        min_pheromone=0.0625, initial_pheromone=15.0, max_pheromone=16.0, height_guided=True, all_lay=False,
        splits=1, demand=0.5, record=False, as_printed=False, **weighed(),
    ),
    "planners.astar": lambda: planned(
        price=PRICES, heuristic="octile", min_clearance=0.5, as_printed=False, record=False, **heights()
    ),
    "planners.compare_planners": lambda: {
        "planners": {"ants": ants}, "maps": [RISK], "seeds": (1, 2), "budget": 10, "start": START, "goal": GOAL,
        "refinement": 0.0, "jobs": 1, "to": fresh("rows"), "progress": False,
    },
    "planners.flight_conditions": lambda: {
        "load": "light", "disturbance": MILD, "uav": DRONE, "reading": "table", "clock": 0.5,
    },
    "planners.hazard_astar": lambda: planned(
        sigma=0.25, uav_diameter=0.5, any_angle=True, mean_offset=(0.25, 0.0, 0.0), speed=5.0, natural_frequency=1.0,
        crash_price=1024.0, **heights()
    ),
    "planners.hazard_price": lambda: {
        "city": TOWN, "sigma": 0.25, "uav_diameter": 0.5, "mean_offset": (0.25, 0.0, 0.0), "speed": 5.0,
        "natural_frequency": 1.0, "crash_price": 1024.0,
    },
    "planners.least_energy": lambda: planned(
        uav=DRONE, disturbance=BREEZE, speed=5.0, min_clearance=0.5, **heights()
    ),
    "planners.least_risk": lambda: risked(
        heuristic="backward", max_igrc=10, ground_risk_buffer=0.5, as_printed=False, **weighed()
    ),
    "planners.optimality_gap": lambda: {"route": LINE, "exact": EXACT},
    "planners.pareto_front": lambda: risked(
        lengths=3, max_turn=3.0, max_pitch=1.0, min_clearance=0.25, drift=False, max_igrc=10, ground_risk_buffer=0.5,
        **heights()
    ),
    "planners.pareto_front: of lengths": lambda: risked(
        lengths=(20.0, 32.0), max_turn=3.0, max_pitch=1.0, min_clearance=0.25, drift=False, max_igrc=10,
        ground_risk_buffer=0.5, **heights()
    ),
    "planners.penalty_zone": lambda: {"city": TOWN, "safe_distance": 1.5, "penalty": 2.0, "zone": "ball"},
    "planners.potential_field": lambda: planned(
        attraction="conic", obstacles="voxels", moves="continuous", pull=1.0, push=5.0, reach=2.0, step=0.5,
        max_steps=200, record=False, **heights()
    ),
    "planners.potential_forces": lambda: {
        "city": TOWN, "points": WAY, "goal": GOAL, "attraction": "conic", "obstacles": "voxels", "pull": 1.0,
        "push": 5.0, "reach": 2.0,
    },
    "planners.refine": lambda: {
        "route": LINE, "risk_map": RISK, "rng": 1, "budget": 40, **weighed(min_clearance=0.25),
    },
    "planners.repare": lambda: planned(
        load="dead", disturbance="none", uav=DRONE, reading="table", mean_offset=(0.25, 0.0, 0.0), penalty=2.0,
        force_weight=1.0, load_weight=1.0, zone="ball", interval=1.0, as_printed=False, record=False, **heights()
    ),
    "planners.repare: in changing air": lambda: planned(
        load=0.0, disturbance=changing, uav=DRONE, reading="table", mean_offset=(0.25, 0.0, 0.0), penalty=2.0,
        force_weight=1.0, load_weight=1.0, zone="ball", interval=1.0, as_printed=False, record=False, **heights()
    ),
    "planners.repare_price": lambda: {
        "city": TOWN, "conditions": MODES, "mean_offset": (0.25, 0.0, 0.0), "penalty": 2.0, "force_weight": 1.0,
        "load_weight": 1.0, "zone": "ball",
    },
    "planners.repulsion": lambda: {"distance": 1.5, "push": 5.0, "reach": 2.0, "safe_distance": 0.5},
    "planners.shortcut": lambda: {"route": LINE, "city": TOWN, "price": PRICES, **promised(min_clearance=0.5)},
    "planners.theta_star": lambda: planned(price=PRICES, weight=1.125, taut=True, min_clearance=0.5, **heights()),
    "planners.waypoint_swarm": lambda: risked(
        rng=1, budget=120, optimizer="pso_bas", waypoints=3, encoding="points", curve="spline", arcs=50, initial=None,
        refinement=0.25, settings={"swarm": 10, "antenna": 0.25}, **weighed(),
    ),
    # plot
    "plot.area_map": lambda: {
        "city": TOWN, "areas": {"built": TOWN.occupied[:, :, 2]}, **marked(), "area": (0.0, 12.0, 0.0, 12.0),
    },
    "plot.alt_text": lambda: {"figure": one_bar(3.0)},
    "plot.bars": lambda: {"values": {"a": 1.0, "b": 2.0}, "label": "length [m]", "title": "bars"},
    "plot.convergence": lambda: {"comparison": COMPARISON, "by": "evaluations", "until": 5, **colored()},
    "plot.corner": lambda: {
        "city": TOWN, "curves": (CURVE,), "center": (2.5, 9.5, 2.5), "reach": 4.0, "uav_diameter": 0.5, "route": LINE,
    },
    "plot.crash_rates": lambda: {"rates": {"calm": {"A*": Rate(1.0, 0.5, 2.0)}}, "least": 0.0625, **colored()},
    "plot.curve_profile": lambda: {
        "curves": (CURVE,), "speed": 5.0, "cell": 1.0, "bank": 0.5, "max_pitch": 1.0, **colored(),
    },
    "plot.diagram": lambda: {
        "x_label": "x [m]", "y_label": "y [m]", "areas": {"wall": SQUARE}, "arrows": {"wind": [[1.0, 2.0], [3.0, 4.0]]},
        "x_range": (0.0, 12.0), "y_range": (0.0, 12.0), **marked(),
    },
    "plot.expansions": lambda: {"city": TOWN, "routes": (SEARCHED,), **colored()},
    "plot.field": lambda: {
        "city": TOWN, "height": 2.5, "goal": GOAL, "routes": (LINE,), "area": (0.0, 12.0, 0.0, 12.0), "spacing": 3.0,
        "setting": {"push": 5.0, "reach": 2.0}, **colored(),
    },
    "plot.front": lambda: {"routes": [LINE, EXACT], "marked": (LINE,), "label": "risk [1/h]", **colored()},
    "plot.ground_risk": lambda: {"risk_map": RISK},
    "plot.ground_station": lambda: {"log": LOG},
    "plot.heat_map": lambda: {
        "x": np.arange(3.0), "y": np.arange(4.0), "values": np.arange(12.0).reshape(3, 4), "x_label": "x [m]",
        "y_label": "y [m]", "label": "height [m]", "contours": [2.0, 5.0], "hatched": {"low": np.eye(3, 4, dtype=bool)},
        "norm": colors.Normalize(0.0, 12.0), "equal": True, **marked(),
    },
    "plot.in_flight": lambda: {"flights": {"a": FLIGHT}, "limits": {"most": 28.0}, **colored()},
    "plot.intervals": lambda: {
        "values": {"A*": {"town": [1.0, 0.5, 2.0], "field": 3.0}}, "label": "length [m]", "level": "95 %", "digits": 1,
        "log": True, "places": {"least": 1.5}, "x_range": (0.25, 8.0), "title": "rows", "colors": {"A*": "#0072B2"},
        "axes": panel(),
    },
    "plot.layers": lambda: {"risk_map": RISK},
    "plot.lines": lambda: {
        "x": np.arange(1.0, 5.0), "series": {"a": [1.0, 4.0, 2.0, 8.0]}, "point_label": "flown", "band_label": "95 %",
        "bands": {"a": ([0.5, 2.0, 1.0, 4.0], 9.0)}, "steps": True,
        "points": {"a": [[1.0, 2.0], [3.0, 4.0]]}, **framed(),
    },
    "plot.matrix": lambda: {
        "values": [[1.0, 2.0], [3.0, 4.0]], "rows": ["a", "b"], "columns": ["c", "d"], "row_label": "true",
        "column_label": "said", "label": "share", "shares": True, "digits": 1, "norm": colors.Normalize(0.0, 1.0),
        "title": "counts", "axes": panel(),
    },
    "plot.new_panels": lambda: {"rows": 1, "columns": 2, "width": 4.0, "height": 3.0, "share": "y"},
    "plot.plan": lambda: drawn(**colored()),
    "plot.points": lambda: {"groups": {"a": [[1.0, 2.0], [3.0, 4.0]]}, **framed()},
    "plot.profile": lambda: drawn(safe_distance=0.5, **colored()),
    "plot.risk": lambda: {"risk_map": RISK, "height": 2.5, "routes": (LINE,), **colored()},
    "plot.risk_norm": lambda: {"risk_map": RISK},
    "plot.styles": lambda: {"names": ["A*", "mine"], "colors": {"mine": "#009E73"}},
    "plot.runs": lambda: {
        "values": {"PSO": {"town": [1.0, 0.5, 2.0]}}, "label": "gap [%]", "digits": 1, "log": True,
        "places": {"least": 1.5}, "x_range": (0.25, 8.0), "title": "rows", "colors": {"PSO": "#0072B2"},
        "axes": panel(),
    },
    "plot.safety_domain": lambda: {"samples": SAMPLES, "domains": {"best": DOMAIN}},
    "plot.section": lambda: {
        "city": TOWN, "height": 2.5, "values": PRICES, "routes": (LINE,), "label": "price [1]",
        "norm": colors.Normalize(0.0, 2.0), **colored(),
    },
    "plot.sliders": lambda: {
        "draw": one_bar, "title": "a bar", "labels": {"wind": "wind [m/s]"}, "start": {"wind": 3.0}, "jobs": 1,
        "progress": False, "values": {"wind": [1.0, 3.0]},
    },
    "plot.tracks": lambda: {
        "city": TOWN, "flights": {"a": [FLIGHT]}, "routes": {"a": LINE}, "area": (0.0, 12.0, 0.0, 12.0),
        "wind": CALM, **colored(),
    },
    "plot.value_map": lambda: {
        "city": TOWN, "values": np.arange(float(TOWN.occupied[:, :, 0].size)).reshape(TOWN.shape[:2]),
        "label": "height [m]", **marked(), "area": (0.0, 12.0, 0.0, 12.0), "norm": colors.Normalize(0.0, 200.0),
    },
    # prediction
    "prediction.OffsetPredictor": lambda: {
        "features": FEATURES, "class_count": 6, "quantile": 0.875, "training": predictor().training,
    },
    "prediction.OffsetPredictor.fit": lambda: {
        "self": predictor(), "features": table()[0], "offsets": table()[1],
        "groups": np.arange(len(table()[1])) // 4, "drop_nan": False,
    },
    "prediction.OffsetPredictor.predict_probabilities": lambda: {"self": predictor(), "features": table()[0]},
    "prediction.OffsetPredictor.predict_class": lambda: {"self": predictor(), "features": table()[0]},
    "prediction.OffsetPredictor.predict_offset": lambda: {"self": predictor(), "features": table()[0]},
    "prediction.OffsetPredictor.predict_sigma": lambda: {
        "self": predictor(), "features": table()[0], "pauta": 3.0,
    },
    "prediction.OffsetPredictor.log_offset": lambda: {"self": predictor(), "features": table()[0]},
    "prediction.OffsetPredictor.save": lambda: {"self": predictor(), "path": out("saved.json")},
    "prediction.OffsetPredictor.load": lambda: {"path": model_file(), "features": FEATURES},
    "prediction.Setting": lambda: {
        "channelling": 0.5, "noise": 0.25, "class_count": 6, "wind_scale": 4.0, "wind_shape": 2.0,
        "real_weather": False,
    },
    "prediction.bayes_accuracy": lambda: {"log_median": np.array([0.5, 1.0, 1.5]), "noise": 0.25, "class_count": 6},
    "prediction.class_probabilities": lambda: {
        "log_median": np.array([0.5, 1.0, 1.5]), "noise": 0.25, "class_count": 6,
    },
    "prediction.compare_models": lambda: {
        "seeds": (1, 2), "setting": SETTINGS["paper"], "models": {"three": class_three}, "jobs": 1, "progress": False,
        "each": True,
    },
    "prediction.make_dataset": lambda: {
        "setting": "paper", "rng": 1, "uav": DRONE, "count": 40, "train_count": 30,
    },
    "prediction.median_offsets": lambda: {"weather": HOURS, "uav": DRONE, **site()},
    "prediction.offset_class": lambda: {"offsets": np.array([0.5, 1.5, 9.0]), "class_count": 6},
    "prediction.score": lambda: {"data": data(), "predicted": class_three(data())},
    "prediction.simulate_offsets": lambda: {"weather": HOURS, "uav": DRONE, "rng": 1, "noise": 0.25, "site": site()},
    "prediction.synthetic_weather": lambda: {"count": 5, "rng": 1, "wind_scale": 4.0, "wind_shape": 2.0},
    # risk
    "risk.RiskMap": lambda: {
        "city": TOWN, "population_density": PLAN, "shelter": PLAN, "vehicle_share": PLAN, "uav": DRONE,
        "safe_height": 0.5, "min_height": 0.5, "as_printed": False,
    },
    "risk.RiskMap.integral": lambda: {"self": RISK, "route": LINE, "drift": False},
    "risk.RiskMap.igrc_within": lambda: {"self": RISK, "ground_risk_buffer": 2.0},
    "risk.RiskMap.highest_igrc": lambda: {"self": RISK, "route": LINE, "ground_risk_buffer": 2.0},
    "risk.RiskMap.cell_sum": lambda: {"self": RISK, "route": LINE},
    "risk.RiskMap.fatalities": lambda: {"self": RISK, "route": LINE, "speed": 5.0},
    "risk.ballistic_fall": lambda: {"height": 30.0, "uav": DRONE, "speed": 5.0, "pitch": 0.25, "air_density": 1.25},
    "risk.building_threat": lambda: {"city": TOWN, "constant": 128.0},
    "risk.fall_speed": lambda: {"height": 30.0, "uav": DRONE, "air_density": 1.25, "as_printed": False},
    "risk.ground_risk_buffer": lambda: {"height": 30.0, "dimension": 0.5, "speed": 16.0},
    "risk.igrc": lambda: {
        "population_density": 0.03125, "dimension": 0.5, "speed": 16.0, "mass": 1.5, "controlled": False,
    },
    "risk.nominal_critical_area": lambda: {"dimension": 0.5, "speed": 16.0},
    "risk.raw_igrc": lambda: {"population_density": 0.03125, "critical_area": 8.0, "tlos": 1e-6},
    "risk.tolerable_failure_rate": lambda: {"population_density": 0.03125, "critical_area": 8.0, "tlos": 1e-6},
    "risk.impact_energy": lambda: {"mass": 1.5, "forward_speed": 5.0, "fall_speed": 20.0},
    "risk.impact_fatality": lambda: {
        "energy": 256.0, "shelter": 0.25, "even_odds_energy": 1048576.0, "least_fatal_energy": 34.0,
    },
    "risk.lethal_area": lambda: {
        "height": 30.0, "forward_speed": 5.0, "fall_speed": 20.0, "uav_diameter": 0.5, "person_radius": 0.25,
        "person_height": 1.75,
    },
    "risk.osm_layers": lambda: {
        "city": TOWN, "path": road_file(), "cars_per_km": 0.125, "lane_width": 3.0, "crs": "EPSG:4326",
    },
    "risk.osm_layers: by class": lambda: {
        "city": TOWN, "path": road_file(), "cars_per_km": {"residential": 0.5}, "lane_width": 3.0, "crs": "EPSG:4326",
    },
    "risk.person_rate": lambda: {
        "height": 30.0, "population_density": 0.03125, "shelter": 0.25, "uav": DRONE, "speed": 5.0, "ballistic": False,
        "air_density": 1.25, "as_printed": False,
    },
    "risk.printed_threat": lambda: {"route": LINE, "city": TOWN, "constant": 128.0},
    "risk.random_campus": lambda: {"rng": 1, "cell": 10.0},
    "risk.read_people": lambda: {
        "city": TOWN, "path": people_file(), "per": "pixel", "crs": "local", "elsewhere": 0.015625,
    },
    "risk.raster_layer": lambda: {
        "city": TOWN, "values": PLAN[:4, :5], "bounds": (0.0, 0.0, 10.0, 12.0), "crs": None, "per": "km²", "fill": 0.5,
    },
    "risk.reference_campus": lambda: {"cell": 10.0},
    "risk.road_layer": lambda: {
        "city": TOWN, "lines": [[(0.0, 9.0), (12.0, 9.0)]], "width": 3.0, "cars_per_km": 0.125, "lane_width": 3.0,
        "crs": None,
    },
    "risk.road_layer: of each": lambda: {
        "city": TOWN, "lines": [[(0.0, 9.0), (12.0, 9.0)], [(9.0, 0.0), (9.0, 12.0)]], "width": [3.0, 4.0],
        "cars_per_km": [0.125, 0.25], "lane_width": 3.0, "crs": None,
    },
    "risk.shelter_layer": lambda: {"city": TOWN, "ground": PLAN, "high": 4.0},
    "risk.shelter_layer: by name": lambda: {"city": TOWN, "ground": "sparse trees", "high": 4.0},
    "risk.terminal_speed": lambda: {"uav": DRONE, "air_density": 1.25},
    "risk.vehicle_rate": lambda: {"share": 0.25},
    "risk.vehicle_share": lambda: {"cars_per_km": 0.125, "lane_width": 3.0},
    # scene
    "scene.live": lambda: {
        "city": TOWN, "start": START, "goal": GOAL, "planners": ["A*", "Dijkstra"], "shown": ["A*"],
        "settings": {"keep": 0.5}, "risk": None, "flights": 3, "expansions": True, "uav": DRONE,
        "colors": {"A*": "#0072B2"}, "camera": "side", "height": 300, "title": "a town",
    },
    "scene.live_curve": lambda: {
        "city": TOWN, "control": WAY, "step": 0.5, "bank": 0.5, "colors": {"curve": "#0072B2"}, "camera": "side",
        "height": 300, "title": "a town",
    },
    "scene.page": lambda: {
        **shown(), "flights": [FLIGHT], "camera": "chase", "start_paused": True, "start_at": 0.5, "title": "a town",
    },
    "scene.page: of a search": lambda: {
        **shown(), "routes": (SEARCHED,), "expansion": True, "risk": None, "slice_height": None, "flights": (),
        "camera": (-60.0, 30.0), "start_paused": False, "start_at": 2.0, "title": None,
    },
    "scene.show": lambda: {
        **shown(), "flights": {"a": FLIGHT}, "camera": "side", "start_paused": True, "start_at": 0.5, "height": 300,
    },
    "scene.still": lambda: {**shown(), "flights": {"a": FLIGHT}, "camera": (-60.0, 30.0), "start_at": 0.5},
    # spline
    "spline.Curve": lambda: {
        "control": WAY, "ends": "phantom", "step": 0.5, "planner": "curve", "info": {}, "takeoff": 0, "landing": 0,
        **promised(),
    },
    "spline.Curve.at": lambda: {"self": CURVE, "parameter": np.array([0.5, 1.5]), "derivative": 1},
    "spline.Curve.least_distances": lambda: {"self": CURVE, "city": TOWN, "at_most": 4.0},
    "spline.Curve.clearance": lambda: {"self": CURVE, "city": TOWN},
    "spline.Curve.route": lambda: {"self": CURVE, "step": 1.0},
    "spline.allowed_speed": lambda: {"curvature": 0.25, "bank": 0.5},
    "spline.basis_functions": lambda: {
        "t": np.array([0.25, 0.5]), "knots": np.array([0.0, 0.0, 0.5, 1.0, 1.0]), "degree": 1, "as_printed": False,
    },
    "spline.bspline": lambda: {"control": WAY, "t": np.array([0.25, 0.5]), "degree": 2},
    "spline.cubic_bspline": lambda: {"control": WAY, "per_segment": 4, "ends": "phantom", "derivative": 1},
    "spline.curvature": lambda: {"velocity": (1.0, 0.5, 0.0), "acceleration": (0.0, 1.0, 0.5)},
    "spline.feasibility": lambda: {
        "curve": CURVE, "city": TOWN, "uav": DRONE, "speed": 2.0, "wind": (1.0, 0.0, 0.0), "bank": 0.5,
        "max_pitch": 1.0, "max_turn": 3.0, "as_printed": False, "reading": "plan", **promised(),
    },
    "spline.Feasibility.__getitem__": lambda: {"self": FOUND, "name": "pitch"},
    "spline.fitted": lambda: {"points": CURVE.control, "count": 4},
    "spline.greatest_speed": lambda: {"curve": CURVE, "uav": DRONE, "wind": (1.0, 0.0, 0.0), "bank": 0.5},
    "spline.smooth": lambda: {"route": LINE, "city": TOWN, "uav": DRONE, **promised()},
    "spline.subdivided": lambda: {"control": CURVE.control},
    "spline.tilted_thrust": lambda: {"curve": CURVE, "uav": DRONE, "speed": 2.0, "wind": (1.0, 0.0, 0.0)},
    # vehicle_sim
    "vehicle_sim.DataLink": lambda: {"bit_rate": 57344.0, "delay": 0.0625, "jitter": 0.03125, "loss": 0.125},
    "vehicle_sim.simulated_vehicle": lambda: {
        "city": TOWN, "uav": DRONE, "weather": BREEZE, "at": (1.5, 1.5, 2.5), "rng": 1, "gps": Gps(),
        "link": DataLink(loss=0.125), "firmware": "px4", "pace": 2.0, "port": 0, "lifetime": 64.0,
        "truth": out("truth.csv"),
    },
    # weather
    "weather.Weather": lambda: {
        "temperature_c": 15.0, "humidity_percent": 50.0, "pressure_hpa": 1013.0, "forecast_wind": 3.0,
        "forecast_max_wind": 5.0, "measured_wind": 2.0, "wind_from_deg": 90.0, "rain_mm_per_h": 2.0,
        "radiation": 512.0,
    },
    "weather.WeatherRecord.weather": lambda: {"self": RECORD, "at": 1},
    "weather.WeatherRecord.weather: at a time": lambda: {"self": RECORD, "at": "2026-01-01T00:30"},
    "weather.WeatherRecord.row": lambda: {"self": RECORD, "at": 1},
    "weather.WeatherRecord.place": lambda: {"self": RECORD, "row": 1},
    "weather.Wind": lambda: {
        "mean": (2.0, 1.0, 0.0), "gusts": "ou", "deviation": 0.5, "correlation": 2.0, "rain_mm_per_h": 2.0,
        "air_density": 1.25,
    },
    "weather.Wind.from_weather": lambda: {"weather": MILD, "gusts": "ou", "correlation": 2.0},
    "weather.air_density": lambda: {"temperature_c": 15.0, "humidity_percent": 50.0, "pressure_hpa": 1013.0},
    "weather.air_speed_held": lambda: {"uav": DRONE, "rain": 0.5, "air_density": 1.25, "share": 0.75},
    "weather.course_wind_limit": lambda: {"air_speed": 8.0, "ground_speed": 4.0, "wind_angle": 2.0},
    "weather.dryden_gusts": lambda: {
        "duration": 2.0, "time_step": 0.25, "air_speed": 5.0, "altitude": 32.0, "wind_at_6m": 4.0, "rng": 1,
    },
    "weather.dryden_parameters": lambda: {"altitude": 32.0, "wind_at_6m": 4.0},
    "weather.dryden_spectrum": lambda: {"omega": 0.5, "air_speed": 5.0, "altitude": 32.0, "wind_at_6m": 4.0},
    "weather.greensboro_weather": lambda: {},
    "weather.ground_speed_held": lambda: {
        "uav": DRONE, "direction": (1.0, 0.5, 0.0), "wind": (1.0, 0.0, 0.0), "rain_mm_per_h": 2.0, "air_density": 1.25,
        "share": 0.75,
    },
    "weather.grounded_by": lambda: {"uav": DRONE, "weather": MILD, "ground_speed": 2.0, "safety_factor": 1.125},
    "weather.gust_spectrum": lambda: {"wind": BREEZE, "omega": 0.5, "air_speed": 5.0, "altitude": 32.0},
    "weather.lift_margin": lambda: {"uav": DRONE, "rain": 0.5, "safety_factor": 1.125, "as_printed": False},
    "weather.mean_wind": lambda: {"samples": np.array([1.0, 2.0, 4.0]), "interval": 1.0, "averaging_time": 2.0},
    "weather.mean_wind_limit": lambda: {
        "uav": DRONE, "rain": 0.5, "ground_speed": 2.0, "air_density": 1.25, "safety_factor": 1.125,
        "gust_factor": 1.75, "keep_speed": False,
    },
    "weather.rain_force": lambda: {
        "rain_mm_per_h": 2.0, "area": 0.125, "drop_speed": 8.0, "restitution": 0.25, "as_printed": False,
    },
    "weather.reachable_ground_speed": lambda: {
        "air_speed": 8.0, "wind": (1.0, 0.0, 0.0), "course": (1.0, 0.5, 0.0),
    },
    "weather.read_weather": lambda: {"path": weather_file()},
    "weather.reference_wind": lambda: {
        "forecast_mean": 3.0, "measured_mean": 2.0, "forecast_max": 5.0, "gust_factor": 1.75, "as_printed": False,
    },
    "weather.wind_drag": lambda: {
        "wind": (1.0, 0.0, 0.0), "ground_velocity": (0.0, 2.0, 0.0), "drag_area": 0.0625, "air_density": 1.25,
        "as_printed": False,
    },
    "weather.wind_limit": lambda: {"uav": DRONE, "rain": 0.5, "air_density": 1.25, "safety_factor": 1.125},
    # route
    "route.as_route": lambda: {"way": CURVE, "name": "way"},
    "route.Route": lambda: {
        "points": WAY, "planner": "given", "reached": True, "reason": "", "cost": 25.0, "info": {}, "takeoff": 0,
        "landing": 0, "max_length": 64.0, "priced": "risk", **promised(),
    },
    "route.Route.none": lambda: {"planner": "given", "reason": "stuck", "info": {"elapsed": 0.5}},
    "route.Route.clearance_profile": lambda: {"self": LINE, "city": TOWN},
    "route.Route.clearance": lambda: {"self": LINE, "city": TOWN},
    "route.Route.integral": lambda: {"self": LINE, "city": TOWN, "values": PRICES},
    "route.Route.voxels": lambda: {"self": LINE, "city": TOWN},
    "route.Route.resample": lambda: {"self": LINE, "step": 1.0},
    "route.Route.to_csv": lambda: {"self": LINE, "path": out("route.csv")},
    # vehicle
    "vehicle.UAV": lambda: dict(VEHICLE),
    "vehicle.UAV.loaded": lambda: {"self": DRONE, "payload": 0.5},
    "vehicle.UAV.hover_power": lambda: {"self": DRONE, "air_density": 1.25},
    "vehicle.UAV.horizontal_reserve": lambda: {"self": DRONE, "downward_force": 0.5},
    # power
    "power.profile_share": lambda: {"uav": DRONE},
    "power.power_needed": lambda: {
        "uav": DRONE, "velocity": (4.0, 1.0, 0.5), "wind": (1.0, 0.0, 0.0), "rain_mm_per_h": 2.0, "air_density": 1.25,
    },
    "power.energy_per_metre": lambda: {
        "uav": DRONE, "direction": (1.0, 0.5, 0.0), "wind": (1.0, 0.0, 0.0), "speed": 5.0, "rain_mm_per_h": 2.0,
        "air_density": 1.25,
    },
    # resilience
    "resilience.resilience_level": lambda: {"load": "light", "disturbance": "mild"},
    "resilience.safe_distance": lambda: {"load": "light", "disturbance": "mild", "reading": "physical", "uav": DRONE},
    "resilience.safe_distance: of numbers": lambda: {
        "load": 0.25, "disturbance": BREEZE, "reading": "table", "uav": DRONE,
    },
    "resilience.payload_of": lambda: {"load": 0.25},
    "resilience.kind_and_speed": lambda: {"disturbance": "mild", "name": "disturbance"},
    "resilience.gust_offset": lambda: {"uav": DRONE, "wind_speed": 4.0},
    "resilience.gust_force": lambda: {"uav": DRONE, "wind_speed": 4.0},
    "resilience.load_class": lambda: {"payload": 0.25},
    "resilience.disturbance_class": lambda: {"wind_speed": 4.0},
    "resilience.ConditionCheck": lambda: {"predicted": 1.0, "step": 0.5, "hold": 16.0, "release": 0.75},
    "resilience.ConditionCheck.observe": lambda: {"self": condition_check(), "time": 1.0, "offset": 1.5},
    "resilience.Controller": lambda: {
        "name": "mine", "speed_share": 0.5, "natural_frequency": 1.5, "tilt_share": 0.75,
    },
    "resilience.basic_offset": lambda: {"controller": ADVANCED},
    "resilience.Monitor": lambda: {
        "check": condition_check(), "uav_diameter": 0.5, "level": "lower", "spare": 0.5, "hold": 4.0,
    },
    "resilience.Monitor.observe": lambda: {"self": monitor(), "time": 1.0, "offset": 1.5, "clearance": 2.0},
    # statistics
    "statistics.share_interval": lambda: {"count": 3, "total": 10},
    "statistics.grouped_share_interval": lambda: {"counts": np.array([1, 2, 0]), "trials": 10},
    "statistics.over_maps": lambda: {"statistic": mean, "values": PLAN[:3, :4]},
    "statistics.share_over_maps": lambda: {"values": PLAN[:3, :4]},
    # sweep
    "sweep.sweep": lambda: {
        "function": level, "cases": [{"x": 1.0}, {"x": 2.0}], "jobs": 1, "on_error": "record",
        "to": fresh("rows"), "progress": False, "unit": "case",
    },
    # trial
    "trial.verdict": lambda: {"claim": JUDGED.claim, "measured": JUDGED.measured},
    "trial.agree": lambda: {"one": JUDGED, "other": JUDGED},
    "trial.run_trial": lambda: {"claims": [JUDGED.claim], "full": False, "jobs": 1, "progress": False},
    "trial.write_findings": lambda: {"findings": [JUDGED], "path": out("findings.csv")},
    "trial.read_findings": lambda: {"path": ROOT / "notebooks" / "trial.csv"},
    "trial.claims_table": lambda: {"findings": [JUDGED], "quick": [JUDGED], "links": {"01": "01.ipynb"}},
    "trial.verdict_figure": lambda: {"findings": [JUDGED]},
}  # fmt: skip


JUDGED = next(one for one in read_findings(ROOT / "notebooks" / "trial.csv") if one.claim.of == "lift")


def connected(**arguments):
    with connect(**arguments) as link:
        return repr(link)


def said_first(**arguments):
    """Of a vehicle, whose words differ from time to time."""
    return type(next(follow(**arguments)))


def obeyed(command, *, flies=True):
    """A command to a vehicle of its own, which none of the others has sent away."""

    def told(link):
        if link is not station():
            return command(link)
        with in_flight(flies) as other:
            return command(other)

    return told


def settled(**arguments):
    """What the process of a vehicle would be told, without one."""
    told = []

    def begun(command, **more):
        told.append((Path(command[-1]) / "settings.json").read_text(encoding="utf-8"))

    with (
        mock.patch.object(process.subprocess, "Popen", begun),
        mock.patch.object(process, "port_of", return_value=14580),
        mock.patch.object(process, "stop"),
        simulated_vehicle(**arguments),
    ):
        return told[0]


USES = {
    "city.Place": lambda **fields: City(OCCUPIED, reference=Place(**fields)),
    "flight.Gps": lambda **fields: Autopilot(gps=Gps(**fields)),
    "mavlink.connect": connected,
    "mavlink.follow": said_first,
    "mavlink.go_home": obeyed(go_home),
    "mavlink.land": obeyed(land),
    "mavlink.start": obeyed(start, flies=False),
    "mission.FencePolygon": lambda **fields: Mission(MISSION.items, PLACE, fence=(FencePolygon(**fields),)),
    "mission.Item": lambda **fields: Mission((Item(**fields),), PLACE),
    "resilience.Controller": lambda **fields: Autopilot(controller=Controller(**fields)),
    "vehicle_sim.simulated_vehicle": settled,
}
"""Named tuples can't look at their fields: who takes them has to. What talks to a vehicle needs one; what is a context,
or goes on, does nothing before it is begun."""


def public():
    """Every public function, class, and method with arguments, by key, but for what is left out above."""
    return {key: value for key, value in everything().items() if key not in MADE_BY_THE_LIBRARY | INSIDE}


def everything():
    found = {}
    for name in PACKAGES + MODULES:
        module = importlib.import_module(f"uavlab.{name}")
        own = [key for key, value in vars(module).items() if getattr(value, "__module__", "") == module.__name__]
        for key in getattr(module, "__all__", own):
            value = getattr(module, key)
            if key.startswith("_") or not callable(value):
                continue
            found[f"{name}.{key}"] = value
            for method in vars(value) if inspect.isclass(value) else ():
                bound = getattr(value, method)
                if method == "__getitem__" or (
                    not method.startswith("_") and (inspect.isfunction(bound) or inspect.ismethod(bound))
                ):
                    names = list(inspect.signature(bound).parameters)
                    if names and names != ["self"]:
                        found[f"{name}.{key}.{method}"] = bound
    return found
