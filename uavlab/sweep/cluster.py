"""Cases on a cluster of Dask: in batches of half a second, and again elsewhere if their worker goes.

joblib has a way to Dask, too, and it is by `joblib.parallel_config("dask")` that a caller asks for it. But joblib isn't
told when a case has killed all workers that tried it, or a result is lost with its worker, and waits for ever; and
while only one core is left, it runs cases in the caller's own process.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from itertools import islice
from typing import Any
from uuid import uuid4

from uavlab.sweep.failure import Failed, WorkerLostError, ranges, words
from uavlab.sweep.travel import opened, packed, refuse_unpicklable, unpacked

LEAST, MOST = 0.2, 1.0
"""How long [s] a batch should take: shorter ones cost more on the way, of longer ones more is lost with a worker."""

AHEAD = 2
"""Batches for each core that are given to the scheduler beforehand."""


def on_dask(
    backend: Any, function: Callable[..., Any], cases: Sequence[Mapping[str, Any]], numbers: Sequence[int], losses: list
) -> Generator[tuple[int, Any]]:
    """The number of each case and what became of it, as they end; `losses` gets a sentence for each dead worker."""
    import distributed

    refuse_unpicklable(function, "function")
    client, sweep = backend.client, uuid4().hex
    batches: dict[Any, list[int]] = {}
    keys: dict[str, list[int]] = {}
    waiting, alone, trial, size = iter(numbers), list[int](), False, 1

    def submit(batch: list[int]) -> None:
        calls = [packed(function, cases[number], number) for number in batch]
        key = f"sweep-{sweep}-{len(keys)}"
        keys[key] = batch
        batches[client.submit(all_unpacked, calls, key=key, **backend.submit_kwargs)] = batch

    try:
        while True:
            while len(batches) < AHEAD * max(sum(client.ncores().values()), 1) and (
                batch := list(islice(waiting, size))
            ):
                submit(batch)
            if not batches and alone:
                trial = True
                submit([alone.pop()])
            if not batches:
                break
            for future in distributed.wait(list(batches), return_when="FIRST_COMPLETED").done:
                batch = batches.pop(future)
                try:
                    contents, took = future.result()
                except distributed.scheduler.KilledWorker as error:
                    if trial:
                        yield batch[0], Failed(WorkerLostError(how_it_was_killed(error, cases[batch[0]])), "", "")
                    else:
                        alone += batch  # it may have been another one on the same worker
                    continue
                size = next_size(size, len(batch), took)
                for number, content in zip(batch, contents, strict=True):
                    yield number, opened(content)
    finally:
        client.cancel(list(batches))
        losses += gone(client, keys)


def next_size(size: int, had: int, took: float) -> int:
    """How many cases the next batch has, after one that took some time [s]."""
    if took < LEAST:
        return max(size, 2 * had)
    return max(had // 2, 1) if took > MOST else size


def all_unpacked(contents: list[bytes]) -> tuple[list[bytes], float]:
    """What came of the cases of a batch, and how long they took together [s]."""
    began = time.perf_counter()
    return [unpacked(content) for content in contents], time.perf_counter() - began


def how_it_was_killed(error: Any, case: Mapping[str, Any]) -> str:
    """Words on a case that ran alone, and killed each worker that tried it."""
    return (
        f"{error.allowed_failures + 1} workers died of it, one after the other and while nothing else ran, the last at "
        f"{error.last_worker.address} ({words(case)})"
    )


def gone(client: Any, keys: Mapping[str, list[int]]) -> Iterator[str]:
    """A sentence for each worker that went away with cases of a sweep, from the scheduler's own record."""
    for _, event in client.get_events("all"):
        if event.get("action") != "remove-worker" or event.get("expected"):
            continue
        had = [number for key in event.get("processing-tasks", ()) for number in keys.get(key, ())]
        if had:
            yield f"the worker at {event['worker']} died while it had the cases {ranges(had)}, which ran elsewhere"
