"""Makes the calls of the table, rightful and wrong, and says what becomes of them."""

from __future__ import annotations

import contextlib
import dataclasses
import inspect
import io
import re
import signal
import warnings
from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any, NamedTuple

import numpy as np
import pandas
from calls import CALLS, USES, public
from matplotlib import pyplot
from matplotlib.figure import Figure
from mistakes import mistakes_for, variants_for

TIMEOUT = 5.0
"""What takes longer [s] counts as endless."""

TIMES = {"elapsed"}
"""Keys that differ from call to call."""


class Slow(BaseException):
    """Not an Exception, so that nothing in between takes it for one."""


class Outcome(NamedTuple):
    """What became of a call with one wrong argument."""

    parameter: str
    mistake: str
    kind: str
    """"clear", "cryptic", "ignored", "accepted", "nan out", "slow"; of variants "same", "refused", "differs"."""
    message: str


@contextlib.contextmanager
def within(seconds: float):
    def stop(signum, frame):
        raise Slow

    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


@cache
def functions():
    return public()


def parameters_of(key: str) -> Mapping[str, inspect.Parameter]:
    return inspect.signature(functions()[key.split(":")[0]]).parameters


def invoke(key: str, arguments: Mapping[str, Any]) -> Any:
    """Call with arguments by name; *routes and what stands before them go by place."""
    plain = key.split(":")[0]
    parameters, positional, named = parameters_of(key), [], {}
    starred = any(parameter.kind is parameter.VAR_POSITIONAL for parameter in parameters.values())
    for name, value in arguments.items():
        kind = parameters[name].kind
        if kind is inspect.Parameter.VAR_POSITIONAL:
            positional.extend(value)
        elif kind is inspect.Parameter.VAR_KEYWORD:
            named.update(value)
        elif name == "self" or (starred and kind is not inspect.Parameter.KEYWORD_ONLY):
            positional.append(value)
        else:
            named[name] = value
    with (
        warnings.catch_warnings(),
        contextlib.redirect_stderr(io.StringIO()),
        contextlib.redirect_stdout(io.StringIO()),
    ):
        warnings.simplefilter("ignore")
        return USES.get(plain, functions()[plain])(*positional, **named)


def rightful(key: str) -> dict[str, Any]:
    """Arguments in the order of the parameters."""
    arguments = CALLS[key]()
    return {name: arguments[name] for name in parameters_of(key) if name in arguments}


def places(key: str) -> Iterator[tuple[str, str, bool, Any]]:
    """Name, annotation, whether None is rightful, and rightful value of all that can be replaced."""
    arguments = rightful(key)
    for name, parameter in parameters_of(key).items():
        note = str(parameter.annotation)
        if parameter.kind is parameter.VAR_KEYWORD:
            for inner, value in arguments[name].items():
                yield f"{name}/{inner}", note, False, value
        elif name != "self":
            yield name, note, parameter.default is None or bool(re.search(r"\bNone\b", note)), arguments[name]


def replaced(key: str, name: str, wrong: Any) -> dict[str, Any]:
    """The rightful call with something else in one place."""
    arguments, (outer, _, inner) = rightful(key), name.partition("/")
    if inner:
        arguments[outer] = {**arguments[outer], inner: wrong}
    elif parameters_of(key)[outer].kind is inspect.Parameter.VAR_POSITIONAL:
        arguments[outer] = (*arguments[outer][1:], wrong)
    else:
        arguments[outer] = wrong
    return arguments


def outcomes(key: str) -> list[Outcome]:
    """Of all mistakes in a call."""
    truth = digest(invoke(key, rightful(key)))
    found = []
    for name, note, optional, value in places(key):
        single = (
            value[0] if parameters_of(key)[name.partition("/")[0]].kind is inspect.Parameter.VAR_POSITIONAL else value
        )
        for mistake, wrong in mistakes_for(key, name.rpartition("/")[2], note, optional, single):
            found.append(Outcome(name, mistake, *classify(key, name, wrong, truth)))
    return found


def variants(key: str) -> list[Outcome]:
    """Of all rightful variants of a call."""
    truth = digest(invoke(key, rightful(key)))
    found = []
    for name, note, _, value in places(key):
        if parameters_of(key)[name.partition("/")[0]].kind is inspect.Parameter.VAR_POSITIONAL:
            continue
        for variant, other in variants_for(key, name.rpartition("/")[2], note, value):
            try:
                with within(TIMEOUT):
                    result = digest(invoke(key, replaced(key, name, other)))
            except Slow:
                found.append(Outcome(name, variant, "slow", ""))
            except Exception as error:
                found.append(Outcome(name, variant, "refused", said(error)))
            else:
                kind = "same" if same(truth, result) else "differs"
                found.append(Outcome(name, variant, kind, "" if kind == "same" else f"{result!r:.150}"))
    return found


