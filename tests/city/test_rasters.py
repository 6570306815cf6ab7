import sys

import numpy as np
import pyproj
import pytest
import rasterio
from rasterio.transform import Affine

import uavlab.city.terrain
from uavlab.city.place import Place, system_of
from uavlab.city.rasters import read_terrain

GRID = """ncols 3
nrows 2
xllcorner 100
yllcorner 200
cellsize 10
NODATA_value -9999
1 2 3
4 5 -9999
"""


def written(tmp_path, text):
    path = tmp_path / "ground.asc"
    path.write_text(text)
    return path


def test_an_ascii_grid_begins_in_the_north(tmp_path):
    terrain = read_terrain(written(tmp_path, GRID))
    assert terrain.system is None
    assert terrain.heights_at([(105, 215), (115, 215), (125, 215), (105, 205), (115, 205)]) == pytest.approx(
        [1, 2, 3, 4, 5]
    )
    assert np.isnan(terrain.heights_at([(125, 205)])).all()
    centred = GRID.replace("xllcorner 100", "xllcenter 105").replace("yllcorner 200", "YLLCENTER 205")
    assert read_terrain(written(tmp_path, centred)).points == pytest.approx(terrain.points)
    there = GRID.replace("100", "565000").replace("200", "5934000")
    assert read_terrain(written(tmp_path, there), crs="EPSG:25832").system.name.startswith("EPSG:25832")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("nrows 2\n", ""), r"ground.asc has no line 'nrows' in its header"),
        (("cellsize 10\n", ""), "no line 'cellsize'"),
        (("xllcorner 100\n", ""), "no line 'xllcorner'"),
        (("ncols 3", "ncols three"), "ground.asc, line 1: expected a number, got 'three'"),
        (("ncols 3", "columns 3"), "ground.asc, line 1: expected a line such as 'ncols 100', got 'columns 3'"),
        (("ncols 3", "ncols nan"), "ground.asc: ncols must be a whole number of at least 1, got nan"),
        (("ncols 3", "ncols inf"), "ncols must be a whole number of at least 1, got inf"),
        (("nrows 2", "nrows 2.5"), "nrows must be a whole number of at least 1, got 2.5"),
        (("ncols 3", "ncols -3"), "ncols must be a whole number of at least 1, got -3"),
        (("ncols 3", "ncols 1e8"), "ground.asc has 2 × 100,000,000 pixels, more than 25,000,000: cut it"),
        (("cellsize 10", "cellsize 0"), "ground.asc: cellsize .* must be finite and above 0, got 0"),
        (("cellsize 10", "cellsize nan"), "cellsize .* must be finite and above 0, got nan"),
        (("xllcorner 100", "xllcorner inf"), "xllcorner and yllcorner must be finite"),
        (("cellsize 10", "cellsize 0.0003"), "in degrees they need crs='EPSG:4326'"),
        (("4 5", "-inf 5"), "heights must not be infinite, 1 are"),
        (("4 5", "4 x5"), "ground.asc, line 8: expected a number, got 'x5'"),
        (("4 5 -9999", "4 5"), "must have 2 × 3 values, as its header says, got 5"),
        (("NODATA_value -9999", "NODATA_value -8888"), "heights on Earth, .* got -9999"),
    ],
)
def test_a_broken_grid_is_refused_with_the_place(tmp_path, change, message):
    with pytest.raises(ValueError, match=message):
        read_terrain(written(tmp_path, GRID.replace(*change)))


def test_a_grid_has_its_system_in_a_file_beside_it(tmp_path):
    path = written(tmp_path, GRID.replace("100", "565000").replace("200", "5934000"))
    path.with_suffix(".prj").write_text(system_of(25832).crs.to_wkt("WKT1_ESRI"))
    assert "UTM" in read_terrain(path).system.name
    assert read_terrain(path, crs="local").system is None
    assert read_terrain(path, crs="EPSG:32632").system.name.startswith("EPSG:32632")
    path.with_suffix(".prj").write_text("somewhere")
    with pytest.raises(ValueError, match=r"ground\.prj='somewhere' is no reference system"):
        read_terrain(path)


