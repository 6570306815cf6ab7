"""What disturbs a flight: wind with gusts, as a force on a body; or offsets themselves, as REPARE has them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.flight.autopilot import checked_controller
from uavlab.offsets.exposure import spring_transition
from uavlab.resilience import BASIC, Controller, basic_offset
from uavlab.vehicle import GRAVITY, UAV
from uavlab.weather import Weather
from uavlab.weather.wind import Wind, gust_spectrum, wind_of


@dataclass(frozen=True)
class OffsetProcess:
    """Offsets from the route as REPARE has them, without a body: a damped spring that white noise shakes.

    x″ + 2 ω_n x′ + ω_n² x = noise on each axis, around a mean. It knows neither thrust nor tilt limits, and the UAV
    keeps its speed.

    Attributes
    ----------
    sigma : float or (3,)
        σ east, north and up under the basic controller [m], at least 0; 0.5 to 2 is usual. Under one with another ω_n
        it is σ·ω_n^(−3/2).
    mean : (2,) or (3,)
        μ east, north and up [m].
    rough : bool
        An Ornstein-Uhlenbeck process with the same σ and correlation time, which is beyond its σ again and again. Its
        path has no speed, so the finer the time steps, the more often it is seen to touch a wall: of 8 000 flights of
        8 s, 3σ from a wall, 44 per 1 000 crash in steps of 5 to 20 ms, 35 in steps of 50 ms, 27 of 200 ms, at
        ω_n = 1 rad/s. So a flight takes steps of at most 0.04/ω_n.

    Raises
    ------
    ValueError
        If `sigma` is negative, not finite or neither one number nor three, `mean` is not two or three finite numbers,
        or `rough` is neither True nor False.

    See Also
    --------
    uavlab.offsets.offset_paths : The same process on one axis, as paths over time.
    uavlab.weather.Wind : Gusts as a force on a body, the other kind of disturbance.

    References
    ----------
    G. E. Uhlenbeck and L. S. Ornstein, On the Theory of the Brownian Motion, Physical Review, 1930.

    Examples
    --------
    σ of one metre, and a steady wind that holds the UAV half a metre to the east of its route:

    >>> from uavlab.flight import OffsetProcess
    >>> OffsetProcess(1.0, mean=(0.5, 0.0))
    OffsetProcess(sigma=1.0, mean=(0.5, 0.0, 0.0), rough=False)
    """

    sigma: float | tuple[float, ...] = 1.0
    mean: tuple[float, ...] = (0.0, 0.0, 0.0)
    rough: bool = False

    def __post_init__(self) -> None:
        sigma = checks.numbers("sigma", self.sigma)
        if sigma.shape not in ((), (3,)):
            raise ValueError(f"sigma must be one number or three (east, north, up), got shape {sigma.shape}")
        checks.not_negative("sigma", sigma)
        object.__setattr__(self, "sigma", tuple(sigma.tolist()) if sigma.shape else float(sigma))
        checks.set_fields(self, checks.three, "mean")
        checks.set_fields(self, checks.flag, "rough")

    def step(self, time_step: float, controller: Controller) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """How offset and speed go on in a time step, exactly for any step.

        s(t + Δt) = A s(t) + B n, where s holds the offset in units of σ and the speed in units of ω_n σ, and n two
        independent standard normal numbers.

        Parameters
        ----------
        time_step : float
            Δt [s], above 0; 0.02 is usual.
        controller : Controller
            Its ω_n is the spring's.

        Returns
        -------
        sigma : (3,) array
            σ east, north and up under this controller [m].
        transition : (2, 2) array
            A
        noise : (2, 2) array
            B

        Raises
        ------
        ValueError
            If `time_step` is not above 0, or `controller` is no `Controller`.

        See Also
        --------
        fly : Takes such steps along a route.

        Examples
        --------
        >>> from uavlab.flight import OffsetProcess
        >>> from uavlab.resilience import ADVANCED
        >>> sigma, transition, noise = OffsetProcess(1.0).step(0.02, ADVANCED)
        >>> sigma.round(3)  # the advanced controller holds the UAV tighter [m]
        array([0.494, 0.494, 0.494])
        >>> transition.round(3)
        array([[ 0.999,  0.031], [-0.031,  0.938]])
        """
        return stepped(self, checks.positive_number("time_step", time_step), checked_controller(controller))


def stepped(
    process: OffsetProcess, time_step: float, controller: Controller
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """`OffsetProcess.step` of what was checked."""
    turn = controller.natural_frequency * time_step
    if process.rough:  # no speed
        keep = np.exp(-turn / 2)
        transition, noise = np.diag([keep, 0.0]), np.diag([np.sqrt(1 - keep**2), 0.0])
    else:
        transition = spring_transition(turn)
        noise = np.linalg.cholesky(np.eye(2) - transition @ transition.T)
    return np.broadcast_to(process.sigma, 3) / basic_offset(controller), transition, noise


def offset_sigma(
    uav: UAV,
    wind: Wind | Weather,
    *,
    ground_velocity: npt.ArrayLike = (0.0, 0.0, 0.0),
    altitude: float = 30.0,
    controller: Controller = BASIC,
) -> np.ndarray:
    """σ of the offsets that gusts should cause, when they are small: theory for what `fly` does.

    Drag grows with V², so that a gust along the air stream weighs ρ C S V, twice as much as one across. The position
    control is a second-order system: σ² = ∫ S(ω) |H(ω)|² dω, H = 1/(ω_n² − ω² + 2iω_n ω + iωd), where the drag itself
    damps with d per second.

    Parameters
    ----------
    uav : UAV
        Its mass and drag area count.
    wind : Wind or Weather
        Its mean and gusts.
    ground_velocity : (2,) or (3,) array
        Of the UAV [m/s]; it hovers by default.
    altitude : float
        For Dryden gusts, 3 to 300 [m].
    controller : Controller
        Its ω_n counts.

    Returns
    -------
    (3,) array
        σ along the air stream, across it and up [m].

    Raises
    ------
    ValueError
        If `uav`, `wind` or `controller` is of another kind; `ground_velocity` is not two or three finite numbers, or
        that of the wind, so that the air stands still relative to the UAV and small gusts have no force; or
        `altitude` is not above 0, or, for Dryden gusts, out of its range.

    See Also
    --------
    fly : What it predicts.
    uavlab.weather.gust_spectrum : S(ω) of the gusts.

    Examples
    --------
    >>> from uavlab.flight import offset_sigma
    >>> from uavlab.vehicle import LIGHT_QUADROTOR
    >>> from uavlab.weather import Wind
    >>> offset_sigma(LIGHT_QUADROTOR, Wind((6, 0), deviation=2.0)).round(3)  # along the wind, across it, up [m]
    array([0.34 , 0.175, 0.087])
    """
    from scipy.integrate import quad

    checks.instance("uav", uav, UAV)
    wind, controller = wind_of(wind, "wind"), checked_controller(controller)
    altitude = checks.positive_number("altitude", altitude)
    stream = np.array(wind.mean) - checks.three("ground_velocity", ground_velocity)
    speed = float(np.linalg.norm(stream))
    if speed == 0:
        raise ValueError(
            "ground_velocity must not be that of the wind: the air stands still relative to the UAV, so that small "
            "gusts have no force on it"
        )
    mass, natural = uav.weight / GRAVITY, controller.natural_frequency
    damping = np.array([2.0, 1.0, 1.0]) * 0.5 * wind.air_density * uav.drag_area * speed / mass
    variances = []
    for axis in range(3):

        def density(omega: float, axis: int = axis) -> float:
            gust = gust_spectrum(wind, omega, speed, altitude)[axis] * damping[axis] ** 2
            spring, damper = natural**2 - omega**2, (2 * natural + damping[axis]) * omega
            return float(gust / (spring**2 + damper**2))

        variances.append(sum(quad(density, low, high, limit=400)[0] for low, high in ((0, natural), (natural, np.inf))))
    return np.sqrt(variances)
