"""Where a wreck lands that keeps its speed: ahead of the place of failure, by 33 to 39 m from 22 to 32 m height.

The papers let it fall straight down. On a map of 5 m voxels it then lands seven voxels away from where its risk
was counted. Here the ballistic fall is followed voxel by voxel until it meets the ground or a building.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from uavlab.checks import frozen
from uavlab.city import City
from uavlab.compiled import compiled
from uavlab.risk.fall import AIR_DENSITY, fall_motion, impact_energy, lethal_area
from uavlab.risk.rates import EVEN_ODDS_ENERGY, FAILURE_RATE, LEAST_FATAL_ENERGY, vehicle_rate
from uavlab.vehicle import UAV

STEPS_PER_CELL = 4
"""How finely a fall is followed."""

PITCH_STEP = 0.5
"""Falls are known for climbs and descents so far apart, and that of the nearest is taken [°]."""

MOMENTS = 4000
"""In which falls are sampled, before they are cut into steps."""


class Falls(NamedTuple):
    """Where a map's UAV falls to that fails at cruise speed, in any direction of flight, for compiled code.

    R rows by pitch, from straight down to straight up; S steps, of which a row uses the first `last` + 1.
    """

    ahead: np.ndarray  # (R, S) way over ground from the place of failure [cells]
    up: np.ndarray  # (R, S) [cells]
    hits: np.ndarray  # (R, S) failures per hour × lethal area [m²/h] if it lands at this step
    energy: np.ndarray  # (R, S) E [J] if it lands at this step
    last: np.ndarray  # (R,)
    occupied: np.ndarray  # (nx, ny, nz)
    people: np.ndarray  # (nx, ny) [1/m²]
    shelter: np.ndarray  # (nx, ny)
    cars: np.ndarray  # (nx, ny) deaths in cars [1/h]


def falls_of(
    city: City, uav: UAV, population_density: np.ndarray, shelter: np.ndarray, vehicle_share: np.ndarray
) -> Falls:
    """All falls of a UAV on a map with these layers (nx, ny), from as high as the map is."""
    from scipy.integrate import solve_ivp

    pitch = np.radians(np.arange(-90.0, 90.0 + PITCH_STEP / 2, PITCH_STEP))
    depth = city.cell * city.shape[2]
    motion, enough = fall_motion(uav, uav.cruise_speed, depth, AIR_DENSITY)
    begin = np.zeros((4, len(pitch)))
    begin[2:] = uav.cruise_speed * np.array([np.cos(pitch), -np.sin(pitch)])

    def all_down(_: float, state: np.ndarray) -> float:
        return float(state.reshape(4, -1)[1].min()) - depth - 1e-3

    all_down.terminal = True  # type: ignore[attr-defined]
    path = solve_ivp(motion, (0.0, enough), begin.ravel(), events=all_down, dense_output=True, rtol=1e-9, atol=1e-9)
    fine = path.sol(np.linspace(0.0, path.t[-1], MOMENTS)).reshape(4, len(pitch), MOMENTS)
    rows = [fall_steps(fall, depth, city.cell) for fall in fine.transpose(1, 0, 2)]
    last = np.array([row.shape[1] - 1 for row in rows])
    steps = np.zeros((4, len(rows), last.max() + 1))
    for number, row in enumerate(rows):
        steps[:, number, : last[number] + 1] = row
    distance, drop, forward, down = steps
    area = lethal_area(np.maximum(drop, 0.0), np.abs(forward), np.maximum(down, 1e-9), uav.diameter)
    energy = impact_energy(uav.mass + uav.payload, np.abs(forward), np.abs(down))
    ahead, up, hits, energy = map(frozen, (distance / city.cell, -drop / city.cell, FAILURE_RATE * area, energy))
    layers = population_density, shelter, vehicle_rate(vehicle_share)
    people, sheltered, cars = (frozen(np.ascontiguousarray(layer)) for layer in layers)
    return Falls(ahead, up, hits, energy, frozen(last, int), city.occupied, people, sheltered, cars)


NOTHING = frozen(np.empty((0, 0)))
NO_FALLS = Falls(
    NOTHING, NOTHING, NOTHING, NOTHING, frozen(np.empty(0), int),
    frozen(np.empty((0, 0, 0)), bool), NOTHING, NOTHING, NOTHING,
)  # fmt: skip
"""For who doesn't look at them."""


def fall_steps(fall: np.ndarray, depth: float, cell: float) -> np.ndarray:
    """A fall (4, N) at even steps of its way down to a depth (4, S): distance, drop, and their rates."""
    fall = fall[:, : int(np.argmax(fall[1] >= depth)) + 1]  # with the first moment below: it may land in between
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(fall[:2])))])
    steps = np.linspace(0.0, way[-1], 1 + int(np.ceil(way[-1] / cell * STEPS_PER_CELL)))
    return np.array([np.interp(steps, way, values) for values in fall])


def landing_rate(falls: Falls, index: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """Deaths per hour of flight [1/h] if the UAV flies in a direction (3,) through the centres of voxels (M, 3)."""
    return landing_rates(falls, np.asarray(direction, dtype=float), np.ascontiguousarray(index))


@compiled
def landing_rates(falls, direction, index):
    rates = np.empty(len(index))
    for n in range(len(index)):
        rates[n] = rate_ahead(falls, direction[0], direction[1], direction[2], index[n, 0], index[n, 1], index[n, 2])
    return rates


@compiled
def rate_ahead(falls, dx, dy, dz, i, j, k):
    """Deaths per hour of flight in a direction through the centre of a voxel.

    The wreck meets the ground, a roof or a wall. Beyond the border the layers are taken to go on as they are at it:
    the column is the nearest one on the map.
    """
    level = math.hypot(dx, dy)
    east, north = (dx / level, dy / level) if level > 0.0 else (0.0, 0.0)
    row = math.floor(0.5 + (math.degrees(math.atan2(dz, level)) + 90.0) / PITCH_STEP)
    nx, ny, nz = falls.occupied.shape
    step = 0
    while True:
        a = math.floor(i + 0.5 + falls.ahead[row, step] * east)
        b = math.floor(j + 0.5 + falls.ahead[row, step] * north)
        c = math.floor(k + 0.5 + falls.up[row, step])
        inside = 0 <= a < nx and 0 <= b < ny and c < nz
        if c < 0 or step == falls.last[row] or (inside and falls.occupied[a, b, c]):
            break
        step += 1
    a, b = min(max(a, 0), nx - 1), min(max(b, 0), ny - 1)
    killed = fatality(falls.energy[row, step], falls.shelter[a, b])
    return falls.people[a, b] * falls.hits[row, step] * killed + falls.cars[a, b]


@compiled
def fatality(energy, shelter):
    """`impact_fatality` of one person."""
    over = math.log(energy / LEAST_FATAL_ENERGY) if energy > 0.0 else -math.inf
    odds = 0.5 * math.log(EVEN_ODDS_ENERGY / LEAST_FATAL_ENERGY)
    if over != 0.0:
        odds -= over / (4 * shelter) if shelter > 0.0 else math.copysign(math.inf, over)
    return 1 / (1 + math.exp(min(odds, 700.0)))
