"""Uniform cubic B-splines by their matrix form, and B-splines of any degree by the recursion of their basis."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.spline.sampling import BASIS, FACTORS, POWERS, mirrored

ENDS = ("phantom", "clamped", "none")

MOST_PER_SEGMENT, MOST_FITTED = 10**6, 10**4
"""Points on a segment, control points of a fit: more take all of the memory."""


def cubic_bspline(
    control: npt.ArrayLike, per_segment: int = 8, *, ends: str = "phantom", derivative: int = 0
) -> np.ndarray:
    """Points of the uniform cubic B-spline, or derivatives there (RISK-ACO Eq. 19, PSO-BAS Eq. 25).

    S_i(t) = [t³ t² t 1]·M·[P_i … P_i+3]ᵀ/6, 0 ≤ t ≤ 1. Printed is P_0 … P_3 in every segment, which draws only one.
    And as the papers have it, with ends="none", the curve misses its ends: it begins at (P_0 + 4P_1 + P_2)/6.

    Parameters
    ----------
    control : (..., N, D) array
        Control points; several curves at once if there are more axes.
    per_segment : int
        Points on each segment, at most a million.
    ends : {"phantom", "clamped", "none"}
        "phantom": a point 2P_0 − P_1 before the first, and likewise after the last; the curve passes through both,
        unbent; N ≥ 2, N − 1 segments. "clamped": each end stands three times; the curve passes through both, its
        parameter starts from rest; N ≥ 2, N + 1 segments. "none": N ≥ 4, N − 3 segments.
    derivative : {0, 1, 2}
        With respect to t, one per segment.

    Returns
    -------
    (..., segments·per_segment + 1, D) array
        Points, in the unit of the control points; or derivatives there, per segment.

    Raises
    ------
    ValueError
        If `control` has too few points for `ends`, another shape than (..., N, D), or a value that is not finite. If
        `per_segment` is below 1 or above a million. If `ends` is unknown. If `derivative` is not 0, 1 or 2.

    See Also
    --------
    Curve : The same curve in 3D, with its length, curvature and clearance.
    bspline : Of any degree.
    subdivided : The same curve from more control points.

    Examples
    --------
    >>> from uavlab.spline import cubic_bspline
    >>> corner = [(10, 10), (20, 10), (20, 20)]
    >>> cubic_bspline(corner, per_segment=2).round(2)  # through both ends, past the corner
    array([[10.  , 10.  ],
           [14.79, 10.21],
           [18.33, 11.67],
           [19.79, 15.21],
           [20.  , 20.  ]])
    """
    points = checks.numbers("control", control)
    per_segment = checks.whole("per_segment", per_segment, 1, MOST_PER_SEGMENT)
    checks.one_of("ends", ends, ENDS)
    derivative = checked_derivative(derivative)
    checked_count(points, ends)
    checks.finite("control", points)
    padded = with_ends(points, ends)
    segments = padded.shape[-2] - 3
    t = (np.arange(per_segment) / per_segment)[:, None]
    windows = np.stack([padded[..., i : i + segments, :] for i in range(4)], axis=-2)
    weights = FACTORS[derivative] * t ** POWERS[derivative] @ BASIS
    curve = (weights @ windows).reshape(*points.shape[:-2], segments * per_segment, points.shape[-1])
    if derivative == 0 and ends != "none":
        last = points[..., -1:, :]  # without rounding
    else:
        last = (FACTORS[derivative] @ BASIS @ windows[..., -1, :, :])[..., None, :]
    return np.concatenate([curve, last], axis=-2)


def checked_derivative(derivative: int) -> int:
    if isinstance(derivative, bool) or not isinstance(derivative, int | np.integer) or derivative not in (0, 1, 2):
        raise ValueError(f"derivative must be 0, 1 or 2, got {derivative!r}")
    return int(derivative)


def checked_count(points: np.ndarray, ends: str) -> None:
    """`ValueError` if there are too few control points for one segment, which takes four."""
    least, added = (4, "") if ends == "none" else (2, f"; ends={ends!r} adds the others")
    if points.ndim < 2 or points.shape[-2] < least:
        raise ValueError(
            f"control must be at least {least} points, shape (..., N, D), as a cubic segment takes four{added}; "
            f"got shape {points.shape}"
        )


def with_ends(points: np.ndarray, ends: str) -> np.ndarray:
    """Control points with those that hold the curve to its ends."""
    first, last = points[..., :1, :], points[..., -1:, :]
    if ends == "phantom":
        phantoms = mirrored(first, points[..., 1:2, :]), mirrored(last, points[..., -2:-1, :])
        return np.concatenate([phantoms[0], points, phantoms[1]], axis=-2)
    if ends == "clamped":
        return np.concatenate([first, first, points, last, last], axis=-2)
    return points


def basis_functions(t: npt.ArrayLike, knots: npt.ArrayLike, degree: int = 3, *, as_printed: bool = False) -> np.ndarray:
    """All B-spline basis functions of a degree, by the recursion of Cox and de Boor (PSO-BAS Eqs 23-24).

    B_i,0(t) = 1 where u_i ≤ t < u_i+1, else 0;
    B_i,p(t) = (t − u_i)/(u_i+p − u_i) B_i,p−1(t) + (u_i+p+1 − t)/(u_i+p+1 − u_i+1) B_i+1,p−1(t).

    Parameters
    ----------
    t : float or (T,) array
        Parameters, within the knots.
    knots : (K,) array
        Not falling; K − degree − 1 basis functions.
    degree : int
        p, at least 0; the curve then has order p + 1. The papers call B_{i,n} "of order n and degree n − 1", but
        their recursion makes degree n.
    as_printed : bool
        Intervals closed on both sides (Eq. 23): at a knot two of them count, and the functions add up to 2.

    Returns
    -------
    (T, K − degree − 1) array
        Each row adds up to 1 where degree + 1 functions overlap; the last interval is closed, so the end belongs to it.

    Raises
    ------
    ValueError
        If `knots` fall, are all equal, not finite or fewer than degree + 2. If `t` lies beyond the knots, or has more
        than one axis. If `degree` is negative. If `as_printed` is neither True nor False.

    See Also
    --------
    bspline : The curve that they weigh the control points for.
    cubic_bspline : Without the recursion, for even knots.

    References
    ----------
    - Cox, The numerical evaluation of B-splines, 1972.
    - De Boor, On calculating with B-splines, 1972.

    Examples
    --------
    >>> from uavlab.spline import basis_functions
    >>> weights = basis_functions([3.0, 3.5], knots=range(8), degree=3)
    >>> weights.round(3)
    array([[0.167, 0.667, 0.167, 0.   ],
           [0.021, 0.479, 0.479, 0.021]])
    >>> weights.sum(axis=1).round(3)
    array([1., 1.])
    """
    t, knots = np.atleast_1d(checks.numbers("t", t)), checks.numbers("knots", knots)
    degree, as_printed = checks.whole("degree", degree, least=0), checks.flag("as_printed", as_printed)
    checks.finite("knots", knots)
    if knots.ndim != 1 or len(knots) < degree + 2 or (np.diff(knots) < 0).any() or knots[0] == knots[-1]:
        raise ValueError(
            f"knots must be at least {degree + 2} numbers that rise, some of them may be equal; got {knots!r:.80}"
        )
    checks.within("t", t, knots[0], knots[-1], "(the knots)")
    t = checks.array("t", t, None)[:, None]
    low, high = knots[:-1], knots[1:]
    inside = (t >= low) & (t <= high) if as_printed else (t >= low) & (t < high)
    if not as_printed:
        last = np.flatnonzero(high > low)[-1]
        inside[:, last] |= t[:, 0] == high[last]
    values = (inside & (high > low)).astype(float)
    for n in range(1, degree + 1):
        rise, fall = knots[n:-1] - knots[: -n - 1], knots[n + 1 :] - knots[1:-n]
        up = np.divide(t - knots[: -n - 1], rise, out=np.zeros((len(t), len(rise))), where=rise > 0)
        down = np.divide(knots[n + 1 :] - t, fall, out=np.zeros((len(t), len(fall))), where=fall > 0)
        values = up * values[:, :-1] + down * values[:, 1:]
    return values


def bspline(control: npt.ArrayLike, t: npt.ArrayLike, degree: int = 3) -> np.ndarray:
    """A clamped uniform B-spline of any degree at parameters t from 0 to 1 (PSO-BAS Eq. 22).

    Its knots are even, but for the first and the last, which stand degree + 1 times: it passes through both ends.

    S(t) = Σ B_i,p(t) P_i, with the basis functions of `basis_functions`.

    Parameters
    ----------
    control : (N, D) array
        N > degree.
    t : float or (T,) array
        From 0 to 1.
    degree : int
        At least 1, the polyline.

    Returns
    -------
    (T, D) array

    Raises
    ------
    ValueError
        If `control` has not more than `degree` points, another shape than (N, D), or a value that is not finite. If `t`
        is not from 0 to 1, or has more than one axis. If `degree` is below 1.

    See Also
    --------
    cubic_bspline : Of degree 3 with even knots.
    basis_functions : Its weights of the control points.

    Examples
    --------
    >>> from uavlab.spline import bspline
    >>> control = [(10, 10), (20, 30), (30, 10)]
    >>> bspline(control, [0, 0.5, 1], degree=1).round(1)  # the polyline
    array([[10., 10.],
           [20., 30.],
           [30., 10.]])
    >>> bspline(control, [0, 0.5, 1], degree=2).round(1)  # half as high
    array([[10., 10.],
           [20., 20.],
           [30., 10.]])
    """
    points = checks.numbers("control", control)
    degree = checks.whole("degree", degree, least=1)
    checks.finite("control", points)
    if points.ndim != 2 or len(points) <= degree:
        raise ValueError(f"control must be more than {degree} points of shape (N, D), got shape {points.shape}")
    inner = np.linspace(0.0, 1.0, len(points) - degree + 1)
    knots = np.concatenate([np.zeros(degree), inner, np.ones(degree)])
    return basis_functions(t, knots, degree) @ points


def subdivided(control: npt.ArrayLike) -> np.ndarray:
    """Control points of the same curve, twice as dense, by Lane and Riesenfeld's rule.

    Q_2i = (P_i−1 + 6 P_i + P_i+1)/8, Q_2i+1 = (P_i + P_i+1)/2; the ends stay.

    Parameters
    ----------
    control : (N, D) array
        Control points of a cubic B-spline with ends="phantom", N ≥ 2.

    Returns
    -------
    (2N − 1, D) array

    Raises
    ------
    ValueError
        If `control` has fewer than two points, another shape than (N, D), or a value that is not finite.

    See Also
    --------
    cubic_bspline : The curve.
    fitted : As many control points as one wants, of a curve near a line of points.

    References
    ----------
    Lane and Riesenfeld, A theoretical development for the computer generation and display of piecewise polynomial
    surfaces, 1980.

    Examples
    --------
    >>> import numpy as np
    >>> from uavlab.spline import cubic_bspline, subdivided
    >>> control = [(10, 10), (20, 10), (20, 20)]
    >>> finer = subdivided(control)
    >>> np.allclose(cubic_bspline(finer, per_segment=4), cubic_bspline(control, per_segment=8))
    True
    """
    control = checks.array("control", control, None, None)
    checked_count(control, "phantom")
    finer = np.empty((2 * len(control) - 1, control.shape[1]))
    finer[0::2] = control
    finer[2:-1:2] = (control[:-2] + 6 * control[1:-1] + control[2:]) / 8
    finer[1::2] = (control[:-1] + control[1:]) / 2
    return finer


def fitted(points: npt.ArrayLike, count: int) -> np.ndarray:
    """Control points of the B-spline nearest to a line of points, by least squares; the ends stay.

    min Σ |S(t_j) − p_j|² over the inner control points, the p_j at even distances along the line.

    Parameters
    ----------
    points : (M, D) array
        Joined by straight lines; M ≥ 2.
    count : int
        How many control points, from 2 to 10,000.

    Returns
    -------
    (count, D) array
        For ends="phantom".

    Raises
    ------
    ValueError
        If `points` are fewer than two, have another shape than (M, D), or a value that is not finite. If `count` is
        below 2 or above 10,000.

    See Also
    --------
    cubic_bspline : The curve.
    subdivided : The same curve from twice as many control points.

    Examples
    --------
    >>> import numpy as np
    >>> from uavlab.spline import cubic_bspline, fitted
    >>> angle = np.linspace(0, np.pi, 50)
    >>> control = fitted(100 * np.stack([np.cos(angle), np.sin(angle)], axis=1), 9)
    >>> off = np.linalg.norm(cubic_bspline(control), axis=1) - 100
    >>> bool(np.abs(off).max() < 2)  # nine points for half a circle of 100 m
    True
    """
    points, count = checks.array("points", points, None, None), checks.whole("count", count, 2, MOST_FITTED)
    if len(points) < 2:
        raise ValueError(f"points must be at least 2, joined by a line, got {len(points)}")
    wanted = spread(points, 8 * (count - 1) + 1)
    basis = cubic_bspline(np.eye(count), per_segment=8)
    rest = wanted - basis[:, [0, -1]] @ points[[0, -1]]
    inner = np.linalg.lstsq(basis[:, 1:-1], rest, rcond=None)[0]
    return np.vstack([points[:1], inner, points[-1:]])


def spread(points: np.ndarray, count: int) -> np.ndarray:
    """`count` points at even distances along a line of points (M, D), from its first to its last."""
    distance = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    along = np.linspace(0.0, 1.0, count)
    return np.stack([np.interp(along * distance[-1], distance, axis) for axis in points.T], axis=1)
