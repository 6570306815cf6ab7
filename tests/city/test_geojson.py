"""GeoJSON with known content: volumes in closed form, heights as people write them, places on Earth, every error."""

import warnings

import numpy as np
import pytest
from files import COURTYARD, FAR, SQUARE, feature, volume, write

from uavlab.city import Building, City, Terrain, read_city, read_geojson

pytestmark = pytest.mark.filterwarnings("ignore:.*coordinates in metres, of an unknown place:UserWarning")


def test_projected_metres_are_shifted_to_the_south_west_corner(geojson):
    city = read_geojson(geojson(feature(SQUARE, height=10), feature(FAR, height=20)), cell=0.5)
    assert np.allclose(city.buildings[0].bounds, [(0, 0, 0), (10, 10, 10)])
    assert np.allclose(city.buildings[1].bounds, [(40, 40, 0), (50, 50, 20)])
    assert np.allclose(city.bounds, [(-20, -20, -0.5), (70, 70, 40)])
    assert volume(city) == pytest.approx(1000 + 2000)
    assert city.reference is None
    assert city.name == "town"


def test_margin_is_free_space_around_and_above(geojson):
    city = read_geojson(geojson(feature(SQUARE, height=10)), margin=5)
    assert np.allclose(city.bounds, [(-5, -5, -1), (15, 15, 15)])


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


@pytest.mark.parametrize(
    "height", [12, 12.0, "12", "12.0", "12 m", "12m", " 12.0 m ", "12,0", "12 metres", "12+", "~12", "8;12"]
)
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
    assert city.bounds[0, 2] == -1  # one layer of ground
    assert city.is_free([(5, 5, 3.5), (5, 5, 10.5)]).all()
    assert not city.is_free([(5, 5, 4.5), (5, 5, 9.5)]).any()
    assert read_geojson(path, base="underside", heights_above="ground").buildings[0].bounds[0, 2] == 6
    assert read_geojson(path, base=2, heights_above="ground").buildings[0].bounds[0, 2] == 2
    assert read_geojson(path, base="absent", heights_above="ground").buildings[0].bounds[0, 2] == 0


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


def degrees(metres_ring, lon=4.36, lat=52.01):
    """A ring in metres near (1000, 2000) as longitude and latitude, by the radii of curvature."""
    meridian, normal = radii_of_curvature(lat)
    x, y = np.transpose(metres_ring).astype(float)
    lons = lon + np.degrees((x - 1000) / (normal * np.cos(np.radians(lat))))
    return np.column_stack([lons, lat + np.degrees((y - 2000) / meridian)]).tolist()


def test_degrees_become_metres_from_the_south_west_corner(geojson):
    city = read_geojson(geojson(feature(degrees(SQUARE), height=10), feature(degrees(FAR), height=20)), cell=0.5)
    assert city.reference == pytest.approx((4.36, 52.01, 0.0))
    assert np.allclose(city.buildings[0].bounds, [(0, 0, 0), (10, 10, 10)], atol=1e-3)
    assert np.allclose(city.buildings[1].bounds, [(40, 40, 0), (50, 50, 20)], atol=2e-3)


def test_town_on_both_sides_of_the_date_line_stays_together(geojson):
    west = [(-180 + abs(lon), lat) for lon, lat in degrees(SQUARE, lon=0.001, lat=-17)]
    east = [(180 - abs(lon), lat) for lon, lat in degrees(SQUARE, lon=0.001, lat=-17)]
    city = read_geojson(geojson(feature(east, height=10), feature(west, height=10)), cell=2)
    assert city.bounds[1, 0] - city.bounds[0, 0] < 300


@pytest.mark.parametrize(
    ("text", "metres"), [("40 ft", 12.192), ("40'", 12.192), ("40'6\"", 12.3444), ("40 feet", 12.192)]
)
def test_feet_are_feet(geojson, text, metres):
    assert read_geojson(geojson(feature(SQUARE, height=text))).buildings[0].bounds[1, 2] == pytest.approx(metres)


def test_what_is_not_finished_or_in_ruins_is_taken_as_it_is_and_said(geojson):
    town = geojson(
        feature(SQUARE, building="construction", **{"building:levels": "7"}),
        feature(SQUARE, building="ruins", height="4"),
        feature(SQUARE, building="yes", height="4"),
    )
    with pytest.warns(UserWarning, match="1 × finished building, though building=construction"):
        city = read_geojson(town)
    assert city.buildings[0].bounds[1, 2] == 21
    assert city.source.count("assumed", "finished building") == 2


