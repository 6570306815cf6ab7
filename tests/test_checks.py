"""What several functions check alike."""

import numpy as np
import pytest

from uavlab import checks
from uavlab.city import City
from uavlab.flight import OffsetProcess, monte_carlo
from uavlab.offsets import offset_paths
from uavlab.optimizers import bas, pso, pso_bas
from uavlab.risk import random_campus
from uavlab.route import Route
from uavlab.vehicle import LIGHT_QUADROTOR

EMPTY = City(np.zeros((9, 9, 9), bool))
DRAWING = {
    "random_pairs": lambda rng: EMPTY.random_pairs(1, rng, apart=2.0),
    "offset_paths": lambda rng: offset_paths(1.0, 2.0, rng),
    "pso": lambda rng: pso(lambda x: (x**2).sum(axis=-1), [(0, 1)], budget=40, rng=rng),
    "bas": lambda rng: bas(lambda x: (x**2).sum(axis=-1), [(0, 1)], budget=40, rng=rng),
    "pso_bas": lambda rng: pso_bas(lambda x: (x**2).sum(axis=-1), [(0, 1)], budget=40, rng=rng),
    "random_campus": random_campus,
    "monte_carlo": lambda rng: monte_carlo(
        Route([(1, 1, 1), (8, 8, 8)]), EMPTY, LIGHT_QUADROTOR, OffsetProcess(), rng=rng, flights=1
    ),
}


@pytest.mark.parametrize("rng", [None, 1.5, -1, "1", True, [], [1, None], np.random])
@pytest.mark.parametrize("draw", DRAWING.values(), ids=DRAWING)
def test_what_gives_other_results_each_time_is_no_seed(draw, rng):
    with pytest.raises(ValueError, match=r"rng must be a numpy\.random\.Generator, or a seed .*, got "):
        draw(rng)


def test_a_seed_of_any_width_is_one():
    for seed in (3, np.int64(3), np.uint8(3)):
        assert checks.generator("rng", seed).random() == np.random.default_rng(3).random()
    assert checks.generator("rng", [1, np.int64(2)]).random() == np.random.default_rng([1, 2]).random()
    rng = np.random.default_rng(0)
    assert checks.generator("rng", rng) is rng
