"""Where on Earth a city lies: to be completed."""

from typing import NamedTuple

import numpy as np


class Place(NamedTuple):
    """The place of x = y = z = 0."""

    longitude: float
    latitude: float
    height: float = 0.0

    def east_north(self, lonlat: np.ndarray) -> np.ndarray:
        raise NotImplementedError

    def longitude_latitude(self, points: np.ndarray) -> np.ndarray:
        raise NotImplementedError