STOREYS = [
    ({"building:levels": "38"}, 0, 114),
    ({"building:levels": 3, "roof:levels": 2}, 0, 15),
    ({"building:levels": "3", "roof:height": "4 m"}, 0, 13),
    ({"building:levels": "4;5"}, 0, 15),
    ({"building:levels": 9, "building:min_level": 2}, 6, 27),
    ({"building:levels": 9, "min_height": "5 m", "building:min_level": 2}, 5, 27),
    ({"building:levels": 2, "height": "10 m"}, 0, 10),
    ({"building:levels": 2, "height": "unknown"}, 0, 6),
    ({"num_floors": 4, "min_floor": 1}, 3, 12),
]


@pytest.mark.parametrize(("properties", "bottom", "top"), STOREYS)
def test_storeys_count_where_no_height_is_known(geojson, properties, bottom, top):
    city = read_geojson(geojson(feature(SQUARE, **properties)))
    assert city.buildings[0].bounds[:, 2].tolist() == [bottom, top]
    if "height" not in properties or properties["height"] == "unknown":
        assert city.source.count("derived", "height from storeys of 3 m") == 1
    higher = read_geojson(geojson(feature(SQUARE, **properties)), storey_height=4.0)
    assert higher.buildings[0].bounds[1, 2] >= top


def test_a_property_that_counts_storeys_is_never_read_as_metres(geojson):
    city = read_geojson(geojson(feature(SQUARE, **{"building:levels": 38})), height="building:levels")
    assert city.buildings[0].bounds[1, 2] == 114


def test_missing_heights_are_counted_and_named_with_the_cure(geojson):
    features = [feature(SQUARE, height=10), feature(SQUARE, stairs=2), feature(SQUARE, height="tall")]
    features[1]["id"] = "way/7"
    path = geojson(*features, {"type": "Feature", "geometry": None})
    with pytest.raises(ValueError, match=r"2 of 3 buildings in town\.geojson have no height that can be") as error:
        read_geojson(path)
    assert "first 'feature way/7' with None, 'feature 2 (counted from 0)' with 'tall'." in str(error.value)
    assert "Properties in the file: height, stairs." in str(error.value)
    assert "Pass default_height=10.0, or height='one of them'" in str(error.value)
    with pytest.warns(UserWarning, match=r"assumed: 2 × height of 7 m \(default_height\) \(feature way/7, feature 2"):
        city = read_geojson(path, default_height=7.0)
    assert [building.bounds[1, 2] for building in city.buildings] == [10, 7, 7]
    assert city.source.count("derived", "that can't be understood") == 1


@pytest.mark.parametrize(
    "height", [0, True, "nan", "inf m", -5, "-5 m", None, [3], {"m": 3}, 10**400, "1e3", "1,234 ft", ""]
)
def test_what_is_no_height_counts_as_unknown(geojson, height):
    path = geojson(feature(SQUARE, height=height))
    with pytest.raises(ValueError, match=r"1 of 1 buildings .* have no height"):
        read_geojson(path)


def test_an_underside_above_the_roof_is_taken_from_the_ground(geojson):
    city = read_geojson(geojson(feature(SQUARE, height=5, min_height=5), feature(FAR, height=5, min_height="low")))
    assert [building.bounds[0, 2] for building in city.buildings] == [0, 0]
    assert city.source.count("mended", "underside") == 1


@pytest.mark.parametrize(
    ("properties", "options", "bottom", "top"),
    [
        ({"height": 30, "min_height": "0;10"}, {}, 0, 30),  # in doubt the lower underside
        ({"height": "10;30", "min_height": 4}, {}, 4, 30),  # and the higher roof
        ({"num_floors": 12}, {"height": "num_floors"}, 0, 36),
        ({"storeys": 5}, {"height": "storeys"}, 0, 15),
        ({"height": 30, "floor": 2}, {"base": "floor"}, 2, 30),
    ],
)
def test_in_doubt_a_building_is_larger(geojson, properties, options, bottom, top):
    city = read_geojson(geojson(feature(SQUARE, **properties)), cell=5.0, heights_above="ground", **options)
    assert city.buildings[0].bounds[:, 2] == pytest.approx([bottom, top])


def test_one_height_for_all_makes_no_house_of_a_lake(geojson):
    path = geojson(feature(SQUARE, building="yes"), feature(FAR, natural="water"))
    city = read_geojson(path, height=9)
    assert len(city.buildings) == 1
    assert city.source.count("derived", "no obstacle: polygons that are no building") == 1


def test_a_sliver_is_left_out_and_the_rest_is_read(geojson):
    sliver = [[1030, 2030], [1040, 2030], [1040, 2030.00001]]
    with pytest.warns(UserWarning, match=r"left out: 1 × polygon without area \(feature 1"):
        assert len(read_geojson(geojson(feature(SQUARE, height=5), feature(sliver, height=5))).buildings) == 1


