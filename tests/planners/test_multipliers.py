"""Bounds of the search with limits: they are none too high, they spare labels, and no answer changes by a bit."""

import numpy as np
import pytest
from risk_references import campus, code, constrained_case

from uavlab.planners import least_risk, multipliers, pareto_front, risk_labels
from uavlab.planners import risk_question as question
from uavlab.planners.heap import open_list
from uavlab.planners.risk_search import NOWHERE, rest_of_cost
from uavlab.risk import CAMPUS_FLIGHT
from uavlab.spline.limits import MAX_PITCH

WITHOUT, AT_ONCE = np.inf, 0
"""The patience of a search that never asks for bounds, and of one that does so for its first label."""


def answers(ask, patience, monkeypatch):
    """Points and cost of each route, to the bit."""
    monkeypatch.setattr(risk_labels, "PATIENCE", patience)
    return [(route.points.tolist(), route.cost) for route in ask()]


def asked(risk_map, ends, max_turn=question.MAX_TURN, max_pitch=MAX_PITCH, drift=False):
    """A question as arrays, what it costs and how long it is from each node on."""
    kept = question.checked_limits(risk_map, max_turn, max_pitch, 0.0, None, np.inf)
    price = question.price_per_cell(risk_map, question.Weights(drift=drift))
    query = question.query_of(risk_map, price, *(code(risk_map, end) for end in ends), kept)
    by_length = question.city_lengths(query)
    rests = [rest_of_cost(one, NOWHERE, open_list(query.blocked.size))[0] for one in (query, by_length)]
    return query, by_length, *rests


@pytest.mark.parametrize("seed", range(60))
def test_front_is_that_of_the_search_without_bounds(seed, monkeypatch):
    risk_map, ends, limits, best = constrained_case(seed)
    every = [length for _, length in best]
    for lengths in (12, 100, [*every, 99.0 * risk_map.city.cell], [*every[:2], 0.1 * risk_map.city.cell]):
        front = lambda lengths=lengths: pareto_front(risk_map, *ends, **limits, lengths=lengths)  # noqa: E731
        assert answers(front, AT_ONCE, monkeypatch) == answers(front, WITHOUT, monkeypatch)


@pytest.mark.parametrize("seed", range(60))
def test_so_it_is_with_many_limits_some_of_them_too_short_or_just_missed(seed, monkeypatch):
    """Neighbours are then taken together, those that no route keeps with those that one does."""
    risk_map, ends, limits, best = constrained_case(seed)
    every = np.array([length for _, length in best] or [risk_map.city.cell])
    missed = every * (1 - 1e-10)
    many = (np.r_[np.linspace(0.7 * every[0], 1.05 * every[-1], count), missed] for count in (70, 150))
    for lengths in (*many, *missed):
        front = lambda lengths=lengths: pareto_front(risk_map, *ends, **limits, lengths=lengths)  # noqa: E731
        assert answers(front, AT_ONCE, monkeypatch) == answers(front, WITHOUT, monkeypatch)


@pytest.mark.parametrize("drift", [False, True])
@pytest.mark.parametrize("number", range(6))
def test_campus_front_is_that_of_the_search_without_bounds(number, drift, monkeypatch):
    for lengths in (2, 12, 400):
        front = lambda lengths=lengths: pareto_front(campus(number), *CAMPUS_FLIGHT, drift=drift, lengths=lengths)  # noqa: E731
        assert answers(front, AT_ONCE, monkeypatch) == answers(front, WITHOUT, monkeypatch)
    for length in (140.0, 150.0, 1e3):
        one = lambda length=length: [least_risk(campus(number), *CAMPUS_FLIGHT, drift=drift, max_length=length)]  # noqa: E731
        assert answers(one, AT_ONCE, monkeypatch) == answers(one, WITHOUT, monkeypatch)


def test_shortest_way_over_a_lake_is_that_of_the_search_without_bounds(monkeypatch):
    """There the cost is limited and the length sought, and moves cost next to nothing."""
    for people in (np.zeros((12, 12)), np.r_[np.zeros((9, 12)), np.full((3, 12), 1e-2)]):
        lake = question.RiskMap(question.City(np.zeros((12, 12, 4), bool), 2.0), people, 0.5, safe_height=0.0)
        ask = lambda lake=lake: [least_risk(lake, (1, 1, 1), (23, 19, 5))]  # noqa: E731
        assert answers(ask, AT_ONCE, monkeypatch) == answers(ask, WITHOUT, monkeypatch)


