"""A notebook that was run as one HTML page that works offline: scenes and sliders live, equations typeset.

MathJax 3 comes once from the npm registry and lies beside the pages; nothing else is outside of a page, and nothing is
asked from a network when it is read.
"""

import base64
import html
import shutil
import subprocess
import tarfile
import tempfile
from pathlib import Path

from nbconvert import HTMLExporter
from nbformat import NotebookNode

from uavlab.plot.pictures import quantised

MATHJAX = "mathjax@3.2.2"
SCRIPT = "tex-svg-full.js"
TEMPLATE = """{% extends 'lab/index.html.j2' %}
{% block html_head_js_requirejs %}{% endblock %}
{% block html_head_js_mermaidjs %}{% endblock %}
{% block jupyter_widgets %}{% endblock %}
{% block html_head_js_mathjax %}
<script>
MathJax = {tex: {inlineMath: [["$", "$"], ["\\\\(", "\\\\)"]], displayMath: [["$$", "$$"], ["\\\\[", "\\\\]"]],
                 processEscapes: true, processEnvironments: true},
           options: {skipHtmlTags: ["script", "noscript", "style", "textarea", "pre", "code", "svg", "iframe"]}};
</script>
<script async src="mathjax/tex-svg-full.js"></script>
{% endblock %}
"""


def export(notebook: NotebookNode, name: str, folder: Path) -> Path:
    """Write a notebook with its live outputs as a page into a folder, with MathJax beside it."""
    folder.mkdir(parents=True, exist_ok=True)
    fetch_mathjax(folder / "mathjax")
    page, _ = HTMLExporter(raw_template=TEMPLATE, template_name="lab").from_notebook_node(
        described(notebook), {"metadata": {"name": name}}
    )
    path = folder / f"{name}.html"
    path.write_text(page, encoding="utf-8")
    return path


def described(notebook: NotebookNode) -> NotebookNode:
    """The notebook with each picture small, and in HTML, with its alternative text; links lead to the other pages."""
    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            cell.source = cell.source.replace(".ipynb)", ".html)")
        for output in cell.get("outputs", []):
            data = output.get("data", {})
            if "image/png" in data and "text/html" not in data:
                picture = base64.b64encode(quantised(base64.b64decode(data.pop("image/png")))).decode()
                words = html.escape(output.metadata.get("image/png", {}).get("alt", ""))
                data["text/html"] = f'<img alt="{words}" src="data:image/png;base64,{picture}">'
    notebook.cells = [cell for cell in notebook.cells if cell.source.strip()]
    return notebook


def fetch_mathjax(folder: Path) -> None:
    """MathJax's script from its npm package, once."""
    if (folder / SCRIPT).exists():
        return
    if shutil.which("npm") is None:
        raise SystemExit("npm is needed for the equations of exported pages: install Node.js, and run this again")
    with tempfile.TemporaryDirectory() as place:
        subprocess.run(["npm", "pack", "--silent", MATHJAX], cwd=place, check=True, stdout=subprocess.DEVNULL)
        (archive,) = Path(place).glob("*.tgz")
        with tarfile.open(archive) as packed:
            script = packed.extractfile(f"package/es5/{SCRIPT}")
            assert script is not None
            content = script.read()
    folder.mkdir(exist_ok=True)
    (folder / SCRIPT).write_bytes(content)
