"""Exercises of chapter 15, the papers on trial: what an interval says, a rule of one's own, digits, a field of Table 2.

A hint says which mistake the answers look like and why it is one. Mistakes are recognised by what they answer, not
by how they are written.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import cache, partial
from typing import Any

import numpy as np

from uavlab.city import City, table1_city
from uavlab.exercises.hints import alike, recognised, recognised_value
from uavlab.exercises.kinds import Quiz, asks_for, asks_for_value, described, numbers, truth, whole_number
from uavlab.planners import astar, potential_field, repare
from uavlab.statistics import over_maps

exercise_1 = Quiz(
    right="b",
    because="The line 0 lies in the interval and the number 80 doesn't. Two questions, two answers.",
    wrong={
        "a": "A route with 37 % less risk lies in the interval, too. Does the interval say that there is no gain?",
        "c": "Partly means that the direction is shown. Which values does the interval leave open?",
        "d": "A measurement was made, and it rules something out. What lies beyond the interval's upper end?",
    },
)

SAFE, MOST = 0.975, 0.01


@asks_for_value(whole_number("a number of flights"))
def exercise_2(flights: float) -> str:
    """15.2: how many flights without a crash show that at most one in a hundred crashes."""
    needed = math.log(1 - SAFE) / math.log(1 - MOST)
    if flights == math.ceil(needed):
        return ""
    if hint := recognised_value(flights, FLIGHTS_NEEDED, relative=0.0, absolute=0.5):
        return hint
    end = 1 - (1 - SAFE) ** (1 / flights) if flights > 0 else 1.0
    few = "more than one" if end > MOST else "less than one, so that fewer are enough"
    return f"After {flights:g} flights without a crash the interval ends at {end:.4%}. That is {few} in a hundred."


FLIGHTS_NEEDED = [
    (math.floor(math.log(1 - SAFE) / math.log(1 - MOST)), "One flight is missing: with so many the interval still "
     "ends above 1 %, if only just."),
    (math.ceil(math.log(0.05) / math.log(1 - MOST)), "You put all 5 % to one end. This interval leaves 2.5 % beyond "
     "each end."),
    (100, "One crash in a hundred on average: with a hundred flights, that happens to be none in 37 of 100 cases."),
    (300, "That is the rule of three, 3/n. It is for 5 % beyond one end, and this interval has 2.5 %."),
    (1, "The interval of one flight ends at 97.5 %."),
]  # fmt: skip

SHARES = [
    ("72.852", 1466), ("59.426", 1466), ("9.424", 1466), ("72.851", 1466), ("50.0", 7), ("42.9", 7), ("33.3", 3),
    ("33.4", 3), ("66.67", 3), ("100", 12), ("0.0", 12), ("8", 12), ("9", 12), ("14.285", 7), ("14.286", 7),
]  # fmt: skip


@asks_for(truth("whether the figure can be a share of so many samples"))
def exercise_3(could_be_a_share: Callable[[str, int], bool]) -> str:
    """15.3: whether a printed percentage can be k of n."""
    given = [bool(could_be_a_share(*case)) for case in SHARES]
    wanted = [is_share(*case) for case in SHARES]
    if given == wanted:
        return ""
    if hint := recognised(given, SHARE_MISTAKES, SHARES, lambda a, b: list(a) == list(b)):
        return hint
    (printed, total), answer = next(
        (case, mine) for case, mine, right in zip(SHARES, given, wanted, strict=True) if mine != right
    )
    near = round(float(printed) / 100 * total)
    return (
        f"For {printed} % of {total} you say {answer}. The nearest whole number is {near}, and {near} of {total} are "
        f"{100 * near / total:.6f} %. How would a paper with as many digits print that?"
    )


def is_share(printed: str, total: int) -> bool:
    digits = len(printed.partition(".")[2])
    return any(f"{100 * k / total:.{digits}f}" == printed for k in range(total + 1))


def nearly(printed: str, total: int, slack: float) -> bool:
    """Whether a share lies within so many of the last digits."""
    digits = len(printed.partition(".")[2])
    return any(abs(100 * k / total - float(printed)) <= slack * 10.0**-digits for k in range(total + 1))


SHARE_MISTAKES: Sequence[tuple[Callable[[str, int], bool], str]] = [
    (lambda p, n: True, "You say yes to everything. Every percentage is near to a share of 1466; is it near enough?"),
    (lambda p, n: False, "You say no to everything. 6 of 12 are 50 %, and a paper may print that."),
    (partial(nearly, slack=1e-9), "You ask for equality. 33.3 is one of three, as far as its digits go."),
    (partial(nearly, slack=1.0), "You allow a whole unit of the last digit. How far can rounding move a number?"),
    (lambda p, n: any(round(100 * k / n, 3) == float(p) for k in range(n + 1)),
     "You round to three digits always. A paper that prints 42.9 has rounded to one."),
    (lambda p, n: any(round(100 * k / n) == round(float(p)) for k in range(n + 1)),
     "You round to whole percent. The digits after the point are printed, too."),
    (lambda p, n: any(math.floor(100 * k / n * 10 ** len(p.partition(".")[2])) == round(float(p) * 10 ** len(
        p.partition(".")[2])) for k in range(n + 1)), "You cut digits off. Papers round: 2 of 3 are printed as 66.67."),
]  # fmt: skip

Judged = tuple[float, float, str, float]
JUDGED: list[Judged] = [
    (0.94, 0.96, "0.952", 1.0), (0.9525, 0.97, "0.952", 1.0), (0.9526, 0.97, "0.952", 1.0), (0.9, 0.9514, "0.952", 1.0),
    (0.94, 1.02, "0.952", 1.0), (1.0, 1.1, "0.952", 1.0), (1.2, 1.3, "0.952", 1.0), (0.97, 1.0, "0.952", 1.0),
    (70.0, 85.0, "80", 50.0), (60.0, 79.5, "80", 50.0), (60.0, 79.4, "80", 50.0), (40.0, 85.0, "80", 50.0),
    (10.0, 50.0, "80", 50.0), (50.0, 90.0, "80", 50.0), (80.6, 95.0, "80", 50.0),
]  # fmt: skip


WORDS = ("holds", "partly", "not shown", "doesn't")


def one_word(value: Any, arguments: tuple) -> str:
    """A verdict is one of four words."""
    if isinstance(value, str) and value.strip().lower() in WORDS:
        return ""
    return f"{described(value)}. The answer is 'holds', 'partly', 'not shown' or \"doesn't\"."


@asks_for(one_word)
def exercise_4(verdict_on: Callable[..., str]) -> str:
    """15.4: the rule, for numbers on either side of the line."""
    given = [str(verdict_on(*case)).strip().lower() for case in JUDGED]
    wanted = [rule(*case) for case in JUDGED]
    if given == wanted:
        return ""
    if hint := recognised(given, RULE_MISTAKES, JUDGED, lambda a, b: list(a) == list(b)):
        return hint
    case, mine = next((case, mine) for case, mine, right in zip(JUDGED, given, wanted, strict=True) if mine != right)
    low, high, printed, line = case
    return (
        f"For the interval from {low:g} to {high:g}, the number {printed} and the line {line:g} you say {mine!r}. Draw "
        "the four on an axis: on which side of the line is the number, and where is the interval?"
    )


def rule(low: float, high: float, printed: str, line: float, *, digit: float = 0.5, number_first: bool = False) -> str:
    number = float(printed)
    slack = digit * 10.0 ** -len(printed.partition(".")[2]) * (1 + 1e-9)
    reached = low <= number + slack and high >= number - slack
    if number_first and reached:
        return "holds"
    best, worst = (line - low, line - high) if number < line else (high - line, low - line)
    if best <= 0:
        return "doesn't"
    if worst <= 0:
        return "not shown"
    return "holds" if reached else "partly"


def below_only(low: float, high: float, printed: str, line: float) -> str:
    """As if the number always lay below the line."""
    if low >= line or high >= line:
        return "doesn't" if low >= line else "not shown"
    return "partly" if float(printed) > line else rule(low, high, printed, line)


def outdone(low: float, high: float, printed: str, line: float) -> str:
    found = rule(low, high, printed, line)
    beyond = high < float(printed) if float(printed) < line else low > float(printed)
    return "holds" if found == "partly" and beyond else found


RULE_MISTAKES: Sequence[tuple[Callable[..., str], str]] = [
    (below_only, "Your rule is for numbers below their line. With 80 and the line 50 the claim's side is above it."),
    (partial(rule, digit=0.0), "You compare with the number alone. 80 stands for all from 79.5 to 80.5."),
    (partial(rule, digit=1.0), "You allow a whole unit of the last digit, and rounding moves a number by half of one."),
    (partial(rule, number_first=True),
     "You look at the number before the line. An interval that has both in it shows nothing."),
    (outdone, "You let the number be outdone. This exercise asks for the number: more is another one."),
]  # fmt: skip


@cache
def another_sample() -> dict[str, np.ndarray]:
    """Lengths of A* and of REPARE's two distances on the pairs of the exercise."""
    city = table1_city()
    pairs = city.random_pairs(100, 15, apart=40, min_clearance=4.5)
    found = {load: np.array([repare(city, *pair, load=load).length for pair in pairs]) for load in ("light", "heavy")}
    return found | {"A*": np.array([astar(city, *pair).length for pair in pairs])}


