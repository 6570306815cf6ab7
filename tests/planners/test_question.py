"""Questions that are refused with the reason, heights above ground, no-fly zones, vertical take-off and landing."""

import re
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from uavlab import checks
from uavlab.city import Building, City
from uavlab.city.zones import NoFlyZone
from uavlab.planners import (
    ant_colony,
    astar,
    hazard_astar,
    least_risk,
    pareto_front,
    potential_field,
    refine,
    repare,
    shortcut,
    theta_star,
    waypoint_swarm,
)
from uavlab.planners.question import Airspace, checked_price, end_at
from uavlab.planners.question import endpoints as ends_of
from uavlab.risk import RiskMap


def node_at(city, point, argument, min_clearance=0.0):
    airspace = Airspace(city, min_clearance)
    return end_at(airspace, airspace.blocked, point, argument)[0]


def endpoints(city, start, goal):
    ends = ends_of(Airspace(city), start, goal)
    return ends.source, ends.target


def test_node_is_the_code_of_the_voxel_that_holds_the_point(table1):
    assert node_at(table1, (90.2, 18.9, 30.0), "start") == 90 * 10_000 + 18 * 100 + 30
    assert endpoints(table1, (0.5, 0, 0), (0, 0, 99.9)) == (0, 99)


@pytest.mark.parametrize("min_clearance", [0.0, 4.5])
def test_a_point_in_a_building_is_told_the_nearest_free_one(table1, min_clearance):
    point = (80.0, 70.5, 30.0)
    with pytest.raises(ValueError, match=r"^goal \(80.0, 70.5, 30.0\) lies in building '3 frustum'; ") as refusal:
        node_at(table1, point, "goal", min_clearance)
    told = re.search(r"the nearest free point is \((.*)\)$", str(refusal.value))[1]
    told = np.array([float(number) for number in told.split(", ")])
    allowed = np.argwhere(table1.clearance >= max(min_clearance, 0.1)) + 0.5
    assert table1.is_free(told)
    assert np.linalg.norm(told - point) == pytest.approx(np.linalg.norm(allowed - point, axis=1).min())
    node_at(table1, told, "goal", min_clearance)


WALLED = np.zeros((4, 4, 4), bool)
WALLED[2] = True
SMALL = City(WALLED)


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (
            lambda: node_at(SMALL, (2.5, 1, 1), "start"),
            r"start \(2.5, 1.0, 1.0\) lies in an obstacle; the nearest free",
        ),
        (
            lambda: node_at(SMALL, (9, 1, 1), "goal"),
            r"goal \(9.0, 1.0, 1.0\) lies outside of the map: x 0 to 4, y 0 to 4",
        ),
        (lambda: node_at(SMALL, (1, 4, 1), "goal"), "lies outside of the map"),
        (lambda: node_at(SMALL, (1, 1, -0.01), "start"), "lies outside of the map"),
        (lambda: node_at(SMALL, (1, np.nan, 1), "start"), r"start must be finite, got \(1.0, nan, 1.0\)"),
        (lambda: node_at(SMALL, (1, np.inf, 1), "goal"), "goal must be finite"),
        (
            lambda: node_at(SMALL, (1, 1), "start"),
            r"start must be three numbers \(x, y, z\) in metres, got shape \(2,\)",
        ),
        (lambda: node_at(SMALL, [(1, 1, 1)], "start"), r"start must be three numbers .* got shape \(1, 3\)"),
        (lambda: node_at(SMALL, 5, "start"), r"start must be three numbers .* got shape \(\)"),
        (
            lambda: node_at(SMALL, (1.5, 1, 1), "start", 1.0),
            r"start \(1.5, 1.0, 1.0\) is 0.50 m from the nearest obstacle, min_clearance asks for 1 m; "
            r"the nearest free point is \(0.5, 0.5, 0.5\)",
        ),
        (lambda: node_at(SMALL, (1.5, 1, 1), "start", 50), "no voxel of the map is free"),
        (lambda: node_at(City(np.ones((2, 2, 2))), (1, 1, 1), "goal"), "an obstacle; no voxel of the map is free"),
        (
            lambda: endpoints(City(WALLED, cell=2.0), (0.1, 0.1, 0.1), (1.9, 1.9, 1.9)),
            r"start \(0.1, .*\) and goal \(1.9, .*\) lie in the same voxel: .* at least one cell \(2 m\) away",
        ),
        (lambda: endpoints(SMALL, (1, 1, 1), (1, 1, 1)), "lie in the same voxel"),
        (lambda: endpoints(SMALL, (1, 1, 1), (1, 1, 7)), "goal .* lies outside of the map"),
        (lambda: endpoints(SMALL, (1, 1, 7), (1, 1, 1)), "start .* lies outside of the map"),
        (lambda: SMALL.blocked(-1), "min_clearance must be a distance in metres, at least 0, got -1"),
        (lambda: SMALL.blocked(np.nan), "min_clearance must be .* got nan"),
        (lambda: SMALL.blocked(np.inf), "min_clearance must be .* got inf"),
        (lambda: checked_price(SMALL, np.ones((4, 4))), r"price must have the city's shape \(4, 4, 4\), got \(4, 4\)"),
        (lambda: checked_price(SMALL, 1.0), r"price must have the city's shape \(4, 4, 4\), got \(1?,?\)"),
        (lambda: checked_price(SMALL, np.full((4, 4, 4), np.nan)), "price must be finite and at least 0 everywhere"),
        (lambda: checked_price(SMALL, np.full((4, 4, 4), np.inf)), "use min_clearance to forbid voxels"),
        (lambda: checked_price(SMALL, np.where(WALLED, -0.1, 1)), "price must be finite and at least 0 everywhere"),
    ],
)
def test_bad_questions_are_refused_with_the_reason(ask, message):
    with pytest.raises(ValueError, match=message):
        ask()


