"""Exercises of chapter 13, flying in gusts: intervals, a point mass, a distance, a spectrum, and a route in a storm.

A hint says which mistake the answers look like and why it is one. Mistakes are recognised by what they answer, not
by how they are written.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache, partial

import numpy as np
from scipy.stats import beta, norm

from uavlab.city import City, table1_city
from uavlab.exercises.hints import alike, each_alike, recognised, recognised_value
from uavlab.exercises.kinds import Quiz, asks_for, asks_for_value, number, numbers, thing
from uavlab.flight import Autopilot, Rate, crash_rate, monte_carlo
from uavlab.planners import repare
from uavlab.route import Route
from uavlab.vehicle import GRAVITY, LIGHT_QUADROTOR
from uavlab.weather import Wind
from uavlab.weather.forces import STANDARD_AIR

Acceleration = Callable[[np.ndarray, np.ndarray, np.ndarray, float, float], np.ndarray]
Interval = Callable[[int, int], tuple[float, float]]
Distance = Callable[[float, float, float, float], float]

exercise_1 = Quiz(
    right="b",
    because="What was drawn at random are the pairs of points. A hundred others may have no such route, or three.",
    wrong={
        "a": "The formula is exact for trials that don't depend on each other. Do two flights past the same wall?",
        "c": "Twenty flights that resemble each other tell less than twenty that don't. Does an interval become "
        "narrower or wider when you know less?",
        "d": "Nothing was wrong with these flights. If bad routes are left out because they are bad, what is the rate "
        "a rate of?",
    },
)

DOWN = np.array([0.0, 0.0, GRAVITY])
FLOWN = [
    (np.array([1.0, -2.0, 17.0]), np.array([6.0, 3.0, 0.5]), np.array([-2.0, 4.0, 1.0]), 1.75, 0.06),
    (np.array([0.0, 0.5, 20.0]), np.array([-3.0, 0.0, -0.5]), np.array([5.0, 1.0, 0.0]), 2.5, 0.09),
    (np.array([3.0, 0.0, 12.0]), np.array([0.0, 9.0, 0.0]), np.array([0.0, 0.0, -1.0]), 1.5, 0.02),
]


@asks_for(numbers((3,), "the acceleration, a vector of three numbers"))
def exercise_2(acceleration: Acceleration) -> str:
    """13.2: thrust, drag of the relative wind and weight."""
    answers = [acceleration(*case) for case in FLOWN]
    if each_alike(answers, [right_acceleration(*case) for case in FLOWN]):
        return ""
    if hint := recognised(answers, ACCELERATIONS, FLOWN, each_alike):
        return hint
    still = FLOWN[0][2]
    alone = np.asarray(acceleration(np.zeros(3), still, still, 1.0, 0.06))
    if not np.allclose(alone, -DOWN):
        return "Begin with what is simplest: no thrust, and air that moves along with the UAV. What is left of Eq. 2?"
    return "Without thrust and drag it is right. Which way does the air stream past, and how long is that vector?"


def right_acceleration(
    thrust: np.ndarray, wind: np.ndarray, velocity: np.ndarray, mass: float, drag_area: float
) -> np.ndarray:
    return (thrust + drag_of(wind - velocity, drag_area)) / mass - DOWN


def drag_of(stream: np.ndarray, drag_area: float) -> np.ndarray:
    return 0.5 * STANDARD_AIR * drag_area * float(np.linalg.norm(stream)) * stream


ACCELERATIONS: list[tuple[Acceleration, str]] = [
    (lambda f, w, v, m, a: (f - drag_of(w - v, a)) / m - DOWN,
     "Your drag pulls against the stream of air. Hover in a wind: where does it push you?"),
    (lambda f, w, v, m, a: (f + drag_of(w, a)) / m - DOWN,
     "Your drag is that of a UAV that stands still. One that drifts with the wind feels none."),
    (lambda f, w, v, m, a: (f + drag_of(-v, a)) / m - DOWN,
     "Your drag is that of still air: where is the wind?"),
    (lambda f, w, v, m, a: (f + drag_of(w + v, a)) / m - DOWN,
     "You add wind and velocity. A UAV that flies with the wind feels less of it, not more."),
    (lambda f, w, v, m, a: (f + drag_of(w - v, 2 * a)) / m - DOWN,
     "Your drag is twice too large: Eq. 2 has one more factor."),
    (lambda f, w, v, m, a: (f + 0.5 * STANDARD_AIR * a * np.abs(w - v) * (w - v)) / m - DOWN,
     "You square each component on its own. Then the drag of a wind from the south-west isn't that of one from the "
     "south: what is the length in Eq. 2 taken of?"),
    (lambda f, w, v, m, a: (f + 0.5 * STANDARD_AIR * a * (w - v) ** 2) / m - DOWN,
     "A square has no sign: your drag pushes east and north, whatever the wind."),
    (lambda f, w, v, m, a: (f + 0.5 * STANDARD_AIR * a * (w - v)) / m - DOWN,
     "Your drag grows with the speed, not with its square. What are the units of your force?"),
    (lambda f, w, v, m, a: (f + drag_of(w - v, a)) / m,
     "Your UAV has no weight: it would rise for ever."),
    (lambda f, w, v, m, a: (f + drag_of(w - v, a)) / m + DOWN,
     "Your weight pulls up."),
    (lambda f, w, v, m, a: (f + drag_of(w - v, a) - DOWN) / m,
     "You divide g by the mass. Which of the three are forces?"),
    (lambda f, w, v, m, a: f + drag_of(w - v, a) - m * DOWN,
     "That is the force [N]. Which acceleration does it give?"),
    (lambda f, w, v, m, a: f / m + drag_of(w - v, a) - DOWN,
     "Drag is a force as thrust is: a heavy UAV feels less of it."),
]  # fmt: skip

TRIALS = [(0, 100), (1, 1000), (3, 20), (10, 10), (50, 200), (0, 1), (19, 2000)]


@asks_for(numbers((2,), "two numbers, (low, high)"))
def exercise_3(interval: Interval) -> str:
    """13.3: the exact interval of a crash probability."""
    answers = [interval(*trial) for trial in TRIALS]
    ends = np.array(answers, dtype=float)
    wanted = np.array([right_interval(*trial) for trial in TRIALS])
    same = partial(alike, absolute=1e-12)
    if same(ends, wanted):
        return ""
    if np.allclose(ends, 1000 * wanted):
        return "That is per 1 000. Asked for is a probability."
    if same(ends, wanted[:, ::-1]):
        return "Your lower end is the upper one."
    if np.isnan(ends).any():
        crashed, flights = TRIALS[int(np.isnan(ends).any(axis=1).argmax())]
        return (
            f"For {crashed} crashes of {flights} one end is NaN: a beta distribution has no parameter of 0. Which end "
            "needs no computing there?"
        )
    return recognised(ends, INTERVALS, TRIALS, same) or half_right(ends, wanted)


def half_right(ends: np.ndarray, wanted: np.ndarray) -> str:
    """A hint by what is right, one end or the trials in which some crashed and some didn't."""
    inner = slice(1, 3)  # neither none nor all crashed
    for column, name, other in ((0, "lower", "upper"), (1, "upper", "lower")):
        if np.allclose(ends[inner, column], wanted[inner, column]) and not np.allclose(
            ends[inner, 1 - column], wanted[inner, 1 - column]
        ):
            return (
                f"The {name} end is right where some crash and some don't. Which of a, b and the share change for the "
                f"{other} one?"
            )
    if np.allclose(ends[inner], wanted[inner]):
        return "It is right where some crash and some don't. What do you know when none crashes, and when all do?"
    crashed, flights = TRIALS[2]
    return (
        f"For {crashed} crashes of {flights} flights you get {ends[2, 0]:.3g} to {ends[2, 1]:.3g}. How often would "
        f"{crashed} or fewer be seen if the upper end were the truth? (`scipy.stats.binom.cdf` says it.)"
    )


