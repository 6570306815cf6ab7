"""How far gusts push a UAV off its route, and how far it must therefore keep from walls (REPARE Eqs 6, 7 and 17).

The Pauta criterion takes 3σ for the edge of what chance does, 99.73 %. That is one axis, one moment and a Gaussian
force. This module has the radius for two and three axes, the law of a force that grows with the square of the wind, the
joint density of two axes and the magnitude that it gives, and the chance of touching a wall during a flight.
Offsets are in metres from the route, σ is their standard deviation.
"""

from uavlab.offsets.axis import OffsetModel, SkewedOffset
from uavlab.offsets.exposure import collision_probability, crossing_rate, offset_paths
from uavlab.offsets.joint import JointOffset, SafetyDomain, magnitude, safety_domain
from uavlab.offsets.pauta import (
    PAUTA_COVERAGE,
    Filtered,
    coverage,
    minimum_safe_distance,
    pauta_filter,
    pauta_radius,
)

__all__ = [
    "PAUTA_COVERAGE",
    "Filtered",
    "JointOffset",
    "OffsetModel",
    "SafetyDomain",
    "SkewedOffset",
    "collision_probability",
    "coverage",
    "crossing_rate",
    "magnitude",
    "minimum_safe_distance",
    "offset_paths",
    "pauta_filter",
    "pauta_radius",
    "safety_domain",
]
