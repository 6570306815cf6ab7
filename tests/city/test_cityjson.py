"""CityJSON with known content: volumes in closed form, each kind of object and geometry, every error."""

import json
import warnings

import numpy as np
import pyproj
import pytest
from files import BOX, GABLE, SQUARE, TRIANGULATED_BOX, box, building, feature, shifted, solid, write
from scipy.spatial import ConvexHull

from uavlab.city import City, read_city, read_cityjson
from uavlab.city.terrain import Terrain

pytestmark = pytest.mark.filterwarnings("ignore:.*assumed. ground level at the lowest point:UserWarning")

RD = {"referenceSystem": "https://www.opengis.net/def/crs/EPSG/0/7415"}
EYE = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]


def solid_volume(thing):
    """Of pieces that don't overlap [m³]."""
    return sum(ConvexHull(piece).volume for piece in thing.pieces)


def thing(kind, *geometry, **members):
    return {"type": kind, "geometry": list(geometry), **members}


def surfaces(found, lod="1"):
    return {"type": "MultiSurface", "lod": lod, "boundaries": found}


@pytest.fixture
def read(cityjson):
    """A city of objects, with coordinates in metres that nobody has to doubt."""

    def city(vertices, objects, *, crs="local", cell=1.0, margin=20.0, terrain=None, height_unit=None, **members):
        path = cityjson(vertices, objects, **members)
        return read_cityjson(path, crs=crs, cell=cell, margin=margin, terrain=terrain, height_unit=height_unit)

    return city


def test_lod1_solid_is_a_box_of_one_piece(read):
    city = read(box((84000, 447000, 2), (84010, 447020, 8)), {"A": building(solid(BOX))}, cell=0.5)
    assert np.allclose(city.buildings[0].bounds, [(0, 0, 0), (10, 20, 6)])
    assert solid_volume(city.buildings[0]) == pytest.approx(1200)
    assert len(city.buildings[0].pieces) == 1
    assert (city.name, city.buildings[0].name, city.reference) == ("model", "A", None)
    assert np.allclose(city.bounds[:, :2], [(-20, -20), (30, 40)])
    assert (city.ground == 0).all()


def test_transform_is_applied(read):
    vertices = [[1000 * v for v in corner] for corner in box((0, 0, 0), (10, 20, 6))]
    transform = {"scale": [0.001, 0.001, 0.002], "translate": [84000.5, 447000.0, -3.0]}
    city = read(vertices, {"A": building(solid(BOX))}, transform=transform, margin=7)
    assert np.allclose(city.buildings[0].bounds, [(0, 0, 0), (10, 20, 12)])
    assert np.allclose(city.bounds[:, :2], [(-7, -7), (17, 27)])


@pytest.mark.parametrize(
    "geometry",
    [
        solid(BOX),
        solid(TRIANGULATED_BOX),
        {"type": "MultiSurface", "lod": 1, "boundaries": BOX},
        {"type": "CompositeSurface", "lod": 1.2, "boundaries": BOX[1:2]},
        {"type": "MultiSolid", "lod": "1", "boundaries": [[BOX]]},
        {"type": "CompositeSolid", "lod": "1", "boundaries": [[BOX]]},
    ],
    ids=["solid", "triangles", "multisurface", "roof only", "multisolid", "compositesolid"],
)
def test_every_kind_of_geometry_gives_the_same_box(read, geometry):
    vertices = box((5, 5, 0), (15, 15, 8)) + box((30, 5, 0), (31, 6, 1))
    city = read(vertices, {"A": building(geometry), "B": building(solid(shifted(BOX, 8)))})
    assert solid_volume(city.buildings[0]) == pytest.approx(800)
    assert len(city.buildings[0].pieces) == 1


@pytest.mark.parametrize("kind", ["Building", "OtherConstruction"])
@pytest.mark.parametrize(
    "roof", [[[[4, 8, 9, 7]], [[5, 6, 9, 8]]], [[[4, 8, 9]], [[4, 9, 7]], [[5, 6, 9]], [[5, 9, 8]]]]
)
def test_gable_roof_has_the_volume_of_its_closed_form(read, roof, kind):
    vertices = [*box((0, 0, 0), (10, 20, 6)), [5, 0, 11], [5, 20, 11]]
    city = read(vertices, {"A": thing(kind, solid(GABLE[:-2] + roof, "2"))}, cell=0.25)
    assert solid_volume(city.buildings[0]) == pytest.approx(10 * 20 * (6 + 5 / 2))
    assert not city.is_free([(5, 10, 10.6), (1, 10, 6.6), (9, 1, 6.6)]).any()
    assert city.is_free([(1, 10, 7.5), (9, 10, 7.5), (5, 10, 11.4)]).all()


def test_roof_that_is_not_plane_goes_through_all_its_corners(read):
    vertices = [*box((0, 0, 0), (10, 10, 6))[:4], [0, 0, 6], [10, 0, 9], [10, 10, 6], [0, 10, 9]]
    city = read(vertices, {"A": building(solid(BOX, "2"))})
    inside = np.array(vertices) * (0.999, 0.999, 0.999) + (0.005, 0.005, 0)
    assert city.buildings[0].contains(inside).all()
    volume = solid_volume(city.buildings[0])
    assert volume in (pytest.approx(700), pytest.approx(800))  # whichever diagonal it is folded along


def test_roof_with_a_step_takes_the_higher_corner(read):
    vertices = [[0, 0, 6], [10, 0, 6], [10, 0, 9], [10, 10, 9], [0, 10, 6], *box((0, 0, 0), (10, 10, 6))]
    roof = surfaces([*shifted(BOX[:1], 5), [[0, 1, 2, 3, 4]]], 2)
    city = read(vertices, {"A": building(roof)})
    assert city.buildings[0].contains((9.99, 0.01, 8.9))


