"""Campuses to plan over: the reference campus, tuned to come near RISK-ACO Table 5, and random ones in its manner.

150 × 150 × 80 m, cut by roads into sixteen blocks: yards, parks, lawns, squares, industry, most with a building.
Neither paper gives its map, only satellite pictures of two universities. A reference that was tuned shows what is
possible; random campuses show what is usual.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from importlib.resources import files
from typing import Any

import numpy as np

from uavlab import checks
from uavlab.city import Building, City
from uavlab.risk.layers import column_centers, road_layer
from uavlab.risk.model import RiskMap
from uavlab.risk.rates import POPULATION_DENSITY

CAMPUS_FLIGHT = ((12.5, 17.5, 22.5), (112.5, 112.5, 27.5))
"""Start and goal [m] on every campus, free and flyable on all of them."""

SIZE = (150.0, 150.0, 80.0)
ROADS = (37.5, 75.0, 112.5)
ROAD_WIDTH, BELT = 6.0, 3.0
"""Width of the roads, both ways, and of the belt of trees on each side [m]."""

MIN_HEIGHT = 5.0
"""No flight below this height above the ground [m]."""

KINDS = {"yard": (0.25, 0.5), "park": (0.5, 0.5), "lawn": (0.0, 0.9), "square": (0.0, 1.6), "industry": (1.0, 0.6)}
"""Shelter of a block's open ground, and how many times the usual number of people are there."""


def reference_campus(cell: float = 5.0) -> RiskMap:
    """The reference campus: a map on which the papers' claim about risk-aware routes can be met.

    Parameters
    ----------
    cell : float
        Edge of a voxel [m], above 0; the papers' figures are for about 5.

    Returns
    -------
    RiskMap
        30 000 people per km² on average; plan from and to `CAMPUS_FLIGHT`.

    Raises
    ------
    ValueError
        If `cell` is not above 0 and finite, or so small that the map would have over 500 million voxels.

    See Also
    --------
    random_campus : others in its manner.
    uavlab.planners.least_risk : plans over it.

    Examples
    --------
    >>> from uavlab.risk import reference_campus
    >>> campus = reference_campus()
    >>> campus, len(campus.city.buildings), round(float(1e6 * campus.population_density.mean()))
    (<RiskMap of reference campus: 30 × 30 × 16 voxels of 5 m>, 10, 30000)
    """
    data = json.loads(files("uavlab.risk").joinpath("reference_campus.json").read_text(encoding="utf-8"))
    crowds = np.random.default_rng(data["crowd_seed"]).normal(0.0, data["crowd_sigma"], (15, 15))
    return campus(data["zones"], crowds, cell, "reference campus")


def random_campus(rng: np.random.Generator | int, cell: float = 5.0) -> RiskMap:
    """A campus drawn at random in the manner of the reference: the same roads, other blocks, buildings and crowds.

    Parameters
    ----------
    rng : numpy.random.Generator or int
        Or a seed for one, by which the campus is then named.
    cell : float
        Edge of a voxel [m], above 0.

    Returns
    -------
    RiskMap
        30 000 people per km² on average; plan from and to `CAMPUS_FLIGHT`.

    Raises
    ------
    ValueError
        If `rng` is neither generator nor seed, or `cell` is not above 0 and finite, or so small that the map would have
        over 500 million voxels.

    See Also
    --------
    reference_campus : the one that was tuned.
    uavlab.planners.compare_planners : compares planners over several campuses.

    Examples
    --------
    >>> from uavlab.risk import CAMPUS_FLIGHT, random_campus
    >>> campus = random_campus(1)
    >>> campus
    <RiskMap of random campus 1: 30 × 30 × 16 voxels of 5 m>
    >>> bool(campus.city.is_free(CAMPUS_FLIGHT).all()), bool((random_campus(1).rate == campus.rate).all())
    (True, True)
    """
    name = f"random campus {rng}" if isinstance(rng, int | np.integer) else "random campus"
    rng = checks.generator("rng", rng)
    zones = [zone((0, 150), (0, 150), *KINDS["yard"], "ground")]
    for west in (0.0, *ROADS):
        for south in (0.0, *ROADS):
            kind = str(rng.choice(list(KINDS), p=(0.45, 0.25, 0.1, 0.1, 0.1)))
            zones.append(zone((west, west + 37.5), (south, south + 37.5), *KINDS[kind], kind))
            if rng.random() < {"yard": 0.8, "park": 0.4, "industry": 0.8}.get(kind, 0.0):
                zones.append(random_building(west, south, kind, rng))
            elif rng.random() < 0.5:
                x, y = place(west, south, rng)
                zones.append(zone(x, y, 0.0, rng.uniform(1.2, 1.7), "sport"))
    return campus(zones, rng.normal(0.0, 0.25, (15, 15)), cell, name)


