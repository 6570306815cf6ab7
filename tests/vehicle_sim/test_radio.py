"""A radio that is slow, late and loses packets."""

import numpy as np
import pytest

from uavlab.vehicle_sim import P840, PERFECT_LINK, DataLink
from uavlab.vehicle_sim.radio import Channel


def channel(link):
    return Channel(link, np.random.default_rng(0))


def test_a_perfect_link_delivers_at_once_in_order():
    line = channel(PERFECT_LINK)
    for number in range(5):
        line.put(1.0, 100, number)
    assert line.due(0.9) == []
    assert line.due(1.0) == [0, 1, 2, 3, 4]
    assert line.due(2.0) == []


def test_packets_get_lost_as_often_as_said():
    line = channel(DataLink(loss=0.1))
    for number in range(10_000):
        line.put(0.0, 10, number)
    assert len(line.due(1.0)) == pytest.approx(9000, abs=100)


def test_what_is_late_comes_late():
    line = channel(DataLink(delay=0.2, jitter=0.05))
    for number in range(2000):
        line.put(number * 1.0, 10, number)
    lateness = [at - number for at, _, number in line.queue]
    assert min(lateness) >= 0.2
    assert np.mean(lateness) == pytest.approx(0.2 + 0.05 * np.sqrt(2 / np.pi), abs=0.003)


def test_a_slow_line_makes_a_queue():
    line = channel(DataLink(bit_rate=10_000.0))
    for number in range(10):
        line.put(0.0, 100, number)  # a tenth of a second each
    assert len(line.due(0.55)) == 5
    assert len(line.due(1.001)) == 5


def test_the_paper_s_radio_is_as_quick_as_it_says():
    assert P840.bit_rate == 57_600.0
    line = channel(P840)
    line.put(0.0, 576, "packet")
    ((at, _, _),) = line.queue
    assert at > 0.1 + 0.05


@pytest.mark.parametrize(
    ("name", "value"),
    [("bit_rate", 0), ("bit_rate", -1), ("bit_rate", float("nan")), ("delay", -0.1), ("delay", float("inf")),
     ("jitter", -1), ("loss", 1.5), ("loss", -0.1), ("loss", "much"), ("delay", None)],
)  # fmt: skip
def test_wrong_values_are_named(name, value):
    with pytest.raises(ValueError, match=name):
        DataLink(**{name: value})
