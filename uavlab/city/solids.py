"""From the surfaces of a city model to solids of convex pieces.

Files hold surfaces: roofs, walls, decks. Seen from above, each that is not a wall is a polygon in a plane, and what
lies between two planes over a convex polygon is a convex piece, here a `Column`. A building is filled from its roofs
down to its own lowest point; a bridge or a mast keeps its lower surface, so that one can fly below it. A surface with
nothing above or below it is a thin slab, and so is what of a wall no column covers: nothing gets lost.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np
import shapely

from uavlab.city.buildings import convex_parts, polygons_in

THINNEST = 1e-3
"""What is thinner or lower [m] is nothing, or a wall seen from above; files of city models keep three decimals."""

SHEET = 0.1
"""How thick [m] a surface becomes that encloses nothing."""

MOST_OVERLAPS = 50
"""If a surface lies above or below more others than this, on average, the body is filled: a lattice of thin bars."""

Surface = Sequence[np.ndarray]
"""A polygon in space: rings (M, 3) [m], the outline first."""

NOTHING = shapely.Polygon()


class Body(NamedTuple):
    """Surfaces that belong together: a solid, or what an object has instead."""

    surfaces: list[Surface]
    tight: bool
    """Whether they close a volume without a gap, so that no wall stands alone."""


class Column(NamedTuple):
    """What lies between two planes z = a·x + b·y + c over a convex outline (M, 2) [m]."""

    outline: np.ndarray
    planes: np.ndarray
    """(2, 3) a, b, c; they may change sides within the outline."""

    @property
    def corners(self) -> np.ndarray:
        """Of the convex piece, (2M, 3) [m]: the lower ones, then the upper ones."""
        low, high = np.sort(heights_at(self.outline, self.planes), axis=0)
        return np.vstack([np.column_stack([self.outline, low]), np.column_stack([self.outline, high])])


class Facets(NamedTuple):
    """A body's surfaces: polygons seen from above in their planes, and walls, which have no area from there."""

    polygons: np.ndarray
    """(F,) of shapely."""
    planes: np.ndarray
    """(F, 3) a, b, c of z = a·x + b·y + c."""
    walls: list[Surface]


def filled(bodies: Sequence[Body], bottom: float) -> tuple[list[np.ndarray], bool]:
    """Convex pieces that fill the space from surfaces down to a height, and whether that closes a passage."""
    found = [facets_of(body) for body in bodies]
    facets = Facets(
        np.concatenate([each.polygons for each in found]),
        np.concatenate([each.planes for each in found]),
        [wall for each in found for wall in each.walls],
    )
    columns, passage = columns_above(facets, bottom)
    return pieces_of(columns, facets.walls), passage


def enclosed(body: Body) -> tuple[list[np.ndarray], bool]:
    """Convex pieces that fill the space between the surfaces of a body, and whether any are more than thin slabs."""
    facets = facets_of(body)
    columns, sheets = columns_between(facets)
    pieces = pieces_of([*columns, *sheets], facets.walls)
    return pieces, len(pieces) > len(sheets)


def facets_of(body: Body) -> Facets:
    """A body as seen from above; of a tight one without its walls.

    Level surfaces of one height are joined, so that a roof of many triangles stays one.
    """
    level: dict[float, list[tuple[float, shapely.Polygon]]] = defaultdict(list)
    polygons, planes, walls = [], [], []
    plans = plans_of(body.surfaces)
    for surface, polygon, thick in zip(body.surfaces, plans, is_thick(plans), strict=True):
        z = surface[0][:, 2] if len(surface) == 1 else np.concatenate(surface)[:, 2]
        lowest, highest = z.min(), z.max()
        if not thick:
            walls.append(surface)
        elif highest - lowest < THINNEST:
            level[round(highest, 3)].append((highest, polygon))
        else:
            for part, plane in sloped(surface, polygon):
                polygons.append(part)
                planes.append(plane)
    for found in level.values():
        height = max(highest for highest, _ in found)
        joined = shapely.union_all([polygon for _, polygon in found]) if len(found) > 1 else found[0][1]
        for polygon in polygons_in(joined):
            polygons.append(polygon)
            planes.append(np.array([0.0, 0.0, height]))
    return Facets(np.array(polygons, dtype=object), np.reshape(planes, (-1, 3)), [] if body.tight and planes else walls)


