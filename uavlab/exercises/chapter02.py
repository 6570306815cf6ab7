"""Exercises of chapter 2, the Pauta criterion: coverage in the plane, the distance to keep, and the filter by hand.

A hint says which mistake the answers look like and why it is one. Mistakes are recognised by what they answer, not
by how they are written.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

import numpy as np

from uavlab.exercises.hints import alike, each_alike, recognised
from uavlab.exercises.kinds import asks_for, number, numbers
from uavlab.offsets import coverage, minimum_safe_distance, pauta_filter, pauta_radius

Vector = tuple[float, float]
RADII = (0.5, 1.0, 2.0, 3.0, 4.0)

same_distances = partial(alike, relative=2e-4)  # the radius may be rounded to 3.439
same_samples = partial(each_alike, same=np.array_equal)


@asks_for(number("a probability, from 0 to 1"))
def exercise_2(coverage_in_the_plane: Callable[[float], float]) -> str:
    """02.2: the probability that an offset in the plane lies within k standard deviations."""
    answers = [coverage_in_the_plane(k) for k in RADII]
    if alike(answers, coverage(RADII, 2)):
        at_zero = coverage_in_the_plane(0.0)
        return "" if math.isclose(at_zero, 0.0, abs_tol=1e-9) else "A circle of radius 0 holds nothing."
    return recognised(answers, PLANE_MISTAKES, [(k,) for k in RADII], alike) or (
        f"For k = 3 you get {float(answers[3]):.4f}. Cut the circle into rings: how large is the ring from r to "
        "r + dr, and how high is the density on it?"
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
        "That is the ball in space. The plane has two axes.",
    ),
    (
        lambda k: math.exp(-(k**2) / 2),
        "That is the chance to be outside of the circle: it falls with k.",
    ),
    (
        lambda k: 1 - math.exp(-(k**2)),
        "Almost: which power of e is in the Gaussian density, −r² or −r²/2?",
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
        "You take the radius of a ball in space. These gusts push in the plane.",
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
        "Towards the wall it is right. Where the wind blows away you make the distance smaller: it may turn.",
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


@asks_for(numbers((None,), "the array of the samples that are left"), unchanged=True)
def exercise_4(without_gross_errors: Callable[[np.ndarray], np.ndarray]) -> str:
    """02.4: the samples that are left when nothing lies beyond three standard deviations any more."""
    cases = contaminated_samples()
    answers = [np.asarray(without_gross_errors(samples)) for samples in cases]
    if any(answer.dtype == bool for answer in answers):
        return "You return a mask. The answer is the samples themselves: index the array with the mask."
    right = [samples[pauta_filter(samples).kept] for samples in cases]
    if same_samples(answers, right):
        return ""
    if hint := recognised(answers, FILTER_MISTAKES, [(samples,) for samples in cases], same_samples):
        return hint
    if same_samples([np.sort(answer, axis=None) for answer in answers], [np.sort(samples) for samples in right]):
        return "These are the right samples in another order. Keep the order in which they were taken."
    wrong = next(i for i, answer in enumerate(answers) if not np.array_equal(answer, right[i]))
    return (
        f"Of {len(cases[wrong])} samples {len(right[wrong])} should be left, you keep {answers[wrong].size}. Print "
        "mean, σ and the number of samples in each round."
    )


def contaminated_samples() -> list[np.ndarray]:
    """Offsets with gross errors: on one side, on both, around a mean that isn't 0, and none; and a few in doubt."""
    rng = np.random.default_rng(23)
    cases = []
    for mean, errors in (
        (0.0, (7.0, 25.0, 90.0, 400.0)),
        (0.5, (-6.0, 8.0, -30.0, 45.0, 200.0, -250.0)),
        (40.0, (20.0, 60.0, 300.0)),
        (-3.0, (-15.0, -60.0)),
    ):
        good = np.clip(rng.normal(mean, 1.0, 80), mean - 2.2, mean + 2.2)
        samples = np.concatenate([good, errors])
        cases.append(samples[rng.permutation(len(samples))])
    few = np.append(np.tile([0.64, -0.64], 5), 10.0)  # 10 is beyond 3σ with n, and within with n − 1
    return [*cases, np.linspace(-1.0, 1.0, 20), few]


def one_round(samples: np.ndarray) -> np.ndarray:
    return samples[np.abs(samples - samples.mean()) <= 3 * samples.std(ddof=1)]


def around_zero(samples: np.ndarray) -> np.ndarray:
    while len(samples) and (far := np.abs(samples) > 3 * samples.std(ddof=1)).any():
        samples = samples[~far]
    return samples


def upper_side(samples: np.ndarray) -> np.ndarray:
    while (far := samples - samples.mean() > 3 * samples.std(ddof=1)).any():
        samples = samples[~far]
    return samples


def two_sigma(samples: np.ndarray) -> np.ndarray:
    while (far := np.abs(samples - samples.mean()) > 2 * samples.std(ddof=1)).any():
        samples = samples[~far]
    return samples


def with_n(samples: np.ndarray) -> np.ndarray:
    while (far := np.abs(samples - samples.mean()) > 3 * samples.std()).any():
        samples = samples[~far]
    return samples


def errors_only(samples: np.ndarray) -> np.ndarray:
    return samples[~pauta_filter(samples).kept]


FILTER_MISTAKES: list[tuple[Callable[[np.ndarray], np.ndarray], str]] = [
    (
        with_n,
        "Of many samples the right ones are left, of few one too few: your σ divides by n, which NumPy does unless "
        "told otherwise. The exercise asks for n − 1.",
    ),
    (
        one_round,
        "That is one round. The largest errors widened the σ that the others were judged by: what is σ now?",
    ),
    (
        around_zero,
        "You measure from 0. The mean of the offsets isn't 0 when there is wind: measure from the mean.",
    ),
    (
        upper_side,
        "Right on the upper side. A sample can be too far below the mean as well.",
    ),
    (
        two_sigma,
        "You cut at 2σ. That takes one good sample in twenty, in every round; the criterion says 3σ.",
    ),
    (
        errors_only,
        "You return the gross errors. The answer is what is left without them.",
    ),
    (
        lambda samples: samples,
        "You keep everything. What is farther from the mean than three standard deviations has to go.",
    ),
]
