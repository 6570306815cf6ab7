"""What flights leave behind: tracks, offsets, crashes and how sure their number is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from uavlab import checks
from uavlab.flight.state import COLUMNS
from uavlab.resilience import Change
from uavlab.route import Route
from uavlab.statistics import grouped_share_interval


class Energy(NamedTuple):
    """What a flight took from the battery, and where that went [J].

    Balance: efficiency · battery + wind = induced + profile + drag + climb + motion + rain + braked

    See Also
    --------
    Flight : Has one as its `energy`.
    uavlab.power : Where the power of the rotors goes.

    Examples
    --------
    >>> from uavlab.flight import Energy
    >>> energy = Energy(2783.9, 0.75, 945.0, 742.4, 370.3, climb=2.5, motion=0.1, rain=0.0, wind=-27.7, braked=0.0)
    >>> energy
    <Energy [J]: battery 2784, induced 945, profile 742, drag 370, climb 2, wind -28>
    >>> abs(energy.imbalance) < 1e-4
    True
    """

    battery: float
    efficiency: float
    """Of motors and their control [1]."""
    induced: float
    """Spent on pushing air down, see `uavlab.power`."""
    profile: float
    """On the drag of the rotors' blades."""
    drag: float
    """On the drag of the body."""
    climb: float
    """Gained in height, m g h."""
    motion: float
    """Of motion at the end, ½ m v²."""
    rain: float
    """Spent on climbing against the rain."""
    wind: float
    """Work that moving air did on the UAV, as the ground sees it: given, where it pushed."""
    braked: float
    """What a fast descent would have given back, lost."""

    def __repr__(self) -> str:
        joules = self._asdict()
        del joules["efficiency"]
        return f"<Energy [J]: {', '.join(f'{name} {value:.0f}' for name, value in joules.items() if round(value))}>"

    @property
    def imbalance(self) -> float:
        """By how much the balance fails, over the energy that reached the rotors; what time steps leave."""
        spent = self.induced + self.profile + self.drag + self.climb + self.motion + self.rain
        reached = self.efficiency * self.battery
        return (reached + self.wind - self.braked - spent) / reached


@dataclass(frozen=True, eq=False)
class Flight:
    """One flight, every step of it.

    Attributes
    ----------
    outcome : {"arrived", "crashed", "landed", "gave up", "grounded"}
        How it ended.
    reason : str
        Where and when it crashed, why it landed, gave up or never took off; empty when it arrived.
    log : (T, 12) array
        A row each time step; `column` says what stands in it.
    clearance : float
        Least distance of its centre to the obstacles [m], exact up to four voxels; infinite when it never flew.
    energy : Energy, optional
        What it took from the battery, and where that went; none of an `OffsetProcess`, which has no thrust.
    changes : list of Change
        What the monitor changed.
    goal : (3,) array, optional
        Where it should have arrived [m].

    See Also
    --------
    fly : Makes one.
    Flights : What is kept of many.
    uavlab.plot.in_flight : Draws how it went.

    Examples
    --------
    >>> from uavlab.flight import OffsetProcess, fly
    >>> from uavlab.planners import least_risk
    >>> from uavlab.risk import CAMPUS_FLIGHT, reference_campus
    >>> campus = reference_campus()
    >>> flight = fly(least_risk(campus, *CAMPUS_FLIGHT), campus.city, campus.uav, OffsetProcess(0.5), rng=1)
    >>> flight
    <Flight: arrived after 11.8 s>
    >>> flight.offset.std(axis=0).round(1)  # along, across, up [m]
    array([0.3, 0.2, 0.7])
    """

    outcome: str
    reason: str
    log: np.ndarray
    clearance: float
    energy: Energy | None
    changes: list[Change] = field(default_factory=list)
    goal: np.ndarray | None = None

    def __repr__(self) -> str:
        grounded = "grounded: " if self.outcome == "grounded" else ""
        return f"<Flight: {grounded}{self.reason or f'arrived after {self.duration:.1f} s'}>"

    def column(self, name: str) -> np.ndarray:
        """A column of the log by its name.

        Parameters
        ----------
        name : str
            "time" [s]; position "x", "y", "z" and reference "x_ref", "y_ref", "z_ref" [m]; offset "along", "across"
            and "up" in the route's frame [m]; "thrust" [N]; "speed" over ground [m/s].

        Returns
        -------
        (T,) array
            One value for each time step.

        Raises
        ------
        ValueError
            If `name` is unknown.

        See Also
        --------
        uavlab.plot.in_flight : Draws some of them over time.

        Examples
        --------
        >>> from uavlab.flight import OffsetProcess, fly
        >>> from uavlab.planners import least_risk
        >>> from uavlab.risk import CAMPUS_FLIGHT, reference_campus
        >>> campus = reference_campus()
        >>> flight = fly(least_risk(campus, *CAMPUS_FLIGHT), campus.city, campus.uav, OffsetProcess(0.5), rng=1)
        >>> round(float(abs(flight.column("across")).max()), 1)  # [m]
        0.6
        """
        return self.log[:, COLUMNS.index(checks.one_of("name", name, COLUMNS))]

    @property
    def time(self) -> np.ndarray:
        """(T,) [s]"""
        return self.log[:, 0]

    @property
    def duration(self) -> float:
        """[s]"""
        return float(self.log[-1, 0]) if len(self.log) else 0.0

    @property
    def position(self) -> np.ndarray:
        """Of the body's centre, (T, 3) [m]."""
        return self.log[:, 1:4]

    @property
    def reference(self) -> np.ndarray:
        """Where it should be, (T, 3) [m]."""
        return self.log[:, 4:7]

    @property
    def offset(self) -> np.ndarray:
        """Along the route, across it to the left, and up, (T, 3) [m]."""
        return self.log[:, 7:10]

    def route(self) -> Route:
        """The way flown."""
        return Route(self.position, f"flown: {self.outcome}", reached=self.outcome == "arrived", reason=self.reason)


