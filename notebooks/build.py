"""Build the notebooks from their sources, or say which are stale.

`notebooks/src/*.py` (jupytext, py:percent) is what is edited and reviewed. `python notebooks/build.py` brings each
`notebooks/*.ipynb` up to date and runs it in a fresh kernel; figures and printed results stay in, 3D pages are taken
out (they come back with Run All, a still picture stands for them). Exercises are their solutions with the answers
taken out. `--check` changes nothing and fails if anything is stale. `--html` runs notebooks and writes them to
`notebooks/html/` as pages that work offline, each in one file with its scenes, sliders and equations. `--page FILE`
writes a project that a student has run and saved as such a page, beside it. `--nbgrader FOLDER` makes assignments of
the exercises. `--full` measures all claims of the papers anew, with full samples, and writes them to
`notebooks/trial.csv`, which chapter 15 reads; where that is missing or old, it is measured without being asked for. The
tables for teachers in `notebooks/README.md` are kept up to date, too, and the pictures of the README, which are those
of cells with the tag `gallery`.
"""

import argparse
import base64
import re
import sys
from pathlib import Path

import gallery
import jupytext
import nbformat
import teaching
from exported import FOLDED, export, handed_in
from grading import write_assignments
from nbclient import NotebookClient
from nbformat import NotebookNode

from uavlab.plot.pictures import quantised
from uavlab.trial import read_findings, run_trial, write_findings

HERE = Path(__file__).resolve().parent
SOURCES = HERE / "src"
TRIAL = HERE / "trial.csv"
READS_TRIAL = "15_the_papers_on_trial"
SOLUTION = re.compile(r"^([ \t]*)### BEGIN SOLUTION.*?### END SOLUTION[ \t]*$", re.DOTALL | re.MULTILINE)
ANSWER = re.compile(r"^(\w+) = ", re.MULTILINE)
SECONDS_PER_CELL = 300


def main() -> int:
    command = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    command.add_argument("names", nargs="*", help="only these, as in 05_astar; default: all that are stale")
    command.add_argument("--all", action="store_true", help="run all of them, stale or not")
    command.add_argument("--check", action="store_true", help="only say what is stale; exit 1 if anything is")
    command.add_argument("--html", action="store_true", help="write pages that work offline to notebooks/html/")
    command.add_argument(
        "--nbgrader",
        metavar="FOLDER",
        help="write exercises, as in 05 06, to FOLDER/source for nbgrader; default: all",
    )
    command.add_argument("--page", type=Path, metavar="FILE", help="a saved notebook as a page to hand in, beside it")
    command.add_argument("--full", action="store_true", help="measure all claims of the papers anew, to trial.csv")
    options = command.parse_args()
    if options.full:
        measure_claims()
        return 0
    if options.page:
        return page_of(options.page)
    if options.nbgrader:
        try:
            for path in assignments(options.names, Path(options.nbgrader)):
                print(path)
        except ValueError as problem:
            raise SystemExit(f"no assignments: {problem}") from None
        return 0
    sources = [path for path in sorted(SOURCES.rglob("*.py")) if not options.names or path.stem in options.names]
    if not sources:
        command.error(f"no source in {SOURCES} is called {' or '.join(options.names)}")
    if options.html:
        for source in sources:
            notebook = run(jupytext.read(source))
            try:
                print(export(notebook, source.stem, HERE / "html"), flush=True)
            except ValueError as problem:
                raise SystemExit(f"no page: {problem}") from None
        return 0
    stale = {source: reason for source in sources if (reason := staleness(source))}
    orphans = [] if options.names else orphaned()
    readme = HERE / "README.md"
    guide = readme.read_text(encoding="utf-8") if readme.exists() and not options.names else ""
    tables = teaching.with_tables(guide, SOURCES)
    if options.check:
        for source, reason in stale.items():
            print(f"stale: {target(source).relative_to(HERE.parent)}: {reason}; run python notebooks/build.py")
        for orphan in orphans:
            print(f"no source: {orphan.relative_to(HERE.parent)}")
        if old := trial_staleness():
            print(f"stale: notebooks/trial.csv: {old}")
        if tables != guide:
            print("stale: notebooks/README.md: its tables differ from the chapters; run python notebooks/build.py")
        for picture in (old_pictures := gallery.stale()):
            print(
                f"stale: {picture.relative_to(HERE.parent)}: its chapter draws another; run python notebooks/build.py"
            )
        print(f"{len(sources)} notebooks, {len(stale)} stale, {len(orphans)} without a source")
        return 1 if stale or orphans or old or old_pictures or tables != guide else 0
    if not options.names and trial_staleness():
        measure_claims()
        stale |= {source: "its claims were measured anew" for source in sources if source.stem == READS_TRIAL}
    for source in sources if options.all or options.names else stale:
        print(f"running {source.relative_to(SOURCES)}", flush=True)
        write(executed(jupytext.read(source)), target(source))
        if is_solution(source):
            write(exercise(source), exercise_target(source))
    if tables != guide:
        readme.write_text(tables, encoding="utf-8")
    gallery.write()
    return 0


