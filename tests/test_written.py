"""What is written down holds: examples run, docstrings have their parts, README and CONTRIBUTING name what is there."""

import ast
import doctest
import importlib
import inspect
import pkgutil
import re
import tomllib
from pathlib import Path

import pytest

import uavlab

ROOT = Path(__file__).parent.parent
README, GUIDE = ((ROOT / name).read_text(encoding="utf-8") for name in ("README.md", "CONTRIBUTING.md"))
MODULES = sorted(module.name for module in pkgutil.walk_packages(uavlab.__path__, "uavlab."))
PACKAGES = (
    "city",
    "flight",
    "mavlink",
    "mission",
    "offsets",
    "optimizers",
    "planners",
    "plot",
    "prediction",
    "risk",
    "scene",
    "spline",
    "sweep",
    "trial",
    "vehicle_sim",
    "weather",
)
ALONE = ("power", "resilience", "route", "statistics", "storage", "vehicle")
"""Modules without a face: what they define is public."""


def public():
    """All public functions and classes, by their full name."""
    found = {}
    for name in PACKAGES:
        package = importlib.import_module(f"uavlab.{name}")
        found |= {f"uavlab.{name}.{one}": getattr(package, one) for one in package.__all__}
    for name in ALONE:
        module = importlib.import_module(f"uavlab.{name}")
        found |= {
            f"uavlab.{name}.{one}": thing
            for one, thing in vars(module).items()
            if getattr(thing, "__module__", "") == module.__name__
        }
    return {name: thing for name, thing in found.items() if inspect.isfunction(thing) or inspect.isclass(thing)}


PUBLIC = public()
SMALL = {
    "uavlab.route.Way", "uavlab.route.as_route", "uavlab.route.check_promises", "uavlab.route.promises_of",
    "uavlab.storage.described", "uavlab.storage.described_fields", "uavlab.storage.made",
}  # fmt: skip
"""Public by their place only: helpers of their modules."""


