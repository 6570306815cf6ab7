"""The basis of B-splines: against SciPy's, and the laws that every such curve obeys."""

import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.interpolate import BSpline
from scipy.spatial import ConvexHull

from uavlab.spline import basis_functions, bspline, cubic_bspline, fitted, subdivided

AXES = st.integers(1, 3)
FEWEST = {"phantom": 2, "clamped": 2, "none": 4}
gaps = st.lists(st.one_of(st.just(0.0), st.floats(0.1, 3)), min_size=8, max_size=14).filter(lambda gaps: any(gaps[1:]))
shares = arrays(float, 7, elements=st.floats(0, 1))


def control_points(least=2, most=9, dimensions=AXES):
    shape = st.tuples(st.integers(least, most), dimensions)
    return shape.flatmap(lambda size: arrays(float, size, elements=st.floats(-100, 100)))


def held(control, ends):
    """The control points and those that hold the curve to its ends, one by one."""
    first, last = control[0], control[-1]
    if ends == "phantom":
        return np.vstack([2 * first - control[1], control, 2 * last - control[-2]])
    return np.vstack([first, first, control, last, last]) if ends == "clamped" else control


def by_scipy(control, per_segment, ends="phantom", derivative=0):
    """On uniform knots."""
    padded = held(control, ends)
    curve = BSpline(np.arange(len(padded) + 4) - 3.0, padded, 3)
    t = np.arange((len(padded) - 3) * per_segment + 1) / per_segment
    return (curve.derivative(derivative) if derivative else curve)(t)


def length_of(points):
    return np.linalg.norm(np.diff(points, axis=0), axis=1).sum()


def polynomials(control):
    """Coefficients (N − 1, 4, D) of t³ … 1 on each segment, from five of its points."""
    curve, t = cubic_bspline(control, 4), np.linspace(0, 1, 5)
    return np.array([np.polyfit(t, curve[4 * i : 4 * i + 5], 3) for i in range(len(control) - 1)])


@pytest.mark.parametrize("derivative", [0, 1, 2])
@pytest.mark.parametrize("ends", FEWEST)
@given(data=st.data(), per_segment=st.integers(1, 12))
def test_the_curve_and_its_derivatives_are_those_of_scipy(ends, derivative, data, per_segment):
    control = data.draw(control_points(FEWEST[ends]))
    curve = cubic_bspline(control, per_segment, ends=ends, derivative=derivative)
    segments = len(control) + {"phantom": -1, "clamped": 1, "none": -3}[ends]
    assert curve.shape == (segments * per_segment + 1, control.shape[1])
    expected = by_scipy(control, per_segment, ends, derivative)
    assert curve == pytest.approx(expected, rel=0, abs=1e-12 * max(np.abs(control).max(), 1))


def test_without_points_added_the_curve_misses_its_ends():
    control = np.array([[0.0, 0.0], [6.0, 0.0], [6.0, 6.0], [12.0, 6.0], [12.0, 0.0]])
    curve = cubic_bspline(control, ends="none")
    assert curve[0] == pytest.approx((control[0] + 4 * control[1] + control[2]) / 6, abs=1e-14)
    assert curve[-1] == pytest.approx((control[2] + 4 * control[3] + control[4]) / 6, abs=1e-14)


@given(control_points(), st.integers(2, 9))
def test_clamped_the_curve_starts_from_rest_along_the_first_leg(control, per_segment):
    curve, velocity, second = (cubic_bspline(control, per_segment, ends="clamped", derivative=d) for d in range(3))
    assert curve[0] == pytest.approx(control[0], abs=1e-12 * 100)
    assert np.array_equal(curve[-1], control[-1])
    for at_rest in (velocity[[0, -1]], second[[0, -1]]):
        assert at_rest == pytest.approx(np.zeros_like(at_rest), abs=1e-12)
    t = np.arange(per_segment)[:, None] / per_segment
    assert curve[:per_segment] == pytest.approx(control[0] + t**3 / 6 * (control[1] - control[0]), abs=1e-11)


