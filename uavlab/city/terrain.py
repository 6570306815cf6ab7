"""The ground as a surface of triangles: to be completed."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class Terrain:
    """A surface of triangles."""

    points: np.ndarray
    triangles: np.ndarray


def ground_and_top(
    terrain: Terrain, origin: np.ndarray, cell: float, shape: Sequence[int]
) -> tuple[np.ndarray, np.ndarray]:
    """Heights at the columns' centres, and the highest in each column."""
    raise NotImplementedError
