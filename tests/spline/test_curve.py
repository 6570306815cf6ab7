"""Curves: curvature against closed forms, all bounds against samples that are much finer."""

import re
import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from uavlab.city import City
from uavlab.route import Route
from uavlab.spline import Curve, allowed_speed, cubic_bspline, curvature
from uavlab.vehicle import GRAVITY

radii = st.floats(0.5, 1e3)
angles = arrays(float, 5, elements=st.floats(-10, 10))
both_ends = pytest.mark.parametrize("ends", ["phantom", "clamped"])
seeds = pytest.mark.parametrize("seed", range(6))


def random_curve(seed, *, ends="phantom", step=0.1, legs=5.0):
    rng = np.random.default_rng(seed)
    return Curve(np.cumsum(rng.normal(0, legs, (rng.integers(3, 9), 3)), axis=0), ends=ends, step=step)


def around(radius, turn=10.0, count=37):
    """Control points on a level circle, `turn` degrees apart."""
    angle = np.radians(turn) * np.arange(count)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), np.full(count, 20.0)], axis=1)


def corner(turn, leg=1.0):
    """Three control points: a leg, a turn of so many degrees to the left, and as long a leg."""
    away = np.radians(turn)
    return leg * np.array([[-1.0, 0.0, 0.0], [0.0, 0.0, 0.0], [np.cos(away), np.sin(away), 0.0]])


def finer(curve, parts=50):
    """Parameters (P − 1, parts + 1) between each two points of a curve, both included."""
    return curve.parameter[:-1, None] + np.diff(curve.parameter)[:, None] * np.linspace(0, 1, parts + 1)


def box_distance(city, points):
    """Distance from points (N, 3) to the nearest occupied box, by looking at all of them."""
    low = city.origin + city.cell * np.argwhere(city.occupied)
    gap = np.maximum(np.maximum(low - points[:, None], points[:, None] - low - city.cell), 0.0)
    return np.linalg.norm(gap, axis=2).min(axis=1)


@given(radii, angles)
def test_on_a_circle_curvature_is_one_over_the_radius(radius, angle):
    velocity = radius * np.stack([-np.sin(angle), np.cos(angle), 0 * angle], axis=1)
    acceleration = -radius * np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    assert curvature(velocity, acceleration) == pytest.approx(np.full(5, 1 / radius), rel=1e-12)
    assert curvature(velocity[:, :2], acceleration[:, :2]) == pytest.approx(np.full(5, 1 / radius), rel=1e-12)


@given(radii, st.floats(-100, 100), angles)
def test_on_a_helix_it_is_less_by_the_climb_but_not_in_the_plan(radius, climb, angle):
    """r(t) = (r cos t, r sin t, c t): κ = r/(r² + c²)."""
    velocity = np.stack([-radius * np.sin(angle), radius * np.cos(angle), np.full(5, climb)], axis=1)
    acceleration = -radius * np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    assert curvature(velocity, acceleration) == pytest.approx(np.full(5, radius / (radius**2 + climb**2)), rel=1e-12)
    assert curvature(velocity[:, :2], acceleration[:, :2]) == pytest.approx(np.full(5, 1 / radius), rel=1e-12)


@given(st.floats(0.05, 20), st.booleans(), st.floats(-20, 20), radii)
def test_curvature_doesn_t_depend_on_how_fast_the_curve_is_passed_nor_on_the_direction(pace, back, gain, radius):
    """With t(u): dr/du = r′ t′, d²r/du² = r″ t′² + r′ t″."""
    angle = np.linspace(0, 6, 7)
    velocity = np.stack([-radius * np.sin(angle), radius * np.cos(angle), np.full(7, 3.0)], axis=1)
    acceleration = -radius * np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    pace = -pace if back else pace
    again = curvature(pace * velocity, pace**2 * acceleration + gain * velocity)
    rounding = 1e-13 * (1 + abs(gain) / pace**2)
    assert again == pytest.approx(curvature(velocity, acceleration), rel=1e-12, abs=rounding)


