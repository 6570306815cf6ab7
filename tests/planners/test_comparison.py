"""Comparisons: exact numbers from planners that only pretend, and two real ones at the same number of evaluations."""

import functools
import re
import warnings

import numpy as np
import pytest

from uavlab.city import City
from uavlab.planners import (
    Comparison,
    ant_colony,
    compare_planners,
    least_risk,
    optimality_gap,
    refine,
    waypoint_swarm,
)
from uavlab.risk import CAMPUS_FLIGHT, RiskMap, random_campus
from uavlab.route import Route
from uavlab.statistics import over_maps, share_interval

START, GOAL = (5.0, 5.0, 25.0), (55.0, 45.0, 25.0)
LINE = np.array([START, GOAL])
NOWHERE = np.empty((0, 3))


def flat(density):
    """An open field of 6 × 6 × 4 voxels of 10 m, with so many people per m²."""
    return RiskMap(City(np.zeros((6, 6, 4), bool), 10.0), np.full((6, 6), density), 0.5)


MAPS = [flat(0.001), flat(0.004)]
compare = functools.partial(compare_planners, start=START, goal=GOAL, progress=False)


def pretend(risk_map, start, goal, *, budget, rng, gaps, elapsed=0.5, used=None, each=2, name="pretended"):
    """A planner that comes to gaps(number of evaluation, seed) above the optimum, in iterations of `each`."""
    least = least_risk(risk_map, start, goal).cost
    history = least * (1 + np.array([gaps(number, rng) for number in range(1, budget + 1)], float))
    info = {
        "evaluations": budget if used is None else used,
        "history": history,
        "iterations": np.arange(each, budget + 1, each),
        "elapsed": elapsed,
    }
    if np.isinf(history[-1]):
        return Route(NOWHERE, name, reached=False, reason="it only pretends", cost=np.inf, info=info)
    return Route([start, goal], name, cost=history[-1], info=info)


def halving(number, seed):
    """Gaps of 1.28, 0.64, 0.32, …; and a tenth more with each seed."""
    return 1.28 * 0.5 ** (number - 1) + 0.1 * seed


def late(number, seed):
    """Nothing until the fifth evaluation; never with odd seeds; then a tenth below the optimum."""
    return -0.1 if number >= 5 and seed % 2 == 0 else np.inf


PLANNERS = {
    "halving": functools.partial(pretend, gaps=halving),
    "late": functools.partial(pretend, gaps=late, elapsed=2.0, each=4),
}


@pytest.fixture(scope="module")
def pretended():
    return compare(PLANNERS, MAPS, seeds=[0, 1, 2], budget=8)


def given(gaps, histories=None, iterations=None):
    """A comparison of gaps (P, M, S), with planners named a, b, …"""
    gaps = np.asarray(gaps, float)
    names = [chr(ord("a") + number) for number in range(len(gaps))]
    histories = gaps[..., None] if histories is None else np.asarray(histories, float)
    iterations = [np.array([histories.shape[-1]])] * len(gaps) if iterations is None else iterations
    return Comparison(names, gaps, histories, iterations, np.ones(gaps.shape), [])


def test_the_gap_is_how_much_more_a_route_costs():
    exact = Route(LINE, cost=2.0)
    assert optimality_gap(Route(LINE, cost=3.0), exact) == 0.5
    assert optimality_gap(exact, exact) == 0
    assert optimality_gap(Route(LINE, cost=1.8), exact) == pytest.approx(-0.1)
    assert optimality_gap(Route(LINE, cost=np.inf), exact) == np.inf


def test_the_gap_of_a_route_that_does_not_arrive_is_infinite_whatever_its_cost():
    exact = Route(LINE, cost=2.0)
    for cost in (np.inf, 1.0, np.nan):
        assert optimality_gap(Route(NOWHERE, reached=False, reason="stuck", cost=cost), exact) == np.inf