def zone(x: Sequence[float], y: Sequence[float], shelter: float, people: float, kind: str, height: float = 0.0) -> dict:
    """A rectangle of the ground plan, as in reference_campus.json."""
    return {
        "x": x, "y": y, "height_m": height, "shelter": shelter, "population_multiplier": people, "kind": kind
    }  # fmt: skip


def place(west: float, south: float, rng: np.random.Generator) -> tuple[Sequence[float], Sequence[float]]:
    """A rectangle of 12 to 22 m within a block, off its roads and off the start of `CAMPUS_FLIGHT`."""
    while True:
        width, depth = rng.uniform(12.0, 22.0, size=2)
        x, y = west + rng.uniform(6.5, 31.0 - width), south + rng.uniform(6.5, 31.0 - depth)
        apart = [max(low - at, at - high, 0.0) for low, high, at in
                 ((x, x + width, CAMPUS_FLIGHT[0][0]), (y, y + depth, CAMPUS_FLIGHT[0][1]))]  # fmt: skip
        if max(apart) > 2.5:
            return (x, x + width), (y, y + depth)


def random_building(west: float, south: float, block: str, rng: np.random.Generator) -> dict[str, Any]:
    """A building in a block: low sheds on industrial ground, else 15 to 60 m, higher ones rarer."""
    x, y = place(west, south, rng)
    if block == "industry":
        return zone(x, y, *KINDS["industry"], "industry", rng.uniform(8.0, 14.0))
    height = 15.0 + min(rng.exponential(14.0), 45.0)
    return zone(x, y, 0.75 if height > 20 else 0.5, 1.6, "building", height)


def campus(zones: Sequence[dict[str, Any]], crowds: np.ndarray, cell: float, name: str) -> RiskMap:
    """Zones, roads and crowds as a risk map; later zones overwrite earlier ones, roads overwrite all but buildings.

    `crowds` (15, 15) are logarithms of how many times more people than usual are on squares of 10 m.
    """
    checks.positive_number("cell", cell)
    buildings = [
        Building.prism(
            [(z["x"][0], z["y"][0]), (z["x"][1], z["y"][0]), (z["x"][1], z["y"][1]), (z["x"][0], z["y"][1])],
            z["height_m"],
            name=f"{z['kind']} {number}",
        )
        for number, z in enumerate((z for z in zones if z["height_m"] > 0), 1)
    ]
    city = City.from_buildings(buildings, cell=cell, origin=(0, 0, 0), size=SIZE, name=name)
    at = np.minimum(column_centers(city), np.nextafter(SIZE[0], 0))  # the last column may stick out of the campus
    x, y = at[..., 0], at[..., 1]
    shelter, people, built = np.zeros(x.shape), np.zeros(x.shape), np.zeros(x.shape, dtype=bool)
    for z in zones:
        here = (x >= z["x"][0]) & (x < z["x"][1]) & (y >= z["y"][0]) & (y < z["y"][1])
        shelter[here], people[here], built[here] = z["shelter"], z["population_multiplier"], z["height_m"] > 0
    to_road = np.min([np.minimum(abs(x - road), abs(y - road)) for road in ROADS], axis=0)
    belt = ~built & (to_road < ROAD_WIDTH / 2 + BELT)
    road = ~built & (to_road < ROAD_WIDTH / 2)
    shelter[belt], people[belt] = 0.5, 0.5
    shelter[road], people[road] = 0.0, 0.1
    square = np.minimum(at // 10, 14).astype(int)
    people *= np.exp(crowds[square[..., 0], square[..., 1]])
    lines = [[(0, road), (SIZE[1], road)] for road in ROADS] + [[(road, 0), (road, SIZE[0])] for road in ROADS]
    return RiskMap(
        city,
        people * POPULATION_DENSITY / people.mean(),
        shelter,
        np.where(built, 0.0, road_layer(city, lines, ROAD_WIDTH)),
        min_height=MIN_HEIGHT,
    )
