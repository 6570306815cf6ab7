"""Where a wreck lands that keeps its speed: ahead of the place of failure, by 33 to 39 m from 22 to 32 m height.

The papers let it fall straight down. On a map of 5 m voxels it then lands seven voxels away from where its risk
was counted. Here the ballistic fall is followed voxel by voxel until it meets the ground or a building.
"""

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from uavlab.compiled import compiled
from uavlab.risk.fall import AIR_DENSITY, impact_energy, lethal_area, wreck_path
from uavlab.risk.rates import FAILURE_RATE, impact_fatality, vehicle_rate

if TYPE_CHECKING:
    from uavlab.risk.model import RiskMap

STEPS_PER_CELL = 4
"""How finely a fall is followed."""


class Wreckage(NamedTuple):
    """A fall in one direction, step by step."""

    offset: np.ndarray  # (S, 3) from the place of failure [cells]
    hits: np.ndarray  # (S,) failures per hour × lethal area [m²/h] if it lands at this step
    energy: np.ndarray  # (S,) E [J] if it lands at this step


def wreckage(risk_map: "RiskMap", direction: np.ndarray) -> Wreckage:
    """The fall of the map's UAV that fails at cruise speed in a direction (3,), from as high as the map is."""
    city, uav = risk_map.city, risk_map.uav
    level = float(np.hypot(direction[0], direction[1]))
    heading = np.asarray(direction[:2]) / level if level > 0 else np.zeros(2)
    depth = city.cell * city.shape[2]
    path = wreck_path(uav, None, float(np.arctan2(direction[2], level)), depth, AIR_DENSITY)
    fine = path.sol(np.linspace(0.0, path.t[-1], 4000))
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(fine[:2])))])
    steps = np.linspace(0.0, way[-1], 1 + int(np.ceil(way[-1] / city.cell * STEPS_PER_CELL)))
    distance, drop, forward, down = (np.interp(steps, way, values) for values in fine)
    offset = np.column_stack([distance * heading[0], distance * heading[1], -drop]) / city.cell
    area = lethal_area(np.maximum(drop, 0.0), np.abs(forward), np.maximum(down, 1e-9), uav.diameter / 2)
    energy = impact_energy(uav.mass + uav.payload, np.abs(forward), np.abs(down))
    return Wreckage(offset, FAILURE_RATE * area, energy)


def landing_rate(risk_map: "RiskMap", index: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """Deaths per hour of flight [1/h] if the UAV flies in a direction (3,) through the centres of voxels (M, 3)."""
    fall = wreckage(risk_map, direction)
    i, j, step = landings(risk_map.city.occupied, fall.offset, np.ascontiguousarray(index)).T
    deadly = fall.hits[step] * impact_fatality(fall.energy[step], risk_map.shelter[i, j])
    return risk_map.population_density[i, j] * deadly + vehicle_rate(risk_map.vehicle_share)[i, j]


@compiled
def landings(occupied, offset, index):
    """For each voxel the column (i, j) and the step at which the wreck meets the ground, a roof or a wall.

    Beyond the border the layers are taken to go on as they are at it: the column is the nearest one on the map.
    """
    nx, ny, nz = occupied.shape
    landed = np.empty((len(index), 3), np.int64)
    for n in range(len(index)):
        step = 0
        while True:
            i = int(np.floor(index[n, 0] + 0.5 + offset[step, 0]))
            j = int(np.floor(index[n, 1] + 0.5 + offset[step, 1]))
            k = int(np.floor(index[n, 2] + 0.5 + offset[step, 2]))
            inside = 0 <= i < nx and 0 <= j < ny and k < nz
            if k < 0 or step == len(offset) - 1 or (inside and occupied[i, j, k]):
                break
            step += 1
        landed[n] = min(max(i, 0), nx - 1), min(max(j, 0), ny - 1), step
    return landed
