"""A real Chromium, and screenshots that are kept."""

import shutil
from pathlib import Path

import matplotlib.image
import pytest
from playwright.sync_api import sync_playwright

SCREENSHOTS = Path(__file__).parent / "screenshots"
FLAGS = [
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
]


@pytest.fixture(scope="module")
def browser():
    executable = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
    if executable is None:
        pytest.skip("no Chromium on this machine: apt-get install chromium, then run the browser tests again")
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=executable, args=FLAGS)
        yield chromium
        chromium.close()


@pytest.fixture
def picture_of(record_property, request):
    """Take a screenshot of a page or an element, keep it under the test's name, and return it as (h, w, 3) floats."""
    SCREENSHOTS.mkdir(exist_ok=True)

    def take(target, suffix=""):
        path = SCREENSHOTS / f"{request.node.name}{suffix}.png"
        target.screenshot(path=path)
        record_property("screenshot", str(path))
        return matplotlib.image.imread(path)[..., :3]

    return take
