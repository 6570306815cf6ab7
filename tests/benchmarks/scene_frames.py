"""Frames per second of a scene of 60 000 triangles while it plays, and how soon a page shows its first frame.

In Chromium with software rendering, as without a graphics card: `python tests/benchmarks/scene_frames.py`. With paths
of other pages as arguments, those are measured in the same run.
"""

import shutil
import statistics
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from playwright.sync_api import sync_playwright

from uavlab import scene
from uavlab.city import Building, City, table1_city
from uavlab.planners import astar
from uavlab.route import Route

FLAGS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
COUNT = """async () => {
  let frames = 0;
  const render = viewer.render;
  viewer.render = function () { frames++; return render.apply(viewer, arguments); };
  await new Promise(done => setTimeout(done, 8000));
  return frames / 8;
}"""


def large_city() -> City:
    """5 000 houses, 12 triangles each."""
    rng = np.random.default_rng(0)
    corners, heights = rng.uniform(0, 1950, (5000, 2)), rng.uniform(5, 40, 5000)
    houses = tuple(
        Building.prism([(x, y), (x + 18, y), (x + 18, y + 14), (x, y + 14)], height)
        for (x, y), height in zip(corners, heights, strict=True)
    )
    return City(np.zeros((40, 40, 4), dtype=bool), 50.0, buildings=houses, name="5 000 houses")


def main() -> None:
    folder = Path(tempfile.mkdtemp())
    table1 = table1_city()
    pages = {
        "Table 1": scene.page(table1, astar(table1, (90, 18, 30), (20, 75, 75))),
        "60 000 triangles": scene.page(large_city(), Route([(10, 10, 60), (1900, 1900, 60)], "across")),
    }
    paths = {}
    for name, page in pages.items():
        paths[name] = folder / f"{name}.html"
        paths[name].write_text(page, encoding="utf-8")
    paths |= {path: Path(path).resolve() for path in sys.argv[1:]}
    executable = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))))
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=executable, args=FLAGS)
        for name, path in paths.items():
            soon = []
            for _ in range(3):
                page = browser.new_page(viewport={"width": 960, "height": 540})
                began = time.perf_counter()
                page.goto(path.as_uri())
                page.wait_for_selector("body[data-ready=yes]", timeout=120_000)
                soon.append(time.perf_counter() - began)
                rate = page.evaluate(COUNT)
                page.close()
            size = path.stat().st_size / 1000
            print(f"{name}: {size:.0f} kB, first frame after {statistics.median(soon):.2f} s, {rate:.1f} frames/s")
        browser.close()
    shutil.rmtree(folder)


if __name__ == "__main__":
    main()
