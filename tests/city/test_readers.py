"""Readers against files with known content: volumes in closed form, projections by other formulas, every error."""

import json
import warnings

import numpy as np
import pytest

from uavlab.city import Building, City, read_city, read_cityjson, read_geojson, read_voxels
from uavlab.city.readers import east_north

SQUARE = [[1000, 2000], [1010, 2000], [1010, 2010], [1000, 2010], [1000, 2000]]  # 10 × 10 m
COURTYARD = [[1003, 2003], [1007, 2003], [1007, 2007], [1003, 2007], [1003, 2003]]  # 4 × 4 m
FAR = [[1040, 2040], [1050, 2040], [1050, 2050], [1040, 2050], [1040, 2040]]


def feature(*rings, kind="Polygon", **properties):
    return {"type": "Feature", "properties": properties, "geometry": {"type": kind, "coordinates": list(rings)}}


def write(path, *documents, encoding="utf-8"):
    """Documents as JSON, one per line; a text as it is."""
    lines = [document if isinstance(document, str) else json.dumps(document) for document in documents]
    path.write_text("\n".join(lines), encoding=encoding)
    return path


@pytest.fixture
def geojson(tmp_path):
    def collection(*features, **members):
        document = {"type": "FeatureCollection", "features": features, **members}
        return write(tmp_path / "town.geojson", document)

    return collection


def volume(city):
    return city.occupied.sum() * city.cell**3


def test_projected_metres_are_shifted_to_the_south_west_corner(geojson):
    city = read_geojson(geojson(feature(SQUARE, height=10), feature(FAR, height=20)), cell=0.5)
    assert np.allclose(city.buildings[0].bounds, [(0, 0, 0), (10, 10, 10)])
    assert np.allclose(city.buildings[1].bounds, [(40, 40, 0), (50, 50, 20)])
    assert np.allclose(city.bounds, [(-20, -20, 0), (70, 70, 40)])
    assert volume(city) == pytest.approx(1000 + 2000)
    assert city.reference is None
    assert city.name == "town"


def test_margin_is_free_space_around_and_above(geojson):
    city = read_geojson(geojson(feature(SQUARE, height=10)), margin=5)
    assert np.allclose(city.bounds, [(-5, -5, 0), (15, 15, 15)])


@pytest.mark.parametrize("ring", [SQUARE, SQUARE[:-1], SQUARE[::-1], [[*point, 7.0] for point in SQUARE]])
def test_rings_may_be_open_clockwise_or_have_altitudes(geojson, ring):
    assert volume(read_geojson(geojson(feature(ring, height=10)))) == pytest.approx(1000)


def test_courtyard_is_free(geojson):
    city = read_geojson(geojson(feature(SQUARE, COURTYARD, height=10)), cell=0.5)
    assert city.is_free([(5, 5, 5), (3.1, 6.9, 0.1)]).all()
    assert not city.is_free([(1, 5, 5), (9, 9, 9), (5, 2.6, 5)]).any()
    assert volume(city) == pytest.approx((100 - 16) * 10)


def test_multipolygon_is_one_building_with_all_its_parts(geojson):
    city = read_geojson(geojson(feature([SQUARE, COURTYARD], [FAR], kind="MultiPolygon", height=10)), cell=0.5)
    assert len(city.buildings) == 1
    assert volume(city) == pytest.approx((84 + 100) * 10)
    assert city.is_free((5, 5, 5))
    assert not city.is_free((45, 45, 5))


def test_geometry_collection_gives_its_polygons(geojson):
    polygons = [{"type": "Polygon", "coordinates": [ring]} for ring in (SQUARE, FAR)]
    geometry = {"type": "GeometryCollection", "geometries": [*polygons, {"type": "Point", "coordinates": [0, 0]}]}
    city = read_geojson(geojson({"type": "Feature", "properties": {"height": 10}, "geometry": geometry}))
    assert volume(city) == pytest.approx(2000)


@pytest.mark.parametrize("height", [12, 12.0, "12", "12.0", "12 m", "12m", " 12.0 m "])
def test_height_is_a_number_or_a_text(geojson, height):
    city = read_geojson(geojson(feature(SQUARE, height=height)))
    assert city.buildings[0].bounds[1, 2] == 12


