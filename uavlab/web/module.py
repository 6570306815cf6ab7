"""The module of planners as it is in the package, and what it was made with."""

from __future__ import annotations

import hashlib
import json
from functools import lru_cache
from importlib.resources import files
from typing import Any

from uavlab import __version__


@lru_cache(1)
def facts_on() -> dict[str, Any]:
    """What made the module, and what its functions take.

    Raises
    ------
    RuntimeError
        If it was made for another version of the library, or isn't the one that is told of.
    """
    facts = json.loads(files("uavlab.web").joinpath("planners.json").read_text("utf-8"))
    made_for = facts["made_by"]["uavlab"]
    if made_for != __version__:
        raise RuntimeError(
            f"planners.wasm was made for uavlab {made_for}, this is {__version__}: run python -m uavlab.web.build, "
            "or install uavlab anew"
        )
    if hashlib.sha256(wasm_bytes()).hexdigest() != facts["digest"]:
        raise RuntimeError(
            "planners.wasm isn't the one that planners.json tells of: run python -m uavlab.web.build, or install "
            "uavlab anew"
        )
    return facts


@lru_cache(1)
def wasm_bytes() -> bytes:
    """The module."""
    return files("uavlab.web").joinpath("planners.wasm").read_bytes()
