"""What a vehicle says of itself in flight, and what a ground station makes of it: a track beside the plan."""

from __future__ import annotations

import csv
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from uavlab import checks
from uavlab.city import City
from uavlab.files import written_whole
from uavlab.flight import Flight
from uavlab.flight.state import COLUMNS
from uavlab.mavlink.dialect import ARDUPILOT, ARDUPILOT_MODES, ARMED, EMERGENCY, ON_GROUND, PX4_MODES
from uavlab.mavlink.link import Link
from uavlab.mavlink.transfer import lost, target_of
from uavlab.mission import Mission
from uavlab.mission.corridor import nearest_on_leg
from uavlab.route import Route

SILENCE = 5.0
"""After which a link is taken for lost [s]."""


class Telemetry(NamedTuple):
    """What a vehicle says of a moment.

    Attributes
    ----------
    time : float
        Since it was switched on [s].
    longitude, latitude : float
        Where it believes to be [degrees, WGS84].
    altitude, above_home : float
        Above the sea, and above home [m].
    velocity : tuple of float
        East, north and up [m/s].
    battery : float
        What is left [%]; NaN where it doesn't know.
    mode : str
        "ready", "take off", "mission", "hold", "return", "land", "crashed", or the autopilot's number.
    armed : bool
        Whether the motors turn.
    current : int
        Number of the item of the mission that it flies to, −1 before it says one.
    reached : tuple of int
        Numbers of items reached since the last one of these.
    breached : bool
        Whether it is outside of its fence.
    said : tuple of str
        What it said since.

    See Also
    --------
    follow : Gives them.

    Examples
    --------
    >>> from uavlab.mavlink import Telemetry
    >>> Telemetry(12.5, 8.5, 47.25, 450.0, 30.0, (4.0, 3.0, 0.0), 81.0, "mission", True, 4)
    <Telemetry after 12.5 s: mission, item 4, 30.0 m above home, 5.0 m/s, battery 81 %>
    """

    time: float
    longitude: float
    latitude: float
    altitude: float
    above_home: float
    velocity: tuple[float, float, float]
    battery: float
    mode: str
    armed: bool
    current: int
    reached: tuple[int, ...] = ()
    breached: bool = False
    said: tuple[str, ...] = ()

    def __repr__(self) -> str:
        speed = float(np.linalg.norm(self.velocity))
        outside = ", outside of the fence" * self.breached
        return (
            f"<Telemetry after {self.time:.1f} s: {self.mode}, item {self.current}, {self.above_home:.1f} m above "
            f"home, {speed:.1f} m/s, battery {self.battery:.0f} %{outside}>"
        )


def follow(link: Link, *, silence: float = SILENCE, until_landed: bool = True) -> Iterator[Telemetry]:
    """What a vehicle says, one moment after the other, as it says it.

    Parameters
    ----------
    link : Link
        On which a vehicle was heard.
    silence : float
        How long it may say nothing [s], above 0.
    until_landed : bool
        Whether to end when it has landed and its motors stand; otherwise it goes on until the caller stops.

    Yields
    ------
    Telemetry

    Raises
    ------
    ValueError
        If `link` is no open link on which a vehicle was heard, `silence` is not above 0, or `until_landed` is neither
        True nor False.
    TimeoutError
        If nothing is heard for so long; what was yielded before remains.

    See Also
    --------
    start : Let it fly.
    FlightLog : Keeps them beside the plan.

    Examples
    --------
    >>> from uavlab.mavlink import connect, follow
    >>> with connect("udp:127.0.0.1:0", wait=False) as link:
    ...     next(follow(link))
    Traceback (most recent call last):
        ...
    ValueError: link must be one on which a vehicle was heard: connect without wait=False
    """
    target_of(link)
    silence = checks.positive_number("silence", silence)
    return followed(link, silence, checks.flag("until_landed", until_landed))


def followed(link: Link, silence: float, until_landed: bool) -> Iterator[Telemetry]:
    state = {"battery": np.nan, "mode": "ready", "armed": False, "current": -1, "breached": False, "flown": False}
    reached: list[int] = []
    said: list[str] = []
    first = int(link.autopilot == ARDUPILOT)  # whose item 0 is home
    over, last = False, time.monotonic()
    while True:
        message = link.receive(timeout=min(silence, 0.5))
        now = time.monotonic()
        if message is None:
            if now - last > silence:
                raise lost(link, "was followed", silence)
            continue
        last = now
        kind = message.get_type()
        if kind == "GLOBAL_POSITION_INT":
            yield sample(message, state, tuple(reached), tuple(said))
            if over:
                return
            reached.clear()
            said.clear()
        elif kind == "MISSION_ITEM_REACHED":
            reached += [message.seq - first] * (message.seq - first not in reached)
        elif kind == "STATUSTEXT":
            said.append(message.text)
        elif kind == "EXTENDED_SYS_STATE":
            state["flown"] = state["flown"] or (bool(state["armed"]) and message.landed_state != ON_GROUND)
            stands = message.landed_state == ON_GROUND and not state["armed"]
            over = until_landed and bool(state["flown"]) and stands  # after one more sample
        else:
            note(message, state, link.autopilot)