def with_ends(ratio: np.ndarray, statistic: Callable[..., Any] = np.mean) -> list[float]:
    return [float(statistic(ratio)), *over_maps(statistic, ratio[:, None])]


@asks_for_value(numbers((3,), "three numbers: mean, lower and upper end"))
def exercise_5(answer: Any) -> str:
    """15.5: REPARE's length over A*'s on another sample."""
    lengths = another_sample()
    mean, low, high = (float(number) for number in answer)
    right = with_ends(lengths["heavy"] / lengths["A*"])
    if alike([mean, low, high], right, relative=2e-4):
        return ""
    wrong = {
        "That is with the light load, so with 3.5 m. Table 4's 4.5 m are for the heavy one.": with_ends(
            lengths["light"] / lengths["A*"]),
        "You divide the other way round: asked for is REPARE's length over A*'s.": with_ends(
            lengths["A*"] / lengths["heavy"]),
        "That is the median. Table 2 speaks of averages.": with_ends(lengths["heavy"] / lengths["A*"], np.median),
    }  # fmt: skip
    for hint, values in wrong.items():
        if alike([mean, low, high], values, relative=2e-4):
            return hint
    if alike(mean, right[0], relative=2e-4):
        return f"The mean is right. The ends of its interval aren't: you have {low:.4f} and {high:.4f}."
    if alike(mean, lengths["heavy"].mean() / lengths["A*"].mean(), relative=1e-4):
        return "That is the ratio of the mean lengths. Asked for is the mean of the ratios, one for each pair."
    return (
        f"Your mean is {mean:.4f}. Are they the hundred pairs of seed 15, at least 40 m apart, with 4.5 m around them?"
    )