def test_what_an_outline_goes_around_twice_is_inside(geojson):
    star = [(0, 10), (6, -8), (-9, 3), (9, 3), (-6, -8)]  # its five points cross the lines of each other
    ring = [[1050 + x, 2050 + y] for x, y in star]
    city = read_geojson(geojson(feature(SQUARE, height=10), feature(ring, height=10)), cell=1.0)
    x, y = city.buildings[1].bounds[:, :2].mean(axis=0)
    assert not city.is_free((x, y - 1.0, 5.0))


def test_above_the_sea_a_house_without_underside_stands_on_the_ground_nearby(geojson):
    unknown = feature(shifted(SQUARE, (-850, -2000)), TopHeight=100.0)
    by_storeys = feature(shifted(SQUARE, (-960, -2000)), BaseHeight=30.0, **{"building:levels": 4})
    below = feature(shifted(SQUARE, (-700, -2000)), BaseHeight=-4.0, TopHeight=9.0)
    options = {"height": "TopHeight", "base": "BaseHeight", "crs": "local", "heights_above": "sea", "cell": 5.0}
    city = read_geojson(geojson(*bases(), unknown, by_storeys, below), **options)
    heights = [building.bounds[:, 2].tolist() for building in city.buildings]
    assert heights[1] == [124, 144]
    assert heights[3][1] == 104  # its roof above the sea, less that of the lowest foot, −4
    assert 0 < heights[3][0] < 124
    assert heights[4] == [34, 46]
    assert heights[5] == [0, 13]


def shifted(ring, by):
    return [[x + by[0], y + by[1]] for x, y in ring]


def test_parts_override_the_outline_that_they_lie_in(geojson):
    tower, podium = [[2, 2], [4, 2], [4, 4], [2, 4]], [[0, 0], [10, 0], [10, 10], [0, 10]]
    outline = feature(podium, building="yes", height=368)
    parts = [
        feature(podium, height=12, **{"building:part": "yes"}),
        feature(tower, height=368, **{"building:part": "yes"}),
    ]
    city = read_geojson(geojson(outline, *parts), crs="local")
    assert volume(city) == pytest.approx(100 * 12 + 4 * (368 - 12))
    assert city.source.count("derived", "outline overridden") == 1
    assert city.source.count("taken", "building part") == 2


def test_what_no_part_covers_stays_as_high_as_the_outline(geojson):
    outline = feature([[0, 0], [10, 0], [10, 10], [0, 10]], building="yes", height=20)
    half = feature([[0, 0], [5, 0], [5, 10], [0, 10]], **{"building:part": "yes", "building:levels": 2})
    apart = feature([[20, 0], [25, 0], [25, 10], [20, 10]], height=9, **{"building:part": "yes"})
    no_part = feature([[5, 0], [10, 0], [10, 10], [5, 10]], height=3, building="yes", **{"building:part": "no"})
    city = read_geojson(geojson(outline, half, apart), crs="local")
    assert volume(city) == pytest.approx(50 * 20 + 50 * 6 + 50 * 9)
    assert volume(read_geojson(geojson(outline, no_part), crs="local")) == pytest.approx(100 * 20)
    over = feature([[5, 0], [13, 0], [13, 10], [5, 10]], height=6, **{"building:part": "yes"})  # 5 of its 8 m
    assert volume(read_geojson(geojson(outline, over), crs="local")) == pytest.approx(50 * 20 + 80 * 6)
    sliver = feature([[0, 0], [9.95, 0], [9.95, 10], [0, 10]], height=4, **{"building:part": "yes"})
    assert max(b.bounds[1, 2] for b in read_geojson(geojson(outline, sliver), crs="local").buildings) == 4


def test_a_part_without_height_is_as_high_as_its_outline_or_left_out(geojson):
    outline = feature([[0, 0], [10, 0], [10, 10], [0, 10]], building="yes", height=20)
    part = feature([[0, 0], [10, 0], [10, 10], [0, 10]], **{"building:part": "yes"})
    assert volume(read_geojson(geojson(outline, part), crs="local")) == pytest.approx(2000)
    lost = feature([[50, 0], [60, 0], [60, 10], [50, 10]], **{"building:part": "yes"})
    with pytest.warns(UserWarning, match="left out: 1 × part without height and outline"):
        assert volume(read_geojson(geojson(outline, lost), crs="local")) == pytest.approx(2000)


