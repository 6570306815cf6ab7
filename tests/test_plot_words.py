"""Alternative texts: what a figure shows is in its words, and changes with it; pictures are small and carry them."""

import base64
import io
import pickle
import re

import matplotlib.pyplot as plt
import numpy as np
import pytest
from PIL import Image, ImageColor

from uavlab import plot
from uavlab.planners import astar, repare
from uavlab.plot.pictures import Picture, png_of, quantised
from uavlab.risk import reference_campus
from uavlab.route import Route


def named(text):
    """Names in an alternative text, each with its colour and the rest of its look."""
    return {name: look.split(", ") for name, look in re.findall(r'"([^"]*)" \(([^)]*)\)', text)}


@pytest.fixture(scope="module")
def ways(table1):
    ends = (90, 18, 30), (50, 44, 30)
    return {"A*": astar(table1, *ends), "REPARE": repare(table1, *ends)}


def test_a_plan_names_its_routes_with_their_colours_and_ends(table1, ways):
    text = plot.alt_text(plot.plan(table1, ways))
    looks = named(text)
    assert looks[f"A*, {ways['A*'].length:.1f} m"] == ["blue", "solid"]
    assert looks[f"REPARE, {ways['REPARE'].length:.1f} m"] == ["green", "dash-dot-dotted"]
    assert looks["start"] == ["black", "discs"]
    assert "The city of REPARE Table 1" in text
    assert 'map, across "x, east [m]" from 0 to 100' in text
    assert 'colours: "top of the buildings above the ground [m]" from 0 to' in text
    assert "from (90.5, 18.5) to (50.5, 44.5)" in text


def test_a_name_has_one_colour_in_plan_profile_and_scene(table1, ways):
    for figure in (
        plot.plan(table1, ways),
        plot.profile(table1, ways),
        plot.profile(table1, dict(reversed(ways.items()))),
    ):
        colors = {name.split(",")[0]: look[:2] for name, look in named(plot.alt_text(figure)).items()}
        assert colors["A*"] == ["blue", "solid"]
        assert colors["REPARE"] == ["green", "dash-dot-dotted"]


def test_lines_say_where_they_begin_and_end_and_what_they_reach():
    x = np.linspace(0, 10, 101)
    text = plot.alt_text(plot.lines(x, {"wave": 5 * np.sin(x)}, "time [s]", "offset [m]", log=""))
    assert '"wave" (blue, solid) from (0, 0) to (10, -2.72), least -5 at 4.7, most 5 at ' in text
    assert 'across "time [s]" from' in text
    other = plot.alt_text(plot.lines(x, {"wave": 4 * np.sin(x)}, "time [s]", "offset [m]"))
    assert "most 4 at" in other
    assert "logarithmic" in plot.alt_text(plot.lines(x[1:], {"a": x[1:]}, "time [s]", "offset [m]", log="y"))


def test_bars_say_each_value():
    assert (
        plot.alt_text(plot.bars({"a": 1.5, "b": 1234.0}, "n [1]", title="T")) == 'T: Bars over "n [1]": a 1.5, b 1,234.'
    )


def test_several_panels_are_counted_and_long_texts_end_in_time():
    campus = reference_campus()
    text = plot.alt_text(plot.layers(campus))
    assert text.startswith("3 panels. ")
    assert "thousands of people per km²" in text
    figure, panels = plot.new_panels(2, 4)
    for axes in panels:
        plot.lines([0, 1], {f"line {n}": [n, n] for n in range(7)}, "a [1]", "b [1]", axes=axes)
    text = plot.alt_text(figure)
    assert len(text) <= 1200
    assert text.endswith("and more.")


@pytest.mark.parametrize("label", ["$p_s$ \\$5", 'a "quoted" one', "two\nlines", "\u200b_x"])
def test_texts_have_no_markup(label):
    figure, axes = plot.new_figure(4, 3)
    axes.plot([0, 1], [0, 1], label=label)
    axes.set_xlabel(label)
    text = plot.alt_text(plot.finished(figure))
    assert not re.search(r"[\\\n\u200b{}]", text)
    assert text.count('"') % 2 == 0


def test_figures_of_anybody_have_words():
    figure, axes = plt.subplots()
    axes.fill_between([0, 1], [1, 2], color="red", label="area")
    axes.hlines([1, 2], 0, 1, label="level")
    axes.scatter([1, 2, 3], [1, 2, 3], label="cloud")
    axes.annotate("note", (0, 0))
    axes.pie([1, 2])
    text = plot.alt_text(figure)
    plt.close(figure)
    assert named(text)["area"] == ["red"]
    assert '"cloud" (blue): 3 points' in text
    with pytest.raises(ValueError, match="figure must be a Figure, got int"):
        plot.alt_text(3)
    assert plot.alt_text(plt.Figure()) == "."


def test_a_finished_figure_brings_its_words_into_a_notebook():
    figure = plt.figure(figsize=(4, 3))
    figure.subplots().plot([1, 2], label="a way")
    shown = plot.finished(figure)
    assert shown is figure
    data, metadata = shown._repr_mimebundle_()
    assert metadata == {"image/png": {"alt": plot.alt_text(figure)}}
    assert base64.b64decode(data["image/png"]).startswith(b"\x89PNG")
    again = pickle.loads(pickle.dumps(shown))
    assert isinstance(again, Picture)
    assert plot.alt_text(again) == plot.alt_text(shown)


def test_a_picture_with_a_palette_is_smaller_looks_the_same_and_stays_as_it_is(table1):
    figure = plot.section(table1, 30.0)
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=100)
    small = quantised(buffer.getvalue())
    assert len(small) < 0.6 * len(buffer.getvalue())
    assert quantised(small) == small
    assert png_of(plot.section(table1, 30.0), 100) == png_of(plot.section(table1, 30.0), 100)
    pictures = [
        np.asarray(Image.open(io.BytesIO(png)).convert("RGB"), dtype=float) for png in (buffer.getvalue(), small)
    ]
    assert np.abs(pictures[0] - pictures[1]).mean() < 2
    assert np.quantile(np.abs(pictures[0] - pictures[1]), 0.99) < 25


def test_a_palette_keeps_the_colours_of_lines_apart_on_a_map(table1):
    ways = {name: Route(np.array([[5.0, y, 30], [95.0, y, 30]])) for name, y in (("one", 10.0), ("two", 62.0))}
    colors = {"one": plot.BLUE, "two": plot.GREEN}
    picture = png_of(plot.section(table1, 30.0, None, ways, colors=colors), 100)
    pixels = np.asarray(Image.open(io.BytesIO(picture)).convert("RGB")).reshape(-1, 3)
    for color in colors.values():
        assert (pixels == np.array(ImageColor.getrgb(color))).all(axis=1).sum() > 300
