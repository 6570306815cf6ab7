"""Buildings against closed forms: which points they contain, how much they hold, what their surface encloses."""

from collections import Counter

import numpy as np
import pytest
import shapely
from scipy.spatial import ConvexHull

from uavlab.city import Building, City, table1_buildings
from uavlab.city.buildings import convex_parts

SQUARE = [(0, 0), (4, 0), (4, 4), (0, 4)]
ELL = [(0, 0), (6, 0), (6, 2), (2, 2), (2, 6), (0, 6)]
COURTYARD = [(3, 3), (7, 3), (7, 7), (3, 7)]


def scattered(low, high, count=20_000, seed=1):
    return np.random.default_rng(seed).uniform(low, high, (count, 3))


def test_box_contains_what_lies_between_its_faces():
    box = Building.prism([(1, 2), (4, 2), (4, 6), (1, 6)], 5, bottom=1)
    points = scattered(-1, 8)
    x, y, z = points.T
    assert np.array_equal(box.contains(points), (x >= 1) & (x <= 4) & (y >= 2) & (y <= 6) & (z >= 1) & (z <= 5))
    assert box.contains([(1, 2, 1), (4, 6, 5), (2, 3, 5)]).all()  # the surface belongs to it
    assert not box.contains([(1 - 1e-6, 3, 3), (2, 3, 5 + 1e-6)]).any()


def test_contains_keeps_the_shape_of_its_argument():
    box = Building.prism(SQUARE, 4)
    assert box.contains((1, 1, 1)).shape == ()
    assert box.contains(np.ones((2, 5, 3))).shape == (2, 5)


def test_gable_roof_falls_linearly_from_ridge_to_eaves():
    gable = Building.roofed([(0, 0), (10, 0), (10, 6), (0, 6)], 4, [(0, 3, 7), (10, 3, 7)])
    points = scattered((-1, -1, -1), (11, 7, 8))
    x, y, z = points.T
    inside = (x >= 0) & (x <= 10) & (y >= 0) & (y <= 6) & (z >= 0) & (z <= 7 - np.abs(y - 3))
    assert np.array_equal(gable.contains(points), inside)


def test_floating_building_leaves_the_air_below_free():
    floating = Building.prism(SQUARE, 10, bottom=6)
    assert floating.contains((2, 2, 8))
    assert not floating.contains([(2, 2, 5.9), (2, 2, 10.1), (2, 2, 0)]).any()


def test_ell_with_courtyard_contains_neither_notch_nor_courtyard():
    outline = [(0, 0), (20, 0), (20, 10), (10, 10), (10, 20), (0, 20)]
    building = Building.prism(outline, 3, holes=[COURTYARD])
    points = scattered((-1, -1, -1), (21, 21, 4))
    x, y, z = points.T
    ell = (x >= 0) & (y >= 0) & (x <= 20) & (y <= 20) & ((x <= 10) | (y <= 10))
    courtyard = (x > 3) & (x < 7) & (y > 3) & (y < 7)
    assert np.array_equal(building.contains(points), ell & ~courtyard & (z >= 0) & (z <= 3))


VOLUMES = {
    "box": (Building.prism(SQUARE, 5, bottom=2), 4 * 4 * 3),
    "gable": (
        Building.roofed([(0, 0), (10, 0), (10, 6), (0, 6)], 4, [(0, 3, 7), (10, 3, 7)]),
        10 * 6 * 4 + 10 * 6 * 3 / 2,
    ),
    "pyramid on walls": (Building.roofed(SQUARE, 3, (2, 2, 6)), 4 * 4 * 3 + 4 * 4 * 3 / 3),
    "frustum": (
        Building.hull([(0, 0, 0), (8, 0, 0), (8, 8, 0), (0, 8, 0), (2, 2, 6), (6, 2, 6), (6, 6, 6), (2, 6, 6)]),
        6 / 3 * (64 + 16 + np.sqrt(64 * 16)),
    ),
    "ell": (Building.prism(ELL, 3), (12 + 8) * 3),
    "courtyard": (Building.prism([(0, 0), (10, 0), (10, 10), (0, 10)], 2, holes=[COURTYARD]), (100 - 16) * 2),
}


