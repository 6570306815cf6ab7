"""Flying a route once, or a thousand times."""

from __future__ import annotations

import copy
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import chain
from os import PathLike

import numpy as np

from uavlab import checks
from uavlab.city import City
from uavlab.city.voxels import distance_to_obstacle
from uavlab.flight.autopilot import AUTOPILOT, PERFECT_GPS, Autopilot
from uavlab.flight.disturbance import OffsetProcess
from uavlab.flight.models import Model, model_of
from uavlab.flight.path import Path, constant_speed, planned_speed
from uavlab.flight.reference import most_steps
from uavlab.flight.results import Energy, Flight, Flights
from uavlab.flight.state import (
    ARRIVED,
    BATTERY,
    BATTERY_EMPTY,
    BLOWN_BACK,
    COLUMNS,
    CRASHED,
    FLYING,
    LEAST,
    Course,
    Obstacles,
    State,
    start_of,
)
from uavlab.resilience import ADVANCED, BASIC, Controller
from uavlab.route import Route, as_route
from uavlab.spline import Curve
from uavlab.spline.curve import contact_distance
from uavlab.sweep import sweep
from uavlab.sweep.rows import told_apart
from uavlab.vehicle import GRAVITY, UAV
from uavlab.weather import Weather, Wind
from uavlab.weather.envelope import CREEP
from uavlab.weather.turbulence import HIGHEST, LOWEST
from uavlab.weather.wind import why_grounded, wind_of

Disturbance = Wind | Weather | OffsetProcess | Callable[[float], Wind | Weather | OffsetProcess]

TIME_STEP = 0.02
LONGEST_TURN = 0.2
"""Of the time step times ω_n: beyond it the position control is no longer that of continuous time."""

LONGEST_ROUGH = 0.04
"""The same for rough offsets, see `OffsetProcess`."""

MOST_STEPS = 5e6
"""Of one flight as planned; they take some seconds, in which nothing can interrupt it."""

MOST_FLIGHTS = 1_000_000
"""In one call; each leaves some kB."""

SLOWEST_SHARE = 0.01
"""Of the cruise speed that a controller may take."""

BATCH = 100


@dataclass(frozen=True)
class Setup:
    """A question that was checked."""

    route: Route
    speed: float
    obstacles: Obstacles
    uav: UAV
    disturbance: Disturbance
    autopilot: Autopilot
    time_step: float
    altitude: float

    def model(self, now: Wind | OffsetProcess, controller: Controller, path: Path) -> Model:
        return model_of(
            now, controller, flown_by(self.uav, controller), self.autopilot, path, self.altitude, self.time_step
        )

    @cached_property
    def path(self) -> Path:
        """As planned when the flight begins."""
        return self.path_in(now_of(self.disturbance, 0.0), first_controller(self.autopilot))

    def path_in(self, now: Wind | OffsetProcess, controller: Controller) -> Path:
        """The route, as fast as a wind and a controller's tilt allow."""
        if isinstance(now, OffsetProcess):
            return constant_speed(self.route, self.speed)
        return planned_speed(self.route, flown_by(self.uav, controller), now, self.speed)


