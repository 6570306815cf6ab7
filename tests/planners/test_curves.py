"""Costs of curves against the exact integral of a route, breaches against sampling and against angles by hand."""

import numpy as np
import pytest

from uavlab.checks import frozen
from uavlab.city import City
from uavlab.city.segments import runs_of
from uavlab.planners.curves import PER_SEGMENT, SLACK, Measure, Sky, Task, Weights, breaches, costs_of, task_of
from uavlab.planners.risk_question import MAX_TURN, checked_limits, flyable_endpoints, price_per_cell
from uavlab.risk import CAMPUS_FLIGHT, RiskMap, random_campus, reference_campus
from uavlab.risk.drift import NO_FALLS, landing_rate
from uavlab.route import Route
from uavlab.spline import cubic_bspline
from uavlab.spline.limits import MAX_PITCH

ANY = {"max_turn": np.pi, "max_pitch": np.pi / 2}
RISK = Weights()


def sky_over(
    price, closed, max_turn=np.pi, max_pitch=np.pi / 2, lowest=-np.inf, highest=np.inf, keep=0.0, longest=np.inf
):
    """A map as curves see it, without limits but for those given [cells]."""
    low, high = np.full(closed.shape, lowest, float), np.full(closed.shape[:2], highest, float)
    clearance = City(closed).clearance if keep else np.empty((0, 0, 0))
    arrays = [frozen(np.array(values)) for values in (low, high, clearance)]
    return Sky(
        price,
        NO_FALLS,
        0.0,
        frozen(closed, bool),
        *arrays[:2],
        runs_of(closed),
        arrays[2],
        keep,
        max_turn,
        max_pitch,
        longest,
    )


def random_sky(rng):
    shape = rng.integers(4, 12, 3)
    return sky_over(10 ** rng.uniform(-6, -3, shape), rng.random(shape) < 0.3)


def random_lines(rng, shape, count=5, beyond=0.0):
    """Polylines (N, P, 3) within a map of this shape [cells], or so far beyond its edges."""
    size = np.array(shape)
    return rng.uniform(-beyond, size - 1e-9 + beyond, (count, rng.integers(2, 9), 3))


@pytest.mark.parametrize("seed", range(60))
def test_cost_and_way_in_closed_voxels_are_the_integrals_of_a_route(seed):
    rng = np.random.default_rng(seed)
    sky = random_sky(rng)
    city = City(np.zeros(sky.closed.shape, bool), 1.0)
    lines = random_lines(rng, city.shape)
    if seed % 2:
        lines = cubic_bspline(lines, 6)
    costs, closed, angles, _ = costs_of(sky, lines)
    for line, cost, shut in zip(lines, costs, closed, strict=True):
        route = Route(line)
        assert cost == pytest.approx(route.integral(city, sky.price), rel=1e-9)
        assert shut == pytest.approx(route.integral(city, sky.closed), rel=1e-9, abs=1e-9)
    assert (angles == 0).all() or seed % 2  # any turn, on legs longer than a voxel


@pytest.mark.parametrize("seed", range(20))
def test_off_the_map_is_closed_and_costs_nothing(seed):
    """Against 20 000 samples along the way; the error of a sum over samples is some jumps of one sample each."""
    rng = np.random.default_rng(seed)
    sky = random_sky(rng)
    (line,) = random_lines(rng, sky.closed.shape, count=1, beyond=3.0)
    (cost,), (closed,), _, _ = costs_of(sky, line[None])
    dense = Route(line).resample(1e-3).points
    middles, length = (dense[1:] + dense[:-1]) / 2, np.linalg.norm(np.diff(dense, axis=0), axis=1)
    index = np.floor(middles).astype(int)
    inside = ((index >= 0) & (index < sky.closed.shape)).all(axis=1)
    shut, price = np.ones(len(index)), np.zeros(len(index))
    shut[inside], price[inside] = (values[tuple(index[inside].T)] for values in (sky.closed, sky.price))
    crossings = 3 * np.abs(np.diff(index, axis=0)).sum()
    assert closed == pytest.approx(shut @ length, abs=1e-3 * crossings)
    assert cost == pytest.approx(price @ length, abs=1e-3 * crossings * sky.price.max())
    assert closed > 0


