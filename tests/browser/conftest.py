"""A real Chromium, and a way to say what a screenshot shows."""

import shutil
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
from matplotlib.colors import rgb_to_hsv, to_rgb
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


def share_of_hue(picture, color, *, tolerance=0.035, saturation=0.12):
    """Share of the pixels that have the hue of a colour, in light or in shade."""
    hsv = rgb_to_hsv(np.clip(picture, 0, 1))
    distance = np.abs(hsv[..., 0] - rgb_to_hsv(to_rgb(color))[0])
    return float(((np.minimum(distance, 1 - distance) < tolerance) & (hsv[..., 1] > saturation)).mean())


def shades_of_hue(picture, color, *, least=0.0005):
    """How many clearly different brightnesses of a colour fill at least a share `least` of the picture."""
    hsv = rgb_to_hsv(np.clip(picture, 0, 1))
    same = (np.abs(hsv[..., 0] - rgb_to_hsv(to_rgb(color))[0]) < 0.035) & (hsv[..., 1] > 0.12)
    counts, _ = np.histogram(hsv[..., 2][same], bins=50, range=(0, 1))
    return int((counts > least * same.size).sum())