@pytest.mark.parametrize(("building", "volume"), VOLUMES.values(), ids=VOLUMES)
def test_volume_is_the_closed_form_without_overlap_of_pieces(building, volume):
    assert sum(ConvexHull(piece).volume for piece in building.pieces) == pytest.approx(volume, rel=1e-9)


@pytest.mark.parametrize("cell", [0.5, 0.2])
@pytest.mark.parametrize(("building", "volume"), VOLUMES.values(), ids=VOLUMES)
def test_voxels_hold_the_volume_within_half_a_cell_of_the_surface(building, volume, cell):
    shifted = np.array([-1.07, -1.03, -1.01])  # so that no face falls onto centres
    city = City.from_buildings([building], cell=cell, origin=shifted, size=(12.1, 12.1, 9), voxels="centres")
    surface = sum(ConvexHull(piece).area for piece in building.pieces)
    assert abs(city.occupied.sum() * cell**3 - volume) < 0.5 * cell * surface


@pytest.mark.parametrize("building", [*table1_buildings(), *(b for b, _ in VOLUMES.values())])
def test_surface_of_each_piece_is_closed_and_faces_outwards(building):
    for piece in building.pieces:
        triangles = Building((piece,)).triangles()
        a, b, c = triangles.transpose(1, 0, 2)
        assert np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6 == pytest.approx(ConvexHull(piece).volume, rel=1e-9)
        outward = np.einsum("ij,ij->i", np.cross(b - a, c - a), a - piece.mean(axis=0))
        assert (outward > 0).all()
        edges = Counter(
            (tuple(t[i]), tuple(t[(i + 1) % 3])) for t in triangles.tolist() for i in range(3)
        )  # each edge belongs to two triangles, that run along it in opposite directions
        assert set(edges.values()) == {1}
        assert all((end, start) in edges for start, end in edges)


def test_pieces_that_overlap_keep_all_their_triangles():
    building = Building((*Building.prism(SQUARE, 3).pieces, *Building.prism(SQUARE, 5, bottom=1).pieces))
    assert len(building.triangles()) == 24


@pytest.mark.parametrize(
    ("building", "edges"),
    [
        (Building.prism(SQUARE, 3), 12),
        (Building.roofed(SQUARE, 3, (2, 2, 6)), 16),
        (Building.hull([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]), 6),
    ],
    ids=["box", "pyramid on walls", "tetrahedron"],
)
def test_edges_are_the_solid_s_without_diagonals_of_faces(building, edges):
    ends = building.edges().reshape(-1, 2, 3)
    assert len(ends) == edges
    assert len({frozenset(map(tuple, pair)) for pair in ends.tolist()}) == edges


def test_bounds_are_the_lowest_and_highest_corner():
    assert np.array_equal(Building.roofed(SQUARE, 3, (2, 2, 6), bottom=1).bounds, [(0, 0, 1), (4, 4, 6)])


@pytest.mark.parametrize(
    "outline",
    [ELL, ELL[::-1], [*ELL, ELL[0]], [(x, y, 99.0) for x, y in ELL]],
    ids=["as is", "clockwise", "closed", "3D"],
)
def test_outlines_may_run_either_way_closed_or_not(outline):
    building = Building.prism(outline, 3)
    assert np.array_equal(building.contains(scattered(-1, 7)), Building.prism(ELL, 3).contains(scattered(-1, 7)))


@pytest.mark.parametrize("offset", [1e4, 447_000.0, 5e6])
def test_map_coordinates_far_from_zero_leave_no_gap_between_pieces(offset):
    outline = np.array(ELL) + offset
    building = Building.prism(outline, 3)
    city = City.from_buildings([building], cell=0.5, origin=(offset, offset, 0), size=(6, 6, 3))
    assert city.occupied.sum() == 20 * 3 * 8  # centres on the diagonals between triangles are inside


