"""Files of rows: results held to the last bit, gone on with, and refused where they are of something else."""

import errno
import functools
import json
import math
import os
import signal
import subprocess
import sys
import time
from collections import Counter, namedtuple
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

import uavlab.sweep.rows as module
from uavlab.route import Route
from uavlab.sweep import Failure, sweep
from uavlab.sweep.values import as_text, fingerprint, read

CASES = [{"x": x} for x in range(10)]


@dataclass(frozen=True)
class Thing:
    a: float
    b: tuple = ()
    c: int = field(default=3, init=False)

    def __post_init__(self):
        assert self.a == self.a, "made anew"

    @cached_property
    def double(self):
        return 2 * self.a


Pair = namedtuple("Pair", "left right")


CALLS: list = []
BROKEN: set = set()


def count(x):
    CALLS.append(x)
    if x in BROKEN:
        raise ValueError("no")
    return x * 0.1


@pytest.fixture(autouse=True)
def nothing_yet():
    CALLS.clear()
    BROKEN.clear()


@pytest.fixture
def rows(tmp_path):
    return tmp_path / "rows.jsonl"


def run(to, cases=CASES, function=count, **more):
    return sweep(function, cases, to=to, progress=False, **more)


def back(value):
    return read(json.loads(as_text(value)))


def same(a, b):
    if isinstance(a, np.ndarray):
        return type(b) is np.ndarray and a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()
    if isinstance(a, float):
        return type(a) is type(b) and (a.hex() == b.hex() if type(a) is float else a.tobytes() == b.tobytes())
    if isinstance(a, list | tuple):
        return type(a) is type(b) and len(a) == len(b) and all(map(same, a, b))
    if isinstance(a, dict):
        return type(b) is dict and list(a) == list(b) and all(map(same, a.values(), b.values()))
    return type(a) is type(b) and a == b


NUMBERS = st.integers() | st.floats(allow_nan=False) | st.complex_numbers(allow_nan=False)
PLAIN = NUMBERS | st.none() | st.booleans() | st.text() | st.binary()
ARRAYS = arrays.arrays(
    arrays.boolean_dtypes() | arrays.floating_dtypes() | arrays.integer_dtypes() | arrays.unicode_string_dtypes(),
    arrays.array_shapes(min_dims=0, min_side=0),
)
VALUES = st.recursive(
    PLAIN | ARRAYS | st.frozensets(st.integers()),
    lambda inner: st.lists(inner) | st.tuples(inner, inner) | st.dictionaries(st.text() | st.integers(), inner),
    max_leaves=8,
)


@settings(max_examples=200, deadline=None)
@given(VALUES)
def test_values_come_back_to_the_last_bit(value):
    text = as_text(value)
    assert text.isascii()
    assert "\n" not in text
    assert same(back(value), value)
    assert as_text(back(value)) == text


@pytest.mark.parametrize(
    "value",
    [
        -0.0, 5e-324, math.pi, 10**400, "\ud800\x00\n", {"!array": 1}, {1: 2, "1": 3}, {(1, 2): None}, np.float32(0.1),
        np.longdouble(1) / 3, np.int8(-3), np.bool_(True), np.datetime64("2024-01-02"), np.complex64(1j), {1, 2},
        Pair(1, [2]), Pair(Pair(1, 2), ()), Thing(0.1, (np.float64(2),)), 1 + 0j, complex(-0.0, 3), [], {}, (),
        b"", np.array(3.0),
    ],
    ids=repr,
)  # fmt: skip
def test_odd_values_come_back(value):
    assert same(back(value), value)


def test_nan_and_infinities_come_back():
    for value in (math.nan, math.inf, -math.inf, np.float64("nan")):
        assert np.array_equal(back(value), value, equal_nan=True)
        assert type(back(value)) is type(value)


def test_a_thing_comes_back_by_its_fields_and_nothing_of_it_is_called():
    thing = Thing(0.1)
    assert thing.double == 0.2
    assert back(thing) == thing
    object.__setattr__(thing, "a", math.nan)  # its own check would refuse it
    assert math.isnan(back(thing).a)


def test_a_route_comes_back_whole():
    route = Route([(0, 0, 10), (30, 40, 10)], cost=2.0, info={"history": np.arange(3.0), "expanded": 5})
    again = back(route)
    assert again.length == 50
    assert same(again.info["history"], route.info["history"])


class Loose:
    pass


