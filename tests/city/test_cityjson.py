"""CityJSON with known content: volumes in closed form, each kind of geometry, every error."""

import warnings

import numpy as np
import pytest
from files import BOX, GABLE, SQUARE, TRIANGULATED_BOX, box, building, feature, shifted, solid, volume, write

from uavlab.city import City, read_city, read_cityjson


def test_lod1_solid_is_a_box_of_one_piece(cityjson):
    path = cityjson(box((84000, 447000, 2), (84010, 447020, 8)), {"A": building(solid(BOX))})
    city = read_cityjson(path, cell=0.5)
    assert np.allclose(city.buildings[0].bounds, [(0, 0, 0), (10, 20, 6)])
    assert volume(city) == pytest.approx(1200)
    assert len(city.buildings[0].pieces) == 1
    assert (city.name, city.buildings[0].name, city.reference) == ("model", "A", None)
    assert np.allclose(city.bounds, [(-20, -20, 0), (30, 40, 26)])


def test_transform_is_applied(cityjson):
    vertices = [[1000 * v for v in corner] for corner in box((0, 0, 0), (10, 20, 6))]
    transform = {"scale": [0.001, 0.001, 0.002], "translate": [84000.5, 447000.0, -3.0]}
    city = read_cityjson(cityjson(vertices, {"A": building(solid(BOX))}, transform=transform), margin=7)
    assert np.allclose(city.buildings[0].bounds, [(0, 0, 0), (10, 20, 12)])
    assert np.allclose(city.bounds, [(-7, -7, 0), (17, 27, 19)])


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
def test_every_kind_of_geometry_gives_the_same_box(cityjson, geometry):
    ground = {"type": "MultiSurface", "lod": 1, "boundaries": shifted(BOX, 8)}
    vertices = box((5, 5, 0), (15, 15, 8)) + box((30, 5, 0), (31, 6, 1))
    city = read_cityjson(cityjson(vertices, {"A": building(geometry), "B": building(ground)}), cell=0.5)
    assert volume(City.from_buildings(city.buildings[:1], cell=0.5)) == pytest.approx(800)
    assert len(city.buildings[0].pieces) == 1


@pytest.mark.parametrize(
    "roof", [[[[4, 8, 9, 7]], [[5, 6, 9, 8]]], [[[4, 8, 9]], [[4, 9, 7]], [[5, 6, 9]], [[5, 9, 8]]]]
)
def test_gable_roof_has_the_volume_of_its_closed_form(cityjson, roof):
    vertices = [*box((0, 0, 0), (10, 20, 6)), [5, 0, 11], [5, 20, 11]]
    city = read_cityjson(cityjson(vertices, {"A": building(solid(GABLE[:-2] + roof, "2"))}), cell=0.25)
    assert sum(hull.volume for hull in city.buildings[0].hulls) == pytest.approx(10 * 20 * (6 + 5 / 2))
    assert volume(city) == pytest.approx(10 * 20 * (6 + 5 / 2), rel=0.25 / 8.5)
    assert not city.is_free([(5, 10, 10.6), (1, 10, 6.6), (9, 1, 6.6)]).any()
    assert city.is_free([(1, 10, 7.5), (9, 10, 7.5), (5, 10, 11.4)]).all()


def test_roof_that_is_not_plane_goes_through_all_its_corners(cityjson):
    vertices = [*box((0, 0, 0), (10, 10, 6))[:4], [0, 0, 6], [10, 0, 9], [10, 10, 6], [0, 10, 9]]
    city = read_cityjson(cityjson(vertices, {"A": building(solid(BOX, "2"))}))
    inside = np.array(vertices) * (0.999, 0.999, 0.999) + (0.005, 0.005, 0)
    assert city.buildings[0].contains(inside).all()
    volumes = sum(hull.volume for hull in city.buildings[0].hulls)
    assert volumes in (pytest.approx(700), pytest.approx(800))  # whichever diagonal it is folded along


def test_roof_with_a_step_takes_the_higher_corner(cityjson):
    vertices = [[0, 0, 6], [10, 0, 6], [10, 0, 9], [10, 10, 9], [0, 10, 6], *box((0, 0, 0), (10, 10, 6))]
    roof = {"type": "MultiSurface", "lod": 2, "boundaries": [*shifted(BOX[:1], 5), [[0, 1, 2, 3, 4]]]}
    city = read_cityjson(cityjson(vertices, {"A": building(roof)}))
    assert city.buildings[0].contains((9.99, 0.01, 8.9))


