"""Files that were changed somewhere: only ValueError comes out of any reader, and it names the file."""

import json
import warnings

import numpy as np
import pytest
import rasterio
from rasterio.transform import Affine

from uavlab.city import City, read_city, read_no_fly, read_terrain, read_voxels
from uavlab.city.place import Place, system_of
from uavlab.risk import osm_layers, read_people
from uavlab.weather import read_weather

TOWN = City(np.zeros((20, 20, 5), bool), 5.0, reference=Place(4.36, 52.01, 0.0))
DUTCH = City(
    np.zeros((2, 2, 2), bool), 2.0, reference=Place(*system_of("EPSG:28992").to_lonlat((85_005, 446_990)), 0.0)
)
JUNK = (
    b"",
    b"0",
    b"-",
    b"]",
    b"[",
    b"{",
    b"}",
    b'"',
    b"null",
    b"1e999",
    b"NaN",
    b",",
    b"\x00",
    b"\xff\xfe",
    b"\xc3\xa9",
)


def square(**properties):
    ring = [[4.3601, 52.0101], [4.3606, 52.0101], [4.3606, 52.0104], [4.3601, 52.0104], [4.3601, 52.0101]]
    return {"type": "Feature", "properties": properties, "geometry": {"type": "Polygon", "coordinates": [ring]}}


def road():
    line = {"type": "LineString", "coordinates": [[4.3601, 52.0101], [4.3606, 52.0104]]}
    return {"type": "Feature", "properties": {"highway": "primary", "lanes": "2"}, "geometry": line}


def collection(*features):
    return json.dumps({"type": "FeatureCollection", "features": features}).encode()


def grid():
    head = "ncols 4\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 5\nNODATA_value -9999\n"
    return (head + "1 2 3 4\n2 3 -9999 5\n3 4 5 6\n").encode()


def raster(tmp_path):
    path = tmp_path / "whole.tif"
    heights = np.arange(12.0, dtype=np.float32).reshape(3, 4)
    shape = {"height": 3, "width": 4, "count": 1, "dtype": "float32"}
    with rasterio.open(
        path, "w", driver="GTiff", crs="EPSG:28992", transform=Affine(5, 0, 85_000, 0, -5, 447_000), **shape
    ) as file:
        file.write(heights, 1)
    return path.read_bytes()


def hours():
    rows = "\n".join(f"2026-01-0{day} 12:00,{4 + day},{200 + day},{0.1 * day},{10 - day}" for day in range(1, 7))
    return f"time,wind_speed [m/s],wind_from [deg],rain [mm/h],temperature [C]\n{rows}\n".encode()


READERS = {
    "voxels.3dmap": (lambda _: b"voxel 4 5 6\n0 0 0\n1 2 3\n3 4 5\n", read_voxels),
    "town.geojson": (lambda _: collection(square(height=9)), lambda path: read_city(path, cell=10.0)),
    "zones.geojson": (lambda _: collection(square(lower=0, upper=60)), lambda path: read_no_fly(path, TOWN)),
    "streets.geojson": (lambda _: collection(road(), square(landuse="forest")), lambda path: osm_layers(TOWN, path)),
    "hills.asc": (lambda _: grid(), read_terrain),
    "hills.tif": (raster, read_terrain),
    "people.asc": (lambda _: grid(), lambda path: read_people(TOWN, path, crs="local", elsewhere=0.01)),
    "people.tif": (raster, lambda path: read_people(DUTCH, path, elsewhere=0.01)),
    "hours.csv": (lambda _: hours(), read_weather),
}


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", READERS)
def test_the_whole_file_is_read(name, tmp_path):
    make, read = READERS[name]
    path = tmp_path / name
    path.write_bytes(make(tmp_path))
    assert read(path) is not None


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("name", READERS)
def test_only_value_errors_come_out_of_files_that_were_changed(name, seed, tmp_path):
    make, read = READERS[name]
    whole, rng = make(tmp_path), np.random.default_rng([seed, len(name)])
    path = tmp_path / name
    refused = 0
    for _ in range(40):
        at, junk = int(rng.integers(len(whole))), JUNK[rng.integers(len(JUNK))]
        path.write_bytes(whole[:at] + junk + whole[at + int(rng.integers(4)) :])
        refused += refuses(read, path)
    for length in (0, 1, len(whole) // 2, len(whole) - 1):
        path.write_bytes(whole[:length])
        refused += refuses(read, path)
    assert refused > 5


def refuses(read, path):
    """Whether a reader raises a ValueError; anything else comes through."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            read(path)
        except ValueError:
            return True
    return False