def right_interval(crashed: int, flights: int, share: float = 0.95) -> tuple[float, float]:
    tail = (1 - share) / 2
    low = float(beta.ppf(tail, crashed, flights - crashed + 1)) if crashed else 0.0
    high = float(beta.ppf(1 - tail, crashed + 1, flights - crashed)) if crashed < flights else 1.0
    return low, high


def normal_interval(crashed: int, flights: int, *, clipped: bool = False) -> tuple[float, float]:
    rate = crashed / flights
    half = float(norm.ppf(0.975)) * math.sqrt(rate * (1 - rate) / flights)
    return (max(rate - half, 0.0), min(rate + half, 1.0)) if clipped else (rate - half, rate + half)


def rounded_normal(crashed: int, flights: int) -> tuple[float, float]:
    rate = crashed / flights
    half = 1.96 * math.sqrt(rate * (1 - rate) / flights)
    return rate - half, rate + half


def equal_tailed(crashed: int, flights: int) -> tuple[float, float]:
    both = beta(crashed + 1, flights - crashed + 1)
    return float(both.ppf(0.025)), float(both.ppf(0.975))


NORMAL = (
    "That is the interval of a normal distribution. For 0 crashes of 100 it has no width, as if you were sure, and for "
    "1 of 1 000 it begins below 0."
)
INTERVALS: list[tuple[Interval, str]] = [
    (normal_interval, NORMAL),
    (rounded_normal, NORMAL),
    (lambda k, n: normal_interval(k, n, clipped=True), NORMAL),
    (lambda k, n: right_interval(k, n, 0.9),
     "Yours holds 90 %: 5 % are cut off at either end. How many should be?"),
    (equal_tailed,
     "You have one distribution with one crash and one safe flight added: Bayes' interval for an even prior. "
     "The exact one has other parameters at each end."),
]  # fmt: skip

