"""A* and its shortcut against other people's planners: the same pairs, in turn, in one run, printed as tables.

Every contender gets a pair and gives back a route; its cost is computed here, by one rule for all. Whatever a peer can
prepare for the map (a graph, a grid of nodes) it prepares outside of the clock. The clock counts processor time, so
that whatever else a machine does disturbs little; nobody here uses more than one thread. Run it as
`python tests/benchmarks/astar.py`; `--help` lists the options.
"""

import argparse
import gc
import multiprocessing
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from importlib.metadata import version
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from scipy.ndimage import gaussian_filter
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from uavlab.city import City, table1_city
from uavlab.city.voxels import is_free_line
from uavlab.planners import astar, penalty_zone, shortcut, theta_star
from uavlab.planners.grid import LENGTHS, MOVES

Voxel = tuple[int, int, int]

DIJKSTRA3D_MOVES = (
    "+00 -00 0+0 0-0 00+ 00- ++0 -+0 +-0 --0 +0+ -0+ 0++ 0-+ +0- -0- 0+- 0-- +++ -++ +-+ --+ ++- -+- +-- ---"
)
"""The moves along x, y and z that the bits of its `voxel_graph` stand for, from the lowest (dijkstra3d's README)."""


OTHER_SEEDS = (1, 2, 3, 7)
"""Of pairs that are flown at any angle, too."""


class Pair(NamedTuple):
    """A start and a goal, as points [m] and as voxels."""

    start: np.ndarray
    goal: np.ndarray
    source: Voxel
    target: Voxel


@dataclass(frozen=True)
class Contender:
    """Somebody's planner on a map that it has prepared for; `solve` gives the route's points (N, 3)."""

    name: str
    solve: Callable[[Pair], np.ndarray]
    note: str = ""
    prepare: Callable[[], Any] = lambda: None  # before each run, outside of the clock


class Result(NamedTuple):
    """What a contender did on each pair."""

    seconds: np.ndarray
    costs: np.ndarray


def random_pairs(city: City, count: int, seed: int) -> list[Pair]:
    """Centres of free voxels, drawn evenly, at least 40 m apart."""
    pairs = city.random_pairs(count, seed)
    return [Pair(*ends, *(tuple(voxel.tolist()) for voxel in city.cell_of(ends))) for ends in pairs]


def cost_of(points: np.ndarray, price: np.ndarray | None = None) -> float:
    """Length of a route; with a price, of one through voxels: Σ d·(price at both ends)/2 [cells]."""
    lengths = np.linalg.norm(np.diff(np.asarray(points, dtype=float), axis=0), axis=1)
    if price is None:
        return float(lengths.sum())
    prices = price[tuple(np.asarray(points, dtype=int).T)]
    return float((lengths * (prices[1:] + prices[:-1]) / 2).sum())


def compete(contenders: list[Contender], pairs: list[Pair], price: np.ndarray | None = None) -> dict[str, Result]:
    """Let all run on the first pair, then on this and the next, so that a busy machine is busy for all."""
    results = {contender.name: Result(np.empty(len(pairs)), np.empty(len(pairs))) for contender in contenders}
    for contender in contenders:
        contender.prepare()
        contender.solve(pairs[0])  # compiles, and fills what is filled once
    for n, pair in enumerate(pairs):
        for contender in contenders:
            points, results[contender.name].seconds[n] = timed(contender, pair)
            results[contender.name].costs[n] = cost_of(points, price)
    return results


def timed(contender: Contender, pair: Pair) -> tuple[np.ndarray, float]:
    """A contender's route and the median time of up to five runs, fewer of a slow one."""
    times: list[float] = []
    while len(times) < 5 and sum(times) < 0.2:
        contender.prepare()
        began = time.process_time()
        points = contender.solve(pair)
        times.append(time.process_time() - began)
    return points, float(np.median(times))


def ours(city: City, price: np.ndarray | None = None, heuristic: str = "auto") -> Contender:
    """Our A*, route and all; its points as voxels."""

    def solve(pair: Pair) -> np.ndarray:
        return city.cell_of(astar(city, pair.start, pair.goal, price=price, heuristic=heuristic).points)

    return Contender("uavlab" if heuristic == "auto" else f"uavlab, {heuristic}", solve, "same rule")