@pytest.mark.parametrize("seed", range(60))
def test_bounds_are_below_what_the_best_routes_cost(seed):
    """By exhaustive search; and what is known to be reached is not below it."""
    risk_map, ends, limits, best = constrained_case(seed)
    if not best:
        return
    query, by_length, rest, _ = asked(risk_map, ends, **limits)
    cells = np.array([length for _, length in best]) / risk_map.city.cell * (1 + 1e-12)
    costs = np.array([cost for cost, _ in best])
    bounds, expanded = multipliers.bounds_of(query, by_length, rest, cells)
    low = bounds.rest[query.source] - np.outer(cells, bounds.multiplier)
    high = bounds.most - np.outer(cells, bounds.multiplier)
    assert (low <= costs[:, None] * (1 + 1e-9)).all()
    assert (high >= costs[:, None] * (1 - 1e-9)).all()
    assert expanded > 0


def test_bounds_spare_nine_labels_of_ten_with_drift():
    query, by_length, rest, rest_length = asked(campus(0), CAMPUS_FLIGHT, drift=True)
    limits = np.linspace(28.3, 44.0, 12)
    bounds, _ = multipliers.bounds_of(query, by_length, rest, limits)
    many, few = (
        risk_labels.search_labels(query, by_length, rest, rest_length, limits, known, np.inf)
        for known in (multipliers.no_bounds(), bounds)
    )
    assert len(few.state) < 0.1 * len(many.state)
    assert few.cost[few.found].tolist() == many.cost[many.found].tolist()
    assert few.ended
    given_up = risk_labels.search_labels(query, by_length, rest, rest_length, limits, multipliers.no_bounds(), 1000)
    assert not given_up.ended
    assert 1000 < len(given_up.state) < 1030


def test_a_search_that_has_not_found_all_says_that_it_was_given_up():
    """Whatever the patience: its answers are complete, or it tells that they are not."""
    risk_map, ends, limits, best = constrained_case(1)
    query, by_length, rest, rest_length = asked(risk_map, ends, **limits)
    cells = np.array([length for _, length in best]) / risk_map.city.cell
    search = lambda patience: risk_labels.search_labels(  # noqa: E731
        query, by_length, rest, rest_length, cells, multipliers.no_bounds(), patience
    )
    every = search(np.inf)
    assert len(every.found) == len(best) > 1
    ended = [found.ended for found in map(search, range(len(every.state) + 2)) if len(found.found) < len(best)]
    assert len(ended) > 10
    assert not any(ended)


def test_of_many_limits_neighbours_are_taken_together():
    query, by_length, rest, _ = asked(campus(1), CAMPUS_FLIGHT)
    limits = np.linspace(28.3, 44.0, 100)
    bounds, _ = multipliers.bounds_of(query, by_length, rest, limits)
    assert len(bounds.limit) == multipliers.MOST_LIMITS
    assert set(bounds.limit) < set(limits)
    assert bounds.limit[-1] == limits[-1]


def test_limits_that_no_route_keeps_have_no_use_for_labels():
    query, by_length, rest, _ = asked(campus(1), CAMPUS_FLIGHT)
    bounds, _ = multipliers.bounds_of(query, by_length, rest, np.array([10.0, 20.0, 40.0]))
    assert (bounds.most[:2] == -np.inf).all()
    assert np.isfinite(bounds.most[2]).all()


@pytest.mark.parametrize("drift", [False, True])
@pytest.mark.parametrize("seed", [1, 3])
def test_compiled_and_plain_python_agree_on_labels(seed, drift):
    risk_map, ends, limits, best = constrained_case(seed)
    query, by_length, rest, rest_length = asked(risk_map, ends, **(limits | {"drift": drift}))
    cells = np.array([length for _, length in best]) / risk_map.city.cell
    for bounds in (multipliers.no_bounds(), multipliers.bounds_of(query, by_length, rest, cells)[0]):
        fast, plain = (
            search(query, by_length, rest, rest_length, cells, bounds, np.inf)
            for search in (risk_labels.search_labels, risk_labels.search_labels.py_func)
        )
        assert all(np.array_equal(a, b) for a, b in zip(fast, plain, strict=True))
        assert len(fast.found) >= 1
    nodes = np.array([label // 9 for label in fast.state[[0]]])
    assert multipliers.cost_along(query, nodes) == multipliers.cost_along.py_func(query, nodes) == 0.0
    of_use, within = (getattr(multipliers, name) for name in ("of_use", "within"))
    for cost in (0.0, 1e9):
        assert of_use(bounds, len(cells), query.source, cost, 0.0, 0.0) == (cost == 0)
        assert of_use.py_func(bounds, len(cells), query.source, cost, 0.0, 0.0) == (cost == 0)
        assert within.py_func(bounds, 0, 0, query.source, cost, 0.0) == (cost == 0)
