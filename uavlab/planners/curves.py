"""What a curve through a risk map costs, and how far it breaks the limits: exactly, voxel by voxel.

A curve is a line of short straight legs. Its cost is the integral of the price; its violations are the metres where it
may not be, and the angles by which legs turn or climb too much. Heights and clearance hold at each of its points, not
only at the centres of voxels as for planners on the grid. An optimiser finds every gap that
samples along the way would leave: measured at a quarter of a voxel, it claims what isn't so.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from uavlab.checks import frozen
from uavlab.city.bounds import height_limits, slack_of
from uavlab.city.segments import Runs, least_to_expect, segment_clearance
from uavlab.city.voxels import voxels_on_segment
from uavlab.compiled import compiled
from uavlab.planners.question import Ends
from uavlab.planners.risk_question import Limits, Weights, base_price, in_cells
from uavlab.risk import RiskMap
from uavlab.risk.drift import NO_FALLS, Falls, rate_ahead
from uavlab.spline.basis import cubic_bspline, fitted, spread, subdivided

PER_SEGMENT = 8
"""Straight legs by which a segment of a curve is drawn and measured."""

SLACK = 1e-9
"""Rounding that a limit on an angle allows [rad]."""

LONGEST = 1000
"""No curve is as long as so many times the edges of the map; what that costs, one that breaks a limit costs more."""


class Sky(NamedTuple):
    """A map for compiled code."""

    price: np.ndarray  # (nx, ny, nz): cost per cell of way, whatever its direction
    falls: Falls  # what depends on the direction
    ahead: float  # weight of the risk where the wreck lands
    closed: np.ndarray  # (nx, ny, nz) bool: obstacles and no-fly zones
    lowest: np.ndarray  # (nx, ny, 1 or nz): least z of a point in each voxel [cells]
    highest: np.ndarray  # (nx, ny): greatest z in each column [cells]
    obstacles: Runs
    clearance: np.ndarray  # (nx, ny, nz): of the centres [cells]; not looked at where `keep` is 0
    keep: float  # least distance to obstacles [cells]
    max_turn: float
    max_pitch: float
    longest: float  # [cells]


def sky_of(risk_map: RiskMap, price: np.ndarray, limits: Limits, risk_ahead: float, max_length: float) -> Sky:
    """The limits at each point of a curve, at a price (nx, ny, nz) per cell of way, and for the risk ahead."""
    city = risk_map.city
    heights = height_limits(city, limits.min_height, limits.max_height, limits.safe_height)
    keep = max(limits.min_clearance / city.cell - slack_of(city), 0.0)
    clearance = city.clearance / city.cell if keep > 0 else np.empty((0, 0, 0))
    return Sky(
        price, risk_map.falls if risk_ahead > 0 else NO_FALLS, risk_ahead,
        city.blocked(), *heights, city.runs, frozen(clearance), keep,
        limits.max_turn, limits.max_pitch, in_cells(city, max_length) + SLACK,
    )  # fmt: skip


class Task(NamedTuple):
    """Which curves to measure; all positions in cells."""

    sky: Sky
    source: np.ndarray
    target: np.ndarray
    spline: bool  # curves are B-splines with these control points, or else lines with these corners
    breach: float  # what a cell flown where it may not, or a radian too much, costs more
    unflyable: float  # what any curve that breaks a limit costs more

    def lines(self, control: np.ndarray, per_segment: int) -> np.ndarray:
        """Curves as straight legs (N, P, 3), from control points (N, K + 2, 3)."""
        return cubic_bspline(control, per_segment) if self.spline else control

    def costs(self, control: np.ndarray, per_segment: int) -> np.ndarray:
        """Costs (N,) of curves (N, K + 2, 3); whichever breaks a limit costs more than any that doesn't."""
        costs, shut, angles, longer = costs_of(self.sky, self.lines(control, per_segment))
        broken = shut + angles + longer
        return costs + np.where(broken > 0, self.unflyable + self.breach * broken, 0.0)

    def finer(self, control: np.ndarray) -> np.ndarray:
        """Control points (2 K + 3, 3) of the same curve as (K + 2, 3), with one more between each two."""
        if self.spline:
            return subdivided(control)
        finer = np.empty((2 * len(control) - 1, 3))
        finer[0::2], finer[1::2] = control, (control[:-1] + control[1:]) / 2
        return finer

    def nearest(self, points: np.ndarray, count: int) -> np.ndarray:
        """`count` control points of a curve along the points of a route (M, 3)."""
        return fitted(points, count) if self.spline else spread(points, count)


def task_of(
    risk_map: RiskMap,
    ends: Ends,
    price: np.ndarray,
    weights: Weights,
    limits: Limits,
    spline: bool,
    max_length: float = np.inf,
) -> Task:
    """The question of `least_risk`, for curves: from the centre of the start's voxel to that of the goal's.

    At the price (1 or 26, nx·ny·nz) of those weights.
    """
    city = risk_map.city
    source, target = city.index_of(np.array((ends.source, ends.target))) + 0.5
    ahead = weights.risk if weights.drift else 0.0
    level = base_price(risk_map, weights) if ahead > 0 else price
    sky = sky_of(risk_map, level.reshape(city.shape), limits, ahead, max_length)
    highest = float(price[:, ~sky.closed.ravel()].max())
    return Task(sky, source, target, spline, 10 * highest, LONGEST * sum(city.shape) * highest)


