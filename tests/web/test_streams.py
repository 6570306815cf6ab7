"""Random numbers in compiled code without NumPy's generator: the same as with it."""

import numpy as np
import pytest
from numba import njit

from uavlab.web.craft import state_of
from uavlab.web.generator import Stream, multiplied, next_double, next_word, normal_from

MANY = 2_000_000
"""Normal numbers; one of 2 700 comes from the ziggurat's tail, one of 70 is looked at twice."""


@njit
def filled(stream, count):
    """By the method, as flights ask for it."""
    numbers = np.empty(count)
    for n in range(count):
        numbers[n] = stream.standard_normal()
    return numbers


@njit
def filled_from(state, count):
    numbers = np.empty(count)
    for n in range(count):
        numbers[n] = normal_from(state)
    return numbers


@njit
def doubles_from(state, count):
    numbers = np.empty(count)
    for n in range(count):
        numbers[n] = next_double(state)
    return numbers


def test_two_million_numbers_are_numpy_s():
    generator = np.random.default_rng(2026)
    state = state_of(generator)
    numbers = filled_from(state, MANY)
    assert np.array_equal(numbers, generator.standard_normal(MANY))
    assert np.array_equal(state, state_of(generator))  # both go on from there
    assert np.abs(numbers).max() > 3.7  # beyond the ziggurat's last layer


@pytest.mark.parametrize("seed", range(5))
def test_compiled_code_calls_the_method_of_a_stream_as_of_a_generator(seed):
    generator = np.random.default_rng(seed).spawn(3)[2]
    numbers = filled(Stream(state_of(generator)), 100_000)
    assert np.array_equal(numbers, generator.standard_normal(100_000))
    assert np.array_equal(numbers, filled(np.random.default_rng(seed).spawn(3)[2], 100_000))


def test_a_stream_in_python():
    generator = np.random.default_rng(3)
    stream = Stream(state_of(generator))
    assert [stream.standard_normal() for _ in range(1000)] == generator.standard_normal(1000).tolist()


def test_words_and_doubles_are_numpy_s():
    generator = np.random.default_rng(4)
    state = state_of(generator)
    assert np.array_equal(doubles_from(state, 100_000), generator.random(100_000))
    assert [int(next_word(state)) for _ in range(100)] == generator.bit_generator.random_raw(100).tolist()


@pytest.mark.parametrize(
    "state",
    [(2**64 - 1, 2**64 - 1, 2**64 - 1, 2**64 - 1), (0, 0, 0, 1), (2**64 - 1, 0, 0, 2**64 - 1), (0, 2**63, 1, 3)],
)
def test_carries_from_word_to_word(state):
    """States at which sums and products overflow."""
    generator = np.random.default_rng(0)
    number, increment = state[0] << 64 | state[1], state[2] << 64 | state[3]
    generator.bit_generator.state = generator.bit_generator.state | {"state": {"state": number, "inc": increment}}
    words = np.array(state, dtype=np.uint64)
    assert np.array_equal(state_of(generator), words)
    assert [int(next_word(words)) for _ in range(1000)] == generator.bit_generator.random_raw(1000).tolist()


def test_products_of_64_bits():
    rng = np.random.default_rng(5)
    numbers = [0, 1, 2**32 - 1, 2**32, 2**64 - 1, *rng.integers(0, 2**64, 200, dtype=np.uint64).tolist()]
    for one in numbers:
        for other in numbers[:25]:
            high, low = multiplied(np.uint64(one), np.uint64(other))
            assert int(high) << 64 | int(low) == one * other


@pytest.mark.parametrize("kind", [np.random.MT19937, np.random.Philox, np.random.SFC64, np.random.PCG64DXSM])
def test_other_generators_are_refused_by_name(kind):
    with pytest.raises(ValueError, match=f"generator must be a default_rng, .* got a {kind.__name__}$"):
        state_of(np.random.Generator(kind(1)))


def test_a_state_is_a_copy():
    generator = np.random.default_rng(6)
    filled(Stream(state_of(generator)), 10)
    assert generator.standard_normal() == np.random.default_rng(6).standard_normal()
