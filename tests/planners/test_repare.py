"""REPARE: its price by hand, its cost against A* and SciPy, the distance it keeps, and its plans in flight."""

import itertools
import re
import warnings

import numpy as np
import pytest
from grid_references import additive_cost, cheapest_by_scipy, is_legal

from uavlab.city import City
from uavlab.planners import astar, flight_conditions, penalty_zone, potential_field, repare, repare_price
from uavlab.planners.repare import cached_price
from uavlab.resilience import LOADS, gust_offset
from uavlab.vehicle import LIGHT_QUADROTOR, UAV
from uavlab.weather import Weather, Wind, grounded_by

TABLE_4 = ("light", "mild", 3.5), ("heavy", "mild", 4.5), ("light", "heavy", 5.5)
NOTCH = (90, 18, 30), (50, 44, 30)  # Fig. 12
FAR = (20, 8, 20), (80, 95, 60)


def wall(length=14, width=5):
    """A wall at x < 1, whose clearance at voxel i is i − ½, and nothing else."""
    occupied = np.zeros((length, width, width), bool)
    occupied[0] = True
    return City(occupied)


def canyon():
    """Walls at x < 1 and x ≥ 14, open in between."""
    occupied = np.zeros((15, 9, 9), bool)
    occupied[[0, -1]] = True
    return City(occupied)


def pillars(seed):
    """A small map with thin pillars, and two voxels at least 2.5 m from them."""
    rng = np.random.default_rng(seed)
    occupied = np.zeros((22, 20, 12), bool)
    for i, j in rng.integers(3, 18, (4, 2)):
        occupied[i, j, : rng.integers(6, 13)] = True
    city = City(occupied)
    roomy = np.argwhere(city.clearance >= 3.5)
    return city, *city.center_of(roomy[rng.choice(len(roomy), 2, replace=False)])


@pytest.mark.parametrize("seed", range(6))
def test_cost_is_that_of_astar_and_of_scipy_s_dijkstra_on_repare_s_price(seed):
    city, start, goal = pillars(seed)
    price = repare_price(city, flight_conditions("light", "mild"))
    route = repare(city, start, goal)
    assert route.cost == astar(city, start, goal, price=price).cost
    assert route.cost == pytest.approx(cheapest_by_scipy(city, start, goal, price), rel=1e-9)
    assert route.cost == pytest.approx(additive_cost(city, route, price), rel=1e-12)
    assert np.array_equal(route.points, astar(city, start, goal, price=price).points)
    assert is_legal(city, city.cell_of(route.points))


def test_the_pillars_above_stand_in_the_way():
    apart = [repare(city, *ends).length - astar(city, *ends).length for city, *ends in map(pillars, range(6))]
    assert min(apart) >= -1e-9
    assert max(apart) > 0.5


def test_both_ways_cost_and_measure_the_same(table1):
    for start, goal in table1.random_pairs(100, 11, min_clearance=3.5):
        there, back = repare(table1, start, goal), repare(table1, goal, start)
        assert there.cost == pytest.approx(back.cost, rel=1e-12)
        assert there.length == pytest.approx(back.length, rel=1e-12)


@pytest.mark.parametrize(
    ("start", "goal", "penalty", "apart"),
    [((79.5, 87.5, 31.5), (49.5, 3.5, 6.5), 0.1, 3.218), ((40.5, 44.5, 23.5), (94.5, 22.5, 30.5), 0.2, 5.414)],
)
def test_as_printed_it_depends_on_the_direction_of_travel(table1, start, goal, penalty, apart):
    both = [repare(table1, *ends, penalty=penalty, as_printed=True).length for ends in ((start, goal), (goal, start))]
    assert abs(both[0] - both[1]) == pytest.approx(apart, abs=1e-3)


def test_as_printed_is_eq_13_on_the_outer_ring(table1):
    route = repare(table1, *NOTCH, penalty=0.2, as_printed=True, mean_offset=(9, 9))
    zone = penalty_zone(table1, 3.5, penalty=0.2, zone="ring")
    expected = astar(table1, *NOTCH, price=zone, heuristic="euclidean", as_printed=True)
    assert np.array_equal(route.points, expected.points)
    assert route.info["expanded"] == expected.info["expanded"]