@dataclass(frozen=True, eq=False)
class Flights:
    """N flights of one route.

    Attributes
    ----------
    outcome : (N,) array of str
        "arrived", "crashed", "landed", "gave up" or "grounded".
    duration, clearance, energy : (N,) arrays
        As for `Flight` [s], [m]; from the battery [J], NaN for an `OffsetProcess`.
    place : (N, 3) array
        Where it ended [m].
    offsets : (N, S, 3) array
        Along, across and up [m], as often as asked for; NaN after its end.
    reason : str
        Why all are grounded; empty if they fly.

    See Also
    --------
    monte_carlo : Makes them.
    crash_rate : How many of 1 000 crash.
    uavlab.offsets.safety_domain : Where their offsets stay, from `samples`.

    Examples
    --------
    >>> from uavlab.flight import OffsetProcess, monte_carlo
    >>> from uavlab.planners import least_risk
    >>> from uavlab.risk import CAMPUS_FLIGHT, reference_campus
    >>> campus = reference_campus()
    >>> route = least_risk(campus, *CAMPUS_FLIGHT)
    >>> flights = monte_carlo(route, campus.city, campus.uav, OffsetProcess(0.5), rng=1, flights=50)
    >>> flights.offsets.shape, flights.samples.std(axis=0).round(2)  # σ across and up [m]
    ((50, 12, 3), array([0.48, 0.5 ]))
    """

    outcome: np.ndarray
    duration: np.ndarray
    clearance: np.ndarray
    energy: np.ndarray
    place: np.ndarray
    offsets: np.ndarray
    reason: str = ""

    def __repr__(self) -> str:
        counts = ", ".join(f"{(self.outcome == name).sum()} {name}" for name in np.unique(self.outcome))
        return f"<Flights: {counts}>"

    @property
    def crashed(self) -> np.ndarray:
        """(N,) bool"""
        return self.outcome == "crashed"

    @property
    def samples(self) -> np.ndarray:
        """All offsets across and up in one list, (M, 2) [m]: ξ_hor, signed, and ξ_ver of REPARE 3.4."""
        across_up = self.offsets[..., 1:].reshape(-1, 2)
        return across_up[np.isfinite(across_up).all(axis=1)]


class Rate(NamedTuple):
    """Crashes per 1 000 flights, and its 95 % interval.

    See Also
    --------
    crash_rate : Counts them.
    uavlab.plot.crash_rates : Draws several beside each other.

    Examples
    --------
    >>> from uavlab.flight import Rate
    >>> print(Rate(5.0, 0.127, 27.5))
    5 [0.127, 27.5] per 1 000
    """

    per_thousand: float
    low: float
    high: float

    def __str__(self) -> str:
        return f"{self.per_thousand:.3g} [{self.low:.3g}, {self.high:.3g}] per 1 000"


def crash_rate(runs: Flights | Sequence[Flights]) -> Rate:
    """How many of 1 000 flights crash, with a 95 % interval.

    1 000 Σk/ΣN, k crashes among the N flights of each route.

    Of one route: the binomial one (Clopper and Pearson). Of several: flights of the same route aren't independent, and
    it is that of the mean over all such routes, `uavlab.statistics.grouped_share_interval`.

    Parameters
    ----------
    runs : Flights, or sequence of Flights
        With as many flights each.

    Returns
    -------
    Rate
        Crashes per 1 000 flights, and the ends of the interval.

    Raises
    ------
    ValueError
        If `runs` is empty, holds anything else than `Flights`, the numbers of flights differ, or a UAV was grounded:
        what never flew can't crash.

    See Also
    --------
    monte_carlo : Makes the flights.
    uavlab.statistics.grouped_share_interval : The interval over several routes.
    uavlab.plot.crash_rates : Draws several rates beside each other.

    References
    ----------
    C. J. Clopper and E. S. Pearson, The Use of Confidence or Fiducial Limits Illustrated in the Case of the Binomial,
    Biometrika, 1934.

    Examples
    --------
    >>> from uavlab.flight import OffsetProcess, crash_rate, monte_carlo
    >>> from uavlab.planners import least_risk
    >>> from uavlab.risk import CAMPUS_FLIGHT, reference_campus
    >>> campus = reference_campus()
    >>> route = least_risk(campus, *CAMPUS_FLIGHT)
    >>> flights = monte_carlo(route, campus.city, campus.uav, OffsetProcess(1.5), rng=1, flights=100)
    >>> print(crash_rate(flights))
    70 [28.6, 139] per 1 000
    """
    runs = [runs] if isinstance(runs, Flights) else checks.several("runs", runs, Flights, least=0)
    for number, run in enumerate(runs):
        if run.reason:
            raise ValueError(
                f"runs[{number}] is grounded ({run.reason}), and what never flew can't crash: leave it out"
            )
    if len({len(run.outcome) for run in runs}) != 1:
        raise ValueError("runs must be at least one, with as many flights each")
    crashed = np.array([run.crashed for run in runs])
    low, high = grouped_share_interval(crashed.sum(axis=1), crashed.shape[1])
    return Rate(1000 * float(crashed.mean()), 1000 * low, 1000 * high)