def test_a_line_along_the_edge_of_the_map_is_within_it_below_and_off_it_above():
    sky = sky_over(np.ones((4, 4, 4)), np.zeros((4, 4, 4), bool))
    low, high = np.array([[[0, 0, 0], [4, 0, 0]], [[0, 4, 0], [4, 4, 0]]], float)
    costs, closed, _, _ = costs_of(sky, np.array([low, high]))
    assert costs.tolist() == [4, 0]
    assert closed.tolist() == [0, 4]


def east_then(degrees, before=2.0, after=2.0, climb=0.0):
    """A leg to the east and one that turns, with their level lengths [cells]."""
    turn = np.radians(degrees)
    x, y = before + after * np.cos(turn), after * np.sin(turn)
    return [(0, 0, 0), (before, 0, climb), (x, y, 2 * climb)]


def angles_of(points, max_turn=60.0, max_pitch=90.0):
    """Excess of angles of one polyline [degrees]."""
    line = np.array([points], dtype=float) + 20.0
    sky = sky_over(np.ones((40, 40, 40)), np.zeros((40, 40, 40), bool), *np.radians([max_turn, max_pitch]))
    return np.degrees(costs_of(sky, line)[2][0])


@pytest.mark.parametrize(
    ("points", "limits", "excess"),
    [
        (east_then(60), {}, 0),  # exactly at the limit
        (east_then(-60), {}, 0),
        (east_then(60.001), {}, 0.001),
        (east_then(100), {}, 40),
        (east_then(-100), {}, 40),
        (east_then(180), {}, 120),
        (east_then(180), {"max_turn": 180}, 0),
        (east_then(1), {"max_turn": 0}, 1),
        (east_then(45, before=0.5, after=0.5), {}, 45 - 30),  # legs of half a voxel: half of the turn
        (east_then(30, before=0.5, after=0.5), {}, 0),
        (east_then(45, before=0.25, after=0.75), {}, 45 - 30),  # their mean counts
        (east_then(60, before=0.5, after=1.5), {}, 0),
        (east_then(60, before=0.3, after=0.4, climb=0.4), {}, 60 - 60 * (0.5 + np.sqrt(0.32)) / 2),
        ([(0, 0, 0), (2, 0, 2)], {"max_pitch": 45}, 0),
        ([(0, 0, 0), (2, 0, -2)], {"max_pitch": 45}, 0),
        ([(0, 0, 0), (2, 0, 2)], {"max_pitch": 30}, 15),
        ([(0, 0, 0), (0, 0, -2)], {"max_pitch": 60}, 30),
        ([(0, 0, 0), (0, 0, 2)], {"max_pitch": 90}, 0),
        ([(0, 0, 0), (0.01, 0, 0.01)], {"max_pitch": 40}, 5),  # however short
        ([(0, 0, 0), (0, 0, 2), (2, 0, 2), (2, 0, 5), (0, 2, 5)], {}, 135 - 60),  # vertical: the heading before stays
        ([(0, 0, 0), (2, 0, 0), (2, 0, 3), (0, 0, 3)], {}, 120),
        ([(0, 0, 0), (2, 0, 0), (2, 0, 0), (0, 0, 0)], {}, 120),  # a leg of no length has no heading either
        ([(0, 0, 0), (0, 0, 2), (0, 2, 2)], {}, 0),  # nor has the first
        ([(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0)], {}, 30 + 30),
        ([(0, 0, 0), (2, 0, 4), (2, 2, 0)], {"max_pitch": 60}, 2 * (np.degrees(np.arctan(2)) - 60) + 30),
    ],
)
def test_excess_of_angles_is_that_by_hand(points, limits, excess):
    assert angles_of(points, **limits) == pytest.approx(max(excess, 0), abs=1e-6)
    assert (angles_of(points, **limits) == 0) == (excess <= 0)
    assert angles_of(points[::-1], **limits) == pytest.approx(max(excess, 0), abs=1e-6)


@pytest.mark.parametrize("seed", range(40))
def test_a_line_without_excess_turns_and_climbs_as_route_says_within_the_limits(seed):
    rng = np.random.default_rng(seed)
    heading = np.cumsum(np.radians(rng.choice((-60, -59, 0, 30, 60), 9)))
    level = rng.integers(2, size=9) | (np.arange(9) == 0)  # some legs are vertical
    steps = np.stack([level * np.cos(heading), level * np.sin(heading), np.where(level, rng.uniform(-1, 1, 9), 1)], 1)
    points = np.insert(np.cumsum(2 * steps, axis=0), 0, 0.0, axis=0)
    route = Route(points)
    over = np.maximum(route.turn - np.pi / 3 - SLACK, 0)
    assert np.radians(angles_of(points)) == pytest.approx(over.sum(), abs=1e-8)