@pytest.mark.parametrize(
    "value",
    [Loose(), np.array([Loose()]), print, {"a": [Loose()]}, np.ma.array([1, 2]), Counter(), range(3)],
    ids=lambda value: type(value).__name__,
)
def test_what_a_file_cannot_hold_is_refused_at_the_first_row(rows, value):
    with pytest.raises(ValueError, match=r"to: case 0 returned .* a file can't hold .*: return numbers, text"):
        run(rows, function=give_of(value))


def give_of(value):
    RETURNED[0] = value
    return returned


RETURNED: list = [None]


def returned(x):
    return RETURNED[0]


def test_a_thing_with_more_than_its_fields_is_refused(rows):
    thing = Thing(1.0)
    object.__setattr__(thing, "more", 3)
    with pytest.raises(ValueError, match="Thing with more than its fields, more"):
        run(rows, function=give_of(thing))
    loop = []
    loop.append(loop)
    with pytest.raises(ValueError, match="without end"):
        run(rows, function=give_of(loop))


@pytest.mark.parametrize("row", [
    {"!thing": "os:system", "fields": {"command": "touch harm"}},
    {"!thing": "subprocess:Popen", "fields": {"args": ["touch", "harm"]}},
    {"!thing": "antigravity:Thing", "fields": {}},
    {"!thing": f"{__name__}:Thing", "fields": {"a": 1.0}},
    {"!thing": f"{__name__}:Thing.__post_init__", "fields": {}},
    {"!array": "gASVJAAAAAAAAACMBXBvc2l4lIwGc3lzdGVtlJOUjAl0b3VjaCBmb28="},
    {"!array": "AAAA"}, {"!eval": "1"}, {"!float": "x"}, {"!number": "<f8"}, {"!tuple": 3}, {"!bytes": "é"},
])  # fmt: skip
def test_a_file_of_somebody_else_runs_nothing(rows, row, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    run(rows)
    lines = rows.read_text().splitlines()
    lines[4] = json.dumps({"case": 3, "result": row})
    rows.write_text("\n".join(lines) + "\n")
    with pytest.raises(ValueError, match=r"to: rows\.jsonl, case 3: "):
        run(rows)
    assert "antigravity" not in sys.modules
    assert [path.name for path in tmp_path.iterdir()] == ["rows.jsonl"]


def test_a_finished_file_gives_its_results_without_a_call(rows):
    first = run(rows)
    assert len(CALLS) == 10
    content = rows.read_bytes()
    assert run(rows) == first == [x * 0.1 for x in range(10)]
    assert len(CALLS) == 10
    assert rows.read_bytes() == content
    header = json.loads(content.splitlines()[0])
    assert header["sweep"].endswith("test_sweep_files.count")
    assert header["cases"] == 10


def test_only_what_is_missing_runs(rows, capsys):
    run(rows)
    content = rows.read_bytes()
    lines = content.splitlines(keepends=True)
    rows.write_bytes(b"".join([lines[0], lines[7], lines[3]]))
    CALLS.clear()
    sweep(count, CASES, to=rows)
    assert CALLS == [0, 1, 3, 4, 5, 7, 8, 9]
    assert rows.read_bytes() == content, "in the order of the cases again"
    assert "10/10" in capsys.readouterr().err


@pytest.mark.parametrize("cut", [1, 5, 12])
def test_a_last_line_that_is_not_whole_runs_again(rows, cut):
    run(rows)
    content = rows.read_bytes()
    rows.write_bytes(content[:-cut])
    CALLS.clear()
    run(rows)
    assert CALLS == [9]
    assert rows.read_bytes() == content


def test_zeros_at_the_end_as_power_cuts_leave_them_are_dropped(rows):
    run(rows)
    content = rows.read_bytes()
    rows.write_bytes(content[: content.rindex(b'{"case":9')] + bytes(4096))
    run(rows)
    assert rows.read_bytes() == content


def test_half_a_header_is_begun_anew(rows):
    run(rows)
    content = rows.read_bytes()
    for size in (0, 1, 40, content.index(b"\n")):
        rows.write_bytes(content[:size])
        run(rows)
        assert rows.read_bytes() == content


def test_damage_before_the_last_line_is_refused_and_the_file_left_as_it_is(rows):
    run(rows)
    lines = rows.read_bytes().splitlines(keepends=True)
    lines[5] = lines[5][:-4] + b"\n"
    rows.write_bytes(b"".join(lines))
    with pytest.raises(ValueError, match=r"to: rows.jsonl is damaged in line 6, and more follow"):
        run(rows)
    assert rows.read_bytes() == b"".join(lines)


def test_rows_of_cases_that_are_not_there_are_refused(rows):
    run(rows)
    with rows.open("a") as file:
        file.write('{"case":10,"result":1}\n')
    with pytest.raises(ValueError, match="has a row of case 10, which isn't one of 10"):
        run(rows)


def other(x):
    return x


def test_files_of_another_sweep_are_refused_by_name(rows, monkeypatch):
    run(rows)
    content = rows.read_bytes()
    with pytest.raises(
        ValueError, match=r"to: rows.jsonl holds a sweep of .*count, this is one of .*other: take another"
    ):
        run(rows, function=other)
    with pytest.raises(ValueError, match=r"holds a sweep of .*count over other cases \(10, these are 9\)"):
        run(rows, cases=CASES[:9])
    with pytest.raises(ValueError, match=r"over other cases \(10, these are 10\)"):
        run(rows, cases=CASES[::-1])
    monkeypatch.setattr(module, "__version__", "9.9.9")
    with pytest.raises(ValueError, match=r"is of version .* \(format 1\), this is 9\.9\.9 \(format 1\)"):
        run(rows)
    monkeypatch.undo()
    monkeypatch.setattr(module, "FORMAT", 2)
    with pytest.raises(ValueError, match=r"\(format 1\), this is .* \(format 2\)"):
        run(rows)
    assert rows.read_bytes() == content


@pytest.mark.parametrize("content", ["x,y\n1,2\n", "no line", "{}\n", "[]\n", "3\n", '{"uavlab": "0.2.0"}\n'])
def test_files_of_something_else_are_refused_and_left_alone(rows, content):
    rows.write_text(content)
    with pytest.raises(ValueError, match=r"to: rows.jsonl is no file of a sweep: take another name, or remove it"):
        run(rows)
    assert rows.read_text() == content


def test_what_is_no_file_is_refused(tmp_path):
    with pytest.raises(ValueError, match="to must be the name of a file that can be read again"):
        run("/dev/null")
    with pytest.raises(ValueError, match="to must be the name of a file"):
        run(3)
    with pytest.raises(ValueError, match="to must be the name of a file that can be read again"):
        run(tmp_path)
    with pytest.raises(FileNotFoundError):
        run(tmp_path / "nowhere" / "rows")


def test_failed_cases_are_in_the_file_and_run_again(rows):
    BROKEN.update({2, 6})
    with pytest.warns(RuntimeWarning, match=r"2 of 10 cases failed \(2, 6\)"):
        results = run(rows)
    assert [x for x, result in enumerate(results) if isinstance(result, Failure)] == [2, 6]
    assert rows.read_text().splitlines()[3] == '{"case":2,"failed":"ValueError: no"}'
    CALLS.clear()
    BROKEN.clear()
    assert run(rows) == [x * 0.1 for x in range(10)]
    assert CALLS == [2, 6]
    alone = rows.with_name("alone")
    run(alone)
    assert alone.read_bytes() == rows.read_bytes()


def test_of_two_rows_of_a_case_the_later_holds(rows):
    run(rows)
    content = rows.read_bytes()
    with rows.open("a") as file:
        file.write('{"case":3,"failed":"ValueError: no"}\n{"case":4,"result":7}\n')
    CALLS.clear()
    assert run(rows)[3:5] == [3 * 0.1, 7]
    assert CALLS == [3]
    assert rows.read_bytes() == content.replace(b'{"case":4,"result":0.4}', b'{"case":4,"result":7}')


def test_an_error_says_what_is_kept(rows):
    BROKEN.add(4)
    with pytest.raises(ValueError, match="no") as raised:
        run(rows, on_error="raise")
    assert raised.value.__notes__ == [
        "in the case x=4",
        f"4 of 10 cases are kept in {rows} (0–3): the same call goes on from there",
    ]
    BROKEN.clear()
    CALLS.clear()
    run(rows, on_error="raise")
    assert CALLS == [4, 5, 6, 7, 8, 9]


def interrupted(x):
    CALLS.append(x)
    if x in BROKEN:
        raise KeyboardInterrupt
    return x


def test_after_ctrl_c_what_is_done_stays_and_is_said(rows):
    BROKEN.add(6)
    with pytest.raises(KeyboardInterrupt) as stopped:
        run(rows, function=interrupted)
    assert stopped.value.__notes__ == [f"6 of 10 cases are kept in {rows} (0–5): the same call goes on from there"]
    with pytest.raises(KeyboardInterrupt) as stopped:
        sweep(interrupted, CASES, progress=False)
    assert stopped.value.__notes__ == ["6 cases had ended and are lost: a file, to=, would keep them"]
    BROKEN.clear()
    CALLS.clear()
    assert run(rows, function=interrupted) == list(range(10))
    assert CALLS == [6, 7, 8, 9]


def slow(x):
    time.sleep(0.02)
    return x


def test_a_signal_as_of_ctrl_c_leaves_a_file_to_go_on_from(rows):
    program = f"""
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell may have started the tests without
sys.path.insert(0, {str(Path(__file__).parent)!r})
from test_sweep_files import slow
from uavlab.sweep import sweep
sweep(slow, [{{"x": x}} for x in range(1000)], jobs=2, to={str(rows)!r}, progress=False)
"""
    began = subprocess.Popen([sys.executable, "-c", program], stderr=subprocess.PIPE, text=True, start_new_session=True)
    while not (rows.exists() and rows.read_bytes().count(b"\n") > 20):
        assert began.poll() is None
    os.killpg(began.pid, signal.SIGINT)  # the terminal's way: workers get it, too
    _, said = began.communicate(timeout=60)
    assert "KeyboardInterrupt" in said
    assert "of 1000 cases are kept in" in said
    kept = rows.read_bytes()
    assert kept.endswith(b"}\n")
    assert 20 <= kept.count(b"\n") - 1 < 1000


LIMITED = """
import resource, sys
sys.path.insert(0, {folder!r})
from test_sweep_files import long_text
from uavlab.sweep import sweep
resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))
sweep(long_text, [{{"x": x}} for x in range(100)], to={rows!r}, progress=False)
"""


def long_text(x):
    return f"{x}" * 300


@pytest.mark.skipif(sys.platform == "win32", reason="no limits there")
def test_a_full_disk_stops_with_what_is_kept_and_harms_nothing(rows):
    """A limit to the size of files does what a full disk does: it takes a part of a row."""
    program = LIMITED.format(folder=str(Path(__file__).parent), rows=str(rows))
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    kept = rows.read_bytes().count(b"\n") - 1
    assert f"OSError: [Errno {errno.EFBIG}] File too large; {kept} of 100 cases are kept in" in done.stderr
    assert f"(0–{kept - 1}): the same call goes on from there" in done.stderr
    assert 20 < kept < 40
    assert rows.read_bytes().endswith(b"}\n")
    cases = [{"x": x} for x in range(100)]
    assert run(rows, function=long_text, cases=cases) == [f"{x}" * 300 for x in range(100)]
    alone = rows.with_name("alone")
    run(alone, function=long_text, cases=cases)
    assert alone.read_bytes() == rows.read_bytes()


def test_a_disk_that_is_full_when_rows_are_ordered_keeps_them_all(rows, monkeypatch):
    run(rows)
    lines = rows.read_bytes().splitlines(keepends=True)
    unordered = b"".join([lines[0], *lines[:0:-1]])
    rows.write_bytes(unordered)

    def full(descriptor):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OSError, match=r"No space left on device; the rows aren't in order yet.*10 of 10 cases"):
        run(rows)
    monkeypatch.undo()
    assert rows.read_bytes() == unordered
    assert [path.name for path in rows.parent.iterdir()] == ["rows.jsonl"]
    assert len(run(rows)) == 10
    assert rows.read_bytes() == b"".join(lines)


