"""The builder: what it strips, what it calls stale, how a solution becomes an exercise."""

import base64
import importlib.util
import io
from pathlib import Path

import jupytext
import nbformat
import pytest

from uavlab import plot
from uavlab.trial import read_findings

NOTEBOOKS = Path(__file__).parents[2] / "notebooks"
SOURCE = '''# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # A question

# %%
def double(x):
    """Twice x."""
    ### BEGIN SOLUTION
    return 2 * x
    ### END SOLUTION

# %% tags=["solution"]
print("why it is so")

# %%
print(double(4))

# %%
### BEGIN SOLUTION
four = double(2)
choice = "b"
### END SOLUTION

# %% tags=["check"]
assert choice == "b"
'''


@pytest.fixture
def build(tmp_path, monkeypatch):
    """The builder, working on a folder with one solution of its own."""
    monkeypatch.syspath_prepend(NOTEBOOKS)
    spec = importlib.util.spec_from_file_location("notebooks_build", NOTEBOOKS / "build.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    monkeypatch.setattr(module, "HERE", tmp_path)
    monkeypatch.setattr(module, "SOURCES", tmp_path / "src")
    source = tmp_path / "src" / "solutions" / "01_doubling.py"
    source.parent.mkdir(parents=True)
    source.write_text(SOURCE)
    return module


def run(build, monkeypatch, *arguments):
    monkeypatch.setattr("sys.argv", ["build.py", *arguments])
    return build.main()


def test_check_finds_what_is_stale_and_building_mends_it(build, tmp_path, monkeypatch, capsys):
    source = tmp_path / "src" / "solutions" / "01_doubling.py"
    assert run(build, monkeypatch, "--check") == 1
    assert "missing" in capsys.readouterr().out
    assert run(build, monkeypatch) == 0
    assert run(build, monkeypatch, "--check") == 0
    source.write_text(SOURCE.replace("double(4)", "double(5)"))
    assert run(build, monkeypatch, "--check") == 1
    assert "its cells differ from its source" in capsys.readouterr().out


def test_claims_are_measured_where_they_are_missing_and_their_chapter_is_built_again(
    build, tmp_path, monkeypatch, capsys
):
    (tmp_path / "src" / "15_the_papers_on_trial.py").write_text(SOURCE)
    run(build, monkeypatch)
    findings = read_findings(NOTEBOOKS / "trial.csv")
    asked = []
    monkeypatch.setattr(build, "run_trial", lambda **how: asked.append(how) or findings)
    monkeypatch.setattr(build, "TRIAL", tmp_path / "trial.csv")
    assert run(build, monkeypatch, "--check") == 1
    assert "stale: notebooks/trial.csv" in capsys.readouterr().out
    run(build, monkeypatch)
    assert asked == [{"full": True, "jobs": -1}]
    assert "running 15_the_papers_on_trial.py" in capsys.readouterr().out
    assert (tmp_path / "trial.csv").read_bytes() == (NOTEBOOKS / "trial.csv").read_bytes()
    run(build, monkeypatch)
    assert len(asked) == 1
    assert "running" not in capsys.readouterr().out


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda nb: nb.cells[-1].update(execution_count=None), "not run from top to bottom"),
        (lambda nb: nb.metadata.update(widgets={"state": {}}), "has outputs or metadata that don't belong"),
        (lambda nb: nb.cells[-1].metadata.update(execution={"iopub.execute_input": "now"}), "don't belong"),
        (
            lambda nb: nb.cells[-1].outputs.append(nbformat.v4.new_output("error", ename="E", evalue="", traceback=[])),
            "a cell failed",
        ),
    ],
)
def test_check_sees_a_notebook_that_was_tampered_with(build, tmp_path, monkeypatch, capsys, change, reason):
    run(build, monkeypatch)
    path = tmp_path / "solutions" / "01_doubling.ipynb"
    notebook = nbformat.read(path, as_version=4)
    change(notebook)
    nbformat.write(notebook, path)
    capsys.readouterr()
    assert run(build, monkeypatch, "--check") == 1
    assert reason in capsys.readouterr().out