def test_in_a_file_of_openstreetmap_land_and_water_are_no_buildings(geojson):
    house = feature(SQUARE, building="house", height=6)
    lake, demolished = feature(FAR, natural="water"), feature(FAR, building="no", landuse="grass")
    chimney = feature(FAR, man_made="chimney", height="30 m")
    city = read_geojson(geojson(house, lake, demolished))
    assert volume(city) == pytest.approx(600)
    assert city.source.count("derived", "no obstacle: polygons that are no building") == 2
    assert volume(read_geojson(geojson(house, lake, chimney))) == pytest.approx(600 + 3000)


@pytest.mark.parametrize(
    ("rings", "area"),
    [
        ([[[0, 0], [10, 10], [10, 0], [0, 10]]], 50),  # a bow-tie
        ([[[0, 0], [10, 0], [10, 10], [10, 14], [10, 10], [0, 10]]], 100),  # a spike
        ([[[0, 0], [10, 0], [10, 0], [10, 10], [0, 10], [0, 10], [0, 0]]], 100),  # corners that stand twice
        ([[[0, 0], [10, 0], [10, 10], [0, 10]], [[3, 3], [3, 3], [4, 4], [3, 3]]], 100),  # a hole without area
        ([[[0, 0], [10, 0], [10, 10], [0, 10]], [[0, 0], [10, 0], [10, 10], [0, 10]]], 100),  # nothing but a hole
        (
            [[[0, 0], [10, 0], [10, 10], [0, 10]], [[2, 2], [6, 2], [6, 6], [2, 6]], [[4, 4], [8, 4], [8, 8], [4, 8]]],
            76,
        ),
    ],
)
def test_broken_rings_are_mended_with_their_area(geojson, rings, area):
    city = read_geojson(
        geojson(feature(SQUARE, height=10), feature(*[shifted(r, (1030, 2030)) for r in rings], height=10))
    )
    footprint = sum(np.ptp(piece[:, 2]) and area_of(piece) for piece in city.buildings[1].pieces)
    assert footprint == pytest.approx(area)


def area_of(piece):
    from scipy.spatial import ConvexHull

    return ConvexHull(piece[:, :2]).volume


def test_only_what_has_no_area_is_left_out_and_named(geojson):
    path = geojson(feature(SQUARE, height=5), feature([[0, 0], [1, 1], [0, 0]], height=5), feature([], height=5))
    with pytest.warns(UserWarning, match=r"left out: 2 × polygon without area \(feature 1 .*, feature 2"):
        assert len(read_geojson(path, crs="local").buildings) == 1


def test_a_porch_on_a_hall_is_not_dropped(geojson):
    hall = [[0, 0], [1000, 0], [1000, 1000], [501.5, 1000], [501.5, 1001.2], [500, 1001.2], [500, 1000], [0, 1000]]
    city = read_geojson(geojson(feature(hall, height=5)), crs="local", cell=1.0)
    assert not city.is_free((500.7, 1000.9, 2.0))


BY_CODE = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::2263"}}


def test_feet_of_new_york_are_metres_here(geojson):
    ring = [[981000, 195000], [981100, 195000], [981100, 195100], [981000, 195100]]
    city = read_geojson(geojson(feature(ring, height=330), crs=BY_CODE), cell=2.0)
    size = np.ptp(city.buildings[0].bounds, axis=0)
    assert size == pytest.approx([30.48, 30.48, 100.584], rel=2e-4)
    assert city.source.count("derived", "heights without a unit are in US survey foot") == 0
    assert "heights without a unit are in US survey foot" in str(city.source)
    in_metres = read_geojson(geojson(feature(ring, height=330), crs=BY_CODE), cell=5.0, height_unit="m")
    assert in_metres.buildings[0].bounds[1, 2] == 330
    said = read_geojson(geojson(feature(ring, height="100 m"), crs=BY_CODE), cell=5.0)
    assert said.buildings[0].bounds[1, 2] == 100
    back = city.to_geographic(city.buildings[0].bounds)
    assert back[0, :2] == pytest.approx([-74.0117, 40.7019], abs=1e-4)
    assert city.from_geographic(back) == pytest.approx(city.buildings[0].bounds, abs=1e-6)


def test_web_mercator_is_brought_to_true_metres(geojson):
    ring = [[-8238000, 4970000], [-8237900, 4970000], [-8237900, 4970100], [-8238000, 4970100]]
    crs = {"type": "name", "properties": {"name": "EPSG:3857"}}
    city = read_geojson(geojson(feature(ring, height=10), crs=crs))
    assert np.ptp(city.buildings[0].bounds, axis=0)[:2] == pytest.approx([75.7, 75.5], rel=5e-3)
    assert read_geojson(geojson(feature(ring, height=10)), crs=3857).buildings[0].bounds == pytest.approx(
        city.buildings[0].bounds
    )