def test_flat_roof_over_a_sloped_floor_is_filled_to_the_lowest_corner(read):
    vertices = [[x, y, 3 if x == 10 and z == 0 else z] for x, y, z in box((0, 0, 0), (10, 10, 8))]
    city = read(vertices, {"A": building(solid(BOX))}, cell=0.5)
    assert (city.occupied[40:60, 40:60].sum(axis=2) * 0.5).min() >= 8
    assert np.allclose(city.buildings[0].bounds, [(0, 0, 0), (10, 10, 8)])
    assert city.ground[58, 50] == pytest.approx(3 * 9.25 / 10)  # the floor tells the ground, and it slopes


def test_house_on_a_hill_stands_on_its_own_ground(read):
    vertices = box((0, 0, 10), (10, 10, 16)) + box((300, 0, 110), (310, 10, 116))
    city = read(vertices, {"A": building(solid(BOX)), "B": building(solid(shifted(BOX, 8)))}, cell=2)
    assert np.allclose([b.bounds[:, 2] for b in city.buildings], [(0, 6), (100, 106)])
    middle = tuple(city.cell_of((155, 5, 0))[:2])
    assert city.ground[middle] == pytest.approx(50, abs=1)
    assert not city.is_free((155, 5, 45))
    assert city.is_free((155, 5, 55))
    assert "ground from the feet of the buildings" in str(city.source)


def test_passage_under_a_building_is_filled_and_told(read):
    vertices = box((0, 0, 0), (10, 10, 3)) + box((10, 0, 4), (20, 10, 9))  # the second one hangs
    city = read(vertices, {"A": building(solid(BOX + shifted(BOX, 8)))})
    assert solid_volume(city.buildings[0]) == pytest.approx(10 * 10 * 3 + 10 * 10 * 9)
    assert city.source.count("derived", "filled below a passage") == 1


def test_hole_in_a_surface_is_a_courtyard(read):
    vertices = box((0, 0, 0), (10, 10, 5)) + box((3, 3, 0), (7, 7, 5))
    found = [[[0, 3, 2, 1], [8, 9, 10, 11]], [[4, 5, 6, 7], [12, 15, 14, 13]], *BOX[2:], *shifted(BOX[2:], 8)]
    for kind in ("Building", "OtherConstruction"):
        city = read(vertices, {"A": thing(kind, solid(found))})
        assert city.is_free([(5, 5, 1), (3.2, 6.7, 4)]).all()
        assert not city.is_free((1.5, 5, 4.6))
        assert solid_volume(city.buildings[0]) == pytest.approx((100 - 16) * 5)


def test_highest_level_of_detail_is_taken(read):
    vertices = [*box((0, 0, 0), (10, 20, 6)), [5, 0, 11], [5, 20, 11], *box((0, 0, 0), (10, 20, 11))]
    levels = [solid(shifted(BOX, 10), 1), solid(GABLE, "2.2"), solid(shifted(BOX, 10), "1.3")]
    city = read(vertices, {"A": building(*levels)})
    assert solid_volume(city.buildings[0]) == pytest.approx(10 * 20 * (6 + 5 / 2))


def test_parts_belong_to_their_building(read):
    vertices = box((0, 0, 0), (10, 10, 6)) + box((10, 0, 0), (20, 10, 9))
    footprint = surfaces(shifted(BOX[1:2], 8), "0")
    objects = {
        "A": building(footprint, children=["A-1", "A-2"]),
        "A-1": thing("BuildingPart", solid(BOX), parents=["A"], children=["A-2"]),
        "A-2": thing("BuildingPart", solid(shifted(BOX, 8)), parents=["A-1"]),
    }
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        city = read(vertices, objects)
    assert [b.name for b in city.buildings] == ["A"]
    assert sorted(ConvexHull(piece).volume for piece in city.buildings[0].pieces) == pytest.approx([600, 900])
    assert city.source.count("taken", "BuildingPart") == 2


def test_part_that_is_only_a_footprint_is_missed(read):
    footprint = surfaces(BOX[:1], "0.2")
    objects = {
        "A": building(children=["A-1", "A-2"]),
        "A-1": thing("BuildingPart", solid(BOX), parents=["A"]),
        "A-2": thing("BuildingPart", footprint, parents=["A"]),
    }
    with pytest.warns(UserWarning, match=r"left out: 1 × BuildingPart: level of detail 0 only \(A-2\)"):
        read(box((0, 0, 0), (10, 10, 6)), objects)


def test_mast_on_a_roof_is_an_obstacle_of_its_own(read):
    vertices = box((0, 0, 0), (20, 20, 10)) + box((8, 8, 10), (12, 12, 30))
    mast = thing("BuildingInstallation", solid(shifted(BOX, 8)), parents=["house"])
    city = read(vertices, {"house": building(solid(BOX), children=["mast"]), "mast": mast})
    assert [b.name for b in city.buildings] == ["house", "BuildingInstallation mast"]
    assert solid_volume(city.buildings[1]) == pytest.approx(4 * 4 * 20)
    assert not city.is_free((10, 10, 29.5))
    assert city.is_free((5, 5, 11.5))
    assert city.source.count("taken", "BuildingInstallation") == 1


def test_ground_comes_from_buildings_alone(read):
    vertices = box((0, 0, 5), (10, 10, 11)) + box((40, 0, 0), (50, 10, 30)) + box((0, 40, 25), (10, 50, 30))
    objects = {
        "A": building(solid(BOX)),
        "B": thing("Bridge", solid(shifted(BOX, 8))),
        "C": thing("CityFurniture", solid(shifted(BOX, 16))),
    }
    city = read(vertices, objects)
    assert (city.ground == 0).all()
    assert [b.bounds[0, 2] for b in city.buildings] == pytest.approx([0, -5, 20])


