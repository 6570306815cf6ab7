"""Exercises of chapter 01: other ways to the answer pass; typical mistakes fail, each with a hint of its own."""

import math

import numpy as np
import pytest

from uavlab import exercises
from uavlab.exercises.chapter01 import scatter
from uavlab.weather import dryden_gusts

NAMES = {"01.2": "rain_newtons", "01.3": "drag", "01.4": "heading"}


def drops(rain_mm_per_h, area, drop_speed, restitution):
    litres_per_second = rain_mm_per_h * area / 3600
    return litres_per_second * (drop_speed + restitution * drop_speed)


def drag_along(wind, velocity, drag_area, density):
    """Size times direction."""
    relative = np.subtract(wind, velocity)
    speed = math.sqrt(sum(part**2 for part in relative))
    return density / 2 * drag_area * speed**2 * (relative / speed if speed else np.zeros(3))


def heading_by_search(air_speed, wind, course):
    """The heading of all whose ground velocity turns least from the course, refined three times."""
    along = np.array([math.sin(math.radians(course)), math.cos(math.radians(course))])
    best, width = course, 90.0
    if abs(wind[0] * along[1] - wind[1] * along[0]) > air_speed:
        return None
    for _ in range(8):
        angles = best + np.linspace(-width, width, 2001)
        east, north = air_speed * np.sin(np.radians(angles)) + wind[0], air_speed * np.cos(np.radians(angles)) + wind[1]
        best, width = angles[np.abs(east * along[1] - north * along[0]).argmin()], width / 50
    return best


@pytest.mark.parametrize(
    ("number", "answer"), [("01.2", drops), ("01.3", drag_along), ("01.4", heading_by_search)], ids=list(NAMES)
)
def test_another_way_to_the_answer_is_right(number, answer):
    verdict = exercises.check(number, answer)
    assert verdict, verdict


def across(wind, course):
    """To the right of the course."""
    return wind[0] * math.cos(math.radians(course)) - wind[1] * math.sin(math.radians(course))


def turned(speed, wind, course):
    """How far the nose turns into the wind [degrees]."""
    return math.degrees(math.asin(across(wind, course) / speed))


def subtracted(speed, wind, course):
    angle = math.radians(course)
    return math.degrees(math.atan2(speed * math.sin(angle) - wind[0], speed * math.cos(angle) - wind[1]))


def without_none(speed, wind, course):
    return course - math.degrees(math.asin(max(-1.0, min(1.0, across(wind, course) / speed))))


def in_degrees(speed, wind, course):
    return course - math.degrees(math.asin((wind[0] * math.cos(course) - wind[1] * math.sin(course)) / speed))