@pytest.mark.parametrize(
    "name", ["urn:ogc:def:crs:OGC:1.3:CRS84", "EPSG:4326", "urn:ogc:def:crs:EPSG::4258", "EPSG:7844"]
)
def test_geographic_systems_have_degrees(geojson, name):
    crs = {"type": "name", "properties": {"name": name}}
    city = read_geojson(geojson(feature(degrees(SQUARE), height=10), crs=crs))
    assert city.reference == pytest.approx((4.36, 52.01, 0.0), abs=2e-5)


@pytest.mark.parametrize(
    ("ring", "options", "message"),
    [
        (
            [[0, 0], [80, 0], [80, 60], [0, 60]],
            {},
            r"no city: .* if they are metres, pass crs='local'",
        ),
        (
            shifted(SQUARE, (84_000, 447_000)),
            {},
            r"names no reference system, .* crs='local'",
        ),
        (SQUARE, {"crs": "EPSG:4326"}, "coordinates .* are no degrees, but EPSG:4326"),
        (SQUARE, {"crs": "EPSG:0"}, "crs='EPSG:0' is no reference system that pyproj knows"),
        (
            degrees(SQUARE) if False else [[9.5, 48.7], [9.6, 48.7], [9.6, 48.8]],
            {"crs": 25832},
            "they look like degrees",
        ),
        (SQUARE, {"height_unit": "yard"}, "height_unit must be one of 'm'"),
        (SQUARE, {"storey_height": 0}, "storey_height must be finite and above 0"),
        (SQUARE, {"default_height": -1}, "default_height must be finite and above 0"),
        (SQUARE, {"heights_above": "roof"}, "heights_above must be one of 'auto', 'ground', 'sea'"),
        (SQUARE, {"height": -3}, "height must be finite and above 0, got -3"),
        (SQUARE, {"voxels": "corners"}, "voxels must be one of 'touched', 'centres', got 'corners'"),
        (SQUARE, {"terrain": np.nan}, "terrain must be finite"),
        (SQUARE, {"base": -1}, "base must be finite and at least 0, got -1"),
        (SQUARE, {"terrain": [1, 2]}, "terrain must be a Terrain"),
        (SQUARE, {"cell": 0.01}, r"cell=0\.01 m gives .* use a cell of at least"),
        (SQUARE, {"margin": -5}, "margin must be finite and at least 0"),
    ],
)
def test_what_cant_be_known_is_asked_for(geojson, ring, options, message):
    with pytest.raises(ValueError, match=message):
        read_geojson(geojson(feature(ring, height=10)), **options)


def bases(low=5.0, hill=120.0):
    return [
        feature(shifted(SQUARE, (x - 1000, -2000)), BaseHeight=base, TopHeight=base + 20)
        for x, base in ((0, low), (100, hill), (200, low))
    ]


def test_heights_above_the_sea_stand_on_the_ground(geojson):
    options = {"height": "TopHeight", "base": "BaseHeight", "crs": "local"}
    with pytest.warns(UserWarning, match="assumed: heights above the sea, as most bases are above 1 m"):
        city = read_geojson(geojson(*bases()), **options)
    assert [b.bounds[:, 2].tolist() for b in city.buildings] == [[0, 20], [115, 135], [0, 20]]
    assert city.height_above_ground([(5, 5, 3), (105, 5, 118), (55, 5, 60)]) == pytest.approx(
        [3, 3, 60 - 57.5], abs=0.7
    )
    assert not city.is_free((55, 5, 50))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        read_geojson(geojson(*bases()), heights_above="sea", **options)
        floating = read_geojson(geojson(*bases()), heights_above="ground", **options)
    assert floating.buildings[1].bounds[:, 2].tolist() == [120, 140]
    assert floating.is_free((105, 5, 50))


def test_buildings_stand_on_a_terrain_that_is_given(geojson):
    slope = Terrain.from_raster(40 + 0.5 * np.tile(np.arange(-40, 80.0), (120, 1)), (-40, -40, 80, 80), crs=None)
    city = read_geojson(geojson(feature(SQUARE, height=10), feature(FAR, height=10)), terrain=slope, crs="local")
    first, second = (building.bounds[:, 2] for building in city.buildings)
    assert first == pytest.approx([0.0, 5.0 + 10], abs=0.3)  # from the lowest ground below to above the highest
    assert second == pytest.approx([20.0, 25.0 + 10], abs=0.3)
    assert city.height_above_ground((25.0, 5.0, 30.0)) == pytest.approx(30 - 12.5, abs=0.3)
    level = read_geojson(geojson(feature(degrees(SQUARE), height=10)), terrain=12.0)
    assert level.reference.height == 12.0
    assert level.to_geographic((0, 0, 5))[2] == 17.0
    small = Terrain.from_raster(np.zeros((30, 30)), (-20, -20, 10, 10))
    path = geojson(feature(SQUARE, height=10), feature(FAR, height=10))
    with pytest.raises(ValueError, match="terrain says nothing about the ground under 'feature 1"):
        read_geojson(path, terrain=small, crs="local")


