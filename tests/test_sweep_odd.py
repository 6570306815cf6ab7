"""Odd but rightful sweeps, and wrong ones that must not pass without a word."""

import copy
import functools
import json
import math
import os
import random
import subprocess
import sys
import threading
import types
import warnings
from collections import defaultdict
from dataclasses import InitVar, dataclass
from typing import NamedTuple

import joblib
import numpy as np
import pytest

import uavlab.sweep.rows as module
from uavlab.compiled import compiled
from uavlab.sweep import Failure, sweep
from uavlab.sweep.values import as_text, fingerprint, read, text_mark

CASES = [{"x": x} for x in range(6)]


def run(function, cases=CASES, **more):
    return sweep(function, cases, progress=False, **more)


def mark(value):
    return fingerprint(value, {})


def plain(x):
    return x * 1.5


@pytest.fixture
def rows(tmp_path):
    return tmp_path / "rows.jsonl"


# whose results a file holds


@dataclass
class Model:
    a: int
    b: InitVar[int]

    def __post_init__(self, b):
        self.hidden = b


class Marked(list):
    pass


def marked(text):
    one = Marked([1])
    one.text = text
    return one


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (Model(1, 2), Model(1, 3)),
        (marked("a"), marked("b")),
        (defaultdict(int, a=1), defaultdict(float, a=1)),
        (10**5000, 10**5000 + 1),
    ],
    ids=["hidden state", "list with more", "factory", "long"],
)
def test_what_a_case_holds_beside_its_fields_and_items_counts(one, other):
    assert mark(one) != mark(other)
    assert mark(one) == mark(copy.deepcopy(one))


def test_frozen_sets_have_one_fingerprint_in_all_processes():
    program = "from uavlab.sweep.values import fingerprint; print(fingerprint(frozenset('xyz'), {}))"
    for seed in ("1", "2", "3"):
        env = {**os.environ, "PYTHONHASHSEED": seed}
        done = subprocess.run([sys.executable, "-c", program], env=env, capture_output=True, text=True, check=True)
        assert done.stdout.strip() == mark(frozenset("zyx"))
    assert mark(frozenset("xyz")) != mark(set("xyz"))


def steps(k):
    def down(x):
        return k if x == 0 else down(x - 1)

    return down


def test_a_local_function_that_calls_itself_has_a_fingerprint(rows):
    assert run(steps(3), to=rows) == [3] * 6
    assert mark(steps(3)) == mark(steps(3)) != mark(steps(4))


SCRIPT = """
from uavlab.sweep import sweep

def run(x):
    return x * {factor}

print(sweep(run, [{{"x": 1}}, {{"x": 2}}], to="rows.jsonl", progress=False))
"""


def script(folder, name, factor):
    (folder / name).write_text(SCRIPT.format(factor=factor))
    return subprocess.run([sys.executable, name], cwd=folder, capture_output=True, text=True)


def test_two_scripts_with_functions_of_one_name_do_not_share_a_file(tmp_path):
    assert script(tmp_path, "twice.py", 2).stdout == "[2, 4]\n"
    assert script(tmp_path, "twice.py", 2).stderr == ""
    second = script(tmp_path, "thrice.py", 3)
    assert "to: rows.jsonl holds a sweep of twice.run, this is one of thrice.run" in second.stderr
    assert second.stdout == ""


def test_a_script_run_as_a_module_is_named_as_when_it_is_imported(tmp_path):
    (tmp_path / "inner").mkdir()
    (tmp_path / "inner" / "twice.py").write_text(SCRIPT.format(factor=2))
    done = subprocess.run([sys.executable, "-m", "inner.twice"], cwd=tmp_path, capture_output=True, text=True)
    assert done.stdout == "[2, 4]\n"
    assert json.loads((tmp_path / "rows.jsonl").read_text().splitlines()[0])["sweep"] == "inner.twice.run"


def checked(function):
    @functools.wraps(function)
    def inner(**case):
        return function(**case)

    return inner


decorated = checked(plain)