@pytest.mark.parametrize(("load", "disturbance", "keep"), TABLE_4)
def test_out_of_the_notch_it_keeps_the_distance_of_table_4(table1, load, disturbance, keep):
    route = repare(table1, *NOTCH, load=load, disturbance=disturbance)
    assert route.reached
    assert route.clearance(table1) == pytest.approx(keep, abs=1e-9)
    assert route.info["safe_distance"] == keep
    assert is_legal(table1, table1.cell_of(route.points))


def test_out_of_the_notch_the_way_is_71_metres_and_the_potential_field_finds_none(table1):
    assert repare(table1, *NOTCH).length == pytest.approx(71.2, abs=0.05)
    trapped = potential_field(table1, *NOTCH)
    assert not trapped.reached
    assert "local minimum" in trapped.reason


def test_a_gap_too_narrow_for_the_distance_is_passed_in_its_middle_where_there_is_no_other_way():
    occupied = np.zeros((17, 31, 5), bool)
    occupied[:, 14:17] = True
    occupied[6:11, 14:17] = False  # five metres wide
    route = repare(City(occupied), (2.5, 4.5, 2.5), (2.5, 26.5, 2.5))
    assert route.reached
    assert route.clearance(City(occupied)) == pytest.approx(2.5)
    assert [x for x, y, _ in route.points if 14 <= y <= 17] == [8.5] * 3


PUSH = (gust_offset(LIGHT_QUADROTOR.loaded(0.25), 6.0) - 1) / 8.5  # of mild gusts, by what the thrust has left
LOAD_RATIO = 1.75 * 9.81 / 28


def repelled(distance, keep=3.5):
    return keep**3 / 4 * (1 / distance - 1 / keep) / distance**2


def test_weight_by_hand_where_the_wind_may_come_from_any_side():
    price = repare_price(wall(), flight_conditions("light", "mild"))
    assert repelled(1.5) == pytest.approx(1.814814814)
    for i, distance in ((1, 0.5), (2, 1.5), (3, 2.5)):
        assert price[i] == pytest.approx(1 + 2 * (1 + repelled(distance) + PUSH + LOAD_RATIO), rel=1e-12)
    assert (price[4:] == 1).all()  # 3.5 m and more


@pytest.mark.parametrize(
    ("wind", "share"),
    [
        ((-6, 0, 0), 1.0),
        ((6, 0, 0), 0.0),
        ((0, 6), 0.0),
        ((-3.6, 4.8), 0.6),
        ((-3.6, 0, -4.8), 0.6),
        ((3.6, -4.8, 0), 0.0),
    ],
)
def test_weight_by_hand_in_a_wind_whose_direction_is_known(wind, share):
    price = repare_price(wall(), flight_conditions("light", Wind(wind)))
    assert price[2] == pytest.approx(1 + 2 * (1 + repelled(1.5) + share * PUSH + LOAD_RATIO), rel=1e-12)


def test_weights_by_hand():
    now = flight_conditions("light", Wind((-6, 0, 0)))
    price = repare_price(wall(), now, penalty=0.5, force_weight=3.0, load_weight=0.25)
    assert price[3] == pytest.approx(1 + 0.5 * (1 + repelled(2.5) + 3 * PUSH + 0.25 * LOAD_RATIO), rel=1e-12)
    assert (repare_price(wall(), now, penalty=0.0) == 1).all()


def test_load_and_disturbance_make_the_zone_dearer_and_wider():
    light, heavy = (repare_price(wall(), flight_conditions(load, "mild")) for load in ("light", "heavy"))
    none, mild = (repare_price(wall(), flight_conditions("light", kind)) for kind in ("none", "mild"))
    for less, more in ((light, heavy), (none, mild)):
        assert (more >= less).all()
        assert (more > less).any()
        assert (more > 1).sum() > (less > 1).sum()


def test_no_wind_has_no_direction_and_no_push():
    still = flight_conditions("dead", Wind((0.0, 0.0)))
    assert still.push == 0.0
    assert repare_price(wall(), still)[1] == pytest.approx(1 + 2 * (1 + repelled(0.5, 2.0) + 1.5 * 9.81 / 28))


