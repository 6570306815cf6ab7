"""Sweeps: the same results in the same order wherever they run, a bar, and cases that fail beside those that don't."""

import os
import pickle
import sys
import threading
import time
import warnings
from types import MappingProxyType

import joblib
import numpy as np
import pytest
from joblib.parallel import ThreadingBackend

from uavlab.sweep import Failure, UnpicklableError, sweep


def squares():
    """A function that takes longer for the first cases, within the test so that it travels to other processes."""

    def square(x):
        time.sleep(0.2 if x == 0 else 0.0)
        return x * x, os.getpid()

    return square


@pytest.fixture
def quiet():
    return {"progress": False}


CASES = [{"x": x} for x in range(12)]


def test_results_stand_in_the_order_of_the_cases_in_this_process(quiet):
    values, processes = zip(*sweep(squares(), CASES, **quiet), strict=True)
    assert values == tuple(x * x for x in range(12))
    assert set(processes) == {os.getpid()}


@pytest.mark.parametrize("jobs", [2, -1, np.int64(2)])
def test_on_several_processes_the_results_are_the_same(quiet, jobs):
    values, processes = zip(*sweep(squares(), CASES, jobs=jobs, **quiet), strict=True)
    assert values == tuple(x * x for x in range(12))
    if jobs == 2:
        assert os.getpid() not in processes


def test_random_cases_do_not_depend_on_where_they_run(quiet):
    def draw(rng):
        return np.random.default_rng(rng).standard_normal(3).tolist()

    cases = [{"rng": seed} for seed in range(5)]
    alone = sweep(draw, cases, **quiet)
    assert alone == sweep(draw, cases, jobs=2, **quiet) == [draw(seed) for seed in range(5)]


def test_the_caller_says_where_it_runs(quiet):
    """Two threads that wait for each other: on one they would wait in vain."""
    meeting = threading.Barrier(2, timeout=60)

    def meet(x):
        meeting.wait()
        return x, os.getpid(), threading.get_ident()

    with joblib.parallel_config("threading", n_jobs=2):
        met = sweep(meet, [{"x": x} for x in range(6)], **quiet)
    assert [x for x, _, _ in met] == list(range(6))
    assert {process for _, process, _ in met} == {os.getpid()}
    assert len({thread for _, _, thread in met}) > 1


def test_a_backend_that_gives_all_results_at_the_end_will_do(capsys):
    class AtTheEnd(ThreadingBackend):
        supports_return_generator = False

    with joblib.parallel_config(AtTheEnd(), n_jobs=2):
        assert sweep(pow, [{"base": x, "exp": 2} for x in range(6)]) == [0, 1, 4, 9, 16, 25]
    assert "6/6" in capsys.readouterr().err


def test_jobs_go_before_what_the_caller_said(quiet):
    with joblib.parallel_config("threading", n_jobs=2):
        threads = sweep(threading.get_ident, [{}] * 6, jobs=1, **quiet)
    assert set(threads) == {threading.get_ident()}


@pytest.mark.parametrize("jobs", [None, 2])
def test_a_bar_on_stderr_counts_the_cases(capsys, jobs):
    sweep(pow, [{"base": 2, "exp": x} for x in range(7)], jobs=jobs, unit="power")
    shown = capsys.readouterr()
    assert "7/7" in shown.err
    assert "power" in shown.err
    assert shown.out == ""


def test_the_bar_can_be_turned_off(capsys, quiet):
    sweep(pow, [{"base": 2, "exp": 3}], **quiet)
    shown = capsys.readouterr()
    assert shown.err == shown.out == ""


def test_cases_may_be_any_mappings_from_any_iterable(quiet):
    cases = (MappingProxyType({"base": 2, "exp": x}) for x in range(4))
    assert sweep(pow, cases, **quiet) == [1, 2, 4, 8]
    assert sweep(pow, [], **quiet) == []


@pytest.mark.parametrize("jobs", [None, 2])
def test_an_error_is_the_functions_own_with_a_note_of_the_case(quiet, jobs):
    def fail(x, name):
        if x == 3:
            raise KeyError("nothing there")
        return x

    cases = [{"x": x, "name": "n" * 500} for x in range(6)]
    with pytest.raises(KeyError, match="nothing there") as failed:
        sweep(fail, cases, jobs=jobs, on_error="raise", **quiet)
    assert failed.value.__notes__ == ["in the case x=3, name='" + "n" * 79]


@pytest.mark.parametrize("jobs", [0, 1.5, "2"])
def test_a_number_of_jobs_that_makes_no_sense_is_refused(quiet, jobs):
    with pytest.raises(ValueError, match=f"jobs must be a number of processes, or −1 for one per core, got {jobs!r}"):
        sweep(pow, [{"base": 2, "exp": 3}], jobs=jobs, **quiet)


def test_a_generator_that_cases_share_is_refused():
    """Before, one process drew other numbers for each case, and two the same for all."""
    rng = np.random.default_rng(0)
    with pytest.raises(ValueError, match=r"cases 0 and 2 share rng, a random generator, .* rng\.spawn\(3\)"):
        sweep(float, [{"rng": rng}, {"rng": 1}, {"rng": rng}], progress=False)
    draws = sweep(lambda rng: rng.random(), [{"rng": one} for one in rng.spawn(3)], progress=False)
    assert len(set(draws)) == 3