@pytest.mark.parametrize(
    ("route", "exact", "message"),
    [
        (Route(LINE), Route(LINE, cost=1.0), "route has no cost: RiskMap.integral(route) gives it"),
        (Route(LINE, cost=1.0), Route(LINE), "exact must be a route that arrives, with a cost above 0"),
        (Route(LINE, cost=1.0), Route(LINE, cost=0.0), "exact must be a route that arrives, with a cost above 0"),
        (Route(LINE, cost=1.0), Route(LINE, cost=np.inf), "exact must be a route that arrives, with a cost above 0"),
        (
            Route(LINE, cost=1.0),
            Route(NOWHERE, "least risk", reached=False, reason="walled in", cost=np.inf),
            "got <Route by least risk: not reached, walled in> of cost inf",
        ),
        (1.5, Route(LINE, cost=1.0), "route must be a Route, got float"),
        (Route(LINE, cost=1.0), 1.5, "exact must be a Route, got float"),
    ],
)
def test_a_gap_without_two_costs_is_refused(route, exact, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        optimality_gap(route, exact)


def test_gaps_are_those_that_were_pretended(pretended):
    assert pretended.planners == ["halving", "late"]
    assert pretended.gaps.shape == (2, 2, 3)
    assert pretended.gaps[0] == pytest.approx(np.tile(0.01 + 0.1 * np.arange(3), (2, 1)), abs=1e-12)
    assert pretended.gaps[1] == pytest.approx(np.tile([-0.1, np.inf, -0.1], (2, 1)), abs=1e-12)
    assert [route.cost for route in pretended.exact] == [least_risk(each, START, GOAL).cost for each in MAPS]
    assert pretended.exact[1].cost > 1.5 * pretended.exact[0].cost  # each map has an optimum of its own


def test_histories_are_gaps_of_the_best_so_far(pretended):
    assert pretended.histories.shape == (2, 2, 3, 8)
    for seed in range(3):
        falling = [halving(number, seed) for number in range(1, 9)]
        assert pretended.histories[0, :, seed] == pytest.approx(np.tile(falling, (2, 1)), abs=1e-12)
    arrives, never = [np.inf] * 4 + [-0.1] * 4, [np.inf] * 8
    assert pretended.histories[1, 0] == pytest.approx(np.array([arrives, never, arrives]), abs=1e-12)
    assert np.array_equal(pretended.histories[..., -1], pretended.gaps)
    assert [ends.tolist() for ends in pretended.iterations] == [[2, 4, 6, 8], [4, 8]]
    assert np.array_equal(pretended.elapsed, np.stack([np.full((2, 3), 0.5), np.full((2, 3), 2.0)]))


def test_each_run_gets_its_own_map_seed_and_the_same_question():
    asked = []

    def ask(risk_map, start, goal, **options):
        asked.append((risk_map, start, goal, options))
        return pretend(risk_map, start, goal, gaps=halving, **options)

    compare({"one": ask, "other": ask}, MAPS, seeds=[4, 7], budget=3, jobs=1)
    expected = [(each, START, GOAL, {"budget": 3, "rng": seed}) for each in MAPS for seed in (4, 7)]
    assert [(id(question[0]), *question[1:]) for question in asked] == [
        (id(question[0]), *question[1:]) for question in expected * 2
    ]


def test_a_run_that_does_not_arrive_has_an_infinite_gap_whatever_cost_it_gives():
    def almost(risk_map, start, goal, **options):
        route = pretend(risk_map, start, goal, gaps=halving, **options)
        return Route(NOWHERE, reached=False, reason="almost there", cost=route.cost, info=route.info)

    assert (compare({"almost": almost}, MAPS, seeds=[0], budget=4).gaps == np.inf).all()


def test_the_table_has_median_quantile_failures_and_time(pretended):
    table = pretended.table()
    assert table.index.tolist() == ["halving", "late"]
    assert table.columns.tolist() == ["median", "low", "high", "90 %", "failed", "seconds"]
    # both maps have the same gaps: resampling them changes nothing
    assert table.loc["halving"].tolist() == pytest.approx([11, 11, 11, 21, 0, 0.5], abs=1e-9)
    assert table.loc["late"].tolist() == pytest.approx([-10, -10, -10, np.inf, 100 / 3, 2.0], abs=1e-9)


def test_medians_where_most_runs_fail_are_infinite():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        table = given([[[np.inf, np.inf, 0.1]], [[0.3, 0.1, 0.2]]]).table()
    assert table.loc["a"].tolist() == pytest.approx([np.inf, np.inf, np.inf, np.inf, 200 / 3, 1], abs=1e-9)
    assert table.loc["b"].tolist() == pytest.approx([20, 20, 20, 30, 0, 1])


def test_the_interval_is_over_maps_not_over_runs():
    """100 seeds on each of 4 maps: what differs are the maps, and 4 say little however many seeds there are."""
    rng = np.random.default_rng(0)
    gaps = np.array([0.1, 0.2, 0.3, 0.6])[:, None] + rng.normal(0, 1e-3, (4, 100))
    row = given([gaps]).table().loc["a"]
    # of 4 draws from 4 maps, all are of the least with a chance of 1/256: rarer than 1/40, and so at the other end
    assert 9 < row["low"] < 21
    assert 29 < row["high"] < 61
    assert row["low"] < row["median"] < row["high"]
    means = over_maps(np.mean, gaps)
    # all 256 resamples of four, exactly: 2.5 % and 97.5 % of their means
    indices = np.stack(np.meshgrid(*[range(4)] * 4), axis=-1).reshape(-1, 4)
    exactly = np.quantile(gaps.mean(axis=1)[indices].mean(axis=1), [0.025, 0.975])
    assert means == pytest.approx(exactly, abs=0.03)
    assert over_maps(np.mean, gaps) == means


def test_one_map_gives_an_interval_of_no_width():
    assert over_maps(np.mean, np.array([[1.0, 2.0, 6.0]])) == (3.0, 3.0)


def test_the_interval_holds_the_true_value_in_nearly_all_samples_of_maps():
    """Of 200 samples of 25 maps whose gaps are normal around 1: a bootstrap of 25 holds about 93 %, ± 4 × 1.8 %."""
    held = 0
    for seed in range(200):
        rng = np.random.default_rng(seed)
        low, high = over_maps(np.mean, rng.normal(1, 0.2, (25, 1)) + rng.normal(0, 0.1, (25, 4)))
        held += low <= 1 <= high
    assert 0.86 < held / 200 <= 0.99


def test_wins_are_shares_of_runs_with_ties_as_halves():
    compared = given([[[0.1, 0.2], [0.3, np.inf]], [[0.2, 0.2], [0.1, np.inf]], [[0.0, 0.0], [0.0, 0.0]]])
    assert compared.wins("a", "b")[0] == (1 + 0.5 + 0 + 0.5) / 4
    assert compared.wins("c", "a") == (1.0, *share_interval(2, 2))  # where both maps agree: of two trials
    assert compared.wins("a", "c") == (0.0, *share_interval(0, 2))
    assert compared.wins("b", "b") == (0.5, *share_interval(1, 2))
    # on the first map a wins 3/4 of the runs, on the second 1/4: of two maps drawn, both are the same one half the time
    assert compared.wins("a", "b") == (0.5, 0.25, 0.75)


def test_wins_of_one_are_losses_of_the_other():
    rng = np.random.default_rng(2)
    compared = given(rng.choice([0.0, 0.1, 0.2, np.inf], (2, 12, 5)))
    share, low, high = compared.wins("a", "b")
    assert compared.wins("b", "a") == pytest.approx((1 - share, 1 - high, 1 - low), abs=0.02)
    assert low < share < high


@pytest.mark.parametrize(
    ("names", "message"),
    [
        (("c", "a"), "planner must be one of 'a', 'b', got 'c'"),
        (("a", "A"), "other must be one of 'a', 'b', got 'A'"),
        (("a", 0), "other must be one of 'a', 'b', got 0"),
    ],
)
def test_wins_of_a_planner_that_was_not_compared_are_refused(names, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        given([[[0.1]], [[0.2]]]).wins(*names)


def test_convergence_is_when_a_run_first_comes_to_within_a_share_of_its_final_cost(pretended):
    """Costs of 2.28, 1.64, 1.32, 1.16, 1.08, 1.04, 1.02, 1.01 times the optimum, and a tenth more with each seed."""
    evaluations, iterations = pretended.converged(0.01)
    assert evaluations[0].tolist() == [[7, 7, 7]] * 2
    assert iterations[0].tolist() == [[4, 4, 4]] * 2
    assert pretended.converged(0.07)[0][0].tolist() == [[5, 5, 5]] * 2
    assert pretended.converged(0.62)[0][0].tolist() == [[3, 2, 2]] * 2  # 1.64 > 1.62 · 1.01, but 1.74 < 1.62 · 1.11
    assert pretended.converged(0.62)[1][0].tolist() == [[2, 1, 1]] * 2


def test_a_run_below_the_optimum_converges_as_any_other(pretended):
    evaluations, iterations = pretended.converged()
    assert evaluations[1][:, [0, 2]].tolist() == [[5, 5]] * 2
    assert iterations[1][:, [0, 2]].tolist() == [[2, 2]] * 2


def test_a_run_that_never_arrives_never_converges(pretended):
    evaluations, iterations = pretended.converged()
    assert evaluations[1][:, 1].tolist() == [8, 8]
    assert iterations[1][:, 1].tolist() == [2, 2]


def test_the_share_is_of_the_cost_not_of_the_gap():
    histories = [[[[1.0, 0.02, 0.009, 0.0]]]]  # costs 2, 1.02, 1.009, 1 with the optimum of 1
    assert given([[[0.0]]], histories).converged(0.01)[0].tolist() == [[[3]]]


def test_what_comes_after_the_last_iteration_counts_as_one_more():
    histories = [[[[3.0, 2.0, 1.0, 0.5, 0.0, 0.0]]]]
    for ends, number in (([2, 4], 3), ([2, 4, 6], 3), ([5], 1), ([1, 2, 3, 4, 5, 6], 5)):
        assert given([[[0.0]]], histories, [np.array(ends)]).converged(0.01)[1].tolist() == [[[number]]]


@pytest.mark.parametrize("within", [0.0, 1.0, -0.1, np.nan])
def test_a_share_out_of_range_is_refused(pretended, within):
    with pytest.raises(ValueError, match="within must be between 0 and 1, without the ends"):
        pretended.converged(within)


def test_several_processes_give_the_same_comparison(pretended):
    again = compare(PLANNERS, MAPS, seeds=[0, 1, 2], budget=8, jobs=2)
    assert np.array_equal(again.gaps, pretended.gaps)
    assert np.array_equal(again.histories, pretended.histories)
    assert np.array_equal(again.elapsed, pretended.elapsed)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"planners": {}}, "planners must hold at least 1, got 0"),
        ({"planners": ant_colony}, "planners must be something by name, as in {'A*': ...}, got function"),
        (
            {"planners": {"ants": "ant_colony"}},
            "planners['ants'] must be a function, called as planner(risk_map, start, ",
        ),
        ({"planners": {"none": lambda **named: None}}, "what planners return must be a Route, got NoneType"),
        ({"planners": {"line": lambda **named: Route(LINE)}}, "planners must use the budget of 8, given used None"),
        ({"maps": []}, "maps must hold at least 1 RiskMap, got 0"),
        ({"maps": 3}, "maps must be a list of RiskMap, got int"),
        ({"maps": [MAPS[0], MAPS[0].city]}, "maps[1] must be a RiskMap, got City"),
        ({"seeds": []}, "seeds must hold at least 1, got 0"),
        ({"seeds": 3}, "seeds must be whole numbers, such as range(10), got 3"),
        ({"seeds": [1, 0.5]}, "seeds must be whole numbers of at least 0, such as range(10), got 0.5 in them"),
        ({"budget": 8.0}, "budget must be a whole number of at least 1, got 8.0"),
        ({"progress": "no"}, "progress must be True or False, got 'no'"),
    ],
)
def test_what_can_t_be_compared_is_named(wrong, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        compare(**({"planners": PLANNERS, "maps": MAPS, "seeds": [0], "budget": 8} | wrong))


def test_a_comparison_says_what_was_compared():
    assert repr(given(np.zeros((2, 3, 10)))) == "<Comparison of a, b: 3 maps × 10 seeds>"
    assert repr(given(np.zeros((1, 1, 1)))) == "<Comparison of a: 1 map × 1 seed>"


def test_a_repeated_seed_is_refused():
    with pytest.raises(ValueError, match=re.escape("seeds must all be different, got [0, 1, 0]")):
        compare(PLANNERS, MAPS, seeds=iter([0, 1, 0]), budget=8)


def test_a_map_without_a_route_is_named():
    occupied = np.zeros((6, 6, 4), bool)
    occupied[3] = True  # a wall from side to side and up to the top
    walled = RiskMap(City(occupied, 10.0), np.full((6, 6), 0.001), 0.5)
    with pytest.raises(ValueError, match=re.escape("maps must have a route from start to goal, maps[1] has none: ")):
        compare(PLANNERS, [MAPS[0], walled], seeds=[0], budget=8)


def test_a_planner_that_takes_another_number_of_evaluations_is_named():
    planners = {"fair": PLANNERS["halving"], "greedy": functools.partial(pretend, gaps=halving, used=9, name="cheat")}
    with pytest.raises(ValueError, match="planners must use the budget of 8, cheat used 9"):
        compare(planners, MAPS, seeds=[0], budget=8)


def test_an_error_within_a_run_says_in_which():
    def fails(risk_map, start, goal, *, budget, rng):
        raise RuntimeError("out of ants")

    with pytest.raises(RuntimeError, match="out of ants") as failed:
        compare({"fails": fails}, MAPS, seeds=[5], budget=8)
    assert "rng=5" in failed.value.__notes__[0]


RACERS = {"ants": ant_colony, "swarm": functools.partial(waypoint_swarm, arcs=50, refinement=0)}


@pytest.fixture(scope="module")
def raced():
    """Two planners on two campuses of 20 × 20 × 11 voxels, from and to where campuses are planned."""
    maps = [random_campus(seed, cell=7.5) for seed in range(2)]
    return compare_planners(RACERS, maps, seeds=range(3), budget=400, progress=False)


def test_real_planners_walk_as_far_as_the_budget_and_their_histories_end_at_their_gaps(raced):
    assert raced.histories.shape == (2, 2, 3, 400)
    assert np.isfinite(raced.gaps).all()
    assert raced.histories[..., -1] == pytest.approx(raced.gaps, abs=1e-9)
    assert (np.diff(np.where(np.isinf(raced.histories), 1e9, raced.histories), axis=-1) <= 0).all()
    assert (raced.gaps[0] > -1e-12).all()  # ants are bound to the grid, and so above its optimum
    assert (raced.gaps < 1).all()  # measured up to 0.14 and 0.31
    assert raced.iterations[0].tolist() == list(range(10, 401, 10))
    assert (np.diff(raced.iterations[1]) > 0).all()
    assert raced.iterations[1][-1] == 400
    assert (raced.elapsed > 0).all()


def test_real_runs_are_those_of_the_planners_alone(raced):
    campus = random_campus(1, cell=7.5)
    start, goal = raced.exact[1].points[[0, -1]]
    alone = ant_colony(campus, start, goal, rng=2, budget=400)
    assert optimality_gap(alone, least_risk(campus, start, goal)) == pytest.approx(raced.gaps[0, 1, 2], abs=1e-12)
    evaluations, iterations = raced.converged()
    assert ((evaluations >= 1) & (evaluations <= 400)).all()
    assert (iterations[0] == np.ceil(evaluations[0] / 10)).all()
    assert raced.table()["failed"].tolist() == [0, 0]


def test_all_are_refined_alike_with_a_share_of_the_budget(raced):
    maps = [random_campus(seed, cell=7.5) for seed in range(2)]
    refined = compare_planners(RACERS, maps, seeds=range(3), budget=400, refinement=0.4, progress=False)
    assert refined.refinement == 0.4
    assert raced.table().index.name == "planner, not refined"
    assert refined.table().index.name == "planner, refined"
    assert refined.histories.shape == raced.histories.shape
    assert refined.histories[..., -1] == pytest.approx(refined.gaps, abs=1e-9)
    assert (np.diff(np.where(np.isinf(refined.histories), 1e9, refined.histories), axis=-1) <= 1e-12).all()
    walked = ant_colony(maps[0], *CAMPUS_FLIGHT, rng=2, budget=240)
    least = refined.exact[0].cost
    assert refined.histories[0, 0, 2, 239] == pytest.approx(walked.cost / least - 1)
    alone = refine(walked, maps[0], rng=2, budget=160)
    assert refined.gaps[0, 0, 2] == pytest.approx(alone.cost / least - 1)
    assert (refined.gaps[0] < refined.histories[0, ..., 239]).mean() > 0.8
    assert (refined.gaps[0] < -1e-9).any()  # off the grid it may be below the grid's best


def test_some_refined_and_others_not_is_no_comparison():
    """The finding: curves that were refined were held against ants on the grid."""
    unequal = {"ants": ant_colony, "swarm": functools.partial(waypoint_swarm, arcs=50)}
    with pytest.raises(ValueError, match="planners must all be refined or none: swarm refines by itself; give refinem"):
        compare_planners(unequal, random_campus(0, cell=7.5), seeds=[0], budget=400, progress=False)
    both = {"swarm": unequal["swarm"], "other": functools.partial(waypoint_swarm, optimizer="pso", arcs=50)}
    raced = compare_planners(both, random_campus(0, cell=7.5), seeds=[0], budget=400, progress=False)
    assert raced.table().index.name == "planner, refined"
    for wrong in (-0.1, 1.0, np.nan):
        with pytest.raises(ValueError, match="refinement must be a share of the budget"):
            compare(PLANNERS, MAPS, seeds=[0], budget=8, refinement=wrong)


def test_a_route_that_was_not_found_can_not_be_refined_and_counts_as_failed():
    def fails(risk_map, start, goal, *, budget, rng):
        return pretend(risk_map, start, goal, budget=budget, rng=1, gaps=late)

    raced = compare({"late": fails}, MAPS, seeds=[1], budget=8, refinement=0.5)
    assert np.isinf(raced.gaps).all()
    assert raced.histories.shape[-1] == 8
