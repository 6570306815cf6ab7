"""Ant colony on a risk map (RISK-ACO section 3): ants walk from voxel to voxel, and good ways smell stronger.

An ant goes on to a neighbour that turns and climbs little enough and that it hasn't visited, by roulette with weights
τ^α·η^β: the pheromone there, and how promising it looks. As printed η knows only the way left, so the ants don't see
what is to be minimised, and β = 80 sends nearly all of them the same way. Here they also see the risk, and pheromone is
laid for low cost. All weights are logarithms: 30^80 and 0.2^500 are no numbers to multiply.
"""

from __future__ import annotations

import time

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.planners.advice import what_binds
from uavlab.planners.ants import Colony, Habits, forage_and_split
from uavlab.planners.risk_question import (
    MAX_TURN,
    Limits,
    Query,
    Weights,
    checked_length,
    checked_limits,
    city_lengths,
    finished,
    flyable_endpoints,
    in_cells,
    price_per_cell,
    query_of,
)
from uavlab.planners.risk_search import solve
from uavlab.risk import RiskMap
from uavlab.route import Route
from uavlab.spline.limits import MAX_PITCH

ANTS, PRINTED_ITERATIONS = 10, 50
"""m and NC_max (RISK-ACO Table 3)."""

OURS = Habits(alpha=1.0, beta=12.0, gamma=2.0, evaporation=0.1, deposit=1.5, least=0.05, first=15.0, most=15.0)
PRINTED = Habits(alpha=0.5, beta=80.0, gamma=0.0, evaporation=0.8, deposit=100.0, least=0.0, first=15.0, most=15.0)
"""α, β, ρ, Q, τ_min and τ_max (RISK-ACO Table 3). What τ is at first it doesn't say."""


