"""The exact planner against SciPy's Dijkstra over states, against exhaustive search, and against its own words."""

import re
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from risk_references import (
    ANY_LIMITS,
    OFFSETS,
    ROUND_THE_BEND,
    THROUGH_THE_WALL,
    UNDECIDED,
    WEIGHTS,
    allowed,
    campus,
    code,
    constrained_case,
    corridor,
    cost_along,
    costs_of,
    keeps_limits,
    made_of,
    prices,
    random_case,
    ways,
)
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from uavlab.city import Building, City
from uavlab.planners import least_risk, pareto_front
from uavlab.planners import risk_question as question
from uavlab.planners import risk_search as search
from uavlab.planners.heap import open_list
from uavlab.risk import CAMPUS_FLIGHT, RiskMap, reference_campus
from uavlab.spline.limits import MAX_PITCH


def cheapest_by_scipy(moves, price, source, target):
    states = 9 * price.shape[1]
    graph = coo_array((costs_of(moves, price), moves[:2]), shape=(states, states)).tocsr()
    return dijkstra(graph, indices=9 * source + UNDECIDED)[9 * target : 9 * target + 9].min()


@pytest.mark.parametrize("seed", range(100))
def test_cost_is_that_of_scipy_s_dijkstra_over_states(seed):
    risk_map, limits, ends = random_case(seed)
    moves = ways(allowed(risk_map, limits["min_clearance"]), limits["max_turn"], limits["max_pitch"])
    for weights in WEIGHTS:
        price = prices(risk_map, **weights)
        expected = cheapest_by_scipy(moves, price, *(code(risk_map, end) for end in ends))
        for heuristic in ("backward", "zero"):
            route = least_risk(risk_map, *ends, **limits, **weights, heuristic=heuristic)
            assert route.cost == pytest.approx(expected, rel=1e-9, abs=1e-12 * price.max()), (weights, heuristic)
            assert route.reached is bool(np.isfinite(expected))
            assert (route.reason == "") is route.reached


@pytest.mark.parametrize("seed", range(40))
def test_sum_as_printed_is_the_least_by_scipy_s_dijkstra_over_states(seed):
    """Each move costs half of both its voxels, whatever its length; the ends lack a half, added here by hand."""
    risk_map, limits, ends = random_case(seed)
    moves = ways(allowed(risk_map, limits["min_clearance"]), limits["max_turn"], limits["max_pitch"])
    source, target = (code(risk_map, end) for end in ends)
    price = prices(risk_map) / np.linalg.norm(OFFSETS, axis=1)[:, None]
    halves = risk_map.rate.reshape(-1)[[source, target]].sum() / 2
    for heuristic in ("backward", "zero"):
        route = least_risk(risk_map, *ends, **limits, as_printed=True, heuristic=heuristic)
        expected = cheapest_by_scipy(moves, price, source, target) + halves
        assert route.cost == pytest.approx(expected, rel=1e-9, abs=1e-12 * price.max())
        if route.reached and len({code(risk_map, point) for point in route.points}) == len(route.points):
            assert route.cost == pytest.approx(risk_map.cell_sum(route), rel=1e-9, abs=1e-12 * price.max())


@pytest.mark.parametrize("number", range(20))
def test_sum_as_printed_is_that_of_the_voxels_passed(number):
    """Within a length, and with take-off and landing."""
    risk_map = campus(number)
    shortest = least_risk(risk_map, *CAMPUS_FLIGHT, risk_weight=0.0, length_weight=1.0).length
    for options in ({"max_length": 1.05 * shortest}, {"min_height": 40.0}):
        by_sum = least_risk(risk_map, *CAMPUS_FLIGHT, as_printed=True, **options)
        by_integral = least_risk(risk_map, *CAMPUS_FLIGHT, **options)
        assert by_sum.cost == pytest.approx(risk_map.cell_sum(by_sum), rel=1e-9)
        assert by_sum.cost <= risk_map.cell_sum(by_integral) * (1 + 1e-9)
        assert risk_map.integral(by_sum) >= by_integral.cost * (1 - 1e-9)


def test_sum_as_printed_is_of_the_risk_alone():
    for others in ({"drift": True}, {"length_weight": 1.0}, {"threat_weight": 1.0}, {"risk_weight": 2.0}):
        refuses(least_risk, "as_printed sums up the risk straight below", OPEN, *ENDS, as_printed=True, **others)
    refuses(least_risk, "as_printed must be True or False", OPEN, *ENDS, as_printed=1)


def classes_by_hand(risk_map, buffer):
    """Highest iGRC within a buffer of each cell's centre, for a UAV below 1 m and 25 m/s, from the definition."""
    classes = 2 + (risk_map.population_density[..., None] * 1e6 >= [5, 50, 500, 5_000, 50_000]).sum(axis=-1)
    index = np.stack(np.indices(classes.shape), axis=-1).reshape(-1, 2)
    gaps = np.maximum(np.abs(index[:, None] - index) - 0.5, 0) * risk_map.city.cell
    near = np.hypot(*np.moveaxis(gaps, -1, 0)) <= buffer
    return np.where(near, classes.ravel(), 0).max(axis=1).reshape(classes.shape)


