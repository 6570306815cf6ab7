"""Where no route keeps the limits: which of them to loosen, and how far."""

from __future__ import annotations

from bisect import bisect_left
from functools import partial

import numpy as np

from uavlab.city import City
from uavlab.planners.risk_question import Limits, Query, city_lengths, query_of
from uavlab.planners.risk_search import solve
from uavlab.risk import RiskMap


def what_binds(risk_map: RiskMap, query: Query, limits: Limits, max_length: float | None) -> str:
    """Words for what would open a route: each limit that does it alone, and how far to loosen it; else several."""
    price = city_lengths(query).price
    any_length = np.finfo(float).max
    most = any_length if max_length is None else max_length

    def shortest(kept: Limits) -> float:
        """Length of the shortest route that keeps other limits [m]."""
        return solve(query_of(risk_map, price, query.source, query.target, kept), True)[1] * risk_map.city.cell

    def opens(kept: Limits, name: str, value: float) -> bool:
        return shortest(kept._replace(**{name: value})) <= most

    length = shortest(limits)
    if np.isfinite(length):
        return f"max_length is {max_length:g} m, the shortest route has {up(length):.2f} m"
    looser = looser_values(risk_map, limits)
    cures = []
    for name, values in looser.items():
        first = bisect_left(values, True, key=partial(opens, limits, name))
        cures += [setting(name, value) for value in values[first : first + 1]]
    if cures:
        return "there would be one with " + ", or with ".join(cures)
    together = limits._replace(**{name: values[-1] for name, values in looser.items() if values})
    if shortest(together) == np.inf:
        return "obstacles close every way"
    if shortest(together) > most:
        most = any_length
    for name in reversed(looser):
        values = [getattr(limits, name), *looser[name]]
        first = bisect_left(values, True, key=partial(opens, together, name))
        together = together._replace(**{name: values[first]})
    cures = [setting(*item) for item in together._asdict().items() if item not in limits._asdict().items()]
    if max_length is not None and most == any_length:
        cures.append(f"max_length={up(shortest(together)):.2f} m")
    return "there would be one with " + " and ".join(cures)


def looser_values(risk_map: RiskMap, limits: Limits) -> dict[str, list[float]]:
    """For each limit the looser values that make a difference, the loosest last; lengths in whole centimetres."""
    city = risk_map.city

    def above(limit: float, degrees: tuple[float, ...]) -> list[float]:
        return [angle for angle in np.radians(degrees).tolist() if angle > limit + 1e-9]

    def below(limit: float, values: np.ndarray) -> list[float]:
        return np.unique(np.floor(100 * values[values < limit]) / 100)[::-1].tolist()

    return {
        "max_turn": above(limits.max_turn, (45, 90, 135, 180)),
        "max_pitch": above(limits.max_pitch, (35.27, 45, 90)),
        "min_clearance": below(limits.min_clearance, city.clearance),
        "safe_height": below(limits.safe_height, city.height_above_surface),
        "min_height": below(limits.min_height, least_heights(city)),
        "max_height": [np.inf] if limits.max_height < np.inf else [],
        "max_igrc": np.unique(risk_map.igrc[risk_map.igrc > limits.max_igrc]).tolist(),
        "ground_risk_buffer": [0.0] if limits.ground_risk_buffer > 0 and limits.max_igrc < np.inf else [],
    }


def least_heights(city: City) -> np.ndarray:
    """Heights [m] of all centres above the highest ground in their columns, each once, from 0."""
    heights = city.coordinates(2) - city.range_of_ground[1][..., None]
    return np.unique(heights[heights > 0])


def setting(name: str, value: float) -> str:
    """A limit with its value in the unit that people think in."""
    if name in ("max_turn", "max_pitch"):
        return f"{name}={np.degrees(value):g}°"
    return f"{name}={value:g}" + " m" * (name != "max_igrc")


def up(length: float) -> float:
    """A length rounded up to centimetres, so that a route of this length keeps it."""
    return float(np.ceil(100 * length) / 100)
