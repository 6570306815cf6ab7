"""Exercises of chapter 8, risk maps: a parachute, cars, a blow, the deaths of a route, a speed, and two routes.

A mistake is recognised by what it answers; its hint says why that can't be.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cache, partial
from typing import Any

import numpy as np

from uavlab.city import City
from uavlab.exercises.hints import each_alike, recognised, recognised_value
from uavlab.exercises.kinds import Quiz, asks_for, asks_for_value, number, shape_of, thing
from uavlab.risk import RiskMap, person_rate
from uavlab.route import Route

EVEN_ODDS_ENERGY, LEAST_FATAL_ENERGY = 1e6, 34.0
BLOWS = [(energy, shelter) for energy in (5.0, 34.0, 100.0, 555.0, 1e4, 1e6) for shelter in (0.25, 0.5, 0.75, 1.0)]
WITHOUT_SHELTER = [(5.0, 0.0), (33.0, 0.0), (35.0, 0.0), (555.0, 0.0), (1e7, 0.0)]


def same(given: Sequence[Any], right: Sequence[float], relative: float = 1e-9) -> bool:
    return each_alike(map(float, given), right, partial(math.isclose, rel_tol=relative, abs_tol=1e-15))


exercise_1 = Quiz(
    right="b",
    because="In the papers' fall the wreck keeps 16 m/s forward and 177 J; in the full fall the parachute takes both.",
    wrong={
        "a": "The blow is softer in both, that is true. But how much energy is left in the papers' fall: less than "
        "34 J? And how far does the wreck fly between the height of a head and the ground?",
        "c": "For the papers' fall that is right. In the full fall drag acts against the whole velocity. How fast is "
        "the wreck forward when it has sunk for seconds under a parachute?",
        "d": "You have exchanged them. In which of the two falls does the wreck keep its speed forward?",
    },
)

ROADS = [(0.1, 3.0), (20.0, 6.0), (35.0, 7.5), (0.0, 6.0), (80.0, 14.0)]
"""Cars per kilometre of the whole road, and its width [m]."""


@asks_for(number("the deaths per hour of flight"))
def exercise_2(answer: Callable[[float, float], float]) -> str:
    """08.2: deaths in cars per hour of flight over a road, from the cars of all its lanes."""
    given = [answer(*road) for road in ROADS]
    if same(given, [deaths_on_road(*road) for road in ROADS], 1e-6):
        return ""
    return recognised(given, ROAD_MISTAKES, ROADS, partial(same, relative=1e-6)) or (
        "Take a square kilometre of road with 1000 cars of 8.4 m² on it: cars cover 0.84 % of it. So each failure "
        "above it costs 0.0252 lives. For 20 cars per km on a road of 6 m you get "
        f"{float(given[1]):.3g} deaths per hour."
    )


def deaths_on_road(cars_per_km: float, width: float) -> float:
    return 6.4e-5 * 3 * 8.4 * cars_per_km / 1000 / width


ROAD_MISTAKES: list[tuple[Callable[[float, float], float], str]] = [
    (
        lambda cars, width: deaths_on_road(cars, 3.0),
        "You divide by one lane, but the cars were counted on all lanes. On what area do they stand?",
    ),
    (
        lambda cars, width: 1000 * deaths_on_road(cars, width),
        "You take cars per kilometre for cars per metre: your cars would stand on top of each other.",
    ),
    (
        lambda cars, width: deaths_on_road(cars, width) / 3,
        "That is how often a car is hit. How many people die in each?",
    ),
    (
        lambda cars, width: deaths_on_road(cars, width) / 6.4e-5,
        "That is the deaths per failure. How often does the UAV fail in an hour of flight?",
    ),
    (
        lambda cars, width: deaths_on_road(cars, width) / 3 / 6.4e-5,
        "That is the share of the road that cars cover. Two factors are missing: how often does the UAV fail, and what "
        "does a hit cost?",
    ),
    (
        lambda cars, width: deaths_on_road(cars, 1 / width),
        "The same cars on a wider road: is it more likely that a wreck hits one of them, or less?",
    ),
    (
        lambda cars, width: deaths_on_road(cars, 3.0) * width / 3.0,
        "You count the cars once more for each lane, but the number is that of all lanes already.",
    ),
]


@asks_for(number("a chance, from 0 to 1"))
def exercise_3(answer: Callable[[float, float], float]) -> str:
    """08.3: the chance that a blow kills, also without shelter."""
    given = [answer(*blow) for blow in BLOWS]
    if not same(given, [chance_to_die(*blow) for blow in BLOWS]):
        return recognised(given, FATALITY_MISTAKES, BLOWS, same) or (
            f"Behind shelter 0.5 a blow of 555 J kills with {answer(555.0, 0.5):.4f}, you say. Two tests: 10⁶ J must "
            "kill one in two there, and at 34 J the shelter must make no difference."
        )
    try:
        limits = [answer(*blow) for blow in WITHOUT_SHELTER]
    except ZeroDivisionError:
        return (
            "With shelter it is right. Without shelter it divides by zero: what does the power go to when the shelter "
            "goes to 0, for energies below E_β and above it?"
        )
    except OverflowError:
        return "With shelter it is right. Without it the power grows without bound: what does the chance go to then?"
    if same(limits, [0, 0, 1, 1, 1]):
        return ""
    if same(limits, [1, 1, 1, 1, 1]):
        return "With shelter it is right. Without it you let every blow kill, one of 5 J too. What does E_β mean?"
    if same(limits, [1, 1, 0, 0, 0]):
        return "With shelter it is right. Without it it is the wrong way round: more energy can't kill less."
    return (
        f"With shelter it is right. Without it you have {limits[1]:.3g} for 33 J and {limits[2]:.3g} for 35 J. Let "
        "the shelter go to 0: what remains of a number below 1 to a power without bound, and of one above 1?"
    )


def chance_to_die(energy: float, shelter: float) -> float:
    root = math.sqrt(EVEN_ODDS_ENERGY / LEAST_FATAL_ENERGY)
    return 1 / (1 + root * (LEAST_FATAL_ENERGY / energy) ** (1 / (4 * shelter)))


FATALITY_MISTAKES: list[tuple[Callable[[float, float], float], str]] = [
    (
        lambda energy, shelter: 1 / (1 + math.sqrt(1e6 / 34 * (34 / energy) ** (1 / (4 * shelter)))),
        "With your bracket the root covers the power as well, and 10⁶ J kill 7 % behind shelter 0.5. How many should "
        "it be, by the meaning of E_α?",
    ),
    (
        lambda energy, shelter: 1 / (1 + math.sqrt(1e6 / 34) * (energy / 34) ** (1 / (4 * shelter))),
        "The harder the blow, the fewer you let die: which way up is the fraction of the energies?",
    ),
    (
        lambda energy, shelter: 1 / (1 + 1e6 / 34 * (34 / energy) ** (1 / (4 * shelter))),
        "There is a root over E_α/E_β. Without it 10⁶ J kill hardly anybody behind shelter 0.5.",
    ),
    (
        lambda energy, shelter: 1 / (1 + math.sqrt(34 / 1e6) * (34 / energy) ** (1 / (4 * shelter))),
        "Behind shelter 0.5 your blow of 34 J kills 99 %: which of E_α and E_β is the larger, and which stands above?",
    ),
    (
        lambda energy, shelter: 1 / (1 + math.sqrt(1e6 / 34) * (34 / energy) ** (shelter / 4)),
        "With more energy than E_β a better shelter must protect better, and yours does the opposite: mind the "
        "brackets in the exponent.",
    ),
    (
        lambda energy, shelter: chance_to_die(energy, 1.0),
        "Your chance is the same behind every shelter.",
    ),
]


@asks_for(number("the expected deaths"))
def exercise_4(answer: Callable[[np.ndarray, np.ndarray, float, float], float]) -> str:
    """08.4: expected deaths on a route over a risk map."""
    missions = [random_mission(seed) for seed in range(6)]
    given = [answer(*mission) for mission in missions]
    if same(given, [expected_deaths(*mission) for mission in missions], relative=1e-6):
        return ""
    if hint := recognised(given, ROUTE_MISTAKES, missions, same):
        return hint
    level = np.full((3, 1, 1), 3.6)
    straight = np.array([(0, 0, 0), (1, 0, 0), (2, 0, 0)])
    cost = float(answer(level, straight, 5.0, 10.0))
    if math.isclose(cost, 0.001, rel_tol=1e-6):
        return (
            "Where the rate is the same everywhere, two straight moves are right. How long is a move over an edge, or "
            "through a corner? And with which rates is each move flown?"
        )
    return (
        "Take a map with 3.6 deaths per hour everywhere, and two moves of 5 m at 10 m/s: one second. That makes 0.001, "
        f"and you get {cost:.4g}."
    )


def expected_deaths(rate: np.ndarray, voxels: np.ndarray, cell: float, speed: float) -> float:
    return route_integral(rate, voxels, 0.5) * cell / (3600 * speed)


def route_integral(rate: np.ndarray, voxels: np.ndarray, begin: float) -> float:
    """∫ r ds [cells/h] with this share of each leg at the rate where it begins, the rest at that where it ends."""
    lengths = np.linalg.norm(np.diff(voxels, axis=0), axis=1)
    along = rate[tuple(voxels.T)]
    return float(lengths @ (begin * along[:-1] + (1 - begin) * along[1:]))


def random_mission(seed: int) -> tuple[np.ndarray, np.ndarray, float, float]:
    """A map, a route of 20 moves that doesn't visit a voxel twice, a cell and a speed."""
    rng = np.random.default_rng([53, seed])
    moves = np.column_stack([np.ones(20, dtype=int), rng.integers(-1, 2, (20, 2))])
    voxels = np.array([0, 25, 25]) + np.vstack([np.zeros(3, dtype=int), np.cumsum(moves, axis=0)])
    return rng.lognormal(-14.0, 1.5, (25, 50, 50)), voxels, float(rng.uniform(2, 10)), float(rng.uniform(5, 20))


