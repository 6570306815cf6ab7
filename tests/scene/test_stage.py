"""What is shown of a city: ground, grid, buildings, voxels, zones, risk, wind."""

import time
import tracemalloc

import numpy as np
import pytest
from decoding import content_of
from matplotlib.colors import to_rgb

from uavlab import scene
from uavlab.city import Building, City, NoFlyZone
from uavlab.plot.ground import MOST_QUADS, ZONE_COLOR
from uavlab.risk import RiskMap, reference_campus
from uavlab.scene.content import drawing_of
from uavlab.scene.stage import layer_triangles, not_twice, voxel_edges, voxel_surface
from uavlab.weather import Wind

SQUARE = np.array([(0, 0), (8, 0), (8, 8), (0, 8)])


def drawn(city, **more):
    return drawing_of(city, (), **more)


def test_buildings_are_one_mesh_with_the_colour_of_each():
    houses = [
        Building.prism(np.add(SQUARE, (20 * n, 0)), 5 + n, color=color)
        for n, color in enumerate(("C0", "tab:red", "0.5"))
    ]
    drawing = drawn(City.from_buildings(houses))
    part = drawing.parts["buildings"]
    assert np.array_equal(part.triangles, np.concatenate([house.triangles() for house in houses]))
    for number, color in enumerate(("C0", "tab:red", "0.5")):
        assert np.allclose(part.colors[12 * number : 12 * number + 12], to_rgb(color))
    assert np.array_equal(drawing.parts["edges"].ends, np.concatenate([house.edges() for house in houses]))
    assert "voxels" not in drawing.parts


@pytest.mark.parametrize("draw", [scene.page, scene.still])
def test_a_colour_that_is_none_is_named_with_its_building(draw):
    house = Building.prism(SQUARE, 5, name="mill", color="nonsense")
    with pytest.raises(ValueError, match=r"color of 'mill' must be a colour of matplotlib, .* got 'nonsense'"):
        draw(City.from_buildings([house]))


def test_voxel_surface_encloses_the_occupied_volume():
    occupied = np.random.default_rng(1).random((6, 7, 5)) < 0.4
    origin = np.array([3.0, -2.0, 1.0])
    triangles = voxel_surface(City(occupied, cell=2.0, origin=origin)) - origin
    volume = np.einsum("ij,ij->i", triangles[:, 0], np.cross(triangles[:, 1], triangles[:, 2])).sum() / 6
    assert volume == pytest.approx(8 * occupied.sum())
    across = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    padded = np.pad(occupied, 1).astype(int)
    faces = sum(np.abs(np.diff(padded, axis=axis)).sum() for axis in range(3))
    assert np.linalg.norm(across, axis=1).sum() / 2 == pytest.approx(4 * faces)


def test_voxels_that_the_ground_reaches_into_are_left_out():
    """The ground has a mesh of its own."""
    occupied = np.zeros((6, 6, 5), dtype=bool)
    occupied[:, :, 0] = True
    occupied[2:4, 2:4, :3] = True
    surface = voxel_surface(City(occupied, 4.0, ground=np.full((6, 6), 3.0)))
    assert np.array_equal(surface.min(axis=(0, 1)), (8, 8, 4))
    assert np.array_equal(surface.max(axis=(0, 1)), (16, 16, 12))
    assert len(drawn(City(occupied[..., :1], 4.0, ground=np.full((6, 6), 3.0))).parts) == 2


