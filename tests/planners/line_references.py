"""What straight legs are held against: random cases, and whether a line touches an obstacle."""

import itertools

import numpy as np

from uavlab.city import City
from uavlab.planners import astar


def random_case(seed, *, side=(6, 16), densest=0.15):
    """A random map, a route that A* found in it, and the price that it was found with."""
    rng = np.random.default_rng(seed)
    shape = rng.integers(*side, 3)
    occupied = rng.random(shape) < rng.uniform(0, densest)
    occupied[0, 0, 0] = occupied[-1, -1, -1] = False
    city = City(occupied, cell=rng.uniform(0.5, 3), origin=rng.uniform(-50, 50, 3))
    price = 10 ** rng.uniform(-0.5, 0.5, shape)
    start, goal = city.center_of([(0, 0, 0), np.array(shape) - 1])
    return city, price, astar(city, start, goal), astar(city, start, goal, price=price)


def touches_obstacle(city, start, end, step=0.01):
    """Whether a leg has a point in common with an occupied voxel, faces, edges and corners included.

    Looks every `step` cells, and where the leg crosses a plane between voxels.
    """
    start, end = ((np.asarray(point) - city.origin) / city.cell for point in (start, end))
    shares = [np.linspace(0, 1, int(np.linalg.norm(end - start) / step) + 2)]
    for a, b in zip(start, end, strict=True):
        if abs(b - a) > 1e-9:
            planes = np.arange(np.ceil(min(a, b)), np.floor(max(a, b)) + 1)
            shares.append((planes - a) / (b - a))
    points = start + np.outer(np.concatenate(shares), end - start)
    for shift in itertools.product((-1e-7, 1e-7), repeat=3):
        index = np.floor(points + shift).astype(int)
        inside = ((index >= 0) & (index < city.shape)).all(axis=1)
        if city.occupied[tuple(index[inside].T)].any():
            return True
    return False
