"""What a live scene's page keeps of a city, a risk map and flights: bytes for its arrays, and numbers for the rest."""

from __future__ import annotations

from typing import Any

import numpy as np

from uavlab.city import City
from uavlab.city.bounds import slack_of
from uavlab.flight import Autopilot
from uavlab.flight.simulation import TIME_STEP
from uavlab.planners.risk_question import MAX_TURN, Weights, checked_limits, price_per_cell, query_of
from uavlab.risk import RiskMap
from uavlab.spline.curve import contact_distance
from uavlab.spline.limits import MAX_PITCH
from uavlab.statistics import share_interval
from uavlab.vehicle import LIGHT_QUADROTOR, UAV
from uavlab.weather import rain_force, wind_limit
from uavlab.weather.envelope import CREEP, steady_air_speed
from uavlab.weather.wind import Wind
from uavlab.web.craft import craft_of, state_of

MOST_VOXELS = 6_000_000
"""Of a city in a page: its planners take up to 70 bytes for each."""

LOG_EVERY = 0.2
"""How often a flight's place is kept for its track [s]."""


class Bytes:
    """Arrays one after the other, each at a multiple of eight."""

    def __init__(self) -> None:
        self.content = bytearray()
        self.places: dict[str, int] = {}

    def add(self, name: str, values: np.ndarray) -> None:
        """Truth values are packed, eight in a byte."""
        self.content += bytes(-len(self.content) % 8)
        self.places[name] = len(self.content)
        self.content += (np.packbits(values) if values.dtype == bool else np.ascontiguousarray(values)).tobytes()


def city_told(city: City, closed: np.ndarray, kept: Bytes) -> dict[str, Any]:
    """A city's voxels, where else one may not be (nx, ny, nz), and where it lies."""
    if city.occupied.size > MOST_VOXELS:
        cell = city.cell * (city.occupied.size / MOST_VOXELS) ** (1 / 3)
        digits = 10.0 ** (np.floor(np.log10(cell)) - 1)
        raise ValueError(
            f"city has {city.occupied.size:,} voxels, a page has room for {MOST_VOXELS:,}: make it with "
            f"cell={np.ceil(cell / digits) * digits:g}"
        )
    kept.add("occupied", city.occupied)
    if closed.any():
        kept.add("closed", closed)
    if city.no_fly:
        kept.add("zones", city.in_no_fly)
    return {
        "shape": list(city.shape), "cell": city.cell, "origin": np.asarray(city.origin, float).tolist(),
        "slack": slack_of(city),
    }  # fmt: skip


def risk_told(risk: RiskMap, kept: Bytes) -> tuple[dict[str, Any], np.ndarray]:
    """A risk map for the page, and where its limits of turns, climbs and heights don't let a route be."""
    limits = checked_limits(risk, MAX_TURN, MAX_PITCH, 0.0, None, np.inf)
    weights = {"least": Weights(), "length": Weights(risk=0.0, length=1.0)}
    prices = {name: price_per_cell(risk, weight) for name, weight in weights.items()}
    for name, values in prices.items():
        kept.add(name, values)
    kept.add("rate", risk.rate)
    kept.add("low", risk.city.out_of_heights(risk.min_height, np.inf))
    query = query_of(risk, prices["least"], 0, 0, limits)
    told = {
        "prices": list(prices), "climb": query.climb.astype(int).tolist(), "turn": query.turn.astype(int).tolist(),
        "lowest": risk.min_height, "scale": 1 / (3600 * risk.uav.cruise_speed),
    }  # fmt: skip
    return told, query.blocked


def flights_told(count: int, uav: UAV, kept: Bytes) -> dict[str, Any]:
    """What flights in a page need; their random numbers are those of `monte_carlo(..., rng=0)`."""
    calm, autopilot = Wind((0.0, 0.0), deviation=0.0), Autopilot()
    kept.add("states", np.array([state_of(one) for one in np.random.default_rng(0).spawn(count)]))
    kept.add("intervals", np.array([share_interval(crashed, count) for crashed in range(count + 1)]))
    known = "LIGHT_QUADROTOR" if uav == LIGHT_QUADROTOR else "uav"
    rain = float(rain_force(0.0, uav.rain_area))
    return {
        "total": count, "craft": craft_of(uav, calm, autopilot, TIME_STEP).tolist(), "speed": uav.cruise_speed,
        "touching": contact_distance(uav.diameter), "near": autopilot.acceptance_radius, "step": TIME_STEP,
        "every": round(LOG_EVERY / TIME_STEP), "memory": calm.correlation,
        "gust": float(wind_limit(uav, rain, air_density=calm.air_density)),
        "head": steady_air_speed(uav, rain, calm.air_density) - CREEP,
        "imports": [
            "from uavlab.flight import crash_rate, monte_carlo", "from uavlab.weather import Wind",
            *(["from uavlab.vehicle import LIGHT_QUADROTOR"] if uav == LIGHT_QUADROTOR else []),
        ],
        "python": f"wind = Wind({{wind}}, deviation={{gusts}})\n"
        "for name, route in routes.items():\n    if route.reached:\n"
        f"        print(name, crash_rate(monte_carlo(route, city, {known}, wind, rng=0, flights={count})))",
    }  # fmt: skip