def test_a_force_towards_the_wall_never_makes_a_metre_cheaper(table1):
    for angle in np.linspace(0, 2 * np.pi, 5, endpoint=False):
        now = flight_conditions("light", Wind((6 * np.cos(angle), 6 * np.sin(angle), 0.0)))
        price = repare_price(table1, now)
        without = repare_price(table1, now._replace(push=0.0))
        towards = table1.towards_wall(now.wind)
        near = price > 1
        assert (price >= without).all()
        assert np.array_equal(near, without > 1)
        assert np.array_equal((price > without)[near], (towards > 0)[near])
        assert (repare_price(table1, now, force_weight=2.0) >= price).all()


def test_the_mean_offset_widens_the_zone_before_walls_that_it_points_to_and_no_other():
    city, now = canyon(), flight_conditions("light", "mild")
    middle = {x: repare_price(city, now, mean_offset=(x, 0, 0))[:, 4, 4] > 1 for x in (0.0, 1.2, -1.2)}
    assert np.flatnonzero(~middle[0.0]).tolist() == [4, 5, 6, 7, 8, 9, 10]  # 3.5 m from both
    assert np.flatnonzero(~middle[1.2]).tolist() == [4, 5, 6, 7, 8]
    assert np.flatnonzero(~middle[-1.2]).tolist() == [6, 7, 8, 9, 10]
    across = repare_price(city, now, mean_offset=(0, 5, 5))
    assert np.array_equal(across[:, 4, 4], repare_price(city, now)[:, 4, 4])


def test_in_what_the_mean_offset_adds_the_wall_does_not_push_yet():
    price = repare_price(wall(), flight_conditions("light", "mild"), mean_offset=(-2.0, 0.0))
    plain = repare_price(wall(), flight_conditions("light", "mild"))
    assert price[4:6] == pytest.approx(np.full((2, 5, 5), 1 + 2 * (1 + PUSH + LOAD_RATIO)))
    assert (price[6:] == 1).all()
    assert np.array_equal(price[:4], plain[:4])


@pytest.mark.parametrize(("mean", "side"), [(0.9, 1), (-0.9, -1)])
def test_it_passes_a_pillar_on_the_side_from_which_the_wind_does_not_blow_to_it(mean, side):
    occupied = np.zeros((19, 13, 5), bool)
    occupied[8:11, 6] = True
    route = repare(
        City(occupied), (9.5, 1.5, 2.5), (9.5, 11.5, 2.5), load="dead", disturbance="none", mean_offset=(mean, 0)
    )
    passed = next(x for x, y, _ in route.points if y == 6.5)
    assert passed == 9.5 + side * 4.0  # 2.5 m from the pillar, the first voxel that keeps 2 m


def test_the_ring_misses_what_is_between_its_points_and_widens_like_the_ball():
    city, now = wall(), flight_conditions("light", "mild")
    ball, ring = (repare_price(city, now, zone=shape) for shape in ("ball", "ring"))
    assert ((ring > 1) <= (ball > 1)).all()
    assert (ring[3] > 1).all()  # three cells from the wall
    assert (ring[1:3] == 1).all()  # a wall one voxel thin: the ring looks through it
    shifted = repare_price(city, now, zone="ring", mean_offset=(-2, 0))
    assert (shifted[5] > 1).all()
    route = repare(city, (5.5, 0.5, 2.5), (5.5, 4.5, 2.5), zone="ring")
    assert route.cost == 4.0


def test_prices_of_other_cities_conditions_and_weights_are_not_confused():
    cities = wall(), canyon()
    conditions = [
        flight_conditions(load, wind) for load in ("dead", "heavy") for wind in ("none", Wind((5, 0)), Wind((0, 5)))
    ]
    offsets = (0.0, 0.0, 0.0), (1.0, 0.0, 0.0)
    weights = (2.0, 1.0, 1.0), (1.0, 1.0, 2.0), (1.0, 2.0, 1.0)
    cases = list(itertools.product(cities, conditions, offsets, weights, ("ball", "ring")))
    np.random.default_rng(0).shuffle(cases := [*cases, *cases])
    for city, now, mean_offset, three, zone in cases:
        named = dict(zip(("penalty", "force_weight", "load_weight"), three, strict=True))
        price = repare_price(city, now, mean_offset=mean_offset, zone=zone, **named)
        assert np.array_equal(price, cached_price.__wrapped__(city, now, mean_offset, three, zone))


