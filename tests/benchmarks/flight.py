"""The point mass against RotorPy's quadrotor of six degrees of freedom, printed as tables.

Both fly the same reference in the same air: position, velocity and acceleration as uavlab plans them, and one series of
wind. Both see their state without noise and pull with the same gains; RotorPy's `SE3Control` knows neither drag nor
wind, so that what uavlab's autopilot reckons with is added to the acceleration that it is told. What is left is the
body: attitude, rotors, drag. The error is the distance across the direction of flight, its mean over the flight. Run it
as `python tests/benchmarks/flight.py`, with RotorPy installed; `--quick` flies two routes with one seed.
"""

import argparse
import sys
import time
from importlib.metadata import version
from typing import Any, NamedTuple

import numpy as np
from astar import machine, print_table
from scipy.signal import lfilter

from uavlab.city import City, table1_city
from uavlab.flight import PERFECT_GPS, Autopilot, Gps, monte_carlo
from uavlab.flight.motion import PREVIEW
from uavlab.flight.reference import advance, velocity_at
from uavlab.flight.simulation import TIME_STEP, setup_of
from uavlab.flight.state import Course, start_of
from uavlab.planners import astar, repare
from uavlab.resilience import Controller
from uavlab.route import Route
from uavlab.spline import Curve, smooth
from uavlab.sweep import sweep
from uavlab.vehicle import GRAVITY, UAV
from uavlab.weather import Wind, dryden_gusts
from uavlab.weather.forces import STANDARD_AIR

SPEED = 5.0
"""Over ground [m/s]."""

ENDS = np.array([[87.5, 28.5, 57.5], [74.5, 86.5, 44.5]])

STATE_GPS = PERFECT_GPS._replace(rate=1 / TIME_STEP)
"""The state itself, each step."""

RATE = 100
"""Of RotorPy's steps [Hz], its default."""

THRUST = 2.0
"""Greatest thrust, of the weight, as usual for the size; RotorPy's hummingbird has 10.2."""

KINDS = {"calm": (0.0, ""), "3 m/s, OU": (3.0, "ou"), "6 m/s, OU": (6.0, "ou"), "6 m/s, Dryden": (6.0, "dryden")}
"""Mean wind [m/s] and gusts; OU gusts have a third of it as their σ, and τ = 1 s."""


HEADER = [
    "RotorPy with",
    "gains",
    "wind",
    "flights",
    "tumble",
    "uavlab [m]",
    "RotorPy [m]",
    "factor",
    "of single flights",
    "mean offset removed",
    "of single flights",
]


class Gains(NamedTuple):
    """Of the position control, (3,) each; `omega` is what uavlab has in their place [rad/s]."""

    name: str
    omega: float
    position: np.ndarray
    velocity: np.ndarray


def critical(omega: float) -> Gains:
    return Gains(f"ω_n = {omega:g}", omega, np.full(3, omega**2), np.full(3, 2 * omega))


THEIRS = Gains("RotorPy's; ω_n = 2.55", np.sqrt(6.5), np.array([6.5, 6.5, 15.0]), np.array([4.0, 4.0, 9.0]))


class Reference(NamedTuple):
    """Where the UAV should be, a row each time step, (T, 3) each."""

    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray


class Sky(NamedTuple):
    """One realisation of the air: its velocity in each time step (T, 3), and its mean (3,) [m/s]."""

    kind: str
    air: np.ndarray
    mean: np.ndarray


class Quadrotor(NamedTuple):
    """RotorPy's vehicle, and what it is flown with."""

    parameters: dict[str, Any]
    attitude_gain: float = 1.0
    """Of the natural frequency of its attitude control."""
    along: bool = False
    """Whether it yaws into the direction of flight."""
    knows_drag: bool = True


def hummingbird() -> dict[str, Any]:
    """RotorPy's, with rotors that lift `THRUST` times its weight."""
    from rotorpy.vehicles.hummingbird_params import quad_params

    return {**quad_params, "rotor_speed_max": np.sqrt(THRUST) * hover(quad_params)}


