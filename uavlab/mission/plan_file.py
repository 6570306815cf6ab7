"""The `.plan` of QGroundControl: mission, fence and rally points as JSON."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from uavlab import checks
from uavlab.city.documents import read_json
from uavlab.city.place import Place
from uavlab.files import written_whole
from uavlab.mission.items import HOME, NO_FRAME, PLACED, SEA, TERRAIN, FencePolygon, Item, has_place

if TYPE_CHECKING:
    from uavlab.mission.model import Mission

ARDUPILOT, PX4, QUADROTOR = 3, 12, 2
"""MAV_AUTOPILOT and MAV_TYPE that a plan names; PX4 takes no altitudes above terrain."""

ALTITUDE_MODES = {HOME: 1, SEA: 2, TERRAIN: 4}
"""What QGroundControl calls the frames."""

SAME_FRAMES = {5: SEA, 6: HOME, 11: TERRAIN}
"""Frames with other numbers and the same meaning, of degrees as whole numbers."""

CIRCLE_CORNERS = 32

FENCE_VERSION = RALLY_VERSION = MISSION_VERSION = 2


def write_plan(mission: Mission, path: str | Path) -> None:
    """`Mission.to_plan`."""
    with written_whole(checks.path("path", path)) as part:
        part.write_text(json.dumps(plan_of(mission), indent=4, ensure_ascii=False) + "\n", encoding="utf-8")


def plan_of(mission: Mission) -> dict[str, Any]:
    """A mission as the file has it; what that has no place for stands under "uavlab"."""
    home = mission.home
    polygons = [
        {"inclusion": polygon.inclusion, "polygon": [list(corner) for corner in polygon.corners], "version": 1}
        for polygon in mission.fence
    ]
    return {
        "fileType": "Plan",
        "version": 1,
        "groundStation": "uavlab",
        "mission": {
            "version": MISSION_VERSION,
            "firmwareType": ARDUPILOT if any(item.frame == TERRAIN for item in mission.items) else PX4,
            "vehicleType": QUADROTOR,
            "cruiseSpeed": mission.speed,
            "hoverSpeed": mission.speed,
            "globalPlanAltitudeMode": ALTITUDE_MODES.get(
                next((i.frame for i in mission.items if has_place(i)), HOME), 1
            ),
            "plannedHomePosition": [home.latitude, home.longitude, home.height],
            "items": [simple_item(number, item) for number, item in enumerate(mission.items, 1)],
        },
        "geoFence": {"version": FENCE_VERSION, "polygons": polygons, "circles": []},
        "rallyPoints": {
            "version": RALLY_VERSION,
            "points": [[p.latitude, p.longitude, p.height] for p in mission.rally],
        },
        "uavlab": {
            "heights": mission.heights,
            "place": None if mission.place is None else list(mission.place),
            "corner_radius": mission.corner_radius,
            "return_height": mission.return_height,
            "name": mission.name,
            "notes": list(mission.notes),
        },
    }


def simple_item(number: int, item: Item) -> dict[str, Any]:
    """An item as the file has it; null is NaN, "leave it as it is"."""
    parameters = [None if math.isnan(value) else value for value in item.parameters]
    simple: dict[str, Any] = {
        "type": "SimpleItem",
        "autoContinue": True,
        "command": item.command,
        "doJumpId": number,
        "frame": item.frame,
        "params": [*parameters, item.latitude, item.longitude, item.altitude],
    }
    if has_place(item):
        simple |= {
            "AMSLAltAboveTerrain": None,
            "Altitude": item.altitude,
            "AltitudeMode": ALTITUDE_MODES.get(item.frame, 1),
        }
    return simple


def fields_of_plan(path: Path) -> dict[str, Any]:
    """What a file says of a mission, by the names of its fields."""
    try:
        (plan, *more) = read_json(path)
        if more:
            raise ValueError("it holds more than one object")
        if plan.get("fileType") != "Plan":
            raise ValueError(f"its fileType is {plan.get('fileType')!r:.40}, not 'Plan'")
        mission, ours = part_of(plan, "mission"), part_of(plan, "uavlab", {})
        notes = list(ours.get("notes", []))
        latitude, longitude, height = part_of(mission, "plannedHomePosition")
        return {
            "items": tuple(item_of(number, item) for number, item in enumerate(entries(mission, "items"))),
            "home": Place(longitude, latitude, 0.0 if height is None else height),
            "fence": tuple(fence_of(part_of(plan, "geoFence", {}), notes)),
            "rally": tuple(place_at(point) for point in entries(part_of(plan, "rallyPoints", {}), "points")),
            "speed": mission.get("hoverSpeed", 5.0) or 5.0,
            "corner_radius": ours.get("corner_radius", 2.0),
            "heights": ours.get("heights", "unknown" if height is None else "above sea"),
            "place": None if ours.get("place") is None else Place(*ours["place"]),
            "return_height": ours.get("return_height", 0.0),
            "name": ours.get("name", path.stem),
            "notes": tuple(notes),
        }
    except (AttributeError, KeyError, TypeError, ValueError, IndexError) as error:
        raise ValueError(f"{path.name} is no plan of QGroundControl, or damaged: {error!s:.300}") from error


MISSING: Any = object()


def part_of(whole: Mapping[str, Any], name: str, default: Any = MISSING) -> Any:
    """A part of an object; `ValueError` if it isn't there and has no default."""
    if not isinstance(whole, Mapping):
        raise ValueError(f"an object was expected where {name!r} should be, got {whole!r:.40}")
    if default is MISSING and name not in whole:
        raise ValueError(f"it has no {name!r}")
    return whole.get(name, default)