def plans_of(surfaces: Sequence[Surface]) -> np.ndarray:
    """Polygons (S,) of surfaces seen from above; one that crosses itself covers what its outline goes around."""
    rings = [ring for surface in surfaces for ring in surface]
    owner = np.repeat(np.arange(len(surfaces)), [len(surface) for surface in surfaces])
    if not rings:
        return np.empty(0, dtype=object)
    corner_of = np.repeat(np.arange(len(rings)), [len(ring) for ring in rings])
    polygons = shapely.polygons(shapely.linearrings(np.concatenate(rings)[:, :2], indices=corner_of), indices=owner)
    polygons[~is_thick(shapely.convex_hull(polygons))] = NOTHING
    for broken in np.flatnonzero(~shapely.is_valid(polygons)):
        polygons[broken] = shapely.MultiPolygon(polygons_in(shapely.make_valid(polygons[broken])))
    return polygons


def sloped(surface: Surface, polygon: shapely.Geometry) -> list[tuple[shapely.Polygon, np.ndarray]]:
    """A sloped surface as polygons in planes: whole if its corners lie in one, else cut into triangles."""
    corners = np.concatenate(surface)
    plane, off = plane_through(corners)
    if off < THINNEST and polygon.geom_type == "Polygon":
        return [(polygon, plane + np.array([0.0, 0.0, off]))]
    found = []
    for triangle in triangles_of(surface, polygon):
        found.append((shapely.Polygon(triangle[:, :2]), plane_through(triangle)[0]))
    return found


def triangles_of(surface: Surface, polygon: shapely.Geometry, *, top_only: bool = False) -> list[np.ndarray]:
    """Triangles (3, 3) [m] of a surface whose plan is a polygon; where it has a step, through its top and its foot."""
    corners = np.concatenate(surface)
    if len(surface) == 1 and len(corners) == 3:
        return [corners] if is_thick(polygon) else []
    triangles = []
    stepped = not top_only and len(np.unique(corners[:, :2], axis=0)) < len(np.unique(corners, axis=0))
    for order in (1, -1) if stepped else (-1,):
        ranked = corners[np.argsort(order * corners[:, 2], kind="stable")]
        for triangle in filter(is_thick, shapely.constrained_delaunay_triangles(polygon).geoms):
            plan = shapely.get_coordinates(triangle)[:3]
            apart = np.linalg.norm(plan[:, None] - ranked[:, :2], axis=2)
            known = apart.min(axis=1) < THINNEST  # a repaired outline has new corners, where it crossed itself
            triangles.append(np.column_stack([plan, np.where(known, ranked[apart.argmin(axis=1), 2], ranked[0, 2])]))
    return triangles


def plane_through(points: np.ndarray) -> tuple[np.ndarray, float]:
    """The plane z = a·x + b·y + c (3,) nearest to points (M, 3) in height, and how far off the worst is [m]."""
    if len(points) == 3:
        (ax, ay, az), (bx, by, bz) = (points[1:] - points[0]).tolist()
        twice = ax * by - ay * bx
        a, b = (az * by - ay * bz) / twice, (ax * bz - az * bx) / twice
        return np.array([a, b, points[0, 2] - a * points[0, 0] - b * points[0, 1]]), 0.0
    middle = points.mean(axis=0)
    slope = np.linalg.lstsq(points[:, :2] - middle[:2], points[:, 2] - middle[2], rcond=None)[0]
    plane = np.array([*slope, middle[2] - slope @ middle[:2]])
    return plane, float(np.abs(heights_at(points[:, :2], plane[None])[0] - points[:, 2]).max())


def heights_at(points: np.ndarray, planes: np.ndarray) -> np.ndarray:
    """Heights (P, M) [m] of planes (P, 3) at points (M, 2)."""
    return planes[:, :2] @ points.T + planes[:, 2:]


