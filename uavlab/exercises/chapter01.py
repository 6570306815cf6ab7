"""Checks of the exercises on wind and rain: a gust in flight, forces, a heading, how long to average, a delivery."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np

from uavlab.exercises.hints import NOTHING, alike, recognised
from uavlab.exercises.kinds import Quiz, asks_for, asks_for_value, number, numbers
from uavlab.vehicle import GRAVITY, LIGHT_QUADROTOR
from uavlab.weather import dryden_parameters, lift_margin, wind_limit

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

exercise_1 = Quiz(
    "c",
    "In the gust the air passes the UAV with G W + 5 m/s, and that must be at most 20 m/s.",
    {
        "a": "That is 20/1.75: right for a UAV that hovers, or stops in the gust. With which speed does the gust meet "
        "one that flies towards it?",
        "b": "That is 20 − 5: the mean wind may then be that strong, but what is there to hold the gust with?",
        "d": "That is 20/1.75 − 5, as if the UAV's own 5 m/s were multiplied by the gust factor, too. What does a gust "
        "make faster, the air or the UAV?",
    },
)


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


AIR_SPEED, WANTED = 8.0, 0.4
"""Of the mean wind, and the standard deviation that its measured mean is to have [m/s]."""


@asks_for_value(number("the averaging time [s]"))
def exercise_5(answer: float) -> str:
    """01.5: how long the wind has to be averaged."""
    time = float(answer)
    if not 0 < time < math.inf:
        return f"An averaging time is above 0 and finite, and you hand over {time:g} s."
    if abs(scatter(time) / WANTED - 1) <= 0.08:  # so the time is 15 % off at most
        return ""
    for (low, high), hint in TIMES.items():
        if low <= time <= high:
            return hint
    often = "more" if scatter(time) > WANTED else "less"
    return (
        f"Means over {time:g} s scatter from record to record by about {scatter(time):.2f} m/s: {often} than the "
        f"{WANTED} m/s that are asked for. Is it over the records, and not along one, that you take the deviation?"
    )


def scatter(time: float) -> float:
    """Standard deviation of the mean over a time [m/s], for gusts that forget exponentially."""
    lengths, deviations = dryden_parameters(30.0, 6.0)
    memory = lengths[0] / AIR_SPEED
    share = 2 * memory / time * (1 - memory / time * (1 - math.exp(-time / memory)))
    return float(deviations[0] * math.sqrt(share))


TIMES = {
    (3.4, 4.6): "Is that in minutes? The time is asked for in seconds.",
    (5.0, 9.0):
        "So few samples would do if each second brought a new gust. Neighbouring seconds are nearly alike: look at the "
        "scatter of the means themselves.",
    (18.0, 20.0): "That is the memory τ of the gusts. Over one memory the mean still follows the gust.",
    (70.0, 90.0): "There the variance of the means is 0.4. Asked for is their standard deviation, its root.",
    (115.0, 140.0):
        "One new gust every τ seconds would give that. A moment is like those before it and like those after it: "
        "correlation counts on both sides.",
    (850.0, 1150.0): "There two standard deviations are 0.4 m/s. Asked for is the time at which one is.",
}  # fmt: skip
"""From and to which time [s] a known mistake leads, and what to tell of it."""

DISTANCE, HEAD_WIND, GUST, PAUSE = 2000.0, 7.0, 1.75, 120.0
"""One way [m], mean wind [m/s], gust factor, loading and unloading [s]."""
NEAR = 0.97
"""Share of the best that is enough."""


@asks_for_value(numbers((3,), "three numbers: the load [kg], the speed out and the speed back [m/s]"))
def exercise_6(answer: Any) -> str:
    """01.6: as many kilograms an hour as possible."""
    load, out, back = (float(part) for part in answer)
    if not (all(map(math.isfinite, (load, out, back))) and load >= 0 and out > 0 and back > 0):
        return (
            f"A load of at least 0 and two speeds above 0 are asked for, and you hand over {load:g}, {out:g}, {back:g}."
        )
    if broken := rule_broken(load, out, back):
        return broken
    brought = kilograms_an_hour(load, out, back)
    if brought >= NEAR * most_an_hour():
        return ""
    words = f"That is allowed and brings {brought:.2f} kg/h. More is possible. "
    fast_out, fast_back = greatest_speeds(load)
    if back <= LIGHT_QUADROTOR.top_speed:
        return words + "On the way back the limit is the speed through the air. What does the wind add over ground?"
    if out < 0.97 * fast_out or back < 0.97 * fast_back:
        return words + "With this load one of the speeds has room left before a rule stops it."
    side = "heavier" if kilograms_an_hour(load + 0.01, *greatest_speeds(load + 0.01)) > brought else "lighter"
    return (
        words + f"The speeds are as high as this load allows. Would a {side} load bring more, with speeds that suit it?"
    )


def rule_broken(load: float, out: float, back: float) -> str:
    """Which rule a delivery breaks, in words."""
    top = LIGHT_QUADROTOR.top_speed
    if (LIGHT_QUADROTOR.mass + load) * GRAVITY >= LIGHT_QUADROTOR.thrust:
        return f"The rotors can't even lift {load:g} kg."
    loaded = LIGHT_QUADROTOR.loaded(load)
    if (margin := float(lift_margin(loaded))) <= 0:
        return f"With {load:g} kg the lift margin is {margin:.2f} N: the safety factor isn't kept."
    for way, speed, through in (("out", out, out + HEAD_WIND), ("back", back, back - HEAD_WIND)):
        if through > top + 1e-9:
            return (
                f"On the way {way} {speed:g} m/s over ground need {through:g} m/s through the air: more than {top:g}."
            )
    met, held = GUST * HEAD_WIND + out, float(wind_limit(loaded))
    if met > held + 1e-9:
        return (
            f"On the way out a gust meets the UAV with {met:.1f} m/s, and with {load:g} kg its thrust holds {held:.1f}."
        )
    return ""


def greatest_speeds(load: float) -> tuple[float, float]:
    """Out and back over ground [m/s], 0 where the load doesn't fly."""
    held = float(wind_limit(LIGHT_QUADROTOR.loaded(load)))
    top = LIGHT_QUADROTOR.top_speed
    return max(0.0, min(held - GUST * HEAD_WIND, top - HEAD_WIND)), top + HEAD_WIND