@pytest.mark.parametrize("buffer", [0.0, 4.0])
@pytest.mark.parametrize("number", range(40))
def test_optimum_of_a_highest_class_is_that_of_scipy_s_dijkstra_over_states(number, buffer):
    """Where start or goal lie over ground of a higher class, the nearest voxels that don't take their place."""
    risk_map = campus(number)
    open_ground = classes_by_hand(risk_map, buffer) <= 6
    free = risk_map.flyable & open_ground[..., None]
    centers = risk_map.city.center_of(np.argwhere(free))
    ends = [centers[np.linalg.norm(centers - end, axis=1).argmin()] for end in CAMPUS_FLIGHT]
    moves = ways(free, question.MAX_TURN, MAX_PITCH)
    for weights in WEIGHTS[:2]:
        expected = cheapest_by_scipy(moves, prices(risk_map, **weights), *(code(risk_map, end) for end in ends))
        route = least_risk(risk_map, *ends, **weights, max_igrc=6, ground_risk_buffer=buffer)
        assert route.reached is bool(np.isfinite(expected))
        assert route.cost == pytest.approx(expected, rel=1e-9)
        if route.reached:
            assert risk_map.highest_igrc(route, ground_risk_buffer=buffer) <= 6


def test_campuses_above_are_of_all_kinds():
    bound = parted = 0
    for number in range(40):
        risk_map = campus(number)
        bound += risk_map.highest_igrc(least_risk(risk_map, *CAMPUS_FLIGHT, risk_weight=0.0, length_weight=1.0)) > 6
        parted += not (risk_map.igrc_within(4.0) <= 6).all()
    assert bound >= 20
    assert parted == 40


def test_front_keeps_to_a_highest_class():
    front = pareto_front(campus(0), *CAMPUS_FLIGHT, lengths=5, max_igrc=6)
    free = pareto_front(campus(0), *CAMPUS_FLIGHT, lengths=5)
    assert [campus(0).highest_igrc(route) for route in front] == [6] * len(front)
    assert campus(0).highest_igrc(free[0]) == 7
    assert front[0].length > free[0].length


def test_a_class_that_no_route_keeps_is_named_with_what_would_open_one():
    """A river of people across the map."""
    people = np.full((7, 7), 10e-6)
    people[3] = [1e-3] * 3 + [1e-2] * 4
    risk_map = RiskMap(City(np.zeros((7, 7, 7), bool), 2.0), people, 0.5, safe_height=0.0)
    ends = (1, 7, 7), (13, 7, 7)
    route = least_risk(risk_map, *ends, max_igrc=4)
    assert route.reason.endswith("there would be one with max_igrc=5")
    assert not pareto_front(risk_map, *ends, max_igrc=4)[0].reached
    assert risk_map.highest_igrc(least_risk(risk_map, *ends, max_igrc=5)) == 5
    tight = least_risk(risk_map, (1, 1, 7), (13, 1, 7), max_igrc=5, ground_risk_buffer=5.0)
    assert tight.reason.endswith("there would be one with max_igrc=6, or with ground_risk_buffer=0 m")
    assert pareto_front(risk_map, (1, 1, 7), (13, 1, 7), max_igrc=5, ground_risk_buffer=5.0)[0].reason == tight.reason
    with pytest.raises(
        ValueError, match=r"start .* has ground of a class above max_igrc=3 within 3 m; the nearest free"
    ):
        least_risk(risk_map, (5, 7, 7), (13, 7, 7), max_igrc=3, ground_risk_buffer=3.0)
    with pytest.raises(ValueError, match=r"goal .* has ground of a class above max_igrc=3 below it; the nearest free"):
        least_risk(risk_map, (1, 7, 7), (7, 7, 7), max_igrc=3)


def test_maps_above_ask_for_all_kinds_of_routes():
    reached, bent, steep, clear, long = 0, 0, 0, 0, 0
    for seed in range(100):
        risk_map, limits, ends = random_case(seed)
        route = least_risk(risk_map, *ends, **limits)
        free = least_risk(risk_map, *ends, **ANY_LIMITS)
        reached += route.reached
        bent += route.reached and route.cost > free.cost * (1 + 1e-9)
        steep += route.reached and (abs(route.pitch) > 1.5).any()
        clear += route.reached and limits["min_clearance"] > 0
        long += len(route.points) > 5
    assert 30 < reached < 90
    assert min(bent, steep, clear, long) >= 10