def level_drag(parameters: dict[str, Any], speed: float) -> float:
    """Drag of RotorPy's vehicle, level and with the rotors at hover [N]."""
    from rotorpy.vehicles.multirotor import Multirotor

    force, _ = Multirotor(parameters).compute_body_wrench(
        np.zeros(3), np.full(4, hover(parameters)), np.array([speed, 0.0, 0.0])
    )
    return -float(force[0])


def hover(parameters: dict[str, Any]) -> float:
    """Rotor speed at hover [rad/s]."""
    return float(np.sqrt(parameters["mass"] * GRAVITY / 4 / parameters["k_eta"]))


def point_mass_of(parameters: dict[str, Any]) -> UAV:
    """uavlab's UAV of the same mass, thrust and size, and the same drag at `SPEED`; its tilt is all but free."""
    return UAV(
        mass=parameters["mass"],
        thrust=4 * parameters["k_eta"] * parameters["rotor_speed_max"] ** 2,
        drag_area=level_drag(parameters, SPEED) / (0.5 * STANDARD_AIR * SPEED**2),
        rain_area=0.1,
        diameter=0.54,
        cruise_speed=SPEED,
        top_speed=20.0,
        max_tilt=np.radians(80.0),
        name="hummingbird",
    )


def with_drag_of(uav: UAV, parameters: dict[str, Any]) -> dict[str, Any]:
    """RotorPy's vehicle with the drag of the point mass, the same on all axes, and none on its rotors."""
    drag = 0.5 * STANDARD_AIR * uav.drag_area
    return {**parameters, "c_Dx": drag, "c_Dy": drag, "c_Dz": drag, "k_d": 0.0, "k_z": 0.0, "k_h": 0.0}


def empty_sky() -> City:
    """Nothing to run into: what is compared is where it flies."""
    return City(np.zeros((40, 40, 40), bool), 10.0, origin=(-150.0, -150.0, -150.0))


def routes_of(uav: UAV) -> dict[str, Route | Curve]:
    city = table1_city()
    planned = repare(city, *ENDS)
    return {
        "straight": Route(np.array([[15.0, 20.0, 30.0], [75.0, 50.0, 30.0]])),
        "A*": astar(city, *ENDS),
        "REPARE": planned,
        "REPARE, smooth": smooth(planned, city, uav),
    }


def reference_of(route: Route | Curve, uav: UAV) -> Reference:
    """What uavlab's autopilot follows: its own steps, and its own way to look ahead for the acceleration."""
    setup, _ = setup_of(route, empty_sky(), uav, Wind(gusts="none"), Autopilot(), TIME_STEP)
    assert setup is not None
    path, rows = setup.path, []
    state = start_of(path.points[0])
    velocity, ahead, back = np.empty(3), np.empty(3), np.empty(3)
    while state.way[0] < path.distance[-1]:
        speed = advance(path, state, TIME_STEP if rows else 0.0, velocity)
        velocity_at(path, state, speed * PREVIEW, ahead)
        velocity_at(path, state, -speed * PREVIEW, back)
        rows.append((state.target.copy(), velocity.copy(), (ahead - back) / (2 * PREVIEW)))
    return Reference(*np.array(rows).swapaxes(0, 1))


def sky_of(kind: str, steps: int, seed: int) -> Sky:
    """Wind from a random direction, with gusts; vertical OU gusts have half the σ."""
    speed, gusts = KINDS[kind]
    rng = np.random.default_rng(seed)
    east, north = np.array([np.cos(turn := rng.uniform(0, 2 * np.pi)), np.sin(turn)])
    mean = speed * np.array([east, north, 0.0])
    air = np.zeros((steps, 3))
    if gusts == "ou":
        keep = np.exp(-TIME_STEP)
        noise = np.sqrt(1 - keep**2) * rng.standard_normal((steps, 3))
        noise[0] /= np.sqrt(1 - keep**2)
        air = speed / 3 * np.array([1.0, 1.0, 0.5]) * lfilter([1.0], [1.0, -keep], noise, axis=0)
    elif gusts == "dryden":
        met = dryden_gusts(steps * TIME_STEP, TIME_STEP, np.hypot(speed, SPEED), 30.0, speed, rng)[:steps]
        air = met @ np.array([[east, north, 0.0], [-north, east, 0.0], [0.0, 0.0, 1.0]])
    return Sky(kind, air + mean, mean)


