"""Workers that die in the middle of a sweep: what they had runs again, and a case that kills them is named."""

import logging
import os
import re
import signal
import subprocess
import sys
import threading
import time
import warnings
from collections import Counter
from contextlib import contextmanager
from pathlib import Path

import joblib
import numpy as np
import pytest

from uavlab.sweep import Failure, WorkerLostError, sweep

pytestmark = pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="processes can't be killed here")
CASES = 120


def noted(x, folder, fatal=(), always=False, pause=0.01):
    """A case that leaves a trace of each call; some kill their process, the first time or always."""
    time.sleep(pause)
    traces = Path(folder)
    before = len(list(traces.glob(f"{x}.*")))
    (traces / f"{x}.{before}").write_text(str(os.getpid()))
    if x in fatal and (always or before == 0):
        os.kill(os.getpid(), signal.SIGKILL)
    return x * 0.1


def cases(folder, **more):
    return [{"x": x, "folder": str(folder), **more} for x in range(CASES)]


def calls(folder):
    return Counter(int(path.name.split(".")[0]) for path in folder.iterdir())


@contextmanager
def loky():
    with joblib.parallel_config("loky", n_jobs=2):
        yield


@contextmanager
def dask(workers=2, allowed=3):
    """Worker processes on this machine; a case may kill so many of them, and one more, before Dask gives it up."""
    distributed = pytest.importorskip("distributed", reason="the extra cluster isn't installed")
    import dask

    more = {"threads_per_worker": 1, "dashboard_address": None, "silence_logs": logging.CRITICAL}
    with (
        dask.config.set({"distributed.scheduler.allowed-failures": allowed}),
        distributed.LocalCluster(n_workers=workers, **more) as cluster,
        distributed.Client(cluster),
        joblib.parallel_config("dask"),
    ):
        yield


@contextmanager
def ray():
    module = pytest.importorskip("ray", reason="ray isn't installed")
    from ray.util.joblib import register_ray

    path = {"env_vars": {"PYTHONPATH": os.pathsep.join([str(Path(__file__).parent), *sys.path])}}
    module.init(runtime_env=path, num_cpus=2, include_dashboard=False, log_to_driver=False, configure_logging=False)
    register_ray()
    try:
        with joblib.parallel_config("ray", n_jobs=2):
            yield
    finally:
        module.shutdown()


PLACES = {"loky": loky, "dask": dask}


@pytest.mark.parametrize("place", PLACES)
def test_a_killed_worker_costs_nothing_but_time_and_is_named(tmp_path, place):
    """One of two is killed in the middle: the file is that of a serial run to the byte, and few cases run twice."""
    traces = tmp_path / "traces"
    traces.mkdir()
    cases_there = cases(traces, fatal=(60,))
    with PLACES[place](), pytest.warns(RuntimeWarning) as warned:
        results = sweep(noted, cases_there, to=tmp_path / "rows", progress=False)
    assert results == [x * 0.1 for x in range(CASES)]
    (said,) = [str(one.message) for one in warned]
    assert "died" in said
    named = {
        number
        for first, last in re.findall(r"\b(\d+)(?:–(\d+))?\b", said.split("case", 1)[1])
        for number in range(int(first), int(last or first) + 1)
    }
    assert 60 in named
    again = {x for x, count in calls(traces).items() if count > 1}
    assert 60 in again
    assert len(again) <= 0.2 * CASES, "batches that were under way"
    assert set(calls(traces)) == set(range(CASES))
    sweep(noted, cases_there, to=tmp_path / "alone", progress=False)  # its traces are there: it doesn't kill again
    assert (tmp_path / "rows").read_bytes() == (tmp_path / "alone").read_bytes()


def test_cases_that_always_kill_their_worker_are_failures_and_no_others(tmp_path):
    traces = tmp_path / "traces"
    traces.mkdir()
    failed = r"2 of 120 cases failed \(40, 90\); the first, case 40"
    with loky(), pytest.warns(RuntimeWarning, match=failed) as warned:
        results = sweep(noted, cases(traces, fatal=(40, 90), always=True), to=tmp_path / "rows", progress=False)
    assert len(warned) == 1
    assert [x for x, result in enumerate(results) if isinstance(result, Failure)] == [40, 90]
    assert all(results[x] == x * 0.1 for x in range(CASES) if x not in (40, 90))
    assert isinstance(results[40].exception, WorkerLostError)
    rows = (tmp_path / "rows").read_text().splitlines()
    assert [row.split(",")[0] for row in rows[1:]] == [f'{{"case":{x}' for x in range(CASES)]
    assert rows[41].startswith('{"case":40,"failed":"WorkerLostError')
    assert calls(traces)[40] >= 2, "it had more than one chance"


