"""The world's planners at one table: uavlab beside other people's libraries, on one page and in one picture.

Each row is one kind of question, asked of both sides in turn in one run, with answers of equal cost where both are
exact. The ratio is the peer's total time to ours, its interval the bootstrap over questions; a clock of processor time
runs around the call alone. Peers that aren't installed are listed as such. Then the same city in ever finer voxels
shows how the cost grows. Run it as `python tests/benchmarks/world.py`; `--write` puts the page into
`tests/benchmarks/WORLD.md`, its short form into README and the picture into `notebooks/figures/benchmarks.png`;
`--quick` asks fewer questions.
"""

from __future__ import annotations

import argparse
import contextlib
import datetime
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from astar import (
    Contender,
    compete,
    dijkstra3d_compass,
    machine,
    ompl_planner,
    ours,
    ours_any_angle,
    pathfinding3d_astar,
    random_pairs,
    scikit_image,
    scipy_dijkstra,
    smooth_price,
)
from least_risk import QUESTIONS
from least_risk import compare as against_scipy
from metaheuristics import our_swarm, their_swarm

from uavlab import __version__
from uavlab.city import City, table1_city
from uavlab.planners import astar, penalty_zone
from uavlab.plot import colors
from uavlab.risk import random_campus

PAGE = Path(__file__).with_name("WORLD.md")
README = Path(__file__).parents[2] / "README.md"
PICTURE = Path(__file__).parents[2] / "notebooks" / "figures" / "benchmarks.png"
CELLS = (2.0, 1.0, 0.5, 0.25, 0.2)
"""Of Table 1's city, 100 m wide [m]: 50³ to 500³ voxels."""

LINES = 27
"""Of the cache, that an expansion looks at: nine columns of three neighbours, in what is closed, costs and parents."""


class Measured(NamedTuple):
    """Seconds of each question, and what is to be known about the answers."""

    ours: np.ndarray
    theirs: np.ndarray
    answers: str


class Peer(NamedTuple):
    """Somebody's library, a question for it, and how it is asked."""

    question: str
    name: str
    package: str
    measure: Callable[[bool], Measured]
    alike: bool = True
    """Whether both answer the same question and stop when they have the answer."""


def searched(
    contender: Callable[[City], Contender], first: Callable[[City], Contender] = ours
) -> Callable[[bool], Measured]:
    """Routes through Table 1's city."""

    def measure(quick: bool) -> Measured:
        city = table1_city()
        pairs = random_pairs(city, 3 if quick else 20, 2022)
        mine, theirs = compete([first(city), contender(city)], pairs).values()
        return Measured(mine.seconds, theirs.seconds, costs_apart(mine.costs, theirs.costs))

    return measure


def priced(price_of: Callable[[City], np.ndarray]) -> Callable[[bool], Measured]:
    """Cheapest routes, by scikit-image, too."""

    def measure(quick: bool) -> Measured:
        city = table1_city()
        pairs, price = random_pairs(city, 3 if quick else 20, 2022), price_of(city)
        mine, theirs = compete([ours(city, price), scikit_image(city, price)], pairs, price).values()
        return Measured(mine.seconds, theirs.seconds, costs_apart(mine.costs, theirs.costs))

    return measure


def any_angle(planner: str, quick: bool) -> Measured:
    """Straight lines between any points; OMPL's planners take all of the time that they get."""
    import ompl.util

    ompl.util.setLogLevel(ompl.util.LogLevel.LOG_NONE)
    ompl.util.RNG.setSeed(2022)  # heard once in a process
    return searched(lambda city: ompl_planner(city, planner, 0.1 if quick else 1.0), ours_any_angle)(quick)


def least_risks(quick: bool) -> Measured:
    """Routes of least risk over random campuses; SciPy has the graph of all states ready."""
    against_scipy(random_campus(0), QUESTIONS["risk"])  # compiles
    results = [against_scipy(random_campus(seed), QUESTIONS["risk"]) for seed in range(1, 3 if quick else 11)]
    mine = np.array([result["seconds"] for result in results])
    apart = max(result["apart"] for result in results)
    return Measured(
        mine,
        mine * [result["scipy times"] for result in results],
        "of equal risk" if apart < 1e-9 else f"{apart:.0e} apart",
    )