@pytest.mark.parametrize("name", [name for name in MODULES if not name.endswith("__main__")])
def test_examples_run(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    flags = doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS
    failed, _ = doctest.testmod(importlib.import_module(name), optionflags=flags)
    assert failed == 0


@pytest.mark.parametrize("name", sorted(set(PUBLIC) - SMALL))
def test_a_docstring_has_its_parts(name):
    thing = PUBLIC[name]
    text = inspect.getdoc(thing) or ""
    assert text.split("\n")[0].endswith((".", ":")), "the first line is a sentence"
    assert ">>> " in text, "an example that runs"
    assert "See Also\n--------" in text
    if inspect.isfunction(thing) and inspect.signature(thing).parameters:
        assert "Parameters\n----------" in text or "As for" in text
    vague = re.findall(r"(?:an|another) (?:argument|parameter|attribute) is (?:out of|not)", text)
    assert not vague, "Raises names the arguments"


@pytest.mark.parametrize("name", sorted(PUBLIC))
def test_what_is_related_is_there(name):
    text = inspect.getdoc(PUBLIC[name]) or ""
    if "See Also\n--------" not in text:
        return
    section = re.split(r"\n\n?(?=[A-Z][A-Za-z ]+\n-+\n)", text.split("See Also\n--------\n")[1])[0]
    for line in section.splitlines():
        related = re.match(r"([\w.]+)\s*:", line)
        if related is None or line.startswith(" "):
            continue
        assert exists(related[1], name), f"{related[1]} isn't there"


def exists(related, name):
    """Whether a name is one of the same package, class, or by its full name."""
    package = name.split(".")[1]
    places = [f"uavlab.{package}.{related}", f"{name}.{related}", related, f"{name.rpartition('.')[0]}.{related}"]
    for place in places:
        parts = place.split(".")
        for at in range(len(parts), 0, -1):
            try:
                thing = importlib.import_module(".".join(parts[:at]))
            except ImportError:
                continue
            for part in parts[at:]:
                fields = getattr(thing, "__dataclass_fields__", {}) | dict.fromkeys(getattr(thing, "_fields", ()))
                thing = getattr(thing, part, fields.get(part, exists))
            if thing is not exists:
                return True
            break
    return False


def test_help_shows_signatures_that_read():
    for name, thing in PUBLIC.items():
        if inspect.isfunction(thing):
            assert "Union[" not in str(inspect.signature(thing)), name
            assert len(str(inspect.signature(thing))) < 1300, name


def test_modules_are_chapters():
    """Each has a docstring, at most 300 lines of code, and annotations as text; at most six bodies have over 40."""
    long = []
    for path in sorted((ROOT / "uavlab").rglob("*.py")):
        text = path.read_text(encoding="utf-8")
        tree = ast.parse(text)
        assert ast.get_docstring(tree), path
        assert code_lines(tree, text) <= 300, f"{path} has {code_lines(tree, text)} lines of code"
        if any(isinstance(part, ast.FunctionDef | ast.ClassDef) for part in tree.body):
            assert "from __future__ import annotations" in text, path
        functions = [part for part in ast.walk(tree) if isinstance(part, ast.FunctionDef)]
        long += [
            f"{path.name}: {part.name}" for part in functions if code_lines(part, text) > 41
        ]  # with its first line
    assert len(long) <= 6, long


def code_lines(tree, text):
    """Lines of code: without blank ones, comments and docstrings; of a function its body and `def`."""
    documents = {
        line
        for part in ast.walk(tree)
        if isinstance(part, ast.FunctionDef | ast.ClassDef | ast.Module) and ast.get_docstring(part)
        for line in range(part.body[0].lineno, part.body[0].end_lineno + 1)
    }
    lines = text.splitlines()
    first, last = 1, len(lines)
    if isinstance(tree, ast.FunctionDef):
        first, last = tree.body[0].lineno, tree.end_lineno
    code = [line for line in range(first, last + 1) if line not in documents and lines[line - 1].strip()]
    return sum(not lines[line - 1].strip().startswith("#") for line in code) + isinstance(tree, ast.FunctionDef)


def test_imports_go_one_way():
    """No package imports one that imports it; and nothing below drawing knows drawing."""
    above = {}
    for path in (ROOT / "uavlab").rglob("*.py"):
        own = path.relative_to(ROOT / "uavlab").parts[0].removesuffix(".py")
        for part in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(part, ast.ImportFrom) and (part.module or "").startswith("uavlab"):
                parts = part.module.split(".")
                names = [parts[1]] if len(parts) > 1 else [alias.name for alias in part.names]
                above.setdefault(own, set()).update(set(names) - {own, "__version__"})

    def reached(name, seen=()):
        assert name not in seen, f"a circle: {' → '.join((*seen, name))}"
        for other in above.get(name, ()):
            reached(other, (*seen, name))

    for name in above:
        reached(name)


def rows_of(table):
    return [[cell.strip() for cell in row.strip("|").split("|")] for row in table.strip().splitlines()]


def table_after(heading, text):
    section = text.split(heading, 1)[1]
    return rows_of(re.search(r"(?:^\|.*\|\n)+", section, re.MULTILINE)[0])[2:]


def test_readme_names_each_notebook_and_its_exercises():
    rows = table_after("## The notebooks", README)
    sources = sorted(path.stem for path in (ROOT / "notebooks/src").glob("*.py"))
    assert [re.search(r"\(notebooks/(.+)\.ipynb\)", row[0])[1] for row in rows] == sources
    for row, stem in zip(rows, sources, strict=True):
        solved = ROOT / f"notebooks/src/solutions/{stem}_exercises.py"
        if not solved.exists():
            assert row[2] == ""
            continue
        count, link = re.fullmatch(r"\[(\d+)\]\((.+)\)", row[2]).groups()
        assert (ROOT / link).exists()
        assert int(count) == len(re.findall(r"^exercises\.check\(", solved.read_text(encoding="utf-8"), re.MULTILINE))


def test_readme_names_each_module_and_planner():
    rows = table_after("## The library", README)
    named = {name for row in rows for name in re.findall(r"`uavlab\.(\w+)`", row[0])}
    assert named == {*PACKAGES, *ALONE, "exercises"}
    (planners,) = [row[1] for row in rows if "`uavlab.planners`" in row[0]]
    face = set(importlib.import_module("uavlab.planners").__all__)
    rest = {"Comparison", "flight_conditions", "hazard_price", "potential_forces", "repare_price", "repulsion"}
    assert set(re.findall(r"`(\w+)`", planners)) - {"Route"} == face - rest


def test_readme_s_program_runs(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (program,) = re.findall(r"```python\n(.*?)```", README, re.DOTALL)
    exec(compile(program, "README.md", "exec"), {})
    assert {path.name for path in tmp_path.iterdir()} >= {"profile.png", "route.csv"}
    assert "per 1 000" in capsys.readouterr().out


def test_the_guide_names_parameters_that_are_there():
    used = {
        parameter
        for thing in PUBLIC.values()
        for one in [thing, *filter(inspect.isfunction, (getattr(m, "__func__", m) for m in vars(thing).values()))]
        if inspect.isfunction(one) or (inspect.isclass(one) and not issubclass(one, Exception))
        for parameter in inspect.signature(one).parameters
    } | {field for thing in PUBLIC.values() for field in dir(thing)}
    for row in table_after("## Names", GUIDE):
        for name in re.findall(r"`(\w+)`", row[0]):
            assert name in used, name


def test_the_guide_s_recipes_name_files_that_are_there():
    made_up = ("rrt_star", "17_name", "chapter17", "NN", "city/name.py", "test_name.py", "name.py")
    for path in re.findall(r"`((?:uavlab|tests|notebooks|planners|city)/[\w/.]+\.(?:py|md))`", GUIDE):
        if not any(part in path for part in made_up):
            assert (ROOT / path).exists() or (ROOT / "uavlab" / path).exists(), path


def test_one_version_everywhere():
    citation = re.search(r"^version: (.+)$", (ROOT / "CITATION.cff").read_text(), re.MULTILINE)[1]
    changes = re.search(r"^## (\d+\.\d+\.\d+)", (ROOT / "CHANGELOG.md").read_text(), re.MULTILINE)[1]
    assert uavlab.__version__ == citation == changes


def test_the_environment_has_what_the_package_asks_for():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    pinned = {line.split("==")[0] for line in (ROOT / "environment.txt").read_text().splitlines() if "==" in line}
    groups = project["optional-dependencies"]
    asked = [
        *project["dependencies"],
        *(one for name in groups if name not in ("bench", "sim") for one in groups[name]),
    ]
    assert {re.split("[>=;]", one)[0] for one in asked if not one.startswith("uavlab[")} == pinned
