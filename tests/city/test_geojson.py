"""GeoJSON with known content: volumes in closed form, projections by other formulas, every error."""

import numpy as np
import pytest
from files import COURTYARD, FAR, SQUARE, feature, volume, write
from hypothesis import given
from hypothesis import strategies as st

from uavlab.city import Building, City, read_city, read_geojson
from uavlab.city.geojson import east_north, longitude_latitude


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


references = st.tuples(st.floats(-180, 180), st.floats(-90, 90))
within_100_km = st.tuples(st.floats(0, 100e3), st.floats(0, 2 * np.pi)).map(
    lambda polar: (polar[0] * np.cos(polar[1]), polar[0] * np.sin(polar[1]))
)


@given(st.lists(within_100_km, min_size=1, max_size=4), references)
def test_longitude_and_latitude_are_the_inverse_of_east_and_north(points, reference):
    lonlat = longitude_latitude(points, reference)
    assert lonlat.shape == (len(points), 2)
    assert (np.abs(lonlat[:, 1]) <= 90).all()
    assert east_north(lonlat, reference) == pytest.approx(np.array(points), abs=1e-6)


@given(st.tuples(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5)), st.floats(-180, 180), st.floats(-80, 80))
def test_east_and_north_are_the_inverse_of_longitude_and_latitude(away, lon, lat):
    lonlat = np.add((lon, lat), away)
    assert longitude_latitude(east_north(lonlat, (lon, lat)), (lon, lat)) == pytest.approx(lonlat, abs=1e-11)


def test_longitudes_go_on_past_the_date_line_and_grids_keep_their_shape():
    lonlat = longitude_latitude(np.full((2, 3, 2), (5000.0, 0.0)), (179.99, -17))
    assert lonlat.shape == (2, 3, 2)
    assert lonlat[0, 0, 0] == pytest.approx(180.037, abs=1e-3)
    assert longitude_latitude((-5000, 0), (-179.99, -17))[0] == pytest.approx(-180.037, abs=1e-3)
    assert longitude_latitude((0, 0), (4.36, 52.01)) == pytest.approx((4.36, 52.01), abs=1e-12)


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


def test_city_that_was_written_by_hand_is_read_back(geojson):
    """Buildings → GeoJSON in metres → the same voxels."""
    ell = [(0, 0), (30, 0), (30, 10), (10, 10), (10, 30), (0, 30)]
    tower = [(20, 20), (28, 20), (28, 28), (20, 28)]
    known = City.from_buildings([Building.prism(ell, 12), Building.prism(tower, 30, bottom=8)], cell=0.5)
    path = geojson(feature(ell, height=12), feature(tower, height=30, min_height=8))
    assert np.array_equal(read_geojson(path, cell=0.5, units="metres").occupied, known.occupied)
