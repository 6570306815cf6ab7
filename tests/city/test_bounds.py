"""What legs must keep: heights, zones and obstacles, against dense samples."""

import numpy as np
import pytest

from uavlab.city import Building, City, NoFlyZone
from uavlab.city.bounds import bounds_of, keeps, least_room, legs_keep, slack_of


@pytest.mark.parametrize("aside", [0.0, 0.3])
@pytest.mark.parametrize("seed", range(30))
def test_room_is_the_least_over_the_columns_that_samples_meet(seed, aside):
    rng = np.random.default_rng(seed)
    lowest = rng.uniform(0, 3, (9, 7))
    highest = lowest + rng.uniform(3, 6, (9, 7))
    start, end = rng.uniform(0, (9, 7, 9), (2, 3))
    if seed % 5 == 0:
        end[:2] = start[:2]
    room = least_room(lowest[..., None], highest, start, end, aside)
    points = start + np.linspace(0, 1, 20_001)[:, None] * (end - start)
    least = np.inf
    for shift in np.array([(-1, -1), (-1, 1), (1, -1), (1, 1), (0, 0)]) * aside:
        index = np.clip(np.floor(points[:, :2] + shift).astype(int), 0, (8, 6))
        inside = (np.abs(points[:, :2] + shift - index - 0.5) <= 0.5).all(axis=1)
        z, at = points[inside, 2], tuple(index[inside].T)
        least = min(least, (z - lowest[at]).min(initial=np.inf), (highest[at] - z).min(initial=np.inf))
    assert room == pytest.approx(least, abs=2e-3)


def town(**members):
    occupied = np.zeros((20, 20, 12), bool)
    occupied[8:10, 8:10, :6] = True
    return City(occupied, 2.0, (5e5, 5e6, 10.0), **members)


def kept(city, start, end, *limits, aside=0.0, rise=0.0):
    start, end = ((np.array(point, float) - city.origin) / city.cell for point in (start, end))
    return keeps(bounds_of(city, *limits), start, end, aside / city.cell, rise / city.cell)


def leg(x, z, city):
    return city.origin + np.array([x, 2.0, z]), city.origin + np.array([x, 38.0, z])


def test_obstacles_are_kept_away_from_exactly_as_far_as_asked():
    city = town()
    assert kept(city, *leg(13.0, 5.0, city), 3.0)[0]  # the wall is at x = 16
    assert not kept(city, *leg(13.0 + 1e-3, 5.0, city), 3.0)[0]
    free, box = kept(city, *leg(14.0, 5.0, city), 3.0)
    assert not free
    assert box[0] == 8
    assert box[1] in (8, 9)
    assert box[2:4] == (0, 6)
    assert not kept(city, *leg(16.0, 5.0, city))[0]  # a touch
    assert kept(city, *leg(15.999, 5.0, city))[0]
    assert kept(city, *leg(13.0, 5.0, city), 2.5, aside=0.5)[0]
    assert not kept(city, *leg(13.0, 5.0, city), 2.5, aside=0.501)[0]


def test_heights_and_zones_and_the_border_are_kept():
    city = town()
    assert kept(city, *leg(4.0, 6.0, city), 0.0, 6.0, 6.5)[0]
    assert not kept(city, *leg(4.0, 5.999, city), 0.0, 6.0, 6.5)[0]
    assert not kept(city, *leg(4.0, 6.501, city), 0.0, 6.0, 6.5)[0]
    assert not kept(city, *leg(4.0, 6.1, city), 0.0, 6.0, 6.5, rise=0.2)[0]
    assert not kept(city, city.origin + 4.0, city.origin + np.array([4, 4, 24.001]))[0]
    zoned = town(no_fly=(NoFlyZone(np.array([(2, 2), (6, 2), (6, 6), (2, 6)]) + np.array([5e5, 5e6]), 0.0, 8.0),))
    assert not kept(zoned, *leg(3.0, 4.0, zoned))[0]
    assert kept(zoned, *leg(6.001, 4.0, zoned))[0]
    assert kept(zoned, *leg(3.0, 8.001, zoned))[0]
    assert not kept(zoned, *leg(6.001, 4.0, zoned), aside=0.01)[0]


def test_each_leg_is_told():
    city = town()
    points = (np.array([*leg(4.0, 5.0, city), *leg(17.0, 5.0, city)[::-1]]) - city.origin) / city.cell
    nothing = np.zeros(3)
    assert legs_keep(bounds_of(city), points, nothing, nothing).tolist() == [True, True, False]


def test_far_from_the_origin_positions_are_rounded_more():
    assert slack_of(City(np.zeros((3, 3, 3)))) == pytest.approx(1e-9, rel=1e-3)
    assert slack_of(City(np.zeros((3, 3, 3)), 0.1, (5e6, 0, 0))) == pytest.approx(4.5e-8, rel=0.1)


def test_height_above_roofs_is_kept_above_a_slab_and_below_it_that_above_the_ground():
    slab = Building.prism([(4, 0), (8, 0), (8, 20), (4, 20)], 8.0, bottom=7.0, name="bridge")
    city = City.from_buildings([slab], cell=1.0, origin=(0, 0, 0), size=(12, 20, 14))
    asked = {"safe_height": 3.0}

    def over(z, x=1.5, to=10.5):
        bounds = bounds_of(city, **asked)
        return keeps(bounds, np.array([x, 10.0, z]), np.array([to, 10.0, z]), 0.0, 0.0)[0]

    assert over(11.0)
    assert not over(10.99)
    assert over(3.0)  # below the bridge it is the ground that counts
    assert not over(2.99)
    assert over(10.99, to=3.9)
    assert keeps(bounds_of(city, **asked), np.array([2.0, 5, 3.0]), np.array([2.0, 5, 13.0]), 0.0, 0.0)[0]
    with pytest.raises(ValueError, match="safe_height must be finite and at least 0"):
        bounds_of(city, safe_height=-1.0)
