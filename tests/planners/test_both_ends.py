"""A* on lazy cities against A* on plain ones of the same buildings: the same cost, and the same errors."""

import re
from itertools import pairwise

import numpy as np
import pytest

from uavlab.city import Building, City, NoFlyZone
from uavlab.city.near import bits_of
from uavlab.planners import astar, both_ends, shortcut
from uavlab.planners.lazy_search import around_in


def town(seed, lots=6, lot=27.0, height=50.0):
    """Blocks of houses, some of them floating, a zone, a map that is no multiple of a block."""
    rng = np.random.default_rng(seed)
    buildings = []
    for i, j in np.ndindex(lots, lots):
        low = lot * np.array([i, j]) + rng.uniform(0, 6, 2)
        high = low + rng.uniform(6, 18, 2)
        bottom = rng.choice([0.0, 0.0, 8.0])
        corners = [low, (high[0], low[1]), high, (low[0], high[1])]
        buildings.append(Building.prism(corners, bottom + rng.uniform(5, 45), bottom=bottom, name=f"{i}-{j}"))
    zone = NoFlyZone(rng.uniform(0, lots * lot, (3, 2)), 5.0, 30.0)
    options = {
        "origin": rng.choice([0.0, 5e6]) + np.zeros(3), "size": (lots * lot + 1, lots * lot - 4, height),
        "cell": rng.choice([1.0, 0.7]), "no_fly": [zone], "terrain": rng.choice([None, 2.5]),
    }  # fmt: skip
    moved = [Building(tuple(piece + options["origin"] for piece in one.pieces), one.name) for one in buildings]
    options["no_fly"] = [NoFlyZone(zone.outline + options["origin"][:2], zone.lower, zone.upper)]
    if options["terrain"] is not None:
        options["terrain"] = options["origin"][2] + 2.5
    return *(City.from_buildings(moved, **options, lazy=lazy) for lazy in (False, True)), rng


def asked(city, pair, **question):
    """A route, or the message of an error up to the advice at its end."""
    try:
        return astar(city, *pair, **question)
    except ValueError as error:
        return str(error).split(";")[0]


@pytest.mark.parametrize("turn", [1, 40, 20_000])
@pytest.mark.parametrize("seed", range(12))
def test_the_cost_is_that_of_the_whole_map(seed, turn, monkeypatch):
    monkeypatch.setattr(both_ends, "FIRST_TURN", turn)
    plain, lazy, rng = town(seed)
    low, high = plain.bounds
    for _ in range(6):
        question = {
            "min_clearance": rng.choice([0.0, rng.uniform(0, 4)]), "min_height": rng.choice([0.0, 6.0]),
            "max_height": rng.choice([np.inf, 30.0]), "heuristic": rng.choice(["octile", "euclidean", "zero"]),
        }  # fmt: skip
        pair = rng.uniform(low, high, (2, 3))
        whole, local = (asked(city, pair, **question) for city in (plain, lazy))
        if isinstance(whole, str):
            assert local == whole
            continue
        assert local.reached == whole.reached
        if not whole.reached:
            assert "no free way" in local.reason
            continue
        assert local.cost == pytest.approx(whole.cost, rel=3e-9)
        assert local.length == pytest.approx(local.cost, rel=1e-9)
        index = plain.cell_of(local.points)
        assert (np.abs(np.diff(index, axis=0)).max(axis=1) == 1).all()
        assert np.array_equal(local.points[[0, -1]], whole.points[[0, -1]])
        open_to = plain.blocked(question["min_clearance"], max_height=question["max_height"])
        way = plain.cell_of(local.en_route.points)
        assert not open_to[tuple(way.T)].any()
        for one, other in pairwise(way):  # nothing is cut
            box = tuple(slice(min(a, b), max(a, b) + 1) for a, b in zip(one, other, strict=True))
            assert not open_to[box].any()


def courtyards():
    """Two, with doors above their roofs, and a wall between them, as a plain and as a lazy city; a place in each."""

    def ring(x, y, door):
        court = [(x + 2, y + 2), (x + 18, y + 2), (x + 18, y + 18), (x + 2, y + 18)]
        return Building.prism([(x, y), (x + 20, y), (x + 20, y + 20), (x, y + 20)], door, holes=[court])

    wall = Building.prism([(100, 0), (103, 0), (103, 130), (100, 130)], 38.0)
    buildings = [ring(10, 70, 33.0), ring(165, 60, 36.0), wall]
    plain, lazy = (City.from_buildings(buildings, origin=(0, 0, 0), size=(195, 150, 40), lazy=a) for a in (False, True))
    pair = (20.5, 80.5, 3.5), (175.5, 70.5, 4.5)
    return plain, lazy, pair


