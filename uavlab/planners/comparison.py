"""How good is a planner? Its gap to the exact optimum, over many maps and seeds, at the same number of evaluations.

A single run on a single map says nothing of a method that draws at random. Nor do iterations: one of PSO measures as
many curves as there are particles, one of PSO-BAS several times as many. So all get the same budget of evaluations
(curves measured, ants walked), and what is compared are medians and shares over maps and seeds. Nor is a curve that was
refined to be held against a route on the grid: all are refined, or none.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.planners.least_risk import least_risk
from uavlab.planners.swarm import checked_refinement, refine
from uavlab.risk import CAMPUS_FLIGHT, RiskMap
from uavlab.route import Route
from uavlab.statistics import over_maps, share_over_maps
from uavlab.sweep import sweep
from uavlab.sweep.rows import told_apart

if TYPE_CHECKING:
    import pandas

Planner = Callable[..., Route]
"""Called as planner(risk_map, start, goal, budget=…, rng=…)."""


def optimality_gap(route: Route, exact: Route) -> float:
    """How much more a route costs than the optimum, as a share of it: cost/cost* − 1.

    Parameters
    ----------
    route : Route
        Its `cost` in the unit of the exact route's; infinite gap if it doesn't arrive.
    exact : Route
        Of `least_risk` for the same question. A curve that isn't bound to the grid may cost less: a negative gap.

    Returns
    -------
    float
        0 for the optimum, 0.1 for a tenth more.

    Raises
    ------
    ValueError
        If `exact` doesn't arrive, or its cost is not finite and above 0. If `route` arrives and its cost is NaN.

    See Also
    --------
    least_risk : Gives the optimum.
    compare_planners : Gaps of many runs.

    Examples
    --------
    >>> from uavlab.planners import optimality_gap
    >>> from uavlab.route import Route
    >>> exact = Route([(0, 0, 30), (40, 0, 30)], cost=2.0)
    >>> round(optimality_gap(Route([(0, 0, 30), (0, 30, 30), (40, 0, 30)], cost=2.5), exact), 2)
    0.25
    >>> optimality_gap(Route.none("ants", "none arrived"), exact)
    inf
    """
    checks.instance("route", route, Route)
    checks.instance("exact", exact, Route)
    if not (exact.reached and 0 < exact.cost < np.inf):
        raise ValueError(
            f"exact must be a route that arrives, with a cost above 0, got {exact!r} of cost {exact.cost:g}"
        )
    if not route.reached:
        return float("inf")
    if np.isnan(route.cost):
        raise ValueError("route has no cost: RiskMap.integral(route) gives it")
    return float(route.cost / exact.cost - 1)


@dataclass(frozen=True, eq=False)
class Comparison:
    """Runs of P planners on M maps with S seeds each.

    Attributes
    ----------
    planners : list of str
        Their P names.
    gaps : (P, M, S) array
        Gap to the exact optimum of each route, infinite if it doesn't arrive.
    histories : (P, M, S, budget) array
        Gap of the best so far after each evaluation; infinite before there was one.
    iterations : list of P int arrays
        How many evaluations had been made at the end of each iteration.
    elapsed : (P, M, S) array
        Time of each run [s].
    exact : list of M Routes
        The optima.
    refinement : float
        Share of the budget that refined each route; 0 where none was.

    See Also
    --------
    compare_planners : Makes one.

    Examples
    --------
    >>> from functools import partial
    >>> from uavlab.planners import ant_colony, compare_planners
    >>> from uavlab.risk import random_campus
    >>> planners = {"ants": ant_colony, "printed": partial(ant_colony, as_printed=True)}
    >>> runs = compare_planners(planners, random_campus(1), seeds=range(5), budget=200, progress=False)
    >>> runs.planners, runs.gaps.shape, runs.histories.shape
    (['ants', 'printed'], (2, 1, 5), (2, 1, 5, 200))
    """

    planners: list[str]
    gaps: np.ndarray
    histories: np.ndarray
    iterations: list[np.ndarray]
    elapsed: np.ndarray
    exact: list[Route]
    refinement: float = 0.0

    def __repr__(self) -> str:
        maps, seeds = self.gaps.shape[1:]
        runs = f"{maps} map{'s' * (maps != 1)} × {seeds} seed{'s' * (seeds != 1)}"
        return f"<Comparison of {', '.join(self.planners)}: {runs}>"

    def table(self) -> pandas.DataFrame:
        """A row per planner: median gap with its 95 % interval, 90 % quantile [%], runs that didn't arrive [%], time.

        Its corner says whether the routes are refined, all alike. The interval is a bootstrap over the maps: runs on
        the same map are not independent.

        Returns
        -------
        pandas.DataFrame
            Columns "median", "low", "high", "90 %" and "failed" [%], and "seconds", the median.

        See Also
        --------
        uavlab.statistics.over_maps : The interval.

        Examples
        --------
        >>> from functools import partial
        >>> from uavlab.planners import ant_colony, compare_planners
        >>> from uavlab.risk import random_campus
        >>> planners = {"ants": ant_colony, "printed": partial(ant_colony, as_printed=True)}
        >>> runs = compare_planners(planners, random_campus(1), seeds=range(5), budget=200, progress=False)
        >>> runs.table().columns.tolist()
        ['median', 'low', 'high', '90 %', 'failed', 'seconds']
        """
        import pandas

        rows = []
        for name, gaps, elapsed in zip(self.planners, self.gaps, self.elapsed, strict=True):
            low, high = over_maps(np.median, gaps)
            rows.append(
                {
                    "planner": name,
                    "median": 100 * np.median(gaps),
                    "low": 100 * low,
                    "high": 100 * high,
                    "90 %": 100 * np.quantile(gaps, 0.9, method="higher"),
                    "failed": 100 * np.isinf(gaps).mean(),
                    "seconds": np.median(elapsed),
                }
            )
        table = pandas.DataFrame(rows).set_index("planner")
        return table.rename_axis(index="planner, refined" if self.refinement > 0 else "planner, not refined")

    def wins(self, planner: str, other: str) -> tuple[float, float, float]:
        """Share of runs (map, seed) in which a planner's gap is less than another's, and its 95 % interval.

        Ties count half.

        Parameters
        ----------
        planner, other : str
            Of `planners`.

        Returns
        -------
        share, low, high : float
            The interval is `share_over_maps`.

        Raises
        ------
        ValueError
            If `planner` or `other` is not one of `planners`.

        See Also
        --------
        uavlab.statistics.share_over_maps : The interval.

        Examples
        --------
        >>> from functools import partial
        >>> from uavlab.planners import ant_colony, compare_planners
        >>> from uavlab.risk import random_campus
        >>> planners = {"ants": ant_colony, "printed": partial(ant_colony, as_printed=True)}
        >>> runs = compare_planners(planners, random_campus(1), seeds=range(5), budget=200, progress=False)
        >>> share, low, high = runs.wins("ants", "printed")
        >>> f"{share:.0%}, from {low:.1%} to {high:.0%}"  # all runs, but one map says little of others
        '100%, from 2.5% to 100%'
        """
        for name, value in (("planner", planner), ("other", other)):
            checks.one_of(name, value, self.planners)
        a, b = (self.gaps[self.planners.index(name)] for name in (planner, other))
        won = np.where(a == b, 0.5, a < b)
        return float(won.mean()), *share_over_maps(won)

    def converged(self, within: float = 0.01) -> tuple[np.ndarray, np.ndarray]:
        """When each run came to within a share of its final cost.

        A run that didn't arrive never did: all its evaluations. What comes after the last iteration counts as one more.

        Parameters
        ----------
        within : float
            Between 0 and 1; 0.01 is 1 %.

        Returns
        -------
        evaluations, iterations : (P, M, S) int arrays
            How many of each had been made by then.

        Raises
        ------
        ValueError
            If `within` is not between 0 and 1.

        See Also
        --------
        uavlab.plot.convergence : Draws the histories.

        Examples
        --------
        >>> from functools import partial
        >>> from uavlab.planners import ant_colony, compare_planners
        >>> from uavlab.risk import random_campus
        >>> planners = {"ants": ant_colony, "printed": partial(ant_colony, as_printed=True)}
        >>> runs = compare_planners(planners, random_campus(1), seeds=range(5), budget=200, progress=False)
        >>> evaluations, iterations = runs.converged(within=0.01)
        >>> bool((evaluations <= 200).all()), bool((iterations <= 20).all())  # ten ants an iteration
        (True, True)
        """
        within = checks.number("within", within, checks.share)
        final = 1 + self.histories[..., -1:]
        near = (1 + self.histories <= (1 + within) * final) & np.isfinite(final)
        evaluations = np.where(near.any(axis=-1), near.argmax(axis=-1) + 1, self.histories.shape[-1])
        iterations = [np.searchsorted(ends, made) + 1 for ends, made in zip(self.iterations, evaluations, strict=True)]
        return evaluations, np.array(iterations)


def compare_planners(
    planners: Mapping[str, Planner],
    maps: RiskMap | Sequence[RiskMap],
    *,
    seeds: Iterable[int] = range(10),
    budget: int = 4000,
    start: npt.ArrayLike = CAMPUS_FLIGHT[0],
    goal: npt.ArrayLike = CAMPUS_FLIGHT[1],
    refinement: float = 0.0,
    jobs: int | None = None,
    to: str | PathLike[str] | None = None,
    progress: bool = True,
) -> Comparison:
    """Run planners on maps with seeds at the same number of evaluations, against the exact optimum of each map.

    Parameters
    ----------
    planners : mapping of name to function
        Called as planner(risk_map, start, goal, budget=…, rng=…), such as `ant_colony` or, with settings,
        `functools.partial(waypoint_swarm, optimizer="pso", refinement=0)`. They minimise the risk, as `least_risk` by
        default.
    maps : RiskMap, or several
    seeds : iterable of int
        One run of each planner on each map with each.
    budget : int
        Evaluations of each run.
    start, goal : (3,) arrays
        Positions [m], the same on all maps.
    refinement : float
        Share of each budget, from 0 to below 1, that `refine` gets for the route that a planner found with the rest.
        0: none is refined.
    jobs, to, progress
        As for `sweep`; for a file, `planners` are no lambdas.

    Returns
    -------
    Comparison

    Raises
    ------
    ValueError
        If `planners`, `maps` or `seeds` is empty, or holds what is no function, RiskMap or whole number of at least 0.
        If one of `seeds` is repeated. If one of `maps` has no route from `start` to `goal`. If `budget` is below 1. If
        `jobs`, `to` or `progress` is what `sweep` refuses. If `refinement` is not from 0 to below 1. If one of
        `planners` takes another number of evaluations than `budget`, or only some of them refine what they found. Also
        what the planners raise.

    See Also
    --------
    optimality_gap : Of one run.
    uavlab.sweep.sweep : Runs them, on many cores if asked.
    uavlab.plot.convergence : Draws it.

    Examples
    --------
    >>> from functools import partial
    >>> from uavlab.planners import ant_colony, compare_planners
    >>> from uavlab.risk import random_campus
    >>> planners = {"ants": ant_colony, "printed": partial(ant_colony, as_printed=True)}
    >>> runs = compare_planners(planners, random_campus(1), seeds=range(5), budget=200, progress=False)
    >>> bool((runs.gaps[0] < runs.gaps[1]).all())  # ants that see the risk always find less of it
    True
    """
    planners = checks.by_name("planners", planners)
    for name, planner in planners.items():
        checks.function(f"planners[{name!r}]", planner, "planner(risk_map, start, goal, budget=…, rng=…)")
    maps = [maps] if isinstance(maps, RiskMap) else checks.several("maps", maps, RiskMap)
    seeds, budget = checked_seeds(seeds), checks.whole("budget", budget, least=1)
    refinement, progress = checked_refinement(refinement), checks.flag("progress", progress)
    if to is not None:
        told_apart("planners", list(planners.values()))
    exact = [least_risk(risk_map, start, goal) for risk_map in maps]
    for number, route in enumerate(exact):
        if not route.reached:
            raise ValueError(f"maps must have a route from start to goal, maps[{number}] has none: {route.reason}")
    alike = {"start": start, "goal": goal, "budget": budget, "refinement": refinement}
    cases = [
        {"planner": planner, "risk_map": risk_map, "rng": seed, **alike}
        for planner in planners.values()
        for risk_map in maps
        for seed in seeds
    ]
    routes = sweep(one_run, cases, jobs=jobs, on_error="raise", to=to, progress=progress, unit="run")
    shape = (len(planners), len(maps), len(seeds))
    for route in routes:
        if (used := route.info.get("evaluations")) != budget:
            raise ValueError(f"planners must use the budget of {budget}, {route.planner} used {used}")
    firsts = routes[:: len(maps) * len(seeds)]
    refined = [route.info.get("refined", 0) for route in firsts]
    refuse_unequal(list(planners), refined)
    least = np.array([route.cost for route in exact])[None, :, None]
    costs = np.array([route.cost if route.reached else np.inf for route in routes])
    gaps = costs.reshape(shape) / least - 1
    histories = np.array([route.info["history"] for route in routes]).reshape(*shape, budget) / least[..., None] - 1
    elapsed = np.array([route.info["elapsed"] for route in routes]).reshape(shape)
    iterations = [route.info["iterations"] for route in firsts]
    return Comparison(list(planners), gaps, histories, iterations, elapsed, exact, max(refined) / budget)


def checked_seeds(seeds: Iterable[int]) -> list[int]:
    """Whole numbers, all different: the same run twice would narrow an interval."""
    several = checks.seeds("seeds", seeds)
    if not several:
        raise ValueError("seeds must hold at least 1, got 0")
    if len(set(several)) < len(several):
        raise ValueError(f"seeds must all be different, got {several}")
    return several


def refuse_unequal(names: list[str], refined: list[int]) -> None:
    """`ValueError` if only some of the planners spent evaluations on refinement."""
    some = [name for name, count in zip(names, refined, strict=True) if count]
    if some and len(some) < len(names):
        raise ValueError(
            f"planners must all be refined or none: {', '.join(some)} refines by itself; give refinement=0 to "
            f"waypoint_swarm, and refinement to compare_planners, which refines all alike"
        )


def one_run(planner: Planner, risk_map: RiskMap, budget: int, rng: int, refinement: float, **ends: Any) -> Route:
    """A planner's route, refined with a share of the budget; where none was found, the rest isn't of use to it."""
    last = int(refinement * budget)
    found = planner(risk_map=risk_map, budget=budget - last, rng=rng, **ends)
    checks.instance("what planners return", found, Route)
    if last == 0 or found.info.get("evaluations") != budget - last:
        return found
    history, info = found.info["history"], {**found.info, "evaluations": budget, "refined": last}
    if not found.reached:
        return replace(found, info=info | {"history": np.append(history, np.full(last, np.inf))})
    better = refine(found, risk_map, rng=rng, budget=last)
    together = np.append(history, np.minimum(better.info["history"], history[-1]))
    elapsed = info["elapsed"] + better.info["elapsed"]
    return replace(better, planner=found.planner, info=info | {"history": together, "elapsed": elapsed})
