"""What a live scene offers: planners, the settings that they have, and how a reader would call them in Python."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from uavlab import checks
from uavlab.city import City
from uavlab.planners import (
    astar,
    flight_conditions,
    hazard_astar,
    least_risk,
    penalty_zone,
    potential_field,
    repare,
    theta_star,
)
from uavlab.planners.grid import HEURISTICS
from uavlab.planners.hazard import CRASH_PRICE, DIAMETER
from uavlab.planners.repare import PENALTY
from uavlab.risk import RiskMap
from uavlab.route import Route
from uavlab.vehicle import LIGHT_QUADROTOR

Settings = dict[str, float]


class Slider(NamedTuple):
    """A number that a reader chooses."""

    label: str
    unit: str
    least: float
    most: float
    step: float
    value: float
    plans: bool = True
    """Whether routes depend on it."""


CONDITIONS = [("light", "mild"), ("light", "moderate"), ("light", "heavy"), ("moderate", "mild"), ("heavy", "mild")]
"""Load and disturbance of REPARE that a reader can choose from; none of them is grounded."""

SLIDERS = {
    "keep": Slider("Distance to keep", " m", 0.0, 8.0, 0.5, 2.0),
    "omega": Slider("Price of the zone ω", "", 0.1, 3.0, 0.1, 1.0),
    "sigma": Slider("σ of the offset", " m", 0.1, 2.5, 0.1, 0.8),
    "reach": Slider("Range of push R", " m", 1.0, 12.0, 0.5, 5.0),
    "conditions": Slider("Planned for: load, disturbance", "", 0, len(CONDITIONS) - 1, 1, 0),
    "wind": Slider("Mean wind", " m/s", 0.0, 14.0, 0.5, 6.0, plans=False),
    "towards": Slider("It blows towards", "°", 0, 355, 5, 90, plans=False),
    "gusts": Slider("σ of gusts", " m/s", 0.0, 4.0, 0.25, 1.5, plans=False),
}


class Offer(NamedTuple):
    """A planner that a page has."""

    kind: str
    """By which of `planners.wasm` it is planned, see SOLVERS in `player/live.js`."""
    needs: tuple[str, ...]
    """Settings that it has."""
    plan: Callable[..., Route]
    """The same in Python, of (city or risk map, start, goal, settings)."""
    python: tuple[str, ...]
    """The call as text, with settings in braces; the second for a distance to keep of 0."""
    imports: str
    more: Mapping[str, Any] = MappingProxyType({})
    """What else the page has to know."""


def straight(heuristic: str) -> Offer:
    """A* with an estimate."""
    named = "" if heuristic == "octile" else f', heuristic="{heuristic}"'

    def plan(city: City, start: np.ndarray, goal: np.ndarray, now: Settings) -> Route:
        return astar(city, start, goal, heuristic=heuristic, min_clearance=now["keep"])

    call = "astar(city, {start}, {goal}" + named
    return Offer(
        "astar", ("keep",), plan, (call + ", min_clearance={keep})", call + ")"),
        "from uavlab.planners import astar", {"heuristic": HEURISTICS[heuristic]},
    )  # fmt: skip


def in_zone(city: City, start: np.ndarray, goal: np.ndarray, now: Settings) -> Route:
    price = penalty_zone(city, now["keep"], penalty=now["omega"]) if now["keep"] > 0 else None
    return astar(city, start, goal, price=price)


def by_risk(risk_weight: float = 1.0, length_weight: float = 0.0) -> Callable[..., Route]:
    def plan(risk: RiskMap, start: np.ndarray, goal: np.ndarray, now: Settings) -> Route:
        return least_risk(risk, start, goal, risk_weight=risk_weight, length_weight=length_weight)

    return plan


OFFERS: dict[str, Offer] = {
    "A*": straight("octile"),
    "A*, straight estimate": straight("euclidean"),
    "Dijkstra": straight("zero"),
    "A* in a penalty zone": Offer(
        "zone", ("keep", "omega"), in_zone,
        (
            "astar(city, {start}, {goal}, price=penalty_zone(city, {keep}, penalty={omega}))",
            "astar(city, {start}, {goal})",
        ),
        "from uavlab.planners import astar, penalty_zone",
    ),
    "Theta*": Offer(
        "theta", ("keep",), lambda city, start, goal, now: theta_star(city, start, goal, min_clearance=now["keep"]),
        ("theta_star(city, {start}, {goal}, min_clearance={keep})", "theta_star(city, {start}, {goal})"),
        "from uavlab.planners import theta_star",
    ),
    "hazard A*": Offer(
        "hazard", ("sigma",), lambda city, start, goal, now: hazard_astar(city, start, goal, sigma=now["sigma"]),
        ("hazard_astar(city, {start}, {goal}, sigma={sigma})",), "from uavlab.planners import hazard_astar",
        {"radius": DIAMETER / 2, "price": CRASH_PRICE * 1.0 / 5.0},
    ),
    "REPARE": Offer(
        "repare", ("conditions",),
        lambda city, start, goal, now: repare(
            city, start, goal, load=CONDITIONS[int(now["conditions"])][0],
            disturbance=CONDITIONS[int(now["conditions"])][1],
        ),
        ("repare(city, {start}, {goal}, {conditions})",), "from uavlab.planners import repare",
        {"radius": LIGHT_QUADROTOR.diameter / 2},
    ),
    "potential field": Offer(
        "field", ("reach",), lambda city, start, goal, now: potential_field(city, start, goal, reach=now["reach"]),
        ("potential_field(city, {start}, {goal}, reach={reach})",), "from uavlab.planners import potential_field",
        {"push": 5.0},
    ),
    "least risk": Offer(
        "risk", (), by_risk(), ("least_risk(risk, {start}, {goal})",), "from uavlab.planners import least_risk",
        {"price": "least"},
    ),
    "shortest": Offer(
        "risk", (), by_risk(risk_weight=0.0, length_weight=1.0),
        ("least_risk(risk, {start}, {goal}, risk_weight=0.0, length_weight=1.0)",),
        "from uavlab.planners import least_risk", {"price": "length"},
    ),
}  # fmt: skip
"""By the name that the reader sees."""


def conditions_told() -> list[dict[str, Any]]:
    """REPARE's conditions as the page has them."""
    told = []
    for load, disturbance in CONDITIONS:
        now = flight_conditions(load, disturbance)
        told.append(
            {
                "label": f"{load} load, {disturbance} disturbance",
                "python": f'load="{load}", disturbance="{disturbance}"',
                "distance": now.safe_distance, "penalty": PENALTY, "blown": now.push, "loaded": now.load_ratio,
            }
        )  # fmt: skip
    return told


