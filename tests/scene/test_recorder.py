"""What the page holds: every array can be read again, and is what was drawn; the same scene gives the same bytes."""

import re

import numpy as np
import pytest
from decoding import content_of, decoded
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from matplotlib.colors import to_rgb

from uavlab import scene
from uavlab.city import Building, City, NoFlyZone, table1_city
from uavlab.risk import reference_campus
from uavlab.route import Route
from uavlab.scene.content import drawing_of
from uavlab.scene.drawing import Drawing, Mover, Surface
from uavlab.scene.recorder import STEPS, Joined, Recorder, record
from uavlab.weather import Wind


@given(arrays(np.int32, st.tuples(st.integers(1, 30), st.integers(1, 4)), elements=st.integers(-(10**8), 10**8)))
def test_arrays_come_back_exactly(whole):
    recorder = Recorder()
    places = [recorder.kept(whole / parts, whole.shape[1], parts) for parts in (512, 1)]
    for place, parts in zip(places, (512, 1), strict=True):
        assert np.array_equal(decoded(place, recorder.arrays), whole / parts)


def test_joined_triangles_are_the_same_triangles_with_each_corner_once():
    rng = np.random.default_rng(1)
    triangles = rng.integers(0, 3, (200, 3, 3)) + 0.0004 * rng.random((200, 3, 3))  # within half a step
    joined = Joined(triangles)
    assert len(joined.vertices) == 27
    assert np.array_equal(joined.vertices[joined.faces], np.round(triangles))
    colors = rng.integers(0, 2, (600, 3)).astype(float)
    joined = Joined(triangles, colors)
    assert np.array_equal(joined.color[joined.faces].reshape(-1, 3), colors)
    assert np.array_equal(joined.vertices[joined.faces], np.round(triangles))


@pytest.fixture(scope="module")
def drawn(hill, crash_and_safe):
    """Three scenes with all there is: as drawing and as page."""
    campus = reference_campus(cell=10.0)
    route = Route([(5, 5, 30), (60, 70, 40), (110, 70, 30)])
    voxels = City(table1_city(cell=5.0).occupied, 5.0)
    return {
        "hill": (hill, (route,), {"wind": Wind((3.0, 1.0)), "safe_distance": 2.0}),
        "campus": (campus.city, (), {"risk": campus, "slice_height": 25.0}),
        "flights": (voxels, (), {"flights": crash_and_safe, "safe_distance": 3.5}),
    }


@pytest.mark.parametrize("name", ["hill", "campus", "flights"])
def test_every_mesh_of_the_page_is_a_part_of_the_drawing(drawn, name):
    city, routes, more = drawn[name]
    drawing, meshes = drawing_of(city, routes, **more), content_of(scene.page(city, *routes, **more)).meshes
    expected = dict(drawing.parts)
    for number, mover in enumerate(drawing.movers):
        expected[f"mover{number}/body"] = mover.body
        if mover.ball is not None:
            expected[f"mover{number}/ball"] = mover.ball
    assert set(meshes) == set(expected)
    for name, part in expected.items():
        mesh = meshes[name]
        center = 0.0 if name.startswith("mover") else drawing.center
        shapes = part.triangles if isinstance(part, Surface) else part.ends.reshape(-1, 2, 3)
        assert mesh.shapes.shape == shapes.shape
        assert np.abs(mesh.shapes - (shapes - center)).max() <= 0.5 / STEPS + 1e-9, name
        assert np.array_equal(np.round(STEPS * mesh.positions), STEPS * mesh.positions)
        if isinstance(part, Surface):
            tones = np.repeat(part.colors, 3, axis=0)
            shown = (
                np.broadcast_to(to_rgb(f"#{mesh.material['color']:06x}"), tones.shape)
                if mesh.colors is None
                else mesh.colors[mesh.index]
            )
            assert np.abs(shown - tones).max() <= 0.51 / 255, name
            assert mesh.material["type"] == ("MeshLambertMaterial" if part.lit else "MeshBasicMaterial")
            assert mesh.material["side"] == (0 if part.closed else 2)
            assert mesh.material["transparent"] == (part.opacity < 1)
            assert mesh.material["opacity"] == part.opacity
            assert mesh.material.get("depthWrite", True) == (part.opacity == 1)  # what is behind glass is seen
        else:
            assert to_rgb(f"#{mesh.material['color']:06x}") == pytest.approx(to_rgb(part.color), abs=1e-9)


def test_expanded_nodes_are_points_as_large_as_in_the_still(table1, route):
    drawing = drawing_of(table1, (route,), expansion=True)
    content = content_of(scene.page(table1, route, expansion=True))
    fov = content.properties["/Cameras/default/rotated/<object>", "fov"]
    shown = []
    for number in range(40):
        name = f"expanded{number:02d}"
        mesh, dots = content.meshes[name], drawing.parts[name]
        assert mesh.kind == "Points"
        assert np.abs(mesh.positions - (dots.points - drawing.center)).max() <= 0.5 / STEPS + 1e-9
        assert np.abs(mesh.colors - to_rgb(dots.color)).max() <= 0.51 / 255
        # three.js draws size · (height / 2) / depth pixels; a length has size · height / (2 tan(fov / 2)) / depth
        assert mesh.material["size"] * np.tan(np.radians(fov) / 2) == pytest.approx(0.9 * table1.cell)
        shown.append(mesh.positions + drawing.center)
    codes = table1.code_of(table1.cell_of(np.concatenate(shown)))
    order = route.info["order"]
    positions = {node: place for place, node in enumerate(order)}
    places = [positions[code] for code in codes.tolist()]
    assert places == sorted(places)
    assert places[0] == 0
    assert set(np.diff(places)) == {2}  # every second one
    since = content.motion["since"]
    for number in range(1, 40):
        first = len(np.concatenate(shown[:number]))
        assert since[f"expanded{number:02d}"] == pytest.approx(places[first], abs=2 * 40)
    assert content.motion["duration"] == len(order)
    assert content.motion["unit"] == "nodes"


