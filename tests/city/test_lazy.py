"""Lazy cities against plain ones of the same buildings: every voxel, every distance."""

import dataclasses

import numpy as np
import pytest

from uavlab.city import Building, City, LazyCity, NoFlyZone, Terrain, table1_buildings
from uavlab.city.lazy import WHOLE, distance_to_corner_box
from uavlab.planners import astar, potential_field, theta_star
from uavlab.risk import RiskMap
from uavlab.route import Route
from uavlab.storage import save


def bodies(rng, origin, size, cell):
    """Prisms and pyramids, on the ground and above it, some with corners on borders of voxels, some off the map."""
    made = []
    for _ in range(rng.integers(1, 16)):
        centre = origin[:2] + rng.uniform(-0.1, 1.1, 2) * size[:2]
        angle, extent = rng.uniform(0, 6), rng.uniform(0.3, 0.4 * max(size[0], 1.0), 2) * rng.choice([1, 0.3])
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) * extent @ turn.T + centre
        if rng.random() < 0.3:
            corners = origin[:2] + np.array([[0, 0], [1, 0], [1, 2], [0, 2]]) * cell * 3 + cell * rng.integers(0, 20)
        bottom = origin[2] + rng.choice([0.0, rng.uniform(0, 0.6) * size[2]])
        top = bottom + 0.1 + rng.uniform(0, 0.5) * size[2]
        if rng.random() < 0.6:
            made.append(Building.prism(corners, top, bottom=bottom))
        else:
            made.append(Building.hull([*((x, y, bottom) for x, y in corners), (*corners.mean(axis=0), top)]))
    return made


def both(seed, most=(70, 70, 70)):
    """A plain city and a lazy one: odd shapes and cells, far from x = y = 0, level ground, zones."""
    rng = np.random.default_rng(seed)
    cell = rng.choice([1.0, 0.5, 2.5, 1 / 3])
    origin = rng.choice([0, 1]) * np.array([455000.37, 5.7e6 + 0.11, 33.3]) + rng.random(3)
    size = cell * rng.integers(5, most, 3)
    zone = NoFlyZone(origin[:2] + rng.random((3, 2)) * size[:2], rng.uniform(0, 10), 10 + rng.uniform(0, size[2]))
    options = {
        "cell": cell, "origin": origin, "size": size - 1e-6, "no_fly": [zone] * int(rng.integers(2)),
        "terrain": rng.choice([None, origin[2] + rng.uniform(0, 0.2) * size[2]]),
    }  # fmt: skip
    buildings = bodies(rng, origin, size, cell)
    return City.from_buildings(buildings, **options), City.from_buildings(buildings, **options, lazy=True), rng


@pytest.mark.parametrize("seed", range(40))
def test_any_window_has_the_voxels_of_the_whole_map(seed):
    plain, lazy, rng = both(seed)
    assert isinstance(lazy, LazyCity)
    assert lazy.shape == plain.shape
    assert np.array_equal(lazy.bounds, plain.bounds)
    for _ in range(5):
        first = tuple(int(rng.integers(n)) for n in plain.shape[:2])
        count = tuple(int(rng.integers(1, n - i + 1)) for n, i in zip(plain.shape[:2], first, strict=True))
        window = tuple(slice(i, i + n) for i, n in zip(first, count, strict=True))
        assert np.array_equal(lazy.window(first, count), plain.occupied[window])
        clearance, least = rng.choice([0.0, rng.uniform(0, 6) * plain.cell]), rng.choice([0.0, 3.0])
        most = rng.choice([np.inf, least + 0.5 * plain.shape[2] * plain.cell])
        blocked = plain.blocked(clearance, min_height=least, max_height=most)[window]
        assert np.array_equal(lazy.blocked_window(first, count, clearance, least, most), blocked)