@pytest.mark.parametrize(
    "geometry",
    [
        {"type": "Polygon", "coordinates": [[[0], [1], [2]]]},
        {"type": "Polygon", "coordinates": [[5, 6, 7]]},
        {"type": "Polygon", "coordinates": 3},
        {"type": "Polygon", "coordinates": [[["a", "b"], [1, 2], [3, 4]]]},
        {"type": "Polygon", "coordinates": [[[10**400, 1], [1, 2], [3, 4]]]},
        "abc",
        ["Polygon"],
        {"coordinates": []},
        {"type": "GeometryCollection", "geometries": 5},
    ],
)
def test_malformed_geometry_is_named(geojson, geometry):
    with pytest.raises(ValueError, match=r"'feature 0 \(counted from 0\)' is malformed"):
        read_geojson(geojson({"type": "Feature", "properties": {"height": 5}, "geometry": geometry}))


def test_properties_that_are_no_object_are_named(geojson):
    broken = feature(SQUARE)
    broken["properties"] = [1]
    with pytest.raises(ValueError, match=r"'feature 0 .*' is malformed"):
        read_geojson(geojson(broken))


def test_file_without_polygons_says_what_it_has(geojson):
    point = {"type": "Feature", "properties": {}, "geometry": {"type": "Point", "coordinates": [1, 2]}}
    with pytest.raises(ValueError, match=r"has no polygon with an area; its features are 2 Point, 1 None"):
        read_geojson(geojson(point, point, {"type": "Feature", "geometry": None}))
    with pytest.raises(ValueError, match="its features are none at all"):
        read_geojson(geojson())


@pytest.mark.parametrize("document", [{"type": "CityJSON"}, {"type": "FeatureCollection", "features": 3}, {}])
def test_other_json_is_not_geojson(tmp_path, document):
    with pytest.raises(ValueError, match="is not GeoJSON: expected a FeatureCollection with a list of features"):
        read_geojson(write(tmp_path / "other.json", document))


@pytest.mark.parametrize("separator", ["\n", "\n\n", "\x1e", "\n\x1e", " "])
def test_features_may_be_separated_by_anything(tmp_path, separator):
    import json

    path = tmp_path / "town.geojsons"
    lines = [json.dumps(feature(ring, height=10)) for ring in (SQUARE, FAR)]
    path.write_text("\x1e" * (separator == "\n\x1e") + separator.join(lines))
    assert len(read_city(path).buildings) == 2


def test_city_that_was_written_by_hand_is_read_back(geojson):
    """Buildings → GeoJSON in metres → the same voxels."""
    ell = [(0, 0), (30, 0), (30, 10), (10, 10), (10, 30), (0, 30)]
    tower = [(20, 20), (28, 20), (28, 28), (20, 28)]
    known = City.from_buildings([Building.prism(ell, 12), Building.prism(tower, 30, bottom=8)], cell=0.5, terrain=0.0)
    path = geojson(feature(ell, height=12), feature(tower, height=30, min_height=8))
    assert np.array_equal(read_geojson(path, cell=0.5, crs="local").occupied, known.occupied)


@pytest.mark.parametrize("seed", range(30))
def test_whatever_is_changed_in_a_file_only_a_value_error_comes_out(tmp_path, seed):
    import json

    rng = np.random.default_rng(seed)
    text = json.dumps({"type": "FeatureCollection", "features": [feature(SQUARE, COURTYARD, height=9), *bases()]})
    for _ in range(20):
        at = int(rng.integers(len(text)))
        junk = rng.choice(["", "0", "-", "]", "[", "{", "}", '"', "null", "1e999", "NaN", ",", "true", "\x1e", "é"])
        path = tmp_path / "town.geojson"
        path.write_text(text[:at] + junk + text[at + int(rng.integers(4)) :], encoding="utf-8")
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                read_geojson(path, cell=10.0, default_height=5.0)
        except ValueError:
            pass