@pytest.mark.parametrize(("code", "corner"), [("EPSG:25832", (565_000, 5_934_000)), ("EPSG:2263", (981_000, 195_000))])
@pytest.mark.parametrize("kind", ["asc", "tif"])
def test_files_are_placed_where_pyproj_puts_them_in_metres(tmp_path, code, corner, kind):
    heights = (100 + 0.25 * np.add.outer(np.arange(40)[::-1], 2.0 * np.arange(50))).astype("float32")
    if kind == "tif":
        path = geotiff(tmp_path / "g.tif", heights, Affine(10, 0, corner[0], 0, -10, corner[1] + 400), crs=code)
    else:
        head = f"ncols 50\nnrows 40\nxllcorner {corner[0]}\nyllcorner {corner[1]}\ncellsize 10\n"
        path = written(tmp_path, head + "\n".join(" ".join(map(str, row)) for row in heights))
    found = read_terrain(path, crs=None if kind == "tif" else code)
    there = np.random.default_rng(0).uniform((10, 10), (490, 390), (200, 2))
    lon, lat = pyproj.Transformer.from_crs(code, "EPSG:4326", always_xy=True).transform(*(corner + there).T)
    place = Place(lon[0], lat[0], height=7.0)
    east, north, _ = pyproj.Transformer.from_pipeline(
        "+proj=pipeline +step +proj=unitconvert +xy_in=deg +xy_out=rad +step +proj=cart +ellps=WGS84 +step "
        f"+proj=topocentric +ellps=WGS84 +lon_0={place.longitude} +lat_0={place.latitude} +h_0=7"
    ).transform(lon, lat, np.full(200, 7.0))
    unit = 1200 / 3937 if code == "EPSG:2263" else 1.0
    expected = unit * (100 + 0.25 * (2 * (there[:, 0] / 10 - 0.5) + there[:, 1] / 10 - 0.5)) - 7
    assert found.placed(place).heights_at(np.column_stack([east, north])) == pytest.approx(expected, abs=1e-4)


def geotiff(path, heights, transform, crs="EPSG:25832", **profile):
    heights = np.atleast_3d(heights.T).T
    with rasterio.open(
        path, "w", driver="GTiff", width=heights.shape[2], height=heights.shape[1], count=heights.shape[0],
        dtype=heights.dtype, crs=crs, transform=transform, **profile,
    ) as file:  # fmt: skip
        file.write(heights)
    return path


def test_a_geotiff_knows_its_system_and_what_is_no_data(tmp_path):
    heights = np.arange(12, dtype="float32").reshape(3, 4)
    heights[0, 0] = -32768
    path = geotiff(tmp_path / "g.tif", heights, Affine(5, 0, 565_000, 0, -5, 5_934_000), nodata=-32768)
    terrain = read_terrain(path)
    assert terrain.system.name == system_of(25832).name
    assert terrain.heights_at([(565_007.5, 5_933_997.5), (565_002.5, 5_933_992.5)]) == pytest.approx([1, 4])
    assert np.isnan(terrain.heights_at([(565_002.5, 5_933_997.5)])).all()
    assert read_terrain(path, crs="local").system is None


def test_a_geotiff_may_have_a_scale_an_offset_and_a_unit(tmp_path):
    path = geotiff(tmp_path / "g.tif", np.array([[100, 200]], "int16"), Affine(5, 0, 565_000, 0, -5, 5_934_000))
    with rasterio.open(path, "r+") as file:
        file.scales, file.offsets, file.units = (0.1,), (50.0,), ("ft",)
    assert sorted(set(read_terrain(path).points[:, 2])) == pytest.approx([60 * 0.3048, 70 * 0.3048])
    feet = geotiff(tmp_path / "f.tif", np.array([[100, 200]], "int16"), Affine(5, 0, 981_000, 0, -5, 195_000), crs=2263)
    with rasterio.open(feet, "r+") as file:
        file.units = ("metre",)
    metres = read_terrain(feet)
    assert sorted(set(metres.points[:, 2] * metres.system.height_factor)) == pytest.approx([100, 200])


def test_a_turned_geotiff_lies_where_its_transform_says(tmp_path):
    turned = Affine.translation(1000, 2000) @ Affine.rotation(30) @ Affine.scale(5, -5)
    heights = np.add.outer(10.0 * np.arange(6), np.arange(8.0)).astype("float32")
    terrain = read_terrain(geotiff(tmp_path / "g.tif", heights, turned, crs=None), crs="local")
    for row, column in [(0, 0), (3, 2), (5, 7)]:
        there = turned @ (column + 0.5, row + 0.5)
        assert terrain.heights_at([there]) == pytest.approx(heights[row, column], abs=1e-4)


