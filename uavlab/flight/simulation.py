"""Flying a route once, or a thousand times."""

import copy
from collections.abc import Callable
from itertools import chain
from typing import NamedTuple

import numpy as np

from uavlab import checks
from uavlab.city import City
from uavlab.city.voxels import distance_to_obstacle
from uavlab.flight.autopilot import AUTOPILOT, Autopilot
from uavlab.flight.disturbance import OffsetProcess, Wind
from uavlab.flight.models import Model, model_of
from uavlab.flight.motion import ARRIVED, BLOWN_BACK, COLUMNS, CRASHED, FLYING, Space, State, steps_to_goal
from uavlab.flight.path import Path, constant_speed, planned_speed, why_grounded
from uavlab.flight.results import Flight, Flights
from uavlab.resilience import ADVANCED, BASIC, Controller
from uavlab.route import Route
from uavlab.spline import Curve
from uavlab.spline.curve import CONTACT
from uavlab.sweep import sweep
from uavlab.vehicle import UAV
from uavlab.weather.turbulence import HIGHEST, LOWEST

Disturbance = Wind | OffsetProcess | Callable[[float], Wind | OffsetProcess]

TIME_STEP = 0.02
LONGEST_TURN = 0.2
"""Of the time step times ω_n: beyond it the position control is no longer that of continuous time."""

EFFICIENCY = 0.5
"""Share of the battery's power that moves air: rotors about 0.7, motors and their control about 0.75."""

PATIENCE, PAUSE = 3.0, 60.0
"""A flight is out of time after so many times the planned duration, and so many seconds more."""

BATCH = 100


class Setup(NamedTuple):
    """A question that was checked."""

    route: Route
    speed: float
    path: Path
    """As planned in the first wind."""
    space: Space
    uav: UAV
    disturbance: Disturbance
    autopilot: Autopilot
    time_step: float
    altitude: float

    def model(self, now: Wind | OffsetProcess, controller: Controller, path: Path) -> Model:
        return model_of(now, controller, self.uav, self.autopilot, path, self.altitude, self.time_step)

    def path_in(self, now: Wind | OffsetProcess) -> Path:
        """The same route as fast as another wind allows."""
        return planned_speed(self.route, self.uav, now, self.speed) if isinstance(now, Wind) else self.path


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
    height first. It has arrived when it is near the goal. As an `OffsetProcess` the offsets are simply added to a
    reference of constant speed, and what arrives is the reference.

    Parameters
    ----------
    route : Route or Curve
    city : City
    uav : UAV
        Its body is a ball of its diameter; it collides when that touches an obstacle. `City.ground` is one; the open
        floor of a city without it is none.
    disturbance : Wind, OffsetProcess, or callable
        Or a function of the time [s] that returns one of these, always the same kind.
    autopilot : Autopilot
    rng : numpy.random.Generator or int
        The seed of `monte_carlo`, whose flight this is.
    number : int
        Which of its flights.
    time_step : float
        [s], at most 0.2/ω_n.

    Returns
    -------
    Flight
        Wind above what the thrust can hold gives `outcome` "grounded" with the margin in `reason`. A UAV that can't
        keep up "gave up": it was blown back, 30 m from its reference, or ran out of time, three times what was planned
        and a minute.

    Raises
    ------
    ValueError
        If the route doesn't arrive, the time step is too long for the controller, or another argument is out of its
        range.
    """
    checks.whole("number", number, least=0)
    setup, grounded = setup_of(route, city, uav, disturbance, autopilot, time_step)
    if setup is None:
        return Flight("grounded", grounded, np.empty((0, len(COLUMNS))), np.inf, 0.0)
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
        N, at least 1.
    every : float
        How often offsets are kept [s].
    jobs : int, optional
        Processes, see `uavlab.sweep`.
    progress : bool
        Show a bar.

    Returns
    -------
    Flights

    Raises
    ------
    ValueError
        As for `fly`.
    """
    checks.whole("flights", flights, least=1)
    checks.positive_number("every", every)
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
    done = chain.from_iterable(sweep(batch, cases, jobs=jobs, progress=progress, unit=f"{BATCH} flights"))
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
        done.append((flight.outcome, last[0], flight.clearance, flight.energy, last[1:4], flight.log[:-1, 7:10]))
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
    way = route.route() if isinstance(route, Curve) else route
    checks.instance("route", way, Route)
    if not way.reached or not way.length > 0:
        raise ValueError(f"route must lead from a start to a goal{': ' * bool(way.reason)}{way.reason}")
    checks.positive_number("time_step", time_step)
    controllers = [autopilot.controller] if autopilot.monitor is None else [BASIC, ADVANCED]
    fastest = max(controller.natural_frequency for controller in controllers)
    if time_step * fastest > LONGEST_TURN * (1 + 1e-9):
        raise ValueError(
            f"time_step must be at most {LONGEST_TURN / fastest:.3g} s for a controller with ω_n = {fastest:g} rad/s, "
            f"got {time_step:g}"
        )
    first = now_of(disturbance, 0.0)
    speed = uav.cruise_speed if autopilot.speed is None else float(autopilot.speed)
    if isinstance(first, Wind):
        grounded = why_grounded(way, uav, first)
        if grounded:
            return None, grounded
        path = planned_speed(way, uav, first, speed)
    else:
        path = constant_speed(way, speed)
    touching = (1 - CONTACT) * uav.diameter / 2
    near_goal = autopilot.acceptance_radius if isinstance(first, Wind) else np.inf
    space = Space(city.occupied, city.runs, city.clearance, city.origin, city.cell, touching, near_goal)
    altitude = float(np.clip(way.points[:, 2].mean() - city.origin[2], LOWEST, HIGHEST))
    return Setup(way, speed, path, space, uav, disturbance, autopilot, float(time_step), altitude), ""


