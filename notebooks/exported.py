"""A notebook that was run as one HTML page that works offline: scenes and sliders live, equations typeset.

Everything is inside of the page: nothing lies beside it, and nothing is asked from a network when it is read.
"""

import base64
import html
import re
from pathlib import Path

import nbformat
from equations import Equations
from jinja2 import pass_context
from jinja2.runtime import Context
from nbconvert import HTMLExporter
from nbconvert.filters.markdown_mistune import IPythonRenderer, MarkdownWithMath, MathInlineParser
from nbformat import NotebookNode

from uavlab.plot.pictures import quantised

TEMPLATE = """{% extends 'lab/index.html.j2' %}
{% block html_head_js_requirejs %}{% endblock %}
{% block html_head_js_mermaidjs %}{% endblock %}
{% block html_head_js_mathjax %}{% endblock %}
{% block jupyter_widgets %}{% endblock %}
{% block html_head_css %}<style>{{ equations.style }}{{ style }}</style>{% endblock %}
{% block input_group %}{% set folded = cell.metadata.tags | folded %}
{% if folded %}<details class="uavlab-folded"><summary>{{ folded }}</summary>{{ super() }}</details>
{% else %}{{ super() }}{% endif %}{% endblock %}
{% block data_latex scoped %}{{ output.data['text/latex'] | markdown2html }}{% endblock %}
{% block body_footer %}{{ equations.letters() }}{{ super() }}{% endblock %}
"""
GUIDE = "guide"
"""Tag of cells that tell a student how to make a project; they aren't part of it."""
FOLDED = {"check": "Code that checks", "figure": "Code of the figure", GUIDE: "Code that prepares"}
"""Tags of cells whose code is out of the reader's way, and what stands in its place."""
QUESTION = re.compile(r"\*\*Question (\d+)\.")
NO_ANSWER = re.compile(r"\banswer\s*\d*|\b(?:todo|tbd|xxx)\b|[\W_]", re.IGNORECASE)
"""What is no answer yet: its heading, in whatever form, a note to oneself, and signs without a letter or digit."""
PROJECT = Path(__file__).parent / "16_your_own_city.ipynb"
OWN = re.compile(r"^TITLE, NAME = ", re.MULTILINE)
"""In the one cell of code that is a student's own."""
STYLE = """
.uavlab-folded > summary { margin-left: 64px; color: var(--jp-ui-font-color2); cursor: pointer; font-size: 12px }
.jp-InputArea-editor, .jp-OutputArea-output { overflow-x: auto }
.jp-MarkdownOutput blockquote { border-left: 4px solid #0072b2; background: #0072b210; padding: 6px 12px }
.jp-MarkdownOutput blockquote > :last-child { margin-bottom: 0 }
.jp-RenderedHTMLCommon :is(td, th):first-child, .jp-RenderedHTMLCommon caption { text-align: left }
"""
EQUATION = re.compile(r"<uavlab-(inline|display)>(.*?)</uavlab-\1>", re.DOTALL)


def export(notebook: NotebookNode, name: str, folder: Path, prompts: bool = True) -> Path:
    """Write a notebook with its live outputs as a page into a folder; `ValueError` names equations that aren't TeX."""
    folder.mkdir(parents=True, exist_ok=True)
    exporter = Exporter(exclude_input_prompt=not prompts, exclude_output_prompt=not prompts)
    page, _ = exporter.from_notebook_node(described(notebook), {"metadata": {"name": name}})
    path = folder / f"{name}.html"
    path.write_text(page, encoding="utf-8")
    return path


def handed_in(path: Path) -> tuple[Path, list[str]]:
    """Write a project as it was saved as a page beside it; the page, and what a teacher would miss in it.

    Cells that explain or check are left out, and code is folded. `ValueError` says what isn't run.
    """
    if not path.is_file():
        raise ValueError(f"there is no file {path}")
    try:
        notebook = nbformat.read(path, as_version=4)
    except (ValueError, KeyError, AttributeError):
        raise ValueError(f"{path.name} is no notebook (.ipynb)") from None
    code = [cell for cell in notebook.cells if cell.cell_type == "code" and cell.source.strip()]
    if any(output.output_type == "error" for cell in code for output in cell.outputs):
        raise ValueError(f"a cell of {path.name} failed: mend it, Restart Kernel and Run All Cells, save")
    if [cell.execution_count for cell in code] != list(range(1, len(code) + 1)):
        raise ValueError(f"{path.name} wasn't run from top to bottom: Restart Kernel and Run All Cells, save")
    outputs = [output.get("data", {}) for cell in code for output in cell.outputs]
    if any(str(data.get("text/plain", "")).startswith("<Scene") and "text/html" not in data for data in outputs):
        raise ValueError(f"the scene of {path.name} is a still picture yet: Restart Kernel and Run All Cells, save")
    missing = [*unanswered(notebook), *changed(notebook)]
    notebook.cells = [cell for cell in notebook.cells if not {GUIDE, "check"} & set(cell.metadata.get("tags", []))]
    for cell in notebook.cells:
        if cell.cell_type == "code" and not set(FOLDED) & set(cell.metadata.get("tags", [])):
            cell.metadata["tags"] = [*cell.metadata.get("tags", []), "code"]
    if missing:
        words = "\n".join(f"- {html.escape(what)}" for what in missing)
        notebook.cells.append(nbformat.v4.new_markdown_cell(f"**Not as the chapter asks**\n\n{words}"))
    return export(notebook, path.stem, path.parent, prompts=False), missing


