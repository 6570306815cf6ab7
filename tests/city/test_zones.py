import json
from dataclasses import replace

import numpy as np
import pytest

from uavlab.city import Building, City, NoFlyZone, read_no_fly

SQUARE = [(10, 10), (20, 10), (20, 20), (10, 20)]
FIELD = City(np.zeros((40, 40, 20), bool), name="field")
SLOPE = City(np.zeros((40, 40, 40), bool), ground=np.tile(0.5 * (np.arange(40)[:, None] + 0.5), (1, 40)), name="slope")


def zoned(city, *zones):
    return replace(city, no_fly=zones)


def test_a_zone_closes_what_it_reaches_into_and_is_no_obstacle():
    city = zoned(FIELD, NoFlyZone(SQUARE, 5.0, 12.5))
    assert city.blocked()[10:20, 10:20, 5:13].all()
    assert city.blocked().sum() == 10 * 10 * 8
    assert not city.occupied.any()
    assert np.isinf(city.clearance).all()
    assert city.is_free((15, 15, 8))
    assert city.zone_at((15.5, 15.5, 8)) == "no-fly zone"
    assert city.zone_at((25.5, 15.5, 8)) == ""


def test_a_zone_on_a_slope_closes_more_rather_than_less():
    city = zoned(SLOPE, NoFlyZone(SQUARE, 2.0, 6.0, name="school"))
    low, high = city.zone_building(city.no_fly[0]).bounds[:, 2]
    assert low == pytest.approx(2.0 + 0.5 * 10, abs=0.3)  # above the lowest ground, in the west
    assert high == pytest.approx(6.0 + 0.5 * 20, abs=0.3)
    above = np.argwhere(city.blocked() & ~city.occupied)
    assert above[:, 0].min() == 10
    assert above[:, 0].max() == 19


def test_a_zone_without_upper_limit_ends_with_the_map_and_holes_stay_open():
    hole = [(13, 13), (17, 13), (17, 17), (13, 17)]
    city = zoned(FIELD, NoFlyZone(SQUARE, holes=(hole,)))
    assert city.blocked()[10:13, 10:20].all()
    assert not city.blocked()[13:17, 13:17].any()


def test_a_zone_off_the_map_or_thin_or_above_it():
    assert not zoned(FIELD, NoFlyZone([(100, 100), (110, 100), (110, 110)])).blocked().any()
    assert not zoned(FIELD, NoFlyZone(SQUARE, 50.0, 60.0)).blocked()[..., :19].any()
    thin = zoned(FIELD, NoFlyZone([(10.4, 0), (10.5, 0), (10.5, 40), (10.4, 40)]))
    assert thin.blocked()[10].all()
    assert thin.blocked().sum() == 40 * 20


def geojson(tmp_path, ring=SQUARE, **properties):
    path = tmp_path / "zones.geojson"
    polygon = {"type": "Polygon", "coordinates": [[list(point) for point in ring]]}
    feature = {"type": "Feature", "properties": properties, "geometry": polygon}
    path.write_text(json.dumps({"type": "FeatureCollection", "features": [feature]}))
    return path