def point_mass(
    route: Route | Curve, uav: UAV, omega: float, sky: Sky, trimmed: bool, gps: Gps = STATE_GPS
) -> np.ndarray:
    """The flight of uavlab's point mass in that air, (T, 3) [m]."""
    autopilot = Autopilot(Controller("", 1.0, omega), trimmed=trimmed, gps=gps)
    setup, _ = setup_of(route, empty_sky(), uav, Wind(gusts="none"), autopilot, TIME_STEP)
    assert setup is not None
    path, rng, log = setup.path, np.random.default_rng(0), np.empty((2, 12))
    state = start_of(path.points[0])
    model = setup.model(Wind(tuple(sky.mean), "none"), autopilot.controller, path)
    flight = []
    for velocity in sky.air:
        model.parts[1].mean[:] = velocity  # the air moves so in this step; the trim stays that of the mean wind
        state.counts[1] = 0
        model.run(Course(path, setup.obstacles, TIME_STEP), state, 1, 1, rng, log)
        flight.append(log[0, 1:4].copy())
    return np.array(flight)


def told(parameters: dict[str, Any], reference: Reference, sky: Sky, trimmed: bool) -> np.ndarray:
    """Acceleration against the drag that the vehicle has when level, (T, 3) [m/s²]; so does uavlab's autopilot."""
    from rotorpy.vehicles.multirotor import Multirotor

    vehicle, rotors = Multirotor(parameters), np.full(4, hover(parameters))
    still = vehicle.compute_body_wrench(np.zeros(3), rotors, np.zeros(3))[0]
    met = reference.velocity - trimmed * sky.mean
    force = [vehicle.compute_body_wrench(np.zeros(3), rotors, velocity)[0] - still for velocity in met]
    return -np.array(force) / parameters["mass"]


class Trajectory:
    """The reference as RotorPy asks for it."""

    def __init__(self, reference: Reference, push: np.ndarray, along: bool) -> None:
        self.position, self.velocity = reference.position, reference.velocity
        self.acceleration = reference.acceleration + push
        heading = np.unwrap(np.arctan2(self.velocity[:, 1], self.velocity[:, 0]))
        self.yaw = heading if along else np.zeros(len(heading))

    def update(self, t: float) -> dict[str, Any]:
        last = len(self.position) - 1
        at = min(t / TIME_STEP, float(last))
        row = min(int(at + 1e-9), last - 1)
        part = at - row

        def between(values: np.ndarray) -> Any:
            return (1 - part) * values[row] + part * values[row + 1]

        zero = np.zeros(3)
        return {
            "x": between(self.position),
            "x_dot": between(self.velocity),
            "x_ddot": between(self.acceleration),
            "x_dddot": zero,
            "x_ddddot": zero,
            "yaw": between(self.yaw),
            "yaw_dot": 0.0,
            "yaw_ddot": 0.0,
        }


class Recorded:
    """A series of wind as RotorPy asks for it: with the time at which a step ends."""

    def __init__(self, air: np.ndarray) -> None:
        self.air = air

    def update(self, t: float, position: np.ndarray) -> np.ndarray:
        return self.air[min(max(int(np.ceil(t / TIME_STEP - 1e-6)) - 1, 0), len(self.air) - 1)]