MISTAKES = {
    "01.2": {
        "take mm/h for m/s": lambda rate, area, speed, e: 1000 * rate * area * speed * (1 + e),
        "millimetres aren't metres": lambda rate, area, speed, e: 1000 * rate / 3600 * area * speed * (1 + e),
        "hours aren't seconds": lambda rate, area, speed, e: rate * area * speed * (1 + e),
        "bounce push harder": lambda rate, area, speed, e: rate / 3600 * area * speed * (1 - e),
        "a pressure, in pascals": lambda rate, area, speed, e: rate / 3600 * speed * (1 + e),
        "REPARE Eq. 1 read with a depth": lambda rate, area, speed, e: rate / 3600 * speed * e,
        "Right for drops that stick": lambda rate, area, speed, e: rate / 3600 * area * speed,
        "a cubic metre of water": lambda rate, area, speed, e: rate / 3.6e6 * area * speed * (1 + e),
        "How many kilograms arrive": lambda *shower: 1.0,
    },
    "01.3": {
        "the direction opposite": lambda w, v, area, rho: rho / 2 * area * np.linalg.norm(v - w) * (v - w),
        "linear in the speed, so no newtons": lambda w, v, area, rho: rho / 2 * area * (w - v),
        "REPARE Eq. 5 as our text has it": lambda w, v, area, rho: rho / 2 * area * v,
        "each component by itself": lambda w, v, area, rho: rho / 2 * area * abs(w - v) * (w - v),
        "none is ever negative": lambda w, v, area, rho: rho / 2 * area * (w - v) ** 2,
        "Right for a UAV that hovers": lambda w, v, area, rho: rho / 2 * area * np.linalg.norm(w) * w,
        "half of the density": lambda w, v, area, rho: rho * area * np.linalg.norm(w - v) * (w - v),
        "add the velocity": lambda w, v, area, rho: rho / 2 * area * np.linalg.norm(w + v) * (w + v),
        "returns one number": lambda w, v, area, rho: rho / 2 * area * np.linalg.norm(w - v) ** 2,
        "returns an array of shape (2,)": lambda w, v, area, rho: (w - v)[:2],
        "how often does that speed enter": lambda w, v, area, rho: np.ones(3),
    },
    "01.4": {
        "the course itself": lambda speed, wind, course: course,
        "turn away from the crosswind": lambda speed, wind, course: course + turned(speed, wind, course),
        "hypotenuse": lambda speed, wind, course: course - math.degrees(math.atan(across(wind, course) / speed)),
        "A compass counts clockwise": lambda speed, wind, course: 90 - course + turned(speed, wind, course),
        "sine and cosine take angles in radians": in_degrees,
        "The arc sine is an angle": lambda speed, wind, course: course - math.radians(turned(speed, wind, course)),
        "Those are radians": lambda speed, wind, course: math.radians(course - turned(speed, wind, course)),
        "that over ground has another": subtracted,
        "whole wind": lambda speed, wind, course: course - math.degrees(math.asin(math.hypot(*wind) / speed)),
        "Return None there": lambda speed, wind, course: course - turned(speed, wind, course),
        "moves the UAV over ground": lambda speed, wind, course: course + 1.0,
        "and you return none": lambda speed, wind, course: None if course > 300 else course,
    },
    "01.5": {
        "in minutes": 3.9,
        "brought a new gust": 6.7,
        "the memory τ": 19.06,
        "the variance of the means": 78,
        "correlation counts on both sides": 127.0,
        "two standard deviations": 990,
        "scatter from record to record by about 0.95 m/s": 10.0,
        "scatter from record to record by about 0.26 m/s": 600.0,
        "above 0 and finite": -5.0,
    },
    "01.6": {
        "can't even lift": (1.4, 5.0, 25.0),
        "the lift margin is": (1.2, 5.0, 25.0),
        "On the way out 13 m/s over ground": (0.5, 13.0, 25.0),
        "On the way back 26 m/s over ground": (0.5, 8.0, 26.0),
        "a gust meets the UAV": (1.0, 11.0, 25.0),
        "What does the wind add": (0.9, 7.5, 18.0),
        "one of the speeds has room left": (0.9, 5.0, 25.0),
        "Would a heavier load": (0.3, 11.0, 25.0),
        "Would a lighter load": (1.09, 5.6, 25.0),
        "two speeds above 0": (0.5, 0.0, 25.0),
    },
}


def test_a_heading_that_is_none_nowhere():
    assert "Return None there" in exercises.check("01.4", without_none).hint


def test_averaging_times_that_are_near_enough():
    for seconds in (205, 233.0, np.float64(254), 260):
        assert exercises.check("01.5", seconds), seconds
    assert not exercises.check("01.5", 180)
    assert not exercises.check("01.5", 300)


def test_averaging_time_by_simulation():
    records = np.array([dryden_gusts(1200, 1.0, 8.0, 30.0, 6.0, rng=seed)[:, 0] for seed in range(600)])
    for seconds in (60, 233, 900):
        assert records[:, :seconds].mean(axis=1).std() == pytest.approx(scatter(seconds), rel=0.08)


def test_deliveries_near_the_best():
    for delivery in ((0.9, 7.9, 25.0), [0.95, 7.4, 25.0], np.array([1.0, 6.92, 24.9])):
        verdict = exercises.check("01.6", delivery)
        assert verdict, verdict


def test_a_heading_may_be_a_turn_more_or_less():
    assert exercises.check("01.4", lambda *case: None if (h := heading_by_search(*case)) is None else h - 360)
