"""The exact risk planner against plain Dijkstra over its states, ours and SciPy's, printed as tables.

All answer the same questions on the same maps in one run, each in turn: the reference campus in voxels of 5 m and 2 m,
and random campuses. SciPy gets the graph of all moves between states (voxel and heading), made outside of the clock,
and can't stop at the goal. The clock counts processor time, the median of up to five runs; nobody uses more than one
thread. Run it as `python tests/benchmarks/least_risk.py`; `--quick` leaves out what needs a minute or a gigabyte.
"""

import argparse
import sys
import time
from collections.abc import Callable
from importlib.metadata import version
from typing import Any

import numpy as np
from astar import legal, machine, print_table
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from uavlab.planners import least_risk, pareto_front
from uavlab.planners.grid import LENGTHS, MOVES
from uavlab.planners.risk_question import MAX_TURN
from uavlab.risk import CAMPUS_FLIGHT, RiskMap, random_campus, reference_campus
from uavlab.spline.limits import MAX_PITCH

QUESTIONS: dict[str, dict[str, Any]] = {
    "risk": {},
    "risk with drift": {"drift": True},
    "length": {"risk_weight": 0.0, "length_weight": 1.0},
}


def clocked(ask: Callable[[], Any]) -> tuple[Any, float]:
    """An answer, and the median processor time of up to five runs [s], fewer of a slow one."""
    times: list[float] = []
    while len(times) < 5 and sum(times) < 1.0:
        began = time.process_time()
        answer = ask()
        times.append(time.process_time() - began)
    return answer, float(np.median(times))


def state_graph(risk_map: RiskMap, question: dict[str, Any]) -> csr_array:
    """Costs of all moves between states, nine to a voxel, within the planner's default limits; by definition."""
    closed = ~risk_map.flyable
    codes = np.arange(closed.size, dtype=np.int32).reshape(closed.shape)
    rows, columns, costs = [], [], []
    for number, (move, length) in enumerate(zip(MOVES, LENGTHS, strict=True)):
        if abs(move[2]) / length > np.sin(MAX_PITCH):
            continue
        source = codes[legal(closed, tuple(move))]
        target = source + (move @ (closed.shape[1] * closed.shape[2], closed.shape[2], 1)).astype(np.int32)
        price = price_of(risk_map, question, number)
        cost = length * (price[source] + price[target]) / 2
        heading = round(np.arctan2(move[1], move[0]) / (np.pi / 4)) % 8
        for before in range(9):
            turn = abs((heading - before + 4) % 8 - 4) * np.pi / 4
            if before == 8 or turn <= MAX_TURN:
                rows.append(9 * source + before)
                columns.append(9 * target + heading)
                costs.append(cost)
    entries = np.concatenate(costs), (np.concatenate(rows), np.concatenate(columns))
    return csr_array(entries, shape=(9 * closed.size, 9 * closed.size))


def price_of(risk_map: RiskMap, question: dict[str, Any], move: int) -> np.ndarray:
    """Cost per cell in each voxel for a move."""
    rate = risk_map.rate_ahead[move] if question.get("drift") else risk_map.rate
    return (question.get("risk", 1.0) * rate + question.get("length", 0.0) * risk_map.city.cell).ravel()


def by_scipy(graph: csr_array, source: int, target: int) -> float:
    return float(dijkstra(graph, indices=9 * source + 8)[9 * target : 9 * target + 9].min())


def compare(risk_map: RiskMap, question: dict[str, Any], with_scipy: bool = True) -> dict[str, float]:
    """Expansions and times of all on one question, and how far their costs are apart."""
    _ = risk_map.rate, risk_map.rate_ahead, risk_map.flyable  # the map's work, not the planners'
    exact, ours = clocked(lambda: least_risk(risk_map, *CAMPUS_FLIGHT, **question))
    plain, zero = clocked(lambda: least_risk(risk_map, *CAMPUS_FLIGHT, **question, heuristic="zero"))
    costs, scipy = [plain.cost], np.nan
    if with_scipy:
        graph = state_graph(risk_map, question)
        ends = [int(risk_map.city.code_of(risk_map.city.cell_of(end))) for end in CAMPUS_FLIGHT]
        cost, scipy = clocked(lambda: by_scipy(graph, *ends))
        costs.append(cost)
    return {
        "expanded": exact.info["expanded"],
        "plain": plain.info["expanded"] / exact.info["expanded"],
        "seconds": ours,
        "plain times": zero / ours,
        "scipy times": scipy / ours,
        "apart": float(np.abs(np.array(costs) / exact.cost - 1).max()),
    }


