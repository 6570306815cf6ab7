"""What the readers of JSON formats share: one object in a file, or a sequence of them with any separator."""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any, NoReturn, TypeVar

from tqdm import tqdm

Item = TypeVar("Item")

MANY = 100_000
"""Above so many things a progress bar is shown."""

NO_NUMBER = re.compile(r'"(?:[^"\\]|\\.)*"|(NaN|-?Infinity)')
"""Texts, to step over them, and what Python's parser takes for a number but JSON doesn't know."""


NO_TEXT = {
    b"\x1f\x8b": "it is packed with gzip: unpack it first",
    b"PK\x03\x04": "it is a zip archive: unpack it first",
    b"\xff\xfe": "it is UTF-16: save it as UTF-8",
    b"\xfe\xff": "it is UTF-16: save it as UTF-8",
    b"SQLi": "it is a database (GeoPackage?): export it as GeoJSON",
}
"""What files are whose first bytes are these, and what to do."""


class NoNumberError(ValueError):
    """NaN or Infinity stands in a JSON text."""


def without_repeats(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """An object; `ValueError` if a key stands twice in it, of which one would silently win."""
    found = dict(pairs)
    if len(found) < len(pairs):
        seen: set[str] = set()
        again = next(key for key, _ in pairs if key in seen or seen.add(key))  # type: ignore[func-returns-value]
        raise ValueError(f"the key {again!r} stands twice in one object: which of the values holds?")
    return found


def read_json(path: Path, objects: Callable[[list[tuple[str, Any]]], Any] = without_repeats) -> list[dict[str, Any]]:
    """The JSON objects in a file: one, or a sequence, one per line or otherwise separated (RFC 8142, RFC 7464).

    Parameters
    ----------
    path : Path
        UTF-8 text, with or without a byte order mark.
    objects : callable
        Makes something of the (key, value) pairs of each object, the innermost first, while the file is read: so that
        repeated keys are seen, and a large file becomes arrays before it fills the memory.

    Raises
    ------
    ValueError
        If the text is not UTF-8, not JSON (NaN and Infinity aren't), nested too deeply, or holds something other than
        objects; the message has the line and the column.
    """
    decoder = json.JSONDecoder(parse_constant=refuse_constant, object_pairs_hook=objects)
    documents: list[Any] = []
    try:
        text = path.read_text(encoding="utf-8-sig")
        position = after_space(text, 0)
        while position < len(text) or not documents:
            start = position
            document, position = decoder.raw_decode(text, start)
            documents.append(document)
            position = after_space(text, position)
    except UnicodeDecodeError as error:
        raise ValueError(
            f"{path.name} is not UTF-8 text: {error.reason} at byte {error.start}{advice_on(path)}"
        ) from None
    except json.JSONDecodeError as error:
        raise ValueError(f"{path.name} is not valid JSON: {error.msg} at {place_in(error)}") from None
    except NoNumberError:
        found = next(match for match in NO_NUMBER.finditer(text, start) if match[1])
        place = place_in(json.JSONDecodeError("", text, found.start()))
        raise ValueError(f"{path.name} is not valid JSON: {found[1]} is not a number, at {place}") from None
    except RecursionError:
        raise ValueError(f"{path.name} is nested too deeply to be a city: lists in lists in lists") from None
    except (OverflowError, ValueError) as error:  # whole numbers of thousands of digits
        raise ValueError(f"{path.name} can't be read: {error}") from None
    for document in documents:
        if not isinstance(document, dict):
            raise ValueError(f"{path.name} must hold a JSON object {{...}}, got a {type(document).__name__}")
    return documents


def advice_on(path: Path) -> str:
    """What to do with a file that is no text, by its first bytes; empty where they don't tell."""
    with path.open("rb") as file:
        start = file.read(4)
    return next((f"; {advice}" for magic, advice in NO_TEXT.items() if start.startswith(magic)), "")


def after_space(text: str, position: int) -> int:
    """The next position that isn't white space, which the record separator U+001E is, too."""
    while text[position : position + 1].isspace():
        position += 1
    return position


def refuse_constant(text: str) -> NoReturn:
    raise NoNumberError(text)


def place_in(error: json.JSONDecodeError) -> str:
    return f"line {error.lineno}, column {error.colno}"


def progress(items: Sequence[Item], unit: str) -> Iterable[Item]:
    """The items one after the other, with a progress bar if there are very many."""
    return tqdm(items, unit=f" {unit}", disable=len(items) <= MANY)


def count(kinds: Iterable[Any]) -> str:
    """Words for how often each kind occurs: "3 Point, 1 LineString"."""
    return ", ".join(f"{number} {kind}" for kind, number in Counter(kinds).most_common()) or "none at all"
