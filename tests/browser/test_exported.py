"""A notebook as a page: equations typeset, scene and sliders alive, words for pictures, nothing asked from outside."""

import importlib.util
import shutil
from pathlib import Path

import jupytext
import pytest
from opened import opened

NOTEBOOKS = Path(__file__).parents[2] / "notebooks"
SOURCE = """
# %% [markdown]
# # A page
#
# An equation, $a^2 + b^2 = c^2$, and one more:
#
# $$ F = \\\\tfrac12 \\\\rho C S V^2 \\\\tag{1} $$

# %%
from uavlab import plot, scene
from uavlab.city import table1_city
from uavlab.planners import astar

city = table1_city(cell=4.0)
route = astar(city, (90, 18, 30), (20, 75, 75))
plot.profile(city, route)

# %%
scene.show(city, route)

# %%
plot.sliders(lambda height: plot.section(city, height), height=[10, 30, 50], progress=False)
""".replace("\\\\\\\\", "\\\\")


@pytest.fixture(scope="module")
def page_of_notebook(tmp_path_factory):
    if shutil.which("npm") is None:
        pytest.skip("no npm on this machine: install Node.js, which brings the equations' script")
    folder = tmp_path_factory.mktemp("html")
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(NOTEBOOKS)
        spec = importlib.util.spec_from_file_location("exporting_build", NOTEBOOKS / "build.py")
        build = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(build)
        return build.export(build.run(jupytext.reads(SOURCE, fmt="py:percent")), "a_page", folder)


def test_an_exported_notebook_is_alive_offline(browser, page_of_notebook, picture_of):
    page = browser.new_page(viewport={"width": 1000, "height": 800})
    errors = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.on("console", lambda said: errors.append(said.text) if said.type == "error" else None)
    page.on("request", lambda one: errors.append(one.url) if one.url.startswith("http") else None)
    page.goto(page_of_notebook.as_uri())
    page.wait_for_selector("mjx-container[display=true]", timeout=60_000)
    page.wait_for_timeout(500)
    assert page.locator("mjx-container").count() == 2
    assert page.locator("mjx-merror").count() == 0
    assert page.locator("mjx-container[display=true]").bounding_box()["height"] > 20
    silent = "[...document.querySelectorAll('img')].filter(image => !image.alt).length"
    assert page.evaluate(silent) == 0
    picture_of(page)
    page.close()
    assert errors == []


def test_its_scene_and_its_sliders_can_be_used(browser, page_of_notebook):
    assert opened(browser, page_of_notebook) == []
