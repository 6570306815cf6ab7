"""The rasteriser, against rays that are cast through each pixel."""

import numpy as np
import pytest

from uavlab.scene.camera import FIELD_OF_VIEW_DEG, View
from uavlab.scene.drawing import Dots, Lines, Surface
from uavlab.scene.raster import FINER, LIFTED, Frame, shaded

NOWHERE = np.zeros(3)
VIEW = View(np.array([0.0, -10.0, 0.0]), NOWHERE, np.array([0.0, 0.0, 1.0]))


def rays(frame):
    """Directions (rows, columns, 3) through the fine pixels, of a depth of 1."""
    rows, columns = frame.shape
    focus = rows / 2 / np.tan(np.radians(FIELD_OF_VIEW_DEG) / 2)
    x = (np.arange(columns) + 0.5 - columns / 2) / focus
    y = (rows / 2 - np.arange(rows) - 0.5) / focus
    right, up, back = frame.axes
    return x[None, :, None] * right + y[:, None, None] * up - back


def depths(triangle, eye, directions):
    """How far along the directions a triangle is hit (rows, columns), infinite where it isn't: Möller and Trumbore."""
    a, b, c = triangle
    across = np.cross(directions, c - a)
    determinant = across @ (b - a)
    with np.errstate(divide="ignore", invalid="ignore"):
        u = across @ (eye - a) / determinant
        v = directions @ np.cross(eye - a, b - a) / determinant
        t = np.cross(eye - a, b - a) @ (c - a) / determinant
        hit = (u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0)
    return np.where(hit, t, np.inf)


def drawn(parts, view=VIEW, width=60, height=40):
    frame = Frame(view, width, height)
    frame.draw(parts, NOWHERE)
    return frame


@pytest.mark.parametrize("seed", range(6))
def test_each_pixel_shows_the_nearest_triangle(seed):
    rng = np.random.default_rng(seed)
    triangles = rng.uniform(-3, 3, (1, 3)) * [1, 0, 0] + rng.uniform(-3, 3, (12, 3, 3))  # they pass through each other
    colors = rng.uniform(0, 1, (12, 3))
    frame = drawn({"all": Surface(triangles, colors, lit=False)})
    hits = np.array([depths(triangle, VIEW.eye, rays(frame)) for triangle in triangles])
    nearest = hits.min(axis=0)
    expected = np.where(np.isfinite(nearest)[..., None], colors[hits.argmin(axis=0)], Frame(VIEW, 60, 40).pixels)
    wrong = (np.abs(frame.pixels - expected) > 1e-9).any(axis=-1)
    assert wrong.mean() < 1e-3  # a pixel exactly on an edge may be either's
    seen = np.isfinite(nearest) & ~wrong
    assert frame.near[seen] == pytest.approx(1 / nearest[seen], rel=1e-6)
    assert seen.mean() > 0.1


def test_a_triangle_that_reaches_behind_the_eye_is_cut_off_in_front_of_it():
    ground = np.array([[[-50.0, 50, -2], [50, 50, -2], [0, -80, -2]]])
    frame = drawn({"ground": Surface(ground, "#FF0000", lit=False)})
    hit = depths(ground[0], VIEW.eye, rays(frame))
    red = (frame.pixels == [1.0, 0.0, 0.0]).all(axis=-1)
    ahead = np.isfinite(hit)
    assert ahead.any()
    assert (red == ahead).mean() > 0.999


def test_what_can_be_looked_through_is_mixed_from_far_to_near_in_any_order():
    wall = np.array([[[-9.0, 0, -9], [9, 0, -9], [0, 0, 15]]])
    red, green, blue = (
        Surface(wall + np.array([0, y, 0]), color, opacity, lit=False)
        for y, color, opacity in ((-3.0, "#FF0000", 0.5), (-1.0, "#00FF00", 0.25), (2.0, "#0000FF", 1.0))
    )
    expected = 0.5 * np.array([1.0, 0, 0]) + 0.5 * (0.25 * np.array([0, 1.0, 0]) + 0.75 * np.array([0, 0, 1.0]))
    for parts in ((red, green, blue), (blue, green, red), (green, blue, red)):
        frame = drawn(dict(zip("abc", parts, strict=True)))
        assert frame.pixels[40, 60] == pytest.approx(expected)
    behind = drawn({"wall": blue, "glass": Surface(wall + np.array([0, 4, 0]), "#FF0000", 0.5, lit=False)})
    assert behind.pixels[40, 60] == pytest.approx([0, 0, 1])


def test_faces_to_the_light_are_brighter_and_either_side_is_lit():
    up = np.array([[[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]])
    colors = np.ones((1, 3))
    above, below = np.array([0.0, 0, 9]), np.array([0.0, 0, -9])
    light = shaded(up, colors, above)
    assert light == pytest.approx(shaded(up[:, ::-1], colors, above))
    assert light.mean() > shaded(up, colors, below).mean() == pytest.approx(0.6)


def test_lines_lie_on_the_faces_that_they_bound_and_behind_what_is_nearer():
    wall = Surface(np.array([[[-3.0, 0, -3], [3, 0, -3], [0, 0, 4]]]), "#FF0000", lit=False)
    line = Lines(np.array([[-9.0, 0, 0], [9, 0, 0]]), "#000000")
    frame = drawn({"wall": wall, "line": line})
    assert (frame.pixels[40, 40:80] == 0).all()
    assert frame.near[40, 60] == pytest.approx(LIFTED / 10)
    hidden = drawn({"wall": Surface(wall.triangles - [0, 1, 0], "#FF0000", lit=False), "line": line})
    assert (hidden.pixels[40, 60] == [1, 0, 0]).all()
    assert (hidden.pixels[40, 5] == 0).all()


def test_dots_are_as_large_as_they_are_far():
    near, far = (drawn({"dot": Dots(np.array([[0.0, y, 0]]), "#000000", 1.0)}, width=200, height=200) for y in (-5, 5))
    counts = [np.sqrt((frame.pixels == 0).all(axis=-1).sum()) for frame in (near, far)]
    focus = 200 * FINER / 2 / np.tan(np.radians(FIELD_OF_VIEW_DEG) / 2)
    assert counts == pytest.approx([focus / 5, focus / 15], abs=2)


def test_a_picture_averages_the_fine_pixels_and_places_are_in_it():
    frame = drawn({"wall": Surface(np.array([[[-9.0, 0, -9], [9, 0, -9], [0, 0, 15]]]), "#FF0000", lit=False)})
    assert frame.picture().shape == (40, 60, 3)
    assert frame.places(np.array([[0.0, 0, 0], [0, -30.0, 0]])) == pytest.approx(
        np.array([[30.0, 20.0], [np.nan, np.nan]]), nan_ok=True
    )