def test_the_price_is_kept_for_the_next_question():
    city, now = wall(), flight_conditions("light", "mild")
    first = repare_price(city, now)
    assert repare_price(city, flight_conditions("light", "mild"), mean_offset=np.zeros(2), penalty=2) is first
    assert repare_price(wall(), now) is not first


def test_without_obstacles_it_flies_straight():
    city = City(np.zeros((30, 5, 5), bool))
    route = repare(city, (1, 2, 2), (28, 2, 2), disturbance=Wind((3.0, 1.0)), mean_offset=(1, 1))
    assert route.cost == route.length == 27


def test_wind_beyond_the_heaviest_class_needs_more_room_than_it():
    assert flight_conditions("light", Wind((9.0, 0.0))).safe_distance == 5.5
    assert flight_conditions("light", Wind((0.0, 11.0))).safe_distance == pytest.approx(7.5)
    assert flight_conditions("light", Wind((0.0, 11.0)), reading="physical").safe_distance == pytest.approx(7.5)
    assert flight_conditions("light", Wind((0.0, 11.0))).grounded == ""


def test_of_a_wind_and_of_a_weather_the_mean_counts():
    weather = Weather(forecast_wind=5.0, wind_from_deg=323.13)
    wind, weathered = flight_conditions("light", Wind((3.0, -4.0))), flight_conditions("light", weather)
    assert wind.wind == (3.0, -4.0, 0.0)
    assert weathered.wind == pytest.approx((3.0, -4.0, 0.0), abs=1e-3)
    assert wind.name == weathered.name == "light load, wind 5.0 m/s (mild disturbance)"
    assert wind.safe_distance == weathered.safe_distance == 3.5
    assert flight_conditions("light", Wind((0.0, 0.0, 7.0))).name.endswith("(moderate disturbance)")


def test_the_rain_and_gusts_that_are_given_ground_it():
    assert "gusts" in flight_conditions("light", Wind((5.0, 0.0), deviation=8.0)).grounded
    assert "gusts" in flight_conditions("light", Weather(forecast_wind=5.0, forecast_max_wind=40.0)).grounded


def test_a_payload_in_kilograms_is_a_load():
    by_class, by_payload = flight_conditions("light", "mild"), flight_conditions(0.25, "mild")
    assert by_payload.name == "load of 0.25 kg, mild disturbance"
    assert by_payload == by_class._replace(name=by_payload.name)
    assert flight_conditions(0.3, "mild").safe_distance == flight_conditions("moderate", "mild").safe_distance


def test_a_class_and_a_wind_at_its_border_push_the_same():
    assert flight_conditions("light", "mild").push == flight_conditions("light", Wind((0, 6.0))).push
    assert flight_conditions("light", "mild").push == pytest.approx(PUSH)
    assert flight_conditions("light", "mild").load_ratio == pytest.approx(LOAD_RATIO)


# in flight


def assert_same(route, other):
    assert np.array_equal(route.points, other.points)
    assert route.cost == other.cost
    assert route.reached is other.reached
    assert {key: route.info[key] for key in route.info if key != "elapsed"} == {
        key: other.info[key] for key in other.info if key != "elapsed"
    }


@pytest.mark.parametrize("disturbance", ["mild", Wind((4.0, -2.0)), Weather(forecast_wind=4.0)])
def test_conditions_that_stay_are_planned_for_once(table1, disturbance):
    assert_same(repare(table1, *FAR, disturbance=lambda _: disturbance), repare(table1, *FAR, disturbance=disturbance))
    assert len(repare(table1, *FAR, disturbance=disturbance).info["plans"]) == 1


def plan_index(route, plan):
    """Where on the route a plan was made."""
    return int(np.flatnonzero((route.points == plan.place).all(axis=1))[0])


