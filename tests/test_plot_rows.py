"""Values in rows: intervals and runs."""

import numpy as np
import pytest

from uavlab import plot

RATES = {"A*": {"town": (3.0, 2.0, 5.0), "field": 1.0}, "REPARE": {"field": (2.0, 1.5, 4.0)}}


def entries(figure):
    return [text.get_text() for legend in figure.legends for text in legend.get_texts()]


def drawn(axes, color):
    return [line.get_xydata() for line in axes.lines if line.get_color() == color and len(line.get_xdata())]


def test_intervals_stand_in_the_row_of_their_name():
    figure = plot.intervals(RATES, "length [m]", digits=1, places={"A*": 2.5, "least": 1.25})
    (axes,) = figure.axes
    bar, mark, _, other = drawn(axes, plot.BLUE)[:4]
    assert bar[:, 0].tolist() == [2, 5]
    assert mark[0, 0] == 3
    assert other[0, 0] == 1
    assert bar[0, 1] == bar[1, 1] == mark[0, 1]
    assert round(mark[0, 1]) == 0
    assert round(other[0, 1]) == 1
    green = drawn(axes, plot.GREEN)
    assert green[0][:, 0].tolist() == [1.5, 4]
    assert green[0][0, 1] > other[0, 1]  # series of a row stand below each other
    assert [label.get_text() for label in axes.get_yticklabels()] == ["town", "field"]
    assert axes.get_ylim()[0] > axes.get_ylim()[1]  # from top to bottom
    assert axes.get_xlabel() == "length [m], with 95 % intervals"
    assert entries(figure) == ["A*", "REPARE"]
    written = {text.get_text(): text for text in axes.texts}
    assert written["3.0"].xy[0] == 5
    assert written["1.0"].xy[0] == 1
    assert written["A*"].get_color() == plot.BLUE
    assert written["least"].get_color() != plot.BLUE


def test_the_level_is_said_only_where_there_is_an_interval():
    assert plot.intervals({"a": {"b": 1.0}}, "length [m]").axes[0].get_xlabel() == "length [m]"
    figure = plot.intervals({"a": {"b": (1.0, 0.5, 2.0)}}, "length [m]", level="90 %", log=True)
    assert figure.axes[0].get_xlabel() == "length [m], with 90 % intervals, logarithmic"


def test_a_value_outside_of_its_interval_is_refused():
    with pytest.raises(ValueError, match=r"values\['a'\]\['b'\] must lie within its interval: 3, got 1 to 2"):
        plot.intervals({"a": {"b": (3.0, 1.0, 2.0)}}, "length [m]")
    with pytest.raises(ValueError, match=r"values\['a'\]\['b'\] must be a value, or \(value, low, high\)"):
        plot.intervals({"a": {"b": (3.0, 1.0)}}, "length [m]")
    with pytest.raises(ValueError, match="values must have at most 60 rows, got 61"):
        plot.intervals({"a": {str(n): 1.0 for n in range(61)}}, "length [m]")


def test_runs_show_each_and_their_median():
    values = {"PSO": {"town": [1, 2, 9, np.nan], "field": [4.0], "sea": [np.nan]}}
    figure = plot.runs(values, "gap [%]", digits=0, x_range=(0, 10))
    (axes,) = figure.axes
    ticks, median, single = drawn(axes, plot.PINK)
    assert ticks.tolist() == [[1, 0], [2, 0], [9, 0]]
    assert median.tolist() == [[2, 0]]
    assert single.tolist() == [[4, 1]]
    assert [text.get_text() for text in axes.texts] == ["2", "4"]
    assert axes.texts[0].xy == (9, 0)
    assert entries(figure) == ["PSO", "a run (the large mark: their median)"]
    assert axes.get_xlim() == (0, 10)


def test_single_values_need_no_word_on_runs():
    assert entries(plot.runs({"a": {"b": [1.0]}}, "gap [%]")) == ["a"]
