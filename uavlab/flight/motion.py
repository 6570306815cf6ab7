"""The flight itself, step by step: a body with limited thrust that an autopilot pulls along a route, in gusts."""

from __future__ import annotations

import math

import numpy as np

from uavlab.city.segments import segment_clearance
from uavlab.city.voxels import distance_to_obstacle
from uavlab.compiled import compiled
from uavlab.flight.reference import advance, patience, squared_distance, velocity_at
from uavlab.flight.state import (
    ARRIVED,
    BATTERY,
    BATTERY_EMPTY,
    BLOWN_BACK,
    BRAKED,
    CRASHED,
    DRAG,
    FLYING,
    GAUSSIAN,
    INDUCED,
    LEAST,
    NONE,
    NOW,
    OU,
    PROFILE,
    RAIN,
    WIND,
)
from uavlab.power import rotor_power
from uavlab.vehicle import GRAVITY

PREVIEW = 0.25
"""How far ahead and back the autopilot looks to know how its velocity has to change [s]."""

LOST = 30.0
"""Who is as far from the reference gives up [m]: the wind is stronger than the UAV."""

HALVINGS = 24
"""To find where on a step a body first touches something."""

MORE = 1 + 1e-12
"""A fix that is due at a step isn't a step late for rounding."""

LESS = 1 - 1e-12
"""What is nearer than a distance is less than it, whatever the rounding."""

LEAST_THRUST, LEAST_LIFT = 0.1, 0.5
"""Of the greatest, and of the weight, whichever is less: rotors can't push down, but a strong UAV can still sink."""


@compiled
def fly_on(body, air, course, state, max_steps, log_every, rng, log):
    """Fly up to so many steps, and log some: FLYING, ARRIVED, CRASHED, BLOWN_BACK or BATTERY_EMPTY."""
    target_velocity, ahead, back = np.empty(3), np.empty(3), np.empty(3)
    thrust, stream, drag, velocity = np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    path, dt = course.path, course.dt
    for _ in range(max_steps):
        step = state.counts[0]
        pace = body.pace * patience(state)
        speed = advance(path, state, dt * pace if step > 0 else 0.0, target_velocity) * pace
        velocity_at(path, state, speed * PREVIEW, ahead)
        velocity_at(path, state, -speed * PREVIEW, back)
        next_gust(air, state, step, rng)
        if fix_due(step, body.gps_fixes):
            look_at_gps(body, state, step, rng)
        for a in range(3):
            target_velocity[a] *= pace
            change = pace * (ahead[a] - back[a]) / (2 * PREVIEW)
            pull = body.omega**2 * (state.target[a] - state.seen_position[a])
            damping = 2 * body.omega * (target_velocity[a] - state.seen_velocity[a])
            thrust[a] = body.mass * (change + pull + damping)
            stream[a] = body.trim[a] - target_velocity[a]
        pressure = body.drag * length(stream)
        for a in range(3):
            thrust[a] -= pressure * stream[a]
        thrust[2] += body.mass * GRAVITY + body.rain
        limit_thrust(body, thrust)
        pulled = length(thrust)
        outcome = log_step(course, state, log_every, pulled, body.charge, log)
        if outcome != FLYING:
            return outcome
        for a in range(3):
            stream[a] = air.mean[a] + state.gust[a] - state.velocity[a]
        pressure = body.drag * length(stream)
        for a in range(3):
            drag[a] = pressure * stream[a]
            force = thrust[a] + drag[a]
            if a == 2:
                force -= body.mass * GRAVITY + body.rain
            change = dt * force / body.mass
            velocity[a] = state.velocity[a] + 0.5 * change
            state.velocity[a] += change
            state.before[a] = state.position[a]
            state.position[a] += dt * state.velocity[a]
            state.seen_position[a] += dt * state.seen_velocity[a]
        spend(body, air, state, dt, thrust, drag, velocity)
    return FLYING


@compiled
def fix_due(step, fixes):
    """Whether GPS has a new fix at a step, with so many fixes a step; at the first one it has."""
    return step == 0 or math.floor(step * fixes * MORE) > math.floor((step - 1) * fixes * MORE)