def test_height_is_another_property_or_one_for_all(geojson):
    path = geojson(feature(SQUARE, roof=8), feature(FAR, roof=9))
    assert [b.bounds[1, 2] for b in read_geojson(path, height="roof").buildings] == [8, 9]
    assert [b.bounds[1, 2] for b in read_geojson(path, height=15).buildings] == [15, 15]


def test_base_makes_a_building_float_above_the_ground_of_the_map(geojson):
    path = geojson(feature(SQUARE, height=10, min_height="4 m", underside=6))
    city = read_geojson(path)
    assert city.bounds[0, 2] == 0
    assert city.is_free([(5, 5, 3.5), (5, 5, 10.5)]).all()
    assert not city.is_free([(5, 5, 4.5), (5, 5, 9.5)]).any()
    assert read_geojson(path, base="underside").buildings[0].bounds[0, 2] == 6
    assert read_geojson(path, base=2).buildings[0].bounds[0, 2] == 2
    assert read_geojson(path, base="absent").buildings[0].bounds[0, 2] == 0


def test_what_is_not_a_polygon_is_skipped(geojson):
    road = {
        "type": "Feature",
        "properties": {},
        "geometry": {"type": "LineString", "coordinates": [[0, 0], [9e3, 9e3]]},
    }
    nowhere = {"type": "Feature", "properties": None, "geometry": None}
    city = read_geojson(geojson(road, nowhere, feature(SQUARE, height=10)))
    assert len(city.buildings) == 1
    assert np.allclose(city.buildings[0].bounds[0], 0)


def test_single_feature_bare_geometry_and_lines_of_features(tmp_path):
    lone = write(tmp_path / "feature.json", feature(SQUARE, height=10))
    bare = write(tmp_path / "bare.json", feature(SQUARE)["geometry"])
    lines = write(tmp_path / "lines.jsonl", feature(SQUARE, height=10), "", feature(FAR, height=10))
    assert volume(read_geojson(lone)) == pytest.approx(1000)
    assert volume(read_geojson(bare, height=10)) == pytest.approx(1000)
    assert volume(read_geojson(lines)) == pytest.approx(2000)


def test_buildings_have_the_name_the_id_or_the_number_of_their_feature(geojson):
    features = [feature(SQUARE, height=9, name="Old Church"), feature(SQUARE, height=9), feature(SQUARE, height=9)]
    features[0]["id"], features[1]["id"] = "way/1", "way/2"
    names = [building.name for building in read_geojson(geojson(*features)).buildings]
    assert names == ["Old Church", "feature way/2", "feature 2 (counted from 0)"]


def test_byte_order_mark_is_tolerated(tmp_path):
    path = write(tmp_path / "bom.geojson", feature(SQUARE, height=10, name="Straße"), encoding="utf-8-sig")
    assert read_city(path).buildings[0].name == "Straße"


def radii_of_curvature(lat):
    """Of the meridian and of the prime vertical on WGS84 [m]."""
    a, e2 = 6378137.0, 0.00669437999014
    w = 1 - e2 * np.sin(np.radians(lat)) ** 2
    return a * (1 - e2) / w**1.5, a / np.sqrt(w)


@pytest.mark.parametrize("lat", [-60.0, 0.0, 35.0, 52.0])
def test_an_arc_second_is_as_long_as_the_radii_of_curvature_say(lat):
    second = np.radians(1 / 3600)
    meridian, normal = radii_of_curvature(lat + 0.5 / 3600)
    assert np.allclose(east_north((4.0, lat + 1 / 3600), (4.0, lat)), (0, meridian * second), atol=1e-6)
    east = east_north((4.0 + 1 / 3600, lat), (4.0, lat))
    assert east[0] == pytest.approx(radii_of_curvature(lat)[1] * np.cos(np.radians(lat)) * second, abs=1e-6)
    assert normal == pytest.approx(radii_of_curvature(lat)[1], rel=1e-6)