def measure_claims() -> None:
    """Measure all claims of the papers with full samples, for chapter 15."""
    write_findings(run_trial(full=True, jobs=-1), TRIAL)
    print(TRIAL)


def assignments(names: list[str], course: Path) -> list[Path]:
    """Write the exercises of chapters, or of all, as assignments into the folder of a course of nbgrader.

    Raises
    ------
    ValueError
        If a name is that of no chapter with exercises, or something is in the way.
    """
    every = {source.stem: source for source in sorted((SOURCES / "solutions").glob("*.py"))}
    for name in names:
        if not any(is_called(name, stem) for stem in every):
            known = ", ".join(stem[:2] for stem in every)
            raise ValueError(f"there are no exercises of chapter {name!r}; there are those of {known}")
    chosen = {stem: source for stem, source in every.items() if not names or any(is_called(n, stem) for n in names)}
    points = {one.number: one.minutes for source in chosen.values() for one in teaching.exercises_of(source)}
    return write_assignments({stem: exercise(source) for stem, source in chosen.items()}, points, course)


def is_called(name: str, stem: str) -> bool:
    """Whether somebody means these exercises, by the number or the name of their chapter."""
    return name in (stem[:2], stem.removesuffix("_exercises"), stem)


def page_of(notebook: Path) -> int:
    """Write the page of a project, and say what is missing in it."""
    try:
        path, missing = handed_in(notebook)
    except ValueError as problem:
        raise SystemExit(f"no page: {problem}") from None
    print(path, *missing, sep="\n")
    return 0


def target(source: Path) -> Path:
    """The notebook that belongs to a source."""
    return HERE / source.relative_to(SOURCES).with_suffix(".ipynb")


def is_solution(source: Path) -> bool:
    return source.parent.name == "solutions"


def exercise_target(source: Path) -> Path:
    return HERE / "exercises" / f"{source.stem}.ipynb"


def staleness(source: Path) -> str:
    """Why a notebook has to be built again; empty when it hasn't."""
    path = target(source)
    if not path.exists():
        return "missing"
    notebook = nbformat.read(path, as_version=4)
    wanted = jupytext.read(source)
    if [(c.cell_type, c.source, tags(c)) for c in notebook.cells] != [
        (c.cell_type, c.source, tags(c)) for c in wanted.cells
    ]:
        return "its cells differ from its source"
    code = [cell for cell in notebook.cells if cell.cell_type == "code" and cell.source.strip()]
    if [cell.execution_count for cell in code] != list(range(1, len(code) + 1)):
        return "not run from top to bottom"
    if any(output.output_type == "error" for cell in code for output in cell.outputs):
        return "a cell failed"
    if any(is_silent(output) for cell in code for output in cell.outputs):
        return "a picture has no alternative text"
    if path.read_text(encoding="utf-8") != text_of(stripped(notebook)):
        return "has outputs or metadata that don't belong"
    if is_solution(source):
        exercises = exercise_target(source)
        if not exercises.exists() or exercises.read_text(encoding="utf-8") != text_of(exercise(source)):
            return "its exercise differs"
    return ""


def trial_staleness() -> str:
    """Why the papers' claims have to be measured again; empty when they haven't."""
    try:
        read_findings(TRIAL)
    except (OSError, ValueError) as problem:
        return str(problem)
    return ""


