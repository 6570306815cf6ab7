"""What a scene shows of a city: voxels and their edges, ground, zones, risk, wind."""

import numpy as np
import pytest

from uavlab.city import Building, City, NoFlyZone, table1_city
from uavlab.plot.ground import ground_lattice
from uavlab.risk import reference_campus
from uavlab.scene.content import drawing_of
from uavlab.scene.drawing import Lines, Surface
from uavlab.scene.stage import layer_triangles, not_twice, voxel_edges, voxel_surface
from uavlab.weather import Wind


@pytest.fixture
def hill():
    x, y = np.meshgrid(np.arange(30) - 14.5, np.arange(20) - 9.5, indexing="ij")
    house = Building.prism([(2, 2), (24, 2), (24, 24), (2, 24)], 10)
    zones = (NoFlyZone([(70, 20), (90, 20), (90, 30)], 0.0, 20.0, name="<school>"),)
    ground = 20 * np.exp(-(x**2 + y**2) / 30)
    return City(np.zeros((30, 20, 15), dtype=bool), 4.0, buildings=(house,), name="hill", ground=ground, no_fly=zones)


def test_voxel_surface_encloses_the_occupied_volume():
    occupied = np.random.default_rng(1).random((6, 7, 5)) < 0.4
    origin = np.array([3.0, -2.0, 1.0])
    triangles = voxel_surface(City(occupied, cell=2.0, origin=origin)) - origin
    volume = np.einsum("ij,ij->i", triangles[:, 0], np.cross(triangles[:, 1], triangles[:, 2])).sum() / 6
    assert volume == pytest.approx(8 * occupied.sum())


def edges_by_hand(occupied):
    """Unit edges that some but not all of the four voxels around them touch, as pairs of lattice points."""
    padded = np.pad(occupied, 1)
    found = set()
    for i, j, k in np.ndindex(*(n + 1 for n in occupied.shape)):
        for axis in range(3):
            around = []
            for a in (0, 1):
                for b in (0, 1):
                    shift = np.insert([a, b], axis, 1)
                    place = tuple(np.array([i, j, k]) + shift)
                    around.append(
                        padded[place] if all(p < n for p, n in zip(place, padded.shape, strict=True)) else False
                    )
            if any(around) and not all(around):
                found.add(((i, j, k), tuple(np.array([i, j, k]) + np.eye(3, dtype=int)[axis])))
    return found


def test_voxel_edges_are_those_of_every_face_between_occupied_and_free():
    occupied = np.random.default_rng(2).random((4, 5, 3)) < 0.5
    lines = voxel_edges(City(occupied, cell=2.0, origin=(1.0, 2.0, 3.0))).reshape(-1, 2, 3)
    lines = np.round((lines - [1, 2, 3]) / 2).astype(int)
    found = set()
    for start, end in lines:
        step = np.sign(end - start)
        for number in range(np.abs(end - start).sum()):
            found.add((tuple(start + number * step), tuple(start + (number + 1) * step)))
    assert found == edges_by_hand(occupied)


def test_voxels_have_edges_unless_there_are_too_many():
    few = drawing_of(City(table1_city(cell=4.0).occupied, 4.0), ())
    assert isinstance(few.parts["edges"], Lines)
    assert "voxels of 4 m" in few.notes
    chequered = np.random.default_rng(0).random((60, 60, 60)) < 0.5
    many = drawing_of(City(chequered, 1.0), ())
    assert "edges" not in many.parts


def test_layers_lie_on_the_ground_when_they_get_its_heights(hill):
    heights = ground_lattice(hill, 50)[..., 2]
    layer = layer_triangles(hill, heights)
    assert layer.shape == (30 * 20, 2, 3, 3)
    assert np.allclose(hill.height_above_ground(layer), 0.0)
    assert np.array_equal(layer[..., :2], layer_triangles(hill, 7)[..., :2])
    normals = np.cross(layer[..., 1, :] - layer[..., 0, :], layer[..., 2, :] - layer[..., 0, :])
    assert (normals[..., 2] > 0).all()


