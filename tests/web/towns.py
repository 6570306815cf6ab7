"""Cities and questions for tests of planners in a page: Table 1's, random ones, and one with no-fly zones."""

import dataclasses

import numpy as np

from uavlab.city import City, NoFlyZone, table1_city

PARK = NoFlyZone([(20, 0), (55, 5), (50, 40), (30, 45)], upper=60.0, name="park")
TOWER = NoFlyZone([(60, 60), (75, 60), (75, 90), (60, 90)], lower=30.0, name="tower")


def with_zones():
    """Table 1's city with two no-fly zones, in voxels of 2.5 m."""
    return dataclasses.replace(table1_city(cell=2.5), no_fly=(PARK, TOWER))


def random_city(seed):
    """Blocks and single voxels, sometimes with rooms that nobody can leave, on a map that doesn't begin at 0."""
    rng = np.random.default_rng(seed)
    shape = rng.integers((22, 18, 10), (34, 28, 16))
    occupied = rng.random(shape) < rng.choice([0.0, 0.01, 0.05])
    for _ in range(rng.integers(3, 9)):
        low = rng.integers(0, shape - 2)
        high = low + rng.integers(2, (9, 9, 14))
        occupied[tuple(map(slice, low, high))] = True
        if rng.random() < 0.3:
            occupied[tuple(map(slice, low + 1, high - 1))] = False
    cell = float(rng.choice([0.7, 1.0, 2.5]))
    return City(occupied, cell=cell, origin=rng.uniform(-500, 500, 3).round(2), name=f"random city {seed}")


def random_ends(city, count, rng, min_clearance=0.0, apart=1.0):
    """Pairs of points (count, 2, 3) anywhere in voxels that are free, no two in the same or nearly so [cells]."""
    free = np.flatnonzero(~city.blocked(min_clearance))
    pairs = []
    while len(pairs) < count and len(free) > 1:
        index = city.index_of(rng.choice(free, 2))
        if np.linalg.norm(index[1] - index[0]) > apart:
            pairs.append(city.center_of(index) + city.cell * rng.uniform(-0.49, 0.49, (2, 3)))
    return np.array(pairs)


def small_cities():
    return [with_zones(), *(random_city(seed) for seed in range(20))]