@compiled
def look_at_gps(body, state, step, rng):
    """What GPS says of place and speed; its error drifts from 0 at the start."""
    for a in range(3):
        if step > 0:
            new = body.gps_enter[a] * rng.standard_normal()
            state.gps_error[a] = body.gps_keep * state.gps_error[a] + new
        state.seen_position[a] = state.position[a] + state.gps_error[a]
        state.seen_velocity[a] = state.velocity[a] + body.gps_velocity * rng.standard_normal()


@compiled
def spend(body, air, state, dt, thrust, drag, velocity):
    """Add up the energy of a step, by the velocity in its middle (3,)."""
    pulled = length(thrust)
    through, speed, dragged, blown = 0.0, 0.0, 0.0, 0.0
    for a in range(3):
        wind = air.mean[a] + state.gust[a]
        relative = velocity[a] - wind
        through += thrust[a] * relative / pulled
        speed += relative * relative
        dragged -= drag[a] * relative
        blown += (thrust[a] + drag[a]) * wind
    across = math.sqrt(max(speed - through * through, 0.0))
    induced, profile, useful = rotor_power(pulled, math.sqrt(pulled / body.disc), through, across, body.profile)
    shaft = induced + profile + useful
    state.sums[BATTERY] += dt * max(shaft, 0.0) / body.efficiency
    state.sums[INDUCED] += dt * induced
    state.sums[PROFILE] += dt * profile
    state.sums[DRAG] += dt * dragged
    state.sums[WIND] += dt * blown
    state.sums[RAIN] += dt * body.rain * velocity[2]
    state.sums[BRAKED] += dt * max(-shaft, 0.0)


@compiled
def drift_on(spring, course, state, max_steps, log_every, rng, log):
    """The same for offsets without a body: they are added to the route."""
    target_velocity = np.empty(3)
    path, dt = course.path, course.dt
    for _ in range(max_steps):
        advance(path, state, dt * spring.pace if state.counts[0] > 0 else 0.0, target_velocity)
        for a in range(3):
            one, two = rng.standard_normal(), rng.standard_normal()
            x, v = state.lags[a, 0], state.lags[a, 1]
            if state.counts[0] == 0:
                state.lags[a, 0], state.lags[a, 1] = one, two
            else:
                state.lags[a, 0] = spring.keep[0, 0] * x + spring.keep[0, 1] * v + spring.enter[0, 0] * one
                state.lags[a, 1] = (
                    spring.keep[1, 0] * x + spring.keep[1, 1] * v + spring.enter[1, 0] * one + spring.enter[1, 1] * two
                )
            position = state.target[a] + spring.mean[a] + spring.sigma[a] * state.lags[a, 0]
            moved = (position - state.position[a]) / dt
            state.velocity[a] = moved if state.counts[0] > 0 else spring.pace * target_velocity[a]
            state.before[a] = state.position[a] if state.counts[0] > 0 else position
            state.position[a] = position
        outcome = log_step(course, state, log_every, np.nan, np.inf, log)
        if outcome != FLYING:
            return outcome
    return FLYING


@compiled
def next_gust(air, state, step, rng):
    """The gust of a step."""
    if air.kind == NONE or (air.kind == GAUSSIAN and step % air.every):
        return
    state.gust[:] = 0.0
    for axis in range(3):
        one, two = rng.standard_normal(), 0.0
        x, y = state.lags[axis, 0], state.lags[axis, 1]
        if air.kind == GAUSSIAN:
            value = one
        elif air.kind == OU:
            state.lags[axis, 0] = one if step == 0 else air.keep[axis, 0, 0] * x + air.enter[axis, 0, 0] * one
            value = state.lags[axis, 0]
        else:
            two = rng.standard_normal()
            if step == 0:  # the stationary state
                state.lags[axis, 0] = math.sqrt(0.5) * one
                state.lags[axis, 1] = math.sqrt(0.125) * (one + two)
            else:
                enter = air.enter[axis]
                state.lags[axis, 0] = air.keep[axis, 0, 0] * x + enter[0, 0] * one
                state.lags[axis, 1] = (
                    air.keep[axis, 1, 0] * x + air.keep[axis, 1, 1] * y + enter[1, 0] * one + enter[1, 1] * two
                )
            value = air.read[axis, 0] * state.lags[axis, 0] + air.read[axis, 1] * state.lags[axis, 1]
        for a in range(3):
            state.gust[a] += air.frame[a, axis] * air.deviation[axis] * value