@pytest.mark.parametrize("seed", range(40, 60))
def test_points_and_lines_are_as_far_from_obstacles(seed):
    plain, lazy, rng = both(seed)
    low, high = plain.bounds
    start, end = rng.uniform(low - 5, high + 5, (2, 30, 3))
    assert np.allclose(lazy.segment_distance(start, end), plain.segment_distance(start, end), rtol=0, atol=1e-6)
    near = lazy.segment_distance(start, end, at_most=2.0)
    assert np.allclose(near, plain.segment_distance(start, end, at_most=2.0), rtol=0, atol=1e-6)
    assert np.allclose(lazy.distance(start), plain.distance(start, exact_within=1e9), rtol=0, atol=1e-6)
    assert np.array_equal(lazy.is_free(start), plain.is_free(start))
    assert np.array_equal(lazy.is_free_line(start, end, 1.0), plain.is_free_line(start, end, 1.0))
    assert np.allclose(lazy.height_above_ground(start), plain.height_above_ground(start), rtol=0, atol=1e-9)
    inside = Route(rng.uniform(low, high, (9, 3)))
    assert inside.clearance(lazy) == pytest.approx(inside.clearance(plain), abs=1e-6)


def test_far_from_everything_distances_are_found_in_windows_that_grow():
    tower = Building.prism([(400, 0), (410, 0), (410, 10), (400, 10)], 30)
    plain, lazy = (
        City.from_buildings([tower], origin=(0, 0, 0), size=(500, 200, 60), lazy=lazy) for lazy in (False, True)
    )
    points = np.array([(1.5, 5.5, 10.5), (300.5, 199.5, 59.5), (-50, 5, 10)])
    assert np.allclose(lazy.distance(points), plain.distance(points, exact_within=1e9), rtol=0, atol=1e-9)
    far = City.from_buildings(
        [tower, Building.prism([(0, 3900), (5, 3900), (5, 3990)], 9)],
        origin=(0, 0, 0),
        size=(5000, 5000, 60),
        lazy=True,
    )
    assert float(far.distance((4400.5, 5.5, 10.5))) == 3990.5
    assert float(far.distance((2.5, 2900.0, 3.5))) == 1000.0
    assert float(far.segment_distance((2.5, 2000, 9.5), (900, 3000, 9.5), at_most=300.0)) == 300.0
    nothing = City.from_buildings([], origin=(0, 0, 0), size=(500, 200, 60), lazy=True)
    assert np.isinf(nothing.distance(points)).all()
    assert nothing.is_free((1, 1, 1))


@pytest.mark.parametrize("terrain", [None, 2.5])
@pytest.mark.parametrize(
    "point", [(50, 50, 300), (50, 50, 5000), (1000, 50, 5), (-3000, -3000, -3000), (50, -90, 61.5), (50, 50, 1)]
)
def test_distances_off_the_map_are_finite_and_right(terrain, point):
    tower = Building.prism([(40, 40), (60, 40), (60, 60), (40, 60)], 30)
    options = {"origin": (0, 0, 0), "size": (100, 100, 60), "terrain": terrain}
    plain, lazy = (City.from_buildings([tower], **options, lazy=each) for each in (False, True))
    assert float(lazy.distance(point)) == pytest.approx(float(plain.distance(point, exact_within=1e9)), abs=1e-9)
    end = np.add(point, (37.0, -11.0, 5.0))
    assert float(lazy.segment_distance(point, end)) == pytest.approx(
        float(plain.segment_distance(point, end)), abs=1e-9
    )


def test_far_from_level_ground_its_plane_is_the_nearest():
    town = city_of_twelve_billion(terrain=2.5)
    assert float(town.distance((9000, 9000, 2000))) == 1997.0  # the voxel that the ground reaches into
    assert float(town.segment_distance((9000, 9000, 400), (9900, 5000, 300))) == 297.0
    assert float(town.segment_distance((9000, -2000, 1), (9900, -900, 1))) == 900.0


