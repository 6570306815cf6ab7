"""A student's function as a check calls it: with arguments of its own, for a limited time, and every failure kept.

What an answer does wrong is told apart from what a check does wrong: only exceptions that leave the student's function
are the student's. A loop without end is stopped from outside, on every system and in Jupyter, as long as it is Python
that runs. The time that numba takes to compile isn't counted.
"""

from __future__ import annotations

import ctypes
import linecache
import reprlib
import sys
import threading
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from time import monotonic
from types import FrameType
from typing import Any

import numpy as np

SECONDS = 5.0
"""That one call of an answer may take."""
LONGEST = 160
"""Of an input in a hint [characters]."""


class OutOfTimeError(BaseException):
    """Raised in an answer that runs too long; `except Exception` doesn't hold it up."""


class WrongKindError(Exception):
    """An answer of another type or shape than is asked for; its text is the hint."""


class Watched:
    """A function that is called with copies of its arguments; what it raises, and how long it runs, is kept."""

    def __init__(
        self, function: Callable[..., Any], kind: Callable[[Any, tuple], str] | None = None, unchanged: bool = False
    ) -> None:
        self.function, self.kind, self.unchanged = function, kind, unchanged
        self.failure: BaseException | None = None
        self.arguments: tuple = ()
        self.compiled: Callable[[], float] = lambda: 0.0
        """Seconds for which numba has compiled."""
        self.began: float | None = None
        self.compiling = 0.0

    def __call__(self, *arguments: Any) -> Any:
        """What the function returns, of the kind that is asked for."""
        own = copied(arguments)
        self.arguments, self.compiling, self.began = arguments, self.compiled(), monotonic()
        try:
            value = self.function(*own)
        except BaseException as failure:
            self.failure = failure
            raise
        finally:
            self.began = None
        if self.kind and (complaint := self.kind(value, arguments)):
            who = f"For {shown(arguments)} your" if arguments else "Your"
            raise WrongKindError(f"{who} function returns {complaint}")
        if self.unchanged and not same(own, arguments):
            raise WrongKindError(
                f"For {shown(arguments)} your function changes an array that it is given. Work on a copy: the caller "
                "may still need it."
            )
        return value

    def seconds(self) -> float:
        """How long the call that is going on has taken; 0 when there is none."""
        began = self.began
        return 0.0 if began is None else monotonic() - began - (self.compiled() - self.compiling)

    def line_of(self, frames: list[tuple[FrameType, int]]) -> str:
        """The student's own line, stripped, that the innermost of these frames and line numbers stands in."""
        code = getattr(self.function, "__code__", None)
        for frame, number in reversed(frames):
            if code is not None and frame.f_code.co_filename == code.co_filename:
                return linecache.getline(code.co_filename, number, frame.f_globals).strip()
        return ""


def copied(value: Any) -> Any:
    """Arrays, tables, lists, tuples, dictionaries and sets anew, whatever is in them too; all else as it is."""
    if isinstance(value, np.ndarray) or is_table(value):
        return value.copy()
    if isinstance(value, dict):
        return {key: copied(one) for key, one in value.items()}
    if type(value) in (list, tuple, set):
        return type(value)(copied(one) for one in value)
    return value


def is_table(value: Any) -> bool:
    """Whether a value is one of pandas, which isn't imported for it."""
    return type(value).__module__.partition(".")[0] == "pandas"


def same(one: Any, other: Any) -> bool:
    """Whether two arguments, or all in them, are the same."""
    if isinstance(one, np.ndarray):
        return np.array_equal(one, other)
    if is_table(one):
        return one.equals(other)
    if type(one) in (list, tuple):
        return len(one) == len(other) and all(map(same, one, other))
    return True


def shown(arguments: tuple) -> str:
    """The input of a call in a hint, shortened."""
    with np.printoptions(threshold=8, edgeitems=2, precision=4):
        texts = [" ".join(str(one).split()) if isinstance(one, np.ndarray) else reprlib.repr(one) for one in arguments]
    text = f"({', '.join(texts)})"
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 1]}…"


@contextmanager
def compile_clock() -> Iterator[Callable[[], float]]:
    """Within this, a function that says for how many seconds numba has compiled."""
    from uavlab import compiled  # not before the first check: numba is slow to import

    if compiled.numba is None:
        yield lambda: 0.0
        return
    from numba.core import event

    class Clock(event.Listener):
        done, depth, began = 0.0, 0, 0.0

        def on_start(self, event: Any) -> None:
            if self.depth == 0:
                self.began = monotonic()
            self.depth += 1

        def on_end(self, event: Any) -> None:
            self.depth -= 1
            if self.depth == 0:
                self.done += monotonic() - self.began

        def seconds(self) -> float:
            return self.done + (monotonic() - self.began if self.depth else 0.0)

    clock = Clock()
    with event.install_listener("numba:compile", clock):
        yield clock.seconds


def hint_from(check: Callable[[Watched], str], answer: Watched) -> str:
    """The hint of a check, which runs in a thread of its own; every failure of the answer is a hint, too.

    Raises
    ------
    Exception
        What the check raised, not the answer.
    """
    found: list[str] = []
    failed: list[BaseException] = []

    def work() -> None:
        try:
            found.append(check(answer))
        except BaseException as failure:
            failed.append(failure)

    thread = threading.Thread(target=work, daemon=True)
    with compile_clock() as answer.compiled, ended(thread):
        thread.start()
        while thread.is_alive():
            thread.join(0.02)
            if answer.seconds() > SECONDS:
                return too_long(answer, thread)
    if found:
        return found[0]
    if failed[0] is answer.failure:
        return failure_hint(answer)
    if isinstance(failed[0], WrongKindError):
        return str(failed[0])
    raise failed[0]


@contextmanager
def ended(thread: threading.Thread) -> Iterator[None]:
    """See to it that a thread doesn't run on, as far as that can be had."""
    try:
        yield
    finally:
        for _ in range(20):
            if not thread.is_alive():
                break
            ctypes.pythonapi.PyThreadState_SetAsyncExc(
                ctypes.c_ulong(thread.ident or 0), ctypes.py_object(OutOfTimeError)
            )
            thread.join(0.1)


def too_long(answer: Watched, thread: threading.Thread) -> str:
    """The hint for a call that takes too long, with the line where it was last seen."""
    frame = sys._current_frames().get(thread.ident or 0)
    line = answer.line_of(list(traceback.walk_stack(frame))[::-1]) if frame else ""
    place = f" It is in the line `{line}`." if line else ""
    return (
        f"For {shown(answer.arguments)} it still runs after {SECONDS:g} seconds, and was stopped.{place} If that is in "
        "a loop: what changes in each round, so that it ends?"
    )


def failure_hint(answer: Watched) -> str:
    """The hint for an exception, with the line where it came up and the input."""
    failure = answer.failure
    if isinstance(failure, NotImplementedError):
        return "There is no answer yet: the function still raises NotImplementedError."
    assert failure is not None
    line = answer.line_of(list(traceback.walk_tb(failure.__traceback__)))
    place = f" in the line `{line}`" if line else ""
    text = f"Your function raises {type(failure).__name__}: {failure},{place} for {shown(answer.arguments)}."
    if isinstance(failure, RecursionError):
        text += " It calls itself without end: which case should answer at once?"
    return text
