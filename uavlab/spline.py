"""Uniform cubic B-splines: a smooth curve from a list of points (RISK-ACO Eqs 18-19, PSO-BAS Eqs 22-25)."""

import numpy as np
import numpy.typing as npt

from uavlab import checks

BASIS = np.array([[-1.0, 3.0, -3.0, 1.0], [3.0, -6.0, 3.0, 0.0], [-3.0, 0.0, 3.0, 0.0], [1.0, 4.0, 1.0, 0.0]]) / 6.0
"""From the powers of t (rows: t³, t², t, 1) to the weights of four control points (columns)."""


def cubic_bspline(control: npt.ArrayLike, per_segment: int = 8) -> np.ndarray:
    """Points of the uniform cubic B-spline, from the first control point to the last (RISK-ACO Eq. 19, PSO-BAS Eq. 25).

    S_i(t) = [t³ t² t 1]·M·[P_i … P_i+3]ᵀ/6. Printed is P_0 … P_3 in every segment, which draws only one; and the curve
    misses its ends. With a phantom point 2P_0 − P_1 before the first, and likewise after the last, it passes through
    both.

    Parameters
    ----------
    control : (..., N, D) array
        Control points, N ≥ 2; several curves at once if there are more axes.
    per_segment : int
        Points on each of the N − 1 segments.

    Returns
    -------
    (..., (N − 1)·per_segment + 1, D) array

    Raises
    ------
    ValueError
        If there are fewer than two control points, one is not finite, or `per_segment` is below 1.
    """
    points = checks.numbers("control", control)
    checks.whole("per_segment", per_segment, least=1)
    if points.ndim < 2 or points.shape[-2] < 2:
        raise ValueError(f"control must be at least two points, shape (N, D), got shape {points.shape}")
    checks.finite("control", points)
    before = 2 * points[..., :1, :] - points[..., 1:2, :]
    after = 2 * points[..., -1:, :] - points[..., -2:-1, :]
    padded = np.concatenate([before, points, after], axis=-2)
    t = np.arange(per_segment) / per_segment
    weights = np.stack([t**3, t**2, t, np.ones_like(t)], axis=1) @ BASIS
    segments = points.shape[-2] - 1
    windows = np.stack([padded[..., i : i + segments, :] for i in range(4)], axis=-2)
    curve = (weights @ windows).reshape(*points.shape[:-2], segments * per_segment, points.shape[-1])
    return np.concatenate([curve, points[..., -1:, :]], axis=-2)


def subdivided(control: np.ndarray) -> np.ndarray:
    """Control points (2N − 1, D) of the same curve, twice as dense (Lane and Riesenfeld 1980)."""
    finer = np.empty((2 * len(control) - 1, control.shape[1]))
    finer[0::2] = control
    finer[2:-1:2] = (control[:-2] + 6 * control[1:-1] + control[2:]) / 8
    finer[1::2] = (control[:-1] + control[1:]) / 2
    return finer


def fitted(points: np.ndarray, count: int) -> np.ndarray:
    """`count` control points of the B-spline nearest to a line of points (M, D), by least squares; the ends stay."""
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
