"""Cubic B-splines: from a list of waypoints to a smooth curve, and whether a UAV can fly it.

A uniform cubic B-spline (RISK-ACO Eqs 18-19, PSO-BAS Eqs 22-25) is continuous up to its second derivative, and a
control point that moves changes only four segments. It doesn't pass through its control points: it cuts corners, so
that a clear route can become one that touches a wall, and `smooth` repairs that. What a UAV can fly is said by
`feasibility`: in 1/m at a speed in m/s, where the papers ask for a curvature "below 1".
"""

from uavlab.spline.basis import basis_functions, bspline, cubic_bspline, fitted, subdivided
from uavlab.spline.curve import Curve, allowed_speed, curvature
from uavlab.spline.limits import Feasibility, Limit, feasibility, greatest_speed, tilted_thrust
from uavlab.spline.smoothing import smooth

__all__ = [
    "Curve",
    "Feasibility",
    "Limit",
    "allowed_speed",
    "basis_functions",
    "bspline",
    "cubic_bspline",
    "curvature",
    "feasibility",
    "fitted",
    "greatest_speed",
    "smooth",
    "subdivided",
    "tilted_thrust",
]
