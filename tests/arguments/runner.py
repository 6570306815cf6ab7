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
from functools import cache, partial
from typing import Any, NamedTuple

import numpy as np
import pandas
from calls import CALLS, USES, public
from matplotlib import pyplot
from matplotlib.figure import Figure
from mistakes import LENIENT, Spot, mistakes_for, variants_for

TIMEOUT = 15.0
"""A mistake that takes longer [s] counts as endless."""

PATIENCE = 30.0
"""And a rightful call, which may have to be compiled on a busy machine [s]."""

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

    if not hasattr(signal, "SIGALRM"):  # on Windows
        yield
        return
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


@cache
def said_of(key: str, name: str) -> str:
    """What the documentation says of a parameter: its own entry, else all of it."""
    text = inspect.getdoc(functions()[key.split(":")[0]]) or ""
    entry = re.search(rf"^(?:[\w, ]+, )?{re.escape(name)}(?:, [\w, ]+)? : .*(?:\n .*)*", text, re.MULTILINE)
    return entry[0] if entry else text


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
        try:
            return USES.get(plain, functions()[plain])(*positional, **named)
        finally:
            pyplot.close("all")


def rightful(key: str) -> dict[str, Any]:
    """Arguments in the order of the parameters."""
    arguments = CALLS[key]()
    return {name: arguments[name] for name in parameters_of(key) if name in arguments}


def spots(key: str) -> Iterator[tuple[str, Spot]]:
    """All that can be replaced in a call, by where it stands: "speed", or "site/noise" under **site.

    Of *routes the last is replaced, and looks as the first.
    """
    arguments = rightful(key)
    for name, parameter in parameters_of(key).items():
        note, value = str(parameter.annotation), arguments[name]
        optional = parameter.default is None or "None" in re.findall(r"\w+", note)
        about = partial(Spot, key.split(":")[0])
        if parameter.kind is parameter.VAR_KEYWORD:
            for inner, item in value.items():
                yield f"{name}/{inner}", about(inner, note, said_of(key, inner), False, item)
        elif parameter.kind is parameter.VAR_POSITIONAL:
            yield name, about(name, note, said_of(key, name), False, value[0])
        elif name != "self":
            yield name, about(name, note, said_of(key, name), optional, value)


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
    return [
        Outcome(where, mistake, *classify(key, where, spot, mistake, wrong, truth))
        for where, spot in spots(key)
        for mistake, wrong in mistakes_for(spot)
    ]


def variants(key: str) -> list[Outcome]:
    """Of all rightful variants of a call."""
    truth = digest(invoke(key, rightful(key)))
    return [
        Outcome(where, variant, *compare(key, where, other, truth))
        for where, spot in spots(key)
        for variant, other in variants_for(spot)
    ]


def compare(key: str, where: str, other: Any, truth: Any) -> tuple[str, str]:
    try:
        with within(PATIENCE):
            result = digest(invoke(key, replaced(key, where, other)))
    except Slow:
        return "slow", f"over {PATIENCE:g} s"
    except Exception as error:
        return "refused", said(error)
    return ("same", "") if same(truth, result) else ("differs", f"{result!r:.150}")


def classify(key: str, where: str, spot: Spot, mistake: str, wrong: Any, truth: Any) -> tuple[str, str]:
    try:
        with within(TIMEOUT):
            found = digest(invoke(key, replaced(key, where, wrong)))
    except Slow:
        return "slow", f"over {TIMEOUT:g} s"
    except OSError as error:
        return "clear" if error.filename is not None else "cryptic", said(error)
    except (ValueError, TypeError) as error:
        return "clear" if any(names(str(error), name) for name in names_of(spot)) else "cryptic", said(error)
    except Exception as error:
        return "cryptic", said(error)
    if not_a_number(found) and not not_a_number(truth):
        return "nan out", f"{found!r:.150}"
    if mistake in LENIENT:
        return "clear", "taken"
    if same(truth, found):
        return "ignored", "the result is that of the rightful call"
    return "accepted", f"{found!r:.150}"


def names_of(spot: Spot) -> list[str]:
    """What a message may call a parameter: in tables the column, too."""
    return [spot.name, *(spot.value.columns if isinstance(spot.value, pandas.DataFrame) else ())]


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
        parts = tuple(map(digest, result))
        numbers = all(isinstance(part, np.ndarray) and not part.shape and part.dtype.kind in "biuf" for part in parts)
        return np.array(parts, dtype=float) if parts and numbers else parts
    if result is None or isinstance(result, str | bytes):
        return str(result) if isinstance(result, str) else result
    if isinstance(result, np.ndarray | np.generic | int | float):
        return np.asarray(result)
    if hasattr(result, "page"):  # a scene
        return {"page": result.page, "height": digest(result.height)}
    if hasattr(result, "html"):  # a figure with sliders
        return {"html": result.html, "alt": result.alt}
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
