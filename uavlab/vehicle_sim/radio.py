"""A data link that is slow, late and loses packets, as radios do."""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from typing import Any

import numpy as np

from uavlab import checks

BITS = 10
"""That a byte takes on a serial line, with start and stop."""


@dataclass(frozen=True)
class DataLink:
    """How a radio between vehicle and ground station behaves, the same both ways.

    Attributes
    ----------
    bit_rate : float
        Of its serial line [bit/s]; infinite where it isn't the limit.
    delay, jitter : float
        What a packet takes beside that, and σ of what comes on top, always later [s].
    loss : float
        Share of packets that never arrive, 0 to 1.

    Raises
    ------
    ValueError
        If `bit_rate` is not above 0, `delay` or `jitter` is negative, or `loss` is not from 0 to 1.

    See Also
    --------
    P840 : RISK-ACO's.
    simulated_vehicle : Talks through one.

    Examples
    --------
    >>> from uavlab.vehicle_sim import P840, DataLink
    >>> P840
    <DataLink: 57600 bit/s, delay 50 ms, jitter 10 ms, loss 1 %>
    >>> DataLink(loss=0.1)
    <DataLink: any bit/s, delay 0 ms, jitter 0 ms, loss 10 %>
    """

    bit_rate: float = np.inf
    delay: float = 0.0
    jitter: float = 0.0
    loss: float = 0.0

    def __post_init__(self) -> None:
        rate = checks.number("bit_rate", self.bit_rate)
        if not rate > 0:
            raise ValueError(f"bit_rate must be above 0 (infinite: no limit), got {self.bit_rate!r}")
        object.__setattr__(self, "bit_rate", rate)
        checks.set_fields(self, checks.not_negative_number, "delay", "jitter")
        object.__setattr__(self, "loss", checks.number("loss", self.loss, checks.within, 0.0, 1.0, "of all packets"))

    def __repr__(self) -> str:
        rate = "any" if self.bit_rate == np.inf else f"{self.bit_rate:.0f}"
        return (
            f"<DataLink: {rate} bit/s, delay {1000 * self.delay:g} ms, jitter {1000 * self.jitter:g} ms, "
            f"loss {100 * self.loss:g} %>"
        )


PERFECT_LINK = DataLink()
P840 = DataLink(bit_rate=57_600.0, delay=0.05, jitter=0.01, loss=0.01)
"""RISK-ACO section 4 flies with a Microhard module at 840 MHz, by a serial line. A maker gives 840 to 845 MHz, up to
345 kbit/s in the air and up to 230.4 kbit/s on the line (Holybro, Microhard radio, specification); 57 600 bit/s is
what autopilots usually set there. Delay, jitter and loss nobody gives: they are ours, for a radio in sight."""


class Channel:
    """One direction of a data link: packets go in, and come out later, or never."""

    def __init__(self, link: DataLink, rng: np.random.Generator) -> None:
        self.link, self.rng = link, rng
        self.free = 0.0
        """When the line has sent what it was given [s]."""
        self.count = 0
        self.queue: list[tuple[float, int, Any]] = []

    def put(self, now: float, size: int, packet: Any) -> None:
        """A packet of so many bytes; packets keep their order on the line, not in the air."""
        self.free = max(self.free, now) + size * BITS / self.link.bit_rate
        if self.rng.random() < self.link.loss:
            return
        late = (
            self.link.delay + abs(self.link.jitter * self.rng.standard_normal())
            if self.link.jitter
            else self.link.delay
        )
        heapq.heappush(self.queue, (self.free + late, self.count, packet))
        self.count += 1

    def due(self, now: float) -> list[Any]:
        """What has arrived."""
        arrived = []
        while self.queue and self.queue[0][0] <= now:
            arrived.append(heapq.heappop(self.queue)[2])
        return arrived
