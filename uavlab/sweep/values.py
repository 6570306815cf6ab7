"""Results as text that holds them exactly, without pickle; and fingerprints that tell cases apart.

JSON holds numbers and text to the last bit. What it lacks gets a tag: `{"!array": …}` is NumPy's own format in base64,
`{"!thing": …}` a dataclass or named tuple by its fields. Reading such a text imports nothing and calls nothing: a thing
is made only of a class that is there already, field by field. So a file that somebody else wrote can't run anything.
"""

from __future__ import annotations

import base64
import hashlib
import inspect
import io
import json
import math
import sys
import types
from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass
from functools import cached_property, partial
from typing import Any

import joblib
import numpy as np

KINDS = "numbers, text, NumPy arrays, and lists, tuples, sets, dicts, dataclasses and named tuples of them"


def as_text(value: Any) -> str:
    """A value in one line of ASCII; `TypeError` for what can't be held exactly."""
    try:
        return json.dumps(described(value), allow_nan=False, separators=(",", ":"))
    except RecursionError:
        raise TypeError("it holds things in things without end") from None


def described(value: Any) -> Any:
    """A value as JSON has it."""
    kind = type(value)
    if value is None or kind in (bool, int, str):
        return value
    if kind is float:
        return value if math.isfinite(value) else {"!float": repr(value)}
    if kind is list:
        return [described(item) for item in value]
    if kind is dict:
        if all(type(key) is str and not key.startswith("!") for key in value):
            return {key: described(item) for key, item in value.items()}
        return {"!dict": [[described(key), described(item)] for key, item in value.items()]}
    if kind in (tuple, set, frozenset):
        items = [described(item) for item in value]
        return {f"!{kind.__name__}": items if kind is tuple else sorted(items, key=json.dumps)}
    if kind is complex:
        return {"!complex": [described(value.real), described(value.imag)]}
    if kind is bytes:
        return {"!bytes": base64.b64encode(value).decode()}
    if isinstance(value, np.generic) or kind in (np.ndarray, np.memmap):
        return described_array(value)
    return described_thing(value)


def described_array(value: Any) -> dict[str, Any]:
    """An array, or one number of it, in NumPy's format."""
    if isinstance(value, np.generic) and value.dtype.kind in "biuf" and value.dtype.itemsize <= 8:
        return {"!number": value.dtype.str, "is": described(value.item())}
    if value.dtype.hasobject:
        raise TypeError("an array of Python objects")
    content = io.BytesIO()
    np.save(content, np.asarray(value), allow_pickle=False)
    text = base64.b64encode(content.getvalue()).decode()
    return {"!scalar" if isinstance(value, np.generic) else "!array": text}


def described_thing(value: Any) -> dict[str, Any]:
    """A dataclass or a named tuple: the name of its class, and its fields."""
    kind = type(value)
    name = f"{kind.__module__}:{kind.__qualname__}"
    if class_of(name) is not kind:
        raise TypeError(f"a {kind.__name__}")
    if is_named_tuple(kind):
        return {"!thing": name, "fields": {key: described(getattr(value, key)) for key in kind._fields}}
    names, held = [one.name for one in fields(value)], getattr(value, "__dict__", {})
    cached = [key for key in held if isinstance(inspect.getattr_static(kind, key, None), cached_property)]
    if more := set(held) - {*names, *cached}:
        raise TypeError(f"a {kind.__name__} with more than its fields, {', '.join(sorted(more))}")
    return {"!thing": name, "fields": {key: described(getattr(value, key)) for key in names}}


def is_named_tuple(kind: type) -> bool:
    return issubclass(kind, tuple) and kind.__new__ is not tuple.__new__ and hasattr(kind, "_fields")


def class_of(name: str) -> type | None:
    """The dataclass or named tuple of a name, in a module that is imported already; else None."""
    module, _, path = name.partition(":")
    found: Any = sys.modules.get(module)
    for part in path.split("."):
        found = inspect.getattr_static(found, part, None)
    return found if isinstance(found, type) and (is_dataclass(found) or is_named_tuple(found)) else None


def read(value: Any) -> Any:
    """The value of JSON that `as_text` wrote; `ValueError` for what isn't."""
    try:
        return made(value)
    except (
        ValueError, TypeError, KeyError, AttributeError, EOFError, OverflowError, RecursionError, MemoryError,
    ) as error:  # fmt: skip
        raise ValueError(f"no value that a sweep wrote: {error}") from error


