"""The table of symbols: complete for REPARE's own, with units and chapters, open about letters with two meanings."""

import re
from collections import Counter
from pathlib import Path

import jupytext
import pytest

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "notebooks" / "SYMBOLS.md").read_text(encoding="utf-8")
CHAPTERS = {path.name[:2] for path in (ROOT / "notebooks" / "src").glob("[0-9][0-9]_*.py")}
COLUMNS = ["symbol", "meaning", "unit", "in code", "in the papers", "chapter"]
SOURCES = sorted((ROOT / "notebooks" / "src").rglob("[0-9][0-9]_*.py"))
CLASHES = "One letter, several meanings"
TABLE_A1 = r"""
    F_r  P_r  S_r  H_r  \rho_r  V_r  \eta_r  t  F_{zMax}  \delta_r  G_{uav}  G_s  \vec{V}_{\mu F}  V_{MaxF}  t_w
    \vec{V}_{\mu S}  V_{res}  \vec{V}_d  V_{uav}  \vec{v}  F_{hmax}  C  \rho_a  S_w  \sigma  \mu  n(x)  D_{min}  D_{uav}
    \xi  h(i, e)  g(s, i)  O(s, i)  T(n)  F_{tra}  F_{rep}  \vartheta_F  \vartheta_G  F_{fin}
"""


def rows_of(text):
    """Cells of the rows of a table, its header included."""
    rows = [re.split(r"(?<!\\)\|", line)[1:-1] for line in text.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in row] for row in rows if not set("".join(row)) <= set("-: ")]


def parts():
    """Rows by the title of their part."""
    sections = re.split(r"^## (.+)$", TEXT, flags=re.MULTILINE)[1:]
    return {title: rows_of(text) for title, text in zip(sections[::2], sections[1::2], strict=True)}


CLASHING = {row[0] for row in parts()[CLASHES][1:]}
ROWS = [row for title, rows in parts().items() if title != CLASHES for row in rows[1:]]


def test_parts_are_tables_with_the_same_columns():
    titles = list(parts())
    assert titles[-1] == CLASHES
    assert len(titles) == 6
    for title in titles[:-1]:
        assert parts()[title][0] == COLUMNS


@pytest.mark.parametrize("symbol", re.split(r"\s{2,}", TABLE_A1.strip()))
def test_each_symbol_of_repare_has_a_row(symbol):
    papers = [part for row in ROWS for part in row[4].split(";") if part.strip().startswith("REPARE")]
    assert any(f"${symbol}$" in part for part in papers)


@pytest.mark.parametrize("row", ROWS, ids=lambda row: f"{row[0]}-{row[5]}")
def test_each_row_has_a_unit_and_chapters_that_exist(row):
    assert len(row) == len(COLUMNS)
    assert all(row), "an empty cell: a dash says that there is none"
    assert row[0].count("$") == 2
    assert set(chapters_of(row)) <= CHAPTERS
    assert chapters_of(row) or row[4] != "–", "in no chapter and in no paper"


def chapters_of(row):
    return [] if row[5] == "–" else row[5].split(", ")


def plain(tex):
    """TeX without what only changes how letters look."""
    tex = re.sub(r"\\([lr]vert|mathbf|text|mathrm|boldsymbol|operatorname|bar|hat|dot)\b", "", tex)
    return re.sub(r"[{}|]|\\[,;!]", " ", tex)


MATHS = dict.fromkeys(CHAPTERS, "")
for source in SOURCES:
    for cell in jupytext.read(source).cells:
        if cell.cell_type == "markdown":
            found = re.findall(r"\$\$(.+?)\$\$|\$([^$]+)\$", cell.source, re.DOTALL)
            MATHS[source.name[:2]] += " ".join(plain(one) for pair in found for one in pair) + " "


@pytest.mark.parametrize("row", [row for row in ROWS if chapters_of(row)], ids=lambda row: f"{row[0]}-{row[5]}")
def test_chapters_use_their_symbols(row):
    """In equations of the text, or of its exercises."""
    symbols = [plain(part) for part in re.split(r",\s*(?![^(]*\))", row[0].strip("$"))]
    for chapter in chapters_of(row):
        for symbol in symbols:
            letters = r"\s*".join(map(re.escape, symbol.replace(" ", "")))
            alone = letters if symbol.startswith("\\") else rf"(?<![A-Za-z\\]){letters}"
            assert re.search(rf"{alone}(?![A-Za-z])", MATHS[chapter]), (symbol, chapter)


def test_each_chapter_has_symbols():
    assert {chapter for row in ROWS for chapter in chapters_of(row)} == CHAPTERS


def test_symbols_with_two_rows_are_listed_as_clashes():
    twice = {symbol for symbol, count in Counter(row[0] for row in ROWS).items() if count > 1}
    assert twice <= CLASHING


def test_no_chapter_uses_a_symbol_for_two_things_unless_that_is_said():
    used = Counter((row[0], chapter) for row in ROWS for chapter in chapters_of(row))
    for (symbol, chapter), count in used.items():
        meanings = next((row[1] for row in parts()[CLASHES][1:] if row[0] == symbol), "")
        assert count == 1 or chapter in meanings, (symbol, chapter)


def test_clashes_name_chapters_that_exist():
    for _, meanings in parts()[CLASHES][1:]:
        assert set(re.findall(r"\b\d\d\b", meanings)) <= CHAPTERS


def test_names_in_code_exist():
    code = "\n".join(path.read_text(encoding="utf-8") for path in sorted((ROOT / "uavlab").rglob("*.py")))
    known = set(re.findall(r"\w+", code))
    for row in ROWS:
        for name in re.findall(r"`([^`]+)`", row[3]):
            assert set(re.findall(r"[A-Za-z_]\w*", name)) <= known, (row[0], name)