def quadrotor_parts(
    quadrotor: Quadrotor, gains: Gains, reference: Reference, sky: Sky, push: np.ndarray
) -> dict[str, Any]:
    """Vehicle, controller, trajectory and wind, as RotorPy's `Environment` takes them."""
    from rotorpy.controllers.quadrotor_control import SE3Control
    from rotorpy.vehicles.multirotor import Multirotor

    state = {
        "x": reference.position[0].copy(),
        "v": np.zeros(3),
        "q": np.array([0.0, 0.0, 0.0, 1.0]),
        "w": np.zeros(3),
        "wind": np.zeros(3),
        "rotor_speeds": np.full(4, hover(quadrotor.parameters)),
    }
    controller = SE3Control(quadrotor.parameters)
    controller.kp_pos, controller.kd_pos = gains.position, gains.velocity
    controller.kp_att *= quadrotor.attitude_gain**2
    controller.kd_att *= quadrotor.attitude_gain
    return {
        "vehicle": Multirotor(quadrotor.parameters, initial_state=state),
        "controller": controller,
        "trajectory": Trajectory(reference, push * quadrotor.knows_drag, quadrotor.along),
        "wind_profile": Recorded(sky.air),
    }


def six_dof(parts: dict[str, Any], steps: int, rate: int = RATE) -> tuple[np.ndarray, bool]:
    """The flight of RotorPy's quadrotor, a row each of uavlab's time steps, (T, 3) [m]; whether it turned over.

    What its `simulate` does, without the sensors and the estimator that nobody listens to.
    """
    vehicle, controller = parts["vehicle"], parts["controller"]
    state, each, flight, over = vehicle.initial_state, round(rate * TIME_STEP), [], False
    for step in range(steps * each):
        if step % each == 0:
            flight.append(state["x"])
            over |= bool(np.hypot(*state["q"][:2]) > np.sqrt(0.5))  # the rotors' axis below the horizon
        now = step / rate
        control = controller.update(now, state, parts["trajectory"].update(now))
        state["wind"] = parts["wind_profile"].update(now + 1 / rate, state["x"])
        state = vehicle.step(state, control, 1 / rate)
    return np.array(flight), over


def across(reference: Reference, flight: np.ndarray, centred: bool = False) -> float:
    """Mean distance across the direction of flight [m]; centred: once the mean offset is taken away."""
    offset = flight - reference.position
    if centred:
        offset = offset - offset.mean(axis=0)
    direction = reference.velocity / np.linalg.norm(reference.velocity, axis=1, keepdims=True)
    offset = offset - (offset * direction).sum(axis=1, keepdims=True) * direction
    return float(np.linalg.norm(offset, axis=1).mean())


def compare(
    route: Route | Curve,
    uav: UAV,
    quadrotor: Quadrotor,
    gains: Gains,
    kind: str,
    seed: int,
    trimmed: bool,
    gps: Gps = STATE_GPS,
    rate: int = RATE,
) -> np.ndarray:
    """Errors of the point mass and of the quadrotor, and the same centred, (2, 2) [m]; NaN if the quadrotor tumbles."""
    reference = reference_of(route, uav)
    steps = len(reference.position)
    sky = sky_of(kind, steps, seed)
    parts = quadrotor_parts(quadrotor, gains, reference, sky, told(quadrotor.parameters, reference, sky, trimmed))
    flight, over = six_dof(parts, steps, rate)
    if over:
        return np.full((2, 2), np.nan)
    flights = point_mass(route, uav, gains.omega, sky, trimmed, gps), flight
    return np.array([[across(reference, flight, centred) for flight in flights] for centred in (False, True)])


def factor(errors: np.ndarray) -> list[str]:
    """Columns for errors (N, 2): means, the factor between them, and between single flights that have an error."""
    if not len(errors):
        return [""] * 4
    ours, theirs = errors.mean(axis=0)
    each = np.divide(*errors[errors[:, 0] > 1e-3].T[::-1])  # a straight line in calm air has none
    return [f"{ours:.3f}", f"{theirs:.3f}", f"{theirs / ours:.2f}", f"{each.min():.2f} to {each.max():.2f}"]