@pytest.mark.parametrize(
    "kind",
    [
        "Bridge", "BridgePart", "BridgeInstallation", "BridgeConstructiveElement", "OtherConstruction",
        "CityFurniture", "SolitaryVegetationObject", "PlantCover", "GenericCityObject", "+Crane",
        "BuildingInstallation", "BuildingConstructiveElement",
    ],
)  # fmt: skip
def test_everything_but_buildings_keeps_its_lower_surface(read, kind):
    vertices = box((0, 0, 0), (5, 5, 3)) + box((20, 0, 6), (60, 8, 7))
    city = read(vertices, {"A": building(solid(BOX)), "B": thing(kind, solid(shifted(BOX, 8)))})
    assert city.buildings[1].name == f"{kind} B"
    assert np.allclose(city.buildings[1].bounds, [(20, 0, 6), (60, 8, 7)])
    assert city.is_free((40, 4, 3))
    assert not city.is_free((40, 4, 6.5))


def test_arched_bridge_leaves_the_air_below(read):
    x = np.linspace(-1, 1, 9)
    outline = [*np.column_stack([20 * x, 5 - 4 * x**2]), (20, 6), (-20, 6)]
    vertices = [[u, y, z] for y in (0, 8) for u, z in outline]
    count = len(outline)
    sides = [[list(range(count))[::-1]], [list(range(count, 2 * count))]]
    around = [[[i, (i + 1) % count, count + (i + 1) % count, count + i]] for i in range(count)]
    city = read(vertices, {"B": thing("Bridge", solid(sides + around, "2"))}, cell=0.25)
    below = 8 * 20 * np.trapezoid(5 - 4 * x**2, x)
    assert solid_volume(city.buildings[0]) == pytest.approx(8 * 40 * 6 - below)
    assert city.is_free((20, 4, 3.5))  # z = 0 is at the piers' feet, 1 m up in the file
    assert not city.is_free((20, 4, 4.5))


def test_a_surface_alone_is_a_thin_slab_and_nothing_below_is_filled(read):
    vertices = box((0, 0, 0), (5, 5, 3)) + box((20, 0, 6), (60, 8, 7))
    city = read(vertices, {"A": building(solid(BOX)), "B": thing("Bridge", surfaces(shifted(BOX[1:2], 8)))})
    assert solid_volume(city.buildings[1]) == pytest.approx(40 * 8 * 0.1)
    assert np.allclose(city.buildings[1].bounds[:, 2], (6.9, 7))


def test_what_of_a_surface_hangs_over_another_becomes_a_slab(read):
    vertices = box((0, 0, 0), (10, 10, 4)) + box((4, 0, 0), (10, 10, 3))
    found = [*shifted(BOX[:1], 8), *BOX[1:2]]  # a roof of 10 × 10 m, a floor below 6 × 10 of it
    city = read([*vertices, *box((50, 0, 0), (51, 1, 1))], {
        "A": building(solid(shifted(BOX, 16))), "B": thing("CityFurniture", surfaces(found))
    })  # fmt: skip
    assert solid_volume(city.buildings[1]) == pytest.approx(6 * 10 * 4 + 4 * 10 * 0.1)


@pytest.mark.parametrize("doubled", [False, True])
def test_sign_is_a_thin_wall(read, doubled):
    vertices = box((0, 0, 0), (5, 5, 3)) + box((20, 0, 2), (24, 3, 5))
    front = shifted(BOX[2:3], 8)
    back = [[front[0][0][::-1]]] if doubled else []
    city = read(vertices, {"A": building(solid(BOX)), "B": thing("CityFurniture", surfaces(front + back))})
    assert np.allclose(city.buildings[1].bounds, [(20, -0.05, 2), (24, 0.05, 5)])
    assert solid_volume(city.buildings[1]) == pytest.approx((2 if doubled else 1) * 4 * 3 * 0.1)


def test_walls_without_a_floor_stand(read):
    vertices = box((0, 0, 0), (5, 5, 3)) + box((20, 0, 0), (24, 3, 5))
    city = read(vertices, {"A": building(solid(BOX)), "B": thing("CityFurniture", surfaces(shifted(BOX[1:], 8)))})
    walls = [(20, 1.5, 2.5), (24, 1.5, 2.5), (22, 0, 2.5), (22, 3, 2.5), (22, 1.5, 4.95)]
    assert city.buildings[1].contains(walls).all()
    assert not city.buildings[1].contains((22, 1.5, 2.5))


def test_parapet_above_a_roof_stands(read):
    vertices = [*box((0, 0, 0), (10, 10, 6)), [0, 0, 7.5], [10, 0, 7.5]]
    city = read(vertices, {"A": building(surfaces([*BOX, [[4, 5, 9, 8]]]))})
    assert city.buildings[0].contains((5, 0, 7.2))
    assert solid_volume(city.buildings[0]) == pytest.approx(600 + 10 * 1.5 * 0.1, rel=1e-4)


def test_building_of_walls_alone_stands(read):
    city = read(box((0, 0, 0), (10, 10, 6)), {"A": building(surfaces(BOX[2:]))})
    assert city.buildings[0].contains([(0, 5, 3), (10, 5, 3), (5, 0, 3), (5, 10, 3)]).all()


def test_lattice_of_many_bars_is_filled_to_its_own_bottom(read):
    rng = np.random.default_rng(1)
    bars = rng.uniform(0, 3, (150, 3, 3)) * (1, 1, 10) + (0, 0, 5)
    found = [[[3 * i, 3 * i + 1, 3 * i + 2]] for i in range(len(bars))]
    city = read(bars.reshape(-1, 3).tolist(), {"B": thing("OtherConstruction", surfaces(found))})
    inside = bars.mean(axis=1) - bars.reshape(-1, 3).min(axis=0)
    assert city.buildings[0].contains(inside).all()
    assert len(city.buildings[0].pieces) < 50 * len(bars)


