"""Heat maps and matrices."""

import numpy as np
import pytest
from matplotlib.colors import LogNorm, Normalize

from uavlab import plot

LOAD, RAIN = np.linspace(0, 1, 11), np.linspace(0, 300, 31)
WIND = 1 + LOAD[:, None] + 0.01 * RAIN
LABELS = "load [kg]", "rain [mm/h]", "wind [m/s]"


def entries(figure):
    return [text.get_text() for legend in figure.legends for text in legend.get_texts()]


def test_a_heat_map_has_its_values_where_they_belong():
    figure = plot.heat_map(LOAD, RAIN, WIND, *LABELS, contours=[3, 2], title="limits", norm=LogNorm(1, 5))
    (axes,) = figure.axes
    bar = axes.child_axes[0]
    mesh = axes.collections[0]
    np.testing.assert_array_equal(np.asarray(mesh.get_array()).reshape(31, 11), WIND.T)
    assert isinstance(mesh.norm, LogNorm)
    assert (axes.get_xlabel(), axes.get_ylabel(), bar.get_ylabel(), axes.get_title()) == (*LABELS, "limits")
    assert axes.get_xlim() == (0, 1)
    assert axes.get_ylim() == (0, 300)
    assert axes.get_aspect() == "auto"
    assert axes.collections[1].levels.tolist() == [2, 3]
    assert {text.get_text() for text in axes.texts} == {"2", "3"}


def test_a_heat_map_has_marks_paths_and_hatched_regions():
    heavy = WIND > 3.5
    figure = plot.heat_map(LOAD, RAIN, np.where(heavy, np.nan, WIND), *LABELS, hatched={"grounded": heavy}, equal=True,
                           paths={"way": [(0, 0), (1, 300)]}, points={"now": (0.5, 20)}, notes={"here": (0.5, 20)},
                           colors={"now": plot.PINK})  # fmt: skip
    (axes,) = figure.axes
    assert sorted(entries(figure)) == ["grounded", "now", "way"]
    (way,) = [line for line in axes.lines if line.get_label() == "way"]
    assert way.get_xydata().tolist() == [[0, 0], [1, 300]]
    assert way.get_path_effects()  # a white rim
    (now,) = [line for line in axes.lines if line.get_label() == "now"]
    assert (now.get_xydata().tolist(), now.get_color()) == ([[0.5, 20]], plot.PINK)
    assert [text.get_text() for text in axes.texts] == ["here"]
    assert axes.get_aspect() == 1
    hatched = axes.collections[1]
    assert hatched.hatches == ["///"]
    low = hatched.get_paths()[0].get_extents()
    assert low.y0 == pytest.approx(300 * 0.5, abs=15)  # 1 + 1 + 0.01 · 150 = 3.5


def test_a_heat_map_needs_rising_axes_and_masks():
    with pytest.raises(ValueError, match="x must be at least two numbers, each above the one before"):
        plot.heat_map(LOAD[::-1], RAIN, WIND, *LABELS)
    with pytest.raises(ValueError, match=r"values must have shape \(11, 31\), got \(31, 11\)"):
        plot.heat_map(LOAD, RAIN, WIND.T, *LABELS)
    with pytest.raises(ValueError, match=r"hatched\['a'\] must be True and False of shape \(11, 31\), got float64"):
        plot.heat_map(LOAD, RAIN, WIND, *LABELS, hatched={"a": WIND})
    with pytest.raises(ValueError, match="contours must differ"):
        plot.heat_map(LOAD, RAIN, WIND, *LABELS, contours=[2, 2])


def test_a_matrix_writes_values_on_colours_of_shares():
    counts = [[30, 10], [5, 1995]]
    figure = plot.matrix(counts, ["1", "2"], ["a", "b"], "true", "said", "share", shares=True, title="classes")
    (axes,) = figure.axes
    bar = axes.child_axes[0]
    assert [(text.get_text(), text.get_position()) for text in axes.texts] == [
        ("30", (0, 0)), ("10", (1, 0)), ("5", (0, 1)), ("1,995", (1, 1)),
    ]  # fmt: skip
    np.testing.assert_allclose(axes.images[0].get_array(), [[0.75, 0.25], [0.0025, 0.9975]])
    assert axes.images[0].get_clim() == (0, 1)
    assert [text.get_color() for text in axes.texts] == [
        "black",
        "white",
        "white",
        "black",
    ]  # to be read on their colour
    assert [label.get_text() for label in axes.get_yticklabels()] == ["1", "2"]
    assert [label.get_text() for label in axes.get_xticklabels()] == ["a", "b"]
    assert (axes.get_xlabel(), axes.get_ylabel(), bar.get_ylabel()) == ("said", "true", "share")
    assert axes.get_ylim()[0] > axes.get_ylim()[1]  # the first row is the uppermost


def test_a_matrix_colours_values_by_its_norm():
    figure = plot.matrix(
        [[1.25, np.nan]], ["r"], ["a", "b"], "row", "column", "left [m]", digits=1, norm=Normalize(0, 5)
    )
    axes = figure.axes[0]
    assert [text.get_text() for text in axes.texts] == ["1.2"]
    assert axes.images[0].get_clim() == (0, 5)
    with pytest.raises(ValueError, match="values must be at least 0, with a sum above 0"):
        plot.matrix([[0, 0], [1, 2]], ["r", "s"], ["a", "b"], "row", "column", "share", shares=True)
    with pytest.raises(ValueError, match="columns must differ"):
        plot.matrix([[1, 2]], ["r"], ["a", "a"], "row", "column", "share")
    with pytest.raises(ValueError, match="values must be at most 2,500 cells"):
        plot.matrix(np.ones((51, 50)), [str(n) for n in range(51)], [str(n) for n in range(50)], "r", "c", "value")


def test_panels_of_one_row_and_norm_share_a_colour_bar():
    _, panels = plot.new_panels(2, 3)
    norm = Normalize(0, 5)
    for number, axes in enumerate(panels):
        scale = Normalize(0, 5) if number == 3 else norm
        plot.matrix([[1.0, 2.0]], ["r"], ["a", "b"], "row", "column", "left [m]", norm=scale, axes=axes)
    assert [len(axes.child_axes) for axes in panels] == [0, 0, 1, 1, 0, 1]


def test_panels_with_other_labels_keep_their_colour_bars():
    _, panels = plot.new_panels(1, 2)
    norm = Normalize(0, 5)
    for axes, label in zip(panels, ("left [m]", "right [m]"), strict=True):
        plot.heat_map(LOAD, RAIN, WIND, *LABELS[:2], label, norm=norm, axes=axes)
    assert [len(axes.child_axes) for axes in panels] == [1, 1]
