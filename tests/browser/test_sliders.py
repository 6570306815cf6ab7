"""Figures with sliders in a real browser: what is dragged or keyed shows exactly its frame, and no more."""

import base64
import io

import numpy as np
import pytest
from PIL import Image

from uavlab import plot

WINDS, LOADS = [0, 3, 6, 9], [0.0, 0.5, 1.0]
PAGE = (
    '<!DOCTYPE html><meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>sliders</title>'
    "<style>:root{{color-scheme:light dark}}</style>{}"
)


def draw(wind, load):
    figure, axes = plot.new_figure(6.4, 3.0)
    x = np.linspace(0, 10, 200)
    for k in range(3):
        axes.plot(x, wind * np.sin(x * (1 + load) + k), label=f"k = {k}")
    axes.set(ylim=(-10, 10), title=f"{wind} m/s, {load} kg", xlabel="time [s]", ylabel="offset [m]")
    axes.legend(loc="upper right")
    return plot.finished(figure)


@pytest.fixture(scope="module")
def shown():
    labels = {"wind": "wind [m/s]", "load": "load [kg]"}
    return plot.sliders(
        draw, wind=WINDS, load=LOADS, labels=labels, start={"wind": 3}, title="offset over time", progress=False
    )


@pytest.fixture
def opened(browser, tmp_path):
    """Open pieces of HTML on one page; no script may fail, and nothing may be asked for."""
    contexts, errors = [], []

    def open_page(*pieces, **context):
        path = tmp_path / "sliders.html"
        path.write_text(PAGE.format("\n".join(pieces)), encoding="utf-8")
        contexts.append(browser.new_context(**{"viewport": {"width": 800, "height": 600}, **context}))
        page = contexts[-1].new_page()
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.on("console", lambda said: errors.append(said.text) if said.type in ("error", "warning") else None)
        page.on("request", lambda asked: errors.append(asked.url) if asked.url.startswith(("http", "ftp")) else None)
        page.goto(path.as_uri())
        return page

    yield open_page
    for context in contexts:
        context.close()
    assert errors == []


def figure_of(page, number=0):
    return page.locator(".uavlab-sliders").nth(number)


def wait_for(figure, frame):
    figure.locator(f'canvas[data-frame="{frame}"]').wait_for(timeout=10_000)


def seen(figure):
    """Pixels of the picture, (height, width, 4)."""
    address = figure.locator("canvas").evaluate("canvas => canvas.toDataURL()")
    return np.asarray(Image.open(io.BytesIO(base64.b64decode(address.partition(",")[2]))).convert("RGBA"))


def assert_shows(figure, shown, wind, load):
    """Picture, values and words are those of a frame."""
    number = WINDS.index(wind) * len(LOADS) + LOADS.index(load)
    wait_for(figure, number)
    frame = np.asarray(Image.open(io.BytesIO(shown.frames[number])).convert("RGBA"))
    assert np.array_equal(seen(figure), frame)
    words = [f"{wind:g} m/s", f"{load:g} kg"]
    assert figure.locator("output").all_inner_texts() == words
    assert [slider.get_attribute("aria-valuetext") for slider in figure.locator("input").all()] == words
    said = f"offset over time: wind {words[0]}, load {words[1]}"
    assert figure.get_by_role("img").get_attribute("aria-label") == said


def test_it_begins_with_the_frame_asked_for_without_a_kernel(opened, shown):
    page = opened(shown.html)
    assert_shows(figure_of(page), shown, 3, 0.0)
    assert page.locator("img").count() == 0
    assert "scripts" not in figure_of(page).inner_text()


def test_every_position_by_keyboard_shows_its_frame_to_the_pixel(opened, shown):
    figure = figure_of(opened(shown.html))
    wind, load = figure.get_by_role("slider", name="wind"), figure.get_by_role("slider", name="load")
    wind.press("Home")
    for number, speed in enumerate(WINDS):
        load.press("Home")
        for weight in LOADS:
            assert_shows(figure, shown, speed, weight)
            load.press("ArrowRight")
        if number < len(WINDS) - 1:
            wind.press("ArrowUp")
    wind.press("ArrowUp")  # stays at its end
    assert_shows(figure, shown, 9, 1.0)
    wind.press("ArrowLeft")
    assert_shows(figure, shown, 6, 1.0)


def test_dragging_shows_the_frames_on_the_way(opened, shown):
    page = opened(shown.html)
    figure = figure_of(page)
    wait_for(figure, 3)
    for name, ends in (("wind", (0, 9)), ("load", (0.0, 1.0))):
        box = figure.get_by_role("slider", name=name).bounding_box()
        middle = box["y"] + box["height"] / 2
        at = {"wind": 9, "load": 0.0}
        page.mouse.move(box["x"] + 8, middle)
        page.mouse.down()
        assert_shows(figure, shown, **{**at, name: ends[0]})
        page.mouse.move(box["x"] + box["width"] - 8, middle, steps=30)
        assert_shows(figure, shown, **{**at, name: ends[1]})
        page.mouse.up()
    assert_shows(figure, shown, 9, 1.0)


