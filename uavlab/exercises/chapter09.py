"""Exercises of chapter 9, the route of least risk: labels, a ground risk class, a search, a front, an abstract.

A hint says which mistake the answers look like and why it is one. Mistakes are recognised by what they answer, not
by how they are written.
"""

from __future__ import annotations

import heapq
import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from uavlab.exercises.hints import alike, recognised, recognised_value
from uavlab.exercises.kinds import Quiz, asks_for, asks_for_value, described, number, thing, whole_number
from uavlab.planners import least_risk
from uavlab.risk import CAMPUS_FLIGHT, RiskMap, random_campus, raw_igrc
from uavlab.route import Route

Label = tuple[float, float]
Roads = Mapping[Any, Mapping[Any, Label]]


exercise_1 = Quiz(
    right="b",
    because="B is both cheaper and shorter than C. Whatever C can become, B can become, too, for less of both.",
    wrong={
        "a": "A is the cheapest, but it is 9 long. Suppose that only 12 are allowed and the rest needs 4. Which labels "
        "could still arrive?",
        "c": "D leaves the most metres, but it costs the most. Which route does the search look for: the shortest, or "
        "the cheapest that is short enough?",
        "d": "Labels of one state can be continued in the same ways, at the same cost and length. Is there a pair of "
        "which one is better in both?",
    },
)


@asks_for(number("the class before it is rounded"))
def exercise_2(raw_class: Callable[[float, float], float]) -> str:
    """09.2: the ground risk class before rounding, from people per km² and the critical area."""
    answers = [raw_class(*case) for case in CLASS_CASES]
    if alike(answers, [class_of(*case) for case in CLASS_CASES]):
        return ""
    return recognised(answers, CLASS_MISTAKES, CLASS_CASES, alike) or (
        f"For 30 000 people per km² and 8 m² you get {answers[0]:.3f}. How many people per m² are that, how many of "
        "them are hit by a crash, and how often may it happen?"
    )


CLASS_CASES = [(30_000.0, 8.0), (500.0, 80.0), (5.0, 8.0), (20_000.0, 1.65)]


def class_of(people_per_km2: float, area: float) -> float:
    return float(raw_igrc(people_per_km2 / 1e6, area))


CLASS_MISTAKES: list[tuple[Callable[[float, float], float], str]] = [
    (lambda n, a: class_of(n, a) + 6, "Your class is too high by 6, which is log₁₀ of a million. Per what area are the "
     "people given, and in what is the critical area?"),
    (lambda n, a: class_of(n, a) + 3, "Your class is too high by 3, which is log₁₀ of a thousand. A square kilometre "
     "is a square with sides of 1000 m: how many m² has it?"),
    (lambda n, a: 2 - class_of(n, a), "You have more people and a lower class. Look at the sign before the logarithm."),
    (lambda n, a: class_of(n, a) - 1, "Your class is lower by exactly 1. A UAV that may fail in every hour, 10⁰, has "
     "class 1, not 0."),
    (lambda n, a: 1 + (class_of(n, a) - 1) * math.log(10), "A class more stands for ten times the people. For yours e "
     "times is enough: which logarithm is it?"),
    (lambda n, a: 10 ** (1 - class_of(n, a)), "That is how often the UAV may fail per hour. The class comes from its "
     "logarithm."),
]  # fmt: skip


def pairs(value: Any, arguments: tuple) -> str:
    """What is wrong with a list of pairs, if anything."""
    if isinstance(value, list | tuple) and all(isinstance(pair, list | tuple) and len(pair) == 2 for pair in value):
        return ""
    return f"{described(value)}. The answer is a list of pairs (cost, length)."