def scikit_image(city: City, price: np.ndarray | None = None) -> Contender:
    """`MCP_Geometric`: Dijkstra with the same edge cost d·(p_a + p_b)/2; an infinite price is an obstacle."""
    from skimage.graph import MCP_Geometric

    prices = np.where(city.occupied, np.inf, 1.0 if price is None else price)

    def solve(pair: Pair) -> np.ndarray:
        search = MCP_Geometric(prices, fully_connected=True)
        search.find_costs([pair.source], [pair.target])
        return np.array(search.traceback(pair.target))

    return Contender("scikit-image MCP_Geometric", solve, "cuts corners" if city.occupied.any() else "same rule")


def scipy_dijkstra(city: City, price: np.ndarray | None = None) -> Contender:
    """`csgraph.dijkstra` on the graph of all legal moves; it can't stop at the goal."""
    graph = graph_of(city, np.ones(city.shape) if price is None else price)

    def solve(pair: Pair) -> np.ndarray:
        source, target = (int(city.code_of(voxel)) for voxel in (pair.source, pair.target))
        _, before = dijkstra(graph, indices=source, return_predecessors=True)
        codes = [target]
        while codes[-1] != source:
            codes.append(int(before[codes[-1]]))
        return city.index_of(codes[::-1])

    return Contender("SciPy csgraph.dijkstra", solve, "same rule")


def graph_of(city: City, price: np.ndarray) -> csr_array:
    """All legal moves as a sparse matrix of costs [cells]."""
    codes = np.arange(city.occupied.size, dtype=np.int32).reshape(city.shape)
    rows, columns, costs = [], [], []
    for move, length in zip(MOVES, LENGTHS, strict=True):
        source = codes[legal(city.occupied, tuple(move))]
        target = (
            source + np.ravel_multi_index(tuple(move + 1), city.shape) - np.ravel_multi_index((1, 1, 1), city.shape)
        )
        rows.append(source)
        columns.append(target.astype(np.int32))
        costs.append(length * (price.ravel()[source] + price.ravel()[target]) / 2)
    entries = np.concatenate(costs), (np.concatenate(rows), np.concatenate(columns))
    return csr_array(entries, shape=(codes.size, codes.size))


def legal(occupied: np.ndarray, move: Voxel) -> np.ndarray:
    """Where a move's whole bounding box is free, (nx, ny, nz) bool; written without the library's own rule."""
    padded = np.pad(occupied, 1, constant_values=True)
    free = np.ones(occupied.shape, dtype=bool)
    for offset in product(*({0, int(step)} for step in move)):
        free &= ~padded[tuple(slice(1 + o, 1 + o + n) for o, n in zip(offset, occupied.shape, strict=True))]
    return free


def dijkstra3d_compass(city: City, metric: bool = True, same_rule: bool = True) -> Contender:
    """dijkstra3d's A*; by default it counts moves, and only `anisotropy` makes it measure their lengths.

    Obstacles are either forbidden moves of its `voxel_graph`, which can state our rule, or voxels of a high price.
    """
    import dijkstra3d

    options: dict[str, Any] = {"anisotropy": (1.0, 1.0, 1.0)} if metric else {}
    if same_rule:
        options["voxel_graph"] = voxel_graph(city.occupied)
    field = np.asfortranarray(np.where(city.occupied & (not same_rule), 1e6, 1.0).astype(np.float32))

    def solve(pair: Pair) -> np.ndarray:
        return dijkstra3d.dijkstra(field, pair.source, pair.target, compass=True, **options).astype(np.int64)

    note = "same rule" if same_rule else "cuts corners"
    name = "dijkstra3d, compass" + (", metric" if metric else "") + (", graph" if same_rule else "")
    return Contender(name, solve, note if metric else f"{note}; counts moves, whatever their length")


