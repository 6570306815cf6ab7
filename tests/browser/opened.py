"""Open scenes and figures with sliders in Chromium, use them as a reader does, and say what is wrong.

Reads a line of JSON for each, `{"html": file with the output of a cell}`, and answers with one, `{"problems": [...]}`.
It is a process of its own because a notebook's tests talk to a kernel at the same time.
"""

import io
import json
import sys
from pathlib import Path

import matplotlib.image
import numpy as np
from playwright.sync_api import TimeoutError as PlaywrightTimeout
from playwright.sync_api import sync_playwright

sys.path.append(str(Path(__file__).parents[1]))  # where pytest looks, too
from chromium import FLAGS, chromium_path

SECONDS = 60_000


def pixels(target):
    return matplotlib.image.imread(io.BytesIO(target.screenshot()))[..., :3]


def used_scene(page, element):
    """What is wrong with a scene in a frame."""
    frame = element.content_frame()
    frame.wait_for_selector("body[data-ready]", timeout=SECONDS)
    if frame.evaluate("document.body.dataset.ready") != "yes":
        return [f"the scene isn't drawn: {frame.inner_text('#problem')}"]
    problems = answered(frame) if frame.query_selector("#live") else []
    moving = frame.evaluate("document.body.classList.contains('moving')")
    if moving and frame.evaluate("document.body.classList.contains('playing')"):
        frame.click("#play")
    seen = pixels(frame.locator("#pane"))
    if len(np.unique((seen * 15).astype(int).reshape(-1, 3), axis=0)) < 12 or seen.std() < 0.02:
        problems.append("the scene is blank")
    page.wait_for_timeout(300)
    if not np.array_equal(seen, pixels(frame.locator("#pane"))):
        problems.append("a paused scene changes")
    if moving:
        problems += scrubbed(frame)
    for name in frame.evaluate("[...document.getElementById('camera').options].map(option => option.value)")[1:]:
        frame.select_option("#camera", name)
        page.wait_for_timeout(100)
        now = pixels(frame.locator("#pane"))
        if np.array_equal(seen, now):
            problems.append(f"camera {name} shows the same")
        seen = now
    if not frame.get_attribute("#pane", "aria-label"):
        problems.append("the scene has no words for those who don't see it")
    return problems


def answered(frame):
    """Move an end of a live scene by its arrow keys, there and back; both times it plans anew."""
    frame.wait_for_selector("body[data-live]", timeout=SECONDS)
    if frame.evaluate("document.body.dataset.live") != "yes":
        return [f"the scene doesn't answer: {frame.inner_text('#lifeless')}"]
    problems = []
    for key in ("ArrowLeft", "ArrowRight"):
        before = frame.evaluate("Number(document.body.dataset.planned)")
        frame.locator(".handle").first.press(key)
        try:
            frame.wait_for_function(
                "before => Number(document.body.dataset.planned) > before", arg=before, timeout=20_000
            )
        except PlaywrightTimeout:
            problems.append(f"{key} moves an end and nothing is planned")
    return problems


def scrubbed(frame):
    """Go to the end and to the beginning; crosses are there at the end only."""
    problems = []
    crosses = (
        "[...document.querySelectorAll('#overlay [data-kind=crash]')].filter(g => g.style.display != 'none').length"
    )
    for key, share in (("End", 1.0), ("Home", 0.0)):
        frame.focus("#scrub")
        frame.press("#scrub", key)
        frame.wait_for_timeout(100)
        if float(frame.input_value("#scrub")) != 1000 * share:
            problems.append(f"{key} doesn't move the time")
        crashed, shown = frame.locator("#overlay [data-kind=crash]").count(), frame.evaluate(crosses)
        if shown != (crashed if share else 0):
            problems.append(f"{shown} of {crashed} crashes are shown at {share:.0%} of the time")
    frame.focus("#scrub")
    frame.press("#scrub", "End")
    frame.wait_for_timeout(100)
    return problems


def used_sliders(page, element):
    """What is wrong with a figure with sliders."""
    problems = []
    for slider in element.query_selector_all("input[type=range]"):
        output, seen = element.inner_text(), pixels(element)
        slider.focus()
        slider.press("End" if slider.input_value() != slider.get_attribute("max") else "Home")
        page.wait_for_timeout(200)
        name = slider.get_attribute("aria-label") or slider.get_attribute("id") or "a slider"
        if element.inner_text() == output:
            problems.append(f"{name} doesn't say its value")
        if np.array_equal(seen, pixels(element)):
            problems.append(f"{name} changes nothing")
    for picture in element.query_selector_all("img"):
        if not picture.get_attribute("alt"):
            problems.append("a picture has no alternative text")
    return problems


def opened(browser, path):
    """Problems of all scenes and sliders in a piece of HTML."""
    page = browser.new_page(viewport={"width": 960, "height": 700})
    problems = []
    page.on("pageerror", lambda error: problems.append(f"a script failed: {error}"))
    page.on("console", lambda said: problems.append(f"console: {said.text}") if said.type == "error" else None)
    page.on("request", lambda one: problems.append(f"asked for {one.url}") if one.url.startswith("http") else None)
    page.goto(path.as_uri())
    scenes, sliders = page.query_selector_all(".uavlab-scene iframe"), page.query_selector_all(".uavlab-sliders")
    try:
        for element in scenes:
            problems += used_scene(page, element)
        for element in sliders:
            problems += used_sliders(page, element)
    except Exception as problem:  # said, and the next one is opened
        problems.append(f"{type(problem).__name__}: {problem}")
    page.close()
    return problems if scenes or sliders else [*problems, "neither a scene nor sliders"]


def main():
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium_path(), args=FLAGS)
        for line in sys.stdin:
            print(json.dumps({"problems": opened(browser, Path(json.loads(line)["html"]))}), flush=True)
        browser.close()


if __name__ == "__main__":
    main()
