"""The parts of a sweep over many processes, one by one: rounds, blocks, batches, and the words on what went wrong."""

import warnings
from concurrent.futures import BrokenExecutor
from types import SimpleNamespace

import joblib
import pytest
from joblib.parallel import ThreadingBackend

from uavlab.sweep import WorkerLostError
from uavlab.sweep.cluster import gone, next_size
from uavlab.sweep.failure import without_frames
from uavlab.sweep.sweep import warn_of
from uavlab.sweep.workers import BARREN, BrokenRound, Work, in_blocks, one_round


def broken(turn, left, under_way, error=None):
    marks = SimpleNamespace(under_way=lambda numbers, left: dict(under_way))
    return BrokenRound(error or BrokenExecutor("gone"), turn, left, marks)


def test_a_case_runs_alone_after_two_broken_rounds_and_fails_after_a_third():
    work = Work(dict.fromkeys(range(4)), [])
    work.done(0)
    assert list(work.lost(broken([0, 1, 2, 3], [1, 2, 3], {2: 77}))) == []
    assert work.turn() == [1, 2, 3], "it may have been another one's fault"
    work.done(1)
    assert list(work.lost(broken([1, 2, 3], [2, 3], {2: 78}))) == []
    assert work.turn() == [3], "and then those first that blame nobody"
    work.done(3)
    assert work.turn() == [2]
    ((number, failed),) = work.lost(broken([2], [2], {}))
    assert number == 2
    assert isinstance(failed.exception, WorkerLostError)
    assert work.turn() == []
    assert [("77" in said, "78" in said) for said in work.losses] == [(True, False), (False, True), (False, False)]


def test_rounds_that_bring_nothing_and_blame_nobody_end_with_their_error():
    work = Work(dict.fromkeys(range(4)), [])
    for _ in range(BARREN - 1):
        assert list(work.lost(broken([0, 1, 2, 3], [0, 1, 2, 3], {}))) == []
    work.done(0)
    assert list(work.lost(broken([0, 1, 2, 3], [1, 2, 3], {}))) == [], "one that brings something begins anew"
    for _ in range(BARREN - 1):
        assert list(work.lost(broken([1, 2, 3], [1, 2, 3], {}))) == []
    with pytest.raises(BrokenExecutor, match="gone"):
        list(work.lost(broken([1, 2, 3], [1, 2, 3], {})))
    assert work.losses == []


def test_what_cannot_be_read_is_no_death():
    words = BrokenExecutor("A task has failed to un-serialize. Please ensure that the arguments are picklable.")
    assert not broken([0, 1], [0, 1], {}, words).by_death
    assert not broken([0, 1], [0, 1], {}, ValueError("no")).by_death
    assert broken([0, 1], [0, 1], {}).by_death
    assert broken([0, 1], [0, 1], {}, type("ActorDiedError", (Exception,), {})("gone")).by_death


class AtTheEnd(ThreadingBackend):
    supports_return_generator = False


@pytest.mark.parametrize(("most", "sizes"), [(1e9, [2, 4, 8, 6]), (0.0, [2] * 10)])
def test_blocks_grow_while_they_are_quick(monkeypatch, most, sizes):
    had = []
    known = joblib.Parallel.__call__
    monkeypatch.setattr(joblib.Parallel, "__call__", lambda self, tasks: had.append(len(tasks)) or known(self, tasks))
    monkeypatch.setattr("uavlab.sweep.workers.BLOCK", most)
    with joblib.parallel_config(AtTheEnd(), n_jobs=2):
        assert list(in_blocks((joblib.delayed(abs)(-x) for x in range(20)), 2)) == list(range(20))
    assert had == sizes


@pytest.mark.parametrize(
    ("size", "had", "took", "then"),
    [(4, 4, 0.1, 8), (16, 4, 0.1, 16), (4, 4, 0.5, 4), (8, 8, 2.0, 4), (8, 1, 60.0, 1)],
)
def test_batches_take_about_half_a_second(size, had, took, then):
    assert next_size(size, had, took) == then


def test_workers_that_were_told_to_go_or_had_nothing_of_a_sweep_are_not_mentioned():
    events = [
        {"action": "remove-worker", "worker": "a", "expected": True, "processing-tasks": {"k": 1}},
        {"action": "remove-worker", "worker": "b", "expected": False, "processing-tasks": {"other": 1}},
        {"action": "add-worker", "worker": "c", "processing-tasks": {"k": 1}},
        {"action": "remove-worker", "worker": "d", "expected": False, "processing-tasks": {"k": 1, "other": 1}},
    ]
    client = SimpleNamespace(get_events=lambda topic: [(0.0, event) for event in events])
    assert list(gone(client, {"k": [3, 4, 7]})) == [
        "the worker at d died while it had the cases 3–4, 7, which ran elsewhere"
    ]


def test_of_many_deaths_the_first_five_are_told():
    with pytest.warns(RuntimeWarning) as warned:
        warn_of([], {}, [f"death {x}" for x in range(7)], ["rows.jsonl was replaced"])
    (said,) = [str(one.message) for one in warned]
    assert said == ("rows.jsonl was replaced; death 0; death 1; death 2; death 3; death 4; and 2 times more")
    with warnings.catch_warnings(action="error"):
        warn_of([1], {}, [], [])


def test_what_an_exception_rose_in_keeps_no_frames():
    try:
        try:
            raise KeyError("inner")
        except KeyError:
            raise ValueError("outer")  # noqa: B904  # its context alone
    except ValueError as error:
        outer = without_frames(error)
    assert outer.__context__ is not None
    assert outer.__context__.__traceback__ is None


def talkative():
    """Results that complain, as joblib's do, when nobody takes them."""
    try:
        yield 0, "zero"
        yield 1, "one"
    except GeneratorExit:
        warnings.warn("1 task has been successfully executed but not used", stacklevel=1)
        raise


@pytest.mark.parametrize("way", ["plain", "packed"])
def test_results_that_nobody_takes_are_let_go_without_a_word(monkeypatch, way):
    """A warning that is an error would come in the place of the function's own."""
    monkeypatch.setattr(joblib, "Parallel", lambda **more: lambda tasks: talkative())
    monkeypatch.setattr("uavlab.sweep.workers.opened", lambda content: content)
    outcomes = one_round(abs, [{}, {}], [0, 1], 2, "marks", way)
    with warnings.catch_warnings(action="error"):
        assert next(outcomes) == (0, "zero")
        outcomes.close()
