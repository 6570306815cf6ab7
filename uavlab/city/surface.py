"""The surface of a union of convex pieces, as it is drawn: without walls between pieces, edges only where it bends.

Pieces that were cut from one footprint, or that stand for the faces of a surface, share whole facets. What two pieces
share from opposite sides lies inside. Pieces that only overlap keep their facets: what is inside is hidden by what is
outside.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from uavlab.city.buildings import Hull

STEP = 1e-5
"""Corners that are nearer to each other are one, planes that differ by less are one [m]."""
LEAST_BEND = np.radians(10.0)
"""Flatter bends have no line: terrain and round roofs have many."""


def outer_surface(hulls: Sequence[Hull]) -> tuple[np.ndarray, np.ndarray]:
    """Triangles (T, 3, 3) [m], counter-clockwise from outside, and ends (2E, 3) [m] of the edges where they bend."""
    corners = np.concatenate([hull.triangles for hull in hulls])
    planes = np.concatenate([hull.equations for hull in hulls])
    piece = np.repeat(np.arange(len(hulls)), [len(hull.simplices) for hull in hulls])
    normals = planes[:, :3]
    inward = np.einsum("ij,ij->i", np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), normals) < 0
    corners[inward] = corners[inward][:, ::-1]

    places = np.round(corners.reshape(-1, 3) / STEP).astype(np.int64)
    point = numbered(places).reshape(-1, 3)
    facet = numbered(np.column_stack([piece, np.round(planes / STEP).astype(np.int64)]))
    kept = ~is_between(facet, point, normals)
    return corners[kept], bends(corners[kept], point[kept], normals[kept])


def is_between(facet: np.ndarray, point: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Whether the facet of each triangle (T,) has the same corners, points (T, 3), as one that faces it.

    Facets that face the same way, as of two pieces that are the same, are a surface all the same.
    """
    pairs = np.unique(np.column_stack([np.repeat(facet, 3), point.ravel()]), axis=0)
    marks = np.random.default_rng(0).integers(0, 2**62, point.max() + 1)  # equal sums: equal corners, all but surely
    sums = np.zeros(facet.max() + 1, dtype=np.int64)
    np.add.at(sums, pairs[:, 0], marks[pairs[:, 1]])
    _, first, same = np.unique(sums[facet], return_index=True, return_inverse=True)
    faced = np.zeros(len(first), dtype=bool)
    np.logical_or.at(faced, same, np.einsum("ij,ij->i", normals, normals[first][same]) < 0)
    return faced[same]


def bends(corners: np.ndarray, point: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Ends (2E, 3) [m] of the edges of triangles (T, 3, 3) whose neighbours lie in another plane, or that have none."""
    edges = np.sort(point[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    ends = corners[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2, 3)
    order = np.lexsort(edges.T)
    edges, ends, normal = edges[order], ends[order], np.repeat(normals, 3, axis=0)[order]
    first = np.concatenate([[True], (edges[1:] != edges[:-1]).any(axis=1)])
    group = np.cumsum(first) - 1
    alike = np.einsum("ij,ij->i", normal, normal[first][group]) > np.cos(LEAST_BEND)
    flat = np.minimum.reduceat(alike, np.flatnonzero(first)) & (np.bincount(group) > 1)
    return ends[first][~flat].reshape(-1, 3)


def numbered(rows: np.ndarray) -> np.ndarray:
    """A number for each row (N, ...), (N,): the same for equal rows."""
    return np.unique(rows, axis=0, return_inverse=True)[1].ravel()