class Measure:
    """Measures curves, counts them, and notes the best and the least cost."""

    def __init__(self, task: Task) -> None:
        self.task = task
        self.best, self.per_segment, self.least = np.empty((0, 3)), PER_SEGMENT, np.inf
        self.histories: list[np.ndarray] = []
        self.iterations: list[int] = []
        self.made = 0

    def __call__(self, control: np.ndarray, per_segment: int = PER_SEGMENT) -> np.ndarray:
        """Costs (N,) of curves (N, K + 2, 3), see `Task.costs`."""
        values = self.task.costs(control, per_segment)
        if values.min() < self.least:
            self.least, self.best, self.per_segment = values.min(), control[values.argmin()], per_segment
        self.note(np.where(values >= self.task.unflyable, np.inf, values))
        return values

    def note(self, costs: np.ndarray, iterations: npt.ArrayLike = ()) -> None:
        """Note costs that were found, and after how many of them iterations ended."""
        self.iterations += [self.made + int(end) for end in np.asarray(iterations)]
        self.histories.append(costs)
        self.made += len(costs)

    @property
    def history(self) -> np.ndarray:
        """Least cost of a curve that keeps the limits, after each."""
        return np.minimum.accumulate(np.concatenate(self.histories))


@compiled
def costs_of(sky, lines):
    """Of polylines (N, P, 3): cost [price·cells], way where it may not be [cells], and excess of angles [rad].

    And by how much it is too long [cells].
    """
    costs, shut = np.zeros(len(lines)), np.zeros(len(lines))
    angles, longer = np.zeros(len(lines)), np.zeros(len(lines))
    for n in range(len(lines)):
        length = 0.0
        for p in range(lines.shape[1] - 1):
            cost, breach, leg = along(sky, lines[n, p], lines[n, p + 1])
            costs[n] += cost
            shut[n] += breach
            length += leg
            angles[n] += excess(sky, lines[n], p)
        longer[n] = max(length - sky.longest, 0.0)
    return costs, shut, angles, longer


@compiled
def along(sky, start, end):
    """∫ price ds over a straight leg, how much of it is where it may not be [cells], and its length [cells].

    That is in voxels that are closed, off the map, too low or too high; all of it, if it comes too near to an obstacle.
    """
    climb = end[2] - start[2]
    length = math.sqrt((end[0] - start[0]) ** 2 + (end[1] - start[1]) ** 2 + climb**2)
    voxels, leave = voxels_on_segment(start, end)
    nx, ny, nz = sky.closed.shape
    cost = shut = entered = 0.0
    for m in range(len(voxels)):
        i, j, k = voxels[m]
        stay = (leave[m] - entered) * length
        if 0 <= i < nx and 0 <= j < ny and 0 <= k < nz:
            z, w = start[2] + entered * climb, start[2] + leave[m] * climb
            price = sky.price[i, j, k]
            if sky.ahead > 0.0:
                price += sky.ahead * rate_ahead(sky.falls, end[0] - start[0], end[1] - start[1], climb, i, j, k)
            cost += stay * price
            if sky.closed[i, j, k]:
                shut += stay
            else:
                shut += stay * share_outside(z, w, sky.lowest[i, j, min(k, sky.lowest.shape[2] - 1)], sky.highest[i, j])
        else:
            shut += stay
        entered = leave[m]
    near = sky.keep > 0.0 and shut < length and least_to_expect(sky.clearance, 1.0, start, end) < sky.keep
    if near and segment_clearance(sky.obstacles, start, end, sky.keep) < sky.keep:
        shut = length
    return cost, shut, length


@compiled
def share_outside(start, end, low, high):
    """How much of the way from one height to another is below `low` or above `high`."""
    bottom, top = min(start, end), max(start, end)
    if bottom >= low and top <= high:
        return 0.0
    if top <= low or bottom >= high:
        return 1.0
    return (max(low - bottom, 0.0) + max(top - high, 0.0)) / (top - bottom)


@compiled
def excess(sky, line, p):
    """How far leg p climbs too much and turns too much against the leg before it [rad].

    Legs shorter than a voxel may turn only in proportion: `max_turn` is per corner and per length of a voxel. A
    vertical leg has no heading, and keeps the one of the leg before it.
    """
    dx, dy, dz = line[p + 1] - line[p]
    level = math.hypot(dx, dy)
    over = max(0.0, abs(math.atan2(dz, level)) - sky.max_pitch - SLACK)
    if level <= SLACK:
        return over
    for before in range(p - 1, -1, -1):
        ex, ey, ez = line[before + 1] - line[before]
        level_before = math.hypot(ex, ey)
        if level_before > SLACK:
            turn = abs(math.atan2(ex * dy - ey * dx, ex * dx + ey * dy))
            mean = 0.5 * (math.hypot(level, dz) + math.hypot(level_before, ez))
            return over + max(0.0, turn - sky.max_turn * min(1.0, mean) - SLACK)
    return over


def breaches(task: Task, line: np.ndarray, cell: float) -> str:
    """Words for the limits that a curve (P, 3) breaks."""
    _, shut, _, longer = costs_of(task.sky, line[None])
    climbs = costs_of(task.sky._replace(max_turn=np.inf), line[None])[2]
    turns = costs_of(task.sky._replace(max_pitch=np.inf), line[None])[2]
    words = [f"flies {shut[0] * cell:.1f} m where it may not"] if shut[0] > 0 else []
    words += ["climbs more than max_pitch"] if climbs[0] > 0 else []
    words += ["turns more than max_turn"] if turns[0] > 0 else []
    words += [f"is {longer[0] * cell:.1f} m longer than max_length"] if longer[0] > 0 else []
    return ", ".join(words)
