"""From a failure to a rate: deaths per hour of flight over a place (RISK-ACO Eqs 4-10, PSO-BAS Eqs 2-8).

r = P1 + P2. P1, people hit: failures per hour × people in the lethal area × the chance that the blow kills, which
depends on its energy and on what shelters them. P2, cars hit: failures per hour × share of the road that is covered
by cars × deaths per crash.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.special import expit

from uavlab import checks
from uavlab.risk.fall import AIR_DENSITY, ballistic_fall, fall_speed, impact_energy, lethal_area
from uavlab.vehicle import RISK_QUADROTOR, UAV

FAILURE_RATE = 6.4e-5
"""f_c (RISK-ACO), f_G (PSO-BAS Table 2) [1/h]: falls out of the sky per hour of flight."""

POPULATION_DENSITY = 30_000e-6
"""ρ [1/m²]: 30 000 people per km² (RISK-ACO and PSO-BAS Table 2)."""

DENSEST_CROWD = 10.0
"""People per m² [1/m²] above which a density is refused: nobody could move, so a unit was mistaken."""

EVEN_ODDS_ENERGY = 1e6
"""α [J]: kills in half of the cases behind shelter 0.5. Missing in both papers' tables; 1 MJ is the value of the
literature that the formula comes from (Dalamagkidis, Valavanis and Piegl 2012)."""

LEAST_FATAL_ENERGY = 34.0
"""β [J]: the least that kills a person without shelter (RISK-ACO and PSO-BAS Table 2)."""

SHELTER = {"none": 0.0, "sparse trees": 0.25, "trees or low buildings": 0.5, "high buildings": 0.75, "industry": 1.0}
"""p_s by what stands there (RISK-ACO and PSO-BAS Table 1)."""

CAR_AREA, LANE_WIDTH, DEATHS_PER_CRASH = 8.4, 3.0, 3.0
"""S_car [m²], D_road [m] and T (RISK-ACO and PSO-BAS Table 2)."""

CARS_PER_KM = 0.1
"""K (RISK-ACO and PSO-BAS Table 2), printed without a unit. Per metre, one cell of road would be riskier than any whole
route in either paper; so it is per kilometre."""


def impact_fatality(
    energy: npt.ArrayLike,
    shelter: npt.ArrayLike,
    *,
    even_odds_energy: float = EVEN_ODDS_ENERGY,
    least_fatal_energy: float = LEAST_FATAL_ENERGY,
) -> np.ndarray:
    """Chance that a person who is hit dies (RISK-ACO Eq. 8, PSO-BAS Eq. 6).

    P(f) = 1 / (1 + √(α/β)·(β/E)^(1/(4 p_s))), computed through logarithms, so that no power overflows. At p_s = 0 it
    takes its limit: 0 below β, 1 above it, 1/(1 + √(α/β)) at E = β. Below β the formula has shelter raise the chance,
    which is then under 0.6 % anyway.

    Parameters
    ----------
    energy : float or array
        E_imp [J], at least 0.
    shelter : float or array
        p_s from 0 (none) to 1 (industry), see `SHELTER`; broadcast with `energy`.
    even_odds_energy : float
        α [J], above 0.
    least_fatal_energy : float
        β [J], above 0.

    Returns
    -------
    float or array
        P(f), 0 to 1.

    Raises
    ------
    ValueError
        If `energy` is negative or not finite, `shelter` is not from 0 to 1, or `even_odds_energy` or
        `least_fatal_energy` is not above 0 and finite.

    See Also
    --------
    impact_energy : E_imp of a wreck.
    person_rate : deaths per hour of flight.

    References
    ----------
    K. Dalamagkidis, K. P. Valavanis and L. A. Piegl, *On Integrating Unmanned Aircraft Systems into the National
    Airspace System*, 2nd edition, 2012.

    Examples
    --------
    A fall from 30 m: without shelter it kills for certain, behind sparse trees in one case of eleven.

    >>> from uavlab.risk import impact_fatality
    >>> impact_fatality(554.0, [0.0, 0.25, 0.5, 0.75, 1.0]).round(3)
    array([1.   , 0.087, 0.023, 0.015, 0.012])
    """
    checks.not_negative("energy", energy)
    checks.within("shelter", shelter, 0.0, 1.0, "(0 none, 1 industry)")
    even_odds_energy = checks.positive_number("even_odds_energy", even_odds_energy)
    least_fatal_energy = checks.positive_number("least_fatal_energy", least_fatal_energy)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        over = np.log(np.asarray(energy, dtype=float) / least_fatal_energy)
        power = np.where(over == 0, 0.0, over / (4 * np.asarray(shelter, dtype=float)))
    return expit(power - 0.5 * np.log(even_odds_energy / least_fatal_energy))


def person_rate(
    height: npt.ArrayLike,
    population_density: npt.ArrayLike = POPULATION_DENSITY,
    shelter: npt.ArrayLike = 0.0,
    uav: UAV = RISK_QUADROTOR,
    *,
    speed: float | None = None,
    ballistic: bool = False,
    air_density: float = AIR_DENSITY,
    as_printed: bool = False,
) -> np.ndarray:
    """Deaths of people on the ground per hour of flight, P1 = f_c·ρ·A_exp·P(f) (RISK-ACO Eqs 4-5, PSO-BAS Eqs 2-3).

    Parameters
    ----------
    height : float or array
        Above what the wreck falls on [m], at least 0.
    population_density : float or array
        ρ [1/m²], 0 to 10; a city has 0.001 to 0.03.
    shelter : float or array
        p_s, 0 to 1. The three are broadcast.
    uav : UAV
        What falls: its mass with payload, diameter, and drag area as a wreck.
    speed : float, optional
        Forward speed when it fails [m/s], at least 0; the cruise speed by default.
    ballistic : bool
        With drag on the forward speed too, see `ballistic_fall`; by default, as in the papers, it is kept.
    air_density : float
        ρ_A [kg/m³], above 0.
    as_printed : bool
        With the printed fall speed, see `fall_speed`.

    Returns
    -------
    float or array
        P1 [1/h].

    Raises
    ------
    ValueError
        If `height` is negative, or above 50 000 m with `ballistic`; `population_density` is not from 0 to 10 per m²;
        `shelter` is not from 0 to 1; `speed` is negative; `air_density` is not above 0; one of them is not finite;
        `uav` is no `UAV`; `ballistic` or `as_printed` isn't True or False; or both are asked for at once.

    See Also
    --------
    vehicle_rate : the part of the cars.
    RiskMap : both, for each voxel of a city.

    Examples
    --------
    Deaths in a million hours of flight over a city without shelter, from 10, 30 and 60 m, and from 30 m over trees.

    >>> from uavlab.risk import person_rate
    >>> (1e6 * person_rate([10, 30, 60])).round(2)
    array([4.52, 3.17, 2.65])
    >>> round(float(1e6 * person_rate(30, shelter=0.5)), 2)
    0.07
    """
    if checks.flag("ballistic", ballistic) and checks.flag("as_printed", as_printed):
        raise ValueError("as_printed and ballistic exclude each other: the papers print the closed form only")
    check_density(population_density)
    checks.instance("uav", uav, UAV)
    speed = checks.not_negative_number("speed", uav.cruise_speed if speed is None else speed)
    if ballistic:
        fall = ballistic_fall(height, uav, speed=speed, air_density=air_density)
        forward, down = fall.forward_speed, fall.fall_speed
    else:
        down = fall_speed(height, uav, air_density=air_density, as_printed=as_printed)
        forward = np.asarray(speed, dtype=float)
    people = np.asarray(population_density, dtype=float) * lethal_area(height, forward, down, uav.diameter)
    return FAILURE_RATE * people * impact_fatality(impact_energy(uav.mass + uav.payload, forward, down), shelter)


def check_density(population_density: npt.ArrayLike) -> None:
    """Refuse a density below 0, and one above `DENSEST_CROWD`, which is people per km² or per pixel."""
    checks.not_negative("population_density", population_density)
    densities = checks.numbers("population_density", population_density)
    demand = f"population_density must be in people per m², at most {DENSEST_CROWD:g} (divide those per km² by 1e6)"
    checks.refuse(densities, densities <= DENSEST_CROWD, demand)


def vehicle_share(cars_per_km: npt.ArrayLike = CARS_PER_KM, lane_width: npt.ArrayLike = LANE_WIDTH) -> np.ndarray:
    """Share of a road that is covered by cars, C = S_car·K / D_road (RISK-ACO Eq. 10, PSO-BAS Eq. 8).

    Parameters
    ----------
    cars_per_km : float or array
        K, cars per kilometre of a lane, at least 0; 0.1 in the papers, next to none; 10 is a busy road.
    lane_width : float or array
        D_road [m], above 0; 3 in the papers. The two are broadcast.

    Returns
    -------
    float or array
        C, 0 to 1.

    Raises
    ------
    ValueError
        If `cars_per_km` is negative or not finite, `lane_width` is not above 0 and finite, or cars would cover more
        than the road: a unit was mistaken.

    See Also
    --------
    vehicle_rate : deaths in cars that follow from it.
    road_layer : the share on the columns of a city.

    Examples
    --------
    A busy road has a hundred times as many cars as the papers' road.

    >>> from uavlab.risk import vehicle_share
    >>> vehicle_share([0.1, 10.0]).round(5)
    array([0.00028, 0.028  ])
    """
    checks.not_negative("cars_per_km", cars_per_km)
    checks.positive("lane_width", lane_width)
    share = CAR_AREA * np.asarray(cars_per_km, dtype=float) / 1000 / np.asarray(lane_width, dtype=float)
    checks.refuse(share, share <= 1, "cars_per_km must leave cars on at most the whole lane; the share covered")
    return share


def vehicle_rate(share: npt.ArrayLike) -> np.ndarray:
    """Deaths in cars per hour of flight over a road, P2 = f_c·C·T (RISK-ACO Eq. 9, PSO-BAS Eq. 7).

    Parameters
    ----------
    share : float or array
        C, share of the ground that is covered by cars, 0 to 1, see `vehicle_share`.

    Returns
    -------
    float or array
        P2 [1/h], at any height.

    Raises
    ------
    ValueError
        If `share` is not from 0 to 1.

    See Also
    --------
    vehicle_share : C of a road.
    person_rate : the part of the people.

    Examples
    --------
    Deaths in a million hours of flight over the papers' road, and over a busy one.

    >>> from uavlab.risk import vehicle_rate, vehicle_share
    >>> (1e6 * vehicle_rate(vehicle_share([0.1, 10.0]))).round(3)
    array([0.054, 5.376])
    """
    checks.within("share", share, 0.0, 1.0, "of the ground")
    return FAILURE_RATE * DEATHS_PER_CRASH * np.asarray(share, dtype=float)
