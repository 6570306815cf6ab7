"""The rasteriser against rays: each pixel has what a ray through it meets first."""

import numpy as np
import pytest
from matplotlib.colors import to_rgb

from uavlab.scene import raster
from uavlab.scene.camera import FIELD_OF_VIEW_DEG, View, fitted
from uavlab.scene.drawing import Dots, Lines, Surface
from uavlab.scene.raster import FINER, NEAREST, Frame
from uavlab.scene.shapes import ball

NOWHERE = np.zeros(3)
WALL = np.array([[(-9.0, 0, -9), (9, 0, -9), (9, 0, 9)], [(-9.0, 0, -9), (9, 0, 9), (-9, 0, 9)]])
"""In the plane y = 0."""
NORTHWARD = View(np.array([0.0, -10, 0]), np.zeros(3), np.array([0.0, 0, 1]))


def random_view(rng):
    return fitted(rng.uniform(-1, 1, (20, 3)), rng.uniform(-180, 180), rng.uniform(-80, 80), 1.5)


def rays_of(view, width, height):
    """Direction (H, W, 3) of the ray through the middle of each fine pixel, one metre deep."""
    back = (view.eye - view.target) / np.linalg.norm(view.eye - view.target)
    right = np.cross(view.up, back)
    rows, columns = FINER * height, FINER * width
    upright = np.tan(np.radians(FIELD_OF_VIEW_DEG / 2))
    b = upright * (1 - 2 * (np.arange(rows) + 0.5) / rows)
    a = upright * width / height * (2 * (np.arange(columns) + 0.5) / columns - 1)
    return a[None, :, None] * right + b[:, None, None] * view.up - back


def depths(view, rays, triangles):
    """How deep (T, H, W) [m] a ray meets each triangle, by Möller and Trumbore; infinite where it doesn't."""
    least = 1.01 * NEAREST * np.linalg.norm(view.eye - view.target)
    found = np.full((len(triangles), *rays.shape[:2]), np.inf)
    for number, (a, b, c) in enumerate(triangles):
        p = np.cross(rays, c - a)
        across = p @ (b - a)
        with np.errstate(divide="ignore", invalid="ignore"):
            u, q = p @ (view.eye - a) / across, np.cross(view.eye - a, b - a)
            v, depth = rays @ q / across, (c - a) @ q / across
            met = (u >= 0) & (v >= 0) & (u + v <= 1) & (depth > least)
        found[number][met] = depth[met]
    return found


def differing(one, other):
    """Share of pixels that differ."""
    return np.mean(~np.isclose(one, other, rtol=1e-9, atol=1e-9).reshape(*one.shape[:2], -1).all(axis=-1))


def drawn(view, parts, width=60, height=40):
    frame = Frame(view, width, height)
    frame.draw(parts, NOWHERE)
    return frame


def as_parts(triangles, colors, opacity=1.0):
    return {"all": Surface(triangles, colors, opacity, lit=False)}


@pytest.mark.parametrize("seed", range(6))
def test_each_pixel_has_the_nearest_triangle(seed):
    """Large ones, that pass through each other, and some reach behind the eye."""
    rng = np.random.default_rng(seed)
    view = random_view(rng)
    triangles = rng.uniform(-1, 1, (12, 3, 3))
    triangles[:3] += 1.5 * (view.eye - triangles[:3]) * rng.uniform(0, 1, (3, 3, 1))
    colors = rng.random((12, 3))
    frame = drawn(view, as_parts(triangles, colors))
    depth = depths(view, rays_of(view, 60, 40), triangles)
    nearest, hit = depth.argmin(axis=0), np.isfinite(depth.min(axis=0))
    assert hit.mean() > 0.1
    background = Frame(view, 60, 40).pixels
    expected = np.where(hit[..., None], colors[nearest], background)
    assert differing(frame.pixels, expected) < 2e-3  # on edges, by rounding
    assert differing(frame.near, np.where(hit, 1 / depth.min(axis=0), 0.0)) < 2e-3
    assert len(np.unique(nearest[hit])) > 3


