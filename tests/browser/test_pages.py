"""The pages that the library writes, in a real browser."""

import subprocess
import sys

import numpy as np
import pytest
from pictures import shades_of_hue, share_of_hue

from uavlab import plot, scene
from uavlab.city import City, NoFlyZone, table1_city
from uavlab.planners import astar
from uavlab.plot.colors import sequential_color
from uavlab.plot.ground import ZONE_COLOR
from uavlab.scene.content import EXPANSION_BATCHES


@pytest.fixture
def page(browser):
    page = browser.new_page(viewport={"width": 1000, "height": 700})
    errors = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.on("request", lambda request: errors.append(request.url) if request.url.startswith("http") else None)
    yield page
    page.close()
    assert errors == [], "a script failed or the page asked the network for something"


def wait_until_drawn(frame):
    frame.wait_for_selector("body[data-ready=yes]", timeout=60_000)
    frame.wait_for_timeout(1500)


def test_page_of_the_command_line_shows_five_buildings_with_roofs_and_the_route(page, tmp_path, picture_of):
    out = tmp_path / "route.html"
    subprocess.run([sys.executable, "-m", "uavlab", "--out", out], check=True, cwd=tmp_path)
    page.goto(out.as_uri())
    frame = page.wait_for_selector("iframe")
    wait_until_drawn(frame.content_frame())
    picture = picture_of(frame)
    for building in table1_city().buildings:
        assert share_of_hue(picture, building.color) > 0.005, building.name
    assert shades_of_hue(picture, table1_city().buildings[1].color) >= 3  # two walls and a roof, each in its own light
    assert share_of_hue(picture, plot.SKY, saturation=0.5) > 0.001 or share_of_hue(picture, plot.BLUE) > 0.001
    assert page.locator("table").first.inner_text().count("\n") >= 5
    assert page.evaluate("document.images[0].naturalWidth") > 300  # the profile


def test_uav_flies(page, tmp_path):
    city = table1_city(cell=4.0)
    route = astar(city, (90, 18, 30), (20, 75, 75))
    path = tmp_path / "scene.html"
    path.write_text(scene.page(city, route), encoding="utf-8")
    page.goto(path.as_uri())
    wait_until_drawn(page)
    first = page.screenshot()
    page.wait_for_timeout(1500)
    assert page.screenshot() != first


def test_expansion_appears_in_its_order(page, tmp_path, picture_of):
    city = table1_city(cell=2.0)
    route = astar(city, (90, 18, 30), (50, 44, 30), record=True)
    path = tmp_path / "scene.html"
    path.write_text(scene.page(city, route, expansion=True), encoding="utf-8")
    page.goto(path.as_uri())
    wait_until_drawn(page)
    shown = """() => { let names = [];
        viewer.scene.traverseVisible(o => { if (o.isPoints) names.push(Number(o.parent.name.slice(8))) });
        return names.sort((a, b) => a - b); }"""
    counts = []
    while not counts or counts[-1] < EXPANSION_BATCHES:
        batches = page.evaluate(shown)
        assert batches == list(range(len(batches)))  # never a later one without all before it
        counts.append(len(batches))
        assert len(counts) < 300
        page.wait_for_timeout(200)
    assert counts[0] < counts[-1]
    assert share_of_hue(picture_of(page), sequential_color(0.0), saturation=0.5) > 0.001


def test_city_without_buildings_is_drawn_from_its_voxels(page, tmp_path, picture_of):
    path = tmp_path / "scene.html"
    path.write_text(scene.page(City(table1_city(cell=2.0).occupied, cell=2.0)), encoding="utf-8")
    page.goto(path.as_uri())
    wait_until_drawn(page)
    assert share_of_hue(picture_of(page), "lightsteelblue") > 0.05


def test_hill_and_no_fly_zone_are_seen(page, tmp_path, picture_of):
    x, y = np.meshgrid(np.arange(50) - 24.5, np.arange(30) - 14.5, indexing="ij")
    ground = 35 * np.exp(-(x**2 + y**2) / 75)
    zone = NoFlyZone([(20, 20), (50, 20), (50, 40), (20, 40)], 0, 40, name="school")
    city = City(np.zeros((50, 30, 20), dtype=bool), 4.0, ground=ground, no_fly=(zone,))
    path = tmp_path / "scene.html"
    path.write_text(scene.page(city), encoding="utf-8")
    page.goto(path.as_uri())
    wait_until_drawn(page)
    picture = picture_of(page)
    assert share_of_hue(picture, ZONE_COLOR) > 0.01
    middle = picture[200:560, 250:800]  # the ground: grey, its slopes in light and in shade
    grey = middle[np.ptp(middle, axis=-1) < 0.08].mean(axis=-1)
    assert np.quantile(grey, 0.95) - np.quantile(grey, 0.05) > 0.15
    assert "no-fly zone: school" in page.locator("#legend").inner_text()
