"""Missions on maps, parsed by others: KML, GPX and GeoJSON."""

import json
from dataclasses import replace
from itertools import pairwise
from xml.etree import ElementTree

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from missions import CENTIMETRE, DELFT, SQUARE, WGS84, plain, table1

from uavlab.city import City, NoFlyZone, Place
from uavlab.mission import FencePolygon, Item, Mission
from uavlab.mission.maps import closed
from uavlab.route import Route
from uavlab.vehicle import LIGHT_QUADROTOR

KML = "{http://www.opengis.net/kml/2.2}"
GPX = "{http://www.topografix.com/GPX/1/1}"
ROUTE = Route([(5, 5, 30), (5, 95, 40), (50, 98, 40)])
SCHOOL = NoFlyZone([(85, 5), (95, 5), (95, 15), (85, 15)], name="school")
CITY = replace(table1(), no_fly=[SCHOOL])
FIJI = City(np.zeros((40, 40, 12), bool), 10.0, reference=(179.9985, -17.7, 3.0), name="Fiji")
ACROSS = Route([(50, 50, 30), (350, 60, 40), (350, 300, 40)])
"""Over the date line, which is 159 m east of the map's corner."""


def mission_with(**options):
    return Mission.from_route(ROUTE, CITY, LIGHT_QUADROTOR, **options)


@pytest.fixture
def exported(tmp_path):
    def parsed(mission, name, city=CITY):
        path = tmp_path / f"flight.{name}"
        getattr(mission, f"to_{name}")(path, city)
        text = path.read_bytes()
        assert text.startswith(b"<?xml version='1.0' encoding='utf-8'?>" if name != "geojson" else b"{")
        return json.loads(text) if name == "geojson" else ElementTree.fromstring(text)

    return parsed


def local(elements):
    return [element.tag.split("}")[1] for element in elements]


def expected_way(mission, city):
    """Longitudes, latitudes and heights above the map's z = 0 of home and of all that follows."""
    return city.to_geographic(mission.path(city).points)


@pytest.mark.parametrize("above_sea", [True, False])
def test_kml(exported, above_sea):
    home = (4.36, 52.01, 13.0) if above_sea else None
    mission = mission_with(home=home)
    root = exported(mission, "kml")
    assert root.tag == f"{KML}kml"
    (document,) = root
    assert local(document) == ["name", "Placemark", "Placemark", "Placemark"]
    assert document.findtext(f"{KML}name") == "the city of REPARE Table 1"
    for mark in document.iter(f"{KML}Placemark"):  # in the order of the schema
        assert local(mark) in (["name", "Style", "LineString"], ["name", "Style", "Polygon"])
        assert local(mark[1]) == ["LineStyle", "PolyStyle"]
        assert local(mark[1][0]) == ["color", "width"]
        assert len(mark[1][0].findtext(f"{KML}color")) == 8
        assert mark[1].findtext(f"{KML}PolyStyle/{KML}fill") == "0"
    line = document.find(f".//{KML}LineString")
    assert local(line) == ["altitudeMode", "coordinates"]
    way = np.array([[float(number) for number in each.split(",")] for each in line[1].text.split()])
    expected = expected_way(mission, CITY)
    assert line[0].text == ("absolute" if above_sea else "relativeToGround")
    if above_sea:
        expected[:, 2] += 13.0 - 3.0  # the reference says 3 m, home 13 m
    else:
        expected[:, 2] -= 3.0
    assert way[:, :2] == pytest.approx(expected[:, :2], abs=1.01e-7)
    assert way[:, 2] == pytest.approx(expected[:, 2], abs=2e-3)
    names = [mark.findtext(f"{KML}name") for mark in document.iter(f"{KML}Placemark")]
    assert names == ["way", "stay inside: fence", "stay outside: school"]
    for polygon, ring in zip(mission.fence, document.iter(f"{KML}LinearRing"), strict=True):
        corners = [tuple(map(float, each.split(","))) for each in ring.findtext(f"{KML}coordinates").split()]
        check_ring(corners, polygon)
    for polygon in document.iter(f"{KML}Polygon"):
        assert local(polygon) == ["outerBoundaryIs"]
        assert local(polygon[0]) == ["LinearRing"]


def check_ring(corners, polygon):
    """Closed, counterclockwise, and with the polygon's corners."""
    ring = shapely.LinearRing(corners)
    assert corners[0] == corners[-1]
    assert ring.is_ccw
    assert {(north, east) for east, north in corners} == set(polygon.corners)
    assert len(corners) == len(polygon.corners) + 1


