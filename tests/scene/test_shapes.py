"""Shapes: closed, as thick as asked for; dashes as in matplotlib; thinning within its tolerance."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from uavlab.scene.shapes import DASHES, arrow, ball, cone, dashed, quadrotor, thinned, tube, wind_sock


def volume_of(triangles):
    return np.einsum("ij,ij->i", triangles[:, 0], np.cross(triangles[:, 1], triangles[:, 2])).sum() / 6


def is_closed(triangles):
    """Each edge is run along as often one way as the other."""
    corners = np.unique(triangles.reshape(-1, 3).round(9), axis=0, return_inverse=True)[1].reshape(-1, 3)
    edges = corners[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    edges = edges[edges[:, 0] != edges[:, 1]]
    return sorted(map(tuple, edges)) == sorted(map(tuple, edges[:, ::-1]))


def distance_to(points, line):
    """Of points (P, 3) to a polyline (N, 3)."""
    legs = np.diff(line, axis=0)
    share = np.einsum("pnj,nj->pn", points[:, None] - line[:-1], legs) / (legs**2).sum(axis=1)
    feet = line[:-1] + np.clip(share, 0, 1)[..., None] * legs
    return np.linalg.norm(points[:, None] - feet, axis=2).min(axis=1)


def random_walk(seed, steps):
    return np.cumsum(np.random.default_rng(seed).normal(size=(steps, 3)), axis=0)


@given(st.integers(0, 10**6), st.integers(2, 30))
def test_tubes_are_closed_and_as_thick_as_asked_for(seed, steps):
    line = 10 * random_walk(seed, steps)
    triangles = tube(line, 0.5)
    assert is_closed(triangles)
    distance = distance_to(triangles.reshape(-1, 3), line)
    assert distance.max() <= 0.5 + 1e-9
    middles = distance_to(triangles.mean(axis=1), line)
    assert middles.max() < 0.5


def test_a_straight_tube_is_a_prism_of_six_sides():
    line = np.array([(1.0, 2, 3), (4, 6, 3)])
    triangles = tube(line, 0.5)
    assert volume_of(triangles) == pytest.approx(5 * 6 * 0.5 * 0.5**2 * np.sin(np.pi / 3))
    twice = tube(np.repeat(line, 3, axis=0), 0.5)  # points that stay
    assert np.array_equal(twice, triangles)
    assert len(tube(line[:1], 0.5)) == len(tube(line[[0, 0]], 0.5)) == 0


@pytest.mark.parametrize("turn", [(0, 0, 5), (0, 0, -5), (-5, 0, 0), (0, 5, 0)])
def test_tubes_turn_up_down_and_back(turn):
    line = np.cumsum([(0, 0, 0), (5, 0, 0), turn, (5, 0, 0)], axis=0, dtype=float)
    triangles = tube(line, 0.2)
    assert np.isfinite(triangles).all()
    assert is_closed(triangles)
    assert distance_to(triangles.reshape(-1, 3), line).max() <= 0.2 + 1e-9


@given(st.integers(0, 10**6), st.integers(1, 300), st.sampled_from([0.01, 0.3, 2.0]))
def test_thinned_lines_stay_within_their_tolerance(seed, steps, tolerance):
    line = np.repeat(random_walk(seed, steps) * (1, 0.05, 0.05), 2, axis=0)
    thin = thinned(line, tolerance)
    assert np.array_equal(thin[[0, -1]], line[[0, -1]])
    assert len(thin) <= len(line) / 2
    if len(thin) > 1:
        assert distance_to(line, thin).max() <= tolerance


def test_a_smooth_line_of_many_points_becomes_one_of_few():
    angle = np.linspace(0, np.pi, 2000)
    thin = thinned(100 * np.column_stack([np.cos(angle), np.sin(angle), 0 * angle]), 0.1)
    assert len(thin) < 150  # 36 would do
    assert len(thinned(np.column_stack([angle, angle, angle]), 0.1)) == 2


@pytest.mark.parametrize("line", ["-", "--", "-.", ":", (0, (5, 1, 1, 1)), (0, (8, 2))])
def test_dashes_are_as_long_as_in_matplotlib(line):
    points = np.cumsum([(0, 0, 0), (30, 0, 0), (0, 40, 0), (0, 0, 17)], axis=0, dtype=float)
    pieces = dashed(points, line, 0.5)
    lengths = [np.linalg.norm(np.diff(piece, axis=0), axis=1).sum() for piece in pieces]
    pattern = 0.5 * np.array(DASHES[line] if isinstance(line, str) else line[1])
    if line == "-":
        assert len(pieces) == 1
        assert np.array_equal(pieces[0], points)
        return
    marks = np.concatenate([[0], np.cumsum(np.resize(pattern, 4000))])
    marks = marks[marks < 87.0]
    ends = np.append(marks, 87.0)
    assert lengths == pytest.approx(np.diff(ends)[::2].tolist())
    assert np.array_equal(pieces[0][0], points[0])
    assert distance_to(np.concatenate(pieces), points).max() < 1e-9
    assert sum(np.isclose(piece, points[1]).all(axis=1).any() for piece in pieces) <= 1


def test_matplotlib_s_own_dashes_are_meant():
    import matplotlib

    for style, name in (("--", "dashed"), ("-.", "dashdot"), (":", "dotted")):
        assert DASHES[style] == tuple(matplotlib.rcParamsDefault[f"lines.{name}_pattern"])


def test_balls_cones_and_arrows_are_closed():
    assert volume_of(ball(3.0, sides=60)) == pytest.approx(4 / 3 * np.pi * 27, rel=0.01)
    foot, tip = np.array([1.0, 2, 3]), np.array([1.0, 2, 9])
    assert volume_of(cone(foot, tip, 2.0)) == pytest.approx(np.pi * 4 * 6 / 3, rel=0.06)
    for shape in (ball(3.0), cone(foot, tip, 2.0), cone(foot, tip, 2.0, tip_radius=1.0), arrow(foot, tip, 0.5)):
        assert is_closed(shape)
    ends = arrow(foot, tip, 0.5)[..., 2]
    assert (ends.min(), ends.max()) == (3.0, 9.0)
    wide = np.abs(arrow(foot, tip, 0.5)[..., 0] - 1.0)
    assert wide[ends > 6.5].max() > 2 * wide[ends < 6.5].max()  # the head is at the tip


def test_a_wind_sock_is_the_more_level_the_stronger_the_wind():
    foot = np.array([5.0, 5, 2])
    drops = []
    for speed in (0.0, 1.0, 3.0, 8.0):
        triangles, colors = wind_sock(foot, speed * np.array([0.6, 0.8]), 10.0)
        assert triangles.shape == (*colors.shape[:1], 3, 3)
        assert np.isfinite(triangles).all()
        sock = triangles[len(tube(np.array([foot, np.add(foot, [0, 0, 10])]), 0.2)) :]
        end = sock[-12:].mean(axis=(0, 1)) - (np.add(foot, [0, 0, 10]))  # the fan that closes it
        drops.append(np.degrees(np.arctan2(-end[2], np.hypot(*end[:2]))))
        if speed:
            assert end[:2] / np.hypot(*end[:2]) == pytest.approx([0.6, 0.8], abs=0.05)
    assert drops == sorted(drops, reverse=True)
    assert drops[0] == pytest.approx(90, abs=5)
    assert drops[-1] == pytest.approx(0, abs=5)
    assert np.array_equal(np.unique(triangles[..., 2])[:1], [2.0])  # its mast stands on the ground


def test_a_quadrotor_is_in_its_colour_with_light_rotors_in_front():
    triangles, colors = quadrotor(1.0, (0.0, 0.0, 1.0))
    places, light = triangles.mean(axis=1), colors[:, 0] > 0.5
    assert (places[light, 0] > 0).all()
    assert light.mean() > 0.2
    assert np.abs(places[light, 1]).min() > 0.05  # left and right
    assert np.allclose(triangles.reshape(-1, 3)[:, :2].min(axis=0), -triangles.reshape(-1, 3)[:, :2].max(axis=0))
    assert colors[~light, 2].min() >= 0.7