def fly(
    route: Route | Curve,
    city: City,
    uav: UAV,
    disturbance: Disturbance,
    autopilot: Autopilot = AUTOPILOT,
    *,
    rng: np.random.Generator | int,
    number: int = 0,
    time_step: float = TIME_STEP,
) -> Flight:
    """Fly a route once.

    In a `Wind` the UAV is a point mass: m a = thrust + ½ ρ C S |V_rel| V_rel − weight − rain. Its autopilot sends a
    reference along the route, no faster than turns and thrust allow, and pulls the UAV after it like a critically
    damped spring, by what GPS says; where the UAV falls behind, the reference waits. Thrust and tilt are limited,
    height first. It has arrived when it is near the goal, as far as it knows. As an `OffsetProcess` the offsets are
    simply added to a reference of constant speed, and what arrives is the reference.

    Parameters
    ----------
    route : Route or Curve
        From its first point to its last; longer than 0.
    city : City
        What can be hit.
    uav : UAV
        Its body is a ball of its diameter; it collides when that touches an obstacle. `City.ground` is one; the open
        floor of a city without it is none.
    disturbance : Wind, Weather, OffsetProcess, or callable
        What the air does, or the offsets themselves; or a function of the time [s] that returns one of these, always
        the same kind.
    autopilot : Autopilot
        Controller, speed, GPS and monitor.
    rng : numpy.random.Generator or int
        The seed of `monte_carlo`, whose flight this is.
    number : int
        Which of its flights, 0 to 999 999.
    time_step : float
        [s], above 0, at most 0.2/ω_n; 0.02 is usual.

    Returns
    -------
    Flight
        What `grounded_by` keeps on the ground is "grounded", with the reason. A UAV that can't keep up "gave up": it
        was blown back, 30 m from its reference; its battery was down to the reserve; or it ran out of time, three
        times what was planned and a minute.

    Raises
    ------
    ValueError
        If `route` doesn't arrive or has no length; `city`, `uav`, `disturbance` or `autopilot` is of another kind, or
        `disturbance` changes its kind in flight; the `speed_share` of the controller is not from 0.01 to 10; `number`
        is no whole number from 0 to 999 999; `rng` is neither generator nor seed; or `time_step` is not above 0, above
        0.2/ω_n, 0.04/ω_n for rough offsets or 1/`gps.rate` in a wind, or so short that the flight has more than
        5 million steps.

    See Also
    --------
    monte_carlo : Many flights.
    uavlab.spline.smooth : Makes a route a curve that is flown without a stop.
    uavlab.plot.in_flight : Draws how a flight went.

    Examples
    --------
    >>> from uavlab.flight import fly
    >>> from uavlab.planners import least_risk
    >>> from uavlab.risk import CAMPUS_FLIGHT, reference_campus
    >>> from uavlab.weather import Wind
    >>> campus = reference_campus()
    >>> route = least_risk(campus, *CAMPUS_FLIGHT)
    >>> fly(route, campus.city, campus.uav, Wind((6, 0)), rng=1)
    <Flight: arrived after 58.9 s>
    """
    checks.whole("number", number, least=0, most=MOST_FLIGHTS - 1)
    setup, grounded = setup_of(route, city, uav, disturbance, autopilot, time_step)
    if setup is None:
        goal = as_route(route).points[-1]
        return Flight("grounded", grounded, np.empty((0, len(COLUMNS))), np.inf, None, goal=goal)
    return flown(setup, checks.generator("rng", rng).spawn(number + 1)[number], every=1)