def routes(quick: bool, campuses: int) -> None:
    rows = []
    for name, question in QUESTIONS.items():
        for cell in (5.0,) if quick else (5.0, 2.0):
            rows.append(
                [name, f"reference, {cell:g} m", *columns([compare(reference_campus(cell), question)], "{:.3g}")]
            )
        results = [compare(random_campus(seed), question) for seed in range(1, campuses + 1)]
        rows.append([name, f"{campuses} random, 5 m", *columns(results, "{:.3g}")])
    print_table(
        "The exact route",
        ["least", "campus", "expansions", "plain Dijkstra expands", "time [s]", "plain Dijkstra", "SciPy", "apart"],
        rows,
    )


def columns(results: list[dict[str, float]], style: str) -> list[str]:
    """One result as it is; of several the median, and the least and the most of the ratios."""
    cells = []
    for key in results[0]:
        values = np.array([result[key] for result in results])
        cell = f"{np.median(values):,.0f}" if key == "expanded" else style.format(np.median(values))
        if key in ("plain", "plain times", "scipy times"):
            cell += " ×" if len(values) == 1 else f" × ({style.format(values.min())} to {style.format(values.max())})"
        cells.append(cell if key != "apart" else f"{values.max():.0e}")
    return cells


def fronts(quick: bool) -> None:
    rows = []
    for cell in (5.0,) if quick else (5.0, 2.0):
        risk_map = reference_campus(cell)
        _ = risk_map.rate, risk_map.rate_ahead, risk_map.flyable  # the map's work, not the planners'
        for name in ("risk", "risk with drift"):
            drift = name != "risk"
            front, seconds = clocked(lambda: pareto_front(risk_map, *CAMPUS_FLIGHT, drift=drift))  # noqa: B023
            _, one = clocked(lambda: least_risk(risk_map, *CAMPUS_FLIGHT, drift=drift))  # noqa: B023
            expanded = f"{front[0].info['expanded']:,}"
            rows.append([name, f"{cell:g} m", str(len(front)), expanded, f"{seconds:.3g}", f"{seconds / one:.3g} ×"])
    header = ["least", "voxels", "routes", "expansions and labels", "time [s]", "of one unlimited route"]
    print_table("pareto_front of 12 lengths, reference campus", header, rows)


def drifts(count: int) -> None:
    """What it costs not to know that wrecks fly on."""
    ratios = []
    for number in range(count + 1):
        risk_map = random_campus(number) if number else reference_campus()
        blind, aware = (least_risk(risk_map, *CAMPUS_FLIGHT, drift=drift) for drift in (False, True))
        true = risk_map.integral(blind, drift=True)
        ratios.append((true / blind.cost, true / aware.cost))
    names = "true risk of the drift-blind optimum, of what it claims", "and of the drift-aware optimum's"
    rows = [
        [name, *(f"{q:.2f}" for q in np.quantile(values, (0, 0.25, 0.5, 0.75, 1)))]
        for name, values in zip(names, np.transpose(ratios), strict=True)
    ]
    title = f"Drift, reference campus and {count} random ones"
    print_table(title, ["", "least", "lower quartile", "median", "upper quartile", "most"], rows)


def maps() -> None:
    rows = []
    for cell in (5.0, 2.0):
        risk_map, seconds = clocked(lambda: fresh(cell))  # noqa: B023
        _, ahead = clocked(lambda: fresh(cell).rate_ahead)  # noqa: B023
        voxels = " × ".join(map(str, risk_map.city.shape))
        rows.append([f"{cell:g} m", voxels, f"{seconds:.2g}", f"{ahead - seconds:.2g}"])
    print_table("Making the reference campus", ["voxels", "", "city, layers and rates [s]", "rates ahead [s]"], rows)


def fresh(cell: float) -> RiskMap:
    """The reference campus, with what is computed when first asked for."""
    risk_map = reference_campus(cell)
    _ = risk_map.rate, risk_map.flyable, risk_map.threat
    return risk_map


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--campuses", type=int, default=10, help="how many random campuses the planners compete on")
    parser.add_argument("--quick", action="store_true", help="voxels of 5 m only, three random campuses")
    options = parser.parse_args()
    if options.quick:
        options.campuses = 3
    versions = ", ".join(f"{package} {version(package)}" for package in ("numpy", "numba", "scipy"))
    print(f"{next(machine())}, Python {sys.version.split()[0]}, {versions}")
    least_risk(reference_campus(), *CAMPUS_FLIGHT, max_length=150.0)  # compiles
    maps()
    routes(options.quick, options.campuses)
    fronts(options.quick)
    drifts(5 if options.quick else 20)


if __name__ == "__main__":
    main()
