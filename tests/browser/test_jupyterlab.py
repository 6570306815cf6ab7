"""JupyterLab opens the first notebook and runs it from top to bottom, as a student does."""

import json
import os
import re
import subprocess
import sys
import time
from pathlib import Path

import nbformat
import pytest
from pictures import share_of_hue

from uavlab.city import table1_city

NOTEBOOK = Path(__file__).parents[2] / "notebooks" / "00_start_here.ipynb"
SLIDERS = """\
from uavlab import plot

def draw(wind):
    return plot.lines([0, 1, 2], {"offset": [0, wind, 2 * wind]}, "time [s]", "offset [m]", y_range=(0, 20))

plot.sliders(draw, wind=[0, 3, 6, 9], labels={"wind": "wind [m/s]"}, progress=False)"""


@pytest.fixture
def course(tmp_path):
    """A folder with the notebook as it is before it was run, and sliders as its last cell."""
    folder = tmp_path / "course"
    folder.mkdir()
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    for cell in notebook.cells:
        if cell.cell_type == "code":
            cell.outputs, cell.execution_count = [], None
    notebook.cells.append(nbformat.v4.new_code_cell(SLIDERS))
    nbformat.write(notebook, folder / NOTEBOOK.name)
    return folder


@pytest.fixture
def lab(course, tmp_path):
    """Address of a JupyterLab on that folder, with settings of its own."""
    environment = os.environ | {
        name: str(tmp_path / name.lower())
        for name in ("JUPYTER_CONFIG_DIR", "JUPYTER_DATA_DIR", "JUPYTER_RUNTIME_DIR", "IPYTHONDIR")
    }
    log = tmp_path / "jupyter.log"
    command = [sys.executable, "-m", "jupyter", "lab", "--no-browser", "--ServerApp.port=0", "--allow-root"]
    command += ["--ServerApp.ip=127.0.0.1", "--IdentityProvider.token=course", f"--ServerApp.root_dir={course}"]
    with open(log, "w") as file:
        server = subprocess.Popen(command, env=environment, stdout=file, stderr=file)
    try:
        yield address(server, log)
    finally:
        server.terminate()
        server.wait(timeout=30)


def address(server, log):
    """The server's address, from its log, once it listens."""
    for _ in range(240):
        found = re.search(r"http://127\.0\.0\.1:\d+/", log.read_text())
        if found and "is running at" in log.read_text():
            return found[0]
        assert server.poll() is None, log.read_text()
        time.sleep(0.25)
    raise AssertionError(log.read_text())


def code_cells(course):
    """The code cells as they are saved; none while JupyterLab is just writing the file."""
    try:
        notebook = json.loads((course / NOTEBOOK.name).read_text(encoding="utf-8"))
    except json.JSONDecodeError:
        return []
    return [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]


def test_run_all_runs_every_cell_and_draws_the_scene(browser, lab, course, picture_of):
    page = browser.new_page(viewport={"width": 1200, "height": 1000})
    page.goto(f"{lab}lab/tree/{NOTEBOOK.name}?token=course")
    page.get_by_role("heading", name="Start here").first.wait_for(timeout=120_000)
    page.wait_for_selector("text=Python 3 (ipykernel)")
    page.get_by_role("menuitem", name="Run", exact=True).click()
    page.get_by_text("Run All Cells", exact=True).click()
    for _ in range(240):
        page.wait_for_timeout(1000)
        page.keyboard.press("Control+s")
        cells = code_cells(course)
        if cells and all(cell["execution_count"] for cell in cells):
            break
    code = [cell for cell in nbformat.read(NOTEBOOK, as_version=4).cells if cell.cell_type == "code"]
    assert [cell["execution_count"] for cell in cells] == list(range(1, len(code) + 2))
    assert not [output for cell in cells for output in cell["outputs"] if output["output_type"] == "error"]
    frame = page.locator(".uavlab-scene iframe").first
    frame.scroll_into_view_if_needed()
    frame.element_handle().content_frame().wait_for_selector("body[data-ready=yes]", timeout=60_000)
    page.wait_for_timeout(1500)
    picture = picture_of(frame)
    for building in table1_city().buildings[:3]:
        assert share_of_hue(picture, building.color) > 0.003, building.name
    picture_of(page, "-lab")

    sliders = page.locator(".uavlab-sliders").last
    sliders.scroll_into_view_if_needed()
    cell = page.locator(".jp-Notebook-cell", has=page.locator(".uavlab-sliders")).last
    for key, frame in (("End", 3), ("ArrowLeft", 2), ("Home", 0)):
        sliders.get_by_role("slider", name="wind").press(key)
        sliders.locator(f'canvas[data-frame="{frame}"]').wait_for(timeout=10_000)
        assert sliders.locator("output").inner_text() == f"{3 * frame} m/s"
    assert cell.locator("canvas").get_attribute("aria-label").endswith("wind 0 m/s")
    picture_of(page, "-lab-sliders")
    page.close()
