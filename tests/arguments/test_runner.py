"""The runner itself: a test of arguments that takes every answer for a clear one would be none."""

import time

import calls
import numpy as np
import pytest
import runner
from calls import CALLS
from mistakes import Spot, kind_of, mistakes_for

from uavlab import offsets, route


@pytest.fixture
def outcome(monkeypatch):
    """What the runner says of a mistake in the argument of a function of ours."""

    def ask(function, wrong="much"):
        monkeypatch.setattr(runner, "functions", lambda: {"ours": function})
        monkeypatch.setattr(runner, "TIMEOUT", 0.2)
        monkeypatch.setitem(CALLS, "ours", lambda: {"speed": 2.0})
        spot = Spot("ours", "speed", "float", "", False, 2.0)
        return runner.classify("ours", "speed", spot, "a word", wrong, runner.digest(2.0))[0]

    return ask


def raises(error):
    def function(speed):
        raise error

    return function


def endless(speed):
    while True:
        time.sleep(0.01)


@pytest.mark.parametrize(
    ("function", "kind"),
    [
        (raises(ValueError("speed must be above 0, got 'much'")), "clear"),
        (raises(TypeError("'speed' must be a number")), "clear"),
        (raises(ValueError("top_speed must be above 0, got 'much'")), "cryptic"),
        (raises(ValueError("could not convert string to float: 'much'")), "cryptic"),
        (raises(AttributeError("speed")), "cryptic"),
        (lambda speed: 2.0, "ignored"),
        (lambda speed: 3.0, "accepted"),
        (lambda speed: "much", "accepted"),
        (lambda speed: np.nan, "nan out"),
        (lambda speed: (1.0, np.array([1j])), "nan out"),
        (endless, "slow"),
    ],
)
def test_outcomes(outcome, function, kind):
    assert outcome(function) == kind


def test_the_t_of_can_t_names_no_parameter():
    assert not runner.names("it can't be", "t")
    assert not runner.names("values must be finite", "value")
    assert runner.names("runs[0] must be Flights", "runs")
    assert runner.names("'t' must rise, got t=3", "t")


@pytest.mark.parametrize(
    ("note", "said", "value", "mistake", "counts"),
    [
        ("float", "speed : float\n    [m/s], above 0.", 2.0, "zero", True),
        ("float", "speed : float\n    [m/s], at least 0.", 2.0, "zero", False),
        ("float", "speed : float\n    [m/s], at least 0.", 2.0, "negative", True),
        ("float | None", "", 2.0, "None", False),
        ("float", "", 2.0, "None", True),
        ("npt.ArrayLike", "speed : float or array", 2.0, "a list", False),
        ("npt.ArrayLike", "speed : (..., 3) array", (1.0, 2.0, 3.0), "deeper", False),
        ("npt.ArrayLike", "speed : (3,) array", (1.0, 2.0, 3.0), "deeper", True),
        ("Route | Curve", "", CALLS["route.Route.clearance"]()["self"], "a Curve", False),
        ("Route", "", CALLS["route.Route.clearance"]()["self"], "a Curve", True),
    ],
)
def test_what_counts_as_a_mistake(note, said, value, mistake, counts):
    spot = Spot("ours", "speed", note, said, "None" in note, value)
    assert (mistake in dict(mistakes_for(spot))) is counts


def test_kinds_follow_from_values_and_annotations():
    kinds = [("int", 3), ("float", 3.0), ("npt.ArrayLike", 3.0), ("npt.ArrayLike", (1.0, 2.0)), ("bool", True),
             ("str", "octile"), ("Sequence[City]", [None]), ("City", None)]  # fmt: skip
    found = [kind_of(Spot("ours", "one", note, "", False, value)) for note, value in kinds]
    assert found == ["count", "number", "numbers", "array", "flag", "choice", "sequence", "thing"]


def test_results_agree_to_what_32_bits_leave():
    one = runner.digest({"points": np.ones((2, 3)), "elapsed": 1.0, "name": "a"})
    assert runner.same(one, runner.digest({"points": np.ones((2, 3)) + 1e-8, "elapsed": 2.0, "name": "a"}))
    assert not runner.same(one, runner.digest({"points": np.ones((2, 3)) + 1e-5, "elapsed": 1.0, "name": "a"}))
    assert not runner.same(one, runner.digest({"points": np.ones((3, 2)), "elapsed": 1.0, "name": "a"}))
    assert not runner.same(one, runner.digest({"points": np.ones((2, 3)), "elapsed": 1.0, "name": "b"}))


def test_a_new_function_is_found(monkeypatch):
    before = calls.public().keys()
    monkeypatch.setattr(offsets, "newcomer", lambda sigma: sigma, raising=False)
    monkeypatch.setattr(offsets, "__all__", [*offsets.__all__, "newcomer"])
    monkeypatch.setattr(route.Route, "shorter", lambda self, by: self, raising=False)
    assert calls.public().keys() - before == {"offsets.newcomer", "route.Route.shorter"}
