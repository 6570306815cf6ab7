"""Lines and points: what is drawn where, in which colour, and how it is told apart."""

import numpy as np
import pytest
from matplotlib.colors import to_hex

from uavlab import plot
from uavlab.plot.series import CLOUD, ROUGH_WIDTH, WIDTH

X = np.linspace(1, 10, 91)


def line_of(axes, label):
    (line,) = [line for line in axes.lines if line.get_label() == label]
    return line


def entries(figure):
    return [text.get_text() for legend in figure.legends for text in legend.get_texts()]


def texts(axes):
    return [text.get_text() for text in axes.texts]


def test_lines_show_the_data_in_their_own_colours():
    figure = plot.lines(X, {"A*": X, "other": 2 * X}, "wind [m/s]", "offset [m]", title="gusts")
    (axes,) = figure.axes
    for name, y in (("A*", X), ("other", 2 * X)):
        np.testing.assert_array_equal(line_of(axes, name).get_xydata(), np.column_stack([X, y]))
    assert line_of(axes, "A*").get_color() == plot.BLUE  # as in all figures
    assert line_of(axes, "other").get_color() == plot.ORANGE
    assert line_of(axes, "other").get_linestyle() == "--"
    assert (axes.get_xlabel(), axes.get_ylabel(), axes.get_title()) == ("wind [m/s]", "offset [m]", "gusts")
    assert entries(figure) == ["A*", "other"]
    assert axes.get_xlim() == (1, 10)


def test_colors_are_as_asked_for():
    figure = plot.lines(X, {"a": X, "b": X**2}, "x [m]", "y [m]", colors={"b": "green", "elsewhere": "red"})
    assert line_of(figure.axes[0], "b").get_color() == to_hex("green").upper()


def test_a_line_below_another_is_wider_and_the_upper_one_dashed():
    shown = {"below": X, "above": X + 1e-4, "elsewhere": 20 - X}
    axes = plot.lines(X, shown, "x [m]", "y [m]", colors={"below": "#111111", "above": "#222222"}).axes[0]
    below, above, elsewhere = (line_of(axes, name) for name in shown)
    assert below.get_linewidth() > above.get_linewidth() + 1 > elsewhere.get_linewidth() + 0.9
    assert below.get_alpha() < 1 == above.get_alpha()
    assert (below.get_linestyle(), above.get_linestyle()) == ("-", "--")  # both have no line style of their own
    assert elsewhere.get_linewidth() == WIDTH


def test_three_lines_on_each_other_have_three_widths():
    axes = plot.lines(X, {"a": X, "b": X, "c": X}, "x [m]", "y [m]").axes[0]
    a, b, c = (line_of(axes, name).get_linewidth() for name in "abc")
    assert a > b + 1 > c + 2


def test_tails_near_zero_are_not_lines_on_each_other():
    x = np.linspace(-8, 8, 201)
    bells = {"a": np.exp(-(x**2)), "b": np.exp(-((x - 1) ** 2))}
    axes = plot.lines(x, bells, "x [m]", "y [1/m]").axes[0]
    assert {line_of(axes, name).get_linewidth() for name in "ab"} == {WIDTH}


def test_what_lies_outside_of_the_axis_tells_no_lines_apart():
    x = np.linspace(0, 12, 200)
    tails = {"a": np.exp(-(x**2)), "b": 4 * np.exp(-(x**2))}  # a hundredth of 60 decades is more than their distance
    axes = plot.lines(x, tails, "x [m]", "y [1/m]", log="y", y_range=(1e-3, 10)).axes[0]
    assert {line_of(axes, name).get_linewidth() for name in "ab"} == {WIDTH}
    everything = plot.lines(x, tails, "x [m]", "y [1/m]", log="y").axes[0]
    assert line_of(everything, "a").get_linewidth() > WIDTH


def test_on_a_logarithmic_axis_lines_lie_apart_by_their_ratio():
    shown = {
        "a": np.geomspace(1, 1e6, len(X)),
        "b": np.geomspace(4, 4e6, len(X)),
    }  # 1 % of 10⁶ is more than most of them
    linear, logarithmic = (plot.lines(X, shown, "x [m]", "y [m]", log=log).axes[0] for log in ("", "y"))
    assert line_of(logarithmic, "a").get_linewidth() == WIDTH
    assert logarithmic.get_ylabel() == "y [m], logarithmic"
    assert (logarithmic.get_xscale(), logarithmic.get_yscale()) == ("linear", "log")
    assert linear.get_yscale() == "linear"


def test_noise_is_thin_and_solid():
    noise = np.random.default_rng(0).normal(size=400)
    axes = plot.lines(np.arange(400), {"a": noise, "b": noise - 9}, "time [s]", "offset [m]").axes[0]
    assert {(line.get_linestyle(), line.get_linewidth()) for line in axes.lines} == {("-", ROUGH_WIDTH)}