def matrix(uav: UAV, routes: dict[str, Route | Curve], seeds: int, jobs: int) -> None:
    """All routes and winds, by drag, gains, and what the autopilot knows."""
    parameters = hummingbird()
    bodies = {"same drag": with_drag_of(uav, parameters), "its own drag": parameters}
    for title, trimmed, chosen in (
        ("Neither autopilot knows the wind", False, (critical(1.0), critical(1.6), THEIRS)),
        ("Both know the mean wind", True, (critical(1.6),)),
    ):
        rows = []
        for body, of_body in bodies.items():
            for gains in chosen:
                for kind, (wind, _) in KINDS.items():
                    if trimmed and not wind:
                        continue
                    cases = [
                        {
                            "route": route,
                            "uav": uav,
                            "quadrotor": Quadrotor(of_body),
                            "gains": gains,
                            "kind": kind,
                            "seed": seed,
                            "trimmed": trimmed,
                        }
                        for number, route in enumerate(routes.values())
                        for seed in (range(number * seeds, (number + 1) * seeds) if wind else [0])
                    ]
                    errors = np.array(sweep(compare, cases, jobs=jobs, on_error="raise", progress=False))
                    tumbled = np.isnan(errors[:, 0, 0])
                    kept, centred = factor(errors[~tumbled, 0]), factor(errors[~tumbled, 1])
                    row = [body, gains.name, kind, str(len(cases)), str(tumbled.sum()), *kept, *centred[2:]]
                    rows.append(row)
                    print(" | ".join(row), file=sys.stderr)
        print_table(title, HEADER, rows)


def reasons(uav: UAV, route: Route | Curve, seeds: int, jobs: int, kind: str = "6 m/s, OU") -> None:
    """One thing changed at a time."""
    parameters = hummingbird()
    plain = with_drag_of(uav, parameters)
    rotors = {**plain, "c_Dx": parameters["c_Dx"], "c_Dy": parameters["c_Dy"], "c_Dz": parameters["c_Dx"]}
    rotors["k_d"] = rotors["k_z"] = parameters["k_d"]
    weak = {"rotor_speed_max": np.sqrt(1.2) * hover(parameters)}
    changes: dict[str, dict[str, Any]] = {
        "nothing: the same drag": {},
        "RotorPy at 200 Hz": {"rate": 200},
        "uavlab sees itself at 10 Hz": {"gps": PERFECT_GPS},
        "attitude control half as fast": {"quadrotor": Quadrotor(plain, attitude_gain=0.5)},
        "attitude control a quarter as fast": {"quadrotor": Quadrotor(plain, attitude_gain=0.25)},
        "motors of 50 ms instead of 5": {"quadrotor": Quadrotor({**plain, "tau_m": 0.05})},
        "yaw into the direction of flight": {"quadrotor": Quadrotor(plain, along=True)},
        "thrust 1.2 times the weight, both": {
            "quadrotor": Quadrotor({**plain, **weak}),
            "uav": point_mass_of({**parameters, **weak}),
        },
        "SE3Control as it is: knows no drag": {"quadrotor": Quadrotor(plain, knows_drag=False)},
        "rotor drag, linear in speed": {"quadrotor": Quadrotor(rotors)},
        "and its inflow along the rotors' axis": {"quadrotor": Quadrotor({**rotors, "k_z": parameters["k_z"]})},
        "all its own drag, with translational lift": {"quadrotor": Quadrotor(parameters)},
    }
    common = {
        "route": route,
        "uav": uav,
        "quadrotor": Quadrotor(plain),
        "gains": critical(1.6),
        "kind": kind,
        "trimmed": True,
    }
    cases = [{**common, **change, "seed": seed} for change in changes.values() for seed in range(seeds)]
    errors = np.array(sweep(compare, cases, jobs=jobs, on_error="raise", progress=False)).reshape(
        len(changes), seeds, 2, 2
    )
    rows = []
    for name, each in zip(changes, errors, strict=True):
        kept = each[np.isfinite(each[:, 0, 0])]
        rows.append([name, str(len(each) - len(kept)), *factor(kept[:, 0])[:3], factor(kept[:, 1])[2]])
    header = ["changed", "tumble", "uavlab [m]", "RotorPy [m]", "factor", "mean offset removed"]
    print_table(f"What makes a difference: {kind}, mean wind known, ω_n = 1.6", header, rows)


