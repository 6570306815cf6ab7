"""Results that are kept for a city, no longer than the city itself."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable
from functools import wraps
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

import numpy as np

if TYPE_CHECKING:
    from uavlab.city.model import City


def kept_for_city(count: int) -> Callable[[Callable[..., np.ndarray]], Callable[..., np.ndarray]]:
    """Keep the last `count` arrays that a function made for each city; they go when the city goes."""

    def keeping(function: Callable[..., np.ndarray]) -> Callable[..., np.ndarray]:
        results: WeakKeyDictionary[City, OrderedDict[Hashable, np.ndarray]] = WeakKeyDictionary()

        @wraps(function)
        def kept(city: City, *question: Any) -> np.ndarray:
            known = results.setdefault(city, OrderedDict())
            if question in known:
                known.move_to_end(question)
            else:
                known[question] = function(city, *question)
                while len(known) > count:
                    known.popitem(last=False)
            return known[question]

        return kept

    return keeping
