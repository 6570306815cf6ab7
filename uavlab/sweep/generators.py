"""Random generators that a sweep comes with: no two cases may have the same, and each case draws from a copy.

In another process a case draws from a copy anyway. In this one it would leave the generator changed: for the next case,
which then has other numbers than elsewhere, or for the next call, which then isn't the same any more.
"""

from __future__ import annotations

import copy
import dis
import random
import types
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import fields, is_dataclass
from functools import partial
from itertools import islice
from typing import Any

import numpy as np

KINDS = (np.random.Generator, np.random.RandomState, np.random.BitGenerator, random.Random)
PLAIN = (type(None), bool, int, float, complex, str, bytes, np.ndarray, type, types.ModuleType)

MOST = 10_000
"""How many things in a value are looked at, those near its top first: a large map shall not hold up the sweep."""


class OwnGenerators(Sequence[Mapping[str, Any]]):
    """Cases, each with copies of its random generators whenever it is asked for.

    `ValueError` if two cases share one, or if the function holds one, which all cases would share.
    """

    def __init__(self, function: Callable[..., Any], cases: Sequence[Mapping[str, Any]]) -> None:
        self.cases, self.names = cases, dict[int, list[str]]()
        if len(cases) > 1 and generators_in(function):
            raise ValueError(
                "function holds a random generator, which all cases would share, so that results would depend on where "
                "they run: give each case a seed, and make the generator in the function"
            )
        known: dict[int, tuple[Any, list[Any]]] = {}
        owners: dict[int, int] = {}
        for number, case in enumerate(cases):
            for name, value in case.items():
                if isinstance(value, PLAIN):
                    continue
                if id(value) not in known:
                    known[id(value)] = value, generators_in(value)
                for rng in known[id(value)][1]:
                    if owners.setdefault(id(rng), number) != number:
                        raise ValueError(shared(owners[id(rng)], number, name, rng, value, len(cases)))
                    self.names.setdefault(number, []).append(name)

    def __len__(self) -> int:
        return len(self.cases)

    def __getitem__(self, number: int) -> dict[str, Any]:  # type: ignore[override]
        case = dict(self.cases[number])
        if names := self.names.get(number):
            with suppress(Exception):  # what holds a lock, say, can't be copied, and doesn't travel either
                case |= copy.deepcopy({name: case[name] for name in names})
        return case


def shared(first: int, second: int, name: str, rng: Any, value: Any, count: int) -> str:
    """Words on a random generator that two cases have."""
    what = name if rng is value else f"what is in {name}"
    spawned = f", or one of {name}.spawn({count})" * (rng is value and isinstance(rng, np.random.Generator))
    return (
        f"cases {first} and {second} share {what}, a random generator, so that results would depend on where they run: "
        f"give each a seed{spawned}"
    )


def generators_in(value: Any) -> list[Any]:
    """The random generators that a value is or holds."""
    found: list[Any] = []
    seen: dict[int, Any] = {}
    waiting = deque([value])
    for _ in range(MOST):
        if not waiting:
            break
        thing = waiting.popleft()
        if id(thing) in seen or isinstance(thing, PLAIN):
            continue
        seen[id(thing)] = thing
        if isinstance(thing, KINDS):
            found.append(thing)
        else:
            waiting.extend(islice(parts_of(thing), MOST))
    return found


def parts_of(thing: Any) -> Iterator[Any]:
    """What a thing holds, as far as it can be seen without calling anything of it."""
    if isinstance(thing, list | tuple):
        yield from thing
    elif isinstance(thing, dict | types.MappingProxyType):
        yield from thing.values()
    elif isinstance(thing, partial):
        yield from (thing.func, thing.args, thing.keywords)
    elif isinstance(thing, types.MethodType | types.BuiltinMethodType):
        yield thing.__self__
    elif isinstance(thing, types.FunctionType):
        yield from globals_of(thing)
        yield from thing.__defaults__ or ()
        for cell in thing.__closure__ or ():
            with suppress(ValueError):  # nothing is in it yet
                yield cell.cell_contents
    elif is_dataclass(thing):
        yield from (getattr(thing, one.name, None) for one in fields(thing))  # those with slots have no __dict__
    yield getattr(thing, "__dict__", None)


def globals_of(function: types.FunctionType) -> list[Any]:
    """The random generators among what a function finds in its module; attributes of such a name are others."""
    names = {one.argval for one in dis.get_instructions(function) if one.opname == "LOAD_GLOBAL"}
    return [function.__globals__[name] for name in names if isinstance(function.__globals__.get(name), KINDS)]
