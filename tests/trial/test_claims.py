"""The list of claims: complete for tables, figures and equations, without doubles, with experiments that answer."""

import re
from itertools import chain
from pathlib import Path

import pytest

from uavlab.trial import CLAIMS, VERDICTS, Claim, Experiment, Finding, Measured, agree, by_campuses, verdict
from uavlab.trial.running import experiments, measure

CHAPTERS = {path.name[:2] for path in (Path(__file__).parents[2] / "notebooks/src").glob("[0-9][0-9]_*.py")}
PRINTED = {
    ("REPARE", "Table"): 4, ("REPARE", "Fig."): 18, ("REPARE", "Eq."): 17,
    ("RISK-ACO", "Table"): 5, ("RISK-ACO", "Fig."): 15, ("RISK-ACO", "Eq."): 19,
    ("PSO-BAS", "Table"): 4, ("PSO-BAS", "Fig."): 10, ("PSO-BAS", "Eq."): 25,
}  # fmt: skip
"""How many of each the papers have."""
QUICK = [one for one in experiments() if one.quick == one.full == 1]


def numbers_in(item, kind):
    """Numbers of the tables, figures or equations that an item names: "Figs 8–10, 12" has 8, 9, 10 and 12."""
    word = {"Table": "Table", "Fig.": r"Figs?\.?", "Eq.": r"Eqs?\.?"}[kind]
    found = re.findall(rf"\b{word} ((?:\d+(?:(?:–| to |, )(?=\d))?)+)", item)
    for part in chain.from_iterable(text.split(", ") for text in found):
        first, *last = re.split("–| to ", part)
        yield from range(int(first), int((last or [first])[0]) + 1)


@pytest.mark.parametrize(("paper", "kind"), PRINTED)
def test_every_table_figure_and_equation_is_on_trial(paper, kind):
    mine = [claim.item for claim in CLAIMS if claim.paper == paper]
    named = set(chain.from_iterable(numbers_in(item, kind) for item in mine))
    assert named == set(range(1, PRINTED[paper, kind] + 1))


def test_no_claim_comes_twice_and_each_has_a_chapter():
    keys = [(claim.paper, claim.item) for claim in CLAIMS]
    assert len(set(keys)) == len(keys)
    assert {claim.chapter for claim in CLAIMS} <= CHAPTERS


@pytest.mark.parametrize("claim", CLAIMS, ids=lambda claim: f"{claim.paper} {claim.item}")
def test_a_claim_says_in_a_sentence_why_and_writes_no_measured_number_down(claim):
    assert claim.why.endswith(".")
    assert claim.why[0].isupper()
    words = re.sub(r"(Eqs?|Table|Figs?|chapter|Number) \d+|\d+ 000|45°|f1|3σ|L²|2gh|R²|V²", "", claim.why)
    assert not re.search(r"\d+\.\d|\d+ ?%", words), "a measured number belongs into the experiment"
    if claim.experiment and claim.side != "equal" and claim.line not in (None, 0.0, 50.0, 1.0) and not claim.printed:
        assert "line" in claim.says or claim.unit == "of 10 segments", "the reader is told a line that we chose"


@pytest.mark.parametrize("experiment", QUICK, ids=lambda one: one.name)
def test_what_needs_no_sample_answers_all_that_is_asked(experiment):
    found = measure(experiment, full=True)
    asked = {claim.of for claim in CLAIMS if claim.experiment == experiment}
    assert asked <= set(found)
    for one in found.values():
        assert one.low <= one.value <= one.high
        assert one.sample


def claim(**settings):
    given = {"paper": "REPARE", "item": "Table 9", "says": "it is so", "why": "It is.", "chapter": "07"}
    return Claim(**(given | settings))