def swarms(quick: bool) -> Measured:
    """Two hundred iterations of a hundred particles over a sphere in ten dimensions."""
    seconds: list[list[float]] = [[], []]
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):  # where pyswarms leaves its report.log
        for seed in range(3 if quick else 15):
            for run, clock in zip((our_swarm(100, 200, 10), their_swarm(100, 200, 10, True)), seconds, strict=True):
                began = time.process_time()
                run(seed)
                clock.append(time.process_time() - began)
    return Measured(*np.array(seconds)[:, 1:], "the same formulas, other random numbers")


def flights(quick: bool) -> Measured:
    """One flight of REPARE's route, by a point mass here and by six degrees of freedom there."""
    import flight as flying

    uav = flying.point_mass_of(flying.hummingbird())
    seconds = flying.clocked_flights(uav, flying.routes_of(uav)["REPARE"], 10 if quick else 100, 3 if quick else 10)
    mine, theirs, _ = map(np.array, seconds.values())
    return Measured(mine, theirs, "another model: a point mass here, six degrees of freedom there")


PEERS = (
    Peer("shortest route, 100³ voxels", "pathfinding3d A*", "pathfinding3d", searched(pathfinding3d_astar)),
    Peer("shortest route, 100³ voxels", "SciPy csgraph.dijkstra", "scipy", searched(scipy_dijkstra)),
    Peer("shortest route, 100³ voxels", "scikit-image MCP_Geometric", "scikit-image", searched(scikit_image)),
    Peer("shortest route, 100³ voxels", "dijkstra3d, compass", "dijkstra3d", searched(dijkstra3d_compass)),
    Peer("shortest route, both without an estimate", "SciPy csgraph.dijkstra", "scipy",
         searched(scipy_dijkstra, lambda city: ours(city, heuristic="zero"))),
    Peer("cheapest route, REPARE's zone", "scikit-image MCP_Geometric", "scikit-image",
         priced(lambda city: penalty_zone(city, 3.5, penalty=2.0))),
    Peer("cheapest route, filtered noise", "scikit-image MCP_Geometric", "scikit-image",
         priced(lambda city: smooth_price(city.shape, 2022))),
    Peer("any angle, OMPL has 1 s", "OMPL RRT*", "ompl", lambda quick: any_angle("RRTstar", quick), False),
    Peer("any angle, OMPL has 1 s", "OMPL Informed RRT*", "ompl",
         lambda quick: any_angle("InformedRRTstar", quick), False),
    Peer("any angle, OMPL has 1 s", "OMPL BIT*", "ompl", lambda quick: any_angle("BITstar", quick), False),
    Peer("route of least risk, campus of 5 m", "SciPy csgraph.dijkstra", "scipy", least_risks),
    Peer("particle swarm", "pyswarms", "pyswarms", swarms),
    Peer("a flight in gusts", "RotorPy", "rotorpy", flights, False),
)  # fmt: skip
"""All at the table."""


def costs_apart(mine: np.ndarray, theirs: np.ndarray) -> str:
    """By how much the peer's total is dearer."""
    more = theirs.sum() / mine.sum() - 1
    return "of equal cost" if abs(more) < 1e-9 else f"{100 * abs(more):.2g} % {'more' if more > 0 else 'less'} there"


def ratio_of(measured: Measured) -> tuple[float, float, float]:
    """How many times as long the peer takes in all, with an interval of 95 % by the bootstrap over questions."""
    rng, count = np.random.default_rng(0), len(measured.ours)
    chosen = rng.integers(0, count, (2000, count))
    drawn = measured.theirs[chosen].sum(axis=1) / measured.ours[chosen].sum(axis=1)
    low, high = np.quantile(drawn, [0.025, 0.975])
    return float(measured.theirs.sum() / measured.ours.sum()), float(low), float(high)


def three_digits(number: float) -> str:
    """A number to three digits, and no power of ten."""
    return f"{float(f'{number:.3g}'):,.10g}".replace(",", " ")


def version_of(package: str) -> str:
    """Empty where it isn't installed."""
    try:
        return version(package)
    except PackageNotFoundError:
        return ""


class Growth(NamedTuple):
    """The same pairs in ever finer voxels."""

    voxels: np.ndarray
    expanded: np.ndarray
    """(cells, pairs)"""
    seconds: np.ndarray


