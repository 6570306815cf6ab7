"""What the stored pictures of the notebooks say of themselves: words for all, one colour for one thing."""

import re
from pathlib import Path

import nbformat
import pytest

NOTEBOOKS = sorted((Path(__file__).parents[2] / "notebooks").glob("*.ipynb"))
LINE = re.compile(r'"([^"]*)" \(([a-z ]+), ([a-z -]+?)(?:, with [a-z ]+)?\)')
STYLES = {"solid", "dashed", "dash-dotted", "dotted", "dash-dot-dotted", "long dashes", "dash-dotted in pairs"}
PLANNERS = ("A*", "A* + shortcut", "Theta*", "potential field", "REPARE", "hazard A*", "least risk")


def texts_of(path):
    """Alternative texts of all stored pictures, by the number of their cell."""
    notebook = nbformat.read(path, as_version=4)
    return [
        (number, output.metadata.get("image/png", {}).get("alt", ""))
        for number, cell in enumerate(notebook.cells)
        for output in cell.get("outputs", [])
        if "image/png" in output.get("data", {})
    ]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_each_picture_has_words_without_markup(path):
    for number, text in texts_of(path):
        assert len(text) > 20 or ": " in text, number
        assert not re.search(r"[\\${}\u200b\n]", text), (number, text)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_planner_has_one_colour_and_line_style_throughout(path):
    looks = {}
    for number, text in texts_of(path):
        for name, color, line in LINE.findall(text):
            thing = re.sub(r", [\d.]+ m$|: .*$", "", name)
            if thing in PLANNERS and line in STYLES:
                looks.setdefault(thing, {}).setdefault((color, line), []).append(number)
    for thing, found in looks.items():
        assert len(found) == 1, f"{thing} looks different in cells {found}"