def test_distances_agree_with_haversine():
    rng = np.random.default_rng(3)
    for lat in (-52.0, 35.0, 52.0):
        points = np.array([4.36, lat]) + rng.uniform(-0.05, 0.05, (50, 2))
        local = east_north(points, (4.36, lat))
        lon, phi = np.radians(points).T
        for i, j in zip(range(49), range(1, 50), strict=True):
            h = np.sin((phi[i] - phi[j]) / 2) ** 2
            h += np.cos(phi[i]) * np.cos(phi[j]) * np.sin((lon[i] - lon[j]) / 2) ** 2
            assert np.linalg.norm(local[i] - local[j]) == pytest.approx(2 * 6371e3 * np.arcsin(np.sqrt(h)), rel=0.005)


def degrees(metres_ring, lon=4.36, lat=52.01):
    """A ring in metres near (1000, 2000) as longitude and latitude, by the radii of curvature."""
    meridian, normal = radii_of_curvature(lat)
    x, y = np.transpose(metres_ring).astype(float)
    lons = lon + np.degrees((x - 1000) / (normal * np.cos(np.radians(lat))))
    return np.column_stack([lons, lat + np.degrees((y - 2000) / meridian)]).tolist()


def test_degrees_become_metres_from_the_south_west_corner(geojson):
    city = read_geojson(geojson(feature(degrees(SQUARE), height=10), feature(degrees(FAR), height=20)), cell=0.5)
    assert city.reference == (4.36, 52.01)
    assert np.allclose(city.buildings[0].bounds, [(0, 0, 0), (10, 10, 10)], atol=1e-3)
    assert np.allclose(city.buildings[1].bounds, [(40, 40, 0), (50, 50, 20)], atol=2e-3)
    assert volume(city) == pytest.approx(3000, rel=0.05)


def test_town_on_both_sides_of_the_date_line_stays_together(geojson):
    west = [(-180 + abs(lon), lat) for lon, lat in degrees(SQUARE, lon=0.001, lat=-17)]
    east = [(180 - abs(lon), lat) for lon, lat in degrees(SQUARE, lon=0.001, lat=-17)]
    city = read_geojson(geojson(feature(east, height=10), feature(west, height=10)), cell=2)
    assert city.bounds[1, 0] - city.bounds[0, 0] < 300


@pytest.mark.parametrize("name", ["EPSG:28992", "urn:ogc:def:crs:EPSG::28992"])
def test_projected_crs_says_metres_even_for_small_numbers(geojson, name):
    crs = {"type": "name", "properties": {"name": name}}
    city = read_geojson(geojson(feature([[5, 5], [15, 5], [15, 15], [5, 15]], height=10), crs=crs))
    assert volume(city) == pytest.approx(1000)
    assert city.reference is None


@pytest.mark.parametrize("name", ["urn:ogc:def:crs:OGC:1.3:CRS84", "EPSG:4326", "urn:ogc:def:crs:EPSG::4258"])
def test_geographic_crs_says_degrees(geojson, name):
    crs = {"type": "name", "properties": {"name": name}}
    assert read_geojson(geojson(feature(degrees(SQUARE), height=10), crs=crs)).reference == (4.36, 52.01)


def test_units_can_be_given(geojson):
    small = geojson(feature([[5, 5], [15, 5], [15, 15], [5, 15]], height=10))
    assert volume(read_geojson(small, units="metres")) == pytest.approx(1000)
    # EPSG:7844, GDA2020: longitude and latitude, but the code doesn't tell
    path = geojson(feature(degrees(SQUARE), height=10), crs={"properties": {"name": "EPSG:7844"}})
    assert read_geojson(path, units="degrees").reference == (4.36, 52.01)
    with pytest.raises(ValueError, match=r"no city: coordinates were read as metres.*pass units='degrees'"):
        read_geojson(path)


def test_metres_mistaken_for_degrees_are_noticed(geojson):
    path = geojson(feature([[0, 0], [80, 0], [80, 60], [0, 60]], height=10))
    with pytest.raises(ValueError, match=r"read as degrees; if they are metres, pass units='metres'"):
        read_geojson(path)


def test_degrees_out_of_range_are_refused(geojson):
    with pytest.raises(ValueError, match=r"within ±180.*reach from \(1000, 2000\) to \(1010, 2010\).*units='metres'"):
        read_geojson(geojson(feature(SQUARE, height=10)), units="degrees")


def test_unknown_units_are_refused(geojson):
    with pytest.raises(ValueError, match="units must be 'auto', 'degrees' or 'metres', got 'feet'"):
        read_geojson(geojson(feature(SQUARE, height=10)), units="feet")