def test_geotiffs_that_cant_be_used_are_refused(tmp_path, monkeypatch):
    flat = np.zeros((2, 2, 2), "float32")
    with pytest.raises(ValueError, match="has 2 bands, expected one, of heights"):
        read_terrain(geotiff(tmp_path / "two.tif", flat, Affine(1, 0, 5, 0, -1, 5)))
    with pytest.raises(ValueError, match="names no reference system: give crs='EPSG"):
        read_terrain(geotiff(tmp_path / "none.tif", flat[0], Affine(1, 0, 5, 0, -1, 5), crs=None))
    with pytest.warns(rasterio.errors.NotGeoreferencedWarning):
        unplaced = geotiff(tmp_path / "unplaced.tif", flat[0], Affine.identity(), crs=None)
    with pytest.raises(ValueError, match=r"unplaced\.tif doesn't say where it lies: use Terrain\.from_raster"):
        read_terrain(unplaced, crs="local")
    with pytest.raises(ValueError, match=r"heights of endless\.tif must not be infinite, 4 are"):
        read_terrain(geotiff(tmp_path / "endless.tif", flat[0] + np.inf, Affine(1, 0, 5, 0, -1, 5)))
    with monkeypatch.context() as patch:
        patch.setattr(uavlab.city.terrain, "MOST_PIXELS", 3)
        with pytest.raises(ValueError, match=r"large\.tif has 2 × 2 pixels, more than 3: cut it to the city first"):
            read_terrain(geotiff(tmp_path / "large.tif", flat[0], Affine(1, 0, 5, 0, -1, 5)))
    broken = tmp_path / "broken.tif"
    broken.write_bytes(b"II*\0" + b"\0" * 50)
    with pytest.raises(ValueError, match=r"broken\.tif is no GeoTIFF that can be read"):
        read_terrain(broken)
    other = tmp_path / "other.asc"
    other.write_bytes(b"\x89PNG\r\n\xff\xfe")
    with pytest.raises(ValueError, match="neither a GeoTIFF nor an ASCII grid"):
        read_terrain(other)
    monkeypatch.setitem(sys.modules, "rasterio", None)
    with pytest.raises(ImportError, match=r'pip install "uavlab\[raster\]"'):
        read_terrain(broken)


def test_no_data_of_a_grid_may_be_rounded(tmp_path):
    text = GRID.replace("NODATA_value -9999", "NODATA_value -3.402823e+38").replace("-9999", "-3.4028234663852886e+38")
    assert len(read_terrain(written(tmp_path, text)).triangles) < len(read_terrain(written(tmp_path, GRID)).points) * 2
    assert np.isnan(read_terrain(written(tmp_path, text)).heights_at([(125, 205)])).all()
    near = GRID.replace("NODATA_value -9999", "NODATA_value 5.01")
    with pytest.raises(ValueError, match="got -9999"):
        read_terrain(written(tmp_path, near))
    assert read_terrain(written(tmp_path, near.replace("-9999", "5.01"))).heights_at([(115, 205)]) == [5]


def test_the_system_beside_a_grid_may_be_named_in_capitals(tmp_path):
    path = written(tmp_path, GRID.replace("100", "565000").replace("200", "5934000"))
    path.with_suffix(".PRJ").write_text(system_of(25832).crs.to_wkt("WKT1_ESRI"))
    assert "UTM" in read_terrain(path).system.name


@pytest.mark.parametrize(("unit", "factor"), [("Feet", 0.3048), ("METERS", 1.0), ("US survey foot", 1200 / 3937)])
def test_units_of_a_geotiff_in_any_case(tmp_path, unit, factor):
    path = geotiff(tmp_path / "g.tif", np.array([[100, 200]], "int16"), Affine(5, 0, 981_000, 0, -5, 195_000), crs=2263)
    with rasterio.open(path, "r+") as file:
        file.units = (unit,)
    terrain = read_terrain(path)
    assert terrain.points[0, 2] * terrain.system.height_factor == pytest.approx(100 * factor)


def test_a_unit_that_is_not_known_is_refused(tmp_path):
    path = geotiff(tmp_path / "g.tif", np.array([[100, 200]], "int16"), Affine(5, 0, 565_000, 0, -5, 5_934_000))
    with rasterio.open(path, "r+") as file:
        file.units = ("cm",)
    with pytest.raises(ValueError, match=r"unit of heights in g\.tif must be one of 'm', .* got 'cm'"):
        read_terrain(path)
