"""The checker itself; each chapter's exercises have a test of their own."""

import pytest

from uavlab import exercises


def test_blank_answers_are_no_answers():
    for blank in (None, ...):
        verdict = exercises.check("06.1", blank)
        assert not verdict
        assert "no answer yet" in repr(verdict)


def test_unknown_exercise():
    for number in ("06.99", "99.1", "six", "06"):
        with pytest.raises(ValueError, match=r"number must be that of an exercise, as in '06\.2'"):
            exercises.check(number, 1)


def test_answer_that_fails_is_told_so():
    def answer(*_):
        return 1 / 0

    assert "Your answer raises ZeroDivisionError" in repr(exercises.check("06.1", answer))


def test_what_a_function_returns_is_not_the_function():
    assert "without brackets" in repr(exercises.check("06.1", 3.0))
