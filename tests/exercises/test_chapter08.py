"""Exercises of chapter 08: other ways to the answer pass; typical mistakes fail, each with a hint of its own."""

import math

import numpy as np
import pytest

from uavlab import exercises, risk
from uavlab.exercises import chapter08


def by_lanes(cars_per_km, width):
    """The cars of a road, shared out among lanes of 3 m."""
    lanes = width / 3.0
    return float(risk.vehicle_rate(risk.vehicle_share(cars_per_km / lanes)))


def fatality_by_odds(energy, shelter):
    return float(risk.impact_fatality(energy, shelter))


def deaths_by_voxel(rate, voxels, cell, speed):
    """Each voxel with half of the move that leads into it and half of the one that leads out."""
    seconds = np.linalg.norm(np.diff(voxels, axis=0), axis=1) * cell / speed
    stay = (np.append(0, seconds) + np.append(seconds, 0)) / 2
    return sum(rate[tuple(voxel)] * time / 3600 for voxel, time in zip(voxels, stay, strict=True))


@pytest.mark.parametrize(
    ("number", "answer"), [("08.2", by_lanes), ("08.3", fatality_by_odds), ("08.4", deaths_by_voxel)]
)
def test_another_way_to_the_answer_is_right(number, answer):
    verdict = exercises.check(number, answer)
    assert verdict, verdict


def on_road(cars, width, factor=1.0):
    return factor * 6.4e-5 * 3 * 8.4 * cars / 1000 / width


def chance(energy, shelter, ratio=1e6 / 34):
    return 1 / (1 + math.sqrt(ratio) * (34 / energy) ** (1 / (4 * shelter)))


def chance_under_one_root(energy, shelter):
    return 1 / (1 + math.sqrt(1e6 / 34 * (34 / energy) ** (1 / (4 * shelter))))


def without_shelter(value):
    """Right with shelter, this below 34 J and above it without."""
    return lambda energy, shelter: chance(energy, shelter) if shelter > 0 else value(energy)


def mean_rate_times_time(rate, voxels, cell, speed):
    length = cell * np.linalg.norm(np.diff(voxels, axis=0), axis=1).sum()
    return rate[tuple(voxels.T)].mean() * length / (3600 * speed)


def cost(rate, voxels, cell, speed, begin=0.5, straight=False, diagonals=1.0):
    """Deaths, with this share of each leg at the rate where it begins."""
    lengths = np.linalg.norm(np.diff(voxels, axis=0), axis=1)
    lengths[lengths > 1] *= diagonals
    along = rate[tuple(voxels.T)]
    legs = begin * along[:-1] + (1 - begin) * along[1:]
    return float(legs @ (np.ones_like(lengths) if straight else lengths)) * cell / (3600 * speed)


START, GOAL = (2.5, 2.5, 27.5), (47.5, 47.5, 27.5)
STRAIGHT = [START, GOAL]
BENT = [START, (25.2, 24.8, 27.5), GOAL]
CORNER = [START, (47.5, 2.5, 27.5), GOAL]
ZIGZAG = [*((2.5 + 5 * n, 2.5 + 5 * n, 27.5 + 5 * (n % 2)) for n in range(9)), GOAL]
HALF_ZIGZAG = [*ZIGZAG[:5], GOAL]
CIRCLES = [START, *[(1.0, 1.0, 27.5), (4.0, 4.0, 27.5)] * 10, START, GOAL]

