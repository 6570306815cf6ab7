"""Parts of buildings (`building:part` of OpenStreetMap): they say better than the outline how high a building is where.

A part overrides the outline that it lies in; what no part covers stays as high as the outline says.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely

from uavlab.city.blocks import Block, plans_of
from uavlab.city.buildings import polygons_in
from uavlab.city.footprints import BUILDING, PART
from uavlab.city.source import Notes

NARROWEST = 0.1
"""What parts leave of an outline counts from this width on [m]; less is how two outlines were drawn apart."""


def overridden_by_parts(blocks: Sequence[Block], notes: Notes) -> list[Block]:
    """Bodies without the outlines that are described by their parts; what no part covers stays as high as it was."""
    parts = [block for block in blocks if block.kind == PART]
    outlines = [block for block in blocks if block.kind != PART]
    if not parts:
        notes.add("taken", BUILDING, count=len(blocks))
        return list(blocks)
    kept: list[Block] = []
    heirs: dict[int, float] = {}
    sites: dict[int, shapely.MultiPolygon] = {}
    for block, members in zip(outlines, without_parts(outlines, parts), strict=True):
        heirs |= {number: max(heirs.get(number, -np.inf), block.top) for number in members}
        sites |= dict.fromkeys(members, block.plan)
        if not members:
            kept.append(block)
            continue
        notes.add("derived", "outline overridden by its parts", block.label)
        rest = rest_of(block.plan, [parts[number].plan for number in members])
        if not rest.is_empty:
            notes.add("derived", "what no part covers, as high as its outline", block.label)
            kept.append(block._replace(plan=rest, site=block.plan))
    for number, part in enumerate(parts):
        if np.isnan(part.top):
            if number not in heirs:
                notes.add("left out", "part without height and outline", part.label)
                continue
            notes.add("derived", "part as high as its outline", part.label)
            part = part._replace(top=max(heirs[number], part.base + 1.0))
        kept.append(part._replace(site=sites.get(number)))
    for kind in (BUILDING, PART):
        if any(block.kind == kind for block in kept):
            notes.add("taken", kind, count=sum(block.kind == kind for block in kept))
    return kept


def without_parts(outlines: Sequence[Block], parts: Sequence[Block]) -> list[list[int]]:
    """For each outline [m] the numbers of the parts that override it: those at least half of which lie in it."""
    outside, inside = plans_of(outlines), plans_of(parts)
    of, part = shapely.STRtree(inside).query(outside, predicate="intersects")
    shared = shapely.area(shapely.intersection(inside[part], outside[of]))
    members: list[list[int]] = [[] for _ in outlines]
    for outline, number in np.column_stack([of, part])[shared >= 0.5 * shapely.area(inside[part])]:
        members[outline].append(int(number))
    return members


def rest_of(outline: shapely.MultiPolygon, parts: Sequence[shapely.MultiPolygon]) -> shapely.MultiPolygon:
    """What parts leave of an outline [m], where it is wide enough to be more than two ways to draw a line."""
    left = outline.difference(shapely.union_all(parts))
    opened = left.buffer(-NARROWEST / 2)
    return shapely.MultiPolygon([p for p in polygons_in(left) if not p.intersection(opened).is_empty])