@pytest.mark.parametrize("above_sea", [True, False])
def test_gpx(exported, above_sea):
    mission = mission_with(home=(4.36, 52.01, 13.0) if above_sea else None)
    root = exported(mission, "gpx")
    assert root.tag == f"{GPX}gpx"
    assert root.attrib == {"version": "1.1", "creator": "uavlab"}
    (route,) = root
    expected = expected_way(mission, CITY)
    assert local(route) == ["name"] + ["rtept"] * len(expected)
    for number, (point, (east, north, height)) in enumerate(zip(route[1:], expected, strict=True)):
        assert local(point) == (["ele", "name"] if above_sea else ["name"])
        assert set(point.attrib) == {"lat", "lon"}
        assert float(point.get("lat")) == pytest.approx(north, abs=1.01e-7)
        assert float(point.get("lon")) == pytest.approx(east, abs=1.01e-7)
        assert point.findtext(f"{GPX}name") == (str(number) if number else "home")
        if above_sea:
            assert float(point.findtext(f"{GPX}ele")) == pytest.approx(height + 10.0, abs=2e-3)


def test_geojson(exported):
    mission = mission_with(end="return")
    collection = exported(mission, "geojson")
    assert collection["type"] == "FeatureCollection"
    features = collection["features"]
    assert {feature["type"] for feature in features} == {"Feature"}
    assert all(set(feature) == {"type", "properties", "geometry"} for feature in features)
    shapes = [shapely.geometry.shape(feature["geometry"]) for feature in features]
    home, *points = (feature for feature in features if feature["geometry"]["type"] == "Point")
    assert home["properties"] == {"name": "home", "altitude": mission.home.height, "above": "unknown"}
    assert home["geometry"]["coordinates"] == pytest.approx([mission.home.longitude, mission.home.latitude], abs=1e-7)
    placed = [(number, item) for number, item in enumerate(mission.items) if item.command in (16, 22)]
    for feature, (number, item) in zip(points, placed, strict=True):
        assert feature["geometry"]["coordinates"] == [item.longitude, item.latitude]
        assert feature["properties"] == {
            "item": number,
            "name": "take off" if item.command == 22 else "waypoint",
            "altitude": item.altitude,
            "above": "home",
        }
    (line,) = (shape for shape in shapes if shape.geom_type == "LineString")
    assert np.array(line.coords) == pytest.approx(expected_way(mission, CITY)[:, :2], abs=1.01e-7)
    rings = [feature for feature in features if feature["geometry"]["type"] == "Polygon"]
    for feature, polygon in zip(rings, mission.fence, strict=True):
        (ring,) = feature["geometry"]["coordinates"]
        check_ring([tuple(corner) for corner in ring], polygon)
        assert feature["properties"] == {"name": polygon.name, "inclusion": polygon.inclusion}
    assert all(shape.is_valid for shape in shapes)


@pytest.mark.parametrize("altitudes", ["home", "sea", "terrain"])
@pytest.mark.parametrize("name", ["kml", "gpx"])
def test_heights_on_maps_are_the_same_whatever_altitudes_are_above(exported, altitudes, name):
    home = (4.36, 52.01, 13.0)
    texts = {
        above: ElementTree.tostring(exported(mission_with(home=home, altitudes=above), name))
        for above in ("home", altitudes)
    }
    assert texts["home"] == texts[altitudes]


def test_other_commands_and_frames_in_geojson(exported):
    items = (*plain().items, Item(201, 0, (0, 0, 0, 0), 52.01, 4.36, 5.0), Item(206, 2, (5, 0, 0, 0)))
    points = exported(plain(items=items), "geojson", table1())["features"][1:4]
    assert [feature["properties"]["name"] for feature in points] == ["take off", "waypoint", "command 201"]
    assert points[2]["properties"]["above"] == "sea"
    strange = exported(plain(items=(*plain().items, Item(201, 9, (0, 0, 0, 0), 52.01, 4.36, 5.0))), "geojson", table1())
    assert strange["features"][3]["properties"]["above"] == "9"


@pytest.mark.parametrize("turned", [False, True])
def test_rings_are_counterclockwise_whichever_way_they_came(turned):
    corners = SQUARE.corners[::-1] if turned else SQUARE.corners
    ring = closed(corners)
    assert shapely.LinearRing([(east, north) for north, east in ring]).is_ccw
    assert ring[0] == ring[-1]
    assert set(ring) == set(corners)


