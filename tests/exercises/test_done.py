"""What is done, as saved notebooks have it."""

import json

import pytest
from solved import EXERCISES

from uavlab import exercises


def cell(number, verdict="", **other):
    outputs = [{"output_type": "execute_result", "data": {"text/plain": [f"{number}: {verdict}"]}}] if verdict else []
    return {"cell_type": "code", "source": [f'exercises.check("{number}", answer)'], "outputs": outputs, **other}


@pytest.fixture
def saved(tmp_path):
    """Write notebooks with cells into the folder, by name."""

    def save(**notebooks):
        for name, cells in notebooks.items():
            path = tmp_path / f"{name}.ipynb"
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(json.dumps({"cells": cells}), encoding="utf-8")
        return tmp_path

    return save


def test_all_exercises_are_counted(saved):
    found = exercises.progress(saved(one=[cell("05.2")]))
    assert sorted(found.untouched) == sorted(EXERCISES)
    assert (found.right, found.tried) == ((), ())
    assert repr(found).startswith(f"0 of {len(EXERCISES)} exercises are right\n01  0 of 6\n")


def test_right_tried_and_untouched_are_told_apart(saved):
    folder = saved(
        astar=[cell("05.2", "right"), cell("05.3", "not yet. Which voxels?"), cell("05.4")],
        pauta=[cell("02.2", "right"), {"cell_type": "markdown", "source": "02.3: right"}],
    )
    found = exercises.progress(str(folder))
    assert (found.right, found.tried) == (("02.2", "05.2"), ("05.3",))
    assert "05.4" in found.untouched
    assert "02.3" in found.untouched
    lines = repr(found).splitlines()
    assert any(line.startswith("02  1 of ") for line in lines)
    assert any(line.startswith("05  1 of ") and line.endswith("; not yet 05.3") for line in lines)


def test_a_right_answer_stays_right(saved):
    folder = saved(one=[cell("05.2", "right"), cell("05.2", "not yet. Too high.")], two=[cell("05.2", "not yet. No.")])
    assert exercises.progress(folder).right == ("05.2",)


def test_cells_that_give_points_count_too(saved):
    """As nbgrader has them: printed when right, an exception when not."""
    asked = {"cell_type": "code", "source": 'from uavlab import exercises\n\nexercises.grade("05.3", legal)'}
    error = {"output_type": "error", "ename": "AssertionError", "evalue": "05.3: not yet. Which voxels?"}
    right = {"output_type": "stream", "name": "stdout", "text": "05.3: right\n"}
    assert "05.3" in exercises.progress(saved(one=[asked | {"outputs": []}])).untouched
    assert exercises.progress(saved(one=[asked | {"outputs": [error]}])).tried == ("05.3",)
    assert exercises.progress(saved(one=[asked | {"outputs": [right]}])).right == ("05.3",)


def test_printed_verdicts_count_too(saved):
    printed = {"cell_type": "code", "source": "", "outputs": [{"output_type": "stream", "text": "05.2: right\n"}]}
    assert exercises.progress(saved(one=[printed])).right == ("05.2",)


def test_broken_notebooks_and_checkpoints_are_passed_over(saved):
    folder = saved(one=[cell("05.2", "right")])
    (folder / "broken.ipynb").write_text('{"cells": [', encoding="utf-8")
    (folder / "list.ipynb").write_text("[]", encoding="utf-8")
    (folder / ".ipynb_checkpoints").mkdir()
    (folder / ".ipynb_checkpoints" / "two.ipynb").write_text(json.dumps({"cells": [cell("05.3", "right")]}))
    assert exercises.progress(folder).right == ("05.2",)


def test_a_folder_without_exercises_is_refused(tmp_path):
    with pytest.raises(ValueError, match="folder must hold notebooks with exercises, such as notebooks/exercises"):
        exercises.progress(tmp_path)
    with pytest.raises(ValueError, match=r"folder must be a folder with exercise notebooks, got .*nowhere"):
        exercises.progress(tmp_path / "nowhere")
    with pytest.raises((ValueError, TypeError), match="folder"):
        exercises.progress(3)


def test_the_course_s_own_folder(request):
    found = exercises.progress(request.config.rootpath / "notebooks" / "exercises")
    assert len(found.right) + len(found.tried) + len(found.untouched) == len(EXERCISES)
    assert not found.right