def test_triangles_that_reach_behind_the_eye_are_cut_off_not_left_out():
    floor = np.array([[(-500.0, -500, -1), (500, -500, -1), (0, 500, -1)]])
    frame = drawn(NORTHWARD, as_parts(floor, "#00ff00"))
    assert np.allclose(frame.pixels[-1], (0, 1, 0))  # to the lowest row
    assert not np.allclose(frame.pixels[0], (0, 1, 0))
    behind = floor - (0, 1100, 0)
    assert not drawn(NORTHWARD, as_parts(behind, "#00ff00")).near.any()


def test_bodies_have_no_tears():
    """A ball of many triangles: along each row of its picture, from its left end to its right, nothing is missing."""
    rng = np.random.default_rng(3)
    for _ in range(5):
        frame = drawn(random_view(rng), as_parts(ball(0.9, sides=60), "#ff0000"))
        covered = frame.near > 0
        assert covered.mean() > 0.05
        for line in (*covered, *covered.T):
            inside = np.flatnonzero(line)
            assert len(inside) == np.ptp(inside) + 1 if len(inside) else True


def test_a_light_face_is_seen_from_both_sides():
    for turn in (1, -1):
        frame = Frame(NORTHWARD, 9, 9)
        frame.draw({"wall": Surface(WALL[:, ::turn], "#808080")}, NOWHERE)
        assert np.allclose(frame.pixels, frame.pixels[0, 0])
        facing = max(0.0, float(raster.SUN @ (0, -1, 0)))
        assert frame.pixels[0, 0, 0] == pytest.approx(128 / 255 * (raster.AMBIENT + raster.SUNLIT * facing))


def test_panes_let_through_what_is_behind_them_from_far_to_near():
    red, blue = np.array(to_rgb("#ff0000")), np.array(to_rgb("#0000ff"))
    green = np.array([0.0, 1.0, 0.0])
    parts = {
        "near": Surface(WALL - (0, 2, 0), "#0000ff", 0.25, lit=False),
        "far": Surface(WALL, "#ff0000", 0.5, lit=False),
        "hidden": Surface(np.add(WALL, (0, 4, 0)), "#ffff00", 0.5, lit=False),
        "solid": Surface(np.add(WALL, (0, 3, 0)), "#00ff00", lit=False),
    }
    expected = 0.25 * blue + 0.75 * (0.5 * red + 0.5 * green)
    for names in (list(parts), list(parts)[::-1]):
        frame = drawn(NORTHWARD, {name: parts[name] for name in names})
        assert np.allclose(frame.pixels, expected)
    one = {"all": Surface(np.concatenate([WALL - (0, 2, 0), WALL]), np.repeat([blue, red], 2, axis=0), 0.5, lit=False)}
    assert np.allclose(drawn(NORTHWARD, {**one, "solid": parts["solid"]}).pixels,
                       0.5 * blue + 0.5 * (0.5 * red + 0.5 * green))  # fmt: skip


def test_panes_hide_nothing_and_of_two_in_one_place_the_first_is_seen():
    pane = Surface(WALL, "#ff0000", 0.5, lit=False)
    assert not drawn(NORTHWARD, {"pane": pane}).near.any()
    both = {"first": Surface(WALL, "#ff0000", lit=False), "second": Surface(WALL, "#0000ff", lit=False)}
    assert np.allclose(drawn(NORTHWARD, both).pixels, (1, 0, 0))


def column_of(x, y, width=60, height=40):
    """In the picture of `NORTHWARD`."""
    return width / 2 + height / 2 / np.tan(np.radians(FIELD_OF_VIEW_DEG / 2)) * x / (y + 10)