def voxel_graph(occupied: np.ndarray) -> np.ndarray:
    """dijkstra3d's word of 26 bits with those set whose moves are legal."""
    graph = np.zeros(occupied.shape, np.uint32, order="F")
    for bit, signs in enumerate(DIJKSTRA3D_MOVES.split()):
        move = tuple({"+": 1, "-": -1, "0": 0}[sign] for sign in signs)
        graph |= legal(occupied, move).astype(np.uint32) << np.uint32(bit)
    return graph


def pathfinding3d_astar(city: City) -> Contender:
    """pathfinding3d's A* with its octile heuristic; its nodes are Python objects, made and cleaned off the clock."""
    from pathfinding3d.core.diagonal_movement import DiagonalMovement
    from pathfinding3d.core.grid import Grid
    from pathfinding3d.core.heuristic import octile
    from pathfinding3d.finder.a_star import AStarFinder

    grid = Grid(matrix=(~city.occupied).astype(int))
    gc.freeze()  # or each collection walks through a million nodes, for every contender

    def solve(pair: Pair) -> np.ndarray:
        finder = AStarFinder(octile, diagonal_movement=DiagonalMovement.only_when_no_obstacle)
        nodes, _ = finder.find_path(grid.node(*pair.source), grid.node(*pair.target), grid)
        return np.array([node.identifier for node in nodes])

    return Contender("pathfinding3d A*", solve, "same rule", prepare=grid.cleanup)


def ours_any_angle(city: City) -> Contender:
    return Contender("uavlab Theta*", lambda pair: theta_star(city, pair.start, pair.goal).points)


def ours_shortened(city: City) -> Contender:
    return Contender("uavlab A* + shortcut", lambda pair: shortcut(astar(city, pair.start, pair.goal), city).points)


def free_line(city: City) -> Callable[[Any, Any], bool]:
    """Whether a straight line touches no obstacle: compiled and exact, so no planner waits for a check in Python."""
    start, end = np.empty(3), np.empty(3)
    (x, y, z), cell = (float(v) for v in city.origin), city.cell

    def check(one: Any, other: Any) -> bool:
        start[0], start[1], start[2] = (one[0] - x) / cell, (one[1] - y) / cell, (one[2] - z) / cell
        end[0], end[1], end[2] = (other[0] - x) / cell, (other[1] - y) / cell, (other[2] - z) / cell
        return is_free_line(city.occupied, start, end)

    return check


def ompl_planner(city: City, planner: str, seconds: float) -> Contender:
    """A planner of OMPL with its default settings and a limit of processor time; straight lines by our rule."""
    from ompl import base, geometric

    is_free = free_line(city)

    class AnyTouch(base.MotionValidator):
        def checkMotion(self, one: Any, other: Any) -> bool:  # noqa: N802  OMPL's name
            return is_free(one, other)

    def solve(pair: Pair) -> np.ndarray:
        space = base.RealVectorStateSpace(3)
        bounds = base.RealVectorBounds(3)
        for axis, (low, high) in enumerate(city.bounds.T):
            bounds.setLow(axis, float(low))
            bounds.setHigh(axis, float(high))
        space.setBounds(bounds)
        setup = geometric.SimpleSetup(space)
        information = setup.getSpaceInformation()
        setup.setStateValidityChecker(lambda state: is_free(state, state))
        information.setMotionValidator(AnyTouch(information))
        setup.setStartAndGoalStates(state_of(space, pair.start), state_of(space, pair.goal))
        setup.setPlanner(getattr(geometric, planner)(information))
        deadline = time.process_time() + seconds
        setup.solve(base.PlannerTerminationCondition(lambda: time.process_time() > deadline))
        if not setup.haveExactSolutionPath():
            return np.full((2, 3), np.nan)
        return np.array([[state[axis] for axis in range(3)] for state in setup.getSolutionPath().getStates()])

    return Contender(f"OMPL {planner}", solve)


def state_of(space: Any, point: np.ndarray) -> Any:
    state = space.allocState()
    for axis in range(3):
        state[axis] = float(point[axis])
    return state


def smooth_price(shape: Voxel, seed: int, sigma: float = 5.0) -> np.ndarray:
    """A price from 1 to 5 that changes over some cells: filtered noise."""
    noise = gaussian_filter(np.random.default_rng(seed).normal(size=shape), sigma)
    return 1.0 + 4.0 * (noise - noise.min()) / np.ptp(noise)