def exponent(voxels: np.ndarray, cost: np.ndarray) -> tuple[float, float, float]:
    """b in cost ~ voxels^b of all pairs together (cells, pairs), with an interval by the bootstrap over pairs."""
    rng, count = np.random.default_rng(0), cost.shape[1]

    def fitted(chosen: np.ndarray) -> float:
        return float(np.polyfit(np.log(voxels), np.log(cost[:, chosen].sum(axis=1)), 1)[0])

    drawn = [fitted(rng.integers(0, count, count)) for _ in range(1000)]
    low, high = np.quantile(drawn, [0.025, 0.975])
    return fitted(np.arange(count)), float(low), float(high)


def growth(quick: bool) -> Growth:
    """A* on Table 1's city, from voxels of 2 m to such of 0.2 m."""
    cells, count = (CELLS[:3], 5) if quick else (CELLS, 20)
    pairs = table1_city(2.0).random_pairs(count, rng=2022, min_clearance=2.0)
    voxels, expanded, seconds = [], [], []
    for cell in cells:
        city = table1_city(cell)
        astar(city, *pairs[0])
        asked = [clocked(lambda pair=pair: astar(city, *pair)) for pair in pairs]  # type: ignore[misc]  # noqa: B023
        voxels.append(city.occupied.size)
        expanded.append([route.info["expanded"] for route, _ in asked])
        seconds.append([each for _, each in asked])
    return Growth(np.array(voxels), np.array(expanded), np.array(seconds))


def clocked(ask: Callable[[], Any]) -> tuple[Any, float]:
    """An answer and its processor time [s]."""
    began = time.process_time()
    answer = ask()
    return answer, time.process_time() - began


def copied_per_second() -> float:
    """Bytes that a copy of a large array reads and writes in a second: what memory gives."""
    source = np.ones(2**27, np.uint8)
    target = np.zeros_like(source)
    return max(2 * source.nbytes / clocked(lambda: np.copyto(target, source))[1] for _ in range(5))


def rows_of(quick: bool) -> Iterator[tuple[Peer, Measured | None]]:
    """What each peer does, None where it isn't installed."""
    for peer in PEERS:
        print(f"{peer.question}: {peer.name}", file=sys.stderr)
        yield peer, peer.measure(quick) if version_of(peer.package) else None


