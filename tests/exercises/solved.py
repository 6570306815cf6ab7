"""The exercises and their worked solutions, as the solution notebooks have them."""

import importlib
import re
from functools import cache
from pathlib import Path

import jupytext

from uavlab.exercises.kinds import Quiz

SOURCES = sorted((Path(__file__).parents[2] / "notebooks/src/solutions").glob("*.py"))
CHECKED = re.compile(r'^exercises\.check\("(\d\d\.\d)", (\w+)\)', re.MULTILINE)
EXERCISES = dict(pair for source in SOURCES for pair in CHECKED.findall(source.read_text(encoding="utf-8")))
"""Number of each exercise, and the name of what it asks for."""


@cache
def solutions_of(chapter):
    """The names that a chapter's solutions define."""
    (source,) = [path for path in SOURCES if path.stem.startswith(chapter)]
    namespace = {}
    for cell in jupytext.read(source).cells:
        if cell.cell_type == "code":
            exec(cell.source, namespace)
    return namespace


def asked_for(number):
    """What an exercise asks for: a "function", a "choice" or a "value"."""
    exercise = getattr(importlib.import_module(f"uavlab.exercises.chapter{number[:2]}"), f"exercise_{number[3:]}")
    if isinstance(exercise, Quiz):
        return "choice"
    return "value" if hasattr(exercise, "value") else "function"


FUNCTIONS = [number for number in EXERCISES if asked_for(number) == "function"]
CHOICES = [number for number in EXERCISES if asked_for(number) == "choice"]
VALUES = [number for number in EXERCISES if asked_for(number) == "value"]