def test_walls_and_degenerate_surfaces_are_nothing(read):
    vertices = [*box((0, 0, 0), (10, 10, 6)), [0, 0, 3], [50, 50, 50]]
    rubbish = [[[0, 1, 5, 4]], [[0, 4, 8]], [[4, 4, 4]], [[4, 6]], [[0, 1, 0, 1]], [[]], []]
    city = read(vertices, {"A": building(solid(BOX + rubbish))})
    assert len(city.buildings[0].pieces) == 1
    assert solid_volume(city.buildings[0]) == pytest.approx(600)


def test_roof_that_crosses_itself_still_stands(read):
    vertices = box((0, 0, 0), (10, 10, 6))
    city = read(vertices, {"A": building(solid([*BOX[:1], [[4, 6, 5, 7]], *BOX[2:]]))}, cell=0.25)
    roof = city.buildings[0]
    assert roof.contains([(1, 5, 5), (9, 5, 5)]).all() or roof.contains([(5, 1, 5), (5, 9, 5)]).all()
    assert roof.contains([(0, 5, 3), (5, 0, 3), (10, 5, 3), (5, 10, 3)]).all()  # the walls stand anyway


def test_slender_triangles_are_kept(read):
    x = 500.0
    vertices = [[0, 0, 0], [x, 0, 0], [x, 0.01, 0], [0, 0.01, 0], [0, 0, 5], [x, 0, 5], [x, 0.01, 5], [0, 0.01, 5]]
    city = read(vertices, {"A": building(solid(BOX)), "B": thing("OtherConstruction", solid(BOX))})
    assert [solid_volume(b) for b in city.buildings] == pytest.approx([25, 25])


TEMPLATE = {"templates": [solid(BOX)], "vertices-templates": box((0, 0, 0), (10, 4, 6))}


def instance(matrix, point=8, template=0):
    return {"type": "GeometryInstance", "template": template, "boundaries": [point], "transformationMatrix": matrix}


@pytest.mark.parametrize(
    ("matrix", "bounds"),
    [
        (EYE, [(40, 30, 0), (50, 34, 6)]),
        ([0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1], [(36, 30, 0), (40, 40, 6)]),  # a quarter turn
        ([2, 0, 0, 5, 0, 1, 0, 6, 0, 0, 0.5, 7, 0, 0, 0, 1], [(45, 36, 7), (65, 40, 10)]),  # scaled and shifted
    ],
)
@pytest.mark.parametrize("kind", ["Building", "SolitaryVegetationObject"])
def test_instance_is_its_template_turned_scaled_and_shifted(read, kind, matrix, bounds):
    vertices = [*box((0, 0, 0), (20, 20, 10)), [40, 30, 0]]
    objects = {"A": building(solid(BOX)), "B": thing(kind, instance(matrix))}
    city = read(vertices, objects, **{"geometry-templates": TEMPLATE})
    assert np.allclose(city.buildings[1].bounds, bounds)
    assert solid_volume(city.buildings[1]) == pytest.approx(np.prod(np.ptp(bounds, axis=0)))


def test_instance_has_the_level_of_detail_of_its_template(read):
    templates = {"templates": [solid(BOX, "0"), solid(BOX, "2")], "vertices-templates": TEMPLATE["vertices-templates"]}
    vertices = [*box((0, 0, 0), (10, 6, 10)), [40, 30, 0]]
    objects = {"A": building(solid(BOX, "1"), instance(EYE, template=1), instance(EYE, template=0))}
    city = read(vertices, objects, **{"geometry-templates": templates})
    assert np.allclose(np.ptp(city.buildings[0].bounds, axis=0), (10, 4, 6))


@pytest.mark.parametrize(
    ("member", "told"),
    [
        ({"template": 1}, "template 1 is none of the 1"),
        ({"template": -1}, "template -1 is none of the 1"),
        ({"boundaries": [9]}, "vertex 9 is none of the 9"),
        ({"boundaries": []}, "not enough values"),
        ({"transformationMatrix": [1, 0, 0]}, "cannot reshape"),
        ({"transformationMatrix": ["x"] * 16}, "could not convert"),
        ({"transformationMatrix": [1e999] * 16}, "not finite"),
    ],
)
def test_wrong_instances_are_named(cityjson, member, told):
    objects = {"B": building(instance(EYE) | member)}
    path = cityjson([*box((0, 0, 0), (20, 20, 10)), [40, 30, 0]], objects, **{"geometry-templates": TEMPLATE})
    path.write_text(path.read_text().replace("Infinity", "1e999"))
    with pytest.raises(ValueError, match=rf"model\.city\.json: 'B' is malformed: .*{told}"):
        read_cityjson(path)


HILL = [[20, -80, 0], [190, -80, 0], [190, 90, 0], [20, 90, 0], [105, 5, 60]]
SLOPES = [[[16, 17, 20]], [[17, 18, 20]], [[18, 19, 20]], [[19, 16, 20]]]


def two_houses(z=0):
    return box((0, 0, z), (10, 10, z + 9)) + box((200, 0, z), (210, 10, z + 9))


def houses():
    return {"west": building(solid(BOX)), "east": building(solid(shifted(BOX, 8)))}


@pytest.mark.parametrize("kind", ["CompositeSurface", "MultiSurface"])
def test_relief_is_the_ground(read, kind):
    relief = thing("TINRelief", {"type": kind, "lod": "1", "boundaries": SLOPES})
    city = read([*two_houses(), *HILL], {**houses(), "hill": relief}, cell=2)
    columns = [tuple(city.cell_of((x, 5, 0))[:2]) for x in (5, 63, 105, 200)]
    x = [city.coordinates(0)[column[0]] for column in columns]
    assert [city.ground[column] for column in columns] == pytest.approx([0, 60 * (x[1] - 20) / 85, 60, 0], abs=0.9)
    assert not city.is_free((105, 5, 50))
    assert [b.name for b in city.buildings] == ["west", "east"]
    assert "ground from TINRelief" in str(city.source)


