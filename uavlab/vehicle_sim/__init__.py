"""A vehicle to fly against: another process that speaks MAVLink as PX4 and ArduPilot do, and flies in wind over a city.

`simulated_vehicle` starts one from Python, `python -m uavlab.vehicle_sim` from a shell. Only this machine hears it.
Needs pymavlink, the extra `mavlink`.
"""

from uavlab.vehicle_sim.process import SimulatedVehicle, simulated_vehicle
from uavlab.vehicle_sim.radio import P840, PERFECT_LINK, DataLink

__all__ = ["P840", "PERFECT_LINK", "DataLink", "SimulatedVehicle", "simulated_vehicle"]