@pytest.mark.parametrize(("start", "goal"), [NOTCH, FAR])
@pytest.mark.parametrize("when", [2.0, 4.0, 5.0, 6.0])
def test_after_a_change_the_rest_is_planned_anew_and_keeps_the_new_distance(table1, start, goal, when):
    before = repare(table1, start, goal)
    route = repare(table1, start, goal, disturbance=lambda clock: "mild" if clock < when else "heavy")
    first, second = route.info["plans"]
    here = plan_index(route, second)
    assert (first.time, first.place, first.safe_distance) == (0.0, tuple(before.points[0]), 3.5)
    assert when <= second.time < when + 1 + 2 * 3**0.5 / 5
    assert second.safe_distance == route.info["safe_distance"] == 5.5
    assert second.conditions == "light load, heavy disturbance"
    assert np.array_equal(route.points[: here + 1], before.points[: here + 1])
    clearance = table1.clearance[tuple(table1.cell_of(route.points[here:]).T)]
    outside = int((clearance >= 5.5 - 1e-9).argmax())
    assert outside <= 5  # as soon as it can
    assert (clearance[outside:] >= 5.5 - 1e-9).all()
    assert is_legal(table1, table1.cell_of(route.points))
    assert np.array_equal(route.points[-1], table1.center_of(table1.cell_of(goal)))
    assert route.info["expanded"] > before.info["expanded"]


def test_the_rest_is_what_would_be_planned_from_there(table1):
    route = repare(table1, *FAR, disturbance=lambda clock: "mild" if clock < 5 else Wind((0.0, -8.0)))
    here = plan_index(route, route.info["plans"][1])
    anew = repare(table1, route.points[here], FAR[1], disturbance=Wind((0.0, -8.0)))
    assert np.array_equal(route.points[here:], anew.points)
    assert route.cost == anew.cost


def test_plans_lie_on_the_route_at_the_distance_flown_by_then(table1):
    kinds = itertools.cycle(["mild", "none", "moderate", "heavy"])
    route = repare(table1, *FAR, disturbance=lambda clock: next(kinds), interval=2.5)
    plans = route.info["plans"]
    assert len(plans) > 8
    for plan in plans:
        assert plan.time * 5.0 == pytest.approx(route.distance[plan_index(route, plan)], abs=1e-9)
    assert np.diff([plan.time for plan in plans]).min() >= 2.5 - 1e-9
    assert is_legal(table1, table1.cell_of(route.points))


def test_it_looks_after_every_interval_at_the_next_waypoint(table1):
    looks = []
    slow = UAV(**(vars(LIGHT_QUADROTOR) | {"cruise_speed": 2.0}))
    route = repare(table1, *FAR, uav=slow, interval=3.0, disturbance=lambda clock: looks.append(clock) or "mild")
    assert looks[0] == 0.0
    assert set(np.round(looks, 6)) <= set(np.round(route.distance / 2.0, 6))
    gaps = np.diff(looks)
    assert gaps[:-1].min() >= 3.0 - 1e-9
    assert gaps.max() < 3.0 + 3**0.5 / 2 + 1e-9


def test_an_interval_shorter_than_a_leg_looks_at_every_waypoint():
    looks = []
    city = City(np.zeros((9, 5, 5), bool))
    repare(city, (1, 1, 1), (7, 1, 1), interval=1e-12, disturbance=lambda clock: looks.append(clock) or "mild")
    assert looks == pytest.approx([0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2])


def test_a_wind_that_turns_is_followed(table1):
    def turning(clock):
        return Wind((5 * np.cos(clock / 4), 5 * np.sin(clock / 4)))

    route = repare(table1, *FAR, disturbance=turning, interval=4.0)
    assert route.reached
    assert len(route.info["plans"]) >= 5
    assert all("wind 5.0 m/s (mild" in plan.conditions for plan in route.info["plans"])
    assert is_legal(table1, table1.cell_of(route.points))


def test_conditions_of_table_3_that_ground_it_are_an_answer(table1):
    route = repare(table1, *FAR, load="heavy", disturbance="heavy")
    assert not route.reached
    assert route.reason == "grounded: heavy load in heavy disturbance (REPARE Table 3)"
    assert route.points.shape == (0, 3)
    assert route.cost == np.inf


def test_gusts_that_push_harder_than_the_thrust_left_over_ground_it(table1):
    route = repare(table1, *FAR, disturbance=Weather(forecast_wind=20.0))
    loaded = LIGHT_QUADROTOR.loaded(LOADS["light"])
    assert route.reason == "grounded: " + "; ".join(grounded_by(loaded, Weather(forecast_wind=20.0)))
    assert "gusts: 35.0 m/s, and the thrust left over holds 24.6 m/s" in route.reason
    assert repare(table1, (20, 5, 20), FAR[1], disturbance=Weather(forecast_wind=12.0)).reached


