"""Views: all that is to be seen is in the frame and fills it."""

import numpy as np
import pytest

from uavlab.scene.camera import FIELD_OF_VIEW_DEG, MARGIN, chasing, checked_camera, fitted


def in_frame(view, points, aspect):
    """Places of points in the frame of a view, from -1 to 1 across and up."""
    back = view.eye - view.target
    back = back / np.linalg.norm(back)
    right = np.cross(view.up, back)
    a, b, depth = (points - view.eye) @ right, (points - view.eye) @ view.up, -(points - view.eye) @ back
    assert (depth > 0).all()
    tangent = np.tan(np.radians(FIELD_OF_VIEW_DEG) / 2)
    return np.column_stack([a / depth / tangent / aspect, b / depth / tangent])


@pytest.mark.parametrize("seed", range(20))
def test_everything_is_in_the_frame_and_touches_its_border(seed):
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(30, 3)) * rng.uniform(1, 100, 3) + rng.uniform(-50, 50, 3)
    aspect, direction = rng.uniform(0.4, 3.0), (rng.uniform(-180, 180), rng.uniform(-90, 90))
    places = in_frame(fitted(points, *direction, aspect), points, aspect)
    reach = np.abs(places).max()
    assert reach <= 1 / MARGIN + 1e-9
    assert reach > 0.99 / MARGIN  # on one pair of sides, at least
    tight = np.abs(places).max(axis=0).argmax()
    assert places[:, tight].max() == pytest.approx(-places[:, tight].min())


def test_directions_are_those_of_the_eye():
    points = np.random.default_rng(0).normal(size=(9, 3))
    for azimuth, elevation, side in ((0, 0, [1, 0, 0]), (90, 0, [0, 1, 0]), (-90, 45, [0, -(0.5**0.5), 0.5**0.5])):
        view = fitted(points, azimuth, elevation, 1.5)
        back = view.eye - view.target
        assert back / np.linalg.norm(back) == pytest.approx(side)
    above = fitted(points, -90.0, 90.0, 1.0)
    assert above.up == pytest.approx([0, 1, 0])  # north is up


def test_the_camera_that_follows_is_behind_and_above_and_looks_at_the_uav():
    view = chasing(np.array([5.0, 6.0, 30.0]), np.array([0.0, 2.0]), 2.0)
    assert view.target == pytest.approx([5, 6, 30])
    assert view.eye[0] == pytest.approx(5)
    assert view.eye[1] < 6 < 30 < view.eye[2]
    assert view.up @ (view.eye - view.target) == pytest.approx(0)
    assert view.up[2] > 0.5


@pytest.mark.parametrize(
    ("camera", "message"),
    [
        ("front", "camera must be one of 'overview', 'above', 'side', 'chase', got 'front'"),
        ((1, 2, 3), r"camera must be one of overview, above, side, chase, or \(azimuth, elevation\) in degrees"),
        ((0, 91), "the elevation must be from -90 to 90, got 91"),
        ((np.nan, 3), "camera must be"),
        (None, "camera must be"),
    ],
)
def test_unknown_cameras(camera, message):
    with pytest.raises(ValueError, match=message):
        checked_camera(camera)
