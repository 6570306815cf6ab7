"""What several functions check alike."""

import os
from dataclasses import astuple, make_dataclass

import numpy as np
import pytest

from uavlab import checks
from uavlab.city import City
from uavlab.flight import OffsetProcess, monte_carlo
from uavlab.offsets import offset_paths
from uavlab.optimizers import bas, pso, pso_bas
from uavlab.risk import random_campus
from uavlab.route import Route
from uavlab.vehicle import LIGHT_QUADROTOR

EMPTY = City(np.zeros((9, 9, 9), bool))
DRAWING = {
    "random_pairs": lambda rng: EMPTY.random_pairs(1, rng, apart=2.0),
    "offset_paths": lambda rng: offset_paths(1.0, 2.0, rng),
    "pso": lambda rng: pso(lambda x: (x**2).sum(axis=-1), [(0, 1)], budget=40, rng=rng),
    "bas": lambda rng: bas(lambda x: (x**2).sum(axis=-1), [(0, 1)], budget=40, rng=rng),
    "pso_bas": lambda rng: pso_bas(lambda x: (x**2).sum(axis=-1), [(0, 1)], budget=40, rng=rng),
    "random_campus": random_campus,
    "monte_carlo": lambda rng: monte_carlo(
        Route([(1, 1, 1), (8, 8, 8)]), EMPTY, LIGHT_QUADROTOR, OffsetProcess(), rng=rng, flights=1
    ),
}


@pytest.mark.parametrize("rng", [None, 1.5, -1, "1", True, [], [1, None], np.random])
@pytest.mark.parametrize("draw", DRAWING.values(), ids=DRAWING)
def test_what_gives_other_results_each_time_is_no_seed(draw, rng):
    with pytest.raises(ValueError, match=r"rng must be a numpy\.random\.Generator, or a seed .*, got "):
        draw(rng)


def test_a_seed_of_any_width_is_one():
    for seed in (3, np.int64(3), np.uint8(3)):
        assert checks.generator("rng", seed).random() == np.random.default_rng(3).random()
    assert checks.generator("rng", [1, np.int64(2)]).random() == np.random.default_rng([1, 2]).random()
    rng = np.random.default_rng(0)
    assert checks.generator("rng", rng) is rng