def test_grounded_in_flight_it_stops_where_it_is(table1):
    whole = repare(table1, *FAR, load="heavy")
    route = repare(table1, *FAR, load="heavy", disturbance=lambda clock: "mild" if clock < 4 else "heavy")
    assert not route.reached
    assert route.cost == np.inf
    assert 0 < len(route.points) < len(whole.points)
    assert np.array_equal(route.points, whole.points[: len(route.points)])
    flown = route.length / 5
    assert 4 <= flown < 5.4
    place = ", ".join(f"{part:.1f}" for part in route.points[-1])
    assert route.reason == (
        f"grounded after {flown:.1f} s at ({place}): heavy load in heavy disturbance (REPARE Table 3)"
    )
    assert len(route.info["plans"]) == 2


def test_a_wall_without_a_way_around_is_an_answer():
    occupied = np.zeros((30, 9, 9), bool)
    occupied[15] = True
    route = repare(City(occupied), (4.5, 4.5, 4.5), (26.5, 4.5, 4.5), disturbance=lambda _: "mild")
    assert not route.reached
    assert route.reason.startswith("no free way from (4.5, 4.5, 4.5)")
    assert route.planner == "REPARE"


def test_the_order_of_expansion_is_recorded_only_when_asked(table1):
    assert "order" not in repare(table1, *NOTCH).info
    route = repare(table1, *NOTCH, record=True)
    assert len(route.info["order"]) == route.info["expanded"]


# what is refused


def suggested(error):
    return [float(part) for part in re.search(r"nearest free point is \((.*)\)", str(error.value))[1].split(", ")]


@pytest.mark.parametrize(
    ("question", "message"),
    [
        ({}, r"start \(2\.5, 4\.5, 4\.5\) is 1\.50 m from the nearest obstacle, 2\.00 m nearer than D_min of 3\.5 m;"),
        ({"disturbance": "heavy"}, r"1\.50 m from .*, 4\.00 m nearer than D_min of 5\.5 m;"),
        ({"mean_offset": (-1.0, 0.0)}, r"3\.00 m nearer than D_min of 3\.5 m and 1\.00 m of mean offset;"),
        ({"mean_offset": (1.0, 0.0)}, r"2\.00 m nearer than D_min of 3\.5 m;"),
    ],
)
def test_a_start_in_the_zone_is_told_by_how_much_and_where_to_start_instead(question, message):
    occupied = np.zeros((30, 9, 9), bool)
    occupied[0] = True
    city = City(occupied)
    with pytest.raises(ValueError, match=message) as error:
        repare(city, (2.5, 4.5, 4.5), (25.5, 4.5, 4.5), **question)
    assert repare(city, suggested(error), (25.5, 4.5, 4.5), **question).reached


def test_a_goal_in_the_zone_is_told_too(table1):
    with pytest.raises(ValueError, match=r"goal \(58\.5, 20\.5, 30\.5\) is 1\.50 m .* D_min") as error:
        repare(table1, (20, 8, 20), (58.5, 20.5, 30.5))
    assert repare(table1, (20, 8, 20), suggested(error)).reached


def test_where_no_voxel_keeps_the_distance_that_is_said():
    occupied = np.zeros((6, 5, 5), bool)
    occupied[[0, -1]] = True
    with pytest.raises(ValueError, match=r"2\.00 m nearer than D_min of 3\.5 m; no voxel of the map keeps it"):
        repare(City(occupied), (2.5, 1.5, 2.5), (2.5, 4.5, 2.5))


WEAK = UAV(**(vars(LIGHT_QUADROTOR) | {"thrust": 20.0}))


