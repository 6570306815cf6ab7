"""Every public function that takes a city, with one of 12 billion voxels: it works, or is refused."""

import contextlib
import sys

import pytest
from calls import CALLS
from runner import PATIENCE, invoke, parameters_of, rightful, within

from uavlab.city import City, LazyCity

MOST = 5e9
"""No call may take more memory [bytes]; all voxels would be 12 GB."""


def endless(town):
    """The same buildings on ten by ten kilometres."""
    size = (10_000.0, 10_000.0, 120.0)
    return City.from_buildings(town.buildings, origin=town.origin, size=size, no_fly=town.no_fly, lazy=True,
                               reference=town.reference)  # fmt: skip


@contextlib.contextmanager
def little_memory():
    """A `MemoryError` for who asks for more than `MOST`."""
    if not sys.platform.startswith("linux"):
        yield
        return
    import resource

    before = resource.getrlimit(resource.RLIMIT_AS)
    with open("/proc/self/statm", encoding="ascii") as file:
        used = int(file.read().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (int(used + MOST), before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, before)


def calls_with_a_city():
    """Where a city stands, with all arguments and with those alone that must be given."""
    for key in CALLS:
        for name, value in rightful(key).items():
            if isinstance(value, City) and not isinstance(value, LazyCity) and value.buildings:
                yield key, name, False
                yield key, name, True


@pytest.mark.parametrize(("key", "name", "least"), list(calls_with_a_city()))
def test_a_lazy_city_works_or_is_refused(key, name, least):
    arguments = rightful(key)
    if least:
        asked = parameters_of(key)
        arguments = {each: value for each, value in arguments.items() if asked[each].default is asked[each].empty}
        if name not in arguments:
            return
    city = arguments[name] = endless(arguments[name])
    with little_memory(), within(PATIENCE), contextlib.suppress(ValueError):
        if name == "self":
            getattr(city, key.split(":")[0].rpartition(".")[2])  # a lazy city refuses where it is asked for it
        invoke(key, arguments)
