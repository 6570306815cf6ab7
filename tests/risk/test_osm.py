import json

import numpy as np
import pytest

from uavlab.city import read_geojson
from uavlab.risk import CARS_BY_CLASS, RiskMap, osm_layers, vehicle_share
from uavlab.risk.osm import LANES


def lonlat(points, at=(4.36, 52.01)):
    return [[at[0] + x / 68_600, at[1] + y / 111_260] for x, y in points]  # metres per degree in Delft, to 0.1 %


def feature(kind, points, **properties):
    coordinates = [lonlat(points)] if kind == "Polygon" else lonlat(points)
    return {"type": "Feature", "properties": properties, "geometry": {"type": kind, "coordinates": coordinates}}


def square(west, south, side):
    return [(west, south), (west + side, south), (west + side, south + side), (west, south + side)]


HOUSE = feature("Polygon", square(0, 0, 20), building="yes", height="12 m")
WOOD = feature("Polygon", square(60, 0, 40), natural="wood")
PARK = feature("Polygon", square(60, 0, 80), leisure="park")
ROAD = feature("LineString", [(0, 50), (140, 50)], highway="residential")


@pytest.fixture
def town(tmp_path):
    def read(*features):
        path = tmp_path / "town.geojson"
        path.write_text(json.dumps({"type": "FeatureCollection", "features": list(features)}))
        return read_geojson(path, cell=5.0, margin=150.0), path

    return read


def test_woods_and_parks_shelter_and_houses_do(town):
    city, path = town(HOUSE, WOOD, PARK)
    layers = osm_layers(city, path)

    def at(x, y):
        return layers.shelter[tuple(city.cell_of((x, y, 1.0))[:2])]

    assert (at(10, 10), at(80, 20), at(130, 70), at(-50, -50)) == (0.75, 0.5, 0.25, 0.0)
    assert layers.source.count("taken", "land as trees or low buildings") == 1
    assert RiskMap(city, 0.01, layers.shelter, layers.vehicle_share).rate.min() >= 0


@pytest.mark.parametrize(
    ("properties", "width"),
    [({}, 6.0), ({"lanes": "3"}, 9.0), ({"width": "4 m"}, 4.0), ({"width": "20 ft"}, 6.096), ({"lanes": "many"}, 6.0)],
)
def test_roads_are_as_wide_as_they_say_or_as_usual(town, properties, width):
    city, path = town(HOUSE, feature("LineString", [(0, 50), (140, 50)], highway="residential", **properties))
    share = osm_layers(city, path).vehicle_share
    assert share.sum() * city.cell**2 == pytest.approx(140 * width * float(vehicle_share()), rel=2e-3)
    busy = osm_layers(city, path, cars_per_km=10.0).vehicle_share
    assert busy.sum() == pytest.approx(100 * share.sum())


def test_ways_without_cars_and_tunnels_have_none(town):
    ways = [
        feature("LineString", [(0, 50), (140, 50)], highway="footway"),
        feature("LineString", [(0, 60), (140, 60)], highway="primary", tunnel="yes"),
        feature("LineString", [(0, 70), (140, 70)], railway="rail"),
    ]
    city, path = town(HOUSE, *ways)
    layers = osm_layers(city, path)
    assert not layers.vehicle_share.any()
    assert "no road" in str(layers.source)


def test_what_is_assumed_of_roads_is_said(town):
    city, path = town(HOUSE, ROAD)
    said = str(osm_layers(city, path).source)
    assert "assumed: 1 × width of a road from the usual lanes of its class, of 3 m" in said
    assert "assumed: cars per km of each lane: 0.1, on all roads" in said
    assert "cars per km of each lane: 0.2 to 6, by class" in str(
        osm_layers(city, path, cars_per_km=CARS_BY_CLASS).source
    )


def test_cars_may_go_by_class_of_road(town):
    city, path = town(HOUSE, ROAD, feature("LineString", [(0, 90), (140, 90)], highway="primary"))
    same = osm_layers(city, path).vehicle_share
    layer = osm_layers(city, path, cars_per_km={"primary": 2.0}).vehicle_share
    south, north = (tuple(city.cell_of((70, y, 1.0))[:2]) for y in (50, 90))
    assert layer[south] == 0
    assert layer[north] == pytest.approx(20 * same[north])
    assert CARS_BY_CLASS.keys() == LANES.keys()
    with pytest.raises(ValueError, match=r"cars_per_km: highway must be one of 'motorway', .* got 'street'"):
        osm_layers(city, path, cars_per_km={"street": 2.0})
    with pytest.raises(ValueError, match="cars_per_km of 'primary' must be finite and at least 0, got -1"):
        osm_layers(city, path, cars_per_km={"primary": -1.0})
    with pytest.raises(ValueError, match="cars_per_km must be finite and at least 0, got nan"):
        osm_layers(city, path, cars_per_km=np.nan)