def test_relief_goes_on_to_the_feet_beside_it(read):
    vertices = [*two_houses(), [20, -80, 40], [90, -80, 40], [90, 90, 40], [20, 90, 40]]
    relief = thing("TINRelief", surfaces([[[16, 17, 18, 19]]]))  # a table of 40 m between two houses at 0
    city = read(vertices, {**houses(), "table": relief}, cell=2)
    ground = [city.ground[tuple(city.cell_of((x, 5, 0))[:2])] for x in (5, 50, 88, 145, 205)]
    assert ground == pytest.approx([0, 40, 40, 20, 0], abs=1.0)


def test_terrain_that_is_given_wins(read):
    relief = thing("TINRelief", surfaces(SLOPES))
    city = read([*two_houses(100), *HILL], {**houses(), "hill": relief}, cell=2, terrain=98.0)
    assert (city.ground == -2).all()  # metres of the file, of which z = 0 is 100 up
    assert "ground from terrain=, which wins over the file's TINRelief" in str(city.source)
    raster = Terrain.from_raster(np.full((3, 3), 7.0), (-100, -100, 400, 200))
    assert (read(two_houses(100), houses(), cell=2, terrain=raster).ground == 7).all()
    with pytest.raises(ValueError, match="terrain must be finite"):
        read(two_houses(), houses(), terrain=np.nan)


def test_without_a_building_the_ground_is_assumed(read):
    with pytest.warns(UserWarning, match="assumed: ground level at the lowest point"):
        city = read(box((0, 0, 7), (10, 10, 9)), {"B": thing("Bridge", solid(BOX))})
    assert (city.ground == 0).all()
    assert np.allclose(city.buildings[0].bounds[:, 2], (0, 2))


def test_place_and_true_north_of_a_projected_file(read):
    vertices = box((84600, 447400, 2), (84610, 447420, 8)) + box((85600, 447400, 2), (85610, 447420, 8))
    city = read(vertices, {"A": building(solid(BOX)), "B": building(solid(shifted(BOX, 8)))}, crs=None, metadata=RD)
    lon, lat, height = city.reference
    assert (lon, lat, height) == pytest.approx((4.3624, 52.0107, 2.0), abs=2e-3)
    way = city.buildings[1].pieces[0][0] - city.buildings[0].pieces[0][0]  # 1 km along the grid's x
    to_degrees = pyproj.Transformer.from_crs(28992, 4326, always_xy=True)
    (west, east), (south, north) = to_degrees.transform([84600, 85600], [447400, 447400])
    azimuth, _, length = pyproj.Geod(ellps="WGS84").inv(west, south, east, north)
    assert np.hypot(*way[:2]) == pytest.approx(length, abs=0.01)
    assert np.degrees(np.arctan2(way[1], way[0])) == pytest.approx(90 - azimuth, abs=1e-3)
    assert azimuth == pytest.approx(89.19, abs=0.01)  # grid north is not north
    assert np.min([b.bounds[0, :2] for b in city.buildings], axis=0) == pytest.approx((0, 0), abs=1e-6)
    assert "heights in metre" in str(city.source)
    assert "EPSG:7415" in str(city.source)
    assert not city.source.doubts


def test_feet_become_metres(read):
    vertices = box((987000, 213000, 30), (987100, 213100, 360))
    metadata = {"referenceSystem": "urn:ogc:def:crs:EPSG::2263"}
    city = read(vertices, {"A": building(solid(BOX))}, crs=None, metadata=metadata)
    assert np.ptp(city.buildings[0].bounds, axis=0)[2] == pytest.approx(330 * 1200 / 3937, rel=1e-6)
    assert city.reference.height == pytest.approx(30 * 1200 / 3937)
    city = read(vertices, {"A": building(solid(BOX))}, crs="EPSG:2263", height_unit="m", cell=4.0)
    assert np.ptp(city.buildings[0].bounds, axis=0)[2] == pytest.approx(330)


def test_degrees_are_placed(read):
    vertices = box((4.3600, 52.0100, 0), (4.3603, 52.0102, 6))
    for members in ({"metadata": {"referenceSystem": "EPSG:4979"}}, {}):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            city = read(vertices, {"A": building(solid(BOX))}, crs=None, **members)
        assert np.ptp(city.buildings[0].bounds, axis=0) == pytest.approx((20.6, 22.3, 6), abs=0.1)
        assert city.reference[:2] == pytest.approx((4.36, 52.01), abs=1e-9)
        assert len(caught) == (0 if members else 1)  # degrees that nobody declared are a guess


def test_small_coordinates_without_a_system_are_metres_and_that_is_said(cityjson):
    path = cityjson(box((0, 0, 0), (20, 20, 6)), {"A": building(solid(BOX))})
    with pytest.warns(UserWarning, match="assumed: coordinates in metres, of an unknown place"):
        city = read_cityjson(path)
    assert np.allclose(city.buildings[0].bounds, [(0, 0, 0), (20, 20, 6)])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        read_cityjson(path, crs="local")


def test_large_coordinates_without_a_system_are_asked_for(cityjson):
    path = cityjson(box((84000, 447000, 0), (84020, 447020, 6)), {"A": building(solid(BOX))})
    with pytest.raises(ValueError, match=r"crs='EPSG:\.\.\.'.*crs='local'"):
        read_cityjson(path)
    with pytest.raises(ValueError, match="crs"):
        read_cityjson(path, crs="EPSG:99999999")
    with pytest.raises(ValueError, match="height_unit"):
        read_cityjson(path, crs="local", height_unit="furlong")


