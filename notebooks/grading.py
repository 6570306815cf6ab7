"""Exercises as assignments of nbgrader: the same blanks, and checks that give points.

nbgrader takes what lies in `source/<assignment>/`. Before it marks, it puts the cells that give points back as they
were; one that ends with an exception gives none.
"""

import re
from collections.abc import Mapping
from pathlib import Path

import nbformat
from nbformat import NotebookNode

CHECK = re.compile(r'exercises\.check\("(\d\d\.\d+)", (\w+)\)')
NEIGHBOUR = re.compile(r"\[([^\]]+)\]\(\.\./[^)]+\)")
"""A link to the chapter, which students don't have beside their assignment."""


def write_assignments(exercises: Mapping[str, NotebookNode], points: Mapping[str, int], course: Path) -> list[Path]:
    """Write exercise notebooks, by name, into the folder of a course of nbgrader, each as an assignment of its own.

    Raises
    ------
    ValueError
        If the course is a file, or has one of the assignments already: nothing is overwritten.
    """
    paths = {
        course / "source" / name.removesuffix("_exercises") / f"{name}.ipynb": notebook
        for name, notebook in exercises.items()
    }
    for place in (course, course / "source"):
        if place.exists() and not place.is_dir():
            raise ValueError(f"FOLDER must be the folder of a course, but {place} is a file")
    for path in paths:
        if path.parent.exists():
            raise ValueError(f"{path.parent} is there already; remove it, or take another FOLDER")
    for path, notebook in paths.items():
        path.parent.mkdir(parents=True)
        path.write_text(nbformat.writes(assignment(notebook, points)) + "\n", encoding="utf-8")
    return list(paths)


def assignment(exercises: NotebookNode, points: Mapping[str, int]) -> NotebookNode:
    """An exercise notebook in which each check gives the points of its exercise."""
    for cell in exercises.cells:
        if cell.cell_type == "markdown":
            cell.source = NEIGHBOUR.sub(r"\1", cell.source)
        elif found := CHECK.fullmatch(cell.source):
            number, answer = found.groups()
            # imported once more: a student may have given the name to something else
            cell.source = f'from uavlab import exercises\n\nexercises.grade("{number}", {answer})'
            cell.metadata = nbformat.from_dict(
                {"tags": ["raises-exception"], "nbgrader": graded(number, points[number])}  # Run All goes on after it
            )
    return exercises


def graded(number: str, points: int) -> dict[str, object]:
    """What nbgrader wants to know of a cell that gives points."""
    return {
        "grade": True,
        "solution": False,
        "locked": True,
        "grade_id": f"exercise_{number.replace('.', '_')}",
        "points": points,
        "cell_type": "code",
        "schema_version": 3,
    }