MISTAKES = {
    "08.2": {
        "by one lane": lambda cars, width: on_road(cars, 3.0),
        "on top of each other": lambda cars, width: on_road(cars, width, 1000),
        "how often a car is hit": lambda cars, width: on_road(cars, width, 1 / 3),
        "deaths per failure": lambda cars, width: on_road(cars, width, 1 / 6.4e-5),
        "Two factors are missing": lambda cars, width: 8.4 * cars / 1000 / width,
        "more likely that a wreck hits": lambda cars, width: on_road(cars, 1 / width),
        "once more for each lane": lambda cars, width: on_road(cars, 3.0, width / 3),
        "you get 0.5 deaths": lambda cars, width: 0.5,
        "The answer is one number": lambda cars, width: np.ones(3),
    },
    "08.3": {
        "the root covers the power": chance_under_one_root,
        "which way up": lambda e, s: 1 / (1 + math.sqrt(1e6 / 34) * (e / 34) ** (1 / (4 * s))),
        "a root over E_α/E_β": lambda e, s: chance(e, s, (1e6 / 34) ** 2),
        "which stands above": lambda e, s: chance(e, s, 34 / 1e6),
        "mind the brackets": lambda e, s: 1 / (1 + math.sqrt(1e6 / 34) * (34 / e) ** (1 / 4 * s)),
        "the same behind every shelter": lambda e, s: chance(e, 1.0),
        "you say": lambda e, s: 0.5,
        "divides by zero": chance,
        "the power grows without bound": lambda e, s: chance(e, max(s, 1e-6)),
        ", 0.0) your function returns nothing": without_shelter(lambda energy: None),
        "let every blow kill": without_shelter(lambda energy: 1.0),
        "wrong way round": without_shelter(lambda energy: float(energy < 34)),
        "0 for 35 J": without_shelter(lambda energy: 0.0),
    },
    "08.4": {
        "the papers' sum": lambda rate, voxels, cell, speed: rate[tuple(voxels.T)].sum(),
        "only by half": lambda r, v, c, s: r[tuple(v.T)].sum() * c / (3600 * s),
        "all moves as equally long": lambda *m: cost(*m, straight=True),
        "that a move leads to": lambda *m: cost(*m, begin=0.0),
        "where a move begins": lambda *m: cost(*m, begin=1.0),
        "the mean rate": mean_rate_times_time,
        "with which rates is each move": lambda *m: cost(*m, diagonals=2.0),
        "Twice too much": lambda *m: 2 * cost(*m),
        "the rate is per hour": lambda *m: 3600 * cost(*m),
        "more than 60 seconds": lambda *m: 60 * cost(*m),
        "lengths are in cells": lambda *m: cost(*m) / m[2],
        "for longer above a crowd": lambda *m: cost(*m) * m[3],
        "the more die": lambda *m: cost(*m) * m[3] ** 2,
        "not yet deaths": lambda *m: cost(*m) / m[2] * 3600 * m[3],
        "and you get 7": lambda *m: 7.0,
        "The answer is one number: the expected deaths": lambda rate, *_: rate[0, 0],
    },
    "08.5": {
        "deaths per *hour* are fewest": 1.0,
        "the upper end": 39.95,
        "the papers' speed": 16,
        "the best speed of the full fall": 16.2,
        "the best speed behind shelter 0.5": 17.8,
        "for longer than need be": 9.0,
        "hitting more people": 25.0,
        "A speed from 1 to 40 m/s": -3.0,
    },
    "08.6": {
        "the other way round": (BENT, ZIGZAG),
        "are the same": (STRAIGHT, STRAIGHT),
        "not clearly": (HALF_ZIGZAG, BENT),
        "its sum is larger, too": (CORNER, STRAIGHT),
        "the sum is no trap": (STRAIGHT, BENT),
        "has to lead from": (STRAIGHT[:1] * 2, STRAIGHT),
        "leaves the map": ([START, (70.0, 0.0, 27.5), GOAL], STRAIGHT),
        "no list of at least two points": (STRAIGHT, [1, 2, 3]),
        "that is no number": (STRAIGHT, [START, (math.nan, 1.0, 27.5), GOAL]),
        "There are two": (STRAIGHT, BENT, ZIGZAG),
        "The answer is a pair of routes": STRAIGHT,
    },
}


def test_best_speeds_are_those_of_the_model():
    def best(**options):
        speeds = np.arange(1.0, 40.0, 0.02)
        return speeds[np.argmin([float(risk.person_rate(30.0, speed=v, **options)) / v for v in speeds])]

    assert best(shelter=0.25) == pytest.approx(chapter08.BEST_SPEED, abs=0.03)
    assert best(shelter=0.5) == pytest.approx(17.8, abs=0.1)
    speeds = np.arange(15.5, 17.0, 0.1)
    full = [float(risk.person_rate(30.0, shelter=0.25, speed=v, ballistic=True)) / v for v in speeds]
    assert speeds[np.argmin(full)] == pytest.approx(16.2, abs=0.1)


@pytest.mark.parametrize("speed", [12.75, 13, np.float64(13.15)])
def test_a_speed_close_to_the_best_is_right(speed):
    assert exercises.check("08.5", speed)


@pytest.mark.parametrize("pair", [(ZIGZAG, BENT), (np.array(ZIGZAG), np.array(BENT)), (CIRCLES, BENT)])
def test_other_pairs_are_right(pair):
    verdict = exercises.check("08.6", pair)
    assert verdict, verdict


def test_the_field_of_the_exercise_is_the_one_that_is_checked(solutions):
    assert (solutions["field"].rate == chapter08.field().rate).all()
    assert (solutions["start"], solutions["goal"]) == (chapter08.START, chapter08.GOAL)
