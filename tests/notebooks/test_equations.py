"""Equations of pages: all of the course's are understood, and one that isn't is named."""

import importlib.util
from pathlib import Path

import jupytext
import pytest
from bs4 import BeautifulSoup

NOTEBOOKS = Path(__file__).parents[2] / "notebooks"
SOURCES = sorted((NOTEBOOKS / "src").rglob("*.py"))


@pytest.fixture
def page_of(monkeypatch, tmp_path):
    """Export of a source without running it, as a parsed page."""
    monkeypatch.syspath_prepend(NOTEBOOKS)
    exported = importlib.import_module("exported")

    def export(text, name="a_page"):
        path = exported.export(jupytext.reads(text, fmt="py:percent"), name, tmp_path)
        return BeautifulSoup(path.read_text(encoding="utf-8"), "html.parser")

    return export


@pytest.mark.parametrize("source", SOURCES, ids=lambda path: path.stem)
def test_every_equation_of_the_course_is_typeset(source, page_of):
    page = page_of(source.read_text(encoding="utf-8"), source.stem)
    letters = {letter["id"] for letter in page.select("defs path")}
    for equation in page.select("mjx-container"):
        used = {letter["xlink:href"] for letter in equation.select("use")}
        assert used, f"blank: {equation.math['alttext']}"
        assert {link.removeprefix("#") for link in used} <= letters
    for other in page.select("mjx-container, code, pre"):
        other.decompose()
    for text in page.select(".jp-RenderedMarkdown"):
        assert not set("\\$") & set(text.get_text()), text.get_text()


def test_a_page_has_its_own_letters_only(page_of):
    page = page_of("# %% [markdown]\n# $x + x$")
    assert len(page.select("use")) == 3
    assert [path["id"] for path in page.select("defs path")] == ["MJX-TEX-I-1D465", "MJX-TEX-N-2B"]


@pytest.mark.parametrize(
    ("tex", "words"),
    [
        (r"$\frca{1}{2}$", r"Undefined control sequence \frca in the equation \frca{1}{2}"),
        (r"$$ \frac{1}{2 $$", r"Missing close brace in the equation \frac{1}{2"),
        (r"\begin{nothing} x \end{nothing}", r"Unknown environment 'nothing'"),
        (r"$\text{岸}$", r"There is no letter 岸 for the equation \text{岸}"),
    ],
)
def test_an_equation_that_is_not_tex_is_named(page_of, tex, words):
    with pytest.raises(ValueError, match=r"^a_page, cell 2: ") as raised:
        page_of(f"# %% [markdown]\n# $x$\n\n# %% [markdown]\n# Text, {tex}, text")
    assert words in str(raised.value)


def test_the_builder_says_what_is_wrong_and_fails(page_of, monkeypatch, tmp_path):
    spec = importlib.util.spec_from_file_location("equations_build", NOTEBOOKS / "build.py")
    build = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(build)
    (tmp_path / "bad.py").write_text("# %% [markdown]\n# $\\frca$\n", encoding="utf-8")
    monkeypatch.setattr(build, "SOURCES", tmp_path)
    monkeypatch.setattr(build, "HERE", tmp_path)
    monkeypatch.setattr(build, "run", lambda notebook: notebook)
    monkeypatch.setattr("sys.argv", ["build.py", "--html", "bad"])
    with pytest.raises(SystemExit, match=r"no page: bad, cell 1: Undefined control sequence \\frca in the equation"):
        build.main()
    assert not list((tmp_path / "html").glob("*.html"))