def test_a_long_line_takes_the_least_of_its_pieces():
    rng = np.random.default_rng(5)
    town = City.from_buildings(table1_buildings(), origin=(0, 0, 0), size=(2000, 2000, 120), lazy=True)
    plain = City.from_buildings(table1_buildings(), origin=(0, 0, 0), size=(130, 130, 120))
    start, end = rng.uniform(-3000, 3000, (2, 20, 3)) * (1, 1, 0.02) + (0, 0, 60)
    assert np.allclose(town.segment_distance(start, end), plain.segment_distance(start, end), rtol=0, atol=1e-8)


@pytest.mark.parametrize("seed", range(20))
def test_distance_to_a_box(seed):
    rng = np.random.default_rng(seed)
    high = rng.integers(1, 9, 3).astype(float)
    start, end = rng.uniform(-12, 20, (2, 3))
    if seed % 3 == 0:
        end[rng.integers(3)] = start[rng.integers(3)]
    if seed == 1:
        end = start
    points = start + np.linspace(0, 1, 200_001)[:, None] * (end - start)
    sampled = np.linalg.norm(points - np.clip(points, 0, high), axis=1).min()
    assert distance_to_corner_box(start, end, high) == pytest.approx(sampled, abs=1e-6)


def test_clearances_of_any_size_are_those_of_the_whole_map():
    tower = Building.prism([(140, 140), (160, 140), (160, 160), (140, 160)], 30)
    plain, lazy = (
        City.from_buildings([tower], origin=(0, 0, 0), size=(300, 300, 60), lazy=each) for each in (False, True)
    )
    for clearance in (39.5, 40.0, 40.5, 100.0):
        blocked = lazy.blocked_window((64, 64), (64, 64), clearance, 0.0, np.inf)
        assert np.array_equal(blocked, plain.blocked(clearance)[64:128, 64:128]), clearance


@pytest.mark.parametrize("min_clearance", [257.0, 3000.0, 1e9])
def test_more_clearance_than_windows_can_hold_is_refused(min_clearance):
    town = city_of_twelve_billion()
    for ask in (
        lambda: town.random_pairs(1, 1, min_clearance=min_clearance),
        lambda: astar(town, (1000.5, 1000.5, 50.5), (3000.5, 3000.5, 50.5), min_clearance=min_clearance),
    ):
        with pytest.raises(
            ValueError, match=r"min_clearance of .* m is more than 256 voxels, too much for a lazy city"
        ):
            ask()


def test_a_small_lazy_city_can_be_made_plain():
    small = City.from_buildings(table1_buildings(), lazy=True)
    with pytest.raises(ValueError, match="or make the city without lazy=True"):
        _ = small.occupied
    with pytest.raises(ValueError, match="or make the city with a larger cell"):
        _ = city_of_twelve_billion().occupied


def test_what_makes_lazy_cities_and_what_can_t_be_done_with_one_is_said(tmp_path):
    with pytest.raises(ValueError, match=r"extent is missing: make a lazy city by City\.from_buildings"):
        LazyCity(1.0)
    with pytest.raises(ValueError, match="thing must be a plain City: read or make a lazy one anew"):
        save(city_of_twelve_billion(), tmp_path / "town.npz")
    assert not list(tmp_path.iterdir())
    with pytest.raises(ValueError, match="a risk map needs all"):
        RiskMap(city_of_twelve_billion(), 1e-3, 0.5)


@pytest.mark.parametrize("seed", range(60, 70))
def test_a_part_is_a_plain_city_of_the_same_voxels(seed):
    plain, lazy, rng = both(seed)
    way = Route(rng.uniform(*plain.bounds, (3, 3)))
    part = lazy.part(way, margin=2.0)
    assert type(part) is City
    first = np.round((part.origin - plain.origin) / plain.cell).astype(int)
    window = tuple(slice(i, i + n) for i, n in zip(first, part.shape, strict=True))
    assert np.array_equal(part.occupied, plain.occupied[window])
    assert part.inside(way.points).all()
    middle = way.points.mean(axis=0)
    assert part.height_above_ground(middle) == pytest.approx(plain.height_above_ground(middle), abs=1e-9)
    at = plain.bounds[0] - (3.0, 0.0, 0.0)
    with pytest.raises(ValueError, match="around must have points near the map, within 1 m"):
        lazy.part(at, margin=1.0)


