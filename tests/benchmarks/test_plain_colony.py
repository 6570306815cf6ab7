"""The colony that the benchmark measures against does the same work: untimed, with few ants."""

import metaheuristics as benchmark
import numpy as np
import pytest

from uavlab.planners import ant_colony, least_risk
from uavlab.planners.risk_question import MAX_TURN
from uavlab.risk import CAMPUS_FLIGHT, random_campus
from uavlab.route import Route
from uavlab.spline.limits import MAX_PITCH


@pytest.fixture(scope="module")
def risk_map():
    return random_campus(1)


def test_plain_ants_keep_the_rules_and_count_the_cost_of_their_way(risk_map):
    colony = benchmark.PlainColony(risk_map, 0, remember=True)
    pheromone = dict.fromkeys(colony.free, 15.0)
    arrived = 0
    for _ in range(20):
        way, cost = colony.walk(pheromone)
        if cost < np.inf:
            arrived += 1
            route = Route(risk_map.city.center_of(np.array(way)))
            assert cost == pytest.approx(risk_map.integral(route), rel=1e-9)
            assert len(set(way)) == len(way)
            assert risk_map.flyable[tuple(route.voxels(risk_map.city)[0].T)].all()
            assert (route.turn <= MAX_TURN + 1e-9).all()
            assert (np.abs(route.pitch) <= MAX_PITCH + 1e-9).all()
            assert route.points[[0, -1]] == pytest.approx(np.array(CAMPUS_FLIGHT))
    assert arrived >= 5


def test_plain_ants_arrive_as_often_and_as_cheaply_as_ours(risk_map):
    """A first generation of 500 against one of 5 000, to four standard errors."""
    ours = ant_colony(risk_map, *CAMPUS_FLIGHT, rng=0, budget=5000, ants=5000).info["ants"]
    colony = benchmark.PlainColony(risk_map, 0, remember=True)
    pheromone = dict.fromkeys(colony.free, 15.0)
    plain = np.array([colony.walk(pheromone)[1] for _ in range(500)])
    share = np.isfinite(ours).mean()
    assert np.isfinite(plain).mean() == pytest.approx(
        share, abs=4 * np.sqrt(share * (1 - share) * (1 / 500 + 1 / 5000))
    )
    logs, plain_logs = (np.log(costs[np.isfinite(costs)]) for costs in (ours, plain))
    error = np.hypot(logs.std() / len(logs) ** 0.5, plain_logs.std() / len(plain_logs) ** 0.5)
    assert plain_logs.mean() == pytest.approx(logs.mean(), abs=4 * error)
    assert error < 0.1
    assert 0.2 < share < 0.9


def test_plain_colony_learns_and_never_beats_the_optimum(risk_map):
    exact = least_risk(risk_map, *CAMPUS_FLIGHT).cost
    few, many = (benchmark.PlainColony(risk_map, 0, True).search(budget) / exact - 1 for budget in (10, 500))
    assert -1e-9 < many < few
    assert many < 0.3


def test_it_may_remember_neighbours_or_not(risk_map):
    found = {benchmark.PlainColony(risk_map, 3, remember).search(20) for remember in (True, False)}
    assert len(found) == 1


def test_our_swarm_finds_the_bottom_of_the_sphere():
    assert benchmark.our_swarm(20, 200, 10)(0) < 1e-4