def entries(whole: Mapping[str, Any], name: str) -> list[Any]:
    """A list in an object; empty where it isn't there, but for the items of the mission."""
    listed = part_of(whole, name, MISSING if name == "items" else [])
    if not isinstance(listed, list):
        raise ValueError(f"{name} must be a list, got {listed!r:.40}")
    return listed


def item_of(number: int, simple: Mapping[str, Any]) -> Item:
    """The item that an entry of the file says."""
    if part_of(simple, "type") != "SimpleItem":
        kind = simple.get("complexItemType", simple["type"])
        raise ValueError(
            f"items[{number}] is a {kind!r}: only simple items can be read, let QGroundControl write those"
        )
    if len(simple["params"]) != 7:
        raise ValueError(f"items[{number}] must have 7 params, got {len(simple['params'])}")
    frame = SAME_FRAMES.get(simple["frame"], simple["frame"])
    parameters, place = [math.nan if value is None else value for value in simple["params"][:4]], simple["params"][4:]
    if None in place:
        if frame != NO_FRAME or simple["command"] in PLACED:
            raise ValueError(f"items[{number}] has no place, or no altitude")
        place = [0.0 if value is None else value for value in place]
    return Item(simple["command"], frame, tuple(parameters), *place)  # type: ignore[arg-type]


def place_at(latlon: Sequence[float]) -> Place:
    """A place that stands as latitude, longitude and height."""
    latitude, longitude, height = latlon
    return Place(longitude, latitude, height)


def fence_of(fence: Mapping[str, Any], notes: list[str]) -> list[FencePolygon]:
    """Polygons of a fence; circles are made polygons, smaller to stay inside of, larger to stay outside of."""
    polygons = [
        FencePolygon(tuple(tuple(corner) for corner in one["polygon"]), one["inclusion"])
        for one in entries(fence, "polygons")
    ]
    circles = entries(fence, "circles")
    if circles:
        notes.append(f"{len(circles)} circles of the fence are polygons of {CIRCLE_CORNERS} corners here")
    return polygons + [circle_of(one["circle"], one["inclusion"]) for one in circles]


def circle_of(circle: Mapping[str, Any], inclusion: bool) -> FencePolygon:
    """A circle as a polygon on its safe side."""
    latitude, longitude = circle["center"]
    radius = checks.positive_number("radius", circle["radius"])
    turn = np.linspace(0.0, 2 * np.pi, CIRCLE_CORNERS, endpoint=False)
    reach = radius if inclusion else radius / np.cos(np.pi / CIRCLE_CORNERS)
    degrees = Place(longitude, latitude).longitude_latitude(reach * np.column_stack([np.cos(turn), np.sin(turn)]))
    return FencePolygon(tuple((north, east) for east, north in degrees.tolist()), inclusion)
