"""Exercises of chapter 01: other ways to the answer pass; typical mistakes fail, each with a hint of its own."""

import math

import numpy as np
import pytest

from uavlab import exercises

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


MISTAKES = [
    ("01.2", lambda rate, area, speed, e: 1000 * rate * area * speed * (1 + e), "take mm/h for m/s"),
    ("01.2", lambda rate, area, speed, e: 1000 * rate / 3600 * area * speed * (1 + e), "millimetres aren't metres"),
    ("01.2", lambda rate, area, speed, e: rate * area * speed * (1 + e), "hours aren't seconds"),
    ("01.2", lambda rate, area, speed, e: rate / 3600 * area * speed * (1 - e), "bounce push harder"),
    ("01.2", lambda rate, area, speed, e: rate / 3600 * speed * (1 + e), "a pressure, in pascals"),
    ("01.2", lambda rate, area, speed, e: rate / 3600 * speed * e, "REPARE Eq. 1 as printed"),
    ("01.2", lambda rate, area, speed, e: rate / 3600 * area * speed, "Right for drops that stick"),
    ("01.2", lambda rate, area, speed, e: rate / 3.6e6 * area * speed * (1 + e), "a cubic metre of water"),
    ("01.2", lambda *shower: 1.0, "How many kilograms arrive"),
    ("01.3", lambda w, v, area, rho: rho / 2 * area * np.linalg.norm(v - w) * (v - w), "the direction opposite"),
    ("01.3", lambda w, v, area, rho: rho / 2 * area * (w - v), "linear in the speed, so no newtons"),
    ("01.3", lambda w, v, area, rho: rho / 2 * area * v, "REPARE Eq. 5 as printed"),
    ("01.3", lambda w, v, area, rho: rho / 2 * area * abs(w - v) * (w - v), "each component by itself"),
    ("01.3", lambda w, v, area, rho: rho / 2 * area * (w - v) ** 2, "none is ever negative"),
    ("01.3", lambda w, v, area, rho: rho / 2 * area * np.linalg.norm(w) * w, "Right for a UAV that hovers"),
    ("01.3", lambda w, v, area, rho: rho * area * np.linalg.norm(w - v) * (w - v), "half of the density"),
    ("01.3", lambda w, v, area, rho: rho / 2 * area * np.linalg.norm(w + v) * (w + v), "add the velocity"),
    ("01.3", lambda w, v, area, rho: rho / 2 * area * np.linalg.norm(w - v) ** 2, "it has a direction"),
    ("01.3", lambda w, v, area, rho: (w - v)[:2], "returns an array of shape (2,)"),
    ("01.3", lambda w, v, area, rho: np.ones(3), "how often does that speed enter"),
    ("01.4", lambda speed, wind, course: course, "the course itself"),
    ("01.4", lambda speed, wind, course: course + turned(speed, wind, course), "turn away from the crosswind"),
    ("01.4", lambda speed, wind, course: course - math.degrees(math.atan(across(wind, course) / speed)), "hypotenuse"),
    ("01.4", lambda speed, wind, course: 90 - course + turned(speed, wind, course), "A compass counts clockwise"),
    ("01.4", lambda speed, wind, course: math.radians(course - turned(speed, wind, course)), "radians"),
    ("01.4", subtracted, "that over ground has another"),
    ("01.4", lambda speed, wind, course: course - math.degrees(math.asin(math.hypot(*wind) / speed)), "whole wind"),
    ("01.4", without_none, "Return None there"),
    ("01.4", lambda speed, wind, course: course - turned(speed, wind, course), "Return None there"),
    ("01.4", lambda speed, wind, course: course + 1.0, "moves the UAV over ground"),
    ("01.4", lambda speed, wind, course: None if course > 300 else course, "there is a heading"),
]


@pytest.mark.parametrize(("number", "answer", "words"), MISTAKES, ids=range(len(MISTAKES)))
def test_mistake_gets_its_own_hint(number, answer, words):
    verdict = exercises.check(number, answer)
    assert not verdict
    assert words in verdict.hint


def test_a_heading_may_be_a_turn_more_or_less():
    assert exercises.check("01.4", lambda *case: None if (h := heading_by_search(*case)) is None else h - 360)