def test_the_text_of_a_function_is_its_own_whatever_it_is_wrapped_in():
    assert text_mark(plain) == text_mark(decorated) == text_mark(functools.partial(plain, x=3))
    assert len({text_mark(one) for one in (plain, drawn, Simulator, Simulator(1).__call__, steps(1))}) == 5
    assert text_mark(Simulator(1)) == text_mark(Simulator)
    assert text_mark(compiled(plain)) == text_mark(plain)
    assert text_mark(math.sin) is None


def test_a_function_whose_text_has_changed_is_told(tmp_path):
    script(tmp_path, "twice.py", 2)
    content = (tmp_path / "rows.jsonl").read_bytes()
    changed = script(tmp_path, "twice.py", 7)
    assert changed.stdout == "[2, 4]\n"
    said = "rows.jsonl was begun with another text of twice.run, and its 2 results are kept: to have them anew, remove"
    assert said in changed.stderr
    assert (tmp_path / "rows.jsonl").read_bytes() == content
    lines = content.splitlines(keepends=True)
    (tmp_path / "rows.jsonl").write_bytes(lines[0] + b'{"case":1,"failed":"ValueError: no"}\n')
    anew = script(tmp_path, "twice.py", 7)
    assert anew.stdout == "[7, 14]\n"
    assert anew.stderr == "", "nothing of the other text is left"
    assert script(tmp_path, "twice.py", 7).stderr == ""


def test_arguments_in_another_order_are_the_same_case(rows):
    run(drawn, [{"rng": np.random.default_rng(1), "more": 2}], to=rows)
    content = rows.read_bytes()
    run(drawn, [{"more": 2, "rng": np.random.default_rng(1)}], to=rows)
    assert rows.read_bytes() == content


# random generators


def drawn(rng, **more):
    return float(rng.random())


@pytest.mark.parametrize("threads", [False, True])
def test_cases_draw_from_copies_so_that_the_same_call_gives_the_same(rows, threads):
    cases = [{"rng": rng} for rng in np.random.default_rng(1).spawn(3)]
    with joblib.parallel_config("threading", n_jobs=2 if threads else 1):
        first = run(drawn, cases)
        assert run(drawn, cases) == first == run(drawn, cases, jobs=2)
        run(drawn, cases, to=rows)
        assert run(drawn, cases, to=rows) == first
    assert first == [cases[x]["rng"].random() for x in range(3)]


def test_one_generator_twice_in_a_case_stays_one(rows):
    rng = np.random.default_rng(1)
    (both,) = run(lambda a, b: a is b["rng"], [{"a": rng, "b": {"rng": rng}}])
    assert both


@dataclass
class World:
    rng: object
    size: int = 3


class Simulator:
    def __init__(self, rng):
        self.rng = rng

    def __call__(self, x):
        return self.rng.random()


@pytest.mark.parametrize("kind", [np.random.default_rng, np.random.RandomState, random.Random, np.random.PCG64])
@pytest.mark.parametrize(
    "holder",
    [lambda g: g, lambda g: [0, (g,)], lambda g: {"a": {"b": g}}, World, Simulator,
     lambda g: functools.partial(drawn, rng=g), lambda g: Simulator(g).__call__, lambda g: lambda x: g],
)  # fmt: skip
def test_a_generator_that_cases_share_is_found_wherever_it_is(kind, holder):
    shared = kind(1)
    with pytest.raises(ValueError, match=r"cases 1 and 2 share .*thing, a random generator.*: give each a seed"):
        run(drawn, [{"thing": 1}, {"thing": holder(shared)}, {"thing": holder(shared)}])
    assert run(lambda thing: 1, [{"thing": holder(kind(1))}, {"thing": holder(kind(1))}]) == [1, 1]


RNG = np.random.default_rng(1)


def from_the_module(x):
    return RNG.random()


def of_that_name(x):
    return x.RNG


@pytest.mark.parametrize(
    "function",
    [functools.partial(drawn, np.random.default_rng(1)), Simulator(random.Random(1)), Simulator(RNG).__call__,
     lambda x: RNG.random(), from_the_module],
    ids=["partial", "callable", "method", "global of a lambda", "global"],
)  # fmt: skip
def test_a_generator_that_the_function_holds_is_refused(function):
    """On one core each case drew other numbers, on two the same."""
    with pytest.raises(ValueError, match=r"function holds a random generator.*: give each case a seed"):
        run(function)


