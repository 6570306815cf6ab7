"""Exercises of chapter 14, from route to autopilot: degrees, altitudes, corners, lost messages, GPS, and a mission.

A hint says which mistake the answers look like and why it is one. Mistakes are recognised by what they answer, not
by how they are written. Of a mission of one's own all that fails is said, with figures.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache, partial
from typing import Any

import numpy as np
import shapely

from uavlab.city import City, Place
from uavlab.exercises.hints import NOTHING, alike, recognised
from uavlab.exercises.kinds import asks_for, number, numbers
from uavlab.mission import Mission
from uavlab.mission.corridor import corner, cut_off
from uavlab.mission.fences import polygon_on
from uavlab.mission.items import CHANGE_SPEED, LAND, LOITER, PLACED, RETURN, TAKEOFF, WAYPOINT
from uavlab.risk import CAMPUS_FLIGHT, reference_campus
from uavlab.route import Route

Function = Callable[..., Any]
Questions = Sequence[tuple[Any, ...]]
Mistakes = Sequence[tuple[Function, str]]


def answers_to(function: Function, questions: Questions) -> np.ndarray:
    """What a function answers to questions, one by one."""
    return np.array([function(*question) for question in questions], dtype=float)


STEP = math.radians(1e-7) * 6_371_000.0
LATITUDES = [(47.25,), (-33.9,), (60.0,), (12.0,)]


@asks_for(numbers((2,), "two numbers, (north, east)"))
def exercise_1(digit_in_metres: Function) -> str:
    """14.1: one step of MAVLink's degrees in metres."""
    given = answers_to(digit_in_metres, LATITUDES)
    if alike(given, [step(*latitude) for latitude in LATITUDES]):
        return ""
    (north, east), (latitude,) = given[0], LATITUDES[0]
    return recognised(given, DIGITS, LATITUDES, alike) or (
        f"At {latitude}° your step is {north:.4g} m to the north and {east:.4g} m to the east. Draw the two circles: "
        "how long is each, and how many steps does it have?"
    )


def step(latitude: float, factor: float = 1.0) -> tuple[float, float]:
    return factor * STEP, factor * STEP * math.cos(math.radians(latitude))


DIGITS: Mistakes = [
    (lambda d: (STEP, STEP), "Your step east is as long everywhere. Near the pole the way around the Earth is short."),
    (lambda d: step(d)[::-1], "Your two numbers are the wrong way round: which of them changes with the latitude?"),
    (lambda d: (step(d)[1],) * 2, "A degree north is as long at any latitude: all meridians are equally long."),
    (lambda d: (STEP, STEP * math.cos(d)), "`math.cos` takes an angle in radians, and the latitude is in degrees."),
    (lambda d: (STEP, STEP * math.sin(math.radians(d))), "Your step east is 0 at the equator, where it is longest."),
    (partial(step, factor=2), "Both are twice too long. 6 371 000 m is the Earth's radius: what is its diameter?"),
    (partial(step, factor=0.5), "Both are half of what they should be. How long is a circle of radius R?"),
    (partial(step, factor=math.degrees(1)), "You take the step for 1e-7 radians. It is 1e-7 degrees."),
    (partial(step, factor=1e14), "You multiply by 10 000 000. One step is a small part of a degree."),
    (partial(step, factor=1e7), "That is a whole degree. How many steps does it have?"),
    (partial(step, factor=1e-3), "That is in kilometres; asked for are metres."),
]

HEIGHTS = [(65.0, 12.0, 430.0, 31.0), (20.0, -4.0, 95.0, 9.0), (8.5, 40.0, 17.0, 2.5)]


@asks_for(number("the altitude [m]"))
def exercise_2(altitude: Function) -> str:
    """14.2: the altitude of a point in three frames."""
    given = {}
    for frame in ALTITUDES:
        given[frame] = answers_to(altitude, [(frame, *heights) for heights in HEIGHTS])
    if alike(given["home"], given["sea"]) and alike(given["home"], given["terrain"]):
        return "Your answer is the same in all three frames. From what does each of them measure?"
    for frame, (right, mistakes) in ALTITUDES.items():
        if not alike(given[frame], [right(*heights) for heights in HEIGHTS]):
            z, home_z, sea, ground = HEIGHTS[0]
            return recognised(given[frame], mistakes, HEIGHTS, alike) or (
                f"In {frame!r} you give {float(given[frame][0]):g} m. The point is at {z:g} m on the map, home at "
                f"{home_z:g} m and the ground at {ground:g} m; home is {sea:g} m above the sea. Draw them."
            )
    return ""


