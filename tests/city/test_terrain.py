import numpy as np
import pytest

from uavlab.city import Building, City
from uavlab.city.place import Place, system_of
from uavlab.city.terrain import Terrain, ground_and_top


def plane(x, y):
    return 20 + 0.3 * x - 0.1 * y


def bowl(x, y):
    return 0.01 * ((x - 50) ** 2 + (y - 40) ** 2)


def raster_of(surface, bounds=(0.0, 0.0, 100.0, 80.0), pixel=2.0):
    west, south, east, north = bounds
    x, y = np.arange(west + pixel / 2, east, pixel), np.arange(north - pixel / 2, south, -pixel)
    return surface(*np.meshgrid(x, y)), bounds


def test_a_raster_is_even_between_the_centres_of_its_pixels():
    terrain = Terrain.from_raster(*raster_of(plane))
    places = np.random.default_rng(0).uniform((1, 1), (99, 79), (5000, 2))
    assert terrain.heights_at(places) == pytest.approx(plane(*places.T), abs=1e-9)
    curved = Terrain.from_raster(*raster_of(bowl)).heights_at(places)
    assert np.abs(curved - bowl(*places.T)).max() < 0.01 * 2 * 2  # (step/2)²·(1/50 per axis)/2, twice
    assert np.isnan(terrain.heights_at([(-0.1, 40.0), (100.1, 40.0)])).all()
    assert terrain.heights_at([(0.2, 41.0)]) == pytest.approx(plane(1.0, 41.0))  # constant in the outer half pixel


@pytest.mark.parametrize("cell", [0.7, 2.0, 5.0])
def test_top_is_the_highest_point_anywhere_in_the_column(cell):
    rng = np.random.default_rng(4)
    points = np.column_stack([rng.uniform(-10, 50, (300, 2)), rng.uniform(0, 30, 300)])
    terrain = Terrain.from_points(points)
    shape = (int(30 / cell), int(20 / cell), 1)
    ground, top = ground_and_top(terrain, np.zeros(3), cell, shape)
    offsets = (np.arange(12) + 0.5) / 12 * cell
    for i, j in np.ndindex(shape[:2]):
        fine = np.stack(np.meshgrid(i * cell + offsets, j * cell + offsets), axis=-1).reshape(-1, 2)
        heights = terrain.heights_at(fine)
        inside = points[
            ((points[:, :2] > (i * cell, j * cell)) & (points[:, :2] < ((i + 1) * cell, (j + 1) * cell))).all(1)
        ]
        assert top[i, j] >= max(heights.max(), inside[:, 2].max(initial=-1)) - 1e-6
        assert top[i, j] <= max(heights.max(), inside[:, 2].max(initial=-1)) + 40 * cell / 12 + 1
    assert (top >= ground - 1e-6).all()


def test_a_peak_narrower_than_a_column_is_not_lost():
    corners = [(0, 0, 0), (100, 0, 0), (100, 100, 0), (0, 100, 0)]
    foot = [(52, 52, 0), (53, 52, 0), (53, 53, 0), (52, 53, 0)]
    points = np.array([*corners, *foot, (52.5, 52.5, 40.0)], float)
    city = City.from_buildings(
        [], terrain=Terrain.from_points(points), cell=5.0, origin=(0, 0, -5), size=(100, 100, 60)
    )
    assert not city.is_free((52.5, 52.5, 38.0))
    assert city.is_free((67.5, 52.5, 3.0))
    assert city.ground[10, 10] == pytest.approx(40.0)


def test_ground_goes_on_beyond_points_as_at_the_nearest():
    terrain = Terrain.from_points([(0, 0, 1.0), (10, 0, 1.0), (0, 10, 3.0), (10, 10, 3.0)])
    assert terrain.heights_at([(5, 5), (5, 15), (-7, 0), (30, 30)]).tolist() == [2, 3, 1, 3]
    assert Terrain.from_points([(3, 4, 5.0)]).heights_at([(0, 0), (99, 9)]).tolist() == [5, 5]
    on_a_line = Terrain.from_points([(0, 0, 1.0), (10, 0, 2.0), (20, 0, 3.0)])
    assert on_a_line.heights_at([(1, 5), (19, -5)]).tolist() == [1, 3]


def test_holes_are_refused_or_filled():
    heights, bounds = raster_of(plane)
    heights[10:14, 20:23] = np.nan
    masked = np.ma.masked_invalid(heights)
    masked.data[masked.mask] = 65535.0
    for values in (heights, masked):
        terrain = Terrain.from_raster(values, bounds)
        with pytest.raises(ValueError, match=r"nothing about \d+ of the map's 2000 columns, .*filled\(\)"):
            ground_and_top(terrain, np.zeros(3), 2.0, (50, 40, 1))
        ground, _ = ground_and_top(terrain.filled(), np.zeros(3), 2.0, (50, 40, 1))
        x, y = np.meshgrid(2.0 * np.arange(50) + 1, 2.0 * np.arange(40) + 1, indexing="ij")
        assert ground == pytest.approx(plane(x, y), abs=1e-6)