@pytest.mark.parametrize(
    ("check", "message"),
    [
        (lambda: checks.array("points", [1, 2, 3], None, 3), r"points must have shape \(N, 3\), got \(3,\)"),
        (lambda: checks.array("points", [[1, 2]], ..., 3), r"points must have shape \(\.\.\., 3\), got \(1, 2\)"),
        (lambda: checks.array("size", [[1, 2, 3]], 3), r"size must have shape \(3,\), got \(1, 3\)"),
        (lambda: checks.array("size", [1, np.nan, 3], 3), "size must be finite, got nan in it"),
        (lambda: checks.array("grid", 1.0, None, None), r"grid must have shape \(N, M\), got \(\)"),
        (
            lambda: checks.numbers("x", np.array(["3", 4.0], object)),
            "x must be a number or an array of numbers: got text, '3'",
        ),
        (lambda: checks.whole("count", 10**400, 1), r"count must be at most 1,000,000,000, .*, got 1e\+400"),
        (lambda: checks.positive_number("x", 0.0), "x must be finite and above 0, got 0"),
        (lambda: checks.positive_number("x", np.inf), "x must be finite and above 0, got inf"),
        (lambda: checks.not_negative_number("x", -1), "x must be finite and at least 0, got -1"),
        (lambda: checks.not_negative_number("x", np.nan), "x must be finite and at least 0, got nan"),
        (
            lambda: checks.number("share", 2, checks.within, 0.0, 1.0, "of all"),
            "share must be from 0 to 1 of all, got 2",
        ),
        (
            lambda: checks.number("share", [0.5], checks.share),
            r"share must be one number, got an array of shape \(1,\)",
        ),
        (lambda: checks.listed("holes", "abc", "outlines"), "holes must be a list of outlines, got str"),
        (lambda: checks.listed("holes", {}, "outlines"), "holes must be a list of outlines, got dict"),
        (lambda: checks.seeds("seeds", "012"), r"seeds must be whole numbers, such as range\(10\), got '012'"),
        (lambda: checks.seeds("seeds", [0, True]), r"seeds must be whole numbers of at least 0, .*, got True in them"),
        (lambda: checks.text("name", 3), "name must be text, got 3"),
        (lambda: checks.whole("flights", 10**400, 1), "flights must be at most 1,000,000,000, or it never ends"),
        (lambda: checks.path("path", 2), "path must be the name of a file, got 2"),
        (lambda: checks.path("path", ""), "path must be the name of a file, got ''"),
        (lambda: checks.function("f", 3, "f(x)"), r"f must be a function, called as f\(x\), got 3"),
        (lambda: checks.function("f", City), "f must be a function, got <class"),
        (lambda: checks.several("routes", Route([(0, 0, 0)]), Route), "routes must be a list of Route, got Route"),
        (lambda: checks.several("routes", [EMPTY], Route), r"routes\[0\] must be a Route, got City"),
        (lambda: checks.several("routes", [], Route), "routes must hold at least 1 Route, got 0"),
        (lambda: checks.by_name("flights", [1]), "flights must be something by name"),
        (lambda: checks.by_name("routes", {"A*": EMPTY}, Route), r"routes\['A\*'\] must be a Route, got City"),
        (lambda: checks.by_name("routes", {1: Route([(0, 0, 0)])}, Route), "the names of routes must be text, got 1"),
        (lambda: checks.by_name("routes", {}, Route), "routes must hold at least 1, got 0"),
    ],
)
def test_what_is_of_another_kind_is_named(check, message):
    with pytest.raises(ValueError, match=message):
        check()


def test_what_is_right_comes_back(tmp_path):
    (tmp_path / "a.csv").touch()
    assert checks.array("points", [(1, 2, 3)], ..., 3).dtype == float
    assert checks.array("points", np.zeros((2, 4, 3)), ..., 3).shape == (2, 4, 3)
    assert checks.array("values", [np.inf], None, finite=False).tolist() == [np.inf]
    assert checks.path("path", "a.csv").name == "a.csv"
    assert [checks.path("path", entry) for entry in os.scandir(tmp_path)] == [tmp_path / "a.csv"]
    assert checks.several("routes", (Route([(0, 0, 0)]),), Route)[0].planner == "given"
    assert list(checks.by_name("functions", {"f": abs})) == ["f"]


def test_texts_come_back_plain():
    assert type(checks.text("name", np.str_("city"))) is str
    assert type(checks.one_of("zone", np.str_("ball"), ("ball", "ring"))) is str


def test_a_number_may_have_to_stand_another_check():
    share = checks.number("share", np.uint8(1), checks.within, 0.0, 1.0, "of all")
    assert share == 1.0
    assert type(share) is type(checks.number("share", np.float64(0.5), checks.share)) is float


def test_seeds_of_any_width_come_back_plain():
    seeds = checks.seeds("seeds", iter([np.uint8(3), 2**70]))
    assert seeds == [3, 2**70]
    assert {type(seed) for seed in seeds} == {int}


@pytest.mark.parametrize("frozen", [True, False])
def test_fields_become_what_a_check_makes_of_them(frozen):
    kind = make_dataclass("Pair", ["low", "high", "name"], frozen=frozen)
    pair = kind(np.uint8(3), 4, np.str_("a"))
    checks.set_fields(pair, checks.number, "low", "high", check=checks.finite)
    checks.set_fields(pair, checks.one_of, "name", known=("a", "b"))
    assert pair == kind(3.0, 4.0, "a")
    assert [type(value) for value in astuple(pair)] == [float, float, str]
    with pytest.raises(ValueError, match="high must be finite, got inf"):
        checks.set_fields(kind(1.0, np.inf, "a"), checks.number, "low", "high", check=checks.finite)
