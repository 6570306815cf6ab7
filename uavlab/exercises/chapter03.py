"""Checks of the exercises on prediction: predicting too low, the most probable class, figures that must be counts."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from scipy.stats import norm

from uavlab.exercises.hints import alike, recognised
from uavlab.exercises.kinds import asks_for, number, whole_number

FLIGHTS = (
    np.array([1, 2, 3, 4, 5, 6, 2, 1, 3, 2, 1, 4]),
    np.array([1, 3, 2, 4, 2, 6, 3, 2, 3, 2, 1, 4]),
)
"""True and predicted classes: 2 of 12 too low (by 1 and 3), 3 too high, so that no two mistakes agree."""

WEATHERS = [
    (0.4, 0.21, 6),
    (1.5, 0.21, 6),
    (2.9, 0.3, 8),
    (4.6, 0.21, 12),
    (1.04, 0.3, 6),  # just above a boundary
    (2.08, 0.4, 8),
    (3.06, 0.3, 8),
    (4.6, 0.3, 6),  # the last class, wide open, wins
    (4.9, 0.8, 6),
    (9.0, 0.3, 6),
]
"""Median [m], spread and number of classes."""

PRINTED = [
    (50.0, 2),
    (33.333, 3),
    (66.667, 3),
    (28.571, 7),
    (0.0, 12),
    (100.0, 12),
    (59.413, 1466),
    (72.851, 1466),
    (9.424, 1466),
    (59.426, 1466),
    (72.852, 1466),
    (33.33, 3),
    (66.666, 3),
]
"""Percentage and number of samples; the last five fit no count."""

same = partial(alike, relative=0, absolute=1e-6)


@asks_for(number("a share, from 0 to 1"))
def exercise_2(answer: Callable[[np.ndarray, np.ndarray], float]) -> str:
    """03.2: the share of flights whose class was predicted too low."""
    true, predicted = FLIGHTS
    given = [answer(true, predicted), answer(true, true), answer(true, np.maximum(true - 1, 1))]
    shares, right = np.asarray(given, dtype=float), [2 / 12, 0.0, float((true > 1).mean())]
    if same(shares, right):
        return ""
    if hint := recognised(shares[:1], LOW_MISTAKES, [FLIGHTS], same):
        return hint
    if same(shares, [len(true) * share for share in right]):
        return "That is how many flights it was, not their share: divide by the number of all flights."
    if same(shares, [100 * share for share in right]):
        return "That is in percent. A share lies between 0 and 1."
    return (
        f"Of twelve flights two were predicted too low, and you get {given[0]:.3g}. Compare the classes flight by "
        "flight: when is a prediction dangerous?"
    )


@asks_for(whole_number("the number of the class"))
def exercise_3(answer: Callable[[float, float, int], int]) -> str:
    """03.3: the class of the highest probability when the logarithm of the offset is normal."""
    given = [answer(*weather) for weather in WEATHERS]
    classes, right = np.asarray(given, dtype=float), [most_probable(*weather) for weather in WEATHERS]
    if same(classes, right):
        return ""
    if same(classes, [number - 1 for number in right]):
        return "All of your classes are one too low: NumPy counts from 0, classes from 1."
    if hint := recognised(classes, CLASS_MISTAKES, WEATHERS, same):
        return hint
    index = next(i for i, (number, true) in enumerate(zip(classes, right, strict=True)) if not same(number, true))
    weather, number = WEATHERS[index], given[index]
    return (
        f"With a median of {weather[0]:g} m, a spread of {weather[1]:g} and {weather[2]} classes you say {number}. "
        "Write down the probability of each class, see that they add up to 1, and take the largest."
    )


@asks_for(whole_number("the count, or -1 where none fits"))
def exercise_4(answer: Callable[[float, int], int]) -> str:
    """03.4: the count that a printed percentage belongs to, or -1."""
    given = [answer(*case) for case in PRINTED]
    counts, right = np.asarray(given, dtype=float), [count_of(*case) for case in PRINTED]
    if same(counts, right):
        return ""
    if hint := recognised(counts, COUNT_MISTAKES, PRINTED, same):
        return hint
    index = next(i for i, (count, fits) in enumerate(zip(counts, right, strict=True)) if not same(count, fits))
    (percent, samples), count, fits = PRINTED[index], given[index], right[index]
    if fits < 0:
        return (
            f"For {percent:g} % of {samples} you return {count:g}. Put it back: 100·{count:g}/{samples} = "
            f"{100 * count / samples:.3f}."
        )
    return f"For {percent:g} % of {samples} you return {count:g}, but there is a count that is printed so: look nearby."


def probabilities(median: float, spread: float, class_count: int) -> np.ndarray:
    below = norm.cdf((np.log(np.arange(1, class_count)) - math.log(median)) / spread)
    return np.diff(below, prepend=0.0, append=1.0)


def most_probable(median: float, spread: float, class_count: int) -> int:
    return 1 + int(probabilities(median, spread, class_count).argmax())


def closed_at_the_top(median: float, spread: float, class_count: int) -> int:
    """The last class taken for one of a metre, like the others."""
    return 1 + int(probabilities(median, spread, class_count + 1)[:-1].argmax())


def normal_in_metres(median: float, spread: float, class_count: int) -> int:
    """The offset itself taken for normal, not its logarithm."""
    below = norm.cdf((np.arange(1, class_count) - median) / spread)
    return 1 + int(np.diff(below, prepend=0.0, append=1.0).argmax())


def count_of(percent: float, samples: int) -> int:
    k = round(percent / 100 * samples)
    return k if abs(round(100 * k / samples, 3) - percent) < 1e-9 else -1


def truncated_count(percent: float, samples: int) -> int:
    """Cut to a whole number, then checked."""
    k = int(percent / 100 * samples)
    return k if abs(round(100 * k / samples, 3) - percent) < 1e-9 else -1


def exact_count(percent: float, samples: int) -> int:
    """Only what fits without any rounding."""
    k = percent / 100 * samples
    return round(k) if abs(k - round(k)) < 1e-9 else -1


def near_count(percent: float, samples: int) -> int:
    """Whatever lies within a hundredth of a percent."""
    k = round(percent / 100 * samples)
    return k if abs(100 * k / samples - percent) < 0.01 else -1


LOW_MISTAKES: list[tuple[Callable[..., Any], str]] = [
    (
        lambda true, predicted: (predicted > true).mean(),
        "You count the flights that were predicted too high. They kept more distance than they needed, and came home.",
    ),
    (
        lambda true, predicted: (predicted != true).mean(),
        "That is the share of all errors. Too high is a waste, too low is a wall: count only one of the two.",
    ),
    (
        lambda true, predicted: (predicted == true).mean(),
        "That is the accuracy: the flights that were predicted right.",
    ),
    (
        lambda true, predicted: (predicted <= true).mean(),
        "You count the right predictions as well: a class that is exactly right keeps enough distance.",
    ),
    (
        lambda true, predicted: np.maximum(true - predicted, 0).mean(),
        "You add up by how many classes the predictions are too low. Asked is on how many flights they are.",
    ),
    (
        lambda true, predicted: (predicted < true).sum() / (predicted != true).sum(),
        "You divide by the number of errors. Asked is the share of all flights.",
    ),
]
"""What else students write, and what to tell them."""

CLASS_MISTAKES: list[tuple[Callable[..., Any], str]] = [
    (
        lambda median, spread, class_count: min(math.ceil(median), class_count),
        "That is the class of the median. Just above a boundary the class below can be more probable: it is wider in "
        "the logarithm. Compute the probabilities.",
    ),
    (
        lambda median, spread, class_count: math.ceil(median),
        "That is the class of the median, and there is no class above the last one.",
    ),
    (
        lambda median, spread, class_count: min(math.ceil(median * math.exp(spread**2 / 2)), class_count),
        "That is the class of the mean. Neither mean nor median need lie in the most probable class.",
    ),
    (
        lambda median, spread, class_count: min(math.ceil(median * math.exp(-(spread**2))), class_count),
        "You take the class in which the density is highest. A class is a metre wide, and the last one has no end: "
        "integrate.",
    ),
    (
        closed_at_the_top,
        "Right, but for the last class: it holds all that is larger. Your probabilities don't add up to 1.",
    ),
    (
        normal_in_metres,
        "You take the offset for normal, with a spread in metres. It is its logarithm that is normal: take the "
        "logarithms of the boundaries and of the median.",
    ),
]
"""What else students write, and what to tell them."""

COUNT_MISTAKES: list[tuple[Callable[..., Any], str]] = [
    (
        lambda percent, samples: round(percent / 100 * samples),
        "You always find a count, the nearest one. Put it back: does it give the printed figure?",
    ),
    (
        lambda percent, samples: int(percent / 100 * samples),
        "You cut to a whole number and always find one. Take the nearest, and put it back: does it give the printed "
        "figure?",
    ),
    (
        truncated_count,
        "int cuts off: 33.333 % of 3 is 0.99999, and you look at 0. Which whole number is the nearest?",
    ),
    (
        exact_count,
        "You ask for a share that is exact. Printed figures are rounded: one of three is printed as 33.333.",
    ),
    (
        near_count,
        "You let figures pass that are off by several units of the last printed digit. Round to three decimals, and "
        "compare.",
    ),
    (
        lambda percent, samples: k if (k := count_of(percent, samples)) > 0 else -1,
        "Nearly: no right answer at all is a count, too.",
    ),
]
"""What else students write, and what to tell them."""
