"""Exercises of chapter 03: other ways to the answer pass; typical mistakes fail, each with a hint of its own."""

import math

import numpy as np
import pytest
from scipy.stats import norm

from uavlab.exercises import check
from uavlab.prediction import class_probabilities, compare_models, make_dataset, score

NUMBERS = [("03.2", "under_prediction"), ("03.3", "most_probable_class"), ("03.4", "right_answers")]


@pytest.mark.parametrize(("number", "name"), NUMBERS)
def test_function_without_return_is_told_so(number, name):
    assert "returns nothing" in check(number, lambda *question: None).hint


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda true, predicted: np.mean(predicted > true), "predicted too high"),
        (lambda true, predicted: np.mean(predicted != true), "share of all errors"),
        (lambda true, predicted: np.mean(predicted == true), "the accuracy"),
        (lambda true, predicted: np.mean(predicted <= true), "exactly right keeps enough"),
        (lambda true, predicted: np.mean(np.maximum(true - predicted, 0)), "on how many flights"),
        (lambda true, predicted: np.sum(predicted < true) / max(np.sum(predicted != true), 1), "divide by the number"),
        (lambda true, predicted: np.sum(predicted < true), "not their share"),
        (lambda true, predicted: 100 * np.mean(predicted < true), "in percent"),
        (lambda true, predicted: 0.123, "you get 0.123"),
    ],
)
def test_mistakes_with_predicting_too_low(answer, hint):
    verdict = check("03.2", answer)
    assert not verdict
    assert hint in verdict.hint


def by_area(median, spread, class_count, *, log=True, last=True, first=1):
    """The most probable class, and how to get it wrong."""
    ends = [-math.inf, *(math.log(k) if log else k for k in range(1, class_count)), math.inf]
    if not last:
        ends[-1] = math.log(class_count)
    middle = math.log(median) if log else median
    return first + int(np.diff(norm.cdf((np.array(ends) - middle) / spread)).argmax())


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda m, s, n: min(math.ceil(m), n), "Compute the probabilities"),
        (lambda m, s, n: math.ceil(m), "no class above the last one"),
        (lambda m, s, n: min(math.ceil(m * math.exp(s * s / 2)), n), "the class of the mean"),
        (lambda m, s, n: min(math.ceil(m * math.exp(-s * s)), n), "the density is highest"),
        (lambda m, s, n: by_area(m, s, n, last=False), "don't add up to 1"),
        (lambda m, s, n: by_area(m, s, n, log=False), "its logarithm that is normal"),
        (lambda m, s, n: by_area(m, s, n, first=0), "NumPy counts from 0"),
        (lambda m, s, n: 3, "you say 3"),
    ],
)
def test_mistakes_with_the_most_probable_class(answer, hint):
    verdict = check("03.3", answer)
    assert not verdict
    assert hint in verdict.hint


def test_another_way_to_the_most_probable_class_is_right(solutions):
    assert check("03.3", by_area)
    for median in np.linspace(0.3, 8, 40):
        expected = 1 + class_probabilities([math.log(median)], 0.3, 6).argmax()
        assert solutions["most_probable_class"](median, 0.3, 6) == expected


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda percent, n: round(percent / 100 * n), "always find a count"),
        (lambda percent, n: int(percent * n / 100 + 1e-12), "cut to a whole number"),
        (lambda percent, n: k if round(100 * (k := int(percent / 100 * n)) / n, 3) == percent else -1, "int cuts off"),
        (lambda percent, n: round(percent * n / 100) if (percent * n / 100).is_integer() else -1, "exact"),
        (lambda percent, n: k if abs(100 * (k := round(percent * n / 100)) / n - percent) < 0.01 else -1, "several un"),
        (lambda percent, n: next((k for k in range(1, n + 1) if round(100 * k / n, 3) == percent), -1), "no right ans"),
        (lambda percent, n: k if round(100 * (k := round(percent * n / 100)) / n, 3) == percent else 5, "Put it back:"),
        (lambda percent, n: -1, "look nearby"),
    ],
)
def test_mistakes_with_counts(answer, hint):
    verdict = check("03.4", answer)
    assert not verdict
    assert hint in verdict.hint


def test_another_way_to_the_count_is_right():
    assert check("03.4", lambda percent, n: next((k for k in range(n + 1) if round(100 * k / n, 3) == percent), -1))


def test_under_prediction_is_the_measure_of_the_library(solutions):
    data = make_dataset(count=200, train_count=100)
    predicted = np.random.default_rng(0).integers(1, 7, 100)
    rate = solutions["under_prediction"](data.classes[data.test], predicted)
    assert rate == score(data, predicted)["under_prediction"]
    assert "under_prediction" in compare_models([0, 1], models={"first": lambda data: data.classes[data.test]})