@pytest.mark.parametrize(
    ("question", "message"),
    [
        ({"load": "feather"}, "load must be one of 'dead', .* got 'feather'"),
        ({"disturbance": "storm"}, "disturbance must be one of 'none', .* got 'storm'"),
        ({"disturbance": (1.0, 2.0)}, r"disturbance must be one of .*, a Wind or a Weather, got \(1\.0, 2\.0\)"),
        ({"disturbance": 6.0}, r"disturbance must be one of .* got 6\.0"),
        ({"disturbance": None}, "disturbance must be one of .* got None"),
        ({"load": -1.0}, "load must be finite and at least 0, got -1"),
        ({"load": 1.2}, "payload must be at most 1 kg, the heaviest class, got 1.2"),
        ({"load": "heavy", "uav": WEAK}, r"thrust 20 N can't lift 1\.5 kg \+ payload 1 kg"),
        ({"reading": "tea leaves"}, "reading must be one of 'table', 'physical'"),
        ({"mean_offset": 1.0}, "mean_offset must be two or three finite numbers"),
        ({"mean_offset": [(1.0, 0.0, 0.0)] * 2}, "mean_offset must be two or three finite numbers"),
        ({"mean_offset": (np.inf, 0)}, "mean_offset must be two or three finite numbers"),
        ({"penalty": -1.0}, "penalty must be finite and at least 0, got -1"),
        ({"penalty": None}, "penalty must be a number .* got None"),
        ({"force_weight": np.nan}, "force_weight must be finite"),
        ({"load_weight": "1"}, "load_weight must be a number"),
        ({"zone": "cube"}, "zone must be one of 'ball', 'ring', got 'cube'"),
        ({"interval": 0.0}, "interval must be finite and above 0, got 0"),
        ({"interval": (1.0, 2.0)}, "interval must be one number"),
        ({"zone": ["ball"]}, "zone must be one of 'ball', 'ring'"),
        ({"uav": "drone"}, "uav must be a UAV, got str"),
        ({"record": 2}, "record must be True or False, got 2"),
        ({"disturbance": Wind}, "disturbance must be a function, called as"),
        ({"mean_offset": 1.0, "as_printed": True}, "mean_offset must be two or three finite numbers"),
        ({"penalty": -1.0, "load": "heavy", "disturbance": "heavy"}, "penalty must be finite and at least 0, got -1"),
        ({"penalty": -1.0, "as_printed": True}, "penalty must be finite and at least 0, got -1"),
    ],
)
def test_bad_questions_are_refused_with_the_reason(table1, question, message):
    with pytest.raises(ValueError, match=message):
        repare(table1, *FAR, **question)


@pytest.mark.parametrize(
    ("later", "message"),
    [
        ("storm", r"disturbance after 5\.\d s must be one of 'none', .* got 'storm'"),
        (np.nan, r"disturbance after 5\.\d s must be one of .* got nan"),
        ((1.0, 1.0), r"disturbance after 5\.\d s must be one of .* got \(1\.0, 1\.0\)"),
        (None, r"disturbance after 5\.\d s must be one of .* got None"),
    ],
)
def test_what_is_wrong_with_a_later_disturbance_is_said_with_its_time(table1, later, message):
    with pytest.raises(ValueError, match=message):
        repare(table1, *FAR, disturbance=lambda clock: "mild" if clock < 5 else later)


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda city: flight_conditions("light", "mild", "drone"), "uav must be a UAV, got str"),
        (lambda city: flight_conditions("light", "mild", clock=-1.0), "clock must be finite and at least 0, got -1"),
        (lambda city: repare_price(city.occupied, flight_conditions("light", "mild")), "city must be a City"),
        (lambda city: repare_price(city, ("light", "mild")), "conditions must be a Conditions, got tuple: flight_cond"),
        (lambda city: repare_price(city, flight_conditions("light", "mild"), zone=["ball"]), "zone must be one of"),
    ],
)
def test_bad_questions_about_conditions_and_prices_are_refused(table1, ask, message):
    with pytest.raises(ValueError, match=message):
        ask(table1)


@pytest.mark.parametrize("question", [{}, {"mean_offset": (1.0, 0.5)}, {"as_printed": True}])
def test_where_there_is_nothing_to_hit_the_way_is_straight(question):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        route = repare(City(np.zeros((9, 9, 9), bool)), (1, 4, 4), (8, 4, 4), **question)
    assert route.cost == pytest.approx(7.0)


def test_ends_that_can_t_be_flown_are_refused_even_when_grounded(table1):
    with pytest.raises(ValueError, match=r"goal .* lies in building '1 notch'"):
        repare(table1, FAR[0], (65, 20, 30), load="heavy", disturbance="heavy")