def test_a_raster_that_doesnt_cover_the_map_says_what_is_missing():
    terrain = Terrain.from_raster(*raster_of(plane))
    box = Building.prism([(90, 10), (97, 10), (97, 15), (90, 15)], 60.0, bottom=40)
    with pytest.raises(ValueError, match=r"x 0\.0 to 100\.0, y 0\.0 to 80\.0 m, the map over x 70\.0 to 117\.0"):
        City.from_buildings([box], terrain=terrain)
    city = City.from_buildings([box], terrain=terrain.filled())
    assert city.height_above_ground((115.0, 20.0, 60.0)) == pytest.approx(60 - plane(99.5, 20.0), abs=0.2)


@pytest.mark.parametrize("code", ["EPSG:25832", "EPSG:2263"])
def test_a_raster_in_a_reference_system_is_placed(code):
    system = system_of(code)
    corner = np.array({"EPSG:25832": (565_000.0, 5_934_000.0), "EPSG:2263": (981_000.0, 195_000.0)}[code])
    heights, bounds = raster_of(lambda x, y: 100 + 0.02 * x, (0, 0, 600, 500), 10.0)
    terrain = Terrain.from_raster(heights, [*(corner + bounds[:2]), *(corner + bounds[2:])], crs=code)
    place = Place(*system.to_lonlat(corner + 250), height=12.0)
    placed = terrain.placed(place)
    there = np.random.default_rng(0).uniform(20, 480, (100, 2))
    local = place.east_north(system.to_lonlat(corner + there))
    expected = (100 + 0.02 * there[:, 0]) * system.height_factor - 12.0
    assert placed.heights_at(local) == pytest.approx(expected, abs=1e-4)
    with pytest.raises(ValueError, match="doesn't know its place on Earth"):
        terrain.placed(None)
    with pytest.raises(ValueError, match=r"use terrain.placed\(place\) first"):
        ground_and_top(terrain, np.zeros(3), 1.0, (3, 3, 3))


def test_ground_is_solid_for_clearance_and_falls():
    hill = Terrain.from_raster(*raster_of(lambda x, y: 0.5 * x))
    city = City.from_buildings([], terrain=hill, origin=(2, 2, -1), size=(90, 70, 80))
    below = city.center_of(np.argwhere(city.occupied))
    assert (city.height_above_ground(below) < 1.0).all()
    free = city.center_of(np.argwhere(~city.occupied))
    assert (city.height_above_ground(free - [0, 0, 0.5]) >= -1e-6).all()
    index = tuple(city.cell_of((50.5, 40.5, 60.5)))
    assert city.height_above_surface[index] == pytest.approx(city.center_of(index)[2] - 0.5 * 51.0, abs=1e-5)
    assert city.clearance[index] < 60.5 - 25
    assert city.building_at((50.5, 40.5, 3.0)) == "the ground"


def test_a_city_of_level_ground_begins_a_layer_below_it():
    city = City.from_buildings([Building.prism([(0, 0), (8, 0), (8, 8)], 9.0)], cell=2.0, terrain=0.0)
    assert city.bounds[0].tolist() == [-20, -20, -2]
    assert city.occupied[:, :, 0].all()
    assert city.occupied[0, 0].tolist() == [True] + [False] * (city.shape[2] - 1)
    assert city.clearance[0, 0, 5] == pytest.approx(9.0)
    assert city.blocked(min_height=3.0)[0, 0].tolist()[:4] == [True, True, False, False]  # centres at −1, 1, 3, 5 m
    assert City.from_buildings(city.buildings, cell=2.0).ground is None


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Terrain.from_raster([1.0, 2.0], (0, 0, 1, 1)), r"heights must have shape \(rows, col"),
        (lambda: Terrain.from_raster([[1.0]], (0, 0, 0, 1)), r"bounds must be \(west, south, east, north\)"),
        (lambda: Terrain.from_raster([[np.nan]], (0, 0, 1, 1)), "heights have no data at all"),
        (lambda: Terrain.from_raster([[1, -9999.0]], (0, 0, 1, 1)), "heights on Earth, .* got -9999, .* make it NaN"),
        (lambda: Terrain.from_raster([[1, 3.4e38]], (0, 0, 1, 1)), "heights on Earth"),
        (lambda: Terrain.from_raster([[1.0]], (0, 0, 1, 1), crs="EPSG:1"), "no reference system that pyproj knows"),
        (lambda: Terrain.from_raster([["a"]], (0, 0, 1, 1)), "heights must be a number or an array of numbers"),
        (lambda: Terrain.from_points([(1, 2)]), r"points must have shape \(N, 3\)"),
        (lambda: Terrain.from_points([(1, 2, np.inf)]), "must be finite"),
        (lambda: Terrain([(0, 0, 0)], [(0, 1, 2)]), "triangles must be numbers of points, 0 to 0, got 2"),
        (lambda: Terrain([(0, 0, 0)], [], beyond="ever"), "beyond must be one of 'refuse', 'nearest', got 'ever'"),
        (lambda: Terrain.from_points([(1, 2, 3)]).heights_at([1, 2]), r"places must be finite and have shape \(N, 2\)"),
        (lambda: City(np.zeros((2, 2, 2)), ground=[[0, 1]]), r"one finite height for each column \(2, 2\)"),
        (lambda: City(np.zeros((2, 2, 2)), ground=[[0, 1], [np.nan, 1]]), "with 1 that are NaN or infinite"),
    ],
)  # fmt: skip
def test_what_is_no_ground_is_refused(make, message):
    with pytest.raises(ValueError, match=message):
        make()
