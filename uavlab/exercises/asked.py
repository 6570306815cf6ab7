"""Functions whose least value is to be found, which remember what they were asked (exercise 11.6).

The least value lies in a place that the one who asks doesn't know, in a box of six dimensions.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

BUDGET = 4000
"""Points that may be evaluated."""


def valley(x: np.ndarray) -> np.ndarray:
    return (100 * (x[:, 1:] - x[:, :-1] ** 2) ** 2 + (1 - x[:, :-1]) ** 2).sum(axis=1)


def holes(x: np.ndarray) -> np.ndarray:
    return (10 + x**2 - 10 * np.cos(2 * np.pi * x)).sum(axis=1)


class Asked:
    """A function with its least value elsewhere, that remembers what it was asked."""

    def __init__(self, f: Callable[[np.ndarray], np.ndarray], half: float, shift: np.ndarray) -> None:
        self.f, self.shift, self.box = f, shift, np.array([[-half, half]] * 6)
        self.made, self.least, self.outside = 0, np.inf, 0

    def value(self, x: np.ndarray) -> np.ndarray:
        return self.f(x - self.shift)

    def __call__(self, x: Any) -> np.ndarray:
        x = np.array(x, dtype=float)
        if x.ndim != 2 or x.shape[1] != 6:
            raise ValueError(f"f takes points of shape (N, 6), and got an array of shape {x.shape}")
        self.made += len(x)
        self.outside += int(((x < self.box[:, 0] - 1e-9) | (x > self.box[:, 1] + 1e-9)).any(axis=1).sum())
        values = self.value(x)
        self.least = min(self.least, float(values.min(initial=np.inf)))
        return values

    def complaint(self) -> str:
        """What is wrong with the questions, if anything."""
        if self.made == 0:
            return "Your optimiser never asks f. The least value lies elsewhere in each of our questions."
        if self.made > BUDGET:
            return f"Your optimiser evaluates {self.made} points, and the budget is {BUDGET}. Count them."
        if self.outside:
            return f"{self.outside} of the points that you evaluate lie outside of the box."
        return ""