def campus_task(spline=True, **limits):
    risk_map = reference_campus()
    return risk_map, task_for(risk_map, *CAMPUS_FLIGHT, spline, **limits)


def task_for(risk_map, start, goal, spline=True, **limits):
    every = {"max_turn": MAX_TURN, "max_pitch": MAX_PITCH, "min_clearance": 0.0, "min_height": None}
    limits = checked_limits(risk_map, **(every | {"max_height": np.inf} | limits))
    price = price_per_cell(risk_map, Weights())
    return task_of(risk_map, flyable_endpoints(risk_map, start, goal, limits), price, RISK, limits, spline)


def test_task_is_the_question_in_cells():
    risk_map, task = campus_task(min_clearance=4.0)
    for end, point in zip((task.source, task.target), CAMPUS_FLIGHT, strict=True):
        city = risk_map.city
        assert city.origin + city.cell * end == pytest.approx(city.center_of(city.cell_of(np.array(point))))
    assert np.array_equal(task.sky.price, risk_map.rate)
    assert np.array_equal(task.sky.closed, risk_map.city.occupied)
    assert task.sky.keep == pytest.approx(4.0 / risk_map.city.cell)
    roofs = np.maximum(risk_map.city.surface_below + risk_map.safe_height, risk_map.min_height) / risk_map.city.cell
    assert task.sky.lowest == pytest.approx(roofs)
    assert np.isinf(task.sky.highest).all()
    (_, task) = campus_task(max_height=60.0, min_height=20.0)
    assert task.sky.highest == pytest.approx(np.full(risk_map.city.shape[:2], 12))
    assert task.sky.lowest.min() == pytest.approx(4)


def curves_near(task, rng, count=40, waypoints=5, wide=4.0):
    """Control points (N, K + 2, 3) around the straight line."""
    control = np.linspace(task.source, task.target, waypoints + 2) + rng.normal(0, wide, (count, waypoints + 2, 3))
    control[:, 0], control[:, -1] = task.source, task.target
    return np.clip(control, 0, np.array(task.sky.closed.shape) - 1e-9)


@pytest.mark.parametrize("spline", [True, False])
def test_costs_are_the_integral_and_any_breach_costs_more_the_worse_it_is(spline):
    risk_map, task = campus_task(spline)
    control = curves_near(task, np.random.default_rng(0), count=300, wide=4.0 if spline else 1.5)
    control[::2, 1:-1, 2] += 4.0  # above most roofs
    costs = task.costs(control, PER_SEGMENT)
    lines = task.lines(control, PER_SEGMENT)
    _, closed, angles, _ = costs_of(task.sky, lines)
    broken = closed + angles
    city = risk_map.city
    for line, cost in zip(lines[broken == 0], costs[broken == 0], strict=True):
        assert cost == pytest.approx(risk_map.integral(Route(city.origin + line * city.cell)), rel=1e-9)
    assert 5 < (broken == 0).sum() < 295
    assert costs[broken > 0].min() > 10 * costs[broken == 0].max()
    little, much = broken[broken > 0] < 0.5, broken[broken > 0] > 5
    assert costs[broken > 0][little].max() < costs[broken > 0][much].min()


def test_a_long_way_round_still_costs_less_than_a_little_breach():
    """Start and goal three cells apart, on both sides of a wall: the way around is fifteen times as long."""
    occupied = np.zeros((40, 40, 4), bool)
    occupied[:35, 20] = True
    risk_map = RiskMap(City(occupied, 2.0), 0.01, 0.5, safe_height=0.0)
    task = task_for(risk_map, (21, 38, 5), (21, 44, 5), False, **ANY)
    round_it, through_it = [(38, 19, 2.5), (38, 22, 2.5)], [(10.5, 20.5, 2.5), (10.5, 21, 2.5)]
    good, bad = (task.costs(np.array([[task.source, *way, task.target]]), 1)[0] for way in (round_it, through_it))
    assert good < bad / 10
    assert good == pytest.approx(risk_map.rate.max() * 54, rel=0.2)


