"""Cities: buildings and ground, voxels, clearance; the paper's map and readers for real ones."""

from uavlab.city.buildings import Building
from uavlab.city.cityjson import read_cityjson
from uavlab.city.geojson import read_geojson
from uavlab.city.lazy import LazyCity
from uavlab.city.model import City
from uavlab.city.place import Place
from uavlab.city.rasters import read_terrain
from uavlab.city.readers import read_city
from uavlab.city.source import Source
from uavlab.city.table1 import table1_buildings, table1_city
from uavlab.city.terrain import Terrain
from uavlab.city.voxel_map import read_voxels
from uavlab.city.zone_files import read_no_fly
from uavlab.city.zones import NoFlyZone

__all__ = [
    "Building",
    "City",
    "LazyCity",
    "NoFlyZone",
    "Place",
    "Source",
    "Terrain",
    "read_city",
    "read_cityjson",
    "read_geojson",
    "read_no_fly",
    "read_terrain",
    "read_voxels",
    "table1_buildings",
    "table1_city",
]