@pytest.mark.parametrize("seed", range(60))
def test_route_keeps_the_limits_and_costs_what_is_measured_on_it(seed):
    risk_map, limits, ends = random_case(seed)
    for weights in WEIGHTS:
        route = least_risk(risk_map, *ends, **limits, **weights)
        if route.reached:
            assert keeps_limits(risk_map, route, **limits)
            assert [code(risk_map, p) for p in route.points[[0, -1]]] == [code(risk_map, p) for p in ends]
            small = 1e-12 * prices(risk_map, **weights).max()
            assert route.cost == pytest.approx(cost_along(risk_map, route, **weights), rel=1e-9, abs=small)


@pytest.mark.parametrize("drift", [False, True])
@pytest.mark.parametrize(("number", "min_clearance"), [(0, 4.0), (1, 0.0), (2, 0.0), (3, 0.0)])
def test_campus_routes_keep_the_limits_and_cost_what_is_measured_on_them(number, min_clearance, drift):
    risk_map = campus(number)
    for max_turn, max_pitch in ((60, 60), (45, 36), (90, 90)):
        limits = {
            "max_turn": np.radians(max_turn),
            "max_pitch": np.radians(max_pitch),
            "min_clearance": min_clearance,
        }
        route = least_risk(risk_map, *CAMPUS_FLIGHT, **limits, drift=drift)
        assert keeps_limits(risk_map, route, **limits)
        assert route.cost == pytest.approx(cost_along(risk_map, route, drift=drift), rel=1e-9)


def test_sixty_degrees_allow_45_and_no_more():
    routes = [least_risk(campus(0), *CAMPUS_FLIGHT, max_turn=np.radians(degrees)) for degrees in (45, 60, 89.9)]
    assert len({route.cost for route in routes}) == 1
    assert np.degrees(routes[0].turn.max()) == pytest.approx(45)


@pytest.mark.parametrize(
    ("limit", "values"),
    [
        ("max_turn", np.radians([180, 90, 45])),
        ("max_pitch", np.radians([90, 45, 36])),
        ("min_clearance", [0.0, 3.0, 4.3]),
    ],
)
def test_tighter_limits_never_cost_less(limit, values):
    costs = [least_risk(campus(1), *CAMPUS_FLIGHT, **{"max_turn": np.pi, limit: value}).cost for value in values]
    assert costs[0] <= costs[1] <= costs[2]
    assert costs[0] < costs[2] * 0.99


def test_looking_back_from_the_goal_saves_four_expansions_of_five():
    """Reference campus, and the median of 20 random ones."""
    ratios = []
    for number in range(21):
        exact, plain = (least_risk(campus(number), *CAMPUS_FLIGHT, heuristic=name) for name in ("backward", "zero"))
        assert exact.cost == pytest.approx(plain.cost, rel=1e-9)
        ratios.append(plain.info["expanded"] / exact.info["expanded"])
    assert ratios[0] > 5
    assert np.median(ratios) > 4.5
    assert min(ratios) > 3


@pytest.mark.parametrize("number", range(8))
def test_second_search_walks_almost_straight_to_the_goal(number):
    risk_map = campus(number)
    limits = question.checked_limits(risk_map, question.MAX_TURN, MAX_PITCH, 0.0, None, np.inf)
    price = question.price_per_cell(risk_map, question.Weights())
    query = question.query_of(risk_map, price, *(code(risk_map, end) for end in CAMPUS_FLIGHT), limits)
    _, nodes = search.rest_of_cost(query, query.source, open_list(query.blocked.size))
    route = least_risk(risk_map, *CAMPUS_FLIGHT)
    assert len(route.points) - 1 <= route.info["expanded"] - nodes < 0.03 * nodes


@pytest.mark.parametrize("number", range(21))
def test_who_knows_of_the_drift_flies_at_less_risk(number):
    """Reference campus and 20 random ones, each with the risk as it is: where wrecks land."""
    risk_map = campus(number)
    blind, aware = (least_risk(risk_map, *CAMPUS_FLIGHT, drift=drift) for drift in (False, True))
    true = [risk_map.integral(route, drift=True) for route in (blind, aware)]
    assert aware.cost == pytest.approx(true[1], rel=1e-9)
    assert true[1] < 0.5 * true[0]


def same(routes, expected):
    """Whether routes have these pairs of cost and length, one after the other."""
    found = [(route.cost, route.length) for route in routes]
    return len(found) == len(expected) and np.allclose(found, expected, rtol=1e-9, atol=0)