@asks_for(pairs, unchanged=True)
def exercise_3(worth_keeping: Callable[[Sequence[Label]], Sequence[Label]]) -> str:
    """09.3: the labels that no other one makes superfluous, from cheap to expensive."""
    answers = [worth_keeping(labels) for labels in LABEL_CASES]
    wanted = [kept_of(labels) for labels in LABEL_CASES]
    if same_pairs(answers, wanted):
        return ""
    if same_pairs([sorted(answer) for answer in answers], wanted):
        return "The right pairs, but not from cheap to expensive."
    if hint := recognised(answers, LABEL_MISTAKES, [(labels,) for labels in LABEL_CASES], same_pairs):
        return hint
    wrong = next(n for n, answer in enumerate(answers) if not same_pairs([answer], [wanted[n]]))
    return f"Of {LABEL_CASES[wrong]} you keep {[tuple(p) for p in answers[wrong]]}. Compare each pair with every other."


LABEL_CASES: list[list[Label]] = [
    [(5, 7), (8, 4), (3, 9), (6, 8)],
    [],
    [(2, 2)],
    [(4, 4), (4, 4)],
    [(4, 6), (4, 5), (5, 5)],
    [(1, 9), (2, 8), (3, 7), (4, 9)],
    [(9, 1), (1, 9), (5, 5), (6, 6), (5, 6), (7, 2)],
]


def same_pairs(answers: Sequence[Any], wanted: Sequence[Any]) -> bool:
    return [[tuple(pair) for pair in answer] for answer in answers] == [[tuple(p) for p in want] for want in wanted]


def kept_of(labels: Sequence[Label]) -> list[Label]:
    kept: list[Label] = []
    for cost, length in sorted(labels):
        if not kept or length < kept[-1][1]:
            kept.append((cost, length))
    return kept


def if_worse_in(labels: Sequence[Label], worse: Callable[[Label, Label], bool], once: bool = True) -> list[Label]:
    """The labels than which none is better in a way."""
    given = sorted(set(labels)) if once else sorted(labels)
    return [one for one in given if not any(worse(one, other) for other in labels)]


def beaten(one: Label, other: Label) -> bool:
    return other[0] <= one[0] and other[1] <= one[1] and other != one


LABEL_MISTAKES: list[tuple[Callable[[Sequence[Label]], Sequence[Label]], str]] = [
    (lambda labels: sorted(labels)[:1], "You keep the cheapest alone. With a limit on the length it may be too long: "
     "which others can be of use?"),
    (lambda labels: if_worse_in(labels, beaten, once=False), "(4, 4) is there twice, and you keep it twice. One of two "
     "equal pairs is enough."),
    (lambda labels: if_worse_in(labels, lambda a, b: b != a and (b[0] < a[0] or b[1] < a[1])), "You drop a pair when "
     "another is cheaper or shorter. It has to be both, or the cheapest pair rules out all others."),
    (lambda labels: if_worse_in(labels, lambda a, b: b[0] < a[0] and b[1] < a[1]), "(4, 5) costs as much as (4, 6) and "
     "is shorter, yet you keep both. What if two are equal in one of the two?"),
    (lambda labels: [(c, n) for c, n in sorted(labels, reverse=True) if not any(m < n for k, m in labels if k > c)],
     "You drop a pair for one that is shorter and more expensive. Which one has to be at most as expensive?"),
    (lambda labels: sorted(set(labels)), "You sort, and drop nothing but equal pairs. In the first case (5, 7) is both "
     "cheaper and shorter than (6, 8)."),
]  # fmt: skip


