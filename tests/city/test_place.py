import numpy as np
import pyproj
import pytest

from uavlab.city.place import Place, metres_per, system_for, system_of

PLACES = {
    "EPSG:4326": (129.095, 35.134),
    "EPSG:3857": (1_000_000.0, 6_200_000.0),
    "EPSG:25832": (565_000.0, 5_934_000.0),
    "EPSG:7415": (84_616.5, 447_423.0),
    "EPSG:2263": (981_000.0, 195_000.0),
}
"""A corner of a city in each system, in its own coordinates."""


def by_pyproj(system, place, xy):
    """East and north by one pipeline of pyproj's own: to the ellipsoid at the height of the place, then topocentric."""
    crs = pyproj.CRS.from_user_input(system)
    horizontal = crs.sub_crs_list[0] if crs.is_compound else crs
    lon, lat = pyproj.Transformer.from_crs(horizontal, "EPSG:4326", always_xy=True).transform(*xy.T)
    centred = pyproj.Transformer.from_crs("EPSG:4979", "EPSG:4978", always_xy=True)
    x, y, z = centred.transform(lon, lat, np.full(len(xy), place.height))
    x0, y0, z0 = centred.transform(*place)
    pipe = pyproj.Transformer.from_pipeline(f"+proj=topocentric +ellps=WGS84 +X_0={x0} +Y_0={y0} +Z_0={z0}")
    return np.stack(pipe.transform(x, y, z), axis=-1)[:, :2]


@pytest.mark.parametrize("height", [0.0, 100.0, 3000.0])
@pytest.mark.parametrize("code", PLACES)
def test_within_a_millimetre_of_pyproj_over_5_km_and_back(code, height):
    system, corner = system_of(code), np.array(PLACES[code])
    span = 0.05 if system.degrees else 5000 / system.height_factor
    xy = corner + np.random.default_rng(1).uniform(-span, span, (500, 2))
    place = Place(*system.to_lonlat(corner), height)
    local = place.east_north(system.to_lonlat(xy))
    assert np.abs(local - by_pyproj(code, place, xy)).max() < 1e-3
    back = place.longitude_latitude(local)
    assert np.abs(place.east_north(back) - local).max() < 1e-6
    assert np.abs(system.from_lonlat(back) - xy).max() * (111e3 if system.degrees else system.height_factor) < 1e-3


def test_north_is_true_north_not_that_of_the_grid():
    system = system_of("EPSG:7415")
    corner = np.array(PLACES["EPSG:7415"])
    place = Place(*system.to_lonlat(corner))
    east, north = place.east_north(system.to_lonlat(corner + np.array([0.0, 1000.0])))
    assert np.degrees(np.arctan2(east, north)) == pytest.approx(-0.81, abs=0.02)  # the turn of the grid in Delft


def test_a_metre_at_41_degrees_is_no_metre_of_web_mercator():
    system = system_of(3857)
    corner = np.array([-8_238_000.0, 4_970_000.0])
    place = Place(*system.to_lonlat(corner))
    east, _ = place.east_north(system.to_lonlat(corner + np.array([100.0, 0.0])))
    assert east == pytest.approx(100 * np.cos(np.radians(place.latitude)), rel=3e-3)


@pytest.mark.parametrize("longitude", [179.999, -179.999])
def test_longitudes_go_on_past_180_degrees(longitude):
    place = Place(longitude, 10.0)
    across = place.longitude_latitude([(500.0, 0.0), (-500.0, 0.0)])
    assert np.ptp(across[:, 0]) < 0.01
    assert place.east_north(across) == pytest.approx(np.array([(500.0, 0.0), (-500.0, 0.0)]), abs=1e-6)


@pytest.mark.parametrize("latitude", [-89.5, 0.0, 89.5])
def test_places_near_the_poles_and_on_the_equator(latitude):
    points = np.random.default_rng(0).uniform(-5000, 5000, (100, 2))
    place = Place(15.0, latitude, 250.0)
    assert place.east_north(place.longitude_latitude(points)) == pytest.approx(points, abs=1e-6)


@pytest.mark.parametrize(
    ("code", "unit", "factor"),
    [
        ("EPSG:4326", "metre", 1.0),
        ("EPSG:25832", "metre", 1.0),
        ("EPSG:7415", "metre", 1.0),
        ("EPSG:2263", "US survey foot", 1200 / 3937),
        ("EPSG:2263+6360", "US survey foot", 1200 / 3937),
        ("EPSG:2263+5703", "metre", 1.0),  # NAVD88 in metres over a plane in feet
    ],
)
def test_heights_have_the_unit_of_the_vertical_part_else_of_the_plane(code, unit, factor):
    system = system_of(code)
    assert system.height_unit == unit
    assert system.height_factor == pytest.approx(factor, rel=1e-9)


