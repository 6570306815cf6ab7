"""Exercises of chapter 09: other ways to the answer pass; typical mistakes fail, each with a hint of its own."""

import heapq
import math

import numpy as np
import pytest

from uavlab.exercises import chapter09, check
from uavlab.planners import least_risk, pareto_front
from uavlab.risk import CAMPUS_FLIGHT, random_campus, reference_campus

START, GOAL = CAMPUS_FLIGHT


def class_by(per_km2=1e6, sign=-1, above=1, log=math.log10):
    return lambda people, area: above + sign * log(1e-6 / (people / per_km2 * area))


def keep_all_that(worse):
    return lambda labels: sorted({one for one in labels if not any(worse(one, other) for other in labels)})


def by_cost_and_length(one, other):
    return other != one and other[0] <= one[0] and other[1] <= one[1]


def search(roads, start, goal, longest, *, one=False, early=False, by=0, strict=False, late=False, none=math.inf):
    """A search with a limit that can be broken in several ways."""
    found, waiting = {}, [((0, 0), start)]
    while waiting:
        label, place = heapq.heappop(waiting)
        cost, length = label if by == 0 else label[::-1]
        if place == goal:
            return cost if not late or length <= longest else none
        mark = (cost, length)[0 if one else 1]
        if mark >= found.get(place, math.inf):
            continue
        found[place] = mark
        for neighbour, (more, further) in roads[place].items():
            new = cost + more, length + further
            if (new[1] >= longest if strict else new[1] > longest) and not late:
                continue
            if early and neighbour == goal:
                return new[0]
            heapq.heappush(waiting, (new if by == 0 else new[::-1], neighbour))
    return none


def broken(**mistake):
    return lambda *question: search(*question, **mistake)


def abstract(seed, extra=0.05, town=None, plan=None):
    campus = random_campus(seed if town is None else town)
    blind = least_risk(campus, START, GOAL, risk_weight=0.0, length_weight=1.0)
    if plan:
        blind = least_risk(campus, START, GOAL, max_length=plan * blind.length)
    return seed, blind, least_risk(campus, START, GOAL, max_length=(1 + extra) * blind.length + 1e-6)


MISTAKES = {
    "09.2": {
        "too high by 6": class_by(per_km2=1.0),
        "too high by 3": class_by(per_km2=1e3),
        "the sign before the logarithm": class_by(sign=1),
        "not 0": class_by(above=0),
        "which logarithm": class_by(log=math.log),
        "how often the UAV may fail": lambda people, area: 1e-6 / (people / 1e6 * area),
        "you get 6.000": lambda people, area: 6.0,
    },
    "09.3": {
        "the cheapest alone": lambda labels: sorted(labels)[:1],
        "you keep it twice": lambda labels: sorted(
            one for one in labels if not any(by_cost_and_length(one, other) for other in labels)
        ),
        "It has to be both": keep_all_that(lambda a, b: b != a and (b[0] < a[0] or b[1] < a[1])),
        "yet you keep both": keep_all_that(lambda a, b: b[0] < a[0] and b[1] < a[1]),
        "drop nothing but equal pairs": lambda labels: sorted(set(labels)),
        "not from cheap to expensive": lambda labels: keep_all_that(by_cost_and_length)(labels)[::-1],
        "Compare each pair with every other": lambda labels: [],
        "a list of pairs": lambda labels: [cost for cost, _ in labels],
    },
    "09.4": {
        "may be flown": broken(strict=True),
        "look at the limit": broken(late=True),
        "cost or length": broken(by=1),
        "when it leaves it": broken(early=True),
        "did you throw away": broken(one=True),
        "return math.inf": broken(none=-1),
    },
    "09.5": {
        "the tie-break's shortest": 8.31,
        "it is a half": 4.16,
        "claims to have straight below": 17.5,
        "the length in metres": 158.77,
        "the length in per cent of": 112.65,
        "The answer is in per cent": 0.1265,
        "additional length in metres": 17.83,
        "`drift=True`": 34.1,
        "above 0": -3,
        "so little true risk": 10.5,
        "Ask for more limits": 13.5,
    },
    "09.6": {
        "the shortest route on this campus": abstract(94, plan=1.1),
        "at most 5 % are promised": abstract(94, extra=0.2),
        "the abstract promises 85 %": abstract(0),
        "it is the baseline that is bad": abstract(39),
        "planned on another one": abstract(94, town=0),
        "from 0 to 199": (200, *abstract(94)[1:]),
        "One of the three parts": (94, 3, 4),
        "There are three": (94, 3),
    },
}


def test_the_broken_search_of_the_exercise_is_told_what_is_wrong(solutions):
    assert solutions["cheapest"](solutions["roads"], "depot", "museum", 7) == math.inf
    assert "did you throw away" in check("09.4", solutions["cheapest"]).hint


def test_search_without_a_mistake_is_right():
    assert check("09.4", search)


def test_labels_may_be_compared_pair_by_pair_and_be_lists():
    assert check("09.3", keep_all_that(by_cost_and_length))
    assert check("09.3", lambda labels: [list(pair) for pair in keep_all_that(by_cost_and_length)(labels)])


def test_class_by_natural_logarithms_is_right():
    assert check("09.2", lambda people, area: 1 + np.log(people * area) / np.log(10))


@pytest.mark.parametrize("longer_by", [12.6, 12.65, np.float64(12.8)])
def test_front_is_read_to_two_tenths(longer_by):
    assert check("09.5", longer_by)


def test_percentages_are_those_of_the_front():
    front = pareto_front(reference_campus(), START, GOAL, drift=True, lengths=400)
    enough = [next(r for r in front if r.cost <= share * front[0].cost) for share in (0.1, 0.5)]
    assert [100 * (r.length / front[0].length - 1) for r in enough] == pytest.approx([chapter09.TENTH, 4.16], abs=0.01)


def test_other_abstracts_that_mislead_are_right():
    assert check("09.6", abstract(94))
    assert check("09.6", abstract(94, extra=0.04))


def test_route_that_was_not_found_is_said():
    seed, blind, _ = abstract(94)
    none = least_risk(random_campus(94), START, GOAL, max_length=100)
    assert "doesn't arrive" in check("09.6", (seed, blind, none)).hint
