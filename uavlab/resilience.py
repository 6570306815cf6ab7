"""Resilience: how careful to be in which conditions, and what if they turn out worse (REPARE 2.1.3, 2.2.4, 3.3).

Before the flight a table says how much of the resilience system to switch on for a load and a disturbance, and how far
to keep from walls. During the flight offsets are observed: one beyond the boundary raises it, a calm that lasts lowers
it again. A monitor chooses between two controllers: the basic one is quick, the advanced one safe.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from uavlab import checks
from uavlab.offsets import minimum_safe_distance
from uavlab.vehicle import LIGHT_QUADROTOR, UAV
from uavlab.weather import Weather, Wind, wind_drag
from uavlab.weather.forces import GUST_FACTOR
from uavlab.weather.wind import wind_of

LOADS = {"dead": 0.0, "light": 0.25, "moderate": 0.6, "heavy": 1.0}
"""Payload of each class of load [kg]. REPARE names the classes of Table 3 only; the masses are ours."""

DISTURBANCES = {"none": 1.5, "mild": 6.0, "moderate": 7.5, "heavy": 9.0}
"""Mean wind up to which each class of disturbance reaches [m/s]; ours too."""

LEVELS = ("off", "lower", "intermediate", "advanced", "grounded")

TABLE3 = {
    "none": ("off", "off", "lower", "intermediate"),
    "mild": ("lower", "lower", "intermediate", "advanced"),
    "moderate": ("intermediate", "intermediate", "advanced", "advanced"),
    "heavy": ("intermediate", "advanced", "grounded", "grounded"),
}
"""REPARE Table 3: the resilience factor by disturbance (row) and load (column, in the order of `LOADS`)."""

STILL_OFFSET, STIFFNESS = 1.0, 8.5
"""ξ₀ and the offset at which gusts eat the whole thrust reserve [m]; fitted to REPARE Table 4."""


def resilience_level(load: str, disturbance: str) -> str:
    """How much of the resilience system is switched on (REPARE Table 3).

    Parameters
    ----------
    load : {"dead", "light", "moderate", "heavy"}
        Class of the payload, `load_class`.
    disturbance : {"none", "mild", "moderate", "heavy"}
        Class of the mean wind, `disturbance_class`.

    Returns
    -------
    str
        "off", "lower", "intermediate", "advanced" or "grounded". Table 4 calls light load in mild disturbance
        "Intermediate"; this follows Table 3.

    Raises
    ------
    ValueError
        If `load` or `disturbance` is none of the classes.

    See Also
    --------
    safe_distance : how far to keep from walls.
    uavlab.weather.grounded_by : what grounds a UAV by its own limits.

    Examples
    --------
    >>> from uavlab.resilience import DISTURBANCES, resilience_level
    >>> [resilience_level("moderate", disturbance) for disturbance in DISTURBANCES]
    ['lower', 'intermediate', 'advanced', 'grounded']
    """
    return TABLE3[checks.one_of("disturbance", disturbance, DISTURBANCES)][
        list(LOADS).index(checks.one_of("load", load, LOADS))
    ]


def safe_distance(
    load: str | float, disturbance: str | Wind | Weather, *, reading: str = "table", uav: UAV = LIGHT_QUADROTOR
) -> float:
    """Minimum safe distance D_min for a load and a disturbance (REPARE Table 4).

    Parameters
    ----------
    load : {"dead", "light", "moderate", "heavy"} or float
        Class of the payload, or the payload itself [kg].
    disturbance : {"none", "mild", "moderate", "heavy"}, Wind or Weather
        Class of the mean wind, or what the air does. Wind beyond the heaviest class needs more room than it, by the
        physical reading.
    reading : {"table", "physical"}
        Table 4 has three cases, and D_min is no function of the factor in Table 3: two "advanced" cases differ.
        "table": D_min = 2 + L/2 + D with the numbers L, D = 0 … 3 of the classes, which gives the three.
        "physical": D_min = ξ + D_uav/2 with ξ = ⌈ξ₀ + 8.5 m·F_gust/√(T² − (m g)²)⌉, the drag of the gusts over the
        thrust that the load leaves; it gives them too, and says why a heavy load needs more room.
    uav : UAV
        For "physical"; its payload is replaced by `load`.

    Returns
    -------
    float
        D_min [m]. For conditions that ground the UAV it is what it would need.

    Raises
    ------
    ValueError
        If `load`, `disturbance` or `reading` is none of the classes, `load` is negative, above 1 kg for "table", or
        more than `uav` can lift, or `uav` is no UAV.

    See Also
    --------
    uavlab.offsets.minimum_safe_distance : the equation, REPARE Eq. 7.
    gust_offset : ξ of the physical reading.
    resilience_level : how much of the system is switched on.

    Examples
    --------
    >>> from uavlab.resilience import safe_distance
    >>> [safe_distance(*case) for case in (("light", "mild"), ("moderate", "moderate"), ("heavy", "moderate"))]
    [3.5, 5.0, 5.5]
    >>> [safe_distance(1.0, "moderate", reading=reading) for reading in ("table", "physical")]
    [5.5, 5.5]
    """
    checks.one_of("reading", reading, ("table", "physical"))
    checks.instance("uav", uav, UAV)
    payload = payload_of(load)
    kind, wind_speed = kind_and_speed(disturbance)
    in_table = 0.0
    if reading == "table":
        in_table = 2.0 + 0.5 * list(LOADS).index(load_class(payload)) + list(DISTURBANCES).index(kind)
        if wind_speed <= DISTURBANCES[kind]:
            return in_table
    loaded = uav.loaded(payload)
    needed = minimum_safe_distance(np.ceil(gust_offset(loaded, wind_speed) - 1e-9), loaded.diameter)
    return max(float(needed), in_table)


def payload_of(load: str | float) -> float:
    """The payload of a class of load, or itself.

    Parameters
    ----------
    load : {"dead", "light", "moderate", "heavy"} or float
        Class, or payload [kg].

    Returns
    -------
    float
        [kg]; of a class the heaviest that it covers.

    Raises
    ------
    ValueError
        If `load` is none of the classes, negative or not finite.

    See Also
    --------
    load_class : the way back.

    Examples
    --------
    >>> from uavlab.resilience import payload_of
    >>> payload_of("moderate"), payload_of(0.4)
    (0.6, 0.4)
    """
    if isinstance(load, str):
        return LOADS[checks.one_of("load", load, LOADS)]
    return checks.not_negative_number("load", load)


def kind_and_speed(disturbance: str | Wind | Weather, name: str = "disturbance") -> tuple[str, float]:
    """Class of a disturbance and its mean wind.

    Parameters
    ----------
    disturbance : {"none", "mild", "moderate", "heavy"}, Wind or Weather
        Class, or what the air does.
    name : str
        Of the argument, for the message.

    Returns
    -------
    (str, float)
        Class, and mean wind [m/s]; of a class the strongest that it covers.

    Raises
    ------
    ValueError
        If `disturbance` is none of the classes, and no Wind or Weather; if `name` is no text.

    See Also
    --------
    disturbance_class : from a speed.

    Examples
    --------
    >>> from uavlab.resilience import kind_and_speed
    >>> from uavlab.weather import Wind
    >>> kind_and_speed("mild"), kind_and_speed(Wind(mean=(3.0, 4.0)))
    (('mild', 6.0), ('mild', 5.0))
    """
    checks.text("name", name)
    if isinstance(disturbance, str):
        return checks.one_of(name, disturbance, DISTURBANCES), DISTURBANCES[disturbance]
    if not isinstance(disturbance, Wind | Weather):
        raise ValueError(
            f"{name} must be one of {', '.join(map(repr, DISTURBANCES))}, a Wind or a Weather, got {disturbance!r:.60}"
        )
    speed = wind_of(disturbance).speed
    return disturbance_class(speed), speed


def gust_offset(uav: UAV, wind_speed: float) -> float:
    """Offset of a UAV in a mean wind, before it is rounded up.

    ξ = ξ₀ + 8.5 m · F_gust/R, ξ₀ = 1 m, R the horizontal reserve of the thrust

    Parameters
    ----------
    uav : UAV
        With its payload.
    wind_speed : float
        Mean wind [m/s], at least 0.

    Returns
    -------
    float
        ξ [m].

    Raises
    ------
    ValueError
        If `uav` is no UAV, or `wind_speed` is negative or not finite.

    See Also
    --------
    gust_force : F_gust.
    safe_distance : D_min with it.

    Examples
    --------
    >>> from uavlab.resilience import gust_offset
    >>> from uavlab.vehicle import LIGHT_QUADROTOR
    >>> [round(gust_offset(LIGHT_QUADROTOR.loaded(payload), 7.5), 1) for payload in (0.0, 0.6, 1.0)]
    [3.3, 3.8, 5.0]
    """
    checks.instance("uav", uav, UAV)
    wind_speed = checks.not_negative_number("wind_speed", wind_speed)
    return float(STILL_OFFSET + STIFFNESS * gust_force(uav, wind_speed) / uav.horizontal_reserve())


def gust_force(uav: UAV, wind_speed: float) -> float:
    """Drag of the strongest gusts on a UAV that holds its place in a mean wind.

    F = ½ ρ C S (1.75 W)²: REPARE Eq. 5 at the gust of Eq. 3.

    Parameters
    ----------
    uav : UAV
        With its drag area.
    wind_speed : float
        Mean wind W [m/s], at least 0.

    Returns
    -------
    float
        F [N].

    Raises
    ------
    ValueError
        If `uav` is no UAV, or `wind_speed` is negative or not finite.

    See Also
    --------
    uavlab.weather.wind_drag : the drag.
    gust_offset : how far it pushes.

    Examples
    --------
    >>> from uavlab.resilience import gust_force
    >>> from uavlab.vehicle import LIGHT_QUADROTOR
    >>> [round(gust_force(LIGHT_QUADROTOR, wind), 1) for wind in (3.0, 6.0)]
    [1.0, 4.1]
    """
    checks.instance("uav", uav, UAV)
    wind_speed = checks.not_negative_number("wind_speed", wind_speed)
    return float(wind_drag((GUST_FACTOR * wind_speed, 0.0), (0.0, 0.0), uav.drag_area)[0])


def load_class(payload: float) -> str:
    """The lightest class of load that covers a payload.

    Parameters
    ----------
    payload : float
        [kg], 0 to 1.

    Returns
    -------
    str
        "dead", "light", "moderate" or "heavy".

    Raises
    ------
    ValueError
        If `payload` is negative, not finite, or heavier than the heaviest class.

    See Also
    --------
    payload_of : the way back.
    resilience_level : what follows from it.

    Examples
    --------
    >>> from uavlab.resilience import load_class
    >>> [load_class(payload) for payload in (0.0, 0.25, 0.3, 1.0)]
    ['dead', 'light', 'moderate', 'heavy']
    """
    payload = checks.not_negative_number("payload", payload)
    name = next((name for name, upper in LOADS.items() if payload <= upper), None)
    if name is None:
        raise ValueError(f"payload must be at most {LOADS['heavy']:g} kg, the heaviest class, got {payload:g}")
    return name


def disturbance_class(wind_speed: float) -> str:
    """The mildest class of disturbance that covers a mean wind.

    Parameters
    ----------
    wind_speed : float
        Mean wind [m/s], at least 0.

    Returns
    -------
    str
        "none", "mild", "moderate" or "heavy"; "heavy" for any stronger wind.

    Raises
    ------
    ValueError
        If `wind_speed` is negative or not finite.

    See Also
    --------
    resilience_level : what follows from it.
    uavlab.weather.reference_wind : the mean wind of a forecast and a measurement.

    Examples
    --------
    >>> from uavlab.resilience import disturbance_class
    >>> [disturbance_class(wind) for wind in (1.0, 5.0, 7.5, 20.0)]
    ['none', 'mild', 'moderate', 'heavy']
    """
    wind_speed = checks.not_negative_number("wind_speed", wind_speed)
    return next((name for name, upper in DISTURBANCES.items() if wind_speed <= upper), "heavy")


class Change(NamedTuple):
    """An entry of a log.

    See Also
    --------
    ConditionCheck, Monitor : keep lists of them.

    Examples
    --------
    >>> from uavlab.resilience import ConditionCheck
    >>> check = ConditionCheck(predicted=2.0)
    >>> _ = check.observe(12.0, 2.3)
    >>> check.log
    [Change(time=12.0, value=2.5, reason='an offset of 2.30 m exceeds 2 m')]
    """

    time: float
    """When [s]."""
    value: str | float
    """What holds from then on."""
    reason: str


@dataclass
class ConditionCheck:
    """The boundary of the offsets to reckon with, corrected by what is observed (REPARE 2.2.4).

    An offset beyond the boundary raises it at once, to the next step above. It comes down by one step when for `hold`
    seconds every offset has stayed below `release` times the next lower boundary, and never below the prediction.
    The two thresholds lie apart, so that the boundary doesn't flutter.

    Attributes
    ----------
    predicted : float
        ξ before the flight [m], above 0.
    step : float
        By how much the boundary moves [m], above 0.
    hold : float
        How long it must be calm before it comes down [s], above 0. Offsets of a position control with ω_n = 1 rad/s
        forget in 2 s, so 10 s hold five of them, too few to tell a pause between gusts from their end.
    release : float
        Share of the lower boundary that counts as calm, between 0 and 1.
    steps : int
        By how many it is raised now.
    boundary : float
        ξ that holds now [m].
    log : list of Change
        When it changed, to what, and why.

    Raises
    ------
    ValueError
        If `predicted`, `step` or `hold` is not above 0, or `release` is not between 0 and 1, without the ends.

    See Also
    --------
    ConditionCheck.observe : takes an offset.
    Monitor : chooses a controller by it.

    Examples
    --------
    >>> from uavlab.resilience import ConditionCheck
    >>> check = ConditionCheck(predicted=2.0, hold=20.0)
    >>> seen = ((0.0, 1.0), (1.0, 2.7), (10.0, 0.5), (21.0, 0.4), (41.0, 0.3))
    >>> [check.observe(time, offset) for time, offset in seen]
    [2.0, 3.0, 3.0, 2.5, 2.0]
    >>> check
    <ConditionCheck: 2 m now, 2 m predicted, changes: 3>
    """

    predicted: float
    step: float = 0.5
    hold: float = 20.0
    release: float = 0.8
    steps: int = field(init=False, default=0)
    log: list[Change] = field(init=False, default_factory=list)
    calm_since: float = field(init=False, default=-np.inf)
    now: float = field(init=False, default=-np.inf)

    def __post_init__(self) -> None:
        checks.set_fields(self, checks.positive_number, "predicted", "step", "hold")
        checks.set_fields(self, checks.number, "release", check=checks.share)

    def __repr__(self) -> str:
        return f"<ConditionCheck: {self.boundary:g} m now, {self.predicted:g} m predicted, changes: {len(self.log)}>"

    @property
    def boundary(self) -> float:
        return float(self.predicted + self.steps * self.step)

    def observe(self, time: float, offset: float) -> float:
        """Take an offset that is observed, and return the boundary that holds from now on.

        Parameters
        ----------
        time : float
            [s], not before the last one.
        offset : float
            From the route [m], at least 0.

        Returns
        -------
        float
            ξ [m], `predicted` or some steps more.

        Raises
        ------
        ValueError
            If `offset` is negative or not finite, or `time` is not finite or before the last one.

        See Also
        --------
        Monitor.observe : passes it on.

        Examples
        --------
        >>> from uavlab.resilience import ConditionCheck
        >>> check = ConditionCheck(predicted=2.0, step=0.5)
        >>> check.observe(0.0, 1.9), check.observe(1.0, 2.1), check.observe(2.0, 3.4)
        (2.0, 2.5, 3.5)
        >>> check.log[-1].reason
        'an offset of 3.40 m exceeds 2.5 m'
        """
        offset, time = checks.not_negative_number("offset", offset), checks.number("time", time)
        checks.finite("time", time)
        if time < self.now:
            raise ValueError(f"time must not go back, got {time:g} s after {self.now:g} s")
        self.now = time
        needed = int(np.ceil((offset - self.predicted) / self.step - 1e-9))
        if offset >= self.release * (self.boundary - self.step):
            self.calm_since = time
        if needed > self.steps:
            self.change(time, needed, f"an offset of {offset:.2f} m exceeds {self.boundary:g} m")
        elif self.steps > 0 and time - self.calm_since >= self.hold:
            self.change(time, self.steps - 1, f"calm for {self.hold:g} s")
        return self.boundary

    def change(self, time: float, steps: int, reason: str) -> None:
        """Set how many steps the boundary is raised by, and log it; `observe` calls this.

        Parameters
        ----------
        time : float
            [s]
        steps : int
            At least 0.
        reason : str
            For the log.

        Returns
        -------
        None

        See Also
        --------
        ConditionCheck.observe : decides on it.

        Examples
        --------
        >>> from uavlab.resilience import ConditionCheck
        >>> check = ConditionCheck(predicted=2.0, step=0.5)
        >>> check.change(0.0, 2, "a storm is forecast")
        >>> check.boundary
        3.0
        """
        self.steps = steps
        self.calm_since = time
        self.log.append(Change(time, self.boundary, reason))


class Controller(NamedTuple):
    """How the UAV is flown.

    See Also
    --------
    Monitor : chooses between `BASIC` and `ADVANCED`.

    Examples
    --------
    >>> from uavlab.resilience import ADVANCED, BASIC
    >>> BASIC
    Controller(name='basic', speed_share=1.0, natural_frequency=1.0, tilt_share=1.0)
    >>> ADVANCED
    Controller(name='advanced', speed_share=0.5, natural_frequency=1.6, tilt_share=0.8)
    """

    name: str
    speed_share: float
    """Of the cruise speed."""
    natural_frequency: float
    """ω_n of the position control [rad/s]: offsets of white gusts shrink as ω_n^(−3/2)."""
    tilt_share: float = 1.0
    """Of the greatest tilt: REPARE 2.1 reduces the pitch angle, too."""


BASIC = Controller("basic", 1.0, 1.0)
ADVANCED = Controller("advanced", 0.5, 1.6, 0.8)
"""REPARE gives no numbers; half the speed, a tighter control and four fifths of the tilt are ours."""


def basic_offset(controller: Controller) -> float:
    """How many metres the basic controller would be off where another is off by one, in white gusts.

    (ω_n/ω_basic)^(3/2)

    Parameters
    ----------
    controller : Controller
        The other one.

    Returns
    -------
    float
        1 for the basic one.

    Raises
    ------
    ValueError
        If `controller` is no Controller.

    See Also
    --------
    Monitor.observe : counts offsets with it.

    Examples
    --------
    >>> from uavlab.resilience import ADVANCED, BASIC, basic_offset
    >>> basic_offset(BASIC), round(basic_offset(ADVANCED), 2)
    (1.0, 2.02)
    """
    checks.instance("controller", controller, Controller)
    return (controller.natural_frequency / BASIC.natural_frequency) ** 1.5


@dataclass
class Monitor:
    """Watches the flight and chooses the controller (REPARE 2.1.3): quick as long as it can be, safe when it must.

    It switches to the advanced controller when the boundary of `check` plus half the body no longer fits between route
    and wall, or when the level of resilience asks for it; and back when there has been `spare` metres of room for
    `hold` seconds. The boundary is that of the basic controller: under the advanced one, which holds the UAV tighter,
    offsets count as much more, or its calm would seem the weather's, and the two would take turns.

    Attributes
    ----------
    check : ConditionCheck
        Of the offsets.
    uav_diameter : float
        D_uav [m], above 0.
    level : str
        One of `LEVELS`; "advanced" keeps the advanced controller on, "off" the basic one, "grounded" is refused.
    spare : float
        Room beyond what is needed before it switches back [m], above 0.
    hold : float
        For how long [s], above 0.
    controller : Controller
        The one that flies now.
    log : list of Change
        The switches.

    Raises
    ------
    ValueError
        If `check` is no ConditionCheck, `uav_diameter`, `spare` or `hold` is not above 0, or `level` is none of
        `LEVELS` or "grounded".

    See Also
    --------
    Monitor.observe : takes what is observed.
    uavlab.flight.Autopilot : flies with a monitor.

    Examples
    --------
    >>> from uavlab.resilience import ConditionCheck, Monitor
    >>> monitor = Monitor(ConditionCheck(predicted=2.0), uav_diameter=1.0)
    >>> clearances = {0.0: 5.0, 1.0: 2.0, 2.0: 5.0, 9.0: 5.0}  # by time: a wall is near for a second
    >>> [monitor.observe(time, 1.0, clearance).name for time, clearance in clearances.items()]
    ['basic', 'advanced', 'advanced', 'basic']
    >>> monitor
    <Monitor: basic controller, level lower, boundary 2.5 m, switches: 2>
    """

    check: ConditionCheck
    uav_diameter: float
    level: str = "lower"
    spare: float = 0.5
    hold: float = 5.0
    controller: Controller = field(init=False, default=BASIC)
    log: list[Change] = field(init=False, default_factory=list)
    roomy_since: float = field(init=False, default=np.inf)

    def __post_init__(self) -> None:
        checks.instance("check", self.check, ConditionCheck)
        checks.set_fields(self, checks.positive_number, "uav_diameter", "spare", "hold")
        checks.set_fields(self, checks.one_of, "level", known=LEVELS)
        if self.level == "grounded":
            raise ValueError("level is 'grounded': there is no flight to watch; wait, or carry less")
        if self.level == "advanced":
            self.controller = ADVANCED

    def __repr__(self) -> str:
        return (
            f"<Monitor: {self.controller.name} controller, level {self.level}, boundary {self.check.boundary:g} m, "
            f"switches: {len(self.log)}>"
        )

    def observe(self, time: float, offset: float, clearance: float) -> Controller:
        """Take what is observed at a time [s], and return the controller for the next moment.

        Parameters
        ----------
        time : float
            [s], not before the last one.
        offset : float
            How far the UAV is from its route [m], at least 0.
        clearance : float
            Of the route where the UAV is [m], at least 0; infinite where there is no wall. That of the UAV would
            count the offset twice.

        Returns
        -------
        Controller
            `BASIC` or `ADVANCED`.

        Raises
        ------
        ValueError
            If `offset` is negative or not finite, `clearance` is negative or NaN, or `time` is not finite or before the
            last one.

        See Also
        --------
        ConditionCheck.observe : the boundary that is compared with the clearance.

        Examples
        --------
        >>> from uavlab.resilience import ConditionCheck, Monitor
        >>> monitor = Monitor(ConditionCheck(predicted=2.0), uav_diameter=1.0)
        >>> monitor.observe(0.0, offset=3.2, clearance=3.5)  # 3.5 m of boundary and half the body don't fit
        Controller(name='advanced', speed_share=0.5, natural_frequency=1.6, tilt_share=0.8)
        >>> monitor.log[-1].reason
        '0.50 m short of the distance to keep'
        """
        clearance, offset = checks.number("clearance", clearance), checks.not_negative_number("offset", offset)
        if not clearance >= 0:
            raise ValueError(f"clearance must be at least 0, got {clearance!r}")
        boundary = self.check.observe(time, offset * basic_offset(self.controller))
        if self.level in ("off", "advanced"):
            return self.controller
        room = clearance - float(minimum_safe_distance(boundary, self.uav_diameter))
        if room < self.spare:
            self.roomy_since = np.inf
        elif self.roomy_since == np.inf:
            self.roomy_since = time
        if room < 0 and self.controller is BASIC:
            self.switch(time, ADVANCED, f"{-room:.2f} m short of the distance to keep")
        elif self.controller is ADVANCED and time - self.roomy_since >= self.hold:
            self.switch(time, BASIC, f"room for {self.hold:g} s")
        return self.controller

    def switch(self, time: float, controller: Controller, reason: str) -> None:
        """Change to another controller, and log it; `observe` calls this.

        Parameters
        ----------
        time : float
            [s]
        controller : Controller
            The one that flies from now on.
        reason : str
            For the log.

        Returns
        -------
        None

        See Also
        --------
        Monitor.observe : decides on it.

        Examples
        --------
        >>> from uavlab.resilience import ADVANCED, ConditionCheck, Monitor
        >>> monitor = Monitor(ConditionCheck(predicted=2.0), uav_diameter=1.0)
        >>> monitor.switch(3.0, ADVANCED, "asked by the pilot")
        >>> monitor.log
        [Change(time=3.0, value='advanced', reason='asked by the pilot')]
        """
        self.controller = controller
        self.log.append(Change(time, controller.name, reason))
