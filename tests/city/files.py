"""Small city files for the tests of the readers to write."""

import json

import numpy as np

SQUARE = [[1000, 2000], [1010, 2000], [1010, 2010], [1000, 2010], [1000, 2000]]  # 10 × 10 m
COURTYARD = [[1003, 2003], [1007, 2003], [1007, 2007], [1003, 2007], [1003, 2003]]  # 4 × 4 m
FAR = [[1040, 2040], [1050, 2040], [1050, 2050], [1040, 2050], [1040, 2040]]


def feature(*rings, kind="Polygon", **properties):
    return {"type": "Feature", "properties": properties, "geometry": {"type": kind, "coordinates": list(rings)}}


def write(path, *documents, encoding="utf-8"):
    """Documents as JSON, one per line; a text as it is."""
    lines = [document if isinstance(document, str) else json.dumps(document) for document in documents]
    path.write_text("\n".join(lines), encoding=encoding)
    return path


def volume(city):
    """Of what is above the ground [m³]."""
    centers = city.center_of(np.argwhere(city.occupied))
    return np.count_nonzero(city.height_above_ground(centers) > 0) * city.cell**3


BOX_CORNERS = [(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
BOX = [[[0, 3, 2, 1]], [[4, 5, 6, 7]], [[0, 1, 5, 4]], [[1, 2, 6, 5]], [[2, 3, 7, 6]], [[3, 0, 4, 7]]]
TRIANGULATED_BOX = [[[ring[0], ring[i], ring[i + 1]]] for (ring,) in BOX for i in (1, 2)]
GABLE = [[[0, 3, 2, 1]], [[0, 1, 5, 8, 4]], [[2, 3, 7, 9, 6]], [[1, 2, 6, 5]], [[3, 0, 4, 7]]]
GABLE += [[[4, 8, 9, 7]], [[5, 6, 9, 8]]]  # the ridge, 8 to 9, runs along y


def box(low, high):
    return [[low[a] + (high[a] - low[a]) * corner[a] for a in range(3)] for corner in BOX_CORNERS]


def shifted(surfaces, by):
    return [[[index + by for index in ring] for ring in rings] for rings in surfaces]


def solid(surfaces, lod="1"):
    return {"type": "Solid", "lod": lod, "boundaries": [surfaces]}


def building(*geometry, **members):
    return {"type": "Building", "geometry": list(geometry), **members}