@pytest.mark.parametrize("spline", [True, False])
def test_finer_is_the_same_curve_with_a_point_more_between_each_two(spline):
    _, task = campus_task(spline)
    rng = np.random.default_rng(1)
    for waypoints in (1, 2, 5, 20):
        (control,) = curves_near(task, rng, count=1, waypoints=waypoints)
        finer = task.finer(control)
        assert finer.shape == (2 * waypoints + 3, 3)
        dense, denser = task.lines(control[None], 8)[0], task.lines(finer[None], 4)[0]
        if spline:
            assert denser == pytest.approx(dense, abs=1e-12)
        else:
            assert denser[::2] == pytest.approx(dense, abs=1e-12)
            assert Route(denser).length == pytest.approx(Route(dense).length)
        for coarse, fine in zip(costs_of(task.sky, dense[None])[:2], costs_of(task.sky, denser[None])[:2], strict=True):
            assert fine == pytest.approx(coarse, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("spline", [True, False])
def test_nearest_follows_a_route_the_closer_the_more_points_it_has(spline):
    _, task = campus_task(spline)
    points = np.array([(2, 3, 4), (2, 20, 4), (20, 20, 10), (22, 22, 5)], float)
    apart = []
    for count in (3, 6, 12, 24, 48):
        control = task.nearest(points, count)
        assert control.shape == (count, 3)
        assert control[[0, -1]] == pytest.approx(points[[0, -1]])
        line = Route(task.lines(control[None], 8)[0]).resample(0.05).points
        apart.append(max(np.linalg.norm(line - point, axis=1).min() for point in Route(points).resample(0.1).points))
    assert (np.diff(apart) < 0).all()
    assert apart[-1] < 0.5


def test_measure_counts_curves_and_notes_the_best_and_the_least_cost_of_a_sound_one():
    _, task = campus_task()
    control = curves_near(task, np.random.default_rng(2), count=60)
    control[20:, 1:-1, 2] += 4.0
    measure = Measure(task)
    values = np.concatenate([measure(control[:25]), measure(control[25:27], 4), measure(control[27:])])
    expected = np.concatenate([task.costs(control[:25], 8), task.costs(control[25:27], 4), task.costs(control[27:], 8)])
    assert np.array_equal(values, expected)
    assert measure.made == 60
    sound = np.where(expected < task.unflyable, expected, np.inf)
    assert np.array_equal(measure.history, np.minimum.accumulate(sound))
    assert np.isinf(measure.history[0])
    assert np.isfinite(measure.history[-1])
    assert np.array_equal(measure.best, control[expected.argmin()])
    assert measure.per_segment == 8
    measure.note(np.array([np.inf, measure.history[-1] / 2]), [1, 2])
    assert measure.made == len(measure.history) == 62
    assert measure.iterations == [61, 62]
    assert measure.history[-1] == measure.history[59] / 2
    drawn_coarsely = Measure(task)
    drawn_coarsely(control[[expected.argmin()]], 4)
    drawn_coarsely(control[:10])
    assert drawn_coarsely.per_segment == 4
    assert np.array_equal(drawn_coarsely.best, control[expected.argmin()])


def test_breaches_say_what_is_wrong_in_metres():
    _, task = campus_task(False)
    closed = np.zeros(task.sky.closed.shape, bool)
    closed[10, 5, 5] = True
    task = Task(
        sky_over(task.sky.price, closed, MAX_TURN, MAX_PITCH),
        task.source,
        task.target,
        False,
        task.breach,
        task.unflyable,
    )
    straight = np.array([(2.5, 5.5, 5.5), (20.5, 5.5, 5.5)])
    assert breaches(task, straight, 5.0) == "flies 5.0 m where it may not"
    assert breaches(task, straight + np.array([0, 2, 0]), 5.0) == ""
    assert breaches(task, np.array([(2.5, 9, 2), (4.5, 9, 9)]), 5.0) == "climbs more than max_pitch"
    assert breaches(task, np.array([(2.5, 9, 2), (4.5, 9, 2), (2.5, 9, 2)]), 5.0) == "turns more than max_turn"
    every = np.array([(2.5, 5.5, 5.5), (12.5, 5.5, 5.5), (12.3, 5.5, 8), (2, 5.5, 8)])
    assert breaches(task, every, 2.0) == (
        "flies 2.0 m where it may not, climbs more than max_pitch, turns more than max_turn"
    )


def test_way_too_low_or_too_high_is_a_breach():
    """A leg that climbs from z = 1 to 5 over 8 voxels; in the columns from x = 4 on it must be 3 high, at most 4.5."""
    sky = sky_over(np.ones((8, 1, 6)), np.zeros((8, 1, 6), bool))
    leg = np.array([[(0, 0.5, 1), (8 - 1e-9, 0.5, 5)]])
    assert costs_of(sky, leg)[1][0] == 0
    lowest, highest = np.full((8, 1, 6), -np.inf), np.full((8, 1), 4.5)
    lowest[4:] = 3.0
    slope = np.sqrt(1 + 0.5**2)
    breach = {n: costs_of(sky._replace(lowest=frozen(low), highest=frozen(high)), leg)[1][0] for n, low, high in (
        ("low", lowest + 0.25, highest + 9), ("exact", lowest, highest + 9), ("high", lowest, highest)
    )}  # fmt: skip
    assert breach["low"] == pytest.approx(slope / 2)  # in the first of them, up to z = 3.25
    assert breach["exact"] == 0
    assert breach["high"] == pytest.approx(slope)  # the last column, from z = 4.5 on
    assert costs_of(sky._replace(highest=frozen(highest - 0.25)), leg)[1][0] == pytest.approx(1.5 * slope)


@pytest.mark.parametrize("seed", range(20))
def test_legs_that_come_too_near_count_their_length(seed):
    """Against samples along each; those whose distance the samples can't tell from what is asked for are left out."""
    rng = np.random.default_rng(seed)
    closed = rng.random((12, 12, 12)) < 0.02
    keep = rng.uniform(0.2, 2.5)
    sky, free = sky_over(np.ones(closed.shape), closed, keep=keep), sky_over(np.ones(closed.shape), closed)
    lines = random_lines(rng, closed.shape, count=60)[:, :2]
    city, told = City(closed), 0
    for line, shut, entered in zip(lines, costs_of(sky, lines)[1], costs_of(free, lines)[1], strict=True):
        least = city.distance(Route(line).resample(0.01).points, 4.0).min()
        length = np.linalg.norm(line[1] - line[0])
        if abs(least - keep) > 0.01:
            told += 1
            assert shut == pytest.approx(length if least < keep else 0.0)
        assert entered <= shut + 1e-9
    assert told > 40


def test_compiled_and_plain_python_agree():
    rng = np.random.default_rng(4)
    sky = random_sky(rng)._replace(max_turn=1.0, max_pitch=0.5, longest=2.0)
    lines = random_lines(rng, sky.closed.shape, beyond=1.0)
    for fast, plain in zip(costs_of(sky, lines), costs_of.py_func(sky, lines), strict=True):
        assert fast == pytest.approx(plain, rel=1e-12)
        assert (fast > 0).all()


@pytest.mark.parametrize("seed", range(6))
def test_the_risk_ahead_of_a_leg_is_that_where_its_wreck_lands(seed):
    """In its own direction, not the nearest of 26."""
    risk_map, rng = random_campus(seed), np.random.default_rng(seed)
    limits = checked_limits(risk_map, MAX_TURN, MAX_PITCH, 0.0, 0.0, np.inf)
    ends = flyable_endpoints(risk_map, *CAMPUS_FLIGHT, limits)
    weights = Weights(2.0, 0.0, 0.0, True)
    sky = task_of(risk_map, ends, price_per_cell(risk_map, weights), weights, limits, False).sky
    ours, theirs = [], []
    for line in random_lines(rng, risk_map.city.shape, 60):
        leg = line[:2]
        index, length = risk_map.city.voxels_along(risk_map.city.origin + leg * risk_map.city.cell)
        theirs.append(2.0 * landing_rate(risk_map.falls, index, leg[1] - leg[0]) @ length / risk_map.city.cell)
        ours.append(costs_of(sky, leg[None])[0][0])
    assert ours == pytest.approx(theirs, rel=1e-9)


def test_a_curve_that_is_too_long_breaks_a_limit_and_says_by_how_much():
    sky = sky_over(np.ones((9, 9, 4)), np.zeros((9, 9, 4), bool), longest=6.0)
    straight, bent = np.array([[(1.0, 1, 1), (4, 1, 1), (7, 1, 1)], [(1.0, 1, 1), (4, 4, 1), (7, 1, 1)]])
    *_, longer = costs_of(sky, np.array([straight, bent]))
    assert longer == pytest.approx([0.0, 6 * 2**0.5 - 6])
    task = Task(sky, straight[0], straight[-1], False, 10.0, 1e4)
    assert task.costs(np.array([straight, bent]), 1)[1] > 1e4
    assert breaches(task, bent, 5.0) == "is 12.4 m longer than max_length"
    assert breaches(task, straight, 5.0) == ""
