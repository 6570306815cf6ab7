"""The checker, and what holds for every exercise, with the mistakes that each chapter's tests list."""

import importlib
import re
import sys
import threading
import time

import numpy as np
import pandas as pd
import pytest
from solved import CHOICES, EXERCISES, FUNCTIONS, SOURCES, VALUES, solutions_of

from uavlab import exercises
from uavlab.exercises import watching
from uavlab.exercises.kinds import Quiz, asks_for_value, number, thing

CHAPTERS = [source.stem[:2] for source in SOURCES]
LEVELS = ("Warm-up", "Warm-up", "Code", "Code", "Experiment", "Open")


def test_every_chapter_with_solutions_has_exercises():
    assert {number[:2] for number in EXERCISES} == set(CHAPTERS)


@pytest.mark.parametrize("source", SOURCES, ids=lambda source: source.stem)
def test_six_exercises_with_their_level_and_minutes(source):
    chapter, text = source.stem[:2], source.read_text(encoding="utf-8")
    found = re.findall(r"^# ## (\d\d\.\d) .+\n#\n# \*([\w-]+) · (\d+) minutes\*$", text, re.MULTILINE)
    assert [number for number, _, _ in found] == [f"{chapter}.{n}" for n in range(1, 7)]
    assert [level for _, level, _ in found] == list(LEVELS)
    assert {number for number in EXERCISES if number.startswith(chapter)} == {number for number, _, _ in found}


@pytest.mark.parametrize("number", EXERCISES)
def test_at_least_three_mistakes_have_words_of_their_own(number):
    """A chapter's test module lists them: `MISTAKES = {"05.2": {"words of the hint": answer}}`; a quiz has its own."""
    exercise = getattr(importlib.import_module(f"uavlab.exercises.chapter{number[:2]}"), f"exercise_{number[3:]}")
    known = importlib.import_module(f"test_chapter{number[:2]}").MISTAKES.get(number, {})
    mistakes = {words: letter for letter, words in exercise.wrong.items()} if number in CHOICES else known
    verdicts = {words: exercises.check(number, answer) for words, answer in mistakes.items()}
    assert not any(verdicts.values())
    hints = {words: verdict.hint for words, verdict in verdicts.items()}
    assert len(hints) >= 3
    for words, hint in hints.items():
        assert words in hint
        assert not any(other in hint for other in hints if other != words), hint


@pytest.mark.parametrize("number", CHOICES)
def test_choices(number):
    (quiz,) = [vars(importlib.import_module(f"uavlab.exercises.chapter{number[:2]}"))[f"exercise_{number[3:]}"]]
    assert exercises.check(number, f" {quiz.right.upper()}) ")
    assert len(quiz.because) > 20
    assert repr(exercises.check(number, quiz.right)) == f"{number}: right. {quiz.because}"
    assert set(quiz.wrong) | {quiz.right} == set("abcde"[: len(quiz.wrong) + 1])
    assert "There are the choices" in exercises.check(number, "z").hint
    for other, words in ((2, "You hand over one number, 2. The answer is one letter in quotes"), (print, "a function")):
        assert words in exercises.check(number, other).hint
    (source,) = [path for path in SOURCES if path.stem.startswith(number[:2])]
    asked = source.read_text(encoding="utf-8").split(f"# ## {number} ")[1].split("# ## ")[0]
    assert re.findall(r"^# - \*\*(\w)\*\*", asked, re.MULTILINE) == sorted(set(quiz.wrong) | {quiz.right})


@pytest.mark.parametrize("number", VALUES)
def test_values_of_the_wrong_kind(number):
    for other in ("twelve", {"a": 1}, print):
        hint = exercises.check(number, other).hint
        assert hint.startswith("You hand over ")
        assert "The answer is" in hint


