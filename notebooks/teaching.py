"""What the chapters say of themselves, and the tables for teachers that `notebooks/README.md` makes of it.

Goals, needs and times stand in a chapter's first cell, levels and minutes above each exercise. The tables between the
marks of `README.md` are made from them by `build.py`; which chapters a week has stands here.
"""

import re
from dataclasses import dataclass
from pathlib import Path

import jupytext

PART = re.compile(r"(<!-- (\w+), made by build\.py -->\n\n).*?(\n\n<!-- end -->)", re.DOTALL)
EXERCISE = re.compile(r"^## (\d\d\.\d+) (.+)\n\n\*([\w-]+) · (\d+) minutes\*$", re.MULTILINE)
CHAPTER = re.compile(r"\[(\d\d)\]\((\w+)\.ipynb\)")
LEVELS = {
    "Warm-up": "The chapter was read: a choice, or a formula in a few lines",
    "Code": "The idea can be written down: a function, tried on cases that the student doesn't see",
    "Experiment": "The idea can be used: a number that has to be found with the library",
    "Open": "Something of their own: many answers are right, and the check measures what is handed in",
}
SIX_WEEKS = {
    "From the weather to forces": ("00", "01"),
    "From gusts to a distance": ("02",),
    "What a planner sees of a city": ("04",),
    "The shortest way, and why we may believe it": ("05",),
    "Who is below": ("08", "09"),
    "What a UAV can fly, and what survives gusts": ("12", "13"),
}
TWELVE_WEEKS = {
    "From the weather to forces": ("00", "01"),
    "From gusts to a distance": ("02",),
    "Predicting gusts, without flattering oneself": ("03",),
    "What a planner sees of a city": ("04",),
    "The shortest way, and why we may believe it": ("05",),
    "Forces instead of a search": ("06",),
    "What a metre near a wall should cost": ("07",),
    "Who is below": ("08", "09"),
    "Ants, swarms, and how far they are from the optimum": ("10", "11"),
    "What a UAV can fly, and what survives gusts": ("12", "13"),
    "To an autopilot, and the papers on trial": ("14", "15"),
    "The project": ("16",),
}


@dataclass(frozen=True)
class Exercise:
    """What stands above an exercise."""

    number: str
    title: str
    level: str
    minutes: int


@dataclass(frozen=True)
class Chapter:
    """What a chapter says of itself in its first cell, and its exercises."""

    name: str
    title: str
    goals: str
    needs: str
    reading: int
    """Minutes to read."""
    exercises: tuple[Exercise, ...]

    @property
    def number(self) -> str:
        return self.name[:2]

    @property
    def answering(self) -> int:
        return sum(exercise.minutes for exercise in self.exercises)


def chapters(sources: Path) -> list[Chapter]:
    """All chapters, in order."""
    return [chapter_of(source) for source in sorted(sources.glob("[0-9][0-9]_*.py"))]


def chapter_of(source: Path) -> Chapter:
    first = jupytext.read(source).cells[0].source
    rows = dict(re.findall(r"^\| \*\*(.+?)\*\* \| (.*) \|$", first, re.MULTILINE))
    reading = re.match(r"(\d+) minutes to read", rows["Time"])
    assert reading is not None, source
    solutions = source.parent / "solutions" / f"{source.stem}_exercises.py"
    return Chapter(
        source.stem,
        first.splitlines()[0].removeprefix("# ").partition(":")[0].replace("*", r"\*"),
        rows["You will be able to"],
        CHAPTER.sub(lambda link: link[0] if source.with_name(f"{link[2]}.py").exists() else link[1], rows["You need"]),
        int(reading[1]),
        exercises_of(solutions) if solutions.exists() else (),
    )


def exercises_of(solutions: Path) -> tuple[Exercise, ...]:
    """The exercises of a notebook of solutions."""
    text = "\n\n".join(cell.source for cell in jupytext.read(solutions).cells if cell.cell_type == "markdown")
    return tuple(
        Exercise(number, title, level, int(minutes)) for number, title, level, minutes in EXERCISE.findall(text)
    )


def with_tables(text: str, sources: Path) -> str:
    """The text for teachers with its tables made anew."""
    if not PART.search(text):
        return text
    course = chapters(sources)
    tables = {
        "chapters": chapter_table(course),
        "levels": level_table(course),
        "six": plan(SIX_WEEKS, course),
        "twelve": plan(TWELVE_WEEKS, course),
    }
    return PART.sub(lambda part: part[1] + tables[part[2]] + part[3], text)


def chapter_table(course: list[Chapter]) -> str:
    rows = ["| chapter | you will be able to | you need | reading | exercises |", "|---|---|---|---|---|"]
    for chapter in course:
        link = f"[{len(chapter.exercises)}](exercises/{chapter.name}_exercises.ipynb)"
        exercises = f"{link}, {chapter.answering} min" if chapter.exercises else ""
        promises = f"| [{chapter.title}]({chapter.name}.ipynb) | {chapter.goals} | {chapter.needs} "
        rows.append(f"{promises}| {chapter.reading} min | {exercises} |")
    reading, answering = sum(chapter.reading for chapter in course), sum(chapter.answering for chapter in course)
    exercises = f"{sum(len(chapter.exercises) for chapter in course)} exercises, {hours(answering)} hours"
    return "\n".join(rows) + f"\n\nTogether: {len(course)} chapters, {hours(reading)} hours to read; {exercises}."


def level_table(course: list[Chapter]) -> str:
    rows = ["| level | exercises | minutes each | what a right answer shows |", "|---|---|---|---|"]
    every = [exercise for chapter in course for exercise in chapter.exercises]
    for level, meaning in LEVELS.items():
        minutes = [exercise.minutes for exercise in every if exercise.level == level]
        rows.append(f"| {level} | {len(minutes)} | {min(minutes)} to {max(minutes)} | {meaning} |")
    return "\n".join(rows)


def plan(weeks: dict[str, tuple[str, ...]], course: list[Chapter]) -> str:
    """Weeks with their chapters and hours, the sum, and what is left out."""
    rows = ["| week | about | chapters | reading, h:min | exercises | together |", "|---|---|---|---|---|---|"]
    taken = []
    for week, (about, numbers) in enumerate(weeks.items(), 1):
        own = [chapter for chapter in course if chapter.number in numbers]
        taken += own
        rows.append(f"| {week} | {about} | {', '.join(numbers_of(own)) or ', '.join(numbers)} | {sums(own)} |")
    rows.append(f"| | | all | {sums(taken)} |")
    left = ", ".join(numbers_of([chapter for chapter in course if chapter not in taken]))
    return "\n".join(rows) + (f"\n\nLeft out: {left}." if left else "")


def numbers_of(course: list[Chapter]) -> list[str]:
    return [f"[{chapter.number}]({chapter.name}.ipynb)" for chapter in course]


def sums(course: list[Chapter]) -> str:
    """Hours of reading, of exercises, and of both, as cells of a table."""
    reading, answering = sum(chapter.reading for chapter in course), sum(chapter.answering for chapter in course)
    return " | ".join(hours(minutes) if minutes else "" for minutes in (reading, answering, reading + answering))


def hours(minutes: int) -> str:
    return f"{minutes // 60}:{minutes % 60:02d}"
