"""The one wrapper around numba: hot loops stay plain Python and run at the speed of C.

`@compiled` translates a function at its first call and keeps the result on disk, so that only the first run on a
machine waits for it. Division by zero gives ±∞ or NaN, as in NumPy: to look for it costs a sixth of the time of a
flight. Where no cache folder can be written, the function is translated again in each process, after
one warning; where there is no numba, it stays the Python that it is, after another.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path
from time import time as now
from typing import Any, TypeVar

try:
    import numba
    import numba.extending
    from numba.core import config
    from numba.core.caching import FunctionCache
except ImportError:
    numba, FunctionCache = None, object  # type: ignore[assignment,misc]

F = TypeVar("F", bound=Callable)


def compiled(function: F) -> F:
    """Compile a function of numbers, arrays and named tuples with numba, cached on disk where that is possible."""
    if numba is None:
        warn_of_slowness()
        return function
    if config.DISABLE_JIT:  # type: ignore[attr-defined]  # NUMBA_DISABLE_JIT=1, to step through with a debugger
        return function
    try:
        dispatcher: Any = numba.njit(cache=True, error_model="numpy")(function)
    except RuntimeError:  # numba found no folder that it may write
        warn_of_folder()
        uncached: Any = numba.njit(error_model="numpy")(function)
        return uncached
    discard_stale(Path(dispatcher.stats.cache_path))
    dispatcher._cache = MendingCache(function)
    return dispatcher


def compilable(function: F) -> F:
    """A formula for numbers and arrays alike: NumPy's where Python calls it, compiled with what calls it there."""
    return function if numba is None else numba.extending.register_jitable(function)


class MendingCache(FunctionCache):
    """A cache on disk that is emptied where it can't be read, after a full disk or a killed process."""

    def load_overload(self, signature: Any, target_context: Any) -> Any:
        try:
            return super().load_overload(signature, target_context)
        except Exception:  # unpickling garbage raises anything
            self.flush()
            return None


@cache
def warn_of_slowness() -> None:
    warnings.warn(
        "numba isn't installed, so planners and flights run as plain Python: all answers are the same, a hundred times "
        'later; pip install numba, or "uavlab" with what it needs',
        RuntimeWarning,
        stacklevel=3,
    )


@cache
def warn_of_folder() -> None:
    warnings.warn(
        "numba's cache folder can't be written, so the planners are compiled anew in each run (about ten seconds); "
        "set NUMBA_CACHE_DIR to a folder you may write",
        RuntimeWarning,
        stacklevel=3,
    )


@cache
def discard_stale(folder: Path) -> None:
    """Drop cached code older than the newest source of the package.

    numba looks only at the file of the function itself; an edit in another file that it calls would go unnoticed.
    """
    changed = [source.stat().st_mtime for source in Path(__file__).parent.rglob("*.py")]
    newest = max((moment for moment in changed if moment <= now()), default=0.0)  # a clock that ran ahead says nothing
    for index in folder.glob("*.nbi"):
        with suppress(FileNotFoundError):  # another process may drop it first
            if index.stat().st_mtime < newest:
                index.unlink()
