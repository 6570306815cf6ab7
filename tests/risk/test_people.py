"""People from files as the world has them: windows of large ones, no data, other systems, and what is refused."""

import numpy as np
import pytest
import rasterio
from rasterio.transform import Affine

from uavlab.city import City, Place
from uavlab.city.place import system_of
from uavlab.risk import RiskMap, raster_layer, read_people

CITY = City(np.zeros((40, 30, 5), bool), 10.0, reference=Place(4.36, 52.01, 0.0))  # 400 × 300 m
HEAD = "ncols {} \nnrows {}\nxllcorner {}\nyllcorner {}\ncellsize {}\nNODATA_value -9999\n"


def tiff(path, values, corner, pixel, crs, nodata=None, turned=0.0, count=1):
    """A GeoTIFF whose north-west corner is given."""
    rows, columns = values.shape
    shape = {"height": rows, "width": columns, "count": count, "dtype": "float32", "nodata": nodata}
    grid = Affine(pixel, turned, corner[0], 0, -pixel, corner[1])
    with rasterio.open(path, "w", driver="GTiff", crs=crs, transform=grid, **shape) as file:
        for band in range(count):
            file.write(values.astype(np.float32), band + 1)
    return path


@pytest.fixture
def mollweide(tmp_path):
    """As GHS-POP has it: 100 m in Mollweide, here 3000 × 3000 pixels with the city somewhere in the middle."""
    x, y = system_of("ESRI:54009").from_lonlat(np.array([4.36, 52.01]))
    values = np.full((3000, 3000), 50.0)
    values[:1000] = -200.0
    return tiff(tmp_path / "GHS_POP.tif", values, (x - 150_000, y + 150_000), 100.0, "ESRI:54009", -200.0)


def test_a_tile_of_ghs_pop_is_read_around_the_city_only(mollweide, monkeypatch):
    sizes = []
    monkeypatch.setattr(
        "uavlab.risk.people.raster_layer", lambda *a, **k: sizes.append(a[1].size) or raster_layer(*a, **k)
    )
    people = read_people(CITY, mollweide)
    assert max(sizes) < 200
    assert 1e6 * people.density == pytest.approx(np.full((40, 30), 5000.0), rel=0.02)  # Mollweide keeps areas
    assert "people on the map, from pixels of about" in people.source.of("taken")[0].what
    assert "54009" in people.source.of("derived")[0].what or "Mollweide" in people.source.of("derived")[0].what
    assert people.source.of("assumed") == ()
    assert RiskMap(CITY, people.density, 0.0).rate.min() > 0


def test_worldpop_in_degrees_keeps_its_people(tmp_path):
    second = 1 / 1200  # 3 arc seconds
    values = np.random.default_rng(1).uniform(0, 90, (40, 40))
    path = tiff(tmp_path / "nld.tif", values, (4.345, 52.025), second, "EPSG:4326", -99999.0)
    people = read_people(CITY, path)
    bounds = (4.345, 52.025 - 40 * second, 4.345 + 40 * second, 52.025)
    expected = raster_layer(CITY, values.astype(np.float32), bounds, crs="EPSG:4326", per="pixel")
    assert np.allclose(people.density, expected, rtol=1e-6)
    assert f"{people.density.sum() * 100:,.0f} people on the map" in str(people.source)


def test_where_the_file_says_nothing_the_density_given_counts(tmp_path):
    second = 1 / 1200
    values = np.full((40, 40), 60.0)
    values[:, 20:] = -99999.0  # no data
    values[17:, :20] = -3.0  # undeclared
    path = tiff(tmp_path / "nld.tif", values, (4.345, 52.025), second, "EPSG:4326", -99999.0)
    with pytest.raises(
        ValueError, match=r"nld.tif says nothing about \d+ of the city's 1200 columns.*say with elsewhere"
    ):
        read_people(CITY, path)
    people = read_people(CITY, path, elsewhere=0.02)
    assert people.density[-1, -1] == pytest.approx(0.02)
    assert people.density[0, -1] < 0.02
    assert people.source.count("assumed") > 100
    assert people.source.count("derived", "below 0") > 0
    assert (read_people(CITY, path, elsewhere=0.0).density <= people.density).all()


def test_an_ascii_grid_in_degrees_by_its_prj_or_in_metres_of_the_city(tmp_path):
    path = tmp_path / "people.asc"
    path.write_text(HEAD.format(2, 1, 4.355, 52.005, 0.01) + "100 200\n")
    degrees = read_people(CITY, path)
    assert "4326" in str(degrees.source) or "CRS84" in str(degrees.source)
    path.with_suffix(".prj").write_text("EPSG:4326")
    assert np.allclose(read_people(CITY, path).density, degrees.density)
    path.write_text(HEAD.format(1, 1, -100, -100, 1000) + "9000\n")
    local = read_people(CITY, path, crs="local")
    assert local.density == pytest.approx(np.full((40, 30), 0.009))
    assert read_people(CITY, path, crs="local", per="km²").density[0, 0] == pytest.approx(0.009)
    nowhere = City(CITY.occupied, 10.0)
    assert np.allclose(read_people(nowhere, path, crs="local").density, local.density)


@pytest.mark.parametrize(
    ("corner", "options", "words"),
    [
        ((5.0, 52.025), {}, "nld.tif doesn't reach the city: is it the tile of that place"),
        ((4.345, 52.025), {"turned": 1e-4}, "nld.tif doesn't say where it lies, or is turned"),
        ((4.345, 52.025), {"count": 2}, "nld.tif has 2 bands, expected one, of people"),
    ],
)
def test_what_is_wrong_with_a_geotiff_is_said(tmp_path, corner, options, words):
    path = tiff(tmp_path / "nld.tif", np.ones((40, 40)), corner, 1 / 1200, "EPSG:4326", **options)
    with pytest.raises(ValueError, match=words):
        read_people(CITY, path)


def test_wrong_questions_are_refused_with_words(tmp_path, mollweide):
    path = tmp_path / "people.asc"
    path.write_text(HEAD.format(2, 1, 14.355, 52.005, 0.01) + "100 200\n")
    with pytest.raises(ValueError, match=r"people.asc: bounds must lie around the city"):
        read_people(CITY, path)
    with pytest.raises(ValueError, match="per must be one of"):
        read_people(CITY, path, per="mile")
    with pytest.raises(ValueError, match="elsewhere must be finite and at least 0"):
        read_people(CITY, path, elsewhere=-1.0)
    with pytest.raises(ValueError, match="city"):
        read_people(path, path)
    with pytest.raises(ValueError, match="reference"):
        read_people(City(CITY.occupied, 10.0), mollweide)
    with pytest.raises(ValueError, match="is no reference system"):
        read_people(CITY, mollweide, crs="EPSG:0")
    path.write_text("people")
    with pytest.raises(ValueError, match=r"people\.asc"):
        read_people(CITY, path)
    with pytest.raises(FileNotFoundError):
        read_people(CITY, tmp_path / "none.tif")
    nameless = tiff(tmp_path / "nameless.tif", np.ones((4, 4)), (4.3, 52.1), 0.05, None)
    with pytest.raises(ValueError, match="names no reference system"):
        read_people(CITY, nameless)
    assert read_people(CITY, nameless, crs="EPSG:4326").density.min() > 0