def ant_colony(
    risk_map: RiskMap,
    start: npt.ArrayLike,
    goal: npt.ArrayLike,
    *,
    rng: np.random.Generator | int,
    budget: int = 4000,
    ants: int = ANTS,
    alpha: float = OURS.alpha,
    beta: float = OURS.beta,
    gamma: float = OURS.gamma,
    evaporation: float = OURS.evaporation,
    deposit: float = OURS.deposit,
    min_pheromone: float = OURS.least,
    initial_pheromone: float = OURS.first,
    max_pheromone: float = OURS.most,
    height_guided: bool = True,
    all_lay: bool = False,
    splits: int = 0,
    demand: float | None = None,
    risk_weight: float = 1.0,
    length_weight: float = 0.0,
    threat_weight: float = 0.0,
    max_turn: float = MAX_TURN,
    max_pitch: float = MAX_PITCH,
    max_length: float | None = None,
    min_clearance: float = 0.0,
    min_height: float | None = None,
    max_height: float = np.inf,
    drift: bool = False,
    record: bool = False,
    as_printed: bool = False,
) -> Route:
    """A route of low cost by an ant colony (RISK-ACO Eqs 11-17).

    An ant's weight of a neighbour is τ^α·η^β·C^−γ with η = 1/(d + Δl) and C its price. After each generation
    τ ← (1 − ρ) τ + Δτ, kept within τ_min and τ_max: the best way so far gets Δτ = Q, unless all ants lay pheromone.

    Parameters
    ----------
    risk_map, start, goal, risk_weight, length_weight, threat_weight, max_turn, max_pitch, max_length
        As for `least_risk`, which finds the least cost there is. Ants whose way gets too long give up.
    min_clearance, min_height, max_height, drift
        As for `least_risk`, too.
    rng : numpy.random.Generator or int
        Or a seed for one.
    budget : int
        How many ants walk in all, at least one generation for each split and one more.
    ants : int
        m, in each generation.
    alpha, beta : float
        α and β, weights of pheromone and of nearness, at least 0.
    gamma : float
        γ, weight of the price of a voxel, at least 0; 0 for ants that don't see it.
    evaporation : float
        ρ, between 0 and 1.
    deposit : float
        Q, above 0.
    min_pheromone, initial_pheromone, max_pheromone : float
        τ_min, τ at first, and τ_max. τ_min may be 0, τ_max infinite: no limits.
    height_guided : bool
        With the difference in height to the goal Δl in η (Eq. 12); else η = 1/d (Eq. 11).
    all_lay : bool
        Whether all ants that arrive lay Δτ = Q/L (Eqs 15 and 16), with L their length [m]; else the best way gets Q.
    splits : int
        Points at which to split the route (section 3.4), one after the other: the piece with most nodes is split at its
        middle node, and both halves are planned anew; a half stays as it was unless the new one is better. Each split
        takes an equal part of the budget.
    demand : float, optional
        Greatest cost that the route may have: it is split no more once it keeps this (section 4, step 3), and no more
        ants walk; by default it is split as often as said.
    record : bool
        Keep `info["pheromone"]`.
    as_printed : bool
        α = 0.5, β = 80, ρ = 0.8, Q = 100, τ from 0 to 15, γ = 0 in place of these parameters, and with `all_lay`: the
        risk enters nowhere, but for which route is kept.

    Returns
    -------
    Route
        `cost` as for `least_risk`; `info["evaluations"]`, how many ants walked; `info["history"]`, the least cost after
        each of them; `info["ants"]`, the cost of each one's own way (after a split: of its piece), infinite if it got
        stuck; `info["iterations"]`, how many had walked at the end of each generation; `info["splits"]` made;
        `info["elapsed"]` [s]. With `record`, `info["pheromone"]`, τ before the first generation and after each of
        those for the whole route, (G + 1, nx, ny, nz). Where no ant arrives `reached` is False, and `reason` says why.

    Raises
    ------
    ValueError
        If `risk_map`, `start`, `goal`, `risk_weight`, `length_weight`, `threat_weight`, `max_turn`, `max_pitch`,
        `max_length`, `min_clearance`, `min_height` or `max_height` is what `least_risk` refuses. If `rng` is no
        generator and no seed. If `budget` is below one generation for each split and one more. If `ants` is below 1, or
        `splits` below 0. If `alpha`, `beta`, `gamma` or `min_pheromone` is negative or not finite. If `evaporation` is
        not between 0 and 1. If `deposit`, `initial_pheromone` or `demand` is not above 0. If `min_pheromone`,
        `initial_pheromone` and `max_pheromone` are not in order. If `height_guided`, `all_lay`, `drift`, `record` or
        `as_printed` is neither True nor False.

    See Also
    --------
    least_risk : The least cost there is.
    compare_planners : Many runs on many maps.

    References
    ----------
    - Dorigo, Maniezzo and Colorni, Ant system: optimization by a colony of cooperating agents, 1996.
    - Stützle and Hoos, MAX-MIN ant system, 2000: limits of the pheromone.

    Examples
    --------
    >>> from uavlab.planners import ant_colony, least_risk, optimality_gap
    >>> from uavlab.risk import CAMPUS_FLIGHT, reference_campus
    >>> campus = reference_campus()
    >>> exact = least_risk(campus, *CAMPUS_FLIGHT)
    >>> ours = ant_colony(campus, *CAMPUS_FLIGHT, rng=1, budget=1000)
    >>> printed = ant_colony(campus, *CAMPUS_FLIGHT, rng=1, budget=1000, as_printed=True)
    >>> 0 <= optimality_gap(ours, exact) < optimality_gap(printed, exact)
    True
    """
    began = time.perf_counter()
    rng = checks.generator("rng", rng)
    flags = {"as_printed": as_printed, "height_guided": height_guided, "all_lay": all_lay, "record": record}
    for name, value in flags.items():
        checks.flag(name, value)
    all_lay = all_lay or as_printed
    ours = Habits(alpha, beta, gamma, evaporation, deposit, min_pheromone, initial_pheromone, max_pheromone)
    ours = checked_habits(ours)
    habits = PRINTED if as_printed else ours
    budget, ants, splits = checked_budget(budget, ants, splits, demand)
    limits = checked_limits(risk_map, max_turn, max_pitch, min_clearance, min_height, max_height)
    allowed = checked_length(max_length)
    longest = in_cells(risk_map.city, allowed)
    weights = Weights.checked(risk_weight, length_weight, threat_weight, drift)
    price = price_per_cell(risk_map, weights)
    between = flyable_endpoints(risk_map, start, goal, limits)
    query = query_of(risk_map, price, between.source, between.target, limits)
    if all_lay:
        habits = habits._replace(deposit=habits.deposit / risk_map.city.cell)  # Q/L: L in metres, ants count cells
    colony = Colony(query, habits, height_guided, all_lay, ants, rng)
    found = forage_and_split(colony, budget, splits, demand, longest, record)
    walked = np.concatenate([search.costs for search in found.searches])
    info = {
        "expanded": len(walked),
        "evaluations": len(walked),
        "history": found.history,
        "ants": walked,
        "iterations": np.cumsum(np.concatenate([search.walkers for search in found.searches])),
        "splits": found.splits,
        "elapsed": time.perf_counter() - began,
    }
    if record:
        info["pheromone"] = np.array(found.searches[0].pheromone).reshape(-1, *risk_map.city.shape)
    if len(found.nodes) == 0:
        reason = f"none of {len(walked)} ants arrived from {checks.show(start)} at {checks.show(goal)}: "
        return Route.none("ant colony", reason + why_none_arrived(risk_map, query, limits, max_length), **info)
    city = risk_map.city
    route = Route(city.center_of(city.index_of(found.nodes)), "ant colony", cost=found.cost, info=info)
    return finished(route, between, price, weights, allowed)