def unanswered(notebook: NotebookNode) -> list[str]:
    """Questions that no text follows, whatever became of the cell that was made for it."""
    own = [cell for cell in notebook.cells if GUIDE not in cell.metadata.get("tags", [])]
    asked = [(at, found[1]) for at, cell in enumerate(own) if (found := QUESTION.search(cell.source))]
    blank = []
    for at, number in asked:
        text = []
        for cell in own[at + 1 :]:
            if cell.cell_type == "code" or QUESTION.search(cell.source) or cell.source.startswith("#"):
                break
            text.append(cell.source)
        if not NO_ANSWER.sub("", " ".join(text)):
            blank.append(f"not written yet: Answer {number}")
    if not asked:
        return []
    known = [number for cell in read_project() for number in QUESTION.findall(cell.source)]
    return blank + [f"Question {n} is gone" for n in known if n not in [number for _, number in asked]]


def changed(notebook: NotebookNode) -> list[str]:
    """How the code of a project differs from that of its chapter, but for the cell of the settings."""
    if not any(QUESTION.search(cell.source) for cell in notebook.cells):
        return []

    def sources(cells: list[NotebookNode]) -> list[str]:
        return [
            c.source.strip() for c in cells if c.cell_type == "code" and c.source.strip() and not OWN.search(c.source)
        ]

    made, theirs = sources(read_project()), sources(notebook.cells)
    other = [source for source in theirs if source not in made]
    changed_heads, heads = ({source.splitlines()[0] for source in some} for some in (other, theirs))
    gone = [source.splitlines()[0] for source in made if source.splitlines()[0] not in heads]
    return [f"code that isn't the chapter's: {head}" for head in sorted(changed_heads)] + [
        f"code of the chapter that is gone: {head}" for head in gone
    ]


def read_project() -> list[NotebookNode]:
    """The cells of the project as the course gives it."""
    return list(nbformat.read(PROJECT, as_version=4).cells)


def described(notebook: NotebookNode) -> NotebookNode:
    """The notebook with each picture small, and in HTML, with its alternative text; links lead to the other pages."""
    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            cell.source = cell.source.replace(".ipynb)", ".html)")
        for output in cell.get("outputs", []):
            data = output.get("data", {})
            if "text/markdown" in data:
                data["text/markdown"] = data["text/markdown"].replace(".ipynb)", ".html)")
            if "image/png" in data and "text/html" not in data:
                picture = base64.b64encode(quantised(base64.b64decode(data.pop("image/png")))).decode()
                words = html.escape(output.metadata.get("image/png", {}).get("alt", ""))
                data["text/html"] = f'<img alt="{words}" src="data:image/png;base64,{picture}">'
    notebook.cells = [cell for cell in notebook.cells if cell.source.strip()]
    return notebook


class Exporter(HTMLExporter):
    """Jupyter's exporter of one page, with equations typeset in Markdown."""

    def __init__(self, **settings: bool) -> None:
        self.equations = Equations()
        super().__init__(raw_template=TEMPLATE, template_name="lab", **settings)
        self.environment.globals |= {"equations": self.equations, "style": STYLE}
        self.environment.filters["folded"] = lambda tags: next(
            ((FOLDED | {"code": "Code"})[tag] for tag in tags or () if tag in FOLDED or tag == "code"), ""
        )

    @pass_context
    def markdown2html(self, context: Context, source: str) -> str:
        """Markdown as HTML; `ValueError` names the notebook, the cell and the equation."""
        renderer = Renderer(escape=False, attachments=context["cell"].get("attachments", {}))
        markup = MarkdownWithMath(renderer, inline=MathParser(hard_wrap=False)).render(source)
        try:
            return EQUATION.sub(lambda one: self.equations.typeset(html.unescape(one[2]), one[1] == "display"), markup)
        except ValueError as problem:
            number = next(at for at, cell in enumerate(context["nb"].cells, 1) if cell is context["cell"])
            raise ValueError(f"{context['resources']['metadata']['name']}, cell {number}: {problem}") from None


class MathParser(MathInlineParser):
    """Jupyter's, with $ close to the equation, no digit behind, no code inside: amounts in dollars are no equation."""

    SPECIFICATION = MathInlineParser.SPECIFICATION | {
        "inline_math_tex": r"(?<![$\\])\$(?!\s)(?P<math_inline_tex>(?:\\.|[^$\\`])+?)(?<!\s)\$(?![$\d])"
    }


class Renderer(IPythonRenderer):
    """Jupyter's, with equations between marks: headings' anchors and alternative texts are made from their TeX."""

    def inline_math(self, body: str) -> str:
        return f"<uavlab-inline>{html.escape(body)}</uavlab-inline>"

    def block_math(self, body: str) -> str:
        return f"<uavlab-display>{html.escape(body)}</uavlab-display>"

    def latex_environment(self, name: str, body: str) -> str:
        return self.block_math(f"\\begin{{{name}}}{body}\\end{{{name}}}")