@pytest.mark.parametrize("seed", range(60))
def test_within_each_length_the_risk_is_the_least(seed):
    risk_map, ends, limits, best = constrained_case(seed)
    if not best:
        assert not least_risk(risk_map, *ends, **limits).reached
        assert [route.reached for route in pareto_front(risk_map, *ends, **limits)] == [False]
        return
    every = [length for _, length in best]
    for n, length in enumerate(every):
        for allowance in (length, length * 1.0001, *every[n + 1 : n + 2]):
            route = least_risk(risk_map, *ends, **limits, max_length=allowance)
            expected = min(cost for cost, other in best if other <= allowance * (1 + 1e-9))
            assert route.cost == pytest.approx(expected, rel=1e-9)
            assert route.length <= allowance * (1 + 1e-9)
            assert keeps_limits(risk_map, route, max_turn=limits["max_turn"], max_pitch=limits["max_pitch"])
    assert same(pareto_front(risk_map, *ends, **limits, lengths=every), best)
    assert same(pareto_front(risk_map, *ends, **limits, lengths=[*every[::-1], every[0] / 2, 99 * every[-1]]), best)
    assert same([least_risk(risk_map, *ends, **limits)], best[-1:])
    assert pareto_front(risk_map, *ends, **limits, lengths=[every[0] * 0.999]) == []
    short = least_risk(risk_map, *ends, **limits, max_length=every[0] * 0.999)
    assert not short.reached
    assert short.cost == np.inf
    assert f"max_length is {every[0] * 0.999:g} m, the shortest route has" in short.reason


@pytest.mark.parametrize("seed", range(60))
def test_front_of_a_number_of_lengths_spreads_from_the_shortest_to_the_safest(seed):
    risk_map, ends, limits, best = constrained_case(seed)
    for count in (2, 5, 50) if best else ():
        asked = np.linspace(best[0][1], best[-1][1], count)
        within = [[pair for pair in best if pair[1] <= length * (1 + 1e-9)] for length in asked]
        assert same(pareto_front(risk_map, *ends, **limits, lengths=count), sorted({w[-1] for w in within})[::-1])


def test_tiny_maps_above_have_choices_to_make():
    choices = [len(constrained_case(seed)[3]) for seed in range(60)]
    assert choices.count(0) >= 2
    assert sum(count > 2 for count in choices) >= 15
    assert max(choices) >= 8


@pytest.mark.parametrize("drift", [False, True])
@pytest.mark.parametrize("number", range(4))
def test_campus_front_falls_from_the_shortest_route_to_the_safest(number, drift):
    risk_map = campus(number)
    front = pareto_front(risk_map, *CAMPUS_FLIGHT, drift=drift)
    lengths, risks = [route.length for route in front], [route.cost for route in front]
    assert len(front) >= 8
    assert (np.diff(lengths) > 1e-6).all()
    assert (np.diff(risks) < 0).all()
    assert lengths[0] == pytest.approx(
        least_risk(risk_map, *CAMPUS_FLIGHT, risk_weight=0.0, length_weight=1.0).length, rel=1e-9
    )
    assert risks[-1] == pytest.approx(least_risk(risk_map, *CAMPUS_FLIGHT, drift=drift).cost, rel=1e-9)
    blind = least_risk(risk_map, *CAMPUS_FLIGHT, risk_weight=0.0, length_weight=1.0)
    assert risks[0] <= risk_map.integral(blind, drift=drift) * (1 + 1e-9)
    for route in front:
        assert keeps_limits(risk_map, route, max_turn=np.pi / 3, max_pitch=np.pi / 3)
        assert route.cost == pytest.approx(risk_map.integral(route, drift=drift), rel=1e-9)
        again = least_risk(risk_map, *CAMPUS_FLIGHT, max_length=route.length, drift=drift)
        assert again.cost == pytest.approx(route.cost, rel=1e-9)


def test_front_of_one_length_is_one_route():
    route = least_risk(campus(0), *CAMPUS_FLIGHT, max_length=160.0)
    for lengths in (160.0, [160.0], [160.0, 160.0]):
        assert same(pareto_front(campus(0), *CAMPUS_FLIGHT, lengths=lengths), [(route.cost, route.length)])


@pytest.mark.parametrize("seed", range(12))
def test_where_nobody_is_at_risk_the_shortest_of_the_ways_of_least_risk_is_taken(seed):
    """The finding: up to 1.6 % longer over a lake with people at its end, as lengths drown in the sum of risks.

    With a weight of a millionth on the length, of what a cell of the shore costs, they don't.
    """
    rng = np.random.default_rng(seed)
    people, occupied = rng.uniform(0.01, 0.03, (40, 30)), np.zeros((40, 30, 8), bool)
    people[12:] = 0.0
    occupied[16:20, 8:25, :6] = occupied[28:31, :20] = True
    risk_map = RiskMap(City(occupied, cell=5.0), people, 0.2)
    ends = (182.5, 122.5, 32.5), (12.5, 12.5, 17.5)
    route = least_risk(risk_map, *ends)
    resolved = least_risk(risk_map, *ends, length_weight=1e-6 * risk_map.rate[people > 0].min() / 5)
    assert route.length == pytest.approx(resolved.length, rel=1e-12)
    assert risk_map.integral(route) == pytest.approx(risk_map.integral(resolved), rel=1e-12)
    front = pareto_front(risk_map, *ends, lengths=4)
    assert front[-1].length == pytest.approx(route.length, rel=1e-12)