def test_lines_are_seen_where_nothing_is_nearer():
    """A line that comes from behind the wall through it towards the eye."""
    line = Lines(np.array([(-2.0, 5, 0), (1.0, -5, 0)]), "#ff0000")  # through the wall at x = -0.5
    frame = drawn(NORTHWARD, {"wall": Surface(WALL, "#ffffff", lit=False), "line": line})
    red = np.flatnonzero(np.isclose(frame.pixels[40], (1, 0, 0)).all(axis=-1)) / FINER
    assert red.min() == pytest.approx(column_of(-0.5, 0), abs=1.5)
    assert red.max() == pytest.approx(column_of(1.0, -5), abs=1.5)
    assert len(red) == FINER * np.ptp(red) + 1
    i, j = np.argwhere(np.isclose(frame.pixels, (1, 0, 0)).all(axis=-1))[-1]
    y = line.ends[1, 1]
    assert 1 / frame.near[i, j] == pytest.approx(y + 10, rel=0.02)
    on_the_wall = Lines(np.array([(-2.0, 0, 1), (2, 0, 1.3)]), "#ff0000")
    frame = drawn(NORTHWARD, {"wall": Surface(WALL, "#ffffff", lit=False), "line": on_the_wall})
    columns = np.isclose(frame.pixels, (1, 0, 0)).all(axis=-1).any(axis=0)
    assert columns.sum() == pytest.approx(FINER * (column_of(2, 0) - column_of(-2, 0)), abs=3)


@pytest.mark.parametrize("seed", range(4))
def test_lines_that_run_out_of_the_picture_or_behind_the_eye_are_cut_off(seed):
    rng = np.random.default_rng(seed)
    view = random_view(rng)
    back = view.eye - view.target
    ends = np.array([view.eye + 3 * back + rng.uniform(-1, 1, 3), view.target - 400 * back + rng.uniform(-1, 1, 3)])
    if seed % 2:
        ends = ends[::-1]
    frame = drawn(view, {"line": Lines(ends, "#ff0000")})
    share = np.linspace(0, 1, 400_000)[:, None]
    points = ends[0] + share * (ends[1] - ends[0])
    points = points[(points - view.eye) @ -back / np.linalg.norm(back) > 1.05 * NEAREST * np.linalg.norm(back)]
    columns, rows = frame.projected(points)[:, :2].T
    inside = (columns > 1) & (columns < frame.shape[1] - 1) & (rows > 1) & (rows < frame.shape[0] - 1)
    assert inside.any()
    red = np.isclose(frame.pixels, (1, 0, 0)).all(axis=-1)
    assert red[rows[inside].astype(int), columns[inside].astype(int)].all()
    places = np.column_stack([rows[inside], columns[inside]])
    for pixel in np.argwhere(red) + 0.5:
        assert np.linalg.norm(places - pixel, axis=1).min() < 2.5


def test_lines_beside_the_picture_are_not_drawn():
    ends = np.array([(50.0, 0, -9), (50, 0, 9), (-9, 0, 50), (9, 0, 50), (-9, -30, 0), (9, -30, 0)])
    assert not drawn(NORTHWARD, {"lines": Lines(ends, "#ff0000")}).near.any()
    assert not drawn(NORTHWARD, {"none": Lines(np.empty((0, 3)), "#ff0000")}).near.any()


