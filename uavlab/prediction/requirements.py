"""Packages that only the prediction needs, imported when they are first used: XGBoost alone takes seconds."""

from __future__ import annotations

import importlib
from typing import Any


def require(module: str) -> Any:
    """The module; an ImportError that says how to install it if it is missing."""
    try:
        return importlib.import_module(module)
    except ImportError as missing:
        raise ImportError(f'uavlab.prediction needs {module}: pip install "uavlab[prediction]"') from missing
