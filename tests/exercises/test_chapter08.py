"""Exercises of chapter 08: other ways to the answer pass; typical mistakes fail, each with a hint of its own."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from uavlab import exercises, risk
from uavlab.vehicle import RISK_QUADROTOR


def speed_by_steps(height, mass, drag_area, air_density):
    """The equation for V², solved step by step."""

    def per_metre(_, squared):
        return 2 * 9.81 - drag_area * air_density * squared / mass

    return math.sqrt(solve_ivp(per_metre, (0.0, height), [0.0], rtol=1e-9, atol=1e-9).y[0, -1])


def fatality_by_odds(energy, shelter):
    return float(risk.impact_fatality(energy, shelter))


def deaths_by_voxel(rate, voxels, cell, speed):
    """Each voxel with half of the move that leads into it and half of the one that leads out."""
    seconds = np.linalg.norm(np.diff(voxels, axis=0), axis=1) * cell / speed
    stay = (np.append(0, seconds) + np.append(seconds, 0)) / 2
    return sum(rate[tuple(voxel)] * time / 3600 for voxel, time in zip(voxels, stay, strict=True))


ANSWERS = {"08.1": speed_by_steps, "08.2": fatality_by_odds, "08.3": deaths_by_voxel}


@pytest.mark.parametrize("number", ANSWERS)
def test_another_way_to_the_answer_is_right(number):
    verdict = exercises.check(number, ANSWERS[number])
    assert verdict, verdict


def test_the_other_gravity_is_right_too():
    def fall_speed(height, mass, drag_area, air_density):
        terminal = 2 * mass * 9.8 / (drag_area * air_density)
        return np.sqrt(terminal * (1 - np.exp(-2 * 9.8 * height / terminal)))

    assert exercises.check("08.1", fall_speed)


def test_the_library_falls_as_fast():
    def fall_speed(height, mass, drag_area, air_density):
        return risk.fall_speed(
            height, replace(RISK_QUADROTOR, mass=mass, fall_drag_area=drag_area), air_density=air_density
        )

    assert exercises.check("08.1", fall_speed)


def fall(height, mass, drag_area, air_density, factor=1.0):
    """The formula, with the exponent times a factor."""
    terminal = 2 * mass * 9.81 / (drag_area * air_density)
    return math.sqrt(terminal * (1 - math.exp(-2 * factor * 9.81 * height / terminal)))


def terminal_speed(height, mass, drag_area, air_density):
    return math.sqrt(2 * mass * 9.81 / (drag_area * air_density))


def chance(energy, shelter, ratio=1e6 / 34):
    return 1 / (1 + math.sqrt(ratio) * (34 / energy) ** (1 / (4 * shelter)))


def chance_under_one_root(energy, shelter):
    return 1 / (1 + math.sqrt(1e6 / 34 * (34 / energy) ** (1 / (4 * shelter))))


def in_the_open(value):
    """Right with shelter, this below β and above it without."""
    return lambda energy, shelter: chance(energy, shelter) if shelter > 0 else value(energy)


def speed_in_time(height, mass, drag_area, air_density):
    """Right at a time, but the time is that of a fall without air."""
    terminal = terminal_speed(height, mass, drag_area, air_density)
    return terminal * math.tanh(9.81 * math.sqrt(2 * height / 9.81) / terminal)


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


MISTAKES = [
    ("08.1", lambda *f: fall(*f, factor=0.5), "as it is printed"),
    ("08.1", lambda *f: fall(*f[:3], 1.0, factor=0.5), "Give your result a unit"),
    ("08.1", lambda *f: fall(*f, factor=2.0), "more energy than gravity"),
    ("08.1", lambda *f: math.sqrt(2 * 9.81 * f[0]), "without air"),
    ("08.1", terminal_speed, "the terminal speed"),
    ("08.1", speed_in_time, "the same time"),
    ("08.1", lambda *f: fall(*f) ** 2, "the square of the speed"),
    ("08.1", lambda *f: fall(*f[:3], 1.0), "where is the density"),
    ("08.1", lambda *f: math.nan, "no finite number"),
    ("08.1", lambda *f: 12.0, "you get 12.00 m/s"),
    ("08.1", lambda *f: np.ones(3), "returns an array of shape (3,). The answer is one number: the speed"),
    ("08.2", chance_under_one_root, "the root covers the power"),
    ("08.2", lambda e, s: 1 / (1 + math.sqrt(1e6 / 34) * (e / 34) ** (1 / (4 * s))), "which way up"),
    ("08.2", lambda e, s: chance(e, s, (1e6 / 34) ** 2), "a root over α/β"),
    ("08.2", lambda e, s: chance(e, s, 34 / 1e6), "which stands above"),
    ("08.2", lambda e, s: 1 / (1 + math.sqrt(1e6 / 34) * (34 / e) ** (1 / 4 * s)), "mind the brackets"),
    ("08.2", lambda e, s: chance(e, 1.0), "the same behind every shelter"),
    ("08.2", lambda e, s: 0.5, "you say"),
    ("08.2", chance, "divides by zero"),
    ("08.2", lambda e, s: chance(e, max(s, 1e-6)), "the power grows without bound"),
    ("08.2", in_the_open(lambda energy: None), ", 0.0) your function returns nothing"),
    ("08.2", in_the_open(lambda energy: 1.0), "let every blow kill"),
    ("08.2", in_the_open(lambda energy: float(energy < 34)), "wrong way round"),
    ("08.2", in_the_open(lambda energy: 0.0), "0 for 35 J"),
    ("08.3", lambda rate, voxels, cell, speed: rate[tuple(voxels.T)].sum(), "the papers' sum"),
    ("08.3", lambda r, v, c, s: r[tuple(v.T)].sum() * c / (3600 * s), "only by half"),
    ("08.3", lambda *m: cost(*m, straight=True), "equally long"),
    ("08.3", lambda *m: cost(*m, begin=0.0), "that a move leads to"),
    ("08.3", lambda *m: cost(*m, begin=1.0), "where a move begins"),
    ("08.3", mean_rate_times_time, "the mean rate"),
    ("08.3", lambda *m: cost(*m, diagonals=2.0), "How long is a move over an edge"),
    ("08.3", lambda *m: 2 * cost(*m), "Twice too much"),
    ("08.3", lambda *m: 3600 * cost(*m), "the rate is per hour"),
    ("08.3", lambda *m: 60 * cost(*m), "more than 60 seconds"),
    ("08.3", lambda *m: cost(*m) / m[2], "lengths are in cells"),
    ("08.3", lambda *m: cost(*m) * m[3], "Who is longer above a crowd"),
    ("08.3", lambda *m: cost(*m) * m[3] ** 2, "the more die"),
    ("08.3", lambda *m: cost(*m) / m[2] * 3600 * m[3], "not yet deaths"),
    ("08.3", lambda *m: 7.0, "and you get 7"),
    ("08.3", lambda rate, *_: rate[0, 0], "The answer is one number: the expected deaths"),
]


@pytest.mark.parametrize(("number", "answer", "hint"), MISTAKES)
def test_mistake_is_told_apart(number, answer, hint):
    verdict = exercises.check(number, answer)
    assert not verdict
    assert hint in verdict.hint


@pytest.mark.parametrize("number", ANSWERS)
def test_hints_differ(number):
    hints = [exercises.check(number, answer).hint for n, answer, _ in MISTAKES if n == number]
    assert len(set(hints)) == len(hints)
