"""Ground risk as practice classes it: SORA 2.5, beside the papers' deaths per hour.

SORA (Specific Operations Risk Assessment) is the method of JARUS by which authorities judge flights over people. Its
first step is the intrinsic ground risk class (iGRC): from how many people are below, and how large and how fast the UA
is. Behind the class stands one balance, as in the papers: failures per hour × people per area × area. The papers ask
how many die; SORA asks how often the UA may fail, so that no more than `TLOS` die.

Source: JARUS guidelines on SORA, edition 2.5 (2024), main body (document JAR-DEL-SRM-SORA-MB-2.5, Step 2 and its Table
2) and Annex F. What stands here serves to learn from. It is no legal advice, and only the first of SORA's ten steps.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy import ndimage

from uavlab import checks
from uavlab.risk.rates import check_density
from uavlab.vehicle import GRAVITY

DIMENSIONS = (1.0, 3.0, 8.0, 20.0, 40.0)
"""Greatest characteristic dimension [m] of each column of the table."""

SPEEDS = (25.0, 35.0, 75.0, 120.0, 200.0)
"""Greatest speed [m/s] of each column."""

CRITICAL_AREAS = (8.0, 80.0, 800.0, 8000.0, 43000.0)
"""Nominal critical area of each column [m²] (Annex F): on which a crash is taken to kill."""

DENSITIES = (5.0, 50.0, 500.0, 5000.0, 50000.0)
"""Upper ends of the bands of population density [people per km²]; a band ends below them."""

NO_CLASS = 11
"""Not part of SORA: above all classes of the table."""

HIGHEST_SPECIFIC = 7
"""Above this final class the specific category, which SORA is for, ends."""

IGRC = np.array(
    [
        [1, 1, 2, 3, 3],
        [2, 3, 4, 5, 6],
        [3, 4, 5, 6, 7],
        [4, 5, 6, 7, 8],
        [5, 6, 7, 8, 9],
        [6, 7, 8, 9, 10],
        [7, 8, NO_CLASS, NO_CLASS, NO_CLASS],
    ]
)
"""Table 2 of the main body: a controlled ground area, then the bands of `DENSITIES` and what lies above."""

TLOS = 1e-6
"""Target level of safety: deaths on the ground per hour of flight that are accepted at most."""

HARMLESS_MASS, HARMLESS_SPEED = 0.25, 25.0
"""Up to this mass [kg] and speed [m/s] the class is 1 whoever is below."""

PER_KM2 = 1e6


def igrc(
    population_density: npt.ArrayLike,
    dimension: float,
    speed: float,
    *,
    mass: float | None = None,
    controlled: bool = False,
) -> int | np.ndarray:
    """Intrinsic ground risk class by Table 2 of SORA 2.5.

    The column is the first that is large and fast enough; the row is the band of the population density.

    Parameters
    ----------
    population_density : float or array
        People [1/m²], 0 to 10; 0.003 is 3 000 per km². In SORA it is the greatest in the area that the flight may
        reach, see `ground_risk_buffer`. The upper end of a band belongs to the next.
    dimension : float
        Greatest characteristic dimension of the UA [m], above 0, at most 40: wing span, or from tip to tip of rotors.
    speed : float
        Its greatest speed [m/s], above 0, at most 200.
    mass : float, optional
        With payload [kg], above 0. Up to 250 g and 25 m/s the class is 1.
    controlled : bool
        Whether nobody is there but those who take part (a controlled ground area), whatever the density.

    Returns
    -------
    int or array
        1 to 10, the shape of `population_density`; `NO_CLASS` (11) where the table says "not part of SORA". Above 7 a
        flight is outside of the specific category, if nothing mitigates the risk.

    Raises
    ------
    ValueError
        If `population_density` is not from 0 to 10 per m²; `dimension` not above 0 or above 40; `speed` not above 0 or
        above 200; `mass` is not above 0; or `controlled` isn't True or False.

    See Also
    --------
    raw_igrc : What the table is made from.
    uavlab.risk.RiskMap.igrc : For each cell of a map.

    References
    ----------
    JARUS guidelines on SORA 2.5, main body, Step 2, Table 2.

    Examples
    --------
    A quadrotor of 40 cm over a city, over a park and over a fenced site.

    >>> from uavlab.risk import igrc
    >>> igrc(0.03, 0.4, 16.0), igrc(0.0003, 0.4, 16.0), igrc(0.0, 0.4, 16.0, controlled=True)
    (6, 4, 1)
    """
    density = checked_density(population_density)
    column = column_of(dimension, speed)
    light = mass is not None and checks.positive_number("mass", mass) <= HARMLESS_MASS * (1 + 1e-9)
    if checks.flag("controlled", controlled):
        row = np.zeros(density.shape, int)
    else:
        row = 1 + np.searchsorted(DENSITIES, density * PER_KM2 * (1 + 1e-9), side="right")
    classes = np.ones(density.shape, int) if light and speed <= HARMLESS_SPEED else IGRC[row, column]
    return int(classes) if density.ndim == 0 else classes


def raw_igrc(
    population_density: npt.ArrayLike, critical_area: npt.ArrayLike, *, tlos: npt.ArrayLike = TLOS
) -> float | np.ndarray:
    """The class before it is rounded, from the balance that stands behind the table (Annex F).

    iGRC = 1 − log₁₀(TLOS / (D·A_c)): a class more for every tenfold of people or area, and a UA of class n may fail
    once in 10^(n − 1) hours. At the upper ends of the bands Table 2 is this value, rounded down.

    Parameters
    ----------
    population_density : float or array
        D, people [1/m²], above 0, to 10.
    critical_area : float or array
        A_c [m²], above 0: on which a crash is taken to kill, see `nominal_critical_area`, or `lethal_area`.
    tlos : float or array
        Target level of safety [deaths per hour], above 0.

    Returns
    -------
    float or array
        The shape of all of them together. Below 1 where even a UA that fails in every hour is safe enough.

    Raises
    ------
    ValueError
        If `population_density` is not above 0 or above 10 per m², or `critical_area` or `tlos` is not above 0 and
        finite.

    See Also
    --------
    igrc : By the table.
    tolerable_failure_rate : The same balance, in failures per hour.

    References
    ----------
    JARUS guidelines on SORA 2.5, Annex F.

    Examples
    --------
    >>> from uavlab.risk import raw_igrc
    >>> round(raw_igrc(0.05, 8.0), 1)  # upper end of the band below 50,000 per km², a UA of 1 m
    6.6
    """
    raw = 1 - np.log10(tolerable_failure_rate(population_density, critical_area, tlos=tlos))
    return float(raw) if np.ndim(raw) == 0 else raw


def tolerable_failure_rate(
    population_density: npt.ArrayLike, critical_area: npt.ArrayLike, *, tlos: npt.ArrayLike = TLOS
) -> float | np.ndarray:
    """How often a UA may go out of control, so that no more than the target level of safety die (Annex F).

    λ = TLOS / (D·A_c)

    Parameters
    ----------
    population_density, critical_area, tlos
        As for `raw_igrc`.

    Returns
    -------
    float or array
        λ [failures per hour]; above 1 it says that the number of failures doesn't matter.

    Raises
    ------
    ValueError
        If `population_density` is not above 0 or above 10 per m², or `critical_area` or `tlos` is not above 0 and
        finite.

    See Also
    --------
    raw_igrc : The same as a class.

    Examples
    --------
    >>> from uavlab.risk import tolerable_failure_rate
    >>> f"{tolerable_failure_rate(0.03, 8.0):.1e}"  # over a dense city, UA of 1 m: once in 240 000 hours
    '4.2e-06'
    """
    for name, values in (("population_density", population_density), ("critical_area", critical_area), ("tlos", tlos)):
        checks.positive(name, values)
    density, area, level = checked_density(population_density), np.asarray(critical_area), np.asarray(tlos)
    rate = level / (density * area)
    return float(rate) if np.ndim(rate) == 0 else rate


def nominal_critical_area(dimension: float, speed: float) -> float:
    """On how large an area SORA takes a crash to kill, by the column of the table (Annex F).

    Parameters
    ----------
    dimension, speed
        As for `igrc`.

    Returns
    -------
    float
        [m²], 8 to 43 000.

    Raises
    ------
    ValueError
        If `dimension` is not above 0 or above 40 m, or `speed` not above 0 or above 200 m/s.

    See Also
    --------
    lethal_area : By the papers' model of the fall.

    Examples
    --------
    >>> from uavlab.risk import nominal_critical_area
    >>> nominal_critical_area(0.4, 16.0), nominal_critical_area(0.4, 30.0)  # too fast for the first column
    (8.0, 80.0)
    """
    return CRITICAL_AREAS[column_of(dimension, speed)]


def ground_risk_buffer(height: npt.ArrayLike, dimension: float = 0.0, speed: float | None = None) -> float | np.ndarray:
    """How far beside the flight people have to be counted, too, since a UA that fails may come down there.

    Without a speed by the 1:1 rule, h + d/2; with a speed by ballistic flight without drag, V·√(2h/g) + d/2.

    Parameters
    ----------
    height : float or array
        h, greatest height above ground that the UA may reach [m], at least 0.
    dimension : float
        d, characteristic dimension of the UA [m], at least 0.
    speed : float, optional
        V, greatest speed [m/s], at least 0; only for what falls as soon as it fails, such as a multirotor.

    Returns
    -------
    float or array
        [m], the shape of `height`.

    Raises
    ------
    ValueError
        If `height`, `dimension` or `speed` is negative or not finite.

    See Also
    --------
    ballistic_fall : With drag, and so a shorter way.

    References
    ----------
    JARUS guidelines on SORA 2.5, Annex A. Luftfahrt-Bundesamt, guidelines for dimensioning flight geography,
    contingency volume and ground risk buffer: both rules.

    Examples
    --------
    >>> from uavlab.risk import ground_risk_buffer
    >>> round(ground_risk_buffer(30.0, 0.4), 1), round(ground_risk_buffer(30.0, 0.4, speed=16.0), 1)
    (30.2, 39.8)
    """
    checks.not_negative("height", height)
    height, half = np.asarray(height, float), checks.not_negative_number("dimension", dimension) / 2
    way = height if speed is None else checks.not_negative_number("speed", speed) * np.sqrt(2 * height / GRAVITY)
    return float(way + half) if height.ndim == 0 else way + half


def highest_within(classes: np.ndarray, distance: float, cell: float) -> np.ndarray:
    """The highest class (nx, ny) from the centre of each cell up to a distance [m]; off the map nothing is known."""
    reach = int(np.floor(distance / cell + 0.5))
    apart = np.maximum(np.abs(np.arange(-reach, reach + 1)) - 0.5, 0) * cell  # to the nearest side
    near = np.hypot(apart[:, None], apart) <= distance + 1e-9 * cell
    return ndimage.maximum_filter(classes, footprint=near, mode="constant", cval=0)


def checked_density(population_density: npt.ArrayLike) -> np.ndarray:
    """People per m² as an array; `ValueError` for what is likely per km²."""
    check_density(population_density)
    return checks.numbers("population_density", population_density)


def column_of(dimension: float, speed: float) -> int:
    """The column of the table: the first that is large and fast enough."""
    dimension, speed = checks.positive_number("dimension", dimension), checks.positive_number("speed", speed)
    for name, value, most in (("dimension", dimension, DIMENSIONS), ("speed", speed, SPEEDS)):
        if value > most[-1]:
            unit = "m" if name == "dimension" else "m/s"
            raise ValueError(f"{name} must be at most {most[-1]:g} {unit}, where the table of SORA ends, got {value:g}")
    return max(int(np.searchsorted(DIMENSIONS, dimension)), int(np.searchsorted(SPEEDS, speed)))