WALLS = [(1.0, 8.0, 0.001, 0.5), (1.5, 20.0, 0.01, 0.5), (0.6, 60.0, 0.002, 0.3), (2.0, 3.0, 0.005, 1.0)]
EASY = (1.0, 0.5, 0.1, 0.4)


@asks_for(number("the distance [m]"))
def exercise_4(distance: Distance) -> str:
    """13.4: how far to keep off so that at most some share of flights touches the wall."""
    answers = [distance(*wall) for wall in WALLS]
    same = partial(alike, relative=1e-5)
    touching = [right_distance(sigma, seconds, -math.log1p(-p), r) for sigma, seconds, p, r in WALLS]
    if same(answers, [right_distance(*wall) for wall in WALLS]) or same(answers, touching):
        easy = distance(*EASY)
        if np.isclose(easy, EASY[3]):
            return ""
        return (
            f"Beside walls that matter it is right. For {EASY[1]:g} s and {EASY[2]:g} allowed touches you get "
            f"{easy:.3g} m: {EASY[1] / (2 * math.pi):.2f} touches are to be expected with no margin at all, and the "
            f"body has a radius of {EASY[3]:g} m."
        )
    if hint := recognised(answers, DISTANCES, WALLS, same):
        return hint
    sigma, seconds, allowed, radius = WALLS[0]
    margin = float(answers[0]) - radius
    expected = seconds / (2 * math.pi) * math.exp(-0.5 * (margin / sigma) ** 2)
    return (
        f"With σ = {sigma:g} m, {seconds:g} s and a radius of {radius:g} m you keep {float(answers[0]):.2f} m: that "
        f"makes {expected:.2g} touches, {allowed:g} are allowed. Write down the touches in all the seconds, and "
        "solve for u."
    )


def right_distance(sigma: float, seconds: float, allowed: float, radius: float) -> float:
    return radius + margin_for(sigma, seconds / (2 * math.pi * allowed))


def margin_for(sigma: float, ratio: float) -> float:
    return sigma * math.sqrt(2 * math.log(ratio)) if ratio > 1 else 0.0


DISTANCES: list[tuple[Distance, str]] = [
    (lambda s, t, p, r: r + 3 * s,
     "That is 3σ and half the body for each flight, short or long. How many touches does it make in an hour?"),
    (lambda s, t, p, r: right_distance(s, t, p, 0.0),
     "That is the room that the centre needs. What is the first thing that touches?"),
    (lambda s, t, p, r: right_distance(s, t, p, 2 * r),
     "You add the whole body. `radius` is half of it already."),
    (lambda s, t, p, r: right_distance(s, 1.0, p, r),
     "Your distance is the same for a second and for an hour beside the wall."),
    (lambda s, t, p, r: r + margin_for(s, t / p),
     "You count a radian as a turn: offsets with ω_n = 1 rad/s don't cross 0 once a second."),
    (lambda s, t, p, r: r + s * math.sqrt(math.log(t / (2 * math.pi * p))),
     "Check the exponent: σ² stands there with a factor."),
    (lambda s, t, p, r: r + s * math.sqrt(2 * math.log10(t / (2 * math.pi * p))),
     "The inverse of exp is the natural logarithm, not that to the base 10."),
    (lambda s, t, p, r: r + s * float(norm.ppf(1 - p)),
     "That is the quantile of one moment on one side. A flight has many moments."),
    (lambda s, t, p, r: r + s * float(norm.ppf(1 - p / 2)),
     "That is the quantile of one moment, and the wall is on one side. A flight has many moments."),
    (lambda s, t, p, r: r + s**2 * math.sqrt(2 * math.log(t / (2 * math.pi * p))),
     "Your margin grows with σ². What are its units?"),
]  # fmt: skip


