"""What the readers of JSON formats share."""

import json
from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np


def read_json(path: Path) -> list[dict[str, Any]]:
    """The JSON objects in a file: one, or a sequence with one per line."""
    documents: list[dict[str, Any]] = []
    position = 0
    try:
        text = path.read_text(encoding="utf-8-sig").rstrip()
        while position < len(text) or not documents:
            while text[position : position + 1].isspace():
                position += 1
            document, position = json.JSONDecoder().raw_decode(text, position)
            documents.append(document)
    except json.JSONDecodeError as error:
        place = f"line {error.lineno}, column {error.colno}"
        raise ValueError(f"{path.name} is not valid JSON: {error.msg} at {place}") from None
    except UnicodeDecodeError as error:
        raise ValueError(f"{path.name} is not UTF-8 text: {error.reason} at byte {error.start}") from None
    if not all(isinstance(document, dict) for document in documents):
        raise ValueError(f"{path.name} must hold a JSON object {{...}}, got a {type(documents[0]).__name__}")
    return documents


def count(kinds: Iterable[Any]) -> str:
    """Words for how often each kind occurs: "3 Point, 1 LineString"."""
    return ", ".join(f"{number} {kind}" for kind, number in Counter(kinds).most_common()) or "none at all"


def lowest_corner(corners: np.ndarray, advice: str) -> np.ndarray:
    """Lowest of corners (N, 3) [m] on each axis; `ValueError` with advice if they span under 1 m or over 100 km."""
    x, y, _ = np.ptp(corners, axis=0)
    if not 1.0 <= max(x, y) <= 100e3:
        raise ValueError(f"the buildings cover {x:.3g} × {y:.3g} m, which is no city: {advice}")
    return corners.min(axis=0)
