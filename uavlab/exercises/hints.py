"""What the checks of all chapters share: whether answers are the same, and which known mistake they look like.

A mistake is recognised by what it answers, not by how it is written. An exercise puts a handful of cases to the
student's function and compares the answers with those of the right formula, then with those of the mistakes that
students are known to make, in order: the first that answers alike has the hint.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np

NOTHING = "Your function returns nothing: it needs a line with `return`."
"""The hint for what most beginners forget."""


def recognised(
    answers: Any,
    mistakes: Iterable[tuple[Callable[..., Any], str]],
    cases: Iterable[Sequence[Any]],
    same: Callable[[Any, Any], bool],
) -> str:
    """Hint of the first mistake that answers the cases in the same way, or nothing.

    Parameters
    ----------
    answers : sequence
        What the student's function answered, one for each case.
    mistakes : iterable of (function, str)
        What else students write, and what to tell them.
    cases : sequence of tuples
        The arguments of each call.
    same : function
        Whether two sequences of answers are the same: `alike`, `each_alike`, or one of the exercise's own.
    """
    for mistake, hint in mistakes:
        if same(answers, [mistake(*case) for case in cases]):
            return hint
    return ""


def recognised_value(
    value: float, mistakes: Iterable[Sequence[Any]], relative: float = 0.01, absolute: float = 0.0
) -> str:
    """Hint of the first known wrong value that a number is close to, or nothing.

    Parameters
    ----------
    value : float
        What the student hands over.
    mistakes : iterable of (float, str) or (float, float, str)
        What else students find, how close is close where that is its own, and what to tell them.
    relative, absolute : float
        How close is close: a share of the wrong value or a difference, whichever is more.
    """
    for wrong, *near, hint in mistakes:
        if abs(value - wrong) <= (near[0] if near else max(relative * abs(wrong), absolute)):
            return hint
    return ""


def alike(answers: Any, wanted: Any, relative: float = 1e-6, absolute: float = 1e-8) -> bool:
    """Whether numbers are the same but for rounding, all at once: answers of one shape."""
    return bool(np.allclose(answers, wanted, rtol=relative, atol=absolute))


def each_alike(answers: Iterable[Any], wanted: Iterable[Any], same: Callable[[Any, Any], bool] = alike) -> bool:
    """Whether answers are the same one by one, up to the first that isn't: they may differ in shape."""
    return all(same(one, other) for one, other in zip(answers, wanted, strict=True))
