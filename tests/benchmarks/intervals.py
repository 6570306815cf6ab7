"""How often the intervals of crash rates hold the true rate, for few and for many routes, printed as a table.

Routes have crash rates of their own, drawn from Beta distributions; flights of a route are independent. Run it as
`python tests/benchmarks/intervals.py`; three minutes.
"""

import numpy as np
from astar import print_table

from uavlab.statistics import grouped_share_interval

LAWS = {"Beta(.2, 5)": (0.2, 5.0), "Beta(.02, 2)": (0.02, 2.0), "Beta(1, 99)": (1.0, 99.0), "Beta(3, 2)": (3.0, 2.0),
        "Beta(40, 4000)": (40.0, 4000.0)}  # fmt: skip
ROUTES = (2, 3, 5, 10, 20, 50, 100)


def covered(law: tuple[float, float], routes: int, flights: int, runs: int, seed: int = 0) -> tuple[float, ...]:
    """Shares of runs whose interval holds the truth, lies below it and above it; and its mean width."""
    rng = np.random.default_rng(seed)
    truth = law[0] / (law[0] + law[1])
    crashes = rng.binomial(flights, rng.beta(*law, (runs, routes)))
    ends = np.array([grouped_share_interval(row, flights) for row in crashes])
    low, high = ends.T
    return ((low <= truth) & (truth <= high)).mean(), (high < truth).mean(), (low > truth).mean(), (high - low).mean()


def main() -> None:
    for flights in (20, 200):
        rows = []
        for name, law in LAWS.items():
            for routes in ROUTES:
                inside, below, above, width = covered(law, routes, flights, 100)
                rows.append([name, str(routes), f"{inside:.1%}", f"{below:.1%}", f"{above:.1%}", f"{1000 * width:.3g}"])
        header = ["rates of routes", "routes", "holds it", "below it", "above it", "mean width [per 1 000]"]
        print_table(f"{flights} flights a route, 100 runs", header, rows)


if __name__ == "__main__":
    main()