def test_voxel_edges_are_those_of_every_face():
    """By hand: an edge is drawn where the four voxels around it aren't all the same."""
    occupied = np.random.default_rng(2).random((4, 5, 3)) < 0.4
    origin = np.array([1.0, 2, 3])
    ends = (voxel_edges(City(occupied, 2.0, origin)) - origin) / 2.0
    found = set()
    for begin, end in ends.reshape(-1, 2, 3):
        steps = int(np.abs(end - begin).max())
        for step in range(steps):
            found.add((*(begin + step * (end - begin) / steps), *((end - begin) != 0)))
    padded, expected = np.pad(occupied, 1), set()
    for along in range(3):
        first, second = np.eye(3, dtype=int)[[axis for axis in range(3) if axis != along]]
        for corner in np.argwhere(np.ones(np.array(occupied.shape) + (np.arange(3) != along))):
            around = [padded[tuple(corner + 1 - i * first - j * second)] for i in (0, 1) for j in (0, 1)]
            if any(around) and not all(around):
                expected.add((*corner.astype(float), *(np.arange(3) == along)))
    assert found == expected


def test_voxels_have_edges_while_there_are_not_too_many():
    blocks = np.zeros((12, 12, 4), dtype=bool)
    blocks[3:6, 3:6, :2] = True
    drawing = drawn(City(blocks, 2.0))
    assert set(drawing.parts) == {"voxels", "edges", "ground", "grid"}
    assert "voxels of 2 m" in drawing.notes
    drawing = drawn(City(np.random.default_rng(0).random((90, 90, 20)) < 0.3, 2.0))
    assert "edges" not in drawing.parts
    assert not any("voxels" in note for note in drawing.notes)


def test_large_voxel_cities_take_little_time_and_memory():
    """As large as a city of 3.5 km: a second, and 40 bytes a voxel."""
    heights = np.random.default_rng(0).integers(0, 30, (59, 43)).repeat(8, axis=0).repeat(8, axis=1)
    city = City(np.arange(40) < heights[..., None], 8.0)
    tracemalloc.start()
    began = time.process_time()
    voxel_edges(city)
    spent = time.process_time() - began
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 40 * city.occupied.size
    assert spent < 10


def test_ground_is_one_mesh_at_its_heights_with_a_grid_on_it(hill):
    drawing = drawn(hill)
    ground = drawing.parts["ground"]
    assert len(ground.triangles) == 2 * 30 * 20
    assert np.abs(hill.height_above_ground(ground.triangles)).max() < 1e-9
    assert ground.lit
    lines = drawing.parts["grid"].ends
    above = hill.height_above_ground(lines)
    assert above.min() > 0
    assert above == pytest.approx(np.full(len(lines), above[0]))
    assert above[0] < 0.5
    straight = np.diff(lines.reshape(-1, 2, 3)[..., :2], axis=1)[:, 0]
    assert (np.count_nonzero(straight, axis=1) == 1).all()
    assert "ground at z = 0 to 20 m" in drawing.notes
    assert "squares of 10 m" in drawing.notes


@pytest.mark.parametrize(("size", "spacing"), [(2, 0.2), (10, 1), (30, 5), (55, 5), (100, 10), (800, 100), (5e5, 5e4)])
def test_the_grid_has_round_lengths_and_about_ten_squares(size, spacing):
    city = City(np.zeros((4, 4, 1), dtype=bool), size / 4)
    drawing = drawn(city)
    assert f"squares of {spacing:g} m" in drawing.notes
    lines = drawing.parts["grid"].ends.reshape(-1, 2, 3)
    x = np.unique(lines[lines[:, 0, 0] == lines[:, 1, 0]][:, 0, 0])
    assert np.allclose(np.diff(x), spacing)
    assert x[0] == pytest.approx(0)
    assert x[-1] <= size * (1 + 1e-12)
    assert (lines[..., 2] == 0).all()
    assert (drawing.parts["ground"].triangles[..., 2] < 0).all()  # so that the lines are on it


def test_fine_terrain_is_thinned():
    city = City(np.zeros((300, 200, 2), dtype=bool), 1.0, ground=np.random.default_rng(0).random((300, 200)))
    assert len(drawn(city).parts["ground"].triangles) == 2 * MOST_QUADS**2