def columns_above(facets: Facets, bottom: float) -> tuple[list[Column], bool]:
    """Columns from surfaces down to a height, and whether some surface between is covered: a passage, a step, a floor.

    A level surface that lies wholly below others adds nothing.
    """
    ground = np.array([0.0, 0.0, bottom])
    level = ~facets.planes[:, :2].any(axis=1)
    columns, low = [], []
    for polygon, plane in zip(facets.polygons[~level], facets.planes[~level], strict=True):
        columns += [Column(outline, np.array([ground, plane])) for outline in convex_parts(polygon)]
        low.append(heights_at(shapely.get_coordinates(polygon), plane[None]).min())
    slopes, lowest = facets.polygons[~level], np.array(low)
    higher, passage = NOTHING, False
    heights = facets.planes[level, 2]
    for height in sorted({*heights[heights > bottom + THINNEST]}, reverse=True):
        here = facets.polygons[level][heights == height]
        cover = shapely.union_all([higher, *slopes[lowest >= height - THINNEST]])
        for polygon in here:
            if is_thick(polygon.difference(cover)):
                columns += [
                    Column(outline, np.array([ground, [0.0, 0.0, height]])) for outline in convex_parts(polygon)
                ]
            else:
                passage = True
        higher = shapely.union_all([higher, *here])
    return columns, passage


def columns_between(facets: Facets) -> tuple[list[Column], list[Column]]:
    """Columns between all surfaces that lie above each other, and thin ones below what is left of them."""
    polygons, planes = facets.polygons, facets.planes
    first, second = shapely.STRtree(polygons).query(polygons, predicate="intersects")
    first, second = first[first < second], second[first < second]
    if len(first) > MOST_OVERLAPS * len(polygons):
        corners = map(shapely.get_coordinates, polygons)
        bottom = min(heights_at(xy, plane[None]).min() for xy, plane in zip(corners, planes, strict=True))
        return columns_above(facets, float(bottom))[0], []
    overlaps = shapely.intersection(polygons[first], polygons[second])
    wide = is_thick(overlaps)  # most only share an edge
    columns, used = [], defaultdict(list)
    for i, j, overlap in zip(first[wide], second[wide], overlaps[wide], strict=True):
        for part in filter(is_thick, polygons_in(overlap)):
            apart = heights_at(shapely.get_coordinates(part), planes[[i, j]])
            if np.abs(apart[0] - apart[1]).max() > THINNEST:
                columns += [Column(outline, planes[[i, j]]) for outline in convex_parts(part)]
                used[i].append(part)
                used[j].append(part)
    sheets = []
    for i, (polygon, plane) in enumerate(zip(polygons, planes, strict=True)):
        rest = polygon.difference(shapely.union_all(used[i])) if i in used else polygon
        for part in filter(is_thick, polygons_in(rest)):
            below = np.array([plane - np.array([0.0, 0.0, SHEET]), plane])
            sheets += [Column(outline, below) for outline in convex_parts(part)]
    return columns, sheets


def pieces_of(columns: Sequence[Column], walls: Sequence[Surface]) -> list[np.ndarray]:
    """Corners of convex pieces: the columns, and thin slabs for what of the walls lies in none of them."""
    pieces = [column.corners for column in columns]
    return pieces + bare_walls(columns, pieces, walls)


def has_walls(bodies: Iterable[Body]) -> bool:
    """Whether a wall, or a closed volume, stands below the roofs of a building."""
    return any(body.tight or not is_thick(plans_of(body.surfaces)).all() for body in bodies)


class Front(NamedTuple):
    """A wall in its own plane: how far along, and how high."""

    start: np.ndarray
    along: np.ndarray
    """Where it begins (2,), and its direction (2,), in plan."""
    polygon: shapely.Geometry


