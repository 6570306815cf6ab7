"""What of the exercises is done, read from the notebooks in which they are answered."""

from __future__ import annotations

import importlib
import json
import pkgutil
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any

from uavlab import checks

ASKED = re.compile(r"exercises\.(?:check|grade)\(\s*[\"'](\d\d\.\d+)[\"']")
VERDICT = re.compile(r"^(\d\d\.\d+): (right|not yet)", re.MULTILINE)


@dataclass(frozen=True)
class Progress:
    """Which exercises are answered, and how; shown as a table of chapters."""

    right: tuple[str, ...]
    """Numbers of those with a saved answer that is right."""
    tried: tuple[str, ...]
    """Those whose saved answers aren't right yet."""
    untouched: tuple[str, ...]
    """Those without a saved answer."""

    def __repr__(self) -> str:
        every = sorted([*self.right, *self.tried, *self.untouched], key=place_of)
        rows = []
        for chapter in dict.fromkeys(number[:2] for number in every):
            mine = [number for number in every if number.startswith(f"{chapter}.")]
            solved = [number for number in mine if number in self.right]
            text = f"{chapter}  {len(solved)} of {len(mine)}"
            tried = [number for number in mine if number in self.tried]
            rows.append(f"{text}; not yet {', '.join(tried)}" if tried else text)
        return "\n".join([f"{len(self.right)} of {len(every)} exercises are right", *rows])


def progress(folder: str | PathLike[str] = ".") -> Progress:
    """What is done of all exercises, by the saved notebooks in a folder.

    Parameters
    ----------
    folder : str or path
        Where the exercise notebooks are, or a folder above; by default where Python runs. What isn't saved doesn't
        count.

    Returns
    -------
    Progress
        Shown as a table: for each chapter how many exercises are right, and which were tried.

    Raises
    ------
    ValueError
        If `folder` is no folder, or has no notebook with exercises.

    Examples
    --------
    >>> import json, tempfile
    >>> from pathlib import Path
    >>> from uavlab import exercises
    >>> answered = {"cell_type": "code", "source": 'exercises.check("05.2", octile)',
    ...             "outputs": [{"data": {"text/plain": "05.2: right"}}]}
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = (Path(folder) / "mine.ipynb").write_text(json.dumps({"cells": [answered]}))
    ...     exercises.progress(folder).right
    ('05.2',)
    """
    place = Path(checks.path("folder", folder))
    if not place.is_dir():
        raise ValueError(f"folder must be a folder with exercise notebooks, got {str(folder)!r}, which is none")
    found: dict[str, str] = {}
    asked: set[str] = set()
    for path in sorted(place.rglob("*.ipynb")):
        if ".ipynb_checkpoints" not in path.parts:
            for number, verdict in verdicts(path):
                asked.add(number)
                if verdict and found.get(number) != "right":
                    found[number] = verdict
    if not asked:
        raise ValueError(f"folder must hold notebooks with exercises, such as notebooks/exercises; {place} has none")
    every = numbers()
    return Progress(
        tuple(number for number in every if found.get(number) == "right"),
        tuple(number for number in every if found.get(number) == "not yet"),
        tuple(number for number in every if number not in found),
    )


def numbers() -> list[str]:
    """Of all exercises there are, in order."""
    every = []
    for module in pkgutil.iter_modules([str(Path(__file__).parent)]):
        if chapter := re.fullmatch(r"chapter(\d\d)", module.name):
            loaded = importlib.import_module(f"uavlab.exercises.{module.name}")
            every += [f"{chapter[1]}.{name[9:]}" for name in vars(loaded) if re.fullmatch(r"exercise_\d+", name)]
    return sorted(every, key=place_of)


def place_of(number: str) -> tuple[int, int]:
    chapter, _, exercise = number.partition(".")
    return int(chapter), int(exercise)


def verdicts(path: Path) -> Iterator[tuple[str, str]]:
    """Number and verdict of each check in a notebook, the verdict empty where the cell hasn't been run."""
    try:
        cells = json.loads(path.read_text(encoding="utf-8")).get("cells", [])
    except (OSError, ValueError, AttributeError):  # being written just now, or no notebook
        return
    for cell in cells:
        if not isinstance(cell, Mapping) or cell.get("cell_type") != "code":
            continue
        asked = re.findall(ASKED, text_of(cell.get("source", "")))
        shown = dict(VERDICT.findall("\n".join(output_texts(cell.get("outputs", [])))))
        for number in {*asked, *shown}:
            yield number, shown.get(number, "")


def output_texts(outputs: list[Any]) -> Iterator[str]:
    """What the outputs of a cell say."""
    for output in outputs:
        yield text_of(output.get("text", ""))
        yield text_of(output.get("data", {}).get("text/plain", ""))
        yield text_of(output.get("evalue", ""))


def text_of(lines: str | list[str]) -> str:
    """A text as notebooks keep it, in one piece."""
    return lines if isinstance(lines, str) else "".join(lines)