def test_gaps_stay_gaps():
    y = X.copy()
    y[40] = np.nan
    axes = plot.lines(X, {"a": y}, "x [m]", "y [m]").axes[0]
    assert np.isnan(line_of(axes, "a").get_ydata()[40])
    with pytest.raises(ValueError, match=r"series\['a'\] must be finite, or NaN for a gap"):
        plot.lines(X, {"a": np.where(np.isnan(y), np.inf, y)}, "x [m]", "y [m]")


def test_what_a_series_lacks_is_named():
    with pytest.raises(ValueError, match=r"series\['b'\] must have shape \(91,\), got \(90,\)"):
        plot.lines(X, {"a": X, "b": X[1:]}, "x [m]", "y [m]")
    with pytest.raises(ValueError, match="series must be at most 7"):
        plot.lines(X, {str(n): X + n for n in range(8)}, "x [m]", "y [m]")
    with pytest.raises(ValueError, match="x_label must say the quantity and its unit"):
        plot.lines(X, {"a": X}, "  ", "y [m]")


def test_limits_stand_beside_the_panel_and_spans_are_shaded():
    limits = {"most": 8, "usual": (2, 3), "far": 99}
    figure = plot.lines(X, {"a": X}, "x [m]", "y [m]", limits=limits, places={"here": 4}, y_range=(0, 12),
                        colors={"most": plot.PINK})  # fmt: skip
    (axes,) = figure.axes
    most, here, far = axes.lines[1], axes.lines[3], axes.lines[2]
    assert list(most.get_ydata()) == [8, 8]
    assert most.get_color() == plot.PINK
    assert list(here.get_xdata()) == [4, 4]
    assert list(far.get_ydata()) == [99, 99]
    (span,) = axes.patches
    assert span.get_extents().transformed(axes.transData.inverted()).intervaly == pytest.approx((2, 3))
    assert texts(axes) == ["usual", "most", "here"]  # "far" is out of sight
    assert [text.xy for text in axes.texts] == [
        (1.0, pytest.approx(2.5)),
        (1.0, pytest.approx(8)),
        (pytest.approx(4), 1.0),
    ]
    assert axes.texts[1].get_color() == plot.PINK
    assert "most" not in entries(figure)


def test_names_of_limits_do_not_lie_on_each_other():
    limits, places = {"one": 5.0, "two": 5.1, "three": 5.2}, {"a long name": 5.0, "another long name": 5.2, "far": 9.5}
    figure = plot.lines(X, {"a": X}, "x [m]", "y [m]", limits=limits, places=places, title="a title")
    figure.draw_without_rendering()
    (axes,) = figure.axes
    boxes = [text.get_window_extent() for text in (*axes.texts, axes.title)]
    for number, box in enumerate(boxes):
        assert not box.padded(-1).count_overlaps(boxes[:number])
        assert not box.padded(-1).overlaps(axes.get_window_extent())
    assert len({round(text.get_window_extent().y0) for text in axes.texts[3:]}) == 2  # "far" needs no row of its own


def test_bands_have_the_colour_of_their_line_and_say_what_they_are():
    figure = plot.lines(X, {"a": X}, "x [m]", "y [m]", bands={"a": (X - 1, X + 1), "alone": (0, X / 2)},
                        band_label="quartiles")  # fmt: skip
    (axes,) = figure.axes
    first, alone, _ = axes.collections
    assert to_hex(first.get_facecolor()[0]).upper() == line_of(axes, "a").get_color() == plot.BLUE
    assert first.get_paths()[0].get_extents().intervaly == pytest.approx((0, 11))
    assert alone.get_paths()[0].get_extents().intervaly == pytest.approx((0, 5))
    assert sorted(entries(figure)) == ["a", "alone", "band: quartiles"]
    with pytest.raises(ValueError, match="band_label must say what the bands of a are"):
        plot.lines(X, {"a": X}, "x [m]", "y [m]", bands={"a": (X - 1, X + 1)})
    with pytest.raises(ValueError, match="band_label is of bands that have the name of a line"):
        plot.lines(X, {"a": X}, "x [m]", "y [m]", band_label="95 %")
    with pytest.raises(ValueError, match=r"bands\['a'\] must have its lower end below"):
        plot.lines(X, {}, "x [m]", "y [m]", bands={"a": (X + 1, X - 1)})
    with pytest.raises(ValueError, match=r"bands\['a'\] must have its lower end below its upper one, got 10 as lower"):
        plot.lines(X, {}, "x [m]", "y [m]", bands={"a": (X, 9.95)})  # of which one alone crosses
    with pytest.raises(ValueError, match=r"bands\['a'\] must be its lower and its upper end, got 3"):
        plot.lines(X, {}, "x [m]", "y [m]", bands={"a": (1, 2, 3)})