def test_values(monkeypatch):
    """A number and an object, right, wrong, and of another kind."""

    @asks_for_value(number("a length [m]"))
    def length(value):
        return "" if value == 3.0 else str(1 / value)

    @asks_for_value(thing(range, "a range"))
    def steps(value):
        return ""

    monkeypatch.setattr("uavlab.exercises.chapter05.exercise_2", length)
    assert exercises.check("05.2", 3)
    assert exercises.check("05.2", 2.0).hint == "0.5"
    assert exercises.check("05.2", "3").hint == "You hand over text, '3'. The answer is one number: a length [m]."
    assert exercises.check("05.2", ...).hint == "There is no answer yet: put yours in the place of the dots."
    assert "its fault, not yours; what you hand over led to it" in exercises.check("05.2", 0.0).hint
    monkeypatch.setattr("uavlab.exercises.chapter05.exercise_2", steps)
    assert exercises.check("05.2", range(2))
    assert exercises.check("05.2", [0, 1]).hint == "You hand over a list of 2. The answer is a range."
    quiz = Quiz("b", "Two and two.", {"a": "One more."})
    monkeypatch.setattr("uavlab.exercises.chapter05.exercise_2", quiz)
    assert repr(exercises.check("05.2", "B")) == "05.2: right. Two and two."
    assert exercises.check("05.2", "a").hint == "One more."
    assert exercises.check("05.2", "c").hint == 'You hand over text, \'c\'. There are the choices "a" or "b".'


@pytest.mark.parametrize(("number", "name"), EXERCISES.items())
def test_solution_is_right(number, name):
    verdict = exercises.check(number, solutions_of(number[:2])[name])
    assert verdict, verdict
    assert repr(verdict).startswith(f"{number}: right")


@pytest.mark.parametrize("number", EXERCISES)
def test_blank_is_no_answer(number, blank):
    for answer in (None, ..., blank) if number in FUNCTIONS else (None, ...):
        verdict = exercises.check(number, answer)
        assert not verdict, answer
        assert "no answer yet" in repr(verdict)


def test_unknown_exercise():
    for unknown in ("05.99", "99.1", "six", "05"):
        with pytest.raises(ValueError, match=r"number must be that of an exercise, as in '05\.2'"):
            exercises.check(unknown, 1)


def test_answer_that_fails_is_told_so_with_its_line_and_the_input():
    def answer(*_):
        return 1 / 0

    hint = exercises.check("05.2", answer).hint
    assert hint == (
        "Your function raises ZeroDivisionError: division by zero, in the line `return 1 / 0` for (5, 3, 1)."
    )


def test_what_a_function_returns_is_not_the_function():
    assert "without brackets" in repr(exercises.check("05.2", 3.0))


def test_not_callable_in_a_function_is_not_the_function():
    """A missing * in 1000 (1 + e) calls the number."""
    two = 2
    hint = exercises.check("05.2", lambda dx, dy, dz: two(dx)).hint
    assert "raises TypeError: 'int' object is not callable" in hint
    assert "without brackets" not in hint


@pytest.mark.parametrize("number", FUNCTIONS)
def test_a_loop_without_end_is_stopped(number, monkeypatch):
    monkeypatch.setattr(watching, "SECONDS", 0.2)

    def endless(*_):
        rounds = 0
        while True:
            rounds += 1

    hint = exercises.check(number, endless).hint
    assert "still runs after 0.2 seconds, and was stopped" in hint
    assert "`while True:`" in hint or "`rounds += 1`" in hint
    assert threading.active_count() < 10


@pytest.mark.parametrize("number", FUNCTIONS)
def test_every_exercise_names_an_exception_of_the_answer(number):
    def answer(*_):
        raise LookupError("no such street")

    hint = exercises.check(number, answer).hint
    assert 'raises LookupError: no such street, in the line `raise LookupError("no such street")` for (' in hint


@pytest.mark.parametrize("number", FUNCTIONS)
@pytest.mark.parametrize(
    ("returned", "words"),
    [
        (None, "returns nothing: it needs a line with `return`"),
        ("twelve", "returns text, 'twelve'"),
        ({"a": 1}, "dict"),
        (print, "function"),
        ([[1.0], [1.0, 2.0]], "list"),
    ],
)
def test_every_exercise_says_what_is_of_the_wrong_type(number, returned, words):
    hint = exercises.check(number, lambda *_: returned).hint
    if returned is None and number in ("06.4", "10.4"):  # None is an answer there, but not always
        assert "None" in hint
    elif returned is None and number in ("01.4", "14.6"):
        assert words in hint
    elif number == "14.6":
        assert "Mission" in hint
    elif number == "07.3" and isinstance(returned, list):
        assert "3 parts" in hint
    else:
        assert words in hint
        assert "The answer" in hint