def test_city_of_no_extent_is_refused(cityjson):
    path = cityjson(box((4.36, 52.01, 0), (4.3603, 52.0102, 6)), {"A": building(solid(BOX))})
    with pytest.raises(ValueError, match=r"cover 0.0003 × 0.0002 m, which is no city: pass crs='EPSG:\.\.\.'"):
        read_cityjson(path, crs="local")
    path = cityjson(box((0, 0, 0), (2e5, 10, 6)), {"A": building(solid(BOX))})
    with pytest.raises(ValueError, match=r"cover 2e\+05 × 10 m, which is no city"):
        read_cityjson(path, crs="local")


def lines_of_a_sequence():
    transform = {"scale": [0.5, 0.5, 0.5], "translate": [100, 100, 0]}
    header = {"type": "CityJSON", "version": "2.0", "CityObjects": {}, "vertices": [], "transform": transform}
    header["geometry-templates"] = {"templates": [solid(BOX)], "vertices-templates": box((0, 0, 0), (5, 5, 5))}
    lines = [
        {"type": "CityJSONFeature", "id": key, "CityObjects": {key: building(geometry)}, "vertices": vertices}
        for key, geometry, vertices in [
            ("A", solid(BOX), box((0, 0, 0), (20, 20, 10))),
            ("B", solid(BOX), box((60, 0, 0), (80, 20, 30))),
            ("C", instance(EYE, point=0), [[100, 0, 0]]),
        ]
    ]
    return [header, *lines]


@pytest.mark.parametrize("between", ["\n", "\r\n\r\n", "\x1e", "\n\x1e", ""])
@pytest.mark.parametrize("start", ["", "\x1e"])
def test_sequence_of_features_has_vertices_per_feature_and_shares_templates(tmp_path, start, between):
    path = write(tmp_path / "town.city.jsonl", start + between.join(map(json.dumps, lines_of_a_sequence())) + "\n")
    city = read_cityjson(path, crs="local")
    assert [b.name for b in city.buildings] == ["A", "B", "C"]
    assert np.allclose(city.buildings[1].bounds, [(30, 0, 0), (40, 10, 15)])
    assert np.allclose(city.buildings[2].bounds, [(50, 0, 0), (55, 5, 5)])
    if not start:
        assert len(read_city(path, crs="local").buildings) == 3


def test_sequence_of_other_things_is_refused(tmp_path):
    path = write(tmp_path / "town.jsonl", *lines_of_a_sequence(), {"type": "Feature"})
    with pytest.raises(ValueError, match=r"town\.jsonl: object 5 of the sequence is a 'Feature'"):
        read_cityjson(path, crs="local")


def test_features_with_one_key_are_two_buildings(tmp_path):
    header, first, second, _ = lines_of_a_sequence()
    second["CityObjects"] = {"A": second["CityObjects"]["B"]}
    city = read_cityjson(write(tmp_path / "town.jsonl", header, first, second), crs="local")
    assert [b.name for b in city.buildings] == ["A", "A"]


def test_objects_with_one_key_are_both_kept_and_told(tmp_path):
    objects = ", ".join(f'"A": {json.dumps(building(solid(shifted(BOX, by))))}' for by in (0, 8))
    vertices = json.dumps(two_houses())
    text = f'{{"type": "CityJSON", "vertices": {vertices}, "CityObjects": {{{objects}}}}}'
    city = read_cityjson(write(tmp_path / "twice.city.json", text), crs="local")
    assert [b.name for b in city.buildings] == ["A", "A (again)"]
    assert city.source.count("mended", "key of another one") == 1


def test_source_counts_what_was_taken_and_left_out(read):
    vertices = two_houses() + box((50, 50, 0), (60, 60, 0.2))
    flat = surfaces(shifted(BOX[:1], 16))
    objects = {
        **houses(),
        "footprint": building(surfaces(BOX[:1], "0")),
        "nothing": building(),
        "level": building(flat),
        "sign": thing("CityFurniture", {"type": "MultiPoint", "lod": 1, "boundaries": [0]}),
        "tube": thing("Tunnel", solid(BOX)),
        "room": thing("BuildingRoom", solid(BOX), parents=["west"]),
        "grass": thing("PlantCover", flat),
        "mat": thing("GenericCityObject", flat),
        "paint": thing("+Marking", flat),
        "street": thing("Road", flat),
        "lane": thing("Road"),
        "pond": thing("WaterBody", flat),
        "group": {"type": "CityObjectGroup", "children": []},
    }
    with pytest.warns(UserWarning, match="left out") as caught:
        city = read(vertices, objects)
    assert len(caught) == 1
    assert city.source.count("taken", "Building") == 2
    assert {(entry.what, entry.first) for entry in city.source.of("left out")} == {
        ("Building: level of detail 0 only", ("footprint",)),
        ("Building: no geometry", ("nothing",)),
        ("Building without a height", ("level",)),
        ("CityFurniture: only MultiPoint", ("sign",)),
        ("Tunnel: below the ground", ("tube",)),
        ("interior: BuildingRoom", ("room",)),
        ("PlantCover: flat", ("grass",)),
        ("GenericCityObject: flat", ("mat",)),
        ("+Marking: flat", ("paint",)),
    }
    assert "no obstacle: 2 Road, 1 WaterBody, 1 CityObjectGroup" in str(city.source)


def test_building_of_rooms_alone_is_taken(read):
    rooms = {"room": thing("BuildingRoom", solid(BOX), parents=["storey"])}
    objects = {"A": building(), "storey": thing("BuildingStorey", parents=["A"], children=["room"]), **rooms}
    city = read(box((0, 0, 0), (10, 10, 3)), objects)
    assert [b.name for b in city.buildings] == ["A"]
    assert solid_volume(city.buildings[0]) == pytest.approx(300)


