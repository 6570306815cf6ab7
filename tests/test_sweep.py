"""Sweeps: the same results in the same order wherever they run, a bar, and errors that say in which case they rose."""

import os
import threading
import time
from types import MappingProxyType

import joblib
import numpy as np
import pytest
from joblib.parallel import ThreadingBackend

from uavlab.sweep import sweep


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
        sweep(fail, cases, jobs=jobs, **quiet)
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
