"""One thing, one colour: planners have their own, others what is asked for or what is free."""

import itertools

import pytest
from matplotlib.colors import to_rgb

from uavlab import plot
from uavlab.plot.colors import LINES, PLANNER_COLORS, Style, checked_colors


def test_a_planner_is_drawn_in_its_own_colour_whoever_is_beside_it():
    for names in (["A*"], ["mine", "A*"], ["REPARE", "A*", "mine"], ["A*", "potential field", "hazard A*"]):
        look = plot.styles(names)[names.index("A*")]
        assert look == Style(plot.BLUE, "-")
    for name, color in PLANNER_COLORS.items():
        assert plot.styles([name]) == [Style(color, LINES[color])]


def test_planners_that_are_compared_differ():
    """Those of the chapters: on a grid, of least risk, swarms."""
    for names in (
        ["A*", "potential field", "REPARE", "hazard A*", "Theta*", "A* + shortcut", "least risk"],
        ["ACO", "PSO", "PSO-BAS", "PSO-ACO", "BAS", "least risk", "A*"],
        ["least risk", "least energy", "ant colony", "A*"],
    ):
        looks = plot.styles(names)
        assert len({look.color for look in looks}) == len({look.line for look in looks}) == len(names)


def test_variants_of_a_planner_have_its_colour_where_it_is_free():
    for name, planner in {
        "A* in gusts": "A*", "REPARE, replanned": "REPARE", "A* + shortcut, windy": "A* + shortcut",
        "potential field: stuck": "potential field", "PSO-BAS (all 21)": "PSO-BAS", "PSO, printed": "PSO",
    }.items():  # fmt: skip
        assert plot.styles(["mine", name])[1].color == PLANNER_COLORS[planner]
    for name in ("A* + other", "A*-like", "PSOs", "a REPARE", "least risks", "ACOustic"):
        assert plot.styles([name])[0].color == plot.BLUE  # the first that is free
    first, exact, second = plot.styles(["A* in gusts", "A*", "REPARE, mild"])
    assert exact.color == plot.BLUE != first.color
    assert second.color == plot.GREEN
    calm, windy = plot.styles(["REPARE, calm", "REPARE, windy"])
    assert calm.color == plot.GREEN != windy.color
    assert plot.styles(["A* in gusts"], {"A* in gusts": plot.PINK, "A*": plot.SKY})[0].color == plot.PINK


def test_others_get_colours_that_are_free():
    for count in range(1, 8):
        names = [f"way {n}" for n in range(count)]
        assert len({look.color for look in plot.styles(names)}) == count
        looks = plot.styles([*names[:-1], "A*"])
        assert len({look.color for look in looks}) == count
        assert looks[-1].color == plot.BLUE
    assert {look.color for look in plot.styles([f"way {n}" for n in range(7)])} == set(LINES)


def test_after_seven_they_come_again():
    looks = plot.styles([f"way {n}" for n in range(16)])
    assert looks[7:14] == looks[:7]
    assert looks[14:] == looks[:2]
    assert plot.styles([]) == []


def test_what_is_asked_for_is_given_even_twice():
    colors = {"a": plot.GREEN, "b": "tab:red", "c": (1.0, 0.0, 0.0), "A*": "C1", "not drawn": "k"}
    looks = plot.styles(["a", "b", "c", "A*", "d"], colors)
    for name, look in zip(["a", "b", "c", "A*"], looks, strict=False):
        assert to_rgb(look.color) == pytest.approx(to_rgb(colors[name]), abs=0.002)
        assert look.color == look.color.upper()
    assert looks[0].line == LINES[plot.GREEN]
    assert looks[1].line == "-"
    assert looks[4].color not in {look.color for look in looks[:4]}
    same = plot.styles(["a", "b", "a"], dict.fromkeys("ab", plot.PINK))
    assert [look.color for look in same] == 3 * [plot.PINK]


def test_a_name_that_comes_twice_is_two_things():
    first, second, third = plot.styles(["A*", "A*", "mine"])
    assert first.color == plot.BLUE
    assert len({first, second, third}) == 3


def test_two_planners_of_one_colour_are_told_apart():
    for one, other in itertools.combinations(PLANNER_COLORS, 2):
        assert len(set(plot.styles([one, other]))) == 2, (one, other)


def test_colours_have_a_line_style_of_their_own():
    assert len(set(LINES.values())) == len(LINES) == 7
    assert set(PLANNER_COLORS.values()) <= set(LINES)


@pytest.mark.parametrize(
    ("names", "colors", "message"),
    [
        ("A*", None, "names must be a list of texts, got 'A"),
        ([1, 2], None, r"names must be a list of texts, got \[1, 2\]"),
        (None, None, "names must be a list of texts, got None"),
        ({"a"}, None, "names must be a list of texts"),
        (["a"], ["red"], "colors must be colours by name, as in"),
        (["a"], "red", "colors must be colours by name, as in .* got 'red'"),
        (["a"], {"a": "reddish"}, r"colors\['a'\] must be a colour, such as plot.BLUE, got 'reddish'"),
        (["a"], {"b": 3}, r"colors\['b'\] must be a colour, such as plot.BLUE, got 3"),
        (["a"], {1: "red"}, r"colors\[1\] must be"),
    ],
)
def test_wrong_question(names, colors, message):
    with pytest.raises(ValueError, match=message):
        plot.styles(names, colors)


def test_colours_are_checked_and_copied():
    assert checked_colors(None) == {}
    assert checked_colors({"a": "red"}) == {"a": "#FF0000"}


def test_no_planner_has_the_colour_of_a_crash():
    assert plot.CRASH_COLOR not in [*LINES, *PLANNER_COLORS.values()]