ARRIVE, PAIRS = 0.9, 100


@cache
def papers_pairs() -> tuple[City, np.ndarray, np.ndarray]:
    """The city, pairs of places in it, and the lengths of A*'s routes."""
    city = table1_city()
    pairs = city.random_pairs(300, 7, apart=40, min_clearance=4.5)[:PAIRS]
    return city, pairs, np.array([astar(city, *pair).length for pair in pairs])


def arguments_of_a_field(value: Any, arguments: tuple) -> str:
    """A dictionary, such as {"moves": "continuous", …}."""
    if isinstance(value, Mapping) and "moves" in value:
        return ""
    return f"{described(value)}. The answer is a dictionary of arguments for `potential_field`, `moves` among them."


@asks_for(arguments_of_a_field)
def exercise_6(own_field: Callable[[], Mapping[str, Any]]) -> str:
    """15.6: a field that moves in any direction, and for which Table 2 holds."""
    field = own_field()
    if field.get("moves") != "continuous":
        return 'Your field moves on the lattice. Asked for is one with `moves` set to "continuous".'
    city, pairs, shortest = papers_pairs()
    try:
        routes = [potential_field(city, *pair, **field) for pair in pairs]
    except (TypeError, ValueError) as error:
        return f"`potential_field` doesn't take these arguments: {error}"
    there = np.array([route.reached for route in routes])
    if there.mean() < ARRIVE:
        return f"It arrives on {there.sum()} of {PAIRS} pairs; at least {ARRIVE:.0%} are asked for. What stops it?"
    ratio, low, high = with_ends((shortest / [route.length for route in routes])[there])
    if rule(low, high, "0.952", 1.0) == "holds":
        return ""
    return (
        f"A*'s length over the field's is {ratio:.3f} [{low:.3f}, {high:.3f}]: {rule(low, high, '0.952', 1.0)}. The "
        f"field's routes would have to be {'shorter' if ratio < 0.952 else 'longer'}. What does a stronger push do?"
    )