LIMITED: list[tuple[Roads, float, float, str]] = [
    ({"a": {"b": (1, 1)}, "b": {"c": (1, 1)}, "c": {}}, 2.0, 2.0,
     "a–b–c costs 2 and is exactly as long as the limit, 2: your cost is {}. A way that is as long as the limit may be "
     "flown."),
    ({"a": {"c": (1, 5), "b": (2, 1)}, "b": {"c": (2, 1)}, "c": {}}, 4.0, 4.0,
     "The direct way a–c costs 1 and is 5 long; 4 are allowed. Over b it is 2 long and costs 4: your cost is {}. Where "
     "does your search look at the limit?"),
    ({"a": {"c": (9, 4), "b": (1, 1)}, "b": {"c": (1, 1)}, "c": {}}, 5.0, 2.0,
     "a–c costs 9, a–b–c costs 2, and both are short enough. Your cost is {}. When is the cheapest way known: when the "
     "goal is put into the heap, or when it leaves it?"),
    ({"a": {"c": (9, 1), "b": (1, 2)}, "b": {"c": (1, 2)}, "c": {}}, 5.0, 2.0,
     "a–c costs 9 and is 1 long, a–b–c costs 2 and is 4 long; 5 are allowed. Your cost is {}. What is to be minimised: "
     "cost or length?"),
    ({"a": {"b": (1, 4), "x": (2, 1)}, "b": {"d": (1, 2)}, "x": {"d": (1, 1)}, "d": {"e": (1, 4)}, "e": {}}, 7.0, 4.0,
     "To d there are two ways: over b for 2, 6 long, and over x for 3, 2 long. From there it is 4 to e, and 7 are "
     "allowed: your cost is {}. Which of the two labels at d did you throw away?"),
    ({"a": {"b": (1, 1), "e": (9, 9)}, "b": {"e": (1, 9)}, "e": {}}, 5.0, math.inf,
     "No way is short enough: return math.inf. Your answer is {}."),
]  # fmt: skip
"""Roads, the greatest length, the cost from a to the last place, and what to ask a search with another cost."""


@asks_for(number("the cost of the cheapest way, math.inf where none is short enough"))
def exercise_4(search: Callable[[Roads, Any, Any, float], float]) -> str:
    """09.4: the cost of the cheapest way that is no longer than a limit."""
    for roads, longest, right, hint in LIMITED:
        cost = search(roads, "a", list(roads)[-1], longest)
        if cost != right:
            return hint.format(cost)
    for seed in range(30):
        roads = random_roads(seed)
        for longest in (9.0, 14.0, 25.0):
            cost, right = search(roads, 0, 8, longest), cheapest_within(roads, 0, 8, longest)
            if cost != right:
                return (
                    f"On a map of 9 places the cheapest way of at most {longest:g} costs {right:g}, yours {cost:g}. "
                    "When exactly do you drop a label?"
                )
    return ""


def random_roads(seed: int) -> Roads:
    """Roads between 9 places in a row, forwards, cheap ones being long."""
    rng = np.random.default_rng(seed)
    roads: dict[int, dict[int, Label]] = {place: {} for place in range(9)}
    for one, other in itertools.combinations(range(9), 2):
        if other - one <= 3:
            cost = int(rng.integers(1, 9))
            roads[one][other] = cost, 10 - cost + int(rng.integers(0, 3))
    return roads


def cheapest_within(roads: Roads, start: Any, goal: Any, longest: float) -> float:
    """Cost of the cheapest way that is short enough, by labels."""
    shortest: dict[Any, float] = {}
    waiting: list[tuple[float, float, Any]] = [(0, 0, start)]
    while waiting:
        cost, length, place = heapq.heappop(waiting)
        if place == goal:
            return cost
        if length >= shortest.get(place, math.inf):
            continue
        shortest[place] = length
        for neighbour, (more, further) in roads[place].items():
            if length + further <= longest:
                heapq.heappush(waiting, (cost + more, length + further, neighbour))
    return math.inf