def test_layers_lie_on_the_ground_when_they_get_its_heights(hill):
    heights = np.random.default_rng(1).random((31, 21))
    layer = layer_triangles(hill, heights)
    assert layer.shape == (30 * 20, 2, 3, 3)
    for point in layer[7 * 20 + 3].reshape(-1, 3):
        i, j = (point[:2] / 4).round().astype(int)
        assert (i, j) in [(7, 3), (8, 3), (7, 4), (8, 4)]
        assert point[2] == heights[i, j]
    normals = np.cross(layer[..., 1, :] - layer[..., 0, :], layer[..., 2, :] - layer[..., 0, :])
    assert (normals[..., 2] > 0).all()


def test_what_is_thin_or_twice_in_large_cities_is_drawn_once():
    base = np.array([[(0.0, 0, 0), (5, 0, 0), (0, 5, 0)]])
    thin = np.array([[(0.0, 0, 0), (5, 0, 0), (5, 0.05, 0)]])
    shapes = np.concatenate([base, np.add(base, (0, 0, 9)), np.add(base, (0, 0, 0.05)), thin, base[:, ::-1]])
    assert not_twice(shapes).tolist() == [0, 1]
    spots = np.stack(np.meshgrid(np.arange(0, 500, 10.1), np.arange(0, 500, 10.3)), axis=-1).reshape(-1, 2)[:2400]
    houses = [Building.prism(SQUARE + spot, 7) for spot in spots]
    drawing = drawn(City.from_buildings(houses, cell=10.0))
    assert len(drawing.parts["buildings"].triangles) == 12 * 2400  # of a box nothing is thin
    assert len(drawing.parts["edges"].ends) == 24 * 2400


def test_five_thousand_houses_of_less_than_a_metre():
    spots = np.stack(np.meshgrid(np.arange(0, 140, 2.0), np.arange(0, 140, 2.0)), axis=-1).reshape(-1, 2)
    drawing = drawn(City.from_buildings([Building.prism(0.1 * SQUARE + spot, 0.9) for spot in spots]))
    assert len(drawing.parts["buildings"].triangles) == 12 * 4900
    assert "edges" not in drawing.parts


def test_zones_can_be_looked_through_and_end_at_the_map(hill):
    drawing = drawn(hill)
    walls = drawing.parts["no-fly zones"]
    assert walls.opacity < 0.5
    assert walls.color == ZONE_COLOR
    low, high = walls.triangles.min(axis=(0, 1)), walls.triangles.max(axis=(0, 1))
    assert low[:2] == pytest.approx([20, 20])
    assert high == pytest.approx([90, 60, 60])  # the church's zone has no upper limit
    assert [entry.text for entry in drawing.legend if entry.kind == "patch"] == ["no-fly zones: <school>, church"]
    bare = drawn(City(hill.occupied, 4.0))
    assert not {"no-fly zones", "their edges"} & set(bare.parts)
    assert not bare.legend
    away = NoFlyZone([(500, 500), (600, 500), (600, 600)], name="away")
    assert not drawn(City(np.zeros((9, 9, 9), dtype=bool), 2.0, no_fly=(away,))).legend


def test_risk_paints_the_ground_and_a_slice_on_one_scale():
    campus = reference_campus()
    drawing = drawn(campus.city, risk=campus, slice_height=27.5)
    ground, cut = drawing.parts["risk on the ground"], drawing.parts["risk at a height"]
    assert len(ground.triangles) == 2 * 30 * 30
    assert len(cut.triangles) == 2 * np.count_nonzero(campus.flyable[:, :, 5])  # buildings are left out
    assert (cut.triangles[..., 2] == 27.5).all()
    assert (cut.opacity < 1, ground.opacity, cut.lit, ground.lit) == (True, 1, False, False)
    lightness = ground.colors.sum(axis=1)[::2].reshape(30, 30)
    assert lightness[28, 28] > lightness[2, 2] + 0.5  # the crowded square against the park
    assert (drawing.risk.vmin, drawing.risk.vmax) == (
        campus.rate[campus.flyable].min(), campus.rate[campus.flyable].max()
    )  # fmt: skip
    middle = cut.triangles.mean(axis=1)[::2]
    columns = campus.city.cell_of(middle)
    rates = campus.rate[columns[:, 0], columns[:, 1], 5]
    order = np.argsort(rates, kind="stable")
    assert (np.diff(cut.colors[::2].sum(axis=1)[order]) >= -0.02).all()  # brighter is riskier
    assert "the plane shows the risk at z = 27.5 m" in drawing.notes


