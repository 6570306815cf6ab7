"""Cities: buildings, voxels, clearance; the paper's map and readers for real ones."""

from uavlab.city.buildings import Building
from uavlab.city.cityjson import read_cityjson
from uavlab.city.geojson import read_geojson
from uavlab.city.model import City
from uavlab.city.readers import read_city, read_voxels
from uavlab.city.table1 import table1_buildings, table1_city

__all__ = [
    "Building",
    "City",
    "read_city",
    "read_cityjson",
    "read_geojson",
    "read_voxels",
    "table1_buildings",
    "table1_city",
]