def note(message: Any, state: dict[str, Any], autopilot: int) -> None:
    """Remember what a message says of the vehicle's state."""
    kind = message.get_type()
    if kind == "HEARTBEAT":
        state["armed"] = bool(message.base_mode & ARMED)
        if autopilot == ARDUPILOT:
            state["mode"] = ARDUPILOT_MODES.get(message.custom_mode, f"mode {message.custom_mode}")
        else:
            state["mode"] = PX4_MODES.get(message.custom_mode >> 24, f"mode {message.custom_mode >> 16 & 255}")
        if not state["armed"]:
            state["mode"] = "crashed" if message.system_status == EMERGENCY else "ready"
    elif kind == "MISSION_CURRENT":
        state["current"] = message.seq - int(autopilot == ARDUPILOT)
    elif kind == "SYS_STATUS":
        state["battery"] = float(message.battery_remaining) if message.battery_remaining >= 0 else np.nan
    elif kind == "FENCE_STATUS":
        state["breached"] = bool(message.breach_status)


def sample(message: Any, state: dict[str, Any], reached: tuple[int, ...], said: tuple[str, ...]) -> Telemetry:
    """A position, with what else is known."""
    return Telemetry(
        message.time_boot_ms / 1000, message.lon / 1e7, message.lat / 1e7, message.alt / 1000,
        message.relative_alt / 1000, (message.vy / 100, message.vx / 100, -message.vz / 100), state["battery"],
        state["mode"], state["armed"], state["current"], reached, state["breached"], said,
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class FlightLog:
    """A flight as a ground station saw it, beside its plan.

    Attributes
    ----------
    mission : Mission
        What was to be flown.
    city : City
        The map.
    samples : sequence of Telemetry
        What was heard; it may be one that still grows.

    Raises
    ------
    ValueError
        If `mission`, `city` or one of `samples` is of another kind, or `samples` is no sequence.

    See Also
    --------
    follow : Gives the samples.
    uavlab.plot.ground_station : Draws it.

    Examples
    --------
    >>> from uavlab.city import table1_city
    >>> from uavlab.mavlink import FlightLog, Telemetry
    >>> from uavlab.mission import Mission
    >>> from uavlab.route import Route
    >>> from uavlab.vehicle import LIGHT_QUADROTOR
    >>> city, route = table1_city(), Route([(5, 5, 30), (40, 5, 30), (40, 50, 30)])
    >>> mission = Mission.from_route(route, city, LIGHT_QUADROTOR, home=(4.36, 52.01))
    >>> heard = Telemetry(9.0, 4.36, 52.01, 31.0, 31.0, (5.0, 0.0, 0.0), 97.0, "mission", True, 2)
    >>> log = FlightLog(mission, city, [heard])
    >>> log.position.round(2), log.deviation.round(2)
    (array([[ 5.,  5., 31.]]), array([1.]))
    """

    mission: Mission
    city: City
    samples: Sequence[Telemetry]

    def __post_init__(self) -> None:
        checks.instance("mission", self.mission, Mission)
        checks.instance("city", self.city, City)
        if not isinstance(self.samples, Sequence):  # no generator, which could be gone through once only
            kind = type(self.samples).__name__
            raise ValueError(f"samples must be a list of Telemetry, such as list(follow(link)), got {kind}")
        checks.several("samples", self.samples, Telemetry, least=0)

    def __repr__(self) -> str:
        if not len(self.samples):
            return "<FlightLog: nothing heard>"
        duration = self.samples[-1].time - self.samples[0].time
        return f"<FlightLog of {self.mission.name}: {len(self.samples)} samples, {duration:.1f} s>"

    @property
    def time(self) -> np.ndarray:
        """(T,) [s]"""
        return np.array([one.time for one in self.samples])

    @property
    def position(self) -> np.ndarray:
        """On the map, where the vehicle believed to be, (T, 3) [m]."""
        if not len(self.samples):
            return np.empty((0, 3))
        place, at = self.mission.place_on(self.city), self.mission.home_on(self.city)
        plan = place.east_north([(one.longitude, one.latitude) for one in self.samples])
        return np.column_stack([plan, [at[2] + one.above_home for one in self.samples]])

    @property
    def deviation(self) -> np.ndarray:
        """Distance from the plan, whose corners aren't rounded, (T,) [m]."""
        position = self.position
        return np.linalg.norm(position - nearest_on(self.mission.path(self.city).points, position), axis=1)

    @property
    def battery(self) -> np.ndarray:
        """What is left, (T,) [%]."""
        return np.array([one.battery for one in self.samples])

    @property
    def breaches(self) -> np.ndarray:
        """When it left its fence, (B,) [s]."""
        outside = np.array([False, *[one.breached for one in self.samples]])
        return self.time[outside[1:] & ~outside[:-1]]

    @property
    def outcome(self) -> str:
        """ "arrived" at the end of the mission, "landed" elsewhere, "crashed", or "gave up" if that wasn't heard."""
        if not len(self.samples) or self.samples[-1].armed:
            return "gave up"
        last = self.samples[-1]
        if last.mode == "crashed":
            return "crashed"
        return "arrived" if last.current >= len(self.mission.items) - 1 else "landed"

    def flight(self) -> Flight:
        """The track as a flight, for figures and scenes.

        Returns
        -------
        uavlab.flight.Flight
            Where the vehicle believed to be, by the time since the first sample; its reference is the nearest point of
            the plan. Offsets and thrust aren't known, NaN.

        Raises
        ------
        ValueError
            If there are fewer than two samples.

        See Also
        --------
        uavlab.scene.show : Shows it in three dimensions.
        uavlab.plot.tracks : Draws it from above.

        Examples
        --------
        >>> from uavlab.city import table1_city
        >>> from uavlab.mavlink import FlightLog, Telemetry
        >>> from uavlab.mission import Mission
        >>> from uavlab.route import Route
        >>> from uavlab.vehicle import LIGHT_QUADROTOR
        >>> city, route = table1_city(), Route([(5, 5, 30), (40, 5, 30), (40, 50, 30)])
        >>> mission = Mission.from_route(route, city, LIGHT_QUADROTOR, home=(4.36, 52.01))
        >>> heard = Telemetry(9.0, 4.36, 52.01, 31.0, 31.0, (5.0, 0.0, 0.0), 97.0, "mission", True, 2)
        >>> FlightLog(mission, city, [heard, heard._replace(time=9.5)]).flight().duration
        0.5
        """
        if len(self.samples) < 2:
            raise ValueError(f"samples must be at least two for a flight, got {len(self.samples)}")
        log = np.full((len(self.samples), len(COLUMNS)), np.nan)
        position = self.position
        log[:, 0], log[:, 1:4] = self.time - self.time[0], position
        log[:, 4:7] = nearest_on(self.mission.path(self.city).points, position)
        log[:, -1] = [np.linalg.norm(one.velocity) for one in self.samples]
        outcome = self.outcome
        reason = "" if outcome == "arrived" else f"{outcome} after {log[-1, 0]:.1f} s at {checks.show(position[-1])}"
        goal = self.mission.path(self.city).points[-1]
        return Flight(outcome, reason, log, Route(position).clearance(self.city), None, goal=goal)

    def to_csv(self, path: str | Path) -> None:
        """Write a line for each sample, with place, height, speed, battery, mode and distance from the plan.

        Parameters
        ----------
        path : str or Path
            What is there is replaced.

        Raises
        ------
        ValueError
            If `path` is not the name of a file.

        See Also
        --------
        connect : Its `record` is a `.tlog` with every word.

        Examples
        --------
        >>> import tempfile
        >>> from pathlib import Path
        >>> from uavlab.city import table1_city
        >>> from uavlab.mavlink import FlightLog, Telemetry
        >>> from uavlab.mission import Mission
        >>> from uavlab.route import Route
        >>> from uavlab.vehicle import LIGHT_QUADROTOR
        >>> city, route = table1_city(), Route([(5, 5, 30), (40, 5, 30), (40, 50, 30)])
        >>> mission = Mission.from_route(route, city, LIGHT_QUADROTOR, home=(4.36, 52.01))
        >>> heard = Telemetry(9.0, 4.36, 52.01, 31.0, 31.0, (5.0, 0.0, 0.0), 97.0, "mission", True, 2)
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     FlightLog(mission, city, [heard]).to_csv(Path(folder) / "flight.csv")
        ...     print((Path(folder) / "flight.csv").read_text().split()[1])
        9.00,4.3600000,52.0100000,5.00,5.00,31.00,31.00,5.00,97,mission,2,False,1.00
        """
        names = (
            "time_s", "longitude_deg", "latitude_deg", "x_m", "y_m", "z_m", "above_home_m", "speed_m_per_s",
            "battery_percent", "mode", "item", "outside_of_fence", "from_plan_m",
        )  # fmt: skip
        rows = zip(self.samples, self.position.tolist(), self.deviation.tolist(), strict=True)
        with written_whole(checks.path("path", path)) as part, part.open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow(names)
            for one, (x, y, z), apart in rows:
                metres = [f"{value:.2f}" for value in (x, y, z, one.above_home, np.linalg.norm(one.velocity))]
                state = [f"{one.battery:.0f}", one.mode, one.current, one.breached, f"{apart:.2f}"]
                writer.writerow([f"{one.time:.2f}", f"{one.longitude:.7f}", f"{one.latitude:.7f}", *metres, *state])


def nearest_on(way: np.ndarray, points: np.ndarray) -> np.ndarray:
    """The points of a polyline (N, 3) that are nearest to points (T, 3)."""
    best, found = np.full(len(points), np.inf), np.empty((len(points), 3))
    for start, end in pairwise(way):
        there = nearest_on_leg(points, start, end)
        apart = np.linalg.norm(points - there, axis=1)
        nearer = apart < best
        best[nearer], found[nearer] = apart[nearer], there[nearer]
    return found