@pytest.mark.parametrize("ground", [None, np.linspace(0, 9, 100).reshape(10, 10)])
def test_risk_lies_on_the_ground_and_may_be_of_nobody(ground):
    city = City(np.zeros((10, 10, 6), dtype=bool), 4.0, ground=ground)
    drawing = drawn(city, risk=RiskMap(city, 0.0, 0.0))
    part = drawing.parts["risk on the ground"]
    assert ("ground" in drawing.parts) == (ground is None)  # a level one lies below, for its border
    above = city.height_above_ground(part.triangles)
    assert above == pytest.approx(np.full(above.shape, 0.04))
    assert len(np.unique(part.colors, axis=0)) == 1
    assert "deaths per hour" in scene.page(city, risk=RiskMap(city, 0.0, 0.0))


def test_a_slice_needs_a_risk_map_and_a_height_on_it(table1):
    campus = reference_campus()
    for draw in (scene.page, scene.still):
        with pytest.raises(ValueError, match="slice_height needs risk"):
            draw(table1, slice_height=30.0)
        with pytest.raises(ValueError, match="slice_height must lie on the map, 0 to 80 m, got 90"):
            draw(campus.city, risk=campus, slice_height=90.0)
        with pytest.raises(ValueError, match="risk must be a map of the same city"):
            draw(table1, risk=campus)


def parts_of_wind(city, wind):
    drawing = drawn(city, wind=wind)
    sock = drawing.parts["wind sock"].triangles
    foot = sock[sock[..., 2] <= sock[..., 2].min() + 1e-9].mean(axis=0)
    return drawing, foot


@pytest.mark.parametrize("corner", range(4))
def test_the_wind_sock_stands_on_a_corner_that_is_not_built_on(corner):
    places = [(0, 0), (80, 0), (0, 80), (80, 80)]
    houses = [Building.prism(2.5 * SQUARE + place, 30) for n, place in enumerate(places) if n != corner]
    city = City.from_buildings(houses, cell=2.0, origin=(0, 0, 0), size=(100, 100, 40))
    _, foot = parts_of_wind(city, Wind((3.0, 1.0)))
    assert city.is_free(np.add(foot, [0, 0, 1.0]))
    assert np.linalg.norm(foot[:2] - (np.array(places[corner]) + 10)) < 12
    assert foot[2] == 0.0


def test_where_all_corners_are_built_on_it_stands_elsewhere(hill):
    houses = [Building.prism(4 * SQUARE + place, 30) for place in ((0, 0), (68, 0), (0, 68), (68, 68))]
    city = City.from_buildings(houses, cell=2.0, origin=(0, 0, 0), size=(100, 100, 40))
    _, foot = parts_of_wind(city, Wind((3.0, 1.0)))
    assert city.is_free(np.add(foot, [0, 0, 1.0]))
    assert hill.height_above_ground(parts_of_wind(hill, Wind((3.0, 1.0)))[1]) == pytest.approx(0, abs=0.05)
    full = City(np.ones((4, 4, 4), dtype=bool), 5.0)  # nowhere is free: it is drawn all the same
    assert np.isfinite(parts_of_wind(full, Wind((3.0, 1.0)))[1]).all()