def test_a_motorway_has_the_lanes_of_both_of_its_ways(town):
    ways = [feature("LineString", [(0, y), (140, y)], highway="motorway", oneway="yes") for y in (50, 62)]
    city, path = town(HOUSE, *ways)
    share = osm_layers(city, path).vehicle_share
    assert share.sum() * city.cell**2 == pytest.approx(140 * 4 * 3.0 * float(vehicle_share()), rel=2e-3)


def test_layers_of_a_projected_file_lie_under_its_city(tmp_path):
    """The same houses, roads and woods in feet of New York: they are read as one file, so they must fit together."""
    corner = np.array([981_000.0, 195_000.0])

    def placed(kind, points, **properties):
        at = (corner + np.array(points) / (1200 / 3937)).tolist()
        geometry = {"type": kind, "coordinates": [at] if kind == "Polygon" else at}
        return {"type": "Feature", "properties": properties, "geometry": geometry}

    features = [
        placed("Polygon", square(0, 0, 20), building="yes", height="12 m"),
        placed("Polygon", square(60, 0, 40), natural="wood"),
        placed("LineString", [(0, 50), (140, 50)], highway="residential", width="20"),
    ]
    path = tmp_path / "york.geojson"
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    city = read_geojson(path, crs="EPSG:2263", cell=2.0, margin=150.0)
    layers = osm_layers(city, path, crs="EPSG:2263")
    assert (layers.shelter == 0.5).sum() * city.cell**2 == pytest.approx(40 * 40, rel=0.05)
    assert layers.vehicle_share.sum() * city.cell**2 == pytest.approx(140 * 20 * float(vehicle_share()), rel=1e-3)
    assert (layers.shelter == 0.75).any()


def test_broken_roads_and_unknown_places_are_refused(town):
    city, path = town(
        HOUSE, {"type": "Feature", "properties": {"highway": "primary"}, "geometry": {"type": "LineString"}}
    )
    with pytest.raises(ValueError, match=r"feature 1 \(counted from 0\) of town\.geojson is malformed"):
        osm_layers(city, path)
    city, path = town(HOUSE, ROAD)
    nowhere = type(city)(np.zeros((3, 3, 3), bool), name="nowhere")
    with pytest.raises(ValueError, match="'nowhere' doesn't know where on Earth it lies"):
        osm_layers(nowhere, path)
    with pytest.raises(ValueError, match="city must be a City"):
        osm_layers(path, path)
    path.write_text(json.dumps({"features": [{"geometry": {"type": "LineString", "coordinates": [[900, 9], [999, 9]]},
                                              "properties": {"highway": "primary"}}]}))  # fmt: skip
    for crs in (None, "local"):
        with pytest.raises(ValueError, match=r"is in metres of an unknown place, .*: give crs='EPSG:...' here and"):
            osm_layers(city, path, crs=crs)


def test_tags_may_be_packed_in_a_property(town):
    road = feature("LineString", [(0, 50), (140, 50)], tags={"highway": "residential", "width": "10"})
    tunnel = feature("LineString", [(0, 90), (140, 90)], highway="primary", other_tags='"tunnel"=>"yes"')
    wood = feature("Polygon", square(60, 0, 40), other_tags='"natural"=>"wood"')
    city, path = town(HOUSE, road, tunnel, wood)
    layers = osm_layers(city, path)
    assert layers.vehicle_share.sum() * city.cell**2 == pytest.approx(140 * 10 * float(vehicle_share()), rel=2e-3)
    assert layers.source.count("taken", "land as trees or low buildings") == 1


def test_land_without_area_is_left_out(town):
    city, path = town(HOUSE, WOOD, feature("Polygon", [(0, 0), (9, 9)], landuse="forest"))
    source = osm_layers(city, path).source
    assert source.count("left out", "land without area") == source.count("taken", "land as trees or low buildings") == 1


def test_a_road_to_infinity_is_refused_with_its_number(town):
    city, path = town(HOUSE, ROAD)
    path.write_text(
        path.read_text().replace('"LineString", "coordinates": [[', '"LineString", "coordinates": [[1e999, 0], [')
    )
    with pytest.raises(ValueError, match=r"feature 1 \(counted from 0\) of town.geojson is malformed.*infinite"):
        osm_layers(city, path)
