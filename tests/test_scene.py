"""Scenes: what the page holds, how large it is, and that the same scene gives the same bytes."""

import base64
import gzip
import re

import numpy as np
import pytest
import umsgpack

from uavlab import scene
from uavlab.city import Building, City
from uavlab.planners import astar, shortcut
from uavlab.risk import RiskMap, reference_campus
from uavlab.route import Route

START, GOAL = (90, 18, 30), (20, 75, 75)


@pytest.fixture(scope="module")
def route(table1):
    return astar(table1, START, GOAL, record=True)


def commands_of(page):
    """The commands that meshcat's viewer gets, by path and type."""
    packed = gzip.decompress(base64.b64decode(re.findall(r'unpack\("([^"]+)"\)', page)[1]))
    commands = {}
    while packed:
        length = int.from_bytes(packed[:4], "big")
        command = umsgpack.unpackb(packed[4 : 4 + length])
        commands[command["path"], command["type"]] = command
        packed = packed[4 + length :]
    return commands


def vertices_of(command):
    attribute = command["object"]["geometries"][0]["data"]["attributes"]["position"]
    return np.frombuffer(bytes(attribute["array"].data), dtype=np.float32).reshape(-1, 3)


def test_page_is_small_and_needs_no_network(table1, route):
    page = scene.page(table1, route, shortcut(route, table1), safe_distance=3.5)
    assert len(page) < 400_000
    assert "src=" not in page.split("<script>")[0]
    assert len(scene.page(table1, route, expansion=True)) < 400_000


def test_same_scene_gives_the_same_bytes(table1, route):
    assert scene.page(table1, route) == scene.page(table1, route)


def test_all_buildings_are_one_mesh_that_spans_them(table1):
    commands = commands_of(scene.page(table1))
    vertices = vertices_of(commands["/meshcat/city/buildings", "set_object"])
    assert vertices.min(axis=0) == pytest.approx([10, 15, 0])
    assert vertices.max(axis=0) == pytest.approx([95, 95, 99])
    assert sum(path.startswith("/meshcat/city") for path, kind in commands if kind == "set_object") == 2


def test_uav_visits_the_waypoints_in_order_at_constant_speed(table1, route):
    straight = shortcut(route, table1)
    animation = commands_of(scene.page(table1, straight))["", "set_animation"]["animations"]
    (clip,) = [entry["clip"] for entry in animation if entry["path"] == "/meshcat/uav"]
    keys = next(track["keys"] for track in clip["tracks"] if track["name"] == ".position")
    assert np.array([key["value"] for key in keys]) == pytest.approx(straight.points)
    frames = np.array([key["time"] for key in keys])
    assert frames / frames[-1] == pytest.approx(straight.distance / straight.length, abs=1 / frames[-1])


def test_expansion_shows_the_nodes_in_batches_in_their_order(table1, route):
    commands = commands_of(scene.page(table1, route, expansion=True))
    batches = [vertices_of(commands[f"/meshcat/expansion/batch{n}", "set_object"]) for n in range(40)]
    shown = table1.code_of(table1.cell_of(np.concatenate(batches)))
    positions = [np.flatnonzero(route.info["order"] == node)[0] for node in shown[:: len(shown) // 50]]
    assert positions == sorted(positions)
    assert shown[0] == route.info["order"][0]


def test_tube_surrounds_the_polyline():
    points = np.array([[0.0, 0, 0], [0, 0, 5], [4, 0, 5]])
    corners = scene.tube(points, 0.5).reshape(-1, 3)
    distance = np.minimum(
        np.linalg.norm(corners - np.clip(corners, points[0], points[1]), axis=1),
        np.linalg.norm(corners - np.clip(corners, points[1], points[2]), axis=1),
    )
    assert distance.max() <= 0.5 + 1e-9
    assert (distance > 0.4).any()


def test_legend_names_the_city_and_escapes_it(route):
    city = City.from_buildings([Building.prism([(0, 0), (9, 0), (9, 9)], 5)], name="<b>Town</b>")
    page = scene.page(city, Route(np.empty((0, 3)), "A*", reached=False, reason="no free way"))
    assert "&lt;b&gt;Town" in page
    assert "A*: no free way" in page


def test_notebook_gets_the_page_and_a_still_picture(table1, route):
    bundle = scene.show(table1, route)._repr_mimebundle_()
    assert bundle["text/html"].startswith('<div class="uavlab-scene">')  # "<iframe" first makes IPython warn
    assert base64.b64decode(bundle["image/png"]).startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"expansion": True}, "expansion needs a first route planned with record=True"),
        ({"safe_distance": 0.0}, "safe_distance must be the radius of a ball in metres, above 0, got 0.0"),
    ],
)
def test_wrong_question(table1, arguments, message):
    with pytest.raises(ValueError, match=message):
        scene.page(table1, Route(np.array([[1.0, 1, 1], [2, 2, 2]])), **arguments)


def colors_of(command):
    attribute = command["object"]["geometries"][0]["data"]["attributes"]["color"]
    return np.frombuffer(bytes(attribute["array"].data), dtype=np.float32).reshape(-1, 3)


def test_risk_paints_the_ground_and_a_slice_on_one_scale_with_a_color_bar():
    campus = reference_campus()
    page = scene.page(campus.city, risk=campus, slice_height=27.5)
    commands = commands_of(page)
    ground, cut = (commands[f"/meshcat/risk/{name}", "set_object"] for name in ("ground", "slice"))
    assert len(vertices_of(ground)) == 6 * 30 * 30
    assert len(vertices_of(cut)) == 6 * np.count_nonzero(campus.flyable[:, :, 5])  # buildings are left out
    assert np.allclose(vertices_of(cut)[:, 2], 27.5)
    lightness = colors_of(ground).sum(axis=1)[::6].reshape(30, 30)
    assert lightness[28, 28] > lightness[2, 2] + 0.5  # the crowded square against the park
    assert "linear-gradient" in page
    assert "deaths per hour of flight" in page
    assert len(page) < 450_000


def test_a_map_without_anybody_can_still_be_drawn():
    nobody = RiskMap(City(np.zeros((4, 4, 4), dtype=bool), 5.0), 0.0, 0.0)
    assert "deaths per hour" in scene.page(nobody.city, risk=nobody)
    assert scene.show(nobody.city, risk=nobody).still


def test_a_slice_needs_a_risk_map_and_a_height_on_it(table1):
    with pytest.raises(ValueError, match="slice_height needs risk"):
        scene.page(table1, slice_height=30.0)
    campus = reference_campus()
    with pytest.raises(ValueError, match="height must lie on the map, 0 to 80 m"):
        scene.page(campus.city, risk=campus, slice_height=90.0)
