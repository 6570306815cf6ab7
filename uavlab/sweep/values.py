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
from collections.abc import Callable
from dataclasses import fields, is_dataclass
from functools import cached_property, partial
from pathlib import Path
from typing import Any

import joblib
import numpy as np

LONG = 14_000
"""Bits of a whole number that Python makes no decimal digits of, nearly, as that takes long."""

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
    if value is None or kind in (bool, str):
        return value
    if kind is int:
        return value if value.bit_length() < LONG else {"!int": hex(value)}
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
    if class_of(name) is not kind or not (is_named_tuple(kind) or is_plain(kind)):
        raise TypeError(f"a {kind.__name__}")
    if more := beside_fields(value):
        raise TypeError(f"a {kind.__name__} with more than its fields, {', '.join(sorted(more))}")
    return {"!thing": name, "fields": {key: described(getattr(value, key)) for key in field_names(kind)}}


def field_names(kind: Any) -> list[str]:
    """The fields of a dataclass or named tuple."""
    return list(kind._fields) if is_named_tuple(kind) else [one.name for one in fields(kind)]


def beside_fields(value: Any) -> dict[str, Any]:
    """What a dataclass or named tuple holds beside its fields, but for what it can compute again."""
    kind, held = type(value), getattr(value, "__dict__", {})
    more = {key: held[key] for key in held if key not in field_names(kind)}
    return {key: more[key] for key in more if not isinstance(inspect.getattr_static(kind, key, None), cached_property)}


def is_plain(kind: type) -> bool:
    """Whether a class is no list, exception or other thing whose content isn't in its fields."""
    try:
        object.__new__(kind)
    except TypeError:
        return False
    return True


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
    if tag == "!int":
        return int(content, 16)
    makers: dict[str, Callable[[Any], Any]] = {"!float": float, "!tuple": tuple, "!set": set, "!frozenset": frozenset}
    return makers[tag](made(content))


def made_thing(name: str, content: dict[str, Any]) -> Any:
    """A thing of a class that is known already; nothing of it is called."""
    kind: Any = class_of(name)
    module, _, path = name.partition(":")
    if kind is None:
        raise ValueError(f"it holds a {path} of {module}: import {module} before")
    if field_names(kind) != list(content):
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
    if kind is int:
        return f"int {value:x}"
    if value is None or kind in (bool, float, complex, str, bytes):
        return f"{kind.__name__} {value!r}"
    if id(value) not in seen:
        seen[id(value)] = value, f"{kind.__name__} {hashlib.sha256(parts(value, seen).encode()).hexdigest()}"
    return seen[id(value)][1]


def parts(value: Any, seen: dict[int, tuple[Any, str]]) -> str:
    """What a thing is made of, in fingerprints."""
    kind = type(value)
    if kind in (list, tuple):
        return " ".join(fingerprint(item, seen) for item in value)
    if kind in (set, frozenset):
        return " ".join(sorted(fingerprint(item, seen) for item in value))
    if kind in (dict, types.MappingProxyType):
        return " ".join(sorted(f"{fingerprint(key, seen)}: {fingerprint(value[key], seen)}" for key in value))
    if is_named_tuple(kind) or (is_dataclass(kind) and is_plain(kind)):
        things = {key: getattr(value, key) for key in field_names(kind)} | beside_fields(value)
        return name_of(kind) + parts(things, seen)
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
        seen[id(value)] = value, f"itself {name}"  # as it may call itself
        if "<locals>" in name:  # of one name there may be several, which differ in what they were made with
            held += [getattr(value, "__defaults__", None), getattr(value, "__kwdefaults__", None)]
        return " ".join([name, *(fingerprint(item, seen) for item in held)])
    return str(joblib.hash(value, hash_name="sha1"))


def name_of(value: Any) -> str:
    """Module and name of a function or class; `TypeError` for a lambda, which has none."""
    module = getattr(value, "__module__", None)
    name = f"{name_of_script() if module == '__main__' else module}."
    name += getattr(value, "__qualname__", type(value).__qualname__)
    if "<lambda>" in name:
        raise TypeError("a lambda, of which nobody can tell whether it is the same: def it by a name")
    return name


def name_of_script() -> str:
    """What `__main__` is when it is imported: all scripts have that name."""
    main = sys.modules["__main__"]
    spec, file = getattr(main, "__spec__", None), getattr(main, "__file__", None)
    return spec.name if spec else Path(file).stem if file else "__main__"


def text_mark(function: Any) -> str | None:
    """A mark of the text of a function, or of its class; None where there is no text, as in a console."""
    while isinstance(function, partial):
        function = function.func
    thing = inspect.unwrap(function)
    try:
        text = inspect.getsource(thing if isinstance(thing, type) or inspect.isroutine(thing) else type(thing))
    except (OSError, TypeError):
        return None
    return hashlib.sha256(text.encode(errors="surrogatepass")).hexdigest()[:16]
