"""What the checks share: the first mistake that answers alike is named, and answers are compared as they should be."""

import operator

import numpy as np
import pytest

from uavlab.exercises.hints import alike, each_alike, recognised, recognised_value

CASES = [(1.0, 2.0), (3.0, 4.0)]
MISTAKES = [(operator.sub, "sign"), (operator.mul, "product"), (lambda a, b: a * b, "product again")]


@pytest.mark.parametrize(
    ("answers", "hint"), [([-1.0, -1.0], "sign"), ([2.0, 12.0 + 1e-6], "product"), ([2.0, 13.0], ""), ([3.0, 7.0], "")]
)
def test_first_mistake_that_answers_all_cases_alike_is_recognised(answers, hint):
    assert recognised(answers, MISTAKES, CASES, alike) == hint


@pytest.mark.parametrize(
    ("value", "hint"),
    [(100.9, "per cent"), (101.1, ""), (0.004, "zero"), (0.006, ""), (2.29, "its own"), (2.31, ""), (-99.1, "sign")],
)
def test_known_value_is_recognised_by_a_share_a_difference_or_a_nearness_of_its_own(value, hint):
    known = [(100.0, "per cent"), (0.0, "zero"), (2.0, 0.3, "its own"), (2.2, "too late"), (-100.0, "sign")]
    assert recognised_value(value, known, relative=0.01, absolute=0.005) == hint


def test_numbers_are_alike_within_either_tolerance():
    assert alike([1e6, 0.0], [1e6 + 0.9, 0.0])
    assert not alike([1e6], [1e6 + 1.1])
    assert alike([0.0], [0.9e-8])
    assert not alike([0.0], [1.1e-8])
    assert not alike([np.nan], [np.nan])
    assert alike([1.0], [1.05], relative=0, absolute=0.1)


def test_one_by_one_shapes_may_differ_but_not_the_number_of_answers():
    arrays = [np.ones(2), np.ones((3, 3))]
    assert each_alike(arrays, [one.copy() for one in arrays])
    assert not each_alike(arrays, [arrays[0], 2 * arrays[1]])
    with pytest.raises(ValueError, match="shorter"):
        each_alike(arrays, arrays[:1])


def test_answers_are_asked_for_no_further_than_the_first_that_differs():
    assert not each_alike((1 / x for x in (1.0, 2.0, 0.0)), [1.0, 3.0, 0.0])
