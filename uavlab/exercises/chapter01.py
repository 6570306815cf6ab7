"""Checks of the exercises on wind and rain: the force of rain, drag as a vector, the heading that holds a course."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np

from uavlab.exercises.hints import NOTHING, alike, recognised
from uavlab.exercises.kinds import asks_for, number, numbers

Triple = tuple[float, float, float]

SHOWERS = [(100.0, 0.1, 9.0, 0.0), (30.0, 0.25, 6.0, 0.2), (250.0, 0.04, 8.0, 1.0), (0.0, 0.1, 9.0, 0.5)]
"""Rain [mm/h], area [m²], speed of drops [m/s], restitution."""

STATES: list[tuple[Triple, Triple, float, float]] = [
    ((5.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.05, 1.2),  # hovering
    ((0.0, 0.0, 0.0), (3.0, -4.0, 0.0), 0.06, 1.1),  # calm air
    ((4.0, 3.0, -1.0), (-2.0, 6.0, 2.0), 0.08, 1.225),
    ((2.0, 2.0, 0.5), (2.0, 2.0, 0.5), 0.05, 1.2),  # drifting along
]
"""Wind, velocity over ground [m/s], drag area [m²], density [kg/m³]."""

COURSES = [
    (18.0, (0.0, -9.0), 90.0),
    (12.0, (5.0, 2.0), 200.0),
    (15.0, (-6.0, 3.0), 10.0),
    (10.0, (0.0, 7.0), 0.0),  # from behind
    (20.0, (8.0, 8.0), 315.0),
]
TOO_STRONG = [(5.0, (0.0, -9.0), 90.0), (8.0, (-9.0, 1.0), 0.0)]
"""Air speed [m/s], wind (east, north) [m/s], course [degrees]; in the second list no heading holds the course."""

same = partial(alike, absolute=1e-9)


@asks_for(number("the force [N]"))
def exercise_2(answer: Callable[..., float]) -> str:
    """01.2: the force of rain."""
    given = [answer(*shower) for shower in SHOWERS]
    forces, right = np.asarray(given, dtype=float), [rain(*shower) for shower in SHOWERS]
    if same(forces, right):
        return ""
    if hint := recognised(forces, RAIN_MISTAKES, SHOWERS, same):
        return hint
    index = next(i for i, (force, true) in enumerate(zip(forces, right, strict=True)) if not same(force, true))
    rate, area, speed, restitution = SHOWERS[index]
    return (
        f"For {rate:g} mm/h on {area:g} m², drops of {speed:g} m/s and restitution {restitution:g} you get "
        f"{given[index]:.4g} N. How many kilograms arrive each second, and by how much does each change its speed?"
    )


@asks_for(numbers((3,), "the force as a vector of three numbers: it has a direction"))
def exercise_3(answer: Callable[..., Any]) -> str:
    """01.3: drag as a vector."""
    states = [(np.array(wind), np.array(velocity), area, density) for wind, velocity, area, density in STATES]
    given = [answer(*state) for state in states]
    forces, right = np.asarray(given, dtype=float), [drag(*state) for state in states]
    if same(forces, right):
        return ""
    if hint := recognised(forces, DRAG_MISTAKES, states, same):
        return hint
    index = next(i for i, (force, true) in enumerate(zip(forces, right, strict=True)) if not same(force, true))
    found = ", ".join(f"{part:.3f}" for part in given[index])
    return (
        f"For the wind {STATES[index][0]} and the velocity {STATES[index][1]} m/s you get ({found}) N. How does the "
        "air move as seen from the UAV, and how often does that speed enter?"
    )


@asks_for(number("the heading [degrees], or None where none holds the course", none=True))
def exercise_4(answer: Callable[..., float | None]) -> str:
    """01.4: the heading that holds a course."""
    cases = [(speed, np.array(wind), course) for speed, wind, course in COURSES]
    answers = [answer(*case) for case in cases]
    if all(angle is None for angle in answers):
        return NOTHING
    given = [math.nan if angle is None else float(angle) for angle in answers]
    for case, angle in zip(COURSES, given, strict=True):
        if not math.isfinite(angle):
            return f"For air speed, wind and course {case} there is a heading, and you return none."
    right = [heading(*case) for case in cases]
    if not same_directions(given, right):
        if hint := recognised(given, HEADING_MISTAKES, cases, same_directions):
            return hint
        return drift_of(*next(pair for pair in zip(COURSES, given, strict=True) if off_course(*pair)))
    try:
        refused = [answer(speed, np.array(wind), course) is None for speed, wind, course in TOO_STRONG]
    except ValueError:
        refused = [False]
    if not all(refused):
        return (
            f"Right wherever there is a heading. But with {TOO_STRONG[0][0]:g} m/s through the air no heading cancels "
            f"a crosswind of {abs(TOO_STRONG[0][1][1]):g} m/s: the sine would have to be above 1. Return None there."
        )
    return ""


def same_directions(given: Sequence[float], right: Sequence[float]) -> bool:
    """Whether angles [degrees] are the same, whole turns aside."""
    difference = np.radians(np.asarray(given, dtype=float) - np.asarray(right))
    return bool((np.cos(difference) > 1 - 1e-9).all())


def rain(rate: float, area: float, speed: float, restitution: float) -> float:
    return rate / 3600 * area * speed * (1 + restitution)  # mm/h on a square metre is kg/h


def drag(wind: np.ndarray, velocity: np.ndarray, area: float, density: float) -> np.ndarray:
    relative = wind - velocity
    return 0.5 * density * area * np.linalg.norm(relative) * relative


def crosswind(wind: np.ndarray, course: float) -> float:
    """To the right of the course [m/s]."""
    return float(wind[0] * math.cos(math.radians(course)) - wind[1] * math.sin(math.radians(course)))


def heading(speed: float, wind: np.ndarray, course: float) -> float:
    return course - math.degrees(math.asin(crosswind(wind, course) / speed))


def ground_velocity(speed: float, wind: Sequence[float], angle: float) -> tuple[float, float]:
    """Velocity over ground (east, north) with this heading [m/s]."""
    east, north = math.sin(math.radians(angle)), math.cos(math.radians(angle))
    return speed * east + wind[0], speed * north + wind[1]


def off_course(case: tuple[float, Sequence[float], float], angle: float) -> bool:
    speed, wind, course = case
    return not same_directions([angle], [heading(speed, np.array(wind), course)])


def drift_of(case: tuple[float, Sequence[float], float], angle: float) -> str:
    """Where a wrong heading leads."""
    speed, wind, course = case
    east, north = ground_velocity(speed, wind, angle)
    return (
        f"With the wind {tuple(wind)} and {speed:g} m/s through the air your heading {angle:.1f}° moves the UAV over "
        f"ground by ({east:.1f}, {north:.1f}) m/s, towards {math.degrees(math.atan2(east, north)) % 360:.1f}°, and the "
        f"course is {course:g}°. Which part of the wind blows across the course, and what cancels it?"
    )


RAIN_MISTAKES: list[tuple[Callable[..., float], str]] = [
    (
        lambda rate, area, speed, e: 3.6e6 * rain(rate, area, speed, e),
        "You take mm/h for m/s. How many millimetres has a metre, how many seconds an hour?",
    ),
    (
        lambda rate, area, speed, e: 1000 * rain(rate, area, speed, e),
        "Hours became seconds, but millimetres aren't metres yet: a thousand times too much.",
    ),
    (
        lambda rate, area, speed, e: 3600 * rain(rate, area, speed, e),
        "Millimetres became metres, but hours aren't seconds yet: 3600 times too much.",
    ),
    (
        lambda rate, area, speed, e: rain(rate, area, speed, -e),
        "Drops that bounce push harder, not less: their speed changes from V down to eV up.",
    ),
    (
        lambda rate, area, speed, e: rain(rate, 1.0, speed, e),
        "That is a pressure, in pascals: it doesn't depend on the area. How much of the rain does the UAV catch?",
    ),
    (
        lambda rate, area, speed, e: rain(rate, 1.0, speed, e - 1),
        "That is REPARE Eq. 1 as printed: without an area, and 0 when drops stick. Which momentum do they bring?",
    ),
    (
        lambda rate, area, speed, e: rain(rate, area, speed, 0.0),
        "Right for drops that stick. Those that bounce push a second time, upwards: with which share of the momentum?",
    ),
    (
        lambda rate, area, speed, e: rain(rate, area, speed, e) / 1000,
        "A thousand times too small: a cubic metre of water has 1000 kg.",
    ),
]
"""What else students write, and what to tell them."""

DRAG_MISTAKES: list[tuple[Callable[..., np.ndarray], str]] = [
    (
        lambda wind, velocity, area, density: drag(velocity, wind, area, density),
        "The size is right, the direction opposite: a wind to the east pushes a hovering UAV to the east.",
    ),
    (
        lambda wind, velocity, area, density: 0.5 * density * area * (wind - velocity),
        "That is linear in the speed, so no newtons. A faster wind brings more air each second, and each kilogram of "
        "it pushes harder.",
    ),
    (
        lambda wind, velocity, area, density: 0.5 * density * area * velocity,
        "That is REPARE Eq. 5 as printed: linear in the speed, and without the wind. What pushes a UAV that hovers?",
    ),
    (
        lambda wind, velocity, area, density: 0.5 * density * area * np.abs(wind - velocity) * (wind - velocity),
        "You square each component by itself. That turns the force away from the wind: one length goes with all three.",
    ),
    (
        lambda wind, velocity, area, density: 0.5 * density * area * (wind - velocity) ** 2,
        "You square the components: then none is ever negative. A wind to the west has to push to the west.",
    ),
    (
        lambda wind, velocity, area, density: drag(wind, 0 * velocity, area, density),
        "Right for a UAV that hovers. One that flies feels the air that it runs into as well.",
    ),
    (
        lambda wind, velocity, area, density: 2 * drag(wind, velocity, area, density),
        "Twice too much: by tradition, drag coefficients go with half of the density.",
    ),
    (
        lambda wind, velocity, area, density: drag(wind, -velocity, area, density),
        "You add the velocity to the wind. Who runs with the wind feels less of it.",
    ),
]
"""What else students write, and what to tell them."""

HEADING_MISTAKES: list[tuple[Callable[..., float], str]] = [
    (
        lambda speed, wind, course: course,
        "That is the course itself: the wind would carry the UAV off it. It has to point into the crosswind.",
    ),
    (
        lambda speed, wind, course: 2 * course - heading(speed, wind, course),
        "You turn away from the crosswind by the right angle. To which side must the nose point when the wind blows to "
        "the right?",
    ),
    (
        lambda speed, wind, course: course - math.degrees(math.atan(crosswind(wind, course) / speed)),
        "The air speed is the long side of the triangle (the hypotenuse), not the one along the course: which function "
        "of the angle is crosswind over air speed?",
    ),
    (
        lambda speed, wind, course: 90 - heading(speed, wind, course),
        "Those are angles counterclockwise from east. A compass counts clockwise from north.",
    ),
    (
        lambda speed, wind, course: math.radians(heading(speed, wind, course)),
        "Those are radians; the heading is asked for in degrees.",
    ),
    (
        lambda speed, wind, course: math.degrees(
            math.atan2(
                speed * math.sin(math.radians(course)) - wind[0], speed * math.cos(math.radians(course)) - wind[1]
            )
        ),
        "You subtract the wind from a velocity along the course with the length of the air speed. But it is the "
        "velocity through the air that has this length; that over ground has another.",
    ),
    (
        lambda speed, wind, course: course - math.degrees(math.asin(min(1.0, np.linalg.norm(wind) / speed))),
        "You cancel the whole wind. Only its part across the course moves the UAV off it.",
    ),
]
"""What else students write, and what to tell them."""