def test_far_off_maps_are_drawn_as_exactly_as_near_ones():
    """float32 has steps of half a metre at 5 000 km."""

    def town(shift):
        house = Building.prism(np.array([(5.2, 10.1), (30.3, 10.1), (30.3, 40.7)]) + shift[:2], 12.3)
        zone = NoFlyZone(np.array([(50.1, 50.3), (60, 50), (60, 60)]) + shift[:2])
        ground = np.linspace(0, 3, 100).reshape(10, 10)
        grid = np.zeros((10, 10, 8), dtype=bool)
        return City(grid, 8.0, np.asarray(shift), (house,), ground=ground, no_fly=(zone,))

    shift = np.array([3_000_000.0, 5_000_000.0, 0.0])  # the grid's lines stay where they are: 10 m divide both
    points = np.array([[2.2, 2.3, 20.1], [40.4, 70.7, 30.3]])
    near = content_of(scene.page(town(0 * shift), Route(points), safe_distance=2.0, wind=Wind((3.0, 1.0))))
    far = content_of(scene.page(town(shift), Route(points + shift), safe_distance=2.0, wind=Wind((3.0, 1.0))))
    assert near.meshes.keys() == far.meshes.keys()
    for name, mesh in near.meshes.items():
        assert mesh.shapes.shape == far.meshes[name].shapes.shape, name
        assert np.abs(mesh.shapes - far.meshes[name].shapes).max() <= 0.002, name
    assert np.allclose(near.motion["movers"][0]["points"], far.motion["movers"][0]["points"], atol=0.002)
    assert np.allclose(near.motion["markers"][0]["place"], far.motion["markers"][0]["place"], atol=0.011)
    assert len(near.motion["corners"]) == len(far.motion["corners"])


def test_uavs_that_move_are_not_about_the_centre():
    body = Surface(np.array([[[-0.5, 0, 0], [0.5, 0, 0], [0, 0.25, 0]]]), "#ff0000")
    drawing = Drawing("town", np.array([100.0, 200.0, 300.0]), np.zeros((2, 3)))
    drawing.movers.append(Mover("#ff0000", np.zeros(1), np.zeros((1, 3)), np.array([[0.0, 0, 0, 1]]), body))
    recorder = record(drawing)
    command = recorder.commands["/meshcat/mover0/body", "set_object"]
    place = command["object"]["geometries"][0]["data"]["attributes"]["position"]["array"]
    assert np.array_equal(np.unique(decoded(place, recorder.arrays)[:, 0]), [-0.5, 0, 0.5])


def test_same_scene_gives_the_same_bytes(table1, route, crash_and_safe):
    for more in ({"expansion": True}, {"flights": crash_and_safe, "wind": Wind((1.0, 2.0))}):
        first, second = (scene.show(table1, route, **more) for _ in range(2))
        assert first.page == second.page
        assert first.still == second.still


def test_the_page_s_camera_sees_as_the_still_s(table1, route):
    from uavlab.scene.camera import DIRECTIONS, FIELD_OF_VIEW_DEG, MARGIN

    content = content_of(scene.page(table1, route, camera=(12.5, 30.0)))
    assert content.properties["/Cameras/default/rotated/<object>", "fov"] == FIELD_OF_VIEW_DEG
    assert content.motion["camera"] == [12.5, 30.0]
    assert content.motion["margin"] == MARGIN
    corners, drawing = np.array(content.motion["corners"]), drawing_of(table1, (route,))
    cameras = {name: tuple(angles) for name, angles in content.motion["cameras"].items()}
    assert cameras == DIRECTIONS | {"overview": drawing.overview}
    seen = np.concatenate(drawing.seen) - drawing.center
    for direction in np.random.default_rng(0).normal(size=(50, 3)):  # what is outermost in any direction is a corner
        assert (corners @ direction).max() == pytest.approx(
            (seen @ direction).max(), abs=0.02 * np.abs(direction).sum()
        )


def test_page_is_small_and_needs_no_network(table1, route, crash_and_safe):
    pages = [scene.page(table1, route, safe_distance=3.5), scene.page(table1, route, expansion=True),
             scene.page(table1, flights=crash_and_safe, wind=Wind((3.0, 0.0)), safe_distance=3.5)]  # fmt: skip
    for page in pages:
        assert len(page) <= 400_000
        assert set(re.findall(r'(?:src|href)="([^"]{0,11})', page)) <= {"data:image/"}
        assert not re.search(r"url\(|@import|https?://", page)
