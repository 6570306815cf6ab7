"""The hazard planner: its price against Rice's formula, and its routes against A* and REPARE."""

import numpy as np
import pytest
from grid_references import additive_cost, cheapest_by_scipy, is_legal

from uavlab.city import City
from uavlab.offsets import crossing_rate
from uavlab.planners import astar, flight_conditions, hazard_astar, hazard_price, repare, repare_price, shortcut
from uavlab.planners.hazard import cached_price

CASES = ("light", "mild", 3.0), ("heavy", "mild", 4.0), ("light", "heavy", 5.0)  # ξ of Table 4; σ = ξ/3


def wall(length=40):
    """A wall at x < 1, whose clearance at voxel i is i − ½."""
    occupied = np.zeros((length, 5, 5), bool)
    occupied[0] = True
    return City(occupied)


def random_city(seed):
    rng = np.random.default_rng(seed)
    return City(rng.random((13, 12, 11)) < 0.02, cell=rng.uniform(0.5, 3.0)), rng


@pytest.mark.parametrize("seed", range(5))
def test_price_is_one_and_what_the_crossings_of_a_metre_cost(seed):
    city, rng = random_city(seed)
    sigma, radius, speed, frequency, crash = rng.uniform(0.3, 2, 5)
    price = hazard_price(
        city, sigma, uav_diameter=2 * radius, speed=speed, natural_frequency=frequency, crash_price=1000 * crash
    )
    margin = np.maximum(city.clearance - radius, 0.0)
    expected = 1 + 1000 * crash * crossing_rate(margin, sigma, frequency) / speed
    assert price == pytest.approx(expected, rel=1e-12)
    assert price.max() > 10


def test_price_by_hand():
    price = hazard_price(wall(), 1.0)
    assert price[3] == pytest.approx(1 + 3000 / 5 / (2 * np.pi) * np.exp(-2.0))  # u = 2.5 m less 0.5 m
    assert price[:2] == pytest.approx(1 + 600 / (2 * np.pi))  # the margin is used up


def test_price_is_one_far_away_and_where_there_is_no_wall_at_all():
    assert (hazard_price(wall(), 1.0)[39] == 1).all()
    assert (hazard_price(City(np.zeros((5, 5, 5), bool)), 1.0) == 1).all()
    assert (hazard_price(wall(), 1.0, crash_price=0) == 1).all()


def test_price_falls_with_the_distance_and_rises_with_sigma():
    near, far = hazard_price(wall(), 1.0)[1:-1], hazard_price(wall(), 1.0)[2:]
    assert (near >= far).all()
    assert (hazard_price(wall(), 1.5) >= hazard_price(wall(), 1.0)).all()
    assert (hazard_price(wall(), 1.5)[4] > hazard_price(wall(), 1.0)[4]).all()


@pytest.mark.parametrize(
    ("mean", "shift"), [((-1.0, 0.0, 0.0), 1), ((1, 0, 0), 0), ((0, 3), 0), ((-2, 3), 2), ((0, 0, -2), 0)]
)
def test_a_mean_offset_towards_the_wall_takes_from_the_margin_and_away_from_it_gives_nothing(mean, shift):
    plain, shifted = hazard_price(wall(), 1.0), hazard_price(wall(), 1.0, mean_offset=mean)
    assert shifted[1 + shift :, :-3] == pytest.approx(plain[1 : 40 - shift, :-3], rel=1e-12)  # beyond the map no wall


def test_the_price_is_kept_and_not_confused():
    cities = wall(), wall(30)
    questions = [
        (s, r, m, c) for s in (1.0, 2.0) for r in (0.5, 1.0) for m in ((0.0,) * 3, (-1.0, 0.0, 0.0)) for c in (60, 90)
    ]
    for _ in range(2):
        for city in cities:
            for sigma, radius, mean, crash in questions:
                price = hazard_price(city, sigma, uav_diameter=2 * radius, mean_offset=mean, crash_price=crash)
                assert np.array_equal(price, cached_price.__wrapped__(city, sigma, radius, mean, crash / 5))
    assert hazard_price(cities[0], 1) is hazard_price(cities[0], np.float64(1), mean_offset=np.zeros(2))