def test_thin_sheets_are_drawn_once():
    sheet = np.array([[[0.0, 0, 0], [9, 0, 0], [0, 9, 0]]])
    rim = np.array([[[0.0, 0, 0], [9, 0, 0], [9, 0, 0.1]]])
    far = sheet + np.array([0, 0, 3.0])
    shapes = np.concatenate([sheet, sheet[:, ::-1] + np.array([0, 0, 0.1]), rim, far])
    assert not_twice(shapes).tolist() == [0, 3]


def test_buildings_keep_their_colours_one_for_each_triangle(hill):
    red = Building.prism([(50, 50), (60, 50), (60, 60), (50, 60)], 9, color="#FF0000")
    city = City.from_buildings([*hill.buildings, red], cell=4.0)
    surface = drawing_of(city, ()).parts["buildings"]
    assert isinstance(surface, Surface)
    reds = (surface.colors == [1, 0, 0]).all(axis=1)
    assert reds.sum() == 12
    assert (surface.triangles[reds].min(axis=(0, 1)) == [50, 50, 0]).all()


def test_zones_are_glass_with_edges_and_one_entry(hill):
    drawing = drawing_of(hill, ())
    zone = drawing.parts["no-fly zones"]
    assert zone.opacity < 0.5
    assert zone.triangles.max(axis=(0, 1))[:2].tolist() == [90, 30]
    assert [entry.text for entry in drawing.legend] == ["no-fly zone: <school>"]


def test_risk_replaces_the_ground_and_a_slice_is_glass():
    campus = reference_campus()
    drawing = drawing_of(campus.city, (), risk=campus, slice_height=27.5)
    ground, cut = drawing.parts["risk on the ground"], drawing.parts["risk at a height"]
    assert len(ground.triangles) == 2 * 30 * 30
    assert len(cut.triangles) == 2 * np.count_nonzero(campus.flyable[:, :, 5])  # buildings are left out
    assert (cut.triangles[..., 2] == 27.5).all()
    assert cut.opacity < 1 == ground.opacity
    lightness = ground.colors.sum(axis=1)[::2].reshape(30, 30)
    assert lightness[28, 28] > lightness[2, 2] + 0.5  # the crowded square against the park


def test_the_wind_sock_stands_on_free_ground_and_arrows_point_along_the_wind(hill):
    drawing = drawing_of(hill, (), wind=Wind((3.0, 4.0)))
    foot = drawing.parts["wind sock"].triangles[:12].min(axis=(0, 1))
    assert not ((foot[:2] > 0) & (foot[:2] < 26)).all()  # where the house is
    assert hill.height_above_ground(foot[None])[0] == pytest.approx(0, abs=0.5)
    arrows = drawing.parts["wind"].triangles.reshape(3, -1, 3)
    for shape in arrows:
        along = shape @ np.array([0.6, 0.8, 0.0])
        across = shape @ np.array([-0.8, 0.6, 0.0])
        assert np.ptp(along) > 3.9 * np.ptp(across)
        tip = shape[along.argmax()]
        assert np.linalg.norm(across[along.argmax()] - across.mean()) < 0.1 * np.ptp(along), tip
    assert drawing.legend[-1].text == "wind 5 m/s, gusts of σ = 1 m/s"


def test_a_calm_has_a_sock_and_no_arrows(hill):
    drawing = drawing_of(hill, (), wind=Wind(deviation=0.5))
    assert "wind" not in drawing.parts
    assert drawing.legend[-1].text == "no mean wind, gusts of σ = 0.5 m/s"


def test_the_outline_has_all_of_flat_and_of_built_maps(hill):
    flat = drawing_of(City(np.zeros((4, 5, 6), dtype=bool), 2.0), ())
    corners = {(x, y) for x in (-4.0, 4.0) for y in (-5.0, 5.0)}
    assert set(map(tuple, flat.outline()[:, :2].tolist())) == corners
    built = drawing_of(table1_city(), ()).outline()
    assert built[:, 2].max() == pytest.approx(99 - 50)
    assert np.ptp(built, axis=0)[:2] == pytest.approx([100, 100])