def cells_passed(rate: np.ndarray, voxels: np.ndarray, cell: float, speed: float) -> float:
    """Σ r, as the papers have it."""
    return float(rate[tuple(voxels.T)].sum())


def legs_as_edges(rate: np.ndarray, voxels: np.ndarray, cell: float, speed: float) -> float:
    """All moves as long as a straight one."""
    along = rate[tuple(voxels.T)]
    return float((along[:-1] + along[1:]).sum() / 2) * cell / (3600 * speed)


ROUTE_MISTAKES: list[tuple[Callable[[np.ndarray, np.ndarray, float, float], float], str]] = [
    (
        cells_passed,
        "That is the papers' sum over the voxels: rates per hour, added up. For how long is the UAV in each voxel?",
    ),
    (
        lambda rate, voxels, cell, speed: cells_passed(rate, voxels, cell, speed) * cell / (3600 * speed),
        "You give every voxel the time of one straight move. Diagonals take longer, and the first and the last voxel "
        "are flown through only by half.",
    ),
    (
        legs_as_edges,
        "You count all moves as equally long. How long is one over an edge, or through a corner?",
    ),
    (
        lambda rate, voxels, cell, speed: route_integral(rate, voxels, 0.0) * cell / (3600 * speed),
        "You take the rate of the voxel that a move leads to, for the whole move. In which voxels does it run?",
    ),
    (
        lambda rate, voxels, cell, speed: route_integral(rate, voxels, 1.0) * cell / (3600 * speed),
        "You take the rate of the voxel where a move begins, for the whole move. In which voxels does it run?",
    ),
    (
        lambda rate, voxels, cell, speed: (
            float(rate[tuple(voxels.T)].mean()) * expected_deaths(np.ones(rate.shape), voxels, cell, speed)
        ),
        "You multiply the mean rate by the whole time. Is the UAV in each voxel equally long?",
    ),
    (
        lambda rate, voxels, cell, speed: 2 * expected_deaths(rate, voxels, cell, speed),
        "Twice too much: each move is counted in full in both of its voxels.",
    ),
    (
        lambda rate, voxels, cell, speed: expected_deaths(rate, voxels, cell, speed) * 3600,
        "You are off by the same factor for all routes: the rate is per hour, and metres by metres per second are "
        "seconds.",
    ),
    (
        lambda rate, voxels, cell, speed: expected_deaths(rate, voxels, cell, speed) * 60,
        "You are off by the same factor for all routes: an hour has more than 60 seconds.",
    ),
    (
        lambda rate, voxels, cell, speed: expected_deaths(rate, voxels, cell, speed) / cell,
        "Your lengths are in cells. How long is a move in metres?",
    ),
    (
        lambda rate, voxels, cell, speed: expected_deaths(rate, voxels, cell, speed) * speed,
        "How fast the UAV flies makes no difference for you. Which UAV is for longer above a crowd?",
    ),
    (
        lambda rate, voxels, cell, speed: expected_deaths(rate, voxels, cell, speed) * speed**2,
        "The faster your UAV flies, the more die. How long is it above each place?",
    ),
    (
        lambda rate, voxels, cell, speed: route_integral(rate, voxels, 0.5),
        "That is ∫ r ds in cells, the scale of the papers, and not yet deaths: how many metres is it, and how long "
        "does the UAV take for them?",
    ),
]