def print_table(title: str, header: list[str], rows: list[list[str]]) -> None:
    print(f"\n### {title}\n", *(f"| {' | '.join(row)} |" for row in (header, ["---"] * len(header), *rows)), sep="\n")
    sys.stdout.flush()


def print_results(title: str, contenders: list[Contender], results: dict[str, Result], unit: str = "m") -> None:
    """Total time and its ratio to the first contender's, the ratio on that one's slowest pair, and costs."""
    first = results[contenders[0].name]
    hardest = int(first.seconds.argmax())
    rows = []
    for contender in contenders:
        result = results[contender.name]
        apart = np.abs(result.costs - first.costs).max()
        rows.append(
            [
                contender.name,
                f"{result.seconds.sum():.4g}",
                f"{result.seconds.sum() / first.seconds.sum():.3g}",
                f"{result.seconds[hardest] / first.seconds[hardest]:.3g}",
                f"{result.costs.sum():.3f}",
                f"{apart:.1g}" if apart < 1e-6 else f"{apart:.3f}",
                contender.note,
            ]
        )
    header = [
        "",
        "total [s]",
        "times ours",
        "on our hardest pair",
        f"total cost [{unit}]",
        "largest difference",
        "rule",
    ]
    print_table(title, header, rows)


def equal_cost(city: City, pairs: list[Pair]) -> None:
    contenders = [
        ours(city),
        dijkstra3d_compass(city),
        dijkstra3d_compass(city, same_rule=False),
        dijkstra3d_compass(city, metric=False, same_rule=False),
        scikit_image(city),
        scipy_dijkstra(city),
        pathfinding3d_astar(city),
    ]
    print_results("A*, shortest routes", contenders, compete(contenders, pairs))


def any_angle(city: City, pairs: list[Pair], seconds: float, seed: int) -> None:
    contenders = [ours_any_angle(city), ours_shortened(city)]
    contenders += [ompl_planner(city, name, seconds) for name in ("RRTstar", "InformedRRTstar", "BITstar")]
    results = compete(contenders, pairs)
    first = results[contenders[0].name]
    rows = [
        [
            name,
            f"{result.seconds.sum():.4g}",
            f"{result.seconds.sum() / first.seconds.sum():.3g}",
            f"{result.costs.sum():.2f}",
            f"{result.costs.sum() / first.costs.sum():.4f}",
            f"{(result.costs < first.costs - 1e-6).sum()}",
        ]
        for name, result in results.items()
    ]
    header = ["", "total [s]", "times ours", "total length [m]", "to ours", "pairs on which it is shorter"]
    print_table(f"Any angle, pairs of seed {seed}; OMPL's planners have {seconds:g} s a pair", header, rows)


def with_price(city: City, pairs: list[Pair], seed: int) -> None:
    noise = smooth_price(city.shape, seed)
    cases = {
        "A* with a price of filtered noise, 1 to 5, no obstacle": (City(np.zeros_like(city.occupied)), noise),
        "The same price, Table 1's city": (city, noise),
        "REPARE's penalty zone, D_min 3.5 m, ω 2": (city, penalty_zone(city, 3.5, penalty=2.0)),
        "The hazard of gusts, 1 + 95·exp(−clearance²/2σ²), σ 1 m": (
            city,
            1.0 + 95.0 * np.exp(-(city.clearance**2) / 2.0),
        ),
    }
    for title, (place, price) in cases.items():
        contenders = [ours(place, price), ours(place, price, "octile"), ours(place, price, "coarse")]
        contenders.append(scikit_image(place, price))
        print_results(title, contenders, compete(contenders, pairs, price), unit="cells × price")


def expansions(city: City, pairs: list[Pair]) -> None:
    rows = []
    for heuristic in ("octile", "euclidean", "zero"):
        routes = [astar(city, pair.start, pair.goal, heuristic=heuristic) for pair in pairs]
        rows.append((heuristic, sum(r.info["expanded"] for r in routes), sum(r.cost for r in routes)))
    table = [[name, f"{count:,}", f"{rows[0][1] / count:.3f}", f"{cost:.3f}"] for name, count, cost in rows]
    print_table("Heuristics", ["", "expansions", "octile's share", "total cost [m]"], table)