def kilograms_an_hour(load: float, out: float, back: float) -> float:
    return 0.0 if out == 0 else 3600 * load / (DISTANCE / out + DISTANCE / back + PAUSE)


def most_an_hour() -> float:
    return max(kilograms_an_hour(load, *greatest_speeds(load)) for load in np.arange(0.0, 1.2, 0.005))


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


def times_too_much(factor: float, rate: float, area: float, speed: float, restitution: float) -> float:
    return factor * rain(rate, area, speed, restitution)


FACTORS = {
    3.6e6: "You take mm/h for m/s. How many millimetres has a metre, how many seconds an hour?",
    1000.0: "Hours became seconds, but millimetres aren't metres yet: a thousand times too much.",
    3600.0: "Millimetres became metres, but hours aren't seconds yet: 3600 times too much.",
    0.001: "A thousand times too small: a cubic metre of water has 1000 kg.",
}
RAIN_MISTAKES: list[tuple[Callable[..., float], str]] = [
    *((partial(times_too_much, factor), hint) for factor, hint in FACTORS.items()),
    (lambda rate, area, speed, e: rain(rate, area, speed, -e),
     "Drops that bounce push harder, not less: their speed changes from V down to eV up."),
    (lambda rate, area, speed, e: rain(rate, 1.0, speed, e),
     "That is a pressure, in pascals: it doesn't depend on the area. How much of the rain does the UAV catch?"),
    (lambda rate, area, speed, e: rain(rate, 1.0, speed, e - 1),
     "That is REPARE Eq. 1 read with a depth: without an area, and 0 for drops that stick. What do they bring?"),
    (lambda rate, area, speed, e: rain(rate, area, speed, 0.0),
     "Right for drops that stick. Those that bounce push a second time, upwards: with which share of the momentum?"),
]  # fmt: skip
"""What else students write, and what to tell them."""

