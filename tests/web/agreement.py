"""Whether a planner of `planners.wasm`, in a page or in Python, answers as the public function does.

Where only + − × ÷ √ are used answers agree to the last bit. exp, hypot and the like differ from machine to machine in
their last digit: `NEARLY`.
"""

import numpy as np
import pytest

from uavlab import checks
from uavlab.flight.simulation import TIME_STEP, setup_of
from uavlab.flight.state import ARRIVED, BATTERY_EMPTY, BLOWN_BACK, CRASHED, FLYING
from uavlab.planners import (
    astar,
    flight_conditions,
    hazard_astar,
    hazard_price,
    least_risk,
    penalty_zone,
    potential_field,
    repare,
    repare_price,
    theta_star,
)
from uavlab.planners.hazard import CRASH_PRICE
from uavlab.planners.potential_field import REASONS
from uavlab.planners.repare import PENALTY
from uavlab.planners.risk_question import MAX_TURN, Weights, checked_limits, price_per_cell, query_of
from uavlab.route import Route
from uavlab.spline import Curve
from uavlab.spline.limits import MAX_PITCH
from uavlab.vehicle import LIGHT_QUADROTOR
from uavlab.web.craft import craft_of, state_of

NEARLY = pytest.approx
ENDINGS = {
    ARRIVED: ("arrived", ""),
    CRASHED: ("crashed", "crashed"),
    BLOWN_BACK: ("gave up", "blown back"),
    BATTERY_EMPTY: ("gave up", "battery empty"),
    FLYING: ("gave up", "out of time"),
}


def same(answer, route, city):
    """To the last bit: points, cost, expansions, length, and distance to obstacles."""
    assert np.array_equal(answer.points, route.points)
    assert answer.cost == route.cost
    assert answer.expanded == route.info["expanded"]
    if len(route.points):
        assert answer.length == route.length
        assert answer.clearance == route.clearance(city)
    else:
        assert not route.reached


def astar_agrees(town, start, goal, heuristic, min_clearance):
    route = astar(town.city, start, goal, heuristic=heuristic, min_clearance=min_clearance, record=True)
    answer = town.astar(start, goal, heuristic, min_clearance, record=True)
    same(answer, route, town.city)
    assert np.array_equal(answer.order, route.info["order"])
    if not route.reached:
        assert f"all {answer.reach:.0f} voxels within reach were searched" in route.reason
    plain = town.astar(start, goal, heuristic, min_clearance)
    assert (plain.cost, plain.expanded) == (answer.cost, answer.expanded)
    return route


def set_zone(town, safe_distance, penalty):
    """Set the price of a town; it is that of `penalty_zone`, which is given back."""
    price = penalty_zone(town.city, safe_distance, penalty=penalty)
    town.side.call("price_zone", town.clearance, safe_distance, penalty, town.city.cell, town.price)
    assert np.array_equal(town.side.values(town.price), price)
    return price


def zone_agrees(town, start, goal, price, heuristic, min_clearance=0.0):
    route = astar(town.city, start, goal, price=price, heuristic=heuristic, min_clearance=min_clearance, record=True)
    answer = town.astar(start, goal, heuristic, min_clearance, float(price.min()), record=True)
    same(answer, route, town.city)
    assert np.array_equal(answer.order, route.info["order"])
    return route


def set_hazard(town, sigma, uav_diameter, speed, natural_frequency):
    price = hazard_price(town.city, sigma, uav_diameter=uav_diameter, speed=speed, natural_frequency=natural_frequency)
    town.side.call(
        "price_hazard", town.clearance, sigma, uav_diameter / 2, CRASH_PRICE * natural_frequency / speed, town.price
    )
    np.testing.assert_allclose(town.side.values(town.price), price, rtol=1e-12, atol=0)


def hazard_agrees(town, start, goal, sigma, uav_diameter, speed, natural_frequency):
    """Whether the points are the same, on the grid and by straight lines; where they are, all else is."""
    asked = {"sigma": sigma, "uav_diameter": uav_diameter, "speed": speed, "natural_frequency": natural_frequency}
    on_grid, straight = (
        hazard_astar(town.city, start, goal, any_angle=any_angle, **asked) for any_angle in (False, True)
    )
    answer = town.astar(start, goal, min_clearance=uav_diameter / 2, cheapest=1.0)
    equal = []
    for route in (on_grid, straight):
        equal.append(np.array_equal(answer.points, route.points))
        assert (len(answer.points) > 0) == route.reached
        if equal[-1]:
            assert answer.cost == NEARLY(route.cost, rel=1e-12)
            assert len(route.points) == 0 or answer.length == route.length
            assert len(route.points) == 0 or answer.clearance == route.clearance(town.city)
        if route is on_grid and equal[-1]:
            assert answer.expanded == route.info["expanded"]
        if route is on_grid and route.reached:
            answer = town.straighten(len(answer.points), uav_diameter / 2)
    return equal


def set_repare(town, load, disturbance, force_weight=1.0, load_weight=1.0, reading="table"):
    now = flight_conditions(load, disturbance, reading=reading)
    price = repare_price(town.city, now, force_weight=force_weight, load_weight=load_weight)
    town.side.call(
        "price_repare", town.clearance, now.safe_distance, PENALTY, force_weight * now.push,
        load_weight * now.load_ratio, town.city.cell, town.price,
    )  # fmt: skip
    assert np.array_equal(town.side.values(town.price), price)
    return now


