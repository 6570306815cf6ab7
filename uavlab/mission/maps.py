"""Missions on maps: KML, GPX and GeoJSON."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

import numpy as np

from uavlab import checks
from uavlab.city import City
from uavlab.city.place import ABOVE_SEA
from uavlab.files import written_whole
from uavlab.mission.items import ABOVE, COMMANDS, Item, has_place, longitude_on_wire, on_wire

if TYPE_CHECKING:
    from uavlab.mission.model import Mission

KML, GPX = "http://www.opengis.net/kml/2.2", "http://www.topografix.com/GPX/1/1"
ORANGE, BLUE, GREY = "ff005ed5", "ffb27200", "ff808080"
"""Of the way, the fence and zones, as KML has them: opacity, blue, green, red."""


def way_of(mission: Mission, city: City) -> np.ndarray:
    """Longitude, latitude and height (N, 3) of home and all waypoints; heights as those of home [m]."""
    points = mission.path(city).points
    place = mission.place_on(city)
    at = mission.home_on(city)
    degrees = place.longitude_latitude(points[:, :2])
    return np.column_stack([degrees, points[:, 2] - at[2] + mission.home.height])


def write_kml(mission: Mission, path: str | Path, city: City) -> None:
    """`Mission.to_kml`."""
    way, path = way_of(mission, city), checks.path("path", path)
    sea = mission.heights == ABOVE_SEA
    if not sea:
        way[:, 2] = city.height_above_ground(mission.path(city).points)
    kml = ElementTree.Element("kml", xmlns=KML)
    document = ElementTree.SubElement(kml, "Document")
    text(document, "name", mission.name)
    line = placemark(document, "way", ORANGE)
    string = ElementTree.SubElement(line, "LineString")
    text(string, "altitudeMode", "absolute" if sea else "relativeToGround")
    text(string, "coordinates", " ".join(coordinates(*point) for point in way.tolist()))
    for polygon in mission.fence:
        mark = placemark(
            document,
            f"stay {'in' if polygon.inclusion else 'out'}side: {polygon.name}",
            BLUE if polygon.inclusion else GREY,
        )
        ring = ElementTree.SubElement(
            ElementTree.SubElement(ElementTree.SubElement(mark, "Polygon"), "outerBoundaryIs"), "LinearRing"
        )
        text(ring, "coordinates", " ".join(coordinates(east, north) for north, east in closed(polygon.corners)))
    written(kml, path)


def write_gpx(mission: Mission, path: str | Path, city: City) -> None:
    """`Mission.to_gpx`."""
    way, path = way_of(mission, city), checks.path("path", path)
    gpx = ElementTree.Element("gpx", xmlns=GPX, version="1.1", creator="uavlab")
    route = ElementTree.SubElement(gpx, "rte")
    text(route, "name", mission.name)
    for number, (east, north, height) in enumerate(way.tolist()):
        point = ElementTree.SubElement(route, "rtept", lat=f"{north:.7f}", lon=f"{longitude_on_wire(east):.7f}")
        if mission.heights == ABOVE_SEA:
            text(point, "ele", f"{height:.3f}")
        text(point, "name", str(number) if number else "home")
    written(gpx, path)


def write_geojson(mission: Mission, path: str | Path, city: City) -> None:
    """`Mission.to_geojson`."""
    way, path = way_of(mission, city), checks.path("path", path)
    features = [feature("Point", way[0, :2].tolist(), name="home", altitude=mission.home.height, above=mission.heights)]
    for number, item in enumerate(mission.items):
        if has_place(item):
            features.append(feature("Point", [item.longitude, item.latitude], **properties(number, item)))
    features.append(
        feature("LineString", [[on_wire(x), on_wire(y)] for x, y in way[:, :2].tolist()], name=mission.name)
    )
    for polygon in mission.fence:
        ring = [[east, north] for north, east in closed(polygon.corners)]
        features.append(feature("Polygon", [ring], name=polygon.name, inclusion=polygon.inclusion))
    with written_whole(path) as part:
        collection = {"type": "FeatureCollection", "features": features}
        part.write_text(json.dumps(collection, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


def properties(number: int, item: Item) -> dict[str, Any]:
    """What GeoJSON says of an item."""
    name = COMMANDS.get(item.command, f"command {item.command}")
    return {"item": number, "name": name, "altitude": item.altitude, "above": ABOVE.get(item.frame, str(item.frame))}


def feature(kind: str, where: Any, **named: Any) -> dict[str, Any]:
    return {"type": "Feature", "properties": named, "geometry": {"type": kind, "coordinates": where}}


def closed(corners: Iterable[tuple[float, float]]) -> list[tuple[float, float]]:
    """A ring whose last corner is its first, counterclockwise as seen from above, as maps want it."""
    ring = list(corners)
    east = [(longitude - ring[0][1] + 180.0) % 360.0 for _, longitude in ring]  # 180° may lie between
    turned = sum(east[n - 1] * ring[n][0] - east[n] * ring[n - 1][0] for n in range(len(ring)))
    ring = ring if turned > 0 else ring[::-1]
    return [*ring, ring[0]]


def coordinates(east: float, north: float, height: float | None = None) -> str:
    return f"{longitude_on_wire(east):.7f},{north:.7f}" + ("" if height is None else f",{height:.3f}")


def placemark(document: ElementTree.Element, name: str, color: str) -> ElementTree.Element:
    """A thing on a map, drawn in a colour, a polygon as its outline."""
    mark = ElementTree.SubElement(document, "Placemark")
    text(mark, "name", name)
    style = ElementTree.SubElement(mark, "Style")
    line = ElementTree.SubElement(style, "LineStyle")
    text(line, "color", color)
    text(line, "width", "3")
    text(ElementTree.SubElement(style, "PolyStyle"), "fill", "0")
    return mark


def text(parent: ElementTree.Element, tag: str, words: str) -> None:
    ElementTree.SubElement(parent, tag).text = words


def written(root: ElementTree.Element, path: Path) -> None:
    """Write an XML document; what XML can't hold of a name is left out."""
    for element in root.iter():
        element.text = "".join(filter(is_character, element.text or "")) or None
    ElementTree.indent(root)
    with written_whole(path) as part:
        ElementTree.ElementTree(root).write(part, encoding="utf-8", xml_declaration=True)


def is_character(one: str) -> bool:
    """Whether XML 1.0 has it."""
    return one in "\t\n" or " " <= one <= "\ud7ff" or "\ue000" <= one <= "\ufffd" or one > "\uffff"
