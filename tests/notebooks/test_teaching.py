"""The page for teachers: its tables and sums are the chapters' own, its links lead somewhere, its commands exist."""

import importlib
import re
import tomllib
from pathlib import Path

import jupytext
import pytest

ROOT = Path(__file__).parents[2]
NOTEBOOKS = ROOT / "notebooks"
PAGE = (NOTEBOOKS / "README.md").read_text(encoding="utf-8")
SOURCES = sorted((NOTEBOOKS / "src").glob("[0-9][0-9]_*.py"))
PLANS = ("Six weeks", "Twelve weeks")


@pytest.fixture(scope="module")
def teaching():
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(NOTEBOOKS)
        yield importlib.import_module("teaching")


def rows_below(heading):
    """The rows of the first table below a heading, without its head."""
    section = PAGE.split(f"\n## {heading}\n", 1)[1]
    table = re.search(r"(?:^\|.*\|\n)+", section, re.MULTILINE)[0]
    return [[cell.strip() for cell in row[1:-1].split(" | ")] for row in table.splitlines()[2:]]


def minutes_of(source):
    """Minutes to read a chapter, and those of its exercises, as its sources say them."""
    stated = re.search(r"^# \| \*\*Time\*\* \| (\d+) minutes to read", source.read_text(encoding="utf-8"), re.MULTILINE)
    solutions = source.parent / "solutions" / f"{source.stem}_exercises.py"
    text = solutions.read_text(encoding="utf-8") if solutions.exists() else ""
    return int(stated[1]), sum(map(int, re.findall(r"^# \*[\w-]+ · (\d+) minutes\*$", text, re.MULTILINE)))


def without_links(text):
    """Chapters by their number alone; those to come have no link yet."""
    return re.sub(r"\[(\d\d)\]\(\w+\.ipynb\)", r"\1", text)


def minutes(text):
    """Of a time as in 1:15."""
    hours, rest = text.split(":") if text else (0, 0)
    return 60 * int(hours) + int(rest)


def test_tables_are_up_to_date(teaching):
    assert teaching.with_tables(PAGE, NOTEBOOKS / "src") == PAGE, "run python notebooks/build.py"
    assert set(re.findall(r"<!-- (\w+), made", PAGE)) == {"chapters", "levels", "six", "twelve"}


def test_every_chapter_is_there_with_its_goals_minutes_and_exercises():
    rows = rows_below("Chapters")
    assert [re.search(r"\]\((\w+)\.ipynb\)", row[0])[1] for row in rows] == [source.stem for source in SOURCES]
    for source, (_, goals, needs, reading, exercises) in zip(SOURCES, rows, strict=True):
        first = jupytext.read(source).cells[0].source
        assert f"| **You will be able to** | {goals} |" in first
        assert f"| **You need** | {without_links(needs)} |" in without_links(first)
        read, answered = minutes_of(source)
        assert reading == f"{read} min"
        assert exercises.endswith(f", {answered} min") if answered else exercises == ""


@pytest.mark.parametrize("heading", PLANS)
def test_hours_of_a_plan_are_those_of_its_chapters(heading):
    *weeks, total = rows_below(heading)
    assert [row[0] for row in weeks] == [str(week) for week in range(1, len(weeks) + 1)]
    assert len(weeks) == {"Six weeks": 6, "Twelve weeks": 12}[heading]
    sums = [0, 0, 0]
    for _, _, chapters, *times in weeks:
        own = [minutes_of(source) for source in SOURCES if f"]({source.stem}.ipynb)" in chapters]
        reading, answering = sum(read for read, _ in own), sum(answered for _, answered in own)
        assert [minutes(time) for time in times] == [reading, answering, reading + answering]
        sums = [before + minutes(time) for before, time in zip(sums, times, strict=True)]
    assert [minutes(time) for time in total[-3:]] == sums


@pytest.mark.parametrize("heading", PLANS)
def test_a_plan_has_what_a_chapter_needs_before_it(heading):
    plan = [number for row in rows_below(heading) for number in re.findall(r"\[(\d\d)\]", row[2])]
    needs = {row[0][1:3]: re.findall(r"\[(\d\d)\]", row[2]) for row in rows_below("Chapters")}
    assert sorted(set(plan)) == sorted(plan)
    for at, number in enumerate(plan):
        late = set(needs[number]) & set(plan[at:])
        assert not late, f"chapter {number} needs {late}, which come later"


def test_twelve_weeks_have_the_whole_course_and_six_say_what_is_left_out():
    chapters = {source.name[:2] for source in SOURCES}
    six, twelve = ({n for row in rows_below(h) for n in re.findall(r"\[(\d\d)\]", row[2])} for h in PLANS)
    assert twelve == chapters, "every chapter has a week in notebooks/teaching.py"
    left = re.search(r"^Left out: (.+)\.$", PAGE, re.MULTILINE)[1]
    assert set(re.findall(r"\[(\d\d)\]", left)) == chapters - six


def test_levels_count_every_exercise():
    counts = [int(row[1]) for row in rows_below("What to assess")]
    solutions = (NOTEBOOKS / "src" / "solutions").glob("*.py")
    text = "".join(path.read_text(encoding="utf-8") for path in solutions)
    assert sum(counts) == len(re.findall(r"^# ## \d\d\.\d+ ", text, re.MULTILINE))


def test_links_lead_somewhere():
    links = re.findall(r"\]\(([^)\s]+)\)", PAGE)
    assert len(links) > 60
    for link in links:
        assert link.startswith("https://") or (NOTEBOOKS / link).exists(), link


def test_numbers_to_change_are_where_the_page_says():
    for number, _, place, _ in rows_below("Solutions are public"):
        (source,) = (NOTEBOOKS / "src" / "solutions").glob(f"{number[:2]}_*.py")
        text = source.read_text(encoding="utf-8").split(f"# ## {number} ")[1].split("\n# ## ")[0]
        for name in re.findall(r"`([^`]+)`", place):
            assert name.split("(…")[0] in text, f"{number}: {name}"


def test_commands_and_points_are_as_they_are():
    build = (NOTEBOOKS / "build.py").read_text(encoding="utf-8")
    for option in re.findall(r"python notebooks/build\.py (--\w+)", PAGE):
        assert f'"{option}"' in build
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["optional-dependencies"]
    assert set(re.findall(r'"\.\[(\w+)\]"', PAGE)) == {"teach"} <= set(extras)
    (astar,) = [source for source in SOURCES if source.stem == "05_astar"]
    assert f"so 05 gives {minutes_of(astar)[1]}." in PAGE