def monte_carlo(
    route: Route | Curve,
    city: City,
    uav: UAV,
    disturbance: Disturbance,
    autopilot: Autopilot = AUTOPILOT,
    *,
    rng: np.random.Generator | int,
    flights: int = 1000,
    every: float = 1.0,
    time_step: float = TIME_STEP,
    jobs: int | None = None,
    to: str | PathLike[str] | None = None,
    progress: bool = False,
) -> Flights:
    """Fly a route many times; each flight has a stream of random numbers of its own.

    The first hundred of a thousand flights are those of a hundred, on one core or many.

    Parameters
    ----------
    route, city, uav, disturbance, autopilot, time_step
        As for `fly`.
    rng : numpy.random.Generator or int
        Same seed, same flights.
    flights : int
        N, 1 to a million; a thousand is usual.
    every : float
        How often offsets are kept [s], above 0.
    jobs : int, optional
        Processes, see `uavlab.sweep`.
    to : str or Path, optional
        A file that keeps the flights, a hundred to a row, as for `uavlab.sweep.sweep`; not of a `disturbance` that is
        a lambda. For a UAV that stays on the ground there is none.
    progress : bool
        Show a bar.

    Returns
    -------
    Flights
        Outcomes, offsets and energy of all.

    Raises
    ------
    ValueError
        If `flights` is no whole number from 1 to a million, `every` is not above 0, `jobs` is 0 or no whole number,
        `to` is no file of these flights, `progress` is neither True nor False, or another argument is wrong as for
        `fly`.

    See Also
    --------
    fly : One of these flights with all its steps, by its number.
    crash_rate : How many of 1 000 crash, with an interval.
    uavlab.offsets.collision_probability : The same beside one wall, by theory.

    Examples
    --------
    >>> from uavlab.flight import OffsetProcess, monte_carlo
    >>> from uavlab.planners import least_risk
    >>> from uavlab.risk import CAMPUS_FLIGHT, reference_campus
    >>> campus = reference_campus()
    >>> route = least_risk(campus, *CAMPUS_FLIGHT)
    >>> monte_carlo(route, campus.city, campus.uav, OffsetProcess(1.5), rng=1, flights=100)
    <Flights: 93 arrived, 7 crashed>
    """
    flights = checks.whole("flights", flights, least=1, most=MOST_FLIGHTS)
    every = checks.positive_number("every", every)
    checks.flag("progress", progress)
    setup, grounded = setup_of(route, city, uav, disturbance, autopilot, time_step)
    if setup is None:
        none = np.zeros(flights)
        return Flights(
            outcome=np.full(flights, "grounded"),
            duration=none,
            clearance=none + np.inf,
            energy=none,
            place=np.full((flights, 3), np.nan),
            offsets=np.empty((flights, 0, 3)),
            reason=grounded,
        )
    steps = max(round(every / time_step), 1)
    generators = checks.generator("rng", rng).spawn(flights)
    cases = [
        {"setup": setup, "generators": generators[first : first + BATCH], "every": steps}
        for first in range(0, flights, BATCH)
    ]
    if to is not None:
        told_apart("disturbance", disturbance)
    unit = f"{BATCH} flights"
    batches = sweep(batch, cases, jobs=jobs, on_error="raise", to=to, progress=progress, unit=unit)
    done = chain.from_iterable(batches)
    outcome, duration, clearance, energy, place, offsets = zip(*done, strict=True)
    longest = max(len(rows) for rows in offsets)
    padded = [np.pad(rows, ((0, longest - len(rows)), (0, 0)), constant_values=np.nan) for rows in offsets]
    return Flights(
        np.array(outcome), np.array(duration), np.array(clearance), np.array(energy), np.array(place), np.array(padded)
    )


def batch(setup: Setup, generators: list[np.random.Generator], every: int) -> list[tuple]:
    """What `Flights` keeps of some flights."""
    done = []
    for generator in generators:
        flight = flown(setup, generator, every)
        last = flight.log[-1]
        battery = np.nan if flight.energy is None else flight.energy.battery
        done.append((flight.outcome, last[0], flight.clearance, battery, last[1:4], flight.log[:-1, 7:10]))
    return done


def setup_of(
    route: Route | Curve,
    city: City,
    uav: UAV,
    disturbance: Disturbance,
    autopilot: Autopilot,
    time_step: float,
) -> tuple[Setup | None, str]:
    """The question made ready for compiled code; or None, and why the UAV stays on the ground."""
    checks.instance("city", city, City)
    checks.instance("uav", uav, UAV)
    checks.instance("autopilot", autopilot, Autopilot)
    way = as_route(route)
    if not way.reached or not way.length > 0:
        raise ValueError(f"route must lead from a start to a goal{': ' * bool(way.reason)}{way.reason}")
    first = now_of(disturbance, 0.0)
    speed = uav.cruise_speed if autopilot.speed is None else float(autopilot.speed)
    time_step = checked_time_step(time_step, autopilot, first, way.length / max(speed, CREEP))
    altitude = float(np.clip(way.points[:, 2].mean() - city.origin[2], LOWEST, HIGHEST))
    if isinstance(first, Wind):
        grounded = why_grounded(flown_by(uav, first_controller(autopilot)), first, altitude)
        if grounded and autopilot.heeds_limits:
            return None, "; ".join(grounded)
    touching = contact_distance(uav.diameter)
    near_goal = autopilot.acceptance_radius if isinstance(first, Wind) else np.inf
    obstacles = Obstacles(city.occupied, city.runs, city.clearance, city.origin, city.cell, touching, near_goal)
    return Setup(way, speed, obstacles, uav, disturbance, autopilot, float(time_step), altitude), ""