def test_flat_roof_over_a_sloped_floor_stays(cityjson):
    vertices = [[x, y, 3 if x == 10 and z == 0 else z] for x, y, z in box((0, 0, 0), (10, 10, 8))]
    city = read_cityjson(cityjson(vertices, {"A": building(solid(BOX))}))
    assert volume(city) == pytest.approx(800)


def test_house_on_a_hill_is_filled_down_to_the_lowest_ground(cityjson):
    vertices = box((0, 0, 10), (10, 10, 16)) + box((30, 0, 12), (40, 10, 18))
    city = read_cityjson(cityjson(vertices, {"A": building(solid(BOX)), "B": building(solid(shifted(BOX, 8)))}))
    assert np.allclose([b.bounds[:, 2] for b in city.buildings], [(0, 6), (0, 8)])
    assert not city.is_free((35, 5, 0.5))
    assert [len(b.pieces) for b in city.buildings] == [1, 1]  # the floor lies under the roof


def test_passage_under_a_building_is_filled_and_low_roofs_beside_it_stay(cityjson):
    vertices = box((0, 0, 0), (10, 10, 3)) + box((10, 0, 4), (20, 10, 9))  # the second one hangs
    city = read_cityjson(cityjson(vertices, {"A": building(solid(BOX + shifted(BOX, 8)))}))
    assert volume(city) == pytest.approx(10 * 10 * 3 + 10 * 10 * 9)


def test_hole_in_a_surface_is_a_courtyard(cityjson):
    vertices = box((0, 0, 0), (10, 10, 5)) + box((3, 3, 0), (7, 7, 5))
    surfaces = [[[0, 3, 2, 1], [8, 9, 10, 11]], [[4, 5, 6, 7], [12, 15, 14, 13]], *BOX[2:], *shifted(BOX[2:], 8)]
    city = read_cityjson(cityjson(vertices, {"A": building(solid(surfaces))}), cell=0.5)
    assert city.is_free([(5, 5, 1), (3.2, 6.7, 4)]).all()
    assert not city.is_free((1.5, 5, 4.6))
    assert volume(city) == pytest.approx((100 - 16) * 5)


def test_highest_level_of_detail_is_taken(cityjson):
    vertices = [*box((0, 0, 0), (10, 20, 6)), [5, 0, 11], [5, 20, 11], *box((0, 0, 0), (10, 20, 11))]
    levels = [solid(shifted(BOX, 10), 1), solid(GABLE, "2.2"), solid(shifted(BOX, 10), "1.3")]
    city = read_cityjson(cityjson(vertices, {"A": building(*levels)}))
    assert sum(hull.volume for hull in city.buildings[0].hulls) == pytest.approx(10 * 20 * (6 + 5 / 2))


def test_parts_belong_to_their_building(cityjson):
    vertices = box((0, 0, 0), (10, 10, 6)) + box((10, 0, 0), (20, 10, 9))
    footprint = {"type": "MultiSurface", "lod": "0", "boundaries": shifted(BOX[1:2], 8)}
    objects = {
        "A": building(footprint, children=["A-1", "A-2"]),
        "A-1": {"type": "BuildingPart", "parents": ["A"], "geometry": [solid(BOX)]},
        "A-2": {"type": "BuildingPart", "parents": ["A"], "geometry": [solid(shifted(BOX, 8))]},
    }
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        city = read_cityjson(cityjson(vertices, objects))
    assert [b.name for b in city.buildings] == ["A"]
    assert len(city.buildings[0].pieces) == 2
    assert volume(city) == pytest.approx(600 + 900)


def test_walls_and_degenerate_surfaces_are_nothing(cityjson):
    vertices = [*box((0, 0, 0), (10, 10, 6)), [0, 0, 3], [50, 50, 50]]
    rubbish = [[[0, 1, 5, 4]], [[0, 4, 8]], [[4, 4, 4]], [[4, 6]], [[0, 1, 0, 1]], [[]]]
    city = read_cityjson(cityjson(vertices, {"A": building(solid(BOX + rubbish))}))
    assert volume(city) == pytest.approx(600)
    assert len(city.buildings[0].pieces) == 1


def test_roof_that_crosses_itself_still_stands(cityjson):
    vertices = box((0, 0, 0), (10, 10, 6))
    city = read_cityjson(cityjson(vertices, {"A": building(solid([*BOX[:1], [[4, 6, 5, 7]], *BOX[2:]]))}), cell=0.25)
    assert volume(city) == pytest.approx(300, rel=0.05)  # a bow tie covers half of the square
    assert not city.is_free([(1, 5, 5), (9, 5, 5)]).any()
    assert city.is_free([(5, 1, 5), (5, 9, 5)]).all()


