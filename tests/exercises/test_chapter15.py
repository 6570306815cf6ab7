"""Exercises of chapter 15: other right forms pass, typical mistakes have words of their own."""

import math
from decimal import Decimal

import numpy as np
import pytest

from uavlab.city import table1_city
from uavlab.exercises import check
from uavlab.exercises.chapter15 import JUDGED, SHARES, another_sample, is_share, rule, with_ends
from uavlab.planners import astar, repare
from uavlab.statistics import over_maps, share_interval
from uavlab.trial import Claim, Measured, verdict


def test_flights_are_those_of_the_exact_interval():
    assert share_interval(0, 368)[1] <= 0.01 < share_interval(0, 367)[1]
    for answer in (368, 368.0, np.int64(368)):
        assert check("15.2", answer)
    for count, words in ((20, "more than one in a hundred"), (500, "fewer are enough")):
        assert words in check("15.2", count).hint


def rounded_half_up(printed, total):
    """The same by exact decimals."""
    digits = Decimal(1).scaleb(Decimal(printed).as_tuple().exponent)
    return any((Decimal(100 * k) / total).quantize(digits) == Decimal(printed) for k in range(total + 1))


def test_other_right_shares_pass():
    assert check("15.3", rounded_half_up)
    assert check("15.3", lambda printed, total: np.bool_(is_share(printed, total)))
    assert [is_share(*case) for case in SHARES[:3]] == [False] * 3
    assert sum(is_share(*case) for case in SHARES) == 8


def test_the_rule_is_the_librarys():
    for low, high, printed, line in JUDGED:
        side = "below" if float(printed) < line else "above"
        given = {"paper": "REPARE", "item": "Table 9", "says": "so", "why": "So.", "chapter": "07"}
        claim = Claim(**given, printed=printed, line=line, side=side)
        assert rule(low, high, printed, line) == verdict(claim, Measured((low + high) / 2, low, high, "some"))


def test_other_forms_of_the_rule_pass():
    assert check("15.4", lambda *case: rule(*case).upper())
    for answer in ("maybe", 1):
        assert "The answer is 'holds'" in check("15.4", lambda *case, answer=answer: answer).hint


def test_another_sample_by_hand():
    city = table1_city()
    pairs = city.random_pairs(100, 15, apart=40, min_clearance=4.5)
    ratio = np.array([repare(city, *pair, load=1.0).length / astar(city, *pair).length for pair in pairs])
    answer = (ratio.mean(), *over_maps(np.mean, ratio[:, None]))
    assert check("15.5", answer)
    assert check("15.5", np.round(answer, 4))
    assert answer[1] < 1.022 < answer[2]
    assert "isn't there" not in check("15.5", answer).hint


@pytest.mark.parametrize(
    "field",
    [
        {"push": 200.0, "reach": 2.0},
        {"push": 1000.0, "reach": 5.0, "attraction": "conic", "obstacles": "voxels"},
        {"push": 1000, "reach": 2, "obstacles": "surface"},
    ],
)
def test_other_fields_are_right(field):
    verdict_ = check("15.6", lambda: {"moves": "continuous"} | field)
    assert verdict_, verdict_


@pytest.mark.parametrize(
    ("field", "words"),
    [
        ([1, 2], "The answer is a dictionary"),
        ({"push": 5.0}, "`moves` among them"),
        ({"moves": "continuous", "strength": 5.0}, "doesn't take these arguments"),
        ({"moves": "continuous", "push": -1.0}, "doesn't take these arguments"),
        ({"moves": "continuous", "push": 500.0, "reach": 8.0}, "It arrives on"),
    ],
)
def test_fields_that_are_none(field, words):
    assert words in check("15.6", lambda: field).hint


def test_solutions_answer_examples(solutions):
    assert solutions["choice"] == "b"
    assert solutions["flights"] == 368
    assert solutions["could_be_a_share"]("42.9", 7)
    assert solutions["verdict_on"](0.90, 1.05, "0.952", 1.0) == "not shown"
    assert solutions["answer"][0] == pytest.approx(with_ends(another_sample()["heavy"] / another_sample()["A*"])[0])


def heavy():
    return another_sample()["heavy"] / another_sample()["A*"]


MISTAKES = {
    "15.2": {
        "One flight is missing": 367,
        "You put all 5 % to one end": 299,
        "the rule of three": 300,
        "ends at 97.5 %": 1,
    },
    "15.3": {
        "yes to everything": lambda printed, total: True,
        "You ask for equality": lambda printed, total: any(
            math.isclose(100 * k / total, float(printed), rel_tol=1e-12) for k in range(total + 1)
        ),
        "three digits always": lambda printed, total: any(
            round(100 * k / total, 3) == float(printed) for k in range(total + 1)
        ),
        "round to whole percent": lambda printed, total: any(
            round(100 * k / total) == round(float(printed)) for k in range(total + 1)
        ),
    },
    "15.4": {
        "for numbers below their line": lambda low, high, printed, line: (
            "doesn't" if low >= line else "not shown" if high >= line
            else "partly" if float(printed) > line else rule(low, high, printed, line)
        ),
        "the number alone": lambda low, high, printed, line: (
            found if (found := rule(low, high, printed, line)) in ("doesn't", "not shown")
            else "holds" if low <= float(printed) <= high else "partly"
        ),
        "the number before the line": lambda low, high, printed, line: (
            "holds" if low <= float(printed) + 0.5 * 10.0 ** -len(printed.partition(".")[2])
            and high >= float(printed) - 0.5 * 10.0 ** -len(printed.partition(".")[2])
            else rule(low, high, printed, line)
        ),
    },
    "15.5": {
        "with the light load": with_ends(another_sample()["light"] / another_sample()["A*"]),
        "the other way round": with_ends(1 / heavy()),
        "That is the median": with_ends(heavy(), np.median),
        "ratio of the mean lengths": [another_sample()["heavy"].mean() / another_sample()["A*"].mean(), 1.0, 1.1],
    },
    "15.6": {
        "moves on the lattice": lambda: {"moves": "lattice", "push": 5.0, "reach": 5.0},
        "doesn't take these arguments": lambda: {"moves": "continuous", "force": 5.0},
        "would have to be longer": lambda: {"moves": "continuous", "push": 5.0, "reach": 5.0},
    },
}  # fmt: skip
