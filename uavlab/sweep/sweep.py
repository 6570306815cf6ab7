"""The sweep itself: cases in, results out in their order, and words for what went wrong."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable, Mapping
from contextlib import closing
from os import PathLike
from typing import Any

from tqdm import tqdm

from uavlab import checks
from uavlab.sweep.failure import Failed, Failure, RemoteError, described, ranges, without_frames, words
from uavlab.sweep.generators import OwnGenerators
from uavlab.sweep.rows import NoRows, Rows, header_of
from uavlab.sweep.workers import finished

ON_ERROR = ("record", "raise")


def sweep(
    function: Callable[..., Any],
    cases: Iterable[Mapping[str, Any]],
    *,
    jobs: int | None = None,
    on_error: str = "record",
    to: str | PathLike[str] | None = None,
    progress: bool = True,
    unit: str = "case",
) -> list[Any]:
    """Call a function once for each case.

    Where a process dies that has a case (killed, out of memory, a fault in compiled code), the case runs again, the
    third time alone; if its process dies then, too, the case has failed.

    Parameters
    ----------
    function : callable
        For other processes, what it refers to must be data: no open files, locks or connections. Its results may
        depend on nothing but the case.
    cases : iterable of mappings
        Keyword arguments of each call. What draws at random brings a seed, or a generator that no other case has; it
        draws from a copy of that, so that the same call gives the same results.
    jobs : int, optional
        Processes, −1 for one per core; at most 10,000. By default what `joblib.parallel_config` says, else 1. A cluster
        of Dask or Ray has as many as it has.
    on_error : {"record", "raise"}
        "record": a case that fails leaves a `Failure` in the place of its result, the others go on, and one warning
        ends the sweep. "raise": the first one that fails stops it.
    to : str or Path, optional
        A file that gets a row for each case as it ends, or of cases that take less than a second, a few of them at
        once. The same call goes on from a file of that name: it runs only cases that are missing or that failed.
        Results that JSON can't hold exactly are arrays in base64, or dataclasses by their fields; nothing is pickled,
        so that a file of unknown origin can't run anything, though it can say what isn't so. The function counts by
        its name; if its own text has changed, results are kept, and the warning says so.
    progress : bool
        Show a bar, with the time left.
    unit : str
        What the bar counts.

    Returns
    -------
    list
        The results, in the order of the cases.

    Raises
    ------
    ValueError
        If `function` can't be called, `cases` are no mappings, `jobs` is 0, no whole number or above 10,000, `on_error`
        is unknown, `progress` is not True or False, `unit` is no text, or `to` is not the name of a file; if `cases`
        share a random generator, or `function` holds one: what one of them draws would be missing in the next on one
        core, and not on two. With several processes, if `function` or one of `cases` can't be pickled. With `to`, if
        two of `cases` are equal (else they run twice), if `function` is a lambda, if `cases` hold what can't be told
        from others or results what a file can't hold, and if the file is of another sweep or version, or damaged before
        its last line.
    OSError
        If `to` can't be written, as on a full disk. What was written before stays whole.
    Exception
        With `on_error="raise"` what `function` raises; a note says in which case. `KeyboardInterrupt` always.

    Warns
    -----
    RuntimeWarning
        Once, at the end, if cases failed or workers died: how many, which, and why the first. And if the file was begun
        with another text of `function`, or was replaced while the sweep ran.

    See Also
    --------
    Failure : What stands for a case that failed.
    uavlab.prediction.compare_models : a sweep over seeds.
    uavlab.planners.compare_planners : one over planners and seeds.

    Notes
    -----
    Dask runs cases of a dead worker on another one by itself. Without a worker it waits for one. A pool of Ray, or of
    multiprocessing, gives results in blocks of some seconds; that of multiprocessing waits for ever if a process dies.

    Examples
    --------
    >>> from uavlab.sweep import sweep
    >>> sweep(pow, [{"base": 2, "exp": exponent} for exponent in range(5)], progress=False)
    [1, 2, 4, 8, 16]
    """
    if not callable(function):
        raise ValueError(f"function must be a function, called with a case's keyword arguments, got {function!r:.60}")
    if jobs is not None:
        jobs = checks.processes("jobs", jobs)
    checks.one_of("on_error", on_error, ON_ERROR)
    checks.flag("progress", progress)
    checks.text("unit", unit)
    cases = checks.several("cases", cases, Mapping, least=0)
    own = OwnGenerators(function, cases)
    rows = NoRows() if to is None else Rows(checks.path("to", to), header_of(function, cases), len(cases))
    losses: list[str] = []
    places: dict[int, str] = {}
    with rows:
        missing = [number for number in range(len(cases)) if number not in rows.results]
        try:
            with (
                # the mean speed: a few cases that take long say little of those to come
                tqdm(total=len(cases), initial=len(rows.results), unit=unit, disable=not progress, smoothing=0) as bar,
                closing(finished(function, own, missing, jobs, losses)) as outcomes,
            ):
                for number, result in outcomes:
                    if isinstance(result, Failed):
                        places[number] = result.place
                        result = recorded(result, cases[number], number, on_error)
                    rows.add(number, result)
                    bar.update()
            rows.finish()
        except BaseException as error:
            if (to is not None or isinstance(error, KeyboardInterrupt)) and str(rows) not in str(error):
                error.add_note(str(rows))
            raise
    results = [rows.results[number] for number in range(len(cases))]
    warn_of(results, places, losses, rows.remarks)
    return results


def recorded(result: Failed, case: Mapping[str, Any], number: int, on_error: str) -> Failure:
    """The failure of a case, unless it is to stop the sweep, as Ctrl-C always does."""
    if isinstance(result.exception, KeyboardInterrupt):
        raise result.exception
    if on_error == "raise":
        raise raised(result, case)
    return Failure(case, without_frames(result.exception), number, result.traceback)


def raised(result: Failed, case: Mapping[str, Any]) -> BaseException:
    """The exception of a case, ready to be raised here: with its case, and the lines of another process."""
    error = result.exception
    error.add_note(f"in the case {words(case)}")
    if error.__traceback__ is None and result.traceback:
        error.__cause__ = RemoteError(result.traceback)
    return error


def warn_of(results: list[Any], places: dict[int, str], losses: list[str], remarks: list[str]) -> None:
    """One warning for all that went wrong."""
    said = list(remarks)
    if places:
        first = results[number := min(places)]
        where = f" at {places[number]}" if places[number] else ""
        said.append(
            f"{len(places)} of {len(results)} cases failed ({ranges(places)}); the first, case {number} "
            f"({words(first.case)}), with {described(first.exception)}{where}"
        )
    if losses:
        more = f"; and {len(losses) - 5} times more" if len(losses) > 5 else ""
        said.append("; ".join(losses[:5]) + more)
    if said:
        warnings.warn("; ".join(said), RuntimeWarning, stacklevel=3)
