"""The outer surface of buildings of several pieces: nothing inside is kept, nothing outside is lost."""

import numpy as np
import pytest

from uavlab.city import Building, table1_buildings

ELL = [(0, 0), (6, 0), (6, 2), (2, 2), (2, 6), (0, 6)]
BLOCK, COURT = [(0, 0), (30, 0), (30, 20), (0, 20)], [(10, 5), (20, 5), (20, 15), (10, 15)]


def volume_of(triangles):
    a, b, c = triangles.transpose(1, 0, 2)
    return np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6


def area_of(triangles):
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    return np.linalg.norm(normals, axis=1).sum() / 2


def first_hits(triangles, origins, directions):
    """How far along rays (R, 3) the first of the triangles is hit, (R,)."""
    a, ab, ac = triangles[:, 0], triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    hits = []
    for origin, direction in zip(origins, directions, strict=True):
        across = np.cross(direction, ac)
        determinant = np.einsum("ij,ij->i", across, ab)
        with np.errstate(divide="ignore", invalid="ignore"):
            u = np.einsum("ij,ij->i", across, origin - a) / determinant
            turned = np.cross(origin - a, ab)
            v = turned @ direction / determinant
            t = np.einsum("ij,ij->i", turned, ac) / determinant
            hit = (u >= -1e-9) & (v >= -1e-9) & (u + v <= 1 + 1e-9) & (t > 0)
        hits.append(t[hit].min() if hit.any() else np.inf)
    return np.array(hits)


@pytest.mark.parametrize(
    ("building", "volume", "area"),
    [
        (Building.prism(ELL, 3), 60, 2 * 20 + 3 * 24),
        (Building.prism(BLOCK, 12, holes=[COURT]), 500 * 12, 2 * 500 + 12 * (100 + 40)),
        (Building.prism(BLOCK, 12), 600 * 12, 2 * 600 + 12 * 100),
    ],
    ids=["ell", "courtyard", "box"],
)
def test_walls_between_pieces_are_left_out(building, volume, area):
    assert volume_of(building.triangles()) == pytest.approx(volume)
    assert area_of(building.triangles()) == pytest.approx(area)


SOLIDS = [*table1_buildings(), Building.prism(ELL, 3), Building.prism(BLOCK, 9, holes=[COURT])]


@pytest.mark.parametrize("building", SOLIDS)
def test_nothing_that_can_be_seen_is_lost(building):
    rng = np.random.default_rng(4)
    center, reach = building.bounds.mean(axis=0), np.linalg.norm(np.ptp(building.bounds, axis=0))
    outward = rng.normal(size=(300, 3))
    origins = center + reach * outward / np.linalg.norm(outward, axis=1, keepdims=True)
    directions = center + rng.uniform(-0.4, 0.4, (300, 3)) * np.ptp(building.bounds, axis=0) - origins
    pieces = np.concatenate([hull.triangles for hull in building.hulls])
    found, expected = (first_hits(triangles, origins, directions) for triangles in (building.triangles(), pieces))
    assert found == pytest.approx(expected)
    assert np.isfinite(expected).mean() > 0.5


def test_edges_are_drawn_where_the_surface_bends_and_not_across_a_flat_roof():
    edges = Building.prism(ELL, 3).edges().reshape(-1, 2, 3)
    assert len(edges) == 18
    lengths = np.linalg.norm(edges[:, 1] - edges[:, 0], axis=1)
    assert lengths.sum() == pytest.approx(2 * 24 + 6 * 3)


def test_a_sheet_of_thin_pieces_keeps_its_two_sides_and_its_rim():
    """Terrain and trees come as triangles that were given a thickness."""
    x, y = np.meshgrid(np.arange(5.0), np.arange(4.0), indexing="ij")
    z = 0.02 * np.sin(x + 2 * y)  # bends by less than 10 degrees
    points = np.stack([x, y, z], axis=-1)
    corners = [points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]]
    sheets = [np.stack([corners[i] for i in order], axis=-2).reshape(-1, 3, 3) for order in ((0, 1, 2), (0, 2, 3))]
    triangles = np.concatenate(sheets)
    building = Building(tuple(np.vstack([t, t + np.array([0, 0, 0.1])]) for t in triangles))
    surface = building.triangles()
    assert len(surface) == 2 * len(triangles) + 2 * 2 * (4 + 3)
    edges = building.edges().reshape(-1, 2, 3)
    ends = np.isin(np.round(edges[..., 0], 6), (0, 4)) | np.isin(np.round(edges[..., 1], 6), (0, 3))
    assert ends.all()  # lines at the rim only
