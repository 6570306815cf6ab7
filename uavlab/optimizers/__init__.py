"""Optimisers for any function: particle swarm, beetle antennae, and both (PSO-BAS section 4)."""

from uavlab.optimizers.beetle import bas
from uavlab.optimizers.particle_swarm import pso
from uavlab.optimizers.pso_bas import pso_bas
from uavlab.optimizers.result import Result

__all__ = ["Result", "bas", "pso", "pso_bas"]
