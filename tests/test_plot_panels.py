"""What kinds of figures share: panels, colours across them, one legend, notes that touch nothing."""

import matplotlib.pyplot as plt
import numpy as np
import pytest

from uavlab import plot

X = np.linspace(0, 10, 101)


def entries(figure):
    return [text.get_text() for legend in figure.legends for text in legend.get_texts()]


def test_panels_come_row_by_row_and_share_their_labels():
    figure, panels = plot.new_panels(2, 2, width=8, height=6, share="xy")
    for number, axes in enumerate(panels):
        plot.lines(X, {"a": X}, "x [m]", "y [m]", title=str(number), axes=axes)
    assert panels == figure.axes
    assert figure.get_size_inches().tolist() == [8, 6]
    assert [axes.get_xlabel() for axes in panels] == ["", "", "x [m]", "x [m]"]
    assert [axes.get_ylabel() for axes in panels] == ["y [m]", "", "y [m]", ""]


def test_panels_that_share_nothing_keep_their_labels():
    _, panels = plot.new_panels(1, 2)
    for axes, label in zip(panels, ("a [m]", "b [s]"), strict=True):
        plot.lines(X, {"a": X}, "x [m]", label, axes=axes)
    assert [axes.get_ylabel() for axes in panels] == ["a [m]", "b [s]"]


def test_a_name_has_one_colour_and_one_entry_in_all_panels():
    figure, (left, right) = plot.new_panels(1, 2)
    plot.lines(X, {"a": X, "b": 2 * X}, "x [m]", "y [m]", bands={"b": (0, X)}, band_label="95 %", axes=left)
    assert plot.lines(X, {"c": 3 * X, "b": X}, "x [m]", "y [m]", axes=right) is figure
    colors = {line.get_label(): line.get_color() for axes in (left, right) for line in axes.lines}
    assert [colors[name] for name in "abc"] == [plot.BLUE, plot.ORANGE, plot.BLACK]
    assert {line.get_color() for line in right.lines if line.get_label() == "b"} == {plot.ORANGE}
    assert entries(figure) == ["a", "b", "band: 95 %", "c"]
    assert len(figure.legends) == 1


def test_colors_that_are_asked_for_win():
    _, (left, right) = plot.new_panels(1, 2)
    plot.lines(X, {"a": X}, "x [m]", "y [m]", axes=left)
    plot.lines(X, {"a": X}, "x [m]", "y [m]", axes=right, colors={"a": plot.GREEN})
    assert right.lines[0].get_color() == plot.GREEN


def test_areas_keep_their_colour_across_panels():
    _, (left, right) = plot.new_panels(1, 2)
    plot.lines(X, {}, "x [m]", "y [m]", bands={"free": (0, X)}, colors={"free": plot.PINK}, axes=left)
    plot.lines(X, {"free": X, "b": X}, "x [m]", "y [m]", axes=right)
    assert [line.get_color() for line in right.lines] == [plot.PINK, plot.BLUE]


def test_the_legend_covers_no_panel():
    figure, panels = plot.new_panels(1, 2)
    for axes in panels:
        plot.lines(X, {f"a rather long name of number {n}": n * X for n in range(6)}, "x [m]", "y [m]", axes=axes)
    figure.draw_without_rendering()
    box = figure.legends[0].get_window_extent()
    assert not any(box.overlaps(axes.get_tightbbox()) for axes in panels)
    assert figure.bbox.x0 <= box.x0
    assert box.x1 <= figure.bbox.x1


def test_a_panel_of_another_layout_gets_room_for_the_legend():
    figure, axes = plt.subplots()
    plot.lines(X, {"a": X}, "x [m]", "y [m]", axes=axes)
    figure.draw_without_rendering()
    assert not figure.legends[0].get_window_extent().overlaps(axes.get_tightbbox())


def test_no_figure_stays_behind():
    before = plt.get_fignums()
    plot.new_panels(1, 2)
    plot.lines(X, {"a": X}, "x [m]", "y [m]")
    with pytest.raises(ValueError, match="y_label"):
        plot.lines(X, {"a": X}, "x [m]", "")
    with pytest.raises(ValueError, match="notes"):
        plot.points({"a": [(1, 1)]}, "x [m]", "y [m]", notes={"a": 3})
    assert plt.get_fignums() == before


def test_too_many_panels_are_refused():
    with pytest.raises(ValueError, match="rows × columns must be at most 40"):
        plot.new_panels(7, 6)


def test_notes_touch_no_line_no_mark_and_no_other_note():
    lines = {"a": X, "b": 10 - X, "c": 5 + 0 * X}
    spots = {f"note {n}": (5 + 0.3 * n, 5) for n in range(6)}
    figure = plot.lines(X, lines, "x [m]", "y [m]", points={"here": list(spots.values())}, notes=spots)
    figure.draw_without_rendering()
    (axes,) = figure.axes
    boxes = [plt.Text.get_window_extent(note) for note in axes.texts]
    paths = [line.get_path().transformed(line.get_transform()) for line in axes.lines]
    inside = axes.get_window_extent()
    assert len(boxes) == 6
    for number, (note, box) in enumerate(zip(axes.texts, boxes, strict=True)):
        assert note.get_text() == f"note {number}"
        assert note.xy == pytest.approx(spots[note.get_text()])
        assert not box.count_overlaps(boxes[:number])
        assert not any(path.intersects_bbox(box, filled=False) for path in paths)
        assert inside.x0 < box.x0 < box.x1 < inside.x1
        assert inside.y0 < box.y0 < box.y1 < inside.y1


def test_a_line_leads_to_a_note_that_is_far_only():
    axes = plot.points({"a": [(1, 1), (9, 9)]}, "x [m]", "y [m]", notes={"free": (5, 5)}).axes[0]
    assert not axes.texts[0].arrow_patch.get_visible()
    around = np.column_stack([np.tile([4.2, 5.8], 20), np.linspace(4.2, 5.8, 40)])
    axes = plot.diagram(
        "x [m]", "y [m]", paths={"full": around, "far": [(0, 0), (10, 10.1)]}, notes={"x": (5, 5)}
    ).axes[0]
    assert axes.texts[0].arrow_patch.get_visible()
