"""Promises over many maps: nothing that is planned enters a true building or comes nearer than it said."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest
from scipy.optimize import nnls

from uavlab.city import Building, City
from uavlab.planners import astar, least_risk, refine, shortcut, waypoint_swarm
from uavlab.risk import CAMPUS_FLIGHT, RiskMap, random_campus
from uavlab.spline import Curve, smooth
from uavlab.vehicle import LIGHT_QUADROTOR

CLEAR = 2.4
SMALL = replace(LIGHT_QUADROTOR, diameter=0.1)


def least_height(city, route):
    """Least height above roof or ground along a route [m]; all buildings of a campus are upright prisms."""
    points = route.resample(0.1).points
    below = np.full(len(points), city.origin[2])
    for building in city.buildings:
        low, high = building.bounds[:, 2]
        over = building.contains(np.column_stack([points[:, :2], np.full(len(points), (low + high) / 2)]))
        below[over] = np.maximum(below[over], high)
    return (points[:, 2] - below).min()


@pytest.mark.parametrize("seed", range(20))
def test_swarms_and_refined_routes_keep_the_safe_height_and_the_clearance_at_each_point(seed):
    risk_map = random_campus(seed)
    exact = least_risk(risk_map, *CAMPUS_FLIGHT, min_clearance=CLEAR)
    assert exact.reached
    routes = [
        exact,
        refine(exact, risk_map, rng=0, budget=400, min_clearance=CLEAR),
        waypoint_swarm(risk_map, *CAMPUS_FLIGHT, rng=0, budget=800, min_clearance=CLEAR),
        waypoint_swarm(
            risk_map, *CAMPUS_FLIGHT, rng=0, budget=800, min_clearance=CLEAR, risk_weight=0.0, length_weight=1.0
        ),
    ]
    arrived = [route for route in routes if route.reached]
    assert len(arrived) >= 3
    for route in arrived:
        assert least_height(risk_map.city, route) >= risk_map.safe_height - 1e-6
        assert route.clearance(risk_map.city) >= CLEAR - 1e-8
        assert risk_map.city.distance(route.resample(0.1).points, 4.0).min() >= CLEAR - 1e-8


class Town(NamedTuple):
    """Rotated, thin and roofed buildings, and what a flight through them promises."""

    city: City
    start: np.ndarray
    goal: np.ndarray
    keep: float


def random_town(seed):
    """A dozen buildings turned at random: gables, tents, walls of 10 to 50 cm, masts, slabs in the air."""
    rng = np.random.default_rng([14, seed])
    cell, size = rng.choice([1.0, 1.6, 2.5]), (60.0, 60.0, 30.0)
    buildings = []
    for number in range(12):
        kind = ("gable", "tent", "wall", "mast", "slab")[number % 5]
        long, wide = rng.uniform(5, 14, 2)
        if kind in ("wall", "mast"):
            long, wide = rng.uniform(10, 30) if kind == "wall" else wide / 20, rng.uniform(0.1, 0.5)
        tall = rng.uniform(6, 22)
        x, y = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]).T * [[long / 2], [wide / 2]]
        low = tall - rng.uniform(0.1, 2) if kind == "slab" else 0.0
        corners = [np.column_stack([x, y, np.full(4, height)]) for height in (low, tall)]
        if kind in ("gable", "tent"):
            ridge = long / 2 if kind == "gable" else 0.0
            corners.append(np.array([(-ridge, 0, tall + 5), (ridge, 0, tall + 5)]))
        angle = rng.uniform(0, np.pi)
        turn = np.array([(np.cos(angle), np.sin(angle), 0), (-np.sin(angle), np.cos(angle), 0), (0, 0, 1)])
        at = [*rng.uniform(8, 52, 2), 0]
        buildings.append(Building.hull(np.vstack(corners) @ turn + at, name=f"{kind} {number}"))
    city = City.from_buildings(buildings, cell=cell, origin=(0, 0, 0), size=size, name=f"town {seed}")
    keep = float(rng.choice([0.1, 1.0, 2.0]))
    (start, goal), *_ = city.random_pairs(1, rng, apart=40.0, min_clearance=keep + 0.1)
    return Town(city, start, goal, keep)


def true_distance(points, buildings, enough):
    """Distance of points (N, 3) to the true buildings (N,) [m], exact below `enough`; negative inside one.

    In front of a face it is at least the distance to the face's plane. Where that isn't enough: the nearest of all
    mixtures of the corners, by non-negative least squares.
    """
    least = np.full(len(points), np.inf)
    for building in buildings:
        for hull in building.hulls:
            ahead = (points @ hull.equations[:, :3].T + hull.equations[:, 3]).max(axis=1)
            for at in np.flatnonzero((ahead > 0) & (ahead < enough)):
                corners = (hull.points - points[at]).T
                mixed, _ = nnls(np.vstack([corners, np.full(corners.shape[1], 1e3)]), np.array([0, 0, 0, 1e3]))
                ahead[at] = np.linalg.norm(corners @ mixed / mixed.sum())
            least = np.minimum(least, ahead)
    return least


def planned(town, seed):
    """Routes and curves through a town by name: on the grid, at any angle, smoothed, of swarms."""
    city, start, goal, keep = town
    risk_map = RiskMap(city, 0.005, 0.2, safe_height=0.0)
    limits = {"min_clearance": keep}
    nodes = {
        "A*": astar(city, start, goal, **limits),
        "least risk": least_risk(risk_map, start, goal, **limits),
    }
    prices = {"A*": None, "least risk": risk_map.rate}
    routes = nodes | {f"{name} + shortcut": shortcut(nodes[name], city, price=price) for name, price in prices.items()}
    for name, route in list(routes.items()):
        if route.reached and len(route.points) > 1:
            try:
                routes[f"{name} + spline"] = smooth(route, city, SMALL, **limits)
            except ValueError:
                assert "shortcut" not in name  # the grid may pass a corner at exactly the distance to keep
    kinds = {"swarm": {}, "short swarm": {"risk_weight": 0.0, "length_weight": 1.0}}
    for name, weights in kinds.items():
        routes[name] = waypoint_swarm(risk_map, start, goal, rng=seed, budget=600, **weights, **limits)
    if routes["least risk"].reached:
        routes["refined"] = refine(routes["least risk"], risk_map, rng=seed, budget=300, **limits)
    return {name: route for name, route in routes.items() if isinstance(route, Curve) or route.reached}


@pytest.mark.parametrize("seed", range(30))
def test_routes_curves_and_swarms_keep_their_distance_to_true_buildings(seed):
    town = random_town(seed)
    for name, route in planned(town, seed).items():
        route = route.route(0.05) if isinstance(route, Curve) else route
        points = route.resample(0.05).points
        distance = true_distance(points, town.city.buildings, town.keep)
        assert distance.min() >= town.keep - 1e-6, (name, town.keep)