def made(value: Any) -> Any:
    """The value that was described."""
    if isinstance(value, list):
        return [made(item) for item in value]
    if not isinstance(value, dict):
        return value
    tag = next(iter(value), "")
    if not tag.startswith("!"):
        return {key: made(item) for key, item in value.items()}
    content = value[tag]
    if tag == "!thing":
        return made_thing(content, {key: made(item) for key, item in value["fields"].items()})
    if tag in ("!array", "!scalar"):
        array = np.lib.format.read_array(io.BytesIO(base64.b64decode(content)), allow_pickle=False)
        return array if tag == "!array" else array[()]
    if tag == "!number":
        return np.dtype(content).type(made(value["is"]))
    if tag == "!dict":
        return {made(key): made(item) for key, item in content}
    if tag == "!complex":
        return complex(*map(made, content))
    if tag == "!bytes":
        return base64.b64decode(content)
    makers: dict[str, Callable[[Any], Any]] = {"!float": float, "!tuple": tuple, "!set": set, "!frozenset": frozenset}
    return makers[tag](made(content))


def made_thing(name: str, content: dict[str, Any]) -> Any:
    """A thing of a class that is known already; nothing of it is called."""
    kind: Any = class_of(name)
    module, _, path = name.partition(":")
    if kind is None:
        raise ValueError(f"it holds a {path} of {module}: import {module} before")
    known = kind._fields if is_named_tuple(kind) else [one.name for one in fields(kind)]
    if list(known) != list(content):
        raise ValueError(f"it holds a {path} of another version of {module}, with {', '.join(content)}")
    if is_named_tuple(kind):
        return tuple.__new__(kind, content.values())
    thing = object.__new__(kind)
    for key, item in content.items():
        object.__setattr__(thing, key, item)
    return thing


def fingerprint(value: Any, seen: dict[int, tuple[Any, str]]) -> str:
    """A text that equal values share, in any process; `TypeError` for what has none.

    `seen` remembers things by their id, as the cases of a sweep share large ones; and them, so that no other gets it.
    """
    kind = type(value)
    if value is None or kind in (bool, int, float, complex, str, bytes):
        return f"{kind.__name__} {value!r}"
    if id(value) not in seen:
        seen[id(value)] = value, f"{kind.__name__} {hashlib.sha256(parts(value, seen).encode()).hexdigest()}"
    return seen[id(value)][1]


def parts(value: Any, seen: dict[int, tuple[Any, str]]) -> str:
    """What a thing is made of, in fingerprints."""
    if isinstance(value, list | tuple):
        return " ".join(fingerprint(item, seen) for item in value)
    if isinstance(value, Mapping):
        return " ".join(sorted(f"{fingerprint(key, seen)}: {fingerprint(value[key], seen)}" for key in value))
    if is_dataclass(value) and not isinstance(value, type):
        return name_of(type(value)) + parts({one.name: getattr(value, one.name) for one in fields(value)}, seen)
    if isinstance(value, np.random.Generator):
        sequence: Any = value.bit_generator.seed_seq
        return f"{parts(value.bit_generator.state, seen)} {sequence.n_children_spawned} {sequence!r}"
    if isinstance(value, partial):
        return " ".join(fingerprint(part, seen) for part in (value.func, value.args, value.keywords))
    if isinstance(value, types.MethodType | types.BuiltinMethodType) and not isinstance(
        value.__self__, types.ModuleType
    ):
        return f"{fingerprint(value.__self__, seen)} {value.__name__}"
    if isinstance(value, type | types.FunctionType | types.BuiltinFunctionType) or hasattr(value, "__wrapped__"):
        name, held = name_of(value), [cell.cell_contents for cell in getattr(value, "__closure__", None) or ()]
        if "<locals>" in name:  # of one name there may be several, which differ in what they were made with
            held += [getattr(value, "__defaults__", None), getattr(value, "__kwdefaults__", None)]
        return " ".join([name, *(fingerprint(item, seen) for item in held)])
    return str(joblib.hash(value, hash_name="sha1"))


def name_of(value: Any) -> str:
    """Module and name of a function or class; `TypeError` for a lambda, which has none."""
    name = f"{getattr(value, '__module__', None)}.{getattr(value, '__qualname__', type(value).__qualname__)}"
    if "<lambda>" in name:
        raise TypeError("a lambda, of which nobody can tell whether it is the same: def it by a name")
    return name