def test_over_a_lake_equal_risk_means_the_shorter_way():
    """Nobody there, so all ways cost the same: nothing."""
    shore = np.full((30, 30), 0.01)
    shore[:, 8:22] = 0.0
    city, ends = City(np.zeros((30, 30, 12), bool), 5.0), ((12.5, 12.5, 32.5), (132.5, 132.5, 32.5))
    nobody = least_risk(RiskMap(city, 0.0, 0.0), *ends)
    assert nobody.length == pytest.approx(24 * 5 * 2**0.5)
    assert nobody.cost == pytest.approx(0.0, abs=1e-290)
    crossing, nudged = (least_risk(RiskMap(city, shore, 0.0), *ends, length_weight=length) for length in (0.0, 1e-12))
    assert crossing.cost == pytest.approx(nudged.cost, rel=1e-4)
    assert crossing.length < 1.02 * nudged.length


def shaft(*, bend=False):
    """Two floors joined by a hole of a single voxel; the lower one is whole, or a corridor with a bend."""
    occupied = np.zeros((6, 3, 3), bool)
    occupied[:, :, 1] = True
    occupied[5, 2, 1] = False
    if bend:
        occupied[:, :, :1] = corridor().city.occupied
    return made_of(occupied)


def ramp():
    """One voxel wide, two high: no room for moves through corners."""
    occupied = np.ones((6, 1, 6), bool)
    for i in range(6):
        occupied[max(i - 1, 0) : i + 2, 0, i] = False
    return made_of(occupied)


def tunnel(**heights):
    """A wall with a hole at the bottom, three voxels wide and two high."""
    occupied = np.zeros((9, 7, 6), bool)
    occupied[4] = True
    occupied[4, 2:5, :2] = False
    return made_of(occupied, **heights)


NOT_ARRIVING = {
    "bend": (corridor(), ROUND_THE_BEND, {}, ["max_turn=90°"]),
    "no turn": (made_of(np.zeros((3, 3, 1), bool)), ((1, 1, 1), (3, 5, 1)), {"max_turn": 0.0}, ["max_turn=45°"]),
    "shaft": (shaft(), ((1, 1, 1), (1, 1, 5)), {"max_turn": np.pi}, ["max_pitch=90°"]),
    "ramp": (ramp(), ((1, 1, 1), (11, 1, 11)), {"max_pitch": np.radians(40)}, ["max_pitch=45°"]),
    "level": (made_of(np.zeros((6, 6, 4), bool)), ((1, 1, 1), (11, 11, 7)), {"max_pitch": 0.0}, ["max_pitch=35.27°"]),
    "narrow": (tunnel(), ((1, 7, 3), (17, 7, 3)), {"min_clearance": 3.5}, ["min_clearance=3 m"]),
    "low": (tunnel(safe_height=4.0), THROUGH_THE_WALL, {}, ["safe_height=3 m"]),
    "lower": (tunnel(min_height=4.0), THROUGH_THE_WALL, {}, ["min_height=3 m"]),
    "either": (
        corridor(basement=True, min_height=3.0),
        ((1, 1, 3), (11, 5, 3)),
        {},
        ["max_turn=90°", "min_height=1 m"],
    ),
    "bend, within a length": (corridor(), ROUND_THE_BEND, {"max_length": 14.0}, ["max_turn=90°"]),
    "bend, too far": (corridor(), ROUND_THE_BEND, {"max_length": 13.0}, ["max_turn=90° and max_length=14.00 m"]),
    "bend and shaft": (shaft(bend=True), ((1, 1, 1), (1, 1, 5)), {}, ["max_turn=90° and max_pitch=90°"]),
    "low and narrow": (
        tunnel(safe_height=4.0),
        ((1, 7, 5), (17, 7, 7)),
        {"min_clearance": 3.5},
        ["min_clearance=1 m and safe_height=3 m"],
    ),
}


def cures_in(reason):
    """What would open a route, as lists of (name, value): "there would be one with a=1 m and b=2°, or with c=3"."""
    _, _, words = reason.partition("there would be one with ")
    found = [re.findall(r"(\w+)=([\d.]+)(°?)", cure) for cure in words.split(", or with ") if words]
    return [{name: float(np.radians(float(v)) if degrees else v) for name, v, degrees in cure} for cure in found]


def ask_with(risk_map, ends, limits, cure):
    """The route with other limits or heights of the map."""
    heights = {name: value for name, value in cure.items() if name.endswith("_height")}
    others = {name: value for name, value in cure.items() if name not in heights}
    return least_risk(replace(risk_map, **heights), *ends, **(limits | others))


def helps_and_goes_no_further_than_it_must(cure, risk_map, ends, limits):
    tighter = [cure | {name: cure[name] + (-0.02 if name.startswith("max") else 0.02)} for name in cure]
    return ask_with(risk_map, ends, limits, cure).reached and not any(
        ask_with(risk_map, ends, limits, close).reached for close in tighter
    )


