"""The reference that an autopilot sends along the route: where it is, how fast, and how patient."""

from __future__ import annotations

import math

from uavlab.compiled import compiled

LEASH = 4.0
"""From so far on the reference waits for the UAV [m]; at twice as far it stands still."""

PATIENCE, PAUSE = 3.0, 60.0
"""A flight is out of time after so many times the planned duration, and so many seconds more."""


@compiled
def patience(state):
    """Share of its speed with which the reference goes on: less where the UAV, as it sees itself, falls behind."""
    behind = squared_distance(state.seen_position, state.target)
    return 1.0 if behind <= LEASH**2 else max(2.0 - math.sqrt(behind) / LEASH, 0.0)


@compiled
def advance(path, state, dt, velocity):
    """Move the reference along the route by a time step; its place and velocity in place, its speed returned."""
    leg = int(state.way[1])
    s = state.way[0]
    s = min(s + dt * speed_at(path, s, leg), path.distance[-1])
    while leg < len(path.on_legs) - 1 and s >= path.distance[leg + 1]:
        leg += 1
    state.way[0] = s
    state.way[1] = leg
    speed = speed_at(path, s, leg)
    for a in range(3):
        state.target[a] = path.points[leg, a] + (s - path.distance[leg]) * path.direction[leg, a]
        velocity[a] = speed * path.direction[leg, a]
    level = math.hypot(path.direction[leg, 0], path.direction[leg, 1])
    if level > 1e-9:
        state.heading[0] = path.direction[leg, 0] / level
        state.heading[1] = path.direction[leg, 1] / level
    return speed


@compiled
def speed_at(path, s, leg):
    """Speed on a leg: that of the leg, less where it has to brake for the next waypoint or still gathers speed."""
    since = path.at_points[leg] ** 2 + 2 * path.braking * max(s - path.distance[leg], 0.0)
    until = path.at_points[leg + 1] ** 2 + 2 * path.braking * max(path.distance[leg + 1] - s, 0.0)
    return min(path.on_legs[leg], math.sqrt(min(since, until)))


@compiled
def velocity_at(path, state, beyond, velocity):
    """Velocity of the reference some metres beyond where it is, or before."""
    s = min(max(state.way[0] + beyond, 0.0), path.distance[-1])
    leg = int(state.way[1])
    while leg < len(path.on_legs) - 1 and s >= path.distance[leg + 1]:
        leg += 1
    while leg > 0 and s < path.distance[leg]:
        leg -= 1
    speed = speed_at(path, s, leg)
    for a in range(3):
        velocity[a] = speed * path.direction[leg, a]


@compiled
def squared_distance(one, other):
    x, y, z = one[0] - other[0], one[1] - other[1], one[2] - other[2]
    return x * x + y * y + z * z


@compiled
def most_steps(path, pace, dt):
    """After how many steps a flight is out of time."""
    return int(PATIENCE * steps_to_goal(path, pace, dt) + PAUSE / dt)


@compiled
def steps_to_goal(path, pace, dt):
    """How many steps the reference takes; the first one doesn't move it, so there is one more."""
    s, leg, steps = 0.0, 0, 1
    while s < path.distance[-1]:
        s += dt * pace * speed_at(path, s, leg)
        while leg < len(path.on_legs) - 1 and s >= path.distance[leg + 1]:
            leg += 1
        steps += 1
    return steps