def orphaned() -> list[Path]:
    """Notebooks that no source stands behind."""
    sources = list(SOURCES.rglob("*.py"))
    known = {target(source) for source in sources} | {exercise_target(s) for s in sources if is_solution(s)}
    return sorted(
        path for path in HERE.rglob("*.ipynb") if path not in known and ".ipynb_checkpoints" not in path.parts
    )


def executed(notebook: NotebookNode) -> NotebookNode:
    """The notebook run from top to bottom in a fresh kernel, stripped."""
    return stripped(run(notebook))


def run(notebook: NotebookNode) -> NotebookNode:
    """The notebook run from top to bottom in a fresh kernel, with all its outputs."""
    client = NotebookClient(
        notebook,
        timeout=SECONDS_PER_CELL,
        record_timing=False,
        coalesce_streams=True,  # else the prints of a cell are split at random
        resources={"metadata": {"path": str(HERE)}},
    )
    client.execute()
    return notebook


def stripped(notebook: NotebookNode) -> NotebookNode:
    """The notebook without what changes from run to run or is too large to keep."""
    notebook.metadata = nbformat.from_dict(
        {
            "kernelspec": {"display_name": "Python 3 (ipykernel)", "language": "python", "name": "python3"},
            "language_info": {"name": "python"},
        }
    )
    for number, cell in enumerate(notebook.cells):
        cell.id = f"cell-{number:02d}"
        cell.metadata = metadata_of(cell)
        if cell.cell_type == "code":
            cell.outputs = [output for output in map(kept, cell.outputs) if output is not None]
    return notebook


def metadata_of(cell: NotebookNode) -> NotebookNode:
    """A cell's tags; code that only draws or checks is collapsed in JupyterLab."""
    metadata: dict[str, object] = {"tags": tags(cell)} if tags(cell) else {}
    if any(tag in FOLDED for tag in tags(cell)):
        metadata["jupyter"] = {"source_hidden": True}
    return nbformat.from_dict(metadata)


def kept(output: NotebookNode) -> NotebookNode | None:
    """An output as it is stored: scenes and sliders as their still picture, pictures small, warnings not at all."""
    if output.output_type == "stream" and output.name == "stderr":
        return None
    data = output.get("data", {})
    if "application/vnd.jupyter.widget-view+json" in data:
        return None
    if is_live(output):
        del data["text/html"]
    if "image/png" in data:
        small = quantised(base64.b64decode(data["image/png"]))
        data["image/png"] = base64.b64encode(small).decode()
    return output


def is_live(output: NotebookNode) -> bool:
    """Whether an output is a page to play with; it comes back with Run All."""
    markup = output.get("data", {}).get("text/html", "")
    return "uavlab-scene" in markup or "uavlab-sliders" in markup


def is_silent(output: NotebookNode) -> bool:
    """Whether an output is a picture without words for those who don't see it."""
    return "image/png" in output.get("data", {}) and not output.metadata.get("image/png", {}).get("alt")


def exercise(source: Path) -> NotebookNode:
    """A solutions notebook with the answers taken out and nothing run."""
    notebook = stripped(jupytext.read(source))
    notebook.metadata["jupytext"] = {"formats": "ipynb"}  # a student who saves it makes no source of it
    notebook.cells = [cell for cell in notebook.cells if "solution" not in tags(cell)]
    for cell in notebook.cells:
        if cell.cell_type == "code":
            cell.source = SOLUTION.sub(blank, cell.source)
    return notebook


def blank(solution: re.Match) -> str:
    """What stands in the place of a solution: a function that isn't written yet, or the dots of a value.

    A value is the last name that the solution sets.
    """
    indent = solution[1]
    if indent:
        return f"{indent}# your answer\n{indent}raise NotImplementedError"
    return f"{ANSWER.findall(solution[0])[-1]} = ...  # your answer"


def tags(cell: NotebookNode) -> list[str]:
    return list(cell.metadata.get("tags", []))


def write(notebook: NotebookNode, path: Path) -> None:
    path.parent.mkdir(exist_ok=True)
    path.write_text(text_of(notebook), encoding="utf-8")


def text_of(notebook: NotebookNode) -> str:
    return nbformat.writes(notebook) + "\n"


if __name__ == "__main__":
    sys.exit(main())