@pytest.mark.parametrize("case", NOT_ARRIVING)
def test_reason_says_what_would_open_a_route_and_it_does(case):
    risk_map, ends, limits, cures = NOT_ARRIVING[case]
    route = least_risk(risk_map, *ends, **limits)
    assert not route.reached
    assert route.cost == np.inf
    assert route.points.shape == (0, 3)
    assert route.reason.startswith(f"no route from ({ends[0][0]}.0, ")
    assert route.reason.endswith("there would be one with " + ", or with ".join(cures))
    for cure in cures_in(route.reason):
        assert helps_and_goes_no_further_than_it_must(cure, risk_map, ends, limits)


@pytest.mark.parametrize("seed", range(150))
def test_every_named_cure_helps_on_random_maps(seed):
    risk_map, limits, ends = random_case(seed)
    if seed % 3 == 0:
        limits["max_length"] = 1.2 * np.linalg.norm(ends[1] - ends[0])
    route = least_risk(risk_map, *ends, **limits)
    cures = cures_in(route.reason)
    for cure in cures:
        assert helps_and_goes_no_further_than_it_must(cure, risk_map, ends, limits)
    if route.reached:
        assert route.reason == ""
    elif "max_length is" in route.reason:
        length = float(re.search(r"shortest route has ([\d.]+) m", route.reason)[1])
        assert least_risk(risk_map, *ends, **(limits | {"max_length": length})).reached
        assert not least_risk(risk_map, *ends, **(limits | {"max_length": length - 0.02})).reached
    elif not cures:
        assert route.reason.endswith("obstacles close every way")
        assert not least_risk(replace(risk_map, safe_height=0.0, min_height=0.0), *ends, **ANY_LIMITS).reached


def test_maps_above_need_all_kinds_of_cures():
    reasons = []
    for seed in range(150):
        risk_map, limits, ends = random_case(seed)
        reasons.append(least_risk(risk_map, *ends, **limits).reason)
    for words in ("max_turn=", "max_pitch=", "min_clearance=", "safe_height=", ", or with", " and ", "obstacles"):
        assert sum(words in reason for reason in reasons) >= 2, words


def test_walls_all_around_are_named():
    occupied = np.zeros((7, 7, 7), bool)
    occupied[1:6, 1:6, 1:6] = True
    occupied[2:5, 2:5, 2:5] = False
    for limits in ({}, {"max_length": 5.0}, ANY_LIMITS):
        for ask in (least_risk, lambda *ends, max_length=0, **limits: pareto_front(*ends, **limits)[0]):
            route = ask(made_of(occupied), (7, 7, 7), (1, 1, 1), **limits)
            assert not route.reached
            assert route.reason == "no route from (7.0, 7.0, 7.0) to (1.0, 1.0, 1.0): obstacles close every way"


def test_front_that_no_route_leads_to_says_why():
    (route,) = pareto_front(corridor(), *ROUND_THE_BEND)
    assert not route.reached
    assert route.reason.endswith("there would be one with max_turn=90°")
    assert len(pareto_front(corridor(), *ROUND_THE_BEND, max_turn=np.pi / 2)) == 1


OPEN = made_of(np.zeros((8, 8, 4), bool))
ENDS = (1.0, 1.0, 1.0), (15.0, 15.0, 7.0)
HIGH = replace(OPEN, safe_height=2.5)
BOTH = (least_risk, pareto_front)


def refuses(ask, message, *arguments, **options):
    with pytest.raises(ValueError, match=message):
        ask(*arguments, **options)


@pytest.mark.parametrize("ask", BOTH)
@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"max_turn": 60}, r"max_turn must be from 0 to 3.14159 rad \(from degrees: numpy.radians\), got 60"),
        ({"max_turn": -0.1}, "max_turn must be from 0 to .* got -0.1"),
        ({"max_turn": np.nan}, "max_turn must be from 0 to .* got nan"),
        ({"max_turn": [0.5, 0.6]}, "max_turn must be one number"),
        ({"max_turn": "60°"}, "max_turn must be a number"),
        ({"max_pitch": 1.6}, "max_pitch must be from 0 to 1.5708 rad .* got 1.6"),
        ({"max_pitch": -1}, "max_pitch must be from 0 to .* got -1"),
        ({"max_pitch": np.nan}, "max_pitch must be from 0 to .* got nan"),
        ({"min_clearance": -1.0}, "min_clearance must be finite and at least 0, got -1"),
        ({"min_clearance": np.nan}, "min_clearance must be .* got nan"),
        ({"min_clearance": None}, "min_clearance must be a number .* got None"),
        ({"min_clearance": "3 m"}, "min_clearance must be a number .* got text, '3 m'"),
    ],
)
def test_limits_out_of_range_are_refused(ask, options, message):
    refuses(ask, message, OPEN, *ENDS, **options)


