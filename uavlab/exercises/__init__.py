"""Checks of the course's exercises: what is right, or what is wrong and why, without giving the answer away.

`check("05.2", answer)` looks for exercise 2 of chapter 5. Each chapter is a module, each exercise a `Quiz`, or a
function of the answer that returns a hint, or nothing when the answer is right. What they share is in
`uavlab.exercises`: the kinds of answers in `kinds`, known mistakes in `hints`, how a student's function is called in
`watching`.
"""

from __future__ import annotations

import importlib
import sys
from contextlib import redirect_stderr
from dataclasses import dataclass
from typing import Any

from uavlab import checks
from uavlab.exercises.done import Progress, progress
from uavlab.exercises.kinds import Quiz
from uavlab.exercises.watching import Watched, hint_from, shown

__all__ = ["Progress", "Verdict", "check", "grade", "progress"]


@dataclass(frozen=True)
class Verdict:
    """What `check` found; true when the answer is right."""

    number: str
    hint: str
    because: str = ""
    """Why a right answer is right, where that is worth a word."""

    def __bool__(self) -> bool:
        return not self.hint

    def __repr__(self) -> str:
        if not self:
            return f"{self.number}: not yet. {self.hint}"
        return f"{self.number}: right. {self.because}" if self.because else f"{self.number}: right"


def check(number: str, answer: Any) -> Verdict:
    """Check the answer to an exercise.

    Parameters
    ----------
    number : str
        Chapter and exercise, as in "05.2".
    answer : function, str, number or object
        What the exercise asks for: mostly a function, which gets copies of its arguments, and may take five seconds a
        call; the letter of a choice, as "b"; or a number or an object, where the exercise says so.

    Returns
    -------
    Verdict
        True when the answer is right; its text says what is wrong and where to look.

    Raises
    ------
    ValueError
        If `number` is no text, or not that of an exercise.

    Examples
    --------
    >>> check("05.2", lambda dx, dy, dz: dx + dy + dz)
    05.2: not yet. That counts straight moves only. It is too high: (1, 1, 1) is one move away, and you charge three.
    """
    number = checks.text("number", number)
    chapter, _, exercise = number.partition(".")
    try:
        module = importlib.import_module(f"uavlab.exercises.chapter{chapter}")
        hint_for = getattr(module, f"exercise_{exercise}")
    except (ImportError, AttributeError):
        raise ValueError(f"number must be that of an exercise, as in '05.2', got {number!r}") from None
    value = getattr(hint_for, "value", None)
    if answer is None or answer is ...:
        is_function = value is None and not isinstance(hint_for, Quiz)
        missing = "hand over your function" if is_function else "put yours in the place of the dots"
        return Verdict(number, f"There is no answer yet: {missing}.")
    if isinstance(hint_for, Quiz):
        hint = hint_for.hint(answer)
        return Verdict(number, hint, "" if hint else hint_for.because)
    if value and (complaint := value(answer, ())):
        return Verdict(number, f"You hand over {complaint}")
    if not value and not callable(answer):
        return Verdict(number, "Hand over the function itself, without brackets, not what it returns.")
    watched = Watched(answer, getattr(hint_for, "kind", None), getattr(hint_for, "unchanged", False))
    try:
        return Verdict(number, hint_for(answer) if value else hint_from(hint_for, watched))
    except Exception as problem:
        led = "what you hand over" if value else f"what your function answered to {shown(watched.arguments)}"
        return Verdict(
            number,
            f"The check itself can't go on, with a {type(problem).__name__} ({problem}). That is its fault, not yours; "
            f"{led} led to it.",
        )


def grade(number: str, answer: Any) -> None:
    """Check the answer to an exercise in a cell that gives points, as nbgrader has them: a wrong one is an exception.

    Parameters
    ----------
    number, answer
        As for `check`.

    Raises
    ------
    AssertionError
        If the answer isn't right; its text is the hint of `check`.
    ValueError
        If `number` is no text, or not that of an exercise.

    Examples
    --------
    >>> grade("05.1", "c")  # doctest: +ELLIPSIS
    05.1: right. ...
    >>> grade("05.1", ...)
    Traceback (most recent call last):
    uavlab.exercises.NotYetError: 05.1: not yet. There is no answer yet: put yours in the place of the dots.
    """
    with redirect_stderr(sys.stdout):  # nbgrader takes whatever a cell says on stderr, such as a warning, for a failure
        verdict = check(number, answer)
    if not verdict:
        raise NotYetError(str(verdict))
    print(verdict)


class NotYetError(AssertionError):
    """A wrong answer, of which a notebook shows the hint alone, without the lines that led to it."""

    def _render_traceback_(self) -> list[str]:
        return [str(self)]