@pytest.mark.parametrize(
    ("settings", "interval", "expected"),
    [
        ({"printed": "0.952", "line": 1.0, "side": "below"}, (0.94, 0.96), "holds"),
        ({"printed": "0.952", "line": 1.0, "side": "below"}, (0.9525, 0.96), "holds"),  # as far as its digits go
        ({"printed": "0.952", "line": 1.0, "side": "below"}, (0.953, 0.96), "partly"),
        ({"printed": "0.952", "line": 1.0, "side": "below"}, (0.90, 0.951), "partly"),  # and shorter still
        ({"printed": "0.952", "line": 1.0, "side": "below"}, (0.94, 1.0), "not shown"),  # the line is in it
        ({"printed": "0.952", "line": 1.0, "side": "below"}, (1.0, 1.1), "doesn't"),
        ({"printed": "80", "line": 0.0, "at_least": True}, (85, 90), "holds"),
        ({"printed": "80", "line": 0.0, "at_least": True}, (60, 79.5), "holds"),
        ({"printed": "80", "line": 0.0, "at_least": True}, (60, 79.4), "partly"),
        ({"printed": "80", "line": 0.0, "at_least": True}, (0, 90), "not shown"),
        ({"printed": "80", "line": 0.0, "at_least": True}, (-9, 0), "doesn't"),
        ({"printed": "21", "line": 50.0, "side": "below", "at_least": True}, (1, 2), "holds"),
        ({"printed": "99.7"}, (99.73, 99.73), "holds"),
        ({"printed": "99.7"}, (99.76, 99.8), "doesn't"),
        ({"printed": "8.75e-7"}, (8.7451e-7, 8.8e-7), "holds"),
        ({"printed": "8.75e-7"}, (8.76e-7, 8.8e-7), "doesn't"),
        ({"line": 50.0}, (50.1, 60), "holds"),
        ({"line": 50.0}, (50.0, 60), "not shown"),
        ({"line": 50.0}, (40, 50.0), "doesn't"),
        ({"line": 1.0, "side": "equal"}, (0.95, 1.05), "holds"),
        ({"line": 1.0, "side": "equal"}, (0.94, 1.0), "not shown"),
        ({"line": 1.0, "side": "equal"}, (0.90, 0.94), "doesn't"),
        ({"line": 50.0, "fair": False}, (60, 70), "can't be checked"),
    ],
)  # fmt: skip
def test_the_rule(settings, interval, expected):
    low, high = interval
    assert verdict(claim(**settings), Measured((low + high) / 2, low, high, "some")) == expected
    assert expected in VERDICTS


def test_nothing_measured_nothing_checked():
    assert verdict(claim(line=1.0), None) == "can't be checked"


@pytest.mark.parametrize("interval", [(2.0, 3.0, 4.0), (float("nan"), 0, 1), (1, float("nan"), 2), (5.0, 3.0, 4.0)])
def test_a_value_lies_within_its_interval(interval):
    with pytest.raises(ValueError, match="measured must have its value within its interval"):
        verdict(claim(line=1.0), Measured(*interval, "some"))


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"printed": "80 %"}, "printed must be a number"),
        ({"printed": "inf"}, "printed must be a number"),
        ({"side": "over"}, "side must be one of"),
        ({"paper": "ours"}, "paper must be one of"),
        ({"item": " "}, "item must say something"),
        ({"line": float("inf")}, "line"),
        ({"experiment": QUICK[0]}, "of must name the value"),
        ({"experiment": QUICK[0], "of": "one"}, "line must be a number where"),
        ({"fair": "no"}, "fair must be True or False"),
    ],
)
def test_claims_that_nothing_could_show_are_refused(settings, words):
    with pytest.raises(ValueError, match=words):
        claim(**settings)


@pytest.mark.parametrize(
    ("settings", "words"),
    [({"quick": 0}, "quick"), ({"quick": 5, "full": 4}, "full"), ({"seed": -1}, "seed"), ({"measure": 3}, "measure")],
)
def test_experiments_have_sizes(settings, words):
    with pytest.raises(ValueError, match=words):
        Experiment(**({"measure": QUICK[0].measure} | settings))


@pytest.mark.parametrize(
    ("one", "other", "expected"),
    [
        ((1.0, 0.9, 1.1), (1.2, 1.1, 1.3), True),
        ((1.0, 0.9, 1.1), (1.3, 1.2, 1.4), False),
        ((1.3, 1.2, 1.4), (1.0, 0.9, 1.1), False),
        ((2.0, 2.0, 2.0), (2.000001, 2.000001, 2.000001), True),
        ((2.0, 2.0, 2.0), (2.001, 2.001, 2.001), False),
    ],
)
def test_intervals_that_touch_agree(one, other, expected):
    mine = claim(line=1.0)
    both = [Finding.of(mine, Measured(*numbers, "some"), "") for numbers in (one, other)]
    assert agree(*both) is expected
    assert agree(*both[::-1]) is expected


def test_only_findings_of_one_claim_are_compared():
    one, other = (Finding.of(claim(item=item), None, "") for item in ("Table 8", "Table 9"))
    assert agree(one, one)
    assert not agree(one, Finding.of(one.claim, Measured(1, 1, 1, "some"), ""))
    with pytest.raises(ValueError, match="other must be of the same claim"):
        agree(one, other)


def test_no_limits_of_tilt_would_let_the_curves_be_flown():
    """So that a verdict on them doesn't hang on the limits of our UAV, as the claim's reason says."""
    assert by_campuses.curves(10, 0)["least press"].value > 3