def pace(uav: UAV, route: Route | Curve, flights: int) -> None:
    """Flights a second on one core, and how long ten thousand take."""
    seconds = clocked_flights(uav, route, flights, 3)
    medians = {name: float(np.median(times)) for name, times in seconds.items()}
    rows = [
        [name, f"{1e3 * median:.3g}", f"{1 / median:.3g}", f"{median / medians['uavlab']:.0f}"]
        for name, median in medians.items()
    ]
    header = ["", "time a flight [ms]", "flights a second", "times ours"]
    print_table("Pace: flights of one route, one core", header, rows)
    began, clock = time.process_time(), time.perf_counter()
    arrived = flown(uav, route, 100 * flights)
    used, passed = time.process_time() - began, time.perf_counter() - clock
    print(f"\n{100 * flights} such flights: {used:.1f} s of one core, {passed:.1f} s on the clock; {arrived} arrive")


def flown(uav: UAV, route: Route | Curve, count: int) -> int:
    """How many of our flights in gusts arrive."""
    wind, autopilot = Wind((6.0, 0.0), "ou", 2.0), Autopilot(Controller("", 1.0, 1.6))
    runs = monte_carlo(route, table1_city(), uav, wind, autopilot, rng=0, flights=count, jobs=1)
    return int((runs.outcome == "arrived").sum())


def clocked_flights(uav: UAV, route: Route | Curve, flights: int, times: int) -> dict[str, list[float]]:
    """Processor time of a flight [s] of each contender, so often; ours is the mean of so many flights."""
    from rotorpy.environments import Environment

    reference, gains = reference_of(route, uav), critical(1.6)
    steps = len(reference.position)
    sky = sky_of("6 m/s, OU", steps, 0)
    push = told(hummingbird(), reference, sky, True)

    def peer() -> dict[str, Any]:
        return quadrotor_parts(Quadrotor(hummingbird()), gains, reference, sky, push)

    flown(uav, route, 1)  # compiles
    seconds: dict[str, list[float]] = {"uavlab": [], "RotorPy, bare loop": [], "RotorPy, Environment.run": []}
    for _ in range(times):
        for name, run, count in (
            ("uavlab", lambda: flown(uav, route, flights), flights),
            ("RotorPy, bare loop", lambda: six_dof(peer(), steps), 1),
            ("RotorPy, Environment.run", lambda: Environment(**peer(), sim_rate=RATE).run(steps * TIME_STEP), 1),
        ):
            began = time.process_time()
            run()
            seconds[name].append((time.process_time() - began) / count)
    return seconds


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=1, help="of each wind and route")
    parser.add_argument("--jobs", type=int, default=2, help="processes, but for the pace")
    parser.add_argument("--quick", action="store_true", help="two routes, one seed")
    parser.add_argument("--only", choices=("matrix", "reasons", "pace"), help="one part of it")
    options = parser.parse_args()
    packages = ("numpy", "numba", "scipy", "rotorpy")
    versions = ", ".join(f"{package} {version(package)}" for package in packages)
    print(f"{next(machine())}, Python {sys.version.split()[0]}, {versions}")
    uav = point_mass_of(hummingbird())
    routes = routes_of(uav)
    if options.quick:
        options.seeds = 1
        routes = {name: routes[name] for name in ("straight", "REPARE, smooth")}
    if options.only in (None, "matrix"):
        matrix(uav, routes, options.seeds, options.jobs)
    if options.only in (None, "reasons"):
        reasons(uav, routes["REPARE, smooth"], options.seeds, options.jobs)
    if options.only in (None, "pace"):
        pace(uav, routes_of(uav)["REPARE"], 10 if options.quick else 100)


if __name__ == "__main__":
    main()