@given(control_points(), st.integers(1, 5))
def test_the_curve_passes_through_both_ends_along_the_first_and_last_leg(control, per_segment):
    curve = cubic_bspline(control, per_segment)
    assert curve[0] == pytest.approx(control[0], abs=1e-12 * 100)
    assert np.array_equal(curve[-1], control[-1])
    first = polynomials(control)[0]
    assert first[-2] == pytest.approx(control[1] - control[0], abs=1e-9)  # the tangent at the start
    assert first[1] == pytest.approx(np.zeros(control.shape[1]), abs=1e-8)  # straight there: no second derivative


@given(st.integers(2, 9), st.integers(1, 6))
def test_points_evenly_on_a_line_give_points_evenly_on_the_line(count, per_segment):
    control = np.linspace((1.0, -2.0, 5.0), (9.0, 4.0, 5.0), count)
    even = np.linspace(control[0], control[-1], (count - 1) * per_segment + 1)
    assert cubic_bspline(control, per_segment) == pytest.approx(even, abs=1e-12)


def test_points_unevenly_on_a_line_give_points_on_the_line():
    along = np.array([0.0, 0.1, 0.15, 0.7, 0.6, 1.0])
    curve = cubic_bspline(along[:, None] * (3.0, 4.0) + (1.0, 2.0), 8)
    assert np.cross((3.0, 4.0, 0.0), np.pad(curve - (1.0, 2.0), ((0, 0), (0, 1)))) == pytest.approx(0, abs=1e-12)


@given(control_points(dimensions=st.just(3)), arrays(float, 3, elements=st.floats(-1e3, 1e3)))
def test_a_moved_and_turned_polygon_gives_the_curve_moved_and_turned(control, shift):
    turn = np.array([[0.6, -0.8, 0.0], [0.8, 0.6, 0.0], [0.0, 0.0, 1.0]])
    assert cubic_bspline(control @ turn + shift) == pytest.approx(cubic_bspline(control) @ turn + shift, abs=1e-9)


def test_weights_are_not_negative_within_and_sum_to_one():
    weights = cubic_bspline(np.eye(7), 20)
    assert weights.sum(axis=1) == pytest.approx(1, abs=1e-14)
    assert (weights[20:-20] >= 0).all()  # the first and the last segment lean on a point outside
    assert (weights[20:-20] > 1e-12).sum(axis=1).max() == 4
    assert weights[60] == pytest.approx([0, 0, 1 / 6, 4 / 6, 1 / 6, 0, 0], abs=1e-14)


@given(st.integers(0, 10_000))
def test_each_segment_lies_within_the_hull_of_its_four_points(seed):
    control = np.random.default_rng(seed).uniform(-1, 1, (7, 2))
    curve = cubic_bspline(control, 10)
    for i in range(1, 5):  # of the inner segments
        hull = ConvexHull(control[i - 1 : i + 3])
        outside = hull.equations[:, :2] @ curve[10 * i : 10 * i + 11].T + hull.equations[:, 2:]
        assert outside.max() < 1e-12


@given(control_points(least=3))
def test_segments_join_with_equal_slope_and_bend(control):
    segments = polynomials(control)
    derivatives = np.array([[1, 1, 1, 1], [3, 2, 1, 0], [6, 2, 0, 0]])  # of t³ t² t 1, at the end of a segment
    ends = np.einsum("kp,spd->skd", derivatives, segments)[:-1]
    starts = (segments[:, [3, 2, 1]] * np.array([1, 1, 2])[:, None])[1:]
    assert ends == pytest.approx(starts, abs=1e-9)


def test_the_third_derivative_jumps_so_the_joints_are_where_they_should_be():
    segments = polynomials(np.array([[0.0, 0.0], [1.0, 2.0], [3.0, -1.0], [4.0, 4.0]]))
    assert np.abs(np.diff(segments[:, 0], axis=0)).min() > 0.1


