"""The same function over many cases: on one core, on many, or on a cluster.

joblib does the work: where it runs is for the caller to say, `with joblib.parallel_config("dask"): sweep(…)`, and the
results don't depend on it, because each case brings its own seed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from numbers import Integral
from typing import Any

import joblib
import numpy as np
from tqdm import tqdm


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
    cases : iterable of mappings
        Keyword arguments of each call.
    jobs : int, optional
        Processes, −1 for one per core. By default what `joblib.parallel_config` says, else 1.
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
        If `jobs` is 0 or no whole number, or cases share a random generator: what one of them draws would be missing
        in the next on one core, and not on two.
    Exception
        What the function raises; a note says in which case.
    """
    if jobs is not None and (not isinstance(jobs, Integral) or jobs == 0):
        raise ValueError(f"jobs must be a number of processes, or −1 for one per core, got {jobs!r}")
    cases = list(cases)
    refuse_shared_generators(cases)
    calls = (joblib.delayed(called)(function, dict(case)) for case in cases)
    backend, _ = joblib.parallel.get_active_backend()
    ordered = "generator" if backend.supports_return_generator else "list"  # Ray's, for one, gives all at the end
    results = joblib.Parallel(n_jobs=jobs, return_as=ordered)(calls)
    return list(tqdm(results, total=len(cases), unit=unit, disable=not progress))


def refuse_shared_generators(cases: list[Mapping[str, Any]]) -> None:
    owners: dict[int, int] = {}
    for number, case in enumerate(cases):
        for name, value in case.items():
            if isinstance(value, np.random.Generator) and owners.setdefault(id(value), number) != number:
                raise ValueError(
                    f"cases {owners[id(value)]} and {number} share {name}, a random generator, so that results would "
                    f"depend on where they run: give each a seed, or one of {name}.spawn({len(cases)})"
                )


def called(function: Callable[..., Any], case: dict[str, Any]) -> Any:
    try:
        return function(**case)
    except Exception as error:
        error.add_note("in the case " + ", ".join(f"{name}={value!r:.80}" for name, value in case.items()))
        raise
