"""Weather: states of it, the forces they make, turbulence, the flight envelope, and real records."""

from uavlab.weather.envelope import (
    air_speed_held,
    course_wind_limit,
    ground_speed_held,
    grounded_by,
    mean_wind_limit,
    wind_limit,
)
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
from uavlab.weather.own_record import WeatherRecord, mean_wind, read_weather
from uavlab.weather.records import greensboro_weather
from uavlab.weather.turbulence import DrydenParameters, dryden_gusts, dryden_parameters, dryden_spectrum
from uavlab.weather.wind import Wind, gust_spectrum

__all__ = [
    "DrydenParameters",
    "ReferenceWind",
    "Weather",
    "WeatherRecord",
    "Wind",
    "air_density",
    "air_speed_held",
    "course_wind_limit",
    "dryden_gusts",
    "dryden_parameters",
    "dryden_spectrum",
    "greensboro_weather",
    "ground_speed_held",
    "grounded_by",
    "gust_spectrum",
    "lift_margin",
    "mean_wind",
    "mean_wind_limit",
    "rain_force",
    "reachable_ground_speed",
    "read_weather",
    "reference_wind",
    "wind_drag",
    "wind_limit",
]