def large_map(pairs: list[Pair]) -> None:
    """0.25 m voxels. Each search in a process of its own, which reads the map that another one has built."""
    with tempfile.TemporaryDirectory() as folder:
        file = str(Path(folder) / "occupied.npy")
        seconds, megabytes = apart(build_large, file)
        searches = [apart(search_large, file, pair.start, pair.goal) for pair in pairs]
    hardest = max(searches, key=lambda search: search["expanded"])
    greediest = max(searches, key=lambda search: search["after"])
    rows = [
        [
            name,
            f"{search['expanded']:,}",
            f"{search['seconds']:.2f}",
            f"{search['before']:.0f}",
            f"{search['after']:.0f}",
        ]
        for name, search in (("hardest pair", hardest), ("most memory", greediest))
    ]
    print_table(
        f"400³ voxels; all pairs {sum(search['seconds'] for search in searches):.1f} s; "
        f"building the map {seconds:.1f} s, peak {megabytes:.0f} MB",
        ["", "expansions", "time [s]", "peak memory before the search [MB]", "and after [MB]"],
        rows,
    )


def apart(function: Callable, *args: Any) -> Any:
    """The function's answer from a fresh process."""
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        return pool.submit(function, *args).result()


def build_large(file: str) -> tuple[float, float]:
    began = time.process_time()
    city = table1_city(0.25)
    seconds = time.process_time() - began
    np.save(file, city.occupied)
    return seconds, peak_memory()


def search_large(file: str, start: np.ndarray, goal: np.ndarray) -> dict[str, float]:
    astar(City(np.zeros((3, 3, 3), bool)), (0.5, 0.5, 0.5), (2.5, 2.5, 2.5))  # loads the compiled code
    city = City(np.load(file), 0.25)
    before = peak_memory()
    began = time.process_time()
    route = astar(city, start, goal)
    seconds = time.process_time() - began
    return {"expanded": route.info["expanded"], "seconds": seconds, "before": before, "after": peak_memory()}


def peak_memory() -> float:
    """The most memory that this process has held [MB]."""
    import resource  # not on Windows

    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit / 1e6


def machine() -> Iterator[str]:
    """The processor and the versions that the figures belong to."""
    info = Path("/proc/cpuinfo")
    lines = info.read_text().splitlines() if info.exists() else []
    yield next((line.split(": ")[1] for line in lines if line.startswith("model name")), "unknown processor")
    yield f"Python {sys.version.split()[0]}"
    for package in ("numpy", "numba", "scipy", "scikit-image", "dijkstra3d", "pathfinding3d", "ompl"):
        yield f"{package} {version(package)}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pairs", type=int, default=20, help="how many pairs of start and goal")
    parser.add_argument("--seed", type=int, default=2022, help="of the pairs, the price and OMPL's sampling")
    parser.add_argument("--seconds", type=float, default=1.0, help="what OMPL's planners are given for a pair")
    parser.add_argument("--quick", action="store_true", help="three pairs, a tenth of a second")
    options = parser.parse_args()
    if options.quick:
        options.pairs, options.seconds = 3, 0.1
    import ompl.util

    ompl.util.setLogLevel(ompl.util.LogLevel.LOG_ERROR)
    ompl.util.RNG.setSeed(options.seed)
    city = table1_city()
    pairs = random_pairs(city, options.pairs, options.seed)
    print(f"{len(pairs)} pairs, seed {options.seed}; {', '.join(machine())}")
    large_map(pairs)  # first, because a process begins with the peak of the one that started it
    expansions(city, pairs)
    for seed in dict.fromkeys((options.seed, *(() if options.quick else OTHER_SEEDS))):
        any_angle(city, random_pairs(city, options.pairs, seed), options.seconds, seed)
    with_price(city, pairs, options.seed)
    equal_cost(city, pairs)


if __name__ == "__main__":
    main()