def checked_time_step(time_step: float, autopilot: Autopilot, first: Wind | OffsetProcess, duration: float) -> float:
    """The time step [s], short enough for what happens in it, and long enough for a flight of this duration [s]."""
    time_step = checks.positive_number("time_step", time_step)
    controllers = [autopilot.controller] if autopilot.monitor is None else [BASIC, ADVANCED]
    for controller in controllers:
        checks.positive_number("the controller's natural_frequency", controller.natural_frequency)
        checks.within("the controller's speed_share", controller.speed_share, SLOWEST_SHARE, 10.0, "(1: as asked for)")
    fastest = max(controller.natural_frequency for controller in controllers)
    longest = {f"for a controller with ω_n = {fastest:g} rad/s": LONGEST_TURN / fastest}
    if isinstance(first, OffsetProcess) and first.rough:
        unseen = f"for rough offsets at ω_n = {fastest:g} rad/s, or crashes go unseen between the steps"
        longest[unseen] = LONGEST_ROUGH / fastest
    if isinstance(first, Wind) and autopilot.gps != PERFECT_GPS:
        longest["from one fix of gps to the next"] = 1 / autopilot.gps.rate
    for why, most in longest.items():
        if time_step > most * (1 + 1e-9):
            raise ValueError(f"time_step must be at most {most:.3g} s, {why}, got {time_step:g}")
    steps = duration / (min(controller.speed_share for controller in controllers) * time_step)
    if steps > MOST_STEPS:
        raise ValueError(
            f"time_step of {time_step:g} s makes {steps:.1g} steps of a flight of {duration:.0f} s, of which at most "
            f"{MOST_STEPS:,.0f} are made: take longer ones"
        )
    return time_step


def first_controller(autopilot: Autopilot) -> Controller:
    """With which a flight begins."""
    if autopilot.monitor is None or autopilot.strategy == "fixed":
        return autopilot.controller
    return autopilot.monitor.controller


def now_of(disturbance: Disturbance, time: float, *, like: Wind | OffsetProcess | None = None) -> Wind | OffsetProcess:
    """The disturbance at a time, of the same kind as an earlier one."""
    if isinstance(disturbance, type):
        raise ValueError(f"disturbance must be one {disturbance.__name__}, as {disturbance.__name__}(), got its class")
    now = disturbance(time) if callable(disturbance) else disturbance
    if not isinstance(now, Wind | Weather | OffsetProcess):
        raise ValueError(
            f"disturbance must be a Wind, a Weather or an OffsetProcess, or return one, got {type(now).__name__}"
        )
    now = now if isinstance(now, OffsetProcess) else wind_of(now)
    if like is not None and type(now) is not type(like):
        raise ValueError(
            f"disturbance must always return the same kind, got {type(now).__name__} at {time:g} s "
            f"after {type(like).__name__}"
        )
    return now


