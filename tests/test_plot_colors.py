"""Colours by name: the same thing looks the same in all figures."""

import pytest

from uavlab import plot
from uavlab.plot.colors import LINES, PLANNER_COLORS, styles


def colors_of(*names, **asked):
    return [style.color for style in styles(list(names), asked or None)]


def test_planners_look_the_same_in_any_company_and_order():
    alone = {name: styles([name])[0] for name in PLANNER_COLORS}
    assert alone["A*"] == (plot.BLUE, "-")
    for names in (["mine", "A*", "REPARE"], ["REPARE", "other", "A*"], ["x", "y", "z", "A*"]):
        looks = dict(zip(names, styles(names), strict=True))
        assert looks["A*"] == alone["A*"]
        assert looks.get("REPARE", alone["REPARE"]) == alone["REPARE"]


def test_others_get_free_colours_with_their_line_styles():
    looks = styles(["a", "A*", "b", "REPARE", "c"])
    assert len({look.color for look in looks}) == 5
    assert len({str(look.line) for look in looks}) == 5
    assert all(LINES[look.color] == look.line for look in looks)


def test_what_is_asked_for_is_given_and_nobody_else_has_it():
    assert colors_of("A*", "mine", mine="#0072b2") == [plot.BLUE, plot.BLUE]  # both are said to be blue
    assert colors_of("safe", "fast", safe=plot.GREEN, fast=plot.PINK) == [plot.GREEN, plot.PINK]
    assert colors_of("other", "safe", safe="tab:red")[1] == "#D62728"
    assert styles(["safe"], {"safe": "tab:red", "not drawn": "red"})[0].line == "-"
    assert plot.GREEN not in colors_of("a", "b", "c", "d", "e", "safe", safe=plot.GREEN)[:5]


def test_a_name_that_comes_twice_is_two_things():
    first, second = colors_of("A*", "A*")
    assert first == plot.BLUE != second


def test_after_seven_they_come_again():
    assert len(LINES) == 7
    names = [f"route {number}" for number in range(16)]
    colors = colors_of(*names)
    assert len(set(colors[:7])) == 7
    assert colors[7:14] == colors[:7]
    assert styles([]) == []


def test_no_planner_has_the_colour_of_a_crash():
    assert plot.CRASH_COLOR not in [*LINES, *PLANNER_COLORS.values()]


@pytest.mark.parametrize(
    ("names", "colors", "message"),
    [
        ("A*", None, "names must be a list of texts, got 'A\\*'"),
        ([1], None, "names must be a list of texts"),
        (None, None, "names must be a list of texts"),
        (["a"], {"a": "bluish"}, r"colors\['a'\] must be a colour, such as plot.BLUE, got 'bluish'"),
        (["a"], {1: "blue"}, r"colors\[1\] must be a colour"),
        (["a"], ["blue"], "colors must be colours by name"),
    ],
)
def test_what_is_no_colour_is_refused(names, colors, message):
    with pytest.raises(ValueError, match=message):
        styles(names, colors)
