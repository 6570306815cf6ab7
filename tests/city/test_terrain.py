import numpy as np
import pyproj
import pytest
import shapely

from uavlab.city import Building, City
from uavlab.city.place import Place, system_of
from uavlab.city.rasterise import range_of_ground
from uavlab.city.terrain import MOST_PIXELS, Terrain, ground_and_top


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


def highest_by_clipping(corners, column):
    """The highest point of triangles (T, 3, 3) over a shapely box: at a corner of what is left of one."""
    highest = -np.inf
    for triangle in corners[shapely.intersects(shapely.polygons(corners[..., :2]), column)]:
        piece = shapely.Polygon(triangle[:, :2]).intersection(column)
        slope = np.linalg.solve(triangle[1:, :2] - triangle[0, :2], triangle[1:, 2] - triangle[0, 2])
        at = shapely.get_coordinates(piece) - triangle[0, :2]
        highest = max(highest, (triangle[0, 2] + at @ slope).max(initial=-np.inf))
    return highest


@pytest.mark.parametrize("cell", [0.7, 2.0, 5.0])
def test_top_is_the_highest_point_anywhere_in_the_column(cell):
    rng = np.random.default_rng(4)
    terrain = Terrain.from_points(np.column_stack([rng.uniform(-10, 50, (300, 2)), rng.uniform(0, 30, 300)]))
    shape = (int(30 / cell), int(20 / cell), 1)
    ground, top = ground_and_top(terrain, np.zeros(3), cell, shape)
    corners, even = terrain.points[terrain.triangles], range_of_ground(ground)[1]
    for i, j in np.ndindex(shape[:2]):
        exact = highest_by_clipping(corners, shapely.box(i * cell, j * cell, (i + 1) * cell, (j + 1) * cell))
        assert top[i, j] == pytest.approx(max(exact, even[i, j]), abs=2e-3)  # slopes of 1000 over 1e-6 m
    assert (top >= ground - 1e-6).all()


def test_top_of_a_plane_and_a_bowl_in_closed_form():
    shape, x, y = (40, 30, 1), 2.0 * np.arange(41) + 5, 2.0 * np.arange(31) + 5
    ground, top = ground_and_top(Terrain.from_raster(*raster_of(plane)), np.array([5.0, 5, 0]), 2.0, shape)
    assert ground == pytest.approx(plane(*np.meshgrid(x[:-1] + 1, y[:-1] + 1, indexing="ij")), abs=1e-9)
    assert top == pytest.approx(plane(*np.meshgrid(x[1:], y[:-1], indexing="ij")), abs=1e-5)  # its south-east corner
    _, top = ground_and_top(Terrain.from_raster(*raster_of(bowl)), np.array([5.0, 5, 0]), 2.0, shape)
    corners = bowl(*np.meshgrid(x, y, indexing="ij"))
    highest = np.max([corners[:-1, :-1], corners[1:, :-1], corners[:-1, 1:], corners[1:, 1:]], axis=0)
    assert (
        np.abs(top - highest).max() < 0.0401
    )  # 0.02 its triangles above the bowl, 0.02 the chords between columns' centres


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


def test_a_hole_smaller_than_a_column_is_one():
    heights, bounds = raster_of(plane, pixel=0.5)
    heights[44, 61] = np.nan  # at (30.75, 57.75), no centre of a column
    with pytest.raises(ValueError, match=r"nothing about 1 of the map's 320 columns, .* at \(32\.5, 57\.5\)"):
        ground_and_top(Terrain.from_raster(heights, bounds), np.zeros(3), 5.0, (20, 16, 1))


def test_a_map_that_ends_within_the_outer_pixels_is_covered():
    heights, bounds = raster_of(plane, pixel=10.0)
    ground, _ = ground_and_top(Terrain.from_raster(heights, bounds), np.zeros(3), 2.0, (50, 40, 1))
    assert ground[0, 0] == pytest.approx(plane(5, 5))
    with pytest.raises(ValueError, match="nothing about 40 of the map's 2040 columns"):
        ground_and_top(Terrain.from_raster(heights, bounds), np.zeros(3), 2.0, (51, 40, 1))


