"""Exercises of chapter 7, REPARE: limits and prices, Table 3 as a score, a steady boundary, and a price that wins.

A hint says which mistake the answers look like and why it is one. Mistakes are recognised by what they answer, not
by how they are written.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import cache, partial
from itertools import product

import numpy as np

from uavlab.city import City, table1_city
from uavlab.exercises.hints import alike, each_alike, recognised
from uavlab.exercises.kinds import Quiz, asks_for, asks_for_value, is_number, number, numbers, parts
from uavlab.offsets import crossing_rate
from uavlab.planners import astar, repare, repulsion
from uavlab.resilience import DISTURBANCES, LEVELS, LOADS, ConditionCheck, resilience_level
from uavlab.route import Route

Vector = tuple[float, float]
Price = Callable[[float, float, Vector, Vector, float], float]

exercise_1 = Quiz(
    "b",
    "The zone has a price, and a price can be paid. In the middle of the street the walls' push is least, so the route "
    "runs there.",
    {
        "a": "That is what a limit would say, such as `min_clearance`. What does O_risk change in Eq. 2?",
        "c": "The price of a voxel depends on the walls beside it. Does it know whether there is another way?",
        "d": "An error comes only when the start or the goal itself lies in the zone. Where do they lie here?",
    },
)

ANGLES = np.linspace(0.0, 2 * np.pi, 9)
NORMALS: list[Vector] = [(float(np.cos(angle)), float(np.sin(angle))) for angle in ANGLES]
BEYOND = [(5.0, 3.5, (-0.4, 0.0), (1.0, 0.0), 0.6), (9.0, 5.5, (0.2, 0.1), (0.0, 1.0), 0.9)]
CALM = [(d, 5.5, (0.0, 0.0), (1.0, 0.0), load) for d in (0.5, 1.5, 2.5, 3.5, 4.5) for load in (0.5, 0.9)]
CALM += [(d, 3.5, (0.0, 0.0), (1.0, 0.0), 0.6) for d in (0.5, 1.5, 3.0)]
WINDY = [(d, 5.5, (0.4, -0.1), normal, 0.6) for d in (1.5, 3.5, 4.5) for normal in NORMALS]


@asks_for(number("the price of a metre"))
def exercise_2(price: Price) -> str:
    """07.2: the price of a metre near a wall, with wind and load."""
    in_calm = [price(*case) for case in CALM]
    if not alike(in_calm, [right_price(*case) for case in CALM]):
        without_wind = [(d, keep, load) for d, keep, _, _, load in CALM]
        return recognised(in_calm, CALM_MISTAKES, without_wind, alike) or (
            f"For {CALM[2][0]} m from a wall, D_min = 5.5 m, no wind and λ_G = 0.5 you get {float(in_calm[2]):.3f}. "
            "Write the reasons in the bracket of Eq. 8 one below the other: how large is each?"
        )
    outside = [price(*case) for case in BEYOND]
    if not np.allclose(outside, 1.0):
        return (
            f"In the zone it is right. At {BEYOND[0][0]} m, with D_min = {BEYOND[0][1]} m, you get "
            f"{float(outside[0]):.3f}: what is O_risk there?"
        )
    in_wind = [price(*case) for case in WINDY]
    if alike(in_wind, [right_price(*case) for case in WINDY]):
        return ""
    return recognised(in_wind, WIND_MISTAKES, WINDY, alike) or (
        "Without wind it is right. With wind: which part of it points towards the wall, and what does the rest do?"
    )


def pushed(distance: float, keep: float) -> float:
    return float(repulsion(distance, keep**3 / 4, keep))


def right_price(distance: float, keep: float, wind: Vector, normal: Vector, load: float) -> float:
    if distance >= keep:
        return 1.0
    return 1 + 2 * (1 + pushed(distance, keep) + max(0.0, -float(np.dot(wind, normal))) + load)


CALM_MISTAKES: list[tuple[Callable[[float, float, float], float], str]] = [
    (
        lambda d, keep, load: 2 * (1 + pushed(d, keep) + load),
        "That is ω. A metre also costs what it costs outside the zone.",
    ),
    (
        lambda d, keep, load: 1 + 2 * (pushed(d, keep) + load),
        "At the edge of your zone the wall's push is 0, and a UAV without weight would pay nothing. Which reason in "
        "the bracket doesn't depend on anything?",
    ),
    (
        lambda d, keep, load: 1 + 2 * (1 + pushed(d, keep)),
        "The load is missing: two UAVs of different weight pay the same.",
    ),
    (
        lambda d, keep, load: 1 + 1 + pushed(d, keep) + load,
        "The bracket is right. How is it weighed: where is ω₀?",
    ),
    (
        lambda d, keep, load: 1 + 2 * (1 + keep**3 / 4 * (1 / d - 1 / keep) + load),
        "Your push isn't the gradient of the potential: Eq. 4 has another factor that depends on the distance.",
    ),
    (
        lambda d, keep, load: 1 + 2 * (1 + (1 / d - 1 / keep) / d**2 + load),
        "You take k_rep for 1. It depends on D_min.",
    ),
]

WIND_MISTAKES: list[tuple[Price, str]] = [
    (
        lambda d, keep, wind, normal, load: (
            1 + 2 * (1 + pushed(d, keep) + max(0.0, float(np.dot(wind, normal))) + load)
        ),
        "You charge for wind away from the wall, and not for wind towards it. Where does n point?",
    ),
    (
        lambda d, keep, wind, normal, load: 1 + 2 * (1 + pushed(d, keep) - float(np.dot(wind, normal)) + load),
        "Wind away from the wall makes your metre cheaper. What does Eq. 8 do with wind that helps?",
    ),
    (
        lambda d, keep, wind, normal, load: 1 + 2 * (1 + pushed(d, keep) + abs(float(np.dot(wind, normal))) + load),
        "Wind away from the wall costs you as much as wind towards it. Only one of them is dangerous.",
    ),
    (
        lambda d, keep, wind, normal, load: 1 + 2 * (1 + pushed(d, keep) + math.hypot(*wind) + load),
        "You take the whole wind. Wind along the wall doesn't bring the UAV nearer to it.",
    ),
    (
        lambda d, keep, wind, normal, load: (
            1 + 2 * (1 + load + math.hypot(*(pushed(d, keep) * n + w for n, w in zip(normal, wind, strict=True))))
        ),
        "You take the size of the sum of two forces. That is way 2: look at what it does when they point against each "
        "other.",
    ),
    (
        lambda d, keep, wind, normal, load: right_price(d, keep, (0.0, 0.0), normal, load),
        "Without wind it is right, and with wind it is the same: where is F_dist?",
    ),
]


@asks_for(parts(3, "points by load, points by disturbance, and four thresholds"))
def exercise_3(score: Callable[[], tuple[Mapping[str, float], Mapping[str, float], Sequence[float]]]) -> str:
    """07.3: points for loads and disturbances and thresholds that give Table 3."""
    answer = score()
    loads, disturbances, thresholds = answer
    if not all(isinstance(points, Mapping) for points in (loads, disturbances)) or np.ndim(thresholds) != 1:
        return "The points are two dictionaries, with a number for each name; the thresholds are a list."
    for what, given, wanted in (("load", loads, LOADS), ("disturbance", disturbances, DISTURBANCES)):
        missing = [name for name in wanted if name not in given]
        if missing:
            return f"There are no points for the {what} {missing[0]!r}."
        unknown = [name for name in wanted if not is_number(given[name])]
        if unknown:
            return f"The points for the {what} {unknown[0]!r} are no number."
    if len(thresholds) != 4:
        return f"Five levels have four thresholds between them; you have {len(thresholds)}."
    if list(thresholds) != sorted(thresholds):
        return "The thresholds must rise, from that of 'lower' to that of 'grounded'."
    wrong = []
    for load, disturbance in product(LOADS, DISTURBANCES):
        points = loads[load] + disturbances[disturbance]
        level, wanted_level = LEVELS[sum(points >= t for t in thresholds)], resilience_level(load, disturbance)
        if level != wanted_level:
            wrong.append((load, disturbance, points, level, wanted_level))
    if not wrong:
        return ""
    if all(LEVELS.index(level) == LEVELS.index(wanted) - 1 for *_, points, level, wanted in wrong) and all(
        points in thresholds for _, _, points, _, _ in wrong
    ):
        return "A sum that equals a threshold belongs to the level above it."
    load, disturbance, points, level, wanted_level = wrong[0]
    return (
        f"{16 - len(wrong)} of 16 are right. The sum for {load} load in {disturbance} disturbance is {points:g}: "
        f"that is {level!r}; Table 3 has {wanted_level!r}. Which entries with that level have a sum like it?"
    )


@asks_for(numbers(lambda offsets, *_: (len(offsets),), "a list with a boundary for each offset"))
def exercise_4(boundaries: Callable[[Sequence[float], float, float, int, float], Sequence[float]]) -> str:
    """07.4: the boundary after each offset, raised at once and lowered late."""
    cases = [[1, 2.7, 1, 1, 1, 1], *([float(o) for o in offsets_seen(seed)] for seed in range(6))]
    answers = [np.asarray(boundaries(case, 2.0, 0.5, 3, 0.8), dtype=float) for case in cases]
    same = partial(each_alike, same=np.allclose)
    if same(answers, [checked(case) for case in cases]):
        return ""
    if hint := recognised(answers, BOUNDARY_MISTAKES, [(case,) for case in cases], same):
        return hint
    case, answer = next((c, a) for c, a in zip(cases, answers, strict=True) if not np.allclose(a, checked(c)))
    first = int(np.argmax(~np.isclose(answer, checked(case))))
    before = checked(case)[first - 1] if first else 2.0
    return (
        f"After {', '.join(f'{offset:.2f}' for offset in case[max(first - 3, 0) : first + 1])} m (the last offsets, up "
        f"to number {first + 1}) the boundary of {before:g} m should {'rise' if case[first] > before else 'not be'}"
        f"{'' if case[first] > before else f' {answer[first]:g} m'}. Go through the three rules for this moment."
    )


def offsets_seen(seed: int) -> np.ndarray:
    """Offsets of a flight with a gusty part in the middle [m], no two rules at a tie."""
    rng = np.random.default_rng(800 + seed)
    gusty = np.concatenate([np.full(10, 0.6), np.full(10, 2.2), np.full(40, 0.9)])
    return np.abs(rng.normal(0.0, gusty)).round(3) + 3e-4


def checked(case: Sequence[float]) -> list[float]:
    check = ConditionCheck(predicted=2.0, step=0.5, hold=3.0, release=0.8)
    return [check.observe(float(moment), float(offset)) for moment, offset in enumerate(case)]


def walked(
    case: Sequence[float],
    *,
    hold: int = 3,
    lower_by: int = 1,
    release: float = 0.8,
    one_step: bool = False,
    floor: bool = True,
    calm_of_boundary: bool = False,
    in_a_row: bool = True,
    fresh: bool = True,
) -> list[float]:
    """The boundary by rules that may be wrong."""
    steps, calm, history = 0, 0, []
    for offset in case:
        boundary = 2.0 + 0.5 * steps
        is_calm = offset < release * (boundary if calm_of_boundary else boundary - 0.5)
        calm = calm + 1 if is_calm else 0 if in_a_row else calm
        if offset > boundary:
            steps, calm = (steps + 1 if one_step else math.ceil((offset - 2.0) / 0.5)), 0
        elif (steps > 0 or not floor) and calm >= hold:
            steps, calm = (max(steps - lower_by, 0) if floor else steps - lower_by), 0 if fresh else calm
        history.append(2.0 + 0.5 * steps)
    return history


BOUNDARY_MISTAKES: list[tuple[Callable[[Sequence[float]], list[float]], str]] = [
    (partial(walked, hold=10**6),
     "Your boundary never comes down: one gust in the first minute, and the whole flight is as careful as "
     "that."),
    (partial(walked, hold=1),
     "It comes down after the first calm observation, so it will jump up and down. How many have to be calm, "
     "one after another?"),
    (partial(walked, one_step=True),
     "After a large offset your boundary is still below it. By how many steps does it have to rise?"),
    (partial(walked, floor=False), "In a long calm your boundary falls below what was predicted."),
    (partial(walked, lower_by=10**6), "It comes down to the prediction at once. Down it goes by one step at a time."),
    (partial(walked, calm_of_boundary=True),
     "You call an offset calm when it is well below the boundary that holds. It would then be near the lower "
     "one and push it up again: calm must be measured there."),
    (partial(walked, release=1.0),
     "You compare with the lower boundary itself. An offset just below it would soon exceed it: what is "
     "`release` for?"),
    (partial(walked, in_a_row=False),
     "You count all calm observations since the last change. They have to follow each other: what does a gust "
     "between them do to the count?"),
    (partial(walked, fresh=False), "After one step down the next follows at once. From what is the calm counted?"),
]  # fmt: skip


SMALLEST = 0.1340
"""ω₀ [1] from which on the route out of the notch keeps 3.5 m."""


@asks_for_value(number("the smallest weight ω₀"))
def exercise_5(weight: float) -> str:
    """07.5: the smallest weight with which the route out of the notch keeps 3.5 m."""
    weight = float(weight)
    if abs(weight / SMALLEST - 1) <= 0.05:
        return ""
    if not weight > 0:
        return "Without a weight above 0 the zone has no price, and REPARE is plain A*."
    if math.isclose(weight, 71.213 / 66.385, rel_tol=2e-3) or math.isclose(weight, 71.213 / 66.385 - 1, rel_tol=2e-2):
        return (
            "That is how much longer the safe route is. The weight counts metres in the zone, and only some of the "
            "way through the notch lies in it."
        )
    if weight > 2 * SMALLEST:
        return f"With ω₀ = {weight:g} it keeps 3.5 m, and with half of that, too. Go on halving."
    if weight > SMALLEST:
        return f"With ω₀ = {weight:g} it keeps 3.5 m. A somewhat smaller one does, too: look between two tries."
    route = repare(test_city(), (90, 18, 30), (50, 44, 30), penalty=weight)
    return f"With ω₀ = {weight:g} the route comes to {route.clearance(test_city()):.1f} m: it pays and enters the zone."


@cache
def test_city() -> City:
    return table1_city()


@cache
def asked() -> tuple[list, float, float]:
    """Pairs that plain A* brings near a wall, and how REPARE does on them."""
    city = test_city()
    drawn = city.random_pairs(60, 9, apart=40, min_clearance=6.5)
    pairs = [pair for pair in drawn if astar(city, *pair).clearance(city) <= 0.5][:16]
    return pairs, *judged([repare(city, *pair) for pair in pairs])


def judged(routes: list[Route]) -> tuple[float, float]:
    """Mean length [m], and wall touches to be expected on 1 000 flights at σ = 1 m and 5 m/s."""
    city, touched = test_city(), 0.0
    for route in routes:
        index, metres = city.voxels_along(route.points)
        room = np.maximum(city.distance(city.center_of(index), exact_within=20.0) - 0.5, 0.0)
        touched += float(crossing_rate(room, 1.0) @ metres / 5.0)
    return float(np.mean([route.length for route in routes])), 1000 * touched / len(routes)


@asks_for(numbers(lambda distance: np.shape(distance), "an array with a price for each distance"))
def exercise_6(own_price: Callable[[np.ndarray], np.ndarray]) -> str:
    """07.6: a price with which routes are no longer than REPARE's and touched less often."""
    city = test_city()
    distance, voxel = np.unique(city.clearance[~city.occupied], return_inverse=True)
    found = np.asarray(own_price(distance), dtype=float)
    bad = ~(np.isfinite(found) & (found >= 1))
    if bad.any():
        return (
            f"At {distance[bad][0]:.2f} m your price is {found[bad][0]:.3g}. A* is exact only if no metre costs less "
            "than its length, and an endless price is none."
        )
    price = np.ones(city.shape)
    price[~city.occupied] = found[voxel.reshape(-1)]
    pairs, length, touches = asked()
    own_length, own_touches = judged([astar(city, *pair, price=price) for pair in pairs])
    if own_length <= length + 1e-6 and own_touches <= 2 / 3 * touches:
        return ""
    said = (
        f"Your routes: {own_length:.2f} m on average, {own_touches:.2f} touches per 1 000 flights; REPARE's: "
        f"{length:.2f} m, {touches:.2f}. "
    )
    if np.allclose(found, found[0]):
        return said + "Your price is the same everywhere, so distance doesn't count."
    if own_touches <= 2 / 3 * touches:
        return said + "Safe enough, but too long. Where do your routes keep away farther than they need to?"
    if own_length <= length + 1e-6:
        return said + "Short enough, but touched too often. Which distances are too cheap?"
    return said + "Both are worse. Does your price fall with the distance, and how far does it reach?"