def checked_offers(argument: str, names: Sequence[str], risk: RiskMap | None) -> list[str]:
    """Names of planners that a page has; those that plan by risk need a risk map, the others none."""
    if isinstance(names, str) or not isinstance(names, Sequence) or len(names) == 0:
        raise ValueError(f"{argument} must be a list of names, such as ['A*', 'REPARE'], got {names!r:.60}")
    for number, name in enumerate(names):
        checks.one_of(argument, name, list(OFFERS))
        if name in names[:number]:
            raise ValueError(f"{argument}: {name!r} stands there twice")
        if (OFFERS[name].kind == "risk") != (risk is not None):
            needed = "needs risk=..., a risk map" if risk is None else "doesn't know of people: leave risk=... out"
            raise ValueError(f"{argument}: {name!r} {needed}")
    return list(names)


def settings_of(names: Sequence[str], flown: bool, asked: Mapping[str, float] | None) -> Settings:
    """The settings that these planners have, as they are at first."""
    needed = {need for name in names for need in OFFERS[name].needs}
    needed |= {"wind", "towards", "gusts"} if flown else set()
    settings = {name: slider.value for name, slider in SLIDERS.items() if name in needed}
    if asked is None:
        return settings
    if not isinstance(asked, Mapping):
        raise ValueError(f"settings must be numbers by name, such as {{'keep': 3.0}}, got {asked!r:.60}")
    for name, value in asked.items():
        if name not in settings:
            raise ValueError(f"settings: {name!r:.40} is none of those that this scene has: {', '.join(settings)}")
        least, most, unit = SLIDERS[name].least, SLIDERS[name].most, SLIDERS[name].unit.strip()
        settings[name] = checks.number(f"settings[{name!r}]", value, checks.within, least, most, unit)
    return settings


def sliders_told(now: Settings) -> list[dict[str, Any]]:
    """Settings as the page has them."""
    told = []
    for name, value in now.items():
        slider = SLIDERS[name]
        ends = {"least": slider.least, "most": slider.most, "unit": slider.unit, "plans": slider.plans}
        told.append({"name": name, "value": value, **ends})
    return told