def test_the_last_position_wins_however_fast_it_is_dragged(opened, shown):
    """Each frame is unpacked on its own, and a large one may come after a small one that was asked for later."""
    figure = figure_of(opened(shown.html))
    wait_for(figure, 3)
    figure.evaluate("""root => {
        const [wind, load] = root.querySelectorAll("input");
        const set = (input, value) => { input.value = value; input.dispatchEvent(new Event("input")); };
        for (let i = 0; i < 4; i++) for (let j = 0; j < 3; j++) { set(wind, i); set(load, j); }
        set(load, 0); set(wind, 3); set(wind, 2);
    }""")
    assert_shows(figure, shown, 6, 0.0)
    figure.page.wait_for_timeout(500)
    assert_shows(figure, shown, 6, 0.0)


def test_two_on_a_page_are_independent_even_if_equal(opened, shown):
    other = plot.sliders(lambda a: draw(a, 0.25), a=[1, 2], progress=False)
    page = opened(shown.html, other.html, shown.html)
    first, second, third = (figure_of(page, number) for number in range(3))
    first.get_by_role("slider", name="wind").press("End")
    third.get_by_role("slider", name="load").press("End")
    second.get_by_role("slider").press("End")
    assert_shows(first, shown, 9, 0.0)
    assert_shows(third, shown, 3, 1.0)
    wait_for(second, 1)
    assert np.array_equal(seen(second)[..., :3], np.asarray(Image.open(io.BytesIO(other.frames[1])).convert("RGB")))
    assert second.locator("output").all_inner_texts() == ["2"]


def test_one_that_is_put_into_a_page_later_lives_too(opened, shown):
    """As JupyterLab does: as text, and then its scripts anew; those of the first mustn't run twice."""
    page = opened(shown.html)
    figure_of(page).get_by_role("slider", name="wind").press("End")
    assert_shows(figure_of(page), shown, 9, 0.0)
    page.evaluate(
        """html => {
            const place = document.body.appendChild(document.createElement("div"));
            place.innerHTML = html;
            for (const old of place.querySelectorAll("script")) {
                const script = document.createElement("script");
                for (const {name, value} of old.attributes) script.setAttribute(name, value);
                script.textContent = old.textContent;
                old.replaceWith(script);
            }
        }""",
        shown.html,
    )
    assert_shows(figure_of(page, 1), shown, 3, 0.0)
    figure_of(page, 1).get_by_role("slider", name="load").press("End")
    assert_shows(figure_of(page, 1), shown, 3, 1.0)
    assert_shows(figure_of(page, 0), shown, 9, 0.0)


def test_keys_of_a_slider_are_not_taken_by_the_page_around_it(opened, shown):
    """JupyterLab goes to another cell on arrow keys, slides to the next one; but it has to hear Ctrl+S."""
    page = opened(shown.html)
    page.evaluate("""() => {
        window.heard = [];
        document.addEventListener("keydown", event => window.heard.push(event.key));
    }""")
    slider = figure_of(page).get_by_role("slider", name="wind")
    for key in ("ArrowDown", "End", "PageUp", "Home", "Tab", "Control+ArrowRight"):
        slider.press(key)
    assert page.evaluate("heard") == ["Tab", "Control", "ArrowRight"]


def test_a_phone_shows_all_of_it(opened, shown, picture_of):
    page = opened(shown.html, viewport={"width": 360, "height": 480}, has_touch=True, is_mobile=True)
    figure = figure_of(page)
    assert_shows(figure, shown, 3, 0.0)
    assert page.evaluate("document.documentElement.scrollWidth") <= 360
    canvas = figure.locator("canvas").bounding_box()
    assert canvas["width"] == pytest.approx(344, abs=2)
    assert canvas["height"] / canvas["width"] == pytest.approx(300 / 640, abs=0.01)
    for slider in figure.locator("input").all():
        box = slider.bounding_box()
        assert box["height"] >= 24  # for a finger
        assert box["width"] > 200
    box = figure.get_by_role("slider", name="wind").bounding_box()
    page.touchscreen.tap(box["x"] + box["width"] - 6, box["y"] + box["height"] / 2)
    assert_shows(figure, shown, 9, 0.0)
    picture_of(page)


def test_labels_are_read_in_the_dark(opened, shown, picture_of):
    page = opened(shown.html, color_scheme="dark")
    assert_shows(figure_of(page), shown, 3, 0.0)
    picture = picture_of(page)
    box = figure_of(page).locator("label span").first.bounding_box()
    x, y, width, height = (int(box[key]) for key in ("x", "y", "width", "height"))
    label = picture[y : y + height, x : x + width].mean(axis=-1)
    assert np.median(label) < 0.2
    assert label.max() > 0.8


def test_without_scripts_there_is_the_picture_and_a_sentence(opened, shown, picture_of):
    page = opened(shown.html, java_script_enabled=False)
    assert page.locator("img").get_attribute("alt") == shown.alt
    assert not page.locator("input").first.is_visible()
    assert "need scripts" in figure_of(page).inner_text()
    picture_of(page)
