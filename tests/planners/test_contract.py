"""One contract for all planners: a Route that arrives or says why not, with the same info, and clear refusals."""

import inspect
from functools import partial

import numpy as np
import pytest

import uavlab.planners as face
from uavlab.city import Building, City
from uavlab.planners import (
    ant_colony,
    astar,
    hazard_astar,
    least_energy,
    least_risk,
    pareto_front,
    potential_field,
    repare,
    theta_star,
    waypoint_swarm,
)
from uavlab.risk import RiskMap
from uavlab.route import Route
from uavlab.vehicle import LIGHT_QUADROTOR, RISK_QUADROTOR

TOWER = Building.prism([(14, 14), (20, 14), (20, 20), (14, 20)], 12.0, name="tower")
TOWN = City.from_buildings([TOWER], cell=2.0, origin=(0, 0, 0), size=(36, 36, 20))
CLOSED = np.zeros((18, 18, 10), bool)
CLOSED[9] = True
WALLED = City(CLOSED, cell=2.0)  # nobody comes from the west to the east
ENDS = (5.0, 7.0, 9.0), (31.0, 29.0, 9.0)


def over(city):
    return RiskMap(city, 0.01, 0.2, uav=RISK_QUADROTOR, safe_height=0.0)


PLANNERS = {
    "astar": astar,
    "theta_star": theta_star,
    "potential_field": partial(potential_field, push=1.0, reach=4.0),
    "repare": partial(repare, disturbance="none"),
    "hazard_astar": partial(hazard_astar, sigma=0.3),
    "least_energy": lambda city, start, goal, **options: least_energy(city, start, goal, LIGHT_QUADROTOR, **options),
    "least_risk": lambda city, *ends, **options: least_risk(over(city), *ends, **options),
    "pareto_front": lambda city, *ends, **options: pareto_front(over(city), *ends, lengths=3, **options)[0],
    "ant_colony": lambda city, *ends, **options: ant_colony(over(city), *ends, rng=3, budget=200, **options),
    "waypoint_swarm": lambda city, *ends, **options: waypoint_swarm(over(city), *ends, rng=3, budget=600, **options),
}
OTHERS = {
    "Comparison", "compare_planners", "flight_conditions", "hazard_price", "optimality_gap", "penalty_zone",
    "potential_forces", "refine", "repare_price", "repulsion", "shortcut",
}  # fmt: skip
ASKED = list(PLANNERS.values())


def test_no_planner_is_forgotten():
    assert set(face.__all__) == set(PLANNERS) | OTHERS


@pytest.mark.parametrize("plan", ASKED, ids=PLANNERS)
def test_a_route_that_arrives_leads_from_start_to_goal_and_says_what_it_cost(plan):
    route = plan(TOWN, *ENDS)
    assert isinstance(route, Route)
    assert (route.reached, route.reason) == (True, "")
    assert 0 < route.cost < np.inf
    assert 0 < route.length < 100
    ends = TOWN.center_of(TOWN.cell_of(ENDS))
    assert route.points[[0, -1]] == pytest.approx(ends, abs=TOWN.cell / 2)
    assert route.clearance(TOWN) > 0


@pytest.mark.parametrize("city", [TOWN, WALLED], ids=["arrives", "no way"])
@pytest.mark.parametrize("plan", ASKED, ids=PLANNERS)
def test_the_same_keys_stand_in_info_whatever_came_of_it(plan, city):
    info = plan(city, *ENDS).info
    assert isinstance(info["expanded"], int)
    assert info["expanded"] >= 0
    assert info["elapsed"] > 0


@pytest.mark.parametrize("plan", ASKED, ids=PLANNERS)
def test_where_no_way_leads_the_route_says_so(plan):
    route = plan(WALLED, *ENDS)
    assert not route.reached
    assert route.reason
    assert route.cost == np.inf
    assert route.points.shape[1] == 3
    assert "not reached" in repr(route)


@pytest.mark.parametrize("plan", ASKED, ids=PLANNERS)
def test_the_same_question_has_the_same_answer(plan):
    one, other = plan(TOWN, *ENDS), plan(TOWN, *ENDS)
    assert np.array_equal(one.points, other.points)
    assert one.cost == other.cost
    assert one.info["expanded"] == other.info["expanded"]


@pytest.mark.parametrize("plan", ASKED, ids=PLANNERS)
def test_the_time_runs_from_the_call(plan, monkeypatch):
    """By a clock that only goes on while the city says where it is blocked: that is asked before any search."""
    clock, blocked = [0.0], City.blocked

    def slowly(city, *arguments, **options):
        clock[0] += 1.0
        return blocked(city, *arguments, **options)

    monkeypatch.setattr(City, "blocked", slowly)
    monkeypatch.setattr("time.perf_counter", lambda: clock[0])
    assert plan(TOWN, *ENDS).info["elapsed"] == clock[0] > 0


@pytest.mark.parametrize(
    ("ends", "message"),
    [
        (((17.0, 17.0, 5.0), ENDS[1]), r"start \(17\.0, 17\.0, 5\.0\) lies in building 'tower'; the nearest free"),
        ((ENDS[0], (17.0, 17.0, 5.0)), r"goal \(17\.0, 17\.0, 5\.0\) lies in building 'tower'"),
        (((-1.0, 5.0, 5.0), ENDS[1]), "start .* lies outside of the map: x 0 to 36"),
        ((ENDS[0], (5.0, np.nan, 5.0)), "goal must be finite"),
        ((ENDS[0], (5.0, 5.0)), "goal must be three numbers"),
        ((ENDS[0], "there"), "goal must be a number or an array of numbers"),
        ((ENDS[0], ENDS[0]), "start .* and goal .* lie in the same voxel"),
        ((None, ENDS[1]), "start must be a number or an array"),
    ],
)
@pytest.mark.parametrize("plan", ASKED, ids=PLANNERS)
def test_a_wrong_start_or_goal_is_refused_by_name(plan, ends, message):
    with pytest.raises(ValueError, match=message):
        plan(TOWN, *ends)


@pytest.mark.parametrize("name", PLANNERS)
def test_what_it_acts_on_comes_first_then_from_where_to_where(name):
    first, *ends = list(inspect.signature(getattr(face, name)).parameters)[:3]
    assert first in ("city", "risk_map")
    assert ends == ["start", "goal"]
    assert {"min_height", "max_height"} <= set(inspect.signature(getattr(face, name)).parameters)
