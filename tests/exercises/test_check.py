"""The checker, and what holds for every exercise; each chapter's typical mistakes have a test of their own."""

from collections import Counter

import pytest
from solved import EXERCISES, SOURCES, solutions_of

from uavlab import exercises

CHAPTERS = [source.stem[:2] for source in SOURCES]


def test_every_chapter_with_solutions_has_exercises():
    assert {number[:2] for number in EXERCISES} == set(CHAPTERS)


def test_each_chapter_has_at_least_three_exercises():
    counts = Counter(number[:2] for number in EXERCISES)
    few = [f"chapter {chapter} has {counts[chapter]}" for chapter in CHAPTERS if counts[chapter] < 3]
    assert not few, f"fewer than three exercises: {', '.join(few)}"


@pytest.mark.parametrize(("number", "name"), EXERCISES.items())
def test_solution_is_right(number, name):
    verdict = exercises.check(number, solutions_of(number[:2])[name])
    assert verdict, verdict
    assert repr(verdict) == f"{number}: right"


@pytest.mark.parametrize("number", EXERCISES)
def test_blank_is_no_answer(number, blank):
    for answer in (None, ..., blank):
        verdict = exercises.check(number, answer)
        assert not verdict, answer
        assert "no answer yet" in repr(verdict)


def test_unknown_exercise():
    for number in ("05.99", "99.1", "six", "05"):
        with pytest.raises(ValueError, match=r"number must be that of an exercise, as in '05\.2'"):
            exercises.check(number, 1)


def test_answer_that_fails_is_told_so():
    def answer(*_):
        return 1 / 0

    assert "Your answer raises ZeroDivisionError" in repr(exercises.check("05.1", answer))


def test_what_a_function_returns_is_not_the_function():
    assert "without brackets" in repr(exercises.check("05.1", 3.0))