def test_prices_become_floats_of_the_city_s_shape():
    price, cheapest = checked_price(SMALL, np.arange(64).reshape(4, 4, 4)[::-1])
    assert cheapest == 0
    assert price.dtype == float
    assert price.flags.c_contiguous
    assert price[0, 0, 0] == 48


def test_points_in_messages_have_one_decimal():
    assert checks.show((90, 18.04, -0.5)) == "(90.0, 18.0, -0.5)"


HOUSE = Building.prism([(20, 16), (24, 16), (24, 20), (20, 20)], 12.0, name="house")
SLOPE = np.broadcast_to(0.25 * (np.arange(40) + 0.5)[:, None], (40, 36))
"""Ground that rises to the east, 10 m over 40 m."""


def town(**members):
    city = City.from_buildings([HOUSE], origin=(0, 0, -1), size=(40, 36, 41))
    return City(city.occupied, city.cell, city.origin, city.buildings, "town", ground=SLOPE, **members)


TOWN = town()
RISK = RiskMap(TOWN, 0.001, 0.25, safe_height=1.0)
ENDS = (4.5, 18.5, 14.5), (36.5, 18.5, 22.5)

PLANNERS = {
    "A*": astar,
    "Theta*": theta_star,
    "potential field": partial(potential_field, push=1.0, reach=2.0),
    "REPARE": partial(repare, disturbance="none", load="dead"),
    "hazard": partial(hazard_astar, sigma=0.3),
    "least risk": lambda city, *ends, **limits: least_risk(replace(RISK, city=city), *ends, **limits),
    "front": lambda city, *ends, **limits: pareto_front(replace(RISK, city=city), *ends, lengths=3, **limits)[0],
    "ants": lambda city, *ends, **limits: ant_colony(replace(RISK, city=city), *ends, rng=1, budget=400, **limits),
    "swarm": lambda city, *ends, **limits: waypoint_swarm(
        replace(RISK, city=city), *ends, rng=1, budget=1500, length_weight=1.0, risk_weight=0.0, **limits
    ),
    "refined": lambda city, *ends, **limits: refine(
        least_risk(replace(RISK, city=city), *ends, **limits),
        replace(RISK, city=city), rng=1, budget=600, length_weight=1.0, risk_weight=0.0, **limits,
    ),
    "shortcut": lambda city, *ends, **limits: shortcut(astar(city, *ends, **limits), city, **limits),
}  # fmt: skip


def finely(route):
    return route.resample(0.05).points


@pytest.mark.parametrize("plan", PLANNERS.values(), ids=PLANNERS)
def test_every_planner_keeps_heights_above_ground_and_out_of_zones(plan):
    zone = NoFlyZone([(10, 14), (16, 14), (16, 24), (10, 24)], 0.0, 30.0, name="school")
    route = plan(town(no_fly=(zone,)), *ENDS, min_height=6.0, max_height=16.0)
    if "potential" in route.planner:  # zones don't push: it says where it may not go on
        assert route.reached or "min" in route.reason or "where it may not" in route.reason
    else:
        assert route.reached
    above = TOWN.height_above_ground(finely(route))
    assert above.min() >= 6.0 - 1e-6
    assert above.max() <= 16.0 + 1e-6
    inside = (finely(route)[:, :2] > (10, 14)).all(axis=1) & (finely(route)[:, :2] < (16, 24)).all(axis=1)
    assert not inside.any()


