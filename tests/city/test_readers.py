"""Voxel maps, and finding out what format a file has."""

import gzip

import numpy as np
import pytest
from files import BOX, SQUARE, box, building, feature, solid, volume, write

from uavlab.city import read_city, read_cityjson, read_geojson, read_voxels


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


@pytest.mark.parametrize("reader", [read_city, read_geojson])
def test_warning_stands_at_the_callers_line_and_cuts_long_names(tmp_path, reader):
    name = "b46c407db-2d29-11e6-9a38-393caa90be70"
    path = write(tmp_path / "a.geojson", {"type": "FeatureCollection", "features": [feature(SQUARE, id=name)]})
    with pytest.warns(UserWarning, match=r"height of 7 m .*b46c407db-2d29[-0-9a-f]*…") as caught:
        city = reader(path, default_height=7.0)
    assert [each.filename for each in caught] == [__file__]
    assumed = next(entry for entry in city.source.of("assumed") if entry.first)
    assert name in assumed.first[0]
    assert name not in str(assumed)


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


def test_overpass_own_json_is_named_with_the_cure(tmp_path):
    text = '{"version": 0.6, "generator": "Overpass API", "elements": [{"type": "way", "id": 1, "nodes": []}]}'
    with pytest.raises(ValueError, match=r"raw\.json is Overpass' own JSON.*choose Export, GeoJSON"):
        read_city(write(tmp_path / "raw.json", text))


def test_other_encodings_and_other_json_are_refused(tmp_path):
    path = write(tmp_path / "a.json", '{"name": "Straße"}', encoding="latin-1")
    with pytest.raises(ValueError, match=r"a\.json is not UTF-8 text: .* at byte 14"):
        read_city(path)
    with pytest.raises(ValueError, match=r"a\.json must hold a JSON object \{\.\.\.\}, got a list"):
        read_city(write(tmp_path / "a.json", "[1, 2]"))


def test_a_packed_file_is_refused_with_advice(tmp_path):
    path = tmp_path / "town.geojson.gz"
    path.write_bytes(gzip.compress(b'{"type": "FeatureCollection"}'))
    with pytest.raises(ValueError, match=r"is not a city that can be read.*packed with gzip: unpack it first"):
        read_city(path)
