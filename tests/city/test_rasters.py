import sys

import numpy as np
import pytest
import rasterio
from rasterio.transform import Affine

from uavlab.city.place import system_of
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
    assert read_terrain(written(tmp_path, GRID), crs="EPSG:25832").system.name.startswith("EPSG:25832")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("nrows 2\n", ""), r"ground.asc has no line 'nrows' in its header"),
        (("cellsize 10\n", ""), "no line 'cellsize'"),
        (("xllcorner 100\n", ""), "no line 'xllcorner'"),
        (("ncols 3", "ncols three"), "ground.asc, line 1: expected a number, got 'three'"),
        (("ncols 3", "columns 3"), "ground.asc, line 1: expected a line such as 'ncols 100', got 'columns 3'"),
        (("4 5", "4 x5"), "ground.asc, line 8: expected a number, got 'x5'"),
        (("4 5 -9999", "4 5"), "must have 2 × 3 heights, as its header says, got 5"),
        (("NODATA_value -9999", "NODATA_value -8888"), "heights on Earth, .* got -9999"),
    ],
)
def test_a_broken_grid_is_refused_with_the_place(tmp_path, change, message):
    with pytest.raises(ValueError, match=message):
        read_terrain(written(tmp_path, GRID.replace(*change)))


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
