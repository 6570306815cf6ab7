"""Cities: buildings, voxels, clearance; the paper's map and readers for real ones."""

from uavlab.city.buildings import Building
from uavlab.city.model import City
from uavlab.city.table1 import table1_buildings, table1_city

__all__ = ["Building", "City", "table1_buildings", "table1_city"]