TAGGED = [
    {"type": "way", "tags": {"building": "yes", "height": "45"}},  # osm2geojson
    {"building": "yes", "tags": '{"height": "45"}'},  # pyrosm
    {"building": "yes", "other_tags": '"note"=>"a \\"tower\\"","height"=>"45"'},  # GDAL
    {"building": "yes", "height": None, "other_tags": '"building:levels"=>"15"'},
]


@pytest.mark.parametrize("properties", TAGGED)
def test_tags_may_be_packed_in_a_property(geojson, properties):
    park = feature(FAR, type="way", tags={"leisure": "park"})
    city = read_geojson(geojson(feature(SQUARE, **properties), park), default_height=5)
    assert [each.bounds[1, 2] for each in city.buildings] == [45]


@pytest.mark.parametrize("tags", ["{height", "a park, 5 m", ["height", 3], 7, '"height"=>3'])
def test_a_property_of_tags_may_be_anything_else(geojson, tags):
    assert read_geojson(geojson(feature(SQUARE, height=9, tags=tags))).buildings[0].bounds[1, 2] == 9


def point(**properties):
    return {"type": "Feature", "properties": properties, "geometry": {"type": "Point", "coordinates": [1020, 2020]}}


@pytest.mark.parametrize(
    ("lost", "said"),
    [
        (point(man_made="mast"), "1 × Point that has no outline"),
        (point(height="120 m", name="antenna"), "1 × Point that has no outline"),
        (feature(*FAR, kind="LineString", building="yes", height=30), "1 × LineString that has no outline"),
        ({"type": "Feature", "properties": {"building": "yes"}, "geometry": None}, "1 × feature without geometry"),
        (feature([FAR], kind="PolyhedralSurface", height=5), "1 × geometry of type 'PolyhedralSurface'"),
    ],
)
def test_an_obstacle_without_outline_is_left_out_with_a_warning(geojson, lost, said):
    path = geojson(feature(SQUARE, building="yes", height=10), lost)
    with pytest.warns(UserWarning, match=f"left out: {said}"):
        city = read_geojson(path, crs="local")
    assert city.source.count("left out") == 1


def test_other_points_are_left_out_in_silence(geojson):
    path = geojson(feature(SQUARE, building="yes", height=10), point(shop="bakery"))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        city = read_geojson(path, crs="local")
    assert city.source.count("derived", "no obstacle: points") == 1


def test_towers_and_tanks_are_obstacles_though_no_buildings(geojson):
    park, tank = feature(COURTYARD, leisure="park"), feature(FAR, man_made="storage_tank")
    path = geojson(feature(SQUARE, building="yes", height=10), park, tank)
    with pytest.raises(ValueError, match=r"1 of 2 buildings in town.geojson have no height"):
        read_geojson(path)
    assert [each.bounds[1, 2] for each in read_geojson(path, default_height=7).buildings] == [10, 7]


@pytest.mark.parametrize(
    ("levels", "height"), [("20-22", 66), ("3 – 4", 12), ("2;3", 9), ("2;3-5", 15), ("5-3", 15), ("3-", None)]
)
def test_of_a_range_of_storeys_the_most_count(geojson, levels, height):
    path = geojson(feature(SQUARE, building="yes", **{"building:levels": levels}))
    assert read_geojson(path, default_height=2).buildings[0].bounds[1, 2] == (height or 2)


@pytest.mark.parametrize("height", ["8-12 m", "8–12", "26.25-39.37 ft"])
def test_of_a_range_of_heights_the_highest_counts(geojson, height):
    assert read_geojson(geojson(feature(SQUARE, height=height))).buildings[0].bounds[1, 2] == pytest.approx(
        12, abs=1e-3
    )


@pytest.mark.parametrize(
    "name", ["storeysAboveGround", "numberOfFloorsAboveGround", "FLOOR_COUNT", "NB_ETAGES", "levels"]
)
def test_properties_that_count_storeys_are_known_by_their_names(geojson, name):
    assert read_geojson(geojson(feature(SQUARE, **{name: 12})), height=name).buildings[0].bounds[1, 2] == 36


@pytest.mark.parametrize("name", ["eaves_level_m", "first_floor_height", "storeys_height", "history"])
def test_other_properties_hold_metres(geojson, name):
    assert read_geojson(geojson(feature(SQUARE, **{name: 12})), height=name).buildings[0].bounds[1, 2] == 12


def test_a_roof_of_overture_stands_on_its_storeys(geojson):
    assert read_geojson(geojson(feature(SQUARE, num_floors=4, roof_height=2.5))).buildings[0].bounds[1, 2] == 14.5


