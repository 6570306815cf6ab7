"""Pages and what a notebook gets: size, bundle, alternative text, the frame; cities of thousands of houses."""

import base64
import gc
import html
import io
import json
import re
import time

import numpy as np
import pytest
from decoding import content_of
from PIL import Image

from uavlab import scene
from uavlab.city import Building, City
from uavlab.plot.pictures import png_of
from uavlab.plot.style import DPI
from uavlab.route import Route
from uavlab.weather import Wind

FLAT = City(np.zeros((20, 20, 4), dtype=bool), 5.0, name="plain")
WAY = Route([(10.0, 10, 10), (80, 20, 10), (80, 90, 15)], "A*")


def still_in(page):
    return base64.b64decode(re.search(r'id="still" alt="" src="data:image/png;base64,([^"]+)"', page)[1])


def test_a_notebook_gets_the_page_a_still_and_what_it_shows(table1, route):
    shown = scene.show(table1, route)
    data, metadata = shown._repr_mimebundle_(include=None)
    assert data["text/plain"] == repr(shown)
    assert data["text/html"].startswith('<div class="uavlab-scene">')  # "<iframe" first makes IPython warn
    assert base64.b64decode(data["image/png"]) == shown.still == still_in(shown.page)
    assert Image.open(io.BytesIO(shown.still)).mode == "P"
    assert metadata == {"image/png": {"alt": shown.words}}
    assert shown.words == (
        'Scene in 3D: the city of REPARE Table 1, 100 by 100 m on the ground, 99 m high. "A*: 66.4 m" (blue, solid).'
    )
    assert json.dumps(metadata)
    assert "height:480px" in data["text/html"]


def test_the_page_says_the_same_words_and_is_what_page_makes(table1, route):
    shown = scene.show(table1, route, camera="side", start_paused=True, start_at=1.0, height=300)
    assert f'aria-label="{html.escape(shown.words)}"' in shown.page
    assert shown.page == scene.page(table1, route, camera="side", start_paused=True, start_at=1.0)
    assert "height:300px" in shown._repr_mimebundle_()[0]["text/html"]
    assert "<title>The city of REPARE Table 1</title>" in shown.page
    assert "<title>Mine</title>" in scene.page(FLAT, title="mine")


def test_a_paused_page_s_still_is_of_its_moment(table1, crash_and_safe):
    given = {"flights": crash_and_safe, "start_at": 1.0, "camera": (20.0, 30.0)}
    paused, playing = (scene.show(table1, **given, start_paused=paused) for paused in (True, False))
    assert paused.still == png_of(scene.still(table1, **given), DPI)
    assert playing.still == png_of(scene.still(table1, flights=crash_and_safe, camera=(20.0, 30.0)), DPI)
    for shown, is_paused in ((paused, True), (playing, False)):
        motion = content_of(shown.page).motion
        assert motion["paused"] is is_paused
        assert motion["at"] == 1.0


def test_motion_is_what_the_drawing_says(table1, crash_and_safe):
    from uavlab.scene.content import drawing_of

    wind = Wind((3.0, -1.0))
    drawing = drawing_of(table1, (), flights=crash_and_safe, wind=wind, safe_distance=3.5)
    motion = content_of(scene.page(table1, flights=crash_and_safe, wind=wind, safe_distance=3.5)).motion
    assert motion["duration"] == pytest.approx(drawing.duration, abs=5e-4)
    assert motion["wind"] == [3.0, -1.0]
    assert motion["unit"] == "s"
    for mover, told in zip(drawing.movers, motion["movers"], strict=True):
        assert np.allclose(told["points"], mover.points - drawing.center, atol=5.1e-4)
        assert np.allclose(told["time"], mover.time, atol=5.1e-4)
        assert np.allclose(told["turn"], mover.turn, atol=5.1e-4)
        assert told["color"] == mover.color
    for mark, told in zip(drawing.markers, motion["markers"], strict=True):
        assert (told["kind"], told["color"]) == (mark.kind, mark.color)
        assert np.allclose(told["place"], mark.place - drawing.center, atol=5.1e-3)
        assert told["since"] == pytest.approx(mark.since, abs=5.1e-4)
        assert told["since"] <= motion["duration"]  # so that scrubbing to the end shows it
    assert set(motion["near"]) | set(motion["far"]) <= set(drawing.parts)
    assert (motion["near"], motion["closeup"]) == (sorted(drawing.near_only), pytest.approx(drawing.closeup, abs=1e-3))
    assert motion["rings"] is True


def test_numbers_of_numpy_are_written(table1, crash_and_safe):
    page = scene.page(
        table1, flights=crash_and_safe, camera=np.array([10, 20]), start_at=np.float32(1.5), safe_distance=np.int64(3)
    )
    motion = content_of(page).motion
    assert (motion["camera"], motion["at"]) == ([10.0, 20.0], 1.5)
    last = max(flight.duration for flight in crash_and_safe.values())
    assert content_of(scene.page(table1, flights=crash_and_safe, start_at=last)).motion["at"] == last


@pytest.mark.parametrize("height", [-3, 0, 300.5, "480", True, 10_001])
def test_a_frame_has_a_height_in_pixels(height):
    with pytest.raises(ValueError, match="height must be "):
        scene.show(FLAT, height=height)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"title": 3}, "title must be text, got 3"),
        ({"start_paused": "yes"}, "start_paused must be True or False, got 'yes'"),
        ({"start_paused": 1.5}, "start_paused must be True or False"),
    ],
)
def test_what_a_page_can_not_be(arguments, message):
    with pytest.raises(ValueError, match=message):
        scene.page(FLAT, WAY, **arguments)


def test_an_empty_title_is_the_city_s_name():
    assert "<title>Plain</title>" in scene.page(FLAT, title="")


def test_five_thousand_buildings():
    """Half of them with a roof, each over another footprint: a page of some MB, in seconds."""
    rng = np.random.default_rng(0)
    houses = []
    for number in range(5000):
        spot, turn = 25.0 * np.array([number % 71, number // 71]), rng.uniform(0, np.pi)
        width, depth = rng.uniform(3, 9, 2)
        axes = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
        corners = spot + np.array([(-width, -depth), (width, -depth), (width, depth), (-width, depth)]) @ axes
        if number % 2:
            ridge = np.column_stack([spot + np.array([(-width, 0), (width, 0)]) @ axes, [12.0, 12.0]])
            houses.append(Building.roofed(corners, 8.0, ridge))
        else:
            houses.append(Building.prism(corners, rng.uniform(6, 30)))
    city = City(np.zeros((180, 180, 5), dtype=bool), 10.0, buildings=houses)
    gc.collect()
    began = time.process_time()
    page = scene.page(city)
    spent = time.process_time() - began
    mesh = content_of(page).meshes["buildings"]
    assert len(mesh.shapes) > 60_000
    assert len(page) < 1_800_000
    assert spent < 60
    print(f"{spent:.1f} s, {len(page) / 1e6:.2f} MB, {len(mesh.shapes):,} triangles")