@pytest.mark.parametrize("ask", BOTH)
@pytest.mark.parametrize(
    ("ends", "message"),
    [
        (((np.nan, 1, 1), ENDS[1]), "start must be finite"),
        ((ENDS[0], (1, 1)), "goal must be three numbers"),
        (("here", ENDS[1]), "start must be a number or an array of numbers: got text, 'here'"),
        ((ENDS[0], (99, 1, 1)), "goal .* lies outside of the map: x 0 to 16, y 0 to 16, z 0 to 8 m"),
        ((ENDS[0], (0.5, 0.5, 0.5)), "lie in the same voxel"),
    ],
)
def test_ends_that_make_no_question_are_refused(ask, ends, message):
    refuses(ask, message, OPEN, *ends)


@pytest.mark.parametrize("ask", BOTH)
def test_a_city_is_no_risk_map(ask):
    refuses(
        ask, r"risk_map must be a RiskMap, got City: RiskMap\(city, population_density, shelter\)", OPEN.city, *ENDS
    )


@pytest.mark.parametrize("ask", BOTH)
def test_ends_that_may_not_be_flown_are_told_why_and_where_one_may(ask):
    too_low = (
        r"start \(1.0, 1.0, 1.0\) is 1.0 m above what lies below, safe_height asks for 2.5 m; "
        r"the nearest free point is \(1.0, 1.0, 3.0\)"
    )
    refuses(ask, too_low, HIGH, *ENDS)
    refuses(ask, "goal .* is 1.0 m above what lies below", HIGH, *ENDS[::-1])
    refuses(
        ask,
        "start .* lies below min_height=99 m, .* no voxel of the map is free",
        replace(OPEN, min_height=99.0),
        *ENDS,
    )
    house = Building.prism([(4, 4), (8, 4), (8, 8), (4, 8)], 6.0, name="town hall")
    town = RiskMap(City.from_buildings([house], cell=2.0, origin=(0, 0, 0), size=(16, 16, 12)), 0.01, 0.5)
    refuses(ask, "start .* lies in building 'town hall'", town, (6, 6, 3), (1, 1, 9))
    refuses(ask, r"goal \(6.0, 6.0, 7.0\) is 1.0 m above what lies below, safe_height asks", town, (1, 1, 9), (6, 6, 7))
    refuses(ask, "start .* is 1.00 m from the nearest obstacle", town, (3, 5, 5), (1, 1, 9), min_clearance=2.0)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (
            {"risk_weight": 0.0},
            "risk_weight, length_weight, threat_weight are all 0: give at least one of them a weight above 0",
        ),
        ({"risk_weight": -1.0}, "risk_weight must be finite and at least 0, got -1"),
        ({"length_weight": np.inf}, "length_weight must be finite and at least 0, got inf"),
        ({"threat_weight": np.nan}, "threat_weight must be finite and at least 0, got nan"),
        ({"threat_weight": [1.0, 2.0]}, "threat_weight must be one number"),
        ({"heuristic": "octile"}, "heuristic must be one of 'backward', 'zero', got 'octile'"),
        ({"max_length": 0.0}, "max_length must be above 0, got 0"),
        ({"max_length": np.nan}, "max_length must be above 0, got nan"),
        ({"max_length": "far"}, "max_length must be a number"),
        ({"max_length": [10.0, 20.0]}, "max_length must be one number"),
    ],
)
def test_weights_and_lengths_out_of_range_are_refused(options, message):
    refuses(least_risk, message, OPEN, *ENDS, **options)


@pytest.mark.parametrize(
    ("lengths", "message"),
    [
        (1, "lengths must be a whole number of at least 2, got 1"),
        (0, "lengths must be a whole number of at least 2, got 0"),
        ([], "lengths is empty"),
        (10**5, "lengths must be at most 10,000"),
        ([[20.0, 30.0]], r"lengths must have shape \(N,\), got \(1, 2\)"),
        ([20.0, 0.0], "lengths must be finite and above 0, got 0"),
        ([20.0, np.nan], "lengths must be finite and above 0, got nan"),
        (-5.0, "lengths must be finite and above 0, got -5"),
        ("many", "lengths must be a number"),
    ],
)
def test_lengths_that_make_no_question_are_refused(lengths, message):
    refuses(pareto_front, message, OPEN, *ENDS, lengths=lengths)
    refuses(pareto_front, message, corridor(), *ROUND_THE_BEND, lengths=lengths)


def test_threat_needs_buildings_that_the_city_knows():
    refuses(least_risk, "city must know its buildings", tunnel(), *THROUGH_THE_WALL, threat_weight=1.0)


def test_ends_may_lie_anywhere_in_their_voxels():
    route = least_risk(OPEN, (0.1, 1.9, 1.2), (15.9, 14.1, 7.3))
    assert route.points[[0, -1]].tolist() == [list(end) for end in ENDS]


