"""The page of the planners of the world: what it computes of times, and that it says what is missing; unclocked."""

import numpy as np
import pytest
import world
from world import Growth, Measured, Peer


@pytest.fixture
def rows():
    there = Peer("a question", "somebody", "numpy", lambda quick: None)
    missing = Peer("a question", "nobody", "no-such-package-at-all", lambda quick: None)
    measured = Measured(np.array([0.001, 0.002, 0.003]), np.array([0.01, 0.02, 0.03]), "of equal cost")
    return [(there, measured), (missing, None)]


@pytest.fixture
def grown():
    voxels = np.array([1e6, 8e6, 64e6])
    return Growth(voxels, np.outer(voxels, [1, 2]) / 100, np.outer(voxels**0.5, [1.0, 2.0]) / 1e6)


def test_a_ratio_is_of_totals_and_lies_in_its_interval():
    rng = np.random.default_rng(1)
    ours = rng.uniform(1, 2, 20)
    theirs = ours * rng.uniform(3, 5, 20)
    ratio, low, high = world.ratio_of(Measured(ours, theirs, ""))
    assert ratio == theirs.sum() / ours.sum()
    assert 3 < low < ratio < high < 5


def test_an_exponent_is_found_again(grown):
    assert world.exponent(grown.voxels, grown.seconds) == pytest.approx((0.5, 0.5, 0.5))
    assert world.exponent(grown.voxels, grown.expanded) == pytest.approx((1.0, 1.0, 1.0))


def test_costs_apart():
    assert world.costs_apart(np.array([1.0, 2.0]), np.array([1.0, 2.0 + 1e-12])) == "of equal cost"
    assert world.costs_apart(np.array([1.0, 1.0]), np.array([1.0, 1.1])) == "5 % more there"
    assert world.costs_apart(np.array([1.0, 1.0]), np.array([1.0, 0.9])) == "5 % less there"


def test_the_page_has_ratios_and_what_is_missing(rows, grown, monkeypatch):
    monkeypatch.setattr(world, "copied_per_second", lambda: 1e10)
    text = world.page(rows, grown, quick=False)
    assert "| a question | somebody | 3 | 2 | 20 | 10 | 10 to 10 | of equal cost |" in text
    assert "| a question | nobody | | | | not installed | | |" in text
    assert "b = 0.50 [0.50, 0.50]" in text
    assert "no-such-package" not in text  # versions are of those at the table
    for peer in world.PEERS:
        version = world.version_of(peer.package)
        assert f"{peer.package} {version or '(not installed)'}" in text


def test_the_picture_has_a_bar_for_each_that_is_there(rows):
    (axes,) = world.picture(rows).axes
    assert [line.get_xdata()[0] for line in axes.lines if line.get_marker() == "o"] == [10.0]
    assert axes.get_xscale() == "log"
    assert [label.get_text() for label in axes.get_yticklabels()] == ["somebody\na question"]


def test_numbers_have_three_digits_and_no_power_of_ten():
    assert [world.three_digits(number) for number in (1083.2, 23456.7, 0.012345, 2.0, 26.94)] == [
        "1 080", "23 500", "0.0123", "2", "26.9",
    ]  # fmt: skip


def test_readme_has_the_table_of_the_page(rows, tmp_path, monkeypatch):
    page, readme = world.PAGE.read_text(encoding="utf-8"), world.README.read_text(encoding="utf-8")
    measured = [[cell.strip() for cell in line.split("|")[1:-1]] for line in page.splitlines() if line.startswith("| ")]
    alike = {(peer.question, peer.name) for peer in world.PEERS if peer.alike}
    kept = [f"| {' | '.join([*row[:2], row[3], *row[5:]])} |" for row in measured if tuple(row[:2]) in alike and row[6]]
    assert len(kept) > len(alike) / 2
    begin = readme.index("| question | beside |")
    assert readme[begin : readme.index("\n\n", begin)].splitlines()[2:] == kept
    other = tmp_path / "README.md"
    other.write_text(f"before\n\n{readme[begin:]}", encoding="utf-8")
    monkeypatch.setattr(world, "README", other)
    world.put_in_short(rows)
    assert "before\n\n| question | beside |" in other.read_text(encoding="utf-8")
    assert "| a question | somebody | 2 | 10 | 10 to 10 | of equal cost |\n\n![" in other.read_text(encoding="utf-8")


def test_a_question_is_asked_of_both_sides():
    measured = world.searched(world.scipy_dijkstra)(quick=True)
    assert measured.answers == "of equal cost"
    assert measured.ours.shape == measured.theirs.shape == (3,)