@pytest.mark.parametrize("blows", [(4.0, 0.0), (0.0, -3.0), (3.0, 4.0), (-6.0, 1.0), (2.0, 2.0, 1.0)])
def test_arrows_lie_along_the_wind_where_it_enters_the_map(blows):
    city = City(np.zeros((30, 60, 10), dtype=bool), 5.0)
    drawing, _ = parts_of_wind(city, Wind(blows))
    arrows = drawing.parts["wind"].triangles.reshape(3, -1, 3)
    level = np.array(blows[:2]) / np.hypot(*blows[:2])
    assert drawing.wind.tolist() == list(blows[:2])
    for points in arrows:
        along, across = points[:, :2] @ level, points[:, :2] @ [-level[1], level[0]]
        assert np.ptp(along) > 3 * np.ptp(across)
        tip = points[along > along.max() - 1e-6]
        assert np.ptp(tip[:, :2] @ [-level[1], level[0]]) < 1e-6  # the point is ahead
        assert points[:, 2].min() > 0
        assert (points[:, :2].mean(axis=0) - city.bounds[:, :2].mean(axis=0)) @ level < 0  # upwind
    tail = arrows[1][:, :2][(arrows[1][:, :2] @ level).argmin()]
    assert np.min(np.abs(tail - city.bounds[:, :2])) < 3.0  # at the border


@pytest.mark.parametrize(
    ("wind", "words"),
    [
        (Wind((3.0, 4.0), deviation=1.5), "wind 5 m/s, gusts of σ = 1.5 m/s"),
        (Wind((3.0, 4.0), "none"), "wind 5 m/s, no gusts"),
        (Wind((3.0, 4.0), deviation=0.0), "wind 5 m/s, no gusts"),
        (Wind((3.0, 4.0), "dryden"), "wind 5 m/s, Dryden gusts"),
        (Wind((0.0, 0.0, 2.0)), "no mean wind, gusts of σ = 1 m/s"),
    ],
)
def test_wind_in_words(table1, wind, words):
    drawing = drawn(table1, wind=wind)
    assert [entry.text for entry in drawing.legend if entry.kind == "wind"] == [words]
    assert ("wind" in drawing.parts) == words.startswith("wind")
    assert "wind sock" in drawing.parts


@pytest.mark.parametrize(
    "city",
    [
        City(np.zeros((1, 1, 1), dtype=bool)),
        City(np.ones((2, 2, 2), dtype=bool)),
        City(np.zeros((9, 1, 5), dtype=bool), 2.0, ground=np.linspace(0, 4, 9)[:, None]),
        City(np.zeros((9, 9, 5), dtype=bool), 2.0, ground=np.ones((9, 9))),
        City(
            np.ones((10, 10, 8), dtype=bool), 4.0, buildings=[Building.prism(SQUARE, 5)], ground=np.full((10, 10), 30.0)
        ),
        City(np.zeros((20, 20, 4), dtype=bool), 50_000.0),
    ],
    ids=["one voxel", "full", "a slope in one row", "level", "ground above its houses", "a thousand kilometres"],
)
def test_any_city_can_be_drawn(city):
    wind = Wind((1.0, 2.0))
    assert scene.show(city, wind=wind, risk=RiskMap(city, 1e-3, 0.5)).still
    content = content_of(scene.page(city, wind=wind))
    assert all(np.isfinite(mesh.positions).all() for mesh in content.meshes.values())
    assert np.isfinite(content.motion["corners"]).all()


def test_the_outline_has_all_of_flat_and_of_built_maps(table1):
    flat = drawn(City(np.zeros((4, 5, 6), dtype=bool), 2.0))
    corners = {(x, y) for x in (-4.0, 4.0) for y in (-5.0, 5.0)}
    assert set(map(tuple, flat.outline()[:, :2].tolist())) == corners
    built = drawn(table1).outline()
    assert built[:, 2].max() == pytest.approx(99 - 50)
    assert np.ptp(built, axis=0)[:2] == pytest.approx([100, 100])
