"""The threat of buildings: distances by hand, what is printed against what adds up."""

import numpy as np
import pytest

from uavlab.city import Building, City
from uavlab.risk import LENGTH_WEIGHT, THREAT_WEIGHT, building_threat, printed_threat
from uavlab.route import Route

TOWER = Building.prism([(10, 20), (30, 20), (30, 30), (10, 30)], 25, name="tower")  # centre (20, 25), b = 10, a = 5
SHED = Building.prism([(40, 0), (44, 0), (44, 8), (40, 8)], 6, bottom=3, name="shed")  # centre (42, 4), b = 2, a = 4
EXTENT = {"origin": (0, 0, 0), "size": (60, 40, 30)}
ONE, BOTH = City.from_buildings([TOWER], **EXTENT), City.from_buildings([TOWER, SHED], **EXTENT)


def distance_to_tower(x, y):
    return max(abs(y - 25), 0.5 * abs(x - 20))


def at(city, threat, point):
    return threat[tuple(city.cell_of(point))]


@pytest.mark.parametrize(
    ("x", "y", "distance"), [(20.5, 39.5, 14.5), (55.5, 25.5, 17.75), (0.5, 0.5, 24.5), (40.5, 26.5, 10.25)]
)
def test_threat_by_hand(x, y, distance):
    assert distance == distance_to_tower(x, y)
    assert at(ONE, building_threat(ONE), (x, y, 1.5)) == pytest.approx(100 / distance)
    assert at(ONE, building_threat(ONE, constant=7.0), (x, y, 24.5)) == pytest.approx(7 / distance)


def test_threats_of_buildings_add_up_below_the_roof_of_each():
    threat = building_threat(BOTH)
    x, y = 30.5, 10.5
    tower, shed = 100 / distance_to_tower(x, y), 100 / max(abs(y - 4), 2 * abs(x - 42))
    assert at(BOTH, threat, (x, y, 1.5)) == pytest.approx(tower + shed)  # below the shed, which floats, as well
    assert at(BOTH, threat, (x, y, 5.5)) == pytest.approx(tower + shed)
    assert at(BOTH, threat, (x, y, 6.5)) == pytest.approx(tower)
    assert at(BOTH, threat, (x, y, 24.5)) == pytest.approx(tower)
    assert at(BOTH, threat, (x, y, 25.5)) == 0


def test_threat_is_zero_above_all_roofs_and_nowhere_else():
    threat = building_threat(BOTH)
    assert threat.shape == BOTH.shape
    assert (threat[:, :, 25:] == 0).all()
    assert (threat[:, :, :25] > 0).all()


def test_distance_is_floored_at_one_metre():
    threat = building_threat(ONE)
    assert at(ONE, threat, (20.5, 25.5, 3.5)) == 100
    assert threat.max() == 100
    assert building_threat(City.from_buildings([TOWER], cell=0.5, **EXTENT)).max() == 100


def test_outline_of_a_box_is_one_level():
    for x, y in ((10, 27), (30, 21), (13, 20), (28, 30), (10, 20)):
        assert printed_threat(Route([(x, y, 5.0)]), ONE) == pytest.approx(100 / 5)


def test_threat_follows_the_map_s_origin():
    shifted = City.from_buildings(
        [Building.prism([(110, -20), (130, -20), (130, -10), (110, -10)], 32, bottom=7)],
        origin=(100, -40, 7),
        size=(60, 40, 30),
    )
    assert building_threat(shifted) == pytest.approx(building_threat(ONE))


def test_printed_threat_is_that_of_the_nearest_waypoint_to_any_building():
    route = Route([(0.5, 0.5, 9), (50, 12, 9), (20, 39, 9)])
    distances = [distance_to_tower(x, y) for x, y, _ in route.points]
    assert printed_threat(route, ONE) == pytest.approx(100 / min(distances))
    assert printed_threat(route, BOTH) == pytest.approx(100 / min(*distances, max(12 - 4, 2 * 8)))
    assert printed_threat(route, ONE, constant=5) == pytest.approx(5 / min(distances))


def test_printed_threat_ignores_height():
    low, high = (Route([(0, 0, z), (20, 36, z), (55, 39, z)]) for z in (1.0, 29.0))
    assert printed_threat(low, ONE) == printed_threat(high, ONE) > 0
    assert high.integral(ONE, building_threat(ONE)) == 0 < low.integral(ONE, building_threat(ONE))


def test_printed_threat_is_infinite_above_a_centre_but_only_at_a_waypoint():
    over_it = [(20, 5, 29), (20, 25, 29), (20, 39, 29)]
    assert printed_threat(Route(over_it), ONE) == np.inf
    assert printed_threat(Route([over_it[0], over_it[2]]), ONE) == pytest.approx(100 / 14)
    assert np.isfinite(Route(over_it).integral(ONE, building_threat(ONE)))


def test_printed_threat_doesnt_add_up_and_the_layer_does():
    there, on = [(1.5, 5.5, 2.5), (31.5, 5.5, 2.5)], [(31.5, 5.5, 2.5), (55.5, 35.5, 2.5)]
    whole = Route([*there, on[1]])
    halves = [Route(there), Route(on)]
    assert printed_threat(whole, ONE) == max(printed_threat(half, ONE) for half in halves)
    threat = building_threat(ONE)
    assert whole.integral(ONE, threat) == pytest.approx(sum(half.integral(ONE, threat) for half in halves))


def test_an_empty_city_threatens_nobody():
    assert (building_threat(City(np.zeros((3, 4, 5), bool))) == 0).all()


def test_weights_are_those_of_the_papers():
    assert (LENGTH_WEIGHT, THREAT_WEIGHT) == (0.5, 0.2)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: building_threat(ONE, constant=-1), "constant must be finite and at least 0, got -1"),
        (lambda: building_threat(ONE, constant=[100, 200]), "constant must be one number"),
        (lambda: building_threat(ONE, constant=np.nan), "constant must be finite and at least 0, got nan"),
        (lambda: building_threat(City(ONE.occupied)), "city must know its buildings, .* use read_geojson or City"),
        (lambda: printed_threat(Route([(1, 1, 1)]), City(ONE.occupied)), "a city that knows its buildings"),
        (lambda: printed_threat(Route(np.empty((0, 3))), ONE), "needs a route with points"),
        (lambda: printed_threat(Route([(1, 1, 1)]), ONE, constant=-1), "constant must be finite and at least 0"),
    ],
)
def test_wrong_questions_are_refused_by_name(call, message):
    with pytest.raises(ValueError, match=message):
        call()