@pytest.mark.parametrize("seed", range(10))
def test_cost_is_that_of_astar_and_of_scipy_s_dijkstra_on_the_price(seed):
    city, rng = random_city(seed)
    start, goal = city.center_of(rng.permutation(np.argwhere(~city.occupied))[:2])
    price = hazard_price(city, 1.3, uav_diameter=0.2)
    route = hazard_astar(city, start, goal, sigma=1.3, uav_diameter=0.2, any_angle=False)
    assert route.cost == pytest.approx(cheapest_by_scipy(city, start, goal, price), rel=1e-9)
    assert route.cost == pytest.approx(additive_cost(city, route, price), rel=1e-12)
    assert route.cost == pytest.approx(astar(city, start, goal, price=price).cost, rel=1e-12)
    assert route.cost >= route.length
    assert is_legal(city, city.cell_of(route.points))
    assert route.planner == "hazard A*"


@pytest.fixture(scope="module")
def blocked(table1):
    """Forty pairs 5.5 m clear of walls between which plain A* comes within half a metre of one, and its routes."""
    found = []
    for start, goal in table1.random_pairs(1000, 9, min_clearance=5.5):
        route = astar(table1, start, goal)
        if route.clearance(table1) <= 0.5 + 1e-9:
            found.append((start, goal, route))
        if len(found) == 40:
            return found
    raise AssertionError("too few pairs are blocked")


def touches(route, city, sigma, speed=5.0):
    """Expected wall touches of a flight, ∫ ν dt at the clearance less half a metre of body."""
    return route.integral(city, crossing_rate(np.clip(city.clearance - 0.5, 0.0, 100.0), sigma)) / speed


def test_touches_beside_a_wall_are_rate_times_time():
    city = wall()
    straight = astar(city, (3.5, 0.5, 2.5), (3.5, 4.5, 2.5))
    assert touches(straight, city, 1.0) == pytest.approx(4 / 5 * np.exp(-0.5 * 2.0**2) / (2 * np.pi), rel=1e-9)


@pytest.mark.parametrize(
    ("load", "disturbance", "offset", "hazard", "reparing"),
    [(*CASES[0], 0.963, 1.02), (*CASES[1], 0.982, 1.03), (*CASES[2], 1.03, 1.075)],
)
def test_it_is_shorter_than_repare_and_touches_less(table1, blocked, load, disturbance, offset, hazard, reparing):
    """Over 40 blocked pairs, length to A*'s; not only on average: on nearly every pair."""
    lengths, rates = [], []
    for start, goal, plain in blocked:
        routes = (
            plain,
            repare(table1, start, goal, load=load, disturbance=disturbance),
            hazard_astar(table1, start, goal, sigma=offset / 3),
        )
        lengths.append([route.length / plain.length for route in routes])
        rates.append([touches(route, table1, offset / 3) for route in routes])
    _, by_repare, by_hazard = np.mean(lengths, axis=0)
    assert by_hazard == pytest.approx(hazard, abs=0.015)
    assert by_repare == pytest.approx(reparing, abs=0.015)
    assert np.mean([hazardous < resilient for _, resilient, hazardous in lengths]) > 0.9
    plain, resilient, hazardous = np.mean(rates, axis=0)
    assert plain > 0.5  # a flight on A*'s route touches a wall about once
    assert resilient < 0.03
    assert hazardous < 0.1 * resilient


def test_the_length_is_saved_by_straight_lines_and_the_touches_by_the_price(table1, blocked):
    """REPARE with the same shortcut is shorter still, but touches 20 times as often; hazard without it is longer."""
    price = repare_price(table1, flight_conditions("light", "mild"))
    lengths, rates = [], []
    for start, goal, _ in blocked:
        resilient = repare(table1, start, goal)
        routes = (
            resilient,
            shortcut(resilient, table1, price=price),
            hazard_astar(table1, start, goal, sigma=1.0, any_angle=False),
            hazard_astar(table1, start, goal, sigma=1.0),
        )
        lengths.append([route.length / resilient.length for route in routes])
        rates.append([touches(route, table1, 1.0) for route in routes])
    resilient, straightened, on_the_grid, hazardous = np.mean(lengths, axis=0)
    assert straightened < hazardous < resilient < on_the_grid
    _, straightened, on_the_grid, hazardous = np.mean(rates, axis=0)
    assert straightened > 15 * hazardous
    assert straightened > 15 * on_the_grid