ALTITUDES: dict[str, tuple[Callable[..., float], Mistakes]] = {
    "home": (lambda z, h, s, g: z - h, [
        (lambda z, h, s, g: z, "'home': that is the height on the map, and home isn't at its zero."),
        (lambda z, h, s, g: z + h, "'home': you add home's height. Which altitude has a point as high as home?"),
        (lambda z, h, s, g: h - z, "'home': your points above home have altitudes below 0."),
        (lambda z, h, s, g: z - g, "'home': you measure from the ground below the point, not from home."),
        (lambda z, h, s, g: z - h + s, "'home': that is the altitude above the sea."),
    ]),
    "sea": (lambda z, h, s, g: z - h + s, [
        (lambda z, h, s, g: z + s, "'sea': put the point at home. You don't get home's own height above the sea."),
        (lambda z, h, s, g: z + h + s, "'sea': you add the heights of home and of the point. Mind a sign."),
        (lambda z, h, s, g: z - h - s, "'sea': the sea lies below home, and you get less than above home."),
        (lambda z, h, s, g: z - s, "'sea': the heights of the map aren't those above the sea."),
        (lambda z, h, s, g: s + h - z, "'sea': your altitude falls when the point rises."),
        (lambda z, h, s, g: z - h, "'sea': that is the altitude above home. How high is home itself?"),
        (lambda z, h, s, g: z - g + s, "'sea': you go by the ground below the point. Whose height is known?"),
        (lambda z, h, s, g: z, "'sea': that is the height on the map, and the sea isn't at its zero."),
    ]),
    "terrain": (lambda z, h, s, g: z - g, [
        (lambda z, h, s, g: z - h, "'terrain': that is above home. Would it clear a hill that is higher than home?"),
        (lambda z, h, s, g: z - h - g, "'terrain': the point is above home here, the ground above the map's zero."),
        (lambda z, h, s, g: z - h + s - g, "'terrain': the point is above the sea here, and the ground isn't."),
        (lambda z, h, s, g: z + g, "'terrain': over higher ground your point has more room below it, not less."),
        (lambda z, h, s, g: g - z, "'terrain': your points above the ground have altitudes below 0."),
        (lambda z, h, s, g: z, "'terrain': that is the height on the map, and the ground isn't flat at its zero."),
    ]),
}  # fmt: skip

CORNERS: list[tuple[Any, ...]] = [
    (*np.array(points, dtype=float), radius)
    for *points, radius in (
        ((0, 0, 30), (40, 0, 30), (70, 20, 30), 2.0),
        ((5, 5, 20), (8, 9, 26), (30, 12, 27), 6.0),  # the first leg is short
        ((0, 50, 30), (30, 35, 38), (31, 33, 41), 5.0),  # the second one is
        ((0, 0, 0), (2, -2, 9), (6, -6, 27), 1.5),  # straight on
        ((0, 0, 30), (20, 0, 30), (20, 15, 30), 4.0),
        ((0, 0, 30), (20, 0, 30), (5, 4, 33), 2.0),
        ((0, 0, 30), (20, 0, 30), (10, 0, 30), 5.0),
    )
]
GENTLE, SHARP = CORNERS[:4], CORNERS[4:]


@asks_for(number("the margin [m]"), unchanged=True)
def exercise_3(corner_margin: Function) -> str:
    """14.3: how far from its legs the way around a corner may lie."""
    given = answers_to(corner_margin, CORNERS)
    same = partial(alike, absolute=1e-6)
    if same(given, [margin(*case) for case in CORNERS]):
        return ""
    gentle, sharp = given[: len(GENTLE)], given[len(GENTLE) :]
    if same(gentle, [margin(*case) for case in GENTLE]):
        return recognised(sharp, SHARP_MISTAKES, SHARP, same) or (
            f"Up to a right angle it is right. At a turn of {np.degrees(turn(*SHARP[1][:3])):.0f}° and a radius of 2 m "
            f"you give {float(sharp[1]):.3g} m: which bound is asked for there?"
        )
    if np.isnan(gentle).any():
        return "Your answer is NaN for points in a line: there, rounding can make the cosine a little more than 1."
    return recognised(gentle, CORNER_MISTAKES, GENTLE, same) or (
        f"At a turn of {np.degrees(turn(*GENTLE[0][:3])):.1f}°, radius 2 m and long legs, you give "
        f"{float(gentle[0]):.3g} m. Draw the triangle of the corner: which point of it is farthest from both legs?"
    )


