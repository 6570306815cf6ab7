"""When the notebooks run as tests, each scene and each figure with sliders is opened in a browser, and used."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

OPENED = Path(__file__).parents[1] / "tests" / "browser" / "opened.py"
BROWSERS = ("chromium", "chromium-browser", "google-chrome")


BROWSER = pytest.StashKey[subprocess.Popen]()
"""Of a session; one that opens nothing starts none."""


def pytest_sessionfinish(session):
    browser = session.config.stash.get(BROWSER, None)
    if browser is not None:
        browser.stdin.close()
        browser.wait(timeout=60)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item):
    result = yield
    for output in getattr(item, "test_outputs", None) or ():
        markup = output.get("data", {}).get("text/html", "")
        if ("uavlab-scene" in markup or "uavlab-sliders" in markup) and any(map(shutil.which, BROWSERS)):
            problems = used(item.config, markup)
            assert not problems, "in the browser: " + "; ".join(problems)
    return result


def used(config, markup):
    """What is wrong with a piece of HTML when a reader uses it."""
    if BROWSER not in config.stash:
        config.stash[BROWSER] = subprocess.Popen(
            [sys.executable, OPENED], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
    browser = config.stash[BROWSER]
    page = Path(config.cache.mkdir("browser")) / f"{getattr(config, 'workerinput', {}).get('workerid', 'main')}.html"
    page.write_text(f'<!DOCTYPE html><meta charset="utf-8"><body>{markup}', encoding="utf-8")
    browser.stdin.write(json.dumps({"html": str(page)}) + "\n")
    browser.stdin.flush()
    return json.loads(browser.stdout.readline())["problems"]
