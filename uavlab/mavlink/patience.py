"""How long to wait for an answer before asking again: as long as answers on this link take, and some more."""

from __future__ import annotations

LEAST, MOST, USUAL = 0.05, 1.0, 0.25
"""Seconds; MAVLink's mission protocol says a quarter of a second."""

MARGIN, WEIGHT = 4.0, 0.25
"""So many times the usual time of an answer; and how much a new one says of that."""


class Patience:
    """Learns from answers to questions that were asked once: of others nobody knows which question was heard."""

    def __init__(self) -> None:
        self.seconds = USUAL
        self.asked_at = 0.0
        self.times = 0

    def asked(self, now: float) -> None:
        """A question was sent; again, if it wasn't answered."""
        self.asked_at = now
        self.times += 1

    def answered(self, now: float) -> None:
        """It was answered."""
        if self.times == 1:
            wanted = MARGIN * (now - self.asked_at)
            self.seconds = min(max((1 - WEIGHT) * self.seconds + WEIGHT * wanted, LEAST), MOST)
        self.times = 0

    def over(self, now: float) -> bool:
        """Whether it is time to ask again."""
        return now - self.asked_at > self.seconds
