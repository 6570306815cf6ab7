"""The frame that chapters share: what a reader is promised, predicts, tries, remembers and can read on."""

import ast
import itertools
import re
from pathlib import Path

import jupytext
import pytest

SOURCES = Path(__file__).parents[2] / "notebooks" / "src"
FRAMED = sorted(SOURCES.glob("*.py"))
CHAPTERS = [path.name[:2] for path in FRAMED]
PROJECT = "16"
"""It has questions and points instead of exercises, and no paper to judge; the rest: test_your_own_city.py."""
TAGS = {"check", "figure", "gallery", "guide", "nbval-check-output", "try-it"}


@pytest.fixture(params=FRAMED, ids=lambda path: path.stem)
def chapter(request):
    """The cells of a chapter."""
    cells = jupytext.read(request.param).cells
    cells[0].name = request.param.stem
    return cells


def tags(cell):
    return set(cell.metadata.get("tags", []))


def text_of(cells):
    return "\n\n".join(cell.source for cell in cells if cell.cell_type == "markdown")


def section(text, title):
    """What stands below a heading, up to the next."""
    found = re.search(rf"^## {re.escape(title)}$(.*?)(?=^## |\Z)", text, re.MULTILINE | re.DOTALL)
    assert found, f"no section '## {title}'"
    return found[1]


def test_first_cell_asks_and_promises(chapter):
    first = chapter[0].source
    assert first.startswith(f"# {chapter[0].name[:2]} ")
    assert "?" in first
    for row in ("You will be able to", "You need", "Time", "Paper"):
        assert f"| **{row}** |" in first
    assert re.search(r"\| \d+ minutes to read", first)


def test_end_remembers_judges_and_leads_on(chapter):
    text = text_of(chapter)
    assert 4 <= len(re.findall(r"^- ", section(text, "Remember"), re.MULTILINE)) <= 7
    sources = re.split(r"^- ", section(text, "Read on"), flags=re.MULTILINE)[1:]
    assert 3 <= len(sources) <= 6
    for source in sources:
        assert "](http" in source or "Press" in source or "ISBN" in source, f"where is it? {source}"
        assert ":" in source, f"what is it for? {source}"


def test_papers_are_judged_and_exercises_follow(chapter):
    text, number = text_of(chapter), chapter[0].name[:2]
    if number == PROJECT:
        assert "## How it is marked" in text
        return
    assert section(text, "What the paper says, what we find").count("\n|") >= 3
    assert number == "00" or "](exercises/" in section(text, "Your turn")


def test_chapters_lead_to_their_neighbours(chapter):
    end, at = chapter[-1].source, CHAPTERS.index(chapter[0].name[:2])
    assert at == 0 or re.search(rf"Before: \[{CHAPTERS[at - 1]} ", end)
    assert chapter[0].name[:2] == CHAPTERS[-1] or re.search(rf"Next: \[{CHAPTERS[at + 1]} ", end)


def test_reader_predicts_and_tries(chapter):
    text = text_of(chapter)
    assert text.count("> **Predict first.**") >= 2
    assert text.count("> **Try it.**") >= 2
    for cell, following in itertools.pairwise(chapter):
        if cell.cell_type == "markdown" and "**Try it.**" in cell.source:
            assert "try-it" in tags(following), cell.source[-200:]


def names(code):
    """Names that code binds, and those that it uses, at whatever depth."""
    found = [node for node in ast.walk(ast.parse(code)) if isinstance(node, ast.Name)]
    tree = list(ast.walk(ast.parse(code)))
    bound = {node.name for node in tree if isinstance(node, ast.FunctionDef)}
    return bound | {n.id for n in found if isinstance(n.ctx, ast.Store)}, {n.id for n in found}


def test_nothing_depends_on_what_a_reader_tries(chapter):
    code = [cell for cell in chapter if cell.cell_type == "code"]
    before = set()
    for at, cell in enumerate(code):
        bound, _ = names(cell.source)
        if "try-it" in tags(cell):
            later = set().union(set(), *(names(one.source)[1] for one in code[at + 1 :] if "try-it" not in tags(one)))
            assert not bound & before, f"a cell to try changes {bound & before}"
            rebound = set().union(set(), *(names(one.source)[0] for one in code[at + 1 :]))
            assert not bound & (later - rebound), f"later cells use {bound & later}"
            assert "assert" not in cell.source
        else:
            before |= bound


def test_visible_cells_hold_ideas_and_no_tests(chapter):
    for cell in chapter:
        assert tags(cell) <= TAGS, tags(cell)
        if cell.cell_type != "code":
            continue
        assert "NBVAL" not in cell.source
        lost = re.search(r"^# ?(#|>|\||- |\$\$)", cell.source, re.MULTILINE)
        assert not lost, f"Markdown in a code cell: {cell.source[lost.start() :][:80]}"
        if "check" in tags(cell):
            assert "assert" in cell.source or "nbval-check-output" in tags(cell)
        elif not tags(cell) & {"figure", "guide"}:
            lines = [line for line in cell.source.splitlines() if line.strip()]
            asserted = re.search(r"^\s*assert |pytest|fmt: skip", cell.source, re.MULTILINE)
            assert not asserted, f"for a cell tagged check: {cell.source[:200]}"
            assert len(lines) <= (20 if "def " in cell.source or "import " in lines[0] else 12), cell.source[:300]


AVOIDED = (
    r"reckon\w* with", r"\bdear(er|est)?\b", r"\bthe open\b(?! (list|category))",
    r"\bin space\b", r"drawn by chance", r"more way\b",
    r"(?i:\bwhoever\b)", r"as it is counted",
    r"scale of factors",
    r"(^|[.:] )Who [^?.]*\.",
)  # fmt: skip


def test_words_that_readers_stumbled_over_are_gone(chapter):
    text = text_of(chapter)
    for words in AVOIDED:
        found = re.search(words, text)
        assert not found, text[max(0, found.start() - 60) : found.end() + 30]


def test_the_first_chapter_names_all_others():
    """Nobody who starts there misses one."""
    first = (SOURCES / "00_start_here.py").read_text(encoding="utf-8").partition("## All chapters")[2]
    for source in sorted(SOURCES.glob("[0-9][0-9]_*.py"))[1:]:
        assert f"[{source.stem[:2]} " in first, source.stem
        assert f"({source.stem}.ipynb) | " in first, source.stem