def test_two_sweeps_at_once_do_not_write_to_one_file(rows):
    pytest.importorskip("fcntl")

    with pytest.raises(ValueError, match=r"to: another sweep is writing to rows\.jsonl"):
        run(rows, function=nested, cases=[{"to": str(rows)}], on_error="raise")


def nested(to):
    return run(to)


def test_rows_are_there_while_the_sweep_runs(rows):
    READ[0] = rows
    assert run(rows, function=lines_of) == [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]


READ: list = [None]


def lines_of(x):
    return READ[0].read_bytes().count(b"\n")


@pytest.mark.parametrize("jobs", [2, -1])
def test_many_cores_write_the_bytes_of_one(rows, jobs):
    alone = rows.with_name("alone")
    cases = [{"x": x} for x in range(60)]
    run(alone, function=uneven, cases=cases)
    run(rows, function=uneven, cases=cases, jobs=jobs)
    assert alone.read_bytes() == rows.read_bytes()


def uneven(x):
    time.sleep(0.05 if x % 7 == 0 else 0.0)
    draws = np.random.default_rng(x).standard_normal((3, 2))
    return {
        "draws": draws,
        "turned": draws.T,
        "part": draws[::2],
        "frozen": Route([(0, 0, x), (1, 2, x)]),
        "mean": draws.mean(),
    }


