"""Diagrams in a plane, and values and areas on the map of a city."""

import numpy as np
import pytest
from matplotlib.colors import LogNorm, to_hex, to_rgb

from uavlab import plot
from uavlab.city import table1_city


def entries(figure):
    return [text.get_text() for legend in figure.legends for text in legend.get_texts()]


def line_of(axes, label):
    (line,) = [line for line in axes.lines if line.get_label() == label]
    return line


def test_a_diagram_has_equal_scales_and_all_its_parts():
    square = [(0, 0), (2, 0), (2, 2), (0, 2)]
    figure = plot.diagram("east [m]", "north [m]", paths={"way": [(0, 3), (4, 3), (np.nan, np.nan), (0, 4), (4, 4)]},
                          areas={"house": [*square, (np.nan, np.nan), *np.add(square, 5)]},
                          arrows={"wind": [[(0, 5), (1, 5)], [(0, 6), (2, 6)]]}, points={"start": (1, 1)},
                          title="town", x_range=(-1, 9), colors={"house": plot.PINK})  # fmt: skip
    (axes,) = figure.axes
    assert axes.get_aspect() == 1
    assert axes.get_xlim() == (-1, 9)
    houses = [patch.get_extents().transformed(axes.transData.inverted()) for patch in axes.patches]
    assert [house.intervalx.tolist() for house in houses] == [pytest.approx([0, 2]), pytest.approx([5, 7])]
    assert {to_hex(patch.get_facecolor()).upper() for patch in axes.patches} == {plot.PINK}
    assert np.isnan(line_of(axes, "way").get_ydata()[2])
    assert line_of(axes, "start").get_xydata().tolist() == [[1, 1]]
    heads = [text.arrow_patch for text in axes.texts if text.arrow_patch]
    assert [text.xy for text in axes.texts] == [pytest.approx((1, 5)), pytest.approx((2, 6))]
    assert {to_hex(head.get_edgecolor()).upper() for head in heads} == {line_of(axes, "wind").get_color().upper()}
    assert sorted(entries(figure)) == ["house", "start", "way", "wind"]
    with pytest.raises(ValueError, match="there is nothing to draw"):
        plot.diagram("east [m]", "north [m]")
    with pytest.raises(ValueError, match=r"arrows\['a'\] must have shape \(\.\.\., 2, 2\)"):
        plot.diagram("east [m]", "north [m]", arrows={"a": [(0, 1, 2)]})


def test_a_map_of_values_is_the_plan_of_the_city():
    city = table1_city()
    values = np.arange(1.0, 10_001).reshape(100, 100)
    values[50, 50] = np.nan
    figure = plot.value_map(city, values, "risk [1/h]", paths={"A*": [(10, 10), (60, 40)]}, norm=LogNorm(1, 1e4),
                            points={"start": (10, 10), "goal": (60, 40)}, area=(0, 80, 10, 90),
                            title="risk")  # fmt: skip
    (axes,) = figure.axes
    bar = axes.child_axes[0]
    (image,) = axes.images
    np.testing.assert_array_equal(np.ma.filled(image.get_array(), np.nan), values.T)
    assert image.get_extent() == [0, 100, 0, 100]
    assert (axes.get_xlim(), axes.get_ylim()) == ((0, 80), (10, 90))
    assert (axes.get_xlabel(), bar.get_ylabel(), axes.get_title()) == ("x, east [m]", "risk [1/h]", "risk")
    assert isinstance(image.norm, LogNorm)
    assert line_of(axes, "A*").get_color() == plot.BLUE
    assert [line_of(axes, name).get_marker() for name in ("start", "goal")] == ["o", "^"]
    assert {line_of(axes, name).get_color() for name in ("start", "goal")} == {plot.BLACK}
    assert entries(figure) == ["A*", "start", "goal"]
    with pytest.raises(ValueError, match=r"values must have shape \(100, 100\)"):
        plot.value_map(city, values[1:], "risk [1/h]")
    with pytest.raises(ValueError, match="label must say the quantity"):
        plot.value_map(city, values, "")


def test_a_map_of_areas_shows_later_ones_above():
    city = table1_city()
    near, built = (city.clearance < 5)[:, :, 30], city.occupied[:, :, 30]
    figure = plot.area_map(city, {"near": near, "building": built}, colors={"near": plot.PINK}, notes={"here": (5, 5)})
    (axes,) = figure.axes
    first, second = axes.images
    assert (~np.ma.getmaskarray(first.get_array())).T.tolist() == near.tolist()
    assert (~np.ma.getmaskarray(second.get_array())).T.tolist() == built.tolist()
    np.testing.assert_allclose(first.cmap(0)[:3], 0.35 + 0.65 * np.array(to_rgb(plot.PINK)), atol=0.01)
    red, green, blue, _ = second.cmap(0)
    assert red == green == blue < 0.5
    assert entries(figure) == ["near", "building"]
    assert [text.get_text() for text in axes.texts] == ["here"]
    assert axes.get_xlim() == (0, 100)
    with pytest.raises(ValueError, match=r"areas\['near'\] must be True and False of shape \(100, 100\)"):
        plot.area_map(city, {"near": near[1:]})


def test_the_legend_of_areas_shows_the_colour_of_the_map():
    city = table1_city()
    everywhere = np.ones((100, 100), dtype=bool)
    areas = {"below": everywhere, "above": city.occupied[:, :, 30], "third": ~everywhere}
    figure = plot.area_map(city, areas, colors={"elsewhere": "red"})
    for patch, image in zip(figure.legends[0].legend_handles, figure.axes[0].images, strict=True):
        red, green, blue, alpha = patch.get_facecolor()
        np.testing.assert_allclose(1 - alpha * (1 - np.array([red, green, blue])), image.cmap(0)[:3], atol=0.01)
        assert image.get_alpha() is None  # nothing shines through
    shades = {to_hex(image.cmap(0)) for image in figure.axes[0].images}
    assert len(shades) == 3
    assert not any(red == green == blue for red, green, blue in map(to_rgb, shades))  # as buildings would look
