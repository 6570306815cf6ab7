"""Surfaces of buildings as they are drawn: closed forms, no walls inside, and nothing lost that can be seen."""

from itertools import pairwise

import numpy as np
import pytest
import shapely

from uavlab.city import Building, table1_buildings

L_SHAPE = [(0, 0), (30, 0), (30, 10), (10, 10), (10, 40), (0, 40)]
BOX = [(0, 0), (10, 0), (10, 10), (0, 10)]


def volume_of(triangles):
    """By the divergence theorem: a sixth of the sum of a · (b × c)."""
    return np.einsum("ij,ij->i", triangles[:, 0], np.cross(triangles[:, 1], triangles[:, 2])).sum() / 6


def area_of(triangles):
    across = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    return np.linalg.norm(across, axis=1).sum() / 2


def lines_of(building):
    """Edges as sorted pairs of corners."""
    return sorted(tuple(sorted(map(tuple, pair))) for pair in building.edges().reshape(-1, 2, 3).round(6).tolist())


def hits(triangles, eyes, rays):
    """How far along each ray (N, 3) the first triangle is, by Möller and Trumbore; infinite where there is none."""
    a, ab, ac = triangles[:, 0], triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    nearest = np.full(len(eyes), np.inf)
    for number, (eye, ray) in enumerate(zip(eyes, rays, strict=True)):
        p = np.cross(ray, ac)
        across = np.einsum("ij,ij->i", ab, p)
        with np.errstate(divide="ignore", invalid="ignore"):
            u = np.einsum("ij,ij->i", eye - a, p) / across
            q = np.cross(eye - a, ab)
            v, distance = q @ ray / across, np.einsum("ij,ij->i", ac, q) / across
            met = (across != 0) & (u >= -1e-9) & (v >= -1e-9) & (u + v <= 1 + 1e-9) & (distance > 0)
        nearest[number] = distance[met].min(initial=np.inf)
    return nearest


def test_l_shape_has_no_walls_inside():
    building = Building.prism(L_SHAPE, 12, bottom=2)
    assert len(building.pieces) > 1
    triangles, polygon = building.triangles(), shapely.Polygon(L_SHAPE)
    assert volume_of(triangles) == pytest.approx(polygon.area * 10)  # outside is outside: each counter-clockwise
    assert area_of(triangles) == pytest.approx(2 * polygon.area + 10 * polygon.length)
    walls = triangles[np.ptp(triangles[..., 2], axis=1) > 0]
    for x, y, _ in walls.mean(axis=1):
        assert polygon.boundary.distance(shapely.Point(x, y)) < 1e-9


def test_edges_are_where_it_bends():
    """18 of an L; none between the triangles of its roof, nor on a wall."""
    corners = [(x, y, z) for x, y in L_SHAPE for z in (0.0, 12.0)]
    rings = [[(*L_SHAPE[n], z) for n in (k, (k + 1) % 6)] for k in range(6) for z in (0.0, 12.0)]
    uprights = [corners[2 * k : 2 * k + 2] for k in range(6)]
    expected = sorted(tuple(sorted(tuple(map(float, end)) for end in pair)) for pair in rings + uprights)
    assert lines_of(Building.prism(L_SHAPE, 12)) == expected


def test_bends_flatter_than_ten_degrees_have_no_edge():
    def arched(degrees):
        rise = 5 * np.tan(np.radians(degrees / 2))  # both slopes are half as steep as the bend between them
        return Building.roofed(BOX, 5, [(5, 0, 5 + rise), (5, 10, 5 + rise)])

    ridge = lambda building: [pair for pair in lines_of(building) if pair[0][0] == pair[1][0] == 5.0]  # noqa: E731
    assert ridge(arched(9.5)) == []
    assert len(ridge(arched(10.5))) == 1


def test_courtyard_is_a_tube():
    hole = [(3, 3), (7, 3), (7, 7), (3, 7)]
    triangles = Building.prism(BOX, 5, holes=[hole]).triangles()
    assert volume_of(triangles) == pytest.approx((100 - 16) * 5)
    assert area_of(triangles) == pytest.approx(2 * (100 - 16) + 5 * (40 + 16))


