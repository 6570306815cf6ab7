"""The objects of a CityJSON file, as surfaces in the coordinates of the file.

Each object gives its highest level of detail above 0. What can be no obstacle, what lies inside of buildings or below
the ground, and what has no surfaces is noted. A broken object is an error that names it.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from uavlab.city.documents import progress
from uavlab.city.solids import Body, Surface
from uavlab.city.source import Notes

NESTING = {"MultiSurface": 0, "CompositeSurface": 0, "Solid": 1, "MultiSolid": 2, "CompositeSolid": 2}
"""Geometries that have surfaces, and how many levels of lists stand around them."""

RELIEF = "TINRelief"
HOUSES = {"Building", "BuildingPart"}
INTERIOR = {"BuildingFurniture", "BuildingRoom", "BuildingStorey", "BuildingUnit", "BridgeFurniture", "BridgeRoom"}
NO_OBSTACLE = {"CityObjectGroup", "LandUse", "Railway", "Road", "TransportSquare", "WaterBody", "Waterway"}

PARTIAL = 0.5
"""A level of detail whose plan is a smaller share of a lower one's doesn't show the whole object."""

AGAIN = " (again)"
"""Stands behind the key of an object that another one has already."""

BROKEN = (ArithmeticError, AttributeError, LookupError, TypeError, ValueError)
"""What goes wrong with values of the wrong kind."""


class Thing(NamedTuple):
    """An object, or a building with its parts, and what it consists of."""

    kind: str
    name: str
    bodies: list[Body]
    sources: list[tuple[str, str]]
    """Type and key of each object that it is made of."""


class Shape(NamedTuple):
    """An object as it stands in the file."""

    kind: str
    key: str
    root: str
    """Key of the building that it is a part of, else its own."""
    bodies: list[Body]
    reason: str
    """Why there are no bodies."""


def with_all_keys(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """A JSON object; of objects in it that have the same key none is lost."""
    found = dict(pairs)
    if len(found) < len(pairs):
        found = {}
        for key, value in pairs:
            while key in found and isinstance(value, dict):
                key += AGAIN
            found[key] = value
    return found


def things_in(documents: Sequence[Mapping[str, Any]], file: str, notes: Notes) -> list[Thing]:
    """What of a file may be an obstacle, and its relief; buildings are one with their parts."""
    things: list[Thing] = []
    passed: Counter[str] = Counter()
    for number, document in enumerate(progress(documents, "features")):
        if number and document.get("type") not in ("CityJSONFeature", "CityJSON"):
            raise ValueError(f"{file}: object {number + 1} of the sequence is a {document.get('type')!r}, no feature")
        found = shapes_in(document, documents[0], file, passed)
        things += houses_of([shape for shape in found if shape.kind in HOUSES | INTERIOR], notes)
        for shape in found:
            if shape.key.endswith(AGAIN):
                notes.add("mended", "object with the key of another one, both are kept", shape.key)
            if shape.kind in HOUSES | INTERIOR:
                continue
            if shape.bodies:
                name = shape.key if shape.kind == RELIEF else f"{shape.kind} {shape.key}"
                things.append(Thing(shape.kind, name, shape.bodies, [(shape.kind, shape.key)]))
            elif shape.reason:
                notes.add("left out", f"{shape.kind}: {shape.reason}", shape.key)
    if passed:
        told = ", ".join(f"{number:,} {kind}" for kind, number in passed.most_common())
        notes.add("derived", f"no obstacle: {told}", count=0)
    return things


def houses_of(shapes: Sequence[Shape], notes: Notes) -> list[Thing]:
    """Buildings with their parts; one that has no shape itself takes those of its rooms, which else are left out."""
    groups: dict[str, list[Shape]] = defaultdict(list)
    for shape in shapes:
        groups[shape.root].append(shape)
    houses = []
    for root, group in groups.items():
        outside = [shape for shape in group if shape.kind in HOUSES]
        inside = [shape for shape in group if shape.kind in INTERIOR and shape.bodies]
        shown = [shape for shape in outside if shape.bodies]
        whole = any(shape.kind == "Building" for shape in shown)
        if shown:
            for shape in inside:
                notes.add("left out", f"interior: {shape.kind}", shape.key)
            for shape in outside:
                if not shape.bodies and shape.reason and shape.kind == "BuildingPart" and not whole:
                    notes.add("left out", f"BuildingPart: {shape.reason}", shape.key)
        elif inside:
            shown = inside
            notes.add("derived", "Building from its rooms and storeys, it has no other shape", root)
        else:
            reasons = [shape.reason for shape in outside if shape.reason] or ["no geometry"]
            notes.add("left out", f"Building: {reasons[0]}", root)
            continue
        sources = [(shape.kind, shape.key) for shape in shown]
        houses.append(Thing("Building", root, [body for shape in shown for body in shape.bodies], sources))
    return houses


def shapes_in(document: Mapping[str, Any], first: Mapping[str, Any], file: str, passed: Counter[str]) -> list[Shape]:
    """The objects of a document; those that can't be obstacles are counted only."""
    found = []
    key = "vertices"
    try:
        vertices = points_of(document.get("vertices"))
        own = document if document["type"] == "CityJSON" else first
        key = "transform"
        if own.get("transform") is not None:
            scale, shift = (np.array(own["transform"][name], dtype=float) for name in ("scale", "translate"))
            if scale.shape != (3,) or shift.shape != (3,):
                raise ValueError("scale and translate must be three numbers each")
            vertices = vertices * scale + shift
        key = "vertices"
        if not np.isfinite(vertices).all():
            raise ValueError("a coordinate is infinite")
        key = "geometry-templates"
        templates = templates_of(document.get("geometry-templates") or first.get("geometry-templates") or {})
        key = "CityObjects"
        objects = document.get("CityObjects") or {}
        for key, item in objects.items():
            kind = item["type"]
            if not isinstance(kind, str):
                raise ValueError(f"type must be a text, got {kind!r}")
            if kind in NO_OBSTACLE:
                passed[kind] += 1
            elif kind.startswith("Tunnel"):
                found.append(Shape(kind, key, key, [], "below the ground"))
            else:
                root = root_of(key, objects) if kind in HOUSES | INTERIOR else key
                found.append(Shape(kind, key, root, *bodies_of(item, vertices, templates)))
    except BROKEN as error:
        raise ValueError(f"{file}: {key!r} is malformed: {error!r}") from None
    return found