def test_the_name_of_heights_may_be_spelled_in_capitals(geojson):
    city = read_geojson(geojson(feature(SQUARE, HEIGHT=50), feature(FAR, HEIGHT=None)), default_height=5)
    assert [each.bounds[1, 2] for each in city.buildings] == [50, 5]
    assert "heights from 'HEIGHT'" in str(city.source)
    both = geojson(feature(SQUARE, HEIGHT=50, Height=60))
    assert read_geojson(both, default_height=5).buildings[0].bounds[1, 2] == 5


def test_a_link_to_a_system_is_not_passed_over(geojson):
    crs = {"type": "link", "properties": {"href": "http://example.org/26986", "type": "proj4"}}
    path = geojson(feature([[4.36, 52.01], [4.361, 52.01], [4.361, 52.011]], height=10), crs=crs)
    with pytest.raises(
        ValueError, match=r"'http://example.org/26986' is no reference system .* such as crs='EPSG:25832'"
    ):
        read_geojson(path)
    assert read_geojson(path, crs="EPSG:4326").reference is not None


def test_a_sequence_has_one_system(tmp_path):
    def collection(east, *codes):
        ring = [[east + x, 5_820_000 + y] for x, y in ((0, 0), (10, 0), (10, 10))]
        crs = [{"crs": {"type": "name", "properties": {"name": code}}} for code in codes]
        return {"type": "FeatureCollection", "features": [feature(ring, height=10)]} | (crs[0] if crs else {})

    def read(one, other):
        return read_geojson(write(tmp_path / "a.geojsons", collection(392_000, one), collection(392_100, other)))

    with pytest.raises(ValueError, match="more than one reference system, 'EPSG:25833' and 'EPSG:25832'"):
        read("EPSG:25833", "EPSG:25832")
    assert len(read("EPSG:25833", "urn:ogc:def:crs:EPSG::25833").buildings) == 2
    half = write(tmp_path / "b.geojsons", collection(392_000, "EPSG:25833"), collection(392_100))
    assert len(read_geojson(half).buildings) == 2


def test_esri_json_is_no_geojson(tmp_path):
    document = {"geometryType": "esriGeometryPolygon", "features": [{"attributes": {}, "geometry": {"rings": []}}]}
    with pytest.raises(ValueError, match="is Esri JSON, not GeoJSON: ask the server for f=geojson"):
        read_geojson(write(tmp_path / "a.json", document))


def test_a_house_on_the_antimeridian_may_go_on_past_180_degrees(geojson):
    ring = [[179.9999, 0], [180.0001, 0], [180.0001, 2e-4], [179.9999, 2e-4]]
    city = read_geojson(geojson(feature(ring, height=10)))
    assert city.buildings[0].bounds[1] == pytest.approx([22.264, 22.115, 10], abs=1e-3)


def test_whether_roofs_count_from_the_sea_is_said(geojson):
    path = geojson(feature(SQUARE, height=40, ground=30), feature(FAR, height=50, ground=31))
    city = read_geojson(path, base="ground", heights_above="sea")
    assert "derived: roofs are above the sea, too" in str(city.source)


def test_undersides_of_parts_count_from_the_lowest_ground_at_the_whole_building(geojson):
    outline, uphill = [[0, 0], [40, 0], [40, 40], [0, 40]], [[20, 0], [40, 0], [40, 40], [20, 40]]
    part = feature(uphill, height=20, min_height=10, **{"building:part": "yes"})
    path = geojson(feature(outline, building="yes", height=20), part)
    slope = Terrain.from_raster(np.tile(100 + 0.5 * np.arange(-95, 205, 10.0), (30, 1)), (-100, -100, 200, 200))
    rest, bridge = read_geojson(path, crs="local", terrain=slope, cell=5.0).buildings
    assert rest.bounds[:, 2] == pytest.approx([0, 30])
    assert bridge.bounds[:, 2] == pytest.approx([10, 40])  # the ground below it is from 10 to 20 m high


def test_terrain_of_other_heights_than_the_file_is_a_doubt(geojson):
    path = geojson(feature(SQUARE, height=140, ground=130), feature(FAR, height=150, ground=130))

    def read(terrain):
        return read_geojson(path, base="ground", heights_above="sea", terrain=terrain, crs="local", cell=5.0)

    assert not read(125.0).source.doubts
    with pytest.warns(UserWarning, match="2 × building more than 10 m above the ground, filled down to it"):
        assert [each.bounds[0, 2] for each in read(0.0).buildings] == [0, 0]
    with pytest.warns(UserWarning, match="1 × building is wholly below the ground"):
        read(Terrain.from_raster(np.full((3, 3), 145.0), (-100, -100, 200, 200)))