def turn(before: np.ndarray, here: np.ndarray, after: np.ndarray) -> float:
    into, out, _ = corner(before, here, after, 1.0)
    return math.acos(float(np.clip(into @ out, -1.0, 1.0)))


def legs(before: np.ndarray, here: np.ndarray, after: np.ndarray) -> tuple[float, float]:
    return float(np.linalg.norm(here - before)), float(np.linalg.norm(after - here))


def margin(*case: Any) -> float:
    return cut_off(*corner(*case))


def shared(share: Callable[[float], float], *case: Any) -> float:
    """Another share of the reach, by the turn."""
    return corner(*case)[2] * share(turn(*case[:3]))


def reached(reach: Callable[..., float], *case: Any) -> float:
    """Another reach, by the radius and the lengths of both legs."""
    return reach(case[3], *legs(*case[:3])) / 2 * math.sin(turn(*case[:3]))


CORNER_MISTAKES: Mistakes = [
    (partial(shared, math.sin), "That is twice too much: so far the reach's end is from the line of the other leg."),
    (partial(shared, lambda a: math.tan(a) / 2), "Near a right angle your margin has no bounds: that is a tangent."),
    (partial(shared, lambda a: math.cos(a) / 2), "Your margin is largest where the way goes straight on: a cosine."),
    (partial(shared, lambda a: math.sin(a / 2)), "That is how far the corner, not a leg, is from the third side."),
    (partial(shared, lambda a: math.sin(a / 2) / 2), "You take half the turn. Which angle is between the directions?"),
    (partial(shared, lambda a: math.sin(math.degrees(a)) / 2), "Your sine takes degrees for radians."),
    (partial(shared, lambda a: 0.5), "That is half the reach whatever the turn. Straight on, nothing is cut off."),
    (partial(reached, lambda r, a, b: r), "Your reach is the radius, also where a leg is shorter than that."),
    (partial(reached, lambda r, a, b: min(r, a, b)), "Your reach may be a whole leg. A leg has a corner at each end."),
    (partial(reached, lambda r, a, b: min(r, a / 2)), "Your reach is limited by the leg before the corner alone."),
    (partial(reached, lambda r, a, b: min(r, b / 2)), "Your reach is limited by the leg behind the corner alone."),
    (lambda *case: margin(*(p * (1, 1, 0) for p in case[:3]), case[3]), "You leave out the heights of the points."),
    (lambda *case: margin(*case) * math.prod(legs(*case[:3])), "Your directions are as long as the legs, and not 1."),
]
SHARP_MISTAKES: Mistakes = [
    (partial(shared, lambda a: math.sin(a) / 2), "Beyond a right angle the sine falls again: see the bound there."),
    (partial(shared, lambda a: 1.0 if a > 1.6 else 0.5), "Beyond a right angle you keep the whole reach."),
]

TRANSFERS = [(20, 0.1, 3), (300, 0.1, 5), (12, 0.3, 4), (5, 0.25, 2), (2, 0.5, 1)]


@asks_for(number("a chance, from 0 to 1"))
def exercise_4(chance_of_transfer: Function) -> str:
    """14.4: the chance that all items of a mission arrive over a link that loses some."""
    given = answers_to(chance_of_transfer, TRANSFERS)
    if alike(given, [chance(*case) for case in TRANSFERS]):
        return ""
    (items, loss, tries), found = TRANSFERS[0], float(given[0])
    return recognised(given, CHANCES, TRANSFERS, alike) or (
        f"For {items} items, {loss:.0%} loss and {tries} tries you give {found:.4g}. "
        + "No chance is below 0 or above 1. " * (not 0 <= found <= 1)
        + "With which chance does one try of one item fail? And with which do all tries of it?"
    )


def chance(items: int, loss: float, tries: int) -> float:
    return (1 - fails(loss) ** tries) ** items


def fails(loss: float) -> float:
    """Chance that a question or its answer is lost."""
    return 1 - (1 - loss) ** 2


