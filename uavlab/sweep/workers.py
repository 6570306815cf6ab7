"""Where cases run: rounds of joblib, until each case has an answer, whatever becomes of the workers.

A pool breaks when one of its processes dies, and takes all cases with it that were under way. So a sweep is made of
rounds: what a broken one left is run again. A board in shared memory says which process has which case; a case that
was under way in two broken rounds is run alone, and if its process dies then, too, it is the case that kills it.
"""

from __future__ import annotations

import mmap
import os
import re
import tempfile
import time
import warnings
from collections import Counter
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from concurrent.futures import BrokenExecutor
from contextlib import closing, contextmanager
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

import joblib
from joblib.parallel import LokyBackend, MultiprocessingBackend, SequentialBackend, ThreadingBackend

from uavlab.sweep.cluster import on_dask
from uavlab.sweep.failure import Failed, UnpicklableError, WorkerLostError
from uavlab.sweep.travel import opened, packed, refuse_unpicklable, tried, unpacked

Case = Mapping[str, Any]

DEATHS = {"ActorDiedError", "RayActorError", "WorkerCrashedError"}
"""What Ray raises when a worker is gone; by their names, as it needn't be installed."""

CHANCES = 2
"""Broken rounds after which a case that was under way is run alone."""

BARREN = 3
"""Broken rounds, one after the other, that brought nothing and blame no case; then it is something else."""

BLOCK = 5.0
"""How long [s] cases run, about, before a pool that gives its results at the end is asked for them."""


def finished(
    function: Callable[..., Any], cases: Sequence[Case], numbers: Sequence[int], jobs: int | None, losses: list[str]
) -> Generator[tuple[int, Any]]:
    """The number of each case and what became of it, as they end; `losses` gets a sentence for each dead worker."""
    backend, _ = joblib.parallel.get_active_backend()
    way = way_of_travel(backend, jobs)
    if way == "dask":
        yield from on_dask(backend, function, cases, numbers, losses)
    elif way == "none":
        for number in numbers:
            yield number, tried(function, dict(cases[number]), travels=False)
    elif way == "shared":
        yield from one_round(function, cases, numbers, jobs, None, way)
    else:
        refuse_unpicklable(function, "function")
        yield from in_rounds(function, cases, Work(dict.fromkeys(numbers), losses), jobs, way)


def way_of_travel(backend: Any, jobs: int | None) -> str:
    """How cases come to where they run: "none" at all, "shared" with threads, "plain" by loky, "packed", or "dask"."""
    if type(backend).__name__ == "DaskDistributedBackend":
        return "dask"
    asked = joblib.parallel.get_active_backend()[1] if jobs is None else jobs
    known = isinstance(backend, LokyBackend | MultiprocessingBackend | SequentialBackend | ThreadingBackend)
    if known and (asked in (None, 1) or backend.effective_n_jobs(asked) == 1):
        return "none"
    if getattr(backend, "supports_sharedmem", False):
        return "shared"
    return "plain" if isinstance(backend, LokyBackend) else "packed"


def in_rounds(
    function: Callable[..., Any], cases: Sequence[Case], work: Work, jobs: int | None, way: str
) -> Generator[tuple[int, Any]]:
    """Rounds until nothing is left."""
    while turn := work.turn():
        with marks_for(len(cases)) as marks:
            try:
                with closing(one_round(function, cases, turn, jobs, marks.path, way)) as outcomes:
                    for number, value in outcomes:
                        work.done(number)
                        yield number, value
            except UnpicklableError:
                raise
            except Exception as error:
                broken = BrokenRound(error, turn, [number for number in turn if work.has(number)], marks)
                if broken.by_death:
                    yield from work.lost(broken)
                elif way == "packed":
                    raise
                else:
                    way = "packed"  # something can't travel: what, is found when each case is packed by itself


class BrokenRound:
    """Why a round ended early: whether a worker died, and the cases that it had."""

    def __init__(self, error: Exception, turn: list[int], left: list[int], marks: Marks) -> None:
        self.why, self.alone, self.brought = error, len(turn) == 1, len(turn) - len(left)
        nameless: dict[int, int | None] = dict.fromkeys(left) if self.alone else {}
        self.under_way = marks.under_way(turn, left) or nameless
        dead = isinstance(error, BrokenExecutor) or any(kind.__name__ in DEATHS for kind in type(error).__mro__)
        self.by_death = dead and "un-serialize" not in str(error)

    def told(self, under_way: Mapping[int, int | None]) -> str:
        """A sentence on dead workers and their cases."""
        had = ", ".join(
            f"process {process} had case {number}" if process else f"it had case {number}"
            for number, process in sorted(under_way.items())
        )
        codes = re.findall(r"exit codes of the workers are {(.+)}", str(self.why))
        return f"a worker process died ({', '.join(codes) or type(self.why).__name__}): {had}"