def page(rows: list[tuple[Peer, Measured | None]], grown: Growth, quick: bool) -> str:
    """As Markdown."""
    packages = ("numpy", "numba", "scipy", *dict.fromkeys(peer.package for peer in PEERS if peer.package != "scipy"))
    versions = ", ".join(f"{package} {version_of(package) or '(not installed)'}" for package in packages)
    lines = [
        "# uavlab and the world's planners",
        "",
        f"Made by `python tests/benchmarks/world.py --write{' --quick' * quick}`, {datetime.date.today().isoformat()}: "
        f"uavlab {__version__}, {next(machine())}, Python {sys.version.split()[0]}, {versions}. Processor time of one "
        "thread. The ratio is the peer's total time to ours; intervals are of 95 %, by the bootstrap over questions. "
        "What a peer can prepare for a map (a graph, a grid of nodes) is prepared outside of the clock.",
        "",
        "| question | peer | questions | ours [ms] | theirs [ms] | times ours | 95 % | cost of the answers |",
        "| --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    for peer, measured in rows:
        if measured is None:
            lines.append(f"| {peer.question} | {peer.name} | | | | not installed | | |")
            continue
        ratio, low, high = ratio_of(measured)
        cells = [
            peer.question, peer.name, str(len(measured.ours)),
            *map(three_digits, (1000 * measured.ours.mean(), 1000 * measured.theirs.mean(), ratio)),
            f"{three_digits(low)} to {three_digits(high)}", measured.answers,
        ]  # fmt: skip
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join([*lines, "", *growth_lines(grown)]) + "\n"


def growth_lines(grown: Growth) -> Iterator[str]:
    """How the cost grows, and how near that is to what memory gives."""
    memory = copied_per_second()
    yield "## How the cost of A\\* grows with the map"
    yield ""
    yield f"The same {grown.seconds.shape[1]} pairs in Table 1's city, in ever finer voxels:"
    yield ""
    yield "| voxels | expanded, mean | ms, mean | ns an expansion | GB/s | of memory's |"
    yield "| --- | --- | --- | --- | --- | --- |"
    for voxels, expanded, seconds in zip(grown.voxels, grown.expanded, grown.seconds, strict=True):
        rate = LINES * 64 * expanded.sum() / seconds.sum()
        yield (
            f"| {round(voxels ** (1 / 3))}³ | {expanded.mean():,.0f} | {three_digits(1000 * seconds.mean())} | "
            f"{1e9 * seconds.sum() / expanded.sum():.0f} | {rate / 1e9:.2g} | {100 * rate / memory:.0f} % |"
        )
    yield ""
    times, nodes = (exponent(grown.voxels, cost) for cost in (grown.seconds, grown.expanded))
    yield (
        f"Time grows as voxels^b with b = {times[0]:.2f} [{times[1]:.2f}, {times[2]:.2f}], expanded voxels with b = "
        f"{nodes[0]:.2f} [{nodes[1]:.2f}, {nodes[2]:.2f}]. (1 is the whole volume, 1/3 a line through it.) A copy "
        f"of a large array reads and writes {memory / 1e9:.1f} GB in a second here. An expansion looks at {LINES} "
        "lines of 64 bytes of the cache. GB/s counts them as if each came from memory: the most that it can have given."
    )


def picture(rows: list[tuple[Peer, Measured | None]]) -> Any:
    """Ratios with intervals, the longest first."""
    from matplotlib.figure import Figure

    known = [(peer, ratio_of(measured)) for peer, measured in rows if measured is not None and peer.alike]
    known.sort(key=lambda row: row[1][0])
    figure = Figure(figsize=(8.0, 0.42 * len(known) + 1.3), layout="constrained")
    axes = figure.subplots()
    color = colors.styles(["uavlab"])[0].color
    for place, (_, (ratio, low, high)) in enumerate(known):
        axes.plot([low, high], [place, place], color=color, lw=2)
        axes.plot(ratio, place, "o", color=color)
        axes.annotate(three_digits(ratio), (max(ratio, high), place), (6, 0), textcoords="offset points", va="center")
    axes.set_xscale("log")
    axes.xaxis.set_major_formatter("{x:g} ×")
    axes.axvline(1, color="black", lw=1)
    axes.set_yticks(range(len(known)), [f"{peer.name}\n{peer.question}" for peer, _ in known], fontsize=8)
    axes.set_xlim(min(0.7, *(row[1][1] for row in known)), 4 * max(row[1][2] for row in known))
    axes.set_xlabel("time that it takes, in times that of uavlab (logarithmic; lines: intervals of 95 %)")
    axes.set_title("Other people's libraries beside uavlab: the same questions, one thread", fontsize=10)
    axes.grid(visible=True, axis="x", alpha=0.4)
    axes.spines[["top", "right"]].set_visible(False)
    return figure


def in_short(rows: list[tuple[Peer, Measured | None]]) -> Iterator[str]:
    """The table of README: those that answer the same question and stop when they have the answer."""
    yield "| question | beside | ours [ms] | times ours | 95 % | cost of the answers |"
    yield "|---|---|---|---|---|---|"
    for peer, measured in rows:
        if measured is not None and peer.alike:
            ratio, low, high = map(three_digits, ratio_of(measured))
            ours = three_digits(1000 * measured.ours.mean())
            yield f"| {peer.question} | {peer.name} | {ours} | {ratio} | {low} to {high} | {measured.answers} |"


def put_in_short(rows: list[tuple[Peer, Measured | None]]) -> None:
    """Write the table of README anew."""
    text = README.read_text(encoding="utf-8")
    table = list(in_short(rows))
    begin = text.index(table[0])
    end = text.index("\n\n", begin)
    README.write_text(text[:begin] + "\n".join(table) + text[end:], encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="fewer questions, smaller maps")
    parser.add_argument("--write", action="store_true", help="put page and picture in their places")
    options = parser.parse_args()
    grown = growth(options.quick)
    rows = list(rows_of(options.quick))
    text = page(rows, grown, options.quick)
    print(text)
    if options.write:
        PAGE.write_text(text, encoding="utf-8")
        put_in_short(rows)
        picture(rows).savefig(PICTURE, dpi=110)


if __name__ == "__main__":
    main()