@pytest.mark.parametrize("drift", [False, True])
@pytest.mark.parametrize("seed", [1, 3])
def test_compiled_and_plain_python_agree(seed, drift):
    risk_map, ends, limits, _ = constrained_case(seed)
    kept = question.checked_limits(risk_map, limits["max_turn"], limits["max_pitch"], 0.0, None, np.inf)
    price = question.price_per_cell(risk_map, question.Weights(drift=drift))
    query = question.query_of(risk_map, price, *(code(risk_map, end) for end in ends), kept)
    by_length, count = question.city_lengths(query), query.blocked.size

    def run(name, *arguments):
        return getattr(search, name)(*arguments), getattr(search, name).py_func(*arguments)

    rests = []
    for asked in (query, by_length):
        for until in (asked.source, search.NOWHERE):
            fast, plain = run("rest_of_cost", asked, until, open_list(count))
            assert np.array_equal(fast[0], plain[0])
            assert fast[1] == plain[1] > 10
            rests.append(fast[0])
    trees = []
    for searched in (search.search_states, search.search_states.py_func):
        g, parent = np.empty(count * 9), np.zeros(count * 9, np.uint8)
        found = searched(query, rests[0], g, parent, open_list(count * 9))
        trees.append((*found, g[parent > 0].tolist(), parent.tolist()))
    assert trees[0] == trees[1]
    assert len({f(query, 3, 1, 2) for f in (question.edge, question.edge.py_func)}) == 1


EVEN = """
import numpy as np
from uavlab.city import City
from uavlab.planners import least_risk, pareto_front
from uavlab.risk import RiskMap
even = RiskMap(City(np.zeros((12, 12, 8), bool), 5.0), 0.01, 0.5, safe_height=0.0)
even.__dict__["rate"] = np.full(even.city.shape, 1e-6)
ends = (2.5, 2.5, 2.5), (57.5, 32.5, 27.5)
routes = [least_risk(even, *ends), least_risk(even, *ends, heuristic="zero"), *pareto_front(even, *ends)]
answer = repr([route.points.tolist() for route in routes])
"""


def test_of_many_equal_routes_the_same_one_is_taken_in_every_process():
    answers = []
    for _ in range(2):
        scope = {}
        exec(EVEN, scope)
        answers.append(scope["answer"])
    assert len(scope["routes"]) == 3
    assert np.ptp([route.length for route in scope["routes"]]) < 1e-9
    fresh = subprocess.run([sys.executable, "-c", EVEN + "print(answer)"], capture_output=True, text=True, check=True)
    assert {*answers, fresh.stdout.strip()} == {answers[0]}


def test_same_question_same_route_on_the_campus():
    for options in ({}, {"drift": True}, {"max_length": 160.0}, {"risk_weight": 0.0, "length_weight": 1.0}):
        first, second = (least_risk(campus(0), *CAMPUS_FLIGHT, **options) for _ in range(2))
        assert np.array_equal(first.points, second.points)
        assert first.cost == second.cost
        assert first.info["expanded"] == second.info["expanded"]


def test_asking_does_not_change_the_map():
    risk_map = campus(0)
    arrays = [risk_map.rate, risk_map.flyable, risk_map.threat, risk_map.rate_ahead, risk_map.city.occupied]
    before = [array.copy() for array in arrays]
    least_risk(risk_map, *CAMPUS_FLIGHT, length_weight=0.1, threat_weight=0.1, drift=True, min_clearance=3.0)
    pareto_front(risk_map, *CAMPUS_FLIGHT, lengths=3)
    assert all(np.array_equal(a, b) for a, b in zip(arrays, before, strict=True))


def test_the_point_suggested_instead_of_one_in_a_building_is_flyable():
    campus = reference_campus()
    with pytest.raises(ValueError, match=r"start .* lies in building .*; the nearest free point is") as refused:
        least_risk(campus, (57.5, 12.5, 22.5), CAMPUS_FLIGHT[1])
    point = [float(part) for part in str(refused.value).rsplit("(", 1)[1].rstrip(")").split(",")]
    assert campus.flyable[tuple(campus.city.cell_of(point))]
    assert least_risk(campus, point, CAMPUS_FLIGHT[1]).reached


@pytest.mark.parametrize("cell", [0.1, 0.3, 1.0])
@pytest.mark.parametrize("corner", [(0, 0, 0), (5e5, 5e6, 0)])
def test_the_length_of_the_shortest_route_is_enough_wherever_the_map_lies(cell, corner):
    """Before, on 9 of 20 such maps with coordinates of a million metres it wasn't, as these are rounded."""
    found = 0
    for seed in range(12):
        rng = np.random.default_rng(seed)
        city = City(rng.random((12, 12, 6)) < 0.1, cell=cell, origin=corner)
        risk_map = RiskMap(city, rng.uniform(0, 0.05, (12, 12)), 0.2, safe_height=0.0)
        ((start, goal),) = city.random_pairs(1, seed, apart=5 * cell)
        shortest = least_risk(risk_map, start, goal, risk_weight=0.0, length_weight=1.0)
        if shortest.reached:
            least = least_risk(risk_map, start, goal, max_length=shortest.length)
            assert least.reached
            assert least.length <= shortest.length * (1 + 1e-7)
            found += 1
    assert found > 6