@pytest.mark.parametrize("turned", [False, True])
def test_rings_over_the_date_line_are_counterclockwise(turned):
    corners = (-17.8, 179.9), (-17.8, -179.9), (-17.6, -179.9), (-17.6, 179.9)
    ring = closed(corners[::-1] if turned else corners)
    on = shapely.LinearRing([(east % 360.0, north) for north, east in ring])
    assert on.is_ccw


def test_over_the_date_line(exported):
    """Longitudes of GPX are below 180; in all of them neighbours are near each other on the Earth."""
    mission = Mission.from_route(ACROSS, FIJI, LIGHT_QUADROTOR, home=(179.9990, -17.6996, 3.0))
    assert {np.sign(item.longitude) for item in mission.items if item.command in (16, 22)} == {-1, 1}
    points = [(float(p.get("lon")), float(p.get("lat"))) for p in exported(mission, "gpx", FIJI).iter(f"{GPX}rtept")]
    assert all(-180.0 <= east < 180.0 for east, _ in points)
    line = exported(mission, "kml", FIJI).find(f".//{KML}LineString/{KML}coordinates").text.split()
    on_kml = [tuple(map(float, each.split(",")))[:2] for each in line]
    features = exported(mission, "geojson", FIJI)["features"]
    (on_geojson,) = (f["geometry"]["coordinates"] for f in features if f["geometry"]["type"] == "LineString")
    assert all(-180.0 <= east <= 180.0 for east, _ in on_kml)
    assert np.ptp(np.array(on_geojson)[:, 0]) < 0.01  # goes on past 180, as maps draw it
    for way in (points, on_kml, on_geojson):
        lengths = [WGS84.inv(*a, *b)[2] for a, b in pairwise(way[1:-1])]
        assert sum(lengths) == pytest.approx(mission.path(FIJI).en_route.length, rel=1e-2)
    assert mission.path(FIJI).points[2:5] == pytest.approx(ACROSS.points, abs=2 * CENTIMETRE)


@settings(max_examples=100)
@given(st.text(max_size=15), st.text(max_size=15))
def test_any_name_makes_a_document_that_can_be_read(tmp_path_factory, name, zone):
    path = tmp_path_factory.mktemp("maps") / "flight"
    mission = plain(name=name, fence=(FencePolygon(SQUARE.corners, False, zone),))
    for write, tag in ((mission.to_kml, f"{KML}Document/{KML}name"), (mission.to_gpx, f"{GPX}rte/{GPX}name")):
        write(path, table1())
        found = ElementTree.parse(path).getroot().findtext(tag)
        kept = [one for one in name if one in "\t\n" or one.isprintable()]
        assert [one for one in found if one in "\t\n" or one.isprintable()] == kept


@pytest.mark.parametrize("character", ["\x00", "\x0b", "\x1f", "\ud800", "\ufffe", "\uffff"])
def test_what_xml_cant_hold_is_left_out(exported, character):
    for name in ("kml", "gpx"):
        root = exported(plain(name=f"a{character}b & <c>"), name, table1())
        assert "ab & <c>" in {element.text for element in root.iter()}


@pytest.mark.parametrize("name", ["kml", "gpx", "geojson"])
def test_maps_need_a_city_with_a_place(tmp_path, name):
    write = getattr(plain(), f"to_{name}")
    with pytest.raises(ValueError, match="doesn't know where on Earth it lies"):
        write(tmp_path / "a", replace(table1(), reference=None))
    with pytest.raises(ValueError, match="city must be a City"):
        write(tmp_path / "a", "Delft")
    assert list(tmp_path.iterdir()) == []


def test_home_above_the_sea_moves_no_place(exported):
    """Nor does it matter how high the reference of the city is said to be."""
    low = mission_with(home=Place(4.36, 52.01, 0.0))
    high = mission_with(home=Place(4.36, 52.01, 2500.0))
    ways = []
    for mission in (low, high):
        root = exported(mission, "gpx")
        ways.append([(point.get("lat"), point.get("lon")) for point in root.iter(f"{GPX}rtept")])
    assert np.array(ways[0], float) == pytest.approx(np.array(ways[1], float), abs=1.01e-7)
    assert DELFT.height == 3.0
