"""Exercises of chapter 8, risk maps: the speed of a fall, the chance that a blow kills, the deaths that a route costs.

A mistake is recognised by what it answers; its hint says why that can't be.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np

from uavlab.exercises.hints import each_alike, recognised
from uavlab.exercises.kinds import asks_for, number

GRAVITY = 9.81
FALLS = [
    (0.0, 1.38, 0.3 * 0.0188, 1.225),
    (0.5, 1.38, 0.3 * 0.0188, 1.225),
    (30.0, 1.38, 0.3 * 0.0188, 1.225),
    (30.0, 1.38, 0.06, 1.225),
    (120.0, 2.5, 0.04, 0.9),
]
"""Height, mass, drag area, air density."""

EVEN_ODDS_ENERGY, LEAST_FATAL_ENERGY = 1e6, 34.0
BLOWS = [(energy, shelter) for energy in (5.0, 34.0, 100.0, 555.0, 1e4, 1e6) for shelter in (0.25, 0.5, 0.75, 1.0)]
IN_THE_OPEN = [(5.0, 0.0), (33.0, 0.0), (35.0, 0.0), (555.0, 0.0), (1e7, 0.0)]


def same(given: Sequence[Any], right: Sequence[float], relative: float = 1e-9) -> bool:
    return each_alike(map(float, given), right, partial(math.isclose, rel_tol=relative, abs_tol=1e-15))


@asks_for(number("the speed [m/s]"))
def exercise_1(answer: Callable[[float, float, float, float], float]) -> str:
    """08.1: vertical speed after a fall from rest with drag."""
    given = [answer(*fall) for fall in FALLS]
    same_speeds = partial(same, relative=1e-3)  # g = 9.8 m/s² is right too
    if same_speeds(given, [speed_after(*fall) for fall in FALLS]):
        return ""
    if hint := recognised(given, FALL_MISTAKES, FALLS, same_speeds):
        return hint
    if any(not np.isfinite(speed) for speed in given):
        return "Some speeds are no finite number. What is under the root, and can it be negative?"
    return (
        f"After 30 m with 1.38 kg, 0.00564 m² and 1.225 kg/m³ you get {given[2]:.2f} m/s. Two tests: for a short fall "
        "V² must go to 2 g h, and for a long one m g = ½ · drag area · air density · V²."
    )


def speed_after(
    height: float, mass: float, drag_area: float, air_density: float, factor: float = 2.0, power: float = 0.5
) -> float:
    """The right speed; with other factors in the exponent, or another power, some of the wrong ones."""
    terminal = 2 * mass * GRAVITY / (drag_area * air_density)
    return float((terminal * -math.expm1(-factor * GRAVITY * height / terminal)) ** power)


def speed_without_density(height: float, mass: float, drag_area: float, air_density: float) -> float:
    """As in RISK-ACO, but with the right factor: the density is lost."""
    return speed_after(height, mass, drag_area, 1.0)


def speed_in_time(height: float, mass: float, drag_area: float, air_density: float) -> float:
    """V∞ tanh(g t / V∞), right at a time, with the time of a fall without air."""
    terminal = math.sqrt(2 * mass * GRAVITY / (drag_area * air_density))
    return terminal * math.tanh(math.sqrt(2 * GRAVITY * height) / terminal)


FALL_MISTAKES: list[tuple[Callable[[float, float, float, float], float], str]] = [
    (
        lambda height, mass, drag_area, air_density: speed_after(height, mass, drag_area, air_density, factor=1.0),
        "That is the formula as it is printed. Drop the wreck by a few centimetres: does its V² go to 2 g h?",
    ),
    (
        lambda height, mass, drag_area, air_density: speed_after(height, mass, drag_area, 1.0, factor=1.0),
        "That is RISK-ACO's formula as printed. Give your result a unit: what has been lost? And after a few "
        "centimetres, does V² go to 2 g h?",
    ),
    (
        lambda height, mass, drag_area, air_density: speed_after(height, mass, drag_area, air_density, factor=4.0),
        "After a few centimetres your V² is 4 g h: more energy than gravity has given.",
    ),
    (
        lambda height, mass, drag_area, air_density: math.sqrt(2 * GRAVITY * height),
        "That is a fall without air. How much of the energy does the drag take away on the next metre?",
    ),
    (
        lambda height, mass, drag_area, air_density: math.sqrt(2 * mass * GRAVITY / (drag_area * air_density)),
        "That is the terminal speed, which a very long fall leads to. How near to it is the wreck after `height`?",
    ),
    (
        lambda height, mass, drag_area, air_density: speed_in_time(height, mass, drag_area, air_density),
        "That is the speed after the time that a fall without air takes. Does the wreck need the same time for it?",
    ),
    (
        lambda height, mass, drag_area, air_density: speed_after(height, mass, drag_area, air_density, power=1.0),
        "That is the square of the speed: energy obeys the simple equation, and the question is for the speed.",
    ),
    (
        speed_without_density,
        "In half the air the wreck must fall faster, and yours doesn't care: where is the density?",
    ),
]


@asks_for(number("a chance, from 0 to 1"))
def exercise_2(answer: Callable[[float, float], float]) -> str:
    """08.2: the chance that a blow kills, in the open too."""
    given = [answer(*blow) for blow in BLOWS]
    if not same(given, [chance_to_die(*blow) for blow in BLOWS]):
        return recognised(given, FATALITY_MISTAKES, BLOWS, same) or (
            f"Behind shelter 0.5 a blow of 555 J kills with {answer(555.0, 0.5):.4f}, you say. Two tests: 10⁶ J must "
            "kill one in two there, and at 34 J the shelter must make no difference."
        )
    try:
        limits = [answer(*blow) for blow in IN_THE_OPEN]
    except ZeroDivisionError:
        return (
            "With shelter it is right. In the open it divides by zero: what does the power go to when the shelter goes "
            "to 0, for energies below β and above it?"
        )
    except OverflowError:
        return "With shelter it is right. In the open the power grows without bound: what does the chance go to then?"
    if same(limits, [0, 0, 1, 1, 1]):
        return ""
    if same(limits, [1, 1, 1, 1, 1]):
        return "With shelter it is right. In the open you let every blow kill, one of 5 J too. What does β mean?"
    if same(limits, [1, 1, 0, 0, 0]):
        return "With shelter it is right. In the open it is the wrong way round: more energy can't kill less."
    return (
        f"With shelter it is right. In the open you have {limits[1]:.3g} for 33 J and {limits[2]:.3g} for 35 J. Let "
        "the shelter go to 0: what remains of a number below 1 to a power without bound, and of one above 1?"
    )


def chance_to_die(energy: float, shelter: float) -> float:
    root = math.sqrt(EVEN_ODDS_ENERGY / LEAST_FATAL_ENERGY)
    return 1 / (1 + root * (LEAST_FATAL_ENERGY / energy) ** (1 / (4 * shelter)))


FATALITY_MISTAKES: list[tuple[Callable[[float, float], float], str]] = [
    (
        lambda energy, shelter: 1 / (1 + math.sqrt(1e6 / 34 * (34 / energy) ** (1 / (4 * shelter)))),
        "With your bracket the root covers the power as well, and 10⁶ J kill 7 % behind shelter 0.5. How many should "
        "it be, by the meaning of α?",
    ),
    (
        lambda energy, shelter: 1 / (1 + math.sqrt(1e6 / 34) * (energy / 34) ** (1 / (4 * shelter))),
        "The harder the blow, the fewer you let die: which way up is the fraction of the energies?",
    ),
    (
        lambda energy, shelter: 1 / (1 + 1e6 / 34 * (34 / energy) ** (1 / (4 * shelter))),
        "There is a root over α/β. Without it 10⁶ J kill hardly anybody behind shelter 0.5.",
    ),
    (
        lambda energy, shelter: 1 / (1 + math.sqrt(34 / 1e6) * (34 / energy) ** (1 / (4 * shelter))),
        "Behind shelter 0.5 your blow of 34 J kills 99 %: which of α and β is the larger, and which stands above?",
    ),
    (
        lambda energy, shelter: 1 / (1 + math.sqrt(1e6 / 34) * (34 / energy) ** (shelter / 4)),
        "With more energy than β a better shelter must protect better, and yours does the opposite: mind the brackets "
        "in the exponent.",
    ),
    (
        lambda energy, shelter: chance_to_die(energy, 1.0),
        "Your chance is the same behind every shelter.",
    ),
]


@asks_for(number("the expected deaths"))
def exercise_3(answer: Callable[[np.ndarray, np.ndarray, float, float], float]) -> str:
    """08.3: expected deaths on a route over a risk map."""
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
        "How fast the UAV flies makes no difference for you. Who is longer above a crowd?",
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
