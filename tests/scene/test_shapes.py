"""Shapes: closed, as large as they are asked for, and where they should be."""

from collections import Counter
from itertools import pairwise

import numpy as np
import pytest

from uavlab.scene.shapes import arrow, ball, cone, dashed, quadrotor, thinned, tube, wind_sock


def volume_of(triangles):
    a, b, c = triangles.transpose(1, 0, 2)
    return np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6


def is_closed(triangles):
    """Whether each edge belongs to two triangles that run along it in opposite directions."""
    corners = np.round(triangles, 9).tolist()
    edges = Counter((tuple(t[i]), tuple(t[(i + 1) % 3])) for t in corners for i in range(3))
    return all(count == edges[end, start] for (start, end), count in edges.items())


BENT = np.array([[0.0, 0, 0], [0, 0, 5], [4, 0, 5], [4, 3, 6], [4, 3, 6], [-2, 3, 6]])


def test_a_tube_is_closed_and_surrounds_its_polyline():
    surface = tube(BENT, 0.5)
    assert is_closed(surface)
    assert volume_of(surface) > 0
    legs = [(a, b) for a, b in pairwise(BENT) if (a != b).any()]
    for corner in surface.reshape(-1, 3):
        shares = [np.clip((corner - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1) for a, b in legs]
        nearest = min(np.linalg.norm(corner - a - s * (b - a)) for (a, b), s in zip(legs, shares, strict=True))
        assert nearest <= 0.5 + 1e-9
    straight = tube(BENT[:2], 0.5)
    hexagon = 3 * np.sqrt(3) / 2 * 0.25
    assert volume_of(straight) == pytest.approx(5 * hexagon)


def test_a_tube_of_a_point_is_nothing():
    assert tube(np.array([[1.0, 2, 3], [1, 2, 3]]), 1.0).shape == (0, 3, 3)


def test_ball_cone_and_arrow_have_their_volumes():
    assert volume_of(ball(2.0, sides=96)) == pytest.approx(4 / 3 * np.pi * 8, rel=0.01)
    assert np.linalg.norm(ball(2.0), axis=-1).max() == pytest.approx(2.0)
    foot, tip = np.array([1.0, 2, 3]), np.array([1.0, 2, 9])
    assert volume_of(cone(foot, tip, 1.0)) == pytest.approx(np.pi / 3 * 6, rel=0.06)
    pointer = arrow(foot, tip, 0.5)
    assert (pointer.min(axis=(0, 1))[2], pointer.max(axis=(0, 1))[2]) == pytest.approx((3, 9))
    for shape in (ball(2.0), cone(foot, tip, 1.0, tip_radius=0.4), pointer):
        assert is_closed(shape)
        assert volume_of(shape) > 0


def test_a_quadrotor_is_as_wide_as_it_is_said_to_be_and_its_front_is_light():
    triangles, colors = quadrotor(0.7, (0.0, 0.4, 0.7))
    reach = np.linalg.norm(triangles.reshape(-1, 3)[:, :2], axis=1).max()
    assert reach == pytest.approx(0.35, rel=0.01)
    light = colors.sum(axis=1) > 2.0
    assert triangles[light][..., 0].mean() > 0.05 > triangles[~light][..., 0].mean()


@pytest.mark.parametrize("line", ["-", "--", "-.", ":", (0, (8, 2))])
def test_dashes_lie_on_the_polyline_and_fill_their_share_of_it(line):
    pieces = dashed(BENT, line, 0.2)
    length = sum(np.linalg.norm(np.diff(piece, axis=0), axis=1).sum() for piece in pieces)
    whole = np.linalg.norm(np.diff(BENT, axis=0), axis=1).sum()
    share = {"-": 1.0, "--": 3.7 / 5.3, "-.": 7.4 / 10.6, ":": 1 / 2.65, (0, (8, 2)): 0.8}[line]
    assert length / whole == pytest.approx(share, abs=0.05)
    assert pieces[0][0] == pytest.approx(BENT[0])
    assert len(pieces) == 1 if line == "-" else len(pieces) > 5


def test_thinned_keeps_ends_and_corners_and_stays_within_the_tolerance():
    angle = np.linspace(0, np.pi, 400)
    arc = np.column_stack([10 * np.cos(angle), 10 * np.sin(angle), np.zeros(400)])
    path = np.vstack([arc, [[-10.0, -30, 0], [-10, -30, 20]]])
    few = thinned(path, 0.05)
    assert len(few) < 60
    for end in (path[0], path[-1], path[-2]):
        assert (few == end).all(axis=1).any()
    dense = np.concatenate([np.linspace(a, b, 2000) for a, b in pairwise(few)])
    assert max(np.linalg.norm(dense - point, axis=1).min() for point in arc) < 0.06


def test_a_wind_sock_points_where_the_wind_blows_and_hangs_in_a_calm():
    foot = np.array([1.0, 2.0, 0.0])
    strong, _ = wind_sock(foot, np.array([12.0, 0.0]), 10.0)
    weak, _ = wind_sock(foot, np.array([0.3, 0.0]), 10.0)
    calm, _ = wind_sock(foot, np.zeros(2), 10.0)
    assert strong[..., 0].max() == pytest.approx(1 + 8, rel=0.1)
    assert strong[..., 2].max() > 10 > strong[..., 2][strong[..., 0] > 8].min() > 8
    assert weak[..., 0].max() < 3
    assert np.isfinite(calm).all()
