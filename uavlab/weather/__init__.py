"""Weather: states of it, the forces they make, turbulence, and real records."""

from uavlab.weather.forces import (
    ReferenceWind,
    Weather,
    air_density,
    lift_margin,
    rain_force,
    reachable_ground_speed,
    reference_wind,
    wind_drag,
)

__all__ = [
    "ReferenceWind",
    "Weather",
    "air_density",
    "lift_margin",
    "rain_force",
    "reachable_ground_speed",
    "reference_wind",
    "wind_drag",
]