def test_web_mercator_is_refused_because_its_metres_are_too_long(geojson):
    crs = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::3857"}}
    with pytest.raises(ValueError, match=r"Web Mercator.*convert the file to longitude and latitude"):
        read_geojson(geojson(feature(SQUARE, height=10), crs=crs))


def test_missing_heights_are_counted_and_named(geojson):
    features = [feature(SQUARE, height=10), feature(SQUARE, levels=2), feature(SQUARE, height="tall")]
    features[1]["id"] = "way/7"
    with pytest.raises(ValueError, match="2 of 3 features with polygons have no usable height") as error:
        read_geojson(geojson(*features, {"type": "Feature", "geometry": None}))
    message = str(error.value)
    assert "the first is 'feature way/7' with height None" in message
    assert "Properties in the file: height, levels." in message
    assert "Pass height='one of them' or a number for all" in message


@pytest.mark.parametrize(
    ("properties", "told"),
    [
        ({"height": 0}, r"with height 0 and base None"),
        ({"height": True}, r"with height True"),
        ({"height": "nan"}, r"with height 'nan'"),
        ({"height": "inf m"}, r"with height 'inf m'"),
        ({"height": 5, "min_height": 5}, r"with height 5 and base 5"),
        ({"height": 5, "min_height": -1}, r"with height 5 and base -1"),
        ({"height": 5, "min_height": "low"}, r"with height 5 and base 'low'"),
    ],
)
def test_height_must_be_above_the_base_and_the_base_not_below_the_ground(geojson, properties, told):
    with pytest.raises(ValueError, match=r"1 of 1 features .* the first is 'feature 0 \(counted from 0\)' " + told):
        read_geojson(geojson(feature(SQUARE, **properties)))


def test_height_for_all_must_be_positive(geojson):
    with pytest.raises(ValueError, match=r"no usable height.*with height=-3"):
        read_geojson(geojson(feature(SQUARE)), height=-3)


def test_self_crossing_outline_is_named_with_the_place_in_the_file(geojson):
    bow = feature([[4.0, 52.0], [4.002, 52.002], [4.002, 52.0], [4.0, 52.002]], height=5)
    with pytest.raises(
        ValueError, match=r"'feature 1 \(counted from 0\)' is not a simple.*Self-intersection\[4\.001 52"
    ):
        read_geojson(geojson(feature(degrees(SQUARE), height=5), bow))


def test_outline_of_two_corners_is_refused(geojson):
    with pytest.raises(ValueError, match=r"'feature 0 .*' needs at least three different corners"):
        read_geojson(geojson(feature([[0, 0], [1, 1], [0, 0]], height=5)))


@pytest.mark.parametrize("rings", [[[[0], [1], [2]]], [[5, 6, 7]], 3, [[["a", "b"], [1, 2], [3, 4]]]])
def test_malformed_coordinates_are_named(geojson, rings):
    geometry = {"type": "Polygon", "coordinates": rings}
    with pytest.raises(ValueError, match=r"geometry of 'feature 0 \(counted from 0\)' is malformed"):
        read_geojson(geojson({"type": "Feature", "properties": {"height": 5}, "geometry": geometry}))


def test_file_without_polygons_says_what_it_has(geojson):
    point = {"type": "Feature", "properties": {}, "geometry": {"type": "Point", "coordinates": [1, 2]}}
    with pytest.raises(ValueError, match=r"town\.geojson has no polygon; its features are 2 Point, 1 None"):
        read_geojson(geojson(point, point, {"type": "Feature", "geometry": None}))
    with pytest.raises(ValueError, match="its features are none at all"):
        read_geojson(geojson())


@pytest.mark.parametrize("document", [{"type": "CityJSON"}, {"type": "FeatureCollection", "features": 3}, {}])
def test_other_json_is_not_geojson(tmp_path, document):
    with pytest.raises(ValueError, match="is not GeoJSON: expected a FeatureCollection with a list of features"):
        read_geojson(write(tmp_path / "other.json", document))


def test_too_many_voxels_name_the_cell(geojson):
    with pytest.raises(ValueError, match=r"cell=0\.01 m gives .* use a cell of at least"):
        read_geojson(geojson(feature(SQUARE, height=10)), cell=0.01)