CHANCES: Mistakes = [
    (lambda n, p, k: (1 - p**k) ** n, "You lose messages one way only. What if just the answer is lost?"),
    (lambda n, p, k: (1 - p**k) ** (2 * n), "You try question and answer apart. If one is lost, both are sent again."),
    (lambda n, p, k: (1 - p ** (2 * k)) ** n, "Your try fails only when both messages are lost. One is enough."),
    (lambda n, p, k: (1 - (2 * p) ** k) ** n, "You add two losses: that counts twice where both messages are lost."),
    (lambda n, p, k: chance(n, p, k - 1), "You count one try less than there are."),
    (lambda n, p, k: chance(n, p, k + 1), "You count one try more: `tries` has the first question in it."),
    (lambda n, p, k: chance(n, p, 1), "Your chance is that of a single try for each item."),
    (lambda n, p, k: chance(1, p, k), "That is the chance of one item. All of them have to arrive."),
    (lambda n, p, k: n * chance(1, p, k), "That is how many items arrive on average. How likely is it that all do?"),
    (lambda n, p, k: 1 - chance(n, p, k), "That is the chance that something is missing."),
    (lambda n, p, k: fails(p) ** k, "That is the chance that one item doesn't arrive."),
    (lambda n, p, k: 1 - fails(p) ** (n * k), "That is the chance that at least one item arrives."),
    (lambda n, p, k: 1 - n * fails(p) ** k, "You add the failures of all items: that is near while they are rare."),
    (lambda n, p, k: 100 * chance(n, p, k), "That is in percent. A chance is a number from 0 to 1."),
]

FLIGHTS = [(1.0, 4.7, 1100.0), (3.0, 4.7, 1100.0), (1.2, 1.5, 60.0), (0.5, 2.0, 300.0)]
FOR_EVER = [(15.0, 4.7, 1100.0), (6.0, 2.0, 300.0)]


@asks_for(number("the time [s], math.inf where no flight is too long"))
def exercise_5(longest_flight: Function) -> str:
    """14.5: how long the error of GPS stays within a margin."""
    given = answers_to(longest_flight, FLIGHTS)
    if not alike(given, [longest(*case) for case in FLIGHTS]):
        (limit, sigma, correlation), found = FLIGHTS[1], float(given[1])
        then = 3 * sigma * math.sqrt(max(0.0, 1 - math.exp(-2 * max(found, 0.0) / correlation)))
        return recognised(given, TIMES, FLIGHTS, alike) or (
            f"For a margin of {limit:g} m, σ = {sigma:g} m and τ = {correlation:g} s you give {found:.4g} s. Then "
            f"3σ is {then:.2f} m. Put σ(t) into 3σ(t) = margin, and solve for t."
        )
    hint = ""
    try:
        given = answers_to(longest_flight, FOR_EVER)
    except (ArithmeticError, ValueError) as error:
        hint = f"Your function raises {error!r}."
    if not hint and not np.isposinf(given).all():
        hint = f"Your answers are {float(given[0]):.4g} and {float(given[1]):.4g} s."
    return hint and f"For 15 m with σ = 4.7 m, and for 6 m with σ = 2 m, no flight is too long. {hint}"


def longest(limit: float, sigma: float, correlation: float, *, sigmas: float = 3.0, power: float = 2.0) -> float:
    return -correlation / 2 * math.log(1 - (limit / (sigmas * sigma)) ** power)


TIMES: Mistakes = [
    (partial(longest, sigmas=1.0), "You let one σ reach the margin. Then a third of all flights is beyond it."),
    (lambda m, s, c: 2 * longest(m, s, c), "Your time is twice too long. Look at the exponent: by what is t divided?"),
    (lambda m, s, c: 4 * longest(m, s, c), "Your time is four times too long: on which side is the 2 of the exponent?"),
    (partial(longest, power=1.0), "You forget the root: it is σ² that grows by 1 − exp(−2t/τ)."),
    (lambda m, s, c: -longest(m, s, c), "Your times are negative. The logarithm of a number below 1 is, too."),
    (lambda m, s, c: 0.0, "That takes σ for what it is in the long run. At the start the error is 0."),
    (lambda m, s, c: math.inf, "No margin here is as large as 3σ in the long run, so a flight can be too long."),
    (lambda m, s, c: longest(m, s, c) / 60, "That is in minutes; asked for are seconds."),
    (lambda m, s, c: longest(m, s, c) / math.log(10), "The inverse of exp is the natural logarithm."),
    (lambda m, s, c: c / 2 * (m / (3 * s)) ** 2, "That is the curve's beginning: σ² doesn't grow evenly for long."),
]

