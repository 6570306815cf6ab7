"""Power of steady flight: momentum theory beside RotorPy's torque times speed, and beside makers' data sheets.

RotorPy's rotors have a torque that grows with the square of their speed, whatever the air does that passes them; so
their power follows from the thrust alone, and translational lift is its one sign of the flow. It is found where its own
wrench balances the weight. Run it as `python tests/benchmarks/energy.py`, with RotorPy installed.
"""

import sys
from importlib.metadata import version
from typing import Any

import numpy as np
from astar import print_table
from flight import hover, hummingbird, point_mass_of
from scipy.optimize import fsolve

from uavlab.power import power_needed
from uavlab.vehicle import DATA_SHEETS, GRAVITY, UAV

VELOCITIES = ((0.0, 0.0), (2.0, 0.0), (5.0, 0.0), (8.0, 0.0), (12.0, 0.0), (0.0, 2.0), (0.0, -2.0), (5.0, 2.0))
"""Level and up [m/s]."""

HEADER = [
    "level, up [m/s]",
    "RotorPy [W]",
    "uavlab, shaft [W]",
    "RotorPy, of hover",
    "uavlab, of hover",
    "induced",
    "profile",
    "useful",
]


def balanced(parameters: dict[str, Any], level: float, up: float) -> float:
    """RotorPy's torque times speed of all rotors [W], tilted and as fast as its forces balance the weight."""
    from rotorpy.vehicles.multirotor import Multirotor

    vehicle = Multirotor(parameters)

    def force(unknown: np.ndarray) -> np.ndarray:
        tilt, speed = unknown
        cos, sin = np.cos(tilt), np.sin(tilt)
        airspeed = np.array([level * cos - up * sin, 0.0, level * sin + up * cos])
        body, _ = vehicle.compute_body_wrench(np.zeros(3), np.full(4, speed), airspeed)
        return np.array([body[0] * cos + body[2] * sin, body[2] * cos - body[0] * sin - parameters["mass"] * GRAVITY])

    _, speed = fsolve(force, [0.05, hover(parameters)])
    return float(4 * parameters["k_m"] * speed**3)


def beside_rotorpy() -> list[list[str]]:
    """Power of both, and what ours is spent on, in units of hover."""
    parameters = hummingbird()
    uav = point_mass_of(parameters)
    uav = UAV(**{**vars(uav), "rotor_area": 4 * np.pi * parameters["rotor_radius"] ** 2})
    rows, theirs, ours = [], balanced(parameters, 0, 0), power_needed(uav, (0, 0, 0)).battery * uav.drive_efficiency
    for level, up in VELOCITIES:
        power = power_needed(uav, (level, 0.0, up))
        other, shaft = balanced(parameters, level, up), float(power.battery) * uav.drive_efficiency
        rows.append(
            [f"{level:g}, {up:g}", f"{other:.1f}", f"{shaft:.1f}", f"{other / theirs:.2f}", f"{shaft / ours:.2f}"]
            + [f"{float(part) / ours:.2f}" for part in (power.induced, power.profile, power.useful)]
        )
    return rows


def beside_data_sheets() -> list[list[str]]:
    """Power of hover from battery and endurance, all of it and a tenth less, against ours."""
    rows = []
    for sheet in DATA_SHEETS:
        thrust = 2 * sheet.mass * GRAVITY
        uav = UAV(sheet.mass, thrust, 0.03, 0.1, 0.5, 10.0, sheet.top_speed, rotor_area=np.pi * sheet.rotor_diameter**2)
        drained = sheet.battery / sheet.endurance
        ours = uav.hover_power()
        powers = f"{0.9 * drained:.0f} to {drained:.0f}", f"{ours:.0f}"
        rows.append([sheet.name, *powers, *(f"{ours / (left * drained) - 1:+.0%}" for left in (1.0, 0.9))])
    return rows


def main() -> None:
    print(f"RotorPy {version('rotorpy')}")
    print_table(
        "Power of steady flight",
        HEADER,
        beside_rotorpy(),
    )
    print_table(
        "Power of hover",
        ["aircraft", "data sheet [W]", "uavlab [W]", "battery emptied", "a tenth left"],
        beside_data_sheets(),
    )


if __name__ == "__main__":
    sys.exit(main())