def test_equal_cases_are_refused_with_a_file_and_run_twice_without(rows):
    cases = [{"x": 1}, {"x": 2}, {"x": 1}]
    with pytest.raises(ValueError, match=r"cases 0 and 2 are equal \(x=1\), and a file keeps each once: give"):
        run(rows, cases=cases)
    assert not rows.exists()
    assert sweep(count, cases, progress=False) == [0.1, 0.2, 0.1]


def test_functions_and_cases_that_cannot_be_told_apart_are_refused(rows):
    with pytest.raises(ValueError, match=r"function can't be told from others.*lambda"):
        run(rows, function=lambda x: x)
    with open(__file__) as file, pytest.raises(ValueError, match=r"x of case 1 can't be told from others.*file"):
        run(rows, cases=[{"x": 1}, {"x": file}])
    with pytest.raises(ValueError, match=r"x of case 0 can't be told from others.*lambda"):
        run(rows, cases=[{"x": lambda: 1}])
    loop = []
    loop.append(loop)
    with pytest.raises(ValueError, match="x of case 0 can't be told from others"):
        run(rows, cases=[{"x": loop}])
    assert not rows.exists()


def mark(value):
    return fingerprint(value, {})


def made_of(k):
    def inner(x, more=k):
        return x + k

    return inner