def test_several_curves_at_once_are_each_alone():
    control = np.random.default_rng(3).uniform(-50, 50, (4, 5, 6, 3))
    curves = cubic_bspline(control, 5)
    assert curves.shape == (4, 5, 26, 3)
    for i in range(4):
        for j in range(5):
            assert curves[i, j] == pytest.approx(cubic_bspline(control[i, j], 5), rel=1e-14)


def test_whole_numbers_and_lists_are_points_too():
    control = [[0, 0], [1, 2], [3, 1]]
    assert np.array_equal(cubic_bspline(control), cubic_bspline(np.array(control, float)))


def test_the_polygon_that_is_given_stays_as_it_was():
    control = np.random.default_rng(0).uniform(size=(5, 3))
    before = control.copy()
    cubic_bspline(control)
    subdivided(control)
    fitted(control, 4)
    assert np.array_equal(control, before)


@pytest.mark.parametrize("per_segment", [2, 4, 8])
@given(control=control_points())
def test_twice_as_many_control_points_draw_the_same_curve(control, per_segment):
    finer = subdivided(control)
    assert finer.shape == (2 * len(control) - 1, control.shape[1])
    same = cubic_bspline(finer, per_segment // 2)
    assert same == pytest.approx(cubic_bspline(control, per_segment), rel=0, abs=1e-12 * max(np.abs(control).max(), 1))


def test_fitted_to_a_circle_twice_as_many_points_come_four_times_as_near():
    """Not sixteen times, as within the curve: its ends are straight. Measured 0.61, 0.15 and 0.038 m of 100 m."""
    angle = np.linspace(0, np.pi, 2000)
    circle = 100 * np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    off = np.array(
        [np.abs(np.linalg.norm(cubic_bspline(fitted(circle, n), 50), axis=1) - 100).max() for n in (9, 17, 33)]
    )
    assert off[0] < 1
    assert off[:-1] / off[1:] == pytest.approx([4, 4], rel=0.1)


@pytest.mark.parametrize("seed", range(5))
def test_fitted_gives_back_the_control_points_of_a_curve_of_even_speed(seed):
    """Where the control points are nearly even, so is the speed: then the curve's parameter is its length."""
    rng = np.random.default_rng(seed)
    control = np.linspace((0, 0, 10), (100, 40, 20), 8) + rng.normal(0, 0.5, (8, 3))
    points = cubic_bspline(control, 100)
    again = fitted(points, 8)
    assert np.array_equal(again[[0, -1]], points[[0, -1]])
    apart = np.linalg.norm(cubic_bspline(again, 100)[:, None] - points[None], axis=2).min(axis=1)
    assert apart.max() < 0.15  # of legs of 15 m; measured 0.08


def test_fitted_is_the_least_of_squares_with_both_ends_held():
    """Moving any inner point, either way, leaves a larger sum of squares to the points evenly along the line."""
    corners = np.array([[0.0, 0.0], [30.0, 0.0], [30.0, 40.0], [60.0, 50.0]])
    control = fitted(corners, 7)
    legs = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(corners, axis=0), axis=1))])
    even = np.stack([np.interp(np.linspace(0, legs[-1], 49), legs, axis) for axis in corners.T], axis=1)

    def squares(points):
        return ((cubic_bspline(points, 8) - even) ** 2).sum()

    for point in range(1, 6):
        for axis in range(2):
            for step in (-0.01, 0.01):
                moved = control.copy()
                moved[point, axis] += step
                assert squares(moved) > squares(control)


@pytest.mark.parametrize("count", [2, 3, 7])
def test_fitted_to_a_straight_line_is_that_line(count):
    line = np.array([[1.0, 2.0, 3.0], [2.0, 4.0, 3.5], [9.0, 18.0, 7.0]])  # corners that lie unevenly on it
    control = fitted(line, count)
    assert control == pytest.approx(np.linspace(line[0], line[-1], count), abs=1e-12)