def points_of(values: Any) -> np.ndarray:
    """Vertices (N, 3) as floats."""
    points = np.array(values or [], dtype=float)
    if points.size and (points.ndim != 2 or points.shape[1] != 3):
        raise ValueError(f"each vertex must have three coordinates, got shape {points.shape}")
    return points.reshape(-1, 3)


def root_of(key: str, objects: Mapping[str, Any]) -> str:
    """Key of the building that an object is a part of, over any number of generations."""
    passed = {key}
    while parents := objects[key].get("parents"):
        parent = parents[0]
        if parent in passed:
            break
        key = parent
        passed.add(key)
        if key not in objects:
            break
    return key


def templates_of(member: Mapping[str, Any]) -> list[tuple[float, list[Body]]]:
    """Level of detail and bodies of each geometry template, in its own coordinates."""
    vertices = points_of(member.get("vertices-templates"))
    if not np.isfinite(vertices).all():
        raise ValueError("a coordinate is infinite")
    return [
        (float(template["lod"]), list(surfaces_of(template, vertices)) if template["type"] in NESTING else [])
        for template in member.get("templates") or []
    ]


def bodies_of(
    item: Mapping[str, Any], vertices: np.ndarray, templates: Sequence[tuple[float, list[Body]]]
) -> tuple[list[Body], str]:
    """Bodies of an object in its highest level of detail, or why it has none; no reason where its children have."""
    levels: dict[float, list[Body]] = defaultdict(list)
    other = []
    for geometry in item.get("geometry") or []:
        if geometry["type"] == "GeometryInstance":
            lod, bodies = instance_of(geometry, vertices, templates)
        elif geometry["type"] in NESTING:
            lod, bodies = float(geometry["lod"]), list(surfaces_of(geometry, vertices))
        else:
            other.append(f"only {geometry['type']}")
            continue
        if bodies and lod >= 1:
            levels[lod] += bodies
        else:
            other.append("level of detail 0 only" if lod < 1 else "no surface with an area")
    if levels:
        lod, *lower = sorted(levels, reverse=True)
        bodies = levels[lod]
        for lod in lower:  # a detail alone, such as a dormer, is no substitute for the house
            bodies = bodies + levels[lod] if PARTIAL * spread(levels[lod]) > spread(bodies) else bodies
        return bodies, ""
    return [], other[0] if other else "" if item.get("children") else "no geometry"


def spread(bodies: Sequence[Body]) -> float:
    """Area of the bounding box of bodies in plan [units²]."""
    plan = np.concatenate([ring[:, :2] for body in bodies for surface in body.surfaces for ring in surface])
    return float(np.prod(np.ptp(plan, axis=0)))


def instance_of(
    geometry: Mapping[str, Any], vertices: np.ndarray, templates: Sequence[tuple[float, list[Body]]]
) -> tuple[float, list[Body]]:
    """A template, turned, scaled and shifted by a 4 × 4 matrix, at a reference point."""
    number, (point,) = geometry["template"], geometry["boundaries"]
    check_index(number, len(templates), "template")
    check_index(point, len(vertices), "vertex")
    matrix = np.array(geometry["transformationMatrix"], dtype=float).reshape(4, 4)
    if not np.isfinite(matrix).all():
        raise ValueError("transformationMatrix is not finite")
    lod, bodies = templates[number]
    shift = vertices[point] + matrix[:3, 3]
    return lod, [
        Body([[ring @ matrix[:3, :3].T + shift for ring in surface] for surface in body.surfaces], body.tight)
        for body in bodies
    ]


def surfaces_of(geometry: Mapping[str, Any], vertices: np.ndarray) -> Iterable[Body]:
    """The bodies of a geometry: each of its solids with its inner shells, or all surfaces that are none."""
    nesting = NESTING[geometry["type"]]
    solids = geometry["boundaries"] if nesting == 2 else [geometry["boundaries"]]
    for solid in solids:
        surfaces = [surface for shell in solid for surface in shell] if nesting else solid
        taken: list[Surface] = []
        edges: set[tuple[int, int]] = set()
        for rings in surfaces:
            for ring in rings:
                check_ring(ring, len(vertices))
                for a, b in zip(ring, ring[1:] + ring[:1], strict=True):
                    edges ^= {(a, b) if a < b else (b, a)}
            if rings and len(rings[0]) > 2:
                taken.append([vertices[ring] for ring in rings if len(ring) > 2])
        if taken:
            yield Body(taken, nesting > 0 and not edges)


def check_ring(ring: Any, count: int) -> None:
    if not isinstance(ring, list) or any(isinstance(index, list) for index in ring):
        raise ValueError(f"a ring must be a list of vertices, got {ring!r:.60}; are lists nested as the type demands?")
    for index in ring:
        check_index(index, count, "vertex")


def check_index(index: Any, count: int, what: str) -> None:
    """Refuse what doesn't count from 0; a negative index would be taken from the end in silence."""
    if type(index) is not int or not 0 <= index < count:
        raise ValueError(f"{what} {index!r} is none of the {count:,}, which are counted from 0")