class TalkativeError(Exception):
    """One that can't be made again from what it holds."""

    def __init__(self, one, two):
        super().__init__(f"{one} and {two}")


def fragile(x):
    if x == 3:
        raise KeyError("nothing there")
    if x == 7:
        sys.exit("enough")
    if x == 8:
        raise TalkativeError("this", "that")
    return x * 0.1


WAYS = {
    "here": {},
    "loky": {"backend": "loky", "n_jobs": 2},
    "threads": {"backend": "threading", "n_jobs": 2},
    "multiprocessing": {"backend": "multiprocessing", "n_jobs": 2},
}


@pytest.mark.parametrize("way", WAYS)
def test_a_case_that_fails_is_recorded_and_the_others_go_on(quiet, way):
    with joblib.parallel_config(**WAYS[way]), pytest.warns(RuntimeWarning) as warned:
        results = sweep(fragile, CASES, **quiet)
    failures = {x: result for x, result in enumerate(results) if isinstance(result, Failure)}
    assert list(failures) == [3, 7, 8]
    assert all(results[x] == x * 0.1 for x in range(12) if x not in failures)
    assert type(failures[3].exception) is KeyError
    assert failures[3].case == {"x": 3}
    assert failures[3].number == 3
    assert 'raise KeyError("nothing there")' in failures[3].traceback
    assert "travel.py" not in failures[3].traceback
    assert repr(failures[3]) == "<Failure of case 3: KeyError: 'nothing there'>"
    assert failures[3].exception.__traceback__ is None, "frames would keep arrays alive"
    assert "this and that" in str(failures[8].exception)
    (warning,) = [one for one in warned if one.category is RuntimeWarning]  # Python's own of forks aren't meant
    said = str(warning.message)
    assert said.startswith("3 of 12 cases failed (3, 7–8); the first, case 3 (x=3), with KeyError: 'nothing there' at ")
    assert "test_sweep.py:" in said
    assert warning.filename == __file__


def test_causes_keep_no_frames_either(quiet):
    def chained(x):
        try:
            fragile(3)
        except KeyError as error:
            raise ValueError("again") from error

    with pytest.warns(RuntimeWarning, match="case 0"):
        (failure,) = sweep(chained, [{"x": 0}], **quiet)
    assert failure.exception.__cause__.__traceback__ is None


@pytest.mark.parametrize("way", WAYS)
def test_raising_stops_at_the_first_without_further_words(quiet, way):
    with joblib.parallel_config(**WAYS[way]), warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(KeyError, match="nothing there") as raised:
            sweep(fragile, CASES[:6], on_error="raise", **quiet)
    assert raised.value.__notes__ == ["in the case x=3"]
    if way not in ("here", "threads"):
        assert 'raise KeyError("nothing there")' in str(raised.value.__cause__)


def test_raising_leaves_what_comes_after_alone(quiet):
    seen = []

    def note(x):
        seen.append(x)
        return 1 / (x - 2)

    with pytest.raises(ZeroDivisionError):
        sweep(note, CASES, on_error="raise", **quiet)
    assert seen == [0, 1, 2]


def test_an_unknown_way_with_errors_is_refused():
    with pytest.raises(ValueError, match="on_error must be one of 'record', 'raise', got 'ignore'"):
        sweep(pow, [], on_error="ignore")


@pytest.mark.parametrize("way", ["loky", "multiprocessing"])
def test_a_function_that_cannot_travel_is_refused_with_the_way_out(quiet, way):
    """Lambdas and local functions can; what holds a lock or an open file can't."""
    lock = threading.Lock()

    def locked(x):
        with lock:
            return x

    with joblib.parallel_config(**WAYS[way]):
        assert sweep(lambda x: x + 1, CASES, **quiet) == list(range(1, 13))
        with pytest.raises(ValueError, match=r"function can't be sent to other processes.*lock.*with jobs=1"):
            sweep(locked, CASES, **quiet)
    assert sweep(locked, CASES, jobs=1, **quiet) == list(range(12))


@pytest.mark.parametrize("way", ["loky", "multiprocessing"])
def test_a_case_that_cannot_travel_is_named(quiet, way):
    cases = [{"x": x, "lock": None if x < 9 else threading.Lock()} for x in range(12)]
    with joblib.parallel_config(**WAYS[way]):
        with pytest.raises(UnpicklableError, match=r"case 9 \(x=9, lock=.*can't be sent to other processes") as refused:
            sweep(lambda x, lock: x, cases, **quiet)
        assert isinstance(refused.value, pickle.PicklingError)
    assert sweep(lambda x, lock: x, cases, jobs=1, **quiet) == list(range(12))


@pytest.mark.parametrize("way", ["loky", "multiprocessing"])
def test_a_result_that_cannot_travel_costs_that_case(quiet, way):
    def locked(x):
        return threading.Lock() if x == 5 else x

    with joblib.parallel_config(**WAYS[way]), pytest.warns(RuntimeWarning, match="1 of 12 cases failed"):
        results = sweep(locked, CASES, **quiet)
    assert "can't be sent back" in str(results[5].exception)
    assert results[:5] + results[6:] == [0, 1, 2, 3, 4, 6, 7, 8, 9, 10, 11]


def test_a_failure_that_a_function_returns_is_a_result(quiet):
    inner = Failure({}, ValueError("inside"), 0, "")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert sweep(lambda x: inner, CASES[:1], **quiet) == [inner]