def test_fitted_to_points_that_stand_still_stays_there():
    assert fitted(np.full((3, 3), 7.0), 5) == pytest.approx(np.full((5, 3), 7.0), abs=1e-12)
    twice = np.repeat([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0]], 2, axis=0)
    assert fitted(twice, 6) == pytest.approx(fitted(twice[::2], 6), abs=1e-12)


@pytest.mark.parametrize(
    ("control", "message"),
    [
        ([[0, 0, 0]], "control must be at least 2 points, shape (..., N, D), as a cubic segment takes four; ends="),
        ([0, 1, 2], "got shape (3,)"),
        (np.zeros((4, 1, 3)), "got shape (4, 1, 3)"),
        ([[0, 0], [np.nan, 0]], "control must be finite, got nan"),
        ([[0, 0], [0, np.inf]], "control must be finite, got inf"),
        ([["a", "b"], ["c", "d"]], "control must be a number or an array of numbers"),
        ([[0, 0], [1]], "control must be a number or an array of numbers"),
    ],
)
def test_wrong_control_points_are_refused(control, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        cubic_bspline(control)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: subdivided([(0, 0)]), "control must be at least 2 points"),
        (lambda: subdivided([0, 1, 2]), "control must have shape (N, M), got (3,)"),
        (lambda: subdivided([(0, 0), (1, np.nan)]), "control must be finite, got nan"),
        (lambda: subdivided("much"), "control must be a number or an array of numbers: got text"),
        (lambda: fitted([(0, 0)], 4), "points must be at least 2, joined by a line, got 1"),
        (lambda: fitted([0, 1, 2], 4), "points must have shape (N, M), got (3,)"),
        (lambda: fitted([(0, 0), (1, np.inf)], 4), "points must be finite, got inf"),
        (lambda: fitted([(0, 0), (1, 1)], 1), "count must be a whole number of at least 2, got 1"),
        (lambda: fitted([(0, 0), (1, 1)], 4.0), "count must be a whole number of at least 2, got 4.0"),
        (lambda: fitted([(0, 0), (1, 1)], 10**5), "count must be at most 10,000"),
        (lambda: cubic_bspline([(0, 0), (1, 1)], 10**7), "per_segment must be at most 1,000,000"),
    ],
)
def test_what_makes_no_line_is_refused(call, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        call()


@pytest.mark.parametrize("per_segment", [0, -1, 2.0])
def test_a_wrong_number_of_points_per_segment_is_refused(per_segment):
    with pytest.raises(ValueError, match=f"per_segment must be a whole number of at least 1, got {per_segment}"):
        cubic_bspline([[0, 0], [1, 1]], per_segment)


@pytest.mark.parametrize("ends", ["phantom", "clamped", "none"])
def test_too_few_control_points_are_refused_with_the_number_that_it_takes(ends):
    least = FEWEST[ends]
    with pytest.raises(ValueError, match=f"control must be at least {least} points, .* a cubic segment takes four"):
        cubic_bspline(np.zeros((least - 1, 3)), ends=ends)
    assert cubic_bspline(np.zeros((least, 3)), 1, ends=ends).shape == ({"clamped": 4}.get(ends, 2), 3)


@pytest.mark.parametrize("ends", ["open", None, 3, ("phantom",)])
def test_unknown_ends_are_refused(ends):
    with pytest.raises(ValueError, match=r"ends must be one of 'phantom', 'clamped', 'none', got "):
        cubic_bspline(np.zeros((4, 2)), ends=ends)


@pytest.mark.parametrize("derivative", [3, -1, 1.0, True, "1", None, np.array([0, 1])])
def test_unknown_derivatives_are_refused(derivative):
    with pytest.raises(ValueError, match=re.escape(f"derivative must be 0, 1 or 2, got {derivative!r}")):
        cubic_bspline(np.zeros((4, 2)), derivative=derivative)


def longer(knots, degree):
    """Knots with more around, so that SciPy, which wants degree + 1 functions everywhere, knows these as well."""
    around = np.arange(1, degree + 1)
    return np.concatenate([knots[0] - around[::-1], knots, knots[-1] + around])


@pytest.mark.parametrize("degree", range(6))
@given(gaps=gaps, shares=shares)
def test_basis_functions_are_those_of_scipy_on_any_knots(degree, gaps, shares):
    knots = np.cumsum(gaps)
    t = np.concatenate([knots[0] + shares * (knots[-1] - knots[0]), knots])
    t = t[t < knots[-1]]
    count = len(knots) - degree - 1
    assert np.array_equal(basis_functions(t, knots, degree).shape, (len(t), count))
    more = longer(knots, degree)
    expected = BSpline(more, np.eye(len(more) - degree - 1), degree)(t)[:, degree : degree + count]
    assert basis_functions(t, knots, degree) == pytest.approx(expected, rel=0, abs=1e-12)


@pytest.mark.parametrize("degree", range(6))
@given(inner=st.lists(st.floats(0.1, 3), min_size=1, max_size=6), shares=shares)
def test_basis_functions_are_scipy_s_design_matrix_up_to_the_last_knot(degree, inner, shares):
    rise = np.concatenate([[0.0], np.cumsum(inner)])
    knots = np.concatenate([np.zeros(degree), rise, np.full(degree, rise[-1])])
    t = np.concatenate([shares * rise[-1], rise])
    expected = BSpline.design_matrix(t, knots, degree).toarray()
    assert basis_functions(t, knots, degree) == pytest.approx(expected, rel=0, abs=1e-12)


@pytest.mark.parametrize("degree", range(6))
@given(gaps=gaps, shares=shares)
def test_basis_functions_sum_to_one_where_all_overlap_and_to_less_beyond(degree, gaps, shares):
    knots = np.cumsum(gaps)
    low, high = knots[degree], knots[-degree - 1]
    t = np.minimum(knots[0] + shares * (knots[-1] - knots[0]), knots[-1])
    values = basis_functions(t, knots, degree)
    whole = (low <= t) & (t < high)
    assert (values > -1e-15).all()
    assert values.sum(axis=1)[whole] == pytest.approx(np.ones(whole.sum()), abs=1e-12)
    assert (values.sum(axis=1) <= 1 + 1e-12).all()


@pytest.mark.parametrize("degree", range(6))
def test_the_last_point_belongs_to_the_last_basis_function(degree):
    knots = np.concatenate([np.zeros(degree), np.arange(4.0), np.full(degree, 3.0)])
    values = basis_functions(3.0, knots, degree)
    assert values.tolist() == [[0.0] * (degree + 2) + [1.0]]
    if degree == 0:
        knots = np.array([0.0, 1.0, 2.0, 2.0])  # an interval without length is nobody's
        assert basis_functions([1.5, 2.0], knots, 0).tolist() == [[0, 1, 0], [0, 1, 0]]


@pytest.mark.parametrize("degree", range(6))
def test_as_printed_the_basis_functions_sum_to_two_at_inner_knots_whatever_the_degree(degree):
    """The recursion hands the sum on: what degree 0 counts twice, the curve counts twice."""
    knots = np.concatenate([np.zeros(degree), np.arange(6.0), np.full(degree, 5.0)])
    t = np.array([0.0, 0.5, 1.0, 2.0, 2.3, 3.0, 4.0, 4.999, 5.0])
    sums = basis_functions(t, knots, degree, as_printed=True).sum(axis=1)
    assert sums == pytest.approx([1, 1, 2, 2, 1, 2, 2, 1, 1], abs=1e-12)
    control = np.random.default_rng(degree).uniform(-1, 1, (degree + 5, 2))
    right = basis_functions(t, knots, degree) @ control
    drawn = basis_functions(t, knots, degree, as_printed=True) @ control
    between = t != np.round(t)
    assert drawn[between] == pytest.approx(right[between], abs=1e-14)
    if degree:
        assert drawn[[2, 3, 5, 6]] == pytest.approx(2 * right[[2, 3, 5, 6]], abs=1e-12)


@given(control_points(least=4), st.integers(1, 6))
def test_the_recursion_draws_the_curve_of_the_matrix(control, per_segment):
    segments = len(control) - 3
    t = np.arange(segments * per_segment + 1) / per_segment
    by_recursion = basis_functions(t, np.arange(len(control) + 4) - 3.0, 3) @ control
    by_matrix = cubic_bspline(control, per_segment, ends="none")
    assert by_recursion == pytest.approx(by_matrix, rel=0, abs=1e-12 * max(np.abs(control).max(), 1))


@pytest.mark.parametrize("degree", range(1, 6))
@given(data=st.data(), t=shares)
def test_a_curve_of_any_degree_is_scipy_s_on_clamped_knots(degree, data, t):
    control = data.draw(control_points(degree + 1, degree + 7))
    t = np.concatenate([t, [0.0, 1.0]])
    knots = np.concatenate([np.zeros(degree), np.linspace(0, 1, len(control) - degree + 1), np.ones(degree)])
    size = max(np.abs(control).max(), 1)
    curve = bspline(control, t, degree)
    assert curve == pytest.approx(BSpline(knots, control, degree)(t), rel=0, abs=1e-12 * size)
    assert curve[-2:] == pytest.approx(control[[0, -1]], rel=0, abs=1e-12 * size)


@given(control_points(), shares)
def test_degree_one_is_the_polyline(control, t):
    even = np.linspace(0, 1, len(control))
    polyline = np.stack([np.interp(t, even, axis) for axis in control.T], axis=1)
    assert bspline(control, t, 1) == pytest.approx(polyline, rel=0, abs=1e-12 * 100)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: basis_functions(0.5, [0, 1, 0.5, 2, 3], 3), "knots must be at least 5 numbers that rise"),
        (lambda: basis_functions(0.5, [0, 1, 2, 3], 3), "knots must be at least 5 numbers that rise"),
        (lambda: basis_functions(0.5, np.ones(8), 3), "some of them may be equal; got array([1."),
        (lambda: basis_functions(0.5, np.ones((2, 8)), 3), "knots must be at least 5 numbers"),
        (lambda: basis_functions(0.5, [0, 1, np.nan, 3, 4], 3), "knots must be finite, got nan"),
        (lambda: basis_functions([0.5, 4.1], np.arange(5), 3), "t must be from 0 to 4 (the knots), got 4.1"),
        (lambda: basis_functions(-0.1, np.arange(5), 3), "t must be from 0 to 4 (the knots), got -0.1"),
        (lambda: basis_functions(np.nan, np.arange(5), 3), "t must be from 0 to 4 (the knots), got nan"),
        (lambda: basis_functions([[1.0, 2.0]], np.arange(5), 3), "t must have shape (N,), got (1, 2)"),
        (lambda: basis_functions(1, np.arange(5), -1), "degree must be a whole number of at least 0, got -1"),
        (lambda: basis_functions(1, np.arange(5), 1.5), "degree must be a whole number of at least 0, got 1.5"),
        (
            lambda: bspline(np.zeros((3, 2)), 0.5),
            "control must be more than 3 points of shape (N, D), got shape (3, 2)",
        ),
        (lambda: bspline(np.zeros((2, 5, 2)), 0.5, 1), "shape (N, D), got shape (2, 5, 2)"),
        (lambda: bspline([[0, 0], [np.nan, 1]], 0.5, 1), "control must be finite, got nan"),
        (lambda: bspline(np.zeros((4, 2)), 1.01), "t must be from 0 to 1 (the knots), got 1.01"),
        (lambda: bspline(np.zeros((4, 2)), 0.5, 0), "degree must be a whole number of at least 1, got 0"),
    ],
)
def test_wrong_knots_parameters_and_degrees_are_refused(call, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        call()