def test_points_on_lines_have_their_colour_and_one_entry():
    figure = plot.lines(X, {"a": X}, "x [m]", "y [m]", points={"a": [(2, 2), (3, 4)], "b": (5, 5)}, point_label="flown")
    (axes,) = figure.axes
    marks = [line for line in axes.lines if line.get_linestyle() == "None" and len(line.get_xdata())]
    assert [to_hex(mark.get_color()).upper() for mark in marks] == [plot.BLUE, plot.ORANGE]
    assert [mark.get_marker() for mark in marks] == ["o", "^"]
    assert marks[0].get_xydata().tolist() == [[2, 2], [3, 4]]
    assert sorted(entries(figure)) == ["a", "b", "flown"]
    with pytest.raises(ValueError, match="point_label must say what the points of a are"):
        plot.lines(X, {"a": X}, "x [m]", "y [m]", points={"a": (2, 2)})


def test_steps_hold_halfway_to_the_neighbours():
    axes = plot.lines(X, {"a": X}, "x [m]", "y [m]", bands={"b": (0, X)}, steps=True).axes[0]
    assert line_of(axes, "a").get_drawstyle() == "steps-mid"
    assert len(axes.collections[0].get_paths()[0].vertices) > 3 * len(X)


@pytest.mark.parametrize(("y", "bottom"), [(X, 0.0), (X + 90, None), (X - 5, None)])
def test_an_axis_begins_at_zero_if_that_is_near(y, bottom):
    low, high = plot.lines(X, {"a": y}, "x [m]", "y [m]").axes[0].get_ylim()
    assert high > y.max()
    assert low == bottom if bottom is not None else low != 0 and low < y.min()


def test_ranges_are_ends_of_the_axes():
    axes = plot.lines(X, {"a": X}, "x [m]", "y [m]", x_range=(2, None), y_range=(-1, 20)).axes[0]
    assert axes.get_xlim() == (2, 10)
    assert axes.get_ylim() == (-1, 20)
    with pytest.raises(ValueError, match="y_range must go from less to more"):
        plot.lines(X, {"a": X}, "x [m]", "y [m]", y_range=(3, 3))
    with pytest.raises(ValueError, match="x_range must be above 0 on a logarithmic axis"):
        plot.lines(X, {"a": X}, "x [m]", "y [m]", x_range=(0, 3), log="x")


def test_a_logarithmic_axis_has_plain_numbers_also_between_powers():
    few, many = (plot.lines(X, {"a": y}, "x [m]", "y [m]", log="y") for y in (X * 30, X**6))
    shown = []
    for figure in (few, many):
        figure.draw_without_rendering()
        low, high = figure.axes[0].get_ylim()
        ticks = zip(figure.axes[0].get_yticks(), figure.axes[0].get_yticklabels(), strict=True)
        shown.append([label.get_text() for tick, label in ticks if low <= tick <= high])
    assert shown[0] == ["50", "100", "200"]
    assert shown[1] == ["1", "10", "100", "1,000", "10,000", "100,000", "1,000,000"] or "$" in shown[1][0]


def test_a_logarithmic_axis_of_small_numbers_writes_all_its_ticks():
    axis = plot.lines(X, {"a": X * 3e-6}, "x [m]", "risk [1/h]", log="y").axes[0].yaxis
    axis.figure.draw_without_rendering()
    low, high = axis.get_view_interval()
    ticks = zip(axis.get_ticklocs(), axis.get_ticklabels(), strict=True)
    shown = [label.get_text() for tick, label in ticks if low <= tick <= high]
    assert len(shown) >= 3
    assert all(shown)


def test_points_by_group():
    groups = {"A*": [(1, 2), (3, np.nan)], "many": np.ones((CLOUD, 2)), "third": (2, 2)}
    figure = plot.points(groups, "length [m]", "risk [1/h]", notes={"best": (1, 2)}, limits={"most": 3}, log="x")
    (axes,) = figure.axes
    first, cloud, entry, third = axes.lines[:4]
    assert first.get_label() == "A*"
    assert first.get_xydata()[0].tolist() == [1, 2]
    assert (cloud.get_marker(), cloud.get_alpha() < 1) == (".", True)
    assert (entry.get_label(), len(entry.get_xdata())) == ("many", 0)
    assert (first.get_marker(), third.get_marker()) == ("o", "s")
    assert (axes.get_xlabel(), axes.get_xscale()) == ("length [m], logarithmic", "log")
    assert texts(axes) == ["most", "best"]
    with pytest.raises(ValueError, match=r"groups\['a'\] must have shape \(N, 2\)"):
        plot.points({"a": [(1, 2, 3)]}, "x [m]", "y [m]")