def why_none_arrived(risk_map: RiskMap, query: Query, limits: Limits, max_length: float | None) -> str:
    """Words for whether there is no way, or ants that look farther might find one."""
    shortest = solve(city_lengths(query), True)[1]
    if shortest == np.inf or shortest > in_cells(risk_map.city, checked_length(max_length)):
        return f"there is no way; {what_binds(risk_map, query, limits, max_length)}"
    cure = "larger max_turn" if max_length is None else "larger max_turn or max_length"
    return f"each ran into a dead end of voxels it may not turn to, or had visited; more ants may help, or a {cure}"


def checked_budget(budget: int, ants: int, splits: int, demand: float | None) -> tuple[int, int, int]:
    """One that is enough for a generation of each search, ants and splits; a demand that is no cost is refused."""
    if demand is not None:
        checks.positive_number("demand", demand)
    ants, splits = checks.whole("ants", ants, least=1), checks.whole("splits", splits, least=0)
    budget = checks.whole("budget", budget, least=1)
    least = ants * (splits + 1) * (2 if splits else 1)
    if budget < least:
        raise ValueError(f"budget must be at least {least}, for {ants} ants and {splits} splits, got {budget}")
    return budget, ants, splits


def checked_habits(habits: Habits) -> Habits:
    """Them as floats, within their ranges."""
    named = {name: getattr(habits, name) for name in ("alpha", "beta", "gamma")}
    alpha, beta, gamma = (checks.not_negative_number(name, weight) for name, weight in named.items())
    evaporation = checks.number("evaporation", habits.evaporation, checks.share)
    deposit = checks.positive_number("deposit", habits.deposit)
    least = checks.not_negative_number("min_pheromone", habits.least)
    first = checks.positive_number("initial_pheromone", habits.first)
    most = checks.number("max_pheromone", habits.most)
    if not least <= first <= most:
        raise ValueError(
            f"min_pheromone, initial_pheromone and max_pheromone must be in order, got {least:g}, {first:g}, {most:g}"
        )
    return Habits(alpha, beta, gamma, evaporation, deposit, least, first, most)
