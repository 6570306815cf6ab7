"""Cases that came to nothing: what is kept of them, in this process and on its way from another."""

from __future__ import annotations

import pickle
import traceback
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import cloudpickle


@dataclass(frozen=True, eq=False, repr=False)
class Failure:
    """A case of a sweep that failed; it stands where its result would.

    Attributes
    ----------
    case : mapping
        Keyword arguments of the call.
    exception : BaseException
        What the function raised, without its frames; a `WorkerLostError` if its process ended.
    number : int
        Which of the cases, from 0.
    traceback : str
        The lines where it rose, as Python shows them.

    See Also
    --------
    sweep : Makes one, unless it is asked to raise.

    Examples
    --------
    >>> import warnings
    >>> from uavlab.sweep import Failure, sweep
    >>> with warnings.catch_warnings(action="ignore"):
    ...     results = sweep(pow, [{"base": 2, "exp": -1, "mod": mod} for mod in (4, 5)], progress=False)
    >>> results
    [<Failure of case 0: ValueError: base is not invertible for the given modulus>, 3]
    >>> [result for result in results if not isinstance(result, Failure)]
    [3]
    """

    case: Mapping[str, Any]
    exception: BaseException
    number: int
    traceback: str

    def __repr__(self) -> str:
        return f"<Failure of case {self.number}: {described(self.exception):.100}>"

    def __reduce__(self) -> tuple[Any, ...]:  # one of a sweep within a case travels, too
        exception = portable(Failed(self.exception, "", "")).exception
        return Failure, (self.case, exception, self.number, self.traceback)


class WorkerLostError(RuntimeError):
    """The process that ran a case ended again and again: killed, out of memory, or by a fault in compiled code.

    See Also
    --------
    Failure : Holds one.

    Examples
    --------
    >>> from uavlab.sweep import WorkerLostError
    >>> issubclass(WorkerLostError, RuntimeError)
    True
    """


class UnpicklableError(ValueError, pickle.PicklingError):
    """A function, or a case, can't be sent to other processes.

    See Also
    --------
    sweep : Raises it.

    Examples
    --------
    >>> from uavlab.sweep import UnpicklableError
    >>> issubclass(UnpicklableError, ValueError)
    True
    """


class ForeignError(RuntimeError):
    """An exception of another process that can't be made again in this one: its words alone."""


class RemoteError(Exception):
    """The lines of another process, where an exception rose."""

    def __str__(self) -> str:
        return f"\n{self.args[0]}"


class Failed(NamedTuple):
    """An exception as it travels from where it rose."""

    exception: BaseException
    traceback: str
    place: str


def failed(error: BaseException) -> Failed:
    """An exception with the lines of the function that raised it, without those of the sweep."""
    frames = error.__traceback__ and error.__traceback__.tb_next
    lines = "".join(traceback.format_exception(type(error), error, frames))
    last = traceback.extract_tb(frames)[-1:]
    return Failed(error, lines, "".join(f"{frame.filename}:{frame.lineno}" for frame in last))


def portable(one: Failed) -> Failed:
    """The same, with an exception that other processes can read: not all can be made again from what they hold.

    One that words its message itself would word it twice; so what is read must say the same.
    """
    text = described(one.exception)
    try:
        same = described(pickle.loads(cloudpickle.dumps(one.exception))) == text
    except Exception:
        same = False
    return one if same else one._replace(exception=ForeignError(text))


def without_frames(error: BaseException) -> BaseException:
    """An exception that keeps no frame, and so none of the arrays in it, alive."""
    seen: set[int] = set()
    chain: list[BaseException | None] = [error]
    while chain:
        one = chain.pop()
        if one is None or id(one) in seen:
            continue
        seen.add(id(one))
        one.__traceback__ = None
        chain += [one.__cause__, one.__context__, *getattr(one, "exceptions", ())]
    return error


def described(error: BaseException) -> str:
    """An exception in one line: KeyError: 'nothing there'."""
    if type(error) is ForeignError:
        return str(error)
    try:
        text = str(error)
    except Exception:
        text = "<exception str() failed>"
    return " ".join(f"{type(error).__qualname__}{': ' * bool(text)}{text}".split())


def words(case: Mapping[str, Any]) -> str:
    """A case for a message: x=3, name='much'."""
    return ", ".join(f"{name}={shown(value)}" for name, value in case.items())


def shown(value: Any) -> str:
    """The beginning of what a value says of itself; some say nothing but an error."""
    try:
        return f"{value!r:.80}"
    except Exception:
        return f"<{type(value).__name__}>"


def ranges(numbers: Iterable[int]) -> str:
    """Numbers for a message: 0–41, 43, 50–57."""
    runs: list[list[int]] = []
    for number in sorted(numbers):
        if runs and number == runs[-1][1] + 1:
            runs[-1][1] = number
        else:
            runs.append([number, number])
    shown = [f"{first}" if first == last else f"{first}–{last}" for first, last in runs]
    return ", ".join(shown[:10]) + f" and {len(shown) - 10} ranges more" * (len(shown) > 10)