def test_zones_are_read_with_their_limits(tmp_path):
    (zone,) = read_no_fly(geojson(tmp_path, lower=10, upper="400 ft", name="airport"), FIELD)
    assert (zone.name, zone.lower, zone.upper) == ("airport", 10.0, pytest.approx(121.92))
    assert zone.outline.tolist() == [list(map(float, point)) for point in SQUARE]
    (zone,) = read_no_fly(geojson(tmp_path), FIELD)
    assert (zone.lower, zone.upper) == (0.0, np.inf)
    (zone,) = read_no_fly(geojson(tmp_path, floor="3 m"), FIELD, lower="floor", upper=50)
    assert (zone.lower, zone.upper) == (3.0, 50.0)
    on_earth = replace(FIELD, reference=(4.36, 52.01))
    ring = on_earth.to_geographic([(x, y, 0.0) for x, y in SQUARE])[:, :2].tolist()
    (zone,) = read_no_fly(geojson(tmp_path, ring), on_earth)
    assert zone.outline == pytest.approx(np.array(SQUARE, float), abs=1e-6)
    (zone,) = read_no_fly(geojson(tmp_path), on_earth, crs="local")
    assert zone.outline[0].tolist() == [10.0, 10.0]


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda path: NoFlyZone([(0, 0), (1, 1)]), "needs at least three different corners"),
        (lambda path: NoFlyZone([(0, 0), (1, 1), (1, 0), (0, 1)]), "is not a simple polygon"),
        (lambda path: NoFlyZone(SQUARE, 9.0, 9.0), r"upper of 'no-fly zone' must be above its lower \(9 m\), got 9 m"),
        (lambda path: NoFlyZone(SQUARE, np.nan), "upper of 'no-fly zone' must be above its lower"),
        (lambda path: NoFlyZone(SQUARE, "low"), "lower must be a number"),
        (lambda path: replace(FIELD, no_fly=[SQUARE]), r"no_fly\[0\] must be a NoFlyZone, got list: "),
        (lambda path: replace(FIELD, no_fly=5), "no_fly must be a list of NoFlyZone, got int"),
        (lambda path: read_no_fly(geojson(path, upper="high"), FIELD), "upper of .* must be a height in metres"),
        (lambda path: read_no_fly(geojson(path, SQUARE[:2]), FIELD), "has no polygon with an area, so no zone"),
        (lambda path: read_no_fly(geojson(path), FIELD, crs="EPSG:4326"), "doesn't know where on Earth"),
        (lambda path: read_no_fly(geojson(path), FIELD, lower=None), "lower must be the name of a property, or a h"),
        (lambda path: read_no_fly(geojson(path), FIELD, upper="ceiling"), "upper='ceiling' is no property of any zone"),
        (lambda path: read_no_fly(geojson(path), "town"), "city must be a City, got str"),
        (lambda path: read_no_fly(5, FIELD), "path must be the name of a file, got 5"),
        (lambda path: NoFlyZone(SQUARE, name=7), "name must be text, got 7"),
        (lambda path: NoFlyZone(SQUARE).pieces(5.0, 5.0), r"high must be above low \(5 m\), got 5 m"),
        (lambda path: read_no_fly(geojson(path), FIELD, upper=[9]), "upper must be the name of a property, or"),
    ],
)  # fmt: skip
def test_what_is_no_zone_is_refused(tmp_path, ask, message):
    with pytest.raises(ValueError, match=message):
        ask(tmp_path)


def test_a_zone_without_area_is_left_out_with_a_warning(tmp_path):
    path = geojson(tmp_path)
    document = json.loads(path.read_text())
    lost = [{"type": "Point", "coordinates": [5, 5]}, {"type": "Polygon", "coordinates": [[[1, 1], [2, 2], [1, 1]]]}]
    document["features"] += [{"type": "Feature", "properties": {"radius": 500}, "geometry": each} for each in lost]
    path.write_text(json.dumps(document))
    with pytest.warns(
        UserWarning, match="1 × Point that has no outline .*; left out: 1 × polygon without area"
    ) as said:
        zones = read_no_fly(path, FIELD)
    assert len(zones) == len(said) == 1
    assert "city.source" not in str(said[0].message)


def test_buildings_in_a_zone_stay_obstacles():
    house = Building.prism([(14, 14), (16, 14), (16, 16), (14, 16)], 30.0, name="tower")
    city = City.from_buildings([house], origin=(0, 0, 0), size=(40, 40, 40), no_fly=(NoFlyZone(SQUARE, 0.0, 10.0),))
    assert city.occupied.sum() == 2 * 2 * 30
    assert city.building_at((15, 15, 5)) == "building 'tower'"