def test_sequence_of_features_has_vertices_per_line(tmp_path):
    transform = {"scale": [0.5, 0.5, 0.5], "translate": [100, 100, 0]}
    header = {"type": "CityJSON", "version": "2.0", "CityObjects": {}, "vertices": [], "transform": transform}
    lines = [
        {"type": "CityJSONFeature", "id": key, "CityObjects": {key: building(solid(BOX))}, "vertices": vertices}
        for key, vertices in [("A", box((0, 0, 0), (20, 20, 10))), ("B", box((60, 0, 0), (80, 20, 30)))]
    ]
    for path in (tmp_path / "town.city.jsonl", tmp_path / "town.jsonl"):
        city = read_city(write(path, header, *lines))
        assert [b.name for b in city.buildings] == ["A", "B"]
        assert np.allclose(city.buildings[1].bounds, [(30, 0, 0), (40, 10, 15)])
        assert volume(city) == pytest.approx(500 + 1500)


def test_buildings_without_height_are_left_out_with_a_warning(cityjson):
    vertices = box((0, 0, 0), (10, 10, 6))
    footprint = {"type": "MultiSurface", "lod": "0", "boundaries": BOX[1:2]}
    path = cityjson(vertices, {"A": building(solid(BOX)), "B": building(footprint), "C": building()})
    with pytest.warns(UserWarning, match=r"2 of 3 buildings in model\.city\.json have no surface .* the first is 'B'"):
        city = read_cityjson(path)
    assert [b.name for b in city.buildings] == ["A"]


@pytest.mark.parametrize(
    "geometry",
    [[], [{"type": "MultiSurface", "lod": "0", "boundaries": BOX[1:2]}], [{"type": "MultiPoint", "lod": 1}]],
)
def test_only_buildings_without_height_are_refused(cityjson, geometry):
    path = cityjson(box((0, 0, 0), (10, 10, 6)), {"B": building(*geometry)})
    with pytest.raises(ValueError, match=r"1 of 1 buildings in model\.city\.json have no surface above the ground"):
        read_cityjson(path)


def test_file_without_buildings_says_what_it_has(cityjson):
    objects = {"1": {"type": "Road"}, "2": {"type": "Road"}, "3": {"type": "WaterBody"}}
    with pytest.raises(ValueError, match="no Building or BuildingPart; its objects are 2 Road, 1 WaterBody"):
        read_cityjson(cityjson([], objects))


def test_cityjson_in_degrees_is_refused(cityjson):
    path = cityjson(box((4.3600, 52.0100, 0), (4.3603, 52.0102, 6)), {"A": building(solid(BOX))})
    with pytest.raises(ValueError, match="which is no city: convert the file to a reference system in metres"):
        read_cityjson(path)


@pytest.mark.parametrize(
    ("geometry", "told"),
    [
        (solid([[[0, 1, 99]]]), "IndexError"),
        (solid([[0, 1, 2]]), "TypeError"),
        ({"type": "MultiSurface", "lod": 1, "boundaries": [BOX]}, "ValueError"),
        ({"type": "Solid", "boundaries": [BOX]}, r"KeyError\('lod'\)"),
        ({"type": "Solid", "lod": "1"}, r"KeyError\('boundaries'\)"),
    ],
)
def test_malformed_objects_are_named(cityjson, geometry, told):
    path = cityjson(box((0, 0, 0), (10, 10, 6)), {"A": building(solid(BOX)), "B": building(geometry)})
    with pytest.raises(ValueError, match=r"model\.city\.json: 'B' is malformed: " + told):
        read_cityjson(path)


def test_malformed_vertices_are_named(cityjson):
    with pytest.raises(ValueError, match=r"model\.city\.json: 'vertices' is malformed"):
        read_cityjson(cityjson([[0, 0, 0], [1, 1]], {"A": building(solid(BOX))}))
    with pytest.raises(ValueError, match=r"'vertices' is malformed: .*NaN or infinite"):
        read_cityjson(cityjson([[0, 0, float("nan")]], {"A": building(solid(BOX))}))


def test_other_json_is_not_cityjson(geojson):
    with pytest.raises(ValueError, match="is not CityJSON: type must be 'CityJSON', got 'FeatureCollection'"):
        read_cityjson(geojson(feature(SQUARE, height=10)))