def repare_agrees(town, start, goal, load, disturbance):
    route = repare(town.city, start, goal, load=load, disturbance=disturbance, record=True)
    answer = town.astar(start, goal, min_clearance=LIGHT_QUADROTOR.diameter / 2, cheapest=1.0, record=True)
    same(answer, route, town.city)
    assert np.array_equal(answer.order, route.info["order"])


def theta_agrees(town, start, goal, min_clearance):
    route = theta_star(town.city, start, goal, min_clearance=min_clearance)
    same(town.theta_star(start, goal, min_clearance), route, town.city)
    return route


def field_agrees(town, start, goal, free, push, reach, most=2000):
    """Also how it ended, in the public function's words."""
    city = town.city
    if not free:
        start, goal = city.center_of(city.cell_of([start, goal]))
    moves = "continuous" if free else "lattice"
    route = potential_field(city, start, goal, moves=moves, push=push, reach=reach, max_steps=most)
    answer = town.potential_field(start, goal, free, push, reach, most)
    same(answer, route, city)
    left = np.linalg.norm(route.points[-1] - goal)
    assert route.reason == REASONS[int(answer.outcome)].format(
        place=checks.show(answer.points[-1]), left=left, steps=most
    )
    return route


class Risk:
    """A risk map on one side, at a price by weights of risk, length and threat, and drift or not."""

    def __init__(self, town, risk_map, weights):
        self.town, self.risk_map, self.weights = town, risk_map, weights
        self.price = town.side.array(price_per_cell(risk_map, Weights.checked(*weights)))
        self.rate = town.side.array(risk_map.rate)


def least_risk_agrees(risk, start, goal, max_turn=MAX_TURN, max_pitch=MAX_PITCH):
    town, names = risk.town, ("risk_weight", "length_weight", "threat_weight", "drift")
    asked = dict(zip(names, risk.weights, strict=True)) | {"max_turn": max_turn, "max_pitch": max_pitch}
    route = least_risk(risk.risk_map, start, goal, **asked)
    limits = checked_limits(risk.risk_map, max_turn, max_pitch, 0.0, None, np.inf)
    query = query_of(risk.risk_map, np.empty((1, 0)), *town.codes(start, goal), limits)
    blocked, climb, turn = (town.side.array(array) for array in (query.blocked, query.climb, query.turn))
    same(town.least_risk(blocked, risk.price, climb, turn, query.source, query.target), route, town.city)
    if route.reached:
        integral = town.integral(len(route.points), risk.rate)
        assert integral == NEARLY(route.integral(town.city, risk.risk_map.rate), rel=1e-12)
    town.side.free(blocked, climb, turn)
    return route


def integral_agrees(town, start, goal, values):
    """Of values in the voxels, along a straight line and along Theta*'s way."""
    route = theta_star(town.city, start, goal)
    answer = town.theta_star(start, goal)
    assert np.array_equal(answer.points, route.points)
    if route.reached:
        kept = town.side.array(values)
        assert town.integral(len(route.points), kept) == NEARLY(route.integral(town.city, values), rel=1e-12)
        town.side.free(kept)


def nearest_agrees(town, point, min_clearance):
    """The voxel is that which the public message names, and none is nearer."""
    city, blocked = town.city, town.city.blocked(min_clearance)
    code = town.nearest(point, min_clearance)
    if blocked.all():
        assert code == -1
        return
    free = np.argwhere(~blocked)
    found = city.index_of(code)
    assert not blocked[tuple(found)]
    distances = np.linalg.norm(city.center_of(free) - point, axis=1)
    assert np.linalg.norm(city.center_of(found) - point) == NEARLY(distances.min(), rel=1e-12)
    if blocked[tuple(city.cell_of(point))]:
        with pytest.raises(ValueError, match="start") as refused:
            astar(city, point, city.center_of(free[0]), min_clearance=min_clearance)
        assert f"the nearest free point is {checks.show(city.center_of(found))}" in str(refused.value)


def curve_agrees(town, control, step):
    curve = Curve(control, step=step)
    points, bend, length, clearance = town.curve(control, step)
    assert np.array_equal(points, curve.points)
    assert length == curve.length
    assert clearance == curve.clearance(town.city)
    np.testing.assert_allclose(bend, curve.level_curvature, rtol=1e-12, atol=1e-300)
    return curve


def flight_agrees(town, route, uav, wind, autopilot, flight, generator, time_step=TIME_STEP):
    """A flight of `fly`, from the state of its generator."""
    setup, grounded = setup_of(route, town.city, uav, wind, autopilot, time_step)
    assert not grounded
    space = setup.obstacles
    log, outcome, clearance, energy = town.fly(
        setup.route.points, setup.speed, wind, craft_of(uav, wind, autopilot, time_step), state_of(generator),
        space.touching, space.near_goal, time_step,
    )  # fmt: skip
    name, why = ENDINGS[outcome]
    assert flight.outcome == name
    assert flight.reason.startswith(why)
    assert log.shape == flight.log.shape
    np.testing.assert_allclose(log[:, :10], flight.log[:, :10], rtol=0, atol=1e-9)
    np.testing.assert_allclose(log[:, 10:], flight.log[:, 10:], rtol=0, atol=1e-7)
    assert clearance == NEARLY(flight.clearance, abs=1e-9)
    assert energy == NEARLY(flight.energy.battery, rel=1e-9)


def way_of(points):
    return Route(np.array(points, float))
