"""Layers: orientation of rasters, area of roads, classes of shelter, and each way of asking wrongly."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import assume, given
from hypothesis import strategies as st

from uavlab.city import Building, City
from uavlab.city.place import Place
from uavlab.city.terrain import Terrain
from uavlab.risk import POPULATION_DENSITY, RiskMap, raster_layer, road_layer, shelter_layer, vehicle_share
from uavlab.risk.layers import column_centers

CITY = City(np.zeros((4, 3, 2), bool), cell=10.0, origin=(100, -20, 5))  # x 100 to 140, y −20 to 10
BOUNDS = (100, -20, 140, 10)
DELFT = (4.36, 52.01)
FIELD = City(np.zeros((40, 30, 1), bool), cell=2.5, name="field", reference=DELFT)  # 100 × 75 m
SHARE = float(vehicle_share())


def radii_of_curvature(lat):
    """Of the meridian and of the prime vertical on WGS84 [m]."""
    a, e2 = 6378137.0, 0.00669437999014
    w = 1 - e2 * np.sin(np.radians(lat)) ** 2
    return a * (1 - e2) / w**1.5, a / np.sqrt(w)


def degrees(points, reference=DELFT):
    """Longitude and latitude of points (M, 2) [m] by the radii of curvature, good to a millimetre in a town."""
    meridian, normal = radii_of_curvature(reference[1])
    x, y = np.transpose(points).astype(float)
    lon = reference[0] + np.degrees(x / (normal * np.cos(np.radians(reference[1]))))
    return np.column_stack([lon, reference[1] + np.degrees(y / meridian)])


def area_of_cars(city, layer):
    return layer.sum() * city.cell**2


def test_centres_of_columns():
    at = column_centers(CITY)
    assert at.shape == (4, 3, 2)
    assert at[0, 0].tolist() == [105, -15]
    assert at[3, 1].tolist() == [135, -5]


def test_first_row_of_a_raster_lies_in_the_north_and_the_first_column_in_the_west():
    raster = np.array([[1, 2, 3, 4], [5, 6, 7, 8], [9, 10, 11, 12]])  # as printed: north up
    layer = raster_layer(CITY, raster, BOUNDS)
    assert layer.shape == (4, 3)
    assert layer[0, 2] == 1  # north-west
    assert layer[3, 2] == 4  # north-east
    assert layer[0, 0] == 9  # south-west
    assert layer[3, 0] == 12
    assert np.array_equal(layer, raster[::-1].T)


@pytest.mark.parametrize("seed", range(10))
def test_each_column_has_the_mean_of_the_pixels_on_it(seed):
    rng = np.random.default_rng(seed)
    raster = rng.random(rng.integers(1, 12, 2))
    west, north = 100 - rng.uniform(0, 30), 10 + rng.uniform(0, 30)
    east, south = 140 + rng.uniform(0, 30), -20 - rng.uniform(0, 30)
    layer = raster_layer(CITY, raster, (west, south, east, north))
    wide, tall = (east - west) / raster.shape[1], (north - south) / raster.shape[0]
    for i, j in np.ndindex(4, 3):
        column = shapely.box(100 + 10 * i, -20 + 10 * j, 110 + 10 * i, -10 + 10 * j)
        mean = 0.0
        for r, c in np.ndindex(raster.shape):
            pixel = shapely.box(west + c * wide, north - (r + 1) * tall, west + (c + 1) * wide, north - r * tall)
            mean += raster[r, c] * column.intersection(pixel).area / 100
        assert layer[i, j] == pytest.approx(mean, rel=1e-9)


@pytest.mark.parametrize("per", ["pixel", "km²", "m²"])
@pytest.mark.parametrize("pixel", [1.7, 7.0, 60.0])
def test_people_of_a_raster_are_all_on_the_map_and_none_twice(per, pixel):
    rng = np.random.default_rng(2)
    counts = rng.integers(0, 50, (int(120 / pixel) + 1, int(150 / pixel) + 1))
    bounds = (-10.0, -5.0, -10 + pixel * counts.shape[1], -5 + pixel * counts.shape[0])
    areas = {"pixel": 1.0, "km²": pixel**2 / 1e6, "m²": pixel**2}[per]
    layer = raster_layer(FIELD, counts, bounds, per=per)
    expected = 0.0
    for r, c in np.ndindex(counts.shape):
        box = shapely.box(
            bounds[0] + c * pixel, bounds[3] - (r + 1) * pixel, bounds[0] + (c + 1) * pixel, bounds[3] - r * pixel
        )
        expected += counts[r, c] * areas * box.intersection(shapely.box(0, 0, 100, 75)).area / pixel**2
    assert layer.sum() * FIELD.cell**2 == pytest.approx(expected, rel=1e-9)


def test_people_of_a_raster_in_degrees_and_in_feet_are_all_on_the_map():
    (west, south), (east, north) = degrees([(-20, -20), (120, 95)])
    counts = np.random.default_rng(0).integers(0, 9, (23, 31))
    whole = City(np.zeros((90, 80, 1), bool), cell=2.5, origin=(-60, -60, 0), reference=DELFT)
    layer = raster_layer(whole, counts, (west, south, east, north), crs="EPSG:4326", per="pixel", fill=0.0)
    assert area_of_people(whole, layer) == pytest.approx(counts.sum(), rel=1e-6)
    corner = np.array([981_000.0, 195_000.0])
    york = City(np.zeros((60, 60, 1), bool), cell=5.0, origin=(-60, -60, 0), reference=(-74.01172, 40.70191))
    bounds = [*corner, *(corner + np.array([310.0, 230.0]))]
    layer = raster_layer(york, counts, bounds, crs="EPSG:2263", per="pixel", fill=0.0)
    assert area_of_people(york, layer) == pytest.approx(counts.sum(), rel=1e-6)


def area_of_people(city, layer):
    return layer.sum() * city.cell**2


def test_what_is_masked_is_no_data_whatever_stands_below_the_mask():
    city = City(np.zeros((4, 4, 8), bool), cell=50.0)
    per_km2 = np.ma.masked_equal(np.array([[65535, 5000], [65535, 3000]], np.uint16), 65535)
    layer = raster_layer(city, per_km2, (0, 0, 200, 200), per="km²", fill=0.0)
    assert layer[:2].tolist() == [[0.0] * 4] * 2
    assert layer[2:].max() == pytest.approx(5000e-6)
    with pytest.raises(ValueError, match="values say nothing about 8 of the city's 16 columns"):
        raster_layer(city, per_km2, (0, 0, 200, 200))
    assert raster_layer(city, per_km2, (0, 0, 200, 200), fill=7.0)[0, 0] == 7.0


def test_a_large_raster_is_read_where_the_city_is():
    far = City(np.zeros((4, 4, 1), bool), cell=10.0, origin=(50_000, 50_000, 0))
    values = np.add.outer(np.arange(1000.0)[::-1], np.zeros(1000))
    layer = raster_layer(far, values, (0, 0, 100_000, 100_000))
    assert layer == pytest.approx(500.0)


def test_geographic_raster_is_split_where_the_degrees_say():
    (lon, _), (_, lat) = degrees([(50, 0), (0, 30)])
    (west, south), (east, north) = degrees([(-20, -20), (120, 95)])
    in_halves = [2 * lon - east, south, east, north]  # two pixels that meet 50 m east of the reference
    layer = raster_layer(FIELD, [[1.0, 2.0]], in_halves, crs="EPSG:4326")
    assert layer[:20] == pytest.approx(1, abs=1e-3)
    assert layer[20:] == pytest.approx(2, abs=1e-3)
    upright = [west, 2 * lat - north, east, north]
    layer = raster_layer(FIELD, [[1.0], [2.0]], upright, crs="EPSG:4326")
    assert layer[:, :12] == pytest.approx(2, abs=1e-3)  # the second row lies in the south
    assert layer[:, 12:] == pytest.approx(1, abs=1e-3)  # a parallel bends away by 1 mm, of a column of 2.5 m


def test_raster_that_doesnt_cover_the_city_is_refused_unless_there_is_a_fill():
    raster = np.full((2, 2), 0.03)
    small = (100, -20, 120, 10)
    with pytest.raises(ValueError, match=r"nothing about 6 of the city's 12 columns, .* larger raster, or .* fill"):
        raster_layer(CITY, raster, small)
    layer = raster_layer(CITY, raster, small, fill=0.001)
    assert layer[:2] == pytest.approx(0.03)
    assert layer[2:] == pytest.approx(0.001)


def test_degrees_taken_for_metres_are_refused_and_metres_for_degrees():
    """With a fill, too: nothing would be left of the raster, and of a road not a square metre."""
    raster, road = np.full((2, 2), 0.03), [(108.9, 34.2), (108.91, 34.21)]
    for fill in (None, 0.0):
        with pytest.raises(
            ValueError, match=r"bounds must lie around the city, .* m \(in degrees\? say crs='EPSG:4326'"
        ):
            raster_layer(CITY, raster, (-179, -80, -178, -79), fill=fill)
    with pytest.raises(ValueError, match=r"lines\[0\] lies within 0.1 m; in degrees it needs crs='EPSG:4326'"):
        road_layer(CITY, [road], 6.0)
    on_earth = replace(CITY, reference=(108.9, 34.2))
    with pytest.raises(ValueError, match=r"latitudes must be from -90 to 90 degrees .* got 150"):
        raster_layer(on_earth, raster, (0, 0, 150, 150), crs="EPSG:4326")
    with pytest.raises(ValueError, match=r"latitudes must be from -90 to 90 degrees .* got 108.9"):
        road_layer(on_earth, [np.fliplr(road)], 6.0, crs="EPSG:4326")
    with pytest.raises(ValueError, match=r"bounds must lie around the city, .* in EPSG:4326 .*, got"):
        raster_layer(on_earth, raster, (8, 50, 9, 51), crs="EPSG:4326")


def test_names_of_shelter_may_come_as_objects():
    names = np.full(CITY.shape[:2], "sparse trees")
    assert (shelter_layer(CITY, names.astype(object)) == shelter_layer(CITY, names)).all()


def test_nan_in_a_raster_is_no_data():
    raster = np.array([[1, 2, 3, 4], [5, np.nan, 7, 8], [9, 10, 11, 12]])
    with pytest.raises(ValueError, match="values say nothing about 1 of the city's 12 columns"):
        raster_layer(CITY, raster, BOUNDS)
    layer = raster_layer(CITY, raster, BOUNDS, fill=0)
    assert layer[1, 1] == 0
    assert layer.sum() == np.nansum(raster)


def test_whole_numbers_stay_what_they_are_and_the_fill_too():
    layer = raster_layer(CITY, np.full((1, 1), 7, dtype=np.uint8), (100, -20, 130, 10), fill=0.5)
    assert layer[:3].tolist() == [[7.0] * 3] * 3
    assert layer[3].tolist() == [0.5] * 3


inside = st.tuples(st.floats(15, 85), st.floats(15, 60))


@given(inside, inside, st.floats(0.5, 20))
def test_a_road_of_any_direction_keeps_its_area(start, end, width):
    length = np.hypot(*np.subtract(end, start))
    assume(length > 1)
    layer = road_layer(FIELD, [[start, end]], width)
    assert area_of_cars(FIELD, layer) == pytest.approx(width * length * SHARE, rel=1e-9)
    assert (layer >= 0).all()
    assert layer.max() <= SHARE * (1 + 1e-9)


def test_a_narrow_road_on_a_coarse_map_keeps_its_cars():
    coarse = City(np.zeros((4, 3, 1), bool), cell=25.0)
    layer = road_layer(coarse, [[(12.5, 0), (12.5, 75)]], 3.0)
    assert layer[0] == pytest.approx([SHARE * 3 / 25] * 3)
    assert (layer[1:] == 0).all()


def test_a_road_turns_without_losing_or_gaining_area():
    bent = [(20, 20), (60, 20), (60, 50), (40, 60)]
    length = np.linalg.norm(np.diff(bent, axis=0), axis=1).sum()
    assert area_of_cars(FIELD, road_layer(FIELD, [bent], 6.0)) == pytest.approx(6 * length * SHARE, rel=1e-9)


def test_columns_within_a_road_have_the_whole_share():
    layer = road_layer(FIELD, [[(0, 37.5), (100, 37.5)]], 15.0)
    assert layer[:, 12:18] == pytest.approx(SHARE)
    assert (layer[:, :12] == 0).all()
    assert (layer[:, 18:] == 0).all()


def test_a_road_beyond_the_map_is_cut_off():
    layer = road_layer(FIELD, [[(-500, 37.5), (500, 37.5)], [(-50, -50), (-50, 200)]], 5.0)
    assert area_of_cars(FIELD, layer) == pytest.approx(5 * 100 * SHARE)


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_where_roads_overlap_the_busier_counts(order):
    lines, widths, cars = [[(10, 30), (90, 30)], [(50, 10), (50, 70)]], [6.0, 8.0], [5.0, 0.1]
    layer = road_layer(
        FIELD, [lines[n] for n in order], [widths[n] for n in order], cars_per_km=[cars[n] for n in order]
    )
    busy, quiet = vehicle_share(5.0), vehicle_share(0.1)
    assert area_of_cars(FIELD, layer) == pytest.approx(busy * 6 * 80 + quiet * (8 * 60 - 6 * 8), rel=1e-9)
    i, j, _ = FIELD.cell_of((50, 30, 1))
    assert layer[i, j] == pytest.approx(busy)


def test_a_road_drawn_twice_counts_once():
    line = [(10, 10), (80, 60)]
    assert road_layer(FIELD, [line, line, line[::-1]], 7.0) == pytest.approx(road_layer(FIELD, [line], 7.0), abs=1e-12)


@pytest.mark.parametrize("seed", range(5))
def test_roads_cover_what_their_union_covers(seed):
    rng = np.random.default_rng(seed)
    lines = rng.uniform((0, 0), (100, 75), (6, 2, 2))
    widths = rng.uniform(2, 12, 6)
    union = shapely.union_all(
        [
            shapely.LineString(li).buffer(w / 2, cap_style="flat", join_style="round")
            for li, w in zip(lines, widths, strict=True)
        ]
    )
    expected = SHARE * shapely.area(shapely.intersection(union, shapely.box(0, 0, 100, 75)))
    assert area_of_cars(FIELD, road_layer(FIELD, lines, widths)) == pytest.approx(expected, rel=1e-9)


def test_a_road_ends_where_its_line_ends_though_it_turns_back():
    hairpin = [(20, 30), (60, 30), (20, 31)]
    layer = road_layer(FIELD, [hairpin], 6.0)
    assert (layer[26:] == 0).all()  # beyond x = 65


def test_shelter_on_a_hill_goes_by_heights_above_the_ground():
    hill = Terrain.from_raster([[40.0, 40.0], [40.0, 40.0]], (-1, -1, 61, 31))
    houses = [square(10, 10, 46.0, 40.0), square(40, 10, 52.0, 40.0)]
    town = City.from_buildings(houses, cell=2.5, origin=(0, 0, 35), size=(60, 30, 40), terrain=hill)
    layer = shelter_layer(town, 0.25)
    assert layer[6, 6] == 0.5
    assert layer[18, 6] == 0.75
    assert layer[0, 0] == 0.25
    slope = Terrain.from_raster(np.tile(np.arange(0.5, 31, 1.0), (2, 1)), (0, 0, 62, 31))  # half as high as long
    bare = City.from_buildings([], cell=2.5, origin=(0, 0, -5), size=(60, 30, 50), terrain=slope)
    assert (shelter_layer(bare, 0.25) == 0.25).all()


def test_cars_and_lanes_set_the_share():
    layer = road_layer(FIELD, [[(0, 37.5), (100, 37.5)]], 15.0, cars_per_km=20.0, lane_width=3.5)
    assert layer.max() == pytest.approx(8.4 * 20 / 1000 / 3.5)
    assert (road_layer(FIELD, [], 5.0) == 0).all()


def test_geographic_roads_are_the_same_roads():
    line = np.array([(10, 12), (70, 60), (90, 20)])
    layer = road_layer(FIELD, [degrees(line)], 6.0, crs="EPSG:4326")
    assert layer == pytest.approx(road_layer(FIELD, [line], 6.0), abs=SHARE * 1e-3)
    exact = road_layer(FIELD, [Place(*DELFT).longitude_latitude(line)], 6.0, crs="EPSG:4326")
    assert exact == pytest.approx(road_layer(FIELD, [line], 6.0), abs=SHARE * 1e-9)


def square(west, south, top, bottom=0.0):
    return Building.prism(
        [(west, south), (west + 10, south), (west + 10, south + 10), (west, south + 10)], top, bottom=bottom
    )


@pytest.mark.parametrize("cell", [1.0, 2.5, 5.0])
@pytest.mark.parametrize("floor", [0.0, 31.0])
def test_shelter_under_buildings_is_that_of_their_height_and_not_of_their_voxels(cell, floor):
    roofs = [6.0, 9.9, 10.0, 30.0]
    buildings = [square(10 + 20 * n, 10, floor + roof, floor) for n, roof in enumerate(roofs)]
    town = City.from_buildings(buildings, cell=cell, origin=(0, 0, floor), size=(90, 30, 40))
    layer = shelter_layer(town, 0.25)
    assert layer.shape == town.shape[:2]
    for n, shelter in enumerate((0.5, 0.5, 0.75, 0.75)):
        i, j, _ = town.cell_of((15 + 20 * n, 15, floor + 1))
        assert layer[i, j] == shelter
    assert ((layer == 0.25) == ~town.occupied.any(axis=2)).all()
    assert (shelter_layer(town, high=6.0)[town.occupied.any(axis=2)] == 0.75).all()
    assert (shelter_layer(town, high=31.0)[town.occupied.any(axis=2)] == 0.5).all()


@pytest.mark.parametrize("floor", [0.1, 31.3, -77.7])
def test_rounding_makes_no_buildings_and_lowers_none(floor):
    town = City.from_buildings(
        [square(10.1, 10.1, floor + 10, floor)], cell=0.7, origin=(0.1, 0.1, floor), size=(35, 35, 21)
    )
    under = town.occupied.any(axis=2)
    assert (shelter_layer(town)[under] == 0.75).all()
    assert (shelter_layer(town)[~under] == 0).all()


def test_shelter_of_a_voxel_only_city_goes_by_its_voxels():
    occupied = np.zeros((3, 1, 6), bool)
    occupied[0, 0, :4] = True  # 8 m
    occupied[1, 0, 4] = True  # a bridge at 8 to 10 m
    assert shelter_layer(City(occupied, cell=2.0))[:, 0].tolist() == [0.5, 0.75, 0.0]
    occupied[0, 0] = True  # as high as the map
    assert shelter_layer(City(occupied, cell=2.0))[:, 0].tolist() == [0.75, 0.75, 0.0]
    assert shelter_layer(City(occupied, cell=2.0), high=12.0)[:, 0].tolist() == [0.75, 0.5, 0.0]


def test_building_too_low_for_a_voxel_shelters_all_the_same():
    town = City.from_buildings([square(10, 10, 2.0)], cell=5.0, origin=(0, 0, 0), size=(30, 30, 20))
    assert town.occupied.sum() == 4  # touched, though no centre lies in it
    assert shelter_layer(town)[2:4, 2:4].tolist() == [[0.5, 0.5], [0.5, 0.5]]


def test_open_ground_is_given_by_name_by_number_or_column_by_column():
    for name, shelter in (("none", 0), ("sparse trees", 0.25), ("trees or low buildings", 0.5), ("industry", 1)):
        assert (shelter_layer(CITY, name) == shelter).all()
    assert (shelter_layer(CITY) == 0).all()
    assert (shelter_layer(CITY, 0.6) == 0.6).all()
    names = np.full(CITY.shape[:2], "none", dtype="<U32")
    names[1, 2] = "high buildings"
    layer = shelter_layer(CITY, names)
    assert layer[1, 2] == 0.75
    assert layer.sum() == 0.75
    numbers = np.linspace(0, 1, 12).reshape(4, 3)
    assert np.array_equal(shelter_layer(CITY, numbers), numbers)


def test_layers_make_a_risk_map():
    layers = RiskMap(
        CITY,
        raster_layer(CITY, [[POPULATION_DENSITY]], BOUNDS),
        shelter_layer(CITY, "sparse trees"),
        road_layer(CITY, [[(100, -5), (140, -5)]], 6.0),
    )
    assert layers.rate[2, 1, 1] - layers.rate[2, 0, 1] == pytest.approx(6.4e-5 * 3 * SHARE * 0.6)


LINE = [(0, 0), (10, 10)]


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: raster_layer(CITY, [1, 2], BOUNDS), r"values must have shape \(rows, columns\), got \(2,\)"),
        (lambda: raster_layer(CITY, np.ones((2, 2, 3)), BOUNDS), r"values must have shape .* got \(2, 2, 3\)"),
        (lambda: raster_layer(CITY, np.ones((0, 2)), BOUNDS), r"values must have shape .* got \(0, 2\)"),
        (lambda: raster_layer(CITY, [[np.inf]], BOUNDS, fill=0.0), "values must not be infinite, 1 are"),
        (lambda: raster_layer(CITY, [["a"]], BOUNDS), "values must be a number or an array of numbers"),
        (lambda: raster_layer(CITY, [[1]], (0, 0, 1)), "bounds must be .west, south, east, north. in increasing"),
        (lambda: raster_layer(CITY, [[1]], (140, -20, 100, 10)), r"bounds must be .* increasing order, got \(140"),
        (lambda: raster_layer(CITY, [[1]], (100, 10, 140, -20)), "bounds must be .* increasing order"),
        (lambda: raster_layer(CITY, [[1]], (100, 10, np.nan, 20)), "bounds must be .* increasing order"),
        (lambda: raster_layer(CITY, [[1]], "abcd"), "bounds must be a number or an array of numbers: got text"),
        (lambda: raster_layer(CITY, [[1]], BOUNDS, per="mile"), "per must be one of 'm²', 'km²', 'pixel', got 'mile'"),
        (lambda: raster_layer(CITY, [[1]], BOUNDS, crs="EPSG:0"), "crs='EPSG:0' is no reference system"),
        (lambda: raster_layer(CITY, [[1]], BOUNDS, fill=np.nan), "fill must be finite, got nan"),
        (lambda: raster_layer(CITY, [[1]], BOUNDS, fill="0"), "fill must be a number .* got text, '0'"),
        (lambda: raster_layer(CITY, [[1]], BOUNDS, fill=[0, 1]), "fill must be one number, got an array"),
        (
            lambda: raster_layer(CITY, [[1]], BOUNDS, crs="EPSG:4326"),
            r"'city' doesn't know where on Earth it lies: read it with crs=\.\.\., or give City its reference",
        ),
        (lambda: road_layer(CITY, [LINE], 5, crs="EPSG:4326"), "doesn't know where on Earth it lies"),
        (lambda: road_layer(CITY, LINE, 5), r"lines\[0\] must be at least two finite points .* got shape \(2,\)"),
        (lambda: road_layer(CITY, [LINE, [(0, 0)]], 5), r"lines\[1\] must be .* got shape \(1, 2\)"),
        (lambda: road_layer(CITY, [[(0, 0, 0), (1, 1, 1)]], 5), r"lines\[0\] must be .* got shape \(2, 3\)"),
        (lambda: road_layer(CITY, [[(0, 0), (1, np.nan)]], 5), r"lines\[0\] must be at least two finite points"),
        (
            lambda: road_layer(FIELD, [[DELFT, DELFT]], 5, crs="EPSG:4326"),
            r"lines\[0\] lies within 0.1 m; is crs, EPSG:4326 \(WGS 84\), its own\?",
        ),
        (lambda: road_layer(CITY, None, 5), r"lines must be a list of lines \(M, 2\), got NoneType"),
        (lambda: road_layer(CITY, ["road"], 5), r"lines\[0\] must be a number or an array of numbers"),
        (lambda: road_layer(CITY, [LINE], 0), "width must be finite and above 0, got 0"),
        (lambda: road_layer(CITY, [LINE], [5, np.nan]), r"width must be one number or one for each of the 1 lines"),
        (lambda: road_layer(CITY, [LINE], [np.nan]), "width must be finite and above 0, got nan"),
        (lambda: road_layer(CITY, [LINE], "6 m"), "width must be a number .* got text, '6 m'"),
        (lambda: road_layer(CITY, [LINE], 5, cars_per_km=-1), "cars_per_km must be finite and at least 0, got -1"),
        (lambda: road_layer(CITY, [LINE], 5, cars_per_km=[1, 2]), "cars_per_km must be one number or one for each"),
        (lambda: road_layer(CITY, [LINE], 5, cars_per_km=1000), "cars_per_km must leave cars on at most the whole"),
        (lambda: road_layer(CITY, [LINE], 5, lane_width=[3]), "lane_width must be one number"),
        (lambda: road_layer(CITY, [LINE], 5, lane_width=0), "lane_width must be finite and above 0, got 0"),
        (lambda: shelter_layer(CITY, "forest"), "ground must be one of 'none', 'sparse trees', .* got 'forest'"),
        (lambda: shelter_layer(CITY, ["none", "sea"]), "ground must be one of .* got 'sea'"),
        (lambda: shelter_layer(CITY, 1.5), r"ground must be from 0 to 1 \(0 none, 1 industry\), got 1.5"),
        (lambda: shelter_layer(CITY, [[0.5], [0.5, 1]]), "ground must be a name, a number, or an array of either"),
        (lambda: shelter_layer(CITY, np.ma.masked_equal([[0.0, 1.0]], 1)), "ground has masked values"),
        (lambda: shelter_layer(CITY, np.nan), "ground must be from 0 to 1 .* got nan"),
        (lambda: shelter_layer(CITY, np.zeros((3, 4))), r"ground must have the city's ground plan \(4, 3\), got \(3"),
        (lambda: shelter_layer(CITY, high=-1), "high must be finite and at least 0, got -1"),
        (lambda: shelter_layer(CITY, high=[5, 10]), "high must be one number, got an array"),
        *(
            (lambda layer=layer: layer(RiskMap(CITY, 0.0, 0.0)), "city must be a City, got RiskMap: .* as its .city")
            for layer in (shelter_layer, lambda it: raster_layer(it, [[1]], BOUNDS), lambda it: road_layer(it, [], 5))
        ),
    ],
)
def test_wrong_questions_are_refused_by_name(call, message):
    with pytest.raises(ValueError, match=message):
        call()


@pytest.mark.parametrize("per", ["m²", "km²", "pixel"])
def test_a_density_below_0_is_no_data_that_nobody_declared(per):
    values = np.array([[5.0, -200.0], [5.0, 5.0]])
    with pytest.raises(ValueError, match=f"values per {per} must be at least 0, 1 on the map are not, the lowest -200"):
        raster_layer(CITY, values, BOUNDS, per=per)
    assert raster_layer(CITY, values, BOUNDS).min() == -200  # heights, say
    with pytest.raises(ValueError, match="fill must be finite and at least 0, got -5"):
        raster_layer(CITY, np.abs(values), BOUNDS, per=per, fill=-5.0)
    far = np.ones((3, 40))
    far[:, -1] = -99999.0
    assert raster_layer(CITY, far, (100, -20, 1000, 10), per=per).min() > 0