def city_of_twelve_billion(terrain=None):
    size = (10_000, 10_000, 120)
    return City.from_buildings(table1_buildings(), origin=(0, 0, 0), size=size, terrain=terrain, lazy=True)


@pytest.mark.parametrize("name", WHOLE)
def test_what_needs_every_voxel_says_so_and_what_to_do(name):
    with pytest.raises(ValueError, match=rf"{name} needs all 12,000,000,000 voxels of 'city'.*city\.part\(around="):
        getattr(city_of_twelve_billion(), name)


def test_planners_that_need_everything_say_so():
    city = city_of_twelve_billion()
    for planner in (theta_star, potential_field):
        with pytest.raises(ValueError, match="needs all 12,000,000,000 voxels"):
            planner(city, (5, 5, 30), (95, 95, 30))
    assert theta_star(city.part([(5, 5, 30), (95, 95, 30)]), (5, 5, 30), (95, 95, 30)).reached


def test_a_part_that_is_too_large_is_refused():
    with pytest.raises(ValueError, match=r"part of more than 500,000,000 voxels: take it around less of the way"):
        city_of_twelve_billion().part([(5, 5, 30), (9995, 9995, 30)])


def test_random_pairs_are_free_and_apart():
    city = city_of_twelve_billion()
    pairs = city.random_pairs(5, 3, apart=2000.0, min_clearance=2.0)
    assert pairs.shape == (5, 2, 3)
    assert (np.linalg.norm(pairs[:, 1] - pairs[:, 0], axis=1) >= 2000.0).all()
    assert (city.distance(pairs) >= 2.0).all()
    assert np.array_equal(pairs, city.random_pairs(5, 3, apart=2000.0, min_clearance=2.0))
    with pytest.raises(ValueError, match="no 1 pairs found"):
        City.from_buildings(table1_buildings(), lazy=True).random_pairs(1, 1, apart=1e6)


def test_attributes_can_be_replaced_and_are_checked():
    city = city_of_twelve_billion()
    zone = NoFlyZone([(0, 0), (20, 0), (20, 20)], name="school")
    closed = dataclasses.replace(city, no_fly=[zone])
    assert closed.shape == city.shape
    assert closed.zone_at((15, 2, 5)) == "school"
    for wrong, words in (
        ({"extent": (0, 5, 5)}, "extent must be three whole numbers of at least 1"),
        ({"extent": (10**6, 10**6, 10)}, "more than 100,000,000,000 voxels"),
        ({"level": np.nan}, "level"),
        ({"ground": np.zeros((3, 3))}, "ground can't be given to a lazy city"),
    ):
        with pytest.raises(ValueError, match=words):
            dataclasses.replace(city, **wrong)


def test_what_a_lazy_city_can_t_be_is_refused():
    hill = Terrain([(-50, -50, 0), (200, -50, 0), (200, 200, 9), (-50, 200, 0)], [(0, 1, 2), (0, 2, 3)])
    with pytest.raises(ValueError, match="lazy=True needs level ground"):
        City.from_buildings(table1_buildings(), terrain=hill, lazy=True)
    with pytest.raises(ValueError, match="lazy=True knows only voxels='touched'"):
        City.from_buildings(table1_buildings(), voxels="centres", lazy=True)
    with pytest.raises(ValueError, match="more than 100,000,000,000"):
        City.from_buildings(table1_buildings(), origin=(0, 0, 0), size=(1e6, 1e6, 100), lazy=True)
    with pytest.raises(ValueError, match="or lazy=True"):
        City.from_buildings(table1_buildings(), origin=(0, 0, 0), size=(1e4, 1e4, 100))


