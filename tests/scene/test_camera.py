"""Views: all that is to be seen is in the frame and touches its border; names, pairs of angles, following."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from uavlab import scene
from uavlab.city import City
from uavlab.route import Route
from uavlab.scene.camera import FIELD_OF_VIEW_DEG, MARGIN, chasing, fitted
from uavlab.scene.content import drawing_of
from uavlab.scene.stills import view_of

UPRIGHT = np.tan(np.radians(FIELD_OF_VIEW_DEG / 2))


def in_frame(points, view, aspect):
    """Where points lie (N, 2), each from -1 to 1 in the frame, by a camera matrix of one's own."""
    forward = (view.target - view.eye) / np.linalg.norm(view.target - view.eye)
    right = np.cross(forward, view.up)
    assert np.linalg.norm(right) == pytest.approx(1.0)
    assert np.linalg.norm(view.up) == pytest.approx(1.0)
    matrix = np.array([right / (aspect * UPRIGHT), view.up / UPRIGHT, forward])
    a, b, depth = matrix @ (points - view.eye).T
    assert (depth > 0).all()
    return np.column_stack([a / depth, b / depth])


@given(
    st.integers(0, 10**6), st.floats(-180, 180), st.floats(-90, 90), st.floats(0.3, 4),
    st.tuples(*3 * [st.floats(0.01, 1000)]), st.integers(4, 60),
)  # fmt: skip
def test_all_points_are_in_the_frame_and_touch_its_border(seed, azimuth, elevation, aspect, size, count):
    points = np.random.default_rng(seed).uniform(-1, 1, (count, 3)) * size
    view = fitted(points, azimuth, elevation, aspect)
    turn, rise = np.radians([azimuth, elevation])
    away = np.array([np.cos(rise) * np.cos(turn), np.cos(rise) * np.sin(turn), np.sin(rise)])
    back = view.eye - view.target
    assert back == pytest.approx(np.linalg.norm(back) * away, abs=1e-6 * np.linalg.norm(back))
    seen = in_frame(points, view, aspect)
    nearest = ((view.eye - points) @ away).min() / np.linalg.norm(back)
    assert nearest >= 0.0999
    if nearest > 0.1001:
        assert np.abs(seen).max() == pytest.approx(1 / MARGIN, rel=1e-6)
    assert np.abs(seen).max() <= 1 / MARGIN + 1e-6
    assert seen.max(axis=0) == pytest.approx(-seen.min(axis=0), abs=1e-6)  # in the middle


def test_up_is_up_and_from_above_it_is_north():
    for azimuth in (-170.0, -61.0, 0.0, 90.0):
        view = fitted(np.eye(3), azimuth, 20.0, 1.5)
        assert view.up[2] > 0.9
    assert fitted(np.eye(3), -90.0, 90.0, 1.5).up == pytest.approx([0, 1, 0])


def test_the_uav_that_is_followed_is_in_the_middle_with_its_way_ahead():
    place, heading = np.array([10.0, 20.0, 30.0]), np.array([0.6, -0.8])
    view = chasing(place, heading, 2.0)
    assert view.target == pytest.approx(place)
    assert (view.target - view.eye)[:2] @ heading == pytest.approx(np.linalg.norm((view.target - view.eye)[:2]))
    assert view.eye[2] > place[2]
    seen = in_frame(np.array([place, place + 5 * np.append(heading, 0), np.add(place, [0, 0, 1])]), view, 1.5)
    assert seen[0] == pytest.approx([0, 0], abs=1e-9)
    assert seen[1, 0] == pytest.approx(0, abs=1e-9)
    assert seen[1, 1] > 0
    assert seen[2, 1] > 0
    near, far = (np.linalg.norm(np.subtract(*chasing(place, heading, size)[:2])) for size in (2.0, 6.0))
    assert far == pytest.approx(3 * near)


def test_the_eye_of_a_name_and_of_its_angles_is_the_same(table1):
    drawing = drawing_of(table1, (Route([(1, 1, 1), (2, 1, 1)]),))
    for name, (azimuth, elevation) in scene.camera.DIRECTIONS.items():
        named, given = (view_of(drawing, camera, 0.0, 2.0, 1.5) for camera in (name, (azimuth, elevation)))
        assert np.array_equal(named.eye, given.eye)
    above = view_of(drawing, "above", 0.0, 2.0, 1.5)
    assert (above.eye - above.target)[:2] == pytest.approx([0, 0], abs=1e-9)


def test_all_of_a_scene_is_in_the_frame(hill, table1):
    """Route out of the map and goal that wasn't reached included."""
    lost = Route([(5, 5, 50), (150, 30, 90)], reached=False, reason="stuck", info={"goal": (-20.0, 90, 10)})
    for city in (hill, table1, City(np.zeros((9, 40, 3), dtype=bool), 5.0)):
        drawing = drawing_of(city, (lost,))
        (low, high), more = city.bounds, [lost.points, [lost.info["goal"]]]
        more += [building.triangles().reshape(-1, 3) for building in city.buildings]
        floor = low[2] if city.ground is None else city.ground.min()
        ground = [(x, y, floor) for x in (low[0], high[0]) for y in (low[1], high[1])]
        points = np.concatenate([ground, *more]) - drawing.center
        for camera in ("overview", "above", "side", (100.0, 10.0)):
            seen = in_frame(points, view_of(drawing, camera, 0.0, 2.0, 1.5), 1.5)
            assert np.abs(seen).max() < 1.0
            assert np.abs(seen).max() > 0.8


@pytest.mark.parametrize("draw", [scene.page, scene.show, scene.still])
@pytest.mark.parametrize(
    ("camera", "message"),
    [
        ("below", "camera must be one of .*'chase', got 'below'"),
        ((10.0,), r"camera must be one of .*, or \(azimuth, elevation\) in degrees"),
        ((10.0, 95.0), "the elevation must be from -90 to 90, got 95"),
        ((np.nan, 0.0), "camera must be finite, got nan"),
        (3, r"or \(azimuth, elevation\) in degrees"),
        ("chase", "camera='chase' follows a UAV: give a route or a flight"),
    ],
)
def test_cameras_that_are_none(draw, camera, message):
    with pytest.raises(ValueError, match=message):
        draw(City(np.zeros((2, 2, 2), dtype=bool)), camera=camera)