def plain_of(k):
    def inner(x, more=k):
        return x

    return inner


DIFFERENT = [
    1, 1.0, True, "1", b"1", None, -0.0, 0.0, (1,), [1], {1}, {"a": 1}, {"a": 2}, {"b": 1}, np.array([1]),
    np.array([1.0]), np.array([[1]]), np.int64(1), Thing(1.0), Thing(2.0), Pair(1, 2), (1, 2), count, other,
    functools.partial(count, 1), functools.partial(count, 2), functools.partial(other, 1), made_of(1), made_of(2),
    plain_of(1), plain_of(2), Thing, np.random.default_rng(1), np.random.default_rng(2),
    *np.random.default_rng(1).spawn(2), "a".upper, "b".upper, math.sin, Route([(0, 0, 1), (1, 1, 1)]),
    Route([(0, 0, 1), (1, 1, 2)]),
]  # fmt: skip


def test_different_things_have_different_fingerprints():
    marks = [mark(value) for value in DIFFERENT]
    assert [marks.count(one) for one in marks] == [1] * len(marks)


def test_equal_things_have_equal_fingerprints_whatever_they_remember():
    used = Thing(1.0)
    assert used.double == 2.0
    assert mark(used) == mark(Thing(1.0))
    assert mark({"a": 1, "b": 2}) == mark({"b": 2, "a": 1})
    assert mark(np.random.default_rng(3)) == mark(np.random.default_rng(3))
    assert mark(np.arange(6).reshape(2, 3)) == mark(np.arange(6).reshape(2, 3).copy())
    drawn, spawned = np.random.default_rng(3), np.random.default_rng(3)
    drawn.random()
    spawned.spawn(1)
    assert len({mark(one) for one in (drawn, spawned, np.random.default_rng(3))}) == 3


def test_a_fingerprint_is_the_same_in_another_process():
    program = f"import sys; sys.path.insert(0, {str(Path(__file__).parent)!r}); from test_sweep_files import *"
    for seed in ("1", "2"):
        more = {"env": {**os.environ, "PYTHONHASHSEED": seed}, "capture_output": True, "text": True}
        done = subprocess.run([sys.executable, "-c", f"{program}; print(mark(KNOWN))"], **more, check=True)
        assert done.stdout.strip() == mark(KNOWN)


KNOWN = {"a": [1, 2.5, {"x", "y", "z"}], "b": np.arange(4.0), "c": functools.partial(count, x=3), "d": Thing(0.1)}


def test_things_that_cases_share_are_told_once():
    """And nothing that is made on the way takes the place of another."""
    seen = {}
    shared = np.arange(1000.0)
    for number in range(200):
        one = fingerprint({"rng": np.random.default_rng(number), "shared": shared}, seen)
        assert one == mark({"rng": np.random.default_rng(number), "shared": shared})