TENTH = 12.65
"""By how many per cent a route is longer that has a tenth of the true risk."""
FRONT_MISTAKES: list[tuple[float, str]] = [
    (8.31, "There the true risk is a tenth of that of the tie-break's shortest route, or a fifth of C_0. C_0 is the "
     "least risk among the shortest: the first route of the front."),
    (4.16, "There it is a half of C_0, not a tenth."),
    (17.5, "There the true risk is a tenth of what the shortest route claims to have straight below. C_0 is its true "
     "risk."),
    (158.77, "That is the length in metres. By how many per cent of L_0 is it longer than L_0?"),
    (112.65, "That is the length in per cent of L_0. By how many per cent is it longer?"),
    (0.1265, "That is a share. The answer is in per cent."),
    (17.82, "That is the additional length in metres. In per cent of L_0?"),
    (34.1, "That is the end of the front without drift. Did you ask for `drift=True`?"),
]  # fmt: skip


@asks_for_value(number("how much longer the route is [%]"))
def exercise_5(longer_by: float) -> str:
    """09.5: how much longer a route must be for a tenth of the true risk."""
    value = float(longer_by)
    if abs(value - TENTH) <= 0.2 + 1e-9:
        return ""
    if hint := recognised_value(value, FRONT_MISTAKES, absolute=0.005):
        return hint
    if not value > 0:
        return "A shortest route has all of C_0, so the answer is above 0."
    if value < TENTH:
        return f"No route that is at most {value:g} % longer has so little true risk. Print the front's costs over C_0."
    return f"At {value:g} % the true risk is below a tenth, but so it is with less. Ask for more limits."


@asks_for_value(thing(tuple, "a tuple, (seed, blind, aware)"))
def exercise_6(abstract: tuple[Any, ...]) -> str:
    """09.6: a campus and two routes whose comparison is true and misleads."""
    if len(abstract) != 3:
        return f"Your tuple has {len(abstract)} parts. There are three: (seed, blind, aware)."
    seed, blind, aware = abstract
    for kind, value in (
        (whole_number("a seed from 0 to 199"), seed),
        (thing(Route, "a route, as `least_risk` gives"), blind),
        (thing(Route, "a route, as `least_risk` gives"), aware),
    ):
        if complaint := kind(value, ()):
            return f"One of the three parts is {complaint}"
    if not 0 <= seed < 200:
        return f"The seed is {seed}. Take one from 0 to 199."
    town = random_campus(int(seed))
    for name, route in (("blind", blind), ("aware", aware)):
        if hint := unflyable(town, name, route):
            return hint
    shortest = least_risk(town, *CAMPUS_FLIGHT, risk_weight=0.0, length_weight=1.0).length
    if blind.length > shortest + 1e-6:
        return f"`blind` is {blind.length:.2f} m long, and the shortest route on this campus is {shortest:.2f} m."
    if aware.length > 1.05 * blind.length + 1e-6:
        return f"`aware` is {aware.length / blind.length - 1:.1%} longer than `blind`; at most 5 % are promised."
    fair = least_risk(town, *CAMPUS_FLIGHT, max_length=shortest + 1e-6).cost
    promised, honest = (1 - town.integral(aware) / risk for risk in (town.integral(blind), fair))
    if promised < 0.85:
        return (
            f"The cut is {promised:.0%}; the abstract promises 85 %. Try other campuses, or look for a riskier route "
            "among the equally short ones."
        )
    if honest > 0.2:
        return (
            f"The cut is {promised:.0%}, but against the least risky shortest route it is still {honest:.0%}. That is "
            "a good detour. Look for a campus on which it is the baseline that is bad."
        )
    return ""


def unflyable(town: RiskMap, name: str, route: Route) -> str:
    """What is wrong with a route on a campus, if anything: ends, map, height."""
    if not route.reached:
        return f"`{name}` doesn't arrive: {route.reason}"
    ends = town.city.cell_of(route.points[[0, -1]])
    if (ends != town.city.cell_of(CAMPUS_FLIGHT)).any():
        return f"`{name}` doesn't lead from start to goal."
    index, length = route.voxels(town.city)
    if not town.flyable[tuple(index[length > 1e-9].T)].all():
        return f"`{name}` leaves what is flyable on campus {town.city.name}. Was it planned on another one?"
    return ""