def test_a_long_list_is_not_looked_through_and_a_generator_beside_it_is_found():
    looked = iter(range(10**9))
    held = types.MappingProxyType({"long": Endless(looked), "rng": np.random.default_rng(1)})
    with pytest.raises(ValueError, match="share what is in thing, a random generator"):
        run(drawn, [{"thing": held, "x": x} for x in range(2)])
    assert next(looked) < 100_000
    loop = [1]
    loop.append(loop)
    assert run(len, [], on_error="raise") == run(lambda thing: 1, [{"thing": loop}])[1:]


class Endless(list):
    def __init__(self, things):
        self.things = things

    def __iter__(self):
        return self.things


def test_a_function_of_one_case_may_hold_a_generator():
    assert run(Simulator(random.Random(1)), CASES[:1]) == [random.Random(1).random()]


def test_an_attribute_of_the_name_of_a_generator_is_none():
    class Named:
        RNG = 3

    assert run(of_that_name, [{"x": Named}, {"x": Named}]) == [3, 3]


# failures that read the same wherever they rose


class WrappedError(Exception):
    def __init__(self, path):
        super().__init__(f"can't read {path}")


class PairError(Exception):
    def __init__(self, a, b):
        super().__init__(f"{a} and {b}")


class MuteError(Exception):
    def __str__(self):
        raise RuntimeError("no words")


def failing(x):
    if x == 1:
        raise WrappedError("f.csv")
    if x == 2:
        raise PairError("this", "that")
    if x == 3:
        raise MuteError
    if x == 4:
        exec("a b")
    return x


@pytest.mark.parametrize("backend", ["loky", "multiprocessing", "threading"])
def test_failures_have_the_same_words_on_one_core_and_many(tmp_path, backend):
    with warnings.catch_warnings(action="ignore"):
        alone = run(failing, to=tmp_path / "alone")
        with joblib.parallel_config(backend, n_jobs=2):
            several = run(failing, to=tmp_path / "several")
    assert (tmp_path / "several").read_bytes() == (tmp_path / "alone").read_bytes()
    assert list(map(repr, several)) == list(map(repr, alone))
    assert [json.loads(row)["failed"] for row in (tmp_path / "alone").read_text().splitlines()[2:6]] == [
        "WrappedError: can't read f.csv",
        "PairError: this and that",
        "MuteError: <exception str() failed>",
        "SyntaxError: invalid syntax (<string>, line 1)",
    ]


class Shy:
    def __repr__(self):
        raise RuntimeError("no words")


@pytest.mark.parametrize("value", [Shy(), 10**5000], ids=["no repr", "too long for text"])
def test_a_case_without_words_does_not_cost_the_sweep(value):
    with pytest.warns(RuntimeWarning, match=r"1 of 2 cases failed \(0\); the first, case 0 \(x=0, y=<(Shy|int)>\)"):
        results = run(lambda x, y: 1 / x, [{"x": 0, "y": value}, {"x": 1, "y": value}])
    assert results[1] == 1.0


def leaving(x, kind):
    if x == 2:
        raise kind
    return x


@pytest.mark.parametrize("jobs", [1, 2])
def test_what_is_no_error_but_leaves_a_function_is_a_failure_and_ctrl_c_stops(rows, jobs):
    with pytest.warns(RuntimeWarning, match=r"1 of 6 cases failed \(2\)"):
        results = run(leaving, [{"x": x, "kind": GeneratorExit} for x in range(6)], jobs=jobs)
    assert isinstance(results[2], Failure)
    with pytest.raises(KeyboardInterrupt) as stopped:
        run(leaving, [{"x": x, "kind": KeyboardInterrupt} for x in range(6)], jobs=jobs, to=rows)
    assert any("the same call goes on from there" in note for note in stopped.value.__notes__)


def test_groups_of_exceptions_keep_no_frames():
    def grouped(x):
        several = []
        try:
            raise ValueError("one")
        except ValueError as error:
            several.append(error)
        raise ExceptionGroup("several", several)

    with pytest.warns(RuntimeWarning):
        (failure,) = run(grouped, CASES[:1])
    assert failure.exception.exceptions[0].__traceback__ is None