def test_sheets_that_make_a_surface_have_no_walls_between_them():
    """A sloped plane cut into strips, each a thin slab."""
    across = np.linspace(0, 12, 5)
    strips = [[(x, y, z + 0.5 * x) for x in pair for y in (0.0, 6.0) for z in (4.9, 5.0)] for pair in pairwise(across)]
    slab = Building.hull([(x, y, z + 0.5 * x) for x in (0, 12) for y in (0, 6) for z in (4.9, 5.0)])
    sheet = Building(tuple(np.array(strip) for strip in strips))
    assert volume_of(sheet.triangles()) == pytest.approx(12 * 6 * 0.1)
    assert area_of(sheet.triangles()) == pytest.approx(area_of(slab.triangles()))
    assert not any(0 < end[0] < 12 and pair[0][0] == pair[1][0] for pair in lines_of(sheet) for end in pair)


def test_pieces_that_are_the_same_are_there():
    box = Building.prism(BOX, 5)
    twice = Building(box.pieces + box.pieces)
    assert area_of(twice.triangles()) == pytest.approx(2 * area_of(box.triangles()))
    assert set(lines_of(twice)) == set(lines_of(box))


def test_floors_that_two_pieces_share_from_above_can_be_seen_from_below():
    """A low and a high block over one footprint, both above the ground."""
    blocks = [Building.prism(BOX, top, bottom=2.0).pieces[0] for top in (5.0, 9.0)]
    triangles = Building(tuple(blocks)).triangles()
    assert hits(triangles, np.array([[4.0, 3.0, 0.0]]), np.array([[0.0, 0, 1]]))[0] == pytest.approx(2.0)


def random_buildings():
    """Towns' worst: table 1, prisms of stars with holes, roofed ones, unions that overlap, share walls, or float."""
    rng = np.random.default_rng(7)
    yield from table1_buildings()
    for _ in range(12):
        angle = np.sort(rng.uniform(0, 2 * np.pi, rng.integers(6, 14)))
        star = rng.uniform(9, 20, len(angle))[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
        ring = np.column_stack([np.cos(angle), np.sin(angle)])
        holes = [2.0 * ring] if shapely.Polygon(star).contains(shapely.Polygon(2.0 * ring)) else []
        prism = Building.prism(star, rng.uniform(5, 30), holes=holes, bottom=rng.choice([0.0, 4.0]))
        roof = Building.roofed(np.array(BOX) + rng.uniform(-9, 9, 2), 8, [(0, 0, rng.uniform(9, 15))])
        yield prism
        yield Building(prism.pieces + roof.pieces)
    left, right = (Building.prism(np.add(np.array(BOX), (shift, 0)), 7.0) for shift in (0, 10))
    yield Building(left.pieces + right.pieces + left.pieces)


@pytest.mark.parametrize("number", range(30))
def test_nothing_that_is_seen_is_lost(number):
    building = list(random_buildings())[number]
    every = np.concatenate([hull.triangles for hull in building.hulls])
    rng = np.random.default_rng(number)
    low, high = building.bounds
    middle, reach = (low + high) / 2, np.linalg.norm(high - low)
    away = rng.normal(size=(150, 3))
    eyes = middle + reach * away / np.linalg.norm(away, axis=1, keepdims=True)
    rays = rng.uniform(low, high, (150, 3)) - eyes
    expected, seen = hits(every, eyes, rays), hits(building.triangles(), eyes, rays)
    assert np.isfinite(expected).sum() > 40
    assert np.array_equal(np.isfinite(expected), np.isfinite(seen))
    assert np.allclose(expected[np.isfinite(expected)], seen[np.isfinite(seen)], atol=1e-6)


def test_surfaces_do_not_depend_on_where_the_map_begins():
    near = Building.prism(L_SHAPE, 12)
    far = Building.prism(np.add(np.array(L_SHAPE), (500_000.25, 5_700_000.5)), 12)
    assert len(near.triangles()) == len(far.triangles())
    assert len(near.edges()) == len(far.edges())
    assert np.allclose(far.triangles() - (500_000.25, 5_700_000.5, 0), near.triangles(), atol=1e-6)


def test_surfaces_can_not_be_written_to():
    building = Building.prism(BOX, 5)
    for values in (building.triangles(), building.edges()):
        with pytest.raises(ValueError, match="read-only"):
            values[0] = 0.0