BEST_SPEED, NEAR = 13.0, 0.25
"""Where r(v)/v over sparse trees is least, 30 m high [m/s]; the test of the chapter computes it."""


@asks_for_value(number("the speed with the fewest deaths per metre [m/s]"))
def exercise_5(speed: float) -> str:
    """08.5: the speed with the fewest expected deaths per metre flown over sparse trees."""
    value = float(speed)
    if not 0 < value < 100:
        return "A speed from 1 to 40 m/s is asked for."
    if abs(value - BEST_SPEED) <= NEAR:
        return ""
    if hint := recognised_value(value, SPEED_MISTAKES):
        return hint
    deaths, best = (float(person_rate(30.0, shelter=0.25, speed=v)) / v for v in (value, BEST_SPEED))
    why = "over each place for longer than need be" if value < BEST_SPEED else "hitting more people, and harder"
    return f"At {value:g} m/s it is {why}: {deaths / best - 1:.1%} more deaths per metre than at the best speed."


SPEED_MISTAKES: list[tuple[float, float, str]] = [
    (
        1.0,
        1.0,
        "There the deaths per *hour* are fewest. A slow UAV needs more hours for the same way: what is it per metre?",
    ),
    (40.0, 0.5, "That is the upper end of what was asked for. Is it least there? Look at a place with shelter 0.25."),
    (16.0, 0.05, "That is the papers' speed. Nobody chose it for having few deaths: try others."),
    (16.2, 0.15, "That is the best speed of the full fall (`ballistic=True`). Here the papers' fall is asked for."),
    (17.8, 0.25, "That is the best speed behind shelter 0.5. Sparse trees have 0.25."),
]
"""Speed, how near an answer has to be [m/s], and the hint."""

