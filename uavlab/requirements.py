"""Packages that only a part of the library needs, imported when that is used first: XGBoost alone takes seconds."""

from __future__ import annotations

import importlib
from typing import Any


def require(module: str, extra: str) -> Any:
    """The module; an ImportError that says how to install it if it is missing."""
    try:
        return importlib.import_module(module)
    except ImportError as missing:
        raise ImportError(f'this needs {module}: pip install "uavlab[{extra}]"') from missing