def test_dots_are_as_large_as_they_say_and_hide_what_is_behind():
    size, depth = 1.5, 10
    for y in (-5.0, 0.0):
        frame = drawn(NORTHWARD, {"dot": Dots(np.array([[0.3, y, 0.2]]), "#ff0000", size)}, 120, 80)
        red = np.isclose(frame.pixels, (1, 0, 0)).all(axis=-1)
        across = FINER * 80 / 2 / np.tan(np.radians(FIELD_OF_VIEW_DEG / 2)) * size / (y + depth)
        assert red.any(axis=0).sum() == pytest.approx(across, abs=1)
        assert red.any(axis=1).sum() == pytest.approx(across, abs=1)
        assert np.flatnonzero(red.any(axis=0)).mean() + 0.5 == pytest.approx(
            FINER * column_of(0.3, y, 120, 80), abs=0.6
        )
    pair = {"far": Dots(np.array([[0.0, 2, 0]]), "#0000ff", 1.0), "near": Dots(np.array([[0.0, 0, 0]]), "#ff0000", 1.0)}
    for names in (("far", "near"), ("near", "far")):
        frame = drawn(NORTHWARD, {name: pair[name] for name in names})
        assert np.allclose(frame.pixels[40, 60], (1, 0, 0))
    assert not drawn(NORTHWARD, {"dot": Dots(np.array([[0.0, -20, 0]]), "#ff0000", 1.0)}).near.any()
    above = Dots(np.array([[0.0, 0, 4.5]]), "#ff0000", 1.0)  # its lower end is just above the picture
    assert not drawn(NORTHWARD, {"dot": above}).near.any()


def test_the_picture_is_the_mean_of_the_finer_one():
    frame = Frame(NORTHWARD, 6, 4)
    frame.pixels = np.random.default_rng(0).random(frame.pixels.shape)
    expected = sum(frame.pixels[i::FINER, j::FINER] for i in range(FINER) for j in range(FINER)) / FINER**2
    assert np.allclose(frame.picture(), expected)


def test_points_are_where_their_pixels_are():
    rng = np.random.default_rng(5)
    view = random_view(rng)
    points = rng.uniform(-0.6, 0.6, (30, 3))
    for point, (column, row) in zip(points, Frame(view, 60, 40).places(points), strict=True):
        frame = drawn(view, {"dot": Dots(point[None], "#ff0000", 0.001)})
        rows, columns = np.nonzero(frame.near)
        assert (rows.mean() + 0.5) / FINER == pytest.approx(row, abs=0.75)
        assert (columns.mean() + 0.5) / FINER == pytest.approx(column, abs=0.75)
    assert np.isnan(Frame(view, 60, 40).places(view.eye[None] + (view.eye - view.target))).all()


def test_coordinates_are_counted_from_the_centre():
    center = np.array([500_000.0, 5_700_000.0, 30.0])
    parts = {"wall": Surface(WALL + center, "#123456"), "line": Lines(WALL[0, :2] + center - (0, 1, 0), "#ff0000"),
             "dot": Dots(center[None] - (0, 1, 0), "#00ff00", 1.0)}  # fmt: skip
    far, near = Frame(NORTHWARD, 30, 20), Frame(NORTHWARD, 30, 20)
    far.draw(parts, center)
    near.draw({"wall": Surface(WALL, "#123456"), "line": Lines(WALL[0, :2] - (0, 1, 0), "#ff0000"),
               "dot": Dots(np.array([[0.0, -1, 0]]), "#00ff00", 1.0)}, NOWHERE)  # fmt: skip
    assert np.allclose(far.pixels, near.pixels)


def test_without_numba_the_picture_is_the_same(monkeypatch):
    rng = np.random.default_rng(2)
    view = random_view(rng)
    parts = {
        "solid": Surface(rng.uniform(-1, 1, (6, 3, 3)), rng.random((6, 3))),
        "glass": Surface(rng.uniform(-1, 1, (4, 3, 3)), "#0000ff", 0.4),
        "lines": Lines(rng.uniform(-2, 2, (8, 3)), "#ff0000"),
        "dots": Dots(rng.uniform(-1, 1, (5, 3)), "#00ff00", 0.1),
    }
    fast = drawn(view, parts, 30, 20)
    for name in ("fill", "stroke", "dot"):
        monkeypatch.setattr(raster, name, getattr(raster, name).py_func)
    plain = drawn(view, parts, 30, 20)
    assert differing(fast.pixels, plain.pixels) < 1e-3
    assert differing(fast.near, plain.near) < 1e-3