BOX_CORNERS = [(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
BOX = [[[0, 3, 2, 1]], [[4, 5, 6, 7]], [[0, 1, 5, 4]], [[1, 2, 6, 5]], [[2, 3, 7, 6]], [[3, 0, 4, 7]]]
TRIANGULATED_BOX = [[[ring[0], ring[i], ring[i + 1]]] for (ring,) in BOX for i in (1, 2)]
GABLE = [[[0, 3, 2, 1]], [[0, 1, 5, 8, 4]], [[2, 3, 7, 9, 6]], [[1, 2, 6, 5]], [[3, 0, 4, 7]]]
GABLE += [[[4, 8, 9, 7]], [[5, 6, 9, 8]]]  # the ridge, 8 to 9, runs along y


def box(low, high):
    return [[low[a] + (high[a] - low[a]) * corner[a] for a in range(3)] for corner in BOX_CORNERS]


def shifted(surfaces, by):
    return [[[index + by for index in ring] for ring in rings] for rings in surfaces]


def solid(surfaces, lod="1"):
    return {"type": "Solid", "lod": lod, "boundaries": [surfaces]}


def building(*geometry, **members):
    return {"type": "Building", "geometry": list(geometry), **members}


@pytest.fixture
def cityjson(tmp_path):
    def model(vertices, objects, **members):
        document = {"type": "CityJSON", "version": "2.0", "CityObjects": objects, "vertices": vertices, **members}
        return write(tmp_path / "model.city.json", document)

    return model


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


def test_voxel_map_round_trip(tmp_path):
    occupied = np.random.default_rng(7).random((12, 7, 9)) < 0.3
    voxels = [f"{i} {j} {k}" for i, j, k in np.argwhere(occupied)]
    city = read_voxels(write(tmp_path / "map.3dmap", "voxel 12 7 9", *voxels, ""), cell=2.5)
    assert np.array_equal(city.occupied, occupied)
    assert (city.cell, city.name, city.buildings) == (2.5, "map", ())
    assert np.array_equal(city.bounds, [(0, 0, 0), (30, 17.5, 22.5)])


@pytest.mark.parametrize("text", ["voxel 2 2 2\n", "voxel 2 2 2", "voxel 2 2 2\n\n  \n"])
def test_voxel_map_may_be_empty(tmp_path, text):
    assert not read_voxels(write(tmp_path / "map.3dmap", text)).occupied.any()


def test_voxel_map_with_one_voxel_blank_lines_tabs_and_carriage_returns(tmp_path):
    city = read_voxels(write(tmp_path / "map.3dmap", "voxel 3 4 5\r\n\r\n2\t3 4\r\n\r\n"))
    assert np.argwhere(city.occupied).tolist() == [[2, 3, 4]]


@pytest.mark.parametrize("header", ["", "voxel 3 4", "voxel 3 4 5 6", "octile 3 4 5", "voxel a b c", "voxel -3 4 5"])
def test_bad_header_is_named(tmp_path, header):
    with pytest.raises(ValueError, match=r"map\.3dmap, line 1: expected 'voxel W H D' with three whole numbers, got"):
        read_voxels(write(tmp_path / "map.3dmap", header, "0 0 0"))


@pytest.mark.parametrize("header", ["voxel 0 4 5", "voxel 10000 10000 10000"])
def test_map_without_voxels_or_with_too_many_is_refused(tmp_path, header):
    with pytest.raises(ValueError, match=rf"line 1: a map must have from 1 to 500,000,000 voxels, got '{header}'"):
        read_voxels(write(tmp_path / "map.3dmap", header))


@pytest.mark.parametrize(
    ("lines", "told"),
    [
        (["0 0 0", "1 2"], r"line 3: expected three whole numbers 'x y z', got '1 2'"),
        (["0 0", "1 2"], r"line 2: expected three whole numbers 'x y z', got '0 0'"),
        (["0 0 0", "", "1 2 0 1"], r"line 4: expected three whole numbers 'x y z', got '1 2 0 1'"),
        (["0 0 0", "1 2.5 0"], r"line 3: expected .* got '1 2.5 0'"),
        (["0 0 0", "1 x 0", "7 7 7"], r"line 3: expected .* got '1 x 0'"),
        (["0 0 0", "1 4 0"], r"line 3: voxel '1 4 0' lies outside of the map: x 0 to 2, y 0 to 3, z 0 to 4"),
        (["", "0 -1 0"], r"line 3: voxel '0 -1 0' lies outside of the map: x 0 to 2, y 0 to 3, z 0 to 4"),
        (["0 0 99999999999999999999"], r"line 2: voxel .* lies outside"),
    ],
)
def test_wrong_lines_are_numbered(tmp_path, lines, told):
    with pytest.raises(ValueError, match=r"map\.3dmap, " + told):
        read_voxels(write(tmp_path / "map.3dmap", "voxel 3 4 5", *lines))


def test_format_is_found_by_content(tmp_path):
    collection = {"type": "FeatureCollection", "features": [feature(SQUARE, height=10)]}
    model = {"type": "CityJSON", "CityObjects": {"A": building(solid(BOX))}, "vertices": box((0, 0, 0), (10, 10, 10))}
    for name in ("a.geojson", "a.json", "a.txt", "a"):
        assert volume(read_city(write(tmp_path / name, collection))) == pytest.approx(1000)
    for name in ("b.city.json", "b.json", "b.txt", "b"):
        assert volume(read_city(write(tmp_path / name, model))) == pytest.approx(1000)
    for name in ("c.3dmap", "c.txt"):
        assert read_city(write(tmp_path / name, "voxel 2 2 2", "0 0 0")).occupied.sum() == 1


def test_options_are_passed_on(tmp_path):
    path = write(tmp_path / "a.json", feature(SQUARE))
    city = read_city(str(path), height=30, cell=2, margin=4)
    assert (city.cell, city.bounds[1, 2]) == (2, 34)


@pytest.mark.parametrize(
    ("name", "text"), [("a.obj", "v 0 0 0"), ("a.json", '{"type": "Topology"}'), ("a.json", "{}"), ("a", "")]
)
def test_unknown_formats_are_refused_with_those_that_are_known(tmp_path, name, text):
    with pytest.raises(
        ValueError, match=r"is not a city that can be read\. Known are GeoJSON .* CityJSON .* \(\.3dmap\)"
    ):
        read_city(write(tmp_path / name, text))


@pytest.mark.parametrize("reader", [read_city, read_geojson, read_cityjson, read_voxels])
def test_missing_file_is_missing(tmp_path, reader):
    with pytest.raises(FileNotFoundError):
        reader(tmp_path / "nowhere.json")


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ('{"type":\n  "FeatureCollection",\n  oops}', r"Expecting property name .* at line 3, column 3"),
        ('{"type": "Feature"', r"at line 1, column 19"),
        ('{"type": "Feature"}\n{"type": ', r"at line 2, column"),
        ("", r"at line 1, column 1"),
    ],
)
def test_broken_json_names_the_place(tmp_path, text, told):
    with pytest.raises(ValueError, match=r"broken\.json is not valid JSON: .*" + told):
        read_city(write(tmp_path / "broken.json", text))


def test_other_encodings_and_other_json_are_refused(tmp_path):
    path = write(tmp_path / "a.json", '{"name": "Straße"}', encoding="latin-1")
    with pytest.raises(ValueError, match=r"a\.json is not UTF-8 text: .* at byte 14"):
        read_city(path)
    with pytest.raises(ValueError, match=r"a\.json must hold a JSON object \{\.\.\.\}, got a list"):
        read_city(write(tmp_path / "a.json", "[1, 2]"))


def test_city_that_was_written_by_hand_is_read_back(geojson):
    """Buildings → GeoJSON in metres → the same voxels."""
    ell = [(0, 0), (30, 0), (30, 10), (10, 10), (10, 30), (0, 30)]
    tower = [(20, 20), (28, 20), (28, 28), (20, 28)]
    known = City.from_buildings([Building.prism(ell, 12), Building.prism(tower, 30, bottom=8)], cell=0.5)
    path = geojson(feature(ell, height=12), feature(tower, height=30, min_height=8))
    assert np.array_equal(read_geojson(path, cell=0.5, units="metres").occupied, known.occupied)
