"""The same function over many cases: on one core, on many, or on a cluster.

joblib does the work: where it runs is for the caller to say, `with joblib.parallel_config("dask"): sweep(…)`, and the
results don't depend on it, because each case brings its own seed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

import joblib
import numpy as np
from tqdm import tqdm

from uavlab import checks


def sweep(
    function: Callable[..., Any],
    cases: Iterable[Mapping[str, Any]],
    *,
    jobs: int | None = None,
    progress: bool = True,
    unit: str = "case",
) -> list[Any]:
    """Call a function once for each case.

    Parameters
    ----------
    function : callable
        At the top of a module, if it is to run in other processes.
    cases : iterable of mappings
        Keyword arguments of each call.
    jobs : int, optional
        Processes, −1 for one per core; at most 10,000. By default what `joblib.parallel_config` says, else 1.
    progress : bool
        Show a bar.
    unit : str
        What the bar counts.

    Returns
    -------
    list
        The results, in the order of the cases.

    Raises
    ------
    ValueError
        If `function` can't be called, `cases` are no mappings, `jobs` is 0, no whole number or above 10,000, `progress`
        is not True or False, or `unit` is no text; if `cases` share a random generator: what one of them draws would be
        missing in the next on one core, and not on two.
    Exception
        What `function` raises; a note says in which case.

    See Also
    --------
    uavlab.prediction.compare_models : a sweep over seeds.
    uavlab.planners.compare_planners : one over planners and seeds.

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
    checks.flag("progress", progress)
    checks.text("unit", unit)
    cases = checks.several("cases", cases, Mapping, least=0)
    refuse_shared_generators(cases)
    calls = (joblib.delayed(called)(function, dict(case)) for case in cases)
    backend, _ = joblib.parallel.get_active_backend()
    ordered = "generator" if backend.supports_return_generator else "list"  # Ray's, for one, gives all at the end
    results = joblib.Parallel(n_jobs=jobs, return_as=ordered)(calls)
    return list(tqdm(results, total=len(cases), unit=unit, disable=not progress))


def refuse_shared_generators(cases: list[Mapping[str, Any]]) -> None:
    """Refuse cases of which two have the same random generator.

    Parameters
    ----------
    cases : list of mappings
        Keyword arguments.

    Returns
    -------
    None

    Raises
    ------
    ValueError
        If one generator stands in two of `cases`.

    See Also
    --------
    sweep : asks it.

    Examples
    --------
    >>> import numpy as np
    >>> from uavlab.sweep import refuse_shared_generators
    >>> rng = np.random.default_rng(0)
    >>> refuse_shared_generators([{"rng": rng}, {"rng": rng}])
    Traceback (most recent call last):
        ...
    ValueError: cases 0 and 1 share rng, a random generator, so that results would depend on where they ...
    >>> refuse_shared_generators([{"rng": child} for child in rng.spawn(2)])
    """
    owners: dict[int, int] = {}
    for number, case in enumerate(cases):
        for name, value in case.items():
            if isinstance(value, np.random.Generator) and owners.setdefault(id(value), number) != number:
                raise ValueError(
                    f"cases {owners[id(value)]} and {number} share {name}, a random generator, so that results would "
                    f"depend on where they run: give each a seed, or one of {name}.spawn({len(cases)})"
                )


def called(function: Callable[..., Any], case: dict[str, Any]) -> Any:
    """What a function returns in a case; its exception gets a note that says in which.

    Parameters
    ----------
    function : callable
        To be called.
    case : dict
        Keyword arguments.

    Returns
    -------
    object
        What the function returns.

    Raises
    ------
    Exception
        What `function` raises.

    See Also
    --------
    sweep : calls it for each case.

    Examples
    --------
    >>> from uavlab.sweep import called
    >>> called(pow, {"base": 2, "exp": 10})
    1024
    """
    try:
        return function(**case)
    except Exception as error:
        error.add_note("in the case " + ", ".join(f"{name}={value!r:.80}" for name, value in case.items()))
        raise