def classify(key: str, name: str, wrong: Any, truth: Any) -> tuple[str, str]:
    try:
        with within(TIMEOUT):
            result = invoke(key, replaced(key, name, wrong))
    except Slow:
        return "slow", f"over {TIMEOUT:g} s"
    except FileNotFoundError as error:
        return "clear", said(error)
    except (ValueError, TypeError) as error:
        return "clear" if names(str(error), name.rpartition("/")[2]) else "cryptic", said(error)
    except Exception as error:
        return "cryptic", said(error)
    finally:
        pyplot.close("all")
    found = digest(result)
    if same(truth, found):
        return "ignored", "the result is that of the rightful call"
    if not_a_number(found) and not not_a_number(truth):
        return "nan out", f"{found!r:.150}"
    return "accepted", f"{found!r:.150}"


def said(error: BaseException) -> str:
    return f"{type(error).__name__}: {' '.join(str(error).split()):.200}"


def names(message: str, parameter: str) -> bool:
    """Whether a message has a parameter's name as a word; the t of "can't" is none."""
    return re.search(rf"(?<!\w)(?<!\w')(?<!\w’){re.escape(parameter)}(?!\w)", message) is not None


def digest(result: Any) -> Any:
    """A result as plain mappings, tuples, arrays and texts, to compare."""
    if isinstance(result, Figure):
        return figure_digest(result)
    if isinstance(result, pandas.DataFrame):
        return {str(name): digest(result[name].to_numpy()) for name in result}
    if dataclasses.is_dataclass(result) and not isinstance(result, type):
        return {
            field.name: digest(getattr(result, field.name))
            for field in dataclasses.fields(result)
            if field.name not in TIMES
        }
    if isinstance(result, Mapping):
        return {str(name): digest(value) for name, value in result.items() if name not in TIMES}
    if isinstance(result, tuple | list):
        return tuple(map(digest, result))
    if isinstance(result, np.ndarray | np.generic | int | float):
        return np.asarray(result)
    if result is None or isinstance(result, str | bytes):
        return result
    if hasattr(result, "page"):  # a scene
        return {"page": result.page, "height": digest(result.height)}
    if type(result).__module__.startswith(("scipy.stats", "uavlab")) and hasattr(result, "cdf"):
        return digest([result.mean(), result.std(), result.cdf(1.0)])
    return type(result).__name__


def figure_digest(figure: Figure) -> Any:
    parts = [np.array(figure.get_size_inches())]
    for axes in figure.axes:
        parts += [axes.get_title(), axes.get_xlabel(), axes.get_ylabel(), np.array([axes.get_xlim(), axes.get_ylim()])]
        parts += [np.array(line.get_xydata(), dtype=float) for line in axes.lines]
        parts += [str(line.get_label()) for line in axes.lines]
        parts += [np.ma.filled(np.ma.asarray(image.get_array(), dtype=float), np.nan) for image in axes.images]
        for collection in axes.collections:
            shown = collection.get_array()
            parts += [
                np.array([len(collection.get_paths())]),
                digest(np.ma.filled(shown, 0.0)) if shown is not None else "",
            ]
        parts += [text.get_text() for text in axes.texts]
        parts += [
            np.array([patch.get_width(), patch.get_height()]) for patch in axes.patches if hasattr(patch, "get_width")
        ]
    return tuple(parts)


def same(one: Any, other: Any) -> bool:
    """Whether two digests agree, to what 32 bits leave."""
    if type(one) is not type(other):
        return False
    if isinstance(one, dict):
        return one.keys() == other.keys() and all(same(one[name], other[name]) for name in one)
    if isinstance(one, tuple):
        return len(one) == len(other) and all(map(same, one, other))
    if isinstance(one, np.ndarray):
        if one.shape != other.shape:
            return False
        if one.dtype.kind in "biufc" and other.dtype.kind in "biufc":
            return bool(np.allclose(one, other, rtol=1e-6, atol=1e-9, equal_nan=True))
        return one.tobytes() == other.tobytes() if object not in (one.dtype, other.dtype) else repr(one) == repr(other)
    return bool(one == other)


def not_a_number(found: Any) -> bool:
    """Whether there is a NaN or a complex number in a digest."""
    if isinstance(found, dict):
        return any(map(not_a_number, found.values()))
    if isinstance(found, tuple):
        return any(map(not_a_number, found))
    if isinstance(found, np.ndarray):
        return found.dtype.kind == "c" or (found.dtype.kind == "f" and bool(np.isnan(found).any()))
    return False