def now_of(disturbance: Disturbance, time: float) -> Wind | OffsetProcess:
    """The disturbance at a time."""
    now = disturbance(time) if callable(disturbance) else disturbance
    if not isinstance(now, Wind | OffsetProcess):
        raise ValueError(f"disturbance must be a Wind or an OffsetProcess, or return one, got {type(now).__name__}")
    return now


def flown(setup: Setup, generator: np.random.Generator, every: int) -> Flight:
    """One flight, with a row of its log every so many steps."""
    autopilot, dt = setup.autopilot, setup.time_step
    monitor = None if autopilot.strategy == "fixed" else copy.deepcopy(autopilot.monitor)
    controller = monitor.controller if monitor else autopilot.controller
    now, path = now_of(setup.disturbance, 0.0), setup.path
    model = setup.model(now, controller, path)
    state = start_of(setup)
    most = planned = steps_to_goal(path, model.pace, dt)
    if monitor is not None or callable(setup.disturbance):
        most = max(round(autopilot.interval / dt), 1)
    longest = PATIENCE * planned + PAUSE / dt
    logs, ending = [], ""
    while True:
        log = np.empty((most // every + 2, len(COLUMNS)))
        state.counts[1] = 0
        outcome = model.run(path, setup.space, state, dt, most, every, generator, log)
        logs.append(log[: state.counts[1]])
        if outcome != FLYING or ending:
            break
        time = float(state.counts[0] * dt)
        if state.counts[0] > longest:
            ending = "out of time"
        then, advised = now_of(setup.disturbance, time), controller
        if type(then) is not type(now):
            raise ValueError(
                f"disturbance must always return the same kind, got {type(then).__name__} at {time:g} s "
                f"after {type(now).__name__}"
            )
        if monitor:
            advised = monitor.observe(time, off_route(path, state), room(setup.space, state))
            if autopilot.strategy == "grounded" and advised != controller:
                ending = "landed"
        if ending:
            most, every = 1, 1  # one step more, to log where
        if (then, advised) != (now, controller):
            path = setup.path_in(then) if then != now else path
            now, controller = then, advised
            changed = setup.model(now, controller, path)
            model.hand_over(state, changed)
            model = changed
    flight_log = np.concatenate(logs)
    where = f"after {flight_log[-1, 0]:.1f} s at {checks.show(flight_log[-1, 1:4])}"
    energy = np.nan
    if isinstance(now, Wind):
        energy = float(state.sums[1] / EFFICIENCY)
    changes = monitor.log if monitor else []
    if outcome == CRASHED:
        name, reason = "crashed", f"crashed {where}"
    elif outcome == ARRIVED:
        name, reason = "arrived", ""
    elif outcome == BLOWN_BACK:
        name, reason = "gave up", f"blown back {where}, {behind(state):.0f} m from its reference"
    elif ending == "out of time":
        left = float(np.linalg.norm(state.position - path.points[-1]))
        name, reason = "gave up", f"out of time {where}, {left:.1f} m from the goal"
    else:
        name, reason = "landed", f"landed {where}: {changes[-1].reason}"
    return Flight(name, reason, flight_log, float(state.sums[0]), energy, changes)


def start_of(setup: Setup) -> State:
    """At the start of the route, at rest, in still air."""
    position = setup.path.points[0].copy()
    return State(
        position=position,
        before=position.copy(),
        velocity=np.zeros(3),
        target=position.copy(),
        seen_position=position.copy(),
        seen_velocity=np.zeros(3),
        lags=np.zeros((3, 2)),
        gust=np.zeros(3),
        heading=np.array([1.0, 0.0]),
        way=np.zeros(2),
        sums=np.array([np.inf, 0.0, np.inf]),
        counts=np.zeros(2, dtype=np.int64),
    )


def behind(state: State) -> float:
    """Distance from the reference [m]."""
    return float(np.linalg.norm(state.position - state.target))


def off_route(path: Path, state: State) -> float:
    """Distance from the reference across the route [m]."""
    offset, direction = state.position - state.target, path.direction[int(state.way[1])]
    return float(np.linalg.norm(offset - (offset @ direction) * direction))


def room(space: Space, state: State) -> float:
    """Clearance of the route where the UAV is [m]."""
    point = (state.target - space.origin) / space.cell
    return float(space.cell * distance_to_obstacle(space.occupied, space.clearance, space.cell, point, 10.0))