@compiled
def limit_thrust(body, thrust):
    """What the rotors can do of a thrust: first hold the height, then pull sideways, no more than the tilt allows."""
    least = min(LEAST_THRUST * body.thrust, LEAST_LIFT * body.mass * GRAVITY)
    thrust[2] = min(max(thrust[2], least), body.thrust)
    sideways = math.hypot(thrust[0], thrust[1])
    most = min(math.sqrt(body.thrust**2 - thrust[2] ** 2), thrust[2] * body.tan_tilt)
    if sideways > most:
        thrust[0] *= most / sideways
        thrust[1] *= most / sideways


@compiled
def log_step(course, state, log_every, thrust, charge, log):
    """Look around after a step, log it if it is time or over, and count it."""
    path, space = course.path, course.obstacles
    gap = closest(space, state)
    state.sums[LEAST] = min(state.sums[LEAST], gap)
    outcome = FLYING
    if gap < space.touching:
        outcome = CRASHED
    elif (
        state.way[0] >= path.distance[-1]
        and squared_distance(state.seen_position, path.points[-1]) <= space.near_goal * space.near_goal
    ):
        outcome = ARRIVED
    elif state.sums[BATTERY] >= charge:
        outcome = BATTERY_EMPTY
    elif space.near_goal < np.inf and squared_distance(state.position, state.target) > LOST**2:
        outcome = BLOWN_BACK
    if state.counts[0] % log_every == 0 or outcome != FLYING:
        row = log[state.counts[1]]
        row[0] = state.counts[0] * course.dt
        for a in range(3):
            row[1 + a] = state.position[a]
            row[4 + a] = state.target[a]
        x, y = state.position[0] - state.target[0], state.position[1] - state.target[1]
        row[7] = x * state.heading[0] + y * state.heading[1]
        row[8] = y * state.heading[0] - x * state.heading[1]
        row[9] = state.position[2] - state.target[2]
        row[10] = thrust
        row[11] = length(state.velocity)
        state.counts[1] += 1
    state.counts[0] += 1
    return outcome


@compiled
def closest(space, state):
    """Distance to obstacles [m], the least since the step before if it may have touched; then it is where it did."""
    cell = space.cell
    end = in_cells(space, state.position)
    near = max(min(state.sums[LEAST] / cell, 4.0), space.touching / cell)
    gap = cell * distance_to_obstacle(space.occupied, space.clearance, cell, end, near)
    moved = squared_distance(state.position, state.before)
    spare = state.sums[NOW] + gap - 2 * space.touching  # to be moved before it can have touched
    state.sums[NOW] = gap
    if moved == 0.0 or (gap >= space.touching and spare >= 0.0 and spare * spare >= moved):
        return gap
    start, touching = in_cells(space, state.before), space.touching / cell
    least = cell * segment_clearance(space.runs, start, end, max(gap, space.touching) / cell)
    if min(least, gap) >= space.touching:
        return least
    flown, most = 0.0, 1.0  # the farther along the step, the less the least distance up to there
    for _ in range(HALVINGS):
        share = (flown + most) / 2
        there = (
            start[0] + share * (end[0] - start[0]),
            start[1] + share * (end[1] - start[1]),
            start[2] + share * (end[2] - start[2]),
        )
        if segment_clearance(space.runs, start, there, touching) < touching:
            most = share
        else:
            flown = share
    for a in range(3):
        state.position[a] = state.before[a] + most * (state.position[a] - state.before[a])
    least = cell * segment_clearance(space.runs, start, in_cells(space, state.position), touching)
    return min(least, LESS * space.touching)


@compiled
def in_cells(space, position):
    return (
        (position[0] - space.origin[0]) / space.cell,
        (position[1] - space.origin[1]) / space.cell,
        (position[2] - space.origin[2]) / space.cell,
    )


@compiled
def length(vector):
    return math.sqrt(vector[0] ** 2 + vector[1] ** 2 + vector[2] ** 2)