def bare_walls(columns: Sequence[Column], pieces: Sequence[np.ndarray], walls: Sequence[Surface]) -> list[np.ndarray]:
    """Thin slabs, (2M, 3) [m] each, for what of walls doesn't lie in columns or on their sides.

    In the plane of a wall, along and up, a column that the wall passes is a quadrilateral; it is taken away.
    """
    fronts = [front for front in map(front_of, walls) if front is not None]
    wall, quads = quadrilaterals(columns, pieces, fronts)
    polygons = np.array([front.polygon for front in fronts], dtype=object)
    bare = np.ones(len(fronts), dtype=bool)
    bare[wall[shapely.covers(quads, polygons[wall])]] = False
    slabs = []
    for w in np.flatnonzero(bare):
        start, along, front = fronts[w]
        across = SHEET / 2 * np.array([-along[1], along[0]])
        for part in filter(is_thick, polygons_in(front.difference(shapely.union_all(quads[wall == w])))):
            for outline in convex_parts(part):
                plan = start + outline[:, :1] * along
                slabs.append(np.vstack([np.column_stack([plan + side, outline[:, 1]]) for side in (across, -across)]))
    return slabs


def front_of(wall: Surface) -> Front | None:
    """A wall in its own plane; None if it has no area there."""
    corners = np.concatenate(wall)[:, :2]
    start = corners[np.square(corners - corners[0]).sum(axis=1).argmax()]
    end = corners[np.square(corners - start).sum(axis=1).argmax()]
    length = np.linalg.norm(end - start)
    if length < THINNEST:
        return None
    along = (end - start) / length
    outline, *holes = [np.column_stack([(ring[:, :2] - start) @ along, ring[:, 2]]) for ring in wall]
    polygon = shapely.Polygon(outline, holes)
    if not polygon.is_valid:
        polygon = shapely.make_valid(polygon)
    return Front(start, along, polygon) if is_thick(polygon) else None


def quadrilaterals(
    columns: Sequence[Column], pieces: Sequence[np.ndarray], fronts: Sequence[Front]
) -> tuple[np.ndarray, np.ndarray]:
    """Columns that walls pass or touch: which wall, and the column in its plane as a polygon, a trifle larger."""
    if not columns or not fronts:
        return np.empty(0, dtype=int), np.empty(0, dtype=object)
    slack = 2 * THINNEST
    owner = np.repeat(np.arange(len(columns)), [len(column.outline) for column in columns])
    plans = shapely.polygons(shapely.linearrings(np.concatenate([column.outline for column in columns]), indices=owner))
    plans = shapely.buffer(plans, slack, join_style="mitre", mitre_limit=2)
    start, along = np.array([front.start for front in fronts]), np.array([front.along for front in fronts])
    ends = shapely.bounds([front.polygon for front in fronts])[:, [0, 2], None]
    lines = shapely.linestrings(start[:, None] + ends * along[:, None])
    wall, column = shapely.STRtree(plans).query(lines, predicate="intersects")
    points, of = shapely.get_coordinates(shapely.intersection(lines[wall], plans[column]), return_index=True)
    known, first = np.unique(of, return_index=True)
    wall, column = wall[known], column[known]
    reach = np.einsum(
        "nk,nk->n", points - start[wall[np.searchsorted(known, of)]], along[wall[np.searchsorted(known, of)]]
    )
    sides = np.stack([np.minimum.reduceat(reach, first), np.maximum.reduceat(reach, first)], axis=1)
    at = start[wall, None] + sides[..., None] * along[wall, None]
    planes = np.array([column.planes for column in columns])[column]
    heights = np.einsum("npk,nsk->nps", planes[..., :2], at) + planes[..., 2:]
    z = [(piece[:, 2].min(), piece[:, 2].max()) for piece in pieces]
    least, most = np.array(z)[column].T[..., None]
    low = heights.min(axis=1).clip(least, most) - slack
    high = heights.max(axis=1).clip(least, most) + slack
    (left, right), (low_left, low_right), (high_left, high_right) = sides.T, low.T, high.T
    around = [[left, low_left], [right, low_right], [right, high_right], [left, high_left]]
    return wall, shapely.polygons(np.moveaxis(np.array(around), -1, 0))


def is_thick(polygons: Any) -> Any:
    """Whether polygons are wider than about a millimetre; a wall, seen from above, is not."""
    return 2 * shapely.area(polygons) > THINNEST * shapely.length(polygons)