@pytest.mark.parametrize("turn", [1, 300, 20_000])
def test_courtyards_at_both_ends_and_a_wall_between(turn, monkeypatch):
    monkeypatch.setattr(both_ends, "FIRST_TURN", turn)

    plain, lazy, pair = courtyards()
    whole, local = (astar(city, *pair, min_clearance=1.0) for city in (plain, lazy))
    assert local.cost == pytest.approx(whole.cost, rel=3e-9)
    assert local.info["blocks"] <= 12


@pytest.mark.parametrize("turn", [1, 20_000])
def test_no_way_out_is_an_answer(turn, monkeypatch):
    monkeypatch.setattr(both_ends, "FIRST_TURN", turn)
    court = [(42, 42), (58, 42), (58, 58), (42, 58)]
    ring = Building.prism([(40, 40), (60, 40), (60, 60), (40, 60)], 40.0, holes=[court])
    city = City.from_buildings([ring], origin=(0, 0, 0), size=(150, 100, 40), lazy=True)
    for pair in (((50, 50, 5), (140, 50, 5)), ((140, 50, 5), (50, 50, 5))):
        route = astar(city, *pair)
        assert not route.reached
        assert "no free way" in route.reason


def test_a_route_that_can_t_be_proven_for_lack_of_memory_is_none(monkeypatch):
    monkeypatch.setattr(both_ends, "MOST_NODES", 40 * 512)
    monkeypatch.setattr(both_ends, "FIRST_TURN", 100)
    wall = Building.prism([(60, 0), (63, 0), (63, 148), (60, 148)], 40.0)
    city = City.from_buildings([wall], origin=(0, 0, 0), size=(150, 150, 40), lazy=True)
    route = astar(city, (5, 5, 20), (140, 20, 20))
    assert not route.reached
    assert re.match(
        r"(no route|a route of \d+\.\d m) is known.* for which there is memory; the cheapest has at least", route.reason
    )
    monkeypatch.setattr(both_ends, "MOST_NODES", 1 << 20)
    monkeypatch.setattr(both_ends, "MOST_BLOCKS", 1)
    assert "for which there is memory" in astar(city, (5, 5, 20), (140, 20, 20)).reason


def test_a_price_and_a_record_are_refused():
    city = City.from_buildings([], origin=(0, 0, 0), size=(30, 30, 30), lazy=True)
    for question, words in (({"price": np.ones((30, 30, 30))}, "a price"), ({"record": True}, "record")):
        with pytest.raises(ValueError, match=f"{words} needs all 27,000 voxels"):
            astar(city, (5, 5, 5), (20, 20, 20), **question)
    with pytest.raises(ValueError, match="a price needs all 27,000 voxels"):
        shortcut(astar(city, (5, 5, 5), (20, 20, 20)), city, price=np.ones((30, 30, 30)))


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("piece", [30.0, 300.0])
def test_a_shortcut_in_parts_keeps_the_clearance_and_is_nearly_as_short(seed, piece, monkeypatch):
    from uavlab.planners.shortcut import straightened_in_parts

    monkeypatch.setitem(straightened_in_parts.__globals__, "PIECE", piece)
    plain, lazy, _ = town(seed)
    low = plain.bounds[0]
    points = [plain.center_of(plain.cell_of(low + np.array(p))) for p in ((2, 2, 48.0), (150, 140, 48.5))]
    route = astar(lazy, *points, min_clearance=2.0)
    short, whole = shortcut(route, lazy), shortcut(route, plain)
    assert short.clearance(plain) >= 2.0 - 1e-6
    assert short.cost == pytest.approx(short.length)
    assert whole.length - 1e-6 <= short.length <= min(route.length, 1.02 * whole.length)
    assert len(short.points) < len(route.points)


@pytest.mark.parametrize("height", [61, 62, 63, 64, 65, 126, 127, 128])
def test_columns_of_any_number_of_words(height):
    wall = Building.prism([(20, 0), (22, 0), (22, 30), (20, 30)], height - 1.0)  # one voxel is free above it
    plain, lazy = (
        City.from_buildings([wall], origin=(0, 0, 0), size=(40, 30, height), lazy=lazy) for lazy in (False, True)
    )
    pair = (10.5, 15.5, 0.5), (30.5, 12.5, 3.5)
    for clearance in (0.0, 0.5):
        whole, local = (astar(city, *pair, min_clearance=clearance) for city in (plain, lazy))
        assert local.reached == whole.reached
        assert local.cost == pytest.approx(whole.cost, rel=3e-9)
        assert local.points[:, 2].max() == height - 0.5


