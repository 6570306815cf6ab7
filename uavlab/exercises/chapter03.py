"""Exercises of chapter 03: a fair test, exceedances, the likeliest class, a quantile, another street, the sun.

A hint says which mistake the answers look like and why it is one. Mistakes are recognised by what they answer, not by
how they are written. Of a rule of one's own all that fails is said, with figures.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cache, partial
from typing import Any

import numpy as np
from scipy.stats import norm

from uavlab.exercises.hints import alike, recognised
from uavlab.exercises.kinds import Quiz, asks_for, asks_for_value, number, numbers, whole_number
from uavlab.prediction import FEATURES, median_offsets
from uavlab.vehicle import LIGHT_QUADROTOR
from uavlab.weather import greensboro_weather

Function = Callable[..., Any]
Mistakes = Sequence[tuple[Function, str]]

same = partial(alike, relative=0, absolute=1e-6)

exercise_1 = Quiz(
    right="c",
    because="Tomorrow is a new day in a street that is known, and so is each test: a day the model hasn't seen, in "
    "streets that it has.",
    wrong={
        "a": "The model has learned these flights. After 300 rounds it names the class of nearly all of them, and of "
        "new ones no more than before.",
        "b": "Other flights of the same day are among those that it learned from. What the day has for itself, the "
        "model looks up; of tomorrow it can't.",
        "d": "That would be the test for a street where nobody has flown. Tomorrow's is one of the four, so this "
        "test is harder than tomorrow.",
    },
)

FLIGHTS = (
    np.array([0.4, 1.7, 2.6, 3.2, 4.9, 9.0, 1.1, 0.9, 2.3, 1.5, 0.6, 3.8, 5.3, 2.0]),
    np.array([1, 3, 2, 4, 2, 6, 3, 2, 3, 2, 1, 4, 6, 2]),
)
"""Offsets [m] and predicted classes: 3 of 14 exceed theirs, one of them in the last class; 1 lies at its end."""
QUIET = (np.array([0.4, 1.2, 2.6]), np.array([1, 2, 3]))


@asks_for(number("a share, from 0 to 1"))
def exercise_2(answer: Function) -> str:
    """03.2: the share of flights that were pushed further than the class that was kept."""
    given = [answer(*FLIGHTS), answer(*QUIET)]
    if same(given, [3 / 14, 0.0]):
        return ""
    return recognised(given[:1], EXCEEDED, [FLIGHTS], same) or (
        f"Of fourteen flights three went beyond, and you get {float(given[0]):.3g}. Go through them one by one: how "
        "many metres were kept, and how far was the flight pushed?"
    )


def classes_of(offsets: np.ndarray) -> np.ndarray:
    return np.clip(np.ceil(offsets), 1, 6)


EXCEEDED: Mistakes = [
    (
        lambda offsets, predicted: (classes_of(offsets) > predicted).mean(),
        "You compare classes. The flight of 9 m is of class 6, and class 6 was predicted; but 6 m were kept.",
    ),
    (
        lambda offsets, predicted: (offsets < predicted).mean(),
        "You count the flights that stayed within. They came home.",
    ),
    (
        lambda offsets, predicted: (offsets >= predicted).mean(),
        "A flight that was pushed by exactly as much as was kept counts with you. Class 2 reaches up to 2 m, with its "
        "end.",
    ),
    (
        lambda offsets, predicted: (offsets > predicted - 1).mean(),
        "You measure from where the class begins. Class 3 begins above 2 m, but what was kept is its upper end.",
    ),
    (
        lambda offsets, predicted: (classes_of(offsets) != predicted).mean(),
        "That is the share of all wrong classes. Many of them were too high: a waste of room, and no danger.",
    ),
    (
        lambda offsets, predicted: (offsets > predicted).sum(),
        "That is how many flights it was. A share is divided by the number of all flights.",
    ),
    (
        lambda offsets, predicted: 100 * (offsets > predicted).mean(),
        "That is in percent. The answer lies between 0 and 1.",
    ),
    (
        lambda offsets, predicted: np.maximum(offsets - predicted, 0).mean(),
        "You add up by how many metres they went beyond. Asked is on how many flights.",
    ),
]

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


@asks_for(whole_number("the number of the class"))
def exercise_3(answer: Function) -> str:
    """03.3: the class of the highest probability when the logarithm of the offset is normal."""
    given = [answer(*weather) for weather in WEATHERS]
    classes, right = np.asarray(given, dtype=float), [most_probable(*weather) for weather in WEATHERS]
    if same(classes, right):
        return ""
    if same(classes, [number - 1 for number in right]):
        return "All of your classes are one too low: NumPy counts from 0, classes from 1."
    if hint := recognised(classes, CLASSES, WEATHERS, same):
        return hint
    index = next(i for i, (number, true) in enumerate(zip(classes, right, strict=True)) if not same(number, true))
    weather = WEATHERS[index]
    return (
        f"With a median of {weather[0]:g} m, a spread of {weather[1]:g} and {weather[2]} classes you say "
        f"{given[index]}. Write down the probability of each class, see that they add up to 1, and take the largest."
    )


def likeliest(ends: Any, middle: float, spread: float, first: float = 0.0, last: float = 1.0) -> int:
    """The class of the largest probability between these ends."""
    return 1 + int(np.diff(norm.cdf((ends - middle) / spread), prepend=first, append=last).argmax())


def most_probable(median: float, spread: float, count: int) -> int:
    return likeliest(np.log(np.arange(1, count)), math.log(median), spread)


CLASSES: Mistakes = [
    (
        lambda median, spread, count: min(math.ceil(median), count),
        "That is the class of the median. Just above a boundary the class below can be more probable: it is wider in "
        "the logarithm. Compute the probabilities.",
    ),
    (
        lambda median, spread, count: math.ceil(median),
        "That is the class of the median, and there is no class above the last one.",
    ),
    (
        lambda median, spread, count: min(math.ceil(median * math.exp(spread**2 / 2)), count),
        "That is the class of the mean. Neither mean nor median need lie in the most probable class.",
    ),
    (
        lambda median, spread, count: min(math.ceil(median * math.exp(-(spread**2))), count),
        "You take the class in which the density is highest. A class is a metre wide, and the last one has no end: "
        "integrate.",
    ),
    (
        lambda median, spread, count: (
            1
            + int(
                np.diff(norm.cdf((np.log(np.arange(1, count + 1)) - math.log(median)) / spread), prepend=0.0).argmax()
            )
        ),
        "Right, but for the last class: it holds all that is larger. Your probabilities don't add up to 1.",
    ),
    (
        lambda median, spread, count: likeliest(np.arange(1, count), median, spread),
        "You take the offset for normal, with a spread in metres. It is its logarithm that is normal: take the "
        "logarithms of the boundaries and of the median.",
    ),
]


def nearest(x: np.ndarray, y: np.ndarray) -> Function:
    """A model: the mean of the two nearest flights, so that it knows each flight that it has learned half by heart."""
    x, y = np.array(x, dtype=float), np.array(y, dtype=float)
    return lambda wind: np.array([y[np.argsort(np.abs(x - w))[:2]].mean() for w in np.atleast_1d(wind)])


@cache
def logbook() -> list[tuple[Any, ...]]:
    """Questions of 03.4: flights of days that differ, the wind tomorrow, and a quantile."""
    rng, asked = np.random.default_rng(34), []
    for days, each, q in ((6, 8, 0.9), (5, 6, 0.75)):
        day = np.repeat(np.arange(days), each)
        wind = rng.uniform(1, 9, len(day)).round(3)
        offsets = np.exp(
            -0.5 + 0.25 * wind + 0.2 * rng.standard_normal(days)[day] + 0.1 * rng.standard_normal(len(day))
        )
        asked.append((nearest, wind, offsets, day, np.array([2.05, 5.45, 7.95]), q))
    return asked


def left_out(fit: Function, x: np.ndarray, y: np.ndarray, group: np.ndarray) -> np.ndarray:
    """Errors on each group by a model of the others."""
    errors = np.zeros(len(y))
    for one in np.unique(group):
        out = group == one
        errors[out] = y[out] - fit(x[~out], y[~out])(x[out])
    return errors


@asks_for(numbers(lambda fit, wind, offsets, day, tomorrow, q: (len(tomorrow),), "an array, an offset for each hour"))
def exercise_4(answer: Function) -> str:
    """03.4: the quantile of the offset, its errors measured on days that were left out."""
    asked = logbook()
    given = [np.asarray(answer(*question), dtype=float) for question in asked]
    same_all = partial(same_rows, cases=len(asked))
    if same_all(given, [kept(*question) for question in asked]):
        return ""
    return recognised(given, KEPT, asked, same_all) or (
        f"At a wind of {asked[0][4][0]} m/s you keep {given[0][0]:.3f} m. Check the steps on their own: the errors of "
        "each day by a model of the other days, all of them in one array, its quantile, and the model of all days."
    )


def same_rows(answers: Sequence[Any], wanted: Sequence[Any], cases: int) -> bool:
    return all(np.shape(a) == np.shape(b) and same(a, b) for a, b in zip(answers, wanted, strict=True)) and cases > 0


def kept(
    fit: Function,
    wind: np.ndarray,
    offsets: np.ndarray,
    day: np.ndarray,
    tomorrow: np.ndarray,
    q: float,
    errors_of: Function = left_out,
    margin: Function = np.quantile,
    log: bool = True,
) -> np.ndarray:
    """The right way, and with other errors or another margin."""
    y = np.log(offsets) if log else offsets
    said = fit(wind, y)(tomorrow) + margin(errors_of(fit, wind, y, day), q)
    return np.exp(said) if log else said


KEPT: Mistakes = [
    (
        partial(kept, errors_of=lambda fit, x, y, day: y - fit(x, y)(x)),
        "Your errors are those on flights that the model has learned from: it knows them half by heart. Tomorrow it "
        "will err more.",
    ),
    (
        partial(kept, errors_of=lambda fit, x, y, day: left_out(fit, x, y, np.arange(len(y)))),
        "You leave out one flight at a time. The others of its day stay in, and betray what that day was like.",
    ),
    (
        partial(kept, log=False),
        "You work in metres all along. The scatter is a factor: in strong wind the errors are larger, and one margin "
        "in metres doesn't fit. What turns a factor into a sum?",
    ),
    (
        lambda *question: np.log(kept(*question)),
        "Those are logarithms, some of them below 0. Which function leads back to metres?",
    ),
    (
        partial(kept, margin=lambda errors, q: 0.0),
        "There is no margin: half of the flights go beyond what the model predicts.",
    ),
    (
        partial(kept, margin=lambda errors, q: np.quantile(np.abs(errors), q)),
        "You take the size of the errors. A flight that is pushed less than predicted does no harm: which sign counts?",
    ),
    (
        partial(kept, margin=lambda errors, q: np.quantile(-errors, q)),
        "Your errors have the wrong sign: they are large where the flight was pushed less than predicted.",
    ),
    (
        partial(kept, margin=lambda errors, q: np.percentile(errors, q)),
        "`np.percentile` counts from 0 to 100, and q lies between 0 and 1.",
    ),
    (
        partial(kept, margin=lambda errors, q: norm.ppf(q) * np.std(errors)),
        "You take the errors for normal, with mean 0. Nobody has promised that: take the quantile of the errors "
        "themselves.",
    ),
]


@asks_for_value(number("a share of the flights, from 0 to 1"))
def exercise_5(share: Any) -> str:
    """03.5: how often the promise of one street is exceeded in another."""
    share = float(share)
    if 1.0 < share <= 100.0:
        return "That is in percent. The answer lies between 0 and 1."
    if 0.155 <= share <= 0.205:
        return ""
    if 0.035 <= share <= 0.065:
        return (
            "About 5 %: that is what was promised. It holds in the street where the model has learned (60°), and where "
            "it has learned anew. Count the flights of the other street against the bound of this one."
        )
    if 0.07 <= share <= 0.11:
        return (
            "You round up to whole metres first: that keeps more than the 95 % bound. Count against the bound itself."
        )
    if 0.8 <= share <= 0.85:
        return "That is the share that stays within. How many go beyond?"
    if 0.33 <= share <= 0.55:
        return "Did you forget the margin? Half of the flights go beyond a median at home, and over a third elsewhere."
    return (
        f"{share:.3g} is not what we find. Fit on the old days of the street at 60°, add the quantile 0.95 of the "
        "errors, and count on the new days how many offsets of the street at 150° lie above."
    )


@cache
def sunny_year() -> tuple[Any, ...]:
    """Flights whose noise grows with the sun: known weather and offsets; new weather, offsets and their 95 % bound."""
    hours = greensboro_weather()[list(FEATURES)]
    rng = np.random.default_rng(36)
    spread = 0.12 + 0.3 * hours["radiation"].to_numpy() / 1000
    median = median_offsets(hours, LIGHT_QUADROTOR)
    offsets = median * np.exp(spread * rng.standard_normal(len(hours)))
    new = np.repeat(rng.random(365) < 0.4, 24)
    tables = (hours[~new].reset_index(drop=True), offsets[~new], hours[new].reset_index(drop=True))
    return *tables, offsets[new], median[new] * np.exp(norm.ppf(0.95) * spread[new])


MOST_BEYOND, MOST_ROOM = 0.07, 1.1
"""Share of the flights, and times the room that one keeps with the true law of the noise."""


@asks_for(numbers(lambda known, offsets, new: (len(new),), "an array, an offset for each row of new"))
def exercise_6(rule: Function) -> str:
    """03.6: a rule for flights whose noise changes with the weather."""
    known, learned, new, offsets, best = sunny_year()
    room = np.asarray(rule(known.copy(), learned, new.copy()), dtype=float)
    if not np.isfinite(room).all():
        return f"{int((~np.isfinite(room)).sum())} of the {len(room)} offsets that you keep are no finite numbers."
    beyond, sun = offsets > room, new["radiation"].to_numpy() > 300
    shares = {"sunny": beyond[sun].mean(), "other": beyond[~sun].mean()}
    wrong = [
        f"{share:.1%} of the {which} flights go beyond what you keep, and at most {MOST_BEYOND:.0%} may"
        for which, share in shares.items()
        if share > MOST_BEYOND
    ]
    if room.mean() > MOST_ROOM * best.mean():
        wrong.append(f"you keep {room.mean():.2f} m on average, and {MOST_ROOM * best.mean():.2f} m would do")
    if not wrong:
        return ""
    advice = "Look at your errors over each of the features: where do they scatter more?"
    if shares["other"] > 0.3:
        advice = "Half of all flights go beyond a median. Where is the margin?"
    elif len(wrong) == 1 and room.mean() > MOST_ROOM * best.mean():
        advice = "Safe, but too wide: in which hours do hardly any flights go beyond?"
    text = "; ".join(wrong)
    return f"{text[0].upper()}{text[1:]}. {advice}"