def test_a_gap_is_bridged_between_its_rims_and_what_stands_in_it():
    """Two level banks 10 m high, a gap of 40 m, and in the middle of it one point, 25 m high."""
    banks = np.array([(x, y, 10.0) for x in (0, 30, 70, 100) for y in (0, 100)])
    triangles = [(0, 2, 1), (2, 3, 1), (4, 6, 5), (6, 7, 5)]
    gap = Terrain(banks, triangles)
    assert np.isnan(gap.heights_at([(50, 50)])).all()
    assert gap.filled().heights_at([(50, 50), (10, 10)]) == pytest.approx([10, 10])
    tower = Terrain(np.vstack([banks, (50.0, 52.0, 25.0)]), triangles, beyond="nearest")
    ground, top = ground_and_top(tower, np.zeros(3), 10.0, (10, 10, 1))
    assert top[5, 5] == pytest.approx(25)  # off its column's centre
    assert ground[5, 5] < 25
    assert top[:2] == pytest.approx(10)
    assert (top >= ground).all()


def test_large_holes_are_filled_as_the_surface_around_them_goes():
    heights, bounds = raster_of(bowl, pixel=1.0)
    heights[10:20, 30:60] = np.nan
    filled = Terrain.from_raster(heights, bounds).filled()
    x, y = np.meshgrid(np.arange(32.0, 58.0), np.arange(62.0, 69.0))
    known = filled.heights_at(np.column_stack([x.ravel(), y.ravel()]))
    assert np.abs(known - bowl(x, y).ravel()).max() < 0.01 * 11**2 / 4 * 2  # over chords of 11 m


@pytest.mark.parametrize("count", [1, 2, 50_000])
def test_heights_are_the_same_however_many_are_asked_for(count):
    rng = np.random.default_rng(1)
    points = np.column_stack([rng.uniform(-10, 50, (300, 2)), rng.uniform(0, 30, 300)])
    terrain = Terrain.from_points(points)
    places = rng.uniform(0, 40, (count, 2))
    found = terrain.heights_at(places)
    for place, height in zip(places[:50], found, strict=False):
        assert terrain.heights_at([place]) == pytest.approx([height], abs=1e-9)
    at = terrain.points[:, :2]
    assert terrain.heights_at(at) == pytest.approx(terrain.points[:, 2])  # corners, the hull's too
    assert terrain.heights_at(np.empty((0, 2))).shape == (0,)


def test_a_valley_far_below_the_town_is_ground_too():
    heights = np.array([[3600.0, 3500.0], [2900.0, 2800.0]])
    terrain = Terrain.from_raster(heights, (565_000, 5_934_000, 566_000, 5_935_000), crs="EPSG:25832")
    place = Place(*terrain.system.to_lonlat([565_500, 5_934_500]), height=3500.0)
    assert terrain.placed(place).points[:, 2].min() == pytest.approx(-700)


def test_a_raster_that_doesnt_cover_the_map_says_what_is_missing():
    terrain = Terrain.from_raster(*raster_of(plane))
    box = Building.prism([(90, 10), (97, 10), (97, 15), (90, 15)], 60.0, bottom=40)
    with pytest.raises(ValueError, match=r"x 0\.0 to 100\.0, y 0\.0 to 80\.0 m, the map over x 70\.0 to 117\.0"):
        City.from_buildings([box], terrain=terrain)
    city = City.from_buildings([box], terrain=terrain.filled())
    assert city.height_above_ground((115.0, 20.0, 60.0)) == pytest.approx(60 - plane(99.5, 20.0), abs=0.2)


def topocentric_by_pyproj(code, place, xy):
    """East and north (N, 2) [m] of coordinates (N, 2) in a system, straight from pyproj."""
    lon, lat = pyproj.Transformer.from_crs(code, "EPSG:4326", always_xy=True).transform(*np.transpose(xy))
    east, north, _ = pyproj.Transformer.from_pipeline(
        "+proj=pipeline +step +proj=unitconvert +xy_in=deg +xy_out=rad +step +proj=cart +ellps=WGS84 +step "
        f"+proj=topocentric +ellps=WGS84 +lon_0={place.longitude} +lat_0={place.latitude} +h_0={place.height}"
    ).transform(lon, lat, np.full(len(xy), place.height))
    return np.column_stack([east, north])


