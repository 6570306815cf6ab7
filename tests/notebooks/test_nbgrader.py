"""Exercises as assignments of nbgrader: points, blanks, and the marks that solutions, blanks and halves get."""

import importlib
import os
import re
import sys
from pathlib import Path

import nbformat
import pytest
from traitlets.config import Config

NOTEBOOKS = Path(__file__).parents[2] / "notebooks"
NAMES = sorted(path.stem.removesuffix("_exercises") for path in (NOTEBOOKS / "exercises").glob("*.ipynb"))
STUDENTS = {"solved": 6, "half": 3, "blank": 0}
"""How many of six exercises each has answered, from the first on."""
MARKED = {"02_pauta": ("solved", "half", "blank"), "05_astar": ("half",)}
"""Chapters with six exercises whose submissions are marked: choices, functions, numbers, a pair and a graph."""


@pytest.fixture(scope="module")
def build():
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(NOTEBOOKS)
        yield importlib.import_module("build")


@pytest.fixture(scope="module")
def course(build, tmp_path_factory):
    """The folder of a course with all exercises as assignments."""
    folder = tmp_path_factory.mktemp("course")
    build.assignments([], folder)
    return folder


@pytest.fixture
def api(course, monkeypatch):
    """nbgrader, on that course, with time for a machine that compiles for the first time."""
    apps = pytest.importorskip("nbgrader.apps")
    monkeypatch.setenv("PATH", str(Path(sys.executable).parent), prepend=os.pathsep)  # where it looks for alembic
    return apps.NbGraderAPI(config=Config({"CourseDirectory": {"root": str(course)}, "Execute": {"timeout": 300}}))


def read(path):
    return nbformat.read(path, as_version=4)


def exercises_of(folder, name):
    return read(folder / name / f"{name}_exercises.ipynb")


def graded(notebook):
    """The cells that give points."""
    return [cell for cell in notebook.cells if "nbgrader" in cell.metadata]


@pytest.mark.parametrize("name", NAMES)
def test_each_exercise_gives_a_point_a_minute(course, name):
    ours, theirs = read(NOTEBOOKS / "exercises" / f"{name}_exercises.ipynb"), exercises_of(course / "source", name)
    text = "\n\n".join(cell.source for cell in ours.cells)
    numbers = re.findall(r"^## (\d\d\.\d) ", text, re.MULTILINE)
    minutes = [int(found) for found in re.findall(r"^\*[\w -]+(?: · |, )(\d+) minutes", text, re.MULTILINE)]
    cells = graded(theirs)
    assert [cell.metadata.nbgrader.grade_id for cell in cells] == [f"exercise_{n.replace('.', '_')}" for n in numbers]
    assert [cell.metadata.nbgrader.points for cell in cells] == (minutes or len(numbers) * [20])
    assert all(cell.metadata.nbgrader.grade and cell.metadata.nbgrader.locked for cell in cells)
    for number, cell in zip(numbers, cells, strict=True):
        assert re.fullmatch(rf'from uavlab import exercises\n\nexercises\.grade\("{number}", \w+\)', cell.source)


@pytest.mark.parametrize("name", NAMES)
def test_all_else_is_as_in_our_exercises(course, name):
    ours, theirs = read(NOTEBOOKS / "exercises" / f"{name}_exercises.ipynb"), exercises_of(course / "source", name)
    for our, their in zip(ours.cells, theirs.cells, strict=True):
        assert our.cell_type == their.cell_type
        if "nbgrader" not in their.metadata:
            assert re.sub(r"\[([^\]]+)\]\(\.\./\w+\.ipynb\)", r"\1", our.source) == their.source
            assert "](../" not in their.source
            assert our.metadata == their.metadata


@pytest.mark.parametrize(
    ("names", "place", "words"),
    [
        (["99"], "", "there are no exercises of chapter '99'; there are those of 01, 02"),
        (["05", "00"], "", "there are no exercises of chapter '00'"),
        (["01_wind_and_rain", "05"], "", "source/05_astar is there already; remove it, or take another FOLDER"),
        (["05"], "gradebook.db", "FOLDER must be the folder of a course, but .*gradebook.db is a file"),
    ],
)
def test_nothing_is_written_where_something_is_wrong(build, tmp_path, names, place, words):
    (tmp_path / "source" / "05_astar").mkdir(parents=True)
    (tmp_path / "gradebook.db").touch()
    with pytest.raises(ValueError, match=words):
        build.assignments(names, tmp_path / place)
    assert sorted(path.name for path in tmp_path.rglob("*")) == ["05_astar", "gradebook.db", "source"]


def test_the_command_says_what_it_wrote_and_what_is_in_the_way(build, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("sys.argv", ["build.py", "--nbgrader", str(tmp_path), "05", "06_potential_field"])
    assert build.main() == 0
    written = [Path(line) for line in capsys.readouterr().out.splitlines()]
    assert written == sorted(tmp_path.rglob("*.ipynb"))
    assert [path.parent.name for path in written] == ["05_astar", "06_potential_field"]
    with pytest.raises(SystemExit, match=r"no assignments: .*05_astar is there already"):
        build.main()


@pytest.mark.filterwarnings("ignore:Object of type <Submitted")
def test_marks(build, course, api):
    """Full marks for solutions, none for blanks, and those of the first three for half of the answers."""
    for name, students in MARKED.items():
        assert api.generate_assignment(name)["success"]
        released, source = exercises_of(course / "release", name), exercises_of(course / "source", name)
        assert [cell.source for cell in released.cells] == [cell.source for cell in source.cells]
        points = [cell.metadata.nbgrader.points for cell in graded(source)]
        for student in students:
            answers = STUDENTS[student]
            hand_in(build, course, name, student, answers)
            done = api.autograde(name, student)
            assert done["success"], done["log"]
            marks = api.get_submission(name, student)
            assert (marks["score"], marks["max_score"]) == (sum(points[:answers]), sum(points)), student
            assert not marks["needs_manual_grade"]
    (failed,) = graded(exercises_of(course / "autograded" / "half", "05_astar"))[-1].outputs
    hint = "05.6: not yet. There is no answer yet: put yours in the place of the dots."
    assert (failed.evalue, failed.traceback) == (hint, [hint])


@pytest.mark.filterwarnings("ignore:Object of type <Submitted")
def test_what_a_student_did_to_the_cells_that_give_points_is_undone(build, course, api):
    name, student = "02_pauta", "sly"
    assert api.generate_assignment(name)["success"]
    path = hand_in(build, course, name, student, 0)
    notebook = read(path)
    first, second, *_ = graded(notebook)
    first.source = "exercises.grade('02.1', 'a right one')"
    notebook.cells.remove(second)
    notebook.cells[1].source += "\n\nclass exercises:\n    check = grade = print"
    nbformat.write(notebook, path)
    assert api.autograde(name, student)["success"]
    assert api.get_submission(name, student)["score"] == 0


def hand_in(build, course, name, student, answers):
    """A released assignment in which a student has answered so many exercises, with our solutions."""
    notebook = exercises_of(course / "release", name)
    solved = build.jupytext.read(NOTEBOOKS / "src" / "solutions" / f"{name}_exercises.py")
    cells = [cell for cell in solved.cells if "solution" not in build.tags(cell)]
    for mine, solution in zip(notebook.cells, cells, strict=True):
        if answers > 0 and "### BEGIN SOLUTION" in solution.source:
            mine.source = solution.source
        answers -= "nbgrader" in mine.metadata
    path = course / "submitted" / student / name / f"{name}_exercises.ipynb"
    path.parent.mkdir(parents=True)
    nbformat.write(notebook, path)
    return path
