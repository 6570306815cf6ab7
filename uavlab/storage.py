"""Routes, curves, cities and risk maps in files: saved once, loaded anywhere, without pickle.

A file is NumPy's `.npz`: arrays, and beside them a text (JSON) that says what they make. Loading runs the same checks
as making the thing anew, so a file that was changed or cut off is refused and can't run anything.
"""

from __future__ import annotations

import json
import math
import warnings
import zipfile
import zlib
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np

from uavlab import checks
from uavlab.city import Building, City, LazyCity, NoFlyZone
from uavlab.city.place import Place
from uavlab.city.source import Entry, Source
from uavlab.files import written_whole
from uavlab.planners.repare import Plan
from uavlab.risk import RiskMap
from uavlab.route import Route
from uavlab.spline import Curve
from uavlab.vehicle import UAV

Saved = Route | Curve | City | RiskMap

KINDS: dict[str, Any] = {
    kind.__name__: kind for kind in (Route, Curve, City, RiskMap, Building, NoFlyZone, Place, Source, Entry, UAV, Plan)
}
HEADER, VERSION = "uavlab", 1
DEEPEST = 20
"""Nothing that is saved holds things in things in things so often."""


def save(thing: Saved, path: str | Path) -> None:
    """Write a route, a curve, a city or a risk map to a file.

    An older file of that name is replaced once the new one is whole.

    Parameters
    ----------
    thing : Route, Curve, City or RiskMap
        With all that it holds; of `info` what is a number, a text, an array, or made of them. What isn't is left out,
        with a warning.
    path : str or Path
        Usually with the ending .npz; the file has exactly this name.

    Raises
    ------
    ValueError
        If `thing` is none of these, or `path` is not the name of a file.

    See Also
    --------
    load : the way back.
    uavlab.route.Route.to_csv : waypoints for a spreadsheet.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from uavlab.route import Route
    >>> from uavlab.storage import load, save
    >>> file = Path(tempfile.mkdtemp()) / "route.npz"
    >>> save(Route([(0, 0, 10), (30, 40, 10)], min_clearance=3.5), file)
    >>> load(file).length, load(file).min_clearance
    (50.0, 3.5)
    """
    if not isinstance(thing, Route | Curve | City | RiskMap):
        raise ValueError(f"thing must be a Route, a Curve, a City or a RiskMap, got {type(thing).__name__}")
    if isinstance(thing, LazyCity):
        raise ValueError("thing must be a plain City: read or make a lazy one anew, or save city.part(around=...)")
    path = checks.path("path", path)
    arrays: dict[str, np.ndarray] = {}
    header = {"version": VERSION, "thing": described(thing, arrays)}
    with written_whole(path) as part, part.open("wb") as file:
        text = np.frombuffer(json.dumps(header).encode(), np.uint8)
        np.savez_compressed(file, allow_pickle=False, **{HEADER: text}, **arrays)


def load(path: str | Path) -> Saved:
    """What `save` wrote.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    Route, Curve, City or RiskMap

    Raises
    ------
    ValueError
        If `path` is not the name of a file, or the file isn't one of `save`, is damaged, or says what can't be.
    FileNotFoundError
        If there is no file at `path`.

    See Also
    --------
    save : the way there, with an example.

    Examples
    --------
    >>> from uavlab.storage import load
    >>> load("no such file.npz")
    Traceback (most recent call last):
    FileNotFoundError: [Errno 2] No such file or directory: 'no such file.npz'
    """
    source = checks.path("path", path)
    source.stat()  # a file that isn't there is no damaged one
    try:
        with np.load(source, allow_pickle=False) as file:
            if not isinstance(file, np.lib.npyio.NpzFile) or HEADER not in file:
                raise ValueError("it has no header of uavlab")
            header = json.loads(file[HEADER].tobytes())
            if header["version"] != VERSION:
                raise ValueError(f"its version is {header['version']!r:.20}, this is version {VERSION}")
            thing = made(header["thing"], file)
    except (
        ValueError, KeyError, TypeError, AttributeError, IndexError, EOFError, OverflowError, RecursionError,
        NotImplementedError, OSError, zipfile.BadZipFile, zlib.error, MemoryError,
    ) as error:  # fmt: skip
        raise ValueError(f"{source.name} is no file of uavlab.storage.save, or damaged: {error!s:.300}") from error
    if not isinstance(thing, Route | Curve | City | RiskMap):
        raise ValueError(f"{source.name} holds a {type(thing).__name__}, no route, curve, city or risk map")
    return thing


def described(value: Any, arrays: dict[str, np.ndarray]) -> Any:
    """A value as JSON takes it; arrays are put aside under a number."""
    if isinstance(value, np.generic):
        value = value.item()
    if value is None or isinstance(value, bool | int | str):
        return value
    if isinstance(value, float):
        return value if math.isfinite(value) else {"float": str(value)}
    if isinstance(value, np.ndarray) and value.dtype.kind in "biufU":
        arrays[f"array{len(arrays)}"] = value
        return {"array": f"array{len(arrays) - 1}"}
    if type(value).__name__ in KINDS and type(value) is KINDS[type(value).__name__]:
        return {"kind": type(value).__name__, "fields": described_fields(value, arrays)}
    if isinstance(value, list | tuple):
        return {type(value).__name__: [described(item, arrays) for item in value]}
    if isinstance(value, dict):
        return {"dict": {checks.text("the keys", key): described(item, arrays) for key, item in value.items()}}
    raise TypeError(f"{type(value).__name__} can't be saved")


def described_fields(thing: Any, arrays: dict[str, np.ndarray]) -> dict[str, Any]:
    """The fields of a thing; of `info` only what can be saved."""
    names = [one.name for one in fields(thing) if one.init] if is_dataclass(thing) else thing._fields
    found, left_out = {}, []
    for name in names:
        value = getattr(thing, name)
        if name != "info":
            found[name] = described(value, arrays)
            continue
        kept = {}
        for key, item in value.items():
            try:
                kept[key] = described(item, arrays)
            except (TypeError, ValueError):
                left_out.append(key)
        found[name] = {"dict": kept}
    if left_out:
        warnings.warn(f"left out of info, as it can't be saved: {', '.join(map(str, left_out))}", stacklevel=4)
    return found


def made(value: Any, arrays: Any, depth: int = 0) -> Any:
    """The value that was described."""
    if depth > DEEPEST:
        raise ValueError("it holds things in things without end")
    if value is None or isinstance(value, bool | int | float | str):
        return value
    ((kind, content), *more) = [(key, item) for key, item in value.items() if key != "fields"]
    if more:
        raise ValueError(f"it says {sorted(value)!s:.80} at once")
    if kind == "float":
        return float(content)
    if kind == "array":
        return arrays[content]
    if kind == "kind":
        return KINDS[content](**{name: made(item, arrays, depth + 1) for name, item in value["fields"].items()})
    if kind in ("list", "tuple"):
        return (list if kind == "list" else tuple)(made(item, arrays, depth + 1) for item in content)
    if kind == "dict":
        return {name: made(item, arrays, depth + 1) for name, item in content.items()}
    raise ValueError(f"it has something unknown, {kind!r:.40}")