@dataclass
class Work:
    """What is still to be done: cases that wait, and those that run alone as two broken rounds had them."""

    waiting: dict[int, None]
    losses: list[str]
    alone: list[int] = field(default_factory=list)
    rounds: Counter[int] = field(default_factory=Counter)
    barren: int = 0

    def turn(self) -> list[int]:
        """The cases of the next round."""
        return list(self.waiting) or self.alone[-1:]

    def has(self, number: int) -> bool:
        return number in self.waiting or number in self.alone

    def done(self, number: int) -> None:
        if number in self.waiting:
            del self.waiting[number]
        else:
            self.alone.remove(number)

    def lost(self, broken: BrokenRound) -> Iterator[tuple[int, Failed]]:
        """Put the cases of a broken round where they belong; a failure for one that kills its process."""
        if broken.under_way:
            self.losses.append(broken.told(broken.under_way))
        self.barren = 0 if broken.under_way or broken.brought else self.barren + 1
        if self.barren == BARREN:
            raise broken.why
        for number, process in broken.under_way.items():
            self.rounds[number] += 1
            if number not in self.waiting:
                self.done(number)
                yield number, Failed(WorkerLostError(broken.told({number: process})), "", "")
            elif self.rounds[number] == CHANCES:
                del self.waiting[number]
                self.alone.append(number)


def one_round(
    function: Callable[..., Any],
    cases: Sequence[Case],
    numbers: Sequence[int],
    jobs: int | None,
    marks: str | None,
    way: str,
) -> Generator[tuple[int, Any]]:
    """Cases given to joblib, once: number and result, as they end."""
    backend, _ = joblib.parallel.get_active_backend()
    task: Callable[..., Any] = joblib.delayed(marked_unpacked if way == "packed" else marked)
    tasks: Iterator[Any] = (task(function, dict(cases[number]), number, marks) for number in numbers)
    if way == "packed":
        tasks = (task(packed_or_not(function, cases[number]), number, marks) for number in numbers)
    if isinstance(backend, LokyBackend):  # it starts them all at once; and one alone would be this process
        jobs = min(joblib.effective_n_jobs(jobs), max(len(numbers), 2))
    if backend.supports_return_generator:
        # a case may change its own arrays, in memory of its own if they come as files
        results = joblib.Parallel(n_jobs=jobs, return_as="generator_unordered", mmap_mode="c")(tasks)
    else:
        results = in_blocks(tasks, jobs)
    try:
        for number, value in results:  # `yield from` would close them before their warnings are ignored
            if way == "packed" and value is None:
                packed(function, cases[number], number)  # raises
            yield number, opened(value) if way == "packed" else value
    finally:
        with warnings.catch_warnings(action="ignore"):  # joblib warns of results that nobody takes
            results.close()


def in_blocks(tasks: Iterator[Any], jobs: int | None) -> Generator[Any]:
    """Results of a pool that gives them at the end (Ray's, multiprocessing's): so in blocks of some seconds."""
    size = joblib.effective_n_jobs(jobs)
    with joblib.Parallel(n_jobs=jobs) as parallel:
        while block := [task for _, task in zip(range(size), tasks, strict=False)]:
            began = time.perf_counter()
            yield from parallel(block)
            size = size * 2 if time.perf_counter() - began < BLOCK else max(size // 2, joblib.effective_n_jobs(jobs))


def marked(function: Callable[..., Any], case: dict[str, Any], number: int, marks: str | None) -> tuple[int, Any]:
    """The number of a case and what became of it; a mark says that this process has it."""
    if marks is not None:
        processes, process = marks_at(marks)
        processes[number] = process
    return number, tried(function, case, travels=marks is not None)


def marked_unpacked(call: bytes | None, number: int, marks: str) -> tuple[int, bytes | None]:
    """The same for a call in bytes, with a result in bytes."""
    processes, process = marks_at(marks)
    processes[number] = process
    return number, None if call is None else unpacked(call)


def packed_or_not(function: Callable[..., Any], case: Case) -> bytes | None:
    """A call as bytes, or None: joblib asks for tasks in a thread in which an exception would be lost."""
    try:
        return packed(function, case, 0)
    except Exception:
        return None


class Marks(NamedTuple):
    """Which process began which case last: one number for each, 0 before."""

    path: str
    processes: Any

    def under_way(self, numbers: Sequence[int], left: Sequence[int]) -> dict[int, int | None]:
        """Of some cases, in the order in which they were given out, the last that each process began, if it is left."""
        last = {self.processes[number]: number for number in numbers}
        return {number: process for process, number in last.items() if process and number in set(left)}


@contextmanager
def marks_for(count: int) -> Iterator[Marks]:
    """Shared memory for marks: a file, which processes of this machine find by its name, and others don't."""
    with tempfile.TemporaryDirectory(prefix="uavlab-sweep-", ignore_cleanup_errors=True) as folder:
        path = Path(folder) / "marks"
        path.write_bytes(bytes(4 * count))
        yield Marks(str(path), marks_at.__wrapped__(str(path))[0])


@lru_cache(maxsize=4)
def marks_at(path: str) -> tuple[Any, int]:
    """The marks of a sweep, opened once in each process, and its number; elsewhere something that forgets them."""
    try:
        with open(path, "r+b") as file:
            return memoryview(mmap.mmap(file.fileno(), 0)).cast("i"), os.getpid()
    except OSError:
        return {}, 0