def test_an_answer_that_holds_up_exceptions_is_stopped_too(monkeypatch):
    monkeypatch.setattr(watching, "SECONDS", 0.2)

    def stubborn(*_):
        while True:
            try:
                sum(range(1000))
            except Exception:
                continue

    assert "was stopped" in exercises.check("05.2", stubborn).hint


def test_compilation_is_not_counted(monkeypatch):
    numba = pytest.importorskip("numba")
    monkeypatch.setattr(watching, "SECONDS", 0.15)

    def compiled_first(dx, dy, dz):
        fresh = numba.njit(lambda a: [x * a for x in range(3)])
        return len(fresh(dx))

    began = time.monotonic()
    hint = exercises.check("05.2", compiled_first).hint
    assert "was stopped" not in hint
    assert time.monotonic() - began > 0.15  # or this says nothing


def test_arguments_are_the_answer_s_own():
    def drag(wind, velocity, area, density):
        wind -= velocity
        return 0.5 * density * area * np.linalg.norm(wind) * wind

    assert exercises.check("01.3", drag)


def test_tables_are_the_answer_s_own(monkeypatch):
    table = pd.DataFrame({"wind_speed": [1.0, 2.0]})

    def doubled(given):
        given["wind_speed"] *= 2
        return given["wind_speed"].sum()

    def exercise(answer):
        return "" if answer(table) == 6.0 else "wrong"

    monkeypatch.setattr("uavlab.exercises.chapter05.exercise_2", exercise)
    assert exercises.check("05.2", doubled)
    assert list(table["wind_speed"]) == [1.0, 2.0]
    exercise.unchanged = True
    assert "changes an array" in exercises.check("05.2", doubled).hint


def test_what_the_check_does_wrong_is_not_blamed_on_the_answer(monkeypatch):
    def broken(answer):
        return 1 / answer(0, 0, 0)

    monkeypatch.setattr("uavlab.exercises.chapter05.exercise_2", broken)
    hint = exercises.check("05.2", lambda *_: 0).hint
    assert hint.startswith("The check itself can't go on, with a ZeroDivisionError")
    assert "its fault, not yours" in hint
    assert "(0, 0, 0)" in hint


def test_endless_recursion_is_named():
    def deeper(*steps):
        return deeper(*steps)

    assert "calls itself without end" in exercises.check("05.2", deeper).hint


def test_long_inputs_are_shortened():
    hint = exercises.check("05.3", lambda occupied, *_: occupied.nothing).hint
    assert "raises AttributeError" in hint
    assert len(hint) < 400


def test_grade_says_the_verdict_or_raises_the_hint(capsys):
    octile = solutions_of("05")["octile"]
    capsys.readouterr()
    assert exercises.grade("05.2", octile) is None
    assert capsys.readouterr().out == "05.2: right\n"
    with pytest.raises(AssertionError, match=r"^05\.2: not yet\. That counts straight moves only"):
        exercises.grade("05.2", lambda dx, dy, dz: dx + dy + dz)
    with pytest.raises(ValueError, match="number must be that of an exercise"):
        exercises.grade("05.99", 1)


def test_grade_says_nothing_on_stderr(capsys):
    """nbgrader would take it for a failure."""
    octile = solutions_of("05")["octile"]

    def answer(*moves):
        print("obsolete", file=sys.stderr)
        return octile(*moves)

    exercises.grade("05.2", answer)
    said = capsys.readouterr()
    assert said.err == ""
    assert "obsolete\n" in said.out
    assert said.out.endswith("05.2: right\n")


def test_a_notebook_shows_the_hint_alone():
    with pytest.raises(AssertionError) as raised:
        exercises.grade("05.1", "b")
    assert raised.value._render_traceback_() == [str(raised.value)]