NEAR, KEPT, TOP, MOST_WAYPOINTS = 3.0, 3.0, 60.0, 12
# what 1e-7 degrees may cost [m], and how far from the campus [m] something is wrong with the place
ROUNDING, LOST = 0.01, 1000.0
ELSEWHERE = {
    RETURN: "Your mission has a command to return: then it lands where it took off, and not at the goal.",
    LOITER: "Your mission has a command to stay: there it hovers until the battery is empty. It has to land.",
}


@cache
def campus_on_earth() -> City:
    return replace(reference_campus().city, reference=Place(8.5, 47.25, 420.0))


def exercise_6(own_mission: Function) -> str:
    """14.6: a mission of one's own: all that it doesn't keep."""
    city = campus_on_earth()
    mission = own_mission(city, *CAMPUS_FLIGHT)
    if mission is None:
        return NOTHING
    if not isinstance(mission, Mission):
        return f"Your function returns a {type(mission).__name__}, not a Mission: what makes one of a route?"
    if hint := out_of_order(mission):
        return hint
    way = mission.path(city)
    away = float(np.abs(way.points[:, :2]).max())
    if away > LOST:
        return f"It goes {away / 1000:.4g} km away from the campus: the order of a place is longitude, latitude."
    return " ".join([*wrong_ends(way), *wrong_on_the_way(mission, way, city), *wrong_fence(mission, way, city)])


def out_of_order(mission: Mission) -> str:
    """What is wrong with its commands."""
    commands = [item.command for item in mission.items]
    for command in commands:
        if command not in (TAKEOFF, WAYPOINT, LAND, CHANGE_SPEED):
            return ELSEWHERE.get(command, f"Where command {command} leads isn't known here. Four commands are enough.")
    placed = [command for command in commands if command in PLACED]
    if placed[:1] != [TAKEOFF] or placed.count(TAKEOFF) > 1:
        return "The first place in your mission must be that of its only take-off: a UAV on the ground can't fly level."
    if commands[-1] != LAND or placed.count(LAND) > 1:
        return "The last item must be the only landing: what comes behind a landing isn't flown."
    return ""


def wrong_ends(way: Route) -> list[str]:
    """Whether it takes off at the start and lands at the goal."""
    start, goal = np.array(CAMPUS_FLIGHT)[:, :2]
    off = float(np.linalg.norm(way.points[:2, :2] - start, axis=1).max())
    beside = float(np.linalg.norm(way.points[-1, :2] - goal))
    begins = [f"It takes off {off:.1f} m from the start; {NEAR:g} m are allowed."] * (off > NEAR)
    return begins + [f"It lands {beside:.1f} m from the goal; {NEAR:g} m are allowed."] * (beside > NEAR)


def wrong_on_the_way(mission: Mission, way: Route, city: City) -> list[str]:
    """Whether it keeps clear and low, from above home to above where it lands, and has few waypoints."""
    above_landing = np.array([*way.points[-1, :2], way.points[-2, 2]])
    level = Route(np.vstack([way.en_route.points, above_landing]))
    apart, height = level.clearance(city), float(city.height_above_ground(level.points).max())
    waypoints = sum(item.command == WAYPOINT for item in mission.items)
    near = f"It comes as near as {apart:.2f} m to an obstacle; it must keep {KEPT:g} m."
    hints = [near if apart > 0 else "It hits an obstacle or leaves the map."] * (apart < KEPT - ROUNDING)
    hints += [f"It climbs to {height:.1f} m above the ground; {TOP:g} m are allowed."] * (height > TOP + ROUNDING)
    few = f"It has {waypoints} waypoints; {MOST_WAYPOINTS} are allowed. How far from the route may a leg be?"
    return hints + [few] * (waypoints > MOST_WAYPOINTS)


def wrong_fence(mission: Mission, way: Route, city: City) -> list[str]:
    """Whether it has a fence that contains it and closes nothing that it crosses."""
    line, place = shapely.LineString(way.points[:, :2]), mission.place_on(city)
    hints = [] if any(polygon.inclusion for polygon in mission.fence) else ["It has no fence to stay inside of."]
    for polygon in mission.fence:
        area = polygon_on(place, polygon)
        if not area.is_valid:
            hints += [f"The polygon {polygon.name!r} of the fence crosses itself."]
        elif polygon.inclusion and not area.contains(line):
            hints += [f"It flies {line.difference(area).length:.1f} m outside of its fence."]
        elif not polygon.inclusion and area.intersects(line):
            hints += [
                f"It flies {line.intersection(area).length:.1f} m through {polygon.name!r}, which the fence closes."
            ]
    return hints
