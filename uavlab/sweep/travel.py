"""How cases and results come to where they run and back: as bytes, or as joblib takes them."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Mapping
from typing import Any

import cloudpickle

from uavlab.sweep.failure import Failed, UnpicklableError, described, failed, portable, words


def tried(function: Callable[..., Any], case: dict[str, Any], *, travels: bool) -> Any:
    """What a function returns in a case, or how it failed.

    Everything that it may raise: a cluster waits for ever for a case that ends with what is no `Exception`.
    """
    try:
        return function(**case)
    except BaseException as error:
        return portable(failed(error)) if travels else failed(error)


def packed(function: Callable[..., Any], case: Mapping[str, Any], number: int) -> bytes:
    """A call as bytes, which Dask leaves as they are: other things it spreads over workers, and loses with them."""
    try:
        return cloudpickle.dumps((function, dict(case)))
    except Exception:
        refuse_unpicklable(dict(case), f"case {number} ({words(case)})")
        raise


def unpacked(call: bytes) -> bytes:
    """What came of a call in bytes, in bytes."""
    try:
        function, case = pickle.loads(call)
        value = tried(function, case, travels=True)
    except Exception as error:  # such as a module that this machine hasn't
        value = portable(failed(error))
    try:
        return cloudpickle.dumps(value)
    except Exception as error:
        no = TypeError(f"what the function returned, a {type(value).__name__}, can't be sent back: {described(error)}")
        return cloudpickle.dumps(Failed(no, "", ""))


def opened(content: bytes) -> Any:
    """A result from bytes."""
    try:
        return pickle.loads(content)
    except Exception as error:
        return Failed(TypeError(f"what the function returned can't be read here: {described(error)}"), "", "")


def refuse_unpicklable(thing: Any, name: str) -> None:
    """`UnpicklableError` with the way out, if a thing can't be sent to other processes."""
    try:
        cloudpickle.dumps(thing)
    except Exception as error:
        raise UnpicklableError(
            f"{name} can't be sent to other processes: {described(error):.200}. What it holds or refers to must be "
            "data: open files, locks and connections within the function, or run it in this process, with jobs=1"
        ) from error