@pytest.mark.parametrize("code", ["EPSG:25832", "EPSG:2263"])
def test_a_raster_in_a_reference_system_is_placed(code):
    system = system_of(code)
    corner = np.array({"EPSG:25832": (565_000.0, 5_934_000.0), "EPSG:2263": (981_000.0, 195_000.0)}[code])
    heights, bounds = raster_of(lambda x, y: 100 + 0.02 * x, (0, 0, 600, 500), 10.0)
    terrain = Terrain.from_raster(heights, [*(corner + bounds[:2]), *(corner + bounds[2:])], crs=code)
    place = Place(*system.to_lonlat(corner + 250), height=12.0)
    placed = terrain.placed(place)
    there = np.random.default_rng(0).uniform(20, 480, (100, 2))
    local = topocentric_by_pyproj(code, place, corner + there)
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
        (lambda: Terrain.from_raster([[1, np.inf]], (0, 0, 1, 1)), "heights must not be infinite, 1 are"),
        (lambda: Terrain.from_raster(np.ma.array([["a"]]), (0, 0, 1, 1)), "heights must be a number or an array"),
        (lambda: Terrain.from_raster([[1, -999.0]], (0, 0, 1, 1)), "heights on Earth, -500 to 9000 m, got -999"),
        (lambda: Terrain.from_raster([[1, -9999.0]], (565e3, 5934e3, 566e3, 5935e3), crs=25832), "got -9999"),
        (lambda: Terrain.from_points([(1, 2, -9999)]), "heights on Earth, -9500 to 9500 m, got -9999"),
        (lambda: Terrain.from_raster([[1.0]], (-74, 40, -73.9999, 40.0001)), r"in degrees they need crs='EPSG:4326'"),
        (lambda: Terrain.from_raster([[1.0]], (8, 50, 9, 51), crs=25832), "they look like degrees: give crs='EPSG"),
        (lambda: Terrain.from_raster([[1.0]], (565e3, 5934e3, 566e3, 5935e3), crs=4326), "are no degrees, but EPSG"),
        (lambda: Terrain.from_raster(np.empty((1, MOST_PIXELS + 1)), (0, 0, 9e9, 1)), "cut it to the city first"),
        (lambda: Terrain.from_raster([[1.0]], (0, 0, 1, 1), crs="EPSG:1"), "no reference system that pyproj knows"),
        (lambda: Terrain.from_raster([["a"]], (0, 0, 1, 1)), "heights must be a number or an array of numbers"),
        (lambda: Terrain.from_points([(1, 2)]), r"points must have shape \(N, 3\)"),
        (lambda: Terrain.from_points([(1, 2, np.inf)]), "must be finite"),
        (lambda: Terrain([(0, 0, 0)], [(0, 1, 2)]), "triangles must be numbers of points, 0 to 0, got 1"),
        (lambda: Terrain([(0, 0, 0)], [(0, 0, -1)]), "triangles must be numbers of points, 0 to 0, got -1"),
        (lambda: Terrain([(0, 0, 0)], [(0, 0.5, 0)]), "triangles must be whole numbers, got 0.5"),
        (lambda: Terrain([(0, 0, 0)], [], system="EPSG:25832"), "system must be a System, got str"),
        (lambda: Terrain.from_grid([[0, 1]]), r"grid must have shape \(N, M, 3\), got \(1, 2\)"),
        (lambda: Terrain.from_points([(1, 2, 3)]).placed("Delft"), "place must be a number .* got text"),
        (lambda: Terrain([(0, 0, 0)], [(0, 0)]), r"triangles must have shape \(T, 3\), got \(1, 2\)"),
        (lambda: Terrain([(0, 0, 0)], [], beyond="ever"), "beyond must be one of 'refuse', 'nearest', got 'ever'"),
        (lambda: Terrain.from_points([(1, 2, 3)]).heights_at([1, 2]), r"places must be finite and have shape \(N, 2\)"),
        (lambda: City(np.zeros((2, 2, 2)), ground=[[0, 1]]), r"one finite height for each column \(2, 2\)"),
        (lambda: City(np.zeros((2, 2, 2)), ground=[[0, 1], [np.nan, 1]]), "with 1 that are NaN or infinite"),
    ],
)  # fmt: skip
def test_what_is_no_ground_is_refused(make, message):
    with pytest.raises(ValueError, match=message):
        make()
