"""What routes on the grid are held against: legal moves, additive costs, SciPy's Dijkstra."""

import itertools

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

OFFSETS = [offset for offset in itertools.product((-1, 0, 1), repeat=3) if any(offset)]


def ways(occupied, price):
    """All legal moves as a sparse matrix, from the definition: the bounding box of a move is free."""
    code = np.arange(occupied.size).reshape(occupied.shape)
    begins, ends, costs = [], [], []
    for offset in OFFSETS:
        here = tuple(slice(max(-o, 0), n - max(o, 0)) for o, n in zip(offset, occupied.shape, strict=True))
        free = np.ones(code[here].shape, bool)
        for corner in itertools.product(*({0, o} for o in offset)):
            free &= ~occupied[tuple(slice(s.start + c, s.stop + c) for s, c in zip(here, corner, strict=True))]
        there = tuple(slice(s.start + o, s.stop + o) for s, o in zip(here, offset, strict=True))
        begins.append(code[here][free])
        ends.append(code[there][free])
        costs.append(np.linalg.norm(offset) * (price[here][free] + price[there][free]) / 2)
    edges = np.concatenate(costs), (np.concatenate(begins), np.concatenate(ends))
    return coo_array(edges, shape=(occupied.size, occupied.size)).tocsr()


def cheapest_by_scipy(city, start, goal, price=None, occupied=None):
    """Cost of the cheapest way [m · price]; infinite where there is none."""
    occupied = city.occupied if occupied is None else occupied
    price = np.ones(city.shape) if price is None else price
    source, target = city.code_of(city.cell_of(start)), city.code_of(city.cell_of(goal))
    return dijkstra(ways(occupied, price), indices=source)[target] * city.cell


def is_legal(city, path):
    """Whether all voxels of the bounding boxes of a path's moves are free."""
    return not any(
        city.occupied[tuple(slice(min(a, b), max(a, b) + 1) for a, b in zip(here, there, strict=True))].any()
        for here, there in itertools.pairwise(path.tolist())
    )


def additive_cost(city, route, price):
    """Σ d·(price at both ends)/2 over the moves of a route."""
    along = price[tuple(city.cell_of(route.points).T)]
    return float((route.leg_lengths * (along[1:] + along[:-1]) / 2).sum())
