"""A notebook as a page: equations typeset, scene and sliders alive, words for pictures, all of it in one file."""

import importlib.util
from pathlib import Path

import jupytext
import pytest
from opened import opened

NOTEBOOKS = Path(__file__).parents[2] / "notebooks"
SOURCE = r"""
# %% [markdown]
# # A page
#
# An equation, $a^2 + b^2 = c^2$, and one more:
#
# $$ F = \tfrac12 \rho C S V^2 \tag{1} $$
#
# ## Where $\xi < \sigma$
#
# | what | as |
# |---|---|
# | a norm | $\lVert x \rVert = \sqrt{x_1^2 + x_2^2 + x_3^2 + x_4^2 + x_5^2 + x_6^2}$ and what more there is to say |
#
# \begin{align} a &= b + c + d + e + f + g + h + i + j + k + l + m + n + o + p + q + r + s \tag{2} \end{align}
#
# From \$1 to \$2, from $5 to $6; `$HOME` and `$x$`.
#
# ```
# $$ code $$ and $code$
# ```

# %%
from uavlab import plot, scene
from uavlab.city import table1_city
from uavlab.planners import astar

city = table1_city(cell=4.0)
route = astar(city, (90, 18, 30), (20, 75, 75))
print("$y$ and $$z$$")
plot.profile(city, route)

# %%
scene.show(city, route)

# %%
plot.sliders(lambda height: plot.section(city, height), height=[10, 30, 50], progress=False)
"""
TEX = [
    r"a^2 + b^2 = c^2",
    r"F = \tfrac12 \rho C S V^2 \tag{1}",
    r"\xi < \sigma",
    r"\lVert x \rVert = \sqrt{x_1^2 + x_2^2 + x_3^2 + x_4^2 + x_5^2 + x_6^2}",
    r"\begin{align} a &= b + c + d + e + f + g + h + i + j + k + l + m + n + o + p + q + r + s \tag{2} \end{align}",
]
EQUATIONS = """
[...document.querySelectorAll('mjx-container')].map(equation => {
  const ink = [...equation.querySelectorAll('use')].map(one => one.getBoundingClientRect());
  return {tex: equation.querySelector('math').getAttribute('alttext'),
          letters: ink.length, blank: ink.filter(box => !(box.width * box.height)).length};
})
"""
TEXT = """
[...document.querySelectorAll('.jp-RenderedMarkdown')].map(part => {
  const text = part.cloneNode(true);
  text.querySelectorAll('mjx-container').forEach(one => one.remove());
  return text.textContent;
}).join(' ')
"""


@pytest.fixture(scope="module")
def page_of_notebook(tmp_path_factory):
    folder = tmp_path_factory.mktemp("html")
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(NOTEBOOKS)
        spec = importlib.util.spec_from_file_location("exporting_build", NOTEBOOKS / "build.py")
        build = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(build)
        return build.export(build.run(jupytext.reads(SOURCE, fmt="py:percent")), "a_page", folder)


@pytest.fixture
def page(browser, page_of_notebook):
    """The page, opened; it may ask for nothing but itself."""
    page = browser.new_page(viewport={"width": 1000, "height": 800})
    errors = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.on("console", lambda said: errors.append(said.text) if said.type == "error" else None)
    page.on("request", lambda one: errors.append(one.url) if not one.url.startswith("data:") else None)
    page.goto(page_of_notebook.as_uri())
    yield page
    page.close()
    assert errors == [page_of_notebook.as_uri()]


def test_equations_are_typeset_in_the_file(page, page_of_notebook, picture_of):
    assert page_of_notebook.read_text(encoding="utf-8").count("<mjx-container") == len(TEX)
    assert list(page_of_notebook.parent.iterdir()) == [page_of_notebook]
    equations = page.evaluate(EQUATIONS)
    assert [equation["tex"] for equation in equations] == TEX
    assert all(equation["letters"] and not equation["blank"] for equation in equations), equations
    assert page.locator("mjx-container[display]").first.bounding_box()["height"] > 20
    assert picture_of(page.locator("mjx-container").first).std() > 0.1
    spoken = page.locator("h2").aria_snapshot()
    assert "ξ" in spoken
    assert "σ" in spoken


def test_no_dollar_is_lost_and_no_tex_seen(page):
    text = page.evaluate(TEXT)
    assert "From $1 to $2, from $5 to $6; $HOME and $x$." in text
    assert "\\" not in text
    assert text.count("$") == 7 + 6
    assert "$y$ and $$z$$" in page.locator(".jp-OutputArea-output pre").first.inner_text()


def test_equations_stand_on_the_line_in_the_size_and_colour_of_the_text(page):
    page.add_style_tag(content=":root, body { --jp-content-font-color1: rgb(250, 240, 230); }")
    letter = page.locator("mjx-container use").first
    assert letter.evaluate("one => getComputedStyle(one).fill") == "rgb(250, 240, 230)"
    place = """p => { const range = document.createRange();
        range.selectNode(p.firstChild);
        const [text, a] = [range.getClientRects()[0], p.querySelector('use').getBoundingClientRect()];
        return [text.top, a.top, a.bottom, text.bottom, parseFloat(getComputedStyle(p).fontSize)]; }"""
    top, above, below, bottom, size = page.locator("p:has(mjx-container)").first.evaluate(place)
    assert top < above < below < bottom
    assert 0.35 * size < below - above < 0.65 * size


def test_on_a_phone_long_equations_are_scrolled_and_the_page_is_not(page, picture_of):
    in_table = page.locator("td svg")
    wide = in_table.bounding_box()["width"]
    page.set_viewport_size({"width": 390, "height": 800})
    assert in_table.bounding_box()["width"] == wide
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    long = page.locator("mjx-container[display]").nth(1)
    assert long.evaluate("one => one.getBoundingClientRect().right") <= 390
    assert long.evaluate("one => one.scrollWidth > one.clientWidth && getComputedStyle(one).overflowX == 'auto'")
    picture_of(page)


def test_an_exported_notebook_has_words_for_its_pictures(page):
    assert page.locator("img").count() > 0
    assert page.locator("img:not([alt]), img[alt='']").count() == 0


def test_its_scene_and_its_sliders_can_be_used(browser, page_of_notebook):
    assert opened(browser, page_of_notebook) == []