# results, and files


@dataclass
class Track(list):
    name: str = "t"


@dataclass
class RefusedError(Exception):
    code: int


class Point(NamedTuple):
    x: float


class Labelled(Point):
    pass


def more_than_fields(x):
    if x == 0:
        return Track("a")
    if x == 1:
        return RefusedError(3)
    label = Labelled(1.0)
    label.text = "lost"
    return label


@pytest.mark.parametrize("x", [0, 1, 2])
def test_what_has_more_than_its_fields_is_refused_when_it_is_written(rows, x):
    with pytest.raises(ValueError, match=r"to: case 0 returned a (Track|RefusedError|Labelled), and a file can't hold"):
        run(more_than_fields, [{"x": x}], to=rows)


@pytest.mark.parametrize("value", [10**4299, 10**4300, -(10**5000), 1 << 14_000], ids="abcd")
def test_whole_numbers_of_any_length_come_back(value):
    assert read(json.loads(as_text(value))) == value


def scaled(x, data):
    data *= x
    return data


def test_a_case_may_change_its_own_arrays_whatever_their_size(tmp_path):
    """joblib gives large ones to other processes as files, which can't be written to unless one asks for it."""
    cases = [{"x": x, "data": np.ones(300_000)} for x in range(4)]
    several = run(scaled, cases, jobs=2)
    assert [float(one.mean()) for one in several] == [0, 1, 2, 3]
    assert {type(one) for one in several} == {np.ndarray}
    assert all(one["data"].mean() == 1 for one in cases)


def processes_of(x):
    return os.getpid()


def test_no_more_processes_than_cases(monkeypatch):
    asked = []
    known = joblib.Parallel

    def noted(*, n_jobs, **more):
        asked.append(n_jobs)
        return known(n_jobs=n_jobs, **more)

    monkeypatch.setattr(joblib, "Parallel", noted)
    assert os.getpid() not in run(processes_of, CASES[:3], jobs=40)
    assert asked == [3]
    assert os.getpid() not in run(processes_of, CASES[:1], jobs=40)
    assert asked == [3, 2], "one case has a process of its own, too, as it may kill it"


def test_names_of_arguments_that_are_no_text_cost_their_case_only(rows):
    with pytest.warns(RuntimeWarning, match="keywords must be strings"):
        results = run(plain, [{1: 1, "x": 2}, {"x": 2}], to=rows)
    assert isinstance(results[0], Failure)
    assert results[1] == 3.0


@pytest.mark.parametrize("place", ["missing/rows", "foreign", "damaged", "folder"])
def test_a_refused_file_is_not_said_to_keep_anything(tmp_path, place):
    (tmp_path / "foreign").write_text("x,y\n")
    (tmp_path / "folder").mkdir()
    run(plain, to=tmp_path / "damaged")
    lines = (tmp_path / "damaged").read_bytes().splitlines(keepends=True)
    (tmp_path / "damaged").write_bytes(b"".join([*lines[:2], b'{"case":1,\n', *lines[3:]]))
    with pytest.raises((ValueError, OSError)) as refused:
        run(plain, to=tmp_path / place)
    assert not hasattr(refused.value, "__notes__")


@pytest.mark.parametrize("damage", [b'{"case":1,\n', b"\n", b'{"case":1,"result":' + b"[" * 100_000 + b"\n"])
def test_damage_is_told_by_its_line_with_the_way_out(rows, damage):
    run(plain, to=rows)
    content = rows.read_bytes()
    lines = content.splitlines(keepends=True)
    rows.write_bytes(b"".join([*lines[:2], damage, *lines[3:]]))
    with pytest.raises(ValueError, match=r"to: rows.jsonl is damaged in line 3.*: remove that line, and its case runs"):
        run(plain, to=rows)
    rows.write_bytes(b"".join([*lines[:2], *lines[3:]]))
    assert run(plain, to=rows) == [x * 1.5 for x in range(6)]
    assert rows.read_bytes() == content