@pytest.mark.parametrize("plan", [p for name, p in PLANNERS.items() if name != "potential field"])
def test_start_and_goal_below_the_least_height_are_left_and_reached_vertically(plan):
    start, goal = (4.5, 18.5, 2.5), (36.5, 18.5, 10.5)
    route = plan(TOWN, start, goal, min_height=6.0)
    assert route.reached
    assert route.points[0] == pytest.approx(start)
    assert route.points[-1] == pytest.approx(goal)
    assert route.takeoff > 0
    assert route.landing > 0
    low = TOWN.height_above_ground(finely(route)) < 6.0 - 1e-6
    at_ends = np.isclose(finely(route)[:, :2], start[:2]).all(axis=1) | np.isclose(finely(route)[:, :2], goal[:2]).all(
        axis=1
    )
    assert low.any()
    assert (at_ends | ~low).all()
    assert TOWN.height_above_ground(finely(route.en_route)).min() >= 6.0 - 1e-6


def test_the_cost_of_a_route_has_its_vertical_legs():
    low = astar(TOWN, (4.5, 18.5, 2.5), ENDS[1], min_height=6.0)
    high = astar(TOWN, low.en_route.points[0], ENDS[1], min_height=6.0)
    assert low.cost == pytest.approx(low.length)
    assert low.cost == pytest.approx(high.cost + low.takeoff)
    both = astar(TOWN, (4.5, 18.5, 2.5), (36.5, 18.5, 10.5), min_height=6.0)
    assert both.takeoff > 0 < both.landing
    assert both.cost == pytest.approx(both.length)
    price = 1.0 + np.random.default_rng(0).random(TOWN.shape)
    priced = astar(TOWN, (4.5, 18.5, 2.5), ENDS[1], price=price, min_height=6.0)
    assert priced.cost == pytest.approx(priced.integral(TOWN, price), rel=1e-9)
    safest = least_risk(RISK, (4.5, 18.5, 2.5), ENDS[1], min_height=6.0)
    assert safest.cost == pytest.approx(RISK.integral(safest), rel=1e-9)
    straight = shortcut(priced, TOWN, price=price, min_height=6.0)
    assert straight.cost == pytest.approx(straight.integral(TOWN, price), rel=1e-9)


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (partial(astar, TOWN, (22, 18, 5), ENDS[1]), "start .* lies in building 'house'; the nearest free point"),
        (partial(astar, TOWN, (36, 30, 5), ENDS[1]), "start .* lies in the ground; the nearest free point"),
        (
            partial(astar, TOWN, ENDS[0], (36, 18, 38), max_height=20),
            r"goal .* is 29\.\d m above ground, max_height allows 20",
        ),
        (partial(astar, TOWN, *ENDS, min_height=-1), "min_height must be finite and at least 0"),
        (partial(astar, TOWN, *ENDS, min_height=9, max_height=9), r"max_height must be above min_height \(9 m\)"),
        (partial(astar, TOWN, *ENDS, max_height=np.nan), "max_height must be above min_height"),
        (
            partial(astar, TOWN, (4.5, 18.5, 2.5), (4.5, 18.5, 4.5), min_height=9),
            r"lie above each other, below min_height=9 m, where only take-off and landing are allowed",
        ),
        (
            partial(astar, town(no_fly=(NoFlyZone([(0, 0), (9, 0), (9, 36), (0, 36)], name="airport"),)), *ENDS),
            "start .* lies in no-fly zone 'airport'; the nearest free point",
        ),
    ],
)  # fmt: skip
def test_what_stands_in_the_way_is_named(ask, message):
    with pytest.raises(ValueError, match=message):
        ask()


def test_nobody_climbs_through_a_roof():
    roof = Building.prism([(2, 16), (8, 16), (8, 22), (2, 22)], 6.0, bottom=5.0, name="canopy")
    city = City.from_buildings([roof], origin=(0, 0, -1), size=(40, 36, 30), terrain=0.0)
    with pytest.raises(ValueError, match=r"start .* lies below min_height=10 m, and there is no free way straight up"):
        astar(city, (4.5, 18.5, 2.5), (36.5, 18.5, 14.5), min_height=10)