@pytest.mark.parametrize(
    ("objects", "told"),
    [
        ({"B": building()}, "left out: 1 × Building: no geometry"),
        ({"B": building(surfaces(BOX[1:2], "0"))}, "Building: level of detail 0 only"),
        ({"B": building({"type": "MultiPoint", "lod": 1})}, "Building: only MultiPoint"),
        ({"1": {"type": "Road"}, "2": {"type": "Road"}, "3": {"type": "WaterBody"}}, "2 Road, 1 WaterBody"),
        ({}, "it has no objects"),
    ],
)
def test_file_without_solids_says_what_it_has(cityjson, objects, told):
    path = cityjson(box((0, 0, 0), (10, 10, 6)), objects)
    with pytest.raises(ValueError, match=rf"model\.city\.json has no building, bridge or other solid: .*{told}"):
        read_cityjson(path)


def test_file_of_flat_things_alone_is_refused(cityjson):
    path = cityjson(box((0, 0, 0), (10, 10, 6)), {"B": building(surfaces(BOX[1:2]))})
    with pytest.raises(ValueError, match=r"nothing in model\.city\.json has a height: .*Building without a height"):
        read_cityjson(path, crs="local")


@pytest.mark.parametrize(
    ("geometry", "told"),
    [
        (solid([[[0, 1, 99]]]), "vertex 99 is none of the 8, which are counted from 0"),
        (solid([[[0, 1, -1]]]), "vertex -1 is none of the 8"),
        (solid([[[0, 1, 2.0]]]), "vertex 2.0 is none"),
        (solid([[[0, 1, None]]]), "vertex None is none"),
        (solid([[[0, 1, True]]]), "vertex True is none"),
        (solid([[0, 1, 2]]), "a ring must be a list of vertices, got 0"),
        ({"type": "MultiSurface", "lod": 1, "boundaries": [BOX]}, "are lists nested as the type demands"),
        ({"type": "Solid", "boundaries": [BOX]}, r"KeyError\('lod'\)"),
        ({"type": "Solid", "lod": "1"}, r"KeyError\('boundaries'\)"),
        ({"type": "Solid", "lod": "high", "boundaries": [BOX]}, "could not convert"),
        (["Solid"], "TypeError"),
    ],
)
@pytest.mark.parametrize("kind", ["Building", "Bridge", "TINRelief"])
def test_malformed_objects_are_named(cityjson, geometry, told, kind):
    path = cityjson(box((0, 0, 0), (10, 10, 6)), {"A": building(solid(BOX)), "B": thing(kind, geometry)})
    with pytest.raises(ValueError, match=r"model\.city\.json: 'B' is malformed: .*" + told):
        read_cityjson(path)


def test_malformed_members_are_named(cityjson):
    objects = {"A": building(solid(BOX))}
    good = box((0, 0, 0), (10, 10, 6))
    for vertices in ([[0, 0, 0], [1, 1]], [[0, 0]], [["a", 0, 0]], [1, 2, 3], {"x": 1}, [[10**400, 0, 0]]):
        with pytest.raises(ValueError, match=r"model\.city\.json: 'vertices' is malformed"):
            read_cityjson(cityjson(vertices, objects))
    with pytest.raises(ValueError, match=r"is not valid JSON: NaN is not a number, at line 1, column \d+"):
        read_cityjson(cityjson([[0, 0, float("nan")]], objects))
    path = cityjson([[0, 0, 12345678], *good], objects)
    with pytest.raises(ValueError, match=r"'vertices' is malformed: .*infinite"):
        read_cityjson(write(path, path.read_text().replace("12345678", "1e999")))
    for transform in ([], {"scale": [1, 1, 1]}, {"scale": [1, 1], "translate": [0, 0]}, {"scale": 1, "translate": 1}):
        with pytest.raises(ValueError, match=r"'transform' is malformed"):
            read_cityjson(cityjson(good, objects, transform=transform))
    for metadata in ([1], "x"):
        with pytest.raises(ValueError, match=r"'metadata' is malformed"):
            read_cityjson(cityjson(good, objects, metadata=metadata))
    for templates in ([1], {"templates": [{}]}, {"templates": [solid(BOX)]}):
        with pytest.raises(ValueError, match=r"'geometry-templates' is malformed"):
            read_cityjson(cityjson(good, objects, **{"geometry-templates": templates}))
    for objects, key in (([1], "CityObjects"), ({"A": 1}, "A"), ({"A": {}}, "A"), ({"A": {"type": 3}}, "A")):
        with pytest.raises(ValueError, match=f"'{key}' is malformed"):
            read_cityjson(cityjson(good, objects))


def test_relatives_in_a_circle_end(read):
    objects = {"A": thing("BuildingPart", solid(BOX), parents=["B"]), "B": thing("BuildingPart", parents=["A"])}
    assert len(read(box((0, 0, 0), (10, 10, 6)), objects).buildings) == 1


def test_other_json_is_not_cityjson(geojson):
    with pytest.raises(ValueError, match="is not CityJSON: type must be 'CityJSON', got 'FeatureCollection'"):
        read_cityjson(geojson(feature(SQUARE, height=10)))


def everything():
    """A document with a bit of everything, for fuzzing."""
    vertices = [*two_houses(), *HILL]
    return {
        "type": "CityJSON", "version": "2.0", "metadata": dict(RD), "vertices": vertices,
        "transform": {"scale": [1, 1, 1], "translate": [84000, 447000, 0]},
        "geometry-templates": {"templates": [solid(BOX)], "vertices-templates": box((0, 0, 0), (5, 5, 5))},
        "CityObjects": {
            **houses(),
            "hill": thing("TINRelief", surfaces(SLOPES)),
            "part": thing("BuildingPart", solid(BOX), parents=["west"]),
            "bridge": thing("Bridge", surfaces(shifted(BOX[1:3], 8)), {"type": "MultiPoint", "lod": "1"}),
            "tree": thing("SolitaryVegetationObject", instance(EYE)),
        },
    }  # fmt: skip