def test_a_header_that_an_editor_saved_in_its_own_way_is_the_same(rows):
    results = run(plain, to=rows)
    content = rows.read_bytes()
    rows.write_bytes(content.replace(b"\n", b"\r\n"))
    assert run(plain, to=rows) == results
    header, rest = content.split(b"\n", 1)
    rows.write_bytes(json.dumps(json.loads(header), separators=(",", ":")).encode() + b"\n" + rest)
    assert run(plain, to=rows) == results


def test_a_file_of_one_long_line_is_not_read_whole(rows, monkeypatch):
    rows.write_bytes(b"[" + b"1," * 10_000_000 + b"1]\n")
    with pytest.raises(ValueError, match="is no file of a sweep"):
        run(plain, to=rows)


def test_who_locks_a_file_that_is_no_longer_there_takes_the_new_one(rows, monkeypatch):
    """Another sweep puts its rows in order, in a new file, after this one opened the old one."""
    fcntl = pytest.importorskip("fcntl")
    run(plain, to=rows)
    lines = rows.read_bytes().splitlines(keepends=True)
    rows.write_bytes(lines[0])
    known, late = fcntl.flock, []

    def locked(file, how):
        if not late:
            late.append(1)
            (rows.parent / "new").write_bytes(b"".join([lines[0], b'{"case":3,"result":"new"}\n']))
            os.replace(rows.parent / "new", rows)
        known(file, how)

    monkeypatch.setattr(module.fcntl, "flock", locked)
    assert run(plain, to=rows) == [0.0, 1.5, 3.0, "new", 6.0, 7.5]
    assert rows.read_bytes() == b"".join(lines).replace(b"4.5", b'"new"')


TO: list = [None]


def removing(x):
    if x == 3:
        TO[0].unlink()
    return x


def replacing(x):
    if x == 3:
        TO[0].unlink()
        TO[0].write_text("something else\n")
    return x


def test_a_file_that_is_removed_while_the_sweep_runs_is_written_at_the_end(rows):
    TO[0] = rows
    assert run(removing, to=rows) == list(range(6))
    assert run(removing, to=rows) == list(range(6)), "nothing runs again"
    assert rows.exists()


def test_a_file_that_is_replaced_while_the_sweep_runs_is_left_alone(rows):
    TO[0] = rows
    with pytest.warns(
        RuntimeWarning, match=r"rows.jsonl was replaced while the sweep ran: what came later isn't in it"
    ):
        assert run(replacing, to=rows) == list(range(6))
    assert rows.read_text() == "something else\n"


def test_a_failure_inside_a_result_is_a_result_without_a_file_and_refused_with_one(rows):
    inner = functools.partial(nested, function=failing)
    with warnings.catch_warnings(action="ignore"):
        (results,) = run(inner, CASES[1:2])
        assert [type(one) for one in results] == [Failure, int]
        with pytest.raises(ValueError, match=r"case 0 returned a list, and a file can't hold a WrappedError"):
            run(inner, CASES[1:2], to=rows)


@pytest.mark.parametrize("x", [1, 2, 3, 4])
def test_failures_of_a_sweep_within_a_case_come_back_from_other_processes(x):
    inner = functools.partial(nested, function=failing)
    with warnings.catch_warnings(action="ignore"):
        here, there = run(inner, [{"x": x}]), run(inner, [{"x": x}], jobs=2)
    assert repr(here) == repr(there)
    assert there[0][1] == 0


def nested(x, function):
    return run(function, [{"x": x}, {"x": 0}])


def test_the_time_left_counts_all_cases_alike(monkeypatch):
    """With tqdm's own mean over the last few it is off by a factor of four where one case in twenty takes long."""
    face = sys.modules["uavlab.sweep.sweep"]
    bars = []
    known = face.tqdm

    def noted(*given, **more):
        bars.append(known(*given, **more))
        return bars[-1]

    monkeypatch.setattr(face, "tqdm", noted)
    sweep(plain, CASES)
    assert bars[0].smoothing == 0


def test_threads_stop_at_an_interrupt(rows):
    with joblib.parallel_config("threading", n_jobs=2), pytest.raises(KeyboardInterrupt):
        run(leaving, [{"x": x, "kind": KeyboardInterrupt} for x in range(6)])
    assert threading.active_count() < 50
