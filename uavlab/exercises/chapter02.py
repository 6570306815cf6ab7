"""Exercises of chapter 2, the Pauta criterion: what 3σ promises, in the plane and over a flight, and when it fails.

A hint says which mistake the answers look like and why it is one. Mistakes are recognised by what they answer, not
by how they are written.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

import numpy as np

from uavlab.exercises.hints import alike, recognised
from uavlab.exercises.kinds import Quiz, asks_for, asks_for_value, number, numbers
from uavlab.offsets import collision_probability, coverage, minimum_safe_distance, pauta_filter, pauta_radius

Vector = tuple[float, float]
RADII = (0.5, 1.0, 2.0, 3.0, 4.0)

same_distances = partial(alike, relative=2e-4)  # the radius may be rounded to 3.439
same_times = partial(alike, relative=2e-3, absolute=1e-3)

exercise_1 = Quiz(
    right="b",
    because="One side of one axis at one moment: half of 0.27 %. How many flights touch depends on how long they are.",
    wrong={
        "a": "99.73 % counts moments, not flights. A flight has many moments, and touches if one of them is bad.",
        "c": "0.27 % counts both sides. What does an offset away from the wall do?",
        "d": "A Gaussian has no end: 1 moment in 741 lies beyond 3σ on that side. Calling it an error doesn't stop it.",
    },
)
"""02.1: what 3σ promises beside a wall."""


@asks_for(number("a probability, from 0 to 1"))
def exercise_2(coverage_in_the_plane: Callable[[float], float]) -> str:
    """02.2: the probability that an offset in the plane lies within k standard deviations."""
    answers = [coverage_in_the_plane(k) for k in RADII]
    if alike(answers, coverage(RADII, 2)):
        at_zero = coverage_in_the_plane(0.0)
        return "" if math.isclose(at_zero, 0.0, abs_tol=1e-9) else "A circle of radius 0 holds nothing."
    return recognised(answers, PLANE_MISTAKES, [(k,) for k in RADII], alike) or (
        f"For k = 3 you get {float(answers[3]):.4f}. Cut the circle into rings: how large is the ring from s to "
        "s + ds, and how high is the density on it?"
    )


PLANE_MISTAKES: list[tuple[Callable[[float], float], str]] = [
    (
        lambda k: float(coverage(k, 1)),
        "That is one axis. An offset of 2.5σ east and 2.5σ north is within 3σ on each axis: is it in the circle?",
    ),
    (
        lambda k: float(coverage(k, 1)) ** 2,
        "That is a square of side 2kσ: both offsets within kσ. Its corners are farther from the route than kσ.",
    ),
    (
        lambda k: float(coverage(k, 3)),
        "That is the ball in three dimensions. The plane has two axes.",
    ),
    (
        lambda k: math.exp(-(k**2) / 2),
        "That is the chance to be outside of the circle: it falls with k.",
    ),
    (
        lambda k: 1 - math.exp(-(k**2)),
        "Almost: which power of e is in the Gaussian density, −s² or −s²/2?",
    ),
    (
        lambda k: k * math.exp(-(k**2) / 2),
        "That is the density of the distance at k. A probability is its integral, from 0 to k.",
    ),
    (
        lambda k: 100 * float(coverage(k, 2)),
        "Right, in per cent. The exercise asks for a probability, from 0 to 1.",
    ),
]


@asks_for(number("the distance [m]"))
def exercise_3(safe_distance: Callable[[float, float, Vector, Vector], float]) -> str:
    """02.3: the distance to keep when gusts push in the plane, widened towards the wind."""
    calm = [(sigma, body, (0.0, 0.0), (1.0, 0.0)) for sigma in (0.5, 1.0, 2.0) for body in (0.4, 1.0)]
    angles = np.linspace(0.0, 2 * np.pi, 13)
    normals: list[Vector] = [(float(np.cos(angle)), float(np.sin(angle))) for angle in angles]
    windy = [
        (sigma, 0.6, mean, normal) for sigma in (0.7, 1.4) for mean in ((1.5, 0.0), (-0.4, 1.1)) for normal in normals
    ]
    in_calm = [safe_distance(*case) for case in calm]
    if not same_distances(in_calm, [widened(*case) for case in calm]):
        return recognised(in_calm, CALM_MISTAKES, [case[:2] for case in calm], same_distances) or (
            f"For σ = 1 m, a body of 1 m and no wind you get {float(in_calm[3]):.3f} m. Which radius holds 99.73 % in "
            "the plane, and how far does the body reach from its centre?"
        )
    in_wind = [safe_distance(*case) for case in windy]
    if same_distances(in_wind, [widened(*case) for case in windy]):
        return ""
    return recognised(in_wind, WIND_MISTAKES, windy, same_distances) or (
        "Without wind it is right. With wind: which part of the mean offset points towards the wall?"
    )


def widened(sigma: float, body: float, mean: Vector, normal: Vector) -> float:
    return float(minimum_safe_distance(pauta_radius(2) * sigma, body, mean_offset=mean, normal=normal))


def widened_by(part: Callable[[Vector, Vector], float]) -> Callable[[float, float, Vector, Vector], float]:
    """The distance without wind, and some part of the mean offset on top."""
    return lambda sigma, body, mean, normal: widened(sigma, body, (0.0, 0.0), normal) + part(mean, normal)


CALM_MISTAKES: list[tuple[Callable[[float, float], float], str]] = [
    (
        lambda sigma, body: 3 * sigma + body / 2,
        "You take 3σ. In the plane that leaves out 1.11 %, not 0.27 %: turn your formula of 02.2 round.",
    ),
    (
        lambda sigma, body: pauta_radius(3) * sigma + body / 2,
        "You take the radius of a ball in three dimensions. These gusts push in the plane.",
    ),
    (
        lambda sigma, body: pauta_radius(2) * sigma + body,
        "The radius k is right. The route is that of the body's centre: how much of the body is on the wall's side?",
    ),
    (
        lambda sigma, body: pauta_radius(2) * sigma,
        "That keeps the centre away from the wall. The body has a width.",
    ),
    (
        lambda sigma, body: pauta_radius(2) * sigma**2 + body / 2,
        "You multiply k by σ². Look at the units: what is in metres?",
    ),
]

WIND_MISTAKES: list[tuple[Callable[[float, float, Vector, Vector], float], str]] = [
    (
        widened_by(lambda mean, normal: 0.0),
        "Without wind it is right, and with wind you get the same: what does the mean offset do to the margin?",
    ),
    (
        widened_by(lambda mean, normal: max(0.0, float(np.dot(mean, normal)))),
        "You widen where the wind blows away from the wall. `normal` points away from it: which sign has wind towards "
        "it?",
    ),
    (
        widened_by(lambda mean, normal: -float(np.dot(mean, normal))),
        "Towards the wall it is right. Where the wind blows away you make the distance smaller: it may drop.",
    ),
    (
        widened_by(lambda mean, normal: float(np.dot(mean, normal))),
        "Your distance shrinks where the wind blows towards the wall. `normal` points away from it.",
    ),
    (
        widened_by(lambda mean, normal: abs(float(np.dot(mean, normal)))),
        "You widen on both sides of the wind. Does wind away from the wall bring the UAV nearer to it?",
    ),
    (
        widened_by(lambda mean, normal: float(np.hypot(*mean))),
        "You add the whole mean offset at every wall. Along the wall it does no harm: which part points towards it?",
    ),
]


@asks_for(number("the time [s]"))
def exercise_4(longest_time: Callable[[float, float, float, float, float], float]) -> str:
    """02.4: how long a UAV may fly beside a wall, so that it touches it with at most a given chance."""
    usual = [
        (distance, 1.0, 1.0, omega, chance)
        for distance in (4.5, 5.0, 5.5)
        for omega in (1.0, 2.0)
        for chance in (0.01, 0.3)
    ]
    wider = [(6.0, 0.6, 1.3, 0.7, 0.02), (3.0, 0.4, 0.6, 1.4, 0.05), (9.0, 2.0, 1.7, 1.0, 0.01)]
    near = [(distance, 1.0, 1.0, 1.0, chance) for distance, chance in ((1.8, 0.2), (2.0, 0.3), (1.5, 0.5))]
    hopeless = [(3.5, 1.0, 1.0, 1.0, 0.001), (1.0, 1.0, 1.0, 1.0, 0.1)]
    answers = [longest_time(*case) for case in [*usual, *wider, *near]]
    if not same_times(answers, [seconds_until(*case) for case in [*usual, *wider, *near]]):
        if same_times(answers[: len(usual)], [seconds_until(*case) for case in usual]) and not same_times(
            answers[: len(usual) + len(wider)], [seconds_until(*case) for case in [*usual, *wider]]
        ):
            return "It is right for a body of 1 m and σ = 1 m, and wrong for others: where do they enter?"
        if same_times(answers, [-seconds_until(*case) for case in [*usual, *wider, *near]]):
            return "The sign is the wrong way round: ln(a/b) is −ln(b/a)."
        return recognised(answers, TIME_MISTAKES, [*usual, *wider, *near], same_when_above_0) or (
            f"At 5 m, for a body of 1 m, σ = 1 m, 1 rad/s and a chance of 0.01, you get {float(answers[4]):.4g} s; put "
            "that time into Eq. 15, and see which chance comes out."
        )
    too_near = [float(longest_time(*case)) for case in hopeless]
    if any(seconds != 0.0 for seconds in too_near):
        return (
            f"For {hopeless[0]} you get {too_near[0]:.3g} s. There one moment is already likelier to touch than is "
            "allowed: the answer is 0."
        )
    return ""


def seconds_until(distance: float, body: float, sigma: float, omega: float, chance: float) -> float:
    """Eq. 15 solved for the time [s]; negative where one moment is too much."""
    z = (distance - body / 2) / sigma
    return inside(z) / crossings(z, omega) * math.log(inside(z) / (1 - chance))


def same_when_above_0(some: list[float], others: list[float]) -> bool:
    """Whether times are the same; what is negative may have been made 0."""
    return same_times(np.maximum(some, 0.0), np.maximum(others, 0.0))


def inside(z: float) -> float:
    return 0.5 * math.erfc(-z / math.sqrt(2))


def crossings(z: float, omega: float) -> float:
    return omega / (2 * math.pi) * math.exp(-(z**2) / 2)


def by_bound(distance: float, body: float, sigma: float, omega: float, chance: float) -> float:
    z = (distance - body / 2) / sigma
    return (chance - 1 + inside(z)) / crossings(z, omega)


def without_start(distance: float, body: float, sigma: float, omega: float, chance: float) -> float:
    return -math.log(1 - chance) / crossings((distance - body / 2) / sigma, omega)


def without_share(distance: float, body: float, sigma: float, omega: float, chance: float) -> float:
    z = (distance - body / 2) / sigma
    return math.log(inside(z) / (1 - chance)) / crossings(z, omega)


TIME_MISTAKES: list[tuple[Callable[[float, float, float, float, float], float], str]] = [
    (
        lambda distance, body, *others: seconds_until(distance, 0.0, *others),
        "You leave the body out. The route is that of its centre: how much of it is on the wall's side?",
    ),
    (
        lambda distance, body, *others: seconds_until(distance, 2 * body, *others),
        "You take away the whole body. The route is that of its centre: only half of it is on the wall's side.",
    ),
    (
        lambda *case: seconds_until(*case) / (2 * math.pi),
        "You cross 2π times as often as Rice does. `omega` is in rad/s: how many turns per second is that?",
    ),
    (
        without_start,
        "You take 1 − exp(−νt) for the chance. A flight may be in the wall at its very start: look at q in Eq. 15.",
    ),
    (
        without_share,
        "Almost: in Eq. 15 the power of e is −νt/q, and you take −νt. It matters where the wall is near.",
    ),
    (
        by_bound,
        "That is the bound (1 − q) + νt. It is safe, but for large chances it is shorter than it need be: use the left "
        "side of Eq. 15.",
    ),
]


@asks_for_value(number("a share of all samples, from 0 to 1"))
def exercise_5(share: float) -> str:
    """02.5: from which share of wrong samples in one place on the filter finds none of them."""
    share = float(share)
    if 0.095 <= share <= 0.105:
        return ""
    if 9.5 <= share <= 10.5:
        return "Right, in per cent. Give it as a number from 0 to 1."
    if not 0 < share < 1:
        return f"A share of all samples lies between 0 and 1, and {share:g} doesn't."
    if abs(share - 1 / 9) < 0.002:
        return "That is wrong samples over good ones, 1 in 9. The question is for their share of all samples."
    if abs(share - 0.5) < 0.01:
        return "Half is what a median bears. This filter uses a mean and a σ, which the errors drag along: try 0.4."
    if abs(share - 0.0027) < 0.0002:
        return "0.27 % is how many *good* samples the filter removes. Vary the share of the wrong ones."
    seen = share_found(share)
    if seen > 0:
        return f"With {share:.3g} of the samples wrong, the filter still finds {seen:.0%} of them: go higher."
    return f"With {share:.3g} the filter is blind indeed, but it is so earlier: go lower until it finds some."


def share_found(share: float) -> float:
    """Of gross errors that all lie at 1000 m, by the filter, among 10 000 samples."""
    wrong = min(max(round(10_000 * share), 1), 9_990)
    good = np.random.default_rng(25).normal(0.0, 1.0, 10_000 - wrong)
    return float(1 - pauta_filter(np.append(good, np.full(wrong, 1000.0))).kept[len(good) :].mean())


@asks_for_value(numbers((2,), "two numbers: the distance from the western wall [m] and the speed [m/s]"))
def exercise_6(plan: Vector) -> str:
    """02.6: where and how fast to fly through a street with wind across."""
    from_west, speed = (float(part) for part in plan)
    if not 0.5 < from_west < 11.5:
        return f"At {from_west:g} m from the western wall, a body of 1 m doesn't fit between the walls, 12 m apart."
    if not 0 < speed <= 5:
        return f"The speed must be above 0 and at most 5 m/s, you fly {speed:g} m/s."
    west, east = touches(from_west, speed)
    if west + east <= 0.001:
        return ""
    where = f"{1000 * west:.3g} in the west and {1000 * east:.3g} in the east"
    said = f"{1000 * (west + east):.3g} of 1000 flights touch, {where}."
    if sum(touches(5.0, speed)) > 0.001:
        return (
            f"{said} No route is good enough at {speed:g} m/s: how does the chance change with the time in the street?"
        )
    if abs(from_west - 6) < 0.05:
        return f"{said} You fly in the middle of the street. Where does the wind hold the UAV then?"
    if from_west > 6:
        return (
            f"{said} You fly nearer to the eastern wall, and the wind pushes east, too. (`from_west` is from the west.)"
        )
    return f"{said} Which wall is the worse one? Move away from it until both are equally likely."


def touches(from_west: float, speed: float) -> Vector:
    """Chances to touch the western and the eastern wall, by Eq. 15."""
    west, east = (
        float(collision_probability(distance, 1.2, 300.0 / speed, 1.0, uav_diameter=1.0, mean_away=away))
        for distance, away in ((from_west, 1.0), (12.0 - from_west, -1.0))
    )
    return west, east