@pytest.mark.parametrize(
    "crs", [2263, "epsg:2263", "urn:ogc:def:crs:EPSG::2263", "https://www.opengis.net/def/crs/EPSG/0/2263"]
)
def test_a_system_has_many_names(crs):
    assert system_of(crs).name == "EPSG:2263 (NAD83 / New York Long Island (ftUS))"
    assert "4 m" in system_of(crs).accuracy


@pytest.mark.parametrize(
    ("bounds", "declared", "given", "degrees"),
    [
        ((4.35, 52.0, 4.37, 52.01), None, None, True),
        ((0, 0, 220, 20), None, None, None),
        ((84e3, 447e3, 85e3, 448e3), None, "local", None),
        ((84e3, 447e3, 85e3, 448e3), "EPSG:7415", None, False),
        ((84e3, 447e3, 85e3, 448e3), "EPSG:2263", "EPSG:28992", False),
        ((0, 0, 20, 20), None, "local", None),
        ((179.99, -17.0, 180.01, -16.99), "OGC:CRS84", None, True),
    ],
)
def test_the_caller_decides_then_the_file_then_the_numbers(bounds, declared, given, degrees):
    system = system_for(bounds, declared, given, "town.json")
    assert (None if system is None else system.degrees) is degrees


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda: system_of("EPSG:999999"), "crs='EPSG:999999' is no reference system that pyproj knows; give the EPSG"),
        (lambda: system_of("nonsense"), "crs='nonsense' is no reference system"),
        (lambda: system_of({"type": "name"}), "is no reference system that pyproj knows"),
        (lambda: system_of(10**30), "is no reference system that pyproj knows"),
        (lambda: system_of("EPSG:4978"), "has no plane coordinates: give the EPSG code"),
        (lambda: system_of("EPSG:5709"), "has no plane coordinates"),
        (lambda: system_of(25832).to_lonlat([(1e30, 2.0)]), r"\(1e\+30, 2\) has no place on Earth in EPSG:25832"),
        (
            lambda: system_for((84e3, 447e3, 85e3, 448e3), None, None, "a.json"),
            "no reference system.*crs='local'",
        ),
        (
            lambda: system_for((9.5, 48.7, 9.6, 48.8), "EPSG:25832", None, "a.json"),
            r"a.json: coordinates .* outside of where that is used: they look like degrees: give crs='EPSG:4326'",
        ),
        (
            lambda: system_for((84e3, 447e3, 85e3, 448e3), "EPSG:25832", None, "a.json"),
            "outside of where that is used: give crs='EPSG:...', their own",
        ),
        (lambda: system_for((84e3, 447e3, 85e3, 448e3), "EPSG:4326", None, "a.json"), "are no degrees, but EPSG:4326"),
        (lambda: metres_per("yard"), "height_unit must be one of 'm', .*, got 'yard'"),
        (lambda: metres_per(1), "height_unit must be one of"),
    ],
)
def test_what_makes_no_sense_is_refused_with_the_cure(ask, message):
    with pytest.raises(ValueError, match=message):
        ask()


def test_degrees_with_the_latitude_first_are_refused_where_the_system_tells():
    munich, swapped = (11.5, 48.1, 11.6, 48.2), (48.1, 11.5, 48.2, 11.6)
    assert system_for(munich, "EPSG:4258", None, "a.json").degrees
    with pytest.raises(ValueError, match=r"outside of where EPSG:4258 \(ETRS89\) is used, and inside if the latitude"):
        system_for(swapped, "EPSG:4258", None, "a.json")
    assert system_for(swapped, "EPSG:4326", None, "a.json").degrees
    guam = (144.7, 13.4, 144.8, 13.5)  # its maps are in NAD83, which is not said to be used there
    assert system_for(guam, "EPSG:4269", None, "a.json").degrees
    with pytest.raises(ValueError, match="is their order longitude, latitude"):
        system_for((35.6, 139.7, 35.7, 139.8), "EPSG:6697", None, "a.json")


@pytest.mark.parametrize("unit", ["us-ft", "US survey foot", " us_survey_foot "])
def test_units_in_any_case(unit):
    assert metres_per(unit) == 1200 / 3937