def test_a_way_of_many_voxels_is_whole_where_codes_are_beyond_32_bits():
    city = City.from_buildings([], origin=(0, 0, 0), size=(10_000, 10_000, 30), lazy=True)
    start, goal = np.array((9900.5, 9900.5, 9.5)), np.array((4110.5, 6700.5, 9.5))
    route = astar(city, start, goal)
    assert np.array_equal(route.points[[0, -1]], [start, goal])
    assert len(route.points) == 5791
    assert (np.abs(np.diff(route.points, axis=0)).max(axis=1) == 1).all()
    assert route.length == pytest.approx(2590 + 3200 * np.sqrt(2.0))


@pytest.mark.parametrize("cell", [0.5, 2.5])
def test_what_is_proven_without_memory_is_in_metres_and_not_too_much(cell, monkeypatch):
    monkeypatch.setattr(both_ends, "MOST_NODES", 40 * 512)
    monkeypatch.setattr(both_ends, "FIRST_TURN", 100)
    wall = Building.prism(cell * np.array([(60, 0), (63, 0), (63, 148), (60, 148)]), 40.0 * cell)
    plain, lazy = (
        City.from_buildings([wall], origin=(0, 0, 0), size=cell * np.array([150, 150, 40]), cell=cell, lazy=lazy)
        for lazy in (False, True)
    )
    pair = cell * np.array([(5.5, 5.5, 20.5), (140.5, 20.5, 20.5)])
    reason = astar(lazy, *pair).reason
    proven = float(reason.split("at least ")[1].split(" m")[0])
    assert np.linalg.norm(pair[1] - pair[0]) - 0.1 <= proven <= astar(plain, *pair).cost + 0.1


@pytest.mark.parametrize("turn", [300, 3000, 20_000])
def test_what_one_search_knows_spares_the_other_most_of_the_map(turn, monkeypatch):
    monkeypatch.setattr(both_ends, "FIRST_TURN", turn)

    plain, lazy, pair = courtyards()
    whole, local = (astar(city, *pair, min_clearance=1.0) for city in (plain, lazy))
    assert local.info["expanded"] < 0.3 * whole.info["expanded"]


@pytest.mark.parametrize("height", [1, 61, 62, 63, 64, 65, 126, 127, 130])
def test_bits_around_a_voxel_are_those_of_its_box(height):
    blocked = np.random.default_rng(height).random((5, 6, height + 2)) < 0.5
    bits = bits_of(blocked)
    for k in range(height):
        box = blocked[1:4, 2:5, k : k + 3].ravel()
        assert around_in(bits, 1, 2, k) == sum(1 << n for n in np.flatnonzero(box).tolist()), k


@pytest.mark.parametrize(
    ("start", "min_clearance"),
    [((250, 250, 5), 0.0), ((110, 250, 5), 60.0), ((136, 136, 5), 5.0), ((399.5, 250.5, 59.5), 0.0)],
)
def test_the_nearest_free_point_is_found_however_large_the_building(start, min_clearance):
    hall = Building.prism([(100, 100), (400, 100), (400, 400), (100, 400)], 60, name="hall")
    messages = []
    for lazy in (False, True):
        city = City.from_buildings([hall], origin=(0, 0, 0), size=(500, 500, 60), lazy=lazy)
        with pytest.raises(ValueError, match=r"start .* lies in building 'hall'; the nearest free point is") as error:
            astar(city, start, (10, 10, 5), min_clearance=min_clearance)
        messages.append(str(error.value))
    assert messages[0] == messages[1]


def test_a_start_in_a_zone_without_end_is_told_how_far_it_was_looked():
    zone = NoFlyZone([(1000, 1000), (9000, 1000), (9000, 9000), (1000, 9000)], name="centre")
    house = Building.prism([(40, 40), (60, 40), (60, 60), (40, 60)], 30)
    city = City.from_buildings([house], origin=(0, 0, 0), size=(10_000, 10_000, 120), lazy=True, no_fly=[zone])
    with pytest.raises(ValueError, match="lies in no-fly zone 'centre'; no voxel within 256 m of it is free"):
        astar(city, (5000, 5000, 50), (10, 10, 50))
    full = City.from_buildings(
        [Building.prism([(-9, -9), (200, -9), (200, 200), (-9, 200)], 90)],
        origin=(0, 0, 0), size=(100, 100, 60), lazy=True,
    )  # fmt: skip
    with pytest.raises(ValueError, match="no voxel of the map is free"):
        astar(full, (50, 50, 50), (10, 10, 50))