def places_in(value, path=()):
    """Ways to all values within JSON."""
    yield path
    if isinstance(value, dict | list):
        for key in value if isinstance(value, dict) else range(len(value)):
            yield from places_in(value[key], (*path, key))


@pytest.mark.parametrize("seed", range(4))
def test_files_that_are_broken_anywhere_raise_value_errors_alone(tmp_path, seed):
    rng = np.random.default_rng(seed)
    rubbish = [None, True, -1, 0, 3.5, 1e300, 10**400, "", "x", [], {}, [[]], [0], {"type": "Solid"}]
    text = json.dumps(everything())
    places = list(places_in(everything()))
    path = tmp_path / "fuzz.city.json"
    for _ in range(40):
        document = json.loads(text)
        for _ in range(rng.integers(1, 3)):
            *way, last = places[rng.integers(1, len(places))] or ("type",)
            try:
                holder = document
                for key in way:
                    holder = holder[key]
                holder[last] = rubbish[rng.integers(len(rubbish))]
            except (IndexError, KeyError, TypeError):  # an earlier change took it away
                continue
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                assert isinstance(read_cityjson(write(path, document), cell=8.0), City)
            except ValueError:
                continue


@pytest.mark.parametrize("seed", range(2))
def test_texts_that_are_cut_or_scrambled_raise_value_errors_alone(tmp_path, seed):
    rng = np.random.default_rng(seed)
    text = json.dumps(everything())
    path = tmp_path / "fuzz.city.json"
    for _ in range(60):
        at, length = rng.integers(len(text)), rng.integers(1, 8)
        scrambled = text[:at] + "".join(rng.choice(list('{}[],:"0-e\x1e\x00'), length)) + text[at + length :]
        path.write_text(text[:at] if rng.random() < 0.2 else scrambled, encoding="utf-8")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                assert isinstance(read_cityjson(path, cell=8.0), City)
            except ValueError:
                continue


def test_a_house_above_its_ground_is_filled_down_to_it(read):
    under = Terrain.from_raster(np.full((4, 4), -3.0), (-100, -100, 400, 200))
    city = read(two_houses(), houses(), cell=1, terrain=under)
    assert [each.bounds[0, 2] for each in city.buildings] == [-3, -3]
    assert [solid_volume(each) for each in city.buildings] == pytest.approx([1200, 1200])
    assert not city.is_free([(5, 5, -1.5), (205, 5, -1.5)]).any()
    assert city.source.count("derived", "filled down from its foot") == 2
    assert city.source.doubts == ()


@pytest.mark.parametrize("roof", [GABLE, BOX])
def test_only_the_foot_of_a_house_is_lengthened(read, roof):
    gable = [*box((0, 0, 0), (10, 10, 6)), [5, 0, 9], [5, 10, 9]]
    whole = read(gable, {"h": building(solid(roof))}).buildings[0]
    longer = read(gable, {"h": building(solid(roof))}, terrain=-2.0).buildings[0]
    assert solid_volume(longer) == pytest.approx(solid_volume(whole) + 200)
    assert longer.bounds[1, 2] == whole.bounds[1, 2]


def test_a_bridge_above_its_ground_keeps_its_lower_surface(read):
    city = read(two_houses(), {**houses(), "east": thing("Bridge", solid(shifted(BOX, 8)))}, terrain=-5.0)
    assert city.is_free((205, 5, -2.5))
    assert not city.is_free((5, 5, -2.5))


def test_terrain_of_other_heights_than_the_file_is_a_doubt(read):
    with pytest.warns(UserWarning, match=r"2 × building more than 10 m above the ground, filled down .*\(west, east\)"):
        read(two_houses(40), houses(), cell=2, terrain=0.0)
    with pytest.warns(UserWarning, match=r"2 × building is wholly below the ground"):
        city = read(two_houses(), houses(), cell=2, terrain=50.0)
    assert len(city.buildings) == 2


def test_a_terrain_that_ends_at_a_house_is_refused(read):
    small = Terrain.from_raster(np.zeros((2, 2)), (-50, -50, 100, 100))
    with pytest.raises(ValueError, match="terrain says nothing about the ground under 'east'"):
        read(two_houses(), houses(), terrain=small)


def test_a_sequence_of_models_has_one_system(tmp_path):
    def model(name, code):
        system = {"referenceSystem": f"https://www.opengis.net/def/crs/EPSG/0/{code}"}
        vertices = box((392_000, 5_820_000, 0), (392_010, 5_820_010, 9))
        members = {"CityObjects": {name: building(solid(BOX))}, "vertices": vertices, "metadata": system}
        return {"type": "CityJSON", "version": "2.0", **members}

    assert len(read_cityjson(write(tmp_path / "a.jsonl", model("a", 25833), model("b", 25833))).buildings) == 2
    with pytest.raises(ValueError, match=r"a\.jsonl has coordinates in more than one reference system"):
        read_cityjson(write(tmp_path / "a.jsonl", model("a", 25833), model("b", 25832)))


def test_a_detail_in_a_high_level_does_not_replace_the_house(read):
    dormer = [[1, 1, 9], [2, 1, 9], [2, 2, 11]]
    whole = building(solid(BOX), {"type": "MultiSurface", "lod": "3", "boundaries": [[[8, 9, 10]]]})
    city = read([*box((0, 0, 0), (10, 10, 9)), *dormer], {"h": whole})
    assert city.buildings[0].bounds.tolist() == [[0, 0, 0], [10, 10, 11]]
    assert not city.is_free((5, 5, 8.5))


def test_a_roof_that_is_smaller_in_a_higher_level_is_taken_alone(read):
    boxes = [*box((0, 0, 0), (10, 10, 9)), *box((1, 1, 0), (9, 9, 7))]
    city = read(boxes, {"h": building(solid(BOX), solid(shifted(BOX, 8), "2.2"))})
    assert city.buildings[0].bounds.tolist() == [[0, 0, 0], [8, 8, 7]]
