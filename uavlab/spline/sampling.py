"""Cubic B-splines point by point, for compiled code: where to look, what is there, how far a line misses it."""

from __future__ import annotations

import math

import numpy as np

from uavlab.compiled import compilable, compiled
from uavlab.vehicle import GRAVITY

BASIS = np.array([[-1.0, 3.0, -3.0, 1.0], [3.0, -6.0, 3.0, 0.0], [-3.0, 0.0, 3.0, 0.0], [1.0, 4.0, 1.0, 0.0]]) / 6.0
"""From the powers of t (rows: t³, t², t, 1) to the weights of four control points (columns)."""

POWERS = np.array([[3, 2, 1, 0], [2, 1, 0, 0], [1, 0, 0, 0]])
FACTORS = np.array([[1, 1, 1, 1], [3, 2, 1, 0], [6, 2, 0, 0]])
"""Of t³, t², t, 1 and of their first and second derivatives."""

AT_REST = 1e-9
"""A curve that runs fewer metres than this per segment stands still."""

CORNER = 1e-4
"""Where it stands still and its direction changes by more than this [rad], it has a corner; less is rounding."""

UNRESOLVED = 0.5
"""A change of direction between two points [rad] in which the curvature of neither may be the greatest."""


@compilable
def speed_in_turn(curvature, bank):
    """`allowed_speed` of arguments that are right."""
    return np.sqrt(GRAVITY * np.tan(bank) / curvature)


@compilable
def mirrored(end, inner):
    """The phantom point beyond an end, 2P_0 − P_1."""
    return 2 * end - inner


@compiled
def steps_on(padded, step):
    """Parameters (P,) from 0 to the number of segments, so close that no two points are more than a step [m] apart.

    A segment's derivative is a mean of three legs of the polygon (N + 2, 3), so it is never faster than the longest.
    """
    legs = np.empty(len(padded) - 1)
    for n in range(len(legs)):
        legs[n] = length(padded[n + 1] - padded[n])
    parts = np.empty(len(legs) - 2, np.int64)
    for segment in range(len(parts)):
        fastest = max(legs[segment], legs[segment + 1], legs[segment + 2])
        parts[segment] = max(math.ceil(fastest / step), 1)
    parameter = np.empty(parts.sum() + 1)
    count = 0
    for segment in range(len(parts)):
        for n in range(parts[segment]):
            parameter[count] = segment + n / parts[segment]
            count += 1
    parameter[count] = len(parts)
    return parameter


@compiled
def points_at(padded, parameter, derivative):
    """Points (P, 3) of the curve at parameters (P,), or derivatives there, per segment; see `Curve.at`."""
    points = np.zeros((len(parameter), padded.shape[1]))
    weights = np.empty(4)
    for m in range(len(parameter)):
        segment = min(int(parameter[m]), len(padded) - 4)
        weights[:] = 0.0
        t = parameter[m] - segment
        powers = t * t * t, t * t, t, 1.0
        for row in range(4 - derivative):
            power = FACTORS[derivative, row] * powers[row + derivative]
            for n in range(4):
                weights[n] += power * BASIS[row, n]
        falling = 0.0
        for n in range(4 if derivative == 0 else 3):
            falling -= weights[n]
            for a in range(padded.shape[1]):
                if derivative == 0:
                    points[m, a] += weights[n] * padded[segment + n, a]
                else:  # of the legs, so that where points stand together they add exactly nothing
                    points[m, a] += falling * (padded[segment + n + 1, a] - padded[segment + n, a])
    return points


@compiled
def sagittas(points, velocity, acceleration, parameter):
    """How far the curve can be from the straight lines between its points, (P − 1,) [m]; see `Curve.sagitta`."""
    most = np.empty(len(points) - 1)
    for n in range(len(most)):
        line = points[n + 1] - points[n]
        along = line / max(length(line), AT_REST)
        onward = min((velocity[n] * along).sum(), (velocity[n + 1] * along).sum()) >= -AT_REST
        faster, later = (acceleration[n] * along).sum(), (acceleration[n + 1] * along).sum()
        onward = onward and (faster >= 0 or later <= 0)
        size = length(acceleration[n] - (faster if onward else 0.0) * along)
        size = max(size, length(acceleration[n + 1] - (later if onward else 0.0) * along))
        most[n] = size * (parameter[n + 1] - parameter[n]) ** 2 / 8
    return most


@compiled
def curvature_vectors(velocity, acceleration):
    """What of r″ is across r′, over |r′|², towards the inside of a turn (P, 3); NaN where r′ stands still."""
    bends = np.full(velocity.shape, np.nan)
    for n in range(len(bends)):
        speed = length(velocity[n])
        if speed > AT_REST:
            tangent = velocity[n] / speed
            bends[n] = (acceleration[n] - (acceleration[n] * tangent).sum() * tangent) / speed**2
    return bends


@compiled
def tangents_of(velocity):
    """Unit vectors along the curve (P, 3); see `Curve.tangent`."""
    tangents, there = np.zeros(velocity.shape), -1
    for n in range(len(velocity)):
        if length(velocity[n]) > AT_REST:
            there = n
    for n in range(len(velocity) - 1, -1, -1):
        if length(velocity[n]) > AT_REST:
            there = n
        if there >= 0:
            tangents[n] = velocity[there] / length(velocity[there])
    return tangents


@compiled
def bends_at(points, velocity, acceleration):
    """Curvature vectors at each point (P, 3) [1/m]; see `Curve.bend`."""
    bends, tangents = curvature_vectors(velocity, acceleration), tangents_of(velocity)
    flown = 0.0
    for n in range(len(bends)):
        at_rest = np.isnan(bends[n, 0])
        if at_rest:
            bends[n] = 0.0
        if n == 0:
            continue
        before, turn = flown, tangents[n] - tangents[n - 1]
        flown += length(points[n] - points[n - 1])
        size = length(turn)
        if size > UNRESOLVED:
            bends[n] = turn / max(flown - before, 1e-9)
        if at_rest and size > CORNER:
            for a in range(points.shape[1]):
                bends[n, a] = math.copysign(np.inf, turn[a]) if abs(turn[a]) > CORNER / 2 else 0.0
    return bends


@compiled
def length(vector):
    return math.sqrt((vector**2).sum())