@given(arrays(float, 3, elements=st.floats(-50, 50)), arrays(float, 3, elements=st.floats(-50, 50)))
def test_curvature_is_the_cross_product_over_the_cubed_speed(velocity, acceleration):
    speed = np.linalg.norm(velocity)
    if speed < 0.1:
        velocity, speed = np.array([3.0, 0.0, 4.0]), 5.0
    expected = np.linalg.norm(np.cross(velocity, acceleration)) / speed**3
    assert float(curvature(velocity, acceleration)) == pytest.approx(expected, rel=1e-9, abs=1e-10 / speed**2)


def test_curvature_is_zero_on_a_straight_line_and_nan_at_rest():
    values = curvature([(3, 4, 0), (3, 4, 0), (0, 0, 0), (0, 0, 1)], [(0, 0, 0), (6, 8, 0), (1, 0, 0), (0, 2, 0)])
    assert values[:2].tolist() == [0, 0]
    assert np.isnan(values[2])
    assert values[3] == 2
    assert curvature((1, 0), (0, 0.5)).shape == ()


@pytest.mark.parametrize(
    ("velocity", "acceleration", "message"),
    [
        ((1, 0, np.nan), (0, 1, 0), "velocity must be finite"),
        ((1, 0, 0), (0, np.inf, 0), "acceleration must be finite"),
        ((1, 0), (0, 1, 0), "all vectors must have as many components"),
        (1.0, 2.0, "velocity must be a vector (east, north) or (east, north, up), got shape ()"),
        ((1, 0, 0, 0), (1, 0, 0, 0), "velocity must be a vector"),
    ],
)
def test_curvature_of_what_is_no_motion_is_refused(velocity, acceleration, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        curvature(velocity, acceleration)


@given(st.floats(1e-3, 10), st.floats(0.05, 1.5))
def test_at_the_allowed_speed_the_bank_holds_the_turn(bend, bank):
    speed = allowed_speed(bend, bank)
    assert speed**2 * bend == pytest.approx(GRAVITY * np.tan(bank), rel=1e-12)


def test_allowed_speed_at_corners_and_on_straight_lines():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert allowed_speed([0.0, np.inf, 1.0]).tolist() == pytest.approx([np.inf, 0, 2.3799], rel=1e-4)


@pytest.mark.parametrize(
    ("bend", "bank", "message"),
    [
        (-0.1, 0.5, "curvature must be at least 0, got -0.1"),
        ([0.1, np.nan], 0.5, "curvature must be at least 0, got nan"),
        (0.1, 30.0, "rad (from degrees: numpy.radians), got 30"),
        (0.1, 0.0, "bank must be from"),
        (0.1, [0.1, 0.2], "bank must be one number"),
        ("sharp", 0.5, "curvature must be a number"),
    ],
)
def test_allowed_speed_refuses_what_is_out_of_range(bend, bank, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        allowed_speed(bend, bank)


@pytest.mark.parametrize("turn", [5.0, 10.0, 30.0])
def test_on_control_points_around_a_circle_curvature_is_near_one_over_the_radius(turn):
    """At the joints κ = 2/(ρ(1 + cos α)) for points on ρ, α apart; the curve itself runs at R = ρ(2 + cos α)/3."""
    curve = Curve(around(50.0, turn), step=0.5)
    joint = np.flatnonzero(curve.parameter == np.round(curve.parameter))[2:-2]
    cosine = np.cos(np.radians(turn))
    assert curve.curvature[joint] == pytest.approx(np.full(len(joint), 2 / (50 * (1 + cosine))), rel=1e-12)
    inner = curve.curvature[joint[0] : joint[-1] + 1]
    assert inner == pytest.approx(np.full(len(inner), 3 / (50 * (2 + cosine))), rel=np.radians(turn) ** 2 / 4)


@pytest.mark.parametrize(("turn", "sharpest"), [(90, 2.828), (60, 1.333), (45, 0.897)])
@pytest.mark.parametrize("leg", [1.0, 7.0])
def test_one_corner_with_equal_legs_is_as_sharp_as_its_angle_says(turn, sharpest, leg):
    """κL = 2 sin(θ/2)/cos²(θ/2), sharpest at the corner: what "below 1 per unit" asks of paths on a grid."""
    curve = Curve(corner(turn, leg), step=leg / 200)
    half = np.radians(turn) / 2
    assert curve.curvature.max() * leg == pytest.approx(2 * np.sin(half) / np.cos(half) ** 2, rel=1e-12)
    assert curve.curvature.max() * leg == pytest.approx(sharpest, abs=5e-4)
    assert curve.parameter[np.argmax(curve.curvature)] == 1


@both_ends
@seeds
def test_no_two_points_are_farther_apart_than_the_step_along_the_curve(seed, ends):
    curve = random_curve(seed, ends=ends)
    arcs = np.linalg.norm(np.diff(curve.at(finer(curve)), axis=1), axis=2).sum(axis=1)
    assert arcs.max() <= curve.step * (1 + 1e-12)
    assert arcs.max() > 0.5 * curve.step  # and not all for nothing


@both_ends
@seeds
def test_the_curve_never_runs_faster_than_the_longest_leg(seed, ends):
    curve = random_curve(seed, ends=ends)
    longest = np.linalg.norm(np.diff(curve.control, axis=0), axis=1).max()
    speed = np.linalg.norm(curve.at(finer(curve), 1), axis=2)
    assert speed.max() <= longest * (1 + 1e-12)


@both_ends
@seeds
def test_distance_adds_up_to_the_length(seed, ends):
    """Chords of at most 0.1 m on turns of metres: shorter by (step·κ)²/24 at the most; measured up to 3e-5."""
    curve = random_curve(seed, ends=ends)
    length = np.linalg.norm(np.diff(curve.at(finer(curve)), axis=1), axis=2).sum()
    assert curve.distance[0] == 0
    assert (np.diff(curve.distance) > 0).all()
    assert curve.distance[-1] == curve.length
    assert length * (1 - 2e-4) < curve.length <= length
    assert len(curve.distance) == len(curve.points) == len(curve.parameter)


@both_ends
@pytest.mark.parametrize("derivative", [0, 1, 2])
def test_at_a_parameter_it_is_the_b_spline(ends, derivative):
    control = random_curve(4).control
    curve = Curve(control, ends=ends)
    expected = cubic_bspline(control, 8, ends=ends, derivative=derivative)
    parameter = np.arange(len(expected)) / 8
    assert curve.at(parameter, derivative) == pytest.approx(expected, rel=0, abs=1e-12)
    assert curve.at(parameter.reshape(1, -1)).shape == (1, len(expected), 3)
    assert curve.at(2.5, derivative) == pytest.approx(expected[20], abs=1e-12)
    assert curve.parameter[-1] == parameter[-1]


@both_ends
@seeds
def test_it_begins_and_ends_on_its_first_and_last_control_point(seed, ends):
    curve = random_curve(seed, ends=ends)
    assert np.array_equal(curve.points[[0, -1]], curve.control[[0, -1]])


@both_ends
@seeds
def test_tangents_are_unit_vectors_along_the_curve(seed, ends):
    curve = random_curve(seed, ends=ends, step=0.02)
    assert np.linalg.norm(curve.tangent, axis=1) == pytest.approx(np.ones(len(curve.points)), rel=1e-12)
    chord = np.diff(curve.points, axis=0)
    chord /= np.linalg.norm(chord, axis=1, keepdims=True)
    middle = curve.tangent[:-1] + curve.tangent[1:]
    middle /= np.linalg.norm(middle, axis=1, keepdims=True)
    apart = np.linalg.norm(chord - middle, axis=1)
    turned = np.maximum(curve.curvature[:-1], curve.curvature[1:]) * 0.02
    assert (apart <= 0.05 * turned + 1e-6).all()  # of a cubic piece between both: none turns by more than a part of κ·a


@seeds
def test_clamped_it_sets_off_and_arrives_along_its_first_and_last_leg(seed):
    curve = random_curve(seed, ends="clamped")
    for end, leg in ((0, curve.control[1] - curve.control[0]), (-1, curve.control[-1] - curve.control[-2])):
        assert curve.at(curve.parameter[end], 1) == pytest.approx(np.zeros(3), abs=1e-12)
        assert curve.tangent[end] == pytest.approx(leg / np.linalg.norm(leg), abs=1e-9)
        assert curve.curvature[end] == 0


@pytest.mark.parametrize(("climb", "degrees"), [(0.0, 0.0), (3.0, 45.0), (-3.0, -45.0), (4.0, 53.1301)])
def test_pitch_is_the_angle_of_climb(climb, degrees):
    curve = Curve([(0, 0, 0), (3, 0, climb), (9, 0, 3 * climb)])
    assert np.degrees(curve.pitch) == pytest.approx(np.full(len(curve.points), degrees), abs=1e-4)
    assert np.degrees(Curve([(0, 0, 0), (0, 0, 5)]).pitch) == pytest.approx(90)


@both_ends
@pytest.mark.parametrize("step", [0.1, 2.0])
@seeds
def test_the_curve_never_leaves_its_chords_by_more_than_the_sagitta(seed, step, ends):
    curve = random_curve(seed, ends=ends, step=step)
    start, chord = curve.points[:-1, None], np.diff(curve.points, axis=0)[:, None]
    away = curve.at(finer(curve)) - start
    along = np.clip((away * chord).sum(axis=2) / (chord**2).sum(axis=2), 0, 1)
    off = np.linalg.norm(away - along[..., None] * chord, axis=2).max(axis=1)
    assert (off <= curve.sagitta * (1 + 1e-9) + 1e-12).all()
    assert (off / curve.sagitta)[curve.sagitta > 1e-6].max() > 0.8  # and the bound is not idle


def test_the_bend_points_to_the_centre_of_the_turn():
    curve = Curve(around(30.0))
    inner = curve.bend[(curve.parameter > 1) & (curve.parameter < 35)]
    points = curve.points[(curve.parameter > 1) & (curve.parameter < 35)]
    inwards = -points * (1, 1, 0)
    inwards /= np.linalg.norm(inwards, axis=1, keepdims=True)
    assert (inner * inwards).sum(axis=1) == pytest.approx(np.full(len(inner), 1 / 30), rel=0.02)
    assert np.linalg.norm(inner, axis=1) == pytest.approx((inner * inwards).sum(axis=1), rel=1e-3)


@seeds
def test_the_bend_is_across_the_curve_and_as_long_as_the_curvature(seed):
    curve = random_curve(seed)
    assert (curve.bend * curve.tangent).sum(axis=1) == pytest.approx(0, abs=1e-12 * curve.curvature.max())
    expected = curvature(curve.at(curve.parameter, 1), curve.at(curve.parameter, 2))
    assert curve.curvature == pytest.approx(expected, rel=1e-9, abs=1e-12)
    assert (curve.level_curvature <= curve.curvature).all()


def test_level_curvature_is_none_in_a_vertical_turn():
    curve = Curve(around(30.0)[:, [0, 2, 1]])
    assert curve.level_curvature[curve.pitch == 0].max(initial=0) < 1e-12
    level = np.abs(curve.pitch) < 0.01
    assert level.any()
    assert curve.level_curvature[level].max() < 0.011 * curve.curvature[level].min()


@pytest.mark.parametrize("times", [3, 4, 5])
@pytest.mark.parametrize(("leg", "place", "step"), [(1.0, 0.0, 0.1), (30.0, 100.0, 0.05), (1000.0, 1e4, 0.05)])
def test_where_a_point_stands_three_times_a_corner_is_infinitely_sharp_and_a_straight_line_straight(
    times, leg, place, step
):
    """Legs of 1 km with points 5 cm apart set off from rest with 2e-11 m: their direction must not come from that."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for turn in (90.0, 3.0, -120.0, 180.0):
            first, middle, last = corner(turn, leg) + place
            curve = Curve([first, *[middle] * times, last], step=step)
            sharp = np.isinf(curve.curvature)
            assert sharp.sum() == 1
            assert curve.points[sharp][0] == pytest.approx(middle, abs=1e-9)
            assert curve.curvature[~sharp].max() < 1e-3
            onward, before = (last - middle) / leg, (middle - first) / leg
            assert np.array_equal(np.sign(curve.bend[sharp][0]), np.sign(np.round(onward - before, 6)))
            assert np.isinf(curve.level_curvature[sharp]).all()
        first, middle, last = corner(0.0, leg) @ np.array([[0.6, 0.64, 0.48]] * 3) + place
        for control in ([first, *[middle] * times, last], [*[first] * times, middle, *[last] * times]):
            straight = Curve(control, step=step)
            assert straight.curvature.max() < 1e-3
            assert straight.length == pytest.approx(2 * leg, rel=1e-9)


def test_a_curve_that_turns_back_has_a_corner_there():
    curve = Curve([(0, 0, 0), (10, 0, 0), (0, 0, 0)])
    assert np.isinf(curve.curvature).sum() == 1
    assert curve.points[np.isinf(curve.curvature)][0] == pytest.approx([10 * 2 / 3, 0, 0])


def test_what_stands_still_has_neither_length_nor_bend():
    curve = Curve(np.full((4, 3), 2.0))
    assert curve.length == pytest.approx(0, abs=1e-14)
    assert not curve.bend.any()
    assert not curve.tangent.any()
    assert curve.points == pytest.approx(np.full(curve.points.shape, 2.0))


@both_ends
@pytest.mark.parametrize("at_most", [0.0, 2.0, np.inf])
@pytest.mark.parametrize("step", [0.1, 1.0])
@pytest.mark.parametrize("seed", range(4))
def test_least_distances_are_below_those_of_every_point_in_between(seed, step, at_most, ends):
    rng = np.random.default_rng(seed)
    city = City(rng.random((14, 14, 14)) < 0.01, cell=1.5, origin=(-10, -10, -10))
    curve = random_curve(seed, ends=ends, step=step, legs=4.0)
    samples = curve.at(finer(curve, 20))
    dense = box_distance(city, samples.reshape(-1, 3)).reshape(samples.shape[:2])
    bound = curve.least_distances(city, at_most)
    assert bound.shape == (len(curve.points) - 1,)
    assert (bound <= dense.min(axis=1) + 1e-12).all()
    if at_most == np.inf:
        apart = np.linalg.norm(np.diff(curve.points, axis=0), axis=1)
        between_samples = apart / 20 + 2 * curve.sagitta  # what the samples miss, and the sagitta twice
        assert (bound >= dense.min(axis=1) - between_samples - 1e-12).all()
        assert curve.clearance(city) <= dense.min()
        assert curve.clearance(city) >= dense.min() - between_samples.max()


@pytest.mark.parametrize("step", [0.01, 0.25, 100.0])
def test_least_distance_of_a_straight_line_past_a_box_is_exact(step):
    occupied = np.zeros((20, 5, 5), bool)
    occupied[10, 0, 0] = True
    curve = Curve([(0.5, 2, 0.5), (10.5, 2, 0.5), (19.5, 2, 0.5)], step=step)
    assert curve.clearance(City(occupied)) == pytest.approx(1, abs=1e-12)
    assert curve.clearance(City(np.zeros((5, 5, 5), bool))) == np.inf


def test_the_sagitta_is_that_across_the_curve_where_it_runs_straight_and_along_it_where_it_turns_back():
    straight = Curve([(0, 0, 0)] * 3 + [(4, 3, 0)] + [(9, 6.75, 0)] * 3, step=0.5)
    assert np.linalg.norm(straight.acceleration, axis=1).max() > 1
    assert straight.sagitta == pytest.approx(0, abs=1e-12)
    back = Curve([(0, 0, 0), (7, 0, 0), (0, 0, 0), (5, 0, 0)], step=1.7)
    start, end = np.minimum(back.points[:-1], back.points[1:]), np.maximum(back.points[:-1], back.points[1:])
    dense = back.at(finer(back))[..., 0]
    over = np.maximum(dense - end[:, :1], start[:, :1] - dense).max(axis=1)
    assert over.max() > 0.01
    assert (over <= back.sagitta + 1e-12).all()


@pytest.mark.parametrize("seed", range(6))
def test_the_rise_is_what_a_curve_leaves_its_chords_up_or_down(seed):
    curve = random_curve(seed, step=2.0)
    share = np.linspace(0, 1, 51)
    chord = curve.points[:-1, None, 2] * (1 - share) + curve.points[1:, None, 2] * share
    off = np.abs(curve.at(finer(curve))[..., 2] - chord).max(axis=1)
    assert (off <= curve.rise + 1e-12).all()
    assert (off / curve.rise)[curve.rise > 1e-6].max() > 0.8


def test_en_route_is_the_curve_between_take_off_and_landing():
    before, way, after = [(0, 0, 0), (0, 0, 2)], [(0, 0, 4), (5, 1, 4), (9, 9, 6)], [(9, 9, 3), (9, 9, 1)]
    control = [*before, way[0], way[0], *way, way[-1], way[-1], *after]
    curve = Curve(control, takeoff=3, landing=3)
    middle = curve.en_route
    assert middle.points[[0, -1]] == pytest.approx(np.array(way)[[0, -1]])
    segments = len(control) - 1
    parameter = np.linspace(0, segments - 6, 200)
    assert middle.at(parameter) == pytest.approx(curve.at(parameter + 3), abs=1e-12)
    assert curve.at(np.linspace(0, 3, 50))[:, :2] == pytest.approx(0, abs=1e-12)
    assert np.isfinite(middle.curvature).all()
    assert np.isinf(curve.curvature.max())  # it hovers at the corner
    assert Curve(way).en_route.control.tolist() == [list(map(float, point)) for point in way]


def test_through_an_obstacle_the_least_distance_is_zero():
    occupied = np.zeros((10, 5, 5), bool)
    occupied[5] = True
    assert Curve([(0.5, 2, 2), (9.5, 2, 2)]).clearance(City(occupied)) == 0


def test_the_curve_as_a_route_is_the_line_through_its_points():
    curve = Curve(around(10.0), planner="round trip")
    route = curve.route()
    assert isinstance(route, Route)
    assert np.array_equal(route.points, curve.points)
    assert route.planner == "round trip"
    assert route.length == pytest.approx(curve.length, rel=1e-12)


def test_it_keeps_its_own_control_points():
    control = around(10.0)
    curve = Curve(control)
    control += 5.0
    assert np.array_equal(curve.control, around(10.0))


def test_it_says_what_it_is():
    assert repr(Curve([(0, 0, 0), (3, 4, 0)], planner="A*")) == "<Curve by A*: 5.0 m, 2 control points>"


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Curve([(0, 0, 0)]), "control must be at least 2 points"),
        (lambda: Curve([(0, 0), (1, 1)]), "control must have shape (N, 3), got (2, 2)"),
        (lambda: Curve(np.zeros((2, 4, 3))), "control must have shape (N, 3), got (2, 4, 3)"),
        (lambda: Curve([(0, 0, 0), (1, np.nan, 1)]), "control must be finite, got nan"),
        (lambda: Curve([(0, 0, 0), (1, 1, 1)], ends="none"), "ends must be one of 'phantom', 'clamped', got 'none'"),
        (lambda: Curve([(0, 0, 0), (1, 1, 1)], step=0), "step must be finite and above 0, got 0"),
        (lambda: Curve([(0, 0, 0), (30, 40, 0)], step=1e-9), "step must be at least 5e-06 m, or a curve of 50 m"),
        (lambda: Curve([(0, 0, 0), (30, 40, 0)]).route(1e-9), "step must be at least 5e-06 m"),
        (lambda: Curve([(0, 0, 0), (1, 1, 1)], planner=3), "planner must be text, got 3"),
        (
            lambda: Curve([(0, 0, 0), (1, 1, 1)], info=[1]),
            "info must be something by name, as in {'A*': ...}",
        ),
        (lambda: Curve([(0, 0, 0), (1, 1, 1)], takeoff=-1), "takeoff must be a whole number of at least 0, got -1"),
        (lambda: Curve([(0, 0, 0), (1, 1, 1)], landing="1"), "landing must be a whole number of at least 0, got '1'"),
        (
            lambda: Curve([(0, 0, 0), (0, 0, 1), (1, 1, 1)], takeoff=1, landing=1),
            "takeoff and landing must leave a segment between 3 control points, got 1 and 1",
        ),
        (lambda: Curve([(0, 0, 0), (1, 1, 1)], max_height="high"), "max_height must be a number"),
        (lambda: Curve([(0, 0, 0), (1, 1, 1)], max_height=-1.0), "max_height must be above min_height"),
        (
            lambda: Curve([(0, 0, 0), (1, 1, 1)]).least_distances(City(np.zeros((2, 2, 2), bool)), None),
            "at_most must be a number",
        ),
        (lambda: Curve([(0, 0, 0), (1, 1, 1)], step=np.inf), "step must be finite and above 0, got inf"),
        (lambda: Curve([(0, 0, 0), (1, 1, 1)]).at(1.01), "parameter must be from 0 to 1 (segments), got 1.01"),
        (lambda: Curve([(0, 0, 0), (1, 1, 1)]).at(-0.1), "parameter must be from 0 to 1 (segments), got -0.1"),
        (lambda: Curve([(0, 0, 0), (1, 1, 1)]).at(np.nan), "parameter must be from 0 to 1 (segments), got nan"),
        (lambda: Curve([(0, 0, 0), (1, 1, 1)]).at(0.5, 3), "derivative must be 0, 1 or 2, got 3"),
        (lambda: Curve([(0, 0, 0), (1, 1, 1)]).at(0.5, -1), "derivative must be 0, 1 or 2, got -1"),
        (lambda: Curve([(0, 0, 0), (1, 1, 1)]).clearance("city"), "city must be a City, got str"),
    ],
)
def test_wrong_curves_and_questions_are_refused(make, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        make()


@settings(max_examples=50)
@given(st.floats(0.2, 50), angles)
def test_twice_as_large_a_curve_bends_half_as_much(scale, turns):
    control = np.cumsum(np.stack([np.cos(turns), np.sin(turns), np.full(5, 0.1)], axis=1), axis=0)
    small, large = Curve(control, step=0.05), Curve(scale * control, step=0.05 * scale)
    moving = small.curvature < 1e3
    if len(small.points) == len(large.points):  # else rounding made one part more
        assert large.curvature[moving] * scale == pytest.approx(small.curvature[moving], rel=1e-6, abs=1e-9)


def test_a_curve_keeps_its_settings_as_plain_numbers_and_texts():
    noted = {"rounds": 1}
    curve = Curve(
        [(0, 0, 0), (0, 0, 9), (9, 9, 9)], np.str_("phantom"), np.float32(0.5), np.str_("A*"), noted, np.uint8(1),
        max_height=np.int8(9),
    )  # fmt: skip
    noted["rounds"] = 2
    kept = curve.ends, curve.step, curve.planner, curve.takeoff, curve.max_height
    assert [*map(type, kept)] == [str, float, str, int, float]
    assert curve.info == {"rounds": 1}