def test_files_can_be_read_lazily(tmp_path):
    import json

    from uavlab.city import read_city

    square = [[13.0, 52.0], [13.001, 52.0], [13.001, 52.001], [13.0, 52.001], [13.0, 52.0]]
    house = {"type": "Feature", "properties": {"height": 20}, "geometry": {"type": "Polygon", "coordinates": [square]}}
    path = tmp_path / "town.geojson"
    path.write_text(json.dumps(house))
    plain, lazy = read_city(path, cell=2.0), read_city(path, cell=2.0, lazy=True)
    assert isinstance(lazy, LazyCity)
    assert lazy.source is not None
    assert np.array_equal(lazy.window((0, 0), lazy.shape[:2]), plain.occupied)
    assert np.array_equal(lazy.to_geographic((5, 5, 5)), plain.to_geographic((5, 5, 5)))


@pytest.mark.parametrize("cell", [0.5, 1.0, 2.5])
def test_a_part_reaches_as_far_as_its_margin_and_less_than_a_cell_farther(cell):
    city = City.from_buildings(
        table1_buildings(), origin=(3.2, -7.1, 0), size=(300, 300, 60), cell=cell, lazy=True, terrain=2.5
    )
    points = np.array([(100.3, 120.9, 5.0), (140.7, 131.2, 9.0)])
    part = city.part(points, margin=20.0)
    before = points.min(axis=0) - part.bounds[0]
    after = part.bounds[1] - points.max(axis=0)
    for beyond in (before[:2], after[:2]):
        assert (beyond >= 20.0).all()
        assert (beyond <= 20.0 + cell).all()


def test_a_part_has_the_zones_and_the_ground_of_the_map():
    zone = NoFlyZone([(10, 10), (40, 10), (40, 40)], name="school")
    city = City.from_buildings(
        table1_buildings(), origin=(0, 0, 0), size=(200, 200, 60), lazy=True, terrain=2.5, no_fly=[zone]
    )
    part = city.part((30, 20, 30), margin=20.0)
    assert part.zone_at((35, 15, 5)) == "school"
    assert float(part.height_above_ground((30, 20, 30))) == 27.5


def test_random_pairs_keep_their_clearance_where_there_is_little_room():
    walls = [Building.prism([(x, 0), (x + 2, 0), (x + 2, 60), (x, 60)], 30.0) for x in range(0, 60, 12)]
    zone = NoFlyZone([(0, 0), (60, 0), (60, 30), (0, 30)])
    plain, lazy = (
        City.from_buildings(walls, origin=(0, 0, 0), size=(60, 60, 30), no_fly=[zone], lazy=lazy)
        for lazy in (False, True)
    )
    blocked = plain.blocked(3.0)
    pairs = lazy.random_pairs(40, 3, apart=20.0, min_clearance=3.0)
    assert 0.8 < blocked.mean() < 0.9
    assert not blocked[tuple(np.moveaxis(plain.cell_of(pairs), -1, 0))].any()


def test_from_afar_the_nearest_of_two_buildings_that_are_nearly_as_far():
    # in voxels the first begins at x = 2000, a cell before itself; so it is nearer, though its box isn't
    towers = [
        Building.prism([(2000.9, 0), (2010, 0), (2010, 10), (2000.9, 10)], 30),
        Building.prism([(0, 2000.5), (10, 2000.5), (10, 2010), (0, 2010)], 30),
    ]
    for order in (towers, towers[::-1]):
        city = City.from_buildings(order, origin=(0, 0, 0), size=(5000, 5000, 60), lazy=True)
        assert float(city.distance((5.0, 5.4, 5.0))) == 1994.6
        assert float(city.distance((5.6, 5.4, 5.0))) == pytest.approx(1994.4, abs=1e-9)