TETRAHEDRON = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
BOW_TIE = [(0, 0), (2, 2), (2, 0), (0, 2)]


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Building((), name="b"), "pieces of 'b' is empty"),
        (lambda: Building((np.zeros((4, 2)),)), r"pieces\[0\] of 'building' must have shape \(N, 3\), got \(4, 2\)"),
        (lambda: Building(3.0), "pieces must be a list of arrays of corners .* got float"),
        (lambda: Building((TETRAHEDRON,), name=3), "name must be text, got 3"),
        (lambda: Building((TETRAHEDRON,), color=(1, 0, 0)), r"color must be text, got \(1, 0, 0\)"),
        (lambda: Building.hull([]), r"corners must have shape \(N, 3\), got \(0,\)"),
        (lambda: Building.hull([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)]), "must each span a volume"),
        (lambda: Building.hull(TETRAHEDRON[:3]), "at least four corners, not all in one plane"),
        (lambda: Building.hull([*TETRAHEDRON, (np.nan, 0, 0)]), "corners must be finite, got nan"),
        (lambda: Building.hull([*TETRAHEDRON, (np.inf, 0, 0)]), "corners must be finite, got inf"),
        (lambda: Building.prism(BOW_TIE, 3, name="tie"), r"footprint of 'tie' is not a simple polygon: .*\[1 1\]"),
        (lambda: Building.prism([(0, 0), (1, 1), (2, 2)], 3), "is not a simple polygon"),
        (lambda: Building.prism([(0, 0), (1, 1), (0, 0)], 3), "needs at least three different corners"),
        (lambda: Building.prism([], 3), "needs at least three different corners"),
        (lambda: Building.prism([(0, 0), (1, 0), (np.nan, 1)], 3), "footprint of 'building' has a corner that is NaN"),
        (lambda: Building.prism(SQUARE, 3, bottom=5), r"top of 'building' must be above its bottom \(5 m\), got 3 m"),
        (lambda: Building.prism(SQUARE, 3, bottom=3), "must be above its bottom"),
        (lambda: Building.prism(SQUARE, np.nan), "must be above its bottom .*, got nan"),
        (lambda: Building.prism(SQUARE, np.inf), "top must be finite, got inf"),
        (lambda: Building.prism(SQUARE, "3"), "top must be a number .* got text"),
        (lambda: Building.prism(SQUARE, 3, holes=5), "holes must be a list of outlines .* got int"),
        (lambda: Building.roofed(SQUARE, 3, np.empty((0, 3))), "ridge .* must have shape"),
        (lambda: Building.roofed(SQUARE, 3, (2, 2, np.nan)), "ridge must be finite, got nan"),
        (lambda: Building.prism(SQUARE, 3).contains((1, 1)), r"points must have shape \(..., 3\), got \(2,\)"),
        (lambda: Building.prism(SQUARE, 3, holes=[[(5, 5), (6, 5), (6, 6)]]), "Hole lies outside shell"),
        (lambda: Building.prism(SQUARE, 3, holes=[[(1, 1), (2, 1)]]), "a hole in the footprint .* at least three"),
        (lambda: Building.prism(SQUARE, 3, holes=[[]]), "a hole in the footprint .* at least three"),
        (lambda: Building.prism(SQUARE, 3, holes=[[(1, 1), (2, 1), (2, np.nan)]]), "a hole in the footprint .* NaN"),
        (lambda: Building.roofed(SQUARE, 3, (2, 2, 6), bottom=4), r"eaves .* above its bottom \(4 m\), got 3 m"),
        (lambda: Building.roofed(SQUARE, np.nan, (2, 2, 6)), "eaves .* got nan"),
        (lambda: Building.roofed(SQUARE, 3, (2, 2)), r"ridge of 'building' must have shape \(R, 3\), got \(2,\)"),
        (lambda: Building.roofed(ELL, 3, (1, 1, 6)), "must be convex under a roof"),
        (lambda: Building.roofed(BOW_TIE, 3, (1, 1, 6)), "is not a simple polygon"),
    ],
)
def test_bad_buildings_are_refused_with_the_reason(make, message):
    with pytest.raises(ValueError, match=message):
        make()


def test_slender_parts_are_kept():
    notched = shapely.Polygon([(0, 0), (100, 0), (100, 100), (0, 100), (0, 50.01), (99.9, 50), (0, 49.99)])
    needle = shapely.Polygon([(0, 0), (1000, 0), (1000, 1000), (999.999, 1000), (999.999, 0.001), (0, 0.001)])
    for polygon in (notched, needle):
        parts = convex_parts(polygon)
        assert sum(shapely.Polygon(part).area for part in parts) == pytest.approx(polygon.area, rel=1e-9)
    assert len(convex_parts(shapely.Polygon([(0, 0), (1, 0), (0, 1)]))) == 1