def test_check_sees_an_edited_exercise_and_an_orphan(build, tmp_path, monkeypatch, capsys):
    run(build, monkeypatch)
    exercise = tmp_path / "exercises" / "01_doubling.ipynb"
    exercise.write_text(exercise.read_text().replace("A question", "Another one"))
    (tmp_path / "02_orphan.ipynb").write_text("{}")
    capsys.readouterr()
    assert run(build, monkeypatch, "--check") == 1
    printed = capsys.readouterr().out
    assert "its exercise differs" in printed
    assert "no source: " in printed


def test_exercise_has_no_answers(build, tmp_path, monkeypatch):
    run(build, monkeypatch)
    exercise = nbformat.read(tmp_path / "exercises" / "01_doubling.ipynb", as_version=4)
    text = "\n".join(cell.source for cell in exercise.cells)
    assert "raise NotImplementedError" in text
    assert "return 2 * x" not in text
    assert "why it is so" not in text
    assert "SOLUTION" not in text
    assert exercise.cells[-2].source == "choice = ...  # your answer"


def test_code_that_only_checks_or_draws_is_collapsed(build, tmp_path, monkeypatch):
    run(build, monkeypatch)
    cells = nbformat.read(tmp_path / "solutions" / "01_doubling.ipynb", as_version=4).cells
    assert [cell.metadata.get("jupyter", {}).get("source_hidden", False) for cell in cells] == 5 * [False] + [True]
    run(build, monkeypatch, "--html")
    page = (tmp_path / "html" / "01_doubling.html").read_text(encoding="utf-8")
    assert page.count('<details class="uavlab-folded"><summary>Code that checks</summary>') == 1
    assert page.count('<details class="uavlab-folded">') == 1


def test_building_twice_gives_the_same_bytes(build, tmp_path, monkeypatch):
    run(build, monkeypatch)
    first = (tmp_path / "solutions" / "01_doubling.ipynb").read_bytes()
    run(build, monkeypatch, "--all")
    assert (tmp_path / "solutions" / "01_doubling.ipynb").read_bytes() == first


def test_scenes_are_kept_as_their_still_picture(build):
    figure = plot.bars({"a": 1.0}, "length [m]")
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png")
    for kind in ("scene", "sliders"):
        output = nbformat.v4.new_output(
            "display_data",
            data={
                "text/html": f'<div class="uavlab-{kind}">…</div>',
                "image/png": base64.b64encode(buffer.getvalue()).decode(),
            },
            metadata={"image/png": {"alt": "a bar"}},
        )
        stored = build.kept(output)
        assert list(stored.data) == ["image/png"]
        assert stored.metadata == {"image/png": {"alt": "a bar"}}
        small = base64.b64decode(stored.data["image/png"])
        assert len(small) < len(buffer.getvalue())
        assert small[25] == 3  # a palette
    slider = nbformat.v4.new_output("display_data", data={"application/vnd.jupyter.widget-view+json": {}})
    assert build.kept(slider) is None


def test_a_picture_without_words_is_stale(build):
    silent = nbformat.v4.new_output("display_data", data={"image/png": "iVBOR"})
    spoken = nbformat.v4.new_output("display_data", data={"image/png": "iVBOR"}, metadata={"image/png": {"alt": "a"}})
    assert (build.is_silent(silent), build.is_silent(spoken)) == (True, False)
    assert not build.is_silent(nbformat.v4.new_output("stream", text="a"))


@pytest.mark.parametrize("source", sorted((NOTEBOOKS / "src").rglob("*.py")), ids=lambda path: path.stem)
def test_no_cell_is_longer_than_twenty_lines(source):
    cells = [cell for cell in jupytext.read(source).cells if cell.cell_type == "code"]
    assert max(len(cell.source.splitlines()) for cell in cells) <= 20


def test_readme_names_every_notebook_and_the_commands_of_ci():
    readme = (NOTEBOOKS.parent / "README.md").read_text(encoding="utf-8")
    for notebook in [*NOTEBOOKS.glob("*.ipynb"), *NOTEBOOKS.glob("exercises/*.ipynb")]:
        assert notebook.relative_to(NOTEBOOKS.parent).as_posix() in readme
    test_command = "pip install -r environment.txt && pytest"
    assert f"\n{test_command}\n" in readme
    assert f"\n{test_command}\n" in (NOTEBOOKS.parent / ".ci" / "run").read_text(encoding="utf-8")