def flown(setup: Setup, generator: np.random.Generator, every: int) -> Flight:
    """One flight, with a row of its log every so many steps."""
    autopilot, dt = setup.autopilot, setup.time_step
    monitor = None if autopilot.strategy == "fixed" else copy.deepcopy(autopilot.monitor)
    controller = first_controller(autopilot)
    now = now_of(setup.disturbance, 0.0)
    path = setup.path
    model = setup.model(now, controller, path)
    state = start_of(path.points[0])
    longest = most_steps(path, model.pace, dt)
    most = longest + 1
    if monitor is not None or callable(setup.disturbance):
        most = max(round(autopilot.interval / dt), 1)
    logs, ending = [], ""
    while True:
        log = np.empty((most // every + 2, len(COLUMNS)))
        state.counts[1] = 0
        outcome = model.run(Course(path, setup.obstacles, dt), state, most, every, generator, log)
        logs.append(log[: state.counts[1]])
        if outcome != FLYING or ending:
            break
        time = float(state.counts[0] * dt)
        if state.counts[0] > longest:
            ending = OUT_OF_TIME
        then, advised = now_of(setup.disturbance, time, like=now), controller
        if monitor:
            seen = state.seen_position if isinstance(now, Wind) else state.position
            advised = monitor.observe(time, off_route(path, seen, state), route_clearance(setup.obstacles, state))
            if autopilot.strategy == "grounded" and advised != controller:
                ending = monitor.log[-1].reason
        if ending:
            most, every = 1, 1  # one step more, to log where
        if (then, advised) != (now, controller):
            now, controller = then, advised
            path = setup.path_in(now, controller)
            changed = setup.model(now, controller, path)
            model.hand_over(state, changed)
            model = changed
    flight_log = np.concatenate(logs)
    name, reason = ending_of(outcome, ending, flight_log[-1], path, state)
    energy = energy_of(state, setup.uav, path.points[0]) if isinstance(now, Wind) else None
    changes = monitor.log if monitor else []
    return Flight(name, reason, flight_log, float(state.sums[LEAST]), energy, changes, path.points[-1])


OUT_OF_TIME = "out of time"


def ending_of(outcome: int, ending: str, last: np.ndarray, path: Path, state: State) -> tuple[str, str]:
    """How a flight ended, and why, by what it had come to and the last row of its log."""
    where = f"after {last[0]:.1f} s at {checks.show(last[1:4])}"
    if outcome == CRASHED:
        return "crashed", f"crashed {where}"
    if outcome == ARRIVED:
        return "arrived", ""
    if outcome == BLOWN_BACK:
        return "gave up", f"blown back {where}, {behind(state):.0f} m from its reference"
    if outcome == BATTERY_EMPTY or ending == OUT_OF_TIME:
        why = "battery empty" if outcome == BATTERY_EMPTY else OUT_OF_TIME
        return "gave up", f"{why} {where}, {from_goal(path, state):.1f} m from the goal"
    return "landed", f"landed {where}: {ending}"


def flown_by(uav: UAV, controller: Controller) -> UAV:
    """A UAV with the tilt that a controller allows."""
    return uav if controller.tilt_share == 1 else replace(uav, max_tilt=controller.tilt_share * uav.max_tilt)


def energy_of(state: State, uav: UAV, start: np.ndarray) -> Energy:
    """What a flight took from the battery, and where it went."""
    battery, induced, profile, drag, wind, rain, braked = (float(value) for value in state.sums[BATTERY:])
    climb = uav.weight * float(state.position[2] - start[2])
    motion = uav.weight / GRAVITY * float(state.velocity @ state.velocity) / 2
    return Energy(battery, uav.drive_efficiency, induced, profile, drag, climb, motion, rain, wind, braked)


def behind(state: State) -> float:
    """Distance from the reference [m]."""
    return float(np.linalg.norm(state.position - state.target))


def from_goal(path: Path, state: State) -> float:
    """Distance from the goal [m]."""
    return float(np.linalg.norm(state.position - path.points[-1]))


def off_route(path: Path, seen: np.ndarray, state: State) -> float:
    """Distance from the reference across the route [m] of a place (3,), where the UAV has itself."""
    offset, direction = seen - state.target, path.direction[int(state.way[1])]
    return float(np.linalg.norm(offset - (offset @ direction) * direction))


def route_clearance(space: Obstacles, state: State) -> float:
    """Clearance of the route where the UAV is [m]."""
    point = (state.target - space.origin) / space.cell
    return float(space.cell * distance_to_obstacle(space.occupied, space.clearance, space.cell, point, 10.0))