def test_any_angle_is_never_dearer_than_without(table1, blocked):
    price = hazard_price(table1, 4 / 3)
    saved = []
    for start, goal, _ in blocked:
        without, with_lines = (
            hazard_astar(table1, start, goal, sigma=4 / 3, any_angle=any_angle) for any_angle in (False, True)
        )
        assert without.cost == pytest.approx(without.integral(table1, price), rel=1e-9)
        assert with_lines.cost == pytest.approx(with_lines.integral(table1, price), rel=1e-9)
        saved.append(without.cost - with_lines.cost)
        assert np.array_equal(with_lines.points[[0, -1]], without.points[[0, -1]])
        assert table1.is_free(with_lines.resample(0.1).points).all()
    assert min(saved) >= -1e-9
    assert max(saved) > 1


def test_it_passes_a_gap_quickly_where_the_way_around_is_long_enough():
    """A gap of 3 m: its hazard against a detour over the wall."""
    ways = []
    for top in (8, 60):
        occupied = np.zeros((17, 15, 64), bool)
        occupied[:, 7, :top] = True
        occupied[7:10, 7] = False
        route = hazard_astar(City(occupied), (8.5, 1.5, 2.5), (8.5, 13.5, 2.5), sigma=0.6)
        ways.append(route.points[:, 2].max())
    assert ways[0] > 8
    assert ways[1] < 8


def test_no_way_is_an_answer():
    occupied = np.zeros((9, 5, 5), bool)
    occupied[4] = True
    route = hazard_astar(City(occupied), (1, 1, 1), (7, 1, 1), sigma=1.0)
    assert not route.reached
    assert route.reason.startswith("no free way")
    assert route.planner == "hazard A*"


OPEN = City(np.zeros((4, 4, 4), bool))
ENDS = (0.5, 0.5, 0.5), (3.5, 3.5, 3.5)


@pytest.mark.parametrize(
    ("question", "message"),
    [
        ({"sigma": 0.0}, "sigma must be finite and above 0, got 0"),
        ({"sigma": (1.0, 2.0)}, "sigma must be one number"),
        ({"sigma": 1.0, "uav_diameter": -0.5}, "uav_diameter must be finite and at least 0, got -0.5"),
        ({"sigma": 1.0, "speed": 0.0}, "speed must be finite and above 0, got 0"),
        ({"sigma": 1.0, "natural_frequency": np.inf}, "natural_frequency must be finite and above 0, got inf"),
        ({"sigma": 1.0, "crash_price": -1.0}, "crash_price must be finite and at least 0, got -1"),
        ({"sigma": 1.0, "crash_price": "much"}, "crash_price must be a number"),
        ({"sigma": 1.0, "any_angle": 1}, "any_angle must be True or False, got 1"),
        ({"sigma": 1.0, "mean_offset": (1.0,)}, "mean_offset must be two or three finite numbers"),
        ({"sigma": 1.0, "mean_offset": (1.0, np.nan)}, "mean_offset must be two or three finite numbers"),
    ],
)
def test_bad_questions_are_refused_with_the_reason(question, message):
    with pytest.raises(ValueError, match=message):
        hazard_astar(OPEN, *ENDS, **question)


def test_a_price_is_that_of_a_city():
    with pytest.raises(ValueError, match="city must be a City, got ndarray"):
        hazard_price(OPEN.occupied, sigma=1.0)


def test_ends_that_can_t_be_flown_are_refused():
    with pytest.raises(ValueError, match=r"goal .* lies outside of the map"):
        hazard_astar(OPEN, ENDS[0], (9, 9, 9), sigma=1.0)
