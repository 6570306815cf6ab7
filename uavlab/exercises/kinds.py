"""What an exercise asks for: one number, a whole one, True or False, an array of a shape. Looked at before all else.

Each function here returns a check of one answer: of what the student's function returned, and of its arguments, or of
what was handed over without a function. It says in words what is there instead, or nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sized
from dataclasses import dataclass
from typing import Any

import numpy as np

Kind = Callable[[Any, tuple], str]
Shape = tuple[int | None, ...] | Callable[..., tuple[int | None, ...]]


def asks_for(kind: Kind, *, unchanged: bool = False) -> Callable[[Callable], Callable]:
    """Decorates an exercise with the kind of its answers, and whether given arrays have to stay as they are."""

    def decorated(exercise: Callable) -> Callable:
        exercise.kind, exercise.unchanged = kind, unchanged  # type: ignore[attr-defined]
        return exercise

    return decorated


def asks_for_value(kind: Kind) -> Callable[[Callable], Callable]:
    """Decorates an exercise whose answer is no function but a value: a number that was read off, a route."""

    def decorated(exercise: Callable) -> Callable:
        exercise.value = kind  # type: ignore[attr-defined]
        return exercise

    return decorated


@dataclass(frozen=True)
class Quiz:
    """A question with choices, one of them right; each wrong one has words of its own."""

    right: str
    """The letter of the right choice."""
    because: str
    """Why it is right: said to those who found it."""
    wrong: Mapping[str, str]
    """Letter of each other choice, and what is wrong with it."""

    def hint(self, answer: Any) -> str:
        """What is wrong with an answer, or nothing."""
        letters = sorted([self.right, *self.wrong])
        asked = ", ".join(f'"{letter}"' for letter in letters[:-1]) + f' or "{letters[-1]}"'
        if not isinstance(answer, str):
            return f"You hand over {described(answer)}. The answer is one letter in quotes: {asked}."
        letter = answer.strip(" .()").lower()
        if letter not in letters:
            return f"You hand over {described(answer)}. There are the choices {asked}."
        return self.wrong.get(letter, "")


def number(meaning: str, *, none: bool = False) -> Kind:
    """One number, also as an array without axes; or None, where that is an answer."""

    def complaint(value: Any, arguments: tuple) -> str:
        if (value is None and none) or is_number(value):
            return ""
        return f"{described(value)}. The answer is one number: {meaning}."

    return complaint


def whole_number(meaning: str, *, none: bool = False) -> Kind:
    """One whole number, of whatever type, such as 3 or 3.0."""

    def complaint(value: Any, arguments: tuple) -> str:
        if value is None and none:
            return ""
        if not is_number(value):
            return f"{described(value)}. The answer is one whole number: {meaning}."
        if not float(value).is_integer():
            return f"{float(value):g}. The answer is a whole number: {meaning}."
        return ""

    return complaint


def truth(meaning: str) -> Kind:
    """True or False; 1 and 0 do, too."""

    def complaint(value: Any, arguments: tuple) -> str:
        if isinstance(value, bool | np.bool_) or (is_number(value) and float(value) in (0.0, 1.0)):
            return ""
        return f"{described(value)}. The answer is True or False: {meaning}."

    return complaint


def parts(count: int, meaning: str) -> Kind:
    """A tuple or list of so many parts."""

    def complaint(value: Any, arguments: tuple) -> str:
        if isinstance(value, tuple | list) and len(value) == count:
            return ""
        return f"{described(value)}. The answer has {count} parts: {meaning}."

    return complaint


def numbers(shape: Shape, meaning: str, *, none: bool = False) -> Kind:
    """Numbers of a shape, which may depend on the arguments, in an array, a list or a tuple; None stands for any."""

    def complaint(value: Any, arguments: tuple) -> str:
        if value is None and none:
            return ""
        wanted = shape(*arguments) if callable(shape) else shape
        found = shape_of(value)
        alike = found is not None and len(found) == len(wanted)
        if alike and all(w is None or f == w for f, w in zip(found or (), wanted, strict=True)):
            return ""
        return f"{described(value)}. The answer is {meaning}."

    return complaint


def thing(wanted: type, meaning: str) -> Kind:
    """An object of a class, such as a `Route`."""

    def complaint(value: Any, arguments: tuple) -> str:
        return "" if isinstance(value, wanted) else f"{described(value)}. The answer is {meaning}."

    return complaint


def is_number(value: Any) -> bool:
    """Whether a value is one real number; True and False are none."""
    return shape_of(value) == () and np.asarray(value).dtype.kind in "iuf"


def shape_of(value: Any) -> tuple[int, ...] | None:
    """Of an array, list or tuple of numbers; None when it is something else, or ragged."""
    if isinstance(value, str | bytes | dict | set):
        return None
    try:
        array = np.asarray(value)
    except ValueError:  # rows of different lengths
        return None
    return array.shape if array.dtype.kind in "iufb" else None


def described(value: Any) -> str:
    """A value in words, for "your function returns …" or "you hand over …"."""
    if value is None:
        return "nothing: it needs a line with `return`"
    if isinstance(value, str | bytes):
        return f"text, {str(value)[:40]!r}"
    if isinstance(value, bool | np.bool_):
        return f"{bool(value)}"
    if is_number(value):
        return f"one number, {float(value):.4g}"
    if isinstance(value, np.ndarray):
        return f"an array of shape {value.shape}" + (" of truth values" if value.dtype == bool else "")
    if callable(value):
        return "a function"
    if isinstance(value, list | tuple | dict | set):
        name = {list: "list", tuple: "tuple", dict: "dictionary", set: "set"}.get(type(value), type(value).__name__)
        shape = shape_of(value)
        inner = f" of shape {shape}" if shape is not None and len(shape) > 1 else f" of {len(value)}"
        return f"a {name}{inner}"
    size = f" of {len(value)}" if isinstance(value, Sized) else ""
    return f"a {type(value).__name__}{size}"