DRAG_MISTAKES: list[tuple[Callable[..., np.ndarray], str]] = [
    (lambda wind, velocity, area, density: drag(velocity, wind, area, density),
     "The size is right, the direction opposite: a wind to the east pushes a hovering UAV to the east."),
    (lambda wind, velocity, area, density: 0.5 * density * area * (wind - velocity),
     "That is linear in the speed, so no newtons. A faster wind brings more air each second, and each kilogram of "
     "it pushes harder."),
    (lambda wind, velocity, area, density: 0.5 * density * area * velocity,
     "That is REPARE Eq. 5 as our text has it: linear, and without the wind. What pushes a UAV that hovers?"),
    (lambda wind, velocity, area, density: 0.5 * density * area * np.abs(wind - velocity) * (wind - velocity),
     "You square each component by itself. That turns the force away from the wind: one length goes with all three."),
    (lambda wind, velocity, area, density: 0.5 * density * area * (wind - velocity) ** 2,
     "You square the components: then none is ever negative. A wind to the west has to push to the west."),
    (lambda wind, velocity, area, density: drag(wind, 0 * velocity, area, density),
     "Right for a UAV that hovers. One that flies feels the air that it runs into as well."),
    (lambda wind, velocity, area, density: 2 * drag(wind, velocity, area, density),
     "Twice too much: by tradition, drag coefficients go with half of the density."),
    (lambda wind, velocity, area, density: drag(wind, -velocity, area, density),
     "You add the velocity to the wind. A UAV that flies along with the wind feels less of it."),
]  # fmt: skip
"""What else students write, and what to tell them."""

HEADING_MISTAKES: list[tuple[Callable[..., float], str]] = [
    (lambda speed, wind, course: course,
     "That is the course itself: the wind would carry the UAV off it. It has to point into the crosswind."),
    (lambda speed, wind, course: 2 * course - heading(speed, wind, course),
     "You turn away from the crosswind by the right angle. To which side must the UAV fly through the air when the "
     "wind blows to the right?"),
    (lambda speed, wind, course: course - math.degrees(math.atan(crosswind(wind, course) / speed)),
     "The air speed is the long side of the triangle (the hypotenuse), not the one along the course: which function "
     "of the angle is crosswind over air speed?"),
    (lambda speed, wind, course: 90 - heading(speed, wind, course),
     "Those are angles counterclockwise from east. A compass counts clockwise from north."),
    (lambda speed, wind, course: course - math.degrees(
        math.asin((wind[0] * math.cos(course) - wind[1] * math.sin(course)) / speed)),
     "Python's sine and cosine take angles in radians, and the course is in degrees."),
    (lambda speed, wind, course: course - math.asin(crosswind(wind, course) / speed),
     "The arc sine is an angle in radians, and you subtract it from degrees."),
    (lambda speed, wind, course: math.radians(heading(speed, wind, course)),
     "Those are radians; the heading is asked for in degrees."),
    (lambda speed, wind, course: math.degrees(math.atan2(
        speed * math.sin(math.radians(course)) - wind[0], speed * math.cos(math.radians(course)) - wind[1])),
     "You subtract the wind from a velocity along the course with the length of the air speed. But it is the "
     "velocity through the air that has this length; that over ground has another."),
    (lambda speed, wind, course: course - math.degrees(math.asin(min(1.0, np.linalg.norm(wind) / speed))),
     "You cancel the whole wind. Only its part across the course moves the UAV off it."),
]  # fmt: skip
"""What else students write, and what to tell them."""