START, GOAL, CLEARLY = (2.5, 2.5, 27.5), (47.5, 47.5, 27.5), 1.2


@cache
def field() -> RiskMap:
    """A map with the same people and shelter everywhere."""
    return RiskMap(City(np.zeros((12, 12, 12), dtype=bool), cell=5.0), np.array(0.03), np.array(0.5))


@asks_for_value(thing(tuple, "a pair of routes, (first, second), each a list of points (x, y, z)"))
def exercise_6(pair: tuple[Any, Any]) -> str:
    """08.6: two routes of which the papers' sum prefers the one that causes more deaths."""
    if len(pair) != 2:
        return f"Your tuple has {len(pair)} parts. There are two: (first, second)."
    for name, points in zip(("first", "second"), pair, strict=True):
        if hint := wrong_points(name, points):
            return hint
    first, second = (Route(np.asarray(points, dtype=float)) for points in pair)
    sums = field().cell_sum(first) / field().cell_sum(second)
    deaths = field().fatalities(first) / field().fatalities(second)
    if sums <= 1 / CLEARLY + 1e-9 and deaths >= CLEARLY - 1e-9:
        return ""
    if sums >= CLEARLY and deaths <= 1 / CLEARLY:
        return "That is such a pair, but the other way round: the first is to have the smaller sum and more deaths."
    if abs(sums - 1) < 1e-6 and abs(deaths - 1) < 1e-6:
        return "For the sum and for the deaths your routes are the same. Make one of them long, but through few voxels."
    if sums < 1 < deaths:
        return (
            f"The sum prefers the wrong one, but not clearly: the first has {sums:.2f} times the sum and {deaths:.2f} "
            "times the deaths of the second. It is to be at most 1/1.2 and at least 1.2."
        )
    if deaths > 1:
        return (
            f"The first causes more deaths ({deaths:.2f} times), but its sum is larger, too ({sums:.2f} times). How "
            "can a long way pass few voxels, and a short one many?"
        )
    return (
        f"The first has {sums:.2f} times the sum of the second and {deaths:.2f} times its deaths: where it has fewer "
        "deaths, the sum is no trap. On this map deaths go with the length. Which moves are long within one voxel?"
    )


def wrong_points(name: str, points: Any) -> str:
    """What is wrong with a list of points, if anything."""
    shape = shape_of(points)
    if shape is None or len(shape) != 2 or shape[0] < 2 or shape[1] != 3:
        return f"The {name} route is no list of at least two points (x, y, z)."
    way = np.asarray(points, dtype=float)
    if not np.isfinite(way).all():
        return f"The {name} route has a point that is no number."
    if not (np.allclose(way[0], START) and np.allclose(way[-1], GOAL)):
        return f"The {name} route has to lead from {START} to {GOAL}."
    if (way < 0).any() or (way >= 60.0).any() or (way[:, 2] < 3.0).any():
        return f"The {name} route leaves the map, which is 60 m wide and high, or flies lower than 3 m."
    return ""