MEMORY, CLOSE = 1.590, 0.03
"""τ_u [s] at which gusts of 4 m/s in a wind of 9 m/s make σ = 1 m for the light load in hover, by Eq. 7."""


@asks_for_value(number("the memory of the gusts [s]"))
def exercise_5(memory: float) -> str:
    """13.5: how long gusts have to last until σ of the offset along the wind is a metre."""
    value = float(memory)
    if abs(value - MEMORY) <= CLOSE:
        return ""
    if hint := recognised_value(value, MEMORIES, relative=0.02):
        return hint
    if not value > 0:
        return "A memory is a time above 0."
    if value > MEMORY:
        return f"With {value:g} s σ is above a metre. The shorter gusts last, the less they push away."
    return f"With {value:g} s σ is still below a metre: let the gusts last longer."


MEMORIES: list[tuple[float, str]] = [
    (15.27, "That is for the heavy load. A light drone of the same drag needs less."),
    (0.522, "That is in flight against the wind at 5 m/s. Hovering, the stream of air is 9 m/s."),
    (1.04, "You took the spectrum as flat, as that of white noise. Gusts that last for a second or more aren't white."),
    (1.512, "That is σ in metres for gusts that last for ever. Asked for is a time."),
]  # fmt: skip

ENDS = (90.0, 18.0, 30.0), (50.0, 44.0, 30.0)
STORM = Wind((9.0, 0.0), deviation=4.0, correlation=3.0)


@cache
def test_city() -> City:
    return table1_city()


def flown(route: Route) -> Rate:
    """Crashes of 1 000 flights in the storm, with GPS that drifts."""
    uav = LIGHT_QUADROTOR.loaded(0.25)
    return crash_rate(monte_carlo(route, test_city(), uav, STORM, Autopilot(), rng=136, flights=1000, time_step=0.04))


@cache
def of_repare() -> tuple[float, Rate]:
    """Length of REPARE's route and its crashes."""
    route = repare(test_city(), *ENDS)
    return route.length, flown(route)


@asks_for_value(thing(Route, "a Route, as planners return it and Route(points) makes it"))
def exercise_6(route: Route) -> str:
    """13.6: a route out of the notch, no longer than REPARE's, that crashes a third as often in the storm."""
    if not route.reached:
        return f"Your route doesn't arrive: {route.reason}. Which planners get out of a notch?"
    for name, end, wanted in zip(("begins", "ends"), route.points[[0, -1]], ENDS, strict=True):
        if math.dist(end, wanted) > 1.0:
            return f"Your route {name} at {tuple(end.round(1).tolist())}, more than a metre from {wanted}."
    longest, theirs = of_repare()
    nearest = route.clearance(test_city())
    if nearest == 0:
        return "Your route leads through a building."
    if nearest <= 0.5:
        return f"Your route comes to {nearest:.2f} m from a wall, and the body's radius is 0.5 m: it needs no gust."
    if route.length > longest + 0.05:
        return (
            f"Your route is {route.length:.1f} m long, REPARE's is {longest:.1f} m. Distance from walls alone is easy: "
            "where can you come back towards the straight way?"
        )
    rate = flown(route)
    said = f"Of 1 000 flights {rate.per_thousand:.0f} [{rate.low:.0f}, {rate.high:.0f}] crash on your route, and "
    said += f"{theirs.per_thousand:.0f} [{theirs.low:.0f}, {theirs.high:.0f}] on REPARE's. "
    if rate.high >= theirs.low:
        return said + "The intervals overlap: that yours is better isn't shown."
    if 3 * rate.per_thousand > theirs.per_thousand:
        return said + "Better, and shown. But it is more than a third. What does your planner take σ for?"
    return ""