def test_a_case_that_kills_all_workers_of_a_cluster_is_a_failure(tmp_path):
    """With joblib's own way to Dask this waited for ever."""
    with dask(allowed=0), pytest.warns(RuntimeWarning, match=r"1 of 120 cases failed \(40\)"):
        results = sweep(noted, cases(tmp_path, fatal=(40,), always=True), progress=False)
    assert [x for x, result in enumerate(results) if isinstance(result, Failure)] == [40]
    assert isinstance(results[40].exception, WorkerLostError)
    assert calls(tmp_path)[40] >= 2, "it had a chance alone"


def test_with_raise_a_case_that_kills_its_worker_is_an_error(tmp_path):
    with loky(), warnings.catch_warnings(action="ignore"), pytest.raises(WorkerLostError, match="case 5") as raised:
        sweep(noted, cases(tmp_path, fatal=(5,), always=True), on_error="raise", progress=False)
    assert "in the case x=5, " in raised.value.__notes__[0]


def test_a_sweep_that_is_killed_whole_goes_on_where_it_was(tmp_path):
    """The caller's process dies, with its workers: what is in the file doesn't run again."""
    traces = tmp_path / "traces"
    traces.mkdir()
    program = f"""
import sys
sys.path.insert(0, {str(Path(__file__).parent)!r})
from test_sweep_workers import cases, noted
from uavlab.sweep import sweep
sweep(noted, cases({str(traces)!r}), jobs=2, to={str(tmp_path / "rows")!r}, progress=False)
"""
    began = subprocess.Popen([sys.executable, "-c", program], start_new_session=True)
    try:
        wait_for(lambda: (tmp_path / "rows").exists() and (tmp_path / "rows").read_bytes().count(b"\n") > 40)
    finally:
        os.killpg(began.pid, signal.SIGKILL)
        began.wait()
    content = (tmp_path / "rows").read_bytes()
    kept = content[: content.rindex(b"\n") + 1].count(b"\n") - 1
    assert 40 <= kept < CASES
    before = sum(calls(traces).values())
    results = sweep(noted, cases(traces), to=tmp_path / "rows", progress=False)
    assert results == [x * 0.1 for x in range(CASES)]
    assert sum(calls(traces).values()) - before == CASES - kept
    sweep(noted, cases(traces), to=tmp_path / "alone", progress=False)
    assert (tmp_path / "rows").read_bytes() == (tmp_path / "alone").read_bytes()


def wait_for(happened, most=60.0):
    end = time.monotonic() + most
    while not happened():
        assert time.monotonic() < end
        time.sleep(0.01)


def described(x):
    if x == 7:
        raise ValueError("seven")
    draws = np.random.default_rng(x).standard_normal(5)
    return {"draws": draws, "mean": draws.mean(), "pair": (x, float("nan"))}


@pytest.mark.parametrize("place", [dask, ray])
def test_a_cluster_gives_the_bytes_of_one_core(tmp_path, place):
    several = [{"x": x} for x in range(40)]
    with warnings.catch_warnings(action="ignore"):
        sweep(described, several, to=tmp_path / "alone", progress=False)
    lock = threading.Lock()
    with place():
        with pytest.warns(RuntimeWarning, match="1 of 40 cases failed") as warned:
            results = sweep(described, several, to=tmp_path / "rows", progress=False)
        assert sweep(lambda x: x + 1, several, progress=False) == list(range(1, 41))
        with pytest.raises(ValueError, match="function can't be sent to other processes"):
            sweep(lambda x: lock, several, progress=False)
        with pytest.raises(ValueError, match=r"case 0 \(x=.*can't be sent to other processes"):
            sweep(str, [{"x": lock}], progress=False)
    assert len([one for one in warned if one.category is RuntimeWarning]) == 1
    assert (tmp_path / "rows").read_bytes() == (tmp_path / "alone").read_bytes()
    assert isinstance(results[7].exception, ValueError)


def test_a_cluster_of_one_core_does_not_run_cases_here(tmp_path):
    """joblib would, as it does for one process: what kills its worker would kill the caller."""
    with dask(workers=1):
        assert os.getpid() not in sweep(lambda x: os.getpid(), [{"x": x} for x in range(5)], progress=False)


def leaving(x, kind):
    if x == 3:
        raise kind
    return x


@pytest.mark.parametrize("place", [dask, ray])
def test_what_is_no_error_but_leaves_a_function_does_not_stop_a_cluster(place):
    """Dask and Ray waited for ever for a case that ended so; of Ctrl-C in one, Dask's workers died."""
    with place():
        with pytest.warns(RuntimeWarning, match=r"^1 of 6 cases failed \(3\)"):
            results = sweep(leaving, [{"x": x, "kind": GeneratorExit} for x in range(6)], progress=False)
        assert isinstance(results[3].exception, GeneratorExit)
        with pytest.raises(KeyboardInterrupt):
            sweep(leaving, [{"x": x, "kind": KeyboardInterrupt} for x in range(6)], progress=False)
        assert sweep(leaving, [{"x": x, "kind": None} for x in range(3)], progress=False) == [0, 1, 2]
