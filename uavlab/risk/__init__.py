"""Ground risk: what a falling UAV does to the people and cars below, as a rate per hour of flight (RISK-ACO, PSO-BAS).

The chain: a failure, a fall (`fall_speed`, or `ballistic_fall` with drag on the whole velocity), a blow
(`impact_energy`) on an area (`lethal_area`), the chance that it kills (`impact_fatality`), people and cars per area. A
`RiskMap` has the rate for each voxel of a city, and the cost of a route: as an integral, as deaths per mission, and
as the papers print it. Beside it stands the class that authorities ask for (`igrc`, SORA 2.5).
"""

from uavlab.risk.campus import CAMPUS_FLIGHT, random_campus, reference_campus
from uavlab.risk.fall import (
    Fall,
    ballistic_fall,
    fall_speed,
    impact_energy,
    lethal_area,
    terminal_speed,
)
from uavlab.risk.layers import raster_layer, road_layer, shelter_layer
from uavlab.risk.model import RiskMap
from uavlab.risk.osm import CARS_BY_CLASS, osm_layers
from uavlab.risk.people import read_people
from uavlab.risk.rates import (
    POPULATION_DENSITY,
    SHELTER,
    impact_fatality,
    person_rate,
    vehicle_rate,
    vehicle_share,
)
from uavlab.risk.sora import (
    TLOS,
    ground_risk_buffer,
    igrc,
    nominal_critical_area,
    raw_igrc,
    tolerable_failure_rate,
)
from uavlab.risk.threat import LENGTH_WEIGHT, THREAT_WEIGHT, building_threat, printed_threat

__all__ = [
    "CAMPUS_FLIGHT",
    "CARS_BY_CLASS",
    "LENGTH_WEIGHT",
    "POPULATION_DENSITY",
    "SHELTER",
    "THREAT_WEIGHT",
    "TLOS",
    "Fall",
    "RiskMap",
    "ballistic_fall",
    "building_threat",
    "fall_speed",
    "ground_risk_buffer",
    "igrc",
    "impact_energy",
    "impact_fatality",
    "lethal_area",
    "nominal_critical_area",
    "osm_layers",
    "person_rate",
    "printed_threat",
    "random_campus",
    "raster_layer",
    "raw_igrc",
    "read_people",
    "reference_campus",
    "road_layer",
    "shelter_layer",
    "terminal_speed",
    "tolerable_failure_rate",
    "vehicle_rate",
    "vehicle_share",
]
